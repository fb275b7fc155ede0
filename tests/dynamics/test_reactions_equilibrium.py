"""Reactions of random mechanisms: equilibrium of every body, sums of the frame, virtual work, gradients."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import centrode as ct
from burdened import burdened
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.state import DriveMotion, State
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import requested_grid, solve
from growing import KINDS, descriptions, grown, mechanism_of
from growing_higher import HIGHER, grown_higher
from kinetostatics import motion_and_reactions, number_of_equations, structure
from mechanisms import EPS, parts_of
from newton_euler import FRAME, Balance, dot, vector
from samples import examples_at_hand, few

Array = npt.NDArray[np.float64]
WIDTH = 0.3
OPERATIONS = 256
"""Roundings in one sum of forces, with those of the sines of turned directions and of accelerations."""
SEEDS = st.integers(0, 2**32 - 1)


def asked(
    parts: dict[str, Any], seed: int, speed: float = -1.7
) -> tuple[ct.Mechanism, xr.Dataset, xr.Dataset]:
    """A burdened mechanism with its motion and its reactions near the initial position."""
    parts = burdened(parts, seed)
    parts["drives"][0]["speed"] = speed
    mechanism = mechanism_of(parts)
    return mechanism, *motion_and_reactions(mechanism, 7, WIDTH)


def bound(mechanism: ct.Mechanism, balance: Balance) -> Array:
    """What rounding may leave of a sum of forces: of each summand, and of accelerations."""
    return OPERATIONS * size_of(mechanism) * EPS * balance.greatest()


def size_of(mechanism: ct.Mechanism) -> int:
    """Number of equations."""
    return number_of_equations(mechanism)


def condition_of(found: xr.Dataset, mechanism: ct.Mechanism) -> Array:
    """Condition numbers: `reaction_loss` is their square times the number of equations times EPS."""
    return np.asarray(np.sqrt(found.reaction_loss.to_numpy() / (size_of(mechanism) * EPS)))


def worst_condition(found: xr.Dataset, mechanism: ct.Mechanism) -> float:
    return float(np.max(condition_of(found, mechanism)[found.reaction_status.to_numpy() == 0]))


def check(parts: dict[str, Any], seed: int) -> int:
    """Everything that holds of one random mechanism; how many samples had reactions."""
    mechanism, motion, found = asked(parts, seed)
    good = found.reaction_status.to_numpy() == 0
    assert np.isfinite(found.joint_force.to_numpy()[good]).all() or found.attrs["undetermined"]
    assert not np.isfinite(found.joint_force.to_numpy()[found.reaction_status.to_numpy() == 3]).any()
    if not good.any():
        return 0
    for residual in ("equilibrium_residual", "frame_residual", "power_residual"):
        assert (
            found.attrs[residual] <= OPERATIONS * size_of(mechanism) * worst_condition(found, mechanism) * EPS
        )
    if found.attrs["undetermined"]:
        return 0
    with np.errstate(all="ignore"):
        balance, outer = Balance.of(mechanism, motion, found), Balance.of_outer(mechanism, motion, found)
        limit = bound(mechanism, balance)
    in_equilibrium(balance, good, limit)
    frame_bears_the_rest(balance, outer, good, limit)
    equals_virtual_work(mechanism, found, good)
    return int(good.sum())


def in_equilibrium(balance: Balance, good: Array, limit: Array) -> None:
    for body in balance.acting:
        if body == FRAME:
            continue
        force, moment = balance.missing(body)
        assert (abs(force) <= limit)[good].all(), body
        if not body.startswith("pin"):
            assert (abs(moment) <= limit)[good].all(), body


def frame_bears_the_rest(balance: Balance, outer: Balance, good: Array, limit: Array) -> None:
    """The frame bears what acts on it, which is all loads less the rates of momentum and of its moment."""
    force, moment = balance.missing(FRAME) if FRAME in balance.acting else (0.0, 0.0)
    assert (abs(vector(balance.found.frame_force) - force) <= limit)[good].all()
    assert (abs(balance.found.frame_moment.to_numpy() - moment) <= limit)[good].all()
    sums = [outer.missing(body) for body in outer.acting]
    assert (abs(vector(balance.found.frame_force) - sum(f for f, _m in sums)) <= limit)[good].all()
    assert (abs(balance.found.frame_moment.to_numpy() - sum(m for _f, m in sums)) <= limit)[good].all()


def equals_virtual_work(mechanism: ct.Mechanism, found: xr.Dataset, good: Array) -> None:
    """J q'' + J' q'^2 / 2 - M, to the rounding that the conditioning of the equations leaves."""
    ends = found.drive_value.to_numpy()[:, 0]
    reduced = ct.reduce(mechanism, len(ends), float(ends[0]), float(ends[-1]))
    rate = reduced.drive_rate.to_numpy()
    wanted = reduced.reduced_inertia_slope.to_numpy() * rate**2 / 2 - reduced.reduced_moment.to_numpy()
    size, condition = size_of(mechanism), condition_of(found, mechanism)
    greatest = np.max(abs(found.joint_force.to_numpy()), axis=(1, 2)) * max(scale_of(mechanism), 1.0)
    greatest = np.maximum(greatest, abs(wanted))
    difference = abs(found.balancing.to_numpy()[:, 0] - wanted)
    assert (difference <= OPERATIONS * size * EPS * condition * greatest)[good].all()


def scale_of(mechanism: ct.Mechanism) -> float:
    return float(structure(mechanism).dimensions.scale)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(few(1, 3)))
def test_every_kind_of_group(kind: str, seed: int) -> None:
    assert check(grown(["RRR", kind], seed), seed + 100) >= 1


@settings(max_examples=few(3, 15), deadline=None)
@given(descriptions(), SEEDS)
def test_random_mechanisms(parts: dict[str, Any], seed: int) -> None:
    check(parts, seed)


@pytest.mark.parametrize("kind", HIGHER)
def test_groups_of_higher_class(kind: str) -> None:
    assert check(grown_higher([kind], 5), 7) >= 1


def spelled_out(mechanism: ct.Mechanism) -> dict[str, Any]:
    """The description with coordinates for lengths and names for guides, as `burdened` wants it."""
    parts = parts_of(mechanism)
    for name, one in mechanism.links.items():
        kept = {key: value for key, value in parts["links"][name].items() if key in ("angle", "reference")}
        parts["links"][name] = {"points": {p: list(at) for p, at in one.coordinates.items()}, **kept}
    for entry, guide in zip(parts.get("guides", []), mechanism.guides, strict=True):
        entry["name"] = guide.id
    return {"guides": [], "frame": {"points": {}}, **parts, "loads": [], "machine": None}


@pytest.mark.parametrize(
    "name",
    examples_at_hand(
        [
            "excavator-arm",
            "five-bar-two-drives",
            "two-link-arm",
            "scissor-lift-cylinder",
            "planetary-gear-train",
            "cardan-gear",
            "geared-five-bar",
            "elliptic-trammel",
            "shaper",
            "slider-between-cranks",
            "third-class-triad",
        ]
    ),
)
def test_built_in_mechanisms(name: str) -> None:
    """Several drives, cylinders, planetary gears, hinges of three links, a mechanism without fixed hinges."""
    parts = burdened(spelled_out(ct.example(name)), 11)
    # the value of the drive is no word in formulas where there are several; where these mechanisms start and end,
    # points stand still, and rounding would decide on a force that acts one way only
    parts["loads"] = [
        load
        for load in parts["loads"]
        if "sin(q)" not in str(load.get("vector")) and "while_moving" not in load
    ]
    mechanism = mechanism_of(parts)
    motion, found = motion_and_reactions(mechanism, 9)
    assert found.attrs["undetermined"] == ""
    good = found.reaction_status.to_numpy() == 0
    assert good.sum() >= 5
    with np.errstate(all="ignore"):
        balance, outer = Balance.of(mechanism, motion, found), Balance.of_outer(mechanism, motion, found)
        limit = bound(mechanism, balance)
    in_equilibrium(balance, good, limit)
    frame_bears_the_rest(balance, outer, good, limit)
    assert (
        found.attrs["power_residual"]
        <= OPERATIONS * size_of(mechanism) * worst_condition(found, mechanism) * EPS
    )


@pytest.mark.parametrize("seed", range(12))
def test_pulls_of_a_coordinate_do_its_slope(seed: int) -> None:
    """Forces of one unit along a coordinate, times the velocities of what they act on, are its derivative."""
    kinds = [KINDS[(seed + k) % len(KINDS)] for k in range(3)]
    mechanism = mechanism_of(burdened(grown(kinds, seed), seed))
    prepared = ready(mechanism)
    initial = prepared.kinematics.path.initial
    solved = solve(prepared, requested_grid(prepared, 5, initial - 0.05, initial + 0.05))
    span = solved.span
    state = State.of(solved, DriveMotion(span.time, span.parameter, span.rate))
    for load in MassesAndLoads.of(mechanism).loads:
        for effort in load.efforts:
            done: Any = 0.0
            size: Any = 0.0
            for pull in effort.coordinate.pulls(state):
                velocity, omega = velocities(state, pull)
                force = pull.force[0] + 1j * pull.force[1]
                done = done + dot(force + 0j * velocity, velocity) + pull.moment * omega
                size = size + abs(force) * abs(velocity) + abs(pull.moment * omega)
            slope = effort.coordinate.slope(state).value
            wrong = abs(done - slope) > OPERATIONS * EPS * (size + state.scale)
            assert not np.any(wrong & np.isfinite(slope)), load.label


def velocities(state: State, pull: Any) -> tuple[Any, Any]:
    """Velocity of the place where a pull acts, as one of its body, and the body's angular velocity."""
    if pull.body.kind == "point":
        x, y = state.point(pull.body.name)
        return x.derivative(1) + 1j * y.derivative(1), 0.0
    if pull.body.name == FRAME:
        return 0.0 * np.asarray(pull.at[0] + 0j), 0.0
    x, y = state.point(next(iter(state.mechanism.links[pull.body.name].coordinates)))
    omega = state.angle(pull.body.name).derivative(1)
    arm = pull.at[0] - x.value + 1j * (pull.at[1] - y.value)
    return x.derivative(1) + 1j * y.derivative(1) + 1j * omega * arm, omega
