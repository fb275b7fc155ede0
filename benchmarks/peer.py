"""The mechanisms of centrode, built in pylinkage 1.3.0 from the same plan, to be run by its compiled solver."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from importlib.util import find_spec
from math import atan2, hypot, tau
from typing import Any

import lazy_loader
import numpy as np
import numpy.typing as npt

from centrode.kinematics.preparation import Ready
from centrode.structure.constraints import FRAME
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Meet, Rail, RigidPoint, Rod, TurnedLink, TwoPointLink

Array = npt.NDArray[np.float64]
PRESENT = find_spec("pylinkage") is not None and find_spec("numba") is not None
MISSING = "pylinkage and numba are not installed: pip install 'centrode[benchmarks]'"


def _loaded(module: str) -> Any:
    # a module of a package that is not there cannot even be named
    return lazy_loader.load(f"pylinkage.{module}") if PRESENT else None


components = _loaded("components")
actuators = _loaded("actuators")
dyads = _loaded("dyads")
simulation = _loaded("simulation")
solver = _loaded("solver.simulation")


class CannotBuild(Exception):
    """The peer has no component for a group of the plan."""


@dataclass
class Peer:
    """A mechanism in pylinkage, standing one step before its first sample.

    `points` are names of the moving points, `columns` the places of their components in the peer's arrays.
    """

    linkage: Any
    points: tuple[str, ...]
    columns: list[int]
    start: list[tuple[float, float]]

    def reset(self) -> None:
        """Stand one step before the first sample again; a run goes on from where the last one ended."""
        self.linkage.set_coords(self.start)

    def positions(self, samples: int) -> Array:
        """Compiled run without derivatives: (samples, components, 2)."""
        found: Array = self.linkage.step_fast(samples)
        return found

    def motion(self, samples: int) -> tuple[Array, Array, Array]:
        """Compiled run with velocities and accelerations, each (samples, components, 2)."""
        found: tuple[Array, Array, Array] = self.linkage.step_fast_with_kinematics(samples)
        return found

    @functools.cached_property
    def ready_to_run(self) -> tuple[Array, Array, tuple[Any, ...]]:
        """Start (components, 2), constraints, and the rest of what the compiled function takes."""
        if self.linkage._solver_data is None or self.linkage._solver_data.omega_values is None:
            self.motion(1)
        data = self.linkage._solver_data
        shared = (data.joint_types, data.parent_indices, data.constraint_offsets, data.solve_order)
        return (
            np.array(self.start),
            data.constraints,
            (*shared, data.omega_values, data.alpha_values, data.crank_indices),
        )


def run_batch(peers: list[Peer], samples: int) -> list[tuple[Array, Array, Array]]:
    """Many mechanisms of one structure with derivatives, by the compiled function alone.

    The peer itself has batches for positions only (`simulate_batch`); this is its loop over the members with
    the function that also gives derivatives.
    """
    run = solver.simulate_with_kinematics
    found = []
    for peer in peers:
        start, constraints, shared = peer.ready_to_run
        positions, zeros = start.copy(), np.zeros_like(start)
        found.append(run(positions, zeros, zeros.copy(), constraints, *shared, samples, 1.0))
    return found


def build(ready: Ready, numbers: Dimensions, places: dict[str, tuple[float, float]], samples: int) -> Peer:
    """The peer of a mechanism turning once in `samples`, both ends included; `places` are those of the first sample.

    Raises CannotBuild if the plan has a group that the peer's compiled solver does not know.
    """
    path = ready.kinematics.path
    drive = path.driven[0].drive
    if path.by_time or drive.kind != "angle" or drive.speed is None or drive.relative_to != FRAME:
        raise CannotBuild("its drive is not a crank of constant speed")
    step = path.forward * tau / (samples - 1)
    parts: dict[str, Any] = {name: components.Ground(*at, name=name) for name, at in numbers.frame.items()}
    helpers: list[Any] = []
    for group in ready.structure.groups:
        if isinstance(group, RigidPoint):
            parts[group.point] = _rigid_point(ready, group, numbers, parts, path.initial - step, step)
        elif isinstance(group, Meet):
            part, lines = _meet(group, numbers, parts, places)
            parts[group.points[0]] = part
            helpers += lines
        elif not isinstance(group, (TwoPointLink, TurnedLink)):
            raise CannotBuild(f"no component for a group {group.kind}")
    linkage = simulation.Linkage([*helpers, *parts.values()])
    crank = next(iter(linkage._cranks))
    linkage.set_input_velocity(crank, omega=drive.speed)
    linkage.compile()
    order = [*(str(id(helper)) for helper in helpers), *parts]
    start = [(part.x, part.y) for part in linkage.components]
    moving = tuple(ready.mechanism.moving_points)
    return Peer(linkage, moving, [order.index(point) for point in moving], start)


def _rigid_point(
    ready: Ready, group: RigidPoint, numbers: Dimensions, parts: dict[str, Any], angle: float, step: float
) -> Any:
    """A crank's end, or a point that a link with two known points carries along."""
    local = numbers.local[group.link]
    known = [name for name in local if name in parts]
    if len(known) == 1 and ready.mechanism.drives[0].link == group.link:
        at, x, y = parts[known[0]], *_from(local, known[0], group.point)
        return actuators.Crank(at, hypot(x, y), angular_velocity=step, initial_angle=angle, name=group.point)
    if len(known) < 2:
        raise CannotBuild(f"point {group.point} hangs on one point of a link that is not driven")
    first, second = known[:2]
    x, y = _from(local, first, group.point)
    along_x, along_y = _from(local, first, second)
    angle = atan2(y, x) - atan2(along_y, along_x)
    return dyads.FixedDyad(parts[first], parts[second], distance=hypot(x, y), angle=angle, name=group.point)


def _from(local: Any, first: str, second: str) -> tuple[float, float]:
    return float(local[second][0] - local[first][0]), float(local[second][1] - local[first][1])


def _meet(
    group: Meet, numbers: Dimensions, parts: dict[str, Any], places: dict[str, tuple[float, float]]
) -> tuple[Any, list[Any]]:
    point = group.points[0]
    x, y = places[point]
    one, other = group.loci
    if group.carriage is None and isinstance(one, Rod) and isinstance(other, Rod):
        radii = (hypot(*_from(numbers.local[rod.link], rod.centre, point)) for rod in (one, other))
        return dyads.RRRDyad(parts[one.centre], parts[other.centre], *radii, x=x, y=y, name=point), []
    if group.carriage is None and isinstance(one, Rod) and isinstance(other, Rail) and other.on == FRAME:
        (x_0, y_0), (dx, dy) = numbers.through[other.guide], numbers.direction[other.guide]
        line = [components.Ground(x_0, y_0), components.Ground(x_0 + dx, y_0 + dy)]
        radius = hypot(*_from(numbers.local[one.link], one.centre, point))
        return dyads.RRPDyad(parts[one.centre], *line, distance=radius, x=x, y=y, name=point), line
    raise CannotBuild(f"no component for a group {group.kind} like that of point {point}")
