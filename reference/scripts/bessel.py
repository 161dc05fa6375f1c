"""Bessel functions to 40 digits, for reference/bessel.csv.

Run with mpmath 1.x:  python reference/scripts/bessel.py > reference/bessel.csv
I is multiplied by e^-x and K by e^x. The arguments are doubles, printed so that they read back exactly.
"""
import mpmath as mp

mp.mp.dps = 40
functions = {
    "j": mp.besselj,
    "y": mp.bessely,
    "i": lambda n, x: mp.besseli(n, x) * mp.exp(-x),
    "k": lambda n, x: mp.besselk(n, x) * mp.exp(x),
}
print("# function,order,argument,value (40-digit arithmetic, 20 digits printed)")
for name, function in functions.items():
    for order in (0, 1, 2, 3, 5, 8, 13, 18, 21):
        for step in range(26):
            x = 10.0 ** (-2 + step / 5)
            print(f"{name},{order},{x!r},{mp.nstr(function(order, mp.mpf(x)), 20)}")
