"""Equilibria of a mechanism under its loads as a labelled result: where they are, how stable, what changes them."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.equilibria.critical_values import (
    BRANCH_POINT,
    FOLD,
    HOPF,
    KINDS,
    KINK,
    CriticalValue,
    EquilibriumBranch,
    branches,
    number_range,
)
from centrode.dynamics.equilibria.equilibrium_search import (
    Equilibria,
    find_equilibria,
    no_equilibrium,
    stop_pushes,
)
from centrode.dynamics.equilibria.friction_bands import friction_bands, friction_reach, friction_share
from centrode.dynamics.equilibria.linear_equations import LoadedMechanism, loaded_mechanism
from centrode.dynamics.equilibria.posed_motions import posed_motion
from centrode.dynamics.equilibria.resting_equilibria import RestingEquilibrium, resting_equilibria
from centrode.dynamics.equilibria.small_motions import (
    STABILITIES,
    UNSTABLE,
    SmallMotions,
    small_motions,
)
from centrode.dynamics.forward_dynamics.contacts import stop_coordinate
from centrode.dynamics.load_coordinates import force_unit
from centrode.errors import InputError, MotionError
from centrode.kinematics.motion import vocabulary_variable
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import kind_at, mechanism_text, value_at, with_value
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest
from centrode.model.units import KINDS as QUANTITY_KINDS
from centrode.model.units import read_quantity
from centrode.version import __version__

Array: TypeAlias = npt.NDArray[np.float64]
Value: TypeAlias = float | str
"""A number in SI, or a text with a unit."""


@dataclass(frozen=True)
class EquilibriumResults:
    """Equilibria of a mechanism.

    Attributes
    ----------
    mechanism : the description
    equilibria : dataset of `equilibrium`
    poses : positions of all parts, each equilibrium a sample
    """

    mechanism: Mechanism
    equilibria: xr.Dataset
    poses: xr.Dataset


def equilibrium(
    mechanism: MechanismSource,
    *,
    hold: Mapping[str, Value] | None = None,
    vary: Mapping[str, Sequence[Value]] | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """All positions that are found in which a mechanism stays under its loads, and how stable they are.

    Everything can move that its joints allow; drives move too, whatever their laws, but those that are held. What is
    found can be reached from the initial position without taking the mechanism apart.

    Parameters
    ----------
    hold : drive -> value [rad or m, or a text with a unit]
        Drives that are held there; the result has the moment or force that this takes.
    vary : path -> (least, greatest), one number of the description [SI, or texts with a unit]
        Equilibria are followed along it, and its critical values found: folds, at which equilibria are lost, points at
        which others branch off, and Hopf points, at which oscillations begin to grow.
    progress : called with the share that is done

    Returns
    -------
    Dataset
        Of every `equilibrium`, counted from 1, stable ones first and near ones before those farther from the initial
        position, behind them those that rest on stops, with their `restraint_force`: positions, drives, potential
        energy, stability, eigenvalues of the linearised equations by `root`; the intervals in which dry friction holds
        (docs: equilibria). With `vary` the `branch_...` of equilibria and the `critical_...` values.

    Raises
    ------
    InputError
        Nothing can move, nothing acts, a load depends on time, or a drive or number is not known.
    MotionError
        No equilibrium is found.

    Examples
    --------
    >>> import centrode as ct
    >>> pendulum = ct.Mechanism(
    ...     gravity=[0, -9.81],
    ...     frame={"points": {"O": [0, 0]}},
    ...     links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
    ... )
    >>> found = ct.equilibrium(pendulum)
    >>> found.angle.sel(link="OA").values.round(3).tolist()
    [-1.571, 1.571]
    """
    description = mechanism_of(mechanism)
    held = held_values(description, hold)
    if vary is not None:
        # what is wrong is said before anything is sought
        _range_of(description, vary)
    loaded = loaded_mechanism(description.with_drives_held(), held)
    found = stable_first(find_equilibria(loaded))
    resting = resting_equilibria(loaded, found)
    held_up = found.curve is not None and loaded.has_friction and bool(friction_bands(found))
    if not len(found.places) and not resting and not held_up:
        raise no_equilibrium(loaded, found.starts)
    if progress is not None:
        progress(0.5)
    followed = () if vary is None else _branches(description, held, found, vary, progress)
    return _dataset(description, loaded, found, resting, held, vary, followed)


def stable_first(found: Equilibria) -> Equilibria:
    """Equilibria with those in front at which departures do not grow, the nearest to the initial position first."""
    grows = [one.stability == UNSTABLE for one in small_motions(found.loaded, found.places)]
    return replace(found, places=found.places[np.argsort(grows, kind="stable")])


def held_values(mechanism: Mechanism, hold: Mapping[str, Value] | None) -> dict[str, float]:
    """Drive -> angle, displacement or distance at which it is held; InputError for a drive that is not known."""
    found = {}
    for name, value in (hold or {}).items():
        coordinate = drive_coordinate(mechanism, name, "hold")
        found[name] = float(coordinate.measure_at(coordinate.read(value, f"hold {name}")))
    return found


def drive_coordinate(mechanism: Mechanism, name: str, where: str) -> Any:
    """The coordinate of a drive; InputError for one that is not known."""
    known = [drive.id for drive in mechanism.drives]
    if name not in known:
        raise InputError(where, _("there is no drive {name}").format(name=f'"{name}"'), nearest(name, known))
    return mechanism.motion_parameter.drive(name)


def equilibrium_results(
    mechanism: Mechanism,
    *,
    hold: Mapping[str, Value] | None = None,
    vary: Mapping[str, Any] | None = None,
    progress: Callable[[float], None] | None = None,
) -> EquilibriumResults:
    """Equilibria with the positions that are drawn; see `equilibrium`."""
    for path, bounds in (vary or {}).items():
        if bounds is None:
            what = _("no range is given")
            raise InputError(f"vary {path}", what, _('write "{path}=LOW:HIGH"').format(path=path))
    found = equilibrium(mechanism, hold=hold, vary=vary or None, progress=progress)
    return results_of_equilibrium(mechanism, found)


def results_of_equilibrium(mechanism: Mechanism, equilibria: xr.Dataset) -> EquilibriumResults:
    """A dataset of `equilibrium` with the positions that are drawn."""
    held = {name: float(value) for name, value in json.loads(equilibria.attrs["hold"]).items()}
    drawn = mechanism.with_drives_held().model_copy(update={"controllers": ()})
    loaded = loaded_mechanism(drawn, held)
    places = equilibria["generalised_coordinate"].values
    return EquilibriumResults(mechanism, equilibria, posed_motion(loaded, np.zeros(len(places)), places))


def has_loads_to_rest(mechanism: Mechanism) -> bool:
    """Whether weights, springs or other loads may hold a mechanism."""
    return bool(mechanism.loads) or (
        bool(mechanism.gravity) and any(link.mass is not None for link in mechanism.links.values())
    )


# What is followed along a number


def _branches(
    description: Mechanism,
    held: Mapping[str, float],
    found: Equilibria,
    vary: Mapping[str, Sequence[Value]],
    progress: Callable[[float], None] | None,
) -> tuple[EquilibriumBranch, ...]:
    """The branches through the equilibria of the description; with one degree of freedom of both ends too."""
    path, low, high = _range_of(description, vary)
    along = number_range(partial(_with_number, description, held, path), low, high, path)
    here = value_at(description, path)
    seeds = [(here, found.places)] if low <= here <= high else []
    # with more degrees of freedom each search takes long, and there are many branches already
    for value in (low, high) if found.curve is not None or not seeds else ():
        try:
            seeds.append((value, find_equilibria(_with_number(description, held, path, value)).places))
        except MotionError:
            # without any at this end there may be some at others
            continue
    if progress is not None:
        progress(0.7)
    return branches(along, seeds)


def _range_of(description: Mechanism, vary: Mapping[str, Sequence[Value]]) -> tuple[str, float, float]:
    if len(vary) != 1:
        what = _("equilibria are followed along one number, and {count} are given").format(count=len(vary))
        raise InputError("vary", what, _("keep one of them"))
    ((path, bounds),) = vary.items()
    kind = kind_at(description, path)
    low, high = (read_quantity(one, kind, path) if kind in QUANTITY_KINDS else float(one) for one in bounds)
    if not low < high:
        raise InputError(path, _("the range is empty: {low:.6g} to {high:.6g}").format(low=low, high=high))
    return path, low, high


def _with_number(
    description: Mechanism, held: Mapping[str, float], path: str, value: float
) -> LoadedMechanism:
    changed = with_value(description, path, value)
    assert isinstance(changed, Mechanism)
    return loaded_mechanism(changed.with_drives_held(), held)


# The result with names


def _dataset(
    description: Mechanism,
    loaded: LoadedMechanism,
    found: Equilibria,
    resting: Sequence[RestingEquilibrium],
    held: Mapping[str, float],
    vary: Mapping[str, Sequence[Value]] | None,
    followed: Sequence[EquilibriumBranch],
) -> xr.Dataset:
    places = np.concatenate([found.places, *(one.place[None] for one in resting)])
    motions = (*small_motions(loaded, found.places), *(one.motions for one in resting))
    poses = posed_motion(loaded, np.zeros(len(places)), places)
    variables = pose_variables(poses, "equilibrium")
    variables |= drive_variables(description, loaded, places, "equilibrium")
    variables |= _stability(motions)
    variables |= _friction(loaded, found, len(resting))
    coordinates: dict[str, Any] = {"equilibrium": np.arange(1, len(places) + 1)}
    variables |= _controllers(description, loaded, places, coordinates)
    if resting:
        _correct_holding(variables, description, loaded, resting)
    pushes = stop_pushes(loaded, places)
    if resting or np.any(pushes):
        variables["restraint_force"] = _stop_forces(description, pushes, len(found.places), resting)
        labels = [stop.label for stop in description.stops]
        coordinates["contact"] = np.array(labels, dtype=object)
    coordinates |= label_values(poses, description)
    facts: dict[str, Any] = {
        "topic": "equilibrium",
        "title": description.title,
        "mechanism": mechanism_text(description),
        "version": __version__,
        "mobility": loaded.mobility,
        "starts": found.starts,
        "hold": json.dumps(dict(held)),
        "vary": "",
    }
    if vary is not None:
        path, low, high = _range_of(description, vary)
        variables |= _branch_variables(description, loaded, followed, kind_at(description, path))
        facts |= {"vary": path, "vary_low": low, "vary_high": high, "vary_value": value_at(description, path)}
    return xr.Dataset(variables, coordinates, facts)


def pose_variables(poses: xr.Dataset, dimension: str) -> dict[str, Any]:
    """Variables of positions with a dimension of another name in place of their samples."""
    found = {}
    for name in poses.data_vars:
        if name != "status":
            one = poses[name]
            found[str(name)] = (
                tuple(dimension if part == "sample" else str(part) for part in one.dims), one.values, dict(one.attrs)
            )  # fmt: skip
    return found


def label_values(poses: xr.Dataset, description: Mechanism) -> dict[str, Any]:
    """Names along the dimensions of positions."""
    names = ("point", "axis", "link", "joint", "guide", "coordinate")
    found: dict[str, Any] = {name: poses[name].values for name in names if name in poses.coords}
    return found | {"drive": np.array([drive.id for drive in description.drives], dtype=object)}


def drive_values_at(description: Mechanism, loaded: LoadedMechanism, places: Array) -> Array:
    """Values (n, drives) of the coordinates of all drives [rad or m]."""
    coordinates = description.motion_parameter.drives
    rows = [loaded.drive_values(place) for place in places]
    values = [[float(one.value_of(row[one.name])) for one in coordinates] for row in rows]
    return np.array(values, dtype=np.float64).reshape(len(places), len(coordinates))


def drive_variables(
    description: Mechanism, loaded: LoadedMechanism, places: Array, dimension: str
) -> dict[str, Any]:
    """Values of all drives, and what holds those that are held."""
    units = description.motion_parameter.units
    if not units:
        return {}
    values = drive_values_at(description, loaded, places)
    variable = vocabulary_variable("drive_value", (dimension, "drive"), values, units[0])
    variable[2]["units"] = units[0] if len(set(units)) == 1 else ", ".join(units)
    found = {"drive_value": variable}
    kept = loaded.equations.kept
    if kept:
        moments = np.full(values.shape, np.nan)
        forces = loaded.reactions(loaded.at(places))
        own = [drive.id for drive in description.drives]
        for k, one in enumerate(kept):
            sense = description.motion_parameter.drive(one.name).sense
            # what the drive gives acts against its constraint
            moments[:, own.index(one.name)] = -sense * forces[:, loaded.equations.equations - len(kept) + k]
        holding = vocabulary_variable("holding_moment", (dimension, "drive"), moments, units[0])
        units_of_force = [one.force_unit for one in description.motion_parameter.drives]
        holding[2]["units"] = (
            units_of_force[0] if len(set(units_of_force)) == 1 else ", ".join(units_of_force)
        )
        found["holding_moment"] = holding
    return found


def _flags(name: str, dimensions: tuple[str, ...], words: Sequence[str], known: Sequence[str]) -> Any:
    numbers = np.array([known.index(word) for word in words], dtype=np.int8)
    dims, values, attributes = vocabulary_variable(name, dimensions, numbers)
    attributes["flag_values"] = np.arange(len(known), dtype=np.int8)
    attributes["flag_meanings"] = " ".join(word.replace(" ", "_") for word in known)
    return dims, values, attributes


def _stability(motions: Sequence[SmallMotions]) -> dict[str, Any]:
    roots = max((len(one.eigenvalues) for one in motions), default=0)
    values = np.full((len(motions), roots), np.nan + 0j)
    for row, one in zip(values, motions, strict=True):
        row[: len(one.eigenvalues)] = one.eigenvalues
    words = [one.stability for one in motions]
    return {
        "stability": _flags("stability", ("equilibrium",), words, STABILITIES),
        "growth_rate": vocabulary_variable("growth_rate", ("equilibrium", "root"), values.real),
        "damped_frequency": vocabulary_variable("damped_frequency", ("equilibrium", "root"), values.imag),
    }


def _correct_holding(
    variables: dict[str, Any],
    description: Mechanism,
    loaded: LoadedMechanism,
    resting: Sequence[RestingEquilibrium],
) -> None:
    """Put what holds the drives where stops bear a part of the loads."""
    if "holding_moment" not in variables:
        return
    values, own = variables["holding_moment"][1], [drive.id for drive in description.drives]
    for row, one in zip(values[len(values) - len(resting) :], resting, strict=True):
        for kept, force in zip(loaded.equations.kept, one.holding, strict=True):
            row[own.index(kept.name)] = -description.motion_parameter.drive(kept.name).sense * force


def _controllers(
    description: Mechanism, loaded: LoadedMechanism, places: Array, coordinates: dict[str, Any]
) -> dict[str, Any]:
    """What controllers give at equilibria, as far as a free drive depends on it; their names among the coordinates."""
    controls = loaded.equations.controls
    if not controls:
        return {}
    coordinates["controller"] = np.array([one.description.name for one in controls], dtype=object)
    found = vocabulary_variable("controller_output", ("equilibrium", "controller"), loaded.at(places).output)
    units = ["1" if one.drives is None else force_unit(one.drives) for one in controls]
    found[2]["units"] = units[0] if len(set(units)) == 1 else ", ".join(units)
    return {"controller_output": found}


def _stop_forces(
    description: Mechanism, pushes: Array, free: int, resting: Sequence[RestingEquilibrium]
) -> Any:
    """Forces of all stops along their coordinates (equilibrium, contact); zero of what is open.

    `pushes` are those of compliant stops.
    """
    stops, forces = description.stops, pushes.copy()
    for row, one in zip(forces[free:], resting, strict=True):
        row += [one.forces.get(stop.label, 0.0) for stop in stops]
    found = vocabulary_variable("restraint_force", ("equilibrium", "contact"), forces)
    units = [force_unit(stop_coordinate(description, stop)) for stop in stops]
    found[2]["units"] = units[0] if len(set(units)) == 1 else ", ".join(units)
    return found


def _friction(loaded: LoadedMechanism, found: Equilibria, resting: int) -> dict[str, Any]:
    """Where dry friction holds: intervals with one degree of freedom, bounds about each equilibrium with more."""
    if not loaded.has_friction:
        return {}
    units = [one.unit for one in loaded.coordinates]
    unit = units[0] if len(set(units)) == 1 else ", ".join(units)

    def named_number(name: str, dimensions: tuple[str, ...], values: Array) -> Any:
        variable = vocabulary_variable(name, dimensions, values)
        variable[2]["units"] = unit
        return variable

    if found.curve is None:
        reach = friction_reach(loaded, found.places)
        # on a stop friction has no bounds of its own
        reach = np.concatenate([reach, np.full((resting, loaded.size), np.nan)])[:, : loaded.joints]
        return {"friction_reach": named_number("friction_reach", ("equilibrium", "coordinate"), reach)}
    bands = friction_bands(found)
    ends = np.array([band.ends for band in bands]).reshape(len(bands), 2, loaded.size)[:, :, : loaded.joints]
    whole = np.array([band.whole for band in bands], dtype=np.int8)
    feeds = np.array([band.feeds_itself for band in bands], dtype=np.int8)
    return {
        "friction_share": vocabulary_variable("friction_share", (), np.array(friction_share(found))),
        "friction_feeds_itself": vocabulary_variable("friction_feeds_itself", ("band",), feeds),
        "friction_band": named_number("friction_band", ("band", "end", "coordinate"), ends),
        "friction_holds_everywhere": vocabulary_variable("friction_holds_everywhere", ("band",), whole),
    }


def _branch_variables(
    description: Mechanism, loaded: LoadedMechanism, followed: Sequence[EquilibriumBranch], kind: str
) -> dict[str, Any]:
    unit = QUANTITY_KINDS[kind].unit if kind in QUANTITY_KINDS else "1"
    none = np.zeros((0, loaded.size))
    places = np.concatenate([none, *(one.places for one in followed)])[:, : loaded.joints]
    values = np.concatenate([np.zeros(0), *(one.values for one in followed)])
    numbers = np.concatenate(
        [np.zeros(0), *(np.full(len(one.values), k + 1.0) for k, one in enumerate(followed))]
    )
    words = [motion.stability for one in followed for motion in one.motions]
    critical: list[CriticalValue] = []
    # where branches cross, one of them turns round: that is no fold
    for kind in (BRANCH_POINT, FOLD, HOPF, KINK):
        for one in (one for branch in followed for one in branch.critical if one.kind == kind):
            if not any(_same_place(loaded, one, other) for other in critical):
                critical.append(one)
    critical.sort(key=lambda one: one.value)
    at = np.array([one.place for one in critical]).reshape(len(critical), loaded.size)[:, : loaded.joints]

    def of_number(name: str, dimension: str, numbers: Array) -> Any:
        variable = vocabulary_variable(name, (dimension,), numbers)
        variable[2]["units"] = unit
        return variable

    def of_coordinates(name: str, dimension: str, rows: Array) -> Any:
        variable = vocabulary_variable(name, (dimension, "coordinate"), rows)
        units = [one.unit for one in loaded.coordinates]
        variable[2]["units"] = units[0] if len(set(units)) == 1 else ", ".join(units)
        return variable

    return {
        "branch": vocabulary_variable("branch", ("branch_point",), numbers.astype(np.int64)),
        "branch_value": of_number("branch_value", "branch_point", values),
        "branch_coordinate": of_coordinates("branch_coordinate", "branch_point", places),
        "branch_stability": _flags("branch_stability", ("branch_point",), words, STABILITIES),
        "critical_value": of_number("critical_value", "critical", np.array([one.value for one in critical])),
        "critical_kind": _flags("critical_kind", ("critical",), [one.kind for one in critical], KINDS),
        "critical_coordinate": of_coordinates("critical_coordinate", "critical", at),
        "critical_frequency": vocabulary_variable(
            "critical_frequency", ("critical",), np.array([one.frequency for one in critical])
        ),
    }


def _same_place(loaded: LoadedMechanism, one: CriticalValue, other: CriticalValue) -> bool:
    """Whether two critical values are one, found on two branches."""
    near = np.max(np.abs((one.place - other.place) / loaded.units)) < 1e-3
    return bool(near and abs(one.value - other.value) <= 1e-5 * max(abs(one.value), abs(other.value)))
