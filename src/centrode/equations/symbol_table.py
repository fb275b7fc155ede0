"""The board on which vector chains are laid: letters, angles of bodies, places of points, in symbols."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from centrode.equations.linear import ORIGIN, Draft, Unknown, UnknownPlace, polar
from centrode.equations.symbols import (
    BEARING,
    LENGTH,
    PLACE,
    SLIDE,
    TURN,
    Alphabet,
    Angle,
    Letter,
    Sum,
    Vector,
    join_points,
)
from centrode.geometry.plane import along
from centrode.kinematics.preparation import Ready
from centrode.structure.constraints import FRAME, DisplacementDrive, DistanceDrive, PointOnGuide, TrackContact
from centrode.structure.gearing import Straight

# What the boards of both spaces share: letters, what moves, what the drives give.


class Lettering:
    """Letters of a mechanism, with the numbers of its initial position behind them."""

    def __init__(self, ready: Ready) -> None:
        self.ready = ready
        self.numbers = ready.kinematics.numbers
        self.mechanism = ready.mechanism
        self.alphabet = Alphabet()
        self.order = {name: i + 1 for i, name in enumerate(self.mechanism.links)}
        self.driven: dict[Letter, str] = {}
        """Letters that a drive gives."""
        self.moving: list[str] = []
        """Moving points in the order in which they were placed."""

    @property
    def moves(self) -> Mapping[Letter, Sum]:
        """Rate of every letter that moves."""
        return {letter: Sum.letter(rate) for letter, rate in self.alphabet.rates.items()}

    @property
    def moves_twice(self) -> Mapping[Letter, Sum]:
        """Rates of letters and of their rates."""
        seconds = {rate: Sum.letter(second) for rate, second in self.alphabet.seconds.items()}
        return {**self.moves, **seconds}

    @property
    def axes_through(self) -> tuple[str, str] | None:
        """Points of the frame that give the axes of places, where these are not the description's own."""
        return None

    def drive_value(self, drive: str) -> float:
        """Value of a drive in the initial position."""
        return float(self.ready.assembled.positions.drives[drive])

    def sort_in(self, letter: Letter, name: str, draft: Draft, drive: str | None) -> None:
        """Note what gives a letter that moves: a drive, or the constraints of a group."""
        if drive is not None:
            self.driven[letter] = drive
            return
        rate = self.alphabet.rates[letter]
        draft.unknowns.append(Unknown(name, letter, rate, self.alphabet.seconds[rate]))


# Guides, cylinders and tracks as parts of vector chains.


@dataclass(frozen=True)
class SymbolLine:
    """A point stays on a line of a body: on a guide, or with a wheel's centre on the parallel of its track."""

    name: str
    point: str
    on: str
    through: Vector
    direction: Vector
    drive: str | None = None


@dataclass(frozen=True)
class SymbolRod:
    """A distance that has a direction of its own: a cylinder, or the radius from a track's centre to the wheel's.

    `first` is a point, or (body, coordinates) of a place that has no name.
    """

    name: str
    first: str | tuple[str, Vector]
    second: str
    length: float
    drive: str | None = None


def lines_of(ready: Ready) -> list[SymbolLine]:
    """Guides and straight tracks, in the order of the constraints."""
    structure, numbers = ready.structure, ready.kinematics.numbers
    driven = {c.guide: c.drive for c in structure.constraints if isinstance(c, DisplacementDrive)}
    found = []
    for constraint in structure.constraints:
        if constraint in structure.redundant:
            continue
        if isinstance(constraint, PointOnGuide):
            through, direction = numbers.curve(constraint.guide)
            drive = driven.get(constraint.guide)
            found.append(
                SymbolLine(
                    constraint.guide, constraint.point, constraint.on, _v(through), _v(direction), drive
                )
            )
        if isinstance(constraint, TrackContact):
            track = numbers.gearing.track[constraint.rolling]
            if isinstance(track, Straight):
                normal = (-track.direction[1], track.direction[0])
                through = along(track.through, normal, numbers.gearing.reach(constraint.rolling))
                found.append(
                    SymbolLine(
                        constraint.rolling, constraint.centre, constraint.on, _v(through), _v(track.direction)
                    )
                )
    return found


def rods_of(ready: Ready) -> list[SymbolRod]:
    """Cylinders and round tracks."""
    structure, numbers = ready.structure, ready.kinematics.numbers
    found = []
    for constraint in structure.constraints:
        if constraint in structure.redundant:
            continue
        if isinstance(constraint, DistanceDrive):
            length = float(ready.assembled.positions.drives[constraint.drive])
            found.append(
                SymbolRod(constraint.drive, constraint.first, constraint.second, length, constraint.drive)
            )
        if isinstance(constraint, TrackContact):
            track = numbers.gearing.track[constraint.rolling]
            if not isinstance(track, Straight):
                reach = float(numbers.gearing.reach(constraint.rolling))
                found.append(
                    SymbolRod(constraint.rolling, (constraint.on, _v(track.centre)), constraint.centre, reach)
                )
    return found


def _v(vector: tuple[object, ...]) -> Vector:
    x, y = vector
    return float(x), float(y)  # type: ignore[arg-type]


class SymbolTable(Lettering):
    """Symbols of everything that is known so far, with the numbers of the initial position behind them."""

    def __init__(self, ready: Ready) -> None:
        super().__init__(ready)
        self.angles: dict[str, Angle] = {FRAME: Angle()}
        self.points: dict[str, UnknownPlace] = {}
        """With what constraints say put in: y_C = C1."""
        self.full: dict[str, UnknownPlace] = {}
        """In angles, lengths and slides alone."""
        self.placed: set[str] = {FRAME}
        self.guides = lines_of(ready)
        self.constants: dict[str, Sum] = {}
        """Guide of the frame -> the constant of what it says of its point."""
        for name, at in self.numbers.frame.items():
            self.points[name] = self.full[name] = self._fixed_place(name, (float(at[0]), float(at[1])))

    # numbers of the initial position

    def local(self, body: str) -> Mapping[str, Vector]:
        """Coordinates of a body's points in its axes."""
        points = self.numbers.frame if body == FRAME else self.numbers.local[body]
        return {name: (float(x), float(y)) for name, (x, y) in points.items()}

    def world(self, body: str, local: Vector) -> complex:
        """Where coordinates of a body lie in the initial position, as a complex number."""
        (ox, oy), (c, s) = self.ready.assembled.positions.poses[body]
        return complex(float(ox), float(oy)) + complex(*local) * complex(float(c), float(s))

    def at(self, point: str) -> complex:
        """Where a point lies in the initial position."""
        x, y = self.ready.assembled.positions.points[point]
        return complex(float(x), float(y))

    # letters that move

    def link_angle(self, link: str, draft: Draft, drive: str | None = None) -> Angle:
        """The angle of a link as a letter of its own: driven, or an unknown of the group."""
        number = self.order[link]
        value = self.ready.assembled.angles[link] if drive is None else self.drive_value(drive)
        letter = self.alphabet.moving(
            number, f"phi{number}", "link angle", (link,), value, "rad", f"omega{number}"
        )
        self.sort_in(letter, f"angle.{link}", draft, drive)
        return Angle.of(letter)

    def relative_angle(self, link: str, base: str, draft: Draft, drive: str) -> Angle:
        """The angle of a link against another, which a drive gives."""
        number = self.order[link]
        letter = self.alphabet.moving(
            TURN + number, f"theta{number}", "relative angle", (link, base), self.drive_value(drive), "rad",
            f"theta{number}_dot",
        )  # fmt: skip
        self.sort_in(letter, "", draft, drive)
        return Angle.of(letter)

    def slide(self, line: SymbolLine, draft: Draft) -> Letter:
        """The displacement of a point along a line of a body."""
        normal = self.at(line.point) - self.world(line.on, line.through)
        turn = self.ready.assembled.positions.poses[line.on][1]
        direction = complex(*line.direction) * complex(float(turn[0]), float(turn[1]))
        value = (normal * direction.conjugate()).real
        letter = self.alphabet.moving(
            SLIDE + len(self.alphabet.meanings), f"s_{line.name}", "slide", (line.name, line.on), value, "m",
            f"s_{line.name}_dot",
        )  # fmt: skip
        self.sort_in(letter, f"slide.{line.name}", draft, line.drive)
        return letter

    def bearing(self, rod: SymbolRod, draft: Draft) -> tuple[Sum, Angle]:
        """Length and direction of a cylinder, or of the radius to a rolling wheel's centre."""
        first = self.at(rod.first) if isinstance(rod.first, str) else self.world(*rod.first)
        way = self.at(rod.second) - first
        index = (
            rod.name if rod.drive is None else join_points(*self.mechanism.drive(rod.drive).distance or ())
        )
        rank = BEARING + len(self.alphabet.meanings)
        letter = self.alphabet.moving(
            rank,
            f"psi_{index}",
            "bearing" if rod.drive is None else "cylinder",
            (rod.name,),
            math.atan2(way.imag, way.real),
            "rad",
            f"omega_{index}",
        )
        self.sort_in(letter, f"{'bearing' if rod.drive is None else 'angle'}.{rod.name}", draft, None)
        if rod.drive is None:
            return self.alphabet.size(LENGTH, f"l_{index}", "reach", (rod.name,), rod.length), Angle.of(
                letter
            )
        stroke = self.alphabet.moving(
            LENGTH + 900_000, f"l_{index}", "stroke", (rod.name,), rod.length, "m", f"l_{index}_dot"
        )
        self.driven[stroke] = rod.drive
        return Sum.letter(stroke), Angle.of(letter)

    # places

    def arm(self, link: str, first: str, second: str) -> UnknownPlace:
        """Vector from one point of a link to another."""
        names = list(self.local(link))
        if names.index(first) > names.index(second):
            return ORIGIN.plus(self.arm(link, second, first), -1)
        size, direction = self.arm_direction(link, first, second)
        return polar(size, direction) if size else ORIGIN

    def arm_direction(self, link: str, first: str, second: str) -> tuple[Sum, Angle]:
        """Length and direction of the vector from one point of a link to another."""
        local = self.local(link)
        names = list(local)
        if names.index(first) > names.index(second):
            size, direction = self.arm_direction(link, second, first)
            return size, direction.turned_by(2)
        (ax, ay), (bx, by) = local[first], local[second]
        number = self.order[link]
        main = names[:2] == [first, second]
        index = join_points(first, second)
        size = self.alphabet.size(
            LENGTH + number, f"l{number}" if main else f"l_{index}", "length", (link, first, second),
            math.hypot(bx - ax, by - ay),
        )  # fmt: skip
        if not size:
            return size, self.angles[link]
        name = f"alpha{number}" if main else f"alpha_{index}"
        turn = self.alphabet.angle(name, "angle in link", (link, first, second), (bx - ax, by - ay))
        return size, self.angles[link].plus(turn)

    def spot(self, body: str, local: Vector, label: str, full: bool = False) -> UnknownPlace:
        """Place of coordinates of a placed body; `label` names them where no point of the body is there."""
        places = self.full if full else self.points
        own = self.local(body)
        for name, at in own.items():
            if at == local:
                return places[name]
        if body == FRAME:
            return self._fixed_place(label, local)
        first = next(iter(own))
        x, y = local[0] - own[first][0], local[1] - own[first][1]
        index = join_points(first, label)
        size = self.alphabet.size(
            LENGTH + self.order[body], f"l_{index}", "length", (body, first, label), math.hypot(x, y)
        )
        turn = self.alphabet.angle(f"alpha_{index}", "angle in link", (body, first, label), (x, y))
        return places[first].plus(polar(size, self.angles[body].plus(turn)))

    def _fixed_place(self, label: str, at: Vector) -> UnknownPlace:
        return UnknownPlace(
            *(
                self.alphabet.size(PLACE, f"{axis}_{label}", "coordinate", (label, axis), value)
                for axis, value in zip("xy", at, strict=True)
            )
        )

    def put(self, point: str, at: UnknownPlace, full: UnknownPlace) -> None:
        """Note where a point lies."""
        self.points[point], self.full[point] = at, full
        self.moving.append(point)

    # lines

    def heading(self, line: SymbolLine) -> Angle:
        """Direction of a line in the frame."""
        turn = self.alphabet.angle(
            f"beta_{line.name}", "angle of guide", (line.name, line.on), line.direction
        )
        return self.angles[line.on].plus(turn)

    def base(self, line: SymbolLine) -> str | None:
        """The point of a body from which a line of it is measured: one it goes through, else the first."""
        if line.on == FRAME:
            return None
        own = self.local(line.on)
        scale = max(1.0, *(math.hypot(*at) for at in own.values())) * 1e-14
        for far in (self._apart, lambda at, line: abs(self._apart_along(at, line)[1])):
            for name, at in own.items():
                if far(at, line) <= scale:
                    return name
        return next(iter(own))

    def track(self, line: SymbolLine, slide: Sum) -> UnknownPlace:
        """Vector from a line's base to a displacement along it."""
        base = self.base(line)
        start = (0.0, 0.0) if base is None else self.local(line.on)[base]
        along, across = self._apart_along(start, line)
        names = (line.name, line.on, base or "")
        scale = 1e-14 * max(1.0, math.hypot(*line.through))
        far = self.alphabet.size(SLIDE - 20, f"a_{line.name}", "offset along", names, _clean(along, scale))
        beside = self.alphabet.size(
            SLIDE - 10, f"e_{line.name}", "offset beside", names, _clean(across, scale)
        )
        heading = self.heading(line)
        return polar(far + slide, heading).plus(polar(beside, heading.turned_by(1)))

    def _apart(self, at: Vector, line: SymbolLine) -> float:
        return math.hypot(*self._apart_along(at, line))

    def _apart_along(self, at: Vector, line: SymbolLine) -> Vector:
        (x, y), (ux, uy) = (line.through[0] - at[0], line.through[1] - at[1]), line.direction
        return x * ux + y * uy, ux * y - uy * x


def _clean(value: float, scale: float) -> float:
    return 0.0 if abs(value) <= scale else value
