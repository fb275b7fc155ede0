"""What the names in a drawing keep clear of: every line of it, as segments."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from centrode.present import signs
from centrode.present.scene import Array, Scene, corners
from centrode.present.wheels import Disc, cylinders, round_track, straight_track, wheel_at

if TYPE_CHECKING:
    from centrode.model.mechanism import Guide

Segments = list[tuple[Array, Array]]
OUTLINE = 8
"""Every so many places of a cam's outline are corners of the polygon that names keep clear of."""


def lines(scene: Scene, sample: int) -> Segments:
    """Everything a name should not cover, as segments."""
    places = scene.at(sample)
    found: Segments = []
    for link in scene.mechanism.links.values():
        outline = [places[point] for point in corners(link) if point in places]
        found += around(outline) if len(outline) > 2 else along(outline)
    for guide in scene.mechanism.guides:
        if guide.point in places:
            found += guide_lines(scene, guide, sample, places[guide.point])
    for name in scene.mechanism.frame.points:
        if name in places:
            feet = scene.sign * np.array([[-2.4, -3.6], [0.0, -3.6], [2.4, -3.6]])
            found += [(places[name], places[name] + foot) for foot in feet]
    for arc in drive_arcs(scene, sample):
        found += along(list(arc))
    return found + wheel_lines(scene, sample) + cam_lines(scene, sample)


def cam_lines(scene: Scene, sample: int) -> Segments:
    """Driving cams and their rollers as segments."""
    found: Segments = []
    for cam in scene.cams:
        found += around(list(cam.outline(sample)[::OUTLINE]))
        roller = cam.roller(sample)
        found += [] if roller is None else around(list(Disc(*roller).outline))
    return found


def wheel_lines(scene: Scene, sample: int) -> Segments:
    """Wheels, tracks and cylinders as segments."""
    found: Segments = []
    for wheel in scene.mechanism.rolling:
        for disc in (wheel_at(scene, wheel, sample), round_track(scene, wheel, sample)):
            found += [] if disc is None else around(list(disc.outline))
        line = straight_track(scene, wheel, sample)
        found += [] if line is None else [line]
    for _drive, foot, mouth, end in cylinders(scene, sample):
        found += [*around(list(signs.barrel_outline(foot, mouth, scene.sign))), (mouth, end)]
    return found


def guide_lines(scene: Scene, guide: Guide, sample: int, place: Array) -> Segments:
    """A guide with its slider or slot, as segments."""
    line = scene.guide_line(guide, sample)
    if line is None:
        return []
    over = 3.0 * scene.sign * unit(line[1] - line[0])
    found = [(line[0] - over, line[1] + over)]
    if guide.on != "frame" and guide.link is None:
        return found + around(list(signs.slot_outline(*line, scene.sign)))
    if guide.on == "frame":
        start, end, away = ground_line(scene, guide, line)
        found += [(start + depth * away, end + depth * away) for depth in (0.0, 0.9 * scene.sign)]
    turn = 0.0 if guide.on == "frame" else float(scene.turns[guide.on][sample])
    return found + around(list(signs.slider_outline(place, turn + guide.direction_angle, scene.sign)))


def ground_line(scene: Scene, guide: Guide, line: tuple[Array, Array]) -> tuple[Array, Array, Array]:
    """Ends of the hatched line that a slider of the frame rests on, and the side of the hatching."""
    along = np.asarray(guide.unit, dtype=float)
    away = down_from(along, 0.5 * (line[0] + line[1]), scene)
    shift, over = 1.7 * scene.sign * away, 4.0 * scene.sign * along
    return line[0] + shift - over, line[1] + shift + over, away


def down_from(along: Array, middle: Array, scene: Scene) -> Array:
    """The side of a guide where the hatching goes: below; beside a steep one, away from the mechanism."""
    normal = np.array([along[1], -along[0]])
    if abs(along[0]) > 0.2:
        return normal if normal[1] < 0 else -normal
    outward = middle - 0.5 * (scene.low + scene.high)
    return normal if float(normal @ outward) >= 0 else -normal


def along(places: Sequence[Array]) -> Segments:
    """The segments of an open polygon."""
    return list(pairwise(places))


def around(places: Sequence[Array]) -> Segments:
    """The segments of a closed polygon."""
    return along([*places, places[0]])


def drive_arcs(scene: Scene, sample: int) -> list[Array]:
    """The arcs of the drives' arrows: in the sense of a uniform drive or a cam, counter-clockwise for a law."""
    places = scene.at(sample)
    found = [signs.turning_arc(cam.hub, 0.0, cam.forward, scene.sign) for cam in scene.cams]
    for drive in scene.mechanism.drives:
        if drive.link is None or drive.relative_to != "frame" or drive.cam is not None:
            continue
        points = [name for name in scene.mechanism.links[drive.link].coordinates if name in places]
        pivots = [name for name in points if name in scene.mechanism.frame.points]
        others = [name for name in points if name not in pivots]
        if len(pivots) == 1 and others:
            arm = places[others[0]] - places[pivots[0]]
            forward = drive.speed is None or drive.speed >= 0
            angle = float(np.arctan2(arm[1], arm[0]))
            found.append(signs.turning_arc(places[pivots[0]], angle, forward, scene.sign))
    return found


def unit(vector: Array) -> Array:
    """A vector of length one, or zero."""
    return np.asarray(vector / max(float(np.hypot(*vector)), np.finfo(float).tiny))
