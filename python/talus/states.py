"""States of a run, read from its VTKHDF files when somebody asks."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from .errors import TalusError


def _h5py():
    try:
        import h5py
    except ImportError as error:
        raise TalusError("states are read with h5py (Debian: python3-h5py)") from error
    return h5py


def _text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


class Piece(Mapping):
    """Fields of the points, nodes, walls or places of contact of one state: `piece["stress"]`.

    Arrays have a row for each point: (n,) for numbers, (n, 3) for vectors (in the plane, too), (n, 6) for
    stress (xx yy zz xy yz zx), (n, 9) for the deformation gradient, row by row. `units[name]` tells the
    unit, `position` [m] is always there. They are read from the file at every access: keep what you need
    more than once.

    >>> points = talus.open(run).states[-1].points
    >>> list(points), points.units["displacement"], points["displacement"].shape
    (['position', 'displacement', 'id'], 'm', (64, 3))
    """

    def __init__(self, file):
        self.file = Path(file)
        with _h5py().File(self.file, "r") as f:
            root = f["VTKHDF"]
            self._places = {"position": "Points"}
            for group in ("PointData", "CellData"):
                self._places.update({name: f"{group}/{name}" for name in root[group]})
            self.units = {name: _text(root[at].attrs.get("unit", "")) for name, at in self._places.items()}
            self.n = int(root["Points"].shape[0])

    def _read(self, name):
        with _h5py().File(self.file, "r") as f:
            return f["VTKHDF"][name][...]

    def __getitem__(self, name):
        if name not in self._places:
            raise KeyError(f"{self.file.name} has no field '{name}'; there are: {', '.join(self)} "
                           "(output: {fields: [...]} in the case says what is written)")
        return self._read(self._places[name])

    def __iter__(self):
        return iter(self._places)

    def __len__(self):
        return len(self._places)

    def by_id(self, name):
        """A field in the order of the points' numbers, which is the same in all states.

        >>> state = talus.open(run).states[0]
        >>> bool((np.diff(state.points.by_id("id")) > 0).all())
        True
        """
        return self[name][np.argsort(self["id"], kind="stable")]

    @property
    def cells(self):
        """Cells of a grid or pieces of a wall: an array of nodes, (cells, nodes a cell), from 0.

        Where cells have different numbers of nodes it is a list of arrays. Nodes on the border of two ranks
        are there once for each.
        """
        nodes, offsets = self._read("Connectivity"), self._read("Offsets")
        points, cells = self._read("NumberOfPoints"), self._read("NumberOfCells")
        ids = self._read("NumberOfConnectivityIds")
        out, first, node, offset = [], 0, 0, 0
        for n_points, n_cells, n_ids in zip(points, cells, ids):  # a piece for each rank
            ends = offsets[offset:offset + n_cells + 1]
            out += np.split(nodes[node:node + n_ids] + first, ends[1:-1]) if n_cells else []
            first, node, offset = first + n_points, node + n_ids, offset + n_cells + 1
        sizes = {len(cell) for cell in out}
        return np.array(out, dtype=np.int64) if len(sizes) == 1 else out

    def __repr__(self):
        return f"<talus.Piece {self.file.name}: {self.n} points with {', '.join(self)}>"


class State:
    """One state of a run: `time` [s], and its pieces, which are read when they are asked for."""

    def __init__(self, folder, file, time):
        self.folder, self.file, self.time = Path(folder), file, time

    def _piece(self, name):
        file = self.folder / self.file.replace("points", name, 1)
        if not file.is_file():
            raise TalusError(f"{self.folder}: this state has no {name} ({file.name} is not there)")
        return Piece(file)

    @property
    def points(self):
        """Material points, a :class:`Piece`; "id" numbers them for the whole run."""
        return self._piece("points")

    @property
    def grid(self):
        """Nodes with their fields, and `cells`. Not of runs with `output: {grid: false}`."""
        return self._piece("grid")

    @property
    def walls(self):
        """Walls as lines (2D) or triangles: `position`, `cells`, and "wall", the number of each piece's wall."""
        return self._piece("walls")

    @property
    def contact(self):
        """Places that touch walls: "pressure" and "shear" [Pa], "normal", "section" [m2], "wall"."""
        return self._piece("contact")

    def __repr__(self):
        return f"<talus.State at {self.time:g} s, {self.file}>"


class States(Sequence):
    """The states that a run has written so far, in the order of time.

    >>> states = talus.open(run).states
    >>> len(states), states[-1].time
    (1, 0.01)
    """

    def __init__(self, folder):
        series = Path(folder) / "points.hdf.series"
        files = json.loads(series.read_text())["files"] if series.is_file() else []
        self._states = [State(folder, entry["name"], entry["time"]) for entry in files]

    @property
    def times(self):
        """Times of the states, s, shape (states,)."""
        return np.array([state.time for state in self._states])

    def at(self, time):
        """The state nearest to a time, s.

        >>> talus.open(run).states.at(0.004)
        <talus.State at 0.01 s, points_000000.hdf>
        """
        if not self._states:
            raise TalusError("the run has written no state yet")
        return self._states[int(np.argmin(abs(self.times - time)))]

    def __getitem__(self, index):
        return self._states[index]

    def __len__(self):
        return len(self._states)

    def __repr__(self):
        return f"<talus.States at {', '.join(f'{time:g}' for time in self.times)} s>"
