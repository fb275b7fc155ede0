"""Numbers of a summary."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Scalar:
    """One number of a summary, in SI."""

    value: float | int
    unit: str

    def as_dict(self) -> dict[str, float | int | str]:
        """As `summary.json` holds it."""
        return {"value": self.value, "unit": self.unit}
