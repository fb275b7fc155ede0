"""The motion of a mechanism as a labelled result."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr

from centrode.errors import STATUSES_OF_MOTION, InputError, Status
from centrode.kinematics.hinge_angles import HINGE_ANGLES, hinge_rates, moving_hinges, spherical_coordinates
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.plan_evaluation import layout_of
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.repeated_motion import repeated_motion
from centrode.kinematics.sample_index import drive_coordinates, label_coordinates
from centrode.kinematics.samples import ORDERS
from centrode.kinematics.solve import Progress, Solved, grid_of, solve
from centrode.locale import _, speaking
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import kind_at, mechanism_text
from centrode.model.mechanism import Mechanism, kept_by_mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.units import read_quantity
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.rooms import GivenRoom, blank_like, check_room
from centrode.quantities import QUANTITIES
from centrode.structure.assur import name_of
from centrode.structure.dimensions import Dimensions, dimensions_of
from centrode.version import __version__

# Results with names: dimensions, units and attributes around the arrays of a motion.

Array: TypeAlias = npt.NDArray[np.float64]
Orders: TypeAlias = tuple[Array | None, Array, Array]
Variable: TypeAlias = tuple[tuple[str, ...], Any, dict[str, Any]]

BATCH = "mechanism"
EVENT_KINDS = ("limit", "change point")


def dataset_of(
    solved: Solved, vary: Mapping[str, Any] | None = None, room: GivenRoom | None = None
) -> xr.Dataset:
    """The labelled result of a motion; a batch has the dimension `mechanism` in front.

    Derivatives by time are fresh arrays, or views of given room.
    What it says in words is English, whatever language messages are in, so that the same motion gives the same file.
    """
    batch = bool(vary)
    front = (BATCH,) if batch else ()
    variables = _in_time(solved, front, room) | spherical_variables(solved, front)
    if not solved.ready.kinematics.path.by_time:
        variables |= _coefficients(solved, front)
    variables |= judgements_of(solved, front) | _contacts(solved, front)
    if not batch:
        variables |= _events(solved)
    attributes = attributes_of(solved, None if batch else "run")
    data = xr.Dataset(variables, coords=label_coordinates(coordinates_of(solved)), attrs=attributes)
    for path, values in (vary or {}).items():
        data = data.assign_coords({path: (BATCH, np.asarray(values, dtype=np.float64))})
    return data


def vocabulary_variable(
    name: str, dimensions: tuple[str, ...], values: Any, drive_unit: str = "rad", length_unit: str = "m"
) -> Variable:
    """A variable of the vocabulary with its dimensions, values and attributes."""
    return dimensions, values, dict(_words(name, drive_unit, length_unit))


@functools.cache
def _words(name: str, drive_unit: str, length_unit: str) -> Mapping[str, Any]:
    quantity = QUANTITIES[name].for_drive(drive_unit)
    if length_unit != "m":
        quantity = quantity.on_sphere()
    return {"units": quantity.unit, "symbol": quantity.symbol, "long_name": quantity.long_name}


def _lanes(array: Any, batch: tuple[str, ...]) -> Any:
    return array if batch else array[0]


def _in_time(solved: Solved, front: tuple[str, ...], room: GivenRoom | None) -> dict[str, Variable]:
    """Values and derivatives by time, by the chain rule from those by the path's parameter."""
    span, unit = solved.span, _length_unit(solved)
    variables: dict[str, Variable] = {}
    for kind in kinds_of(solved):
        for order in range(3):
            still = _still_points(solved) if kind.dimensions[0] == "point" and order > 0 else 0
            values = by_time(kind.orders, order, span, room, still)
            if values is None:
                continue
            name, dimensions = kind.names[order], (*front, "sample", *kind.dimensions)
            variables[name] = vocabulary_variable(name, dimensions, _lanes(values, front), length_unit=unit)
    return variables


def _still_points(solved: Solved) -> int:
    """Points in front of all others whose derivatives are zero at every sample."""
    # the frame's points are absent where the motion is; and with a drive that runs backwards zeros are negative
    moves = (solved.status == Status.OPEN).any() or not (solved.span.rate > 0.0).all()
    return 0 if moves else solved.all_points.shape[3] - solved.points.shape[3]


def by_time(
    orders: Orders, order: int, span: SampleGrid, room: GivenRoom | None = None, still: int = 0
) -> Array | None:
    """Values (order 0), or first or second derivatives by time (lanes, samples, ...); None where there are none.

    `still` is the number of points in front that do not move: of many samples their zeros are not written.
    """
    by_parameter = orders[order]
    if order == 0 or by_parameter is None:
        return by_parameter
    along = (slice(None), *[None] * (by_parameter.ndim - 2))  # samples, then what stands behind them
    # the chain rule: d/dt = rate d/dq, and second derivatives have rate^2 and the second rate
    factor = (span.rate if order == 1 else span.rate**2)[along]
    blank = blank_like(by_parameter) if room is None and still else None
    if blank is not None:
        values = blank
        np.multiply(by_parameter[:, :, still:], factor, out=values[:, :, still:])
    elif room is None:
        values = by_parameter * factor
    else:
        values = np.multiply(by_parameter, factor, out=room.take_like(by_parameter))
    if order == 2 and span.accelerates:
        values += orders[1] * span.second_rate[along]
    return values


@dataclass(frozen=True)
class VariableKind:
    """Kind of quantity with value and two derivatives by the path's parameter: names by time, prefix by the drive."""

    names: tuple[str, str, str]
    prefix: str
    dimensions: tuple[str, ...]
    orders: Orders


def kinds_of(solved: Solved) -> list[VariableKind]:
    """Quantities of a motion that have derivatives."""

    def orders(values: Array) -> Orders:
        return values[0], values[1], values[2]

    points = ("position", "velocity", "acceleration")
    slides = ("slide", "slide_velocity", "slide_acceleration")
    turning = ("angle", "angular_velocity", "angular_acceleration")
    kinds = [VariableKind(points, "", ("point", "axis"), orders(solved.all_points))]
    if solved.spins is None:
        kinds.append(VariableKind(turning, "angular_", ("link",), orders(solved.angles)))
    else:
        spins = (None, solved.spins[0], solved.spins[1])
        kinds.append(VariableKind(turning, "angular_", ("link", "axis"), spins))
        joints = ("joint_angle", "joint_velocity", "joint_acceleration")
        kinds.append(VariableKind(joints, "joint_", ("joint",), orders(solved.angles)))
    return [*kinds, VariableKind(slides, "slide_", ("guide",), orders(solved.slides))]


def hinge_orders(solved: Solved) -> Orders | None:
    """Angles at the moving hinges with two derivatives by the path's parameter; None where there are none."""
    hinges = moving_hinges(solved.ready.mechanism) if solved.hinges is not None else ()
    if not hinges:
        return None
    assert solved.spins is not None
    points = (*solved.ready.structure.dimensions.frame, *solved.layout.points)
    rates = hinge_rates(hinges, points, solved.all_points[0], solved.layout.links, solved.spins)
    return solved.hinges, *rates


def spherical_variables(
    solved: Solved, front: tuple[str, ...] = (), *, coordinates: bool = True
) -> dict[str, Variable]:
    """On the sphere: angles at the moving hinges with their rates by time, and polar angles and azimuths of points."""
    if solved.spins is None:
        return {}
    variables: dict[str, Variable] = {}
    orders = hinge_orders(solved)
    for order, name in enumerate(HINGE_ANGLES if orders is not None else ()):
        assert orders is not None
        values = _lanes(by_time(orders, order, solved.span), front)
        variables[name] = vocabulary_variable(name, (*front, "sample", "hinge"), values)
    if coordinates:
        polar, azimuth = spherical_coordinates(_lanes(solved.all_points[0], front))
        for name, values in (("polar_angle", polar), ("azimuth", azimuth)):
            variables[name] = vocabulary_variable(name, (*front, "sample", "point"), values)
    return variables


def _coefficients(solved: Solved, front: tuple[str, ...]) -> dict[str, Variable]:
    """Kinematic coefficients: derivatives by the drive's value."""
    unit = solved.ready.parameter.units[0]
    variables = {}
    for order, word in ((1, "velocity"), (2, "acceleration")):
        for kind in kinds_of(solved):
            name, dimensions = f"{kind.prefix}{word}_coefficient", (*front, "sample", *kind.dimensions)
            values = _lanes(kind.orders[order], front)
            variables[name] = vocabulary_variable(name, dimensions, values, unit, _length_unit(solved))
    return variables


def _length_unit(solved: Solved) -> str:
    return solved.layout.space.unit


def _contacts(solved: Solved, front: tuple[str, ...]) -> dict[str, Variable]:
    """Where rolling wheels touch their tracks."""
    if not solved.ready.mechanism.rolling:
        return {}
    dimensions = (*front, "sample", "rolling", "axis")
    return {"contact": vocabulary_variable("contact", dimensions, _lanes(solved.contacts, front))}


def judgements_of(solved: Solved, front: tuple[str, ...]) -> dict[str, Variable]:
    """Status and residual of every sample."""
    dimensions, status, attributes = vocabulary_variable(
        "status", (*front, "sample"), _lanes(solved.status, front)
    )
    attributes["flag_values"] = np.array([s.value for s in STATUSES_OF_MOTION], dtype=np.int8)
    attributes["flag_meanings"] = " ".join(s.name.lower() for s in STATUSES_OF_MOTION)
    return {
        "status": (dimensions, status, attributes),
        "residual": vocabulary_variable("residual", (*front, "sample"), _lanes(solved.residual, front)),
    }


def _events(solved: Solved) -> dict[str, Variable]:
    events = solved.events()
    parameter = solved.ready.parameter
    with speaking("en"):
        groups = [name_of(solved.ready.structure.groups[event.group]) for event in events]
    kinds = np.array([EVENT_KINDS.index(event.kind) for event in events], dtype=np.int8)
    dimensions, values, attributes = vocabulary_variable("event_kind", ("event",), kinds)
    attributes["flag_values"] = np.arange(len(EVENT_KINDS), dtype=np.int8)
    attributes["flag_meanings"] = " ".join(word.replace(" ", "_") for word in EVENT_KINDS)
    places = vocabulary_variable("event_value", ("event",), np.array([event.at for event in events]))
    places[2]["units"] = parameter.variable.unit
    return {
        "event_value": places,
        "event_kind": (dimensions, values, attributes),
        "event_group": vocabulary_variable("event_group", ("event",), np.array(groups, dtype=str)),
    }


def coordinates_of(solved: Solved) -> dict[str, Any]:
    """Times, values of the drives, and names."""
    along = coordinates_along(solved)
    frame = tuple(solved.ready.structure.dimensions.frame)
    joints = {} if solved.spins is None else joints_of(solved)
    wheels = tuple(wheel.id for wheel in solved.ready.mechanism.rolling)
    return {
        "time": along.pop("time"),
        "drive_value": along.pop("drive_value"),
        "point": labels_of(frame + solved.layout.points),
        "link": labels_of(solved.layout.links),
        **joints,
        "guide": labels_of(solved.layout.guides),
        **({"rolling": labels_of(wheels)} if wheels else {}),
        "drive": along.pop("drive"),
        "axis": labels_of(solved.layout.space.axes),
        **along,
    }


def joints_of(solved: Solved) -> dict[str, Any]:
    """On the sphere: links whose angle is counted from an arc, and pairs of links at moving hinges."""
    hinges = tuple(hinge.label for hinge in moving_hinges(solved.ready.mechanism))
    joints = {"joint": labels_of(solved.layout.angles)}
    return joints | ({"hinge": labels_of(hinges)} if hinges else {})


def coordinates_along(solved: Solved) -> dict[str, Any]:
    """Times, values of the drives together, their names, and the values of each by its name."""
    path = solved.ready.kinematics.path
    values = path.coordinates(ARRAYS, solved.span.parameter)
    count = len(solved.span.time)
    drives = np.stack([np.broadcast_to(value, (count,)) for value in values.values()], axis=-1)
    units = solved.ready.parameter.units
    drive_value = vocabulary_variable("drive_value", ("sample", "drive"), drives, units[0])
    if len(set(units)) > 1:
        drive_value[2]["units"] = " ".join(units)
    return {
        "time": vocabulary_variable("time", ("sample",), solved.span.time),
        "drive_value": drive_value,
        "drive": labels_of(tuple(values)),
        **drive_coordinates(tuple(values), drives, units),
    }


@functools.lru_cache(maxsize=256)
def labels_of(names: tuple[str, ...]) -> Any:
    """Names as a coordinate."""
    # an index as it is: from an array xarray makes one by way of every array library it finds, pint included
    return pd.Index(names, dtype=object)


_text_of = kept_by_mechanism(32)(mechanism_text)


def attributes_of(solved: Solved, topic: str | None = None) -> dict[str, Any]:
    """What a result says of itself: the topic of the registry that shows it, its mechanism as text, how exact it is."""
    mechanism = solved.ready.mechanism
    with speaking("en"):
        worst = solved.worst_constraint.label
    return {
        **({} if topic is None else {"topic": topic}),
        "title": mechanism.title,
        "mechanism": _text_of(mechanism),
        "version": __version__,
        "mobility": solved.ready.mobility,
        "worst_residual": float(np.nanmax(solved.residual, initial=0.0)),
        "worst_residual_constraint": worst,
    }


Values: TypeAlias = Mapping[str, npt.ArrayLike]

# what machine code needs is not loaded for one motion
_many = functools.partial(importlib.import_module, "centrode.kinematics.machine_code.batch")


def motion(
    mechanism: MechanismSource,
    samples: int | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
    at: npt.ArrayLike | None = None,
    vary: Values | None = None,
    progress: Progress | None = None,
    out: npt.NDArray[np.float64] | None = None,
) -> xr.Dataset:
    """Positions, velocities and accelerations of a mechanism, at evenly spaced samples or at given places.

    Parameters
    ----------
    samples : int
        The description's own number, else 361 (with both ends).
    start, stop : float [rad or m, or s], or texts with a unit ("60 deg")
        Values of the drive; times by a law of time or with several drives. One turn of an angle drive by default.
    at : (n,) values of the drive [rad or m], times [s], or texts with a unit
        Exactly these places instead of evenly spaced ones; the three arguments before it are then not used.
    vary : path -> (batch,) values [m or rad], or texts with a unit
        Dimensions that vary between mechanisms ("links.AC.length"); the signs of the initial position stay.
    progress : called with (mechanisms done, mechanisms in all)
    out : array of float64
        Room for points, angles and displacements with all derivatives, which are views of it (docs: results).

    Returns
    -------
    Dataset
        Dimensions sample, point, link, guide, drive, axis (docs: results); with `vary` a dimension
        mechanism in front. Absent values are NaN and have a status.

    Raises
    ------
    InputError
        The description does not define a motion: drives against mobility, initial position, range. No room in `out`.
    NotComputedYet
        It names what this version does not compute.

    Examples
    --------
    >>> import centrode as ct
    >>> motion = ct.motion(ct.example("crank-rocker"), 37)
    >>> motion.position.sel(point="B").shape
    (37, 2)
    >>> print(ct.summary(motion).splitlines()[-2])
    samples                37: ok 37
    """
    mechanism = mechanism_of(mechanism)
    prepared = ready(mechanism)
    vary = _varied_numbers(mechanism, vary)
    numbers, lanes = _batch(mechanism, vary)
    span = grid_of(prepared, samples, start, stop, at)
    if out is None:
        return dataset_of(_solve_range(prepared, span, numbers, lanes, progress), vary)
    check_room(out, lanes * len(span.parameter) * _numbers_of_position(prepared))
    room = GivenRoom(out)
    return dataset_of(_solve_range(prepared, span, numbers, lanes, progress, room), vary, room)


def _numbers_of_position(prepared: Ready) -> int:
    """Numbers that the arrays of a motion, and the way to them, take of one sample at most."""
    layout, mechanism = layout_of(prepared.kinematics), prepared.mechanism
    points = layout.axes * (len(prepared.structure.dimensions.frame) + len(layout.points))
    # on the sphere angular velocities are vectors
    turning = 3 * len(layout.links) if mechanism.space == "sphere" else 0
    solved = ORDERS * (points - layout.axes * len(layout.points) + layout.width + len(layout.angles))
    by_time = points + len(layout.angles) + turning + len(layout.guides)
    # contact points have two coordinates; the last two are the residual and the slack of radicands
    return solved + 2 * by_time + 2 * turning + 2 * len(mechanism.rolling) + 2


def initial_place(mechanism: Mechanism) -> float:
    """Value of the drive in the initial position, with a law or several drives the time there [rad, m or s]."""
    prepared = ready(mechanism)
    return float(prepared.kinematics.path.initial) if prepared.parameter.is_uniform else 0.0


def default_instants(mechanism: Mechanism) -> tuple[float, ...]:
    """Instants [rad, m or s] of the study, else that of the initial position."""
    return mechanism.study.instants or (initial_place(mechanism),)


def _solve_range(
    ready: Ready,
    span: SampleGrid,
    numbers: Dimensions | None,
    lanes: int,
    progress: Progress | None,
    room: GivenRoom | None = None,
) -> Solved:
    if numbers is None and room is None and progress is None:
        return repeated_motion(ready, span).solve(ready, span)
    if numbers is None:
        return solve(ready, span, progress=progress, given=room)
    # angles at hinges take their turns from the search of the arrays
    if ready.mechanism.space == "sphere" and moving_hinges(ready.mechanism):
        return solve(ready, span, numbers, lanes, progress, room)
    solved: Solved = _many().solve_many(ready, span, numbers, lanes, progress, room)
    return solved


def _varied_numbers(mechanism: Mechanism, vary: Values | None) -> Values | None:
    """Values in SI, of texts by the kind of quantity that their path names."""
    if not vary:
        return None
    refuses_bare = mechanism.display.refuses_bare_angles

    def numbers(path: str, values: Any) -> Any:
        values = [values] if isinstance(values, str) else values
        listed = isinstance(values, Sequence) or getattr(values, "dtype", np.dtype(float)).kind in "OU"
        if not listed or not any(isinstance(value, str) for value in values):
            return values
        kind = kind_at(mechanism, path)
        return [
            read_quantity(value, kind, path, refuses_bare=refuses_bare) if isinstance(value, str) else value
            for value in values
        ]

    return {path: numbers(path, values) for path, values in vary.items()}


def _batch(mechanism: Mechanism, vary: Values | None) -> tuple[Dimensions | None, int]:
    if not vary:
        return None, 1
    arrays = {path: np.asarray(values, dtype=np.float64) for path, values in vary.items()}
    sizes = {array.size for array in arrays.values()}
    if any(array.ndim != 1 for array in arrays.values()) or len(sizes) != 1 or 0 in sizes:
        raise InputError("vary", _("every path needs the same number of values, in one dimension"))
    for path, array in arrays.items():
        if not np.isfinite(array).all():
            raise InputError(path, _("values must be finite"))
    return dimensions_of(mechanism, arrays, ARRAYS), sizes.pop()


# What a drawing of one instant is made from: the motion with that instant among its samples, the points
# named.

ALL = "all"


def motion_among(mechanism: Mechanism, course: xr.Dataset, place: float) -> tuple[xr.Dataset, int]:
    """The samples of a motion with an instant among them, and the number of that sample.

    `place` is a value of the drive [rad or m], or a time [s] where the drive is a law of time or there are several.
    """
    places = np.unique(np.append(mechanism.motion_parameter.instants(course), place))
    return motion(mechanism, at=places), int(np.searchsorted(places, place))


def moving_points(mechanism: Mechanism, names: Sequence[str], where: str) -> tuple[str, ...]:
    """Points by their names, or every moving point for "all"; InputError, told of `where`, for another name."""
    if ALL in names:
        return mechanism.moving_points
    for name in names:
        if name not in mechanism.moving_points:
            what = _("there is no moving point {name}").format(name=value_text(name))
            raise InputError(where, what, nearest(name, mechanism.moving_points))
    return tuple(names)
