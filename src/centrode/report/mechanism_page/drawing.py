"""What a page draws of a mechanism, as plain data: its signs, and which numbers they hang on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from centrode.model.links import Guide, Link, Rolling
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.values import unit_vector
from centrode.render.drawing.colours import GROUND
from centrode.report.html.stage import SCREEN_COLOURS, look_of_link, support_sign
from centrode.report.mechanism_page.driving_cams import cams_of
from centrode.report.mechanism_page.numbers_that_vary import joints_of
from centrode.scenes.places import corners
from centrode.scenes.sphere import view_of

if TYPE_CHECKING:
    import xarray


def drawing_of(
    mechanism: Mechanism, motion: xarray.Dataset, points: list[str], links: list[str]
) -> dict[str, Any]:
    """The signs of a mechanism.

    Parameters
    ----------
    mechanism : Mechanism
    motion : Dataset
        Of `motion`: on the sphere the direction of sight follows from it.
    points, links : names in the order of the page
    """
    joints = joints_of(mechanism)
    in_plane = mechanism.space == "plane"
    cams, not_drawn = cams_of(mechanism, motion, points, links)
    return {
        "points": [_point(mechanism, name, joints) for name in points],
        "bodies": _bodies(mechanism, points, links),
        "tracks": [points.index(name) for name in mechanism.moving_points],
        "guides": [_guide(guide, points, links) for guide in mechanism.guides] if in_plane else [],
        "wheels": [_wheel(mechanism, wheel, points, links) for wheel in mechanism.rolling],
        "cylinders": [
            [points.index(end) for end in drive.distance]
            for drive in mechanism.drives
            if drive.distance is not None
        ],
        "cams": cams,
        "notDrawn": not_drawn,
        "rings": [] if in_plane else _rings(mechanism, points, links),
        "support": support_sign(),
        "view": None if in_plane else _view(mechanism, motion),
    }


def _point(mechanism: Mechanism, name: str, joints: set[str]) -> dict[str, Any]:
    rails = [guide for guide in mechanism.guides if guide.point == name and guide.on == FRAME]
    slope = None
    if rails and mechanism.space == "plane":
        slope = round(-float(np.degrees(rails[0].direction_angle)), 3)
    own = {"name": name, "fixed": name in mechanism.frame.points, "dot": name not in joints, "slider": slope}
    if not own["fixed"]:
        return own
    axes = ("x", "y") if mechanism.space == "plane" else ("longitude", "latitude")
    paths = [f"frame.points.{name}.{axis}" for axis in axes]
    return {**own, "frame": list(mechanism.frame.coordinates[name]), "paths": paths}


def _bodies(mechanism: Mechanism, points: list[str], links: list[str]) -> list[dict[str, Any]]:
    """The links, then the rods of cylinders that are no links of the description."""
    found: list[dict[str, Any]] = []
    for number, name in enumerate(links):
        link = mechanism.links[name]
        found.append(
            {
                "name": name,
                "link": number,
                "points": [points.index(one) for one in corners(link)],
                "locals": [_local(name, link, one, points) for one in link.coordinates],
                **look_of_link(number),
            }
        )
    for drive in mechanism.drives:
        if drive.distance is not None and drive.id not in mechanism.links:
            ends = [points.index(end) for end in drive.distance]
            found.append({"name": drive.id, "points": ends, "locals": [], **look_of_link(len(found))})
    return found


def _local(name: str, link: Link, point: str, points: list[str]) -> dict[str, Any]:
    """A point in the axes of its link, with the paths of the numbers that place it."""
    x, y = link.coordinates[point]
    own: dict[str, Any] = {"point": points.index(point), "at": [x, y]}
    if link.length is not None:
        return {**own, "length": f"links.{name}.length"} if x else own
    return {**own, "x": f"links.{name}.points.{point}.x", "y": f"links.{name}.points.{point}.y"}


def _index(links: list[str], name: str | None) -> int | None:
    return None if name is None or name == FRAME else links.index(name)


def _guide(guide: Guide, points: list[str], links: list[str]) -> dict[str, Any]:
    return {
        "point": points.index(guide.point),
        "on": _index(links, guide.on),
        "link": _index(links, guide.link),
        "direction": guide.direction_angle,
        "directionPath": f"guides.{guide.id}.direction",
    }


def _wheel(mechanism: Mechanism, wheel: Rolling, points: list[str], links: list[str]) -> dict[str, Any]:
    along = wheel.along
    track = None
    if along.radius is not None:
        centre = along.centre
        place = mechanism.points_of(wheel.on)[centre] if isinstance(centre, str) else centre or (0.0, 0.0)
        track = {
            "centre": list(place),
            "radius": along.radius,
            "radiusPath": f"rolling.{wheel.id}.along.radius",
        }
    x, y = along.unit
    return {
        "link": links.index(wheel.link),
        "centre": points.index(wheel.centre),
        "radius": wheel.radius,
        "radiusPath": f"rolling.{wheel.id}.radius",
        "on": _index(links, wheel.on),
        "direction": float(np.arctan2(y, x)),
        "track": track,
    }


def _rings(mechanism: Mechanism, points: list[str], links: list[str]) -> list[dict[str, Any]]:
    """Circles of guides whose pole is a point, or stands in the frame."""
    found = []
    for guide in mechanism.guides:
        pole = guide.pole
        if not isinstance(pole, str) and guide.on != FRAME:
            continue
        found.append(
            {
                "point": points.index(pole) if isinstance(pole, str) else None,
                "pole": None if isinstance(pole, str) else list(unit_vector(pole)),  # type: ignore[arg-type]
                "fixed": guide.on == FRAME,
                "arc": guide.arc,
                "arcPath": f"guides.{guide.id}.radius",
                "colour": SCREEN_COLOURS[GROUND]
                if guide.on == FRAME
                else look_of_link(links.index(guide.on))["colour"],
            }
        )
    return found


def _view(mechanism: Mechanism, motion: xarray.Dataset) -> list[list[float]]:
    """To the right, up and towards the eye, as rows."""
    names = motion["point"].values.tolist()
    tracks = {name: motion["position"].sel(point=name).values for name in names}
    for name, place in mechanism.frame.coordinates.items():
        tracks[name] = np.array([unit_vector(place)])
    return [[float(value) for value in row] for row in np.round(view_of(tracks), 9)]
