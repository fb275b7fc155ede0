"""The functions formulas need, on plain floats and on arrays of whatever library these come from."""

from __future__ import annotations

import math
from typing import Any

Number = Any


class Plain:
    """Namespace `m` of plain values for rooms that import no array library: arrays say themselves whose they are."""

    def sin(self, x: Number) -> Number:
        return math.sin(x) if isinstance(x, float | int) else x.__array_namespace__().sin(x)

    def cos(self, x: Number) -> Number:
        return math.cos(x) if isinstance(x, float | int) else x.__array_namespace__().cos(x)

    def sqrt(self, x: Number) -> Number:
        return math.sqrt(x) if isinstance(x, float | int) else x.__array_namespace__().sqrt(x)

    def abs(self, x: Number) -> Number:
        return abs(x)

    def sign(self, x: Number) -> Number:
        if isinstance(x, float | int):
            return math.copysign(1.0, x) if x else 0.0
        return x.__array_namespace__().sign(x)

    def atan2(self, y: Number, x: Number) -> Number:
        if isinstance(y, float | int) and isinstance(x, float | int):
            return math.atan2(y, x)
        library = (x if isinstance(y, float | int) else y).__array_namespace__()
        return library.atan2(library.asarray(y), library.asarray(x))


PLAIN = Plain()
