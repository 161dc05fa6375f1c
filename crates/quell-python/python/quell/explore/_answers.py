"""The answers about one motion: functions from a study to plain arrays and words. Each can run in another process."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .._study import Study
from .._system import System
from ..results import Simulation
from ._friction import contacts_of, friction_of_belt
from ._moment import knot_times, of_a_moment, steady, varies
from ._reading import Answer, Array, array_name, number_of, unit, values

SLOW_PERIODS = 20
"""Slow periods in a trajectory."""

FAST_PERIODS = 600
"""Most dither periods in a trajectory, which is shorter if the dither is fast."""

PER_PERIOD = 28.0
"""Samples of a trajectory for each dither period."""

MOST_SAMPLES = 8000

LONGEST_SMALL = 150
"""Longest small motion of a disc, in slow periods."""

LARGEST_GROWTH = 1e3
"""Factor by which the small motion of a disc may grow."""

MOST_BINS = 1500
"""Most points of a spectrum; each is the largest of its bin."""

FLOOR_DB = -120.0
"""Least level that a spectrum shows."""


@of_a_moment
def averaged(study: Study) -> Answer:
    """The averaged stability, and the friction laws with their averages under the dither."""
    found = study.stability()
    facts = found.facts
    growth = facts.get("growth_rate_per_s", facts.get("growth_rate"))
    laws = friction_of_belt(study) if study._native.kind == "belt" else contacts_of(study, facts)
    return {
        "sentence": facts.get("sentence", ""),
        "verdict": facts.get("verdict", "unknown"),
        "growth": growth,
        "criterion": facts.get("criterion"),
        "undithered": (facts.get("undithered") or {}).get("verdict"),
        "laws": laws,
        "warnings": found.warnings,
    }


def times(study: Study) -> tuple[float, float]:
    """The slow period and the shortest dither period of a study, in its unit of time; 0 without dither."""
    kind = study._native.kind
    if kind == "belt":
        facts = study.check().facts
        rate = natural_frequency(study, facts)
        ratios = [it["frequency_ratio"] for it in facts["dithers"] if it["amplitude"]]
        slow = 2.0 * math.pi / rate
        return slow, slow / max(ratios) if ratios else 0.0
    facts = steady(study)[0].stability().facts
    if kind == "disc":
        slow = 2.0 * math.pi / max(facts.get("frequency") or 1.0, 1e-3)
        return slow, 0.0
    motions = [it for it in facts.get("motions", []) if it.get("frequency")]
    rate = max(motions, key=lambda it: it["growth_rate"])["frequency"] if motions else 1.0
    fast = [frequency_of(it.given) for it in study.dithers] if isinstance(study, System) else []
    top = max((it for it in fast if it), default=0.0)
    return 2.0 * math.pi / rate, 2.0 * math.pi / top if top else 0.0


def frequency_of(dither: Mapping[str, Any]) -> float:
    """The angular frequency of a dither of a system; 0 if it is a formula or a text."""
    hertz, rate = dither.get("frequency_hz"), dither.get("frequency")
    if isinstance(hertz, (int, float)):
        return 2.0 * math.pi * float(hertz)
    return float(rate) if isinstance(rate, (int, float)) else 0.0


def natural_frequency(study: Study, facts: Mapping[str, Any]) -> float:
    """ω₀ of a belt in its unit of time: 1 if the study is dimensionless."""
    if facts["system"] != "si":
        return 1.0
    tables = (facts["belt"], facts.get("friction") or {}, *facts["dithers"])
    pairs = (("belt_velocity", "belt_velocity_m_per_s", 1.0), ("reference_velocity", "reference_velocity_m_per_s", 1.0))
    for table in tables:
        for scaled, measured, factor in (*pairs, ("frequency_ratio", "frequency_ratio_hz", 2.0 * math.pi)):
            if table.get(scaled) and table.get(measured):
                return float(factor * table[measured] / table[scaled])
    return 1.0


def moments(study: Study) -> Array:
    """Times at which a trajectory is sampled."""
    slow, fast = times(study)
    end = SLOW_PERIODS * slow
    if fast:
        end = max(min(end, FAST_PERIODS * fast), 3.0 * slow)
    if varies(study):
        # The whole course, and a little of what follows it.
        end = max(end, 1.1 * knot_times(study)[-1])
    wanted = PER_PERIOD * (end / fast if fast else end / slow * 4.0)
    return np.linspace(0.0, end, int(np.clip(wanted, 1500, MOST_SAMPLES)))


def pairs_of(run: Simulation, kind: str) -> list[tuple[str, str]]:
    """The pairs of state names that a phase plane can show: displacement and velocity."""
    if kind == "belt":
        return [("displacement", "velocity")]
    names = [str(it) for it in run.facts["state_names"]]
    found = [(it, f"velocity.{it}") for it in names if f"velocity.{it}" in names]
    return found or [(names[place], names[place + 1]) for place in range(len(names) - 1)]


def trajectory(study: Study, start: Mapping[str, float] | None, pair: int = -1) -> Answer:
    """A run from the start with its events and sticking intervals; ``pair`` selects the plane [default: the largest motion]."""
    kind = study._native.kind
    at = moments(study)
    asked: Any = dict(start) if start else None
    run: Any = study.simulate(t_eval=at, start=asked)
    pairs = pairs_of(run, kind)
    if not 0 <= pair < len(pairs):
        spread = [float(np.ptp(values(run, array_name(first)))) for first, _ in pairs]
        pair = int(np.argmax(spread)) if spread else 0
    first, second = pairs[pair]
    time = values(run, "time")
    phase = "sticking" if kind == "belt" else next((it for it in run.arrays if it.endswith("_phase")), None)
    sticking = values(run, phase) == 1.0 if phase is not None else np.zeros(time.size, dtype=bool)
    events = [it for it in run.facts["events"] if it["contact"] == 0]
    moments_of = [float(it.get("time_s", it["time"])) for it in events]
    return {
        "time": time,
        "x": values(run, array_name(first)),
        "v": values(run, array_name(second)),
        "sticking": sticking,
        "event_time": np.array(moments_of),
        "event_kind": [str(it["kind"]) for it in events],
        "names": (first, second),
        "pairs": [it[0] for it in pairs],
        "pair": pair,
        "units": (unit(run, "time"), unit(run, array_name(first)), unit(run, array_name(second))),
        "sentence": run.facts.get("sentence", ""),
        "sliding": number_of(study, "belt.belt_velocity", "belt.belt_velocity_m_per_s") if kind == "belt" else None,
        "warnings": run.warnings,
    }


def binned(frequency: Array, levels: Sequence[Array]) -> tuple[Array, list[Array]]:
    """A spectrum with few points, each with the largest level of its bin."""
    count = frequency.size // max(1, math.ceil(frequency.size / MOST_BINS))
    size = frequency.size // max(count, 1)
    used = count * size
    return (
        frequency[:used].reshape(count, size).mean(axis=1),
        [level[:used].reshape(count, size).max(axis=1) for level in levels],
    )


@of_a_moment
def response(study: Study) -> Answer:
    """The steady response with and without dither, and its spectrum in dB re the largest line without dither."""
    if study._native.kind == "disc":
        return small_motion(study)
    found = study.response()
    facts = found.facts
    name = "spectrum_frequency_hz" if "spectrum_frequency_hz" in found.arrays else "frequency"
    frequency = values(found, name)
    after, before = values(found, "spectrum_amplitude"), values(found, "spectrum_undithered_amplitude")
    _, fast = times(study)
    in_hertz = unit(found, name) == "Hz"
    rate = 1.0 / fast if in_hertz and fast else 2.0 * math.pi / fast if fast else 0.0
    if study._native.kind == "belt" and not in_hertz and fast:
        rate = 2.0 * math.pi / fast
    peaks = [it.get("frequency_hz", it["frequency"]) if in_hertz else it["frequency"] for it in facts.get("peaks", [])]
    top = 1.3 * rate if rate else 1.5 * max(peaks, default=float(frequency[-1]))
    inside = frequency <= min(top, float(frequency[-1]))
    return {
        **in_db(frequency[inside], before[inside], after[inside]),
        "unit": unit(found, name),
        "sentence": facts["sentence"],
        "effect": facts["effect"],
        "level_db": facts.get("level_db"),
        "settled": bool(facts.get("settled")) and bool(facts.get("undithered_settled")),
        "warnings": found.warnings,
    }


def in_db(frequency: Array, before: Array, after: Array) -> Answer:
    """Two spectra in dB re the largest line of the first, or of the second if the first is silent."""
    reference = float(before[1:].max(initial=0.0)) or float(after[1:].max(initial=0.0)) or 1.0
    at, (first, second) = binned(frequency, (before, after))
    with np.errstate(divide="ignore"):
        levels = [np.maximum(20.0 * np.log10(it / reference), FLOOR_DB) for it in (first, second)]
    return {"frequency": at, "before": levels[0], "after": levels[1]}


def small_motion(study: Study) -> Answer:
    """The spectra of the motion of a disc from the same small start with and without dither."""
    end, start = small_start(study)
    at = np.linspace(0.0, end, MOST_SAMPLES // 2)
    after: Any = study.simulate(t_eval=at, start=start)
    quiet = without_dither(study)
    before: Any = after if quiet is None else quiet.simulate(t_eval=at, start=start)
    pairs = pairs_of(after, "disc")
    name = array_name(max((it[0] for it in pairs), key=lambda it: float(np.ptp(values(after, array_name(it))))))
    window = np.hanning(at.size)
    frequency: Array = (2.0 * math.pi * np.fft.rfftfreq(at.size, float(at[1] - at[0]))).astype(np.float64)
    spectra: list[Array] = [np.abs(np.fft.rfft(window * values(run, name))).astype(np.float64) for run in (before, after)]
    inside = frequency <= 4.0 * 2.0 * math.pi / times(study)[0]
    words = study.stability().facts["sentence"]
    return {
        **in_db(frequency[inside], spectra[0][inside], spectra[1][inside]),
        "unit": "ω_ref",
        "sentence": words,
        "effect": "",
        "level_db": None,
        "settled": True,
        "warnings": after.warnings,
    }


def small_start(study: Study) -> tuple[float, dict[str, float]]:
    """A small start of a disc, that of its leading motion without dither, and a time in which it stays small."""
    quiet = without_dither(study) or study
    facts = quiet.stability().facts
    slow = times(quiet)[0]
    growth = max(facts["growth_rate"] or 0.0, study.stability().facts["growth_rate"] or 0.0)
    end = min(LONGEST_SMALL * slow, math.log(LARGEST_GROWTH) / growth if growth > 0.0 else math.inf)
    run = quiet.simulate(slow, samples=False, events=False)
    names, state = run.facts["state_names"], run.facts["start"]["state"]
    return max(end, slow), {str(name): float(value) for name, value in zip(names, state, strict=True)}


def without_dither(study: Study) -> Study | None:
    """The study with every dither at amplitude 0; ``None`` if it has no dither."""
    keys = [path for path in study.settings if path.split("[")[0].split(".")[0] == "dither"]
    paths = [path for path in keys if path.rsplit(".", 1)[-1].startswith("amplitude")]
    return study.set(dict.fromkeys(paths, 0)) if paths else None
