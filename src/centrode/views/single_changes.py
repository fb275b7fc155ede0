"""The change of one dimension that repairs a mechanism that locks: in words, in a table, as schemes side by side."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import degrees
from typing import TYPE_CHECKING

from centrode.model.mechanism import FRAME
from centrode.sheets.linkages import SchemePair, SchemePicture
from centrode.sheets.sheet import Block, Check, Column, Fact, Illustration, Paragraph, Table
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Slanted, Text, Unit
from centrode.views.instants import instant_title

if TYPE_CHECKING:
    from centrode.analysis.redesign.proposal import ProposedRepair
    from centrode.analysis.redesign.repair import Change
    from centrode.analysis.redesign.single_changes import (
        DeadPosition,
        Dimension,
        SingleChange,
        SingleChanges,
    )
    from centrode.model.mechanism import Mechanism

CLOSED = 1e-9
"""Residual over the greatest length below which a sample is closed."""
SHOWN = 3
"""Changes that a terminal prints."""

# Translators: {name} is the name of a link, a hinge or a guide; {after} and {before} are lengths or angles.
CHANGES: Mapping[str, Sentence] = {
    "length": Sentence("link {name} {after} long instead of {before}"),
    "arc": Sentence("link {name} with an arc of {after} instead of {before}"),
    "angle": Sentence("initial angle of link {name} {after} instead of {before}"),
    "point": Sentence("hinge {name} at {axis} = {after} instead of {before}"),
    "guide": Sentence("line of guide {name} at {axis} = {after} instead of {before}"),
}
DIMENSIONS: Mapping[str, Sentence] = {
    "length": Sentence("length of link {name}"),
    "arc": Sentence("arc of link {name}"),
    "angle": Sentence("initial angle of link {name}"),
    "point": Sentence("coordinate {axis} of hinge {name}"),
    "guide": Sentence("coordinate {axis} of the line of guide {name}"),
}


def single_facts(found: SingleChanges) -> Iterator[Fact]:
    """The repair as a terminal prints it: the smallest changes, each with the value at which the mechanism is dead."""
    label = Sentence("repair")
    if not found.changes:
        yield Fact(label, _no_change(found))
        return
    yield Fact(label, Sentence("one of these dimensions, for {motion}:", motion=_motion(found)))
    if found.greatest is not None:
        text = Sentence(
            "one dimension alone brings about {greatest} at most; several: --repair",
            greatest=_angle(found.greatest),
        )
        yield Fact(NOTHING, text)
    for change in found.changes[:SHOWN]:
        yield Fact(
            NOTHING,
            Sentence(
                "{change} (limiting value {bound}), transmission angle of {angle} or more",
                change=change_text(found.mechanism, change, ".9g"),
                bound=Number(change.bound, change.unit),
                angle=_angle(change.least_angle),
            ),
        )


def proposal_blocks(
    found: SingleChanges, proposed: ProposedRepair | None, dead: DeadPosition | None, cause: Text
) -> Iterator[Block]:
    """What locks, what to change, the mechanism before and after, and every dimension that would do alone."""
    if dead is not None:
        place = instant_title(found.mechanism, dead.locked, 0)
        yield Paragraph(Sentence("The mechanism locks at {place}: {cause}.", place=place, cause=cause))
    wanted = found.margin if proposed is None else proposed.wanted
    yield Paragraph(Sentence("Required: {motion}.", motion=_motion(found, wanted)))
    if proposed is None:
        yield Paragraph(Sentence("No change of one dimension alone was found that is sufficient."))
        if found.greatest is not None:
            yield Paragraph(
                Sentence(
                    "One dimension alone brings about transmission angles of {greatest} at most.",
                    greatest=_angle(found.greatest),
                )
            )
        return
    if proposed.greatest is not None:
        yield Paragraph(
            Sentence(
                "{wanted} are out of reach: the greatest transmission angle that was found is {greatest}. The repair "
                "keeps {angle} or more.",
                wanted=_angle(proposed.wanted),
                greatest=_angle(proposed.greatest),
                angle=_angle(proposed.angle),
            )
        )
    changes = proposed_changes(proposed)
    least = _angle(proposed.least_angle)
    if proposed.several is None:
        text = Sentence(
            "Proposed repair: {change}. The limiting value is {bound}. The difference is a margin: the transmission "
            "angle of every group stays at {angle} or more.",
            change=changes,
            bound=Number(found.changes[0].bound, found.changes[0].unit, ""),
            angle=least,
        )
    else:
        text = Sentence(
            "Proposed repair: {changes}. The transmission angle of every group stays at {angle} or more.",
            changes=changes,
            angle=least,
        )
    yield Paragraph(text)
    if dead is not None:
        yield Illustration(scheme_pair(proposed, dead))
    if len(found.changes) > (proposed.several is None):
        yield _table(found)
    if found.without:
        names = Joined([_dimension(found.mechanism, one) for one in found.without])
        yield Paragraph(
            Sentence("No value between the bounds of the search is sufficient for: {names}.", names=names)
        )
    statement = Sentence(
        "The repaired mechanism was assembled at all samples of the motion; the worst residual is {share} of its "
        "greatest length."
    )
    yield Check(statement, proposed.residual, 1.0, CLOSED)


def proposed_changes(proposed: ProposedRepair) -> Text:
    """The changes of a proposed repair in words."""
    return changes_text(proposed.mechanism, proposed.dimensions, proposed.changes)


def changes_text(mechanism: Mechanism, dimensions: Sequence[Dimension], changes: Sequence[Change]) -> Text:
    """Changes of dimensions in words, one after the other."""
    pairs = zip(dimensions, changes, strict=True)
    return Joined(
        [
            _changed_dimension(mechanism, one, change.before, change.after, change.unit)
            for one, change in pairs
        ]
    )


def repaired_blocks(proposed: ProposedRepair) -> Iterator[Block]:
    """What the repaired mechanism differs in, and the transmission angle that it keeps."""
    yield Paragraph(
        Sentence(
            "This chapter computes the repaired mechanism: {changes}. Its drive makes the required motion; the least "
            "transmission angle is {angle}.",
            changes=proposed_changes(proposed),
            angle=_angle(proposed.least_angle),
        )
    )


def change_text(mechanism: Mechanism, change: SingleChange, digits: str = "") -> Text:
    """A change in words: "link AB 92 mm long instead of 80 mm"."""
    return _changed_dimension(mechanism, change.dimension, change.before, change.after, change.unit, digits)


def _changed_dimension(
    mechanism: Mechanism, dimension: Dimension, before: float, after: float, unit: str, digits: str = ""
) -> Text:
    return CHANGES[_kind(mechanism, dimension)].fill(
        name=Name(dimension.name),
        after=Number(after, unit, digits, degrees_too=True),
        before=Number(before, unit, digits, degrees_too=True),
        **_axis(dimension),
    )


def _dimension(mechanism: Mechanism, dimension: Dimension) -> Text:
    return DIMENSIONS[_kind(mechanism, dimension)].fill(name=Name(dimension.name), **_axis(dimension))


def _kind(mechanism: Mechanism, dimension: Dimension) -> str:
    return "arc" if dimension.kind == "length" and mechanism.space == "sphere" else dimension.kind


def _axis(dimension: Dimension) -> dict[str, Text]:
    return {"axis": Slanted(dimension.axis)} if dimension.axis else {}


def _motion(found: SingleChanges, margin_angle: float | None = None) -> Text:
    """What is required: a full turn, or a range of the drive, and a transmission angle."""
    required, margin = found.required, _angle(found.margin if margin_angle is None else margin_angle)
    if required.turn:
        return Sentence("a full turn of the drive with transmission angles of {angle} or more", angle=margin)
    drive = found.mechanism.motion_parameter.drives[0]
    low, high = (Number(end, drive.unit, ".9g") for end in (required.low, required.high))
    return Sentence(
        "the range of {drive} from {low} to {high} with transmission angles of {angle} or more",
        drive=Name(drive.label),
        low=low,
        high=high,
        angle=margin,
    )


def _no_change(found: SingleChanges) -> Text:
    if not found.required.turn:
        return Sentence("no change of one dimension alone was found, for {motion}", motion=_motion(found))
    return Sentence(
        "no change of one dimension alone was found, for {motion}; change several dimensions (--repair)",
        motion=_motion(found),
    )


def _angle(angle: float) -> Number:
    """A transmission angle, in degrees for every reader."""
    return Number(degrees(angle), "deg", ".3g")


def scheme_pair(proposed: ProposedRepair, dead: DeadPosition) -> SchemePair:
    """The mechanism in its dead position, and repaired at the same value of the drive."""
    lengths = [one.name for one in proposed.dimensions if one.kind == "length"]
    changed = lengths[0] if len(lengths) == 1 and len(proposed.dimensions) == 1 else FRAME
    words = Sentence("repaired: {change}", change=proposed_changes(proposed))
    return pair_of_schemes(proposed.mechanism, proposed.repaired, dead, words, changed)


def pair_of_schemes(
    mechanism: Mechanism, repaired: Mechanism, dead: DeadPosition, words: Text, changed: str = ""
) -> SchemePair:
    """A mechanism in its dead position and another one at the same value of the drive, side by side.

    `words` say what the other one is; the dimensions of the `changed` link, or of the frame, are set off.
    """
    place = instant_title(mechanism, dead.locked, 0)
    if mechanism.space == "sphere":
        title = Sentence(
            "Kinematic schemes at {place}: a) in the dead position; b) {words}. The dimensions of the links are arcs",
            place=place,
            words=words,
        )
    else:
        title = Sentence(
            "Kinematic schemes at {place}: a) in the dead position; b) {words}. Dimensions in {unit}",
            place=place,
            words=words,
            unit=Unit("m", shown=True),
        )
    schemes = (
        SchemePicture(title, mechanism, dead.locked, 0),
        SchemePicture(title, repaired, dead.repaired, 0, changed),
    )
    return SchemePair(title, schemes)


def _table(found: SingleChanges) -> Table:
    """Each dimension that alone repairs the mechanism, the smallest change first."""
    changes = found.changes

    def numbers(head: Sentence, values: list[Number]) -> Column:
        return Column("", tuple(values), head=head)

    names = tuple(_dimension(found.mechanism, one.dimension) for one in changes)
    return Table(
        (
            Column("", names, head=Sentence("dimension")),
            numbers(Sentence("present value"), [Number(one.before, one.unit, "") for one in changes]),
            numbers(Sentence("limiting value"), [Number(one.bound, one.unit, "") for one in changes]),
            numbers(Sentence("proposed value"), [Number(one.after, one.unit, "") for one in changes]),
            numbers(Sentence("least transmission angle"), [_angle(one.least_angle) for one in changes]),
        ),
        Sentence(
            "Dimensions of which each alone repairs the mechanism, with transmission angles of {angle} or more",
            angle=_angle(found.margin),
        ),
    )
