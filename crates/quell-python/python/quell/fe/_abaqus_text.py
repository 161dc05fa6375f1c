"""Text of Abaqus: entries of ``*MATRIX OUTPUT``, and matrices of substructures and user elements."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import NamedTuple

from .._errors import StudyError, complaint
from ._coordinate import Rows
from ._entries import Entries
from ._lines import Refusal, check_kind, is_cut_off, lines_of, number_of, whole_of
from ._points import Dof

__all__ = ["matrix_of"]

ADVICE = "; give symmetric=False for a matrix that is not symmetric"

TYPES = {"stiffness": "STIFFNESS", "mass": "MASS", "damping": "VISCOUS DAMPING", "structural_damping": "STRUCTURAL DAMPING"}
"""Types of matrices in the text of a substructure."""

INSTEAD = "write it with *MATRIX OUTPUT, FORMAT=MATRIX INPUT"


class Line(NamedTuple):
    """An entry of a line: two or four labels and the text of the value."""

    number: int
    labels: list[int]
    value: float


def matrix_of(file: str | os.PathLike[str], name: str, rows: Rows, symmetric: bool) -> Entries:
    """The entries of a file by node and direction.

    Raises
    ------
    quell.StudyError
        A line that is wrong, or rows without nodes that are not named.
    """
    check_kind(name, file, INSTEAD)
    refuse = Refusal(name, file)
    if any(line[:13].upper() == "*USER ELEMENT" for _, line in lines_of(name, file)):
        return substructure(file, name, refuse)
    found = Entries(name, file, symmetric=symmetric, advice=ADVICE)
    bare: list[Line] = []
    labels = 0
    for entry in entries(file, lines_of(name, file), refuse):
        if labels not in (0, len(entry.labels)):
            refuse.met(entry.number, f"{len(entry.labels)} labels before the entry, and {labels} in the lines above")
        labels = len(entry.labels)
        if labels == 4:
            if rows.is_given:
                refuse.met(entry.number, "a matrix whose lines have nodes and directions; leave out dofs, nodes and directions")
            row, row_direction, column, column_direction = entry.labels
            found.add((row, row_direction), (column, column_direction), entry.value, entry.number)
        else:
            bare.append(entry)
    if bare:
        by_rows(bare, found, rows, refuse)
    if not len(found):
        raise StudyError([complaint(name, str(file), f"{file} has no line with an entry of a matrix of Abaqus", "path")])
    return found


def entries(path: str | os.PathLike[str], lines: Iterable[tuple[int, str]], refuse: Refusal) -> Iterable[Line]:
    """The lines with entries."""
    last, number, fixed = "", 0, 0
    for number, line in lines:
        words = line.replace(",", " ").split()
        # Comments begin with **; a keyword line, with *, comes before the entries.
        if not words or words[0].startswith("*"):
            continue
        if words[0].startswith("%"):
            refuse.met(number, f"{line[:60]!r} begins a file in Matrix Market form, not a matrix of Abaqus")
        try:
            *texts, last = words
            found = Line(number, [whole_of(text) for text in texts], number_of(last))
        except ValueError:
            found = Line(number, [], 0.0)
        if len(found.labels) not in (2, 4) or (len(found.labels) == 4 and not all(1 <= found.labels[at] for at in (1, 3))):
            refuse(number, line, "row node, direction, column node, direction and a finite entry, or row, column and entry")
        # Abaqus writes numbers of equal length: a shorter one at the end has lost digits.
        if fixed and len(last.lstrip("-+")) < fixed and is_cut_off(path):
            refuse(number, line, f"an entry of {fixed} characters as those above: the file is cut off")
        fixed = len(last.lstrip("-+")) if "e" in last.lower() else 0
        yield found


def by_rows(bare: list[Line], found: Entries, rows: Rows, refuse: Refusal) -> None:
    """Adds the entries of the format COORDINATE."""
    least = min(bare, key=lambda entry: min(entry.labels))
    if min(least.labels) < 1:
        refuse.met(least.number, f"row {least.labels[0]} and column {least.labels[1]}; they begin at 1")
    count = max(max(entry.labels) for entry in bare)
    dofs = rows.named(count, f"{refuse.path} (FORMAT=COORDINATE)")
    for entry in bare:
        found.add(dofs[entry.labels[0] - 1], dofs[entry.labels[1] - 1], entry.value, entry.number)


def keyword(line: str) -> tuple[str, dict[str, str]]:
    """The keyword of a line and its parameters."""
    head, *rest = [part.strip().upper() for part in line.lstrip("*").split(",")]
    parameters = (part.partition("=") for part in rest)
    return head, {key.strip(): value.strip() for key, _, value in parameters}


def substructure(file: str | os.PathLike[str], name: str, refuse: Refusal) -> Entries:
    """A matrix of the text of a substructure: nodes in comments, lists of degrees of freedom, and rows of the lower triangle."""
    found = Entries(name, file, symmetric=True)
    nodes: list[int] = []
    count, expects_nodes, wanted, begun = 0, False, False, 0
    lists: list[tuple[int, str]] = []
    values: list[tuple[int, float]] = []
    in_matrix = False
    types: list[str] = []
    for number, line in lines_of(name, file):
        text = line.strip()
        if text.startswith("**"):
            if "ELEMENT NODES" in text.upper():
                expects_nodes = True
            elif expects_nodes:
                nodes += [int(word) for word in text.replace("*", " ").replace(",", " ").split() if word.lstrip("-").isdigit()]
                expects_nodes = len(nodes) < count
        elif text.startswith("*"):
            key, parameters = keyword(text)
            in_matrix = key == "MATRIX"
            wanted = in_matrix and parameters.get("TYPE") == TYPES[name]
            if key == "USER ELEMENT":
                if begun:
                    refuse.met(number, f"a second *USER ELEMENT; line {begun} has the first. One substructure is read")
                begun, count = number, int(parameters.get("NODES", "0") or 0)
                if "UNSYMM" in parameters:
                    refuse.met(number, "a substructure with unsymmetric matrices, of which only symmetric ones are read")
            if in_matrix:
                types.append(parameters.get("TYPE", ""))
                if wanted and values:
                    refuse.met(number, f"a second matrix of type {TYPES[name]}")
        elif text and begun and not in_matrix:
            lists.append((number, text))
        elif text and wanted:
            values += numbers_of(number, text, refuse)
    if not values:
        raise StudyError([complaint(name, str(file), f"{file} has no *MATRIX, TYPE={TYPES[name]}; it has {', '.join(types) or 'none'}", "path")])
    dofs = dofs_of(nodes, lists, count, begun, refuse)
    fill(found, dofs, values, refuse)
    return found


def numbers_of(number: int, text: str, refuse: Refusal) -> list[tuple[int, float]]:
    """The numbers of a line of a matrix."""
    try:
        return [(number, number_of(word)) for word in text.replace(",", " ").split()]
    except ValueError:
        refuse(number, text, "finite numbers with commas")


def dofs_of(nodes: list[int], lists: list[tuple[int, str]], count: int, begun: int, refuse: Refusal) -> list[Dof]:
    """The degrees of freedom of the nodes: the list of the first, then a position from which on another one holds."""
    if not nodes or len(nodes) != count:
        refuse.met(begun, f"*USER ELEMENT has {count} nodes, and the comment ELEMENT NODES after it has {len(nodes)}")
    own: dict[int, list[int]] = {}
    position = 1
    for place, (number, text) in enumerate(lists):
        try:
            words = [whole_of(word) for word in text.replace(",", " ").split()]
        except ValueError:
            refuse(number, text, "whole numbers: directions of the first node, or a position and the directions from it on")
        if place:
            position, *words = words
        if not words or not 1 <= position <= count or any(word < 1 for word in words):
            refuse(number, text, f"a position of a node from 1 to {count}, and its directions")
        own[position] = words
    if 1 not in own:
        refuse.met(begun, "*USER ELEMENT without the list of directions of its first node")
    found: list[Dof] = []
    directions = own[1]
    for place, node in enumerate(nodes, 1):
        directions = own.get(place, directions)
        found += [(node, direction) for direction in directions]
    if len(set(found)) < len(found):
        refuse.met(begun, "*USER ELEMENT has a node with a direction twice")
    return found


def fill(found: Entries, dofs: list[Dof], values: list[tuple[int, float]], refuse: Refusal) -> None:
    """Adds the rows of a lower triangle."""
    size = len(dofs)
    if len(values) != size * (size + 1) // 2:
        what = f"{len(values)} numbers, and the lower triangle of {size} degrees of freedom has {size * (size + 1) // 2}"
        refuse.met(values[-1][0], f"the matrix ends here with {what}. Is the file cut off?")
    places = ((row, column) for row in range(size) for column in range(row + 1))
    for (row, column), (number, value) in zip(places, values, strict=True):
        found.add(dofs[row], dofs[column], value, number)
