"""Studies of systems: objects and texts, every verb, and numbers computed without Quell (`systems.json`)."""

from __future__ import annotations

import doctest
import pickle
from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
import pytest
import xarray
from conftest import STUDIES
from gallery import DRIVE, FRICTION, HOFFMANN

import quell
from quell import _system, results

@pytest.fixture
def hoffmann() -> quell.System:
    """Mode coupling in a mass with two degrees of freedom."""
    study = quell.Study.from_text(HOFFMANN)
    assert isinstance(study, quell.System)
    return study


@pytest.fixture
def drive() -> quell.System:
    """A drive with dither at its motor."""
    study = quell.Study.from_text(DRIVE)
    assert isinstance(study, quell.System)
    return study


def test_objects_and_texts_make_the_same_study(hoffmann: quell.System, drive: quell.System) -> None:
    made = quell.System(
        coordinates=["x", "y"],
        mass=np.ones(2),
        damping=["c", "c"],
        stiffness=[[2, 1], [1, 2 / 3]],
        contact=quell.Contact(
            "pad",
            tangent={"x": 1},
            normal=[0, 1],
            normal_load=1,
            normal_stiffness=4 / 3,
            belt_velocity=1,
            friction=quell.Coulomb(0.9),
        ),
        parameters={"c": 0.05},
        title="made of objects",
    )
    assert made.stability().facts == {**hoffmann.stability().facts, "sentence": made.stability().sentence}
    also = quell.System(
        coordinates=("motor", "carriage"),
        mass=[0.5, 1.0],
        damping=np.array([[0.03, -0.01], [-0.01, 0.01]]),
        stiffness=[[5, -4], [-4, 4]],
        contact=[quell.Contact("guide", tangent={"carriage": 1}, normal_load=1, belt_velocity=0.05)],
        friction=quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity=0.2),
        dither=quell.SystemDither({"motor": 1}, "sine", amplitude=5.2, frequency=10),
    )
    assert also.stability().growth_rate == drive.stability().growth_rate
    assert pickle.loads(pickle.dumps(made)) == made and "pad" in repr(made) and made._repr_html_()
    modal = quell.System(
        mode=[quell.SystemMode(frequency=1, damping_ratio=0.01, shape={"p": 1}),
              quell.SystemMode(frequency=2, damping_ratio=0.02, shape={"p": -1})],
        contact=quell.Contact(tangent={"p": 1}, normal_load=1, belt_velocity=1, friction=quell.Coulomb(0.3)),
        initial="sliding",
    )
    assert [it["frequency"] for it in modal.modes().modes] == pytest.approx([1, 2], rel=1e-14)


def test_mistakes_are_reported_at_once() -> None:
    with pytest.raises(quell.StudyError) as caught:
        quell.System(
            coordinates=["x"],
            mass=[1],
            stiffness=[1, 2],
            contact=quell.Contact(tangent={"y": 1}, normal_load=-1, belt_velocty=1, friction=quell.Coulomb(0.3)),  # type: ignore[arg-type]
        )
    keys = {error["key"] for error in caught.value.errors}
    assert {"system.stiffness", "contact.normal_load", "contact.belt_velocty"} <= keys
    assert all(error["line"] is None for error in caught.value.errors)


def test_the_example_of_the_class_is_right() -> None:
    done = doctest.testmod(_system)
    assert done.attempted >= 4 and done.failed == 0


def test_check_modes_and_sources(hoffmann: quell.System, drive: quell.System) -> None:
    check = hoffmann.check()
    assert (check.coordinates, [it["name"] for it in check.contacts], check.unit_system) == (["x", "y"], ["pad"], "none")
    modes = hoffmann.modes()
    assert modes.coordinates == ["x", "y"]
    # Stiffness [[2, 1], [1, 2]] with the spring of the contact.
    assert [it["frequency"] for it in modes.modes] == pytest.approx([1, 3**0.5], rel=1e-14)
    assert modes.dataset["shape_x"].dims == ("mode",)
    keys = [source["key"] for source in hoffmann.cite().sources]
    assert keys == ["gelb1968", "jorba2005", "filippov1988", "harris1978", "menck2013", "wilson1927", "hoffmann2002"]
    keys = [source["key"] for source in drive.cite().sources]
    runs = ["jorba2005", "filippov1988", "harris1978", "menck2013", "wilson1927"]
    assert keys == ["michaux2005", "thomsen1999", "cunefare2002", "gelb1968", *runs, "hairer1993"]
    assert "@book{hairer1993," in drive.cite().bibtex


def test_stability_is_that_of_the_reference(hoffmann: quell.System, drive: quell.System) -> None:
    undamped = hoffmann.set({"parameters.c": 0.0}).stability()
    assert undamped.verdict == "unstable" and undamped.protocol == "linearised"
    assert undamped.growth_rate == pytest.approx(0.157146672239535, rel=1e-12)
    assert undamped.eigenvalues.shape == (4,) and undamped.dataset["eigenvalues"].shape == (4, 2)
    assert abs(undamped.eigenvalues[0].imag) == pytest.approx(1.4229178038790433, rel=1e-12)
    assert undamped.undithered is None and undamped.why["undithered"]
    averaged = drive.stability()
    assert averaged.protocol == "averaged" and averaged.undithered is not None
    assert averaged.growth_rate == pytest.approx(0.2833658802332312, rel=1e-9)
    assert averaged.undithered["growth_rate"] == pytest.approx(0.2928396179388291, rel=1e-12)
    assert averaged.contacts[0]["slip_amplitude"] == pytest.approx(0.048340944844528395, rel=1e-10)
    assert averaged.critical_amplitudes is not None
    assert averaged.critical_amplitudes[0]["amplitude"] == pytest.approx(5.378463346883234, rel=1e-9)
    with pytest.raises(AttributeError, match="its facts are"):
        _ = quell.Study.from_text(quell.new("disc")["text"]).stability().eigenvalues


def test_thresholds_are_those_of_tracked_stability(hoffmann: quell.System) -> None:
    tracked = hoffmann.stability(FRICTION, 0.6, 0.9)
    assert isinstance(tracked, results.TrackedStability)
    merging, hopf = tracked.local
    assert (merging["kind"], merging["was"], merging["becomes"]) == ("coalescence", "stable", "stable")
    assert (hopf["kind"], hopf["was"], hopf["becomes"]) == ("hopf", "stable", "unstable")
    assert hopf["value"] == pytest.approx(0.75375, rel=1e-10)
    assert tracked.thresholds == tracked.local and tracked.at_from == {"steady_sliding": "stable"}
    assert tracked.covered and not tracked.resumes and tracked.unknown == []
    assert tracked.dataset["growth_rate"].dims == ("parameter", "branch")
    assert float(tracked.dataset["parameter"][-1]) == 0.9
    thresholds = hoffmann.thresholds(FRICTION, 0.6, 0.9)
    assert isinstance(thresholds, results.Thresholds) and thresholds.local == tracked.local
    # Belt and system: one list, the same keys.
    belt = quell.Study.from_toml(STUDIES / "stribeck-belt.toml").thresholds("dither.amplitude", 0.3, 0.6)
    shared = {"value", "error", "kind", "was", "becomes"}
    assert shared <= set(belt.local[0]) and shared <= set(thresholds.local[0])
    assert {"covered", "resumes", "parameter", "from", "to"} <= set(belt.facts) & set(thresholds.facts)
    # A coordinate whose stiffness vanishes at k = 0.3.
    soft = quell.System(
        coordinates=["x", "z"],
        mass=[1, 1],
        damping=[0.1, 0.1],
        stiffness=[1, "k - 0.3"],
        contact=quell.Contact("pad", tangent={"x": 1}, normal_load=1, belt_velocity=1, friction=quell.Coulomb(0.3)),
        parameters={"k": 1.0},
    )
    divergence = next(it for it in soft.thresholds("parameters.k", 0.1, 1.0).local if it["kind"] == "divergence")
    assert divergence["becomes"] == "stable" and divergence["value"] == pytest.approx(0.3, rel=1e-9)


def test_curves_of_thresholds_follow_a_second_parameter(hoffmann: quell.System) -> None:
    done = hoffmann.stability(FRICTION, 0.6, 0.9, along="parameters.c", between=(0.02, 0.2))
    hopf = [curve for curve in done.curves if curve["kind"] == "hopf"]
    assert len(hopf) == 1 and hopf[0]["becomes"] == "unstable"
    along, value = np.array(hopf[0]["along"]), np.array(hopf[0]["value"])
    assert along[0] == 0.02 and along[-1] == 0.2
    assert np.allclose(value, 0.75 * (1 + 2 * along**2), rtol=1e-9, atol=0)
    same = hoffmann.thresholds(FRICTION, 0.6, 0.9, along="parameters.c", between=(0.02, 0.2))
    assert isinstance(same, results.ThresholdCurves) and same.curves == done.curves
    dataset = same.dataset
    assert dataset["curve"].dims == ("point",) and dataset["contact_pad_friction_coefficient"].shape == dataset["parameters_c"].shape
    assert dataset["eigenvalues_growth_rate"].dims == ("parameter", "branch")


def test_exact_stability_is_that_of_the_reference(drive: quell.System, hoffmann: quell.System) -> None:
    exact = drive.stability(exact=True)
    assert isinstance(exact, results.ExactStability)
    assert exact.verdict == "unstable" and exact.protocol == "floquet"
    assert exact.period == pytest.approx(0.2 * np.pi, rel=1e-14) and len(exact.state) == 4
    assert abs(exact.multipliers[0]) == pytest.approx(1.1949215377617952, rel=1e-10)
    with pytest.raises(quell.RunError, match="no dither"):
        hoffmann.stability(exact=True)


def test_resonances_are_the_reach_of_the_dither(drive: quell.System) -> None:
    reach = drive.resonances(frequency=(10.0, 20.0))
    # The slip amplitude of the reference for the amplitude 5.2 at the frequency 10.
    slip = reach.dataset["slip_of_guide_per_dither_0"]
    assert slip.dims == ("frequency",) and float(reach.dataset["frequency"][0]) == 10.0
    assert float(slip[0]) == pytest.approx(0.048340944844528395 / 5.2, rel=1e-10)
    peaks = [it for it in drive.resonances(frequency=(0.5, 10)).responses[0]["extremes"] if it["kind"] == "peak"]
    assert peaks and peaks[0]["reversal_amplitude"] == pytest.approx(0.05 / peaks[0]["slip_per_amplitude"], rel=1e-12)
    assert drive.resonances().responses[0]["contact"] == "guide"
    for wrong in ({"speeds": (0, 1)}, {"order": "second"}, {"clear": (0, 1)}):
        with pytest.raises(quell.StudyError, match=f"{next(iter(wrong))}.*a system has no waves"):
            drive.resonances(**wrong)  # type: ignore[arg-type]
    with pytest.raises(quell.StudyError, match="frequency"):
        drive.resonances(frequency=(20, 10))


def test_simulations_have_every_contact(hoffmann: quell.System, belt: quell.Belt) -> None:
    done = hoffmann.simulate(60, start={"velocity.x": 0.1})
    assert isinstance(done, results.Simulation)
    assert done.state_names == ["x", "y", "velocity.x", "velocity.y"]
    assert done.event_count == len(done.events) == sum(done.event_counts.values()) > 0
    pad = done.final["contacts"][0]
    assert pad["name"] == "pad" and {"slip_velocity", "friction", "normal", "sticking", "open", "slip_sign"} <= set(pad)
    assert done.contacts[0]["event_counts"] == done.event_counts
    dataset = done.dataset
    assert float(dataset["velocity_x"][0]) == 0.1 and dataset["pad_friction"].dims == ("time",)
    assert float(dataset["time"][-1]) == 60.0
    assert np.allclose(dataset["x"][-1], done.final["state"][0], rtol=0, atol=1e-12)
    assert "100 periods" in hoffmann.simulate(samples=False).notes[0]
    with pytest.raises(quell.StudyError, match="did you mean velocity.x"):
        hoffmann.simulate(1, start={"velocty.x": 1})
    with pytest.raises(quell.StudyError, match="start"):
        hoffmann.simulate(1, start=[1])  # type: ignore[arg-type]
    assert belt.simulate().final["time"] == pytest.approx(200.0 * np.pi, rel=1e-4)
    assert belt.simulate(1, start={"x": 1}).start["state"] == [1.0, 0.0]


def test_responses_have_contacts_and_dithers(drive: quell.System, belt: quell.Belt) -> None:
    done = drive.set({"dither.amplitude": 5.6}).response(settle=400, record=200)
    assert isinstance(done, results.Response) and done.effect == "quenches"
    assert done.facts["settle"] == 400 and done.facts["record_length"] == 200
    assert done.contacts[0]["name"] == "guide" and 0 <= done.contacts[0]["stick_fraction"] <= 1
    assert done.dithers[0]["stroke"] > 0 and done.band_end < 10
    assert done.half_peak_to_peak >= 0.9 * done.amplitude
    assert done.dataset["displacement"].dims == ("time",) and done.dataset["spectrum_amplitude"].dims == ("frequency",)
    with pytest.raises(quell.StudyError, match="settle"):
        drive.response(settle="soon")
    with pytest.raises(quell.StudyError, match="record"):
        belt.response(record="long")
    assert belt.response(settle=100, record=60).facts["record_length"] == 60


def sliding_mass() -> quell.System:
    """A mass that slides on all its motion: a damped oscillator, ζ = 0.02, driven at 10 times its frequency."""
    return quell.System(
        coordinates=["x"], mass=[1], damping=[0.04], stiffness=[1], initial="sliding",
        contact=quell.Contact("pad", tangent={"x": 1}, normal_load=1, belt_velocity=1, friction=quell.Coulomb(0.3)),
        dither=quell.SystemDither({"x": 1}, "sine", amplitude=0.4, frequency=10),
    )  # fmt: skip


def test_responses_say_on_which_motion_they_settled(drive: quell.System) -> None:
    done = sliding_mass().response()
    assert (done.settled, done.ends_on, done.undithered_ends_on) == (True, "period-1", "rest")
    assert (done.base_response, done.quiet) == (True, True)
    assert done.period == pytest.approx(2 * np.pi / 10, rel=1e-12)
    assert done.undithered_period is None and "periodic" in done.why["undithered_period"]
    # Without dither the drive squeals, in a limit cycle.
    squealing = drive.set({"dither.amplitude": 5.6}).response(settle=400, record=200)
    assert (squealing.ends_on, squealing.undithered_ends_on) == ("period-1", "limit-cycle")
    assert squealing.period == pytest.approx(2 * np.pi / 10, rel=1e-12)
    cycle = drive.set({"dither.amplitude": 0.0}).orbit()
    assert squealing.undithered_period == pytest.approx(cycle.period, rel=1e-6)


def test_lyapunov_exponents_are_those_of_the_equations(hoffmann: quell.System) -> None:
    found = sliding_mass().attractor(lyapunov=True)
    assert found.attractor is not None and found.lyapunov is not None
    exponents = found.lyapunov["exponents"]
    # Both rates are −ζω, and their sum is the trace of the equations.
    assert exponents == pytest.approx([-0.02, -0.02], abs=5 * max(found.lyapunov["errors"]))
    assert sum(exponents) == pytest.approx(-0.04, abs=1e-9)
    assert found.lyapunov["of_multiplier"] == pytest.approx(-0.02, rel=1e-9) and found.lyapunov["agrees_with_multipliers"]
    assert (found.lyapunov["verdict"], found.lyapunov["kaplan_yorke_dimension"]) == ("regular", 0.0)
    assert found["lyapunov_exponents"].values.tolist() == found.lyapunov.exponents == exponents and found.dataset["lyapunov_errors"].shape == (2,)
    sliding = hoffmann.set({FRICTION: 0.3}).attractor(lyapunov=True, settle=20, record=200).lyapunov
    assert sliding is not None and sum(sliding["exponents"]) == pytest.approx(-0.1, abs=1e-9)
    # Exponents of steady sliding are eigenvalues: there is no record, and the reason is given.
    assert sliding["settle"] is None and sliding["time"] is None
    assert hoffmann.set({FRICTION: 0.3}).attractor().facts.get("lyapunov") is None


def test_maps_of_systems_are_arrays(hoffmann: quell.System) -> None:
    assert {"growth", "verdict"} <= set(quell.quantities()["system"])
    done = hoffmann.map(["growth", "verdict"], {FRICTION: [0.5, 0.9]})
    assert done["growth"].values[1] == hoffmann.stability().growth_rate
    assert done.words("verdict").tolist() == ["stable", "unstable"]


def test_arguments_are_checked(hoffmann: quell.System, belt: quell.Belt) -> None:
    anyhow: Any = hoffmann
    for wrong in (
        {"parameter": FRICTION},
        {"parameter": FRICTION, "from_": 0.6},
        {"parameter": FRICTION, "from_": 0.6, "to": 0.9, "along": "parameters.c"},
        {"along": "parameters.c", "between": (0, 1)},
        {"parameter": FRICTION, "from_": 0.6, "to": 0.9, "exact": True},
        {"parameter": 3, "from_": 0.6, "to": 0.9},
        {"parameter": FRICTION, "from_": 0.9, "to": 0.6},
        {"parameter": "contact.pad.friction.mu", "from_": 0.6, "to": 0.9},
    ):
        with pytest.raises(quell.StudyError):
            anyhow.stability(**wrong)
    with pytest.raises(quell.StudyError, match="near: must be left out: without dither"):
        hoffmann.thresholds(FRICTION, 0.6, 0.9, near={"x": 0.1})
    with pytest.raises(quell.StudyError, match="ramp"):
        hoffmann.thresholds(FRICTION, 0.6, 0.9, ramp=10)
    assert belt.stability("dither.amplitude", 0.1, 0.2).facts["ok"] and belt.stability(exact=True).facts["ok"]
    with pytest.raises(quell.StudyError, match="mean friction of every contact"):
        hoffmann.friction(measured=True)


def test_every_result_plots_pickles_and_equals_the_command_line(drive: quell.System, hoffmann: quell.System, cli: Any, tmp_path: Any) -> None:
    paths = {"hoffmann": tmp_path / "hoffmann.toml", "drive": tmp_path / "drive.toml"}
    paths["hoffmann"].write_text(HOFFMANN)
    paths["drive"].write_text(DRIVE)
    over = ["--parameter", FRICTION, "--from", "0.6", "--to", "0.9"]
    second = ["--along", "parameters.c", "--between", "0.02:0.2"]
    cases: list[tuple[results.Result, str, str, list[str], bool]] = [
        (hoffmann.check(), "check", "hoffmann", [], False),
        (drive.cite(), "cite", "drive", [], False),
        (hoffmann.modes(), "modes", "hoffmann", [], True),
        (hoffmann.stability(), "stability", "hoffmann", [], True),
        (drive.stability(), "stability", "drive", [], True),
        (drive.stability(exact=True), "stability", "drive", ["--exact"], False),
        (hoffmann.stability(FRICTION, 0.6, 0.9), "stability", "hoffmann", over, True),
        (hoffmann.stability(FRICTION, 0.6, 0.9, along="parameters.c", between=(0.02, 0.2)), "stability", "hoffmann", over + second, True),
        (hoffmann.thresholds(FRICTION, 0.6, 0.9), "thresholds", "hoffmann", over, True),
        (hoffmann.simulate(20), "simulate", "hoffmann", ["--until", "20"], True),
        (drive.response(settle=100, record=100), "response", "drive", ["--settle", "100", "--record", "100"], True),
        (drive.resonances(frequency=(1, 20)), "resonances", "drive", ["--frequency", "1:20"], True),
    ]  # fmt: skip
    for result, verb, name, options, has_picture in cases:
        assert result.facts == cli(verb, str(paths[name]), *options), verb
        dataset = result.dataset
        assert isinstance(dataset, xarray.Dataset) and dataset.attrs["verb"] == verb
        again = pickle.loads(pickle.dumps(result))
        assert again.facts == result.facts and again.dataset.identical(dataset)
        assert repr(again) and f"quell {verb}" in again._repr_html_()
        if has_picture:
            assert isinstance(again.plot(), matplotlib.figure.Figure), verb
    curves = cases[7][0].save(tmp_path / "curves.csv")
    cli("stability", str(paths["hoffmann"]), *over, *second, "--save", str(tmp_path / "same.csv"))
    assert curves == [str(tmp_path / "curves.csv"), str(tmp_path / "curves_eigenvalues.csv")]
    for name in ("", "_eigenvalues"):
        assert rows(tmp_path / f"same{name}.csv") == rows(tmp_path / f"curves{name}.csv")


def rows(path: Path) -> list[str]:
    """The lines of a table without its header, which names the file of the study."""
    return [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]


def test_a_study_with_units_has_them_everywhere() -> None:
    study = quell.Study.from_text(DRIVE.replace("[system]", '[system]\nunits = "SI"'))
    assert study.check().unit_system == "SI"
    done = study.stability("contact.guide.belt_velocity", 0.03, 0.06)
    assert done.units["from"] == "m/s" and done.dataset["parameter"].attrs["units"] == "m/s"
    assert done.dataset["growth_rate"].attrs["units"] == "1/s"
    reach = study.resonances(frequency=("1Hz", "3Hz")).dataset
    assert reach["frequency"].attrs["units"] == "rad/s"
    assert float(reach["frequency"][0]) == pytest.approx(2 * np.pi)
    assert reach["slip_of_guide_per_dither_0"].attrs["units"] == "m/s/N"


def test_planes_of_systems_take_random_starts_and_parameters(drive: quell.System) -> None:
    """Curves, sweeps without dither, random starts and shares over a parameter, as on the command line."""
    curves = drive.thresholds("dither.amplitude", 3, 9, along="contact.guide.belt_velocity", between=(0.045, 0.055))
    assert [curve["kind"] for curve in curves.curves] == ["grazing"]
    assert np.asarray(curves.curves[0]["state"]).shape[1] == 4
    silent = drive.set({"dither.amplitude": 0.0})
    sweep = silent.bifurcation("contact.guide.belt_velocity", 0.05, 0.25, points=3)
    assert {jump["becomes"] for jump in sweep.jumps} == {"quiet", "not quiet"}
    shares = silent.basins(
        plane="carriage=0:0.6,velocity.carriage=-0.2:0.2",
        sample=4,
        seed=3,
        over="contact.guide.belt_velocity",
        from_=0.05,
        to=0.25,
        points=2,
    )
    assert shares.layout == {"sample": 4, "seed": 3}
    assert [portrait["quiet_fraction"] for portrait in shares.portraits] == [0.0, 1.0]
