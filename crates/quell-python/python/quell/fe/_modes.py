"""The lowest modes of a structure, mass-normalised, from its matrices: by all eigenvalues of dense ones here, of sparse ones in `_sparse`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import StudyError, complaint
from ._massless import finite_motions, infinite_note
from ._modal import FileMode
from ._points import Dof

__all__ = ["COUPLED", "FreeMotion", "check_count", "check_symmetry", "modes_of", "rounding_note"]

Floats = npt.NDArray[np.float64]

SYMMETRIC = 1e-9
"""Largest difference of a matrix from its transpose, relative to its largest entry: more than rounding to ten digits."""

RIGID = 1e-9
"""Share of the cancellation in φᵀKφ below which an eigenvalue is rounding of a rigid motion, whose frequency is 0: files have ten digits."""

ROUNDING = 16.0 * float(np.finfo(np.float64).eps)
"""The same of positive eigenvalues, times the root of the number of terms: rounding of double numbers. A soft support is above it."""

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
    structural: Any
    points: list[Dof]
    """Degrees of freedom of the study."""
    at_points: Floats
    """Shapes there (points, modes)."""
    notes: list[str]
    """Sentences about what was read and left out."""

    @classmethod
    def of_dense(cls, matrices: tuple[Floats, ...], dofs: list[Dof], count: int, points: list[Dof], notes: list[str]) -> FreeMotion:
        """The motions of dense matrices over ``dofs``: mass, damping, stiffness and structural damping."""
        mass, damping, stiffness, structural = matrices
        check_symmetry(mass, damping, stiffness, structural)
        values, shapes, infinite, light = finite_motions(mass, damping, stiffness)
        check_count(count, len(values))
        shapes = shapes[:, :count]
        place = {dof: index for index, dof in enumerate(dofs)}
        shown = shapes[[place[dof] for dof in points]]
        notes = notes + infinite_note(infinite, light)
        return cls(values[:count], shapes, mass, damping, stiffness, structural, points, shown, notes)


def check_count(count: object, most: int) -> None:
    """Rejects a number of modes that the structure does not have."""
    if not isinstance(count, int) or isinstance(count, bool) or not 1 <= count <= most:
        raise StudyError([complaint("modes", count, f"a whole number from 1 to {most}")])


def check_symmetry(mass: Any, damping: Any, stiffness: Any, structural: Any) -> None:
    """Rejects matrices whose modes are not real."""
    for name, matrix in (("mass", mass), ("stiffness", stiffness), ("damping", damping), ("structural_damping", structural)):
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
    cancelled = (abs(shapes) * size).sum(axis=0)
    growing = values < -RIGID * cancelled
    if growing.any():
        allowed = f"positive semidefinite for a reduction to modes; its least eigenvalue is {values.min():.6g}"
        raise StudyError([complaint("stiffness", None, allowed, "conflict")])
    elastic = values > ROUNDING * np.sqrt(len(shapes)) * cancelled
    return np.sqrt(np.where(elastic, values, 0.0))


def rounding_note(motion: FreeMotion) -> list[str]:
    """A sentence about frequencies that are within the rounding of ten digits, which a punch file has."""
    cancelled = (abs(motion.shapes) * (abs(motion.stiffness) @ abs(motion.shapes))).sum(axis=0)
    unsure = motion.values[np.abs(motion.values) < RIGID * cancelled]
    if not unsure.size:
        return []
    largest = float(np.sqrt(np.abs(unsure).max()))
    if unsure.size == 1:
        return [f"The lowest angular frequency, {largest:.3g}, is within the rounding of ten digits: that of a rigid motion, or not known."]
    have = f"The {unsure.size} lowest angular frequencies, up to {largest:.3g}"
    return [f"{have}, are within the rounding of ten digits: those of rigid motions, or not known."]


def modes_of(motion: FreeMotion, damped: list[str]) -> list[FileMode]:
    """The modes at the points of the study; ``damped`` has the names of the damping matrices that the file has."""
    frequencies = frequencies_of(motion)
    ratios: list[float | None] = [None] * len(frequencies)
    if damped:
        viscous = modal_damping("damping", motion.shapes, motion.damping, frequencies)
        hysteretic = modal_damping("structural_damping", motion.shapes, motion.structural, frequencies)
        # Half the loss factor φᵀHφ/ω² of a mode.
        ratios = [
            0.0 if frequency == 0.0 else float((rate + loss / frequency) / (2.0 * frequency))
            for frequency, rate, loss in zip(frequencies, viscous, hysteretic, strict=True)
        ]
    return [
        FileMode(float(frequency), ratio, 1.0, dict(zip(motion.points, motion.at_points[:, place].tolist(), strict=True)))
        for place, (frequency, ratio) in enumerate(zip(frequencies, ratios, strict=True))
    ]


def modal_damping(name: str, shapes: Floats, damping: Any, frequencies: Floats) -> Floats:
    """φᵀCφ of each mode, of a damping matrix that does not couple the modes.

    Raises
    ------
    quell.StudyError
        It couples them, or it damps a rigid motion.
    """
    modal: Floats = shapes.T @ (damping @ shapes)
    rates = np.diag(modal)
    own = np.sqrt(np.abs(rates))
    # Rounding of the sums, of which that of a rigid motion is zero.
    size = np.sqrt((np.abs(shapes) * (abs(damping) @ np.abs(shapes))).sum(axis=0))
    allowed_coupling = COUPLED * np.outer(own, own) + RIGID * np.outer(size, size)
    rigid = frequencies == 0.0
    if (np.abs(modal - np.diag(rates)) > allowed_coupling).any() or (np.abs(rates[rigid]) > RIGID * size[rigid] ** 2).any():
        allowed = f"a damping matrix that does not couple the modes; leave out modes, or give damping_ratio and {name}=None"
        raise StudyError([complaint(name, None, allowed, "conflict")])
    return rates
