"""Outlines of a plate cam: its profile, the path of the roller's centre, that of a cutter, with their corners."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from centrode.cams.followers.bodies import Corner, FollowerCam
from centrode.cams.followers.contact import Array, Contact, Face
from centrode.cams.followers.cutting import LEAST_SPACES, check_cutter, chord_pieces, cutter_speed
from centrode.cams.nodes import inside
from centrode.cams.profiles.outlines import Layer, Outline


@dataclass(frozen=True)
class _Layer:
    """A curve along with the profile: its distance from it [m] outwards."""

    name: Layer
    away: float


def follower_outlines(
    cam: FollowerCam, tolerance: float = 1e-6, cutter: float | None = None
) -> list[Outline]:
    """The profile, the path of a roller's centre and that of a cutter's, each in smooth pieces end to end.

    Parameters
    ----------
    tolerance : float [m]
        By how much a chord between neighbouring points may depart from the curve.
    cutter : float [m]
        Radius of a cutter or grinding wheel.

    Raises
    ------
    InputError
        The cutter is larger than a hollow; a tolerance that asks for too many points.

    Notes
    -----
    At a hollow corner of the path the roller's own arc joins both sides, at a step under a flat face a straight line,
    about an outward corner of the profile the cutter's arc. What a follower cuts away is drawn with its loop.
    """
    layers = [_Layer("profile", 0.0)]
    if not isinstance(cam.touch, Face) and cam.touch.roller > 0.0:
        layers.append(_Layer("path", cam.touch.roller))
    if cutter is not None:
        check_cutter(cam, cutter)
        layers.append(_Layer("cutter", cutter))
    corners = {one.at: one for one in cam.corners}
    pieces = chord_pieces(cam, tolerance, cutter or 0.0)
    found: list[Outline] = []
    for layer in layers:
        for (start, _stop), phi in zip(pairwise(cam.edges), pieces, strict=True):
            if start in corners:
                found += _corner(cam, corners[start], layer, tolerance)
            contact = cam.contact(phi)
            places = contact.place + layer.away * contact.normal
            speed = cutter_speed(cam, contact, layer.away)
            found.append(Outline(layer.name, phi, places, speed[:, None] * contact.tangent, contact.normal))
    return found


def _corner(cam: FollowerCam, corner: Corner, layer: _Layer, tolerance: float) -> Iterator[Outline]:
    """What joins both sides of a corner, where they part."""
    before = _before(cam, corner.at)
    if corner.step > 0.0:
        start = before.place[0] + layer.away * before.normal[0]
        along = np.linspace(0.0, corner.step, LEAST_SPACES + 1)
        slopes = np.broadcast_to(before.tangent[0], (len(along), 2))
        places = start + along[:, None] * slopes
        normals = np.broadcast_to(before.normal[0], slopes.shape)
        size = cam.base_radius
        yield Outline(layer.name, corner.at + along / size, places, size * slopes, normals)
    # seen from the roller's centre, about which the normal turns
    distance = layer.away - (0.0 if isinstance(cam.touch, Face) else cam.touch.roller)
    if distance * corner.turn > 0.0:
        size = abs(corner.turn)
        step = math.sqrt(8.0 * tolerance / abs(distance))
        turned = np.linspace(0.0, size, 1 + max(LEAST_SPACES, math.ceil(size / step)))
        sense = cam.sense * math.copysign(1.0, corner.turn)
        normal = before.normal_angle[0] + sense * turned
        outwards = np.stack([np.sin(normal), np.cos(normal)], axis=-1)
        along = np.stack([np.cos(normal), -np.sin(normal)], axis=-1)
        places = before.centre[0] + distance * outwards
        yield Outline(layer.name, corner.at + turned, places, sense * distance * along, outwards)


def _before(cam: FollowerCam, at: float) -> Contact:
    """The contact just before a joint; before phi = 0 that at the end of the turn."""
    end = cam.edges[-1] if at == cam.edges[0] else at
    return cam.contact(np.array([inside(cam.edges[0], end)[1]]))


def joined(outlines: list[Outline], layer: Layer) -> Array:
    """All points (n, 2) [m] of a layer in their order, those where pieces meet once."""
    found: list[Array] = []
    for one in outlines:
        if one.layer == layer:
            found.append(one.places if not found else one.places[1:])
    return np.concatenate(found)
