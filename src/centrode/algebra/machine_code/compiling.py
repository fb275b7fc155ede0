"""From LLVM's language to a function that can be called."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from typing import Any

import llvmlite
import llvmlite.binding as llvm

from centrode.algebra.machine_code.loops import ARGUMENTS, FUNCTION
from centrode.algebra.machine_code.target import Target

OPTIMISATION = 2
"""Of the code generator: registers and order. The graph itself is already free of what is computed twice."""
VERSIONS = f"llvmlite {llvmlite.__version__}, LLVM {'.'.join(map(str, llvm.llvm_version_info))}"
TYPES = [ctypes.c_int64 if argument.startswith("i64") else ctypes.c_void_p for argument in ARGUMENTS]


@dataclass(frozen=True)
class Loaded:
    """A function in memory, with what keeps it there. While it runs, other threads do too."""

    call: Any
    engine: Any


def machine(target: Target) -> Any:
    """LLVM's code generator for a machine."""
    return llvm.Target.from_triple(target.triple).create_target_machine(
        cpu=target.cpu, features=target.features, opt=OPTIMISATION, jit=True
    )


def object_code(text: str, target: Target) -> bytes:
    """A module in LLVM's language as object code."""
    module = llvm.parse_assembly(text)
    module.triple = target.triple
    generator = machine(target)
    module.data_layout = str(generator.target_data)
    module.verify()
    return bytes(generator.emit_object(module))


def loaded(code: bytes, target: Target) -> Loaded:
    """Object code brought into memory.

    Raises
    ------
    ValueError
        It has no such function.
    """
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine(target))
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    address = engine.get_function_address(FUNCTION)
    if not address:
        raise ValueError(f"no function {FUNCTION} in the object code")
    return Loaded(ctypes.CFUNCTYPE(None, *TYPES)(address), engine)
