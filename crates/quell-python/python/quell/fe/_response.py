"""Measured receptances as the CSV file of a study."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple, Union

import numpy as np
import numpy.typing as npt

from .._errors import Complaint, StudyError, complaint
from ._points import Dof, Points, chosen

__all__ = ["Point", "Response", "written"]

Point = Union[Dof, str]
"""A node with a direction, or the name that the caller gives to a point."""


class Response(NamedTuple):
    """Displacement at a point over a force at a point."""

    output: Point
    force: Point
    hertz: npt.NDArray[np.float64]
    receptance: npt.NDArray[np.complex128]
    line: int
    """Line of the file that it begins in."""


def written(
    responses: list[Response],
    points: Points | None,
    units: str,
    save: str | os.PathLike[str] | None,
    static: Mapping[tuple[str, str], float] | None,
) -> str:
    """Writes the responses of the points, completely or not at all, and returns the path of the file.

    Raises
    ------
    quell.StudyError
        A static value that is missing, a pair of points that the file has twice, or a path that is not given.
    """
    wrong: list[Complaint] = []
    if save is None:
        wrong.append(complaint("save", None, "given: a CSV file for the responses, which the study names", "missing"))
    names = names_of(responses, points)
    known = dict(static or {})
    # Numbers without units have angular frequencies.
    column, factor = ("frequency", 2.0 * np.pi) if units == "none" else ("frequency_hz", 1.0)
    lines = [f"{column},output,input,re,im"]
    seen: dict[tuple[str, str], int] = {}
    for one in responses:
        if one.output not in names or one.force not in names:
            continue
        pair = (names[one.output], names[one.force])
        if pair in seen:
            allowed = f"one response of {pair}: those of lines {seen[pair]} and {one.line} are of the same points"
            wrong.append(complaint("path", None, allowed, "conflict"))
            continue
        seen[pair] = one.line
        begins = one.hertz.size > 0 and one.hertz[0] == 0.0
        at_rest = known.pop(pair, None)
        if not begins and at_rest is None:
            wrong.append(complaint("static", None, f"given for {pair}: its response does not begin at 0 Hz", "missing"))
            continue
        if not begins:
            lines.append(f"0,{pair[0]},{pair[1]},{at_rest!r},0")
        if not one.hertz.size or one.hertz[-1] == 0.0:
            allowed = f"a response at more than 0 Hz: that of {pair} (line {one.line}) has no other frequency"
            wrong.append(complaint("path", None, allowed, "path"))
            continue
        values = zip((factor * one.hertz).tolist(), one.receptance.tolist(), strict=True)
        lines.extend(f"{hertz!r},{pair[0]},{pair[1]},{value.real!r},{value.imag!r}" for hertz, value in values)
    if known:
        wrong.append(complaint("static", list(known), "pairs of points whose response the file has"))
    if wrong or save is None:
        raise StudyError(wrong)
    place = Path(save).absolute()
    part = place.with_name(f".{place.name}.{os.getpid()}.part")
    try:
        part.write_text("\n".join(lines) + "\n", encoding="utf-8")
        part.replace(place)
    finally:
        part.unlink(missing_ok=True)
    return str(place)


def names_of(responses: list[Response], points: Points | None) -> dict[Point, str]:
    """The names of the points of responses: those that the caller gave, or of nodes with a direction."""
    there = list(dict.fromkeys(point for one in responses for point in (one.output, one.force)))
    given: dict[Point, str] = {point: point for point in there if isinstance(point, str)}
    if given and points is not None:
        raise StudyError([complaint("points", None, "left out: pairs has the names of the points", "conflict")])
    nodes = [point for point in there if not isinstance(point, str)]
    return given | ({dof: name for name, dof in chosen(points, nodes).items()} if nodes or points is not None else {})
