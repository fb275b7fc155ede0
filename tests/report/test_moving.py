"""Motions to be played: the part that is reached, and shapes that keep what the mechanism keeps."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.model.examples.catalogue import load_cam
from centrode.render.document.blocks import Moving, Outline, RingBlock
from centrode.render.document.cam_player import STEP, moving_wheel
from centrode.render.document.linkage_player import moving_of

EPS = np.finfo(float).eps


def of(name: str, **how: float) -> tuple[ct.Mechanism, Moving]:
    mechanism = ct.example(name)
    return mechanism, moving_of(mechanism, ct.motion(mechanism, **how))


def placed(outline: Outline, sample: int) -> np.ndarray:
    """Corners of an outline in the axes of the frame at a sample."""
    x, y, turn = outline.poses[sample if len(outline.poses) > 1 else 0]
    cosine, sine = np.cos(turn), np.sin(turn)
    return outline.corners @ np.array([[cosine, sine], [-sine, cosine]]) + [x, y]


def test_a_whole_turn_is_played() -> None:
    mechanism, moving = of("six-bar-press")
    assert len(moving.drive) == len(moving.drive_texts) == 361
    assert list(moving.bodies) == list(mechanism.links)
    assert moving.fixed == ("O", "C")
    assert moving.driven == ("A",)
    assert set(moving.dots) == {"S2", "S4"}
    assert moving.start == 0
    length = np.hypot(*(moving.places["A"] - moving.places["O"]).T)
    assert np.abs(length - 0.347).max() <= 4 * EPS


def test_what_is_cut_off_is_not_played() -> None:
    mechanism, moving = of("slider-between-cranks-locked")
    limit = ct.limits(mechanism, "OA", {}).interval[1]
    motion = ct.motion(mechanism)
    reached = motion.drive_value.values[:, 0] <= limit
    assert 0 < reached.sum() < reached.size
    np.testing.assert_array_equal(moving.drive, motion.drive_value.values[reached, 0])


def test_a_range_begins_where_the_mechanism_stands() -> None:
    mechanism, moving = of("slider-between-cranks-locked", start=-0.5, stop=1.5, samples=21)
    assert np.abs(moving.drive[moving.start]) == np.abs(moving.drive).min()
    assert moving.start > 0
    del mechanism


def test_nothing_to_play() -> None:
    mechanism = ct.example("slider-between-cranks-locked")
    with pytest.raises(InputError, match="no sample has every point in place"):
        moving_of(mechanism, ct.motion(mechanism, start=2.0, stop=2.3, samples=5))


def test_a_value_of_the_drive_has_its_unit() -> None:
    _mechanism, moving = of("six-bar-press")
    assert moving.drive_texts[0] == "φ (OA) = 219.1°"
    _mechanism, moving = of("five-bar-two-drives")
    assert moving.drive_texts[0] == "t = 0.000\u202fs"


def test_the_pin_stays_in_its_slot() -> None:
    _mechanism, moving = of("whitworth-quick-return")
    slot = next(one for one in moving.shapes if isinstance(one, Outline) and one.white)
    middle = np.nanmean(slot.corners, axis=0)
    for sample in range(0, len(moving.drive), 40):
        corners = placed(slot, sample)
        ends = corners[: len(corners) // 2].mean(axis=0), corners[len(corners) // 2 :].mean(axis=0)
        way = (ends[1] - ends[0]) / np.hypot(*(ends[1] - ends[0]))
        offset = moving.places["A"][sample] - ends[0]
        across = way[0] * offset[1] - way[1] * offset[0]
        assert abs(across) <= 64 * EPS * np.abs(corners).max()
        assert 0 <= offset @ way <= np.hypot(*(ends[1] - ends[0]))
    assert np.isfinite(middle).all()


def test_a_wheel_touches_its_ring() -> None:
    _mechanism, moving = of("planetary-hypocycloid")
    ring, wheel = (one for one in moving.shapes if isinstance(one, Outline))
    radius = np.nanmax(np.hypot(*wheel.corners.T))
    track = np.hypot(*ring.corners[0])
    for sample in range(0, len(moving.drive), 30):
        rim = np.hypot(*placed(wheel, sample).T)
        # the rim is drawn with corners: a corner may miss the contact by this much
        assert track - radius * (1 - np.cos(np.pi / 48)) - 1e-12 <= rim.max() <= track * (1 + 8 * EPS)
        points = [moving.places[name][sample] for name in ("P",)]
        assert all(np.hypot(*point) <= track * (1 + 8 * EPS) for point in points)


def test_cylinders_have_barrel_and_rod() -> None:
    mechanism, moving = of("excavator-arm")
    barrels = [one for one in moving.shapes if isinstance(one, Outline) and not one.behind]
    drives = [drive for drive in mechanism.drives if drive.distance]
    assert len(barrels) == len(drives) == 3
    for barrel, drive in zip(barrels, drives, strict=True):
        assert moving.bodies[drive.id] == tuple(drive.distance or ())
        first, second = (moving.places[point] for point in drive.distance or ())
        first = np.broadcast_to(first, second.shape)
        np.testing.assert_allclose(barrel.poses[:, :2], first, rtol=0, atol=8 * EPS * np.abs(first).max())
        way = second - first
        along = np.stack([np.cos(barrel.poses[:, 2]), np.sin(barrel.poses[:, 2])], axis=1)
        lengths = np.hypot(*way.T)
        assert np.abs(np.sum(way * along, axis=1) - lengths).max() <= 8 * EPS * lengths.max()
        assert barrel.corners[:, 0].max() < lengths.min()


def test_a_guide_of_the_sphere_is_a_circle_about_its_pole() -> None:
    _mechanism, moving = of("spherical-crank-guide")
    (ring,) = (one for one in moving.shapes if isinstance(one, RingBlock))
    assert moving.view is not None
    np.testing.assert_allclose(moving.view @ moving.view.T, np.eye(3), atol=8 * EPS)
    arcs = np.arccos(moving.places["C"] @ ring.poles[0])
    assert np.abs(arcs - ring.arc).max() <= 8 * EPS


@pytest.mark.parametrize("name", ["walking-wheel-four-legs"])
def test_a_walking_wheel_stands_on_its_ground(name: str) -> None:
    cam = load_cam(name)
    wheel = ct.walking_wheel(cam)
    moving = moving_wheel(wheel, cam.title)
    outlines = [one for one in moving.shapes if isinstance(one, Outline)]
    shoes = [one for one in outlines if one.filled and len(one.poses) > 1]
    assert len(shoes) == wheel.legs
    assert len(moving.drive) == STEP * wheel.legs + 1
    lowest = np.array([[placed(shoe, k)[:, 1].min() for shoe in shoes] for k in range(len(moving.drive))])
    # a shoe is drawn with corners: a chord leaves its arc by (step of angle)^2 / 8 of the radius of curvature
    chord = (2 * wheel.half / 120) ** 2 / 8 * 4 * wheel.height
    assert np.abs(lowest.min(axis=1)).max() <= chord
    hub = np.array([0.0, wheel.height])
    for name_of, places in moving.places.items():
        if name_of != "O":
            turn = np.arctan2(*(hub - places).T)
            radius = wheel.closed.radius(turn)[0]
            assert np.abs(np.hypot(*(places - hub).T) - radius).max() <= 64 * EPS * radius.max()
    for places in moving.places.values():
        np.testing.assert_allclose(places[-1], places[0], atol=64 * EPS * wheel.height)
