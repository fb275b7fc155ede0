"""Where the limits of a mechanism's only drive lie, in a sentence."""

from __future__ import annotations

from centrode.kinematics.several_drives.reach import limits
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.study.wording import value_text


def limits_sentence(mechanism: Mechanism) -> str:
    """Where the limits of the only drive lie, and which groups lock there; empty where there are none to tell."""
    if len(mechanism.drives) != 1:
        return ""
    found = limits(mechanism)
    told = _("limit at {value}, where {group} is a dead point")
    ends = [end for end in (found.low, found.high) if end is not None]
    return "; ".join(
        told.format(value=value_text(end.value, found.unit, mechanism.display), group=end.group)
        for end in ends
    )
