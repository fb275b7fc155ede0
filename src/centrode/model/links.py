"""The fixed link and the moving links: rigid sets of named points."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import PlainValidator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import reading
from centrode.model.reading import (
    FRAME,
    PLACED,
    DescriptionPart,
    FrozenMap,
    Problem,
    Problems,
    bounded_list,
    choice,
    entries,
    missing_key,
    named_entries,
    one_of,
    read_name,
    value_text,
)
from centrode.model.values import (
    READING,
    Angle,
    Coordinates,
    Direction,
    Flag,
    Inertia,
    Name,
    NamedPositions,
    Placed,
    PositiveLength,
    PositiveMetres,
    Spot,
    Through,
    Vector,
    not_negative,
    quantity,
    read_coordinates,
    read_inertia,
)

Shape = Literal["rod", "disc", "ring", "arc"]
SHAPES = ("rod", "disc", "ring", "arc")
RING_AND_POINT = "ring and point mass"


def _read_points(value: object) -> tuple[str, ...] | Mapping[str, Vector]:
    """Names, or local coordinates by name; how many there have to be, the checks know."""
    if isinstance(value, Mapping):
        return _read_local(named_entries(value, read_name, reading.POINTS))
    if not isinstance(value, list | tuple):
        what = _('expected names ["A", "B"] or coordinates {{ A = [x, y] }}, got {value}')
        raise Problem(what.format(value=value_text(value)))
    return tuple(read_name(name) for name in entries(value, reading.POINTS))


def _read_local(named: Mapping[str, object]) -> Mapping[str, Vector]:
    local: dict[str, Vector] = {}
    wrong: list[Problem] = []
    for name, coordinates in named.items():
        try:
            local[name] = read_coordinates(coordinates)
        except Problem as problem:
            wrong.append(Problem(problem.what, problem.repair, (name,)))
    if wrong:
        raise Problems(wrong)
    return FrozenMap(local)


class Frame(DescriptionPart):
    """The fixed link.

    Attributes
    ----------
    points : mapping of name to (x, y) [m] or Placed

    Examples
    --------
    >>> import centrode as ct
    >>> ct.Frame(points={"O": [0, 0], "D": ["4 m", 0]}).points["D"]
    (4.0, 0.0)
    """

    points: NamedPositions = FrozenMap({})

    @property
    def coordinates(self) -> Mapping[str, Vector]:
        """Coordinates [m] of every point; raises InputError for a point that is not placed yet."""
        return FrozenMap({name: _resolve_position(name, position) for name, position in self.points.items()})


def _resolve_position(name: str, position: Vector | Placed) -> Vector:
    if not isinstance(position, Placed):
        return position
    if position.at is None:
        raise InputError(
            f"[frame.points] {name}", _("the point is not placed yet"), _("give its coordinates")
        )
    return position.at


class PartMass(DescriptionPart):
    """One of several masses of a planar link.

    Attributes
    ----------
    mass : float [kg]
    at : local (x, y) [m] or a point's name
    inertia : float [kg m^2]
        About its own centre; none of a mass in one point.
    """

    mass: Annotated[float, quantity("mass", not_negative)]
    at: Spot
    inertia: Annotated[float, quantity("inertia", not_negative)] = 0.0


MASSES = 100
"""Masses of one link."""


class Link(DescriptionPart):
    """A rigid link.

    Attributes
    ----------
    points : tuple of names, or mapping of name to local (x, y) [m]
        One or two names, or coordinates in the link's own axes.
    length : float [m], positive
        Of a link with two named points; an arc [rad] on the sphere.
    angle : float [rad]
        In the initial position, absolute: from the first point to the second, or of the link's own x axis.
    mass [kg], centre (local (x, y) [m] or a point's name), inertia [kg m^2] about the centre
        On the sphere three principal moments in the link's axes, or its tensor.
    shape : "rod", "disc", "ring" or, on the sphere, "arc"
        Fills centre and inertia; a disc and a ring have a `radius` [m].
    masses : tuple of PartMass
        In the plane: further masses, beside `mass` or alone.
    centre_radius : float [m]
        On the sphere: how far the centre of mass is from the centre of the sphere.
    model : "ring and point mass"
        On the sphere: the inertia is that about the axis through the centre alone, and the mass is there.
    reference : two points
        On the sphere: the arc the angle is measured from.

    Examples
    --------
    >>> import centrode as ct
    >>> ct.Link(length="50 mm", angle="30 deg").length
    0.05
    """

    points: Annotated[tuple[str, ...] | Mapping[str, Vector], PlainValidator(_read_points)] = ()
    length: PositiveLength | None = None
    angle: Angle | None = None
    mass: Annotated[float, quantity("mass", not_negative)] | None = None
    centre: Spot | None = None
    inertia: Annotated[Inertia, PlainValidator(read_inertia)] | None = None
    shape: Annotated[Shape, choice(*SHAPES)] | None = None
    radius: PositiveMetres | None = None
    masses: Annotated[tuple[PartMass, ...], bounded_list(MASSES)] = ()
    centre_radius: Annotated[float, PlainValidator(lambda value: not_negative(value, "length"))] | None = None
    model: Annotated[Literal["ring and point mass"], choice(RING_AND_POINT)] | None = None
    reference: Annotated[tuple[Name, ...], bounded_list(2)] | None = None

    @property
    def coordinates(self) -> Mapping[str, Vector]:
        """Local coordinates [m] of every point: (0, 0) and (length, 0) where two points are named."""
        if isinstance(self.points, Mapping):
            return self.points
        return FrozenMap(
            {name: (0.0 if i == 0 else self.length or 0.0, 0.0) for i, name in enumerate(self.points)}
        )


# What joins links besides hinges: guides, gears, rolling.

PLANE_KEYS = ("through", "direction")
SPHERE_KEYS = ("pole", "radius")


def unit_along(direction: Vector | float) -> Vector:
    """Unit vector of a direction that is given as a vector or as an angle [rad]."""
    if isinstance(direction, tuple):
        length = math.hypot(*direction)
        return direction[0] / length, direction[1] / length
    return math.cos(direction), math.sin(direction)


class Guide(DescriptionPart):
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

    Examples
    --------
    >>> import centrode as ct
    >>> ct.Guide(point="C", through=[0, 0], direction="90 deg").direction_angle
    1.5707963267948966
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
        alone = [Problem(_("angle is used for a guide with a link only"), _("add link = ..., or remove it"))]
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
    def needs_place(self) -> bool:
        """Whether the line (the pole, on the sphere) is still to be placed."""
        return Placed() in (self.through, self.pole)


def _foreign(key: str, sphere: bool) -> Problem:
    if sphere:
        return Problem(
            _("{key} is used in the plane only").format(key=key), _("on the sphere give pole and radius")
        )
    return Problem(
        _("{key} is used on the sphere only").format(key=key), _("in the plane give through and direction")
    )


class Track(DescriptionPart):
    """What a wheel rolls on: a line (`through`, `direction`) or a circle (`centre`, `radius`).

    The wheel's centre lies to the left of a line, outside a circle or, with `inside`, inside it.
    """

    through: Coordinates | None = None
    direction: Direction | None = None
    centre: Spot | None = None
    radius: PositiveLength | None = None
    inside: Flag = False

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given, by the rules of this part."""
        wrong = one_of(given, ("direction", "radius"))
        for key, partner in (("direction", "through"), ("radius", "centre")):
            if (given.get(key) is None) != (given.get(partner) is None):
                wrong.append(
                    Problem(_("{key} and {partner} must be given together").format(key=key, partner=partner))
                )
        if given.get("inside") and given.get("direction") is not None:
            repair = _("remove it; reverse the direction to roll on the line's other side")
            wrong.append(Problem(_("inside is used with a circle only"), repair))
        return super().key_problems(given) + wrong

    @property
    def unit(self) -> Vector:
        """Unit vector along a line; (1, 0) for a circle."""
        return unit_along(self.direction or 0.0)


class Rolling(DescriptionPart):
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


# Any part of a description as the tables of a file, with only what differs from the defaults.


def part_tables(part: DescriptionPart) -> dict[str, Any]:
    """Tables of any part of a description."""
    tables: dict[str, Any] = {}
    for key, name in part.keys().items():
        value, field = getattr(part, name), type(part).model_fields[name]
        if name == type(part).among_keys:
            tables |= _plain(value)
            continue
        if field.is_required() or value != field.default or _is_required_key(part, name):
            tables[key] = _plain(value)
    return tables


def _is_required_key(part: DescriptionPart, name: str) -> bool:
    """Keys that a file has to give although the part has a default: a guide's line, in the plane."""
    return isinstance(part, Guide) and part.pole is None and name in PLANE_KEYS


def _plain(value: object) -> Any:
    if isinstance(value, DescriptionPart):
        return part_tables(value)
    if isinstance(value, Placed):
        return PLACED if value.at is None else {PLACED: list(value.at)}
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, tuple):
        return [_plain(entry) for entry in value]
    return value
