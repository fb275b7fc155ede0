"""From LLVM's language to a function that can be called."""

from __future__ import annotations

import ctypes
import functools
from dataclasses import dataclass, replace
from typing import Any

import llvmlite
import llvmlite.binding as llvm

from centrode.numerics.machine_code.loops import ARGUMENTS, FUNCTION
from centrode.numerics.machine_code.targets import TARGETS, architecture, chosen_target

# The machine that is compiled for.

NARROW = 128
"""Bits of a vector register where nothing wider is known to be there: SSE2, NEON."""


@dataclass(frozen=True)
class Target:
    """A processor as LLVM names it.

    Attributes
    ----------
    triple, cpu, features : LLVM's words for it
    register : bits of its vector registers
    has_fma : whether it rounds a product and a sum at once
    effort : of the code generator on registers and order, 0 to 3; numbers are the same with any
    """

    triple: str
    cpu: str
    features: str
    register: int
    has_fma: bool
    effort: int = 2

    def width(self, bits: int) -> int:
        """Count of numbers of so many bits in one register."""
        return self.register // bits


# the graph itself is already free of what is computed twice: what is left to the generator gains a tenth
def in_haste(target: Target) -> Target:
    """The same machine, for code that is waited for: generated in half the time or less, a tenth slower."""
    return replace(target, effort=0)


@functools.cache
def host() -> Target:
    """The machine that this runs on."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return target_of(llvm.get_process_triple(), llvm.get_host_cpu_name(), dict(llvm.get_host_cpu_features()))


def standing() -> Target:
    """The machine that kernels are compiled for now: the one that was named, or the one that this runs on."""
    name = chosen_target()
    return host() if name is None else named_target(name)


@functools.cache
def named_target(name: str) -> Target:
    """A target of TARGETS."""
    host()  # code generators are made ready
    cpu, features = TARGETS[name]
    return target_of(llvm.get_process_triple(), cpu, dict.fromkeys(features, True))


def lacking_features(name: str) -> tuple[str, ...]:
    """The features of a named target that this machine does not have; its architecture where that is another one."""
    if not name.startswith(architecture()):
        return (name.partition("-v")[0],)
    present = dict(llvm.get_host_cpu_features())
    return tuple(feature for feature in TARGETS[name][1] if not present.get(feature, False))


def target_of(triple: str, cpu: str, features: dict[str, bool]) -> Target:
    """A machine by its name and features."""
    words = [f"{'+' if present else '-'}{name}" for name, present in sorted(features.items())]
    if not triple.startswith(("x86_64", "i686", "i386")):
        return Target(triple, cpu, ",".join(words), NARROW, True)
    register = 512 if features.get("avx512f") else 256 if features.get("avx2") else NARROW
    if register == 512:
        words.append(
            "-prefer-256-bit"
        )  # else LLVM splits vectors of 512 bits on most machines that have them
    return Target(triple, cpu, ",".join(words), register, bool(features.get("fma")))


VERSIONS = f"llvmlite {llvmlite.__version__}, LLVM {'.'.join(map(str, llvm.llvm_version_info))}"
TYPES = [ctypes.c_int64 if argument.startswith("i64") else ctypes.c_void_p for argument in ARGUMENTS]


@dataclass(frozen=True)
class Loaded:
    """A function in memory, with what keeps it there, and its object code. While it runs, other threads do too."""

    call: Any
    engine: Any
    code: bytes


def machine(target: Target) -> Any:
    """LLVM's code generator for a machine."""
    return llvm.Target.from_triple(target.triple).create_target_machine(
        cpu=target.cpu, features=target.features, opt=target.effort, jit=True
    )


def object_code(text: str, target: Target) -> bytes:
    """A module in LLVM's language as object code."""
    module = llvm.parse_assembly(text)
    module.triple = target.triple
    generator = machine(target)
    module.data_layout = str(generator.target_data)
    module.verify()
    return bytes(generator.emit_object(module))


def load_object_code(code: bytes, target: Target) -> Loaded:
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
    return Loaded(ctypes.CFUNCTYPE(None, *TYPES)(address), engine, code)
