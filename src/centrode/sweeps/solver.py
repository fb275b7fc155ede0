"""One mechanism whose numbers change: its plan and kernels are kept, and each change is a motion at once."""

from __future__ import annotations

import math
import sys
import threading
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError, Status
from centrode.kinematics.machine_code.frame_entries import keep_plan, kept_plan
from centrode.kinematics.machine_code.frame_kernels import RESIDUAL, quantities_of
from centrode.kinematics.machine_code.frame_plan import DirectPlan, FramePlan, FreeMechanism, traced_plan
from centrode.kinematics.machine_code.trace import Untraceable, trace_motion
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.plan_evaluation import RadicandZero, layout_of
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import Solved, check_size, grid_of, solve
from centrode.locale import _, ngettext
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import mechanism_text, parse_mechanism, value_at, with_values
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.units import read_quantity
from centrode.numerics.executors import AUTO, MACHINE_CODE, choose_executor
from centrode.sweeps import designs
from centrode.sweeps.solver_outputs import Asked, LiveColumn, LiveOutputs, SolverOutputs, asked_outputs

Array: TypeAlias = npt.NDArray[np.float64]
Values: TypeAlias = Sequence[float | str] | Mapping[str, float | str] | Array


@dataclass(frozen=True)
class MotionFrame:
    """The motion of one mechanism at the samples of a solver, as plain arrays that cannot be written to.

    Arrays of a clear mechanism are views of the solver's memory, which a later `move` uses again once nothing refers to
    the frame or to an array of it any more.

    Attributes
    ----------
    values : numbers at the free paths [SI]
    status : (samples,) int8, see `Status`
    residual : (samples,), NaN where there is no position
    events : limits and change points, in the order of the path
    arrays : quantity -> (samples, ...), by the names that a motion has them under; angles of the plane (samples, links)
    outputs : output -> its number, or (samples, ...); empty if the solver has none
    is_clear : whether machine code computed the motion: no event, every sample ok

    Examples
    --------
    >>> import centrode as ct
    >>> frame = ct.solver("crank-rocker", ["links.AB.length"], 37).move([3.6])
    >>> frame.position.shape, int(frame.status.max())
    ((37, 4, 2), 0)
    """

    solver: Solver
    values: tuple[float, ...]
    status: npt.NDArray[np.int8]
    residual: Array
    events: tuple[RadicandZero, ...]
    arrays: Mapping[str, Array]
    outputs: Mapping[str, Any]
    is_clear: bool

    def __getitem__(self, name: str) -> Array:
        return self.arrays[name]

    @property
    def position(self) -> Array:
        """Positions of points (samples, points, axes) [m]."""
        return self.arrays["position"]

    @property
    def velocity(self) -> Array:
        """Velocities of points (samples, points, axes) [m/s]."""
        return self.arrays["velocity"]

    @property
    def acceleration(self) -> Array:
        """Accelerations of points (samples, points, axes) [m/s^2]."""
        return self.arrays["acceleration"]

    @property
    def angle(self) -> Array:
        """Angles of links (samples, links) [rad]; on the sphere those of joints."""
        return self.arrays["angle" if "angle" in self.arrays else "joint_angle"]

    def copy(self) -> MotionFrame:
        """The same with arrays of its own."""
        arrays = {name: _read_only(array.copy()) for name, array in self.arrays.items()}
        outputs = {name: np.copy(x) if isinstance(x, np.ndarray) else x for name, x in self.outputs.items()}
        return MotionFrame(
            self.solver, self.values, _read_only(self.status.copy()), arrays.get(RESIDUAL, self.residual.copy()),
            self.events, arrays, outputs, self.is_clear,
        )  # fmt: skip

    def dataset(self) -> xr.Dataset:
        """The labelled motion of the mechanism with these numbers, as `motion` gives it of the changed description.

        It is computed anew, by the arrays. Raises InputError where no description can have the numbers.
        """
        return self.solver.dataset(self.values)


class _KeptFrame:
    """Memory of a thread, and the frame of what is in it.

    A slice refers to the array that owns its memory, and a frame to the mapping of its arrays: references to these are
    counted, so that nothing is overwritten that somebody still has.
    """

    def __init__(self, solver: Solver, memory: Any, status: npt.NDArray[np.int8]) -> None:
        self.memory = memory
        self.frame = MotionFrame(
            solver, solver.own, status, memory.quantities[RESIDUAL], (), memory.quantities, {}, True
        )
        owners = {id(x.base): x.base for x in self.frame.arrays.values() if x.base is not None}
        self._shown = (self.frame.arrays, *self.frame.arrays.values(), *owners.values())
        # counted while nothing but the memory and this frame refers to them
        del owners
        self._own = self._references()

    @property
    def is_free(self) -> bool:
        """Whether nobody has the frame, an array of it, or a part of one."""
        return self._references() <= self._own

    def _references(self) -> int:
        return sum(map(sys.getrefcount, self._shown))


MEMORIES = 4
"""Memories of a thread that are looked at before another one is made; a frame that is kept has its own to itself."""
_FLOATS = frozenset({float})


def _frame_like(frame: MotionFrame, values: tuple[float, ...], outputs: Mapping[str, Any]) -> MotionFrame:
    """A frame of the same arrays: to make one field by field takes as long as a short kernel."""
    made = object.__new__(MotionFrame)
    made.__dict__.update(frame.__dict__, values=values, outputs=outputs)
    return made


class Solver:
    """One mechanism whose numbers at some paths are free; made by `solver`.

    Attributes
    ----------
    mechanism : Mechanism
    free : paths, in the order of values
    samples : number of samples

    Examples
    --------
    >>> import centrode as ct
    >>> lever = ct.solver("crank-rocker", ["links.AB.length"], 37, outputs="range(angle_DB)")
    >>> lever.gradient([3.5]).shape
    (1,)
    """

    def __init__(
        self, mechanism: Mechanism, free: Sequence[str], grid: tuple[Any, ...], outputs: Asked
    ) -> None:
        self.mechanism, self.free = mechanism, tuple(free)
        self._settings = grid, outputs
        self._kinds = _kinds(mechanism, self.free)
        self.own = tuple(value_at(mechanism, path) for path in self.free)
        prepared = ready(mechanism)
        self._span = grid_of(prepared, *grid)
        self._free = FreeMechanism(prepared, self._span, self.free)
        check_size(layout_of(prepared.kinematics), 1, self.samples)
        self._free.dimensions(self.own)  # paths that are no dimension are refused here
        self._positive = [k for k in range(len(self.free)) if self._is_refused(k)]
        self._checked = any(path.startswith(("gears.", "rolling.")) for path in self.free)
        self._outputs = asked_outputs(prepared, self._span, self.free, outputs)
        executor = choose_executor(AUTO)
        self._reason = ""
        self._live: LiveOutputs | None = None
        self._plan: FramePlan | None = None
        # outputs are expressions of the trace, which is not kept: with them it is made anew
        if self._outputs is None and executor == MACHINE_CODE:
            self._plan = kept_plan(self._free)
        if self._plan is None:
            self._trace(executor)
        self._ok = _read_only(np.zeros(self.samples, dtype=np.int8))
        self._local = threading.local()

    def _trace(self, executor: str) -> None:
        """Make the plan, which is kept on disk for other processes."""
        outputs = self._outputs
        try:
            varied = self._free.varied_numbers(self.own)
            traced = trace_motion(self._free.ready, self._span, varied, differentiable=outputs is not None)
            self._plan = traced_plan(self._free, varied, traced, executor)
        except Untraceable as why:
            self._reason = why.reason
            return
        if outputs is not None and self._plan is not None:
            try:
                self._live = LiveOutputs(outputs, self._plan, traced, varied, self._free)
            except Untraceable as why:
                # the motion can be traced, the outputs are left to the arrays
                self._reason = why.reason
        elif isinstance(self._plan, DirectPlan):
            keep_plan(self._plan)

    def __reduce__(self) -> tuple[Any, ...]:
        """A solver is handed on by its description; the other process makes its own plan."""
        grid, outputs = self._settings
        return _rebuild, (mechanism_text(self.mechanism), self.free, grid, outputs)

    @property
    def columns(self) -> tuple[LiveColumn, ...]:
        """The outputs in their order, with what they are; InputError where there are none."""
        return self._require_outputs().columns

    @property
    def samples(self) -> int:
        """Number of samples."""
        return len(self._span.parameter)

    @property
    def time(self) -> Array:
        """Times of the samples [s]."""
        return self._span.time

    @property
    def parameter(self) -> Array:
        """Value of the drive at the samples [rad or m]; times [s] with a law or several drives."""
        return self._span.parameter

    def move(self, values: Values) -> MotionFrame:
        """The motion with these numbers.

        Parameters
        ----------
        values : numbers [SI] or texts with a unit in the order of the free paths, or path -> number
            Of paths that a mapping omits the description's own number stands.

        Returns
        -------
        Frame
            Numbers with which nothing assembles, and NaN, give statuses that say so.

        Raises
        ------
        InputError
            Another count of values, an unknown path, what is no number.

        Notes
        -----
        Signs of the initial position stay those of the description, as in `motion` with `vary`. Numbers differ from
        those of `motion` by rounding at most, statuses do not (docs: engine).

        Examples
        --------
        >>> import centrode as ct
        >>> lever = ct.solver("crank-rocker", ["links.AB.length"], 37)
        >>> int(lever.move(["3.6 m"]).status.max()), int(lever.move([9.0]).status.min())
        (0, 1)
        """
        # plain floats, as optimisers and pages give them, are not looked at one by one
        if type(values) is list and len(values) == len(self.free) and _FLOATS.issuperset(map(type, values)):
            given: tuple[float, ...] = tuple(values)
        else:
            given = self._read_values(values)
        if not self._possible(given):
            return self._without_values(given)
        if self._plan is not None:
            kept = self._kept_frame()
            if self._plan.move(given, kept.memory):
                outputs = {} if self._outputs is None else self._outputs_of(given)
                return _frame_like(kept.frame, given, outputs)
        return self._frame_of(given, self._solve(given))

    @property
    def without_gradient(self) -> str:
        """Why the outputs have no derivatives, as a sentence that is not translated; empty where they have some."""
        return self._reason if self._live is None else ""

    def outputs(self, values: Values) -> Any:
        """All numbers of the outputs with these values, (numbers,) one output after the other; one alone as a float.

        Examples
        --------
        >>> import centrode as ct
        >>> lever = ct.solver("crank-rocker", ["links.AB.length"], 37, outputs=["position.B.x", "position.B.y"])
        >>> lever.outputs([3.5]).shape, lever.gradient([3.5]).shape
        ((74,), (74, 1))
        """
        asked = self._require_outputs()
        return asked.join_numbers(self._outputs_of(self._read_values(values)))

    def gradient(self, values: Values) -> Array:
        """Derivatives of the outputs by the free numbers, (numbers, free); of one number alone (free,).

        NaN where an output has no value, and at limits and change points (docs: engine). Raises InputError where there
        are no outputs, or none that can be differentiated.
        """
        asked = self._require_outputs()
        if self._live is None:
            what = _("derivatives cannot be computed here: {reason}").format(reason=_(self._reason))
            raise InputError("gradient", what, _("omit gradient"))
        given = self._read_values(values)
        # what cannot be differentiated is told for any values
        self._live.require_slopes()
        if not self._possible(given):
            return asked.blank(len(self.free))
        found = self._live.gradient(given, self._memory())
        return self._live.gradient_with_events(given, self._solve(given)) if found is None else found

    def split(self, numbers: Array) -> dict[str, Array]:
        """Output -> its part of what `outputs` or `gradient` gives, in its own shape."""
        return self._require_outputs().split(np.asarray(numbers))

    def dataset(self, values: Values) -> xr.Dataset:
        """The labelled motion with these numbers. Raises InputError where no description can have them."""
        given = self._read_values(values)
        changed = with_values(self.mechanism, dict(zip(self.free, given, strict=True)))
        data = dataset_of(self._solve(given))
        return data.assign_attrs(mechanism=mechanism_text(changed))

    # values as they are given

    def _read_values(self, values: Values) -> tuple[float, ...]:
        if isinstance(values, np.ndarray):
            values = values.tolist()
        elif isinstance(values, Mapping):
            for path in values:
                if path not in self.free:
                    what = _("{path} is not free").format(path=value_text(path))
                    raise InputError("values", what, nearest(str(path), self.free))
            values = [values.get(path, own) for path, own in zip(self.free, self.own, strict=True)]
        if not isinstance(values, Sequence) or isinstance(values, str) or len(values) != len(self.free):
            what = ngettext(
                "{n} value is required, one for each free path",
                "{n} values are required, one for each free path",
                len(self.free),
            ).format(n=len(self.free))
            raise InputError("values", what, _("give them in the order of free"))
        return tuple([x if type(x) is float else self._number(k, x) for k, x in enumerate(values)])

    def _number(self, k: int, value: Any) -> float:
        path = self.free[k]
        if isinstance(value, str):
            refuses = self.mechanism.display.refuses_bare_angles
            return float(read_quantity(value, self._kinds[k], path, refuses_bare=refuses))
        try:
            return float(value)
        except (TypeError, ValueError, OverflowError):
            raise InputError(
                path, _("its values are not numbers"), _("give numbers, or texts with a unit")
            ) from None

    def _possible(self, given: tuple[float, ...]) -> bool:
        """Whether a description can have these numbers."""
        # one sum tells of all numbers, but of great ones, whose sum may be infinite
        if not math.isfinite(sum(given)) and not all(map(math.isfinite, given)):
            return False
        for k in self._positive:
            if given[k] <= 0.0:
                return False
        return not self._checked or not self._is_impossible(given)

    def _is_refused(self, k: int) -> bool:
        """Whether the k-th number has to be greater than zero."""
        return self._is_impossible([*self.own[:k], -1.0, *self.own[k + 1 :]])

    def _is_impossible(self, given: Sequence[float]) -> bool:
        try:
            self._free.dimensions(given)
        except InputError:
            return True
        return False

    # frames

    def _kept_frame(self) -> _KeptFrame:
        memories: list[_KeptFrame] | None = getattr(self._local, "memories", None)
        if memories is None:
            memories = self._local.memories = [self._make_frame()]
        kept = memories[0]
        if not kept.is_free:
            kept = next((each for each in memories if each.is_free), None) or self._make_frame()
            # the one that is used stands first, what has not been used for long is left to those who have it
            memories[:] = [kept, *(each for each in memories if each is not kept)][:MEMORIES]
        return kept

    def _make_frame(self) -> _KeptFrame:
        assert self._plan is not None
        return _KeptFrame(self, self._plan.memory(), self._ok)

    def _memory(self) -> Any:
        """Memory to judge a mechanism in; what a frame shows of it is not written to."""
        return self._kept_frame().memory

    def _solve(self, given: tuple[float, ...]) -> Solved:
        return solve(self._free.ready, self._span, self._free.dimensions(given), 1)

    def _frame_of(self, given: tuple[float, ...], solved: Solved) -> MotionFrame:
        arrays = {name: _read_only(np.asarray(values)[0]) for name, values in quantities_of(solved).items()}
        arrays[RESIDUAL] = residual = _read_only(solved.residual[0])
        outputs = {} if self._outputs is None else self._outputs.of(solved, given)
        status = _read_only(solved.status[0])
        return MotionFrame(self, given, status, residual, tuple(solved.events()), arrays, outputs, False)

    def _without_values(self, given: tuple[float, ...]) -> MotionFrame:
        """A frame of numbers that no description can have: open everywhere."""
        blank = self._frame_of(self.own, self._solve(self.own))
        arrays = {name: _read_only(np.full_like(array, np.nan)) for name, array in blank.arrays.items()}
        status = _read_only(np.full(self.samples, Status.OPEN, dtype=np.int8))
        outputs = {} if self._outputs is None else self._outputs.without_values()
        return MotionFrame(self, given, status, arrays[RESIDUAL], (), arrays, outputs, False)

    def _outputs_of(self, given: tuple[float, ...]) -> Mapping[str, Any]:
        asked = self._outputs
        if asked is None:
            return {}
        if not self._possible(given):
            return asked.without_values()
        found = None if self._live is None else self._live.values(given, self._memory())
        return asked.of(self._solve(given), given) if found is None else found

    def _require_outputs(self) -> SolverOutputs:
        if self._outputs is None:
            raise InputError(
                "outputs", _("no output is given"), _('name one, such as "position.C" or "angle"')
            )
        return self._outputs


def solver(
    mechanism: MechanismSource,
    free: Sequence[str],
    samples: int | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
    at: npt.ArrayLike | None = None,
    outputs: Asked = None,
) -> Solver:
    """A mechanism whose numbers at some paths change again and again: pages, optimisers and tolerances move it.

    Parameters
    ----------
    free : paths
        Dimensions that change ("links.AB.length"), in the order in which values are given.
    samples, start, stop, at :
        As those of `motion`.
    outputs : names or formulas
        Quantities at every sample ("position.C.x", reactions such as "joint_force.B/AB"), or formulas as those of
        `sweep`, of samples or reduced ("range(position_C_x)"); a list of them, or name -> formula.

    Returns
    -------
    Solver
        Its `move` gives a `MotionFrame`; threads may share it, and it is pickled by its description.

    Raises
    ------
    InputError
        An unknown path, one that names no dimension, a motion that `motion` refuses, an unknown output.

    Examples
    --------
    >>> import centrode as ct
    >>> lever = ct.solver("crank-rocker", ["links.AB.length", "links.DB.length"])
    >>> lever.move([3.6, 3.1]).velocity.shape
    (361, 4, 2)
    """
    mechanism = mechanism_of(mechanism)
    given: object = free
    if not isinstance(given, Iterable) or not all(isinstance(path, str) for path in free):
        repair = _("give at most {most} paths, as texts").format(most=designs.PATHS)
        raise InputError("free", repair)
    paths = [free] if isinstance(free, str) else list(free)
    if not 1 <= len(paths) <= designs.PATHS or len(set(paths)) < len(paths):
        what = _("{count} paths are given, of which {different} differ")
        raise InputError(
            "free",
            what.format(count=len(paths), different=len(set(paths))),
            _("give 1 to {most} different paths").format(most=designs.PATHS),
        )
    return Solver(mechanism, paths, (samples, start, stop, at), outputs)


def _rebuild(text: str, free: Sequence[str], grid: tuple[Any, ...], outputs: Asked) -> Solver:
    return Solver(parse_mechanism(text), free, grid, outputs)


def _kinds(mechanism: Mechanism, paths: Sequence[str]) -> list[str]:
    """Kinds of the numbers at the paths; InputError at the first that is none."""
    kinds = []
    for path in paths:
        try:
            kinds.append(designs.kind_of(mechanism, path))
        except InputError as error:
            raise InputError("free", error.what, error.repair) from None
    return kinds


def _read_only(array: npt.NDArray[Any]) -> npt.NDArray[Any]:
    view = array.view()
    view.flags.writeable = False
    return view
