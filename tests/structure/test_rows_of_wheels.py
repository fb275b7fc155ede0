"""Jacobian rows of gears, rolling wheels and cylinders against the derivatives of their own residuals, by jets."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.geometry.plane import moved_point, moved_pose
from centrode.kinematics.path import JETS
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Entity, Positions, constraints_of, unknowns_of
from centrode.structure.dimensions import Dimensions, dimensions_of
from centrode.structure.rank import random_realisation

TRACKS: dict[str, dict[str, Any]] = {
    "line": {"through": [0.3, 0.1], "direction": 0.8},
    "outside": {"centre": [0.2, -0.4], "radius": 1.3},
    "inside": {"centre": [0.2, -0.4], "radius": 2.3, "inside": True},
    "ring about a pin": {"centre": [0.2, -0.4], "radius": 0.3, "inside": True},
}


def mechanism(track: dict[str, Any]) -> ct.Mechanism:
    """Every kind of constraint between two moving links that nothing special ties."""
    return ct.Mechanism(
        frame={"points": {"O": [0, 0], "F": [3, 0]}},
        links={
            "OA": {"length": 1.0},
            "wheel": {"points": {"A": [0, 0], "W": [0.7, 0.2]}},
            "body": {"points": {"F": [0, 0], "G": [1, 1]}},
        },
        gears=[{"links": ["OA", "wheel"], "carrier": "body", "ratio": -1.7}],
        rolling=[{"link": "wheel", "centre": "A", "radius": 0.6, "on": "body", "along": track}],
        drives=[{"distance": ["W", "G"], "start": 1.0, "speed": 1.0}],
    )


def realised(description: ct.Mechanism) -> tuple[Dimensions, Positions]:
    """Random positions with angles; the constants of the meshing are no derivatives of anything."""
    numbers = dimensions_of(description)
    fitted, at = random_realisation(description, numbers)
    at.angles |= {link: float(np.arctan2(*at.poses[link].rotor[::-1])) for link in description.links}
    gearing = numbers.gearing.with_phases({"OA-wheel": 0.3, "wheel": -0.2})
    return replace(fitted, gearing=gearing), at


def nudged(at: Positions, entity: Entity, column: int) -> Positions:
    """Positions in which one coordinate of one unknown is the variable of jets."""
    new = at.copy()
    by = [Jet((0.0, 1.0)) if k == column else 0.0 for k in range(entity.unknowns)]
    if entity.kind == "point":
        new.points[entity.name] = moved_point(JETS, at.points[entity.name], by)
        return new
    new.poses[entity.name] = moved_pose(JETS, at.poses[entity.name], by)
    new.angles[entity.name] = by[2] + at.angles[entity.name]
    return new


@pytest.mark.parametrize("track", TRACKS)
def test_rows_are_the_derivatives_of_the_residuals(track: str) -> None:
    description = mechanism(TRACKS[track])
    numbers, at = realised(description)
    checked = set()
    for constraint in constraints_of(description):
        (row, *_rest) = constraint.rows(numbers, at)
        for entity in unknowns_of(description):
            expected = row.get(entity, (0.0,) * entity.unknowns)
            for column in range(entity.unknowns):
                residual = constraint.residual(JETS, numbers, nudged(at, entity, column))[0]
                slope = residual.derivative(1) if isinstance(residual, Jet) else 0.0
                assert slope == pytest.approx(expected[column], rel=1e-12, abs=1e-13), (
                    constraint,
                    entity,
                    column,
                )
                checked.add((type(constraint).__name__, entity.kind))
    assert {
        ("GearRatio", "link"),
        ("NoSlip", "point"),
        ("TrackContact", "link"),
        ("DistanceDrive", "point"),
    } <= checked
