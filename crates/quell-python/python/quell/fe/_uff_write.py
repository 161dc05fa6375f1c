"""Complex modes and frequency responses as universal files, which programs for modal tests and finite elements read: data sets 55 and 58."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._arguments import Arguments
from .._errors import StudyError, complaint
from ._points import DIRECTIONS, Dof

__all__ = ["WrittenMode", "write_functions", "write_modes"]

COMPLEX_EIGENVALUE, DISPLACEMENT, DOUBLE_COMPLEX = 3, 8, 6
"""Analysis of the first order, displacements, and complex numbers."""

EXCITATION, FREQUENCY, FREQUENCY_RESPONSE = 13, 18, 4
"""Forces of excitation, frequencies in Hz, and the type of a frequency response function."""

LABELS = {"SI": ("m", "N"), "mm-t-s": ("mm", "N")}
"""Length and force of unit systems."""

NAME = re.compile(r"(?:.*\.)?n(\d+)_(\w+)")
"""Names that :func:`quell.from_universal_file` and the readers of other programs give, also of a component."""


class WrittenMode(NamedTuple):
    """A complex mode."""

    eigenvalue: complex
    """λ, with e^λt."""
    shape: Sequence[complex]
    """Displacement of every coordinate."""


def places_of(coordinates: Iterable[str]) -> tuple[list[Dof], list[str]]:
    """Node and direction of every coordinate, and words about names that have none: they are the x of nodes of their own."""
    found, words, taken = list[Dof](), list[str](), set[Dof]()
    names = list(coordinates)
    for name in names:
        match = NAME.fullmatch(name)
        if match and match[2] in DIRECTIONS:
            taken.add((int(match[1]), DIRECTIONS.index(match[2]) + 1))
    free = max((node for node, _ in taken), default=0) + 1
    for name in names:
        match = NAME.fullmatch(name)
        if match and match[2] in DIRECTIONS:
            dof = (int(match[1]), DIRECTIONS.index(match[2]) + 1)
        else:
            dof, free = (free, 1), free + 1
            words.append(f"node {dof[0]} x: {name}")
        if dof in found:
            raise StudyError([complaint("coordinates", name, f"names of different nodes and directions; node {dof[0]} is there twice", "conflict")])
        found.append(dof)
    return found, words


UNITS_164 = {"SI": (1, "SI: metre (newton)", 1.0, 1.0), "mm-t-s": (9, "mm (newton)", 1e3, 1.0)}
"""Code, words, and the length and the force of SI in the units."""


def units_set(units: str) -> str:
    """The data set 164 of a study with units."""
    if units not in UNITS_164:
        return ""
    code, words, length, force = UNITS_164[units]
    factors = "".join(f"{value:25.17E}".replace("E", "D") for value in (length, force, 1.0))
    offset = f"{273.15:25.17E}".replace("E", "D")
    return "\n".join(["    -1", "   164", f"{code:10d}{words:<20}{2:10d}", factors, offset, "    -1", ""])


def write_modes(
    path: str | os.PathLike[str], head: tuple[str, str], coordinates: Iterable[str], modes: Iterable[WrittenMode], overwrite: bool
) -> str:
    """Writes modes of a study with this title and these units, one data set each; returns the path.

    Raises
    ------
    quell.StudyError
        The file exists, or cannot be written.
    """
    place = checked_path(path)
    dofs, words = places_of(coordinates)
    title, units = head
    sets = [data_set(number, title, words, dofs, mode) for number, mode in enumerate(modes, 1)]
    return write_sets(place, units, sets, overwrite)


def write_functions(
    path: str | os.PathLike[str],
    head: tuple[str, str],
    hertz: npt.NDArray[np.float64],
    receptances: Mapping[tuple[str, str], npt.NDArray[np.complex128]],
    overwrite: bool,
) -> str:
    """Writes receptances (output, input) over frequency with this title and these units, one data set each; returns the path.

    Raises
    ------
    quell.StudyError
        The file exists, or cannot be written.
    """
    place = checked_path(path)
    names = list(dict.fromkeys(name for pair in receptances for name in pair))
    dofs = dict(zip(names, places_of(names)[0], strict=True))
    title, units = head
    sets = []
    for number, ((output, force), values) in enumerate(receptances.items(), 1):
        known = np.isfinite(values)
        points = [(output, dofs[output]), (force, dofs[force])]
        sets.append(function_set((number, title, units), points, hertz[known], values[known]))
    return write_sets(place, units, sets, overwrite)


def checked_path(path: str | os.PathLike[str]) -> str:
    """The path of a file to write."""
    arguments = Arguments()
    place = arguments.path("path", path)
    arguments.done()
    return place


def write_sets(place: str, units: str, sets: Iterable[str], overwrite: bool) -> str:
    """Writes data sets after that of the units; returns the path."""
    text = units_set(units) + "".join(sets)
    try:
        with open(place, "w" if overwrite else "x", encoding="ascii", errors="replace", newline="\n") as file:
            file.write(text)
    except FileExistsError:
        raise StudyError([complaint("path", place, "a new file; overwrite=True replaces it", "path")]) from None
    except OSError as why:
        raise StudyError([complaint("path", place, f"a file that can be written: {why.strerror}", "path")]) from None
    return place


def data_set(number: int, title: str, words: list[str], dofs: list[Dof], mode: WrittenMode) -> str:
    """One data set 55."""
    rotates = any(direction > 3 for _, direction in dofs)
    count, characteristic = (6, 3) if rotates else (3, 2)
    eigenvalue = mode.eigenvalue
    hertz = abs(eigenvalue.imag) / (2 * math.pi)
    named = ", ".join(words) or "NONE"
    lines = [
        "    -1",
        "    55",
        (title or "NONE")[:80],
        f"Mode {number}: {hertz:.6g} cycles per unit of time, growth rate {eigenvalue.real:.6g}"[:80],
        "Quell: complex modes, unit of shapes as normalised",
        named[:80],
        "NONE",
        integers(1, COMPLEX_EIGENVALUE, characteristic, DISPLACEMENT, DOUBLE_COMPLEX, count),
        integers(2, 6, 0, number),
        # Modal A and B are not known: the shapes are normalised to their largest entry.
        reals(eigenvalue.real, eigenvalue.imag, 0.0, 0.0, 0.0, 0.0),
    ]
    by_node: dict[int, list[complex]] = {}
    for (node, direction), value in zip(dofs, mode.shape, strict=True):
        by_node.setdefault(node, [0j] * count)[direction - 1] = value
    for node in sorted(by_node):
        flat = [part for value in by_node[node] for part in (value.real, value.imag)]
        lines.append(integers(node))
        lines += [reals(*flat[at : at + 6]) for at in range(0, len(flat), 6)]
    return "\n".join([*lines, "    -1", ""])


def function_set(
    head: tuple[int, str, str],
    points: Sequence[tuple[str, Dof]],
    hertz: npt.NDArray[np.float64],
    values: npt.NDArray[np.complex128],
) -> str:
    """One data set 58: displacement at the first point over force at the second."""
    number, title, units = head
    (output, (node, direction)), (force, (forced, along)) = points
    length, force_unit = LABELS[units]
    # Each frequency has a number of its own: that of even ones would be lost to six digits of their increment.
    lines = [
        "    -1",
        "    58",
        (title or "NONE")[:80],
        f"Displacement of {output} over a force along {force}"[:80],
        "NONE",
        f"Quell: receptance {number}",
        "NONE",
        f"{FREQUENCY_RESPONSE:5d}{number:10d}{0:5d}{0:10d}"
        f" {name_of(output):10s}{node:10d}{direction:4d} {name_of(force):10s}{forced:10d}{along:4d}",
        f"{DOUBLE_COMPLEX:10d}{hertz.size:10d}{0:10d}{hertz[0] if hertz.size else 0.0:13.5e}{0.0:13.5e}{0.0:13.5e}",
        axis(FREQUENCY, 0, "Frequency", "Hz"),
        axis(DISPLACEMENT, 1, "Displacement", length),
        axis(EXCITATION, 0, "Force", force_unit),
        axis(0, 0, "NONE", "NONE"),
    ]
    rows = zip(hertz.tolist(), values.real.tolist(), values.imag.tolist(), strict=True)
    lines += [f"{at:13.5e}{re:20.12e}{im:20.12e}" for at, re, im in rows]
    return "\n".join([*lines, "    -1", ""])


def axis(kind: int, length: int, label: str, unit: str) -> str:
    """An axis of a data set 58: specific type, exponents of length, force and temperature, and the words."""
    return f"{kind:10d}{length:5d}{0:5d}{0:5d} {label:20s} {unit:20s}"


def name_of(point: str) -> str:
    """The entity name of a point: the part of its name before the node."""
    match = NAME.fullmatch(point)
    return "NONE" if match else point[:10]


def integers(*values: int) -> str:
    return "".join(f"{value:10d}" for value in values)


def reals(*values: float) -> str:
    return "".join(f"{value:13.5e}" for value in values)
