"""Results over parameters or starts: thresholds, sweeps, basins, maps."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _dataset
from .._errors import StudyError, complaint
from .._frozen import FrozenDict, Records, frozen
from .._result import Result

if TYPE_CHECKING:
    from .._study import Study


class Thresholds(Result):
    """Values of a parameter at which the response changes."""

    verb = "thresholds"
    parameter: str
    """Path of the parameter."""
    local: Records
    """``value`` with its ``error``, ``kind``, ``was``, ``becomes``; under dither or with runs the ``state`` there, ``displacement`` and
    ``velocity`` of what is observed, and the multipliers on both sides, ``radius_below`` and ``radius_above``.

    Kinds are "neimark-sacker", "hopf", "flip", "fold", "grazing", "separation", "branching", "signature", and without dither and without
    runs "hopf", "divergence", "coalescence", with ``frequency``; see :class:`TrackedStability`. ``contacts`` of a grazing or a separation
    names the contacts that graze or open, ``contact`` the first of them.

    ``opens_towards`` of a fold is "larger" or "smaller", the values of the parameter at which two responses exist, or ``None`` with
    the reason in ``why``; it is the sign of ``quadratic_coefficient`` with its ``quadratic_coefficient_error``.

    ``criticality`` of a Hopf, Neimark–Sacker or flip bifurcation is "supercritical" (beyond the threshold the vibration is stable
    and grows from zero), "subcritical" (the motion jumps, with hysteresis) or ``None`` with ``criticality_reason``. It is the sign
    of ``first_lyapunov_coefficient`` with its ``first_lyapunov_coefficient_error``: below zero is supercritical. The critical
    shape has norm 1 over the coordinates, so that its unit is 1/displacement²; of a Hopf bifurcation it is divided by the angular
    frequency, of the others it is per period.
    """
    signature_changes: Records
    """``value`` at which the events of a period change, and the events ``below`` and ``above``."""
    gaps: Records
    """Intervals ``from`` … ``to`` next to a grazing in which no response was found."""
    covered: bool
    """Whether the response was continued over the whole range."""
    resumes: bool
    """Whether the last value has an answer again, after a range without one."""
    rests: Records
    """Without dither and without runs: ``value`` at which the surface of a ``contact`` comes to rest."""
    from_: float
    """First value of the parameter."""
    to: float
    """Last value of the parameter."""
    from_rest: Records
    """On request: ``value`` with its ``error``, and the outcome of runs from rest above it, ``becomes``: "quenched", "not quenched" or
    "unknown"; ``kind`` of the threshold of the run's orbit, or ``None`` where the run changes to another motion."""
    from_sliding: Records
    """The same for runs from steady sliding."""
    from_squeal: Records
    """The same for runs from full squeal."""
    from_start: Records
    """The same for runs from ``start``."""
    at_from: FrozenDict[Any]
    """The outcome at the first value, by protocol, and the ``verdict`` on the response; without dither and without runs the verdict on
    ``steady_sliding``."""
    values_tried: int
    """Number of values at which runs were judged."""
    ramp: float
    """Time over which the dither of the runs grows."""
    thresholds: Records
    """Without dither and without runs: the list ``local``."""
    protocol: str
    """The method."""
    points: int
    """Without dither and without runs: number of values at which eigenvalues were computed."""
    unknown: Records
    """Without dither and without runs: ``from`` and ``to`` of ranges without an answer, and ``why``."""
    state_names: list[str]
    """Names of the numbers of a state."""
    ending: str | None
    """How the continuation ended."""
    point: npt.NDArray[np.float64]
    """Number of each point (n,) of the branch."""
    radius: npt.NDArray[np.float64]
    """Modulus of the decisive multiplier (n,)."""
    branch: npt.NDArray[np.float64]
    """Without dither: number of each eigenvalue."""
    growth_rate: npt.NDArray[np.float64]
    """Without dither: growth rate over the parameter and the branch."""
    frequency: npt.NDArray[np.float64]
    """Without dither: angular frequency over the parameter and the branch."""


class ThresholdCurves(Result):
    """Curves of thresholds in the plane of two parameters."""

    verb = "thresholds"
    parameter: str
    """Path of the parameter whose thresholds are continued."""
    along: str
    """Path of the second parameter."""
    curves: Records
    """``kind``, ``value`` (n,), ``along`` (n,) of each curve, and with dither ``multiplier_modulus`` (n,), ``ends``, ``state`` (n, m) and
    the ``contacts`` that graze or open. ``criticality`` (n,) and ``first_lyapunov_coefficient`` (n,)
    of each point, or ``None`` with its reason in ``criticality_reason`` (n,); of folds ``opens_towards`` (n,) likewise."""
    averaged: Records
    """With dither: boundaries of averaging: whether in the ``limit`` R → ∞, ``along`` (n,), ``value`` (n,), and both as pairs, ``points``."""
    from_: float
    """First value of the parameter."""
    to: float
    """Last value of the parameter."""
    between: list[float]
    """First and last value of the second parameter."""
    protocol: str
    """The method."""
    state_names: list[str]
    """Names of the numbers of a state."""
    point: npt.NDArray[np.float64]
    """Number of each point (n,) of the curves."""
    curve: npt.NDArray[np.float64]
    """Curve of each point (n,)."""
    kind: npt.NDArray[np.uint8]
    """Code of the kind of threshold at each point (n,)."""
    multiplier_modulus: npt.NDArray[np.float64]
    """Modulus of the decisive multiplier (n,)."""


class Bifurcation(Result):
    """The response along a parameter, swept up and down."""

    verb = "bifurcation"
    parameter: str
    """Path of the parameter."""
    unit: str
    """Unit of its values."""
    start: str
    """The start of the first sweep."""
    jumps: Records
    """``direction``, ``before`` and ``after``: values between which the quiet response is left or reached; ``becomes``."""
    hysteresis: list[list[float]] | None
    """First and last value of each interval in which up and down differ; ``None`` if only one direction was swept."""
    up: Records
    """Points of the sweep up: ``value``, ``local_verdict``, ``settled``, ``quiet``, ``kind``, ``periods``, ``rotation_number``,
    ``section_displacement`` (n,), …"""
    down: Records
    """Points of the sweep down."""
    protocol: str
    """The method."""
    most_periods: int
    """System: most periods of a run at one value."""
    row: npt.NDArray[np.float64]
    """Number of each point (n,) of both sweeps."""
    direction: npt.NDArray[np.uint8]
    """Code of the direction of the sweep (n,)."""
    kind: npt.NDArray[np.uint8]
    """Code of the kind of motion (n,)."""
    quiet: npt.NDArray[np.uint8]
    """Code of whether it has no slow vibration (n,)."""
    local_verdict: npt.NDArray[np.uint8]
    """Code of the verdict on the base response (n,)."""
    periods: npt.NDArray[np.float64]
    """Dither periods in one period of the motion (n,)."""
    periods_to_settle: npt.NDArray[np.float64]
    """Dither periods until the run was near it (n,)."""
    rotation_number: npt.NDArray[np.float64]
    """Rotation number (n,)."""
    rotation_error: npt.NDArray[np.float64]
    """Its error (n,)."""
    locking_turns: npt.NDArray[np.float64]
    """Cycles of a locked motion (n,)."""
    locking_periods: npt.NDArray[np.float64]
    """Dither periods of these cycles (n,)."""
    frequency: npt.NDArray[np.float64]
    """Angular frequency of the slow vibration (n,)."""
    peak_to_peak: npt.NDArray[np.float64]
    """Peak-to-peak displacement (n,)."""
    section_displacement: npt.NDArray[np.float64]
    """Displacement in the stroboscopic section (n,)."""
    section_velocity: npt.NDArray[np.float64]
    """Velocity in the stroboscopic section (n,)."""
    belt_stick_fraction: npt.NDArray[np.float64]
    """Belt: fraction of the time in stick (n,)."""


class Ramp(Result):
    """One run in which a drive, a load or an amplitude changes slowly, compared with the exact thresholds."""

    verb = "bifurcation --ramp"
    parameter: str
    """Path of the number that changes."""
    least: float
    """Its least value."""
    largest: float
    """Its largest value."""
    until: float
    """End of the run, at the last knot."""
    switches: Records
    """``time`` and ``value`` at which the run begins or ceases to vibrate, ``becomes``, and the exact ``threshold`` at which the base
    response changes in the same sense, with the ``threshold_time`` at which the ramp passes it."""
    thresholds: Records | None
    """Exact thresholds of the base response at constant values: ``value``, ``kind``, ``becomes``."""
    manoeuvre: FrozenDict[Any]
    """When the run vibrates, as in :class:`quell.results.Simulation`."""
    time: npt.NDArray[np.float64]
    """Time of each sample (n,)."""
    value: npt.NDArray[np.float64]
    """Value of the number that changes (n,)."""
    displacement: npt.NDArray[np.float64]
    """Observed displacement (n,)."""
    velocity: npt.NDArray[np.float64]
    """Observed velocity (n,)."""


class Basins(Result):
    """The responses on which starts in a window end, and the fraction of each."""

    verb = "basins"
    starts: int
    """Number of starts."""
    layout: FrozenDict[Any]
    """``grid``: numbers of values of both numbers; or ``sample`` and ``seed``."""
    error_meaning: str
    """Meaning of the bounds of the fractions."""
    quiet_fraction: float | None
    """Fraction of the starts that end on a quiet response; ``None`` if no outcome is known."""
    quiet_fraction_low: float | None
    """Its lower bound."""
    quiet_fraction_high: float | None
    """Its upper bound, in which starts with an unknown outcome count."""
    local_verdict: str
    """Verdict on the base response, without dither on steady sliding."""
    attractors: Records
    """``words``, ``starts``, ``fraction``, ``fraction_low``, ``fraction_high``, ``quiet``, ``kind``, … of each response."""
    unknown: FrozenDict[Any]
    """``starts`` with an unknown outcome, and their ``fraction``."""
    ends: list[int]
    """Index of the attractor of each start."""
    parameter: str
    """With ``over``: path of the parameter."""
    unit: str
    """With ``over``: unit of its values."""
    portraits: Records
    """With ``over``: the fractions and attractors, by ``value``."""
    protocol: str
    """The method."""
    start: str
    """The start in words, of which two numbers are varied."""
    plane: list[str]
    """Names of the two numbers that are varied."""
    window_across: list[float]
    """Least and largest value of the first."""
    window_up: list[float]
    """Least and largest value of the second."""
    across: list[float]
    """Values of the first number of each start."""
    up: list[float]
    """Values of the second number of each start."""
    unknown_starts: int
    """Number of starts with an unknown outcome."""
    attractor: npt.NDArray[np.float64]
    """Attractor of each start of a grid, NaN where it is unknown."""
    quiet: npt.NDArray[np.uint8]
    """Code of whether the end of each start is quiet."""
    unknown_fraction: npt.NDArray[np.float64]
    """With ``over``: fraction of the starts with an unknown outcome."""


class Map(Result, Mapping[str, Any]):
    """Quantities over the axes of a study: a mapping of names to variables over them. ``NAME_status`` has the codes of the reasons why values
    of a quantity are missing."""

    verb = "map"
    shape: list[int]
    """Number of values of each axis."""
    points: int
    """Number of points."""
    resumed_points: int
    """Points that the store already had."""
    axes: Records
    """``parameter``, ``name``, ``unit`` and ``values`` of each axis."""
    counts: FrozenDict[FrozenDict[int]]
    """Number of points by status, for each quantity."""
    amplitude: npt.NDArray[np.float64]
    """Largest spectral amplitude M of the observed displacement in the band of slow vibration."""
    amplitude_status: npt.NDArray[np.uint8]
    criterion: npt.NDArray[np.float64]
    """Criterion of stability 2ζ + Fμ̄′ by finite-R averaging: unstable where negative."""
    criterion_status: npt.NDArray[np.uint8]
    critical_amplitude: npt.NDArray[np.float64]
    """Smallest amplitude of the first dither that makes sliding stable, by averaging."""
    critical_amplitude_status: npt.NDArray[np.uint8]
    destabilising_amplitude: npt.NDArray[np.float64]
    """Smallest amplitude of the first dither that makes sliding unstable, by averaging."""
    destabilising_amplitude_status: npt.NDArray[np.uint8]
    dither_power: npt.NDArray[np.float64]
    """Mean power supplied by tangential dither."""
    dither_power_status: npt.NDArray[np.uint8]
    dither_stroke: npt.NDArray[np.float64]
    """Largest peak-to-peak displacement of a point on which tangential dither acts."""
    dither_stroke_status: npt.NDArray[np.uint8]
    effect: npt.NDArray[np.uint8]
    """Effect of the dither on the vibration: quenches, reduces, increases, causes, or quiet with and without it."""
    effect_status: npt.NDArray[np.uint8]
    ends_on: npt.NDArray[np.uint8]
    """The motion on which the run of the study ends: period-1 (in step with the dither), locked, quasi-periodic, not-periodic, limit-cycle, rest."""
    ends_on_status: npt.NDArray[np.uint8]
    frequency: npt.NDArray[np.float64]
    """Angular frequency of the fastest growing motion; of a disc under dither up to multiples of the dither frequency."""
    frequency_status: npt.NDArray[np.uint8]
    growth: npt.NDArray[np.float64]
    """Largest growth rate of small motions, by averaging under dither."""
    growth_status: npt.NDArray[np.uint8]
    growth_error: npt.NDArray[np.float64]
    """Bound on its error."""
    growth_error_status: npt.NDArray[np.uint8]
    growth_undithered: npt.NDArray[np.float64]
    """Largest growth rate without dither."""
    growth_undithered_status: npt.NDArray[np.uint8]
    growth_undithered_error: npt.NDArray[np.float64]
    """Bound on its error."""
    growth_undithered_error_status: npt.NDArray[np.uint8]
    growth_verdict: npt.NDArray[np.uint8]
    """Code of the verdict by its sign, undecided within the error."""
    growth_verdict_status: npt.NDArray[np.uint8]
    limit_criterion: npt.NDArray[np.float64]
    """Criterion of averaged stability 2ζ + Fμ̄′ (2.26) in the limit R → ∞."""
    limit_criterion_status: npt.NDArray[np.uint8]
    limit_critical_amplitude: npt.NDArray[np.float64]
    """Smallest amplitude ratio α = D/R of the first dither at which averaged stability changes in the limit R → ∞."""
    limit_critical_amplitude_status: npt.NDArray[np.uint8]
    limit_critical_amplitude_upper: npt.NDArray[np.float64]
    """The largest of these amplitude ratios."""
    limit_critical_amplitude_upper_status: npt.NDArray[np.uint8]
    limit_growth: npt.NDArray[np.float64]
    """Growth rate of small slow motions by averaging in the limit R → ∞."""
    limit_growth_status: npt.NDArray[np.uint8]
    limit_verdict: npt.NDArray[np.uint8]
    """Averaged verdict (2.26) in the limit of high dither frequency, R → ∞: that of the dissertation."""
    limit_verdict_status: npt.NDArray[np.uint8]
    mean_friction: npt.NDArray[np.float64]
    """Mean friction force of the steady response, of all contacts."""
    mean_friction_status: npt.NDArray[np.uint8]
    minimum_normal_load: npt.NDArray[np.float64]
    """Smallest normal load of a contact in the steady response."""
    minimum_normal_load_status: npt.NDArray[np.uint8]
    orbit_radius: npt.NDArray[np.float64]
    """Modulus of the deciding multiplier of the base response: stable below 1."""
    orbit_radius_status: npt.NDArray[np.uint8]
    orbit_verdict: npt.NDArray[np.uint8]
    """Verdict on the base response by its multipliers."""
    orbit_verdict_status: npt.NDArray[np.uint8]
    peak_to_peak: npt.NDArray[np.float64]
    """Peak-to-peak of the observed displacement of the motion on which the run ends."""
    peak_to_peak_status: npt.NDArray[np.uint8]
    quench_amplitude: npt.NDArray[np.float64]
    """Least amplitude of the first dither from which the base response is stable, exactly."""
    quench_amplitude_status: npt.NDArray[np.uint8]
    quench_amplitude_averaged: npt.NDArray[np.float64]
    """The same by finite-R averaging."""
    quench_amplitude_averaged_status: npt.NDArray[np.uint8]
    quench_kind: npt.NDArray[np.uint8]
    """Code of the kind of that threshold."""
    quench_kind_status: npt.NDArray[np.uint8]
    quench_last: npt.NDArray[np.float64]
    """Amplitude from which every larger one is quiet, up to the limit of the search."""
    quench_last_status: npt.NDArray[np.uint8]
    quench_lost: npt.NDArray[np.float64]
    """Amplitude at which the first range of quiet amplitudes ends."""
    quench_lost_status: npt.NDArray[np.uint8]
    residual_vibration: npt.NDArray[np.float64]
    """Residual vibration E = M₁/M₀ (2.27), the dissertation's efficiency metric: the share that remains under dither; 0 if quenched."""
    residual_vibration_status: npt.NDArray[np.uint8]
    settled: npt.NDArray[np.uint8]
    """Whether the amplitudes of the two halves of the record agree."""
    settled_status: npt.NDArray[np.uint8]
    slip_ratio: npt.NDArray[np.float64]
    """Largest fast slip velocity over the velocity of its surface: from 1 on a contact reverses."""
    slip_ratio_status: npt.NDArray[np.uint8]
    stick_fraction: npt.NDArray[np.float64]
    """Largest fraction of the time that a contact sticks, on the motion on which the run ends."""
    stick_fraction_status: npt.NDArray[np.uint8]
    undithered_amplitude: npt.NDArray[np.float64]
    """Spectral amplitude M₀ of the run without dither."""
    undithered_amplitude_status: npt.NDArray[np.uint8]
    verdict: npt.NDArray[np.uint8]
    """Verdict on steady sliding, by averaging under dither: stable or unstable, undecided within its error."""
    verdict_status: npt.NDArray[np.uint8]

    def _is_entry(self, fact: str) -> bool:
        return False

    __hash__ = None  # type: ignore[assignment]

    def words(self, name: str) -> npt.NDArray[np.str_]:
        """The words of a variable with coded values, such as "verdict" or "residual_vibration_status"."""
        return self.arrays[name].words()


class Shard(Result):
    """The part of a map that one of several processes computed, and what is left."""

    verb = "map"
    chunks: int
    """Chunks of this shard."""
    computed_chunks: int
    """Chunks of this shard that were computed by this call."""
    computed_points: int
    """Points of these chunks."""
    there_chunks: int
    """Chunks of this shard that the store already had."""
    left_chunks: int
    """Chunks of the whole map that are missing."""
    left_shards: list[int]
    """Shards that have the missing chunks."""

    @classmethod
    def _left(cls, study: Study, facts: dict[str, Any]) -> Shard:
        """What one process computed, and what is left."""
        made = cls._of(study, None)
        made._keep(_facts=frozen(facts), _arrays=_dataset.arrays(cls.verb, facts, []))
        return made

    def save(
        self, path: str | os.PathLike[str], *, width: str | None = None, caption: bool = False, title: bool = True
    ) -> list[str]:
        """Raises an error: the chunks are in the store, and only the whole map has a table."""
        raise StudyError([complaint("save", None, "a shard has no table: read the map with resume=True", "usage")])
