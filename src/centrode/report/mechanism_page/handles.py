"""Which numbers of a mechanism follow the hand that takes hold of a joint."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any

from centrode.locale import _
from centrode.model.mechanism import FRAME, Guide, Link, Mechanism
from centrode.report.mechanism_page.numbers_that_vary import name_of

ON_AXIS = 0.0


def handles_of(
    mechanism: Mechanism, points: list[str], links: list[str], paths: Collection[str]
) -> list[dict[str, Any]]:
    """A handle for each point that some of the numbers at `paths` move, as plain data of the page.

    Parameters
    ----------
    mechanism : Mechanism
    points, links : names in the order of the page
    paths : of the numbers that the page changes
    """
    found = []
    for point in points:
        ways = list(_ways(mechanism, point, points, links, paths))
        if not ways:
            continue
        changed = list(dict.fromkeys(path for way in ways for path in _paths_of(way)))
        found.append(
            {
                "point": points.index(point),
                "fixed": point in mechanism.frame.points,
                "ways": ways,
                "rails": [{"direction": guide.direction_angle} for guide in _rails(mechanism, point)],
                "changes": [name_of(mechanism, path) for path in changed],
            }
        )
    return found


def _paths_of(way: dict[str, Any]) -> list[str]:
    own = [way.get(key) for key in ("path", "x", "y")]
    others = [path for pair in way.get("others", ()) for path in pair]
    return [path for path in (*own, *others) if path]


def _rails(mechanism: Mechanism, point: str) -> list[Guide]:
    """Lines of the frame that the point stays on."""
    if mechanism.space == "sphere":
        return []
    return [guide for guide in mechanism.guides if guide.point == point and guide.on == FRAME]


def _ways(
    mechanism: Mechanism, point: str, points: list[str], links: list[str], paths: Collection[str]
) -> Iterator[dict[str, Any]]:
    """How each part that has the point follows: a place in the frame, a length, a place in a link, a line."""

    def varied_path(path: str) -> str | None:
        return path if path in paths else None

    axes = ("longitude", "latitude") if mechanism.space == "sphere" else ("x", "y")
    if point in mechanism.frame.points:
        x, y = (varied_path(f"frame.points.{point}.{axis}") for axis in axes)
        if x or y:
            yield {"kind": "frame", "x": x, "y": y}
        return
    for guide in _rails(mechanism, point):
        x, y = (varied_path(f"guides.{guide.id}.through.{axis}") for axis in axes)
        if x or y:
            yield {"kind": "guide", "x": x, "y": y, "direction": guide.direction_angle}
    driven = {drive.link for drive in mechanism.drives}
    for name, link in mechanism.links.items():
        if point in link.coordinates:
            way = _in_link(name, link, point, points, links, paths)
            if way is not None:
                yield {**way, "driven": name in driven}


def _in_link(
    name: str, link: Link, point: str, points: list[str], links: list[str], paths: Collection[str]
) -> dict[str, Any] | None:
    """A link that has the point follows with its length, with a coordinate, or with those of its other points."""
    length = f"links.{name}.length"
    if length in paths:
        other = next(one for one in link.coordinates if one != point)
        return {"kind": "length", "path": length, "other": points.index(other), "sign": 1}

    def pair(one: str) -> tuple[str | None, str | None]:
        x, y = (f"links.{name}.points.{one}.{axis}" for axis in "xy")
        return x if x in paths else None, y if y in paths else None

    origin = next((one for one, at in link.coordinates.items() if at == (0.0, 0.0)), None)
    x, y = pair(point)
    if point == origin:
        others = [(one, pair(one)) for one in link.coordinates if one != point and any(pair(one))]
        if not others:
            return None
        if len(others) == 1 and not all(others[0][1]):
            other, (along, across) = others[0]
            return _along(link, points, along or across or "", other, other)
        return {"kind": "origin", "link": links.index(name), "others": [paths_ for _one, paths_ in others]}
    if x is None and y is None:
        return None
    if (x is None or y is None) and origin is not None:
        return _along(link, points, x or y or "", point, origin)
    return {"kind": "local", "link": links.index(name), "x": x, "y": y}


def _along(link: Link, points: list[str], path: str, measured: str, other: str) -> dict[str, Any]:
    """A coordinate on an axis of the link: a length with a sign, from `other` to the joint."""
    value = link.coordinates[measured]["xy".index(path[-1])]
    return {"kind": "length", "path": path, "other": points.index(other), "sign": -1 if value < 0 else 1}


def joint_words() -> dict[str, str]:
    """What a handle is called."""
    return {
        "joint": _("Joint {name}, arrow keys change"),
        "fixed_joint": _("Fixed hinge {name}, arrow keys change"),
    }
