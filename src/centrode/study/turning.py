"""What is said of a mechanism's turning: rows of a label and a text, and as JSON."""

from __future__ import annotations

import json
from math import degrees
from typing import TypeAlias

from centrode.analysis.rotatability.causes import Transmission
from centrode.analysis.rotatability.circuits import Branch, Circuits, FourBar
from centrode.analysis.rotatability.rotatability import LimitFound, LinkTurning, Rotatability
from centrode.analysis.rotatability.tours import Dwell, LinkStroke, StrokeExtreme
from centrode.locale import _, mark, ngettext
from centrode.model.mechanism import Mechanism
from centrode.model.reading import body_word
from centrode.study.wording import value_text

Rows: TypeAlias = list[tuple[str, str]]

ROUNDING = 1e-12
"""A least transmission angle [rad] below which it is zero but for rounding."""


def rotatability_rows(mechanism: Mechanism, found: Rotatability) -> Rows:
    """Everything about the turning of every drive, in the units and the language of the reader."""
    rows: Rows = []
    for turning in found.drives:
        rows += _Words(mechanism, turning).rows()
    return [*rows, *(row for loop in found.four_bars for row in _loop(loop))]


def rotatability_text(found: Rotatability) -> str:
    """What was found as JSON, in SI."""
    return json.dumps(found.as_dict(), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def _loop(loop: FourBar) -> Rows:
    name = "-".join(body_word(body) for body in loop.bodies)
    return [(_("loop {name}").format(name=name), _(loop.kind)), ("", loop.inequality)]


SIDES = (mark("left"), mark("right"), mark("ahead"), mark("behind"))
"""Words of the sides, in which a description names them."""


class _Words:
    """Rows about one drive."""

    def __init__(self, mechanism: Mechanism, turning: LinkTurning) -> None:
        self.mechanism = mechanism
        self.turning = turning

    def value(self, value: float, unit: str) -> str:
        # what is zero but for rounding is said as zero
        return value_text(0.0 if abs(value) < 1e-14 else value, unit, self.mechanism.display)

    def held(self, name: str, value: float) -> str:
        """The value of a drive that stands still."""
        return self.value(value, self.mechanism.motion_parameter.drive(name).unit)

    def place(self, at: float) -> str:
        """A value of the drive."""
        value = self.value(at, self.turning.unit)
        return f"{self.turning.drive} = {value}"

    def rows(self) -> Rows:
        turning = self.turning
        held = ", ".join(f"{name} = {self.held(name, value)}" for name, value in turning.held.items())
        rows = [(_("drive"), turning.drive + (_(" (held: {held})").format(held=held) if held else ""))]
        rows += [(_("turns fully"), self.verdict())]
        rows += [row for limit in turning.limits for row in self.limit(limit)]
        rows += [
            (_("change point"), f"{self.place(point.value)}, {point.cause}: {point.condition}")
            for point in turning.change_points
        ]
        rows += self.circuits(turning.circuits)
        rows += [row for swing in turning.swings for row in self.swing(swing)]
        rows += self.dead_points()
        return rows + [row for one in turning.transmissions for row in self.transmission(one)]

    def verdict(self) -> str:
        turning = self.turning
        if turning.turns_fully is None:
            return _("a displacement does not turn")
        if not turning.turns_fully and not turning.limits:
            return _("no; it does not close all over the turn, though no limit was found")
        if not turning.turns_fully:
            return _("no")
        if turning.period is None:
            return _("yes; not back in its position after two turns")
        return ngettext("yes, back after {n} turn", "yes, back after {n} turns", turning.period).format(
            n=turning.period
        )

    def limit(self, limit: LimitFound) -> Rows:
        label = _("stops below") if limit.end == "low" else _("stops above")
        cause = f"{limit.cause}: {limit.condition}" if limit.condition else limit.cause
        return [
            (label, _("{place}, {group}").format(place=self.place(limit.value), group=limit.group)),
            ("", cause),
        ]

    def circuits(self, circuits: Circuits | None) -> Rows:
        if circuits is None:
            return [(_("circuits"), self.turning.circuits_missing)]
        count = len(circuits.circuits)
        text = ngettext("{n}; assembled in number {own}", "{n}; assembled in number {own}", count).format(
            n=count, own=circuits.own + 1
        )
        text += ngettext(", which has {n} branch", ", which has {n} branches", circuits.branches).format(
            n=circuits.branches
        )
        rows = [(_("circuits"), text + (_("; joined at change points") if circuits.joined else ""))]
        return rows + [("", self.branch(branch)) for branch in circuits.circuits[circuits.own]]

    def branch(self, branch: Branch) -> str:
        """A branch by its sides, and from where to where it goes."""
        sides = ", ".join(f"{point} {_(word)}" for point, word in branch.sides.items()) or _("no sides")
        if branch.low is None and branch.high is None:
            return _("{sides}: everywhere").format(sides=sides)
        ends = (
            self.place(end) if end is not None else _("without limit") for end in (branch.low, branch.high)
        )
        return _("{sides}: from {low} to {high}").format(sides=sides, low=next(ends), high=next(ends))

    def swing(self, swing: LinkStroke) -> Rows:
        label = (_("link {name}") if swing.member == "link" else _("slide {name}")).format(name=swing.name)
        if swing.kind == "still":
            return [(label, _("keeps its angle") if swing.unit == "rad" else _("stands still"))]
        if swing.kind == "turns":
            return [(label, self.turns(swing)), *self.dwells(swing.dwells)]
        if swing.least is None or swing.greatest is None or swing.stroke is None:
            return [(label, _("moves; its value at a limit is undetermined"))]
        stroke = _("stroke {stroke}").format(stroke=self.value(swing.stroke, swing.unit))
        if swing.time_ratio is not None:
            stroke += _(", time ratio {ratio:.6g}").format(ratio=swing.time_ratio)
        return [
            (label, stroke),
            ("", _("least {extreme}").format(extreme=self.extreme(swing.least, swing.unit))),
            ("", _("greatest {extreme}").format(extreme=self.extreme(swing.greatest, swing.unit))),
            *self.dwells(swing.dwells),
        ]

    def turns(self, swing: LinkStroke) -> str:
        if not swing.turns or self.turning.period is None:
            return _("runs on")
        count = abs(swing.turns)
        text = ngettext("turns {n} time in a period", "turns {n} times in a period", count).format(n=count)
        return text + (_(", against the drive") if swing.turns < 0 else "")

    def extreme(self, extreme: StrokeExtreme, unit: str) -> str:
        text = _("{value} at {place}").format(
            value=self.value(extreme.value, unit), place=self.place(extreme.at)
        )
        if extreme.at_limit:
            return _("{text}, where the drive stops").format(text=text)
        return text + self.in_line(extreme.in_line)

    def in_line(self, pairs: tuple[tuple[str, str], ...]) -> str:
        named = [_("{one} and {other} in line").format(one=one, other=other) for one, other in pairs]
        return "".join(f", {name}" for name in named)

    def dwells(self, dwells: tuple[Dwell, ...]) -> Rows:
        return [
            ("", _("stays within 1 % of its stroke from {first} to {last}").format(
                first=self.place(dwell.first), last=self.place(dwell.last)))
            for dwell in dwells
        ]  # fmt: skip

    def dead_points(self) -> Rows:
        """Members that, as the drive, could not move the present one somewhere; they move it everywhere else."""
        drivers = dict.fromkeys(point.driver for point in self.turning.dead_points)
        rows = []
        for driver in drivers:
            points = [point for point in self.turning.dead_points if point.driver == driver]
            places = [self.place(point.at) + self.in_line(point.in_line) for point in points]
            rows.append((_("dead points"), _("driven at {driver}: {places}").format(
                driver=driver, places="; ".join(places))))  # fmt: skip
        return [(label if k == 0 else "", text) for k, (label, text) in enumerate(rows)]

    def transmission(self, one: Transmission) -> Rows:
        label = _("transmission angle")
        value = degrees(one.least if one.least > ROUNDING else 0.0)
        least = _("{group} ({kind}): least {value:.6g} deg at {place}").format(
            group=one.group, kind=one.kind, value=value, place=self.place(one.least_at)
        )
        extremes = [
            _("{value:.6g} deg at {place}").format(value=degrees(value), place=self.place(at))
            for at, value in one.extremes
        ]
        return [
            (label, least),
            *([("", _("extremes: {extremes}").format(extremes="; ".join(extremes)))] if extremes else []),
        ]
