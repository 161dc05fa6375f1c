"""Matrices that Abaqus writes with ``*MATRIX GENERATE`` and ``*MATRIX OUTPUT``."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from .._errors import StudyError, complaint
from .._system import System
from ._matrices import Entries, symmetric_of, system_of_matrices
from ._modal import PerMode
from ._points import Dof, Points, Units, check_units

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
    left out, and those without mass are eliminated statically, which is exact.

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
    files = {"stiffness": stiffness, "mass": mass} | ({} if damping is None else {"damping": damping})
    read = {name: symmetric_of(entries(file, name, dofs), symmetric, name) for name, file in files.items()}
    return system_of_matrices(
        read["mass"],
        read.get("damping", {}),
        read["stiffness"],
        units=units,
        points=points,
        modes=modes,
        damping_ratio=damping_ratio,
        study=study,
    )


def entries(file: str | os.PathLike[str], name: str, dofs: list[Dof] | None) -> Entries:
    """The entries of a file, by node and direction."""
    found: Entries = {}
    for number, line in enumerate(Path(file).read_text(encoding="utf-8", errors="replace").splitlines(), 1):
        words = line.replace(",", " ").split()
        # Comments begin with **; a keyword line, with *, comes before the entries.
        if not words or words[0].startswith("*"):
            continue
        try:
            *labels, last = words
            places = [int(word) for word in labels]
            value = float(last.replace("D", "E").replace("d", "e"))
        except ValueError:
            raise StudyError([wrong(name, file, number, line)]) from None
        if len(places) == 4:
            pair = ((places[0], places[1]), (places[2], places[3]))
        elif len(places) == 2:
            pair = (of_row(name, file, number, places[0], dofs), of_row(name, file, number, places[1], dofs))
        else:
            raise StudyError([wrong(name, file, number, line)])
        found[pair] = found.get(pair, 0.0) + value
    if not found:
        raise StudyError([complaint(name, str(file), "a matrix of Abaqus with at least one entry", "path")])
    return found


def of_row(name: str, file: Any, number: int, row: int, dofs: list[Dof] | None) -> Dof:
    """The degree of freedom of a row of the format COORDINATE."""
    if dofs is None:
        allowed = f"given: line {number} of {os.fspath(file)} has rows without nodes (FORMAT=COORDINATE)"
        raise StudyError([complaint("dofs", None, allowed, "missing")])
    if not 1 <= row <= len(dofs):
        allowed = f"the nodes and directions of all rows: line {number} of {os.fspath(file)} has row {row}, dofs has {len(dofs)}"
        raise StudyError([complaint("dofs", len(dofs), allowed)])
    node, direction = dofs[row - 1]
    return (int(node), int(direction))


def wrong(name: str, file: Any, number: int, line: str) -> Any:
    """The complaint about a line."""
    allowed = "row node, direction, column node, direction and entry, or row, column and entry"
    return complaint(name, f"{os.fspath(file)}, line {number}: {line[:40]!r}", allowed)
