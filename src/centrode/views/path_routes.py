"""The three routes to the path of a cam's roller: what the terminal, the files, the figure and the document show."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from centrode.sheets.plots import AxisLabel, Curve, CurvePanel, Plot
from centrode.sheets.sheet import (
    Chapter,
    Check,
    Column,
    Deferred,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Paragraph,
    Scalar,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Counted, Joined, Name, Number, Sentence, Symbol, Text, Title, Unit
from centrode.views.curvature_cams import ROUNDED, angle, carrier_table, over_carrier

if TYPE_CHECKING:
    import xarray as xr

    from centrode.cams.cam import PathRoutesResults

VARIABLES = (
    "path_radius",
    "pressure_sine",
    "pressure_sine_slope",
    "radius_by_slope",
    "parting",
    "foretold_error",
    "series_error",
    "routes_difference",
)
MOST_LINES = 19
PLACES = 3
"""So many places at which formula (16) has no meaning are named."""
REAL = 1e-12
"""Imaginary part [rad] below which a singularity lies at a real angle."""
LEAST_DRAWN = 1e-17
"""Differences [m] below this are not drawn."""
DIFFERENCES = {
    "parting": Sentence("series: ({second}) minus ({slope})", second=Number(16), slope=Number(15)),
    "foretold_error": Sentence("series: estimated from its next terms"),
    "series_error": Sentence("series minus steps"),
    "routes_difference": Sentence("integrated minus steps"),
}
BY_SECOND, BY_SLOPE = Number(16), Number(15)
"""Numbers of the two formulas of the radius in the paper."""


def sheet(results: PathRoutesResults) -> Sheet:
    """Everything there is to say about the routes to a path."""
    return Sheet(
        heading=Sentence("Three routes to the path"),
        facts=tuple(_facts(results)),
        scalars=_scalars(results),
        printed=(_table(results),),
        tables=Deferred({"cam-routes": lambda: carrier_table(results.dataset, VARIABLES)}),
        datasets={"cam-routes": results.dataset},
        pictures=Deferred({"cam-routes": lambda: _plot(results)}),
        chapters=Deferred({"routes": lambda: _chapter(results)}),
    )


# Facts and numbers


def _facts(results: PathRoutesResults) -> Iterator[Fact]:
    facts = results.dataset.attrs
    yield Fact(Sentence("(a) one series"), _series(results))
    if results.without_series:
        lost = Sentence(
            "it gives no path at {count} of {of} samples: the sine η is beyond {one} there",
            count=Number(results.without_series, digits="d"),
            of=Number(results.dataset.sizes["sample"], digits="d"),
            one=Number(1),
        )
        yield Fact(NOTHING, lost)
    yield Fact(NOTHING, _convergence(facts))
    yield Fact(NOTHING, _validity(results))
    steps = Counted(
        "{n} series of degree {order} expanded anew, tolerance {tolerance}",
        "{n} series of degree {order} expanded anew, tolerance {tolerance}",
        int(facts["steps"]),
        order=Number(int(facts["order"])),
        tolerance=Number(facts["tolerance"], digits="g"),
    )
    yield Fact(Sentence("(b) by steps"), steps)
    integrated = Sentence(
        "Runge-Kutta of eighth order along the arc: {share} of ρ from (b) at most",
        share=Number(facts["worst_difference"], digits=".1e"),
    )
    yield Fact(Sentence("(c) integrated"), integrated)
    if math.isfinite(facts["stall"]):
        apart = Number(abs(facts["stall"] - facts["stall_integrated"]), "rad", ".1e", unit_fixed=True)
        yield Fact(Sentence("stall by two routes"), Sentence("(b) and (c) differ by {apart}", apart=apart))


def _series(results: PathRoutesResults) -> Sentence:
    """The cut series and its greatest error."""
    term, zero = Symbol("a", str(int(results.dataset.attrs["terms"])), slanted=True), Number(0.0)
    if math.isnan(results.series_error):
        return Sentence(
            "power series about φ = {zero}, truncated after {term}: no sample to compare it at",
            zero=zero,
            term=term,
        )
    return Sentence(
        "power series about φ = {zero}, truncated after {term}: greatest error of ρ {error}",
        zero=zero,
        term=term,
        error=Number(results.series_error, "m", ".3g"),
    )


def _convergence(facts: Mapping[str, Any]) -> Sentence:
    """How far the series converges, and how that is known."""
    radius, estimate = facts["radius_of_convergence"], facts["radius_by_coefficients"]
    if math.isnan(radius):
        return Sentence(
            "its radius of convergence is unknown: its coefficients exceed the range of floating-point numbers"
        )
    if math.isinf(radius):
        return Sentence("the series terminates: its further coefficients vanish, it converges everywhere")
    x, y = facts["singularity"]
    if not math.isfinite(x):
        return Sentence(
            "it converges up to about {radius} (estimated from its coefficients; no singularity was found)",
            radius=angle(radius, ".4g"),
        )
    place: Text = angle(x)
    if y > REAL:
        place = Joined((Number(x, "rad"), Number(y, "rad")), " ± i·")
    return Sentence(
        "it converges up to {radius}: cos γ = {zero} at φ = {place}; its coefficients alone give {estimate}",
        radius=angle(radius, ".7g"),
        zero=Number(0.0),
        place=place,
        estimate=angle(estimate, ".4g"),
    )


def _validity(results: PathRoutesResults) -> Sentence:
    """Where formulas (15) and (16) part, and the first break of the law."""
    facts = results.dataset.attrs
    if results.leaves_the_series:
        return Sentence(
            "the law has a break: the series is that of the path from {low} to {high} only",
            low=angle(facts["series_from"]),
            high=angle(facts["series_to"]),
        )
    if math.isnan(results.parting):
        return Sentence("formula ({second}) does not apply where the curvature is constant", second=BY_SECOND)
    parts = Sentence(
        "formulas ({slope}) and ({second}) differ by up to {parting}",
        slope=BY_SLOPE,
        second=BY_SECOND,
        parting=Number(results.parting, "m", ".3g"),
    )
    if not results.flat:
        return parts
    places: list[Text] = [angle(place) for place in results.flat[:PLACES]]
    if len(results.flat) > PLACES:
        places.append(Symbol("..."))
    return Sentence(
        "{parts}; where K′ = {zero} the comparison has no meaning: φ = {places}",
        parts=parts,
        zero=Number(0.0),
        places=Joined(places),
    )


def _scalars(results: PathRoutesResults) -> dict[str, Scalar]:
    facts = results.dataset.attrs
    scalars = {
        "cam_series_terms": Scalar(int(facts["terms"]), "1"),
        "cam_series_greatest_error": Scalar(results.series_error, "m"),
        "cam_routes_difference": Scalar(facts["worst_difference"], "1"),
    }
    if math.isfinite(facts["radius_of_convergence"]):
        scalars["cam_radius_of_convergence"] = Scalar(facts["radius_of_convergence"], "rad")
        scalars["cam_radius_of_convergence_by_coefficients"] = Scalar(facts["radius_by_coefficients"], "rad")
    return {name: scalar for name, scalar in scalars.items() if math.isfinite(scalar.value)}


# Table and figure


def _table(results: PathRoutesResults) -> Table:
    """The routes at the chosen angles, otherwise at a few of the samples, both ends among them."""
    shown = _few(results.dataset) if results.at_instants is None else results.at_instants
    radius, sine, slope = (
        shown[name].values.tolist() for name in ("path_radius", "pressure_sine", "pressure_sine_slope")
    )
    series, steps, rho = Name("(a)"), Name("(b)"), Symbol("ρ")
    columns = (
        Column("phi", _cells(shown["carrier_angle"].values.tolist(), "rad", ".6g"), "rad", Symbol("φ")),
        Column("rho_a", _cells(radius[0], "m", ".3f"), "m", Joined((series, rho), " ")),
        Column("rho_b", _cells(radius[1], "m", ".3f"), "m", Joined((steps, rho), " ")),
        Column("eta", _cells(sine[1], "1", ".6f"), head=Joined((steps, Symbol("η")), " ")),
        Column("eta_slope", _cells(slope[1], "1", ".6f"), head=Joined((steps, Symbol("η′")), " ")),
        _difference(shown, "series_error", Name("(a) − (b)")),
        _difference(shown, "foretold_error", Sentence("estimate")),
        _difference(shown, "parting", Name("(16) − (15)")),
        _difference(shown, "routes_difference", Name("(c) − (b)")),
    )
    unit = Unit("m", shown=True)
    return Table(
        columns,
        Sentence("Differences in {unit}; estimate: from the next four terms of the series", unit=unit),
    )


def _few(dataset: xr.Dataset) -> xr.Dataset:
    count = dataset.sizes["sample"]
    if count <= MOST_LINES:
        return dataset
    return dataset.isel(sample=np.round(np.linspace(0, count - 1, MOST_LINES)).astype(int))


def _cells(values: list[float], unit: str, digits: str) -> tuple[Number, ...]:
    """Numbers without their unit; a plain one that its digits would show as nothing has no sign."""
    least = 0.5e-6 if unit == "1" else 0.0
    return tuple(
        Number(0.0 if abs(value) < least else value, unit, digits, unit_hidden=True) for value in values
    )


def _difference(shown: xr.Dataset, name: str, head: Text) -> Column:
    """A small difference of the radius: its size alone matters, nothing is nothing."""
    cells = (
        Number(value, "m", ".1e" if value else ".6g", unit_hidden=True)
        for value in shown[name].values.tolist()
    )
    return Column(name, tuple(cells), head=head)


def _plot(results: PathRoutesResults) -> Plot:
    """What parts the routes, on a logarithmic scale, with the circle of convergence."""
    curves = []
    for place, (name, text) in enumerate(DIFFERENCES.items()):
        values = results.dataset[name].values
        curves.append(Curve(text, np.where(np.abs(values) > LEAST_DRAWN, values, np.nan), place))
    facts = results.dataset.attrs
    radius, circle = facts["radius_of_convergence"], Sentence("circle of convergence")
    return Plot(
        Sentence(
            "Differences of the radius, series truncated after {last}",
            last=Symbol("a", str(int(facts["terms"])), slanted=True),
        ),
        Title(results.cam.title),
        over_carrier(results.dataset),
        ((CurvePanel(AxisLabel(symbol=Symbol("|Δρ|"), unit="m"), tuple(curves)),),),
        sizes_above=0.0,
        places=((circle, -radius), (circle, radius)) if math.isfinite(radius) else (),
    )


# Chapter


def _chapter(results: PathRoutesResults) -> Chapter:
    """One power series, series expanded anew, an integrator, beside each other."""
    text = Sentence(
        "(a) one power series about $phi = 0$, truncated; (b) series expanded anew step by step, by which "
        "everything else is computed; (c) a Runge-Kutta method along the arc of the path, which shares neither "
        "variable nor method with the others."
    )
    formulas = Formula(
        (
            ("eta", "sum_(n = 0)^N a_n phi^n"),
            ("sqrt(1 - eta^2)", "sum_(n = 0)^N b_n phi^n"),
            ("rho_((15))", "frac(sqrt(1 - eta^2) - eta', K)"),
            ("rho_((16))", "-frac(eta'' + eta, K')"),
        )
    )
    facts = results.dataset.attrs
    agree = Check(
        Sentence("The integrated path differs from the one by steps by {share} of its radius."),
        facts["worst_difference"],
        1.0,
        facts["tolerance"] * (1.0 + facts["steps"]) + ROUNDED,
    )
    blocks = (
        Paragraph(text),
        formulas,
        FactTable(tuple(_facts(results))),
        _table(results),
        agree,
        Illustration("cam-routes", Sentence("Differences between the routes")),
    )
    return Chapter(Sentence("Three routes to the path"), (Section(NOTHING, blocks),))
