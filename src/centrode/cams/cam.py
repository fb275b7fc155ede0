"""A cam as a labelled result: the path of its roller's centre, with the pressure angle and the curvature."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.cams.curvature_laws import derivatives, drawn_curvature
from centrode.cams.followers.motion import dataset_of_motion, follower_motion
from centrode.cams.path_integration import IntegratedPath, integrated_path
from centrode.cams.path_series import (
    TOLERANCE,
    Convergence,
    ExpandedPath,
    SeriesPath,
    convergence,
    half_path,
    law_of,
    path_of,
    series_path,
)
from centrode.cams.roller_path import (
    FEWEST,
    RollerPath,
    SymmetricPath,
    angles_of,
    curvature_extremes,
    pressure_extremes,
    radius_extremes,
    stalls_of,
)
from centrode.errors import CentrodeError, Status
from centrode.kinematics.motion import Variable, labels_of, vocabulary_variable
from centrode.kinematics.sample_index import selectable
from centrode.model.cam import Cam
from centrode.model.cam_files import AnyCam, cam_text, require_curvature_cam
from centrode.model.examples.catalogue import CamSource, cam_of
from centrode.model.follower_cam import PlateCam
from centrode.numerics.search import Extremes
from centrode.version import __version__

Array = npt.NDArray[np.float64]


def cam(cam: CamSource, samples: int | None = None, at: npt.ArrayLike | None = None) -> xr.Dataset:
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

    Examples
    --------
    >>> import centrode as ct
    >>> path = ct.cam(ct.example("cam-from-curvature"), 37)
    >>> print(ct.summary(path).splitlines()[5])
    radius ρ                      50 mm at 0 deg to 61.0092 mm at 79.1402 deg
    """
    cam = cam_of(cam)
    phi = angles_of(cam, samples, at)
    if isinstance(cam, PlateCam):
        return dataset_of_motion(cam, follower_motion(cam), phi)
    path = path_of(cam)
    return dataset_of_path(cam, path, phi)


def dataset_of_path(cam: Cam, path: RollerPath, phi: Array) -> xr.Dataset:
    """The labelled result of a path at angles of the carrier [rad]."""
    along = ("sample",)
    values = _values(path, phi)
    data = {name: vocabulary_variable(name, along, found) for name, found in values.items()}
    centre = np.stack([values["path_radius"] * np.sin(phi), values["path_radius"] * np.cos(phi)], axis=-1)
    data["roller_centre"] = vocabulary_variable("roller_centre", ("sample", "axis"), centre)
    data["status"] = status_of(path, phi)
    coordinates = {
        "carrier_angle": vocabulary_variable("carrier_angle", along, phi),
        "axis": labels_of(("x", "y")),
    }
    return selectable(xr.Dataset(data, coords=coordinates, attrs=_path_facts(cam, path)))


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
    dimensions, values, attributes = vocabulary_variable("status", ("sample",), status)
    attributes["flag_values"] = np.array([s.value for s in Status], dtype=np.int8)
    attributes["flag_meanings"] = " ".join(s.name.lower() for s in Status)
    return dimensions, values, attributes


def _path_facts(cam: Cam, path: RollerPath) -> dict[str, Any]:
    return {
        "topic": "roller-path",
        "title": cam.title,
        "cam": cam_text(cam),
        "version": __version__,
        "start": path.start,
        "stop": path.stop,
        "stall": math.nan if path.stall is None else path.stall,
    }


# The three routes to a roller's path beside each other: one series, series expanded anew, an integrator.

ROUTES = ("series", "steps", "integrated")
"""(a) the power series about phi = 0, cut; (b) series expanded anew step by step; (c) the integrator."""


@dataclass(frozen=True)
class Routes:
    """The path by the three routes, each for phi >= 0 only where the cam is symmetric."""

    series: SeriesPath
    steps: ExpandedPath
    integrated: IntegratedPath
    convergence: Convergence


def routes_of(cam: Cam, terms: int | None = None) -> Routes:
    """The path of a cam by the three routes; `terms` of the series, the description's own number if left out."""
    law, start = law_of(cam), (cam.start.radius, cam.start.pressure_angle)
    ends = cam.range.start, cam.range.stop
    count = cam.study.terms if terms is None else terms
    steps = half_path(cam)
    return Routes(
        series_path(law, *start, *ends, count),
        steps,
        integrated_path(law, *start, *ends),
        convergence(law, *start),
    )


def cam_routes(
    cam: Cam, samples: int | None = None, at: npt.ArrayLike | None = None, terms: int | None = None
) -> xr.Dataset:
    """A roller's path by three routes, and what parts them.

    Parameters
    ----------
    cam : Cam
    samples, at
        As `cam`.
    terms : int
        The series is cut after a_terms; the description's own number (20) if left out.

    Returns
    -------
    Dataset
        Along `sample` and `route` ("series", "steps", "integrated"): rho, the sine of the pressure angle, its slope.
        Along `sample`: rho by formula (16) and its difference from (15), which vanishes for the whole series; the
        error of rho that the next four terms foretell (NaN outside the circle of convergence, where there is no
        error to be foretold); the true differences from the route by steps. Attributes tell the circle of convergence.

    Raises
    ------
    InputError
        As `path_of`; a number of terms out of bounds.
    """
    phi = angles_of(cam, samples, at)
    routes = routes_of(cam, terms)
    places, sign = (
        (np.abs(phi), np.sign(phi) + (phi == 0)) if cam.curvature.symmetric else (phi, np.ones_like(phi))
    )
    radii, sines, slopes = zip(
        *((one.radius(places)[0], sign * one.sine(places)[0], one.sine(places, 1)[1]) for one in _three(routes)),
        strict=True,
    )  # fmt: skip
    by_slope = routes.series.radius_by_slope(places)
    alone = {
        "radius_by_slope": by_slope,
        "parting": by_slope - radii[0],
        "foretold_error": foretold_error(routes, places),
        "series_error": radii[0] - radii[1],
        "routes_difference": radii[2] - radii[1],
    }
    across = {"path_radius": radii, "pressure_sine": sines, "pressure_sine_slope": slopes}
    data = {
        name: vocabulary_variable(name, ("route", "sample"), np.stack(found))
        for name, found in across.items()
    }
    data |= {name: vocabulary_variable(name, ("sample",), found) for name, found in alone.items()}
    data["status"] = status_of(SymmetricPath(routes.steps) if cam.curvature.symmetric else routes.steps, phi)
    coordinates = {
        "carrier_angle": vocabulary_variable("carrier_angle", ("sample",), phi),
        "route": labels_of(ROUTES),
    }
    return selectable(xr.Dataset(data, coords=coordinates, attrs=_comparison_facts(cam, routes, data)))


def _three(routes: Routes) -> tuple[SeriesPath, ExpandedPath, IntegratedPath]:
    return routes.series, routes.steps, routes.integrated


def foretold_error(routes: Routes, phi: Array) -> Array:
    """Error of rho [m] by formula (15) that the next terms of the series foretell; NaN outside the circle.

    The sizes of the next four terms of eta' and of cos(gamma), over K, and a geometric series behind them.
    """
    series, radius = routes.series, routes.convergence.radius
    distance = np.abs(phi)
    slope = np.zeros_like(distance)
    value = np.zeros_like(distance)
    with np.errstate(all="ignore"):
        for n, left_out in enumerate(series.following, series.terms + 1):
            slope = slope + n * abs(left_out) * distance ** (n - 1)
            value = value + abs(left_out) * distance**n
        ratio = (
            (distance / radius) ** len(series.following) if math.isfinite(radius) else np.zeros_like(distance)
        )
        tangent = np.abs(np.tan(series.pressure_angle(phi)))
        error = (slope + tangent * value) / derivatives(series.law, phi)[0] / (1.0 - ratio)
    return np.where(ratio < 1.0, error, np.nan)


def _comparison_facts(cam: Cam, routes: Routes, data: dict[str, Any]) -> dict[str, Any]:
    circle, steps = routes.convergence, routes.steps
    place = complex(math.nan, math.nan) if circle.singularity is None else circle.singularity
    radii = data["path_radius"][1]
    with np.errstate(all="ignore"):
        apart = np.abs(radii[2] / radii[1] - 1.0)
    return {
        "topic": "path-routes",
        "title": cam.title,
        "cam": cam_text(cam),
        "version": __version__,
        "terms": routes.series.terms,
        "radius_of_convergence": circle.radius,
        "radius_by_coefficients": circle.estimate,
        "singularity": [place.real, place.imag],
        "series_from": routes.series.start,
        "series_to": routes.series.stop,
        "tolerance": TOLERANCE,
        "steps": len(steps.centres),
        "order": steps.order,
        "worst_difference": float(np.nanmax(apart, initial=0.0)),
        "stall": math.nan if steps.stall is None else steps.stall,
        "stall_integrated": math.nan if routes.integrated.stall is None else routes.integrated.stall,
    }


# What is known of a path, and of the routes to it, together.

FURTHER = math.tau
"""Angle [rad] up to which a stall beyond the range is looked for."""
TURN = 1e-9
"""By how much [rad] a range may miss a whole turn."""


@dataclass(frozen=True)
class RollerPathResults:
    """The path of a cam's roller with its extremes, its stall and its ends.

    Attributes
    ----------
    cam : Cam
    path : RollerPath
    dataset : the labelled path
    radius, pressure_angle, curvature : extremes along the path [m], [rad], [1/m]
    stalls : angles [rad] at which the follower stalls, the positive one of a symmetric law; none if it does not
    stall_beyond : angle [rad] at which the law would make it stall beyond the range; None where it would not
    gap : by how much [m] the path misses its beginning after a whole turn; None if it is no turn
    kink : kink [rad] of the path after a whole turn, otherwise of the path and its mirror image at its end; None where
        the path ends in a stall
    """

    cam: Cam
    path: RollerPath
    dataset: xr.Dataset
    radius: Extremes
    pressure_angle: Extremes
    curvature: Extremes
    stalls: tuple[float, ...]
    stall_beyond: float | None
    gap: float | None
    kink: float | None

    @property
    def steepest(self) -> tuple[float, float]:
        """The greatest pressure angle with its sign, and where it is [rad]."""
        gamma = self.pressure_angle
        greatest = gamma.greatest >= -gamma.least
        return (gamma.greatest, gamma.at_greatest) if greatest else (gamma.least, gamma.at_least)

    @property
    def drawn_difference(self) -> float:
        """Greatest share by which the curvature of circles through three samples differs from the law's; NaN of two."""
        law, drawn = (self.dataset[name].values for name in ("law_curvature", "drawn_curvature"))
        with np.errstate(all="ignore"):
            return _greatest(drawn / law - 1.0)

    @property
    def equation_residual(self) -> tuple[float, float]:
        """What is left of the differential equation of the sine along the path, and its greatest term [1/m]."""
        names = ("pressure_sine", "pressure_sine_slope", "pressure_sine_second", "pressure_cosine")
        eta, slope, second, cosine = (self.dataset[name].values for name in names)
        bend, bent = (self.dataset[name].values for name in ("law_curvature", "law_curvature_slope"))
        terms = np.array([bend * second, -bent * slope, bend * eta, bent * cosine])
        known = terms[:, np.isfinite(terms).all(axis=0)]
        return float(np.abs(known.sum(axis=0)).max(initial=0.0)), float(np.abs(known).max(initial=0.0))


def roller_path_results(cam: AnyCam, samples: int | None = None) -> RollerPathResults:
    """The path of a cam's roller, with what is known of it.

    Parameters
    ----------
    cam : Cam
    samples : int
        As of `cam`.

    Raises
    ------
    InputError
        As `path_of`; a cam that is given by its follower's lift.
    """
    cam = require_curvature_cam(cam)
    phi = angles_of(cam, samples)
    path = path_of(cam)
    ends = np.array([path.start, path.stop])
    gamma, radius = path.pressure_angle(ends), path.radius(ends)[0]
    gap = kink = None
    if abs(path.stop - path.start - math.tau) < TURN:
        gap, kink = float(radius[1] - radius[0]), float(gamma[1] - gamma[0])
    elif path.stall is None:
        kink = 2.0 * float(gamma[1])
    return RollerPathResults(
        cam,
        path,
        dataset_of_path(cam, path, phi),
        radius_extremes(path),
        pressure_extremes(path),
        curvature_extremes(path),
        _stalls(cam, path),
        stall_beyond(cam) if path.stall is None else None,
        gap,
        kink,
    )


def results_of_roller_path(cam: Cam, dataset: xr.Dataset) -> RollerPathResults:
    """A dataset of `cam` with what is known of the whole path."""
    return replace(roller_path_results(cam, FEWEST), dataset=dataset)


def _stalls(cam: Cam, path: RollerPath) -> tuple[float, ...]:
    """Where the follower stalls [rad]; of a path that is the same on both sides the positive angle."""
    if path.stall is None:
        return ()
    return (path.stall,) if cam.curvature.symmetric else tuple(stalls_of(path))


def stall_beyond(cam: Cam) -> float | None:
    """The angle [rad] at which the law would make the follower stall beyond the range; None where it does not."""
    if cam.range.stop >= FURTHER:
        return None
    longer = cam.model_copy(update={"range": cam.range.model_copy(update={"start": 0.0, "stop": FURTHER})})
    try:
        return half_path(longer).stall
    except CentrodeError:  # the law ends, or is none of a cam, before that
        return None


@dataclass(frozen=True)
class PathRoutesResults:
    """The three routes to a cam's path.

    Attributes
    ----------
    cam : Cam
    dataset : the routes over the range
    at_instants : the same at chosen angles; None where none are chosen
    """

    cam: Cam
    dataset: xr.Dataset
    at_instants: xr.Dataset | None

    @property
    def series_error(self) -> float:
        """Greatest error of the radius [m] by the series; NaN where it gives no sample."""
        return _greatest(self.dataset["series_error"].values)

    @property
    def parting(self) -> float:
        """Greatest difference [m] of the radius by formulas (16) and (15); NaN where the curvature is constant."""
        return _greatest(self.dataset["parting"].values)

    @property
    def without_series(self) -> int:
        """Number of samples of the path at which the series gives none: its sine is no sine there."""
        radii = self.dataset["path_radius"].values
        sine = np.abs(self.dataset["pressure_sine"].values[0])
        return int(np.count_nonzero((sine > 1.0) & np.isnan(radii[0]) & np.isfinite(radii[1])))

    @property
    def flat(self) -> tuple[float, ...]:
        """Angles [rad] at which the slope of the curvature vanishes, and formula (16) has no meaning."""
        reached = np.isfinite(self.dataset["path_radius"].values[0])
        flat = np.isnan(self.dataset["parting"].values) & reached
        return tuple(self.dataset["carrier_angle"].values[flat].tolist())

    @property
    def leaves_the_series(self) -> bool:
        """Whether the range goes beyond the first break of the law, where the series is no longer that of the path."""
        phi = np.abs(self.dataset["carrier_angle"].values)
        facts = self.dataset.attrs
        return bool(phi.max() > max(-facts["series_from"], facts["series_to"]) * (1 + 1e-12))


def path_routes_results(
    cam: AnyCam,
    samples: int | None = None,
    *,
    terms: int | None = None,
    instants: Sequence[float] = (),
) -> PathRoutesResults:
    """One series, series expanded anew, an integrator, beside each other.

    Parameters
    ----------
    cam : Cam
    samples, terms : int
        As of `cam_routes`.
    instants : angles [rad]
        Those of the description if there are none.

    Raises
    ------
    InputError
        As `cam_routes`; a cam that is given by its follower's lift.
    """
    cam = require_curvature_cam(cam)
    dataset = cam_routes(cam, samples, terms=terms)
    chosen = tuple(instants) or cam.study.instants
    return PathRoutesResults(cam, dataset, cam_routes(cam, at=chosen, terms=terms) if chosen else None)


def results_of_path_routes(cam: Cam, dataset: xr.Dataset) -> PathRoutesResults:
    """A dataset of `cam_routes`, whose series has as many terms, with the routes at the instants of the description."""
    chosen = cam.study.instants
    terms = int(dataset.attrs["terms"])
    return PathRoutesResults(cam, dataset, cam_routes(cam, at=chosen, terms=terms) if chosen else None)


def _greatest(values: Array) -> float:
    sizes = np.abs(values)
    return float(np.nanmax(sizes)) if np.isfinite(sizes).any() else math.nan
