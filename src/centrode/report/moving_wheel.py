"""The walking wheel as a motion to be played: one turn of its carrier, seen from the hub."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from centrode.cams.roller_path import frames
from centrode.locale import _
from centrode.model.settings import Display
from centrode.present.cams.walking_wheel import (
    CAM,
    CARRIER,
    FREE,
    PRINT,
    carrier_radius,
    draw_wheel,
    reach,
    window,
)
from centrode.present.signs import slider_outline
from centrode.present.style import GROUND, MUTED, house_style
from centrode.render.document.blocks import Moving, Outline, shown
from centrode.render.document.figures import picture
from centrode.render.document.numbers import Numbers
from centrode.report.circles import LIFT, Array, circle, hatched

if TYPE_CHECKING:
    from centrode.cams.walking_wheel import WheelMover, WheelPose

STEP = 45
"""Pictures of a step."""
POINTS = 121
INCHES = 5.2
DIGITS = 4


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
        still=picture(_still(wheel), ""),
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
    frame = frames(wheel.closed, phi)
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
    line = hatched(np.array([low, 0.0]), np.array([high, 0.0]), np.array([0.0, -1.0]), apart / 0.9)
    yield Outline(line, passing, GROUND)
    ends = np.array([-wheel.half, wheel.half])
    own = wheel.travel(ends) + wheel.touch(ends)
    steps = np.arange(math.floor(low / wheel.step), math.ceil(high / wheel.step) + 1)
    prints = [np.column_stack([own + step * wheel.step, np.zeros(2)]) for step in steps]
    yield Outline(np.concatenate([np.concatenate([one, LIFT]) for one in prints]), passing, PRINT)


def _still(wheel: WheelMover) -> Figure:
    """The wheel where its first leg stands straight down."""
    with house_style():
        figure = Figure(figsize=(INCHES, INCHES))
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        pose = wheel.pose(0.0)
        draw_wheel(axes, wheel, pose, 1.0)
        window(axes, wheel, pose, 1.0)
        axes.set_axis_off()
    return figure
