"""The questions that a study asks: the least dither, what its actuator can give, how probable the vibration is."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from .._study import Study
from ..results import Result
from ._reading import Answer, said

TABLES = {"design": "design", "actuator": "actuator", "probability": "uncertainty"}
"""The table that asks the question of each verb."""


def asked(study: Study) -> list[str]:
    """The questions of a study, in the order in which they are shown."""
    tables = study._native.document()
    dithered = "dither" in tables
    return [verb for verb, table in TABLES.items() if table in tables and (dithered or verb == "probability")]


def shown(result: Result) -> Answer:
    """What an answer says, and its picture."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder) / "answer.svg"
        result.save(place)
        picture = place.read_text(encoding="utf-8")
    return {"picture": picture, **said(result)}


def design(study: Study) -> Answer:
    """The least dither over the operating points."""
    return shown(study.design())


def actuator(study: Study) -> Answer:
    """What the actuator can give, against what quenching needs."""
    return shown(study.actuator())


def probability(study: Study, progress: Any = None) -> Answer:
    """How probable the vibration is."""
    return shown(study.probability(progress=progress))
