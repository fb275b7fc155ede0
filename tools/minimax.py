"""Derive the constants of the vector mathematics: minimax polynomials (Remez) and the parts of pi/2.

`python tools/minimax.py` writes src/centrode/numerics/machine_code/polynomials.py. Needs mpmath.

Each polynomial P(z), z = x^2, is what is left of a function beyond its first terms:
    sin x = x + x z P(z)             on |x| <= pi/4
    cos x = 1 - z/2 + z^2 P(z)       on |x| <= pi/4
    atan x = x + x z P(z)            on |x| <= 4/7
and has the least greatest error relative to the function itself. The exchange is that of Remez; see
Muller, Elementary Functions (3rd ed., 2016), section 3.5.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import mpmath as mp

Number = Any
TARGET = Path(__file__).parents[1] / "src" / "centrode" / "numerics" / "machine_code" / "polynomials.py"
DIGITS = 60
GRID = 40
"""Places looked at between two neighbouring extrema."""
ROUNDS = 12
SLOPE = 35 / 64
"""Steeper vectors are turned back by pi/4: their angles lie above 1/2, where the last place is coarse enough for the
roundings of turning. Of subnormal vectors some up to 4/7 are not turned, because the bound is rounded."""


class Problem(NamedTuple):
    """What is approximated: the rest beyond the first terms, and its share of the function."""

    name: str
    told: str
    rest: Callable[[Number], Number]
    share: Callable[[Number], Number]
    end: Number
    terms: int


def problems() -> list[Problem]:
    """The three functions, in the square z of their argument."""
    quarter = (mp.pi / 4) ** 2 * (1 + mp.mpf(2) ** -20)  # reduced arguments may lie beyond by rounding
    root = mp.sqrt
    return [
        Problem(
            "SINE", "sin x = x + x z P(z), |x| <= pi/4",
            lambda z: (mp.sin(root(z)) - root(z)) / (root(z) * z), lambda z: z * root(z) / mp.sin(root(z)),
            quarter, 6,
        ),
        Problem(
            "COSINE", "cos x = 1 - z/2 + z^2 P(z), |x| <= pi/4",
            lambda z: (mp.cos(root(z)) - 1 + z / 2) / z**2, lambda z: z**2 / mp.cos(root(z)),
            quarter, 6,
        ),
        Problem(
            "ARCTANGENT", "atan x = x + x z P(z), |x| <= 4/7",
            lambda z: (mp.atan(root(z)) - root(z)) / (root(z) * z), lambda z: z * root(z) / mp.atan(root(z)),
            (mp.mpf(4) / 7) ** 2, 13,
        ),
    ]  # fmt: skip


def polynomial(coefficients: Sequence[Number], z: Number) -> Number:
    """Value by Horner's rule; the constant term comes first."""
    return mp.polyval(list(reversed(coefficients)), z)


def minimax(problem: Problem) -> tuple[list[Number], Number]:
    """Coefficients with the least greatest error relative to the function, and that error."""
    n, start = problem.terms, problem.end / 10**4  # the error vanishes at zero
    nodes = [
        (start + problem.end) / 2 - (problem.end - start) / 2 * mp.cos(mp.pi * k / n) for k in range(n + 1)
    ]
    for _round in range(ROUNDS):
        coefficients, level = _levelled(problem, nodes)
        nodes, greatest = _extrema(problem, coefficients, nodes, start)
        if greatest <= abs(level) * (1 + mp.mpf(10) ** -6):
            break
    return coefficients, greatest


def _levelled(problem: Problem, nodes: Sequence[Number]) -> tuple[list[Number], Number]:
    """The polynomial whose weighted error is +-level in turn at the nodes."""
    n = problem.terms
    matrix, right = mp.matrix(n + 1, n + 1), mp.matrix(n + 1, 1)
    for i, z in enumerate(nodes):
        share = problem.share(z)
        for k in range(n):
            matrix[i, k] = share * z**k
        matrix[i, n] = (-1) ** i
        right[i] = share * problem.rest(z)
    solution = mp.lu_solve(matrix, right)
    return [solution[k] for k in range(n)], solution[n]


def _extrema(
    problem: Problem, coefficients: Sequence[Number], nodes: Sequence[Number], start: Number
) -> tuple[list[Number], Number]:
    """Places of the greatest error between the nodes, signs in turn."""

    def error(z: Number) -> Number:
        return problem.share(z) * (polynomial(coefficients, z) - problem.rest(z))

    places = [start, *nodes, problem.end]
    found = []
    for i, node in enumerate(nodes):
        low, high = (places[i] + node) / 2, (node + places[i + 2]) / 2
        low, high = (start if i == 0 else low), (problem.end if i == len(nodes) - 1 else high)
        sign = mp.sign(error(node)) or 1
        grid = [low + (high - low) * k / GRID for k in range(GRID + 1)]
        found.append(max(grid, key=lambda z, sign=sign: sign * error(z)))  # type: ignore[misc]
    return found, max(abs(error(z)) for z in found)


def parts_of_quarter_turn() -> tuple[list[float], list[float]]:
    """pi/2 in parts of 53 bits, and in parts of 33 bits with a last one of 53: products by 20 bits are exact."""
    whole, rest = [], mp.pi / 2
    for _part in range(3):
        whole.append(float(rest))
        rest -= mp.mpf(whole[-1])
    short, rest = [], mp.pi / 2
    for part in range(4):
        value = rest if part == 3 else mp.ldexp(mp.nint(mp.ldexp(rest, 32 + 34 * part)), -32 - 34 * part)
        short.append(float(value))
        rest -= mp.mpf(short[-1])
    return whole, short


def text() -> str:
    """The module as text."""
    lines = [
        '"""Constants of the vector mathematics, written by tools/minimax.py: coefficients of 1, z, z^2 ..."""', "",
        "from __future__ import annotations",
    ]  # fmt: skip
    for problem in problems():
        coefficients, error = minimax(problem)
        lines += ["", f"{problem.name} = (", *(f"    {float(c)!r}," for c in coefficients), ")"]
        lines.append(f'"""{problem.told}; relative error 2^{float(mp.log(error, 2)):.1f}."""')
    whole, short = parts_of_quarter_turn()
    for name, parts, told in (
        ("QUARTER_TURN", whole, "pi/2 in parts of 53 bits."),
        ("QUARTER_TURN_SHORT", short, "pi/2 in parts of 33 bits and one of 53."),
    ):
        lines += ["", f"{name} = (", *(f"    {part!r}," for part in parts), ")", f'"""{told}"""']
    lines += ["", f"SLOPE = {SLOPE!r}", '"""Steepest slope of vectors that are not turned back by pi/4."""']
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    mp.mp.dps = DIGITS
    TARGET.write_text(text(), encoding="utf-8")
