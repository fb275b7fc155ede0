"""Controllers of a mechanism at rest: those that matter, as far as they can rest.

At an equilibrium the states of controllers do not change, so their rates are equations like the forces are, and the
states unknowns like the coordinates. An integral of a deviation says that the deviation vanishes; a controller without
states is a spring. (K. J. Astrom and R. M. Murray, Feedback Systems, 2nd ed., 2021, chapters 5 and 11.)
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from centrode.dynamics.forward_dynamics.controllers import INTEGRAL, Control, controls_of
from centrode.dynamics.forward_dynamics.free_loads import coordinate_of_drive
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.motors import OF_SPEED, OF_VALUE, Controller
from centrode.model.simulation import spelt
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.text_formula import TextFormula, compile_formula


def controls_at_rest(
    mechanism: Mechanism, kept: Collection[str], begin: Mapping[str, float]
) -> tuple[Control, ...]:
    """Controllers on which the moment or force of a free drive depends, in the order of `controls_of`.

    Parameters
    ----------
    kept : drives that are held, whatever their controllers give
    begin : coordinate of every drive in the initial position, from which integrals of speeds count [rad or m]

    Raises
    ------
    InputError
        An output depends on time, a state grows at rest, or it is not determined by the position.
    """
    described = tuple(
        _as_signal(_without_integral_of_speed(one, begin), kept) for one in mechanism.controllers
    )
    controls = controls_of(mechanism.model_copy(update={"controllers": described}), coordinate_of_drive)
    outputs = {control.description.name for control in controls}
    needed = {control.description.name for control in controls if control.drives is not None}
    found: list[Control] = []
    # each needs outputs of those before it alone
    for control in reversed(controls):
        if control.description.name not in needed:
            continue
        own = _with_needed_states(control)
        _check(own, outputs)
        needed |= {name for formula in own.formulas.values() for name in formula.used} & outputs
        found.insert(0, own)
    return tuple(found)


def _as_signal(one: Controller, kept: Collection[str]) -> Controller:
    """The controller of a held drive gives others its output, and measures what it measured."""
    if one.drive not in kept:
        return one
    return one.model_copy(update={"drive": None, "measures": one.measures or one.drive})


def _without_integral_of_speed(one: Controller, begin: Mapping[str, float]) -> Controller:
    """The same where the speed itself is integrated: what it has moved by since the initial position."""
    if one.value is not None or one.of != OF_SPEED or not one.integral:
        return one
    where = f"[[controllers]] {one.name}"
    target = compile_formula(one.target or "0", ("t",), where)
    if target.used:
        _refuse_time(where)
    speed = float(target(ARRAYS))
    if speed:
        what = _("its target is a speed of {speed:.6g}: at rest its integral grows without end")
        raise InputError(where, what.format(speed=speed), _("simulate it, or hold its drive"))
    measured = one.measures or one.drive or ""
    changes = {
        "of": OF_VALUE, "target": spelt(begin[measured]), "proportional": one.integral,
        "derivative": one.proportional, "integral": None,
    }  # fmt: skip
    return one.model_copy(update=changes)


def _with_needed_states(control: Control) -> Control:
    """The controller without states on which its output does not depend."""
    states = [name for name, _start in control.states]
    if control.description.value is None:
        needed = set(states) if control.gains.get("integral") else set()
    else:
        needed = _states_behind(control.formulas, control.formulas["value"].used, states)
    kept = tuple(one for one in control.states if one[0] in needed)
    formulas = {name: one for name, one in control.formulas.items() if name not in states or name in needed}
    gains = {name: x for name, x in control.gains.items() if name != "integral" or INTEGRAL in needed}
    return replace(control, states=kept, formulas=formulas, gains=gains)


def _states_behind(
    formulas: Mapping[str, TextFormula], used: Collection[str], states: Sequence[str]
) -> set[str]:
    """States that an output uses, and those on which their rates depend."""
    found, left = set[str](), set(used) & set(states)
    while left:
        name = left.pop()
        found.add(name)
        left |= (set(formulas[name].used) & set(states)) - found
    return found


def _check(control: Control, outputs: Collection[str]) -> None:
    """Refuse what is never at rest, or what is at rest in any state."""
    where = f"[[controllers]] {control.description.name}"
    if any("t" in formula.used for formula in control.formulas.values()):
        _refuse_time(where)
    if control.description.value is None:
        return
    determining = {"q", *outputs, *(name for name, _start in control.states)}
    for name, _start in control.states:
        formula = control.formulas[name]
        if formula.used & determining:
            continue
        rate = float(formula(ARRAYS, **dict.fromkeys(formula.used, 0.0)))
        if rate:
            what = _("at rest its state {state} changes by {rate:.6g} every second").format(
                state=name, rate=rate
            )
            raise InputError(where, what, _("let its rate depend on q or on the state itself"))
        what = _("at rest its state {state} may have any value: its rate depends on the speed alone")
        raise InputError(where, what.format(state=name), _("write with q what its integral stands for"))


def _refuse_time(where: str) -> None:
    what = _("it depends on time, and at rest nothing may")
    raise InputError(where, what, _("write it as a function of the position"))
