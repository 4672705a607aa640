"""The C library: where it is, its functions as ctypes, and the session of MPI and PETSc."""

import atexit
import ctypes
import os
import weakref
from pathlib import Path

from ._header import Header, find_header
from ._version import version
from .errors import LibraryError, TalusError

_SONAME = "libtalus.so" if version == "unknown" else "libtalus.so." + ".".join(version.split(".")[:2])
_HERE = Path(__file__).resolve().parent


def _candidates():
    """Places of the library: TALUS_LIBRARY alone, or the prefix of the package, its build tree, the system's."""
    named = os.environ.get("TALUS_LIBRARY")
    if named:
        folder = Path(named)
        yield from ([folder / _SONAME, folder / "libtalus.so"] if folder.is_dir() else [folder])
        return
    for prefix in (*_HERE.parents, Path("/usr/local"), Path("/usr")):
        for pattern in ("lib", "lib64", "lib/*-linux-*"):
            yield from (folder / _SONAME for folder in sorted(prefix.glob(pattern)))
    yield _HERE.parents[1] / "build" / _SONAME
    yield _SONAME  # of the loader: ld.so.conf, LD_LIBRARY_PATH


def _load():
    tried = []
    for place in _candidates():
        if isinstance(place, Path) and not place.is_file():
            continue
        try:
            return ctypes.CDLL(str(place))
        except OSError as error:
            tried.append(f"{place}: {error}")
    where = f"TALUS_LIBRARY={os.environ['TALUS_LIBRARY']}" if "TALUS_LIBRARY" in os.environ else \
        f"{_SONAME}, which `make install` and `make` put in place"
    raise LibraryError(f"the library of talus is not found ({where}); results can be read without it. "
                       + "; ".join(tried))


class Library:
    """All functions of talus.h, as `library.TalusRanks(...)`; those that fail raise TalusError."""

    def __init__(self):
        self.header = Header(find_header().read_text())
        self._dll = _load()
        self.constants = self.header.constants
        self._started = False
        self._open = weakref.WeakSet()  # what must be closed before PETSc ends
        for name, (result, arguments) in self.header.functions.items():
            try:
                function = getattr(self._dll, name)
            except AttributeError:
                raise LibraryError(f"{self._dll._name} has no {name}: it is older than this package") from None
            function.restype, function.argtypes = result, arguments
        found = self._dll.TalusVersion().decode()
        if version != "unknown" and found.split(".")[:2] != version.split(".")[:2]:
            raise LibraryError(f"{self._dll._name} is version {found}, this package is {version}")

    def code(self, name, *arguments):
        """Call a function, return its code."""
        return getattr(self._dll, name)(*arguments)

    def call(self, name, *arguments):
        """Call a function that returns a code, and raise what it tells."""
        code = self.code(name, *arguments)
        if code:
            raise TalusError(f"{name}: {self._dll.talus_error_string(code).decode()}")

    def text(self, name, *arguments):
        """Call a function that returns a text of its own."""
        return getattr(self._dll, name)(*arguments).decode()

    def take_text(self, pointer):
        """A text that the library has handed out (a c_void_p), given back to it."""
        if not pointer.value:
            return ""
        text = ctypes.cast(pointer, ctypes.c_char_p).value.decode(errors="replace")
        self.code("TalusTextFree", ctypes.byref(pointer))
        return text

    def start(self):
        """Start MPI and PETSc, once; they end with the process."""
        if self._started:
            return
        self.call("TalusInitialize", None, None)
        self._started = True
        atexit.register(self._end)

    def watch(self, thing):
        """Close it before the session ends, if nobody did."""
        self._open.add(thing)

    def _end(self):
        for thing in list(self._open):
            thing.close()
        self.code("TalusFinalize")

    def world(self):
        """MPI_COMM_WORLD as a number: an address (Open MPI) or MPICH's constant."""
        try:
            return ctypes.addressof(ctypes.c_char.in_dll(self._dll, "ompi_mpi_comm_world"))
        except ValueError:
            return 0x44000000

    def communicator(self, comm):
        """The number of a communicator of mpi4py; None is MPI_COMM_WORLD."""
        if comm is None:
            return self.world()
        from mpi4py import MPI
        kind = ctypes.c_void_p if MPI._sizeof(MPI.Comm) == ctypes.sizeof(ctypes.c_void_p) else ctypes.c_int
        return kind.from_address(MPI._addressof(comm)).value


_library = None


def library():
    """The library with its session started; loaded at the first call.

    mpi4py, if the program uses it, must have been imported before: whoever starts MPI ends it.
    """
    global _library
    if _library is None:
        _library = Library()
    _library.start()
    return _library


def fields():
    """Fields of points that states and models have: {name: (numbers a point, unit)}.

    >>> fields()["stress"]
    (6, 'Pa')
    """
    global _library
    if _library is None:
        _library = Library()
    name, unit, components = ctypes.c_char_p(), ctypes.c_char_p(), ctypes.c_int()
    out = {}
    while not _library.code("TalusField", len(out), ctypes.byref(name), ctypes.byref(unit), ctypes.byref(components)):
        out[name.value.decode()] = (components.value, unit.value.decode())
    return out
