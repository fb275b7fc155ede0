"""The same graph by other compilers: as C through gcc, and as a Python loop through Numba."""

from __future__ import annotations

import ctypes
import importlib.util
import shutil
import subprocess
from collections.abc import Callable, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from centrode.numerics.expressions import Node
from centrode.numerics.operations import CONSTANT, VARIABLE
from centrode.numerics.scans import Call, Scan

Array = npt.NDArray[np.float64]
Runner = Callable[[Call], None]
FLAGS = (
    "-O3", "-march=native", "-mprefer-vector-width=512", "-ffast-math", "-fopenmp-simd", "-shared", "-fPIC",
)  # fmt: skip
"""With -ffast-math gcc has vector forms of atan2; our kernels do without."""
SIGNS = {"add": "{} + {}", "subtract": "{} - {}", "multiply": "{} * {}", "divide": "{} / {}", "negate": "-{}"}
HAS_GCC = shutil.which("gcc") is not None
HAS_NUMBA = find_spec("numba") is not None


def by_gcc(scan: Scan, folder: Path) -> Runner:
    """A scan without a state as C: steps outside, lanes inside under `omp simd`."""
    loads = {name: f"p[{i} * pr + i]" for i, name in enumerate(scan.parameters)}
    lines = _lines(scan, loads, "double {} = {};")
    inputs = [f"double {_name(scan, name)} = u[{i} * ur + k];" for i, name in enumerate(scan.inputs)]
    text = "\n".join(
        [
            "#include <math.h>",
            "void run(long lanes, long steps, const double *restrict p, long pr, const double *restrict u,",
            "         long ur, double *restrict o, long oo, long os) {",
            "  for (long k = 0; k < steps; k++) {",
            *inputs,
            "    #pragma omp simd",
            "    for (long i = 0; i < lanes; i++) {",
            *lines,
            *(f"      o[{j} * oo + k * os + i] = {value};" for j, value in enumerate(_outputs(scan))),
            "    }\n  }\n}",
        ]
    )
    source, library = folder / "scan.c", folder / "scan.so"
    source.write_text(text, encoding="utf-8")
    subprocess.run(["gcc", *FLAGS, "-o", str(library), str(source), "-lmvec", "-lm"], check=True)
    function = ctypes.CDLL(str(library)).run
    number, place = ctypes.c_long, ctypes.c_void_p
    function.argtypes = [number, number, place, number, place, number, place, number, number]
    function.restype = None

    def run(call: Call) -> None:
        p, u, o = call.parameters, call.inputs, call.outputs
        strides = [stride // 8 for stride in o.strides[:2]]
        function(
            call.lanes, call.steps, p.ctypes.data, p.strides[0] // 8, u.ctypes.data, u.strides[0] // 8,
            o.ctypes.data, *strides,
        )  # fmt: skip

    return run


def by_numba(scan: Scan, folder: Path) -> Runner:
    """A scan without a state as a loop that Numba compiles."""
    loads = {name: f"p[{i}, i]" for i, name in enumerate(scan.parameters)}
    lines = _lines(scan, loads, "{} = {}")
    text = "\n".join(
        [
            "from math import atan2, cos, sin, sqrt",
            "import numba",
            "@numba.njit(fastmath=True)",
            "def run(p, u, o):",
            "  for k in range(u.shape[1]):",
            *(f"    {_name(scan, name)} = u[{i}, k]" for i, name in enumerate(scan.inputs)),
            "    for i in range(p.shape[1]):",
            *lines,
            *(f"      o[{j}, k, i] = {value}" for j, value in enumerate(_outputs(scan))),
        ]
    )
    source = folder / "numba_scan.py"
    source.write_text(text, encoding="utf-8")
    spec = importlib.util.spec_from_file_location("numba_scan", source)
    assert spec is not None and spec.loader is not None
    module: Any = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)

    def run(call: Call) -> None:
        module.run(call.parameters, call.inputs, call.outputs)

    return run


def _lines(scan: Scan, loads: Mapping[str, str], form: str) -> list[str]:
    """The graph, one operation a line."""
    lines = [f"      {form.format(_name(scan, name), load)}" for name, load in loads.items()]
    for node in scan.graph.order:
        if node.arguments:
            inside = [_value(scan, x) for x in node.arguments]
            text = SIGNS.get(
                node.operation, node.operation + "({})" if len(inside) == 1 else node.operation + "({}, {})"
            )
            lines.append(f"      {form.format(_value(scan, node), text.format(*inside))}")
    return lines


def _outputs(scan: Scan) -> list[str]:
    return [_value(scan, node) for node in scan.outputs.values()]


def _value(scan: Scan, node: Node) -> str:
    if node.operation == CONSTANT:
        return f"({float(node.detail)!r})"
    if node.operation == VARIABLE:
        return _name(scan, str(node.detail))
    return f"t{scan.graph.order.index(node)}"


def _name(scan: Scan, name: str) -> str:
    return f"x{[*scan.parameters, *scan.inputs].index(name)}"
