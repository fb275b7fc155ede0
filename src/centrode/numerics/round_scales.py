"""Round scales of drawings: the finest of a series of round numbers at which something goes into its room."""

from __future__ import annotations

import math
from collections.abc import Sequence

SCALES = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
"""Scales that a person takes, times a power of ten."""
FORCE_SCALES = (1.0, 2.0, 2.5, 5.0, 10.0)
"""Scales of forces."""
HAIR = 1e-9
"""Of a scale: one that is too fine by less is taken, so that an extent of a round scale is not sent to the next."""


def round_scale(extent: float, room: float = 1.0, series: Sequence[float] = SCALES) -> float:
    """The finest round scale at which an extent goes into a room; 1 where there is no extent.

    Parameters
    ----------
    extent : float
        In any unit.
    room : float
        On paper; the scale is in units of the extent to one of the room.
    series : sequence of float
        Numbers from 1 to 10 that are taken, times a power of ten.
    """
    if not extent > 0.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(extent / room))
    return next(float(f"{step * power:.3g}") for step in series if step * power >= (1 - HAIR) * extent / room)
