"""Make the gallery: a small picture of every built-in mechanism, pair and train of gears, and the page.

    python -m tools.gallery [NAME ...]

The pictures go to docs/images/gallery; `make reference` makes the page that shows them.
"""

from __future__ import annotations

import io
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

import centrode as ct
from centrode.animation.animate import animate
from centrode.animation.gears import MeshLayer
from centrode.animation.video_files import Pace
from centrode.gears.profiles import wheel_outline
from centrode.render.drawing.style import PALETTE
from centrode.render.figures.linkages import draw, initial_sample, read_scene
from centrode.scenes.sphere import Globe
from centrode.sheets.outlines import DrawnLines
from centrode.views.gear_train import wheels_drawing
from tools import exchange_gallery, synthesis_gallery

DOCS = Path(__file__).parents[1] / "docs"
FOLDER = DOCS / "images" / "gallery"
INCHES, DOTS, COLOURS = 3.0, 120, 48
COLUMNS = 3
PATH = "#9BB8D3"
HEAD = """# Gallery

All built-in mechanisms, each with the paths of its points; `centrode run NAME` computes it, `centrode examples NAME`
prints its description. Made by `python -m tools.gallery`.
"""
HEAD_OF_GEARS = """## Gears

Pairs (`centrode gears NAME`) with their contacts on the line of action, pitch circles of trains
(`centrode trains NAME`).
"""
GEARS = ("gear pair", "gear train")
MOVING = ("catapult", "door-closer")
"""What a simulation moves in a way that a picture does not show: animations."""
FRAMES, SIZE = 24, "320x320"
ELSEWHERE = {"vibrating-screen": "images/vibrating-screen-mode.gif"}
"""What moves too little to be seen, by its modes."""


def picture(name: str) -> bytes:
    """A mechanism in its initial position as a small PNG."""
    mechanism = ct.example(name)
    assert isinstance(mechanism, ct.Mechanism)
    motion = ct.motion(mechanism)
    scene = read_scene(mechanism, motion)
    figure = Figure(figsize=(INCHES, INCHES))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    draw(axes, scene, initial_sample(scene, motion), names=False)
    axes.set_axis_off()
    for point in mechanism.moving_points:
        path = scene.tracks[point]
        if isinstance(scene, Globe):
            path = np.where(scene.in_front(path)[:, None], scene.flat(path), np.nan)
        axes.plot(path[:, 0], path[:, 1], color=PATH, linewidth=1.0, zorder=1.5)
    return _small(figure)


def picture_of_gears(name: str) -> bytes:
    """Teeth of a pair in mesh, or pitch circles of a train, as a small PNG."""
    figure = Figure(figsize=(INCHES, INCHES))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    if name in ct.example_names("gear pair"):
        results = ct.gear_pair(name)
        layer = MeshLayer(results.geometry, [wheel_outline(profile) for profile in results.profiles], 1, 1.0)
        (left, low), (right, high) = layer.reach()
        layer.ground(axes)
        layer.draw(axes, 0)
        axes.set_xlim(left, right)
        axes.set_ylim((low + high) / 2 - (right - left) / 2, (low + high) / 2 + (right - left) / 2)
    else:
        drawing = wheels_drawing(ct.gear_train(name))
        for piece in drawing.pieces:
            axes.plot(*piece.places.T, color=PALETTE[piece.layer != "profile"], linewidth=1.4)
        for shape in drawing.shapes:
            for line in shape.lines if isinstance(shape, DrawnLines) else ():
                axes.plot(*line.T, color=PATH, linewidth=1.0)
        axes.set_aspect("equal")
    axes.set_axis_off()
    return _small(figure)


def _small(figure: Figure) -> bytes:
    """A figure as a PNG of few colours."""
    drawn, kept = io.BytesIO(), io.BytesIO()
    figure.savefig(drawn, format="png", dpi=DOTS)
    drawn.seek(0)
    Image.open(drawn).convert("RGB").quantize(COLOURS).save(kept, format="png", optimize=True)
    return kept.getvalue()


def page() -> str:
    """The page: pictures side by side, each with its title and its name."""
    linkages = _table(ct.example_names("linkage"))
    gears = _table([name for kind in GEARS for name in ct.example_names(kind)])
    return f"{HEAD}\n{linkages}\n{HEAD_OF_GEARS}\n{gears}\n{synthesis_gallery.section()}\n{exchange_gallery.section()}"


def _table(names: Sequence[str]) -> str:
    rows = []
    for start in range(0, len(names), COLUMNS):
        cells = [_cell(name) for name in names[start : start + COLUMNS]]
        rows.append("| " + " | ".join(cells + [""] * (COLUMNS - len(cells))) + " |")
    heads = "|" + " |" * COLUMNS + "\n" + "|" + "---|" * COLUMNS
    return f"{heads}\n" + "\n".join(rows) + "\n"


def _cell(name: str) -> str:
    title = ct.example(name).title
    ending = "gif" if name in MOVING else "png"
    place = ELSEWHERE.get(name, f"images/gallery/{name}.{ending}")
    return f"![{title}]({place})<br>{title}<br>`{name}`"


def main(names: list[str]) -> None:
    """Write the pictures."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    of_gears = [name for kind in GEARS for name in ct.example_names(kind)]
    for name in names or [*ct.example_names("linkage"), *of_gears]:
        if name in MOVING:
            animate(name, FOLDER / f"{name}.gif", pace=Pace(frames=FRAMES), simulation=True, size=SIZE)
            continue
        if name in ELSEWHERE:
            continue
        made = picture_of_gears(name) if name in of_gears else picture(name)
        (FOLDER / f"{name}.png").write_bytes(made)


if __name__ == "__main__":
    main(sys.argv[1:])
