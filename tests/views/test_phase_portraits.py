"""Phase portraits between samples: an oscillation is an ellipse however few samples its periods have."""

from __future__ import annotations

import numpy as np
import pytest

import centrode as ct
from centrode.sheets.texts import Title
from centrode.views import multibody_motion
from centrode.views.multibody_motion import _between_samples

NO_OCCASIONS = np.empty(0)


@pytest.mark.parametrize("samples", [10, 12.5, 25])
def test_an_oscillation_is_an_ellipse(samples: float) -> None:
    """q = a sin(w t): (q/a)^2 + (q'/(a w))^2 = 1; the chords of the samples are beside it by 1 - cos(pi/n)."""
    a, w = 0.004, 100.0
    time = np.arange(60) * 2 * np.pi / w / samples
    course = a * np.sin(w * time), a * w * np.cos(w * time), -a * w**2 * np.sin(w * time)
    values, speeds, places = _between_samples(time, course, NO_OCCASIONS)
    assert np.array_equal(values[places], course[0]) and np.array_equal(speeds[places], course[1])
    middles = [0.5 * (one[1:] + one[:-1]) for one in (values, speeds)]
    # the remainder of a cubic with slopes is (w dt)^4/384 of the amplitude; a finer chord's sagitta comes on top
    turn = 2 * np.pi / samples
    allowed = turn**4 / 384 * np.sqrt(2.0) + (turn / 8) ** 2 / 8
    for x, y in ((values, speeds), middles):
        assert np.abs(np.hypot(x / a, y / (a * w)) - 1.0).max() < 1.2 * allowed
    coarse = np.hypot(*(0.5 * (one[1:] + one[:-1]) / one.max() for one in course[:2]))
    assert np.abs(coarse - 1.0).max() > 2 * allowed


def test_a_straight_course_stays_as_sampled() -> None:
    time = np.linspace(0.0, 2.0, 21)
    course = 3.0 * time, np.full(21, 3.0), np.zeros(21)
    values, speeds, samples = _between_samples(time, course, NO_OCCASIONS)
    assert np.array_equal(values, course[0]) and np.array_equal(speeds, course[1])
    assert np.array_equal(samples, np.arange(21))


def test_no_curve_leads_over_an_impact() -> None:
    """A ball that bounces at t = 0.25: the chord over the jump of its speed stays, all others become curves."""
    time = np.linspace(0.0, 1.0, 11)
    height = np.where(time < 0.25, 0.5 - 8.0 * time**2, 4.0 * (time - 0.25) - 8.0 * (time - 0.25) ** 2)
    speed = np.where(time < 0.25, -16.0 * time, 4.0 - 16.0 * (time - 0.25))
    course = height, speed, np.full(11, -16.0)
    values, speeds, samples = _between_samples(time, course, np.array([0.25]))
    assert len(values) == 11 + (10 - 1) * 7
    assert np.array_equal(values[samples], height)
    at = int(np.flatnonzero(values == height[2])[0])
    assert values[at + 1] == height[3]
    before, after = np.arange(at + 1), np.arange(at + 1, len(values))
    # parabolas are met by cubics: the energy g h + v^2/2 is that of each flight
    for part, energy in ((before, 8.0), (after, 8.0)):
        assert np.abs(16.0 * values[part] + speeds[part] ** 2 / 2 - energy).max() < 1e-12


def test_the_portrait_of_the_vibrating_screen_is_round() -> None:
    """Its exciter turns a dozen times a second: the corners of its portrait are less than a picture shows."""
    run = ct.simulate(ct.example("vibrating-screen"))
    plot = multibody_motion._portrait(run, Title("screen"), "screen")
    x, y = plot.abscissa.values, plot.rows[0][0].curves[0].values
    step = np.column_stack([np.diff(x) / np.ptp(x), np.diff(y) / np.ptp(y)])
    heading = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
    assert np.abs(np.diff(heading)).max() < np.radians(10.0)
    coordinates = multibody_motion._Coordinates(run)
    coarse = np.column_stack([np.diff(coordinates.course("screen", k)) for k in (0, 1)])
    coarse /= [np.ptp(x), np.ptp(y)]
    assert np.degrees(np.abs(np.diff(np.unwrap(np.arctan2(*coarse.T[::-1]))))).max() > 25.0
