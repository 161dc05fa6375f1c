"""Eigenvectors of a punch file of Nastran as modes."""

from __future__ import annotations

import numpy as np

from .._errors import StudyError, complaint
from ._lines import Refusal, number_of, whole_of
from ._modal import FileMode
from ._points import Dof
from ._punch import Block
from ._shapes import ComplexMode, real_modes

__all__ = ["eigenvectors", "is_mode"]

RIGID = 1e-9
"""Eigenvalues below 0 down to this share of the largest of a file are rounding of rigid motions, whose frequency is 0."""


def is_mode(block: Block) -> bool:
    """Whether a table has displacements of a mode; those of the solution set are the same modes again."""
    return (block.kind.startswith("EIGENVECTOR") and "SOLUTION SET" not in block.kind) or (
        block.kind.startswith("DISPLACEMENT") and "EIGENVALUE" in block.keys
    )


def eigenvectors(blocks: list[Block], subcase: int | None, limit: float, refuse: Refusal) -> tuple[list[FileMode], list[str]]:
    """The modes of a punch file, of one subcase, and notes.

    Raises
    ------
    quell.StudyError
        A line that is wrong, or shapes that are not real.
    """
    cases = list(dict.fromkeys(block.case for block in blocks))
    if subcase is None and len(cases) > 1:
        raise StudyError([complaint("subcase", None, f"one of the subcases of the file, {', '.join(map(str, cases))}", "missing")])
    if subcase is not None and subcase not in cases:
        raise StudyError([complaint("subcase", subcase, f"a subcase of the file, {', '.join(map(str, cases))}")])
    own = [block for block in blocks if block.case == (cases[0] if subcase is None else subcase)]
    values = [eigenvalue_of(block, refuse) for block in own]
    check_numbers(own, refuse)
    shapes = [shape_of(block, refuse) for block in own]
    check_grids(own, shapes, refuse)
    if any(block.is_complex() for block in own):
        return of_complex(own, values, shapes, limit, refuse)
    largest = max(abs(value) for value in values)
    for block, value in zip(own, values, strict=True):
        if value.real < -RIGID * largest:
            refuse(block.keys["EIGENVALUE"][0], f"{value.real:g}", "an eigenvalue ω² ≥ 0: this motion grows without friction")
    found = zip(values, shapes, strict=True)
    real = ((value, {dof: one.real for dof, one in shape.items()}) for value, shape in found)
    return [FileMode(float(np.sqrt(max(value.real, 0.0))), None, None, shape) for value, shape in real], []


def eigenvalue_of(block: Block, refuse: Refusal) -> complex:
    """The eigenvalue of a table: ω², or λ of a complex mode."""
    if "EIGENVALUE" not in block.keys:
        refuse.met(block.line, "an eigenvector without the line $EIGENVALUE; request SORT1")
    line, text = block.keys["EIGENVALUE"]
    number = text.upper().split("MODE")[0]
    try:
        if block.is_complex():
            re, im = number.strip().strip("()").split(",")
            return complex(number_of(re), number_of(im))
        return complex(number_of(number))
    except ValueError:
        wanted = "a complex eigenvalue (re, im)" if block.is_complex() else "an eigenvalue ω²"
        refuse(line, text, f"{wanted} of finite numbers, and the number of a mode")


def mode_number(block: Block) -> str:
    """The number of a mode as the file has it; empty without one."""
    _, _, number = block.keys["EIGENVALUE"][1].upper().partition("MODE")
    return number.strip(" =")


def check_numbers(blocks: list[Block], refuse: Refusal) -> None:
    """Rejects a mode that a subcase has twice."""
    seen: dict[str, int] = {}
    for block in blocks:
        number = mode_number(block)
        if number and number in seen:
            refuse.met(block.line, f"mode {number} again; line {seen[number]} has it first")
        seen[number] = block.line


def shape_of(block: Block, refuse: Refusal) -> dict[Dof, complex]:
    """The displacements of a table."""
    shape: dict[Dof, complex] = {}
    lines: dict[int, int] = {}
    for row in block.rows:
        try:
            grid = whole_of(row.head)
        except ValueError:
            refuse(row.line, row.head, "the number of a grid")
        if grid in lines:
            refuse.met(row.line, f"grid {grid} again in one mode; line {lines[grid]} has it first")
        lines[grid] = row.line
        for direction, value in enumerate(block.components(row, refuse), 1):
            shape[grid, direction] = value
    if not shape:
        refuse.met(block.line, "an eigenvector without displacements. Is the file cut off?")
    return shape


def check_grids(blocks: list[Block], shapes: list[dict[Dof, complex]], refuse: Refusal) -> None:
    """Rejects a mode that lacks a displacement of another."""
    everywhere = dict.fromkeys(dof for shape in shapes for dof in shape)
    for block, shape in zip(blocks, shapes, strict=True):
        missing = next((dof for dof in everywhere if dof not in shape), None)
        if missing is not None:
            has = f"mode {mode_number(block)} has no displacement {missing[1]} of grid {missing[0]}, which other modes have"
            refuse.met(block.line, f"{has}. Is the file cut off?")


def of_complex(
    blocks: list[Block], values: list[complex], shapes: list[dict[Dof, complex]], limit: float, refuse: Refusal
) -> tuple[list[FileMode], list[str]]:
    """The modes of complex eigenvectors; conjugates of others are not modes of their own."""
    modes, left = [], 0
    for block, value, shape in zip(blocks, values, shapes, strict=True):
        if not block.is_complex():
            refuse.met(block.line, "a real eigenvector among complex ones of the same subcase")
        if value.imag < 0.0:
            left += 1
            continue
        modes.append(ComplexMode(value, 0j, shape, f"mode {mode_number(block)} (line {block.line})"))
    if not modes:
        refuse.met(blocks[0].line, "complex eigenvalues whose frequencies are all negative")
    found, notes = real_modes(modes, limit, has_mass=True)
    return found, notes + ([f"{left} modes of negative frequency, conjugates of others, were left out."] if left else [])
