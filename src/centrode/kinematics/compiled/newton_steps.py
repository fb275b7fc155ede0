"""One step of Newton's method on a group of higher class as expressions: from one place of the path to the next.

What is handed on are the free coordinates with their first two derivatives, which foretell the next place. There
one step with a matrix of its own, one more with the same, and one with a matrix of the place found come down to
rounding; the last matrix gives the derivatives as well. Whether that was the group's own curve, and regular all
the way, is told by `slack`:

Between two places the matrix A changes by D (for a short step as much more as goes into a long one). Where the greatest row sum of |A^-1| |D| stays below one, no matrix
on the way is singular (Banach's lemma; Higham, Accuracy and Stability of Numerical Algorithms, 2nd ed., 2002,
section 7.1), so the curve runs on over the drive's value without a limit or a change point, and the place found
is on it: Newton's steps shrink at once (Kantorovich).
"""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.jets import Jet
from centrode.geometry.plane import Vector, is_literal_zero, turned
from centrode.kinematics.compiled.matrices import Matrix
from centrode.kinematics.compiled.small_systems import dot, minus, multiplied, plus, sizes, times, total
from centrode.kinematics.compiled.turns import TURN, whole_turns
from centrode.kinematics.compiled.variables import FIRST, NODE_JETS, SHARE, STEP
from centrode.kinematics.higher_class.chains import Chain, Posture
from centrode.kinematics.higher_class.surroundings import needed, plain
from centrode.kinematics.higher_class.system import cut
from centrode.structure.positions import Positions

Number: TypeAlias = Any

m = EXPRESSIONS

CHANGE = 0.4
"""Greatest change of a matrix from one place to the next, in itself."""
CONDITION = 1e-3
"""Part of its own numbers that counts as changed in any case: matrices of a condition above 250 are not clear."""
FARTHEST = 0.3
"""Greatest change of a free coordinate from one place to the next, in rad or in the greatest length."""
WRONG = 0.01
"""By how much a foretold place may be wrong, likewise."""
SHRINKING, FAINT = 0.1, 1e-9
"""What part of a step the next one with the same matrix may be, and a step below which nothing is asked."""
LAST = 1e-9
"""Greatest last step: by the square of it, but for rounding, a place is wrong, and so are its derivatives."""


@dataclass(frozen=True)
class Step:
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


@dataclass(frozen=True)
class Names:
    """Names of what is handed on from step to step."""

    group: int
    chain: Chain

    def posture(self) -> Posture:
        """The free coordinates as variables."""
        return _mapped(self.labels(), variable)

    def labels(self) -> Posture:
        """The names of the free coordinates."""
        links, own = self.chain.group.links, f"group {self.group}"
        hanging = [f.entity.name for f in self.chain.pattern.follows if f.by is None]
        return Posture(
            {link: (f"{own} cosine {link}", f"{own} sine {link}") for link in links},
            {link: f"{own} angle {link}" for link in links},
            {name: (f"{own} x {name}", f"{own} y {name}") for name in hanging},
        )

    def rates(self, order: int) -> list[str]:
        """Names of derivatives of the free coordinates."""
        return [f"group {self.group} derivative {order} of {k}" for k in range(self.chain.pattern.free)]


def numbers_of(posture: Posture) -> list[Number]:
    """All numbers of a posture in one order."""
    pairs = [x for vector in (*posture.rotors.values(), *posture.places.values()) for x in vector]
    return [*pairs, *posture.angles.values()]


def _mapped(posture: Posture, function: Any) -> Posture:
    return Posture(
        {name: (function(x), function(y)) for name, (x, y) in posture.rotors.items()},
        {name: function(x) for name, x in posture.angles.items()},
        {name: (function(x), function(y)) for name, (x, y) in posture.places.items()},
    )


def newton_step(group: int, chain: Chain, before: Positions, differentiable: bool) -> Step:
    """The step of a group from where its state stands to where the drive does.

    `before` is what is known there, as jets of second order. Where results are to be differentiated by dimensions,
    they are made to depend on these as the equations say (implicit functions).
    """
    return _Stepping(group, chain, needed(chain.group, before), differentiable).step()


class _Stepping:
    def __init__(self, group: int, chain: Chain, known: Positions, differentiable: bool) -> None:
        self.chain, self.known, self.differentiable = chain, known, differentiable
        self.names = Names(group, chain)
        self.values = known.mapped(plain)
        self.free = chain.pattern.free
        self.rests: list[Operand] = [0.0] * self.free

    def step(self) -> Step:
        chain, names = self.chain, self.names
        start, along = names.posture(), variable(STEP)
        first, second = (list(map(variable, names.rates(order))) for order in (1, 2))
        ahead: list[Operand] = [(x + y * (along * 0.5)) * along for x, y in zip(first, second, strict=True)]
        foretold = self._moved(start, ahead, far=True)
        matrix = self._matrix(foretold)
        one = matrix.solved(self._gaps(foretold, matrix.arms))
        near = self._moved(foretold, one)
        two = matrix.solved(self._gaps(near, matrix.arms))
        nearer = self._moved(near, two)
        matrix = self._matrix(nearer)
        three = matrix.solved(self._gaps(nearer, matrix.arms))
        found = self._moved(nearer, three)
        rates, bends = self._rates(nearer, matrix, self.rests, self.rests)
        rates, bends = self._rates(found, matrix, rates, bends)
        state = self._state(found, rates, bends, matrix)
        slack = self._slack(matrix, ahead, one, two, three)
        whole = self._with_turns(found)
        standing: dict[str, Node] = {}
        if self.differentiable:
            standing = self._standing(whole, rates, bends, matrix)
            whole, rates, bends = self._by_implication(whole, rates, bends, matrix)
        motion = [Jet((0.0, x, y)) for x, y in zip(rates, bends, strict=True)]
        return Step(chain.positions(self.known, whole, motion), state, slack, standing)

    # the equations

    def _gaps(self, posture: Posture, arms: Sequence[Vector]) -> list[Operand]:
        at = self.chain.positions(self.values, self._with_turns(posture), self.rests)
        return [minus(0.0, x) for x in self.chain.equations(m, at, arms)]

    def _matrix(self, posture: Posture) -> Matrix:
        """Derivatives of the equations by the free coordinates, each seen along the arms of this posture."""
        arms, posture = self.chain.arms(posture), self._with_turns(posture)
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
        known = self.known.mapped(lambda x: cut(x, order))
        motion = [0.0 if all(map(is_literal_zero, c)) else Jet(c) for c in coefficients]
        at = self.chain.positions(known, self._with_turns(posture), motion)
        equations = self.chain.equations(NODE_JETS, at, matrix.arms)
        off = matrix.solved(
            [minus(0.0, x.coefficients[order]) if isinstance(x, Jet) else 0.0 for x in equations]
        )
        return [plus(c[order], x) for c, x in zip(coefficients, off, strict=True)]

    # the free coordinates

    def _moved(self, posture: Posture, by: Sequence[Operand], far: bool = False) -> Posture:
        """A posture with its free coordinates changed; `far` is exact for more than a little."""
        rotors, angles, places = dict(posture.rotors), dict(posture.angles), dict(posture.places)
        for follow in self.chain.pattern.follows:
            name = follow.entity.name
            if follow.entity.kind == "link":
                turn = by[follow.turn]
                rotors[name] = _righted(turned(rotors[name], _rotor(turn, far)))
                angles[name] = angles[name] + turn
            if follow.by is None:
                x, y = places[name]
                shift = by[follow.first : follow.first + 2]
                places[name] = x + self.chain.unit * shift[0], y + self.chain.unit * shift[1]
        return Posture(rotors, angles, places)

    def _with_turns(self, posture: Posture) -> Posture:
        """The same with the angles of its rotors, on the turn on which they are counted."""
        angles = {}
        for link, (cosine, sine) in posture.rotors.items():
            angle = m.atan2(sine, cosine)
            angles[link] = angle + TURN * whole_turns(posture.angles[link], angle)
        return Posture(posture.rotors, angles, posture.places)

    def _state(
        self, found: Posture, rates: Sequence[Operand], bends: Sequence[Operand], matrix: Matrix
    ) -> dict[str, Node]:
        names = [*numbers_of(self.names.labels()), *self.names.rates(1), *self.names.rates(2)]
        values = [*numbers_of(found), *rates, *(2.0 * x for x in bends)]
        state = dict(zip(names, map(as_node, values), strict=True))
        for (i, j), x in matrix.changing:
            state[self._before(i, j)] = as_node(x)
        return state

    def _before(self, i: int, j: int) -> str:
        return f"group {self.names.group} matrix {i} {j}"

    # what it is good for

    def _slack(self, matrix: Matrix, ahead: Sequence[Operand], *steps: Sequence[Operand]) -> Node:
        """The least of what is left of all that is allowed, each counted in its own measure."""
        one, two, three = (greatest(step) for step in steps)
        change: list[list[Operand]] = [[0.0] * len(matrix.core) for _row in matrix.core]
        for (i, j), x in matrix.changing:
            change[i][j] = as_node(x - variable(self._before(i, j)))
        # as if the step were the longest: so the samples asked for do not matter; none before the first
        share = m.where(m.equal(variable(FIRST), 1.0), 0.0, variable(SHARE))
        moved = [total(row) for row in sizes(multiplied(matrix.inverse, change))]
        own = [total(row) for row in sizes(matrix.core)]
        condition = [dot(row, own) for row in sizes(matrix.inverse)]
        changed = plus(times(share, greatest(moved)), times(CONDITION, greatest(condition)))
        shrunk = SHRINKING * one + FAINT - two
        parts = [
            (CHANGE - changed) * (1.0 / CHANGE),
            (FARTHEST - greatest(ahead)) * (1.0 / FARTHEST),
            (WRONG - one) * (1.0 / WRONG),
            shrunk * (1.0 / WRONG),
            (LAST - three) * (1.0 / LAST),
        ]
        return as_node(functools.reduce(m.min, parts))

    # derivatives by dimensions

    def _standing(
        self, found: Posture, rates: Sequence[Operand], bends: Sequence[Operand], matrix: Matrix
    ) -> dict[str, Node]:
        nodes = [*numbers_of(found), *rates, *bends, *matrix.numbers]
        given = [x for x in nodes if isinstance(x, Node) and x.arguments]
        return {f"group {self.names.group} standing {k}": x for k, x in enumerate(dict.fromkeys(given))}

    def _by_implication(
        self, found: Posture, rates: Sequence[Operand], bends: Sequence[Operand], matrix: Matrix
    ) -> tuple[Posture, list[Operand], list[Operand]]:
        """The same numbers by a last step of Newton's from where they stand, which moves with the dimensions."""
        at = self.chain.positions(self.values, found, self.rests)
        gaps = [minus(0.0, x) for x in self.chain.equations(m, at, matrix.arms)]
        posture = self._moved(found, matrix.solved(gaps))
        return posture, *self._rates(posture, matrix, rates, bends)


def _rotor(turn: Operand, far: bool) -> Vector:
    """Rotor of a small angle, but for its length; to the sixth power of what is not that small."""
    if not far:
        return 1.0, turn
    square = turn * turn
    return (
        1.0 - square * (0.5 - square * (1.0 / 24.0)),
        turn * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0))),
    )


def _righted(rotor: Vector) -> Vector:
    """A rotor of nearly unit length made one: 1 / sqrt(1 + e) by its tangent."""
    cosine, sine = rotor
    factor = 1.5 - 0.5 * (cosine * cosine + sine * sine)
    return cosine * factor, sine * factor


def greatest(values: Sequence[Operand]) -> Operand:
    """The greatest size; NaN where one is."""
    return functools.reduce(m.max, [m.abs(x) for x in values])
