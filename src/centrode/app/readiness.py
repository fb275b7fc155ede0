"""What a description lacks to move: mobility, drives, loose points, limits of its motion."""

from __future__ import annotations

from typing import Any

from centrode import render
from centrode.app.move_drags import way_of
from centrode.app.sketch import SketchParts
from centrode.errors import CentrodeError
from centrode.kinematics.check import check_of
from centrode.locale import _
from centrode.sheets.texts import Number
from centrode.structure.constraints import constraints_of, is_drive, unknowns_of
from centrode.structure.dimensions import dimensions_of
from centrode.structure.plan import drives_against_mobility
from centrode.views import structure


def readiness_of(sketch: SketchParts) -> dict[str, Any]:
    """Mobility, facts, loose points, and what is missing, in sentences."""
    document = sketch.document
    answer: dict[str, Any] = {
        "mobility": None,
        "facts": [],
        "loose": [],
        "missing": [],
        "limit": None,
        "ready": False,
    }
    if document.is_cam:
        answer["ready"] = document.cam is not None
        return answer
    if not sketch.links:
        answer["missing"].append(_("draw a link: press at one joint, release at the other"))
        return answer
    answer["loose"] = sketch.loose_points()
    if document.prepared is None:
        answer["missing"] += _missing_parts(sketch)
        return answer
    checked = check_of(document.prepared)
    display = document.prepared.mechanism.display
    answer["ready"] = True
    answer["mobility"] = checked.mobility
    answer["loose"] = []
    answer["facts"] = [
        {"label": render.screen_text(fact.label, display), "text": render.screen_text(fact.value, display)}
        for fact in structure.facts(checked)
    ]
    answer["limit"] = _limit(sketch)
    return answer


def _missing_parts(sketch: SketchParts) -> list[str]:
    sentences = []
    if not sketch.frame_points and not sketch.guides:
        sentences.append(_("no point belongs to the frame: switch Ground on at one"))
    freedom = _mobility(sketch)
    given = len(sketch.drives)
    if freedom is not None and freedom > given:
        sentences.append(
            _("{comparison}: switch Drive on at a link").format(
                comparison=drives_against_mobility(given, freedom)
            )
        )
    elif freedom is not None and freedom < given:
        sentences.append(
            _("{comparison}: remove one").format(comparison=drives_against_mobility(given, freedom))
        )
    elif not given:
        sentences.append(_("nothing drives the mechanism: switch Drive on at a link"))
    if not sentences:
        sentences += [
            f"{one.message}; {one.repair}" if one.repair else one.message for one in sketch.document.problems
        ]
    return sentences


def _mobility(sketch: SketchParts) -> int | None:
    """Chebyshev's count of a description in the plane that is right in itself; None where it is not."""
    mechanism = sketch.document.mechanism
    if mechanism is None:
        return None
    try:
        dimensions_of(mechanism)
        constraints = [one for one in constraints_of(mechanism) if not is_drive(one)]
    except CentrodeError:
        return None
    width = sum(entity.unknowns for entity in unknowns_of(mechanism))
    return width - sum(one.size for one in constraints)


def _limit(sketch: SketchParts) -> str | None:
    """Where the motion ends, in a sentence; None where a drive at constant speed makes full turns."""
    prepared = sketch.document.prepared
    if prepared is None or not prepared.kinematics.path.parameter.is_uniform:
        return None
    try:
        way = way_of(sketch.document)
    except CentrodeError as failure:
        return failure.what
    if way.closes:
        return None
    drive = prepared.mechanism.drives[0].id
    low, high = float(way.places[0]), float(way.places[-1])
    if prepared.kinematics.path.turns:
        ends = (Number(low, "rad", ".4g"), Number(high, "rad", ".4g"))
    else:
        ends = (Number(low, "m", ".4g"), Number(high, "m", ".4g"))
    low_text, high_text = (render.screen_text(end, prepared.mechanism.display) for end in ends)
    return _("the drive {drive} moves from {low} to {high} only").format(
        drive=drive, low=low_text, high=high_text
    )
