"""Positions of planar groups in closed form: dyads of all kinds, driven links, gears, points of links."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction

from centrode.equations.inverse_functions import (
    CONSTANTS,
    HALF_PI,
    AngleSum,
    ArcFunction,
    SquareRoot,
    VectorDirection,
    VectorLength,
    angle_sum,
    within_a_turn,
)
from centrode.equations.linear import LinearConstraint, UnknownPlace, polar, system_of
from centrode.equations.position_functions import (
    Branch,
    Formula,
    GroupPositions,
    PositionFunctions,
    PositionLine,
    formula_value,
)
from centrode.equations.spelling import formula_of
from centrode.equations.symbol_table import SymbolLine, SymbolTable, lines_of, rods_of
from centrode.equations.symbols import (
    LENGTH,
    PLACE,
    ZERO,
    Angle,
    Letter,
    Sum,
    SumTerm,
    join_points,
    merge_waves,
    quarters_of,
)
from centrode.structure.constraints import FRAME
from centrode.structure.groups import (
    Aim,
    CylinderCircle,
    Group,
    GuideStop,
    Locus,
    Meet,
    Newton,
    Rail,
    RigidPoint,
    Rod,
    Slot,
    Touch,
    Train,
    TurnedLink,
    TwoPointLink,
)

DELTA = -1_500_000
"""Rank from which the auxiliary angles are counted: behind pi, before the angles of links."""
SIGN = -1_900_000
SHORT = 4
"""Terms of the longest square of a length that is written in angles and lengths too."""
MOST = 12
"""Terms of the longest coordinate that is written in one line."""


class UnwrittenGroup(Exception):
    """A group whose positions are not written in closed form."""


@dataclass(frozen=True)
class _Circle:
    """A circle on which a point of a group lies: about a known centre, drawn by a link or a cylinder."""

    point: str
    centre: str
    at: UnknownPlace
    radius: Sum
    direction: Angle
    """Of the radius, in letters."""


@dataclass(frozen=True)
class _SymbolTrack:
    """A line on which a point of a group lies: (point - base) across its heading is the offset."""

    point: str
    line: SymbolLine
    base: UnknownPlace
    heading: Angle
    offset: Sum
    carried: bool = False
    """Whether the group carries the line past a known point; then the base is a vector on the carriage."""


@dataclass
class _Lines:
    """Lines of a group in the making."""

    lines: list[PositionLine] = field(default_factory=list)
    names: tuple[str, ...] = ()
    branch: Branch | None = None
    auxiliary: tuple[Letter, ...] = ()
    unsolved: tuple[Letter, ...] = ()


class PlanePositions:
    """Writes the positions of a planar mechanism whose chains are laid."""

    def __init__(self, board: SymbolTable, conditions: Sequence[LinearConstraint]) -> None:
        self.board = board
        self.conditions = conditions
        self.lines = {line.name: line for line in lines_of(board.ready)}
        self.rods = {rod.name: rod for rod in rods_of(board.ready)}
        self.places: dict[str, UnknownPlace] = {name: board.points[name] for name in board.numbers.frame}
        self.known: set[Letter] = set(board.driven)
        """Letters that move and are known so far."""
        self.values: dict[Letter, float] = dict(CONSTANTS)
        """Numbers in the initial position of letters that the board does not have."""
        self.taken = {letter.name for letter in board.alphabet.meanings}
        self.deltas, self.signs = 0, 0
        self.axes = {
            line.point: (line, quarters % 2)
            for line in self.lines.values()
            if line.on == FRAME and line.name in board.constants
            and (quarters := quarters_of(line.direction)) is not None
        }  # fmt: skip
        """Point on an axis-parallel guide of the frame -> that guide, and whether it is upright."""

    def written(self, label_of: dict[int, str]) -> PositionFunctions:
        """All groups in the order of the plan; `label_of` has the terms of the structural formula by number."""
        found = []
        for number, group in enumerate(self.board.ready.structure.groups):
            lines = _Lines()
            before = (
                dict(self.places),
                set(self.known),
                set(self.taken),
                dict(self.values),
                self.deltas,
                self.signs,
            )
            try:
                self._write(group, lines)
            except UnwrittenGroup:
                self.places, self.known, self.taken, self.values, self.deltas, self.signs = before
                lines = _Lines()
                self._leave(group, lines)
            kind = "" if isinstance(group, RigidPoint) else group.kind
            if lines.lines or lines.unsolved:
                found.append(
                    GroupPositions(
                        label_of.get(number, "" if not group.links else ", ".join(group.links)),
                        kind,
                        tuple(lines.lines),
                        lines.names,
                        lines.branch,
                        lines.auxiliary,
                        lines.unsolved,
                    )
                )
        moving = {name: tuple(self.places[name]) for name in self.board.moving if name in self.places}
        return PositionFunctions(tuple(found), moving)

    def _write(self, group: Group, out: _Lines) -> None:
        match group:
            case RigidPoint():
                self._rigid_point(group.link, group.point, out)
            case TwoPointLink():
                self._two_points(group.link, group.first, group.second, out)
            case TurnedLink():
                self._linear(self._unknown(self.board.angles[group.link]), out)
            case Train():
                self._train(group, out)
            case Aim():
                self._aim(group, out)
            case Meet():
                self._meet(group, out)
            case Newton():
                raise UnwrittenGroup

    # what is known by name

    def _letter(self, rank: int, name: str, value: float) -> Letter:
        while name in self.taken:
            name += "'"
        self.taken.add(name)
        letter = Letter(rank, name)
        self.values[letter] = value
        return letter

    def _initial(self, formula: Formula) -> float:
        return float(formula_value(formula, self._number))

    def _number(self, letter: Letter) -> float:
        own = self.values.get(letter)
        return self.board.alphabet.meanings[letter].value if own is None else own

    def _add(
        self, out: _Lines, letter: Letter, formula: Formula, unit: str, other: Formula | None = None
    ) -> Sum:
        """Add a line, whose letter is known from there on."""
        out.lines.append(PositionLine(letter, formula, unit, other))
        self.values[letter] = self._initial(formula)
        self.known.add(letter)
        return Sum.letter(letter)

    def _unknown(self, angle: Angle) -> list[Letter]:
        """Letters of an angle that are not known yet."""
        return [x for x, _count in angle.parts if x in self.board.alphabet.rates and x not in self.known]

    def _turn(self, angle: Angle, way: Sum, out: _Lines) -> None:
        """From a direction, as a sum of angles, the letter of the angle that it is."""
        for letter in self._unknown(angle):
            count = dict(angle.parts)[letter]
            rest = angle_sum(angle) - Sum.letter(letter).scale(count)
            self._add(out, letter, AngleSum(within_a_turn((way - rest).scale(count))), "rad")

    def _put(self, point: str, at: UnknownPlace, out: _Lines) -> None:
        """Coordinates of a point as letters; what is a letter or zero already stays."""
        coordinates = []
        if point in self.axes:
            line, upright = self.axes[point]
            constant = self.board.constants[line.name]
            at = UnknownPlace(constant, at.y) if upright else UnknownPlace(at.x, constant)
        for axis, total in zip("xy", at, strict=True):
            if not total or _is_letter(total):
                coordinates.append(total)
                continue
            if len(total.terms) > MOST:
                raise UnwrittenGroup
            letter = self._letter(PLACE - 1_000_000 + len(self.places), f"{axis}_{point}", math.nan)
            coordinates.append(self._add(out, letter, formula_of(total), "m"))
        self.places[point] = UnknownPlace(*coordinates)

    def _place(self, point: str) -> UnknownPlace:
        try:
            return self.places[point]
        except KeyError:
            raise UnwrittenGroup from None

    # points and angles of links

    def _rigid_point(self, link: str, point: str, out: _Lines) -> None:
        start = self._start(link, point)
        self._put(point, self.places[start].plus(self.board.arm(link, start, point)), out)

    def _start(self, link: str, point: str = "") -> str:
        """The known point from which the points of a link are written: a fixed one where it has one."""
        known = [name for name in self.board.local(link) if name in self.places and name != point]
        fixed = [name for name in known if name in self.board.numbers.frame]
        if not known:
            raise UnwrittenGroup
        return (fixed or known)[0]

    def _two_points(self, link: str, first: str, second: str, out: _Lines) -> None:
        if self._unknown(self.board.angles[link]):
            self._towards(self._place(first), self._place(second), self._direction(link, first, second), out)

    def _direction(self, link: str, first: str, second: str) -> Angle:
        """Direction from one point of a link to another, in the angle of the link."""
        return self.board.arm_direction(link, first, second)[1]

    def _towards(self, start: UnknownPlace, end: UnknownPlace, angle: Angle, out: _Lines) -> None:
        """The angle of a link from two places on it."""
        if angle.quarters == 2:  # the link points the other way
            start, end, angle = end, start, angle.turned_by(2)
        way = end.plus(start, -1)
        if angle.parts and len(angle.parts) == 1 and not angle.quarters and angle.parts[0][1] == 1:
            self._add(out, angle.parts[0][0], VectorDirection(way.y, way.x), "rad")
            return
        direction = self._auxiliary_angle(VectorDirection(way.y, way.x), out)
        self._turn(angle, Sum.letter(direction), out)

    def _auxiliary_angle(self, formula: Formula, out: _Lines) -> Letter:
        self.deltas += 1
        letter = self._letter(DELTA + self.deltas, f"delta{self.deltas}", self._initial(formula))
        self._add(out, letter, formula, "rad")
        return letter

    # gears and wheels: linear equations between angles

    def _linear(self, unknown: list[Letter], out: _Lines) -> None:
        """Letters that a linear equation gives from what is known."""
        for letter in unknown:
            for one in self.conditions:
                total = one.residual
                slope = total.slope(letter)
                others = [
                    x
                    for x in total.letters
                    if x in self.board.alphabet.rates and x not in self.known and x != letter
                ]
                if others or not slope or slope.letters & {letter} or len(slope.terms) != 1:
                    continue
                term, number = next(iter(slope.terms.items()))
                rest = total - slope * Sum.letter(letter)
                formula = formula_of(rest.divide(term).scale(Fraction(-1) / Fraction(number)))
                self._add(out, letter, formula, self.board.alphabet.meanings[letter].unit)
                break
            else:
                raise UnwrittenGroup

    def _train(self, group: Train, out: _Lines) -> None:
        waiting = [x for link in group.links for x in self._unknown(self.board.angles[link])]
        while waiting:
            for letter in waiting:
                try:
                    self._linear([letter], out)
                except UnwrittenGroup:
                    continue
                waiting.remove(letter)
                break
            else:
                self._together(waiting, out)
                break
        for point, link in group.brought:
            self._rigid_point(link, point, out)

    def _together(self, unknown: list[Letter], out: _Lines) -> None:
        """Letters that as many linear equations give together, by Cramer's rule."""
        moving = self.board.alphabet.rates.keys()
        chosen = [
            one
            for one in self.conditions
            if one.residual.letters & set(unknown)
            and all(x in self.known or x in unknown for x in one.residual.letters & moving)
        ]
        if len(chosen) != len(unknown):
            raise UnwrittenGroup
        system = system_of([one.residual for one in chosen], unknown, [-1] * len(chosen))
        determinant = system.determinant
        if determinant is None or determinant.total.letters & moving:
            raise UnwrittenGroup
        name = self._letter(
            DELTA + 1000 + len(self.taken), f"D_{self.board.alphabet.meanings[unknown[0]].names[0]}", 0.0
        )
        formulas = system.solved_unknowns(name)
        if formulas is None:
            raise UnwrittenGroup
        if not determinant.single:
            self._add(out, name, determinant, "1")
        for letter, formula in zip(unknown, formulas, strict=True):
            self._add(out, letter, formula, "rad")

    # loci

    def _track(self, point: str, name: str, carried: bool) -> _SymbolTrack:
        board, line = self.board, self.lines[name]
        heading = board.heading(line)
        base = board.base(line)
        if line.name in board.constants:
            constant = board.constants[line.name]
            sign = {0: 1, 1: -1, 2: -1, 3: 1}[heading.quarters] if not heading.parts else 1
            return _SymbolTrack(point, line, UnknownPlace(ZERO, ZERO), heading, constant.scale(sign), carried)
        offset = board.track(line, ZERO).across(heading)
        place = UnknownPlace(ZERO, ZERO) if base is None or carried else self._place(base)
        return _SymbolTrack(point, line, place, heading, offset, carried)

    def _locus(self, locus: Locus, group: Meet) -> _Circle | _SymbolTrack:
        board = self.board
        match locus:
            case Rod(point, centre, link):
                radius, direction = board.arm_direction(link, centre, point)
                return _Circle(point, centre, self._place(centre), radius, direction)
            case CylinderCircle(point, centre, drive):
                rod = self.rods[drive]
                letters = {one.kind: x for x, one in board.alphabet.meanings.items() if one.names == (drive,)}
                if not {"stroke", "cylinder"} <= letters.keys():
                    raise UnwrittenGroup
                direction = Angle.of(letters["cylinder"]).turned_by(0 if rod.first == centre else 2)
                return _Circle(point, centre, self._place(centre), Sum.letter(letters["stroke"]), direction)
            case Rail(point, guide, _on):
                return self._track(point, guide, False)
            case Slot(point, guide):
                return self._track(point, guide, True)
            case Touch(letter="P"):
                return self._track(locus.point, locus.contact.rolling, locus.carried)
            case Touch():
                return self._round_track(locus, group)
            case _:
                raise UnwrittenGroup

    def _round_track(self, locus: Touch, group: Meet) -> _Circle:
        """The circle of a wheel's centre about that of its track; carried, the circle of the group's own point."""
        board, name = self.board, locus.contact.rolling
        rod = self.rods[name]
        letter = next(
            (
                x
                for x, one in board.alphabet.meanings.items()
                if one.kind == "bearing" and one.names == (name,)
            ),
            None,
        )
        if letter is None or isinstance(rod.first, str):
            raise UnwrittenGroup
        body, local = rod.first
        radius = board.alphabet.size(LENGTH, f"l_{name}", "reach", (name,), rod.length)
        own = board.local(body)
        hub = next((point for point, at in own.items() if at == local), "")
        if body == FRAME:
            return _Circle(locus.point, hub or name, board.spot(FRAME, local, name), radius, Angle.of(letter))
        first = next(iter(own))
        arm = board.spot(body, local, name).plus(board.points[first], -1)
        if not locus.carried:
            return _Circle(locus.point, hub or name, self._place(first).plus(arm), radius, Angle.of(letter))
        point = group.points[0]
        at = self._place(locus.point).plus(self._arm(group, point, first), -1).plus(arm, -1)
        return _Circle(point, locus.point, at, radius, Angle.of(letter).turned_by(2))

    def _meet(self, group: Meet, out: _Lines) -> None:
        stop = next((locus for locus in group.loci if isinstance(locus, GuideStop)), None)
        if stop is not None:
            self._write_stop(group, stop, out)
            return
        if group.carriage is not None:
            unknown = self._unknown(self.board.angles[group.carriage])
            if unknown:
                self._linear(unknown, out)
        loci = [self._locus(locus, group) for locus in group.loci]
        match loci:
            case [_Circle() as one, _Circle() as other]:
                self._circles(group, one, other, out)
            case [_Circle() as one, _SymbolTrack() as other]:
                self._circle_and_line(group, one, other, out)
            case [_SymbolTrack() as one, _SymbolTrack() as other]:
                self._tracks(group, one, other, out)
        self._slides(group, out)

    def _arm(self, group: Meet, first: str, second: str) -> UnknownPlace:
        """From one point of a group to another: nothing, or a vector on its carriage."""
        if first == second or group.carriage is None:
            return UnknownPlace(ZERO, ZERO)
        return self.board.arm(group.carriage, first, second)

    def _finish(self, group: Meet, point: str, at: UnknownPlace, out: _Lines) -> None:
        """Places of all points of a group from that of one."""
        if point not in self.places:
            self._put(point, at, out)
        for name in group.points:
            if name not in self.places:
                self._put(name, self.places[point].plus(self._arm(group, point, name)), out)

    def _auxiliary_vector(
        self, start: UnknownPlace, end: UnknownPlace, names: tuple[str, str], out: _Lines
    ) -> tuple[UnknownPlace, Letter]:
        """The vector between two known places, and the letter of its length."""
        way = end.plus(start, -1)
        chain = self._chain(names)
        letter = self._letter(LENGTH - 1_000_000 + self.deltas, f"l_{join_points(*names)}", math.nan)
        self._add(out, letter, VectorLength(tuple(one for one in way if one)), "m", chain)
        return way, letter

    def _chain(self, names: tuple[str, str]) -> Formula | None:
        """The same length by the law of cosines, in angles and lengths: where that is short."""
        board = self.board
        places = [board.full.get(name) for name in names]
        if places[0] is None or places[1] is None:
            return None
        way = places[0].plus(places[1], -1)
        square = formula_of(merge_waves(way.x * way.x + way.y * way.y))
        moving = square.total.letters & board.alphabet.rates.keys()
        short = (
            square.size <= SHORT and moving <= self.known and any(term.waves for term in square.rest.terms)
        )
        return SquareRoot(square) if short else None

    def _base_angle(self, way: UnknownPlace, out: _Lines) -> tuple[Letter, Sum]:
        """The auxiliary angle of a vector, and its direction: from the negative x axis where it points that way."""
        if float(way.x.value(math, self._number)) < 0.0:
            delta = self._auxiliary_angle(VectorDirection(way.y, -way.x), out)
            return delta, angle_sum(Angle((), 2)) - Sum.letter(delta)
        delta = self._auxiliary_angle(VectorDirection(way.y, way.x), out)
        return delta, Sum.letter(delta)

    def _sign(self, measure: Sum, out: _Lines) -> Sum:
        """The letter of the sign that a sum has."""
        places = self._initial_places()
        value = float(measure.value(math, lambda one: places[one] if one in places else self._number(one)))
        initial = 1 if value >= 0.0 else -1
        self.signs += 1
        letter = self._letter(SIGN + self.signs, f"k{self.signs}", float(initial))
        out.branch = Branch(letter, measure, initial)
        return Sum.letter(letter)

    def _initial_places(self) -> dict[Letter, float]:
        """Letters of the measures of signs: x_B and y_B of points whose lines are still to come."""
        found: dict[Letter, float] = {}
        for point in self.board.moving:
            at = self.board.at(point)
            found |= {_coordinate("x", point): at.real, _coordinate("y", point): at.imag}
        return found

    def _measured_place(self, point: str) -> UnknownPlace:
        """Where the motion has a point that is not written yet."""
        return UnknownPlace(Sum.letter(_coordinate("x", point)), Sum.letter(_coordinate("y", point)))

    # the dyads

    def _circles(self, group: Meet, one: _Circle, other: _Circle, out: _Lines) -> None:
        """RRR: law of cosines in the triangle of both centres and the point."""
        frame = self.board.numbers.frame
        if one.centre in frame and other.centre not in frame:
            one, other = other, one  # the link on a fixed hinge is the one that is solved
        main, far = other, one
        shift = self._arm(group, main.point, far.point)
        way, length = self._auxiliary_vector(main.at, far.at.plus(shift, -1), (far.centre, main.centre), out)
        direction, base = self._base_angle(way, out)
        square = Sum.letter(length, 2) + main.radius * main.radius - far.radius * far.radius
        corner = formula_of(square.divide(_product(main.radius)).scale(Fraction(1, 2)).divide(_term(length)))
        angle = self._auxiliary_angle(ArcFunction("arccos", corner), out)
        arm = self._measured_place(main.point).plus(main.at, -1)
        sign = self._sign(way.x * arm.y - way.y * arm.x, out)
        out.names, out.auxiliary = (main.point, main.centre, far.centre), (length, direction, angle)
        self._turn(main.direction, base + sign * Sum.letter(angle), out)
        self._finish(group, main.point, main.at.plus(polar(main.radius, main.direction)), out)
        if self._unknown(far.direction):
            self._towards(far.at, self.places[far.point], far.direction, out)

    def _circle_and_line(self, group: Meet, one: _Circle, track: _SymbolTrack, out: _Lines) -> None:
        """RRP: the link's angle against the line from the distance of its centre."""
        if track.carried:
            base = self.board.base(track.line)
            assert base is not None
            way = self._place(track.point).plus(one.at, -1).plus(self._arm(group, one.point, base), -1)
            height = track.offset - way.across(track.heading)
        else:
            way = one.at.plus(self._arm(group, one.point, track.point)).plus(track.base, -1)
            height = way.across(track.heading) - track.offset
        sine = formula_of(height.divide(_product(one.radius)))
        angle = self._auxiliary_angle(ArcFunction("arcsin", sine), out)
        arm = self._measured_place(one.point).plus(one.at, -1)
        sign = self._sign(arm.along(track.heading), out)
        out.names, out.auxiliary = (one.point, one.centre, track.line.name), (angle,)
        # ahead: heading - delta; behind: heading + pi + delta
        heading = angle_sum(track.heading)
        half = Sum.letter(HALF_PI)
        direction = heading - sign * Sum.letter(angle) + (Sum.number(1) - sign) * half
        self._turn(one.direction, direction, out)
        self._finish(group, one.point, one.at.plus(polar(one.radius, one.direction)), out)

    def _tracks(self, group: Meet, one: _SymbolTrack, other: _SymbolTrack, out: _Lines) -> None:
        """PRP and RPP: two linear equations."""
        if not group.points:
            raise UnwrittenGroup
        point = one.point if not one.carried else other.point if not other.carried else group.points[0]
        first, second = (self._line_of(group, track, point) for track in (one, other))
        sine = formula_of(Sum.wave("sin", one.heading.plus(other.heading, -1)))
        if not sine.number or not sine.single:
            raise UnwrittenGroup
        (base, offset), (other_base, other_offset) = first, second
        start = base.plus(polar(offset, one.heading.turned_by(1)))
        height = other_offset - start.plus(other_base, -1).across(other.heading)
        slide = height.divide(sine.product).scale(Fraction(1) / Fraction(sine.number))
        at = start.plus(polar(slide, one.heading))
        at = UnknownPlace(merge_waves(at.x), merge_waves(at.y))
        out.names = (one.line.name, other.line.name)
        self._finish(group, point, at, out)

    def _line_of(self, group: Meet, track: _SymbolTrack, point: str) -> tuple[UnknownPlace, Sum]:
        """A line on which a point of a group lies: one of its places, and its offset to the left of that."""
        if not track.carried:
            return track.base.plus(self._arm(group, point, track.point), -1), track.offset
        base = self.board.base(track.line)
        assert base is not None
        # the known point is at the offset from the line's base, which the carriage has beside the point
        return self._place(track.point).plus(self._arm(group, point, base), -1), -track.offset

    def _write_stop(self, group: Meet, stop: GuideStop, out: _Lines) -> None:
        """A point whose displacement on a guide is driven."""
        line = self.lines[stop.guide]
        letter = next((x for x, name in self.board.driven.items() if name == stop.drive), None)
        if letter is None:
            raise UnwrittenGroup
        base = self.board.base(line)
        start = UnknownPlace(ZERO, ZERO) if base is None else self._place(base)
        if group.carriage is not None:
            unknown = self._unknown(self.board.angles[group.carriage])
            if unknown:
                self._linear(unknown, out)
        self._finish(group, stop.point, start.plus(self.board.track(line, Sum.letter(letter))), out)
        self._slides(group, out)

    def _aim(self, group: Aim, out: _Lines) -> None:
        """RPR: the direction of the vector from the pivot to the target gives that of the guide."""
        board = self.board
        line = self.lines[group.guide if group.contact is None else group.contact.rolling]
        heading, pivot, target = board.heading(line), self._place(group.pivot), self._place(group.target)
        base = board.base(line)
        assert base is not None
        inside = board.track(line, ZERO).plus(board.arm(group.link, group.pivot, base))
        if group.block is not None and group.sliding is not None:
            inside = inside.plus(board.arm(group.block, group.target, group.sliding), -1)
        offset = merge_waves(inside.across(heading))
        if offset.letters & board.alphabet.rates.keys() or len(offset.terms) > SHORT:
            raise UnwrittenGroup
        way, length = self._auxiliary_vector(pivot, target, (group.pivot, group.target), out)
        direction, turned = self._base_angle(way, out)
        out.names = (group.target, group.pivot, line.name)
        out.auxiliary = (length, direction)
        sign = self._sign(self._ahead(group, heading, inside), out)
        half = Sum.letter(HALF_PI)
        if offset:
            sine = formula_of(offset.divide(_term(length)))
            beside = Sum.letter(self._auxiliary_angle(ArcFunction("arcsin", sine), out))
            turned = turned - sign * beside
        self._turn(heading, turned + (Sum.number(1) - sign) * half, out)
        if group.sliding is not None and group.block is not None:
            arm = board.arm(group.block, group.target, group.sliding)
            if group.sliding not in self.places:
                self._put(group.sliding, target.plus(arm), out)
        for letter in [x for x in self._slide_letters(line.name) if x not in self.known]:
            along = merge_waves(inside.along(heading))
            if offset:
                self._slide(line, letter, group, out)
            else:
                self._add(out, letter, formula_of(sign * Sum.letter(length) - along), "m")

    def _ahead(self, group: Aim, heading: Angle, inside: UnknownPlace) -> Sum:
        """How far the target is ahead of the foot of the pivot, by the angle that the motion gives."""
        way = self._place(group.target).plus(self._place(group.pivot), -1)
        return way.along(heading)

    # displacements

    def _slide_letters(self, name: str) -> list[Letter]:
        meanings = self.board.alphabet.meanings
        return [x for x, one in meanings.items() if one.kind == "slide" and one.names[0] == name]

    def _slides(self, group: Meet, out: _Lines) -> None:
        for locus in group.loci:
            name = (
                locus.guide
                if isinstance(locus, (Rail, Slot))
                else locus.contact.rolling
                if isinstance(locus, Touch)
                else ""
            )
            for letter in self._slide_letters(name):
                if letter not in self.known:
                    self._slide(self.lines[name], letter, None, out)

    def _slide(self, line: SymbolLine, letter: Letter, group: Aim | None, out: _Lines) -> None:
        """Displacement of a point along a line both of whose places are known."""
        board = self.board
        heading, base = board.heading(line), board.base(line)
        start = UnknownPlace(ZERO, ZERO)
        if base is not None:
            if base not in self.places and group is not None:
                start = self._place(group.pivot).plus(board.arm(group.link, group.pivot, base))
            elif base not in self.places:
                near = self._start(line.on)
                start = self.places[near].plus(board.arm(line.on, near, base))
            else:
                start = self.places[base]
        if line.point not in self.places:
            raise UnwrittenGroup
        way = self.places[line.point].plus(start, -1)
        far = board.track(line, ZERO).along(heading)
        self._add(out, letter, formula_of(merge_waves(way.along(heading) - far)), "m")

    # groups that have no closed form

    def _leave(self, group: Group, out: _Lines) -> None:
        """Angles and displacements that the motion gives, and the places of the points in them."""
        board = self.board
        letters = [x for link in group.links for x in self._unknown(board.angles[link])]
        names = {
            line.name for line in self.lines.values() if line.on in group.links or line.point in group.points
        }
        letters += [x for name in names for x in self._slide_letters(name)]
        meanings = board.alphabet.meanings
        points = set(group.points) | {p for link in group.links for p in board.local(link)}
        for x, one in meanings.items():
            rod = self.rods.get(one.names[0]) if one.names else None
            if one.kind in ("bearing", "cylinder") and rod is not None and {rod.first, rod.second} & points:
                letters.append(x)
        for letter in sorted(set(letters)):
            with suppress(UnwrittenGroup):
                self._linear([letter] if letter not in self.known else [], out)
        out.unsolved = tuple(dict.fromkeys(x for x in sorted(letters) if x not in self.known))
        self.known.update(out.unsolved)
        waiting = [point for point in group.points if point not in self.places]
        while waiting:
            step = next(
                (
                    (point, link)
                    for point in waiting
                    for link in (*group.links, *board.placed - set(group.links) - {FRAME})
                    if point in board.local(link)
                    and not self._unknown(board.angles[link])
                    and any(name in self.places for name in board.local(link))
                ),
                None,
            )
            if step is None:
                for point in waiting:
                    self._put(point, board.points[point], out)
                return
            self._rigid_point(step[1], step[0], out)
            waiting.remove(step[0])


def _coordinate(axis: str, point: str) -> Letter:
    """A coordinate of a point as the motion has it, which is not written."""
    return Letter(0, f"{axis}({point})")


def _is_letter(total: Sum) -> bool:
    """Whether a sum is a letter by itself."""
    (term, number), *others = total.terms.items()
    return (
        not others and number == 1 and not term.waves and len(term.letters) == 1 and term.letters[0][1] == 1
    )


def _product(total: Sum) -> SumTerm:
    """A length that is one product."""
    (term, number), *others = total.terms.items()
    if others or number != 1:
        raise UnwrittenGroup
    return term


def _term(letter: Letter) -> SumTerm:
    return SumTerm(((letter, 1),))
