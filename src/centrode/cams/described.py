"""From the description of a cam to its curvature law and the path of its roller's centre."""

from __future__ import annotations

import math

from centrode.cams.curvature_laws import (
    ConstantCurvature,
    CurvatureLaw,
    ExponentialCurvature,
    LinearCurvature,
    SplineCurvature,
)
from centrode.cams.expanded import TOLERANCE, ExpandedPath, expanded_path
from centrode.cams.path import RollerPath, SymmetricPath
from centrode.cams.text_curvature import TextCurvature
from centrode.errors import InputError
from centrode.model.cams.files import AnyCam, curved


def law_of(cam: AnyCam) -> CurvatureLaw:
    """The curvature law K(phi) [1/m] of a cam; InputError where its numbers make none."""
    cam = curved(cam)
    given = cam.curvature
    try:
        if given.law == "constant":
            return ConstantCurvature(given.k0 or math.nan)
        if given.law == "exponential":
            return ExponentialCurvature(given.k0 or math.nan, given.k1 or 0.0)
        if given.law == "linear":
            return LinearCurvature(given.k0 or math.nan, given.k1 or 0.0)
        if given.law == "spline":
            angles, values = zip(*given.points or (), strict=True)
            return SplineCurvature(angles, values)
        return TextCurvature(
            given.formula or "", cam.range.start, cam.range.stop, tuple(given.constants.items())
        )
    except InputError as error:
        raise InputError(error.where or "[curvature]", error.what, error.repair) from None


def half_path(cam: AnyCam, tolerance: float = TOLERANCE) -> ExpandedPath:
    """The path that the law itself gives: of a symmetric cam the half with phi >= 0."""
    cam = curved(cam)
    start = cam.start
    return expanded_path(
        law_of(cam), start.radius, start.pressure_angle, cam.range.start, cam.range.stop, tolerance
    )


def path_of(cam: AnyCam, tolerance: float = TOLERANCE) -> RollerPath:
    """The path of the roller's centre, by series expanded anew step by step to a tolerance.

    Raises
    ------
    InputError
        A curvature that is not positive and finite where the path goes, its angle is told.
    """
    cam = curved(cam)
    half = half_path(cam, tolerance)
    return SymmetricPath(half) if cam.curvature.symmetric else half
