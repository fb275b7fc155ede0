"""Motion at constant speed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from centrode.laws.law import Number


@dataclass(frozen=True)
class Uniform:
    """s(t) = speed t, with speed in rad/s or m/s."""

    speed: float

    @property
    def span(self) -> tuple[float, float] | None:
        """Defined everywhere."""
        return None

    def jet(self, m: Any, t: Number) -> Number:
        """s(t) [rad or m] over the algebra of `m`."""
        return t * self.speed
