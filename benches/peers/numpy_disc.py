"""Growth rates of the disc in NumPy: the workload of quell-disc's `speed` example, µs per point.

Exponents use the same algorithm as far as it can be fast in NumPy: constant flow e^{A₀h} by SciPy, kick of rank one,
64 and 128 steps per period (32 and 64 for three modes), extrapolated, one eigenvalue solve each. `ode` is the direct
approach: the monodromy matrix by DOP853 at 1e-10.
"""

import json
import time

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import expm

SMALL = [
    (0, 1.7715482549454453, 0.65875445677796),
    (1, 1.8076647041409195, 0.933051069689499),
    (2, 2.0, 0.934699921735261),
]
LARGE = [
    (0, 2.10498834135328, 0.65875445677796),
    (1, 2.147902613812594, 0.933051069689499),
    (2, 2.3764391802221647, 0.934699921735261),
    (3, 3.0, 0.930869380030987),
    (4, 4.136811657377203, 0.916799457181122),
    (5, 5.774719287102873, 0.890682598473148),
    (0, 13.743057339280387, -1.43103252071965),
    (1, 14.01344958049745, -2.02319009033238),
    (2, 14.826776768417763, -2.02260542893234),
    (3, 16.1891255259296, -2.02464786168498),
    (4, 18.109525779611632, -2.03147634566082),
    (5, 20.59801190109086, -2.04368782383033),
]
SPEEDS = 0.05 + 0.09 * np.arange(10)
FRICTIONS = 0.02 + 0.03 * np.arange(20)
DAMPING, LOAD, RATIO = 1e-4, 0.3, 2.7


def system(modes, speed):
    """A0 without friction, and U and V."""
    n = sum(1 if q == 0 else 2 for q, _, _ in modes)
    mass, damping, stiffness = np.eye(n), np.zeros((n, n)), np.zeros((n, n))
    contact, slope = np.zeros(n), np.zeros(n)
    at = 0
    for q, beta, shape in modes:
        loss, turning = 2 * DAMPING * beta, q * speed
        count = 1 if q == 0 else 2
        for i in range(at, at + count):
            damping[i, i] = loss
            stiffness[i, i] = beta**2 - turning**2
        contact[at] = shape
        if q:
            damping[at, at + 1], damping[at + 1, at] = -2 * turning, 2 * turning
            stiffness[at, at + 1], stiffness[at + 1, at] = -loss * turning, loss * turning
            slope[at + 1] = q * shape
        at += count
    one = np.outer(contact, contact)
    mass, damping, stiffness = mass + LOAD * one, damping + LOAD * one, stiffness + LOAD * one
    a = np.block([
        [np.zeros((n, n)), np.eye(n)],
        [-np.linalg.solve(mass, stiffness), -np.linalg.solve(mass, damping)],
    ])
    u = np.concatenate([np.zeros(n), np.linalg.solve(mass, contact)])
    return a, u, np.concatenate([slope, np.zeros(n)])


def strang(half, whole, u, v, kicks):
    x = half.copy()
    for kick in kicks[:-1]:
        x = whole @ (x + np.outer(kick * u, v @ x))
    return half @ (x + np.outer(kicks[-1] * u, v @ x))


def rate(m, period):
    return np.log(np.abs(np.linalg.eigvals(m)).max()) / period


def measure(work, points, passes):
    fastest = np.inf
    for _ in range(passes):
        began = time.process_time()
        work()
        fastest = min(fastest, time.process_time() - began)
    return 1e6 * fastest / points


def main():
    answer = {}
    for name, modes, coarse in (("1_2", SMALL, 32), ("2_5", LARGE, 64)):
        systems = [system(modes, speed) for speed in SPEEDS]
        matrices = [a + f * np.outer(u, v) for a, u, v in systems for f in FRICTIONS]

        def eigenvalues():
            for a in matrices:
                np.linalg.eigvals(a).real.max()

        answer[f"eigenvalues_{name}"] = measure(eigenvalues, len(matrices), 5)
        period = 2 * np.pi / RATIO

        def exponents():
            for speed in SPEEDS[::3]:
                a, u, v = system(modes, speed)
                levels = []
                for count in (coarse, 2 * coarse):
                    h = period / count
                    force = 1 + np.cos(2 * np.pi * (np.arange(count) + 0.5) / count)
                    half = expm(a * h / 2)
                    levels.append((half, half @ half, h * force))
                for f in FRICTIONS:
                    low, high = (
                        rate(strang(half, whole, u, v, f * kicks), period)
                        for half, whole, kicks in levels
                    )
                    (16 * high - low) / 15

        answer[f"exponents_normal_{name}"] = measure(exponents, 4 * len(FRICTIONS), 3)

        def ode():
            a, u, v = systems[5]
            n = len(u)

            def slope(t, x):
                x = x.reshape(n, n)
                return (a @ x + np.outer(0.3 * (1 + np.cos(RATIO * t)) * u, v @ x)).ravel()

            done = solve_ivp(slope, (0, period), np.eye(n).ravel(), method="DOP853", rtol=1e-10, atol=1e-10)
            rate(done.y[:, -1].reshape(n, n), period)

        answer[f"ode_{name}"] = measure(ode, 1, 3)
    print(json.dumps({key: round(value, 2) for key, value in answer.items()}))


if __name__ == "__main__":
    main()
