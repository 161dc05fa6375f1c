"""Every answer of the explorer by name."""

from __future__ import annotations

from collections.abc import Callable

from ._answers import averaged, trajectory
from ._maps import basins, curves, eigenvalues, plane
from ._measured import compare, fit
from ._questions import actuator, design, probability
from ._reading import Answer
from ._sound import sound
from ._spectra import response

TASKS: dict[str, Callable[..., Answer]] = {
    "averaged": averaged,
    "trajectory": trajectory,
    "response": response,
    "plane": plane,
    "curves": curves,
    "basins": basins,
    "eigenvalues": eigenvalues,
    "sound": sound,
    "design": design,
    "actuator": actuator,
    "probability": probability,
    "compare": compare,
    "fit": fit,
}
"""Every answer by name."""

REPORTING = ("basins", "probability")
"""Answers that report progress."""
