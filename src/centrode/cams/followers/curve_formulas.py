"""Curves of a rise as textbooks write them, in letters and as functions, so that the formulas can be proved.

A rise of h over the angle beta begins at the lift s_0 and the angle phi_0; u = (phi - phi_0) / beta. Formulas of
R. L. Norton, Cam Design and Manufacturing Handbook, 2009, chapters 2 and 3.
"""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
sin, cos = np.sin, np.cos


class Rule(NamedTuple):
    """One formula of a curve.

    Attributes
    ----------
    upto : float
        Share of the angle at which it ends, and `mark` the same as mathematics.
    spelled : (s - s_0, s', s'') as mathematics of u, h and beta
    shares : the same of u (n) in parts of h, h/beta, h/beta^2
    """

    upto: float
    mark: str
    spelled: tuple[str, str, str]
    shares: Callable[[Array], tuple[Array, Array, Array]]


def _polynomial(*powers: tuple[int, int]) -> Rule:
    """A polynomial of u by its coefficients and exponents."""
    rows = [list(powers)]
    for _order in range(2):
        rows.append([(c * k, k - 1) for c, k in rows[-1] if k])
    fronts = ("h", "frac(h, beta)", "frac(h, beta^2)")
    texts = tuple(f"{front} ({_powers(row)})" for front, row in zip(fronts, rows, strict=True))

    def shares(u: Array) -> tuple[Array, Array, Array]:
        first, second, third = (np.sum([c * u**k for c, k in row], axis=0) for row in rows)
        return first, second, third

    return Rule(1.0, "1", (texts[0], texts[1], texts[2]), shares)


def _powers(row: list[tuple[int, int]]) -> str:
    text = ""
    for c, k in row:
        sign = ("- " if c < 0 else "+ ") if text else ("-" if c < 0 else "")
        text += f"{' ' if text else ''}{sign}{abs(c)} u{f'^{k}' if k > 1 else ''}"
    return text


_S, _T = 1.0 / (4.0 + pi), 1.0 / (2.0 + pi)
_SINE, _TRAPEZOID = "frac(h, 4 + pi)", "frac(h, 2 + pi)"

CURVES: dict[str, tuple[Rule, ...]] = {
    "uniform": (
        Rule(1.0, "1", ("h u", "frac(h, beta)", "0"), lambda u: (u, np.ones_like(u), np.zeros_like(u))),
    ),
    "parabolic": (
        Rule(
            1 / 2, "1/2",
            ("2 h u^2", "frac(4 h, beta) u", "frac(4 h, beta^2)"),
            lambda u: (2 * u**2, 4 * u, 4 * np.ones_like(u)),
        ),
        Rule(
            1.0, "1",
            ("h (1 - 2 (1 - u)^2)", "frac(4 h, beta) (1 - u)", "-frac(4 h, beta^2)"),
            lambda u: (1 - 2 * (1 - u) ** 2, 4 * (1 - u), -4 * np.ones_like(u)),
        ),
    ),
    "harmonic": (
        Rule(
            1.0, "1",
            (
                "frac(h, 2) (1 - cos (pi u))",
                "frac(pi h, 2 beta) sin (pi u)",
                "frac(pi^2 h, 2 beta^2) cos (pi u)",
            ),
            lambda u: (0.5 * (1 - cos(pi * u)), 0.5 * pi * sin(pi * u), 0.5 * pi**2 * cos(pi * u)),
        ),
    ),
    "cycloidal": (
        Rule(
            1.0, "1",
            (
                "h (u - frac(1, 2 pi) sin (2 pi u))",
                "frac(h, beta) (1 - cos (2 pi u))",
                "frac(2 pi h, beta^2) sin (2 pi u)",
            ),
            lambda u: (u - sin(2 * pi * u) / (2 * pi), 1 - cos(2 * pi * u), 2 * pi * sin(2 * pi * u)),
        ),
    ),
    "3-4-5": (_polynomial((10, 3), (-15, 4), (6, 5)),),
    "4-5-6-7": (_polynomial((35, 4), (-84, 5), (70, 6), (-20, 7)),),
    "trapezoid": (
        Rule(
            1 / 8, "1/8",
            ("frac(64 h, 9) u^3", "frac(64 h, 3 beta) u^2", "frac(128 h, 3 beta^2) u"),
            lambda u: (64 / 9 * u**3, 64 / 3 * u**2, 128 / 3 * u),
        ),
        Rule(
            3 / 8, "3/8",
            (
                "h (frac(1, 72) + frac(1, 3) (u - frac(1, 8)) + frac(8, 3) (u - frac(1, 8))^2)",
                "frac(h, 3 beta) (1 + 16 (u - frac(1, 8)))",
                "frac(16 h, 3 beta^2)",
            ),
            lambda u: (
                1 / 72 + (u - 1 / 8) / 3 + 8 / 3 * (u - 1 / 8) ** 2,
                (1 + 16 * (u - 1 / 8)) / 3,
                16 / 3 * np.ones_like(u),
            ),
        ),
        Rule(
            5 / 8, "5/8",
            (
                "h (2 u - frac(1, 2) - frac(64, 9) (u - frac(1, 2))^3)",
                "frac(h, beta) (2 - frac(64, 3) (u - frac(1, 2))^2)",
                "-frac(128 h, 3 beta^2) (u - frac(1, 2))",
            ),
            lambda u: (
                2 * u - 1 / 2 - 64 / 9 * (u - 1 / 2) ** 3,
                2 - 64 / 3 * (u - 1 / 2) ** 2,
                -128 / 3 * (u - 1 / 2),
            ),
        ),
        Rule(
            7 / 8, "7/8",
            (
                "h (frac(71, 72) - frac(1, 3) (frac(7, 8) - u) - frac(8, 3) (frac(7, 8) - u)^2)",
                "frac(h, 3 beta) (1 + 16 (frac(7, 8) - u))",
                "-frac(16 h, 3 beta^2)",
            ),
            lambda u: (
                71 / 72 - (7 / 8 - u) / 3 - 8 / 3 * (7 / 8 - u) ** 2,
                (1 + 16 * (7 / 8 - u)) / 3,
                -16 / 3 * np.ones_like(u),
            ),
        ),
        Rule(
            1.0, "1",
            ("h (1 - frac(64, 9) (1 - u)^3)", "frac(64 h, 3 beta) (1 - u)^2", "-frac(128 h, 3 beta^2) (1 - u)"),
            lambda u: (1 - 64 / 9 * (1 - u) ** 3, 64 / 3 * (1 - u) ** 2, -128 / 3 * (1 - u)),
        ),
    ),
    "modified sine": (
        Rule(
            1 / 8, "1/8",
            (
                f"{_SINE} (pi u - frac(1, 4) sin (4 pi u))",
                "frac(pi h, (4 + pi) beta) (1 - cos (4 pi u))",
                "frac(4 pi^2 h, (4 + pi) beta^2) sin (4 pi u)",
            ),
            lambda u: (
                _S * (pi * u - sin(4 * pi * u) / 4),
                pi * _S * (1 - cos(4 * pi * u)),
                4 * pi**2 * _S * sin(4 * pi * u),
            ),
        ),
        Rule(
            7 / 8, "7/8",
            (
                f"{_SINE} (2 + pi u - frac(9, 4) sin (frac(4 pi u + pi, 3)))",
                "frac(pi h, (4 + pi) beta) (1 - 3 cos (frac(4 pi u + pi, 3)))",
                "frac(4 pi^2 h, (4 + pi) beta^2) sin (frac(4 pi u + pi, 3))",
            ),
            lambda u: (
                _S * (2 + pi * u - 9 / 4 * sin((4 * pi * u + pi) / 3)),
                pi * _S * (1 - 3 * cos((4 * pi * u + pi) / 3)),
                4 * pi**2 * _S * sin((4 * pi * u + pi) / 3),
            ),
        ),
        Rule(
            1.0, "1",
            (
                f"{_SINE} (4 + pi u - frac(1, 4) sin (4 pi u))",
                "frac(pi h, (4 + pi) beta) (1 - cos (4 pi u))",
                "frac(4 pi^2 h, (4 + pi) beta^2) sin (4 pi u)",
            ),
            lambda u: (
                _S * (4 + pi * u - sin(4 * pi * u) / 4),
                pi * _S * (1 - cos(4 * pi * u)),
                4 * pi**2 * _S * sin(4 * pi * u),
            ),
        ),
    ),
    "modified trapezoid": (
        Rule(
            1 / 8, "1/8",
            (
                f"{_TRAPEZOID} (2 u - frac(1, 2 pi) sin (4 pi u))",
                "frac(2 h, (2 + pi) beta) (1 - cos (4 pi u))",
                "frac(8 pi h, (2 + pi) beta^2) sin (4 pi u)",
            ),
            lambda u: (
                _T * (2 * u - sin(4 * pi * u) / (2 * pi)),
                2 * _T * (1 - cos(4 * pi * u)),
                8 * pi * _T * sin(4 * pi * u),
            ),
        ),
        Rule(
            3 / 8, "3/8",
            (
                f"{_TRAPEZOID} (frac(1, 4) - frac(1, 2 pi) + 2 (u - frac(1, 8)) + 4 pi (u - frac(1, 8))^2)",
                "frac(2 h, (2 + pi) beta) (1 + 4 pi (u - frac(1, 8)))",
                "frac(8 pi h, (2 + pi) beta^2)",
            ),
            lambda u: (
                _T * (1 / 4 - 1 / (2 * pi) + 2 * (u - 1 / 8) + 4 * pi * (u - 1 / 8) ** 2),
                2 * _T * (1 + 4 * pi * (u - 1 / 8)),
                8 * pi * _T * np.ones_like(u),
            ),
        ),
        Rule(
            5 / 8, "5/8",
            (
                f"{_TRAPEZOID} (2 (1 + pi) u - frac(pi, 2) + frac(1, 2 pi) sin (4 pi u))",
                "frac(2 h, (2 + pi) beta) (1 + pi + cos (4 pi u))",
                "-frac(8 pi h, (2 + pi) beta^2) sin (4 pi u)",
            ),
            lambda u: (
                _T * (2 * (1 + pi) * u - pi / 2 + sin(4 * pi * u) / (2 * pi)),
                2 * _T * (1 + pi + cos(4 * pi * u)),
                -8 * pi * _T * sin(4 * pi * u),
            ),
        ),
        Rule(
            7 / 8, "7/8",
            (
                f"{_TRAPEZOID} (frac(7, 4) + pi + frac(1, 2 pi) - 2 (frac(7, 8) - u)"
                " - 4 pi (frac(7, 8) - u)^2)",
                "frac(2 h, (2 + pi) beta) (1 + 4 pi (frac(7, 8) - u))",
                "-frac(8 pi h, (2 + pi) beta^2)",
            ),
            lambda u: (
                _T * (7 / 4 + pi + 1 / (2 * pi) - 2 * (7 / 8 - u) - 4 * pi * (7 / 8 - u) ** 2),
                2 * _T * (1 + 4 * pi * (7 / 8 - u)),
                -8 * pi * _T * np.ones_like(u),
            ),
        ),
        Rule(
            1.0, "1",
            (
                f"{_TRAPEZOID} (pi + 2 u - frac(1, 2 pi) sin (4 pi u))",
                "frac(2 h, (2 + pi) beta) (1 - cos (4 pi u))",
                "frac(8 pi h, (2 + pi) beta^2) sin (4 pi u)",
            ),
            lambda u: (
                _T * (pi + 2 * u - sin(4 * pi * u) / (2 * pi)),
                2 * _T * (1 - cos(4 * pi * u)),
                8 * pi * _T * sin(4 * pi * u),
            ),
        ),
    ),
}  # fmt: skip
"""Formulas of each curve, one after the other."""

PEAKS: dict[str, tuple[tuple[str, str, str], tuple[float, float, float]]] = {
    "uniform": (("1", "0", "0"), (1.0, 0.0, 0.0)),
    "parabolic": (("2", "4", "0"), (2.0, 4.0, 0.0)),
    "harmonic": (("frac(pi, 2)", "frac(pi^2, 2)", "frac(pi^3, 2)"), (pi / 2, pi**2 / 2, pi**3 / 2)),
    "cycloidal": (("2", "2 pi", "4 pi^2"), (2.0, 2 * pi, 4 * pi**2)),
    "3-4-5": (("frac(15, 8)", "frac(10, sqrt(3))", "60"), (15 / 8, 10 / 3**0.5, 60.0)),
    "4-5-6-7": (("frac(35, 16)", "frac(84 sqrt(5), 25)", "frac(105, 2)"), (35 / 16, 84 * 5**0.5 / 25, 52.5)),
    "trapezoid": (("2", "frac(16, 3)", "frac(128, 3)"), (2.0, 16 / 3, 128 / 3)),
    "modified sine": (
        ("frac(4 pi, 4 + pi)", "frac(4 pi^2, 4 + pi)", "frac(16 pi^3, 4 + pi)"),
        (4 * pi * _S, 4 * pi**2 * _S, 16 * pi**3 * _S),
    ),
    "modified trapezoid": (
        ("2", "frac(8 pi, 2 + pi)", "frac(32 pi^2, 2 + pi)"),
        (2.0, 8 * pi * _T, 32 * pi**2 * _T),
    ),
}
"""Greatest velocity, acceleration and jerk in parts of h/beta, h/beta^2, h/beta^3: as mathematics, and as numbers."""


def shares_of(curve: str, u: Array) -> Array:
    """(s - s_0)/h, s' beta/h, s'' beta^2/h (3, n) of a curve at shares u (n) of its angle."""
    rules = CURVES[curve]
    found = np.array([rule.shares(u) for rule in rules])
    row = np.searchsorted([rule.upto for rule in rules[:-1]], u, side="right")
    return np.asarray(found[row, :, np.arange(len(u))].T)
