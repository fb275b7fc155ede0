"""Memory for results: fresh, or an array of the user's own, whose pages are there from one call to the next."""

from __future__ import annotations

import contextlib
import math
import mmap
import sys
import threading
import weakref
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.locale import _, ngettext

Array: TypeAlias = npt.NDArray[np.float64]

BLANK = 32_000_000
"""Bytes from which on the operating system gives zeros as pages that it has not made yet; less would be cleared."""
KEPT = 256_000_000
"""Bytes of memory that are kept for the next result, at most."""


def fresh_room(numbers: int) -> tuple[Array, bool]:
    """Memory for so many numbers, and whether it is blank: zeros that take no page until they are written over.

    Memory of a result that nothing refers to any more is handed out again: its pages are there, and to make pages takes
    the operating system longer than a kernel to write them. One such room is kept, of at most `KEPT` bytes.
    """
    size = numbers * np.dtype(np.float64).itemsize
    if size <= BLANK:
        return np.empty(numbers), False
    if size > KEPT:
        return np.zeros(numbers), True
    memory = _given_back.take(size)
    blank = memory is None
    if memory is None:
        memory = _pages(size)
    room = np.frombuffer(memory, np.float64, numbers)
    # views of an array keep the array itself: when it goes, nothing refers to its memory
    weakref.finalize(room, _given_back.put, memory).atexit = False
    return room, blank


def _pages(size: int) -> mmap.mmap:
    """Pages that are not made yet, huge ones where there are some."""
    if sys.platform == "win32":
        return mmap.mmap(-1, size)
    # private: of memory that is shared there are small pages only, which take three times as long to make, and a fork
    # would write into the results of its parent
    memory = mmap.mmap(-1, size, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    if hasattr(mmap, "MADV_HUGEPAGE"):
        # a system without huge pages refuses, and gives small ones
        with contextlib.suppress(OSError):
            memory.madvise(mmap.MADV_HUGEPAGE)
    return memory


class _GivenBack:
    """The memory that was given back last."""

    def __init__(self) -> None:
        self._memory: mmap.mmap | None = None
        # an array may go at any moment, while its thread takes memory too
        self._one_at_a_time = threading.RLock()

    def take(self, size: int) -> mmap.mmap | None:
        """What is there, where it is large enough and not more than twice as large."""
        with self._one_at_a_time:
            memory = self._memory
            if memory is None or not size <= len(memory) <= 2 * size:
                return None
            self._memory = None
            return memory

    def put(self, memory: mmap.mmap) -> None:
        """Keep it in the place of what was there."""
        with self._one_at_a_time:
            self._memory = memory


_given_back = _GivenBack()


def is_blank(number: float) -> bool:
    """Whether it is the number of blank memory to the last bit."""
    return number == 0.0 and math.copysign(1.0, number) > 0.0


def blank_like(array: Array) -> Array | None:
    """Blank memory of the shape of an array, its axes in the same order in memory; none where it would be cleared."""
    whole, blank = fresh_room(array.size)
    return GivenRoom(whole).take_like(array) if blank else None


def check_room(out: object, numbers: int) -> None:
    """InputError where `out` has too little room for so many numbers, or is no array that they can be written to."""
    if (
        not isinstance(out, np.ndarray)
        or out.dtype != np.float64
        or not out.flags.c_contiguous
        or not out.flags.writeable
    ):
        what = _("an array of float64 that is contiguous and can be written to is required")
        raise InputError("out", what, _("make it by numpy.empty({numbers})").format(numbers=numbers))
    if out.size < numbers:
        what = ngettext(
            "it has room for {n} number; needed: {numbers}",
            "it has room for {n} numbers; needed: {numbers}",
            out.size,
        ).format(n=out.size, numbers=numbers)
        raise InputError("out", what, _("make it by numpy.empty({numbers})").format(numbers=numbers))


class GivenRoom:
    """Room of the user's for the arrays of one result, handed out piece by piece; fresh memory where none is given."""

    def __init__(self, out: Array | None) -> None:
        self.left = None if out is None else out.reshape(-1)

    def take(self, shape: tuple[int, ...]) -> Array:
        """The next piece."""
        if self.left is None:
            return np.empty(shape)
        numbers = math.prod(shape)
        piece, self.left = self.left[:numbers], self.left[numbers:]
        return piece.reshape(shape)

    def take_like(self, array: Array) -> Array:
        """A piece of the shape of an array, its axes in the same order in memory."""
        order = np.argsort([-step for step in array.strides], kind="stable")
        return self.take(tuple(array.shape[k] for k in order)).transpose(np.argsort(order))
