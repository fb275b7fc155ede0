"""Cognates: the two other four-bar linkages that draw the same coupler curve.

S. Roberts, Proc. London Math. Soc. 7, 1875. With k = p/b, the place of the coupler point as a complex number in units
of the coupler, the third fixed hinge is E = O + k (D - O). One cognate hangs between O and E, the other between D and
E; each has a coupler triangle similar to the first.
"""

from __future__ import annotations

import numpy as np

from centrode.synthesis.four_bars import COUPLER, CRANK, DX, DY, OX, OY, PX, PY, ROCKER, Array


def cognates(linkage: Array, side: float, crank: float) -> list[tuple[Array, float, float]]:
    """Both cognates of one linkage: dimensions (9,), side, and the angle of their crank.

    Parameters
    ----------
    linkage : (9,) in the order of `DIMENSIONS`
    side : of B from the line AD
    crank : angle of the linkage's crank [rad], at which it closes
    """
    fixed = complex(linkage[OX], linkage[OY])
    other = complex(linkage[DX], linkage[DY])
    a, b, c = (float(linkage[k]) for k in (CRANK, COUPLER, ROCKER))
    shape = complex(linkage[PX], linkage[PY]) / b
    if abs(shape) < 1e-9 or abs(1 - shape) < 1e-9:
        return []
    first = fixed + a * np.exp(1j * crank)
    line = other - first
    along = (abs(line) ** 2 + b * b - c * c) / (2 * abs(line) ** 2)
    height = np.sqrt(max(b * b / abs(line) ** 2 - along**2, 0.0))
    second = first + line * (along + 1j * side * height)
    point = first + shape * (second - first)
    third = fixed + shape * (other - fixed)
    # Both begin with a parallelogram: O A P A1 and D B P B2. The links of the first turn as the coupler and the rocker
    # of the linkage, those of the second as its crank and its coupler: with a crank it has one too, at E.
    left = fixed + point - first
    right = other + point - second
    return [
        _four_bar(fixed, third, left, left + shape * (first - fixed), point),
        _four_bar(third, other, right + (1 - shape) * (second - other), right, point),
    ]


def _four_bar(
    fixed: complex, other: complex, first: complex, second: complex, point: complex
) -> tuple[Array, float, float]:
    """Dimensions, side and crank angle of the linkage that stands with its hinges at given places."""
    coupler = second - first
    local = (point - first) / coupler * abs(coupler)
    row = np.array(
        [
            fixed.real, fixed.imag, other.real, other.imag, abs(first - fixed), abs(coupler),
            abs(second - other), local.real, local.imag,
        ]
    )  # fmt: skip
    turn = ((other - first).conjugate() * (second - first)).imag
    return row, 1.0 if turn >= 0 else -1.0, float(np.angle(first - fixed))
