"""Whether a step of Newton's method on a group of higher class stays on the group's own curve, and that is regular.

Between two places the matrix A changes by D (after a short step as much more as goes into a long one). Where
E = A^-1 D has no eigenvalue as great as one, for which |E E| tells, no matrix on the way A + t D is singular
(Banach's lemma; Golub and Van Loan, Matrix Computations, 4th ed., 2013, section 2.3.4). So the curve runs on over
the drive's value without a limit or a change point; and the place found is on it where Newton's steps shrink at once.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.kinematics.compiled.newton.matrices import Matrix
from centrode.kinematics.compiled.newton.postures import Names
from centrode.kinematics.compiled.newton.small_systems import dot, multiplied, plus, sizes, times, total
from centrode.kinematics.compiled.variables import FIRST, SHARE

CHANGE = 0.4
"""Greatest change of a matrix from one place to the next, in itself: 0.4 of what could make it singular."""
CONDITION = 1e-3
"""Part of its own numbers that counts as changed in any case: where the condition is above 400 nothing is certain."""
FARTHEST = 0.3
"""Greatest change of a free coordinate from one place to the next, in rad or in the greatest length."""
WRONG = 0.01
"""By how much a foretold place may be wrong, likewise."""
SHRINKING, FAINT = 0.1, 1e-9
"""What part of a step the next one with the same matrix may be, and a step below which nothing is asked."""
LAST = 1e-9
"""Greatest last step: by the square of it, but for rounding, a place is wrong, and so are its derivatives."""

m = EXPRESSIONS


def slack_of(
    names: Names, matrix: Matrix, ahead: Sequence[Operand], steps: Sequence[Sequence[Operand]]
) -> Node:
    """Positive where a step is certain: the least of what is left of all that is allowed.

    `ahead` is how far the place before is, `steps` are Newton's: with a matrix of their own, with the same, and with
    that of the place found, which is `matrix`.
    """
    one, two, three = (_greatest(step) for step in steps)
    parts = [
        (CHANGE - _changed(names, matrix)) * (1.0 / CHANGE),
        (FARTHEST - _greatest(ahead)) * (1.0 / FARTHEST),
        (WRONG - one) * (1.0 / WRONG),
        (SHRINKING * one + FAINT - two) * (1.0 / WRONG),
        (LAST - three) * (1.0 / LAST),
    ]
    return as_node(functools.reduce(m.min, parts))


def _changed(names: Names, matrix: Matrix) -> Operand:
    """By how much the matrix has changed since the place before, in itself."""
    change: list[list[Operand]] = [[0.0] * len(matrix.core) for _row in matrix.core]
    for (i, j), x in matrix.changing:
        change[i][j] = x - variable(names.of_matrix(i, j))
    moved = multiplied(matrix.inverse, change)
    twice = [total(row) for row in sizes(multiplied(moved, moved))]
    # where all numbers of a row are small its equation is no better known than its terms
    own = [plus(total(row), size) for row, size in zip(sizes(matrix.core), matrix.terms, strict=True)]
    condition = [dot(row, own) for row in sizes(matrix.inverse)]
    # as if the step were the longest: so it does not matter which samples are asked for; none before the first
    share = m.where(m.equal(variable(FIRST), 1.0), 0.0, variable(SHARE))
    return plus(times(share, m.sqrt(_greatest(twice))), times(CONDITION, _greatest(condition)))


def _greatest(values: Sequence[Operand]) -> Operand:
    """The greatest size; NaN where one is."""
    return functools.reduce(m.max, [m.abs(x) for x in values])
