"""How great every load is over a motion, beside the coordinate and the speed that it works along."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum
from math import hypot
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.load_coordinates import Component, Distance, HalfSquare, Slide, Spin, Turn
from centrode.dynamics.loads import AppliedLoad, Constant, LoadTerm, MassesAndLoads
from centrode.dynamics.reduction import motion_of_loads
from centrode.dynamics.state import State
from centrode.dynamics.steady_motion.steady import solution_of, turned_at
from centrode.errors import CentrodeError
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import solve

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
AXES = "xyz"


class WorkingCoordinate(Enum):
    """What a load works along."""

    COMPONENT = "component"
    SLIDE = "slide"
    LENGTH = "length"
    ANGLE = "angle"


@dataclass(frozen=True)
class LoadCourse:
    """A load, or its component along one axis, at the samples of a motion.

    Attributes
    ----------
    label : name of the load in results
    axis : "x", "y" or "z" of a force that acts along an axis; empty of others
    unit : "N" or "N m"
    coordinate : kind of what it works along
    strength : (n) [unit], NaN where the motion does not exist
    place, speed : (n) coordinate [m or rad] and its derivative by time
    depends_on : "place", "speed", or nothing where it depends on neither
    """

    label: str
    axis: str
    unit: str
    coordinate: WorkingCoordinate
    strength: Array
    place: Array
    speed: Array
    depends_on: str

    @property
    def place_unit(self) -> str:
        """Unit of the coordinate."""
        return "rad" if self.coordinate is WorkingCoordinate.ANGLE else "m"

    @property
    def varies(self) -> bool:
        """Whether it is not the same at all samples, but for rounding."""
        known = self.strength[np.isfinite(self.strength)]
        return bool(known.size) and float(np.ptp(known)) > 1e-9 * float(np.max(np.abs(known)))


def load_courses(mechanism: Mechanism, reduction: xr.Dataset) -> tuple[LoadCourse, ...]:
    """Every load at the samples of a dataset of `reduce`, at the speed that loads see there."""
    prepared, places = ready(mechanism), mechanism.motion_parameter.instants(reduction)
    solved = solve(prepared, grid_at(prepared.kinematics.path, np.asarray(places, dtype=np.float64)))
    burden = MassesAndLoads.of(mechanism)
    state = State.of(solved, motion_of_loads(solved, burden))
    return tuple(course for load in burden.loads for course in _courses(load, state))


def _courses(load: AppliedLoad, state: State) -> Iterator[LoadCourse]:
    strengths = load.strengths(state, state.exists)
    for term, strength in zip(load.efforts, strengths, strict=True):
        yield _course(load.label, term, strength, state)


def _course(label: str, term: LoadTerm, strength: Any, state: State) -> LoadCourse:
    along, count = term.coordinate, len(state.parameter)
    place, speed = along.value(state), along.slope(state).value * state.rate
    kind, axis, sense = WorkingCoordinate.LENGTH, "", 1.0
    match along:
        case HalfSquare():
            # of a spring the law is along half the squared distance: a force is that times the distance
            length = np.sqrt(2.0 * np.asarray(place))
            with np.errstate(all="ignore"):
                place, strength, speed = length, strength * length, speed / length
        case Turn() | Spin():
            kind = WorkingCoordinate.ANGLE
        case Slide():
            kind = WorkingCoordinate.SLIDE
        case Component():
            kind = WorkingCoordinate.COMPONENT
            axis, sense = _axis_of(along.direction)
        case Distance():
            pass
    absent = np.where(np.asarray(state.exists), 0.0, np.nan)

    def over_samples(values: Any) -> Array:
        return np.asarray(np.broadcast_to(np.asarray(values) + absent, (1, count))[0])

    return LoadCourse(
        label,
        axis,
        "N m" if kind is WorkingCoordinate.ANGLE else "N",
        kind,
        sense * over_samples(strength),
        sense * over_samples(place),
        sense * over_samples(speed),
        _depends_on(term),
    )


def _axis_of(direction: tuple[float, ...]) -> tuple[str, float]:
    """The axis along which a direction runs and its sense; nothing of another direction."""
    size = hypot(*direction)
    for letter, x in zip(AXES, direction, strict=False):
        if abs(x) == size:
            return letter, 1.0 if x > 0.0 else -1.0
    return "", 1.0


def _depends_on(term: LoadTerm) -> str:
    """What of its own coordinate a term depends on; a one-sided force is drawn over its coordinate too."""
    amount = term.amount
    if "x" in amount.uses or (term.gate is not None and isinstance(amount, Constant)):
        return "place"
    return "speed" if "v" in amount.uses or amount.depends_on_sense else ""


def driving_moments(mechanism: Mechanism, reduction: xr.Dataset) -> Array | None:
    """Driving moment of a machine [N m] at the samples of a dataset of `reduce`, positive as the drive's value grows.

    It is that of the cycle with loads at the mean speed; None where it is not known.
    """
    if not mechanism.runs_at_mean_speed or "reduced_moment" not in reduction:
        return None
    with suppress(CentrodeError):
        solution = solution_of(mechanism)
        turned = turned_at(solution, at=reduction["drive_value"].values[:, 0])
        return np.asarray(solution.cycle.sense * solution.balance.driving.at(turned))
    return None
