"""Where the limits of a mechanism's only drive lie, in a sentence."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from centrode.errors import MotionError, Status
from centrode.kinematics.several_inputs.limits import limits
from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism
from centrode.study.texts import value_text

if TYPE_CHECKING:
    import xarray as xr

NOT_REACHED = (Status.OPEN, Status.CUT_OFF, Status.UNCONVERGED)


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


class Sampled(Protocol):
    """A result over the samples of a motion."""

    @property
    def mechanism(self) -> Mechanism:
        """Of which mechanism."""

    @property
    def status(self) -> xr.DataArray:
        """(sample) what each sample is worth."""


def check_reached(result: Sampled) -> None:
    """Raise MotionError where samples are not reached, with the limits that bound the motion."""
    missing = int(np.isin(result.status.to_numpy(), NOT_REACHED).sum())
    if missing:
        what = not_reached_sentence(missing, result.status.size)
        where = limits_sentence(result.mechanism)
        raise MotionError("", f"{what} ({where})" if where else what, repair_of_range(result.mechanism))


def not_reached_sentence(missing: int, samples: int) -> str:
    """How many samples the mechanism does not reach."""
    return ngettext(
        "the mechanism locks: {missing} of {all} samples is not reached",
        "the mechanism locks: {missing} of {all} samples are not reached",
        missing,
    ).format(missing=missing, all=samples)


def repair_of_range(mechanism: Mechanism) -> str:
    """What to ask for where samples are not reached: between the limits, by a word where one drive has them."""
    if not mechanism.motion_parameter.is_uniform:
        return _("ask for a range between the limits, or change the dimensions")
    return _(
        'ask for the range between the limits (range = "reachable" under [study], or --range reachable), or '
        "change the dimensions"
    )
