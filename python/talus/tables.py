"""Tables that talus writes (.csv), and the sweeps and calibrations that consist of them."""

import csv
import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from .errors import TalusError

_HEAD = re.compile(r"(.*?)(?: \[([^\]]*)\])?$")


def _column(cells):
    try:
        return np.array([float(cell) if cell else np.nan for cell in cells])
    except ValueError:
        return np.array(cells)


class Table(Mapping):
    """Columns by name, in the order of the file; `units[name]` is "" where there is none.

    Numbers are arrays of floats, shape (rows,), with nan where a cell is empty; words are arrays of texts.
    A last row that is not whole yet (a run may be writing it) is left out.

    >>> table = talus.open(sweep).table
    >>> list(table)[:2], table.units["top"]
    (['materials.rubber.young', 'top'], 'm')
    >>> table["materials.rubber.young"]
    array([1000000., 2000000.])
    """

    def __init__(self, file):
        text = Path(file).read_text(encoding="utf-8", errors="replace")
        rows = list(csv.reader(text[:text.rfind("\n") + 1].splitlines()))
        if not rows:
            raise TalusError(f"{file}: this is no table yet: it has no first line")
        self.file, self.units, self._columns = Path(file), {}, {}
        for head, cells in zip(rows[0], zip(*rows[1:]) if rows[1:] else [()] * len(rows[0])):
            name, unit = _HEAD.match(head).groups()
            if name == "+-" and self._columns:
                name = f"{list(self._columns)[-1]} +-"
            self.units[name] = unit or ""
            self._columns[name] = _column(cells)

    def __getitem__(self, name):
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"{self.file.name} has no column '{name}'; there are: {', '.join(self)}") from None

    def __iter__(self):
        return iter(self._columns)

    def __len__(self):
        return len(self._columns)

    def __repr__(self):
        shown = (f"{name} [{unit}]" if unit else name for name, unit in self.units.items())
        rows = len(next(iter(self._columns.values()), ()))
        return f"<{type(self).__name__} of {rows} rows: {', '.join(shown)}>"


class History(Table):
    """What a run has measured, `history.csv`: "time" [s], "step", and the measures of the case.

    >>> history = talus.open(run).history
    >>> history["top"].shape, history.units["top"]
    ((6,), 'm')
    >>> float(history.time[-1])
    0.01
    """

    @property
    def time(self):
        """Times of the rows, s, shape (rows,)."""
        return self["time"]

    @property
    def last(self):
        """The last row: {name: number}."""
        return {name: float(values[-1]) for name, values in self.items() if len(values)}


class _Folder:
    def __init__(self, path):
        self.path = Path(path)

    def __repr__(self):
        return f"<talus.{type(self).__name__} {str(self.path)!r}>"


class Sweep(_Folder):
    """The directory of a `talus sweep`.

    >>> sweep_ = talus.open(sweep)
    >>> [run.history.units["top"] for run in sweep_.runs]
    ['m', 'm']
    """

    @property
    def table(self):
        """A :class:`Table` with a row for each member: its keys, measures, steps, how it ended, directory."""
        return Table(self.path / "sweep.csv")

    @property
    def runs(self):
        """The :class:`talus.Run` of each row of the table."""
        from .runs import Run
        return [Run(self.path / str(folder)) for folder in self.table["directory"]]


class Calibration(_Folder):
    """The directory of a `talus calibrate`."""

    @property
    def runs(self):
        """A :class:`Table` of every set of parameters that was run, with its measures."""
        return Table(self.path / "runs.csv")

    @property
    def region(self):
        """A :class:`Table` of points of the region, with predictions and their deviations ("NAME +-")."""
        return Table(self.path / "region.csv")

    @property
    def report(self):
        """What the calibration found, in words (Markdown)."""
        return (self.path / "report.md").read_text(encoding="utf-8")
