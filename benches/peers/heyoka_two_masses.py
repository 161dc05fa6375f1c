"""Two masses on two contacts with heyoka.py: one adaptive Taylor integrator for each set of sticking contacts, zeros of slip
velocities and of stick margins as terminal events, decisions in Python. Prints CPU µs per dither period as JSON."""

import itertools
import json

import heyoka as hy

import two_masses as work

TOLERANCE = 1e-10
SOON = 1e-9  # An event this soon after a release is the release itself.

x1, x2, v1, v2 = hy.make_vars("x1", "x2", "v1", "v2")
X, V = (x1, x2), (v1, v2)


def needed(contact):
    row = work.STIFFNESS[contact]
    force = row[0] * x1 + row[1] * x2 + work.DAMPING * V[contact]
    return force - work.AMPLITUDE * hy.sin(work.FREQUENCY * hy.time) if contact == 0 else force


def integrator(sticks):
    """The integrator of one set of sticking contacts, and the contact of each of its events."""
    equations, events, contacts = [(x1, v1), (x2, v2)], [], []
    down, up = hy.event_direction.negative, hy.event_direction.positive
    for contact in range(2):
        if sticks[contact]:
            equations.append((V[contact], 0.0 * x1))
            events.append(hy.t_event(needed(contact) - work.STATIC, direction=up, cooldown=SOON))
            events.append(hy.t_event(needed(contact) + work.STATIC, direction=down, cooldown=SOON))
            contacts += [contact] * 2
        else:
            sign = hy.par[contact]
            slip = work.BELT_VELOCITY - V[contact]
            equations.append((V[contact], work.stribeck(slip, sign) - needed(contact)))
            events.append(hy.t_event(sign * slip, direction=down, cooldown=SOON))
            contacts.append(contact)
    pars = [1.0] * (2 if not sticks[1] else 1 if not sticks[0] else 0)  # heyoka wants no more than are used.
    return hy.taylor_adaptive(equations, [0.0] * 4, tol=TOLERANCE, t_events=events, pars=pars), contacts


INTEGRATORS = {sticks: integrator(sticks) for sticks in itertools.product((False, True), repeat=2)}


def run():
    """Number of events and the final state."""
    now, state, signs, events = 0.0, [0.0] * 4, [1, 1], 0
    while now < work.END:
        current, contacts = INTEGRATORS[tuple(sign == 0 for sign in signs)]
        current.time, current.state[:] = now, state
        current.pars[:] = signs[: len(current.pars)]
        current.reset_cooldowns()
        while True:
            outcome = current.propagate_until(work.END)[0]
            if outcome == hy.taylor_outcome.time_limit or current.time > now + SOON:
                break
        now, state = current.time, list(current.state)
        if outcome == hy.taylor_outcome.time_limit:
            break
        contact = contacts[-int(outcome) - 1]
        events += 1
        if signs[contact]:
            state[2 + contact] = work.BELT_VELOCITY
            signs[contact] = work.decided(contact, now, state[:2], state[2:])
        else:
            force = work.needed(contact, now, state[:2], state[2:])
            signs[contact] = 1 if force > 0 else -1
    return events, state


cost, (events, state) = work.timed(run)
print(json.dumps({"cost": cost, "events": events, "final": [float(value) for value in state]}))
