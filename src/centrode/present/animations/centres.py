"""The layer of instant centres with their names; on the sphere of the ends of instantaneous axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from centrode.analysis.instant_centres.bodies import sliders_of
from centrode.analysis.instant_centres.centres import instant_centres
from centrode.locale import _
from centrode.model.labels import body_name
from centrode.model.reading import FRAME
from centrode.present.animations.layers import WHOLE, Array
from centrode.present.animations.motions import FAR, MotionLayer
from centrode.present.scene import Scene
from centrode.present.sphere.globe import Globe
from centrode.present.style import pens
from centrode.present.symbols import subscripted
from centrode.present.window import within

if TYPE_CHECKING:
    from centrode.study.moving.films import Film

CENTRE = "#A00000"
FULL = 4
"""Bodies of which all centres are shown."""
NAMED = 9.0
"""Size of names [pt]."""
TOGETHER = 0.3
"""Places nearer than this share one text, in radii of a hinge."""


class CentresLayer(MotionLayer):
    """Instant centres of pairs of bodies, those that lie in the picture."""

    def __init__(
        self, film: Film, scene: Scene | Globe, pairs: Sequence[tuple[str, str]] | None = None
    ) -> None:
        super().__init__(film, scene)
        mechanism = film.mechanism
        self.bodies = (FRAME, *mechanism.link_names, *sliders_of(mechanism))
        if pairs is None and len(self.bodies) > FULL:
            pairs = [(name, FRAME) for name in self.bodies[1:]]
        found = instant_centres(film.motion, pairs)
        self.pairs = [str(label).split(",") for label in found["pair"].to_numpy()]
        self.places = found["centre"].transpose("sample", "pair", "axis").to_numpy()
        if isinstance(scene, Globe):
            # of the two ends of an axis the one that is seen
            seen = scene.in_front(np.nan_to_num(self.places))
            self.places = np.where(seen[..., None], self.places, -self.places)
        else:
            self.places = scene.factor * self.places

    def reach(self) -> Array:
        """Centres that come not too far out: others leave the picture."""
        if isinstance(self.scene, Globe):
            return WHOLE
        low, high = self.box
        far = FAR * float(np.max(high - low))
        places = self.places.reshape(-1, 2)
        with np.errstate(invalid="ignore"):
            return np.asarray(places[((places > low - far) & (places < high + far)).all(axis=1)])

    def draw(self, axes: Axes, frame: int) -> None:
        """A diamond in each, and its name beside it; those in one place share a text."""
        entries: list[tuple[Array, list[str]]] = []
        for pair, place in zip(self.pairs, self.places[self.sample(frame)], strict=True):
            if not np.isfinite(place).all():
                continue
            at = self.on_paper(place)
            if not within(axes, at):
                continue
            name = self.symbol(pair)
            near = [names for other, names in entries if np.hypot(*(other - at)) < TOGETHER * self.scene.sign]
            if near:
                near[0].append(name)
            else:
                entries.append((at, [name]))
        for at, names in entries:
            axes.plot(*at, marker="D", markersize=4.6, color=CENTRE, markeredgecolor="white",
                      markeredgewidth=0.6, zorder=9.0)  # fmt: skip
            axes.annotate(
                ", ".join(names), (at[0], at[1]), xytext=(6.0, -6.0), textcoords="offset points", fontsize=NAMED,
                color=CENTRE, ha="left", va="top", zorder=9.1,
            )  # fmt: skip

    def symbol(self, pair: Sequence[str]) -> str:
        """How the centre of a pair is called, by the bodies' numbers."""
        first, second = sorted((self.bodies.index(name) for name in pair), reverse=True)
        return subscripted((first, second), len(self.bodies))

    def entries(self) -> Sequence[tuple[Artist, str]]:
        """The bodies by number."""
        shown = {name for pair in self.pairs for name in pair}
        links = pens(self.film.mechanism.link_names)
        mark = Line2D([], [], color=CENTRE, marker="D", markersize=4.6, linestyle="none")
        title = _("instant axes") if isinstance(self.scene, Globe) else _("instant centres")
        found: list[tuple[Artist, str]] = [(mark, title)]
        for number, name in enumerate(self.bodies):
            if name in shown:
                line = (
                    Line2D([], [], color=links[name].colour, linestyle=links[name].dashes, linewidth=2.2)
                    if name in links
                    else Line2D([], [], linewidth=0.0)
                )
                found.append((line, f"{number} {body_name(self.film.mechanism, name)}"))
        return found
