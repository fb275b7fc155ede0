"""How a cam is made: the path of a cutter's centre, and points whose chords keep a tolerance."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from centrode.cams.followers.bodies import FollowerCam
from centrode.cams.followers.contact import Array, Contact, Face
from centrode.cams.nodes import inside
from centrode.errors import InputError
from centrode.locale import _

LEAST_SPACES = 8
"""Least number of spaces between the points of a piece."""
UNCOUNTED = 1e12
"""Points beyond which they are not counted."""
MOST_POINTS = 200_000
FINE = 64
"""Places of the first mesh of a piece for one that it needs at least."""
SAFE = 0.9
"""Share of a tolerance that points are dealt by; then they are checked."""


def cutter_centres(contact: Contact, radius: float) -> Array:
    """Centres (n, 2) [m] of a cutter of a radius [m] that touches the profile at contacts, in the cam's axes."""
    return contact.place + radius * contact.normal


def cutter_speed(cam: FollowerCam, contact: Contact, radius: float) -> Array:
    """ds/dphi (n) [m/rad] of the cutter's centre; negative where it would run back."""
    if isinstance(cam.touch, Face):
        return contact.pace * (contact.bend + radius)
    return contact.pace * (1.0 + (radius - cam.touch.roller) * contact.path_curvature)


def check_cutter(cam: FollowerCam, radius: float) -> None:
    """Raise InputError where a cutter is larger than a hollow of the profile; the greatest that fits is told."""
    most, at = cam.greatest_cutter
    if radius <= most:
        return
    what = _("a cutter of {radius:.6g} mm cuts away the hollow at {at:.6g} deg")
    fits = (
        _("take one of at most {most:.6g} mm")
        if most > 0.0
        else _("no cutter comes into a sharp inner corner")
    )
    raise InputError(
        "[tool] radius", what.format(radius=1e3 * radius, at=math.degrees(at)), fits.format(most=1e3 * most)
    )


def chord_pieces(cam: FollowerCam, tolerance: float, cutter: float = 0.0) -> list[Array]:
    """Angles [rad] of each piece between edges, so that chords keep a tolerance.

    Parameters
    ----------
    tolerance : float [m]
        By how much a chord between neighbouring points may depart from the profile, from the path of the roller's
        centre and from that of the cutter's.
    cutter : float [m]
        Its radius.

    Raises
    ------
    InputError
        It would take too many points.
    """
    pieces = [_dealt(cam, start, stop, tolerance, cutter) for start, stop in pairwise(cam.edges)]
    count = sum(len(one) for one in pieces)
    if count > MOST_POINTS:
        what = _("a chord tolerance of {tolerance:.3g} mm asks for {count} points, {most} are the most")
        told = what.format(tolerance=1e3 * tolerance, count=count, most=MOST_POINTS)
        raise InputError("[study] chord_tolerance", told, _("make it greater"))
    return pieces


def _dealt(cam: FollowerCam, start: float, stop: float, tolerance: float, cutter: float) -> Array:
    """A chord over a turn t of the tangent on a way s departs by s t/8: points are dealt by sqrt(ds dt/8)."""
    first, last = inside(start, stop)
    fine = np.linspace(first, last, 1 + FINE * LEAST_SPACES)
    contact = cam.contact(fine)
    ways = [np.abs(contact.speed), np.hypot(*np.gradient(contact.centre, fine, axis=0).T)]
    if cutter:
        ways.append(np.abs(cutter_speed(cam, contact, cutter)))
    turning = np.abs(np.gradient(np.unwrap(contact.normal_angle), fine))
    density = np.sqrt(np.max(ways, axis=0) * turning / (8.0 * SAFE * tolerance))
    needed = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(fine))])
    if needed[-1] > MOST_POINTS:
        # only their number is wanted: it takes no memory
        return np.broadcast_to(fine[:1], (math.ceil(min(needed[-1], UNCOUNTED)),))
    # an even share keeps stretches that need next to nothing from being left without points
    even = LEAST_SPACES * (fine - first) / (last - first)
    shares = needed + even
    count = math.ceil(shares[-1])
    found = np.interp(np.linspace(0.0, shares[-1], count + 1), shares, fine)
    found[[0, -1]] = first, last
    return found
