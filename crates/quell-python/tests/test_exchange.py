"""Values of other packages go in, and results go out to them."""

from __future__ import annotations

import array
import subprocess
import sys
from typing import Any

import gallery
import numpy as np
import pandas
import pint
import pytest
import scipy.io
import scipy.sparse
import xarray
from conftest import BELT

import quell

UNITS = pint.UnitRegistry()
SPEEDS = [0.05, 0.1, 0.2]


class OfInterface:
    """An array by its interface alone."""

    def __init__(self, values: Any) -> None:
        self._kept = np.array(values, dtype=float)
        self.__array_interface__ = self._kept.__array_interface__


class OfDlpack:
    """An array by DLPack alone."""

    def __init__(self, values: Any) -> None:
        self._kept = np.array(values, dtype=float)

    def __dlpack__(self, **how: Any) -> Any:
        return self._kept.__dlpack__(**how)

    def __dlpack_device__(self) -> Any:
        return self._kept.__dlpack_device__()


KINDS: dict[str, Any] = {
    "tuple": tuple,
    "numpy": np.array,
    "Series": pandas.Series,
    "Index": pandas.Index,
    "DataArray": lambda values: xarray.DataArray(values, dims="v"),
    "array": lambda values: array.array("d", values),
    "memoryview": lambda values: memoryview(np.array(values)),
    "__array_interface__": OfInterface,
    "__dlpack__": OfDlpack,
    "quantity without dimension": lambda values: UNITS.Quantity(np.array(values), ""),
    "numbers of numpy": lambda values: [np.float64(it) for it in values],
}


@pytest.mark.parametrize("kind", KINDS)
def test_arrays_of_any_kind_are_taken(kind: str) -> None:
    make, belt = KINDS[kind], gallery.belt()
    assert belt.friction(make(SPEEDS)).facts == belt.friction(SPEEDS).facts
    assert belt.simulate(1.0, t_eval=make(SPEEDS)).facts == belt.simulate(1.0, t_eval=SPEEDS).facts
    axes = {"belt.belt_velocity": make(SPEEDS)}
    assert belt.map("growth", axes).arrays["growth"].values.tolist() == belt.map("growth", {"belt.belt_velocity": SPEEDS}).growth.tolist()
    assert quell.Axis("belt.belt_velocity", values=make(SPEEDS)).values == SPEEDS
    assert belt.orbit(near=make([0.36, -0.04])).facts == belt.orbit(near=(0.36, -0.04)).facts
    v = np.linspace(0.0, 1.0, 30)
    mu = 0.3 + 0.1 * np.exp(-v / 0.2)
    samples = quell.Belt(**{**BELT, "friction": quell.Samples(make(v.tolist()), make(mu.tolist()))})
    assert samples.settings == quell.Belt(**{**BELT, "friction": quell.Samples(v, mu)}).settings
    system = quell.System(
        coordinates=["x", "y"], mass=make([1.0, 2.0]), damping=[make([0.1, 0.0]), make([0.0, 0.1])], stiffness=[1, 1],
        contact=quell.Contact(tangent=make([1.0, 0.0]), normal_load=make([1.0])[0] if kind not in WITHOUT_ITEMS else 1.0, belt_velocity=1,
                              friction=quell.Coulomb(0.3)),
    )  # fmt: skip
    assert system.mass == [1, 2] and system.damping == [[0.1, 0], [0, 0.1]]


WITHOUT_ITEMS = {"__array_interface__", "__dlpack__"}


def test_ranges_and_iterators_are_axes() -> None:
    assert quell.Axis("dither.frequency_ratio", values=range(5, 8)).values == [5, 6, 7]
    assert quell.Axis("dither.frequency_ratio", values=iter([5.0, 6.0])).values == [5.0, 6.0]  # type: ignore[arg-type]


def test_quantities_are_converted_to_the_unit_of_the_key() -> None:
    ms = UNITS.meter / UNITS.second
    given = quell.Belt(
        mass_kg=2000 * UNITS.gram, stiffness_n_per_m=0.2 * UNITS("N/mm"), damping_n_s_per_m=0.2 * UNITS("N*s/m"),
        normal_force_n=0.02 * UNITS.kilonewton, belt_velocity_m_per_s=0.18 * UNITS("km/hour"),
        friction=quell.Stribeck(static_coefficient=40 * UNITS.percent, minimum_coefficient=0.2857, reference_velocity_m_per_s=200 * UNITS("mm/s")),
        dither=quell.Dither("tangential", "sine", amplitude_n=80 * UNITS.newton, frequency_hz=0.016 * UNITS.kilohertz),
        initial=(1 * UNITS.centimeter, 0 * ms),
    )  # fmt: skip
    plain = quell.Belt(
        mass_kg=2.0, stiffness_n_per_m=200.0, damping_n_s_per_m=0.2, normal_force_n=20.0, belt_velocity_m_per_s=0.05,
        friction=quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity_m_per_s=0.2),
        dither=quell.Dither("tangential", "sine", amplitude_n=80.0, frequency_hz=16.0), initial=(0.01, 0.0),
    )  # fmt: skip
    assert given.settings.keys() == plain.settings.keys()
    for path, value in plain.settings.items():
        assert given.settings[path] == (pytest.approx(value, rel=1e-15) if isinstance(value, float) else value), path
    at = plain.friction([20, 30] * UNITS("mm/s"))
    assert np.allclose(at.slip_velocity, [0.02, 0.03], rtol=1e-15)
    assert plain.simulate(1500 * UNITS.millisecond).final["time"] == pytest.approx(1.5, rel=1e-15)
    assert plain.simulate(t_eval=[100, 200] * UNITS.millisecond).time.tolist() == pytest.approx([0.1, 0.2])
    swept = plain.map("growth", {"belt.belt_velocity_m_per_s": [50, 100] * UNITS("mm/s")})
    assert swept.arrays["belt_velocity_m_per_s"].values.tolist() == pytest.approx([0.05, 0.1])
    v = np.linspace(0, 1, 20)
    law = quell.Samples(slip_velocity_m_per_s=1000 * v * UNITS("mm/s"), coefficient=0.3 + 0.1 * np.exp(-v))
    assert plain.replace(friction=law).friction.slip_velocity_m_per_s == pytest.approx(v.tolist())
    disc = gallery.disc_in_si().load
    assert disc is not None
    spun = gallery.disc_in_si().replace(load=disc.replace(speed_hz=None, speed_rpm=UNITS.Quantity(600, "rpm")))
    assert spun.load is not None and spun.load.speed_rpm == pytest.approx(600.0)
    angle = quell.Dither("tangential", "sine", amplitude_n=80.0, frequency_hz=16.0, phase=90 * UNITS.degree)
    assert plain.replace(dither=angle).settings["dither.phase"] == pytest.approx(np.pi / 2)


@pytest.mark.parametrize(
    ("call", "key"),
    [
        (lambda: gallery.belt_in_si().replace(normal_force_n=3 * UNITS.meter), "belt.normal_force_n"),
        (lambda: gallery.belt_in_si().set({"belt.mass_kg": 3 * UNITS.second}), "belt.mass_kg"),
        (lambda: gallery.belt_in_si().simulate(3 * UNITS.newton), "until"),
        (lambda: gallery.belt_in_si().simulate(t_eval=[1, 2] * UNITS.meter), "t_eval"),
        (lambda: gallery.belt_in_si().friction([1, 2] * UNITS.newton), "at"),
        (lambda: gallery.belt().replace(belt_velocity=3 * UNITS("m/s")), "belt.belt_velocity"),
        (lambda: gallery.belt_in_si().replace(normal_force_n=3 * UNITS.kelvin), "belt.normal_force_n"),
    ],
)
def test_a_wrong_dimension_is_a_complaint(call: Any, key: str) -> None:
    with pytest.raises(quell.StudyError) as refused:
        call()
    assert key in [error["key"] for error in refused.value.errors]


def test_numbers_go_out_as_quantities() -> None:
    response = gallery.result("response in SI")
    amplitude = response.quantity("amplitude", UNITS)
    assert amplitude.to("mm").magnitude == pytest.approx(1000 * response.amplitude)  # type: ignore[attr-defined]
    time = response.quantity("time", UNITS)
    assert time.check("[time]") and time.magnitude.shape == response.arrays["time"].shape
    assert gallery.result("response").quantity("residual_vibration", UNITS).check("[]")
    with pytest.raises(KeyError, match="did you mean amplitude?"):
        response.quantity("amplitud")


def test_events_are_a_frame() -> None:
    run = gallery.result("simulate")
    assert isinstance(run, quell.results.Simulation)
    frame = run.events_frame()
    of_moments = ["displacement", "velocity", "x", "velocity_x"]
    assert list(frame.columns) == ["time", "contact", "contact_name", "kind", "slip_sign", *of_moments] and len(frame) == run.event_count
    assert frame["time"].tolist() == [it["time"] for it in run.events]
    in_si = gallery.result("simulate in SI")
    assert isinstance(in_si, quell.results.Simulation)
    seconds = in_si.events_frame()
    assert list(seconds.columns) == list(frame.columns) and seconds.attrs["units"]["time"] == "s"
    assert seconds["time"].tolist() == [it["time"] for it in in_si.events]
    system = gallery.study("hoffmann").simulate(60, start={"velocity.x": 0.1})
    table = system.events_frame()
    assert set(table["contact_name"]) == {"pad"} and table["velocity_x"].tolist() == [it["state"][2] for it in system.events]
    none = gallery.belt().simulate(0.0).events_frame()
    assert len(none) == 0 and list(none.columns) == list(frame.columns)


def test_arrays_are_a_frame_and_a_parquet_file(tmp_path: Any) -> None:
    run = gallery.result("simulate in SI")
    frame = run.to_dataframe()
    assert frame.index.name == "time" and frame["displacement"].tolist() == run.arrays["displacement"].values.tolist()
    assert frame.attrs["units"]["displacement"] == "m"
    run.to_parquet(tmp_path / "run.parquet")
    again = pandas.read_parquet(tmp_path / "run.parquet")
    assert again.equals(frame) and again.attrs["units"] == frame.attrs["units"] and again.attrs["study"] == run.study.text
    table = gallery.result("map").to_dataframe()
    assert list(table.index.names) == ["dither_amplitude", "belt_velocity"] and set(table["verdict"]) <= {"stable", "unstable", "undecided"}
    with pytest.raises(quell.StudyError, match="to_dict"):
        gallery.result("cite").to_dataframe()


@pytest.mark.parametrize("call", gallery.CALLS)
def test_every_result_is_a_netcdf_file(call: str, tmp_path: Any) -> None:
    result = gallery.result(call)
    result.to_netcdf(tmp_path / "result.nc")
    with xarray.open_dataset(tmp_path / "result.nc") as again:
        assert again.attrs["verb"] == result.verb
        for name, one in result.arrays.items():
            stored = again[name if name in again.variables and again[name].dims == one.dims else f"{name}_value"]
            if one.values.dtype.kind == "f":
                assert np.array_equal(stored.values, one.values, equal_nan=True), name
            elif one.values.dtype.kind == "U":
                assert stored.values.tolist() == one.values.tolist(), name


def datasets(result: quell.results.Result) -> list[tuple[str, Any]]:
    """The native datasets that tables are made of."""
    return result._alive().datasets()  # type: ignore[no-any-return]


@pytest.mark.parametrize("call", gallery.CALLS)
def test_every_table_is_a_matlab_and_a_netcdf_file(call: str, tmp_path: Any) -> None:
    """Files of ``--save`` have the values, units, words and dimensions of the arrays."""
    result = gallery.result(call)
    tables = datasets(result)
    if not tables:
        for name in ("x.mat", "x.nc"):
            with pytest.raises(quell.StudyError, match="no table"):
                result.save(tmp_path / name)
        return
    assert result.save(tmp_path / "x.mat") == [str(tmp_path / "x.mat")]
    assert result.save(tmp_path / "x.nc") == [str(tmp_path / "x.nc")]
    stored = scipy.io.loadmat(tmp_path / "x.mat", simplify_cells=True, verify_compressed_data_integrity=True)
    file = xarray.open_dataset(tmp_path / "x.nc", engine="scipy", decode_times=False)
    for place, (name, (provenance, axes, arrays)) in enumerate(tables):
        table = stored[name]
        shape = tuple(len(axis[2]) for axis in axes)
        about = table["about"]
        # An empty text is an empty array; a fit of a record belongs to no study.
        assert (about["study"].strip() if np.size(about["study"]) else "") == provenance["study"].strip()
        assert len(np.atleast_1d(about["axes"])) == len(axes)
        prefix = "" if place == 0 else f"{name}_"
        for kind, several in (("axis", axes), ("array", arrays)):
            for array in several:
                label = array[0].replace(".", "_").replace("[", "_").replace("]", "").replace(" ", "_")
                values = np.asarray(array[2], dtype=float)
                values = values if kind == "axis" else values.reshape(shape)
                assert np.array_equal(np.asarray(table[label], dtype=float).reshape(values.shape), values, equal_nan=True), label
                assert about["units"][label] == array[1][0]
                if array[3] is not None:
                    meanings = np.atleast_1d(about["words"][label]["meanings"]).tolist()
                    assert meanings == [word for _, word in array[3]]
                if 0 in shape:
                    continue
                variable = next(file[it] for it in (prefix + label, label, f"{name}_{label}", f"{prefix}{label}_value") if it in file)
                assert np.array_equal(variable.values.astype(float).reshape(values.shape), values, equal_nan=True), label
                if array[3] is None:
                    assert variable.attrs["units"] == array[1][0]
                else:
                    assert variable.attrs["flag_meanings"].split(" ") == [word.replace(" ", "_") for _, word in array[3]]
    assert file.attrs["program"].startswith("quell ") and file.attrs.get("study", "") == tables[0][1][0]["study"]
    file.close()


@pytest.mark.parametrize("call", gallery.CALLS)
def test_every_result_is_a_matlab_file(call: str, tmp_path: Any) -> None:
    """``to_mat`` has the facts too."""
    result = gallery.result(call)
    result.to_mat(tmp_path / "whole.mat")
    stored = scipy.io.loadmat(tmp_path / "whole.mat", simplify_cells=True)
    (table,) = (value for name, value in stored.items() if not name.startswith("__"))
    assert table["about"]["verb"] == result.verb
    for array, one in result.arrays.items():
        # Names of fields of MATLAB have no spaces.
        name = array.replace(" ", "_")
        if one.values.dtype.kind == "f":
            assert np.array_equal(np.asarray(table[name], dtype=float).reshape(one.values.shape), one.values, equal_nan=True), name
        elif one.values.dtype.kind == "U" and one.dims and one.values.size:
            assert np.atleast_1d(table[name]).tolist() == one.values.tolist(), name
        if "units" in one.attrs:
            assert table["about"]["units"][name] == one.attrs["units"]


def test_averaged_friction_is_a_file_of_abaqus_and_simscape(tmp_path: Any) -> None:
    friction = gallery.belt_in_si().friction()
    assert friction.save(tmp_path / "friction.inp") == [str(tmp_path / "friction.inp")]
    text = (tmp_path / "friction.inp").read_text(encoding="utf-8")
    rows = [line.split(",") for line in text.split("\n*FRICTION\n")[1].splitlines() if not line.startswith("*")]
    coefficients, rates = np.array(rows, dtype=float).T
    known = np.interp(rates, friction.slip_velocity, np.nan_to_num(friction.effective_coefficient))
    assert rates[0] == 0.0 and np.all(np.diff(rates) > 0) and np.allclose(coefficients, known, atol=2e-3)
    friction.save(tmp_path / "friction.m")
    assert "friction.breakaway_friction_velocity" in (tmp_path / "friction.m").read_text(encoding="utf-8")
    with pytest.raises(quell.StudyError, match="only averaged friction"):
        gallery.result("response").save(tmp_path / "response.inp")
    assert not (tmp_path / "response.inp").exists()


def test_matrices_are_files_of_matrix_market(tmp_path: Any) -> None:
    """What SciPy writes, sparse and dense, symmetric and general, is the same study as the matrices."""
    random = np.random.default_rng(5)
    spring = random.normal(size=(4, 4))
    stiffness, damping = spring @ spring.T + np.eye(4), 0.1 * random.normal(size=(4, 4))
    names = ["a", "b", "c", "d"]
    contact = quell.Contact(tangent={"a": 1}, normal_load=1, belt_velocity=1, friction=quell.Coulomb(0.3))
    how: dict[str, Any] = {"coordinates": names, "contact": contact}
    known = quell.System(mass=np.ones(4), stiffness=stiffness.tolist(), damping=damping.tolist(), **how).stability()
    for form in (lambda matrix: matrix, scipy.sparse.coo_array):
        for name, matrix in (("M", np.eye(4)), ("K", stiffness), ("C", damping)):
            scipy.io.mmwrite(tmp_path / f"{name}.mtx", form(matrix), precision=17, symmetry="AUTO")
        files = {name: {"file": str(tmp_path / f"{letter}.mtx")} for name, letter in (("mass", "M"), ("stiffness", "K"), ("damping", "C"))}
        found = quell.System(**files, **how)
        assert found.stability().facts == known.facts and found.mass == files["mass"]


def test_missing_packages_are_named() -> None:
    program = """
import sys
for name in ("pandas", "xarray", "pint", "pyarrow", "scipy.io"):
    sys.modules[name] = None
import quell
belt = quell.Belt(damping_ratio=0.005, normal_load=1, belt_velocity=0.05,
    friction=quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity=0.2))
run = belt.simulate(5)
for call in (run.events_frame, run.to_dataframe, lambda: run.to_netcdf("x.nc"), lambda: run.to_parquet("x.parquet"), lambda: run.quantity("steps"),
             lambda: run.to_mat("x.mat")):
    try:
        call()
    except ImportError as why:
        print(why)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.stdout.splitlines() == [
        "events_frame() needs pandas, which is not installed: pip install pandas",
        "to_dataframe() needs pandas, which is not installed: pip install pandas",
        "to_netcdf() needs xarray, which is not installed: pip install xarray",
        "to_dataframe() needs pandas, which is not installed: pip install pandas",
        "quantity() needs pint, which is not installed: pip install pint",
        "to_mat() needs scipy, which is not installed: pip install scipy",
    ], done.stderr
