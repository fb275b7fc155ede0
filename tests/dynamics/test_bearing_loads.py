"""Worst cases over a motion: against dense sampling, at jumps from both sides, and closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.bearings.extremes import BearingLoad, bearing_loads
from centrode.dynamics.bearings.reaction_series import reaction_series
from centrode.dynamics.bearings.results import with_bearings
from centrode.dynamics.bearings.wear import bearings
from centrode.dynamics.motion_results import study
from centrode.render.spelling import PlainSpelling
from centrode.topics.presentation import sheet_of
from centrode.views.reactions import loads_table
from mechanisms import parts_of

EPSILON = 2.0**-52


def turning(gravity: float = 0.0, speed: float = 3.0) -> ct.Mechanism:
    """A crank of 2 m whose mass of 5 kg is at 0.5 m."""
    link = {"points": {"O": [0, 0], "A": [2, 0]}, "mass": 5, "centre": [0.5, 0], "inertia": 0.25}
    return ct.Mechanism(
        gravity=[0, -gravity],
        frame={"points": {"O": [0, 0]}},
        links={"OA": link},
        drives=[{"link": "OA", "start": 0, "speed": speed}],
    )


def found(loads: tuple[BearingLoad, ...], key: str) -> BearingLoad:
    return next(one for one in loads if one.key == key)


@pytest.mark.parametrize("name", ["single-cylinder-engine", "in-line-four-bar"])
def test_extremes_lie_between_the_samples(name: str) -> None:
    """Above what twenty times as many samples see, by no more than a parabola over a step can be."""
    mechanism = ct.example(name)
    loads = bearing_loads(mechanism, ct.reactions(mechanism, 73))
    dense = ct.reactions(mechanism, 72 * 20 + 1)
    sizes = {
        one.key: np.hypot(*one.values.T) if one.values.ndim == 2 else one.values
        for one in reaction_series(mechanism, dense)
    }
    assert set(sizes) == {one.key for one in loads}
    for one in loads:
        size = sizes[one.key]
        whole = max(abs(size.max()), abs(size.min()))
        bend = np.abs(np.diff(size, 2))
        for value, sign, extreme in ((one.greatest, 1.0, size.max()), (one.least, -1.0, size.min())):
            # the slope changes by no more than twice the greatest second difference within two steps
            above = sign * (value - extreme)
            assert -1e3 * EPSILON * whole - 1e-6 * bend.max() <= above <= bend.max() + 1e3 * EPSILON * whole


def test_a_place_and_its_direction() -> None:
    engine = ct.example("single-cylinder-engine")
    for one in bearing_loads(engine, ct.reactions(engine, 73)):
        there = ct.reactions(engine, at=[one.at_greatest])
        values = {other.key: other.values[0] for other in reaction_series(engine, there)}
        # the same at another sample of another call: positions are rounded alike, forces by the condition number
        bound = 1e4 * EPSILON * max(abs(one.greatest), abs(one.least), 1e-300)
        value = values[one.key]
        size = float(value) if np.ndim(value) == 0 else math.hypot(*value)
        assert abs(size - one.greatest) <= bound
        if one.direction is not None:
            # a direction is as good as the force across it
            assert (
                abs(math.remainder(math.atan2(value[1], value[0]) - one.direction, math.tau)) <= 1e4 * EPSILON
            )


def test_at_a_jump_the_greater_side_counts() -> None:
    """The load of the press begins at a dead point; a force right behind it is greater than at any sample."""
    press = ct.example("six-bar-press")
    samples = ct.reactions(press, 361)
    one = found(bearing_loads(press, samples), "joint_force_O/OA")
    jumps = ct.reduce(press, 3).jumps.to_numpy()
    step = math.tau / 360
    at = float(jumps[np.argmin(np.abs(np.remainder(jumps - one.at_greatest + math.pi, math.tau) - math.pi))])
    at += math.tau * round((one.at_greatest - at) / math.tau)
    assert abs(one.at_greatest - at) <= 1e-4 * step
    sides = ct.reactions(press, at=[at - 1e-9, at + 1e-9])
    greater = np.hypot(*sides.joint_force.sel(side="O/OA").to_numpy().T)
    size = np.hypot(*samples.joint_force.sel(side="O/OA").to_numpy().T)
    # away from jumps, the force changes by less than this over the width that is left
    slope = np.sort(np.abs(np.diff(size)))[-5] / step
    assert one.greatest > size.max()
    assert abs(one.greatest - greater.max()) <= 2.0 * slope * 1e-4 * step


def test_closed_forms_of_a_turning_mass() -> None:
    """5 kg at 0.5 m: 2.5 w^2 outwards, and with weight greatest at the bottom."""
    still = found(bearing_loads(turning(), ct.reactions(turning(), 37)), "joint_force_O/OA")
    force = 5 * 0.5 * 9.0
    for value in (still.greatest, still.least, still.mean, still.rms):
        assert abs(value - force) <= 100 * EPSILON * force
    heavy = turning(gravity=2.0)
    one = found(bearing_loads(heavy, ct.reactions(heavy, 38)), "joint_force_O/OA")
    step = math.tau / 37 * 1e-4
    # at angle p the pin pulls the link with F^2 = f^2 + w^2 + 2 f w cos(p + 90 deg) about the bottom
    weight = 10.0
    curvature = force * weight / (force + weight) + force * weight / (force - weight)
    assert abs(one.greatest - (force + weight)) <= curvature * step**2 + 100 * EPSILON * force
    assert abs(one.least - (force - weight)) <= curvature * step**2 + 100 * EPSILON * force
    assert abs(math.remainder(one.at_greatest + math.pi / 2, math.tau)) <= step
    assert one.direction is not None
    assert abs(math.remainder(one.direction - math.pi / 2, math.tau)) <= 2 * step
    # mean of F^2 over a turn: f^2 + w^2, which the trapezoid rule has exactly
    assert abs(one.rms - math.hypot(force, weight)) <= 100 * EPSILON * force


def test_words_and_numbers() -> None:
    engine = ct.example("single-cylinder-engine")
    results = with_bearings(engine, ct.reactions(engine, 37))
    loads, spelling = results.loads, PlainSpelling(engine.display)
    assert loads is not None
    columns = loads_table(engine, loads).columns
    assert [spelling.text(column.head) for column in columns[:3]] == ["reaction", "unit", "greatest"]
    assert spelling.text(columns[0].values[0]) == "O: frame on crank"
    assert [len(column.values) for column in columns] == [len(loads)] * 9
    first = [spelling.text(column.values[0]) for column in columns]
    assert first[2:4] == ["9123.92", "0 deg"] and first[4] in ("180.00", "-180.00")
    keys = ct.tables(results)["bearing-loads"].columns[0].values
    assert [spelling.text(key) for key in keys] == [one.key for one in loads]
    scalars = sheet_of(results).scalars
    assert scalars["greatest_joint_force_O/crank"].unit == "N"
    assert scalars["greatest_joint_force_O/crank_at"].unit == "rad"
    assert sheet_of(study(engine, 37)).scalars["mean_joint_force_B/rod"] == scalars["mean_joint_force_B/rod"]


def test_samples_that_are_not_reached_are_left_out() -> None:
    locked = ct.example("slider-between-cranks-locked")
    load = {"kind": "force", "point": "C", "vector": [-10.0, 0.0]}
    loaded = ct.Mechanism(**{**parts_of(locked), "loads": [load]})
    reactions = ct.reactions(loaded, 61)
    assert (reactions.status == ct.Status.OPEN).any()
    loads = bearing_loads(loaded, reactions)
    assert all(math.isfinite(x) for one in loads for x in (one.greatest, one.least, one.mean, one.rms))


def test_one_sample() -> None:
    one = found(bearing_loads(turning(), ct.reactions(turning(), at=[1.0])), "joint_force_O/OA")
    assert one.greatest == one.least == one.mean == one.rms
    assert one.at_greatest == 1.0


def test_with_friction_and_without() -> None:
    """Extremes between samples are those of the reactions that were given."""
    parts = parts_of(ct.example("single-cylinder-engine"))
    rubbing = {"kind": "friction", "guide": "B", "coefficient": 0.1}
    engine = ct.Mechanism(**{**parts, "loads": [rubbing]})
    smooth = bearing_loads(ct.Mechanism(**parts), ct.reactions(ct.Mechanism(**parts), 37))
    without = bearing_loads(engine, ct.reactions(engine, 37, friction=False))
    assert [one.key for one in without] == [one.key for one in smooth]
    for one, other in zip(without, smooth, strict=True):
        assert abs(one.greatest - other.greatest) <= 1e4 * EPSILON * abs(other.greatest)
    reactions = ct.reactions(engine, 37)
    rubbed = found(bearing_loads(engine, reactions), "joint_force_B/rod")
    there = ct.reactions(engine, at=[rubbed.at_greatest]).joint_force.sel(side="B/rod").to_numpy()[0]
    assert abs(math.hypot(*there) - rubbed.greatest) <= 1e-9 * rubbed.greatest


def test_on_the_sphere() -> None:
    """Magnitudes of vectors in space; they have no direction in a plane."""
    linkage = ct.example("spherical-crank-rocker-rigid")
    reactions = ct.reactions(linkage, 37)
    one = found(bearing_loads(linkage, reactions), "joint_force_A/AB")
    dense = ct.reactions(linkage, 36 * 20 + 1).joint_force.sel(side="A/AB").to_numpy()
    size = np.sqrt((dense**2).sum(axis=-1))
    assert one.direction is None
    assert -1e-6 <= (one.greatest - size.max()) / np.abs(np.diff(size, 2)).max() <= 1.0
    with pytest.raises(ct.NotComputedYet, match="sphere"):
        bearings(linkage, reactions)
