"""Equations of any plane mechanism in the coordinates of its bodies, apart from the formulas of centrode.

Unknowns are the origin and the angle of every moving link, the places of guided points that no link carries, and the
direction of every wheel's centre that rolls on a circle. So angles run on over turns by themselves.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from oracle_fields import Field

Pose = tuple[Any, Any]
"""Origin as a complex number, and angle."""


class Plane:
    """The equations of a description; `phases` are the constants of gears and wheels, by their ids.

    `dropped` are ids of wheels that something else keeps at their distance.
    """

    def __init__(self, parts: Mapping[str, Any], field: Field, dropped: Sequence[str] = ()) -> None:
        self.field, self.parts, self.dropped = field, parts, dropped
        self.frame = {name: self._point(v) for name, v in parts.get("frame", {}).get("points", {}).items()}
        self.local = {name: self._local(name, link) for name, link in parts["links"].items()}
        self.owners = self._owners()
        guided = [guide["point"] for guide in parts.get("guides", ())]
        self.loose = [p for p in dict.fromkeys(guided) if p not in self.owners and p not in self.frame]
        self.wheels = [w for w in parts.get("rolling", ()) if "radius" in w["along"]]
        self.size = 3 * len(self.local) + 2 * len(self.loose) + len(self.wheels)
        self.meshes = [f"gear {i}" for i, _ in enumerate(parts.get("gears", ()))]
        self.meshes += [f"wheel {w['link']}" for w in parts.get("rolling", ())]

    def _point(self, v: Sequence[Any]) -> Any:
        return self.field.complex(self.field.number(v[0]), self.field.number(v[1]))

    def _own(self, on: str, spot: Any) -> Any:
        """A place in the axes of a link, given by coordinates or by the name of one of its points."""
        if isinstance(spot, str):
            return (self.frame if on == "frame" else self.local[on])[spot]
        return self._point(spot)

    def _local(self, name: str, link: Mapping[str, Any]) -> dict[str, Any]:
        points = link.get("points", list(name))
        if isinstance(points, Mapping):
            return {point: self._point(v) for point, v in points.items()}
        ends = [0, link.get("length", 0)]
        return {point: self._point((end, 0)) for point, end in zip(points, ends, strict=False)}

    def _owners(self) -> dict[str, list[str]]:
        owners: dict[str, list[str]] = {}
        for link, points in self.local.items():
            for point in points:
                owners.setdefault(point, []).append(link)
        return owners

    def _poses(self, x: Sequence[Any]) -> dict[str, Pose]:
        zero = self.field.number(0)
        poses = {"frame": (self.field.complex(zero, zero), zero)}
        for i, link in enumerate(self.local):
            poses[link] = (self.field.complex(x[3 * i], x[3 * i + 1]), x[3 * i + 2])
        return poses

    def places(self, x: Sequence[Any]) -> dict[str, Any]:
        """Every point as a complex number."""
        poses = self._poses(x)
        found = dict(self.frame)
        for point, owners in self.owners.items():
            found.setdefault(point, self._carried(poses[owners[0]], self.local[owners[0]][point]))
        first = 3 * len(self.local)
        for i, point in enumerate(self.loose):
            found.setdefault(point, self.field.complex(x[first + 2 * i], x[first + 2 * i + 1]))
        return found

    def _carried(self, pose: Pose, local: Any) -> Any:
        return pose[0] + local * self.field.rotor(pose[1])

    def _seen(self, pose: Pose, place: Any) -> Any:
        return (place - pose[0]) * self.field.rotor(-pose[1])

    def equations(self, values: Sequence[Any], x: Sequence[Any], phases: Mapping[str, Any]) -> list[Any]:
        """What vanishes where the drives have the values."""
        poses, places = self._poses(x), self.places(x)
        wrong = self._hinges(poses, places)
        for guide in self.parts.get("guides", ()):
            wrong += self._guide(guide, poses, places)
        slopes = list(x[self.size - len(self.wheels) :]) + [None] * len(self.meshes)
        kept = self.constants(x)
        wrong += [kept[mesh] - phases[mesh] for mesh in self.meshes]
        for wheel in self.parts.get("rolling", ()):
            on_circle = "radius" in wheel["along"]
            wrong += self._contact(wheel, poses, places, slopes.pop(0) if on_circle else None)
        drives = self.parts["drives"]
        return wrong + [
            self._driven(drive, poses, places) - value for drive, value in zip(drives, values, strict=True)
        ]

    def _hinges(self, poses: Mapping[str, Pose], places: Mapping[str, Any]) -> list[Any]:
        wrong = []
        for point, owners in self.owners.items():
            for link in owners if point in self.frame else owners[1:]:
                gap = self._carried(poses[link], self.local[link][point]) - places[point]
                wrong += [gap.real, gap.imag]
        return wrong

    def _line(self, on: str, through: Any, direction: Any, place: Any, poses: Mapping[str, Pose]) -> Any:
        """Place along (real) and left of (imaginary part) a line in the axes of a link."""
        start = self._own(on, through)
        if isinstance(direction, list | tuple):
            d = self._point(direction)
        else:
            d = self.field.rotor(self.field.number(direction))
        return d.conjugate() * (self._seen(poses[on], place) - start) / abs(d)

    def _guided(self, guide: Mapping[str, Any], poses: Mapping[str, Pose], places: Mapping[str, Any]) -> Any:
        place = places[guide["point"]]
        return self._line(guide.get("on", "frame"), guide["through"], guide["direction"], place, poses)

    def _guide(
        self, guide: Mapping[str, Any], poses: Mapping[str, Pose], places: Mapping[str, Any]
    ) -> list[Any]:
        wrong = [self._guided(guide, poses, places).imag]
        if "link" in guide:
            turn = poses[guide["link"]][1] - poses[guide.get("on", "frame")][1]
            wrong.append(turn - self.field.number(guide.get("angle", 0)))
        return wrong

    def constants(self, x: Sequence[Any]) -> dict[str, Any]:
        """What every gear and wheel keeps constant, by its id."""
        poses, places = self._poses(x), self.places(x)
        slopes = list(x[self.size - len(self.wheels) :])
        found = []
        for gear in self.parts.get("gears", ()):
            a, b, c = (poses[link][1] for link in (*gear["links"], gear.get("carrier", "frame")))
            found.append((b - c) - self.field.number(gear["ratio"]) * (a - c))
        for wheel in self.parts.get("rolling", ()):
            r, on, along = self.field.number(wheel["radius"]), wheel.get("on", "frame"), wheel["along"]
            turn = poses[wheel["link"]][1] - poses[on][1]
            if "radius" in along:
                ring = self.field.number(along["radius"])
                found.append(turn - slopes.pop(0) * (r - ring if along.get("inside") else r + ring) / r)
            else:
                at = self._line(on, along["through"], along["direction"], places[wheel["centre"]], poses)
                found.append(turn + at.real / r)
        return dict(zip(self.meshes, found, strict=True))

    def _contact(
        self, wheel: Mapping[str, Any], poses: Mapping[str, Pose], places: Mapping[str, Any], slope: Any
    ) -> list[Any]:
        """The wheel touches; on a circle also where its centre stands (the direction `slope`)."""
        r, on, along = self.field.number(wheel["radius"]), wheel.get("on", "frame"), wheel["along"]
        place, dropped = places[wheel["centre"]], wheel["link"] in self.dropped
        if slope is None:
            at = self._line(on, along["through"], along["direction"], place, poses)
            return [] if dropped else [at.imag - r]
        ring = self.field.number(along["radius"])
        turned = (self._seen(poses[on], place) - self._own(on, along["centre"])) * self.field.rotor(-slope)
        distance = abs(ring - r) if along.get("inside") else ring + r
        return [turned.imag] if dropped else [turned.imag, turned.real - distance]

    def _driven(self, drive: Mapping[str, Any], poses: Mapping[str, Pose], places: Mapping[str, Any]) -> Any:
        if "link" in drive:
            return poses[drive["link"]][1] - poses[drive.get("relative_to", "frame")][1]
        if "guide" in drive:
            return self._guided(self._named(drive["guide"]), poses, places).real
        a, b = drive["distance"]
        return abs(places[a] - places[b])

    def _named(self, name: str) -> Mapping[str, Any]:
        found: Mapping[str, Any] = next(g for g in self.parts["guides"] if g.get("name", g["point"]) == name)
        return found

    def outputs(self, x: Sequence[Any]) -> dict[str, Any]:
        """Coordinates of moving points, angles of links, displacements along guides."""
        poses, places = self._poses(x), self.places(x)
        found = {}
        for name, place in places.items():
            if name not in self.frame:
                found[f"x:{name}"], found[f"y:{name}"] = place.real, place.imag
        found.update({f"angle:{name}": poses[name][1] for name in self.local})
        for guide in self.parts.get("guides", ()):
            name = guide.get("name", guide["point"])
            found[f"slide:{name}"] = self._guided(guide, poses, places).real
        return found

    def guess(self, points: Mapping[str, Sequence[float]], angles: Mapping[str, float]) -> list[Any]:
        """Unknowns from rough places of points, and angles of links with one point."""
        at = {name: complex(*v) for name, v in points.items()}
        at.update({name: complex(v) for name, v in self.frame.items()})
        x: list[Any] = []
        for link, local in self.local.items():
            first, *others = local
            if link in angles:
                angle = angles[link]
            else:
                arm = (at[others[0]] - at[first]) / complex(local[others[0]] - local[first])
                angle = _argument(arm)
            origin = at[first] - complex(local[first]) * _rotor(angle)
            x += [origin.real, origin.imag, angle]
        for point in self.loose:
            x += [at[point].real, at[point].imag]
        poses = self._poses([self.field.number(v) for v in x])
        for wheel in self.wheels:
            on, place = wheel.get("on", "frame"), at[wheel["centre"]]
            seen = self._seen(poses[on], self._point((place.real, place.imag)))
            x.append(_argument(complex(seen - self._own(on, wheel["along"]["centre"]))))
        return [self.field.number(v) for v in x]


def _argument(v: complex) -> float:
    return math.atan2(v.imag, v.real)


def _rotor(angle: float) -> complex:
    return complex(math.cos(angle), math.sin(angle))
