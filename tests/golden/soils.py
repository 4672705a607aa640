#!/usr/bin/env python3
"""Golden stresses of the laws for soils, by plain integration of their rate equations (Runge-Kutta of fourth order in
small steps, continuum tangents, no return mapping): python3 soils.py > soils.json.

Principal Kirchhoff stresses s (tension positive) follow principal logarithmic strains along straight paths with fixed
axes, where the laws of large strains are those of small ones. Stresses stay apart, so that Mohr-Coulomb is on one plane."""
import json
import numpy as np

RAD = np.pi / 180
STEPS = 20000  # a segment


def hooke(bulk, shear):
    return (bulk - 2 / 3 * shear) * np.ones((3, 3)) + 2 * shear * np.eye(3)


class DruckerPrager:
    def __init__(self, g):
        young, nu = g["young"], g["poisson"]
        self.D = hooke(young / 3 / (1 - 2 * nu), young / 2 / (1 + nu))
        s, d, c = np.sin(g["friction_angle"] * RAD), np.sin(g["dilatancy_angle"] * RAD), np.cos(g["friction_angle"] * RAD)
        if g["match"] == 2:  # eta and etabar by Davis' relation of the plane strain limit, see theory.md
            self.etabar = d / np.sqrt(1 + d * d / 3)
            both = np.sqrt(1 - self.etabar**2 / 3) + s * self.etabar / 3
            self.eta, self.xi = s / both, c / both
        else:
            side = 2 * g["match"] - 1
            self.eta, self.etabar = (6 * x / np.sqrt(3) / (3 + side * x) for x in (s, d))
            self.xi = 6 * c / np.sqrt(3) / (3 + side * s)
        self.limit = self.xi * g["cohesion"]

    def start(self):
        return np.zeros(4)

    def f(self, y):
        dev = y[:3] - y[:3].mean()
        return np.sqrt(dev @ dev / 2) + self.eta * y[:3].mean() - self.limit

    def rate(self, y, de, plastic):
        ds = self.D @ de
        if not plastic:
            return np.append(ds, 0)
        dev = y[:3] - y[:3].mean()
        shear = dev / 2 / np.sqrt(dev @ dev / 2)
        n, m = shear + self.eta / 3, shear + self.etabar / 3
        gamma = max(0, n @ ds / (n @ self.D @ m))
        return np.append(ds - gamma * self.D @ m, gamma / np.sqrt(3))


class Softening:
    def __init__(self, g):
        young, nu = g["young"], g["poisson"]
        self.D = hooke(young / 3 / (1 - 2 * nu), young / 2 / (1 + nu))
        self.at = [0, g["peak_strain"], g["residual_strain"]]
        self.table = [[g[w + n] for w in ("initial_", "", "residual_")] for n in ("friction_angle", "dilatancy_angle", "cohesion")]

    def start(self):
        return np.zeros(4)

    def strength(self, kappa):
        phi, psi, c = (np.interp(kappa, self.at, row) for row in self.table)
        k, m = ((1 + np.sin(x * RAD)) / (1 - np.sin(x * RAD)) for x in (phi, psi))
        return np.array([k, m, 2 * c * np.sqrt(k)])

    def f(self, y):
        k, m, q = self.strength(y[3])
        return k * y[:3].max() - y[:3].min() - q

    def rate(self, y, de, plastic):
        ds = self.D @ de
        if not plastic:
            return np.append(ds, 0)
        k, m, q = self.strength(y[3])
        h = 1e-7
        dk, dm, dq = (self.strength(y[3] + h) - self.strength(y[3])) / h
        first, last = np.argmax(y[:3]), np.argmin(y[:3])
        a, b = np.zeros(3), np.zeros(3)
        a[first], a[last], b[first], b[last] = k, -1, m, -1
        grows = np.sqrt(2 / 3 * ((b - b.mean()) @ (b - b.mean())))
        gamma = max(0, a @ ds / (a @ self.D @ b - (dk * y[first] - dq) * grows))
        return np.append(ds - gamma * self.D @ b, gamma * grows)


class CamClay:
    def __init__(self, g):
        self.g = g
        to = lambda slope: slope / g["specific_volume"] / (1 - slope / g["specific_volume"])
        self.lam, self.kap, self.M2 = to(g["lambda"]), to(g["kappa"]), g["critical_stress_ratio"] ** 2

    def start(self):
        p = self.g["pressure"]
        return np.array([-p, -p, -p, self.g["ocr"] * p])

    def f(self, y):
        p = -y[:3].mean()
        dev = y[:3] + p
        return (1.5 * dev @ dev / self.M2 + p * (p - y[3])) / y[3]

    def rate(self, y, de, plastic):
        p = -y[:3].mean()
        D = hooke(p / self.kap, self.g["shear_modulus"])
        ds = D @ de
        if not plastic:
            return np.append(ds, 0)
        n = 3 * (y[:3] + p) / self.M2 - (2 * p - y[3]) / 3
        hardening = y[3] / (self.lam - self.kap) * (2 * p - y[3])
        gamma = max(0, n @ ds / (n @ D @ n + p * hardening))
        return np.append(ds - gamma * D @ n, gamma * hardening)


class MuI:
    """Flows at a rate that follows from its stress: R / P = mu(I) solved for I. Each path takes `seconds`."""
    def __init__(self, g):
        self.g = g
        young, nu = g["young"], g["poisson"]
        self.bulk = young / 3 / (1 - 2 * nu)
        self.D, self.dt = hooke(self.bulk, young / 2 / (1 + nu)), g["seconds"] / STEPS

    def start(self):
        tau = -self.g["pressure"]
        for _ in range(50):  # tau = J sigma, K ln J = tau
            tau = -self.g["pressure"] * np.exp(tau / self.bulk)
        return np.array([tau, tau, tau, 0])

    def rate(self, y, de, plastic):
        g, P = self.g, -y[:3].mean()
        dev = y[:3] + P
        R = np.sqrt(dev @ dev / 2)
        excess = R / P - g["static_friction"]
        if excess <= 0:
            return np.append(self.D @ de, 0)
        number = g["inertial_number"] * excess / (g["limit_friction"] - R / P)
        gamma = number * np.sqrt(P / g["grain_density"]) / g["grain_size"] * self.dt
        return np.append(self.D @ (de - gamma * dev / 2 / R), gamma / np.sqrt(3))

    def step(self, y, de):
        return runge_kutta(self, y, de, True)


def runge_kutta(law, y, de, plastic):
    a = law.rate(y, de, plastic)
    b = law.rate(y + a / 2, de, plastic)
    c = law.rate(y + b / 2, de, plastic)
    return y + (a + 2 * b + 2 * c + law.rate(y + c, de, plastic)) / 6


def step(law, y, de):
    """Elastic up to the yield surface, which is found by bisection, and plastic from there on."""
    if hasattr(law, "step"):
        return law.step(y, de)
    if law.f(y) < -1e-9 * np.abs(y[:3]).max():
        to = runge_kutta(law, y, de, False)
        if law.f(to) <= 0:
            return to
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if law.f(runge_kutta(law, y, middle * de, False)) < 0 else (low, middle)
        return runge_kutta(law, runge_kutta(law, y, low * de, False), (1 - low) * de, True)
    if law.f(runge_kutta(law, y, de, False)) < law.f(y):
        return runge_kutta(law, y, de, False)
    return runge_kutta(law, y, de, True)


SOIL = {"young": 2e7, "poisson": 0.3, "friction_angle": 30, "dilatancy_angle": 8, "cohesion": 1e4}
PRESS, SHEAR, BACK = [-1.1e-3, -1.3e-3, -1.6e-3], [4e-3, 1e-3, -8e-3], [-5e-4, 1e-4, 9e-4]
DENSE = dict(SOIL, initial_friction_angle=22, initial_dilatancy_angle=0, initial_cohesion=4e3, residual_friction_angle=24,
             residual_dilatancy_angle=0, residual_cohesion=1e3, peak_strain=3e-3, residual_strain=2e-2)
CLAY = {"critical_stress_ratio": 1.1, "lambda": 0.2, "kappa": 0.04, "specific_volume": 2.1, "shear_modulus": 4e6, "ocr": 1.0,
        "pressure": 1e5}
GRAINS = {"young": 2e7, "poisson": 0.3, "static_friction": 0.38, "limit_friction": 0.64, "inertial_number": 0.3,
          "grain_size": 0.01, "grain_density": 2500, "pressure": 1e5, "seconds": 2e-4}
CASES = [("drucker-prager", DruckerPrager, dict(SOIL, match=k), [PRESS, SHEAR, BACK, SHEAR]) for k in range(3)] + [
    ("mohr-coulomb-softening", Softening, DENSE, [PRESS, SHEAR, BACK, [1e-2, 1e-3, -1.5e-2]]),
    ("mohr-coulomb-softening", Softening, dict(DENSE, peak_strain=5e-2, residual_strain=0.1), [PRESS, SHEAR, [0.03, 0, -0.05]]),
    ("modified-cam-clay", CamClay, CLAY, [[-0.02, -0.02, -0.02], [0.01, 0.005, -0.04], [0.002, 0.001, 0.01], [0.03, 0.03, -0.06]]),
    ("modified-cam-clay", CamClay, dict(CLAY, ocr=6.0), [[0.02, 0.01, -0.03], [0.03, 0.01, -0.06]]),
    ("mu-i", MuI, GRAINS, [PRESS, SHEAR, BACK, [4e-3, 4e-3, -1e-2]])]

if __name__ == "__main__":
    out = []
    for name, kind, given, path in CASES:
        law, ends = kind(given), []
        y = law.start()
        for segment in path:
            for _ in range(STEPS):
                y = step(law, y, np.array(segment) / STEPS)
            ends.append(list(y))
        out.append({"law": name, "given": given, "path": path, "ends": ends})
    print(json.dumps({"description": "principal Kirchhoff stresses and the law's own number (plastic shear strain; Cam Clay: p_c) "
                      "at the ends of straight paths of logarithmic strain, by soils.py", "cases": out}, indent=1))
