"""Files of finite-element programs that are wrong or large: complaints with file and line, and modes of sparse matrices."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import quell
from quell.fe import _matrices

HOW: dict[str, Any] = {"units": "none", "points": {"x": (1, "x")}}


def bare(point: str = "x") -> dict[str, Any]:
    """A contact at one point."""
    contact = quell.Contact(tangent={point: 1}, normal_load=1, belt_velocity=1, friction=quell.Coulomb(0.3))
    return {"contact": contact}


def abaqus(folder: Path, diagonal: str, coupling: str = "-1.0") -> quell.System:
    """Three masses on springs, with a text in place of the second stiffness and of a coupling."""
    stiffness = f"** of a job\n1,1,1,1, 2.0\n2,1,2,1, {diagonal}\n2,1,1,1, {coupling}\n3,1,3,1, 3.0\n"
    (folder / "K.mtx").write_text(stiffness, encoding="utf-8")
    (folder / "M.mtx").write_text("1,1,1,1,1.\n2,1,2,1,1.\n3,1,3,1,1.\n", encoding="utf-8")
    return quell.from_abaqus(folder / "K.mtx", folder / "M.mtx", **HOW, **bare())


def nastran(folder: Path, diagonal: str, coupling: str = "-1.0") -> quell.System:
    """The same as DMIG entries."""
    lines = ["$ a job", "DMIG,K,0,6,2", f"DMIG,K,1,1,,1,1,2.0\n,2,1,{coupling}", f"DMIG,K,2,1,,2,1,{diagonal}", "DMIG,K,3,1,,3,1,3.0"]
    lines += ["DMIG,M,0,6,2", *(f"DMIG,M,{grid},1,,{grid},1,1.0" for grid in (1, 2, 3))]
    (folder / "k.pch").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return quell.from_nastran(folder / "k.pch", stiffness="K", mass="M", **HOW, **bare())


WRONG = ["nan", "inf", "-inf", "infinity", "1e999", "-1e36", "1e31", "2_0.0", "１.0", "0x1p3", "two"]


@pytest.mark.parametrize("text", WRONG)
@pytest.mark.parametrize("read", [abaqus, nastran])
@pytest.mark.parametrize("where", ["diagonal", "coupling"])
def test_a_number_that_is_none_is_refused_with_file_and_line(
    read: Callable[..., quell.System], text: str, where: str, tmp_path: Path
) -> None:
    read(tmp_path, "2.5")
    with pytest.raises(quell.StudyError) as caught:
        read(tmp_path, **{"diagonal": "2.5", where: text})
    error = caught.value.errors[0]
    lines = {(abaqus, "diagonal"): 3, (abaqus, "coupling"): 4, (nastran, "coupling"): 4, (nastran, "diagonal"): 5}
    assert error["line"] == lines[read, where], error
    assert ("K.mtx" if read is abaqus else "k.pch") in error["message"] and f"line {error['line']}" in error["message"]


def test_only_the_number_of_abaqus_restrains(tmp_path: Path) -> None:
    assert abaqus(tmp_path, "1.000000000000000e+36").coordinates == ["x", "n3_x"]
    with pytest.raises(quell.StudyError, match="line 4.*below 1e\\+30"):
        abaqus(tmp_path, "2.5", "1e36")


def test_an_entry_of_dmig_is_given_once(tmp_path: Path) -> None:
    nastran(tmp_path, "2.5")
    with (tmp_path / "k.pch").open("a", encoding="utf-8") as file:
        file.write("DMIG,K,2,1,,2,1,7.0\n")
    with pytest.raises(quell.StudyError, match="line 11.*one entry at \\(n2_x, n2_x\\)"):
        quell.from_nastran(tmp_path / "k.pch", stiffness="K", mass="M", **HOW, **bare())


def vectors(folder: Path, values: list[float], case: str = "1", first: float = 1.0) -> quell.System:
    """Eigenvectors of one grid with these eigenvalues."""
    lines = []
    for mode, value in enumerate(values, 1):
        lines += ["$TITLE   =", "$EIGENVECTOR", "$REAL OUTPUT", f"$SUBCASE ID = {case}", f"$EIGENVALUE = {value:.7E}  MODE = {mode}"]
        lines.append(f"{1:10d}{'G':>8}{first:18.6E}{0.0:18.6E}{0.0:18.6E}")
    (folder / "modes.pch").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return quell.from_nastran(folder / "modes.pch", damping_ratio=0.01, modal_mass=1, **HOW, **bare())


def test_a_negative_eigenvalue_is_no_rigid_motion(tmp_path: Path) -> None:
    found = vectors(tmp_path, [-3e-5, 400.0, 1e6])
    assert [it.given["frequency"] for it in found.mode] == [0.0, 20.0, 1000.0]
    with pytest.raises(quell.StudyError, match="modes.pch, line 11.*ω² ≥ 0"):
        vectors(tmp_path, [400.0, -100.0, 1e6])
    for arguments in ({"values": [float("nan"), 4.0]}, {"values": [1.0], "case": "one"}, {"values": [1.0], "first": float("inf")}):
        with pytest.raises(quell.StudyError, match="modes.pch, line [456]"):
            vectors(tmp_path, **arguments)  # type: ignore[arg-type]


def test_a_mode_without_a_point_is_refused(tmp_path: Path) -> None:
    vectors(tmp_path, [400.0, 900.0])
    text = (tmp_path / "modes.pch").read_text(encoding="utf-8")
    (tmp_path / "modes.pch").write_text("\n".join(text.splitlines()[:-1]), encoding="utf-8")
    with pytest.raises(quell.StudyError, match="modes.pch, line 8: an eigenvector without displacements"):
        quell.from_nastran(tmp_path / "modes.pch", damping_ratio=0.01, modal_mass=1, **HOW, **bare())


READERS: list[Callable[[Any], object]] = [
    lambda path: quell.from_abaqus(path, path, **HOW),
    lambda path: quell.from_nastran(path, **HOW),
    lambda path: quell.from_universal_file(path, **HOW),
]


@pytest.mark.parametrize("read", READERS)
def test_what_has_no_end_is_not_read(read: Callable[[Any], object], tmp_path: Path) -> None:
    fifo = tmp_path / "fifo"
    os.mkfifo(fifo)
    begin = time.monotonic()
    for path in (fifo, "/dev/zero", "/dev/stdin", tmp_path):
        with pytest.raises(quell.StudyError, match="expected a regular file"):
            read(path)
    assert time.monotonic() - begin < 5.0
    with pytest.raises(quell.StudyFileNotFoundError):
        read(tmp_path / "nowhere")
    (tmp_path / "binary").write_bytes(b"\x00\xff" * 200_000)
    for wrong in (tmp_path / "binary", 7.5, None):
        with pytest.raises(quell.StudyError):
            read(wrong)


def test_arguments_are_refused_by_name(tmp_path: Path) -> None:
    abaqus(tmp_path, "2.5")
    nastran(tmp_path, "2.5")
    files = (tmp_path / "K.mtx", tmp_path / "M.mtx")
    for call, key in [
        (lambda: quell.from_abaqus(*files, units="none", dofs=7), "dofs"),  # type: ignore[arg-type]
        (lambda: quell.from_abaqus(*files, units="none", dofs=[(1,)]), r"dofs\[0\]"),  # type: ignore[list-item]
        (lambda: quell.from_abaqus(*files, units="none", points=["x"]), "points"),  # type: ignore[arg-type]
        (lambda: quell.from_abaqus(*files, units="none", modes="two"), "modes"),  # type: ignore[arg-type]
        (lambda: quell.from_nastran(tmp_path / "k.pch", units="none", stiffness=3), "stiffness"),  # type: ignore[arg-type]
    ]:
        with pytest.raises(quell.StudyError, match=key):
            call()


Floats = npt.NDArray[np.float64]


def chain(folder: Path, count: int, springs: Floats, masses: Floats) -> tuple[Path, Path]:
    """A chain of masses between walls; springs (count + 1,)."""
    rows = [f"{place + 1},1,{place + 1},1,{springs[place] + springs[place + 1]!r}" for place in range(count)]
    rows += [f"{place + 1},1,{place},1,{-springs[place]!r}" for place in range(1, count)]
    (folder / "K.mtx").write_text("\n".join(rows).replace("np.float64(", "").replace(")", ""), encoding="utf-8")
    kept = [f"{place + 1},1,{place + 1},1,{float(mass)!r}" for place, mass in enumerate(masses) if mass > 0.0]
    (folder / "M.mtx").write_text("\n".join(kept), encoding="utf-8")
    return folder / "K.mtx", folder / "M.mtx"


def test_sparse_modes_are_those_of_dense_matrices(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(2)
    masses = random.uniform(0.5, 2.0, 120)
    masses[::5] = 0.0
    files = chain(tmp_path, 120, random.uniform(0.5, 2.0, 121), masses)
    how: dict[str, Any] = {"units": "none", "points": {"x": (2, "x"), "light": (1, "x")}, "modes": 20, "damping_ratio": 0.01, **bare()}
    dense = quell.from_abaqus(*files, **how)
    monkeypatch.setattr(_matrices, "DENSE", 10)
    sparse = quell.from_abaqus(*files, **how)
    for one, other in zip(dense.mode, sparse.mode, strict=True):
        # Rounding of both: the largest eigenvalue over the lowest is below 1e5, times 16 digits.
        assert one.given["frequency"] == pytest.approx(other.given["frequency"], rel=1e-10)
        shapes = [np.array([it.given["shape"][name] for name in ("x", "light")]) for it in (one, other)]
        assert np.abs(shapes[0]) == pytest.approx(np.abs(shapes[1]), rel=1e-7, abs=1e-9)


def test_a_large_model_is_reduced_within_seconds(tmp_path: Path) -> None:
    count = 30_000
    files = chain(tmp_path, count, np.ones(count + 1), np.ones(count))
    how: dict[str, Any] = {"units": "none", **bare()}
    with pytest.raises(quell.StudyError, match="modes.*more than 1000 degrees of freedom"):
        quell.from_abaqus(*files, points={"x": (1, "x")}, **how)
    with pytest.raises(quell.StudyError, match="points.*too many"):
        quell.from_abaqus(*files, modes=5, damping_ratio=0.01, **how)
    begin = time.monotonic()
    found = quell.from_abaqus(*files, points={"x": (count // 2, "x")}, modes=5, damping_ratio=0.01, **how)
    # Dense matrices of this size have 21 GB.
    assert time.monotonic() - begin < 60.0
    wanted = 2.0 * np.sin(np.arange(1, 6) * np.pi / (2 * (count + 1)))
    # The lowest ω² is 1e-8 of the largest, and rounding of the matrix 1e-16 of that.
    assert [it.given["frequency"] for it in found.mode] == pytest.approx(wanted, rel=1e-7)


@pytest.mark.parametrize("most", [10, 1000])
def test_a_structure_with_a_growing_motion_is_refused(most: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    springs = np.ones(61)
    springs[30] = -0.6
    files = chain(tmp_path, 60, springs, np.ones(60))
    monkeypatch.setattr(_matrices, "DENSE", most)
    with pytest.raises(quell.StudyError, match="positive semidefinite"):
        quell.from_abaqus(*files, units="none", points={"x": (1, "x")}, modes=4, damping_ratio=0.01, **bare())
