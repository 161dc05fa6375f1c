"""Two masses on two contacts with SciPy: `solve_ivp` (RK45) with terminal events, decisions in Python.
Prints CPU µs per dither period as JSON."""

import json
import math

import numpy as np
from scipy.integrate import solve_ivp

import two_masses as work

RTOL, ATOL = 1e-8, 1e-10
# Without a limit the event search of `solve_ivp`, which looks at signs at the ends of steps, misses pairs of events in a step.
LONGEST = math.tau / work.FREQUENCY / 50
SOON = 1e-9  # An event this soon after a release is the release itself.


def slope(t, state, signs):
    x, v = state[:2], state[2:]
    forces = [
        0.0 if signs[c] == 0 else work.stribeck(work.BELT_VELOCITY - v[c], signs[c]) - work.needed(c, t, x, v)
        for c in range(2)
    ]
    return [v[0], v[1], *forces]


def guard(contact, signs):
    if signs[contact] == 0:
        def value(t, state, _):
            return work.STATIC - abs(work.needed(contact, t, state[:2], state[2:]))
    else:
        def value(_, state, signs):
            return signs[contact] * (work.BELT_VELOCITY - state[2 + contact])
    value.terminal, value.direction = True, -1
    return value


def run(longest=LONGEST):
    """Number of events and the final state."""
    now, state, signs, events = 0.0, np.zeros(4), [1, 1], 0
    while now < work.END:
        guards = [guard(contact, signs) for contact in range(2)]
        found = solve_ivp(
            slope, (now, work.END), state, rtol=RTOL, atol=ATOL, max_step=longest, events=guards, args=(signs,)
        )
        before, now, state = now, found.t[-1], found.y[:, -1].copy()
        if found.status == 0:
            break
        contact = next(c for c in range(2) if len(found.t_events[c]))
        if now < before + SOON:
            now += SOON
            continue
        events += 1
        if signs[contact]:
            state[2 + contact] = work.BELT_VELOCITY
            signs[contact] = work.decided(contact, now, state[:2], state[2:])
        else:
            signs[contact] = 1 if work.needed(contact, now, state[:2], state[2:]) > 0 else -1
    return events, list(state)


cost, (events, state) = work.timed(run)
free, (found, _) = work.timed(lambda: run(math.inf))
print(json.dumps({"cost": cost, "events": events, "final": [float(value) for value in state],
                  "free": {"cost": free, "events": found}}))
