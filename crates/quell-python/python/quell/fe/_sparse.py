"""The lowest modes of a large structure, by a shifted and inverted Lanczos iteration on its sparse matrices.

One factorisation of ``K − σM`` with σ < 0 serves every step. Its pivots have the signs of the eigenvalues above and below σ (Sylvester's
law of inertia), so that no motion that grows is overlooked. Massless degrees of freedom follow the others in it, and are not eliminated
before. The method is that of Ericsson and Ruhe (1980), of which SciPy has ARPACK's implementation.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import StudyError, complaint
from .._export import needed
from ._entries import Listed
from ._modes import FreeMotion, check_count, check_symmetry
from ._points import Dof, name_of

__all__ = ["lowest_of"]

Floats = npt.NDArray[np.float64]

SHIFT = 1e-8
"""Distance of σ from 0, as a share of the largest ratio of stiffness to mass on the diagonal. Rounding in the factorisation is 10⁻¹⁶ of that
ratio, and the lowest eigenvalues of a mesh are of this order or larger."""

SEED = 1
"""Seed of the start of the iteration, so that equal files give equal modes."""


def lowest_of(dofs: list[Dof], entries: tuple[Listed, ...], count: int, points: list[Dof], notes: list[str]) -> FreeMotion:
    """The lowest motions of mass, damping, stiffness and structural damping over ``dofs``, with the shapes at ``points``.

    Raises
    ------
    quell.StudyError
        What is wrong with a matrix, or the number of modes.
    ImportError
        SciPy is not installed.
    """
    sparse = needed("scipy.sparse", f"reading {len(dofs)} degrees of freedom")
    size = (len(dofs), len(dofs))
    mass, damping, stiffness, structural = (sparse.csc_array((it.values, (it.rows, it.columns)), shape=size) for it in entries)
    heavy = abs(mass).sum(axis=0) > 0.0
    # ARPACK needs one direction more than modes.
    check_count(count, min(int(heavy.sum()), len(dofs) - 2))
    check_symmetry(mass, damping, stiffness, structural)
    empty = np.flatnonzero(~heavy & (abs(stiffness).sum(axis=0) == 0.0))
    if empty.size:
        allowed = f"a mass for every free motion: {name_of(dofs[empty[0]])} has neither mass nor stiffness"
        raise StudyError([complaint("mass", None, allowed, "conflict")])
    if (abs(damping).sum(axis=0)[~heavy] > 0.0).any():
        raise StudyError([complaint("damping", None, "zero at degrees of freedom without mass", "conflict")])
    if (mass.diagonal()[heavy] <= 0.0).any():
        raise StudyError([complaint("mass", None, "positive definite over the degrees of freedom that have mass", "conflict")])
    values, shapes = shifted(mass, stiffness, count, heavy)
    place = {dof: index for index, dof in enumerate(dofs)}
    light = int((~heavy).sum())
    if light:
        notes = [*notes, f"{light} degrees of freedom have no mass; they follow the others statically."]
    shown = shapes[[place[dof] for dof in points]]
    return FreeMotion(values, shapes, mass, damping, stiffness, structural, points, shown, notes)


def shifted(mass: Any, stiffness: Any, count: int, heavy: npt.NDArray[np.bool_]) -> tuple[Floats, Floats]:
    """Eigenvalues next to σ in ascending order, and mass-normalised vectors."""
    linalg = needed("scipy.sparse.linalg", "a reduction to modes")
    largest = float((np.abs(stiffness.diagonal()[heavy]) / mass.diagonal()[heavy]).max())
    shift = -SHIFT * largest
    try:
        # Without exchanged rows the pivots are those of the symmetric matrix.
        solver = linalg.splu(
            stiffness - shift * mass, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
    except RuntimeError:
        allowed = "a mass for every free motion: the matrix of a static load and slow inertia is singular"
        raise StudyError([complaint("mass", None, allowed, "conflict")]) from None
    below = int((solver.U.diagonal() <= 0.0).sum())
    if below or not np.array_equal(solver.perm_r, solver.perm_c):
        allowed = f"positive semidefinite for a reduction to modes; {below or 'some'} of its eigenvalues are below {shift:.6g}"
        raise StudyError([complaint("stiffness", None, allowed, "conflict")])
    inverse = linalg.LinearOperator(stiffness.shape, matvec=solver.solve, dtype=np.float64)
    start = np.random.default_rng(SEED).normal(size=stiffness.shape[0])
    try:
        values, vectors = linalg.eigsh(stiffness, k=count, M=mass, sigma=shift, OPinv=inverse, v0=inverse.matvec(mass @ start))
    except linalg.ArpackError as why:
        raise StudyError([complaint("stiffness", None, f"a matrix whose modes can be found: {why}", "conflict")]) from None
    order = np.argsort(values)
    # The motions of massless degrees of freedom are those of one more solution.
    shapes: Floats = np.column_stack([solver.solve(mass @ vectors[:, place]) for place in order])
    lengths = np.sqrt(np.einsum("ij,ij->j", shapes, mass @ shapes))
    return values[order], shapes / lengths
