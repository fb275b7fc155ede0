"""Angles of the carrier at which a cam is looked at."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.locale import _
from centrode.model import limits
from centrode.model.cams.files import AnyCam
from centrode.model.cams.plate import PlateCam

Array = npt.NDArray[np.float64]

DEFAULT_SAMPLES = 361


def ends_of(cam: AnyCam) -> tuple[float, float]:
    """First and last angle [rad] that a cam asks for: of a symmetric one on both sides, of a follower's a turn."""
    if isinstance(cam, PlateCam):
        return 0.0, math.tau
    low, high = cam.range.start, cam.range.stop
    return (-high, high) if cam.curvature.symmetric else (low, high)


def angles_of(cam: AnyCam, samples: int | None = None, at: npt.ArrayLike | None = None) -> Array:
    """Angles [rad]: those given, else evenly spaced ones, both ends included.

    Raises
    ------
    InputError
        A number of samples out of bounds, or angles that are not finite numbers in one dimension.
    """
    if at is None:
        asked = samples if samples is not None else cam.study.samples
        count = DEFAULT_SAMPLES if asked is None else asked
        if isinstance(count, bool) or not 2 <= count <= limits.SAMPLES:
            what = _("{samples} samples were asked for").format(samples=count)
            raise InputError(_("samples"), what, _("ask for 2 to {most}").format(most=limits.SAMPLES))
        return np.linspace(*ends_of(cam), count)
    places = np.asarray(at, dtype=np.float64)
    if places.ndim != 1 or not 1 <= len(places) <= limits.SAMPLES or not np.isfinite(places).all():
        raise InputError("at", _("it needs finite angles of the carrier, one or more, in one dimension"))
    return places
