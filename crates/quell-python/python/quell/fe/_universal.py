"""Universal files (UFF): modes of data sets 55 and 2414, and frequency responses of data set 58. They are read by pyuff."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from .._errors import StudyError, complaint
from .._export import needed
from .._system import System
from ._lines import regular
from ._modal import FileMode, PerMode, system_of_modes
from ._points import DIRECTIONS, Dof, Points, Units, check_units
from ._response import Response, written

__all__ = ["from_universal_file"]

DataSet = Mapping[str, Any]

NORMAL_MODE = 2
"""Analysis type of real modes."""

FREQUENCY_RESPONSE = 4
"""Function type of a frequency response function."""

DISPLACEMENT, VELOCITY, ACCELERATION, FORCE = 8, 11, 12, 9
"""Specific data types of the response, and that of an excitation: reaction or excitation force."""

EXCITATION = (FORCE, 13)

FACTORS = {"SI": (1.0, 1.0), "mm-t-s": (1000.0, 1.0)}
"""Factors of length and force of data set 164, by which numbers of the file are divided to get SI."""


def from_universal_file(
    path: str | os.PathLike[str],
    *,
    units: Units,
    content: Literal["modes", "responses"] | None = None,
    points: Points | None = None,
    damping_ratio: PerMode = None,
    modal_mass: PerMode = None,
    save: str | os.PathLike[str] | None = None,
    static: Mapping[tuple[str, str], float] | None = None,
    **study: Any,
) -> System:
    """A study of a universal file: of modes, or of measured frequency responses.

    It needs pyuff. Directions are those of the file, in which every node may have its own coordinate system.

    Parameters
    ----------
    path :
        The universal file.
    units :
        Units of the file: "SI", "mm-t-s" or, for numbers without units, "none". Data set 164, if there is one, must agree.
    content :
        "modes" (data sets 55 and 2414 of normal modes) or "responses" (data sets 58), where the file has both.
    points :
        Names of nodes with a direction, such as ``{"pad_x": (1204, "x")}`` [default: every one, as ``n1204_x``].
    damping_ratio :
        Damping ratio of the modes instead of the viscous one of the file: one number or one for each.
    modal_mass :
        Modal mass instead of that of the file, for files that have none: 1 for mass-normalised shapes.
    save :
        CSV file for the responses, which the study names. A file there is replaced.
    static :
        Static receptances of pairs of points, response and force, such as ``{("pad_x", "pad_x"): 2e-8}``, where a measurement does
        not begin at 0 Hz. The verdict needs them, and none is extrapolated.
    study :
        Everything else of :class:`quell.System`: ``contact``, ``friction``, ``dither``, …

    Returns
    -------
    quell.System

    Raises
    ------
    quell.StudyError
        Data sets that are missing or of another kind, and everything that is wrong in the study.
    ImportError
        pyuff is not installed.
    """
    check_units(units)
    pyuff = needed("pyuff", "from_universal_file()")
    place = regular("path", path)
    sets = data_sets(pyuff, place)
    agree(sets, units)
    modal = [one for one in sets if one.get("type") in (55, 2414) and one.get("analysis_type") == NORMAL_MODE]
    responses = [one for one in sets if one.get("type") == 58 and one.get("func_type") == FREQUENCY_RESPONSE]
    if content is None and modal and responses:
        allowed = '"modes" or "responses": the file has both'
        raise StudyError([complaint("content", None, allowed, "missing")])
    if content == "responses" or (content is None and responses):
        if not responses:
            raise StudyError([complaint("path", str(place), "a universal file with frequency responses (data set 58)", "path")])
        if damping_ratio is not None or modal_mass is not None:
            name = "damping_ratio" if damping_ratio is not None else "modal_mass"
            raise StudyError([complaint(name, None, "left out: the study is of frequency responses", "conflict")])
        found = [response_of(one) for one in responses]
        return System(frequency_response=written(found, points, units, save, static), units=units, **study)
    if not modal:
        complex_modes = any(one.get("type") in (55, 2414) and one.get("analysis_type") in (3, 7) for one in sets)
        allowed = "a universal file with normal modes (data set 55 or 2414, analysis type 2)"
        allowed += "; its complex modes have no real shapes" if complex_modes else ""
        raise StudyError([complaint("path", str(place), allowed, "path")])
    found_modes = [mode_of(one) for one in modal]
    return system_of_modes(
        found_modes, units=units, points=points, damping_ratio=damping_ratio, modal_mass=modal_mass, study=study
    )


def data_sets(pyuff: Any, place: Path) -> list[DataSet]:
    """The data sets of a file. pyuff raises errors of many kinds for lines that it cannot read."""
    number = 0
    try:
        file = pyuff.UFF(str(place))
        found = []
        for number in range(1, int(file.get_n_sets()) + 1):
            one = file.read_sets(number - 1)
            found.append(one[0] if isinstance(one, list) else one)
    except Exception as why:
        allowed = f"{place}: data set {number} cannot be read: {why}" if number else f"{place}: expected a universal file: {why}"
        raise StudyError([complaint("path", str(place), allowed, "path")]) from why
    return [one for one in found if one]


def finite(one: DataSet, values: npt.ArrayLike, what: str) -> None:
    """Rejects numbers of a data set that are not finite."""
    if not np.isfinite(np.asarray(values)).all():
        raise StudyError([complaint(f"data set {one['type']}", None, f"finite numbers: its {what} has others", "path")])


def agree(sets: list[DataSet], units: Units) -> None:
    """Rejects units that data set 164 contradicts."""
    stated = next((one for one in sets if one.get("type") == 164), None)
    if stated is None or units not in FACTORS:
        return
    length, force = FACTORS[units]
    if not np.allclose([stated["length"], stated["force"]], [length, force], rtol=1e-6):
        allowed = f"the units of the file: its data set 164 has the factors {stated['length']:g} of length and {stated['force']:g} of force"
        raise StudyError([complaint("units", units, allowed)])


def mode_of(one: DataSet) -> FileMode:
    """A mode. Data sets that are left without a modal mass or damping have 0 there."""
    if one["type"] == 55:
        hertz, mass, viscous, hysteretic = (one[name] for name in ("freq", "modal_m", "modal_damp_vis", "modal_damp_his"))
        columns = [np.asarray(one[f"r{place}"]) for place in range(1, 7) if f"r{place}" in one]
        nodes, values = one["node_nums"], np.column_stack(columns)
    else:
        hertz, mass, viscous, hysteretic = (one[f"record12_field{place}"] for place in (2, 4, 5, 6))
        nodes, values = one["node_nums"], np.vstack(one["data_at_node"])
    if np.iscomplexobj(values) or values.shape[1] not in (3, 6):
        allowed = "a normal mode with three displacements, or three and three rotations, at each node"
        raise StudyError([complaint(f"data set {one['type']}", None, allowed, "path")])
    shape = {
        (int(node), direction): float(value)
        for node, row in zip(nodes, values, strict=True)
        for direction, value in enumerate(row, 1)
    }
    finite(one, [hertz, mass, viscous, hysteretic], "header")
    finite(one, values, "shape")
    if hertz < 0.0:
        raise StudyError([complaint(f"data set {one['type']}", float(hertz), "a natural frequency ≥ 0")])
    damping = None if viscous == 0.0 and hysteretic != 0.0 else float(viscous)
    return FileMode(2.0 * np.pi * float(hertz), damping, float(mass) or None, shape)


def directed(node: Any, direction: int) -> tuple[Dof, float]:
    """A node with the number of a direction, and its sign."""
    if not 1 <= abs(direction) <= len(DIRECTIONS):
        allowed = "a direction of displacement or rotation at every response and force"
        raise StudyError([complaint("data set 58", f"node {node}, direction {direction}", allowed, "path")])
    return (int(node), abs(direction)), float(np.sign(direction))


def response_of(one: DataSet) -> Response:
    """A frequency response as receptance, displacement over force."""
    output, sign_out = directed(one["rsp_node"], int(one["rsp_dir"]))
    force, sign_in = directed(one["ref_node"], int(one["ref_dir"]))
    hertz: npt.NDArray[np.float64] = np.asarray(one["x"], dtype=np.float64)
    values: npt.NDArray[np.complex128] = np.asarray(one["data"], dtype=np.complex128) * (sign_out * sign_in)
    finite(one, hertz, "abscissa")
    finite(one, values, "response")
    kind, over = int(one["ordinate_spec_data_type"]), int(one["orddenom_spec_data_type"])
    s: npt.NDArray[np.complex128] = np.asarray(2j * np.pi * hertz, dtype=np.complex128)
    powers = {DISPLACEMENT: 0, VELOCITY: 1, ACCELERATION: 2}
    if kind not in powers or over not in EXCITATION:
        allowed = "displacement (8), velocity (11) or acceleration (12) over force (9 or 13)"
        raise StudyError([complaint("data set 58", f"types {kind} over {over}", allowed, "path")])
    # Velocity and acceleration say nothing about the static response.
    says = np.ones(hertz.shape, dtype=bool) if kind == DISPLACEMENT else hertz > 0.0
    return Response(output, force, hertz[says], values[says] / s[says] ** powers[kind])
