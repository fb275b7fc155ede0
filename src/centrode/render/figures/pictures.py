"""Plots and diagrams of sheets as figures of matplotlib, in the house style."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, assert_never

from matplotlib.figure import Figure

from centrode.locale import _
from centrode.render.drawing.style import darken, house_style
from centrode.render.drawing.walking_wheel import wheel_figure
from centrode.render.figures.areas import area_figure
from centrode.render.figures.chain_atlas import atlas_figure
from centrode.render.figures.charts import (
    bar_figure,
    front_figure,
    histogram_figure,
    hodograph_figure,
    linkage_figure,
    named_bar_figure,
)
from centrode.render.figures.curve_maps import map_figure
from centrode.render.figures.files import save_figures
from centrode.render.figures.linkages import mechanism_figure, paths_figure
from centrode.render.figures.outlines import outline_figure, path_figure
from centrode.render.figures.panel_grids import grid_figure
from centrode.render.figures.plots import diagram_figure, plot_figure
from centrode.render.figures.scenes import scene_figure
from centrode.render.figures.schemes import pair_figure, scheme_figure
from centrode.render.figures.span_plots import span_figure
from centrode.render.pages.force_polygons import group_page
from centrode.render.pages.instants import instant_figure
from centrode.render.pages.levers import lever_page
from centrode.render.pages.positions import positions_figure
from centrode.render.pages.several_instants import instants_figure
from centrode.render.pages.vector_diagrams import vector_diagram_figure
from centrode.render.pages.vectors import vector_page
from centrode.sheets.chain_atlas import ChainAtlas
from centrode.sheets.charts import (
    BarChart,
    FrontDiagram,
    Histograms,
    Hodograph,
    LinkageWithDiscs,
    NamedBarChart,
)
from centrode.sheets.curve_maps import CurveMap
from centrode.sheets.force_pages import GroupPage, LeverPage
from centrode.sheets.linkages import MechanismPicture, PathsPicture, SchemePair, SchemePicture
from centrode.sheets.outlines import OutlineDrawing, PathDrawing, WheelPositions
from centrode.sheets.pages import InstantPage, InstantsPage, PositionsPage, VectorDiagramPage
from centrode.sheets.plots import (
    AreaDiagram,
    CurveDiagram,
    PanelGrid,
    Plot,
    SpanPlot,
    VectorPage,
)
from centrode.sheets.scenes import Scene

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.pictures import Picture


def figures_of(pictures: Mapping[str, Picture], display: Display) -> dict[str, Figure]:
    """The pictures of a sheet as figures, by name; those whose every panel is empty are left out."""
    return {
        name: figure_of(picture, display)
        for name, picture in pictures.items()
        if not isinstance(picture, Plot) or any(panel.curves for row in picture.rows for panel in row)
    }


def write_pictures(
    pictures: Mapping[str, Picture],
    folder: Path,
    display: Display,
    say: Callable[[str, int, int], None] = lambda *_progress: None,
    *,
    dark: bool = False,
) -> None:
    """Write the pictures of a sheet as PNG and SVG, `dark` with light lines on a dark ground.

    `say` hears which is drawn, its number and how many there are.
    """
    drawn = figures_of(pictures, display)
    for number, (name, figure) in enumerate(drawn.items(), start=1):
        say(_("drawing {name}").format(name=name), number, len(drawn))
        save_figures({name: darken(figure) if dark else figure}, folder)


def figure_of(picture: Picture, display: Display) -> Figure:
    """A picture of a sheet as a figure, lengths and angles in the units of the display."""
    with house_style():
        match picture:
            case Plot():
                return plot_figure(picture, display)
            case CurveDiagram():
                return diagram_figure(picture, display)
            case PanelGrid():
                return grid_figure(picture, display)
            case VectorPage():
                return vector_page(picture)
            case Hodograph():
                return hodograph_figure(picture, display)
            case BarChart():
                return bar_figure(picture, display)
            case NamedBarChart():
                return named_bar_figure(picture, display)
            case Histograms():
                return histogram_figure(picture, display)
            case LinkageWithDiscs():
                return linkage_figure(picture, display)
            case AreaDiagram():
                return area_figure(picture, display)
            case Scene():
                return scene_figure(picture, display)
            case SpanPlot():
                return span_figure(picture, display)
            case GroupPage():
                return group_page(picture)
            case LeverPage():
                return lever_page(picture)
            case PositionsPage():
                return positions_figure(picture, display)
            case InstantPage():
                return instant_figure(picture, display)
            case InstantsPage():
                return instants_figure(picture, display)
            case VectorDiagramPage():
                return vector_diagram_figure(picture, display)
            case MechanismPicture():
                return mechanism_figure(picture, display)
            case PathsPicture():
                return paths_figure(picture, display)
            case SchemePicture():
                return scheme_figure(picture, display)
            case SchemePair():
                return pair_figure(picture, display)
            case OutlineDrawing():
                return outline_figure(picture, display)
            case PathDrawing():
                return path_figure(picture, display)
            case WheelPositions():
                return wheel_figure(picture, display)
            case FrontDiagram():
                return front_figure(picture, display)
            case ChainAtlas():
                return atlas_figure(picture, display)
            case CurveMap():
                return map_figure(picture, display)
            case _:
                assert_never(picture)
