"""The cost of Python: a call, an import, and a map compared with the command line.

    python benches/python/calls.py [path of the program quell]

Ratios and CPU times within one run; wall times of a loaded machine mean little.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import quell

BELT = quell.Belt(
    damping_ratio=0.005,
    normal_load=1.0,
    belt_velocity=0.05,
    friction=quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity=0.2),
    dither=quell.Dither("tangential", "sine", amplitude=0.4, frequency_ratio=10.0),
)


def calls() -> None:
    """Minimum and median time of calls that compute nothing, or little."""
    small = BELT.set({"solver.settle": 0.0, "solver.record_periods": 2})
    for name, work in (
        ("simulate to τ = 0 (all of it is the call)", lambda: BELT.simulate(0.0, events=False, samples=False)),
        ("response of two slow periods", lambda: small.response()),
        ("the same with its facts", lambda: small.response().facts),
    ):
        times = []
        for _ in range(1000):
            begun = time.perf_counter()
            work()
            times.append(time.perf_counter() - begun)
        print(f"  {name}: least {1e6 * min(times):.1f} µs, median {1e6 * np.median(times):.1f} µs")


def imports() -> None:
    """CPU time of the import, compared with that of NumPy."""
    for module in ("numpy", "quell"):
        program = f"import time; begun = time.process_time(); import {module}; print(time.process_time() - begun)"
        found = [float(subprocess.check_output([sys.executable, "-c", program])) for _ in range(5)]
        print(f"  import {module}: {min(found):.3f} s")


def children() -> float:
    """CPU time of child processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def maps(program: str) -> None:
    """CPU time of the same map from Python and from the command line, in alternation."""
    study = BELT.set({"solver.settle": 400.0, "solver.record_periods": 20}).sweeping(
        [quell.Axis("dither.amplitude", 0.05, 1.0, 40), quell.Axis("belt.belt_velocity", 0.02, 0.4, 40)]
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "study.toml")
        path.write_text(study.text)
        sets = [argument for change in study.changes for argument in ("--set", change)]
        here, there = [], []
        for turn in range(5):
            begun = time.process_time()
            study.map("residual-vibration", store=Path(folder, f"p{turn}.zarr"))
            here.append(time.process_time() - begun)
            begun = children()
            command = [program, "map", str(path), "--quantity", "residual-vibration", "--save", f"{folder}/c{turn}.zarr", "--json"]
            subprocess.run([*command, *sets], check=True, stdout=subprocess.DEVNULL)
            there.append(children() - begun)
    print(f"  1600 points: Python {min(here):.2f} s, command line {min(there):.2f} s of CPU, ratio {min(here) / min(there):.3f}")


def main() -> None:
    """Runs all measurements."""
    program = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("QUELL_CLI", "quell")
    print("calls:")
    calls()
    print("imports:")
    imports()
    print("maps:")
    maps(program)


if __name__ == "__main__":
    main()
