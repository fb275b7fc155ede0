"""Memory for results: fresh, or an array of the user's own, whose pages are there from one call to the next."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.locale import _

Array: TypeAlias = npt.NDArray[np.float64]

BLANK = 32_000_000
"""Bytes from which on the operating system gives zeros as pages that it has not made yet; less would be cleared."""


def fresh_room(numbers: int) -> tuple[Array, bool]:
    """Memory for so many numbers, and whether it is blank: zeros that take no page until they are written over."""
    blank = numbers * np.dtype(np.float64).itemsize > BLANK
    return (np.zeros if blank else np.empty)(numbers), blank


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
        what = _("it has room for {size} numbers, {numbers} are needed").format(
            size=out.size, numbers=numbers
        )
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
