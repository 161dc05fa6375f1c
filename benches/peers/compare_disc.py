"""Quell and NumPy on maps of the disc, one after the other on one core: ratios within one run."""

import json
import os
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = ROOT / "target" / "peers"
PYTHON = ENVIRONMENT / "bin" / "python"
ONE_CORE = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}


def last_line(command):
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True, env=ONE_CORE)
    return json.loads(done.stdout.strip().splitlines()[-1])


if not PYTHON.exists():
    venv.create(ENVIRONMENT, with_pip=True)
    subprocess.run([PYTHON, "-m", "pip", "install", "--quiet", "scipy"], check=True)
speed = ["cargo", "run", "--quiet", "--release", "--package", "quell-disc", "--example", "disc_speed"]
before = last_line(speed)
peer = last_line([PYTHON, ROOT / "benches" / "peers" / "numpy_disc.py"])
# Repeated, to detect a change in the speed of the machine.
after = last_line(speed)
print(f"{'CPU µs per point':44}{'Quell':>9}{'again':>9}{'NumPy':>10}{'ratio':>8}")
for name, states in (("1_2", 10), ("2_5", 44)):
    for what, key, ours in (
        ("eigenvalues", "eigenvalues", "eigenvalues"),
        ("exponents with bound, same splitting", "exponents_normal", "exponents_normal"),
        ("exponents, DOP853 1e-10", "ode", "exponents_normal"),
    ):
        first, again = before[f"{ours}_{name}"], after[f"{ours}_{name}"]
        theirs = peer[f"{key}_{name}"]
        title = f"{states} states: {what}"
        print(f"{title:44}{first:9.1f}{again:9.1f}{theirs:10.1f}{theirs / min(first, again):8.1f}")
