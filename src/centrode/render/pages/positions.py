"""Numbered positions of a mechanism over each other on a page, with the paths of its points."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import xarray
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.numerics.round_scales import round_scale
from centrode.quantities import spelled_unit
from centrode.render.drawing.linkage import draw_bodies, draw_links
from centrode.render.drawing.style import INK, LEAST_POINTS, MUTED, NAME, SMALL, TITLE, pens
from centrode.render.drawing.tags import lines
from centrode.render.drawing.texts import plain
from centrode.render.figures.files import AS_WRITTEN
from centrode.render.figures.linkages import instant_text
from centrode.render.pages.page import Page, PageView, new_page, typeset
from centrode.render.pages.screens import screen_millimetres, size_on_screen, write_scale_bars
from centrode.render.spelling import FigureSpelling
from centrode.scenes.linkage import scene_of
from centrode.scenes.places import SIGN_INCHES, LinkageScene

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.pages import PositionsPage

CORNER, SIZE = np.array([6.0, 6.0]), np.array([150.0, 128.0])
COLUMN, TOP, LINE = 160.0, 140.0, 3.4
SIGN = 0.9
"""Radius of a hinge's circle [mm]."""


def drawing_end() -> tuple[float, float]:
    """Where the drawing ends: at the column, or with the screen; below the title and what stands under it [mm]."""
    return min(COLUMN, screen_millimetres()), TOP - 6.0


def positions_figure(sheet: PositionsPage, display: Display) -> Figure:
    """A page A5 across: position 0 in full, the others faint, all of them numbered along some paths.

    The scale is true on paper.
    """
    mechanism, spelling = sheet.mechanism, FigureSpelling(display)
    page = new_page()
    together = [data.drop_dims("event", errors="ignore") for data in (sheet.positions, sheet.path)]
    joined = xarray.concat(together, dim="sample", data_vars="minimal")
    scene = scene_of(mechanism, joined)
    _factor, unit = shown_as("m", display)
    size = size_on_screen(SIZE, COLUMN - SIZE[0])
    scale = round_scale(float(np.max((scene.high - scene.low) / size)), 0.86)
    view = PageView.about(CORNER, size, np.array([scene.low, scene.high]), scale)
    scene = replace(scene, inches=SIGN_INCHES * scene.extent / (SIGN * scale))
    count = sheet.positions.sizes["sample"]
    draw_positions(page, view, scene, count)
    draw_paths(page, view, scene, count)
    for name in sheet.numbered:
        number_path(page, view, scene, name, count)
    for name, place in scene.at(0).items():
        page.name(view.mm(place), plain(name), clear=SIGN + 0.6, size=9.0)
    page.write(6.0, TOP, spelling.text(sheet.title), size=TITLE, va="bottom")
    page.write(6.0, TOP - 5.0, plain(_(mechanism.title))[:90], size=SMALL, va="bottom", label=AS_WRITTEN)
    scale_text = f"μ_l = {scale:g} {spelled_unit(unit)} " + _("per mm")
    write_column(page, sheet, spelling.text(sheet.note), scale_text)
    page.place_names(np.array([[1.0, 1.0], [drawing_end()[0] - 1.0, TOP - 7.0]]))
    write_scale_bars(page, CORNER[0], [(scale, unit)])
    return page.figure


def draw_positions(page: Page, view: PageView, scene: LinkageScene, count: int) -> None:
    """All positions, the first over the others."""
    axes = view.axes(page)
    colours = pens(scene.mechanism.link_names)
    for sample in range(count - 1, 0, -1):
        draw_links(axes, scene, sample, colours, alpha=0.22)
    draw_bodies(axes, scene, 0, colours)
    page.avoid((view.mm(a), view.mm(b)) for a, b in lines(scene, 0))


def draw_paths(page: Page, view: PageView, scene: LinkageScene, count: int) -> None:
    """Paths of the moving points, thin."""
    for name in scene.mechanism.moving_points:
        path = np.array([view.mm(place) for place in scene.tracks[name][count:]])
        page.overlay.plot(path[:, 0], path[:, 1], color=MUTED, linewidth=0.7, zorder=2.5)


def number_path(page: Page, view: PageView, scene: LinkageScene, name: str, count: int) -> None:
    """Numbers of the positions beside a point's places, with a dot at each."""
    for sample in range(count):
        place = scene.tracks[name][sample]
        if not np.isfinite(place).all():
            continue
        at = view.mm(place)
        page.overlay.plot([at[0]], [at[1]], marker="o", markersize=2.2, color=INK, zorder=6.5)
        page.name(at, str(sample), clear=0.9, size=LEAST_POINTS)


def write_column(page: Page, sheet: PositionsPage, note: str, scale: str) -> None:
    """Scale, note and list of the positions at the right."""
    y = TOP - 6.0
    page.write(COLUMN, y, typeset(scale), size=NAME, va="top")
    y -= 2 * LINE
    if note:
        page.write(COLUMN, y, note, size=SMALL, va="top")
        y -= LINE
    count = sheet.positions.sizes["sample"]
    step = min(LINE, (y - 6.0) / count)
    for sample in range(count):
        value = instant_text(sheet.mechanism, sheet.positions, sample)
        page.write(COLUMN, y, f"{sample}:  {value}", size=LEAST_POINTS, va="top")
        y -= step
