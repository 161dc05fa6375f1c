"""Assembled matrices of a file as a study: as they are, or reduced to modes.

Restrained and massless degrees of freedom are eliminated first. Both eliminations are exact: a restrained one does not move, and
one without mass and damping follows the others statically, so that the stiffness becomes ``K_rr − K_rm K_mm⁻¹ K_mr``.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .._errors import StudyError, complaint
from .._system import System
from ._entries import RESTRAINT, Entries, Listed
from ._modal import PerMode, system_of_modes
from ._modes import FreeMotion, modes_of
from ._points import Dof, Points, Units, chosen, name_of
from ._sparse import lowest_of

__all__ = ["system_of_matrices"]

Floats = npt.NDArray[np.float64]

DENSE = 1000
"""Most degrees of freedom of dense matrices; larger ones are sparse, and only their modes become a study."""


class Assembled(NamedTuple):
    """Entries of the matrices over the degrees of freedom that are not restrained."""

    dofs: list[Dof]
    mass: Listed
    damping: Listed
    stiffness: Listed


class Matrices(NamedTuple):
    """Dense matrices over the same degrees of freedom."""

    dofs: list[Dof]
    mass: Floats
    damping: Floats
    stiffness: Floats


def assembled(mass: Entries, damping: Entries | None, stiffness: Entries) -> Assembled:
    """The entries over all degrees of freedom that have one, in ascending order, without the restrained ones."""
    given = [it for it in (mass, damping, stiffness) if it is not None]
    dofs = sorted({dof for entries in given for dof in entries.dofs})
    place = {dof: index for index, dof in enumerate(dofs)}
    none = Listed(np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0))
    read = [none if it is None else it.listed(place) for it in (mass, damping, stiffness)]
    springs = read[2]
    kept: npt.NDArray[np.bool_] = np.ones(len(dofs), dtype=bool)
    kept[springs.rows[(springs.rows == springs.columns) & (springs.values == RESTRAINT)]] = False
    number = np.cumsum(kept) - 1
    inner = []
    for rows, columns, values in read:
        moves = kept[rows] & kept[columns]
        inner.append(Listed(number[rows[moves]], number[columns[moves]], values[moves]))
    return Assembled([dof for dof, is_kept in zip(dofs, kept, strict=True) if is_kept], *inner)


def dense(entries: Assembled) -> Matrices:
    """The matrices with every entry."""
    count = len(entries.dofs)
    filled = []
    for rows, columns, values in entries[1:]:
        matrix: Floats = np.zeros((count, count))
        matrix[rows, columns] = values
        filled.append(matrix)
    return Matrices(entries.dofs, *filled)


def condensed(matrices: Matrices) -> tuple[Matrices, Floats]:
    """The matrices without massless degrees of freedom, and the rows of all degrees of freedom over those that are left."""
    dofs, mass, damping, stiffness = matrices
    light: npt.NDArray[np.bool_] = np.logical_not(np.any(mass, axis=0) | np.any(mass, axis=1))
    rows: Floats = np.eye(len(dofs))[:, ~light]
    if not light.any():
        return matrices, rows
    if damping[light].any() or damping[:, light].any():
        names = [name_of(dof) for dof, is_light in zip(dofs, light, strict=True) if is_light]
        allowed = f"zero at degrees of freedom without mass, such as {names[0]}"
        raise StudyError([complaint("damping", None, allowed, "conflict")])
    heavy = ~light
    try:
        follow = -np.linalg.solve(stiffness[np.ix_(light, light)], stiffness[np.ix_(light, heavy)])
    except np.linalg.LinAlgError:
        allowed = "a mass for every free motion: some degrees of freedom have neither mass nor stiffness"
        raise StudyError([complaint("mass", None, allowed, "conflict")]) from None
    rows[light] = follow
    reduced = stiffness[np.ix_(heavy, heavy)] + stiffness[np.ix_(heavy, light)] @ follow
    inner = np.ix_(heavy, heavy)
    kept = [dof for dof, is_heavy in zip(dofs, heavy, strict=True) if is_heavy]
    return Matrices(kept, mass[inner], damping[inner], reduced), rows


def system_of_matrices(
    mass: Entries,
    damping: Entries | None,
    stiffness: Entries,
    *,
    units: Units,
    points: Points | None,
    modes: int | None,
    damping_ratio: PerMode,
    study: dict[str, Any],
) -> System:
    """The study of a structure with these matrices.

    Raises
    ------
    quell.StudyError
        What is wrong with a matrix or an argument, and everything that is wrong in the study.
    """
    whole = assembled(mass, damping, stiffness)
    if not whole.dofs:
        raise StudyError([complaint("stiffness", None, "a matrix with a degree of freedom that can move", "conflict")])
    if modes is not None:
        if damping is not None and damping_ratio is not None:
            raise StudyError([complaint("damping_ratio", None, "left out where there is a damping matrix", "conflict")])
        motion = free_motion(whole, points, modes, damping is not None)
        found = modes_of(motion, damping is not None)
        return system_of_modes(found, units=units, points=points, damping_ratio=damping_ratio, modal_mass=None, study=study)
    if len(whole.dofs) > DENSE:
        allowed = f"given: matrices of more than {DENSE} degrees of freedom are reduced to modes, and these have {len(whole.dofs)}"
        raise StudyError([complaint("modes", None, allowed, "missing")])
    if damping_ratio is not None:
        allowed = "given together with modes: matrices have their own damping"
        raise StudyError([complaint("damping_ratio", None, allowed, "conflict")])
    left, _ = condensed(dense(whole))
    named = {dof: name for name, dof in chosen(points, whole.dofs).items()}
    if missing := [name for dof, name in named.items() if dof not in left.dofs and points is not None]:
        allowed = f"a point with mass, or give modes, whose shapes have every point: {', '.join(missing)} has none"
        raise StudyError([complaint("points", None, allowed, "conflict")])
    coordinates = [named.get(dof, name_of(dof)) for dof in left.dofs]
    return System(
        coordinates=coordinates,
        mass=left.mass.tolist(),
        damping=left.damping.tolist() if damping is not None else None,
        stiffness=left.stiffness.tolist(),
        units=units,
        **study,
    )


def free_motion(whole: Assembled, points: Points | None, modes: int, has_damping: bool) -> FreeMotion:
    """The lowest natural motions of the structure at its points."""
    named = list(chosen(points, whole.dofs).values())
    if len(whole.dofs) > DENSE:
        if points is None:
            allowed = f"given: the file has {len(whole.dofs)} degrees of freedom, too many for a study"
            raise StudyError([complaint("points", None, allowed, "missing")])
        return lowest_of(whole.dofs, (whole.mass, whole.damping, whole.stiffness), modes, named)
    matrices = dense(whole)
    left, rows = condensed(matrices)
    return FreeMotion.of_dense((left.mass, left.damping, left.stiffness), rows, whole.dofs, modes, named)
