"""Cost of one point of a disc's map against the number of states, for docs/cost-disc.svg.

`python3 benches/peers/plot_cost.py` runs Quell's `cost` example and computes the eigenvalues of matrices of the same sizes with NumPy, one
after the other on one core, and plots both. It needs only the packages that `compare_disc.py` installs.
"""

import csv
import io
import json
import math
import os
import subprocess
import sys
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = ROOT / "target" / "peers"
PYTHON = ENVIRONMENT / "bin" / "python"
ONE_CORE = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}
COST = ["cargo", "run", "--quiet", "--release", "--package", "quell-disc", "--example", "cost"]
NUMPY = """
import json, sys, time, numpy
random = numpy.random.default_rng(1)
times = {}
for n in json.loads(sys.argv[1]):
    matrix = random.standard_normal((n, n))
    best = 1e9
    for _ in range(7):
        began = time.thread_time()
        for _ in range(4):
            numpy.linalg.eigvals(matrix)
        best = min(best, (time.thread_time() - began) / 4)
    times[n] = 1e6 * best
print(json.dumps(times))
"""
WIDTH, HEIGHT = 560, 400
LEFT, RIGHT, TOP, BOTTOM = 70, 545, 20, 345


def run(command):
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True, env=ONE_CORE).stdout


def draw(series, states):
    """An SVG with logarithmic axes; series are (name, colour, dash, [(states, µs)])."""
    values = [time for *_, points in series for _, time in points]
    x_low, x_high = math.log10(0.8 * min(states)), math.log10(1.2 * max(states))
    y_low, y_high = math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))

    def place(n, time):
        x = LEFT + (math.log10(n) - x_low) / (x_high - x_low) * (RIGHT - LEFT)
        y = BOTTOM - (math.log10(time) - y_low) / (y_high - y_low) * (BOTTOM - TOP)
        return x, y

    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" font-family="sans-serif" font-size="13">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
    ]
    for power in range(y_low, y_high + 1):
        _, y = place(states[0], 10**power)
        label = {0: "1 µs", 1: "10 µs", 2: "100 µs", 3: "1 ms", 4: "10 ms", 5: "100 ms", 6: "1 s"}[power]
        out.append(f'<path d="M{LEFT} {y:.1f}H{RIGHT}" stroke="#ddd"/>')
        out.append(f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{label}</text>')
    labelled = 0.0
    for n in states:
        x, _ = place(n, values[0])
        out.append(f'<path d="M{x:.1f} {BOTTOM}v5" stroke="black"/>')
        if x - labelled > 26:
            labelled = x
            out.append(f'<text x="{x:.1f}" y="{BOTTOM + 19}" text-anchor="middle" font-size="11">{n}</text>')
    out.append(f'<path d="M{LEFT} {TOP}V{BOTTOM}H{RIGHT}" fill="none" stroke="black"/>')
    middle = (LEFT + RIGHT) / 2
    out.append(f'<text x="{middle}" y="{HEIGHT - 12}" text-anchor="middle">states (twice the coordinates of the modes)</text>')
    for row, (name, colour, dash, points) in enumerate(series):
        places = [place(*point) for point in points]
        line = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        out.extend(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in places)
        y = TOP + 14 + 19 * row
        out.append(f'<path d="M{LEFT + 14} {y - 4}h28" stroke="{colour}" stroke-width="2" stroke-dasharray="{dash}"/>')
        out.append(f'<text x="{LEFT + 50}" y="{y}">{name}</text>')
    return "\n".join(out) + "\n</svg>\n"


def main():
    if not PYTHON.exists():
        venv.create(ENVIRONMENT, with_pip=True)
        subprocess.run([PYTHON, "-m", "pip", "install", "--quiet", "scipy"], check=True)
    rows = list(csv.DictReader(io.StringIO(run(COST))))
    states = [int(row["states"]) for row in rows]
    numpy = json.loads(run([PYTHON, "-c", NUMPY, json.dumps(states)]))
    print(f"{'N':>8}{'states':>8}{'growth rate':>14}{'exponent':>12}{'NumPy eigvals':>16}   µs")
    for row in rows:
        name = f"({row['radial_modes']},{row['nodal_diameters']})"
        growth, exponent = float(row["eigenvalues_us"]), float(row["exponents_us"])
        print(f"{name:>8}{row['states']:>8}{growth:14.1f}{exponent:12.1f}{numpy[row['states']]:16.1f}")
    series = [
        ("Floquet exponent with its bound", "#d55e00", "", [(int(r["states"]), float(r["exponents_us"])) for r in rows]),
        ("growth rate without dither, with its bound", "#0072b2", "", [(int(r["states"]), float(r["eigenvalues_us"])) for r in rows]),
        ("NumPy, eigenvalues of one matrix alone", "#777777", "6 4", [(n, numpy[str(n)]) for n in states]),
    ]
    target = ROOT / "docs" / "cost-disc.svg"
    target.write_text(draw(series, states))
    print(target.relative_to(ROOT), file=sys.stderr)


if __name__ == "__main__":
    main()
