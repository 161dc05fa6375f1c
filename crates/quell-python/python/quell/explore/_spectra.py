"""The steady response of a study and its spectra with and without dither, and the one band in which loudness is compared."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .._study import Study
from ..results import NoiseResponse
from ._answers import pairs_of, start_of, times, without_dither
from ._moment import of_a_moment
from ._reading import Answer, Array, array_name, said, unit, values

MOST_BINS = 1500
"""Most points of a spectrum; each is the largest of its bin."""

MOST_SAMPLES = 4000
"""Samples of a run whose spectrum is computed here."""

FLOOR_DB = -120.0
"""Least level that a spectrum shows."""

LONGEST_SMALL = 150
"""Longest small motion of a disc, in slow periods."""

LARGEST_GROWTH = 1e3
"""Factor by which the small motion of a disc may grow."""


@of_a_moment
def response(study: Study) -> Answer:
    """The steady response with and without dither, and its spectrum in dB re the largest line of the band of E without dither."""
    if study._native.kind == "disc":
        return small_motion(study)
    found: Any = study.response()
    words = {**said(found), "loudness": loudness_of(study, found)}
    if isinstance(found, NoiseResponse):
        return {**spectra_of_noise(study, found), **words}
    frequency = values(found, "frequency")
    after, before = values(found, "spectrum_amplitude"), values(found, "spectrum_undithered_amplitude")
    own = unit(found, "frequency")
    in_hertz = own == "rad/s"
    per_unit = 2.0 * math.pi if in_hertz else 1.0
    frequency = frequency / per_unit
    end = band_end(found.facts, in_hertz)
    _, fast = times(study)
    rate = 2.0 * math.pi / per_unit / fast if fast else 0.0
    peaks = [it["frequency"] / per_unit for it in found.facts.get("peaks", [])]
    top = 1.3 * rate if rate else 1.5 * max(peaks, default=float(frequency[-1]))
    inside = frequency <= min(top, float(frequency[-1]))
    return {**in_db(frequency[inside], before[inside], after[inside], end), "unit": "Hz" if in_hertz else own, **words}


def band_end(facts: Mapping[str, Any], in_hertz: bool) -> float | None:
    """The upper end of the band of E in the unit of a spectrum, where it is known."""
    end = facts.get("band_end")
    return None if end is None else float(end) / (2.0 * math.pi if in_hertz else 1.0)


def loudness_of(study: Study, found: Any) -> str:
    """What dither does to the vibration in the band of E, in the numbers of the response."""
    facts = found.facts
    if "dither" not in study._native.document():
        return ""
    noise = isinstance(found, NoiseResponse)
    share = facts.get("residual_vibration_median") if noise else facts.get("residual_vibration")
    what = f"the vibration of the median run {band_of(facts)}" if noise else f"the steady vibration {band_of(facts)}"
    if share is None:
        why = found.why.get("residual_vibration", "")
        return f"How much dither changes {what} is unknown{f': {why}' if why else ''}."
    if share <= 0.0:
        return f"With dither, {what} is silent."
    level = 20.0 * math.log10(share)
    change = "as loud as without" if abs(level) < 0.5 else f"{abs(level):.0f} dB {'quieter' if level < 0.0 else 'louder'}"
    return f"With dither, {what} is {change} (E = {100.0 * share:.3g} %)."


def band_of(facts: Mapping[str, Any]) -> str:
    """The band of E in words."""
    end = facts.get("band_end")
    if end is None:
        return "below the dither"
    if facts.get("units", {}).get("band_end") != "rad/s":
        return f"below the angular frequency {float(end):.4g}"
    return f"below {float(end) / (2.0 * math.pi):.4g} Hz"


@of_a_moment
def loudness(study: Study) -> Answer:
    """The words about the loudness of a study."""
    if study._native.kind == "disc":
        return {"words": ""}
    return {"words": loudness_of(study, study.response())}


def binned(frequency: Array, levels: Sequence[Array]) -> tuple[Array, list[Array]]:
    """A spectrum with few points, each with the largest level of its bin."""
    count = frequency.size // max(1, math.ceil(frequency.size / MOST_BINS))
    size = frequency.size // max(count, 1)
    used = count * size
    return (
        frequency[:used].reshape(count, size).mean(axis=1),
        [level[:used].reshape(count, size).max(axis=1) for level in levels],
    )


def in_db(frequency: Array, before: Array, after: Array, end: float | None) -> Answer:
    """Two spectra in dB re the largest line of the first below ``end``, or of the second if the first is silent."""
    slow = (frequency > 0.0) & (frequency <= (math.inf if end is None else end))
    reference = float(before[slow].max(initial=0.0)) or float(after[slow].max(initial=0.0)) or 1.0
    at, (first, second) = binned(frequency, (before, after))
    with np.errstate(divide="ignore"):
        levels = [np.maximum(20.0 * np.log10(it / reference), FLOOR_DB) for it in (first, second)]
    return {"frequency": at, "before": levels[0], "after": levels[1], "band_end": end}


def of_runs(runs: Sequence[Any], at: Array, name: str) -> tuple[Array, list[Array]]:
    """Angular frequencies and amplitudes of the lines of runs over equal times."""
    window = np.hanning(at.size)
    frequency: Array = (2.0 * math.pi * np.fft.rfftfreq(at.size, float(at[1] - at[0]))).astype(np.float64)
    return frequency, [np.abs(np.fft.rfft(window * values(run, name))).astype(np.float64) for run in runs]


def spectra_of_noise(study: Study, found: NoiseResponse) -> Answer:
    """The spectra of the first run under noise, over its record, and of the same run without it."""
    settle, length = (found.facts.get(f"{name}_s", found.facts[name]) for name in ("settle", "record_length"))
    slow, fast = times(study)
    # The record is shorter if the noise is fast, with four samples for each of its shortest periods.
    length = min(length, 0.25 * MOST_SAMPLES * (fast or slow))
    at = np.linspace(settle, settle + length, MOST_SAMPLES)
    quiet = without_dither(study)
    runs = [one.simulate(t_eval=at, events=False) for one in (quiet, study) if one is not None]
    pairs = pairs_of(runs[-1], study._native.kind)
    name = array_name(max((it[0] for it in pairs), key=lambda it: float(np.ptp(values(runs[-1], array_name(it))))))
    frequency, lines = of_runs(runs, at, name)
    in_hertz = unit(runs[-1], "time") == "s"
    if in_hertz:
        frequency = frequency / (2.0 * math.pi)
    top = 1.3 * (2.0 * math.pi / (fast or slow)) / (2.0 * math.pi if in_hertz else 1.0)
    inside = frequency <= top
    end = band_end(found.facts, in_hertz)
    words = "Hz" if in_hertz else "ω₀" if study._native.kind == "belt" else ""
    return {**in_db(frequency[inside], lines[0][inside], lines[-1][inside], end), "unit": words}


def small_motion(study: Study) -> Answer:
    """The spectra of the motion of a disc from the same small start with and without dither."""
    end, start = small_start(study)
    at = np.linspace(0.0, end, MOST_SAMPLES)
    after: Any = study.simulate(t_eval=at, start=start)
    quiet = without_dither(study)
    before: Any = after if quiet is None else quiet.simulate(t_eval=at, start=start)
    pairs = pairs_of(after, "disc")
    name = array_name(max((it[0] for it in pairs), key=lambda it: float(np.ptp(values(after, array_name(it))))))
    frequency, spectra = of_runs((before, after), at, name)
    inside = frequency <= 4.0 * 2.0 * math.pi / times(study)[0]
    return {
        **in_db(frequency[inside], spectra[0][inside], spectra[1][inside], None),
        "unit": "ω_ref",
        **said(study.stability()),
        "loudness": "",
        "warnings": after.warnings,
    }


def small_start(study: Study, chosen: Any = None) -> tuple[float, dict[str, float]]:
    """The start of the small motion of a disc, and a time in which it stays small with and without dither."""
    quiet = without_dither(study) or study
    slow = times(quiet)[0]
    growth = max(quiet.stability().facts["growth_rate"] or 0.0, study.stability().facts["growth_rate"] or 0.0)
    end = min(LONGEST_SMALL * slow, math.log(LARGEST_GROWTH) / growth if growth > 0.0 else math.inf)
    return max(end, slow), start_of(study, chosen)
