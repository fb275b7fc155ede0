"""Equilibria on rigid stops, against closed forms of rods and of a slider-crank."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.errors import InputError, MotionError

G = 9.81
ROD = {"length": 1, "mass": 1, "shape": "rod"}


def rod(angle: float = 0.2, **parts: object) -> ct.Mechanism:
    return ct.Mechanism(
        gravity=[0, -G], frame={"points": {"O": [0, 0]}}, links={"OA": {**ROD, "angle": angle}}, **parts
    )


def words(found) -> list[str]:
    names = found.stability.attrs["flag_meanings"].split()
    return [names[k] for k in found.stability.values]


def test_a_rod_leans_on_either_stop_and_is_unstable_upright():
    found = ct.equilibrium(rod(stops=[{"link": "OA", "least": -0.5, "most": 2.5}]))
    assert np.allclose(found.angle[:, 0], [math.pi / 2, -0.5, 2.5], rtol=0.0, atol=1e-12)
    assert words(found) == ["unstable", "stable", "stable"]
    moments = [0.0, 0.5 * G * math.cos(0.5), 0.5 * G * math.cos(2.5)]
    assert np.allclose(found.restraint_force[:, 0], moments, rtol=0.0, atol=1e-12)
    assert found.restraint_force.attrs["units"] == "N m"
    assert found.contact.values.tolist() == ["stop OA"]


def test_a_stop_that_would_have_to_pull_holds_nothing():
    # at 1.2 rad the rod falls away from the bound above, and rests on the one below alone
    found = ct.equilibrium(rod(stops=[{"link": "OA", "least": -0.5, "most": 1.2}]))
    assert np.allclose(found.angle[:, 0], [-0.5], rtol=0.0, atol=1e-12)
    # a rope that is longer than the rod is never taut
    roped = ct.equilibrium(rod(stops=[{"points": ["O", "A"], "most": 2}]))
    assert np.allclose(np.sort(roped.angle[:, 0]), [-math.pi / 2, math.pi / 2])
    assert "restraint_force" not in roped


def test_a_rod_rests_on_a_floor_on_both_sides():
    found = ct.equilibrium(rod(stops=[{"point": "A", "direction": [0, 2], "least": -0.5, "name": "floor"}]))
    assert np.allclose(found.angle[:, 0], [math.pi / 2, -math.pi / 6, 7 * math.pi / 6], rtol=0.0, atol=1e-12)
    # half the weight at the end, whatever the angle
    assert np.allclose(found.restraint_force[:, 0], [0.0, G / 2, G / 2], rtol=0.0, atol=1e-11)


def test_a_chain_of_two_rods_on_a_floor_is_stable_where_its_first_rod_hangs():
    """With sin a + sin b = -1.5 the energy is g (sin a - 0.75): cos a = 0 is its least, cos b = 0 its greatest."""
    chain = ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {**ROD, "angle": -1.2}, "AB": {**ROD, "angle": -1.3}},
        stops=[{"point": "B", "direction": [0, 1], "least": -1.5}],
    )
    found = ct.equilibrium(chain)
    rests = {
        tuple(np.round(np.sin(row), 9)): (word, float(force))
        for row, word, force in zip(
            found.angle.values, words(found), found.restraint_force.values[:, 0], strict=True
        )
        if force
    }
    assert set(rests) == {(-1.0, -0.5), (-0.5, -1.0)}
    assert rests[-1.0, -0.5] == ("stable", pytest.approx(G / 2, rel=1e-11))
    assert rests[-0.5, -1.0] == ("unstable", pytest.approx(1.5 * G, rel=1e-11))


def test_a_corner_closes_two_stops_at_once():
    slab = ct.Mechanism(
        gravity=[3, -G],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {**ROD, "angle": -0.6}, "AB": {**ROD, "angle": -0.5}},
        stops=[
            {"point": "B", "direction": [0, 1], "least": -1.0, "name": "floor"},
            {"point": "B", "direction": [1, 0], "most": 1.4, "name": "wall"},
        ],
    )
    found = ct.equilibrium(slab)
    both = [k for k in range(found.sizes["equilibrium"]) if np.all(found.restraint_force[k] != 0.0)]
    assert both
    for k in both:
        a, b = found.angle.values[k]
        assert np.allclose([math.cos(a) + math.cos(b), math.sin(a) + math.sin(b)], [1.4, -1.0])
        # both rods in equilibrium: moments about A and about O
        lift, push = found.restraint_force.values[k]
        outer = -math.sin(b) * (push + 1.5) + math.cos(b) * (lift - G / 2)
        inner = -math.sin(a) * (push + 3 + 1.5) + math.cos(a) * (lift - G - G / 2)
        assert abs(outer) < 1e-10
        assert abs(inner) < 1e-10
        assert lift > 0.0 > push
        assert words(found)[k] == "stable"


def test_a_slider_crank_is_pressed_against_its_end_stop_on_both_branches():
    pressed = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 0.1}, "AB": {"length": 0.3}, "slider": {"points": ["B"], "mass": 1}},
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "slider"}],
        drives=[{"link": "OA", "start": "60 deg"}],
        assembly={"sides": {"B": "ahead"}},
        loads=[{"kind": "force", "guide": "B", "value": 20}],
        stops=[{"guide": "B", "most": 0.38}],
    )
    found = ct.equilibrium(pressed)
    on_stop = found.restraint_force.values[:, 0] != 0.0
    assert np.allclose(found.restraint_force.values[on_stop, 0], -20.0, rtol=1e-12)
    # cosine rule for the crank
    angle = math.acos((0.1**2 + 0.38**2 - 0.3**2) / (2 * 0.1 * 0.38))
    assert np.allclose(np.sort(found.drive_value.values[on_stop, 0]), [-angle, angle], rtol=0.0, atol=1e-10)


def test_what_stays_nowhere_and_modes_on_stops_are_refused_by_name():
    # pulled away from its only stop for ever
    sledge = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"block": {"points": {"P": [0, 0]}, "mass": 2}},
        guides=[{"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "block"}],
        drives=[{"guide": "P", "start": 0}],
        loads=[{"kind": "force", "guide": "P", "value": 3}],
        stops=[{"guide": "P", "least": -1}],
    )
    with pytest.raises(MotionError, match="no equilibrium"):
        ct.equilibrium(sledge)
    with pytest.raises(InputError, match="there is 1 equilibrium that rests on no stop, and number 2"):
        ct.modes(rod(stops=[{"link": "OA", "least": -0.5, "most": 2.5}]), equilibrium=2)
