"""What an animation runs over: round, there and back, several turns, between limits; where its frames stand."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.animation.frames import closes, course_from, course_of, film_from, film_of, frame_ways, usable

EPS = float(np.finfo(float).eps)


@pytest.mark.parametrize("frames", [2, 3, 12, 13, 60])
def test_frames_on_their_way(frames: int) -> None:
    """Round: evenly, without the end. Back: as many as asked for, each step as long, mirrored."""
    assert frame_ways("round", frames).tolist() == [k / frames for k in range(frames)]
    ways = frame_ways("back", frames)
    steps = np.diff(np.append(ways, ways[0]))
    assert ways[0] == 0.0
    assert np.allclose(ways[1:], ways[1:][::-1], rtol=0.0, atol=2 * EPS)
    if frames % 2 == 0:
        assert ways.max() == 1.0
        assert np.allclose(np.abs(steps), 2.0 / frames, rtol=0.0, atol=2 * EPS)


@pytest.mark.parametrize("frames", [8, 60])
def test_the_last_frame_leads_to_the_first(frames: int) -> None:
    """A crank goes one step from each frame to the next, and from the last to the first: one chord."""
    film = film_of(course_of(ct.example("crank-rocker")), frames)
    assert film.course.loop == "round"
    places = film.motion["position"].sel(point="A").to_numpy()[film.order]
    crank = float(np.hypot(*places[0]))
    steps = np.hypot(*(np.roll(places, -1, axis=0) - places).T)
    assert len(steps) == frames
    assert np.abs(steps - 2.0 * crank * math.sin(math.pi / frames)).max() <= 64 * EPS * crank


def test_there_and_back_every_place_is_passed_twice() -> None:
    film = film_of(course_of(ct.example("double-rocker")), 10)
    assert film.course.loop == "back"
    assert film.order.tolist() == [0, 1, 2, 3, 4, 5, 4, 3, 2, 1]
    assert film.places[[0, -1]].tolist() == film.course.places[[0, -1]].tolist()
    assert film.course.seconds == pytest.approx(2 * float(np.ptp(film.course.motion["time"].to_numpy())))


def test_limits_are_those_of_the_mechanism() -> None:
    """Both limits next to the initial position, half a percent inside: also that on the far side of a full turn."""
    mechanism = ct.example("slider-between-cranks-locked")
    high, low = ct.motion(mechanism, 1001)["event_value"].to_numpy().tolist()
    low -= math.tau
    course = course_of(mechanism)
    inside = 0.005 * (high - low)
    # two searches for the same limits: to the root of rounding, where the derivative is infinite
    room = 10 * math.sqrt(EPS)
    assert course.places[[0, -1]] == pytest.approx([low + inside, high - inside], abs=room)
    assert course.loop == "back"
    assert (course.left_out, course.asked) == (int((~usable(ct.motion(mechanism))).sum()), 101)
    assert usable(course.motion).all()


def test_a_range_that_is_not_all_reached_is_cut() -> None:
    mechanism = ct.example("slider-between-cranks-locked")
    motion = ct.motion(mechanism, start=0.5, stop=3.0)
    course = course_of(mechanism, start=0.5, stop=3.0)
    reached = int((motion["status"] == 0).sum())
    assert course.motion.sizes["sample"] == reached
    assert course.left_out == motion.sizes["sample"] - reached > 0
    assert course.loop == "back"


def test_of_a_range_without_the_initial_position_the_longest_part_is_shown() -> None:
    mechanism = ct.example("crank-rocker")
    motion = ct.motion(mechanism, 101)
    motion["status"][20:30] = 1
    motion["status"][:1] = 1
    motion["time"] = ("sample", np.linspace(1.0, 2.0, 101))
    course = course_from(mechanism, motion)
    assert course.places.tolist() == motion["drive_value"].to_numpy()[30:, 0].tolist()


@pytest.mark.parametrize(("name", "turns"), [("bevel-pair", 2), ("crank-rocker", 1), ("geared-five-bar", 1)])
def test_gears_come_back_after_several_turns(name: str, turns: int) -> None:
    course = course_of(ct.example(name))
    assert (course.loop, course.turns) == ("round", turns)
    assert closes(course.motion)
    assert abs(course.places[-1] - course.places[0]) == pytest.approx(math.tau * turns)


def test_a_turned_link_is_not_back_although_its_points_are() -> None:
    """A wheel about a fixed point: only its angle tells that it has turned."""
    motion = ct.motion(ct.example("planetary-gear-train"), 3, 0.0, math.tau)
    still = motion.isel(sample=[0, 2]).copy(deep=True)
    still["position"][1] = still["position"][0]
    assert not closes(still)
    still["angle"][1] = still["angle"][0] + math.tau
    assert closes(still)


@pytest.mark.parametrize(("count", "closed"), [(12, True), (12, False)])
def test_frames_of_given_samples(count: int, closed: bool) -> None:
    mechanism = ct.example("crank-rocker")
    motion = ct.motion(mechanism, 49, 0.0, math.tau if closed else 3.0)
    film = film_from(course_from(mechanism, motion), count)
    assert len(film.order) == (count if closed else 2 * count)
    assert np.isin(film.places, motion["drive_value"].to_numpy()).all()


def test_what_does_not_move_is_refused() -> None:
    for samples, said in ((1, "only one position is reached: nothing moves"), (5, "the range is empty")):
        with pytest.raises(ct.InputError, match=said):
            course_of(ct.example("crank-rocker"), samples, 0.5, 0.5)
