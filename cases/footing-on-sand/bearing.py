#!/usr/bin/env python3
"""Bearing capacity of a strip footing by the method of characteristics (Sokolovskii), without talus.

Ground x > 0 is free under a surcharge q, the footing stands on x < 0, its edge is the origin, y points up, pressure is positive.
With s = p + c cot(phi), psi the direction of the larger principal pressure and e = pi/4 - phi/2, equilibrium where all yields has
characteristics in the directions psi + e (first family) and psi - e (second), along which over a length dl

     cos(phi) ds + 2 s sin(phi) dpsi = -gamma cos(psi - e) dl,     -cos(phi) ds + 2 s sin(phi) dpsi = -gamma cos(psi + e) dl.

From the free surface (psi = 0) a fan at the edge turns psi. Lines of the first family are found one after another outward: each
point is where a line of the second family from the line before meets the new one (trapezoidal rule, iterated).

smooth   Lines end at the footing, where psi = -pi/2; each half of the footing stands by itself.
rough    Near the edge friction is all mobilised: lines end at the footing where the second family touches it, psi = e - pi. From the
         place where that ends, the last line of the second family bounds what moves with the footing. It meets the axis with psi = -pi/2,
         which says where the axis is: the width follows from the place. Its force is that on this line less the weight above.

    python3 bearing.py [PHI]       degrees; N_q, and N_gamma = 2 p / (gamma B) over c / (gamma B)
"""
import math
import sys

CLOSE = 1e-13


class Ground:
    def __init__(self, phi, c, q, gamma):
        self.sin, self.cos, self.tan, self.gamma = math.sin(phi), math.cos(phi), math.tan(phi), gamma
        self.e, self.shift = math.pi / 4 - phi / 2, c / math.tan(phi)
        self.free = (q + self.shift) / (1 - self.sin)

    def first(self, a, b):
        """f and m of cos ds + m dpsi = f on the first family's line from b to a, and its direction."""
        d = (a[3] + b[3]) / 2 + self.e
        dl = (a[0] - b[0]) * math.cos(d) + (a[1] - b[1]) * math.sin(d)
        return -self.gamma * math.cos(d - 2 * self.e) * dl, (a[2] + b[2]) * self.sin, d

    def second(self, a, b):
        d = (a[3] + b[3]) / 2 - self.e
        dl = (a[0] - b[0]) * math.cos(d) + (a[1] - b[1]) * math.sin(d)
        return -self.gamma * math.cos(d + 2 * self.e) * dl, (a[2] + b[2]) * self.sin, d

    def meet(self, a, b):
        """Where the second family's line from a meets the first's from b: x, y, s, psi."""
        p = b
        for _ in range(60):
            (_, _, d1), (_, _, d2) = self.first(p, b), self.second(p, a)
            t = ((a[0] - b[0]) * math.sin(d2) - (a[1] - b[1]) * math.cos(d2)) / math.sin(d2 - d1)
            p = (b[0] + t * math.cos(d1), b[1] + t * math.sin(d1), p[2], p[3])
            (f1, m1, _), (f2, m2, _) = self.first(p, b), self.second(p, a)
            psi = (f1 + f2 + self.cos * (b[2] - a[2]) + m1 * b[3] + m2 * a[3]) / (m1 + m2)
            s, old = b[2] + (f1 - m1 * (psi - b[3])) / self.cos, p
            p = (p[0], p[1], s, psi)
            if abs(s - old[2]) < CLOSE * s and abs(psi - old[3]) < CLOSE:
                break
        return p

    def land(self, b, psi):
        """Where the first family's line from b comes to the footing."""
        d = (psi + b[3]) / 2 + self.e
        p = (b[0] - b[1] / math.tan(d), 0.0, b[2], psi)
        for _ in range(60):
            (f, m, _), old = self.first(p, b), p
            p = (p[0], 0.0, b[2] + (f - m * (psi - b[3])) / self.cos, psi)
            if abs(p[2] - old[2]) < CLOSE * p[2]:
                break
        return p

    def lines(self, end, n, growth, landing):
        """Last points of the first family's lines, from the edge outward; the first `landing` of them end at the footing."""
        line = [(0.0, 0.0, self.free * math.exp(-2 * self.tan * end * k / n), end * k / n) for k in range(n + 1)]
        x, count = 0.0, 0
        while True:
            yield line[-1]
            x, count = x + max(growth * x, 0.02 * self.free / self.gamma), count + 1
            new = [(x, 0.0, self.free, 0.0)]
            for a in line:
                new.append(self.meet(a, new[-1]))
            if count <= landing:
                new.append(self.land(new[-1], end))
            line = new

    def pressure(self, p):
        """sigma_yy and sigma_xy."""
        r = p[2] * self.sin
        return p[2] - self.shift - r * math.cos(2 * p[3]), r * math.sin(2 * p[3])


def part(a, b, share):
    return tuple(x + share * (y - x) for x, y in zip(a, b))


def smooth(phi, c, q, gamma, n=40, growth=0.05):
    """Mean pressure below a smooth footing of width 1."""
    ground, before, load = Ground(phi, c, q, gamma), None, 0.0
    for p in ground.lines(-math.pi / 2, n, growth, math.inf):
        if before:
            share = min(1.0, (0.5 + before[0]) / (before[0] - p[0]))
            now = part(before, p, share)
            load += (ground.pressure(now)[0] + ground.pressure(before)[0]) / 2 * (before[0] - now[0])
            if share < 1:
                return 2 * load
        before = p


def rough_try(phi, landing, n, growth):
    """c / (gamma B) and N_gamma of a rough footing on which so many lines end."""
    c = 1e-6
    ground, before, load = Ground(phi, c, 0, 1), None, 0.0
    for p in ground.lines(math.pi / 4 - phi / 2 - math.pi, n, growth, landing):
        if before:
            over = p[3] > -math.pi / 2
            now = part(before, p, (-math.pi / 2 - before[3]) / (p[3] - before[3])) if over else p
            (yy, xy), (yy0, xy0) = ground.pressure(now), ground.pressure(before)
            dx, dy = now[0] - before[0], now[1] - before[1]
            load += (xy + xy0) / 2 * dy - (yy + yy0 + now[1] + before[1]) / 2 * dx
            if over:
                return c / (-2 * now[0]), 2 * load / (2 * now[0] ** 2)
        before = p


def rough(phi, c, n=40, growth=0.05):
    """N_gamma of a rough footing for c / (gamma B): more and more lines end on it until the cohesion is as small."""
    landing, before = 1, (math.inf, 0.0)
    while True:
        now = rough_try(phi, landing, n, growth)
        if now[0] <= c:
            share = math.log(c / before[0]) / math.log(now[0] / before[0])
            return before[1] + share * (now[1] - before[1])
        landing, before = landing + max(1, int(math.log(now[0] / c) / growth * 0.5)), now


if __name__ == "__main__":
    phi = math.radians(float(sys.argv[1]) if len(sys.argv) > 1 else 30)
    exact = math.exp(math.pi * math.tan(phi)) * math.tan(math.pi / 4 + phi / 2) ** 2
    print(f"N_q {smooth(phi, 0, 1, 1e-9):.4f}, closed form {exact:.4f}")
    print("c / (gamma B)   smooth   rough")
    for c in (1e-5, 1e-4, 1e-3, 1e-2):
        print(f"{c:13g} {2 * smooth(phi, c, 0, 1):8.3f} {rough(phi, c):7.3f}")
