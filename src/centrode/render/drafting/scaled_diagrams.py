"""Diagrams to round scales: curves over an axis of numbered positions, the energy-mass diagram with its tangents."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from matplotlib.patches import Polygon

from centrode.numerics.round_scales import round_scale
from centrode.quantities import spelled_unit
from centrode.render.drafting.drawing_page import SMALLEST, USUAL, DrawingPage, SheetField
from centrode.render.drafting.plates import begin, number_text, scale_text, write_caption
from centrode.render.drafting.recorder import MAIN, THIN
from centrode.render.drafting.scales import diagram_scale
from centrode.render.pages.page import Array, count_crossings
from centrode.render.spelling import FigureSpelling

if TYPE_CHECKING:
    from centrode.sheets.drawing_sheets import EnergyMassDiagram, ScaledCurve, ScaledDiagram
    from centrode.sheets.plots import AxisLabel

LEFT, RIGHT, LOW, TOP = 20.0, 24.0, 9.0, 9.0
"""Room for numbers and names around the axes [mm]."""
TICK = 1.2
"""Half the length of a tick [mm]."""
APART = 24.0
"""About so far apart are the numbers along an axis [mm]."""
WORD, HEIGHT = 3.5, 7.0
"""Half the width of a number at a tick, and how far it reaches from the axis [mm]."""
NEXT = 6.5
"""Numbers nearer to the one before than this are left out [mm]."""
SHIFTS = {"center": 0.0, "left": 1.0, "right": -1.0}
"""Between a tick and a number beside it, by the number's alignment [mm]."""
STEPS = (1.0, 2.0, 2.5, 5.0, 10.0)
FIRST = 0.6
"""Share of the room of the tangents' numbers that their first column takes: its lines are longer."""
BEYOND = 7.0
"""How far an axis goes beyond what is drawn [mm]."""


@dataclass(frozen=True)
class DiagramAxes:
    """Where a diagram lies: its origin [mm], what a millimetre stands for, and the ends of its axes [mm].

    A diagram that is `turned` has its first axis downwards, and its second to the right.
    """

    origin: Array
    per: tuple[float, float]
    turned: bool = False

    def mm(self, across: Array, up: Array) -> Array:
        """Places of a curve on the sheet (n, 2) [mm]."""
        right, high = np.asarray(across) / self.per[0], np.asarray(up) / self.per[1]
        if self.turned:
            right, high = high, -right
        return np.asarray(self.origin + np.stack([right, high], axis=-1))


def span_of(curves: tuple[ScaledCurve, ...], axis: str) -> tuple[float, float]:
    """Least and greatest of curves and zero."""
    values = np.concatenate([np.ravel(getattr(curve, axis)) for curve in curves] + [np.zeros(1)])
    values = values[np.isfinite(values)]
    return float(values.min()), float(values.max())


def lay_axes(
    field: SheetField, across: tuple[float, float], up: tuple[float, float], per: tuple[float, float]
) -> DiagramAxes:
    """Axes whose spans stand in the middle of a field."""
    spans = np.array([across, up]).T / per
    slack = field.size - (spans[1] - spans[0])
    return DiagramAxes(np.asarray(field.corner - spans[0] + slack / 2), per)


def draw_diagram(page: DrawingPage, field: SheetField, diagram: ScaledDiagram) -> tuple[float, float]:
    """Curves in their field with axes and scales; returns what a millimetre stands for along both axes."""
    inner = begin(page, field).part(LEFT, LOW, RIGHT, TOP)
    across, up = span_of(diagram.curves, "across"), span_of(diagram.curves, "up")
    per = (
        diagram_scale(across[1] - across[0], float(inner.size[0])),
        diagram_scale(up[1] - up[0], float(inner.size[1])),
    )
    _draw_one(page, field, lay_axes(inner, across, up, per), diagram, across, up)
    return per


def _draw_one(
    page: DrawingPage,
    field: SheetField,
    axes: DiagramAxes,
    diagram: ScaledDiagram,
    across: tuple[float, float],
    up: tuple[float, float],
) -> None:
    """Axes, curves, names and caption of a diagram."""
    lines = [axes.mm(curve.across, curve.up) for curve in diagram.curves]
    draw_axis(page, axes, diagram.across, 0, across, diagram.ticks, lines)
    draw_axis(page, axes, diagram.up, 1, up, curves=lines)
    draw_curves(page, axes, diagram.curves)
    page.place_names(begin_box(field))
    scales = [axis_scale(diagram.up, axes.per[1]), axis_scale(diagram.across, axes.per[0])]
    write_caption(page, field, FigureSpelling(None).text(diagram.title), scales)


def begin_box(field: SheetField) -> Array:
    """The box in which names of a diagram may stand."""
    return field.part(bottom=14.0).box


def axis_scale(label: AxisLabel, per: float) -> str:
    """The scale of an axis, its letter that of the axis."""
    letter = "" if label.symbol is None else symbol_text(label).strip("$")
    return scale_text(letter, per, label.unit)


def symbol_text(label: AxisLabel) -> str:
    """The letter of an axis as mathematics."""
    return "" if label.symbol is None else FigureSpelling(None).symbol(label.symbol)


def draw_axis(
    page: DrawingPage,
    axes: DiagramAxes,
    label: AxisLabel,
    which: int,
    span: tuple[float, float],
    ticks: tuple[float, ...] = (),
    curves: Sequence[Array] = (),
) -> None:
    """An axis through the origin with its letter, ticks of numbered positions or of round numbers."""
    way = np.array([1.0, 0.0]) if (which == 0) != axes.turned else np.array([0.0, 1.0])
    if axes.turned and which == 0:
        way = -way
    across = np.array([-way[1], way[0]]) if which == 0 else np.array([way[1], -way[0]])
    start, end = (axes.origin + value / axes.per[which] * way for value in span)
    tip = _name_axis(page, end, way, label)
    page.line([start, tip], THIN)
    page.overlay.add_artist(page_head(tip, way))
    page.avoid([(start, tip)])
    numbered = bool(ticks)
    before = -np.inf
    places = ticks if numbered else _round_places(span, axes.per[which])
    apart = float(np.abs(np.diff(places)).min(initial=np.inf)) / axes.per[which]
    ways = BESIDE_TICK if apart > NEXT + WORD else AT_TICK
    for number, value in enumerate(places):
        if value == 0.0 and not numbered:
            continue
        at = axes.origin + value / axes.per[which] * way
        page.line([at - TICK * across, at + TICK * across], THIN)
        if numbered and (value - before) / axes.per[which] < NEXT and before < value:
            continue
        before = value
        words = str(number) if numbered else number_text(value)
        height = USUAL if numbered else SMALLEST
        if abs(way[0]) > 0.5:
            side, where = _free_side(at, curves, ("right",) if not value else ways)
            right = float(at[0]) + SHIFTS[where]
            up = float(at[1]) + side * 1.5 * TICK
            page.write_in(height, right, up, words, ha=where, va="top" if side < 0 else "bottom")
        else:
            room = np.array([[2.0, -1.5], [2.0 + 0.7 * height * len(words), 1.5]])
            beside, other = (_is_crowded(at + room * [side, 1.0], curves) for side in (-1.0, 1.0))
            side = 1.0 if beside and not other else -1.0
            right = float(at[0]) + side * 1.5 * TICK
            page.write_in(height, right, float(at[1]), words, ha="right" if side < 0 else "left", va="center")


def _name_axis(page: DrawingPage, end: Array, way: Array, label: AxisLabel) -> Array:
    """Write the letter of an axis beyond its end, where no number of it stands; returns its tip [mm]."""
    text = symbol_text(label)
    if label.unit not in ("", "1"):
        text = f"{text}, {spelled_unit(label.unit)}"
    tip = np.asarray(end + BEYOND * way)
    if abs(way[0]) > 0.5:
        left = float(end[0]) + WORD
        written = page.write_in(USUAL, left, float(end[1]) + 2.0, text, ha="left", va="bottom")
        return np.array([max(float(tip[0]), float(page.box_of(written)[1, 0]) + 1.0), tip[1]])
    top = float(tip[1]) if way[1] > 0 else float(tip[1]) - 1.0
    page.write_in(USUAL, float(tip[0]) + 2.0, top, text, ha="left", va="top" if way[1] > 0 else "bottom")
    return tip


Alignment: TypeAlias = Literal["center", "left", "right"]
AT_TICK: tuple[Alignment, ...] = ("center",)
BESIDE_TICK: tuple[Alignment, ...] = ("center", "left", "right")


def _free_side(at: Array, curves: Sequence[Array], ways: tuple[Alignment, ...]) -> tuple[float, Alignment]:
    """Below (-1) or above (1) a tick, and how aligned: the first of some ways at which no curve runs."""
    for where in ways:
        for side in (-1.0, 1.0):
            box = np.array([[-WORD, 0.3 * side], [WORD, HEIGHT * side]])
            box[:, 0] += SHIFTS[where] + {"center": 0.0, "left": WORD, "right": -WORD}[where]
            if not _is_crowded(at + box, curves):
                return side, where
    return -1.0, ways[0]


def _is_crowded(box: Array, curves: Sequence[Array]) -> bool:
    """Whether a curve runs through a box given by two opposite corners [mm]."""
    low, high = box.min(axis=0), box.max(axis=0)
    for places in curves:
        segments = np.stack([places[:-1], places[1:]], axis=1)
        segments = segments[np.isfinite(segments).all(axis=(1, 2))]
        if count_crossings(low[None], high[None], segments)[0]:
            return True
    return False


def page_head(tip: Array, way: Array) -> Polygon:
    """The head of an axis."""
    across = np.array([-way[1], way[0]])
    corners = np.array([tip, tip - 4.0 * way + 0.7 * across, tip - 4.0 * way - 0.7 * across])
    return Polygon(corners, closed=True, facecolor="black", edgecolor="none", zorder=5)


def _round_places(span: tuple[float, float], per: float) -> tuple[float, ...]:
    """Round numbers along an axis, about evenly far apart on paper."""
    step = round_scale(APART * per, series=STEPS)
    first, last = math.ceil(span[0] / step - 1e-9), math.floor(span[1] / step + 1e-9)
    return tuple(float(f"{number * step:.12g}") for number in range(first, last + 1))


def draw_curves(page: DrawingPage, axes: DiagramAxes, curves: tuple[ScaledCurve, ...]) -> None:
    """Curves as main lines, with their names where they are farthest from the axis."""
    spelling = FigureSpelling(None)
    lines = [axes.mm(curve.across, curve.up) for curve in curves]
    for places in lines:
        page.line(places, MAIN)
        known = places[np.isfinite(places).all(axis=1)]
        page.avoid(pairwise(known[:: max(1, len(known) // 200)]))
    for number, (curve, places) in enumerate(zip(curves, lines, strict=True)):
        name = spelling.text(curve.name)
        if name:
            share = int((number + 1) / (len(curves) + 1) * (len(places) - 1))
            page.name(places[share], name, clear=1.0, size=8.0)


# Wittenbauer's diagram


@dataclass(frozen=True)
class EnergyMassFields:
    """Where the parts of the energy-mass diagram go: works and masses side by side at one height."""

    work: SheetField
    masses: SheetField
    inertia: SheetField
    text: SheetField


def draw_energy_mass(
    page: DrawingPage, fields: EnergyMassFields, diagram: EnergyMassDiagram
) -> tuple[float, float]:
    """Work over the turn, beside it work over inertia, below that the inertia, turned, and the tangents with numbers.

    Returns what a millimetre stands for: of work [J], of inertia [kg m^2], which both diagrams with them share.
    """
    inner = [
        begin(page, one).part(LEFT, LOW, RIGHT, TOP) for one in (fields.work, fields.masses, fields.inertia)
    ]
    turn, inertia = span_of(diagram.work.curves, "across"), span_of(diagram.inertia.curves, "up")
    low, high = span_of(diagram.work.curves, "up")
    work = min(low, *diagram.intercepts, 0.0), max(high, *diagram.intercepts, 0.0)
    per_work = diagram_scale(work[1] - work[0], float(inner[0].size[1]))
    per_inertia = diagram_scale(inertia[1], float(inner[1].size[0]))
    per_turn = (
        diagram_scale(turn[1], float(inner[0].size[0])),
        diagram_scale(turn[1], float(inner[2].size[1])),
    )
    works = lay_axes(inner[0], turn, work, (per_turn[0], per_work))
    _draw_one(page, fields.work, works, diagram.work, turn, (low, high))
    begin(page, fields.masses)
    masses = lay_axes(inner[1], inertia, work, (per_inertia, per_work))
    _draw_tangents(page, masses, diagram, inertia[1])
    _draw_one(page, fields.masses, masses, diagram.energy_mass, inertia, work)
    begin(page, fields.inertia)
    origin = np.array([masses.origin[0], inner[2].end[1] - (inner[2].size[1] - turn[1] / per_turn[1]) / 2])
    turned = DiagramAxes(origin, (per_turn[1], per_inertia), turned=True)
    _draw_one(page, fields.inertia, turned, diagram.inertia, turn, inertia)
    _write_tangents(page, fields.text, diagram, per_work, per_inertia)
    return per_work, per_inertia


ENDS = "k", "l"
"""Names of the places where the tangents cut the axis of works."""


def _draw_tangents(page: DrawingPage, axes: DiagramAxes, diagram: EnergyMassDiagram, reach: float) -> None:
    """Both tangents from the axis of works to the end of the diagram, and the segment between them."""
    for name, slope, start in zip(("min", "max"), diagram.slopes, diagram.intercepts, strict=False):
        ends = axes.mm(np.array([0.0, reach]), np.array([start, start + slope * reach]))
        page.line(ends, THIN)
        page.avoid([(ends[0], ends[1])])
        page.name(ends[1], rf"$\psi_{{\mathrm{{{name}}}}}$", clear=1.0, size=8.0)
    for inertia, work in diagram.touching:
        at = axes.mm(np.array(inertia), np.array(work))
        page.overlay.plot([at[0]], [at[1]], marker="o", markersize=4.0, color="black", zorder=6)
    for name, start in zip(ENDS, diagram.intercepts, strict=False):
        at = axes.mm(np.array(0.0), np.array(start))
        page.overlay.plot([at[0]], [at[1]], marker="o", markersize=4.0, color="black", zorder=6)
        page.name(at, f"${name}$", clear=1.0, size=9.0)


def _write_tangents(
    page: DrawingPage, field: SheetField, diagram: EnergyMassDiagram, per_work: float, per_inertia: float
) -> None:
    """How the flywheel follows from the tangents, in letters and numbers of the drawing."""
    if diagram.needed is None:
        return
    share = per_inertia / per_work
    lines = []
    for name, slope in zip(("max", "min"), reversed(diagram.slopes), strict=True):
        angle = math.degrees(math.atan(slope * share))
        letter = rf"\psi_{{\mathrm{{{name}}}}}"
        speed = rf"\omega_{{\mathrm{{{name}}}}}"
        tangent = rf"$\mathrm{{tg}}\,{letter} = \mu_J\,{speed}^2\,/\,(2\,\mu_T)$ = {_short(slope * share)}"
        lines.append(f"{tangent};  ${letter}$ = {_short(angle)}°")
    for name, slope in zip(("max", "min"), reversed(diagram.slopes), strict=True):
        speed = _short(math.sqrt(2.0 * slope))
        lines.append(rf"$\omega_{{\mathrm{{{name}}}}}$ = {speed} {spelled_unit('rad/s')}")
    length = abs(diagram.intercepts[1] - diagram.intercepts[0]) / per_work
    lines.append(f"$kl$ = {_short(length)} {spelled_unit('mm')}")
    below = r"(\mathrm{tg}\,\psi_\mathrm{max} - \mathrm{tg}\,\psi_\mathrm{min})"
    inertia = rf"$J_\mathrm{{I}} = \mu_J\,kl\,/\,{below}$"
    lines.append(f"{inertia} = {_short(diagram.needed)} {spelled_unit('kg m^2')}")
    lines = [lines[0], lines[1], lines[5], lines[2], lines[3], lines[4]]
    rows = -(-len(lines) // 2)
    for number, line in enumerate(lines):
        cell = field.share(1, 0, rows, rows - 1 - number % rows)
        left = float(cell.corner[0] + (FIRST * cell.size[0] if number >= rows else 0.0))
        middle = float(cell.corner[1] + cell.size[1] / 2)
        page.write_in(USUAL, left, middle, line, ha="left", va="center")


def _short(value: float) -> str:
    """A number of five digits."""
    return number_text(float(f"{value:.5g}"))
