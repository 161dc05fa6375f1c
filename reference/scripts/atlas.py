"""Grazing amplitudes and neutral dampings of a belt in slip, in dimensionless groups: writes atlas.json.

Plain Python, independent of Quell: y'' + 2 zeta y' + y = 2 zeta_f f(w)/max|f'| + D g(R t), w = v0 - y', lengths over v_m. The period is integrated
by the extrapolated midpoint rule with its variational equation and the integral of the damping, between the breaks of the waveform. The
periodic response is found by Newton's method, the grazing by a secant on the least w, the neutral damping by iteration. Everything is
done with two numbers of steps; their largest difference is `two_ways`.
"""

import json
import math
from pathlib import Path

LAWS = {
    "stribeck": (1.5, lambda w: -1.5 * (w - w**3 / 3), lambda w: -1.5 * (1 - w * w)),
    "decreasing": (1.0, lambda w: math.exp(-w), lambda w: -math.exp(-w)),
    "stribeck-exponential": (math.sqrt(2 / math.e), lambda w: math.exp(-w * w), lambda w: -2 * w * math.exp(-w * w)),
}


def triangle(theta):
    x = theta / (math.pi / 2)
    return x if x <= 1 else 2 - x if x <= 3 else x - 4


WAVES = {
    "sine": (lambda theta, _: math.sin(theta), [0, 2 * math.pi]),
    "triangle": (lambda theta, _: triangle(theta), [0, math.pi / 2, 3 * math.pi / 2, 2 * math.pi]),
    "square": (lambda theta, middle: 1.0 if middle < math.pi else -1.0, [0, math.pi, 2 * math.pi]),
}
COUNTS = [2, 4, 6, 8, 10, 12]


class Belt:
    def __init__(self, law, wave, zeta, zeta_f, v0, ratio, steps):
        self.steepest, self.f, self.slope = LAWS[law]
        self.g, self.breaks = WAVES[wave]
        self.zeta, self.zeta_f, self.v0, self.ratio, self.steps = zeta, zeta_f, v0, ratio, steps

    def rates(self, theta, s, amplitude, middle):
        y, u, a, b, c, d, _ = s
        w = self.v0 - u
        slope = 2 * self.zeta_f * self.slope(w) / self.steepest
        force = 2 * self.zeta_f * self.f(w) / self.steepest + amplitude * self.g(theta, middle)
        damping = 2 * self.zeta + slope
        r = self.ratio
        return [u / r, (force - 2 * self.zeta * u - y) / r, c / r, d / r, (-damping * c - a) / r, (-damping * d - b) / r, damping / r]

    def step(self, theta, s, h, amplitude, middle):
        """The extrapolated midpoint rule."""
        table = []
        for count in COUNTS:
            k = h / count
            before, now = s, [x + k * f for x, f in zip(s, self.rates(theta, s, amplitude, middle))]
            for i in range(1, count):
                rates = self.rates(theta + i * k, now, amplitude, middle)
                before, now = now, [x + 2 * k * f for x, f in zip(before, rates)]
            rates = self.rates(theta + h, now, amplitude, middle)
            row = [[0.5 * (x + y + k * f) for x, y, f in zip(now, before, rates)]]
            for j, previous in enumerate(table[-1] if table else []):
                q = (count / COUNTS[len(table) - j - 1]) ** 2 - 1
                row.append([x + (x - z) / q for x, z in zip(row[j], previous)])
            table.append(row)
        return table[-1][-1]

    def period(self, start, amplitude):
        """State after a period, its derivative, the mean damping, and the least slip velocity."""
        s = [start[0], start[1], 1.0, 0.0, 0.0, 1.0, 0.0]
        least = self.v0 - s[1]
        for low, high in zip(self.breaks, self.breaks[1:]):
            count = max(1, round(self.steps * (high - low) / (2 * math.pi)))
            middle = 0.5 * (low + high)
            h = (high - low) / count
            for i in range(count):
                theta = low + i * h
                after = self.step(theta, s, h, amplitude, middle)
                ends = [self.rates(at, x, amplitude, middle)[1] for at, x in ((theta, s), (theta + h, after))]
                if ends[0] > 0 >= ends[1]:
                    a, b = 0.0, h
                    for _ in range(60):
                        m = 0.5 * (a + b)
                        at = self.step(theta, s, m, amplitude, middle)
                        a, b = (m, b) if self.rates(theta + m, at, amplitude, middle)[1] > 0 else (a, m)
                    least = min(least, self.v0 - at[1])
                s = after
                least = min(least, self.v0 - s[1])
        return s, least

    def sliding(self):
        return (2 * self.zeta_f * self.f(self.v0) / self.steepest, 0.0)

    def response(self, amplitude, start):
        for _ in range(30):
            s, least = self.period(start, amplitude)
            r0, r1 = s[0] - start[0], s[1] - start[1]
            a, b, c, d = s[2] - 1, s[3], s[4], s[5] - 1
            det = a * d - b * c
            dx, dv = -(d * r0 - b * r1) / det, -(a * r1 - c * r0) / det
            start = (start[0] + dx, start[1] + dv)
            if abs(dx) + abs(dv) < 1e-13 * max(1.0, abs(start[0])):
                break
        return start, least, s[6] * self.ratio / (2 * math.pi)

    def grazing(self):
        """Followed from steady sliding in steps of at most an eighth of the way."""
        path = [(0.0, self.sliding(), self.v0)]
        longest = self.v0 * self.ratio / 8
        now = longest
        for _ in range(60):
            if len(path) == 1:
                start = self.sliding()
                fast = {2: 1.0, 4: math.pi / 4, 3: math.pi / 2}[len(self.breaks)] * now / self.ratio
                start = (start[0], -fast)
            else:
                (d0, s0, _), (d1, s1, _) = path[-2:]
                share = (now - d0) / (d1 - d0)
                start = tuple(x + share * (y - x) for x, y in zip(s0, s1))
            start, least, _ = self.response(now, start)
            path.append((now, start, least))
            (d0, _, l0), (d1, _, l1) = path[-2:]
            step = l1 * (d1 - d0) / (l0 - l1)
            if abs(step) < 1e-12 * now:
                break
            now += max(-longest, min(longest, step))
        return now, start


def grazing(law, wave, kappa, zeta_f, v0, ratio, steps):
    return Belt(law, wave, kappa * zeta_f, zeta_f, v0, ratio, steps).grazing()[0]


def neutral(law, wave, share, zeta_f, v0, ratio, steps):
    kappa = 0.5
    for _ in range(40):
        belt = Belt(law, wave, max(kappa, 0.0) * zeta_f, zeta_f, v0, ratio, steps)
        amplitude, start = belt.grazing()
        guess = tuple(x + share * (y - x) for x, y in zip(belt.sliding(), start))
        _, _, damping = belt.response(share * amplitude, guess)
        after = max(kappa, 0.0) - 0.5 * damping / zeta_f
        if abs(after - kappa) < 1e-12:
            break
        kappa = after
    return after


def main():
    points = [(0.3, 0.5, 7.0, 0.05, 0.7), (0.05, 0.2, 3.5, 0.2, 0.9), (0.7, 0.35, 25.0, 0.4, 0.4)]
    fastest = {"stribeck": 1.0, "decreasing": 5.0, "stribeck-exponential": 2.5}
    cases, worst = [], 0.0
    for law in LAWS:
        for wave in WAVES:
            for kappa, velocity, ratio, fall, share in points:
                v0, zeta_f = velocity * fastest[law], fall * ratio
                two = [
                    (grazing(law, wave, kappa, zeta_f, v0, ratio, steps), neutral(law, wave, share, zeta_f, v0, ratio, steps)) for steps in (32, 48)
                ]
                worst = max([worst] + [abs(x - y) / max(abs(x), 0.1) for x, y in zip(*two)])
                cases.append(
                    dict(
                        law=law, waveform=wave, relative_damping=kappa, relative_velocity=v0, frequency_ratio=ratio, friction_damping=zeta_f,
                        grazing_share=share, grazing_amplitude=two[1][0], neutral_damping=two[1][1],
                    )
                )
    about = "Grazing amplitude D/v_m and neutral damping of belts in slip, see scripts/atlas.py"
    text = json.dumps(dict(about=about, two_ways=worst, cases=cases), indent=1)
    (Path(__file__).parents[1] / "atlas.json").write_text(text + "\n", encoding="utf-8")
    print(worst)


if __name__ == "__main__":
    main()
