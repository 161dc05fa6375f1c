"""Types: the package passes mypy, its stub matches the native module, and misuse is detected."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import quell

CRATE = Path(__file__).resolve().parents[1]
CONFIGURATION = CRATE / "pyproject.toml"

CACHE = str(CRATE.parents[1] / "target" / "python" / "mypy")

GOOD = """
from typing import Any

import numpy as np
import numpy.typing as npt
import pint

import quell

belt = quell.Belt(damping_ratio=0.1, normal_load=1, belt_velocity=0.1,
    friction=quell.Stribeck(static_coefficient=0.4, minimum_coefficient=0.3, reference_velocity=0.2),
    dither=[quell.Dither("normal", "square", amplitude=0.1, frequency_ratio=10)], initial=(0.1, 0))
residual_vibration: float | None = belt.response().residual_vibration
amplitude: float = belt.response().amplitude
faster: quell.Belt = belt.set({"belt.belt_velocity": 0.2})
again: quell.Study = quell.Study.from_toml("x.toml")
shape: list[int] = belt.map("residual-vibration", {"dither.amplitude": [0.1, 0.2]}).shape
time: npt.NDArray[np.float64] = belt.simulate(5).time
first: float = belt.thresholds("dither.amplitude", 0.3, 0.6).from_
in_si: float | None = belt.response().amplitude
values: npt.NDArray[np.float64] = belt.thresholds("dither.amplitude", 0.3, 0.6).local.value
first_value: float = belt.thresholds("dither.amplitude", 0.3, 0.6).local[0].value
peak: float = belt.actuator().own.drive.force.peak
shown: list[str] = list(belt.response())
residual: npt.NDArray[Any] = belt.map("residual-vibration").residual_vibration
heavy: quell.Belt = quell.Belt(mass_kg=pint.UnitRegistry().Quantity(2000, "gram"))
velocity: float | None = heavy.belt_velocity_m_per_s
last: quell.results.Simulation = belt.simulate(5).continued(10, t_eval=[6, 7])
coefficient: float = belt.friction.static_coefficient
amplitude_of_dither = quell.Dither(amplitude=0.1).amplitude
left: list[int] = belt.map("residual-vibration", store="m.zarr", shard="1/2").left_shards
louder: quell.Belt = belt.replace(dither=belt.dithers[0].replace(amplitude=0.5), friction=belt.friction.replace(static_coefficient=0.5))
copied: dict[str, Any] = belt.response().to_dict()
"""

BAD = """
import quell

quell.Belt(damping_ratio=[0.1])
quell.Belt(belt_velcity=0.1)
quell.Dither("sideways", "sine")
quell.Stribeck(mu=0.4)
belt: quell.Belt = quell.Study.from_text("")
number: str = belt.response().amplitude
belt.simulate(start=0.1)
belt.response().eficiency
belt.simulate(5).tme
quell.Dither().amplitud
belt.belt_velcity
quell.Belt().belt_velocity = 0.5
quell.Dither().amplitude = 0.5
quell.Stribeck().static_coefficient = 0.5
quell.Belt().friction.static_coefficient = 0.5
quell.Belt().title = "b"
quell.Contact().normal_load = 1.0
belt.response().residual_vibration = 0.1
belt.simulate(5).time = belt.simulate(6).time
belt.response().facts["residual_vibration"] = 0.1
quell.Dither().given["amplitude"] = 0.5
belt.actuator().own.amplitude = 0.5
belt.actuator().own_amplitude
"""


def mypy(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Runs mypy with the package's configuration."""
    command = [sys.executable, "-m", "mypy", "--config-file", str(CONFIGURATION), "--no-error-summary", "--cache-dir", CACHE, *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_the_package_is_clean_and_misuse_is_found(tmp_path: Path) -> None:
    good, bad = tmp_path / "good.py", tmp_path / "bad.py"
    good.write_text(GOOD)
    bad.write_text(BAD)
    assert (Path(quell.__file__).parent / "py.typed").is_file()
    done = mypy(str(CRATE / "python" / "quell"), str(good), str(bad))
    lines = [line for line in done.stdout.splitlines() if ": error:" in line]
    others = [line for line in lines if "bad.py" not in line]
    assert not others, "\n".join(others) + done.stderr
    wrong = {int(line.split(":")[1]) for line in lines}
    assert wrong == set(range(4, 27)), "\n".join(lines)


def test_the_stub_is_what_the_native_module_has() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "mypy.stubtest", "quell._quell", "--ignore-missing-stub", "--mypy-config-file", str(CONFIGURATION)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
