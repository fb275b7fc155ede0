"""Rotatability with the repair: whether the drives turn fully, and the smallest changes after which they do."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from centrode.analysis.redesign.candidates import check_greatest_change, read_least_angle
from centrode.analysis.redesign.proposal import ProposedRepair, propose
from centrode.analysis.redesign.repair import LEAST_ANGLES, Repair
from centrode.analysis.redesign.repair import repair as find_repair
from centrode.analysis.redesign.single_changes import (
    DeadPosition,
    SingleChanges,
    dead_position,
    single_changes,
)
from centrode.analysis.rotatability.rotatability import Rotatability, rotatability
from centrode.analysis.transmission import TransmissionResults, transmission_results
from centrode.errors import CentrodeError, InputError
from centrode.locale import _
from centrode.model.units import read_quantity

if TYPE_CHECKING:
    from centrode.analysis.redesign.candidates import Value
    from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class RotatabilityResults(Rotatability):
    """What a mechanism's geometry says of its turning, with what is made of it.

    Attributes
    ----------
    repair : the smallest change after which the drive turns fully; None where none was sought
    single : the dimensions of which each alone repairs the mechanism; None where it makes the motion asked for
    proposed : the repair that documents propose; None where none was found, or none is needed
    dead : the dead position, and the repaired mechanism there, for documents
    refusal : why no change could be sought
    angles : transmission angles over the motion, for documents; None where no group has one
    """

    repair: Repair | None = None
    single: SingleChanges | None = None
    proposed: ProposedRepair | None = None
    dead: DeadPosition | None = None
    refusal: CentrodeError | None = None
    angles: TransmissionResults | None = None

    @classmethod
    def of(cls, turning: Rotatability, **more: Any) -> RotatabilityResults:
        """What is known of the turning, and more."""
        known = {one.name: getattr(turning, one.name) for one in fields(Rotatability)}
        return cls(**known, **more)


def rotatability_results(
    mechanism: Mechanism,
    samples: int | None = None,
    *,
    repair: bool = False,
    vary: Mapping[str, tuple[Value, Value] | None] | None = None,
    least_transmission_angle: Value | None = None,
    greatest_change: Value | None = None,
    complete: bool = False,
    progress: Callable[[float], None] | None = None,
) -> RotatabilityResults:
    """Whether a mechanism turns fully; of one that locks the changes of one dimension that repair it.

    Parameters
    ----------
    samples : int or None
        Of the motion over which documents show the transmission angles.
    repair : bool
        Seek the smallest change after which it turns fully.
    vary : mapping of path -> bounds or None, optional
        Numbers that may change, as `repair` has them.
    least_transmission_angle : float [rad] or text, optional
        As `repair` has it; of a change of one dimension too.
    greatest_change : float or text, optional
        As `repair` has it; of a change of one dimension too.
    complete : bool
        As documents have it: with the transmission angles over the motion, and of a mechanism that locks with its
        dead position and with the repair that is proposed.
    progress : function of the share that is done

    Raises
    ------
    InputError, NotComputedYet
        As `rotatability` and, with `repair`, `repair` do.
    """
    change = None if greatest_change is None else read_quantity(greatest_change, "ratio", "greatest_change")
    if repair:
        wanted = vary or {}
        bounds = {path: both for path, both in wanted.items() if both is not None}
        found = find_repair(
            mechanism,
            list(wanted) or None,
            bounds,
            least_transmission_angle,
            None if progress is None else lambda done, of: progress(done / of),
            change,
        )
        return RotatabilityResults.of(found.before, repair=found)
    turning = rotatability(mechanism)
    named = read_least_angle(least_transmission_angle, mechanism.display)
    check_greatest_change(change)
    single, refusal = _single_or_refusal(turning, LEAST_ANGLES if named is None else (named,), change)
    if not complete:
        return RotatabilityResults.of(turning, single=single, refusal=refusal)
    angles = _angles(mechanism, samples)
    if single is None:
        return RotatabilityResults.of(turning, refusal=refusal, angles=angles)
    proposed = propose(single)
    dead = None if proposed is None else dead_position(turning, single.required, proposed.repaired)
    several = proposed and proposed.several
    return RotatabilityResults.of(
        turning, repair=several, single=single, proposed=proposed, dead=dead, angles=angles
    )


def repair_results(mechanism: Mechanism, samples: int | None = None) -> Repair:
    """The smallest change after which a mechanism turns fully, of what `repair` varies where nothing is named."""
    return find_repair(mechanism)


def need_repair(
    _mechanism: Mechanism,
    *,
    repair: bool = False,
    vary: Mapping[str, tuple[Value, Value] | None] | None = None,
    least_transmission_angle: Value | None = None,
    greatest_change: Value | None = None,
) -> None:
    """Raise InputError for what belongs to a repair where none is sought."""
    given = {
        "--vary": vary,
        "--least-transmission-angle": least_transmission_angle,
        "--greatest-change": greatest_change,
    }
    for option, value in given.items():
        if value is not None and not repair:
            raise InputError(option, _("this option is used with --repair only"), _("add --repair"))


def _single_or_refusal(
    turning: Rotatability, margins: Sequence[float], greatest_change: float | None
) -> tuple[SingleChanges | None, CentrodeError | None]:
    """The changes that repair the one drive of a mechanism that locks, or why none is sought."""
    if len(turning.drives) > 1 or not (turning.limits or turning.turns_fully is False):
        return None, None
    try:
        return single_changes(turning.mechanism, turning, margins, greatest_change), None
    except CentrodeError as refusal:
        return None, refusal


def _angles(mechanism: Mechanism, samples: int | None) -> TransmissionResults | None:
    """Transmission angles over the motion; None where no group has one."""
    try:
        return transmission_results(mechanism, samples)
    except CentrodeError:
        return None
