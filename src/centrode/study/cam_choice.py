"""A cam's contact and what was chosen for it, in sentences and rows."""

from __future__ import annotations

from math import degrees, isfinite
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.choosing.measures import MEASURES
from centrode.locale import _, ngettext
from centrode.quantities import display_unit, typeset_unit

if TYPE_CHECKING:
    import xarray

    from centrode.cams.choosing.choice import Design
    from centrode.cams.choosing.chosen import CamChoice
    from centrode.model.cams import Cam

Rows = list[tuple[str, str]]
MEGA = 1e-6


def contact_rows(cam: Cam, contact: xarray.Dataset) -> Rows:
    """The greatest contact stress by both formulas, and the strip there."""
    facts = contact.attrs
    if not isfinite(facts["greatest_stress"]):
        return [(_("contact stress"), _("the cam is undercut all along"))]
    sign = "±" if cam.curvature.symmetric and facts["greatest_stress_at"] else ""
    told = _("{stress:.5g} MPa at {sign}{angle:.5g} deg").format(
        stress=MEGA * facts["greatest_stress"], sign=sign, angle=degrees(facts["greatest_stress_at"])
    )
    rows = [
        (_("greatest contact stress"), told + _bound(facts)),
        ("", _source(facts)),
    ]
    at = int(np.nanargmax(contact["contact_stress"].to_numpy()))
    strip = _("strip of {width:.4g} mm, greatest shear {shear:.4g} MPa at a depth of {depth:.4g} mm")
    rows.append(
        (
            "",
            strip.format(
                width=2e3 * float(contact["contact_half_width"][at]),
                shear=MEGA * float(contact["contact_shear"][at]),
                depth=1e3 * float(contact["contact_depth"][at]),
            ),
        )
    )
    return rows


def choice_rows(found: CamChoice) -> Rows:
    """What was chosen, with the measures of the start beside, the bounds that bind, and the proof."""
    choice, cam = found.choice, found.cam
    best = _(MEASURES[choice.best].title)
    rows = [
        (
            _("chosen for the least"),
            best if choice.admissible else _("{what}, but no design keeps all bounds").format(what=best),
        )
    ]
    for name, value in choice.chosen.parameters.items():
        rows.append(
            (name, _was(_parameter(cam, name, value), _parameter(cam, name, choice.start.parameters[name])))
        )
    for name in choice.chosen.measures:
        rows.append((_(MEASURES[name].title), _measure(cam, choice.chosen, choice.start, name)))
    return [*rows, *_ending_rows(found)]


def missed_text(found: CamChoice) -> str:
    """By how much the nearest design misses its bounds: "contact stress by 12.3 %"."""
    misses = found.choice.chosen.misses
    each = [
        _("{measure} by {part:.3g} %").format(measure=_(MEASURES[name].title), part=100 * by)
        for name, by in misses.items()
    ]
    return ", ".join(each)


def _ending_rows(found: CamChoice) -> Rows:
    choice, proof = found.choice, found.proof
    agree = ngettext("{n} of {of} search ended there", "{n} of {of} searches ended there", choice.searches)
    rows = [(_("searches"), agree.format(n=min(choice.agreeing, choice.searches), of=choice.searches))]
    if choice.at_ends:
        rows.append((_("at the end of its range"), ", ".join(choice.at_ends)))
    if not choice.admissible:
        return [*rows, (_("missed by the nearest design"), missed_text(found))]
    for name, by in choice.binding.items():
        moved = _("1 % more of it changes the best value by {change:+.3g} %")
        rows.append(
            (
                _("binds: {measure}").format(measure=_(MEASURES[name].title)),
                moved.format(change=-MEASURES[name].sign * by),
            )
        )
    near = _("{admissible} of {all} neighbours keep the bounds, none is better")
    if proof.gain > 0:
        near = _("{admissible} of {all} neighbours keep the bounds, one is better by {gain:.2g}")
    rows.append(
        (_("looked at"), near.format(admissible=proof.admissible, all=proof.neighbours, gain=proof.gain))
    )
    return rows


def _bound(facts: dict[str, float]) -> str:
    admissible = facts.get("admissible_stress")
    if admissible is None:
        return ""
    told = (
        _(", admissible {stress:.5g} MPa")
        if facts["greatest_stress"] <= admissible
        else _(", more than the admissible {stress:.5g} MPa")
    )
    return told.format(stress=MEGA * admissible)


def _source(facts: dict[str, float]) -> str:
    return _("{stress:.5g} MPa by the source's formula, with 0.418").format(
        stress=MEGA * facts["greatest_stress_by_source"]
    )


def _measure(cam: Cam, chosen: Design, start: Design, name: str) -> str:
    judged = chosen.measures[name]
    told = _was(_shown(cam, name, judged.value), _shown(cam, name, start.measures[name].value))
    if judged.bound is None:
        return told
    limit = _("{told}; at least {bound}") if MEASURES[name].least else _("{told}; at most {bound}")
    return limit.format(told=told, bound=_shown(cam, name, judged.bound))


def _was(now: str, before: str) -> str:
    return _("{now} (start {before})").format(now=now, before=before)


def _shown(cam: Cam, name: str, value: float) -> str:
    """A value of a measure with its unit."""
    unit = MEASURES[name].unit
    if unit == "Pa":
        return f"{MEGA * value:.6g} MPa"
    return _in_units(cam, value, unit)


def _parameter(cam: Cam, name: str, value: float) -> str:
    units = {"start.radius": "m", "roller.radius": "m", "start.pressure_angle": "rad"}
    slope = "1/m/rad" if cam.curvature.law == "linear" else "1/rad"
    unit = units.get(name, slope if name == "curvature.k1" else "1/m")
    return _in_units(cam, value, unit)


def _in_units(cam: Cam, value: float, unit: str) -> str:
    angle = "rad" if "/rad" in unit else cam.display.angle
    factor, shown = display_unit(unit, cam.display.length, angle)
    return f"{factor * value:.6g} {typeset_unit(shown)}"
