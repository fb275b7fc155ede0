"""Counterweights that are discs, which balance moments too."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import centrode as ct
from balanced import SPEED, four_bar, rest_of
from centrode.kinematics.preparation import ready
from mechanisms import rounding, solve_evenly
from samples import few


@settings(max_examples=few(3, 8))
@given(st.integers(0, 10_000), st.floats(0.3, 1.0))
def test_discs_balance_the_moment_of_an_in_line_four_bar(seed: int, pendulum: float) -> None:
    """Berkof 1973: the coupler a physical pendulum, discs of the side links with its shares."""
    mechanism = four_bar(seed, in_line=True, pendulum=pendulum)
    found = ct.balance(mechanism, moment=True)
    discs = {disc.link: disc for disc in found.discs}
    coupler = mechanism.links["AB"]
    assert isinstance(coupler.centre, tuple) and coupler.mass and coupler.inertia
    length, r = coupler.coordinates["B"][0], coupler.centre[0]
    missing = coupler.mass * r * (length - r) - coupler.inertia
    exact = {"AB": missing}
    for link, base, end, share in (("OA", "O", "A", 1 - r / length), ("DB", "D", "B", r / length)):
        heavy = ct.balance(mechanism).balanced.links[link]
        assert isinstance(heavy.centre, tuple) and heavy.mass and heavy.inertia
        arm = heavy.coordinates[end][0]
        exact[link] = (
            heavy.inertia + heavy.mass * abs(complex(*heavy.centre)) ** 2 + share * coupler.mass * arm**2
        )
        assert discs[link].base == base
    whole = sum(exact.values())
    for link, inertia in exact.items():
        got = discs[link].inertia if link in discs else 0.0
        assert abs(got - inertia) <= 1e-8 * whole
    rest = rest_of(found.balanced)
    rate = SPEED**2 * float(np.max(rounding(solve_evenly(ready(mechanism), 37))[2])) * whole
    assert found.after.attrs["greatest_shaking_force"] <= rest
    assert found.after.attrs["greatest_shaking_moment"] <= 100 * (rate + 10 * rest)
    assert found.before.attrs["greatest_shaking_moment"] > 1e3 * (rate + rest)


@pytest.mark.parametrize("weighs", [True, False])
def test_a_disc_on_a_coupler_whose_inertia_a_shape_tells(weighs: bool) -> None:
    """A rod has m l^2/12, and a coupler needs m l^2/4: the disc on it adds m l^2/6. One without mass needs none."""
    coupler = {"mass": 1.4, "shape": "rod"} if weighs else {}
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [0.4, 0.0]}},
        links={
            "OA": {"length": 0.1, "mass": 0.9, "shape": "rod"},
            "AB": {"length": 0.4, **coupler},
            "DB": {"length": 0.3, "mass": 1.1, "shape": "rod"},
        },
        drives=[{"link": "OA", "start": 1.0, "speed": SPEED}],
        assembly={"sides": {"B": "left"}},
    )
    found = ct.balance(mechanism, moment=True)
    discs = {disc.link: disc.inertia for disc in found.discs if disc.base is None}
    assert discs == ({"AB": pytest.approx(1.4 * 0.4**2 / 6, rel=1e-8)} if weighs else {})
    assert found.balanced.links["AB"].shape is None or not discs
    # as much of the moment as the discs are apart from what they should be
    before, after = (data.attrs["greatest_shaking_moment"] for data in (found.before, found.after))
    assert after <= 1e-8 * before


def test_discs_that_are_not_to_be_had() -> None:
    with pytest.raises(ct.MotionError, match="discs cannot balance"):
        ct.balance(four_bar(1), moment=True)
    with pytest.raises(ct.MotionError, match=r"the moment of inertia of AB is .* too large"):
        ct.balance(four_bar(1, in_line=True, pendulum=1.5), moment=True)
    with pytest.raises(ct.InputError, match="only if the shaking force is balanced fully"):
        ct.balance(four_bar(1), to="least", moment=True)


def test_discs_as_counterweights() -> None:
    engine = ct.example("single-cylinder-engine")
    touching = ct.balance(engine, on=["crank"], to="least", thickness="20 mm")
    (one,) = touching.counterweights
    assert one.disc is not None
    assert math.isclose(one.disc, one.radius, rel_tol=1e-12)
    assert math.isclose(one.mass, 7800 * 0.02 * math.pi * one.disc**2, rel_tol=1e-12)
    assert math.isclose(one.inertia, one.mass * one.disc**2 / 2, rel_tol=1e-12)
    least = one.inertia + one.mass * one.radius**2
    for factor in (0.7, 0.9, 1.1, 1.5):
        radius = {"crank": factor * one.radius}
        beside = ct.balance(engine, on=["crank"], to="least", thickness="20 mm", radius=radius)
        (other,) = beside.counterweights
        # the same product, to what is left of the search
        assert math.isclose(other.product, one.product, rel_tol=1e-3)
        scaled = (one.product / other.product) ** 2 * (other.inertia + other.mass * other.radius**2)
        assert scaled > least
    # half an inch of lead is not half an inch of steel
    lead = ct.balance(engine, on=["crank"], to="least", thickness="20 mm", density="11.3 g/cm^3")
    assert lead.counterweights[0].disc is not None and lead.counterweights[0].disc < one.disc
