"""Python functions where the library wants C functions. What they raise is kept and raised when the library has
returned: nothing of C may be left by an exception."""

import contextlib

import numpy as np

from .errors import TalusError


def _view(pointer, n):
    """n x 3 numbers of C as an array, not copied."""
    return np.ctypeslib.as_array(pointer, (n, 3)) if n else np.zeros((0, 3))


def _places(pointer, n, least=0):
    """The same as an array of the function's own: the library frees or reuses its numbers, a function may keep or
    change them. The last place is repeated until there are as many as `least`."""
    places = _view(pointer, n).copy()
    return np.concatenate([places, np.repeat(places[-1:], least - n, axis=0)]) if 0 < n < least else places


def _numbers(what, answer):
    """What a function has returned, as an array."""
    if answer is None:
        raise TalusError(f"the function of {what} returned None: a `return` is missing")
    return np.asarray(answer, dtype=float)


def _of_points(force, n):
    """Forces of n points as (2,), (3,), (1, 2), (1, 3), (n, 2) or (n, 3); 0 is none."""
    if not force.ndim and force == 0:
        return np.zeros(3)
    if force.ndim not in (1, 2) or force.shape[-1] not in (2, 3) or force.shape[:-1] not in ((), (1,), (n,)):
        raise TalusError(f"the function of body_force returned numbers of shape {force.shape} for {n} points: it "
                         "returns one vector for all, of 2 or 3 numbers, or one for each, (n, 2) or (n, 3)")
    return force


_UNLIKE_VECTORS = 4  # places: numbers for so many are no vector


def _of_places(factor, n):
    """Factors of n places as (n, 1), (n, 2), (n, 3), (1, 2), (1, 3) or one number. One vector is refused: with two or
    three places it could be a number for each."""
    if factor.ndim == 1 and factor.shape == (n,):
        return factor[:, None]
    if factor.ndim == 1 and factor.size > 1:
        raise TalusError(f"the function of a load returned {factor.size} numbers for {n} places: it returns a number "
                         "for each place, (n,), or factors of the components, (n, 2) or (n, 3); those of all places "
                         "alike are [[1, 0]]")
    return factor


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
                force = _numbers("body_force", function(_places(X, n), _places(x, n), t))
                force = _of_points(force, n) if n else wanted  # of no points any shape will do
                wanted[:, :force.shape[-1]] = force

            self._fill(_view(b, n), force_of)

        return self._types["TalusBodyForces"](ask)

    def load_factors(self, function):
        """A TalusLoadFactors of function(X, x, t); NULL of None. Numbers for each place fill its three components."""
        if function is None:
            return self._types["TalusLoadFactors"]()

        def ask(_, n, X, x, t, f):
            # of two or three places a number for each looks like one vector: such a function is asked of four
            m = _UNLIKE_VECTORS if 1 < n < _UNLIKE_VECTORS else n

            def factor_of(wanted):
                factor = _of_places(_numbers("a load", function(_places(X, n, m), _places(x, n, m), t)), m)
                factor = factor[:n] if factor.ndim == 2 and len(factor) == m else factor
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
