"""Motors and controllers of drives in a simulation: `[[motors]]` and `[[controllers]]` of a description."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, PlainValidator

from centrode.locale import _
from centrode.model.reading import (
    DescriptionPart,
    FrozenMap,
    Problem,
    Problems,
    choice,
    missing_key,
    named_entries,
    read_name,
    unknown_keys,
    value_text,
)
from centrode.model.simulation import Motor, spelt
from centrode.model.values import READING, Name, TableColumns, positive, quantity, read_rows, read_text, si

MOST_CONTROLLERS, MOST_STATES, MOST_ROWS = 20, 10, 20
MOTOR_KINDS = ("linear", "asynchronous", "direct current", "table")
CONTROLLER_VARIABLES = ("t", "q", "v")
"""Time [s], the measured coordinate [rad or m] and its speed, in formulas of controllers."""
OF_VALUE, OF_SPEED = TARGETS = ("value", "speed")
_NEEDED = {
    "linear": ("idle_speed", "starting_moment"),
    "asynchronous": ("idle_speed", "breakdown_moment", "breakdown_slip"),
    "direct current": ("voltage", "resistance", "constant"),
    "table": ("table",),
}
_CHARACTERISTIC = tuple(dict.fromkeys(key for keys in _NEEDED.values() for key in keys))


def _rows(value: object) -> tuple[tuple[float, ...], ...] | None:
    if value is None:
        return None
    columns = TableColumns(("angular speed", "torque"), "[speed, moment]", 2)
    rows = read_rows(value, columns, READING.get().folder)
    if not 2 <= len(rows) <= MOST_ROWS or any(not low[0] < high[0] for low, high in itertools.pairwise(rows)):
        what = _("a motor's table has 2 to {most} rows, with speeds that increase")
        raise Problem(what.format(most=MOST_ROWS), _("sort the rows, and keep one of equal speeds"))
    return rows


class DriveMotor(Motor):
    """A motor of one drive; besides the kinds of `Motor`:

    Attributes
    ----------
    drive : id of the drive
    voltage, resistance, constant : float [V, ohm, N m/A]
        Direct current: k (U - k ω) / R, k its constant.
    table : rows of (speed [rad/s], moment [N m])
        Straight lines between them, the last moments beyond.
    """

    drive: Name
    kind: Annotated[Literal["linear", "asynchronous", "direct current", "table"], choice(*MOTOR_KINDS)]  # type: ignore[assignment]
    idle_speed: Annotated[float, quantity("angular speed", positive)] | None = None  # type: ignore[assignment]
    voltage: Annotated[float, quantity("ratio")] | None = None
    resistance: Annotated[float, quantity("ratio", positive)] | None = None
    constant: Annotated[float, quantity("ratio", positive)] | None = None
    table: Annotated[tuple[tuple[float, ...], ...] | None, PlainValidator(_rows)] = None

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given: each kind has its own."""
        # the rules of a part, not those of the motor of a simulation, which has fewer kinds
        found: list[Problem] = DescriptionPart.key_problems.__func__(cls, given)  # type: ignore[attr-defined]
        kind = given.get("kind")
        if found or kind not in _NEEDED:
            return found
        for key in _CHARACTERISTIC:
            if (given.get(key) is None) is (key in _NEEDED[kind]):
                what = _("a motor of the kind {kind} has {keys}, and no other characteristic")
                return [Problem(what.format(kind=value_text(kind), keys=", ".join(_NEEDED[kind])))]
        return found

    @property
    def law(self) -> str:
        """Its moment on the drive [N m] as a formula of the drive's speed v [rad/s]."""
        if self.kind in ("linear", "asynchronous"):
            return super().law
        ratio = spelt(self.ratio)
        if self.kind == "direct current":
            k = spelt(self.constant)
            return f"{ratio}*{k}*({spelt(self.voltage)} - {k}*{ratio}*v)/{spelt(self.resistance)}"
        rows = self.table or ()
        text = spelt(rows[0][1])
        for (low, below), (high, above) in itertools.pairwise(rows):
            share = f"max(min(({ratio}*v - {spelt(low)})/{spelt(high - low)}, 1), 0)"
            text += f" + {spelt(above - below)}*{share}"
        return f"{ratio}*({text.replace('- -', '+ ')})"


class ControllerState(DescriptionPart):
    """A state of a controller: its rate by a formula, and where it starts."""

    rate: Annotated[str, PlainValidator(read_text)]
    start: Annotated[float, quantity("ratio")] = 0.0


def _read_states(value: object) -> Mapping[str, ControllerState]:
    if not isinstance(value, Mapping):
        raise Problem(_("expected a table, got {value}").format(value=value_text(value)))
    found = {}
    for name, entry in named_entries(value, read_name, MOST_STATES).items():
        if not name.isidentifier() or name in CONTROLLER_VARIABLES:
            what = _("{name} is no name of a state").format(name=value_text(name))
            raise Problem(what, _("use letters and digits, and none of t, q, v"))
        if isinstance(entry, ControllerState):
            found[name] = entry
            continue
        table = entry if isinstance(entry, Mapping) else {"rate": entry}
        wrong = unknown_keys(table, ("rate", "start")) + ([] if "rate" in table else [missing_key("rate")])
        if wrong:
            raise Problems([Problem(one.what, one.repair, (name,)) for one in wrong])
        found[name] = ControllerState(**table)
    return FrozenMap(found)


def _formula(value: object) -> str | None:
    if value is None:
        return None
    return spelt(si(value, "ratio")) if isinstance(value, int | float) else read_text(value)


class Controller(DescriptionPart):
    """A controller: the moment or force of a drive from what is measured.

    Attributes
    ----------
    name : by which other controllers use its output
    drive : id of the drive that it moves; None of a signal that others use
    measures : id of the drive whose value q and speed v it measures; its own by default
    target : formula of `t`, for PID
    of : "value" or "speed"
        What is to follow the target.
    proportional, integral, derivative : float [N m or N per unit of what is controlled]
    value : formula of `t`, `q`, `v`, its states and outputs of other controllers, in place of PID
    states : name -> rate (a formula of the same) and start
    most : float
        The output lies between this and its negative.
    """

    name: Name
    drive: Name | None = None
    measures: Name | None = None
    target: Annotated[str | None, PlainValidator(_formula)] = None
    of: Annotated[Literal["value", "speed"], choice(*TARGETS)] = "value"
    proportional: Annotated[float, quantity("ratio")] | None = None
    integral: Annotated[float, quantity("ratio")] | None = None
    derivative: Annotated[float, quantity("ratio")] | None = None
    value: Annotated[str | None, PlainValidator(_formula)] = None
    states: Annotated[Mapping[str, ControllerState], PlainValidator(_read_states)] = Field(
        default=FrozenMap({})
    )
    most: Annotated[float, quantity("ratio", positive)] | None = None

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        """What is wrong with the keys that are given: gains with a target, or a formula."""
        wrong = super().key_problems(given)
        gains = [key for key in ("proportional", "integral", "derivative") if given.get(key) is not None]
        if (given.get("value") is None) is not bool(gains):
            what = _("a controller has a formula (value), or gains (proportional, integral, derivative)")
            wrong.append(Problem(what, _("give one of both")))
        if gains and given.get("target") is None:
            wrong.append(missing_key("target"))
        if gains and given.get("states"):
            wrong.append(Problem(_("states are used with a formula only"), _("remove them, or give value")))
        if given.get("derivative") is not None and given.get("of") == OF_SPEED:
            what = _(
                "the derivative of a speed is an acceleration, which depends on the moment: an algebraic loop"
            )
            wrong.append(Problem(what, _("leave derivative out, or pass the speed through a state")))
        return wrong


def controller_variables(controller: Controller, outputs: list[str]) -> tuple[str, ...]:
    """Names that formulas of a controller may use."""
    return tuple(dict.fromkeys((*CONTROLLER_VARIABLES, *controller.states, *outputs)))
