"""Forces by hand against those from the one list of constraints: two routes that share nothing but the motion."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import centrode as ct
from burdened import burdened
from centrode.dynamics.force_polygons.polygons import ForcePolygons
from centrode.dynamics.force_polygons.statics import FreeBodies
from centrode.kinematics.preparation import ready
from growing import KINDS, grown, mechanism_of
from mechanisms import EPS
from samples import few

pytest.importorskip("centrode.dynamics.kinetostatics")
OPERATIONS = 64


def by_pins(found: ForcePolygons) -> dict[str, complex]:
    """Force of the pin on a body ("A/AB"), where the pin belongs to another and nothing else acts there on it.

    A guide's force and that of a wheel's contact act on the link here, on the pin in the list of constraints.
    """
    mechanism = found.mechanism
    bodies = FreeBodies.of(ready(mechanism).structure)
    held = {(guide.point, guide.link) for guide in mechanism.guides}
    held |= {(wheel.centre, wheel.link) for wheel in mechanism.rolling}
    forces = {}
    for point, (host, *others) in bodies.at_point.items():
        for body in others:
            name = f"R{bodies.pair(host, body)}"
            name = name if name in found.reactions else f"{name}({point})"
            if body in mechanism.links and (point, body) not in held:
                forces[f"{point}/{body}"] = found.reactions[name]
    return forces


def along_guides(found: ForcePolygons) -> dict[str, tuple[complex, float]]:
    """Force and moment of each guide on what slides on it."""
    mechanism = found.mechanism
    bodies = FreeBodies.of(ready(mechanism).structure)
    forces = {}
    for guide in mechanism.guides:
        name = f"R{bodies.pair(guide.on, bodies.carrier(guide))}"
        name = name if name in found.reactions else f"{name}({guide.id})"
        forces[guide.id] = found.reactions[name], found.moments[f"M{name.removeprefix('R')}"]
    return forces


def conditioning(found: ForcePolygons) -> float:
    """By how much the reactions answer to the outer forces: how many digits the least sine takes."""
    outer = sum(abs(one.force) for one in found.outer) + sum(abs(one.moment) for one in found.outer)
    return max(1.0, sum(map(abs, found.reactions.values())) / outer)


@settings(max_examples=few(20, 60))
@given(st.lists(st.sampled_from(KINDS), min_size=1, max_size=4), st.integers(0, 2**32 - 1))
def test_both_routes_give_the_same_forces(kinds: list[str], seed: int) -> None:
    mechanism = mechanism_of(burdened(grown(kinds, seed), seed))
    at = ready(mechanism).kinematics.path.initial + 0.01
    try:
        found = ct.force_polygons(mechanism, at)
    except ct.MotionError:
        assume(False)  # it is open there, or at a dead point
    listed: Any = ct.reactions(mechanism, at=[at])
    assert bool(listed.determined.all())
    size = sum(map(abs, found.reactions.values())) + sum(map(abs, found.moments.values()))
    reach = max(abs(a - b) for a in found.places.values() for b in found.places.values())
    allowed = OPERATIONS * EPS * conditioning(found) * size * max(1.0, reach)
    for side, force in by_pins(found).items():
        assert abs(complex(*listed.joint_force.sel(side=side).values[0]) - force) <= allowed
    for guide, (force, moment) in along_guides(found).items():
        assert abs(complex(*listed.guide_force.sel(guide=guide).values[0]) - force) <= allowed
        assert abs(float(listed.guide_moment.sel(guide=guide)[0]) - moment) <= allowed
    assert abs(float(listed.balancing[0, 0]) - found.balancing["link0"]) <= allowed
    assert np.isfinite(allowed)
