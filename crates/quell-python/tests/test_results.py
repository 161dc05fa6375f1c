"""Results: facts, arrays with units, xarray Datasets, pictures, files, pickles."""

from __future__ import annotations

import pickle
import re
import subprocess
import sys
from typing import Any

import gallery
import matplotlib.figure
import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray
from conftest import STUDIES

import quell
from quell import _dataset, _names, results


def every(belt: quell.Belt, disc: quell.Disc) -> dict[str, results.Result]:
    """A result of every kind."""
    return {
        "check": belt.check(),
        "cite": belt.cite(),
        "friction": belt.friction(),
        "stability": belt.stability(),
        "disc stability": disc.stability(),
        "simulate": belt.simulate(20.0, sound=True),
        "response": belt.response(),
        "orbit": belt.orbit(),
        "attractor": belt.attractor(lyapunov=True, settle=50, record=500),
        "thresholds": belt.thresholds("dither.amplitude", 0.3, 0.6),
        "map": belt.map(["growth", "verdict"], {"dither.amplitude": [0.1, 0.5], "belt.belt_velocity": [0.05, 0.1, 0.2]}),
        "bifurcation": belt.bifurcation("dither.amplitude", 0.45, 0.55, points=3, up=True),
        "basins": belt.basins(grid=(5, 4)),
        "curves": belt.thresholds("dither.amplitude", 0.45, 0.55, along="belt.belt_velocity", between=(0.045, 0.055)),
        "modes": disc.modes(),
        "resonances": disc.resonances(),
    }


WITHOUT_PICTURE = {"check", "cite"}


def test_every_result_is_a_dataset_and_pickles_and_shows(belt: quell.Belt, disc: quell.Disc) -> None:
    for name, result in every(belt, disc).items():
        dataset = result.dataset
        assert isinstance(dataset, xarray.Dataset), name
        assert dataset.attrs["verb"] == result.verb and dataset.attrs["quell_version"] == quell.__version__
        again = pickle.loads(pickle.dumps(result))
        assert again.facts == result.facts, name
        assert again.dataset.identical(dataset), name
        assert again.study == result.study
        assert repr(again) and f"quell {result.verb}" in again._repr_html_()
        if name in WITHOUT_PICTURE:
            with pytest.raises(quell.StudyError, match="no picture"):
                result.plot()
        else:
            assert isinstance(again.plot(), matplotlib.figure.Figure), name


def test_an_orbit_has_the_same_fields_where_there_is_none(belt: quell.Belt) -> None:
    squealing = quell.Study.from_toml(STUDIES / "does-it-squeal.toml")
    dithered, cycle, sliding = belt.orbit(), squealing.orbit(), squealing.set({"belt.belt_velocity": 3}).orbit()
    assert cycle.period > 0.0 and sliding.period is None and sliding.cycles == []
    # Every result that has a reason for an unknown fact, and a belt without dither.
    extras = {"why", "cycles", "steady_sliding"}
    for found in (cycle, sliding):
        assert set(found.facts) - extras == set(dithered.facts) - extras
        # Where there is no orbit there are no contacts of one.
        missing = set(dithered.units) - set(found.units)
        assert missing <= {"stick_fraction", "open_fraction", "least_slip_velocity"}
        assert "cycles" in found.facts
    assert sliding.free_phase is sliding.monodromy is sliding.contacts is None and sliding.steady_sliding == "stable"
    assert len(sliding.multipliers) == 0
    unknown = {name for name, value in sliding.facts.items() if value is None}
    assert unknown <= set(sliding.why)


def test_arrays_have_dimensions_units_and_provenance(belt: quell.Belt) -> None:
    run = belt.simulate(20.0).dataset
    assert run["displacement"].dims == ("time",) and run["time"].attrs["units"]
    assert run["displacement"].attrs["units"] == "dimensionless"
    assert float(run["time"][-1]) == 20.0 == float(run["final_time"])
    assert run.attrs["study"] == belt.text and run.attrs["title"] == "a belt"
    assert run["event_time"].dims == ("event",) and set(run["event_kind"].values) <= {"stick", "release", "reversal"}
    response = belt.response()
    dataset = response.dataset
    assert float(dataset["residual_vibration"]) == response.residual_vibration
    assert dataset["displacement"].dims == ("time",) and dataset["spectrum_amplitude"].dims == ("frequency",)
    assert dataset["peak_frequency"].attrs["units"] == "dimensionless"
    for name, variable in dataset.variables.items():
        # Words, flags and counts have no unit.
        assert variable.attrs.get("units") is not None or variable.dtype.kind in "biU", name


def test_maps_are_arrays_over_their_axes(belt: quell.Belt, tmp_path: Any) -> None:
    done = belt.map("residual-vibration", {"dither.amplitude": np.linspace(0.1, 0.8, 5), "belt.belt_velocity": [0.05, 0.3]},
                    store=tmp_path / "m.zarr")
    dataset = done.dataset
    assert dataset["residual_vibration"].dims == ("dither_amplitude", "belt_velocity")
    assert dataset["residual_vibration"].shape == (5, 2) == tuple(done.shape)
    stored = xarray.open_zarr(tmp_path / "m.zarr", consolidated=False, mask_and_scale=False)
    assert set(stored.data_vars) <= set(dataset.data_vars)
    for name in stored.data_vars:
        assert stored[name].dims == dataset[name].dims
        assert stored[name].values.tobytes() == dataset[name].values.tobytes(), name
    assert "residual_vibration" in done and len(done) == len(list(done))
    assert belt.map("residual-vibration", {"dither.amplitude": [0.1]}).dataset["residual_vibration"].dims == ("dither_amplitude",)
    single = belt.set({"dither.amplitude": 0.1, "belt.belt_velocity": 0.3}).response()
    assert float(done["residual_vibration"][0, 1]) == single.residual_vibration or single.residual_vibration is None


def test_what_is_unknown_is_none_and_says_why(belt: quell.Belt) -> None:
    quiet = belt.set({"belt.damping_ratio": 0.5}).response()
    assert quiet.residual_vibration is None and "vibration" in quiet.why["residual_vibration"]
    assert np.isnan(quiet.dataset["residual_vibration"]) and quiet.dataset["residual_vibration"].attrs["why"]
    with pytest.raises(AttributeError, match="efficency.*its facts are.*residual_vibration"):
        _ = quiet.efficency


def test_friction_takes_and_gives_numpy(belt: quell.Belt) -> None:
    at = np.linspace(-0.5, 0.5, 11)
    curve = belt.friction(at)
    assert np.array_equal(curve.slip_velocity, at)
    assert curve.coefficient[-1] == -curve.coefficient[0] and np.isnan(curve.coefficient[5])
    assert np.array_equal(belt.friction(at[::2]).coefficient, curve.coefficient[::2], equal_nan=True)
    with pytest.raises(quell.StudyError, match="at"):
        belt.friction([0.1, np.nan])
    with pytest.raises(quell.StudyError, match="at"):
        belt.friction("fast")


def test_a_result_is_shown_with_its_numbers() -> None:
    shown = repr(gallery.result("thresholds of a system"))
    for local in gallery.result("thresholds of a system").facts["local"]:
        row = next(line for line in shown.splitlines() if f"{local['value']:.6g} " in line and local["kind"] in line)
        assert f"{local['error']:.6g}" in row and row.index(local["was"]) < row.rindex(local["becomes"])
    # The list has two names, and is shown once.
    assert shown.count("0.75375 ") == 1 + shown.splitlines()[1].count("0.75375 ")
    orbit = gallery.result("orbit")
    assert f"modulus {abs(orbit.multipliers[0]):.6g}" in repr(orbit)
    assert f"modulus {abs(orbit.multipliers[0]):.6g}" in orbit._repr_html_()
    jumps = repr(gallery.result("bifurcation in SI"))
    assert re.search(r"up +90 +120 +quiet", jumps) and re.search(r"down +120 +90 +not quiet", jumps)
    run = gallery.result("simulate")
    assert f"events, the first 11 of {run.event_count}:" in repr(run) and "final: time = 20" in repr(run)
    assert "arrays over time (" in repr(run) and "growth_rate" in repr(gallery.result("stability of a system"))
    shown = " ".join(repr(gallery.result("response")).split())
    assert "unknown: band_from, band_to, " in shown and "(the study does not define a frequency band)" in shown
    assert "arrays over disc_load_speed (2): growth" in repr(gallery.result("map of a disc"))


@pytest.mark.parametrize("call", gallery.CALLS)
def test_a_shown_result_is_short(call: str) -> None:
    lines = repr(gallery.result(call)).splitlines()
    assert not any("−" in line for line in lines), "numbers with a minus sign that Python does not read"
    assert sum(line.startswith("    ") for line in lines) <= 60
    of_tables = [line for line in lines if not line.startswith(("  arrays", "  warning")) and not line.endswith((".", ")"))]
    assert max(len(line) for line in of_tables[2:]) <= 160


def test_names_of_variables_are_singular_and_have_no_dots() -> None:
    for call in gallery.CALLS:
        found = gallery.result(call).arrays
        names = {*found, *(dim for it in found.values() for dim in it.dims)}
        assert not [name for name in names if "." in name or "[" in name], call
        assert not {"hysteresi", "hysteresi_part", "unstable_surface_velocitie", "acros"} & names, call
    stability, run = gallery.result("stability"), gallery.result("simulate a system")
    assert stability["unstable_surface_velocity_upper"].dims == ("unstable_surface_velocity",)
    intervals = _dataset.arrays("bifurcation", {"hysteresis": [[1.0, 2.0]]}, [])
    assert intervals["hysteresis_value"].dims == ("hysteresis", "hysteresis_part")
    with pytest.warns(FutureWarning, match="hysteresis is now named hysteresis_value"):
        assert intervals["hysteresis"] is intervals["hysteresis_value"]
    with pytest.warns(FutureWarning, match="unstable_surface_velocitie_upper is now named unstable_surface_velocity_upper"):
        old = stability["unstable_surface_velocitie_upper"]
    assert old.identical(stability["unstable_surface_velocity_upper"])
    with pytest.warns(FutureWarning, match="velocity.motor is now named velocity_motor"):
        assert run.arrays["velocity.motor"] is run.arrays["velocity_motor"]
    assert "velocity.motor" in run.arrays and "velocity.motor" not in list(run.arrays)


def test_names_that_differ_only_in_dots_stay() -> None:
    both = quell.System(
        coordinates=["x", "velocity_x"], mass=[1, 1], damping=[0.1, 0.1], stiffness=[1, 1],
        contact=quell.Contact(tangent={"x": 1}, normal_load=1, belt_velocity=1, friction=quell.Coulomb(0.3)),
    )  # fmt: skip
    found = both.simulate(1.0).arrays
    assert {"x", "velocity_x", "velocity.x", "velocity_velocity_x"} <= set(found)


@pytest.mark.parametrize(
    ("plural", "one"),
    [("velocities", "velocity"), ("unstable_surface_velocities", "unstable_surface_velocity"), ("hysteresis", "hysteresis"),
     ("responses", "response"), ("branches", "branch"), ("axes", "axis"), ("losses", "loss"), ("modes", "mode"), ("state", "state"),
     ("across", "across"), ("series", "series"), ("radius", "radius"), ("edges", "edge"), ("waves", "wave")],
)  # fmt: skip
def test_singulars(plural: str, one: str) -> None:
    assert _names.singular(plural) == one


def test_arrays_are_handed_over_not_copied(belt: quell.Belt) -> None:
    run = belt.simulate(5.0)
    values = run.arrays["displacement"].values
    assert values is run.arrays["displacement"].values and values.base is not None or values.flags.owndata
    assert np.shares_memory(run.dataset["displacement"].values, values)



def test_inputs_are_never_outputs(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    study, data = tmp_path / "study.toml", tmp_path / "data.csv"
    data.write_text("slip_velocity,coefficient\n0,0.4\n0.1,0.35\n0.2,0.31\n0.3,0.29\n0.4,0.28\n0.5,0.275\n0.8,0.272\n")
    law = '[friction]\nlaw = "samples"\nfile = "data.csv"\n'
    study.write_text(f"schema = 1\n[belt]\ndamping_ratio = 0.005\nnormal_load = 1\nbelt_velocity = 0.1\n{law}")
    before = study.read_text(), data.read_text()
    (tmp_path / "link.csv").symlink_to("study.toml")
    (tmp_path / "link.svg").symlink_to("data.csv")
    monkeypatch.chdir(tmp_path)
    read = quell.Study.from_toml("study.toml")
    monkeypatch.chdir("/")
    changed = read.set({"belt.belt_velocity": 0.2})
    for belt in [read, changed, pickle.loads(pickle.dumps(changed))]:
        run = belt.simulate(1.0)
        for name in ["data.csv", "link.csv", "link.svg"]:
            with pytest.raises(quell.StudyError, match="which the study is read from"):
                run.save(tmp_path / name)
    assert (study.read_text(), data.read_text()) == before


def test_files_are_those_of_the_command_line(belt: quell.Belt, cli: Any, tmp_path: Any) -> None:
    path = STUDIES / "stribeck-belt.toml"
    run = quell.Study.from_toml(path).simulate(20)
    cli("simulate", str(path), "--until", "20", "--save", str(tmp_path / "c.csv"), "--plot", str(tmp_path / "c.svg"))
    assert run.save(tmp_path / "p.csv") == [str(tmp_path / "p.csv")]
    run.save(tmp_path / "p.svg")
    for kind in ("csv", "svg"):
        assert (tmp_path / f"p.{kind}").read_bytes() == (tmp_path / f"c.{kind}").read_bytes()
    assert [str(tmp_path / "r.csv"), str(tmp_path / "r_spectrum.csv")] == belt.response().save(tmp_path / "r.csv")
    with pytest.raises(quell.StudyError, match="must end in"):
        run.save(tmp_path / "p.xlsx")
    with pytest.raises(quell.StudyError, match="cannot be written"):
        run.save(tmp_path / "nowhere" / "p.csv")


def test_pictures_have_the_curves_of_the_command_line_s(belt: quell.Belt) -> None:
    figure = belt.response().plot()
    record, spectrum = figure.axes
    colours = {line.get_color() for line in record.get_lines()}
    assert {"#0072b2", "#808080"} <= colours
    assert spectrum.get_yscale() == "log"
    assert "time" in record.get_xlabel() and figure.legends
    described = belt.response()._native.description()  # type: ignore[union-attr]
    frame = described["panels"][0]["frame"]
    box = record.get_position()
    assert box.x0 * described["width"] == pytest.approx(frame["left"])
    assert (1.0 - box.y1) * described["height"] == pytest.approx(frame["top"])


def test_pictures_are_drawn_into_given_axes() -> None:
    response, friction = gallery.result("response"), gallery.result("friction")
    figure, axes = plt.subplots(2)
    assert response.plot(ax=axes, color="red", lw=3) is axes
    assert all(line.get_color() == "red" and line.get_linewidth() == 3 for line in axes[0].get_lines())
    assert "time" in axes[0].get_xlabel() and axes[1].get_yscale() == "log" and axes[0].get_legend() is not None
    _, one = plt.subplots()
    one.plot([0, 1], [0.3, 0.3], label="measured")
    assert friction.plot(ax=one, label="fitted") is one and len(one.get_lines()) > 1
    assert [text.get_text() for text in one.get_legend().get_texts()].count("fitted") == 1
    assert 0.5 in [line.get_alpha() for line in friction.plot(alpha=0.5).axes[0].get_lines()]
    assert len(response.plot(ax=tuple(axes))) == 2
    shown = gallery.result("map of a disc")
    with pytest.raises(quell.StudyError, match="ax = 1 Axes: must be a sequence of 2 Axes, one for each panel"):
        response.plot(ax=one)
    with pytest.raises(quell.StudyError, match="2 Axes: must be one Axes: this picture has one panel"):
        friction.plot(ax=axes)
    with pytest.raises(quell.StudyError, match="matplotlib axes"):
        friction.plot(ax=3)
    with pytest.raises(TypeError, match="did you mean linewidth"):
        friction.plot(linewith=3)
    plt.close("all")
    _, several = plt.subplots()
    two = gallery.belt().map("growth", {"dither.amplitude": [0.1, 0.5], "belt.belt_velocity": [0.05, 0.1, 0.2]})
    assert two.plot(ax=several) is several and len(several.figure.axes) == 2  # with the colour bar
    assert isinstance(shown.plot(), matplotlib.figure.Figure)
    plt.close("all")
    del figure


def test_without_xarray_and_matplotlib_there_is_numpy() -> None:
    program = """
import sys
sys.modules["xarray"] = sys.modules["matplotlib"] = None
import quell
belt = quell.Belt(damping_ratio=0.005, normal_load=1, belt_velocity=0.05,
    friction=quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity=0.2),
    dither=quell.Dither("tangential", "sine", amplitude=0.4, frequency_ratio=10))
run = belt.simulate(5)
assert isinstance(run.dataset, quell.results.Arrays)
assert run.dataset["displacement"].dims == ("time",) and run["time"].values[-1] == 5.0
assert run.dataset.attrs["study"] == belt.text
try:
    run.to_xarray()
except ImportError:
    print("as it should be")
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.stdout == "as it should be\n", done.stderr


def test_friction_is_measured_on_steady_responses() -> None:
    belt = gallery.belt()
    at = [-0.1, 0.0, 0.02, 0.1]
    averaged, measured = belt.friction(at), belt.friction(at, measured=True)
    assert averaged.measured_coefficient is None and averaged.measured_stick_fraction is None
    assert np.array_equal(averaged.effective_coefficient, measured.effective_coefficient, equal_nan=True)
    found, stuck = measured.measured_coefficient, measured.measured_stick_fraction
    assert found is not None and stuck is not None
    assert found[0] == pytest.approx(-found[3], abs=1e-9) and np.isnan(found[1]) and np.isnan(stuck[1])
    # Slip throughout: averaging holds to the order 1/R².
    assert stuck[3] == 0.0 and found[3] == pytest.approx(measured.effective_coefficient[3], rel=0.01)
    contact = measured.contacts[0]
    assert contact["measured_verdict"][1] is None
    assert "zero slip velocity" in measured.facts["why"]["contacts[0].measured_coefficient[1]"]
