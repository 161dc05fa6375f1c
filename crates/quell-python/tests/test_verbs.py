"""Python has everything that the command line has, under the same names and with the same answers."""

from __future__ import annotations

import inspect
import re
import subprocess
from typing import Any

import pytest
from conftest import STUDIES, command

import quell

ELSEWHERE = {
    "--help": "help(quell)",
    "--version": "quell.__version__",
    "--set": "Study.set, and set= of Study.from_toml",
    "--tolerance": 'study.set({"solver.tolerance": …})',
    "--at-time": "Study.at_time",
    "--json": "Result.facts, Result.to_dict",
    "--plot": "Result.plot, Result.save",
    "--save": "Result.save, and store= of Study.map",
    "--bibtex": "Citations.bibtex",
}
"""Options whose equivalent belongs to every result or study in Python, and that equivalent."""

OF_PICTURES = {
    "--width": "width= of Result.plot and Result.save",
    "--caption": "caption= of Result.plot and Result.save",
    "--no-title": "title= of Result.plot and Result.save",
}
"""The same for the options of `--plot`."""

OTHER_NAMES = {"--from": "from_", "--no-title": "title"}
"""Options whose name is a keyword of Python or a negation."""

DRAWINGS = {"sketch", "report"}
"""Verbs whose answer is a file; Python returns its text, and `--out` is the argument `path`."""

CONVERSIONS = {"convert"}
"""Verbs whose answer is a study."""

BESIDE = {
    "quell.sweep",
    "quell.quantities",
    "quell.fit_decay",
    "quell.fit_laws",
    "quell.from_abaqus",
    "quell.from_ansys",
    "quell.from_nastran",
    "quell.from_universal_file",
    "quell.load",
}
"""Functions that only Python has: about axes and names of maps, the fits whose results have arrays, files, and those of other programs."""

FITS = {"fit_record"}
"""Methods that are an option of a verb of the command line."""


def offered() -> dict[str, Any]:
    """Verbs in Python: methods that return a result, and functions of the package."""
    members = inspect.getmembers(quell.Study, inspect.isfunction)
    # The law of a study is an attribute, and called it is the verb.
    members.append(("friction", quell.StudyFriction.__call__))
    verbs = {
        name: method
        for name, method in members
        if name not in FITS and (name in DRAWINGS | CONVERSIONS or (not name.startswith("_") and "results." in str(method.__annotations__.get("return"))))
    }
    functions = {
        name: it for name, it in vars(quell).items() if inspect.isfunction(it) and name in quell.__all__
    }
    return {**verbs, **{name: it for name, it in functions.items() if f"quell.{name}" not in BESIDE}}


def help_of(*arguments: str) -> str:
    """The output of --help."""
    done = subprocess.run([command(), *arguments, "--help"], capture_output=True, text=True, check=True)
    return done.stdout


def verbs_of_the_command_line() -> list[str]:
    """Verbs as --help lists them, in groups before the options; completion is only for shells."""
    listed = help_of().split("Options:\n")[0]
    found = re.findall(r"^  (\w+) ", listed, flags=re.MULTILINE)
    return [verb for verb in found if verb != "completions"]


def test_the_verbs_are_the_same() -> None:
    assert sorted(offered()) == sorted(verbs_of_the_command_line())


@pytest.mark.parametrize("verb", sorted(offered()))
def test_the_options_are_the_same(verb: str) -> None:
    options = set(re.findall(r"^\s+(?:-\w, )?(--[a-z-]+)", help_of(verb), flags=re.MULTILINE))
    elsewhere = {**ELSEWHERE, **OF_PICTURES} if "--plot" in options else ELSEWHERE
    names = {**OTHER_NAMES, "--out": "path"} if verb in DRAWINGS else OTHER_NAMES
    wanted = {names.get(it, it[2:].replace("-", "_")) for it in options - set(elsewhere)}
    given = set(inspect.signature(offered()[verb]).parameters) - {"self"}
    python_only = {
        "map": {"axes", "store", "progress", "client"},
        "simulate": {"samples", "sound", "t_eval"},
        "bifurcation": {"progress"},
        "basins": {"progress"},
        "probability": {"progress"},
        "reproduce": {"names", "set"},
        "new": {"question", "save"},
        "fit": {"data"},
        "compare": {"measured"},
    }
    assert wanted <= given, f"Python lacks {wanted - given}"
    assert given - wanted <= python_only.get(verb, set()), f"the command line lacks {given - wanted}"


BELT = str(STUDIES / "stribeck-belt.toml")
SI = str(STUDIES / "squealing-pad-si.toml")
DISC = str(STUDIES / "which-dither-frequency.toml")
QUICK = {"solver.settle": 100, "solver.record_periods": 10}
CASES: list[tuple[str, str, list[str], Any]] = [
    ("check", BELT, [], lambda study: study.check()),
    ("check", DISC, [], lambda study: study.check()),
    ("cite", BELT, [], lambda study: study.cite()),
    ("friction", BELT, ["--at", "0.05,0,0.1"], lambda study: study.friction([0.05, 0.0, 0.1])),
    ("friction", SI, [], lambda study: study.friction()),
    ("friction", BELT, ["--describing", "0.2"], lambda study: study.friction(describing=0.2)),
    ("waveforms", BELT, [], lambda study: study.waveforms()),
    ("design", str(STUDIES / "design.toml"), [], lambda study: study.design()),
    ("actuator", str(STUDIES / "actuator.toml"), [], lambda study: study.actuator()),
    ("actuator", str(STUDIES / "actuator.toml"), ["--frequency", "15kHz:30kHz"],
        lambda study: study.actuator(frequency=("15kHz", "30kHz"))),
    ("probability", str(STUDIES / "probability.toml"), ["--samples", "100"], lambda study: study.probability(samples=100)),
    ("stability", BELT, [], lambda study: study.stability()),
    ("stability", SI, [], lambda study: study.stability()),
    ("stability", DISC, [], lambda study: study.stability()),
    ("simulate", BELT, ["--until", "20", "--events"], lambda study: study.simulate(20)),
    ("response", BELT, ["--set", "solver.settle=100", "--set", "solver.record_periods=10"],
     lambda study: study.set(QUICK).response()),
    ("orbit", BELT, [], lambda study: study.orbit()),
    ("attractor", BELT, ["--start", "0.1,0"], lambda study: study.attractor(start=(0.1, 0.0))),
    ("attractor", BELT, ["--lyapunov", "--settle", "50", "--record", "500"],
     lambda study: study.attractor(lyapunov=True, settle=50, record=500)),
    ("thresholds", BELT, ["--parameter", "dither.amplitude", "--from", "0.3", "--to", "0.6"],
     lambda study: study.thresholds("dither.amplitude", 0.3, 0.6)),
    ("thresholds", SI, ["--parameter", "dither.amplitude_n", "--from", "5500", "--to", "6000"],
     lambda study: study.thresholds("dither.amplitude_n", 5500, 6000)),
    ("thresholds", BELT, ["--parameter", "dither.amplitude", "--from", "0.45", "--to", "0.55", "--along",
      "belt.belt_velocity", "--between", "0.045:0.055"],
     lambda study: study.thresholds("dither.amplitude", 0.45, 0.55, along="belt.belt_velocity", between=(0.045, 0.055))),
    ("bifurcation", BELT, ["--parameter", "dither.amplitude", "--from", "0.45", "--to", "0.55", "--points", "3", "--up"],
     lambda study: study.bifurcation("dither.amplitude", 0.45, 0.55, points=3, up=True)),
    ("basins", BELT, ["--displacement", "0:0.5", "--velocity", "-0.2:0.2", "--grid", "4x3"],
     lambda study: study.basins(displacement=(0, 0.5), velocity=(-0.2, 0.2), grid=(4, 3))),
    ("compare", str(STUDIES / "measured-belt.toml"), [str(STUDIES / "synthetic-squeal.csv"), "--after", str(STUDIES / "synthetic-quenched.csv")],
     lambda study: study.compare(STUDIES / "synthetic-squeal.csv", after=STUDIES / "synthetic-quenched.csv")),
    ("modes", DISC, [], lambda study: study.modes()),
    ("receptance", str(STUDIES / "mode-coupling.toml"), ["--outputs", "x,pad.normal", "--at", "0.5,1"],
     lambda study: study.receptance(outputs=["x", "pad.normal"], at=[0.5, 1.0])),
    ("resonances", DISC, ["--speeds", "0:0.9"], lambda study: study.resonances(speeds=(0, 0.9))),
]  # fmt: skip


@pytest.mark.parametrize(("verb", "path", "options", "call"), CASES, ids=lambda it: it if isinstance(it, str) else "")
def test_the_answers_are_the_same(verb: str, path: str, options: list[str], call: Any, cli: Any) -> None:
    answer = call(quell.Study.from_toml(path))
    assert answer.facts == cli(verb, path, *options)
    assert answer.facts["warnings"] == answer.warnings


def test_cases_are_of_every_verb_of_a_study() -> None:
    functions = {"schema", "new", "reproduce", "map", "fit", *DRAWINGS, *CONVERSIONS}
    assert {case[0] for case in CASES} == set(offered()) - functions


def test_the_schema_is_the_same(cli: Any) -> None:
    assert quell.schema() == cli("schema")


def test_a_fit_is_the_same(cli: Any) -> None:
    data = str(STUDIES / "synthetic-friction.csv")
    assert quell.fit(data, law=["stribeck", "coulomb"]) == cli("fit", data, "--law", "stribeck", "--law", "coulomb")
    found = quell.fit_laws(data, law=["stribeck", "coulomb"])
    assert found.facts == quell.fit(data, law=["stribeck", "coulomb"])
    assert found.study is None and found.tables["friction"].startswith("[friction]")
    assert len(found["points_point_residual"]) == found.n and len(found.plot().axes) >= 1
    with pytest.raises(quell.StudyError, match="stribeck"):
        quell.fit(data, law="stribek")
    with pytest.raises(quell.StudyError, match="gain"):
        quell.fit(data, gain=2.0)


def test_fits_of_records_are_the_same(cli: Any) -> None:
    decay = str(STUDIES / "synthetic-decay.csv")
    one = cli("fit", decay, "--decay", "--law", "viscous")
    assert quell.fit_decay(decay, law="viscous").facts == one == quell.fit(decay, decay=True, law="viscous")
    record, study = str(STUDIES / "synthetic-squeal.csv"), str(STUDIES / "measured-belt.toml")
    free = ["friction.static_coefficient", "record.shift"]
    quiet = "dither.amplitude_n=0"
    other = cli("fit", record, "--record", "--study", study, "--free", ",".join(free), "--fix", quiet)
    assert quell.Study.from_toml(study).fit_record(record, free=free, fix=quiet).facts == other
    assert quell.fit(record, record=True, study=study, free=free, fix=quiet) == other


def test_a_new_study_is_the_same(cli: Any, tmp_path: Any) -> None:
    assert quell.new() == cli("new")
    made = quell.new("drive")
    assert made == cli("new", "drive")
    assert quell.Study.from_text(made["text"]).check().unit_system == "SI"
    path = tmp_path / "drive.toml"
    assert quell.new("drive", save=path)["saved"] == str(path)
    with pytest.raises(quell.StudyError, match="overwrite"):
        quell.new("quench", save=path)
    assert path.read_text(encoding="utf-8") == made["text"]
    with pytest.raises(quell.StudyError, match="did you mean quench"):
        quell.new("quenhc")
    with pytest.raises(quell.StudyError, match="name of a question"):
        quell.new(save=path)


def test_bibtex_is_the_same() -> None:
    printed = subprocess.run([command(), "cite", BELT, "--bibtex"], capture_output=True, text=True, check=True).stdout
    assert quell.Study.from_toml(BELT).cite().bibtex == printed
    assert "@phdthesis{michaux2005," in printed


def test_a_map_is_the_same(cli: Any) -> None:
    study = quell.Study.from_toml(BELT)
    axes = ["--set", "sweep[0].parameter=dither.amplitude", "--set", "sweep[0].values=[0.1, 0.3, 0.9]"]
    axes += ["--set", "sweep[1].parameter=belt.belt_velocity", "--set", "sweep[1].values=[0.05, 0.2]"]
    there = cli("map", BELT, "--quantity", "growth,verdict,critical-amplitude", *axes)
    asked = ["growth", "verdict", "critical-amplitude"]
    here = study.map(asked, {"dither.amplitude": [0.1, 0.3, 0.9], "belt.belt_velocity": [0.05, 0.2]})
    assert here["growth"].values.tolist() == there["growth"]
    assert here.words("verdict").tolist() == there["verdict"]
    assert here.words("growth_status").tolist() == there["growth_status"]
    assert {name: value for name, value in there.items() if name in here.facts} == here.facts


def test_a_sound_is_the_same(cli: Any, tmp_path: Any) -> None:
    study = quell.Study.from_toml(BELT)
    options = ["--until", "500", "--transpose", "2", "--gain", "4.5"]
    there = cli("simulate", BELT, *options, "--save", str(tmp_path / "cli.wav"))
    here = study.simulate(500, events=False, transpose=2, gain=4.5)
    assert here.sound == there["sound"] and here.sentence == there["sentence"]
    assert here.save(tmp_path / "python.wav") == [str(tmp_path / "python.wav")]
    assert (tmp_path / "python.wav").read_bytes() == (tmp_path / "cli.wav").read_bytes()
    assert float(here.arrays["sound_gain"].values) == 4.5
    # Without options the file has the default ones.
    plain = study.simulate(500)
    assert "sound" not in plain.facts
    plain.save(tmp_path / "plain.wav")
    study.simulate(500, sound=True).save(tmp_path / "asked.wav")
    assert (tmp_path / "plain.wav").read_bytes() == (tmp_path / "asked.wav").read_bytes()


def test_reproduce_writes_the_same_files(cli: Any, tmp_path: Any) -> None:
    quell.reproduce("2.2", out=tmp_path / "python")
    cli("reproduce", "2.2", "--out", str(tmp_path / "cli"))
    names = sorted(path.name for path in (tmp_path / "python").iterdir())
    assert names and names == sorted(path.name for path in (tmp_path / "cli").iterdir())
    # Reports contain the run time, and the order of the objects in a PDF is arbitrary.
    for name in (it for it in names if it.startswith("figure") and not it.endswith(".pdf")):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "cli" / name).read_bytes()
    with pytest.raises(quell.StudyError, match="2.3"):
        quell.reproduce("2.33", out=tmp_path)


@pytest.mark.parametrize("path", [BELT, DISC, str(STUDIES / "two-mass-drive.toml")])
def test_a_sketch_is_the_same(cli: Any, tmp_path: Any, path: str) -> None:
    study = quell.Study.from_toml(path)
    by_command, by_python = tmp_path / "command.svg", tmp_path / "python.svg"
    facts = cli("sketch", path, "--out", str(by_command), "--width", "85mm")
    assert facts["saved"] == [str(by_command)]
    assert study.sketch(by_python, width="85mm") == by_python.read_text() == by_command.read_text()
    study.sketch(tmp_path / "sketch.pdf")
    assert (tmp_path / "sketch.pdf").read_bytes().startswith(b"%PDF")
    for wrong in ("85", "1mm", "wide"):
        with pytest.raises(quell.StudyError, match="width"):
            study.sketch(width=wrong)
    with pytest.raises(quell.StudyError, match="path"):
        study.sketch(tmp_path / "sketch.gif")


@pytest.mark.parametrize("path", [BELT, DISC])
def test_a_report_is_the_same(cli: Any, tmp_path: Any, path: str) -> None:
    study = quell.Study.from_toml(path)
    by_command, by_python = tmp_path / "command.html", tmp_path / "python.html"
    facts = cli("report", path, "--out", str(by_command), "--without", "stability")
    assert "stability" not in {answer["verb"] for answer in facts["answers"]}
    assert study.report(by_python, without=["stability"]) == by_python.read_text() == by_command.read_text()
    with pytest.raises(quell.StudyError, match="without"):
        study.report(without=["basins"])
    with pytest.raises(quell.StudyError, match="path"):
        study.report(tmp_path / "report.pdf")
