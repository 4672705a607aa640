"""Which angle of friction has a material whose column ran out so far? SciPy asks, talus answers.

What was "measured" is the front of a run with 28 degrees over time, so that the answer is known. `talus calibrate`
looks for several parameters and says how well they are determined (docs/calibrate.md).
"""

import sys
import warnings
from pathlib import Path

import numpy as np

import talus

try:
    from scipy.optimize import minimize_scalar
except ImportError:
    print("SciPy is not here (Debian: python3-scipy)")
    sys.exit(77)

warnings.simplefilter("ignore", talus.TalusWarning)  # the column is coarse, and says so
column = Path(__file__).with_name("column.yaml")


def front(angle):
    """The front over time, m, with this angle of friction, degrees."""
    case = talus.Case(column)
    case["materials.grains.friction_angle"] = angle
    case["output.every"] = "end"
    history = case.run("runs/friction-fit", force=True).history
    return history["front"]


measured = front(28)


def miss(angle):
    """Root of the mean square of what the front is off, m."""
    off = np.sqrt(np.mean((front(angle) - measured) ** 2))
    print(f"  {angle:6.3f} degrees: the front is off by {off * 1e3:.3f} mm")
    return off**2


fit = minimize_scalar(miss, bounds=(20, 45), method="bounded", options={"xatol": 0.05})
print(f"angle of friction: {fit.x:.2f} degrees after {fit.nfev} runs (28 in truth)")
