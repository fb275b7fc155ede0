"""Where parts rub on each other: bearings on the pins of hinges, sliders in guides."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import pi
from typing import Any, TypeAlias

from centrode.dynamics.coordinates import Slide, Turn
from centrode.errors import InputError, NotComputedYet
from centrode.locale import _
from centrode.model.loads import Load
from centrode.model.mechanism import FRAME, Mechanism

FITS = {"clearance": 1.0, "new": pi / 2.0, "worn-in": 4.0 / pi}
"""Moment of friction over coefficient, radius and load of the pin, by how the bearing fits."""


@dataclass(frozen=True)
class Bearing:
    """A link that turns on a pin; the pin is fixed in another body.

    Attributes
    ----------
    coefficient : of the moment, the fit in it
    where : what messages name it by
    """

    point: str
    link: str
    pin: str
    coefficient: float
    radius: float
    where: str

    @property
    def label(self) -> str:
        """Its name in results, that of the side."""
        return f"{self.point}/{self.link}"

    @property
    def pressed_by(self) -> tuple[str, ...]:
        """Reactions that its friction depends on."""
        return ("joint_force",)

    @property
    def motion(self) -> Turn:
        """What rubs: the link turns against the pin."""
        return Turn(self.link, self.pin)


@dataclass(frozen=True)
class Sliding:
    """A slider or a pin that moves along a guide.

    Attributes
    ----------
    link : the slider; None where the point itself slides
    length, height : of the slider along and across the guide [m]; 0 where they do not matter
    """

    guide: str
    link: str | None
    on: str
    coefficient: float
    length: float
    height: float
    where: str

    @property
    def label(self) -> str:
        """Its name in results."""
        return f"guide {self.guide}"

    @property
    def pressed_by(self) -> tuple[str, ...]:
        """Reactions that its friction depends on."""
        return ("guide_normal", "guide_moment") if self.length else ("guide_normal",)

    @property
    def motion(self) -> Slide:
        """What rubs: the displacement grows or falls."""
        return Slide(self.guide)


Contact: TypeAlias = Bearing | Sliding


def contacts_of(mechanism: Mechanism) -> tuple[Contact, ...]:
    """Contacts with friction by a coefficient, in the order of the loads.

    Raises InputError for a hinge that is none, a pin in a body that is not there, a slider that is no link, and for a
    contact that is given twice; NotComputedYet on the sphere.
    """
    found: dict[str, Contact] = {}
    for load in mechanism.loads:
        if load.coefficient is None:
            continue
        where = f"[[loads]] {load.label}"
        if mechanism.space == "sphere":
            what = _("friction by a coefficient on the sphere is not computed yet")
            raise NotComputedYet(where, what, _("give the size of the friction, or leave it out"))
        contacts = [_sliding(mechanism, load, where)] if load.guide else _bearings(mechanism, load, where)
        for contact in contacts:
            if contact.label in found:
                what = _("friction at {contact} is given twice").format(contact=contact.label)
                raise InputError(where, what, _("keep one of them"))
            found[contact.label] = contact
    return tuple(found.values())


def without_friction(mechanism: Mechanism) -> Mechanism:
    """The mechanism without friction by coefficients."""
    loads = tuple(load for load in mechanism.loads if load.coefficient is None)
    return mechanism.model_copy(update={"loads": loads})


def refuse_undetermined(
    contacts: Sequence[Contact], undetermined: Mapping[str, Any], sides: Sequence[Any], mechanism: Mechanism
) -> None:
    """Raise InputError where friction depends on a reaction that nothing determines.

    `undetermined` tells of each kind of reaction which entries that is, in the order of `sides` and guides.
    """
    labels = [side.label for side in sides]
    guides = [guide.id for guide in mechanism.guides]
    for contact in contacts:
        row = labels.index(contact.label) if isinstance(contact, Bearing) else guides.index(contact.guide)
        parts = contact.pressed_by
        if any(part in undetermined and undetermined[part][row].any() for part in parts):
            what = _("friction at {contact} depends on a reaction that the constraints do not determine")
            repair = _("leave out a constraint that repeats others, or the friction there")
            raise InputError(contact.where, what.format(contact=contact.label), repair)


def _sliding(mechanism: Mechanism, load: Load, where: str) -> Sliding:
    guide = mechanism.guide(load.guide or "")
    if guide.link is None and (load.length or load.height):
        what = _("guide {guide} has no slider of its own that could tilt").format(guide=guide.id)
        raise InputError(where, what, _("take length and height out, or give the guide a link"))
    coefficient, length, height = load.coefficient or 0.0, load.length or 0.0, load.height or 0.0
    return Sliding(guide.id, guide.link, guide.on, coefficient, length, height, where)


def _bearings(mechanism: Mechanism, load: Load, where: str) -> list[Bearing]:
    point = load.point or ""
    bodies = _bodies(mechanism, point)
    if len(bodies) < 2:
        what = _("nothing turns at the point {point}: it is no hinge").format(point=point)
        raise InputError(where, what, _("name a point in which links are hinged together"))
    for key, name in (("link", load.link), ("pin", load.pin)):
        if name is not None and name not in bodies:
            what = _("{key} {name} has no hinge in {point}").format(key=key, name=name, point=point)
            raise InputError(where, what, _("use one of {known}").format(known=", ".join(bodies)))
    carrier = _carrier(mechanism, point)
    pin = load.pin or carrier or bodies[0]
    if carrier not in (None, pin):
        text = _("the pin {point} is fixed in the frame")
        text = (
            text
            if point in mechanism.frame.points
            else _("the pin {point} is fixed in the slider of its guide")
        )
        raise InputError(where, text.format(point=point), _("take pin out"))
    links = [name for name in bodies if name != pin]
    if load.link is not None:
        if load.link == pin:
            what = _("the pin {point} is fixed in {link}, which therefore does not rub on it")
            raise InputError(
                where, what.format(point=point, link=pin), _("name another link, or another pin")
            )
        links = [load.link]
    coefficient = (load.coefficient or 0.0) * FITS[load.fit]
    return [Bearing(point, link, pin, coefficient, load.radius or 0.0, where) for link in links]


def _bodies(mechanism: Mechanism, point: str) -> list[str]:
    """What is hinged in a point: the frame, or what carries the guide of a slider without a link; then links."""
    links = [name for name, link in mechanism.links.items() if point in link.coordinates]
    carrier = _carrier(mechanism, point)
    return links if carrier is None else [carrier, *(name for name in links if name != carrier)]


def _carrier(mechanism: Mechanism, point: str) -> str | None:
    """The body that a pin cannot turn against: the frame, or that of the guide in which its slider moves."""
    if point in mechanism.frame.points:
        return FRAME
    return next((guide.on for guide in mechanism.guides if guide.point == point and not guide.link), None)
