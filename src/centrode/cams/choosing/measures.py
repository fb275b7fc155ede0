"""What a cam is judged by: contact stress, pressure angle, size, lift, the gap between prints, and the cusp."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from centrode.cams.choosing.tried import STEEPEST, Tried
from centrode.cams.contacts.line import Contact
from centrode.locale import mark

Array = NDArray[np.float64]

BLUNT = 0.98
"""Greatest curvature of the path times the roller's radius: at 1 the cam has a cusp."""
FLATTEST = 1e-6
"""Least curvature of the path times its radius: a law of the path is positive."""


@dataclass(frozen=True)
class Measure:
    """A number that a path has at each angle, or as a whole.

    Attributes
    ----------
    name : str
        As `[choose]` writes it.
    title, unit : str
        What it is, in English; its SI unit.
    least : bool
        The least value counts and is bounded from below, instead of the greatest from above.
    whole : bool
        It belongs to the path as a whole.
    of : callable
        Of paths (`Tried`) and contact: (angles, designs), or (1, designs) of the whole, or as many times the angles;
        multiplied by -1 if `least`.
    """

    name: str
    title: str
    unit: str
    of: Callable[[Tried, Contact | None], Array]
    least: bool = False
    whole: bool = False

    @property
    def sign(self) -> int:
        """+1 where small is good, -1 where great is."""
        return -1 if self.least else 1


def _stress(tried: Tried, contact: Contact | None) -> Array:
    """Greatest pressure of the line contact [Pa]; finite also where there is a cusp, so that a search gets away."""
    assert contact is not None
    bent = tried.roller_radius * tried.curvature
    gap = 1 + bent if contact.outer else 1 - bent
    held = np.maximum(gap, 0.5 * (1 - BLUNT)) * tried.roller_radius
    cosine = np.cos(np.clip(tried.gamma, -STEEPEST, STEEPEST))
    load = contact.force / (contact.width * cosine)
    return np.asarray(np.sqrt(load * contact.modulus / (math.pi * held)))


def _pressure_angle(tried: Tried, _contact: Contact | None) -> Array:
    """Both signs, one after the other: each of them is smooth, the magnitude has a kink at 0."""
    return np.concatenate([tried.gamma, -tried.gamma])


def _size(tried: Tried, _contact: Contact | None) -> Array:
    return tried.rho


def _lift(tried: Tried, _contact: Contact | None) -> Array:
    return -(tried.rho[-1:] - tried.rho[_zero(tried)])


def _gap(tried: Tried, _contact: Contact | None) -> Array:
    """Ground between the prints of two shoes: H' cos(phi) at the end of the working arc less that at its start."""
    held = np.clip(tried.gamma, -STEEPEST, STEEPEST)
    ahead = tried.rho * np.tan(held) * np.cos(tried.phi)[:, None]
    behind = -ahead[-1:] if tried.mirrored else ahead[:1]
    return np.asarray(behind - ahead[-1:])


def _sharp(tried: Tried, _contact: Contact | None) -> Array:
    return tried.roller_radius * tried.curvature


def _flat(tried: Tried, _contact: Contact | None) -> Array:
    return -tried.rho * tried.curvature


def _zero(tried: Tried) -> slice:
    at = int(np.argmin(np.abs(tried.phi)))
    return slice(at, at + 1)


_ALL = (
    Measure("stress", mark("contact stress"), "Pa", _stress),
    Measure("pressure_angle", mark("pressure angle"), "rad", _pressure_angle),
    Measure("size", mark("radius of the roller's path"), "m", _size),
    Measure("lift", mark("lift"), "m", _lift, least=True, whole=True),
    Measure("gap", mark("gap between prints"), "m", _gap, least=True, whole=True),
)

MEASURES: Mapping[str, Measure] = {measure.name: measure for measure in _ALL}
"""What may be bounded or be made best, by its name."""

ALWAYS: Mapping[str, tuple[Measure, float]] = {
    "sharp": (Measure("sharp", "", "1", _sharp), BLUNT),
    "flat": (Measure("flat", "", "1", _flat, least=True), FLATTEST),
    "steep": (Measure("steep", "", "rad", _pressure_angle), 0.95 * STEEPEST),
}
"""Bounds of every design: no cusp, a path that bends one way, a follower that does not jam."""
