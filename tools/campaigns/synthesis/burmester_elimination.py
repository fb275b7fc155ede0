"""Dyads of five poses in 50 digits, by an elimination of its own.

With the moving point (u, v) and the centre (x, y) the four closures are rows of M(u, v) (x, y, 1) = 0, linear in u and
v. The determinants of rows 1, 2, 3 and of rows 1, 2, 4 are cubics; their resultant by v, as a polynomial in u, has the
common zeros of both and those where rows 1 and 2 alone are dependent, which the other two determinants reveal.
"""

from __future__ import annotations

from typing import Any

from mpmath import mp, mpc, mpf

DIGITS = 50


def real_dyads(places: list[list[float]], angles: list[float]) -> list[tuple[complex, complex]]:
    """All real pairs (moving point in the first pose, centre)."""
    with mp.workdps(DIGITS):
        rows = _rows(places, angles)
        found: list[tuple[Any, Any]] = []
        for u, v in _common_zeros(rows):
            if abs(mp.im(u)) > mpf(10) ** -15 * (1 + abs(u)) or abs(mp.im(v)) > mpf(10) ** -15 * (1 + abs(v)):
                continue
            u, v = mp.re(u), mp.re(v)
            matrix = [[row[0][k] + u * row[1][k] + v * row[2][k] for k in range(3)] for row in rows]
            best = None
            for i in range(4):
                for j in range(i):
                    det = matrix[i][0] * matrix[j][1] - matrix[i][1] * matrix[j][0]
                    # two rows that depend on each other, as at a pole of two poses, give no centre
                    if abs(det) > (0 if best is None else abs(best[0])):
                        x = (-matrix[i][2] * matrix[j][1] + matrix[i][1] * matrix[j][2]) / det
                        y = (-matrix[i][0] * matrix[j][2] + matrix[i][2] * matrix[j][0]) / det
                        best = (det, x, y)
            if best is None:
                continue
            _det, x, y = best
            misses = [abs(row[0] * x + row[1] * y + row[2]) for row in matrix]
            if max(misses) < mpf(10) ** -18 * (1 + abs(u) + abs(v)) * (1 + abs(x) + abs(y)):
                found.append((complex(u, v), complex(x, y)))
        return found


def _rows(places: list[list[float]], angles: list[float]) -> list[list[list[Any]]]:
    first = mpc(*places[0])
    rows = []
    for (x, y), angle in zip(places[1:], angles[1:], strict=True):
        turn = mp.expj(mpf(angle) - mpf(angles[0]))
        shift = mpc(x, y) - turn * first

        def row(w: Any, turn: Any = turn, shift: Any = shift) -> list[Any]:
            image = turn * w + shift - w
            return [-mp.re(image), -mp.im(image), abs(shift) ** 2 / 2 + mp.re(mp.conj(shift) * turn * w)]

        base = row(mpc(0))
        rows.append(
            [
                base,
                [a - b for a, b in zip(row(mpc(1)), base, strict=True)],
                [a - b for a, b in zip(row(mpc(0, 1)), base, strict=True)],
            ]
        )
    return rows


def _determinant_in_v(rows: list[Any], u: Any) -> list[Any]:
    """Coefficients of 1, v, v^2, v^3 of a determinant of three rows at a value of u."""
    entries = [[[row[0][k] + u * row[1][k], row[2][k]] for k in range(3)] for row in rows]
    total = [mpf(0)] * 4
    for (i, j, k), sign in (
        ((0, 1, 2), 1), ((1, 2, 0), 1), ((2, 0, 1), 1), ((0, 2, 1), -1), ((2, 1, 0), -1), ((1, 0, 2), -1),
    ):  # fmt: skip
        product = [mpf(sign)]
        for row, column in enumerate((i, j, k)):
            constant, linear = entries[row][column]
            grown = [mpf(0)] * (len(product) + 1)
            for power, value in enumerate(product):
                grown[power] += value * constant
                grown[power + 1] += value * linear
            product = grown
        total = [a + b for a, b in zip(total, product, strict=True)]
    return total


def _resultant(one: list[Any], other: list[Any]) -> Any:
    """Sylvester's determinant of two cubics."""
    matrix = mp.matrix(6)
    for shift in range(3):
        for power in range(4):
            matrix[shift, shift + 3 - power] = one[power]
            matrix[3 + shift, shift + 3 - power] = other[power]
    return mp.det(matrix)


def _common_zeros(rows: list[Any]) -> list[tuple[Any, Any]]:
    count = 10
    circle = [mp.expj(2 * mp.pi * k / count) for k in range(count)]
    first, second = [rows[0], rows[1], rows[2]], [rows[0], rows[1], rows[3]]
    values = [_resultant(_determinant_in_v(first, z), _determinant_in_v(second, z)) for z in circle]
    coefficients = [
        sum(value * z ** (-power) for value, z in zip(values, circle, strict=True)) / count
        for power in range(count)
    ]
    largest = max(abs(c) for c in coefficients)
    while abs(coefficients[-1]) < largest * mpf(10) ** -30:
        coefficients.pop()
    roots = mp.polyroots(coefficients[::-1], maxsteps=500, extraprec=400)
    found = []
    for u in roots:
        cubic = _determinant_in_v(first, u)
        while len(cubic) > 1 and abs(cubic[-1]) < max(map(abs, cubic)) * mpf(10) ** -30:
            cubic.pop()
        other = _determinant_in_v(second, u)
        for v in mp.polyroots(cubic[::-1], maxsteps=500, extraprec=400):
            miss = abs(sum(c * v**power for power, c in enumerate(other)))
            size = sum(abs(c) * abs(v) ** power for power, c in enumerate(other))
            if miss < mpf(10) ** -16 * size:
                found.append((u, v))
    return found
