"""Forces of followers against closed forms for harmonic motion, and against statics written out."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from centrode.cams.followers import forces
from centrode.cams.followers.forces import Burden, greatest, least

EPS = np.finfo(float).eps
FLAT = 1e-6
"""Where a smooth extreme is found to an angle of some sqrt(eps), slopes beside it are of that size."""


class Harmonic:
    """Rise by half a cosine wave, fall likewise, dwells between: written out by hand."""

    def __init__(self, high, rise, dwell, fall):
        self.high = high
        self.edges = tuple(np.cumsum([0.0, rise, dwell, fall, 2 * math.pi - rise - dwell - fall]))

    def lift(self, phi, order=0):
        phi = np.mod(phi, 2 * math.pi)
        first, top, down, rest, _end = self.edges
        rows = np.zeros((order + 1, phi.size))
        for start, stop, sign in ((first, top, 1.0), (down, rest, -1.0)):
            wave, inside = math.pi / (stop - start), (phi >= start) & (phi < stop)
            for k in range(order + 1):
                value = -0.5 * self.high * sign * wave**k * np.cos(wave * (phi - start) + k * math.pi / 2)
                rows[k] = np.where(inside, value + 0.5 * self.high * (k == 0), rows[k])
        rows[0] = np.where((phi >= top) & (phi < down), self.high, rows[0])
        return rows


class Straight(Harmonic):
    """Up and down at constant slopes."""

    def lift(self, phi, order=0):
        phi = np.mod(phi, 2 * math.pi)
        rows = np.zeros((order + 1, phi.size))
        rows[0] = self.high * np.interp(phi, self.edges, (0, 1, 1, 0, 0))
        if order:
            slopes = self.high * np.diff((0, 1, 1, 0, 0)) / np.diff(self.edges)
            rows[1] = slopes[np.clip(np.searchsorted(self.edges, phi, side="right") - 1, 0, 3)]
        return rows


HIGH, RISE, FALL = 0.02, math.radians(100), math.radians(80)
MOTION = Harmonic(HIGH, RISE, math.radians(40), FALL)
BURDEN = Burden(inertia=0.6, stiffness=4e3, preload=30.0, load=6.0)
SPEED = 60.0
BOW = 0.5 * HIGH * (math.pi / FALL) ** 2
"""The greatest deceleration by angle, in the quicker fall: h/2 (pi/beta)^2."""
INSET = 64 * EPS
"""Rounding of a sum of a few terms, over its greatest one; an end that is seen from inside is off by less."""


def test_least_force_of_harmonic_motion():
    # With c = cos(pi phi/beta) the force is linear in c, so that it is least at an end: at the top, c = -1.
    found = forces.least_push(MOTION, BURDEN, SPEED)
    expected = 36.0 + 4e3 * HIGH - 0.6 * SPEED**2 * BOW
    assert abs(found.value - expected) <= INSET * 0.6 * SPEED**2 * BOW
    assert abs(found.angle - MOTION.edges[2]) <= INSET


def test_jump_speed_of_harmonic_motion():
    found = forces.jump_speed(MOTION, BURDEN)
    expected = math.sqrt((36.0 + 4e3 * HIGH) / (0.6 * BOW))
    assert abs(found.value - expected) <= INSET * expected
    below, above = (
        forces.least_push(MOTION, BURDEN, found.value * (1 + part)).value for part in (-1e-9, 1e-9)
    )
    assert below > 0 > above


def test_springs_of_harmonic_motion():
    # Stiffness: the force is linear in the lift as well, the worst is the top again.
    accelerating = 0.6 * SPEED**2 * BOW
    stiffness = forces.stiffness_needed(MOTION, BURDEN, SPEED, push=5.0)
    assert abs(stiffness.value - (accelerating + 5.0 - 36.0) / HIGH) <= INSET * accelerating / HIGH
    preload = forces.preload_needed(MOTION, BURDEN, SPEED, push=5.0)
    assert abs(preload.value - (accelerating + 5.0 - 6.0 - 4e3 * HIGH)) <= INSET * accelerating


@pytest.mark.parametrize("seed", range(5))
def test_springs_leave_what_was_asked(seed):
    # By way of the answer: with the spring found the least push is the one asked for.
    draw = np.random.default_rng(seed)
    high, rise, dwell, fall = draw.uniform(0.005, 0.03), *draw.uniform(0.6, 1.6, 3)
    motion = Harmonic(high, rise, dwell, fall)
    speed, push = draw.uniform(20, 90), draw.uniform(0, 40)
    burden = Burden(draw.uniform(0.1, 2), draw.uniform(0, 3e3), draw.uniform(60, 200), draw.uniform(-10, 10))
    scale = max(abs(burden.required_effort(motion.lift(np.array(motion.edges), 2), speed)))
    for name, found in (
        ("preload", forces.preload_needed(motion, burden, speed, push)),
        ("stiffness", forces.stiffness_needed(motion, burden, speed, push)),
    ):
        if name == "stiffness" and found.value == 0.0:
            assert forces.least_push(motion, replace(burden, stiffness=0.0), speed).value >= push
            continue
        left = forces.least_push(motion, replace(burden, **{name: found.value}), speed)
        assert abs(left.value - push) <= INSET * scale


def test_what_no_spring_can_do():
    straight = Straight(HIGH, 1.0, 1.0, 1.0)
    assert forces.jump_speed(straight, BURDEN).value == 0.0
    assert forces.jump_speed(straight, replace(BURDEN, inertia=0.0)).value == math.inf
    assert forces.preload_needed(straight, BURDEN, SPEED).value == math.inf
    assert forces.stiffness_needed(straight, BURDEN, SPEED).value == math.inf
    # Pulled off already at rest; and too little while the follower is down, where a stiffness does nothing.
    pulled = Burden(inertia=0.6, stiffness=4e3, preload=0.0, load=-1.0)
    assert forces.jump_speed(MOTION, pulled).value == 0.0
    assert forces.stiffness_needed(MOTION, pulled, SPEED).value == math.inf


def test_extremes_count_both_sides_of_joints():
    # s'' of harmonic motion jumps between +-bow and 0 at every joint.
    top = greatest(MOTION, lambda rows: rows[2])
    assert abs(top.value - BOW) <= INSET * BOW
    bottom = least(MOTION, lambda rows: rows[2])
    assert abs(bottom.value + BOW) <= INSET * BOW
    steep = greatest(MOTION, lambda rows: rows[1])
    assert abs(steep.value - 0.5 * HIGH * math.pi / RISE) <= 4 * EPS * HIGH
    assert abs(steep.angle - RISE / 2) <= FLAT
    assert not forces.slope_drops(MOTION)


PHI = np.concatenate([np.linspace(a, b, 23, endpoint=False) + 1e-3 for a, b in pairwise(MOTION.edges)])
ROWS = MOTION.lift(PHI, 2)
PUSH = BURDEN.required_effort(ROWS, 25.0)
ARM, DISTANCE, ANGLES = 0.08, 0.1, ROWS * (0.3 / HIGH)
START = math.acos((DISTANCE**2 + ARM**2 - 0.045**2) / (2 * DISTANCE * ARM))
MEETINGS = {
    f"{name}{sense:+.0f}": (met, rows)
    for sense in (1.0, -1.0)
    for name, met, rows in (
        ("roller", forces.on_centre(ROWS, 0.008, 0.05, sense, rolling=True), ROWS),
        ("edge", forces.on_centre(ROWS, -0.008, 0.05, sense, rolling=False), ROWS),
        ("face", forces.on_face(ROWS, 0.05, sense), ROWS),
        ("arm", forces.on_arm(ANGLES, ARM, DISTANCE, START, sense, rolling=True), ANGLES),
        ("arm-edge", forces.on_arm(ANGLES, ARM, DISTANCE, START, sense, rolling=False), ANGLES),
        ("turning-face", forces.on_turning_face(ANGLES, DISTANCE, 0.45, 0.006, sense), ANGLES),
    )
}


@pytest.mark.parametrize("name", MEETINGS)
def test_torque_is_that_of_virtual_work(name):
    # Without friction the cam's work is the follower's: T dphi = Q ds.
    met, rows = MEETINGS[name]
    force = met.normal_force(PUSH)
    torque = met.torque(force)
    size = np.abs(force) * np.linalg.norm(met.place, axis=1)
    # The normal is known to rounding of a sum of a few terms; so is its moment.
    assert np.all(np.abs(torque - PUSH * rows[1]) <= 16 * EPS * size)


@pytest.mark.parametrize("flank", [1.0, -1.0])
@pytest.mark.parametrize("name", MEETINGS)
def test_friction_costs_what_slips(name, flank):
    # Power of the cam = power of the follower + friction force times speed of sliding, on both flanks of a groove.
    met, rows = MEETINGS[name]
    friction, push = 0.12, flank * PUSH
    force = met.normal_force(push, friction)
    assert np.all(flank * force > 0)
    torque = met.torque(force, friction)
    cam = met.sense * np.stack([-met.place[:, 1], met.place[:, 0]], axis=1)
    if name[:-2] in ("arm", "arm-edge", "turning-face"):
        reach = met.place - np.array([DISTANCE, 0.0])
        follower = rows[1][:, None] * np.stack([reach[:, 1], -reach[:, 0]], axis=1)
    else:
        follower = rows[1][:, None] * np.array([0.0, 1.0])
    slip = cam - follower
    # Of the edge the place is the follower's own point; of a face that of the cam: both meet along the normal.
    along = np.sum(slip * met.slip, axis=1)
    rolling = name[:-2] in ("roller", "arm")
    assert np.all(along == 0) if rolling else np.all(along > 0)
    across = np.abs(np.sum(slip * met.normal, axis=1))
    assert np.all(across <= 16 * EPS * np.linalg.norm(slip, axis=1))
    lost = torque - push * rows[1] - friction * np.abs(force) * along
    assert np.all(np.abs(lost) <= 32 * EPS * np.abs(force) * np.linalg.norm(met.place, axis=1))


def test_normal_force_by_the_pressure_angle():
    # tan alpha = (s' - e)/(rise + s): the textbook's formula for a translating roller.
    met, _rows = MEETINGS["roller+1"]
    tangent = (ROWS[1] - 0.008) / (0.05 + ROWS[0])
    expected = PUSH * np.hypot(1.0, tangent)
    assert np.all(np.abs(met.normal_force(PUSH) - expected) <= 8 * EPS * np.abs(expected))


def test_friction_that_locks():
    # An edge on a slope steeper than the angle of friction leaves: tan alpha = 1/mu.
    rows = np.array([[0.0, 0.0], [0.0, 0.2], [0.0, 0.0]])
    met = forces.on_centre(rows, 0.0, 0.05, 1.0, rolling=False)
    assert np.isfinite(met.normal_force(np.array([1.0, 1.0]), 0.2499)).all()
    assert np.isinf(met.normal_force(np.array([1.0, 1.0]), 0.2501)).tolist() == [False, True]


def test_what_is_zero_is_not_told_below_zero():
    free = least(MOTION, lambda rows: 0.0 * rows[0])
    assert free.value == 0.0 and math.copysign(1.0, free.value) == 1.0
