"""Conclusions from the results of a cam: lift, pressure angle, radii, undercut, forces, contact stress."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import TYPE_CHECKING

from centrode.cams.followers.closed_forms import ClosedForms
from centrode.cams.followers.motion import motion_names
from centrode.quantities import QUANTITIES
from centrode.sheets.sheet import Chapter, Items, Section
from centrode.sheets.texts import NOTHING, Number, Sentence, Text
from centrode.views.curvature_cams import on_both_sides
from centrode.views.curvature_cams import stress as in_megapascals

if TYPE_CHECKING:
    from centrode.cams.cam import RollerPathResults
    from centrode.cams.followers.force_results import FollowerForceResults
    from centrode.cams.followers.motion_results import FollowerMotionResults
    from centrode.cams.followers.profile_results import FollowerProfileResults
    from centrode.cams.results import CamContactResults
    from centrode.numerics.search import Extremes


def cam_conclusions_chapter(
    motion: FollowerMotionResults | None = None,
    profile: FollowerProfileResults | None = None,
    forces: FollowerForceResults | None = None,
    path: RollerPathResults | None = None,
    contact: CamContactResults | None = None,
) -> Chapter:
    """What follows from the results that there are, a sentence each."""
    texts: list[Text] = []
    if motion is not None:
        texts += _lift(motion)
    if profile is not None:
        texts += _profile(profile)
    if path is not None:
        texts += _path(path)
    if forces is not None:
        texts += _forces(forces)
    if contact is not None:
        texts += _contact(contact)
    return Chapter(Sentence("Conclusions"), (Section(NOTHING, (Items(tuple(texts), numbered=True),)),))


def _angle(value: float) -> Number:
    return Number(value, "rad", ".4g", degrees_too=True)


def _lift(results: FollowerMotionResults) -> Iterator[Text]:
    """Greatest lift, velocity and acceleration with their places; by the angle of a cam without a speed."""
    speed = results.motion.speed
    by_angle, in_time = motion_names(results.motion.swings)
    rates = []
    for order, (size, _place) in enumerate(results.greatest[:2], 1):
        unit = QUANTITIES[by_angle[order] if speed is None else in_time[order - 1]].unit
        rates.append(Number(size * (1.0 if speed is None else speed**order), unit, ".4g"))
    yield Sentence(
        "The greatest lift is {lift}, at {at_lift}; the velocity is greatest in magnitude at {at}, {v}, the"
        " acceleration at {there}, {a}.",
        lift=Number(results.lift.greatest, results.motion.unit, ".4g"),
        at_lift=_angle(results.lift.at_greatest),
        at=_angle(results.greatest[0][1]),
        v=rates[0],
        there=_angle(results.greatest[1][1]),
        a=rates[1],
    )


def _profile(results: FollowerProfileResults) -> Iterator[Text]:
    """Radii, pressure angle, undercut."""
    body = results.body
    yield Sentence(
        "The base radius is {radius}; the greatest radius of the profile is {greatest}.",
        radius=Number(body.base_radius, "m", ".4g"),
        greatest=Number(results.greatest_radius, "m", ".4g"),
    )
    if ClosedForms(body).has_pressure_angle:
        yield _pressure(body.pressure)
    yield Sentence("The profile is undercut.") if body.undercuts else Sentence("The profile is not undercut.")


def _pressure(extremes: Extremes) -> Text:
    """The pressure angle that is greatest in size."""
    least, greatest = (
        (extremes.least, extremes.at_least),
        (extremes.greatest, extremes.at_greatest),
    )
    size, place = max(least, greatest, key=lambda one: abs(one[0]))
    return Sentence(
        "The pressure angle is greatest in magnitude at {at}, {angle}.", at=_angle(place), angle=_angle(size)
    )


def _path(results: RollerPathResults) -> Iterator[Text]:
    """Radii of the path of the roller's centre, greatest pressure angle."""
    radius = results.radius
    yield Sentence(
        "The radius of the path of the roller's centre is least at {at_least}, {least}, and greatest at {at_greatest},"
        " {greatest}.",
        at_least=on_both_sides(results.cam, radius.at_least, ".4g"),
        least=Number(radius.least, "m", ".4g"),
        at_greatest=on_both_sides(results.cam, radius.at_greatest, ".4g"),
        greatest=Number(radius.greatest, "m", ".4g"),
    )
    angle, place = results.steepest
    yield Sentence(
        "The pressure angle is greatest in magnitude at {at}, {angle}.",
        at=on_both_sides(results.cam, place, ".4g"),
        angle=_angle(abs(angle)),
    )


def _forces(results: FollowerForceResults) -> Iterator[Text]:
    """Greatest contact force, extremes of the torque, greatest contact stress; nothing where they are not known."""
    turn = results.whole_turn
    if not isfinite(turn["greatest_force"]):
        return
    yield Sentence(
        "The contact force is greatest at {at}, {force}; the torque of the camshaft is least at {at_least}, {least},"
        " and greatest at {at_greatest}, {greatest}.",
        at=_angle(turn["greatest_force_at"]),
        force=Number(turn["greatest_force"], "N", ".4g"),
        at_least=_angle(turn["least_torque_at"]),
        least=Number(turn["least_torque"], "N m", ".4g"),
        at_greatest=_angle(turn["greatest_torque_at"]),
        greatest=Number(turn["greatest_torque"], "N m", ".4g"),
    )
    stress = turn.get("greatest_stress")
    if stress is not None and isfinite(stress):
        yield _stress(stress, _angle(turn["greatest_stress_at"]), turn.get("admissible_stress"))


def _contact(results: CamContactResults) -> Iterator[Text]:
    """The greatest contact stress of roller and cam; nothing where it is not bounded."""
    facts = results.dataset.attrs
    if isfinite(facts["greatest_stress"]):
        place = on_both_sides(results.cam, facts["greatest_stress_at"], ".4g")
        yield _stress(facts["greatest_stress"], place, facts.get("admissible_stress"))


def _stress(value: float, place: Text, admissible: float | None) -> Text:
    """The greatest contact stress [Pa], beside the one that is admissible."""
    numbers: dict[str, Text] = {"at": place, "stress": in_megapascals(value)}
    if admissible is None:
        return Sentence("The contact stress is greatest at {at}, {stress}.", **numbers)
    numbers["admissible"] = in_megapascals(admissible)
    if value <= admissible:
        return Sentence(
            "The contact stress is greatest at {at}, {stress}; {admissible} is admissible.", **numbers
        )
    return Sentence(
        "The contact stress is greatest at {at}, {stress}, more than the admissible {admissible}.", **numbers
    )
