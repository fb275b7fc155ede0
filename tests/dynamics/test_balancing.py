"""Counterweights: forces at rest, the closed forms of the books, proofs of the least maximum, what cannot be done."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import centrode as ct
from balanced import four_bar, rest_of
from centrode.kinematics.preparation import ready
from centrode.model.examples import example_text
from mechanisms import EPS, rounding, solve_evenly
from samples import few


def static_moment(mechanism: ct.Mechanism, link: str, base: str) -> complex:
    """Mass times place of the centre from a point, in the link's axes."""
    one = mechanism.links[link]
    x, y = one.coordinates[base]
    assert isinstance(one.centre, tuple) and one.mass is not None
    return one.mass * complex(one.centre[0] - x, one.centre[1] - y)


@settings(max_examples=few(3, 20))
@given(st.integers(0, 10_000))
def test_a_four_bar_is_balanced_as_berkof_and_lowen_say(seed: int) -> None:
    mechanism = four_bar(seed)
    found = ct.balance(mechanism)
    assert [one.link for one in found.counterweights] == ["OA", "DB"]
    assert found.unique
    rest = rest_of(found.balanced)
    assert float(found.after.shaking_force_size.max()) <= rest
    assert found.after.attrs["greatest_shaking_force"] <= rest
    assert found.before.attrs["greatest_shaking_force"] > 1e6 * rest  # so that this says something
    # m1 r1 = m2 r2' a1/a2 with theta1 = theta2', m3 r3 = m2 r2 a3/a2 with theta3 = theta2 + pi
    lengths = {name: one.coordinates[name[1]][0] for name, one in mechanism.links.items()}
    from_a, from_b = (static_moment(mechanism, "AB", end) for end in "AB")
    crank = from_b * lengths["OA"] / lengths["AB"]
    rocker = -from_a * lengths["DB"] / lengths["AB"]
    size = sum(abs(x) for x in (from_a, from_b, crank, rocker)) + abs(static_moment(mechanism, "DB", "D"))
    conditioned = float(np.max(rounding(solve_evenly(ready(mechanism), 37))[0]))
    for link, base, right in (("OA", "O", crank), ("DB", "D", rocker)):
        # the equations are solved by numbers: their condition is that of the rotors, some tens
        assert abs(static_moment(found.balanced, link, base) - right) <= 100 * (conditioned + EPS) * size


def with_masses(name: str, seed: int) -> ct.Mechanism:
    """A built-in mechanism with random masses on its links."""
    random = np.random.default_rng(seed)
    mechanism = ct.example(name)
    links = {}
    for link, one in mechanism.links.items():
        reach = max(math.hypot(*xy) for xy in one.coordinates.values()) or 1.0
        links[link] = one.model_copy(
            update={
                "mass": float(random.uniform(0.5, 3.0)),
                "centre": tuple(random.uniform(-0.2, 0.8, 2) * reach),
                "inertia": float(random.uniform(0.1, 0.5)) * reach**2,
            }
        )
    return mechanism.model_copy(update={"links": links})


@pytest.mark.parametrize(
    ("name", "count"),
    [("watt-six-bar", 3), ("stephenson-six-bar", 3), ("slider-crank-offset", 2), ("four-bar-and-slider", 3)],
)
@pytest.mark.parametrize("seed", range(few(1, 3)))
def test_half_as_many_counterweights_as_links_are_enough(name: str, count: int, seed: int) -> None:
    """Of a linkage with hinges and n links with the frame, n/2 counterweights (Tepper and Lowen 1972)."""
    found = ct.balance(with_masses(name, seed))
    assert len(found.counterweights) == count
    assert found.after.attrs["greatest_shaking_force"] <= rest_of(found.balanced)
    assert ct.parse_mechanism(ct.mechanism_text(found.balanced)) == found.balanced


def test_the_press_is_balanced_by_three() -> None:
    """CD carries DH and the slider at D, half of the coupler's mass, and its own centre: all by hand."""
    found = ct.balance(ct.example("six-bar-press"))
    by_link = {one.link: one for one in found.counterweights}
    at_d = 22 + 3.5 + by_link["DH"].mass
    exact = {"OA": 4.5 * 0.347, "DH": (22 * 0.85 + 3.5 * 1.7), "CD": 16 * 0.85 + 4.5 * 0.85 + at_d * 1.7}
    assert by_link.keys() == exact.keys()
    for link, product in exact.items():
        assert abs(by_link[link].product - product) <= 1e-12 * sum(exact.values())
        assert abs(abs(by_link[link].angle) - math.pi) <= 1e-12
    assert found.after.attrs["greatest_shaking_force"] <= rest_of(found.balanced)
    # honest: moment and drive get worse
    assert found.after.attrs["greatest_shaking_moment"] > 2 * found.before.attrs["greatest_shaking_moment"]
    assert found.before.attrs["turns_of_cycle"] == 1


def test_at_the_real_speed_the_force_is_zero_too() -> None:
    found = ct.balance(ct.example("six-bar-press"), speed="steady")
    assert found.after.attrs["greatest_shaking_force"] <= 2 * rest_of(found.balanced)
    assert found.before.attrs["speed"] == found.after.attrs["speed"] == "steady"


def test_a_parallelogram_can_be_balanced_in_many_ways() -> None:
    """Crank and rocker turn alike, so one of them is enough, and both share the work as they like."""
    heavy = with_masses("parallelogram", 1)
    one, both = ct.balance(heavy), ct.balance(heavy, on=["OA", "DB"])
    assert len(one.counterweights) == 1 and one.unique
    assert len(both.counterweights) == 2 and not both.unique
    for found in (one, both):
        assert found.after.attrs["greatest_shaking_force"] <= rest_of(found.balanced)
    # of all ways the one with the least products: half and half
    first, second = both.counterweights
    assert math.isclose(first.product, second.product, rel_tol=1e-9)
    assert math.isclose(first.product + second.product, one.counterweights[0].product, rel_tol=1e-9)


@pytest.mark.parametrize("to", ["full", "least"])
def test_results_go_with_lengths_and_masses(to: Any) -> None:
    """Lengths 1000 times, masses 50 times as great: products 50000 times, and the centres in the same places."""
    linkage = ct.example("in-line-four-bar")
    links = {
        name: {
            "length": 1000 * one.length,
            "mass": 50 * one.mass,
            "centre": [1000 * one.centre[0], 0],
            "inertia": 5e7 * one.inertia,
        }
        for name, one in linkage.links.items()
    }
    great = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [400, 0]}},
        links=links,
        drives=linkage.drives,
        assembly=linkage.assembly,
    )
    asked: dict[str, Any] = {"to": to, "on": ["OA"]} if to == "least" else {"to": to}
    small, large = ct.balance(linkage, **asked), ct.balance(great, **asked)
    # the least maximum is found to 1e-8, its place to the root of that where it is flat
    close = 1e-9 if to == "full" else 1e-4
    for one, other in zip(small.counterweights, large.counterweights, strict=True):
        assert math.isclose(other.product, 5e4 * one.product, rel_tol=close)
        assert math.isclose(other.radius, 1000 * one.radius, rel_tol=1e-12)
    before = [data.before.attrs["greatest_shaking_force"] for data in (small, large)]
    assert math.isclose(before[1], 5e4 * before[0], rel_tol=1e-9)
    if to == "least":
        after = [data.after.attrs["greatest_shaking_force"] for data in (small, large)]
        assert math.isclose(after[1], 5e4 * after[0], rel_tol=4e-8)


def test_a_massless_mechanism_but_for_its_slider() -> None:
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0, 0]}},
        "links": {"OA": {"length": 0.1}, "AB": {"length": 0.3}, "C": {"points": ["B"], "mass": 2}},
        "guides": [{"point": "B", "through": [0, 0], "direction": [1, 0], "link": "C"}],
        "drives": [{"link": "OA", "start": 1, "speed": 5}],
        "assembly": {"sides": {"B": "ahead"}},
    }
    found = ct.balance(ct.Mechanism(**parts))
    assert found.after.attrs["greatest_shaking_force"] <= rest_of(found.balanced)
    assert {one.link: round(one.product, 12) for one in found.counterweights} == {"OA": 0.6, "AB": 0.6}


def test_scotch_yokes_are_not_to_be_balanced() -> None:
    """Counterweights turn, a yoke moves to and fro: the crank balances at best half of it at every instant."""
    text = example_text("scotch-yoke")
    yoke = ct.parse_mechanism(text)
    slid = next(guide.link for guide in yoke.guides if guide.link is not None)
    heavy = yoke.model_copy(
        update={
            "links": {**yoke.links, slid: yoke.links[slid].model_copy(update={"mass": 2.0, "centre": "H"})}
        }
    )
    with pytest.raises(ct.MotionError, match=f"no chain of hinges connects the frame and {slid}"):
        ct.balance(heavy)
    found = ct.balance(heavy, to="least")
    before, after = (data.attrs["greatest_shaking_force"] for data in (found.before, found.after))
    assert abs(after / before - 0.5) <= 1e-7
    with pytest.raises(ct.InputError, match="slider-cranks only"):
        ct.balance(heavy, to="fraction")


@pytest.mark.parametrize(
    ("change", "error", "reason"),
    [
        ({"to": "half"}, ct.InputError, "is not a balancing method"),
        ({"on": []}, ct.InputError, "0 links were named"),
        ({"on": ["OX"]}, ct.InputError, "there is no link"),
        ({"on": ["OA@Z"]}, ct.InputError, "has no point"),
        ({"on": ["OA", "OA"]}, ct.InputError, "given twice"),
        ({"radius": 0}, ct.InputError, "must be positive"),
        ({"radius": "3 kg"}, ct.InputError, "radius"),
        ({"radius": {"XY": 1}}, ct.InputError, "no counterweight on"),
        ({"thickness": -1}, ct.InputError, "must be positive"),
        ({"density": "steel"}, ct.InputError, "density"),
        ({"most": "0.1 g"}, ct.MotionError, "more than 0.0001 kg"),
        ({"on": ["OA"]}, ct.MotionError, "do not balance the shaking force"),
        ({"to": "least", "weights": (0, 0, 0)}, ct.InputError, "not all zero"),
        ({"to": "least", "weights": (1, -1, 0)}, ct.InputError, "none negative"),
        ({"to": "least", "weights": (1, 0)}, ct.InputError, "three numbers"),
        ({"to": "fraction"}, ct.InputError, "slider-cranks only"),
        ({"to": "fraction", "fraction": 1.5}, ct.InputError, "from 0 to 1"),
        ({"about": "Z"}, ct.InputError, "is not a point of the frame"),
        ({"speed": "steady"}, ct.InputError, r"\[machine\]"),
        ({"speed": "quick"}, ct.InputError, "not a speed"),
    ],
)
def test_wrong_arguments_are_refused(change: dict[str, Any], error: type[Exception], reason: str) -> None:
    with pytest.raises(error, match=reason):
        ct.balance(four_bar(3), **change)


def test_wrong_mechanisms_are_refused() -> None:
    with pytest.raises(ct.InputError, match="no link has a mass"):
        ct.balance(ct.example("crank-rocker"))
    with pytest.raises(ct.NotComputedYet, match="sphere"):
        ct.balance(ct.example("spherical-four-bar"))
    text = example_text("double-rocker").replace("length", 'mass = 1\nshape = "rod"\nlength')
    with pytest.raises(ct.MotionError, match="does not turn fully"):
        ct.balance(ct.parse_mechanism(text))
    with pytest.raises(ct.InputError, match="one drive, the mechanism has 2"):
        ct.balance(with_masses("two-link-arm", 1))
    with pytest.raises(ct.InputError, match="no full turn"):
        ct.balance(with_masses("scissor-lift-cylinder", 1))
    law = four_bar(3).model_copy(update={"drives": (ct.Drive(link="OA", law="t^2"),)})
    with pytest.raises(ct.InputError, match="constant speed"):
        ct.balance(law)
