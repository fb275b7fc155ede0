"""The machine that is compiled for."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import llvmlite.binding as llvm

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
    """

    triple: str
    cpu: str
    features: str
    register: int
    has_fma: bool

    def width(self, bits: int) -> int:
        """How many numbers of some bits a register holds."""
        return self.register // bits


@functools.cache
def host() -> Target:
    """The machine that this runs on."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return target_of(llvm.get_process_triple(), llvm.get_host_cpu_name(), dict(llvm.get_host_cpu_features()))


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
