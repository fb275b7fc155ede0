"""The functions formulas need, on NumPy arrays and floats."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Number = Any
"""Anything with `+ - * /` that a namespace below has functions for: array, jet, bounded number, symbol."""


class Arrays:
    """Namespace `m` of plain values: what a formula calls when it computes.

    Absence is NaN and a status, so the square root of a negative number is NaN without a warning from NumPy;
    callers hold `numpy.errstate` around whole evaluations. Complex arrays are taken for points next to the real
    axis: every function is continued analytically from there, where a formula decides, the real part does.
    """

    sin = staticmethod(np.sin)
    cos = staticmethod(np.cos)
    tan = staticmethod(np.tan)
    asin = staticmethod(np.arcsin)
    acos = staticmethod(np.arccos)
    atan = staticmethod(np.arctan)
    sqrt = staticmethod(np.sqrt)
    exp = staticmethod(np.exp)
    log = staticmethod(np.log)
    min = staticmethod(np.minimum)
    max = staticmethod(np.maximum)
    least = staticmethod(np.fmin)
    greatest = staticmethod(np.fmax)
    less = staticmethod(np.less)
    less_equal = staticmethod(np.less_equal)
    equal = staticmethod(np.equal)
    not_equal = staticmethod(np.not_equal)
    both = staticmethod(np.logical_and)
    either = staticmethod(np.logical_or)
    opposite = staticmethod(np.logical_not)
    where = staticmethod(np.where)

    @staticmethod
    def atan2(y: Number, x: Number) -> Number:
        """Angle of the vector (x, y); of a complex one that of its real part and a complex rest near zero."""
        if not (np.iscomplexobj(y) or np.iscomplexobj(x)):
            return np.arctan2(y, x)
        # arctan2 takes no complex numbers; turned back by the angle of the real part, the rest has a small
        # quotient, and arctan continues it analytically
        angle = np.arctan2(np.real(y), np.real(x))
        cosine, sine = np.cos(angle), np.sin(angle)
        return angle + np.arctan((y * cosine - x * sine) / (x * cosine + y * sine))

    @staticmethod
    def abs(x: Number) -> Number:
        """The number or its negative, whichever has a positive real part."""
        return np.where(np.real(x) < 0.0, -x, x) if np.iscomplexobj(x) else np.abs(x)

    @staticmethod
    def sign(x: Number) -> Number:
        """Sign of the real part."""
        return np.sign(np.real(x))

    @staticmethod
    def is_number(x: Number) -> Number:
        """Whether a value is there: not NaN."""
        return np.equal(x, x)


ARRAYS = Arrays()


def of_shape(number: Number, shape: tuple[int, ...]) -> npt.NDArray[np.float64]:
    """A number as an array of a shape, to be read: itself where it has that shape, as most have."""
    return number if getattr(number, "shape", None) == shape else np.broadcast_to(number, shape)
