"""Roots of many functions at once, each inside its bracket, to the last bits."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

Array: TypeAlias = npt.NDArray[np.float64]
WithSlope: TypeAlias = Callable[[Array], tuple[Array, Array]]

STEPS = 100
"""Bisection alone halves a bracket to the last bit in fewer steps than this."""


def bracketed_roots(function: WithSlope, low: Array, high: Array) -> Array:
    """Roots of a function with sign changes between `low` and `high`, elementwise.

    Newton steps, replaced by bisection where they leave the bracket. The result is exact to a few units of
    the last place of the root, as far as the function's own rounding allows.
    """
    low, high = low.copy(), high.copy()
    sign_low = np.sign(function(low)[0])
    x = 0.5 * (low + high)
    active = np.ones(x.shape, dtype=bool)
    for _ in range(STEPS):
        value, slope = function(x)
        left = np.sign(value) == sign_low
        low = np.where(active & left, x, low)
        high = np.where(active & ~left, x, high)
        with np.errstate(all="ignore"):
            step = x - value / slope
        inside = (step > low) & (step < high) & np.isfinite(step)
        following = np.where(inside, step, 0.5 * (low + high))
        # a Newton step of the last bits may point out of the bracket: it has arrived, nothing throws it back
        last_bits = 2.0 * np.spacing(np.abs(x))
        done = (value == 0.0) | (np.abs(step - x) <= last_bits) | (high - low <= last_bits)
        x = np.where(active & ~done, following, x)
        active &= ~done
        if not active.any():
            break
    return x
