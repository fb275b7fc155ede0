"""Loads of a free motion: those of the description, without what jumps with the sense of a motion."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

from centrode.dynamics.forward_dynamics.broken_lines import broken_line_of
from centrode.dynamics.forward_dynamics.contacts import (
    Contact,
    SmoothFriction,
    friction_contact,
    rubbing_coordinate,
    sensed_contact,
)
from centrode.dynamics.forward_dynamics.equations_of_motion import DriveShaft, LoadAlong
from centrode.dynamics.load_coordinates import Distance, Slide, Turn
from centrode.dynamics.loads import (
    AppliedLoad,
    EnergyClass,
    Friction,
    LoadDiagram,
    LoadTable,
    LoadTerm,
    Situation,
)
from centrode.dynamics.state import is_none
from centrode.errors import InputError, NotComputedYet
from centrode.locale import _
from centrode.model.loads import AnyLoad, GuideFriction, HingeFriction
from centrode.model.mechanism import Drive, Mechanism

Number: TypeAlias = Any
ForceLaw: TypeAlias = Callable[[Any, Number, Number, Number], Number]
"""(m, t, q, v) -> force [N] or moment [N m] along a drive, over any algebra."""


@dataclass(frozen=True)
class DriveEffort:
    """A force or moment along what a drive moves, besides the loads: a motor's, or a given one.

    Attributes
    ----------
    drive : id of the drive
    law : of time, the drive's value and its speed
    uses : which of "t", "q" and "v" it depends on
    """

    drive: str
    law: ForceLaw
    uses: frozenset[str] = frozenset("tqv")


@dataclass(frozen=True)
class DriveLaw:
    """The force of a drive as the law of a load; x and v are those of the drive itself."""

    law: ForceLaw
    uses: frozenset[str]
    levels: tuple[float, ...] = ()
    jumps: bool = False
    depends_on_sense: bool = False
    energy_class = EnergyClass.OTHER
    by_place = False

    def __call__(self, now: Situation) -> Number:
        return self.law(now.m, now.t, now.x, now.v)


def free_loads_of(
    mechanism: Mechanism, loads: Sequence[AppliedLoad], efforts: Sequence[DriveEffort]
) -> tuple[LoadAlong, ...]:
    """Loads as they act on a free motion, then the forces of drives; dry friction is left to `dry_frictions_of`.

    Raises NotComputedYet for loads that act in one sense of a motion alone, and plain sums.
    """
    described = dict(zip((load.label for load in loads), mechanism.loads, strict=False))
    found = []
    for load in loads:
        for term in load.efforts:
            if has_sense(term):
                continue
            smooth = _smooth_part(term, described[load.label]) if is_dry(term) else term
            if smooth is not None:
                found.append(LoadAlong(load.label, _without_branches(load, smooth)))
    for effort in efforts:
        drive = next(one for one in mechanism.drives if one.id == effort.drive)
        law = DriveLaw(effort.law, effort.uses - {"q"})
        found.append(LoadAlong(f"drive {drive.id}", LoadTerm(coordinate_of_drive(mechanism, drive), law)))  # type: ignore[arg-type]
    return tuple(found)


def is_dry(term: LoadTerm) -> bool:
    """Whether an effort is friction with a dry part."""
    return isinstance(term.amount, Friction) and term.amount.depends_on_sense


def has_sense(term: LoadTerm) -> bool:
    """Whether an effort has a force for each sense of a motion, friction aside."""
    of_columns = isinstance(term.amount, LoadDiagram) and term.amount.depends_on_sense
    return term.works is None and (term.gate is not None or of_columns)


def _smooth_part(term: LoadTerm, load: AnyLoad) -> LoadTerm | None:
    """What of a friction grows with the speed, against the belt if there is one; None where nothing does."""
    law = term.amount
    assert isinstance(law, Friction)
    drift = load.surface_speed if isinstance(load, GuideFriction) else 0.0
    if is_none(law.viscous) and is_none(law.quadratic):
        return None
    return replace(term, amount=SmoothFriction(law.viscous, law.quadratic, drift))  # type: ignore[arg-type]


def dry_frictions_of(mechanism: Mechanism, loads: Sequence[AppliedLoad]) -> tuple[Contact, ...]:
    """The dry parts of frictions, and loads with a force for each sense, as contacts, in the order of the loads."""
    found = []
    for load, described in zip(loads, mechanism.loads, strict=False):
        for term in load.efforts:
            if is_dry(term):
                assert isinstance(term.amount, Friction)
                assert isinstance(described, HingeFriction | GuideFriction)
                along = rubbing_coordinate(mechanism, term.coordinate)
                found.append(friction_contact(described, load.label, term.amount, along))
            elif has_sense(term):
                found.append(sensed_contact(term, load.label, load.where))
    return tuple(found)


def coordinate_of_drive(mechanism: Mechanism, drive: Drive) -> Turn | Slide | Distance:
    """What the force of a drive works along."""
    if drive.distance is not None:
        return Distance(*drive.distance)
    if drive.guide is not None:
        return Slide(drive.guide)
    assert drive.link is not None
    return Turn(drive.link) if mechanism.space == "sphere" else Turn(drive.link, drive.relative_to)


def shafts_of(mechanism: Mechanism) -> tuple[DriveShaft, ...]:
    """The shafts and the flywheel of `[machine]`, which turn with the only drive."""
    inertia = 0.0 if mechanism.machine is None else mechanism.machine.inertia
    if not inertia:
        return ()
    if len(mechanism.drives) != 1:
        what = _("shafts and a flywheel turn with the one drive, and there are {count}")
        raise InputError("[machine]", what.format(count=len(mechanism.drives)), _("describe them as links"))
    (drive,) = mechanism.drives
    return (DriveShaft(drive, coordinate_of_drive(mechanism, drive), inertia),)


def _without_branches(load: AppliedLoad, term: LoadTerm) -> LoadTerm:
    amount = term.amount
    reason = None
    if term.works is not None:
        reason = _("a plain sum of friction")
    if reason is not None:
        what = _("{load} is not computed by all coordinates").format(load=reason)
        raise NotComputedYet(
            load.where, what, _("with one degree of freedom the reduced equation computes it")
        )
    if isinstance(amount, LoadDiagram | LoadTable):
        return replace(term, amount=broken_line_of(amount))  # type: ignore[arg-type]
    return term
