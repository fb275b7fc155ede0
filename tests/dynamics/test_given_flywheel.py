"""A flywheel whose inertia is given, and a machine whose mean speed is not."""

from __future__ import annotations

import sys

import pytest

import centrode as ct
from centrode.dynamics.motion_results import study

EPS = sys.float_info.epsilon


def press(**machine: object) -> ct.Mechanism:
    tables = {"shafts": [{"inertia": 2.5}], **machine}
    return ct.Mechanism.model_validate(
        {**{key: getattr(ct.example("six-bar-press"), key) for key in KEYS}, "machine": tables}
    )


KEYS = ("title", "gravity", "frame", "links", "guides", "drives", "loads")


@pytest.mark.parametrize("ratio", [1.0, -3.0])
def test_the_needed_flywheel_gives_the_fluctuation_it_was_made_for(ratio: float) -> None:
    """There and back: J_I for 0.11, on a shaft of its own, then the fluctuation of that J_I."""
    needed = ct.flywheel(press(mean_speed="65 rpm", fluctuation=0.11, flywheel={"ratio": ratio}))
    assert needed.added is not None and needed.inertia is not None
    there = ct.flywheel(press(mean_speed="65 rpm", flywheel={"ratio": ratio, "inertia": needed.added}))
    assert there.fluctuation is None and there.added is None
    assert there.present == pytest.approx(needed.inertia, rel=8 * EPS)
    assert there.obtained == pytest.approx(0.11, rel=1e-11)
    # the sizes of this wheel are those of the one that was needed
    assert there.rim is not None and needed.rim is not None
    assert there.rim.outer == pytest.approx(needed.rim.outer, rel=1e-12)
    assert "fluctuation 0.11" in ct.summary(there)


def test_a_flywheel_that_is_there_counts_in_what_is_needed() -> None:
    needed = ct.flywheel(press(mean_speed="65 rpm", fluctuation=0.11))
    half = ct.flywheel(press(mean_speed="65 rpm", fluctuation=0.11, flywheel={"inertia": 1000}))
    assert half.added == pytest.approx((needed.added or 0.0) - 1000, rel=1e-12)


def test_a_machine_without_mean_speed_has_shafts_alone() -> None:
    """Motion and reactions are those of the drive's own speed; the shafts count in a simulation."""
    shafts = press()
    none = shafts.model_copy(update={"machine": None})
    results = study(shafts, 9)
    assert results.machine is None and not results.refusals
    expected = ct.reactions(none, 9).balancing.values
    assert ct.reactions(shafts, 9).balancing.values == pytest.approx(expected, rel=4 * EPS)
    assert ct.reduce(shafts, 9).attrs["rate_from"] == "drive"
    with pytest.raises(ct.InputError, match="mean_speed is missing"):
        ct.steady_motion(shafts)
    assert ct.parse_mechanism(ct.mechanism_text(shafts)) == shafts


def test_shafts_count_in_a_simulation_without_a_mean_speed() -> None:
    """A crank of 0.5 kg m^2 with a shaft of 0.1 kg m^2 at ratio 5 under 6 N m: epsilon = 6/3."""
    crank = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"crank": {"points": {"O": [0, 0], "A": [1, 0]}, "inertia": 0.5, "mass": 1, "centre": "O"}},
        drives=[{"link": "crank", "start": 0, "speed": 1}],
        machine={"shafts": [{"inertia": 0.1, "ratio": 5}]},
        simulation={"driving": "6", "duration": 2.0, "samples": 3},
    )
    assert ct.simulate(crank).drive_speed.values.ravel() == pytest.approx([0.0, 2.0, 4.0], rel=1e-9)
