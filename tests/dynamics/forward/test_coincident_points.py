"""A rope between points that coincide at the start is refused: its distance has no direction there."""

from __future__ import annotations

from typing import Any

import pytest

import centrode as ct

PLANE: dict[str, Any] = {
    "gravity": [0, -9.81],
    "frame": {"points": {"O": [0, 0], "P": [0.4, 0]}},
    "links": {"OA": {"length": 0.4, "angle": 0, "mass": 1, "shape": "rod"}},
}


@pytest.mark.parametrize("kind", [{"restitution": 0.3}, {"stiffness": 100}], ids=["rigid", "compliant"])
def test_a_rope_between_coincident_points_is_refused_by_name(kind: dict[str, float]) -> None:
    mechanism = ct.Mechanism(**PLANE, stops=[{"name": "rope", "points": ["A", "P"], "most": 0.3} | kind])
    with pytest.raises(ct.InputError, match=r"rope: its points coincide at the start"):
        ct.simulate(mechanism, ct.Simulation(duration=0.1))
