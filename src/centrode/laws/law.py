"""What a motion law is."""

from __future__ import annotations

from typing import Any, Protocol

Number = Any


class Law(Protocol):
    """A motion law s(t); with jets as t it gives its derivatives."""

    @property
    def span(self) -> tuple[float, float] | None:
        """First and last t [s] at which the law is defined; None: everywhere."""

    def jet(self, m: Any, t: Number) -> Number:
        """s(t) [rad or m] over the algebra whose functions `m` holds."""
