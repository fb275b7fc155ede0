"""A group taken out of its mechanism, to the scale of lengths, with the forces on it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes

from centrode.render.drawing import signs
from centrode.render.drawing.linkage import draw_body
from centrode.render.drawing.style import GROUND, INK, MUTED, pens
from centrode.render.drawing.texts import plain
from centrode.render.pages.force_signs import force_arrows, moment_arc
from centrode.render.pages.page import Array, Page, PageView, flat
from centrode.scenes.linkage import wheel_at
from centrode.scenes.places import LinkageScene, corners

if TYPE_CHECKING:
    from centrode.sheets.force_pages import GroupPage, GuideSign

RAIL = 14.0
"""Half the length of a guide's line [mm]."""
TINY = 1e-12
"""Moments smaller than this part of the greatest force times length are none."""


def draw_group(page: Page, view: PageView, sheet: GroupPage, scene: LinkageScene) -> None:
    """Links, sliders and hinges of a group, its outer forces and the reactions of its outer joints."""
    axes = view.axes(page)
    sign = 1.1 * page.signs * view.scale
    places = scene.at(0)
    shown = draw_bodies(axes, page, view, scene, sheet, sign)
    for guide in sheet.guides:
        draw_guide(axes, page, view, scene, guide, sign)
    for name in shown:
        if name in sheet.pins:
            signs.hinge(axes, places[name], sign)
        else:
            signs.traced_point(axes, places[name], sign, INK)
        page.name(view.mm(places[name]), plain(name), clear=2.2, size=9.0)
    draw_marks(page, view, sheet, scene.factor)
    draw_forces(page, view, sheet, scene.factor)


def draw_marks(page: Page, view: PageView, sheet: GroupPage, factor: float) -> None:
    """Special points of the construction, if they lie in the view, with the lines on which they lie."""
    for mark in sheet.marks:
        at = view.mm(flat([factor * mark.place])[0])
        if (at < view.corner + 4.0).any() or (at > view.corner + view.size - 4.0).any():
            continue
        signs.cross(page.overlay, at, 1.2 * page.signs, INK)
        page.name(at, mark.name, clear=1.4, size=9.0)
        for hinge in mark.hinges:
            end = view.mm(flat([factor * hinge])[0])
            page.overlay.plot(*np.array([end, at]).T, color=MUTED, linewidth=0.6, linestyle="--", zorder=3)


def draw_bodies(
    axes: Axes,
    page: Page,
    view: PageView,
    scene: LinkageScene,
    sheet: GroupPage,
    sign: float,
) -> list[str]:
    """The links of a group with their numbers; returns the points that belong to them or to its sliders."""
    places, shown = scene.at(0), list[str]()
    colours = pens(scene.mechanism.link_names)
    for number, body in sheet.bodies:
        if body not in scene.mechanism.links:
            continue
        link = scene.mechanism.links[body]
        outline = [places[point] for point in corners(link)]
        draw_body(axes, outline, colours[body], 1.0, body)
        page.avoid((view.mm(a), view.mm(b)) for a, b in zip(outline, outline[1:] + outline[:1], strict=True))
        shown += list(link.coordinates)
        if len(outline) >= 2:
            middle = view.mm((outline[0] + outline[1]) / 2)
            page.name(middle, str(number), clear=1.2, size=9.0, colour=colours[body].colour)
        for wheel in scene.mechanism.rolling:
            disc = wheel_at(scene, wheel, 0) if wheel.link == body else None
            if disc is not None:
                signs.wheel(axes, disc.centre, disc.radius, disc.angle, colours[body].colour, 1.0)
    shown += sheet.hinges
    return list(dict.fromkeys(name for name in shown if name in places))


def draw_guide(
    axes: Axes, page: Page, view: PageView, scene: LinkageScene, drawn: GuideSign, sign: float
) -> None:
    """A guide of the group: its line, and what slides on it."""
    guide = scene.mechanism.guide(drawn.guide)
    place = scene.at(0)[guide.point]
    along = flat([drawn.along])[0]
    rail = RAIL * page.signs * view.scale
    ends = [place - rail * along, place + rail * along]
    if drawn.has_line:
        start = scene.carried_places(guide.on, next(iter(scene.mechanism.points_of(guide.on).values())), 0)
        reach = [*ends, *([] if start is None else [start])]
        ways = [float((end - place) @ along) for end in reach]
        line = [place + min(ways) * along, place + max(ways) * along]
        colour = pens(scene.mechanism.link_names)[guide.on].colour
        if start is not None:
            foot = place + float((start - place) @ along) * along
            axes.plot(*np.array([start, foot]).T, color=colour, linewidth=2.4, zorder=2.9)
        axes.plot(*np.array(line).T, color=colour, linewidth=2.4, zorder=2.9)
    else:
        line = ends
        style = "-" if guide.on == "frame" else "--"
        axes.plot(*np.array(line).T, color=MUTED, linewidth=0.9, linestyle=style, zorder=1.5)
    page.avoid([(view.mm(line[0]), view.mm(line[1]))])
    if drawn.slider is not None:
        turn = float(np.arctan2(along[1], along[0]))
        signs.slider(axes, place, turn, sign, INK if guide.link is None else GROUND)
        page.name(view.mm(place), str(drawn.slider), clear=3.2, size=9.0, colour=GROUND)
        outline = view.mm(signs.slider_outline(place, turn, sign))
        page.avoid(zip(outline, np.roll(outline, -1, axis=0), strict=True))


def draw_forces(page: Page, view: PageView, sheet: GroupPage, factor: float) -> None:
    """Outer forces in black, reactions of outer joints in the colour of their link."""
    colours = {name: pen.colour for name, pen in pens(sheet.mechanism.link_names).items()} | {"": INK}

    def at(place: complex) -> Array:
        return view.mm(flat([factor * place])[0])

    force_arrows(page, [(one.name, one.force, at(one.place), colours[one.link]) for one in sheet.forces])
    greatest = max((abs(one.force) for one in sheet.forces), default=0.0) * view.scale / factor
    for one in sheet.moments:
        if abs(one.moment) > TINY * greatest:
            moment_arc(page, at(one.place), one.moment, one.name, colours[one.link])
