"""Quell, SciPy and heyoka on the same work, alternating on one core: ratios within one run.

`python3 benches/peers/compare.py [rounds]`. The fastest round of each counts, because other load on
the machine only slows it down. SciPy, by far the slowest, runs once.
"""

import json
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = ROOT / "target" / "peers"
PYTHON = ENVIRONMENT / "bin" / "python"
PEERS = ROOT / "benches" / "peers"
SPEED = ["cargo", "run", "--quiet", "--release", "--package", "quell-dynamics", "--example", "speed"]


def prepare():
    """Creates the environment of the peers if it does not exist."""
    if not PYTHON.exists():
        venv.create(ENVIRONMENT, with_pip=True)
        subprocess.run([PYTHON, "-m", "pip", "install", "--quiet", "scipy", "heyoka", "solve-nivp"], check=True)


def last_line(command):
    done = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    return json.loads(done.stdout.strip().splitlines()[-1])


def ours():
    """{(tool, workload): µs per dither period}, with one entry for each way of running."""
    found = last_line(SPEED)
    return {
        ("Quell, " + (way if way == "alone" else "side by side, " + way), workload): time
        for workload, times in found.items()
        for way, time in times.items()
    }


def peer(name):
    found = last_line([PYTHON, PEERS / f"{name}_belt.py"])
    times = {(f"{name}, alone", "stick-slip"): found["stick_slip"]}
    if "event_free" in found:
        times[f"{name}, alone", "event-free"] = found["event_free"]
    if "event_free_batch_of_8" in found:
        times[f"{name}, batch of 8", "event-free"] = found["event_free_batch_of_8"]
    return times


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    prepare()
    times = {}
    for measure in ([ours, lambda: peer("heyoka")] * rounds) + [lambda: peer("scipy")]:
        try:
            for key, time in measure().items():
                times[key] = min(time, times.get(key, time))
        except subprocess.CalledProcessError as failed:
            print(f"a peer did not run:\n{failed.stderr}", file=sys.stderr)
    best = {
        workload: min(time for (tool, of), time in times.items() if of == workload and tool[0] == "Q")
        for workload in ("stick-slip", "event-free")
    }
    print(f"{'CPU µs per dither period':32}" + "".join(f"{w:>12}{'ratio':>8}" for w in best))
    for tool in dict.fromkeys(tool for tool, _ in times):
        line = f"{tool:32}"
        for workload, fastest in best.items():
            time = times.get((tool, workload))
            line += f"{'–':>12}{'':8}" if time is None else f"{time:12.3f}{time / fastest:8.1f}"
        print(line)


if __name__ == "__main__":
    main()
