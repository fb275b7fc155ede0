"""Rotatability with the repair: whether the drives turn fully, and the smallest change after which they do."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

from centrode.analysis.redesign.repair import Repair
from centrode.analysis.redesign.repair import repair as find_repair
from centrode.analysis.rotatability.rotatability import Rotatability, rotatability
from centrode.analysis.transmission import TransmissionResults, transmission_results
from centrode.errors import CentrodeError, InputError
from centrode.locale import _

if TYPE_CHECKING:
    from centrode.analysis.redesign.candidates import Value
    from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class RotatabilityResults(Rotatability):
    """What a mechanism's geometry says of its turning, with what is made of it.

    Attributes
    ----------
    repair : the smallest change after which the drive turns fully; None where none was sought
    refusal : why none could be sought
    angles : transmission angles over the motion, for documents; None where no group has one
    """

    repair: Repair | None = None
    refusal: CentrodeError | None = None
    angles: TransmissionResults | None = None

    @classmethod
    def of(
        cls,
        turning: Rotatability,
        repair: Repair | None = None,
        refusal: CentrodeError | None = None,
        angles: TransmissionResults | None = None,
    ) -> RotatabilityResults:
        """What is known of the turning, and more."""
        known = {one.name: getattr(turning, one.name) for one in fields(Rotatability)}
        return cls(**known, repair=repair, refusal=refusal, angles=angles)


def rotatability_results(
    mechanism: Mechanism,
    samples: int | None = None,
    *,
    repair: bool = False,
    vary: Mapping[str, tuple[Value, Value] | None] | None = None,
    least_transmission_angle: Value | None = None,
    complete: bool = False,
    progress: Callable[[float], None] | None = None,
) -> RotatabilityResults:
    """Whether a mechanism turns fully, on demand with the repair of it.

    Parameters
    ----------
    samples : int or None
        Of the motion over which documents show the transmission angles.
    repair : bool
        Seek the smallest change after which it turns fully.
    vary : mapping of path -> bounds or None, optional
        Numbers that may change, as `repair` has them.
    least_transmission_angle : float [rad] or text, optional
        As `repair` has it.
    complete : bool
        As documents have it: with the transmission angles over the motion, and with the repair of one drive that
        does not turn fully, or the reason why none is sought.
    progress : function of the share that is done

    Raises
    ------
    InputError, NotComputedYet
        As `rotatability` and, with `repair`, `repair` do.
    """
    if repair:
        wanted = vary or {}
        bounds = {path: both for path, both in wanted.items() if both is not None}
        found = find_repair(
            mechanism,
            list(wanted) or None,
            bounds,
            least_transmission_angle,
            None if progress is None else lambda done, of: progress(done / of),
        )
        return RotatabilityResults.of(found.before, found)
    turning = rotatability(mechanism)
    if not complete:
        return RotatabilityResults.of(turning)
    mended, refusal = None, None
    if turning.turns_fully is False:
        mended, refusal = _repair_or_refusal(mechanism)
    return RotatabilityResults.of(turning, mended, refusal, _angles(mechanism, samples))


def repair_results(mechanism: Mechanism, samples: int | None = None) -> Repair:
    """The smallest change after which a mechanism turns fully, of what `repair` varies where nothing is named."""
    return find_repair(mechanism)


def need_repair(
    _mechanism: Mechanism,
    *,
    repair: bool = False,
    vary: Mapping[str, tuple[Value, Value] | None] | None = None,
    least_transmission_angle: Value | None = None,
) -> None:
    """Raise InputError for what belongs to a repair where none is sought."""
    given = {"--vary": vary, "--least-transmission-angle": least_transmission_angle}
    for option, value in given.items():
        if value is not None and not repair:
            raise InputError(option, _("this option is used with --repair only"), _("add --repair"))


def _repair_or_refusal(mechanism: Mechanism) -> tuple[Repair | None, CentrodeError | None]:
    try:
        return find_repair(mechanism), None
    except CentrodeError as refusal:
        return None, refusal


def _angles(mechanism: Mechanism, samples: int | None) -> TransmissionResults | None:
    """Transmission angles over the motion; None where no group has one."""
    try:
        return transmission_results(mechanism, samples)
    except CentrodeError:
        return None
