"""What a construction knows while it grows: velocities or accelerations of points and links, edges, equations."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from centrode.analysis.graphic.board import Board
from centrode.geometry.plane import place, turned
from centrode.structure.constraints import FRAME, Positions
from centrode.structure.dimensions import Dimensions

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
class Trial:
    """A false position: trial values [rad/s or rad/s^2] of one link's turning, and what was amiss with each."""

    links: tuple[str, ...]
    values: tuple[tuple[float, ...], ...]
    misfits: tuple[tuple[float, ...], ...]
    found: tuple[float, ...]
    checked: tuple[str, ...]


@dataclass(frozen=True)
class Step:
    """What was done for one group: its vector equations, its triangle, its trials."""

    group: str
    equations: tuple[str, ...]
    triangle: Triangle | None = None
    trial: Trial | None = None


@dataclass(frozen=True)
class Drawing:
    """What is measured: the mechanism's positions at an instant, its numbers, the board."""

    numbers: Dimensions
    at: Positions
    board: Board

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
        vector = complex(*turned(direction, self.at.poses[link].rotor))
        # the frame's own directions are given, not read
        return vector if link == FRAME else self.board.direction(vector)

    def arm(self, start: complex, end: complex, known: bool = False) -> complex:
        """Vector from place to place as it is read."""
        return self.board.arm(end - start, known)


@dataclass
class Stage:
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

    drawing: Drawing
    driven: dict[str, float]
    before: Stage | None = None
    points: dict[str, complex] = field(default_factory=dict)
    turns: dict[str, float] = field(default_factory=lambda: {FRAME: 0.0})
    bases: dict[str, str] = field(default_factory=dict)
    hidden: dict[str, complex] = field(default_factory=dict)
    grain: float = 0.0
    edges: list[Edge] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)

    @property
    def order(self) -> int:
        """1 of velocities, 2 of accelerations."""
        return 1 if self.before is None else 2

    def rate(self, name: str) -> complex:
        """Rate of a point, or of the origin of a link's axes."""
        return self.hidden[name] if name.startswith(ORIGIN) else self.points[name]

    def about(self, link: str, arm: complex) -> complex:
        """What turning of a link adds at the end of an arm of it: i omega arm, or (i epsilon - omega^2) arm."""
        return 1j * self.turns[link] * arm + self.inwards(link, arm)

    def inwards(self, link: str, arm: complex) -> complex:
        """The normal part of it: nothing of velocities, -omega^2 arm of accelerations."""
        return 0j if self.before is None else -(self.before.turns[link] ** 2) * arm

    def carried(self, link: str, at: complex) -> complex:
        """Rate of the place of a link that lies at a place of the drawing."""
        if link == FRAME:
            return 0j
        base = self.bases[link]
        return self.rate(base) + self.about(link, self.drawing.arm(self.drawing.point(base), at))

    def coriolis(self, link: str, at: complex, velocity: complex) -> complex:
        """Coriolis acceleration at a place of a link of what passes there with a velocity; nothing of velocities."""
        if self.before is None or link == FRAME:
            return 0j
        return 2j * self.before.turns[link] * (velocity - self.before.carried(link, at))

    def read(self, length: float) -> float:
        """The length of an edge as it is read off the diagram."""
        return self.grain * round(length / self.grain) if self.grain else length

    def copied(self) -> Stage:
        """The same, to be gone on with apart."""
        return Stage(
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
