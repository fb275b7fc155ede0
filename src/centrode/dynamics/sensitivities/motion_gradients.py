"""Derivatives of a simulated motion by numbers of the description: lengths, masses, loads, and how it starts.

Where a number enters is known by differences of high order of what is prepared (numbers of the equations, initial
state); how the motion changes with these is integrated with it by the variational equations.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.forward_dynamics.free_motion import FreeMotion
from centrode.dynamics.forward_dynamics.initial_state import InitialState
from centrode.dynamics.forward_dynamics.trajectory import trajectory_points
from centrode.dynamics.sensitivities.variational_equations import ChangedMotion, VariationalEquations
from centrode.dynamics.simulation.multibody_motion import multibody_setting
from centrode.dynamics.state import length_unit
from centrode.errors import InputError
from centrode.kinematics.motion import vocabulary_variable
from centrode.locale import _
from centrode.model.files import value_at, with_value
from centrode.model.mechanism import Mechanism
from centrode.model.simulation import Simulation
from centrode.numerics.expressions import EXPRESSIONS, as_node, variable
from centrode.numerics.graphs import Graph, directional_derivatives
from centrode.numerics.jets import Jet
from centrode.numerics.scans import evaluate

Array: TypeAlias = npt.NDArray[np.float64]

STEP = 3e-4
"""Step of differences, as a share of the number, or itself where that is zero."""
WEIGHTS = ((1, 3.0 / 4.0), (2, -3.0 / 20.0), (3, 1.0 / 60.0))
"""Central differences of sixth order: steps and weights."""
MOST_NUMBERS = 40


@dataclass(frozen=True)
class MotionGradients:
    """A motion at instants (n) with its derivatives by k numbers.

    Attributes
    ----------
    paths : of the numbers
    motion : coordinates and their derivatives
    position, velocity : (n, k, points, axes) derivatives of places and velocities of points
    """

    paths: tuple[str, ...]
    motion: ChangedMotion
    position: Array
    velocity: Array


def motion_gradients(
    mechanism: Mechanism,
    settings: Simulation,
    paths: Sequence[str],
    times: Array,
    executor: str = "auto",
) -> MotionGradients:
    """The motion of a simulation at times (n) [s] that grow, and its derivatives by numbers of the description.

    Raises
    ------
    InputError
        A path names no number, or a number changes the structure of the equations.
    MotionError
        The motion does not get to the last instant.
    """
    described = mechanism.model_copy(update={"simulation": settings})
    if not 1 <= len(paths) <= MOST_NUMBERS:
        what = _("derivatives by {count} numbers are requested").format(count=len(paths))
        raise InputError("gradients", what, _("give 1 to {most} paths").format(most=MOST_NUMBERS))
    setting = multibody_setting(described, settings)
    start = setting.free.initial(setting.speeds, setting.start)
    changes = [_change(described, setting.free, path) for path in paths]
    equations = VariationalEquations(setting.free, tuple(numbers for numbers, _state in changes))
    motion = equations.motion(
        start, [state for _numbers, state in changes], times, settings.tolerance, executor
    )
    position, velocity = _of_points(setting.free, motion, [numbers for numbers, _state in changes])
    return MotionGradients(tuple(paths), motion, position, velocity)


def _prepared_motion(described: Mechanism, path: str, value: float) -> tuple[FreeMotion, InitialState]:
    changed = with_value(described, path, value)
    assert changed.simulation is not None
    setting = multibody_setting(changed, changed.simulation)
    return setting.free, setting.free.initial(setting.speeds, setting.start)


def _change(described: Mechanism, free: FreeMotion, path: str) -> tuple[dict[str, float], InitialState]:
    """How the numbers of the equations and the initial state change with a number of the description."""
    value = value_at(described, path)
    step = STEP * (abs(value) or 1.0)
    variables = free.integration.variables
    slopes = np.zeros(len(variables.parameters))
    size = len(free.coordinates)
    places, speeds = np.zeros(size), np.zeros(size)
    for count, weight in WEIGHTS:
        for sense in (1.0, -1.0):
            other, state = _prepared_motion(described, path, value + sense * count * step)
            if not variables.fits(other.equations):
                what = _("with another value the equations have other terms, so there is no derivative here")
                raise InputError(path, what, _("give it a value other than zero"))
            share = sense * weight / step
            slopes += share * variables.values(other.equations)[:, 0]
            places += share * state.coordinates
            speeds += share * state.speeds
    # what rounding makes of numbers that do not change is no change
    here = np.abs(variables.values(free.equations)[:, 0])
    changes = {
        name: float(x)
        for name, x, size_of in zip(variables.parameters, slopes, here, strict=True)
        if abs(x) * step > 1e-13 * size_of and abs(x) > 0.0
    }
    return changes, InitialState(places, speeds)


def _of_points(
    free: FreeMotion, motion: ChangedMotion, changes: Sequence[Mapping[str, float]]
) -> tuple[Array, Array]:
    """Derivatives (n, k, points, axes) of places and velocities, which depend on numbers by themselves too."""
    integration = free.integration
    variables, equations, m = integration.variables, integration.variables.equations, EXPRESSIONS
    size = len(free.coordinates)
    q = [variable(f"coordinate {k}") for k in range(size)]
    w = [variable(f"speed {k}") for k in range(size)]
    state = equations.state(
        m,
        equations.tree.values(m, q),
        [Jet((x, y, 0.0)) for x, y in zip(q, w, strict=True)],
        variable("time"),
    )
    points = trajectory_points(free.mechanism)
    jets = [jet for name in points for jet in state.point(name)]
    nodes = [as_node(jet.coefficients[k]) for k in (0, 1) for jet in jets]
    direction = {one: variable(f"change of {one.detail}") for one in (*q, *w)}
    direction |= {variable(name): variable(f"change of {name}") for name in variables.parameters}
    (derived,) = directional_derivatives(nodes, [direction])
    graph = Graph({str(k): as_node(x) for k, x in enumerate(derived)})
    numbers = dict(zip(variables.parameters, variables.values(free.equations)[:, 0].tolist(), strict=True))
    n, axes = len(motion.times), len(jets) // len(points)
    found = np.zeros((2, len(changes), n, len(points), axes))
    for k, change in enumerate(changes):
        values: dict[str, Any] = {"time": motion.times} | numbers
        values |= {f"change of {name}": change.get(name, 0.0) for name in variables.parameters}
        for i in range(size):
            values |= {
                f"coordinate {i}": motion.coordinates[:, i],
                f"speed {i}": motion.speeds[:, i],
                f"change of coordinate {i}": motion.coordinate_changes[:, k, i],
                f"change of speed {i}": motion.speed_changes[:, k, i],
            }
        out = evaluate(graph, values)
        rows = np.array([np.broadcast_to(out[str(j)], n) for j in range(len(nodes))])
        found[:, k] = rows.reshape(2, len(points), axes, n).transpose(0, 3, 1, 2)
    scaled = found * 1.0 / length_unit(free.mechanism)
    return scaled[0].transpose(1, 0, 2, 3), scaled[1].transpose(1, 0, 2, 3)


def add_gradients(
    mechanism: Mechanism, settings: Simulation, run: xr.Dataset, paths: Sequence[str], executor: str
) -> xr.Dataset:
    """A motion with its derivatives by numbers of the description."""
    found = motion_gradients(mechanism, settings, tuple(paths), run["time"].values, executor)
    numbers = np.array(found.paths, dtype=object)
    return run.assign(gradient_variables(run, found)).assign_coords(number=numbers)


def gradient_variables(run: xr.Dataset, gradients: MotionGradients) -> dict[str, Any]:
    """The derivatives with the names of a simulation's dataset, along its samples; the rest of these is NaN."""
    count = run.sizes["sample"]

    def over_samples(values: Array) -> Array:
        whole = np.full((count, *values.shape[1:]), np.nan)
        whole[: len(values)] = values
        return whole

    motion = gradients.motion
    by = ("sample", "number")
    return {
        "coordinate_gradient": vocabulary_variable(
            "coordinate_gradient", (*by, "coordinate"), over_samples(motion.coordinate_changes)
        ),
        "speed_gradient": vocabulary_variable(
            "speed_gradient", (*by, "coordinate"), over_samples(motion.speed_changes)
        ),
        "position_gradient": vocabulary_variable(
            "position_gradient", (*by, "point", "axis"), over_samples(gradients.position)
        ),
        "point_speed_gradient": vocabulary_variable(
            "point_speed_gradient", (*by, "point", "axis"), over_samples(gradients.velocity)
        ),
    }
