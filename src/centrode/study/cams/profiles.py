"""The profile of a cam in words: how it closes, what its return arc keeps, undercut."""

from __future__ import annotations

import math

from centrode.cams.profiles import ProfileBody, Undercut, cam_body
from centrode.cams.results import count_of, profile_dataset, shoe_dataset, wheel_of
from centrode.cams.walking_wheel import WheelMover, WheelRolling, rolling
from centrode.errors import MotionError
from centrode.locale import _
from centrode.model.cam import Cam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.parts import Asked, CamPart, Rows, Units


def profile_part(cam: Cam, asked: Asked) -> CamPart | None:
    """The profile that the roller leaves; nothing without a roller."""
    if cam.roller is None:
        return None
    heading = _("Profile of the cam")
    try:
        body = cam_body(cam)
    except MotionError as refusal:
        return CamPart(
            heading, [(_("return arc"), _("none"))], {}, failures=(f"{refusal.what}; {refusal.repair}",)
        )
    units = Units(cam)
    rows = [
        (_("roller"), _("radius {radius}").format(radius=units.text(body.roller))),
        *_closing(body, units),
        *_bends(body, units),
    ]
    dataset = profile_dataset(body, count_of(cam, asked.samples), groove=asked.groove)
    return CamPart(heading, rows, _scalars(body), {"cam-profile": dataset}, objects={"body": body})


def _closing(body: ProfileBody, units: Units) -> Rows:
    """The working arc, the return arc, and how they join."""
    working = body.closed.arcs[0]
    ends = {"first": units.angle(working.start), "last": units.angle(working.stop)}
    rows = [(_("working arc"), _("{first} to {last}").format(**ends))]
    if not body.closed.whole:
        return [*rows, (_("closure"), _("open: give [return] or [mover] to close it"))]
    if body.returned is None:
        return [*rows, (_("closure"), _kinks(body, units))]
    found = body.returned
    size = _(
        "ρ {least} to {greatest}, radius of curvature from {bend}, pressure angle up to {steepest}"
    ).format(
        least=units.text(found.radius.least),
        greatest=units.text(found.radius.greatest),
        bend=units.text(1.0 / found.curvature.greatest),
        steepest=units.angle(max(-found.pressure_angle.least, found.pressure_angle.greatest), 5),
    )
    shape = _("convex") if found.curvature.least >= 0.0 else _hollow(found.curvature.least, units)
    way = _("the smoothest by itself") if not found.additions else _("the smoothest within the bounds")
    joined = _(
        "joined in value, slope and curvature: gap {gap:.1g} m, kink {kink:.1g} rad, curvature {jump:.1g}"
    )
    gaps = max(abs(joint.gap) for joint in body.closed.joints)
    return [
        *rows,
        (_("return arc"), f"{way}, {shape}"),
        ("", size),
        ("", joined.format(gap=gaps, kink=body.closed.greatest_kink, jump=body.greatest_jump)),
    ]


def _hollow(curvature: float, units: Units) -> str:
    return _("hollow with a radius from {radius}").format(radius=units.text(-1.0 / curvature))


def _kinks(body: ProfileBody, units: Units) -> str:
    """How a path closes that was not designed to."""
    if not body.kinks:
        return _("closed without a kink")
    places = ", ".join(f"{math.degrees(math.remainder(one.at, math.tau)):.6g}" for one in body.kinks)
    worst = max(body.kinks, key=lambda one: abs(one.kink))
    text = _("kinks of {kink} outwards at {places} deg")
    if worst.kink > 0:
        text = _("kinks of {kink} inwards at {places} deg")
    return text.format(kink=units.angle(abs(worst.kink), 6), places=places)


def _bends(body: ProfileBody, units: Units) -> Rows:
    """Undercut, and the roller that would be too large."""
    most, at = body.greatest_roller
    least = most - body.roller
    rows = []
    if math.isfinite(most):
        text = _("from {radius} where it is convex, at {at}").format(
            radius=units.text(least), at=units.angle(at)
        )
        rows.append((_("radius of curvature of the profile"), text))
        rows.append((_("greatest roller"), _("below {radius}").format(radius=units.text(most))))
    if body.undercuts:
        text = ", ".join(_stretch(one) for one in body.undercuts)
        rows.append((_("undercut"), _("from {stretches} deg").format(stretches=text)))
    else:
        rows.append((_("undercut"), _("none")))
        depth, place = body.overlap
        if depth:
            text = _("the roller at {place} overlaps the cam by {depth} across a waist")
            rows.append(
                (_("overlap"), text.format(place=units.angle(place), depth=units.text(depth, digits=3)))
            )
    return rows


def _stretch(one: Undercut) -> str:
    start = math.degrees(math.remainder(one.start, math.tau))
    stop = start + math.degrees(one.stop - one.start)
    return _("{first:.6g} to {last:.6g}").format(first=start, last=stop)


def _scalars(body: ProfileBody) -> dict[str, Scalar]:
    most, at = body.greatest_roller
    scalars = {
        "cam_closed": Scalar(int(body.closed.whole), "1"),
        "cam_kink": Scalar(body.closed.greatest_kink, "rad"),
        "cam_undercuts": Scalar(len(body.undercuts), "1"),
        "cam_overlap": Scalar(body.overlap[0], "m"),
    }
    if math.isfinite(most):
        scalars["cam_greatest_roller"] = Scalar(most, "m")
        scalars["cam_greatest_roller_at"] = Scalar(at, "rad")
    if body.returned is not None:
        scalars["cam_return_least_radius"] = Scalar(body.returned.radius.least, "m")
        scalars["cam_return_greatest_radius"] = Scalar(body.returned.radius.greatest, "m")
    return scalars


# A walking wheel in words: step, evenness of its travel, shoe, and the proof that it rolls level without
# slip.

LEAST_ANGLE = 1e-9
"""Smaller angles [rad] are said to be zero."""
DUG = 1e-9
"""Share of the hub's height by which a shoe may seem to dig in by rounding."""


def walking_part(cam: Cam, asked: Asked) -> CamPart | None:
    """The walking wheel; nothing without a mover."""
    if cam.mover is None:
        return None
    heading = _("Walking wheel")
    try:
        body = cam_body(cam)
    except MotionError:  # told of the profile
        return None
    try:
        wheel = wheel_of(cam, body)
    except MotionError as refusal:
        return CamPart(heading, [(_("shoe"), _("none"))], {}, failures=(f"{refusal.what}; {refusal.repair}",))
    proof, units = rolling(wheel), Units(cam)
    rows = [*_travel(wheel, units), *_shoe(wheel, units), *_proof(wheel, proof, units, uneven(body, wheel))]
    dataset = shoe_dataset(wheel, count_of(cam, asked.samples))
    return CamPart(
        heading,
        rows,
        _walking_scalars(wheel, proof),
        {"shoe-profile": dataset},
        (),
        _failures(wheel, proof, units),
        {"wheel": wheel},
    )


def uneven(body: ProfileBody, wheel: WheelMover) -> list[tuple[float, float]]:
    """Stretches [rad] of a standing leg on which the profile is undercut: the roller leaves its path there."""
    found = []
    for one in body.undercuts:
        for turn in (0.0, math.tau):
            start, stop = max(one.start - turn, -wheel.half), min(one.stop - turn, wheel.half)
            if stop - start > LEAST_ANGLE:
                found.append((start, stop))
    return sorted(found)


def _failures(wheel: WheelMover, proof: WheelRolling, units: Units) -> tuple[str, ...]:
    """What keeps the wheel from walking."""
    failures = []
    if proof.clearance < -DUG * wheel.height:
        text = _(
            "a returning shoe digs {depth} into the ground where its leg is at {at}; bound greatest_radius in [return]"
        )
        failures.append(text.format(depth=units.text(-proof.clearance), at=units.angle(proof.clearance_at)))
    if proof.room < -DUG * wheel.height:
        text = _(
            "the rollers of neighbouring legs overlap by {depth} where one leg is at {at}; "
            "take smaller rollers or fewer legs"
        )
        failures.append(text.format(depth=units.text(-proof.room), at=units.angle(proof.room_at)))
    return tuple(failures)


def _travel(wheel: WheelMover, units: Units) -> Rows:
    half, rates = units.angle(wheel.half), wheel.rates
    uneven = _("dX/dφ {least} at {least_at} to {greatest} at {greatest_at}, ratio {ratio:.6g}")
    return [
        (_("legs"), _("{count}, each stands over ±{half}").format(count=wheel.legs, half=half)),
        (_("height of the hub"), units.text(wheel.height)),
        (
            _("step"),
            _("{step}; a turn travels {turn}").format(
                step=units.text(wheel.step), turn=units.text(wheel.step * wheel.legs)
            ),
        ),
        (
            _("unevenness of the travel"),
            uneven.format(
                least=units.text(rates.least, "m/rad"),
                least_at=_both_sides(rates.at_least, units),
                greatest=units.text(rates.greatest, "m/rad"),
                greatest_at=_both_sides(rates.at_greatest, units),
                ratio=wheel.unevenness,
            ),
        ),
    ]


def _shoe(wheel: WheelMover, units: Units) -> Rows:
    bend, at = wheel.shoe.least_bend
    gap = _("and {gap} between them") if wheel.print_gap >= 0 else _("overlapping by {gap}")
    prints = _("{length} long").format(length=units.text(wheel.print_length))
    return [
        (_("footprints"), f"{prints}, {gap.format(gap=units.text(abs(wheel.print_gap)))}"),
        (
            _("shoe"),
            _("radius of curvature from {bend} at {at}").format(
                bend=units.text(bend), at=_both_sides(at, units)
            ),
        ),
    ]


def _proof(wheel: WheelMover, proof: WheelRolling, units: Units, cut: list[tuple[float, float]]) -> Rows:
    level = _("the shoe put on the ground holds the hub level to {error}")
    slip = _("the shoe's point at the contact moves at {slip:.1g} of the hub's speed")
    arcs = _("arc of the shoe {arc}, ground travelled {ground}, apart by {apart}")
    rows = [(_("level"), level.format(error=units.text(proof.level, digits=2)))]
    if cut:
        where = ", ".join(
            _("{first} to {last}").format(first=units.angle(first), last=units.angle(last))
            for first, last in cut
        )
        lost = _("but not from {where}: the profile is undercut there and the roller leaves its path")
        rows.append(("", lost.format(where=where)))
    rows += [
        (_("no slip"), slip.format(slip=proof.slip)),
        (
            "",
            arcs.format(
                arc=units.text(proof.shoe_arc, digits=10),
                ground=units.text(proof.ground, digits=10),
                apart=units.text(abs(proof.shoe_arc - proof.ground), digits=2),
            ),
        ),
    ]
    if abs(proof.joint) > DUG * wheel.height:
        jump = _("the hub's dX/dφ jumps by {jump} where the next leg takes over")
        rows.append((_("change of legs"), jump.format(jump=units.text(proof.joint, "m/rad"))))
    if proof.clearance >= -DUG * wheel.height:
        rows.append((_("returning legs"), _("clear of the ground")))
    if proof.room >= -DUG * wheel.height:
        rows.append((_("neighbouring rollers"), _("{room} apart").format(room=units.text(proof.room))))
    return rows


def _walking_scalars(wheel: WheelMover, proof: WheelRolling) -> dict[str, Scalar]:
    return {
        "walking_legs": Scalar(wheel.legs, "1"),
        "walking_hub_height": Scalar(wheel.height, "m"),
        "walking_step": Scalar(wheel.step, "m"),
        "walking_turn": Scalar(wheel.step * wheel.legs, "m"),
        "walking_least_rate": Scalar(wheel.rates.least, "m/rad"),
        "walking_greatest_rate": Scalar(wheel.rates.greatest, "m/rad"),
        "walking_unevenness": Scalar(wheel.unevenness, "1"),
        "walking_footprint": Scalar(wheel.print_length, "m"),
        "walking_footprint_gap": Scalar(wheel.print_gap, "m"),
        "walking_level_error": Scalar(proof.level, "m"),
        "walking_slip": Scalar(proof.slip, "1"),
        "walking_arc_difference": Scalar(abs(proof.shoe_arc - proof.ground), "m"),
        "walking_clearance": Scalar(proof.clearance, "m"),
        "walking_roller_room": Scalar(proof.room, "m"),
        "walking_half": Scalar(math.pi / wheel.legs, "rad"),
    }


def _both_sides(at: float, units: Units) -> str:
    """An angle, on both sides where the law is the same there."""
    at = at if abs(at) > LEAST_ANGLE else 0.0
    both = isinstance(units.cam, Cam) and units.cam.curvature.symmetric and at
    return f"±{units.angle(abs(at))}" if both else units.angle(at)
