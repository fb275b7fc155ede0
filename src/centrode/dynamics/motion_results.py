"""The main job: a mechanism's structure, its checked motion, its machine and its reactions as one result."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite, tau
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.bearings.results import ReactionResults, reaction_results, with_bearings
from centrode.dynamics.kinetostatics.applied_forces import MotionOfDrive, check_motion, input_motion_of
from centrode.dynamics.kinetostatics.friction import contacts_of
from centrode.dynamics.kinetostatics.reactions import reactions_at
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.masses import has_masses_or_loads
from centrode.dynamics.steady_motion.machine import MachineResults, machine_results
from centrode.errors import STATUSES_NOT_REACHED, CentrodeError, InputError, MotionError, NotComputedYet
from centrode.kinematics.check import MechanismCheck, check_of
from centrode.kinematics.motion import dataset_of, initial_place, motion
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.several_inputs.coefficients import coefficients_of, most_samples
from centrode.kinematics.several_inputs.limits import End
from centrode.kinematics.solve import Solved, requested_grid, solve
from centrode.model.mechanism import Mechanism
from centrode.structure.assur import name_of

BACK = 1e-6
"""A mechanism is back where its points are nearer to their first places than this share of its greatest length."""


@dataclass(frozen=True)
class MotionResults:
    """A mechanism with everything `run` computes of it.

    Attributes
    ----------
    mechanism : Mechanism
    check : structure, mobility, plan, initial position
    motion : the labelled motion
    worst_constraint : name of the constraint that is kept worst
    limits : what bounds the motion where samples are not reached; none where all are
    comes_back : False where one turn of the drive does not bring the mechanism back to its first position
    instants : the motion exactly at the instants that are asked for
    shown : the motion where tables of a document show it: at the instants, else in the initial position
    points : those whose places and rates a document has in tables
    coefficients : kinematic coefficients by each drive, where there are several
    most_samples : how many samples have such coefficients; of more they are left out
    machine : energies, flywheel and real motion, where the description has a machine that can be computed
    reactions : forces in every joint at the samples, loads and wear of bearings, where there are masses or loads
    refusals : name of a part -> why it is left out
    """

    mechanism: Mechanism
    check: MechanismCheck
    motion: xr.Dataset
    worst_constraint: str
    limits: tuple[End, ...]
    comes_back: bool
    instants: xr.Dataset | None
    coefficients: xr.Dataset | None
    most_samples: int
    machine: MachineResults | None
    reactions: ReactionResults | None
    refusals: Mapping[str, CentrodeError]
    shown: xr.Dataset | None = None
    points: tuple[str, ...] = ()

    @property
    def unreached_samples(self) -> int:
        """How many samples the mechanism does not reach."""
        return int(np.isin(self.motion["status"].values, STATUSES_NOT_REACHED).sum())

    @property
    def parts(self) -> Mapping[str, Any]:
        """Results of other topics that belong to it, by the names of the topics."""
        parts = {"flywheel": self.machine, "reactions": self.reactions}
        return {name: part for name, part in parts.items() if part is not None}


def study(
    mechanism: Mechanism,
    samples: int | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
    *,
    motion: MotionOfDrive = "mean",
    incomplete: bool = False,
) -> MotionResults:
    """Check a mechanism and compute its motion, its machine and its reactions.

    Parameters
    ----------
    samples, start, stop : as of `motion`
    motion : of the reactions: "mean", or "real", over the cycle of the machine
    incomplete : leave out a machine that is described wrongly as well

    Raises
    ------
    InputError, NotComputedYet
        As `motion`. A machine or reactions that cannot be computed, or whose masses or loads are not complete, are left
        out; `refusals` says why.

    Examples
    --------
    >>> import centrode as ct
    >>> from centrode.dynamics.motion_results import study
    >>> results = study(ct.example("crank-rocker"), 37)
    >>> results.unreached_samples
    0
    """
    check_motion(motion)
    prepared = ready(mechanism)
    solved = solve(prepared, requested_grid(prepared, samples, start, stop))
    return _results(solved, dataset_of(solved), samples, of_forces=motion, incomplete=incomplete)


def results_of_motion(mechanism: Mechanism, course: xr.Dataset) -> MotionResults:
    """A dataset of `motion`, or of `kinematic_coefficients`, with all that `study` computes beside it.

    Single places have no loads of bearings, as these are taken over a motion.

    Raises KeyError for a dataset that lacks a variable of the motion, or a part of one.
    """
    if course["status"].dims != ("sample",):
        raise KeyError("sample")
    prepared = ready(mechanism)
    places = mechanism.motion_parameter.instants(course)
    solved = solve(prepared, grid_at(prepared.kinematics.path, np.asarray(places, dtype=np.float64)))
    over_range = _is_evenly_spaced(places)
    count = len(places) if over_range else None
    whole = dataset_of(solved)
    if "drive_2" in course.dims:
        _check_whole(course, coefficients_of(solved))
        return replace(_results(solved, whole, count, over_range=over_range), coefficients=course)
    _check_whole(course, whole)
    return _results(solved, course, count, over_range=over_range)


def _check_whole(course: xr.Dataset, whole: xr.Dataset) -> None:
    """Raise KeyError where a dataset lacks a variable of another, or has it with other dimensions or fewer names."""
    for name, variable in whole.variables.items():
        if name not in course.variables or course.variables[name].dims != variable.dims:
            raise KeyError(name)
    for dimension, size in whole.sizes.items():
        # fewer samples are a shorter motion, with fewer events
        if dimension not in ("sample", "event") and course.sizes[dimension] != size:
            raise KeyError(dimension)


def _is_evenly_spaced(places: npt.NDArray[np.float64]) -> bool:
    """Whether places are those of a range: the grid of a range with these ends has the same bits."""
    ends = float(places[0]), float(places[-1])
    return len(places) > 2 and np.array_equal(places, np.linspace(*ends, len(places)))


def _results(
    solved: Solved,
    data: xr.Dataset,
    samples: int | None,
    *,
    over_range: bool = True,
    of_forces: MotionOfDrive = "mean",
    incomplete: bool = False,
) -> MotionResults:
    """What follows from a motion that is solved already; `samples` are those of the machine's cycle."""
    prepared, mechanism = solved.ready, solved.ready.mechanism
    refusals: dict[str, CentrodeError] = {}
    machine = reactions = None
    try:
        machine = machine_results(mechanism, samples) if mechanism.runs_at_mean_speed else None
    except (MotionError, NotComputedYet) as refusal:
        refusals["flywheel"] = refusal
    except InputError as refusal:
        if not incomplete and not _lacks_masses_or_loads(mechanism):
            raise
        refusals["flywheel"] = refusal
    try:
        if has_masses_or_loads(mechanism) and of_forces == "real":
            reactions = reaction_results(mechanism, samples, motion="real")
        elif has_masses_or_loads(mechanism):
            reactions = _reactions(mechanism, solved, over_range)
    except (InputError, MotionError, NotComputedYet) as refusal:
        refusals["reactions"] = refusal
    most = most_samples(solved)
    by_each_drive = len(mechanism.drives) > 1 and solved.status.size <= most
    found = MotionResults(
        mechanism,
        check_of(prepared),
        data,
        solved.worst_constraint.label,
        (),
        _comes_back(solved),
        _at_instants(prepared),
        coefficients_of(solved) if by_each_drive else None,
        most,
        machine,
        reactions,
        refusals,
    )
    return replace(found, limits=_limits(solved)) if found.unreached_samples else found


def _lacks_masses_or_loads(mechanism: Mechanism) -> bool:
    """Whether masses or loads are not complete."""
    try:
        MassesAndLoads.of(mechanism)
    except NotComputedYet:
        return False
    except InputError:
        return True
    return False


def with_instants(results: MotionResults, instants: Sequence[float], points: Sequence[str]) -> MotionResults:
    """Results with the motion at further instants [rad, m or s], or in the initial position where there are none.

    `points` are those whose places and rates tables have.
    """
    mechanism = results.mechanism
    places = instants_of(mechanism, instants)
    shown = motion(mechanism, at=places)
    return replace(results, shown=shown, instants=shown if instants else None, points=tuple(points))


def instants_of(mechanism: Mechanism, wished: Sequence[float]) -> list[float]:
    """Instants [rad, m or s] that are wished, each once; that of the initial position without any."""
    return list(dict.fromkeys(wished)) or [initial_place(mechanism)]


def _reactions(mechanism: Mechanism, solved: Solved, over_range: bool) -> ReactionResults:
    """Reactions of a motion that is solved already, over a range with the loads and the wear of the bearings."""
    given = MassesAndLoads.for_reactions(mechanism)
    found = reactions_at(
        solved, given, input_motion_of(solved, given), contacts_of(mechanism), whole=over_range
    )
    if over_range:
        return with_bearings(mechanism, found)
    return ReactionResults(mechanism, found, tuple(map(float, mechanism.motion_parameter.instants(found))))


def _at_instants(prepared: Ready) -> xr.Dataset | None:
    """The motion exactly at the instants of the description; None without any."""
    places = prepared.mechanism.study.instants
    if not places:
        return None
    try:
        span = grid_at(prepared.kinematics.path, np.array(places))
    except InputError as error:
        raise InputError("[study] instants", error.what, error.repair) from None
    return dataset_of(solve(prepared, span))


def _limits(solved: Solved) -> tuple[End, ...]:
    """The nearest limits on both sides of the initial position, with the groups that lock there."""
    groups, found = solved.ready.structure.groups, []
    for place in solved.branches.reach(0):
        if isfinite(place):
            events = [one for one in solved.branches.events if one.kind == "limit" and one.at == place]
            names = dict.fromkeys(name_of(groups[event.group]) for event in events)
            found.append(End(place, ", ".join(names)))
    return tuple(found)


def _comes_back(solved: Solved) -> bool:
    """Whether one turn of the drive brings the mechanism back; True of any other motion."""
    if not solved.ready.parameter.turns or len(solved.span.parameter) < 2:
        return True
    turned = abs(solved.span.parameter[-1] - solved.span.parameter[0])
    ends = solved.points[0, 0, [0, -1]]
    if abs(turned - tau) > 1e-9 or not np.isfinite(ends).all() or not ends.size:
        return True
    return float(np.abs(ends[1] - ends[0]).max()) <= BACK * float(solved.ready.kinematics.numbers.scale)
