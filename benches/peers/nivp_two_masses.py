"""Two masses on two contacts with solve_nivp: implicit time stepping with friction as a projection (semismooth Newton with exact
Jacobians, trapezoidal rule, adaptive steps), no events. The state has the slip velocities in place of the velocities.
Prints CPU µs per dither period as JSON."""

import json

import numpy as np
from solve_nivp import solve_ivp_ns

import two_masses as work

RTOL, ATOL = 1e-4, 1e-5
STIFFNESS = np.array(work.STIFFNESS)


def smooth(t, state):
    x, slip = state[:2], state[2:]
    v = work.BELT_VELOCITY - slip
    force = np.array([work.AMPLITUDE * np.sin(work.FREQUENCY * t), 0.0])
    return np.concatenate([v, STIFFNESS @ x + work.DAMPING * v - force])


def smooth_jacobian(*_):
    matrix = np.zeros((4, 4))
    matrix[:2, 2:] = -np.eye(2)
    matrix[2:, :2] = STIFFNESS
    matrix[2:, 2:] = -work.DAMPING * np.eye(2)
    return matrix


def friction(state, *_):
    bound = np.zeros(4)
    bound[2:] = [work.stribeck(abs(slip), 1.0) for slip in state[2:]]
    return bound


def friction_jacobian(state, *_):
    matrix = np.zeros((4, 4))
    for place in (2, 3):
        w = state[place] / work.VELOCITY_OF_LEAST
        slope = -1.5 * (work.STATIC - work.LEAST) * (1.0 - w * w) / work.VELOCITY_OF_LEAST
        matrix[place, place] = slope * np.sign(w)
    return matrix


def run():
    """Number of steps and the final state."""
    start = np.array([0.0, 0.0, work.BELT_VELOCITY, work.BELT_VELOCITY])
    t, y, *_ = solve_ivp_ns(
        fun=smooth, t_span=(0.0, work.END), y0=start, method="trapezoidal", projection="coulomb",
        solver="semismooth_newton", rtol=RTOL, atol=ATOL, h0=1e-3,
        projection_opts={
            "con_force_func": friction, "jac_func": friction_jacobian, "rhok": 1.0, "constraint_indices": [2, 3],
        },
        solver_opts={"tol": 1e-10, "rhs_jac": smooth_jacobian},
        component_slices=[slice(0, 2), slice(2, 4)],
    )
    return len(t), [*y[-1][:2], *(work.BELT_VELOCITY - y[-1][2:])]


cost, (steps, state) = work.timed(run)
print(json.dumps({"cost": cost, "steps": steps, "final": [float(value) for value in state]}))
