"""Profiles of cams and shoes, and the hub's travel, as labelled results."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from centrode.cams.cam import status_of
from centrode.cams.contact_stress import Greatest, LineContact, Stressed, stress_along
from centrode.cams.followers.base_circle import follower_cam
from centrode.cams.followers.manufacture import follower_profile
from centrode.cams.parameter_choice.search import contact_of, working_arc
from centrode.cams.path_series import path_of
from centrode.cams.profiles import ProfileBody, cam_body
from centrode.cams.return_arc import ClosedPath
from centrode.cams.roller_path import FEWEST, Array, angles_of, frames, in_order_of, stalls_of
from centrode.cams.walking_wheel import Shoe, WheelMover, WheelRolling, mover, rolling
from centrode.errors import InputError, MotionError
from centrode.kinematics.motion import vocabulary_variable
from centrode.kinematics.sample_index import selectable
from centrode.locale import _, ngettext
from centrode.model import reading
from centrode.model.cam import Cam
from centrode.model.cam_files import AnyCam, cam_text, require_curvature_cam
from centrode.model.examples.catalogue import CamSource, cam_of
from centrode.model.follower_cam import PlateCam

DEFAULT_SAMPLES = 361
AXES = ["x", "y"]
SAME = 1e-9
"""Angles [rad] that are nearer than this are one."""


def cam_profile(cam: CamSource, samples: int | None = None, *, groove: bool = False) -> xr.Dataset:
    """The closed profile of a cam.

    Parameters
    ----------
    cam : Cam or PlateCam
    samples : int
        Evenly spaced over the turn, both ends included, joints added; the description's own number, else 361.
    groove : bool
        Also the outer wall of a groove; not of a cam that is given by its follower's lift.

    Returns
    -------
    Dataset
        Over `sample`: `carrier_angle` phi, which `part` ("working", "return"), the path of the roller's centre and
        the profile in the cam's axes and in polar form, pressure angle, curvatures (docs: cam-profiles). Of a cam that
        is given by its follower's lift: over `cam_angle` (docs: cam-follower-profiles).

    Raises
    ------
    InputError, MotionError
        As the description: no roller, one too large for a hollow of the groove, bounds that cannot be kept, a
        path that does not close.

    Examples
    --------
    >>> import centrode as ct
    >>> profile = ct.cam_profile(ct.example("valve-cam"), 37)
    >>> round(float(profile.profile_radius.min()), 6)
    0.024
    """
    cam = cam_of(cam)
    if isinstance(cam, PlateCam):
        if groove:
            what = _("a groove is made for a cam that is given by its roller's path")
            raise InputError("groove", what, _("omit it"))
        tool = None if cam.tool is None else cam.tool.radius
        return follower_profile(follower_cam(cam), angles_of(cam, samples), tool)
    return profile_dataset(cam, cam_body(cam), count_of(cam, samples), groove=groove)


def profile_dataset(cam: Cam, body: ProfileBody, samples: int, *, groove: bool = False) -> xr.Dataset:
    """`cam_profile` of a body that is known."""
    closed = body.closed
    phi = _angles(closed, samples)
    frame, inner = frames(closed, phi), body.profile(phi)
    _places, arcs = closed.locate(phi)
    kinds = np.array([arc.kind for arc in closed.arcs])
    variables = {
        "carrier_angle": vocabulary_variable("carrier_angle", ("sample",), phi),
        "part": ("sample", kinds[arcs]),
        "roller_centre": vocabulary_variable("roller_centre", ("sample", "axis"), frame.place),
        "path_radius": vocabulary_variable("path_radius", ("sample",), frame.radius),
        "profile": vocabulary_variable("profile", ("sample", "axis"), inner.place),
        "profile_radius": vocabulary_variable("profile_radius", ("sample",), inner.polar_radius),
        "profile_angle": vocabulary_variable("profile_angle", ("sample",), inner.polar_angle),
        "cam_pressure_angle": vocabulary_variable("cam_pressure_angle", ("sample",), frame.pressure_angle),
        "path_curvature": vocabulary_variable("path_curvature", ("sample",), frame.curvature),
        "profile_bend": vocabulary_variable("profile_bend", ("sample",), inner.bend),
    }
    if groove:
        body.fit_groove()
        variables["groove"] = vocabulary_variable(
            "groove", ("sample", "axis"), body.profile(phi, "outer").place
        )
    facts = {"topic": "cam-profile", "title": cam.title, "cam": cam_text(cam), "roller": body.roller}
    return xr.Dataset(variables, coords={"axis": AXES}, attrs=facts)


def _angles(closed: ClosedPath, samples: int) -> Array:
    """Evenly spaced angles and the joints; a joint that a sample lies on to rounding is the joint."""
    even = np.linspace(closed.start, closed.stop, samples)
    joints = np.array([joint.at for joint in closed.joints[:-1]])
    apart = np.abs(even[:, None] - joints).min(axis=1, initial=math.inf) > SAME
    return np.sort(np.concatenate([even[apart], joints]))


@dataclass(frozen=True)
class CamProfileResults:
    """The profile that a roller leaves of its cam.

    Attributes
    ----------
    cam : Cam
    groove : whether the outer wall is wanted too
    body : the closed path with its roller; None where there is none
    dataset : the labelled profile; None without a body
    refusal : why there is no body
    """

    cam: Cam
    groove: bool
    body: ProfileBody | None
    dataset: xr.Dataset | None
    refusal: MotionError | None = None


def cam_profile_results(
    cam: AnyCam, samples: int | None = None, *, groove: bool = False
) -> CamProfileResults:
    """The profile of a cam by a curvature law, also where there is none: then with the reason.

    Parameters
    ----------
    cam : Cam
    samples, groove : as of `cam_profile`

    Raises
    ------
    InputError
        As `cam_body`; a cam that is given by its follower's lift.
    """
    cam = require_curvature_cam(cam)
    try:
        body = cam_body(cam)
    except MotionError as refusal:
        return CamProfileResults(cam, groove, None, None, refusal)
    dataset = profile_dataset(cam, body, count_of(cam, samples), groove=groove)
    return CamProfileResults(cam, groove, body, dataset)


def results_of_cam_profile(cam: Cam, dataset: xr.Dataset) -> CamProfileResults:
    """A dataset of `cam_profile` with the body of its cam."""
    body, groove = cam_body(cam), "groove" in dataset
    pattern = profile_dataset(cam, body, FEWEST, groove=groove)
    return CamProfileResults(cam, groove, body, in_order_of(dataset, pattern))


def has_roller(cam: AnyCam) -> bool:
    """Whether a curvature law gives the cam, and a roller its profile."""
    return isinstance(cam, Cam) and cam.roller is not None


def shoe_profile(cam: Cam, samples: int | None = None) -> xr.Dataset:
    """The shoe of a walking wheel and the travel of its hub.

    Parameters
    ----------
    samples : int
        Evenly spaced over the arc on which a leg stands, both ends included.

    Returns
    -------
    Dataset
        Over `sample`: `carrier_angle` of the leg, the profile in the leg's axes (from the roller's centre, y along the
        leg) and in polar form, the paper's Y1 and Y2, travel and dX/dphi of the hub.

    Raises
    ------
    InputError, MotionError
        As `walking_wheel`.
    """
    return shoe_dataset(cam, walking_wheel(cam), count_of(cam, samples))


def shoe_dataset(cam: Cam, wheel: WheelMover, samples: int) -> xr.Dataset:
    """`shoe_profile` of a wheel that is known."""
    shoe: Shoe = wheel.shoe
    phi: Array = np.linspace(-wheel.half, wheel.half, samples)
    angle, radius = shoe.polar(phi)
    first, second = shoe.parts(phi)
    columns = {
        "carrier_angle": phi,
        "shoe_radius": radius,
        "shoe_angle": angle,
        "shoe_bend": shoe.bend(phi),
        "shoe_along": first,
        "shoe_upright": second,
        "hub_travel": wheel.travel(phi),
        "hub_rate": wheel.rate(phi),
    }
    variables = {name: vocabulary_variable(name, ("sample",), values) for name, values in columns.items()}
    variables["shoe_profile"] = vocabulary_variable("shoe_profile", ("sample", "axis"), shoe.place(phi))
    facts = {"topic": "walking-wheel", "title": cam.title, "cam": cam_text(cam), "hub_height": wheel.height}
    return xr.Dataset(variables, coords={"axis": AXES}, attrs=facts)


def walking_wheel(cam: CamSource) -> WheelMover:
    """The walking wheel of a description.

    Raises
    ------
    InputError
        No `[mover]`, a pressure angle at phi = 0 that makes the shoe singular, too few legs, and what a profile needs.
    MotionError
        A shoe with a cusp; no return arc within the bounds.

    Examples
    --------
    >>> import centrode as ct
    >>> wheel = ct.walking_wheel(ct.example("walking-wheel-four-legs"))
    >>> wheel.legs
    4
    """
    cam = cam_of(cam)
    return wheel_of(require_curvature_cam(cam), cam_body(cam))


def wheel_of(cam: Cam, body: ProfileBody) -> WheelMover:
    """`walking_wheel` on a body that is known."""
    if cam.mover is None:
        raise InputError("[mover]", _("a walking wheel needs legs"), _("give [mover] legs and post"))
    return replace(mover(body.closed, cam.mover.legs, cam.mover.post, body.roller), cam=cam)


def count_of(cam: Cam, samples: int | None) -> int:
    """The number of samples asked for; InputError if it is none."""
    asked = samples if samples is not None else cam.study.samples
    count = DEFAULT_SAMPLES if asked is None else asked
    if isinstance(count, bool) or not 2 <= count <= reading.SAMPLES:
        raise InputError(
            _("samples"),
            ngettext("{n} sample is given", "{n} samples are given", count).format(n=count),
            _("give {least} to {most}").format(least=2, most=reading.SAMPLES),
        )
    return count


INSTANTS = 6
"""Instants over a step, where none are chosen."""


@dataclass(frozen=True)
class WalkingWheelResults:
    """A walking wheel with the proof that it rolls level without slip.

    Attributes
    ----------
    cam : Cam
    wheel : the wheel; None where there is none
    proof : of the wheel
    dataset : the labelled shoe, with the travel of the hub
    uneven : stretches [rad] of a standing leg on which the profile is undercut, so that the roller leaves its path
    instants : angles [rad] by which the carrier has turned, to show the wheel there
    refusal : why there is no shoe; None as well where the cam has no profile, which the profile says
    """

    cam: Cam
    wheel: WheelMover | None = None
    proof: WheelRolling | None = None
    dataset: xr.Dataset | None = None
    uneven: tuple[tuple[float, float], ...] = ()
    instants: tuple[float, ...] = ()
    refusal: MotionError | None = None


def walking_wheel_results(
    cam: AnyCam, samples: int | None = None, *, instants: Sequence[float] = ()
) -> WalkingWheelResults:
    """The walking wheel of a description, also where there is none: then with the reason.

    Parameters
    ----------
    cam : Cam
    samples : int
        As of `shoe_profile`.
    instants : angles [rad]
        That the carrier has turned; those of the description, otherwise some over a step, if there are none.

    Raises
    ------
    InputError
        As `walking_wheel`; a cam that is given by its follower's lift.
    """
    cam = require_curvature_cam(cam)
    try:
        body = cam_body(cam)
    except MotionError:
        return WalkingWheelResults(cam)
    try:
        wheel = wheel_of(cam, body)
    except MotionError as refusal:
        return WalkingWheelResults(cam, refusal=refusal)
    pitch = math.tau / wheel.legs
    even = tuple(pitch * (number / (INSTANTS - 1) - 0.5) for number in range(INSTANTS))
    return WalkingWheelResults(
        cam,
        wheel,
        rolling(wheel),
        shoe_dataset(cam, wheel, count_of(cam, samples)),
        tuple(_uneven(body, wheel)),
        tuple(instants) or cam.study.instants or even,
    )


def results_of_walking_wheel(cam: Cam, dataset: xr.Dataset) -> WalkingWheelResults:
    """A dataset of `shoe_profile` with the wheel of its cam."""
    found = walking_wheel_results(cam, FEWEST)
    assert found.dataset is not None
    return replace(found, dataset=in_order_of(dataset, found.dataset))


def results_of_wheel(cam: Cam, wheel: WheelMover) -> WalkingWheelResults:
    """A walking wheel with its shoe, and the proof that it rolls level without slip."""
    return replace(walking_wheel_results(cam), wheel=wheel)


def _uneven(body: ProfileBody, wheel: WheelMover) -> list[tuple[float, float]]:
    """Stretches [rad] of a standing leg on which the profile is undercut."""
    found = []
    for cut in body.undercuts:
        for turn in (0.0, math.tau):
            start, stop = max(cut.start - turn, -wheel.half), min(cut.stop - turn, wheel.half)
            if stop - start > SAME:
                found.append((start, stop))
    return sorted(found)


def has_mover(cam: AnyCam) -> bool:
    """Whether a curvature law gives the cam, and it is that of a wheel with legs."""
    return isinstance(cam, Cam) and cam.mover is not None


# Contact stress of a described cam as a labelled result.


@dataclass(frozen=True)
class CamContactResults:
    """The contact of roller and cam over the working arc.

    Attributes
    ----------
    cam : Cam
    dataset : of `cam_contact`
    """

    cam: Cam
    dataset: xr.Dataset

    @property
    def missing(self) -> int:
        """Number of samples at which roller and cam do not touch: the cam is undercut there."""
        return int(np.isnan(self.dataset["contact_stress"].values).sum())

    @property
    def worst(self) -> int:
        """Number of the sample with the greatest stress."""
        return int(np.nanargmax(self.dataset["contact_stress"].values))


def cam_contact_results(cam: AnyCam, samples: int | None = None) -> CamContactResults:
    """The contact of roller and cam; parameters and errors are those of `cam_contact`."""
    return CamContactResults(require_curvature_cam(cam), cam_contact(cam, samples))


def has_contact(cam: AnyCam) -> bool:
    """Whether a curvature law gives the cam, and a force presses its roller on it."""
    return isinstance(cam, Cam) and cam.contact is not None


def cam_contact(cam: CamSource, samples: int | None = None) -> xr.Dataset:
    """Contact of roller and cam over the working arc.

    Parameters
    ----------
    cam : Cam
        With `[contact]`.
    samples : int
        Evenly spaced over the working arc, both ends included; the description's own number, else 361.

    Returns
    -------
    Dataset
        By the angle `carrier_angle`: `contact_stress`, `contact_stress_by_source`, `contact_shear`,
        `contact_depth`, `contact_half_width` and `cam_curvature_radius`, NaN where the cam is undercut or the
        follower has stalled. Its attributes hold the greatest stress by both formulas with its angle, of a symmetric
        cam the positive one; infinite where the working arc ends in a stall.

    Raises
    ------
    InputError
        No contact, a curvature that no cam has; a strip wider than the roller, for which the formulas do not hold.

    Examples
    --------
    >>> import centrode as ct
    >>> contact = ct.cam_contact(ct.example("walking-wheel-four-legs"), 37)
    >>> print(ct.summary(contact).splitlines()[2])
    greatest contact stress  626.262 MPa at ±45 deg, more than the admissible 600 MPa
    """
    cam = cam_of(cam)
    cam = require_curvature_cam(cam)
    contact = contact_of(cam)
    if contact is None:
        what = _("the contact stress needs the force, the width and the materials")
        raise InputError("[contact]", what, _("write a table [contact]"))
    path = path_of(cam)
    low, high = working_arc(cam)
    ends = max(low, path.start), min(high, path.stop)
    phi = np.linspace(*ends, len(angles_of(cam, samples)))
    looked = (0.0, ends[1]) if cam.curvature.symmetric else ends
    found = stress_along(path, contact, phi, looked)
    stalls = [one for one in stalls_of(path) if one in looked]
    if stalls:  # cos gamma runs to zero
        endless = Greatest(math.inf, stalls[-1])
        found = replace(found, greatest=endless, greatest_by_source=endless)
    _check_strip(found, contact)
    values = {
        "contact_stress": found.strip.pressure,
        "contact_stress_by_source": found.by_source,
        "contact_shear": found.strip.shear,
        "contact_depth": found.strip.depth,
        "contact_half_width": found.strip.half_width,
        "cam_curvature_radius": found.cam_radius,
    }
    attributes: dict[str, Any] = {
        "topic": "cam-contact",
        "title": cam.title,
        "cam": cam_text(cam),
        "greatest_stress": found.greatest.value,
        "greatest_stress_at": found.greatest.angle,
        "greatest_stress_by_source": found.greatest_by_source.value,
        "greatest_stress_by_source_at": found.greatest_by_source.angle,
        "contact_modulus": contact.modulus,
    }
    if cam.contact is not None and cam.contact.admissible is not None:
        attributes["admissible_stress"] = cam.contact.admissible
    data = {name: vocabulary_variable(name, ("sample",), one) for name, one in values.items()}
    data["status"] = status_of(path, phi)
    coordinates = {"carrier_angle": vocabulary_variable("carrier_angle", ("sample",), phi)}
    return selectable(xr.Dataset(data, coords=coordinates, attrs=attributes))


def _check_strip(found: Stressed, contact: LineContact) -> None:
    """Raise InputError where all strips are wider than the roller: a force or modulus in other units."""
    widths = 2.0 * found.strip.half_width
    known = widths[np.isfinite(widths)]
    if known.size and float(known.min()) > 2.0 * contact.roller_radius:
        what = _("the strip of contact would be {width:.4g} mm wide, wider than the roller").format(
            width=1e3 * float(known.min())
        )
        raise InputError(
            "[contact]", what, _('check the units: a force such as "3 kN", an elasticity "206 GPa"')
        )
