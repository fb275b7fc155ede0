"""Counterweights on links: where they are measured from, what they add to the inertia, the description with them."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from centrode.dynamics.balancing.inertial import (
    Array,
    Complex,
    Effects,
    Pace,
    cross,
    orders,
    track,
)
from centrode.dynamics.balancing.making import Made, Making
from centrode.dynamics.masses import Mass
from centrode.dynamics.states import State
from centrode.model.mechanism import Link, Mechanism

PARAMETERS = 4
"""Mass, product of mass and radius along and across, inertia about the hinge: all that matters of a counterweight."""

ROUNDING = 2.0**-46
"""Share of a product that its component may have from rounding alone."""


@dataclass(frozen=True)
class Spot:
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


def counterweight(mechanism: Mechanism, spot: Spot, product: complex) -> Counterweight:
    """The counterweight of a product of mass and radius, as a vector in the link's axes [kg m]."""
    product = _straight(complex(product))
    made = spot.making.made(abs(product))
    x, y = mechanism.links[spot.link].coordinates[spot.base]
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


def columns_of(state: State, spot: Spot, pace: Pace, about: complex) -> Effects:
    """Effects of the PARAMETERS of a counterweight, each of size 1: rows (PARAMETERS, n)."""
    base, turn, angle = _motion(state, spot)
    carried, whirled = pace.second(base), pace.second(turn)
    angular = pace.second(angle)
    arm, first, second, rate = base[0] - about, base[1], base[2], pace.rate**2
    force, moment = [carried], [cross(arm, carried)]
    driving = [np.abs(first) ** 2 * pace.second_rate + (np.conj(first) * second).real * rate]
    for unit in (1.0, 1j):
        rotor = unit * turn
        force.append(unit * whirled)
        moment.append(cross(arm, unit * whirled) + cross(rotor[0], carried))
        driving.append(
            2.0 * (np.conj(first) * rotor[1]).real * pace.second_rate
            + (np.conj(second) * rotor[1] + np.conj(first) * rotor[2]).real * rate
        )
    force.append(np.zeros_like(carried))
    moment.append(angular)
    driving.append(angle[1] ** 2 * pace.second_rate + angle[1] * angle[2] * rate)
    return Effects(-np.array(force), -np.array(moment), np.array(driving))


def _motion(state: State, spot: Spot) -> tuple[Complex, Complex, Array]:
    """Place of the base, rotor and angle of the link, each (3, n)."""
    count = len(state.parameter)
    return (
        track(state.point(spot.base), count),
        track(state.rotor(spot.link), count),
        orders(state.angle(spot.link), count),
    )


def mass_moments(state: State, spot: Spot) -> tuple[Complex, Complex]:
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
    for one in counterweights:
        if one.mass > 0.0:
            links[one.link] = _heavier(links[one.link], own.get(one.link), one)
    return replaced(mechanism, links=links)


def replaced(mechanism: Mechanism, **parts: object) -> Mechanism:
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
    inertia += added.inertia + mass * abs(centre - middle) ** 2 + added.mass * abs(extra - middle) ** 2
    changes = {"mass": whole, "centre": (middle.real, middle.imag), "inertia": inertia}
    return link.model_copy(update={**changes, "shape": None, "radius": None})


def stiffened(link: Link, own: Mass | None, inertia: float) -> Link:
    """A link with so much more inertia; what its shape tells of it becomes numbers."""
    if own is None:
        return link.model_copy(update={"inertia": inertia})
    x, y = link.coordinates[own.planar_centre.base]
    changes: dict[str, object] = {"inertia": own.moment_of_inertia + inertia, "shape": None, "radius": None}
    if own.weighs:
        changes["centre"] = (x + own.planar_centre.along, y + own.planar_centre.across)
    return link.model_copy(update=changes)
