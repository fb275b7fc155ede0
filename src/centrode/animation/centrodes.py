"""The layer of rolling centrodes, on the sphere of polodes: the moving one rolls on the fixed one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from centrode.analysis.instant_centres.centres import instant_centres
from centrode.analysis.instant_centres.centrodes import centrodes
from centrode.animation.layers import FAR, WHOLE, Array, MotionLayer
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.labels import body_name, sliders_of
from centrode.model.reading import FRAME
from centrode.render.drawing.globe import draw_line
from centrode.render.drawing.style import LINK, marker_options, pens
from centrode.render.drawing.texts import centre_symbol
from centrode.render.drawing.window import carried_by, within
from centrode.scenes.places import LinkageScene
from centrode.scenes.sphere import Globe, laid

if TYPE_CHECKING:
    import xarray

    from centrode.animation.frames import Film

FIXED, MOVING, CENTRE_OF_PAIR = "#0072B2", "#D55E00", "#A00000"
LOOKS = 9
"""Positions whose curves the view holds."""


class CentrodesLayer(MotionLayer):
    """Both centrodes of a link against another body, laid where the bodies are."""

    def __init__(
        self,
        film: Film,
        scene: LinkageScene | Globe,
        link: str,
        against: str = FRAME,
        found: xarray.Dataset | None = None,
    ) -> None:
        super().__init__(film, scene)
        found = centrodes(film.course.motion, link, against) if found is None else found
        self.bodies = (str(found.attrs["against"]), str(found.attrs["link"]))
        self.pieces = found["centrode_piece"].values
        if int((self.pieces >= 0).sum()) < 2:
            raise InputError(
                "link", _("there is no centrode in this range"), _("choose another link or another range")
            )
        self.curves = [found[f"{name}_centrode"].values for name in ("fixed", "moving")]
        self.contact = centrodes(film.motion, self.bodies[1], self.bodies[0])["fixed_centrode"].values

    def reach(self) -> Array:
        """What of both curves comes not too far out."""
        if isinstance(self.scene, Globe):
            return WHOLE
        low, high = self.box
        far = FAR * float(np.max(high - low))
        looks = np.unique(np.linspace(0, self.count - 1, LOOKS).astype(int)).tolist()
        places = np.concatenate([self.placed_curve(side, look) for side in (0, 1) for look in looks])
        with np.errstate(invalid="ignore"):
            return np.asarray(places[((places > low - far) & (places < high + far)).all(axis=1)])

    def placed_curve(self, side: int, sample: int) -> Array:
        """The fixed (0) or the moving curve (1) as it lies at a sample; NaN where its body has no position."""
        return self._curve_carried_by(self.bodies[side], self.curves[side], sample)

    def touching(self, sample: int) -> Array:
        """Where one rolls on the other at a sample."""
        return np.asarray(self._curve_carried_by(self.bodies[0], self.contact[sample][None], sample)[0])

    def ground(self, axes: Axes) -> None:
        """The curve of the frame stands still."""
        for side in (0, 1):
            if self.bodies[side] == FRAME:
                self._draw_curve(axes, side, 0)

    def draw(self, axes: Axes, frame: int) -> None:
        """What rolls, and the place where it touches."""
        sample = self.sample(frame)
        for side in (0, 1):
            if self.bodies[side] != FRAME:
                self._draw_curve(axes, side, sample)
        place = self.touching(sample)
        if np.isfinite(place).all() and within(axes, self.on_paper(place)):
            behind = isinstance(self.scene, Globe) and not bool(self.scene.in_front(place))
            axes.plot(*self.on_paper(place), marker="D", markersize=5.0, color=CENTRE_OF_PAIR,
                      markeredgecolor="white", alpha=0.45 if behind else 1.0, zorder=9.5)  # fmt: skip

    def entries(self) -> Sequence[tuple[Artist, str]]:
        """Whose curves they are."""
        texts = (
            (_("fixed polode (of {name})"), _("moving polode (of {name})"))
            if isinstance(self.scene, Globe)
            else (_("fixed centrode (of {name})"), _("moving centrode (of {name})"))
        )
        return [
            (
                Line2D([], [], color=colour, linewidth=1.6),
                text.format(name=body_name(self.film.mechanism, body)),
            )
            for colour, text, body in zip((FIXED, MOVING), texts, self.bodies, strict=True)
        ]

    def _curve_carried_by(self, body: str, curve: Array, sample: int) -> Array:
        if isinstance(self.scene, Globe):
            found = laid(self.scene, body, curve, sample)
            return np.full_like(curve, np.nan) if found is None else found
        return carried_by(self.scene, body, curve, sample)

    def _draw_curve(self, axes: Axes, side: int, sample: int) -> None:
        """Piece by piece, so that nothing joins where the curve goes to infinity."""
        curve, colour = self.placed_curve(side, sample), (FIXED, MOVING)[side]
        for piece in np.unique(self.pieces[self.pieces >= 0]):
            own = curve[self.pieces == piece]
            if isinstance(self.scene, Globe):
                draw_line(axes, self.scene, own, colour, 1.6, zorder=7.2)
                continue
            dot: dict[str, Any] = {"marker": "o", "markersize": 2.5} if len(own) == 1 else {}
            axes.plot(*own.T, color=colour, linewidth=1.6, zorder=7.2, scalex=False, scaley=False, **dot)


# The layer of instant centres with their names; on the sphere of the ends of instantaneous axes.

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
        self, film: Film, scene: LinkageScene | Globe, pairs: Sequence[tuple[str, str]] | None = None
    ) -> None:
        super().__init__(film, scene)
        mechanism = film.mechanism
        self.bodies = (FRAME, *mechanism.link_names, *sliders_of(mechanism))
        if pairs is None and len(self.bodies) > FULL:
            pairs = [(name, FRAME) for name in self.bodies[1:]]
        found = instant_centres(film.motion, pairs)
        self.pairs = [str(label).split(",") for label in found["pair"].values]
        self.places = found["centre"].transpose("sample", "pair", "axis").values
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
        return centre_symbol((first, second), len(self.bodies))

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
                    Line2D(
                        [], [], color=links[name].colour, linewidth=LINK, **marker_options(links[name], None)
                    )
                    if name in links
                    else Line2D([], [], linewidth=0.0)
                )
                found.append((line, f"{number} {body_name(self.film.mechanism, name)}"))
        return found
