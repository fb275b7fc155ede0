"""Equations on the sphere: as the source writes them, and against motion, which knows nothing of arcs and closures."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings

import centrode as ct
from centrode.equations.derivation import Equations
from growing_sphere import Growing, Vector, mechanisms
from mechanisms import EPS
from worked_out import Values, initial_values, value_of

WORTH = 1e5
"""Positions whose condition is worse prove nothing about formulas."""
OPERATIONS = 4096
"""Roundings in the places of four groups on each other, their derivatives and right sides, of errors that add up."""


def mechanism_of(growing: Growing) -> ct.Mechanism:
    return ct.Mechanism.model_validate(growing.parts())


def places(motion: Any, sample: int) -> dict[str, Vector]:
    return {str(name): motion.position.sel(point=name)[sample].to_numpy() for name in motion.point.values}


def spin(motion: Any, link: str, sample: int) -> Vector:
    if link == "frame":
        return np.zeros(3)
    return np.asarray(motion.angular_velocity.sel(link=link)[sample].to_numpy())


def own_axes(found: Equations, at: dict[str, Vector]) -> Vector:
    """The axes in which the formulas are written, as rows."""
    first, second = (at[name] for name in found.board.firsts["frame"])
    upright = np.cross(first, second)
    upright /= np.linalg.norm(upright)
    return np.stack([first, np.cross(upright, first), upright])


def conditioned(found: Equations, values: Values) -> float:
    """What its slope, of terms of the size of one, makes of the rounding of a closure."""
    slopes = [group.velocities.system.matrix[0][0] for group in found.groups]
    sizes = [abs(float(one.value(math, values.__getitem__))) for one in slopes]
    return 1.0 / min(sizes, default=1.0) if min(sizes, default=1.0) else math.inf


def check(mechanism: ct.Mechanism, *, passed: bool = False) -> bool:
    """Places, velocities and rates of angles by the formulas in the initial position against motion."""
    found = ct.equations(mechanism)
    values = initial_values(found)
    worth = conditioned(found, values)
    if not worth < WORTH:
        return passed
    motion = ct.motion(
        mechanism, at=[0.0] if len(mechanism.drives) > 1 else [float(mechanism.drives[0].start or 0.0)]
    )
    at = places(motion, 0)
    axes = own_axes(found, at)
    speed = 1.0 + max((abs(values[one.rate]) for one in found.unknowns), default=0.0)
    allowed = OPERATIONS * EPS * worth * len(found.groups or (1,)) * speed
    for point in found.board.moving:
        velocity = found.velocity(point)
        formulas = [velocity.x, velocity.y, velocity.z]
        place = [one.value(math, values.__getitem__) for one in velocity.place]
        assert np.abs(np.array(place) - axes @ at[point]).max() <= allowed
        rates = [value_of(one, values) for one in formulas if one is not None]
        known = axes @ motion.velocity.sel(point=point)[0].to_numpy()
        assert np.abs(np.array(rates) - known).max() <= allowed
    for one in found.unknowns:
        kind, _dot, link = one.name.partition(".")
        if kind != "angle":
            continue
        pivot = next(x.names[1] for x in found.legend if x.symbol == one.letter.name)
        base = found.board.body_of(pivot)
        turning = float((spin(motion, link, 0) - spin(motion, base, 0)) @ at[pivot])
        assert abs(turning - values[one.rate]) <= allowed
    return True


@pytest.mark.parametrize("name", ct.example_names())
def test_examples_agree_with_motion(name: str) -> None:
    mechanism = ct.example(name)
    if mechanism.space != "sphere":
        pytest.skip("it is in the plane")
    try:
        assert check(mechanism)
    except ct.InputError as refused:
        assert "driven links and dyads" in refused.what


@settings(max_examples=25, deadline=None)
@given(mechanisms(("RRR", "RRP", "rigid point", "turned link")))
def test_random_mechanisms_agree_with_motion(growing: Growing) -> None:
    mechanism = mechanism_of(growing)
    try:
        check(mechanism, passed=True)
    except ct.InputError as refused:
        assert "too many terms" in refused.what
