"""Kernels: scans as machine code, called with arrays."""

from __future__ import annotations

import ctypes
import functools
import os
import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt

from centrode.numerics.expressions import constant
from centrode.numerics.graphs import Graph, graph_of_rows, graph_rows
from centrode.numerics.machine_code import cache
from centrode.numerics.machine_code.compile import (
    VERSIONS,
    Loaded,
    Target,
    host,
    in_haste,
    load_object_code,
    object_code,
    standing,
)
from centrode.numerics.machine_code.language import Vector
from centrode.numerics.machine_code.loops import (
    ConstantTable,
    LoopShape,
    Tables,
    function_text,
    with_reciprocals,
)
from centrode.numerics.scans import EXTREMES, Array, Call, Scan, Scanned, call_of, check_room

NUMBERS = {np.dtype(np.float64): "double", np.dtype(np.float32): "float"}
REMEMBERED = 256
"""Kernels kept in memory; the one that was longest not requested goes first."""
PARTS = 4
"""Parts of the work for each thread, so that none waits long for another."""

_remembered: OrderedDict[tuple[Any, ...], Kernel] = OrderedDict()
_one_at_a_time = threading.Lock()


@dataclass(frozen=True)
class Kernel:
    """A scan as machine code.

    Attributes
    ----------
    scan : what it computes
    tables : what is computed before it runs
    rest : what it computes in machine code
    shape : how the scan is carried out
    """

    scan: Scan
    tables: Tables
    rest: Scan
    shape: LoopShape
    number: np.dtype[Any]
    function: Loaded

    def run(
        self,
        parameters: npt.ArrayLike | None,
        inputs: npt.ArrayLike | None,
        state: npt.ArrayLike | None = None,
        out: Array | None = None,
        steps: int | None = None,
        new_state: Array | None = None,
        threads: int = 1,
    ) -> Scanned:
        """Run the scan; shapes as in `call_of`, `new_state` is written to if given.

        Threads share lanes, or steps if lanes are inside.
        """
        call = call_of(self.scan, parameters, inputs, state, out, steps, self.number)
        if not call.lanes or not call.steps:
            extremes = np.empty((len(self.scan.extremes), call.steps))
            return Scanned(call.outputs, _copied_state(call.state, new_state), extremes)
        width = self.shape.vector.width
        # a kernel reads and writes whole vectors: fewer lanes are filled up outside the caller's arrays
        if call.lanes < width:
            scanned = _without_padding(self._run(_pad_lanes(call, width), 1), call, self.scan.rows)
            return Scanned(scanned.outputs, _copied_state(scanned.state, new_state), scanned.extremes)
        return self._run(call, threads, new_state)

    def _run(self, call: Call, threads: int, new_state: Array | None = None) -> Scanned:
        prepared = self.tables.split_call(call)
        if self.scan.extremes:
            # there are no states where there are extremes, and these take their place
            state = self.room_of_extremes(call.steps)
        else:
            state = np.empty_like(call.state) if new_state is None else new_state
        if threads == 1:
            self._call(prepared, state)
        else:
            pool = _pool_of(threads, os.getpid())
            running = [pool.submit(self._call, *part) for part in self._parts(prepared, state, threads)]
            for done in as_completed(running):
                done.result()
        if self.scan.extremes:
            return Scanned(call.outputs, call.state, self.extremes_of(state))
        return Scanned(call.outputs, state)

    def room_of_extremes(self, steps: int) -> Array:
        """Room for extremes over the lanes of each step, one in every lane of a vector: (extremes, steps, width)."""
        return np.empty((len(self.scan.extremes), steps, self.shape.vector.width), self.number)

    def extremes_of(self, room: Array) -> Array:
        """Extremes (extremes, steps) from those in each lane of a vector."""
        kinds = [EXTREMES[x.operation] for x in self.scan.extremes.values()]
        # lane by lane along the steps: a row of a few lanes takes NumPy longer than many steps
        return np.stack([functools.reduce(kind, x.T) for kind, x in zip(kinds, room, strict=True)])

    def _parts(self, call: Call, state: Array, threads: int) -> Iterator[tuple[Call, Array]]:
        """The call in parts that do not touch one another."""
        inside, width = self.shape.lanes_inside, self.shape.vector.width
        length = call.steps if inside else call.lanes // width
        count = min(threads * PARTS, length)
        bounds = [i * length // count for i in range(count + 1)]
        # parts are whole vectors but for the last: none is narrower than a vector, and lanes of two parts do
        # not overlap
        if not inside:
            bounds = [bound * width for bound in bounds[:-1]] + [call.lanes]
        for first, last in pairwise(bounds):
            some = slice(first, last)
            if inside:
                room = state[:, some] if self.scan.extremes else state
                yield replace(call, inputs=call.inputs[:, some], outputs=call.outputs[:, some]), room
            else:
                yield _of_lanes(call, some), state[:, some]

    def _call(self, call: Call, state: Array) -> None:
        size, outputs = self.number.itemsize, call.outputs
        arguments: list[int] = [call.lanes, call.steps]
        for array in (call.parameters, call.inputs, call.state, state):
            arguments += [address(array), array.strides[0] // size]
        output, row, _one = outputs.strides
        self.function.call(*arguments, address(outputs), output // size, row // size)


def kernel_of(
    scan: Scan,
    number: npt.DTypeLike = np.float64,
    width: int | None = None,
    lanes_inside: bool = False,
    relaxed: bool = False,
    target: Target | None = None,
    hasty: bool = False,
    own_functions: bool = False,
) -> Kernel:
    """The kernel of a scan, from memory or disk if it has been compiled before.

    Parameters
    ----------
    number : float64 or float32
    width : numbers in a vector; what the machine's registers hold if left out
    lanes_inside : take every step along all lanes; only for scans without a state
    relaxed : what no status depends on may be rounded otherwise than on NumPy (see `relaxing`); faster
    target : the machine to compile for; the one that is named now (`targets`), or this one, if left out
    hasty : the code is waited for, see `in_haste`
    own_functions : with the steps inside, functions of the lanes' numbers are rounded as here, not as on NumPy
    """
    if np.dtype(number) not in NUMBERS:
        raise ValueError(f"numbers of a kernel are float64 or float32, not {np.dtype(number)}")
    machine = target or standing()
    if hasty:
        machine = in_haste(machine)
    vector = Vector(NUMBERS[np.dtype(number)], 1)
    vector = replace(vector, width=width or machine.width(vector.bits))
    if lanes_inside and scan.state:
        raise ValueError("a scan with a state takes its steps inside")
    if scan.extremes and not lanes_inside:
        raise ValueError("extremes over lanes are taken with the lanes inside")
    shape = LoopShape(vector, machine.has_fma, lanes_inside, relaxed, own_functions)
    key = (scan.key, shape, machine)
    # compiling is done without the lock: two threads may compile the same kernel, which costs time and
    # nothing else
    with _one_at_a_time:
        if key in _remembered:
            _remembered.move_to_end(key)
            return _remembered[key]
    kernel = _compile_kernel(scan, shape, np.dtype(number), machine)
    with _one_at_a_time:
        _remembered[key] = kernel
        while len(_remembered) > REMEMBERED:
            _remembered.popitem(last=False)
    return kernel


def forget() -> None:
    """Forget the kernels in memory; those on disk stay."""
    with _one_at_a_time:
        _remembered.clear()


def _compile_kernel(scan: Scan, shape: LoopShape, number: np.dtype[Any], machine: Target) -> Kernel:
    tables = Tables.of(scan, shape.lanes_inside, shape.own_functions)
    rest = tables.rest
    if shape.relaxed:
        rest = with_reciprocals(rest, rest.parameters if shape.lanes_inside else rest.inputs)
    text = function_text(rest, shape)
    return Kernel(scan, tables, rest, shape, number, compiled_function(text, machine))


# A kernel as data, from which another process has it again without what it was traced from.

Record = dict[str, Any]


def kernel_record(kernel: Kernel) -> tuple[Record, bytes]:
    """Names and tables of a kernel, as what JSON can hold, and its object code."""
    scan, tables = kernel.scan, kernel.tables
    record: Record = {
        "parameters": list(scan.parameters),
        "inputs": list(scan.inputs),
        "outputs": len(scan.outputs),
        "of steps": graph_rows(tables.of_steps.graph),
        "of lanes": graph_rows(tables.of_lanes.graph),
    }
    return record, kernel.function.code


def kernel_of_record(record: Record, code: bytes) -> Kernel:
    """The kernel of a record made on a machine of this kind, of float64 with the lanes inside.

    Its scan has the names alone: what it computes is in the object code. Raises ValueError, KeyError or TypeError
    where the record is none.
    """
    machine, number = host(), np.dtype(np.float64)
    parameters, inputs = tuple(map(str, record["parameters"])), tuple(map(str, record["inputs"]))
    scan = Scan(parameters, inputs, {str(k): constant(0.0) for k in range(int(record["outputs"]))})
    of_steps, of_lanes = graph_of_rows(record["of steps"]), graph_of_rows(record["of lanes"])
    tables = Tables(ConstantTable(inputs, of_steps), ConstantTable(parameters, of_lanes), scan)
    shape = LoopShape(Vector("double", machine.width(64)), machine.has_fma, lanes_inside=True, relaxed=False)
    return Kernel(scan, tables, scan, shape, number, load_object_code(code, machine))


def circumstances(machine: Target) -> tuple[str, str]:
    """What object code depends on besides what it computes."""
    return VERSIONS, repr(machine)


def compiled_function(text: str, machine: Target) -> Loaded:
    """The function of a text, from disk if its object code is there."""
    name = cache.name_of(text, *circumstances(machine))
    code = cache.read_entry(name)
    if code is not None:
        return load_object_code(code, machine)
    code = object_code(text, machine)
    cache.write(name, code)
    return load_object_code(code, machine)


@lru_cache(maxsize=8)
def function_of(text: Callable[[int], str]) -> Callable[[int, int], int]:
    """A function (address, number) -> number from its text for vectors of so many doubles."""
    machine = host()
    loaded = compiled_function(text(machine.width(64)), machine)
    place = ctypes.cast(loaded.call, ctypes.c_void_p).value
    found = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p, ctypes.c_int64)(place or 0)
    # what is loaded has to stay as long as the function
    found.loaded = loaded  # type: ignore[attr-defined]
    return found


def address(array: Array) -> int:
    """Where an array with a contiguous last axis begins; 0 of an empty one."""
    if not array.size:
        return 0
    # short kernels are called often: this takes half the time of what arrays tell of themselves
    row = array[(0,) * (array.ndim - 1)]
    if row.flags.writeable:
        return ctypes.addressof(ctypes.c_char.from_buffer(row))
    # read-only arrays give no buffer that can be written to
    return int(array.__array_interface__["data"][0])


@lru_cache(maxsize=4)
# the process is part of the key: after a fork threads do not exist, though the pool would be remembered
def _pool_of(threads: int, process: int) -> ThreadPoolExecutor:
    """Threads that wait for the next call: to begin them takes as long as a short kernel. A fork has none of them."""
    return ThreadPoolExecutor(threads, "kernel")


def _pad_lanes(call: Call, width: int) -> Call:
    """Fewer lanes than a vector has: the last one is repeated."""

    # repeated numbers send no lane to the C library that the call would not send there itself
    def pad(rows: Array) -> Array:
        return np.ascontiguousarray(np.pad(rows, ((0, 0), (0, width - call.lanes)), mode="edge"))

    outputs = np.empty((*call.outputs.shape[:2], width), call.outputs.dtype)
    return Call(pad(call.parameters), call.inputs, pad(call.state), outputs)


def _copied_state(state: Array, new_state: Array | None) -> Array:
    """A state of its own, that of the caller where there is one."""
    if new_state is None:
        return state.copy()
    new_state[...] = state
    return new_state


def _without_padding(scanned: Scanned, call: Call, rows: tuple[int, ...]) -> Scanned:
    for row in rows:
        call.outputs[row] = scanned.outputs[row, :, : call.lanes]
    return Scanned(call.outputs, np.ascontiguousarray(scanned.state[:, : call.lanes]), scanned.extremes)


def _of_lanes(call: Call, some: slice) -> Call:
    return Call(call.parameters[:, some], call.inputs, call.state[:, some], call.outputs[:, :, some])


# A kernel whose lanes stay while steps pass by in parts: a call costs little besides its work.


class Stream:
    """A kernel with the lanes inside and their numbers, called with one part of the steps after the other.

    Parameters
    ----------
    kernel : one without a state
    parameters : (parameters, lanes), which stay as they are
    threads : share the steps of a part
    """

    def __init__(self, kernel: Kernel, parameters: npt.ArrayLike, threads: int = 1) -> None:
        self.kernel, self.threads = kernel, threads
        self.parameters = np.ascontiguousarray(parameters, kernel.number)
        if self.parameters.ndim != 2 or len(self.parameters) != len(kernel.scan.parameters):
            raise ValueError(
                f"expected ({len(kernel.scan.parameters)}, lanes) values, got {self.parameters.shape}"
            )
        self.lanes = self.parameters.shape[1]
        # fewer lanes than a vector have to be filled up at every call, which `run` does
        self._alone = threads == 1 and self.lanes >= kernel.shape.vector.width
        self._below = kernel.tables.of_lanes.below(self.parameters)
        self._of_lanes = (address(self._below), self._below.strides[0] // kernel.number.itemsize)

    def __call__(self, inputs: npt.ArrayLike | None, out: Array, extremes: Array | None = None) -> Array:
        """Take some steps.

        Parameters
        ----------
        inputs : (inputs, steps), numbers of a row side by side; none if the scan has none
        out : (outputs, steps, lanes), is written to; its last axis has to be contiguous
        extremes : (extremes, steps), is written to where the scan has some
        """
        kernel = self.kernel
        if not self._alone or inputs is None:
            scanned = kernel.run(self.parameters, inputs, out=out, steps=out.shape[1], threads=self.threads)
            if extremes is not None:
                extremes[...] = scanned.extremes
            return scanned.outputs
        rows, size = np.asarray(inputs, kernel.number), kernel.number.itemsize
        self._check(rows, out)
        rows = kernel.tables.of_steps.below(rows)
        if rows.shape[1]:
            room, place = None, (0, 0)
            if kernel.scan.extremes:
                room = kernel.room_of_extremes(rows.shape[1])
                place = address(room), room.strides[0] // size
            kernel.function.call(
                self.lanes, rows.shape[1], *self._of_lanes, address(rows), rows.strides[0] // size, 0, 0, *place,
                address(out), out.strides[0] // size, out.strides[1] // size,
            )  # fmt: skip
            if room is not None and extremes is not None:
                extremes[...] = kernel.extremes_of(room)
        return out

    def bare_call(self, rows: Array, out: Array) -> tuple[int, ...] | None:
        """Address of the function and its arguments for one step; None of fewer lanes than a vector has.

        `rows` are (inputs and what is computed of these alone, 1), `out` (outputs, 1, lanes). Nothing is checked when
        these are used: both arrays and this stream have to be there then.
        """
        if not self._alone:
            return None
        size = self.kernel.number.itemsize
        return (
            ctypes.cast(self.kernel.function.call, ctypes.c_void_p).value or 0,
            self.lanes, 1, *self._of_lanes, address(rows), rows.strides[0] // size, 0, 0, 0, 0,
            address(out), out.strides[0] // size, out.strides[1] // size,
        )  # fmt: skip

    @property
    def functions(self) -> Graph:
        """What is computed of the inputs alone before each call: its numbers stand behind the inputs."""
        return self.kernel.tables.of_steps.graph

    def _check(self, rows: npt.NDArray[Any], out: Array) -> None:
        """Check shapes, as machine code writes to addresses and knows no sizes."""
        scan, number = self.kernel.scan, self.kernel.number
        if rows.ndim != 2 or len(rows) != len(scan.inputs) or rows.strides[1] != number.itemsize:
            raise ValueError(f"expected ({len(scan.inputs)}, n) values, row by row, got {rows.shape}")
        check_room(scan, out, rows.shape[1], self.lanes, number)
