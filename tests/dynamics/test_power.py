"""Virtual power is power, and reduced inertia twice the kinetic energy, of random mechanisms with random loads."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import centrode as ct
from burdened import burdened, kinetic_energy, powers
from centrode.kinematics.preparation import ready
from growing import KINDS, descriptions, grown, mechanism_of
from growing_higher import HIGHER, grown_higher
from mechanisms import EPS
from samples import few

WIDTH = 0.3
OPERATIONS = 256
"""Roundings that one product of forces and velocities makes at most, with those of the sines of turned directions."""
SEEDS = st.integers(0, 2**32 - 1)


def agree(parts: dict[str, Any], seed: int, speed: float = -1.7) -> int:
    """Compare with the motion; returns how many samples had derivatives."""
    parts = burdened(parts, seed)
    parts["drives"][0]["speed"] = speed
    mechanism = mechanism_of(parts)
    initial = ready(mechanism).kinematics.path.initial
    ends = {"samples": 7, "start": initial - WIDTH, "stop": initial + WIDTH}
    data, reduced = ct.motion(mechanism, **ends), ct.reduce(mechanism, **ends)
    assert np.array_equal(data.status, reduced.status)
    assert np.array_equal(data.time, reduced.time)
    here = np.isfinite(data.angular_velocity.to_numpy()).all(axis=1)
    assert np.array_equal(here, np.isfinite(reduced.reduced_inertia))
    # velocities that rounding alone makes of a stretched position are rounding of the greatest velocity
    fast = float(abs(data.velocity).max()) + float(abs(data.angular_velocity).max()) * scale_of(data)
    for name, energy in kinetic_energy(mechanism, data).items():
        part = 0.5 * speed**2 * reduced.reduced_inertia_part.sel(link=name).to_numpy()
        body = mechanism.links[name]
        size = (body.mass or 0.0) * fast**2 + (body.inertia or 0.0) * float(
            abs(data.angular_velocity.sel(link=name)).max()
        ) ** 2
        assert np.nanmax(abs(part - energy), initial=0.0) <= OPERATIONS * EPS * size
    given = powers(mechanism, data)
    assert len(given) == reduced.sizes["load"]
    for k, power in enumerate(given):
        part = speed * reduced.reduced_moment_part.isel(load=k).to_numpy()
        force = np.nanmax(abs(part), initial=0.0) + strongest(data) * fast
        assert np.nanmax(abs(part - power), initial=0.0) <= OPERATIONS * EPS * force, reduced["load"][k]
    total = reduced.reduced_moment_part.sum("load", skipna=False)
    assert np.nanmax(abs(total - reduced.reduced_moment), initial=0.0) <= OPERATIONS * EPS * float(
        abs(reduced.reduced_moment_part).sum("load").max()
    )
    return int(here.sum())


def scale_of(data: Any) -> float:
    """Greatest coordinate, or reach of a centre of mass from its link's first point."""
    return float(abs(data.position).max()) + 3.0


def strongest(data: Any) -> float:
    """A bound of the forces and moments of the loads, those of dampers and springs included."""
    fast = float(abs(data.velocity).max()) + float(abs(data.angular_velocity).max()) + 1.0
    return 50.0 * (scale_of(data) + float(abs(data.angle).max())) + 10.0 * fast**2


@settings(max_examples=few(6, 30))
@given(descriptions(), SEEDS)
def test_random_mechanisms(parts: dict[str, Any], seed: int) -> None:
    assume(agree(parts, seed))


@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_of_group(kind: str) -> None:
    assert sum(agree(grown([kind], seed), seed) for seed in range(3))


@pytest.mark.parametrize("kind", HIGHER)
def test_each_kind_of_higher_group(kind: str) -> None:
    assert agree(grown_higher([kind], 5), 5)
