"""Sensitivity of cams with followers: pressure angle and lift by base radius, roller, offset and lengths of an arm.

The pressure angle is that of the cam that is drawn anew for another number. The lift follows the law however the cam is
drawn; here it is that of the cam as it was made, under a follower whose number deviates: the follower's place at every
angle of the cam. A roller's centre lies at a distance r from the profile; if r grows by dr, or the profile by dr all
along its normal, the follower gives way by ds with n . (dP/ds ds + dP/dp dp) = dr.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.cams.followers.base_circle import FollowerLayout, follower_cam, layout_of
from centrode.cams.followers.geometry import FollowerCam, Oscillating, Translating
from centrode.cams.roller_path import JETS
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cam_files import cam_text, with_follower
from centrode.model.examples.catalogue import CamSource, cam_of
from centrode.model.reading import nearest, value_text
from centrode.numerics.jets import Jet
from centrode.version import __version__

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

OUTPUTS = ("pressure_angle", "lift")
BASE, ROLLER, OFFSET = "cam.base_radius", "follower.roller_radius", "follower.offset"
ARM, DISTANCE, FACE = "follower.arm", "follower.pivot_distance", "follower.face_offset"
SAMPLES = 361


def paths_of_cam(layout: FollowerLayout) -> tuple[str, ...]:
    """Numbers that a cam with this follower depends on."""
    if layout.kind == "translating":
        return (BASE,) if layout.flat else (BASE, ROLLER, OFFSET)
    return (BASE, DISTANCE, FACE) if layout.flat else (BASE, ROLLER, ARM, DISTANCE)


def cam_sensitivity(
    cam: CamSource,
    outputs: str | Sequence[str] = OUTPUTS,
    by: Sequence[str] | None = None,
    at: npt.ArrayLike | None = None,
    samples: int | None = None,
) -> xr.Dataset:
    """Derivatives of a cam's pressure angle and of its follower's lift by its numbers, at angles of the cam.

    Parameters
    ----------
    outputs : "pressure_angle", "lift"
        The pressure angle [rad] of the cam that is drawn for the number; the lift [m or rad] of the cam as it was made,
        under a follower whose number deviates. By `cam.base_radius` the profile of the made cam grows all along its
        normal.
    by : paths
        "cam.base_radius", "follower.roller_radius", "follower.offset", "follower.arm", "follower.pivot_distance",
        "follower.face_offset", as far as the follower has them; all of these without.
    at : angles of the cam [rad]
    samples : evenly spaced over a turn, 361 by default

    Returns
    -------
    Dataset
        `gradient.OUTPUT` (sample, path) and the outputs (sample), with `cam_angle` (sample).

    Raises
    ------
    InputError
        An unknown output or path, a cam that is given by its curvature.

    Examples
    --------
    >>> import centrode as ct
    >>> found = ct.sensitivity(ct.example("valve-cam"), ["lift"], samples=5)
    >>> found["gradient.lift"].dims
    ('sample', 'path')
    """
    plate = with_follower(cam_of(cam))
    body, layout = follower_cam(plate), layout_of(plate)
    known = paths_of_cam(layout)
    names = [outputs] if isinstance(outputs, str) else list(outputs)
    for name in names:
        if name not in OUTPUTS:
            what = _("there is no {word} in {name}")
            raise InputError(
                "outputs", what.format(word=value_text(name), name="cam"), nearest(str(name), OUTPUTS)
            )
    paths = list(known) if by is None else [by] if isinstance(by, str) else list(by)
    for path in paths:
        if path not in known:
            what = _("the cam has no {name}").format(name=value_text(path))
            raise InputError("by", what, nearest(str(path), known))
    count = SAMPLES if samples is None else samples
    angles = np.linspace(0.0, 2.0 * np.pi, count) if at is None else np.atleast_1d(np.asarray(at, float))
    contact = body.contact(np.mod(angles, 2.0 * np.pi))
    variables: dict[str, Any] = {}
    compute: dict[str, Callable[[FollowerCam, FollowerLayout, str, Array], Array]] = {
        "pressure_angle": pressure_gradient,
        "lift": lift_gradient,
    }
    units = {"pressure_angle": "rad", "lift": "m" if layout.kind == "translating" else "rad"}
    for name in names:
        columns = [compute[name](body, layout, path, np.mod(angles, 2.0 * np.pi)) for path in paths]
        described = {"units": units[name]}
        variables[name] = xr.Variable(("sample",), getattr(contact, name), described)
        variables[f"gradient.{name}"] = xr.Variable(("sample", "path"), np.stack(columns, axis=-1), described)
    coords = {"path": paths, "cam_angle": ("sample", angles, {"units": "rad"})}
    attributes = {
        "topic": "cam-sensitivity",
        "title": plate.title,
        "cam": cam_text(plate),
        "version": __version__,
        "outputs": "\n".join(names),
    }
    return xr.Dataset(variables, coords, attrs=attributes)


def pressure_gradient(body: FollowerCam, layout: FollowerLayout, path: str, phi: Array) -> Array:
    """Derivative of the pressure angle by a number [rad/m], (n)."""
    if layout.flat:
        return _pressure_of_face(body, layout, path, phi)
    numbers = {
        BASE: body.base_radius,
        ROLLER: layout.touch.roller,
        OFFSET: layout.offset,
        ARM: layout.arm,
        DISTANCE: layout.distance,
    }
    # one number varies, and all that follows from it carries its derivative
    given: dict[str, Number] = {
        name: Jet.variable(np.full_like(phi, x), 1) if name == path else x for name, x in numbers.items()
    }
    radius = given[BASE] + given[ROLLER]
    lift = body.motion.lift(phi, 1)
    guide: Translating | Oscillating
    if layout.kind == "translating":
        guide = Translating(_root(radius * radius - given[OFFSET] * given[OFFSET]), given[OFFSET])
        scale: Number = 1.0
    else:
        arm, distance = given[ARM], given[DISTANCE]
        cosine = (arm * arm + distance * distance - radius * radius) / (arm * distance * 2.0)
        start = JETS.atan2(_root((1.0 - cosine) * (1.0 + cosine)), cosine)
        guide, scale = Oscillating(start, distance, arm), arm
    rise = Jet((lift[0], np.zeros_like(phi)))
    (x, y), (across, up) = guide.centre(JETS, rise), guide.direction(JETS, rise)
    sense = body.sense
    u, v = across * scale * lift[1] + y * sense, up * scale * lift[1] - x * sense
    pressure = JETS.atan2(u * across + v * up, (u * up - v * across) * sense)
    return np.asarray(pressure.derivative(1) + 0.0 * phi)


def _root(x: Number) -> Number:
    return JETS.sqrt(x) if isinstance(x, Jet) else np.sqrt(x)


def _pressure_of_face(body: FollowerCam, layout: FollowerLayout, path: str, phi: Array) -> Array:
    """Of a flat face that slides the angle is zero; of one that turns it is that of its offset over the contact."""
    if layout.kind == "translating":
        return np.zeros_like(phi)
    lift = body.motion.lift(phi, 1)
    numbers = {BASE: body.base_radius, DISTANCE: layout.distance, FACE: layout.face_offset}
    given = {
        name: Jet.variable(np.full_like(phi, x), 1) if name == path else x for name, x in numbers.items()
    }
    sine = (given[BASE] + given[FACE]) / given[DISTANCE]
    psi = JETS.atan2(sine, _root((1.0 - sine) * (1.0 + sine))) + Jet((lift[0], np.zeros_like(phi)))
    # the foot of the normal: slope of the face's distance over that of its angle
    foot = JETS.cos(psi) * given[DISTANCE] * lift[1] / (lift[1] + body.sense)
    along = JETS.cos(psi) * given[DISTANCE] - foot
    pressure = JETS.atan2(along * 0.0 - given[FACE] * body.sense, along)
    return np.asarray(pressure.derivative(1))


def lift_gradient(body: FollowerCam, layout: FollowerLayout, path: str, phi: Array) -> Array:
    """Derivative of the lift of the made cam by a number [1, of an oscillating follower rad/m], (n)."""
    contact = body.contact(phi)
    guide = body.guide
    if layout.flat:
        if isinstance(guide, Translating):
            return np.ones_like(phi)
        psi = contact.lift + guide.start
        push = {BASE: np.ones_like(phi), FACE: np.ones_like(phi), DISTANCE: -np.sin(psi)}
        return np.asarray(push[path] / contact.along)
    normal = body.in_frame(contact.normal, phi)
    direction = np.stack(guide.direction(np, contact.lift), axis=-1)
    scale = guide.arm if isinstance(guide, Oscillating) else 1.0
    along = scale * np.sum(normal * direction, axis=-1)
    if path in (BASE, ROLLER):
        return np.asarray(1.0 / along)
    if path in (OFFSET, DISTANCE):
        moved = np.broadcast_to([1.0, 0.0], normal.shape)
    else:
        assert isinstance(guide, Oscillating)
        psi = contact.lift + guide.start
        moved = np.stack([-np.cos(psi), np.sin(psi)], axis=-1)
    return np.asarray(-np.sum(normal * moved, axis=-1) / along)
