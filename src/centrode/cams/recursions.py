"""Taylor coefficients of a roller path from its differential equations, over any algebra with `+ - * /`.

With eta = sin(gamma) and lambda = cos(gamma), gamma the pressure angle, the path of curvature K obeys
`eta' = lambda - rho K`, `rho' lambda = rho eta`, `lambda lambda' = -eta eta'`. Equation numbers are those of
A. T. Skoibeda, V. N. Zhukovets, Solution of an autonomous nonlinear differential equation of second order in the
construction of plane curves (in Russian).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Number = Any
Series = list[Number]


def system_series(
    rho: Number, eta: Number, cosine: Number, curvature: Sequence[Number]
) -> tuple[Series, Series, Series]:
    """Coefficients of rho, eta and lambda about a place, from their values and the coefficients of K there.

    Neither K nor its slope is divided by: the zeros of K do not spoil them. One order more than K has, work of the
    order squared.
    """
    radii, sines, cosines = [rho], [eta], [cosine]
    for n in range(len(curvature)):
        bent: Number = 0
        climb: Number = 0
        for i in range(n + 1):
            bent = bent + radii[i] * curvature[n - i]
            climb = climb + radii[i] * sines[n - i]
        for i in range(1, n + 1):
            climb = climb - (n + 1 - i) * cosines[i] * radii[n + 1 - i]
        sines.append((cosines[n] - bent) / (n + 1))
        radii.append(climb / ((n + 1) * cosine))
        cosines.append(next_cosine(sines, cosines))
    return radii, sines, cosines


def next_cosine(a: Sequence[Number], b: Sequence[Number]) -> Number:
    """b_(m+1) from a_0 ... a_(m+1) and b_0 ... b_m: formulas (24) for even m and (25) for odd m."""
    m = len(b) - 1
    total: Number = 0
    if m % 2 == 0:
        for i in range(m // 2 + 1):
            total = total - a[i] * a[m + 1 - i]
        for i in range(1, m // 2 + 1):
            total = total - b[i] * b[m + 1 - i]
        return total / b[0]
    for i in range((m - 1) // 2 + 1):
        total = total - a[i] * a[m + 1 - i]
    for i in range(1, (m - 1) // 2 + 1):
        total = total - b[i] * b[m + 1 - i]
    half = (m - 1) // 2 + 1
    return (2 * total - a[half] * a[half] - b[half] * b[half]) / (2 * b[0])


def exponential_series(
    a_0: Number, a_1: Number, b_0: Number, rate: Number, terms: int
) -> tuple[Series, Series]:
    """a_0 ... a_terms and b_0 ... b_(terms-1) of eta and lambda for K = k0 exp(k1 phi): (24), (25) and (34)."""
    a, b = [a_0, a_1], [b_0]
    for m in range(terms - 1):
        a.append((rate * ((m + 1) * a[m + 1] - b[m]) - a[m]) / ((m + 2) * (m + 1)))
        b.append(next_cosine(a, b))
    return a, b


def arc_series(
    phi: Number, rho: Number, eta: Number, cosine: Number, curvature: Any, order: int
) -> tuple[Series, Series, Series, Series]:
    """Coefficients of phi, rho, eta and lambda by the arc s of the path: regular where lambda is zero.

    `phi' = lambda / rho`, `rho' = eta`, `eta' = lambda w`, `lambda' = -eta w` with `w = phi' - K(phi(s))`;
    `curvature(coefficients of phi)` gives those of K, as many as it gets.
    """
    angles, radii, sines, cosines = [phi], [rho], [eta], [cosine]
    turning: Series = []
    rates: Series = []
    for n in range(order):
        rate = cosines[n]
        for i in range(n):
            rate = rate - rates[i] * radii[n - i]
        rates.append(rate / rho)
        turning.append(rates[n] - curvature(angles)[n])
        angles.append(rates[n] / (n + 1))
        radii.append(sines[n] / (n + 1))
        up: Number = 0
        down: Number = 0
        for i in range(n + 1):
            up = up + cosines[i] * turning[n - i]
            down = down - sines[i] * turning[n - i]
        sines.append(up / (n + 1))
        cosines.append(down / (n + 1))
    return angles, radii, sines, cosines
