"""Results of the verbs of a study.

A result has the facts that the command line prints with ``--json`` as attributes (``response.efficiency``), in the
dimensionless form of the equations and, for a study in SI, also in SI (``amplitude_m``). Unknown facts are ``None``, with
the reason in ``result.why``. ``result.dataset`` has everything, including arrays and provenance, as one
:class:`xarray.Dataset` in the units of the study: in SI for a study in SI. pint reads the units, and ``attrs["scaling"]``
is the scale of a dimensionless number. If xarray is not installed, it is a :class:`quell.results.Arrays`. Results plot,
save, pickle, and are shown as a table in notebooks.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import numpy as np
import numpy.typing as npt

from . import _dataset
from ._dataset import Arrays, Variable
from ._errors import StudyError, complaint

if TYPE_CHECKING:
    import matplotlib.figure
    import xarray

    from ._quell import NativeAnswer
    from ._study import Study

__all__ = [
    "Arrays",
    "Attractor",
    "Basins",
    "Bifurcation",
    "Check",
    "Citations",
    "ExactStability",
    "FrictionCurve",
    "Map",
    "Modes",
    "Orbit",
    "Resonances",
    "Response",
    "Result",
    "Shard",
    "Simulation",
    "Stability",
    "ThresholdCurves",
    "Thresholds",
    "TrackedStability",
    "Variable",
]

Verdict = Literal["stable", "unstable", "undecided"]
R = TypeVar("R", bound="Result")


class Result:
    """The result of a verb for a study."""

    verb: str = ""
    """The verb."""

    study: Study
    """The study of the result."""

    sentence: str
    """The result in one sentence, if the verb has one."""

    def __init__(self, study: Study, native: NativeAnswer | None) -> None:
        self.study = study
        self._native = native
        self._facts: dict[str, Any] | None = None
        self._arrays: Arrays | None = None
        self._description: dict[str, Any] | None = None

    @property
    def facts(self) -> dict[str, Any]:
        """The facts, as the command line prints them with ``--json``; for a map without its arrays."""
        if self._facts is None:
            self._facts = self._alive().facts()
        return self._facts

    @property
    def units(self) -> dict[str, str]:
        """Units of the facts, by name."""
        units: dict[str, str] = self.facts.get("units", {})
        return units

    @property
    def why(self) -> dict[str, str]:
        """Reasons why facts are ``None``, by name."""
        why: dict[str, str] = self.facts.get("why", {})
        return why

    @property
    def warnings(self) -> list[str]:
        """Warnings about the numbers."""
        found: list[str] = self.facts.get("warnings", [])
        return found

    @property
    def arrays(self) -> Arrays:
        """Everything as NumPy arrays with dimensions, units and provenance, without xarray."""
        if self._arrays is None:
            self._arrays = _dataset.arrays(self.verb, self.facts, self._alive().datasets())
        return self._arrays

    @property
    def dataset(self) -> xarray.Dataset:
        """Everything as one xarray Dataset; the same as :attr:`arrays` if xarray is not installed.

        Facts are variables without dimension, lists have one dimension, and arrays have their own. The attributes of each
        variable have the unit, those of the Dataset the provenance.
        """
        return self.arrays.to_xarray()

    def to_xarray(self) -> xarray.Dataset:
        """Like :attr:`dataset`, but raises ImportError if xarray is not installed."""
        return self.arrays.to_xarray(needed=True)

    def to_dict(self) -> dict[str, Any]:
        """The facts as a new dict, as ``--json`` prints them."""
        import copy

        return copy.deepcopy(self.facts)

    def plot(self) -> matplotlib.figure.Figure:
        """Draws the picture of ``--plot`` on the command line with matplotlib."""
        from .plotting import draw

        return draw(self._described())

    def save(self, path: str | os.PathLike[str]) -> list[str]:
        """Writes the arrays as .csv, with units and the study in the header, the picture as .svg or .png, or a run as .wav.

        The files are those of ``--save`` and ``--plot`` on the command line. Returns the paths of the written files.
        """
        try:
            place = os.fspath(path)
        except TypeError:
            raise StudyError([complaint("path", path, "a path", "path")]) from None
        if self._native is None:
            raise StudyError([complaint("save", None, "a result that was not unpickled: repeat the call", "usage")])
        if str(place).lower().endswith((".svg", ".png")):
            return [self._native.picture(str(place))]
        if str(place).lower().endswith(".wav"):
            return [self._native.sound(str(place))]
        return self._native.csv(str(place))

    def _alive(self) -> NativeAnswer:
        if self._native is None:
            raise RuntimeError("an unpickled result has only its facts, its arrays and its picture")
        return self._native

    def _described(self) -> dict[str, Any]:
        if self._description is None:
            if self._native is None:
                allowed = "this result has no picture"
                raise StudyError([complaint("plot", None, allowed, "usage")])
            self._description = self._native.description()
        return self._description

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self.facts[name]
        except KeyError:
            pass
        there = ", ".join(key for key in self.facts if key not in ("ok", "units", "why"))
        raise AttributeError(f"{type(self).__name__} has no {name}; its facts are {there}") from None

    def __getitem__(self, name: str) -> Any:
        """A variable of :attr:`dataset`."""
        return self.dataset[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *(key for key in self.facts if key not in ("ok",))})

    def __getstate__(self) -> dict[str, Any]:
        try:
            description = self._described() if self._native else self._description
        except StudyError:
            description = None  # this result has no picture
        return {
            "study": self.study,
            "_native": None,
            "_facts": self.facts,
            "_arrays": self.arrays,
            "_description": description,
        }

    def __repr__(self) -> str:
        from ._html import plain

        return plain(self)

    def _repr_html_(self) -> str:
        from ._html import result

        return result(self)


class Check(Result):
    """The study in numbers."""

    verb = "check"
    system: Literal["dimensionless", "si"]
    """Whether the numbers are only dimensionless, or also in SI."""
    coordinates: list[str]
    """System: names of the coordinates or states."""
    contacts: list[str]
    """System: names of the contacts."""
    unit_system: Literal["none", "SI", "mm-t-s"]
    """System: the unit of bare numbers."""


class Citations(Result):
    """Sources of the computations for a study, and corrections of their printed equations."""

    verb = "cite"
    sources: list[dict[str, Any]]
    """``key``, ``reference``, and ``used``, the purpose."""
    corrections: list[dict[str, Any]]
    """Errors in the print of a source, with the correct form."""
    bibtex: str
    """The sources as BibTeX entries."""


class FrictionCurve(Result):
    """The friction law and its average under the dither, over slip velocities (n,)."""

    verb = "friction"

    @property
    def slip_velocity(self) -> npt.NDArray[np.float64]:
        """v_r (n,): lengths per τ."""
        return self.arrays["slip_velocity"].values

    @property
    def coefficient(self) -> npt.NDArray[np.float64]:
        """μ (n,); NaN at v_r = 0, where friction takes any value up to ±μ_s."""
        return self.arrays["coefficient"].values

    @property
    def effective_coefficient(self) -> npt.NDArray[np.float64]:
        """μ̄ (n,); NaN where it is undefined."""
        return self.arrays["effective_coefficient"].values

    @property
    def effective_slope(self) -> npt.NDArray[np.float64]:
        """μ̄′ (n,) per unit of v_r; NaN where it is undefined."""
        return self.arrays["effective_slope"].values


class Stability(Result):
    """Stability of steady sliding: of a belt by averaging, of a disc or system by eigenvalues."""

    verb = "stability"
    verdict: Verdict
    """Whether small motions decay."""
    protocol: str
    """Method: "averaged", "linearised" or "floquet"."""
    criterion: float | None
    """Belt: 2ζ + Fμ̄′ (2.26), stable where positive."""
    critical_amplitudes: list[dict[str, Any]] | None
    """Belt: every α > 0 at which the verdict changes: ``amplitude_ratio``, ``amplitude``, ``kind``, ``becomes``. System: the
    amplitudes of the first dither."""
    growth_rate: float | None
    """Largest growth rate, per unit τ or per unit of time of a system."""
    growth_rate_error: float | None
    """Disc and system: bound on the error of the growth rate."""
    frequency: float | None
    """Disc and system: frequency of the motion that grows fastest or decays slowest."""
    motions: list[dict[str, Any]]
    """System: ``growth_rate``, ``frequency``, ``damping_ratio``, ``error``, ``shape`` and ``friction_work`` of each motion."""
    contacts: list[dict[str, Any]]
    """System: ``name``, ``friction``, ``normal``, ``slip_amplitude``, ``effective_coefficient``, … of each contact."""
    undithered: dict[str, Any] | None
    """System: ``verdict``, ``growth_rate`` and ``frequency`` without dither."""

    @property
    def eigenvalues(self) -> npt.NDArray[np.complex128]:
        """System: the eigenvalues (n,), those with the largest growth rate first."""
        return numbers_of(self.__getattr__("eigenvalues"))


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
    local: list[dict[str, Any]]
    """``value`` with its ``error``, ``kind`` ("hopf", "divergence", "coalescence", "jump"), ``frequency``, and the verdicts below
    and above it, ``was`` and ``becomes``, which are equal where two frequencies merge without a change."""
    thresholds: list[dict[str, Any]]
    """The same list."""
    at_from: dict[str, Verdict | None]
    """The verdict at the first value."""
    covered: bool
    """Whether every value of the range has an answer."""
    resumes: bool
    """Whether the last value has an answer again, after a range without one."""
    rests: list[dict[str, Any]]
    """``value`` at which the surface of a ``contact`` comes to rest: friction reverses there, and there is no steady sliding."""
    unknown: list[dict[str, Any]]
    """``from`` and ``to`` of ranges without an answer, and ``why``.

    With a second parameter also ``along``, ``between``, and ``curves``: ``kind``, ``value`` (n,), ``along`` (n,), ``error`` (n,),
    ``frequency`` (n,), ``was`` and ``becomes`` of each curve, and ``criticality`` (n,) with ``criticality_reason`` (n,) and
    ``first_lyapunov_coefficient`` (n,) of its points.
    """


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
    exponents: list[dict[str, Any]]
    """``growth_rate``, ``growth_rate_error``, ``frequency`` and ``multiplier`` of each exponent."""

    @property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """The multipliers (n,), in the order of the exponents."""
        return numbers_of([it["multiplier"] for it in self.exponents])


def numbers_of(pairs: list[list[float]]) -> npt.NDArray[np.complex128]:
    """Pairs of a real and an imaginary part as complex numbers."""
    return np.array([complex(re, im) for re, im in pairs], dtype=np.complex128)


class Simulation(Result):
    """A trajectory: its end, its events, its samples."""

    verb = "simulate"
    final: dict[str, Any]
    """``time``, ``displacement``, ``velocity``, ``sticking``, ``slip_sign`` at the end; of a system ``time``, ``state`` and
    ``contacts``: ``name``, ``slip_velocity``, ``sticking``, ``open``, ``slip_sign``, ``friction``, ``normal``."""
    events: list[dict[str, Any]]
    """``time``, ``contact``, ``kind`` ("stick", "release", "reversal", of a system also "separation", "landing"), ``slip_sign``,
    and ``displacement`` or ``state`` of every event."""
    event_count: int
    """Number of events, including those that were not kept."""
    sound: dict[str, Any]
    """With ``sound``: ``sample_rate``, ``duration_s``, ``transposition``, ``natural_frequency_hz`` (where ω₀ sounds),
    ``strongest_frequency_hz``, ``gain`` and ``clipped`` of the file that ``save("run.wav")`` writes."""
    event_counts: dict[str, int]
    """System: number of events of each kind."""
    contacts: list[dict[str, Any]]
    """System: ``name``, ``event_counts``, ``stick_fraction``, ``open_fraction``, ``mean_friction``, ``mean_normal``,
    ``least_normal``, ``friction_power`` of every contact over the run."""
    state_names: list[str]
    """System: names of the numbers of ``state``."""
    amplitude: float | None
    """Disc: half the peak-to-peak deflection under the first load over the last tenth of the run."""
    growth_observed: float | None
    """Disc: growth rate of the extremes of that deflection while the motion is small, in ω_ref."""


class Response(Result):
    """The steady response with and without dither."""

    verb = "response"
    effect: str
    """Effect of the dither: "quenches", "reduces", "increases", "causes" (quiet without, vibrating with), "quiet" or
    "unknown"."""
    ends_on: str
    """Where the dithered run ends: "base response", "another response without slow motion of its own", "another response" or
    "unknown"."""
    amplitude: float
    """Largest spectral amplitude with 0 < ω ≤ 1.9 ω₀: a length."""
    undithered_amplitude: float
    """The same without dither."""
    efficiency: float | None
    """Residual vibration E = amplitude / undithered amplitude (2.27)."""
    level_db: float | None
    """20 lg E, in dB."""
    stick_fraction: float
    """Fraction of the time during which the mass sticks to the belt."""
    settled: bool
    """Whether both halves of the record have the same amplitude."""
    undithered_settled: bool
    """The same without dither."""
    mean_friction: float
    """Mean friction force over k: a length."""
    mean_friction_undithered: float
    """Friction force μ(v₀)F of steady sliding without dither, over k: a length."""
    friction_loss: float | None
    """Fraction of the friction of undithered steady sliding that is lost; negative if friction rises."""
    dither_power: float | None
    """Mean power of tangential dither over kω₀: a length squared."""
    dither_stroke: float | None
    """Stroke of the fast motion due to tangential dither: a length."""
    minimum_normal_load: float
    """Least normal force over k: a length."""
    peaks: list[dict[str, float]]
    """Peaks of the spectrum: ``frequency`` (ω₀), ``amplitude``."""
    band_displacement_level_db: float | None
    """Change of the level of the displacement in the band of the study, in dB."""
    band_velocity_level_db: float | None
    """The same for the velocity."""
    band_displacement_rms: float | None
    """Root mean square of the displacement in the band: a length; ``band_undithered_displacement_rms`` without dither."""
    band_velocity_rms: float | None
    """Root mean square of the velocity in the band: a length; ``band_undithered_velocity_rms`` without dither."""
    half_peak_to_peak: float
    """System: half of the peak-to-peak value of ``observe``; ``rms`` and ``mean`` likewise."""
    band_end: float
    """System: upper end of the band of ``amplitude`` and ``efficiency``, an angular frequency below the lowest dither."""
    contacts: list[dict[str, Any]]
    """System: ``name``, ``stick_fraction``, ``open_fraction``, ``mean_friction``, ``mean_normal``, ``friction_power`` and
    ``friction_loss`` of every contact."""
    dithers: list[dict[str, Any]]
    """System: ``power`` that each dither feeds in, and its peak-to-peak ``stroke``."""


class Orbit(Result):
    """A periodic response and its Floquet multipliers.

    Of a system: ``response`` ("base", "near", "reached", "limit-cycle"), ``period``, ``state`` at t = 0 with ``state_names``,
    ``multipliers``, ``radius``, ``verdict``, ``events``, ``contacts``; where no limit cycle was found ``tried``, the starts.
    """

    verb = "orbit"
    free_phase: bool | None
    """Whether it is a limit cycle, whose phase is free; ``None`` for steady sliding."""
    displacement: float
    """x at τ = 0: a length."""
    velocity: float
    """x′ at τ = 0: a length per τ."""
    period: float | None
    """Period, in τ; ``None`` if there is no orbit."""
    monodromy: list[list[float]] | None
    """Matrix that maps a small change of x and x′ to that after one period; ``None`` if there is no orbit."""
    verdict: Verdict
    """Whether small deviations decay."""
    stick_episodes: int
    """Number of sticking phases in a period."""
    reversals: int
    """Number of reversals of slip in a period."""
    stick_fraction: float
    """Fraction of the period during which the mass sticks."""
    residual: float
    """Distance of the state from itself after one period: a length."""
    state_error: float | None
    """Estimated error of the state: a length; ``None`` if a multiplier is too close to 1."""
    multiplier_error: float | None
    """Estimated error of the modulus of the decisive multiplier; ``None`` as for ``state_error``."""
    signature: list[dict[str, Any]]
    """``kind`` and ``slip_sign`` of the events of a period, in order."""
    least_slip_velocity: float | None
    """Least |v_r| during slip: a length per τ; ``None`` if the mass always sticks.

    Without dither: ``cycles``, every limit cycle, each with all of these facts.
    """

    @property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """The two multipliers; empty if there is no orbit (see ``why``)."""
        return numbers_of(self.facts["multipliers"] or [])


class Attractor(Result):
    """The motion on which a run ends, and its Lyapunov exponents."""

    verb = "attractor"
    start: str
    """The start in words."""
    attractor: dict[str, Any] | None
    """``kind``, ``quiet``, ``periods``, ``multiplier``, ``lowest``, ``highest``, …; ``None`` if the run did not settle."""
    periods_until_settled: int | None
    """Periods of the dither until the run was near the motion.

    With ``lyapunov=True`` also ``lyapunov``, or ``None`` with the reason in ``why``: ``exponents`` (largest first; ``None`` where a
    stick erases the direction, −∞) with their standard ``errors``, per unit of time; ``time`` of the record and ``settle`` before
    it; ``verdict`` ("regular", "irregular (chaotic)", "unknown"); ``deciding``, the largest exponent apart from the 0 of a shift in
    time, whose place is ``shift_in_time``; ``kaplan_yorke_dimension``; ``of_multiplier``, the same rate by the multipliers of a
    periodic motion, and ``agrees_with_multipliers``.
    """


class Thresholds(Result):
    """Values of a parameter at which the response changes."""

    verb = "thresholds"
    parameter: str
    """Path of the parameter."""
    local: list[dict[str, Any]]
    """``value`` with its ``error``, ``kind``, ``was``, ``becomes``, and of a belt the state ``displacement``, ``velocity``.

    Kinds are "neimark-sacker", "hopf", "flip", "fold", "grazing", "branching", "signature", and of a system without dither
    "hopf", "divergence", "coalescence", with ``frequency``; see :class:`TrackedStability`. Under dither a system also has
    "separation", and ``state``, ``radius_below`` and ``radius_above``. ``contacts`` of a grazing or a separation names the contacts
    of a system that graze or open, ``contact`` the first of them.

    ``opens_towards`` of a fold is "larger" or "smaller", the values of the parameter at which two responses exist, or ``None`` with
    the reason in ``why``; it is the sign of ``quadratic_coefficient`` with its ``quadratic_coefficient_error``.

    ``criticality`` of a Hopf, Neimark–Sacker or flip bifurcation is "supercritical" (beyond the threshold the vibration is stable
    and grows from zero), "subcritical" (the motion jumps, with hysteresis) or ``None`` with ``criticality_reason``. It is the sign
    of ``first_lyapunov_coefficient`` with its ``first_lyapunov_coefficient_error``: below zero is supercritical. The critical
    shape has norm 1 over the coordinates, so that its unit is 1/displacement²; of a Hopf bifurcation it is divided by the angular
    frequency, of the others it is per period.
    """
    signature_changes: list[dict[str, Any]]
    """Belt: ``value`` at which the events of a period change, and the events ``below`` and ``above``."""
    covered: bool
    """Whether the response was continued over the whole range.

    With a protocol also ``from_rest``, ``from_sliding``, ``from_squeal`` or ``from_start``: ``value`` with its ``error``, and the
    outcome of runs above it, ``becomes``: "quenched", "not quenched", "unsettled" or "unknown"; and ``at_from``, the outcome at
    the first value, by protocol.
    """


class ThresholdCurves(Result):
    """Curves of thresholds in the plane of two parameters."""

    verb = "thresholds"
    parameter: str
    """Path of the parameter whose thresholds are continued."""
    along: str
    """Path of the second parameter."""
    curves: list[dict[str, Any]]
    """``kind``, ``value`` (n,), ``along`` (n,) of each curve, and with dither ``multiplier_modulus`` (n,) and ``ends``; of a
    system also ``state`` (n, m) and the ``contacts`` that graze or open. ``criticality`` (n,) and ``first_lyapunov_coefficient`` (n,)
    of each point, or ``None`` with its reason in ``criticality_reason`` (n,); of folds ``opens_towards`` (n,) likewise."""
    averaged: list[dict[str, Any]]
    """With dither: boundaries of averaging: ``sharper``, ``along`` (n,), ``value`` (n,), and both as pairs, ``points``."""


class Bifurcation(Result):
    """The response along a parameter, swept up and down."""

    verb = "bifurcation"
    parameter: str
    """Path of the parameter."""
    unit: str
    """Unit of its values."""
    start: str
    """The start of the first sweep."""
    jumps: list[dict[str, Any]]
    """``direction``, ``before`` and ``after``: values between which the quiet response is left or reached; ``becomes``."""
    hysteresis: list[list[float]] | None
    """First and last value of each interval in which up and down differ; ``None`` if only one direction was swept.

    A direction that was swept, ``up`` or ``down``, is a list of its points: ``value``, ``local_verdict``, ``settled``,
    ``quiet``, ``kind``, ``periods``, ``rotation_number``, ``section_displacement`` (n,), …
    """


class Basins(Result):
    """The responses on which starts in a window end, and the fraction of each."""

    verb = "basins"
    starts: int
    """Number of starts."""
    window_displacement: list[float]
    """Least and largest x of the starts: lengths."""
    window_velocity: list[float]
    """Least and largest x′ of the starts: lengths per τ. Of a system ``plane`` names the axes, and ``window_across`` and
    ``window_up`` are their windows."""
    layout: dict[str, Any]
    """``grid``: displacements and velocities; or ``sample`` and ``seed``."""
    error_meaning: str
    """Meaning of the bounds of the fractions.

    Without a parameter: ``quiet_fraction`` with its bounds ``quiet_fraction_low`` and ``quiet_fraction_high`` (starts with an
    unknown outcome count in the upper one; all three are ``None`` if no outcome is known), ``local_verdict``, ``attractors``
    (each with ``words``, ``fraction``, ``fraction_low``, ``fraction_high``, …), ``unknown``, and ``ends``, the index of the
    attractor of each start. Over a parameter: ``portraits``, a list of these by ``value``.
    """


class Modes(Result):
    """Natural frequencies and shapes of a disc or of a system."""

    verb = "modes"
    modes: list[dict[str, Any]]
    """Disc: ``radial``, ``diameters``, ``frequency_parameter`` (k²), ``ratio`` (ω_ref), ``shape_at_load``, ``damping``, …
    System: ``frequency``, ``damping_ratio``, ``shape``, ``shape_imaginary``, with the springs of contacts and without friction."""
    critical_mode: dict[str, int] | None
    """Disc: the mode with the lowest critical speed."""
    coordinates: list[str]
    """System: names of the coordinates of the shapes."""


class Resonances(Result):
    """Meetings of the waves of a disc, or responses of the contacts of a system to its dithers."""

    verb = "resonances"
    responses: list[dict[str, Any]]
    """System: ``dither``, ``contact`` and ``extremes`` of each pair: ``kind`` ("peak" or "dip"), ``frequency``,
    ``slip_per_amplitude``, ``out_of_reach``, ``reversal_amplitude``. The dataset has the slip over ``frequency``."""
    undithered: list[dict[str, Any]]
    """Disc: meetings without dither, with the keys of ``dithered``."""
    dithered: list[dict[str, Any]]
    """Disc: ``speed``, ``waves``, ``can_be_unstable``, ``threshold``, ``edges``, ``peak_growth`` of each meeting.

    If a range of speeds should be kept clear: ``clear``, with the intervals of R that are ``clear`` and ``blocked``, the best R
    (``suggestion``) with its ``verified_growth_rate``, the result of the exact equations for it (``verified``: ``verdict``,
    which is "stable" if nothing grows, "unstable" or "undecided", ``growth_rate``, ``growth_rate_error`` and its
    ``speed``; or ``None``, and ``why``), and the meetings in the range, ``there``, each with ``reaches_in``.
    """


class Map(Result, Mapping[str, Any]):
    """Quantities over the axes of a study: a mapping of names to variables over them."""

    verb = "map"
    shape: list[int]
    """Number of values of each axis."""
    points: int
    """Number of points."""
    resumed_points: int
    """Points that the store already had."""

    def __iter__(self) -> Iterator[str]:
        return iter(self.arrays)

    def __len__(self) -> int:
        return len(self.arrays)

    __hash__ = None  # type: ignore[assignment]

    def words(self, name: str) -> npt.NDArray[np.str_]:
        """The words of a variable with coded values, such as "verdict" or "efficiency_status"."""
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

    def __init__(self, study: Study, facts: dict[str, Any]) -> None:
        super().__init__(study, None)
        self._facts = facts
        self._arrays = _dataset.arrays(self.verb, facts, [])

    def save(self, path: str | os.PathLike[str]) -> list[str]:
        """Raises an error: the chunks are in the store, and only the whole map has a table."""
        raise StudyError([complaint("save", None, "a shard has no table: read the map with resume=True", "usage")])
