"""Layers of the mechanism itself: frame, cams, links, wheels, hinges, names; in the plane and on the sphere."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from centrode.animation.layers import Array, MotionLayer
from centrode.render.drawing import signs
from centrode.render.drawing.cams import draw_axes_of_cams, draw_turned_cams
from centrode.render.drawing.globe import (
    arcs_on_paper,
    draw_arcs,
    draw_circles,
    draw_line,
    draw_points,
    draw_turns,
    frame_globe,
)
from centrode.render.drawing.linkage import (
    NAME_POINTS,
    draw_drive,
    draw_frame,
    draw_hinges,
    draw_links,
    used_points,
)
from centrode.render.drawing.style import GROUND, INK, MUTED, pens
from centrode.render.drawing.tags import lines, steady_offsets
from centrode.render.drawing.texts import plain
from centrode.scenes.places import LinkageScene, View
from centrode.scenes.sphere import Globe

if TYPE_CHECKING:
    from centrode.animation.frames import Film

LOOKS = 12
"""Positions over which places of names are chosen."""


class LinksLayer(MotionLayer):
    """A mechanism in its conventional signs, with the names of its points."""

    def reach(self) -> Array:
        """The whole motion; below hinges of the frame there is their ground."""
        return self.box

    def stand(self, view: View) -> None:
        """Names get their places once, so that none jumps."""
        super().stand(view)
        self.pens = pens(self.scene.mechanism.link_names)
        looks = np.unique(np.linspace(0, self.count - 1, LOOKS).astype(int))
        point = view.per_inch / 72.0
        moments = []
        for look in looks.tolist():
            places = {name: self.on_paper(place) for name, place in self.scene.at(look).items()}
            moments.append((places, self._segments(look)))
        offset = self.scene.sign + 0.85 * NAME_POINTS * point
        self.names = steady_offsets(moments, offset, NAME_POINTS * point)

    def ground(self, axes: Axes) -> None:
        """The frame, or the sphere."""
        if isinstance(self.scene, Globe):
            limits = axes.get_xlim(), axes.get_ylim()
            frame_globe(axes, self.scene)
            axes.set_xlim(limits[0])
            axes.set_ylim(limits[1])
        else:
            draw_frame(axes, self.scene, 0)
            draw_axes_of_cams(axes, self.scene)
        if self.film.course.loop != "round":  # the sense of the drive changes
            return
        if isinstance(self.scene, Globe):
            draw_turns(axes, self.scene, 0)
        else:
            draw_drive(axes, self.scene, 0)

    def draw(self, axes: Axes, frame: int) -> None:
        """Everything that moves, and the hinges of the frame over it."""
        sample = self.sample(frame)
        if isinstance(self.scene, Globe):
            draw_circles(axes, self.scene, sample, self.pens)
            draw_arcs(axes, self.scene, sample, self.pens)
            draw_points(axes, self.scene, sample, self.pens)
        else:
            draw_turned_cams(axes, self.scene, sample)
            draw_links(axes, self.scene, sample, self.pens)
            draw_hinges(axes, self.scene, sample, self.pens)
            self._draw_fixed_hinges(axes, self.scene, sample)
        for name, place in self.scene.at(sample).items():
            x, y = self.on_paper(place) + self.names.get(name, np.zeros(2))
            axes.text(
                x, y, plain(name), fontsize=NAME_POINTS, color=INK, ha="center", va="center", zorder=8
            )  # fmt: skip

    def _draw_fixed_hinges(self, axes: Axes, scene: LinkageScene, sample: int) -> None:
        used, places = used_points(scene), scene.at(sample)
        for name in scene.mechanism.frame.points:
            if name in used and name in places:
                signs.hinge(axes, places[name], scene.sign, GROUND)
        for cam in scene.cams:
            signs.hinge(axes, cam.hub, scene.sign, GROUND)

    def _segments(self, sample: int) -> list[tuple[Array, Array]]:
        if isinstance(self.scene, Globe):
            return arcs_on_paper(self.scene, sample)
        return lines(self.scene, sample)


# The layer of the points' paths: whole from the first frame on, or growing behind their points.

WIDTH = 1.2


class PathsLayer(MotionLayer):
    """Paths of points, all grey: colours belong to the links, and a path is known by the point on it."""

    def __init__(self, film: Film, scene: LinkageScene | Globe, points: Sequence[str], growing: bool) -> None:
        super().__init__(film, scene)
        self.points = points
        self.growing = growing
        self.passed = film.passed_samples

    def ground(self, axes: Axes) -> None:
        """Whole paths do not move."""
        for name in () if self.growing else self.points:
            self._draw_path(axes, self.scene.tracks[name][self.count :])

    def draw(self, axes: Axes, frame: int) -> None:
        """Growing ones end at their point."""
        sample = self.sample(frame)
        for name in self.points if self.growing else ():
            self._draw_path(axes, self.behind(name, sample))

    def behind(self, name: str, sample: int) -> Array:
        """The path of a point from the beginning of the course to where the point is."""
        track = self.scene.tracks[name]
        return np.concatenate(
            [track[self.count : self.count + int(self.passed[sample])], track[sample][None]]
        )

    def _draw_path(self, axes: Axes, path: Array) -> None:
        if isinstance(self.scene, Globe):
            draw_line(axes, self.scene, path, MUTED, WIDTH, zorder=1.5)
        else:
            axes.plot(*path.T, color=MUTED, linewidth=WIDTH, zorder=1.45, scalex=False, scaley=False)
