"""Laws of motion beside each other for one rise: what the terminal, the files, the figure and the document show."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.cams.followers.curve_formulas import PEAKS
from centrode.cams.followers.motion import motion_names
from centrode.cams.followers.motion_results import FOUND, ORDERS
from centrode.quantities import QUANTITIES
from centrode.sheets.plots import AxisLabel, Curve, SpanPanel, SpanPlot
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Deferred,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import (
    NOTHING,
    Expression,
    Joined,
    Leaf,
    Number,
    Sentence,
    Symbol,
    Text,
    Title,
)
from centrode.views.followers import angle, curve_name, symbols_of

if TYPE_CHECKING:
    from centrode.cams.followers.motion_results import MotionLawResults

JUMPS = (
    Sentence("–"),
    Sentence("velocity"),
    Sentence("acceleration"),
    Sentence("jerk"),
    Sentence("fourth derivative"),
)
LETTERS = ("s", "v", "a", "j")
AXES = ("s/h", "vβ/h", "aβ²/h", "jβ³/h")


def sheet(results: MotionLawResults) -> Sheet:
    """Everything there is to say about laws of motion beside each other."""
    coefficients = _coefficients(
        results,
        Sentence(
            "Peak coefficients: greatest v, a, j as multiples of h/β, h/β², h/β³; of v a as multiples of h²/β³"
        ),
    )
    return Sheet(
        heading=Sentence("Laws of motion for one rise"),
        facts=_facts(results),
        printed=(coefficients, _sizes(results)),
        tables=Deferred({"cam-laws": lambda: _shares(results)}),
        datasets={"cam-laws": results.dataset},
        pictures=Deferred({"cam-laws": lambda: _plot(results)}),
        chapters=Deferred({"laws": lambda: _chapter(results)}),
    )


def _facts(results: MotionLawResults) -> tuple[Fact, ...]:
    """Which rise of the cam it is."""
    facts = results.dataset.attrs
    rise = Sentence(
        "{rise} over {angle}: segment {number}, {curve}",
        rise=Number(facts["rise"], "rad" if results.cam.swings else "m"),
        angle=angle(facts["angle"]),
        number=Number(facts["segment"] + 1),
        curve=curve_name(facts["curve"]),
    )
    return (Fact(Sentence("rise"), rise),)


def _names(results: MotionLawResults) -> Column:
    return Column("curve", tuple(map(curve_name, results.names)), head=Sentence("curve"))


def _coefficients(results: MotionLawResults, caption: Sentence) -> Table:
    """Peak coefficients of each law; a derivative above one that jumps has no bound there."""
    dataset = results.dataset
    peaks, jumps = dataset["peak_coefficient"], dataset["first_jump"].values.tolist()
    columns = [_names(results)]
    for order, letter in zip(ORDERS, LETTERS[1:], strict=True):
        values = peaks.sel(derivative=order).values.tolist()
        cells = tuple(
            _peak(value, unbounded=0 < jump < order) for value, jump in zip(values, jumps, strict=True)
        )
        columns.append(Column(f"C_{letter}", cells, head=Expression(f"C_{letter}")))
    torques = tuple(Number(value, digits=".5g") for value in dataset["torque_coefficient"].values.tolist())
    ends = tuple(JUMPS[jump] for jump in jumps)
    columns.append(Column("C_T", torques, head=Expression("C_T")))
    columns.append(Column("jumps", ends, head=Sentence("jumps at the ends or inside")))
    return Table(tuple(columns), caption)


def _peak(value: float, *, unbounded: bool) -> Text:
    number = Number(value, digits=".5g")
    return Joined((number, Sentence(", ∞ there")), "") if unbounded else number


def _sizes(results: MotionLawResults) -> Table:
    """Greatest velocity, acceleration and jerk in this rise, in time if there is a speed."""
    facts, peaks = results.dataset.attrs, results.dataset["peak_coefficient"]
    speed = facts.get("speed")
    by_angle, in_time = motion_names(results.cam.swings)
    names = by_angle[1:4] if speed is None else in_time
    columns = [_names(results)]
    for order, name, head in zip(ORDERS, names, symbols_of(names), strict=True):
        scale, unit = abs(facts["rise"]) * ((speed or 1.0) / facts["angle"]) ** order, QUANTITIES[name].unit
        values = (peaks.sel(derivative=order).values * scale).tolist()
        cells = tuple(Number(value, unit, unit_hidden=True) for value in values)
        columns.append(Column(name, cells, unit, head))
    return Table(tuple(columns), Sentence("Greatest magnitudes in this rise"))


def _shares(results: MotionLawResults) -> Table:
    """Lift and derivatives of each law over the share of the angle, in shares of the rise."""
    shares = results.dataset["rise_share"]
    columns = (
        Column(f"{letter} {name}", shares.sel(law=name, derivative=order).values)
        for name in results.names
        for order, letter in enumerate(LETTERS)
    )
    return Table((Column("share", results.dataset["share"].values), *columns))


def _plot(results: MotionLawResults) -> SpanPlot:
    """Lift and derivatives of each law over the rise."""
    shares = results.dataset["drawn_rise"]
    panels = (
        SpanPanel(
            AxisLabel(symbol=Symbol(axis)),
            tuple(
                Curve(curve_name(name), shares.sel(law=name, derivative=order).values, place)
                for place, name in enumerate(results.names)
            ),
        )
        for order, axis in enumerate(AXES)
    )
    return SpanPlot(
        Sentence("Laws of motion for one rise"),
        Title(results.cam.title),
        AxisLabel(Sentence("share of the angle"), Symbol("φ/β")),
        results.dataset["drawn_share"].values,
        (0.0, 1.0),
        (),
        tuple(panels),
    )


def _chapter(results: MotionLawResults) -> Chapter:
    """What other laws would do for the same rise."""
    meaning = Sentence(
        r"A rise $h$ over the angle $beta$ has the greatest velocity $C_v h \/ beta$, acceleration $C_a h \/ "
        r"beta^2$ and jerk $C_j h \/ beta^3$; the camshaft torque that accelerates a mass is proportional to the "
        r"greatest product of velocity and acceleration, $C_T h^2 \/ beta^3$. Where a derivative jumps at the "
        "ends, higher ones are unbounded."
    )
    check = Check(
        Sentence(
            "The greatest values, found on the exact derivatives, agree with those of the closed forms within {share}."
        ),
        results.closed_forms_difference,
        1.0,
        FOUND,
    )
    blocks: tuple[Block, ...] = (
        Paragraph(meaning),
        FactTable(_facts(results)),
        _coefficients(results, Sentence("Peak coefficients")),
        Paragraph(Sentence("The closed forms of the coefficients are")),
        Formula(tuple(_closed_forms(results))),
        check,
        _sizes(results),
        Illustration("cam-laws", Sentence("Lift and derivatives over the rise")),
    )
    return Chapter(Sentence("Laws of motion for one rise"), (Section(NOTHING, blocks),))


def _closed_forms(results: MotionLawResults) -> Iterator[tuple[Leaf, ...]]:
    """The coefficients of each curve that is there, in one line."""
    for name in results.names:
        if name in PEAKS:
            velocity, acceleration, jerk = PEAKS[name][0]
            yield (
                Expression(
                    "{curve} quad C_v = {velocity}, quad C_a = {acceleration}, quad C_j = {jerk}",
                    curve=Sentence("{curve}:", curve=curve_name(name)),
                    velocity=velocity,
                    acceleration=acceleration,
                    jerk=jerk,
                ),
            )
