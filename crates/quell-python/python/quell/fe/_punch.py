"""Blocks of results in a punch file of Nastran: what each is, and its rows.

Lines have fixed columns: a grid or a frequency and the kind of point in the first 18, then three numbers of 18 characters, and the number
of the line from column 73 on.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from ._lines import Refusal, number_of, whole_of

__all__ = ["Block", "Row", "blocks_of", "summary"]

TITLES = ("TITLE", "SUBTITLE", "LABEL")


@dataclass
class Row:
    """The values of a grid or of a frequency."""

    line: int
    head: str
    """The grid, or the frequency."""
    kind: str
    """G for a grid, S for a scalar point."""
    values: list[float]


@dataclass
class Block:
    """One table of results."""

    line: int
    kind: str
    """Such as EIGENVECTOR or DISPLACEMENTS."""
    form: str = "REAL"
    """REAL, REAL-IMAGINARY or MAGNITUDE-PHASE."""
    case: int = 0
    keys: dict[str, tuple[int, str]] = field(default_factory=dict)
    """Other keys of the head, such as EIGENVALUE, with line and value."""
    rows: list[Row] = field(default_factory=list)

    def is_complex(self) -> bool:
        """Whether every value has two parts."""
        return self.form != "REAL"

    def components(self, row: Row, refuse: Refusal) -> list[complex]:
        """The values of a row, six of a grid or one of a scalar point."""
        values, size = row.values, len(row.values)
        parts = 2 if self.is_complex() else 1
        wanted = {3 * parts, 6 * parts} | ({parts} if row.kind == "S" else set())
        if size not in wanted:
            refuse.met(row.line, f"{row.head.strip()} has {size} values; a {self.form.lower()} table has {6 * parts} at a grid. Is the file cut off?")
        half = size // parts
        found = [complex(value) for value in values[:half]]
        if self.form == "REAL-IMAGINARY":
            found = [complex(re, im) for re, im in zip(values[:half], values[half:], strict=True)]
        elif self.form == "MAGNITUDE-PHASE":
            turned = (np.exp(1j * np.deg2rad(angle)) for angle in values[half:])
            found = [size * complex(turn) for size, turn in zip(values[:half], turned, strict=True)]
        return found[:1] if row.kind == "S" else found


def blocks_of(lines: Iterable[tuple[int, str]], refuse: Refusal, wanted: tuple[str, ...]) -> list[Block]:
    """The blocks of a file; rows are read of those whose kind begins with one of ``wanted``."""
    found: list[Block] = []
    case, in_head, in_bulk = 0, False, False
    for number, line in lines:
        # Columns 73 to 80 count the lines.
        line = line[:72].rstrip()
        if line.startswith("$") and not line[1:2].isalpha():
            # A comment: names of tables and of their keys begin at once.
            continue
        if line.startswith("$"):
            in_bulk = False
            key, equals, value = line[1:].partition("=")
            key = " ".join(key.split()).upper()
            if not equals:
                in_head = titled(found, number, key, case, in_head)
            elif key == "SUBCASE ID":
                try:
                    case = whole_of(value)
                except ValueError:
                    refuse(number, line, "the number of a subcase")
                if in_head:
                    found[-1].case = case
            elif key in TITLES:
                in_head = False
            elif found:
                if found[-1].rows:
                    # A table of the same kind may go on with its next key.
                    last = found[-1]
                    found.append(Block(number, last.kind, last.form, case))
                found[-1].keys[key] = (number, value)
        elif line[:1].isalpha() or line[:1] == "*":
            # Entries of an input file, such as DMIG, with their continuations.
            in_bulk = True
        elif line.strip() and not in_bulk and found and found[-1].kind.startswith(wanted):
            add_row(found[-1], number, line, refuse)
    return found


def titled(found: list[Block], number: int, words: str, case: int, in_head: bool) -> bool:
    """Reads a line of a head without a value: the form of the numbers, or the name of a table."""
    if words.endswith("OUTPUT") and found:
        form = words.removesuffix("OUTPUT").strip()
        found[-1].form = form if form in ("REAL-IMAGINARY", "MAGNITUDE-PHASE") else "REAL"
        return in_head
    if words:
        found.append(Block(number, words, case=case))
        return True
    return in_head


def add_row(block: Block, number: int, line: str, refuse: Refusal) -> None:
    """Reads a line of numbers."""
    try:
        values = [number_of(line[at : at + 18]) for at in (18, 36, 54) if line[at : at + 18].strip()]
    except ValueError:
        refuse(number, line, "finite numbers in columns of 18 characters")
    if line.startswith("-CONT-"):
        if not block.rows:
            refuse(number, line, "a row with a grid or a frequency first")
        block.rows[-1].values.extend(values)
        return
    *head, kind = line[:18].split() or [""]
    if len(head) != 1 or kind not in ("G", "S"):
        refuse(number, line, "a grid (G) or a scalar point (S), and numbers in columns of 18 characters")
    block.rows.append(Row(number, head[0], kind, values))


def summary(blocks: list[Block]) -> str:
    """What a file has, in words."""
    kinds = dict.fromkeys(block.kind for block in blocks)
    found = []
    for kind in kinds:
        own = [block for block in blocks if block.kind == kind]
        points = [block.keys["POINT ID"][1].upper() for block in own if "POINT ID" in block.keys]
        by = next((words for key, words in BY if any(key in block.keys for block in own) or any(key in text for text in points)), "")
        found.append(f"{kind}{by} (line {own[0].line})")
    return ", ".join(found)


BY = (("FREQUENCY", " by frequency"), ("TIME", " over time"), ("EIGENVALUE", " of modes"))
"""Keys of tables, and what they mean."""
