"""Make the pictures of imports and exports in the gallery: an imported drawing, models in MuJoCo, a sketch of FreeCAD.

    MUJOCO_GL=egl python -m tools.exchange_gallery

MuJoCo renders what `centrode export` writes for it, at moments of a free or driven motion.
"""

from __future__ import annotations

import io
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from matplotlib.figure import Figure
from PIL import Image

import centrode as ct
from centrode.export.freecad import freecad_macro
from centrode.export.mjcf import mjcf_text
from centrode.kinematics.motion import initial_place
from centrode.render.figures.linkages import draw, initial_sample, read_scene
from centrode.sketches.dxf_sketches import dxf_sketch

DOCS = Path(__file__).parents[1] / "docs"
FOLDER = DOCS / "images" / "gallery"
INCHES, DOTS, COLOURS, PIXELS = 3.0, 120, 64, 480
IMPORTED, SKETCHED = "six-bar-press", "klann-leg"
FALLING, TURNING = "five-bar-pendulum", "hookes-joint"
SHOWN = {
    "imported-drawing": ("A DXF drawing and the mechanism that is read from it", "import.md"),
    "in-mujoco": ("A five-bar linkage that falls, in MuJoCo", "export.md#mujoco"),
    "sphere-in-mujoco": ("Hooke's joint, driven in MuJoCo", "export.md#mujoco"),
    "in-freecad": (
        "The sketch of a macro for FreeCAD, and its bars in positions of the motion",
        "export.md#freecad",
    ),
}
"""Name of the picture -> its title, and the page that tells how it is made."""
HEAD = """## From and into other programs

Drawings that `centrode import` reads, models and macros that `centrode export` writes.
"""
FADING = 0.55
"""How much of what stood there before is left at the next moment."""
INK, PALE = "#20405C", "#9BB8D3"


def section() -> str:
    """The part of the page that shows them."""
    cells = [
        f"![{title}](images/gallery/{name}.png)<br>{title}<br>[how]({page})"
        for name, (title, page) in SHOWN.items()
    ]
    columns = 2
    rows = ["| " + " | ".join(cells[k : k + columns]) + " |" for k in range(0, len(cells), columns)]
    return f"{HEAD}\n|" + " |" * columns + "\n|" + "---|" * columns + "\n" + "\n".join(rows) + "\n"


def imported_drawing() -> Image.Image:
    """The strokes of a drawing, and the mechanism that was read from it beside them."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "drawing.dxf"
        command = [sys.executable, "-m", "centrode", "draw", IMPORTED, "--out", str(file)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        mechanism, sketch = ct.import_sketch(file).mechanism, dxf_sketch(file.read_bytes(), str(file))
    figure = Figure(figsize=(2 * INCHES, INCHES))
    left, right = (figure.add_axes((0.5 * k, 0.0, 0.5, 1.0)) for k in range(2))
    for line in [*sketch.strokes, *sketch.hatches]:
        points = [*line.points, line.points[0]] if line.closed else line.points
        left.plot(*np.array(points).T, color=INK, linewidth=0.8)
    turn = np.linspace(0.0, 2.0 * np.pi, 61)
    for circle in sketch.rings:
        x, y = circle.centre
        left.plot(
            x + circle.radius * np.cos(turn), y + circle.radius * np.sin(turn), color=INK, linewidth=0.8
        )
    left.set_aspect("equal")
    motion = ct.motion(mechanism)
    scene = read_scene(mechanism, motion)
    draw(right, scene, initial_sample(scene, motion), names=True)
    for axes in (left, right):
        axes.set_axis_off()
    return _drawn(figure)


def in_mujoco() -> Image.Image:
    """A free motion: positions over one another, the later the darker."""
    mechanism = ct.example(FALLING)
    return _rendered(mechanism, free=True, seconds=(0.0, 0.25, 0.5), view=(90.0, -90.0), far=1.35)


def sphere_in_mujoco() -> Image.Image:
    """Positions of a driven joint."""
    return _rendered(ct.example(TURNING), free=False, seconds=(0.6,), view=(150.0, -35.0), far=0.95)


def _rendered(
    mechanism: ct.Mechanism, *, free: bool, seconds: tuple[float, ...], view: tuple[float, float], far: float
) -> Image.Image:
    """What MuJoCo shows of a model at moments, laid over one another."""
    text = mjcf_text(mechanism, ct.motion(mechanism, at=[initial_place(mechanism)]), free=free)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    camera = mujoco.MjvCamera()
    mujoco.mjv_defaultFreeCamera(model, camera)
    camera.azimuth, camera.elevation = view
    camera.distance *= far
    whole: Any = None
    with mujoco.Renderer(model, PIXELS, PIXELS) as renderer:
        for moment in seconds:
            while data.time < moment:
                mujoco.mj_step(model, data)
            renderer.update_scene(data, camera)
            seen = renderer.render().astype(float)
            whole = seen if whole is None else np.minimum(255.0 - FADING * (255.0 - whole), seen)
    return Image.fromarray(whole.astype(np.uint8))


def in_freecad() -> Image.Image:
    """The lines of the sketch with their fixed points, and where the bars stand in positions of the motion."""
    names: dict[str, Any] = {}
    exec(freecad_macro(SKETCHED, 5).partition("\nimport math\n")[0], names)
    figure = Figure(figsize=(INCHES, INCHES))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    places = names["PLACES"]
    for link, first, second, _base in names["SIDES"]:
        ends = np.array([places[first], places[second]])
        for x, y, angle in names["PLACEMENTS"].get(link, []):
            turned = ends @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
            axes.plot(*(turned + np.array([x, y])).T, color=PALE, linewidth=2.0, solid_capstyle="round")
        axes.plot(*ends.T, color=INK, linewidth=1.2, marker="o", markersize=3.0, zorder=3)
    fixed = np.array([places[point] for point in names["FIXED"]])
    axes.plot(*fixed.T, "s", color="#B23A48", markersize=5.0, zorder=4)
    axes.set_aspect("equal")
    axes.set_axis_off()
    return _drawn(figure)


def _drawn(figure: Figure) -> Image.Image:
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=DOTS)
    stream.seek(0)
    return Image.open(stream).convert("RGB")


PICTURES = {
    "imported-drawing": imported_drawing,
    "in-mujoco": in_mujoco,
    "sphere-in-mujoco": sphere_in_mujoco,
    "in-freecad": in_freecad,
}


def main() -> None:
    """Write the pictures."""
    for name, picture in PICTURES.items():
        picture().quantize(COLOURS).save(FOLDER / f"{name}.png", optimize=True)


if __name__ == "__main__":
    main()
