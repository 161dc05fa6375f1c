"""The stick-slip workload as a SciPy user would write it: solve_ivp (RK45, the pair of ode45) with
terminal events on v_r = 0, and stick phases by brentq. Prints CPU µs per dither period as JSON."""

import json
import math
import time

from scipy.integrate import solve_ivp
from scipy.optimize import brentq

MU_S, MU_M, V_M, ZETA, V0 = 0.4, 0.2857, 0.2, 0.005, 0.05
END = 200.0


def slip_rate(tau, state, sign, amplitude, ratio):
    w = (V0 - state[1]) / V_M
    friction = MU_S * sign - 1.5 * (MU_S - MU_M) * (w - w**3 / 3)
    dither = amplitude * math.sin(ratio * tau)
    return [state[1], friction + dither - 2 * ZETA * state[1] - state[0]]


def bond_force(tau, x, amplitude, ratio):
    return 2 * ZETA * V0 + x - amplitude * math.sin(ratio * tau)


def release(tau, x, amplitude, ratio):
    """Time at which the contact is released after sticking at (tau, x), or END."""
    margin = lambda t: abs(bond_force(t, x + V0 * (t - tau), amplitude, ratio)) - MU_S
    step, left = 0.2 / ratio, tau
    while left < END:
        if margin(left + step) >= 0:
            return brentq(margin, left, left + step, xtol=1e-13) if margin(left) < 0 else left
        left += step
    return END


def simulate(amplitude, ratio):
    def stops(tau, state, *_):
        return V0 - state[1]

    stops.terminal = True
    tau, x, v, sign, events = 0.0, 0.0, 0.0, 1.0, 0
    while tau < END:
        stops.direction = -sign
        slip = solve_ivp(
            slip_rate, (tau, END), [x, v], events=stops, args=(sign, amplitude, ratio),
            rtol=1e-8, atol=1e-10, max_step=math.pi / ratio,
        )
        tau, x = slip.t[-1], slip.y[0, -1]
        if slip.status != 1:
            break
        events += 1
        if abs(bond_force(tau, x, amplitude, ratio)) <= MU_S:
            free = release(tau, x, amplitude, ratio)
            tau, x = free, x + V0 * (free - tau)
            if tau >= END:
                break
            events += 1
        sign = math.copysign(1.0, bond_force(tau, x, amplitude, ratio))
        # Slightly off v_r = 0, otherwise the event fires again immediately.
        v = V0 - 1e-12 * sign
    return events


began, events, periods = time.process_time(), 0, 0.0
for amplitude in (0.1, 0.3, 0.5, 0.8):
    for ratio in (5.0, 10.0):
        events += simulate(amplitude, ratio)
        periods += ratio * END / math.tau
cost = (time.process_time() - began) / periods * 1e6
print(json.dumps({"stick_slip": cost, "events_per_period": events / periods}))
