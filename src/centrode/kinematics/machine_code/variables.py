"""Variables of a traced plan: the numbers of a batch, and the place on the path."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.path import JETS, Path, SampleGrid
from centrode.kinematics.samples import ORDERS
from centrode.numerics.executors import Run, runner
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.graphs import Graph, rebuilt, split_graph
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.machine_code.loops import FUNCTIONS
from centrode.numerics.operations import VARIABLE
from centrode.numerics.scans import Reduction, Scan, evaluate
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]
Number: TypeAlias = Any

NODE_JETS = JetFunctions(EXPRESSIONS)
PARAMETER, TIME, RATE, SECOND_RATE, SCALE = "parameter", "time", "rate", "second rate", "scale"
STEP, SHARE, FIRST, SAMPLE = "step", "share", "first", "sample"
"""Of a walk along the path: how far the place before is, how often that goes into the longest step, whether there is
none, whether the place is a sample."""
ALONG = (PARAMETER, TIME, RATE, SECOND_RATE, STEP, SHARE, FIRST, SAMPLE)


def box_array(values: Sequence[Any]) -> Nodes:
    """An array of nodes and floats."""
    boxed = np.empty(len(values), dtype=object)
    for k, value in enumerate(values):
        boxed[k] = value
    return boxed


@dataclass(frozen=True)
class Varied:
    """The numbers of a batch as variables.

    Attributes
    ----------
    numbers : every array of the batch a variable, floats as they are
    names : a variable for each array that `arrays_of` finds, in its order
    scale : the greatest length, a variable where it varies, or an expression of the numbers
    """

    numbers: Dimensions
    names: tuple[str, ...]
    scale: Operand

    def values(self, numbers: Dimensions) -> dict[str, Array]:
        """Values of the variables in a batch of the same kind: name -> (lanes,)."""
        values = dict(zip(self.names, arrays_of(numbers), strict=True))
        if isinstance(self.scale, Node) and self.scale.operation == VARIABLE:
            values[SCALE] = np.asarray(numbers.scale, dtype=np.float64)
        return values

    def with_traced_scale(self) -> Varied:
        """The same with the greatest length as an expression of the numbers, of which it is a variable otherwise."""
        return replace(self, scale=self.numbers.scale)


def varied_of(numbers: Dimensions, values: Mapping[str, Array]) -> Varied:
    """The numbers of a batch as variables; those that are a varied value itself are called by its path."""
    # identity of arrays, not equality: values that happen to be equal vary on their own
    known = {id(value): path for path, value in values.items()}
    names: list[str] = []

    def lift(x: Number) -> Number:
        if isinstance(x, float):
            return x
        # one array in several places is one variable
        names.append(known.setdefault(id(x), f"number {len(names)}"))
        return variable(names[-1])

    nodes = numbers.map_numbers(lift)
    scale = numbers.scale
    return Varied(nodes, tuple(names), scale if isinstance(scale, float) else variable(SCALE))


def take_lanes(numbers: Dimensions, lanes: npt.NDArray[np.intp]) -> Dimensions:
    """The numbers of some mechanisms of a batch."""
    return numbers.map_numbers(lambda x: x if isinstance(x, float) else x[lanes])


def arrays_of(numbers: Dimensions) -> list[Array]:
    """The arrays of a batch's numbers, in the order in which `map_numbers` meets them."""
    arrays: list[Array] = []

    def seen(x: Number) -> Number:
        if not isinstance(x, float):
            arrays.append(x)
        return x

    numbers.map_numbers(seen)
    return arrays


@dataclass(frozen=True)
class TracedGrid(SampleGrid):
    """One place of the path, whose numbers may be variables."""

    accelerated: bool = False

    @property
    def accelerates(self) -> bool:
        return self.accelerated


def grid_of_variables(span: SampleGrid) -> TracedGrid:
    """The place as variables; rates that are the same everywhere as numbers."""
    accelerates = span.accelerates

    def row(name: str, values: Array) -> Any:
        # what is the same everywhere stays a number, so that zeros among them drop out of the plan
        return values[:1] if (values == values[0]).all() else box_array([variable(name)])

    second = row(SECOND_RATE, span.second_rate) if accelerates else np.zeros(1)
    place = box_array([variable(PARAMETER)])
    return TracedGrid(box_array([variable(TIME)]), place, row(RATE, span.rate), second, accelerates)


def times_of(span: SampleGrid) -> dict[str, Array]:
    """Values of time and of the rates of the parameter at the samples of a span: name -> (samples,)."""
    return {
        TIME: span.time,
        RATE: span.rate,
        SECOND_RATE: span.second_rate,
    }


# Several drives in a traced plan: their values and rates are variables of a place on the path.
#
# A law is not traced: what it gives at the places is computed by the arrays, once for all mechanisms.
# Derivatives that are the same everywhere stay numbers, so that plans skip their zeros as the arrays do.

Namespace: TypeAlias = Any


@dataclass(frozen=True)
class TracedPath(Path):
    """A path of several drives, the value of each with its derivatives as variables."""

    known: Mapping[str, Number] = field(default_factory=dict)

    def drive_values(self, m: Namespace, parameter: Number) -> dict[str, Number]:
        """Jets where the parameter is one, else values."""
        if isinstance(parameter, Jet):
            return dict(self.known)
        values = {drive: x.value if isinstance(x, Jet) else x for drive, x in self.known.items()}
        if isinstance(parameter, np.ndarray):
            return {drive: box_array([x]) for drive, x in values.items()}
        return values


def traced_path(path: Path, parameter: Array, order: int) -> Path:
    """The path as a plan is traced with; `parameter` are some of its places."""
    if not path.by_time:
        return path
    known: dict[str, Number] = {}
    for drive, value in _jets(path, parameter, order).items():
        known[drive] = value
        if isinstance(value, Jet):
            known[drive] = Jet([_operand(drive, k, x) for k, x in enumerate(value.coefficients)])
    whole = {each.name: getattr(path, each.name) for each in fields(Path)}
    return TracedPath(**whole, known=known)


def places_of(path: Path, parameter: Array, order: int) -> dict[str, Array]:
    """Values of the variables of places on the path at parameters (n,): name -> (n,)."""
    places = {PARAMETER: parameter}
    if not path.by_time:
        return places
    for drive, value in _jets(path, parameter, order).items():
        if isinstance(value, Jet):
            rows = (np.broadcast_to(x, parameter.shape) for x in value.coefficients)
            places |= {_name(drive, k): row for k, row in enumerate(rows)}
    return places


def inputs_of(path: Path, span: SampleGrid) -> dict[str, Array]:
    """Values of the variables of a place, time included, at the samples of a span: name -> (samples,)."""
    return {**places_of(path, span.parameter, ORDERS - 1), **times_of(span)}


def winders_of(path: Path) -> dict[str, Operand]:
    """Drive -> its value, of the angle drives with which links may turn."""
    if not path.by_time:
        return {path.driven[0].drive.id: variable(PARAMETER)}
    values = path.drive_values(None, variable(PARAMETER))
    return {
        driven.drive.id: values[driven.drive.id] for driven in path.driven if driven.drive.kind == "angle"
    }


def _jets(path: Path, parameter: Array, order: int) -> dict[str, Number]:
    with np.errstate(all="ignore"):
        return Path.drive_values(path, JETS, Jet.variable(parameter, order))


def _operand(drive: str, k: int, coefficient: Number) -> Operand:
    return variable(_name(drive, k)) if np.ndim(coefficient) else float(coefficient)


def _name(drive: str, k: int) -> str:
    return f"drive {drive}, {k}"


# Turns of angles as expressions: found from a centre that may run on with the drive, or by the place before.

TURN = 2.0 * math.pi
WHOLE = 1.5 * 2.0**52
"""Added and taken away again it leaves the nearest whole number: the bits behind the point do not fit."""
MOST = 0.8
"""Greatest change of an angle [rad] from one place at which turns are counted to the next."""
AWAY = 0.2
"""How far [rad] angles stay from half a turn off what tells their turns."""


def whole_turns(near: Number, angle: Number) -> Number:
    """The turns to add to an angle to come as close as may be to another, over any algebra."""
    # rounding to even of a sum beside 2^52: the operations and so the bits are the same on every executor
    return ((near - angle) * (1.0 / TURN) + WHOLE) - WHOLE


def turns_of(link: str, cosine: Operand, sine: Operand, winders: Mapping[str, Operand]) -> Operand:
    """The turns that bring an angle within half a turn of a centre that runs on with a drive."""
    centre: Operand = variable(centre_of(link))
    for drive, value in winders.items():
        centre = centre + variable(winding_of(link, drive)) * value
    turns: Operand = whole_turns(centre, EXPRESSIONS.atan2(sine, cosine))
    return turns


def turns_along(link: str, cosine: Operand, sine: Operand) -> Operand:
    """The turns that bring an angle within half a turn of what it was at the place before."""
    turns: Operand = whole_turns(variable(before_of(link)), EXPRESSIONS.atan2(sine, cosine))
    return turns


def before_of(link: str) -> str:
    """Name of a link's angle at the place before."""
    return f"angle before {link}"


def centre_of(link: str) -> str:
    """Name of the middle of a link's angles, those of the drive (times its winding) taken off."""
    return f"centre {link}"


def winding_of(link: str, drive: str) -> str:
    """Name of the turns that a link makes for one of a drive: -1, 0 or 1."""
    return f"winding {link} with {drive}"


# One pass over places of the path for many mechanisms: what is left of it are a few numbers of each.

Values: TypeAlias = Mapping[str, Array]

m = EXPRESSIONS
INFINITE = float("inf")
FUNCTION = "function "
"""Before the key of a function of what is known of mechanisms: its name among their values."""


@dataclass(frozen=True)
class LaneRows(Mapping[str, Array]):
    """Numbers of mechanisms, name -> (lanes,): first those of a block, which passes take where they stand.

    Attributes
    ----------
    names : of the rows of the block
    memory : (names or more, lanes), the block and room for what passes add to it
    more : numbers that stand elsewhere
    """

    names: tuple[str, ...]
    memory: Array
    more: Mapping[str, Array] = field(default_factory=dict)

    @classmethod
    def of(cls, values: Values, spare: int) -> LaneRows:
        """The numbers as one block, with room for so many further rows."""
        memory = np.empty((len(values) + spare, len(next(iter(values.values())))))
        for row, numbers in zip(memory, values.values(), strict=False):
            row[:] = numbers
        return cls(tuple(values), memory)

    @property
    def block(self) -> Array:
        """The numbers that stand together, (names, lanes)."""
        return self.memory[: len(self.names)]

    @property
    def room(self) -> Array:
        """Rows of the memory behind the block."""
        return self.memory[len(self.names) :]

    def with_room(self, names: Sequence[str]) -> LaneRows:
        """The block with rows behind it that have been filled in."""
        return replace(self, names=(*self.names, *names))

    def block_has(self, names: Sequence[str]) -> bool:
        """Whether numbers of these names stand in the block, at least one of them."""
        return bool(names) and self._places.keys() >= set(names)

    def take(self, lanes: npt.NDArray[np.intp]) -> LaneRows:
        """Those of some mechanisms."""
        memory = np.empty((len(self.memory), len(lanes)))
        np.take(self.block, lanes, axis=1, out=memory[: len(self.names)])
        return LaneRows(self.names, memory, {name: row[lanes] for name, row in self.more.items()})

    def __or__(self, more: Values) -> LaneRows:
        return replace(self, more={**self.more, **more})

    def __getitem__(self, name: str) -> Array:
        found = self.more.get(name)
        return self.memory[self._places[name]] if found is None else found

    def __iter__(self) -> Iterator[str]:
        return iter({**self._places, **self.more})

    def __len__(self) -> int:
        return len({**self._places, **self.more})

    @cached_property
    def _places(self) -> dict[str, int]:
        return {name: k for k, name in enumerate(self.names)}


@dataclass(frozen=True)
class Pass:
    """A reduction over places that have nothing to do with one another.

    Attributes
    ----------
    names : what may be known of mechanisms
    places : name -> (places,), what may be known of places
    compiled : functions of what is known of mechanisms, those aside whose names are known, are rounded as kernels
        round them, not as NumPy does
    """

    reduction: Reduction
    names: Sequence[str]
    places: Values
    compiled: bool = False

    @cached_property
    def _known(self) -> tuple[str, ...]:
        """The names of what is known before this pass."""
        return tuple(name for name in dict.fromkeys(self.names) if name not in self.reduction.state)

    @cached_property
    def _split(self) -> tuple[Graph, Graph]:
        """Functions of what is known of mechanisms, and the states with these as variables."""
        whole = Graph(self.reduction.state)
        functions, rest = split_graph(whole, self._known, "", FUNCTIONS)
        # called by what they are, so that passes know them from one another
        called = {name: FUNCTION + node.key.hex() for name, node in functions.outputs.items()}
        named = Graph({called[name]: node for name, node in functions.outputs.items()})
        if not self.compiled:
            return named, rest.substitute({name: variable(new) for name, new in called.items()})
        names = {node: variable(name) for name, node in named.outputs.items() if name in self.names}
        return Graph({}), Graph(rebuilt(whole.outputs, lambda node, _arguments: names.get(node)))

    @cached_property
    def scan(self) -> Scan:
        """The scan, with those of the names that are used."""
        functions, rest = self._split
        used = frozenset(rest.variables)
        return Scan(
            tuple(name for name in (*self._known, *functions.outputs) if name in used),
            tuple(name for name in self.places if name in used),
            {},
            rest.outputs,
        )

    @cached_property
    def _at_once(self) -> bool:
        """Whether nothing is handed on: what is left is then computed in one step, and nothing starts."""
        handed_on = frozenset(self._split[1].variables) & self.scan.state.keys()
        return bool(self.scan.parameters) and not self.scan.inputs and not handed_on

    @cached_property
    def _runners(self) -> dict[tuple[str, int, tuple[str, ...]], Run]:
        """What runs the scan, by executor, threads and parameters: found once, as a pass is made for every batch."""
        return {}

    def _runner(self, kernels: str, threads: int, parameters: tuple[str, ...]) -> Run:
        key = kernels, threads, parameters
        if key not in self._runners:
            scan = replace(self.scan, parameters=parameters)
            if self._at_once:
                scan = replace(scan, outputs=scan.state, state={})
            self._runners[key] = runner(scan, kernels, threads=threads, own_functions=self.compiled)
        return self._runners[key]

    @cached_property
    def _inputs(self) -> Array | None:
        names = self.scan.inputs
        return np.stack([self.places[name] for name in names]) if names else None

    def _start(self, lanes: int) -> Array:
        """What every lane starts with, (states, lanes): kept from one batch to the next."""
        start = self._starts.get(lanes)
        if start is None:
            values = np.array([[value] for value in self.reduction.start.values()])
            start = np.repeat(values, lanes, axis=1)
            self._starts.clear()
            self._starts[lanes] = start
        return start

    @cached_property
    def _starts(self) -> dict[int, Array]:
        return {}

    @property
    def function_names(self) -> tuple[str, ...]:
        """Names of the functions of what is known of mechanisms."""
        return tuple(self._split[0].outputs)

    def functions(self, values: Values) -> dict[str, Array]:
        """Functions of what is known of mechanisms, as NumPy rounds them: those that are not among the values yet."""
        missing = {name: x for name, x in self._split[0].outputs.items() if name not in values}
        if not missing:
            return {}
        lanes = len(next(iter(values.values())))
        return {name: np.broadcast_to(x, (lanes,)) for name, x in evaluate(Graph(missing), values).items()}

    def run(self, values: Values, kernels: str, threads: int, steps: int = 1) -> dict[str, Array]:
        """The states behind all places, name -> (lanes,); `steps` says how many there are where nothing tells.

        Functions that the values have already are not computed again, see `functions`.
        """
        scan = self.scan
        state = self._state(values, kernels, threads, steps, None) if scan.state else ()
        return dict(zip(scan.state, state, strict=True))

    def onto(self, rows: LaneRows, kernels: str, threads: int, steps: int = 1) -> LaneRows:
        """The numbers of mechanisms with these states, as `run` gives them, in one block where it has room."""
        names = tuple(self.scan.state)
        if not names or len(rows.room) < len(names) or rows.more.keys() & set(names):
            return rows | self.run(rows, kernels, threads, steps)
        self._state(rows, kernels, threads, steps, rows.room[: len(names)])
        return rows.with_room(names)

    def _state(self, values: Values, kernels: str, threads: int, steps: int, room: Array | None) -> Array:
        """States (states, lanes), in the room where there is one."""
        scan, lanes = self.scan, len(next(iter(values.values())))
        parameters: Array | None
        if isinstance(values, LaneRows) and values.block_has(scan.parameters):
            parameters, take = values.block, self._runner(kernels, threads, values.names)
        else:
            known = {**values, **self.functions(values)}
            parameters = np.stack([known[name] for name in scan.parameters]) if scan.parameters else None
            take = self._runner(kernels, threads, scan.parameters)
        if self._at_once:
            out = None if room is None else room[:, None]
            found: Array = take(parameters, None, out=out).outputs[:, 0]
            return found
        # every lane starts alike; where nothing else tells how many places or lanes there are, steps and states do
        count = None if scan.inputs else steps
        found = take(parameters, self._inputs, self._start(lanes), steps=count, new_state=room).state
        return found


def greatest(name: str, value: Node, start: float = -INFINITE) -> Reduction:
    """The greatest of all places; NaN where one is: such a mechanism is not clear."""
    return Reduction({name: as_node(m.max(value, variable(name)))}, {name: start})


def least(name: str, value: Node) -> Reduction:
    """The least of all places; NaN where one is."""
    return Reduction({name: as_node(m.min(value, variable(name)))}, {name: INFINITE})


def least_of(values: Sequence[Node]) -> Node:
    """The least of several; NaN where one is."""
    least = values[0]
    for value in values[1:]:
        least = as_node(m.min(least, value))
    return least
