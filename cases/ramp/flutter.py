#!/usr/bin/env python3
"""How fast a block that slides down an elastic ramp begins to squeal, without talus: finite elements of both bodies (squares of 0.25 m or less,
linear elasticity), nodes that touch and slide with Coulomb's friction, and the eigenvalues s of

    W^T (s^2 M + K) Z q = 0,    Z: motions that neither open nor close the joint,    W: those on which n - mu t does no work.

Friction is not symmetric, and some s have a real part: oscillations that grow by exp(s t), without any damping to stop them.
Given runs of this case with mu = 0.5 and the ramp along x, also how fast the joint's normal force swings ever wider there.

    python3 flutter.py [RUN ...]"""
import csv
import sys
import numpy as np

WEIGHT, RAISED = 500 * 9.81 * np.cos(np.pi / 6), 0.4
CORNER = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])


def square(h, young, nu, rho):
    """Stiffness and mass of a square of side h, plane strain, 2 x 2 Gauss points."""
    lam, G = young * nu / ((1 + nu) * (1 - 2 * nu)), young / 2 / (1 + nu)
    C = np.array([[lam + 2 * G, lam, 0], [lam, lam + 2 * G, 0], [0, 0, G]])
    K, M = np.zeros((8, 8)), np.zeros((8, 8))
    for a in (-1 / np.sqrt(3), 1 / np.sqrt(3)):
        for b in (-1 / np.sqrt(3), 1 / np.sqrt(3)):
            x, y = CORNER[:, 0], CORNER[:, 1]
            N, B = np.zeros((2, 8)), np.zeros((3, 8))
            N[0, 0::2] = N[1, 1::2] = (1 + x * a) * (1 + y * b) / 4
            B[0, 0::2] = B[2, 1::2] = x * (1 + y * b) / (2 * h)
            B[1, 1::2] = B[2, 0::2] = y * (1 + x * a) / (2 * h)
            K += h * h / 4 * B.T @ C @ B
            M += h * h / 4 * rho * N.T @ N
    return K, M


def body(nx, ny, h, young):
    K = np.zeros((2 * (nx + 1) * (ny + 1),) * 2)
    M = np.zeros_like(K)
    k, m = square(h, young, 0.3, 1000)
    for i in range(nx):
        for j in range(ny):
            node = j * (nx + 1) + i
            dofs = [2 * n + d for n in (node, node + 1, node + nx + 2, node + nx + 1) for d in (0, 1)]
            K[np.ix_(dofs, dofs)] += k
            M[np.ix_(dofs, dofs)] += m
    return K, M


def beside(A):
    """A basis of what A takes to zero."""
    return np.linalg.svd(A)[2][len(A):].T


def modes(mu, n):
    """Growing s with cells of 0.25 m / n, fastest first."""
    ramp, block = body(16 * n, 2 * n, 0.25 / n, 3e7), body(4 * n, 2 * n, 0.25 / n, 1e8)
    held = 2 * (16 * n + 1)  # the base
    size = len(ramp[0]) - held
    K, M = (np.block([[r[held:, held:], np.zeros((size, len(b)))], [np.zeros((len(b), size)), b]]) for r, b in zip(ramp, block))
    normal, along = np.zeros((4 * n + 1, len(K))), np.zeros((4 * n + 1, len(K)))
    for i in range(4 * n + 1):
        top = 2 * (2 * n * (16 * n + 1) + n + i) - held
        normal[i, [size + 2 * i + 1, top + 1]] = along[i, [size + 2 * i, top]] = 1, -1
    Z, W = beside(normal), beside(normal - mu * along)
    s = np.sqrt(-np.linalg.eigvals(np.linalg.solve(W.T @ M @ Z, W.T @ K @ Z)).astype(complex))
    s = np.where(s.real < 0, -s, s)
    s = s[(s.imag > 1) & (s.real > 1)]
    return s[np.argsort(-s.real)]


def swings(run, omega):
    """Growth of what the joint's normal force has of omega, 1/s, from windows of four periods that begin at 0.03 to 0.065 s."""
    with open(run + "/history.csv") as file:
        rows = list(csv.DictReader(file))[1:]
    t, up = (np.array([float(r[k]) for r in rows]) for k in ("time [s]", "up [N]"))
    rest = up - WEIGHT * np.minimum(t / RAISED, 1)
    begins, sizes = np.arange(0.03, 0.07, 0.005), []
    for begin in begins:
        here = (t >= begin) & (t < begin + 8 * np.pi / omega)
        window = np.hanning(here.sum())
        sizes.append(abs((window * rest[here] * np.exp(-1j * omega * t[here])).sum() / window.sum()))
    return np.polyfit(begins, np.log(sizes), 1)[0]


if __name__ == "__main__":
    for mu in (0, 0.2, 0.5):
        for n in (1, 2):
            told = ", ".join(f"{s.real:.0f} ({s.imag:.0f})" for s in modes(mu, n) if s.imag < 1500)
            print(f"mu = {mu}, cells of {0.25 / n} m: growth in 1/s (of rad/s): {told or 'none'}")
    for run in sys.argv[1:]:
        grow = modes(0.5, 1)
        told = ", ".join(f"{swings(run, s.imag):.0f} ({s.imag:.0f})" for s in (grow[0], min(grow, key=lambda s: s.imag)))
        print(f"{run}: {told}")
