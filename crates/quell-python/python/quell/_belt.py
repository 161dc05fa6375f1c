"""The mass on a moving belt: its tables and its study."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Literal, Union

import numpy as np

from ._axes import Axes, axes_tables
from ._errors import StudyError, complaint
from ._laws import Friction, as_law, law_of
from ._profile import Profile
from ._sampling import with_wave
from ._study import Study
from ._tables import Number, Table, Unknown, given, key

__all__ = [
    "Belt",
    "Dither",
    "Initial",
    "Solver",
]


Waveform = Union[Literal["sine", "triangle", "square", "fourier", "samples", "burst", "noise"], "Callable[[float], float]"]
"""The name of a waveform, or a function of the phase in radians."""


class PeriodicForce(Table):
    """The keys that the dithers of belts, discs and systems share."""

    amplitude: Number | None = None
    frequency_ratio: Number | None = None
    frequency: Number | None = None
    phase: Number | None = None
    amplitude_n: Number | None = None
    amplitude_n_rms: Number | None = None
    amplitude_rms: Number | None = None
    amplitude_peak_to_peak: Number | None = None
    amplitude_n_peak_to_peak: Number | None = None
    amplitude_v: Number | None = None
    amplitude_v_rms: Number | None = None
    amplitude_v_peak_to_peak: Number | None = None
    amplitude_a: Number | None = None
    amplitude_a_rms: Number | None = None
    amplitude_a_peak_to_peak: Number | None = None
    amplitude_percent: Number | None = None
    frequency_hz: Number | None = None
    harmonics: Iterable[Mapping[str, Number]] | None = None
    values: Iterable[float] | None = None
    file: str | None = None
    hold: Literal["linear", "zero"] | None = None
    carrier: Literal["sine", "triangle", "square"] | None = None
    on: int | None = None
    off: int | None = None
    band: tuple[Number, Number] | None = None
    band_hz: tuple[Number, Number] | None = None
    lines: int | None = None
    seed: int | None = None
    envelope: Profile | Mapping[str, Any] | None = None

    def _read(self, keys: dict[str, Any]) -> dict[str, Any]:
        keys, distance = with_wave(keys)
        if distance is not None:
            self._keep(_waveform_error=distance)
        return keys

    @property
    def waveform_error(self) -> float | None:
        """Of a waveform that is a function: its largest distance from its samples, over its largest value."""
        found: float | None = self.__dict__.get("_waveform_error")
        return found


class Dither(PeriodicForce):
    """One dither force.

    Parameters
    ----------
    direction :
        "tangential", a force on the mass along the belt, or "normal", a variation of the normal load.
    waveform :
        "sine", "triangle" or "square"; "fourier", "samples", "burst" or "noise" with the keys below; or a function of the phase in
        radians, which is sampled over one period.
    amplitude :
        D, the peak of the force over k: a length, ≥ 0; of noise its root mean square times √2. For a disc: the relative amplitude α.
    frequency_ratio, frequency :
        R, in units of ω₀ (belt) or ω_ref (disc), > 0; or the angular frequency in the unit of the study.
    phase :
        Phase at τ = 0, in radians.
    amplitude_n, amplitude_n_rms, frequency_hz :
        The same in N (peak, or root mean square) and Hz, in a study in SI.
    amplitude_rms, amplitude_peak_to_peak, amplitude_n_peak_to_peak :
        The amplitude as root mean square or peak to peak, in the unit of the study or in N.
    amplitude_v, amplitude_v_rms, amplitude_v_peak_to_peak, amplitude_a, amplitude_a_rms, amplitude_a_peak_to_peak :
        The voltage or the current of the actuator about its mean, from which its equations give the force; needs ``actuator``.
    amplitude_percent :
        Per cent of the largest amplitude that the actuator can give at the frequency of the dither; needs ``actuator``.
    harmonics :
        "fourier": a list of ``{"order": n, "sine": s, "cosine": c}``.
    values, file, hold :
        "samples": one period at equal distances, or a file of it (one number per line, or a CSV file with a column ``value``); and
        "linear" (straight lines) or "zero" (held).
    carrier, on, off :
        "burst": the waveform of the carrier, and its periods in a burst and in a pause.
    band, lines, seed :
        "noise": lowest and highest frequency in units of ω₀, instead of ``frequency_ratio`` and ``phase``; the number of equal lines
        [default: 64]; and the seed of their frequencies and phases [default: 1]. ``band_hz``: the band in Hz, in a study in SI.
    envelope :
        Share of the amplitude over time: a :class:`Profile` with ``share``.
    """

    _path = "dither"

    direction: Literal["tangential", "normal"] | None = key(default=None, kw_only=False)
    waveform: Waveform | None = key(default=None, kw_only=False)


class Initial(Table):
    """The initial state of a run: a named state, or displacement and velocity.

    Parameters
    ----------
    state :
        "rest" (x = x′ = 0), "sliding" (steady sliding without dither) or "squealing" (on the limit cycle
        of the belt without dither).
    displacement, velocity :
        x and x′ at τ = 0: lengths.
    displacement_m, velocity_m_per_s :
        The same in m and m/s, in a study in SI.
    """

    _path = "belt.initial"

    state: Literal["rest", "sliding", "squealing"] | None = key(default=None, kw_only=False)
    displacement: Number | None = None
    velocity: Number | None = None
    displacement_m: Number | None = None
    velocity_m_per_s: Number | None = None


class Solver(Table):
    """Accuracy and length of the computations.

    Parameters
    ----------
    tolerance :
        Bound on the last retained Taylor terms of a step, relative to the length scale F [default: 1e-12].
    settle :
        τ that is discarded before a response is measured [default: 1200]. ``settle_s``: the same in seconds.
    record_periods :
        Slow periods 2π in the record [default: 60].
    """

    _path = "solver"

    tolerance: Number | None = None
    settle: Number | None = None
    settle_s: Number | None = None
    record_periods: int | None = None


OTHER_TABLES = ("friction", "dither", "solver", "band", "band_hz", "design", "actuator", "uncertainty", "axes", "title")
"""Arguments of a belt that are tables of their own."""


class Belt(Study):
    """A study of a mass on a moving belt, dimensionless or in SI.

    Lengths are x and all forces over k: F = N/k and D; v₀ = V₀/ω₀ and v_m are lengths per τ. A study in SI has mass and
    stiffness and the SI twin of every key instead, and results are in both.

    Parameters
    ----------
    damping_ratio :
        ζ ≥ 0. In SI ``damping_n_s_per_m``, in N·s/m.
    normal_load :
        F = N/k > 0: a length. In SI ``normal_force_n``, in N.
    belt_velocity :
        v₀ ≥ 0: a length per τ. In SI ``belt_velocity_m_per_s``, in m/s.
    tangential_stiffness :
        k_t/k > 0 of a contact that adheres elastically before it slips. In SI ``tangential_stiffness_n_per_m``, in N/m [default: rigid].
    normal_stiffness :
        k_n/k > 0 of the contact, through which an actuator gives normal dither. In SI ``normal_stiffness_n_per_m``, in N/m [default: the
        load is prescribed].
    drive, load :
        Velocity of the belt and normal load over time: a :class:`Profile` with ``velocity`` or ``load``, instead of
        ``belt_velocity`` and ``normal_load`` or, as an oscillation, added to them.
    friction :
        A law: :class:`Stribeck`, :class:`Decreasing`, :class:`Coulomb`, :class:`StribeckExponential`, :class:`Lugre`,
        :class:`Expression` (a formula), :class:`Samples` (measured), a function of the slip speed ≥ 0 (see :class:`SampledLaw`), or
        :class:`Friction` with the name of the law.
    dither :
        One :class:`Dither` or several.
    initial :
        "rest", "sliding", "squealing", (x, x′), in m and m/s in a study in SI, or an :class:`Initial` [default: "rest"].
    solver :
        A :class:`Solver`.
    band :
        (lower, upper) frequency, in ω₀, of a band in which the level of the vibration with dither is compared with that
        without. In SI ``band_hz``, in Hz.
    design :
        The table ``[design]`` of :meth:`Study.design`, such as ``{"minimise": "amplitude", "vary": ["dither.amplitude"], "from": [0.01],
        "to": [20], "over": {"belt.belt_velocity": [0.05, 0.2]}}``.
    actuator :
        The table ``[actuator]`` of :meth:`Study.design`, such as ``{"kind": "piezo", "blocked_force_n": 3000, "free_stroke_m": 20e-6,
        "maximum_voltage": 150}``.
    uncertainty :
        The table ``[uncertainty]`` of :meth:`Study.probability`, such as ``{"belt.damping_ratio": {"lognormal": [0.05, 0.5]}}``.
    axes :
        Axes of a map: see :meth:`Study.map`.
    title :
        Title of the study.
    units :
        "SI", "mm-t-s" or "none", the units of numbers without a unit [default: SI where a mass is given].
    mass, stiffness, natural_frequency, damping :
        m, k, ω₀ (angular) and c in the units of the study.
    mass_kg, stiffness_n_per_m :
        m in kg and k in N/m. With them the study is in SI.
    natural_frequency_hz :
        ω₀/2π in Hz, instead of the stiffness. A study in SI may also have ``damping_ratio`` instead of the damping constant.

    Notes
    -----
    A number may be given as a text with a unit, such as ``normal_force_n="4kN"``.

    Raises
    ------
    quell.StudyError
        All complaints at once.
    """

    _own = "belt"

    units: str | None
    damping_ratio: float | None
    damping: float | None
    normal_load: float | None
    belt_velocity: float | None
    tangential_stiffness: float | None
    normal_stiffness: float | None
    mass: float | None
    stiffness: float | None
    natural_frequency: float | None
    mass_kg: float | None
    stiffness_n_per_m: float | None
    natural_frequency_hz: float | None
    damping_n_s_per_m: float | None
    normal_load_n: float | None
    normal_force_n: float | None
    belt_velocity_m_per_s: float | None
    tangential_stiffness_n_per_m: float | None
    normal_stiffness_n_per_m: float | None
    drive: Any
    load: Any

    def __init__(
        self,
        *,
        units: Literal["SI", "mm-t-s", "none"] | None = None,
        damping_ratio: Number | None = None,
        damping: Number | None = None,
        normal_load: Number | None = None,
        belt_velocity: Number | None = None,
        tangential_stiffness: Number | None = None,
        normal_stiffness: Number | None = None,
        friction: Friction | Mapping[str, Any] | Callable[[float], float] | None = None,
        dither: Dither | Iterable[Dither] | None = None,
        initial: Literal["rest", "sliding", "squealing"] | tuple[float, float] | Initial | None = None,
        solver: Solver | None = None,
        band: tuple[Number, Number] | None = None,
        band_hz: tuple[Number, Number] | None = None,
        axes: Axes | None = None,
        title: str | None = None,
        mass: Number | None = None,
        stiffness: Number | None = None,
        natural_frequency: Number | None = None,
        mass_kg: Number | None = None,
        stiffness_n_per_m: Number | None = None,
        natural_frequency_hz: Number | None = None,
        damping_n_s_per_m: Number | None = None,
        normal_load_n: Number | None = None,
        normal_force_n: Number | None = None,
        belt_velocity_m_per_s: Number | None = None,
        tangential_stiffness_n_per_m: Number | None = None,
        normal_stiffness_n_per_m: Number | None = None,
        drive: Profile | Mapping[str, Any] | None = None,
        load: Profile | Mapping[str, Any] | None = None,
        design: Mapping[str, Any] | None = None,
        actuator: Mapping[str, Any] | None = None,
        uncertainty: Mapping[str, Any] | None = None,
        **unknown: Unknown,
    ) -> None:
        keys = given(locals(), *OTHER_TABLES)
        si = any(keys.get(name) is not None for name in ("mass_kg", "stiffness_n_per_m", "natural_frequency_hz"))
        belt = Table(**{**keys, "initial": None if initial is None else start(initial, si)})
        if callable(friction):
            friction = as_law(friction, *speed_of(belt.given, several(dither)))
        self._build(
            title=title,
            belt=belt,
            friction=friction,
            dither=several(dither),
            solver=solver,
            response=levels(band, band_hz),
            design=None if design is None else dict(design),
            actuator=None if actuator is None else dict(actuator),
            uncertainty=None if uncertainty is None else dict(uncertainty),
            sweep=axes_tables(axes),
        )


    @property
    def dithers(self) -> tuple[Dither, ...]:
        """The dithers."""
        return tuple(Dither._of(table) for table in listed_tables(self._document().get("dither")))

    @property
    def dither(self) -> Dither | None:
        """The dither, or ``None``. A belt with several has :attr:`dithers`."""
        found: Dither | None = single(self.dithers, "dithers")
        return found

    @property
    def initial(self) -> Initial:
        """The initial state."""
        found = self._document()["belt"].get("initial", {"state": "rest"})
        return Initial._of(found if isinstance(found, Mapping) else {"state": found})

    @property
    def solver(self) -> Solver:
        """The given settings of the solver."""
        return Solver._of(self._document().get("solver", {}))

    def _arguments(self) -> dict[str, Any]:
        document = self._document()
        arguments = self._common(document)
        own = dict(document.pop("belt"))
        friction = document.pop("friction", None)
        if "initial" in own:
            own["initial"] = self.initial
        if "dither" in document:
            arguments["dither"] = as_given(document.pop("dither"), Dither)
        if "solver" in document:
            document.pop("solver")
            arguments["solver"] = self.solver
        bands = document.pop("response", {})
        return {**arguments, **own, **bands, **document, "friction": None if friction is None else law_of(friction)}


def speed_of(belt: Mapping[str, Any], dither: object) -> tuple[float, bool]:
    """Speed of the belt and peak speed of a free mass under its tangential dithers, and whether it is in m/s.

    Numbers that are texts or invalid do not count: the reader checks them, and the law is valid farther than this speed.
    """
    in_si = any(name in belt for name in ("mass_kg", "stiffness_n_per_m", "natural_frequency_hz"))
    keys = ("belt_velocity_m_per_s", "amplitude_n", "frequency_hz") if in_si else ("belt_velocity", "amplitude", "frequency_ratio")
    inertia = 2.0 * np.pi * number_in(belt, "mass_kg") if in_si else 1.0
    total = max(number_in(belt, keys[0]), fastest(belt.get("drive"), keys[0].removeprefix("belt_")))
    for table in dither if isinstance(dither, list) else [dither]:
        given = table.given if isinstance(table, Table) else table if isinstance(table, Mapping) else {}
        under = inertia * number_in(given, keys[2])
        if given.get("direction") == "tangential" and under > 0.0:
            total += number_in(given, keys[1]) / under
    return total, in_si


def fastest(drive: object, key: str) -> float:
    """Largest speed of a drive over knots; 0 if it has none."""
    given = drive.given if isinstance(drive, Table) else drive if isinstance(drive, Mapping) else {}
    values = given.get(key)
    listed = values if isinstance(values, (list, tuple, np.ndarray)) else []
    speeds = [number_in({key: abs(value)}, key) for value in listed if isinstance(value, (int, float))]
    return max(speeds, default=0.0)


def number_in(table: Mapping[str, Any], key: str) -> float:
    """A number of a table; 0 if it is no finite number ≥ 0."""
    value = table.get(key)
    if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
        return 0.0
    number = float(value)
    return number if np.isfinite(number) and number >= 0.0 else 0.0


def listed_tables(found: Any) -> list[Mapping[str, Any]]:
    """One table or several as a list."""
    return found if isinstance(found, list) else [] if found is None else [found]


def as_given(found: Any, cls: type[Table]) -> Any:
    """One table or a list of them, as in the document."""
    return [cls._of(table) for table in found] if isinstance(found, list) else cls._of(found)


def single(tables: tuple[Any, ...], name: str) -> Any:
    """The only table, or ``None``.

    An AttributeError would be taken for a missing attribute, so that a StudyError names the list.
    """
    if len(tables) > 1:
        allowed = f"read as {name}[0], …: this study has {len(tables)} {name}"
        raise StudyError([complaint(name[:-1], None, allowed, "usage")])
    return tables[0] if tables else None


def start(initial: object, si: bool) -> object:
    """The table of an initial state, in SI if the study is; invalid values are passed through and rejected by the reader."""
    if isinstance(initial, str):
        return Initial(state=initial)  # type: ignore[arg-type]
    if isinstance(initial, tuple) and len(initial) == 2:
        if si:
            return Initial(displacement_m=initial[0], velocity_m_per_s=initial[1])
        return Initial(displacement=initial[0], velocity=initial[1])
    return initial


def levels(band: object, band_hz: object) -> object:
    """The table of a band; invalid values are passed through and rejected by the reader."""
    given = {name: listed(value) for name, value in (("band", band), ("band_hz", band_hz)) if value is not None}
    return Table(**given) if given else None


def listed(value: object) -> object:
    """A tuple as a list."""
    return list(value) if isinstance(value, tuple) else value


def several(given: object) -> object:
    """One table or a list of them."""
    if isinstance(given, Iterable) and not isinstance(given, (str, bytes, Table, Mapping)):
        return list(given)
    return given
