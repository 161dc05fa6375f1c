"""Averages of `coulomb` and `stribeck-exponential` in reference/laws.json, from their definition.

Run with mpmath 1.x:  python reference/scripts/laws.py reference/laws.json
mean = <mu(v - alpha G)> over a period, where G is the zero-mean integral of the waveform and alpha = D/R. The integral is split
where the slip v - alpha G changes sign. The script prints the largest relative difference from the stored coefficients.
"""
import json
import sys
import tomllib

import mpmath as mp

mp.mp.dps = 25


def integral_of(waveform):
    """G over [0, 2 pi) in two branches, with the cosine's phase; peaks 1, pi/4, pi/2."""
    half = mp.pi / 2
    if waveform == "sine":
        return lambda t: -mp.cos(t)
    if waveform == "square":
        return lambda t: t - half if t < mp.pi else 3 * half - t
    # Triangle: rises through 0 at t = 0; G' = g.
    def triangle(t):
        if t < half:
            return t * t / mp.pi - mp.pi / 4
        if t < 3 * half:
            u = t - mp.pi
            return mp.pi / 4 - u * u / mp.pi
        u = t - 2 * mp.pi
        return u * u / mp.pi - mp.pi / 4

    return triangle


def law_of(friction):
    def number(key, default=0.0):
        return mp.mpf(friction.get(key, default))

    def coefficient(speed):
        value = number("coefficient") + number("viscous") * speed
        if friction["law"] == "stribeck-exponential":
            fall = number("static_coefficient") - number("coefficient")
            value += fall * mp.exp(-((speed / number("reference_velocity")) ** number("exponent", 2.0)))
        return value

    return coefficient


def mean(law, waveform, alpha, v):
    g = integral_of(waveform)
    slip = lambda t: v - alpha * g(t)
    cuts = [mp.mpf(0), mp.pi / 2, mp.pi, 3 * mp.pi / 2, 2 * mp.pi]
    for a, b in zip(cuts[:4], cuts[1:5]):
        if mp.sign(slip(a)) * mp.sign(slip(b - mp.mpf(10) ** -20)) < 0:
            cuts.append(mp.findroot(slip, (a, b), solver="anderson", tol=mp.mpf(10) ** -40, verify=False))
    friction = lambda t: mp.sign(slip(t)) * law(abs(slip(t)))
    return mp.quad(friction, sorted(cuts)) / (2 * mp.pi)


def main(path):
    worst = mp.mpf(0)
    for row in json.load(open(path))["averages"]:
        study = tomllib.loads(row["study"])
        dither = study["dither"]
        alpha = mp.mpf(dither["amplitude"]) / mp.mpf(dither["frequency_ratio"])
        for v, stored in zip(row["slip_velocity"], row["coefficient"]):
            found = mean(law_of(study["friction"]), dither["waveform"], alpha, mp.mpf(v))
            worst = max(worst, abs(found / mp.mpf(stored) - 1))
    print(mp.nstr(worst, 3))


main(sys.argv[1])
