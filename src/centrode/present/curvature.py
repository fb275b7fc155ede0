"""Curvature of point paths as a picture: inflection circle, cubic of stationary curvature, Ball's point."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.locale import _
from centrode.present.curves import write_title
from centrode.present.drawing import draw_mechanism
from centrode.present.obstacles import lines
from centrode.present.pictures import caption, label_lengths
from centrode.present.reading import scene_of
from centrode.present.scene import Array, turned
from centrode.present.shown import plain
from centrode.present.style import MUTED, house_style
from centrode.present.tags import Tag, write_tags
from centrode.present.window import segments_of, widened, within

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

WIDTH, HEIGHT = 8.2, 5.75  # inches: A5 across
PLACE = (0.085, 0.095, 0.62, 0.775)
CIRCLE, CUBIC, SIGN = "#0072B2", "#009E73", "#A00000"
NAMED = 10.0
STEPS = 721


def curvature_figure(
    mechanism: Mechanism, motion: xarray.Dataset, curvature: xarray.Dataset, sample: int = 0
) -> Figure:
    """The mechanism at one place with what bends the paths of a link's points.

    Parameters
    ----------
    mechanism : Mechanism
    motion, curvature : Dataset
        Of a planar mechanism, at the same samples. W is the inflection pole, U Ball's point; thin lines join
        points with the centres of curvature of their paths.
    """
    with house_style():
        scene = scene_of(mechanism, motion)
        signs = {
            symbol: scene.factor * curvature[name].to_numpy()[sample]
            for symbol, name in (("P", "pole"), ("W", "inflection_pole"), ("U", "ball_point"))
        }
        circle = _circle(signs["P"], signs["W"])
        places = np.concatenate([np.array(list(signs.values())), circle[::20]])
        scene = widened(scene, places, (PLACE[2] * WIDTH - 0.3, PLACE[3] * HEIGHT - 0.3))
        figure = Figure(figsize=(WIDTH, HEIGHT))
        axes = figure.add_axes(PLACE)
        draw_mechanism(axes, scene, sample, names=False)
        label_lengths(axes, scene)
        axes.set_title(caption(mechanism, motion, sample))
        cubic = _cubic(curvature, sample, scene.factor)
        how: dict[str, Any] = {"linewidth": 1.4, "scalex": False, "scaley": False, "zorder": 6.8}
        axes.plot(*circle.T, color=CIRCLE, **how)
        axes.plot(*cubic.T, color=CUBIC, **how)
        tags = [Tag(place, plain(name)) for name, place in scene.at(sample).items()]
        for symbol, place in signs.items():
            if np.isfinite(place).all() and within(axes, place):
                axes.plot(*place, marker="D", markersize=5.0, color=SIGN, markeredgecolor="white", zorder=9)
                tags.append(Tag(place, _("pole") if symbol == "P" else f"${symbol}$"))
        rays = _radii(curvature, scene.at(sample), scene.factor, sample)
        for start, end in rays:
            axes.plot(
                *np.array([start, end]).T, color=MUTED, linewidth=0.8, zorder=6.5, scalex=False, scaley=False
            )
        near = [curve[::4] for curve in (circle, cubic)]
        reach = 72 * scene.sign * scene.inches / scene.extent
        write_tags(axes, tags, lines(scene, sample), [*segments_of(near), *rays], NAMED, reach)
        key = [
            (Line2D([], [], color=CIRCLE), _("inflection circle")),
            (Line2D([], [], color=CUBIC), _("cubic of stationary\ncurvature")),
            (Line2D([], [], color=MUTED, linewidth=0.8), _("radii of curvature")),
            *(
                (Line2D([], [], color=SIGN, marker="D", markersize=5.0, linewidth=0.0), f"${symbol}$: {text}")
                for symbol, text in (("W", _("inflection pole")), ("U", _("Ball's point")))
            ),
        ]
        axes.legend(
            *zip(*key, strict=True),
            loc="upper left",
            bbox_to_anchor=(1.01, 1.0),
            borderaxespad=0.0,
            handlelength=2.0,
        )
        title = _("Curvature of the paths of {link}").format(link=plain(str(curvature.attrs["link"])))
        write_title(figure, title, _(mechanism.title))
    return figure


def _circle(pole: Array, end: Array) -> Array:
    """The circle with a diameter between two places."""
    turns = np.linspace(0.0, 2.0 * np.pi, STEPS)
    way = np.stack([np.cos(turns), np.sin(turns)], axis=1)
    return np.asarray(0.5 * (pole + end) + 0.5 * np.hypot(*(end - pole)) * way)


def _cubic(curvature: xarray.Dataset, sample: int, factor: float) -> Array:
    """(x^2 + y^2)(a x + b y) = x y in the pole's axes, by the direction from the pole."""
    a, b = curvature["stationary_cubic"].to_numpy()[sample]
    tangent = float(curvature["pole_tangent"].to_numpy()[sample])
    turns = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 4 * STEPS)
    cosine, sine = np.cos(turns), np.sin(turns)
    slope = a * cosine + b * sine
    with np.errstate(divide="ignore", invalid="ignore"):
        radius = sine * cosine / slope
    beyond = np.abs(np.diff(np.sign(slope), prepend=np.sign(slope[:1]))) > 0
    radius[beyond] = np.nan  # it goes to infinity along its asymptote
    offset = turned(np.stack([radius * cosine, radius * sine]), tangent)
    return np.asarray(factor * (curvature["pole"].to_numpy()[sample] + offset))


def _radii(
    curvature: xarray.Dataset, places: dict[str, Array], factor: float, sample: int
) -> list[tuple[Array, Array]]:
    """From points to the centres of curvature of their paths."""
    found = []
    for name, centre in zip(
        curvature["point"].to_numpy().tolist(), curvature["curvature_centre"].to_numpy()[sample], strict=True
    ):
        if name in places and np.isfinite(centre).all():
            found.append((places[name], factor * centre))
    return found
