"""The workload `two-masses`: two masses in a row, each on its own belt, with dither on the first.

Equations, numbers and the decision of a contact, shared by the peers, so that all of them do the same work.
State: x₁, x₂, v₁, v₂.
"""

import math
import sys
import time

STATIC, LEAST, VELOCITY_OF_LEAST = 0.4, 0.2857, 0.2
STIFFNESS = ((2.2, -1.2), (-1.2, 2.2))
DAMPING = 0.02
BELT_VELOCITY = 0.05
AMPLITUDE, FREQUENCY = 0.4, 10.0
END = float(sys.argv[1]) if len(sys.argv) > 1 else 200.0
PERIODS = FREQUENCY * END / math.tau


def stribeck(slip, sign):
    """Cubic Stribeck law with the sign of the slip given."""
    w = slip / VELOCITY_OF_LEAST
    return STATIC * sign - 1.5 * (STATIC - LEAST) * (w - w * w * w / 3.0)


def needed(contact, t, x, v):
    """Friction that keeps the velocity of a mass."""
    row = STIFFNESS[contact]
    applied = AMPLITUDE * math.sin(FREQUENCY * t) if contact == 0 else 0.0
    return row[0] * x[0] + row[1] * x[1] + DAMPING * v[contact] - applied


def decided(contact, t, x, v):
    """0 for a contact that sticks from slip velocity 0 on; otherwise the sign of its slip.

    The contacts act on different masses, so that each is decided alone.
    """
    force = needed(contact, t, x, v)
    return 0 if abs(force) <= STATIC else int(math.copysign(1, force))


def timed(work):
    """CPU time of `work()` in µs per dither period, and its result."""
    began = time.process_time()
    result = work()
    return (time.process_time() - began) / PERIODS * 1e6, result
