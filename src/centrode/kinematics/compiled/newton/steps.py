"""One step of Newton's method on a group of higher class as expressions: from one place of the path to the next.

What is handed on are the free coordinates with their first two derivatives, which foretell the next place. There
one step with a matrix of its own, one more with the same, and one with a matrix of the place found come down to
rounding; the last matrix gives the derivatives as well. `certainty` tells where that can be relied upon.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.jets import Jet
from centrode.geometry.plane import Vector, is_literal_zero
from centrode.kinematics.compiled.newton.certainty import slack_of
from centrode.kinematics.compiled.newton.matrices import Matrix
from centrode.kinematics.compiled.newton.postures import Names, moved, numbers_of, with_turns
from centrode.kinematics.compiled.newton.small_systems import minus, plus
from centrode.kinematics.compiled.variables import NODE_JETS, STEP
from centrode.kinematics.higher_class.chains import Chain, Posture
from centrode.kinematics.higher_class.surroundings import needed, plain
from centrode.kinematics.higher_class.system import cut
from centrode.structure.constraints import Positions

Number: TypeAlias = Any

m = EXPRESSIONS


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
        start, along = names.posture, variable(STEP)
        first, second = (list(map(variable, names.derivatives(order))) for order in (1, 2))
        ahead: list[Operand] = [(x + y * (along * 0.5)) * along for x, y in zip(first, second, strict=True)]
        foretold = moved(chain, start, ahead, far=True)
        matrix = self._matrix(foretold)
        one = matrix.solved(self._gaps(foretold, matrix.arms))
        near = moved(chain, foretold, one)
        two = matrix.solved(self._gaps(near, matrix.arms))
        nearer = moved(chain, near, two)
        matrix = self._matrix(nearer)
        three = matrix.solved(self._gaps(nearer, matrix.arms))
        found = moved(chain, nearer, three)
        rates, bends = self._rates(nearer, matrix, self.rests, self.rests)
        rates, bends = self._rates(found, matrix, rates, bends)
        state = self._state(found, rates, bends, matrix)
        slack = slack_of(names, matrix, ahead, (one, two, three))
        whole = with_turns(found)
        standing: dict[str, Node] = {}
        if self.differentiable:
            standing = self._standing(whole, rates, bends, matrix)
            whole, rates, bends = self._by_implication(whole, rates, bends, matrix)
        motion = [Jet((0.0, x, y)) for x, y in zip(rates, bends, strict=True)]
        return Step(chain.positions(self.known, whole, motion), state, slack, standing)

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
        known = self.known.mapped(lambda x: cut(x, order))
        motion = [0.0 if all(map(is_literal_zero, c)) else Jet(c) for c in coefficients]
        at = self.chain.positions(known, with_turns(posture), motion)
        equations = self.chain.equations(NODE_JETS, at, matrix.arms)
        off = matrix.solved(
            [minus(0.0, x.coefficients[order]) if isinstance(x, Jet) else 0.0 for x in equations]
        )
        return [plus(c[order], x) for c, x in zip(coefficients, off, strict=True)]

    def _state(
        self, found: Posture, rates: Sequence[Operand], bends: Sequence[Operand], matrix: Matrix
    ) -> dict[str, Node]:
        names = [*numbers_of(self.names.labels), *self.names.derivatives(1), *self.names.derivatives(2)]
        values = [*numbers_of(found), *rates, *(2.0 * x for x in bends)]
        state = dict(zip(names, map(as_node, values), strict=True))
        for (i, j), x in matrix.changing:
            state[self.names.of_matrix(i, j)] = as_node(x)
        return state

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
        posture = moved(self.chain, found, matrix.solved(gaps))
        return posture, *self._rates(posture, matrix, rates, bends)
