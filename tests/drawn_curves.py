"""Curves of figures are drawn through more places than samples: what they show at the samples."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from numpy.typing import NDArray


def at_samples(values: Any, samples: int) -> NDArray[np.float64]:
    """Every so manieth of the coordinates of a line, which was drawn from so many samples without a gap."""
    drawn = np.asarray(values, dtype=float)
    steps, rest = divmod(len(drawn) - 1, samples - 1)
    assert rest == 0
    return drawn[::steps]


def heights_at(line: Line2D, across: Any) -> NDArray[np.float64]:
    """What a line shows at its samples, whose abscissas are known; it has each of them once."""
    drawn = np.asarray(line.get_xdata(), dtype=float)
    found = [np.flatnonzero(drawn == place) for place in np.asarray(across, dtype=float)]
    assert {len(one) for one in found} == {1}
    return np.asarray(line.get_ydata(), dtype=float)[np.concatenate(found)]
