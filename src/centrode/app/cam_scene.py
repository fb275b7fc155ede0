"""The picture of a cam as data: its outline, the path of its roller, the lift of its follower, its segments."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.app.cam_segments import segment_rows
from centrode.app.documents import Document
from centrode.app.quantity_texts import field_text
from centrode.app.sketch import display_units, list_of_tables
from centrode.cams.cam import cam as course_of
from centrode.cams.followers.base_circle import follower_cam, has_profile
from centrode.cams.followers.geometry import Oscillating
from centrode.cams.results import cam_profile
from centrode.errors import CentrodeError
from centrode.locale import _, mark
from centrode.model.cam import Cam
from centrode.model.follower_cam import PlateCam
from centrode.model.units import number_and_unit
from centrode.scenes.driving_cams import DrivingCam

DIGITS = 6
"""Significant digits of a place in the picture."""
SAMPLES = 361
FIELDS = {
    "base_radius": mark("base radius"),
    "radius": mark("radius"),
    "pressure_angle": mark("pressure angle"),
    "to": mark("to"),
    "speed": mark("speed"),
    "thickness": mark("thickness of the cam"),
    "roller_radius": mark("radius of the roller"),
    "offset": mark("offset of the follower"),
    "arm": mark("arm of the follower"),
    "pivot_distance": mark("distance of the pivots"),
    "face_offset": mark("offset of the face"),
    "mass": mark("mass"),
    "inertia": mark("moment of inertia"),
    "load": mark("load"),
    "friction": mark("coefficient of friction"),
}
"""Numbers of the cam and its follower, as the editor names them."""
FIELDS_OF = {
    ("start", "radius"): mark("radius at the start"),
    ("roller", "radius"): mark("radius of the roller"),
    ("range", "to"): mark("end of the path"),
}
"""Those whose names tell nothing without their table."""


def cam_scene(document: Document) -> dict[str, Any]:
    """The scene of a cam, right or not."""
    title = document.tables.get("title")
    return {
        "title": _(title) if isinstance(title, str) else "",
        "kind": "cam",
        "display": display_units(document.tables),
        "size": [[-1.0, -1.0], [1.0, 1.0]],
        **{key: [] for key in ("points", "links", "guides", "drives", "wheels", "cylinders", "loads")},
        "rows": {},
        "dimensions": list(_dimensions(document)),
        "cam": _cam(document),
    }


def _cam(document: Document) -> dict[str, Any]:
    found: dict[str, Any] = {
        "profile": [],
        "pitch": None,
        "base": None,
        "roller": None,
        "displacement": None,
        "follower": None,
        "carrier": None,
        "segments": list(segment_rows(document)),
    }
    cam = document.cam
    if isinstance(cam, PlateCam):
        found["displacement"] = _displacement(cam)
    if cam is None:
        return found
    try:
        if isinstance(cam, PlateCam) and not has_profile(cam):
            return found
        profile = cam_profile(cam, SAMPLES)
    except CentrodeError as failure:
        # the path of a roller is there without the roller
        path = {} if isinstance(cam, PlateCam) else _path_of_roller(cam)
        return {**found, **path, "open": True, "missing": failure.what, "repair": failure.repair}
    found["profile"] = _places(profile["profile"].to_numpy())
    if isinstance(cam, PlateCam):
        found["follower"] = follower_scene(cam, np.linspace(0.0, math.tau, SAMPLES))
    if not isinstance(cam, PlateCam):
        found |= _roller_on_path(profile)
    elif "roller_centre" in profile:
        found["pitch"] = _places(profile["roller_centre"].to_numpy())
    for key, name in (("base", "base_radius"), ("roller", "roller")):
        value = profile.attrs.get(name)
        found[key] = float(value) if value is not None and np.isfinite(value) else None
    return found


def _path_of_roller(cam: Cam) -> dict[str, Any]:
    try:
        return _roller_on_path(course_of(cam, SAMPLES))
    except CentrodeError:
        return {}


def _roller_on_path(data: xr.Dataset) -> dict[str, Any]:
    """Where a carrier leads its roller around a cam that stands, as far as it is known: angles [rad] and places."""
    places, angles = data["roller_centre"].to_numpy(), data["carrier_angle"].to_numpy()
    known = np.isfinite(places).all(axis=1) & np.isfinite(angles)
    return {"pitch": _places(places[known]), "carrier": [float(f"{x:.7g}") for x in angles[known]]}


def _places(places: Any) -> list[list[float]]:
    places = np.asarray(places, dtype=float)
    return [[float(f"{x:.6g}"), float(f"{y:.6g}")] for x, y in places[np.isfinite(places).all(axis=1)]]


def _displacement(cam: PlateCam) -> dict[str, Any]:
    """Lift of the follower with two derivatives by the angle of the cam, over a turn."""
    try:
        course = course_of(cam, SAMPLES)
    except CentrodeError as failure:
        return {"missing": failure.what, "repair": failure.repair}
    stem = "lift" if "lift" in course else "swing"
    names = {
        "angle": "cam_angle",
        "lift": stem,
        "velocity": f"{stem}_slope",
        "acceleration": f"{stem}_second",
    }
    unit = "m" if stem == "lift" else "rad"
    numbers = {key: [_finite(x) for x in course[name].to_numpy()] for key, name in names.items()}
    return {**numbers, "unit": unit}


def _finite(value: float) -> float | None:
    return float(f"{value:.7g}") if np.isfinite(value) else None


def _dimensions(document: Document) -> Iterator[dict[str, Any]]:
    """Numbers of the body, the follower and the segments, as the text has them."""
    for room in ("cam", "follower", "curvature", "start", "range", "roller"):
        table = document.tables.get(room)
        if isinstance(table, Mapping):
            yield from _numbers(room, table, room)
    for k, segment in enumerate(list_of_tables(document.tables, "segments")):
        yield from _numbers(f"segments.{k}", segment, f"segments.{k}")


def _numbers(path: str, table: Mapping[str, Any], owner: str) -> Iterator[dict[str, Any]]:
    for key, value in table.items():
        if isinstance(value, bool) or not isinstance(value, int | float | str):
            continue
        found = number_and_unit(str(value))
        if found is None:
            continue
        number = float(found[0])
        yield {
            "of": owner,
            "path": f"{path}.{key}",
            "name": _field_name(owner, key),
            "value": number,
            "unit": found[1],
            "shown": field_text(number),
            "locked": False,
        }


def _field_name(owner: str, key: str) -> str:
    name = FIELDS_OF.get((owner, key)) or FIELDS.get(key)
    return _(name) if name else key.replace("_", " ")


def follower_scene(cam: PlateCam, angles: npt.NDArray[np.float64]) -> dict[str, Any] | None:
    """The follower at angles (n) [rad] of the cam; None where this cannot lead it.

    `places` are centres of the roller, the edge, or the foot of a stem on its face, (n, 2) [m]; `faces` the ends of
    the straight parts of a flat-faced follower, (n, 4) or (n, 8) [m]; `sense` is 1 where the cam turns
    counter-clockwise, else -1; `pivot` that of an oscillating follower [m].
    """
    try:
        body = follower_cam(cam)
        drawing = DrivingCam.alone(body, angles, 1.0)
        lift = body.motion.lift(np.mod(angles, math.tau))[0]
    except CentrodeError:
        return None
    oscillating = isinstance(body.guide, Oscillating)
    flat = math.isinf(body.touch.roller)
    places = None
    if not (flat and oscillating):
        places = np.stack(np.broadcast_arrays(*body.guide.centre(np, lift)), axis=-1)
    faces = None
    if flat:
        lines = [np.ravel(drawing.lines(sample)) for sample in range(len(angles))]
        faces = [_rounded_numbers(line) for line in lines]
    return {
        "sense": 1 if body.sense > 0.0 else -1,
        "contact": cam.follower.contact,
        "places": None if places is None else [_rounded_numbers(place) for place in places],
        "faces": faces,
        "pivot": None if drawing.pivot is None else _rounded_numbers(drawing.pivot),
    }


def _rounded_numbers(numbers: npt.NDArray[np.float64]) -> list[float | None]:
    return [float(f"{x:.{DIGITS}g}") if math.isfinite(x) else None for x in numbers]
