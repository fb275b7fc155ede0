"""One step of Newton's method on a group of higher class as expressions: from one place of the path to the next.

What is handed on are the free coordinates with their first two derivatives, which foretell the next place. There
one step with a matrix of its own, one more with the same, and one with a matrix of the place found come down to
rounding; the last matrix gives the derivatives as well. `certainty` tells where that can be relied upon.
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.geometry.plane import Vector, dot, is_literal_zero, rotate_vector
from centrode.kinematics.higher_class.system import LinkChain, Posture, needed_positions, plain, truncate_jet
from centrode.kinematics.machine_code.variables import FIRST, NODE_JETS, SHARE, STEP, TURN, whole_turns
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Positions

# Free coordinates of groups of higher class as expressions: their names, and how they move.

Number: TypeAlias = Any


@dataclass(frozen=True)
class Names:
    """Names of what is handed on from step to step; `group` is the number of the group in the plan."""

    group: int
    chain: LinkChain

    @property
    def labels(self) -> Posture:
        """The names of the free coordinates."""
        links, own = self.chain.group.links, f"group {self.group}"
        hanging = [f.entity.name for f in self.chain.pattern.follows if f.by is None]
        return Posture(
            {link: (f"{own} cosine {link}", f"{own} sine {link}") for link in links},
            {link: f"{own} angle {link}" for link in links},
            {name: (f"{own} x {name}", f"{own} y {name}") for name in hanging},
        )

    @property
    def posture(self) -> Posture:
        """The free coordinates as variables."""
        labels = self.labels
        return Posture(
            {name: (variable(x), variable(y)) for name, (x, y) in labels.rotors.items()},
            {name: variable(x) for name, x in labels.angles.items()},
            {name: (variable(x), variable(y)) for name, (x, y) in labels.places.items()},
        )

    def derivatives(self, order: int) -> list[str]:
        """Names of derivatives of the free coordinates."""
        return [f"group {self.group} derivative {order} of {k}" for k in range(self.chain.pattern.free)]

    def of_matrix(self, i: int, j: int) -> str:
        """Name of a number of the matrix."""
        return f"group {self.group} matrix {i} {j}"


def numbers_of(posture: Posture) -> list[Number]:
    """All numbers of a posture in one order."""
    # the order of `labels`, in which states are handed on
    pairs = [x for vector in (*posture.rotors.values(), *posture.places.values()) for x in vector]
    return [*pairs, *posture.angles.values()]


def move_posture(chain: LinkChain, posture: Posture, by: Sequence[Operand], far: bool = False) -> Posture:
    """A posture with its free coordinates changed by small numbers, or by such as stand in `far`."""
    rotors, angles, places = dict(posture.rotors), dict(posture.angles), dict(posture.places)
    for follow in chain.pattern.follows:
        name = follow.entity.name
        if follow.entity.kind == "link":
            turn = by[follow.turn]
            # by a product with a rotor near 1: no sine or cosine, which kernels and NumPy round differently
            rotors[name] = _normalise_rotor(rotate_vector(rotors[name], _rotor(turn, far)))
            angles[name] = angles[name] + turn
        if follow.by is None:
            x, y = places[name]
            by_x, by_y = by[follow.first : follow.first + 2]
            places[name] = x + chain.unit * by_x, y + chain.unit * by_y
    return Posture(rotors, angles, places)


def with_turns(posture: Posture) -> Posture:
    """A posture whose angles [rad] are those of its rotors, on the turns that the angles had before."""
    angles = {}
    for link, (cosine, sine) in posture.rotors.items():
        angle = EXPRESSIONS.atan2(sine, cosine)
        angles[link] = angle + TURN * whole_turns(posture.angles[link], angle)
    return Posture(posture.rotors, angles, posture.places)


def _rotor(turn: Operand, far: bool) -> Vector:
    """Rotor of an angle, but for its length: of a small one; with `far` to the sixth power of any that is no turn."""
    if not far:
        return 1.0, turn
    square = turn * turn
    # Taylor's polynomials: what they leave out, some 1e-6 at the greatest step, is within what Newton's
    # method rights
    return (
        1.0 - square * (0.5 - square * (1.0 / 24.0)),
        turn * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0))),
    )


def _normalise_rotor(rotor: Vector) -> Vector:
    """A rotor of nearly unit length made one: 1 / sqrt(1 + e) by its tangent."""
    cosine, sine = rotor
    # 1 / sqrt(1 + e) is 1 - e/2 but for e^2, with e = |rotor|^2 - 1: no root and no division
    factor = 1.5 - 0.5 * (cosine * cosine + sine * sine)
    return cosine * factor, sine * factor


# Small systems of linear equations solved by straight-line code: no step hangs on a value, only what it takes
# does.
#
# Up to three unknowns by cofactors, more by elimination in which rows are exchanged by selection.

Rows: TypeAlias = Sequence[Sequence[Operand]]
Operands: TypeAlias = Sequence[Operand]

m = EXPRESSIONS


def times(a: Operand, b: Operand) -> Operand:
    """Product; a literal zero costs nothing."""
    if is_literal_zero(a) or is_literal_zero(b):
        return 0.0
    return a * b


def minus(a: Operand, b: Operand) -> Operand:
    """Difference; a literal zero costs nothing."""
    return a if is_literal_zero(b) else -b if is_literal_zero(a) else a - b


def plus(a: Operand, b: Operand) -> Operand:
    """Sum; a literal zero costs nothing."""
    return b if is_literal_zero(a) else a if is_literal_zero(b) else a + b


def product(matrix: Rows, vector: Operands) -> list[Operand]:
    """Matrix times vector."""
    return [scalar_product(row, vector) for row in matrix]


def matrix_product(first: Rows, second: Rows) -> list[list[Operand]]:
    """Product of two matrices."""
    columns = list(zip(*second, strict=True))
    return [[scalar_product(row, column) for column in columns] for row in first]


def scalar_product(a: Operands, b: Operands) -> Operand:
    """Scalar product."""
    return total([times(x, y) for x, y in zip(a, b, strict=True)])


def total(values: Operands) -> Operand:
    """Sum."""
    start: Operand = 0.0
    return functools.reduce(plus, values, start)


def sizes(matrix: Rows) -> list[list[Operand]]:
    """Absolute values of all numbers."""
    return [[x if is_literal_zero(x) else m.abs(x) for x in row] for row in matrix]


def inverse(matrix: Rows) -> list[list[Operand]]:
    """The inverse; infinite or NaN where there is none."""
    return _by_cofactors(matrix) if len(matrix) <= 3 else _by_elimination(matrix)


def _by_cofactors(matrix: Rows) -> list[list[Operand]]:
    size = len(matrix)
    if not size:
        return []
    cofactors = [[_cofactor(matrix, i, j) for j in range(size)] for i in range(size)]
    # the determinant is the first row times its cofactors, which are needed anyway
    over = 1.0 / scalar_product(matrix[0], cofactors[0])
    return [[times(cofactors[j][i], over) for j in range(size)] for i in range(size)]


def _cofactor(matrix: Rows, i: int, j: int) -> Operand:
    rest = [[x for c, x in enumerate(row) if c != j] for r, row in enumerate(matrix) if r != i]
    if not rest:
        return 1.0
    if len(rest) == 1:
        minor: Operand = rest[0][0]
    else:
        (a, b), (c, d) = rest
        minor = minus(times(a, d), times(b, c))
    return minus(0.0, minor) if (i + j) % 2 else minor


def _by_elimination(matrix: Rows) -> list[list[Operand]]:
    """Gauss and Jordan; the greatest number of a column comes to its diagonal."""
    size = len(matrix)
    rows = [[*row, *(1.0 if i == j else 0.0 for j in range(size))] for i, row in enumerate(matrix)]
    for k in range(size):
        for i in range(k + 1, size):
            _exchange_rows(rows, k, i)
        over = 1.0 / rows[k][k]
        # columns up to the pivot's are never read again: literal zeros spare their operations
        rows[k] = [0.0 if c <= k else times(x, over) for c, x in enumerate(rows[k])]
        for i in range(size):
            if i != k:
                factor = rows[i][k]
                rows[i] = [
                    0.0 if c <= k else minus(x, times(factor, y))
                    for c, (x, y) in enumerate(zip(rows[i], rows[k], strict=True))
                ]
    return [row[size:] for row in rows]


def _exchange_rows(rows: list[list[Operand]], k: int, i: int) -> None:
    """Exchange two rows where the lower one has the greater number in column k."""
    first, second = rows[k][k], rows[i][k]
    # a literal zero is in no lane the greater number
    if is_literal_zero(second):
        return
    if is_literal_zero(first):
        rows[k], rows[i] = rows[i], rows[k]
        return
    lower = m.less(m.abs(first), m.abs(second))
    pairs = list(zip(rows[k], rows[i], strict=True))
    # the same node in both rows needs no selection
    rows[k] = [x if x is y else _select(lower, y, x) for x, y in pairs]
    rows[i] = [y if x is y else _select(lower, x, y) for x, y in pairs]


def _select(condition: Operand, x: Operand, y: Operand) -> Operand:
    if is_literal_zero(x) and is_literal_zero(y):
        return 0.0
    return m.where(condition, x, y)  # type: ignore[arg-type]


# The matrix of a group of higher class as expressions, made small once more: turns of leaves are found last.


@dataclass(frozen=True)
class Matrix:
    """Equations of a group made linear.

    Attributes
    ----------
    core : the equations without those across the arms of leaves, by all coordinates but the turns of leaves
    inverse : of the core
    rows, columns : where they stand among all
    terms : of each row of the core, what the terms of its equation come up to: in rad, or in the greatest length
    across : of each leaf, its equation by the core's coordinates
    leaves : of each leaf, its equation, its turn, and one over the derivative of that by this
    arms : along which equations of leaves are seen
    """

    core: Sequence[Sequence[Operand]]
    inverse: Sequence[Sequence[Operand]]
    rows: Sequence[int]
    columns: Sequence[int]
    terms: Sequence[Operand]
    across: Sequence[Sequence[Operand]]
    leaves: Sequence[tuple[int, int, Operand]]
    arms: Sequence[Vector]

    @classmethod
    def of(cls, chain: LinkChain, columns: Sequence[Sequence[Operand]], arms: Sequence[Vector]) -> Matrix:
        """From the columns of all derivatives, in the order of the equations left over."""
        whole = [list(row) for row in zip(*columns, strict=True)]
        leaves = []
        terms: list[Operand] = [1.0] * len(whole)
        for leaf in chain.leaves:
            local = chain.arm(leaf)
            # an equation seen along an arm is a length times the arm's length
            terms[leaf.rows[0]] = EXPRESSIONS.sqrt(dot(local, local)) * (1.0 / chain.unit)
            # across its arm a leaf turns by minus the square of that, whatever it stands at
            leaves.append((leaf.rows[1], leaf.column, -(chain.unit**2) / dot(local, local)))
        rows = [i for i in range(len(whole)) if i not in [row for row, _column, _over in leaves]]
        others = [j for j in range(len(whole)) if j not in [column for _row, column, _over in leaves]]
        core = [[whole[i][j] for j in others] for i in rows]
        across = [[whole[i][j] for j in others] for i, _column, _over in leaves]
        return cls(core, inverse(core), rows, others, [terms[i] for i in rows], across, leaves, arms)

    @property
    def changing(self) -> list[tuple[tuple[int, int], Node]]:
        """The numbers of the core that are not the same everywhere."""
        return [
            ((i, j), x) for i, row in enumerate(self.core) for j, x in enumerate(row) if isinstance(x, Node)
        ]

    @property
    def numbers(self) -> list[Operand]:
        """All that solving takes."""
        numbers = [x for rows in (self.inverse, self.across) for row in rows for x in row]
        return [
            *numbers,
            *(over for _row, _column, over in self.leaves),
            *(x for arm in self.arms for x in arm),
        ]

    def solve(self, right: Sequence[Operand]) -> list[Operand]:
        """The free coordinates that answer right sides."""
        solution: list[Operand] = [0.0] * len(right)
        core = product(self.inverse, [right[i] for i in self.rows])
        for j, x in zip(self.columns, core, strict=True):
            # the core first, then each leaf's turn from its own equation across the arm
            solution[j] = x
        for (row, column, over), across in zip(self.leaves, self.across, strict=True):
            rest = right[row]
            for a, x in zip(across, core, strict=True):
                rest = minus(rest, times(a, x))
            solution[column] = times(rest, over)
        return solution


# Whether a step of Newton's method on a group of higher class stays on the group's own curve, and that is
# regular.
#
# Between two places the matrix A changes by D (after a short step as much more as goes into a long one).
# Where E = A^-1 D has no eigenvalue as great as one, for which |E E| tells, no matrix on the way A + t D is
# singular (Banach's lemma; Golub and Van Loan, Matrix Computations, 4th ed., 2013, section 2.3.4). So the
# curve runs on over the drive's value without a limit or a change point; and the place found is on it where
# Newton's steps shrink at once.

CHANGE = 0.4
"""Greatest change of a matrix from one place to the next, in itself: 0.4 of what could make it singular."""
CONDITION = 1e-3
"""Part of its own numbers that counts as changed in any case: where the condition is above 400 nothing is certain."""
FARTHEST = 0.3
"""Greatest change of a free coordinate from one place to the next, in rad or in the greatest length."""
WRONG = 0.01
"""By how much a foretold place may be wrong, likewise."""
SHRINKING, FAINT = 0.1, 1e-9
"""What part of a step the next one with the same matrix may be, and a step below which nothing is checked."""
LAST = 1e-9
"""Greatest last step: by the square of it, but for rounding, a place is wrong, and so are its derivatives."""


def slack_of(
    names: Names, matrix: Matrix, ahead: Sequence[Operand], steps: Sequence[Sequence[Operand]]
) -> Node:
    """Positive where a step is certain: the least of what is left of all that is allowed.

    `ahead` is how far the place before is, `steps` are Newton's: with a matrix of their own, with the same, and with
    that of the place found, which is `matrix`.
    """
    one, two, three = (_greatest(step) for step in steps)
    parts = [
        # each part is 1 where nothing of the allowance is used and falls below 0 where it is used up
        (CHANGE - _relative_change(names, matrix)) * (1.0 / CHANGE),
        (FARTHEST - _greatest(ahead)) * (1.0 / FARTHEST),
        (WRONG - one) * (1.0 / WRONG),
        (SHRINKING * one + FAINT - two) * (1.0 / WRONG),
        (LAST - three) * (1.0 / LAST),
    ]
    return as_node(functools.reduce(m.min, parts))


def _relative_change(names: Names, matrix: Matrix) -> Operand:
    """By how much the matrix has changed since the place before, in itself."""
    change: list[list[Operand]] = [[0.0] * len(matrix.core) for _row in matrix.core]
    for (i, j), x in matrix.changing:
        change[i][j] = x - variable(names.of_matrix(i, j))
    moved = matrix_product(matrix.inverse, change)
    twice = [total(row) for row in sizes(matrix_product(moved, moved))]
    # where all numbers of a row are small its equation is no better known than its terms
    own = [plus(total(row), size) for row, size in zip(sizes(matrix.core), matrix.terms, strict=True)]
    condition = [scalar_product(row, own) for row in sizes(matrix.inverse)]
    # as if the step were the longest: so it does not matter which samples are requested; none before the first
    share = m.where(m.equal(variable(FIRST), 1.0), 0.0, variable(SHARE))
    return plus(times(share, m.sqrt(_greatest(twice))), times(CONDITION, _greatest(condition)))


def _greatest(values: Sequence[Operand]) -> Operand:
    """The greatest size; NaN where one is."""
    # `max` of nodes lets NaN win, so that a step without numbers is not certain
    return functools.reduce(m.max, [m.abs(x) for x in values])


@dataclass(frozen=True)
class NewtonStep:
    """A group of higher class after a step.

    Attributes
    ----------
    at : its points and links, jets of second order
    state : name -> what is handed on
    slack : positive where the group is sure to be where the arrays find it
    standing : name -> what a derivative by a dimension takes as given: it is found by iteration
    """

    at: Positions
    state: Mapping[str, Node]
    slack: Node
    standing: Mapping[str, Node]


def newton_step(group: int, chain: LinkChain, before: Positions, differentiable: bool) -> NewtonStep:
    """The step of a group from where its state stands to where the drive does.

    `before` is what is known there, as jets of second order. Where results are to be differentiated by dimensions,
    they are made to depend on these as the equations say (implicit functions).
    """
    return _Stepping(group, chain, needed_positions(chain.group, before), differentiable).step()


class _Stepping:
    def __init__(self, group: int, chain: LinkChain, known: Positions, differentiable: bool) -> None:
        self.chain, self.known, self.differentiable = chain, known, differentiable
        self.names = Names(group, chain)
        self.values = known.map_numbers(plain)
        self.free = chain.pattern.free
        self.rests: list[Operand] = [0.0] * self.free

    def step(self) -> NewtonStep:
        chain, names = self.chain, self.names
        start, along = names.posture, variable(STEP)
        first, second = (list(map(variable, names.derivatives(order))) for order in (1, 2))
        # x s + y s^2 / 2, with first and second derivatives of the place before
        ahead: list[Operand] = [(x + y * (along * 0.5)) * along for x, y in zip(first, second, strict=True)]
        foretold = move_posture(chain, start, ahead, far=True)
        # a matrix at the foretold place; it is kept for a second step, which shows whether steps shrink
        matrix = self._matrix(foretold)
        one = matrix.solve(self._gaps(foretold, matrix.arms))
        near = move_posture(chain, foretold, one)
        two = matrix.solve(self._gaps(near, matrix.arms))
        nearer = move_posture(chain, near, two)
        # the third step has the matrix of where it starts, so that what is left is of the square of a small
        # number
        matrix = self._matrix(nearer)
        three = matrix.solve(self._gaps(nearer, matrix.arms))
        posture = move_posture(chain, nearer, three)
        # derivatives first near the place, then righted at the place found: one pass of each suffices, as
        # they are linear
        rates, bends = self._rates(nearer, matrix, self.rests, self.rests)
        rates, bends = self._rates(posture, matrix, rates, bends)
        state = self._state(posture, rates, bends, matrix)
        slack = slack_of(names, matrix, ahead, (one, two, three))
        whole = with_turns(posture)
        standing: dict[str, Node] = {}
        if self.differentiable:
            standing = self._standing(whole, rates, bends, matrix)
            whole, rates, bends = self._by_implication(whole, rates, bends, matrix)
        # the motion is zero at the place itself: jets bring derivatives alone
        motion = [Jet((0.0, x, y)) for x, y in zip(rates, bends, strict=True)]
        return NewtonStep(chain.positions(self.known, whole, motion), state, slack, standing)

    # the equations

    def _gaps(self, posture: Posture, arms: Sequence[Vector]) -> list[Operand]:
        at = self.chain.positions(self.values, with_turns(posture), self.rests)
        return [minus(0.0, x) for x in self.chain.equations(m, at, arms)]

    def _matrix(self, posture: Posture) -> Matrix:
        """Derivatives of the equations by the free coordinates, each seen along the arms of this posture."""
        arms, posture = self.chain.arms(posture), with_turns(posture)
        columns = []
        for j in range(self.free):
            motion = [Jet((0.0, 1.0)) if i == j else 0.0 for i in range(self.free)]
            at = self.chain.positions(self.values, posture, motion)
            equations = self.chain.equations(NODE_JETS, at, arms)
            columns.append([x.coefficients[1] if isinstance(x, Jet) else 0.0 for x in equations])
        return Matrix.of(self.chain, columns, arms)

    def _rates(
        self, posture: Posture, matrix: Matrix, first: Sequence[Operand], second: Sequence[Operand]
    ) -> tuple[list[Operand], list[Operand]]:
        """First and second Taylor coefficients of the free coordinates, from nearly right ones and a matrix near by."""
        rates = self._righted_by(posture, matrix, [(0.0, x) for x in first])
        bends = self._righted_by(posture, matrix, [(0.0, *pair) for pair in zip(rates, second, strict=True)])
        return rates, bends

    def _righted_by(
        self, posture: Posture, matrix: Matrix, coefficients: Sequence[Sequence[Operand]]
    ) -> list[Operand]:
        """The last coefficients, made such that the equations hold to their order."""
        order = len(coefficients[0]) - 1
        known = self.known.map_numbers(lambda x: truncate_jet(x, order))
        motion = [0.0 if all(map(is_literal_zero, c)) else Jet(c) for c in coefficients]
        at = self.chain.positions(known, with_turns(posture), motion)
        equations = self.chain.equations(NODE_JETS, at, matrix.arms)
        off = matrix.solve(
            [minus(0.0, x.coefficients[order]) if isinstance(x, Jet) else 0.0 for x in equations]
        )
        return [plus(c[order], x) for c, x in zip(coefficients, off, strict=True)]

    def _state(
        self, found: Posture, rates: Sequence[Operand], bends: Sequence[Operand], matrix: Matrix
    ) -> dict[str, Node]:
        names = [*numbers_of(self.names.labels), *self.names.derivatives(1), *self.names.derivatives(2)]
        # second Taylor coefficients are half of second derivatives
        values = [*numbers_of(found), *rates, *(2.0 * x for x in bends)]
        state = dict(zip(names, map(as_node, values), strict=True))
        for (i, j), x in matrix.changing:
            state[self.names.of_matrix(i, j)] = as_node(x)
        return state

    # derivatives by dimensions

    def _standing(
        self, found: Posture, rates: Sequence[Operand], bends: Sequence[Operand], matrix: Matrix
    ) -> dict[str, Node]:
        # constants and plain variables do not depend on the iteration: only computed nodes are given
        nodes = [*numbers_of(found), *rates, *bends, *matrix.numbers]
        given = [x for x in nodes if isinstance(x, Node) and x.arguments]
        return {f"group {self.names.group} standing {k}": x for k, x in enumerate(dict.fromkeys(given))}

    def _by_implication(
        self, found: Posture, rates: Sequence[Operand], bends: Sequence[Operand], matrix: Matrix
    ) -> tuple[Posture, list[Operand], list[Operand]]:
        """Posture and coefficients after one more step of Newton's method: equal values, which depend on dimensions."""
        at = self.chain.positions(self.values, found, self.rests)
        gaps = [minus(0.0, x) for x in self.chain.equations(m, at, matrix.arms)]
        posture = move_posture(self.chain, found, matrix.solve(gaps))
        return posture, *self._rates(posture, matrix, rates, bends)
