"""Declarations of the C library, read from its header: talus.h is the only place where they stand."""

import ctypes
import re
from pathlib import Path

from .errors import LibraryError

_HERE = Path(__file__).resolve().parent

# MPI_Comm is a pointer (Open MPI) or an int (MPICH), which a pointer's register holds as well.
_SCALARS = {"int": ctypes.c_int, "unsigned": ctypes.c_uint, "size_t": ctypes.c_size_t, "double": ctypes.c_double,
            "MPI_Comm": ctypes.c_void_p, "void": None}


def find_header():
    """The header that was installed with the package, or that of the sources the package stands in."""
    for file in (_HERE / "talus.h", _HERE.parents[1] / "include" / "talus.h"):
        if file.is_file():
            return file
    raise LibraryError(f"talus.h is neither in {_HERE} nor in {_HERE.parents[1] / 'include'}: this copy of the package "
                       "reads results; `pip install ./python` of the sources makes one that does everything")


class Header:
    """Functions, callbacks and constants of talus.h.

    `functions[name]` is (result, arguments) in types of ctypes; `callbacks[name]` is a type to make
    callbacks with; `constants[name]` is the number of an enum's name.
    """

    def __init__(self, text):
        text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
        text = re.sub(r"^\s*#.*$", "", text, flags=re.M)
        text = " ".join(text.split())
        self.constants, self.callbacks, self.functions = {}, {}, {}
        self.enums, self.handles = set(), set(re.findall(r"typedef struct (\w+) \1;", text))
        for name, body in re.findall(r"enum (\w+) \{(.*?)\}", text):
            self.enums.add(name)
            self._read_enum(body)
        for result, name, arguments in re.findall(r"typedef (\w+) \(\*(\w+)\)\((.*?)\);", text):
            self.callbacks[name] = ctypes.CFUNCTYPE(self._type(result), *self._arguments(arguments))
        declaration = r"((?:const )?\w+ \**)((?:Talus|talus_)\w+)\(([^()]*)\);"
        for result, name, arguments in re.findall(declaration, text):
            self.functions[name] = (self._type(result), self._arguments(arguments))

    def _read_enum(self, body):
        for name, value in re.findall(r"(\w+) = (\d+)", body):
            self.constants[name] = int(value)

    def _arguments(self, text):
        return [] if text.strip() == "void" else [self._argument(item.strip()) for item in text.split(",")]

    def _argument(self, text):
        array = "*" if text.endswith("]") else ""
        return self._type(re.sub(r"\w+(\[\d*\])?$", "", text) + array)

    def _type(self, text):
        stars = text.count("*")
        base = re.sub(r"\b(const|struct|enum)\b|\*", "", text).strip()
        if base == "char":
            strings = [None, ctypes.c_char_p, ctypes.POINTER(ctypes.c_char_p), ctypes.c_void_p]
            return ctypes.POINTER(ctypes.c_void_p) if text.strip() == "char **" else strings[stars]
        if base in self.handles or base == "void":
            kind, stars = ctypes.c_void_p if stars else None, stars - 1
        elif base in self.callbacks:
            kind = self.callbacks[base]
        else:
            kind = ctypes.c_int if base in self.enums else _SCALARS[base]
        for _ in range(max(stars, 0)):
            kind = ctypes.POINTER(kind)
        return kind
