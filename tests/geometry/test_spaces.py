"""Both spaces: rows are the derivatives of what they belong to, by the coordinates that bodies are moved by."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from centrode.geometry.in_plane import PLANE
from centrode.geometry.on_sphere import SPHERE
from centrode.geometry.space import Space
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions

JETS = JetFunctions(ARRAYS)
EPS = 2.0**-52
SPACES = [PLANE, SPHERE]
RANDOM = [0, 1, 2, 3, 4]


class Scene:
    """Bodies and points anywhere: no constraint holds, so derivatives are looked at beside solutions too."""

    def __init__(self, space: Space, seed: int) -> None:
        self.space = space
        self.random = np.random.default_rng(seed)
        self.point = self.a_place()
        self.pose, self.base = self.a_pose(), self.a_pose()
        self.local = self.a_local()
        self.reference = tuple(self.a_local() for _ in range(4)) if space is SPHERE else None
        self.rotor = (math.cos(0.4), math.sin(0.4))
        angle = self.random.uniform(-3, 3)
        direction = (math.cos(angle), math.sin(angle)) if space is PLANE else (self.random.uniform(0.3, 2.5),)
        self.curve = (self.a_local(), direction)

    def a_local(self) -> tuple[float, float]:
        return float(self.random.uniform(-1.4, 1.4)), float(self.random.uniform(-1.4, 1.4))

    def a_place(self) -> Any:
        return self.space.place(ARRAYS, self.space.at_rest, self.a_local())

    def a_pose(self) -> Any:
        pose = self.space.at_rest
        for _ in range(2):
            pose = self.space.moved_pose(ARRAYS, pose, self.random.uniform(-1, 1, size=3))
        return pose


def slopes(space: Space, function: Any, points: list[Any], poses: list[Any]) -> list[list[float]]:
    """Derivatives of function(points, poses) by the coordinates of each of them, by jets."""
    found = []
    for k in range(len(points) + len(poses)):
        size = 2 if k < len(points) else 3
        row = []
        for j in range(size):
            by = [Jet.variable(0.0, 1) if i == j else Jet((0.0, 0.0)) for i in range(size)]
            moved_points, moved_poses = list(points), list(poses)
            if k < len(points):
                moved_points[k] = space.moved_point(JETS, points[k], by)
            else:
                moved_poses[k - len(points)] = space.moved_pose(JETS, poses[k - len(points)], by)
            row.append(float(function(moved_points, moved_poses).derivative(1)))
        found.append(row)
    return found


@pytest.mark.parametrize("space", SPACES, ids=["plane", "sphere"])
@pytest.mark.parametrize("seed", RANDOM)
def test_rows_are_derivatives(space: Space, seed: int) -> None:
    scene = Scene(space, seed)
    local, curve, rotor, reference = scene.local, scene.curve, scene.rotor, scene.reference
    one_of_each: list[tuple[Any, Any]] = [
        (
            lambda p, q, k=k: space.in_link(JETS, p[0], q[0], local)[k],
            space.in_link_rows(ARRAYS, scene.point, scene.pose, local)[k],
        )
        for k in (0, 1)
    ]
    one_of_each += [
        (
            lambda p, q: space.on_guide(JETS, p[0], q[0], curve),
            space.on_guide_row(ARRAYS, scene.point, scene.pose, curve),
        ),
        (
            lambda p, q: space.slid(JETS, p[0], q[0], curve, 0.3),
            space.slid_row(ARRAYS, scene.point, scene.pose, curve),
        ),
        (
            lambda p, q: space.slide(JETS, p[0], q[0], curve),
            space.slid_row(ARRAYS, scene.point, scene.pose, curve),
        ),
    ]
    for function, rows in one_of_each:
        check(slopes(space, function, [scene.point], [scene.pose]), rows)
    check(
        slopes(
            space, lambda _p, q: space.turn(JETS, q[0], q[1], rotor, reference), [], [scene.pose, scene.base]
        ),
        space.turn_row(ARRAYS, scene.pose, scene.base, reference),
    )


def check(found: list[list[float]], rows: Any) -> None:
    for derivative, row in zip(found, rows, strict=True):
        size = max(1.0, *(abs(x) for x in derivative))
        # some dozens of operations, amplified where the measure itself is steep
        assert derivative == pytest.approx([float(x) for x in row], abs=256 * EPS * size**2)


@pytest.mark.parametrize("space", SPACES, ids=["plane", "sphere"])
@pytest.mark.parametrize("seed", RANDOM)
def test_moved_bodies_stay_what_they_are(space: Space, seed: int) -> None:
    """Large motions too: a point stays in the space, a link keeps its distances."""
    scene = Scene(space, seed)
    by = scene.random.uniform(-2, 2, size=3)
    pose = space.moved_pose(ARRAYS, scene.pose, by)
    assert max(abs(float(x)) for x in space.stretch(space.attitude(pose))) <= 64 * EPS
    locals_ = [scene.a_local(), scene.a_local()]
    inside = [space.place(ARRAYS, space.at_rest, x) for x in locals_]
    outside = [space.place(ARRAYS, pose, x) for x in locals_]
    assert space.distance(ARRAYS, *outside) == pytest.approx(space.distance(ARRAYS, *inside), abs=64 * EPS)
    moved = space.moved_point(ARRAYS, scene.point, by[:2])
    if space is SPHERE:
        assert np.linalg.norm(moved) == pytest.approx(1.0, abs=8 * EPS)
    still = space.moved_point(ARRAYS, scene.point, (0.0, 0.0))
    assert [float(x) for x in still] == pytest.approx([float(x) for x in scene.point], abs=4 * EPS)


@pytest.mark.parametrize("space", SPACES, ids=["plane", "sphere"])
@pytest.mark.parametrize("seed", RANDOM)
def test_a_point_in_its_place_has_no_residual(space: Space, seed: int) -> None:
    scene = Scene(space, seed)
    place = space.place(ARRAYS, scene.pose, scene.local)
    assert max(abs(float(x)) for x in space.in_link(ARRAYS, place, scene.pose, scene.local)) <= 16 * EPS
    # the residual of a small shift is its length
    shifted = space.moved_point(ARRAYS, place, (3e-6, 4e-6))
    found = [float(x) for x in space.in_link(ARRAYS, shifted, scene.pose, scene.local)]
    assert math.hypot(*found) == pytest.approx(5e-6, rel=1e-9)  # to the square of the shift
    if space is SPHERE:
        opposite = tuple(-x for x in place)
        assert max(abs(float(x)) for x in space.in_link(ARRAYS, opposite, scene.pose, scene.local)) > 1e12
        near = space.moved_point(ARRAYS, opposite, (1e-3, 0.0))
        assert max(abs(float(x)) for x in space.in_link(ARRAYS, near, scene.pose, scene.local)) > 1e3


@pytest.mark.parametrize("space", SPACES, ids=["plane", "sphere"])
def test_small_motions_of_a_link(space: Space) -> None:
    """Shifts move the point itself by the scale, the turn leaves it where it is (in the plane: the origin)."""
    scene = Scene(space, 9)
    scale, tiny = 0.2, 1e-7
    local = (0.0, 0.0) if space is PLANE else scene.local
    at = space.place(ARRAYS, scene.pose, local)
    moved = []
    for row in space.shifts(ARRAYS, at, scale):
        pose = space.moved_pose(ARRAYS, scene.pose, [tiny * float(x) for x in row])
        moved.append(float(space.distance(ARRAYS, at, space.place(ARRAYS, pose, local))) / tiny)
    assert moved == pytest.approx([scale, scale, 0.0], abs=8 * EPS / tiny)
