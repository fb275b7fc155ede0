"""Commands about single instants without `--at`: which instants they take, and another one where these fail."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any

import centrode as ct
from centrode.cli import library, output
from centrode.cli.about import about
from centrode.errors import CentrodeError, MotionError, Status
from centrode.locale import _
from centrode.quantities import terminal_unit, with_unit
from centrode.topics.topic import InstantsOption, Topic, ValueOption

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.mechanism import Mechanism

TRIALS = 8
"""Instants that are tried for one that works."""


def echo_values(mechanism: Mechanism, *values: tuple[str, float | None]) -> None:
    """Say on stderr how options with values of the drive, or times [SI], were read: in the unit of the display."""
    texts = [
        f"{option}: {_value_text(mechanism, value, unit_name=terminal_unit)}"
        for option, value in values
        if value is not None
    ]
    if texts:
        output.tell("; ".join(texts))


@contextmanager
def default_instants(
    topic: Topic, name: str, mechanism: Mechanism, arguments: Mapping[str, Any]
) -> Iterator[None]:
    """Say which instants a command takes without `--at`; where the initial position fails, name one that works.

    `name` is the file or example; `arguments` are those of the computation, with the instants if they were given.
    """
    parameter = _parameter(topic)
    if not parameter or arguments.get(parameter):
        yield
        return
    with about(name):
        places = library.default_instants(mechanism)
    values = ", ".join(_value_text(mechanism, place, unit_name=terminal_unit) for place in places)
    if mechanism.study.instants:
        output.tell(_("without --at, the instants of [study]: {values}").format(values=values))
        yield
        return
    output.tell(_("without --at, the initial position: {values}").format(values=values))
    try:
        yield
    except MotionError as failure:
        other = _working_instant(topic, mechanism, arguments, parameter)
        if not other:
            raise
        repair = _("choose another instant: {option}").format(option=f'--at "{other}"')
        raise MotionError(failure.where, failure.what, repair) from failure


def _parameter(topic: Topic) -> str:
    """Parameter of the computation that takes the instants; empty where they have no default."""
    if topic.command is None or not topic.command.default_instants:
        return ""
    for option in topic.command.options:
        if isinstance(option, InstantsOption):
            return "at"
        if isinstance(option, ValueOption) and option.name == "at":
            return option.parameter
    return ""


def _working_instant(topic: Topic, mechanism: Mechanism, arguments: Mapping[str, Any], parameter: str) -> str:
    """An instant as text at which the topic can be computed; empty where none was found."""
    with suppress(CentrodeError):
        course = ct.motion(mechanism)
        for place in _clear_places(mechanism, course)[:TRIALS]:
            # a round value: the instant that is tried is the one that is named
            text = _value_text(mechanism, place, ".3g")
            instant = mechanism.motion_parameter.instant.read(text, "--at")
            with suppress(CentrodeError):
                result = topic.compute(mechanism, **{**arguments, parameter: [instant]})
                if topic.command is not None and topic.command.ending is not None:
                    topic.command.ending(result)
                return text
    return ""


def _clear_places(mechanism: Mechanism, course: xr.Dataset) -> list[float]:
    """Instants of the samples that are reached, those first that are farthest from limits and change points."""
    places = mechanism.motion_parameter.instants(course).tolist()
    reached = [status == Status.OK for status in course["status"].values.tolist()]
    bounds = [place for place, ok in zip(places, reached, strict=True) if not ok]
    if mechanism.motion_parameter.states_instants:
        bounds += course["event_value"].values.tolist()

    def clearance(place: float) -> float:
        return min((abs(place - bound) for bound in bounds), default=0.0)

    good = [place for place, ok in zip(places, reached, strict=True) if ok]
    return sorted(good, key=clearance, reverse=True)


def _value_text(
    mechanism: Mechanism, value: float, digits: str = ".9g", unit_name: Callable[[str], str] = str
) -> str:
    """An instant [SI] in the unit of the display, as `--at` takes it unless `unit_name` spells the unit for readers."""
    instant, display = mechanism.motion_parameter.instant, mechanism.display
    unit = {"angle": display.angle, "length": display.length}.get(instant.kind, instant.unit)
    return with_unit(f"{value / library.unit_factor(unit, instant.kind):{digits}}", unit_name(unit))
