"""Controllers of a free motion: outputs of what is measured and of states of their own, over any algebra."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from centrode.dynamics.load_coordinates import Coordinate
from centrode.model.mechanism import Drive, Mechanism
from centrode.model.motors import OF_SPEED, Controller, controller_variables
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.text_formula import TextFormula, compile_formula

Number: TypeAlias = Any
INTEGRAL = "integral of the deviation"
GAINS = ("proportional", "integral", "derivative", "most")


@dataclass(frozen=True)
class Control:
    """A controller: its output, the rates of its states, and what it moves and measures.

    Attributes
    ----------
    label : of results
    drives, measures : along what its output works, and what it measures; None of a signal, and of time alone
    states : names with their values at the start
    gains : "proportional", "integral", "derivative" and "most", as far as they are given; "target" that is a number
    """

    description: Controller
    label: str
    drives: Coordinate | None
    measures: Coordinate | None
    states: tuple[tuple[str, float], ...]
    formulas: Mapping[str, TextFormula]
    gains: Mapping[str, Number]

    @property
    def uses_place(self) -> bool:
        """Whether the value of what it measures counts, and not its speed alone."""
        if self.description.value is None:
            return self.description.of != OF_SPEED
        return any("q" in formula.used for formula in self.formulas.values())

    def output(self, m: Any, given: Mapping[str, Number]) -> Number:
        """Its moment or force at given numbers: t, q, v, its states and outputs of others."""
        gains, most = self.gains, self.gains.get("most")
        if self.description.value is not None:
            size = self._evaluate(m, "value", given)
        else:
            error, rate = self._deviation(m, given)
            size = gains.get("proportional", 0.0) * error
            if "integral" in gains:
                size = size + gains["integral"] * given[INTEGRAL]
            if "derivative" in gains:
                size = size + gains["derivative"] * rate
        return size if most is None else m.max(m.min(size, most), -most)

    def rates(self, m: Any, given: Mapping[str, Number]) -> list[Number]:
        """Rates of its states."""
        if self.description.value is None:
            return [self._deviation(m, given)[0] for _state in self.states]
        return [self._evaluate(m, name, given) for name, _start in self.states]

    def _evaluate(self, m: Any, name: str, given: Mapping[str, Number]) -> Number:
        formula = self.formulas[name]
        return formula(m, **{word: given[word] for word in formula.used})

    def _deviation(self, m: Any, given: Mapping[str, Number]) -> tuple[Number, Number]:
        """Target less what follows it, and the rate of that; of a speed no rate is needed."""
        value, slope = self.gains.get("target"), 0.0
        if value is None:
            target = self.formulas["target"](JetFunctions(m), t=Jet((given["t"], 1.0)))
            value, slope = target.coefficients if isinstance(target, Jet) else (target, 0.0)
        if self.description.of == OF_SPEED:
            return value - given["v"], 0.0
        return value - given["q"], slope - given["v"]


CoordinateOf: TypeAlias = Callable[[Mechanism, Drive], Coordinate]


def controls_of(mechanism: Mechanism, coordinate_of: CoordinateOf) -> tuple[Control, ...]:
    """Controllers in an order in which each needs outputs of those before it alone.

    `coordinate_of` says what the force of a drive works along.
    """
    outputs = [one.name for one in mechanism.controllers if one.name.isidentifier()]
    left, ordered = list(mechanism.controllers), []
    while left:
        waiting = {one.name for one in left}
        ready = next(one for one in left if not _needed_variables(one, outputs) & waiting)
        ordered.append(_control(mechanism, ready, outputs, coordinate_of))
        left.remove(ready)
    return tuple(ordered)


def _needed_variables(one: Controller, outputs: list[str]) -> set[str]:
    if one.value is None:
        return set()
    return set(compile_formula(one.value, controller_variables(one, outputs), "").used) & set(outputs)


def _control(
    mechanism: Mechanism, one: Controller, outputs: list[str], coordinate_of: CoordinateOf
) -> Control:
    where = f"[[controllers]] {one.name}"
    known = controller_variables(one, outputs)
    texts = {name: state.rate for name, state in one.states.items()}
    if one.value is not None:
        texts["value"] = one.value
    formulas = {name: compile_formula(text, known, where) for name, text in texts.items()}
    gains = {key: getattr(one, key) for key in GAINS if getattr(one, key) is not None}
    states = tuple((name, state.start) for name, state in one.states.items())
    if one.target is not None:
        target = compile_formula(one.target, ("t",), where)
        if target.used:
            formulas["target"] = target
        else:
            gains["target"] = float(target(ARRAYS))
    if one.integral is not None:
        states = ((INTEGRAL, 0.0),)

    def along(name: str | None) -> Coordinate | None:
        return None if name is None else coordinate_of(mechanism, mechanism.drive(name))

    return Control(
        one,
        f"controller {one.name}",
        along(one.drive),
        along(one.measures or one.drive),
        states,
        formulas,
        gains,
    )


def outputs_of(
    m: Any,
    controls: Sequence[Control],
    time: Number,
    measured: Sequence[tuple[Number, Number]],
    states: Sequence[Number],
) -> tuple[list[Number], list[Number]]:
    """Outputs of all controllers, and rates of all states.

    Parameters
    ----------
    measured : of every controller the coordinate and its speed
    states : in their order
    """
    outputs: dict[str, Number] = {}
    own: list[dict[str, Number]] = []
    first = 0
    for control, (q, v) in zip(controls, measured, strict=True):
        names = [name for name, _start in control.states]
        given = {"t": time, "q": q, "v": v, **dict(zip(names, states[first:], strict=False))}
        first += len(names)
        own.append(given)
        outputs[control.description.name] = control.output(m, outputs | given)
    rates = [
        rate
        for control, given in zip(controls, own, strict=True)
        for rate in control.rates(m, outputs | given)
    ]
    return list(outputs.values()), rates


def states_of(controls: Sequence[Control]) -> tuple[float, ...]:
    """Values of all states at the start, in their order."""
    return tuple(start for control in controls for _name, start in control.states)
