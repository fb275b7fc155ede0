"""Accuracy of a mechanism: what the terminal, the files, the figures and the document show."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.charts import HistogramPanel, Histograms, NamedBarChart, NamedBars
from centrode.sheets.plots import AxisLabel, Band, Curve, CurvePanel, CurveRole, Plot
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Column,
    Deferred,
    Fact,
    Failure,
    Illustration,
    Paragraph,
    Scalar,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Counted, Joined, Name, Number, Sentence, Text, Title, Unit
from centrode.views.abscissa import motion_abscissa
from centrode.views.columns import drive_units

if TYPE_CHECKING:
    from centrode.model.motion_parameter import MotionVariable
    from centrode.tolerances.assembly_in_limits import LimitStop
    from centrode.tolerances.results import OutputAccuracy, ToleranceResults

Array: TypeAlias = NDArray[np.float64]

DISTRIBUTIONS = {
    "normal": Sentence("normal, limits at three standard deviations"),
    "uniform": Sentence("uniform between the limits"),
    "triangular": Sentence("triangular"),
}
TRUE = Sentence("worst case, true")
_ROUNDING = 1e-12
"""A share below this part of the greatest is the rounding of derivatives."""
MOST_BARS = 10
"""Bars of one output: the table has all numbers."""
STATISTICAL = Sentence("three standard deviations")
OUTPUT = Sentence("output")
REST = Sentence(
    "Play is that of joints at rest: between which positions an output may lie. "
    "It says nothing of impacts and vibrations."
)


def sheet(results: ToleranceResults) -> Sheet:
    """Deviations of the outputs, contributions of the numbers, play, and a chapter of a document."""
    sampled = [output for output in results.outputs if output.of_samples]
    single = [output for output in results.outputs if not output.of_samples and output.drawn is not None]
    return Sheet(
        facts=tuple(_facts(results)),
        scalars=_scalars(results),
        tables=Deferred(
            {
                "outputs": lambda: outputs_table(results),
                "contributions": lambda: contributions_table(results, derivatives=True),
                **({"bands": lambda: _bands_table(results, sampled)} if sampled else {}),
                **({"histogram": lambda: _histogram_table(single)} if single else {}),
                **({"play": lambda: _play_table(results)} if _has_play(results) else {}),
            }
        ),
        pictures=Deferred(
            {
                "contributions": lambda: _contributions(results),
                **({"band": lambda: _bands(results, sampled)} if sampled else {}),
                **({"histogram": lambda: _histograms(results, single)} if single else {}),
            }
        ),
        printed=tuple(_printed_results(results)),
        chapters={"accuracy": _chapter(results, bool(sampled), bool(single))},
        failure=_failure(results),
        notes=(REST,) if _has_play(results) else (),
    )


def _has_play(results: ToleranceResults) -> bool:
    return any(output.clearance is not None for output in results.outputs)


# Facts: what deviates, and whether all mechanisms move.


def _facts(results: ToleranceResults) -> Iterator[Fact]:
    count = len(results.limits.paths)
    yield Fact(
        Sentence("numbers that deviate"),
        Joined(
            (
                Counted("{n} number", "{n} numbers", count),
                DISTRIBUTIONS[results.limits.distribution],
            ),
            ", ",
        ),
    )
    yield Fact(Sentence("mechanisms within the limits"), _moves(results))
    first = results.assembly.first
    if first is not None:
        yield Fact(Sentence("stops first"), _stop(results, first))
    for output in results.outputs:
        if output.within is not None:
            yield Fact(Sentence("bounds of {output}", output=Name(output.name)), _bounds(output))


def _moves(results: ToleranceResults) -> Text:
    found = results.assembly
    corners = Number(found.corners, digits=".0f")
    drawn = Number(found.drawn, digits=".0f")
    if found.moves and found.all_corners:
        return Sentence("all move: {corners} corners, {drawn} drawn", corners=corners, drawn=drawn)
    if found.moves:
        return Sentence(
            "all move that were looked at: {corners} of the corners, {drawn} drawn",
            corners=corners,
            drawn=drawn,
        )
    return Sentence(
        "{stopped} of {corners} corners and {lost} of {drawn} drawn ones do not move as the description does",
        stopped=Number(found.stopped_corners, digits=".0f"),
        corners=corners,
        lost=Number(found.stopped_drawn, digits=".0f"),
        drawn=drawn,
    )


def _stop(results: ToleranceResults, stop: LimitStop) -> Text:
    share = Number(100.0 * stop.share, "%", ".4g")
    if math.isnan(stop.at):
        return Sentence("at {share} of the tolerances: it does not assemble", share=share)
    variable: MotionVariable = results.mechanism.motion_parameter.variable
    return Sentence(
        "at {share} of the tolerances: group {group} locks at {place}",
        share=share,
        group=Name(stop.group),
        place=Number(stop.at, variable.unit, degrees_too=True),
    )


def _bounds(output: OutputAccuracy) -> Text:
    words = Sentence("kept in the worst case") if output.is_kept else Sentence("not kept in the worst case")
    kept = None if output.drawn is None else output.drawn.kept
    if kept is None:
        return words
    shares = [Number(100.0 * x, "%", ".4g") for x in (kept.share, kept.low, kept.high)]
    yields = Sentence(
        "yield {share} of those drawn ({low} to {high} with {confidence} confidence)",
        share=shares[0],
        low=shares[1],
        high=shares[2],
        confidence=Number(95.0, "%", ".3g"),
    )
    return Joined((words, yields), ", ")


def _failure(results: ToleranceResults) -> Failure | None:
    first = results.assembly.first
    if first is None:
        return None
    return Failure(
        Sentence("within its limits the mechanism falls apart: {what}", what=_stop(results, first)),
        Sentence("narrow the limits, or change the dimensions"),
    )


def _scalars(results: ToleranceResults) -> dict[str, Scalar]:
    found = {}
    for output in results.outputs:
        values = {
            "nominal": output.at_worst(output.nominal),
            "linear_lower": output.at_worst(output.linear.lower),
            "linear_upper": output.at_worst(output.linear.upper),
            "true_lower": output.at_worst(output.true.lower),
            "true_upper": output.at_worst(output.true.upper),
            "three_sigma": output.at_worst(output.statistics.half),
        }
        for name, value in values.items():
            found[f"{output.name}.{name}"] = Scalar(value, output.unit)
        if output.drawn is not None and output.drawn.kept is not None:
            found[f"{output.name}.yield"] = Scalar(output.drawn.kept.share, "1")
    return found


# Tables.


def outputs_table(results: ToleranceResults, caption: Text = NOTHING) -> Table:
    """Each output with its nominal value and its deviations; of an output of samples at the worst one."""
    outputs = results.outputs
    units = tuple(output.unit for output in outputs)

    def column(name: str, head: Text, values: list[float]) -> Column:
        return Column(name, np.array(values), head=head, units=units)

    def of(values: list[Array]) -> list[float]:
        return [output.at_worst(one) for output, one in zip(outputs, values, strict=True)]

    columns = [
        Column("output", tuple(Name(output.name) for output in outputs), head=OUTPUT),
        column("nominal", Sentence("nominal"), of([o.nominal for o in outputs])),
        column("linear_lower", Sentence("linear, lower"), of([o.linear.lower for o in outputs])),
        column("linear_upper", Sentence("linear, upper"), of([o.linear.upper for o in outputs])),
        column("true_lower", Sentence("true, lower"), of([o.true.lower for o in outputs])),
        column("true_upper", Sentence("true, upper"), of([o.true.upper for o in outputs])),
        column("three_sigma", Sentence("statistical ±"), of([o.statistics.half for o in outputs])),
        Column("unit", tuple(_unit(output.unit) for output in outputs), head=Sentence("unit")),
    ]
    if any(output.of_samples for output in outputs):
        variable = results.mechanism.motion_parameter.variable
        values = _abscissa_values(results)
        places = np.array([values[o.worst] if o.of_samples else np.nan for o in outputs])
        columns.append(Column("at", places, variable.unit, head=Sentence("worst at")))
    if _has_play(results):
        play = [
            np.array(np.nan) if o.clearance is None else np.asarray(o.clearance.first_order) for o in outputs
        ]
        columns.append(
            column(
                "play", Sentence("play ±"), [float(np.nanmax(one)) if one.size else math.nan for one in play]
            )
        )
    return Table(tuple(columns), caption)


def _unit(unit: str) -> Text:
    return NOTHING if unit == "1" else Unit(unit, shown=True)


def _abscissa_values(results: ToleranceResults) -> Array:
    if results.mechanism.motion_parameter.is_uniform:
        return np.asarray(results.motion["drive_value"].isel(drive=0).to_numpy())
    return np.asarray(results.motion["time"].to_numpy())


def contributions_table(
    results: ToleranceResults, caption: Text = NOTHING, *, derivatives: bool = False
) -> Table:
    """Each number with its limits, and what it contributes to the variance of each output.

    With `derivatives` also those of the outputs by the numbers.
    """
    limits = results.limits
    units = tuple(results.units)
    columns = [
        Column("path", tuple(map(Name, limits.paths)), head=Sentence("dimension or mass")),
        Column("value", limits.values, head=Sentence("nominal"), units=units),
        Column("lower", limits.lower, head=Sentence("lower deviation"), units=units),
        Column("upper", limits.upper, head=Sentence("upper deviation"), units=units),
    ]
    for output in results.outputs:
        shares = output.statistics.contributions
        shown = shares[output.worst] if output.of_samples else shares
        slopes = output.gradient[output.worst] if output.of_samples else output.gradient
        name = Name(output.name)
        if derivatives:
            columns.append(
                Column(
                    f"derivative of {output.name}",
                    np.asarray(slopes),
                    head=Sentence("derivative of {output}, SI", output=name),
                    unit_fixed=True,
                )
            )
        columns.append(
            Column(
                f"contribution to {output.name}",
                shares_above_rounding(100.0 * shown),
                "%",
                head=Sentence("contribution to {output}", output=name),
            )
        )
    return Table(tuple(columns), caption)


def shares_above_rounding(shares: Array) -> Array:
    """Shares of one output with zero where a share is the rounding of derivatives: what adds nothing adds 0."""
    sizes = np.abs(np.asarray(shares, dtype=float))
    greatest = np.nanmax(sizes, initial=0.0)
    return np.where(sizes <= _ROUNDING * greatest, 0.0, shares)


def _bands_table(results: ToleranceResults, sampled: list[OutputAccuracy]) -> Table:
    motion = results.motion
    columns = [Column("time", motion["time"].to_numpy(), "s")]
    columns += [
        Column(f"drive_{name}", motion["drive_value"].to_numpy()[:, number], drive_units(motion)[number])
        for number, name in enumerate(motion["drive"].to_numpy().tolist())
    ]
    for output in sampled:
        numbers = {
            "nominal": output.nominal,
            "linear lower": output.linear.lower,
            "linear upper": output.linear.upper,
            "true lower": output.true.lower,
            "true upper": output.true.upper,
            "three sigma": output.statistics.half,
        }
        if output.clearance is not None:
            numbers["play"] = output.clearance.first_order
            if output.clearance.by_force is not None:
                numbers["play by force"] = output.clearance.by_force
        columns += [Column(f"{output.name} {name}", values, output.unit) for name, values in numbers.items()]
    return Table(tuple(columns))


def _histogram_table(single: list[OutputAccuracy]) -> Table:
    rows: list[tuple[str, float, float, int, str]] = []
    for output in single:
        assert output.drawn is not None
        bins = output.drawn.bins
        rows += [
            (output.name, low, high, int(count), output.unit)
            for low, high, count in zip(bins, bins[1:], output.drawn.counts, strict=False)
        ]
    names, low, high, counts, units = zip(*rows, strict=True)
    return Table(
        (
            Column("output", tuple(map(Name, names)), head=OUTPUT),
            Column("from", np.array(low), units=units),
            Column("to", np.array(high), units=units),
            Column("mechanisms", np.array(counts), whole=True),
        )
    )


def _play_table(results: ToleranceResults, caption: Text = NOTHING) -> Table:
    """Each joint with its play, and what it adds to the deviation of each output at its worst sample."""
    extents = [(output, output.clearance) for output in results.outputs if output.clearance is not None]
    joints = extents[0][1].joints
    columns = [
        Column("joint", tuple(Name(joint.name) for joint in joints), head=Sentence("joint")),
        Column(
            "play",
            np.array([joint.play for joint in joints]),
            "m" if results.mechanism.space == "plane" else "rad",
            head=Sentence("play"),
        ),
    ]
    for output, extent in extents:
        shares = extent.shares
        if shares.ndim > 1:
            whole = extent.first_order
            shares = shares[int(np.nanargmax(whole))] if np.isfinite(whole).any() else shares[0]
        columns.append(
            Column(
                output.name,
                shares_above_rounding(shares),
                output.unit,
                head=Sentence("adds to {output}", output=Name(output.name)),
            )
        )
    return Table(tuple(columns), caption)


def _printed_results(results: ToleranceResults) -> Iterator[Section]:
    yield Section(Sentence("Deviations of the outputs"), (outputs_table(results),))
    yield Section(Sentence("Contributions to the variance"), (contributions_table(results),))
    if _has_play(results):
        yield Section(Sentence("Play in joints"), (_play_table(results),))


# Figures.


def _contributions(results: ToleranceResults) -> NamedBarChart:
    """What each number contributes to the variance of each output, the greatest first."""
    panels = []
    for output in results.outputs:
        shares = output.statistics.contributions
        shown = 100.0 * (shares[output.worst] if output.of_samples else shares)
        order = np.argsort(-np.abs(shown), kind="stable")[:MOST_BARS]
        names = tuple(Name(results.limits.paths[k]) for k in order)
        panels.append(NamedBars(Name(output.name), names, shown[order]))
    label = AxisLabel(Sentence("contribution to the variance"), unit="%", unit_fixed=True)
    return NamedBarChart(
        Sentence("Contributions of the numbers"), Title(results.mechanism.title), label, tuple(panels)
    )


def _bands(results: ToleranceResults, sampled: list[OutputAccuracy]) -> Plot:
    """Deviations of each output over the cycle: bands about the nominal curve."""
    rows = []
    for output in sampled:
        label = AxisLabel(Sentence("deviation of {output}", output=Name(output.name)), unit=output.unit)
        half = output.statistics.half
        middle = output.statistics.shift
        bands = (
            Band(TRUE, output.true.lower, output.true.upper, 0),
            Band(STATISTICAL, middle - half, middle + half, 1),
        )
        curves = [
            Curve(Sentence("linear, upper"), output.linear.upper, 0, approximate=True),
            Curve(Sentence("linear, lower"), output.linear.lower, 0, approximate=True),
        ]
        if output.clearance is not None:
            curves += [
                Curve(Sentence("play, upper"), output.clearance.first_order, 2),
                Curve(Sentence("play, lower"), -output.clearance.first_order, 2),
            ]
            if output.clearance.by_force is not None:
                curves.append(
                    Curve(Sentence("play by the forces"), output.clearance.by_force, 3, role=CurveRole.THING)
                )
        scale = float(np.nanmax(np.abs(output.linear.upper), initial=0.0))
        rows.append((CurvePanel(label, tuple(curves), scale, bands=bands),))
    return Plot(
        Sentence("Deviations within the limits"),
        Title(results.mechanism.title),
        motion_abscissa(results.mechanism, results.motion),
        tuple(rows),
    )


def _histograms(results: ToleranceResults, single: list[OutputAccuracy]) -> Histograms:
    panels = []
    for output in single:
        assert output.drawn is not None
        levels: list[tuple[Text, float]] = [(Sentence("nominal"), float(output.nominal))]
        if output.within is not None:
            levels += [(Sentence("bounds"), float(one)) for one in output.within]
        ends = (output.true.lower, output.true.upper)
        levels += [(TRUE, float(output.nominal + one)) for one in ends]
        label = AxisLabel(Name(output.name), unit=output.unit)
        counts = output.drawn.counts.astype(np.float64)
        panels.append(HistogramPanel(label, output.drawn.bins, counts, tuple(levels)))
    return Histograms(
        Sentence("Drawn mechanisms"),
        Title(results.mechanism.title),
        Sentence("mechanisms"),
        tuple(panels),
    )


# The chapter of a document.


def _chapter(results: ToleranceResults, sampled: bool, single: bool) -> Chapter:
    sections = [
        Section(NOTHING, (*_introduction(), Paragraph(_moves_sentence(results)))),
        Section(
            Sentence("Deviations of the outputs"),
            (
                outputs_table(
                    results, Sentence("Deviations; of curves at the place where they are greatest")
                ),
                *_illustrations(sampled, "band", Sentence("Deviations over the cycle")),
                *_illustrations(single, "histogram", Sentence("Drawn mechanisms with the bounds")),
            ),
        ),
        Section(
            Sentence("Contributions to the variance"),
            (
                contributions_table(results, Sentence("Limits of the numbers, and what they contribute")),
                Illustration("contributions", Sentence("Contributions of the numbers to the variance")),
            ),
        ),
    ]
    if _has_play(results):
        sections.append(
            Section(
                Sentence("Play in joints"),
                (Paragraph(REST), _play_table(results, Sentence("What each joint adds at most"))),
            )
        )
    return Chapter(Sentence("Accuracy of the mechanism"), tuple(sections))


def _illustrations(there: bool, name: str, caption: Text) -> tuple[Block, ...]:
    return (Illustration(name, caption),) if there else ()


def _introduction() -> Iterator[Block]:
    yield Paragraph(
        Sentence(
            "Every number of the mechanism lies within its limits. In the linear worst case every number lies at the "
            "limit to which the derivative of the output points; the true one is that of the mechanisms at the corners "
            "of the limits. The statistical deviation is three times the root of the sum of the squares of derivative "
            "times standard deviation."
        )
    )


def _moves_sentence(results: ToleranceResults) -> Text:
    return Sentence("Mechanisms within the limits: {what}.", what=_moves(results))
