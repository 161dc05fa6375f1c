"""Runs from a state, at given times, and in parts."""

from __future__ import annotations

from typing import Any

import gallery
import numpy as np
import pytest

import quell


def joined(first: quell.results.Simulation, second: quell.results.Simulation, key: str) -> Any:
    """The numbers of the events of two runs."""
    return np.array([np.ravel(event[key]) for run in (first, second) for event in run.events], dtype=float)


STUDIES: list[tuple[str, Any, float, float]] = [
    ("belt", gallery.belt, 20.0, 47.3),
    ("belt in SI", gallery.belt_in_si, 1.5, 6.0),
    ("sticking belt", lambda: gallery.belt().set({"dither.amplitude": 0.0}), 5.0, 40.0),
    ("system", lambda: gallery.study("hoffmann"), 20.0, 90.0),
    ("dithered system in SI", lambda: gallery.study("drive in SI"), 7.0, 31.0),
    ("disc", gallery.disc, 8.0, 30.0),
]


@pytest.mark.parametrize(("study", "middle", "end"), [case[1:] for case in STUDIES], ids=[case[0] for case in STUDIES])
def test_two_runs_are_one_long_run(study: Any, middle: float, end: float) -> None:
    study = study()
    times = np.linspace(0.0, end, 400)
    times = times[times != middle]
    whole = study.simulate(end, t_eval=times)
    assert np.allclose(whole.time, times, rtol=1e-14, atol=0)
    first = study.simulate(middle, t_eval=times[times < middle])
    second = first.continued(end, t_eval=times[times > middle])
    again = study.simulate(end, start=first.final, t_eval=times[times > middle])
    assert second.facts == again.facts
    assert [it["kind"] for it in first.events + second.events] == [it["kind"] for it in whole.events]
    if whole.events:
        assert np.allclose(joined(first, second, "time"), [[it["time"]] for it in whole.events], rtol=0, atol=1e-10)
    scale = np.abs(whole.arrays[list(whole.arrays)[1]].values).max()
    for name, one in whole.arrays.items():
        if one.dims == ("time",) and one.values.dtype.kind == "f":
            both = np.concatenate([first.arrays[name].values, second.arrays[name].values])
            assert np.allclose(both, one.values, rtol=1e-10, atol=1e-10 * max(scale, 1.0)), name
    assert second.start["time"] == first.final["time"] and second.final["time"] == whole.final["time"]


def test_samples_at_given_times_are_those_of_the_polynomials() -> None:
    """The trajectory of a sliding mass is known; interpolation between equal steps would be off by far more."""
    free = quell.Belt(
        damping_ratio=0.0, normal_load=1e-9, belt_velocity=5.0, friction=quell.Coulomb(0.3), initial=(1.0, 0.0)
    )
    times = np.sort(np.random.default_rng(3).uniform(0, 50, 300))
    run = free.simulate(t_eval=times)
    assert np.allclose(run.displacement, np.cos(times), rtol=0, atol=1e-8) and run.final["time"] == times[-1]
    assert np.allclose(run.velocity, -np.sin(times), rtol=0, atol=1e-8)
    dense = gallery.belt().simulate(20.0)
    some = dense.time[[0, 7, 100, -1]]
    few = gallery.belt().simulate(20.0, t_eval=some)
    assert np.array_equal(few.displacement, dense.displacement[[0, 7, 100, -1]]) and few.event_count == dense.event_count
    seconds = gallery.belt_in_si().simulate("1500ms", t_eval=[0.1, 0.2, 1.5])
    assert np.allclose(seconds.time, [0.1, 0.2, 1.5], rtol=1e-15) and seconds["time"].attrs["units"] == "s"
    assert len(few.plot().axes) >= 1


def test_runs_begin_at_a_given_state() -> None:
    belt = gallery.belt()
    assert belt.simulate(5.0, start=(0.2, -0.1)).final == belt.replace(initial=(0.2, -0.1)).simulate(5.0).final
    later = belt.simulate(5.0, start={"displacement": 0.2, "velocity": -0.1, "time": 1.0})
    assert later.start == {"time": 1.0, "displacement": 0.2, "velocity": -0.1, "state": [0.2, -0.1]}
    assert "From the given state at t = 1" in later.sentence
    in_si = gallery.belt_in_si().simulate(1.0, start=("20mm", "-0.1 m/s"))
    assert in_si.start["displacement"] == pytest.approx(0.02) and in_si.start["velocity"] == pytest.approx(-0.1)
    assert in_si.facts == gallery.belt_in_si().simulate(1.0, start={"displacement": 0.02, "velocity": -0.1}).facts
    given = gallery.study("hoffmann").simulate(3.0, start={"velocity.x": 0.1})
    assert given.start["state"] == [0.0, 0.0, 0.1, 0.0]
    assert "from the given state at t = 3" in given.continued(4.0).dataset.attrs["trajectory_facts"]


@pytest.mark.parametrize(
    ("given", "key"),
    [
        ({"t_eval": [1.0, 0.5]}, "t_eval"),
        ({"t_eval": [0.0, 30.0]}, "t_eval"),
        ({"t_eval": [-1.0]}, "t_eval"),
        ({"t_eval": ["soon"]}, "t_eval"),
        ({"t_eval": [np.nan]}, "t_eval"),
        ({"t_eval": [1.0], "samples": False}, "t_eval"),
        ({"start": {"displacement": "a"}}, "start"),
        ({"start": {"z": 1.0}}, "start"),
        ({"start": 0.1}, "start"),
        ({"start": {"displacement": 0.1, "velocity": 0.0, "time": 30.0}}, "until"),
        ({"start": {"time": 0.0, "state": [1.0], "contacts": []}}, "start"),
    ],
)
def test_wrong_times_and_states_are_refused(given: dict[str, Any], key: str) -> None:
    with pytest.raises(quell.StudyError) as refused:
        gallery.belt().simulate(20.0, **given)
    assert [error["key"] for error in refused.value.errors] == [key] and "--" not in str(refused.value)
    if "x" not in str(given):
        with pytest.raises(quell.StudyError):
            gallery.study("hoffmann").simulate(20.0, **given)


def test_the_command_line_starts_a_belt_at_a_state(cli: Any, tmp_path: Any) -> None:
    path = tmp_path / "belt.toml"
    gallery.belt().to_toml(path)
    found = cli("simulate", str(path), "--until", "5", "--events", "--start", "0.2,-0.1")
    assert found == gallery.belt().simulate(5.0, start=(0.2, -0.1)).facts
