"""Structures of finite-element programs and modal tests as studies: universal files, Nastran, Abaqus, ANSYS.

Each function reads a file and returns a :class:`quell.System` whose coordinates or points are nodes with a direction, such as
``n1204_x``, or the names that ``points`` gives them. Rows of contacts and dithers use these names. Units are always stated: no file
but a universal one says them reliably.
"""

from __future__ import annotations

from ._abaqus import from_abaqus
from ._ansys import from_ansys
from ._nastran import from_nastran
from ._universal import from_universal_file

__all__ = ["from_abaqus", "from_ansys", "from_nastran", "from_universal_file"]
