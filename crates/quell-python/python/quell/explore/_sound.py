"""The sound of a study with and without dither."""

from __future__ import annotations

import io
import math
import os
import tempfile
import wave
from typing import Any

import numpy as np

from .._study import Study
from .._tables import Number
from ..results import Simulation
from ._answers import small_start, without_dither
from ._reading import Answer

SOUND_SECONDS = 2.0

SLOW_BAND = 1.9
"""Upper end of the band of slow vibration in ω₀, as in the response."""

QUANTUM = (1.0 / 32768.0) ** 2 / 12.0
"""Power of the rounding of samples of 16 bits: less is silence."""


def sound(study: Study) -> Answer:
    """The same run with and without dither as sound with the same gain, and the difference of their levels."""
    quiet = without_dither(study)
    until: Number | None = None
    start: Any = None
    if study._native.kind == "belt":
        until = SOUND_SECONDS * heard(study)
    elif study._native.kind == "disc":
        until, start = small_start(study)
    runs = {"with dither": study.simulate(until, start=start, samples=False, events=False, sound=True)}
    if quiet is not None:
        runs["without dither"] = quiet.simulate(until, start=start, samples=False, events=False, sound=True)
    gains = {name: gain_of(run) for name, run in runs.items()}
    known = [it for it in gains.values() if it]
    common = min(known, default=None)
    files = {}
    levels = {}
    slow = {}
    natural = next((it.facts["sound"].get("natural_frequency_hz") for it in runs.values() if it.facts.get("sound")), None)
    for name, run in runs.items():
        if common is not None and gains[name] != common:
            other = study if name == "with dither" else quiet
            assert other is not None
            run = other.simulate(until, start=start, samples=False, events=False, gain=common)
        files[name] = wave_of(run)
        levels[name] = level_of(files[name])
        if natural:
            slow[name] = level_of(files[name], SLOW_BAND * float(natural))
    return {"files": files, "levels": levels, "slow": slow, "gain": common}


def heard(study: Study) -> float:
    """Time of the study that a second of sound takes: seconds in SI, otherwise ω₀ sounds at 110 Hz."""
    return 1.0 if study.check().facts["system"] == "si" else 2.0 * math.pi * 110.0


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


def level_of(wave_file: bytes, below: float | None = None) -> float:
    """The level of the second half of a sound in dB re full scale; −∞ for silence.

    With ``below``, only frequencies above 0 and up to this one count, in Hz.
    """
    with wave.open(io.BytesIO(wave_file)) as file:
        samples = np.frombuffer(file.readframes(file.getnframes()), dtype="<i2").astype(np.float64) / 32768.0
        rate = file.getframerate()
    half = samples[samples.size // 2 :]
    if half.size == 0:
        return -math.inf
    if below is None:
        power = float(np.mean(half**2))
    else:
        window = np.hanning(half.size)
        lines = np.abs(np.fft.rfft(half * window)) ** 2
        frequency = np.fft.rfftfreq(half.size, 1.0 / rate)
        inside = (frequency > 0.0) & (frequency <= below)
        power = 2.0 * float(lines[inside].sum()) / (half.size * float(np.sum(window**2)))
    return 10.0 * math.log10(power) if power > QUANTUM else -math.inf
