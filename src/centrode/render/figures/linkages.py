"""Pictures of a mechanism itself: at chosen instants, and with the paths of its points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from centrode.errors import Status
from centrode.locale import _
from centrode.model.motion_parameter import TIME, MotionVariable
from centrode.model.settings import shown_as
from centrode.quantities import spelled_unit, status_word, with_unit
from centrode.render.drawing.figure_room import PAGE_HEIGHT, count_across, figure_width
from centrode.render.drawing.globe import draw_globe
from centrode.render.drawing.linkage import MARGIN, draw_mechanism
from centrode.render.drawing.style import (
    CUT,
    HIDDEN,
    LINK,
    MUTED,
    Decimals,
    Pen,
    marker_options,
    pens,
)
from centrode.render.drawing.texts import formula, label_with_unit
from centrode.render.figures.curves import (
    draw_parts,
    legend_height,
    legend_width,
    say_nothing_known,
    write_legend,
    write_title,
)
from centrode.render.figures.interpolation import interpolated_curve
from centrode.render.figures.plots import drawn_abscissa
from centrode.render.spelling import FigureSpelling
from centrode.scenes.linkage import scene_of
from centrode.scenes.places import LinkageScene
from centrode.scenes.sphere import Globe, globe_of

if TYPE_CHECKING:
    from centrode.model.mechanism import Mechanism
    from centrode.model.settings import Display
    from centrode.sheets.linkages import MechanismPicture, PathsPicture

GHOSTS = 7  # fading pictures behind the initial position
COLUMNS = 3
FAINT = "#B4B4B4"
INCHES = 4.2
"""The most that the longer side of a mechanism takes [inch]."""
BESIDE, HEAD = (0.75, 0.7), 0.45
"""What stands beside and above each drawing, and above the figure [inch]."""


def mechanism_figure(picture: MechanismPicture, display: Display) -> Figure:
    """The mechanism at the chosen values of the drive, or initially over fading pictures of its motion."""
    dataset = _with_instants(picture)
    scene = read_scene(picture.mechanism, dataset)
    samples = [nearest_sample(scene.mechanism, dataset, value) for value in picture.values]
    samples = samples or [initial_sample(scene, dataset)]
    columns = min(2 if len(samples) == 4 else len(samples), count_across(COLUMNS))
    rows = -(-len(samples) // columns)
    scene, figure = place_on_paper(scene, scene.mechanism.link_names, rows, columns)
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    faded = [] if picture.values else ghosts(scene, dataset, samples[0])
    for axes, sample in zip(grid, samples, strict=False):
        draw(axes, scene, sample, faded=faded)
        if picture.captioned:
            axes.set_title(caption(scene.mechanism, dataset, sample))
    for axes in grid[len(samples) :]:
        axes.set_axis_off()
    write_legend(grid[columns - 1], link_key(scene.mechanism), inches=figure.get_figheight() - 1.0)
    _write_title(figure, picture, display)
    return figure


def paths_figure(picture: PathsPicture, display: Display) -> Figure:
    """Paths of points, with the mechanism faint in its initial position."""
    abscissa = drawn_abscissa(picture.abscissa, FigureSpelling(display))
    scene = read_scene(picture.mechanism, picture.motion)
    scene, figure = place_on_paper(scene, picture.points)
    axes = figure.subplots()
    draw(axes, scene, initial_sample(scene, picture.motion), colour=FAINT)
    drawn = []
    for name, pen in pens(picture.points).items():
        path = scene.tracks[name]
        if isinstance(scene, Globe):
            hidden = np.where(scene.in_front(path)[:, None], np.nan, scene.flat(path))
            axes.plot(
                *hidden[abscissa.order].T, color=pen.colour, linestyle=HIDDEN, linewidth=1.0, zorder=6.5
            )
            path = np.where(scene.in_front(path)[:, None], scene.flat(path), np.nan)
        x, y = (abscissa.parts(path[:, axis]) for axis in (0, 1))
        regular, beyond = (interpolated_curve(one, other) for one, other in zip(x, y, strict=True))
        x, y = (regular[0], beyond[0]), (regular[1], beyond[1])
        drawn.append((draw_parts(axes, x, y, name, pen, level=7.0), name))
    key = []
    if abscissa.cut.any():
        key.append((Line2D([], [], color=MUTED, linewidth=1.0, linestyle=CUT), _("cut off")))
    write_legend(axes, drawn, key, figure.get_figheight() - 1.0)
    if not any(np.isfinite(scene.tracks[name]).any() for name in picture.points):
        say_nothing_known(axes)
    _write_title(figure, picture, display)
    return figure


def _with_instants(picture: MechanismPicture) -> xarray.Dataset:
    """The samples of a motion, those of its instants before them."""
    if picture.instants is None:
        return picture.motion
    together = [data.drop_dims("event", errors="ignore") for data in (picture.instants, picture.motion)]
    return xarray.concat(together, dim="sample", data_vars="minimal")


def read_scene(mechanism: Mechanism, dataset: xarray.Dataset) -> LinkageScene | Globe:
    """Where everything stands, in the plane or on the sphere."""
    return globe_of(mechanism, dataset) if mechanism.space == "sphere" else scene_of(mechanism, dataset)


def _write_title(figure: Figure, picture: MechanismPicture | PathsPicture, display: Display) -> None:
    title = FigureSpelling(display).text(picture.title)
    write_title(figure, title, _(picture.mechanism.title))


def draw(axes: Axes, scene: LinkageScene | Globe, sample: int, **how: Any) -> None:
    """A mechanism in the plane with its coordinates along the axes, or on the sphere."""
    if isinstance(scene, Globe):
        draw_globe(axes, scene, sample, **how)
    else:
        draw_mechanism(axes, scene, sample, **how)
        label_lengths(axes, scene)


def place_on_paper(
    scene: LinkageScene | Globe, names: Sequence[str], rows: int = 1, columns: int = 1
) -> tuple[LinkageScene | Globe, Figure]:
    """The scene at the size that it gets on paper, and an empty figure in its proportions."""
    beside, above = legend_width(names, 3.0), legend_height(names, inches=3.0)
    # what labels and titles leave of the page, and the proportions of the scene
    room = np.array([figure_width() - beside, PAGE_HEIGHT - above - HEAD]) / (columns, rows) - BESIDE
    sides = (scene.high - scene.low) / scene.extent + 2 * MARGIN
    inches = min(INCHES, float(np.min(room / sides)))
    height = rows * (inches * float(sides[1]) + BESIDE[1]) + above + HEAD
    return replace(scene, inches=inches), Figure(figsize=(figure_width(), height), layout="constrained")


def label_lengths(axes: Axes, scene: LinkageScene) -> None:
    """Coordinates along both axes, in the unit of the display."""
    unit = shown_as("m", scene.mechanism.display)[1]
    axes.set_xlabel(label_with_unit(formula("x"), unit))
    axes.set_ylabel(label_with_unit(formula("y"), unit))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(Decimals())


def link_line(pen: Pen) -> Line2D:
    """What stands for a link in a legend."""
    return Line2D([], [], color=pen.colour, linewidth=LINK, **marker_options(pen, None))


def link_key(mechanism: Mechanism) -> list[tuple[Line2D, str]]:
    """Entries of the legend for the links."""
    return [(link_line(pen), name) for name, pen in pens(mechanism.link_names).items()]


def caption(mechanism: Mechanism, dataset: xarray.Dataset, sample: int) -> str:
    """The instant, and why there is nothing to see where there is not; of a drive by a law the time too."""
    text = instant_text(mechanism, dataset, sample)
    if not mechanism.motion_parameter.states_instants:
        text = f"{_value_text(mechanism, TIME, float(dataset['time'][sample]))}, {text}"
    status = int(dataset["status"][sample])
    return text if status == Status.OK else f"{text} ({status_word(status)})"


def instant_text(mechanism: Mechanism, dataset: xarray.Dataset, sample: int) -> str:
    """The instant: the value of the motion's parameter at a sample."""
    parameter = mechanism.motion_parameter
    values = parameter.values(dataset)
    value = float(values[sample])
    if not parameter.by_time and abs(value) < 1e-9 * float(np.nanmax(np.abs(values))):
        value = 0.0  # rounding of the range's middle or end
    return _value_text(mechanism, parameter.variable, value)


def _value_text(mechanism: Mechanism, variable: MotionVariable, value: float) -> str:
    """A value [SI] with its letter."""
    factor, unit = shown_as(variable.unit, mechanism.display)
    shown = with_unit(f"{factor * value:.5g}", spelled_unit(unit))
    return f"{formula(variable.symbol)} = {shown}".replace("-", "−")


def nearest_sample(mechanism: Mechanism, dataset: xarray.Dataset, value: float) -> int:
    """The sample nearest to an instant."""
    return int(np.argmin(np.abs(mechanism.motion_parameter.instants(dataset) - value)))


def initial_sample(scene: LinkageScene | Globe, dataset: xarray.Dataset) -> int:
    """The sample nearest to the start, at time zero, among those with every point in place."""
    known = complete(scene)
    if not known.any():
        return 0
    distance = np.abs(dataset["time"].values)
    worth = np.where(dataset["status"].values == Status.OK, 0.0, 1.0)
    return int(np.lexsort((distance, worth, ~known))[0])


def ghosts(scene: LinkageScene | Globe, dataset: xarray.Dataset, sample: int) -> list[int]:
    """Samples evenly spread over the motion's regular part, the nearest to the given one last."""
    regular = np.flatnonzero(complete(scene) & (dataset["status"].values == Status.OK))
    if regular.size < 2:
        return []
    chosen = regular[np.linspace(0, regular.size - 1, GHOSTS + 1).astype(int)]
    return sorted({int(k) for k in chosen} - {sample}, key=lambda k: -abs(k - sample))


def complete(scene: LinkageScene | Globe) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """True where every moving point has a position."""
    moving = [scene.tracks[name] for name in scene.mechanism.moving_points]
    return np.asarray(np.isfinite(np.stack(moving)).all(axis=(0, 2)))
