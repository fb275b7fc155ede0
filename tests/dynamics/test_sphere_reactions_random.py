"""Reactions of random spherical mechanisms: Euler's equations of every link, every pin, the frame, virtual work."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import centrode as ct
from centrode.dynamics.kinetostatics.equations import Scheme
from centrode.kinematics.preparation import ready
from growing_sphere import Growing, grown
from mechanisms import EPS
from samples import few
from spatial_balance import FRAME, Balance, loaded, rounding
from spherical_bodies import dot, place

Array = npt.NDArray[np.float64]
WIDTH, SAMPLES, SPEED, RADIUS = 0.3, 7, -1.7, 0.8
ONE_DRIVE = ("RRR", "RRP", "RPR", "PRP", "rigid point")


def check(growing: Growing, mechanism: ct.Mechanism, balance: Balance, found: xr.Dataset) -> int:
    """Everything that holds of reactions with their motion; how many samples had them."""
    good = found.reaction_status.to_numpy() == ct.Status.OK
    if not good.any() or found.attrs["undetermined"]:
        return 0
    balance.loads(set(found.side_point.to_numpy().tolist()))
    balance.inertia()
    outer = [balance.missing(body) for body in balance.acting]
    balance.reactions(found)
    limit = rounding(growing, balance.motion) * balance.size()
    frame = balance.missing(FRAME)
    for body in balance.acting:
        force, moment = balance.missing(body)
        if body != FRAME:
            assert (np.abs(force).max(axis=1) <= limit)[good].all(), body
            # forces on a pin meet in one place
            assert (np.abs(moment).max(axis=1) <= limit)[good].all(), body
    for name, own, all_outer in zip(
        ("force", "moment"), frame, map(sum, zip(*outer, strict=True)), strict=True
    ):
        given = found[f"frame_{name}"].to_numpy()
        assert (np.abs(given - own).max(axis=1) <= limit)[good].all()
        # by the law of momentum
        assert (np.abs(given - all_outer).max(axis=1) <= limit)[good].all()
    hinges_bear_no_moment_about_their_axes(found, balance, good, limit)
    return int(good.sum())


def hinges_bear_no_moment_about_their_axes(
    found: xr.Dataset, balance: Balance, good: Array, limit: Array
) -> None:
    """Nor do they press along them, but where the frame takes a load on its point, or an only link that on its tip."""
    hinges, bodies = found.side_point.to_numpy().tolist(), found.side_link.to_numpy().tolist()
    links, moving = balance.mechanism.links.values(), balance.mechanism.moving_points
    tips = [p for p in hinges if p in moving and sum(p in link.coordinates for link in links) == 1]
    for k, point in enumerate(hinges):
        axis = place(balance.motion, point)
        moment, force = found.joint_moment[:, k].to_numpy(), found.joint_force[:, k].to_numpy()
        assert (abs(dot(moment, axis)) <= limit)[good].all()
        assert (np.abs(np.cross(RADIUS * axis, force) - moment).max(axis=1) <= limit)[good].all()
        if point not in tips and bodies[k] != FRAME:
            assert (abs(dot(force, axis)) <= limit)[good].all()


@pytest.mark.parametrize("seed", range(few(12, 30)))
def test_one_drive(seed: int) -> None:
    kinds = np.random.default_rng(seed).choice(ONE_DRIVE, 1 + seed % 4).tolist()
    growing = grown(kinds, seed)
    parts, clouds = loaded(growing, seed, RADIUS)
    parts["drives"][0]["speed"] = SPEED
    mechanism = ct.Mechanism(**parts)
    initial = ready(mechanism).kinematics.path.initial
    ends: dict[str, Any] = {"samples": SAMPLES, "start": initial - WIDTH, "stop": initial + WIDTH}
    found = ct.reactions(mechanism, **ends)
    balance = Balance(mechanism, ct.motion(mechanism, **ends), clouds)
    assert check(growing, mechanism, balance, found) > 0
    reduced = ct.reduce(mechanism, **ends)
    wanted = reduced.reduced_inertia_slope * SPEED**2 / 2 - reduced.reduced_moment
    good = found.reaction_status.to_numpy() == ct.Status.OK
    size = Scheme.of(ready(mechanism).structure).size
    condition = np.sqrt(found.reaction_loss.to_numpy() / (size * EPS))
    apart = abs(found.balancing.to_numpy()[:, 0] - wanted.to_numpy())
    assert (apart <= 256 * size * EPS * condition * balance.size())[good].all()
    worst = float(np.max(condition[good]))
    for name in ("equilibrium_residual", "frame_residual", "power_residual"):
        assert found.attrs[name] <= 256 * size * worst * EPS


@pytest.mark.parametrize("seed", range(6))
def test_two_drives(seed: int) -> None:
    """A second drive turns a link against another: its moment works between the two."""
    growing = grown(["turned link", "RRR"], seed)
    parts, clouds = loaded(growing, seed, RADIUS)
    del parts["drives"][0]["speed"]
    parts["drives"][0]["law"], parts["drives"][1]["speed"] = "0.3*sin(2*t)", 0.4
    mechanism = ct.Mechanism(**parts)
    times = np.linspace(0.0, 0.4, 5)
    found = ct.reactions(mechanism, at=times)
    assert check(growing, mechanism, Balance(mechanism, ct.motion(mechanism, at=times), clouds), found) > 0
