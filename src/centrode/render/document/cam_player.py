"""Cams with their followers as shapes that move: profile, mark, roller, arm or face, stem."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from centrode.locale import _
from centrode.model.settings import Display
from centrode.render.document.blocks import Moving, Outline, shown
from centrode.render.document.figures import picture
from centrode.render.document.numbers import Numbers
from centrode.render.drawing.cams import GAP, WALLS, FollowerDrawing
from centrode.render.drawing.colours import CARRIER
from centrode.render.drawing.linkage import MARGIN
from centrode.render.drawing.signs import slider_outline
from centrode.render.drawing.style import GROUND, INK, MUTED, house_style
from centrode.render.drawing.walking_wheel import (
    CAM,
    FREE,
    PRINT,
    carrier_radius,
    draw_wheel,
    reach,
    window,
)
from centrode.scenes.places import View

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.cams.walking_wheel import WheelMover, WheelPose
    from centrode.scenes.driving_cams import DrivingCam

# Signs that shapes are made of: circles, hatched lines.

Array = NDArray[np.float64]
Samples = NDArray[np.intp]
ROUND = 48
"""Corners of a circle."""
LIFT = np.full((1, 2), np.nan)
AT_REST = np.zeros((1, 3))


def circle(radius: float, spoke: bool = False) -> Array:
    """A circle (n, 2) about the origin, with a spoke if asked."""
    turn = np.linspace(0.0, 2.0 * np.pi, ROUND + 1)
    rim = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return np.concatenate([rim, np.zeros((1, 2))]) if spoke else rim


def hatch(start: Array, end: Array, away: Array, size: float) -> Array:
    """A line (n, 2) with strokes on the side that the unit vector `away` points to."""
    along = (end - start) / max(float(np.hypot(*(end - start))), np.finfo(float).tiny)
    count = max(2, round(float(np.hypot(*(end - start))) / (0.9 * size)))
    feet = start + (np.arange(1, count + 1) / count)[:, None] * (end - start)
    tips = feet + 0.9 * size * (away - along)
    strokes = np.stack([feet, tips, np.full_like(feet, np.nan)], axis=1).reshape(-1, 2)
    return np.concatenate([[start, end], LIFT, strokes])


TURN = 180
"""Pictures of a turn."""
INCHES = 5.2
DIGITS = 4


def cam_shapes(cam: DrivingCam, samples: Samples, size: float) -> Iterator[Outline]:
    """A cam with what its follower touches it with, in units of the cam's picture; `size` is the radius of a hinge."""
    turned = (1.0 if cam.forward else -1.0) * cam.angles[samples]
    poses = np.column_stack([np.tile(cam.hub, (len(samples), 1)), turned])
    still = replace(cam, angles=np.zeros(1))
    profile = still.outline(0) - cam.hub
    yield Outline(profile, poses, MUTED, filled=True)
    closed = np.concatenate([profile, profile[:1], LIFT, still.mark(0) - cam.hub])
    yield Outline(closed, poses, INK)
    lines = np.array([cam.lines(int(sample)) for sample in samples])
    for k in range(lines.shape[1]):
        yield _rod(lines[:, k])
    rollers = [cam.roller(int(sample)) for sample in samples]
    if rollers[0] is not None:
        centres = np.array([one[0] for one in rollers if one is not None])
        yield Outline(
            circle(rollers[0][1]), np.column_stack([centres, np.zeros(len(centres))]), INK, white=True
        )
    yield Outline(circle(size) + cam.hub, AT_REST, GROUND, white=True, behind=False)


def _rod(ends: Array) -> Outline:
    """A straight body from its two ends (samples, 2, 2)."""
    way = ends[:, 1] - ends[:, 0]
    length = float(np.hypot(*way[0]))
    poses = np.column_stack([ends[:, 0], np.arctan2(way[:, 1], way[:, 0])])
    return Outline(np.array([[0.0, 0.0], [length, 0.0]]), poses, INK)


def moving_follower(body: FollowerCam, title: str = "") -> Moving:
    """A cam that turns under its follower, to be played; its mark can be dragged around.

    Parameters
    ----------
    body : FollowerCam
        Of `follower_cam`.
    title : str
        Of the cam, as its user wrote it.
    """
    angles = math.tau * np.arange(TURN + 1) / TURN
    drawing = FollowerDrawing(body, angles, 1.0)
    cam, samples = drawing.cam, np.arange(TURN + 1)
    reach = drawing.reach()
    low, high = reach.min(axis=0), reach.max(axis=0)
    view = View(low, high, float(np.max(high - low)) / INCHES)
    drawing.stand(view)
    size = view.sign
    tips = np.array([cam.foot(int(sample)) for sample in samples])
    marks = np.array([cam.mark(int(sample))[1] for sample in samples])
    places = {"O": np.zeros((1, 2)), "K": marks, "A": tips}
    bodies = {"cam": ("O", "K")}
    loose = ["K", *(["A"] if not 0.0 < body.touch.roller < math.inf else [])]
    if cam.pivot is not None:
        places["C"] = cam.pivot[None]
        if math.isfinite(body.touch.roller):
            bodies["arm"] = ("C", "A")
    shapes = list(cam_shapes(cam, samples, size))
    if cam.pivot is None:
        shapes += _stem(drawing, tips)
    numbers = Numbers(Display(), DIGITS)
    degrees = numbers.column(np.degrees(angles).tolist(), least=1e-9)
    return Moving(
        places=places,
        bodies=bodies,
        fixed=("O", "C") if cam.pivot is not None else ("O",),
        guides={},
        sliders={},
        drive=angles,
        drive_texts=tuple(f"φ = {one}°" for one in degrees),
        tracks=(),
        still=picture(_still(drawing, view), ""),
        caption=_("Motion of {title}").format(title=shown(title) or _("the cam and its follower")),
        shapes=tuple(shapes),
        driven=("K",),
        dots=tuple(loose),
        box=np.array([low, high]),
    )


def _stem(drawing: FollowerDrawing, tips: Array) -> Iterator[Outline]:
    """The stem of a translating follower, and the walls of its guide."""
    poses = np.column_stack([tips, np.zeros(len(tips))])
    yield Outline(np.array([[0.0, 0.0], [0.0, drawing.stem]]), poses, INK)
    low = drawing.top + GAP * drawing.far
    for side in (-1.0, 1.0):
        x = tips[0, 0] + 1.2 * side * drawing.size
        ends = np.array([x, low]), np.array([x, low + WALLS * drawing.far])
        yield Outline(hatch(*ends, np.array([side, 0.0]), drawing.size), AT_REST, GROUND)


def _still(drawing: FollowerDrawing, view: View) -> Figure:
    """The cam and its follower at the beginning of a turn."""
    room = MARGIN * float(np.max(view.high - view.low))
    low, high = view.low - room, view.high + room
    with house_style():
        wide, tall = INCHES * (high - low) / float(np.max(high - low))
        figure = Figure(figsize=(wide, tall))
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set_aspect("equal")
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
        drawing.ground(axes)
        drawing.draw(axes, 0)
        axes.set_axis_off()
    return figure


# The walking wheel as a motion to be played: one turn of its carrier, seen from the hub.

STEP = 45
"""Pictures of a step."""
POINTS = 121


def moving_wheel(wheel: WheelMover, title: str = "") -> Moving:
    """A walking wheel to be played; its rollers can be dragged around the cam.

    Parameters
    ----------
    wheel : WheelMover
        Of `walking_wheel`.
    title : str
        Of the cam, as its user wrote it.
    """
    turned = -wheel.half + math.tau * np.arange(STEP * wheel.legs + 1) / (STEP * wheel.legs)
    poses = [wheel.pose(float(one)) for one in turned]
    hub = np.array([0.0, wheel.height])
    legs = [f"{leg + 1}" for leg in range(wheel.legs)]
    rollers = {
        name: np.array([pose.rollers[leg] - pose.hub + hub for pose in poses])
        for leg, name in enumerate(legs)
    }
    far = 1.04 * reach(wheel)
    name = shown(title) or _("the walking wheel")
    numbers = Numbers(Display(), DIGITS)
    degrees = numbers.column(np.degrees(turned).tolist(), least=1e-9)
    return Moving(
        places={"O": hub[None], **rollers},
        bodies={},
        fixed=("O",),
        guides={},
        sliders={},
        drive=turned,
        drive_texts=tuple(f"φ = {one}°" for one in degrees),
        tracks=(),
        still=picture(_still_wheel(wheel), ""),
        caption=_("Motion of {title}").format(title=name),
        shapes=tuple(_shapes(wheel, poses, rollers)),
        driven=tuple(legs),
        dots=("O",),
        box=np.array([[-far, -0.09 * far], [far, wheel.height + far]]),
    )


def _shapes(wheel: WheelMover, poses: list[WheelPose], rollers: dict[str, Array]) -> Iterator[Outline]:
    """Ground, footprints, cam, carrier, legs: those below first."""
    still = np.array([[0.0, wheel.height, 0.0]])
    yield from _ground(wheel, poses)
    phi = np.linspace(wheel.closed.start, wheel.closed.stop, 2 * POINTS)
    frame = wheel.roller_frames(phi)
    yield Outline(-frame.place, still, MUTED)
    yield Outline(-(frame.place - wheel.roller * frame.normal), still, CAM, filled=True)
    ring = carrier_radius(wheel)
    yield Outline(circle(ring), still, CARRIER)
    angles = np.array([pose.angles for pose in poses])
    phi = np.linspace(-wheel.half, wheel.half, POINTS)
    outline = wheel.shoe.place(phi)
    top = np.array([[0.0, 0.8 * outline[[0, -1], 1].min()]])
    shoe = np.concatenate([outline, top]) * np.array([1.0, -1.0])
    rod = np.array([[0.0, 0.0], [0.0, -float(outline[:, 1].max())]])
    for leg, places in enumerate(rollers.values()):
        # a leg's axes: across to the right, along downwards where it stands straight down; it turns clockwise
        turn = -np.unwrap(angles[:, leg])
        own = np.column_stack([places, turn])
        yield Outline(shoe, own, FREE, filled=True)
        yield Outline(rod, own, FREE)
        guide = np.column_stack([np.tile(still[0, :2], (len(turn), 1)), turn])
        block = slider_outline(np.array([0.0, -ring]), math.pi / 2, 0.05 * ring)
        yield Outline(block, guide, CARRIER, white=True)
        yield Outline(circle(wheel.roller), own, FREE, white=True)
    contact = np.array([pose.contact - np.array([pose.hub[0], 0.0]) for pose in poses])
    dot = circle(0.02 * ring)
    yield Outline(dot, np.column_stack([contact, np.zeros(len(contact))]), PRINT, white=True, behind=False)


def _ground(wheel: WheelMover, poses: list[WheelPose]) -> Iterator[Outline]:
    """The hatched ground and the footprints, which pass by under the hub."""
    far = 1.04 * reach(wheel)
    hubs = np.array([pose.hub[0] for pose in poses])
    # so many strokes to a step that the ground looks alike after it
    apart = wheel.step / round(wheel.step / (0.027 * far))
    low = apart * math.floor((hubs.min() - 2 * far) / apart)
    high = apart * math.ceil((hubs.max() + 2 * far) / apart)
    passing = np.column_stack([-hubs, np.zeros((len(hubs), 2))])
    line = hatch(np.array([low, 0.0]), np.array([high, 0.0]), np.array([0.0, -1.0]), apart / 0.9)
    yield Outline(line, passing, GROUND)
    ends = np.array([-wheel.half, wheel.half])
    own = wheel.travel(ends) + wheel.touch(ends)
    steps = np.arange(math.floor(low / wheel.step), math.ceil(high / wheel.step) + 1)
    prints = [np.column_stack([own + step * wheel.step, np.zeros(2)]) for step in steps]
    yield Outline(np.concatenate([np.concatenate([one, LIFT]) for one in prints]), passing, PRINT)


def _still_wheel(wheel: WheelMover) -> Figure:
    """The wheel where its first leg stands straight down."""
    with house_style():
        figure = Figure(figsize=(INCHES, INCHES))
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        pose = wheel.pose(0.0)
        draw_wheel(axes, wheel, pose, 1.0)
        window(axes, wheel, pose, 1.0)
        axes.set_axis_off()
    return figure
