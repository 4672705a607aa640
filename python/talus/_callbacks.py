"""Python functions where the library wants C functions. What they raise is kept and raised when the library has
returned: nothing of C may be left by an exception."""

import contextlib

import numpy as np

from .errors import TalusError


def _view(pointer, n):
    """n x 3 numbers of C as an array, not copied."""
    return np.ctypeslib.as_array(pointer, (n, 3)) if n else np.zeros((0, 3))


def _numbers(what, answer):
    """What a function has returned, as an array."""
    if answer is None:
        raise TalusError(f"the function of {what} returned None: a `return` is missing")
    return np.asarray(answer, dtype=float)


class Callbacks:
    def __init__(self, header):
        self._types = header.callbacks
        self._raised = None

    @contextlib.contextmanager
    def _kept(self):
        try:
            yield
        except BaseException as error:  # KeyboardInterrupt, too
            self._raised = self._raised or error

    def _fill(self, numbers, function):
        """Let a function fill what C gave; with no numbers once something was raised, so that no step is taken."""
        if self._raised is None:
            with self._kept():
                function(numbers)
        if self._raised is not None:
            numbers[:] = np.nan

    def raise_kept(self):
        """Raise what a function has raised meanwhile."""
        error, self._raised = self._raised, None
        if error is not None:
            raise error

    def body_force(self, function):
        """A TalusBodyForces of function(X, x, t); NULL of None."""
        if function is None:
            return self._types["TalusBodyForces"]()

        def ask(_, n, X, x, t, b):
            def force_of(wanted):
                force = _numbers("body_force", function(_view(X, n), _view(x, n), t))
                wanted[:, :force.shape[-1] if force.ndim else 3] = force

            self._fill(_view(b, n), force_of)

        return self._types["TalusBodyForces"](ask)

    def load_factors(self, function):
        """A TalusLoadFactors of function(X, x, t); NULL of None. Numbers for each place fill its three components."""
        if function is None:
            return self._types["TalusLoadFactors"]()

        def ask(_, n, X, x, t, f):
            def factor_of(wanted):
                factor = _numbers("a load", function(_view(X, n), _view(x, n), t))
                if factor.ndim == 1 and factor.shape == (n,):
                    factor = factor[:, None]  # a number for each place, not for each component
                wanted[:, :factor.shape[-1] if factor.ndim and factor.shape[-1] > 1 else 3] = factor

            self._fill(_view(f, n), factor_of)

        return self._types["TalusLoadFactors"](ask)

    def progress(self, function):
        """A TalusProgress of function(step, time, end), or one that only stops after another's exception."""
        def tell(_, step, time, end):
            stop = True
            with self._kept():
                stop = bool(function(step, time, end)) if function else False
            return int(stop or self._raised is not None)

        return self._types["TalusProgress"](tell)
