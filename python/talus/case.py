"""Cases: from a file or a dict, changed, checked, run, or made into a model that is stepped."""

import contextlib
import copy
import ctypes
import re
from pathlib import Path

from . import _yaml
from ._callbacks import Callbacks
from ._library import library
from .errors import CaseError, RunError, TalusError, read_messages, warn_of
from .runs import Run


def _parts(path):
    """The steps of "bodies[0].shape": ["bodies", 0, "shape"]."""
    parts = re.findall(r"[^.\[\]]+|\[\d+\]", path)
    if not parts or "".join(parts).replace("[", "").replace("]", "") != re.sub(r"[.\[\]]", "", path):
        raise KeyError(path)
    return [int(part[1:-1]) if part.startswith("[") else part for part in parts]


def _walk(document, path, parts):
    for i, part in enumerate(parts):
        try:
            document = document[part]
        except (KeyError, IndexError, TypeError):
            known = f"; there are: {', '.join(document)}" if isinstance(document, dict) else ""
            raise KeyError(f"the case has no '{path}': no {part!r}{known}") from None
    return document


def _named(document):
    """The same dict with texts for its keys, which `case["boundary[0].on"]` looks for."""
    if isinstance(document, dict):
        return {_yaml.key(name): _named(item) for name, item in document.items()}
    return [_named(item) for item in document] if isinstance(document, list) else document


class Case:
    """A case of a file, of a folder with a `case.yaml`, or of a dict.

    `case["materials.sand.young"]` gets and sets values by their paths, as `--set` does; lists are counted from
    0: "bodies[0].shape". A dict may hold arrays and numbers of NumPy; files that it names (meshes) are looked
    for in `folder`. `comm` is a communicator of mpi4py, without one all ranks of MPI_COMM_WORLD; all ranks
    must then do the same with the case. `body_force` is a function of (X, x, t) or None: see
    :attr:`talus.Model.body_force`; it acts in runs, too. `loads` are functions that let loads of the case vary from
    place to place, by their places in it: see :attr:`talus.Model.loads`.

    >>> case = talus.Case(block)
    >>> case["materials.rubber.young"]
    1000000.0
    >>> case["materials.rubber.young"] = 2e6
    >>> case.run("runs/stiff").history.last["top"] > -5e-4
    True
    """

    def __init__(self, source, folder=None, comm=None, body_force=None, loads=None):
        self.comm, self.body_force, self.loads = comm, body_force, dict(loads or {})
        self.trusted, self._running = False, False
        self.document = None
        self.changes = {}
        if isinstance(source, dict):
            self.document = _named(copy.deepcopy(source))
            self.folder = Path(folder or ".")
            self.file = self.folder / "case"
        else:
            self.file = Path(source)
            if self.file.is_dir():
                self.file = self.file / "case.yaml"
            self.folder = self.file.parent

    def _changed(self, parts):
        """Paths of the changes at a key and below it."""
        return [path for path in self.changes if _parts(path)[:len(parts)] == parts]

    def __setitem__(self, path, value):
        parts = _parts(path)
        if self.document is None:
            for old in self._changed(parts):
                del self.changes[old]  # what is set last holds, and stands last
            self.changes[path] = _yaml.plain(value)
            return
        at = self.document
        for part in parts[:-1]:
            if isinstance(part, str) and isinstance(at, dict):
                at.setdefault(part, {})
            at = _walk(at, path, [part])
        if not isinstance(at, (dict, list)):
            raise KeyError(f"the case has no '{path}'")
        at[parts[-1]] = value

    def __getitem__(self, path):
        """The value of a key: what was set, what the dict holds, or what the file comes to, defaults too."""
        parts = _parts(path)
        if self._changed(parts) == [path]:
            return self.changes[path]
        return _walk(self.resolved() if self.document is None else self.document, path, parts)

    def __delitem__(self, path):
        """Take a key out of a dict, or a change back that was made to a file."""
        parts = _parts(path)
        if self.document is None:
            del self.changes[path]
        else:
            del _walk(self.document, path, parts[:-1])[parts[-1]]

    def text(self):
        """The case as the program reads it, a text: JSON of a dict; of a file all that it comes to, as YAML."""
        if self.document is not None:
            return _yaml.dumps(self.document)[0] + "\n"
        with self.opened() as handle:
            return self._resolved_text(handle)

    def functions(self):
        """What functions of this process act on: ["body_force", "loads.tractions[0]"]."""
        loads = [f"loads.{place}" for place, function in self.loads.items() if function is not None]
        return ["body_force"] * (self.body_force is not None) + loads

    def settings(self):
        """The changes to a file as `--set` takes them: ["analysis.end=0.02"]."""
        return [f"{path}={_yaml.one_line(value)}" for path, value in self.changes.items()]

    @contextlib.contextmanager
    def opened(self):
        """A TalusCase of the library; raises CaseError for mistakes, and warns."""
        lib = library()
        handle, messages = ctypes.c_void_p(), ctypes.c_void_p()
        changes = [change.encode() for change in self.settings()]
        texts = (ctypes.c_char_p * len(changes))(*changes)
        common = (len(changes), texts, ctypes.byref(handle), ctypes.byref(messages))
        comm, file, keys = lib.communicator(self.comm), str(self.file).encode(), None
        if self.document is None:
            code = lib.code("TalusCaseOpen", comm, file, *common)
        else:
            text, keys = _yaml.dumps(self.document)
            code = lib.code("TalusCaseParse", comm, file, text.encode(), *common)
        self.tell(lib, code, messages, keys)
        try:
            if self.trusted:
                lib.call("TalusCaseTrust", handle)
            yield handle
        finally:
            lib.call("TalusCaseClose", ctypes.byref(handle))

    def tell(self, lib, code, messages, keys=None):
        """What the library answered: an exception, or warnings."""
        text = lib.take_text(messages)
        if code == lib.constants["TALUS_ERROR_INPUT"]:
            raise CaseError(text, read_messages(text, keys))
        if code:
            raise TalusError(f"{lib.text('talus_error_string', code)}\n{text}")
        warn_of(text)

    def check(self):
        """Read and validate the case; CaseError tells all its mistakes.

        >>> case = talus.Case(block)
        >>> case["materials.rubber.poison"] = 0.3
        >>> try:
        ...     case.check()
        ... except talus.CaseError as error:
        ...     print(error.mistakes[0].key, "-", error.mistakes[0].hint)
        materials.rubber.poison - did you mean 'poisson'?
        """
        with self.opened():
            pass

    @staticmethod
    def _resolved_text(handle):
        lib, text = library(), ctypes.c_void_p()
        lib.call("TalusCaseText", handle, ctypes.byref(text))
        return lib.take_text(text)

    def resolved(self):
        """The case with every key, defaults too, as a dict. SI units, angles in degrees.

        >>> talus.Case(block).resolved()["analysis"]["bossak"]
        0
        """
        with self.opened() as handle:
            return _yaml.loads(self._resolved_text(handle))

    @property
    def measures(self):
        """Measures of the case and their units: {"top": "m"}."""
        with self.opened() as handle:
            return self.measures_of(handle)

    @staticmethod
    def measures_of(handle):
        """The same of a TalusCase."""
        lib = library()
        n, name, unit, out = ctypes.c_int(), ctypes.c_char_p(), ctypes.c_char_p(), {}
        lib.call("TalusCaseCountMeasures", handle, ctypes.byref(n))
        for i in range(n.value):
            lib.call("TalusCaseMeasureName", handle, i, ctypes.byref(name), ctypes.byref(unit))
            out[name.value.decode()] = unit.value.decode()
        return out

    def run(self, out, force=False, resume=False, quiet=True, progress=None):
        """Run the case in this process, into the directory `out`, as `talus run` does; returns its :class:`Run`.

        `force` replaces a run that is there. `resume` goes on with it from its newest checkpoint: the case is
        then the one of that directory (`talus.Case("runs/x")`). `quiet=False` prints what the program would.
        `progress(step, time, end)` is called after every step (times in s); if it returns True the run ends
        there, with its state and a checkpoint, and so it does on what progress or a body force raises.
        A run in which functions acted (`body_force`, `loads`) goes on with them alone: give them to the case again.
        A solver that gives up is a RunError, whose `run` holds what there is; a signal (Ctrl-C) ends the run in the
        same way with a checkpoint, and is a KeyboardInterrupt. Collective.

        >>> run = talus.Case(block).run("runs/three", progress=lambda step, time, end: step == 3)
        >>> run, run.history["step"]
        (<talus.Run 'three': interrupted>, array([0., 1., 2., 3.]))
        >>> talus.Case("runs/three").run("runs/three", resume=True).history.time[-1]
        0.01
        """
        if self._running:
            raise TalusError("the case is being run: a function that its run asks cannot run it again")
        self._running = True
        try:
            return self._run(out, force, resume, quiet, progress)
        finally:
            self._running = False

    def _run(self, out, force, resume, quiet, progress):
        lib = library()
        constants, callbacks = lib.constants, Callbacks(lib.header)
        flags = (constants["TALUS_RUN_FORCE"] * bool(force) | constants["TALUS_RUN_QUIET"] * bool(quiet)
                 | constants["TALUS_RUN_RESUME"] * bool(resume))
        stopped = []

        def watch(*now):
            stop = bool(progress and progress(*now))
            stopped.append(stop)
            return stop

        ended, messages, outcome = ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_int()
        with self.opened() as handle:
            hooks = [callbacks.progress(watch), self.push(lib, callbacks, handle), *self.vary(lib, callbacks, handle)]
            lib.call("TalusCaseSetProgress", handle, hooks[0], None)
            code = lib.code("TalusRunCase", handle, str(out).encode(), flags, ctypes.byref(ended),
                            ctypes.byref(messages))
            if not code:
                lib.call("TalusRunOutcome", ended, ctypes.byref(outcome))
                lib.call("TalusRunDestroy", ctypes.byref(ended))
        callbacks.raise_kept()
        gave_up = not code and outcome.value == constants["TALUS_GAVE_UP"]
        if gave_up:
            text = lib.take_text(messages)
            if not any(stopped[-1:]):
                errors = [mistake.text for mistake in read_messages(text) if mistake.severity == "error"]
                if any("interrupted by a signal" in error for error in errors):
                    raise KeyboardInterrupt("\n".join(errors))
                raise RunError("\n".join(errors) or text, Run(out))
        else:
            self.tell(lib, code, messages)
        return Run(out)

    def push(self, lib, callbacks, handle):
        """Hand `body_force` to a TalusCase; the hook, likewise."""
        hook = callbacks.body_force(self.body_force)
        lib.call("TalusCaseSetBodyForces", handle, hook, None)
        return hook

    def vary(self, lib, callbacks, handle):
        """Hand the functions of `loads` to a TalusCase; the hooks, to be kept as long as it may ask them."""
        hooks = []
        for place, function in self.loads.items():
            hooks.append(callbacks.load_factors(function))
            code = lib.code("TalusCaseSetLoadFactors", handle, place.encode(), hooks[-1], None)
            if code == lib.constants["TALUS_ERROR_UNKNOWN"]:
                raise KeyError(f"the case has no load '{place}'; they are called tractions[0], pressures[0], points[0], ...")
            if code:
                raise TalusError(lib.text("talus_error_string", code))
        return hooks

    def model(self):
        """The case at its start time, to be stepped: a :class:`talus.Model`, to be used in a `with`. Collective.

        >>> with talus.Case(block).model() as model:
        ...     while model.step():
        ...         pass
        ...     round(model.measures["top"], 7)
        -0.0004902
        """
        from .model import Model
        return Model(self)

    def __repr__(self):
        return f"<talus.Case {str(self.file) if self.document is None else 'of a dict'}>"
