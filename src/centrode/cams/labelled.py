"""A cam as a labelled result: the path of its roller's centre, with the pressure angle and the curvature."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.cams.described import path_of
from centrode.cams.drawn import drawn_curvature
from centrode.cams.followers.labelled import dataset_of_motion
from centrode.cams.followers.motion import follower_motion
from centrode.cams.path import RollerPath
from centrode.cams.sampled import angles_of
from centrode.errors import Status
from centrode.kinematics.dataset import Variable, labels_of, named
from centrode.model.cams.description import Cam
from centrode.model.cams.files import AnyCam, cam_text
from centrode.model.cams.plate import PlateCam
from centrode.version import __version__

Array = npt.NDArray[np.float64]


def cam(cam: AnyCam, samples: int | None = None, at: npt.ArrayLike | None = None) -> xr.Dataset:
    """The path of a cam's roller, by series expanded anew step by step; or the motion of a cam's follower.

    Parameters
    ----------
    cam : Cam or PlateCam
    samples : int
        Evenly spaced over the range or a turn, both ends included; the description's own number, else 361.
    at : (n,) angles of the carrier, or of the cam [rad]
        Exactly these places instead.

    Returns
    -------
    Dataset
        Along `sample`, over `carrier_angle`: rho with two derivatives, the pressure angle, its sine with two
        derivatives and its cosine, the curvature of the law and its slope, the roller's centre, the curvature of the
        curve drawn through the neighbouring places, status (docs: cams). Beyond a stall a sample is open; at a stall
        it is singular: its derivatives are NaN. Of a cam that is given by its follower's lift: along `sample`, over
        `cam_angle`, the lift with four derivatives by the cam's angle, and with a speed of the cam those in time
        (docs: cam followers).

    Raises
    ------
    InputError
        As `path_of`.
    """
    phi = angles_of(cam, samples, at)
    if isinstance(cam, PlateCam):
        return dataset_of_motion(cam, follower_motion(cam), phi)
    path = path_of(cam)
    return dataset_of_path(cam, path, phi)


def dataset_of_path(cam: Cam, path: RollerPath, phi: Array) -> xr.Dataset:
    """The labelled result of a path at angles of the carrier [rad]."""
    along = ("sample",)
    values = _values(path, phi)
    data = {name: named(name, along, found) for name, found in values.items()}
    centre = np.stack([values["path_radius"] * np.sin(phi), values["path_radius"] * np.cos(phi)], axis=-1)
    data["roller_centre"] = named("roller_centre", ("sample", "axis"), centre)
    data["status"] = status_of(path, phi)
    coordinates = {"carrier_angle": named("carrier_angle", along, phi), "axis": labels_of(("x", "y"))}
    return xr.Dataset(data, coords=coordinates, attrs=_facts(cam, path))


def _values(path: RollerPath, phi: Array) -> dict[str, Array]:
    with np.errstate(all="ignore"):
        radius, sine = (
            np.where(np.isfinite(one), one, np.nan) for one in (path.radius(phi, 2), path.sine(phi, 2))
        )
        curvature = path.curvature(phi, 1)
        gamma = path.pressure_angle(phi)
    return {
        "path_radius": radius[0],
        "path_radius_slope": radius[1],
        "path_radius_second": radius[2],
        "cam_pressure_angle": gamma,
        "pressure_sine": sine[0],
        "pressure_sine_slope": sine[1],
        "pressure_sine_second": sine[2],
        "pressure_cosine": np.cos(gamma),
        "law_curvature": curvature[0],
        "law_curvature_slope": curvature[1],
        "drawn_curvature": drawn_curvature(phi, radius[0]),
    }


def status_of(path: RollerPath, phi: Array) -> Variable:
    """Status of every place: open beyond the path, singular at a stall."""
    known = np.isfinite(path.radius(phi)[0])
    status = np.where(known, np.int8(Status.OK), np.int8(Status.OPEN)).astype(np.int8)
    if path.stall is not None:
        status[known & (np.abs(np.abs(path.pressure_angle(phi)) - math.pi / 2) == 0)] = Status.SINGULAR
    dimensions, values, attributes = named("status", ("sample",), status)
    attributes["flag_values"] = np.array([s.value for s in Status], dtype=np.int8)
    attributes["flag_meanings"] = " ".join(s.name.lower() for s in Status)
    return dimensions, values, attributes


def _facts(cam: Cam, path: RollerPath) -> dict[str, Any]:
    return {
        "title": cam.title,
        "cam": cam_text(cam),
        "version": __version__,
        "start": path.start,
        "stop": path.stop,
        "stall": math.nan if path.stall is None else path.stall,
    }
