"""Shifts by their purpose, the blocking contour, descriptions of pairs."""

from __future__ import annotations

import math

import numpy as np
import pytest

import centrode as ct
from centrode.errors import InputError, MotionError
from centrode.gears.blocking_contour import BLOCKING, CURVES, blocking_contour, margins_of, with_shifts
from centrode.gears.pair_geometry import PairGeometry
from centrode.gears.shift_choice import chosen_shifts, shift_sum_at
from centrode.model.gear_pairs import GEAR_PAIRS, PURPOSES
from centrode.views import gear_pair as gear_pair_view

PAIR = PairGeometry("external", 3.0, (12, 24), (0.0, 0.0))
NEAR = 1e-3
"""Step in a shift with which neighbours of a chosen pair are looked at."""


@pytest.mark.parametrize("teeth", [(12, 24), (15, 60), (20, 21), (30, 90)])
def test_equal_sliding_is_equal_and_keeps_the_sum(teeth: tuple[int, int]) -> None:
    pair = PairGeometry("external", 2.0, teeth, (0.0, 0.0))
    distance = pair.pitch_distance + 0.9
    shifts = chosen_shifts(pair, "equal sliding", distance)
    made = with_shifts(pair, *shifts)
    assert made.wheels[0].sliding == pytest.approx(made.wheels[1].sliding, rel=1e-9)
    assert made.centre_distance == pytest.approx(distance, rel=1e-12)
    assert sum(shifts) == pytest.approx(shift_sum_at(pair, distance), rel=1e-12)


@pytest.mark.parametrize("purpose", ["least sliding", "strength"])
def test_no_neighbour_within_the_bounds_is_better(purpose: str) -> None:
    """The best shifts against every neighbour on a ring, and against a net over the whole contour."""

    def worth(pair: PairGeometry) -> float:
        if purpose == "least sliding":
            return max(abs(wheel.sliding) for wheel in pair.wheels)
        radius = pair.pitch_curvature_radius
        return -radius * float(pair.other_curvature_radius(radius)) / pair.line_length

    def keeps(pair: PairGeometry) -> bool:
        margins = margins_of(pair)
        names = ("undercut_1", "undercut_2", "interference_1", "interference_2", "tip_0.25_1", "tip_0.25_2")
        return all(margins[name] >= 0 for name in (*names, "contact_ratio_1.2"))

    chosen = with_shifts(PAIR, *chosen_shifts(PAIR, purpose))
    margins = margins_of(chosen)
    assert min(margins[name] for name in BLOCKING) >= -1e-9
    assert margins["contact_ratio_1.2"] >= -1e-9
    ring = [
        (chosen.shifts[0] + NEAR * math.cos(a), chosen.shifts[1] + NEAR * math.sin(a))
        for a in np.arange(0, 6.28, 0.05)
    ]
    net = [(x, y) for x in np.linspace(0.2, 1.4, 25) for y in np.linspace(-0.5, 1.5, 25)]
    others = [with_shifts(PAIR, float(x), float(y)) for x, y in (*ring, *net)]
    better = [worth(other) for other in others if keeps(other)]
    assert better
    assert worth(chosen) <= min(better) + 1e-9


def test_no_undercut_is_the_least_shift() -> None:
    first, second = chosen_shifts(PAIR, "no undercut")
    assert first == pytest.approx(1 - 12 * math.sin(math.pi / 9) ** 2 / 2, rel=1e-14)
    assert second == -first
    assert chosen_shifts(PairGeometry("external", 3.0, (20, 40), (0, 0)), "no undercut") == (0.0, 0.0)
    few = chosen_shifts(PairGeometry("external", 3.0, (10, 11), (0, 0)), "no undercut")
    assert few[1] == pytest.approx(1 - 11 * math.sin(math.pi / 9) ** 2 / 2, rel=1e-14)


def test_margins_vanish_on_the_curves_of_the_contour_and_change_their_sign_there() -> None:
    contour = blocking_contour(with_shifts(PAIR, 0.6, 0.36), nodes=15)
    assert set(contour.curves) == set(CURVES)
    seen = 0
    for name, places in contour.curves.items():
        for x, y in places[~np.isnan(places).any(axis=1)]:
            assert margins_of(with_shifts(PAIR, x, y))[name] == pytest.approx(0.0, abs=1e-6), name
            seen += 1
    assert seen > 60
    inside = contour.possible > 0
    assert inside.any()
    assert not inside.all()
    for (row, column), possible in np.ndenumerate(inside):
        pair = with_shifts(PAIR, float(contour.first[row]), float(contour.second[column]))
        fails = not pair.contact_ratio > 1 or any(
            wheel.undercut or wheel.interferes or not wheel.tip_thickness > 0 for wheel in pair.wheels
        )
        assert possible == (not fails)


@pytest.mark.parametrize("name", ct.example_names("gear pair"))
def test_descriptions_are_read_back_exactly_and_compute(name: str) -> None:
    described = ct.example(name)
    assert GEAR_PAIRS.parse(GEAR_PAIRS.text(described)) == described
    results = ct.gear_pair(name)
    assert results.geometry.contact_ratio > 1
    assert "nan" not in ct.summary(results)
    action = results.line_of_action
    assert action.places[0] < 0 < action.places[-1]
    if results.forces is not None and described.moment is not None:
        # The power of the moment is that of the tangential force at the working pitch circle.
        speed = described.speed or 1.0
        assert results.forces.tangential * speed * results.geometry.wheels[
            0
        ].working_pitch / 2 == pytest.approx(described.moment * speed, rel=1e-12)


def pair_text(**keys: object) -> str:
    """A description with these keys in place of its own; a key of None is left out."""
    lines = {"kind": '"gear pair"', "module": '"3 mm"', "teeth": "[12, 24]", "shifts": "[0.6, 0.36]"} | keys
    return "\n".join(f"{key} = {value}" for key, value in lines.items() if value is not None)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"teeth": "[3, 24]"}, "whole number from 4"),
        ({"teeth": "[12.5, 24]"}, "whole number"),
        ({"teeth": '[12, "rak"]'}, 'did you mean "rack"'),
        ({"teeth": "[12]"}, "[pinion, wheel]"),
        ({"shifts": '"equal slidng"'}, "equal sliding"),
        ({"shifts": "[0.6, 9]"}, "between -5 and 5"),
        ({"module": "0"}, "positive"),
        ({"centre_distance": '"57 mm"'}, "both given"),
        ({"internal": "true", "teeth": "[12, 13]"}, "two teeth more"),
        ({"teeth": '[12, "rack"]', "centre_distance": '"57 mm"', "shifts": None}, "a rack has no centre"),
        ({"helix_angle": '"80 deg"'}, "between 0 and 60 deg"),
        ({"rack": "{ addendum = 2 }"}, "pointed"),
        ({"rack": "{ fillet = 0.9 }"}, "does not fit"),
        ({"modul": '"3 mm"', "module": None}, "module"),
        ({"shifts": "[nan, 0]"}, "nan"),
    ],
)
def test_bad_descriptions_say_where_and_what_helps(keys: dict[str, object], said: str) -> None:
    with pytest.raises(InputError) as refusal:
        GEAR_PAIRS.parse(pair_text(**keys), "pair.toml")
    assert said in str(refusal.value)
    assert "pair.toml" in str(refusal.value)


def test_pairs_that_cannot_be() -> None:
    with pytest.raises(InputError, match="the flanks do not touch"):
        ct.gear_pair(GEAR_PAIRS.parse(pair_text(shifts=None, centre_distance='"50 mm"')))
    with pytest.raises(MotionError, match="cannot mesh"):
        ct.gear_pair(GEAR_PAIRS.parse(pair_text(shifts="[-2, -1]")))
    with pytest.raises(MotionError, match="no shifts"):
        ct.gear_pair(GEAR_PAIRS.parse(pair_text(teeth="[5, 5]", shifts='"least sliding"')))


def test_every_purpose_has_a_word_of_the_view() -> None:
    assert set(gear_pair_view.PURPOSES) == set(PURPOSES)
