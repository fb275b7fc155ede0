"""Two guides that become parallel send their point to infinity: a limit, and no change point of the links behind it."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from mechanisms import EPS

PIVOT = (1.0, -2.0)


def crossing_guides(length: float) -> ct.Mechanism:
    """A guide that turns about O crosses the line y = 1 at P = (cot t, 1); two equal links follow P."""
    line = {"through": "O", "direction": [1, 0]}
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": PIVOT}},
        links={"OA": {"length": 1.0}, "PQ": {"length": length}, "QD": {"length": length}},
        guides=[
            {"point": "P", "on": "OA", **line},
            {"point": "P", "name": "fixed", "on": "frame", "through": [0.0, 1.0], "direction": [1, 0]},
        ],
        drives=[{"link": "OA", "start": np.pi / 2, "speed": 1.0}],
        assembly={"sides": {"Q": "left"}},
    )


@pytest.mark.parametrize("length", [3.0, 20.0, 100.0])
def test_only_limits_where_guides_become_parallel(length: float) -> None:
    motion = ct.motion(crossing_guides(length), samples=5, start=0.5 * np.pi, stop=1.25 * np.pi)
    assert set(motion.event_kind.values.tolist()) == {0}  # limits
    # |PD| = 2 l: cot t = 1 -+ sqrt(4 l^2 - 9); between the two P runs through infinity, at t = pi
    half = np.sqrt(4.0 * length**2 - (1.0 - PIVOT[1]) ** 2)
    exact = np.array([np.arctan2(1.0, 1.0 - half), np.pi, np.pi + np.arctan2(1.0, 1.0 + half)])
    found = np.unique(motion.event_value.values)
    assert found == pytest.approx(exact, abs=64 * EPS)
