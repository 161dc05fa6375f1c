"""Fits the laws of reference/fits.json by Gauss-Newton with derivatives by central differences, in 40 digits, and prints the largest
relative difference from the stored numbers. Independent of Quell: plain Python and its decimal numbers. Run in this folder."""

import json
from decimal import Decimal as D
from decimal import getcontext
from pathlib import Path

getcontext().prec = 40

LAWS = {
    "decreasing": (
        ["static_coefficient", "minimum_coefficient", "reference_velocity"],
        lambda v, s, m, r: m + (s - m) * (-v / r).exp(),
    ),
    "stribeck": (
        ["static_coefficient", "minimum_coefficient", "reference_velocity"],
        lambda v, s, m, r: s - D("1.5") * (s - m) * (v / r - (v / r) ** 3 / 3),
    ),
    "coulomb": (["coefficient"], lambda v, c: c),
    "stribeck-exponential": (
        ["static_coefficient", "coefficient", "reference_velocity", "viscous"],
        lambda v, s, c, r, u: c + (s - c) * (-((v / r) ** 2)).exp() + u * v,
    ),
}


def solve(a, b):
    """Gauss-Jordan with pivoting; b has several columns."""
    n = len(a)
    rows = [list(a[i]) + list(b[i]) for i in range(n)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i in range(n):
            if i != k:
                factor = rows[i][k]
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k])]
    return [row[n:] for row in rows]


def fit(law, points, start):
    p, h = list(start), D("1e-14")
    for _ in range(60):
        residual = [c - law(v, *p) for v, c in points]
        columns = []
        for j in range(len(p)):
            up, down = list(p), list(p)
            up[j] += h * p[j]
            down[j] -= h * p[j]
            columns.append([(law(v, *up) - law(v, *down)) / (2 * h * p[j]) for v, _ in points])
        normal = [[sum(x * y for x, y in zip(a, b)) for b in columns] for a in columns]
        right = [[sum(x * y for x, y in zip(a, residual))] for a in columns]
        step = [row[0] for row in solve(normal, right)]
        p = [x + s for x, s in zip(p, step)]
        if max(abs(s / x) for s, x in zip(step, p)) < D("1e-25"):
            break
    n, k = len(points), len(p)
    rss = sum((c - law(v, *p)) ** 2 for v, c in points)
    unit = [[D(int(i == j)) for j in range(k)] for i in range(k)]
    covariance = [[x * rss / (n - k) for x in row] for row in solve(normal, unit)]
    tau = D("6.283185307179586476925286766559")
    aic = n * (rss / n).ln() + n * (1 + tau.ln()) + 2 * (k + 1)
    return p, covariance, (rss / (n - k)).sqrt(), aic


worst = D(0)
for case in json.loads(Path("../fits.json").read_text()):
    names, law = LAWS[case["law"]]
    lines = case["csv"].split("\n")[1:-1]
    points = [tuple(map(D, line.split(","))) for line in lines]
    start = [D(str(case["truth"][name])) for name in names]
    p, covariance, residual, aic = fit(law, points, start)
    pairs = [(residual, case["residual"]), (aic, case["aic"])]
    for i, name in enumerate(names):
        stored = case["parameters"][name]
        pairs += [(p[i], stored["value"]), (covariance[i][i].sqrt(), stored["standard_error"])]
        pairs += list(zip(covariance[i], case["covariance"]["matrix"][i]))
    difference = max(abs(x / D(str(y)) - 1) for x, y in pairs)
    worst = max(worst, difference)
    print(f"{case['law']}: {difference:.1e}")
print(f"worst: {worst:.1e}")
