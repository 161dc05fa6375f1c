"""Matrices that Abaqus writes with ``*MATRIX GENERATE`` and ``*MATRIX OUTPUT``."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import Any

from .._errors import StudyError, complaint
from .._system import System
from ._entries import Entries
from ._lines import lines_of, number_of, of_line, whole_of
from ._matrices import system_of_matrices
from ._modal import PerMode
from ._points import Dof, Points, Units, check_units, dof_of

__all__ = ["from_abaqus"]


def from_abaqus(
    stiffness: str | os.PathLike[str],
    mass: str | os.PathLike[str],
    *,
    units: Units,
    damping: str | os.PathLike[str] | None = None,
    symmetric: bool = True,
    dofs: list[tuple[int, int]] | None = None,
    points: Points | None = None,
    modes: int | None = None,
    damping_ratio: PerMode = None,
    **study: Any,
) -> System:
    """A study of matrices that Abaqus has written as text (``JOB_STIF1.mtx``, ``JOB_MASS1.mtx``, ``JOB_DMPV1.mtx``).

    The three formats of ``*MATRIX OUTPUT`` are read: ``MATRIX INPUT`` and ``LABELS`` have lines of row node, row direction, column
    node, column direction and entry, with commas or spaces; ``COORDINATE`` has lines of row, column and entry. Entries that a file
    repeats are added, as Abaqus does on input. Degrees of freedom that boundary conditions restrain (1e36 on the diagonal) are
    left out, and those without mass are eliminated statically, which is exact. Matrices of more than 1000 degrees of freedom are sparse:
    they need ``modes``, ``points`` and SciPy.

    Parameters
    ----------
    stiffness, mass, damping :
        The files. The springs of contacts are not part of the stiffness: they belong to the contacts of the study.
    units :
        Units of the model: "SI", "mm-t-s" or, for numbers without units, "none".
    symmetric :
        Whether the matrices are symmetric; a triangle of them is enough then [default: True].
    dofs :
        Nodes and directions of the rows of the format ``COORDINATE``, such as ``[(1, 1), (1, 2)]``.
    points :
        Names of nodes with a direction, such as ``{"pad_x": (1204, "x")}`` [default: every one, as ``n1204_x``].
    modes :
        Number of lowest modes to which the matrices are reduced; only the points are in their shapes [default: the matrices
        as they are]. Modes that are left out no longer give way statically: compare with more modes.
    damping_ratio :
        Damping ratio of the modes: one number or one for each, for ``modes`` without a damping matrix.
    study :
        Everything else of :class:`quell.System`: ``contact``, ``friction``, ``dither``, …

    Returns
    -------
    quell.System

    Raises
    ------
    quell.StudyError
        A line that is wrong, or everything that is wrong in the study.

    Examples
    --------
    >>> import quell
    >>> import pathlib, tempfile
    >>> folder = pathlib.Path(tempfile.mkdtemp())
    >>> _ = (folder / "brake_STIF1.mtx").write_text("1,1, 1,1, 2.0\\n1,2, 1,1, 1.0\\n1,2, 1,2, 0.6666666666666667\\n")
    >>> _ = (folder / "brake_MASS1.mtx").write_text("1,1, 1,1, 1.0\\n1,2, 1,2, 1.0\\n")
    >>> pad = quell.Contact("pad", tangent={"x": 1}, normal={"y": 1}, normal_load=1, normal_stiffness=4 / 3, belt_velocity=1)
    >>> system = quell.from_abaqus(
    ...     folder / "brake_STIF1.mtx",
    ...     folder / "brake_MASS1.mtx",
    ...     units="none",
    ...     points={"x": (1, "x"), "y": (1, "y")},
    ...     contact=pad,
    ...     friction=quell.Coulomb(0.9),
    ... )
    >>> system.stability().verdict
    'unstable'
    """
    check_units(units)
    rows = None if dofs is None else rows_of(dofs)
    files = {"stiffness": stiffness, "mass": mass} | ({} if damping is None else {"damping": damping})
    read = {name: entries(file, name, rows, symmetric) for name, file in files.items()}
    return system_of_matrices(
        read["mass"],
        read.get("damping"),
        read["stiffness"],
        units=units,
        points=points,
        modes=modes,
        damping_ratio=damping_ratio,
        study=study,
    )


ADVICE = "; give symmetric=False for a matrix that is not symmetric"


def rows_of(dofs: object) -> list[Dof]:
    """Nodes and directions of the rows of the format COORDINATE."""
    allowed = "nodes and directions of all rows, such as [(1, 1), (1, 2)]"
    if not isinstance(dofs, Iterable):
        raise StudyError([complaint("dofs", dofs, allowed)])
    found = [(given, dof_of(given)) for given in dofs]
    wrong = [complaint(f"dofs[{place}]", given, "a node and a direction") for place, (given, dof) in enumerate(found) if dof is None]
    if wrong:
        raise StudyError(wrong)
    return [dof for _, dof in found if dof is not None]


def entries(file: str | os.PathLike[str], name: str, dofs: list[Dof] | None, symmetric: bool) -> Entries:
    """The entries of a file, by node and direction."""
    found = Entries(name, file, symmetric=symmetric, repeated=True, advice=ADVICE)
    for number, line in lines_of(name, file):
        words = line.replace(",", " ").split()
        # Comments begin with **; a keyword line, with *, comes before the entries.
        if not words or words[0].startswith("*"):
            continue
        try:
            *labels, last = words
            places = [whole_of(word) for word in labels]
            value = number_of(last)
        except ValueError:
            places, value = [], 0.0
        if len(places) == 4:
            found.add((places[0], places[1]), (places[2], places[3]), value, number)
        elif len(places) == 2:
            row, column = (of_row(name, file, number, place, dofs) for place in places)
            found.add(row, column, value, number)
        else:
            allowed = "row node, direction, column node, direction and a finite entry, or row, column and entry"
            raise StudyError([of_line(name, file, number, line, allowed)])
    if not len(found):
        raise StudyError([complaint(name, str(file), "a matrix of Abaqus with at least one entry", "path")])
    return found


def of_row(name: str, file: object, number: int, row: int, dofs: list[Dof] | None) -> Dof:
    """The degree of freedom of a row of the format COORDINATE."""
    if dofs is None:
        allowed = f"given: line {number} of {file} has rows without nodes (FORMAT=COORDINATE)"
        raise StudyError([complaint("dofs", None, allowed, "missing")])
    if not 1 <= row <= len(dofs):
        raise StudyError([of_line(name, file, number, str(row), f"one of the {len(dofs)} rows of dofs")])
    return dofs[row - 1]
