"""A group that locks just before a group in front of it does: links run ever faster there, and no node follows."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from mechanisms import EPS

CRANK, ROD, HEIGHT, REACH = 0.5, 1.0, 1.2, 1.6
DEAD = np.pi - np.arcsin((HEIGHT - ROD) / CRANK)
"""Where the rod AC is perpendicular to its guide: C's speed is infinite there."""


def slider_at(turn: float) -> float:
    """Where C stands on its guide, by the triangle of the rod."""
    away = HEIGHT - CRANK * np.sin(turn)
    return float(CRANK * np.cos(turn) + np.sqrt(ROD**2 - away**2))


def stretched_at(turn: float) -> ct.Mechanism:
    """Two links of 0.8 m follow the slider C; they are stretched out when the crank is at an angle."""
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [slider_at(turn) + REACH, HEIGHT]}},
        links={"OA": {"length": CRANK}, "AC": {"length": ROD}, "CB": {"length": 0.8}, "BD": {"length": 0.8}},
        guides=[{"point": "C", "on": "frame", "through": [0.0, HEIGHT], "direction": [1, 0]}],
        drives=[{"link": "OA", "start": np.pi / 2, "speed": 1.0}],
        assembly={"sides": {"C": "ahead", "B": "left"}},
    )


@pytest.mark.parametrize("gap", [3e-3, 3e-4, 3e-5, 3e-6])
def test_the_nearer_of_two_limits_in_one_cell_of_the_mesh(gap: float) -> None:
    turn = DEAD - gap
    mechanism = stretched_at(turn)
    # the place of C is rounded; it runs as 1/sqrt(gap), so the drive's value feels it less and less
    bound = 64 * EPS * (1.0 + HEIGHT + REACH)
    found = ct.limits(mechanism).high
    assert found is not None
    assert found.group == "group CB-BD (point B)"
    assert abs(found.value - turn) <= bound
    told = ct.rotatability(mechanism)
    assert not told.turns_fully
    events = ct.motion(mechanism, samples=9)
    assert abs(events.event_value.to_numpy() - turn).min() <= bound
    assert abs(events.event_value.to_numpy() - DEAD).min() <= bound / np.sqrt(gap)
