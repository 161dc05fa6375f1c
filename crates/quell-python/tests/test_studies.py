"""Studies made of objects equal study files, and are rejected with the same complaints."""

from __future__ import annotations

import errno
import inspect
import pickle
import re
from typing import Any

import numpy as np
import pytest
from conftest import BELT, DITHER, STUDIES

import quell
from quell import _quell


def test_objects_and_files_make_the_same_study() -> None:
    made = quell.Belt(**BELT, dither=DITHER)
    text = """
        [belt]
        damping_ratio = 0.005
        normal_load = 1.0
        belt_velocity = 0.05
        [friction]
        law = "stribeck"
        static_coefficient = 0.4
        minimum_coefficient = 0.2857
        reference_velocity = 0.2
        [dither]
        direction = "tangential"
        waveform = "sine"
        amplitude = 0.4
        frequency_ratio = 10.0
    """
    read = quell.Study.from_text(text)
    assert isinstance(read, quell.Belt)
    assert read == made and hash(read) == hash(made)
    assert quell.Study.from_text(made.text) == made
    assert quell.Study.from_toml(text) == quell.load(text) == made
    louder = made.set({"dither.amplitude": 0.5})
    assert made != louder and quell.load(text, {"dither.amplitude": 0.5}) == louder


@pytest.mark.parametrize("path", sorted(STUDIES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_study_of_the_project_is_read(path: Any) -> None:
    study = quell.load(path)
    assert isinstance(study, (quell.Belt, quell.Disc, quell.System))
    assert pickle.loads(pickle.dumps(study)) == study
    assert study.check().facts["ok"] is True


def test_all_complaints_come_at_once_with_key_value_and_advice() -> None:
    with pytest.raises(quell.StudyError) as caught:
        quell.Belt(
            damping_ratio=-1,
            normal_load="heavy",  # type: ignore[arg-type]
            belt_velcity=0.05,  # type: ignore[arg-type]
            friction=quell.Stribeck(static_coefficient=0.2, minimum_coefficient=0.3, reference_velocity=0.2),
            dither=[DITHER, quell.Dither("sideways", "sine", amplitude=1, frequency_ratio=0)],  # type: ignore[arg-type]
            initial="asleep",  # type: ignore[arg-type]
            solver=quell.Solver(tolerance=2.0),
        )
    errors = {error["key"]: error for error in caught.value.errors}
    wanted = {
        "belt.damping_ratio",
        "belt.normal_load",
        "belt.belt_velcity",
        "friction.minimum_coefficient",
        "dither[1].direction",
        "dither[1].frequency_ratio",
        "belt.initial.state",
        "solver.tolerance",
    }
    assert wanted <= set(errors)
    assert errors["belt.damping_ratio"]["value"] == -1
    assert errors["belt.belt_velcity"]["suggestion"] == "belt.belt_velocity" and "belt.belt_velocity" not in errors
    # Lines of a generated text are not reported; lines of a file are.
    assert all(error["line"] is None for error in errors.values())
    assert "line" not in str(caught.value)
    with pytest.raises(quell.StudyError, match="line 2"):
        quell.Study.from_text("schema = 1\nbelt = 3\n")
    assert isinstance(caught.value, ValueError)
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.errors == caught.value.errors and str(again) == str(caught.value)


def test_complaints_are_those_of_the_command_line(cli: Any, tmp_path: Any) -> None:
    path = tmp_path / "wrong.toml"
    path.write_text("schema = 1\n[belt]\ndamping_ratio = -1\n[frition]\n")
    with pytest.raises(quell.StudyError) as caught:
        quell.Study.from_toml(path)
    assert caught.value.errors == cli("check", str(path))["errors"]
    with pytest.raises(quell.StudyError) as caught:
        quell.Study.from_toml(tmp_path / "missing.toml")
    assert caught.value.errors[0]["fault"] == "path"
    missing = caught.value
    assert isinstance(missing, FileNotFoundError) and isinstance(missing, quell.StudyFileNotFoundError)
    assert missing.filename == str(tmp_path / "missing.toml") and missing.errno == errno.ENOENT
    assert str(missing) == missing.errors[0]["message"]
    again = pickle.loads(pickle.dumps(missing))
    assert again.errors == missing.errors and again.filename == missing.filename
    with pytest.raises(quell.StudyError) as caught:
        quell.Study.from_toml(tmp_path)
    assert not isinstance(caught.value, FileNotFoundError)


def belt_in_si(**given: Any) -> quell.Belt:
    """A belt in SI, ω₀ = 10 rad/s."""
    keys: dict[str, Any] = {
        "mass_kg": 2.0,
        "stiffness_n_per_m": 200.0,
        "damping_n_s_per_m": 0.2,
        "normal_force_n": 20.0,
        "belt_velocity_m_per_s": 0.05,
        "friction": quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity_m_per_s=0.2),
        "dither": quell.Dither("tangential", "sine", amplitude_n=80.0, frequency_hz=16.0),
        "initial": (0.01, 0.0),
    }
    return quell.Belt(**{**keys, **given})


def test_a_study_in_si_answers_in_si() -> None:
    belt = belt_in_si()
    end = belt.simulate("1500ms").final
    assert end["time"] == 1.5 and "time_s" not in end
    assert belt.simulate(1.5).final == end
    assert belt.check().unit_system == "SI"


def test_arguments_of_a_study_in_si_are_in_si_or_have_units() -> None:
    belt = belt_in_si()
    assert belt == belt_in_si(initial=quell.Initial(displacement_m=0.01, velocity_m_per_s=0.0))
    with_units = belt_in_si(mass_kg="2000 g", normal_force_n="0.02kN", belt_velocity_m_per_s="0.18 km/h",
                            dither=quell.Dither("tangential", "sine", amplitude_n="0.08kN", frequency_hz="0.016 kHz"))
    assert with_units.settings == belt.settings
    assert belt.set({"belt.normal_force_n": "0.02kN"}).settings == belt.settings
    at = belt.friction([0.02, -0.03])
    assert at.facts == belt.friction(["20mm/s", "-0.03m/s"]).facts
    assert np.allclose(at.slip_velocity, [0.02, -0.03], rtol=1e-15)
    near = belt.orbit(near=(0.02, 0.05))
    assert near.facts == belt.orbit(near=("20mm", "5cm/s")).facts
    found = belt.thresholds("dither.amplitude_n", 70, 90, start=(0.02, 0.05), ramp=0.5)
    same = belt.thresholds("dither.amplitude_n", "0.07kN", "90 N", start=("2cm", 0.05), ramp="500ms")
    assert found.facts == same.facts and found.from_ == pytest.approx(70)
    for call, key in (
        (lambda: belt.simulate("5N"), "until"),
        (lambda: belt.orbit(near=("1s", 0)), "near"),
        (lambda: belt.thresholds("dither.amplitude_n", "5m", 90), "from_"),
        (lambda: quell.Belt(**BELT, dither=DITHER).simulate("5s"), "until"),
    ):
        with pytest.raises(quell.StudyError) as caught:
            call()
        assert caught.value.errors[0]["key"] == key


def test_datasets_are_in_the_units_of_the_study() -> None:
    belt = belt_in_si()
    run = belt.simulate(1.5).dataset
    assert float(run["time"][-1]) == 1.5 and run["time"].attrs["units"] == "s"
    assert run["velocity"].attrs["units"] == "m/s" and run["displacement"].attrs["units"] == "m"
    assert float(run["final_time"]) == 1.5 and run["final_time"].attrs["units"] == "s"
    orbit = belt.orbit()
    assert orbit.dataset["velocity"].attrs["units"] == "m/s"
    assert orbit.lowest < orbit.highest and orbit.lowest_velocity < orbit.highest_velocity
    for verb in (run, orbit.dataset, belt.friction().dataset, belt.stability().dataset, belt.response().dataset):
        units = {it.attrs["units"] for it in verb.variables.values() if "units" in it.attrs}
        assert not any("length" in unit or "ω" in unit or "(" in unit for unit in units), units


def test_a_belt_may_give_its_natural_frequency() -> None:
    hertz = 10.0 / (2.0 * np.pi)
    belt = belt_in_si(stiffness_n_per_m=None, damping_n_s_per_m=None, natural_frequency_hz=hertz, damping_ratio=0.005)
    assert belt.simulate(1.5).final["time"] == 1.5
    with pytest.raises(quell.StudyError, match="not both"):
        belt_in_si(natural_frequency_hz=hertz)


def test_a_belt_may_name_a_band_of_frequencies() -> None:
    solver = quell.Solver(settle=60.0, record_periods=60)
    response = quell.Belt(**BELT, dither=DITHER, solver=solver, band=(0.5, 0.9)).response()
    level = 20 * np.log10(response.band_displacement_rms / response.band_undithered_displacement_rms)
    assert response.band_displacement_level_db == pytest.approx(level)
    with pytest.raises(quell.StudyError, match="the study is dimensionless"):
        quell.Belt(**BELT, band_hz=(100, 200))


def test_numpy_numbers_are_numbers() -> None:
    one = quell.Belt(**{**BELT, "belt_velocity": np.float64(0.05), "normal_load": np.int64(1)}, dither=DITHER)
    assert one == quell.Belt(**BELT, dither=DITHER)
    assert one.set({"dither.amplitude": np.float32(0.5)}).settings["dither.amplitude"] == 0.5


def test_changes_are_those_of_set() -> None:
    belt = quell.Study.from_toml(STUDIES / "stribeck-belt.toml", set={"belt.belt_velocity": 0.1})
    assert belt.changes == ["belt.belt_velocity=0.1"]
    again = belt.set({"dither.waveform": "square"})
    assert again.changes == ["belt.belt_velocity=0.1", 'dither.waveform="square"']
    assert again.settings["dither.waveform"] == "square"
    with pytest.raises(quell.StudyError, match="did you mean belt.belt_velocity"):
        belt.set({"belt.belt_velcity": 1})
    with pytest.raises(quell.StudyError, match="set"):
        belt.set("belt.belt_velocity=1")  # type: ignore[arg-type]


def parameters(cls: type) -> set[str]:
    """Keyword arguments of a class."""
    found = inspect.signature(cls).parameters.values()
    return {it.name for it in found if it.name != "self" and it.kind is not it.VAR_KEYWORD}


def keys(table: str) -> set[str]:
    """Keys of a table of study files; those of a system are in the schema alone."""
    found = {key for _, section, key, _, _ in _quell.keys() if section == table}
    return found or set(quell.schema()["$defs"][table]["properties"])


@pytest.mark.parametrize(
    ("cls", "table", "also"),
    [
        (
            quell.Belt,
            "belt",
            {"friction", "dither", "initial", "drive", "load", "solver", "design", "actuator", "uncertainty", "axes", "title"} | keys("response"),
        ),
        (quell.Initial, "belt.initial", set()),
        (quell.Dither, "dither", {"envelope"}),
        (quell.Solver, "solver", set()),
        (quell.Disc, "disc", {"friction", "dither", "mode", "load", "drive", "design", "uncertainty", "axes", "title"}),
        (quell.Mode, "disc.mode", set()),
        (quell.Load, "disc.load", {"envelope"}),
        (quell.System, "system", {"contact", "friction", "dither", "parameters", "design", "actuator", "uncertainty", "axes", "title"}),
        (quell.SystemMode, "system_mode", set()),
        (quell.Component, "system_component", set()),
        (quell.SystemInitial, "system_initial", set()),
        (quell.Contact, "contact", set()),
        (quell.SystemDither, "dither", {"at", "contact", "reaction", "mean", "envelope"}),
    ],
)
def test_classes_have_the_keys_of_their_tables(cls: type, table: str, also: set[str]) -> None:
    assert parameters(cls) == keys(table) | also


def test_every_law_has_a_class_with_its_parameters() -> None:
    classes = {
        cls.__name__.lower(): cls
        for cls in vars(quell).values()
        if isinstance(cls, type) and issubclass(cls, quell.Friction) and cls not in (quell.Friction, quell.StudyFriction, quell.SampledLaw)
    }
    laws: dict[str, set[str]] = {}
    for law in quell.schema()["$defs"]["friction"]["oneOf"]:
        name = law["properties"]["law"]["const"].replace("-", "")
        laws.setdefault(name, set()).update(set(law["properties"]) - {"law"})
    assert set(classes) == set(laws)
    for name, wanted in laws.items():
        assert parameters(classes[name]) == wanted, name


def test_laws_of_one_s_own_take_formulas_and_arrays() -> None:
    belt = {**BELT, "friction": quell.Expression("a + b*exp(-abs(v)/0.2)", constants={"a": 0.3, "b": 0.1})}
    formula = quell.Belt(**belt, dither=DITHER)
    speed = np.linspace(0.0, 1.0, 60)
    exact = 0.3 + 0.1 * np.exp(-speed / 0.2)
    measured = quell.Belt(**{**BELT, "friction": quell.Samples(speed, exact)}, dither=DITHER)
    built_in = quell.Decreasing(static_coefficient=0.4, minimum_coefficient=0.3, reference_velocity=0.2)
    known = quell.Belt(**{**BELT, "friction": built_in}, dither=DITHER)
    at = np.array([0.01, 0.1, 0.5])
    wanted = known.friction(at)
    for study, allowed in ((formula, 1e-12), (measured, 1e-4)):
        found = study.friction(at)
        assert np.allclose(found.coefficient, wanted.coefficient, rtol=0, atol=allowed)
        assert np.allclose(found.effective_coefficient, wanted.effective_coefficient, rtol=0, atol=allowed)
        assert pickle.loads(pickle.dumps(study)) == study
    steeper = formula.set({"friction.constants.b": 0.2})
    assert steeper.friction([1e-9]).coefficient[0] == pytest.approx(0.5, abs=1e-6)
    with pytest.raises(quell.StudyError, match="friction"):
        quell.Belt(**{**BELT, "friction": quell.Expression("0.3 + 0.1*exq(-v)")}, dither=DITHER)


def test_friction_of_a_drive_is_given_in_newtons_and_ranges_are_told() -> None:
    drive = quell.Belt(
        mass_kg=0.538,
        stiffness_n_per_m=6957.0,
        damping_n_s_per_m=5.746,
        belt_velocity_m_per_s=0.05,
        friction=quell.StribeckExponential(
            friction_force_n=2.0,
            static_friction_force_n=6.0,
            reference_velocity_m_per_s=0.1,
            exponent=1.0,
            viscous_n_s_per_m=0.2,
        ),
    )
    assert drive.check().facts["contacts"][0]["friction"]["friction_force"] == pytest.approx(2.0)
    bands = drive.stability().facts["unstable_surface_velocities"]
    assert bands[0]["upper"] == pytest.approx(0.190616072953803, rel=1e-9)
    coulomb = quell.Belt(**{**BELT, "friction": quell.Coulomb(0.3, static_coefficient=0.4)})
    assert coulomb.friction([0.2]).warnings == []
    fast = quell.Belt(**{**BELT, "belt_velocity": 3.0})
    assert "range" in fast.stability().warnings[0]
    formula = quell.Expression("0.4 - 0.1*abs(v)", maximum_velocity=5.0)
    with pytest.raises(quell.StudyError, match="maximum velocity 5"):
        quell.Belt(**{**BELT, "friction": formula})


def test_axes_of_a_map_take_the_place_of_the_study_s_own() -> None:
    belt = quell.Belt(**BELT, dither=DITHER, axes={"dither.amplitude": [0.1, 0.2]})
    other = belt.sweeping([quell.Axis("belt.belt_velocity", 0.01, 0.1, 3, spacing="log")])
    assert [axis["parameter"] for axis in other.check().facts["sweeps"]] == ["belt.belt_velocity"]
    assert pickle.loads(pickle.dumps(other)).check().facts == other.check().facts
    with pytest.raises(quell.StudyError) as caught:
        belt.sweeping({"dither.amplitude": [0.1, -0.2], "belt.belt_velcity": np.linspace(0, 1, 3)})
    assert {error["key"] for error in caught.value.errors} >= {"sweep[1].parameter"}
    with pytest.raises(quell.StudyError, match="axes"):
        belt.map("residual-vibration", 3)  # type: ignore[arg-type]


def test_a_verb_about_the_other_kind_of_study_says_so(belt: quell.Belt, disc: quell.Disc) -> None:
    for refused in (disc.response, disc.friction, disc.orbit, disc.waveforms):
        with pytest.raises(quell.StudyError, match="is not available for a"):
            refused()
    assert len(belt.modes().facts["modes"]) == 1 and belt.resonances().facts["ok"]


def test_the_numbers_of_a_study_are_attributes(belt: quell.Belt, disc: quell.Disc) -> None:
    assert belt.belt_velocity == 0.05 and belt.dither is not None and belt.dither.amplitude == 0.4
    assert belt.dither == DITHER and belt.dithers == (DITHER,) and belt.dither.phase is None
    assert belt.friction.static_coefficient == 0.4 and belt.friction.law == "stribeck"
    assert belt.friction == BELT["friction"] and isinstance(belt.friction([0.1]), quell.results.FrictionCurve)
    assert belt.solver.settle == 60.0 and belt.initial.state == "rest" and belt.mass_kg is None
    assert eval(repr(belt.friction)) == belt.friction and eval(repr(belt.dither)) == belt.dither and {"static_coefficient", "law"} <= set(dir(belt.friction))
    assert pickle.loads(pickle.dumps(belt.friction)) == belt.friction
    assert disc.load is not None and disc.load.radius_ratio == 0.75 and disc.radial_modes == 1 and disc.inner_radius_ratio == 0.5
    assert belt.settings["dither.amplitude"] == 0.4 and belt.settings["friction.law"] == "stribeck"
    assert {"belt_velocity", "dither", "response"} <= set(dir(belt))
    for wrong, words in (
        (lambda: belt.belt_velcity, "Belt has no belt_velcity; did you mean belt_velocity?"),
        (lambda: belt.respone, "did you mean response?"),
        (lambda: belt.dither.amplitud, "Dither has no amplitud; did you mean amplitude?"),
        (lambda: belt.friction.static_coeficient, "did you mean static_coefficient?"),
        (lambda: disc.load.radius_rato, "did you mean radius_ratio?"),
    ):
        with pytest.raises(AttributeError, match=re.escape(words)):
            wrong()
    two = quell.Study.from_toml(STUDIES / "two-dithers.toml")
    assert isinstance(two, quell.Belt) and [it.direction for it in two.dithers] == ["tangential", "normal"]
    with pytest.raises(quell.StudyError, match=r"dithers\[0\], …: this study has 2 dithers"):
        _ = two.dither


def test_the_contacts_of_a_system_are_attributes() -> None:
    system = quell.Study.from_toml(STUDIES / "mode-coupling.toml")
    assert isinstance(system, quell.System)
    pad = system.contacts["pad"]
    assert pad.friction.coefficient == 0.9 and pad.tangent == {"x": 1} and system.contacts[0] == pad
    assert system.coordinates == ["x", "y"] and system.parameters == {"c": 0.05} and system.damping == ["c", "c"]
    with pytest.raises(KeyError, match="did you mean pad?"):
        _ = system.contacts["pat"]
    shared = quell.System(
        coordinates=["x"], mass=[1], damping=[0.1], stiffness=[1], friction=quell.Coulomb(0.3),
        contact=quell.Contact(tangent={"x": 1}, normal_load=1, belt_velocity=1), dither=quell.SystemDither({"x": 1}, "sine", amplitude=1, frequency=9),
    )  # fmt: skip
    assert shared.contacts["1"].friction.coefficient == 0.3 == shared.friction.coefficient
    assert shared.dither is not None and shared.dither.at == {"x": 1} and len(shared.contacts) == 1


def test_a_study_is_replaced_by_its_arguments(belt: quell.Belt, disc: quell.Disc) -> None:
    faster = belt.replace(belt_velocity=0.1)
    assert faster.settings == belt.set({"belt.belt_velocity": 0.1}).settings and faster.title == "a belt" and not faster.changes
    assert belt.dither is not None
    louder = belt.replace(dither=belt.dither.replace(amplitude=0.5))
    assert louder.dither is not None and louder.dither.amplitude == 0.5 and louder.dither.waveform == "sine"
    assert belt.replace(dither=None).dither is None and belt.replace(friction=quell.Coulomb(0.3)).friction.coefficient == 0.3
    assert belt.replace(friction=belt.friction).settings == belt.settings
    with pytest.raises(quell.StudyError, match="did you mean belt.belt_velocity"):
        belt.replace(belt_velcity=1)
    assert disc.replace(radial_modes=2).radial_modes == 2


@pytest.mark.parametrize("path", sorted(STUDIES.glob("*.toml")), ids=lambda path: path.stem)
def test_studies_survive_replacing_and_writing(path: Any, tmp_path: Any) -> None:
    study = quell.Study.from_toml(path)
    assert study.replace().settings == study.settings
    assert study.replace().check().facts == study.check().facts
    assert study.to_toml() == path.read_text("utf-8")
    text = study.to_toml(tmp_path / "copy.toml")
    copy = quell.Study.from_toml(tmp_path / "copy.toml")
    assert (tmp_path / "copy.toml").read_text("utf-8") == text
    named = {"friction.file", "system.modes", "disc.modes_file", "system.frequency_response"}
    assert {k: v for k, v in copy.settings.items() if k not in named} == {k: v for k, v in study.settings.items() if k not in named}


def test_a_changed_study_is_written_with_its_changes(belt: quell.Belt, tmp_path: Any) -> None:
    axes = {"dither.amplitude": [0.1, 0.2]}
    changed = belt.set({"belt.belt_velocity": 0.1, "dither.waveform": "square"}).sweeping(axes)
    again = quell.Study.from_text(changed.to_toml())
    assert again.settings == changed.settings and again.title == "a belt"
    assert again.check().facts["sweeps"] == changed.check().facts["sweeps"]
    assert changed.replace().check().facts["sweeps"] == changed.check().facts["sweeps"]
    assert changed.to_toml(tmp_path / "belt.toml") == changed.to_toml()
    with pytest.raises(quell.StudyError, match="overwrite=True"):
        changed.to_toml(tmp_path / "belt.toml")
    assert belt.to_toml(tmp_path / "belt.toml", overwrite=True) == belt.text
    with pytest.raises(quell.StudyError, match="can be written"):
        belt.to_toml(tmp_path / "nowhere" / "belt.toml")


def test_misspelt_arguments_name_the_nearest(belt: quell.Belt) -> None:
    anyhow: Any = belt
    for call, words in (
        (lambda: anyhow.simulate(untill=3), "simulate() got an unexpected keyword argument 'untill'; did you mean until?"),
        (lambda: anyhow.friction(att=[0.1]), "did you mean at?"),
        (lambda: anyhow.thresholds("dither.amplitude", 0.3, 0.6, from_resst=True), "did you mean from_rest?"),
        (lambda: quell.new(qestion="drive"), "did you mean question?"),  # type: ignore[call-arg]
        (lambda: quell.Study.from_toml("x.toml", sett={}), "did you mean set?"),  # type: ignore[call-arg]
        (lambda: quell.sweep(belt, "growth", thread=1), "did you mean threads?"),
        (lambda: anyhow.check(3), "takes 1 positional argument"),
    ):
        with pytest.raises(TypeError, match=re.escape(words)):
            call()
