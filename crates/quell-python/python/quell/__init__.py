"""Quell finds the dither that silences friction-induced vibration, and quantifies its confidence.

::

    import quell

    belt = quell.Belt(
        damping_ratio=0.005, normal_load=1.0, belt_velocity=0.05,
        friction=quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity=0.2),
        dither=quell.Dither("tangential", "sine", amplitude=0.4, frequency_ratio=10.0),
    )
    response = belt.response()
    print(response.sentence, response.residual_vibration)
    response.plot()

Studies are made by :class:`Belt`, :class:`Disc`, :class:`System` or :meth:`Study.from_toml`, and from files of other programs by
:func:`from_universal_file`, :func:`from_nastran`, :func:`from_abaqus` and :func:`from_ansys`. Their methods are the verbs of
the command line. Results (:mod:`quell.results`) have the numbers that ``--json`` prints as attributes, and everything with units
and provenance as an xarray Dataset. :class:`StudyError` reports all errors in the input at once.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

from . import _quell, results
from ._arguments import Arguments, changes_of, keywords
from ._axes import Axes, Axis
from ._belt import Belt, Dither, Initial, Solver
from ._disc import Disc, Load, Mode
from ._errors import Complaint, QuellError, RunError, StudyError, StudyFileNotFoundError, complaint
from ._laws import (
    Coulomb,
    Decreasing,
    Expression,
    Friction,
    Lugre,
    SampledLaw,
    Samples,
    Stribeck,
    StribeckExponential,
    StudyFriction,
)
from ._quell import __version__
from ._record import columns_of, names_of, record_of
from ._study import Study
from ._profile import Profile
from ._system import Component, Contact, Contacts, System, SystemDither, SystemInitial, SystemMode
from .fe import from_abaqus, from_ansys, from_nastran, from_universal_file

if TYPE_CHECKING:
    from .explore import explore

__all__ = [
    "Axis",
    "Belt",
    "Complaint",
    "Component",
    "Contact",
    "Contacts",
    "Coulomb",
    "Decreasing",
    "Disc",
    "Dither",
    "Expression",
    "Friction",
    "Initial",
    "Profile",
    "Load",
    "Lugre",
    "Mode",
    "QuellError",
    "RunError",
    "SampledLaw",
    "Samples",
    "Solver",
    "Stribeck",
    "StribeckExponential",
    "Study",
    "StudyError",
    "StudyFileNotFoundError",
    "StudyFriction",
    "System",
    "SystemDither",
    "SystemInitial",
    "SystemMode",
    "__version__",
    "explore",
    "from_abaqus",
    "from_ansys",
    "from_nastran",
    "from_universal_file",
    "load",
    "new",
    "quantities",
    "fit",
    "fit_decay",
    "fit_laws",
    "reproduce",
    "results",
    "schema",
    "sweep",
]

# The explorer is imported when it is used. Its module is the function.
if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        if name == "explore":
            from importlib import import_module

            return import_module(".explore", __name__)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


@keywords
def load(path: str | os.PathLike[str], set: Mapping[str, Any] | None = None) -> Study:  # noqa: A002
    """The study of a file, or of its text, with changes: :meth:`Study.from_toml`."""
    return Study.from_toml(path, set)


def schema() -> dict[str, Any]:
    """The JSON Schema of a study file (draft 2020-12)."""
    return _quell.schema()


@keywords
def new(
    question: str | None = None, *, save: str | os.PathLike[str] | None = None, overwrite: bool = False
) -> dict[str, Any]:
    """A commented study to start from.

    Parameters
    ----------
    question :
        Name of a question [default: list the questions].
    save :
        Path of a new file for the study.
    overwrite :
        Whether to replace an existing file.

    Returns
    -------
    dict
        Without a question: ``questions``, each with ``name`` and ``question``. Otherwise ``text``, the study, which
        :meth:`Study.from_text` reads, with ``name``, ``question`` and ``commands``.
    """
    arguments = Arguments()
    name = None if question is None else arguments.text("question", question, "the name of a question")
    place = None if save is None else arguments.path("save", save)
    if place is not None and name is None:
        arguments.wrong.append(complaint("save", save, "given with the name of a question", "conflict"))
    arguments.done()
    return _quell.new(name, place, bool(overwrite))


@keywords
def fit(
    data: str | os.PathLike[str],
    *,
    law: str | list[str] | None = None,
    free: str | list[str] | None = None,
    fix: str | list[str] | None = None,
    decay: bool = False,
    record: bool = False,
    study: Study | str | os.PathLike[str] | None = None,
    settle: float | str | None = None,
    column: str | None = None,
    quantity: str | None = None,
    gain: float | None = None,
    window: tuple[float, float] | None = None,
    columns: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    """Fits friction laws to measured coefficients, a free decay, or a study to a record, with standard errors.

    Parameters
    ----------
    data :
        CSV, LabVIEW or MATLAB file with ``slip_velocity`` (or ``slip_velocity_m_per_s``) and ``coefficient``, or ``friction_force`` and ``normal_load``; with
        ``decay`` and ``record`` with ``time`` (or ``time_s``) and ``displacement``, ``velocity`` or ``acceleration``.
    law :
        Names of laws, or "all" [default: "all"]: :func:`fit_laws` returns their fit with arrays and a picture.
    free :
        Parameters to estimate that are otherwise fixed, such as "exponent"; with ``record`` numbers of the study.
    fix :
        Parameters to fix, such as "static_coefficient=0.4".
    decay :
        Whether to fit a free decay: :func:`fit_decay` returns its result with arrays and a picture.
    record :
        Whether to fit a study: :meth:`Study.fit_record` returns its result with arrays and a picture.
    study :
        Study of ``record``.
    settle :
        Time before the record, of ``record``.
    column, quantity, gain, window, columns :
        How a record is read, as in :func:`fit_decay`.

    Returns
    -------
    dict
        What the command line prints with ``--json``: ``parameters`` with ``value`` and ``standard_error``, ``covariance``,
        ``residual``, ``aic`` and the comparison of the laws.
    """
    arguments = Arguments()
    given = {"column": column, "quantity": quantity, "gain": gain, "window": window}
    if decay:
        beside: dict[str, object] = {"record": record or None, "study": study, "settle": settle, "free": free}
        for name, value in beside.items():
            if value is not None:
                arguments.wrong.append(complaint(name, str(value), "left out with decay", "conflict"))
        arguments.done()
        return fit_decay(data, law=law, fix=fix, columns=columns, **given).to_dict()  # type: ignore[arg-type]
    if record:
        if study is None or law is not None:
            arguments.wrong.append(complaint("study", None, "given with record, and law left out", "conflict"))
        arguments.done()
        read = study if isinstance(study, Study) else Study.from_toml(study)  # type: ignore[arg-type]
        return read.fit_record(data, free=free or [], fix=fix, settle=settle, columns=columns, **given).to_dict()  # type: ignore[arg-type]
    alone: dict[str, object] = {"study": study, "settle": settle, **given}
    for name, value in alone.items():
        if value is not None:
            arguments.wrong.append(complaint(name, str(value), "given with decay or record", "conflict"))
    arguments.done()
    return fit_laws(data, law=law, free=free, fix=fix, columns=columns).to_dict()


@keywords
def fit_laws(
    data: str | os.PathLike[str],
    *,
    law: str | list[str] | None = None,
    free: str | list[str] | None = None,
    fix: str | list[str] | None = None,
    columns: Mapping[str, str] | None = None,
) -> results.LawFit:
    """Fits friction laws to measured coefficients, with standard errors, and compares them.

    Parameters
    ----------
    data :
        CSV, LabVIEW or MATLAB file with ``slip_velocity`` (or ``slip_velocity_m_per_s``) and ``coefficient``, or ``friction_force`` and ``normal_load``.
    law :
        Names of laws, or "all" [default: "all"].
    free :
        Parameters to estimate that are otherwise fixed, such as "exponent".
    fix :
        Parameters to fix, such as "static_coefficient=0.4".
    columns :
        Columns by other names, such as ``{"slip_velocity": "V[mm/s]", "friction_force": "%*9.84mNm"}``: quantities with the name of their column,
        or its unit where that is unique, with a unit that the file does not give in brackets, and a factor after ``*``.

    Returns
    -------
    quell.results.LawFit
        Estimates with standard errors and covariance, the comparison of the laws, the fitted curve with its band, and the residuals.

    Examples
    --------
    >>> found = quell.fit_laws("friction.csv")
    >>> found.plot()
    >>> print(found.tables["friction"])
    """
    arguments = Arguments()
    place = arguments.path("data", data)
    laws, freed, fixed = (names_of(arguments, name, it) for name, it in (("law", law), ("free", free), ("fix", fix)))
    named = columns_of(arguments, columns)
    arguments.done()
    return results.LawFit._of(None, _quell.fit_laws(str(place), laws, freed, fixed, named))


@keywords
def fit_decay(
    data: str | os.PathLike[str],
    *,
    law: str | list[str] | None = None,
    fix: str | list[str] | None = None,
    column: str | None = None,
    quantity: str | None = None,
    gain: float | None = None,
    window: tuple[float, float] | None = None,
    columns: Mapping[str, str] | None = None,
) -> results.Decay:
    """Fits natural frequency, damping ratio and friction to a record of a free decay.

    Parameters
    ----------
    data :
        CSV, LabVIEW or MATLAB file with ``time`` (or ``time_s``) and ``displacement``, ``velocity`` or ``acceleration``, with their units in the names.
    law :
        "viscous", "coulomb", "viscous-coulomb", or "all" [default: "all"].
    fix :
        Parameters to fix, such as "offset=0".
    column :
        Column of the record [default: the first of displacement, velocity and acceleration].
    quantity :
        What the column shows, if its name does not say it.
    gain :
        Factor of the readings [default: 1].
    window :
        Two times of the record between which it is read.
    columns :
        Columns by other names, such as ``{"time": "t[ms]", "velocity": "ch1[mm/s]"}``, as in :func:`fit_laws`.

    Returns
    -------
    quell.results.Decay
        Estimates with standard errors and covariance, the comparison of the laws, and arrays over the samples.
    """
    arguments = Arguments()
    place = arguments.path("data", data)
    laws, fixed = names_of(arguments, "law", law), names_of(arguments, "fix", fix)
    texts = record_of(arguments, column, quantity, gain, window, columns)
    arguments.done()
    return results.Decay._of(None, _quell.fit_decay(str(place), laws, fixed, texts))


def quantities() -> dict[str, dict[str, str]]:
    """The quantities that a map can show of each kind of study: names and descriptions."""
    found: dict[str, dict[str, str]] = {}
    for kind, name, about in _quell.quantities():
        found.setdefault(kind, {})[name] = about
    return found


def sweep(
    study: Study,
    quantity: str | Iterable[str],
    axes: Axes | None = None,
    **how: Any,
) -> results.Map:
    """Computes quantities over the axes of a study; see :meth:`Study.map` for the other arguments.

    ``quell.sweep(study, "residual-vibration", store="map.zarr", client=client)`` runs on the cluster of a
    ``dask.distributed`` client, with the same bits as a local run.
    """
    done: results.Map = study.map(quantity, axes, **how)
    return done


@keywords
def reproduce(
    *names: str,
    out: str | os.PathLike[str] = "reproduction",
    quick: bool = False,
    set: Mapping[str, Any] | None = None,  # noqa: A002
    width: str | None = None,
    caption: bool = False,
    title: bool = True,
) -> dict[str, Any]:
    """Reproduces figures and tables of the dissertation, with their data, the table of claims and a report.

    Parameters
    ----------
    names :
        Figures such as "2.3", or "claims" [default: everything].
    out :
        Directory for the report, pictures, data and tables; it is created if it is missing.
    quick :
        Whether to use coarser grids for the maps, which takes less than a minute.
    set :
        Numbers of your own for the named figures, such as ``{"friction.reference_velocity": 0.3}``; a list replaces a family of
        curves or panels, such as ``{"dither.amplitude": [0, 1, 2]}``. Such figures are captioned as yours.
    width :
        Width of the figures with its unit, such as ``"85mm"`` [default: suits their panels].
    caption :
        Whether to draw the captions below the figures.
    title :
        Whether to draw the titles above the figures.
    """
    arguments = Arguments()
    changes = changes_of(set, arguments)
    place = arguments.path("out", out)
    asked = [arguments.text("names", name, "the name of a figure or table") for name in names]
    arguments.page(width, caption, title)
    arguments.done()
    return _quell.reproduce(asked, place, bool(quick), changes, (width, caption, title))
