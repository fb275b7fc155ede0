"""The recursions, in exact fractions: those of the paper, the general one, and that of the equations themselves."""

from __future__ import annotations

import math
from fractions import Fraction

from hypothesis import given, settings
from hypothesis import strategies as st

from centrode.cams.recursions import arc_series, exponential_series, general_series, system_series

TERMS = 12
# right-angled triangles: sine and cosine of the pressure angle as fractions
ANGLES = st.sampled_from([(0, 1, 1), (3, 4, 5), (-5, 12, 13), (8, 15, 17), (-20, 21, 29)])
NUMBERS = st.fractions(min_value=-3, max_value=3, max_denominator=12)
POSITIVE = st.fractions(min_value=Fraction(1, 4), max_value=4, max_denominator=12)


def product(a: list[Fraction], b: list[Fraction], n: int) -> Fraction:
    return sum((a[i] * b[n - i] for i in range(n + 1)), Fraction(0))


@settings(max_examples=40, deadline=None)
@given(ANGLES, POSITIVE, NUMBERS, POSITIVE)
def test_three_recursions_are_one_for_exponentials(
    angle: tuple[int, int, int], k0: Fraction, k1: Fraction, rho: Fraction
) -> None:
    sine, cosine = Fraction(angle[0], angle[2]), Fraction(angle[1], angle[2])
    curvature = [k0 * k1**n / math.factorial(n) for n in range(TERMS + 1)]
    slope = cosine - rho * k0
    paper = exponential_series(sine, slope, cosine, k1, TERMS)
    assert paper == general_series(sine, slope, cosine, curvature, TERMS)
    _radii, sines, cosines = system_series(rho, sine, cosine, curvature)
    assert paper == (sines[: TERMS + 1], cosines[:TERMS])


@settings(max_examples=40, deadline=None)
@given(ANGLES, POSITIVE, st.lists(NUMBERS, min_size=TERMS, max_size=TERMS), POSITIVE)
def test_the_general_recursion_is_that_of_the_equations(
    angle: tuple[int, int, int], k0: Fraction, more: list[Fraction], rho: Fraction
) -> None:
    sine, cosine = Fraction(angle[0], angle[2]), Fraction(angle[1], angle[2])
    curvature = [k0, *more]
    a, b = general_series(sine, cosine - rho * k0, cosine, curvature, TERMS)
    radii, sines, cosines = system_series(rho, sine, cosine, curvature)
    assert (a, b) == (sines[: TERMS + 1], cosines[:TERMS])
    for n in range(TERMS):
        # formula (15), eta^2 + lambda^2 = 1, and rho' lambda = rho eta, coefficient by coefficient
        assert product(radii, curvature, n) == b[n] - (n + 1) * a[n + 1]
        assert product(a, a, n) + product(b, b, n) == (1 if n == 0 else 0)
        slopes = [(k + 1) * radii[k + 1] for k in range(n + 1)]
        assert product(slopes, b, n) == product(radii, a, n)


@settings(max_examples=20, deadline=None)
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
