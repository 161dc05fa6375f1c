"""The lowest modes of a structure, mass-normalised, from its matrices: by all eigenvalues of dense ones here, of sparse ones in `_sparse`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import StudyError, complaint
from ._modal import FileMode
from ._points import Dof

__all__ = ["COUPLED", "FreeMotion", "check_count", "check_symmetry", "modes_of"]

Floats = npt.NDArray[np.float64]

SYMMETRIC = 1e-9
"""Largest difference of a matrix from its transpose, relative to its largest entry: more than rounding to ten digits."""

RIGID = 1e-9
"""Share of the cancellation in φᵀKφ below which an eigenvalue is rounding of a rigid motion, whose frequency is 0: files have ten digits."""

COUPLED = 1e-6
"""Modal damping is diagonal if the coupling of two modes is below this share of their own damping."""

ACCURATE = 1e-6
"""Largest residual of Kφ = ω²Mφ, relative to the largest sum of the absolute values of its terms."""


@dataclass(frozen=True)
class FreeMotion:
    """Natural motions, with the matrices that check them. Matrices are dense or sparse."""

    values: Floats
    """Squares ω² of the lowest angular frequencies, in ascending order (modes,)."""
    shapes: Floats
    """Mass-normalised shapes φ over the degrees of freedom of the matrices (n, modes)."""
    mass: Any
    damping: Any
    stiffness: Any
    points: list[Dof]
    """Degrees of freedom of the study."""
    at_points: Floats
    """Shapes there (points, modes)."""

    @classmethod
    def of_dense(
        cls, matrices: tuple[Floats, Floats, Floats], rows: Floats, dofs: list[Dof], count: int, points: list[Dof]
    ) -> FreeMotion:
        """The motions of dense matrices; ``rows`` are those of all degrees of freedom over those of the matrices."""
        mass, damping, stiffness = matrices
        check_count(count, len(mass))
        check_symmetry(mass, damping, stiffness)
        try:
            factor = np.linalg.cholesky(mass)
        except np.linalg.LinAlgError:
            allowed = "positive definite over the degrees of freedom that have mass"
            raise StudyError([complaint("mass", None, allowed, "conflict")]) from None
        half = np.linalg.solve(factor, stiffness)
        values, vectors = np.linalg.eigh(np.linalg.solve(factor, half.T))
        shapes: Floats = np.linalg.solve(factor.T, vectors)[:, :count]
        place = {dof: index for index, dof in enumerate(dofs)}
        shown = rows[[place[dof] for dof in points]] @ shapes
        return cls(values[:count], shapes, mass, damping, stiffness, points, shown)


def check_count(count: object, most: int) -> None:
    """Rejects a number of modes that the structure does not have."""
    if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= most:
        raise StudyError([complaint("modes", count, f"a whole number from 1 to {most}")])


def check_symmetry(mass: Any, damping: Any, stiffness: Any) -> None:
    """Rejects matrices whose modes are not real."""
    for name, matrix in (("mass", mass), ("stiffness", stiffness), ("damping", damping)):
        if abs(matrix - matrix.T).max() > SYMMETRIC * abs(matrix).max():
            raise StudyError([complaint(name, None, "symmetric for a reduction to modes; leave out modes", "conflict")])


def frequencies_of(motion: FreeMotion) -> Floats:
    """Angular frequencies.

    Raises
    ------
    quell.StudyError
        The motions do not solve their equation, or the structure has a motion that grows.
    """
    values, shapes = motion.values, motion.shapes
    size = abs(motion.stiffness) @ abs(shapes)
    residual = abs(motion.stiffness @ shapes - (motion.mass @ shapes) * values)
    scale = (size + (abs(motion.mass) @ abs(shapes)) * abs(values)).max(axis=0)
    if (residual.max(axis=0) > ACCURATE * scale).any():
        allowed = "entries of sizes that can be computed with: the eigenvalues of these matrices are lost in rounding"
        raise StudyError([complaint("stiffness", None, allowed, "conflict")])
    growing = values < -RIGID * (abs(shapes) * size).sum(axis=0)
    if growing.any():
        allowed = f"positive semidefinite for a reduction to modes; its least eigenvalue is {values.min():.6g}"
        raise StudyError([complaint("stiffness", None, allowed, "conflict")])
    return np.sqrt(np.clip(values, 0.0, None))


def modes_of(motion: FreeMotion, has_damping: bool) -> list[FileMode]:
    """The modes at the points of the study."""
    frequencies = frequencies_of(motion)
    ratios = modal_damping(motion.shapes, motion.damping, frequencies) if has_damping else [None] * len(frequencies)
    return [
        FileMode(float(frequency), ratio, 1.0, dict(zip(motion.points, motion.at_points[:, place].tolist(), strict=True)))
        for place, (frequency, ratio) in enumerate(zip(frequencies, ratios, strict=True))
    ]


def modal_damping(shapes: Floats, damping: Any, frequencies: Floats) -> list[float | None]:
    """Damping ratios of a damping matrix that does not couple the modes."""
    modal = shapes.T @ (damping @ shapes)
    own = np.sqrt(np.abs(np.diag(modal)))
    if (np.abs(modal - np.diag(np.diag(modal))) > COUPLED * np.outer(own, own)).any() or (np.diag(modal)[frequencies == 0.0] != 0.0).any():
        allowed = "a damping matrix that does not couple the modes; leave out modes, or give damping_ratio instead of damping"
        raise StudyError([complaint("damping", None, allowed, "conflict")])
    found = zip(np.diag(modal), frequencies, strict=True)
    return [0.0 if frequency == 0.0 else float(rate / (2.0 * frequency)) for rate, frequency in found]
