"""A mechanism at one instant as a drawing to scale: links, frame, wheels, cams, paths, centrodes, a title."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from centrode.errors import NotComputedYet
from centrode.locale import _, decimal_mark
from centrode.model.labels import place_words
from centrode.quantities import spelled_unit
from centrode.render.drafting.board import CAPITAL, Board, BoardWords, Drawing, Stroke, on_paper
from centrode.render.drafting.scales import DrawingScale
from centrode.render.drawing.cams import draw_axes_of_cams, draw_turned_cams
from centrode.render.drawing.linkage import draw_drive, draw_frame, draw_hinges, draw_links, draw_names
from centrode.render.drawing.style import pens
from centrode.render.drawing.window import carried_by
from centrode.scenes.linkage import scene_of

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism
    from centrode.scenes.places import LinkageScene

METRE = 1000.0
"""Millimetres."""
FULL_SIZE = DrawingScale(1.0, 1.0)
TITLE = 12.0
"""Size of the title's letters, in points of the names' paper."""
FARTHEST = 1.0
"""How far from the middle of the drawing centrodes are drawn, in its sizes."""
DOUBLE = 1e-6
"""Lines whose ends are nearer than this share of them are one."""
LINE = 1.8
"""Height of a line of the title, in heights of its letters."""


def mechanism_drawing(
    mechanism: Mechanism,
    motion: xarray.Dataset,
    sample: int = 0,
    paths: Sequence[str] = (),
    centrodes: Sequence[xarray.Dataset] = (),
    names: bool = True,
    course: xarray.Dataset | None = None,
    unit_name: Callable[[str], str] = spelled_unit,
    scale: DrawingScale = FULL_SIZE,
) -> Drawing:
    """A mechanism at a sample of its motion in millimetres, at full size unless a scale is given.

    Parameters
    ----------
    mechanism, motion : as elsewhere
        In the plane.
    sample : int
        The instant that is drawn.
    paths : points whose paths over the motion are drawn
    centrodes : results of `centrodes` that are drawn, the moving one where its link is at the instant
    names : write the points' names
    course : the motion that the paths belong to, where it is not `motion`
    unit_name : how units are spelled: as readers print them, `str` for the names that files of data keep
    scale : size on paper to size in reality

    Raises
    ------
    NotComputedYet
        Spherical linkages.
    """
    if mechanism.space == "sphere":
        what = _("drawings at full size are made of planar mechanisms")
        raise NotComputedYet("space", what, _("use the pictures of centrode run"))
    scene = scene_of(mechanism, motion)
    metre = METRE * scale.ratio
    board: Any = Board(metre / scene.factor)
    board.letters = on_paper(scene.extent, scene.inches, board.scale)
    links = pens(mechanism.link_names)
    with board.on("frame"):
        draw_frame(board, scene, sample)
        draw_axes_of_cams(board, scene)
    with board.on("cams"):
        draw_turned_cams(board, scene, sample)
    with board.on("links"):
        draw_links(board, scene, sample, links)
    with board.on("hinges"):
        draw_hinges(board, scene, sample, links)
    with board.on("drive"):
        draw_drive(board, scene, sample)
    if names:
        with board.on("names"):
            draw_names(board, scene, sample)
    drawing: Drawing = board.drawing
    drawing.strokes = [one for one in drawing.strokes if one.layer != "cams" or not _has_double(one, drawing)]
    whole = motion if course is None else course
    for name in paths:
        drawing.strokes.append(Stroke("paths", metre * whole["position"].sel(point=name).values))
    for pair in centrodes:
        drawing.strokes += _centrode(scene, pair, sample, board.scale)
    _title(
        drawing,
        scene,
        place_words(mechanism, motion, sample, unit_name),
        CAPITAL * TITLE * board.letters,
        scale,
    )
    return drawing


def _has_double(line: Stroke, drawing: Drawing) -> bool:
    """Whether a link has the same straight line: the arm that carries the roller."""
    if len(line.places) != 2:
        return False
    room = DOUBLE * float(np.ptp(line.places, axis=0).max())
    for link in (one.places for one in drawing.strokes if one.layer == "links"):
        for ends in (line.places, line.places[::-1]):
            apart = np.maximum(np.abs(link[:-1] - ends[0]), np.abs(link[1:] - ends[1])).max(axis=1)
            if (apart <= room).any():
                return True
    return False


def _centrode(scene: LinkageScene, pair: xarray.Dataset, sample: int, scale: float) -> list[Stroke]:
    """Both curves where they are at the instant, each piece a stroke; what runs off to infinity is cut."""
    reach = FARTHEST * scene.extent
    found = []
    for name, body in (("fixed_centrode", "against"), ("moving_centrode", "link")):
        places = carried_by(scene, str(pair.attrs[body]), pair[name].values, sample)
        number = pair["centrode_piece"].values
        near = (np.abs(places - 0.5 * (scene.low + scene.high)) <= reach).all(axis=1)
        for piece in np.unique(number[number >= 0]):
            kept = np.where(((number == piece) & near)[:, None], places, np.nan)
            found.append(Stroke("centrodes", scale * kept))
    return found


def _title(drawing: Drawing, scene: LinkageScene, place: str, height: float, scale: DrawingScale) -> None:
    """The title below the drawing: what it is, where the drive is, scale and unit."""
    low, _high = drawing.box()
    lines = [
        _(scene.mechanism.title),
        place,
        _("scale {ratio}, millimetres").format(ratio=scale.text.replace(".", decimal_mark())),
    ]
    for number, text in enumerate(line for line in lines if line):
        corner = float(low[0]), float(low[1]) - LINE * height * (number + 1.5)
        drawing.words.append(BoardWords("title", text, corner, height, left=True))
