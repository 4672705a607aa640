"""The program `talus` in processes of its own: several ranks, several runs at a time."""

import contextlib
import os
import re
import shutil
import subprocess
import tempfile
import time as clock
from pathlib import Path

from . import _yaml
from .case import Case
from .errors import CaseError, RunError, TalusError, read_messages, warn_of
from .runs import Run
from .runs import open as open_results

_HERE = Path(__file__).resolve().parent


def find_program():
    """Path of the program: TALUS_PROGRAM, that of the package's prefix, of its build tree, or of PATH.

    >>> find_program().name
    'talus'
    """
    named = os.environ.get("TALUS_PROGRAM")
    places = [Path(named)] if named else [prefix / "bin" / "talus" for prefix in _HERE.parents]
    if not named:
        places.append(_HERE.parents[1] / "build" / "talus")
        found = shutil.which("talus")
        places += [Path(found)] if found else []
    for place in places:
        if place.is_file() and os.access(place, os.X_OK):
            return place
    raise TalusError("the program talus is not found" + (f": TALUS_PROGRAM={named}" if named else
                                                         "; TALUS_PROGRAM may name it"))


@contextlib.contextmanager
def _environment():
    """That of this process as Python knows it: what MPI has put there since, or an mpiexec that started us, is not
    the child's. MPI gets a folder of its own: of two that share one, the first to end takes it away."""
    launched = "OMPI_COMM_WORLD_SIZE" in os.environ or "PMI_SIZE" in os.environ
    of_mpi = ("OMPI_", "PMIX_", "PMI_", "PRTE_", "HYDRA_")
    mine = {key: value for key, value in os.environ.items()
            if not launched or not key.startswith(of_mpi) or key.startswith("OMPI_ALLOW")}
    with tempfile.TemporaryDirectory(prefix="talus-mpi-", ignore_cleanup_errors=True) as folder:
        yield dict(mine, OMPI_MCA_orte_tmpdir_base=folder)


@contextlib.contextmanager
def _as_file(case):
    """The case as arguments of the program; a dict as a file in its folder for the time being."""
    case = case if isinstance(case, Case) else Case(case)
    functions = case.functions()
    if functions:
        raise TalusError(f"{', '.join(functions)}: a function of this process acts there, which case.run() knows and "
                         "the program does not")
    if case.document is None:
        yield [str(case.file)] + [word for change in case.settings() for word in ("--set", change)], None
        return
    text, keys = _yaml.dumps(case.document)
    handle, name = tempfile.mkstemp(".yaml", "talus-", case.folder)
    try:
        with os.fdopen(handle, "w") as out:
            out.write(text + "\n")
        yield [name], keys
    finally:
        os.unlink(name)


def _raise_for(code, text, keys, run=None):
    if code == 2:
        raise CaseError(text, read_messages(text, keys))
    if code:
        errors = [mistake.text for mistake in read_messages(text) if mistake.severity == "error"]
        raise RunError("\n".join(errors) or text or f"the program ended with code {code}", run)


@contextlib.contextmanager
def _process(words, said):
    """A process that hears signals only from here: on Ctrl-C, and on whatever else is raised, it is asked to leave,
    once, and writes its checkpoint (a second signal would end it at once)."""
    with _environment() as env:
        process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=said, env=env,
                                   start_new_session=True)
        try:
            yield process
        except BaseException:
            process.terminate()
            process.wait()
            raise


def _state_of(file):
    return (file.stat().st_ino, file.stat().st_size, file.stat().st_mtime_ns) if file.is_file() else None


def _follow(process, log, before, progress):
    """Tell progress of each new step of the log until the process ends; ask it to leave if that wants no more. The log
    of an earlier run, known by its state `before`, is none of it."""
    at, stopped = 0, False
    while True:
        ended = process.poll() is not None
        text = log.read_text(errors="replace") if _state_of(log) not in (None, before) else ""
        whole = text.rfind("\n") + 1
        for line in text[at:whole].splitlines():
            words = line.split()
            if words[:2] == ["step", "="] and words[3:5] == ["time", "="] and not stopped:
                stopped = bool(progress(int(words[2]), float(words[5])))
                if stopped and not ended:
                    process.terminate()
        at = whole
        if ended:
            return stopped
        clock.sleep(0.05)


def run(case, out, ranks=1, force=False, resume=False, progress=None, trust=False):
    """Run a case by the program, on so many ranks of MPI, into the directory `out`; returns its :class:`Run`.

    `case` is a :class:`Case`, a file or a dict. `progress(step, time)` is told of the steps (time in s); if it
    returns True the run is asked to leave with its state. `resume` goes on with the run in `out`, with the
    changes made to `case` (`talus.Case("runs/x")`). Mistakes are a CaseError, a run that gave up a RunError.

    >>> talus.run(block, "runs/by-program").history.last["step"]
    5.0
    """
    out = Path(out)
    with _as_file(case) as (words, keys):
        words = ["--resume", str(out), *words[1:]] if resume else [*words, "--out", str(out)]
        words = [str(find_program()), "run", *words, "--quiet"] + ["--force"] * bool(force) + ["--trust"] * bool(trust)
        if ranks > 1:
            words = ["mpiexec", "--oversubscribe", "-n", str(ranks), *words]
        told = progress or (lambda *_: False)
        if resume and progress and out.is_dir():
            told = _only_new(progress, Run(out).history["step"][-1])
        log = out / "log.txt"
        before = _state_of(log)
        with tempfile.TemporaryFile() as said, _process(words, said) as process:
            stopped = _follow(process, log, before, told)
            text = _said(said)
    if not stopped:
        _raise_for(process.returncode, text, keys, Run(out) if (out / "case.yaml").is_file() else None)
        warn_of(text)
    return Run(out)


def _only_new(progress, before):
    """Progress of the steps that a resumed run has not taken before."""
    return lambda step, time: step > before and progress(step, time)


def _said(file):
    file.seek(0)
    return file.read().decode(errors="replace")


def _call(words):
    with tempfile.TemporaryFile() as said, _process([str(find_program()), *words], said) as process:
        process.wait()
        return process.returncode, _said(said)


def sweep(case, over, measures=(), out=None, along=None, jobs=None, force=False):
    """`talus sweep`: a case over values of its keys, several runs at a time; returns the :class:`Sweep`.

    `over` is {key: values}: all combinations are run. `along` is {key: {other key: values}}: keys that vary along
    with one of `over`. `measures` are as `--measure` takes them ("tip:max", "flow:mean:0.2:0.8"); default: all, at the
    end. `out` is the directory, default `runs/sweep/<case>` (a dict has no name and needs it); the same call again goes
    on. A member that fails is told in its row.
    """
    if out is None and (isinstance(case, dict) or getattr(case, "document", None) is not None):
        raise TalusError("a case of a dict has no name: say where its sweep goes, out=...")
    with _as_file(case) as (words, keys):
        for key, values in over.items():
            words += ["--over", f"{key}={_values(values)}"]
            for other, others in (along or {}).get(key, {}).items():
                words += ["--along", f"{other}={_values(others)}"]
        words += [word for measure in measures for word in ("--measure", measure)]
        words += ["--out", str(out)] if out else []
        words += ["--jobs", str(jobs)] if jobs else []
        code, text = _call(["sweep", *words, *["--force"] * bool(force)])
        name = Path(words[0]).parent.resolve().name if Path(words[0]).name == "case.yaml" else Path(words[0]).stem
    folder = Path(out or Path("runs") / "sweep" / name)
    if code == 2 or not (folder / "sweep.csv").is_file():
        _raise_for(code or 1, text, keys)
    return open_results(folder)


def _values(values):
    return ",".join(_item(value) for value in values)


def _item(value):
    """A value among others: a text that is more than words, a number or a range (1:9:2) stands in quotes."""
    if not isinstance(value, str):
        return _yaml.one_line(value)
    return value if re.fullmatch(r"[\w.:/+-]+( [\w.:/+-]+)*", value) else "'" + value.replace("'", "''") + "'"


def calibrate(file, out=None, quick=False):
    """`talus calibrate FILE`: which parameters give what was measured; returns the :class:`Calibration`.

    `out` is the directory, default `runs/calibrate/<file>`. Its report tells whether the best point meets all
    targets (the program's exit code 3 if not, which is no error here).
    """
    words = ["calibrate", str(file)] + (["--out", str(out)] if out else []) + ["--quick"] * bool(quick)
    code, text = _call(words)
    folder = Path(out or Path("runs") / "calibrate" / Path(file).stem)
    if code in (1, 2) and not (folder / "report.md").is_file() or code == 2:
        _raise_for(code, text, None)
    return open_results(folder)
