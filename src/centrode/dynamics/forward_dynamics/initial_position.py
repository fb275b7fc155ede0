"""Where a free motion starts: joint coordinates of the initial position, closed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.forward_dynamics.spanning_tree import (
    CarriedLink,
    FreePoint,
    JointValues,
    SlidPoint,
    SpanningTree,
    TreeLink,
    rotor_jets,
)
from centrode.errors import InputError
from centrode.geometry.sphere import components, tangent, tangent_inside, vector_in_frame
from centrode.kinematics.preparation import ready
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.structure.constraints import (
    AngleDrive,
    Constraint,
    DisplacementDrive,
    DistanceDrive,
    GearRatio,
    NoSlip,
    Positions,
    constraints_of,
    identity_of,
    is_drive,
    phase_of,
)
from centrode.structure.dimensions import Dimensions, dimensions_of

Number: TypeAlias = Any
Array: TypeAlias = npt.NDArray[np.float64]

CLOSED = 1e-13
"""Newton's method ends where residuals fall below this share of the mechanism's lengths, or no longer fall."""
OPEN = 1e-9
"""A position whose residuals stay above this share is none."""
STEPS = 60
JETS = JetFunctions(ARRAYS)


@dataclass(frozen=True)
class InitialPosition:
    """Joint coordinates of a position that closes, and the dimensions with the constants of gears."""

    coordinates: Array
    numbers: Dimensions


def residuals_and_rows(
    tree: SpanningTree,
    numbers: Dimensions,
    constraints: Sequence[Constraint],
    coordinates: Array,
    drives: Mapping[str, float],
) -> tuple[Array, Array]:
    """Left sides of constraints (equations) and their derivatives by the coordinates (equations, coordinates)."""
    values = tree.values(ARRAYS, list(coordinates))
    at = tree.positions(ARRAYS, numbers, values, drives)
    residuals = [constraint.residual(ARRAYS, numbers, at) for constraint in constraints]
    left = np.array([float(x) for own in residuals for x in own])
    rows = np.zeros((len(left), len(coordinates)))
    for k in range(len(coordinates)):
        unit = Jet((coordinates[k], 1.0))
        changed, rotors = list(coordinates), dict(values.rotors)
        changed[k] = unit
        if k in rotors:
            rotors[k] = rotor_jets(rotors[k], unit)
        moved = tree.positions_along(JETS, numbers, JointValues(changed, rotors), at, k)
        first = 0
        for constraint, own in zip(constraints, residuals, strict=True):
            if k in tree.dependence(constraint):
                for number, x in enumerate(constraint.residual(JETS, numbers, moved)):
                    rows[first + number, k] = x.coefficients[1] if isinstance(x, Jet) else 0.0
            first += len(own)
    return left, rows


def units_of(tree: SpanningTree, numbers: Dimensions) -> Array:
    """What a change of each coordinate is compared with: 1 rad, or the mechanism's greatest length."""
    scale = float(numbers.scale)
    return np.array([1.0 if one.kind == "angle" else scale for one in tree.coordinates])


def equation_units(constraints: Sequence[Constraint], numbers: Dimensions) -> Array:
    """What the residual of each equation is compared with."""
    scale = float(numbers.scale)
    return np.array([1.0 if c.angular else scale for c in constraints for _equation in range(c.size)])


def close_position(
    tree: SpanningTree,
    numbers: Dimensions,
    constraints: Sequence[Constraint],
    coordinates: Array,
    drives: Mapping[str, float],
    units: Array | None = None,
) -> Array:
    """Coordinates that keep the constraints, by Newton's method of least change; InputError where none are found.

    `units` are what a change of each coordinate costs, 1 rad and the greatest length where they are left out.
    """
    units = units_of(tree, numbers) if units is None else units
    scales = equation_units(constraints, numbers)
    best, place = np.inf, coordinates
    for _step in range(STEPS):
        left, rows = residuals_and_rows(tree, numbers, constraints, place, drives)
        size = float(np.max(np.abs(left) / scales, initial=0.0))
        if size <= CLOSED or (size < OPEN and size >= best):
            return place
        best = min(best, size)
        change = np.linalg.lstsq(rows * units / scales[:, None], -left / scales, rcond=1e-10)[0] * units
        # far off a step is no longer than a good part of a turn
        longest = float(np.max(np.abs(change) / units, initial=0.0))
        place = place + change * min(1.0, 0.5 / longest if longest else 1.0)
    if best < OPEN:
        return place
    what = _("the loops do not close: {gap:.3g} of the greatest length stays open").format(gap=best)
    raise InputError("", what, _("correct the initial angles, the starts of the drives or a length"))


def position_of_description(mechanism: Mechanism, tree: SpanningTree) -> InitialPosition:
    """The initial position that a description gives.

    With as many drives as the mobility it is the assembled one. With fewer it is the nearest one to the initial angles
    of the links, in which the drives that there are have their values.

    Raises
    ------
    InputError
        It does not close, or an initial angle is not given.
    """
    if len(mechanism.drives) and _has_all_drives(mechanism, tree):
        assembled = ready(mechanism).assembled
        numbers = assembled.numbers
        coordinates = coordinates_at(tree, numbers, assembled.positions, assembled.angles)
        constraints = [c for c in tree.closures]
        return InitialPosition(close_position(tree, numbers, constraints, coordinates, {}), numbers)
    return _nearest_position(mechanism, tree)


def _has_all_drives(mechanism: Mechanism, tree: SpanningTree) -> bool:
    """Whether drives are as many as the mobility at a random position near the described one."""
    if len(mechanism.drives) < len(tree.coordinates) - sum(closure.size for closure in tree.closures):
        # not even if every closure took a freedom away
        return False
    numbers = _with_any_phases(mechanism, tree, dimensions_of(mechanism))
    generator = np.random.default_rng(29)
    guess = generator.uniform(0.1, 1.5, len(tree.coordinates)) * units_of(tree, numbers)
    try:
        place = close_position(tree, numbers, tree.closures, guess, {})
    except InputError:
        place = _described_place(mechanism, tree, numbers, guess)
    _left, rows = residuals_and_rows(tree, numbers, tree.closures, place, {})
    scaled = rows * units_of(tree, numbers) / equation_units(tree.closures, numbers)[:, None]
    rank = int(np.sum(np.linalg.svd(scaled, compute_uv=False) > 1e-9)) if len(scaled) else 0
    return len(mechanism.drives) >= len(tree.coordinates) - rank


def _described_place(mechanism: Mechanism, tree: SpanningTree, numbers: Dimensions, guess: Array) -> Array:
    """A position near the described one; the guess where the description tells none, or none closes.

    Special lengths let a mechanism move that could not with others: nothing tells so but a position that closes.
    """
    try:
        described = np.array([_described_value(mechanism, tree, k) for k in range(len(tree.coordinates))])
        return close_position(tree, numbers, tree.closures, described, {})
    except InputError:
        # anywhere closures are as independent as they are in general
        return guess


def _with_any_phases(mechanism: Mechanism, tree: SpanningTree, numbers: Dimensions) -> Dimensions:
    meshing = [c for c in tree.closures if isinstance(c, GearRatio | NoSlip)]
    return replace(numbers, gearing=numbers.gearing.with_phases({identity_of(c): 0.0 for c in meshing}))


def _nearest_position(mechanism: Mechanism, tree: SpanningTree) -> InitialPosition:
    numbers = dimensions_of(mechanism)
    guess = np.array([_described_value(mechanism, tree, k) for k in range(len(tree.coordinates))])
    meshing = [c for c in tree.closures if isinstance(c, GearRatio | NoSlip)]
    others: list[Constraint] = [c for c in tree.closures if not isinstance(c, GearRatio | NoSlip)]
    driven = [c for c in constraints_of(mechanism) if is_drive(c)]
    starts = {drive.id: drive.start for drive in mechanism.drives if drive.start is not None}
    held = [c for c in driven if _drive_id(c) in starts]
    place = close_position(tree, numbers, [*others, *held], guess, starts)
    if meshing:
        # wheels mesh as they stand
        values = tree.values(ARRAYS, list(place))
        at = tree.positions(ARRAYS, numbers, values, starts)
        phases = {identity_of(c): float(phase_of(c, ARRAYS, numbers, at)) for c in meshing}
        numbers = replace(numbers, gearing=numbers.gearing.with_phases(phases))
    return InitialPosition(close_position(tree, numbers, tree.closures, place, starts), numbers)


def _drive_id(constraint: Constraint) -> str:
    assert isinstance(constraint, AngleDrive | DisplacementDrive | DistanceDrive)
    return constraint.drive


def _described_value(mechanism: Mechanism, tree: SpanningTree, number: int) -> float:
    """Value of a coordinate that the description gives."""
    coordinate = tree.coordinates[number]
    if coordinate.kind == "angle":
        link = mechanism.links[coordinate.name]
        for drive in mechanism.drives:
            if (
                drive.link == coordinate.name
                and drive.start is not None
                and drive.relative_to == coordinate.base
            ):
                return float(drive.start)
        if link.angle is not None:
            return float(link.angle)
        what = _("its initial angle is not given, and drives do not tell it")
        raise InputError(f"[links.{coordinate.name}]", what, _("give its angle"))
    if coordinate.kind == "slide":
        for drive in mechanism.drives:
            if drive.guide == coordinate.name and drive.start is not None:
                return float(drive.start)
    return 0.0


def coordinates_at(
    tree: SpanningTree, numbers: Dimensions, at: Positions, angles: Mapping[str, float]
) -> Array:
    """Joint coordinates of positions; angles of links have their turns where they are given."""
    coordinates = np.zeros(len(tree.coordinates))
    for step in tree.steps:
        if isinstance(step, SlidPoint):
            pose, curve = at.poses[step.base], numbers.curve(step.guide)
            coordinates[step.number] = float(numbers.space.slide(ARRAYS, at.points[step.point], pose, curve))
        elif isinstance(step, FreePoint):
            coordinates[step.first : step.first + 2] = [float(x) for x in at.points[step.point]]
        elif isinstance(step, TreeLink):
            value = angles.get(step.link) if step.measured else None
            if value is None or not isfinite(value):
                value = _angle_of(step, numbers, at)
            coordinates[step.number] = value
        else:
            assert not isinstance(step, CarriedLink) or step.link in at.poses
    return coordinates


def _angle_of(step: TreeLink, numbers: Dimensions, at: Positions) -> float:
    pose, place = at.poses[step.link], at.points[step.pivot]
    if not step.end:
        cosine, sine = pose.rotor
        return float(np.arctan2(sine, cosine))
    local = numbers.local[step.link]
    second = local[step.second] if step.second else (local[step.pivot][0] + 1.0, local[step.pivot][1])
    arm = vector_in_frame(pose, tangent_inside(ARRAYS, local[step.pivot], second))
    end = at.points[step.end]
    cosine, sine = components(arm, tangent(place, end), place)
    return float(np.arctan2(sine, cosine))
