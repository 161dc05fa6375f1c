"""Quell finds the dither that silences friction-induced vibration, and quantifies its confidence.

::

    import quell

    belt = quell.Belt(
        damping_ratio=0.005, normal_load=1.0, belt_velocity=0.05,
        friction=quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity=0.2),
        dither=quell.Dither("tangential", "sine", amplitude=0.4, frequency_ratio=10.0),
    )
    response = belt.response()
    print(response.sentence, response.efficiency)
    response.plot()

Studies are made by :class:`Belt`, :class:`Disc` or :meth:`Study.from_toml`; their methods are the verbs of the command
line. Results (:mod:`quell.results`) have the numbers that ``--json`` prints as attributes, and everything with units
and provenance as an xarray Dataset. Whatever is wrong with the input is told at once by :class:`StudyError`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

from . import _quell, results
from ._arguments import Arguments
from ._axes import Axes, Axis
from ._belt import (
    Belt,
    Coulomb,
    Decreasing,
    Dither,
    Expression,
    Friction,
    Initial,
    Samples,
    Solver,
    Stribeck,
    StribeckExponential,
)
from ._disc import Disc, Load, Mode
from ._errors import Complaint, QuellError, RunError, StudyError, complaint
from ._quell import __version__
from ._study import Study

__all__ = [
    "Axis",
    "Belt",
    "Complaint",
    "Coulomb",
    "Decreasing",
    "Disc",
    "Dither",
    "Expression",
    "Friction",
    "Initial",
    "Load",
    "Mode",
    "QuellError",
    "RunError",
    "Samples",
    "Solver",
    "Stribeck",
    "StribeckExponential",
    "Study",
    "StudyError",
    "__version__",
    "new",
    "quantities",
    "reproduce",
    "results",
    "schema",
    "sweep",
]


def schema() -> dict[str, Any]:
    """The JSON Schema of a study file (draft 2020-12)."""
    return _quell.schema()


def new(
    question: str | None = None, *, save: str | os.PathLike[str] | None = None, overwrite: bool = False
) -> dict[str, Any]:
    """A commented study to start from.

    Parameters
    ----------
    question :
        Name of a question; without it, the questions are listed.
    save :
        A new file to save the study to.
    overwrite :
        Whether an existing file is replaced.

    Returns
    -------
    dict
        ``questions``, with ``name`` and ``question`` of each; or ``text``, the study, which
        :meth:`Study.from_text` reads, with ``name``, ``question`` and ``commands``.
    """
    arguments = Arguments()
    name = None if question is None else arguments.text("question", question, "the name of a question")
    place = None if save is None else arguments.path("save", save)
    if place is not None and name is None:
        arguments.wrong.append(complaint("save", save, "given with the name of a question", "conflict"))
    arguments.done()
    return _quell.new(name, place, bool(overwrite))


def quantities() -> dict[str, dict[str, str]]:
    """What a map can show of a belt and of a disc: names, and what each is."""
    found: dict[str, dict[str, str]] = {"belt": {}, "disc": {}}
    for system, name, about in _quell.quantities():
        found[system][name] = about
    return found


def sweep(
    study: Study,
    quantity: str | Iterable[str],
    axes: Axes | None = None,
    **how: Any,
) -> results.Map:
    """Quantities over the axes of a study: :meth:`Study.map`, which says what else can be given.

    ``quell.sweep(study, "efficiency", store="map.zarr", client=client)`` runs on the cluster of a
    ``dask.distributed`` client, with the result of a local run bit for bit.
    """
    done: results.Map = study.map(quantity, axes, **how)
    return done


def reproduce(*names: str, out: str | os.PathLike[str] = "reproduction", quick: bool = False) -> dict[str, Any]:
    """Makes figures and tables of the dissertation again, with their data, the table of claims and a report.

    Parameters
    ----------
    names :
        Figures such as "2.3", or "claims"; everything where none is given.
    out :
        Directory for the report, pictures, data and tables; it is made if it is missing.
    quick :
        Coarser grids of the maps: a look in less than a minute.
    """
    arguments = Arguments()
    place = arguments.path("out", out)
    asked = [arguments.text("names", name, "the name of a figure or table") for name in names]
    arguments.done()
    return _quell.reproduce(asked, place, bool(quick))
