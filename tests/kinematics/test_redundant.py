"""Constraints that repeat others: parallelograms of three cranks, one on the other, and bars that do not fit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode import render
from centrode.topics.presentation import sheet_of

EPS = 2.0**-52
LOWER, UPPER, WIDTH = 1.0, 1.2, 2.0
OPERATIONS = 64
"""Roundings on the way to a point of the second stage, with the derivatives' sums: a dozen a link, five links."""


def double_parallelogram(**lengths: float) -> ct.Mechanism:
    """Two parallelograms one on the other, each with a third crank in its middle that repeats the other two."""
    cranks = {"OA": LOWER, "DB": LOWER, "FG": LOWER, "AC": UPPER, "BE": UPPER, "GH": UPPER} | lengths
    links: dict[str, Any] = {name: {"length": length} for name, length in cranks.items()}
    for name, points in (("table", "AGB"), ("top", "CHE")):
        links[name] = {"points": {point: [k * WIDTH / 2, 0.0] for k, point in enumerate(points)}}
    return ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "F": [WIDTH / 2, 0.0], "D": [WIDTH, 0.0]}},
        links=links,
        drives=[
            {"link": "OA", "start": 0.7, "speed": 1.0},
            {"link": "AC", "start": 1.9, "speed": -0.5},
        ],
        assembly={"sides": {"B": "right", "E": "right"}},
    )


def test_two_parallelograms_move_by_two_drives() -> None:
    checked = ct.check(double_parallelogram())
    assert checked.mobility == 2
    # Chebyshev counts the two cranks in the middle as constraints of their own: 2 less
    rows = dict(render.fact_rows(sheet_of(checked).facts, checked.mechanism.display))
    assert rows["mobility"].endswith("= 0")
    assert rows["redundant constraints"] != "none"


def test_two_parallelograms_against_their_closed_form_through_change_points() -> None:
    motion = ct.motion(double_parallelogram(), samples=721, start=0.0, stop=4.0 * np.pi)
    assert (motion.status == ct.Status.OK).all()
    assert (motion.event_kind == 1).all()
    # the lower cranks lie along the frame four times, the upper ones along their table twice
    assert motion.sizes["event"] >= 6
    first, second = motion.drive_value.values.T
    table = LOWER * np.exp(1j * first)
    top = table + UPPER * np.exp(1j * second)
    found = motion.position.values[..., 0] + 1j * motion.position.values[..., 1]
    for name, exact in (
        ("A", table),
        ("G", table + WIDTH / 2),
        ("B", table + WIDTH),
        ("C", top),
        ("E", top + WIDTH),
    ):
        place = found[:, list(motion.point.values).index(name)]
        # conventions 25: next to change points interpolation is good to 1e-12 for linkages of size 1
        assert np.abs(place - exact).max() <= WIDTH * (OPERATIONS * EPS + 1e-12), name
    assert float(motion.residual.max()) <= 1e-12
    assert np.abs(motion.angle.sel(link="table")).max() <= 1e-12


@pytest.mark.parametrize(("bar", "length"), [("FG", LOWER), ("GH", UPPER)])
@pytest.mark.parametrize("off", [1e-3, -1e-3, 1e-6])
def test_a_bar_of_wrong_length_is_refused_with_its_residual(bar: str, length: float, off: float) -> None:
    with pytest.raises(ct.InputError, match="the residual of this constraint is") as caught:
        ct.motion(double_parallelogram(**{bar: length + off}))
    assert f"length of link {bar}: " in str(caught.value)
    assert f"residual of this constraint is {abs(off):.3g} m; it repeats other constraints" in str(
        caught.value
    )


def test_bars_of_wrong_length_in_a_batch_are_open() -> None:
    """The description fits; what a batch makes of it need not: nothing is given there."""
    lengths = np.array([LOWER, LOWER + 1e-3, LOWER])
    motion = ct.motion(
        double_parallelogram(), samples=5, start=0.0, stop=1.0, vary={"links.FG.length": lengths}
    )
    assert (motion.status.values[[0, 2]] == ct.Status.OK).all()
    assert (motion.status.values[1] == ct.Status.OPEN).all()
    assert np.isnan(motion.position.values[1]).all()


@pytest.mark.parametrize("start", [0.272, 0.3, 0.35])
def test_a_limit_next_to_the_start_where_constraints_repeat(start: float) -> None:
    """Constraints that repeat others are looked at next to the start too, where a slot may be out of reach."""
    offset, away = 0.6, 1.5 - complex(np.cos(start), np.sin(start))
    turn = float(np.angle(away) - np.arcsin(offset / abs(away)))
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "F": [1.5, 0.0]}},
        links={
            "OA": {"length": 1.0},
            "twin": {"points": {"O": [0.0, 0.0], "A": [1.0, 0.0]}},
            "slotted": {"points": {"A": [0.0, 0.0]}, "angle": turn},
        },
        guides=[{"point": "F", "on": "slotted", "through": [0.0, offset], "direction": 0.0}],
        drives=[{"link": "OA", "start": start, "speed": 1.0}],
    )
    limit = float(np.arccos((1.0 + 1.5**2 - offset**2) / 3.0))  # |AF| is the offset
    assert start - limit < 0.13  # one of the places that are looked at lies beyond
    found = ct.motion(mechanism, samples=5, start=start, stop=start + 0.3)
    assert (found.status == ct.Status.OK).all()
    assert ct.check(mechanism).mobility == 1
