"""A case that is stepped: look at its points, change them, push them."""

import contextlib
import ctypes
from collections.abc import Mapping

import numpy as np

from ._callbacks import Callbacks
from ._library import fields, library
from .errors import RunError, TalusError

_ARRAYS = {"position": "m", "displacement": "m", "velocity": "m/s", "acceleration": "m/s2", "mass": "kg",
           "deformation_gradient": "", "kirchhoff_stress": "Pa", "state": ""}


class Points(Mapping):
    """Fields of the material points of this rank, by name.

    The model's own arrays are shown as they are, without a copy, and cannot be written: position,
    displacement [m], velocity [m/s], acceleration [m/s2] with shape (n, 2), in space (n, 3); mass [kg] (n,);
    deformation_gradient (n, 5): xx xy yx yy zz, in space (n, 9) row by row; kirchhoff_stress [Pa] (n, 4):
    xx yy zz xy, in space (n, 6): xx yy zz xy yz zx; state (n, k): what the law remembers. **They are the model's
    until its next step**: ask anew, or keep a copy. All other fields of :func:`talus.fields` are computed
    when they are asked for: stress [Pa] (n, 6), pressure, mises, density, volume, id, body, ... (n,).

    Points change their order from step to step, and ranks; "id" tells them apart.

    >>> with talus.Case(block).model() as model:
    ...     model.points["velocity"].shape, model.points["stress"].shape, model.points.units["stress"]
    ((64, 2), (64, 6), 'Pa')
    """

    def __init__(self, model):
        self._model = model
        self.units = {name: unit for name, (components, unit) in fields().items() if components}
        self.units.update(_ARRAYS)

    def _array(self, name):
        """The model's own array, and whether it may be written."""
        lib, data = library(), ctypes.POINTER(ctypes.c_double)()
        n, components, writable = ctypes.c_int(), ctypes.c_int(), ctypes.c_int()
        lib.call("TalusModelArray", self._model.handle, name.encode(), ctypes.byref(data), ctypes.byref(n),
                 ctypes.byref(components), ctypes.byref(writable))
        shape = (n.value, components.value)
        array = np.ctypeslib.as_array(data, shape) if n.value * components.value else np.zeros(shape)
        return array[:, 0] if name == "mass" else array, bool(writable.value)

    def _computed(self, name):
        lib, n, components = library(), ctypes.c_int(), ctypes.c_int()
        ask = (self._model.handle, name.encode(), ctypes.byref(n), ctypes.byref(components))
        lib.call("TalusModelPoints", *ask, None, 0)
        out = np.empty((n.value, components.value))
        lib.call("TalusModelPoints", *ask, out.ctypes.data_as(ctypes.POINTER(ctypes.c_double)), out.size)
        out = out.astype(np.int64) if name in ("id", "body", "material") else out
        return out[:, 0] if components.value == 1 else out

    def __getitem__(self, name):
        if name not in self.units:
            raise KeyError(f"points have no field '{name}'; there are: {', '.join(self)}")
        if name not in _ARRAYS:
            return self._computed(name)
        array, _ = self._array(name)
        array.flags.writeable = False
        return array

    @contextlib.contextmanager
    def edit(self, name):
        """Change an array of the model in a `with`; at its end the nodes learn of it. Collective.

        These may be changed: velocity and acceleration where points carry the motion (mpm), state with any
        method. The model's energies do not count what that gives or takes. Gradients of the velocity that points
        carry beside it (`transfer: consistent` with linear functions, explicit dynamics) stay what they are.

        >>> with talus.Case(block).model() as model:
        ...     with model.points.edit("velocity") as v:
        ...         v += [0.5, 0]
        ...     model.step(), bool((model.points["position"][:, 0] > model.points["displacement"][:, 0]).all())
        (True, True)
        """
        if name not in _ARRAYS:
            raise KeyError(f"'{name}' is computed from other fields and cannot be changed")
        array, writable = self._array(name)
        if not writable:
            why = ": nodes keep the motion with this method" if name in ("velocity", "acceleration") else ""
            raise TalusError(f"'{name}' of the points cannot be changed{why}")
        try:
            yield array
        finally:
            array.flags.writeable = False
            library().call("TalusModelChanged", self._model.handle)

    def __iter__(self):
        return iter(self.units)

    def __len__(self):
        return len(self.units)

    def __repr__(self):
        return f"<talus.Points: {len(self['id'])} with {', '.join(self)}>"


class _Measures(Mapping):
    def __init__(self, model, units):
        self._model, self.units = model, units

    def __getitem__(self, name):
        if name not in self.units:
            raise KeyError(f"the case has no measure '{name}'; there are: {', '.join(self.units)}")
        value = ctypes.c_double()
        library().call("TalusModelMeasure", self._model.handle, name.encode(), ctypes.byref(value))
        return value.value

    def __iter__(self):
        return iter(self.units)

    def __len__(self):
        return len(self.units)


class Model:
    """The state of a case in time; :meth:`talus.Case.model` makes it. Use it in a `with`, or `close()` it.

    `points` are its material points (:class:`talus.Points`), `measures` the values of the case's measures now:
    `model.measures["top"]`, with `model.measures.units`. Getting a measure is collective.
    """

    def __init__(self, case):
        lib = library()
        self._callbacks = Callbacks(lib.header)
        self._handle, messages = ctypes.c_void_p(), ctypes.c_void_p()
        self._stack = contextlib.ExitStack()
        opened = self._stack.enter_context(case.opened())
        try:
            self._body_force, self._hook = case.body_force, case.push(lib, self._callbacks, opened)
            self._loads, self._load_hooks = dict(case.loads), case.vary(lib, self._callbacks, opened)
            code = lib.code("TalusModelCreate", opened, ctypes.byref(self._handle), ctypes.byref(messages))
            self._callbacks.raise_kept()
            case.tell(lib, code, messages)
        except BaseException:
            self.close()
            raise
        lib.watch(self)
        self.points, self.measures = Points(self), _Measures(self, case.measures_of(opened))

    def close(self):
        """Give the model back; its views mean nothing any more. Not from a function that its step asks. Collective."""
        if self._handle.value:
            library().call("TalusModelDestroy", ctypes.byref(self._handle))
        self._stack.close()

    @property
    def handle(self):
        """The TalusModel of the C library."""
        if not self._handle.value:
            raise TalusError("the model is closed: there is nothing left of it")
        return self._handle

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    @property
    def body_force(self):
        """A force per mass besides gravity, m/s2, or None: a function of (X, x, t).

        X and x are where the points of this rank were at the start of the model and are at the start of the
        step, m, both (n, 3), with zeros as the third column in the plane: the function's own, to keep or to change.
        t is the time of the balance that is solved, s: the middle of the step with the midpoint scheme (the default
        of elastic bodies with gimp and splines), the start of each substep in explicit dynamics, else the end of the
        step. Calls for what a step begins or ends with come besides, and each try of a step has its own: let the
        answer depend on X, x and t alone. It returns one vector for all points, of 2 or 3 numbers, or one for each,
        (n, 2) or (n, 3); 0 is no force.

        >>> with talus.Case(block).model() as model:
        ...     model.body_force = lambda X, x, t: [3 * t, 0]
        ...     model.step()
        True
        """
        return self._body_force

    @body_force.setter
    def body_force(self, function):
        hook = self._callbacks.body_force(function)
        library().call("TalusModelSetBodyForces", self.handle, hook, None)
        self._body_force, self._hook = function, hook  # the library keeps what it points to
        self._callbacks.raise_kept()

    @property
    def loads(self):
        """Functions that let loads vary from place to place: {"tractions[0]": f, "pressures[1]": g}. Not to be
        changed in place; `vary` sets one of them."""
        return dict(self._loads)

    def vary(self, load, function):
        """Let a load of the case, "tractions[0]", "pressures[0]" or "points[0]", vary from place to place and with
        time: a function of (X, x, t), or None. Collective.

        X and x are places on the loaded surface, of this rank, as undeformed and as the step begins, m, both (n, 3),
        with zeros as the third column in the plane; they and t are as for `body_force`. What it returns multiplies
        the load's `value` and `amplitude`: a number for each place, (n,), or factors of its components, (n, 3) or
        (n, 2); of all places alike, a number or [[fx, fy]]. One vector, [fx, fy], is refused, since of two places it
        would be a number for each; of two or three places the last is asked for again, up to four. With a value of 1 it is the load itself: N/m2 of undeformed surface for tractions, Pa of the
        present one, along its normal, for pressures.

        >>> case = talus.Case(block)
        >>> case["loads.pressures"] = [{"on": {"body": "block", "y": 1}, "value": 1000.0}]
        >>> with case.model() as model:
        ...     model.vary("pressures[0]", lambda X, x, t: X[:, 0] ** 2)  # none at the left, 1 kPa at the right
        ...     model.step()
        True
        """
        hook = self._callbacks.load_factors(function)
        lib = library()
        code = lib.code("TalusModelSetLoadFactors", self.handle, load.encode(), hook, None)
        if code == lib.constants["TALUS_ERROR_UNKNOWN"]:
            raise KeyError(f"the case has no load '{load}'; they are called tractions[0], pressures[0], points[0], ...")
        if code:
            raise TalusError(lib.text("talus_error_string", code))
        self._loads[load] = function
        self._load_hooks.append(hook)  # the library may still hold one before
        self._callbacks.raise_kept()

    def step(self, limit=0.0):
        """One step, halved until Newton's method converges; returns False if the end was reached before, or a
        condition of the case's `analysis.until`.

        `limit` [s] is the longest step to take, even beyond either end; 0: as the case's step control
        chooses, up to them. RunError: no step converged (the model is as it was), or points were lost. What a
        function of a force raises is raised here: no step is taken (of explicit ones a part is, and no other after it).
        Collective.
        """
        lib, step = library(), ctypes.c_int()
        lib.call("TalusModelStep", self.handle, limit, ctypes.byref(step))
        self._callbacks.raise_kept()
        if step.value in (lib.constants["TALUS_STEP_TOO_SMALL"], lib.constants["TALUS_STEP_POINTS_LOST"]):
            raise RunError(lib.text("TalusModelReason", self.handle))
        return step.value == lib.constants["TALUS_STEP_ACCEPTED"]

    def _times(self):
        time, end = ctypes.c_double(), ctypes.c_double()
        library().call("TalusModelTime", self.handle, ctypes.byref(time), ctypes.byref(end))
        return time.value, end.value

    @property
    def time(self):
        """Time of the present state, s."""
        return self._times()[0]

    @property
    def end(self):
        """End time of the case, s."""
        return self._times()[1]

    def __repr__(self):
        return f"<talus.Model at {self.time:g} of {self.end:g} s>" if self._handle.value else "<talus.Model, closed>"
