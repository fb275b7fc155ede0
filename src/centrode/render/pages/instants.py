"""The mechanism of an instant drawn to scale: instant centres, velocities of its points, senses of rotation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
import xarray
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.numerics.round_scales import round_scale
from centrode.quantities import spelled_unit
from centrode.render.drawing import signs
from centrode.render.drawing.linkage import draw_bodies, draw_drive
from centrode.render.drawing.style import INK, MUTED, Pen, pens
from centrode.render.drawing.tags import lines
from centrode.render.drawing.texts import plain
from centrode.render.figures.linkages import caption
from centrode.render.pages.page import (
    BESIDE,
    COLUMN,
    CORNER,
    NAMES,
    SIZE,
    TOP,
    Array,
    Page,
    PageView,
    arrow,
    flat,
    new_page,
    symbol,
    write_head,
)
from centrode.render.pages.screens import (
    scale_on_screen,
    screen_millimetres,
    size_on_screen,
    write_scale_bars,
)
from centrode.render.spelling import PrintSpelling
from centrode.scenes.linkage import scene_of
from centrode.scenes.places import SIGN_INCHES, LinkageScene

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.pages import InstantPage

SIGN = 1.1
"""Radius of a hinge's circle [mm]."""
LONGEST = 18.0
"""Most that a vector of velocity is long [mm]."""
ARC = 3.2
"""Radius of an arc that shows a sense of rotation [mm]."""


def drawing_end() -> tuple[float, float]:
    """Where the drawing of a page of an instant ends: at the column, or with the screen; below the head [mm]."""
    return min(COLUMN, screen_millimetres()), TOP


def instant_figure(sheet: InstantPage, display: Display) -> Figure:
    """A page A5 across: the mechanism at its scale, which is true on paper, with what its velocities say."""
    spelling = PrintSpelling(display)
    page = new_page()
    factor, unit = shown_as("m", display)
    greatest = max((abs(one.rate) for one in sheet.velocities), default=0.0)
    per_mm = max(round_scale(greatest, LONGEST), sheet.finest)
    scene, view = placed_scene(sheet, factor, per_mm)
    axes = view.axes(page)
    colours = pens(sheet.mechanism.link_names)
    draw_bodies(axes, scene, 0, colours)
    draw_drive(axes, scene, 0)
    page.avoid((view.mm(a), view.mm(b)) for a, b in lines(scene, 0))
    draw_velocities(page, view, sheet, factor, per_mm)
    draw_centres(page, view, sheet, factor, colours)
    draw_senses(page, view, scene, sheet, colours)
    for name, place in scene.at(0).items():
        page.name(view.mm(place), plain(name), clear=SIGN + 0.6, size=9.0)
    speed_factor, speed_unit = shown_as("m/s", display)
    head = [
        caption(sheet.mechanism, sheet.instant, 0),
        f"μ_l = {view.scale:g} {spelled_unit(unit)} " + _("per mm"),
        f"μ_v = {speed_factor * per_mm:g} {spelled_unit(speed_unit)} " + _("per mm"),
    ]
    listed = [spelling.text(one) for one in sheet.lines]
    write_head(page, spelling.text(sheet.title), sheet.mechanism, head, listed)
    page.place_names(np.array([[1.0, 1.0], [drawing_end()[0] - 1.0, TOP - 3.0]]))
    write_scale_bars(page, CORNER[0], [(view.scale, unit), (speed_factor * per_mm, speed_unit)])
    return page.figure


def placed_scene(sheet: InstantPage, factor: float, per_mm: float) -> tuple[LinkageScene, PageView]:
    """The scene with its signs as large as on the page, and a view of all but the instant centres that do not fit.

    Slots are as long as their pins travel in the whole motion; the view is that of the instant.
    """
    now = scene_of(sheet.mechanism, sheet.instant)
    together = [data.drop_dims("event", errors="ignore") for data in (sheet.instant, sheet.course)]
    whole = scene_of(sheet.mechanism, xarray.concat(together, dim="sample", data_vars="minimal"))
    size = size_on_screen(SIZE, BESIDE)

    def whole_of(scale: float) -> Array:
        tips = [factor * one.place + scale / per_mm * one.rate for one in sheet.velocities]
        return np.vstack([now.low, now.high, flat(tips)]) if tips else np.array([now.low, now.high])

    scale = scale_on_screen(
        factor * sheet.scale, lambda one: bool((np.ptp(whole_of(one), axis=0) / one <= size - NAMES).all())
    )
    chosen = whole_of(scale)
    centres = [flat([factor * centre.place])[0] for centre in sheet.centres]
    for centre in sorted(centres, key=lambda at: float(np.abs(at - (now.low + now.high) / 2).max())):
        more = np.vstack([chosen, centre])
        if ((more.max(axis=0) - more.min(axis=0)) / scale > size - 12.0).any():
            break
        chosen = more
    inches = SIGN_INCHES * now.extent / (SIGN * scale)
    scene = replace(whole, low=now.low, high=now.high, inches=inches)
    return scene, PageView.about(CORNER, size, chosen, scale)


def draw_velocities(
    page: Page, view: PageView, sheet: InstantPage, factor: float, per_mm: float, mark: str = ""
) -> None:
    """Velocities of the moving points as arrows, a millimetre standing for `per_mm` [m/s]; `mark` ends their names."""
    for one in sheet.velocities:
        start = view.mm(flat([factor * one.place])[0])
        end = start + flat([one.rate / per_mm])[0]
        if np.hypot(*(end - start)) < 1.0:
            continue
        arrow(page, start, end, INK, width=1.1)
        page.name(end, symbol("v", one.point + mark), clear=0.8, size=7.5)


def draw_centres(
    page: Page,
    view: PageView,
    sheet: InstantPage,
    factor: float,
    colours: Mapping[str, Pen],
    mark: str = "",
) -> None:
    """Instant centres with the perpendiculars that meet there, of those that lie on the page."""
    names: list[tuple[Array, list[str]]] = []
    for centre in sheet.centres:
        at = view.mm(flat([factor * centre.place])[0])
        if (at < view.corner).any() or (at > view.corner + view.size).any():
            continue
        for point in centre.points:
            place = view.mm(flat([factor * point])[0])
            page.overlay.plot(*np.array([place, at]).T, color=MUTED, linewidth=0.6, linestyle="--", zorder=3)
            page.avoid([(place, at)])
        near = next((known for place, known in names if np.hypot(*(place - at)) < 1.0), None)
        if near is not None:
            near.append(centre.link)
            continue
        names.append((at, [centre.link]))
        signs.cross(page.overlay, at, 1.0, colours[centre.link].colour)
    for at, links in names:
        text = ", ".join(symbol("P", link + mark) for link in links[:4]) + (", …" if len(links) > 4 else "")
        page.name(at, text, clear=1.4, size=7.5)


def draw_senses(
    page: Page, view: PageView, scene: LinkageScene, sheet: InstantPage, colours: Mapping[str, Pen]
) -> None:
    """An arc with a head in the middle of every link that turns."""
    places = scene.at(0)
    for link, forward in sheet.senses.items():
        points = [places[name] for name in sheet.mechanism.links[link].coordinates if name in places]
        if len(points) < 2:
            continue
        middle = view.mm(0.5 * (points[0] + points[1]))
        radius = min(ARC, max(0.5 * ARC, 0.3 * float(np.hypot(*(points[1] - points[0]))) / view.scale))
        angle = float(np.arctan2(*(points[1] - points[0])[::-1])) + np.pi / 2
        arc = angle + np.linspace(-2.2, 2.2, 25) * (1.0 if forward else -1.0)
        path = middle + radius * np.stack([np.cos(arc), np.sin(arc)], axis=1)
        signs.turning_arrow(page.overlay, path, colours[link].colour)
        page.avoid(pairwise(path))
