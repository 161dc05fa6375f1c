"""Measured receptances as the CSV file of a study."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._errors import Complaint, StudyError, complaint
from ._points import Dof, Points, Units, chosen

__all__ = ["Response", "written"]


class Response(NamedTuple):
    """Displacement at a point over a force at a point."""

    output: Dof
    force: Dof
    hertz: npt.NDArray[np.float64]
    receptance: npt.NDArray[np.complex128]


def written(
    responses: list[Response],
    points: Points | None,
    units: Units,
    save: str | os.PathLike[str] | None,
    static: Mapping[tuple[str, str], float] | None,
) -> str:
    """Writes the responses of the points, completely or not at all, and returns the path of the file.

    Raises
    ------
    quell.StudyError
        A static value that is missing, or a path that is not given.
    """
    wrong: list[Complaint] = []
    if save is None:
        wrong.append(complaint("save", None, "given: a CSV file for the responses, which the study names", "missing"))
    names = {dof: name for name, dof in chosen(points, (dof for one in responses for dof in (one.output, one.force))).items()}
    known = dict(static or {})
    # Numbers without units have angular frequencies.
    column, factor = ("frequency", 2.0 * np.pi) if units == "none" else ("frequency_hz", 1.0)
    lines = [f"{column},output,input,re,im"]
    for one in responses:
        if one.output not in names or one.force not in names:
            continue
        pair = (names[one.output], names[one.force])
        begins = one.hertz.size > 0 and one.hertz[0] == 0.0
        at_rest = known.pop(pair, None)
        if not begins and at_rest is None:
            wrong.append(complaint("static", None, f"given for {pair}: its response does not begin at 0 Hz", "missing"))
            continue
        if not begins:
            lines.append(f"0,{pair[0]},{pair[1]},{at_rest!r},0")
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
