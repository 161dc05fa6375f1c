"""Quell, SciPy and heyoka on the same work, one after the other on one core: ratios of one run."""

import json
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = ROOT / "target" / "peers"
PYTHON = ENVIRONMENT / "bin" / "python"


def last_line(command):
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    return json.loads(done.stdout.strip().splitlines()[-1])


if not PYTHON.exists():
    venv.create(ENVIRONMENT, with_pip=True)
    subprocess.run([PYTHON, "-m", "pip", "install", "--quiet", "scipy", "heyoka"], check=True)
speed = ["cargo", "run", "--quiet", "--release", "--package", "quell-belt", "--example", "speed"]
ours = last_line(speed)
rows = [("Quell", ours)]
for name in ("heyoka", "scipy"):
    try:
        rows.append((name, last_line([PYTHON, ROOT / "benches" / "peers" / f"{name}_belt.py"])))
    except subprocess.CalledProcessError as failed:
        print(f"{name} did not run:\n{failed.stderr}", file=sys.stderr)
# Once more: a machine that changed its speed meanwhile shows here.
rows.append(("Quell again", last_line(speed)))
print(f"{'CPU µs per dither period':26}{'stick-slip':>12}{'ratio':>8}{'event-free':>12}{'ratio':>8}")
for name, row in rows:
    line = f"{name:26}"
    for key in ("stick_slip", "event_free"):
        if key in row:
            line += f"{row[key]:12.2f}{row[key] / ours[key]:8.1f}"
        else:
            line += f"{'–':>12}{'':8}"
    print(line)
    if "event_free_batch_of_8" in row:
        batch = row["event_free_batch_of_8"]
        print(f"{name + ', batch of 8':26}{'–':>12}{'':8}{batch:12.2f}{batch / ours['event_free']:8.1f}")
