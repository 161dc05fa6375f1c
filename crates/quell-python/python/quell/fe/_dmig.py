"""Matrices of Nastran as DMIG entries: fields of 8 or 16 characters, or between commas."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from ._entries import Entries
from ._lines import Refusal, number_of, whole_of
from ._points import Dof

__all__ = ["Header", "headers_of", "matrices"]

RECTANGULAR, SYMMETRIC = (2, 9), 6
"""Forms of matrices; 1 is a square one."""

COMPLEX = (3, 4)
"""Types of complex numbers; 1 and 2 are real."""

NAMED = {
    "VAX": "a vector of diagonal terms",
    "PAX": "loads",
    "RVA": "residual vectors",
    "MUG1T": "a transformation of results",
    "MUG1": "a transformation of results",
    "MEF1": "a transformation of results",
    "MES1": "a transformation of results",
    "MQG1": "a transformation of results",
    "K4AAX": "structural damping",
    "BAAX": "viscous damping",
}
"""What matrices of an external superelement are."""


@dataclass
class Header:
    """The first entry of a matrix."""

    name: str
    line: int
    case: int
    form: int
    kind: int
    columns: int | None
    """Number of columns that it states."""

    def words(self) -> str:
        """The matrix in words."""
        what = NAMED.get(self.name)
        size = f", {self.columns} column{'' if self.columns == 1 else 's'}" if self.form in RECTANGULAR and self.columns else ""
        return f"{self.name} ({f'{what}, ' if what else ''}line {self.line}{size})"


def headers_of(lines: Iterable[tuple[int, str]], refuse: Refusal) -> list[Header]:
    """The headers of all matrices of a file, of every subcase."""
    found: list[Header] = []
    case = 0
    for number, line in lines:
        if line.startswith("$"):
            case = subcase(line, case)
        elif line[:4].upper() == "DMIG" and is_header(fields := padded(line.split("$", 1)[0])):
            found.append(header_of(number, line, fields, case, refuse))
    return found


def subcase(line: str, before: int) -> int:
    """The subcase that a comment states, or the one before."""
    key, equals, value = line[1:].partition("=")
    if equals and key.split()[:1] == ["SUBCASE"] and value[:40].split():
        try:
            return whole_of(value[:40].split()[0])
        except ValueError:
            return before
    return before


def is_header(fields: list[str]) -> bool:
    """Whether an entry is the header of a matrix: its column is 0 and a form follows."""
    return len(fields) > 4 and fields[2] in ("0", "+0") and fields[3] != ""


def header_of(number: int, line: str, fields: list[str], case: int, refuse: Refusal) -> Header:
    """The header that an entry is."""
    name = fields[1].upper()
    try:
        form, kind = whole_of(fields[3]), whole_of(fields[4])
        columns = whole_of(fields[8]) if len(fields) > 8 and fields[8] else None
    except ValueError:
        refuse(number, line, "a header of DMIG: name, 0, form, type and number of columns in whole numbers")
    if not name:
        refuse(number, line, "a header of DMIG with the name of the matrix")
    if form not in (1, SYMMETRIC, *RECTANGULAR):
        refuse(number, line, f"the form 1 (square), 2 or 9 (rectangular) or 6 (symmetric) of {name}")
    if kind not in (1, 2, *COMPLEX):
        refuse(number, line, f"the type 1 or 2 (real), or 3 or 4 (complex) of {name}")
    return Header(name, number, case, form, kind, columns)


def matrices(lines: Iterable[tuple[int, str]], refuse: Refusal, wanted: dict[tuple[int, str], str]) -> dict[str, Entries]:
    """The matrices of a file by what they are; ``wanted`` has subcase and name of each.

    Raises
    ------
    quell.StudyError
        A line that is wrong.
    """
    found: dict[str, Entries] = {}
    forms: dict[str, Header] = {}
    case = 0
    for entry in entries(lines):
        number, line, fields = *entry.lines[0], entry.fields
        if not fields:
            case = subcase(line, case)
            continue
        name = fields[1].upper()
        key = wanted.get((case, name))
        if key is None:
            continue
        if is_header(fields):
            forms[key] = checked(header_of(number, line, fields, case, refuse), forms.get(key), refuse)
            found[key] = Entries(key, refuse.path, symmetric=forms[key].form == SYMMETRIC)
            continue
        if key not in found:
            refuse(number, line, f"the header of {name} before its columns")
        add_column(found[key], entry, refuse)
    return found


def add_column(found: Entries, entry: Entry, refuse: Refusal) -> None:
    """Adds the rows of a column."""
    fields, (number, line) = entry.fields, entry.lines[0]
    try:
        column = dof_of(fields[2], fields[3])
        for at in range(5, len(fields), 4):
            number, line = entry.lines[at] if at < len(entry.lines) else entry.lines[-1]
            if any(fields[at : at + 3]):
                row = dof_of(fields[at], fields[at + 1])
                found.add(row, column, number_of(fields[at + 2]), number)
    except (ValueError, IndexError):
        refuse(number, line, "a column of DMIG: grid and component, and rows with grid, component and a finite value")


def checked(header: Header, before: Header | None, refuse: Refusal) -> Header:
    """The header of a matrix that can be part of a structure."""
    name = header.name
    if before is not None:
        refuse.met(header.line, f"{name} begins again; line {before.line} has its first header. One matrix of each name can be read")
    if header.kind in COMPLEX:
        refuse.met(header.line, f"{name} is a complex matrix (type {header.kind}), and a structure has real ones")
    if header.form in RECTANGULAR:
        refuse.met(header.line, f"{name} is rectangular (form {header.form}), and the matrix of a structure is square (form 1 or 6)")
    return header


def dof_of(grid: str, component: str) -> Dof:
    """A degree of freedom; a scalar point has component 0, which is its displacement."""
    node, direction = whole_of(grid), whole_of(component or "0")
    if node < 1 or not 0 <= direction <= 6:
        raise ValueError(grid)
    return (node, max(direction, 1))


@dataclass
class Entry:
    """A DMIG entry with its continuations; a comment that states a subcase has no fields."""

    lines: list[tuple[int, str]]
    """Line and text of each field."""
    fields: list[str] = field(default_factory=list)
    """Field 4 is empty, so that rows begin at field 5."""


def entries(lines: Iterable[tuple[int, str]]) -> Iterator[Entry]:
    """The DMIG entries of a file."""
    current: Entry | None = None
    for number, line in lines:
        if line.startswith("$SUBCASE"):
            if current:
                yield current
            current = None
            yield Entry([(number, line)])
        plain = line.split("$", 1)[0].rstrip()
        if not plain:
            continue
        head = plain[:8].rstrip().upper().split(",")[0]
        if head.rstrip("*").rstrip() == "DMIG":
            if current:
                yield current
            fields = padded(plain)
            current = Entry([(number, plain)] * len(fields), fields)
        elif head in ("", "*") or head.startswith(("*", "+")):
            if current:
                more = padded(plain)[1:]
                current.fields.extend(more)
                current.lines.extend([(number, plain)] * len(more))
        elif current:
            yield current
            current = None
    if current:
        yield current


def padded(line: str) -> list[str]:
    """The fields of a line, four after the first in the wide format and eight in the others, without the last, which continues."""
    if "," in line:
        # The field after the eighth continues, or has the number of columns of a header.
        fields = [field.strip() for field in line.split(",")]
        count = 9
    elif "*" in line[:8]:
        fields = [line[:8], *(line[at : at + 16] for at in range(8, 72, 16))]
        count = 5
    else:
        fields = [line[at : at + 8] for at in range(0, 72, 8)]
        count = 9
    fields = [field.strip() for field in fields][:count]
    return fields + [""] * (count - len(fields))
