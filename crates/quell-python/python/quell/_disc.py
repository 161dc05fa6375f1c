"""The annular disc under rotating loads: its tables and its study."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import Any, Literal

from ._axes import Axes, axes_tables
from ._belt import Dither, as_given, listed_tables, several, single
from ._laws import Friction, law_of
from ._profile import Profile
from ._study import Study
from ._tables import Number, Table, Unknown, given

__all__ = ["Disc", "Load", "Mode"]


class Load(Table):
    """A mass, damper and spring with friction at one point, rotating over the disc.

    Parameters
    ----------
    radius_ratio :
        r₀/a, between b/a and 1; required if modes are computed.
    angle_deg :
        Angle of the load, in degrees; each of several loads has its own.
    mass, damping, stiffness, friction :
        m*, c*, k*, f* of the equations, dimensionless.
    normal_load, half_thickness :
        Normal load under a friction law of the disc, which then gives the follower force instead of ``friction``, and half the
        thickness of the disc over the radius of the load.
    static_load :
        Static load that deflects the disc.
    slip_ratio :
        Peak velocity of tangential dither over the speed of sliding.
    extent_deg, radial_extent, points, radial_points :
        Angle and radial width over which the load is distributed, and numbers of quadrature points.
    pad_mass, pad_damping, pad_stiffness :
        Mass of a pad, and damper and spring between it and the caliper or the ground [default: no pad].
    caliper_mass, caliper_damping, caliper_stiffness :
        Mass, damper and spring of the caliper that carries the pad.
    mass_kg, damping_n_s_per_m, stiffness_n_per_m, friction_n, normal_load_n, static_load_n :
        The same in SI, if the disc has its material.
    pad_mass_kg, pad_damping_n_s_per_m, pad_stiffness_n_per_m :
        The pad in SI.
    caliper_mass_kg, caliper_damping_n_s_per_m, caliper_stiffness_n_per_m :
        The caliper in SI.
    dither_phase_deg :
        Phase of the dither of this load's friction, in degrees [default: 0].
    envelope :
        Share of the load, and with it of friction, over time: a :class:`Profile` with ``share``, or with an ``oscillation`` about 1.
    speed :
        Ω in units of ω_ref, the same for every load.
    speed_hz, speed_rpm :
        The same in revolutions per second or per minute, if the disc has its material or modes in Hz.
    """

    _path = "disc.load"

    radius_ratio: Number | None = None
    angle_deg: Number | None = None
    mass: Number | None = None
    damping: Number | None = None
    stiffness: Number | None = None
    friction: Number | None = None
    mass_kg: Number | None = None
    damping_n_s_per_m: Number | None = None
    stiffness_n_per_m: Number | None = None
    friction_n: Number | None = None
    normal_load: Number | None = None
    normal_load_n: Number | None = None
    half_thickness: Number | None = None
    static_load: Number | None = None
    static_load_n: Number | None = None
    slip_ratio: Number | None = None
    extent_deg: Number | None = None
    radial_extent: Number | None = None
    points: int | None = None
    radial_points: int | None = None
    pad_mass: Number | None = None
    pad_mass_kg: Number | None = None
    pad_damping: Number | None = None
    pad_damping_n_s_per_m: Number | None = None
    pad_stiffness: Number | None = None
    pad_stiffness_n_per_m: Number | None = None
    caliper_mass: Number | None = None
    caliper_mass_kg: Number | None = None
    caliper_damping: Number | None = None
    caliper_damping_n_s_per_m: Number | None = None
    caliper_stiffness: Number | None = None
    caliper_stiffness_n_per_m: Number | None = None
    dither_phase_deg: Number | None = None
    envelope: Profile | Mapping[str, Any] | None = None
    speed: Number | None = None
    speed_hz: Number | None = None
    speed_rpm: Number | None = None


class Mode(Table):
    """A mode of the disc, for modes that are listed instead of computed.

    Parameters
    ----------
    diameters :
        Nodal diameters q.
    ratio, frequency_hz :
        Natural frequency, in ω_ref or in Hz.
    shape_at_load :
        Value of the mode shape at the load; one for each load.
    damping :
        Damping ratio ξ of this mode.
    centrifugal :
        Centrifugal stiffening κ of the mode, β² + κΩ², of a disc that rotates itself.
    """

    _path = "disc.mode"

    diameters: int | None = None
    ratio: Number | None = None
    frequency_hz: Number | None = None
    shape_at_load: Number | None = None
    damping: Number | None = None
    centrifugal: Number | None = None


class Disc(Study):
    """A study of an annular disc, clamped at the inner and free at the outer edge, under rotating loads (chapter 5).

    Parameters
    ----------
    inner_radius_ratio, poisson_ratio :
        b/a and ν, from which modes are computed.
    radial_modes, nodal_diameters :
        N_r and N_θ: modes with 0 to N_θ nodal diameters, N_r of each.
    modal_damping :
        ξ of every mode.
    rotating, centrifugal :
        "loads" or "disc", the part that rotates [default: "loads"], and the centrifugal stiffening of every mode.
    reference_frequency :
        "critical", the lowest critical speed of these modes, or a frequency parameter k².
    mode :
        Listed modes instead of computed ones: one :class:`Mode` or several.
    modes_file :
        A CSV file of modes instead of computed ones.
    load :
        One :class:`Load` or several.
    drive :
        Speed over time, a :class:`Profile` with ``speed``, instead of the speed of the loads, or with an ``oscillation`` about it.
    friction :
        A friction law, for loads with a normal load.
    dither :
        A :class:`Dither` of the friction, of any waveform [default: "sine"]; it leads by a quarter of a cycle, so that a sine is
        cos Rτ.
    design :
        The table ``[design]`` of :meth:`Study.design`, such as ``{"minimise": "amplitude", "vary": ["dither.amplitude",
        "dither.frequency_ratio"], "from": [0, 2], "to": [1, 6], "over": {"disc.load.speed": [0.25, 0.9]}}``.
    without :
        Contributions that are left out of the equations.
    units :
        "SI", "mm-t-s" or "none", the units of numbers of loads and dither without a unit [default: "none"].
    youngs_modulus_pa, density_kg_per_m3, thickness_m, outer_radius_m :
        Material and size, with which frequencies are also given in Hz.
    plate_mass_kg :
        Mass of the plate whose modes are listed; with it their loads may be in SI.
    uncertainty :
        The table ``[uncertainty]`` of :meth:`Study.probability`, such as ``{"disc.load.friction": {"lognormal": [0.25, 0.1]}}``.
    axes :
        Axes of a map: see :meth:`Study.map`.
    title :
        Title of the study.

    Raises
    ------
    quell.StudyError
        All complaints at once.
    """

    _own = "disc"

    units: str | None
    inner_radius_ratio: float | None
    poisson_ratio: float | None
    modal_damping: float | None
    rotating: str | None
    centrifugal: float | None
    radial_modes: int | None
    nodal_diameters: int | None
    reference_frequency: str | float | None
    modes_file: str | None
    drive: Any
    without: list[str] | None
    youngs_modulus_pa: float | None
    density_kg_per_m3: float | None
    thickness_m: float | None
    outer_radius_m: float | None
    plate_mass_kg: float | None

    def __init__(
        self,
        *,
        units: Literal["SI", "mm-t-s", "none"] | None = None,
        inner_radius_ratio: Number | None = None,
        poisson_ratio: Number | None = None,
        modal_damping: Number | None = None,
        rotating: Literal["loads", "disc"] | None = None,
        centrifugal: Number | None = None,
        radial_modes: int | None = None,
        nodal_diameters: int | None = None,
        reference_frequency: Literal["critical"] | Number | None = None,
        mode: Mode | Iterable[Mode] | None = None,
        modes_file: str | os.PathLike[str] | None = None,
        load: Load | Iterable[Load] | None = None,
        drive: Profile | Mapping[str, Any] | None = None,
        friction: Friction | Mapping[str, Any] | None = None,
        dither: Dither | Iterable[Dither] | None = None,
        design: Mapping[str, Any] | None = None,
        without: Iterable[str] | None = None,
        youngs_modulus_pa: Number | None = None,
        density_kg_per_m3: Number | None = None,
        thickness_m: Number | None = None,
        outer_radius_m: Number | None = None,
        plate_mass_kg: Number | None = None,
        uncertainty: Mapping[str, Any] | None = None,
        axes: Axes | None = None,
        title: str | None = None,
        **unknown: Unknown,
    ) -> None:
        keys = given(locals(), "mode", "load", "friction", "dither", "design", "uncertainty", "axes", "title")
        modes = [mode] if isinstance(mode, Table) else several(mode)
        disc = Table(**{**keys, "without": several(without), "mode": modes, "load": several(load)})
        self._build(
            title=title,
            disc=disc,
            friction=friction,
            dither=several(dither),
            design=None if design is None else dict(design),
            uncertainty=None if uncertainty is None else dict(uncertainty),
            sweep=axes_tables(axes),
        )

    @property
    def loads(self) -> tuple[Load, ...]:
        """The loads."""
        return tuple(Load._of(table) for table in listed_tables(self._document()["disc"].get("load")))

    @property
    def load(self) -> Load | None:
        """The load, or ``None``. A disc with several has :attr:`loads`."""
        found: Load | None = single(self.loads, "loads")
        return found

    @property
    def mode(self) -> tuple[Mode, ...]:
        """The listed modes."""
        return tuple(Mode._of(table) for table in listed_tables(self._document()["disc"].get("mode")))

    @property
    def dither(self) -> Dither | None:
        """The dither, or ``None``."""
        found: Dither | None = single(tuple(Dither._of(it) for it in listed_tables(self._document().get("dither"))), "dithers")
        return found

    def _arguments(self) -> dict[str, Any]:
        document = self._document()
        arguments = self._common(document)
        own = dict(document.pop("disc"))
        friction = document.pop("friction", None)
        for name, cls in (("load", Load), ("mode", Mode)):
            if name in own:
                arguments[name] = as_given(own.pop(name), cls)
        if "dither" in document:
            arguments["dither"] = as_given(document.pop("dither"), Dither)
        return {**arguments, **own, **document, "friction": None if friction is None else law_of(friction)}
