"""Modes of a file as modes of a study."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple, Union

import numpy as np
import numpy.typing as npt

from .._errors import Complaint, StudyError, complaint
from .._system import System, SystemMode
from ._points import Dof, Points, Units, chosen

__all__ = ["FileMode", "PerMode", "system_of_modes"]

PerMode = Union[float, Sequence[float], None]
"""One number for every mode, or one for each."""


class FileMode(NamedTuple):
    """A mode of a file."""

    frequency: float
    """Angular frequency."""
    damping_ratio: float | None
    """Damping ratio; ``None`` where the file does not say it."""
    modal_mass: float | None
    """Modal mass; ``None`` where the file does not say it."""
    shape: dict[Dof, float]
    """Displacements."""


def per_mode(name: str, given: PerMode, count: int, least: float, wrong: list[Complaint]) -> list[float] | None:
    """The number of each mode that an argument gives; ``None`` without the argument."""
    if given is None:
        return None
    allowed = f"a number {'≥ 0' if least == 0.0 else '> 0'}, or {count} of them, one for each mode"
    try:
        numbers: npt.NDArray[np.float64] = np.asarray(given, dtype=np.float64)
        spread = np.broadcast_to(numbers, (count,))
    except (TypeError, ValueError):
        wrong.append(complaint(name, given, allowed))
        return None
    right = np.isfinite(spread) & ((spread >= 0.0) if least == 0.0 else (spread > 0.0))
    if not right.all():
        wrong.append(complaint(name, given, allowed))
    return [float(number) for number in spread]


def system_of_modes(
    modes: Iterable[FileMode],
    *,
    units: Units,
    points: Points | None,
    damping_ratio: PerMode,
    modal_mass: PerMode,
    study: dict[str, Any],
) -> System:
    """The study of a structure with these modes, in ascending order of frequency.

    Raises
    ------
    quell.StudyError
        A damping ratio or a modal mass that neither the file nor an argument gives, and everything that is wrong in the study.
    """
    found = sorted(modes, key=lambda mode: mode.frequency)
    wrong: list[Complaint] = []
    ratios = per_mode("damping_ratio", damping_ratio, len(found), 0.0, wrong)
    masses = per_mode("modal_mass", modal_mass, len(found), 1.0, wrong)
    if ratios is None and any(mode.damping_ratio is None for mode in found) and not wrong:
        wrong.append(complaint("damping_ratio", None, "given: the file has no modal damping", "missing"))
    if masses is None and any(mode.modal_mass is None for mode in found) and not wrong:
        allowed = "given: the file has no modal masses; 1 in the units of the file for mass-normalised shapes"
        wrong.append(complaint("modal_mass", None, allowed, "missing"))
    if wrong:
        raise StudyError(wrong)
    names = chosen(points, (dof for mode in found for dof in mode.shape))
    for mode in found:
        missing = [name for name, dof in names.items() if dof not in mode.shape]
        if missing:
            allowed = f"in every mode: that of angular frequency {mode.frequency:.6g} has no displacement of {missing[0]}"
            raise StudyError([complaint("points", missing[0], allowed)])
    made = [
        SystemMode(
            frequency=mode.frequency,
            damping_ratio=mode.damping_ratio if ratios is None else ratios[place],
            modal_mass=mode.modal_mass if masses is None else masses[place],
            shape={name: mode.shape[dof] for name, dof in names.items()},
        )
        for place, mode in enumerate(found)
    ]
    return System(mode=made, normalisation="max", units=units, **study)
