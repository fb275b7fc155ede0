"""Checks of stops, clamps and events against the other parts of a description, and whether it has such things."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.model.checks import link_known, two_known_points, unknown_name_problems
from centrode.model.contacts import Clamp, MeasuredPart, Stop
from centrode.model.loads import CoefficientFriction, GuideFriction, HingeFriction
from centrode.model.reading import Place, Problem, nearest, value_text

if TYPE_CHECKING:
    from centrode.model.description import Description


def needs_events(mechanism: Description) -> bool:
    """Whether a description has what makes events: stops, clamps, conditions, belts, some frictions."""
    if mechanism.stops or mechanism.clamps or mechanism.events:
        return True
    if mechanism.motors or mechanism.controllers:
        return True
    if any(isinstance(load, CoefficientFriction) for load in mechanism.loads):
        return True
    dry = (load for load in mechanism.loads if isinstance(load, HingeFriction | GuideFriction))
    return any(load.static is not None or load.surface_speed for load in dry)


def contact_problems(mechanism: Description) -> Iterator[Problem]:
    """Problems of stops, clamps and events: names that are not there, or are there twice; bounds that cross."""
    parts = (("stops", mechanism.stops), ("clamps", mechanism.clamps), ("events", mechanism.events))
    labels: set[str] = set()
    for room, group in parts:
        for index, part in enumerate(group):
            at: Place = (room, index)
            yield from _names(mechanism, part, at)
            if part.label in labels:
                what = _("there are two stops, clamps or events {name}").format(name=value_text(part.label))
                yield Problem(what, _("give one of them a different name: name = ..."), at)
            labels.add(part.label)
            if isinstance(part, Stop):
                yield from _bounds(part, at)
            if isinstance(part, Clamp) and isinstance(part.until, str):
                known = [event.label for event in mechanism.events]
                if part.until not in known:
                    what = _("there is no event {name}").format(name=value_text(part.until))
                    yield Problem(what, nearest(part.until, known), (*at, "until"))


def _names(mechanism: Description, part: MeasuredPart, at: Place) -> Iterator[Problem]:
    if part.link is not None:
        yield from link_known(mechanism, part.link, (*at, "link"), moving=True)
        yield from link_known(mechanism, part.relative_to, (*at, "relative_to"))
        if part.link == part.relative_to:
            yield Problem(
                _("a link does not turn against itself"), _("name another link"), (*at, "relative_to")
            )
    if part.guide is not None:
        guides = [guide.id for guide in mechanism.guides]
        yield from unknown_name_problems(part.guide, guides, "guide", (*at, "guide"))
    if part.point is not None:
        yield from unknown_name_problems(part.point, mechanism.points, "point", (*at, "point"))
    if part.points is not None:
        yield from two_known_points(mechanism, part.points, (*at, "points"))


def _bounds(stop: Stop, at: Place) -> Iterator[Problem]:
    if stop.least is not None and stop.most is not None and not stop.least < stop.most:
        what = _("least ({least:.9g}) has to be below most ({most:.9g})")
        yield Problem(what.format(least=stop.least, most=stop.most), _("exchange or correct them"), at)
