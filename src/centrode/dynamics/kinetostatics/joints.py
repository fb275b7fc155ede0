"""Sides of hinges: the force of each pin on each link that it joins, the frame included."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.equations import ForceSystem, Inverse, Kinetostatics, Unknown
from centrode.dynamics.wrenches import Vector, Wrench, plus
from centrode.errors import Status
from centrode.model.mechanism import FRAME, Mechanism
from centrode.numerics.expressions import Node
from centrode.numerics.rounding_bounds import SAFETY
from centrode.structure.constraints import (
    AngleDrive,
    Constraint,
    DisplacementDrive,
    DistanceDrive,
    Entity,
    GearRatio,
    NoSlip,
    NoTurning,
    PointInLink,
    PointOnGuide,
    TrackContact,
)
from centrode.structure.gearing import Straight

Number: TypeAlias = Any


@dataclass(frozen=True)
class JointSide:
    """A point and a body that is hinged there."""

    point: str
    body: str

    @property
    def label(self) -> str:
        """Name of the side in results, "point/body"."""
        return f"{self.point}/{self.body}"


def sides_of(mechanism: Mechanism) -> tuple[JointSide, ...]:
    """Sides of all hinges, in the order in which links name the points; of each its links, then the frame.

    A moving point in one link is a hinge if a guide or a cylinder holds it as well; so is a fixed one in none.
    """
    held = {guide.point for guide in mechanism.guides}
    held |= {point for drive in mechanism.drives for point in drive.distance or ()}
    sides = []
    named = [point for link in mechanism.links.values() for point in link.coordinates]
    for point in dict.fromkeys([*named, *mechanism.moving_points, *mechanism.frame.points]):
        links = [name for name, link in mechanism.links.items() if point in link.coordinates]
        fixed = point in mechanism.frame.points
        # a pin is worth a row where at least two bodies meet in it
        if len(links) > 1 or (links and fixed) or (point in held and (links or fixed)):
            sides += [JointSide(point, link) for link in links]
            sides += [JointSide(point, FRAME)] if fixed else []
    return tuple(sides)


def side_forces(forces: ForceSystem, sides: Iterable[JointSide]) -> dict[JointSide, Vector]:
    """Force of the pin on the body at each side [N], in the frame's axes."""
    origin = forces.system.equilibrium.origin
    return {
        side: _sum(
            wrenches_on_point(forces, side.point) if side.body == FRAME else _on_body(forces, side), origin
        )
        for side in sides
    }


def _on_body(forces: ForceSystem, side: JointSide) -> list[Wrench]:
    """Wrenches of a pin on a link: of the hinge, and on the sphere of the load that is pressed against it."""
    tie = PointInLink(side.point, side.body)
    known = [(tie, row) for row in range(tie.size) if (tie, row) in forces.multipliers]
    tied = [pull for unknown in known for pull in forces.pulls(unknown) if pull.body.kind == "link"]
    pressed = [pull for joint in forces.pressing if joint.point == side.point for pull in joint.pulls]
    return [*tied, *(pull for pull in pressed if pull.body == Entity("link", side.body))]


def _sum(pulls: Iterable[Wrench], origin: Vector) -> Vector:
    """Sum of forces; of none, nothing."""
    resultant = origin
    for pull in pulls:
        resultant = tuple(plus(x, y) for x, y in zip(resultant, pull.force, strict=True))
    return resultant


def wrenches_on_point(forces: ForceSystem, point: str) -> list[Wrench]:
    """All forces on a pin: of links, guides, cylinders and loads."""
    return [pull for pull in forces.all_wrenches if pull.body.kind == "point" and pull.body.name == point]


# Numbers over samples put together as arrays, samples first.

Array: TypeAlias = npt.NDArray[np.float64]


def column(value: Number, samples: int) -> Array:
    """Number over the samples (n), from arrays (1, n) or a plain number; of one sample a node."""
    return np.array(np.broadcast_to(value, (1, samples))[0], dtype=_kind_of([value]))


def columns(values: Sequence[Number], samples: int) -> Array:
    """Numbers over the samples (n, numbers)."""
    table = np.empty((len(values), samples), dtype=_kind_of(values))
    for row, value in zip(table, values, strict=True):
        row[:] = value  # of an array (1, n) its only lane
    return np.ascontiguousarray(table.T)


def _kind_of(values: Sequence[Number]) -> npt.DTypeLike:
    return object if any(isinstance(value, Node) for value in values) else np.float64


def tables(values: Sequence[Sequence[Number]], width: int, samples: int) -> Array:
    """Rows of so many numbers over the samples (n, rows, width)."""
    return columns([value for row in values for value in row], samples).reshape(samples, len(values), width)


# Reactions of all joints from the solved equations, as plain arrays by the names of the dataset.


def reactions_of(forces: ForceSystem, sides: Sequence[JointSide]) -> dict[str, Array]:
    """Every reaction, (samples, ...) as the dataset has it."""
    structure = forces.system.scheme.structure
    of_kind = {
        kind: [c for c in structure.constraints if isinstance(c, kind)]
        for kind in (PointOnGuide, GearRatio, TrackContact, NoSlip)
    }
    samples, axes = forces.system.shape[-1], len(forces.system.equilibrium.origin)
    # along the coordinates of the drives, as everything that is reduced to them
    senses = {one.name: one.sense for one in structure.mechanism.motion_parameter.drives}
    drives = [
        senses[c.drive] * _value(forces, c)
        for c in structure.constraints
        if isinstance(c, AngleDrive | DisplacementDrive | DistanceDrive)
    ]
    parts = {
        "joint_force": tables([*side_forces(forces, sides).values()], axes, samples),
        "balancing": columns(drives, samples),
    }
    if axes == 3:
        parts["centre_force"] = tables([*centre_forces(forces).values()], axes, samples)
    if of_kind[PointOnGuide]:
        parts |= _of_guides(forces, of_kind[PointOnGuide])
    if of_kind[GearRatio]:
        parts |= _of_gears(forces, of_kind[GearRatio])
    if of_kind[TrackContact]:
        parts |= _of_wheels(forces, of_kind[TrackContact], of_kind[NoSlip])
    return parts


def centre_forces(forces: ForceSystem) -> dict[str, Vector]:
    """On the sphere: force of its centre on each link, and on each pin of several links that loads act on."""
    pulls = {pull.body.name: pull.force for pull in forces.centre if pull.body.name != FRAME}
    for joint in forces.pressing:
        if joint.bearer == FRAME:
            known = pulls.get(f"pin {joint.point}", forces.system.equilibrium.origin)
            pulls[f"pin {joint.point}"] = tuple(x - y for x, y in zip(known, joint.force, strict=True))
    return pulls


def _value(forces: ForceSystem, constraint: Constraint | None) -> Number:
    """Multiplier of a constraint of one row; zero of one that repeats others, or that there is none of."""
    return 0.0 if constraint is None else forces.multipliers.get((constraint, 0), 0.0)


def _force_of(pulls: Iterable[Wrench]) -> list[Number]:
    """The first of the forces that a constraint exerts: on the point, slider or wheel; carriers come after."""
    # a row's body without force is skipped: links that only get a moment
    return next(list(pull.force) for pull in pulls if not isinstance(pull.force[0], float) or any(pull.force))


def _of_guides(forces: ForceSystem, guides: Sequence[Constraint]) -> dict[str, Array]:
    turning = {c.guide: c for c in forces.system.scheme.structure.constraints if isinstance(c, NoTurning)}
    normal = [_value(forces, c) for c in guides]
    units = [_force_of(forces.system.pulls[c, 0]) for c in guides]
    vectors = [[value * x for x in unit] for value, unit in zip(normal, units, strict=True)]
    moments = [_value(forces, turning.get(c.guide)) for c in guides if isinstance(c, PointOnGuide)]
    samples, axes = forces.system.shape[-1], len(forces.system.equilibrium.origin)
    parts = {"guide_force": tables(vectors, axes, samples), "guide_normal": columns(normal, samples)}
    # the guides of the sphere have no links of their own
    return parts if axes == 3 else parts | {"guide_moment": columns(moments, samples)}


def _of_gears(forces: ForceSystem, gears: Sequence[Constraint]) -> dict[str, Array]:
    moments, teeth = [], []
    for gear in gears:
        assert isinstance(gear, GearRatio)
        value = _value(forces, gear)
        weights = gear.weights(forces.system.numbers)
        moments.append([value * weights[link] for link in gear.links])
        force = forces.system.pulls[gear, 0][0].force
        # of bevel wheels that turn alike the moment alone is known
        told = any(not isinstance(x, float) or x for x in force)
        known = told and gear.gear in forces.system.teeth.axes
        teeth.append([value * x if known else np.nan for x in force])
    samples, axes = forces.system.shape[-1], len(forces.system.equilibrium.origin)
    return {"gear_moment": tables(moments, 3, samples), "tooth_force": tables(teeth, axes, samples)}


def _of_wheels(
    forces: ForceSystem, contacts: Sequence[Constraint], slips: Sequence[Constraint]
) -> dict[str, Array]:
    vectors, normal, along = [], [], []
    for contact, slip in zip(contacts, slips, strict=True):
        assert isinstance(contact, TrackContact)
        track = forces.system.numbers.gearing.track[contact.rolling]
        out = _force_of(forces.system.pulls[contact, 0])
        press, drag = _value(forces, contact), _value(forces, slip)
        grip = [drag * x for x in _force_of(forces.system.pulls[slip, 0])]
        vectors.append([press * x + y for x, y in zip(out, grip, strict=True)])
        # a wheel inside a circle, or a ring around a pin, is pressed towards the circle's centre
        normal.append(press if isinstance(track, Straight) or not track.inside else -press)
        # forwards along a line, counter-clockwise about a circle: square to the outward normal
        way = (out[1], -out[0]) if isinstance(track, Straight) else (-out[1], out[0])
        along.append(grip[0] * way[0] + grip[1] * way[1])
    samples = forces.system.shape[-1]
    return {
        "rolling_force": tables(vectors, 2, samples),
        "rolling_normal": columns(normal, samples),
        "rolling_tangential": columns(along, samples),
    }


# What reactions are worth: where the equations are singular, and which reactions nothing determines.

Mask: TypeAlias = npt.NDArray[np.bool_]
Codes: TypeAlias = npt.NDArray[np.int8]
MOMENTS = ("guide_moment", "gear_moment", "balancing")
"""Reactions that may be moments: measured by the greatest length beside forces."""


def reaction_status(inverse: Inverse, status: Codes) -> Codes:
    """The motion's statuses (n), and `singular` where rounding leaves no digit of the reactions."""
    codes = status.copy()
    lost = inverse.useless[0]
    codes[lost & ((status == Status.OK) | (status == Status.CUT_OFF))] = Status.SINGULAR
    return codes


def undetermined_parts(
    system: Kinetostatics, sides: Sequence[JointSide], status: Codes, residual: float
) -> dict[str, Mask]:
    """Which entries of each reaction nothing determines, over all samples that are ok.

    Each equation that repeats others leaves a state of stress free: forces that balance among themselves. What any
    of them changes is not determined. `residual` is how well the equations repeat each other.
    """
    good = status == Status.OK
    masks: dict[str, Mask] = {}
    if not good.any():
        return masks
    condition = system.inverse.condition[0][good]
    # rounding of the matrix, and what the equations fail to repeat each other by, magnified by the condition
    # number
    noise = SAFETY * (system.inverse.loss[0][good] + condition * residual)
    for unknown in system.scheme.repeating:
        parts = _moments_as_forces(reactions_of(_self_stress(system, unknown), sides), system.scale)
        # moments as forces, so that the greatest of all reactions is a measure for each
        greatest = np.max([_greatest(values[good]) for values in parts.values()], axis=0)
        for name, values in parts.items():
            bound = (noise * greatest).reshape(-1, *[1] * (values.ndim - 1))
            felt = (np.abs(values[good]) > bound).any(axis=0)
            masks[name] = masks.get(name, np.zeros_like(felt)) | felt
    return masks


def _self_stress(system: Kinetostatics, unknown: Unknown) -> ForceSystem:
    """All constraint forces that a unit of one repeating equation brings about."""
    # a unit of the repeating equation, and what the others have to do to balance it
    multipliers = system.forces(system.pulls[unknown]).multipliers
    return ForceSystem(system, {**multipliers, unknown: multipliers[unknown] + 1.0}, ())


def _moments_as_forces(parts: Mapping[str, Array], scale: float) -> dict[str, Array]:
    return {
        name: values / scale if name in MOMENTS else np.nan_to_num(values) for name, values in parts.items()
    }


def _greatest(values: Array) -> Array:
    greatest: Array = np.abs(values).reshape(len(values), -1).max(axis=1)
    return greatest
