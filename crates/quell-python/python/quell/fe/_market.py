"""Matrices in Matrix Market form, as ANSYS exports them, and vectors of node numbers."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import NamedTuple

from ._coordinate import Rows
from ._entries import Entries
from ._lines import Refusal, check_kind, lines_of, number_of, whole_of

__all__ = ["market_matrix", "market_vector"]

BANNER = "%%MATRIXMARKET"
INSTEAD = "export it with *EXPORT, NAME, MMF, FILE"


class Head(NamedTuple):
    """The first lines of a file."""

    line: int
    """Line of the sizes."""
    form: str
    """coordinate or array."""
    kind: str
    """real, integer, …"""
    symmetry: str
    sizes: list[int]


def head_of(lines: Iterator[tuple[int, str]], refuse: Refusal) -> Head:
    """Reads the banner, comments and sizes."""
    number, line = next(lines, (1, ""))
    words = line.split()
    if len(words) != 5 or words[0].upper() != BANNER or words[1].lower() != "matrix":
        refuse(number, line, "the banner of Matrix Market: %%MatrixMarket matrix, coordinate or array, real, and the symmetry")
    form, kind, symmetry = (word.lower() for word in words[2:])
    if form not in ("coordinate", "array"):
        refuse(number, line, "a matrix in the form coordinate or array")
    if kind not in ("real", "integer"):
        refuse(number, line, f"a matrix of real numbers, and this one is {kind}")
    if symmetry not in ("general", "symmetric"):
        refuse(number, line, f"a general or a symmetric matrix, and this one is {symmetry}")
    wanted = 3 if form == "coordinate" else 2
    for number, line in lines:
        if not line.strip() or line.lstrip().startswith("%"):
            continue
        try:
            sizes = [whole_of(word) for word in line.split()]
        except ValueError:
            sizes = []
        if len(sizes) != wanted or min(sizes) < 0:
            refuse(number, line, "rows, columns and the number of entries" if wanted == 3 else "rows and columns")
        return Head(number, form, kind, symmetry, sizes)
    refuse.met(number, "the file ends before its sizes")


def content(lines: Iterator[tuple[int, str]]) -> Iterator[tuple[int, str]]:
    """The lines with numbers."""
    return ((number, line) for number, line in lines if line.strip() and not line.lstrip().startswith("%"))


def market_matrix(file: str | os.PathLike[str], name: str, rows: Rows, symmetric: bool) -> Entries:
    """The entries of a matrix by node and direction.

    Raises
    ------
    quell.StudyError
        A line that is wrong, entries that are missing, or rows that are not named.
    """
    check_kind(name, file, INSTEAD)
    refuse = Refusal(name, file)
    lines = lines_of(name, file)
    head = head_of(lines, refuse)
    count = head.sizes[0]
    if head.sizes[1] != count:
        refuse.met(head.line, f"a matrix of {count} rows and {head.sizes[1]} columns, and that of a structure is square")
    dofs = rows.named(count, str(file))
    if len(dofs) != count:
        refuse.met(head.line, f"a matrix of {count} rows, and another one of the structure has {len(dofs)}")
    found = Entries(name, file, symmetric=symmetric or head.symmetry == "symmetric")
    read = coordinates(lines, head, refuse) if head.form == "coordinate" else columns(lines, head, refuse)
    for number, row, column, value in read:
        found.add(dofs[row - 1], dofs[column - 1], value, number)
    # Rows of zeros are degrees of freedom too.
    for dof in dofs:
        found.dofs.setdefault(dof, len(found.dofs))
    return found


def coordinates(lines: Iterator[tuple[int, str]], head: Head, refuse: Refusal) -> Iterator[tuple[int, int, int, float]]:
    """Line, row, column and value of the entries of the form coordinate."""
    count, number = 0, head.line
    for number, line in content(lines):
        count += 1
        if count > head.sizes[2]:
            refuse.met(number, f"more than the {head.sizes[2]} entries that line {head.line} states")
        try:
            row, column, value = line.split()
            places = whole_of(row), whole_of(column)
            entry = number_of(value)
        except ValueError:
            refuse(number, line, "row, column and a finite entry")
        if not all(1 <= place <= head.sizes[0] for place in places):
            refuse(number, line, f"a row and a column from 1 to {head.sizes[0]}")
        if head.symmetry == "symmetric" and places[1] > places[0]:
            refuse(number, line, "an entry of the lower triangle, which a symmetric matrix has in this form")
        yield number, *places, entry
    if count < head.sizes[2]:
        refuse.met(number, f"the file ends after {count} of the {head.sizes[2]} entries that line {head.line} states")


def columns(lines: Iterator[tuple[int, str]], head: Head, refuse: Refusal) -> Iterator[tuple[int, int, int, float]]:
    """Line, row, column and value of the entries of the form array, column by column."""
    size = head.sizes[0]
    places = ((row, column) for column in range(1, size + 1) for row in range(column if head.symmetry == "symmetric" else 1, size + 1))
    number = head.line
    for number, line in content(lines):
        for word in line.split():
            place = next(places, None)
            if place is None:
                refuse.met(number, f"more entries than a matrix of {size} rows has")
            try:
                value = number_of(word)
            except ValueError:
                refuse(number, line, "a finite entry")
            if value != 0.0:
                yield number, *place, value
    if next(places, None) is not None:
        refuse.met(number, f"the file ends before the last entry of a matrix of {size} rows")


def market_vector(argument: str, file: str | os.PathLike[str]) -> list[int]:
    """The node numbers of a mapping vector: in Matrix Market form, or one a line.

    Raises
    ------
    quell.StudyError
        A line that is wrong.
    """
    check_kind(argument, file, INSTEAD)
    refuse = Refusal(argument, file)
    lines = lines_of(argument, file)
    is_market = next(lines_of(argument, file), (1, ""))[1].upper().startswith(BANNER)
    stated = None
    if is_market:
        head = head_of(lines, refuse)
        if head.form != "array" or head.sizes[1] != 1:
            refuse.met(head.line, "a mapping vector must be an array of one column")
        stated = head.sizes[0]
    found: dict[int, int] = {}
    number = 1
    for number, line in content(lines):
        try:
            node = whole_of(line)
        except ValueError:
            refuse(number, line, "the number of a node")
        if node < 1:
            refuse(number, line, "the number of a node, from 1 on")
        if node in found:
            refuse.met(number, f"node {node} again; line {found[node]} has it first")
        found[node] = number
    if stated is not None and len(found) != stated:
        refuse.met(number, f"the file ends after {len(found)} of the {stated} nodes that its head states")
    return list(found)
