"""A structure with friction contacts: its tables and its study."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal, Union, overload

import numpy.typing as npt

from ._axes import Axes, axes_tables
from ._belt import PeriodicForce, Waveform, as_given, listed_tables, number_in, several, single
from ._laws import Friction, as_law, law_of
from ._names import suggestion
from ._profile import Profile
from ._study import Study
from ._tables import Number, Table, Unknown, given, key

__all__ = ["Component", "Contact", "System", "SystemDither", "SystemInitial", "SystemMode"]

Row = Union["Mapping[str, Number]", "npt.ArrayLike"]
"""One number for each coordinate: an array, or a dict of names in which missing names are 0."""

Entries = Union["npt.ArrayLike", "Iterable[Iterable[Number]]", "Mapping[str, str]"]
"""A matrix: a diagonal, rows, or a Matrix Market file ``{"file": "M.mtx"}``. An entry may be a formula of the study's parameters, as a text."""


OTHER_TABLES = ("contact", "friction", "dither", "initial", "parameters", "design", "actuator", "uncertainty", "axes", "title", "mode", "component")
"""Arguments of a system that are tables of their own."""


class Contact(Table):
    """A friction contact of a system.

    Parameters
    ----------
    name :
        Name of the contact, by which paths such as ``contact.pad.normal_load`` address it [default: contact 1, 2, …].
    tangent :
        Row of the displacement along the surface.
    normal :
        Row of the approach, which changes the load [default: the load is prescribed].
    slope :
        Row of the slope of the surface, which turns friction by that angle.
    force :
        Effect of the friction force on the states of first-order equations.
    normal_load :
        Steady normal load, > 0.
    normal_stiffness, normal_damping :
        Stiffness and damping of the contact along ``normal`` [default: 0].
    tangential_stiffness :
        Stiffness along the surface, > 0, of a contact that adheres elastically before it slips [default: rigid].
    belt_velocity :
        Velocity of the moving surface.
    normal_load_n, normal_stiffness_n_per_m, normal_damping_n_s_per_m, tangential_stiffness_n_per_m, belt_velocity_m_per_s :
        The same in SI, in a study with units.
    drive, load :
        Velocity of the surface and normal load over time: a :class:`Profile` with ``velocity`` or ``load``, instead of
        ``belt_velocity`` and ``normal_load`` or, as an oscillation, added to them.
    friction :
        A friction law, such as :class:`Coulomb`, or a function of the slip speed ≥ 0 (see :class:`SampledLaw`) [default: that of
        the study].
    """

    _path = "contact"

    name: str | None = key(default=None, kw_only=False)
    tangent: Row | None = None
    normal: Row | None = None
    slope: Row | None = None
    force: Row | None = None
    normal_load: Number | None = None
    normal_stiffness: Number | None = None
    normal_damping: Number | None = None
    tangential_stiffness: Number | None = None
    belt_velocity: Number | None = None
    normal_load_n: Number | None = None
    normal_stiffness_n_per_m: Number | None = None
    normal_damping_n_s_per_m: Number | None = None
    tangential_stiffness_n_per_m: Number | None = None
    belt_velocity_m_per_s: Number | None = None
    friction: Friction | Mapping[str, Any] | Callable[[float], float] | None = None
    drive: Profile | Mapping[str, Any] | None = None
    load: Profile | Mapping[str, Any] | None = None

    def _read(self, keys: dict[str, Any]) -> dict[str, Any]:
        if callable(keys.get("friction")):
            in_si = keys.get("belt_velocity_m_per_s") is not None
            speed = number_in(keys, "belt_velocity_m_per_s" if in_si else "belt_velocity")
            keys["friction"] = as_law(keys["friction"], speed, in_si)
        return keys


class SystemDither(PeriodicForce):
    """A periodic force on a system, or a modulation of the load of a contact.

    Parameters
    ----------
    at :
        Row of the force over the coordinates.
    contact, direction :
        Instead of ``at``: the name of a contact, and "normal" for a modulation of its load, "tangential" for a force along
        its tangent, or "friction" for a factor on its friction.
    reaction :
        Whether the structure bears the modulation of the load [default: True].
    waveform :
        "sine", "triangle" or "square"; "fourier", "samples", "burst" or "noise" with the keys below; or a function of the phase in
        radians, which is sampled over one period.
    amplitude, frequency, phase :
        Peak of the force or of the factor, angular frequency, and phase at time 0 in radians [default: 0].
    frequency_ratio :
        The frequency over the natural frequency, of a system of one coordinate.
    mean :
        "friction": mean of the factor [default: 1]; factors on one contact are added.
    amplitude_n, amplitude_n_rms, frequency_hz :
        The same in N (peak, or root mean square) and Hz, in a study with units.
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
        "noise": lowest and highest angular frequency, instead of ``frequency`` and ``phase``; the number of equal lines
        [default: 64]; and the seed of their frequencies and phases [default: 1]. ``band_hz``: the band in Hz, in a study with units.
    envelope :
        Share of the amplitude over time: a :class:`Profile` with ``share``.
    """

    _path = "dither"

    at: Row | None = key(default=None, kw_only=False)
    waveform: Waveform | None = key(default=None, kw_only=False)
    contact: str | None = None
    direction: Literal["tangential", "normal", "friction"] | None = None
    reaction: bool | None = None
    mean: Number | None = None


class SystemInitial(Table):
    """The initial state of a run of a system: a named state, or numbers.

    Parameters
    ----------
    state :
        "rest", "sliding" (steady sliding without dither), "squealing" or "base" (the dithered response).
    displacements, velocities :
        Displacement and velocity of each coordinate [default: 0].
    displacements_m, velocities_m_per_s :
        The same in SI, in a study with units.
    values :
        The whole state instead.
    """

    _path = "system.initial"

    state: Literal["rest", "sliding", "squealing", "base"] | None = key(default=None, kw_only=False)
    displacements: Row | None = None
    velocities: Row | None = None
    displacements_m: Row | None = None
    velocities_m_per_s: Row | None = None
    values: Row | None = None


class SystemMode(Table):
    """A mode of a structure.

    Parameters
    ----------
    frequency, frequency_hz :
        Natural angular frequency, or in Hz in a study with units.
    damping_ratio :
        Damping ratio of the mode.
    shape :
        Displacement of each point in the mode, by name.
    modal_mass, modal_mass_kg :
        Modal mass, if shapes have any size [default: 1].
    """

    _path = "system.mode"

    frequency: Number | None = None
    frequency_hz: Number | None = None
    damping_ratio: Number | None = None
    modal_mass: Number | None = None
    modal_mass_kg: Number | None = None
    shape: Row | None = None


class Component(Table):
    """A body given by its modes; several bodies are joined by contacts.

    Parameters
    ----------
    name :
        Name of the body, the first part of the names of its points.
    mode :
        One :class:`SystemMode` or several.
    modes :
        A CSV file of modes instead.
    normalisation :
        "mass" (shapes of unit modal mass) or "max" (shapes of any size, with a modal mass) [default: "mass"].
    """

    _path = "system.component"

    name: str | None = key(default=None, kw_only=False)
    mode: SystemMode | Iterable[SystemMode] | None = None
    modes: str | os.PathLike[str] | None = None
    normalisation: Literal["mass", "max"] | None = None

    def _read(self, keys: dict[str, Any]) -> dict[str, Any]:
        return {**keys, "mode": tables(keys.get("mode"))}


class System(Study):
    """A study of a linear structure with friction contacts.

    The structure is given by one of these: matrices over named coordinates, first-order equations, modes, several bodies with
    modes, or a measured frequency response.

    Parameters
    ----------
    coordinates :
        Names of the coordinates.
    mass, damping, stiffness :
        Matrices: a diagonal, rows, or a Matrix Market file ``{"file": "M.mtx"}``. The springs and dampers of contacts are not part of
        them.
    states, matrix :
        Names of the states of first-order equations, and their matrix: rows, or a file.
    mode, modes, normalisation :
        One :class:`SystemMode` or several, or a CSV file of modes, and the size of their shapes.
    component :
        One :class:`Component` or several.
    frequency_response :
        A CSV file of a measured receptance.
    force :
        Constant forces [default: 0].
    mass_kg, damping_n_s_per_m, stiffness_n_per_m, force_n :
        The same in SI, in a study with units.
    units :
        "none", "SI" or "mm-t-s": the unit of bare numbers [default: "none"].
    contact :
        One :class:`Contact` or several.
    friction :
        Friction law of contacts that have none of their own.
    dither :
        One :class:`SystemDither` or several.
    observe :
        Row of the displacement that a response measures [default: the tangent of the first contact].
    initial :
        "rest", "sliding", "squealing", "base", or a :class:`SystemInitial` [default: "rest"].
    parameters :
        Named numbers for formulas; a text in place of a number is a formula of them, such as ``stiffness=[[2, "1 - kappa"], …]``.
    design :
        The table ``[design]`` of :meth:`Study.design`, such as ``{"minimise": "amplitude", "vary": ["dither.amplitude"], "from": [0.01],
        "to": [20], "over": {"contact.pad.belt_velocity": [0.05, 0.2]}}``.
    actuator :
        The table ``[actuator]`` of :meth:`Study.design`, such as ``{"kind": "piezo", "blocked_force": 3000, "free_stroke": 20e-6,
        "maximum_voltage": 150}``.
    uncertainty :
        The table ``[uncertainty]`` of :meth:`Study.probability`, such as ``{"contact.pad.friction.coefficient": {"lognormal": [0.5, 0.1]}}``.
    axes :
        Axes of a map: see :meth:`Study.map`.
    title :
        Title of the study.

    Raises
    ------
    quell.StudyError
        All complaints at once.

    Examples
    --------
    >>> import quell
    >>> system = quell.System(
    ...     coordinates=["x", "y"],
    ...     mass=[1, 1],
    ...     damping=[0.05, 0.05],
    ...     stiffness=[[2, 1], [1, 2 / 3]],
    ...     contact=quell.Contact(
    ...         "pad",
    ...         tangent={"x": 1},
    ...         normal={"y": 1},
    ...         normal_load=1,
    ...         normal_stiffness=4 / 3,
    ...         belt_velocity=1,
    ...         friction=quell.Coulomb(0.5),
    ...     ),
    ... )
    >>> system.stability().verdict
    'stable'
    >>> hopf = system.thresholds("contact.pad.friction.coefficient", 0.6, 0.9).local[-1]
    >>> hopf["kind"], round(hopf["value"], 9), hopf["becomes"]
    ('hopf', 0.75375, 'unstable')
    """

    _own = "system"

    coordinates: list[str] | None
    mass: list[Any] | dict[str, str] | None
    damping: list[Any] | dict[str, str] | None
    stiffness: list[Any] | dict[str, str] | None
    states: list[str] | None
    matrix: list[Any] | dict[str, str] | None
    force: list[Any] | dict[str, Any] | None
    normalisation: str | None
    frequency_response: str | None
    units: str | None
    observe: list[Any] | dict[str, Any] | None
    mass_kg: list[Any] | dict[str, str] | None
    damping_n_s_per_m: list[Any] | dict[str, str] | None
    stiffness_n_per_m: list[Any] | dict[str, str] | None
    force_n: list[Any] | dict[str, Any] | None

    def __init__(
        self,
        *,
        coordinates: Iterable[str] | None = None,
        mass: Entries | None = None,
        damping: Entries | None = None,
        stiffness: Entries | None = None,
        states: Iterable[str] | None = None,
        matrix: Entries | None = None,
        force: Row | None = None,
        mode: SystemMode | Iterable[SystemMode] | None = None,
        modes: str | os.PathLike[str] | None = None,
        normalisation: Literal["mass", "max"] | None = None,
        component: Component | Iterable[Component] | None = None,
        frequency_response: str | os.PathLike[str] | None = None,
        units: Literal["none", "SI", "mm-t-s"] | None = None,
        observe: Row | None = None,
        mass_kg: Entries | None = None,
        damping_n_s_per_m: Entries | None = None,
        stiffness_n_per_m: Entries | None = None,
        force_n: Row | None = None,
        contact: Contact | Iterable[Contact] | None = None,
        friction: Friction | Mapping[str, Any] | None = None,
        dither: SystemDither | Iterable[SystemDither] | None = None,
        initial: Literal["rest", "sliding", "squealing", "base"] | SystemInitial | None = None,
        parameters: Mapping[str, Number] | None = None,
        design: Mapping[str, Any] | None = None,
        actuator: Mapping[str, Any] | None = None,
        uncertainty: Mapping[str, Any] | None = None,
        axes: Axes | None = None,
        title: str | None = None,
        **unknown: Unknown,
    ) -> None:
        keys = given(locals(), *OTHER_TABLES)
        start = SystemInitial(initial) if isinstance(initial, str) else initial
        names = {name: several(keys[name]) for name in ("coordinates", "states")}
        system = Table(**{**keys, **names, "mode": tables(mode), "component": tables(component), "initial": start})
        self._build(
            title=title,
            parameters=None if parameters is None else Table(**parameters),
            system=system,
            contact=tables(contact),
            friction=friction,
            dither=tables(dither),
            design=None if design is None else dict(design),
            actuator=None if actuator is None else dict(actuator),
            uncertainty=None if uncertainty is None else dict(uncertainty),
            sweep=axes_tables(axes),
        )


    @property
    def notes(self) -> tuple[str, ...]:
        """What a function that reads files (``quell.from_nastran``, …) left out of the file, or decided, in sentences; empty otherwise.

        A study that is changed by :meth:`set` or :meth:`replace` has none.
        """
        found: tuple[str, ...] = self.__dict__.get("_notes", ())
        return found

    @property
    def contacts(self) -> Contacts:
        """The contacts, by name or place: ``system.contacts["pad"].friction.coefficient``."""
        document = self._document()
        found = []
        for place, table in enumerate(listed_tables(document.get("contact"))):
            law = table.get("friction", document.get("friction"))
            own = {} if law is None else {"friction": law_of(law)}
            found.append(Contact._of({"name": f"{place + 1}", **table, **own}))
        return Contacts(found)

    @property
    def dithers(self) -> tuple[SystemDither, ...]:
        """The dithers."""
        return tuple(SystemDither._of(table) for table in listed_tables(self._document().get("dither")))

    @property
    def dither(self) -> SystemDither | None:
        """The dither, or ``None``. A system with several has :attr:`dithers`."""
        found: SystemDither | None = single(self.dithers, "dithers")
        return found

    @property
    def parameters(self) -> dict[str, Any]:
        """Named numbers of formulas."""
        return dict(self._document().get("parameters", {}))

    @property
    def initial(self) -> SystemInitial:
        """The initial state."""
        found = self._document()["system"].get("initial", {"state": "rest"})
        return SystemInitial._of(found if isinstance(found, Mapping) else {"state": found})

    @property
    def mode(self) -> tuple[SystemMode, ...]:
        """The modes of the structure, if it is given by them."""
        return tuple(SystemMode._of(table) for table in listed_tables(self._document()["system"].get("mode")))

    @property
    def component(self) -> tuple[Component, ...]:
        """The bodies of the structure, if it is given by them."""
        return tuple(Component._of(table) for table in listed_tables(self._document()["system"].get("component")))

    def _arguments(self) -> dict[str, Any]:
        document = self._document()
        arguments = self._common(document)
        own = dict(document.pop("system"))
        friction = document.pop("friction", None)
        for name, cls in (("mode", SystemMode), ("component", Component)):
            if name in own:
                arguments[name] = as_given(own.pop(name), cls)
        if own.pop("initial", None) is not None:
            arguments["initial"] = self.initial
        for name, outer in (("contact", Contact), ("dither", SystemDither)):
            if name in document:
                arguments[name] = as_given(document.pop(name), outer)
        return {**arguments, **own, **document, "friction": None if friction is None else law_of(friction)}


class Contacts(Sequence[Contact]):
    """Contacts of a system, by place or name."""

    def __init__(self, contacts: Sequence[Contact]) -> None:
        self._contacts = list(contacts)

    @property
    def names(self) -> list[str]:
        """Names of the contacts."""
        return [str(contact.given["name"]) for contact in self._contacts]

    @overload
    def __getitem__(self, key: int | str) -> Contact: ...

    @overload
    def __getitem__(self, key: slice) -> Contacts: ...

    def __getitem__(self, key: int | str | slice) -> Contact | Contacts:
        if isinstance(key, slice):
            return Contacts(self._contacts[key])
        if isinstance(key, str):
            if key not in self.names:
                raise KeyError(f"no contact is named {key}{suggestion(key, self.names)}")
            return self._contacts[self.names.index(key)]
        return self._contacts[key]

    def __len__(self) -> int:
        return len(self._contacts)

    def __repr__(self) -> str:
        return f"<{len(self)} contacts: {', '.join(self.names)}>"

    def _ipython_key_completions_(self) -> list[str]:
        return self.names


def tables(given: object) -> object:
    """One table or several as a list; invalid values are passed through and rejected by the reader."""
    return [given] if isinstance(given, (Table, Mapping)) else several(given)
