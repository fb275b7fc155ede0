"""Reactions at places that a mechanism does not reach, or where friction lets nothing move, as a failure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import MotionError, Status
from centrode.locale import _
from centrode.study.limiting import NOT_REACHED, limits_sentence, not_reached_sentence, repair_of_range
from centrode.study.running import self_locking_sentence

if TYPE_CHECKING:
    from centrode.dynamics.bearings.results import ReactionResults


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
