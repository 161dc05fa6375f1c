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
from . import _columns

if TYPE_CHECKING:
    from .._study import Study


class Thresholds(_columns.ThresholdsColumns, Result):
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


class ThresholdCurves(_columns.ThresholdCurvesColumns, Result):
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


class Bifurcation(_columns.BifurcationColumns, Result):
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


class Ramp(_columns.RampColumns, Result):
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


class Basins(_columns.BasinsColumns, Result):
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


class Map(_columns.MapColumns, Result, Mapping[str, Any]):
    """Quantities over the axes of a study: a mapping of names to variables over them."""

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
