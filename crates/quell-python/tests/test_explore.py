"""The explorer without a browser: sliders, state, undo, sharing, lanes of requests, answers, the server and its refusals."""

from __future__ import annotations

import base64
import http.client
import importlib
import math
import os
import pickle
import socket
import subprocess
import sys
import threading
import time
import wave
import zlib
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import STUDIES, command

import quell
from quell.explore import _answers, _link, _maps, _measured, _numbers, _other_law, _questions, _reading, _share, _sound, _spectra, _state, _zoo
from quell.explore._freshness import Freshness
from quell.explore._lanes import Event, Here, Lane, Process

BELT = STUDIES / "stribeck-belt.toml"
FILES = sorted(path.name for path in STUDIES.glob("*.toml") if "figure-4" not in path.name and "figure-2.1" not in path.name)


def of(name: str) -> quell.Study:
    return quell.Study.from_toml(STUDIES / name)


def state_of(path: Path) -> _state.State:
    return _state.State(*_state.opened(path))


# Sliders.


@pytest.mark.parametrize("name", FILES)
def test_every_number_of_a_study_has_a_slider_that_reaches_its_value(name: str) -> None:
    study = of(name)
    found = _numbers.knobs(study)
    paths = {it.path for it in found} | {it.twin for it in found}
    numbers = {
        path
        for path, value in study.settings.items()
        if isinstance(value, (int, float)) and not isinstance(value, bool) and path != "schema" and not path.startswith(("design.", "actuator."))
    }  # [design] and [actuator] ask a question about the study.
    assert numbers <= paths, numbers - paths
    for one in found:
        grid = one.grid()
        assert one.value in grid and grid == sorted(grid) and one.start <= one.value <= one.stop, one
        assert all(one.allows(it) for it in grid) and all(math.isfinite(it) for it in grid), one
        assert not one.logarithmic or one.start > 0.0


@pytest.mark.parametrize("name", ["stribeck-belt.toml", "squealing-pad-si.toml", "figure-5.3.toml", "mode-coupling.toml", "drill-string.toml"])
def test_the_ends_of_a_slider_are_valid_numbers_of_the_schema(name: str) -> None:
    study = of(name)
    for one in _numbers.knobs(study):
        for end in (one.grid()[0], one.grid()[-1]):
            try:
                study.set({one.path: one.given(end)})
            except quell.StudyError as refused:
                # A relation between numbers may refuse it, but not the bound of the number itself.
                assert not any(it["fault"] == "value" and "finite number" in it["message"] and one.path == it["key"] for it in refused.errors)


def test_units_and_scales_are_those_of_the_registry() -> None:
    found = {it.path: it for it in _numbers.knobs(of("squealing-pad-si.toml"))}
    assert found["dither.amplitude_n"].unit == "N" and found["belt.belt_velocity_m_per_s"].unit == "m/s"
    assert found["belt.stiffness_n_per_m"].unit == "N/m" and found["belt.damping_n_s_per_m"].unit == "N·s/m"
    assert found["belt.mass_kg"].logarithmic and not found["belt.belt_velocity_m_per_s"].logarithmic
    scaled = {it.path: it for it in _numbers.knobs(of("stribeck-belt.toml"))}
    assert scaled["belt.normal_load"].unit == "length (force/k)" and scaled["friction.static_coefficient"].unit == ""
    load = {it.path: it for it in _numbers.knobs(of("drill-string.toml"))}["contact[0].normal_load"]
    own = {one.path: one for one in _numbers.knobs(of("own-friction-law.toml"))}["friction.constants.mu_s"]
    assert (own.label, own.unit) == ("mu s", ""), "a name that a study gives has no unit"
    assert load.unit == "kN" and load.given(50.0).__class__ is str and "kN" in str(load.given(50.0))


def test_an_axis_of_the_study_is_the_range_of_its_slider() -> None:
    speed = {it.path: it for it in _numbers.knobs(of("figure-5.3.toml"))}["disc.load.speed"]
    assert (speed.start, speed.stop, speed.logarithmic) == (0.02, 1.0, True)


def test_elements_of_a_symmetric_matrix_share_a_slider() -> None:
    found = {it.path: it for it in _numbers.knobs(of("two-mass-drive.toml"))}
    assert found["system.stiffness[0][1]"].twin == "system.stiffness[1][0]" and "system.stiffness[1][0]" not in found


def test_choices_are_the_words_of_the_schema() -> None:
    found = {it.path: it for it in _numbers.choices(of("stribeck-belt.toml"))}
    assert found["dither.waveform"].options == ("sine", "triangle", "square", "fourier", "samples", "burst", "noise")


@pytest.mark.parametrize("waveform", ["fourier", "samples", "burst", "square", "noise"])
def test_another_waveform_has_the_keys_that_it_needs(waveform: str) -> None:
    state = _state.State(of("stribeck-belt.toml"), _state.Source("text"))
    assert state.set({"dither.waveform": waveform}) and state.study.settings["dither.waveform"] == waveform
    assert state.set({"dither.waveform": "sine"}) and "dither.on" not in state.study.settings
    assert state.undo() and state.study.settings["dither.waveform"] == waveform


# State.


def test_undo_and_redo_return_the_same_studies() -> None:
    state = state_of(BELT)
    first = state.study
    assert state.set({"belt.belt_velocity": 0.1}) and state.set({"dither.amplitude": 0.2})
    last = state.study
    assert state.undo() and state.study.settings["dither.amplitude"] == 0.4 and state.study.settings["belt.belt_velocity"] == 0.1
    assert state.undo() and state.study == first and not state.undo()
    assert state.redo() and state.redo() and state.study.settings == last.settings and not state.redo()


def test_a_drag_is_one_step_of_undo(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    state = state_of(BELT)
    for step in range(20):
        now[0] += 0.1
        state.set({"dither.amplitude": 0.1 + 0.01 * step})
    assert len(state.past) == 1
    now[0] += 5.0
    state.set({"dither.amplitude": 0.9})
    assert len(state.past) == 2
    state.undo()
    assert state.study.settings["dither.amplitude"] == pytest.approx(0.29)


def test_a_refused_change_leaves_the_study_and_gives_its_reason() -> None:
    state = state_of(BELT)
    before = state.study
    assert not state.set({"belt.normal_load": -3.0})
    assert state.study is before and "normal_load" in state.complaints[0] and not state.past
    assert state.set({"belt.normal_load": 2.0}) and not state.complaints


def test_a_range_of_a_map_is_valid_at_its_ends() -> None:
    study = of("drill-string.toml")
    wide = next(it for it in _numbers.knobs(study) if it.path.endswith("static_coefficient"))
    found = _numbers.within(study, wide)
    # The static coefficient is at least the minimum one.
    assert wide.start == 0.0 and found.start == pytest.approx(0.5, abs=0.01) and found.stop == wide.stop
    assert _numbers.accepts(study, found, found.start) and not _numbers.accepts(study, found, 0.4)


def test_many_changes_do_not_make_the_study_longer() -> None:
    state = state_of(BELT)
    for step in range(200):
        state.set({"dither.amplitude": 0.001 * step})
    assert len(state.study.changes) == 1


@pytest.mark.parametrize("law", _other_law.laws())
@pytest.mark.parametrize("name", ["stribeck-belt.toml", "squealing-pad-si.toml", "two-mass-drive.toml", "bowed-string.toml"])
def test_every_law_can_be_chosen(law: str, name: str) -> None:
    state = state_of(STUDIES / name)
    for path in _other_law.tables_of_laws(state.study):
        assert state.set_law(path, law), state.complaints
        assert state.study.settings[f"{path}.law"] == law
    assert state.study.stability().sentence
    state.undo()
    assert state.study == of(name)


def test_numbers_that_laws_share_are_kept() -> None:
    state = state_of(BELT)
    state.set_law("friction", "stribeck-exponential")
    assert state.study.settings["friction.static_coefficient"] == 0.4 and state.study.settings["friction.coefficient"] == 0.2857
    state.set_law("friction", "stribeck")
    assert state.study.settings["friction.minimum_coefficient"] == 0.2857 and state.study.settings["friction.reference_velocity"] == 0.2


def test_the_zoo_opens() -> None:
    sources = {**_zoo.questions(), **_zoo.neighbours(_state.Source("file", str(BELT)))}
    assert len(_zoo.questions()) >= 10 and "two-mass-drive.toml" in sources
    assert all(_zoo.read(it) for it in _zoo.questions().values())


# Sharing.


def stepped(state: _state.State) -> _state.Step:
    assert state.set({"dither.amplitude": 0.3, "belt.belt_velocity": 0.07})
    return state.step


SOURCES = {
    "file": lambda: state_of(BELT),
    "question": lambda: _state.State(_zoo.read(_state.Source("question", "quench")), _state.Source("question", "quench")),
    "text": lambda: _state.State(quell.Study.from_text(BELT.read_text()), _state.Source("text")),
}


@pytest.mark.parametrize("kind", list(SOURCES))
def test_what_is_shared_gives_the_same_answer(kind: str, tmp_path: Path) -> None:
    step = stepped(SOURCES[kind]())
    wanted = step.study().response()
    file = tmp_path / "study.toml"
    file.write_text(_share.toml(step))
    assert quell.Study.from_toml(file).response().facts == wanted.facts
    space: dict[str, Any] = {}
    exec(_share.python(step), space)  # noqa: S102  the program under test
    assert space["result"].facts == wanted.facts
    if kind == "question":
        file.unlink()
    program = _share.commands(step).replace("quell ", f"{command()} ")
    shown = subprocess.run(["sh", "-e", "-c", program], cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    assert wanted.sentence.split(". ")[0] in shown


def test_a_study_that_names_files_can_be_saved_anywhere(tmp_path: Path) -> None:
    state = state_of(STUDIES / "bowed-string.toml")
    assert state.set_law("contact[0].friction", "coulomb")
    file = tmp_path / "study.toml"
    file.write_text(_share.toml(state.step))
    assert quell.Study.from_toml(file).stability().facts == state.study.stability().facts
    space: dict[str, Any] = {}
    exec(_share.python(state.step).split("result =")[0], space)  # noqa: S102  the program under test
    assert space["study"].stability().facts == state.study.stability().facts


def test_a_chosen_start_is_shared(tmp_path: Path) -> None:
    state = state_of(BELT)
    state.set_start({"displacement": -0.1, "velocity": 0.02})
    space: dict[str, Any] = {}
    exec(_share.python(state.step), space)  # noqa: S102  the program under test
    wanted = state.study.simulate(100, start=(-0.1, 0.02))
    assert space["run"].final == wanted.final
    program = _share.commands(state.step).replace("quell ", f"{command()} ")
    shown = subprocess.run(["sh", "-e", "-c", program], cwd=tmp_path, capture_output=True, text=True, check=True).stdout
    assert wanted.sentence.split(", ")[0] in shown


# Answers.


@pytest.mark.parametrize("name", ["stribeck-belt.toml", "squealing-pad-si.toml", "two-mass-drive.toml", "figure-5.3.toml", "pid-drive.toml"])
def test_answers_are_those_of_the_verbs(name: str) -> None:
    study = of(name)
    averaged = _answers.averaged(study)
    assert averaged["verdict"] == study.stability().facts["verdict"] and averaged["sentence"] == study.stability().sentence
    run = _answers.trajectory(study, None)
    at = _answers.moments(study)
    direct: Any = study.simulate(t_eval=at)
    assert run["x"].shape == run["v"].shape == run["time"].shape == at.shape
    np.testing.assert_array_equal(run["x"], np.asarray(direct.arrays[_reading.array_name(run["names"][0])].values))
    assert np.all(np.diff(run["time"]) > 0.0)
    assert pickle.loads(pickle.dumps(run))["sentence"] == run["sentence"]


def test_questions_of_a_study_are_those_of_its_tables() -> None:
    study = of("actuator.toml")
    assert _questions.asked(study) == ["design", "actuator"]
    assert _questions.asked(of("probability.toml")) == ["probability"]
    assert _questions.asked(of("pin-on-disc.toml")) == []
    found = _questions.actuator(study)
    assert found["sentence"] == study.actuator().facts["sentence"] and found["picture"].lstrip().startswith(("<svg", "<?xml"))


def test_the_spectrum_is_in_db_of_the_largest_line_without_dither() -> None:
    study = of("stribeck-belt.toml")
    found = _spectra.response(study)
    assert max(found["before"][1:]) == pytest.approx(0.0, abs=1e-9)
    slow = found["frequency"] <= 1.9
    # The residual vibration E compares the largest lines below 1.9 ω₀.
    change = max(found["after"][slow][1:]) - max(found["before"][slow][1:])
    assert change == pytest.approx(study.response().facts["level_db"], abs=1.0)


def test_the_map_changes_sign_at_the_averaged_threshold() -> None:
    study = of("stribeck-belt.toml")
    found = _maps.plane(study, ("belt.belt_velocity", 0.04, 0.06, False), ("dither.amplitude", 0.1, 0.9, False))
    critical = study.stability().facts["critical_amplitudes"][0]["amplitude"]
    column = found["growth"][:, int(np.argmin(np.abs(found["x"] - 0.05)))]
    assert np.all(column[found["y"] < critical - 0.03] > 0.0) and np.all(column[found["y"] > critical + 0.03] < 0.0)


def test_exact_curves_contain_the_threshold() -> None:
    study = of("stribeck-belt.toml")
    found = _maps.curves(study, ("belt.belt_velocity", 0.02, 0.1, False), ("dither.amplitude", 0.1, 0.9, False))
    exact = study.thresholds("dither.amplitude", 0.3, 0.7).facts["local"][0]["value"]
    curve = found["curves"][0]
    order = np.argsort(curve["x"])
    assert np.interp(0.05, curve["x"][order], curve["y"][order]) == pytest.approx(exact, rel=1e-2)


def test_the_effective_friction_of_a_contact_is_that_of_stability() -> None:
    study = of("two-mass-drive.toml")
    law = _answers.averaged(study)["laws"][0]
    at = np.interp(law["sliding"], law["velocity"], law["effective"])
    assert at == pytest.approx(law["point"], rel=2e-3)


def samples_of(file: bytes) -> tuple[np.ndarray[Any, Any], int]:
    with wave.open(BytesIO(file)) as sound:
        return np.frombuffer(sound.readframes(sound.getnframes()), "<i2"), sound.getframerate()


def test_both_sounds_have_the_same_gain() -> None:
    study = of("stribeck-belt.toml")
    found = _sound.sound(study)
    for name, one in (("with dither", study), ("without dither", study.set({"dither.amplitude": 0}))):
        samples, rate = samples_of(found["files"][name])
        end = samples.size / rate * 2.0 * math.pi * 110.0
        run: Any = one.simulate(t_eval=np.linspace(0.0, end * 0.999, 20000))
        expected = found["gain"] * float(np.max(np.abs(np.asarray(run.arrays["velocity"].values)))) * 32768.0
        assert np.max(np.abs(samples.astype(float))) == pytest.approx(expected, rel=0.03)


def test_every_entry_of_a_legend_has_a_mark() -> None:
    models = pytest.importorskip("bokeh.models")
    figures = importlib.import_module("quell.explore._figures")
    motion, eigenvalues = figures.Motion(), figures.Eigenvalues()
    for plot in (motion.over_time, motion.plane, figures.Spectrum().plot, figures.Law().plot, *eigenvalues.plots):
        items = [item for one in plot.select(models.Legend) for item in one.items]
        # Bokeh draws no mark of a glyph without data.
        assert len(items) > 1 and all(len(column) for it in items for column in it.renderers[0].data_source.data.values())


def test_cells_have_markers_only_if_there_are_several_motions() -> None:
    pytest.importorskip("holoviews")
    basins = importlib.import_module("quell.explore._planes").Basins(lambda x, y: None)
    for quiet, marked in (([False], 0), ([True], 0), ([False, True], 1), ([False, False], 2)):
        basins.answer = {"quiet": quiet}
        assert sum(it is not None for it in basins.marks()) == marked


@pytest.mark.parametrize("name", ["stribeck-belt.toml", "squealing-pad-si.toml", "two-mass-drive.toml"])
def test_loudness_is_that_of_the_response_everywhere(name: str) -> None:
    study = of(name)
    level = study.response().facts["level_db"]
    said = _sound.sound(study)["words"]
    change = "as loud as without" if abs(level) < 0.5 else f"{abs(level):.0f} dB {'quieter' if level < 0 else 'louder'}"
    assert "same gain" in said and change in said, said
    shown = _spectra.response(study)
    assert shown["loudness"] in said and change in shown["loudness"]
    slow = (shown["frequency"] > 0.0) & (shown["frequency"] <= shown["band_end"])
    # The lines of the spectrum are those of which E compares the largest; each point is the largest of its bin.
    assert shown["after"][slow].max() - shown["before"][slow].max() == pytest.approx(level, abs=1.0)


def test_sound_file_and_picture_begin_at_the_same_place(tmp_path: Path) -> None:
    files = pytest.importorskip("quell.explore._files", exc_type=ImportError)
    for name, chosen in (("stribeck-belt.toml", {"displacement": -0.4, "velocity": 0.3}), ("figure-5.3.toml", {"A2": 0.01})):
        study = of(name)
        for start in (None, chosen):
            picture = _answers.trajectory(study, start)
            lines = files.content(study, "simulate", "csv", start).decode().splitlines()
            head, first = (line.split(",") for line in [it for it in lines if not it.startswith("#")][:2])
            column = next(place for place, it in enumerate(head) if it.split(" ")[0].replace(".", "_") == _reading.array_name(picture["names"][0]))
            assert float(first[column]) == pytest.approx(picture["x"][0], abs=1e-12)
        runs = [_sound.sound(study, start) for start in (None, chosen)]
        assert runs[0]["files"]["with dither"] != runs[1]["files"]["with dither"]
    # Both sounds are those of runs from the chosen start.
    study = of("stribeck-belt.toml")
    found = _sound.sound(study, {"displacement": 0.0, "velocity": 0.3})
    for name, one in (("with dither", study), ("without dither", study.set({"dither.amplitude": 0}))):
        until = _sound.SOUND_SECONDS * _sound.heard(study)
        one.simulate(until, start=(0.0, 0.3), samples=False, events=False, gain=found["gain"]).save(tmp_path / "direct.wav")
        assert (tmp_path / "direct.wav").read_bytes() == found["files"][name]


def test_noise_has_answers() -> None:
    state = _state.State(of("stribeck-belt.toml").set({"solver.settle": 60, "solver.record_periods": 8}), _state.Source("text"))
    assert state.set({"dither.waveform": "noise"}), state.complaints
    found, direct = _spectra.response(state.study), state.study.response()
    assert found["sentence"] == direct.sentence and f"E = {100 * direct.residual_vibration_median:.3g} %" in found["loudness"]
    assert found["before"].shape == found["after"].shape == found["frequency"].shape and found["band_end"] == 1.9
    assert found["before"][(found["frequency"] > 0.0) & (found["frequency"] < 1.9)].max() == pytest.approx(0.0, abs=1e-9)
    inside = (found["frequency"] > 8.0) & (found["frequency"] < 12.0)
    assert found["after"][inside].max() > found["before"][inside].max() + 20.0
    for answer in (_answers.averaged, lambda it: _answers.trajectory(it, None), _sound.sound):
        assert answer(state.study)
    system = of("mode-coupling-dither.toml")
    other = _state.State(system, _state.Source("text"))
    path = next(path for path in system.settings if path.endswith("waveform"))
    assert other.set({path: "noise"}), other.complaints
    assert _answers.times(other.study)[1] > 0.0 and _answers.averaged(other.study)["sentence"]


def test_the_map_of_a_disc_is_exact() -> None:
    assert not _answers.is_averaged(of("figure-5.3.toml")) and not _answers.is_averaged(of("mode-coupling.toml"))
    assert _answers.is_averaged(of("stribeck-belt.toml")) and _answers.is_averaged(of("two-mass-drive.toml"))


def test_an_answer_about_earlier_numbers_is_known() -> None:
    fresh = Freshness()
    fresh.outdate(["averaged", "response"])
    old = Event("response", "done", {}, tag=fresh.tag("response"))
    assert fresh.is_stale("response") and fresh.show(old) and not fresh.is_stale("response")
    fresh.outdate(["averaged"])
    assert fresh.is_current(old) and not fresh.is_stale("response") and fresh.is_stale("averaged")
    fresh.outdate(["averaged", "response"])
    assert not fresh.is_current(old) and not fresh.show(old) and fresh.is_stale("response")
    assert fresh.show(Event("response", "failed", tag=fresh.tag("response")))


def test_two_studies_are_compared() -> None:
    state = state_of(BELT)
    first = state.study
    assert state.choose("B") and state.study == first and not state.choose("B")
    assert state.set({"dither.amplitude": 0.7})
    assert state.choose("A") and state.study == first
    assert state.choose("B") and state.study.settings["dither.amplitude"] == 0.7
    assert state.copy().study == state.study and state.copy().slot == "B"


@pytest.mark.parametrize("name", ["stribeck-belt.toml", "squealing-pad-si.toml", "bowed-string.toml", "figure-5.3.toml"])
def test_a_link_has_the_whole_state(name: str) -> None:
    state = state_of(STUDIES / name)
    knob = next(it for it in _numbers.knobs(state.study) if it.path.split(".")[-1].startswith(("belt_velocity", "speed")))
    assert state.set({knob.path: knob.given(knob.grid()[len(knob.grid()) // 2])}), state.complaints
    start = {"displacement": 0.1, "velocity": -0.2}
    state.set_start(start)
    code = _link.encoded(state.step)
    study, source, begin = _link.decoded(_link.in_link(f"http://127.0.0.1:1/secret/?x=1&state={code}"))
    assert study.stability().facts == state.study.stability().facts and begin == start and source.kind == "text"
    assert len(code) < 3000 and _link.code_of({"state": [code.encode()]}) == code and _link.code_of({}) is None


def test_a_broken_link_is_refused() -> None:
    code = _link.encoded(state_of(BELT).step)
    bomb = base64.urlsafe_b64encode(zlib.compress(b" " * (64 << 20))).decode()
    invalid = base64.urlsafe_b64encode(zlib.compress(b'{"study": "x = 1", "start": null}')).decode()
    for wrong in (code[:-9], "", "???", code[10:], bomb, invalid, "ü"):
        with pytest.raises(quell.StudyError):
            _link.decoded(wrong)
    done = subprocess.run([sys.executable, "-m", "quell.explore", "--link", "xyz"], capture_output=True, text=True, check=False)
    assert done.returncode == 2 and "a whole link" in done.stderr and "Traceback" not in done.stderr


@pytest.mark.parametrize(("format_", "begins"), [("svg", b"<svg"), ("png", b"\x89PNG"), ("pdf", b"%PDF"), ("csv", b"#"), ("nc", b"\x89HDF"), ("toml", b"")])
@pytest.mark.parametrize("name", ["stribeck-belt.toml", "figure-5.3.toml", "two-mass-drive.toml"])
def test_every_download_has_its_format(name: str, format_: str, begins: bytes) -> None:
    files = pytest.importorskip("quell.explore._files", exc_type=ImportError)
    study = of(name)
    assert files.content(study, "simulate", format_).startswith(begins)
    if format_ == "toml":
        assert quell.Study.from_text(files.content(study, "simulate", format_).decode()) == study


# Lanes.


class Recorder:
    """Keeps events, and waits for them."""

    def __init__(self) -> None:
        self.events: list[Event] = []
        self._changed = threading.Condition()

    def __call__(self, event: Event) -> None:
        with self._changed:
            self.events.append(event)
            self._changed.notify_all()

    def wait(self, kind: str, tag: object, limit: float = 30.0) -> Event:
        def found() -> Event | None:
            return next((it for it in self.events if it.kind == kind and it.tag == tag), None)

        with self._changed:
            assert self._changed.wait_for(found, limit), [(it.kind, it.tag, it.words) for it in self.events]
            event = found()
        assert event is not None
        return event


class Slow(Here):
    """Computes when it is allowed to."""

    def __init__(self) -> None:
        self.gate = threading.Event()

    def compute(self, request: Any, progress: Any) -> tuple[str, Any, float]:
        self.gate.wait(30.0)
        return "done", {"tag": request.tag}, 0.0


def test_requests_that_wait_are_dropped_for_newer_ones() -> None:
    recorder, engine = Recorder(), Slow()
    lane = Lane(recorder, engine, patience=60.0)
    study = of("stribeck-belt.toml")
    lane.submit("response", study, tag=0)
    recorder.wait("running", 0)
    for tag in range(1, 10):
        lane.submit("response", study, tag=tag)
    lane.submit("trajectory", study, tag="other")
    engine.gate.set()
    recorder.wait("done", 9)
    recorder.wait("done", "other")
    assert [it.tag for it in recorder.events if it.kind == "dropped"] == list(range(1, 9))
    assert [it.tag for it in recorder.events if it.kind == "done"] == [0, 9, "other"]
    lane.close()


def test_a_long_computation_that_is_not_wanted_is_ended() -> None:
    recorder = Recorder()
    lane = Lane(recorder, Process(), patience=0.2)
    # These basins take minutes.
    lane.submit("basins", of("mode-coupling-dither.toml"), (61, 61), tag="long")
    recorder.wait("running", "long")
    begin = time.monotonic()
    lane.submit("basins", of("stribeck-belt.toml"), (3, 3), tag="short")
    recorder.wait("dropped", "long")
    done = recorder.wait("done", "short")
    assert time.monotonic() - begin < 25.0 and done.answer is not None and done.answer["ends"].shape == (3, 3)
    lane.close()


def test_a_computation_that_takes_too_long_is_ended_with_a_reason() -> None:
    recorder = Recorder()
    lane = Lane(recorder, Process(), longest=1.0)
    lane.submit("basins", of("mode-coupling-dither.toml"), (61, 61), tag="long")
    assert "stopped" in recorder.wait("failed", "long").words
    lane.submit("averaged", of("stribeck-belt.toml"), tag="next")
    assert recorder.wait("done", "next").answer is not None
    lane.close()


def test_a_failure_is_an_event_in_words() -> None:
    recorder = Recorder()
    for lane in (Lane(recorder, Here()), Lane(recorder, Process())):
        lane.submit("curves", of("figure-5.3.toml"), ("disc.load.speed", 0.1, 1.0, False), ("disc.load.friction", 0.1, 0.2, False), tag=lane)
        assert "not available" in recorder.wait("failed", lane).words
        lane.close()


# The module and the server.


def test_importing_quell_imports_nothing_of_the_explorer() -> None:
    program = "import sys, quell; print([it for it in sys.modules if it.split('.')[0] in ('panel', 'bokeh', 'holoviews') or 'explore' in it])"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    assert callable(quell.explore) and "explore" in quell.__all__


def test_without_panel_the_error_says_what_to_install() -> None:
    program = "import sys; sys.modules['panel'] = None\nimport quell\ntry:\n    quell.explore()\nexcept ImportError as e:\n    print(e)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert "pip install 'quell[explore]'" in done.stdout


@pytest.fixture(scope="module")
def explorer() -> Any:
    pytest.importorskip("panel")
    running = quell.explore(BELT)
    yield running
    running.stop()


def status(explorer: Any, path: str, **headers: str) -> int:
    connection = http.client.HTTPConnection("127.0.0.1", explorer.port, timeout=30)
    connection.putrequest("GET", path, skip_host="Host" in headers)
    for name, value in headers.items():
        connection.putheader(name.replace("_", "-"), value)
    connection.endheaders()
    found = connection.getresponse().status
    connection.close()
    return found


UPGRADE = {
    "Connection": "Upgrade",
    "Upgrade": "websocket",
    "Sec_WebSocket_Version": "13",
    "Sec_WebSocket_Key": "dGhlIHNhbXBsZSBub25jZQ==",
}


def test_only_requests_with_the_secret_and_the_host_are_answered(explorer: Any) -> None:
    path = "/" + explorer.url.split("/", 3)[3]
    assert status(explorer, path) == 200
    assert status(explorer, "/") in (403, 404) and status(explorer, "/wrong/") in (403, 404)
    assert status(explorer, path[:-2] + "x/") in (403, 404)
    assert status(explorer, f"{path}static/js/bokeh.min.js") == 200
    assert status(explorer, "/static/js/bokeh.min.js") in (403, 404)
    assert status(explorer, path, Host="evil.example") == 403
    assert status(explorer, f"{path}static/js/bokeh.min.js", Host="evil.example") == 403
    assert status(explorer, path, Host=f"evil.example:{explorer.port}") == 403
    assert status(explorer, path, Origin="http://evil.example") == 403
    assert status(explorer, f"{path}ws", Host="evil.example", **UPGRADE) == 403
    assert status(explorer, f"{path}ws", Origin="http://evil.example", **UPGRADE) == 403
    assert status(explorer, "/wrong/ws", **UPGRADE) in (403, 404)


def test_the_server_is_on_the_loopback_interface_alone(explorer: Any) -> None:
    assert {it.getsockname()[0] for it in explorer._server._http._sockets.values()} == {"127.0.0.1"}
    assert len(explorer._token) >= 40
    other = quell.explore(BELT)
    assert other._token != explorer._token and other.port != explorer.port
    other.stop()
    with socket.socket() as probe:
        assert probe.connect_ex(("127.0.0.1", other.port)) != 0


def test_a_notebook_shows_a_frame(explorer: Any) -> None:
    assert explorer.url in explorer._repr_html_() and "<iframe" in explorer._repr_html_()
    assert explorer.study == quell.Study.from_toml(BELT)


def test_the_command_prints_its_address_and_refuses_what_is_no_study(tmp_path: Path) -> None:
    pytest.importorskip("panel")
    missing = subprocess.run([sys.executable, "-m", "quell.explore", str(tmp_path / "no.toml")], capture_output=True, text=True, check=False)
    assert missing.returncode == 2 and "no.toml" in missing.stderr and "Traceback" not in missing.stderr
    wrong = [sys.executable, "-m", "quell.explore", str(BELT), "--set", "belt.normal_load=-1", "--no-browser"]
    refused = subprocess.run(wrong, capture_output=True, text=True, check=False)
    assert refused.returncode == 2 and "normal_load" in refused.stderr
    running = subprocess.Popen(
        [sys.executable, "-u", "-m", "quell.explore", str(BELT), "--no-browser"], stdout=subprocess.PIPE, text=True, env=os.environ
    )
    assert running.stdout is not None
    assert "http://127.0.0.1:" in running.stdout.readline()
    running.send_signal(2)
    assert running.wait(30) == 0


# What varies in time, waveforms and contacts with a state.

PROFILES = {
    "belt": """[belt]
damping_ratio = 0.01
[belt.drive]
time = [0.0, 40.0, 90.0]
velocity = [0.3, 0.3, 0.02]
[belt.load]
time = [0.0, 50.0]
load = [1.0, 1.5]
shape = "smooth"
[friction]
law = "stribeck"
static_coefficient = 0.4
minimum_coefficient = 0.2857
reference_velocity = 0.2
[dither]
direction = "tangential"
waveform = "sine"
amplitude = 0.8
frequency_ratio = 10.0
[dither.envelope]
time = [0.0, 60.0]
share = [0.0, 1.0]
""",
    "system": """[system]
coordinates = ["x"]
mass = [1.0]
damping = [[0.02]]
stiffness = [[1.0]]
[[contact]]
name = "pad"
tangent = { x = 1.0 }
normal_load = 1.0
[contact.drive]
time = [0.0, 40.0]
velocity = [0.3, 0.1]
[contact.friction]
law = "coulomb"
coefficient = 0.3
[[dither]]
at = { x = 1.0 }
waveform = "sine"
amplitude = 0.8
frequency = 10.0
""",
}


@pytest.mark.parametrize("kind", list(PROFILES))
def test_knots_have_sliders_between_their_neighbours(kind: str) -> None:
    state = _state.State(quell.Study.from_text(PROFILES[kind]), _state.Source("text"))
    found = {it.path: it for it in _numbers.knobs(state.study)}
    drive = "belt.drive" if kind == "belt" else "contact[0].drive"
    time_, velocity = found[f"{drive}.time[1]"], found[f"{drive}.velocity[1]"]
    assert time_.group == velocity.group and time_.group.endswith("drive") and velocity.label.startswith("velocity 2")
    assert time_.start == 0.0 and time_.stop > 40.0 and velocity.start == 0.0 and velocity.stop == pytest.approx(0.45)
    if kind == "belt":
        assert time_.stop == 90.0 and found["dither.envelope.share[1]"].stop == 1.0
        assert found["belt.load.load[1]"].start > 0.0 and found["belt.load.load[1]"].group == "belt load"
    before = _answers.trajectory(state.study, None)
    assert before["time"][-1] >= (90.0 if kind == "belt" else 40.0)
    assert state.set({f"{drive}.velocity[1]": 0.2}), state.complaints
    after = _answers.trajectory(state.study, None)
    assert not np.array_equal(before["x"], after["x"])
    assert not state.set({f"{drive}.time[1]": -5.0}) and "time does not go back" in state.complaints[0]


@pytest.mark.parametrize("kind", list(PROFILES))
def test_questions_about_a_steady_study_are_answered_for_a_moment(kind: str) -> None:
    study = quell.Study.from_text(PROFILES[kind])
    averaged = _answers.averaged(study)
    assert averaged["sentence"].startswith("At time ") and averaged["verdict"] in ("stable", "unstable")
    at = 60.0 if kind == "belt" else 0.0
    assert averaged["growth"] == study.at_time(at).stability().facts["growth_rate"]
    assert _spectra.response(study)["sentence"].startswith("At time ")


STATES = {
    "slider": ('tangential_stiffness = 30.0\n', 'law = "coulomb"\ncoefficient = 0.3\n'),
    "lugre": (
        "",
        'law = "lugre"\ncoefficient = 0.25\nstatic_coefficient = 0.4\nreference_velocity = 0.2\nbristle_stiffness = 60.0\nbristle_damping = 0.1\n',
    ),
}


def with_state(kind: str, name: str) -> quell.Study:
    contact, law = STATES[name]
    if kind == "belt":
        return quell.Study.from_text(
            f"[belt]\ndamping_ratio = 0.01\nnormal_load = 1.0\nbelt_velocity = 0.1\n{contact}[friction]\n{law}"
            '[dither]\ndirection = "tangential"\nwaveform = "sine"\namplitude = 0.8\nfrequency_ratio = 10.0\n[solver]\nsettle = 60\nrecord_periods = 8\n'
        )
    steady = PROFILES["system"].replace("[contact.drive]\ntime = [0.0, 40.0]\nvelocity = [0.3, 0.1]\n", f"belt_velocity = 0.1\n{contact}")
    return quell.Study.from_text(steady.replace('law = "coulomb"\ncoefficient = 0.3\n', law))


@pytest.mark.parametrize("name", list(STATES))
@pytest.mark.parametrize("kind", ["belt", "system"])
def test_contacts_with_a_state_open_change_and_draw(kind: str, name: str) -> None:
    state = _state.State(with_state(kind, name), _state.Source("text"))
    found = {it.path: it for it in _numbers.knobs(state.study)}
    path = next(it for it in found if it.endswith("tangential_stiffness" if name == "slider" else "bristle_stiffness"))
    averaged = _answers.averaged(state.study)
    assert averaged["laws"] and averaged["laws"][0]["velocity"].size > 10 and averaged["warnings"]
    before = _answers.trajectory(state.study, None)
    assert state.set({path: found[path].grid()[-1]}), state.complaints
    after = _answers.trajectory(state.study, None)
    assert not np.array_equal(before["x"], after["x"])
    assert _spectra.response(state.study)["sentence"]
    amplitude, velocity = ("dither.amplitude", "belt.belt_velocity") if kind == "belt" else ("dither[0].amplitude", "contact[0].belt_velocity")
    plane = _maps.plane(state.study, (velocity, 0.05, 0.2, False), (amplitude, 0.1, 2.0, False))
    assert np.isfinite(plane["growth"]).any()
    assert ("tangential-spring" if name == "slider" else "bristles") in state.study.sketch()


@pytest.mark.parametrize("waveform", ["fourier", "samples", "burst", "noise"])
def test_every_waveform_is_drawn(waveform: str) -> None:
    state = _state.State(of("stribeck-belt.toml"), _state.Source("text"))
    assert state.set({"dither.waveform": waveform}), state.complaints
    assert _answers.averaged(state.study)["laws"][0]["velocity"].size > 10
    assert np.ptp(_answers.trajectory(state.study, None)["x"]) > 0.0


def test_measured_files_are_set_against_a_study() -> None:
    study = of("measured-belt.toml")
    squeal, quenched = ((STUDIES / f"synthetic-{name}.csv").read_bytes() for name in ("squeal", "quenched"))
    found = _measured.compare(study, squeal, quenched)
    direct = study.compare(STUDIES / "synthetic-squeal.csv", after=STUDIES / "synthetic-quenched.csv")
    assert found["sentence"] == direct.facts["sentence"] and "<svg" in found["picture"]
    assert _measured.compare(study, quenched)["sentence"] != found["sentence"]
    friction = (STUDIES / "synthetic-friction.csv").read_bytes()
    laws = _measured.fit(study, friction)
    assert "decreasing" in laws["picture"] and "[friction]" in laws["picture"] and laws["warnings"]
    with pytest.raises(quell.QuellError, match="slip_velocity"):
        _measured.fit(study, b"a,b\n1,2\n")
