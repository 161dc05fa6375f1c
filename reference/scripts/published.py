"""Published cases, recomputed by an integrator written without Quell: an extrapolated midpoint rule of order 16, events by bisection.

x'' + 2 zeta x' + x = mu(|v_r|) sign(v_r) + D sin(R t) with v_r = v0 - x'. The mass sticks while the holding force of the belt,
x + 2 zeta v0 - D sin(R t), is at most mu_s. Plain Python without packages. Prints the numbers of ../published.json.
"""

import math

STEP = 0.02
COLUMNS = 8


class Belt:
    """A mass on a belt."""

    def __init__(self, zeta, v0, mu, mu_s, d=0.0, r=1.0):
        self.zeta, self.v0, self.mu, self.mu_s, self.d, self.r = zeta, v0, mu, mu_s, d, r

    def force(self, t):
        return self.d * math.sin(self.r * t)

    def rate(self, t, x, v, sign):
        # The branch of this sign is continued beyond v_r = 0, as far as a step overshoots.
        return v, -x - 2 * self.zeta * v + sign * self.mu(sign * (self.v0 - v)) + self.force(t)

    def step(self, t, x, v, sign, h):
        """One step of Gragg's midpoint rule, extrapolated."""
        table = []
        for k in range(1, COLUMNS + 1):
            n = 2 * k
            s = h / n
            a, b = (x, v), self.rate(t, x, v, sign)
            c = (x + s * b[0], v + s * b[1])
            for i in range(1, n):
                b = self.rate(t + i * s, *c, sign)
                a, c = c, (a[0] + 2 * s * b[0], a[1] + 2 * s * b[1])
            b = self.rate(t + h, *c, sign)
            row = [tuple(0.5 * (a[i] + c[i] + s * b[i]) for i in (0, 1))]
            for j in range(1, k):
                share = 1.0 / ((k / (k - j)) ** 2 - 1.0)
                row.append(tuple(row[j - 1][i] + share * (row[j - 1][i] - table[-1][j - 1][i]) for i in (0, 1)))
            table.append(row)
        return table[-1][-1]

    def slide(self, t, x, v, sign, until=1e9, past=None):
        """Slides until v_r = 0, or until `past(t, x, v)` changes its sign."""
        met = past or (lambda t, x, v: sign * (self.v0 - v))
        before = met(*((t, *self.step(t, x, v, sign, 1e-3)) if past is None else (t, x, v)))
        while t < until:
            h = min(STEP, until - t)
            after = met(t + h, *self.step(t, x, v, sign, h))
            if before * after <= 0.0:
                low, high = 0.0, h
                while high - low > 1e-16 * max(1.0, t):
                    middle = 0.5 * (low + high)
                    if middle in (low, high):
                        break
                    if before * met(t + middle, *self.step(t, x, v, sign, middle)) > 0.0:
                        low = middle
                    else:
                        high = middle
                return t + high, *self.step(t, x, v, sign, high), True
            t, (x, v) = t + h, self.step(t, x, v, sign, h)
            before = after
        return t, x, v, False

    def held(self, t, x):
        return x + 2 * self.zeta * self.v0 - self.force(t)

    def stick(self, t, x, until=1e9):
        """Sticks until the threshold: time and position, and whether the mass is released."""
        begin, at = t, x
        beyond = lambda s: abs(self.held(s, at + self.v0 * (s - begin))) - self.mu_s
        while t < until and beyond(t + 1e-3) <= 0.0:
            t += 1e-3
        low, high = t, t + 1e-3
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if beyond(middle) <= 0.0 else (low, middle)
        return high, at + self.v0 * (high - begin), high < until


def cycle(belt):
    """Period and stick fraction of the stick-slip cycle without dither."""
    x = belt.mu_s - 2 * belt.zeta * belt.v0
    slip, landed, _, _ = belt.slide(0.0, x, belt.v0, 1)
    stick = (x - landed) / belt.v0
    return slip + stick, stick / (slip + stick)


def driven(belt):
    """The half period of the symmetric response with stick: durations of stick and slip, and the position of the stick."""
    t, x, sign = 0.0, 0.0, 0
    for _ in range(60):
        at = (t, x)
        t, x, _ = belt.stick(t, x)
        released = t
        sign = -1 if belt.held(t, x) < 0 else 1
        # The mass moves against the force that held it: v_r = v0 - x' has the sign of that force.
        t, x, v, _ = belt.slide(t, x, 0.0, sign)
    return released - at[0], t - released, x


def end_of_bistability():
    """The belt velocity in m/s up to which a release is followed by stick, for the mass of Veraszto and Stepan."""
    m, b, k = 0.538, 5.746, 6957.0
    omega = math.sqrt(k / m)

    def above(speed):
        """Difference between the belt velocity and the first maximum of x' after a release."""
        mu = lambda v: (2.0 + 4.0 * math.exp(-10.0 * omega * v) + 0.2 * omega * v) / k
        belt = Belt(b / (2 * m * omega), speed / omega, mu, 6.0 / k)
        t, x, v = 0.0, 6.0 / k - 2 * belt.zeta * belt.v0, belt.v0
        # First down to the lowest velocity, then up to the next point with x'' = 0, unless the belt velocity is reached before.
        bend = lambda t, x, v: belt.rate(t, x, v, 1)[1]
        t, (x, v) = 0.5, belt.slide(0.0, x, v, 1, until=0.5)[1:3]
        t, x, v, _ = belt.slide(t, x, v, 1, past=bend)
        t, (x, v) = t + 0.5, belt.slide(t, x, v, 1, until=t + 0.5)[1:3]
        t, x, v, _ = belt.slide(t, x, v, 1, past=bend)
        return belt.v0 - v

    low, high = 0.2, 0.32
    while high - low > 1e-13:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if above(middle) > 0.0 else (middle, high)
    return low


def coulomb_decay(x, v):
    """Final position of an oscillator with friction 1 from (x, v) with v > 0."""
    belt = Belt(0.0, 0.0, lambda _: 1.0, 1.0)
    sign = -1
    t = 0.0
    while True:
        t, x, v, _ = belt.slide(t, x, v, sign)
        if abs(x) <= 1.0:
            return x
        v, sign = 0.0, -sign


if __name__ == "__main__":
    print("driven, R = 0.6: stick, slip, place", driven(Belt(0.05, 0.0, lambda _: 1.0, 1.1, 1.5, 0.6)))
    print("Leine, delta = 3: period, stick", cycle(Belt(0.0, 0.2, lambda v: 1 / (1 + 3 * v), 1.0)))
    print("Carlson-Langer: period, stick", cycle(Belt(0.0, 0.01, lambda v: 1 / (1 + 5 * v), 1.0)))
    print("decay: stops at", coulomb_decay(12.0, 6.0), "exactly", 15 - math.sqrt(205))
    print("Veraszto-Stepan: end of bistability", end_of_bistability())
