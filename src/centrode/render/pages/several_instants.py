"""A mechanism at several instants in one drawing: instant centres, velocities, accelerations, senses of rotation."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.model.settings import shown_as
from centrode.numerics.round_scales import round_scale
from centrode.quantities import spelled_unit
from centrode.render.drawing.figure_room import screen_width
from centrode.render.drawing.linkage import draw_bodies, draw_drive, draw_hinges, draw_links
from centrode.render.drawing.style import INK, LEAST_POINTS, NAME, SMALL, TITLE, pens
from centrode.render.drawing.tags import lines
from centrode.render.drawing.texts import plain
from centrode.render.figures.files import AS_WRITTEN
from centrode.render.figures.linkages import caption
from centrode.render.pages.instants import SIGN, draw_centres, draw_senses, draw_velocities
from centrode.render.pages.page import Array, Page, PageView, arrow, flat, new_page, symbol, typeset
from centrode.render.pages.screens import screen_millimetres, size_on_screen
from centrode.render.spelling import PrintSpelling
from centrode.scenes.linkage import scene_of
from centrode.scenes.places import SIGN_INCHES, LinkageScene

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.pages import InstantPage, InstantsPage, MovingPoint

PAPER = 238.0, 170.0
"""Width and height of the page [mm]."""
CORNER, SIZE = np.array([6.0, 22.0]), np.array([148.0, 130.0])
COLUMN, TOP = 162.0, 160.0
LONGEST = 20.0
"""Most that a vector is long [mm]."""
FOOT = 16.0
"""Where the lines below the drawing begin [mm]."""
LINE, COLUMNS = 3.8, 51
"""From line to line of the column [mm], and letters in a line of it."""
LETTER = 1.45
"""Width of a small letter [mm]."""
FADED = 0.5
"""How opaque the positions before the last are."""
OF_ACCELERATIONS: Any = (0, (4, 1.5))
"""Dashes of accelerations."""


def drawing_end() -> tuple[float, float]:
    """Where the drawing ends: at the column, or with the screen; below the head [mm]."""
    return min(COLUMN, screen_millimetres()), TOP - 6.0


def instants_figure(sheet: InstantsPage, display: Display) -> Figure:
    """A page: the positions over each other, names of later ones with primes; scales are true on paper."""
    spelling = PrintSpelling(display)
    mechanism = sheet.mechanism
    page = new_page(PAPER)
    factor, unit = shown_as("m", display)
    per_speed = _scale_of([one.velocities for one in sheet.instants])
    per_rate = _scale_of(sheet.accelerations)
    scenes, view = _placed_scenes(sheet, factor)
    axes, colours = view.axes(page), pens(mechanism.link_names)
    last = len(scenes) - 1
    for number, scene in enumerate(scenes):
        if number < last:
            draw_links(axes, scene, 0, colours, alpha=FADED)
            draw_hinges(axes, scene, 0, colours)
        else:
            draw_bodies(axes, scene, 0, colours)
            draw_drive(axes, scene, 0)
        page.avoid((view.mm(a), view.mm(b)) for a, b in lines(scene, 0))
    for number, (scene, one) in enumerate(zip(scenes, sheet.instants, strict=True)):
        mark = "′" * number
        draw_velocities(page, view, one, factor, per_speed, mark)
        _draw_accelerations(page, view, sheet.accelerations[number], factor, per_rate, mark)
        draw_centres(page, view, _with_new_centres(sheet.instants, number), factor, colours, mark)
        draw_senses(page, view, scene, one, colours)
        for name, place in scene.at(0).items():
            fixed = name in mechanism.frame.points
            if not (fixed and number):
                page.name(view.mm(place), plain(name if fixed else name + mark), clear=SIGN + 0.6, size=9.0)
    units = [shown_as(one, display) for one in ("m/s", "m/s^2")]
    scales = ((r"\mu_l", view.scale, unit), (r"\mu_v", units[0][0] * per_speed, units[0][1]),
              (r"\mu_a", units[1][0] * per_rate, units[1][1]))  # fmt: skip
    _write_foot(
        page,
        sheet,
        [f"${letter}$ = {size:g} {spelled_unit(one)} " + _("per mm") for letter, size, one in scales],
    )
    page.write(CORNER[0], TOP, spelling.text(sheet.title), size=TITLE, va="bottom")
    page.write(COLUMN, TOP, plain(_(mechanism.title))[:60], size=SMALL, va="bottom", label=AS_WRITTEN)
    page.write_lines(
        COLUMN, TOP - 8.0, [spelling.text(one) for one in sheet.lines], letters=COLUMNS, step=LINE,
        size=LEAST_POINTS, indent=4, spelled=typeset,
    )  # fmt: skip
    page.place_names(np.array([[1.0, FOOT + 2.0], [drawing_end()[0] - 1.0, drawing_end()[1]]]))
    return page.figure


def _scale_of(points: Sequence[Sequence[MovingPoint]]) -> float:
    """What a millimetre of the vectors stands for, in SI."""
    return round_scale(max((abs(one.rate) for some in points for one in some), default=0.0), LONGEST)


def _placed_scenes(sheet: InstantsPage, factor: float) -> tuple[list[LinkageScene], PageView]:
    """The scenes with signs as large as on the page, and a view of all but the instant centres that do not fit."""
    course = sheet.instants[0].course.drop_dims("event", errors="ignore")
    now = [scene_of(sheet.mechanism, one.instant) for one in sheet.instants]
    whole = [
        scene_of(
            sheet.mechanism,
            xarray.concat(
                [one.instant.drop_dims("event", errors="ignore"), course], dim="sample", data_vars="minimal"
            ),
        )
        for one in sheet.instants
    ]
    chosen = np.vstack([corner for scene in now for corner in (scene.low, scene.high)])
    size = size_on_screen(SIZE, COLUMN - SIZE[0])
    scale = round_scale(float(np.max(np.ptp(chosen, axis=0) / (size - 2.0 * LONGEST))))
    middle = (chosen.min(axis=0) + chosen.max(axis=0)) / 2
    centres = [flat([factor * centre.place])[0] for one in sheet.instants for centre in one.centres]
    around = np.vstack([chosen - scale * LONGEST, chosen + scale * LONGEST])
    for centre in sorted(centres, key=lambda at: float(np.abs(at - middle).max())):
        more = np.vstack([around, centre])
        if (np.ptp(more, axis=0) / scale > size).any():
            break
        around = more
    extent = float(np.max(np.ptp(chosen, axis=0)))
    inches = SIGN_INCHES * extent / (SIGN * scale)
    low, high = chosen.min(axis=0), chosen.max(axis=0)
    scenes = [replace(scene, low=low, high=high, inches=inches) for scene in whole]
    return scenes, PageView.about(CORNER, size, around, scale)


def _with_new_centres(instants: Sequence[InstantPage], number: int) -> InstantPage:
    """An instant without the centres that stand where earlier instants have them: those of fixed hinges."""
    one = instants[number]
    before = {(centre.link, centre.place) for other in instants[:number] for centre in other.centres}
    kept = tuple(centre for centre in one.centres if (centre.link, centre.place) not in before)
    return replace(one, centres=kept)


def _draw_accelerations(
    page: Page, view: PageView, points: Sequence[MovingPoint], factor: float, per_mm: float, mark: str
) -> None:
    """Accelerations of the moving points as dashed arrows, a millimetre standing for `per_mm` [m/s^2]."""
    for one in points:
        start: Array = view.mm(flat([factor * one.place])[0])
        end = start + flat([one.rate / per_mm])[0]
        if np.hypot(*(end - start)) < 1.0:
            continue
        arrow(page, start, end, INK, OF_ACCELERATIONS, 0.8)
        page.name(end, symbol("a", one.point + mark), clear=0.8, size=7.5)


def _write_foot(page: Page, sheet: InstantsPage, scales: Sequence[str]) -> None:
    """Below the drawing which marks belong to which instant, what lines mean, and the scales."""
    first = next(iter(sheet.mechanism.moving_points), "")
    shown = [
        f"{plain(first)}{'′' * number}: {caption(sheet.mechanism, one.instant, 0)}"
        for number, one in enumerate(sheet.instants)
    ]
    meaning = _("velocities in full lines, accelerations dashed")
    if screen_width() is not None:  # as wide as the drawing
        room = int((screen_millimetres() - 2.0 * CORNER[0]) / LETTER)
        text = "\n".join(textwrap.fill(";   ".join(line), room) for line in (shown, scales, [meaning]))
        page.write(CORNER[0], FOOT + LINE, text, size=LEAST_POINTS, va="top", linespacing=1.1)
        return
    page.write(CORNER[0], FOOT, ";   ".join(shown), size=NAME, va="top")
    page.write(CORNER[0], FOOT - 1.2 * LINE, ";   ".join(scales), size=NAME, va="top")
    page.write(CORNER[0], FOOT - 2.4 * LINE, meaning, size=SMALL, va="top")
