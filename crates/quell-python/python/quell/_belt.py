"""The mass on a moving belt: its tables and its study."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any, Literal

import numpy.typing as npt

from ._axes import Axes, axes_tables
from ._study import Study
from ._tables import Number, Table, Unknown, given

__all__ = [
    "Belt",
    "Coulomb",
    "Decreasing",
    "Dither",
    "Expression",
    "Friction",
    "Initial",
    "Samples",
    "Solver",
    "Stribeck",
    "StribeckExponential",
]


class Friction(Table):
    """A friction law given by its name and its parameters: ``Friction("stribeck", …)``.

    Every law of :func:`quell.schema` can be given this way; the common ones have their own classes.
    """

    _path = "friction"
    law: str

    def __init__(self, law: str, **parameters: Any) -> None:
        super().__init__(law=law, **parameters)


class Stribeck(Friction):
    """The Stribeck law, μ(v) = μ_s − (3/2)(μ_s − μ_m)(w − w³/3) with w = v/v_m > 0, equation (2.7).

    Friction falls to μ_m at v_m, then rises.

    Parameters
    ----------
    static_coefficient, minimum_coefficient :
        μ_s and μ_m, with 0 ≤ μ_m ≤ μ_s, dimensionless.
    reference_velocity :
        v_m, the slip velocity of least friction, as length per τ (velocity/ω₀).
    reference_velocity_m_per_s :
        The same in m/s, in a study in SI.
    """

    def __init__(
        self,
        *,
        static_coefficient: Number | None = None,
        minimum_coefficient: Number | None = None,
        reference_velocity: Number | None = None,
        reference_velocity_m_per_s: Number | None = None,
        **unknown: Unknown,
    ) -> None:
        super().__init__("stribeck", **given(locals()))


class Decreasing(Friction):
    """The decreasing law, μ(v) = μ_m + (μ_s − μ_m) exp(−v/v_m), equation (2.8).

    Parameters
    ----------
    static_coefficient, minimum_coefficient :
        μ_s and μ_m, with 0 ≤ μ_m ≤ μ_s, dimensionless.
    reference_velocity :
        v_m, over which the excess of friction above μ_m falls to 1/e, as length per τ (velocity/ω₀).
    reference_velocity_m_per_s :
        The same in m/s, in a study in SI.
    """

    def __init__(
        self,
        *,
        static_coefficient: Number | None = None,
        minimum_coefficient: Number | None = None,
        reference_velocity: Number | None = None,
        reference_velocity_m_per_s: Number | None = None,
        **unknown: Unknown,
    ) -> None:
        super().__init__("decreasing", **given(locals()))


class Coulomb(Friction):
    """Coulomb friction, μ(v) = μ_d + σ_v v for v > 0, with static friction μ_s ≥ μ_d.

    Parameters
    ----------
    coefficient, static_coefficient :
        μ_d and μ_s, dimensionless [default of μ_s: μ_d].
    viscous :
        σ_v, the rise of the coefficient with slip speed, per length per τ [default: 0].
    viscous_s_per_m :
        The same in s/m, in a study in SI.
    friction_force_n, static_friction_force_n, viscous_n_s_per_m :
        Friction as forces in N and N·s/m instead, in a study in SI. The normal force may then be left out.
    """

    def __init__(
        self,
        coefficient: float | None = None,
        *,
        static_coefficient: float | None = None,
        viscous: float | None = None,
        viscous_s_per_m: float | None = None,
        friction_force_n: float | None = None,
        static_friction_force_n: float | None = None,
        viscous_n_s_per_m: float | None = None,
        **unknown: Unknown,
    ) -> None:
        super().__init__("coulomb", **given(locals()))


class StribeckExponential(Friction):
    """Exponential Stribeck friction, μ(v) = μ_d + (μ_s − μ_d) exp(−(v/v_s)^δ) + σ_v v for v > 0.

    Parameters
    ----------
    coefficient, static_coefficient :
        μ_d and μ_s, dimensionless.
    reference_velocity :
        v_s, over which friction falls, as length per τ (velocity/ω₀).
    exponent :
        δ [default: 2]. Simulation needs 1, 2, 3 or 4; averages accept any δ > 0.
    viscous :
        σ_v, the rise of the coefficient with slip speed, per length per τ [default: 0].
    reference_velocity_m_per_s, viscous_s_per_m :
        The same in m/s and s/m, in a study in SI.
    friction_force_n, static_friction_force_n, viscous_n_s_per_m :
        Friction as forces in N and N·s/m instead, in a study in SI. The normal force may then be left out.
    """

    def __init__(
        self,
        *,
        coefficient: float | None = None,
        static_coefficient: float | None = None,
        reference_velocity: float | None = None,
        exponent: float | None = None,
        viscous: float | None = None,
        reference_velocity_m_per_s: float | None = None,
        viscous_s_per_m: float | None = None,
        friction_force_n: float | None = None,
        static_friction_force_n: float | None = None,
        viscous_n_s_per_m: float | None = None,
        **unknown: Unknown,
    ) -> None:
        super().__init__("stribeck-exponential", **given(locals()))


class Expression(Friction):
    """A friction law as a formula: ``Expression("0.3 + 0.1*exp(-abs(v)/0.2)")``.

    Parameters
    ----------
    coefficient :
        The coefficient as a function of the slip velocity v, in the unit of the belt's velocity, for both directions of
        slip. Its derivatives are exact.
    constants :
        Named numbers of the formula. They can be changed, swept and searched for thresholds as
        ``friction.constants.NAME``.
    static_coefficient :
        μ_s, independent of the formula [default: the value of the formula at v = 0].
    maximum_velocity :
        The slip speed up to which the formula holds and is proven finite, smooth and not negative, as length per τ
        [default: 10 times the speed of belt and dither].
    maximum_velocity_m_per_s :
        The same in m/s, in a study in SI.
    """

    def __init__(
        self,
        coefficient: str | None = None,
        *,
        constants: Mapping[str, float] | None = None,
        static_coefficient: Number | None = None,
        maximum_velocity: Number | None = None,
        maximum_velocity_m_per_s: Number | None = None,
        **unknown: Unknown,
    ) -> None:
        super().__init__("expression", **given(locals()))


class Samples(Friction):
    """A friction law from measured samples: one smooth fit of exponentials, whose error ``Study.check`` reports.

    Parameters
    ----------
    slip_velocity, coefficient :
        Slip speeds ≥ 0 (n,), as length per τ, and the coefficients measured there (n,).
    slip_velocity_m_per_s :
        The same in m/s, in a study in SI.
    file :
        A CSV file with columns of these names, instead of arrays.
    static_coefficient :
        μ_s, independent of the samples [default: the value of the fit at v = 0].
    terms :
        Number of exponentials of the fit [default: the best number].
    """

    def __init__(
        self,
        slip_velocity: npt.ArrayLike | None = None,
        coefficient: npt.ArrayLike | None = None,
        *,
        slip_velocity_m_per_s: npt.ArrayLike | None = None,
        file: str | os.PathLike[str] | None = None,
        static_coefficient: Number | None = None,
        terms: int | None = None,
        **unknown: Unknown,
    ) -> None:
        super().__init__("samples", **given(locals()))


class Dither(Table):
    """One dither force.

    Parameters
    ----------
    direction :
        "tangential", a force on the mass along the belt, or "normal", a variation of the normal load.
    waveform :
        "sine", "triangle" or "square".
    amplitude :
        D, the peak of the force over k: a length, ≥ 0. For a disc: the relative amplitude α.
    frequency_ratio :
        R, in units of ω₀ (belt) or ω_ref (disc), > 0.
    phase :
        Phase at τ = 0, in radians.
    amplitude_n, amplitude_n_rms, frequency_hz :
        The same in N (peak, or root mean square) and Hz, in a study in SI.
    """

    _path = "dither"

    def __init__(
        self,
        direction: Literal["tangential", "normal"] | None = None,
        waveform: Literal["sine", "triangle", "square"] | None = None,
        *,
        amplitude: Number | None = None,
        frequency_ratio: Number | None = None,
        phase: Number | None = None,
        amplitude_n: Number | None = None,
        amplitude_n_rms: Number | None = None,
        frequency_hz: Number | None = None,
        **unknown: Unknown,
    ) -> None:
        super().__init__(**given(locals()))


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

    def __init__(
        self,
        state: Literal["rest", "sliding", "squealing"] | None = None,
        *,
        displacement: Number | None = None,
        velocity: Number | None = None,
        displacement_m: Number | None = None,
        velocity_m_per_s: Number | None = None,
        **unknown: Unknown,
    ) -> None:
        super().__init__(**given(locals()))


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

    def __init__(
        self,
        *,
        tolerance: Number | None = None,
        settle: Number | None = None,
        settle_s: Number | None = None,
        record_periods: int | None = None,
        **unknown: Unknown,
    ) -> None:
        super().__init__(**given(locals()))


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
    friction :
        A law: :class:`Stribeck`, :class:`Decreasing`, :class:`Coulomb`, :class:`StribeckExponential`,
        :class:`Expression` (a formula), :class:`Samples` (measured), or
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
    axes :
        Axes of a map: see :meth:`Study.map`.
    title :
        Title of the study.
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

    def __init__(
        self,
        *,
        damping_ratio: Number | None = None,
        normal_load: Number | None = None,
        belt_velocity: Number | None = None,
        friction: Friction | Mapping[str, Any] | None = None,
        dither: Dither | Iterable[Dither] | None = None,
        initial: Literal["rest", "sliding", "squealing"] | tuple[float, float] | Initial | None = None,
        solver: Solver | None = None,
        band: tuple[Number, Number] | None = None,
        band_hz: tuple[Number, Number] | None = None,
        axes: Axes | None = None,
        title: str | None = None,
        mass_kg: Number | None = None,
        stiffness_n_per_m: Number | None = None,
        natural_frequency_hz: Number | None = None,
        damping_n_s_per_m: Number | None = None,
        normal_force_n: Number | None = None,
        belt_velocity_m_per_s: Number | None = None,
        **unknown: Unknown,
    ) -> None:
        belt = Table(**given(locals(), "friction", "dither", "initial", "solver", "band", "band_hz", "axes", "title"))
        if initial is not None:
            si = any(name in belt.given for name in ("mass_kg", "stiffness_n_per_m", "natural_frequency_hz"))
            belt.given["initial"] = start(initial, si)
        self._build(
            title=title,
            belt=belt,
            friction=friction,
            dither=several(dither),
            solver=solver,
            response=levels(band, band_hz),
            sweep=axes_tables(axes),
        )


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
