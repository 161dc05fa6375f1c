"""Matrices of Abaqus and of ANSYS as these programs write them: internal nodes, rows without nodes, substructures, Matrix Market."""

from __future__ import annotations

import doctest
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import quell
from quell.fe import _ansys

Floats = npt.NDArray[np.float64]

STIFFNESS = np.array(
    [
        [4.0, 0.0, 0.5, -1.0, 0.0, 0.0],
        [0.0, 3.0, 0.0, 0.0, -1.0, 0.0],
        [0.5, 0.0, 2.0, 0.0, 0.0, -0.5],
        [-1.0, 0.0, 0.0, 5.0, 0.0, 0.0],
        [0.0, -1.0, 0.0, 0.0, 6.0, 0.25],
        [0.0, 0.0, -0.5, 0.0, 0.25, 7.0],
    ]
)
MASS = np.diag([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])


def pad(point: str = "n1_x") -> dict[str, Any]:
    """Everything of the studies that no file has."""
    contact = quell.Contact(tangent={point: 1}, normal_load=1, belt_velocity=1, friction=quell.Coulomb(0.3))
    return {"units": "none", "contact": contact}


def frequencies(system: quell.System) -> list[float]:
    return [mode.given["frequency"] for mode in system.mode]


OMEGA = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(MASS, STIFFNESS)).real))


def coordinate(path: Path, matrix: Floats, both: bool = True) -> Path:
    """The format COORDINATE, both triangles."""
    lines = []
    for i in range(len(matrix)):
        for j in range(i + 1):
            if matrix[i, j] != 0.0:
                lines.append(f"{i + 1} {j + 1}  {matrix[i, j]:.15e}")
                if i != j and both:
                    lines.append(f"{j + 1} {i + 1}  {matrix[i, j]:.15e}")
    path.write_text("\n".join(lines) + "\n")
    return path


def test_rows_without_nodes_are_named_only_when_stated(tmp_path: Path) -> None:
    files = coordinate(tmp_path / "a_STIF1.mtx", STIFFNESS), coordinate(tmp_path / "a_MASS1.mtx", MASS)
    with pytest.raises(quell.StudyError, match="6 rows without nodes.*directions=3 those of 2 nodes in order and directions=6 those of 1"):
        quell.from_abaqus(*files, **pad())
    found = quell.from_abaqus(*files, directions=3, **pad())
    assert found.coordinates == ["n1_x", "n1_y", "n1_z", "n2_x", "n2_y", "n2_z"]
    assert np.array_equal(found.stiffness, STIFFNESS)
    other = quell.from_abaqus(*files, directions=3, nodes=[9, 4], **pad("n9_x"))
    # In ascending order of nodes.
    assert other.coordinates == ["n4_x", "n4_y", "n4_z", "n9_x", "n9_y", "n9_z"] and other.stiffness[3][3] == 4.0
    for arguments, words in [
        ({"directions": 4}, "directions = 4: must be a divisor of the 6 rows"),
        ({"directions": 7}, "from 1 to 6"),
        ({"nodes": [9, 4]}, "directions: given"),
        ({"nodes": [9, 4, 3], "directions": 3}, "nodes = 3 nodes"),
        ({"nodes": [9, 9], "directions": 3}, "each node once"),
        ({"dofs": [(1, 1)] * 6}, "each node and direction once"),
        ({"dofs": [(1, 1)]}, "dofs = 1 rows: must be the 6 rows"),
        ({"dofs": [(1, 1)], "directions": 1}, "directions: left out"),
    ]:
        with pytest.raises(quell.StudyError, match=words):
            quell.from_abaqus(*files, **arguments, **pad())  # type: ignore[arg-type]


def labelled(path: Path, entries: dict[tuple[int, int, int, int], float], end: str = "\n") -> Path:
    """The format MATRIX INPUT."""
    lines = [f"{a},{b}, {c},{d}, {value: .15e}" for (a, b, c, d), value in entries.items()]
    path.write_bytes((end.join(lines) + end).encode())
    return path


def beam(end: str, folder: Path) -> tuple[Path, Path]:
    """Two nodes with a rod along x of third order, whose internal node −1 has two directions, and a mass that is singular."""
    stiffness = {(-1, 1, -1, 1): 8.0, (-1, 2, -1, 2): 8.0, (1, 1, -1, 1): 2.0, (2, 1, -1, 2): -2.0, (1, 1, 1, 1): 5.0, (2, 1, 1, 1): -4.0, (2, 1, 2, 1): 5.0}
    # The rank of the mass of the inner directions is 1.
    mass = {(-1, 1, -1, 1): 1.0, (-1, 2, -1, 1): -1.0, (-1, 2, -1, 2): 1.0, (1, 1, 1, 1): 3.0, (2, 1, 2, 1): 3.0}
    return labelled(folder / "b_STIF1.mtx", stiffness, end), labelled(folder / "b_MASS1.mtx", mass, end)


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_internal_nodes_and_a_singular_mass(end: str, tmp_path: Path) -> None:
    files = beam(end, tmp_path)
    with pytest.raises(quell.StudyError, match="modes: given: the mass matrix is singular. 1 directions? ha"):
        quell.from_abaqus(*files, **pad())
    found = quell.from_abaqus(*files, modes=3, damping_ratio=0.0, **pad())
    assert set(found.mode[0].given["shape"]) == {"internal1_x", "internal1_y", "n1_x", "n2_x"}
    assert found.notes[0].startswith("1 direction has no mass, of which 0 are coordinates")
    # By hand: with the mean m = (p + q)/2 of the inner directions static and d = (p − q)/2 of mass 4.
    stiffness = np.array([[8.0, 0, 2, 0], [0, 8, 0, -2], [2, 0, 5, -4], [0, -2, -4, 5]])
    to_rest = np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, 0, 1]])
    still = np.array([1.0, 1, 0, 0])
    follow = -(still @ stiffness @ to_rest) / (still @ stiffness @ still)
    whole = to_rest + np.outer(still, follow)
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(np.diag([4.0, 3, 3]), whole.T @ stiffness @ whole)).real)
    assert frequencies(found) == pytest.approx(np.sqrt(squares), rel=1e-9)


def test_damping_and_structural_damping_of_abaqus(tmp_path: Path) -> None:
    names = ("STIF1", "MASS1", "DMPV1", "DMPS1")
    matrices = (STIFFNESS, MASS, 0.1 * MASS, 0.02 * STIFFNESS)
    files = [coordinate(tmp_path / f"a_{name}.mtx", matrix) for name, matrix in zip(names, matrices, strict=True)]
    how = {"directions": 3, "modes": 6, **pad()}
    found = quell.from_abaqus(files[0], files[1], damping=files[2], structural_damping=files[3], **how)
    assert frequencies(found) == pytest.approx(OMEGA, rel=1e-12)
    assert [mode.given["damping_ratio"] for mode in found.mode] == pytest.approx(0.05 / OMEGA + 0.01, rel=1e-9)


SUBSTRUCTURE = """**
** a comment
*USER ELEMENT,NODES=         2,LINEAR
** ELEMENT NODES
**        31,        32,
        1,  2
        2,  2,  6
*MATRIX,TYPE=STIFFNESS
 4.0,
 1.0, 3.0,
 0.0, -1.0, 5.0,
 0.5, 0.0, 0.0, 2.0,
*MATRIX,TYPE=MASS
 1.0,
 0.0, 2.0,
 0.0, 0.0, 1.0,
 0.0, 0.0, 0.0, 0.5,
"""


def test_the_text_of_a_substructure(tmp_path: Path) -> None:
    file = tmp_path / "sub.mtx"
    file.write_text(SUBSTRUCTURE)
    found = quell.from_abaqus(file, file, **pad("n31_x"))
    assert found.coordinates == ["n31_x", "n31_y", "n32_y", "n32_rz"]
    assert found.stiffness == [[4, 1, 0, 0.5], [1, 3, -1, 0], [0, -1, 5, 0], [0.5, 0, 0, 2]]
    for old, new, words in [
        (" 0.5, 0.0, 0.0, 2.0,\n", " 0.5, 0.0, 0.0,\n", "line 12: the matrix ends here with 9 numbers.*has 10"),
        ("TYPE=MASS", "TYPE=LOAD", "no \\*MATRIX, TYPE=MASS; it has STIFFNESS, LOAD"),
        (" 1.0, 3.0,", " 1.0, nan,", "line 10.*finite numbers"),
        ("2,  2,  6", "3,  2,  6", "line 7.*a position of a node from 1 to 2"),
        ("31,        32,", "31,", "has 2 nodes.*has 1"),
        ("*MATRIX,TYPE=MASS", "*MATRIX,TYPE=STIFFNESS", "line 13: a second matrix of type STIFFNESS"),
        ("*MATRIX,TYPE=MASS", "*USER ELEMENT,NODES=2\n*MATRIX,TYPE=MASS", "line 13: a second .USER ELEMENT; line 3"),
    ]:
        (tmp_path / "wrong.mtx").write_text(SUBSTRUCTURE.replace(old, new))
        with pytest.raises(quell.StudyError, match=words):
            quell.from_abaqus(tmp_path / "wrong.mtx", tmp_path / "wrong.mtx", **pad("n31_x"))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text[:-8], "the file is cut off"),
        (lambda text: text.replace("2 5 ", "2 x "), "line .*row, column and entry"),
        (lambda text: text.replace("1 1 ", "0 1 "), "line 1: row 0"),
        (lambda text: text + "6 6 7.000000000000000e+00\n", "one entry at \\(n2_z, n2_z\\)"),
        (lambda text: "".join(line + "\n" for line in text.splitlines() if not line.startswith("5 6")), "listed with its mirror image.*cut off"),
        (lambda text: text + "1,1, 1,1, 2.0\n", "4 labels before the entry, and 2"),
        (lambda text: "%%MatrixMarket matrix\n" + text, "line 1: .*begins a file in Matrix Market form"),
        (lambda text: "", "is empty"),
        (lambda text: "** nothing\n", "has no line with an entry"),
    ],
)
def test_wrong_files_of_abaqus_are_refused_with_their_line(change: Callable[[str], str], words: str, tmp_path: Path) -> None:
    files = coordinate(tmp_path / "a_STIF1.mtx", STIFFNESS), coordinate(tmp_path / "a_MASS1.mtx", MASS)
    files[0].write_text(change(files[0].read_text()))
    with pytest.raises(quell.StudyError, match=words):
        quell.from_abaqus(*files, directions=3, **pad())


def test_what_has_no_stiffness_is_noted(tmp_path: Path) -> None:
    files = [labelled(tmp_path / name, entries) for name, entries in (("K.mtx", {(1, 1, 1, 1): 2.0}), ("M.mtx", {(1, 1, 1, 1): 1.0, (2, 1, 2, 1): 1.0}))]
    assert quell.from_abaqus(*files, **pad()).notes == ("1 degree of freedom has no stiffness, such as n2_x.",)
    files[0].write_text("1,1, 1,1, 2.0\n1,1, 1,1, 1.0\n")
    with pytest.raises(quell.StudyError, match="line 2: '1.0' must be one entry at .n1_x, n1_x., which line 1 has"):
        quell.from_abaqus(*files, **pad())


def test_rows_are_not_named_twice(tmp_path: Path) -> None:
    with pytest.raises(quell.StudyError, match="line 1: a matrix whose lines have nodes and directions; leave out dofs"):
        quell.from_abaqus(*beam("\n", tmp_path), directions=1, **pad())


def market(path: Path, matrix: Floats, form: str = "coordinate", symmetry: str = "symmetric") -> Path:
    """A matrix as ANSYS exports it."""
    size = len(matrix)
    places = [(i, j) for j in range(size) for i in range(j if symmetry == "symmetric" else 0, size)]
    lines = [f"%%MatrixMarket matrix {form} real {symmetry} ", "%=====", "% a program", "%====="]
    if form == "coordinate":
        places = [place for place in places if matrix[place] != 0.0]
        lines += [f"{size} {size} {len(places)}", *(f"{i + 1} {j + 1}  {matrix[i, j]:.13E}" for i, j in places)]
    else:
        lines += [f"{size} {size}", *(f"{matrix[place]:.13E}" for place in places)]
    path.write_text("\n".join(lines) + "\n")
    return path


def mapping(path: Path, nodes: list[int]) -> Path:
    path.write_text("\n".join(["%%MatrixMarket matrix array integer general ", "% a program", f"{len(nodes)} 1", *map(str, nodes)]) + "\n")
    return path


@pytest.mark.parametrize("form", ["coordinate", "array"])
@pytest.mark.parametrize("symmetry", ["symmetric", "general"])
def test_matrices_of_ansys_are_named_by_the_mapping(form: str, symmetry: str, tmp_path: Path) -> None:
    files = market(tmp_path / "K.txt", STIFFNESS, form, symmetry), market(tmp_path / "M.txt", MASS, form, symmetry)
    found = quell.from_ansys(*files, mapping(tmp_path / "map.txt", [31, 7]), **pad("n31_x"))
    assert found.coordinates == ["n7_x", "n7_y", "n7_z", "n31_x", "n31_y", "n31_z"]
    order = [3, 4, 5, 0, 1, 2]
    assert np.array_equal(found.stiffness, STIFFNESS[np.ix_(order, order)])
    reduced = quell.from_ansys(*files, directions=6, modes=6, damping_ratio=0.01, **pad())
    assert frequencies(reduced) == pytest.approx(OMEGA, rel=1e-12) and "n1_rz" in reduced.mode[0].given["shape"]
    (tmp_path / "plain.txt").write_text("31\r\n7\r\n")
    assert quell.from_ansys(*files, tmp_path / "plain.txt", **pad("n31_x")).coordinates == found.coordinates
    with pytest.raises(quell.StudyError, match="6 rows without nodes"):
        quell.from_ansys(*files, **pad())


def test_wrong_files_of_ansys_are_refused_with_their_line(tmp_path: Path) -> None:
    text = market(tmp_path / "K.txt", STIFFNESS).read_text()
    market(tmp_path / "M.txt", MASS)
    lines = text.splitlines()
    for wrong, words in [
        (text.replace("real", "complex"), "line 1.*real numbers, and this one is complex"),
        (text.replace("symmetric", "hermitian"), "this one is hermitian"),
        (text.replace("%%MatrixMarket", "%MatrixMarket"), "line 1.*the banner"),
        ("\n".join(lines[:-1]), "line 15: the file ends after 10 of the 11 entries that line 5 states"),
        (text + "6 1 2.0\n", "line 17: more than the 11 entries"),
        (text.replace("6 6 11", "6 5 11"), "line 5: a matrix of 6 rows and 5 columns"),
        (text.replace("4.0000000000000E+00", "nan"), "line 6.*a finite entry"),
        (text.replace("6 5  ", "7 5  "), "from 1 to 6"),
        (text.replace("4 1  ", "1 4  "), "an entry of the lower triangle"),
        (text.replace("4 1  ", "1 1  "), "one entry at"),
    ]:
        (tmp_path / "K.txt").write_text(wrong)
        with pytest.raises(quell.StudyError, match=words):
            quell.from_ansys(tmp_path / "K.txt", tmp_path / "M.txt", directions=3, **pad())
    (tmp_path / "K.txt").write_text(text)
    for nodes, words in [([31], "directions|6 rows"), ([31, 31], "line 5: node 31 again; line 4"), ([1, 2, 3, 4], "6 rows are not 1 to 6 of each of 4 nodes")]:
        files = (tmp_path / "K.txt", tmp_path / "M.txt", mapping(tmp_path / "map.txt", nodes))
        if nodes == [31]:
            assert quell.from_ansys(*files, **pad("n31_x")).coordinates[-1] == "n31_rz"
            continue
        with pytest.raises(quell.StudyError, match=words):
            quell.from_ansys(*files, **pad("n31_x"))
    (tmp_path / "map.txt").write_text((tmp_path / "map.txt").read_text()[:-2])
    with pytest.raises(quell.StudyError, match="the file ends after 3 of the 4 nodes"):
        quell.from_ansys(*files, **pad("n31_x"))


def test_examples_of_the_documentation_run() -> None:
    done = doctest.testmod(_ansys)
    assert done.attempted > 4 and done.failed == 0
