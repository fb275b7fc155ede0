"""Sums as SymPy expressions, for whoever goes on with them. SymPy is an extra and slow to import: it comes late."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from fractions import Fraction
from importlib.util import find_spec
from typing import Any

import lazy_loader

from centrode.equations.letters import Wave
from centrode.equations.sums import Sum
from centrode.errors import InputError
from centrode.locale import _

_load = functools.partial(lazy_loader.load, "sympy")


def sympy() -> Any:
    """The library; raises InputError where it is not installed."""
    if find_spec("sympy") is None:
        raise InputError(
            "",
            _("expressions need SymPy, which is not installed"),
            _('install it with pip install "centrode[symbols]"'),
        )
    return _load()


def expression(total: Sum) -> Any:
    """A sum as a SymPy expression; its symbols have the names of the letters and no assumptions."""
    library = sympy()
    terms = []
    for (letters, waves), number in total.terms.items():
        parts = [library.Rational(Fraction(number).numerator, Fraction(number).denominator)]
        parts += [library.Symbol(letter.name) ** power for letter, power in letters]
        parts += [_wave(library, one) ** power for one, power in waves]
        terms.append(library.Mul(*parts))
    return library.Add(*terms)


def _wave(library: Any, one: Wave) -> Any:
    angle = library.Add(*(count * library.Symbol(letter.name) for letter, count in one.parts))
    return library.sin(angle) if one.kind == "sin" else library.cos(angle)


def matrix(rows: Sequence[Sequence[Sum]]) -> Any:
    """Rows of sums as an immutable SymPy matrix."""
    return sympy().ImmutableMatrix([[expression(entry) for entry in row] for row in rows])
