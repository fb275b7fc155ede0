"""Positions in closed form, letter by letter, against the motion, which knows nothing of auxiliary vectors and angles."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import assume, given, settings

import centrode as ct
from centrode.equations.derivation import Equations
from centrode.equations.instants import instant_of, position_values
from centrode.errors import Status
from growing import descriptions, mechanism_of
from mechanisms import EPS, Parts, parts_of
from samples import few
from worked_out import planar_examples

WORTH = 1e6
"""Positions whose condition is worse prove nothing about formulas and are passed over."""
OPERATIONS = 64
"""Roundings in the lines of one group."""
MENDED = 1e-10
"""Error of places about change points, where motions are interpolated."""


def compared(found: Equations, motion: xr.Dataset) -> int:
    """Compare all places and angles at all samples; the number of samples that were worth it."""
    functions, scale = found.position_functions, float(found.board.numbers.scale)
    count = 0
    for sample in np.flatnonzero(motion.status.to_numpy() == Status.OK).tolist():
        instant = instant_of(found, motion, sample)
        condition = max((one.condition for one in instant.velocities), default=1.0)
        if not condition < WORTH:
            continue
        count += 1
        values = position_values(found, motion, sample)
        turns = max(1.0, *(abs(x) for x in instant.values.values() if np.isfinite(x)))
        allowed = OPERATIONS * EPS * condition * len(functions.groups) * max(1.0, scale) * turns
        allowed += MENDED if motion.event_kind.size else 0.0
        for point, place in functions.places.items():
            at = motion.position.sel(point=point).to_numpy()[sample]
            own = [total.value(np, values.__getitem__) for total in place]
            assert np.abs(np.array(own) - at).max() <= allowed, (point, sample, allowed)
        for letter in found.board.alphabet.rates:
            away = values[letter] - instant.values[letter]
            away -= math.tau * round(away / math.tau) if found.board.alphabet.meanings[letter].unit == "rad" else 0.0
            assert abs(away) <= allowed * (1.0 if scale > 1.0 else 1.0 / scale), (letter, sample, away)
    return count


def sampled(mechanism: ct.Mechanism, samples: int = 13) -> tuple[Equations, xr.Dataset]:
    return ct.equations(mechanism), ct.motion(mechanism, samples)


@pytest.mark.parametrize("name", planar_examples())
def test_positions_of_examples(name: str) -> None:
    found, motion = sampled(ct.example(name))
    assert compared(found, motion)
    # every moving point has its coordinates, and only groups of higher class have none in closed form
    assert set(found.position_functions.places) == set(found.board.moving)
    assert all(one.kind == "higher class" for one in found.position_functions.groups if one.unsolved)


@settings(max_examples=few(6, 40), deadline=None)
@given(descriptions())
def test_positions_of_random_mechanisms(parts: dict[str, Any]) -> None:
    mechanism = mechanism_of(parts)
    found, motion = sampled(mechanism, 7)
    assume(compared(found, motion))
    assert not found.position_functions.unsolved
