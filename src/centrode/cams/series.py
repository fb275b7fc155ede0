"""The power series of the sine and the cosine of the pressure angle about phi = 0, and the path by it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.cams.curvature_laws import ExponentialCurvature
from centrode.cams.path_series import SeriesPath, coefficients, law_of, series_path
from centrode.cams.roller_path import angles_of
from centrode.kinematics.motion import vocabulary_variable
from centrode.kinematics.sample_index import selectable
from centrode.model.cam import Cam
from centrode.model.cam_files import AnyCam, cam_text, require_curvature_cam
from centrode.model.examples.catalogue import CamSource, cam_of
from centrode.version import __version__

Array = npt.NDArray[np.float64]


def cam_series(
    cam: CamSource, samples: int | None = None, at: npt.ArrayLike | None = None, terms: int | None = None
) -> xr.Dataset:
    """The coefficients of a roller's path as one power series about phi = 0, and the path that the cut series gives.

    Parameters
    ----------
    cam : Cam
    samples, at
        As of `cam`.
    terms : int
        The series is cut after a_terms; by default the description's own number, else 20.

    Returns
    -------
    Dataset
        Along `term` (0 to terms): a_n of eta = sin(gamma) and b_n of lambda = cos(gamma) [1/rad^n]. Along `sample`,
        over `carrier_angle`: eta with two derivatives by phi, lambda = sqrt(1 - eta^2), the curvature K of the law and
        rho by formula (15), all of the series cut after a_terms (docs: cams). NaN beyond the first break of the law.

    Raises
    ------
    InputError
        As `path_of`; a number of terms out of bounds; a cam that is given by its follower's lift.

    Notes
    -----
    By the recursions (24), (25), (34) of the paper for an exponential law, by those of the equations themselves for
    any other.

    Examples
    --------
    >>> import centrode as ct
    >>> series = ct.cam_series(ct.example("cam-from-curvature"), terms=4)
    >>> series.sine_coefficient.values.round(6).tolist()
    [0.0, 0.5, -0.1875, -0.130208, -0.000977]
    """
    chosen = require_curvature_cam(cam_of(cam))
    return _dataset(chosen, angles_of(chosen, samples, at), chosen.study.terms if terms is None else terms)


def _dataset(cam: Cam, phi: Array, terms: int) -> xr.Dataset:
    law, start = law_of(cam), (cam.start.radius, cam.start.pressure_angle)
    path = series_path(law, *start, cam.range.start, cam.range.stop, terms)
    # the series of lambda has one term less than that of eta: both are wanted up to the same one
    cosines = np.asarray(coefficients(law, *start, terms + 1)[1])
    sign = np.where(phi < 0.0, -1.0, 1.0) if cam.curvature.symmetric else np.ones_like(phi)
    values = _course(path, sign * phi)
    # the mirror image has the sine and its second derivative of the other sign
    for name in ("pressure_sine", "pressure_sine_second"):
        values[name] = sign * values[name]
    data = {
        "sine_coefficient": vocabulary_variable("sine_coefficient", ("term",), path.sines),
        "cosine_coefficient": vocabulary_variable("cosine_coefficient", ("term",), cosines[: terms + 1]),
        **{name: vocabulary_variable(name, ("sample",), found) for name, found in values.items()},
    }
    coordinates = {
        "carrier_angle": vocabulary_variable("carrier_angle", ("sample",), phi),
        "term": np.arange(terms + 1),
    }
    attributes = {
        "topic": "cam-series",
        "title": cam.title,
        "cam": cam_text(cam),
        "version": __version__,
        "terms": terms,
        "recursion": "exponential" if isinstance(law, ExponentialCurvature) else "general",
    }
    return selectable(xr.Dataset(data, coords=coordinates, attrs=attributes))


def _course(path: SeriesPath, phi: Array) -> dict[str, Array]:
    """What the cut series gives at angles [rad]."""
    eta = path.sine(phi, 2)
    with np.errstate(invalid="ignore"):
        upright = np.sqrt(1.0 - eta[0] ** 2)
    return {
        "pressure_sine": eta[0],
        "pressure_sine_slope": eta[1],
        "pressure_sine_second": eta[2],
        "pressure_cosine": upright,
        "law_curvature": path.curvature(phi)[0],
        "path_radius": path.radius(phi)[0],
    }


@dataclass(frozen=True)
class CamSeriesResults:
    """The power series of a cam's path.

    Attributes
    ----------
    cam : Cam
    dataset : what `cam_series` gives of it
    """

    cam: Cam
    dataset: xr.Dataset


def cam_series_results(
    cam: AnyCam, samples: int | None = None, *, terms: int | None = None
) -> CamSeriesResults:
    """The power series of a cam's path, with the cam; raises as `cam_series` does."""
    chosen = require_curvature_cam(cam)
    return CamSeriesResults(chosen, cam_series(chosen, samples, terms=terms))
