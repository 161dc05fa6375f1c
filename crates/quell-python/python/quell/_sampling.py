"""Sampling of functions that users give.

Friction laws over the slip speed, and waveforms over the phase.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import StudyError, complaint

__all__ = ["fitted", "sampled", "sampled_wave"]

FIRST_INTERVALS = 64
"""Intervals that are refined."""

MOST_SAMPLES = 400
"""Most samples of a function."""

RESOLVED = 1e-4
"""Distance of a function from the straight line between neighbouring samples, over its largest value, that is resolved."""


def sampled(function: Callable[[float], float], top: float) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Speeds from 0 to ``top`` and the values of a function there, denser where the function bends.

    Speed 0 is the limit from above: a function may have its static value there.

    Raises
    ------
    StudyError
        The function fails, or a value is not a finite number ≥ 0.
    """
    first = np.linspace(0.0, top, FIRST_INTERVALS + 1)
    first[0] = 1e-9 * top
    values = {float(speed): value_at(function, float(speed)) for speed in first}
    largest = max(values.values()) or 1.0
    # The interval in which the function is farthest from a straight line is halved, until all are resolved.
    gaps = [gap(function, low, high, values) for low, high in zip(first[:-1], first[1:], strict=True)]
    while len(values) < MOST_SAMPLES:
        off, low, middle, high = max(gaps)
        if off <= RESOLVED * largest:
            break
        gaps.remove((off, low, middle, high))
        values[middle] = value_at(function, middle)
        gaps += [gap(function, low, middle, values), gap(function, middle, high, values)]
    speeds = np.array(sorted(values))
    coefficients = np.array([values[speed] for speed in sorted(values)])
    speeds[0] = 0.0
    return speeds, coefficients


def gap(function: Callable[[float], float], low: float, high: float, values: dict[float, float]) -> tuple[float, float, float, float]:
    """How far a function is from a straight line in the middle of an interval, and the interval with its middle."""
    low, high = float(low), float(high)
    middle = 0.5 * (low + high)
    off = abs(value_at(function, middle) - 0.5 * (values[low] + values[high]))
    return off, low, middle, high


def value_at(function: Callable[[float], float], speed: float) -> float:
    """The value of a function at a slip speed."""
    try:
        value = float(function(speed))
    except Exception as why:
        allowed = f"a function of the slip speed; at {speed:.6g} it raises {type(why).__name__}: {why}"
        raise StudyError([complaint("friction", None, allowed, "usage")]) from why
    if not (np.isfinite(value) and value >= 0.0):
        allowed = f"a function whose values are finite and not negative; at {speed:.6g} it is {value}"
        raise StudyError([complaint("friction", None, allowed, "usage")])
    return value


def fitted(coefficients: Any, speeds: Any, terms: int | None, at: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """The values of the law that is fitted to samples."""
    from ._belt import Belt
    from ._laws import Samples

    law = Samples(speeds, coefficients, terms=terms)
    probe = Belt(damping_ratio=0.1, normal_load=1.0, belt_velocity=float(at[-1]), friction=law)
    return probe.friction(at).coefficient


MOST_WAVE_SAMPLES = 4096
"""Most samples of a period of a waveform."""


def sampled_wave(function: Callable[[float], float]) -> tuple[list[float], float]:
    """Samples of a waveform over one period, and its largest distance from the straight lines between them, over its largest value.

    The number of samples is doubled from 64 until that distance is below 10⁻⁴, up to 4096: at a jump it stays.

    Raises
    ------
    StudyError
        The function fails, or a value is not finite.
    """
    count = 64
    while True:
        phases = 2.0 * np.pi * np.arange(2 * count) / (2 * count)
        values = np.array([wave_at(function, float(phase)) for phase in phases])
        samples, between = values[::2], values[1::2]
        largest = float(np.max(np.abs(values))) or 1.0
        off = float(np.max(np.abs(between - 0.5 * (samples + np.roll(samples, -1))))) / largest
        if off <= RESOLVED or count == MOST_WAVE_SAMPLES:
            return samples.tolist(), off
        count *= 2


def wave_at(function: Callable[[float], float], phase: float) -> float:
    """The value of a waveform at a phase."""
    try:
        value = float(function(phase))
    except Exception as why:
        allowed = f"a function of the phase in radians; at {phase:.6g} it raises {type(why).__name__}: {why}"
        raise StudyError([complaint("waveform", None, allowed, "usage")]) from why
    if not np.isfinite(value):
        allowed = f"a function whose values are finite; at {phase:.6g} it is {value}"
        raise StudyError([complaint("waveform", None, allowed, "usage")])
    return value


def with_wave(given: dict[str, Any]) -> tuple[dict[str, Any], float | None]:
    """The keys of a dither, a waveform that is a function as samples; and how far those are from the function."""
    function = given.get("waveform")
    if not callable(function):
        return given, None
    values, off = sampled_wave(function)
    return {**given, "waveform": "samples", "values": values, "hold": "linear"}, off
