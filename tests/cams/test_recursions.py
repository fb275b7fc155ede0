"""The recursions, in exact fractions: those of the paper, equation (23), and that of the equations themselves."""

from __future__ import annotations

import math
from fractions import Fraction

from hypothesis import given, settings
from hypothesis import strategies as st

from centrode.cams.roller_path import arc_series, exponential_series, next_cosine, system_series
from samples import few

TERMS = 12
# right-angled triangles: sine and cosine of the pressure angle as fractions
ANGLES = st.sampled_from([(0, 1, 1), (3, 4, 5), (-5, 12, 13), (8, 15, 17), (-20, 21, 29)])
NUMBERS = st.fractions(min_value=-3, max_value=3, max_denominator=12)
POSITIVE = st.fractions(min_value=Fraction(1, 4), max_value=4, max_denominator=12)


def product(a: list[Fraction], b: list[Fraction], n: int) -> Fraction:
    return sum((a[i] * b[n - i] for i in range(n + 1)), Fraction(0))


def by_equation_23(
    a_0: Fraction, a_1: Fraction, b_0: Fraction, curvature: list[Fraction], terms: int
) -> tuple[list[Fraction], list[Fraction]]:
    """Equation (23) of the paper, coefficient by coefficient: right in fractions, but it divides by K.

    In numbers the rounding grows like 1/R^n, R the distance of the nearest zero of K, real or complex.
    """
    a, b, k = [a_0, a_1], [b_0], curvature
    for n in range(terms - 1):
        total: Fraction = Fraction(0)
        for i in range(n + 1):
            total = total + (i + 1) * k[i + 1] * ((n - i + 1) * a[n - i + 1] - b[n - i])
            total = total - k[i] * a[n - i]
            if i:
                total = total - k[i] * ((n - i + 2) * (n - i + 1)) * a[n - i + 2]
        a.append(total / (k[0] * ((n + 2) * (n + 1))))
        b.append(next_cosine(a, b))
    return a, b


@settings(max_examples=few(15, 40), deadline=None)
@given(ANGLES, POSITIVE, NUMBERS, POSITIVE)
def test_three_recursions_are_one_for_exponentials(
    angle: tuple[int, int, int], k0: Fraction, k1: Fraction, rho: Fraction
) -> None:
    sine, cosine = Fraction(angle[0], angle[2]), Fraction(angle[1], angle[2])
    curvature = [k0 * k1**n / math.factorial(n) for n in range(TERMS + 1)]
    slope = cosine - rho * k0
    paper = exponential_series(sine, slope, cosine, k1, TERMS)
    assert paper == by_equation_23(sine, slope, cosine, curvature, TERMS)
    _radii, sines, cosines = system_series(rho, sine, cosine, curvature)
    assert paper == (sines[: TERMS + 1], cosines[:TERMS])


@settings(max_examples=few(15, 40), deadline=None)
@given(ANGLES, POSITIVE, st.lists(NUMBERS, min_size=TERMS, max_size=TERMS), POSITIVE)
def test_the_general_recursion_is_that_of_the_equations(
    angle: tuple[int, int, int], k0: Fraction, more: list[Fraction], rho: Fraction
) -> None:
    sine, cosine = Fraction(angle[0], angle[2]), Fraction(angle[1], angle[2])
    curvature = [k0, *more]
    a, b = by_equation_23(sine, cosine - rho * k0, cosine, curvature, TERMS)
    radii, sines, cosines = system_series(rho, sine, cosine, curvature)
    assert (a, b) == (sines[: TERMS + 1], cosines[:TERMS])
    for n in range(TERMS):
        # formula (15), eta^2 + lambda^2 = 1, and rho' lambda = rho eta, coefficient by coefficient
        assert product(radii, curvature, n) == b[n] - (n + 1) * a[n + 1]
        assert product(a, a, n) + product(b, b, n) == (1 if n == 0 else 0)
        slopes = [(k + 1) * radii[k + 1] for k in range(n + 1)]
        assert product(slopes, b, n) == product(radii, a, n)


@settings(max_examples=few(10, 20), deadline=None)
@given(ANGLES, POSITIVE, POSITIVE)
def test_along_the_arc_a_constant_curvature_draws_a_circle(
    angle: tuple[int, int, int], k0: Fraction, rho: Fraction
) -> None:
    """Of a circle about c the squared distance from the origin is |c|^2 + R^2 + 2 R |c| cos(arc/R + constant)."""
    sine, cosine = Fraction(angle[0], angle[2]), Fraction(angle[1], angle[2])

    def curvature(angles: list[Fraction]) -> list[Fraction]:
        return [k0] + [Fraction(0)] * (len(angles) - 1)

    _angles, radii, _sines, _cosines = arc_series(Fraction(0), rho, sine, cosine, curvature, TERMS)
    square = [product(radii, radii, n) for n in range(TERMS + 1)]
    for n in range(3, TERMS + 1):  # its third derivative is -1/R^2 times its first
        assert n * (n - 1) * (n - 2) * square[n] == -(k0**2) * (n - 2) * square[n - 2]
