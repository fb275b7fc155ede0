"""What joins links besides hinges: guides, gears, rolling."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import PlainValidator

from centrode.locale import _
from centrode.model.entries import listed
from centrode.model.names import FRAME
from centrode.model.part import Part, missing_key, one_of
from centrode.model.problems import KEY, Problem, shown
from centrode.model.values import (
    READING,
    Angle,
    Coordinates,
    Direction,
    Name,
    Placed,
    PositiveLength,
    Spot,
    Through,
    Vector,
    si,
)

PLANE_KEYS = ("through", "direction")
SPHERE_KEYS = ("pole", "radius")


def _read_ratio(value: object) -> float:
    ratio = si(value, "ratio")
    if ratio == 0:
        raise Problem(_("{key} must not be zero").format(key=KEY))
    return ratio


def _read_flag(value: object) -> bool:
    if not isinstance(value, bool):
        raise Problem(_("expected true or false, got {value}").format(value=shown(value)))
    return value


def unit_along(direction: Vector | float) -> Vector:
    """Unit vector of a direction that is given as a vector or as an angle [rad]."""
    if isinstance(direction, tuple):
        length = math.hypot(*direction)
        return direction[0] / length, direction[1] / length
    return math.cos(direction), math.sin(direction)


class Guide(Part):
    """A point on a line of the frame or of a link; on the sphere, on a circle about a pole.

    Attributes
    ----------
    point : str
        The guided point.
    on : str
        "frame" or the link that carries the line.
    through : (x, y) [m] in the axes of `on`, a point's name, or Placed
    direction : (x, y) or angle [rad], in the axes of `on`
    link : str
        A link that contains `point` and does not turn against `on` (prismatic pair).
    angle : float [rad]
        The constant angle from `on` to `link`.
    name : str
        The guide's id where it is not its point's name.
    pole, radius : (longitude, latitude) [rad], a point's name or Placed; arc [rad]
        On the sphere, instead of `through` and `direction`; without a radius a great circle.
    """

    point: Name
    on: Name = FRAME
    through: Through = (0.0, 0.0)
    direction: Direction = (1.0, 0.0)
    link: Name | None = None
    angle: Angle | None = None
    name: Name | None = None
    pole: Through | None = None
    radius: PositiveLength | None = None

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given, by the rules of this part."""
        sphere = READING.get().space == "sphere"
        required = ("pole",) if sphere else PLANE_KEYS
        foreign = PLANE_KEYS if sphere else SPHERE_KEYS
        missing = [missing_key(key) for key in required if given.get(key) is None]
        wrong = [_foreign(key, sphere) for key in foreign if given.get(key) is not None]
        turning = given.get("angle") is not None and given.get("link") is None
        alone = [Problem(_("angle belongs to a guide with a link"), _("add link = ..., or take it out"))]
        return super().key_problems(given) + missing + wrong + (alone if turning else [])

    @property
    def id(self) -> str:
        """The guide's name, else its point's."""
        return self.name or self.point

    @property
    def direction_angle(self) -> float:
        """Angle [rad] of the line in the axes of `on`."""
        if isinstance(self.direction, tuple):
            return math.atan2(self.direction[1], self.direction[0])
        return self.direction

    @property
    def unit(self) -> Vector:
        """Unit vector along the line in the axes of `on`."""
        return unit_along(self.direction)

    @property
    def arc(self) -> float:
        """Radius [rad] of the circle about the pole, on the sphere."""
        return math.pi / 2 if self.radius is None else self.radius

    @property
    def unplaced(self) -> bool:
        """Whether the line (the pole, on the sphere) is still to be placed."""
        return Placed() in (self.through, self.pole)


def _foreign(key: str, sphere: bool) -> Problem:
    if sphere:
        return Problem(
            _("{key} belongs to the plane").format(key=key), _("on the sphere give pole and radius")
        )
    return Problem(
        _("{key} belongs to the sphere").format(key=key), _("in the plane give through and direction")
    )


class Gear(Part):
    """Two links whose angles against a carrier keep a ratio: the second's turn over the first's.

    Attributes
    ----------
    links : two names
        Of links; one of them may be "frame" (a fixed sun or ring).
    carrier : "frame" or a link
        The one that holds both axes.
    ratio : float, not zero
        Negative where they turn in opposite senses.
    name : str
        The gear's id where its links' names will not do.
    """

    links: Annotated[tuple[Name, ...], listed(2)]
    ratio: Annotated[float, PlainValidator(_read_ratio)]
    carrier: Name = FRAME
    name: Name | None = None

    @property
    def id(self) -> str:
        """The gear's name, else its two links as "OA-wheel"."""
        return self.name or "-".join(self.links)


class Track(Part):
    """What a wheel rolls on: a line (`through`, `direction`) or a circle (`centre`, `radius`).

    The wheel's centre lies to the left of a line, outside a circle or, with `inside`, inside it.
    """

    through: Coordinates | None = None
    direction: Direction | None = None
    centre: Spot | None = None
    radius: PositiveLength | None = None
    inside: Annotated[bool, PlainValidator(_read_flag)] = False

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given, by the rules of this part."""
        wrong = one_of(given, ("direction", "radius"))
        for key, partner in (("direction", "through"), ("radius", "centre")):
            if (given.get(key) is None) != (given.get(partner) is None):
                wrong.append(Problem(_("{key} and {partner} go together").format(key=key, partner=partner)))
        if given.get("inside") and given.get("direction") is not None:
            repair = _("take it out; turn the direction round to roll on the line's other side")
            wrong.append(Problem(_("inside belongs to a circle"), repair))
        return super().key_problems(given) + wrong

    @property
    def unit(self) -> Vector:
        """Unit vector along a line; (1, 0) for a circle."""
        return unit_along(self.direction or 0.0)


class Rolling(Part):
    """A wheel that rolls without slip on a line or a circle of another link.

    Attributes
    ----------
    link, centre : str
        The wheel and the point that is its centre.
    radius : float [m], positive
    on : "frame" or a link
    along : Track
        In the axes of `on`.
    name : str
        Its id where the wheel's name will not do, such as a wheel that rolls on two links.
    """

    link: Name
    centre: Name
    radius: PositiveLength
    along: Track
    on: Name = FRAME
    name: Name | None = None

    @property
    def id(self) -> str:
        """Its name, else the wheel's."""
        return self.name or self.link
