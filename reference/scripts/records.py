"""Records with planted numbers for the fits of decays and of records, and for comparisons. Independent of Quell: plain Python.

Writes ../../studies/synthetic-decay.csv, synthetic-squeal.csv and synthetic-quenched.csv, with noise, and ../records.json, without.
Free decay: closed form between the reversals of the velocity. Stick-slip: Runge-Kutta of order 4 with 2000 steps a period, the ends of slips
by bisection of the step, the ends of sticks by bisection of the friction that is needed. Run in this folder."""

import json
import math
import random
from pathlib import Path

HERE = Path(__file__).parent

# Free decay: a frequency of 12.5 Hz, a damping ratio of 0.004 and friction of 40 µm over the stiffness.
HERTZ, ZETA, FRICTION, X0, V0, OFFSET = 12.5, 0.004, 40e-6, 2e-3, 0.03, 1e-5

# Squealing belt in units of its equations (lengths over F): the study measured-belt.toml has 0.005, 0.4 and 0.0637 m/s.
TRUTH = {"damping_ratio": 0.006, "static_coefficient": 0.42, "minimum_coefficient": 0.2857, "reference_velocity_m_per_s": 0.06}
MASS, NATURAL, FORCE, BELT = 2.0, 50.0, 200.0, 0.016
AMPLITUDE, DITHER = 160.0, 500.0


def decay(times):
    """x of a mass with viscous damping and Coulomb friction."""
    omega = 2 * math.pi * HERTZ
    sigma, damped = ZETA * omega, omega * math.sqrt(1 - ZETA**2)
    x, v, begin = X0, V0, 0.0
    sign = 1.0 if v > 0 else -1.0
    # The first reversal: v e^{st}(cos - ...) = 0.
    angle = math.atan2(abs(v) * damped, sign * (omega**2 * (x + sign * FRICTION) + sigma * v))
    end = angle / damped
    rest = False
    found = []

    def state(t):
        u = x + sign * FRICTION
        e, c, s = math.exp(-sigma * t), math.cos(damped * t), math.sin(damped * t) / damped
        return u * e * (c + sigma * s) + v * e * s - sign * FRICTION

    for time in times:
        while not rest and time > end:
            x, v = state(end - begin), 0.0
            sign, begin = -sign, end
            rest = abs(x) <= FRICTION
            end = begin + math.pi / damped
        found.append(x if rest else state(time - begin))
    return found


def belt(times, dithered, truth=TRUTH, settle=60.0):
    """Velocity of the mass, m/s, at times in seconds after `settle` natural periods and a phase of a third of one."""
    omega = 2 * math.pi * NATURAL
    stiffness = MASS * omega**2
    load = FORCE / stiffness
    drive = BELT / omega
    zeta, high, low = truth["damping_ratio"], truth["static_coefficient"], truth["minimum_coefficient"]
    reference = truth["reference_velocity_m_per_s"] / omega
    push, ratio = (AMPLITUDE / stiffness if dithered else 0.0), DITHER / NATURAL

    def dither(t):
        return push * math.sin(ratio * t)

    def needed(t, x):
        return 2 * zeta * drive + x - dither(t)

    def slope(t, x, v, sign):
        slip = drive - v
        friction = sign * load * (low + (high - low) * math.exp(-abs(slip) / reference))
        return v, friction + dither(t) - 2 * zeta * v - x

    def step(t, x, v, sign, h):
        a = slope(t, x, v, sign)
        b = slope(t + h / 2, x + h / 2 * a[0], v + h / 2 * a[1], sign)
        c = slope(t + h / 2, x + h / 2 * b[0], v + h / 2 * b[1], sign)
        d = slope(t + h, x + h * c[0], v + h * c[1], sign)
        return (
            x + h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0]),
            v + h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1]),
        )

    def bisect(holds, h):
        """The largest part of a step for which a condition holds."""
        below, above = 0.0, h
        for _ in range(60):
            middle = (below + above) / 2
            if holds(middle):
                below = middle
            else:
                above = middle
        return below

    wanted = [omega * t + (settle + 1 / 3) * 2 * math.pi for t in times]
    t, x, v, sign, stuck = 0.0, 0.0, 0.0, 1.0, False
    h = 2 * math.pi / 2000 if not dithered else 2 * math.pi / 8000
    found = []
    while len(found) < len(wanted):
        end = min(t + h, wanted[len(found)])
        length = end - t
        if stuck:
            inside = lambda part: abs(needed(t + part, x + drive * part)) <= load * high
            if inside(length):
                t, x, v = end, x + drive * length, drive
            else:
                part = bisect(inside, length)
                t, x, v = t + part, x + drive * part, drive
                stuck, sign = False, math.copysign(1.0, needed(t, x))
                # A release leaves the slip velocity at zero: a short step in the direction of the force.
                small = 1e-7
                x, v = step(t, x, v, sign, small)
                t += small
        else:
            inside = lambda part: sign * (drive - step(t, x, v, sign, part)[1]) > 0
            if inside(length):
                x, v = step(t, x, v, sign, length)
                t = end
            else:
                part = bisect(inside, length)
                x, _ = step(t, x, v, sign, part)
                t, v = t + part, drive
                if abs(needed(t, x)) <= load * high:
                    stuck = True
                else:
                    sign = math.copysign(1.0, needed(t, x))
                    small = 1e-7
                    x, v = step(t, x, v, sign, small)
                    t += small
        if t >= wanted[len(found)]:
            found.append(v * omega)
    return found


def write(name, about, column, times, values, noise, seed):
    source = random.Random(seed)
    rows = [f"{t:.5f},{y + noise * source.gauss(0, 1):.6e}" for t, y in zip(times, values)]
    head = [f"# {line}" for line in about]
    (HERE / "../../studies" / name).write_text("\n".join([*head, f"time_s,{column}", *rows]) + "\n", encoding="utf-8")


if __name__ == "__main__":
    times = [0.002 * k for k in range(1000)]
    exact = decay(times)
    about = [
        "Synthetic: a free decay with viscous damping and Coulomb friction, and noise of 20 µm.",
        f"Planted: natural frequency {HERTZ} Hz, damping ratio {ZETA}, friction over stiffness {FRICTION} m, zero of the sensor {OFFSET} m.",
    ]
    write("synthetic-decay.csv", about, "displacement_m", times, [x + OFFSET for x in exact], 2e-5, 1)
    fine = [0.00025 * k for k in range(1200)]
    squeal, quenched = belt(fine, False), belt(fine, True)
    planted = ", ".join(f"{name} {value}" for name, value in TRUTH.items())
    about = ["Synthetic: velocity of a squealing belt without dither, and noise of 0.3 mm/s.", f"Planted: {planted}."]
    write("synthetic-squeal.csv", about, "velocity_m_per_s", fine, squeal, 3e-4, 2)
    about = [f"Synthetic: the same belt under its dither of {AMPLITUDE} N at {DITHER} Hz.", f"Planted: {planted}."]
    write("synthetic-quenched.csv", about, "velocity_m_per_s", fine, quenched, 3e-4, 3)
    stored = {
        "about": "Records without noise, from scripts/records.py.",
        "decay": {
            "natural_frequency_hz": HERTZ, "damping_ratio": ZETA, "friction": FRICTION, "displacement": X0, "velocity": V0,
            "times": times[::25], "values": exact[::25],
        },
        "squeal": {**TRUTH, "times": fine[:600:4], "velocities": squeal[:600:4]},
    }  # fmt: skip
    (HERE / "../records.json").write_text(json.dumps(stored) + "\n", encoding="utf-8")
