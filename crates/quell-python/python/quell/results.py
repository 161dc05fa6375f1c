"""Results: what the verbs of a study answer.

A result has the facts that the command line prints with ``--json`` as attributes (``response.efficiency``), in the
numbers of the equations and, for a study in SI, in SI beside them (``amplitude_m``). What is unknown is ``None``, and
``result.why`` says why. All of it, arrays included, is one :class:`xarray.Dataset` in the units of the study (in SI where
it is; units are words that pint reads, what dimensionless numbers are scaled by is ``attrs["scaling"]``), with provenance, in
``result.dataset`` (a :class:`quell.results.Arrays` where xarray is not installed). Results plot, save, pickle, and
show as a table in notebooks.
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
    "Basins",
    "Bifurcation",
    "Check",
    "Citations",
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
    "Variable",
]

Verdict = Literal["stable", "unstable", "undecided"]
R = TypeVar("R", bound="Result")


class Result:
    """What a verb answered about a study."""

    verb: str = ""
    """The verb."""

    study: Study
    """The study it is about."""

    sentence: str
    """The answer in one sentence, where there is one."""

    def __init__(self, study: Study, native: NativeAnswer | None) -> None:
        self.study = study
        self._native = native
        self._facts: dict[str, Any] | None = None
        self._arrays: Arrays | None = None
        self._description: dict[str, Any] | None = None

    @property
    def facts(self) -> dict[str, Any]:
        """The facts, as the command line prints them with ``--json``; of a map without its arrays."""
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
        """Why facts are ``None``, by name."""
        why: dict[str, str] = self.facts.get("why", {})
        return why

    @property
    def warnings(self) -> list[str]:
        """What a reader of the numbers should know."""
        found: list[str] = self.facts.get("warnings", [])
        return found

    @property
    def arrays(self) -> Arrays:
        """Everything as NumPy arrays with dimensions, units and provenance; no xarray needed."""
        if self._arrays is None:
            self._arrays = _dataset.arrays(self.verb, self.facts, self._alive().datasets())
        return self._arrays

    @property
    def dataset(self) -> xarray.Dataset:
        """Everything as one xarray Dataset; the same as :attr:`arrays` where xarray is not installed.

        Facts are variables without dimension, lists of the facts have one dimension, arrays theirs; units stand in
        the attributes of each variable, where it comes from in those of the Dataset.
        """
        return self.arrays.to_xarray()

    def to_xarray(self) -> xarray.Dataset:
        """:attr:`dataset`, but an ImportError where xarray is not installed."""
        return self.arrays.to_xarray(needed=True)

    def to_dict(self) -> dict[str, Any]:
        """The facts as a new dict, as ``--json`` prints them."""
        import copy

        return copy.deepcopy(self.facts)

    def plot(self) -> matplotlib.figure.Figure:
        """The picture of the command line's ``--plot``, drawn with matplotlib."""
        from .plotting import draw

        return draw(self._described())

    def save(self, path: str | os.PathLike[str]) -> list[str]:
        """Writes the arrays as .csv, with units and the study in its header, or the picture as .svg or .png.

        These are the files of the command line's ``--save`` and ``--plot``. Returns the paths that were written.
        """
        try:
            place = os.fspath(path)
        except TypeError:
            raise StudyError([complaint("path", path, "a path", "path")]) from None
        if self._native is None:
            raise StudyError([complaint("save", None, "a result that was not unpickled: repeat the call", "usage")])
        if str(place).lower().endswith((".svg", ".png")):
            return [self._native.picture(str(place))]
        return self._native.csv(str(place))

    def _alive(self) -> NativeAnswer:
        if self._native is None:
            raise RuntimeError("a result that was unpickled has what was kept, and no more")
        return self._native

    def _described(self) -> dict[str, Any]:
        if self._description is None:
            if self._native is None:
                allowed = "there is no picture of this result"
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
        raise AttributeError(f"{type(self).__name__} has no {name}; there are {there}") from None

    def __getitem__(self, name: str) -> Any:
        """A variable of :attr:`dataset`."""
        return self.dataset[name]

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *(key for key in self.facts if key not in ("ok",))})

    def __getstate__(self) -> dict[str, Any]:
        try:
            description = self._described() if self._native else self._description
        except StudyError:
            description = None  # there is no picture
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
    """What its numbers are: those of the equations, or SI beside them."""


class Citations(Result):
    """Sources of a study's computations, and where the print was corrected."""

    verb = "cite"
    sources: list[dict[str, Any]]
    """``key``, ``reference``, and ``used``: for what."""
    corrections: list[dict[str, Any]]
    """Where the print of a source is wrong, and what is right."""
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
        """μ̄ (n,); NaN where there is none."""
        return self.arrays["effective_coefficient"].values

    @property
    def effective_slope(self) -> npt.NDArray[np.float64]:
        """μ̄′ (n,) per unit of v_r; NaN where there is none."""
        return self.arrays["effective_slope"].values


class Stability(Result):
    """Stability of steady sliding by averaging, or of a disc by eigenvalues or Floquet exponents."""

    verb = "stability"
    verdict: Verdict
    """Whether small motions die out."""
    criterion: float | None
    """Belt: 2ζ + Fμ̄′ (2.26), stable where positive."""
    critical_amplitudes: list[dict[str, Any]] | None
    """Belt: every α > 0 at which it changes: ``amplitude_ratio``, ``amplitude``, ``kind``, ``becomes``."""
    growth_rate: float | None
    """Largest growth rate per unit τ."""


class Simulation(Result):
    """A trajectory: its end, its events, its samples."""

    verb = "simulate"
    final: dict[str, Any]
    """``time``, ``displacement``, ``velocity``, ``sticking``, ``slip_sign`` at the end."""
    events: list[dict[str, Any]]
    """``time``, ``kind`` ("stick", "release", "reversal"), ``slip_sign``, ``displacement`` of every event."""
    event_count: int
    """Number of events, kept or not."""


class Response(Result):
    """The steady response with and without dither."""

    verb = "response"
    effect: str
    """Effect of the dither: "quenches", "reduces", "increases", "causes" (quiet without, vibrating with), "quiet" or "unknown"."""
    ends_on: str
    """Where the dithered run ends: "base response", "another response without slow motion of its own", "another response" or
    "unknown"."""
    amplitude: float
    """Largest spectral amplitude with 0 < ω ≤ 1.9 ω₀: a length."""
    undithered_amplitude: float
    """The same without dither."""
    efficiency: float | None
    """Residual vibration E = amplitude over undithered amplitude (2.27)."""
    level_db: float | None
    """20 lg E, in dB."""
    stick_fraction: float
    """Share of the time in which the mass sticks to the belt."""
    settled: bool
    """Whether both halves of the record have the same amplitude."""
    undithered_settled: bool
    """The same without dither."""
    mean_friction: float
    """Mean friction force over k: a length."""
    mean_friction_undithered: float
    """Friction force μ(v₀)F of steady sliding without dither, over k: a length."""
    friction_loss: float | None
    """Share of the friction of undithered steady sliding that is lost; negative where friction rises."""
    dither_power: float | None
    """Mean power of tangential dither over kω₀: a length squared."""
    dither_stroke: float | None
    """Stroke of the fast motion that tangential dither makes: a length."""
    minimum_normal_load: float
    """Least normal force over k: a length."""
    peaks: list[dict[str, float]]
    """Peaks of the spectrum: ``frequency`` (ω₀), ``amplitude``."""
    band_displacement_level_db: float | None
    """Change of the level of the displacement in the band of a study with one, in dB."""
    band_velocity_level_db: float | None
    """The same of the velocity."""
    band_displacement_rms: float | None
    """Root mean square of the displacement in the band: a length; ``band_undithered_displacement_rms`` without dither."""
    band_velocity_rms: float | None
    """Root mean square of the velocity in the band: a length; ``band_undithered_velocity_rms`` without dither."""


class Orbit(Result):
    """A periodic response and its Floquet multipliers."""

    verb = "orbit"
    free_phase: bool | None
    """Whether it is a limit cycle, whose phase nothing fixes; none where there is no orbit but steady sliding."""
    displacement: float
    """x at τ = 0: a length."""
    velocity: float
    """x′ at τ = 0: a length per τ."""
    period: float | None
    """Period, in τ; none where there is no orbit."""
    monodromy: list[list[float]] | None
    """What a small change of x and x′ has become after a period; none where there is no orbit."""
    verdict: Verdict
    """Whether small deviations die out."""
    stick_episodes: int
    """Sticks in a period."""
    reversals: int
    """Reversals of slip in a period."""
    stick_fraction: float
    """Share of the period in which the mass sticks."""
    residual: float
    """How far the state is from itself after a period: a length."""
    state_error: float | None
    """Estimated error of the state: a length; none where a multiplier is too near to 1."""
    multiplier_error: float | None
    """Estimated error of the modulus of the multiplier that decides; none as for ``state_error``."""
    signature: list[dict[str, Any]]
    """``kind`` and ``slip_sign`` of the events of a period, in their order."""
    least_slip_velocity: float | None
    """Least |v_r| while it slips: a length per τ; none where it sticks throughout.

    Without dither: ``cycles``, every limit cycle, each with all of these.
    """

    @property
    def multipliers(self) -> npt.NDArray[np.complex128]:
        """The two multipliers; none where there is no orbit (see ``why``)."""
        pairs = self.facts["multipliers"] or []
        return np.array([complex(re, im) for re, im in pairs], dtype=np.complex128)


class Thresholds(Result):
    """Values of a parameter at which the response changes."""

    verb = "thresholds"
    parameter: str
    """Path of the parameter."""
    local: list[dict[str, Any]]
    """``value`` with its ``error``, ``kind``, ``was``, ``becomes``, and the state ``displacement``, ``velocity``.

    Kinds are "neimark-sacker", "hopf", "flip", "fold", "grazing", "branching", "signature".
    """
    signature_changes: list[dict[str, Any]]
    """``value`` at which the events of a period change, ``below`` and ``above``: what they are there."""
    covered: bool
    """Whether the response was followed over the whole range.

    With a protocol also ``from_rest``, ``from_sliding``, ``from_squeal`` or ``from_start``: ``value`` with its ``error`` and where
    runs end above it, ``becomes``: "quenched", "not quenched", "unsettled" or "unknown"; and ``at_from``, where they end at the
    first value, by protocol.
    """


class ThresholdCurves(Result):
    """Curves of thresholds in the plane of two parameters."""

    verb = "thresholds"
    parameter: str
    """Path of the parameter whose thresholds are followed."""
    along: str
    """Path of the parameter along which they are."""
    curves: list[dict[str, Any]]
    """``kind``, ``value`` (n,), ``along`` (n,), ``multiplier_modulus`` (n,), ``ends`` of each curve."""
    averaged: list[dict[str, Any]]
    """Boundaries of averaging: ``sharper``, ``along`` (n,), ``value`` (n,), and both as pairs, ``points``."""


class Bifurcation(Result):
    """The response along a parameter, swept up and down."""

    verb = "bifurcation"
    parameter: str
    """Path of the parameter."""
    unit: str
    """Unit of its values."""
    start: str
    """Where the first sweep begins."""
    jumps: list[dict[str, Any]]
    """``direction``, ``before`` and ``after``: values between which the quiet response is left or reached; ``becomes``."""
    hysteresis: list[list[float]] | None
    """First and last value of each stretch in which up and down differ; none where one way alone was swept.

    A direction that was swept, ``up`` or ``down``, is a list of its points: ``value``, ``local_verdict``, ``settled``,
    ``quiet``, ``kind``, ``periods``, ``rotation_number``, ``section_displacement`` (n,), …
    """


class Basins(Result):
    """The responses that starts of a window end on, and the share of each."""

    verb = "basins"
    starts: int
    """Number of starts."""
    window_displacement: list[float]
    """Least and largest x of the starts: lengths."""
    window_velocity: list[float]
    """Least and largest x′ of the starts: lengths per τ."""
    layout: dict[str, Any]
    """``grid``: displacements and velocities; or ``sample`` and ``seed``."""
    error_meaning: str
    """What the bounds of the shares are.

    Without a parameter: ``quiet_fraction`` with its bounds ``quiet_fraction_low`` and ``quiet_fraction_high`` (starts whose end is
    not known are in the upper one; all three are ``None`` where no end is), ``local_verdict``, ``attractors`` (each with ``words``, ``fraction``,
    ``fraction_low``, ``fraction_high``, …), ``unknown`` and ``ends``, the place of the attractor of each start. Over a
    parameter: ``portraits``, a list of these by ``value``.
    """


class Modes(Result):
    """Natural frequencies and shapes of a disc."""

    verb = "modes"
    modes: list[dict[str, Any]]
    """``radial``, ``diameters``, ``frequency_parameter`` (k²), ``ratio`` (ω_ref), ``shape_at_load``, ``damping``, …"""
    critical_mode: dict[str, int] | None
    """The mode with the lowest critical speed."""


class Resonances(Result):
    """Where waves of a disc meet."""

    verb = "resonances"
    undithered: list[dict[str, Any]]
    """Meetings that need no dither, as ``dithered``."""
    dithered: list[dict[str, Any]]
    """``speed``, ``waves``, ``can_be_unstable``, ``threshold``, ``edges``, ``peak_growth`` of each meeting.

    Where speeds are to be kept clear: ``clear``, with intervals of R that are ``clear`` and ``blocked``, the best R
    (``suggestion``) with its ``verified_growth_rate``, what the exact equations say of it (``verified``: ``verdict``,
    which is "stable" where nothing grows, "unstable" or "undecided", ``growth_rate``, ``growth_rate_error`` and the
    ``speed`` of it; or None, and ``why``), and the meetings that are ``there``, each with ``reaches_in``.
    """


class Map(Result, Mapping[str, Any]):
    """Quantities over the axes of a study: a mapping of names to variables over them."""

    verb = "map"
    shape: list[int]
    """Number of values of each axis."""
    points: int
    """Number of points."""
    resumed_points: int
    """Points that were in the store already."""

    def __iter__(self) -> Iterator[str]:
        return iter(self.arrays)

    def __len__(self) -> int:
        return len(self.arrays)

    __hash__ = None  # type: ignore[assignment]

    def words(self, name: str) -> npt.NDArray[np.str_]:
        """The words of a variable of words or states, such as "verdict" or "efficiency_status"."""
        return self.arrays[name].words()


class Shard(Result):
    """What one of several processes computed of a map, and what is left of it."""

    verb = "map"
    chunks: int
    """Chunks of this shard."""
    computed_chunks: int
    """Chunks of it that were computed now."""
    computed_points: int
    """Points of these."""
    there_chunks: int
    """Chunks that the store had already."""
    left_chunks: int
    """Chunks of the whole map that are not there yet."""
    left_shards: list[int]
    """Shards, of as many, that have them."""

    def __init__(self, study: Study, facts: dict[str, Any]) -> None:
        super().__init__(study, None)
        self._facts = facts
        self._arrays = _dataset.arrays(self.verb, facts, [])

    def save(self, path: str | os.PathLike[str]) -> list[str]:
        """Refuses: the chunks are in the store, and the table is that of the whole map."""
        raise StudyError([complaint("save", None, "a shard has no table: read the map with resume=True", "usage")])
