"""The path of a cam's roller in words: law, sizes, pressure angle, stall, ends."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from centrode.cams.cam import dataset_of_path
from centrode.cams.path_series import half_path, path_of
from centrode.cams.roller_path import (
    RollerPath,
    angles_of,
    curvature_extremes,
    ends_of,
    pressure_extremes,
    radius_extremes,
    stalls_of,
)
from centrode.errors import CentrodeError
from centrode.locale import _
from centrode.model.cam import Cam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.said import Asked, CamPart, Rows, Units

FURTHER = math.tau
"""Angle [rad] up to which a stall beyond the range is looked for."""


def path_part(cam: Cam, asked: Asked) -> CamPart:
    """The path by series expanded anew step by step."""
    phi = angles_of(cam, asked.samples)
    path = path_of(cam)
    dataset = dataset_of_path(cam, path, phi)
    rows, scalars = _sizes(cam, path)
    stall, told, failures = _stall(cam, path)
    scalars |= stall
    ends, kink = _ends(cam, path)
    drawn, worst = _drawn(dataset)
    return CamPart(
        _("Path of the roller's centre"),
        [*_law(cam), *rows, told, ends, drawn],
        scalars | kink | worst,
        {"cam-path": dataset},
        failures=failures,
        objects={"path": path},
    )


def _law(cam: Cam) -> Rows:
    given, units = cam.curvature, Units(cam)
    k0 = units.text(given.k0 or math.nan, "1/m", 9)
    slope = units.text(given.k1 or 0.0, "1/m/rad", 9)
    law = {
        "constant": f"K = {k0}",
        "exponential": f"K = k0 exp(k1 φ), k0 = {k0}, k1 = {given.k1 or 0.0:.9g} 1/rad",
        "linear": f"K = k0 + k1 φ, k0 = {k0}, k1 = {slope}",
        "spline": _("K by the spline through {count} points").format(count=len(given.points or ())),
        "formula": f"K = {given.formula} 1/m",
    }[given.law]
    if given.symmetric:
        law += ", " + _("the same on both sides of φ = 0")
    start = _("ρ = {radius}, pressure angle {angle}").format(
        radius=units.text(cam.start.radius, digits=9), angle=units.angle(cam.start.pressure_angle)
    )
    low, high = ends_of(cam)
    return [
        (_("curvature law"), law),
        (_("start"), start),
        (_("range"), _("{first} to {last}").format(first=units.angle(low), last=units.angle(high))),
    ]


def _sizes(cam: Cam, path: RollerPath) -> tuple[Rows, dict[str, Scalar]]:
    units = Units(cam)
    radius, gamma, bent = radius_extremes(path), pressure_extremes(path), curvature_extremes(path)
    steepest, at = (
        (gamma.greatest, gamma.at_greatest)
        if gamma.greatest >= -gamma.least
        else (gamma.least, gamma.at_least)
    )
    between = _("{least} at {least_at} to {greatest} at {greatest_at}")
    rows = [
        (
            _("radius ρ"),
            between.format(
                least=units.text(radius.least),
                least_at=units.angle(radius.at_least),
                greatest=units.text(radius.greatest),
                greatest_at=units.angle(radius.at_greatest),
            ),
        ),
        (
            _("greatest pressure angle"),
            _("{angle} at {at}").format(angle=units.angle(steepest), at=units.angle(at)),
        ),
        (
            _("radius of curvature"),
            _("{least} to {greatest}").format(
                least=units.text(1.0 / bent.greatest), greatest=units.text(1.0 / bent.least)
            ),
        ),
    ]
    scalars = {
        "cam_least_radius": Scalar(radius.least, "m"),
        "cam_greatest_radius": Scalar(radius.greatest, "m"),
        "cam_greatest_pressure_angle": Scalar(abs(steepest), "rad"),
        "cam_greatest_pressure_angle_at": Scalar(at, "rad"),
        "cam_least_curvature_radius": Scalar(1.0 / bent.greatest, "m"),
        "cam_greatest_curvature_radius": Scalar(1.0 / bent.least, "m"),
    }
    return rows, scalars


def _stall(cam: Cam, path: RollerPath) -> tuple[dict[str, Scalar], tuple[str, str], tuple[str, ...]]:
    """Where the follower stalls: its number, its row, and the sentence if that lies in the range."""
    units = Units(cam)
    if path.stall is not None:
        sign = "±" if cam.curvature.symmetric else ""
        places = [path.stall] if sign else stalls_of(path)
        place = _(" and ").join(f"{sign}{units.angle(one, 9)}" for one in places)
        failure = _("the follower stalls at {place}, where the pressure angle is 90 deg").format(place=place)
        failure += "; " + _("end the range before that angle")
        row = (_("stall"), _("at {place}, inside the range").format(place=place))
        return {"cam_stall": Scalar(path.stall, "rad")}, row, (failure,)
    beyond = stall_beyond(cam)
    if beyond is None:
        return {}, (_("stall"), _("none in the range")), ()
    told = _("none in the range; with this law the follower would stall at {place}")
    return (
        {"cam_stall": Scalar(beyond, "rad")},
        (_("stall"), told.format(place=units.angle(beyond, 9))),
        (),
    )


def stall_beyond(cam: Cam) -> float | None:
    """The angle [rad] at which the law would make the follower stall beyond the range; None where it does not."""
    if cam.range.stop >= FURTHER:
        return None
    longer = cam.model_copy(update={"range": cam.range.model_copy(update={"start": 0.0, "stop": FURTHER})})
    try:
        return half_path(longer).stall
    except CentrodeError:  # the law ends, or is none of a cam, before that
        return None


def _ends(cam: Cam, path: RollerPath) -> tuple[tuple[str, str], dict[str, Scalar]]:
    """What parts the ends: over a whole turn from each other, else from their mirror image."""
    units = Units(cam)
    ends = np.array([path.start, path.stop])
    gamma, radius = path.pressure_angle(ends), path.radius(ends)[0]
    if abs(path.stop - path.start - math.tau) < 1e-9:
        said = _("after a turn ρ is {gap} greater and the path has a kink of {kink}").format(
            gap=units.text(radius[1] - radius[0], digits=4), kink=units.angle(gamma[1] - gamma[0], 4)
        )
        return (_("closure"), said), {"cam_gap": Scalar(float(radius[1] - radius[0]), "m")}
    if path.stall is not None:
        return (_("closure"), _("the path ends where the follower stalls")), {}
    kink = 2.0 * float(gamma[1])
    said = _("mirrored at {place} the path has a kink of {kink}").format(
        place=units.angle(path.stop), kink=units.angle(abs(kink), 5)
    )
    return (_("closure"), said), {"cam_mirrored_kink": Scalar(abs(kink), "rad")}


def _drawn(dataset: xr.Dataset) -> tuple[tuple[str, str], dict[str, Scalar]]:
    law, drawn = dataset["law_curvature"].to_numpy(), dataset["drawn_curvature"].to_numpy()
    with np.errstate(all="ignore"):
        apart = np.abs(drawn / law - 1.0)
    if not np.isfinite(apart).any():
        return (_("curvature of the drawn curve"), _("three neighbouring places are needed")), {}
    worst = float(np.nanmax(apart))
    said = _("within {share:.2g} of the law's (circles through three of {count} places)")
    told = said.format(share=worst, count=dataset.sizes["sample"])
    return (_("curvature of the drawn curve"), told), {"cam_drawn_curvature_difference": Scalar(worst, "1")}
