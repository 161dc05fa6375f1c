"""Values of the special functions to 50 digits, for reference/special.csv.

Run with mpmath 1.x:  python reference/scripts/special.py > reference/special.csv
The arguments are doubles, printed so that they read back exactly.
"""
import mpmath as mp

mp.mp.dps = 50
functions = {
    "i0e": lambda x: mp.besseli(0, x) * mp.exp(-abs(x)),
    "i1e": lambda x: mp.besseli(1, x) * mp.exp(-abs(x)),
    "erf": mp.erf,
    "erfc": mp.erfc,
    "erfcx": lambda x: mp.exp(x * x) * mp.erfc(x),
    "dawson": lambda x: mp.sqrt(mp.pi) / 2 * mp.exp(-x * x) * mp.erfi(x),
    "exp": mp.exp,
    "expm1": mp.expm1,
    "ln_1p": mp.log1p,
}
positive = [10.0 ** (-10 + k / 10) for k in range(131)]
print("# function,argument,value (50-digit arithmetic, 22 digits printed)")
for name, function in functions.items():
    for x in positive:
        if name == "erfc" and x > 26:
            continue
        if name in ("exp", "expm1") and x > 700:
            continue
        print(f"{name},{x!r},{mp.nstr(function(mp.mpf(x)), 22)}")
    if name in ("erfcx", "exp", "expm1", "ln_1p"):
        for x in [k / 64 for k in range(-128, 0)]:
            if name == "ln_1p" and x <= -1:
                continue
            print(f"{name},{x!r},{mp.nstr(function(mp.mpf(x)), 22)}")
