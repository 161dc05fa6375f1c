"""Universal files as modal tests and finite-element programs write them: complex modes, units, functions in text and binary."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import quell

Values = npt.NDArray[np.complex128]

NODES = (4, 17)
SHAPE = [1.0, 0.5, -0.25, -2.0, 0.125, 0.75]


def pad(point: str = "n4_x", units: str = "none") -> dict[str, Any]:
    """Everything of the studies that no file has."""
    contact = quell.Contact(tangent={point: 1}, normal_load=1, belt_velocity=1, friction=quell.Coulomb(0.3))
    return {"units": units, "contact": contact}


def reals(values: list[float]) -> list[str]:
    """Six numbers of 13 characters a line."""
    cells = [f"{value:13.5E}" for value in values]
    return ["".join(cells[at : at + 6]) for at in range(0, len(cells), 6)]


def data_set(kind: str, lines: list[str]) -> list[str]:
    return ["    -1", f"{kind:>6}", *lines, "    -1"]


def whole(*values: int) -> str:
    return "".join(f"{value:10d}" for value in values)


def mode_55(
    number: int, numbers: list[float], shape: list[complex], analysis: int = 2, is_complex: bool = False, quantity: int = 8
) -> list[str]:
    """A mode of data set 55 with three displacements at two nodes."""
    lines = ["a test", "NONE", "NONE", "NONE", "NONE", whole(1, analysis, 2, quantity, 5 if is_complex else 2, 3)]
    lines += [whole(2, len(numbers), 0, number), *reals(numbers)]
    for place, node in enumerate(NODES):
        own = shape[3 * place : 3 * place + 3]
        lines += [whole(node), *reals([part for z in own for part in ((z.real, z.imag) if is_complex else (z.real,))])]
    return data_set("55", lines)


def mode_2414(number: int, hertz: float, mass: float, shape: list[complex], location: int = 1) -> list[str]:
    """A normal mode of data set 2414 in complex numbers, as NX writes it."""
    lines = [whole(number), f"Mode {number}", whole(location), *["NONE"] * 5, whole(1, 2, 2, 8, 5, 3), whole(0, 0, 1, 0, 0, number, 0, 0), whole(0, 0)]
    lines += [*reals([0.0, hertz, 0.0, mass, 0.0, 0.0]), *reals([0.0] * 6)]
    for place, node in enumerate(NODES):
        lines += [whole(node), *reals([part for z in shape[3 * place : 3 * place + 3] for part in (z.real, z.imag)])]
    return data_set("2414", lines)


def units_164(code: int, name: str, length: float, force: float) -> list[str]:
    factors = "".join(f"{value:25.17E}".replace("E", "D") for value in (length, force, 1.0))
    return data_set("164", [f"{code:10d}{name:<20}{2:10d}", factors, f"{273.15:25.17E}".replace("E", "D")])


def write(path: Path, *sets: list[str], end: str = "\n") -> Path:
    path.write_bytes((end.join(line for one in sets for line in one) + end).encode("latin-1"))
    return path


REAL = [complex(x) for x in SHAPE]


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_complex_modes_become_real_ones(end: str, tmp_path: Path) -> None:
    # Modal A of a real shape is 2iω_d m, and turns with the square of the shape.
    turn = complex(np.exp(0.4j))
    rates = [complex(-0.5, 30.0), complex(-1.0, 50.0), complex(-2.0, 70.0)]
    skew = [z * (1.0 if place < 3 else 1j) for place, z in enumerate(REAL)]
    sets = []
    for number, (rate, shape) in enumerate(zip(rates, (REAL, [turn * z for z in REAL], skew), strict=True), 1):
        a = 2j * rate.imag * 3.0 * (turn**2 if number == 2 else 1.0)
        b = -rate * a
        # The first mode has modal B only.
        a = a if number > 1 else 0j
        sets.append(mode_55(number, [rate.real, rate.imag, a.real, a.imag, b.real, b.imag], shape, 3, True))
    nodes = data_set("2411", [whole(4, 0, 0, 11), *reals([0.0, 0.0, 0.0]), whole(-1), *reals([1.0, 0.0, 0.0])])
    file = write(tmp_path / "m.uff", nodes, *sets, end=end)
    file.write_bytes(b"\xef\xbb\xbf" + file.read_bytes())
    found = quell.from_universal_file(file, **pad())
    assert len(found.mode) == 2
    names = [f"n{node}_{way}" for node in NODES for way in "xyz"]
    for mode, rate in zip(found.mode, rates, strict=False):
        assert mode.given["frequency"] == pytest.approx(abs(rate), rel=1e-5)
        assert mode.given["damping_ratio"] == pytest.approx(-rate.real / abs(rate), rel=1e-5)
        assert mode.given["modal_mass"] == pytest.approx(3.0, rel=1e-5)
        assert [mode.given["shape"][name] for name in names] == pytest.approx(SHAPE, abs=2e-5)
    kept, left = found.notes
    assert "mode 1 (line 9): 1.0000; mode 2 (line" in kept and "below 0.95: mode 3 (line" in left
    # (Σ|a|² − Σ|b|²)²/(Σ|a|² + Σ|b|²)² of two parts at a right angle.
    sizes = [sum(x * x for x in SHAPE[:3]), sum(x * x for x in SHAPE[3:])]
    assert f": {((sizes[0] - sizes[1]) / sum(sizes)) ** 2:.4f}." in left
    more = quell.from_universal_file(file, collinearity=0.1, modal_mass=[3, 3, 3], **pad())
    assert len(more.mode) == 3
    with pytest.raises(quell.StudyError, match="collinearity = 0.95.*mode 3 .line 2.: 0."):
        quell.from_universal_file(write(tmp_path / "skew.uff", sets[2]), **pad())
    wrong = mode_55(1, [-1.0, 50.0, 8.0, 3.0, 0.0, 0.0], REAL, 3, True)
    with pytest.raises(quell.StudyError, match="modal_mass: given: modal A of mode 1 .line 2. is 8.3j"):
        quell.from_universal_file(write(tmp_path / "a.uff", wrong), **pad())


def test_units_of_the_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    modes = [mode_2414(number, 10.0 * number, 2.0, REAL) for number in (1, 2)]
    file = write(tmp_path / "m.uff", units_164(5, "mm (milli-newton)", 1e3, 1e3), *modes)
    found = quell.from_universal_file(file, units="file", contact=pad()["contact"])
    assert found.units == "SI" and found.mode[0].given["modal_mass"] == 2.0
    assert found.mode[0].given["frequency"] == pytest.approx(20 * np.pi, rel=1e-15)
    assert found.notes == ("The numbers of the file, in mm (milli-newton) (data set 164), became SI.",)
    tonnes = write(tmp_path / "t.uff", units_164(9, "mm (newton)", 1e3, 1.0), *modes)
    assert quell.from_universal_file(tonnes, units="file", contact=pad()["contact"]).mode[0].given["modal_mass"] == 2000.0
    assert quell.from_universal_file(tonnes, **pad(units="mm-t-s")).mode[0].given["modal_mass"] == 2.0
    with pytest.raises(quell.StudyError, match='data set 164 .line 2. states mm .milli-newton., code 5, factors 1000.*units="file"'):
        quell.from_universal_file(file, **pad(units="SI"))
    with pytest.raises(quell.StudyError, match="no data set 164"):
        quell.from_universal_file(write(tmp_path / "n.uff", *modes), units="file", contact=pad()["contact"])
    with pytest.raises(quell.StudyError, match="a second data set 164 with other units"):
        quell.from_universal_file(write(tmp_path / "2.uff", units_164(1, "SI", 1.0, 1.0), units_164(9, "mm", 1e3, 1.0), *modes), units="file")
    assert capsys.readouterr().out == ""


def test_shapes_of_accelerations_have_no_modal_mass(tmp_path: Path) -> None:
    file = write(tmp_path / "m.uff", mode_55(1, [10.0, 2.0, 0.01, 0.0], REAL, quantity=12))
    with pytest.raises(quell.StudyError, match="modal_mass: given"):
        quell.from_universal_file(file, **pad())
    found = quell.from_universal_file(file, modal_mass=1, **pad())
    assert found.notes == ("The shape in line 2 is of accelerations: the modal mass of the file does not belong to displacements.",)


MODES = [line for number in (1, 2) for line in mode_55(number, [10.0 * number, 2.0, 0.01, 0.0], REAL)]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda lines: lines[:-1], "line 17: data set 55 has no end, a line -1. Is the file cut off"),
        (lambda lines: [*lines[:-3], lines[-1]], "line 17: mode 2 has no displacement 1 of node 17"),
        (lambda lines: [*lines[:11], lines[11].replace("E", "x"), *lines[12:]], "line 12.*finite numbers"),
        (lambda lines: [line.replace("        17", "         4") for line in lines], "node 4 again in one mode; line 11"),
        (lambda lines: [*lines, *lines[:15]], "mode 1 again; line 2"),
        (lambda lines: [line.replace("  1.00000E+01", "           nan") for line in lines], "line 10.*finite numbers"),
        (lambda lines: [line.replace("  1.00000E+01", " -1.00000E+01") for line in lines], "line 2: a mode of frequency -10 Hz"),
        (lambda lines: [line if line != "    55" else "    x5" for line in lines], "line 2.*the number of a data set"),
        (lambda lines: ["    -1", "  2411", *lines[1:10], "    -1"], "has data sets 2411 .nodes.; expected modes"),
        (lambda lines: ["no data sets"], "no data set begins"),
        (lambda lines: mode_2414(1, 10.0, 1.0, REAL, location=2), "results at elements"),
        (lambda lines: [line.replace(whole(1, 2, 2, 8, 2, 3), whole(1, 1, 2, 8, 2, 3)) for line in lines], "a test of a static analysis .type 1."),
        (lambda lines: [line.replace(whole(1, 2, 2, 8, 2, 3), whole(1, 2, 1, 8, 2, 1)) for line in lines], "1 value at a node"),
        (lambda lines: [line.replace(whole(1, 2, 2, 8, 2, 3), "1 2 2") for line in lines], "line 8.*whole numbers: model type"),
    ],
)
def test_wrong_modes_are_refused_with_their_line(change: Callable[[list[str]], list[str]], words: str, tmp_path: Path) -> None:
    quell.from_universal_file(write(tmp_path / "right.uff", MODES), **pad())
    with pytest.raises(quell.StudyError, match=words):
        quell.from_universal_file(write(tmp_path / "m.uff", change(MODES)), **pad())


HERTZ = np.arange(1, 41) * 0.5


def receptance() -> Values:
    """That of an oscillator of 3 kg at 9 Hz."""
    s = 2j * np.pi * HERTZ
    return np.asarray(1 / (3.0 * (s**2 + 2.0 * s + (18 * np.pi) ** 2)), dtype=np.complex128)


def function_58(
    values: Values, kind: int = 4, direction: int = 1, types: tuple[int, int] = (12, 13), even: bool = True, data: int = 5
) -> list[str]:
    """A function in text."""
    begin = f"{kind:5d}{1:10d}{0:5d}{0:10d} {'point 1':<10}{17:10d}{direction:4d} {'NONE':<10}{17:10d}{direction:4d}"
    spacing = f"{data:10d}{len(values):10d}{int(even):10d}{HERTZ[0]:13.5E}{HERTZ[1] - HERTZ[0]:13.5E}{0.0:13.5E}"
    axes = [(18, "Frequency", "Hz"), (types[0], "Response", "m/s\xb2"), (types[1], "Force", "N"), (0, "NONE", "NONE")]
    head = ["H1", "NONE", "today", "Record 1", "NONE", begin, spacing, *(f"{one:10d}{0:5d}{0:5d}{0:5d} {name:<20} {unit:<20}" for one, name, unit in axes)]
    numbers = [part for hertz, z in zip(HERTZ, values, strict=True) for part in ([] if even else [hertz]) + [z.real, z.imag]]
    if data == 5:
        return data_set("58", head + reals(numbers))
    return data_set("58", head + ["".join(f"{x:20.12E}" for x in numbers[at : at + 4]) for at in range(0, len(numbers), 4)])


STATIC = {("x", "x"): 1 / (3.0 * (18 * np.pi) ** 2)}


def saved(folder: Path) -> Values:
    rows = np.genfromtxt(folder / "f.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    assert rows["frequency_hz"][1:].tolist() == HERTZ.tolist()
    return np.asarray(rows["re"][1:] + 1j * rows["im"][1:], dtype=np.complex128)


@pytest.mark.parametrize("even", [True, False])
@pytest.mark.parametrize(("data", "digits"), [(5, 1e-5), (6, 1e-11)])
@pytest.mark.parametrize(("types", "power"), [((8, 13), 0), ((11, 9), 1), ((12, 13), 2)])
def test_functions_in_text(even: bool, data: int, digits: float, types: tuple[int, int], power: int, tmp_path: Path) -> None:
    lines = function_58(receptance() * (2j * np.pi * HERTZ) ** power, types=types, even=even, data=data)
    file = write(tmp_path / "f.uff", lines, function_58(receptance(), kind=9))
    found = quell.from_universal_file(file, points={"x": (17, "x")}, save=tmp_path / "f.csv", static=STATIC, **pad("x", "SI"))
    assert np.abs(saved(tmp_path) / receptance() - 1).max() < digits
    assert found.notes == ("Not read of data sets 58: power spectral density (function type 9).",)


@pytest.mark.parametrize("data", [5, 6])
@pytest.mark.parametrize("even", [True, False])
@pytest.mark.parametrize("binary", [0, 1])
def test_functions_of_pyuff(data: int, even: bool, binary: int, tmp_path: Path) -> None:
    pyuff = pytest.importorskip("pyuff")
    one = pyuff.prepare_58(
        binary=binary, func_type=4, rsp_node=17, rsp_dir=1, ref_node=17, ref_dir=-1, data=-receptance(), x=HERTZ, id1="frf", ord_data_type=data,
        rsp_ent_name="a", ref_ent_name="a", abscissa_spacing=int(even), abscissa_spec_data_type=18, ordinate_spec_data_type=8,
        orddenom_spec_data_type=13, abscissa_min=HERTZ[0], abscissa_inc=0.5,
    )  # fmt: skip
    file = tmp_path / "f.uff"
    pyuff.UFF(str(file)).write_sets([one, one], "add")
    how: dict[str, Any] = {"save": tmp_path / "f.csv", "static": STATIC, **pad("x", "SI")}
    with pytest.raises(quell.StudyError, match="one response of .'x', 'x'.: those of lines 2 and"):
        quell.from_universal_file(file, points={"x": (17, "x")}, **how)
    file.unlink()
    pyuff.UFF(str(file)).write_sets([one], "add")
    quell.from_universal_file(file, points={"x": (17, "x")}, **how)
    assert np.abs(saved(tmp_path) / receptance() - 1).max() < 1e-5
    if binary:
        content = file.read_bytes()
        file.write_bytes(content[:-100])
        with pytest.raises(quell.StudyError, match="line 2: the file ends after .* bytes of a binary function"):
            quell.from_universal_file(file, points={"x": (17, "x")}, **how)


def test_units_of_responses(tmp_path: Path) -> None:
    # In mm over mN the numbers are those of m over N; in mm over N they are a thousand times larger.
    for name, force, factor in (("mm (milli-newton)", 1e3, 1.0), ("mm (newton)", 1.0, 1e3)):
        lines = function_58(receptance() * factor, types=(8, 13))
        file = write(tmp_path / "f.uff", units_164(5, name, 1e3, force), lines)
        quell.from_universal_file(
            file, points={"x": (17, "x")}, save=tmp_path / "f.csv", static=STATIC, units="file", contact=pad("x")["contact"]
        )  # fmt: skip
        assert np.abs(saved(tmp_path) / receptance() - 1).max() < 1e-5


def test_scalars_are_named_by_the_caller(tmp_path: Path) -> None:
    file = write(tmp_path / "f.uff", function_58(-receptance() * (2 * np.pi * HERTZ) ** 2, direction=0, types=(1, 0)))
    how: dict[str, Any] = {"save": tmp_path / "f.csv", "static": STATIC, **pad("x", "SI")}
    with pytest.raises(quell.StudyError, match="node 17 .point 1. has direction 0, a scalar.*'H1 / today / Record 1'.*pairs="):
        quell.from_universal_file(file, **how)
    with pytest.raises(quell.StudyError, match="types 1 .'m/s²'. over 0 .'N'., which are no quantities; give quantity"):
        quell.from_universal_file(file, pairs=[("x", "x")], **how)
    quell.from_universal_file(file, pairs=[("x", "x")], quantity="acceleration", **how)
    assert np.abs(saved(tmp_path) / receptance() - 1).max() < 1e-5
    for change, words in [
        ({"pairs": [("x", "x")] * 2}, "each of the 1 frequency responses"),
        ({"pairs": ["x"]}, r"pairs\[0\]"),
        ({"pairs": [("x", "x")], "quantity": "acceleration", "points": {"x": (1, "x")}}, "points: left out"),
        ({"quantity": "force"}, "quantity = force"),
        ({"damping_ratio": 0.1}, "damping_ratio: left out"),
    ]:
        with pytest.raises(quell.StudyError, match=words):
            quell.from_universal_file(file, **{**how, **change})


@pytest.mark.parametrize(("kind", "name"), [(1, "time record"), (2, "auto spectrum"), (6, "coherence"), (9, "power spectral density")])
def test_other_functions_are_named(kind: int, name: str, tmp_path: Path) -> None:
    file = write(tmp_path / "f.uff", function_58(receptance(), kind=kind))
    for content in (None, "responses"):
        with pytest.raises(quell.StudyError, match=f"data set 58 .line 2.: {name} .function type {kind}.; expected"):
            quell.from_universal_file(file, content=content, **pad(units="SI"))  # type: ignore[arg-type]


def test_wrong_functions_are_refused_with_their_line(tmp_path: Path) -> None:
    how: dict[str, Any] = {"points": {"x": (17, "x")}, "save": tmp_path / "f.csv", "static": STATIC, **pad("x", "SI")}
    lines = function_58(receptance(), types=(8, 13))
    for wrong, words in [
        ([*lines[:-2], lines[-1]], "line 26: the function of line 2 ends here with 78 numbers, and 40 points have 80"),
        ([*lines[:13], lines[13].replace("E", "n"), *lines[14:]], "line 14.*finite numbers"),
        (function_58(receptance(), types=(8, 8)), "types 8 .* over 8"),
        ([line.replace("Hz  ", "rad/s") for line in lines], "not over a frequency in Hz"),
        (lines[:6] + lines[-1:], "data set 58 ends before its line 5"),
        ([line.replace("         5        40", "         7        40") for line in lines], "line 9.*type of the ordinate"),
    ]:
        with pytest.raises(quell.StudyError, match=words):
            quell.from_universal_file(write(tmp_path / "f.uff", wrong), **how)


def test_complex_modes_are_written_and_read_again(tmp_path: Path) -> None:
    """The motions of a structure with nodes, and one without."""
    hertz = [12.0, 31.0, 55.0]
    modes = [mode_2414(number, value, 2.0, REAL) for number, value in enumerate(hertz, 1)]
    shapes = [[complex(x * (1 + place) ** number) for place, x in enumerate(SHAPE)] for number in range(3)]
    modes = [mode_2414(number + 1, value, 2.0, shape) for number, (value, shape) in enumerate(zip(hertz, shapes, strict=True))]
    contact = pad(f"n{NODES[0]}_x")["contact"]
    study = quell.from_universal_file(write(tmp_path / "m.unv", *modes), damping_ratio=[0.01, 0.02, 0.03], units="SI", contact=contact)
    path = study.modes().to_universal_file(tmp_path / "out.unv")
    lines = Path(path).read_text().splitlines()
    assert lines[1].strip() == "164" and lines[2].startswith(f"{1:10d}SI")
    again = quell.from_universal_file(path, modal_mass=[2.0] * 3, units="file", contact=contact)
    for mode, value, ratio, shape in zip(again.mode, hertz, [0.01, 0.02, 0.03], shapes, strict=True):
        assert mode.given["frequency"] == pytest.approx(2 * np.pi * value, rel=2e-3)
        assert mode.given["damping_ratio"] == pytest.approx(ratio, rel=0.1)
        found = np.array([mode.given["shape"][f"n{node}_{way}"] for node in NODES for way in "xyz"])
        mac = np.dot(found, np.real(shape)) ** 2 / np.dot(found, found) / np.dot(np.real(shape), np.real(shape))
        assert mac > 0.9999
    with pytest.raises(quell.StudyError, match="a new file"):
        study.modes().to_universal_file(path)
    plain = quell.load(Path(__file__).parents[3] / "studies" / "mode-coupling.toml")
    stability = plain.stability()
    written = Path(stability.to_universal_file(tmp_path / "plain.unv")).read_text().splitlines()
    assert "164" not in written[1] and "node 1 x: x, node 2 x: y" in written[5]
    rate = complex(*(float(written[9][at : at + 13]) for at in (0, 13)))
    assert rate == pytest.approx(stability.eigenvalues[0], rel=1e-5)
    disc = quell.load(Path(__file__).parents[3] / "studies" / "figure-5.3.toml")
    with pytest.raises(quell.StudyError, match="convert"):
        disc.modes().to_universal_file(tmp_path / "disc.unv")


def test_receptances_go_out_and_come_back(tmp_path: Path) -> None:
    hertz, ratio = [300.0, 1250.0, 1800.0], 0.01
    shapes = [[complex(x * (1 + place) ** number) for place, x in enumerate(SHAPE)] for number in range(3)]
    modes = [mode_2414(number + 1, value, 2.0, shape) for number, (value, shape) in enumerate(zip(hertz, shapes, strict=True))]
    first, second = f"n{NODES[0]}_x", f"n{NODES[1]}_y"
    contact = pad(first)["contact"]
    study = quell.from_universal_file(write(tmp_path / "m.unv", *modes), damping_ratio=ratio, units="SI", contact=contact)
    found = study.receptance(outputs=[first, second], inputs=first, contacts="none")
    assert found.receptance.shape == (2, 1, found.points) and found.outputs == [first, second]
    # Resonances are resolved: one with a half-width of 3 Hz has 21 frequencies of its own.
    peaks = np.abs(found.receptance[0, 0])
    near = np.abs(found.frequency / (2 * np.pi * 300.0) - 1.0) < 14 * ratio
    assert near.sum() >= 21 and peaks[near].max() == peaks.max()
    path = found.to_universal_file(tmp_path / "out.unv")
    with pytest.raises(quell.StudyError, match="a new file"):
        found.to_universal_file(path)
    again = quell.from_universal_file(
        path, units="file", points={"a": (NODES[0], "x"), "b": (NODES[1], "y")}, save=tmp_path / "f.csv", contact=pad("a")["contact"]
    )
    assert again.stability().verdict == study.stability().verdict
    rows = np.genfromtxt(tmp_path / "f.csv", delimiter=",", names=True, dtype=None, encoding="utf-8")
    rows = rows[rows["output"] == "b"]
    values = study.receptance(
        outputs=second, inputs=first, contacts="none", at=[f"{one!r}Hz" for one in rows["frequency_hz"].tolist()]
    ).receptance[0, 0]
    assert np.abs((rows["re"] + 1j * rows["im"]) / values - 1.0).max() < 1e-11
    plain = quell.load(Path(__file__).parents[3] / "studies" / "mode-coupling.toml").receptance()
    with pytest.raises(quell.StudyError, match="in hertz"):
        plain.to_universal_file(tmp_path / "plain.unv")


def test_receptances_are_read_by_pyuff(tmp_path: Path) -> None:
    pyuff = pytest.importorskip("pyuff")
    belt = quell.load(Path(__file__).parents[3] / "studies" / "squealing-pad-si.toml")
    found = belt.receptance(frequency=("1Hz", "3kHz"), points=50)
    one = pyuff.UFF(found.to_universal_file(tmp_path / "belt.unv")).read_sets()[-1]
    assert (one["func_type"], one["ordinate_spec_data_type"], one["orddenom_spec_data_type"]) == (4, 8, 13)
    assert one["rsp_ent_name"].strip() == "belt.tange" and one["num_pts"] == 50
    assert one["data"] == pytest.approx(found.receptance[0, 0], rel=1e-4)


def test_few_contacts_stand_for_a_surface() -> None:
    names = ["x", "y", "turn"]
    contacts = [
        quell.Contact(
            name=f"p{k}", tangent={"x": 1.0, "turn": 0.2}, normal={"y": 1.0, "turn": k / 20 - 0.5},
            normal_load=1.5, normal_stiffness=200.0, belt_velocity=0.05,
        )
        for k in range(21)
    ]  # fmt: skip
    study = quell.System(
        coordinates=names, mass=[1.0, 1.0, 0.1], stiffness=[2000.0, 1000.0, 300.0], damping=[0.2, 0.2, 0.02],
        contact=contacts, friction=quell.Coulomb(coefficient=0.4),
    )  # fmt: skip
    with pytest.warns(UserWarning) as said:
        few = study.convert(contacts=6)
    assert any("stand for 21" in str(one.message) for one in said)
    assert len(few.contacts) <= 6
    assert few.stability().growth_rate == pytest.approx(study.stability().growth_rate, abs=1e-5)
    with pytest.raises(quell.StudyError, match="error"):
        study.convert(error=1e-3)
