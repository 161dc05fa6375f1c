"""Results about steady sliding and small motions, and about the study itself."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import numpy.typing as npt

from .._frozen import FrozenDict, Records
from .._result import Result, numbers_of

if TYPE_CHECKING:
    from .._quell import NativeAnswer
    from .._study import Study

Verdict = Literal["stable", "unstable", "undecided"]


def written(
    result: Result, modes: Iterable[tuple[complex, Sequence[complex]]], path: str | os.PathLike[str], overwrite: bool
) -> str:
    """The modes of a result in a universal file."""
    from .._errors import StudyError, complaint
    from ..fe._uff_write import WrittenMode, write_modes

    facts = result.study.check().facts
    if "coordinates" not in facts:
        allowed = "a study of a system or a belt: the modes of a disc have no nodes; Study.convert writes it as a system"
        raise StudyError([complaint("to_universal_file", None, allowed, "usage")])
    names, points = points_of(result.study, facts["coordinates"])
    head = (result.study.title or "", str(facts.get("unit_system", "none")))
    found = []
    for rate, own in modes:
        shape = points @ np.array(own)
        largest = shape[np.argmax(np.abs(shape))] if shape.size else 0.0
        found.append(WrittenMode(rate, shape / largest if largest else shape))
    return write_modes(path, head, names, found, overwrite)


def points_of(study: Study, coordinates: list[str]) -> tuple[list[str], npt.NDArray[np.float64]]:
    """Names of the points of a structure, and the displacement of each for every coordinate."""
    from .._errors import StudyError, complaint

    document = study._document()
    system = document.get("system", {})
    if "mode" not in system and "modes" not in system and "component" not in system:
        return list(coordinates), np.eye(len(coordinates))
    if "mode" not in system or "component" in system:
        allowed = "a structure by coordinates or by [[system.mode]]: the modes of a file and of components are not written with their points"
        raise StudyError([complaint("to_universal_file", None, allowed, "usage")])
    modes = system["mode"]
    names = list(dict.fromkeys(name for mode in modes for name in mode["shape"]))
    is_scaled = system.get("normalisation") == "max"
    # The coordinate of a mode has the mass 1.
    sizes = [float(mode["modal_mass"]) ** -0.5 if is_scaled else 1.0 for mode in modes]
    columns = [[size * number_of(mode["shape"].get(name, 0.0)) for name in names] for size, mode in zip(sizes, modes, strict=True)]
    return names, np.array(columns).T


def number_of(entry: object) -> float:
    """An entry of a shape."""
    from .._errors import StudyError, complaint

    if isinstance(entry, (int, float)):
        return float(entry)
    raise StudyError([complaint("to_universal_file", entry, "shapes of numbers, not of formulas", "usage")])


class Check(Result):
    """The study in numbers."""

    verb = "check"
    coordinates: list[str]
    """Belt and system: names of the coordinates or states."""
    damping_ratios: list[float]
    """Belt and system: damping ratio of each coordinate alone; absent where one has no spring of its own."""
    contacts: Records
    """Belt and system: ``name``, ``normal_load``, ``belt_velocity``, ``tangential_stiffness`` and ``breakaway`` of each contact, whether
    ``normal`` and ``tangent`` are given, and its ``friction``: ``law``, its parameters, and the range of slip in which it holds; of a fit also
    its error. What varies in time has ``least_`` and ``largest_``."""
    unit_system: Literal["none", "SI", "mm-t-s"]
    """The units of the numbers."""
    title: str | None
    """Title of the study."""
    form: Literal["coordinates", "states"]
    """Belt and system: how the structure is given."""
    disc: FrozenDict[Any]
    """Disc: ``modes`` (their number), ``modes_from``, ``loads``, ``speed``, ``without``."""
    dither: FrozenDict[Any] | None
    """Disc: its dither."""
    dithers: Records
    """Belt and system: the waves of the dithers, each with its place, ``waveform``, ``amplitude``, ``frequency``, ``phase``, ``has_envelope``."""
    given_amplitudes: Records
    """Belt and system: amplitudes of the dither that are given by another size than a peak force: ``key``, ``value``, ``unit``,
    ``amplitude``, ``amplitude_unit``, and whether it is ``by_actuator``."""
    observe: list[float]
    """Belt and system: row of the observed displacement."""
    initial: str | list[float]
    """Belt and system: the initial state in words or numbers."""
    sweeps: Records
    """Axes of a map: ``parameter`` and its values."""


class Citations(Result):
    """Sources of the computations for a study, and corrections of their printed equations."""

    verb = "cite"
    sources: Records
    """``key``, ``reference``, and ``used``, the purpose."""
    corrections: Records
    """Errors in the print of a source, with the correct form."""
    bibtex: str
    """The sources as BibTeX entries."""


class FrictionCurve(Result):
    """The friction law of every contact and its average under the dither: arrays have one row for each contact and slip velocity (n,),
    those of a belt one row for each slip velocity."""

    verb = "friction"
    contacts: Records
    """``name``, ``surface_velocity``, the largest ``fast_velocity``, the ``law`` with its parameters and the range of slip in which it holds,
    and over ``slip_velocity``: ``coefficient``, ``effective_coefficient`` and ``effective_slope`` with their errors and whether the slope is
    ``effective_slope_one_sided``; measured also ``measured_verdict`` and ``measured_base``."""
    row: npt.NDArray[np.float64]
    """Number of each row."""
    contact_number: npt.NDArray[np.float64]
    """Contact of each row, counted from 0."""
    slip_velocity: npt.NDArray[np.float64]
    """v_r (n,), in the unit of the study."""
    coefficient: npt.NDArray[np.float64]
    """μ (n,); NaN at v_r = 0, where friction takes any value up to ±μ_s."""
    effective_coefficient: npt.NDArray[np.float64]
    """μ̄ (n,); NaN where it is undefined."""
    effective_slope: npt.NDArray[np.float64]
    """μ̄′ (n,) per unit of ``slip_velocity``; NaN where it is undefined."""

    @property
    def limit_effective_coefficient(self) -> npt.NDArray[np.float64] | None:
        """μ̄ (n,) in the limit of high dither frequency, R → ∞; ``None`` where no contact has it, as without dither."""
        found = self.arrays.get("limit_effective_coefficient")
        return None if found is None else found.values

    @property
    def limit_effective_slope(self) -> npt.NDArray[np.float64] | None:
        """Its slope (n,), in the same way."""
        found = self.arrays.get("limit_effective_slope")
        return None if found is None else found.values

    @property
    def measured_coefficient(self) -> npt.NDArray[np.float64] | None:
        """⟨f/N⟩ (n,) over a period of the steady response; NaN where it has no value, ``None`` without ``measured=True``."""
        found = self.arrays.get("measured_coefficient")
        return None if found is None else found.values

    @property
    def measured_stick_fraction(self) -> npt.NDArray[np.float64] | None:
        """Fraction of the period (n,) that this response sticks; ``None`` without ``measured=True``."""
        found = self.arrays.get("measured_stick_fraction")
        return None if found is None else found.values

    @property
    def measured_stable(self) -> npt.NDArray[np.float64] | None:
        """1 where this response is stable, 0 where it is unstable, NaN where that is not known; ``None`` without
        ``measured=True``."""
        found = self.arrays.get("measured_stable")
        return None if found is None else found.values


class DescribingFunction(Result):
    """Averaged friction of every contact under a slow sinusoid of its slip velocity; arrays have one row for each contact
    and velocity amplitude."""

    verb = "friction"
    balanced_contact: str | None
    """The contact whose amplitude the slow vibration has; ``None`` where harmonic balance does not hold."""
    limit_cycle_velocity: float | None
    """Velocity amplitude at this contact of the smallest stable limit cycle."""
    limit_cycle_amplitude: float | None
    """Its amplitude of the observed displacement."""
    limit_cycle_frequency: float | None
    """Its frequency."""
    limit_cycles: Records | None
    """Every limit cycle: ``velocity_amplitude``, ``velocity_amplitude_error``, ``amplitude``, ``frequency``, ``stable``."""
    small_growth_rate: float | None
    """Growth rate of small slow motions."""
    growth_rate: list[float] | None
    """Growth rate of slow motions at the amplitudes of this contact."""
    contacts: Records
    """``name``, ``slip_velocity``, ``normal_load``, ``small_gain``, and over ``velocity_amplitude``: ``mean_coefficient``, ``gain``
    with ``gain_error``, and ``undithered_gain``."""
    limit: FrozenDict[Any] | None
    """One mass under dither: ``small_gain``, ``limit_cycle_velocity``, ``limit_cycle_amplitude`` and ``limit_cycles`` in the limit of high
    dither frequency."""
    row: npt.NDArray[np.float64]
    """Number of each row."""
    contact_number: npt.NDArray[np.float64]
    """Contact of each row, counted from 0."""
    velocity_amplitude: npt.NDArray[np.float64]
    """Velocity amplitude (n,) of the sinusoid."""
    mean_coefficient: npt.NDArray[np.float64]
    """Mean of the averaged coefficient (n,)."""
    gain: npt.NDArray[np.float64]
    """Describing function (n,), per unit of velocity."""
    undithered_gain: npt.NDArray[np.float64]
    """The same without dither (n,)."""


class Design(Result):
    """The least dither that is quiet over a box of operating points; arrays over the choices that were tried (n,)."""

    verb = "design"
    feasible: bool | None
    """Whether one dither is quiet in the whole box and keeps every limit; ``None`` where the search failed on the way."""
    waveform: str
    """Its waveform."""
    place: str | None
    """Where it acts; ``None`` without ``places`` in ``[design]``."""
    minimise: str
    """What is to be small."""
    critical: FrozenDict[float] | None
    """The exact least dither by paths; ``None`` where no dither is allowed."""
    parameters: FrozenDict[float] | None
    """The dither that was verified, 0.1 % above the least one or at the end of its range; where no dither is allowed, that of ``covered``."""
    averaged: FrozenDict[float] | None
    """The least dither by averaging alone."""
    objective: float | None
    """The objective of the exact least dither."""
    binding: list[str] | None
    """Names of the limits that are used wholly, and paths of numbers at an end of their range."""
    worst: FrozenDict[float] | None
    """The operating point that decides."""
    margin: float | None
    """Share by which the verified amplitude exceeds the least one."""
    quiet: bool | None
    """Whether the verified dither is quiet: no slow vibration, and a residual vibration E below 0.05."""
    residual_vibration: float | None
    """The residual vibration E on the base response where it is largest; 0 of a dither that repeats above the band of the vibration."""
    level_db: float | None
    """20 lg E."""
    tone_frequency: float | None
    """Frequency of the strongest line of that response; ``None`` of a dither that repeats above the band of the vibration."""
    tone_amplitude: float | None
    """Its amplitude."""
    loud_from: float | None
    """The larger amplitude from which it vibrates again somewhere in the box; ``None`` where no amplitude of the range does."""
    verified: FrozenDict[Any] | None
    """``protocol``, ``multiplier`` (of a disc ``growth_rate`` too) and ``point`` of the deciding operating point, the
    ``largest_multiplier``, and the number of ``operating_points``."""
    confident: FrozenDict[Any] | None
    """The dither that is quiet in the share ``confidence`` of ``samples``: its ``parameters``, ``amplitude`` with its 95 % interval
    from ``low`` to ``high``, ``over_least``, ``objective``, ``limits`` and whether they are kept (``allowed``); samples whose threshold
    is ``exact``, ``never_quiet``, ``loud_again`` by averaging, ``unknown`` or ``invalid``. ``None`` without ``confidence`` in
    ``[design]``."""
    friction_loss: float | None
    """The largest share of the mean friction that is lost, on exact responses."""
    drive: FrozenDict[Any] | None
    """What the verified dither demands of the actuator: ``force``, ``displacement``, ``voltage`` and ``current``, each as ``peak``,
    ``rms`` and ``peak_to_peak``; ``samples_per_period``; how far each limit is ``used`` (``rated``); the operating ``point``."""
    limits: Records
    """How far each limit is ``used``."""
    frontier: Records
    """The least objective by averaging against each ``limit`` and its ``value``."""
    basins: Records
    """The local minima that were found by averaging: ``parameters`` and ``objective``."""
    waveforms: Records
    """The answer of each dither that was tried: ``waveform``, of a burst ``on`` and ``off``, ``place``, ``feasible``, ``critical``,
    ``objective``."""
    covered: FrozenDict[list[float]] | None
    """Where no dither is allowed: the largest part of the box that one dither serves."""
    examined: FrozenDict[Any] | None
    """What was examined of it: the number of ``points``, all of which the dither serves, the ``largest_gap`` between two of them, and
    what is ``below`` and ``above`` it: ``"not examined"`` where the box ends, ``"loud"``, the name of a limit that is exceeded, or
    ``None`` where that is unknown."""
    response_rms: float | None
    """Root mean square of the observed displacement about its mean, on the exact responses to the verified dither: the largest of the
    box."""
    response_peak: float | None
    """Half of its range, the largest of the box."""
    schedule: Records | None
    """For a box of one coordinate the exact least dither at 33 operating points: the coordinate by its path, ``amplitude``,
    ``objective``."""
    saved_by_schedule: float | None
    """Share of the objective that such a dither saves on average."""
    sensitivity: FrozenDict[float | None] | None
    """Exact derivative of the least amplitude with respect to each number of the study by its path, at the operating point that decides:
    the unit of the amplitude per unit of the number. ``None`` where the amplitude is that of runs from a start."""
    sensitivity_relative: FrozenDict[float | None] | None
    """The same as percents of amplitude per percent of the number."""
    threshold: FrozenDict[Any] | None
    """``kind`` of the threshold that decides, and the one that it ``meets`` at a tip."""
    number: npt.NDArray[np.float64]
    """Number of each choice (n,)."""
    amplitude: npt.NDArray[np.float64]
    """Amplitude of each choice (n,); numbers that are searched have arrays of their keys."""
    dither_frequency_ratio: npt.NDArray[np.float64]
    """Frequency ratio of each choice (n,), if it is searched."""
    dither_frequency_hz: npt.NDArray[np.float64]
    """Frequency of each choice (n,) in Hz, if it is searched."""
    used: npt.NDArray[np.float64]
    """Largest use of a limit at each choice (n,): at most 1 where every limit is kept."""


class Actuator(Result):
    """What the actuator can give over the frequency of the dither, and what quenching needs; arrays over the frequency (n,), with the largest
    slip velocity of the dither at each contact, at the largest amplitude, in ``slip_of_`` and its name."""

    verb = "actuator"
    kind: str
    """Kind of actuator."""
    dither: str
    """Table of the dither, such as "dither"."""
    waveform: str
    """Its waveform."""
    can_quench: bool
    """Whether the actuator suffices anywhere in the range."""
    quiet_without: bool
    """Whether steady sliding is stable without this dither."""
    sufficient: Records
    """Where the actuator suffices: ``from``, ``to``, and the ``best`` frequency with its ``margin``, ``amplitude``, ``needed``, ``limit``
    and ``contacts``."""
    best: FrozenDict[Any] | None
    """The largest margin of the range: ``frequency``, ``amplitude``, ``limit``, ``needed``, ``margin``, ``contacts``."""
    own: FrozenDict[Any]
    """The same at the frequency of the study, with its ``given`` amplitude, the share of the largest one that is ``used``, and its
    ``drive``."""
    binding: Records
    """Which ``limit`` binds ``from`` one frequency ``to`` another."""
    from_: float
    """Lower end of the range of frequencies."""
    to: float
    """Upper end of the range of frequencies."""
    changes: Records
    """Each ``frequency`` at which the limit changes: the one ``below`` and the one ``above``."""
    resonances: Records
    """Frequencies at which little dither suffices, and whether each ``helps``."""
    slip_of_belt: npt.NDArray[np.float64]
    """Belt: largest slip velocity of the dither (n,), at the largest amplitude."""
    frequency: npt.NDArray[np.float64]
    """Angular frequency of the dither (n,), in the unit of the study; without units over ω₀ of a belt, which is R."""
    amplitude: npt.NDArray[np.float64]
    """Largest amplitude that the actuator can give (n,); NaN where it is unknown."""
    needed: npt.NDArray[np.float64]
    """Least amplitude that quenches by averaging (n,); NaN where none does."""
    margin: npt.NDArray[np.float64]
    """The largest amplitude over the least one (n,)."""
    voltage: npt.NDArray[np.float64]
    """Peak of the voltage about its mean at the largest amplitude (n,), in V."""
    current: npt.NDArray[np.float64]
    """Peak of the current about its mean at the largest amplitude (n,), in A."""
    stroke: npt.NDArray[np.float64]
    """Peak-to-peak displacement of the driven point at the largest amplitude (n,)."""

    @property
    def limit(self) -> npt.NDArray[np.str_]:
        """Name of the limit that binds (n,)."""
        return self.arrays["limit"].words()


class Probability(Result):
    """How probable it is that a study vibrates; arrays over shares of the samples (n,)."""

    verb = "probability"
    start: str
    """What decides: "averaged", "local", "rest" or "squeal"."""
    samples: int
    """Number of samples."""
    seed: int
    """Seed of the random numbers."""
    probability: float | None
    """Share of the samples that vibrate."""
    low: float | None
    """Lower end of its 95 % interval."""
    high: float | None
    """Upper end of its 95 % interval."""
    confidence: float
    """Confidence of the interval."""
    vibrating: int
    """Samples that vibrate."""
    quiet: int
    """Samples that do not."""
    unknown: int
    """Samples whose verdict is unknown; the interval includes both verdicts."""
    limit: FrozenDict[Any]
    """Of a dithered belt, in the limit of high dither frequency: ``quantiles``, ``indices`` and, judged by averaging, ``probability``,
    ``low``, ``high``, ``vibrating``, ``quiet`` and ``unknown``."""
    quantiles: FrozenDict[FrozenDict[float]]
    """Quantiles 0.05, 0.5 and 0.95 of the growth rate, ``growth``."""
    thresholds: Records
    """The least ``amplitude`` of the first dither that is enough for a ``share`` of the samples: 0.05, 0.5 and 0.95."""
    indices: FrozenDict[FrozenDict[float | None]]
    """Sobol indices of the growth rate by path: ``first`` and ``total`` with their standard errors."""
    groups: Records
    """Indices of each group of correlated numbers, ``of``."""
    invalid: int
    """Samples that are no valid studies and are left out."""
    share: npt.NDArray[np.float64]
    """Share of the samples (n,) up to each growth rate."""
    growth: npt.NDArray[np.float64]
    """Growth rate (n,), ascending."""


class Waveforms(Result):
    """The least dither of each waveform that quenches, and its cost; arrays over the waveforms (n,)."""

    verb = "waveforms"
    carrier: str
    """Carrier of the bursts."""
    waveforms: Records
    """Each waveform: ``waveform``, ``label``, ``own``, ``duty_cycle``; whether averaging cannot rank it (``slow``); by averaging ``amplitude``,
    ``root_mean_square``, ``power``, ``stroke``, ``velocity``, ``until``; at the exact amplitude the same with ``exact_``; of bursts ``on``
    and ``off``."""
    ranked_by: str
    """What ranks the waveforms: "exact", or "averaging" where none has an exact amplitude."""
    best: FrozenDict[str | None]
    """Label of the waveform that is smallest in amplitude, rms force, power, stroke and velocity, of those that are ranked."""
    number: npt.NDArray[np.float64]
    """Number of each waveform (n,)."""
    waveform: npt.NDArray[np.uint8]
    """Code of each waveform (n,)."""
    amplitude: npt.NDArray[np.float64]
    """Least amplitude by averaging (n,), in the unit of the study; NaN where no amplitude quenches."""
    root_mean_square: npt.NDArray[np.float64]
    """Root mean square of that force (n,)."""
    power: npt.NDArray[np.float64]
    """Mean power into the structure without friction, of a system into the sliding structure (n,)."""
    stroke: npt.NDArray[np.float64]
    """Peak-to-peak displacement of the mass without friction, of a system at the driven point (n,)."""

    @property
    def duty_cycle(self) -> npt.NDArray[np.float64] | None:
        """Share of the period in which the dither acts (n,): 1 except for bursts."""
        found = self.arrays.get("duty_cycle")
        return None if found is None else found.values

    @property
    def velocity(self) -> npt.NDArray[np.float64] | None:
        """Belt: largest velocity of the structure without friction (n,)."""
        found = self.arrays.get("velocity")
        return None if found is None else found.values

    @property
    def exact_amplitude(self) -> npt.NDArray[np.float64] | None:
        """Belt: exact least amplitude at the study's frequency (n,); NaN where it is unknown."""
        found = self.arrays.get("exact_amplitude")
        return None if found is None else found.values


class Stability(Result):
    """Stability of steady sliding by eigenvalues of small motions, under dither by averaging."""

    verb = "stability"
    verdict: Verdict
    """Whether small motions decay."""
    protocol: str
    """Method: "averaged", "linearised" or "floquet"."""
    critical_amplitudes: Records | None
    """Every amplitude of the first dither at which the verdict changes: ``amplitude``, ``amplitude_error``, ``kind``, ``becomes``, …"""
    growth_rate: float | None
    """Largest growth rate, per unit of time."""
    growth_rate_db_per_s: float | None
    """The same in decibels per second, of a study with units."""
    growth_rate_error: float | None
    """Bound on the error of the growth rate."""
    frequency: float | None
    """Angular frequency of the motion that grows fastest or decays slowest."""
    motions: Records
    """``growth_rate``, ``frequency``, ``damping_ratio``, ``error``, ``shape`` and ``friction_work`` of each motion."""
    contacts: Records
    """``name``, ``friction``, ``normal``, ``slip_amplitude``, ``effective_coefficient``, … of each contact."""
    undithered: FrozenDict[Any] | None
    """``verdict``, ``growth_rate`` and ``frequency`` without dither."""
    criterion: float | None
    """One mass: 2ζ + Fμ̄′ (2.26), stable where positive."""
    unstable_surface_velocities: Records | None
    """One mass: ``lower``, ``lower_kind`` and ``upper`` of each range of surface velocities in which sliding is unstable."""
    limit: FrozenDict[Any] | None
    """One mass: the averages of the dissertation, in the limit of high dither frequency, R → ∞ (2.26); ``None`` without dither."""
    everywhere_stable_amplitude: float | None
    """One mass: amplitude from which on sliding is stable at any surface velocity."""
    everywhere_stable_amplitude_ratio: float | None
    """One mass: the same over the angular frequency: a velocity."""
    unstable_modes: list[int]
    """Disc: modes that grow."""
    critical_speeds: Records
    """Disc: ``mode``, ``diameters``, ``speed`` of each critical speed, and whether the speed of the study is ``near``."""
    speed: float
    """Disc: speed of the loads."""
    speed_at_load: float
    """Disc with units and a radius of the first load: speed of the surface there."""
    without: list[str]
    """Disc: contributions that were left out."""
    changes: Records | None
    """Disc: ``friction`` and ``frequency`` of each motion that is marginal at a friction of the load."""
    changes_up_to: float | None
    """Disc: the friction up to which ``changes`` are known; ``None`` where those of every size are."""
    out_of_reach: bool
    """Disc: whether no dither of this kind can change the verdict."""

    @property
    def eigenvalues(self) -> npt.NDArray[np.complex128]:
        """System: the eigenvalues (n,), those with the largest growth rate first."""
        return numbers_of(self._named("eigenvalues"))

    def to_universal_file(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> str:
        """Writes the small motions of a system, friction carried along, as complex modes: data set 55 of a universal file.

        Coordinates that are named by node and direction (``n1204_x``) keep both; others become the x of nodes of their own, which the
        file names. Eigenvalues are λ with e^λt; modal A and B are left at 0, and shapes have the largest entry 1. Six digits are kept.

        Returns
        -------
        str
            The path.

        Raises
        ------
        quell.StudyError
            A study of a disc; the file exists, or cannot be written.
        """
        shapes = [[complex(*entry) for entry in it["shape"]] for it in self.motions]
        rates = [complex(it["growth_rate"], it["frequency"]) for it in self.motions]
        return written(self, zip(rates, shapes, strict=True), path, overwrite)


class TrackedStability(Result):
    """Eigenvalues of a system over a parameter, and its thresholds.

    The dataset has ``growth_rate`` and ``frequency`` over ``parameter`` and ``branch``; with a second parameter their names begin
    with ``eigenvalues_``, and ``curve``, ``kind`` and both parameters are those of the points of the curves.
    """

    verb = "stability"
    protocol: str
    """Method: "linearised", or "averaged" under dither."""
    parameter: str
    """Path of the parameter."""
    local: Records
    """``value`` with its ``error``, ``kind`` ("hopf", "divergence", "coalescence", "jump"), ``frequency``, and the verdicts below
    and above it, ``was`` and ``becomes``, which are equal where two frequencies merge without a change."""
    thresholds: Records
    """The same list."""
    at_from: FrozenDict[Verdict | None]
    """The verdict at the first value."""
    covered: bool
    """Whether every value of the range has an answer."""
    resumes: bool
    """Whether the last value has an answer again, after a range without one."""
    rests: Records
    """``value`` at which the surface of a ``contact`` comes to rest: friction reverses there, and there is no steady sliding."""
    unknown: Records
    """``from`` and ``to`` of ranges without an answer, and ``why``."""
    from_: float
    """First value of the parameter."""
    to: float
    """Last value of the parameter."""
    points: int
    """Number of values at which eigenvalues were computed."""
    along: str
    """Path of the second parameter."""
    between: list[float]
    """First and last value of the second parameter."""
    curves: Records
    """``kind``, ``value`` (n,), ``along`` (n,), ``error`` (n,), ``frequency`` (n,), ``was`` and ``becomes`` of each curve."""
    branch: npt.NDArray[np.float64]
    """Number of each eigenvalue."""
    growth_rate: npt.NDArray[np.float64]
    """Growth rate over the parameter and the branch."""
    frequency: npt.NDArray[np.float64]
    """Angular frequency over the parameter and the branch."""
    eigenvalues_growth_rate: npt.NDArray[np.float64]
    """Growth rate, with a second parameter."""
    eigenvalues_frequency: npt.NDArray[np.float64]
    """Angular frequency, with a second parameter."""
    point: npt.NDArray[np.float64]
    """Number of each point (n,) of the curves."""
    curve: npt.NDArray[np.float64]
    """Curve of each point (n,)."""
    kind: npt.NDArray[np.uint8]
    """Code of the kind of threshold at each point (n,)."""


class ExactStability(Result):
    """Stability of the dithered motion of a system in pure slip, by its Floquet exponents."""

    verb = "stability"
    verdict: Verdict
    """Whether small deviations decay."""
    protocol: str
    """Method: "floquet"."""
    growth_rate: float
    """Largest growth rate."""
    growth_rate_error: float
    """Bound on its error."""
    frequency: float
    """Frequency of that deviation, up to multiples of the frequency of the motion."""
    period: float
    """Period of the motion."""
    state: list[float]
    """State at time 0: displacements, velocities, further states."""
    residual: float
    """Distance of the state from itself after one period."""
    exponents: Records
    """``growth_rate``, ``growth_rate_error``, ``frequency`` and ``multiplier`` of each exponent."""

    @property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """The multipliers (n,), in the order of the exponents."""
        return numbers_of([it["multiplier"] for it in self.exponents])


class Modes(Result):
    """Natural frequencies and shapes of a disc or of a system."""

    verb = "modes"
    modes: Records
    """Disc: ``radial``, ``diameters``, ``frequency_parameter`` (k²), ``ratio``, ``frequency``, ``shape_at_load``, ``damping``, …
    System: ``frequency``, ``damping_ratio``, ``shape``, ``shape_imaginary``, with the springs of contacts and without friction."""
    critical_mode: FrozenDict[int] | None
    """Disc: the mode with the lowest critical speed."""
    coordinates: list[str]
    """System: names of the coordinates of the shapes."""

    def to_universal_file(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> str:
        """Writes the modes of a system as complex ones: see :meth:`Stability.to_universal_file`."""
        shapes = [
            # Discs have shapes of another kind, and are refused.
            [complex(a, b) for a, b in zip(it["shape"], it["shape_imaginary"], strict=True)]
            for it in self.modes
            if "shape_imaginary" in it
        ]
        sizes = [(it["frequency"], it["damping_ratio"]) for it in self.modes if "shape_imaginary" in it]
        rates = [complex(-ratio * size, size * max(0.0, 1.0 - ratio**2) ** 0.5) for size, ratio in sizes]
        return written(self, zip(rates, shapes, strict=True), path, overwrite)

    reference_frequency: float
    """Disc: frequency parameter k² of ω_ref."""
    reference: float | None
    """Disc: ω_ref in rad/s."""
    plate_mass: float | None
    """Disc: mass of the plate, in kg."""
    mode: npt.NDArray[np.float64]
    """Number of each mode (n,)."""
    frequency: npt.NDArray[np.float64]
    """System: angular frequency (n,)."""
    damping_ratio: npt.NDArray[np.float64]
    """System: damping ratio (n,)."""
    radial: npt.NDArray[np.float64]
    """Disc: number of nodal circles (n,)."""
    diameters: npt.NDArray[np.float64]
    """Disc: number of nodal diameters (n,)."""
    frequency_parameter: npt.NDArray[np.float64]
    """Disc: k² (n,)."""
    ratio: npt.NDArray[np.float64]
    """Disc: frequency over ω_ref (n,)."""
    frequency_hz: npt.NDArray[np.float64]
    """Disc with units: frequency (n,) in Hz."""
    shape_at_load: npt.NDArray[np.float64]
    """Disc: shape at the first load (n,)."""
    damping: npt.NDArray[np.float64]
    """Disc: damping (n,)."""


class Receptance(Result):
    """Displacement over force between rows, over frequency.

    The dataset has ``re`` and ``im`` over ``output``, ``input`` and ``frequency``.
    """

    verb = "receptance"
    contacts: Literal["sliding", "springs", "none"]
    """What the contacts are: sliding with friction, springs without friction, or none."""
    verdict: Verdict
    """Whether small motions decay; where they grow, no measurement shows these responses."""
    outputs: list[str]
    """Names of the rows whose displacements are given."""
    inputs: list[str]
    """Names of the rows along which forces act."""
    from_: float
    """Least angular frequency."""
    to: float
    """Largest angular frequency."""
    points: int
    """Number of frequencies."""
    receptances: Records
    """``output``, ``input``, ``largest`` (the largest magnitude) and its ``frequency`` of each pair."""
    frequency: npt.NDArray[np.float64]
    """Angular frequencies (n,)."""
    output: npt.NDArray[np.uint8]
    """Number of each output (n,)."""
    input: npt.NDArray[np.uint8]
    """Number of each input (n,)."""
    re: npt.NDArray[np.float64]
    """Real part over output, input and frequency; NaN at an undamped resonance."""
    im: npt.NDArray[np.float64]
    """Imaginary part over output, input and frequency; NaN at an undamped resonance."""

    @property
    def receptance(self) -> npt.NDArray[np.complex128]:
        """The receptances over output, input and frequency, complex."""
        found: npt.NDArray[np.complex128] = self.re + 1j * self.im
        return found

    def to_universal_file(self, path: str | os.PathLike[str], *, overwrite: bool = False) -> str:
        """Writes the receptances as data sets 58 of a universal file: frequency response functions over hertz, with double precision.

        Rows that are named by node and direction (``n1204_x``) keep both; others become the x of nodes of their own, and the entity
        names of the functions have the beginning of their names. The data set has room for six digits of a frequency: the receptances
        are those at the frequencies that it has. Frequencies without a value are left out.

        Returns
        -------
        str
            The path.

        Raises
        ------
        quell.StudyError
            The file exists, or cannot be written; a study without units, whose frequencies are not in hertz.
        """
        from .._errors import StudyError, complaint
        from ..fe._uff_write import write_functions

        units = str(self.study.check().facts.get("unit_system", "none"))
        if units == "none":
            allowed = "a study with units: the frequencies of data set 58 are in hertz"
            raise StudyError([complaint("to_universal_file", None, allowed, "usage")])
        # The data set has room for six digits of a frequency.
        hertz = np.unique([float(f"{one:.5e}") for one in self.frequency / (2.0 * np.pi)])
        same = self.study.receptance(
            outputs=self.outputs, inputs=self.inputs, contacts=self.contacts, at=[f"{one!r}Hz" for one in hertz.tolist()]
        )
        found = same.receptance
        pairs = {(a, b): found[i, j] for i, a in enumerate(self.outputs) for j, b in enumerate(self.inputs)}
        return write_functions(path, (self.study.title or "", units), hertz, pairs, overwrite)


class Resonances(Result):
    """Meetings of the waves of a disc, or responses of the contacts of a system to its dithers."""

    verb = "resonances"
    responses: Records
    """System: ``dither``, ``contact`` and ``extremes`` of each pair: ``kind`` ("peak" or "dip"), ``frequency``,
    ``slip_per_amplitude``, ``out_of_reach``, ``reversal_amplitude``. The dataset has the slip over ``frequency``."""
    undithered: Records
    """Disc: meetings without dither, with the keys of ``dithered``."""
    dithered: Records
    """Disc: ``speed``, ``waves``, ``pair_can_be_unstable`` (at the order of the theory), ``threshold``, ``edges``, ``peak_growth`` of
    each meeting."""
    growing: Records | None
    """Disc: the speeds in which a motion grows by the exact equations at the study's friction: ``from``, ``to``, ``peak_speed``,
    ``peak_growth``, and ``explained_by``: "wave", "pair" (its ``pair`` and ``order``), or "none" where three waves or more grow
    together; ``None`` and ``why`` where the exponents are not known."""
    friction: float
    """Disc: friction f* of the study."""
    speeds: list[float]
    """Disc: range of speeds in which meetings are listed, in ω_ref."""
    order: str
    """Disc: order of the theory in the friction."""
    clear: FrozenDict[Any]
    """Disc: ``clear`` and ``blocked`` intervals of R for the ``speeds`` that should be kept clear, the best R (``suggestion``) with
    its ``verified_growth_rate``, the result of the exact equations for it (``verified``: ``verdict``, which is "stable" if nothing
    grows, "unstable" or "undecided", ``growth_rate``, ``growth_rate_error`` and its ``speed``; or ``None``, and ``why``), the frequencies that were
    tested by the exact equations (``tested``), and the meetings in the range, ``there``, each with ``reaches_in``. The intervals are
    those of first order."""
    from_: float
    """System: least frequency."""
    to: float
    """System: largest frequency."""
    frequency: npt.NDArray[np.float64]
    """System: angular frequency (n,) of the dither."""
    meeting: npt.NDArray[np.float64]
    """Disc: number of each meeting (n,)."""
    speed: npt.NDArray[np.float64]
    """Disc: speed (n,) at which the waves meet."""
    harmonic: npt.NDArray[np.float64]
    """Disc: harmonic (n,) of the dither, 0 without dither."""
    pair_can_be_unstable: npt.NDArray[np.float64]
    """Disc: 1 where a pair of waves can be unstable (n,), at the order of the theory."""
    threshold: npt.NDArray[np.float64]
    """Disc: friction (n,) from which it is unstable."""
    lower_edge: npt.NDArray[np.float64]
    """Disc: lower end (n,) of the unstable speeds."""
    upper_edge: npt.NDArray[np.float64]
    """Disc: upper end (n,) of the unstable speeds."""
    peak_growth: npt.NDArray[np.float64]
    """Disc: largest growth rate (n,)."""
