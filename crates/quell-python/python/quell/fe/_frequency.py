"""Displacements, velocities and accelerations by frequency of a punch file of Nastran, as receptances over a force that the caller states."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Union

import numpy as np

from .._errors import StudyError, complaint
from ._lines import Refusal, number_of, whole_of
from ._points import Dof, dof_of
from ._punch import Block, Row
from ._response import Response

__all__ = ["Forces", "MOTIONS", "is_by_frequency", "responses_of"]

Forces = Union[tuple[int, Union[str, int]], Mapping[int, tuple[int, Union[str, int]]], None]
"""Grid and direction of the force, of all subcases or of each."""

MOTIONS = ("DISPLACEMENT", "VELOCIT", "ACCELERATION")
"""Beginnings of the names of tables of motions, in the order of their derivatives."""


def is_by_frequency(block: Block) -> bool:
    """Whether a table has complex motions by frequency, in SORT1 or SORT2."""
    by_point = "FREQUENCY" in block.keys.get("POINT ID", (0, ""))[1].upper()
    return block.kind.startswith(MOTIONS) and ("FREQUENCY" in block.keys or by_point)


def responses_of(blocks: list[Block], forces: Forces, amplitude: float, case: int | None, refuse: Refusal) -> tuple[list[Response], list[str]]:
    """The responses of all subcases, or of one, and notes.

    Raises
    ------
    quell.StudyError
        A force that is not stated, or a line that is wrong.
    """
    present = [name for name in MOTIONS if any(block.kind.startswith(name) for block in blocks)]
    order, own = MOTIONS.index(present[0]), [block for block in blocks if block.kind.startswith(present[0])]
    notes = [f"Of the motions by frequency, {own[0].kind} were read, and the others left out."] if len(present) > 1 else []
    cases = list(dict.fromkeys(block.case for block in own))
    if case is not None:
        if case not in cases:
            raise StudyError([complaint("subcase", case, f"a subcase of the file, {', '.join(map(str, cases))}")])
        cases = [case]
    by_case = stated(forces, cases, own[0], refuse)
    if isinstance(amplitude, bool) or not isinstance(amplitude, (int, float)) or not np.isfinite(amplitude) or amplitude == 0.0:
        raise StudyError([complaint("force_amplitude", amplitude, "the amplitude of the force, a number other than 0")])
    found: dict[tuple[int, Dof], dict[float, tuple[int, complex]]] = {}
    for block in own:
        if block.case in by_case:
            gather(block, found, refuse)
    made = []
    for (where, dof), values in found.items():
        hertz = np.array(sorted(values))
        motion = np.array([values[one][1] for one in sorted(values)])
        # Velocity and acceleration say nothing about the static response.
        says = np.ones(hertz.shape, dtype=bool) if order == 0 else hertz > 0.0
        s = 2j * np.pi * hertz[says]
        line = min(line for line, _ in values.values())
        made.append(Response(dof, by_case[where], hertz[says], motion[says] / s**order / amplitude, line))
    return made, notes


def stated(forces: Forces, cases: list[int], first: Block, refuse: Refusal) -> dict[int, Dof]:
    """The force of each subcase."""
    given: Mapping[Any, Any] = forces if isinstance(forces, Mapping) else dict.fromkeys(cases, forces)
    found = {}
    for case in cases:
        dof = dof_of(given.get(case)) if given.get(case) is not None else None
        if dof is None and given.get(case) is not None:
            raise StudyError([complaint("force", given[case], 'a grid and a direction, such as (1204, "x")')])
        if dof is None and not isinstance(forces, Mapping):
            allowed = f"line {first.line} has {first.kind} by frequency, over a load that no punch file states"
            allowed += "; give force=(grid, direction) of a unit force"
            allowed += f", or one for each of the subcases {', '.join(map(str, cases))}" if len(cases) > 1 else f" of subcase {case}"
            raise StudyError([complaint("force", None, f"given: {refuse.path}, {allowed}", "missing")])
        if dof is not None:
            found[case] = dof
    if not found:
        raise StudyError([complaint("force", forces, f"that of a subcase of the file, {', '.join(map(str, cases))}")])
    return found


def gather(block: Block, found: dict[tuple[int, Dof], dict[float, tuple[int, complex]]], refuse: Refusal) -> None:
    """Adds the values of a table, which has one point (SORT2) or one frequency (SORT1)."""
    if not block.is_complex():
        refuse.met(block.line, f"{block.kind} by frequency in real numbers; request real and imaginary parts, or magnitude and phase")
    for row in block.rows:
        point, hertz = place_of(block, row, refuse)
        for direction, value in enumerate(block.components(row, refuse), 1):
            values = found.setdefault((block.case, (point, direction)), {})
            if hertz in values:
                refuse.met(row.line, f"point {point} has {hertz:g} Hz again; line {values[hertz][0]} has its first value")
            values[hertz] = (row.line, value)


def place_of(block: Block, row: Row, refuse: Refusal) -> tuple[int, float]:
    """The point and the frequency of a row."""
    try:
        if "FREQUENCY" in block.keys:
            words = block.keys["FREQUENCY"][1].split()
            point, hertz = whole_of(row.head), number_of(words[0])
        else:
            point, hertz = whole_of(block.keys["POINT ID"][1].split()[0]), number_of(row.head)
    except (ValueError, IndexError):
        refuse(row.line, row.head, "the row of a grid at the frequency of its table, or of a frequency at the grid of its table")
    if hertz < 0.0:
        refuse(row.line, row.head, "a frequency ≥ 0 in Hz")
    return point, hertz
