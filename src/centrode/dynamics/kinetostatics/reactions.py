"""Reactions in every joint, and what the drives must give, as a labelled result."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.kinetostatics.applied_forces import (
    DriveGroup,
    InertiaForce,
    InputMotion,
    MotionOfDrive,
    Outer,
    check_motion,
    given_motion,
    input_motion_of,
    outer_of,
    rates_of,
    steady_grid,
)
from centrode.dynamics.kinetostatics.equations import ForceSystem, Kinetostatics, Scheme, Teeth
from centrode.dynamics.kinetostatics.friction import (
    JAMMED,
    LOCKING,
    Contact,
    HingeBearing,
    Outcome,
    Powers,
    Rubbed,
    contacts_of,
    friction_of_contacts,
    friction_parts,
    refuse_undetermined,
    reversals,
    with_friction,
    without_friction,
    works_over,
)
from centrode.dynamics.kinetostatics.joints import (
    JointSide,
    Mask,
    centre_forces,
    column,
    columns,
    reaction_status,
    reactions_of,
    sides_of,
    tables,
    undetermined_parts,
)
from centrode.dynamics.kinetostatics.radial_forces import with_radial_forces
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.state import State
from centrode.dynamics.steady_motion.steady import solution_of
from centrode.dynamics.wrenches import Resultant, Vector, Wrench, components, plus
from centrode.errors import CentrodeError, InputError, NotComputedYet, Status
from centrode.kinematics.motion import (
    Variable,
    attributes_of,
    coordinates_along,
    coordinates_of,
    judgements_of,
    labels_of,
    vocabulary_variable,
)
from centrode.kinematics.preparation import ready
from centrode.kinematics.repeated_motion import repeated_motion
from centrode.kinematics.sample_index import label_coordinates
from centrode.kinematics.solve import Solved, grid_of, solve
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism, kept_by_mechanism
from centrode.numerics.expressions import EXPRESSIONS, Node
from centrode.structure.constraints import Entity

# Reactions at the samples of a motion, as plain arrays with what they come from.

Array: TypeAlias = npt.NDArray[np.float64]

# what machine code needs is not loaded for reactions that are requested once
_kernels = functools.partial(importlib.import_module, "centrode.dynamics.kinetostatics.reaction_kernels")

GREATEST_MATRICES = 30_000_000
"""Numbers in all matrices of one result: with their inverses some 1 GB."""


@dataclass(frozen=True)
class WithFriction:
    """Friction with what it takes."""

    rubbed: Rubbed
    powers: Powers


@dataclass(frozen=True)
class ReactionSolution:
    """Reactions of a motion.

    Attributes
    ----------
    pace : how the drive moved
    outer : loads and inertia
    forces : the solved equations
    parts : name -> reactions (samples, ...); of an undetermined one, one of the many that are possible
    undetermined : name -> mask (...) of reactions that nothing determines
    status : (samples)
    friction : friction by coefficients, where there is any
    """

    pace: InputMotion
    outer: Outer
    forces: ForceSystem
    sides: tuple[JointSide, ...]
    parts: dict[str, Array]
    undetermined: dict[str, Mask]
    status: npt.NDArray[np.int8]
    friction: WithFriction | None = None


@dataclass(frozen=True)
class ReactionNumbers:
    """Reactions of a motion as numbers alone, whatever computed them.

    Attributes
    ----------
    held : links and pins that the centre of a sphere holds
    parts : name -> reactions, inertia forces, forces and moments on the frame (samples, ...)
    balances : what is missing to the equilibrium of the bodies, and of the frame (n), and the size that measures it (n)
    moment : (n), of loads and inertia along the path's parameter by virtual work
    undetermined : name -> mask (...) of reactions that nothing determines
    status : (n)
    loss : (n), bound on the relative rounding error
    """

    pace: InputMotion
    sides: tuple[JointSide, ...]
    held: tuple[str, ...]
    parts: dict[str, Array]
    balances: Mapping[str, tuple[Array, Array]]
    moment: Array
    undetermined: Mapping[str, Mask]
    status: npt.NDArray[np.int8]
    loss: Array
    friction: WithFriction | None = None

    @classmethod
    def of(cls, found: ReactionSolution) -> ReactionNumbers:
        """The numbers of solved equations."""
        parts = found.parts | totals_of(found.forces, found.outer.inertia)
        held: tuple[str, ...] = ()
        if "centre_force" in parts:
            parts["joint_moment"] = joint_moments(found, parts["joint_force"])
            held = tuple(centre_forces(found.forces))
        return cls(
            found.pace, found.sides, held, parts, balances_of(found.forces, found.outer.pulls), found.outer.moment[0],
            found.undetermined, found.status, found.forces.system.inverse.loss[0], found.friction,
        )  # fmt: skip


def find(
    solved: Solved, burden: MassesAndLoads, pace: InputMotion, contacts: Sequence[Contact] = ()
) -> ReactionSolution:
    """Solve for all reactions at the samples of a motion of one mechanism.

    Raises InputError for a load without a finite amount, more samples than memory holds, or friction in a contact whose
    reaction nothing determines.
    """
    prepared = solved.ready
    scheme, teeth, sides = _unchanging(prepared.mechanism)
    _check_size(scheme, len(pace.acceleration))
    state = State.of(solved, pace.moving)
    system = Kinetostatics.of(scheme, prepared.kinematics.numbers, state, teeth)
    outer = outer_of(state, burden, pace.acceleration, state.exists)
    forces = system.forces(outer.pulls)
    # without friction first: what acts decides neither on statuses nor on what is undetermined
    status = reaction_status(system.inverse, solved.status[0])
    residual = float(np.nanmax(solved.residual, initial=0.0))
    undetermined = undetermined_parts(system, sides, status, residual)
    parts = with_radial_forces(reactions_of(forces, sides), forces, sides)
    solution = ReactionSolution(pace, outer, forces, sides, parts, undetermined, status)
    return _with_friction(solution, solved, burden, state, contacts) if contacts else solution


def _with_friction(
    found: ReactionSolution, solved: Solved, burden: MassesAndLoads, state: State, contacts: Sequence[Contact]
) -> ReactionSolution:
    """A solution with friction, which is as great as the reactions that it changes make it."""
    refuse_undetermined(contacts, found.undetermined, found.sides, solved.ready.mechanism)
    useful = (found.status == Status.OK) | (found.status == Status.CUT_OFF)
    sizes = friction_of_contacts(state, found.forces, contacts, found.pace.acceleration, useful)
    without = found.outer
    # friction acts on the bodies as any load does, so the same equations take it
    outer = Outer(
        (*without.loads, *sizes.pulls), without.inertia, without.moment + sizes.moment, without.shares
    )
    forces = found.forces.system.forces(outer.pulls)
    parts = with_radial_forces(reactions_of(forces, found.sides), forces, found.sides)
    with_friction(parts, sizes, state)
    status = found.status.copy()
    status[sizes.solution.outcome == Outcome.LOCKED] = Status.SELF_LOCKING
    status[sizes.solution.outcome == Outcome.LOST] = Status.UNCONVERGED
    by_time = solved.ready.kinematics.path.by_time
    # with several drives the parameter is time, and moments along it are powers
    drives = parts["balancing"] * rates_of(solved, found.pace) if by_time else parts["balancing"]
    powers = Powers.of(drives, burden.loads, without.shares, without.moment, sizes, found.pace.moving.rate)
    parts |= friction_parts(sizes, powers, state.mechanism)
    return replace(
        found, outer=outer, forces=forces, parts=parts, status=status, friction=WithFriction(sizes, powers)
    )


@kept_by_mechanism(most=16)
def _unchanging(mechanism: Mechanism) -> tuple[Scheme, Teeth, tuple[JointSide, ...]]:
    """What the equations are solved for, where teeth mesh, and the sides of hinges: the same at all positions."""
    return Scheme.of(ready(mechanism).structure), Teeth.of(mechanism), sides_of(mechanism)


@kept_by_mechanism(most=16)
def _forces_that_act(mechanism: Mechanism) -> tuple[MassesAndLoads, tuple[Contact, ...]]:
    """Masses and loads as forces, and where friction is: the same at all positions."""
    return MassesAndLoads.for_reactions(mechanism), contacts_of(mechanism)


def _check_size(scheme: Scheme, samples: int) -> None:
    most = GREATEST_MATRICES // (scheme.size * len(scheme.unknowns))
    if samples > most:
        what = _("reactions are requested at {asked} positions").format(asked=samples)
        raise InputError(_("samples"), what, _("give at most {most} at once").format(most=most))


# What a mechanism does to its frame: all of it, and the part of inertia that shakes it.


def totals_of(forces: ForceSystem, inertia: Sequence[InertiaForce]) -> dict[str, Array]:
    """Inertia forces of the links, forces and moments on the frame, (samples, ...)."""
    samples, origin = forces.system.shape[-1], forces.system.equilibrium.origin
    moments = [components(action.moment) for action in inertia]
    return {
        "inertia_force": tables([action.force for action in inertia], len(origin), samples),
        "inertia_moment": _moments(moments, len(origin), samples),
        **frame_totals(forces, inertia),
    }


def frame_totals(forces: ForceSystem, inertia: Sequence[InertiaForce]) -> dict[str, Array]:
    """Forces and moments on the frame: all, and those of inertia alone."""
    samples, origin = forces.system.shape[-1], forces.system.equilibrium.origin
    shaking = Resultant.of([pull for action in inertia for pull in action.pulls], origin)
    return {**_sums("frame", forces.frame_resultant, samples), **_sums("shaking", shaking, samples)}


def _moments(moments: Sequence[Vector], axes: int, samples: int) -> Array:
    """Moments of links: one number each in the plane, three on the sphere."""
    table = tables(moments, axes if axes == 3 else 1, samples)
    return table if axes == 3 else table[:, :, 0]


def _sums(name: str, all_together: Resultant, samples: int) -> dict[str, Array]:
    moment = all_together.moment
    turned = columns(moment, samples) if isinstance(moment, tuple) else column(moment, samples)
    return {f"{name}_force": columns(all_together.force, samples), f"{name}_moment": turned}


def joint_moments(found: ReactionSolution, forces: Array) -> Array:
    """On the sphere: moments about its centre [N m] of the forces in hinges, (samples, sides, 3)."""
    system = found.forces.system
    samples, radius = system.shape[-1], system.scheme.structure.mechanism.sphere_radius
    places = [system.at.points[side.point] for side in found.sides]
    return np.cross(radius * tables(places, 3, samples), forces)


# Three checks of solved reactions by other ways: equilibrium of every body, momentum, power.

Number: TypeAlias = Any


BALANCES = ("equilibrium_residual", "frame_residual")


def checks_of(found: ReactionNumbers, rates: Array) -> dict[str, float]:
    """Worst residuals over all samples that are ok, each over the greatest force or moment of its sample, or power.

    `rates` (samples, drives) are the speeds of the drives.
    """
    good = found.status == Status.OK
    checks = {name: _worst(good, *balance) for name, balance in found.balances.items()}
    return checks | {"power_residual": _worst(good, *_power(found, rates))}


def balances_of(forces: ForceSystem, outer: Sequence[Wrench]) -> dict[str, tuple[Array, Array]]:
    """Name of a check -> what is missing to equilibrium at each sample, and the size that it is measured by."""
    return dict(zip(BALANCES, (body_balance(forces), frame_balance(forces, outer)), strict=True))


def _worst(good: Mask, missing: Array, size: Array) -> float:
    with np.errstate(all="ignore"):
        # nothing missing where nothing acts counts as zero, not as 0/0
        share = np.where(missing == 0.0, 0.0, missing / size)
    return float(np.max(share[good], initial=0.0))


def body_balance(forces: ForceSystem) -> tuple[Array, Array]:
    """Residual of the equilibrium of pins and links (n), and the greatest force (n), by which it is measured.

    The centre of a sphere bears what the forces on a link leave, so that there its moments alone tell.
    """
    system = forces.system
    samples = system.shape[-1]
    sums: dict[Entity, Sequence[Number]] = {entity: (0.0,) * 3 for entity in system.scheme.structure.unknowns}
    acting: list[Number] = []
    turning: list[Number] = []
    for pull in forces.acting:
        if pull.body in sums:
            parts = system.on_link(pull.body.name, pull) if pull.body.kind == "link" else pull.force
            # `strict=False`: a pin has two components in the plane, a link three
            sums[pull.body] = tuple(plus(x, y) for x, y in zip(sums[pull.body], parts, strict=False))
        acting += pull.force
        turning += components(pull.moment)
    missing = _greatest_size([x for left in sums.values() for x in left], samples)
    size = _greatest_size(acting, samples)
    return missing, _greater(size, _greatest_size(turning, samples) / system.scale)


def _greatest_size(parts: Sequence[Number], samples: int) -> Array:
    """The greatest size (n) of some numbers over the samples, of nodes a node; plain zeros are none."""
    told = [x for x in parts if not (isinstance(x, float) and x == 0.0)]
    if any(isinstance(x, Node) for x in told):
        return np.array([functools.reduce(EXPRESSIONS.max, map(EXPRESSIONS.abs, told))], dtype=object)
    table = np.empty((len(told), samples))
    for row, x in zip(table, told, strict=True):
        np.abs(x, out=row[None])
    return np.asarray(table.max(axis=0, initial=0.0))


def _greater(sizes: Array, others: Array) -> Array:
    """The greater of two sizes (n), of nodes a node."""
    if object in (sizes.dtype, others.dtype):
        return np.array([EXPRESSIONS.max(sizes[0], others[0])], dtype=object)
    return np.asarray(np.maximum(sizes, others))


def frame_balance(forces: ForceSystem, outer: Sequence[Wrench]) -> tuple[Array, Array]:
    """Residual of the frame (n): what it bears less loads and inertia forces; and the greatest force (n)."""
    scale = forces.system.scale
    samples = forces.system.shape[-1]
    borne, acting = forces.frame_resultant, Resultant.of(outer, forces.system.equilibrium.origin)
    short = [x - y for x, y in zip(borne.force, acting.force, strict=True)]
    pairs = zip(components(borne.moment), components(acting.moment), strict=True)
    missing = _greatest_size(short, samples)
    missing = _greater(missing, _greatest_size([x - y for x, y in pairs], samples) / scale)
    size = _greatest_size([x for pull in (*borne.pulls, *acting.pulls) for x in pull.force], samples)
    moments = [x for moment in (*borne.moments, *acting.moments) for x in components(moment)]
    return missing, _greater(size, _greatest_size(moments, samples) / scale)


def _power(found: ReactionNumbers, rates: Array) -> tuple[Array, Array]:
    """Power of the drives, and of loads and inertia by virtual work; the greatest of the whole motion."""
    given = found.parts["balancing"] * rates
    taken = found.moment * found.pace.moving.rate
    good = found.status == Status.OK
    # over the greatest power of the motion: at single samples all powers may vanish together
    greatest = np.max((np.abs(given).sum(axis=-1) + np.abs(taken))[good], initial=0.0)
    return np.abs(given.sum(axis=-1) + taken), np.full(len(good), greatest)


# Group I of a machine in its real motion: what the links need, and what the flywheel takes, is what drives.


def drive_group_variables(group: DriveGroup, needed: Array) -> dict[str, Variable]:
    """Variables of the balance of the drive; `needed` (n) is what the links need. All along its coordinate."""
    values = {
        "drive_acceleration": group.acceleration,
        "moment_of_links": needed,
        "inertia_moment_of_group": group.inertia_moment,
        "driving_moment": group.driving,
    }
    return {name: vocabulary_variable(name, ("sample",), value) for name, value in values.items()}


def driving_attributes(group: DriveGroup, needed: Array) -> dict[str, float]:
    """J_I, how far M_links + J_I epsilon is from the driving moment, and how far it may be.

    What the links need (n) comes from the reactions, acceleration and driving moment from the energy equation. Both
    numbers are shares of the greatest sum of the terms of that equation.
    """
    missing, greatest = np.abs(needed - group.inertia_moment - group.driving), float(np.max(group.size))
    scale = greatest or 1.0
    return {
        "inertia": group.inertia,
        "driving_residual": float(np.max(missing, where=np.isfinite(missing), initial=0.0)) / scale,
        "driving_error": float(np.max(group.error)) / scale,
    }


# Names and units around friction, beside those of reactions.


def friction_variables(solved: Solved, rubbed: Rubbed, powers: Powers, whole: bool) -> dict[str, Variable]:
    """Variables of friction besides forces at samples: works over a `whole` range, senses, self-locking, jumps."""
    parameter = solved.span.parameter
    locking = powers.locking
    locking[rubbed.solution.outcome == Outcome.LOCKED] = JAMMED
    dimensions, values, attributes = vocabulary_variable("self_locking", ("sample",), locking)
    flags = {
        "flag_values": np.array(list(LOCKING), dtype=np.int8),
        "flag_meanings": " ".join(LOCKING.values()),
    }
    # amounts act along the slopes, against the motion: minus makes work taken positive
    works = works_over(parameter, powers.rate, -rubbed.amounts * rubbed.slopes)
    works = np.where(whole and _friction_converged(rubbed), works, np.nan)
    variables = {
        "friction_work": vocabulary_variable("friction_work", ("friction",), works),
        "friction_turns": vocabulary_variable(
            "friction_turns", ("sample", "friction"), rubbed.turns.astype(np.int8)
        ),
        "self_locking": (dimensions, values, attributes | flags),
    }
    if not solved.ready.kinematics.path.by_time:
        first, last = float(np.min(parameter)), float(np.max(parameter))
        places = reversals(solved.ready, rubbed.contacts, first, last)
        variables["jumps"] = vocabulary_variable("jumps", ("jump",), places, solved.ready.parameter.units[0])
    return variables


def friction_coordinates(contacts: tuple[Contact, ...]) -> dict[str, Any]:
    """Labels of the contacts."""
    bearings = tuple(contact.label for contact in contacts if isinstance(contact, HingeBearing))
    coordinates = {"friction": labels_of(tuple(contact.label for contact in contacts))}
    return coordinates | ({"bearing": labels_of(bearings)} if bearings else {})


def friction_attributes(solved: Solved, rubbed: Rubbed, powers: Powers, whole: bool) -> dict[str, Any]:
    """Attributes of friction: residual and iterations of the sizes, contacts that stand still, mean efficiency."""
    return {
        "friction_residual": float(np.max(rubbed.solution.residual, initial=0.0)),
        "friction_iterations": rubbed.solution.tries,
        "standing": "; ".join(rubbed.standing),
        "efficiency": powers.mean_efficiency(solved.span.parameter)
        if whole and _friction_converged(rubbed)
        else float("nan"),
    }


def _friction_converged(rubbed: Rubbed) -> bool:
    return bool((rubbed.solution.outcome == Outcome.FOUND).all())


# Names, units and statuses around the arrays of kinetostatics.

SPATIAL = ("inertia_moment", "frame_moment", "shaking_moment")
"""Moments that have components on the sphere."""
GEAR_BODIES = ("first", "second", "carrier")
DIMENSIONS = {
    "joint_force": ("side", "axis"),
    "joint_moment": ("side", "axis"),
    "centre_force": ("held", "axis"),
    "guide_force": ("guide", "axis"),
    "guide_normal": ("guide",),
    "guide_moment": ("guide",),
    "gear_moment": ("gear", "gear_body"),
    "tooth_force": ("gear", "axis"),
    "tooth_radial_force": ("gear", "axis"),
    "rolling_force": ("rolling", "axis"),
    "rolling_normal": ("rolling",),
    "rolling_tangential": ("rolling",),
    "friction_moment": ("bearing",),
    "friction_force": ("guide",),
    "friction_power": ("friction",),
    "efficiency": (),
    "balancing": ("drive",),
    "inertia_force": ("link", "axis"),
    "inertia_moment": ("link",),
    "frame_force": ("axis",),
    "frame_moment": (),
    "shaking_force": ("axis",),
    "shaking_moment": (),
}


def reactions_dataset(
    solved: Solved, burden: MassesAndLoads, found: ReactionNumbers, whole: bool
) -> xr.Dataset:
    """The dataset of `reactions`; `whole` where the samples are a range, and works over it have a sense."""
    parts = dict(found.parts)
    checks = checks_of(found, rates_of(solved, found.pace))
    # absence is NaN: nothing where the equations are singular, or where the motion itself has no derivatives
    absent = (found.status != Status.OK) & (found.status != Status.CUT_OFF)
    undetermined = _mask_undetermined(parts, solved.ready.mechanism, found)
    # after the checks, which look at numbers
    for values in parts.values():
        values[absent] = np.nan
    units = solved.ready.parameter.units
    variables = {
        name: vocabulary_variable(name, ("sample", *_dimensions(name, values)), values, units[0])
        for name, values in parts.items()
    }
    if len(set(units)) > 1:
        variables["balancing"][2]["units"] = ", ".join(
            drive.force_unit for drive in solved.ready.parameter.drives
        )
    if not solved.ready.kinematics.path.by_time:
        variables["drive_rate"] = vocabulary_variable(
            "drive_rate", ("sample",), found.pace.moving.rate.copy(), units[0]
        )
    variables |= _statuses(solved, found)
    sides = np.array([side.label not in undetermined for side in found.sides], dtype=np.int8)
    variables["determined"] = vocabulary_variable("determined", ("side",), sides)
    attributes = attributes_of(solved, "reactions") | checks
    attributes |= {"rate_from": found.pace.source, "undetermined": "; ".join(undetermined)}
    attributes["samples"] = "range" if whole else "single places"
    coordinates = _coordinates(solved, burden, found)
    if found.friction is not None:
        rubbed, powers = found.friction.rubbed, found.friction.powers
        variables |= friction_variables(solved, rubbed, powers, whole)
        coordinates |= friction_coordinates(rubbed.contacts)
        attributes |= friction_attributes(solved, rubbed, powers, whole)
    if found.pace.group is not None:
        # of the numbers as they are shown: absent where the reactions are
        group, needed = found.pace.group, parts["balancing"][:, 0]
        variables |= drive_group_variables(group, needed)
        attributes |= driving_attributes(group, needed)
    return xr.Dataset(variables, coords=label_coordinates(coordinates), attrs=attributes)


def _dimensions(name: str, values: Array) -> tuple[str, ...]:
    known = DIMENSIONS[name]
    return (*known, "axis") if name in SPATIAL and values.ndim > 1 + len(known) else known


def _statuses(solved: Solved, found: ReactionNumbers) -> dict[str, Variable]:
    motion = judgements_of(solved, ())["status"]
    flags = {
        "flag_values": np.array(list(Status), dtype=np.int8),
        "flag_meanings": " ".join(status.name.lower() for status in Status),
    }
    dimensions, values, attributes = vocabulary_variable("reaction_status", ("sample",), found.status)
    # above 1 no digit is left, and how many more than none says nothing
    loss = np.minimum(found.loss, 1.0)
    return {
        "status": motion,
        "reaction_status": (dimensions, values, attributes | flags),
        "reaction_loss": vocabulary_variable("reaction_loss", ("sample",), loss),
    }


def _coordinates(solved: Solved, burden: MassesAndLoads, found: ReactionNumbers) -> dict[str, Any]:
    known, mechanism = coordinates_of(solved), solved.ready.mechanism
    wanted = (*coordinates_along(solved), "axis", "guide", "rolling")
    coordinates = {
        name: known[name] for name in wanted if name in known and (name != "guide" or mechanism.guides)
    }
    coordinates["link"] = labels_of(burden.links)
    coordinates["side"] = labels_of(tuple(side.label for side in found.sides))
    coordinates["side_point"] = (("side",), np.array([side.point for side in found.sides], dtype=str))
    coordinates["side_link"] = (("side",), np.array([side.body for side in found.sides], dtype=str))
    if "centre_force" in found.parts:
        coordinates["held"] = labels_of(found.held)
    if mechanism.gears:
        coordinates["gear"] = labels_of(tuple(gear.id for gear in mechanism.gears))
        coordinates["gear_body"] = labels_of(GEAR_BODIES)
    return coordinates


def _mask_undetermined(parts: dict[str, Array], mechanism: Mechanism, found: ReactionNumbers) -> list[str]:
    """Put NaN where nothing determines a reaction; the names of these."""
    if not found.undetermined:
        return []
    names = _names(mechanism, found)
    said: list[str] = []
    for part, felt in found.undetermined.items():
        if part == "balancing":
            continue  # work tells it, whatever the state of stress
        for k, mask in enumerate(felt):
            if np.any(mask):
                parts[part][:, k] = np.nan
                if part == "joint_force" and "joint_moment" in parts:
                    parts["joint_moment"][:, k] = np.nan
                said.append(names[part][k])
    return list(dict.fromkeys(said))


def _names(mechanism: Mechanism, found: ReactionNumbers) -> dict[str, list[str]]:
    guides = [guide.id for guide in mechanism.guides]
    gears = [f"gear {gear.id}" for gear in mechanism.gears]
    wheels = [f"rolling {wheel.id}" for wheel in mechanism.rolling]
    return {
        "joint_force": [side.label for side in found.sides],
        "centre_force": [f"centre on {name}" for name in found.held],
        "guide_force": [f"guide {guide}" for guide in guides],
        "guide_normal": [f"guide {guide}" for guide in guides],
        "guide_moment": [f"moment of guide {guide}" for guide in guides],
        "gear_moment": gears,
        "tooth_force": gears,
        "tooth_radial_force": gears,
        "rolling_force": wheels,
        "rolling_normal": wheels,
        "rolling_tangential": wheels,
    }


def reactions(
    mechanism: MechanismSource,
    samples: int | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
    at: npt.ArrayLike | None = None,
    *,
    motion: MotionOfDrive = "mean",
    speed: float | str | None = None,
    acceleration: float | str | None = None,
    friction: bool = True,
) -> xr.Dataset:
    """Forces in every joint and what the drives must give, from J' lambda = -Q with one list of constraints.

    Parameters
    ----------
    samples, start, stop, at
        As for `motion`; with `motion="real"` as for `steady_motion`, without start and stop.
    motion : "mean" or "real"
        At the speed of `reduce`, or at the real speed and acceleration of a machine in steady motion: then also the
        inertia moment of what turns with the drive, and the driving moment.
    speed : [rad/s or m/s] or a text with a unit ("65 rpm")
        Of the drive in its own sense at the places `at`, in place of that motion; 0 for static equilibrium.
    acceleration : [rad/s^2 or m/s^2] or a text with a unit ("-2.77 rad/s^2")
        Of the drive in its own sense, with a given speed.
    friction
        Whether Coulomb friction counts; where there is any, `friction_moment`, `friction_force`,
        `friction_power`, `efficiency` and more tell it (docs: friction).

    Returns
    -------
    Dataset
        `joint_force` (sample, side, axis), `guide_force`, `guide_moment`, `gear_moment`, `rolling_force`, `balancing`
        (sample, drive), `inertia_force`, `frame_force`, `shaking_force` and more (docs: reactions), with a status of
        their own.

    Raises
    ------
    InputError
        As `motion` does; masses or loads that are not complete, or none; a formula without a value.
    NotComputedYet
        Coulomb friction on the sphere, and at the real speed.

    Examples
    --------
    >>> import centrode as ct
    >>> forces = ct.reactions(ct.example("six-bar-press"), 37)
    >>> print(ct.summary(forces).splitlines()[4])
    samples               37: ok 37
    """
    mechanism = mechanism_of(mechanism)
    mechanism = mechanism if friction else without_friction(mechanism)
    burden, contacts = _forces_that_act(mechanism)
    check_motion(motion)
    _check_given(motion, speed, acceleration, at)
    if motion == "real":
        if start is not None or stop is not None:
            what = _("steady motion is given over a whole cycle")
            raise InputError(_("range"), what, _("omit the ends of the range, or give the positions with at"))
        _refuse_unknown_speed(contacts)
        prepared, span, pace = steady_grid(mechanism, samples, at)
        return reactions_at(solve(prepared, span), burden, pace, whole=at is None)
    prepared = ready(mechanism)
    span = grid_of(prepared, samples, start, stop, at)
    course = repeated_motion(prepared, span)
    solved = course.solve(prepared, span)
    pace = input_motion_of(solved, burden) if speed is None else given_motion(solved, speed, acceleration)
    if course.is_compiled and not contacts:
        found = _kernels().reactions_by_kernels(solved, burden, pace)
        if found is not None:
            return reactions_dataset(solved, burden, found, at is None)
    return reactions_at(solved, burden, pace, contacts, at is None)


def _check_given(
    motion: MotionOfDrive,
    speed: float | str | None,
    acceleration: float | str | None,
    at: npt.ArrayLike | None,
) -> None:
    """Raise InputError for a given motion of the drive that lacks a part, or that two arguments contradict."""
    if speed is None and acceleration is not None:
        what = _("an acceleration is given without a speed")
        raise InputError("acceleration", what, _("give the speed of the drive as well, 0 at rest"))
    if speed is not None and motion == "real":
        what = _("a speed is given, and the real one of the machine is requested")
        raise InputError("speed", what, _("choose one of them"))
    if speed is not None and at is None:
        what = _("a speed is given for a whole range")
        raise InputError("speed", what, _("give the positions with at"))


def motion_of_reactions(found: xr.Dataset) -> MotionOfDrive:
    """The motion that reactions were computed at."""
    return "real" if found.attrs.get("rate_from") == "steady" else "mean"


def has_real_motion(mechanism: Mechanism) -> bool:
    """Whether reactions can be computed at the real speed of the machine that the mechanism works in."""
    if mechanism.machine is None or contacts_of(mechanism):
        return False
    try:
        solution_of(mechanism)
    except CentrodeError:
        return False
    return True


def motion_of_forces(mechanism: Mechanism) -> MotionOfDrive:
    """The motion at which documents have forces: as the description wishes, else the real one of a machine.

    It is the mean one where no real motion can be computed.
    """
    return mechanism.report.motion or ("real" if has_real_motion(mechanism) else "mean")


def _refuse_unknown_speed(contacts: tuple[Contact, ...]) -> None:
    if contacts:
        what = _("the real speed of a machine with Coulomb friction is not computed yet")
        raise NotComputedYet(contacts[0].where, what, _("use the mean speed, or omit friction"))


def reactions_at(
    solved: Solved,
    burden: MassesAndLoads,
    pace: InputMotion,
    contacts: tuple[Contact, ...] = (),
    whole: bool = True,
) -> xr.Dataset:
    """Reactions at the samples of a solved motion of one mechanism, with friction in the contacts; see `reactions`.

    `whole` where its samples are a range, over which works have a sense.
    """
    found = ReactionNumbers.of(find(solved, burden, pace, contacts))
    return reactions_dataset(solved, burden, found, whole)
