"""Effective friction over a wide grid, for reference/averaging_wide.csv.

Run with mpmath 1.x:  python reference/scripts/averaging_wide.py > reference/averaging_wide.csv
Computed from the definition <mu(v - alpha G)> over a quarter wave of G with 40 digits, without closed forms. The
inputs are doubles, printed so that they read back exactly, and enter the arithmetic with their exact values.
"""
import mpmath as mp

mp.mp.dps = 40
STATIC, MINIMUM, VM = mp.mpf(0.4), mp.mpf(0.2857), mp.mpf(0.2)
PEAK = {"sine": mp.mpf(1), "triangle": mp.pi / 4, "square": mp.pi / 2}
QUARTER = {  # sigma, its slope, its inverse
    "sine": (mp.sin, mp.cos, mp.asin),
    "triangle": (
        lambda d: d - d * d / mp.pi,
        lambda d: 1 - 2 * d / mp.pi,
        lambda s: mp.pi / 2 * (1 - mp.sqrt(1 - 4 * s / mp.pi)),
    ),
    "square": (lambda d: d, lambda d: mp.mpf(1), lambda s: s),
}


def stribeck(u):
    w = u / VM
    return STATIC - (STATIC - MINIMUM) * mp.mpf(3) / 2 * (w - w**3 / 3)


def stribeck_slope(u):
    w = u / VM
    return -(STATIC - MINIMUM) * mp.mpf(3) / 2 / VM * (1 - w * w)


def decreasing(u):
    return MINIMUM + (STATIC - MINIMUM) * mp.exp(-u / VM)


def decreasing_slope(u):
    return -(STATIC - MINIMUM) / VM * mp.exp(-u / VM)


LAWS = {"stribeck": (stribeck, stribeck_slope), "decreasing": (decreasing, decreasing_slope)}


def mean(law, wave, alpha, v):
    value, slope = LAWS[law]
    sigma, steepness, inverse = QUARTER[wave]
    peak = alpha * PEAK[wave]
    end = mp.pi / 2
    crossing = inverse(v / alpha) if v < peak else end
    cuts = {mp.mpf(0), crossing, end}
    for offset in (-150, -80, -40, -16, -6, -2, 2, 6, 16, 40, 80, 150):
        s = v + offset * VM
        if 0 < s < peak:
            cuts.add(inverse(s / alpha))
        s = peak - abs(offset) * VM
        if 0 < s < peak:
            cuts.add(inverse(s / alpha))
    cuts = sorted(cuts)
    # mp.quad uses an absolute error: scale tiny outer slopes to order one for the integration.
    size = mp.exp((v - peak) / VM) if law == "decreasing" and v > peak else mp.mpf(1)
    total = rate = total_error = rate_error = mp.mpf(0)
    for a, b in zip(cuts, cuts[1:]):
        sign = 1 if b <= crossing else -1
        part, error = mp.quad(
            lambda d: value(v + alpha * sigma(d)) + sign * value(abs(v - alpha * sigma(d))), [a, b], error=True
        )
        total += part
        total_error += error
        part, error = mp.quad(
            lambda d: size * (slope(v + alpha * sigma(d)) + slope(abs(v - alpha * sigma(d)))), [a, b], error=True
        )
        rate += part
        rate_error += error
    assert total_error < 1e-15 * abs(total), (law, wave, alpha, v, total_error / total)
    assert rate_error < 1e-12 * abs(rate), (law, wave, alpha, v, rate_error / rate)
    total, rate = total / mp.pi, rate / mp.pi / size
    if v < peak:
        rate += 2 * value(mp.mpf(0)) / (mp.pi * alpha * steepness(crossing))
    return total, rate


print("# law,waveform,alpha,v,mubar,slope; static 0.4, minimum 0.2857, v_m 0.2, as doubles")
for law in LAWS:
    for wave in QUARTER:
        for ratio in (1e-6, 1e-4, 1e-2, 0.1, 0.5, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0):
            alpha = ratio * 0.2
            corner = alpha * float(PEAK[wave])
            speeds = {f * corner for f in (1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999, 1.001, 1.1, 2.0)}
            speeds |= {f * 0.2 for f in (1e-6, 1e-3, 0.05, 0.7, 1.3, 3.0)}
            for v in sorted(speeds):
                m, s = mean(law, wave, mp.mpf(alpha), mp.mpf(v))
                print(f"{law},{wave},{alpha!r},{v!r},{mp.nstr(m, 20)},{mp.nstr(s, 20)}", flush=True)
