"""The self-test passes, and fails if a number is wrong."""

from __future__ import annotations

import subprocess
import sys

import pytest

from quell import selftest


def test_an_installation_passes_in_time() -> None:
    done = subprocess.run([sys.executable, "-m", "quell.selftest"], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    *_, last = done.stdout.splitlines()
    assert last.startswith("passed in ") and float(last.split()[2]) < 20.0


def test_a_wrong_number_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    true = selftest.reference

    def wrong(name: str) -> object:
        found = true(name)
        if name == "trajectories":
            found["cases"][3]["state_at_50"]["x"] = "0.1234"
        return found

    monkeypatch.setattr(selftest, "reference", wrong)
    outcomes = {outcome.name: outcome for outcome in selftest.run()}
    assert len(outcomes["trajectories with their events"].failures) == 1
    assert sum(bool(outcome.failures) for outcome in outcomes.values()) == 1
    assert all(outcome.compared > 0 for outcome in outcomes.values())
