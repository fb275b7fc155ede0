"""Profiles under followers, and the points of their outlines, as labelled results."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from centrode.cams.followers.bodies import FollowerCam
from centrode.cams.followers.contact import Array, Face
from centrode.cams.followers.cutting import check_cutter, cutter_centres
from centrode.cams.followers.described import follower_cam
from centrode.cams.followers.outlines import follower_outlines
from centrode.cams.profiles.outlines import Outline
from centrode.kinematics.dataset import Variable, named
from centrode.model.cams.files import AnyCam, with_follower

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
        "cam_angle": named("cam_angle", ("sample",), phi),
        "profile": named("profile", PLACED, found.place),
        "profile_radius": named("profile_radius", ("sample",), np.hypot(x, y)),
        "profile_angle": named("profile_angle", ("sample",), np.unwrap(np.arctan2(x, y))),
        "profile_normal": named("profile_normal", PLACED, found.normal),
        "cam_pressure_angle": named("cam_pressure_angle", ("sample",), found.pressure_angle),
        "profile_bend": named("profile_bend", ("sample",), found.bend),
    }
    if isinstance(body.touch, Face):
        variables["face_place"] = named("face_place", ("sample",), found.along)
    elif body.touch.roller > 0.0:
        variables["roller_centre"] = named("roller_centre", PLACED, found.centre)
        variables["path_curvature"] = named("path_curvature", ("sample",), found.path_curvature)
    if cutter is not None:
        check_cutter(body, cutter)
        variables["cutter_centre"] = named("cutter_centre", PLACED, cutter_centres(found, cutter))
    attributes = {"roller": body.touch.roller, "base_radius": body.base_radius}
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


def points_dataset(outlines: Sequence[Outline]) -> xr.Dataset:
    """`cam_points` of outlines that are known."""
    curves: list[str] = []
    angles, places, normals = [], [], []
    for number, one in enumerate(outlines):
        # where pieces meet the point is told once
        again = number > 0 and outlines[number - 1].layer == one.layer
        fresh = slice(1 if again and _meet(outlines[number - 1], one) else 0, None)
        curves += [one.layer] * len(one.phi[fresh])
        angles.append(one.phi[fresh])
        places.append(one.places[fresh])
        normals.append(np.asarray(one.normals)[fresh])
    variables: dict[str, Variable] = {
        "curve": (("sample",), np.array(curves), {}),
        "cam_angle": named("cam_angle", ("sample",), np.concatenate(angles)),
        "curve_point": named("curve_point", PLACED, np.concatenate(places)),
        "curve_normal": named("curve_normal", PLACED, np.concatenate(normals)),
    }
    return xr.Dataset(variables, coords={"axis": AXES})


def _meet(one: Outline, two: Outline) -> bool:
    return bool(np.hypot(*(one.places[-1] - two.places[0])) < 1e-12)
