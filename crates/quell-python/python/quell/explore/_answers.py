"""The answers about one motion: functions from a study to plain arrays and words. Each can run in another process."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from .._study import Study
from .._system import System
from ..results import Simulation
from ._friction import contacts_of, friction_of_belt
from ._moment import knot_times, of_a_moment, steady, varies
from ._reading import Answer, Array, array_name, number_of, said, unit, values

SLOW_PERIODS = 20
"""Slow periods in a trajectory."""

FAST_PERIODS = 600
"""Most dither periods in a trajectory, which is shorter if the dither is fast."""

PER_PERIOD = 28.0
"""Samples of a trajectory for each dither period."""

MOST_SAMPLES = 8000


@of_a_moment
def averaged(study: Study) -> Answer:
    """The averaged stability, and the friction laws with their averages under the dither."""
    found = study.stability()
    facts = found.facts
    growth = facts.get("growth_rate")
    laws = friction_of_belt(study) if study._native.kind == "belt" else contacts_of(study, facts)
    return {
        **said(found),
        "verdict": facts.get("verdict", "unknown"),
        "growth": growth,
        "criterion": facts.get("criterion"),
        "undithered": (facts.get("undithered") or {}).get("verdict"),
        "laws": laws,
    }


def times(study: Study) -> tuple[float, float]:
    """The slow period and the shortest dither period of a study, in its unit of time; 0 without dither."""
    kind = study._native.kind
    if kind == "belt":
        facts = study.check().facts
        rate = study._native.angular_frequency or 1.0
        rates = [highest(it) for it in facts["dithers"] if it["amplitude"]]
        return 2.0 * math.pi / rate, 2.0 * math.pi / max(rates) if rates else 0.0
    facts = steady(study)[0].stability().facts
    if kind == "disc":
        slow = 2.0 * math.pi / max(facts.get("frequency") or 1.0, 1e-3)
        return slow, 0.0
    motions = [it for it in facts.get("motions", []) if it.get("frequency")]
    rate = max(motions, key=lambda it: it["growth_rate"])["frequency"] if motions else 1.0
    fast = [frequency_of(it.given) for it in study.dithers] if isinstance(study, System) else []
    top = max((it for it in fast if it), default=0.0)
    return 2.0 * math.pi / rate, 2.0 * math.pi / top if top else 0.0


def highest(dither: Mapping[str, Any]) -> float:
    """The angular frequency of a dither, of noise the upper end of its band."""
    noise = dither.get("noise") or {}
    return float(max(noise.get("band", [dither["frequency"]])))


def frequency_of(dither: Mapping[str, Any]) -> float:
    """The angular frequency of a dither of a system, of noise the upper end of its band; 0 if it is a formula or a text."""
    hertz, rate = (dither.get(key, (dither.get(band) or [None])[-1]) for key, band in (("frequency_hz", "band_hz"), ("frequency", "band")))
    if isinstance(hertz, (int, float)):
        return 2.0 * math.pi * float(hertz)
    return float(rate) if isinstance(rate, (int, float)) else 0.0


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
    run: Any = study.simulate(t_eval=at, start=start_of(study, start))
    pairs = pairs_of(run, kind)
    if not 0 <= pair < len(pairs):
        spread = [float(np.ptp(values(run, array_name(first)))) for first, _ in pairs]
        pair = int(np.argmax(spread)) if spread else 0
    first, second = pairs[pair]
    time = values(run, "time")
    phase = next((it for it in run.arrays if it.endswith("_phase")), None)
    sticking = values(run, phase) == 1.0 if phase is not None else np.zeros(time.size, dtype=bool)
    events = [it for it in run.facts["events"] if it["contact"] == 0]
    moments_of = [float(it["time"]) for it in events]
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
        **said(run),
        "sliding": number_of(study, "belt.belt_velocity", "belt.belt_velocity_m_per_s") if kind == "belt" else None,
    }


def start_of(study: Study, chosen: Mapping[str, float] | None) -> Any:
    """Where the run of every picture, sound and file begins: the chosen start, or that of the study.

    That of a disc is its leading small motion, in numbers: a run without dither begins there too.
    """
    if study._native.kind != "disc":
        return dict(chosen) if chosen else None
    begin = study.simulate(times(study)[0], samples=False, events=False, start=dict(chosen) if chosen else None).facts
    numbers = zip(begin["state_names"], begin["start"]["state"], strict=True)
    return {str(name): float(value) for name, value in numbers}


def is_averaged(study: Study) -> bool:
    """Whether growth rates are averaged over a dither: those of a disc are exact."""
    return study._native.kind != "disc" and "dither" in study._native.document()


def without_dither(study: Study) -> Study | None:
    """The study with every dither at amplitude 0; ``None`` if it has no dither."""
    keys = [path for path in study.settings if path.split("[")[0].split(".")[0] == "dither"]
    paths = [path for path in keys if path.rsplit(".", 1)[-1].startswith("amplitude")]
    return study.set(dict.fromkeys(paths, 0)) if paths else None
