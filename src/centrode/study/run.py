"""The main job: a mechanism's structure, its checked motion, and the scalars that sum them up."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from centrode.dynamics.bearings.results import ReactionResults, with_bearings
from centrode.dynamics.kinetostatics.applied_forces import input_motion_of
from centrode.dynamics.kinetostatics.friction import contacts_of
from centrode.dynamics.kinetostatics.reactions import reactions_at
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.masses import has_masses_or_loads
from centrode.dynamics.steady_motion.machine import MachineResults, machine_results
from centrode.errors import STATUSES_OF_MOTION, InputError, MotionError, NotComputedYet, Status
from centrode.kinematics.motion import dataset_of
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.several_inputs.coefficients import coefficients_of, most_samples
from centrode.kinematics.solve import Solved, requested_grid, solve
from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism, Study
from centrode.sheets.sheet import Scalar
from centrode.study.check import MechanismCheck, check_of
from centrode.study.limits import NOT_REACHED, limits_sentence, not_reached_sentence, repair_of_range
from centrode.study.texts import Words, extremes
from centrode.views import flywheel
from centrode.views import reactions as reactions_view


@dataclass(frozen=True)
class StudyResults:
    """A mechanism with everything `run` computes of it.

    Attributes
    ----------
    check : structure, mobility, plan, initial position
    motion : the labelled motion
    instants : the motion exactly at the instants the description asks for
    coefficients : kinematic coefficients by each drive, where there are several
    machine : energies, flywheel and real motion, where the description has a machine that can be computed
    reactions : forces in every joint at the samples, loads and wear of bearings, where there are masses or loads
    scalars : name -> number and SI unit, as `summary.json` holds them
    failure : why the mechanism cannot do what was asked, in a sentence; None if it can
    notes : what a reader should know besides
    words : sentences about the motion, in the units the description wants
    """

    mechanism: Mechanism
    check: MechanismCheck
    motion: xr.Dataset
    instants: xr.Dataset | None
    coefficients: xr.Dataset | None
    machine: MachineResults | None
    reactions: ReactionResults | None
    scalars: dict[str, Scalar]
    failure: str | None
    notes: tuple[str, ...]
    words: Words

    @property
    def results(self) -> Mapping[str, Any]:
        """What belongs to topics of the registry, by their names; without what the description has nothing for."""
        made = {"flywheel": self.machine, "reactions": self.reactions}
        return {name: result for name, result in made.items() if result is not None}


def study(
    mechanism: Mechanism, samples: int | None = None, start: float | None = None, stop: float | None = None
) -> StudyResults:
    """Check a mechanism and compute its motion; the arguments are those of `motion`."""
    prepared = ready(mechanism)
    solved = solve(prepared, requested_grid(prepared, samples, start, stop))
    checked = check_of(prepared)
    data = dataset_of(solved)
    words = Words(solved)
    machine, notes = _machine(mechanism, samples)
    reactions, lacking = _reactions(mechanism, solved)
    notes = [*_notes(mechanism, solved, words), *notes, *lacking]
    return StudyResults(
        mechanism,
        checked,
        data,
        _at_instants(prepared),
        coefficients_of(solved) if _by_each_drive(solved) else None,
        machine,
        reactions,
        _scalars(checked, solved)
        | dict(flywheel.scalars(machine.flywheel) if machine else ())
        | dict(reactions_view.scalars(reactions) if reactions else ()),
        _failure(solved, words),
        tuple(notes),
        words,
    )


def _machine(mechanism: Mechanism, samples: int | None) -> tuple[MachineResults | None, list[str]]:
    """The machine in steady motion; a note where it does not turn fully, or has what is not computed yet."""
    if mechanism.machine is None:
        return None, []
    try:
        return machine_results(mechanism, samples), []
    except (MotionError, NotComputedYet) as missing:
        what = f"{missing.what}; {missing.repair}" if missing.repair else missing.what
        return None, [_("the machine is left out: {reason}").format(reason=what)]


def _reactions(mechanism: Mechanism, solved: Solved) -> tuple[ReactionResults | None, list[str]]:
    """Reactions of a motion; a note where masses or loads are there, but not complete or not computed yet."""
    if not has_masses_or_loads(mechanism):
        return None, []
    try:
        burden = MassesAndLoads.for_reactions(mechanism)
        found = reactions_at(solved, burden, input_motion_of(solved, burden), contacts_of(mechanism))
    except (InputError, NotComputedYet) as missing:
        what = f"{missing.where}: {missing.what}" if missing.where else missing.what
        return None, [_("reactions are left out: {reason}").format(reason=what)]
    return with_bearings(mechanism, found), _jams(found)


def _jams(reactions: xr.Dataset) -> list[str]:
    """A note where friction lets nothing move."""
    locked = int((reactions["reaction_status"] == Status.SELF_LOCKING).sum())
    return [self_locking_sentence(locked)] if locked else []


def self_locking_sentence(samples: int) -> str:
    """At how many samples friction lets nothing move."""
    return ngettext(
        "self-locking: at {n} sample no drive overcomes the friction",
        "self-locking: at {n} samples no drive overcomes the friction",
        samples,
    ).format(n=samples)


def _by_each_drive(solved: Solved) -> bool:
    """Whether there are coefficients besides those of the motion, and not too many."""
    return len(solved.ready.mechanism.drives) > 1 and solved.status.size <= most_samples(solved)


def _at_instants(prepared: Ready) -> xr.Dataset | None:
    """The motion exactly at the instants the description asks for; None without any.

    They are values of the drive, which a law of time may pass more than once: then the nearest samples have to do.
    """
    places = prepared.mechanism.study.instants
    if not places or not prepared.parameter.states_instants:
        return None
    try:
        span = grid_at(prepared.kinematics.path, np.array(places))
    except InputError as error:
        raise InputError("[study] instants", error.what, error.repair) from None
    return dataset_of(solve(prepared, span))


def with_range(mechanism: Mechanism, asked: str | None) -> Mechanism:
    """The mechanism whose study has a range by a word ("reachable") in place of its own; itself without a word.

    Raises InputError for another word.
    """
    if asked is None:
        return mechanism
    own = mechanism.study
    study = Study(samples=own.samples, instants=own.instants, range=asked)
    return mechanism.model_copy(update={"study": study})


def range_value(mechanism: Mechanism, text: float | str, where: str) -> float:
    """Value of the drive, or time, that a number or a text with a unit names: an end of a motion's range [rad, m or s].

    Raises InputError for a unit of another kind.
    """
    return mechanism.motion_parameter.instant.read(text, where)


def _scalars(checked: MechanismCheck, solved: Solved) -> dict[str, Scalar]:
    unit = solved.ready.parameter.variable.unit
    parameter = solved.span.parameter
    found = {
        "mobility": Scalar(checked.mobility, "1"),
        "mobility_by_chebyshev": Scalar(checked.count.mobility, "1"),
        "moving_links": Scalar(checked.count.moving_links, "1"),
        "lower_pairs": Scalar(checked.count.lower_pairs, "1"),
        "higher_pairs": Scalar(checked.count.higher_pairs, "1"),
        "redundant_constraints": Scalar(len(checked.redundant), "1"),
        "loops": Scalar(checked.count.loops, "1"),
        "initial_residual": Scalar(checked.initial_residual, "1"),
        "samples": Scalar(len(parameter), "1"),
        "first_value": Scalar(float(parameter[0]), unit),
        "last_value": Scalar(float(parameter[-1]), unit),
        **_times(solved),
        "worst_residual": Scalar(float(np.nanmax(solved.residual, initial=0.0)), "1"),
    }
    for status in STATUSES_OF_MOTION:
        found[f"samples_{status.name.lower()}"] = Scalar(int(np.sum(solved.status == status)), "1")
    for kind in ("limit", "change point"):
        places = dict.fromkeys(event.at for event in solved.events() if event.kind == kind)
        for number, place in enumerate(places, start=1):
            found[f"{kind.replace(' ', '_')}_{number}"] = Scalar(place, unit)
    return found


def _times(solved: Solved) -> dict[str, Scalar]:
    """How long the motion takes; where a law drives, from when to when, and what each drive reaches."""
    first, last = float(solved.span.time[0]), float(solved.span.time[-1])
    found = {"duration": Scalar(abs(last - first), "s")}
    if not solved.ready.parameter.is_uniform:
        found |= {"first_time": Scalar(first, "s"), "last_time": Scalar(last, "s")}
        for drive, low, high in extremes(solved):
            unit = solved.ready.parameter.drive(drive.id).unit
            found |= {f"least_{drive.id}": Scalar(low, unit), f"greatest_{drive.id}": Scalar(high, unit)}
    return found


def _failure(solved: Solved, words: Words) -> str | None:
    """The sentence for samples that the mechanism does not reach; None if it reaches all."""
    missing = np.isin(solved.status[0], NOT_REACHED)
    if not missing.any():
        return None
    what = not_reached_sentence(int(missing.sum()), len(missing))
    low, high = solved.branches.reach(0)
    where = "; ".join(words.limit(at) for at in (low, high) if np.isfinite(at))
    return f"{what} ({where})" if where else what


def _notes(mechanism: Mechanism, solved: Solved, words: Words) -> list[str]:
    notes = []
    singular = int(np.sum(solved.status[0] == Status.SINGULAR))
    if singular:
        notes.append(
            ngettext(
                "{n} sample is singular: its position is given, its derivatives do not exist",
                "{n} samples are singular: their positions are given, their derivatives do not exist",
                singular,
            ).format(n=singular)
        )
    if len(mechanism.drives) > 1 and not _by_each_drive(solved):
        notes.append(
            _("kinematic coefficients by each drive are left out; ask for at most {most} samples").format(
                most=most_samples(solved)
            )
        )
    notes += words.period()
    if mechanism.loads and mechanism.machine is None:
        notes.append(
            _("the motion is given, loads do not change it: centrode reduce reduces them to the drive")
        )
    return notes


# Reactions at places that a mechanism does not reach, or where friction lets nothing move, as a failure.


def refuse_unreached(results: ReactionResults) -> None:
    """Raise MotionError where samples are not reached, with the limits of the motion, and at self-locking."""
    mechanism, status = results.mechanism, results.reactions["status"].to_numpy()
    missing = int(np.isin(status, NOT_REACHED).sum())
    if missing:
        what, where = not_reached_sentence(missing, len(status)), limits_sentence(mechanism)
        repair = _("ask for places between the limits") if results.at else repair_of_range(mechanism)
        raise MotionError("", f"{what} ({where})" if where else what, repair)
    locked = int((results.reactions["reaction_status"] == Status.SELF_LOCKING).sum())
    if locked:
        what = self_locking_sentence(locked)
        raise MotionError("", what, _("make the coefficients or radii less, or the sliders longer"))
