"""How a cam is made: the path of a cutter's centre, and points whose chords keep a tolerance."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr

from centrode.cams.followers.base_circle import follower_cam
from centrode.cams.followers.geometry import Array, Face, FollowerCam, FollowerContact, LiftCorner
from centrode.cams.nodes import inside
from centrode.cams.profiles import Layer
from centrode.errors import InputError
from centrode.kinematics.motion import Variable, vocabulary_variable
from centrode.locale import _
from centrode.model.cam_files import AnyCam, cam_text, with_follower
from centrode.numerics.outline_pieces import OutlinePiece

LEAST_SPACES = 8
"""Least number of spaces between the points of a piece."""
UNCOUNTED = 1e12
"""Points beyond which they are not counted."""
MOST_POINTS = 200_000
FINE = 64
"""Places of the first mesh of a piece for one that it needs at least."""
SAFE = 0.9
"""Share of a tolerance that points are dealt by; then they are checked."""


def cutter_centres(contact: FollowerContact, radius: float) -> Array:
    """Centres (n, 2) [m] of a cutter of a radius [m] that touches the profile at contacts, in the cam's axes."""
    return contact.place + radius * contact.normal


def cutter_speed(cam: FollowerCam, contact: FollowerContact, radius: float) -> Array:
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
        _("choose one of at most {most:.6g} mm")
        if most > 0.0
        else _("no cutter fits into a sharp inner corner")
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
        what = _(
            "a chord tolerance of {tolerance:.3g} mm requires {count} points; at most {most} are allowed"
        )
        told = what.format(tolerance=1e3 * tolerance, count=count, most=MOST_POINTS)
        raise InputError("[study] chord_tolerance", told, _("increase it"))
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


# Outlines of a plate cam: its profile, the path of the roller's centre, that of a cutter, with their corners.


@dataclass(frozen=True)
class _Layer:
    """A curve along with the profile: its distance from it [m] outwards."""

    name: Layer
    away: float


def follower_outlines(
    cam: FollowerCam, tolerance: float = 1e-6, cutter: float | None = None
) -> list[OutlinePiece]:
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
    found: list[OutlinePiece] = []
    for layer in layers:
        for (start, _stop), phi in zip(pairwise(cam.edges), pieces, strict=True):
            if start in corners:
                found += _corner(cam, corners[start], layer, tolerance)
            contact = cam.contact(phi)
            places = contact.place + layer.away * contact.normal
            speed = cutter_speed(cam, contact, layer.away)
            found.append(
                OutlinePiece(layer.name, phi, places, speed[:, None] * contact.tangent, contact.normal)
            )
    return found


def _corner(cam: FollowerCam, corner: LiftCorner, layer: _Layer, tolerance: float) -> Iterator[OutlinePiece]:
    """What joins both sides of a corner, where they part."""
    before = _before(cam, corner.at)
    if corner.step > 0.0:
        start = before.place[0] + layer.away * before.normal[0]
        along = np.linspace(0.0, corner.step, LEAST_SPACES + 1)
        slopes = np.broadcast_to(before.tangent[0], (len(along), 2))
        places = start + along[:, None] * slopes
        normals = np.broadcast_to(before.normal[0], slopes.shape)
        size = cam.base_radius
        yield OutlinePiece(layer.name, corner.at + along / size, places, size * slopes, normals)
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
        yield OutlinePiece(layer.name, corner.at + turned, places, sense * distance * along, outwards)


def _before(cam: FollowerCam, at: float) -> FollowerContact:
    """The contact just before a joint; before phi = 0 that at the end of the turn."""
    end = cam.edges[-1] if at == cam.edges[0] else at
    return cam.contact(np.array([inside(cam.edges[0], end)[1]]))


def join_outlines(outlines: list[OutlinePiece], layer: Layer) -> Array:
    """All points (n, 2) [m] of a layer in their order, those where pieces meet once."""
    found: list[Array] = []
    for one in outlines:
        if one.layer == layer:
            found.append(one.places if not found else one.places[1:])
    return np.concatenate(found)


# Profiles under followers, and the points of their outlines, as labelled results.

AXES = ["x", "y"]
PLACED = ("sample", "axis")


def follower_profile(body: FollowerCam, phi: Array, cutter: float | None = None) -> xr.Dataset:
    """The profile of a cam with a follower at angles of the cam [rad].

    Parameters
    ----------
    cutter : float [m]
        Radius of a cutter, whose centres are wanted too.

    Returns
    -------
    Dataset
        Over `sample`, in the cam's axes: `cam_angle`, the profile with its polar form and its normals, the pressure
        angle, the profile's radius of curvature; of a roller its centre and the curvature of its path, of a flat face
        the place of contact along it, of a cutter its centre (docs: cam follower profiles).
    """
    found = body.contact(phi)
    x, y = found.place.T
    variables: dict[str, Variable] = {
        "cam_angle": vocabulary_variable("cam_angle", ("sample",), phi),
        "profile": vocabulary_variable("profile", PLACED, found.place),
        "profile_radius": vocabulary_variable("profile_radius", ("sample",), np.hypot(x, y)),
        "profile_angle": vocabulary_variable("profile_angle", ("sample",), np.unwrap(np.arctan2(x, y))),
        "profile_normal": vocabulary_variable("profile_normal", PLACED, found.normal),
        "cam_pressure_angle": vocabulary_variable("cam_pressure_angle", ("sample",), found.pressure_angle),
        "profile_bend": vocabulary_variable("profile_bend", ("sample",), found.bend),
    }
    if isinstance(body.touch, Face):
        variables["face_place"] = vocabulary_variable("face_place", ("sample",), found.along)
    elif body.touch.roller > 0.0:
        variables["roller_centre"] = vocabulary_variable("roller_centre", PLACED, found.centre)
        variables["path_curvature"] = vocabulary_variable("path_curvature", ("sample",), found.path_curvature)
    if cutter is not None:
        check_cutter(body, cutter)
        variables["cutter_centre"] = vocabulary_variable(
            "cutter_centre", PLACED, cutter_centres(found, cutter)
        )
    attributes: dict[str, Any] = {"roller": body.touch.roller, "base_radius": body.base_radius}
    if body.cam is not None:
        attributes |= {"topic": "follower-profile", "title": body.cam.title, "cam": cam_text(body.cam)}
    return xr.Dataset(variables, coords={"axis": AXES}, attrs=attributes)


def cam_points(cam: AnyCam) -> xr.Dataset:
    """Points of a cam's outlines for a machine: chords between them keep `[study] chord_tolerance`.

    Returns
    -------
    Dataset
        Over `sample`: which `curve` ("profile", "path" of the roller's centre, "cutter"), the cam's angle, the point
        and the unit normal out of the cam, in the cam's axes, in the order of the contact's way.

    Raises
    ------
    InputError, MotionError
        As `follower_cam`; a cutter that is larger than a hollow; a tolerance that asks for too many points.
    """
    plate = with_follower(cam)
    cutter = None if plate.tool is None else plate.tool.radius
    return points_dataset(follower_outlines(follower_cam(plate), plate.study.chord_tolerance, cutter))


def points_dataset(outlines: Sequence[OutlinePiece]) -> xr.Dataset:
    """`cam_points` of outlines that are known."""
    curves: list[str] = []
    angles, places, normals = [], [], []
    for number, one in enumerate(outlines):
        # where pieces meet the point is told once
        again = number > 0 and outlines[number - 1].layer == one.layer
        fresh = slice(1 if again and _meet(outlines[number - 1], one) else 0, None)
        curves += [one.layer] * len(one.parameter[fresh])
        angles.append(one.parameter[fresh])
        places.append(one.places[fresh])
        normals.append(np.asarray(one.normals)[fresh])
    variables: dict[str, Variable] = {
        "curve": (("sample",), np.array(curves), {}),
        "cam_angle": vocabulary_variable("cam_angle", ("sample",), np.concatenate(angles)),
        "curve_point": vocabulary_variable("curve_point", PLACED, np.concatenate(places)),
        "curve_normal": vocabulary_variable("curve_normal", PLACED, np.concatenate(normals)),
    }
    return xr.Dataset(variables, coords={"axis": AXES})


def _meet(one: OutlinePiece, two: OutlinePiece) -> bool:
    return bool(np.hypot(*(one.places[-1] - two.places[0])) < 1e-12)
