"""Places of a mechanism that were asked for and are not reached."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

from centrode.errors import MotionError, Status
from centrode.locale import _
from centrode.quantities import status_word

if TYPE_CHECKING:
    import xarray

MOVING = (Status.OK, Status.CUT_OFF)
"""Statuses of places that have velocities."""


def is_moving(motion: xarray.Dataset, sample: int) -> bool:
    """Whether the mechanism has a position with velocities at a sample."""
    return Status(int(motion["status"][sample])) in MOVING


def is_placed(motion: xarray.Dataset, sample: int) -> bool:
    """Whether the mechanism has a position at a sample."""
    return Status(int(motion["status"][sample])) in (*MOVING, Status.SINGULAR)


def tell_no_centre(mechanism: str, link: str, other: str) -> NoReturn:
    """Raise MotionError about a link that has no instant centre over a motion."""
    what = _("{link} has no centre against {other} in this range: it translates, or does not move")
    raise MotionError(
        mechanism,
        what.format(link=link, other=other),
        _("name another link, or another body with --against"),
    )


def tell_absent(mechanism: str, motion: xarray.Dataset) -> None:
    """Raise MotionError if any place has no velocities: what the others give is written and printed by then."""
    absent = [int(code) for code in motion["status"].values if Status(int(code)) not in MOVING]
    if absent:
        raise MotionError(
            mechanism,
            _("at {n} of {all} places there are no velocities ({status})").format(
                n=len(absent), all=motion.sizes["sample"], status=status_word(absent[0])
            ),
            _("ask for places between the limits"),
        )
