"""Which keys the loads of each kind need, and which they may have."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from centrode.locale import _
from centrode.model.part import missing_key, one_of
from centrode.model.problems import Problem, shown

FRICTION_SIZES = ("value", "viscous", "quadratic", "coefficient")
# what friction by a coefficient has besides
_OF_HINGE, _OF_SLIDER = ("radius", "fit", "pin"), ("length", "height")
# a force in a point has a vector, one along a guide a value or a table
_IN_POINT, _ALONG_GUIDE = ("vector", "axes", "while_moving"), ("value", "table")

# kind -> keys that it needs, and keys that it may have; a tuple of alternatives needs exactly one of them.
_ALTERNATIVES: dict[str, tuple[str, ...]] = {
    "force": ("point", "guide"),
    "torque": ("link",),
    "spring": ("points", "link"),
    "damper": ("points", "link"),
    "weight": ("link", "point"),
    "friction": ("link", "guide", "point"),
}
_NEEDED: dict[str, tuple[str, ...]] = {
    "force": (),
    "torque": ("value",),
    "spring": ("stiffness",),
    "damper": ("damping",),
    "weight": (),
    "friction": (),
}
_ALLOWED: dict[str, tuple[str, ...]] = {
    "force": ("vector", "value", "table", "axes", "while_moving"),
    "torque": ("relative_to", "axis"),
    "spring": ("free_length", "free_angle", "relative_to", "axis"),
    "damper": ("relative_to", "axis"),
    "weight": ("value",),
    "friction": (*FRICTION_SIZES, "form", "relative_to", "axis", *_OF_HINGE, *_OF_SLIDER),
}


def load_key_problems(kind: str, given: Mapping[str, Any], defaults: Mapping[str, Any]) -> list[Problem]:
    """What is wrong with the keys of a load of a known kind; `defaults` are those of all its keys."""
    present = {key for key, value in given.items() if value is not None}
    said = {key for key in present if key not in defaults or given[key] != defaults[key]}
    alternatives, needed = _ALTERNATIVES[kind], _NEEDED[kind]
    known = {"kind", "name", *alternatives, *needed, *_ALLOWED[kind]}
    problems = [missing_key(key) for key in needed if key not in present]
    problems += [_foreign(key, kind) for key in defaults if key in said and key not in known]
    acts_on = present & set(alternatives)
    if kind == "friction" and "point" in acts_on:
        acts_on -= {"link"}  # at a hinge it says which of the links rubs
    if len(acts_on) != 1:
        words = ", ".join(alternatives)
        problems.append(Problem(_("a {kind} acts on one of: {keys}").format(kind=kind, keys=words)))
    elif kind == "force":
        problems += _of_force(given, present, said)
    elif kind == "friction":
        problems += _of_friction(given, present, said)
    return problems


def _of_force(given: Mapping[str, Any], present: set[str], said: set[str]) -> list[Problem]:
    """A force in a point has a vector; one along a guide a value or a table."""
    if "point" in present:
        missing = [] if "vector" in present else [missing_key("vector")]
        wrong = [key for key in _ALONG_GUIDE if key in present]
        what = _("{key} belongs to a force along a guide")
        repair = _("give vector, or a guide in place of the point")
    else:
        missing = one_of(given, _ALONG_GUIDE)
        wrong = [key for key in _IN_POINT if key in said]
        what = _("{key} belongs to a force in a point")
        repair = _("give value or table, or a point in place of the guide")
    return missing + [Problem(what.format(key=shown(key)), repair) for key in wrong]


def _of_friction(given: Mapping[str, Any], present: set[str], said: set[str]) -> list[Problem]:
    """Friction is as great as its keys say together; the plain sum is one of quadratic friction in hinges."""
    amounts = [key for key in FRICTION_SIZES if key in present]
    if not amounts:
        return [Problem(_("one of {keys} is missing").format(keys=", ".join(FRICTION_SIZES)))]
    if "coefficient" in amounts:
        if len(amounts) > 1:
            what = _("{names} are given together").format(names=", ".join(amounts))
            return [Problem(what, _("keep the coefficient, or the others"))]
        return _of_coefficient(present, said)
    wrong = [key for key in ("point", *_OF_HINGE, *_OF_SLIDER) if key in said]
    if wrong:
        what = _("{key} belongs to friction by a coefficient")
        repair = _("give coefficient in place of {keys}").format(keys=", ".join(amounts))
        return [Problem(what.format(key=shown(key)), repair) for key in wrong]
    if given.get("form") == "plain sum" and (amounts != ["quadratic"] or "link" not in present):
        what = _("the plain sum belongs to quadratic friction in a hinge")
        return [Problem(what, _("take form out, or give quadratic alone"))]
    return []


def _of_coefficient(present: set[str], said: set[str]) -> list[Problem]:
    """A hinge has a point and the radius of its pin; a guide, a slider."""
    problems = []
    if "guide" in present:
        wrong = [key for key in (*_OF_HINGE, "relative_to", "axis", "form") if key in said]
        what, repair = _("{key} belongs to friction in a hinge"), _("take it out, or give point")
    else:
        if "point" not in present:
            what = _("friction by a coefficient in a hinge needs the point of the hinge")
            problems.append(
                Problem(what, _("give point and radius; link says which link rubs, pin which not"))
            )
        elif "radius" not in present:
            problems.append(Problem(_("the radius of the pin is missing"), _("give radius")))
        wrong = [key for key in (*_OF_SLIDER, "relative_to", "axis", "form") if key in said]
        what, repair = _("{key} does not belong to friction by a coefficient there"), _("take it out")
    return problems + [Problem(what.format(key=shown(key)), repair) for key in wrong]


def _foreign(key: str, kind: str) -> Problem:
    known = (*_ALTERNATIVES[kind], *_NEEDED[kind], *_ALLOWED[kind])
    what = _("{key} does not belong to a {kind}").format(key=shown(key), kind=kind)
    return Problem(what, _("it has: {keys}").format(keys=", ".join(known)))
