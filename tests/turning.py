"""What holds of every answer about rotatability."""

from __future__ import annotations

import numpy as np

import centrode as ct


def assert_swings(found: ct.Rotatability) -> None:
    """Extremes of swings are numbers, and strokes are not negative."""
    for turning in found.drives:
        for swing in turning.swings:
            values = [extreme.value for extreme in swing.extremes]
            assert swing.stroke is None or swing.stroke >= 0.0
            assert np.isfinite(values).all()
