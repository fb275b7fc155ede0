"""Layers of cams: a walking wheel seen from its hub, and a cam that turns below its roller."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Polygon

from centrode.animation.frames import Loop, frame_ways
from centrode.animation.layers import Array, Layer, decimals_for, plain_number, turned_caption
from centrode.animation.stage import Stage
from centrode.animation.video_files import (
    FRAMES,
    PER_SECOND,
    SIZE,
    Animation,
    Pace,
    Said,
    Timing,
    no_progress,
    size_of,
    write_stage,
)
from centrode.cams.followers.base_circle import follower_cam
from centrode.cams.followers.geometry import Oscillating
from centrode.cams.profiles import ProfileBody, cam_body
from centrode.cams.results import WalkingWheelResults, walking_wheel
from centrode.cams.roller_path import frames as frames_along
from centrode.cams.walking_wheel import WheelMover
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cam_files import AnyCam, require_curvature_cam
from centrode.model.follower_cam import PlateCam
from centrode.model.settings import shown_as
from centrode.quantities import QUANTITIES, spelled_unit, with_unit
from centrode.render.drawing import signs
from centrode.render.drawing.cams import CAM, CHAIN, ROLLER, FollowerDrawing
from centrode.render.drawing.style import GROUND, INK, MUTED
from centrode.render.drawing.walking_wheel import draw_wheel, reach, wheel_keys
from centrode.scenes.places import View, turn_vectors

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.cams.followers.profile_results import FollowerProfileResults
    from centrode.cams.results import CamProfileResults
    from centrode.model.settings import Display

POINTS = 720
STEM = 3.0
"""Length of the follower's stem above its highest place, in radii of the roller."""


def walking_stage(
    wheel: WheelMover, frames: int, size: tuple[int, int], title: str, display: Display | None, *, dark: bool
) -> Stage:
    """The stage of one step of a walking wheel."""
    angles = -wheel.half + math.tau / wheel.legs * frame_ways("round", frames)
    layer = WalkingLayer(wheel, angles, shown_as("m", display)[0])
    return _turning(layer, angles, size, title, display, dark=dark)


def roller_stage(
    body: ProfileBody, frames: int, size: tuple[int, int], title: str, display: Display | None, *, dark: bool
) -> Stage:
    """The stage of a cam that turns below its roller, once round or, where it is open, there and back."""
    first, last = body.closed.start, body.closed.stop
    angles = first + (last - first) * frame_ways(loop_of(body), frames)
    layer = TurningCamLayer(body, angles, shown_as("m", display)[0])
    return _turning(layer, angles, size, title, display, dark=dark)


def loop_of(body: ProfileBody) -> Loop:
    """How the animation of a cam runs on."""
    return "round" if _whole(body) else "back"


def _whole(body: ProfileBody) -> bool:
    return body.closed.stop - body.closed.start >= math.tau * (1.0 - 1e-9)


def _turning(
    layer: Layer, angles: Array, size: tuple[int, int], title: str, display: Display | None, *, dark: bool
) -> Stage:
    captions = [turned_caption(float(angle), display) for angle in angles]
    return Stage([layer], len(angles), size, title, lambda frame: captions[frame], dark=dark)


class WalkingLayer(Layer):
    """A walking wheel over one step or more, seen from its hub: the ground passes by.

    The carrier turns evenly; after a step the next leg stands where the last one stood and the ground has moved on by
    the distance of two footprints, so that the last picture leads to the first.
    """

    def __init__(self, wheel: WheelMover, turned_by: Array, factor: float) -> None:
        self.wheel = wheel
        self.turned_by = turned_by
        self.factor = factor

    def reach(self) -> Array:
        """The wheel about its hub at any instant, and the ground."""
        far = 1.04 * reach(self.wheel)
        return self.factor * np.array([[-far, -0.09 * far], [far, self.wheel.height + far]])

    def draw(self, axes: Axes, frame: int) -> None:
        """The whole wheel; the limits go along with the hub."""
        pose = self.wheel.pose(float(self.turned_by[frame]))
        left, right = axes.get_xlim()
        hub = self.factor * float(pose.hub[0])
        axes.set_xlim(hub - (right - left) / 2.0, hub + (right - left) / 2.0)
        draw_wheel(axes, self.wheel, pose, self.factor)

    def entries(self) -> Sequence[tuple[Artist, str]]:
        """What the colours mean."""
        return wheel_keys()


class TurningCamLayer(Layer):
    """A cam that turns about its centre below its roller, whose stem moves up and down in a guide.

    The same as a roller carried round a fixed cam, seen from the carrier.
    """

    def __init__(self, body: ProfileBody, angles: Array, factor: float) -> None:
        self.body = body
        self.angles = angles
        self.factor = factor
        phi = np.linspace(body.closed.start, body.closed.stop, POINTS + 1)
        self.path = factor * frames_along(body.closed, phi).place
        self.profile = factor * body.profile(phi).place
        self.centres = factor * frames_along(body.closed, angles).place
        self.roller = factor * body.roller
        self.top = float(np.hypot(*self.path.T).max()) + (1.0 + STEM) * self.roller

    def reach(self) -> Array:
        """The circle that the cam sweeps, and the stem above it."""
        far = float(np.hypot(*np.concatenate([self.path, self.profile]).T).max())
        return np.array([[-far, -far], [far, self.top + self.roller]])

    def stand(self, view: View) -> None:
        """Signs are as large as on any drawing."""
        self.view = view

    def at(self, places: Array, frame: int) -> Array:
        """Where places (n, 2) in the cam's axes are in a frame."""
        return turn_vectors(places.T, float(self.angles[frame]))

    def ground(self, axes: Axes) -> None:
        """The guide of the stem."""
        for side in (-1.0, 1.0):
            foot = np.array([0.45 * side * self.roller, self.top - self.roller])
            away = np.array([side, 0.0])
            signs.ground(axes, foot, foot + self.roller * np.array([0.0, 1.0]), away, self.view.sign)

    def draw(self, axes: Axes, frame: int) -> None:
        """The cam with the path of the roller's centre, the roller, its stem, and the hub."""
        profile, path = self.at(self.profile, frame), self.at(self.path, frame)
        if _whole(self.body):
            axes.add_artist(Polygon(profile, facecolor=CAM, edgecolor="none", alpha=0.15, zorder=3))
        else:
            shape = np.concatenate([np.zeros((1, 2)), profile])
            axes.add_artist(Polygon(shape, facecolor=CAM, edgecolor="none", alpha=0.15, zorder=3))
        axes.plot(*profile.T, color=CAM, linewidth=1.8, zorder=4)
        axes.plot(*path.T, color=MUTED, linewidth=0.9, linestyle=CHAIN, zorder=3)
        mark = np.stack([np.zeros(2), profile[0]])
        axes.plot(*mark.T, color=CAM, linewidth=1.0, zorder=3.5)  # by it the turning is seen
        x, y = self.at(self.centres[frame][None], frame)[0]
        axes.plot([x, x], [y, self.top], color=ROLLER, linewidth=2.4, zorder=5)
        axes.add_artist(
            Circle((x, y), self.roller, facecolor="white", edgecolor=ROLLER, linewidth=1.6, zorder=6)
        )
        axes.plot([x], [y], marker="+", color=ROLLER, markersize=6, zorder=7)
        signs.hinge(axes, np.zeros(2), self.view.sign, GROUND)

    def entries(self) -> Sequence[tuple[Artist, str]]:
        """What the colours mean."""
        return [
            (Line2D([], [], color=CAM, linewidth=1.8), _("cam")),
            (Line2D([], [], color=MUTED, linewidth=0.9, linestyle=CHAIN), _("path of the roller's centre")),
            (Line2D([], [], color=ROLLER, marker="o", markerfacecolor="white", markersize=7), _("roller")),
            (Line2D([], [], color=INK, marker="o", markerfacecolor="white", linestyle="none"), _("hub")),
        ]


# A cam that turns below its follower, as a layer.


def follower_captions(body: FollowerCam, angles: Array, display: Display | None) -> list[str]:
    """The angle of the cam and the lift of its follower, frame by frame, with as many decimals in all of them."""
    factor, unit = shown_as("rad", display)
    lift_unit = "rad" if isinstance(body.guide, Oscillating) else "m"
    lift_factor, lift_shown = shown_as(lift_unit, display)
    lifts = lift_factor * body.motion.lift(np.mod(angles, math.tau))[0]
    decimals = decimals_for(lifts, lift_shown)
    turned, lifted = QUANTITIES["cam_angle"].symbol, QUANTITIES["lift"].symbol
    label, lift_label = spelled_unit(unit), spelled_unit(lift_shown)
    return [
        f"{turned} = {with_unit(plain_number(factor * angle, 1 if unit == 'deg' else 3), label)},  "
        f"{lifted} = {with_unit(plain_number(lift, decimals), lift_label)}"
        for angle, lift in zip(angles.tolist(), lifts.tolist(), strict=True)
    ]


def follower_stage(
    body: FollowerCam, frames: int, size: tuple[int, int], title: str, display: Display | None, *, dark: bool
) -> Stage:
    """The stage of one turn of a cam below its follower."""
    angles = math.tau * frame_ways("round", frames)
    captions = follower_captions(body, angles, display)
    layer = FollowerLayer(body, angles, shown_as("m", display)[0])
    return Stage([layer], frames, size, title, lambda frame: captions[frame], dark=dark)


class FollowerLayer(FollowerDrawing, Layer):
    """A plate cam that turns about its axis, and the follower that it moves."""


# The animation of a cam: a walking wheel's step, or a turn below the roller or the follower.


def animate_cam(
    cam: AnyCam, path: Path, pace: Pace, size: Sequence[int] | str, dark: bool, said: Said
) -> Animation:
    """A step of the walking wheel, or a turn of the cam; an open cam runs there and back."""
    timing = pace.timing(path.suffix.lower(), _period(cam, pace))
    pixels = size_of(size, path.suffix.lower(), timing.frames)
    stage, loop = _stage_of(cam, timing.frames, pixels, dark)
    write_stage(stage, path, timing, said)
    return Animation(path, timing.frames, timing.per_second, pixels, loop)


def _stage_of(cam: AnyCam, frames: int, size: tuple[int, int], dark: bool) -> tuple[Stage, Loop]:
    """The stage of a cam, and how it runs on."""
    title, display = _(cam.title), cam.display
    if isinstance(cam, PlateCam):
        return follower_stage(follower_cam(cam), frames, size, title, display, dark=dark), "round"
    if require_curvature_cam(cam).mover is not None:
        return walking_stage(walking_wheel(cam), frames, size, title, display, dark=dark), "round"
    body = cam_body(cam)
    return roller_stage(body, frames, size, title, display, dark=dark), loop_of(body)


def _period(cam: AnyCam, pace: Pace) -> float:
    """How long a turn of the cam takes [s], where that is asked for."""
    speed = cam.body.speed if isinstance(cam, PlateCam) else None
    if speed is not None:
        return math.tau / speed
    if pace.speed is not None:
        raise InputError("speed", _("a cam has no speed of its own"), _("give a duration instead"))
    return 1.0


# Animations of results that are there already.

FRAMES_OF_A_STEP, STEPS_PER_SECOND = 36, 100.0 / 7.0
FRAMES_OF_A_TURN = FRAMES


def animate_body(
    body: WheelMover | ProfileBody | FollowerCam,
    path: Path,
    title: str = "",
    display: Display | None = None,
    *,
    frames: int | None = None,
    dark: bool = False,
    said: Said = no_progress,
) -> None:
    """Write an animation (GIF or MP4): a step of a walking wheel, a turn of a cam below its roller or its follower.

    Parameters
    ----------
    body : WheelMover, ProfileBody or FollowerCam
        Of `walking_wheel`, `cam_body` or `follower_cam`. A cam that is open turns there and back below its roller.
    path : Path
        The file, GIF or MP4 by the ending of its name.
    title : str
        Above the pictures.
    display : Display
        Units of what is written; metres and radians if left out.
    frames : int
        36 of a step, 60 of a turn if left out.
    dark : bool
        Light lines on a dark ground.
    said : callable
        Told after each frame how many are done, and of how many.
    """
    rate = PER_SECOND
    if isinstance(body, WheelMover):
        stage = walking_stage(body, frames or FRAMES_OF_A_STEP, SIZE, title, display, dark=dark)
        rate = STEPS_PER_SECOND
    elif isinstance(body, ProfileBody):
        stage = roller_stage(body, frames or FRAMES_OF_A_TURN, SIZE, title, display, dark=dark)
    else:
        stage = follower_stage(body, frames or FRAMES_OF_A_TURN, SIZE, title, display, dark=dark)
    write_stage(stage, Path(path), Timing(stage.frames, rate), said)


def animate_body_of(
    results: WalkingWheelResults | CamProfileResults | FollowerProfileResults, path: Path, dark: bool = False
) -> None:
    """Write an animation of the wheel or the cam of a result; nothing where there is none."""
    body = results.wheel if isinstance(results, WalkingWheelResults) else results.body
    if body is not None:
        animate_body(body, path, _(results.cam.title), results.cam.display, dark=dark)
