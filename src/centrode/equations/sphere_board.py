"""The board of the sphere: bodies by arcs from their first point, turned in it by angles."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from centrode.equations.alphabet import BEARING, ROUNDING, SIMPLE, TURN, quarters_of
from centrode.equations.draft import Draft
from centrode.equations.lettering import Lettering
from centrode.equations.letters import Angle
from centrode.equations.turned import AXES, BACK, Axes, SpherePlace
from centrode.errors import InputError
from centrode.kinematics.prepared import Ready
from centrode.locale import _
from centrode.model.sphere import makes_arc, unit_vector
from centrode.structure.constraints import FRAME

Vector = npt.NDArray[np.float64]

ARC = -500_000
"""Arcs stand before the angles of links."""
LONGEST = 16
"""Terms of the longest coordinate of a place on which anything more is laid."""


class SphereBoard(Lettering):
    """Symbols of everything that is known so far on the sphere.

    Everything is written in axes of the frame: the first through its first pivot, the second in the half-plane of
    the arc from there to its second pivot, the third square to both.
    """

    def __init__(self, ready: Ready, pivots: list[str]) -> None:
        super().__init__(ready)
        self.axes: dict[str, Axes] = {}
        """Of every placed body, in its first point along the arc to its second."""
        self.firsts: dict[str, tuple[str, str]] = {}
        self.points: dict[str, SpherePlace] = {}
        self.inside = {
            body: {name: np.array(unit_vector((float(a), float(b)))) for name, (a, b) in points.items()}
            for body, points in {FRAME: self.numbers.frame, **self.numbers.local}.items()
        }
        self.poles = {guide: self._pole(guide, body) for guide, body in self.numbers.bodies.items()}
        """Of every guide the point about which its circle runs."""
        self._begin(pivots)

    def _pole(self, guide: str, body: str) -> str:
        """The point of a body in the pole of a guide; a name for the pole where there is none."""
        a, b = self.numbers.through[guide]
        at = np.array(unit_vector((float(a), float(b))))
        same = [name for name, place in self.inside[body].items() if np.array_equal(place, at)]
        name = same[0] if same else f"pole-{guide}"
        self.inside[body][name] = at
        return name

    def _begin(self, pivots: list[str]) -> None:
        """The axes of the frame: through two of its points that make an arc, pivots first."""
        at = self.inside[FRAME]
        names = [*pivots, *(name for name in at if name not in pivots)]
        for second in names[1:]:
            if makes_arc(tuple(at[names[0]].tolist()), tuple(at[second].tolist())):
                self.place(FRAME, names[0], second, AXES)
                return
        raise unwritten()

    @property
    def axes_through(self) -> tuple[str, str] | None:
        first, second = (self.inside[FRAME][name] for name in self.firsts[FRAME])
        own = abs(first[0] - 1.0) < ROUNDING and abs(second[2]) < ROUNDING and second[1] > 0
        return None if own else self.firsts[FRAME]

    # numbers of the initial position

    def at(self, point: str) -> Vector:
        """Where a point lies in the initial position."""
        return np.array([float(x) for x in self.ready.assembled.positions.points[point]])

    def carried(self, body: str, inside: Vector) -> Vector:
        """Where a place of a body lies in the initial position."""
        pose = self.ready.assembled.positions.poses[body]
        axes = np.array([[float(x) for x in axis] for axis in pose])
        return np.asarray(inside @ axes)

    # constants

    def arc(self, body: str, *points: str) -> Angle:
        """An arc between two points of a body, AB; right angles as such."""
        first, second = sorted(points, key=list(self.inside[body]).index)
        a, b = self.inside[body][first], self.inside[body][second]
        plain = SIMPLE.fullmatch(first) and SIMPLE.fullmatch(second)
        name = f"{first}{second}" if plain else f"l_{first}-{second}"
        size = float(np.linalg.norm(np.cross(a, b)))
        return self.constant(name, "arc", (first, second), (float(a @ b), size))

    def constant(self, name: str, kind: str, names: tuple[str, ...], direction: tuple[float, float]) -> Angle:
        """A constant arc or angle by its cosine and sine: right angles as such, another one by a letter."""
        quarters = quarters_of(direction)
        if quarters is not None:
            return Angle((), quarters)
        value = math.atan2(direction[1], direction[0])
        return Angle.of(self.alphabet.letter(ARC, name, kind, names, value, "rad"))

    def between(self, pivot: str, start: str, end: str, at: tuple[Vector, Vector, Vector]) -> Angle:
        """The constant angle in a point from one arc to another of the same body."""
        if start == end:
            return Angle()
        place, a, b = at
        first, second = np.cross(place, a), np.cross(place, b)
        direction = (float(first @ second), float(place @ np.cross(first, second)))
        return self.constant(f"kappa_{start}{pivot}{end}", "corner", (start, pivot, end), direction)

    # letters that move

    def turn(self, link: str, of: tuple[str, str, float], draft: Draft, drive: str | None) -> Angle:
        """The angle of a link in a point from an arc: phi3, with its initial value."""
        number = self.order[link]
        pivot, towards, value = of
        letter = self.alphabet.moving(
            number, f"phi{number}", "angle from arc", (link, pivot, towards), value, "rad", f"omega{number}"
        )
        self.sort_in(letter, f"angle.{link}", draft, drive)
        return Angle.of(letter)

    def bearing(self, guide: str, of: tuple[str, str, float], draft: Draft) -> Angle:
        """Where a point is on the circle of a guide: the angle in its pole."""
        rank = BEARING + len(self.alphabet.meanings)
        pole, towards, value = of
        letter = self.alphabet.moving(
            rank, f"psi_{guide}", "angle on circle", (guide, pole, towards), value, "rad", f"omega_{guide}"
        )
        self.sort_in(letter, f"bearing.{guide}", draft, None)
        return Angle.of(letter)

    def lean(self, link: str, point: str, guide: str, value: float, draft: Draft) -> Angle:
        """The angle of a link in a point against the circle on which another link carries it: gamma2."""
        number = self.order[link]
        letter = self.alphabet.moving(
            TURN + number, f"gamma{number}", "angle to path", (link, point, guide), value, "rad",
            f"gamma{number}_dot",
        )  # fmt: skip
        self.sort_in(letter, f"lean.{link}", draft, None)
        return Angle.of(letter)

    # bodies

    def place(self, body: str, first: str, second: str, axes: Axes) -> None:
        """Note how a body stands: its axes in one point along the arc to another; places of all its points."""
        self.axes[body], self.firsts[body] = axes, (first, second)
        if max(len(total.terms) for axis in axes for total in axis) > LONGEST:
            raise InputError(
                body,
                _("its place in symbols has too many terms to be read"),
                _("compute the motion: centrode run"),
            )
        for name in self.inside[body]:
            if name not in self.points:
                self.points[name] = self.seen_from(body, name).at
                if body != FRAME and name in self.numbers.local[body]:
                    self.moving.append(name)

    def seen_from(self, body: str, point: str) -> Axes:
        """Axes in a point of a placed body: along the arc on from its first point."""
        inside = self.inside[body]
        first, second = self.firsts[body]
        if point == first:
            return self.axes[body]
        arc = self.arc(body, first, point)
        corner = self.between(first, second, point, (inside[first], inside[second], inside[point]))
        return self.axes[body].turned(corner).moved(arc)

    def towards(self, body: str, pivot: str, end: str | None) -> tuple[Axes, str]:
        """Axes in a point of a placed body along the arc to another of its points, and the name of that one.

        Where none is named, the body's first point is taken, or its second from the first.
        """
        inside = self.inside[body]
        first, second = self.firsts[body]
        axes = self.seen_from(body, pivot)
        if pivot != first:
            axes = axes.turned(BACK)
        own = second if pivot == first else first
        if end is None or end == own:
            return axes, own
        return axes.turned(self.between(pivot, own, end, (inside[pivot], inside[own], inside[end]))), end

    def body_of(self, point: str) -> str:
        """A placed body that has a point: the frame before others."""
        return next(body for body in (FRAME, *self.axes) if body in self.axes and point in self.inside[body])


def unwritten() -> InputError:
    """What is told of a group that is not written in symbols on the sphere."""
    return InputError(
        "",
        _("on the sphere equations in symbols are written for driven links and dyads of arcs and circles"),
        _("compute the motion: centrode run"),
    )
