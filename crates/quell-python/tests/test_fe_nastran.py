"""Punch files of Nastran as it writes them: matrices with others next to them, singular masses, complex modes, motions by frequency."""

from __future__ import annotations

import gzip
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import quell

Floats = npt.NDArray[np.float64]

DOFS = [(3, 1), (3, 5), (7, 1), (7, 2)]
NAMES = ["n3_x", "n3_ry", "n7_x", "n7_y"]
STIFFNESS = np.array([[5.0, 1.0, -2.0, 0.0], [1.0, 4.0, 0.5, 0.0], [-2.0, 0.5, 6.0, -1.0], [0.0, 0.0, -1.0, 3.0]])
MASS = np.diag([2.0, 0.5, 1.0, 1.5])


def pad(point: str = "n3_x") -> dict[str, Any]:
    """Everything of the studies that no file has."""
    contact = quell.Contact(tangent={point: 1}, normal_load=1, belt_velocity=1, friction=quell.Coulomb(0.3))
    return {"units": "none", "contact": contact}


def dmig(name: str, matrix: Floats, form: int = 6, kind: int = 2, columns: int | None = None) -> list[str]:
    """A symmetric or a rectangular matrix, as a punch file has it."""
    count = matrix.shape[1] if columns is None else columns
    lines = [f"DMIG    {name:<8}{0:>8}{form:>8}{kind:>8}{0:>8}{'':>16}{count:>8}"]
    for j in range(matrix.shape[1]):
        rows = [i for i in range(len(matrix)) if matrix[i, j] != 0.0 and (form != 6 or i >= j)]
        column = (j + 1, 0) if form == 9 else DOFS[j]
        if rows:
            lines.append(f"DMIG*   {name:<16}{column[0]:>16}{column[1]:>16}")
        for i in rows:
            value = f"{matrix[i, j]:.9E}".replace("E", "D")
            lines.append(f"*       {DOFS[i][0]:>16}{DOFS[i][1]:>16}{value:>16}")
    return lines


def write(path: Path, lines: list[str], end: str = "\n") -> Path:
    path.write_bytes((end.join(lines) + end).encode())
    return path


DTI = ["DTI     TUG1    0       954     4       32767   0       7       0", "        PHIP            7                       REAL           1ENDREC"]
WHOLE = [*dmig("KAAX", STIFFNESS), *dmig("MAAX", MASS)]
OTHERS = [*dmig("VAX", np.ones((4, 1)), 9), *dmig("RVA", np.eye(4)[:, :2], 9), *DTI, *dmig("MUG1T", np.ones((4, 3)), 9)]


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_matrices_are_read_and_others_noted(end: str, tmp_path: Path) -> None:
    damping = 0.1 * STIFFNESS
    file = write(tmp_path / "k.pch", [*WHOLE, *dmig("BAAX", damping), *OTHERS], end)
    found = quell.from_nastran(file, **pad())
    assert found.coordinates == NAMES
    assert np.allclose(found.stiffness, STIFFNESS) and np.allclose(found.mass, MASS) and np.allclose(found.damping, damping)
    (note,) = found.notes
    assert "VAX (a vector of diagonal terms, line" in note and "MUG1T (a transformation of results" in note and "3 columns" in note
    plain = quell.from_nastran(file, damping=None, **pad())
    assert plain.damping is None and "BAAX (viscous damping, line" in plain.notes[0]
    modal = quell.from_nastran(file, modes=4, **pad())
    omega = np.array([mode.given["frequency"] for mode in modal.mode])
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(MASS, STIFFNESS)).real)
    assert omega == pytest.approx(np.sqrt(squares), rel=1e-8)
    # C = 0.1 K has the ratios 0.05 ω.
    assert [mode.given["damping_ratio"] for mode in modal.mode] == pytest.approx(0.05 * omega, rel=1e-8)
    with pytest.raises(quell.StudyError, match="damping_ratio.*damping=None"):
        quell.from_nastran(file, modes=4, damping_ratio=0.01, **pad())


def test_structural_damping_is_half_its_loss_factor(tmp_path: Path) -> None:
    file = write(tmp_path / "k.pch", [*WHOLE, *dmig("K4AAX", 0.04 * STIFFNESS)])
    modal = quell.from_nastran(file, modes=3, **pad())
    assert [mode.given["damping_ratio"] for mode in modal.mode] == pytest.approx([0.02] * 3, rel=1e-8)
    with pytest.raises(quell.StudyError, match="structural_damping.*together with modes"):
        quell.from_nastran(file, **pad())
    assert quell.from_nastran(file, structural_damping=None, **pad()).damping is None


def test_an_offset_mass_is_reduced_to_finite_modes(tmp_path: Path) -> None:
    linalg = pytest.importorskip("scipy.linalg")
    # A mass of 2 at a distance of 0.3 along the rotation, and a coordinate without mass.
    mass = np.zeros((4, 4))
    mass[:2, :2] = 2.0 * np.outer([1.0, 0.3], [1.0, 0.3])
    mass[2, 2] = 1.0
    file = write(tmp_path / "k.pch", [*dmig("KAAX", STIFFNESS), *dmig("MAAX", mass)])
    with pytest.raises(quell.StudyError, match="modes: given: the mass matrix is singular. 2 directions have no mass, and 1 of them"):
        quell.from_nastran(file, **pad())
    modal = quell.from_nastran(file, modes=2, damping_ratio=0.0, **pad())
    assert modal.notes == (
        "2 directions have no mass, of which 1 are coordinates; they follow the others statically, and their infinite frequencies were dropped.",
    )
    values = linalg.eigvals(STIFFNESS, mass)
    finite = np.sort(values[np.abs(values) < 1e9].real)
    assert [mode.given["frequency"] for mode in modal.mode] == pytest.approx(np.sqrt(finite), rel=1e-9)
    # Shapes are those of unit modal mass, and follow statically where there is no mass.
    shapes = np.array([[mode.given["shape"][name] for name in NAMES] for mode in modal.mode])
    assert np.allclose(shapes @ mass @ shapes.T, np.eye(2), atol=1e-9)
    assert np.allclose(STIFFNESS @ shapes.T, mass @ shapes.T * finite, atol=1e-8)
    with pytest.raises(quell.StudyError, match="whole number from 1 to 2"):
        quell.from_nastran(file, modes=3, damping_ratio=0.0, **pad())
    negative = mass.copy()
    negative[0, 1] = negative[1, 0] = 0.9
    file = write(tmp_path / "n.pch", [*dmig("KAAX", STIFFNESS), *dmig("MAAX", negative)])
    with pytest.raises(quell.StudyError, match="mass: positive semidefinite; scaled to a unit diagonal, its least"):
        quell.from_nastran(file, modes=2, damping_ratio=0.0, **pad())


def test_rigid_motions_of_a_punch_file_are_noted(tmp_path: Path) -> None:
    free = np.diag([1.0, 3.0, 3.0, 1.0]) / 3.0
    free[[0, 1, 2], [1, 2, 3]] = free[[1, 2, 3], [0, 1, 2]] = -1.0 / 3.0
    free[[1, 2], [1, 2]] = 2.0 / 3.0
    file = write(tmp_path / "k.pch", [*dmig("KAAX", free), *dmig("MAAX", MASS)])
    found = quell.from_nastran(file, modes=4, damping_ratio=0.0, **pad())
    assert found.notes[-1].startswith("The lowest angular frequency, ")
    listed = found.modes().frequency
    assert listed.size == 4 and listed[0] < 1e-4 < listed[1]


def test_subcases_of_matrices(tmp_path: Path) -> None:
    softer = [*dmig("KAAX", 0.5 * STIFFNESS), *dmig("MAAX", MASS)]
    file = write(tmp_path / "k.pch", ["$SUBCASE ID =           1", *WHOLE, "$SUBCASE ID =           4", *softer])
    with pytest.raises(quell.StudyError, match="subcase.*1, 4"):
        quell.from_nastran(file, **pad())
    assert np.allclose(quell.from_nastran(file, subcase=4, **pad()).stiffness, 0.5 * STIFFNESS)
    with pytest.raises(quell.StudyError, match="subcase = 2.*1, 4"):
        quell.from_nastran(file, subcase=2, **pad())


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ([*dmig("KAAX", STIFFNESS, kind=4), *dmig("MAAX", MASS)], "line 1: KAAX is a complex matrix \\(type 4\\)"),
        ([*dmig("KAAX", STIFFNESS, 9), *dmig("MAAX", MASS)], "line 1: KAAX is rectangular \\(form 9\\)"),
        ([*WHOLE, *dmig("KAAX", STIFFNESS)], "KAAX begins again; line 1 has its first header"),
        ([*WHOLE[1:]], "the header of KAAX before its columns|matrix of the file: MAAX"),
        ([*dmig("KAAX", STIFFNESS, columns=9), *dmig("MAAX", MASS)], "line 1: the header of KAAX states 9 columns.*have 4.*cut off"),
        ([*dmig("KAAX", STIFFNESS, form=5), *dmig("MAAX", MASS)], "line 1.*the form 1 .square., 2 or 9"),
        ([*WHOLE[:3], WHOLE[2], *WHOLE[3:]], "line 4.*one entry at \\(n3_x, n3_x\\)"),
        ([*WHOLE[:2], WHOLE[2].replace("D+00", "nan"), *WHOLE[3:]], "line 3.*finite value"),
        (dmig("KAAX", STIFFNESS), "mass = MAAX.*a matrix of the file: KAAX"),
        (["$ nothing"], "no table of results and no DMIG"),
        (["1     N A S T R A N   F 0 6"], "a listing of Nastran"),
        (["SOL 103", "BEGIN BULK"], "an input file of Nastran"),
        (["$---- COLUMN NUMBERS ----", "$ FOR EXTERNAL SUPERELEMENT 111", "BEGIN SUPER 111"], "superelement of Nastran, which holds no matrices"),
    ],
)
def test_wrong_matrices_are_refused_by_name(lines: list[str], words: str, tmp_path: Path) -> None:
    with pytest.raises(quell.StudyError, match=words):
        quell.from_nastran(write(tmp_path / "k.pch", lines), **pad())


def head(kind: str, form: str, *keys: str) -> list[str]:
    return ["$TITLE   =", "$SUBTITLE=", "$LABEL   =", f"${kind}", f"${form} OUTPUT", "$SUBCASE ID =           1", *keys]


def row(first: str, kind: str, values: list[float]) -> list[str]:
    """The lines of a grid or a frequency."""
    cells = [f"{value:18.6E}" for value in values]
    begin = [f"{first:>10}{kind:>8}" if len(first) <= 10 else f"{first:>16} {kind}", *["-CONT-            "] * ((len(cells) - 1) // 3)]
    return [text + "".join(cells[3 * place : 3 * place + 3]) for place, text in enumerate(begin)]


def complex_modes(values: list[complex], shapes: list[list[complex]], form: str = "REAL-IMAGINARY") -> list[str]:
    """Complex eigenvectors of two grids."""
    lines = []
    for mode, (value, shape) in enumerate(zip(values, shapes, strict=True), 1):
        lines += head("EIGENVECTOR", form, f"$EIGENVALUE = ({value.real:15.7E},{value.imag:15.7E}) MODE = {mode:5d}")
        for place, grid in enumerate((3, 7)):
            own = np.array(shape[6 * place : 6 * place + 6])
            parts = (own.real, own.imag) if form == "REAL-IMAGINARY" else (np.abs(own), np.rad2deg(np.angle(own)))
            lines += row(str(grid), "G", [*parts[0].tolist(), *parts[1].tolist()])
    return [f"{line:<72}{number:8d}" for number, line in enumerate(lines, 1)]


SHAPE = [1.0, 0.5, -0.25, 0.1, 0.0, 0.2, -2.0, 0.125, 1.0, 0.0, 0.3, 0.0]


@pytest.mark.parametrize("form", ["REAL-IMAGINARY", "MAGNITUDE-PHASE"])
def test_complex_eigenvectors_become_real_ones(form: str, tmp_path: Path) -> None:
    turn = complex(np.exp(0.7j))
    skew = [value * (1.0 if place < 6 else 1j) for place, value in enumerate(SHAPE)]
    values = [0.0 + 3.0j, -0.5 + 10.0j, -1.0 + 20.0j]
    file = write(tmp_path / "m.pch", complex_modes(values, [[complex(x) for x in SHAPE], [turn * x for x in SHAPE], [complex(x) for x in skew]], form))
    found = quell.from_nastran(file, modal_mass=1, **pad())
    first, second = (mode.given for mode in found.mode)
    assert (first["frequency"], first["damping_ratio"]) == (3.0, 0.0)
    assert second["frequency"] == pytest.approx(abs(values[1])) and second["damping_ratio"] == pytest.approx(0.5 / abs(values[1]))
    names = [f"n{grid}_{way}" for grid in (3, 7) for way in ("x", "y", "z", "rx", "ry", "rz")]
    for mode in (first, second):
        assert [mode["shape"][name] for name in names] == pytest.approx(SHAPE, abs=3e-6)
    kept, left = found.notes
    assert "mode 2 (line" in kept and ": 1" in kept and "Left out" in left and "mode 3 (line" in left
    assert len(quell.from_nastran(file, modal_mass=1, collinearity=0.0, **pad()).mode) == 3
    with pytest.raises(quell.StudyError, match="collinearity = 2"):
        quell.from_nastran(file, modal_mass=1, collinearity=2, **pad())


def test_imaginary_parts_of_zero_are_real_modes(tmp_path: Path) -> None:
    file = write(tmp_path / "m.pch", complex_modes([0j, 5j], [[complex(x) for x in SHAPE], [complex(-x) for x in SHAPE]]))
    found = quell.from_nastran(file, modal_mass=1, **pad())
    assert [mode.given["frequency"] for mode in found.mode] == [0, 5] and found.notes == ()
    assert found.mode[0].given["shape"]["n7_x"] == -2.0 and found.mode[1].given["shape"]["n7_x"] == 2.0
    growing = write(tmp_path / "g.pch", complex_modes([1.0 + 5j], [[complex(x) for x in SHAPE]]))
    with pytest.raises(quell.StudyError, match="mode 1 .line 4. grows"):
        quell.from_nastran(growing, modal_mass=1, **pad())


def vectors(change: Callable[[list[str]], list[str]]) -> list[str]:
    """Two real eigenvectors of two grids, changed."""
    lines = []
    for mode in (1, 2):
        lines += head("EIGENVECTOR", "REAL", f"$EIGENVALUE ={4.0 * mode:15.7E}  MODE = {mode:5d}")
        lines += row("3", "G", SHAPE[:6]) + row("7", "G", SHAPE[6:])
    return change(lines)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda lines: lines[:-1], "line 21: 7 has 3 values; a real table has 6|no displacement"),
        (lambda lines: lines[:-2], "mode 2 has no displacement 1 of grid 7.*cut off"),
        (lambda lines: [*lines, *row("7", "G", SHAPE[:6])], "grid 7 again in one mode; line 21"),
        (lambda lines: [line.replace("MODE =     2", "MODE =     1") for line in lines], "line 15: mode 1 again; line 4"),
        (lambda lines: [line.replace("$EIGENVALUE =", "$X =") for line in lines], "line 4: an eigenvector without the line"),
        (lambda lines: [line.replace("-2.000000E+00", "-2.000000E+0x") for line in lines], "line 10.*finite numbers"),
        (lambda lines: [line.replace("       G", "       H") for line in lines], "line 8.*a grid .G. or a scalar point"),
    ],
)
def test_wrong_eigenvectors_are_refused_with_their_line(change: Callable[[list[str]], list[str]], words: str, tmp_path: Path) -> None:
    quell.from_nastran(write(tmp_path / "right.pch", vectors(lambda lines: lines)), damping_ratio=0.0, modal_mass=1, **pad())
    with pytest.raises(quell.StudyError, match=words):
        quell.from_nastran(write(tmp_path / "m.pch", vectors(change)), damping_ratio=0.0, modal_mass=1, **pad())


HERTZ = [0.0, 2.0, 5.0]


def motion(hertz: float, grid: int) -> list[complex]:
    """Six displacements of a grid under a unit force: those of an oscillator of 1 + 0.02 iω − ω²/900, times numbers of each."""
    s = 2j * np.pi * hertz
    return [complex((grid + place) / (1 + 0.02 * s + s**2 / 900)) for place in range(6)]


def by_frequency(sort: int, form: str, kind: str = "DISPLACEMENTS", power: int = 0) -> list[str]:
    lines = []
    cells = {}
    for hertz in HERTZ:
        for grid in (3, 7):
            own = np.array(motion(hertz, grid)) * (2j * np.pi * hertz) ** power
            parts = (own.real, own.imag) if form == "REAL-IMAGINARY" else (np.abs(own), np.rad2deg(np.angle(own)) % 360)
            cells[hertz, grid] = [*parts[0].tolist(), *parts[1].tolist()]
    if sort == 2:
        for grid in (3, 7):
            lines += head(kind, form, f"$POINT ID = {grid:11d}  IDENTIFIED BY FREQUENCY")
            for hertz in HERTZ:
                lines += row(f"{hertz:16.6E}", "G", cells[hertz, grid])
    else:
        for hertz in HERTZ:
            lines += head(kind, form, f"$FREQUENCY = {hertz:15.7E}")
            for grid in (3, 7):
                lines += row(str(grid), "G", cells[hertz, grid])
    return lines


@pytest.mark.parametrize("form", ["REAL-IMAGINARY", "MAGNITUDE-PHASE"])
@pytest.mark.parametrize("sort", [1, 2])
@pytest.mark.parametrize(("kind", "power"), [("DISPLACEMENTS", 0), ("ACCELERATION", 2)])
def test_motions_by_frequency_are_receptances(sort: int, form: str, kind: str, power: int, tmp_path: Path) -> None:
    file = write(tmp_path / "f.pch", by_frequency(sort, form, kind, power))
    how: dict[str, Any] = {**pad("x"), "units": "SI", "points": {"x": (3, "x"), "turn": (7, "rz")}, "save": tmp_path / "f.csv"}
    with pytest.raises(quell.StudyError, match=f"force: given: .*line 4 has {kind} by frequency"):
        quell.from_nastran(file, **how)
    static = {("x", "x"): 1.5, ("turn", "x"): 6.0} if power else None
    found = quell.from_nastran(file, force=(3, "x"), force_amplitude=2.0, static=static, **how)
    assert found.frequency_response == str(tmp_path / "f.csv")
    rows = np.genfromtxt(tmp_path / "f.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    for output, grid, place in (("x", 3, 0), ("turn", 7, 5)):
        own = rows[rows["output"] == output]
        assert own["frequency_hz"].tolist() == HERTZ
        wanted = np.array([motion(hertz, grid)[place] / 2.0 for hertz in HERTZ])
        # Seven digits are written, and degrees have as many.
        assert np.abs(own["re"] + 1j * own["im"] - wanted).max() < 1e-5 * np.abs(wanted).max()


def test_matrices_next_to_modes_are_noted(tmp_path: Path) -> None:
    file = write(tmp_path / "m.pch", [*vectors(lambda lines: lines), *WHOLE])
    found = quell.from_nastran(file, damping_ratio=0.0, modal_mass=1, **pad())
    assert found.notes == ("Matrices of the file were not read: KAAX (line 23), MAAX (line 36).",) and len(found.mode) == 2


def test_wrong_motions_are_refused(tmp_path: Path) -> None:
    how: dict[str, Any] = {**pad("x"), "points": {"x": (3, "x")}, "save": tmp_path / "f.csv", "force": (3, "x")}
    lines = by_frequency(2, "REAL-IMAGINARY")
    for wrong, words in [
        ([*lines, *lines[-4:]], "point 7 has 5 Hz again; line"),
        (lines[:-1], "has 9 values; a real-imaginary table has 12"),
        (by_frequency(2, "REAL"), "DISPLACEMENTS by frequency in real numbers"),
        ([line.replace("FREQUENCY", "TIME") for line in lines], "has results: DISPLACEMENTS over time"),
        ([line for line in lines if "POINT ID" not in line], "has static results: DISPLACEMENTS .line 4."),
    ]:
        with pytest.raises(quell.StudyError, match=words):
            quell.from_nastran(write(tmp_path / "f.pch", wrong), **how)
    file = write(tmp_path / "f.pch", lines)
    for change, words in [
        ({"force": {9: (3, "x")}}, "that of a subcase of the file, 1"),
        ({"force": (3,)}, "a grid and a direction"),
        ({"force_amplitude": 0.0}, "force_amplitude"),
        ({"subcase": 9}, "subcase = 9"),
        ({"modes": 3}, "modes: left out"),
        ({"points": {"x": (5, "x")}}, "a node and a direction of the file"),
    ]:
        with pytest.raises(quell.StudyError, match=words):
            quell.from_nastran(file, **{**how, **change})


def test_a_file_that_ends_within_a_number_is_refused(tmp_path: Path) -> None:
    file = write(tmp_path / "k.pch", WHOLE)
    content = file.read_bytes()
    for short in (1, 2, 5, 8):
        file.write_bytes(content[:-short])
        if short == 1:
            quell.from_nastran(file, **pad())
            continue
        with pytest.raises(quell.StudyError, match="line 22.*a line of 56 characters: the file is cut off"):
            quell.from_nastran(file, **pad())


def test_files_that_are_not_text_are_named(tmp_path: Path) -> None:
    (tmp_path / "m.op2").write_bytes(b"\x04\0\0\0\x03\0\0\0\x04\0\0\0NASTRAN FORT TAPE ID CODE - " + bytes(40))
    (tmp_path / "m.pch.gz").write_bytes(gzip.compress(b"$TITLE\n"))
    (tmp_path / "empty.pch").write_text(" \n")
    static = [*head("DISPLACEMENTS", "REAL"), *row("3", "G", SHAPE[:6]), *head("SPCF", "REAL"), *row("3", "G", SHAPE[:6])]
    write(tmp_path / "static.pch", static)
    for name, words in [
        ("m.op2", "an op2 file, the binary results of Nastran, which is not read; request a punch file"),
        ("m.pch.gz", "a file that gzip has compressed: unpack it first"),
        ("empty.pch", "empty"),
        ("static.pch", "has static results: DISPLACEMENTS .line 4., SPCF .line 12.; a structure needs eigenvectors"),
    ]:
        with pytest.raises(quell.StudyError, match=words):
            quell.from_nastran(tmp_path / name, **pad())
