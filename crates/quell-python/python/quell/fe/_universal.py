"""Universal files (UFF): modes of data sets 55 and 2414, and frequency responses of data set 58.

An own reader, with the lines of the file in every complaint.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Literal, NoReturn, Union

import numpy as np

from .._errors import StudyError, complaint
from .._system import System
from ._lines import Refusal, regular
from ._modal import FileMode, PerMode, system_of_modes
from ._notes import noted
from ._points import Points, Units, check_units
from ._response import written
from ._shapes import COLLINEAR, check_limit
from ._uff import DataSet, Units164, data_sets, summary, units_of
from ._uff_functions import FREQUENCY_RESPONSE, QUANTITIES, Function, check_pairs, function_of, response_of
from ._uff_modes import COMPLEX, NORMAL, Result, modes_of_sets, result_of

__all__ = ["from_universal_file"]

FACTORS = {"SI": (1.0, 1.0), "mm-t-s": (1000.0, 1.0)}
"""Factors of length and force of data set 164, by which numbers of the file are divided to get SI."""

FROM_FILE = "file"


def from_universal_file(
    path: str | os.PathLike[str],
    *,
    units: Union[Units, Literal["file"]],
    content: Literal["modes", "responses"] | None = None,
    points: Points | None = None,
    damping_ratio: PerMode = None,
    modal_mass: PerMode = None,
    collinearity: float = COLLINEAR,
    save: str | os.PathLike[str] | None = None,
    static: Mapping[tuple[str, str], float] | None = None,
    pairs: Sequence[tuple[str, str]] | None = None,
    quantity: Literal["displacement", "velocity", "acceleration"] | None = None,
    **study: Any,
) -> System:
    """A study of a universal file: of modes, or of measured frequency responses.

    Directions are those of the file, in which every node may have its own coordinate system. Complex modes become real by a rotation
    of their shapes, if these are nearly real; their modal phase collinearity is in :attr:`quell.System.notes`.

    Parameters
    ----------
    path :
        The universal file. Functions (data set 58) may be binary.
    units :
        Units of the file: "SI", "mm-t-s" or, for numbers without units, "none". "file" takes those of its data set 164, such as mm, mN
        and kg, and gives a study in SI. Otherwise data set 164, if there is one, must agree.
    content :
        "modes" (data sets 55 and 2414) or "responses" (data sets 58), where the file has both.
    points :
        Names of nodes with a direction, such as ``{"pad_x": (1204, "x")}`` [default: every one, as ``n1204_x``].
    damping_ratio :
        Damping ratio of the modes instead of the viscous one of the file: one number or one for each.
    modal_mass :
        Modal mass instead of that of the file, for files that have none: 1 for mass-normalised shapes.
    collinearity :
        Least modal phase collinearity of complex modes; others are left out [default: 0.95].
    save :
        CSV file for the responses, which the study names. A file there is replaced.
    static :
        Static receptances of pairs of points, response and force, such as ``{("pad_x", "pad_x"): 2e-8}``, where a measurement does
        not begin at 0 Hz. The verdict needs them, and none is extrapolated.
    pairs :
        Names of response and force of each frequency response, in the order of the file, where its points have no direction.
    quantity :
        What the responses are over a force, where their data sets do not say it.
    study :
        Everything else of :class:`quell.System`: ``contact``, ``friction``, ``dither``, …

    Returns
    -------
    quell.System

    Raises
    ------
    quell.StudyError
        Data sets that are missing or of another kind, and everything that is wrong in the study.
    """
    if units != FROM_FILE:
        check_units(units)
    limit = check_limit(collinearity)
    if quantity is not None and quantity not in QUANTITIES:
        raise StudyError([complaint("quantity", quantity, "displacement, velocity or acceleration")])
    refuse = Refusal("path", path)
    sets = data_sets("path", regular("path", path))
    results = [(one, result_of(one, refuse)) for one in sets if one.kind in (55, 2414)]
    functions = [(one, function_of(one, refuse)) for one in sets if one.kind == 58]
    modal = [(one, head) for one, head in results if head.analysis == NORMAL or head.analysis in COMPLEX]
    responses = [(one, head) for one, head in functions if head.kind == FREQUENCY_RESPONSE]
    wanted = content_of(content, bool(modal), bool(responses))
    if not (responses if wanted == "responses" else modal):
        nothing(wanted, sets, results, functions, path)
    stated = units_of(sets, refuse)
    length, force = in_units(units, stated, path)
    has_changed = stated is not None and (length, force) != (1.0, 1.0)
    converted = [f"The numbers of the file, in {stated.name or 'its units'} (data set 164), became SI."] if stated and has_changed else []
    own: Units = "SI" if units == "file" else units
    if wanted == "responses":
        check_left_out(damping_ratio=damping_ratio, modal_mass=modal_mass)
        named = check_pairs(pairs, len(responses))
        found = [response_of(one, head, pair, quantity, refuse) for (one, head), pair in zip(responses, named, strict=True)]
        found = [one._replace(receptance=one.receptance * (force / length)) for one in found]
        notes = converted + others_left_out(functions)
        return noted(System(frequency_response=written(found, points, own, save, static), units=own, **study), notes)
    modes, notes = modes_of_sets(modal, limit, modal_mass is not None, refuse)
    modes = [in_si(mode, length, force) for mode in modes]
    system = system_of_modes(modes, units=own, points=points, damping_ratio=damping_ratio, modal_mass=modal_mass, study=study)
    return noted(system, converted + notes)


def content_of(content: str | None, has_modes: bool, has_responses: bool) -> str:
    """What the study is made of."""
    if content not in (None, "modes", "responses"):
        raise StudyError([complaint("content", content, '"modes" or "responses"')])
    if content is None and has_modes and has_responses:
        raise StudyError([complaint("content", None, '"modes" or "responses": the file has both', "missing")])
    return content or ("responses" if has_responses else "modes")


def nothing(
    wanted: str, sets: list[DataSet], results: list[tuple[DataSet, Result]], functions: list[tuple[DataSet, Function]], path: object
) -> NoReturn:
    """Complains about a file without the content of a study, by what it has."""
    expected = "frequency response functions (data set 58, function type 4)" if wanted == "responses" else "modes (data sets 55 and 2414)"
    if wanted == "modes" and functions and not results:
        expected += " or frequency response functions (data set 58, function type 4)"
    there = list(dict.fromkeys([head.words() for _, head in functions] + [head.words() for _, head in results]))
    has = "; ".join(there[:4]) + (f" and {len(there) - 4} more" if len(there) > 4 else "") if there else f"data sets {summary(sets)}"
    raise StudyError([complaint("path", str(path), f"{path} has {has}; expected {expected}", "path")])


def in_units(units: str, stated: Units164 | None, path: object) -> tuple[float, float]:
    """The factors of length and force by which numbers are divided to be in the units of the study.

    Raises
    ------
    quell.StudyError
        The units contradict those of the file, or the file has none.
    """
    if units == FROM_FILE:
        if stated is None:
            allowed = f'"SI", "mm-t-s" or "none": {path} has no data set 164, which states the units'
            raise StudyError([complaint("units", units, allowed)])
        return stated.length, stated.force
    if stated is not None and units in FACTORS and not np.allclose([stated.length, stated.force], FACTORS[units], rtol=1e-6):
        named = f"{stated.name or 'no name'}, code {stated.code}, factors {stated.length:g} of length and {stated.force:g} of force"
        allowed = f'the units of the file: its data set 164 (line {stated.line}) states {named}. units="file" takes them'
        raise StudyError([complaint("units", units, allowed)])
    return 1.0, 1.0


def in_si(mode: FileMode, length: float, force: float) -> FileMode:
    """A mode with its modal mass in kg, and rotations over displacements in rad/m."""
    shape = {dof: value * (length if dof[1] > 3 else 1.0) for dof, value in mode.shape.items()}
    return mode._replace(modal_mass=None if mode.modal_mass is None else mode.modal_mass * length / force, shape=shape)


def check_left_out(**given: Any) -> None:
    """Rejects arguments that belong to modes."""
    wrong = [
        complaint(name, None, "left out: the study is of frequency responses", "conflict") for name, value in given.items() if value is not None
    ]
    if wrong:
        raise StudyError(wrong)


def others_left_out(functions: list[tuple[DataSet, Function]]) -> list[str]:
    """A note about functions that are no frequency responses."""
    counts: dict[str, int] = {}
    for _, head in functions:
        if head.kind != FREQUENCY_RESPONSE:
            counts[head.name()] = counts.get(head.name(), 0) + 1
    others = "; ".join(f"{count} × {name}" if count > 1 else name for name, count in counts.items())
    return [f"Not read of data sets 58: {others}."] if others else []

