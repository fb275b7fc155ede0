"""The parameters chosen for a cam: measures, the bounds that bind, the proof, what another bound would cost."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.parameter_choice.problem import MEASURES
from centrode.model.cam import CONSTANT, POINT
from centrode.model.cam_files import cam_text
from centrode.sheets.charts import DesignDot, FrontDiagram, FrontPanel
from centrode.sheets.plots import AxisLabel
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Column,
    Deferred,
    Fact,
    FactTable,
    Failure,
    Paragraph,
    Scalar,
    Section,
    Sheet,
    Table,
    illustrations,
)
from centrode.sheets.texts import NOTHING, Counted, Joined, Name, Number, Sentence, Symbol, Text, Title
from centrode.views.curvature_cams import MEGA, shortfall

if TYPE_CHECKING:
    from centrode.cams.parameter_choice.search import CamChoice, CamDesign, TradeOff
    from centrode.model.cam import Cam

SYMBOLS: Mapping[str, tuple[Symbol, str]] = {
    "curvature.k0": (Symbol("k", "0", slanted=True), "1/m"),
    "curvature.k1": (Symbol("k", "1", slanted=True), "1/rad"),
    "start.radius": (Symbol("ρ", "0", slanted=True), "m"),
    "start.pressure_angle": (Symbol("γ", "0", slanted=True), "rad"),
    "roller.radius": (Symbol("r"), "m"),
}
"""Letter and SI unit of each parameter."""
LEAST_EXCESS = 1e-9
"""What a bound may be missed by in the search."""
NEAR = 0.02
"""An end of a range is drawn where it lies within this part of the front's values."""


def sheet(results: CamChoice) -> Sheet:
    """Everything there is to say about chosen parameters."""
    chosen = results.choice.chosen
    scalars = {
        f"chosen.{name}": Scalar(value, parameter_unit(results.cam, name))
        for name, value in chosen.parameters.items()
    }
    for name in results.measures:
        scalars[f"chosen.{name}"] = Scalar(chosen.measures[name].value, MEASURES[name].unit)
    front = results.front
    drawn = front is not None and bool(front.designs)
    return Sheet(
        heading=Sentence("Chosen parameters"),
        facts=tuple(_facts(results)),
        scalars=scalars,
        printed=(_parameters(results), _measures(results)),
        tables=Deferred({"cam-choice": lambda: _designs(results)}),
        pictures=Deferred({"cam-choice": lambda: _diagram(results)} if drawn else {}),
        chapters=Deferred({"choice": lambda: _chapter(results)}),
        files={"chosen.toml": cam_text(results.cam)} if results.choice.admissible else {},
        failure=_failure(results),
    )


def parameter_symbol(name: str) -> Symbol:
    """Letter of a parameter; a spline's points are numbered, a formula's constants as they are."""
    if POINT.fullmatch(name):
        return Symbol("K", name.rpartition(".")[2], slanted=True)
    return Symbol(name.rpartition(".")[2]) if CONSTANT.fullmatch(name) else SYMBOLS[name][0]


def parameter_unit(cam: Cam, name: str) -> str:
    """SI unit of a parameter: that of k1 depends on the law."""
    if name == "curvature.k1" and cam.curvature.law == "linear":
        return "1/m/rad"
    if CONSTANT.fullmatch(name):
        return "1"
    return SYMBOLS[name][1] if name in SYMBOLS else "1/m"


def _measure(name: str) -> Sentence:
    """What a measure is called."""
    return Sentence(MEASURES[name].title)


def _measure_unit(name: str) -> tuple[float, str, bool]:
    """Factor and unit in which a measure is shown, and whether that is fixed: stresses are in megapascals."""
    unit = MEASURES[name].unit
    return (MEGA, "MPa", True) if unit == "Pa" else (1.0, unit, False)


def _value(name: str, value: float) -> Number:
    """A value of a measure with its unit."""
    factor, unit, _fixed = _measure_unit(name)
    return Number(factor * value, unit)


# Facts and tables


def _facts(results: CamChoice) -> Iterator[Fact]:
    """What was made best, how the search ended, the bounds that bind, and the proof."""
    choice = results.choice
    yield Fact(Sentence("minimised"), _measure(choice.best))
    ended = Counted(
        "{agreeing} of {n} search ended there",
        "{agreeing} of {n} searches ended there",
        choice.searches,
        agreeing=Number(min(choice.agreeing, choice.searches), digits="d"),
    )
    yield Fact(Sentence("searches"), ended)
    if choice.at_ends:
        yield Fact(Sentence("at an end of its range"), Joined(list(map(Name, choice.at_ends))))
    if not choice.admissible:
        yield Fact(Sentence("result"), _missed_bounds(results))
        return
    for name, by in choice.binding.items():
        moved = Sentence(
            "a bound larger by {step} changes the best value by {change}",
            step=Number(1, "%"),
            change=Number(-MEASURES[name].sign * by, "%", "+.3g"),
        )
        yield Fact(Sentence("active bound: {measure}", measure=_measure(name)), moved)
    yield from _proof(results)


def _proof(results: CamChoice) -> Iterator[Fact]:
    proof = results.proof
    excess = Number(max(proof.excess, LEAST_EXCESS), digits=".0e")
    yield Fact(
        Sentence("bounds"),
        Sentence("satisfied along the path itself, within {excess} of them", excess=excess),
    )
    counts = {
        "admissible": Number(proof.admissible, digits="d"),
        "all": Number(proof.neighbours, digits="d"),
    }
    near = Sentence("of {all} neighbouring designs {admissible} satisfy the bounds; none is better", **counts)
    if proof.better is not None:
        near = Sentence(
            "of {all} neighbouring designs {admissible} satisfy the bounds; one is better by {gain} of the value",
            gain=Number(proof.gain, digits=".2g"),
            **counts,
        )
    yield Fact(Sentence("other designs"), near)


def _missed_bounds(results: CamChoice) -> Sentence:
    """By how much the nearest design misses its bounds: "contact stress by 12.3 %"."""
    bounds = Joined(
        [
            Sentence("{measure} by {part}", measure=_measure(name), part=Number(100 * by, "%", ".3g"))
            for name, by in results.choice.chosen.misses.items()
        ]
    )
    return Sentence("no design satisfies all bounds; the closest one violates {bounds}", bounds=bounds)


def _failure(results: CamChoice) -> Failure | None:
    if results.choice.admissible:
        return None
    return Failure(_missed_bounds(results), Sentence("move a bound, or widen the ranges of the parameters"))


def _parameters(results: CamChoice) -> Table:
    """The parameters with their ranges."""
    cam, chosen, start = results.cam, results.choice.chosen.parameters, results.choice.start.parameters
    assert cam.choose is not None
    ranges = cam.choose.parameters
    columns = {
        "chosen": (Sentence("chosen"), list(chosen.values())),
        "start": (Sentence("start"), [start[name] for name in chosen]),
        "from": (Sentence("from"), [ranges[name][0] for name in chosen]),
        "to": (Sentence("to"), [ranges[name][1] for name in chosen]),
    }
    units = [parameter_unit(cam, name) for name in chosen]
    return Table(
        (
            Column("parameter", tuple(map(Name, chosen)), head=Sentence("parameter")),
            *(
                Column(name, tuple(map(Number, values, units)), head=head)
                for name, (head, values) in columns.items()
            ),
        ),
        Sentence("Parameters"),
    )


def _measures(results: CamChoice) -> Table:
    """The measures with their bounds."""
    chosen, start = results.choice.chosen.measures, results.choice.start.measures
    names = results.measures
    return Table(
        (
            Column("measure", tuple(map(_measure, names)), head=Sentence("measure")),
            Column(
                "chosen", tuple(_value(name, chosen[name].value) for name in names), head=Sentence("chosen")
            ),
            Column("start", tuple(_value(name, start[name].value) for name in names), head=Sentence("start")),
            Column(
                "bound", tuple(_bound(name, chosen[name].bound) for name in names), head=Sentence("bound")
            ),
        ),
        Sentence("Measures"),
    )


def _bound(name: str, bound: float | None) -> Text:
    if bound is None:
        return NOTHING
    value = _value(name, bound)
    return (
        Sentence("at least {value}", value=value)
        if MEASURES[name].least
        else Sentence("at most {value}", value=value)
    )


def _designs(results: CamChoice) -> Table:
    """The start, the chosen design and each design of the front."""
    front = results.front.designs if results.front is not None else ()
    named = [("start", results.choice.start), ("chosen", results.choice.chosen)]
    named += [("front", design) for design in front]
    designs = [design for _word, design in named]
    columns = [Column("design", tuple(Name(word) for word, _design in named))]
    for name in results.choice.chosen.parameters:
        values = np.array([design.parameters[name] for design in designs])
        columns.append(Column(name, values, parameter_unit(results.cam, name)))
    for name in results.measures:
        factor, unit, fixed = _measure_unit(name)
        values = np.array([design.measures[name].value * factor for design in designs])
        columns.append(Column(name, values, unit, unit_fixed=fixed))
    kept = tuple(Name("no" if design.misses else "yes") for design in designs)
    return Table((*columns, Column("admissible", kept)))


# Figure and chapter


def _diagram(results: CamChoice) -> FrontDiagram:
    """Best designs as a bound moves, with the parameters that lead to them."""
    front = results.front
    assert front is not None
    factor = _measure_unit(front.against)[0]
    bound = results.choice.chosen.measures[front.against].bound
    return FrontDiagram(
        Sentence(
            "Trade-off: {best} against {against}", best=_measure(front.best), against=_measure(front.against)
        ),
        Title(results.cam.title),
        _label(front.against),
        factor * front.values(front.against),
        None if bound is None else factor * bound,
        (
            _front_panel(results, front),
            *(_parameter_panel(results, front, name) for name in front.designs[0].parameters),
        ),
    )


def _label(name: str) -> AxisLabel:
    _factor, unit, fixed = _measure_unit(name)
    worst = Sentence("greatest {measure}", measure=_measure(name))
    if MEASURES[name].least:
        worst = Sentence("least {measure}", measure=_measure(name))
    return AxisLabel(worst, unit=unit, unit_fixed=fixed)


def _front_panel(results: CamChoice, front: TradeOff) -> FrontPanel:
    """What is made best, with the start and the chosen design among the best ones."""
    factor = _measure_unit(front.best)[0]
    dots = (
        _dot(results.choice.start, front, Sentence("start"), chosen=False),
        _dot(results.choice.chosen, front, Sentence("chosen"), chosen=True),
    )
    return FrontPanel(_label(front.best), factor * front.values(front.best), dots)


def _dot(design: CamDesign, front: TradeOff, name: Sentence, *, chosen: bool) -> DesignDot:
    text = Sentence("{name}, violates a bound", name=name) if design.misses else name
    x, y = (_measure_unit(name)[0] * design.measures[name].value for name in (front.against, front.best))
    return DesignDot(text, x, y, not design.misses, chosen)


def _parameter_panel(results: CamChoice, front: TradeOff, name: str) -> FrontPanel:
    """A parameter along the front, the ends of its range where they are near, and its chosen value."""
    assert results.cam.choose is not None
    values = np.array([design.parameters[name] for design in front.designs])
    low, high = float(values.min()), float(values.max())
    ends = tuple(
        end
        for end in results.cam.choose.parameters[name]
        if low - NEAR * abs(low) <= end <= high + NEAR * abs(high)
    )
    chosen = results.choice.chosen
    at = _measure_unit(front.against)[0] * chosen.measures[front.against].value
    dot = DesignDot(NOTHING, at, chosen.parameters[name], admissible=True, chosen=True)
    label = AxisLabel(symbol=parameter_symbol(name), unit=parameter_unit(results.cam, name))
    return FrontPanel(label, values, (dot,), ends)


def _chapter(results: CamChoice) -> Chapter:
    """The parameters that make one measure least while others keep their bounds."""
    text = Sentence(
        "The parameters below minimise one measure while the others satisfy their bounds; the other chapters "
        "describe the cam as it is given, not this choice."
    )
    blocks: tuple[Block, ...] = (
        Paragraph(text),
        FactTable(tuple(_facts(results))),
        _parameters(results),
        _measures(results),
        *shortfall(_failure(results)),
    )
    caption = Sentence("Effect of a bound: the best values over the bound that is moved")
    figures = illustrations(["cam-choice"], {"cam-choice": caption})
    drawn = (figures,) if results.front is not None and results.front.designs else ()
    return Chapter(Sentence("Chosen parameters"), (Section(NOTHING, blocks), *drawn))
