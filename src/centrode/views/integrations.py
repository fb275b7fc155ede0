"""An integrated motion beside that in closed form: what the terminal, the files, the figures and the document show."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import isfinite
from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import Status
from centrode.model.labels import GEAR, ROLLING
from centrode.sheets.plots import AxisLabel, Curve, CurvePanel, EventKind, Overlay, Plot
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Fact,
    FactTable,
    Failure,
    Illustration,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import (
    NOTHING,
    Counted,
    Expression,
    Joined,
    Name,
    Number,
    Sentence,
    Symbol,
    Text,
    Title,
    Unit,
)
from centrode.views.abscissa import events_of, over_time
from centrode.views.columns import columns_of, counted_statuses, numeric_columns, rows_reached
from centrode.views.equations import constraint_text
from centrode.views.instants import place_number
from centrode.views.motion_plots import (
    PlottedMotion,
    Rows,
    panels_of_guides,
    panels_of_links,
    panels_of_points,
)

if TYPE_CHECKING:
    from centrode.equations.integration import IntegrationResults

RETURNS = 1e-9
"""A motion in closed form whose ends are nearer than this comes back: rounding stays far below, designs far above."""
AGREE = 1e-6
"""Part of a radian, or of the greatest length, that errors of steps of tolerance 1e-10 stay far below."""
ROUNDING = 1e-15
"""Errors below this are not drawn: a logarithmic scale would show nothing but them."""
BEHIND = ("drift", "angle_difference", "position_difference")
"""Variables behind those of the motion in its table."""
ERRORS = "integration-errors"


def sheet(results: IntegrationResults) -> Sheet:
    """How far the integrated motion gets, how far it drifts, and how much it differs from the closed forms."""
    facts = tuple(_facts(results))
    return Sheet(
        facts=facts,
        tables={"integration": _table(results)},
        datasets={"integration": results.integration},
        pictures=dict(_pictures(results)),
        chapters={"integration": _chapter(results, facts)},
        failure=_failure(results),
    )


# Facts


def _facts(results: IntegrationResults) -> Iterator[Fact]:
    """Method, range, rows, where it stopped, greatest drift and differences, whether the last row repeats the first."""
    integration = results.integration
    status, times = integration["status"].values, integration["time"].values
    first, last = (place_number(float(times[end]) + 0.0, "s") for end in (0, -1))
    stops = Joined(list(_stops(results)), "; ")
    yield Fact(Sentence("method"), _method(results))
    yield Fact(Sentence("range"), Sentence("{first} to {last}", first=first, last=last))
    yield Fact(Sentence("rows"), Joined((Number(len(status), digits="d"), counted_statuses(status)), ": "))
    yield Fact(Sentence("stops"), stops if stops.parts else Sentence("nowhere"))
    yield Fact(Sentence("closed-form solution"), _events(results))
    yield Fact(Sentence("greatest drift"), _drift(results))
    yield Fact(Sentence("greatest difference"), _difference(results))
    yield Fact(Sentence("last row"), _return(results))


def _method(results: IntegrationResults) -> Text:
    attributes, times = results.integration.attrs, results.integration["time"].values
    taken = int(attributes["steps_taken"])
    if attributes["method"] == "rk4":
        step = abs(float(times[-1] - times[0])) / max(taken, 1)
        return Counted(
            "Runge-Kutta of fourth order, {n} step of {step}",
            "Runge-Kutta of fourth order, {n} steps of {step}",
            taken,
            step=Number(step, "s"),
        )
    return Counted(
        "Dormand-Prince of eighth order, {n} step, tolerance {tolerance}",
        "Dormand-Prince of eighth order, {n} steps, tolerance {tolerance}",
        taken,
        tolerance=Number(attributes["tolerance"], digits=".1e"),
    )


def _stops(results: IntegrationResults) -> Iterator[Sentence]:
    """Where and why the integration stopped; nothing where it did not."""
    stop, lost = (results.integration.attrs[name] for name in ("stop_time", "lost_time"))
    if isfinite(lost):
        yield Sentence(
            "fixed steps drift off the mechanism at {time}: increase the number of steps",
            time=_at(results, lost),
        )
    if isfinite(stop):
        yield Sentence(
            "at {time} the determinant of the equations is zero: they do not determine the velocities",
            time=_at(results, stop),
        )


def _failure(results: IntegrationResults) -> Failure | None:
    stops = list(_stops(results))
    if not stops:
        return None
    # steps that are too coarse are told with their repair
    ends = isfinite(results.integration.attrs["stop_time"])
    repair = Sentence("choose a range that ends before it, or change the dimensions") if ends else NOTHING
    return Failure(Joined(stops, "; "), repair)


def _at(results: IntegrationResults, time: float) -> Text:
    """A time [s], with the value of the only drive where it is even."""
    parameter = results.mechanism.motion_parameter
    if not parameter.is_uniform:
        return place_number(time, "s")
    value = parameter.value_at(time, float(parameter.values(results.integration)[0]))
    return Sentence(
        "{time} ({drive} at {value})",
        time=place_number(time, "s"),
        drive=Name(parameter.drives[0].label),
        value=place_number(value, parameter.variable.unit),
    )


def _events(results: IntegrationResults) -> Text:
    """Limits and change points of the closed forms in the range, each once."""
    unit = str(results.integration["event_value"].attrs["units"])
    places: dict[tuple[EventKind, str], Text] = {}
    for value, kind in events_of(results.integration):
        at = place_number(value, unit)
        text = (
            Sentence("limit at {value}", value=at)
            if kind is EventKind.LIMIT
            else Sentence("change point at {value}", value=at)
        )
        # several groups may lock at one place
        places.setdefault((kind, format(value, at.digits)), text)
    return Joined(list(places.values()), "; ") if places else Sentence("no obstacle")


def _drift(results: IntegrationResults) -> Text:
    drift = np.abs(results.integration["drift"].values)
    if not np.isfinite(drift).any():
        return Sentence("none")
    _row, column = np.unravel_index(int(np.nanargmax(drift)), drift.shape)
    return Sentence(
        "{value} of the greatest length ({constraint})",
        value=Number(float(np.nanmax(drift)), digits=".1e"),
        constraint=_constraint(str(results.integration["constraint"].values[column])),
    )


def _constraint(name: str) -> Text:
    """A constraint that is written as an equation: of a gear or a wheel in words, else by its symbol ("x_C")."""
    if name.startswith(GEAR):
        return Sentence("gear {name}", name=Name(name.removeprefix(GEAR)))
    if name.startswith(ROLLING):
        return Sentence("wheel {name}", name=Name(name.removeprefix(ROLLING)))
    return constraint_text(name)


def _small(value: float, unit: str = "1") -> Number:
    """Two figures of a small number in SI; nothing as nothing."""
    return Number(value, unit, ".1e" if value else ".6g", unit_fixed=True)


def _difference(results: IntegrationResults) -> Text:
    """Worst angle and worst place against the closed forms."""
    found: list[Text] = []
    for name, dimension in (("angle_difference", "link"), ("position_difference", "point")):
        variable = results.integration[name]
        values = np.abs(variable.values)
        if not np.isfinite(values).any():
            continue
        _row, column = np.unravel_index(int(np.nanargmax(values)), values.shape)
        worst = _small(float(np.nanmax(values)), str(variable.attrs["units"]))
        where = Name(str(results.integration[dimension].values[column]))
        found.append(Sentence("{value} ({remark})", value=worst, remark=where) if worst.value else worst)
    return Joined(found) if found else Sentence("none")


def _return(results: IntegrationResults) -> Text:
    attributes = results.integration.attrs
    own, closed = attributes["return_difference"], attributes["closed_return_difference"]
    if not isfinite(own):
        return Sentence("not reached")
    if closed > RETURNS:
        return Sentence(
            "does not repeat the first: difference {own}, in closed form {closed}",
            own=Number(own, digits=".3g"),
            closed=Number(closed, digits=".3g"),
        )
    return (
        Sentence("repeats the first within {own}", own=_small(own)) if own else Sentence("repeats the first")
    )


# Table


def _table(results: IntegrationResults) -> Table:
    """What a motion's table has of it, then drift and differences, and the status."""
    chosen = results.integration.sel(point=list(results.mechanism.moving_points))
    found = [*numeric_columns(chosen), *(one for name in BEHIND for one in columns_of(chosen[name], name))]
    columns = [Column(name, values.values, unit) for name, unit, values in found]
    words = tuple(Name(Status(code).word) for code in chosen["status"].values.tolist())
    return Table((*columns, Column("status", words)))


# Figures


def _pictures(results: IntegrationResults) -> Iterator[tuple[str, Plot]]:
    """Integrated curves over those in closed form, and the errors."""
    mechanism = results.mechanism
    closed, integrated = (
        PlottedMotion(mechanism, dataset, 1.0) for dataset in (results.closed, results.integration)
    )
    under, over = over_time(results.closed), over_time(results.integration)
    for name, title in (
        ("integrated-angles", Sentence("Angles of the links over time")),
        ("integrated-angular-velocities", Sentence("Angular velocities of the links over time")),
        ("integrated-velocities", Sentence("Velocities of the points over time")),
        ("integrated-slides", Sentence("Motion along the guides over time")),
    ):
        below, above = _panels(name, closed), _panels(name, integrated)
        if any(panel.curves for row in below for panel in row):
            overlay = Overlay(Sentence("integrated"), over, above)
            yield name, Plot(title, Title(mechanism.title), under, below, overlay)
    shown = (results.integration[name].values for name in ("drift", "angle_difference"))
    if any((np.abs(values) > ROUNDING).any() for values in shown):
        yield ERRORS, _errors(results)


def _panels(name: str, motion: PlottedMotion) -> Rows:
    """Panels of a figure; the equations that are integrated give no accelerations."""
    match name:
        case "integrated-angles":
            return panels_of_links(motion, "angle")
        case "integrated-angular-velocities":
            return panels_of_links(motion, "angular_velocity")
        case "integrated-velocities":
            return panels_of_points(motion, "velocity")
        case _:
            return panels_of_guides(motion, ("slide", "slide_velocity"))


def _errors(results: IntegrationResults) -> Plot:
    """Drift of the constraints and differences of the angles from the closed forms."""
    integration, mechanism = results.integration, results.mechanism
    difference = integration["angle_difference"]
    drift = CurvePanel(
        AxisLabel(Sentence("drift, greatest length = {one}", one=Number(1, digits="d"))),
        tuple(
            Curve(_constraint(name), integration["drift"].sel(constraint=name).values, place)
            for place, name in enumerate(integration["constraint"].values.tolist())
        ),
    )
    angles = CurvePanel(
        AxisLabel(symbol=Symbol("|Δφ|"), unit="rad"),
        tuple(
            Curve(Name(name), difference.sel(link=name).values, place)
            for place, name in enumerate(mechanism.link_names)
            if difference.sel(link=name).any()
        ),
    )
    return Plot(
        Sentence("Drift of the constraints, and difference from the closed-form solution"),
        Title(mechanism.title),
        over_time(integration),
        ((drift,), (angles,)),
        sizes_above=ROUNDING,
    )


# Chapter


def _chapter(results: IntegrationResults, facts: tuple[Fact, ...]) -> Chapter:
    """The second route: the equations in Cauchy form integrated, beside the closed forms; fixed steps where wished."""
    integration = results.integration
    worst = float(np.nanmax(np.abs(integration["angle_difference"].values), initial=0.0))
    check = Check(
        Sentence(
            "Where the equations can be integrated, they give the angles of the closed-form solution: the "
            "greatest difference is {worst}, at a tolerance of {tolerance} for each step.",
            worst=_small(worst, "rad"),
            tolerance=_small(integration.attrs.get("tolerance", 0.0)),
        ),
        worst,
        1.0,
        AGREE,
    )
    caption = Sentence("Difference of the integrated motion from the closed-form solution")
    sections: tuple[Section, ...] = (
        Section(NOTHING, (FactTable(facts),), detail=True),
        Section(NOTHING, (check,)),
        Section(NOTHING, (Illustration(ERRORS, caption),), detail=True),
    )
    if results.fixed is not None:
        fixed = replace(results, integration=results.fixed)
        sections = (
            *sections,
            Section(Sentence("Fixed steps of the Runge-Kutta method"), tuple(_fixed_steps(fixed))),
        )
    return Chapter(Sentence("Integration of the equations"), sections)


def _fixed_steps(results: IntegrationResults) -> Iterator[Block]:
    """Rows by fixed steps as a program of an assignment prints them, and their errors over the range."""
    integration = results.integration
    worst = np.abs(integration["angle_difference"].values)
    yield Paragraph(
        Sentence(
            "{method}. The columns are those of a table of fixed steps: time, angles, and how far each angle is from"
            " the closed-form solution; the greatest difference is {worst}.",
            method=_method(results),
            worst=_small(float(np.nanmax(worst, initial=0.0)), "rad"),
        )
    )
    for stop in _stops(results):
        yield Paragraph(stop, clause=True)
    yield _fixed_rows(results)
    yield Illustration(_errors(results), Sentence("Drift and error of the fixed steps over the range"))


def _fixed_rows(results: IntegrationResults) -> Table:
    """Time, angles and errors of the angles of the links that move, in rows at even steps."""
    integration = results.integration
    columns = [Column("", integration["time"].values, "s", Expression("t"))]
    angles = {name: integration["angle"].sel(link=name).values for name in results.mechanism.link_names}
    moving = {name: values for name, values in angles.items() if np.ptp(values[np.isfinite(values)]) > 0}
    for name, values in moving.items():
        columns.append(Column("", values, "rad", Expression("phi_({name})", name=Name(name))))
    for name in moving:
        errors = integration["angle_difference"].sel(link=name).values
        if np.nanmax(np.abs(errors), initial=0.0) > ROUNDING:
            head = Joined((Expression("Delta phi_({name})", name=Name(name)), Unit("rad")))
            cells = tuple(NOTHING if np.isnan(one) else _small(float(one)) for one in errors)
            columns.append(Column("", cells, head=head))
    rows = rows_reached(integration["status"])
    return Table(tuple(columns), Sentence("Rows of the integration by fixed steps"), rows)
