"""Processors by name: kernels of a sweep that many machines share are compiled for one that all of them can run."""

from __future__ import annotations

import platform
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar

_V2 = ("cx16", "popcnt", "sahf", "sse3", "sse4.1", "sse4.2", "ssse3")
_V3 = (*_V2, "avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe")
_V4 = (*_V3, "avx512bw", "avx512cd", "avx512dq", "avx512f", "avx512vl")

TARGETS: Mapping[str, tuple[str, tuple[str, ...]]] = {
    "x86-64-v2": ("x86-64-v2", _V2),
    "x86-64-v3": ("x86-64-v3", _V3),
    "x86-64-v4": ("x86-64-v4", _V4),
    "aarch64": ("generic", ("neon",)),
}
"""Name -> the processor as LLVM names it, and the features that code for it uses: levels of the x86-64 ABI, ARMv8."""

_chosen: ContextVar[str | None] = ContextVar("named target", default=None)


@contextmanager
def compiling_for(name: str | None) -> Iterator[None]:
    """While the block runs, kernels are compiled for a target of TARGETS; None: for the machine that this runs on."""
    token = _chosen.set(name)
    try:
        yield
    finally:
        _chosen.reset(token)


def chosen_target() -> str | None:
    """The target that kernels are compiled for now; None for the machine that this runs on."""
    return _chosen.get()


def architecture() -> str:
    """The architecture of this machine as names of targets begin."""
    machine = platform.machine().lower()
    return "aarch64" if machine in ("arm64", "aarch64") else "x86-64"


def baseline() -> str:
    """The target that a cluster's machines have in common, as a rule: x86 of 2015 and later, ARMv8."""
    return "aarch64" if architecture() == "aarch64" else "x86-64-v3"
