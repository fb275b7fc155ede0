"""Poses: dyads against an elimination of its own in 50 digits, known linkages returned, answers by a continuation."""

from __future__ import annotations

import math

import numpy as np
import pytest
from tools.campaigns.synthesis.burmester_elimination import real_dyads
from tools.campaigns.synthesis.coupler_continuation import walk

import centrode as ct
from centrode.synthesis import burmester, four_bars
from centrode.synthesis.burmester import Poses

POSES = [[0, 0, 0.0], [1, 0.6, 0.3], [2, 1, 0.7], [3, 0.9, 1.2], [3.5, 0.4, 1.6]]


@pytest.mark.parametrize("seed", range(4))
def test_five_poses_have_the_dyads_of_an_own_elimination(seed: int) -> None:
    random = np.random.default_rng(seed)
    places, angles = random.normal(size=(5, 2)), random.uniform(-3, 3, 5)
    found = burmester.five_pose_dyads(Poses(places[:, 0] + 1j * places[:, 1], angles))
    own = real_dyads(places.tolist(), angles.tolist())
    assert len(found.moving) == len(own)
    for moving, fixed in own:
        distance = np.abs(found.moving - moving) + np.abs(found.fixed - fixed)
        assert distance.min() < 1e-9 * (1 + abs(moving) + abs(fixed))


def known_linkage(random):
    while True:
        row = np.array([0, 0, random.uniform(2, 4), random.normal(), 1, 1, 1, *random.normal(size=2)])
        ground = math.hypot(row[2], row[3])
        row[4:7] = ground * random.uniform([0.3, 0.8, 0.8], [0.6, 1.1, 1.1])
        crank = np.sort(random.uniform(0, 3, 5))
        motion = four_bars.coupler_motion(row[None], crank, np.ones(1))
        if (motion.radicand > 0.02).all() and np.diff(crank).min() > 0.2:
            return row, crank, motion


def test_poses_of_a_known_linkage_return_it() -> None:
    random = np.random.default_rng(5)
    for _case in range(20):
        row, crank, motion = known_linkage(random)
        poses = Poses(motion.point[0], np.angle(motion.direction[0]) + 0.4)
        joint = row[4] * np.exp(1j * crank[0])
        end = joint + row[5] * motion.direction[0, 0]
        size = np.abs(poses.places - poses.places.mean()).max()
        found = burmester.five_pose_dyads(poses)
        for moving, fixed in ((joint, 0.0), (end, complex(row[2], row[3]))):
            assert (np.abs(found.moving - moving) + np.abs(found.fixed - fixed)).min() < 1e-10 * max(
                size, 1
            ) * 10
        four = burmester.four_pose_dyads(Poses(poses.places[:4], poses.angles[:4]), 4000)
        closed = burmester.closures(Poses(poses.places[:4], poses.angles[:4]), four.moving, four.fixed)
        assert np.nanmax(np.abs(closed) / (1 + np.abs(four.moving) + np.abs(four.fixed))[:, None] ** 2) < 1e-9
        three = Poses(poses.places[:3], poses.angles[:3])
        hinges = np.array([0.0, complex(row[2], row[3])])
        assert burmester.three_pose_moving_points(three, hinges) == pytest.approx(
            np.array([joint, end]), abs=1e-9
        )
        assert burmester.three_pose_centres(three, np.array([joint, end])) == pytest.approx(hinges, abs=1e-9)


@pytest.mark.parametrize("count", [2, 3, 4, 5])
def test_answers_pass_all_poses(count: int) -> None:
    wanted = {"topology": "crank-rocker", "kind": "motion", "targets": POSES[:count]}
    found = ct.synthesise({"synthesis": wanted})
    assert len(found.answers) >= 1
    for answer in found.answers:
        walked = walk(answer.mechanism, answer.drive)
        assert walked.ordered and walked.one_branch and walked.closes
        start = np.array([complex(*row[:2]) for row in POSES[:count]])
        assert walked.places["P"] == pytest.approx(start, abs=1e-9)
        heading = np.angle(np.array(walked.places["Q"]) - np.array(walked.places["P"]))
        turned = np.array([row[2] for row in POSES[:count]])
        assert np.angle(np.exp(1j * (heading - turned))) == pytest.approx(0, abs=1e-9)


def test_three_poses_with_given_hinges() -> None:
    wanted = {
        "topology": "crank-rocker", "kind": "motion", "targets": POSES[:3], "hinges": [[0, -2], [3, -2]],
        "constraints": {"order": False},
    }  # fmt: skip
    found = ct.synthesise({"synthesis": wanted})
    for answer in found.answers:
        fixed = {tuple(answer.mechanism.frame.points[name][:2]) for name in ("O", "D")}
        assert fixed == {(0, -2), (3, -2)}


def test_many_poses_in_the_least_squares_sense() -> None:
    """Nine poses of a known linkage, which is met to rounding."""
    row, crank, _motion = known_linkage(np.random.default_rng(8))
    crank = np.linspace(crank[0], crank[-1], 9)
    motion = four_bars.coupler_motion(row[None], crank, np.ones(1))
    table = [
        [float(z.real), float(z.imag), float(np.angle(d))]
        for z, d in zip(motion.point[0], motion.direction[0], strict=True)
    ]
    best = ct.synthesise(
        {"synthesis": {"topology": "crank-rocker", "kind": "motion", "targets": table}}
    ).answers[0]
    assert best.error < 1e-8
    assert best.numbers["turn_error"][0] < 1e-8
