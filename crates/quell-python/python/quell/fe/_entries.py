"""Entries of a matrix as a file lists them: row, column, value, and the line that each comes from."""

from __future__ import annotations

from array import array
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._errors import Complaint, StudyError
from ._lines import of_line
from ._points import Dof, name_of

__all__ = ["Entries", "Listed", "RESTRAINT"]

Floats = npt.NDArray[np.float64]
Whole = npt.NDArray[np.int64]

SYMMETRIC = 1e-9
"""Largest difference of entries that count as equal, relative to the larger one: more than rounding to ten digits."""

RESTRAINT = 1e36
"""Stiffness that Abaqus writes on the diagonal of a restrained degree of freedom."""

HUGE = 1e30
"""Size from which on no entry is a mass, a damping or a stiffness in any units. Only a restraint is larger."""


class Listed(NamedTuple):
    """Entries in ascending order of row and column, each once."""

    rows: Whole
    columns: Whole
    values: Floats


class Entries:
    """Entries of one matrix, in the order of the file."""

    def __init__(self, what: str, path: object, *, symmetric: bool, advice: str = "") -> None:
        """``symmetric``: the file may have a triangle; ``advice`` about what is not symmetric."""
        self.what, self.path, self.symmetric, self.advice = what, path, symmetric, advice
        self.dofs: dict[Dof, int] = {}
        self._rows, self._columns, self._lines = array("q"), array("q"), array("q")
        self._values = array("d")

    def add(self, row: Dof, column: Dof, value: float, line: int) -> None:
        """Adds an entry of a line."""
        self._rows.append(self.dofs.setdefault(row, len(self.dofs)))
        self._columns.append(self.dofs.setdefault(column, len(self.dofs)))
        self._values.append(value)
        self._lines.append(line)

    def __len__(self) -> int:
        return len(self._values)

    def listed(self, place: dict[Dof, int]) -> Listed:
        """The entries over all degrees of freedom, whose places are given.

        Raises
        ------
        quell.StudyError
            An entry out of range, one that is repeated, or two that should be equal and are not.
        """
        count = len(place)
        own: Whole = np.array([place[dof] for dof in self.dofs], dtype=np.int64)
        rows, columns = own[np.frombuffer(self._rows, dtype=np.int64)], own[np.frombuffer(self._columns, dtype=np.int64)]
        keys, first, where = np.unique(rows * count + columns, return_index=True, return_inverse=True)
        if keys.size < rows.size:
            seen: Whole = np.arange(rows.size, dtype=np.int64)
            again = int(np.flatnonzero(first[where] != seen)[0])
            raise StudyError([self._about(again, f"one entry at {self._names(again)}, which line {self._lines[int(first[where[again]])]} has")])
        values: Floats = np.bincount(where, weights=np.frombuffer(self._values), minlength=keys.size).astype(np.float64)
        found = Listed(keys // count, keys % count, values)
        self._check_sizes(found, first)
        return self._mirrored(found, first, count) if self.symmetric else found

    def _check_sizes(self, found: Listed, first: Whole) -> None:
        """Rejects entries that are no physical numbers; on the diagonal of the stiffness 1e36 restrains."""
        is_restraint = (found.rows == found.columns) & (found.values == RESTRAINT) & (self.what == "stiffness")
        wrong = np.flatnonzero((np.abs(found.values) >= HUGE) & ~is_restraint)
        if wrong.size:
            only = ", or 1e36 on the diagonal, which restrains a degree of freedom" if self.what == "stiffness" else ""
            raise StudyError([self._about(int(first[wrong[0]]), f"an entry below {HUGE:g}{only}")])

    def _mirrored(self, found: Listed, first: Whole, count: int) -> Listed:
        """The entries of a symmetric matrix of which a file has a triangle or all."""
        rows, columns, values = found
        keys, mirror = rows * count + columns, columns * count + rows
        at = np.minimum(np.searchsorted(keys, mirror), keys.size - 1)
        both = keys[at] == mirror
        mixed = ~both & (rows != columns) if (both & (rows != columns)).any() else np.zeros(both.shape, dtype=np.bool_)
        if mixed.any():
            wrong = int(first[np.flatnonzero(mixed)[-1]])
            allowed = f"listed with its mirror image, as others are: {self._names(wrong)} has none. Is the file cut off?{self.advice}"
            raise StudyError([self._about(wrong, allowed)])
        differ = both & (np.abs(values[at] - values) > SYMMETRIC * np.maximum(np.abs(values[at]), np.abs(values)))
        if differ.any():
            wrong = int(np.flatnonzero(differ)[0])
            allowed = f"equal to its mirror image {float(values[at][wrong])!r}, at {self._names(int(first[wrong]))}{self.advice}"
            raise StudyError([self._about(int(first[wrong]), allowed)])
        added = Listed(*(np.concatenate([one, other[~both]]) for one, other in zip(found, (columns, rows, values), strict=True)))
        order = np.argsort(added.rows * count + added.columns)
        return Listed(added.rows[order], added.columns[order], added.values[order])

    def _names(self, entry: int) -> str:
        """Row and column of an entry in words."""
        dofs = list(self.dofs)
        return f"({name_of(dofs[self._rows[entry]])}, {name_of(dofs[self._columns[entry]])})"

    def _about(self, entry: int, allowed: str) -> Complaint:
        return of_line(self.what, self.path, self._lines[entry], f"{self._values[entry]!r}", allowed)
