"""Where Coulomb friction holds: closed forms of blocks, ladders, wedges, pins, and the reactions of a slider-crank."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import centrode as ct

G = 9.81


def block(slope: float, **friction: Any) -> ct.Mechanism:
    return ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={"block": {"points": {"B": [0, 0]}, "mass": 2}},
        guides=[
            {
                "point": "B",
                "on": "frame",
                "through": "O",
                "direction": [math.cos(slope), math.sin(slope)],
                "link": "block",
            }
        ],
        drives=[{"guide": "B", "start": 0}],
        loads=[{"kind": "friction", "guide": "B", **friction}],
    )


def test_a_block_stays_on_an_incline_up_to_the_angle_of_friction() -> None:
    found = ct.equilibrium(block(0.3, coefficient=0.2, static_coefficient=0.31))
    assert found.sizes["equilibrium"] == 0
    assert found.friction_holds_everywhere.values.tolist() == [1]
    assert math.isclose(float(found.friction_share), math.tan(0.3) / 0.31, rel_tol=1e-12)
    with pytest.raises(ct.MotionError, match="no equilibrium"):
        ct.equilibrium(block(0.3, coefficient=0.2, static_coefficient=0.309))


def test_a_pin_holds_a_rod_beside_the_vertical() -> None:
    rod = ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": -1}},
        loads=[{"kind": "friction", "point": "O", "coefficient": 0.3, "radius": 0.05}],
    )
    ends = np.sort(ct.equilibrium(rod).friction_band.values[:, :, 0].ravel())
    # m g at the arm l/2 cos a against the moment 0.3 r m g
    half = math.asin(0.3 * 0.05 / 0.5)
    exact = [-math.pi / 2 - half, -math.pi / 2 + half, math.pi / 2 - half, math.pi / 2 + half]
    assert np.allclose(ends, exact, rtol=0, atol=1e-12)


@pytest.mark.parametrize(("floor", "wall"), [(0.3, 0.2), (0.6, 0.6)])
def test_a_ladder_stays_up_to_the_angle_of_its_closed_form(floor: float, wall: float) -> None:
    ladder = ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={
            "ladder": {"points": {"A": [0, 0], "B": [4, 0]}, "mass": 12, "shape": "rod", "centre": [2, 0]}
        },
        guides=[
            {"point": "A", "on": "frame", "through": "O", "direction": [1, 0]},
            {"point": "B", "on": "frame", "through": "O", "direction": [0, 1]},
        ],
        drives=[{"link": "ladder", "start": 1.2}],
        loads=[
            {"kind": "friction", "guide": "A", "coefficient": floor},
            {"kind": "friction", "guide": "B", "coefficient": wall},
        ],
    )
    found = ct.equilibrium(ladder)
    column = found.coordinate.values.tolist().index("ladder")
    ends = np.sort(found.friction_band.values[:, :, column].ravel())
    assert np.min(np.abs(ends - math.atan((1 - floor * wall) / (2 * floor)))) < 1e-12
    assert not found.friction_feeds_itself.values.any()


def wedge(slope: float, coefficient: float) -> ct.Mechanism:
    return ct.Mechanism(
        frame={"points": {"O": [0, 0], "Q": [1, 0]}},
        links={
            "wedge": {"points": {"W": [0, 0]}, "mass": 1},
            "follower": {"points": {"F": [0, 0]}, "mass": 1},
        },
        guides=[
            {"name": "floor", "point": "W", "on": "frame", "through": "O", "direction": [1, 0], "link": "wedge"},
            {"name": "way", "point": "F", "on": "frame", "through": "Q", "direction": [0, 1], "link": "follower"},
            {"name": "face", "point": "F", "on": "wedge", "through": [0, 0],
             "direction": [math.cos(slope), math.sin(slope)]},
        ],
        drives=[{"guide": "floor", "start": 0}],
        loads=[
            {"kind": "force", "point": "F", "vector": [0, -100]},
            {"kind": "friction", "guide": "floor", "coefficient": coefficient},
            {"kind": "friction", "guide": "face", "coefficient": coefficient},
        ],
    )  # fmt: skip


def test_a_wedge_locks_itself_up_to_twice_the_angle_of_friction() -> None:
    found = ct.equilibrium(wedge(0.3, 0.2))
    # with the share s of both frictions it stays where tan(slope / 2) = s mu
    assert math.isclose(float(found.friction_share), math.tan(0.15) / 0.2, rel_tol=1e-11)
    assert found.friction_holds_everywhere.values.tolist() == [1]
    with pytest.raises(ct.MotionError, match="no equilibrium"):
        ct.equilibrium(wedge(0.3, 0.99 * math.tan(0.15)))


def slider_crank(start: float = 1.0, speed: float = 1.0) -> ct.Mechanism:
    pin = {"kind": "friction", "coefficient": 0.2, "radius": 0.02}
    return ct.Mechanism(
        gravity=[0, -G],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 0.1, "mass": 0.1, "shape": "rod"},
            "AB": {"length": 0.3, "mass": 0.1, "shape": "rod"},
            "slider": {"points": ["B"], "mass": 1},
        },
        guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "slider"}],
        drives=[{"link": "OA", "start": start, "speed": speed}],
        assembly={"sides": {"B": "ahead"}},
        loads=[
            {"kind": "force", "guide": "B", "value": -100},
            *({**pin, "point": point} for point in "OAB"),
            {"kind": "friction", "guide": "B", "coefficient": 0.2, "length": 0.05, "height": 0.03},
        ],
    )


def test_where_friction_ends_to_hold_a_slider_crank_its_drive_takes_no_moment() -> None:
    """`ct.reactions` finds friction of a slow motion by another route: beyond the end the drive would have to hold."""
    found = ct.equilibrium(slider_crank())
    ends = found.friction_band.values[:, :, found.coordinate.values.tolist().index("OA")].ravel()
    assert len(ends) == 4
    for end in ends:
        moments = [
            abs(float(ct.reactions(slider_crank(float(end), speed)).balancing.values.ravel()[0]))
            for speed in (1e-6, -1e-6)
        ]
        # in one sense it begins to move, against the other it takes some newton metres
        assert min(moments) < 1e-9 and max(moments) > 1.0


def test_with_two_freedoms_friction_reaches_as_far_as_the_same_force_does() -> None:
    def pair(**friction: Any) -> ct.Mechanism:
        return ct.Mechanism(
            gravity=[0, -G],
            frame={"points": {"O": [0, 0], "W": [-1, 0]}},
            links={
                "cart": {"points": {"P": [0, 0]}, "mass": 3},
                "PA": {"length": 1, "mass": 1, "shape": "rod"},
            },
            guides=[{"point": "P", "on": "frame", "through": "O", "direction": [1, 0], "link": "cart"}],
            drives=[{"guide": "P", "start": 0}, {"link": "PA", "start": -1.3}],
            loads=[
                {"kind": "spring", "points": ["W", "P"], "stiffness": 40, "free_length": 1},
                {"kind": "friction", "guide": "P", **friction},
            ],
        )

    pressed, given = ct.equilibrium(pair(coefficient=0.1)), ct.equilibrium(pair(value=0.1 * 4 * G))
    assert np.allclose(pressed.friction_reach, given.friction_reach, rtol=1e-10)
    assert np.allclose(pressed.friction_reach[0, 0], 0.1 * 4 * G / 40, rtol=1e-10)


def test_a_running_belt_has_no_rest() -> None:
    with pytest.raises(ct.CentrodeError, match="a belt that runs"):
        ct.equilibrium(block(0.1, coefficient=0.3, surface_speed=0.2))
