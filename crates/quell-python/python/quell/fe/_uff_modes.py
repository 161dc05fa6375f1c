"""Modes of universal files: data sets 55 and 2414."""

from __future__ import annotations

import math
from typing import NamedTuple

from ._lines import Refusal
from ._modal import FileMode
from ._points import Dof
from ._shapes import ComplexMode, real_modes
from ._uff import ANALYSES, DataSet, numbers

__all__ = ["Result", "modes_of_sets", "result_of"]

NORMAL, COMPLEX = 2, (3, 7)
"""Types of analysis that are modes."""

AT_NODES = 1
COMPLEX_DATA = (5, 6)
DISPLACEMENT = (0, 1, 8)
"""Specific types of displacements, or unknown."""

NAMES = {11: "velocities", 12: "accelerations"}


class Result(NamedTuple):
    """The head of a data set with results at nodes."""

    line: int
    kind: int
    analysis: int
    characteristic: int
    """1 scalar, 2 three displacements, 3 three displacements and rotations."""
    quantity: int
    """Specific type, such as 8 for displacements."""
    is_complex: bool
    values: int
    """Values at a node."""
    number: int
    """Number of the mode."""
    reals: list[float]
    """Frequency, modal mass, viscous and hysteretic damping; or eigenvalue, modal A and B."""
    where: int
    """1 for results at nodes."""
    name: str
    first: int
    """Place of the first line with values."""

    def words(self) -> str:
        """What the data set has."""
        name = f" {self.name}" if self.name else ""
        return f"data set {self.kind} (line {self.line}):{name} of a {ANALYSES.get(self.analysis, 'unknown')} analysis (type {self.analysis})"


def result_of(one: DataSet, refuse: Refusal) -> Result:
    """Reads the head of a data set 55 or 2414."""
    if one.kind == 55:
        head = whole_numbers(one, 5, 6, "model type, analysis type, characteristic, specific type, data type and values at a node", refuse)
        counts = whole_numbers(one, 6, 2, "how many whole numbers and reals follow, and these whole numbers", refuse)
        place, reals = 7, list[float]()
        while len(reals) < counts[1]:
            number, _ = one.text(place, refuse)
            reals += numbers(number, one.lines[place][1], refuse, f"{counts[1]} finite numbers")
            place += 1
        number_of_mode = counts[3] if len(counts) > 3 else 0
        name = one.text(0, refuse)[1].strip()
        name = "" if name == "NONE" else name
        return Result(one.line, 55, head[1], head[2], head[3], head[4] in COMPLEX_DATA, head[5], number_of_mode, reals, AT_NODES, name, place)
    where = whole_numbers(one, 2, 1, "the location of the results", refuse)[0]
    head = whole_numbers(one, 8, 6, "model type, analysis type, characteristic, result type, data type and values at a node", refuse)
    integers = whole_numbers(one, 9, 6, "eight whole numbers, the sixth of which is that of the mode", refuse)
    one.text(12, refuse)
    first = numbers(*one.lines[11], refuse, "six finite numbers")
    second = numbers(*one.lines[12], refuse, "six finite numbers")
    if len(first) < 6 or len(second) < 6:
        refuse(one.lines[11][0], one.text(11, refuse)[1], "six finite numbers, and six in the next line")
    reals = second if head[1] in COMPLEX and any(second) else [first[1], *first[3:6]]
    # Simcenter writes a key before the name.
    name = one.text(1, refuse)[1].removeprefix("LOADCASE_NAME_KEY").strip()
    return Result(one.line, 2414, head[1], head[2], head[3], head[4] in COMPLEX_DATA, head[5], integers[5], reals, where, name, 13)


def whole_numbers(one: DataSet, place: int, least: int, wanted: str, refuse: Refusal) -> list[int]:
    """The whole numbers of a line."""
    number, text = one.text(place, refuse)
    found = numbers(number, one.lines[place][1], refuse, wanted)
    if len(found) < least or any(value != int(value) for value in found):
        refuse(number, text, f"whole numbers: {wanted}")
    return [int(value) for value in found]


def shape_of(one: DataSet, head: Result, refuse: Refusal) -> dict[Dof, complex]:
    """The displacements at all nodes."""
    if head.where != AT_NODES:
        refuse.met(one.line, "a mode with results at elements, not at nodes")
    if head.values not in (3, 6):
        what = f"a mode with {head.values} value{'' if head.values == 1 else 's'} at a node (characteristic {head.characteristic})"
        refuse.met(one.line, f"{what}; read are three displacements, or three and three rotations")
    parts = 2 if head.is_complex else 1
    shape: dict[Dof, complex] = {}
    seen: dict[int, int] = {}
    place = head.first
    while place < len(one.lines):
        number, text = one.text(place, refuse)
        node = whole_numbers(one, place, 1, "the number of a node", refuse)[0]
        if node in seen:
            refuse.met(number, f"node {node} again in one mode; line {seen[node]} has it first")
        seen[node] = number
        values: list[float] = []
        place += 1
        while len(values) < head.values * parts:
            if place >= len(one.lines):
                refuse(number, text, f"a node with {head.values * parts} numbers after it; the data set ends before")
            values += numbers(*one.lines[place], refuse, "finite numbers")
            place += 1
        if len(values) != head.values * parts:
            refuse(one.lines[place - 1][0], one.text(place - 1, refuse)[1], f"{head.values * parts} numbers for node {node}")
        for direction in range(1, head.values + 1):
            at = parts * (direction - 1)
            shape[node, direction] = complex(values[at], values[at + 1] if parts == 2 else 0.0)
    if not shape:
        refuse.met(one.line, "a mode without nodes")
    return shape


def modes_of_sets(sets: list[tuple[DataSet, Result]], limit: float, has_mass: bool, refuse: Refusal) -> tuple[list[FileMode], list[str]]:
    """The modes of data sets, and notes.

    Raises
    ------
    quell.StudyError
        A line that is wrong, or shapes that are not real.
    """
    found: list[FileMode] = []
    complex_modes: list[tuple[ComplexMode, float | None, float | None]] = []
    notes: list[str] = []
    seen: dict[tuple[int, tuple[float, ...]], int] = {}
    shapes = [shape_of(one, head, refuse) for one, head in sets]
    check_nodes([head for _, head in sets], shapes, refuse)
    for (one, head), shape in zip(sets, shapes, strict=True):
        key = (head.number, tuple(head.reals))
        if key in seen:
            refuse.met(one.line, f"mode {head.number} again; line {seen[key]} has it first")
        seen[key] = one.line
        if head.analysis == NORMAL or len(head.reals) < 6:
            hertz, mass, damping = normal(one, head, refuse)
            if head.quantity not in DISPLACEMENT:
                mass = None
                what = NAMES.get(head.quantity, f"specific type {head.quantity}")
                notes.append(f"The shape in line {one.line} is of {what}: the modal mass of the file does not belong to displacements.")
            omega = 2.0 * math.pi * hertz
            if not head.is_complex or not any(value.imag for value in shape.values()):
                found.append(FileMode(omega, damping, mass, {dof: value.real for dof, value in shape.items()}))
                continue
            ratio = min(damping or 0.0, 1.0)
            value = omega * complex(-ratio, math.sqrt(1.0 - ratio**2))
            complex_modes.append((ComplexMode(value, 0j, shape, named(head)), damping, mass))
        else:
            value, modal_a, modal_b = (complex(*head.reals[at : at + 2]) for at in (0, 2, 4))
            # λ = −B/A.
            modal_a = modal_a or (-modal_b / value if value else 0j)
            if value.imag < 0.0:
                notes.append(f"Mode {head.number} (line {one.line}) of negative frequency was left out: it is the conjugate of another.")
                continue
            complex_modes.append((ComplexMode(value, modal_a, shape, named(head)), None, None))
    if complex_modes:
        real, words = real_modes([mode for mode, _, _ in complex_modes], limit, has_mass)
        stated = {abs(mode.eigenvalue): mass for mode, _, mass in complex_modes if mass is not None}
        found += [mode if mode.modal_mass is not None else mode._replace(modal_mass=stated.get(mode.frequency)) for mode in real]
        notes += words
    return found, notes


def check_nodes(heads: list[Result], shapes: list[dict[Dof, complex]], refuse: Refusal) -> None:
    """Rejects a mode that lacks a displacement of another."""
    everywhere = dict.fromkeys(dof for shape in shapes for dof in shape)
    for head, shape in zip(heads, shapes, strict=True):
        missing = next((dof for dof in everywhere if dof not in shape), None)
        if missing is not None:
            refuse.met(head.line, f"mode {head.number} has no displacement {missing[1]} of node {missing[0]}, which other modes have")


def named(head: Result) -> str:
    """A mode in words."""
    return f"mode {head.number} (line {head.line})"


def normal(one: DataSet, head: Result, refuse: Refusal) -> tuple[float, float | None, float | None]:
    """Frequency, modal mass and damping ratio of a normal mode; 0 is a modal mass that the file does not have."""
    if not head.reals:
        refuse.met(one.line, "a mode without a frequency")
    hertz, mass, viscous, hysteretic = [*head.reals[:4], 0.0, 0.0, 0.0][:4]
    if hertz < 0.0 or mass < 0.0:
        refuse.met(one.line, f"a mode of frequency {hertz:g} Hz and modal mass {mass:g}; both must be ≥ 0")
    damping = None if viscous == 0.0 and hysteretic != 0.0 else viscous
    return hertz, mass or None, damping
