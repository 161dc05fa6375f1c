"""Friction laws: one class for each law, and the law of a study."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, overload

import numpy as np
import numpy.typing as npt

from ._arguments import Arguments, keywords
from ._errors import StudyError, complaint
from ._frozen import frozen
from ._tables import Number, Table, key
from ._values import plain

if TYPE_CHECKING:
    from . import results
    from ._study import Study

LARGEST_ERROR = 0.01
"""Default bound on the error of a fit, as a fraction of the largest coefficient."""

POINTS_OF_A_CHECK = 2001
"""Speeds at which a fit is compared with its function."""

RANGE_OF_A_FUNCTION = 10.0
"""Range of a function without a maximum velocity, over the speed of belt and dither."""

__all__ = [
    "Coulomb",
    "Decreasing",
    "Expression",
    "Friction",
    "Lugre",
    "SampledLaw",
    "Samples",
    "Stribeck",
    "StribeckExponential",
    "StudyFriction",
    "as_law",
    "law_of",
]


class Friction(Table):
    """A friction law given by its name and its parameters: ``Friction("stribeck", …)``.

    Every law of :func:`quell.schema` can be given this way; the common ones have their own classes.
    """

    _path = "friction"

    def __init__(self, law: str, **parameters: Any) -> None:
        super().__init__(law=law, **parameters)

    @property
    def law(self) -> str:
        """Name of the law."""
        return str(self.given.get("law"))

    if TYPE_CHECKING:
        # Which parameters a law has depends on its name.
        def __getattr__(self, name: str) -> Any: ...

    def __repr__(self) -> str:
        shown = {name: value for name, value in self.given.items() if name != "law" or type(self) is Friction}
        inside = ", ".join(f"{name}={value!r}" for name, value in shown.items())
        return f"quell.{type(self).__name__}({inside})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Friction) and other.given == self.given

    __hash__ = None


class NamedLaw(Friction):
    """A law with a class of its own."""

    _law: ClassVar[str]

    def __init__(self, *places: Any, **keys: Any) -> None:
        Table.__init__(self, *places, law=self._law, **keys)


class Stribeck(NamedLaw):
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
    static_coefficient_n, minimum_coefficient_n :
        Friction as forces in N instead, in a study with units. The normal load may then be left out.
    friction_force :
        Whether the coefficients are forces, in the unit of the study [default: False].
    static_friction_force_n :
        Older name of ``static_coefficient_n``.
    """

    _law = "stribeck"

    static_coefficient: Number | None = None
    minimum_coefficient: Number | None = None
    reference_velocity: Number | None = None
    reference_velocity_m_per_s: Number | None = None
    friction_force: bool | None = None
    static_coefficient_n: Number | None = None
    minimum_coefficient_n: Number | None = None
    static_friction_force_n: Number | None = None


class Decreasing(NamedLaw):
    """The decreasing law, μ(v) = μ_m + (μ_s − μ_m) exp(−v/v_m), equation (2.8).

    Parameters
    ----------
    static_coefficient, minimum_coefficient :
        μ_s and μ_m, with 0 ≤ μ_m ≤ μ_s, dimensionless.
    reference_velocity :
        v_m, over which the excess of friction above μ_m falls to 1/e, as length per τ (velocity/ω₀).
    reference_velocity_m_per_s :
        The same in m/s, in a study in SI.
    static_coefficient_n, minimum_coefficient_n :
        Friction as forces in N instead, in a study with units. The normal load may then be left out.
    friction_force :
        Whether the coefficients are forces, in the unit of the study [default: False].
    static_friction_force_n :
        Older name of ``static_coefficient_n``.
    """

    _law = "decreasing"

    static_coefficient: Number | None = None
    minimum_coefficient: Number | None = None
    reference_velocity: Number | None = None
    reference_velocity_m_per_s: Number | None = None
    friction_force: bool | None = None
    static_coefficient_n: Number | None = None
    minimum_coefficient_n: Number | None = None
    static_friction_force_n: Number | None = None


class Coulomb(NamedLaw):
    """Coulomb friction, μ(v) = μ_d + σ_v v for v > 0, with static friction μ_s ≥ μ_d.

    Parameters
    ----------
    coefficient, static_coefficient :
        μ_d and μ_s, dimensionless [default of μ_s: μ_d].
    viscous :
        σ_v, the rise of the coefficient with slip speed, per length per τ [default: 0].
    viscous_s_per_m :
        The same in s/m, in a study in SI.
    coefficient_n, static_coefficient_n, viscous_n_s_per_m :
        Friction as forces in N and N·s/m instead, in a study with units. The normal load may then be left out.
    friction_force :
        Whether the coefficients are forces, in the unit of the study [default: False].
    friction_force_n, static_friction_force_n :
        Older names of ``coefficient_n`` and ``static_coefficient_n``.
    """

    _law = "coulomb"

    coefficient: float | None = key(default=None, kw_only=False)
    static_coefficient: float | None = None
    viscous: float | None = None
    viscous_s_per_m: float | None = None
    friction_force: bool | None = None
    coefficient_n: Number | None = None
    static_coefficient_n: Number | None = None
    friction_force_n: float | None = None
    static_friction_force_n: float | None = None
    viscous_n_s_per_m: float | None = None


class StribeckExponential(NamedLaw):
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
    coefficient_n, static_coefficient_n, viscous_n_s_per_m :
        Friction as forces in N and N·s/m instead, in a study with units. The normal load may then be left out.
    friction_force :
        Whether the coefficients are forces, in the unit of the study [default: False].
    friction_force_n, static_friction_force_n :
        Older names of ``coefficient_n`` and ``static_coefficient_n``.
    """

    _law = "stribeck-exponential"

    coefficient: float | None = None
    static_coefficient: float | None = None
    reference_velocity: float | None = None
    exponent: float | None = None
    viscous: float | None = None
    reference_velocity_m_per_s: float | None = None
    viscous_s_per_m: float | None = None
    friction_force: bool | None = None
    coefficient_n: Number | None = None
    static_coefficient_n: Number | None = None
    friction_force_n: float | None = None
    static_friction_force_n: float | None = None
    viscous_n_s_per_m: float | None = None


class Lugre(NamedLaw):
    """LuGre friction: T/N = σ₀z + σ₁ż + σ₂v with ż = v − σ₀|v|z/g(v) and g(v) = μ_c + (μ_s − μ_c) exp(−(v/v_s)²).

    The deflection z of the bristles is a state. ``simulate`` and ``friction`` take it into account; verbs that cannot refuse the law.

    Parameters
    ----------
    coefficient, static_coefficient :
        μ_c and μ_s, dimensionless.
    reference_velocity :
        v_s, over which friction falls, as length per τ (velocity/ω₀).
    bristle_stiffness :
        σ₀, per length.
    bristle_damping :
        σ₁, per length per τ [default: 0].
    viscous :
        σ₂, the rise of the coefficient with slip speed, per length per τ [default: 0].
    reference_velocity_m_per_s, bristle_stiffness_per_m, bristle_damping_s_per_m, viscous_s_per_m :
        The same in m/s, 1/m and s/m, in a study in SI.
    coefficient_n, static_coefficient_n, viscous_n_s_per_m :
        Friction as forces in N and N·s/m instead, in a study with units. The normal load may then be left out.
    friction_force :
        Whether the coefficients are forces, in the unit of the study [default: False].
    friction_force_n, static_friction_force_n :
        Older names of ``coefficient_n`` and ``static_coefficient_n``.
    """

    _law = "lugre"

    coefficient: float | None = None
    static_coefficient: float | None = None
    reference_velocity: float | None = None
    bristle_stiffness: float | None = None
    bristle_damping: float | None = None
    viscous: float | None = None
    reference_velocity_m_per_s: float | None = None
    bristle_stiffness_per_m: float | None = None
    bristle_damping_s_per_m: float | None = None
    viscous_s_per_m: float | None = None
    friction_force: bool | None = None
    coefficient_n: Number | None = None
    static_coefficient_n: Number | None = None
    friction_force_n: float | None = None
    static_friction_force_n: float | None = None
    viscous_n_s_per_m: float | None = None


class Expression(NamedLaw):
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

    _law = "expression"

    coefficient: str | None = key(default=None, kw_only=False)
    constants: Mapping[str, float] | None = None
    static_coefficient: Number | None = None
    maximum_velocity: Number | None = None
    maximum_velocity_m_per_s: Number | None = None


class Samples(NamedLaw):
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

    _law = "samples"

    slip_velocity: npt.ArrayLike | None = key(default=None, kw_only=False)
    coefficient: npt.ArrayLike | None = key(default=None, kw_only=False)
    slip_velocity_m_per_s: npt.ArrayLike | None = None
    file: str | os.PathLike[str] | None = None
    static_coefficient: Number | None = None
    terms: int | None = None

    def _read(self, keys: dict[str, Any]) -> dict[str, Any]:
        lists = {name: plain(keys.get(name)) for name in ("slip_velocity", "slip_velocity_m_per_s", "coefficient")}
        return {**keys, **lists}


class SampledLaw(Samples):
    """A friction law from a function of the slip speed, which is sampled and fitted as :class:`Samples`.

    A function given as the friction of a study (``friction=lambda v: …``) becomes such a law up to 10 times the speed of belt and
    dither.

    Parameters
    ----------
    function :
        The coefficient of friction at a slip speed ≥ 0, in the unit of the study.
    maximum_velocity :
        Slip speed up to which it is sampled, as length per τ (velocity/ω₀); of a system in its unit of velocity.
    maximum_velocity_m_per_s :
        The same in m/s, in a study in SI.
    static_coefficient :
        μ_s, independent of the function [default: the value of the fit at v = 0].
    terms :
        Number of exponentials of the fit [default: the best number].
    largest_error :
        Bound on the difference between function and fit, as a fraction of the largest coefficient; beyond it a UserWarning is
        raised [default: 0.01].

    Attributes
    ----------
    error : float
        The largest difference between function and fit between the samples, a coefficient of friction.
    """

    @property
    def error(self) -> float:
        """The largest difference between function and fit."""
        return float(self.__dict__["_error"])

    def __init__(
        self,
        function: Callable[[float], float],
        maximum_velocity: Number | None = None,
        *,
        maximum_velocity_m_per_s: Number | None = None,
        static_coefficient: Number | None = None,
        terms: int | None = None,
        largest_error: float = LARGEST_ERROR,
    ) -> None:
        from ._sampling import sampled

        arguments = Arguments()
        in_si = maximum_velocity_m_per_s is not None
        name = "maximum_velocity_m_per_s" if in_si else "maximum_velocity"
        top = arguments.number(name, maximum_velocity_m_per_s if in_si else maximum_velocity, "a slip speed above 0")
        bound = arguments.number("largest_error", largest_error)
        if in_si and maximum_velocity is not None:
            arguments.wrong.append(complaint("maximum_velocity", maximum_velocity, "given without its twin in SI", "conflict"))
        if not callable(function):
            arguments.wrong.append(complaint("function", function, "a function of the slip speed"))
        elif not top > 0.0:
            arguments.wrong.append(complaint(name, top, "a slip speed above 0"))
        arguments.done()
        speeds, coefficients = sampled(function, top)
        super().__init__(
            None if in_si else speeds,
            coefficients,
            slip_velocity_m_per_s=speeds if in_si else None,
            static_coefficient=static_coefficient,
            terms=terms,
        )
        self._check(function, top, bound)

    def _check(self, function: Callable[[float], float], top: float, bound: float) -> None:
        """Compares the fit with the function, and warns where it is off."""
        from ._sampling import fitted

        speeds = np.linspace(0.0, top, POINTS_OF_A_CHECK)[1:]
        wanted = np.array([float(function(float(speed))) for speed in speeds])
        off = np.abs(fitted(self.given["coefficient"], speeds_of(self.given), self.given.get("terms"), speeds) - wanted)
        error = float(off.max())
        self._keep(_error=error)
        largest = float(np.abs(wanted).max())
        if error > bound * largest:
            where = float(speeds[off.argmax()])
            warnings.warn(
                f"the fit of this friction law is off by {error:.2g} at the slip speed {where:.4g}, more than {bound:g} of its largest "
                f"coefficient {largest:.4g}; quell.Expression takes a formula exactly",
                UserWarning,
                stacklevel=3,
            )


def speeds_of(table: Mapping[str, Any]) -> Any:
    """The slip speeds of samples, in either unit."""
    return table.get("slip_velocity", table.get("slip_velocity_m_per_s"))


def as_law(friction: Any, speed: float, in_si: bool) -> Any:
    """A friction law; of a function the sampled law up to 10 times a speed. Invalid values are rejected by the reader."""
    if isinstance(friction, (Table, Mapping)) or not callable(friction):
        return friction
    if not (np.isfinite(speed) and speed > 0.0):
        allowed = "quell.SampledLaw(function, maximum_velocity): the speed of belt and dither is not known here"
        raise StudyError([complaint("friction", friction, allowed)])
    top = RANGE_OF_A_FUNCTION * speed
    return SampledLaw(friction, maximum_velocity_m_per_s=top) if in_si else SampledLaw(friction, top)


CLASSES: dict[str, type[Friction]] = {
    "stribeck": Stribeck,
    "decreasing": Decreasing,
    "coulomb": Coulomb,
    "stribeck-exponential": StribeckExponential,
    "expression": Expression,
    "samples": Samples,
}
"""Classes by the name of the law."""


def law_of(table: Mapping[str, Any]) -> Friction:
    """The law of a table of a study."""
    return CLASSES.get(str(table.get("law")), Friction)._of(table)


class StudyFriction(Friction):
    """The friction of a study: the numbers of its law are attributes, and a call is the verb ``friction``.

    ::

        belt.friction.static_coefficient
        belt.friction(at=[0.1, 0.2]).coefficient
    """

    _study: Study

    def __init__(self, study: Study, table: Mapping[str, Any]) -> None:
        self._keep(given=frozen(dict(table)), _study=study)

    def replace(self, **changes: Any) -> Friction:  # type: ignore[override]
        """The law with other numbers."""
        return law_of(self.given).replace(**changes)

    def _keys(self) -> tuple[str, ...]:
        return law_of(self.given)._keys()

    def __repr__(self) -> str:
        return repr(law_of(self.given)) if self.given else "<no friction law for the whole study>"

    def __reduce__(self) -> tuple[type[StudyFriction], tuple[Any, ...]]:
        return type(self), (self._study, self.given)

    @overload
    def __call__(
        self, at: npt.ArrayLike | str | Sequence[str] | None = None, measured: bool = False
    ) -> results.FrictionCurve: ...
    @overload
    def __call__(self, *, describing: Number) -> results.DescribingFunction: ...
    @keywords
    def __call__(
        self,
        at: npt.ArrayLike | str | Sequence[str] | None = None,
        measured: bool = False,
        describing: Number | None = None,
    ) -> results.FrictionCurve | results.DescribingFunction:
        """The friction law and the effective friction under the dither, equations (2.21), (3.19)–(3.27), (4.27).

        Parameters
        ----------
        at :
            Slip velocities of any shape, which is flattened; in m/s in a study in SI, of a system in its units, or texts with
            units such as ``"20mm/s"`` [default: a grid that shows the law].
        measured :
            One mass: whether friction is also measured on steady responses, equations (4.30) and (4.31), stick included, instead of
            averaged [default: False].
        describing :
            Largest velocity amplitude a of a slow sinusoid: the describing function of averaged friction under the slip velocity
            v₀ + a sin φ, and the limit cycles that it predicts (Gelb and Vander Velde 1968), instead of the curve.

        Returns
        -------
        quell.results.FrictionCurve or quell.results.DescribingFunction
            μ, μ̄ and μ̄′ over ``slip_velocity`` (n,) of every contact, and the measured ⟨f/N⟩ if requested; with ``describing`` mean
            coefficient and gain over ``velocity_amplitude`` (n,).
        """
        from . import results

        study, native = self._study, self._study._native
        curve = results.FrictionCurve
        if describing is not None:
            arguments = Arguments()
            allowed = "a velocity amplitude above 0"
            largest = arguments.quantity("describing", describing, allowed)
            if at is not None or measured:
                arguments.wrong.append(complaint("describing", None, "given without at and measured", "conflict"))
            arguments.done()
            return results.DescribingFunction._of(study, native.describing(largest))
        where: npt.NDArray[np.float64] | None = None
        at = plain(at)
        if isinstance(at, str):
            at = [at]
        if isinstance(at, Sequence) and at and all(isinstance(it, str) for it in at):
            return curve._of(study, native.friction(None, [str(it) for it in at], bool(measured)))
        if at is not None:
            try:
                where = np.atleast_1d(np.asarray(at, dtype=np.float64)).ravel()
            except (TypeError, ValueError, OverflowError):
                raise StudyError([complaint("at", at, "slip velocities: finite numbers")]) from None
        return curve._of(study, native.friction(where, [], bool(measured)))
