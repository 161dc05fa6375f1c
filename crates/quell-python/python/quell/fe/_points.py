"""Names of degrees of freedom: a node and a direction."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, Literal, Union

import numpy as np

from .._errors import StudyError, complaint

__all__ = ["DIRECTIONS", "Dof", "Points", "Units", "chosen", "check_units", "dof_of", "name_of"]

Dof = tuple[int, int]
"""A node and the number of a direction: 1 to 3 are displacements, 4 to 6 rotations."""

Points = Mapping[str, tuple[int, Union[str, int]]]
"""Names of nodes with a direction, such as ``{"pad_x": (1204, "x")}``."""

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")
"""Names of the directions 1 to 6."""


def name_of(dof: Dof) -> str:
    """The name of a degree of freedom: ``n1204_x``; nodes that a program adds have negative numbers: ``internal24_x``."""
    node, direction = dof
    letters = DIRECTIONS[direction - 1] if 1 <= direction <= len(DIRECTIONS) else f"d{direction}"
    return f"n{node}_{letters}" if node >= 0 else f"internal{-node}_{letters}"


def dof_of(given: Any) -> Dof | None:
    """The degree of freedom of a node and a direction."""
    try:
        node, direction = given
    except (TypeError, ValueError):
        return None
    if isinstance(direction, str):
        if direction.lower() not in DIRECTIONS:
            return None
        direction = DIRECTIONS.index(direction.lower()) + 1
    if any(isinstance(it, bool) or not isinstance(it, (int, np.integer)) for it in (node, direction)) or direction < 0:
        return None
    return (int(node), int(direction))


def chosen(points: Points | None, there: Iterable[Dof]) -> dict[str, Dof]:
    """The names of the degrees of freedom that a study has: those of ``points``, or all.

    Raises
    ------
    quell.StudyError
        A point that is no node with a direction, or is not in the file.
    """
    known = dict.fromkeys(there)
    if points is None:
        return {name_of(dof): dof for dof in known}
    if not isinstance(points, Mapping):
        raise StudyError([complaint("points", points, 'a dict of names, nodes and directions, such as {"pad_x": (1204, "x")}')])
    wrong, found = [], {}
    for name, given in points.items():
        dof = dof_of(given)
        if dof is None:
            wrong.append(complaint(f"points[{name}]", given, 'a node and a direction "x", "y", "z", "rx", "ry", "rz" or its number, such as (1204, "x")'))
        elif dof not in known:
            wrong.append(complaint(f"points[{name}]", given, f"a node and a direction of the file, which has {_some(known)}"))
        else:
            found[name] = dof
    if wrong:
        raise StudyError(wrong)
    return found


def _some(known: Iterable[Dof]) -> str:
    names = [name_of(dof) for dof in known]
    return ", ".join(names[:6]) + (f" and {len(names) - 6} more" if len(names) > 6 else "")


Units = Literal["SI", "mm-t-s", "none"]
UNITS = ("SI", "mm-t-s", "none")
"""What a file may be in: SI, mm-t-s (mm, t, s, N), or numbers without units."""


def check_units(units: object) -> None:
    """Rejects units that are not stated.

    Raises
    ------
    quell.StudyError
        Always with the units that are allowed.
    """
    if units not in UNITS:
        allowed = 'the units of the numbers in the file: "SI", "mm-t-s" or, for numbers without units, "none"'
        raise StudyError([complaint("units", units, allowed)])
