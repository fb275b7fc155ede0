"""The functions formulas need, on NumPy arrays and floats."""

from __future__ import annotations

from typing import Any

import numpy as np

Number = Any
"""Anything with `+ - * /` that a namespace below has functions for: array, jet, bounded number, symbol."""


class Arrays:
    """Namespace `m` of plain values: what a formula calls when it computes.

    Absence is NaN and a status, so the square root of a negative number is NaN without a warning from NumPy;
    callers hold `numpy.errstate` around whole evaluations.
    """

    sin = staticmethod(np.sin)
    cos = staticmethod(np.cos)
    tan = staticmethod(np.tan)
    asin = staticmethod(np.arcsin)
    acos = staticmethod(np.arccos)
    atan = staticmethod(np.arctan)
    atan2 = staticmethod(np.arctan2)
    sqrt = staticmethod(np.sqrt)
    exp = staticmethod(np.exp)
    log = staticmethod(np.log)
    abs = staticmethod(np.abs)
    sign = staticmethod(np.sign)
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
    def is_number(x: Number) -> Number:
        """Whether a value is there: not NaN."""
        return np.equal(x, x)


ARRAYS = Arrays()
