"""Punch files of Nastran: eigenvectors, matrices as DMIG entries, and motions by frequency.

An own reader of two documented text formats: the lines of a punch file have fixed columns, and DMIG has fields of 8 or 16
characters or between commas.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Mapping
from itertools import islice
from typing import Any

from .._errors import Complaint, StudyError, complaint
from .._system import System
from ._dmig import Header, headers_of, matrices
from ._entries import Entries
from ._frequency import MOTIONS, Forces, is_by_frequency, responses_of
from ._lines import Refusal, check_kind, is_cut_off, lines_of
from ._matrices import system_of_matrices
from ._modal import PerMode, system_of_modes
from ._notes import noted
from ._points import Points, Units, check_units
from ._punch import Block, blocks_of, summary
from ._response import written
from ._shapes import COLLINEAR, check_limit
from ._vectors import eigenvectors, is_mode

__all__ = ["from_nastran"]

OF_FILE = "file"
"""The damping that the file has."""

INSTEAD = "request a punch file: DISPLACEMENT(PUNCH) = ALL, or EXTSEOUT(DMIGPCH)"


def from_nastran(
    path: str | os.PathLike[str],
    *,
    units: Units,
    stiffness: str = "KAAX",
    mass: str = "MAAX",
    damping: str | None = OF_FILE,
    structural_damping: str | None = OF_FILE,
    subcase: int | None = None,
    points: Points | None = None,
    modes: int | None = None,
    damping_ratio: PerMode = None,
    modal_mass: PerMode = None,
    collinearity: float = COLLINEAR,
    force: Forces = None,
    force_amplitude: float = 1.0,
    save: str | os.PathLike[str] | None = None,
    static: Mapping[tuple[str, str], float] | None = None,
    **study: Any,
) -> System:
    """A study of a punch file of Nastran (``.pch``): eigenvectors, matrices, or motions by frequency.

    Eigenvectors are those that ``DISPLACEMENT(PUNCH) = ALL`` writes in SOL 103, or in SOL 107 if their shapes are nearly real. Matrices
    are DMIG entries, which ``EXTSEOUT(DMIGPCH)`` or ``PARAM,EXTOUT,DMIGPCH`` write. Directions without mass are eliminated statically,
    which is exact; ``modes`` is needed where they are not coordinates, as those of an offset mass. Motions by frequency of SOL 108 and
    111, in SORT1 or SORT2, are receptances over a force that is stated. Matrices of more than 1000 degrees of freedom are sparse: they
    need ``modes``, ``points`` and SciPy. What was left out of a file is in :attr:`quell.System.notes`.

    Parameters
    ----------
    path :
        The punch file.
    units :
        Units of the model: "SI", "mm-t-s" or, for numbers without units, "none".
    stiffness, mass :
        Names of the matrices [default: KAAX and MAAX].
    damping, structural_damping :
        Names of the matrices of viscous and of structural damping; ``None`` leaves them out [default: BAAX and K4AAX, if the file has
        them]. Structural damping needs ``modes``: it becomes half its loss factor in each.
    subcase :
        Subcase of the eigenvectors, the matrices or the motions, where there are several.
    points :
        Names of grids with a direction, such as ``{"pad_x": (1204, "x")}`` [default: every one, as ``n1204_x``].
    modes :
        Of matrices, the number of lowest modes to which they are reduced [default: the matrices as they are]; of eigenvectors, the
        number of lowest modes that are kept [default: all].
    damping_ratio :
        Damping ratio of the modes: one number or one for each. Eigenvectors of SOL 103 have no damping.
    modal_mass :
        Modal mass of the eigenvectors: 1 for mass-normalised ones (``NORM=MASS``, the default of EIGRL). A punch file does not say how
        its eigenvectors are normalised.
    collinearity :
        Least modal phase collinearity of complex eigenvectors; others are left out [default: 0.95].
    force, force_amplitude :
        Of motions by frequency, grid and direction of the force, of all subcases or in a dict by subcase, and its real amplitude
        [default: 1].
    save, static :
        Of motions by frequency, the CSV file for the receptances, and static ones where the file does not begin at 0 Hz: as of
        :func:`quell.from_universal_file`.
    study :
        Everything else of :class:`quell.System`: ``contact``, ``friction``, ``dither``, …

    Returns
    -------
    quell.System

    Raises
    ------
    quell.StudyError
        A line that is wrong, or everything that is wrong in the study.
    """
    check_units(units)
    given = {"stiffness": stiffness, "mass": mass, "damping": damping, "structural_damping": structural_damping}
    wrong = [
        complaint(key, name, "the name of a matrix")
        for key, name in given.items()
        if not isinstance(name, str) and not (name is None and key.endswith("damping"))
    ]
    if wrong:
        raise StudyError(wrong)
    limit = check_limit(collinearity)
    check_kind("path", path, INSTEAD)
    refuse = Refusal("path", path)
    blocks = blocks_of(lines_of("path", path), refuse, ("EIGENVECTOR", *MOTIONS))
    vectors = [block for block in blocks if is_mode(block)]
    motions = [block for block in blocks if is_by_frequency(block)]
    headers = headers_of(lines_of("path", path), refuse)
    others = [f"Matrices of the file were not read: {', '.join(header.words() for header in headers)}."] if headers else []
    if vectors:
        found, notes = eigenvectors(vectors, subcase, limit, refuse)
        if modes is not None:
            if not isinstance(modes, int) or isinstance(modes, bool) or not 1 <= modes <= len(found):
                raise StudyError([complaint("modes", modes, f"a whole number from 1 to {len(found)}")])
            found = sorted(found, key=lambda mode: mode.frequency)[:modes]
        system = system_of_modes(found, units=units, points=points, damping_ratio=damping_ratio, modal_mass=modal_mass, study=study)
        return noted(system, notes + others)
    if motions:
        check_left_out(modes=modes, damping_ratio=damping_ratio, modal_mass=modal_mass)
        responses, notes = responses_of(motions, force, force_amplitude, subcase, refuse)
        place = written(responses, points, units, save, static)
        return noted(System(frequency_response=place, units=units, **study), notes + others)
    if not headers:
        raise StudyError([nothing(blocks, path)])
    if modal_mass is not None:
        raise StudyError([complaint("modal_mass", None, "left out: the file has no eigenvectors", "conflict")])
    read, notes = read_matrices(headers, given, subcase, path, refuse)
    return system_of_matrices(
        read, units=units, points=points, modes=modes, damping_ratio=damping_ratio, notes=notes, study=study, has_ten_digits=True
    )


def check_left_out(**given: Any) -> None:
    """Rejects arguments that belong to modes."""
    wrong = [
        complaint(name, None, "left out: the study is of motions by frequency", "conflict") for name, value in given.items() if value is not None
    ]
    if wrong:
        raise StudyError(wrong)


def nothing(blocks: list[Block], path: str | os.PathLike[str]) -> Complaint:
    """The complaint about a file that has nothing to be read, by what it has."""
    wanted = "eigenvectors, motions by frequency or matrices (DMIG)"
    if not blocks:
        first = " ".join(line for _, line in islice(lines_of("path", path), 400)).upper()
        for words, what in OTHERS.items():
            if words in first:
                return complaint("path", str(path), f"{path} is {what}, which is not read; {INSTEAD}", "path")
        return complaint("path", str(path), f"{path} has no table of results and no DMIG: expected a punch file of Nastran with {wanted}", "path")
    is_static = not any({"EIGENVALUE", "FREQUENCY", "TIME", "POINT ID"} & block.keys.keys() for block in blocks)
    of = "static results" if is_static else "results"
    return complaint("path", str(path), f"{path} has {of}: {summary(blocks)}; a structure needs {wanted}", "path")


OTHERS = {
    "EXTERNAL SUPERELEMENT": "the bulk data of a superelement of Nastran, which holds no matrices",
    "N A S T R A N": "a listing of Nastran (f06)",
    "BEGIN BULK": "an input file of Nastran",
    "GRID,": "an input file of Nastran",
    "GRID  ": "an input file of Nastran",
}
"""Words of other text files of Nastran, and what they are."""

DEFAULTS = {"damping": "BAAX", "structural_damping": "K4AAX"}


def read_matrices(
    headers: list[Header], given: dict[str, str | None], subcase: int | None, path: str | os.PathLike[str], refuse: Refusal
) -> tuple[dict[str, Entries], list[str]]:
    """The matrices of a structure by what they are, and notes about what else the file has."""
    names = {key: (DEFAULTS[key] if name == OF_FILE and key in DEFAULTS else name).upper() for key, name in given.items() if name is not None}
    mine = [header for header in headers if header.name in names.values()]
    cases = list(dict.fromkeys(header.case for header in mine))
    if subcase is not None and subcase not in cases and cases != [0]:
        raise StudyError([complaint("subcase", subcase, f"a subcase of the file, {', '.join(map(str, cases)) or 'which has none'}")])
    if subcase is None and len(cases) > 1:
        raise StudyError([complaint("subcase", None, f"one of the subcases of the file, {', '.join(map(str, cases))}", "missing")])
    case = subcase if subcase in cases else (cases or [0])[0]
    there = {header.name for header in mine if header.case == case}
    missing = [
        complaint(key, name, f"the name of a matrix of the file: {', '.join(dict.fromkeys(header.name for header in headers))}")
        for key, name in names.items()
        if name not in there and given[key] != OF_FILE
    ]
    if missing:
        raise StudyError(missing)
    read = matrices(lines_of("path", path), refuse, {(case, name): key for key, name in names.items() if name in there})
    check_size(headers, names, case, read, refuse)
    check_end(path, refuse)
    others = [header.words() for header in headers if header.name not in names.values()]
    return read, [f"Not read, because they are no part of the structure: {', '.join(others)}."] if others else []


WIDE = 56
"""Characters of a line of DMIG in wide fields: a field of 8 and three of 16."""


def check_end(path: str | os.PathLike[str], refuse: Refusal) -> None:
    """Rejects a file that ends within a line of wide fields, whose last number has lost digits."""
    if is_cut_off(path):
        number, line = deque(lines_of("path", path), maxlen=1)[0]
        if "*" in line[:8] and len(line) < WIDE:
            refuse(number, line, f"a line of {WIDE} characters: the file is cut off")


def check_size(headers: list[Header], names: dict[str, str], case: int, read: dict[str, Entries], refuse: Refusal) -> None:
    """Rejects matrices that are smaller than their headers say: a file that is cut off would be another structure."""
    dofs = {dof for entries in read.values() for dof in entries.dofs}
    for header in headers:
        if header.name == names["stiffness"] and header.case == case and header.columns is not None and len(dofs) != header.columns:
            what = f"the header of {header.name} states {header.columns} columns, and the matrices of the file have {len(dofs)} degrees of freedom"
            refuse.met(header.line, f"{what}. Is the file cut off? If the others have neither stiffness nor mass, correct the number")
