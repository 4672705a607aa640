"""talus in Python: read what runs have left, build and run cases, step models.

Reading needs NumPy, and h5py for states; neither the C library nor MPI. Everything else loads libtalus of the
same version: that of the prefix the package is installed in, of TALUS_LIBRARY, or of the build tree.

>>> history = talus.open(run).history
>>> print(f"{history['top'][-1]:.3e} {history.units['top']}")
-4.902e-04 m
"""

from ._library import fields
from ._version import version as __version__
from .case import Case
from .errors import CaseError, LibraryError, Mistake, RunError, TalusError, TalusWarning
from .model import Model, Points
from .program import calibrate, find_program, run, sweep
from .runs import Run, open
from .states import Piece, State, States
from .tables import Calibration, History, Sweep, Table

__all__ = ["Calibration", "Case", "CaseError", "History", "LibraryError", "Mistake", "Model", "Piece", "Points", "Run",
           "RunError", "State", "States", "Sweep", "Table", "TalusError", "TalusWarning", "calibrate", "fields",
           "find_program", "open", "run", "sweep"]
