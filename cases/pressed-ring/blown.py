#!/usr/bin/env python3
"""Inner and outer displacement of a ring blown up by a pressure, at finite strain: equilibrium of thin rings one within
the other, (P_r R)' = P_t with the nominal stresses of the neo-Hookean law, by Runge and Kutta's rule."""
from math import log
import sys

MU, LAMBDA = 1e6 / 2.6, 1e6 * 0.3 / (1.3 * 0.4)


def bisect(f, low, high):
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if f(middle) > 0 else (middle, high)
    return low


def nominal(a, b):
    return (LAMBDA * log(a * b) + MU * (a * a - 1)) / a


def slopes(R, r, force):
    around = r / R
    along = bisect(lambda a: nominal(a, around) - force / R, 1e-3, 10)
    return along, nominal(around, along)


def outside(p, r, n=800):
    """The force on the outer circle and its radius, if the inner one has come to r."""
    R, h, force = 1.0, 1.0 / n, -p * r
    for _ in range(n):
        a, b = slopes(R, r, force)
        c, d = slopes(R + h / 2, r + h / 2 * a, force + h / 2 * b)
        R, r, force = R + h, r + h * c, force + h * d
    return force, r


p = float(sys.argv[1])
r = bisect(lambda r: outside(p, r)[0], 1.0, 1.9)
print("inside %.7f, outside %.7f" % (r - 1, outside(p, r)[1] - 2))
