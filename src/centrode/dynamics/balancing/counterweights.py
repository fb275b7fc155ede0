"""Counterweights on links: where they are measured from, what they add to the inertia, the description with them."""

from __future__ import annotations

import cmath
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import dist, pi
from typing import TypeAlias

import numpy as np

from centrode.dynamics.balancing.shaking_forces import (
    Array,
    Complex,
    Effects,
    ShaftMotion,
    cross,
    orders,
    track,
)
from centrode.dynamics.state import Mass, State
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import Link, Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.units import read_quantity

# How counterweights are made: mass, radius and inertia that go with a product of mass and radius.

STEEL = 7800.0
"""Density [kg/m^3] where none is given."""
LEAST = 1e-12
"""Share of the greatest product below which slopes are those there: the root of a disc's size has none at zero."""


@dataclass(frozen=True)
class Made:
    """A counterweight of one product of mass and radius.

    Attributes
    ----------
    mass : float [kg]
    radius : float [m]
        Distance of its centre from the hinge it is measured from.
    inertia : float [kg m^2]
        About its own centre.
    mass_slope, inertia_slope : float [1/m], [m]
        Derivatives of the mass, and of the inertia about the hinge, by the product.
    """

    mass: float
    radius: float
    inertia: float
    mass_slope: float
    inertia_slope: float

    @property
    def about_hinge(self) -> float:
        """Moment of inertia about the hinge [kg m^2]."""
        return self.inertia + self.mass * self.radius**2


@dataclass(frozen=True)
class Making:
    """Make of one counterweight.

    Attributes
    ----------
    radius : float or None [m]
        Distance of its centre from the hinge; None for a disc whose edge passes through the hinge, which has the
        least inertia of all discs of one product.
    thickness : float or None [m]
        Of a disc; None for a mass in one point.
    density : float [kg/m^3]
    most : float or None [kg]
        Greatest mass.
    """

    radius: float | None
    thickness: float | None = None
    density: float = STEEL
    most: float | None = None

    @property
    def sheet(self) -> float:
        """Mass of a disc over the square of its radius [kg/m^2]."""
        return pi * self.density * (self.thickness or 0.0)

    def counterweight_for(self, product: float, floor: float = 0.0) -> Made:
        """The counterweight of a product of mass and radius [kg m]; slopes are those at `floor` if it is less."""
        if self.radius is not None:
            mass, slope, inertia = product / self.radius, self.radius, 0.0
            if self.thickness is not None:
                # m r^2 / 2 with r^2 = m / sheet
                inertia = 0.5 * mass**2 / self.sheet
                # the inertia about the hinge is s R + s^2 / (2 sheet R^2), of the product s: its derivative
                slope += mass / (self.sheet * self.radius)
            return Made(mass, self.radius, inertia, 1.0 / self.radius, slope)
        # a disc touching its hinge: product = sheet radius^3
        radius = (product / self.sheet) ** (1 / 3)
        smooth = (max(product, floor) / self.sheet) ** (1 / 3)
        # from here on: mass sheet r^2, inertia about the hinge 3/2 m r^2; by the product 2 / (3 r) and 2 r
        mass = self.sheet * radius**2
        return Made(mass, radius, 0.5 * mass * radius**2, 2 / (3 * smooth) if smooth else 0.0, 2.0 * smooth)

    @property
    def greatest(self) -> float | None:
        """Greatest product of mass and radius [kg m]; None without a greatest mass."""
        if self.most is None:
            return None
        if self.radius is not None:
            return self.most * self.radius
        return float(self.sheet * (self.most / self.sheet) ** 1.5)

    def disc(self, made: Made) -> float | None:
        """Radius of the disc [m]; None of a mass in one point."""
        return None if self.thickness is None else (made.mass / self.sheet) ** 0.5


PARAMETERS = 4
"""Mass, product of mass and radius along and across, inertia about the hinge: all that matters of a counterweight."""

ROUNDING = 2.0**-46
"""Share of a product that its component may have from rounding alone."""


@dataclass(frozen=True)
class CounterweightPlace:
    """A place for a counterweight: a link, and the point of it that its radius is measured from."""

    link: str
    base: str
    making: Making
    fixed: bool
    """Whether the point is one of the frame's: then the mass alone does nothing."""


@dataclass(frozen=True)
class Counterweight:
    """A counterweight on a link.

    Attributes
    ----------
    link, base : the link, and the point of it that the radius is measured from
    mass [kg], radius [m]
    angle : float [rad]
        Of its place from the base, from the link's x axis.
    place : (x, y) [m]
        Its centre in the link's own axes.
    inertia : float [kg m^2]
        About its own centre.
    disc : float or None [m]
        Its radius if it is a disc; None for a mass in one point.
    """

    link: str
    base: str
    mass: float
    radius: float
    angle: float
    place: tuple[float, float]
    inertia: float
    disc: float | None

    @property
    def product(self) -> float:
        """Product of mass and radius [kg m]."""
        return self.mass * self.radius


def counterweight(mechanism: Mechanism, spot: CounterweightPlace, product: complex) -> Counterweight:
    """The counterweight of a product of mass and radius, as a vector in the link's axes [kg m]."""
    # rounding beside an axis would turn the counterweight by a visible hair in a drawing
    product = _straight(complex(product))
    made = spot.making.counterweight_for(abs(product))
    x, y = mechanism.links[spot.link].coordinates[spot.base]
    # without a product any direction will do
    at = complex(x, y) + made.radius * (product / abs(product) if product else 1.0)
    return Counterweight(
        spot.link,
        spot.base,
        made.mass,
        made.radius,
        cmath.phase(product),
        (at.real, at.imag),
        made.inertia,
        spot.making.disc(made),
    )


def _straight(product: complex) -> complex:
    """A product along an axis of its link without the rounding beside it."""
    x, y = product.real, product.imag
    noise = ROUNDING * abs(product)
    return complex(x if abs(x) > noise else 0.0, y if abs(y) > noise else 0.0)


def columns_of(state: State, spot: CounterweightPlace, pace: ShaftMotion, about: complex) -> Effects:
    """Effects of the PARAMETERS of a counterweight, each of size 1: rows (PARAMETERS, n)."""
    base, turn, angle = _motion(state, spot)
    # second derivatives by time: of the base, of the rotor, of the angle
    carried, whirled = pace.second(base), pace.second(turn)
    angular = pace.second(angle)
    arm, first, second, rate = base[0] - about, base[1], base[2], pace.rate**2
    force, moment = [carried], [cross(arm, carried)]
    # J q'' + J' q'^2 / 2 with J = |b'|^2 of a unit mass at the base b
    driving = [np.abs(first) ** 2 * pace.second_rate + (np.conj(first) * second).real * rate]
    # a unit product of mass and radius along the link, then across it: products are linear in the rotor
    for unit in (1.0, 1j):
        rotor = unit * turn
        force.append(unit * whirled)
        # the moment of the whirled mass about the place, and that of the carried base about the mass
        moment.append(cross(arm, unit * whirled) + cross(rotor[0], carried))
        # twice the scalar product of the base's and the rotor's rates: J is |b' + r'|^2
        driving.append(
            2.0 * (np.conj(first) * rotor[1]).real * pace.second_rate
            + (np.conj(second) * rotor[1] + np.conj(first) * rotor[2]).real * rate
        )
    # inertia alone pushes nothing
    force.append(np.zeros_like(carried))
    moment.append(angular)
    driving.append(angle[1] ** 2 * pace.second_rate + angle[1] * angle[2] * rate)
    # on the frame acts what the bodies do not get: the reaction
    return Effects(-np.array(force), -np.array(moment), np.array(driving))


def _motion(state: State, spot: CounterweightPlace) -> tuple[Complex, Complex, Array]:
    """Place of the base, rotor and angle of the link, each (3, n)."""
    count = len(state.parameter)
    return (
        track(state.point(spot.base), count),
        track(state.rotor(spot.link), count),
        orders(state.angle(spot.link), count),
    )


def mass_moments(state: State, spot: CounterweightPlace) -> tuple[Complex, Complex]:
    """Place of the base and the link's rotor (n): what mass and product give to the sum of mass times place."""
    base, turn, _angle = _motion(state, spot)
    return base[0], turn[0]


def parameters(made: Made, product: complex) -> Array:
    """The PARAMETERS of a counterweight."""
    return np.array([made.mass, product.real, product.imag, made.about_hinge])


def with_counterweights(
    mechanism: Mechanism, masses: Sequence[Mass], counterweights: Sequence[Counterweight]
) -> Mechanism:
    """The description with counterweights in the masses, centres and inertias of their links."""
    own = {mass.link: mass for mass in masses}
    links = dict(mechanism.links)
    for counterweight in counterweights:
        if counterweight.mass > 0.0:
            links[counterweight.link] = _heavier(
                links[counterweight.link], own.get(counterweight.link), counterweight
            )
    return replace_parts(mechanism, links=links)


def replace_parts(mechanism: Mechanism, **parts: object) -> Mechanism:
    """The description with other parts, checked anew."""
    return Mechanism(**{name: getattr(mechanism, name) for name in type(mechanism).model_fields} | parts)


def _heavier(link: Link, own: Mass | None, added: Counterweight) -> Link:
    extra = complex(*added.place)
    mass, centre, inertia = 0.0, extra, 0.0
    if own is not None:
        at = own.planar_centre
        x, y = link.coordinates[at.base]
        mass, inertia = own.mass, own.moment_of_inertia
        centre = complex(x + at.along, y + at.across) if own.weighs else extra
    whole = mass + added.mass
    middle = (mass * centre + added.mass * extra) / whole
    # both bodies' inertia about the common centre (Steiner)
    inertia += added.inertia + mass * abs(centre - middle) ** 2 + added.mass * abs(extra - middle) ** 2
    changes = {"mass": whole, "centre": (middle.real, middle.imag), "inertia": inertia}
    return link.model_copy(update={**changes, "shape": None, "radius": None, "masses": ()})


def add_inertia(link: Link, own: Mass | None, inertia: float) -> Link:
    """A link with so much more inertia; what its shape tells of it becomes numbers."""
    if own is None:
        return link.model_copy(update={"inertia": inertia})
    x, y = link.coordinates[own.planar_centre.base]
    changes: dict[str, object] = {
        "inertia": own.moment_of_inertia + inertia,
        "shape": None,
        "radius": None,
        "masses": (),
    }
    if own.weighs:
        changes["centre"] = (x + own.planar_centre.along, y + own.planar_centre.across)
    return link.model_copy(update=changes)


# Which links hinges alone join to the frame, and where counterweights on them are measured from.
#
# By the theorem of contours a linkage can be balanced fully by counterweights only if every link is reached
# from the frame by a way through hinges alone (F. R. Tepper, G. G. Lowen, Journal of Engineering for Industry
# 94, 1972, 789-796).


def hinged_from(mechanism: Mechanism) -> Mapping[str, str]:
    """Links reached by hinges alone, nearest to the frame first, each with the point by which it is reached."""
    bodies = {name: tuple(link.coordinates) for name, link in mechanism.links.items()}
    known = set(mechanism.frame.points)
    reached: dict[str, str] = {}
    while True:
        hinges = {
            name: next(point for point in points if point in known)
            for name, points in bodies.items()
            if name not in reached and known & set(points)
        }
        if not hinges:
            return reached
        reached |= hinges
        known |= {point for name in hinges for point in bodies[name]}


def base_of(mechanism: Mechanism, link: str) -> str:
    """The point that the radius of a counterweight is measured from, where nothing else is said."""
    return hinged_from(mechanism).get(link) or next(iter(mechanism.links[link].coordinates))


def on_frame(mechanism: Mechanism) -> list[str]:
    """Links that are hinged to the frame."""
    return [name for name, base in hinged_from(mechanism).items() if base in mechanism.frame.points]


# The counterweights that are requested: on which links, measured from where, how made.

Lengths: TypeAlias = float | str | Mapping[str, float | str] | None
Masses: TypeAlias = float | str | Mapping[str, float | str] | None
MOST_COUNTERWEIGHTS = 20


def asked_spots(
    mechanism: Mechanism,
    on: Sequence[str] | None,
    to: str,
    radius: Lengths,
    most: Masses,
    thickness: float | str | None,
    density: float | str,
) -> list[CounterweightPlace]:
    """Places for counterweights, in the order they were named."""
    places = _places(mechanism, on, to)
    if on is None and radius is None and thickness is None:  # one point tells no radius: sliders, wheels
        places = [(link, base) for link, base in places if len(mechanism.links[link].coordinates) > 1]
    links = [link for link, _base in places]
    radii = _by_link(radius, links, "radius", "length")
    heaviest = _by_link(most, links, "most", "mass")
    thick = None if thickness is None else positive(thickness, "thickness", "length")
    dense = positive(density, "density", "density")
    spots = []
    for link, base in places:
        out = radii.get(link)
        if out is None and thick is None:
            out = _half_way(mechanism, link, base)
        making = Making(out, thick, dense, heaviest.get(link))
        spots.append(CounterweightPlace(link, base, making, base in mechanism.frame.points))
    return spots


def number(value: object, where: str, kind: str) -> float:
    """A number in SI of a number or a text with a unit; InputError about `where`."""
    return read_quantity(value, kind, where)


def positive(value: object, where: str, kind: str) -> float:
    """A number in SI greater than zero, of a number or a text with a unit; InputError about `where`."""
    given = number(value, where, kind)
    if not given > 0.0:
        raise InputError(where, _("it must be positive, got {value}").format(value=value_text(value)))
    return given


def _places(mechanism: Mechanism, on: Sequence[str] | None, to: str) -> list[tuple[str, str]]:
    """Links with the points that radii are measured from."""
    if on is None:
        hinged = hinged_from(mechanism)
        chosen = {
            name: base for name, base in hinged.items() if to == "full" or base in mechanism.frame.points
        }
        if to == "fraction":
            chosen = {name: base for name, base in chosen.items() if name == mechanism.drives[0].link}
        if not chosen:
            what = _("no link is hinged to the frame; by default counterweights are placed on such links")
            raise InputError("on", what, _("name links"))
        return list(chosen.items())
    names = [on] if isinstance(on, str) else list(on)
    if not names or len(names) > MOST_COUNTERWEIGHTS:
        what = _("{count} links were named").format(count=len(names))
        raise InputError("on", what, _("name 1 to {most}").format(most=MOST_COUNTERWEIGHTS))
    places = [_place(mechanism, name) for name in names]
    links = [link for link, _base in places]
    twice = next((link for link in links if links.count(link) > 1), None)
    if twice is not None:
        raise InputError(
            "on", _("{name} is given twice").format(name=value_text(twice)), _("keep one of them")
        )
    return places


def _place(mechanism: Mechanism, name: str) -> tuple[str, str]:
    link, sign, base = (part.strip() for part in str(name).partition("@"))
    if link not in mechanism.links:
        what = _("there is no link {name}").format(name=value_text(link))
        raise InputError("on", what, nearest(link, list(mechanism.links)))
    points = list(mechanism.links[link].coordinates)
    if sign and base not in points:
        what = _("link {link} has no point {name}").format(link=value_text(link), name=value_text(base))
        raise InputError("on", what, nearest(base, points))
    return link, base or base_of(mechanism, link)


def _by_link(given: Lengths | Masses, links: Sequence[str], where: str, kind: str) -> dict[str, float]:
    """A number for each link that has one."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        one = positive(given, where, kind)
        return dict.fromkeys(links, one)
    for link in given:
        if link not in links:
            what = _("there is no counterweight on {name}").format(name=value_text(link))
            raise InputError(where, what, nearest(str(link), list(links)))
    return {link: positive(value, f"{where} {link}", kind) for link, value in given.items()}


def _half_way(mechanism: Mechanism, link: str, base: str) -> float:
    """Half the distance to the farthest point of a link."""
    places = mechanism.links[link].coordinates
    out = 0.5 * max(dist(places[base], place) for place in places.values())
    if not out > 0.0:
        what = _("link {name} has one point, which does not define a radius").format(name=value_text(link))
        raise InputError("radius", what, _("give the radius of its counterweight"))
    return out
