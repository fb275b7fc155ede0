"""The two kinds of numbers of the higher oracle: doubles to trace motions, digits to solve them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath as mp


@dataclass(frozen=True)
class Field:
    """Numbers and the functions of them that equations need."""

    number: Callable[[Any], Any]
    complex: Callable[[Any, Any], Any]
    cos: Callable[[Any], Any]
    sin: Callable[[Any], Any]
    sqrt: Callable[[Any], Any]

    def rotor(self, angle: Any) -> Any:
        """The complex number of an angle."""
        return self.complex(self.cos(angle), self.sin(angle))


FLOATS = Field(float, complex, math.cos, math.sin, math.sqrt)
DIGITS = Field(mp.mpf, mp.mpc, mp.cos, mp.sin, mp.sqrt)
