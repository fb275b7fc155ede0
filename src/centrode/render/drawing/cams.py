"""Cams that drive a linkage, drawn with it: the profile, its axis, the roller, the arm or the face."""

from __future__ import annotations

import functools
import importlib
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Polygon
from numpy.typing import NDArray

from centrode.locale import _
from centrode.render.drawing import signs
from centrode.render.drawing.style import GROUND, INK, MUTED, PALETTE

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.scenes.driving_cams import DrivingCam
    from centrode.scenes.places import LinkageScene, View

# what computes cams is not loaded for a linkage without any
_driving_cams = functools.partial(importlib.import_module, "centrode.scenes.driving_cams")


def draw_cams(axes: Axes, scene: LinkageScene, sample: int) -> None:
    """The driving cams of a scene as they stand at a sample, on their axes."""
    draw_axes_of_cams(axes, scene)
    draw_turned_cams(axes, scene, sample)


def draw_axes_of_cams(axes: Axes, scene: LinkageScene) -> None:
    """The hinges on the frame that the driving cams turn about."""
    for cam in scene.cams:
        signs.fixed_hinge(axes, cam.hub, scene.sign)


def draw_turned_cams(axes: Axes, scene: LinkageScene, sample: int) -> None:
    """The driving cams with roller, arm or face of their followers, without their axes."""
    for cam in scene.cams:
        if np.isfinite(cam.angles[sample]):
            draw_profile(axes, cam, sample)
            draw_touching(axes, cam, sample)


def draw_profile(axes: Axes, cam: DrivingCam, sample: int, line: str = INK, tint: str = MUTED) -> None:
    """A cam without its axis, as it has turned."""
    outline = cam.outline(sample)
    axes.add_artist(Polygon(outline, closed=True, facecolor=tint, edgecolor="none", alpha=0.25, zorder=1.8))
    axes.add_artist(Polygon(outline, closed=True, fill=False, edgecolor=line, linewidth=1.4, zorder=2.1))
    axes.plot(*cam.mark(sample).T, color=line, linewidth=1.0, zorder=2.1)


def draw_touching(axes: Axes, cam: DrivingCam, sample: int, line: str = INK) -> None:
    """What belongs to the follower alone: arm or face, and roller."""
    for ends in cam.lines(sample):
        axes.plot(*np.array(ends).T, color=line, linewidth=1.6, solid_capstyle="round", zorder=2.3)
    roller = cam.roller(sample)
    if roller is not None:
        (x, y), radius = roller
        rim = Circle(
            (float(x), float(y)), radius, facecolor="white", edgecolor=line, linewidth=1.4, zorder=2.35
        )
        axes.add_artist(rim)


# A cam that turns below its follower, which is a stem or an arm with roller, edge or flat face.

Array = NDArray[np.float64]
CAM, ROLLER = PALETTE[0], PALETTE[1]
CHAIN = (0, (5, 1.2, 1.2, 1.2))
GAP, WALLS, ABOVE = 0.12, 0.4, 0.15
"""Between the highest place of a translating follower and its guide, length of the guide, and stem above it; as parts
of the greatest radius of the cam."""
WEDGE = (0.7, 2.4)
"""Half width and height of a knife edge, over the size of a hinge."""


class FollowerDrawing:
    """A plate cam that turns about its axis, and the follower that it moves, in the axes of the frame.

    Parameters
    ----------
    body : FollowerCam
    angles : (frame) [rad]
        That the cam has turned in its sense.
    factor : float
        Drawing units in a metre.
    """

    def __init__(self, body: FollowerCam, angles: Array, factor: float) -> None:
        driving = _driving_cams()
        self.cam: DrivingCam = driving.DrivingCam.alone(body, angles, factor)
        phi = np.linspace(0.0, body.edges[-1], driving.PLACES)
        found = body.contact(phi)
        self.path = found.centre
        self.far = factor * float(np.linalg.norm(found.place, axis=1).max())
        roller = body.touch.roller
        self.rolls = 0.0 < roller < math.inf
        self.edged = roller == 0.0
        self.frames = range(len(angles))
        lifts = body.motion.lift(phi)[0]
        self.top = factor * (body.guide.start + float(np.max(lifts)) + (roller if self.rolls else 0.0))
        self.stem = self.top - factor * body.guide.start + (GAP + WALLS + ABOVE) * self.far

    def reach(self) -> Array:
        """The circle that the cam sweeps with the path about it, and the follower over the whole turn."""
        swept = (
            max(self.far, self.cam.factor * float(np.hypot(*self.path.T).max())) if self.rolls else self.far
        )
        corners = [swept * np.array([[-1.0, -1.0], [1.0, 1.0]]), self.cam.reach()]
        corners += [np.array(line) for frame in self.frames for line in self.cam.lines(frame)]
        if self.cam.pivot is None:
            corners += [self._stem(frame) for frame in self.frames]
        return np.concatenate(corners)

    def stand(self, view: View) -> None:
        """Signs are as large as on any drawing."""
        self.size = view.sign

    def ground(self, axes: Axes) -> None:
        """The hinges on the frame, or the guide, and how the cam turns."""
        signs.fixed_hinge(axes, self.cam.hub, self.size)
        signs.turning_arrow(axes, signs.turning_arc(self.cam.hub, 0.0, self.cam.forward, self.size), GROUND)
        if self.cam.pivot is not None:
            signs.fixed_hinge(axes, self.cam.factor * self.cam.pivot, self.size)
            return
        low = self.top + GAP * self.far
        for side in (-1.0, 1.0):
            x = self.cam.foot(0)[0] + 1.2 * side * self.size
            ends = np.array([x, low]), np.array([x, low + WALLS * self.far])
            signs.ground(axes, *ends, np.array([side, 0.0]), self.size)

    def draw(self, axes: Axes, frame: int) -> None:
        """The cam with the path of the roller's centre, the follower over it, and the hinges over both."""
        draw_profile(axes, self.cam, frame, CAM, CAM)
        if self.rolls:
            path = self.cam.carried_places(self.path, frame)
            axes.plot(*path.T, color=MUTED, linewidth=0.9, linestyle=CHAIN, zorder=2.0)
        if self.cam.pivot is None:
            axes.plot(*self._stem(frame).T, color=ROLLER, linewidth=2.4, solid_capstyle="butt", zorder=2.2)
        draw_touching(axes, self.cam, frame, ROLLER)
        foot = self.cam.foot(frame)
        if self.rolls:
            axes.plot(*foot[:, None], marker="+", color=ROLLER, markersize=6, zorder=7)
        elif self.edged:
            axes.add_artist(Polygon(self._wedge(foot), facecolor=ROLLER, edgecolor=ROLLER, zorder=2.4))
        signs.hinge(axes, self.cam.hub, self.size, GROUND)
        if self.cam.pivot is not None:
            signs.hinge(axes, self.cam.factor * self.cam.pivot, self.size, GROUND)

    def entries(self) -> Sequence[tuple[Artist, str]]:
        """What the colours mean."""
        found: list[tuple[Artist, str]] = [(Line2D([], [], color=CAM, linewidth=1.8), _("cam"))]
        if self.rolls:
            path = Line2D([], [], color=MUTED, linewidth=0.9, linestyle=CHAIN)
            found.append((path, _("path of the roller's centre")))
        return [*found, (Line2D([], [], color=ROLLER, linewidth=2.4), _("follower"))]

    def _stem(self, frame: int) -> Array:
        """The axis of a translating follower, from where it touches to above its guide."""
        foot = self.cam.foot(frame)
        return np.stack([foot, foot + np.array([0.0, self.stem])])

    def _wedge(self, edge: Array) -> Array:
        """A knife's corners; it stands on its edge, across the arm or along the stem."""
        along = np.array([0.0, 1.0])
        if self.cam.pivot is not None:
            arm = self.cam.factor * self.cam.pivot - edge
            along = np.array([-arm[1], arm[0]]) / float(np.hypot(*arm))
            along = along if along @ (edge - self.cam.hub) > 0.0 else -along
        across = np.array([-along[1], along[0]])
        half, high = WEDGE[0] * self.size, WEDGE[1] * self.size
        return np.array([edge, edge + high * along + half * across, edge + high * along - half * across])
