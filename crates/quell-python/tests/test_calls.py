"""Calls: other threads run meanwhile, Ctrl-C is heard, nothing costs much, no panic comes through."""

from __future__ import annotations

import _thread
import subprocess
import sys
import threading
import time
from typing import Any

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
    """How long it takes from Ctrl-C to KeyboardInterrupt."""
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
    interrupted(lambda: study.map("efficiency", store=store, progress=lambda *it: seen.append(it)))
    with pytest.raises(quell.StudyError, match="resume=True goes on with it"):
        study.map("efficiency", store=store)
    small = study.sweeping({"dither.amplitude": [0.1, 0.4]})
    with pytest.raises(quell.StudyError, match="another map"):
        small.map("efficiency", store=store, resume=True)
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
    # Nothing is computed: all of it is the call. 30 µs on an idle machine; this finds a tenfold rise.
    assert min(times) < 3e-4, min(times)


def test_import_is_quick_and_brings_little_along() -> None:
    program = (
        "import time; begun = time.process_time(); import quell; print(time.process_time() - begun);"
        "import sys; print([it for it in ('xarray', 'matplotlib', 'pandas', 'distributed', 'zarr') if it in sys.modules])"
    )
    runs = []
    for _ in range(3):
        done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
        seconds, modules = done.stdout.splitlines()
        assert modules == "[]"
        runs.append(float(seconds))
    assert min(runs) < 0.3, runs


@pytest.mark.parametrize(
    ("call", "key"),
    [
        (lambda belt: belt.orbit(from_rest=True, near=(0.1, 0.0)), "near"),
        (lambda belt: belt.orbit(start=(0.0, 0.0), periods=2), "periods"),
        (lambda belt: belt.thresholds("dither.amplitude", 0.3, 0.6, ramp=5.0), "ramp"),
        (lambda belt: belt.basins(points=5), "over"),
    ],
)
def test_what_would_be_left_out_is_refused(call: Any, key: str, belt: quell.Belt) -> None:
    with pytest.raises(quell.StudyError) as refused:
        call(belt)
    assert [(it["key"], it["fault"]) for it in refused.value.errors] == [(key, "conflict")]
    assert "--" not in str(refused.value)


def test_times_that_nobody_could_wait_for_are_refused(belt: quell.Belt) -> None:
    for call in (lambda: belt.simulate(1e308), lambda: belt.thresholds("dither.amplitude", 0.3, 0.6, from_rest=True, ramp=1e99)):
        with pytest.raises(quell.StudyError, match="1e9"):
            call()
