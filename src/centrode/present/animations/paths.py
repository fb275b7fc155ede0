"""The layer of the points' paths: whole from the first frame on, or growing behind their points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from centrode.present.animations.layers import Array
from centrode.present.animations.motions import MotionLayer
from centrode.present.scene import Scene
from centrode.present.sphere.globe import Globe
from centrode.present.sphere.globe_drawing import draw_line
from centrode.present.style import MUTED

if TYPE_CHECKING:
    from centrode.study.moving.films import Film

WIDTH = 1.2


class PathsLayer(MotionLayer):
    """Paths of points, all grey: colours belong to the links, and a path is known by the point on it."""

    def __init__(self, film: Film, scene: Scene | Globe, points: Sequence[str], growing: bool) -> None:
        super().__init__(film, scene)
        self.points = points
        self.growing = growing
        self.passed = film.passed

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
