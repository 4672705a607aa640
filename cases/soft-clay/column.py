#!/usr/bin/env python3
"""How far a fill as wide as the clay itself makes it settle, without talus: at each depth the rate equations of Modified Cam Clay are
integrated in one dimension by Runge and Kutta's method (slopes of ln v over ln of Kirchhoff's pressure, theory section 4), from the stress of the
weight (K0) until the vertical Cauchy stress is that of weight and fill; the settlement is the sum of what all depths shorten.

    python3 column.py [FILL in Pa ...]"""
import sys
import numpy as np

DEPTH, WEIGHT, K0, OCR = 6.0, 1700 * 9.81, 0.6, 1.5
M2, SHEAR = 1.0, 2e6
LAMBDA, KAPPA = (x / 2.2 / (1 - x / 2.2) for x in (0.2, 0.04))
STEP = 2e-4


def invariants(y):
    """p, q and p_c of y = (tau_v, tau_h, p_c)."""
    return -(y[0] + 2 * y[1]) / 3, abs(y[0] - y[1]), y[2]


def f(y):
    p, q, pc = invariants(y)
    return q * q / M2 + p * (p - pc)


def rate(y, plastic):
    """By the vertical logarithmic strain, which shortens: de = -1."""
    p, q, pc = invariants(y)
    D = np.full((3, 3), p / KAPPA - 2 / 3 * SHEAR) + 2 * SHEAR * np.eye(3)
    e, gamma, grows = np.array([-1.0, 0, 0]), 0.0, 0.0
    s = np.array([y[0], y[1], y[1]])
    n = 3 * (s + p) / M2 - (2 * p - pc) / 3
    if plastic:
        grows = pc / (LAMBDA - KAPPA) * (2 * p - pc)
        gamma = max(0.0, n @ D @ e / (n @ D @ n + p * grows))
    t = D @ (e - gamma * n)
    return np.array([t[0], t[1], gamma * grows])


def advance(y, h, plastic):
    a = rate(y, plastic)
    b = rate(y + h / 2 * a, plastic)
    c = rate(y + h / 2 * b, plastic)
    return y + h / 6 * (a + 2 * b + 2 * c + rate(y + h * c, plastic))


def step(y, h):
    if f(y) < -1e-9 * y[2] ** 2:
        to = advance(y, h, False)
        if f(to) <= 0:
            return to
        low, high = 0.0, h
        for _ in range(50):
            middle = (low + high) / 2
            low, high = (middle, high) if f(advance(y, middle, False)) < 0 else (low, middle)
        return advance(advance(y, low, False), h - low, True)
    return advance(y, h, True)


def shortening(depth, fill):
    """1 - J where the vertical stress has become that of weight and fill."""
    v = -WEIGHT * depth
    y = np.array([v, K0 * v, 0.0])
    p, q, _ = invariants(y)
    y[2] = OCR * (p + q * q / M2 / p)
    wanted, e = v - fill, 0.0
    while True:
        to = step(y, STEP)
        if to[0] * np.exp(e + STEP) <= wanted:  # sigma = tau / J
            break
        y, e = to, e + STEP
    low, high = 0.0, STEP
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (low, middle) if step(y, middle)[0] * np.exp(e + middle) <= wanted else (middle, high)
    return 1 - np.exp(-e - low)


if __name__ == "__main__":
    x, w = np.polynomial.legendre.leggauss(24)
    s = (x + 1) / 2  # depth = DEPTH s^3: points crowd where the stress of the weight goes to zero
    for fill in [float(a) for a in sys.argv[1:]] or [10e3, 20e3, 40e3]:
        print(f"{fill:g} Pa: {sum(wi / 2 * DEPTH * 3 * si * si * shortening(DEPTH * si**3, fill) for si, wi in zip(s, w)):.6f} m")
