"""Polodes on the sphere, laid where their bodies are: the moving one rolls on the fixed one."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from centrode.locale import _
from centrode.model.values import unit_vector
from centrode.present.sphere.axes_drawing import CENTRE, NAMED, arcs_on_paper, draw_bodies, name_points
from centrode.present.sphere.globe import Array, Globe
from centrode.present.sphere.globe_drawing import draw_line
from centrode.present.tags import Tag, write_tags

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Guide

FIXED, MOVING = "#0072B2", "#D55E00"


def draw_polodes(
    axes: Axes, globe: Globe, centrodes: xarray.Dataset, sample: int, names: bool
) -> list[Line2D]:
    """Draw both polodes with the mechanism at one sample; returns the lines for a key, the fixed one first."""
    draw_bodies(axes, globe, sample)
    pieces = centrodes["centrode_piece"].to_numpy()
    handles = []
    for name, body, colour in (("fixed", "against", FIXED), ("moving", "link", MOVING)):
        curve = laid(globe, str(centrodes.attrs[body]), centrodes[f"{name}_centrode"].to_numpy(), sample)
        for piece in np.unique(pieces[pieces >= 0]) if curve is not None else ():
            own = curve[pieces == piece]  # type: ignore[index]
            draw_line(axes, globe, own, colour, 1.6, zorder=7.2)
        handles.append(Line2D([], [], color=colour, linewidth=1.6))
    tags = name_points(globe, sample) if names else []
    pole = laid(globe, str(centrodes.attrs["against"]), centrodes["fixed_centrode"].to_numpy(), sample)
    if pole is not None and np.isfinite(pole[sample]).all():
        flat = globe.flat(pole[sample])
        axes.plot(*flat, marker="D", markersize=5.0, color=CENTRE, markeredgecolor="white", zorder=9.5,
                  alpha=1.0 if globe.in_front(pole[sample]) else 0.45)  # fmt: skip
        tags += [Tag(flat, _("axis"))] if names else []
    reach = 72 * globe.sign * globe.inches / globe.extent
    write_tags(axes, tags, arcs_on_paper(globe, sample), [], NAMED, reach)
    return handles


def laid(globe: Globe, body: str, curve: Array, sample: int) -> Array | None:
    """A curve in the axes of a body (samples, 3) as it lies at a sample; nothing where the body has no position."""
    guide = slider_guide(globe, body)
    if guide is None:
        return globe.carried(body, curve, sample)
    pole = guide.pole
    if isinstance(pole, str):
        pole = globe.mechanism.points_of(guide.on)[pole]
    inside = unit_vector(pole)  # type: ignore[arg-type]
    longitude, latitude = pole  # type: ignore[misc]
    north = np.array(unit_vector((longitude, latitude + np.pi / 2)))
    frame = globe.carried(guide.on, np.eye(3), sample)
    if frame is None:
        return None
    point = frame @ globe.tracks[guide.point][sample]
    angle = np.arctan2(point @ np.cross(inside, north), point @ north)
    axis = np.array(inside)
    turned = (
        np.cos(angle) * curve
        + np.sin(angle) * np.cross(axis, curve)
        + (1.0 - np.cos(angle)) * (curve @ axis)[:, None] * axis
    )
    return globe.carried(guide.on, turned, sample)


def slider_guide(globe: Globe, body: str) -> Guide | None:
    """The guide of a slider by the slider's name; none of a link or the frame."""
    if body == "frame" or body in globe.mechanism.links:
        return None
    return next(guide for guide in globe.mechanism.guides if body.startswith(f"slider {guide.id}"))
