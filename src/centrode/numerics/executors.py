"""The executors of scans under one name: NumPy, which is always there, and machine code."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.numerics.graphs import Graph
from centrode.numerics.machine_code import PRESENT
from centrode.numerics.scans import Array, Scan, Scanned, run_on_arrays

Run: TypeAlias = Callable[..., Scanned]
Take: TypeAlias = Callable[..., Array]
AUTO, ARRAYS, MACHINE_CODE = "auto", "arrays", "machine code"

# llvmlite is heavy and may be missing: it is imported when the first kernel is requested
_kernels = functools.partial(importlib.import_module, "centrode.numerics.machine_code.kernels")
_streaming = functools.partial(importlib.import_module, "centrode.numerics.machine_code.kernels")
_compile = functools.partial(importlib.import_module, "centrode.numerics.machine_code.compile")


def choose_executor(executor: str) -> str:
    """The executor that is used where `executor` is requested: "auto" takes machine code if it can."""
    if executor not in (AUTO, ARRAYS, MACHINE_CODE):
        raise ValueError(f"no such executor: {executor}")
    if executor == AUTO:
        return MACHINE_CODE if PRESENT else ARRAYS
    return executor


def runner(
    scan: Scan,
    executor: str = AUTO,
    number: npt.DTypeLike = np.float64,
    lanes_inside: bool = False,
    relaxed: bool = False,
    threads: int = 1,
    own_functions: bool = False,
) -> Run:
    """A function (parameters, inputs, state=None, out=None, steps=None, new_state=None) that runs a scan.

    Shapes are those of `scans.call_of`; `lanes_inside`, `relaxed` and `own_functions` those of `kernel_of`, and nothing
    to NumPy.

    Raises
    ------
    ImportError
        Machine code is requested, and llvmlite (the extra `fast`) is not installed.
    """
    if choose_executor(executor) == ARRAYS:
        return functools.partial(run_on_arrays, scan, number=number)
    kernel = _kernels().kernel_of(
        scan, number, lanes_inside=lanes_inside, relaxed=relaxed, own_functions=own_functions
    )
    return functools.partial(kernel.run, threads=threads)


def streamer(
    scan: Scan, parameters: npt.ArrayLike, executor: str = AUTO, threads: int = 1, hasty: bool = False
) -> Take:
    """A function (inputs, out) that takes a scan's steps part by part, its lanes the same; `out` has the steps' room.

    `parameters` are (parameters, lanes); inputs (inputs, steps) or none; out (outputs, steps, lanes), returned again.
    Of a scan with extremes over lanes they are written to a third array, (extremes, steps).
    `hasty` is that of `kernel_of`.

    Raises
    ------
    ImportError
        Machine code is requested, and llvmlite (the extra `fast`) is not installed.
    """
    lanes = np.array(parameters, np.float64)  # a copy: the caller may change its own array afterwards
    if choose_executor(executor) == ARRAYS:

        def take(inputs: npt.ArrayLike | None, out: Array, extremes: Array | None = None) -> Array:
            scanned = run_on_arrays(scan, lanes, inputs, out=out, steps=out.shape[1])
            if extremes is not None:
                extremes[...] = scanned.extremes
            return scanned.outputs

        return take
    kernel = _kernels().kernel_of(scan, lanes_inside=True, hasty=hasty)
    stream: Take = _streaming().Stream(kernel, lanes, threads)
    return stream


def machine_function(text: Callable[[int], str]) -> Callable[[int, int], int]:
    """A function (address, number) -> number of machine code from its text for vectors of so many doubles."""
    made: Callable[[int, int], int] = _kernels().function_of(text)
    return made


def bare_call(take: Take, rows: Array, out: Array) -> tuple[int, ...] | None:
    """Address and arguments of a streamer of machine code, see `kernels.Stream.bare_call`; None of another."""
    made: tuple[int, ...] | None = take.bare_call(rows, out) if hasattr(take, "bare_call") else None
    return made


def functions_before(take: Take) -> Graph:
    """What a streamer computes of its inputs alone, behind which its numbers stand; nothing on NumPy."""
    found: Graph = take.functions if hasattr(take, "functions") else Graph({})
    return found


def address_of(array: Array) -> int:
    """Where an array with a contiguous last axis begins, as machine code is told."""
    return int(_kernels().address(array))


# A streamer of machine code as data, from which another process has it again without its scan.

StreamerRecord: TypeAlias = tuple[dict[str, Any], bytes]
"""What JSON can hold, and object code."""


def streamer_record(stream: Take) -> StreamerRecord:
    """What a streamer of machine code is made of, besides its lanes."""
    made: StreamerRecord = _kernels().kernel_record(stream.kernel)  # type: ignore[attr-defined]
    return made


def streamer_of_record(record: StreamerRecord, parameters: npt.ArrayLike) -> Take:
    """The streamer of a record made under the same `code_circumstances`, with lanes as those of `streamer`.

    Raises ValueError, KeyError, TypeError or RuntimeError where the record is none.
    """
    kernel = _kernels().kernel_of_record(*record)
    stream: Take = _streaming().Stream(kernel, np.array(parameters, np.float64))
    return stream


def code_circumstances() -> tuple[str, ...]:
    """What object code depends on besides what it computes: libraries and the machine."""
    kernels = _kernels()
    found: tuple[str, ...] = kernels.circumstances(kernels.host())
    return found


def lacking_features(target: str) -> tuple[str, ...]:
    """What this machine has not of a target of `machine_code.targets`.

    Raises ImportError where llvmlite is not installed.
    """
    found: tuple[str, ...] = _compile().lacking_features(target)
    return found
