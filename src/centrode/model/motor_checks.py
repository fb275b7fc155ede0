"""Checks of motors and controllers beside the rest of a description: their drives, names and formulas."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.motors import controller_variables
from centrode.model.reading import Place, Problem, nearest, value_text
from centrode.numerics.text_formula import compile_formula

if TYPE_CHECKING:
    from centrode.model.description import Description


def motor_problems(mechanism: Description) -> Iterator[Problem]:
    """Problems of motors and controllers: drives that are not there, two motors of one, loops of outputs."""
    drives = [drive.id for drive in mechanism.drives]
    seen: set[str] = set()
    for index, motor in enumerate(mechanism.motors):
        at: Place = ("motors", index)
        yield from _drive(motor.drive, drives, (*at, "drive"))
        if motor.drive in seen:
            what = _("drive {name} has two motors").format(name=value_text(motor.drive))
            yield Problem(what, _("keep one of them"), at)
        seen.add(motor.drive)
        driven = next((one for one in mechanism.drives if one.id == motor.drive), None)
        if driven is not None and driven.kind != "angle":
            yield Problem(_("the drive does not turn"), _("give a controller, whose value is a force"), at)
    names: set[str] = set()
    for index, controller in enumerate(mechanism.controllers):
        at = ("controllers", index)
        for key in ("drive", "measures"):
            name = getattr(controller, key)
            if name is not None:
                yield from _drive(name, drives, (*at, key))
        if controller.drive is None and controller.measures is None and drives:
            yield Problem(_("one of {keys} is missing").format(keys="drive, measures"), "", at)
        if controller.name in names:
            what = _("there are two controllers {name}").format(name=value_text(controller.name))
            yield Problem(what, _("give one of them a different name: name = ..."), at)
        names.add(controller.name)
    yield from _formulas(mechanism)


def _drive(name: str, drives: list[str], at: Place) -> Iterator[Problem]:
    if name not in drives:
        yield Problem(_("there is no drive {name}").format(name=value_text(name)), nearest(name, drives), at)


def _formulas(mechanism: Description) -> Iterator[Problem]:
    """Problems of the formulas, and a loop of outputs that need each other at once."""
    outputs = [one.name for one in mechanism.controllers if one.name.isidentifier()]
    needs: dict[str, set[str]] = {}
    for index, one in enumerate(mechanism.controllers):
        known = controller_variables(one, outputs)
        texts = {"value": one.value, **{f"states.{name}": state.rate for name, state in one.states.items()}}
        for key, text in texts.items():
            if text is None:
                continue
            try:
                used = compile_formula(text, known, "").used
            except InputError as error:
                yield Problem(error.what, error.repair, ("controllers", index, *key.split(".")))
                continue
            if key == "value":
                needs[one.name] = set(used) & set(outputs)
        if one.target is not None:
            try:
                compile_formula(one.target, ("t",), "")
            except InputError as error:
                yield Problem(error.what, error.repair, ("controllers", index, "target"))
    loop = loop_of(needs)
    if loop:
        what = _("the outputs of {names} need each other at the same instant: an algebraic loop")
        repair = _("pass one of them through a state")
        yield Problem(what.format(names=", ".join(map(value_text, loop))), repair, ("controllers",))


def loop_of(needs: Mapping[str, set[str]]) -> list[str]:
    """Names that need each other in a circle; empty where there is none."""
    left = {name: set(others) for name, others in needs.items()}
    while True:
        ready = [name for name, others in left.items() if not others & left.keys()]
        if not ready:
            return sorted(left)
        for name in ready:
            del left[name]
        if not left:
            return []
