"""Friction by coefficients in random mechanisms: equilibrium of every body, Coulomb's law, power."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import centrode as ct
from burdened import burdened
from growing import DYADS, descriptions, grown, mechanism_of
from kinetostatics import motion_and_reactions, number_of_equations
from mechanisms import EPS, link, slide
from newton_euler import FRAME, Balance, dot, vector
from samples import few

Array = npt.NDArray[np.float64]
OPERATIONS = 256
"""Roundings in one sum of forces."""
SEEDS = st.integers(0, 2**32 - 1)


def pin_of(parts: dict[str, Any], point: str) -> str:
    """What the pin of a hinge is fixed in: the frame, the body of a guide without slider, the first link."""
    if point in parts["frame"]["points"]:
        return FRAME
    carriers = [guide["on"] for guide in parts["guides"] if guide["point"] == point and not guide.get("link")]
    return str([*carriers, *(name for name, body in parts["links"].items() if point in body["points"])][0])


def with_friction(parts: dict[str, Any], seed: int, greatest: float) -> dict[str, Any]:
    """Friction in every hinge and guide, with random coefficients and sizes."""
    random = np.random.default_rng(seed)
    parts = burdened(parts, seed)
    parts["loads"] = [load for load in parts["loads"] if load["kind"] != "friction"]
    parts["drives"][0]["speed"] = -1.7
    points = dict.fromkeys(point for body in parts["links"].values() for point in body["points"])
    for point in points:
        bodies = {name for name, body in parts["links"].items() if point in body["points"]}
        if len(bodies | {pin_of(parts, point)}) > 1:
            mu, radius = random.uniform(0.01, greatest), random.uniform(0.02, 0.15)
            parts["loads"].append({"kind": "friction", "point": point, "coefficient": mu, "radius": radius})
    for guide in parts["guides"]:
        load = {"kind": "friction", "guide": guide["name"], "coefficient": random.uniform(0.01, greatest)}
        if guide.get("link"):
            load |= {"length": random.uniform(0.5, 3.0), "height": random.uniform(0.1, 0.5)}
        parts["loads"].append(load)
    return parts


@dataclass
class Rubbed(Balance):
    """Equilibrium with friction: of hinges as couples, of guides as part of their force and moment."""

    def guides(self) -> None:
        for guide in self.mechanism.guides:
            one = self.found.sel(guide=guide.id)
            self.pair(self.slider(guide), guide.on, vector(one.guide_force), self.at(guide.point))
            if guide.link is not None:
                self.pair(guide.link, guide.on, 0.0, 0.0, one.guide_moment.to_numpy())

    def load(self, load: Any) -> None:
        if load.kind != "friction":
            super().load(load)

    def bearings(self, pins: dict[str, str]) -> None:
        for label in self.found.bearing.to_numpy():
            name, body = str(label).split("/")
            moment = self.found.friction_moment.sel(bearing=label).to_numpy()
            self.pair(body, pins[name], 0.0, 0.0, moment)


def asked(parts: dict[str, Any], seed: int, greatest: float) -> Any:
    parts = with_friction(parts, seed, greatest)
    mechanism = mechanism_of(parts)
    pins = {point: pin_of(parts, point) for body in parts["links"].values() for point in body["points"]}
    return mechanism, *motion_and_reactions(mechanism, 7, 0.3), pins


def check(parts: dict[str, Any], seed: int, greatest: float = 0.3) -> int:
    """Everything that holds of one random mechanism; how many samples had reactions."""
    try:
        mechanism, motion, found, pins = asked(parts, seed, greatest)
    except ct.InputError as error:
        assert "do not determine" in str(error)
        return 0
    status = found.reaction_status.to_numpy()
    assert not (status == ct.Status.UNCONVERGED)[motion.status.to_numpy() == 0].any()
    good = status == 0
    given_ = good | (status == ct.Status.CUT_OFF)
    assert (np.isfinite(found.joint_force.to_numpy()).all(axis=(1, 2)) == given_).all()
    if not good.any():
        return 0
    # rounding of f over the greatest f: of as many summands as sizes, and of what they are differences of
    assert found.attrs["friction_residual"] <= OPERATIONS * EPS * worst_condition(found, mechanism)
    with np.errstate(all="ignore"):
        balance = Rubbed.of(mechanism, motion, found)
        balance.bearings(pins)
        limit = OPERATIONS * size_of(mechanism) * EPS * balance.greatest()
        limit = np.where(good, limit, 0.0)
    for body in balance.acting:
        if body != FRAME:
            force, moment = balance.missing(body)
            assert (abs(force) <= limit)[good].all(), body
            assert body.startswith("pin") or (abs(moment) <= limit)[good].all(), body
    coulomb(mechanism, motion, found, pins, good, limit)
    power(mechanism, found, good, limit)
    return int(good.sum())


def coulomb(
    mechanism: ct.Mechanism, motion: xr.Dataset, found: Any, pins: Any, good: Array, limit: Any
) -> None:
    """Sizes and senses of friction, from the reactions beside them and from the motion."""
    for load in mechanism.loads:
        if not hasattr(load, "coefficient"):
            continue
        if hasattr(load, "guide"):
            in_guide(mechanism, load, motion, found, good, limit)
            continue
        for label in found.bearing.to_numpy():
            name, body = str(label).split("/")
            if name == load.point:
                turn = link(motion, body, "angular_velocity")
                turn = turn - (0 if pins[name] == FRAME else link(motion, pins[name], "angular_velocity"))
                pressing = abs(vector(found.joint_force.sel(side=label)))
                wanted = -np.sign(turn) * load.coefficient * load.radius * pressing
                moving = good & (abs(turn) > 1e-9)
                difference = found.friction_moment.sel(bearing=label).to_numpy() - wanted
                assert (abs(difference) <= limit)[moving].all(), label


def in_guide(mechanism: ct.Mechanism, load: Any, motion: Any, found: Any, good: Array, limit: Any) -> None:
    guide = mechanism.guide(load.guide)
    one = found.sel(guide=load.guide)
    sense = np.sign(slide(motion, load.guide, "slide_velocity"))
    moving = good & (abs(slide(motion, load.guide, "slide_velocity")) > 1e-9)
    normal, moment = one.guide_normal.to_numpy(), one.guide_moment.to_numpy()
    pressing = abs(normal)
    if load.length is not None:
        # each end bears; friction on the faces that do has an arm of half the height
        ends = moment + sense * load.coefficient * load.height / 2 * normal
        first, second = normal / 2 - ends / load.length, normal / 2 + ends / load.length
        pressing = abs(first) + abs(second)
    found_force = one.friction_force.to_numpy()
    assert (abs(found_force + sense * load.coefficient * pressing) <= 4 * limit)[moving].all()
    turn = 1.0 if guide.on == FRAME else np.exp(1j * link(motion, guide.on))
    along = turn * complex(*guide.unit)
    force = vector(one.guide_force)
    assert (abs(dot(along, force) - found_force) <= limit)[good].all()
    assert (abs(dot(1j * along, force) - normal) <= limit)[good].all()


def power(mechanism: ct.Mechanism, found: xr.Dataset, good: Array, limit: Any) -> None:
    """What the drive gives more than without friction is what friction takes, at every sample."""
    ends = found.drive_value.to_numpy()[:, 0]
    free = ct.reactions(mechanism, len(ends), float(ends[0]), float(ends[-1]), friction=False)
    assert "friction_power" not in free
    rate = found.drive_rate.to_numpy()
    more = (found.balancing - free.balancing).to_numpy()[:, 0] * rate
    lost = found.friction_power.to_numpy()
    assert (lost[good] >= 0).all()
    condition = condition_of(found, mechanism)
    assert (abs(more - lost.sum(axis=1)) <= limit * condition * abs(rate))[good].all()
    assert (
        found.attrs["power_residual"]
        <= OPERATIONS * size_of(mechanism) * worst_condition(found, mechanism) * EPS
    )
    efficiency = found.efficiency.to_numpy()[good]
    assert ((efficiency >= 0) & (efficiency <= 1)).all()


def size_of(mechanism: ct.Mechanism) -> int:
    return number_of_equations(mechanism)


def condition_of(found: xr.Dataset, mechanism: ct.Mechanism) -> Array:
    """`reaction_loss` is the square of the condition number times the number of equations times EPS."""
    return np.asarray(np.sqrt(found.reaction_loss.to_numpy() / (size_of(mechanism) * EPS)))


def worst_condition(found: xr.Dataset, mechanism: ct.Mechanism) -> float:
    return float(np.max(condition_of(found, mechanism)[found.reaction_status.to_numpy() == 0]))


@pytest.mark.parametrize("kind", DYADS)
@pytest.mark.parametrize("seed", range(few(1, 3)))
def test_every_kind_of_dyad(kind: str, seed: int) -> None:
    if kind != "parallel link":  # whose constraints repeat each other
        assert check(grown(["RRR", kind], seed), seed + 100, 0.1) >= 1


@settings(max_examples=few(4, 15), deadline=None)
@given(descriptions(), SEEDS)
def test_random_mechanisms(parts: dict[str, Any], seed: int) -> None:
    check(parts, seed)
