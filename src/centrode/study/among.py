"""What a drawing of one instant is made from: the motion with that instant among its samples, the points named."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from centrode.errors import InputError
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, value_text

ALL = "all"


def motion_among(mechanism: Mechanism, course: xr.Dataset, place: float) -> tuple[xr.Dataset, int]:
    """The samples of a motion with an instant among them, and the number of that sample.

    `place` is a value of the drive [rad or m], or a time [s] where the drive is a law of time or there are several.
    """
    places = np.unique(np.append(mechanism.motion_parameter.instants(course), place))
    return motion(mechanism, at=places), int(np.searchsorted(places, place))


def moving_points(mechanism: Mechanism, names: Sequence[str], where: str) -> tuple[str, ...]:
    """Points by their names, or every moving point for "all"; InputError, told of `where`, for another name."""
    if ALL in names:
        return mechanism.moving_points
    for name in names:
        if name not in mechanism.moving_points:
            what = _("there is no moving point {name}").format(name=value_text(name))
            raise InputError(where, what, nearest(name, mechanism.moving_points))
    return tuple(names)
