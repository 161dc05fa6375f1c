"""Files of finite-element programs and modal tests: written here, read, and compared with the study stated by matrices."""

from __future__ import annotations

import doctest
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import quell
from quell.fe import _abaqus

pyuff = pytest.importorskip("pyuff")

Floats = npt.NDArray[np.float64]

NODES = (11, 12)
"""Two nodes with three directions each."""

DOFS = [(node, direction) for node in NODES for direction in (1, 2, 3)]

POINTS: dict[str, tuple[int, str | int]] = {"pad_x": (11, "x"), "pad_y": (11, "y"), "back": (12, 3)}


def matrices() -> tuple[Floats, Floats]:
    """Mass and stiffness of six degrees of freedom, positive definite and full."""
    random = np.random.default_rng(4)
    spring, mass = random.normal(size=(6, 6)), 0.1 * random.normal(size=(6, 6))
    return mass @ mass.T + np.eye(6), spring @ spring.T + 4.0 * np.eye(6)


MASS, STIFFNESS = matrices()
PART = {
    "contact": quell.Contact(
        "pad", tangent={"pad_x": 1}, normal={"pad_y": 1}, normal_load=1, normal_stiffness=8, belt_velocity=1, friction=quell.Coulomb(0.4)
    ),
    "observe": {"pad_x": 1},
}
"""Everything of the studies that no file has."""

RATIO = 0.01


def modes_of_matrices() -> tuple[Floats, Floats]:
    """Frequencies and mass-normalised shapes, computed here."""
    factor = np.linalg.cholesky(MASS)
    inverse = np.linalg.inv(factor)
    values, vectors = np.linalg.eigh(inverse @ STIFFNESS @ inverse.T)
    return np.sqrt(values), inverse.T @ vectors


def stated(units: str = "none") -> quell.System:
    """The study stated by matrices, with the damping ratio RATIO in each mode."""
    frequencies, shapes = modes_of_matrices()
    left = MASS @ shapes
    damping = left @ np.diag(2 * RATIO * frequencies) @ left.T
    names = ["pad_x", "pad_y", "z", "u", "v", "back"]
    return quell.System(
        coordinates=names, mass=MASS.tolist(), stiffness=STIFFNESS.tolist(), damping=damping.tolist(), units=units, **PART
    )  # type: ignore[arg-type]


def same(system: quell.System, rel: float, units: str = "none") -> None:
    """Eigenvalues, friction at the threshold and exact critical values are those of the stated study."""
    wanted = stated(units)
    eigenvalues = [np.array(it.stability().facts["eigenvalues"]) for it in (system, wanted)]
    size = np.abs(eigenvalues[1]).max()
    assert np.allclose(sorted(eigenvalues[0][:, 1]), sorted(eigenvalues[1][:, 1]), atol=rel * size)
    assert np.allclose(sorted(eigenvalues[0][:, 0]), sorted(eigenvalues[1][:, 0]), atol=rel * size)
    path = "contact.pad.friction.coefficient"
    found, known = (it.stability(path, 0.1, 4.0).facts["thresholds"] for it in (system, wanted))
    assert [it["kind"] for it in found] == [it["kind"] for it in known] and known
    # The growth rate crosses zero with a slope, so that errors of eigenvalues over it are those of thresholds.
    assert [it["value"] for it in found] == pytest.approx([it["value"] for it in known], rel=300 * rel)


def write_abaqus(path: Path, matrix: Floats, form: str = "MATRIX INPUT") -> Path:
    """A triangle of a matrix in a format of Abaqus."""
    lines = ["** ", f"** {form}"]
    for i, row in enumerate(DOFS):
        for j, column in enumerate(DOFS[: i + 1]):
            if form == "COORDINATE":
                lines.append(f"{i + 1} {j + 1} {matrix[i, j]:.15e}")
            elif form == "LABELS":
                lines.append(f"{row[0]} {row[1]} {column[0]} {column[1]} {matrix[i, j]:.15e}")
            else:
                lines.append(f"{row[0]},{row[1]}, {column[0]},{column[1]},  {matrix[i, j]:.15e}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("form", ["MATRIX INPUT", "LABELS", "COORDINATE"])
def test_matrices_of_abaqus_are_the_stated_ones(form: str, tmp_path: Path) -> None:
    stiffness = write_abaqus(tmp_path / "job_STIF1.mtx", STIFFNESS, form)
    mass = write_abaqus(tmp_path / "job_MASS1.mtx", MASS, form)
    dofs = DOFS if form == "COORDINATE" else None
    whole = quell.from_abaqus(stiffness, mass, units="none", dofs=dofs, points=POINTS, **PART)
    assert whole.coordinates == ["pad_x", "pad_y", "n11_z", "n12_x", "n12_y", "back"]
    # 16 digits are written.
    assert np.allclose(whole.stiffness, STIFFNESS, rtol=1e-15) and np.allclose(whole.mass, MASS, rtol=1e-15)
    reduced = quell.from_abaqus(stiffness, mass, units="none", dofs=dofs, points=POINTS, modes=6, damping_ratio=RATIO, **PART)
    assert len(reduced.mode) == 6 and set(reduced.mode[0].given["shape"]) == set(POINTS)
    # Rounding times the condition of the masses and of the eigenvectors, about 10 each.
    same(reduced, 1e-13 * 100)


def test_restrained_and_massless_degrees_of_freedom_are_eliminated(tmp_path: Path) -> None:
    mass, stiffness = MASS.copy(), STIFFNESS.copy()
    # v has no mass, u is restrained.
    mass[4, :] = mass[:, 4] = 0.0
    stiffness[3, 3] = 1e36
    files = (write_abaqus(tmp_path / "K.mtx", stiffness), write_abaqus(tmp_path / "M.mtx", mass))
    left = quell.from_abaqus(*files, units="none", points=POINTS, **PART)
    assert left.coordinates == ["pad_x", "pad_y", "n11_z", "back"]
    kept = [0, 1, 2, 5]
    # The frequencies are those of a very light mass in place of none, up to its share.
    light = mass[np.ix_([0, 1, 2, 4, 5], [0, 1, 2, 4, 5])] + np.diag([0, 0, 0, 1e-9, 0])
    spring = stiffness[np.ix_([0, 1, 2, 4, 5], [0, 1, 2, 4, 5])]
    near = np.sort(np.linalg.eigvals(np.linalg.solve(light, spring)).real)[:4]
    exact = np.sort(np.linalg.eigvals(np.linalg.solve(np.array(left.mass), np.array(left.stiffness))).real)
    assert np.allclose(np.array(left.mass), mass[np.ix_(kept, kept)]) and np.allclose(near, exact, rtol=1e-7)
    points: dict[str, tuple[int, str | int]] = {**POINTS, "light": (12, "y")}
    with pytest.raises(quell.StudyError, match="light has none"):
        quell.from_abaqus(*files, units="none", points=points, **PART)
    # Static condensation gives every point its shape.
    modal = quell.from_abaqus(*files, units="none", points=points, modes=4, damping_ratio=0.0, **PART)
    row = -stiffness[4, kept] / stiffness[4, 4]
    shapes = [it.given["shape"] for it in modal.mode]
    full = quell.from_abaqus(*files, units="none", modes=4, damping_ratio=0.0, **{**PART, "contact": None, "observe": None})
    for short, long in zip(shapes, (it.given["shape"] for it in full.mode), strict=True):
        others = [long[name] for name in ("n11_x", "n11_y", "n11_z", "n12_z")]
        assert short["light"] == pytest.approx(row @ others, rel=1e-12)


def test_damping_of_a_matrix_becomes_that_of_modes(tmp_path: Path) -> None:
    frequencies, shapes = modes_of_matrices()
    left = MASS @ shapes
    ratios = np.linspace(0.01, 0.06, 6)
    damping = left @ np.diag(2 * ratios * frequencies) @ left.T
    files = [write_abaqus(tmp_path / f"{name}.mtx", it) for name, it in (("K", STIFFNESS), ("M", MASS), ("C", damping))]
    found = quell.from_abaqus(files[0], files[1], damping=files[2], units="none", points=POINTS, modes=6, **PART)
    assert [it.given["damping_ratio"] for it in found.mode] == pytest.approx(ratios, rel=1e-10)
    # A damper between two points couples the modes: it is kept in matrices, and not in modes.
    damping[0, 0] += 1.0
    write_abaqus(tmp_path / "C.mtx", damping)
    whole = quell.from_abaqus(files[0], files[1], damping=files[2], units="none", points=POINTS, **PART)
    assert np.allclose(whole.damping, damping, rtol=1e-14)
    with pytest.raises(quell.StudyError, match="couple the modes"):
        quell.from_abaqus(files[0], files[1], damping=files[2], units="none", points=POINTS, modes=6, **PART)


def write_dmig(path: Path, named: dict[str, Floats]) -> Path:
    """Symmetric matrices as wide DMIG entries, the lower triangle, as a punch file has them."""
    lines = ["$TITLE   = BRAKE"]
    for name, matrix in named.items():
        lines.append(f"DMIG    {name:<8}{0:>8}{6:>8}{2:>8}{0:>8}{'':>16}{6:>8}")
        for j, column in enumerate(DOFS):
            lines.append(f"DMIG*   {name:<16}{column[0]:>16}{column[1]:>16}")
            for i, row in enumerate(DOFS[j:], j):
                value = f"{matrix[i, j]:.9E}".replace("E", "D")
                lines.append(f"*       {row[0]:>16}{row[1]:>16}{value:>16}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def write_vectors(path: Path, subcase: int = 1) -> str:
    """Mass-normalised eigenvectors as a punch file."""
    frequencies, shapes = modes_of_matrices()
    lines = []
    for mode, frequency in enumerate(frequencies):
        lines += ["$TITLE   = BRAKE", "$SUBTITLE=", "$LABEL   =", "$EIGENVECTOR", "$REAL OUTPUT", f"$SUBCASE ID = {subcase:11d}"]
        lines.append(f"$EIGENVALUE ={frequency**2:15.7E}  MODE ={mode + 1:6d}")
        for place, node in enumerate(NODES):
            x, y, z = shapes[3 * place : 3 * place + 3, mode]
            lines.append(f"{node:10d}{'G':>8}{x:18.6E}{y:18.6E}{z:18.6E}")
            lines.append(f"{'-CONT-':<18}{0.0:18.6E}{0.0:18.6E}{0.0:18.6E}")
    # Columns 73 to 80 count the lines.
    text = "\n".join(f"{line:<72}{number:8d}" for number, line in enumerate(lines, 1)) + "\n"
    path.write_text(text, encoding="utf-8")
    return text


def test_matrices_and_eigenvectors_of_nastran(tmp_path: Path) -> None:
    file = write_dmig(tmp_path / "brake.pch", {"KAAX": STIFFNESS, "MAAX": MASS})
    whole = quell.from_nastran(file, units="none", points=POINTS, **PART)
    # Ten digits are written.
    assert np.allclose(whole.stiffness, STIFFNESS, rtol=1e-9, atol=1e-9) and np.allclose(whole.mass, MASS, rtol=1e-9, atol=1e-9)
    same(quell.from_nastran(file, units="none", points=POINTS, modes=6, damping_ratio=RATIO, **PART), 1e-8)
    write_vectors(tmp_path / "modes.pch")
    modal = quell.from_nastran(tmp_path / "modes.pch", units="none", points=POINTS, damping_ratio=RATIO, modal_mass=1, **PART)
    # Seven digits are written.
    same(modal, 1e-5)
    few = quell.from_nastran(tmp_path / "modes.pch", units="none", points=POINTS, damping_ratio=RATIO, modal_mass=1, modes=2, **PART)
    assert len(few.mode) == 2


def test_fields_of_dmig_in_every_format(tmp_path: Path) -> None:
    """Small, wide and free fields, and numbers without an E, are the same matrix."""
    small = "DMIG    K       0       6       1\nDMIG    K       1       1               1       1       2.5+1\n" \
        "        1       2       -1.5            2       0       4.D-1\nDMIG    K       1       2               1       2       3.0\n" \
        "DMIG    K       2       0               2       0       7.\n"
    free = "DMIG,K,0,6,1\nDMIG,K,1,1,,1,1,25.\n,1,2,-1.5,,2,0,.4\nDMIG,K,1,2,,1,2,3.\nDMIG,K,2,0,,2,0,7.\n"
    mass = "".join(f"DMIG,M,{grid},{part},,{grid},{part},1.\n" for grid, part in ((1, 1), (1, 2), (2, 0)))
    for text in (small, free):
        (tmp_path / "k.pch").write_text(f"$ a comment\n{text}DMIG,M,0,6,2\n{mass}GRID,1,,0.,0.,0.\n", encoding="utf-8")
        found = quell.from_nastran(tmp_path / "k.pch", units="mm-t-s", stiffness="k", mass="M", **bare("n1_x"))
        assert found.stiffness == [[25, -1.5, 0.4], [-1.5, 3, 0], [0.4, 0, 7]] and found.units == "mm-t-s"


def bare(point: str) -> dict[str, Any]:
    """A contact at one point."""
    contact = quell.Contact(tangent={point: 1}, normal_load=1, belt_velocity=1, friction=quell.Coulomb(0.3))
    return {"contact": contact}


def write_universal(path: Path, kind: int, mass: float = 2.0, analysis: int = 2) -> Path:
    """Modes of modal mass ``mass`` as data sets 55 or 2414."""
    frequencies, shapes = modes_of_matrices()
    file = pyuff.UFF(str(path))
    for mode, frequency in enumerate(frequencies):
        vector = np.sqrt(mass) * shapes[:, mode].reshape(2, 3)
        hertz = frequency / (2 * np.pi)
        if kind == 55:
            one: dict[str, Any] = {
                "type": 55, "model_type": 1, "analysis_type": analysis, "data_ch": 2, "spec_data_type": 8, "load_case": 0,
                "mode_n": mode + 1, "freq": hertz, "modal_m": mass, "modal_damp_vis": RATIO, "modal_damp_his": 0.0,
                "node_nums": np.array(NODES), "r1": vector[:, 0], "r2": vector[:, 1], "r3": vector[:, 2],
            }  # fmt: skip
        else:
            one = {
                "type": 2414, "analysis_dataset_label": mode + 1, "analysis_dataset_name": "mode", "dataset_location": 1, "id1": "a",
                "id2": "b", "id3": "c", "id4": "d", "id5": "e", "model_type": 1, "analysis_type": analysis, "data_characteristic": 2,
                "result_type": 8, "data_type": 2, "number_of_data_values_for_the_data_component": 3, "record12_field2": hertz,
                "record12_field4": mass, "record12_field5": RATIO, "node_nums": np.array(NODES), "data_at_node": vector,
            }  # fmt: skip
        file.write_sets(one, "add")
    return path


@pytest.mark.parametrize("kind", [55, 2414])
def test_modes_of_universal_files_are_the_stated_ones(kind: int, tmp_path: Path) -> None:
    file = write_universal(tmp_path / "modes.uff", kind)
    found = quell.from_universal_file(file, units="none", points=POINTS, **PART)
    # Six digits are written.
    same(found, 1e-4)
    assert found.mode[0].given["modal_mass"] == 2.0
    other = quell.from_universal_file(file, units="none", points=POINTS, damping_ratio=[0.02] * 6, **PART)
    assert other.mode[5].given["damping_ratio"] == 0.02


def test_responses_of_universal_files_are_receptances(tmp_path: Path) -> None:
    """Accelerance of one mass between its springs: the receptance in the file and the verdict are those of the mass."""
    mass, stiffness, rate = 2.0, 800.0, 1.6
    # The file has the spacing of the frequencies with six digits.
    hertz = 0.05 * np.arange(1, 401)
    s = 2j * np.pi * hertz
    receptance = 1 / (mass * s**2 + rate * s + stiffness)
    # The response against the direction x.
    one = pyuff.prepare_58(
        binary=0, func_type=4, rsp_node=3, rsp_dir=-1, ref_node=3, ref_dir=1, data=-(s**2) * receptance, x=hertz, id1="frf",
        rsp_ent_name="a", ref_ent_name="a", abscissa_spacing=1, abscissa_spec_data_type=18, ordinate_spec_data_type=12,
        orddenom_spec_data_type=13,
    )  # fmt: skip
    pyuff.UFF(str(tmp_path / "frf.uff")).write_sets([one], "add")
    how: dict[str, Any] = {"units": "SI", "points": {"x": (3, "x")}, "save": tmp_path / "frf.csv"}
    with pytest.raises(quell.StudyError, match="does not begin at 0 Hz"):
        quell.from_universal_file(tmp_path / "frf.uff", **how, **bare("x"))
    assert not (tmp_path / "frf.csv").exists()
    law = quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2, reference_velocity=0.5)
    contact = quell.Contact("pad", tangent={"x": 1}, normal_load=10, belt_velocity=0.1, friction=law)
    static = {("x", "x"): 1 / stiffness}
    measured = quell.from_universal_file(tmp_path / "frf.uff", **how, static=static, contact=contact)
    rows = np.genfromtxt(tmp_path / "frf.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    assert rows["frequency_hz"][0] == 0.0 and rows["re"][0] == 1 / stiffness
    found = rows["re"][1:] + 1j * rows["im"][1:]
    # Data sets of this form have about 12 digits.
    assert np.abs(found - receptance).max() < 1e-9 * np.abs(receptance).max()
    for load in (0.1, 10.0):
        known = quell.System(
            coordinates=["x"], mass=[mass], damping=[rate], stiffness=[stiffness], units="SI", contact=contact.replace(normal_load=load)
        )
        verdict = measured.set({"contact.pad.normal_load": load}).stability().verdict
        assert verdict == known.stability().verdict == ("stable" if load < 1.0 else "unstable")


def test_what_files_do_not_say_is_asked_for(tmp_path: Path) -> None:
    write_vectors(tmp_path / "modes.pch")
    write_dmig(tmp_path / "k.pch", {"KAAX": STIFFNESS})
    write_universal(tmp_path / "bare.uff", 55, mass=1.0)
    text = (tmp_path / "modes.pch").read_text(encoding="utf-8")
    (tmp_path / "two.pch").write_text(text + text.replace("ID =           1", "ID =           2"), encoding="utf-8")
    (tmp_path / "broken.pch").write_text(text.replace("-CONT-", "-CONT-            zero"), encoding="utf-8")
    (tmp_path / "K.mtx").write_text("1,1,1,1\n", encoding="utf-8")
    (tmp_path / "A.mtx").write_text("1,1, 1,1, 2.0\n1,1, 1,2, 1.0\n1,2, 1,1, 1.5\n1,2,1,2,1.\n", encoding="utf-8")
    unitless: dict[str, Any] = {"units": "none"}
    modal = {**unitless, "damping_ratio": 0.01, "modal_mass": 1}
    asymmetric = quell.from_abaqus(tmp_path / "A.mtx", write_identity(tmp_path / "I.mtx"), symmetric=False, **unitless, **bare("n1_x"))
    assert asymmetric.stiffness == [[2, 1], [1.5, 1]]
    for call, words in [
        (lambda: quell.from_nastran(tmp_path / "modes.pch", units="inch"), "units"),
        (lambda: quell.from_nastran(tmp_path / "modes.pch", **unitless), "modal damping"),
        (lambda: quell.from_nastran(tmp_path / "modes.pch", damping_ratio=0.01, **unitless), "modal masses"),
        (lambda: quell.from_nastran(tmp_path / "modes.pch", **{**modal, "damping_ratio": [0.1, 0.2]}), "6 of them"),
        (lambda: quell.from_nastran(tmp_path / "modes.pch", points={"a": (9, "x")}, **modal), "of the file, which has n11_x"),
        (lambda: quell.from_nastran(tmp_path / "modes.pch", points={"a": (11, "q")}, **modal), "a direction"),
        (lambda: quell.from_nastran(tmp_path / "two.pch", **modal), "subcases of the file, 1, 2"),
        (lambda: quell.from_nastran(tmp_path / "broken.pch", **modal), "line 9"),
        (lambda: quell.from_nastran(tmp_path / "k.pch", **unitless), "the file: KAAX"),
        (lambda: quell.from_abaqus(tmp_path / "K.mtx", tmp_path / "K.mtx", **unitless), "line 1"),
        (lambda: quell.from_abaqus(tmp_path / "A.mtx", tmp_path / "A.mtx", **unitless), "symmetric=False"),
        (lambda: quell.from_universal_file(tmp_path / "bare.uff", units="SI", content="responses"), "data set 58"),
    ]:
        with pytest.raises(quell.StudyError, match=words):
            call()
    with pytest.raises(FileNotFoundError):
        quell.from_universal_file(tmp_path / "nowhere.uff", units="SI")
    write_universal(tmp_path / "massless.uff", 55, mass=1.0)
    lines = (tmp_path / "massless.uff").read_text(encoding="utf-8").replace("  1.00000e+00  1.00000e-02", "  0.00000e+00  1.00000e-02")
    (tmp_path / "massless.uff").write_text(lines, encoding="utf-8")
    with pytest.raises(quell.StudyError, match="modal masses"):
        quell.from_universal_file(tmp_path / "massless.uff", **unitless)
    pyuff.UFF(str(tmp_path / "massless.uff")).write_sets(
        {"type": 164, "units_code": 9, "units_description": "mm (newton)", "temp_mode": 1, "length": 1000.0, "force": 1.0, "temp": 1.0,
         "temp_offset": 273.15}, "add",
    )  # fmt: skip
    with pytest.raises(quell.StudyError, match="data set 164"):
        quell.from_universal_file(tmp_path / "massless.uff", units="SI", modal_mass=1)
    right = quell.from_universal_file(tmp_path / "massless.uff", units="mm-t-s", modal_mass=1, points=POINTS, **PART)
    assert right.units == "mm-t-s"


def write_identity(path: Path) -> Path:
    """Two unit masses."""
    path.write_text("1,1,1,1,1.\n1,2,1,2,1.\n", encoding="utf-8")
    return path


def test_examples_of_the_documentation_run() -> None:
    done = doctest.testmod(_abaqus)
    assert done.attempted > 4 and done.failed == 0
