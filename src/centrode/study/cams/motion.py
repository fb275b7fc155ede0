"""The motion of a cam's follower in words: sizes, peaks of every segment, what jumps at the joints."""

from __future__ import annotations

import math

from centrode.cams.followers.motion import (
    ORDER,
    FollowerMotion,
    Peaks,
    dataset_of_motion,
    derivative,
    extremes_of,
    first_jump,
    follower_motion,
    greatest_size,
    joints_of,
    motion_names,
    peaks_of,
)
from centrode.cams.roller_path import angles_of
from centrode.locale import _, mark
from centrode.model.follower_cam import PlateCam
from centrode.quantities import QUANTITIES
from centrode.sheets.sheet import Scalar
from centrode.study.cams.said import Asked, CamPart, Rows, Table, Units

DERIVATIVES = (
    mark("the lift"),
    mark("the velocity"),
    mark("the acceleration"),
    mark("the jerk"),
    mark("the fourth derivative"),
)
GREATEST = {
    "velocity": mark("greatest velocity"),
    "acceleration": mark("greatest acceleration"),
    "jerk": mark("greatest jerk"),
}
KINDS = {"translating": mark("translating"), "oscillating": mark("oscillating")}
CONTACTS = {"knife": mark("a knife edge"), "roller": mark("a roller"), "flat": mark("a flat face")}


def motion_part(cam: PlateCam, asked: Asked) -> CamPart:
    """The follower's lift over a turn."""
    motion = follower_motion(cam)
    dataset = dataset_of_motion(cam, motion, angles_of(cam, asked.samples))
    sizes, scalars = _sizes(cam, motion)
    rows = [*_follower(cam), *sizes, *_continuity(motion)]
    tables = [_segments(cam, motion), _joints(cam, motion), *_instants(cam, motion)]
    return CamPart(
        _("Motion of the follower"),
        rows,
        scalars | _jump_scalar(motion),
        {"cam-motion": dataset},
        tuple(tables),
        objects={"motion": motion},
    )


def _follower(cam: PlateCam) -> Rows:
    told = _("{kind}, with {contact}").format(
        kind=_(KINDS[cam.follower.kind]), contact=_(CONTACTS[cam.follower.contact])
    )
    rows = [(_("follower"), told)]
    if cam.body.speed is not None:
        said = _("{turns} rpm, a turn takes {time:.6g} s").format(
            turns=f"{cam.body.speed * 30 / math.pi:.6g}", time=math.tau / cam.body.speed
        )
        rows.append((_("speed of the cam"), said))
    return rows


def _sizes(cam: PlateCam, motion: FollowerMotion) -> tuple[Rows, dict[str, Scalar]]:
    """Least and greatest lift, and the greatest sizes of its derivatives."""
    units = Units(cam)
    by_angle, in_time = motion_names(motion.swings)
    lift = extremes_of(motion.law, 1, derivative(0))
    told = _("{least} to {greatest} at {at}").format(
        least=units.text(_clear(lift.least, lift.greatest), motion.unit),
        greatest=units.text(lift.greatest, motion.unit),
        at=units.angle(lift.at_greatest),
    )
    rows = [(_("lift"), told)]
    if lift.least < -ROUNDING * lift.greatest:
        below = _("it goes below 0, to its least value at {at}").format(at=units.angle(lift.at_least))
        rows.append(("", below))
    scalars = {
        "follower_least_lift": Scalar(_clear(lift.least, lift.greatest), motion.unit),
        "follower_greatest_lift": Scalar(lift.greatest, motion.unit),
    }
    for order, (word, label) in enumerate(GREATEST.items(), 1):
        size, at = greatest_size(extremes_of(motion.law, order + 1, derivative(order)))
        unit = QUANTITIES[by_angle[order]].unit
        text = units.text(size, unit)
        scalars[f"follower_greatest_{word}"] = Scalar(size, unit)
        scalars[f"follower_greatest_{word}_at"] = Scalar(at, "rad")
        if motion.speed is not None:
            timed, per_time = size * motion.speed**order, QUANTITIES[in_time[order - 1]].unit
            text = _("{by_angle}, {in_time}").format(by_angle=text, in_time=units.text(timed, per_time))
            scalars[f"follower_greatest_{word}_in_time"] = Scalar(timed, per_time)
        rows.append((_(label), _("{value} at {at}").format(value=text, at=units.angle(at))))
    return rows, scalars


ROUNDING = 1e-12
"""Share of the greatest value, of the lift or a derivative, that rounding may leave of a zero."""


def _clear(value: float, greatest: float) -> float:
    """A value without the rounding of one that vanishes."""
    return 0.0 if abs(value) <= ROUNDING * greatest else value


def _continuity(motion: FollowerMotion) -> Rows:
    """Up to which derivative all is continuous, and what the first that is not does to the follower."""
    order = first_jump(motion)
    if order is None:
        told = _("all derivatives up to the fourth")
    elif order == 1:
        told = _("the lift; the velocity jumps: the follower takes blows")
    elif order == 2:
        told = _("up to the velocity; the acceleration jumps: the jerk has no bound")
    else:
        told = _("up to {last}; {first} jumps").format(
            last=_(DERIVATIVES[order - 1]), first=_(DERIVATIVES[order])
        )
    return [(_("continuous"), told)]


def _jump_scalar(motion: FollowerMotion) -> dict[str, Scalar]:
    order = first_jump(motion)
    return {} if order is None else {"follower_first_jump": Scalar(order, "1")}


def _segments(cam: PlateCam, motion: FollowerMotion) -> Table:
    units = Units(cam)
    turn, angle = units.shown("rad")
    factor, unit = units.shown(motion.unit)
    header = (
        _("segment"), f"φ, {angle}", f"{'ψ' if motion.swings else 's'}, {unit}", _("curve"), "C_v", "C_a", "C_j"
    )  # fmt: skip
    lines: list[tuple[str, ...]] = []
    before = 0.0
    for number, segment in enumerate(cam.segments):
        first, last = motion.joints[number : number + 2]
        after = before if segment.to is None else segment.to
        lift = (
            f"{before * factor:.6g}" if after == before else f"{before * factor:.6g} … {after * factor:.6g}"
        )
        lines.append(
            (
                str(number + 1),
                f"{first * turn:.6g} … {last * turn:.6g}",
                lift,
                _(segment.curve),
                *coefficients_text(peaks_of(motion.law, number)),
            )
        )
        before = after
    heading = _("Segments, and their greatest velocity, acceleration and jerk in parts of h/β, h/β², h/β³")
    return Table(heading, header, lines)


def coefficients_text(peaks: Peaks) -> tuple[str, str, str]:
    """Peak coefficients as a table shows them; a dash where nothing moves."""
    first, second, third = (f"{one:.5g}" if peaks.coefficients[0] else "–" for one in peaks.coefficients)
    return first, second, third


def _joints(cam: PlateCam, motion: FollowerMotion) -> Table:
    """What jumps where segments meet; the end of the last one stands at 0."""
    units = Units(cam)
    turn, angle = units.shown("rad")
    names = motion_names(motion.swings)[0][1 : ORDER + 1]
    shown = [(QUANTITIES[name].symbol, *units.shown(QUANTITIES[name].unit)) for name in names]
    header = (f"φ, {angle}", *(symbol if unit == "1" else f"{symbol}, {unit}" for symbol, _f, unit in shown))
    joints = joints_of(motion)
    lines = []
    for joint in (joints[-1], *joints[:-1]):
        place = 0.0 if joint is joints[-1] else joint.angle
        jumps = [
            f"{jump * factor:+.6g}" if jump else "–"
            for jump, (_symbol, factor, _unit) in zip(joint.jumps[1:], shown, strict=True)
        ]
        lines.append((f"{place * turn:.6g}", *jumps))
    return Table(_("Jumps of the derivatives where segments meet"), header, lines)


def _instants(cam: PlateCam, motion: FollowerMotion) -> list[Table]:
    if not cam.study.instants:
        return []
    units = Units(cam)
    turn, angle = units.shown("rad")
    names = motion_names(motion.swings)[0][:4]
    shown = [(QUANTITIES[name].symbol, *units.shown(QUANTITIES[name].unit)) for name in names]
    header = (f"φ, {angle}", *(symbol if unit == "1" else f"{symbol}, {unit}" for symbol, _f, unit in shown))
    values = motion.lift(cam.study.instants, len(names) - 1)
    for order, row in enumerate(values):
        size = abs(greatest_size(extremes_of(motion.law, order + 1, derivative(order)))[0])
        row[abs(row) <= ROUNDING * size] = 0.0
    lines = [
        (
            f"{phi * turn:.6g}",
            *(f"{value * factor:.6g}" for value, (_s, factor, _u) in zip(row, shown, strict=True)),
        )
        for phi, row in zip(cam.study.instants, values.T, strict=True)
    ]
    return [Table(_("Positions"), header, lines)]
