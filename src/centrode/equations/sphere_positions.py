"""Positions of spherical dyads in closed form: psi(beta), the angle of the coupler, spherical coordinates of points."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from centrode.equations.inverse_functions import (
    CONSTANTS,
    HALF_PI,
    AngleSum,
    ArcFunction,
    TangentOfAngle,
    VectorDirection,
    VectorLength,
)
from centrode.equations.position_functions import (
    Branch,
    Formula,
    GroupPositions,
    PositionFunctions,
    PositionLine,
    SphericalCoordinates,
    formula_value,
)
from centrode.equations.spelling import formula_of
from centrode.equations.sphere_chains import SphereBoard, SphereClosure, SpherePlace
from centrode.equations.symbols import ZERO, Angle, Letter, Sum, SumTerm, Wave, merge_waves

DELTA, SIGN = -1_500_000, -1_900_000
LONGEST = 3
"""Terms of the longest coordinate of a point that is written as a spherical one."""


class SpherePositions:
    """Writes the positions of a spherical mechanism whose closures are laid."""

    def __init__(self, board: SphereBoard) -> None:
        self.board = board
        self.values: dict[Letter, float] = dict(CONSTANTS)
        self.deltas = 0
        self.tangents: dict[Letter, TangentOfAngle] = {}

    def written(self, label_of: dict[int, str]) -> PositionFunctions:
        """All dyads in the order of the plan; `label_of` has the terms of the structural formula by number."""
        found = []
        for number, closure in enumerate(self.board.closures, 1):
            found += [
                self._closing(closure, number, label_of.get(closure.plan, "")),
                self._leaning(closure),
            ]
        places: dict[str, tuple[Sum, ...]] = {
            point: tuple(self.board.points[point]) for point in self.board.moving
        }
        coordinates = tuple(
            one
            for point in dict.fromkeys(self.board.moving)
            if (one := self._spherical(point, self.board.points[point])) is not None
        )
        return PositionFunctions(tuple(found), places, coordinates)

    def _number(self, letter: Letter) -> float:
        own = self.values.get(letter)
        return self.board.alphabet.meanings[letter].value if own is None else own

    def _line(self, letter: Letter, formula: Formula, unit: str) -> PositionLine:
        self.values[letter] = float(formula_value(formula, self._number))
        return PositionLine(letter, formula, unit)

    def _closing(self, closure: SphereClosure, number: int, label: str) -> GroupPositions:
        """The closure p cos x + q sin x = r by auxiliary angles: x = atan2(q, p) + k arccos(r/sqrt(p^2 + q^2))."""
        one = closure.closing
        p, q, rest = by_wave(one.right, closure.turn)
        r = merge_waves(one.left - rest)
        lines: list[PositionLine] = []
        whole = all(len(total.terms) <= 1 for total in (p, q, r))
        index = closure.turn.name.removeprefix("phi").removeprefix("psi")
        if not whole:
            letters = [Letter(SIGN - 100 + 4 * number + k, f"{name}{index}") for k, name in enumerate("pqr")]
            for letter, total in zip(letters, (p, q, r), strict=True):
                lines.append(self._line(letter, formula_of(total), "1"))
            p, q, r = map(Sum.letter, letters)
        self.deltas += 2
        size = Letter(SIGN - 100 + 4 * number + 3, f"d{index}")
        base, corner = (Letter(DELTA + self.deltas + k, f"delta{self.deltas + k}") for k in (-1, 0))
        sign = Letter(SIGN + number, f"k{number}")
        direction = self._line(base, VectorDirection(q, p), "rad")
        if r:
            lines.append(self._line(size, VectorLength(tuple(total for total in (p, q) if total)), "1"))
            lines += [direction, self._line(corner, ArcFunction("arccos", formula_of(r), size), "rad")]
        else:  # the arc is a right angle
            size = corner
            lines += [direction, self._line(corner, AngleSum(Sum.letter(HALF_PI)), "rad")]
        places = tuple(map(self._at, closure.places))
        initial = 1 if float(np.linalg.det(np.array(places))) >= 0.0 else -1
        self.values[sign] = float(initial)
        total = Sum.letter(base) + Sum.letter(sign) * Sum.letter(corner)
        lines.append(self._line(closure.turn, AngleSum(total), "rad"))
        if whole and r:
            self.tangents[closure.turn] = TangentOfAngle(p, q, r, sign, initial)
        centre, far, point = closure.places
        return GroupPositions(
            label,
            self.board.ready.structure.groups[closure.plan].kind,
            tuple(lines),
            (point, centre, far),
            Branch(sign, None, initial, closure.places),
            (size, base, corner),
            (),
            {x: one for x, one in self.tangents.items() if x == closure.turn},
        )

    def _leaning(self, closure: SphereClosure) -> GroupPositions:
        """The angle of the coupler to the path of its point, from the law of cosines."""
        one = closure.leaning
        _cosine, slope, rest = by_wave(one.left, closure.lean)
        total = merge_waves(one.right - rest)
        (term, number), *_others = slope.terms.items()
        formula = formula_of(total.divide(term).scale(1 / Fraction(number)))
        line = self._line(closure.lean, ArcFunction("arcsin", formula), "rad")
        return GroupPositions(closure.label, "", (line,))

    def _at(self, name: str) -> list[float]:
        """Where a point or a pole lies in the initial position."""
        board = self.board
        if name in board.ready.assembled.positions.points:
            return [float(x) for x in board.at(name)]
        body = next(body for body, points in board.inside.items() if name in points)
        return [float(x) for x in board.initial_place(body, board.inside[body][name])]

    def _spherical(self, point: str, at: SpherePlace) -> SphericalCoordinates | None:
        """Angles of a point from the z axis and about it, where its coordinates are short."""
        if max(len(total.terms) for total in at) > LONGEST:
            return None
        tangent = None
        for letter, formula in self.tangents.items():
            own = at.z == Sum.wave("cos", Angle.of(letter)) and not at.y
            if own and 0.0 < math.remainder(self._number(letter), math.tau) < math.pi:
                tangent = letter, formula
        letters = Letter(0, f"theta_{point}"), Letter(0, f"phi_{point}")
        return SphericalCoordinates(point, *letters, at.x, at.y, at.z, tangent)


def by_wave(total: Sum, letter: Letter) -> tuple[Sum, Sum, Sum]:
    """A sum as p cos x + q sin x + rest, of the angle x that a letter stands for."""
    p, q, rest = ZERO, ZERO, ZERO
    for term, number in total.terms.items():
        own = [one for one, _power in term.waves if letter in dict(one.parts)]
        if not own:
            rest += Sum({term: number})
            continue
        wave: Wave = own[0]
        factor = Sum({term.times(SumTerm((), ((wave, 1),)), -1): number})
        angle = Angle(wave.parts).plus(Angle.of(letter), -dict(wave.parts)[letter])
        sense = dict(wave.parts)[letter]
        cosine, sine = Sum.wave("cos", angle), Sum.wave("sin", angle)
        # cos(sx + a) = cos a cos x - s sin a sin x; sin(sx + a) = sin a cos x + s cos a sin x
        if wave.kind == "cos":
            p, q = p + factor * cosine, q - (factor * sine).scale(sense)
        else:
            p, q = p + factor * sine, q + (factor * cosine).scale(sense)
    return merge_waves(p), merge_waves(q), merge_waves(rest)
