"""Forces between cam and follower in words: contact, springs, torque, stress."""

from __future__ import annotations

import math

import xarray as xr

from centrode.cams.followers.base_circle import has_bounds
from centrode.cams.followers.forces import dataset_of_forces, follower_forces
from centrode.cams.roller_path import angles_of
from centrode.errors import MotionError
from centrode.locale import _
from centrode.model.follower_cam import PlateCam
from centrode.sheets.sheet import Scalar
from centrode.study.cams.said import Asked, CamPart, Rows, Units

MEGA = 1e-6


def forces_part(cam: PlateCam, asked: Asked) -> CamPart | None:
    """Forces over a turn; nothing where neither mass nor spring nor load is given, or no base radius."""
    follower = cam.follower
    given = follower.mass or follower.inertia or follower.load or follower.spring is not None
    if not given or (cam.body.base_radius is None and not has_bounds(cam)):
        return None
    try:
        forces = follower_forces(cam)
    except MotionError:  # told of the profile
        return None
    found = dataset_of_forces(cam, forces, angles_of(cam, asked.samples))
    heading = _("Forces on cam and follower")
    failures = _failures(cam, found)
    return CamPart(
        heading, forces_rows(cam, found), _scalars(cam, found), {"cam-forces": found}, failures=failures
    )


def forces_rows(cam: PlateCam, forces: xr.Dataset) -> Rows:
    """What keeps the contact, how fast the cam may turn, the greatest forces, torque and stress.

    Parameters
    ----------
    cam : PlateCam
    forces : Dataset
        Of `cam_forces`.
    """
    facts, said = forces.attrs, _Said(cam)
    rows = [(_("speed of the cam"), _turns(facts["speed"]) if facts["speed"] else _("none: forces at rest"))]
    rows += _pushing(facts, said)
    if not facts["led"]:
        rows += _springs(facts, said)
    rows += _greatest(facts, said)
    return rows


class _Said:
    """Forces and angles as they are shown."""

    def __init__(self, cam: PlateCam) -> None:
        self.units = Units(cam)
        self.swings = cam.swings
        self.push = "N·m" if cam.swings else "N"

    def at(self, text: str, angle: float) -> str:
        return _("{value} at {angle}").format(value=text, angle=self.units.angle(angle))

    def pushed(self, value: float) -> str:
        return f"{value:.6g} {self.push}"

    def stiffness(self, value: float) -> str:
        return f"{value:.6g} N·m/rad" if self.swings else f"{1e-3 * value:.6g} N/mm"


def _pushing(facts: dict[str, float], said: _Said) -> Rows:
    """The least push, and the speed of jumping."""
    if facts["led"]:
        return [
            (
                _("contact of cam and follower"),
                _("nothing presses the follower on the cam: it has to be led both ways"),
            )
        ]
    least = facts["least_push"]
    if least == -math.inf:
        told = _("lost: the speed of the lift falls by a step at {angle}")
        rows = [
            (_("contact of cam and follower"), told.format(angle=said.units.angle(facts["least_push_at"])))
        ]
    elif least < 0:
        told = _("lost: {push} along the follower").format(push=said.pushed(least))
        rows = [(_("contact of cam and follower"), said.at(told, facts["least_push_at"]))]
    else:
        told = _("kept: at least {push} along the follower").format(push=said.pushed(least))
        rows = [(_("contact of cam and follower"), said.at(told, facts["least_push_at"]))]
    return [*rows, (_("the follower jumps"), _jumps(facts, said))]


def _jumps(facts: dict[str, float], said: _Said) -> str:
    speed = facts["jump_speed"]
    if math.isinf(speed):
        return _("at no speed")
    if speed == 0:
        return _("at every speed")
    told = _("from {speed} on").format(speed=_turns(speed))
    return said.at(told, facts["jump_speed_at"])


def _springs(facts: dict[str, float], said: _Said) -> Rows:
    """Springs that would just keep the contact at this speed."""
    preload, stiffness = facts["preload_needed"], facts["stiffness_needed"]
    if math.isinf(preload):
        return [(_("spring needed"), _("none keeps the contact"))]
    told = _("with this stiffness a preload of {value}").format(value=said.pushed(preload))
    if preload <= 0:
        told = _("with this stiffness no preload")
    rows = [(_("spring needed"), told)]
    if math.isinf(stiffness):
        return [*rows, ("", _("with this preload none is stiff enough"))]
    told = _("with this preload a stiffness of {value}").format(value=said.stiffness(stiffness))
    if stiffness <= 0:
        told = _("with this preload no stiffness")
    return [*rows, ("", told)]


def _greatest(facts: dict[str, float], said: _Said) -> Rows:
    """Greatest force, torque, stress."""
    if math.isinf(facts["greatest_force"]):
        told = _("without bound: friction locks the follower at {angle}")
        return [
            (_("greatest contact force"), told.format(angle=said.units.angle(facts["greatest_force_at"])))
        ]
    if not math.isfinite(facts["greatest_force"]):
        return [(_("greatest contact force"), _("none is known"))]
    rows = [
        (
            _("greatest contact force"),
            said.at(f"{facts['greatest_force']:.6g} N", facts["greatest_force_at"]),
        ),
        (
            _("torque of the camshaft"),
            _("{least} to {greatest}").format(
                least=said.at(f"{facts['least_torque']:.6g} N·m", facts["least_torque_at"]),
                greatest=said.at(f"{facts['greatest_torque']:.6g} N·m", facts["greatest_torque_at"]),
            ),
        ),
    ]
    if math.isfinite(facts["works_difference"]):
        told = _("by virtual work the torque is the same within {apart:.1g} N·m")
        rows.append(("", told.format(apart=facts["works_difference"])))
    stress = facts.get("greatest_stress", math.nan)
    if math.isfinite(stress):
        told = said.at(f"{MEGA * stress:.6g} MPa", facts["greatest_stress_at"])
        rows.append((_("greatest contact stress"), told + _bound(facts)))
    return rows


def _bound(facts: dict[str, float]) -> str:
    admissible = facts.get("admissible_stress")
    if admissible is None:
        return ""
    if facts["greatest_stress"] <= admissible:
        return _(", admissible {stress}").format(stress=f"{MEGA * admissible:.6g} MPa")
    return _(", more than the admissible {stress}").format(stress=f"{MEGA * admissible:.6g} MPa")


def _turns(speed: float) -> str:
    return _("{turns} rpm").format(turns=f"{speed * 30 / math.pi:.6g}")


def _failures(cam: PlateCam, forces: xr.Dataset) -> tuple[str, ...]:
    """A follower that is pressed on the cam and jumps all the same, or that friction locks."""
    facts, said = forces.attrs, _Said(cam)
    told = []
    if not facts["led"] and facts["least_push"] < 0:
        what = _("the follower jumps off the cam at {angle}").format(
            angle=said.units.angle(facts["least_push_at"])
        )
        speed, preload = facts["jump_speed"], facts["preload_needed"]
        if 0 < speed < math.inf:
            repair = _("turn it slower than {speed}, or preload the spring with {value}")
            what += "; " + repair.format(speed=_turns(speed), value=said.pushed(preload))
        told.append(what)
    if math.isinf(facts["greatest_force"]):
        told.append(_("friction locks the follower: no force of the cam moves it"))
    if facts.get("greatest_stress", math.nan) > facts.get("admissible_stress", math.inf):
        what = _("the contact stress is not admissible at {angle}")
        told.append(what.format(angle=said.units.angle(facts["greatest_stress_at"])))
    return tuple(told)


def _scalars(cam: PlateCam, forces: xr.Dataset) -> dict[str, Scalar]:
    push, stiffness = ("N m", "N m/rad") if cam.swings else ("N", "N/m")
    units = {
        "least_push": push,
        "least_push_at": "rad",
        "jump_speed": "rad/s",
        "jump_speed_at": "rad",
        "preload_needed": push,
        "stiffness_needed": stiffness,
        "greatest_force": "N",
        "greatest_force_at": "rad",
        "greatest_torque": "N m",
        "greatest_torque_at": "rad",
        "least_torque": "N m",
        "least_torque_at": "rad",
        "greatest_stress": "Pa",
        "greatest_stress_at": "rad",
    }
    facts = forces.attrs
    return {
        f"cam_{name}": Scalar(facts[name], unit)
        for name, unit in units.items()
        if math.isfinite(facts.get(name, math.nan))
    }
