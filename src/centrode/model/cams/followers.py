"""Parts of a cam with a follower: cam, follower, spring, bounds, tool, study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import PlainValidator, field_validator

from centrode.locale import _
from centrode.model import limits
from centrode.model.asked import read_samples
from centrode.model.cams.parts import Material
from centrode.model.cams.values import Flag, Size, Steepness, Stress
from centrode.model.entries import choice, listed
from centrode.model.part import Part, missing_key
from centrode.model.problems import Problem, shown
from centrode.model.segments import DRIVEN
from centrode.model.values import Angle, not_negative, positive, quantity, si

KINDS = ("translating", "oscillating")
CONTACTS = ("knife", "roller", "flat")
TURNS = ("counter-clockwise", "clockwise")


class CamBody(Part):
    """The cam: table [cam].

    Attributes
    ----------
    base_radius : float [m] or None
        Least distance of the follower's contact place (of a roller: of the cam's profile) from the centre, at lift 0.
    turn : "counter-clockwise" or "clockwise"
    speed : float [rad/s] or None
        Of the camshaft, positive.
    thickness : float [m] or None
        Width of the cam across its plane.
    material : Material or None
    """

    base_radius: Size | None = None
    turn: Annotated[Literal["counter-clockwise", "clockwise"], choice(*TURNS)] = "counter-clockwise"
    speed: Annotated[float, quantity("angular speed", positive)] | None = None
    thickness: Size | None = None
    material: Material | None = None


class Spring(Part):
    """A spring that presses the follower on the cam.

    Attributes
    ----------
    stiffness : float [N/m], of an oscillating follower [N*m/rad]
    preload : float [N], of an oscillating follower [N*m]
        At lift 0.
    """

    stiffness: float
    preload: float = 0.0

    @field_validator("stiffness", mode="plain")
    @classmethod
    def _stiffness(cls, value: object) -> float:
        return not_negative(value, "angular stiffness" if DRIVEN.get() == "angle" else "stiffness")

    @field_validator("preload", mode="plain")
    @classmethod
    def _preload(cls, value: object) -> float:
        return not_negative(value, "torque" if DRIVEN.get() == "angle" else "force")


class Follower(Part):
    """What the cam moves.

    Attributes
    ----------
    kind : "translating" or "oscillating"
    contact : "knife", "roller" or "flat"
    roller_radius : float [m]
        Of a roller.
    offset : float [m]
        Of a translating follower: of its line from the cam's centre.
    arm, pivot_distance : float [m]
        Of an oscillating follower: its length to the roller's centre or the edge; of its pivot from the cam's centre.
    face_offset : float [m]
        Of an oscillating flat face: by how much its line passes the pivot, on the cam's side.
    mass : float [kg], inertia : float [kg*m^2]
        Of a translating, of an oscillating follower, with all that moves with it.
    spring : Spring or None
    load : float [N or N*m]
        A constant force, or moment, that presses the follower on the cam.
    friction : float
        Coefficient between cam and follower.
    material : Material or None
    """

    kind: Annotated[Literal["translating", "oscillating"], choice(*KINDS)] = "translating"
    contact: Annotated[Literal["knife", "roller", "flat"], choice(*CONTACTS)] = "roller"
    roller_radius: Size | None = None
    offset: Annotated[float, quantity("length")] = 0.0
    arm: Size | None = None
    pivot_distance: Size | None = None
    face_offset: Annotated[float, quantity("length")] = 0.0
    mass: Annotated[float, quantity("mass", not_negative)] | None = None
    inertia: Annotated[float, quantity("inertia", not_negative)] | None = None
    spring: Spring | None = None
    load: float = 0.0
    friction: Annotated[float, quantity("ratio", not_negative)] = 0.0
    material: Material | None = None

    @classmethod
    def key_problems(cls, given: Mapping[str, Any]) -> list[Problem]:
        problems = super().key_problems(given)
        kind, contact = given.get("kind", "translating"), given.get("contact", "roller")
        if contact in CONTACTS:
            problems += _belongs(given, "roller_radius", contact == "roller", _("a roller"), needed=True)
        if kind not in KINDS:
            return problems
        swings = kind == "oscillating"
        straight, turning = _("a translating follower"), _("an oscillating follower")
        for key in ("offset", "mass"):
            problems += _belongs(given, key, not swings, straight)
        problems += _belongs(given, "inertia", swings, turning)
        problems += _belongs(given, "pivot_distance", swings, turning, needed=True)
        # A flat face is long enough wherever the cam touches it: it has no arm.
        flat, arm = swings and contact == "flat", _("an oscillating follower with a roller or a knife edge")
        problems += _belongs(given, "arm", swings and not flat, arm, needed=True)
        return problems + _belongs(given, "face_offset", flat, _("an oscillating flat face"))

    @field_validator("load", mode="plain")
    @classmethod
    def _load(cls, value: object) -> float:
        return si(value, "torque" if DRIVEN.get() == "angle" else "force")


def _belongs(
    given: Mapping[str, Any], key: str, right: bool, whose: str, *, needed: bool = False
) -> list[Problem]:
    """The problem of a key that is given for another follower, or missing for this one."""
    has = given.get(key) is not None
    if right:
        return [missing_key(key)] if needed and not has else []
    if not has or given[key] == 0:
        return []
    return [Problem(_("{key} belongs to {whose}").format(key=shown(key), whose=whose), _("take it out"))]


class Bounds(Part):
    """What is admissible: table [bounds].

    Attributes
    ----------
    pressure_angle : float [rad]
        Greatest one.
    return_pressure_angle : float [rad]
        Greatest one where the follower falls; that of the rise if left out.
    curvature_radius : float [m]
        Least radius of curvature of the profile where it is convex.
    stress : float [Pa]
        Greatest contact stress.
    """

    pressure_angle: Steepness | None = None
    return_pressure_angle: Steepness | None = None
    curvature_radius: Size | None = None
    stress: Stress | None = None


class Tool(Part):
    """The milling cutter or grinding wheel that the cam is made with: `radius` [m]."""

    radius: Size


class FollowerStudy(Part):
    """What is to be computed.

    Attributes
    ----------
    samples : int
        Over a turn, both ends included.
    instants : tuple of float [rad]
        Angles that are shown.
    chord_tolerance : float [m]
        By how much the chords between points for a machine may depart from the profile.
    show_undercut : bool
        Whether a profile that the follower cuts away is shown, instead of being refused.
    """

    samples: Annotated[int, PlainValidator(read_samples)] | None = None
    instants: Annotated[tuple[Angle, ...], listed(limits.INSTANTS)] = ()
    chord_tolerance: Size = 1e-6
    show_undercut: Flag = False
