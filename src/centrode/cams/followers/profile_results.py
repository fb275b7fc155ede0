"""The profile under a follower with its outlines and points, and second routes to it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.cams.followers.base_circle import follower_cam
from centrode.cams.followers.closed_forms import TURN, ClosedForms
from centrode.cams.followers.forces import meeting_of
from centrode.cams.followers.geometry import FollowerCam
from centrode.cams.followers.manufacture import (
    check_cutter,
    follower_outlines,
    follower_profile,
    points_dataset,
)
from centrode.cams.followers.motion import derivative, extremes_of, follower_motion, greatest_size
from centrode.cams.nodes import nodes_of
from centrode.cams.roller_path import FEWEST, angles_of, in_order_of
from centrode.model.cam_files import AnyCam, with_follower
from centrode.model.follower_cam import PlateCam
from centrode.numerics.outline_pieces import OutlinePiece
from centrode.numerics.search import roots

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class FollowerProfileResults:
    """The profile of a cam with a follower.

    Attributes
    ----------
    cam : PlateCam
    body : FollowerCam
    outlines : the profile, the path of a roller's centre and that of a cutter's, in smooth pieces
    dataset : the labelled profile over a turn
    points : labelled points for a machine, whose chords keep the tolerance of the description
    greatest_radius : greatest polar radius of the profile [m]
    shown : angle [rad] for which formulas have numbers
    shown_by : why that one: "choice", "pressure angle" or "velocity", which are greatest there
    """

    cam: PlateCam
    body: FollowerCam
    outlines: tuple[OutlinePiece, ...]
    dataset: xr.Dataset
    points: xr.Dataset
    greatest_radius: float
    shown: float
    shown_by: str


def follower_profile_results(
    cam: AnyCam, samples: int | None = None, *, instants: Sequence[float] | None = None
) -> FollowerProfileResults:
    """The profile of a cam with a follower, its outlines, and points for a machine.

    Parameters
    ----------
    cam : PlateCam
    samples : int
        Evenly spaced over the turn; the description's own number, else 361.
    instants : angles [rad]
        Formulas have numbers for the first of them; those of the description if left out.

    Raises
    ------
    InputError, MotionError
        As `follower_cam`; a cutter that is larger than a hollow; a tolerance that asks for too many points.
    """
    plate = with_follower(cam)
    body = follower_cam(plate)
    cutter = None if plate.tool is None else plate.tool.radius
    outlines = follower_outlines(body, plate.study.chord_tolerance, cutter)
    if cutter is not None:
        check_cutter(body, cutter)
    chosen = plate.study.instants if instants is None else tuple(instants)
    shown, shown_by = (chosen[0], "choice") if chosen else _example(plate, body)
    return FollowerProfileResults(
        plate,
        body,
        tuple(outlines),
        follower_profile(body, angles_of(plate, samples), cutter),
        points_dataset(outlines),
        _greatest_radius(body),
        shown,
        shown_by,
    )


def results_of_follower_profile(cam: PlateCam, dataset: xr.Dataset) -> FollowerProfileResults:
    """A dataset of `cam_profile` with the outlines of its cam, and points for a machine."""
    found = follower_profile_results(cam, FEWEST)
    return replace(found, dataset=in_order_of(dataset, found.dataset))


def results_of_follower_cam(cam: PlateCam, body: FollowerCam) -> FollowerProfileResults:
    """A cam under its follower with its profile, its outlines, and points for a machine."""
    return replace(follower_profile_results(cam), body=body)


def _greatest_radius(body: FollowerCam) -> float:
    """It lies where the lift rests, as the normal then meets the centre."""
    nodes = nodes_of(body.edges)
    phi = np.append(nodes, roots(lambda phi: np.asarray(body.motion.lift(phi, 1)[1]), nodes))
    return float(np.hypot(*body.contact(phi).place.T).max())


def _example(cam: PlateCam, body: FollowerCam) -> tuple[float, str]:
    """The angle of the greatest pressure angle; under a face that has none, of the greatest slope of the lift."""
    if ClosedForms(body).has_pressure_angle and not body.pressure.greatest == body.pressure.least == 0.0:
        return body.pressure.at_greatest, "pressure angle"
    slopes = extremes_of(follower_motion(cam).law, 2, derivative(1))
    return greatest_size(slopes)[1], "velocity"


# Second routes: closed forms, and the contact by the instant centre


def pressure_difference(body: FollowerCam) -> float:
    """The greatest difference [rad] of pressure angles by the closed form and by the normal of the envelope."""
    tangent = ClosedForms(body).pressure(body.motion.lift(TURN, 3))
    return float(np.abs(np.arctan(tangent) - body.contact(TURN).pressure_angle).max())


def curvature_difference(body: FollowerCam) -> tuple[float, float]:
    """By which share the curvature by the closed form differs from that of the envelope.

    Returns it with the factor by which rounding grows where the profile is nearly, or is, undercut; infinite at a cusp.
    """
    contact = body.contact(TURN)
    with np.errstate(divide="ignore"):
        curvature = 1.0 / ClosedForms(body).radius(body.motion.lift(TURN, 3))
    size = 1.0 / body.base_radius + np.abs(contact.curvature)
    apart = float(np.max(np.abs(curvature - contact.curvature) / size))
    # near a cusp the radius of curvature is what is left of much greater numbers
    finite = np.isfinite(contact.bend)
    left = float(np.max(np.abs(contact.path_curvature * contact.bend), initial=1.0, where=finite))
    least = float(np.abs(contact.stretch).min())
    scale = 1.0 if np.isfinite(body.touch.roller) else body.base_radius
    return apart, max(1.0, left, scale / least if least > 0.0 else np.inf)


def profile_difference(body: FollowerCam) -> float:
    """The greatest distance [m] of points of the profile by the closed forms from those of the envelope."""
    places = ClosedForms(body).place(TURN, body.motion.lift(TURN, 3))
    return float(np.hypot(*(places - body.contact(TURN).place).T).max())


def instant_centre_difference(body: FollowerCam) -> float:
    """The greatest distance [m] of points by the instant centre of cam and follower, which no profile enters."""
    met = meeting_of(body, body.motion.lift(TURN, 3))
    roller = body.touch.roller if np.isfinite(body.touch.roller) else 0.0
    places = met.place - roller * met.normal
    return float(np.hypot(*(body.in_frame(body.contact(TURN).place, TURN) - places).T).max())


def is_never_undercut(body: FollowerCam) -> bool:
    """Whether by the closed forms no stretch of the profile runs back."""
    forms, rows = ClosedForms(body), body.motion.lift(TURN, 3)
    if forms.flat:
        return bool(np.all(forms.radius(rows) > 0.0))
    return bool(np.all(1.0 - forms.roller * forms.bending(rows) > 0.0))
