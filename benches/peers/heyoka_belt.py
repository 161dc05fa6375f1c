"""Both workloads with heyoka.py: adaptive Taylor steps compiled by LLVM, v_r = 0 as a terminal
event, and stick phases in Python. Prints CPU µs per dither period as JSON."""

import json
import math
import time

import heyoka as hy
import numpy as np
from scipy.optimize import brentq

MU_S, MU_M, V_M, ZETA = 0.4, 0.2857, 0.2, 0.005
TOLERANCE, END = 1e-10, 200.0

x, v = hy.make_vars("x", "v")
belt_velocity, amplitude, ratio, sign = (hy.par[i] for i in range(4))
slip = (belt_velocity - v) / V_M
stribeck = MU_S * sign - 1.5 * (MU_S - MU_M) * (slip - slip * slip * slip / 3)
decreasing = sign * (MU_M + (MU_S - MU_M) * hy.exp(-sign * slip))


def equations(friction):
    force = friction + amplitude * hy.sin(ratio * hy.time)
    return [(x, v), (v, force - 2 * ZETA * v - x)]


def stick_slip(ta, v0, d, r):
    """Number of events from rest to END."""
    ta.time, ta.state[:], ta.pars[:] = 0.0, (0.0, 0.0), (v0, d, r, 1.0)
    ta.reset_cooldowns()
    events = 0
    while ta.propagate_until(END)[0] != hy.taylor_outcome.time_limit:
        events += 1
        began, x0 = ta.time, ta.state[0]
        force = lambda t: 2 * ZETA * v0 + x0 + v0 * (t - began) - d * math.sin(r * t)
        if abs(force(began)) > MU_S:
            ta.pars[3] = -ta.pars[3]
            continue
        margin = lambda t: abs(force(t)) - MU_S
        step, left = 0.2 / r, began
        while left < END and margin(left + step) < 0:
            left += step
        if left >= END:
            break
        free = brentq(margin, left, left + step, xtol=1e-13) if margin(left) < 0 else left
        events += 1
        ta.time, ta.state[:] = free, (x0 + v0 * (free - began), v0)
        ta.pars[3] = math.copysign(1.0, force(free))
    return events


def per_period(work, periods):
    began = time.process_time()
    result = work()
    return (time.process_time() - began) / periods * 1e6, result


ta = hy.taylor_adaptive(equations(stribeck), [0.0, 0.0], tol=TOLERANCE,
                        t_events=[hy.t_event(belt_velocity - v)], pars=[0.05, 0.4, 10.0, 1.0])
cases = [(d, r) for d in (0.1, 0.3, 0.5, 0.8) for r in (5.0, 10.0)]
periods = sum(r * END / math.tau for _, r in cases)
cost, events = per_period(lambda: sum(stick_slip(ta, 0.05, d, r) for d, r in cases), periods)
out = {"stick_slip": cost, "events_per_period": events / periods}

pars = np.array([1.0, 2.0, 10.0, 1.0])
for lanes in (1, 8):
    if lanes == 1:
        free = hy.taylor_adaptive(equations(decreasing), [0.2, 0.0], tol=TOLERANCE, pars=pars)
    else:
        free = hy.taylor_adaptive_batch(equations(decreasing), np.tile([[0.2], [0.0]], (1, lanes)),
                                        tol=TOLERANCE, pars=np.tile(pars[:, None], (1, lanes)))
    cost, _ = per_period(lambda: free.propagate_until(2000.0), 10.0 * 2000.0 / math.tau * lanes)
    out["event_free" if lanes == 1 else "event_free_batch_of_8"] = cost
print(json.dumps(out))
