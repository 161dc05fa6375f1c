"""Shared by the tests: the studies of the project, its command line, a belt."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import matplotlib
import pytest
from hypothesis import settings

import quell

matplotlib.use("agg")

ROOT = Path(__file__).resolve().parents[3]
STUDIES = ROOT / "studies"

settings.register_profile("quell", deadline=None, derandomize=True, max_examples=150, database=None)
settings.load_profile("quell")

BELT = {
    "damping_ratio": 0.005,
    "normal_load": 1.0,
    "belt_velocity": 0.05,
    "friction": quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.2857, reference_velocity=0.2),
}
DITHER = quell.Dither("tangential", "sine", amplitude=0.4, frequency_ratio=10.0)
SHORT = quell.Solver(settle=60.0, record_periods=8)


@pytest.fixture
def belt() -> quell.Belt:
    """The belt of the README, with a short record."""
    return quell.Belt(**BELT, dither=DITHER, solver=SHORT, title="a belt")


@pytest.fixture
def disc() -> quell.Disc:
    """An annular disc with one load."""
    return quell.Disc(
        inner_radius_ratio=0.5,
        poisson_ratio=0.3,
        radial_modes=1,
        nodal_diameters=2,
        load=quell.Load(radius_ratio=0.75, mass=0.1, damping=0.1, stiffness=0.1, friction=0.05, speed=0.3),
        dither=quell.Dither("normal", "sine", amplitude=0.5, frequency_ratio=2.7),
    )


def command() -> str:
    """The command-line program; `cargo xtask test` sets its path."""
    path = Path(os.environ.get("QUELL_CLI", ROOT / "target" / "debug" / "quell"))
    if not path.is_file():
        pytest.fail(f"{path} is not there: cargo build --package quell-cli makes it")
    return str(path)


@pytest.fixture(scope="session")
def cli() -> Any:
    """Runs the command line with --json and returns its object."""
    program = command()

    def run(*arguments: str) -> dict[str, Any]:
        done = subprocess.run([program, *arguments, "--json"], capture_output=True, text=True, check=False)
        found: dict[str, Any] = json.loads(done.stdout)
        return found

    return run
