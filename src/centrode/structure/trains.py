"""Finding what gears and rolling wheels form in a group: angles that follow one another, loci, trains."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import Mechanism, Rolling
from centrode.structure.bevels import shares_of
from centrode.structure.constraints import AngleDrive, Constraint, NoTurning, PointInLink
from centrode.structure.gear_ratios import GearRatio
from centrode.structure.positions import FRAME
from centrode.structure.wheel_groups import (
    AngleEquation,
    AngleGiven,
    Arm,
    Following,
    Meshed,
    Rolled,
    Rolloff,
    Touch,
    Train,
    angles_in,
)
from centrode.structure.wheels import Contact, NoSlip

SINGULAR = 1e-9
"""A pivot smaller than this, beside ratios of the order of one, means that the angles do not follow."""
COINCIDE = 1e-12
"""Coordinates closer than this part of their size are those of one place."""


class Unsolved(Protocol):
    """A group before it is classified."""

    @property
    def mechanism(self) -> Mechanism: ...
    @property
    def points(self) -> tuple[str, ...]: ...
    @property
    def links(self) -> tuple[str, ...]: ...
    @property
    def constraints(self) -> tuple[Constraint, ...]: ...
    def ends(self, link: str) -> tuple[str, ...]: ...
    def knows_point(self, point: str) -> bool: ...
    def knows_link(self, link: str) -> bool: ...


def following(group: Unsolved, constraint: Constraint, link: str) -> Following | None:
    """How a gear or a rolling contact gives the angle of a link from what is known; None if it does not."""
    if isinstance(constraint, GearRatio) and link in constraint.links:
        if not all(group.knows_link(other) for other in constraint.links if other != link):
            return None
        first, second = shares_of(group.mechanism, constraint.gear)
        if link == constraint.carrier and _ratio(group.mechanism, constraint) * first == second:
            raise _singular((link,))
        return Meshed(constraint)
    if isinstance(constraint, NoSlip) and link == constraint.link:
        known = group.knows_point(constraint.centre) and group.knows_link(constraint.on)
        return Rolled(constraint) if known else None
    return None


def wheel_locus(group: Unsolved, constraint: Constraint, carriage: str | None) -> Touch | Rolloff | None:
    """The locus that a contact or a rolling contact is for the unknown vector of a group; None if it is none."""
    if not isinstance(constraint, (Contact, NoSlip)):
        return None
    straight = _description(group.mechanism, constraint.rolling).along.radius is None
    centre_known = group.knows_point(constraint.centre)
    carried = constraint.on == carriage
    if carried != centre_known or not (carried or group.knows_link(constraint.on)):
        return None
    if isinstance(constraint, Contact):
        return Touch(constraint.centre, constraint, carried, "P" if straight else "R")
    turns_known = constraint.link == carriage or group.knows_link(constraint.link)
    return Rolloff(constraint.centre, constraint, carried) if straight and turns_known else None


def train(group: Unsolved) -> Train | None:
    """A group whose angles follow from equations between them alone; its links then only have to be placed."""
    hinges = [c for c in group.constraints if isinstance(c, PointInLink)]
    others = [c for c in group.constraints if not isinstance(c, PointInLink)]
    equations = [equation_of(group, c) for c in others]
    if len(equations) != len(group.links) or len(equations) < 2 or None in equations:
        return None
    found = tuple(equation for equation in equations if equation is not None)
    placed = _placed(group, hinges)
    if placed is None:
        return None
    return Train(found, _pivots(group, found), *placed)


def equation_of(group: Unsolved, constraint: Constraint) -> AngleEquation | None:
    """The equation between angles that a constraint of a group is; None if it is none."""
    if isinstance(constraint, AngleDrive):
        return AngleGiven(constraint.link, constraint.relative_to, drive=constraint.drive)
    if isinstance(constraint, NoTurning):
        return AngleGiven(constraint.link, constraint.on, guide=constraint.guide)
    if isinstance(constraint, GearRatio):
        return constraint
    if isinstance(constraint, NoSlip):
        if group.knows_point(constraint.centre) and group.knows_link(constraint.on):
            return constraint
        return _arm(group.mechanism, constraint)
    return None


def _arm(mechanism: Mechanism, rolling: NoSlip) -> Arm | None:
    """The link that carries a wheel around the circle it rolls on, if one turns about the circle's centre."""
    pivot = _named_centre(mechanism, _description(mechanism, rolling.rolling))
    for name, link in mechanism.links.items():
        if pivot in link.coordinates and rolling.centre in link.coordinates and name != rolling.on:
            return Arm(rolling, name, pivot or "")
    return None


def _named_centre(mechanism: Mechanism, wheel: Rolling) -> str | None:
    """The point of the wheel's track that is its circle's centre, where one has a name."""
    along = wheel.along
    if along.radius is None or isinstance(along.centre, str):
        return along.centre if isinstance(along.centre, str) else None
    x, y = along.centre or (0.0, 0.0)
    near = COINCIDE * (abs(x) + abs(y) + along.radius)
    for name, (px, py) in mechanism.points_of(wheel.on).items():
        if abs(px - x) <= near and abs(py - y) <= near:
            return name
    return None


def _placed(
    group: Unsolved, hinges: Sequence[PointInLink]
) -> tuple[tuple[tuple[str, str], ...], tuple[tuple[str, str], ...]] | None:
    """Each link with its known point in an order of placing, and each point with the link that brings it."""
    places: list[tuple[str, str]] = []
    brought: dict[str, str] = {}
    waiting = list(group.links)
    while waiting:
        for link in waiting:
            own = [c.point for c in hinges if c.link == link]
            known = [point for point in own if group.knows_point(point) or point in brought]
            if len(known) > 1:
                return None
            if known:
                places.append((link, known[0]))
                brought |= {point: link for point in own if point != known[0]}
                waiting.remove(link)
                break
        else:
            return None
    # points that no link of the group brings would hang on something else
    if set(brought) != set(group.points) or any(c.link not in group.links for c in hinges):
        return None
    return tuple(places), tuple(brought.items())


def _pivots(group: Unsolved, equations: Sequence[AngleEquation]) -> tuple[tuple[int, str], ...]:
    """Order of elimination by the description's own ratios: the greatest factor first."""
    rows = [_weights(group.mechanism, equation) for equation in equations]
    table = [{link: row.get(link, 0.0) for link in group.links} for row in rows]
    found: list[tuple[int, str]] = []
    for _step in group.links:
        rest = [
            (abs(table[i][link]), -i, link)
            for i in range(len(table))
            for link in group.links
            if all(i != row and link != column for row, column in found)
        ]
        size, k, link = max(rest, key=lambda entry: entry[:2])
        if size < SINGULAR:
            raise _singular(group.links)
        found.append((-k, link))
        for i in range(len(table)):
            if all(i != row for row, _column in found):
                share = table[i][link] / table[-k][link]
                table[i] = {name: x - share * table[-k][name] for name, x in table[i].items()}
    return tuple(found)


def _weights(mechanism: Mechanism, equation: AngleEquation) -> Mapping[str, float]:
    """Link -> factor of its angle, with the numbers of the description."""
    if isinstance(equation, GearRatio):
        ratio = _ratio(mechanism, equation)
        first, second = shares_of(mechanism, equation.gear)
        return {equation.first: -ratio, equation.second: 1.0, equation.carrier: ratio * first - second}
    if isinstance(equation, Arm):
        spin = _spin(_description(mechanism, equation.rolling.rolling))
        return {equation.rolling.link: 1.0, equation.rolling.on: spin - 1.0, equation.link: -spin}
    if mechanism.space == "sphere":
        return {equation.link: 1.0}
    return dict(zip(angles_in(equation), (1.0, -1.0), strict=True))


def _ratio(mechanism: Mechanism, gear: GearRatio) -> float:
    return next(other.ratio for other in mechanism.gears if other.id == gear.gear)


def _description(mechanism: Mechanism, rolling: str) -> Rolling:
    return next(wheel for wheel in mechanism.rolling if wheel.id == rolling)


def _spin(wheel: Rolling) -> float:
    circle = wheel.along.radius or 0.0
    return (wheel.radius - circle if wheel.along.inside else wheel.radius + circle) / wheel.radius


def _singular(links: Sequence[str]) -> InputError:
    return InputError(
        _("gears of {links}").format(links=", ".join(link for link in links if link != FRAME)),
        _("they lock each other or leave an angle open: their equations do not give every angle"),
        _("change a ratio, or drive another link"),
    )
