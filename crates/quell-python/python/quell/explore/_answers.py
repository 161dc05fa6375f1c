"""The answers of the explorer: functions from a study to plain arrays and words. Each can run in another process."""

from __future__ import annotations

import io
import math
import os
import tempfile
import wave
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import QuellError
from .._result import Result
from .._study import Study
from .._system import System
from .._tables import Number
from ..results import Simulation

Answer = dict[str, Any]
"""An answer: arrays, numbers and words by name."""

Progress = Callable[[int, int], object]
Array = npt.NDArray[np.float64]

SLOW_PERIODS = 20
"""Slow periods in a trajectory."""

FAST_PERIODS = 600
"""Most dither periods in a trajectory, which is shorter if the dither is fast."""

MOST_SAMPLES = 8000
LONGEST_SMALL = 150
"""Longest small motion of a disc, in slow periods."""

LARGEST_GROWTH = 1e3
"""Factor by which the small motion of a disc may grow."""

MOST_BINS = 1500
"""Most points of a spectrum; each is the largest of its bin."""

SOUND_SECONDS = 2.0
SLOW_BAND = 1.9
"""Upper end of the band of slow vibration in ω₀, as in the response."""

QUANTUM = (1.0 / 32768.0) ** 2 / 12.0
"""Power of the rounding of samples of 16 bits: less is silence."""

FLOOR_DB = -120.0
"""Least level that a spectrum shows."""


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


def friction_of_belt(study: Study) -> list[Answer]:
    """The friction law of a belt with and without averaging over the dither."""
    found = study.friction()
    law: Answer = {
        "name": "friction",
        "velocity": values(found, "slip_velocity"),
        "coefficient": values(found, "coefficient"),
        "unit": unit(found, "slip_velocity"),
        "effective": values(found, "effective_coefficient") if "effective_coefficient" in found.arrays else None,
        "sliding": number_of(study, "belt.belt_velocity", "belt.belt_velocity_m_per_s"),
    }
    return [law]


def number_of(study: Study, *paths: str) -> float | None:
    """The first of these numbers that the study has."""
    settings = study.settings
    return next((float(settings[it]) for it in paths if isinstance(settings.get(it), (int, float))), None)


SHARED_KEYS = ("law", "static_coefficient", "minimum_coefficient", "coefficient", "exponent", "constants", "terms")
VELOCITIES = {"reference_velocity": 1.0, "maximum_velocity": 1.0, "viscous": 1.0}


def contacts_of(study: Study, facts: Mapping[str, Any]) -> list[Answer]:
    """The friction law of each contact, with its average if its slip by the dither is a sine."""
    if not isinstance(study, System):
        return []
    found = []
    listed = facts.get("contacts") or []
    sine = all(dither.waveform == "sine" for dither in study.dithers) and len(study.dithers) == 1
    for contact, averages in zip(study.contacts, listed, strict=False):
        table = dict(getattr(contact.given.get("friction"), "given", {}) or {})
        name = str(contact.given["name"])
        speed = contact.given.get("belt_velocity", contact.given.get("belt_velocity_m_per_s"))
        slip = averages.get("slip_amplitude_m_per_s", averages.get("slip_amplitude"))
        law = curve_of(table, slip if sine else None, speed)
        if law is not None:
            si = any(key.endswith("_m_per_s") for key in (*table, *contact.given))
            found.append({**law, "name": name, "unit": "m/s" if si else "", "point": averages.get("effective_coefficient")})
    return found


def curve_of(table: Mapping[str, Any], slip: float | None, speed: object) -> Answer | None:
    """A friction law and its average over a sinusoidal slip velocity; ``None`` if it has formulas of parameters."""
    from .. import _toml

    scaled = {}
    for key, value in table.items():
        short = key.removesuffix("_m_per_s").removesuffix("_s_per_m")
        if short not in VELOCITIES and key not in SHARED_KEYS:
            return None
        scaled[short] = value
    # Friction depends on the velocity alone, so that a belt whose lengths per τ are these velocities has the same averages.
    text = "[belt]\ndamping_ratio = 0\nnormal_load = 1\nbelt_velocity = 1\n" + f"[friction]\n{lines_of(scaled, _toml)}"
    if slip:
        text += f'[dither]\ndirection = "tangential"\nwaveform = "sine"\namplitude = {float(slip)!r}\nfrequency_ratio = 1.0\n'
    try:
        found = Study.from_text(text).friction()
    except QuellError:
        return None
    return {
        "velocity": values(found, "slip_velocity"),
        "coefficient": values(found, "coefficient"),
        "effective": values(found, "effective_coefficient") if slip and "effective_coefficient" in found.arrays else None,
        "sliding": float(speed) if isinstance(speed, (int, float)) else None,
    }


def lines_of(table: Mapping[str, Any], toml: Any) -> str:
    """The lines of a table."""
    return "".join(f"{key} = {toml.value(value)}\n" for key, value in table.items())


def times(study: Study) -> tuple[float, float]:
    """The slow period and the shortest dither period of a study, in its unit of time; 0 without dither."""
    kind = study._native.kind
    if kind == "belt":
        facts = study.check().facts
        rate = natural_frequency(study, facts)
        ratios = [it["frequency_ratio"] for it in facts["dithers"] if it["amplitude"]]
        slow = 2.0 * math.pi / rate
        return slow, slow / max(ratios) if ratios else 0.0
    facts = study.stability().facts
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
    per_period = 16.0 * (end / fast if fast else end / slow * 4.0)
    return np.linspace(0.0, end, int(np.clip(per_period, 1500, MOST_SAMPLES)))


def pairs_of(run: Simulation, kind: str) -> list[tuple[str, str]]:
    """The pairs of state names that a phase plane can show: displacement and velocity."""
    if kind == "belt":
        return [("displacement", "velocity")]
    names = [str(it) for it in run.facts["state_names"]]
    found = [(it, f"velocity.{it}") for it in names if f"velocity.{it}" in names]
    return found or [(names[place], names[place + 1]) for place in range(len(names) - 1)]


def array_name(state: str) -> str:
    """The array of a number of the state."""
    return state.replace(".", "_")


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


QUANTITY = {"belt": "growth-sharper", "disc": "growth", "system": "growth"}
GRID = (44, 32)


def spaced(start: float, stop: float, count: int, logarithmic: bool) -> Array:
    """Values of an axis."""
    if logarithmic and start > 0.0:
        return np.geomspace(start, stop, count)
    return np.linspace(start, stop, count)


def plane(study: Study, across: tuple[str, float, float, bool], up: tuple[str, float, float, bool]) -> Answer:
    """The averaged growth rate over two parameters."""
    first, second = (spaced(it[1], it[2], count, it[3]) for it, count in zip((across, up), GRID, strict=True))
    quantity = QUANTITY[study._native.kind]
    found: Any = study.map(quantity, {across[0]: first, up[0]: second}, threads=1)
    name = quantity.replace("-", "_")
    return {
        "x": first,
        "y": second,
        "growth": values(found, name).T,
        "unit": unit(found, name),
        "tongues": tongues(study, across),
        "warnings": found.warnings,
    }


def tongues(study: Study, across: tuple[str, float, float, bool]) -> list[Answer]:
    """Speeds of a disc at which waves meet, with the edges of the tongue at its friction."""
    if study._native.kind != "disc" or across[0] != "disc.load.speed":
        return []
    facts = study.resonances(speeds=(max(0.0, across[1]), across[2])).facts
    both = [*((it, False) for it in facts["undithered"]), *((it, True) for it in facts["dithered"])]
    return [
        {"speed": it["speed"], "edges": it.get("edges"), "pair": it["pair"], "dithered": dithered}
        for it, dithered in both
        if it["can_be_unstable"] and it["speed"] > 0.0
    ]


def curves(study: Study, across: tuple[str, float, float, bool], up: tuple[str, float, float, bool]) -> Answer:
    """The exact thresholds in two parameters as curves."""
    found: Any = study.thresholds(up[0], up[1], up[2], along=across[0], between=(across[1], across[2]))
    exact = [{"x": np.array(twin(it, "along")), "y": np.array(twin(it, "value")), "kind": it["kind"]} for it in found.facts["curves"]]
    return {"curves": exact, "sentence": found.facts["sentence"], "warnings": found.warnings}


def twin(facts: Mapping[str, Any], name: str) -> Any:
    """A fact in SI, if it is there, otherwise as it is."""
    return next((value for key, value in facts.items() if key.startswith(f"{name}_")), facts[name])


def basins(study: Study, grid: tuple[int, int], progress: Progress | None = None) -> Answer:
    """The motions on which starts end."""
    found: Any = study.basins(grid=grid, threads=1, progress=progress)
    first, second = ("displacement", "velocity")
    plane_names = found.facts.get("plane")
    if plane_names:
        first, second = (str(it) for it in plane_names)
    x, y = values(found, array_name(first)), values(found, array_name(second))
    return {
        "x": x,
        "y": y,
        "ends": values(found, "attractor"),
        "words": [str(it["words"]) for it in found.facts["attractors"]],
        "quiet": [bool(it.get("quiet")) for it in found.facts["attractors"]],
        "fractions": [float(it["fraction"]) for it in found.facts["attractors"]],
        "names": (first, second),
        "units": (unit(found, array_name(first)), unit(found, array_name(second))),
        "sentence": found.facts["sentence"],
        "warnings": found.warnings,
    }


def eigenvalues(study: Study, parameter: str, start: float, stop: float) -> Answer:
    """Growth rates and frequencies of a system over a parameter."""
    found: Any = study.stability(parameter, start, stop)
    return {
        "parameter": values(found, "parameter"),
        "growth": values(found, "growth_rate"),
        "frequency": values(found, "frequency"),
        "unit": unit(found, "growth_rate"),
        "local": [float(it["value"]) for it in found.facts["local"]],
        "sentence": found.facts["sentence"],
        "warnings": found.warnings,
    }


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


TASKS: dict[str, Callable[..., Answer]] = {
    "averaged": averaged,
    "trajectory": trajectory,
    "response": response,
    "plane": plane,
    "curves": curves,
    "basins": basins,
    "eigenvalues": eigenvalues,
    "sound": sound,
}
"""Every answer by name."""

REPORTING = ("basins",)
"""Answers that report progress."""
