"""Figures and files of loads: over the motion, over the coordinate or speed that they depend on, given as tables."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.dynamics.load_courses import LoadCourse, WorkingCoordinate
from centrode.sheets.plots import AxisLabel, Curve, CurveDiagram, CurvePanel, CurveRole, Plot, Trace
from centrode.sheets.sheet import Column, Table
from centrode.sheets.texts import Joined, Sentence, Symbol, Text, Title
from centrode.views.abscissa import motion_abscissa
from centrode.views.columns import force_columns
from centrode.views.load_names import load_text
from centrode.views.motion_plots import deal_to_panels

if TYPE_CHECKING:
    from centrode.dynamics.reduction_results import ReductionResults
    from centrode.model.loads import AnyLoad
    from centrode.model.mechanism import Mechanism
    from centrode.sheets.pictures import Picture

Array: TypeAlias = NDArray[np.float64]
MARGIN = 0.04
"""Share of its width by which a diagram is wider than its curve."""
SYMBOLS = {"N": "F", "N m": "M"}
COORDINATES = {
    WorkingCoordinate.COMPONENT: (Sentence("coordinate"), Sentence("velocity")),
    WorkingCoordinate.SLIDE: (Sentence("displacement along the guide"), Sentence("velocity along the guide")),
    WorkingCoordinate.LENGTH: (Sentence("distance"), Sentence("rate of the distance")),
    WorkingCoordinate.ANGLE: (Sentence("angle"), Sentence("angular velocity")),
}
"""Name of a coordinate, and of its derivative by time."""
TABLES_OVER = {
    "displacement": AxisLabel(Sentence("displacement along the guide"), unit="m"),
    "stroke": AxisLabel(Sentence("share of the stroke")),
    "drive": AxisLabel(Sentence("value of the drive"), unit="rad"),
    "time": AxisLabel(Sentence("time"), Symbol("t"), "s"),
}
"""What the rows of a load's table are given over."""


def load_pictures(results: ReductionResults) -> Iterator[tuple[str, Picture]]:
    """Loads that change over the motion; each over what it depends on; moments of loads and drive with their sum."""
    mechanism, title = results.mechanism, Title(results.mechanism.title)
    changing = [course for course in results.courses if course.varies]
    panels = [panel for unit in SYMBOLS for panel in _panels(mechanism, unit, changing)]
    abscissa = motion_abscissa(mechanism, results.reduction)
    if panels:
        rows = tuple((panel,) for panel in panels)
        yield "loads", Plot(Sentence("Loads over the motion"), title, abscissa, rows)
    diagrams = [course for course in changing if _has_diagram(course)]
    for number, course in enumerate(diagrams, start=1):
        suffix = f"-{number}" if len(diagrams) > 1 else ""
        yield f"load-diagram{suffix}", _diagram(mechanism, course, title)
    if results.driving is not None:
        panel = _moments(results.reduction["reduced_moment"].values, results.driving)
        what = Sentence("Moments of the loads and of the drive, and their sum")
        yield "moment-sum", Plot(what, title, abscissa, ((panel,),))


def load_captions(results: ReductionResults) -> dict[str, Text]:
    """Name of each figure -> its caption in a document."""
    return {name: picture.title for name, picture in load_pictures(results)}


def course_text(mechanism: Mechanism, course: LoadCourse) -> Text:
    """A load, with the axis of its component."""
    name = load_text(mechanism, course.label)
    return Joined((name, Symbol(course.axis)), ", ") if course.axis else name


def _panels(mechanism: Mechanism, unit: str, courses: list[LoadCourse]) -> Iterator[CurvePanel]:
    """Panels of the loads of one unit, with as many curves each as can be distinguished."""
    of_unit = [course for course in courses if course.unit == unit]
    for numbers in deal_to_panels(map(str, range(len(of_unit)))):
        curves = tuple(
            Curve(course_text(mechanism, of_unit[place]), of_unit[place].strength, place)
            for place in map(int, numbers)
        )
        if curves:
            yield CurvePanel(AxisLabel(symbol=Symbol(SYMBOLS[unit]), unit=unit, unit_fixed=True), curves)


def _has_diagram(course: LoadCourse) -> bool:
    """Whether a load depends on its coordinate or its speed, and this changes."""
    if not course.depends_on:
        return False
    values = _depended_on(course)
    known = values[np.isfinite(values)]
    return bool(known.size) and float(np.ptp(known)) > 1e-9 * float(np.max(np.abs(known)))


def _depended_on(course: LoadCourse) -> Array:
    return course.place if course.depends_on == "place" else course.speed


def _diagram(mechanism: Mechanism, course: LoadCourse, title: Title) -> CurveDiagram:
    """A load over the coordinate or the speed that it depends on."""
    at, place = _depended_on(course), course.depends_on == "place"
    coordinate, rate = COORDINATES[course.coordinate]
    unit = course.place_unit if place else f"{course.place_unit}/s"
    name = load_text(mechanism, course.label)
    what = (
        Sentence("Load over its coordinate: {name}", name=name)
        if place
        else Sentence("Load over its speed: {name}", name=name)
    )
    symbol = Symbol(course.axis) if course.axis and place else None
    return CurveDiagram(
        what,
        title,
        AxisLabel(coordinate if place else rate, symbol, unit),
        AxisLabel(
            symbol=Symbol(SYMBOLS[course.unit], course.axis, slanted=True), unit=course.unit, unit_fixed=True
        ),
        (Trace(course_text(mechanism, course), at, course.strength),),
        _across(at),
    )


def _across(values: Array) -> tuple[float, float]:
    """Ends of an axis, somewhat beyond the values."""
    low, high = float(np.nanmin(values)), float(np.nanmax(values))
    return low - MARGIN * (high - low), high + MARGIN * (high - low)


def _moments(loads: Array, driving: Array) -> CurvePanel:
    parts = ((Sentence("loads"), loads), (Sentence("driving moment"), driving))
    curves = [Curve(name, values, place, role=CurveRole.PART) for place, (name, values) in enumerate(parts)]
    total = Curve(Sentence("sum"), loads + driving, len(parts), role=CurveRole.SUM)
    return CurvePanel(AxisLabel(symbol=Symbol("M"), unit="N m", unit_fixed=True), (*curves, total))


# Files


def loads_table(results: ReductionResults) -> Table:
    """One row a sample: every load with its coordinate and speed, driving moment and sum of moments; in SI."""
    along = [Column(name, values.values, unit) for name, unit, values in force_columns(results.reduction, ())]
    columns = [column for course in results.courses for column in _columns(course)]
    if results.driving is not None:
        total = results.reduction["reduced_moment"].values + results.driving
        columns += [
            Column("driving_moment", results.driving, "N m"),
            Column("sum_of_moments", total, "N m"),
        ]
    return Table((*along, *columns))


def _columns(course: LoadCourse) -> Iterator[Column]:
    name = "_".join(filter(None, (course.label, course.axis)))
    yield Column(f"load_{name}", course.strength, course.unit)
    if np.isfinite(course.place).any():
        yield Column(f"coordinate_{name}", course.place, course.place_unit)
    yield Column(f"speed_{name}", course.speed, f"{course.place_unit}/s")


# Tables that the description gives


def table_diagram(mechanism: Mechanism, load: AnyLoad) -> CurveDiagram | None:
    """The table of a load as its rows and the straight lines between them; None of a load without one."""
    given: Any = load
    rows = getattr(given, "table", None)
    if rows is None:
        return None
    at, *forces = np.array(rows).T
    unit = "N m" if load.kind == "torque" else "N"
    over = getattr(given, "over", None) or ("drive" if load.kind == "torque" else "displacement")
    ways = (
        (Sentence("way out"), Sentence("way back"))
        if len(forces) > 1
        else (load_text(mechanism, load.label),)
    )
    factor = getattr(given, "factor", 1.0)
    traces = tuple(
        Trace(way, at, factor * force, marks=np.stack([at, factor * force], axis=-1))
        for way, force in zip(ways, forces, strict=True)
    )
    return CurveDiagram(
        Sentence("Table of the load: {name}", name=load_text(mechanism, load.label)),
        Title(mechanism.title),
        TABLES_OVER[over],
        AxisLabel(symbol=Symbol(SYMBOLS[unit]), unit=unit, unit_fixed=True),
        traces,
        _across(at),
    )
