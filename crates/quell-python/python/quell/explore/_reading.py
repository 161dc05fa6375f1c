"""How arrays, units and numbers of results and studies are read."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .._result import Result
from .._study import Study

Answer = dict[str, Any]
"""An answer: arrays, numbers and words by name."""

Array = npt.NDArray[np.float64]


def said(result: Result) -> Answer:
    """What a result says in words: the sentence, the notes and the warnings."""
    return {"sentence": str(result.facts.get("sentence", "")), "notes": result.notes, "warnings": result.warnings}


def values(result: Result, name: str) -> Array:
    """An array of a result in the units of the study."""
    return np.asarray(result.arrays[name].values, dtype=np.float64)


def unit(result: Result, name: str) -> str:
    """The unit of an array; empty if it has none."""
    attributes = result.arrays[name].attrs
    found = str(attributes.get("units", ""))
    scaled = str(attributes.get("scaling", ""))
    return bare(scaled if found in ("dimensionless", "") else found)


def bare(unit_: str) -> str:
    """A unit without the sign of a ratio: "c/(2mω₀)" for "1 (c/(2mω₀))", and nothing for "1"."""
    return unit_[3:-1] if unit_.startswith("1 (") else "" if unit_ == "1" else unit_


def number_of(study: Study, *paths: str) -> float | None:
    """The first of these numbers that the study has."""
    settings = study.settings
    return next((float(settings[it]) for it in paths if isinstance(settings.get(it), (int, float))), None)


def array_name(state: str) -> str:
    """The array of a number of the state."""
    return state.replace(".", "_")
