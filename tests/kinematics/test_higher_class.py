"""Groups of higher class against dyads: one mechanism, driven from links that leave triads and from others."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import centrode as ct
from centrode.structure.plan import structure_of
from mechanisms import EPS, OPERATIONS, events, parts_of, statuses
from redriven import Redriven, answer, by_chain_rule, by_newton, reach_of, redriven
from samples import few

DRIVEN = [
    ("stephenson-six-bar", "FR", -0.13), ("stephenson-six-bar", "FR", -2.14), ("stephenson-six-bar", "PR", -0.42),
    ("watt-six-bar", "PR", 0.55), ("watt-six-bar", "QR", 1.49), ("watt-six-bar", "QR", 2.87),
    ("klann-leg", "leg", -3.13), ("klann-leg", "leg", 2.97), ("klann-leg", "hip", -1.2),
    ("jansen-leg", "CF", 1.52), ("jansen-leg", "FG", 0.93), ("jansen-leg", "EG", 1.23),
]  # fmt: skip
"""Example of class II, the link driven instead, and where: also next to limits (leg at -3.13), dyads behind (CF)."""
LOOKED_AT = few([DRIVEN[k] for k in (0, 3, 6, 9)], DRIVEN)
BESIDE = (1e-13, 1e-10, 1e-6)
"""Distances from a limit [rad]."""


@pytest.fixture(scope="module", params=LOOKED_AT, ids=lambda p: "-".join(map(str, p)))
def case(request: pytest.FixtureRequest) -> Redriven:
    name, link, base = request.param
    return redriven(ct.example(name), link, base)


@pytest.fixture(scope="module")
def ends(case: Redriven) -> list[float]:
    """Limits of the new drive nearest to the ends of the stretch, the lower one first."""
    low, high = reach_of(case)
    limits = np.array(events(ct.motion(case.other, at=[low - 1e-3, high + 1e-3]), "limit"))
    return [float(limits[np.argmin(np.abs(limits - end))]) for end in (low, high)]


@pytest.fixture(scope="module")
def beside(case: Redriven, ends: list[float]) -> xr.Dataset:
    """The motion inside the limits, outside of them, at them, and at four times a distance from the lower one."""
    low, high = ends
    inside = [*(low + x for x in BESIDE), *(high - x for x in BESIDE)]
    outside = [*(low - x for x in BESIDE), *(high + x for x in BESIDE)]
    return ct.motion(case.other, at=[*inside, *outside, low, high, low + 4 * BESIDE[1]])


def test_the_plan_has_a_group_of_higher_class(case: Redriven) -> None:
    assert "higher class" in [group.kind for group in structure_of(case.other).groups]
    assert "higher class" not in [group.kind for group in structure_of(case.by_dyads).groups]


def test_newton_agrees_with_dyads(case: Redriven) -> None:
    """Positions and two derivatives, to what rounding of the dimensions would make of them on either route."""
    low, high = reach_of(case)
    values = np.linspace(low, high, 41)[1:-1]
    data, found = by_newton(case, values)
    assert set(statuses(data)) == {"ok"}
    expected = by_chain_rule(case, values)
    scale = float(np.max(np.abs(expected[0])))
    allowed = 2.0 * OPERATIONS * EPS * answer(case.other, values) * scale
    assert np.all(np.max(np.abs(found - expected), axis=(2, 3)) <= allowed)
    assert float(data.residual.max()) <= 1e-12


def test_limits_are_the_extremes_of_the_motion_by_dyads(case: Redriven, ends: list[float]) -> None:
    """The drive's value at an extreme is exact to rounding: there it answers to the position in second order only."""
    for limit, end in zip(ends, reach_of(case), strict=True):
        assert abs(limit - end) <= 16 * EPS * max(1.0, abs(end)), end


def test_beyond_a_limit_is_open_and_beside_it_ok(beside: xr.Dataset) -> None:
    told = statuses(beside)
    assert told[:6] == ["ok"] * 6
    assert told[6:12] == ["open"] * 6
    assert told[12:14] == ["singular"] * 2
    at_ends = beside.isel(sample=slice(12, 14))
    assert np.isfinite(at_ends.position).all()
    assert np.isnan(at_ends.angular_velocity).all()


def test_next_to_a_limit_positions_follow_its_square_root(beside: xr.Dataset) -> None:
    """A place at a distance x from a limit is some sqrt(x) away from that at the limit: four times x, twice as far."""
    data = beside.isel(sample=[12, 1, 14])
    away = np.abs(data.position - data.position[0]).max(dim=("point", "axis")).to_numpy()
    # the next term is smaller by sqrt(x); rounding of the end itself is seen through the square root
    slack = 100.0 * np.sqrt(4e-10) + np.sqrt(64 * EPS / 1e-10)
    assert away[2] / away[1] == pytest.approx(2.0, rel=slack)


@pytest.mark.parametrize(("name", "link", "base"), few(DRIVEN[:4:3], DRIVEN[:5]))
def test_the_order_of_the_description_does_not_matter(name: str, link: str, base: float) -> None:
    case = redriven(ct.example(name), link, base)
    parts = parts_of(case.other)
    parts["links"] = dict(reversed(parts["links"].items()))
    low, high = reach_of(case)
    values = np.linspace(low, high, 9)[1:-1]
    one, other = ct.motion(case.other, at=values), ct.motion(ct.Mechanism(**parts), at=values)
    allowed = 2.0 * OPERATIONS * EPS * answer(case.other, values)[0] * float(np.abs(one.position).max())
    gap = np.abs(one.position - other.position.sel(point=one.point)).max(dim=("point", "axis"))
    assert np.all(gap.to_numpy() <= allowed)


def test_wedges_that_guides_alone_hold_are_driven_at_their_face() -> None:
    """Along a face that rises by one in two: R is at (0.6, s/sqrt 5), W at (0.6 - 2 s/sqrt 5, 0)."""
    mechanism = ct.parse_mechanism("""
        links.wedge = { points = { W = [0, 0] }, angle = 0 }
        links.ram = { points = { R = [0, 0] }, angle = 0 }
        drives = [{ guide = "face", start = 0.1, speed = 0.05 }]
        guides = [
            { point = "W", on = "frame", through = [0, 0], direction = [1, 0], link = "wedge" },
            { point = "R", on = "frame", through = [0.6, 0], direction = [0, 1], link = "ram" },
            { name = "face", point = "R", on = "wedge", through = [0, 0], direction = [2, 1], link = "ram" },
        ]
        """)
    at = np.linspace(0.1, 0.6, 6)
    motion = ct.motion(mechanism, at=at)
    ram = np.stack([np.full(6, 0.6), at / np.sqrt(5.0)], axis=1)
    wedge = np.stack([0.6 - 2.0 * at / np.sqrt(5.0), np.zeros(6)], axis=1)
    rounding = 16 * np.finfo(float).eps  # of a handful of operations on numbers below one
    assert np.abs(motion.position.sel(point="R").to_numpy() - ram).max() <= rounding
    assert np.abs(motion.position.sel(point="W").to_numpy() - wedge).max() <= rounding
