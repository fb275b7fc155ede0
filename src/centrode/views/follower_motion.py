"""The motion of a cam's follower over a turn: what the terminal, the files, the figure and the document show."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import degrees, tau
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.curve_formulas import CURVES, PEAKS
from centrode.cams.followers.motion import ORDER, motion_names
from centrode.cams.followers.motion_results import (
    INSIDE,
    ORDERS,
    ROUNDED,
    ROUNDING,
    formulas_difference,
    integrals_difference,
)
from centrode.laws.segments import THROUGH_POINTS
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
    Scalar,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import (
    NOTHING,
    Expression,
    Factor,
    Joined,
    Leaf,
    Name,
    Number,
    Sentence,
    Symbol,
    Text,
    Title,
)
from centrode.views.follower_data import data_chapter
from centrode.views.followers import (
    CONTACTS,
    KINDS,
    angle,
    at,
    course,
    curve_name,
    letter_of,
    rate,
    rates_in_time,
    symbols_of,
    turn_table,
    turns_a_minute,
)

if TYPE_CHECKING:
    from centrode.cams.followers.motion_results import FollowerMotionResults
    from centrode.laws.rises import Piece

DERIVATIVES = (
    Sentence("the lift"),
    Sentence("the velocity"),
    Sentence("the acceleration"),
    Sentence("the jerk"),
    Sentence("the fourth derivative"),
)
GREATEST = {
    "velocity": Sentence("greatest velocity"),
    "acceleration": Sentence("greatest acceleration"),
    "jerk": Sentence("greatest jerk"),
}
COEFFICIENTS = ("C_v", "C_a", "C_j")
Lines = Iterator[tuple[Leaf, ...]]


def sheet(results: FollowerMotionResults) -> Sheet:
    """Everything there is to say about the motion of a follower."""
    return Sheet(
        heading=Sentence("Motion of the follower"),
        facts=_facts(results),
        scalars=_scalars(results),
        printed=(_segments(results), _joints_printed(results), *_instants_printed(results)),
        tables=Deferred({"cam-motion": lambda: turn_table(results.dataset)}),
        datasets={"cam-motion": results.dataset},
        pictures=Deferred({"cam-motion": lambda: _plot(results)}),
        chapters=Deferred({"data": lambda: data_chapter(results.cam), "lift": lambda: _chapter(results)}),
    )


# Facts, numbers, printed tables


def _facts(results: FollowerMotionResults) -> tuple[Fact, ...]:
    """What the follower is, sizes of its motion, what jumps."""
    follower, speed = results.cam.follower, results.motion.speed
    kind = Sentence("{kind}, with {contact}", kind=KINDS[follower.kind], contact=CONTACTS[follower.contact])
    facts = [Fact(Sentence("follower"), kind)]
    if speed is not None:
        turn = Sentence(
            "{speed}, a turn takes {time}", speed=turns_a_minute(speed), time=Number(tau / speed, "s")
        )
        facts.append(Fact(Sentence("speed of the cam"), turn))
    facts += _lift_facts(results)
    by_angle, in_time = motion_names(results.motion.swings)
    for order, (label, (size, place)) in enumerate(zip(GREATEST.values(), results.greatest, strict=True), 1):
        value: Text = Number(size, QUANTITIES[by_angle[order]].unit)
        if speed is not None:
            timed = Number(size * speed**order, QUANTITIES[in_time[order - 1]].unit)
            value = Sentence("{by_angle}, {in_time}", by_angle=value, in_time=timed)
        facts.append(Fact(label, at(value, place)))
    return (*facts, Fact(Sentence("continuous"), _continuity(results.first_jump)))


def _lift_facts(results: FollowerMotionResults) -> Iterator[Fact]:
    lift, unit = results.lift, results.motion.unit
    least, greatest = Number(_least(results), unit), Number(lift.greatest, unit)
    yield Fact(
        Sentence("lift"),
        Sentence("{least} to {greatest} at {at}", least=least, greatest=greatest, at=angle(lift.at_greatest)),
    )
    if lift.least < -ROUNDING * lift.greatest:
        below = Sentence(
            "it goes below {zero}, to its least value at {at}", zero=Number(0.0), at=angle(lift.at_least)
        )
        yield Fact(NOTHING, below)


def _least(results: FollowerMotionResults) -> float:
    """The least lift without the rounding of one that vanishes."""
    lift = results.lift
    return 0.0 if abs(lift.least) <= ROUNDING * lift.greatest else lift.least


def _continuity(jump: int | None) -> Sentence:
    """Up to which derivative all is continuous, and what the first that is not does to the follower."""
    if jump is None:
        return Sentence("all derivatives up to the fourth")
    if jump == 1:
        return Sentence("the lift only; the velocity jumps: rigid impacts")
    if jump == 2:
        return Sentence("up to the velocity; the acceleration jumps: soft impacts, unbounded jerk")
    return Sentence("up to {last}; {first} jumps", last=DERIVATIVES[jump - 1], first=DERIVATIVES[jump])


def _scalars(results: FollowerMotionResults) -> dict[str, Scalar]:
    motion = results.motion
    by_angle, in_time = motion_names(motion.swings)
    scalars = {
        "follower_least_lift": Scalar(_least(results), motion.unit),
        "follower_greatest_lift": Scalar(results.lift.greatest, motion.unit),
    }
    for order, (word, (size, place)) in enumerate(zip(GREATEST, results.greatest, strict=True), 1):
        name = f"follower_greatest_{word}"
        scalars[name] = Scalar(size, QUANTITIES[by_angle[order]].unit)
        scalars[f"{name}_at"] = Scalar(place, "rad")
        if motion.speed is not None:
            unit = QUANTITIES[in_time[order - 1]].unit
            scalars[f"{name}_in_time"] = Scalar(size * motion.speed**order, unit)
    if results.first_jump is not None:
        scalars["follower_first_jump"] = Scalar(results.first_jump, "1")
    return scalars


def _segments(results: FollowerMotionResults) -> Table:
    """Angles, lifts, curves and coefficients of the segments."""
    motion, segments = results.motion, results.cam.segments
    angles = tuple(_from_to(ends, "rad") for ends in pairwise(motion.joints))
    lifts = tuple(_from_to(ends, motion.unit) for ends in results.rises)
    peaks = tuple(
        Column(
            letters,
            tuple(
                Number(one.coefficients[k] if one.coefficients[0] else np.nan, digits=".5g")
                for one in results.peaks
            ),
            head=Expression(letters),
        )
        for k, letters in enumerate(COEFFICIENTS)
    )
    return Table(
        (
            Column("segment", _numbers(len(segments)), head=Sentence("segment")),
            Column("angle", angles, "rad", Symbol("φ")),
            Column("lift", lifts, motion.unit, Symbol("ψ" if motion.swings else "s")),
            Column("curve", tuple(curve_name(one.curve) for one in segments), head=Sentence("curve")),
            *peaks,
        ),
        Sentence(
            "Segments, and their greatest velocity, acceleration and jerk as multiples of h/β, h/β², h/β³"
        ),
    )


def _numbers(count: int) -> tuple[Number, ...]:
    return tuple(Number(number + 1) for number in range(count))


def _from_to(ends: tuple[float, float], unit: str) -> Text:
    """A range without its unit, or the one value that it has."""
    numbers = tuple(Number(end, unit, unit_hidden=True) for end in ends)
    return numbers[0] if ends[0] == ends[1] else Joined(numbers, " … ")


def _joints(results: FollowerMotionResults, heads: Sequence[Text], caption: Sentence) -> Table:
    """What derivatives change by where segments meet, the first segment with the last one at 0."""
    names = motion_names(results.motion.swings)[0][1:]
    places_of = [(0.0, results.joints[-1]), *((joint.angle, joint) for joint in results.joints[:-1])]
    places_of += [(joint.angle, joint) for joint in results.inner_joints]
    angles, joints = zip(*sorted(places_of, key=lambda one: one[0]), strict=True)
    places = tuple(Number(place, "rad", digits="", unit_hidden=True) for place in angles)
    columns = [Column("angle", places, "rad", heads[0])]
    for order, (name, head) in enumerate(zip(names, heads[1:], strict=True), 1):
        unit = QUANTITIES[name].unit
        jumps = (joint.jumps[order] or np.nan for joint in joints)
        cells = tuple(Number(jump, unit, digits="+", unit_hidden=True) for jump in jumps)
        columns.append(Column(name, cells, unit, head))
    return Table(tuple(columns), caption)


def _joints_printed(results: FollowerMotionResults) -> Table:
    heads = [Symbol("φ"), *symbols_of(motion_names(results.motion.swings)[0][1 : ORDER + 1])]
    if results.inner_joints:
        return _joints(
            results, heads, Sentence("Jumps of the derivatives where segments meet and inside them")
        )
    return _joints(results, heads, Sentence("Jumps of the derivatives where segments meet"))


def _instants_printed(results: FollowerMotionResults) -> Iterator[Table]:
    if len(results.instants):
        heads = [Symbol("φ"), *symbols_of(motion_names(results.motion.swings)[0][:4])]
        yield _at_instants(results, heads, Sentence("Positions"))


def _at_instants(results: FollowerMotionResults, heads: Sequence[Text], caption: Sentence) -> Table:
    """Lift and derivatives at the chosen angles."""
    names = motion_names(results.motion.swings)[0]
    columns = [Column("angle", results.instants, "rad", heads[0])]
    for name, values, head in zip(names, results.at_instants, heads[1:], strict=False):
        columns.append(Column(name, values, QUANTITIES[name].unit, head))
    return Table(tuple(columns), caption)


# Figure


def _plot(results: FollowerMotionResults) -> SpanPlot:
    """Lift, velocity, acceleration and jerk over a turn; in time if there is a speed."""
    dataset, speed = results.dataset, results.motion.speed
    by_angle, in_time = motion_names(results.motion.swings)
    names = by_angle[:4] if speed is None else (by_angle[0], *in_time)
    drawn = dataset["drawn_motion"].values
    ends = (0.0, *(joint.angle for joint in results.joints))
    panels = []
    for order, name in enumerate(names):
        quantity, pace = QUANTITIES[name], 1.0 if speed is None else speed**order
        sides = [(pace * joint.before[order], pace * joint.after[order]) for joint in results.joints]
        jumps = [(end, *side) for end, side in zip(ends, (sides[-1], *sides), strict=True)]
        jumps += [
            (one.angle, pace * one.before[order], pace * one.after[order]) for one in results.inner_joints
        ]
        curve = Curve(Sentence(quantity.long_name), pace * drawn[:, order], 0)
        label = AxisLabel(symbol=Symbol(quantity.symbol), unit=quantity.unit)
        panels.append(SpanPanel(label, (curve,), tuple(jumps)))
    return SpanPlot(
        Sentence("Motion of the follower"),
        Title(results.cam.title),
        AxisLabel(Sentence("angle of the cam"), Symbol("φ"), "rad"),
        dataset["drawn_angle"].values,
        ends,
        tuple(curve_name(segment.curve) for segment in results.cam.segments),
        tuple(panels),
    )


# Chapter


def _chapter(results: FollowerMotionResults) -> Chapter:
    """Laws of the segments, their numbers, joints, tables, plots."""
    swings = results.motion.swings
    rates = [Expression(f"Delta {rate(swings, order)}") for order in ORDERS]
    heads = [Expression("phi"), *rates, Expression(f"Delta {letter_of(swings)}^((4))")]
    joints = (
        Sentence(
            "Jumps of the derivatives where segments meet and inside them; a dash: continuous, to rounding"
        )
        if results.inner_joints
        else Sentence("Jumps of the derivatives where segments meet; a dash: continuous, to rounding")
    )
    plot = Illustration("cam-motion", Sentence("Lift, velocity, acceleration and jerk over a turn"))
    sections = (
        Section(NOTHING, (*_given(results), FactTable(_facts(results)))),
        Section(Sentence("Laws of the segments"), tuple(_laws(results))),
        Section(Sentence("Numbers of the segments"), tuple(_segment_blocks(results))),
        Section(Sentence("Where segments meet"), (_joints(results, heads, joints),)),
        Section(Sentence("Tables"), tuple(_tables(results))),
        Section(Sentence("Plots"), (plot,)),
    )
    return Chapter(Sentence("Motion of the follower"), tuple(one for one in sections if one.blocks))


def _given(results: FollowerMotionResults) -> Iterator[Block]:
    """What is given, and how derivatives by the angle become those in time."""
    swings, speed = results.motion.swings, results.motion.speed
    yield Paragraph(
        Sentence(
            "The lift {letter} is given over the angle $phi$ of the cam, segment by segment. A prime denotes a "
            "derivative with respect to $phi$ in radians; with respect to time",
            letter=Expression(letter_of(swings)),
        )
    )
    lines: list[tuple[Leaf, ...]] = [
        (letter, f"omega{_power(order)} {rate(swings, order)}")
        for order, letter in enumerate(rates_in_time(swings), 1)
    ]
    if speed is not None:
        turns = Expression("frac(pi dot.op {turns}, 30)", turns=Number(speed * 30.0 / np.pi))
        lines.insert(0, ("omega", "frac(pi n, 30)", turns, Number(speed, "rad/s", unit_fixed=True)))
    yield Formula(tuple(lines))


def _power(order: int) -> str:
    return "" if order == 1 else f"^{order}"


def _laws(results: FollowerMotionResults) -> Iterator[Block]:
    """Every curve that is used, once, in letters."""
    swings = results.motion.swings
    letter = letter_of(swings)
    used = [curve for curve in CURVES if any(one.curve == curve for one in results.cam.segments)]
    if not used:
        return
    yield Paragraph(
        Sentence(
            "A segment begins at the angle $phi_0$ with the lift {start} and rises by $h$ (falls, where $h < 0$) over"
            " the angle $beta$; {share} goes from {first} to {last}.",
            start=Expression(f"{letter}_0"),
            share=Expression("u = (phi - phi_0) \\/ beta"),
            first=Number(0.0),
            last=Number(1.0),
        )
    )
    for curve in used:
        yield Paragraph(Sentence("Curve: {curve}", curve=curve_name(curve)))
        before = "0"
        for rule in CURVES[curve]:
            if len(CURVES[curve]) > 1:
                shares = Expression(f"{before} <= u <= {rule.mark}")
                yield Paragraph(Sentence("for {shares}", shares=shares))
            before = rule.mark
            lift, slope, second = rule.spelled
            lines = (letter, f"{letter}_0 + {lift}"), (rate(swings, 1), slope), (rate(swings, 2), second)
            yield Formula(lines)
    yield Check(
        Sentence(
            "The formulas, evaluated at {count} angles of each segment, give the motion within {share} of its "
            "magnitude.",
            count=Number(len(INSIDE)),
        ),
        formulas_difference(results),
        1.0,
        ROUNDED,
    )


def _segment_blocks(results: FollowerMotionResults) -> Iterator[Block]:
    """Each segment that moves the follower, from its rise to its greatest jerk."""
    yield Paragraph(
        Sentence(
            r"The greatest magnitudes of the derivatives are $C_v |h| \/ beta$, $C_a |h| \/ beta^2$, $C_j |h| \/ "
            "beta^3$; the coefficients depend on the curve alone."
        )
    )
    for number, (segment, (before, after)) in enumerate(
        zip(results.cam.segments, results.rises, strict=True)
    ):
        if segment.to is not None:
            first, last = results.motion.joints[number : number + 2]
            yield Paragraph(
                Sentence(
                    "Segment {number}, {curve}, from {first} to {last}:",
                    number=Number(number + 1),
                    curve=curve_name(segment.curve),
                    first=Number(first, "rad", digits=""),
                    last=Number(last, "rad", digits=""),
                )
            )
        if segment.lift:
            yield Paragraph(_lift_formula(segment.lift))
        if after != before:
            yield Formula(tuple(_segment_lines(results, number, before, after)))
        if segment.curve in THROUGH_POINTS:
            yield from _pieces(results, number, before)


def _lift_formula(text: str) -> Sentence:
    """The formula of a segment as it is given."""
    return Sentence(
        "In SI units its lift is {formula}, with phi the angle from its start, beta the angle of the segment, s0 and "
        "s1 the lift at its start and at its end, h = s1 - s0.",
        formula=Name(text),
    )


def _segment_lines(results: FollowerMotionResults, number: int, before: float, after: float) -> Lines:
    """Rise over angle, greatest derivatives by their coefficients."""
    swings, speed, segment = results.motion.swings, results.motion.speed, results.cam.segments[number]
    letter, rise, turned = letter_of(swings), after - before, segment.angle
    worked = Expression(
        "{after} - {before}", after=_bare(results, after), before=Factor(_bare(results, before))
    )
    yield "h", f"{letter}_1 - {letter}_0", worked, _derivative(results, rise)
    radians = Number(turned, "rad", unit_fixed=True)
    yield "beta", Expression("{degrees} degree", degrees=Number(degrees(turned))), radians
    closed = PEAKS[segment.curve][0] if segment.curve in PEAKS else None
    for order, name in enumerate(COEFFICIENTS, 1):
        coefficient, power = results.peaks[number].coefficients[order - 1], _power(order)
        most = coefficient * abs(rise) / turned**order
        over = Expression(
            f"{{coefficient}} dot.op frac({{rise}}, {{angle}}{power})",
            coefficient=Number(coefficient) if closed is None else closed[order - 1],
            rise=_bare(results, abs(rise)),
            angle=Number(turned),
        )
        symbol = f'abs({rate(swings, order)})_"max"'
        yield symbol, f"{name} frac(abs(h), beta{power})", over, _derivative(results, most, order)
        if speed is not None and order < 3:
            timed = Expression(
                f"{{speed}}{power} dot.op {{most}}", speed=Number(speed), most=Factor(_bare(results, most))
            )
            unit = ("rad" if swings else "m") + f"/s{power}"
            value = Number(speed**order * most, unit, unit_fixed=swings)
            yield f'abs({rates_in_time(swings)[order - 1]})_"max"', f"omega{power} {symbol}", timed, value


def _derivative(results: FollowerMotionResults, value: float, order: int = 0) -> Number:
    """The lift or a derivative of it by the angle of the cam; angles of the follower are in radians."""
    if results.motion.swings:
        return Number(value, "1" if order else "rad", unit_fixed=True)
    return Number(value, f"m/rad{_power(order)}" if order else "m")


def _bare(results: FollowerMotionResults, value: float) -> Number:
    """The same without unit, in a sum or a product."""
    return Number(value, "1" if results.motion.swings else "m", unit_hidden=True)


def _pieces(results: FollowerMotionResults, number: int, before: float) -> Iterator[Block]:
    """Coefficients of the polynomials that a segment through points consists of."""
    swings = results.motion.swings
    start = results.motion.joints[number]
    found = results.cam.segments[number].law.pieces(start, before)
    yield Paragraph(
        Sentence(
            "With {share} it is {polynomial}",
            share=Expression("x = (phi - phi_k) \\/ beta_k"),
            polynomial=Expression(f"{letter_of(swings)} = a_0 + a_1 x + a_2 x^2 + ..."),
        )
    )
    ends = [start, *(end for end, _piece in found)]
    places = (
        ("from", Sentence("$phi$ from"), ends[:-1]),
        ("to", Sentence("$phi$ to"), ends[1:]),
        ("origin", Expression("phi_k"), [piece.origin for _end, piece in found]),
        ("angle", Expression("beta_k"), [piece.unit for _end, piece in found]),
    )
    most = max(len(piece.powers) for _end, piece in found)
    coefficients = np.array([_coefficients(piece, most) for _end, piece in found]).T.tolist()
    unit = "1" if swings else "m"
    yield Table(
        (
            *(Column(name, _cells(values, "rad"), "rad", head) for name, head, values in places),
            *(
                Column(f"a_{k}", _cells(values, unit), unit, Expression(f"a_{k}"))
                for k, values in enumerate(coefficients)
            ),
        ),
        Sentence("Coefficients of segment {number}", number=Number(number + 1)),
    )


def _coefficients(piece: Piece, most: int) -> tuple[float, ...]:
    return (piece.value, *piece.powers, *(0.0,) * (most - len(piece.powers)))


def _cells(values: Sequence[float], unit: str) -> tuple[Number, ...]:
    """Numbers that have digits of their own each."""
    return tuple(Number(value, unit, digits="", unit_hidden=True) for value in values)


def _tables(results: FollowerMotionResults) -> Iterator[Block]:
    """The motion at even steps and at the chosen angles, and its derivatives integrated."""
    motion, swings = results.motion, results.motion.swings
    by_angle, in_time = motion_names(swings)
    letters = [rate(swings, order) for order in range(4)]
    if len(results.instants):
        heads = [Expression("phi"), *map(Expression, letters)]
        yield _at_instants(results, heads, Sentence("At the chosen angles"))
    caption = Sentence(
        "Lift and derivatives by the angle of the cam; where a derivative jumps, the value after the jump"
    )
    yield course(results.dataset, list(zip(by_angle, letters, strict=False)), caption, brief=True)
    if motion.speed is not None:
        caption = Sentence("Velocity, acceleration and jerk at the speed of the cam")
        variables = list(zip(in_time, rates_in_time(swings), strict=True))
        yield course(results.dataset, variables, caption, brief=True)
    yield Check(
        Sentence(
            "Velocity, acceleration and jerk, integrated over each segment by Gauss quadrature, reproduce the "
            "changes of lift, velocity and acceleration within {share} of their greatest values."
        ),
        integrals_difference(motion),
        1.0,
        ROUNDED,
    )
