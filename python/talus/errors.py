"""What can go wrong, as exceptions that carry what a program needs to react."""

import contextlib
import os
import re
import sys
import warnings
from dataclasses import dataclass


class TalusError(Exception):
    """Everything that talus raises by itself."""


class LibraryError(TalusError):
    """The C library cannot be found or used; reading results works without it."""


class TalusWarning(UserWarning):
    """Warnings of a case or a run, as :mod:`warnings` hands them on."""


@dataclass(frozen=True)
class Mistake:
    """One message about a case.

    `severity` is "error" or "warning"; `file`, `line` and `column` (from 1, None where it has none) tell
    the place, `key` the path of the value as in ``case["materials.sand.young"]`` where it is known, and
    `hint` what might have been meant.
    """

    severity: str
    text: str
    file: str = None
    line: int = None
    column: int = None
    key: str = None
    hint: str = None


class CaseError(TalusError):
    """A case with mistakes. `str(error)` is what the program prints; `error.mistakes` lists them."""

    def __init__(self, text, mistakes=()):
        super().__init__(text.strip())
        self.mistakes = list(mistakes)


class RunError(TalusError):
    """A run or a step that gave up. `error.run` is the :class:`talus.Run` as far as it came, or None."""

    def __init__(self, text, run=None):
        super().__init__(text.strip())
        self.run = run


_HEAD = re.compile(r"^(?:(?P<file>.*?)(?::(?P<line>\d+):(?P<column>\d+))?: )?"
                   r"(?P<severity>error|warning): (?P<text>.*)$")


def read_messages(text, key_of_line=None):
    """The :class:`Mistake` objects of what the library or the program has printed.

    `key_of_line` maps lines of a text that this package has written to the paths of their keys.

    >>> (found,) = read_messages("a.yaml:3:5: error: key 'yung' is not known\\n  hint: did you mean 'young'?")
    >>> found.file, found.line, found.column, found.text, found.hint
    ('a.yaml', 3, 5, "key 'yung' is not known", "did you mean 'young'?")
    """
    found = []
    for line in (text or "").splitlines():
        head = _HEAD.match(line)
        if head:
            fields = head.groupdict()
            number = int(fields["line"]) if fields["line"] else None
            column = int(fields["column"]) if fields["column"] else None
            key = key_of_line.get(number) if key_of_line else None
            set_by = re.match(r"--set ([^=]+)=", fields["file"] or "")
            if set_by:
                key = set_by.group(1)
            found.append(dict(fields, line=number, column=column, key=key, hint=None))
        elif line.startswith("  hint: ") and found:
            found[-1]["hint"] = line[8:]
    return [Mistake(**fields) for fields in found]


def warn_of(text):
    """Hand the warnings of a text on to :mod:`warnings`, at the line of the user that led here."""
    level, frame, ours = 1, sys._getframe(), (os.path.dirname(__file__), contextlib.__file__)
    while frame and frame.f_code.co_filename.startswith(ours):
        level, frame = level + 1, frame.f_back
    for mistake in read_messages(text):
        if mistake.severity == "warning":
            hint = f" ({mistake.hint})" if mistake.hint else ""
            warnings.warn(mistake.text + hint, TalusWarning, level)
