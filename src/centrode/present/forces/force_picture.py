"""The mechanism where a joint force is greatest, to scale, with the forces in its joints to theirs."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure

from centrode.analysis.graphic.stage import round_scale
from centrode.locale import _
from centrode.model.labels import side_name
from centrode.present.cams.driving_drawing import draw_cams
from centrode.present.diagram_drawing import COLUMN, CORNER, SIZE, TOP, arrow, write_head
from centrode.present.drawing import draw_frame, draw_hinges, draw_links
from centrode.present.forces.force_signs import moment_arc
from centrode.present.obstacles import lines
from centrode.present.page import Array, Page, View, new_page
from centrode.present.pictures import caption
from centrode.present.reading import scene_of
from centrode.present.scene import Scene
from centrode.present.sheet import SIGN_INCHES
from centrode.present.shown import plain, shown_as
from centrode.present.style import GROUND, INK, pens

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

SIGN = 1.1
"""Radius of a hinge's circle [mm]."""
LONGEST = 26.0
"""Most that a force is long [mm]."""
SHORTEST = 0.8
"""Forces shorter than this [mm] are left out."""
BODY = float(SIZE[0]) - 2.0 * LONGEST
"""Room of the mechanism between the arrows [mm]."""


def force_page(mechanism: Mechanism, reactions: xarray.Dataset, motion: xarray.Dataset) -> Figure | None:
    """A page of the sample at which a joint force is greatest; nothing where there is none."""
    force = reactions["joint_force"].transpose("sample", "side", "axis").to_numpy()
    size = np.hypot(force[..., 0], force[..., 1])
    if not size.size or not np.nanmax(np.nan_to_num(size)) > 0.0:
        return None
    sample = int(np.unravel_index(np.nanargmax(size), size.shape)[0])
    scene = scene_of(mechanism, motion)
    places = scene.at(sample)
    page, per_mm = new_page(), round_scale(float(np.nanmax(size[sample])), LONGEST)
    scene, view = _placed(scene, sample)
    axes = view.axes(page)
    links = pens(mechanism.link_names)
    draw_frame(axes, scene, sample)
    draw_cams(axes, scene, sample)
    draw_links(axes, scene, sample, links)
    draw_hinges(axes, scene, sample, links)
    page.avoid((view.mm(a), view.mm(b)) for a, b in lines(scene, sample))
    for name, place in places.items():
        page.name(view.mm(place), plain(name), clear=SIGN + 0.6, size=9.0)
    colours = {name: pen.colour for name, pen in links.items()} | {"frame": GROUND}
    bodies, points = reactions["side_link"].to_numpy(), reactions["side_point"].to_numpy()
    for k, label in enumerate(reactions["side"].to_numpy().tolist()):
        if points[k] in places:
            colour = colours[str(bodies[k])]
            _vector(page, view.mm(places[points[k]]), force[sample, k] / per_mm, side_name(label), colour)
    _guides(page, view, reactions.isel(sample=sample), scene, sample, per_mm)
    _moments(page, view, mechanism, reactions.isel(sample=sample), places)
    unit = shown_as("m", mechanism.display)[1]
    head = [
        caption(mechanism, motion, sample),
        f"μ_l = {view.scale:g} {unit} " + _("per mm"),
        f"μ_F = {per_mm:g} N " + _("per mm"),
    ]
    write_head(
        page, _("Forces of the pins on the links"), mechanism, head, _list(reactions.isel(sample=sample))
    )
    page.place_names(np.array([[1.0, 1.0], [COLUMN - 1.0, TOP - 3.0]]))
    return page.figure


def _placed(scene: Scene, sample: int) -> tuple[Scene, View]:
    """The scene with signs as large as on the page, and a view of the sample with room for arrows around it."""
    spots = [np.array(list(scene.at(sample).values()))]
    for guide in scene.mechanism.guides:
        ends = scene.guide_line(guide, sample) if guide.on == "frame" else None
        spots += [] if ends is None else [np.array(ends)]
    around = np.vstack(spots)
    extent = float(np.max(np.ptp(around, axis=0))) or 1.0
    scale = round_scale(extent, BODY)
    inches = SIGN_INCHES * scene.extent / (SIGN * scale)
    return replace(scene, inches=inches), View.about(CORNER, SIZE, around, scale)


def _vector(page: Page, start: Array, along: Array, label: str, colour: str) -> None:
    """A force to scale from where it acts."""
    if not np.isfinite(along).all() or np.hypot(*along) < SHORTEST:
        return
    arrow(page, start, start + along, colour, width=1.3)
    page.name(start + along, plain(label), clear=0.8, size=7.5, colour=colour)


def _guides(page: Page, view: View, here: xarray.Dataset, scene: Scene, sample: int, per_mm: float) -> None:
    if "guide_force" not in here:
        return
    places = scene.at(sample)
    for guide in scene.mechanism.guides:
        force = here["guide_force"].sel(guide=guide.id).to_numpy()
        if guide.point in places:
            label = _("guide {name}").format(name=guide.id)
            _vector(page, view.mm(places[guide.point]), force / per_mm, label, INK)


def _moments(
    page: Page, view: View, mechanism: Mechanism, here: xarray.Dataset, places: dict[str, Array]
) -> None:
    """What a drive gives, as an arc about the first point of its link."""
    for drive in mechanism.drives:
        value = float(here["balancing"].sel(drive=drive.id))
        if drive.kind != "angle" or drive.link is None or not np.isfinite(value) or value == 0.0:
            continue
        first = next(iter(mechanism.links[drive.link].coordinates))
        if first in places:
            moment_arc(page, view.mm(places[first]), value, "Mb")


def _list(here: xarray.Dataset) -> list[str]:
    """Magnitude and direction of every force, and what the drives give."""
    found = []
    named = list(
        zip(
            map(side_name, here["side"].to_numpy().tolist()),
            here["joint_force"].transpose("side", "axis").to_numpy(),
            strict=True,
        )
    )
    if "guide_force" in here:
        words = [_("guide {name}").format(name=name) for name in here["guide"].to_numpy().tolist()]
        named += list(zip(words, here["guide_force"].transpose("guide", "axis").to_numpy(), strict=True))
    for name, (x, y) in named:
        text = f"{np.hypot(x, y):.5g} N, {np.degrees(np.arctan2(y, x)):.1f}°".replace("-", "−")
        told = text if np.isfinite(x) else _("not determined")
        found.append(f"{plain(name)}: {told}")
    units = str(here["balancing"].attrs["units"]).split(", ")
    for k, name in enumerate(here["drive"].to_numpy().tolist()):
        value = float(here["balancing"].to_numpy()[k])
        text = f"{value:.5g} {units[k % len(units)]}".replace("-", "−")
        found.append(_("drive {name} gives").format(name=plain(name)) + " " + text)
    return found
