"""Matrices that Abaqus writes with ``*MATRIX GENERATE`` and ``*MATRIX OUTPUT``."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

from .._system import System
from ._abaqus_text import matrix_of
from ._coordinate import Rows
from ._matrices import matrices_of_files, system_of_matrices
from ._modal import PerMode
from ._points import Points, Units, check_units

__all__ = ["from_abaqus"]


def from_abaqus(
    stiffness: str | os.PathLike[str],
    mass: str | os.PathLike[str],
    *,
    units: Units,
    damping: str | os.PathLike[str] | None = None,
    structural_damping: str | os.PathLike[str] | None = None,
    symmetric: bool = True,
    dofs: Sequence[tuple[int, int]] | None = None,
    nodes: Sequence[int] | None = None,
    directions: int | None = None,
    points: Points | None = None,
    modes: int | None = None,
    damping_ratio: PerMode = None,
    **study: Any,
) -> System:
    """A study of matrices that Abaqus has written as text (``JOB_STIF1.mtx``, ``JOB_MASS1.mtx``, ``JOB_DMPV1.mtx``).

    The three formats of ``*MATRIX OUTPUT`` are read: ``MATRIX INPUT`` and ``LABELS`` have lines of row node, row direction, column
    node, column direction and entry, with commas or spaces; ``COORDINATE`` has lines of row, column and entry. The text of a substructure (``*SUBSTRUCTURE MATRIX OUTPUT``) has all matrices in one
    file, which is given for each. Nodes that Abaqus adds have negative numbers and names such as ``internal1_x``.

    Degrees of freedom that boundary conditions restrain (1e36 on the diagonal) are left out, and directions without mass are
    eliminated statically, which is exact; ``modes`` is needed where these are not coordinates, as those of the consistent mass of
    beams. Matrices of more than 1000 degrees of freedom are sparse: they need ``modes``, ``points`` and SciPy. What was left out is in
    :attr:`quell.System.notes`.

    Parameters
    ----------
    stiffness, mass, damping, structural_damping :
        The files. Structural damping needs ``modes``: it becomes half its loss factor in each. The springs of contacts are not part of
        the stiffness: they belong to the contacts of the study.
    units :
        Units of the model: "SI", "mm-t-s" or, for numbers without units, "none".
    symmetric :
        Whether the matrices are symmetric; a triangle of them is enough then [default: True].
    dofs :
        Nodes and directions of the rows of the format ``COORDINATE``, such as ``[(1, 1), (1, 2)]``.
    directions, nodes :
        Instead of ``dofs``, the number of directions of every node, 3 or 6, whose rows are in order, and the nodes [default: 1, 2, 3, …].
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
    rows = Rows(dofs, nodes, directions)
    files = {"stiffness": stiffness, "mass": mass, "damping": damping, "structural_damping": structural_damping}
    read = matrices_of_files(files, lambda file, kind: matrix_of(file, kind, rows, symmetric))
    return system_of_matrices(read, units=units, points=points, modes=modes, damping_ratio=damping_ratio, notes=[], study=study)
