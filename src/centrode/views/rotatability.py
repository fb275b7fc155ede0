"""Rotatability and the repair of it: what the terminal, the files and the document show."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from math import degrees
from typing import TYPE_CHECKING, Any, assert_never

from centrode.analysis.redesign.candidates import Impossibility
from centrode.analysis.redesign.results import RotatabilityResults
from centrode.analysis.rotatability.causes import (
    AngleCondition,
    AngleSymbol,
    Cause,
    CauseKind,
    SlideCondition,
    Tracer,
)
from centrode.analysis.rotatability.circuits import MOST_DYADS, FourBar, Uncounted
from centrode.analysis.rotatability.tours import DWELL_BAND
from centrode.model.files import mechanism_text
from centrode.model.reading import FRAME
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Fact,
    FactTable,
    Failure,
    Paragraph,
    Section,
    Sheet,
)
from centrode.sheets.texts import (
    NOTHING,
    Counted,
    Expression,
    Indexed,
    Joined,
    Leaf,
    Name,
    Number,
    Sentence,
    Symbol,
    Text,
)
from centrode.views import transmission
from centrode.views.instants import place_number
from centrode.views.single_changes import proposal_blocks, single_facts
from centrode.views.structure import GROUP_KINDS

if TYPE_CHECKING:
    from centrode.analysis.redesign.repair import Change, Repair
    from centrode.analysis.rotatability.causes import Condition, Transmission
    from centrode.analysis.rotatability.circuits import CircuitBranch
    from centrode.analysis.rotatability.rotatability import LimitFound, LinkTurning, Rotatability
    from centrode.analysis.rotatability.tours import Dwell, LinkStroke, StrokeExtreme

ROUNDING = 1e-12
"""A least transmission angle [rad] below which it is zero but for rounding."""


def sheet(turning: Rotatability) -> Sheet:
    """Whether the drives turn and why not, how everything moves; where a repair was sought, this in its place."""
    found = turning if isinstance(turning, RotatabilityResults) else RotatabilityResults.of(turning)
    shown = (
        Sheet(facts=(*_facts(found), *_single_facts(found)), record=_record(found))
        if found.repair is None
        else repair_sheet(found.repair)
    )
    pictures = {} if found.angles is None else transmission.sheet(found.angles).pictures
    return dataclasses.replace(shown, pictures=pictures, chapters={"rotatability": _chapter(found)})


def _single_facts(found: RotatabilityResults) -> Iterator[Fact]:
    """The change of one dimension that repairs a mechanism that locks, or why none is sought."""
    if found.single is not None:
        yield from single_facts(found.single)
    elif found.refusal is not None:
        reason = Name(str(found.refusal))
        yield Fact(Sentence("repair"), Sentence("none is sought: {reason}", reason=reason))


def repair_sheet(repair: Repair) -> Sheet:
    """What changes and by how much, what that reaches, and what was tried; the repaired mechanism as a file."""
    failure = Failure(
        Sentence("no change was found that satisfies the requirement"),
        Sentence("widen the bounds, or vary more"),
    )
    return Sheet(
        facts=tuple(_repair_facts(repair)),
        files={} if repair.repaired is None else {"repaired.toml": mechanism_text(repair.repaired)},
        record=_record(repair),
        failure=None if repair.found else failure,
    )


# What stops a group


def cause_text(cause: Cause) -> Text:
    """What happens to a group at its limit or its change point, as a sentence without its full stop."""
    bodies = dict(zip(("one", "other"), map(_body, cause.bodies), strict=False))
    match cause.kind:
        case CauseKind.TURNS_BACK:
            return Sentence(
                "the curve of positions of the group turns back: the determinant of its equations is zero"
            )
        case CauseKind.POSITIONS_MEET:
            return Sentence("positions of the group coincide: the determinant of its equations is zero")
        case CauseKind.RODS_IN_LINE:
            return _of_two_rods(cause, Sentence("{one} and {other} are collinear", **bodies))
        case CauseKind.RODS_PARALLEL:
            return _of_two_rods(cause, Sentence("{one} and {other} are parallel", **bodies))
        case CauseKind.RODS_ON_GREAT_CIRCLE:
            return _of_two_rods(cause, Sentence("{one} and {other} lie on one great circle", **bodies), "rad")
        case CauseKind.ROD_SQUARE:
            return Sentence("{rod} is perpendicular to {guide}", rod=bodies["one"], guide=bodies["other"])
        case CauseKind.ROD_ALONG:
            return Sentence("{rod} is parallel to {guide}", rod=bodies["one"], guide=bodies["other"])
        case CauseKind.LINES_PARALLEL:
            return Sentence("{one} and {other} are parallel: their intersection goes to infinity", **bodies)
        case CauseKind.CIRCLES_TOUCH:
            return Sentence("the circles of {one} and {other} touch", **bodies)
        case CauseKind.NO_LENGTH:
            return Sentence("cylinder {name} of no length", name=Name(cause.bodies[0][1]))
        case _:
            return _of_aiming_link(cause)


def _of_two_rods(cause: Cause, line: Text, unit: str = "m") -> Text:
    how = Sentence("extended") if cause.stretched else Sentence("folded")
    sentence = Sentence("{line}, {how}", line=line, how=how)
    if cause.distance is None:
        return sentence
    first, second = map(Name, cause.points)
    return Sentence(
        "{sentence} (distance of {first} and {second}: {apart})",
        sentence=sentence,
        first=first,
        second=second,
        apart=Number(cause.distance, unit),
    )


def _of_aiming_link(cause: Cause) -> Text:
    """Of a link whose guide aims at a point."""
    names = dict(zip(("link", "guide"), (Name(name) for _tracer, name in cause.bodies), strict=True))
    names |= dict(zip(("pivot", "target"), map(Name, cause.points), strict=True))
    if cause.kind == CauseKind.WHEEL_NEAREST:
        return Sentence("{link} cannot come closer to the wheel about {target}", **names)
    if cause.kind == CauseKind.PIN_AT_PIVOT:
        return Sentence("{target} reaches the pivot {pivot} of {link}", **names)
    if cause.distance is None:
        return Sentence("the arc from {pivot} to {target} is perpendicular to guide {guide}", **names)
    return Sentence(
        "the line from {pivot} to {target} is perpendicular to guide {guide}: {target} comes no closer than {by}",
        **names,
        by=Number(cause.distance, "m"),
    )


def _body(body: tuple[Tracer, str]) -> Text:
    """What draws a locus: a link by its name, a cylinder and a guide by a word before theirs."""
    tracer, name = body
    match tracer:
        case Tracer.LINK:
            return Name(name)
        case Tracer.CYLINDER:
            return Sentence("cylinder {name}", name=Name(name))
        case Tracer.GUIDE:
            return Sentence("guide {name}", name=Name(name))
        case Tracer.WHEEL:
            return Sentence("the track of a wheel")
        case _:
            assert_never(tracer)


def _condition(condition: Condition) -> Text:
    """What holds at the limit: angles as mathematics, a displacement in the units of the display."""
    if isinstance(condition, str):
        return Name(condition)
    if isinstance(condition, SlideCondition):
        value = Number(condition.value, "m") if condition.value else Number(0.0)
        return Joined((Name(f"s_{condition.guide}"), value), " = ")
    return _angles(condition)


def _angles(condition: AngleCondition) -> Expression:
    holes: dict[str, Leaf] = {}
    notation = ""
    for sign, angles in (("+", condition.plus), ("-", condition.minus)):
        for angle in angles:
            hole = f"angle{len(holes)}"
            notation += f" {sign} {{{hole}}}" if holes else f"{{{hole}}}"
            holes[hole] = _angle(angle)
    if condition.constant:
        notation += f" {'+' if condition.constant > 0 else '-'} {{constant}}"
        holes["constant"] = Number(abs(condition.constant))
    return Expression(f"{condition.function}({notation}) = 0", **holes)


def _angle(angle: AngleSymbol) -> Leaf:
    return Indexed(angle.letter, angle.index) if angle.letter == "phi" else Symbol(angle.letter, angle.index)


def _stop(cause: Cause, condition: Condition) -> Text:
    return Joined((cause_text(cause), _condition(condition)), ": ")


# Facts of rotatability


def _facts(found: Rotatability) -> Iterator[Fact]:
    for turning in found.drives:
        yield from _Turning(found, turning).facts()
    for loop in found.four_bars:
        names = Joined([_link(body) for body in loop.bodies], "-")
        yield Fact(Sentence("loop {name}", name=names), Sentence(loop.kind.word))
        yield Fact(NOTHING, _rule(loop))


def _link(name: str) -> Text:
    return Sentence("frame") if name == FRAME else Name(name)


def _rule(loop: FourBar) -> Text:
    """The rule of Grashof with the sums of this loop."""
    rule = loop.inequality
    sign = "=" if loop.grashof is None else "<" if loop.grashof else ">"
    sums = Joined((Number(rule.short, rule.unit), Number(rule.long, rule.unit)), f" {sign} ")
    shortest = _link(loop.shortest)
    meaning = (
        Sentence(
            "shortest and longest link ({one}, {other}) compared with the two others",
            one=shortest,
            other=_link(rule.longest),
        )
        if rule.longest
        else Sentence("shorter link {one} plus offset compared with the longer link", one=shortest)
    )
    return Joined((sums, meaning), ": ")


class _Turning:
    """Facts about one drive."""

    def __init__(self, found: Rotatability, turning: LinkTurning) -> None:
        self.mechanism = found.mechanism
        self.turning = turning

    def place(self, at: float) -> Text:
        """A value of the drive."""
        label = self.mechanism.motion_parameter.drive(self.turning.drive).label
        return Joined((Name(label), _number(at, self.turning.unit)), " = ")

    def facts(self) -> Iterator[Fact]:
        turning = self.turning
        yield Fact(Sentence("drive"), self.drive())
        yield Fact(Sentence("turns fully"), self.verdict())
        for limit in turning.limits:
            yield from self.limit(limit)
        for point in turning.change_points:
            where = Joined((self.place(point.value), _stop(point.cause, point.condition)))
            yield Fact(Sentence("change point"), where)
        yield from self.circuits()
        for stroke in turning.swings:
            yield from self.stroke(stroke)
        yield from self.dead_points()
        for one in turning.transmissions:
            yield from self.transmission(one)

    def drive(self) -> Text:
        """The drive, and the values of those that stand still."""
        name, parameter = Name(self.turning.drive), self.mechanism.motion_parameter
        held = [
            Joined((Name(other), _number(value, parameter.drive(other).unit)), " = ")
            for other, value in self.turning.held.items()
        ]
        return Joined((name, Sentence(" (held: {held})", held=Joined(held))), "") if held else name

    def verdict(self) -> Text:
        turning = self.turning
        if turning.turns_fully is None:
            return Sentence("a displacement does not turn")
        if not turning.turns_fully and not turning.limits:
            return Sentence("no; the position does not close over the whole turn, though no limit was found")
        if not turning.turns_fully:
            return Sentence("no")
        if turning.period is None:
            return Sentence("yes; it does not return to its position after two turns")
        return Counted("yes, it returns after {n} turn", "yes, it returns after {n} turns", turning.period)

    def limit(self, limit: LimitFound) -> Iterator[Fact]:
        label = Sentence("lower limit") if limit.end == "low" else Sentence("upper limit")
        place = self.place(limit.value)
        yield Fact(label, Sentence("{place}, {group}", place=place, group=Name(limit.group)))
        yield Fact(NOTHING, _stop(limit.cause, limit.condition))

    def circuits(self) -> Iterator[Fact]:
        found, label = self.turning.circuits, Sentence("circuits")
        if found is None:
            yield Fact(label, _uncounted_reason(self.turning.circuits_missing))
            return
        parts: list[Text] = [
            Counted(
                "{n}; the mechanism is assembled in number {own}",
                "{n}; the mechanism is assembled in number {own}",
                len(found.circuits),
                own=Number(found.own + 1, digits="d"),
            ),
            Counted(", which has {n} branch", ", which has {n} branches", found.branches),
        ]
        parts += [Sentence("; joined at change points")] if found.joined else []
        yield Fact(label, Joined(parts, ""))
        for branch in found.circuits[found.own]:
            yield Fact(NOTHING, self.branch(branch))

    def branch(self, branch: CircuitBranch) -> Text:
        """A branch by its sides, and from where to where it goes."""
        named = [Joined((Name(point), SIDES[word]), " ") for point, word in branch.sides.items()]
        sides: Text = Joined(named) if named else Sentence("no sides")
        if branch.low is None and branch.high is None:
            return Sentence("{sides}: everywhere", sides=sides)
        low, high = (
            Sentence("without limit") if end is None else self.place(end) for end in (branch.low, branch.high)
        )
        return Sentence("{sides}: from {low} to {high}", sides=sides, low=low, high=high)

    def stroke(self, stroke: LinkStroke) -> Iterator[Fact]:
        name = Name(stroke.name)
        label = (
            Sentence("link {name}", name=name)
            if stroke.member == "link"
            else Sentence("slide {name}", name=name)
        )
        if stroke.kind == "still":
            angular = stroke.unit == "rad"
            yield Fact(label, Sentence("constant angle") if angular else Sentence("at rest"))
            return
        if stroke.kind == "turns":
            yield Fact(label, self.turns(stroke))
        elif stroke.least is None or stroke.greatest is None or stroke.stroke is None:
            yield Fact(label, Sentence("moves; its value at a limit is undetermined"))
            return
        else:
            size: Text = Sentence("stroke {stroke}", stroke=_number(stroke.stroke, stroke.unit))
            if stroke.forward is not None and stroke.back is not None and stroke.time_ratio is not None:
                forward, back = (Number(way, "rad") for way in (stroke.forward, stroke.back))
                ways = Sentence(", forward {forward}, back {back}", forward=forward, back=back)
                size = Joined(
                    (size, Sentence(", time ratio {ratio}", ratio=Number(stroke.time_ratio)), ways), ""
                )
            yield Fact(label, size)
            least, greatest = (self.extreme(one, stroke.unit) for one in (stroke.least, stroke.greatest))
            yield Fact(NOTHING, Sentence("least {extreme}", extreme=least))
            yield Fact(NOTHING, Sentence("greatest {extreme}", extreme=greatest))
        for dwell in stroke.dwells:
            yield Fact(NOTHING, self.dwell(dwell))

    def turns(self, stroke: LinkStroke) -> Text:
        if not stroke.turns or self.turning.period is None:
            return Sentence("rotates in one sense")
        text = Counted("turns {n} time in a period", "turns {n} times in a period", abs(stroke.turns))
        return Joined((text, Sentence(", against the drive")), "") if stroke.turns < 0 else text

    def extreme(self, extreme: StrokeExtreme, unit: str) -> Text:
        value, place = _number(extreme.value, unit), self.place(extreme.at)
        text = Sentence("{value} at {place}", value=value, place=place)
        if extreme.at_limit:
            return Sentence("{text}, where the drive stops", text=text)
        return Joined((text, *_in_line(extreme.in_line)))

    def dwell(self, dwell: Dwell) -> Text:
        return Sentence(
            "stays within {share} of its stroke from {first} to {last}",
            share=Number(100 * DWELL_BAND, "%"),
            first=self.place(dwell.first),
            last=self.place(dwell.last),
        )

    def dead_points(self) -> Iterator[Fact]:
        """Members that, as the drive, could not move the present one somewhere; they move it everywhere else."""
        points = self.turning.dead_points
        for number, driver in enumerate(dict.fromkeys(point.driver for point in points)):
            places = [
                Joined((self.place(point.at), *_in_line(point.in_line)))
                for point in points
                if point.driver == driver
            ]
            text = Sentence("driven at {driver}: {places}", driver=Name(driver), places=Joined(places, "; "))
            yield Fact(NOTHING if number else Sentence("dead positions"), text)

    def transmission(self, one: Transmission) -> Iterator[Fact]:
        least = _degrees(one.least if one.least > ROUNDING else 0.0)
        yield Fact(
            Sentence("transmission angle"),
            Sentence(
                "{group} ({kind}): least {value} at {place}",
                group=Name(one.group),
                kind=GROUP_KINDS[one.kind],
                value=least,
                place=self.place(one.least_at),
            ),
        )
        if one.extremes:
            extremes = [
                Sentence("{value} at {place}", value=_degrees(value), place=self.place(at))
                for at, value in one.extremes
            ]
            yield Fact(NOTHING, Sentence("extremes: {extremes}", extremes=Joined(extremes, "; ")))


def _number(value: float, unit: str) -> Number:
    """A value with the digits to ask for it again; what is zero but for rounding as zero."""
    return place_number(0.0 if abs(value) < 1e-14 else value, unit)


def _degrees(angle: float) -> Number:
    """A transmission angle, in degrees for every reader."""
    return Number(degrees(angle), "deg")


def _in_line(pairs: Sequence[tuple[str, str]]) -> Iterator[Text]:
    for one, other in pairs:
        yield Sentence("{one} and {other} in line", one=Name(one), other=Name(other))


SIDES: Mapping[str, Text] = {
    "left": Sentence("left"),
    "right": Sentence("right"),
    "ahead": Sentence("ahead"),
    "behind": Sentence("behind"),
}
"""Sides, by the words in which a description names them."""


def _uncounted_reason(reason: Uncounted | None) -> Text:
    return NOTHING if reason is None else Sentence(reason.word, most=Number(MOST_DYADS, digits="d"))


# Facts of the repair


def _repair_facts(repair: Repair) -> Iterator[Fact]:
    yield Fact(
        Sentence("requirement"),
        Sentence(
            "turns fully, transmission angles of {angle} or more",
            angle=_degrees(repair.least_transmission_angle),
        ),
    )
    if repair.least_transmission_angle < repair.wanted:
        yield from _out_of_reach(repair)
    elif repair.impossible is not None:
        reason = impossibility_text(repair.impossible)
        yield Fact(Sentence("found"), Sentence("impossible: {reason}", reason=reason))
        yield from _within_reach(repair)
        return
    if repair.found and not repair.changes:
        yield Fact(Sentence("found"), Sentence("the requirement is already satisfied"))
        yield _reached_angle(repair)
        return
    if repair.found:
        yield Fact(Sentence("found"), Sentence("a change of magnitude {size}", size=Number(repair.size)))
        for change in repair.changes:
            yield Fact(Name(change.path), _change(change))
        yield _reached_angle(repair)
    else:
        none = Sentence("none found within the bounds; this does not prove that none exists")
        yield Fact(Sentence("found"), none)
        yield from _within_reach(repair)
    yield Fact(
        Sentence("tried"),
        Sentence(
            "{tried}; of the {spread} spread over the bounds {turning} are feasible",
            tried=Counted("{n} candidate", "{n} candidates", repair.tried),
            spread=Number(repair.spread, digits="d"),
            turning=Number(repair.turning, digits="d"),
        ),
    )


def _out_of_reach(repair: Repair) -> Iterator[Fact]:
    """Why less is required than was wanted."""
    wanted = Sentence("transmission angles of {angle} or more", angle=_degrees(repair.wanted))
    if repair.impossible is not None:
        reason = impossibility_text(repair.impossible)
        wanted = Sentence("{wanted}, impossible: {reason}", wanted=wanted, reason=reason)
    yield Fact(Sentence("out of reach"), wanted)
    yield from _within_reach(repair)


def _within_reach(repair: Repair) -> Iterator[Fact]:
    """The greatest transmission angle of any candidate, where the one wanted is out of reach."""
    if repair.greatest is not None:
        greatest = Number(degrees(repair.greatest), "deg", ".4g")
        yield Fact(
            Sentence("within reach"), Sentence("transmission angles of {angle} at most", angle=greatest)
        )


def _reached_angle(repair: Repair) -> Fact:
    angle = _degrees(repair.reached or 0.0)
    return Fact(Sentence("verified"), Sentence("turns fully, least transmission angle {angle}", angle=angle))


def _change(change: Change) -> Text:
    before, after = place_number(change.before, change.unit), place_number(change.after, change.unit)
    if change.before == change.after:
        return Sentence("stays {before}", before=before)
    return Sentence("from {before} to {after}", before=before, after=after)


def impossibility_text(reason: Impossibility) -> Text:
    """The inequality that excludes a repair, with its numbers, and why it has to hold."""
    angle = Number(degrees(reason.least_angle), "deg", ".4g")
    crank, low, high = Name(reason.crank), Number(reason.low, "m"), Number(reason.high, "m")
    if len(reason.rods) == 2:
        one, other = map(Name, reason.rods)
        return Sentence(
            "{inequality}: {low} > {high}; the slider's stroke is at least twice the crank's length, and no "
            "straight path of this length lies between the least and the greatest reach of {one} and {other}",
            inequality=Expression(
                "{crank} > 2 sqrt({one} {other} cos {angle})", crank=crank, one=one, other=other, angle=angle
            ),
            low=low,
            high=high,
            one=one,
            other=other,
        )
    rod = Name(reason.rods[0])
    offset = " + e" if reason.offset else ""
    return Sentence(
        "{inequality}: {low} > {high}{remark}; over a turn the crank's pin moves farther from the guide than "
        "{rod} reaches",
        inequality=Expression(
            f"{{crank}}{offset} > {{rod}} cos {{angle}}", crank=crank, rod=rod, angle=angle
        ),
        low=low,
        high=high,
        remark=Sentence(" (e = {e}, not varied)", e=Number(reason.offset, "m")) if reason.offset else NOTHING,
        rod=rod,
    )


# Chapter


def _chapter(found: RotatabilityResults) -> Chapter:
    """What bounds the motion, transmission angles, and the repair of what does not turn fully."""
    sections = [Section(NOTHING, (FactTable(tuple(_facts(found))),))]
    if found.angles is not None:
        sections.append(transmission.section(found.angles))
    if found.single is not None or found.refusal is not None:
        sections.append(Section(Sentence("Repair"), tuple(_repair_blocks(found))))
    if found.repair is not None:
        several = tuple(_blocks_of_several(found.repair))
        sections.append(Section(Sentence("Change of several dimensions"), several, detail=True))
    return Chapter(Sentence("Rotatability"), tuple(sections))


def _repair_blocks(found: RotatabilityResults) -> Iterator[Block]:
    """The smallest change of one dimension after which the motion is made, or why none is sought."""
    if found.single is None:
        yield Paragraph(Sentence("No repair was sought: {reason}", reason=Name(str(found.refusal))))
        return
    cause = NOTHING if found.dead is None else cause_text(found.dead.limit.cause)
    yield from proposal_blocks(found.single, found.proposed, found.dead, cause)


def _blocks_of_several(repair: Repair) -> Iterator[Block]:
    """How the change of several dimensions was sought, in exact numbers."""
    yield Paragraph(Sentence("A change of the dimensions was sought after which the drive turns fully."))
    yield FactTable(tuple(_repair_facts(repair)))
    if repair.repaired is not None:
        turns = repair.after is not None and repair.after.turns_fully is True
        statement = Sentence("The changed mechanism was analysed again: its drive turns fully.")
        yield Check(statement, 0.0 if turns else 1.0, 1.0, 0.0)


# Records

LEFT_OUT = ("mechanism", "repaired", "repair", "refusal", "angles", "dead", "proposed", "several")
"""Of a result, what its record does not hold."""
REASONS = ("circuits_missing", "impossible")
"""What a record holds as an empty text where there is none."""


def _record(value: Any) -> Any:
    """A result as JSON holds it, in SI: causes, rules and reasons as texts."""
    match value:
        case Cause():
            return cause_text(value)
        case AngleCondition() | SlideCondition():
            return str(value)
        case Uncounted():
            return _uncounted_reason(value)
        case Impossibility():
            return impossibility_text(value)
        case FourBar():
            return {**_fields(value), "inequality": _rule(value)}
        case tuple():
            return [_record(part) for part in value]
        case Mapping():
            return {name: _record(part) for name, part in value.items()}
    return _fields(value) if dataclasses.is_dataclass(value) else value


def _fields(value: Any) -> dict[str, Any]:
    names = (field.name for field in dataclasses.fields(value) if field.name not in LEFT_OUT)
    parts = {name: getattr(value, name) for name in names}
    return {name: "" if part is None and name in REASONS else _record(part) for name, part in parts.items()}
