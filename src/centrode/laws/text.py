"""Motion by a formula of time written as text."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from centrode.algebra.jet_functions import JetFunctions
from centrode.algebra.jets import Jet
from centrode.algebra.text import TextFormula, compile_formula
from centrode.laws.law import Number


class _Onward(JetFunctions):
    """Jets whose `abs`, `sign`, `min` and `max` take, where they decide by a zero, the sign just behind it."""

    def sign(self, x: Number) -> Number:
        if not isinstance(x, Jet):
            return self.base.sign(x)
        found: Number = 0.0
        for coefficient in x.coefficients:
            found = found + (1.0 - found * found) * self.base.sign(coefficient)
        return found

    def abs(self, x: Number) -> Number:
        return x * self.sign(x) if isinstance(x, Jet) else self.base.abs(x)


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
        """s(t) [rad or m] over the algebra of `m`; derivatives at a kink are those that hold from there on."""
        if isinstance(t, Jet) and type(m) is JetFunctions:
            m = _Onward(m.base)
        # A constant formula still has to have the shape of t.
        return self.formula(m, t=t) if self.formula.used else t * 0.0 + self.formula(m)
