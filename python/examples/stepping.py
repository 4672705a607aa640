"""Step a model and change its points: a block settles under its own weight, in a dynamic run that is stopped whenever
it moves fastest ("kinetic damping"). What is left is the equilibrium, whose settlement is known.
"""

import numpy as np

import talus

HEIGHT, DENSITY, YOUNG, POISSON, GRAVITY = 2.0, 1500.0, 4e6, 0.3, 9.81

block = talus.Case({
    "title": "A block comes to rest",
    "kinematics": "plane-strain",
    "method": "mpm",
    "analysis": {"type": "dynamic", "end": 10, "step": 2e-3, "transfer": "thesis"},
    "grid": {"box": {"min": [0, 0], "max": [1, 2.5]}, "size": 0.25, "cell": "quadrilateral"},
    "bodies": [{"name": "block", "shape": {"box": {"min": [0, 0], "max": [1, HEIGHT]}}, "points_per_cell": 4,
                "material": "soft"}],
    "materials": {"soft": {"law": "neo-hookean", "density": DENSITY, "young": YOUNG, "poisson": POISSON}},
    "boundary": [{"on": {"boundary": "bottom"}, "fix": ["y"]},
                 {"on": {"boundary": "left"}, "fix": ["x"]}, {"on": {"boundary": "right"}, "fix": ["x"]}],
    "loads": {"gravity": [0, -GRAVITY]},
    "measures": {"top": {"displacement": "y", "of": {"tracer": [0.5, HEIGHT]}}},
})

with block.model() as model:
    mass = model.points["mass"].copy()
    energy, stops = 0.0, 0
    while stops < 12 and model.step():
        velocity = model.points["velocity"]  # the model's own array, until its next step
        before, energy = energy, 0.5 * (model.points["mass"][:, None] * velocity**2).sum()
        if energy < before:  # it was fastest a moment ago
            stops += 1
            energy = 0.0
            with model.points.edit("velocity") as v:
                v[:] = 0
            with model.points.edit("acceleration") as a:
                a[:] = 0
    settled, time = -model.measures["top"], model.time

modulus = YOUNG * (1 - POISSON) / (1 + POISSON) / (1 - 2 * POISSON)
exact = DENSITY * GRAVITY * HEIGHT**2 / 2 / modulus
print(f"stopped {stops} times, at rest after {time:.3f} s")
print(f"settlement {settled * 1e3:.3f} mm, of small strains {exact * 1e3:.3f} mm")
print(f"error: {100 * abs(settled / exact - 1):.2f} %")
