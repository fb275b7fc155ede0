"""Every kind of picture that a sheet may hold."""

from __future__ import annotations

from typing import TypeAlias

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
from centrode.sheets.plots import AreaDiagram, CurveDiagram, PanelGrid, Plot, SpanPlot, VectorPage
from centrode.sheets.scenes import Scene

Picture: TypeAlias = (
    Plot
    | CurveDiagram
    | PanelGrid
    | VectorPage
    | Hodograph
    | BarChart
    | NamedBarChart
    | Histograms
    | LinkageWithDiscs
    | AreaDiagram
    | Scene
    | SpanPlot
    | GroupPage
    | LeverPage
    | PositionsPage
    | InstantPage
    | InstantsPage
    | VectorDiagramPage
    | MechanismPicture
    | PathsPicture
    | SchemePicture
    | SchemePair
    | OutlineDrawing
    | PathDrawing
    | WheelPositions
    | FrontDiagram
    | ChainAtlas
    | CurveMap
)
