#!/usr/bin/env python3
"""kratos_cantilever.py [RESULTS.json]: why Kratos's dynamic cantilever differs from talus (docs/import.md).

Linear mpm of ten square cells of 1 m, four points each: steel under its weight, plane stress, Newmark with 1/4 and 1/2, steps of
0.1 s; three things as in talus or as in Kratos. Prints the deflection of the point at the tip over that of RESULTS.json, which is
dynamic_cantilever_consistent_mass_test_results.json of Kratos's repository, or of all as in Kratos, minus 1, in percent."""
import itertools
import json
import sys

import numpy as np

YOUNG, POISSON, DENSITY, GRAVITY, STEP, CELLS = 210e9, 0.3, 7850.0, 9.81, 0.1, 10
STEPS = (2, 3, 5, 7, 9, 11)
C = YOUNG / (1 - POISSON**2) * np.array([[1, POISSON, 0], [POISSON, 1, 0], [0, 0, (1 - POISSON) / 2]])
TIP = 4 * CELLS - 3  # the point that Kratos calls 114


def shapes(x, cell):
    """Nodes of the cell, their functions at x and strains from their displacements."""
    a, b = x[0] - cell, x[1]
    slopes = np.array([[b - 1, a - 1], [-b, 1 - a], [1 - b, -a], [b, a]])
    strain = np.zeros((3, 8))
    strain[0, 0::2], strain[1, 1::2] = slopes.T
    strain[2, 0::2], strain[2, 1::2] = slopes[:, 1], slopes[:, 0]
    return 2 * cell + np.arange(4), np.array([(1 - a) * (1 - b), (1 - a) * b, a * (1 - b), a * b]), strain


def assemble(points, stress, mass):
    """Mass, stiffness and forces at the nodes, and what points see of nodes."""
    n = 2 * (CELLS + 1)
    M, K, f, N = np.zeros((n, n)), np.zeros((2 * n, 2 * n)), np.zeros(2 * n), np.zeros((len(points), n))
    B = np.zeros((len(points), 3, 2 * n))
    for p, x in enumerate(points):
        nodes, values, strain = shapes(x, p // 4)
        N[p, nodes] = values
        B[p][:, np.stack([2 * nodes, 2 * nodes + 1], 1).ravel()] = strain
        M += mass * np.outer(N[p], N[p])
        K += 0.25 * B[p].T @ C @ B[p]
        f -= 0.25 * B[p].T @ stress[p]
        f[1::2] -= mass * GRAVITY * N[p]
    return M, K, f, N, B


def deflections(velocity, held, start, lumped=False):
    """Each of the three as "talus" or "kratos": points' velocities, prescribed nodes, the first acceleration."""
    corner = np.array([[1, -1], [1, 1], [-1, 1], [-1, -1]]) / np.sqrt(3)  # in Kratos's order
    x = np.concatenate([[cell + 0.5, 0.5] + 0.5 * corner for cell in range(CELLS)])
    u, v, a, stress, mass = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x), np.zeros((len(x), 3)), 0.25 * DENSITY
    found = []
    for step in range(max(STEPS)):
        M, K, f, N, B = assemble(x, stress, mass)
        whole = M.sum(1)[:, None]
        if step == 0:
            first = np.tile([0, -GRAVITY], (len(M), 1))
            first[:2] *= start == "kratos"
            a = N @ first
        gathered = mass * N.T @ v / whole
        before, slowing = gathered.copy(), (first if step == 0 and start == "talus" else mass * N.T @ a / whole)
        if held == "talus":
            before[:2] = slowing[:2] = 0
        inertia = np.kron(np.diag(whole[:, 0]) if lumped else M, np.eye(2))
        right = f + inertia @ (4 / STEP * before + slowing).ravel()
        du = np.zeros(2 * len(M))
        du[4:] = np.linalg.solve((K + 4 / STEP**2 * inertia)[4:, 4:], right[4:])  # the first two nodes are held
        moved = du.reshape(-1, 2)
        end = 4 / STEP**2 * moved - 4 / STEP * before - slowing
        change = before + STEP / 2 * (slowing + end) - gathered
        v = v + (N @ change if velocity == "talus" else STEP / 2 * (a + N @ end))
        a, u, x, stress = N @ end, u + N @ moved, x + N @ moved, stress + (B @ du) @ C
        found.append(u[TIP, 1])
    return np.array([found[k - 1] for k in STEPS])


def main():
    reference = deflections("kratos", "kratos", "kratos")
    if len(sys.argv) > 1:
        with open(sys.argv[1], encoding="utf-8") as file:
            reference = np.array(json.load(file)["PARTICLE_114"]["MP_DISPLACEMENT_Y"])
    print("velocities, held nodes, start; steps", *STEPS)
    for three in itertools.product(("kratos", "talus"), repeat=3):
        print("%-7s %-7s %-7s" % three, *("%8.2f" % x for x in (deflections(*three) / reference - 1) * 100))
    lumped = deflections("kratos", "kratos", "kratos", lumped=True)
    print("%-23s" % "kratos, lumped mass", *("%8.2f" % x for x in (lumped / reference - 1) * 100))


if __name__ == "__main__":
    main()
