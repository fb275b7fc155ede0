"""Instantaneous axes and polodes on the sphere against closed forms and against the places of the motion itself."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import centrode as ct
from centrode.analysis.instant_centres.bodies import body_names
from centrode.analysis.instant_centres.centres import Case
from centrode.analysis.instant_centres.kennedy import construct_centres
from centrode.kinematics.motion import initial_place
from growing import mechanism_of
from growing_sphere import KINDS, grown
from mechanisms import EPS, four_bar

Vector = Any


def along(axis: Vector, other: Vector) -> float:
    """Sine of the angle between two lines."""
    return float(np.linalg.norm(np.cross(axis, other)) / np.linalg.norm(other))


def centre(found: Any, pair: str, sample: int = 0) -> Vector:
    return found.centre.sel(pair=pair).to_numpy()[sample]


def test_axes_of_a_four_bar_lie_on_its_great_circles() -> None:
    """Coupler against frame: where the arcs AB and DC meet; rocker against crank: where AD and BC do."""
    motion = ct.motion(ct.example("spherical-four-bar"), at=[0.3, 1.0, 4.0])
    found = ct.instant_centres(motion)
    for sample in range(3):
        a, b, c, d = (motion.position.sel(point=name).to_numpy()[sample] for name in "ABCD")
        pairs = {"BC,frame": ((a, b), (d, c)), "DC,AB": ((a, d), (b, c))}
        for pair, (one, other) in pairs.items():
            first, second = np.cross(*one), np.cross(*other)
            truth = np.cross(first, second)
            loss = np.linalg.norm(first) * np.linalg.norm(second) / np.linalg.norm(truth)
            reach = 1.0 / min(np.linalg.norm(first), np.linalg.norm(second))
            assert along(centre(found, pair, sample), truth) <= 64 * EPS * loss * reach
        for pair, hinge in {"AB,frame": a, "DC,frame": d, "BC,AB": b, "DC,BC": c}.items():
            assert along(centre(found, pair, sample), hinge) <= 64 * EPS / 0.1
    assert set(found.centre_case.values.ravel().tolist()) == {Case.HINGE, Case.DIRECTIONS}


def test_speed_about_the_axis_is_that_of_the_joint() -> None:
    """Driven shaft of Hooke's joint: cos b/(1 - sin^2 b cos^2 x); it turns as the driving one does."""
    motion = ct.motion(ct.example("hookes-joint"), samples=25)
    found = ct.instant_centres(motion, [("DC", "frame"), ("AB", "frame")])
    x, bend = motion.drive_value.to_numpy()[:, 0], np.pi / 6
    truth = np.cos(bend) / (1.0 - (np.sin(bend) * np.cos(x)) ** 2)
    speeds = found.relative_speed.to_numpy()
    assert np.abs(speeds[:, 0] - truth).max() <= 64 * EPS
    assert np.abs(speeds[:, 1] - 1.0).max() <= 64 * EPS
    ends = found.centre.sel(pair="DC,frame").to_numpy()
    assert np.abs(ends - [np.cos(bend), np.sin(bend), 0.0]).max() <= 64 * EPS


def attitude(motion: Any, link: str, mechanism: ct.Mechanism, sample: int) -> Vector:
    """Columns fixed in a link, from the places of its first two points."""
    first, second = (
        motion.position.sel(point=name).to_numpy()[sample] for name in list(mechanism.points_of(link))[:2]
    )
    normal = np.cross(first, second) / np.linalg.norm(np.cross(first, second))
    return np.column_stack([first, np.cross(normal, first), normal])


@pytest.mark.parametrize(("link", "against"), [("BC", "AB"), ("BC", "DC"), ("DC", "AB")])
def test_axes_follow_from_places_a_little_before_and_after(link: str, against: str) -> None:
    """The axis of the small rotation between two places tends to the instantaneous one as the square of the step."""
    mechanism = ct.example("spherical-four-bar")
    truth = ct.instant_centres(ct.motion(mechanism, at=[1.0]), [(link, against)]).centre.to_numpy()[0, 0]
    base = attitude(ct.motion(mechanism, at=[1.0]), against, mechanism, 0)
    errors = []
    for step in (2e-2, 1e-2):
        motion = ct.motion(mechanism, at=[1.0 - step, 1.0 + step])
        seen = [
            attitude(motion, against, mechanism, k).T @ attitude(motion, link, mechanism, k) for k in (0, 1)
        ]
        turn = seen[1] @ seen[0].T
        axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
        axis = base @ axis
        assert axis @ truth > 0.0  # about the end that is given, it turns counter-clockwise
        errors.append(along(truth, axis))
    assert 3.5 <= errors[0] / errors[1] <= 4.5 or errors[0] <= 64 * EPS / 1e-2


@settings(max_examples=25, deadline=None)
@given(st.lists(st.sampled_from(KINDS), min_size=1, max_size=3), st.integers(0, 2**16))
def test_axes_of_three_bodies_lie_on_one_great_circle(kinds: list[str], seed: int) -> None:
    """Kennedy's theorem on random mechanisms, and the construction from places against the velocities."""
    mechanism = mechanism_of(grown(kinds, seed).parts())
    # with several drives values are given in time: the initial position is at 0
    motion = ct.motion(mechanism, at=[initial_place(mechanism)])
    if not np.isfinite(motion.angular_velocity.to_numpy()).all():
        return
    found = ct.instant_centres(motion)
    names = body_names(mechanism)
    ends = {}
    for column, label in enumerate(found.pair.values):
        ends[frozenset(label.split(","))] = (
            found.centre.to_numpy()[0, column],
            abs(float(found.relative_speed[0, column])),
        )
    rate = max(speed for _end, speed in ends.values())
    residual = float(motion.residual[0])
    for triple in combinations(names, 3):
        three = [ends[frozenset(pair)] for pair in combinations(triple, 2)]
        if all(np.isfinite(end).all() for end, _speed in three):
            volume = abs(np.linalg.det([end for end, _speed in three]))
            # the relative velocities add up to nothing: rounding of the greatest over the smallest of them
            slowest = min(speed for _end, speed in three)
            assert volume <= 64 * EPS * rate / slowest
    made = construct_centres(motion)
    for step in made.steps:
        assert made.mismatch[step.pair] <= 4.0 * step.error * max(1.0, 1.0 / 0.05) + 1e3 * (EPS + residual)


def test_bevel_wheels_roll_on_their_pitch_cones() -> None:
    """The polodes are circles of atan 20/40 about A and of atan 40/20 about B; arcs are angles times their sines."""
    mechanism = ct.example("bevel-pair")
    motion = ct.motion(mechanism, samples=73)
    found = ct.centrodes(motion, "BF", "AE")
    fixed, moving = found.fixed_centrode.to_numpy(), found.moving_centrode.to_numpy()
    small, great = np.arctan2(20, 40), np.arctan2(40, 20)
    # the first point of a link with a length lies on its x axis
    assert np.abs(np.abs(fixed[:, 0]) - np.cos(small)).max() <= 64 * EPS
    assert np.abs(np.abs(moving[:, 0]) - np.cos(great)).max() <= 64 * EPS
    turned = motion.drive_value.to_numpy()[:, 0]
    step = turned[1]
    truth = turned * np.sin(small)
    assert np.abs(found.fixed_arc - truth).max() <= truth[-1] * step**4
    assert np.abs(found.moving_arc - truth).max() <= truth[-1] * step**4
    mesh = ct.instant_centres(motion, [("BF", "AE")])
    axis = np.array([2.0, 1.0, 0.0]) / np.sqrt(5.0)
    assert np.linalg.norm(np.cross(mesh.centre.to_numpy()[:, 0], axis), axis=1).max() <= 64 * EPS
    assert (mesh.centre_case == Case.ROLLING).all()
    assert np.abs(mesh.relative_speed.to_numpy() - np.sqrt(1.25)).max() <= 64 * EPS


ROLLING = [
    ("spherical-four-bar", "BC", "frame"),
    ("spherical-four-bar", "DC", "AB"),
    ("spherical-crank-guide", "slider C", "AB"),
    ("wobble-plate", "BC", "frame"),
    ("bevel-differential", "planet", "left"),
]


@pytest.mark.parametrize(("name", "link", "against"), ROLLING)
def test_polodes_roll_without_slip(name: str, link: str, against: str) -> None:
    """Both arcs are integrated apart, each from its own places: they agree to the fourth order of the step."""
    apart = []
    for samples in (121, 241):
        motion = ct.motion(ct.example(name), samples=samples, start=0.0, stop=6.0)
        found = ct.centrodes(motion, link, against)
        assert (found.centrode_piece == 0).all()
        assert np.abs(np.linalg.norm(found.moving_centrode, axis=-1) - 1.0).max() <= 64 * EPS
        apart.append(float(np.abs(found.fixed_arc - found.moving_arc).max()))
    assert apart[1] <= apart[0] / 12.0 or apart[0] <= 1e3 * EPS * samples
    back = ct.centrodes(motion, against, link)  # seen the other way round the axis turns its other end
    assert np.abs(back.fixed_centrode + found.moving_centrode).max() <= 64 * EPS
    assert np.abs(back.moving_arc - found.fixed_arc).max() <= 1e3 * EPS * samples


def test_the_moving_polode_touches_the_fixed_one_at_every_instant() -> None:
    """Carried along with the coupler, it passes through the axis, in the direction in which the fixed one goes."""
    mechanism = ct.example("spherical-four-bar")
    motion = ct.motion(mechanism, samples=361)
    found = ct.centrodes(motion, "BC")
    fixed, moving = found.fixed_centrode.to_numpy(), found.moving_centrode.to_numpy()
    step = 2.0 * np.pi / 360
    for sample in (40, 170, 300):
        b, c = (motion.position.sel(point=name).to_numpy()[sample] for name in "BC")
        side = (c - b * (b @ c)) / np.linalg.norm(np.cross(b, c))
        axes = np.column_stack([b, side, np.cross(b, side)])
        laid = moving @ axes.T
        assert np.abs(laid[sample] - fixed[sample]).max() <= 64 * EPS / np.linalg.norm(np.cross(b, c))
        ways = [np.gradient(curve, axis=0)[sample] for curve in (fixed, laid)]
        assert along(ways[0], ways[1]) <= 10 * step**2


def test_where_a_rocker_turns_back() -> None:
    """At 90 and 270 deg the rocker stands still: no axis there, and a piece of the polode ends."""
    mechanism = ct.example("spherical-four-bar")
    found = ct.instant_centres(ct.motion(mechanism, at=[np.pi / 2]), [("DC", "frame")])
    assert found.centre_case.item() == Case.REST
    assert np.isnan(found.centre).all()
    assert abs(found.relative_speed.item()) <= 64 * EPS
    rolled = ct.centrodes(ct.motion(mechanism, samples=100), "DC")
    assert rolled.centrode_piece.max() == 2
    assert np.nanmax(rolled.fixed_arc) <= 1e3 * EPS  # a hinge is a place


def test_bodies_that_move_alike_have_no_axis() -> None:
    """With both side wheels at one speed the whole differential turns as one body."""
    text = ct.mechanism_text(ct.example("bevel-differential")).replace("speed = 2.0", "speed = 1.0")
    motion = ct.motion(ct.parse_mechanism(text), at=[0.7])
    found = ct.instant_centres(motion)
    moving = {str(label) for label in found.pair.values if label.endswith(",frame")}
    for column, label in enumerate(map(str, found.pair.values)):
        still = found.centre_case.to_numpy()[0, column] == Case.REST
        assert still == (label not in moving)
    assert np.allclose(found.relative_speed.sel(pair=sorted(moving)), 1.0, rtol=0, atol=64 * EPS)


def test_a_batch_is_its_mechanisms() -> None:
    mechanism = ct.example("spherical-crank-guide")
    values = [0.7, 0.8]
    batch = ct.motion(mechanism, samples=7, vary={"links.BC.length": values})
    axes, rolled = ct.instant_centres(batch), ct.centrodes(batch, "slider C", "AB")
    for k in range(2):
        one = batch.isel(mechanism=k)
        assert np.array_equal(axes.centre[k], ct.instant_centres(one).centre, equal_nan=True)
        assert np.array_equal(rolled.moving_arc[k], ct.centrodes(one, "slider C", "AB").moving_arc)
    made = construct_centres(batch.isel(mechanism=1), 3)
    assert max(made.mismatch.values()) <= 64 * EPS / 0.1


def test_a_small_linkage_keeps_its_accuracy() -> None:
    """A four-bar of some micrometres on the unit sphere has the centres of a planar one."""
    size = 1e-5
    text = f"""
space = "sphere"
[frame.points]
A = [0, 0]
D = [{4 * size}, 0]
[links.AB]
length = {size}
reference = ["A", "D"]
[links.BC]
length = {3.5 * size}
[links.DC]
length = {3 * size}
[[drives]]
link = "AB"
start = 1.0
speed = 1.0
[assembly]
sides = {{ C = "left" }}
"""
    motion = ct.motion(ct.parse_mechanism(text), at=[1.0])
    made = construct_centres(motion)
    assert {step.how for step in made.steps} == {"hinge", "kennedy"}
    planar = ct.motion(four_bar(1.0, 3.5, 3.0, 4.0), at=[1.0])
    for pair, same in ((("BC", "frame"), ("AB", "frame")), (("DC", "AB"), ("DB", "OA"))):
        place = made.step(*pair).place
        assert place is not None
        truth = ct.instant_centres(planar, [same]).centre.to_numpy()[0, 0]
        seen = np.array(place[1:]) / place[0] / size
        # arcs differ from lengths by the square of their size, and places are known to EPS over it
        assert np.abs(seen - truth).max() <= 64 * (size**2 + EPS / size) * np.abs(truth).max()
