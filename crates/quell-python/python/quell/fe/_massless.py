"""Directions without mass, which need not be coordinates: offset masses and rigid elements make a mass matrix singular.

With M scaled to a unit diagonal, its eigenvectors of eigenvalue 0 are the directions N without mass, and the others R. A motion
q = Ra + Nb has NᵀKq = 0, so that b = −(NᵀKN)⁻¹NᵀKR a: the finite eigenvalues of Kq = ω²Mq are those of ``Rᵀ K (R + N b)``, and the
infinite ones, one for each direction, are dropped.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .._errors import StudyError, complaint

__all__ = ["finite_motions", "infinite_note", "without_mass"]

Floats = npt.NDArray[np.float64]

SINGULAR = 1e-8
"""Share of the largest eigenvalue of the scaled mass below which a direction has no mass: files have ten digits."""

FREE = 1e-13
"""Share of the largest eigenvalue of the scaled stiffness of massless directions below which one of them has no stiffness either."""


def split(mass: Floats) -> tuple[Floats, Floats, int]:
    """Mass-normalised directions R, directions N without mass, and how many of these are coordinates.

    Raises
    ------
    quell.StudyError
        A direction has a negative mass.
    """
    size = len(mass)
    light: npt.NDArray[np.bool_] = np.logical_not(np.any(mass, axis=0))
    heavy = np.flatnonzero(~light)
    diagonal = np.diag(mass)[heavy]
    if (diagonal <= 0.0).any():
        raise StudyError([complaint("mass", float(diagonal.min()), "positive semidefinite: a diagonal entry of a row with mass is not positive")])
    scale = 1.0 / np.sqrt(diagonal)
    values, vectors = np.linalg.eigh(mass[np.ix_(heavy, heavy)] * np.outer(scale, scale))
    largest = float(values.max(initial=0.0))
    if (values < -SINGULAR * largest).any():
        allowed = f"positive semidefinite; scaled to a unit diagonal, its least eigenvalue is {values.min():.3g}"
        raise StudyError([complaint("mass", None, allowed, "conflict")])
    has_mass = values > SINGULAR * largest
    directions: Floats = np.zeros((size, len(heavy)))
    directions[heavy] = vectors * scale[:, None]
    with_mass = directions[:, has_mass] / np.sqrt(values[has_mass])
    massless = np.column_stack([np.eye(size)[:, light], directions[:, ~has_mass]])
    return with_mass, massless, int(light.sum())


def without_mass(mass: Floats) -> int:
    """How many directions have no mass."""
    return int(split(mass)[1].shape[1])


def finite_motions(mass: Floats, damping: Floats, stiffness: Floats) -> tuple[Floats, Floats, int, int]:
    """Squares of the finite frequencies in ascending order, mass-normalised shapes, and the numbers of directions and coordinates without mass.

    Raises
    ------
    quell.StudyError
        A direction without mass has damping, or no stiffness.
    """
    heavy, massless, light = split(mass)
    if not massless.shape[1]:
        factor = np.linalg.cholesky(mass)
        half = np.linalg.solve(factor, stiffness)
        values, vectors = np.linalg.eigh(np.linalg.solve(factor, half.T))
        return values, np.linalg.solve(factor.T, vectors), 0, 0
    acts = np.abs(damping @ massless).max(initial=0.0)
    if acts > SINGULAR * (np.abs(damping) @ np.abs(massless)).max(initial=0.0):
        raise StudyError([complaint("damping", None, "zero at degrees of freedom without mass, and in any other direction without mass", "conflict")])
    held = massless.T @ stiffness @ massless
    size = np.sqrt(np.abs(np.diag(held)))
    if (size == 0.0).any() or np.abs(np.linalg.eigvalsh(held / np.outer(size, size))).min() < FREE:
        allowed = "a mass for every free motion: some directions have neither mass nor stiffness"
        raise StudyError([complaint("mass", None, allowed, "conflict")])
    coupling = massless.T @ stiffness @ heavy
    follow = -np.linalg.solve(held / np.outer(size, size), coupling / size[:, None]) / size[:, None]
    reduced = heavy.T @ stiffness @ heavy + coupling.T @ follow
    values, vectors = np.linalg.eigh(0.5 * (reduced + reduced.T))
    return values, (heavy + massless @ follow) @ vectors, massless.shape[1], light


def infinite_note(infinite: int, light: int) -> list[str]:
    """A sentence about the directions without mass."""
    if not infinite:
        return []
    have = "1 direction has no mass" if infinite == 1 else f"{infinite} directions have no mass"
    return [f"{have}, of which {light} are coordinates; they follow the others statically, and their infinite frequencies were dropped."]
