"""What was chosen for a cam, in words: parameters, measures, the bounds that bind, the proof."""

from __future__ import annotations

from centrode.cams.parameter_choice.problem import MEASURES
from centrode.cams.parameter_choice.search import CamChoice, choose_cam
from centrode.locale import _, ngettext
from centrode.model.cam import CONSTANT, Cam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.parts import Asked, CamPart, CamTable, Rows, Units

MEGA = 1e-6
UNITS = {
    "curvature.k1": "1/rad",
    "start.radius": "m",
    "roller.radius": "m",
    "start.pressure_angle": "rad",
}
"""SI units of parameters; others are curvatures."""


def choice_part(cam: Cam, asked: Asked) -> CamPart | None:
    """What `[choose]` asks for; nothing where the description has none."""
    if cam.choose is None:
        return None
    found = choose_cam(cam, front=asked.front)
    choice = found.choice
    scalars = {
        f"chosen.{name}": Scalar(value, parameter_unit(cam, name))
        for name, value in choice.chosen.parameters.items()
    }
    for name in found.measures:
        scalars[f"chosen.{name}"] = Scalar(choice.chosen.measures[name].value, MEASURES[name].unit)
    failures: tuple[str, ...] = ()
    if not choice.admissible:
        what = _("no design keeps all bounds; the nearest misses {bounds}").format(bounds=missed_text(found))
        failures = (f"{what}; " + _("move a bound, or widen the ranges of the parameters"),)
    tables = (_parameters(found), _measures(found))
    return CamPart(
        _("Chosen parameters"), choice_rows(found), scalars, {}, tables, failures, {"choice": found}
    )


def choice_rows(found: CamChoice) -> Rows:
    """What was made best, how the search ended, the bounds that bind, and the proof.

    Parameters
    ----------
    found : CamChoice
        Of `choose_cam`.
    """
    choice = found.choice
    best = _(MEASURES[choice.best].title)
    agree = ngettext("{n} of {of} search ended there", "{n} of {of} searches ended there", choice.searches)
    rows = [
        (_("made least"), best),
        (_("searches"), agree.format(n=min(choice.agreeing, choice.searches), of=choice.searches)),
    ]
    if choice.at_ends:
        rows.append((_("at an end of its range"), ", ".join(choice.at_ends)))
    if not choice.admissible:
        told = _("no design keeps all bounds; the nearest misses {bounds}").format(bounds=missed_text(found))
        return [*rows, (_("result"), told)]
    for name, by in choice.binding.items():
        moved = _("a bound greater by 1 % changes the best value by {change:+.3g} %")
        label = _("binds: {measure}").format(measure=_(MEASURES[name].title))
        rows.append((label, moved.format(change=-MEASURES[name].sign * by)))
    return [*rows, *_proof(found)]


def missed_text(found: CamChoice) -> str:
    """By how much the nearest design misses its bounds: "contact stress by 12.3 %"."""
    each = _("{measure} by {part:.3g} %")
    return ", ".join(
        each.format(measure=_(MEASURES[name].title), part=100 * by)
        for name, by in found.choice.chosen.misses.items()
    )


def parameter_unit(cam: Cam, name: str) -> str:
    """SI unit of a parameter: that of k1 depends on the law."""
    if name == "curvature.k1" and cam.curvature.law == "linear":
        return "1/m/rad"
    return "1" if CONSTANT.fullmatch(name) else UNITS.get(name, "1/m")


def _proof(found: CamChoice) -> Rows:
    proof = found.proof
    kept = _("kept along the path itself, to {excess:.0e} of them").format(excess=max(proof.excess, 1e-9))
    near = _("{admissible} of {all} near by keep the bounds, none of them is better")
    if proof.better is not None:
        near = _("{admissible} of {all} near by keep the bounds, one is better by {gain:.2g} of the value")
    told = near.format(admissible=proof.admissible, all=proof.neighbours, gain=proof.gain)
    return [(_("bounds"), kept), (_("other designs"), told)]


def _parameters(found: CamChoice) -> CamTable:
    units = Units(found.cam)
    chosen, start = found.choice.chosen.parameters, found.choice.start.parameters
    assert found.cam.choose is not None
    lines: list[tuple[str, ...]] = []
    for name, value in chosen.items():
        unit = parameter_unit(found.cam, name)
        low, high = found.cam.choose.parameters[name]
        lines.append((name, *(units.text(one, unit) for one in (value, start[name], low, high))))
    return CamTable(
        _("Parameters"), (_("parameter"), _("chosen"), _("start"), _("from"), _("to")), lines, named=True
    )


def _measures(found: CamChoice) -> CamTable:
    lines: list[tuple[str, ...]] = []
    for name in found.measures:
        judged, bound = found.choice.chosen.measures[name], ""
        if judged.bound is not None:
            told = _("at least {value}") if MEASURES[name].least else _("at most {value}")
            bound = told.format(value=_shown(found.cam, name, judged.bound))
        before = _shown(found.cam, name, found.choice.start.measures[name].value)
        lines.append((_(MEASURES[name].title), _shown(found.cam, name, judged.value), before, bound))
    return CamTable(_("Measures"), (_("measure"), _("chosen"), _("start"), _("bound")), lines, named=True)


def _shown(cam: Cam, name: str, value: float) -> str:
    """A value of a measure with its unit."""
    unit = MEASURES[name].unit
    return f"{MEGA * value:.6g} MPa" if unit == "Pa" else Units(cam).text(value, unit)
