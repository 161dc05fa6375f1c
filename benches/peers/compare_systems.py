"""Quell, heyoka, SciPy and solve_nivp on two masses with two contacts (`two_masses.py`), alternating on one core.

`python3 benches/peers/compare_systems.py [rounds]`. The fastest round of Quell and heyoka counts, because other load on the
machine only slows it down. SciPy and solve_nivp, by far slower, run once, solve_nivp to τ = 20 only. The last column is
the largest difference of the final state from that of heyoka.
"""

import subprocess
import sys

from compare import PEERS, PYTHON, last_line, prepare

SPEED = ["cargo", "run", "--quiet", "--release", "--package", "quell-dynamics", "--example", "motion_speed"]
SHORT = "20"


def peer(name, *arguments):
    return last_line([PYTHON, PEERS / f"{name}_two_masses.py", *arguments])


def difference(one, other):
    return max(abs(a - b) for a, b in zip(one["final"], other["final"]))


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    prepare()
    measured = [(last_line(SPEED), peer("heyoka")) for _ in range(rounds)]
    ours = min(own["two masses"] for own, _ in measured)
    events = measured[0][0]["two masses, events"]
    heyoka = min((other for _, other in measured), key=lambda found: found["cost"])
    rows = [("Quell", ours, events, None), ("heyoka", heyoka["cost"], heyoka["events"], 0.0)]
    try:
        scipy = peer("scipy")
        rows.append(("SciPy, 50 steps a period", scipy["cost"], scipy["events"], difference(scipy, heyoka)))
        rows.append(("SciPy, free steps", scipy["free"]["cost"], scipy["free"]["events"], None))
        implicit, reference = peer("nivp", SHORT), peer("heyoka", SHORT)
        rows.append((f"solve_nivp, to {SHORT}", implicit["cost"], None, difference(implicit, reference)))
    except subprocess.CalledProcessError as failed:
        print(f"a peer did not run:\n{failed.stderr}", file=sys.stderr)
    print(f"{'CPU µs per dither period':28}{'two masses':>12}{'ratio':>10}{'events':>8}{'difference':>12}")
    for name, cost, found, apart in rows:
        found, apart = found if found is not None else "–", f"{apart:.1e}" if apart is not None else "–"
        print(f"{name:28}{cost:12.2f}{cost / ours:10.1f}{found:>8}{apart:>12}")


if __name__ == "__main__":
    main()
