"""Products of sines and cosines taken together: sin a cos b - cos a sin b = sin(a - b), and the like.

The determinants and numerators of planar linkages are sums of such pairs, so taking pairs together, nothing else,
brings them to the form of the textbooks.
"""

from __future__ import annotations

from collections.abc import Iterator

from centrode.equations.letters import Angle, Wave
from centrode.equations.sums import Coefficient, Sum, Term


def merged(total: Sum) -> Sum:
    """The sum with every pair of terms taken together that makes one wave of two."""
    terms = dict(total.terms)
    waiting = sorted(terms, key=_order, reverse=True)
    while waiting:
        term = waiting.pop()
        number = terms.get(term)
        found = None if number is None else _pair(term, number, terms)
        if found is None:
            continue
        partner, together = found
        del terms[term], terms[partner]
        for new, value in together.terms.items():
            terms[new] = terms.get(new, 0) + value
            if not terms[new]:
                del terms[new]
            waiting.append(new)
        # a pair that was looked at before may have a partner now
        waiting += [one for one in terms if one not in waiting] if together.terms else []
    return Sum(terms)


def _order(term: Term) -> tuple[int, Term]:
    return sum(abs(power) for _wave, power in term.waves), term


def _pair(term: Term, number: Coefficient, terms: dict[Term, Coefficient]) -> tuple[Term, Sum] | None:
    """Another term with which this one makes a single one, and that one."""
    for one, other in _pairs(term):
        rest = term.times(_product(one, other), -1)
        partner = rest.times(_product(one.partner, other.partner))
        value = terms.get(partner)
        if value is None or abs(value) != abs(number) or partner == term:
            continue
        together = _together(one, other, value == number)
        return partner, Sum({rest: number}) * together
    return None


def _together(one: Wave, other: Wave, same: bool) -> Sum:
    """Two waves times each other, plus or minus the product of their partners, as a single wave."""
    a, b = Angle(one.parts), Angle(other.parts)
    if one.kind == other.kind:  # cos a cos b + sin a sin b, or sin a sin b + cos a cos b
        if same:
            return Sum.wave("cos", a.plus(b, -1))
        return Sum.wave("cos", a.plus(b)).scaled(1 if one.kind == "cos" else -1)
    if same:
        return Sum.wave("sin", a.plus(b))
    return Sum.wave("sin", a.plus(b, -1)).scaled(1 if one.kind == "sin" else -1)


def _pairs(term: Term) -> Iterator[tuple[Wave, Wave]]:
    """Pairs of waves in a product; a squared wave is a pair with itself."""
    present = [(one, power) for one, power in term.waves if power > 0]
    for i, (one, power) in enumerate(present):
        if power > 1:
            yield one, one
        for other, _power in present[i + 1 :]:
            yield one, other


def _product(one: Wave, other: Wave) -> Term:
    return Term((), ((one, 1),)).times(Term((), ((other, 1),)))
