"""Data sets of universal files: where each begins, and its lines; binary functions with their bytes."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from dataclasses import dataclass, field

from ._lines import Refusal, check_kind, number_of, whole_of

__all__ = ["ANALYSES", "DataSet", "FUNCTIONS", "Units164", "data_sets", "fixed", "numbers", "summary", "units_of"]

INSTEAD = "export a universal file (.unv, .uff) with data sets 55, 58 or 2414"

NUMBERS = re.compile(rb"\s*[+-]?(?:\d+\.\d*[+-]\d{3}(?![\d.])|(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d+)?)")
"""A number of a line; numbers of 13 characters need no space between them, and exponents of three digits no E."""

CONTENTS = {
    15: "nodes", 18: "coordinate systems", 55: "results at nodes", 56: "results of elements", 57: "results of elements", 58: "functions", 82: "trace lines",
    151: "header", 164: "units", 780: "elements", 781: "nodes", 2400: "model", 2411: "nodes", 2412: "elements", 2414: "results",
    2417: "groups", 2420: "coordinate systems", 2429: "groups", 2430: "groups", 2432: "groups", 2435: "groups", 2452: "groups",
    2467: "groups", 2477: "groups", 1858: "qualifiers of functions",
}  # fmt: skip
"""What data sets have."""

ANALYSES = {
    0: "unknown", 1: "static", 2: "normal mode", 3: "complex eigenvalue", 4: "transient", 5: "frequency response", 6: "buckling",
    7: "complex eigenvalue of second order", 9: "static, nonlinear",
}  # fmt: skip
"""Types of analysis."""

FUNCTIONS = (
    "general function", "time record", "auto spectrum", "cross spectrum", "frequency response function", "transmissibility", "coherence",
    "auto correlation", "cross correlation", "power spectral density", "energy spectral density", "probability density function",
    "spectrum", "cumulative frequency distribution", "peaks and valleys", "stress over cycles", "strain over cycles", "orbit",
    "mode indicator function", "force pattern", "partial power", "partial coherence", "eigenvalue", "eigenvector",
    "shock response spectrum", "impulse response filter", "multiple coherence", "order function", "phase compensation",
)  # fmt: skip
"""Types of functions in data set 58."""


@dataclass
class DataSet:
    """One data set of a file."""

    kind: int
    line: int
    """Line of its number."""
    lines: list[tuple[int, bytes]] = field(default_factory=list)
    binary: bytes = b""
    """The values of a binary function."""
    order: str = "<"
    """Order of its bytes."""

    def text(self, place: int, refuse: Refusal) -> tuple[int, str]:
        """A line of the data set, from 0, with its number."""
        if place >= len(self.lines):
            refuse.met(self.line, f"data set {self.kind} ends before its line {place + 1}. Is the file cut off?")
        number, line = self.lines[place]
        return number, line.decode("latin-1")


def data_sets(argument: str, path: str | os.PathLike[str]) -> list[DataSet]:
    """The data sets of a file in its order.

    Raises
    ------
    quell.StudyError
        The file has none, or ends within one.
    """
    refuse = Refusal(argument, path)
    with open(os.fspath(path), "rb") as file:
        content = file.read().removeprefix(b"\xef\xbb\xbf")
    if not re.search(rb"^ *-1 *\r?$", content, re.MULTILINE):
        check_kind(argument, path, INSTEAD)
        refuse.met(1, f"no data set begins, with a line -1; {INSTEAD}")
    found: list[DataSet] = []
    current: DataSet | None = None
    at, number, is_open = 0, 0, False
    while at < len(content):
        end = content.find(b"\n", at)
        end = len(content) if end < 0 else end
        line, at, number = content[at:end].rstrip(b"\r"), end + 1, number + 1
        # A number −1 of data is in ten columns.
        if line.strip() == b"-1" and len(line.rstrip()) <= 6:
            is_open, current = not is_open, None
        elif is_open and current is None:
            current = begun(number, line, refuse)
            found.append(current)
        elif current is not None:
            current.lines.append((number, line))
            head, size = binary_of(current)
            if head and len(current.lines) == head:
                close = end_of_bytes(content, at, size)
                if close is None:
                    have = len(content) - at
                    refuse.met(current.line, f"the file ends after {have} of the {size} bytes of a binary function, without a line -1 after it")
                current.binary, at = content[at:close], close
                at += len(content[at : at + 2]) - len(content[at : at + 2].lstrip(b"\r\n"))
    if is_open:
        what, where = (f"data set {found[-1].kind}", found[-1].line) if found else ("a data set", number)
        refuse.met(where, f"{what} has no end, a line -1. Is the file cut off?")
    return found


def begun(number: int, line: bytes, refuse: Refusal) -> DataSet:
    """The data set that a line begins."""
    words = line[:6].split()
    text = words[0] if words else b""
    is_binary = line[6:7].lower() == b"b" or text.lower().endswith(b"b")
    try:
        made = DataSet(whole_of(text.lower().rstrip(b"b").decode("latin-1")), number)
    except ValueError:
        refuse(number, line.decode("latin-1"), "the number of a data set after the line -1")
    if is_binary:
        made.order = ">" if fixed(line.decode("latin-1"), (6, 1, 6))[2] == "2" else "<"
        made.lines.append((number, line))
    return made


def binary_of(one: DataSet) -> tuple[int, int]:
    """Numbers of lines before the values of a binary function, its first included, and of bytes; 0 of another data set."""
    if not one.lines or one.lines[0][0] != one.line:
        return 0, 0
    fields = fixed(one.lines[0][1].decode("latin-1"), (6, 1, 6, 6, 12, 12))
    try:
        return whole_of(fields[4]) + 1, whole_of(fields[5])
    except ValueError:
        return 0, 0


def end_of_bytes(content: bytes, begin: int, size: int) -> int | None:
    """Where the bytes of a binary function end: before a line -1. Some programs state a wrong number of bytes."""
    if END.match(content, begin + size):
        return begin + size
    found = END.search(content, begin)
    return None if found is None else found.start()


END = re.compile(rb"\r?\n? {4}-1[ \r]*(?:\n|$)")
"""The end of a data set after bytes."""


def fixed(line: str, widths: Iterable[int]) -> list[str]:
    """The fields of a line in columns."""
    found, at = [], 0
    for width in widths:
        found.append(line[at : at + width].strip())
        at += width
    return found


def numbers(number: int, line: bytes, refuse: Refusal, wanted: str) -> list[float]:
    """All numbers of a line, and nothing else."""
    found, at, line = [], 0, line.rstrip()
    while at < len(line):
        match = NUMBERS.match(line, at)
        if match is None:
            refuse(number, line.decode("latin-1"), wanted)
        try:
            found.append(number_of(match.group().decode()))
        except ValueError:
            refuse(number, line.decode("latin-1"), wanted)
        at = match.end()
    return found


def summary(sets: list[DataSet]) -> str:
    """What data sets a file has, in words."""
    counts: dict[int, int] = {}
    for one in sets:
        counts[one.kind] = counts.get(one.kind, 0) + 1
    named = {kind: f"{kind} ({CONTENTS.get(kind, 'other')})" for kind in counts}
    return ", ".join(f"{count} × {named[kind]}" if count > 1 else named[kind] for kind, count in counts.items())


@dataclass
class Units164:
    """The units of a file: numbers over these factors are in SI."""

    line: int
    code: int
    name: str
    length: float
    force: float


def units_of(sets: list[DataSet], refuse: Refusal) -> Units164 | None:
    """The units that data set 164 states, if there is one."""
    stated = [one for one in sets if one.kind == 164]
    found = None
    for one in stated:
        number, line = one.text(0, refuse)
        code, name, *_ = fixed(line, (10, 20, 10))
        factors: list[float] = []
        for place, values in one.lines[1:]:
            factors += numbers(place, values, refuse, "the factors of length, force and temperature")
        if len(factors) < 2 or min(factors[:2]) <= 0.0 or not code.isdigit():
            refuse(number, line, "the code of the units, their name, and then positive factors of length and force")
        made = Units164(one.line, int(code), name, factors[0], factors[1])
        if found is not None and (found.length, found.force) != (made.length, made.force):
            refuse.met(made.line, f"a second data set 164 with other units; line {found.line} has the first")
        found = found or made
    return found
