"""Centrodes as a picture: the moving one rolls on the fixed one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.locale import _
from centrode.present.curves import write_legend, write_title
from centrode.present.drawing import draw_mechanism
from centrode.present.obstacles import lines
from centrode.present.pictures import caption, initial_sample, label_lengths
from centrode.present.reading import scene_of
from centrode.present.scene import Array, Scene
from centrode.present.shown import plain
from centrode.present.sphere.axes_drawing import whole
from centrode.present.sphere.globe import Globe, globe_of
from centrode.present.sphere.polodes_drawing import draw_polodes
from centrode.present.style import house_style
from centrode.present.tags import Tag, write_tags
from centrode.present.window import carried_by, segments_of, widened, within

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

WIDTH, HEIGHT = 8.2, 5.75  # inches: A5 across
PLACE = (0.085, 0.095, 0.66, 0.775)
FIXED, MOVING, CENTRE = "#0072B2", "#D55E00", "#A00000"
LOOKS = 9  # samples whose curves the window holds
NAMED = 10.0


def centrodes_figure(
    mechanism: Mechanism, motion: xarray.Dataset, centrodes: xarray.Dataset, sample: int | None = None
) -> Figure:
    """Both centrodes with the mechanism at one sample, the initial one if left out.

    Parameters
    ----------
    mechanism : Mechanism
    motion : Dataset
        Without batch dimensions.
    centrodes : Dataset
        Of `centrodes`, of the same motion. What lies further out than the mechanism's extent is cut; the
        sphere is drawn whole.
    """
    with house_style():
        if mechanism.space == "sphere":
            globe = whole(globe_of(mechanism, motion))
            return _on_globe(globe, motion, centrodes, _first(globe, motion, centrodes, sample), names=True)
        scene = _scene(mechanism, motion, centrodes)
        number = _first_with_centre(scene, motion, centrodes) if sample is None else sample
        return _drawn(scene, motion, centrodes, number, names=True)


def _scene(mechanism: Mechanism, motion: xarray.Dataset, centrodes: xarray.Dataset) -> Scene:
    scene = scene_of(mechanism, motion)
    looks = np.unique(np.linspace(0, motion.sizes["sample"] - 1, LOOKS).astype(int))
    places = np.concatenate([curve for look in looks for curve in _curves(scene, centrodes, int(look))])
    return widened(scene, places, (PLACE[2] * WIDTH - 0.3, PLACE[3] * HEIGHT - 0.3))


def _first_with_centre(scene: Scene, motion: xarray.Dataset, centrodes: xarray.Dataset) -> int:
    """The sample nearest to the initial one at which the centre is to be seen."""
    start = initial_sample(scene, motion)
    fixed = scene.factor * centrodes["fixed_centrode"].to_numpy()
    with np.errstate(invalid="ignore"):
        seen = ((fixed >= scene.low) & (fixed <= scene.high)).all(axis=1)
    candidates = np.flatnonzero(seen if seen.any() else np.isfinite(fixed).all(axis=1))
    return int(candidates[np.argmin(np.abs(candidates - start))]) if candidates.size else start


def _first(globe: Globe, motion: xarray.Dataset, centrodes: xarray.Dataset, sample: int | None) -> int:
    """The sample asked for, else the one nearest to the initial one that has an axis."""
    if sample is not None:
        return sample
    start = initial_sample(globe, motion)
    candidates = np.flatnonzero(centrodes["centrode_piece"].to_numpy() >= 0)
    return int(candidates[np.argmin(np.abs(candidates - start))]) if candidates.size else start


def _on_globe(
    globe: Globe, motion: xarray.Dataset, centrodes: xarray.Dataset, sample: int, names: bool
) -> Figure:
    figure = Figure(figsize=(WIDTH, HEIGHT))
    axes = figure.add_axes(PLACE)
    axes.set_title(caption(globe.mechanism, motion, sample))
    handles = draw_polodes(axes, globe, centrodes, sample, names)
    against, link = (plain(str(centrodes.attrs[name])) for name in ("against", "link"))
    texts = [
        _("fixed polode\n(of {name})").format(name=against),
        _("moving polode\n(of {name})").format(name=link),
    ]
    write_legend(axes, list(zip(handles, texts, strict=True)))
    write_title(figure, _("Polodes"), _(globe.mechanism.title))
    return figure


def _drawn(
    scene: Scene, motion: xarray.Dataset, centrodes: xarray.Dataset, sample: int, names: bool
) -> Figure:
    figure = Figure(figsize=(WIDTH, HEIGHT))
    axes = figure.add_axes(PLACE)
    draw_mechanism(axes, scene, sample, names=False)
    label_lengths(axes, scene)
    axes.set_title(caption(scene.mechanism, motion, sample))
    curves = _curves(scene, centrodes, sample)
    pieces = centrodes["centrode_piece"].to_numpy()
    handles = [
        _draw_curve(axes, curve, pieces, colour)
        for curve, colour in zip(curves, (FIXED, MOVING), strict=True)
    ]
    tags = [Tag(place, plain(name)) for name, place in scene.at(sample).items()] if names else []
    place = curves[0][sample]
    if np.isfinite(place).all() and within(axes, place):
        axes.plot(*place, marker="D", markersize=5.0, color=CENTRE, markeredgecolor="white", zorder=9.5)
        tags += [Tag(place, _("centre"))] if names else []
    reach = 72 * scene.sign * scene.inches / scene.extent
    inside = [np.where(_near(scene, curve)[:, None], curve, np.nan) for curve in curves]
    write_tags(axes, tags, lines(scene, sample), segments_of(inside), NAMED, reach)
    against, link = (plain(str(centrodes.attrs[name])) for name in ("against", "link"))
    texts = [
        _("fixed centrode\n(of {name})").format(name=against),
        _("moving centrode\n(of {name})").format(name=link),
    ]
    write_legend(axes, list(zip(handles, texts, strict=True)))
    write_title(figure, _("Centrodes"), _(scene.mechanism.title))
    return figure


def _curves(scene: Scene, centrodes: xarray.Dataset, sample: int) -> tuple[Array, Array]:
    """Fixed and moving centrode, laid where their bodies are at a sample."""
    fixed, moving = (centrodes[name].to_numpy() for name in ("fixed_centrode", "moving_centrode"))
    bodies = [str(centrodes.attrs[name]) for name in ("against", "link")]
    return carried_by(scene, bodies[0], fixed, sample), carried_by(scene, bodies[1], moving, sample)


def _near(scene: Scene, curve: Array) -> Array:
    with np.errstate(invalid="ignore"):
        return np.asarray(((curve >= scene.low) & (curve <= scene.high)).all(axis=1))


def _draw_curve(axes: Axes, curve: Array, pieces: Array, colour: str) -> Line2D:
    """A curve piece by piece, so that nothing joins where it goes to infinity."""
    for piece in np.unique(pieces[pieces >= 0]):
        own = curve[pieces == piece]
        dot: dict[str, Any] = {"marker": "o", "markersize": 2.5} if len(own) == 1 else {}
        axes.plot(
            own[:, 0], own[:, 1], color=colour, linewidth=1.6, zorder=7.2, scalex=False, scaley=False, **dot
        )
    return Line2D([], [], color=colour, linewidth=1.6)
