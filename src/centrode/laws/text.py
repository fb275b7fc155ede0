"""Motion by a formula of time written as text."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from centrode.algebra.text import TextFormula, compile_formula
from centrode.laws.law import Number


@dataclass(frozen=True)
class TextLaw:
    """s(t) [rad or m] by a formula in t [s], such as "0.3*sin(2*t)"; raises InputError for any other text."""

    text: str
    formula: TextFormula = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "formula", compile_formula(self.text, ("t",), ""))

    @property
    def span(self) -> tuple[float, float] | None:
        """Defined everywhere, as far as is known before it is computed."""
        return None

    def jet(self, m: Any, t: Number) -> Number:
        """s(t) [rad or m] over the algebra of `m`."""
        # A constant formula still has to have the shape of t.
        return self.formula(m, t=t) if self.formula.used else t * 0.0 + self.formula(m)
