"""A load that no case file can say: the ground under a layer of soil begins to shake.

In the frame of the ground the soil feels a force per mass -a(t), everywhere the same: a body force. The layer is a
shear beam, whose motion from rest is known as a series of its modes; the top follows it.
"""

import numpy as np

import talus

HEIGHT, DENSITY, SHEAR = 10.0, 2000.0, 20e6  # m, kg/m3, Pa
AMPLITUDE, OMEGA = 0.5, 9.0  # of the ground's acceleration, m/s2 and 1/s; the first mode has 15.7 1/s

layer = talus.Case({
    "title": "A layer of soil on ground that shakes",
    "kinematics": "plane-strain",
    "method": "fem",
    "analysis": {"type": "dynamic", "end": 1.0, "step": 0.005},
    "grid": {"box": {"min": [0, 0], "max": [1, HEIGHT]}, "counts": [1, 20], "cell": "quadrilateral"},
    "bodies": [{"name": "soil", "shape": {"box": {"min": [0, 0], "max": [1, HEIGHT]}}, "points_per_cell": 4,
                "material": "soil"}],
    "materials": {"soil": {"law": "neo-hookean", "density": DENSITY, "shear": SHEAR, "poisson": 0.3}},
    "boundary": [{"on": {"boundary": "bottom"}, "fix": ["x", "y"]},
                 {"on": {"boundary": "left"}, "fix": ["y"]}, {"on": {"boundary": "right"}, "fix": ["y"]}],
    "measures": {"top": {"displacement": "x", "of": {"tracer": [0.5, HEIGHT]}}},
    "output": {"fields": ["displacement"], "every": 0.1},
})


def shaking(X, x, t):
    """m/s2, for all points at once: X and x have shape (n, 3), the result whatever can be put into that."""
    return [-AMPLITUDE * np.sin(OMEGA * t), 0, 0]


def exact(t, modes=50):
    """Displacement of the top, m: each mode answers to the force by itself, from rest."""
    k = (2 * np.arange(modes)[:, None] + 1) * np.pi / 2
    omega = k * np.sqrt(SHEAR / DENSITY) / HEIGHT
    answer = (np.sin(OMEGA * t) - OMEGA / omega * np.sin(omega * t)) / (omega**2 - OMEGA**2)
    return -AMPLITUDE * (2 / k * np.sin(k) * answer).sum(axis=0)


layer.body_force = shaking
run = layer.run("runs/shaken-layer", force=True)
time, top = run.history.time, run.history["top"]
error = abs(top - exact(time)).max() / abs(exact(time)).max()
print(f"largest displacement of the top: {abs(top).max() * 1e3:.2f} mm, exact {abs(exact(time)).max() * 1e3:.2f} mm")
print(f"largest error: {100 * error:.2f} % of that")
