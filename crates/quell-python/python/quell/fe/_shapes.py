"""Complex mode shapes as real ones: by a rotation in the complex plane, where they are nearly real."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._errors import StudyError, complaint
from ._modal import FileMode
from ._points import Dof

__all__ = ["COLLINEAR", "ComplexMode", "check_limit", "real_modes"]

COLLINEAR = 0.95
"""Least modal phase collinearity of a shape that is taken for a real one: after the rotation (1 - √0.95)/2 = 1.3 % of Σ|ψ|² is imaginary,
and left out. A lower limit takes shapes that travel for standing ones; ``collinearity=`` sets it, and each mode states its own."""

ROUNDING = 1e-6
"""Largest |Re λ|/|λ| of a mode whose damping is rounding."""

TURNED = 0.2
"""Largest imaginary part of a modal mass relative to its real part: that of the phase that a shape of collinearity 0.95 may have."""


class ComplexMode(NamedTuple):
    """A mode e^{λt} of a file."""

    eigenvalue: complex
    """λ in rad/s."""
    modal_a: complex
    """Modal A, ψᵀ(2λM + C)ψ; 0 where the file does not say it."""
    shape: dict[Dof, complex]
    """Displacements ψ."""
    where: str
    """The mode in words, with its line."""


def check_limit(limit: object) -> float:
    """The least collinearity that a caller allows.

    Raises
    ------
    quell.StudyError
        It is not a number from 0 to 1.
    """
    if isinstance(limit, bool) or not isinstance(limit, (int, float)) or not 0.0 <= limit <= 1.0:
        raise StudyError([complaint("collinearity", limit, "a number from 0 to 1, the least modal phase collinearity of a shape")])
    return float(limit)


def real_modes(modes: list[ComplexMode], limit: float, has_mass: bool) -> tuple[list[FileMode], list[str]]:
    """The modes whose shapes are nearly real, and notes with the collinearity of each; ``has_mass``: the caller states their modal masses.

    Raises
    ------
    quell.StudyError
        No shape is real enough, or a motion grows.
    """
    found, kept, left = [], [], []
    for mode in modes:
        if mode.eigenvalue.real > ROUNDING * abs(mode.eigenvalue):
            allowed = f"{mode.where} grows without friction: λ = {mode.eigenvalue:.6g}; modes must decay"
            raise StudyError([complaint("path", None, allowed, "path")])
        shape, angle, collinearity = rotated(mode.shape)
        words = f"{mode.where}: {collinearity:.4f}"
        if collinearity < limit:
            left.append(words)
            continue
        kept.append(words)
        size = abs(mode.eigenvalue)
        ratio = 0.0 if size == 0.0 else max(-mode.eigenvalue.real / size, 0.0)
        found.append(FileMode(size, ratio, None if has_mass else modal_mass(mode, angle), shape))
    if not found:
        allowed = f"modes whose shapes are nearly real (modal phase collinearity at least {limit:g}); {'; '.join(left)}"
        raise StudyError([complaint("collinearity", limit, allowed)])
    notes = []
    if any(value.imag for mode in modes for value in mode.shape.values()):
        notes.append(f"Complex shapes were rotated to real ones. Modal phase collinearity: {'; '.join(kept)}.")
    if left:
        notes.append(f"Left out, because their modal phase collinearity is below {limit:g}: {'; '.join(left)}.")
    return found, notes


def rotated(shape: dict[Dof, complex]) -> tuple[dict[Dof, float], float, float]:
    """The shape ψe^{−iθ} of the largest real part, θ, and the modal phase collinearity |Σψ²|²/(Σ|ψ|²)².

    Displacements decide where there are any: rotations have another unit.
    """
    straight = [value for (_, direction), value in shape.items() if 1 <= direction <= 3]
    values: npt.NDArray[np.complex128] = np.array(straight if any(straight) else list(shape.values()), dtype=np.complex128)
    largest = float(np.abs(values).max(initial=0.0))
    if largest == 0.0:
        return {dof: value.real for dof, value in shape.items()}, 0.0, 1.0
    values = values / largest
    square = complex((values**2).sum())
    collinearity = (abs(square) / float((np.abs(values) ** 2).sum())) ** 2
    angle = 0.5 * float(np.angle(square)) if np.any(values.imag) else 0.0
    turn = complex(np.cos(angle), -np.sin(angle))
    return {dof: (value * turn).real if angle else value.real for dof, value in shape.items()}, angle, min(collinearity, 1.0)


def modal_mass(mode: ComplexMode, angle: float) -> float | None:
    """The modal mass of the rotated shape from modal A, which is 2iω_d m for a real shape; ``None`` without one.

    Raises
    ------
    quell.StudyError
        Modal A is not that of a real shape with a mass.
    """
    damped = mode.eigenvalue.imag
    if mode.modal_a == 0.0 or damped == 0.0:
        return None
    mass = mode.modal_a * complex(np.cos(2.0 * angle), -np.sin(2.0 * angle)) / (2j * damped)
    if mass.real <= 0.0 or abs(mass.imag) > TURNED * mass.real:
        allowed = f"given: modal A of {mode.where} is {mode.modal_a:.6g}, of which the rotated shape has the modal mass {mass:.4g}, not a real mass"
        raise StudyError([complaint("modal_mass", None, allowed, "missing")])
    return float(mass.real)
