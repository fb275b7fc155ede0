"""Reactions in the joints of a free motion, by the equations of kinetostatics at its instants.

The motion is known there, with its accelerations, so every link is in equilibrium with loads and inertia forces. The
equations of kinetostatics ask for as many drives as degrees of freedom: coordinates without one get a drive that must
give nothing, and what all free drives would have to give tells how well both ways agree.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt
import scipy.linalg

from centrode.dynamics.forward_dynamics.free_motion import FreeMotion
from centrode.dynamics.forward_dynamics.initial_position import residuals_and_rows, units_of
from centrode.dynamics.forward_dynamics.trajectory import Trajectory
from centrode.dynamics.kinetostatics.applied_forces import inertia_forces_of
from centrode.dynamics.kinetostatics.equations import Kinetostatics, Scheme, Teeth
from centrode.dynamics.kinetostatics.joints import (
    JointSide,
    centre_forces,
    reaction_status,
    reactions_of,
    sides_of,
    undetermined_parts,
)
from centrode.dynamics.kinetostatics.reactions import DIMENSIONS, GEAR_BODIES, SPATIAL
from centrode.dynamics.wrenches import Wrench
from centrode.errors import NotComputedYet, Status
from centrode.kinematics.motion import labels_of, vocabulary_variable
from centrode.locale import _
from centrode.model.mechanism import Drive, Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.structure.constraints import constraints_of, is_drive
from centrode.structure.plan import structure_of

if TYPE_CHECKING:
    from centrode.dynamics.forward_dynamics.joint_state import JointState
    from centrode.kinematics.motion import Variable

Array: TypeAlias = npt.NDArray[np.float64]

RANK = 1e-9
"""A singular value below this share of the greatest is one of rounding."""


@dataclass(frozen=True)
class ReactionsInMotion:
    """Reactions at the instants of a motion.

    Attributes
    ----------
    sides : of hinges
    parts : name -> values (instants, ...), NaN where nothing determines them
    determined : whether each side is
    status : (instants), singular at change points
    held : on the sphere what its centre bears
    imbalance : greatest force or moment that free drives would have to give, over the greatest reaction
    """

    sides: tuple[JointSide, ...]
    parts: Mapping[str, Array]
    determined: npt.NDArray[np.int8]
    status: npt.NDArray[np.int8]
    imbalance: float
    held: tuple[str, ...] = ()


def reactions_in_motion(free: FreeMotion, course: Trajectory) -> ReactionsInMotion:
    """Reactions at the instants of a trajectory.

    Raises NotComputedYet where a free coordinate is none that a drive could move.
    """
    mechanism = _with_all_drives(free)
    scheme, sides = Scheme.of(structure_of(mechanism)), sides_of(mechanism)
    state = _state(free, course, mechanism)
    system = Kinetostatics.of(scheme, free.equations.numbers, state, Teeth.of(mechanism))
    with np.errstate(all="ignore"):
        forces = system.forces(_acting(free, course, state))
        status = reaction_status(system.inverse, np.full(len(course.time), Status.OK.value, dtype=np.int8))
        residual = float(np.max(course.position_residual, initial=0.0)) / system.scale
        undetermined = undetermined_parts(system, sides, status, residual)
        parts = reactions_of(forces, sides)
    good = status == Status.OK.value
    kept = {one.name for one in free.equations.kept}
    idle = [k for k, drive in enumerate(mechanism.drives) if drive.id not in kept]
    greatest = max((float(np.max(np.abs(x[good]), initial=0.0)) for x in parts.values()), default=0.0)
    given = np.abs(parts.pop("balancing")[good][:, idle])
    for values in parts.values():
        values[~good] = np.nan
    for name, felt in undetermined.items():
        if name in parts:
            parts[name][:, felt] = np.nan
    hinges = (
        np.all(np.isfinite(parts["joint_force"][good]), axis=(0, 2)) if good.any() else np.zeros(len(sides))
    )
    return ReactionsInMotion(
        sides,
        parts,
        hinges.astype(np.int8),
        status,
        float(np.max(given, initial=0.0)) / (greatest or 1.0),
        tuple(centre_forces(forces)) if "centre_force" in parts else (),
    )


def reaction_variables(
    free: FreeMotion, found: ReactionsInMotion
) -> tuple[dict[str, Variable], dict[str, Any]]:
    """Variables and coordinates of a dataset, as those of `ct.reactions`."""
    mechanism, on_sphere = free.mechanism, free.mechanism.space == "sphere"
    variables = {}
    for name, values in found.parts.items():
        dimensions: tuple[str, ...] = DIMENSIONS[name]
        if name in SPATIAL and values.ndim > 1 + len(dimensions):
            dimensions = (*dimensions, "axis")
        variables[name] = vocabulary_variable(name, ("sample", *dimensions), values)
    dimensions_, values_, attributes = vocabulary_variable("reaction_status", ("sample",), found.status)
    attributes["flag_values"] = np.array(list(Status), dtype=np.int8)
    attributes["flag_meanings"] = " ".join(status.name.lower() for status in Status)
    variables["reaction_status"] = (dimensions_, values_, attributes)
    variables["determined"] = vocabulary_variable("determined", ("side",), found.determined)
    labels: dict[str, Any] = {
        "side": labels_of(tuple(side.label for side in found.sides)),
        "side_point": (("side",), np.array([side.point for side in found.sides], dtype=str)),
        "side_link": (("side",), np.array([side.body for side in found.sides], dtype=str)),
    }
    if on_sphere:
        labels["held"] = labels_of(found.held)
    if mechanism.gears:
        labels["gear"] = labels_of(tuple(gear.id for gear in mechanism.gears))
        labels["gear_body"] = labels_of(GEAR_BODIES)
    if mechanism.rolling:
        labels["rolling"] = labels_of(tuple(wheel.id for wheel in mechanism.rolling))
    return variables, labels


def _state(free: FreeMotion, course: Trajectory, mechanism: Mechanism) -> JointState:
    """The state along time (1, instants) with derivatives of second order, of the mechanism with all drives."""
    q, w, a = (rows.T[:, None, :] for rows in (course.coordinates, course.speeds, course.accelerations))
    jets = [Jet((x, y, 0.5 * z)) for x, y, z in zip(q, w, a, strict=True)]
    time = course.time[None]
    state = free.equations.state(ARRAYS, free.tree.values(ARRAYS, list(q)), jets, time)
    parameter = np.broadcast_to(np.asarray(state.parameter, dtype=np.float64), time.shape)
    return replace(state, mechanism=mechanism, parameter=parameter[0], known={}, attitudes={})


def _acting(free: FreeMotion, course: Trajectory, state: JointState) -> list[Wrench]:
    """Loads, what drives, forces of stops, clamps and frictions, and inertia forces of links and shafts."""
    equations = free.equations
    pulls = [
        pull.times(load.term.strength(state)) for load in equations.loads for pull in load.term.pulls(state)
    ]
    pulls += [pull for action in inertia_forces_of(state, equations.masses, None) for pull in action.pulls]
    for contact, force in zip(equations.contacts, course.contact_forces.T, strict=True):
        pulls += [pull.times(force[None]) for pull in contact.coordinate.pulls(state)]
    for shaft in equations.shafts:
        moment = -shaft.inertia * state.drive(shaft.drive).derivative(2)
        pulls += [pull.times(moment) for pull in shaft.coordinate.pulls(state)]
    return pulls


def _with_all_drives(free: FreeMotion) -> Mechanism:
    """The mechanism with a drive for each free coordinate that none moves."""
    mechanism, tree, numbers = free.mechanism.with_drives_held(), free.tree, free.equations.numbers
    place = free.position.coordinates
    driven = [c for c in constraints_of(free.mechanism) if is_drive(c)]
    constraints = [*tree.closures, *driven]
    _left, rows = residuals_and_rows(tree, numbers, constraints, place, free.drive_values(place))
    scaled = rows * units_of(tree, numbers)
    norms = np.linalg.norm(scaled, axis=1)
    scaled = scaled[norms > 0.0] / norms[norms > 0.0][:, None]
    _u, sizes, turned = np.linalg.svd(scaled) if len(scaled) else (None, np.zeros(0), np.eye(len(place)))
    null = turned[int(np.sum(sizes > RANK * max(sizes, default=1.0))) :]
    count = len(free.mechanism.drives)
    missing = min(len(null), free.mobility + len(free.equations.kept) - count)
    if missing <= 0:
        return mechanism
    movable = [k for k, one in enumerate(tree.coordinates) if one.kind in ("angle", "slide")]
    if mechanism.space == "sphere" or len(movable) < missing:
        what = _("reactions of a motion with coordinates that no drive could move")
        raise NotComputedYet("reactions", what, _("name the free coordinates by [[drives]] without a law"))
    _q, _r, order = scipy.linalg.qr(null[:, movable], pivoting=True, mode="economic")
    chosen = [tree.coordinates[movable[k]] for k in sorted(order[:missing])]
    added = tuple(
        Drive(link=one.name, start=0.0, speed=0.0)
        if one.kind == "angle"
        else Drive(guide=one.name, start=0.0, speed=0.0)
        for one in chosen
    )
    return mechanism.model_copy(update={"drives": (*mechanism.drives, *added)})
