"""Functions of universal files: data set 58, ascii and binary."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._errors import StudyError, complaint
from ._lines import Refusal, whole_of
from ._points import DIRECTIONS, Dof
from ._response import Point, Response
from ._uff import FUNCTIONS, DataSet, fixed, numbers

__all__ = ["FREQUENCY_RESPONSE", "QUANTITIES", "Function", "check_pairs", "function_of", "response_of"]

FREQUENCY_RESPONSE = 4
"""Function type of a frequency response function."""

QUANTITIES = {"displacement": 8, "velocity": 11, "acceleration": 12}
"""Specific types of responses, in the order of their derivatives."""

EXCITATIONS = (9, 13)
"""Specific types of forces: of reaction and of excitation."""

FREQUENCY = 18
"""Specific type of an abscissa in Hz."""

UNSAID = (0, 1)
"""Specific types that say nothing: unknown and general."""

Floats = npt.NDArray[np.float64]
Values = npt.NDArray[np.complex128]


class Function(NamedTuple):
    """The head of a function."""

    line: int
    kind: int
    """Function type."""
    titles: list[str]
    response: tuple[str, int, int]
    """Name, node and direction."""
    reference: tuple[str, int, int]
    data: int
    """Type of the ordinate: 2 and 4 real, 5 and 6 complex; 4 and 6 with double precision."""
    points: int
    is_even: bool
    begin: float
    step: float
    abscissa: int
    """Specific types."""
    numerator: int
    denominator: int
    labels: list[str]
    """Units that abscissa, ordinate and its denominator have in words."""

    def name(self) -> str:
        """What the function is."""
        name = FUNCTIONS[self.kind] if 0 <= self.kind < len(FUNCTIONS) else "unknown function"
        return f"{name} (function type {self.kind})"

    def words(self) -> str:
        """What the function is, and where."""
        return f"data set 58 (line {self.line}): {self.name()}"


def head_lines(one: DataSet) -> int:
    """The place of the first line after that of the number, which a binary function keeps."""
    return 1 if one.lines and one.lines[0][0] == one.line else 0


def function_of(one: DataSet, refuse: Refusal) -> Function:
    """Reads the head of a function."""
    first = head_lines(one)
    rows = [one.text(first + place, refuse) for place in range(10)]
    number, line = rows[5]
    fields = fixed(line, (5, 10, 5, 10, 11, 10, 4, 11, 10, 4))
    if len(words := line.split()) == 10 and not all(field.lstrip("-").isdigit() for field in (*fields[:4], *fields[5:7], *fields[8:10])):
        # The words are not in their columns.
        fields = words
    try:
        kind = whole_of(fields[0])
        response = (fields[4], whole_of(fields[5] or "0"), whole_of(fields[6] or "0"))
        reference = (fields[7], whole_of(fields[8] or "0"), whole_of(fields[9] or "0"))
    except ValueError:
        refuse(number, line, "function type, numbers, and name, node and direction of response and reference in their columns")
    number, line = rows[6]
    values = numbers(number, one.lines[first + 6][1], refuse, "type of the ordinate, points, spacing, first abscissa and increment")
    if len(values) < 5 or values[1] < 1 or int(values[0]) not in (2, 4, 5, 6):
        refuse(number, line, "type of the ordinate (2, 4, 5 or 6), at least one point, spacing, first abscissa and increment")
    axes = [fixed(line, (10, 5, 5, 5, 1, 20, 1, 20)) for _, line in rows[7:10]]
    try:
        types = [whole_of(axis[0]) for axis in axes]
    except ValueError:
        refuse(rows[7][0], rows[7][1], "specific types of abscissa, ordinate and its denominator")
    titles = [line.strip() for _, line in rows[:5]]
    labels = [axis[7] for axis in axes]
    abscissa, numerator, denominator = types
    return Function(
        one.line, kind, titles, response, reference, int(values[0]), int(values[1]), values[2] == 1.0, values[3], values[4],
        abscissa, numerator, denominator, labels,
    )  # fmt: skip


def ordinates(one: DataSet, head: Function, refuse: Refusal) -> tuple[Floats, Values]:
    """Abscissae and values of a function."""
    width = (1 if head.data in (2, 4) else 2) + (0 if head.is_even else 1)
    if one.binary:
        found = from_bytes(one, head, width, refuse)
    else:
        read: list[float] = []
        for number, line in one.lines[head_lines(one) + 11 :]:
            read += numbers(number, line, refuse, "finite numbers")
        found = np.array(read)
        if found.size != width * head.points:
            what = f"{found.size} numbers, and {head.points} points have {width * head.points}"
            refuse.met(one.lines[-1][0], f"the function of line {one.line} ends here with {what}. Is the file cut off?")
        found = found.reshape(-1, width)
    if not np.isfinite(found).all():
        refuse.met(one.line, "a function with numbers that are not finite")
    x: Floats = np.asarray(head.begin + head.step * np.arange(head.points) if head.is_even else found[:, 0], dtype=np.float64)
    y = found if head.is_even else found[:, 1:]
    values: Values = np.asarray(y[:, 0] + (1j * y[:, 1] if y.shape[1] == 2 else 0j), dtype=np.complex128)
    if (np.diff(x) <= 0.0).any():
        refuse.met(one.line, "a function whose abscissae do not ascend")
    return x, values


def from_bytes(one: DataSet, head: Function, width: int, refuse: Refusal) -> Floats:
    """The numbers of a binary function; an uneven abscissa next to double numbers is single in some files."""
    size = 8 if head.data in (4, 6) else 4
    number = f"{one.order}f{size}"
    if len(one.binary) == head.points * width * size:
        return np.frombuffer(one.binary, dtype=number).astype(np.float64).reshape(-1, width)
    if not head.is_even and len(one.binary) == head.points * (4 + (width - 1) * size):
        rows = np.frombuffer(one.binary, dtype=[("x", f"{one.order}f4"), ("y", number, (width - 1,))])
        return np.column_stack([rows["x"].astype(np.float64), rows["y"].astype(np.float64)])
    refuse.met(one.line, f"a binary function of {len(one.binary)} bytes; {head.points} points have {head.points * width * size}")


def directed(head: Function, of: tuple[str, int, int], what: str, refuse: Refusal) -> tuple[Dof, float]:
    """A node with the number of a direction, and its sign."""
    name, node, direction = of
    if not 1 <= abs(direction) <= len(DIRECTIONS):
        titles = [title for title in head.titles if title not in ("", "NONE")]
        where = f"node {node}" + (f" ({name})" if name not in ("", "NONE") else "")
        met = f"the {what} of a frequency response at {where} has direction {direction}, a scalar, which names no displacement"
        met += f"; the text of the data set is {' / '.join(titles)!r}" if titles else ""
        refuse.met(head.line, f"{met}. Give pairs=[(response, force), …] with the names of the points of each data set 58")
    return (node, abs(direction)), float(np.sign(direction))


def derivative(head: Function, quantity: str | None, refuse: Refusal) -> int:
    """0 of a displacement, 1 of a velocity and 2 of an acceleration over a force."""
    types = list(QUANTITIES.values())
    kind, over = head.numerator, head.denominator
    words = f"types {kind} ({head.labels[1]!r}) over {over} ({head.labels[2]!r})"
    if quantity is not None:
        if kind not in (*UNSAID, QUANTITIES[quantity]) or over not in (*UNSAID, *EXCITATIONS):
            refuse.met(head.line, f"a frequency response of {words}, which contradicts quantity={quantity!r}")
        return list(QUANTITIES).index(quantity)
    if kind in UNSAID or over in UNSAID:
        give = 'give quantity="acceleration", "velocity" or "displacement" if it is that over a force'
        refuse.met(head.line, f"a frequency response of {words}, which are no quantities; {give}")
    if kind not in types or over not in EXCITATIONS:
        allowed = "displacement (8), velocity (11) or acceleration (12) over force (9 or 13)"
        refuse.met(head.line, f"a frequency response of {words}; read are {allowed}")
    return types.index(kind)


def response_of(one: DataSet, head: Function, pair: tuple[str, str] | None, quantity: str | None, refuse: Refusal) -> Response:
    """A frequency response as receptance, displacement over force.

    Raises
    ------
    quell.StudyError
        It has no directions, or is no motion over a force.
    """
    output: Point
    force: Point
    if pair is not None:
        (output, force), sign = pair, 1.0
    else:
        output, sign_out = directed(head, head.response, "response", refuse)
        force, sign_in = directed(head, head.reference, "force", refuse)
        sign = sign_out * sign_in
    if head.abscissa not in (*UNSAID, FREQUENCY) or re.search(r"rad|rpm|^s$", head.labels[0], re.IGNORECASE):
        refuse.met(head.line, f"a frequency response over an abscissa of type {head.abscissa} ({head.labels[0]!r}), not over a frequency in Hz")
    order = derivative(head, quantity, refuse)
    hertz, values = ordinates(one, head, refuse)
    if hertz[0] < 0.0:
        refuse.met(head.line, "a frequency response with negative frequencies")
    # Velocity and acceleration say nothing about the static response.
    says = np.ones(hertz.shape, dtype=bool) if order == 0 else hertz > 0.0
    s: Values = np.asarray(2j * np.pi * hertz[says], dtype=np.complex128)
    return Response(output, force, hertz[says], values[says] * sign / s**order, head.line)


def check_pairs(pairs: object, count: int) -> list[tuple[str, str] | None]:
    """The names of response and force of each function.

    Raises
    ------
    quell.StudyError
        They are not pairs of names, or of another number.
    """
    if pairs is None:
        return [None] * count
    allowed = f"the names of response and force of each of the {count} frequency responses of the file, such as [(\"pad_x\", \"pad_x\")]"
    if not isinstance(pairs, (list, tuple)) or len(pairs) != count:
        raise StudyError([complaint("pairs", pairs, allowed)])
    found: list[tuple[str, str] | None] = []
    for place, pair in enumerate(pairs):
        if not isinstance(pair, (list, tuple)) or len(pair) != 2 or not all(isinstance(name, str) and name for name in pair):
            raise StudyError([complaint(f"pairs[{place}]", pair, 'two names, such as ("pad_x", "pad_x")')])
        found.append((pair[0], pair[1]))
    return found
