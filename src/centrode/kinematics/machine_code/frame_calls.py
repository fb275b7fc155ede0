"""A move as one call of machine code: memory, and a table that says where everything is, are made beforehand.

What `frame_code` does, with kernels and numbers of one plan. A thread writes the numbers at the free paths, calls, and
has the motion; NumPy gives the arc tangents, so that angles have the bits of `solve`.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from operator import itemgetter
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.machine_code.event_free_mechanisms import SLACK
from centrode.kinematics.machine_code.frame_code import FrameAnswer, FrameSlot, Task, frame_text
from centrode.kinematics.machine_code.frame_kernels import (
    COSINES,
    RESIDUAL,
    SINES,
    SLACK_AT_SAMPLES,
    FrameKernels,
    FrameMemory,
    FreeNumbers,
    Known,
)
from centrode.kinematics.machine_code.variables import centre_of, winding_of
from centrode.numerics.executors import (
    MACHINE_CODE,
    Take,
    address_of,
    bare_call,
    functions_before,
    machine_function,
    streamer,
)
from centrode.numerics.expressions import FOLDED, Node, apply_operation, variable
from centrode.numerics.graphs import Graph, rebuilt
from centrode.numerics.operations import CONSTANT
from centrode.numerics.scans import FUNCTIONS, Scan, room_of

Array: TypeAlias = npt.NDArray[np.float64]
Numbers: TypeAlias = npt.NDArray[np.int64]
Given: TypeAlias = Sequence[float]
MOVE, TURN, JUDGE, CALL = (int(x) for x in (Task.MOVE, Task.TURN, Task.JUDGE, Task.CALL))
CLEAR, WINDINGS = int(FrameAnswer.CLEAR), int(FrameAnswer.WINDINGS)


WORTH_A_KERNEL = 40
"""Operations in a row from which on machine code takes less time than Python."""
LANES = 16
"""Lanes of a kernel for one mechanism, all alike: as many as a vector may have."""


@dataclass(frozen=True)
class _Stage:
    """Part of a small graph: what libraries round differently, then operations that are rounded correctly.

    `groups` are functions with the places of their arguments, all of one kind together; `plain` operations with those
    of theirs, or `kernel` does these at once, from the numbers at places `inputs`, and gives so many outputs.
    """

    groups: list[tuple[Callable[..., Any], list[tuple[int, ...]]]]
    plain: list[tuple[Callable[..., float], list[int]]]
    kernel: Take | None
    inputs: list[int]
    outputs: int
    first_output: int

    def for_thread(self, before: _KernelRow | None) -> tuple[Callable[[list[Any]], None], _KernelRow | None]:
        """What adds its numbers to those that are known, with memory of its own; what its kernel leaves for the next.

        Functions of what the kernel of the stage before has left take it where it stands.
        """
        plain, kernel, inputs = self.plain, self.kernel, self.inputs
        packs: dict[tuple[int, ...], _Row | Array] = {}
        groups = []
        for function, rows in self.groups:
            # functions of the same numbers, as sines and cosines are, share a row
            fresh = [row for row in dict.fromkeys(rows) if row not in packs]
            for row in fresh:
                standing = None if before is None else before.view(row)
                packs[row] = _Row(row) if standing is None else standing
            filled = [packs[row] for row in fresh]
            fill = [row.fill for row in filled if isinstance(row, _Row)]
            taken = [row.numbers if isinstance(row, _Row) else row for row in map(packs.__getitem__, rows)]
            groups.append((fill, function, taken, np.empty(len(rows[0]))))
        left: _KernelRow | None = None
        if kernel is not None:
            given, room = _Row(tuple(inputs)), room_of(self.outputs, 1, LANES)
            fill_kernel, first = given.fill, room[:, 0, 0]
            call = _one_call(kernel, given.numbers[:, None], room)
            left = _KernelRow(self.first_output, first)

        def add(numbers: list[Any]) -> None:
            for fill, function, rows, results in groups:
                for each in fill:
                    each(numbers)
                numbers += function(*rows, results).tolist()
            if kernel is not None:
                fill_kernel(numbers)
                call()
                numbers += first.tolist()
            for operation, at in plain:
                numbers.append(operation(*[numbers[k] for k in at]))

        return add, left


@dataclass(frozen=True)
class _KernelRow:
    """What a kernel gives, as an array, and the place of the first of these numbers among all."""

    first: int
    numbers: Array

    def view(self, places: Sequence[int]) -> Array | None:
        """Numbers at some places, where these are as far from one another as from the next."""
        start, step = places[0] - self.first, places[1] - places[0] if len(places) > 1 else 1
        stop = start + step * len(places)
        if start < 0 or step < 1 or stop - step >= len(self.numbers):
            return None
        even = all(b - a == step for a, b in pairwise(places))
        return self.numbers[start:stop:step] if even else None


class _Row:
    """Numbers at some places of a list, as an array."""

    def __init__(self, places: Sequence[int]) -> None:
        self.numbers = np.zeros(len(places))
        self._pack: Callable[..., None] = struct.Struct(f"{len(places)}d").pack_into
        self._pick = _picker(places)

    def fill(self, numbers: list[Any]) -> None:
        """Take them from the list."""
        self._pack(self.numbers, 0, *self._pick(numbers))


def _picker(places: Sequence[int]) -> Callable[[list[Any]], Sequence[Any]]:
    """What gives the numbers at some places of a list; twice as fast as one after the other."""
    if len(places) < 2:
        return lambda numbers: [numbers[k] for k in places]
    return itemgetter(*places)


def _one_call(kernel: Take, row: Array, room: Array) -> Callable[[], object]:
    """One call of a kernel with one step, by a table: to hand over fourteen numbers takes longer than the kernel."""
    arguments = bare_call(kernel, row, room)
    assert arguments is not None
    table, run = np.array(arguments, dtype=np.int64), machine_function(frame_text)
    at = table.ctypes.data

    def call(_kept: object = (kernel, table, row, room)) -> None:
        run(at, CALL)

    return call


class PlainFunction:
    """All outputs of a small graph of numbers at paths, rounded as on arrays.

    What libraries round differently is left to NumPy, all functions of one kind that can be taken at once in one call.
    """

    def __init__(self, graph: Graph, paths: Sequence[str]) -> None:
        depths: dict[Node, int] = {}
        for node in graph.order:
            below = max((depths[x] for x in node.arguments), default=0)
            depths[node] = below + bool(node.arguments and node.operation not in FOLDED)
        # the numbers at the paths come first, as they are given
        constants = [node for node in graph.order if node.operation == CONSTANT]
        places = {node: k for k, node in enumerate([*map(variable, paths), *constants])}
        self._constants: list[Any] = [node.detail for node in constants]
        ends = set(graph.outputs.values())
        self._stages = []
        for depth in range(max(depths.values(), default=0) + 1):
            inner = [node for node in graph.order if node.arguments and depths[node] == depth]
            later = {x for node in graph.order if depths[node] > depth for x in node.arguments} | ends
            self._stages.append(_stage_of(inner, places, later))
        self._ends = [places[node] for node in graph.outputs.values()]

    def for_thread(self) -> Callable[[Given], Sequence[float]]:
        """The function of the numbers at the paths, with memory of its own."""
        constants, ends = self._constants, _picker(self._ends)
        stages: list[Callable[[list[Any]], None]] = []
        left: _KernelRow | None = None
        for stage in self._stages:
            add, left = stage.for_thread(left)
            stages.append(add)

        def run(values: Given) -> Sequence[float]:
            numbers = [*values, *constants]
            for stage in stages:
                stage(numbers)
            return ends(numbers)

        return run


def _stage_of(inner: Sequence[Node], places: dict[Node, int], later: Container[Node]) -> _Stage:
    """A stage of a graph; what it computes gets its places."""
    taken: dict[str, list[Node]] = {}
    for node in inner:
        if node.operation not in FOLDED:
            taken.setdefault(node.operation, []).append(node)
    groups = []
    for operation, nodes in taken.items():
        # in the order of what they are taken of, so that functions of the same numbers have one row
        nodes.sort(key=lambda node: [places[x] for x in node.arguments])
        rows = list(zip(*([places[x] for x in node.arguments] for node in nodes), strict=True))
        places |= {node: len(places) + k for k, node in enumerate(nodes)}
        groups.append((FUNCTIONS[operation], rows))
    exact = [node for node in inner if node.operation in FOLDED]
    if len(exact) < WORTH_A_KERNEL:
        plain = []
        for node in exact:
            plain.append((FOLDED[node.operation], [places[x] for x in node.arguments]))
            places[node] = len(places)
        return _Stage(groups, plain, None, [], 0, 0)
    known = dict(places)
    asked = [node for node in exact if node in later]

    def replaced_node(node: Node, _arguments: tuple[Node, ...]) -> Node | None:
        return variable(str(known[node])) if node in known and node.operation != CONSTANT else None

    graph = Graph(rebuilt({str(k): node for k, node in enumerate(asked)}, replaced_node))
    scan = Scan((), graph.variables, graph.outputs)
    kernel = streamer(scan, np.empty((0, LANES)), MACHINE_CODE, hasty=True)
    first = len(places)
    places |= {node: first + k for k, node in enumerate(asked)}
    return _Stage(groups, [], kernel, [int(name) for name in graph.variables], len(asked), first)


class CalledMemory(FrameMemory):
    """Memory of one thread, with the table that says where it is."""

    def __init__(self, called: CalledFrames) -> None:
        kernels = called.kernels
        super().__init__(kernels)
        judge, samples = kernels.judge, kernels.write.places
        links = len(judge.layout.links)
        self.values = np.zeros(called.size)
        # what NumPy finds is found where machine code looks for it
        self.centres = self.values[called.first_centre :][:links]
        self.windings = self.values[called.first_centre + links :][: links * len(judge.winders)]
        self.windings = self.windings.reshape(links, len(judge.winders))
        self.wound = np.zeros((links, judge.drives.shape[1]))
        self.wound_at_samples = np.zeros((links, samples))
        self.angles = np.empty((len(kernels.angles), samples))
        self.sines, self.cosines = (self.rows.get(name, np.empty((0, samples))) for name in (SINES, COSINES))
        self.inputs = [np.empty((max(1, len(which)), 1)) for which in called.gathers]
        self._angle_rows = np.array(
            [address_of(self.room[row, 0]) for row in kernels.angles] or [0], dtype=np.int64
        )
        self.functions = None if called.functions is None else called.functions.for_thread()
        self.table = self._table(called)
        self.address = self.table.ctypes.data

    def wind(self, kernels: FrameKernels) -> None:
        """Write down what the drives turn links by."""
        np.matmul(self.windings, kernels.judge.drives, out=self.wound)
        np.matmul(self.windings, kernels.drives, out=self.wound_at_samples)

    def _table(self, called: CalledFrames) -> Numbers:
        kernels, judge = called.kernels, called.kernels.judge
        table = np.zeros(FrameSlot.COUNT, dtype=np.int64)
        rooms = (self.mesh, self.sparse, self.room)
        first = (FrameSlot.MESH, FrameSlot.SPARSE, FrameSlot.SAMPLES)
        for scan, slot, room, inputs in zip(kernels.scans, first, rooms, self.inputs, strict=True):
            arguments = bare_call(scan.take, inputs, room)
            assert arguments is not None
            table[slot : slot + len(arguments)] = arguments
        for slot, which in zip(
            (FrameSlot.FOR_MESH, FrameSlot.FOR_SPARSE, FrameSlot.FOR_SAMPLES), called.gathers, strict=True
        ):
            table[slot], table[slot + 1] = which.ctypes.data, len(which)
        layout = judge.layout
        table[FrameSlot.VALUES] = self.values.ctypes.data
        table[FrameSlot.LEAST] = len(layout.least)
        table[FrameSlot.ROWS] = len(layout.least) + len(layout.greatest)
        table[FrameSlot.REDUCED] = self.values[called.first_reduced :].ctypes.data
        table[FrameSlot.CONDITIONS] = called.conditions.ctypes.data
        table[FrameSlot.CONDITIONS + 1] = len(called.conditions)
        table[FrameSlot.LINKS], table[FrameSlot.START] = len(layout.links), judge.start
        table[FrameSlot.AT_START] = judge.at_start.ctypes.data
        table[FrameSlot.WOUND] = self.wound.ctypes.data
        table[FrameSlot.CENTRES] = self.values[called.first_centre :].ctypes.data
        table[FrameSlot.RESIDUAL] = address_of(self.rows[RESIDUAL])
        if SLACK_AT_SAMPLES in self.rows:
            table[FrameSlot.SLACK] = address_of(self.rows[SLACK_AT_SAMPLES])
        table[FrameSlot.TURNED], table[FrameSlot.ANGLES] = len(kernels.angles), self.angles.ctypes.data
        table[FrameSlot.WOUND_AT_SAMPLES] = self.wound_at_samples.ctypes.data
        table[FrameSlot.ANGLE_ROWS] = self._angle_rows.ctypes.data
        return table


@dataclass(frozen=True)
class CalledFrames:
    """What moves a mechanism by one call.

    Attributes
    ----------
    gathers : for the scans at the nodes, the sparse ones and the samples which of the values their inputs are
    conditions : (k, 2), rows of which the least has to be positive, or the greatest negative; -1 for none
    known : variable -> its place among the values
    first_reduced, first_centre, size : places of the extremes of nodes, of the centres, and how many values there are
    functions : of the numbers at free paths, None where there are none; their numbers stand behind these
    """

    kernels: FrameKernels
    run: Callable[[int, int], int]
    gathers: tuple[Numbers, Numbers, Numbers]
    conditions: Numbers
    known: Mapping[str, int]
    first_reduced: int
    first_centre: int
    size: int
    pack: Callable[..., None]
    functions: PlainFunction | None

    @classmethod
    def of(cls, numbers: FreeNumbers, kernels: FrameKernels) -> CalledFrames | None:
        """The calls of a plan of machine code; None where they cannot be made, as of few samples."""
        rooms = [scan.room() for scan in kernels.scans]
        row = np.zeros((1, 1))
        calls = [bare_call(scan.take, row, room) for scan, room in zip(kernels.scans, rooms, strict=True)]
        # fewer places than a vector has numbers
        if any(call is None for call in calls):
            return None
        turned = {
            name: apply_operation(function, variable(numbers.paths[k]))
            for name, (k, function) in numbers.turned.items()
        }
        before = [functions_before(scan.take).substitute(turned) for scan in kernels.scans]
        nodes = {
            **turned,
            **{f"{k}: {name}": x for k, g in enumerate(before) for name, x in g.outputs.items()},
        }
        # scans have functions in common: each is computed once
        distinct = {node: len(numbers.paths) + k for k, node in enumerate(dict.fromkeys(nodes.values()))}
        graph = Graph({str(k): node for k, node in enumerate(distinct)})
        if set(graph.variables) - set(numbers.paths):
            return None
        layout, winders = kernels.judge.layout, kernels.judge.winders
        places = {name: k for name, k in numbers.copied.items()}
        places |= {name: distinct[node] for name, node in nodes.items()}
        first_reduced = len(numbers.paths) + len(distinct)
        first_greatest = first_reduced + len(layout.least)
        places |= {name: first_greatest + k for k, name in enumerate(layout.greatest)}
        first_centre = first_greatest + len(layout.greatest)
        angles = [centre_of(link) for link in layout.links]
        angles += [winding_of(link, drive) for link in layout.links for drive in winders]
        places |= {name: first_centre + k for k, name in enumerate(angles)}
        names = [
            [*scan.names, *(f"{k}: {name}" for name in g.outputs)]
            for k, (scan, g) in enumerate(zip(kernels.scans, before, strict=True))
        ]
        if any(name not in places for each in names for name in each):
            return None
        mesh, sparse, samples = (np.array([places[name] for name in each], dtype=np.int64) for each in names)
        pairs = [(layout.least.index(SLACK), -1)] if SLACK in layout.least else []
        pairs += [(low, len(layout.least) + high) for low, high in layout.divisors]
        return cls(
            kernels,
            machine_function(frame_text),
            (mesh, sparse, samples),
            np.array(pairs, dtype=np.int64).reshape(-1, 2),
            {name: k for name, k in places.items() if ": " not in name},
            first_reduced,
            first_centre,
            first_centre + len(angles),
            struct.Struct(f"{first_reduced}d").pack_into,
            PlainFunction(graph, numbers.paths) if nodes else None,
        )

    def memory(self) -> CalledMemory:
        """Memory for one thread."""
        return CalledMemory(self)

    def move(self, given: Given, memory: CalledMemory) -> bool:
        """Write the motion of a mechanism; False, with nothing to rely on, where it is not clear."""
        if not self._runs(given, memory, MOVE):
            return False
        if len(memory.angles):
            np.arctan2(memory.sines, memory.cosines, memory.angles)
            self.run(memory.address, TURN)
        return True

    def judged_variables(self, given: Given, memory: CalledMemory) -> Known | None:
        """The variables of a mechanism that is clear at the nodes; None of another."""
        if not self._runs(given, memory, JUDGE):
            return None
        values = memory.values.tolist()
        return {name: values[k] for name, k in self.known.items()}

    def _runs(self, given: Given, memory: CalledMemory, task: int) -> bool:
        functions = memory.functions
        if functions is None:
            self.pack(memory.values, 0, *given)
        else:
            self.pack(memory.values, 0, *given, *functions(given))
        answer = self.run(memory.address, task)
        if answer == WINDINGS and self.kernels.judge.centre(memory):
            # links wind otherwise than the last time
            memory.wind(self.kernels)
            answer = self.run(memory.address, task)
        return answer == CLEAR
