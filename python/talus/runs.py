"""Runs that are done, or still going: what stands in their directories."""

import re
from pathlib import Path

from . import _yaml
from .errors import TalusError
from .states import States
from .tables import Calibration, History, Sweep, Table



def _pairs(file):
    """The lines `key = value` of a file."""
    lines = (line.split(" = ", 1) for line in file.read_text(errors="replace").splitlines() if " = " in line)
    return {key: value.split("   #")[0] for key, value in lines}


class Run:
    """The directory of a run. Everything is read when it is asked for, so that a run that is still going
    shows what it has written by then. Neither the C library nor MPI is needed.

    >>> talus.open(run)
    <talus.Run 'block': done>
    >>> talus.open(run).case["materials"]["rubber"]["young"]
    1000000.0
    """

    def __init__(self, path):
        self.path = Path(path)
        if not (self.path / "case.yaml").is_file():
            raise TalusError(f"{self.path}: there is no run here (no case.yaml)")

    def _file(self, name, what):
        file = self.path / name
        if not file.is_file():
            raise TalusError(f"{self.path}: this run has no {name}: {what}")
        return file

    @property
    def case(self):
        """The resolved case: every key with its value, defaults too, as a dict. SI units, angles in degrees."""
        return _yaml.loads((self.path / "case.yaml").read_text(encoding="utf-8"))

    @property
    def history(self):
        """What was measured, a :class:`talus.History`: arrays by name, with units."""
        return History(self._file("history.csv", "it has not begun, or was cut off before its first step"))

    @property
    def states(self):
        """The states, a :class:`talus.States`: `run.states[-1].points["stress"]`."""
        return States(self.path)

    @property
    def events(self):
        """What measures that count events noted of each, a :class:`talus.Table`; only where there are such."""
        return Table(self._file("events.csv", "no measure of the case counts events"))

    @property
    def factor(self):
        """Factors that were tried, a :class:`talus.Table`; only of an analysis for a factor of safety."""
        return Table(self._file("factor.csv", "its analysis is not for a factor of safety"))

    @property
    def log(self):
        """log.txt as a text: lines `key = value`."""
        return self._file("log.txt", "it was written elsewhere (--log)").read_text(errors="replace")

    @property
    def version(self):
        """Which talus made the run, with which libraries and on how many ranks: {name: text}."""
        return _pairs(self._file("version.txt", "it was cut off before it began"))

    @property
    def summary(self):
        """Steps, iterations, halvings, seconds and outcome of a run that has ended; {} before that.

        >>> summary = talus.open(run).summary
        >>> summary["steps"], summary["outcome"], sorted(summary["times"])[:2]
        (5, 'done', ['commit', 'initialise'])
        """
        file = self.path / "timings.txt"
        if not file.is_file():
            return {}
        pairs = _pairs(file)
        times = {key[:-4]: float(value) for key, value in pairs.items() if key.endswith(" [s]")}
        out = {key: _yaml.scalar(value) for key, value in pairs.items() if not key.endswith(" [s]")}
        return dict(out, seconds=times.pop("total", None), times=times)

    @property
    def running(self):
        """Is the run at work now, on this machine? (It holds a lock on its directory.)"""
        locks = Path("/proc/locks")
        end = f":{self.path.stat().st_ino} 0 EOF"
        return locks.is_file() and any("FLOCK" in line and line.endswith(end)
                                       for line in locks.read_text().splitlines())

    @property
    def outcome(self):
        """"done", "gave up", "interrupted" (by a signal or who called it), "running", or "cut off": it says no
        more (killed, or at work on another machine)."""
        if self.running:
            return "running"
        outcome = self.summary.get("outcome", "cut off")
        if outcome == "gave up" and re.search("^interrupted = ", self.log, re.M):
            last = re.findall("^(interrupted|gave up) = ", self.log, re.M)[-1]
            return last
        return outcome

    @property
    def reason(self):
        """Why the run gave up or was interrupted, in words; "" if it did not."""
        found = re.findall("^(?:interrupted|gave up|error) = (.*)$", self.log, re.M)
        return found[-1] if found and self.outcome in ("gave up", "interrupted") else ""

    def __repr__(self):
        return f"<talus.Run {self.path.name!r}: {self.outcome}>"


def open(path):  # as in talus.open
    """The results in a directory: a :class:`Run`, a :class:`Sweep` or a :class:`Calibration`.

    >>> talus.open(run)
    <talus.Run 'block': done>
    >>> talus.open("nowhere")
    Traceback (most recent call last):
    ...
    talus.errors.TalusError: nowhere: there is no such directory
    """
    path = Path(path)
    if not path.is_dir():
        raise TalusError(f"{path}: " + ("this is a file, not a directory of results" if path.exists() else
                                        "there is no such directory"))
    if (path / "sweep.csv").is_file():
        return Sweep(path)
    if (path / "runs.csv").is_file():
        return Calibration(path)
    if (path / "case.yaml").is_file() and (path / "version.txt").is_file():
        return Run(path)
    case = (path / "case.yaml").is_file()
    raise TalusError(f"{path}: there are no results here" + (": it is the folder of a case; talus.Case reads that"
                                                            if case else " (no run, sweep or calibration of talus)"))
