"""Assembled matrices of a file as a study: as they are, or reduced to modes.

Restrained and massless degrees of freedom are eliminated first. Both eliminations are exact: a restrained one does not move, and
one without mass and damping follows the others statically, so that the stiffness becomes ``K_rr − K_rm K_mm⁻¹ K_mr``. Directions without
mass that are not coordinates, as those of an offset mass, are left to the reduction to modes (`_massless`).
"""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .._errors import StudyError, complaint
from .._system import System
from ._entries import RESTRAINT, Entries, Listed
from ._massless import without_mass
from ._modal import PerMode, system_of_modes
from ._modes import FreeMotion, modes_of, rounding_note
from ._notes import noted
from ._points import Dof, Points, Units, chosen, name_of
from ._sparse import lowest_of

__all__ = ["matrices_of_files", "system_of_matrices"]

Floats = npt.NDArray[np.float64]

DENSE = 1000
"""Most degrees of freedom of dense matrices; larger ones are sparse, and only their modes become a study."""

KINDS = ("mass", "damping", "stiffness", "structural_damping")
"""What matrices are, in the order of `Assembled`."""


class Assembled(NamedTuple):
    """Entries of the matrices over the degrees of freedom that are not restrained."""

    dofs: list[Dof]
    mass: Listed
    damping: Listed
    stiffness: Listed
    structural_damping: Listed


class Matrices(NamedTuple):
    """Dense matrices over the same degrees of freedom."""

    dofs: list[Dof]
    mass: Floats
    damping: Floats
    stiffness: Floats
    structural_damping: Floats


def assembled(given: dict[str, Entries]) -> tuple[Assembled, int]:
    """The entries over all degrees of freedom that have one, in ascending order, without the restrained ones, and the number of these."""
    dofs = sorted({dof for entries in given.values() for dof in entries.dofs})
    place = {dof: index for index, dof in enumerate(dofs)}
    none = Listed(np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0))
    read = [given[kind].listed(place) if kind in given else none for kind in KINDS]
    springs = read[2]
    kept: npt.NDArray[np.bool_] = np.ones(len(dofs), dtype=bool)
    kept[springs.rows[(springs.rows == springs.columns) & (springs.values == RESTRAINT)]] = False
    number = np.cumsum(kept) - 1
    inner = []
    for rows, columns, values in read:
        moves = kept[rows] & kept[columns]
        inner.append(Listed(number[rows[moves]], number[columns[moves]], values[moves]))
    left = [dof for dof, is_kept in zip(dofs, kept, strict=True) if is_kept]
    return Assembled(left, *inner), len(dofs) - len(left)


def free_note(entries: Assembled) -> list[str]:
    """A sentence about degrees of freedom without an entry of the stiffness."""
    held: npt.NDArray[np.bool_] = np.zeros(len(entries.dofs), dtype=bool)
    held[entries.stiffness.rows] = True
    free = np.flatnonzero(~held)
    if not free.size:
        return []
    have = "1 degree of freedom has" if free.size == 1 else f"{free.size} degrees of freedom have"
    return [f"{have} no stiffness, such as {name_of(entries.dofs[free[0]])}."]


def dense(entries: Assembled) -> Matrices:
    """The matrices with every entry."""
    count = len(entries.dofs)
    filled = []
    for rows, columns, values in entries[1:]:
        matrix: Floats = np.zeros((count, count))
        matrix[rows, columns] = values
        filled.append(matrix)
    return Matrices(entries.dofs, *filled)


def condensed(matrices: Matrices) -> Matrices:
    """The matrices without massless degrees of freedom.

    Raises
    ------
    quell.StudyError
        One of them has damping, or no stiffness; or other directions have no mass.
    """
    dofs, mass, damping, stiffness, structural = matrices
    light: npt.NDArray[np.bool_] = np.logical_not(np.any(mass, axis=0) | np.any(mass, axis=1))
    heavy = ~light
    inner = np.ix_(heavy, heavy)
    infinite = without_mass(mass) if np.array_equal(mass, mass.T) else int(light.sum())
    if infinite > light.sum():
        allowed = f"given: the mass matrix is singular. {infinite} directions have no mass, and {int(light.sum())} of them are coordinates"
        raise StudyError([complaint("modes", None, f"{allowed}; the reduction to modes eliminates the others", "missing")])
    if not light.any():
        return matrices
    if damping[light].any() or damping[:, light].any():
        names = [name_of(dof) for dof, is_light in zip(dofs, light, strict=True) if is_light]
        allowed = f"zero at degrees of freedom without mass, such as {names[0]}"
        raise StudyError([complaint("damping", None, allowed, "conflict")])
    try:
        follow = -np.linalg.solve(stiffness[np.ix_(light, light)], stiffness[np.ix_(light, heavy)])
    except np.linalg.LinAlgError:
        allowed = "a mass for every free motion: some degrees of freedom have neither mass nor stiffness"
        raise StudyError([complaint("mass", None, allowed, "conflict")]) from None
    reduced = stiffness[inner] + stiffness[np.ix_(heavy, light)] @ follow
    kept = [dof for dof, is_heavy in zip(dofs, heavy, strict=True) if is_heavy]
    return Matrices(kept, mass[inner], damping[inner], reduced, structural[inner])


def matrices_of_files(
    files: dict[str, str | os.PathLike[str] | None], read: Callable[[str | os.PathLike[str], str], Entries]
) -> dict[str, Entries]:
    """The matrices of the files that are given, by what they are; ``read`` takes a file and what it is."""
    return {kind: read(file, kind) for kind, file in files.items() if file is not None}


def system_of_matrices(
    given: dict[str, Entries],
    *,
    units: Units,
    points: Points | None,
    modes: int | None,
    damping_ratio: PerMode,
    notes: list[str],
    study: dict[str, Any],
    has_ten_digits: bool = False,
) -> System:
    """The study of a structure with these matrices, by what they are: `KINDS`; ``has_ten_digits``: the file has no more of a number.

    Raises
    ------
    quell.StudyError
        What is wrong with a matrix or an argument, and everything that is wrong in the study.
    """
    whole, restrained = assembled(given)
    if not whole.dofs:
        raise StudyError([complaint("stiffness", None, "a matrix with a degree of freedom that can move", "conflict")])
    if restrained:
        notes = [*notes, f"{restrained} restrained degrees of freedom were left out."]
    notes = notes + free_note(whole)
    damped: list[str] = [kind for kind in ("damping", "structural_damping") if kind in given]
    if modes is not None:
        if damped and damping_ratio is not None:
            allowed = f"left out where there is a damping matrix, or given with {damped[0]}=None"
            raise StudyError([complaint("damping_ratio", None, allowed, "conflict")])
        motion = free_motion(whole, points, modes, notes)
        found = modes_of(motion, damped)
        system = system_of_modes(found, units=units, points=points, damping_ratio=damping_ratio, modal_mass=None, study=study)
        return noted(system, motion.notes + (rounding_note(motion) if has_ten_digits else []))
    if "structural_damping" in given:
        allowed = "left out (None), or given together with modes: structural damping has no matrix in time"
        allowed += ", and half its loss factor is the damping ratio of a mode"
        raise StudyError([complaint("structural_damping", None, allowed, "conflict")])
    if len(whole.dofs) > DENSE:
        allowed = f"given: matrices of more than {DENSE} degrees of freedom are reduced to modes, and these have {len(whole.dofs)}"
        raise StudyError([complaint("modes", None, allowed, "missing")])
    if damping_ratio is not None:
        allowed = "given together with modes: matrices have their own damping"
        raise StudyError([complaint("damping_ratio", None, allowed, "conflict")])
    left = condensed(dense(whole))
    named = {dof: name for name, dof in chosen(points, whole.dofs).items()}
    if missing := [name for dof, name in named.items() if dof not in left.dofs and points is not None]:
        allowed = f"a point with mass, or give modes, whose shapes have every point: {', '.join(missing)} has none"
        raise StudyError([complaint("points", None, allowed, "conflict")])
    if count := len(whole.dofs) - len(left.dofs):
        notes = [*notes, f"{count} degrees of freedom without mass were eliminated; they follow the others statically."]
    system = System(
        coordinates=[named.get(dof, name_of(dof)) for dof in left.dofs],
        mass=left.mass.tolist(),
        damping=left.damping.tolist() if "damping" in given else None,
        stiffness=left.stiffness.tolist(),
        units=units,
        **study,
    )
    return noted(system, notes)


def free_motion(whole: Assembled, points: Points | None, modes: int, notes: list[str]) -> FreeMotion:
    """The lowest natural motions of the structure at its points."""
    named = list(chosen(points, whole.dofs).values())
    if len(whole.dofs) > DENSE:
        if points is None:
            allowed = f"given: the file has {len(whole.dofs)} degrees of freedom, too many for a study"
            raise StudyError([complaint("points", None, allowed, "missing")])
        return lowest_of(whole.dofs, whole[1:], modes, named, notes)
    return FreeMotion.of_dense(dense(whole)[1:], whole.dofs, modes, named, notes)
