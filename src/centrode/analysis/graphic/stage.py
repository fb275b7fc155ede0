"""What a construction knows while it grows: velocities or accelerations of points and links, edges, equations."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from centrode.errors import InputError, MotionError
from centrode.geometry.plane import place, rotate_vector
from centrode.locale import _
from centrode.structure.constraints import FRAME, Positions
from centrode.structure.dimensions import Dimensions

# A drawing board: how finely directions and lengths are read, where lines meet, which scales a person takes.
#
# Vectors are complex numbers, x + i y. Turning by a quarter is multiplying by i.

PARALLEL = 1e-12
"""Lines whose sine is smaller count as parallel: rounding of directions makes some 1e-16, a dead point 1e-8."""
COARSEST_ANGLE, COARSEST_LENGTH = math.pi / 6, 0.01
"""Reading steps [rad] and [m on paper] above which a drawing says nothing."""


@dataclass(frozen=True)
class DrawingBoard:
    """Reading steps of angles [rad] and of lengths on paper [m]; None reads exactly.

    `length_step` is what the step on paper is in the mechanism [m], once its scale is chosen.
    """

    angle_step: float | None = None
    paper_step: float | None = None
    length_step: float | None = None

    def __post_init__(self) -> None:
        if self.angle_step is not None and not 0.0 < self.angle_step <= COARSEST_ANGLE:
            raise InputError(
                "angle_step",
                _("a reading step of {step:g} rad is not allowed").format(step=self.angle_step),
                _("give one above 0 and at most 30 deg"),
            )
        if self.paper_step is not None and not 0.0 < self.paper_step <= COARSEST_LENGTH:
            raise InputError(
                "length_step",
                _("a reading step of {step:g} m is not allowed").format(step=self.paper_step),
                _("give one above 0 and at most 10 mm on paper"),
            )

    def angle(self, angle: float) -> float:
        """An angle [rad] as it is read."""
        return angle if self.angle_step is None else self.angle_step * round(angle / self.angle_step)

    def direction(self, vector: complex) -> complex:
        """Unit vector along a vector, its angle as it is read."""
        if self.angle_step is None:
            return vector / abs(vector)
        return cmath.rect(1.0, self.angle(cmath.phase(vector)))

    def arm(self, vector: complex, known: bool = False) -> complex:
        """A distance in the drawing as it is read; the length of one between two points of a link is `known`."""
        if vector == 0:
            return 0j
        length = abs(vector)
        if self.length_step is not None and not known:
            length = self.length_step * round(length / self.length_step)
        return (
            # exactly, the vector itself: through its polar form it would be rounded
            vector if self.angle_step is None and length == abs(vector) else length * self.direction(vector)
        )


def meet(first: complex, along: complex, second: complex, other: complex) -> complex:
    """Where a line through `first` along a unit vector meets one through `second`; MotionError if they do not."""
    sine = cross(along, other)
    if abs(sine) < PARALLEL:
        raise MotionError(
            "",
            _("two lines of the construction are parallel: the group is in a dead position"),
            _("choose another instant, or a finer reading step"),
        )
    # Cramer's rule, with unit vectors: the sine is the determinant
    return first + cross(second - first, other) / sine * along


def cross(a: complex, b: complex) -> float:
    """Sine of the angle from a to b, times both lengths."""
    return (a.conjugate() * b).imag


def dot(a: complex, b: complex) -> float:
    """Cosine of the angle between a and b, times both lengths."""
    return (a.conjugate() * b).real


def extent_of(places: Iterable[complex]) -> float:
    """The longer side of the box around places."""
    places = list(places)
    across, up = [place.real for place in places], [place.imag for place in places]
    return max(max(across) - min(across), max(up) - min(up))


Kind: TypeAlias = Literal[
    "image", "normal", "tangential", "relative", "sliding", "coriolis", "driven", "carried"
]


ORIGIN = "0"
"""What stands before a link's name to name the origin of its axes; no point's name begins so."""


@dataclass(frozen=True)
class Edge:
    """A vector drawn in a diagram, from place to place [m/s or m/s^2].

    `name` says which: "BA" of B against A, "C" of C along its guide. An "image" joins images of one link.
    """

    start: complex
    end: complex
    kind: Kind
    name: str
    link: str = ""

    @property
    def vector(self) -> complex:
        """From start to end."""
        return self.end - self.start


@dataclass(frozen=True)
class Triangle:
    """A triangle of a diagram: a known side between two corners, and two sides whose directions alone are known.

    `names` are those of the known side and of the two others; `sides` their lengths, `angles` the angles opposite
    to them [rad].
    """

    names: tuple[str, str, str]
    sides: tuple[float, float, float]
    angles: tuple[float, float, float]


@dataclass(frozen=True)
class ConstructionTrial:
    """A false position: trial values [rad/s or rad/s^2] of one link's turning, and what was amiss with each."""

    links: tuple[str, ...]
    values: tuple[tuple[float, ...], ...]
    misfits: tuple[tuple[float, ...], ...]
    found: tuple[float, ...]
    checked: tuple[str, ...]


@dataclass(frozen=True)
class ConstructionStep:
    """Construction of one group: its vector equations, its triangle, its trials."""

    group: str
    equations: tuple[str, ...]
    triangle: Triangle | None = None
    trial: ConstructionTrial | None = None


@dataclass(frozen=True)
class VectorDrawing:
    """Drawing in which is measured: the mechanism's positions at an instant, its numbers, the board."""

    numbers: Dimensions
    at: Positions
    board: DrawingBoard

    def point(self, name: str) -> complex:
        """Place of a point, or of the origin of a link's axes."""
        if name.startswith(ORIGIN):
            return complex(*self.at.poses[name.removeprefix(ORIGIN)].origin)
        return complex(*self.at.points[name])

    def inside(self, link: str, local: tuple[float, float]) -> complex:
        """Place of coordinates in a link's axes."""
        return complex(*place(self.at.poses[link], local))

    def heading(self, link: str, direction: tuple[float, float]) -> complex:
        """A direction in a link's axes, as it is read off the drawing."""
        vector = complex(*rotate_vector(direction, self.at.poses[link].rotor))
        # the frame's own directions are given, not read
        return vector if link == FRAME else self.board.direction(vector)

    def arm(self, start: complex, end: complex, known: bool = False) -> complex:
        """Vector from place to place as it is read."""
        return self.board.arm(end - start, known)


@dataclass
class ConstructionStage:
    """Velocities (order 1) or accelerations (order 2) known so far.

    Attributes
    ----------
    points : point -> velocity or acceleration
    turns : link -> angular velocity [rad/s] or acceleration [rad/s^2]
    bases : link -> a point of it (or its origin) whose rate is known: the others follow from it
    before : the velocities, where accelerations are constructed
    driven : drive -> rate or second rate of its value
    hidden : places of links under points that slide on them, by the point's name with a dash; origins of links
        without a point that is found with them
    grain : what the length of an edge is read to; zero reads exactly
    """

    drawing: VectorDrawing
    driven: dict[str, float]
    before: ConstructionStage | None = None
    points: dict[str, complex] = field(default_factory=dict)
    turns: dict[str, float] = field(default_factory=lambda: {FRAME: 0.0})
    bases: dict[str, str] = field(default_factory=dict)
    hidden: dict[str, complex] = field(default_factory=dict)
    grain: float = 0.0
    edges: list[Edge] = field(default_factory=list)
    steps: list[ConstructionStep] = field(default_factory=list)

    @property
    def order(self) -> int:
        """1 of velocities, 2 of accelerations."""
        return 1 if self.before is None else 2

    def rate(self, name: str) -> complex:
        """Rate of a point, or of the origin of a link's axes."""
        return self.hidden[name] if name.startswith(ORIGIN) else self.points[name]

    def about(self, link: str, arm: complex) -> complex:
        """Rate that turning of a link adds at the end of an arm of it: i omega arm, or (i epsilon - omega^2) arm."""
        return 1j * self.turns[link] * arm + self.inwards(link, arm)

    def inwards(self, link: str, arm: complex) -> complex:
        """Normal part of `about`: 0 of velocities, -omega^2 arm of accelerations."""
        return 0j if self.before is None else -(self.before.turns[link] ** 2) * arm

    def point_rate(self, link: str, at: complex) -> complex:
        """Rate of the place of a link that lies at a place of the drawing."""
        if link == FRAME:
            return 0j
        base = self.bases[link]
        # from the one known point of the link, as on paper
        return self.rate(base) + self.about(link, self.drawing.arm(self.drawing.point(base), at))

    def coriolis(self, link: str, at: complex, velocity: complex) -> complex:
        """Coriolis acceleration at a place of a link of what passes there with a velocity; nothing of velocities."""
        if self.before is None or link == FRAME:
            return 0j
        # relative to the place of the link under what passes
        return 2j * self.before.turns[link] * (velocity - self.before.point_rate(link, at))

    def read(self, length: float) -> float:
        """The length of an edge as it is read off the diagram."""
        return self.grain * round(length / self.grain) if self.grain else length

    def copy(self) -> ConstructionStage:
        """A copy that can be continued independently: collections are copied, the drawing is shared."""
        return ConstructionStage(
            self.drawing,
            dict(self.driven),
            self.before,
            dict(self.points),
            dict(self.turns),
            dict(self.bases),
            dict(self.hidden),
            self.grain,
            list(self.edges),
            list(self.steps),
        )
