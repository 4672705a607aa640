#!/usr/bin/env python3
"""Passive earth pressure of a rough wall by limit analysis: an upper bound of K = 2 P / (rho g H^2).

The sand between the wall (x = 0, height 1, toe at the origin) and a logarithmic spiral r = r0 exp(tan(phi) s)
from the toe to the surface turns as a block about the spiral's centre. What acts on the spiral goes through the
centre, so the moments of the weight and of the wall's force, at a third of the height and turned by delta, are
equal. The least over all centres is the bound (Terzaghi 1943; Chen 1975, Limit analysis and soil plasticity).
"""
import math


def thrust(phi, delta, cx, cy, n=600):
    """2 P / (rho g) with the spiral's centre at (cx, cy); infinite if it is no mechanism."""
    r0, a0, t = math.hypot(cx, cy), math.atan2(-cy, -cx), math.tan(phi)
    x, y = [0.0], [0.0]
    for k in range(1, n + 1):
        s = 3.5 * k / n
        r = r0 * math.exp(t * s)
        x.append(cx + r * math.cos(a0 + s))
        y.append(cy + r * math.sin(a0 + s))
        if x[-1] < 0:
            return math.inf
        if y[-1] >= 1:
            break
    else:
        return math.inf
    f = (1 - y[-2]) / (y[-1] - y[-2])
    x[-1], y[-1] = x[-2] + f * (x[-1] - x[-2]), 1.0
    x.append(0.0)
    y.append(1.0)
    area = first = 0.0
    for i in range(len(x)):
        j = (i + 1) % len(x)
        cross = x[i] * y[j] - x[j] * y[i]
        area += cross / 2
        first += (x[i] + x[j]) * cross / 6
    weight = first - area * cx
    arm = cx * math.sin(delta) - (1 / 3 - cy) * math.cos(delta)
    return 2 * weight / arm if arm > 1e-6 and weight > 0 else math.inf


def least(phi, delta):
    """By a search on ever finer lattices of centres."""
    best, width, steps = (math.inf, -5.0, 6.0), (5.0, 6.5), 20
    for _ in range(9):
        centre = best
        for i in range(-steps, steps + 1):
            for j in range(-steps, steps + 1):
                cx, cy = centre[1] + width[0] * i / steps, centre[2] + width[1] * j / steps
                best = min(best, (thrust(phi, delta, cx, cy), cx, cy))
        width, steps = (width[0] / 3, width[1] / 3), 6
    return best[0]


if __name__ == "__main__":
    for delta in (0, 15, 30):
        print(f"phi 30, delta {delta}: {least(math.radians(30), math.radians(delta)):.4f}")
