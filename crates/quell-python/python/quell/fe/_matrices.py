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
from ._modal import FileMode, PerMode, system_of_modes
from ._points import Dof, Points, Units, chosen, name_of

__all__ = ["Entries", "Matrices", "symmetric_of", "system_of_matrices"]

Entries = dict[tuple[Dof, Dof], float]
"""Entries of a matrix, by row and column."""

Floats = npt.NDArray[np.float64]

RESTRAINED = 1e35
"""Stiffness on the diagonal from which on a degree of freedom is restrained: Abaqus writes 1e36 there."""

SYMMETRIC = 1e-9
"""Largest difference of entries that count as equal, relative to the largest entry: more than rounding to ten digits."""

RIGID = 1e-9
"""Eigenvalues of the stiffness below 0 down to this share of the largest are rounding of rigid motions, whose frequency is 0."""

COUPLED = 1e-6
"""Modal damping is diagonal if the coupling of two modes is below this share of their own damping."""


class Matrices(NamedTuple):
    """Matrices over the same degrees of freedom."""

    dofs: list[Dof]
    mass: Floats
    damping: Floats
    stiffness: Floats


def symmetric_of(entries: Entries, symmetric: bool, what: str) -> Entries:
    """The entries of a symmetric matrix of which a file has a triangle or all; of any matrix the entries as they are.

    Raises
    ------
    quell.StudyError
        Two entries that should be equal are not.
    """
    if not symmetric:
        return entries
    full = dict(entries)
    for (row, column), value in entries.items():
        other = entries.get((column, row), value)
        if abs(other - value) > SYMMETRIC * max(abs(other), abs(value)):
            names = f"({name_of(row)}, {name_of(column)})"
            allowed = f"equal to its mirror image {other}, at {names}; give symmetric=False for a matrix that is not symmetric"
            raise StudyError([complaint(what, value, allowed)])
        full[column, row] = value
    return full


def assembled(mass: Entries, damping: Entries, stiffness: Entries) -> Matrices:
    """Dense matrices over all degrees of freedom that have an entry, in ascending order."""
    dofs = sorted({dof for entries in (mass, damping, stiffness) for pair in entries for dof in pair})
    place = {dof: index for index, dof in enumerate(dofs)}
    filled = []
    for entries in (mass, damping, stiffness):
        matrix: Floats = np.zeros((len(dofs), len(dofs)))
        for (row, column), value in entries.items():
            matrix[place[row], place[column]] = value
        filled.append(matrix)
    return Matrices(dofs, *filled)


def free_of(matrices: Matrices) -> Matrices:
    """The matrices without restrained degrees of freedom."""
    kept: npt.NDArray[np.bool_] = np.abs(np.diag(matrices.stiffness)) < RESTRAINED
    inner = np.ix_(kept, kept)
    dofs = [dof for dof, is_kept in zip(matrices.dofs, kept, strict=True) if is_kept]
    return Matrices(dofs, matrices.mass[inner], matrices.damping[inner], matrices.stiffness[inner])


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


def modes_of(matrices: Matrices, rows: Floats, dofs: list[Dof], count: int, has_damping: bool) -> list[FileMode]:
    """The lowest modes, mass-normalised, with shapes over ``dofs``."""
    _, mass, damping, stiffness = matrices
    for name, matrix in (("mass", mass), ("stiffness", stiffness), ("damping", damping)):
        if np.abs(matrix - matrix.T).max(initial=0.0) > SYMMETRIC * np.abs(matrix).max(initial=0.0):
            raise StudyError([complaint(name, None, "symmetric for a reduction to modes; leave out modes", "conflict")])
    try:
        factor = np.linalg.cholesky(mass)
    except np.linalg.LinAlgError:
        allowed = "positive definite over the degrees of freedom that have mass"
        raise StudyError([complaint("mass", None, allowed, "conflict")]) from None
    half = np.linalg.solve(factor, stiffness)
    values, vectors = np.linalg.eigh(np.linalg.solve(factor, half.T))
    if values[0] < -RIGID * abs(values[-1]):
        allowed = f"positive semidefinite for a reduction to modes; its least eigenvalue is {values[0]:.6g}"
        raise StudyError([complaint("stiffness", None, allowed, "conflict")])
    shapes = np.linalg.solve(factor.T, vectors)[:, :count]
    frequencies = np.sqrt(np.clip(values[:count], 0.0, None))
    ratios = modal_damping(shapes, damping, frequencies) if has_damping else [None] * len(frequencies)
    displaced = rows @ shapes
    return [
        FileMode(float(frequency), ratio, 1.0, dict(zip(dofs, displaced[:, place].tolist(), strict=True)))
        for place, (frequency, ratio) in enumerate(zip(frequencies, ratios, strict=True))
    ]


def modal_damping(shapes: Floats, damping: Floats, frequencies: Floats) -> list[float | None]:
    """Damping ratios of a damping matrix that does not couple the modes."""
    modal = shapes.T @ damping @ shapes
    own = np.sqrt(np.abs(np.diag(modal)))
    if (np.abs(modal - np.diag(np.diag(modal))) > COUPLED * np.outer(own, own)).any() or (np.diag(modal)[frequencies == 0.0] != 0.0).any():
        allowed = "a damping matrix that does not couple the modes; leave out modes, or give damping_ratio instead of damping"
        raise StudyError([complaint("damping", None, allowed, "conflict")])
    found = zip(np.diag(modal), frequencies, strict=True)
    return [0.0 if frequency == 0.0 else float(rate / (2.0 * frequency)) for rate, frequency in found]


def system_of_matrices(
    mass: Entries,
    damping: Entries,
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
    whole = free_of(assembled(mass, damping, stiffness))
    if not whole.dofs:
        raise StudyError([complaint("stiffness", None, "a matrix with a degree of freedom that can move", "conflict")])
    left, rows = condensed(whole)
    if modes is not None:
        if not isinstance(modes, int) or isinstance(modes, bool) or not 1 <= modes <= len(left.dofs):
            raise StudyError([complaint("modes", modes, f"a whole number from 1 to {len(left.dofs)}")])
        if damping and damping_ratio is not None:
            raise StudyError([complaint("damping_ratio", None, "left out where there is a damping matrix", "conflict")])
        found = modes_of(left, rows, whole.dofs, modes, bool(damping))
        return system_of_modes(found, units=units, points=points, damping_ratio=damping_ratio, modal_mass=None, study=study)
    if damping_ratio is not None:
        allowed = "given together with modes: matrices have their own damping"
        raise StudyError([complaint("damping_ratio", None, allowed, "conflict")])
    named = {dof: name for name, dof in chosen(points, whole.dofs).items()}
    if missing := [name for dof, name in named.items() if dof not in left.dofs and points is not None]:
        allowed = f"a point with mass, or give modes, whose shapes have every point: {', '.join(missing)} has none"
        raise StudyError([complaint("points", None, allowed, "conflict")])
    coordinates = [named.get(dof, name_of(dof)) for dof in left.dofs]
    return System(
        coordinates=coordinates,
        mass=left.mass.tolist(),
        damping=left.damping.tolist() if damping else None,
        stiffness=left.stiffness.tolist(),
        units=units,
        **study,
    )
