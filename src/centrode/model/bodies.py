"""The fixed link and the moving links: rigid sets of named points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import PlainValidator

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import limits
from centrode.model.entries import choice, entries, listed, named_entries
from centrode.model.frozen import FrozenMap
from centrode.model.names import read_name
from centrode.model.part import Part
from centrode.model.problems import Problem, Problems, shown
from centrode.model.tensors import Inertia, read_inertia
from centrode.model.values import (
    Angle,
    Name,
    NamedPositions,
    Placed,
    PositiveLength,
    PositiveMetres,
    Spot,
    Vector,
    not_negative,
    quantity,
    read_coordinates,
)

Shape = Literal["rod", "disc", "ring", "arc"]
SHAPES = ("rod", "disc", "ring", "arc")
RING_AND_POINT = "ring and point mass"


def _read_points(value: object) -> tuple[str, ...] | Mapping[str, Vector]:
    """Names, or local coordinates by name; how many there have to be, the checks know."""
    if isinstance(value, Mapping):
        return _read_local(named_entries(value, read_name, limits.POINTS))
    if not isinstance(value, list | tuple):
        what = _('expected names ["A", "B"] or coordinates {{ A = [x, y] }}, got {value}')
        raise Problem(what.format(value=shown(value)))
    return tuple(read_name(name) for name in entries(value, limits.POINTS))


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


class Frame(Part):
    """The fixed link.

    Attributes
    ----------
    points : mapping of name to (x, y) [m] or Placed
    """

    points: NamedPositions = FrozenMap({})

    @property
    def coordinates(self) -> Mapping[str, Vector]:
        """Coordinates [m] of every point; raises InputError for a point that is not placed yet."""
        return FrozenMap({name: _resolved(name, position) for name, position in self.points.items()})


def _resolved(name: str, position: Vector | Placed) -> Vector:
    if not isinstance(position, Placed):
        return position
    if position.at is None:
        raise InputError(
            f"[frame.points] {name}", _("the point is not placed yet"), _("give its coordinates")
        )
    return position.at


class Link(Part):
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
    centre_radius : float [m]
        On the sphere: how far the centre of mass is from the centre of the sphere.
    model : "ring and point mass"
        On the sphere: the inertia is that about the axis through the centre alone, and the mass is there.
    reference : two points
        On the sphere: the arc the angle is measured from.
    """

    points: Annotated[tuple[str, ...] | Mapping[str, Vector], PlainValidator(_read_points)] = ()
    length: PositiveLength | None = None
    angle: Angle | None = None
    mass: Annotated[float, quantity("mass", not_negative)] | None = None
    centre: Spot | None = None
    inertia: Annotated[Inertia, PlainValidator(read_inertia)] | None = None
    shape: Annotated[Shape, choice(*SHAPES)] | None = None
    radius: PositiveMetres | None = None
    centre_radius: Annotated[float, PlainValidator(lambda value: not_negative(value, "length"))] | None = None
    model: Annotated[Literal["ring and point mass"], choice(RING_AND_POINT)] | None = None
    reference: Annotated[tuple[Name, ...], listed(2)] | None = None

    @property
    def coordinates(self) -> Mapping[str, Vector]:
        """Local coordinates [m] of every point: (0, 0) and (length, 0) where two points are named."""
        if isinstance(self.points, Mapping):
            return self.points
        return FrozenMap(
            {name: (0.0 if i == 0 else self.length or 0.0, 0.0) for i, name in enumerate(self.points)}
        )
