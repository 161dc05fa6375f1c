"""The sound of a study with and without dither."""

from __future__ import annotations

import math
import os
import tempfile
from collections.abc import Mapping
from typing import Any

from .._study import Study
from .._tables import Number
from ..results import Simulation
from ._answers import start_of, without_dither
from ._reading import Answer
from ._spectra import loudness, small_start

SOUND_SECONDS = 2.0


def sound(study: Study, chosen: Mapping[str, float] | None = None) -> Answer:
    """The run of the pictures with and without dither as sound with the same gain, and the loudness of the steady response in words."""
    quiet = without_dither(study)
    until: Number | None = None
    start: Any = start_of(study, chosen)
    if study._native.kind == "belt":
        until = SOUND_SECONDS * heard(study)
    elif study._native.kind == "disc":
        until, start = small_start(study, chosen)
    runs = {"with dither": study.simulate(until, start=start, samples=False, events=False, sound=True)}
    if quiet is not None:
        runs["without dither"] = quiet.simulate(until, start=start, samples=False, events=False, sound=True)
    gains = {name: gain_of(run) for name, run in runs.items()}
    common = min((it for it in gains.values() if it), default=None)
    files = {}
    for name, run in runs.items():
        if common is not None and gains[name] != common:
            other = study if name == "with dither" else quiet
            assert other is not None
            run = other.simulate(until, start=start, samples=False, events=False, gain=common)
        files[name] = wave_of(run)
    same = "Both sounds begin where the picture begins, and have the same gain."
    told = f"{same} {loudness(study)['words']}" if quiet is not None else "The study has no dither: this is its only sound."
    return {"files": files, "gain": common, "words": told.strip()}


def heard(study: Study) -> float:
    """Time of the study that a second of sound takes: seconds in SI, otherwise ω₀ sounds at 110 Hz."""
    return 1.0 if study.check().facts["unit_system"] != "none" else 2.0 * math.pi * 110.0


def gain_of(run: Simulation) -> float | None:
    """The gain of the sound of a run, in the unit in which it is given."""
    found = run.facts.get("sound") or {}
    gain = next((found[it] for it in ("gain_s_per_m", "gain") if found.get(it)), None)
    return None if gain is None else float(gain)


def wave_of(run: Simulation) -> bytes:
    """The sound of a run as a WAV file."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "run.wav")
        run.save(path)
        with open(path, "rb") as file:
            return file.read()
