"""From a motion to the block that a page plays: the part of it that the mechanism reaches, in the signs of diagrams."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from centrode.errors import InputError, Status
from centrode.locale import _
from centrode.model.values import unit_vector
from centrode.quantities import with_unit
from centrode.render.document.blocks import Moving, Outline, RingBlock, shown
from centrode.render.document.cam_player import AT_REST, LIFT, Array, Samples, cam_shapes, circle, hatch
from centrode.render.document.figures import picture
from centrode.render.document.numbers import NARROW, Numbers
from centrode.render.drawing import signs
from centrode.render.drawing.globe import draw_globe
from centrode.render.drawing.linkage import MARGIN, draw_mechanism, nearest
from centrode.render.drawing.style import GROUND, INK, house_style, pens
from centrode.render.figures.linkages import complete, initial_sample
from centrode.scenes.linkage import BARREL, OVER, scene_of, slides
from centrode.scenes.places import LinkageScene, corners, span
from centrode.scenes.sphere import Globe, globe_of

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Guide, Mechanism, Rolling
    from centrode.model.motion_parameter import MotionParameter

# What moves beside the lines of links: slots, blocks on rods, cylinders, wheels, tracks, circles of guides.


def shapes_of(scene: LinkageScene, samples: Samples) -> tuple[Outline, ...]:
    """The outlines of a planar mechanism [m], those below first."""
    found = [*_grounds(scene), *_wheels(scene, samples), *_slots(scene, samples), *_cylinders(scene, samples)]
    found += [one for cam in scene.cams for one in cam_shapes(cam, samples, scene.sign)]
    return tuple(_in_metres(one, scene.factor) for one in found)


def rings_of(globe: Globe, samples: Samples) -> tuple[RingBlock, ...]:
    """The circles of a spherical mechanism's guides."""
    colours = pens(globe.mechanism.link_names)
    found = []
    for guide in globe.mechanism.guides:
        pole = guide.pole
        if isinstance(pole, str):
            pole = globe.mechanism.points_of(guide.on)[pole]
        local: Array = np.array(unit_vector(pole))  # type: ignore[arg-type]
        at = samples[:1] if guide.on == "frame" else samples
        poles = [globe.carried_places(guide.on, local, int(sample)) for sample in at]
        colour = GROUND if guide.on == "frame" else colours[guide.on].colour
        kept = np.array([np.full(3, np.nan) if one is None else one for one in poles])
        found.append(RingBlock(kept, float(guide.arc), colour))
    return tuple(found)


def _in_metres(one: Outline, factor: float) -> Outline:
    poses = one.poses / np.array([factor, factor, 1.0])
    return Outline(one.corners / factor, poses, one.colour, one.filled, one.behind, one.white)


def _poses(
    scene: LinkageScene, link: str, samples: Samples, local: Sequence[float] = (0.0, 0.0)
) -> Array | None:
    """Where axes in a link's own axes are (samples, 3); nothing if the link has no position."""
    if link == "frame":
        return np.array([[*scene.factor * np.asarray(local, dtype=float), 0.0]])
    place = scene.carried_places(link, local, slice(None))
    if place is None:
        return None
    return np.column_stack([place, scene.turns[link]])[samples]


def _grounds(scene: LinkageScene) -> Iterator[Outline]:
    """Lines and circles of the frame that wheels roll on."""
    for wheel in scene.mechanism.rolling:
        if wheel.on != "frame":
            continue
        if wheel.along.radius is not None:
            yield Outline(_round_ground(scene, wheel), AT_REST, GROUND)
        else:
            start, end = _track(scene, wheel)
            x, y = wheel.along.unit
            yield Outline(hatch(start, end, np.array([y, -x]), scene.sign), AT_REST, GROUND)


def _track(scene: LinkageScene, wheel: Rolling) -> tuple[Array, Array]:
    """The part of a line that its wheel rolls over, in the axes of the link that carries it."""
    start = scene.factor * np.asarray(wheel.along.through, dtype=float)
    along = np.asarray(wheel.along.unit, dtype=float)
    way, over = span(slides(scene, wheel)), OVER * scene.factor * wheel.radius
    return start + (way[0] - over) * along, start + (way[1] + over) * along


def _round_ground(scene: LinkageScene, wheel: Rolling) -> Array:
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


def _centre(scene: LinkageScene, wheel: Rolling) -> Sequence[float]:
    centre = wheel.along.centre
    return scene.mechanism.points_of(wheel.on)[centre] if isinstance(centre, str) else centre or (0.0, 0.0)


def _wheels(scene: LinkageScene, samples: Samples) -> Iterator[Outline]:
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


def _slots(scene: LinkageScene, samples: Samples) -> Iterator[Outline]:
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


def _slot_line(scene: LinkageScene, guide: Guide) -> tuple[Array, Array]:
    """The part of a guide that its point travels, in the axes of its link."""
    start = scene.factor * np.asarray(scene.mechanism.through(guide), dtype=float)
    along = np.asarray(guide.unit, dtype=float)
    least, most = scene.travels[guide.id]
    return start + least * along, start + most * along


def _cylinders(scene: LinkageScene, samples: Samples) -> Iterator[Outline]:
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


MOST = 720
"""Samples of a motion that are played; of more, evenly chosen ones."""
INCHES = 5.2
DIGITS = 4
"""Of the drive's greatest value."""


def moving_of(
    mechanism: Mechanism,
    motion: xarray.Dataset,
    by_time: bool = False,
    marks: Sequence[tuple[str, float]] = (),
) -> Moving:
    """A motion to be played, in the plane or on the sphere.

    Parameters
    ----------
    mechanism : Mechanism
    motion : Dataset
        Of `motion`; the samples that hang together with the initial position are played.
    by_time : bool
        The slider goes through time, as for the motion of a simulation, which may pass a value of the drive again.
    marks : names and instants [s] that the slider marks

    Raises
    ------
    InputError
        No sample has every point in place.
    """
    scene = globe_of(mechanism, motion) if mechanism.space == "sphere" else scene_of(mechanism, motion)
    chosen = samples_in_one_piece(scene, motion)
    parameter = mechanism.motion_parameter.in_time() if by_time else mechanism.motion_parameter
    on_sphere = isinstance(scene, Globe)
    factor = 1.0 if isinstance(scene, Globe) else scene.factor
    fixed = tuple(mechanism.frame.points)
    places = {
        name: track[chosen[:1] if name in fixed else chosen] / factor for name, track in scene.tracks.items()
    }
    frame_guides = [] if on_sphere else [guide for guide in mechanism.guides if guide.on == "frame"]
    lines = {} if isinstance(scene, Globe) else {one.id: scene.guide_line(one, 0) for one in frame_guides}
    return Moving(
        places=places,
        bodies=_bodies(mechanism),
        fixed=fixed,
        guides={name: np.array(line) / factor for name, line in lines.items() if line is not None},
        sliders={guide.point: guide.id for guide in frame_guides},
        drive=parameter.values(motion)[chosen],
        drive_texts=tuple(drive_texts(mechanism, motion, chosen, parameter)),
        tracks=tuple(name for name in mechanism.moving_points if name in places),
        still=picture(_still(scene, motion), ""),
        caption=_("Motion of {title}").format(title=shown(_(mechanism.title) or _("the mechanism"))),
        shapes=rings_of(scene, chosen) if isinstance(scene, Globe) else shapes_of(scene, chosen),
        view=scene.view if isinstance(scene, Globe) else None,
        driven=tuple(_driven(mechanism)),
        dots=tuple(_dots(mechanism)),
        start=int(np.argmin(np.abs(chosen - initial_sample(scene, motion)))),
        box=np.array([scene.low, scene.high]) / factor,
        marks=_marks(motion, chosen, marks),
    )


def _marks(
    motion: xarray.Dataset, chosen: np.ndarray, marks: Sequence[tuple[str, float]]
) -> tuple[tuple[float, str], ...]:
    """Marks on the way of a slider through the chosen samples, whose places are parts of them."""
    if not marks or len(chosen) < 2:
        return ()
    times = np.asarray(motion["time"].values, dtype=np.float64)[chosen]
    shares = np.arange(len(chosen)) / (len(chosen) - 1)
    return tuple(
        (float(np.interp(at, times, shares)), name) for name, at in marks if times[0] <= at <= times[-1]
    )


def samples_in_one_piece(scene: LinkageScene | Globe, motion: xarray.Dataset) -> NDArray[np.intp]:
    """The samples about the initial position where the mechanism is in one piece and gets to."""
    status = motion["status"].values
    good = complete(scene) & ((status == Status.OK) | (status == Status.SINGULAR))
    if not good.any():
        raise InputError("", _("no sample has every point in place"), _("choose another range"))
    start = initial_sample(scene, motion)
    if not good[start]:
        start = int(np.flatnonzero(good)[0])
    bad = np.flatnonzero(~good)
    low = int(bad[bad < start].max(initial=-1)) + 1
    high = int(bad[bad > start].min(initial=good.size))
    count = min(MOST + 1, high - low)
    return np.unique(np.linspace(low, high - 1, count).round().astype(np.intp))


def drive_texts(
    mechanism: Mechanism, motion: xarray.Dataset, samples: NDArray[np.intp], parameter: MotionParameter
) -> list[str]:
    """The parameter of the motion at each sample, the value of the only drive or the time, with symbol and unit."""
    values, unit, name = parameter.values(motion)[samples], parameter.variable.unit, parameter.variable.symbol
    if not parameter.by_time and not parameter.drives[0].is_chosen:
        name = f"{name} ({mechanism.drives[0].id})"
    numbers = Numbers(mechanism.display, DIGITS)
    label = numbers.shown(unit)[1]
    texts = numbers.column(values.tolist(), unit, least=1e-9 * float(np.abs(values).max()))
    return [f"{name} = {with_unit(text, label, NARROW)}" for text in texts]


def _bodies(mechanism: Mechanism) -> dict[str, tuple[str, ...]]:
    """The points that each link is drawn through, and the rods of cylinders."""
    links = {name: tuple(corners(link)) for name, link in mechanism.links.items()}
    rods = {one.id: one.distance for one in mechanism.drives if one.distance is not None}
    return {**links, **{name: ends for name, ends in rods.items() if name not in links}}


def _driven(mechanism: Mechanism) -> list[str]:
    """Points that the drives move themselves."""
    found: list[str] = []
    for drive in mechanism.drives:
        if drive.link is not None:
            found += mechanism.links[drive.link].coordinates
        elif drive.distance is not None:
            found += drive.distance
        else:
            found += [guide.point for guide in mechanism.guides if guide.id == drive.guide]
    return [name for name in dict.fromkeys(found) if name in mechanism.moving_points]


def _dots(mechanism: Mechanism) -> list[str]:
    """Points where nothing is hinged."""
    found = []
    for name in (*mechanism.frame.points, *mechanism.moving_points):
        owners = sum(name in link.coordinates for link in mechanism.links.values())
        pins = sum(guide.point == name and guide.link is None for guide in mechanism.guides)
        ends = sum(name in (drive.distance or ()) for drive in mechanism.drives)
        if owners + pins + ends + (name in mechanism.frame.points) < 2:
            found.append(name)
    return found


def _still(scene: LinkageScene | Globe, motion: xarray.Dataset) -> Figure:
    """The initial position over the paths of the points."""
    with house_style():
        wide, high = INCHES * ((scene.high - scene.low) / scene.extent + 2 * MARGIN)
        figure = Figure(figsize=(wide, high))
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        draw = draw_globe if isinstance(scene, Globe) else draw_mechanism
        draw(axes, scene, initial_sample(scene, motion))  # type: ignore[arg-type]
        axes.set_axis_off()
    return figure
