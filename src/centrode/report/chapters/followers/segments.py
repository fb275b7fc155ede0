"""The numbers of each segment: rise over angle, greatest derivatives by their coefficients."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

from centrode.cams.followers.motion import peaks_of
from centrode.laws.segments import THROUGH_POINTS
from centrode.locale import _
from centrode.render.document.blocks import Block, Formula, Paragraph, Table
from centrode.render.document.formulas import factor, with_unit
from centrode.report.chapters.followers.curves import PEAKS
from centrode.report.chapters.followers.parts import letter_of, motion_of, rate

if TYPE_CHECKING:
    from centrode.laws.rises import Piece
    from centrode.model.follower_cam import LiftSegment
    from centrode.report.study import ReportStudy

NAMES = ("v", "a", "j")


def segment_blocks(study: ReportStudy) -> Iterator[Block]:
    """Each segment that moves the follower, from its rise to its greatest jerk."""
    text = _(
        "Greatest sizes of the derivatives are $C_v |h| \\/ beta$, $C_a |h| \\/ beta^2$, $C_j |h| \\/ beta^3$;"
        " the coefficients depend on the curve alone."
    )
    yield Paragraph(text)
    before = 0.0
    for number, segment in enumerate(study.plate.segments):
        after = before if segment.to is None else segment.to
        if after != before:
            yield Paragraph(_title(study, segment, number))
            yield Formula(tuple(_numbers(study, segment, number, before, after)))
        elif segment.to is not None:
            yield Paragraph(_title(study, segment, number))
        if segment.curve in THROUGH_POINTS:
            yield from _pieces(study, segment, number, before)
        before = after


def _title(study: ReportStudy, segment: LiftSegment, number: int) -> str:
    first, last = (study.numbers.measured(one, "rad") for one in motion_of(study).joints[number : number + 2])
    told = _("Segment {number}, {curve}, from {first} to {last}:")
    return told.format(number=number + 1, curve=_(segment.curve), first=first, last=last)


def size(study: ReportStudy, value: float, order: int = 0) -> str:
    """The lift or a derivative of it with its unit; angles of the follower in radians."""
    if study.plate.swings:
        unit = "rad" if order == 0 else ""
        text = study.numbers.math(value)
        return f'{text} thin "{unit}"' if unit else text
    return with_unit(
        study.numbers, value, "m" + ("" if not order else "/rad" + (f"^{order}" if order > 1 else ""))
    )


def bare(study: ReportStudy, value: float) -> str:
    """The same without unit, in a product."""
    return factor(study.numbers, value, "1" if study.plate.swings else "m")


def _numbers(
    study: ReportStudy, segment: LiftSegment, number: int, before: float, after: float
) -> Iterator[tuple[str, ...]]:
    letter, numbers, rise, angle = letter_of(study), study.numbers, after - before, segment.angle
    shown = numbers.math(after, "1" if study.plate.swings else "m"), bare(study, before)
    yield "h", f"{letter}_1 - {letter}_0", f"{shown[0]} - {shown[1]}", size(study, rise)
    degrees, radians = numbers.math(math.degrees(angle)), numbers.math(angle)
    yield "beta", f"{degrees} degree", f'{radians} thin "rad"'
    peaks = peaks_of(motion_of(study).law, number)
    spelled, _values = PEAKS.get(segment.curve, (("", "", ""), (0.0, 0.0, 0.0)))
    speed = study.plate.body.speed
    for order, (name, coefficient) in enumerate(zip(NAMES, peaks.coefficients, strict=True), 1):
        power = "beta" if order == 1 else f"beta^{order}"
        below = radians if order == 1 else f"{radians}^{order}"
        c = spelled[order - 1] or numbers.math(coefficient)
        most = coefficient * abs(rise) / angle**order
        symbol = f'abs({rate(letter, order)})_"max"'
        over = f"frac({study.numbers.math(abs(rise), '1' if study.plate.swings else 'm')}, {below})"
        yield symbol, f"C_{name} frac(abs(h), {power})", f"{c} dot.op {over}", size(study, most, order)
        if speed is not None and order < 3:
            yield _in_time(study, name, order, symbol, speed, most)


def _in_time(
    study: ReportStudy, name: str, order: int, symbol: str, speed: float, most: float
) -> tuple[str, ...]:
    """A greatest velocity or acceleration at the speed of the cam."""
    numbers, power = study.numbers, "" if order == 1 else f"^{order}"
    unit = ("rad" if study.plate.swings else "m") + "/s" + power
    value = speed**order * most
    told = (
        f'{numbers.math(value)} thin "{unit.replace("^2", "²")}"'
        if study.plate.swings
        else with_unit(numbers, value, unit)
    )
    letter = {1: "dot(psi)", 2: "dot.double(psi)"}[order] if study.plate.swings else name
    worked = f"{numbers.math(speed)}{power} dot.op {bare(study, most)}"
    return f'abs({letter})_"max"', f"omega{power} {symbol}", worked, told


def _pieces(study: ReportStudy, segment: LiftSegment, number: int, before: float) -> Iterator[Block]:
    """Coefficients of the polynomials that a segment through points consists of."""
    letter, numbers = letter_of(study), study.numbers
    start = motion_of(study).joints[number]
    found = segment.law.pieces(start, before)
    scale = 1.0 if study.plate.swings else numbers.shown("m")[0]
    turn = numbers.shown("rad")[0]
    most = max(len(piece.powers) for _end, piece in found)
    text = _("With $x = (phi - phi_k) \\/ beta_k$ it is ${letter} = a_0 + a_1 x + a_2 x^2 + ...$")
    yield Paragraph(text.format(letter=letter))
    ends = [start, *(end for end, _piece in found)]
    rows = tuple(
        (
            *(numbers.plain(one * turn) for one in (low, high, piece.origin, piece.unit)),
            *(numbers.plain(one * scale) for one in _powers(piece, most)),
        )
        for (low, high), (_end, piece) in zip(pairwise(ends), found, strict=True)
    )
    unit = "1" if study.plate.swings else "m"
    head = (
        *(numbers.head(one, "rad") for one in (_("$phi$ from"), _("$phi$ to"), "$phi_k$", "$beta_k$")),
        *(numbers.head(f"$a_{k}$", unit) for k in range(most + 1)),
    )
    caption = _("Coefficients of segment {number}").format(number=number + 1)
    yield Table(head, rows, caption, (True,) * len(head))


def _powers(piece: Piece, most: int) -> tuple[float, ...]:
    return (piece.value, *piece.powers, *(0.0,) * (most - len(piece.powers)))
