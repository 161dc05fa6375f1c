"""Matrices that ANSYS exports with ``*EXPORT`` in Matrix Market form."""

from __future__ import annotations

import os
from typing import Any

from .._errors import StudyError, complaint
from .._system import System
from ._coordinate import Rows
from ._market import market_matrix, market_vector
from ._matrices import matrices_of_files, system_of_matrices
from ._modal import PerMode
from ._points import Points, Units, check_units

__all__ = ["from_ansys"]


def from_ansys(
    stiffness: str | os.PathLike[str],
    mass: str | os.PathLike[str],
    mapping: str | os.PathLike[str] | None = None,
    *,
    units: Units,
    directions: int | None = None,
    dofs: list[tuple[int, int]] | None = None,
    damping: str | os.PathLike[str] | None = None,
    structural_damping: str | os.PathLike[str] | None = None,
    points: Points | None = None,
    modes: int | None = None,
    damping_ratio: PerMode = None,
    **study: Any,
) -> System:
    """A study of matrices in Matrix Market form, as ANSYS writes them with ``*EXPORT, NAME, MMF, FILE``.

    The rows have no nodes of their own. ANSYS exports the node of every block of rows as a vector, the mapping of ``*SMAT`` (its
    nodal form); ``directions`` says how many rows each has. Directions without mass are eliminated statically, as in
    :func:`quell.from_abaqus`, and what was left out is in :attr:`quell.System.notes`. Files of other programs in this form are
    read too.

    Parameters
    ----------
    stiffness, mass, damping, structural_damping :
        The files. Structural damping needs ``modes``. The springs of contacts are not part of the stiffness.
    mapping :
        File of the mapping vector: the node of every block of rows, in Matrix Market form or one a line [default: nodes 1, 2, 3, …].
    units :
        Units of the model: "SI", "mm-t-s" or, for numbers without units, "none".
    directions :
        Number of rows of each node: 3 for x, y and z, 6 with rotations. With a mapping it is the number of rows over that of nodes
        [default], which must be a whole number.
    dofs :
        Nodes and directions of all rows instead, such as ``[(1, 1), (1, 2)]``.
    points, modes, damping_ratio, study :
        As of :func:`quell.from_abaqus`.

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
    >>> head = "%%MatrixMarket matrix coordinate real symmetric\\n"
    >>> _ = (folder / "K.txt").write_text(head + "2 2 3\\n1 1 2.0\\n2 1 1.0\\n2 2 0.6666666666666667\\n")
    >>> _ = (folder / "M.txt").write_text(head + "2 2 2\\n1 1 1.0\\n2 2 1.0\\n")
    >>> _ = (folder / "map.txt").write_text("1204\\n")
    >>> pad = quell.Contact("pad", tangent={"n1204_x": 1}, normal={"n1204_y": 1}, normal_load=1, normal_stiffness=4 / 3, belt_velocity=1)
    >>> how = {"units": "none", "contact": pad, "friction": quell.Coulomb(0.9)}
    >>> quell.from_ansys(folder / "K.txt", folder / "M.txt", folder / "map.txt", **how).stability().verdict
    'unstable'
    """
    check_units(units)
    if mapping is not None and dofs is not None:
        raise StudyError([complaint("mapping", None, "left out: dofs has the nodes and directions of all rows", "conflict")])
    nodes = None if mapping is None else market_vector("mapping", mapping)
    rows = Rows(dofs, nodes, directions, per_node=True)
    files = {"stiffness": stiffness, "mass": mass, "damping": damping, "structural_damping": structural_damping}
    read = matrices_of_files(files, lambda file, kind: market_matrix(file, kind, rows, False))
    return system_of_matrices(read, units=units, points=points, modes=modes, damping_ratio=damping_ratio, notes=[], study=study)
