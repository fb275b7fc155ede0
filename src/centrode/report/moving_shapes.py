"""What moves beside the lines of links: slots, blocks on rods, cylinders, wheels, tracks, circles of guides."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from centrode.model.values import unit_vector
from centrode.present import signs
from centrode.present.drawing import nearest
from centrode.present.scene import Scene, span
from centrode.present.sphere.globe import Globe
from centrode.present.style import GROUND, INK, pens
from centrode.present.wheels import BARREL, OVER, slides
from centrode.render.document.blocks import Outline, Ring
from centrode.report.circles import AT_REST, LIFT, Array, Samples, circle, hatched
from centrode.report.moving_cams import cam_shapes

if TYPE_CHECKING:
    from centrode.model.mechanism import Guide, Rolling


def shapes_of(scene: Scene, samples: Samples) -> tuple[Outline, ...]:
    """The outlines of a planar mechanism [m], those below first."""
    found = [*_grounds(scene), *_wheels(scene, samples), *_slots(scene, samples), *_cylinders(scene, samples)]
    found += [one for cam in scene.cams for one in cam_shapes(cam, samples, scene.sign)]
    return tuple(_in_metres(one, scene.factor) for one in found)


def rings_of(globe: Globe, samples: Samples) -> tuple[Ring, ...]:
    """The circles of a spherical mechanism's guides."""
    colours = pens(globe.mechanism.link_names)
    found = []
    for guide in globe.mechanism.guides:
        pole = guide.pole
        if isinstance(pole, str):
            pole = globe.mechanism.points_of(guide.on)[pole]
        local: Array = np.array(unit_vector(pole))  # type: ignore[arg-type]
        at = samples[:1] if guide.on == "frame" else samples
        poles = [globe.carried(guide.on, local, int(sample)) for sample in at]
        colour = GROUND if guide.on == "frame" else colours[guide.on].colour
        kept = np.array([np.full(3, np.nan) if one is None else one for one in poles])
        found.append(Ring(kept, float(guide.arc), colour))
    return tuple(found)


def _in_metres(one: Outline, factor: float) -> Outline:
    poses = one.poses / np.array([factor, factor, 1.0])
    return Outline(one.corners / factor, poses, one.colour, one.filled, one.behind, one.white)


def _poses(scene: Scene, link: str, samples: Samples, local: Sequence[float] = (0.0, 0.0)) -> Array | None:
    """Where axes in a link's own axes are (samples, 3); nothing if the link has no position."""
    if link == "frame":
        return np.array([[*scene.factor * np.asarray(local, dtype=float), 0.0]])
    place = scene.carried(link, local, slice(None))
    if place is None:
        return None
    return np.column_stack([place, scene.turns[link]])[samples]


def _grounds(scene: Scene) -> Iterator[Outline]:
    """Lines and circles of the frame that wheels roll on."""
    for wheel in scene.mechanism.rolling:
        if wheel.on != "frame":
            continue
        if wheel.along.radius is not None:
            yield Outline(_round_ground(scene, wheel), AT_REST, GROUND)
        else:
            start, end = _track(scene, wheel)
            x, y = wheel.along.unit
            yield Outline(hatched(start, end, np.array([y, -x]), scene.sign), AT_REST, GROUND)


def _track(scene: Scene, wheel: Rolling) -> tuple[Array, Array]:
    """The part of a line that its wheel rolls over, in the axes of the link that carries it."""
    start = scene.factor * np.asarray(wheel.along.through, dtype=float)
    along = np.asarray(wheel.along.unit, dtype=float)
    way, over = span(slides(scene, wheel)), OVER * scene.factor * wheel.radius
    return start + (way[0] - over) * along, start + (way[1] + over) * along


def _round_ground(scene: Scene, wheel: Rolling) -> Array:
    """A circle of the frame, hatched on the side away from its wheel."""
    radius = scene.factor * float(wheel.along.radius or 0.0)
    centre = _centre(scene, wheel)
    strokes = max(12, round(2.0 * np.pi * radius / (0.9 * scene.sign)))
    turn = np.linspace(0.0, 2.0 * np.pi, strokes, endpoint=False)
    out = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    away = out if wheel.along.inside else -out
    feet = radius * out
    tips = feet + 0.9 * scene.sign * (away - np.stack([-out[:, 1], out[:, 0]], axis=1))
    lines = np.stack([feet, tips, np.full_like(feet, np.nan)], axis=1).reshape(-1, 2)
    return np.asarray(scene.factor * np.asarray(centre) + np.concatenate([circle(radius), LIFT, lines]))


def _centre(scene: Scene, wheel: Rolling) -> Sequence[float]:
    centre = wheel.along.centre
    return scene.mechanism.points_of(wheel.on)[centre] if isinstance(centre, str) else centre or (0.0, 0.0)


def _wheels(scene: Scene, samples: Samples) -> Iterator[Outline]:
    """Rolling wheels with a spoke, and the tracks that moving links carry."""
    colours = pens(scene.mechanism.link_names)
    for wheel in scene.mechanism.rolling:
        if wheel.on != "frame":
            around = wheel.along.radius is not None
            poses = _poses(scene, wheel.on, samples, _centre(scene, wheel) if around else (0.0, 0.0))
            track = (
                circle(scene.factor * float(wheel.along.radius or 0.0))
                if around
                else np.array(_track(scene, wheel))
            )
            if poses is not None:
                yield Outline(track, poses, colours[wheel.on].colour)
        rim = circle(scene.factor * wheel.radius, spoke=True)
        poses = np.column_stack([scene.tracks[wheel.centre], scene.turns[wheel.link]])[samples]
        yield Outline(rim, poses, colours[wheel.link].colour, filled=True)


def _slots(scene: Scene, samples: Samples) -> Iterator[Outline]:
    """Slots and rods of moving links, what joins them to their links, and the blocks on rods."""
    colours = pens(scene.mechanism.link_names)
    for guide in scene.mechanism.guides:
        poses = None if guide.on == "frame" else _poses(scene, guide.on, samples)
        if poses is None:
            continue
        start, end = _slot_line(scene, guide)
        colour = colours[guide.on].colour
        own = [scene.factor * np.array(at) for at in scene.mechanism.links[guide.on].coordinates.values()]
        if own:
            feet = [nearest(place, start, end) for place in own]
            k = int(np.argmin([np.hypot(*(foot - at)) for foot, at in zip(feet, own, strict=True)]))
            yield Outline(np.array([own[k], feet[k]]), poses, colour)
        if guide.link is None:
            yield Outline(signs.slot_outline(start, end, scene.sign), poses, colour, white=True)
            continue
        along = 3.5 * scene.sign * np.asarray(guide.unit, dtype=float)
        yield Outline(np.array([start - along, end + along]), poses, colour)
        block = signs.slider_outline(np.zeros(2), guide.direction_angle, scene.sign)
        places = np.column_stack([scene.tracks[guide.point], scene.turns[guide.on]])[samples]
        yield Outline(block, places, colours[guide.link].colour, white=True, behind=False)


def _slot_line(scene: Scene, guide: Guide) -> tuple[Array, Array]:
    """The part of a guide that its point travels, in the axes of its link."""
    start = scene.factor * np.asarray(scene.mechanism.through(guide), dtype=float)
    along = np.asarray(guide.unit, dtype=float)
    least, most = scene.travels[guide.id]
    return start + least * along, start + most * along


def _cylinders(scene: Scene, samples: Samples) -> Iterator[Outline]:
    """Barrels over the rods of cylinders, which are drawn from point to point."""
    for drive in scene.mechanism.drives:
        if drive.distance is None:
            continue
        first, second = (scene.tracks[point][samples % len(scene.tracks[point])] for point in drive.distance)
        way = second - first
        turn = np.arctan2(way[:, 1], way[:, 0])
        lengths = np.hypot(way[:, 0], way[:, 1])
        barrel = BARREL * float(np.nanmin(lengths))
        outline = signs.barrel_outline(np.zeros(2), np.array([barrel, 0.0]), scene.sign)
        yield Outline(outline, np.column_stack([first, turn]), INK, white=True, behind=False)
