"""Punch files of Nastran: eigenvectors, and matrices as DMIG entries.

An own reader of two documented text formats: the lines of a punch file have fixed columns, and DMIG has fields of 8 or 16
characters or between commas.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple, NoReturn

import numpy as np

from .._errors import Complaint, StudyError, complaint
from .._system import System
from ._entries import Entries
from ._lines import lines_of, number_of, of_line, whole_of
from ._matrices import system_of_matrices
from ._modal import FileMode, PerMode, system_of_modes
from ._points import Dof, Points, Units, check_units

__all__ = ["from_nastran"]


def from_nastran(
    path: str | os.PathLike[str],
    *,
    units: Units,
    stiffness: str = "KAAX",
    mass: str = "MAAX",
    damping: str | None = None,
    subcase: int | None = None,
    points: Points | None = None,
    modes: int | None = None,
    damping_ratio: PerMode = None,
    modal_mass: PerMode = None,
    **study: Any,
) -> System:
    """A study of a punch file of Nastran (``.pch``): eigenvectors, or matrices.

    Eigenvectors are those that ``DISPLACEMENT(PUNCH) = ALL`` writes in SOL 103. Matrices are DMIG entries, which
    ``EXTSEOUT(DMIGPCH)`` or ``PARAM,EXTOUT,DMIGPCH`` write. Degrees of freedom without mass are eliminated statically, which is exact.
    Matrices of more than 1000 degrees of freedom are sparse: they need ``modes``, ``points`` and SciPy.

    Parameters
    ----------
    path :
        The punch file.
    units :
        Units of the model: "SI", "mm-t-s" or, for numbers without units, "none".
    stiffness, mass, damping :
        Names of the matrices [default: KAAX, MAAX and no damping].
    subcase :
        Subcase of the eigenvectors, where there are several.
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
    wrong = [complaint(key, it, "the name of a matrix") for key, it in (("stiffness", stiffness), ("mass", mass)) if not isinstance(it, str)]
    if damping is not None and not isinstance(damping, str):
        wrong.append(complaint("damping", damping, "the name of a matrix"))
    if wrong:
        raise StudyError(wrong)
    if any(line.startswith("$EIGENV") for _, line in lines_of("path", path)):
        found = eigenvectors(lines_of("path", path), subcase, Refusal(path))
        if modes is not None:
            if not isinstance(modes, int) or isinstance(modes, bool) or not 1 <= modes <= len(found):
                raise StudyError([complaint("modes", modes, f"a whole number from 1 to {len(found)}")])
            found = sorted(found, key=lambda mode: mode.frequency)[:modes]
        return system_of_modes(found, units=units, points=points, damping_ratio=damping_ratio, modal_mass=modal_mass, study=study)
    if modal_mass is not None:
        raise StudyError([complaint("modal_mass", None, "left out: the file has no eigenvectors", "conflict")])
    names = {"stiffness": stiffness, "mass": mass} | ({} if damping is None else {"damping": damping})
    read = matrices(lines_of("path", path), path, {name.upper(): key for key, name in names.items()})
    missing = [absent(key, name, list(read)) for key, name in names.items() if name.upper() not in read]
    if missing:
        raise StudyError(missing)
    chosen = {key: read[name.upper()] for key, name in names.items()}
    return system_of_matrices(
        chosen["mass"],
        chosen.get("damping"),
        chosen["stiffness"],
        units=units,
        points=points,
        modes=modes,
        damping_ratio=damping_ratio,
        study=study,
    )


def absent(key: str, name: str, read: list[str]) -> Complaint:
    """The complaint about a matrix that the file does not have."""
    there = f"the name of a matrix of the file: {', '.join(read)}" if read else "in the file, which has no eigenvectors and no DMIG"
    return complaint(key, name, there)


RIGID = 1e-9
"""Eigenvalues below 0 down to this share of the largest of a file are rounding of rigid motions, whose frequency is 0."""


class Refusal:
    """Complains about lines of a file."""

    def __init__(self, path: object) -> None:
        self.path = path

    def __call__(self, number: int, line: str, allowed: str) -> NoReturn:
        raise StudyError([of_line("path", self.path, number, line, allowed)])


class Vector(NamedTuple):
    """An eigenvector of a file."""

    eigenvalue: float
    line: int
    shape: dict[Dof, float]


def eigenvectors(lines: Iterable[tuple[int, str]], subcase: int | None, refuse: Refusal) -> list[FileMode]:
    """The modes of a punch file, of one subcase."""
    found: dict[int, list[Vector]] = {}
    case, shape, is_vector, grid = 0, dict[Dof, float](), False, 0
    for number, line in lines:
        # Columns 73 to 80 count the lines.
        line = line[:72].rstrip()
        if line.startswith("$"):
            key, _, value = line[1:].partition("=")
            key = key.strip()
            if key.startswith("EIGENVECTOR"):
                is_vector = True
            elif key in ("TITLE", "SUBTITLE", "LABEL"):
                # A new block: what follows is another kind of output unless it says otherwise.
                is_vector, shape = False, {}
            elif key == "SUBCASE ID":
                try:
                    case = whole_of(value)
                except ValueError:
                    refuse(number, line, "the number of a subcase")
            elif "IMAGINARY" in key and is_vector or "MAGNITUDE" in key and is_vector:
                refuse(number, line, "real eigenvectors, of SOL 103")
            elif key == "EIGENVALUE" and is_vector:
                words = value.replace("MODE =", " ").replace("MODE=", " ").split()
                try:
                    eigenvalue = number_of(words[0])
                except (ValueError, IndexError):
                    refuse(number, line, "an eigenvalue ω² and the number of a mode")
                shape = {}
                found.setdefault(case, []).append(Vector(eigenvalue, number, shape))
        elif is_vector and line.strip():
            grid = vector_line(number, line, grid, shape, refuse)
    if not found:
        raise StudyError([complaint("path", str(refuse.path), "eigenvectors: $EIGENVECTOR and $EIGENVALUE", "path")])
    if subcase is None and len(found) > 1:
        allowed = f"one of the subcases of the file, {', '.join(map(str, found))}"
        raise StudyError([complaint("subcase", None, allowed, "missing")])
    if subcase is not None and subcase not in found:
        raise StudyError([complaint("subcase", subcase, f"a subcase of the file, {', '.join(map(str, found))}")])
    vectors = next(iter(found.values())) if subcase is None else found[subcase]
    largest = max(abs(one.eigenvalue) for one in vectors)
    for one in vectors:
        if one.eigenvalue < -RIGID * largest:
            refuse(one.line, f"{one.eigenvalue:g}", "an eigenvalue ω² ≥ 0: this motion grows without friction")
    return [FileMode(float(np.sqrt(max(one.eigenvalue, 0.0))), None, None, one.shape) for one in vectors]


def vector_line(number: int, line: str, grid: int, shape: dict[Dof, float], refuse: Refusal) -> int:
    """Adds the displacements of a line to a shape, and returns its grid."""
    try:
        values = [number_of(line[at : at + 18]) for at in (18, 36, 54) if line[at : at + 18].strip()]
        if line.startswith("-CONT-"):
            first = 4
        else:
            grid, kind, first = whole_of(line[:10]), line[10:18].strip(), 1
            if kind not in ("G", "S"):
                refuse(number, line, "a grid (G) or a scalar point (S)")
            if kind == "S":
                values = values[:1]
    except ValueError:
        refuse(number, line, "a grid, its kind and three finite displacements in columns of 18 characters")
    for place, value in enumerate(values):
        shape[grid, first + place] = value
    return grid


def matrices(lines: Iterable[tuple[int, str]], path: object, wanted: dict[str, str]) -> dict[str, Entries]:
    """The matrices of DMIG entries, by name; ``wanted`` says what each is."""
    refuse = Refusal(path)
    found: dict[str, Entries] = {}
    for number, line, fields in entries(lines):
        name = fields[1].upper()
        try:
            if name not in found:
                if fields[2].strip() != "0" or len(fields) < 5:
                    refuse(number, line, f"the header of {name} before its columns")
                form, kind = whole_of(fields[3]), whole_of(fields[4])
                if form not in (1, 6):
                    refuse(number, line, "a square matrix (form 1) or a symmetric one (form 6)")
                if kind not in (1, 2):
                    refuse(number, line, "a real matrix (type 1 or 2)")
                found[name] = Entries(wanted.get(name, name), path, symmetric=form == 6, repeated=False)
                continue
            column = dof_of(fields[2], fields[3])
            for at in range(5, len(fields), 4):
                if any(field.strip() for field in fields[at : at + 3]):
                    row = dof_of(fields[at], fields[at + 1])
                    found[name].add(row, column, number_of(fields[at + 2]), number)
        except (ValueError, IndexError):
            refuse(number, line, "a column of DMIG: grid and component, and rows with grid, component and a finite value")
    return found


def dof_of(grid: str, component: str) -> Dof:
    """A degree of freedom; a scalar point has component 0, which is its displacement."""
    return (whole_of(grid), max(whole_of(component or "0"), 1))


def entries(lines: Iterable[tuple[int, str]]) -> Iterator[tuple[int, str, list[str]]]:
    """The DMIG entries of a file with their continuations: line, text, fields. Field 4 is empty, so that rows begin at field 5."""
    current: tuple[int, str, list[str]] | None = None
    for number, line in lines:
        plain = line.split("$", 1)[0].rstrip()
        if not plain:
            continue
        head = plain[:8].rstrip().upper().split(",")[0]
        if head.rstrip("*").rstrip() == "DMIG":
            if current:
                yield current
            current = (number, plain, padded(plain))
        elif head in ("", "*") or head.startswith(("*", "+")):
            if current:
                current[2].extend(padded(plain)[1:])
        elif current:
            yield current
            current = None
    if current:
        yield current


def padded(line: str) -> list[str]:
    """The fields of a line, four after the first in the wide format and eight in the others, without the last, which continues."""
    if "," in line:
        fields = [field.strip() for field in line.split(",")][:9]
        count = 9
    elif "*" in line[:8]:
        fields = [line[:8], *(line[at : at + 16] for at in range(8, 72, 16))]
        count = 5
    else:
        fields = [line[at : at + 8] for at in range(0, 72, 8)]
        count = 9
    fields = [field.strip() for field in fields]
    return fields + [""] * (count - len(fields))
