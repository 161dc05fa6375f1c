"""Calls: other threads keep running, Ctrl-C is handled, calls are cheap, and no panic reaches Python."""

from __future__ import annotations

import _thread
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np
import pytest
from conftest import BELT, DITHER

import quell

LONG = quell.Belt(**BELT, dither=DITHER, solver=quell.Solver(settle=2e5, record_periods=100))


def test_other_threads_run_meanwhile() -> None:
    counted, done = 0, threading.Event()

    def count() -> None:
        nonlocal counted
        while not done.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    LONG.set({"solver.settle": 2e4}).response()
    done.set()
    thread.join()
    assert counted >= 3


def test_calls_from_other_threads_give_the_same(belt: quell.Belt) -> None:
    found: list[Any] = []
    threads = [threading.Thread(target=lambda: found.append(belt.response().facts)) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [belt.response().facts] * 3


def interrupted(call: Any) -> float:
    """The time from Ctrl-C to KeyboardInterrupt."""
    at: list[float] = []

    def press() -> None:
        time.sleep(0.3)
        at.append(time.monotonic())
        _thread.interrupt_main()

    presser = threading.Thread(target=press)
    presser.start()
    try:
        with pytest.raises(KeyboardInterrupt):
            call()
        return time.monotonic() - at[0]
    finally:
        presser.join()


def test_ctrl_c_is_heard_in_a_long_call() -> None:
    assert interrupted(lambda: LONG.simulate(5e5, events=False, samples=False)) < 2.0


def test_ctrl_c_stops_a_map_and_keeps_what_is_done(tmp_path: Any) -> None:
    axes = [quell.Axis("dither.amplitude", 0.05, 1.0, 40), quell.Axis("belt.belt_velocity", 0.02, 0.4, 40)]
    study = quell.Belt(**BELT, dither=DITHER, solver=quell.Solver(settle=300.0, record_periods=20), axes=axes)
    store = tmp_path / "m.zarr"
    seen: list[tuple[int, int]] = []
    interrupted(lambda: study.map("residual-vibration", store=store, progress=lambda *it: seen.append(it)))
    with pytest.raises(quell.StudyError, match="resume=True continues it"):
        study.map("residual-vibration", store=store)
    small = study.sweeping({"dither.amplitude": [0.1, 0.4]})
    with pytest.raises(quell.StudyError, match="another map"):
        small.map("residual-vibration", store=store, resume=True)
    assert seen and seen[-1][1] == 1600


def test_progress_is_told_and_may_refuse(belt: quell.Belt) -> None:
    seen: list[tuple[int, int]] = []
    belt.map("growth", {"dither.amplitude": [0.1, 0.2, 0.3]}, progress=lambda *it: seen.append(it))
    assert seen[-1] == (3, 3)

    def refuse(there: int, every: int) -> None:
        raise LookupError(f"{there} of {every}")

    with pytest.raises(LookupError):
        belt.map("growth", {"dither.amplitude": [0.1, 0.2, 0.3]}, progress=refuse)


def test_work_that_cannot_be_done_says_so() -> None:
    still = quell.Belt(**{**BELT, "damping_ratio": 0.0}, dither=DITHER)
    with pytest.raises(quell.RunError) as caught:
        still.orbit(near=(1e6, 1e6))
    assert caught.value.key and caught.value.why and isinstance(caught.value, RuntimeError)


def test_a_call_costs_little_more_than_its_computation(belt: quell.Belt) -> None:
    times = []
    for _ in range(300):
        begun = time.perf_counter()
        belt.simulate(0.0, events=False, samples=False)
        times.append(time.perf_counter() - begun)
    # Nothing is computed, so this is the cost of the call: 30 µs on an idle machine. The test detects a tenfold rise.
    assert min(times) < 3e-4, min(times)


def test_import_is_quick_and_brings_little_along() -> None:
    program = (
        "import numpy, time; begun = time.process_time(); import quell; print(time.process_time() - begun);"
        "import sys; print([it for it in ('xarray', 'matplotlib', 'pandas', 'pint', 'distributed', 'zarr') if it in sys.modules])"
    )
    runs = []
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
        seconds, modules = done.stdout.splitlines()
        assert modules == "[]"
        runs.append(float(seconds))
    # 0.02 s next to NumPy's own 0.1 s on an idle machine.
    assert min(runs) < 0.1, runs


@pytest.mark.parametrize(
    ("call", "key"),
    [
        (lambda belt: belt.orbit(from_rest=True, near=(0.1, 0.0)), "near"),
        (lambda belt: belt.orbit(from_rest=True, near=np.array([0.1, 0.0])), "near"),
        (lambda belt: belt.orbit(start=(0.0, 0.0), periods=2), "periods"),
        (lambda belt: belt.thresholds("dither.amplitude", 0.3, 0.6, ramp=5.0), "ramp"),
        (lambda belt: belt.thresholds("dither.amplitude", 0.3, 0.6, along="belt.belt_velocity", between=(0.04, 0.06), ramp=5.0), "along"),
        (lambda belt: belt.basins(points=5), "over"),
        (lambda belt: belt.basins(seed=3), "seed"),
        (lambda belt: belt.basins(sample=10, grid=(4, 3)), "grid"),
    ],
)
def test_what_would_be_left_out_is_refused(call: Any, key: str, belt: quell.Belt) -> None:
    with pytest.raises(quell.StudyError) as refused:
        call(belt)
    assert [(it["key"], it["fault"]) for it in refused.value.errors] == [(key, "conflict")]
    assert "--" not in str(refused.value)


@pytest.mark.parametrize(
    "given",
    ["12", b"12", 0.1, True, (True, 0.1), ("0", "one"), {0.1, 0.2}, {0.1: 1.0, 0.2: 2.0}, (0.1,), (0.1, 0.2, 0.3), (0.1, np.inf),
     np.array([True, False]), np.array([[0.1], [0.2]])],
)  # fmt: skip
def test_what_is_no_pair_of_numbers_is_refused(given: Any, belt: quell.Belt, disc: quell.Disc) -> None:
    calls: list[tuple[Any, str]] = [
        (lambda: belt.orbit(near=given), "near"),
        (lambda: belt.thresholds("dither.amplitude", 0.3, 0.6, start=given), "start"),
        (lambda: belt.basins(displacement=given), "displacement"),
        (lambda: belt.basins(grid=given), "grid"),
        (lambda: disc.resonances(speeds=given), "speeds"),
    ]
    for call, key in calls:
        with pytest.raises(quell.StudyError) as refused:
            call()
        assert [(it["key"], it["fault"]) for it in refused.value.errors] == [(key, "value")]


def test_pairs_are_tuples_lists_or_arrays(belt: quell.Belt) -> None:
    found = belt.orbit()
    state = (found.displacement, found.velocity)
    near = [belt.orbit(near=it).facts for it in (state, list(state), np.array(state))]  # type: ignore[arg-type]
    assert near[0] == near[1] == near[2]


def test_basins_have_a_grid_and_a_seed_by_default(belt: quell.Belt) -> None:
    window: Any = {"displacement": (0.0, 0.5), "velocity": (-0.2, 0.2)}
    assert belt.basins(sample=5, **window).facts == belt.basins(sample=5, seed=1, **window).facts
    assert belt.basins(sample=5, seed=2, **window).facts != belt.basins(sample=5, **window).facts


def messages(failed: quell.QuellError) -> list[str]:
    """All texts of a failure."""
    if isinstance(failed, quell.StudyError):
        return [str(it[part]) for it in failed.errors for part in ("key", "allowed", "message")]
    return [str(failed)]


TANGENTIAL = {"dither.direction": "tangential", "disc.load.friction": 0.25}

WRONG: list[tuple[str, str, Any]] = [
    ("to", "from_", lambda belt, disc: belt.thresholds("dither.amplitude", 0.6, 0.3)),
    ("parameter", "", lambda belt, disc: belt.thresholds("dither.colour", 0.3, 0.6)),
    ("ramp", "from_rest, from_sliding, from_squeal or start", lambda belt, disc: belt.thresholds("dither.amplitude", 0.3, 0.6, ramp=5)),
    ("between", "", lambda belt, disc: belt.thresholds("dither.amplitude", 0.3, 0.6, along="belt.belt_velocity", between=(2, 1))),
    ("along", "", lambda belt, disc: belt.thresholds("dither.amplitude", 0.3, 0.6, along="dither.amplitude", between=(1, 2))),
    ("from_squeal", "another start", lambda belt, disc: belt.set({"belt.belt_velocity": 9}).orbit(from_squeal=True)),
    ("points", "", lambda belt, disc: belt.bifurcation("dither.amplitude", 0.3, 0.6, points=1)),
    ("grid", "", lambda belt, disc: belt.basins(grid=(1, 9))),
    ("sample", "", lambda belt, disc: belt.basins(sample=0)),
    ("until", "", lambda belt, disc: belt.simulate(-1.0)),
    ("until", "raise transpose", lambda belt, disc: belt.simulate(1e9, sound=True)),
    ("transpose", "a factor above 0", lambda belt, disc: belt.simulate(1.0, transpose=-1)),
    ("gain", "", lambda belt, disc: belt.simulate(1.0, gain="loud")),
    ("quantity", "residual-vibration", lambda belt, disc: belt.map("residual-vibratoin", {"dither.amplitude": [0.1]})),
    ("[[sweep]]", 'axes={"dither.amplitude"', lambda belt, disc: belt.map("residual-vibration")),
    ("clear", "clear and frequency must be given together", lambda belt, disc: disc.resonances(clear=(0.2, 0.6))),
    ("clear", "damped", lambda belt, disc: disc.set(TANGENTIAL).resonances(clear=(0.1, 1.0), frequency=(2.0, 6.0))),
    ("out", "", lambda belt, disc: quell.reproduce("2.2", out=__file__)),
    ("path", "must end in", lambda belt, disc: belt.simulate(1.0).save("x.xlsx")),
    ("path", "must end in", lambda belt, disc: belt.cite().save("x.xlsx")),
    ("save", "no sound", lambda belt, disc: belt.cite().save("x.wav")),
]
"""The wrong argument, words of the reason, and the call."""


@pytest.mark.parametrize(("key", "words", "call"), WRONG)
def test_failures_name_arguments_not_options(key: str, words: str, call: Any, belt: quell.Belt, disc: quell.Disc) -> None:
    with pytest.raises(quell.QuellError) as caught:
        call(belt, disc)
    failed: Any = caught.value
    named = [it["key"] for it in failed.errors] if isinstance(failed, quell.StudyError) else [failed.key]
    assert key in named, named
    reported = messages(failed)
    assert not [message for message in reported if "--" in message]
    assert any(words in message for message in reported), reported


def test_failures_of_stores_and_pictures_name_arguments(belt: quell.Belt, tmp_path: Any) -> None:
    axes = {"dither.amplitude": [0.1, 0.2]}
    belt.map("growth", axes, store=tmp_path / "m.zarr")
    with pytest.raises(quell.StudyError, match="resume=True continues it") as refused:
        belt.map("growth", axes, store=tmp_path / "m.zarr")
    assert [it["key"] for it in refused.value.errors] == ["store"] and "--" not in str(refused.value)
    sliding = quell.Belt(**{**BELT, "damping_ratio": 0.5}).orbit()
    assert sliding.period is None
    with pytest.raises(quell.RunError) as failed:
        sliding.plot()
    assert failed.value.key == "plot" and "--" not in str(failed.value)


def test_times_that_nobody_could_wait_for_are_refused(belt: quell.Belt) -> None:
    for call in (lambda: belt.simulate(1e308), lambda: belt.thresholds("dither.amplitude", 0.3, 0.6, from_rest=True, ramp=1e99)):
        with pytest.raises(quell.StudyError, match="1e9|10⁸ periods"):
            call()
