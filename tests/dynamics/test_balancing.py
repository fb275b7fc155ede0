"""Counterweights: forces at rest, the closed forms of the books, proofs of the least maximum, what cannot be done."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import centrode as ct
from centrode.dynamics.balancing.counterweights import Counterweight, with_counterweights
from centrode.dynamics.masses import masses_of
from centrode.kinematics.ready import ready
from mechanisms import EPS, rounding, solve_evenly

SPEED = 12.0


def body(points: dict[str, list[float]], random: np.random.Generator, *, in_line: bool = False) -> Any:
    """A link with random mass and inertia, its centre anywhere near it or on its line."""
    reach = max(x for x, _y in points.values())
    across = 0.0 if in_line else float(random.uniform(-0.3, 0.3)) * reach
    return {
        "points": points,
        "mass": float(random.uniform(0.5, 4.0)),
        "centre": [float(random.uniform(0.1, 0.9)) * reach, across],
        "inertia": float(random.uniform(0.05, 0.2)) * reach**2,
    }


def four_bar(seed: int, *, in_line: bool = False, pendulum: float | None = None) -> ct.Mechanism:
    """A crank-rocker with random masses, in any place; the coupler's inertia as that of two masses, times a factor."""
    random = np.random.default_rng(seed)
    crank, coupler, rocker, ground = 1.0, *random.uniform(2.6, 3.4, 2).tolist(), 3.2
    turn, x, y = random.uniform(-2.0, 2.0, 3).tolist()
    links = {
        "OA": body({"O": [0, 0], "A": [crank, 0]}, random, in_line=in_line),
        "AB": body({"A": [0, 0], "B": [coupler, 0]}, random, in_line=in_line),
        "DB": body({"D": [0, 0], "B": [rocker, 0]}, random, in_line=in_line),
    }
    if pendulum is not None:
        r = links["AB"]["centre"][0]
        links["AB"]["inertia"] = pendulum * links["AB"]["mass"] * r * (coupler - r)
    return ct.Mechanism(
        frame={"points": {"O": [x, y], "D": [x + ground * math.cos(turn), y + ground * math.sin(turn)]}},
        links=links,
        drives=[{"link": "OA", "start": float(random.uniform(-3, 3)), "speed": SPEED}],
        assembly={"sides": {"B": "left" if seed % 2 else "right"}},
    )


def rest_of(mechanism: ct.Mechanism, samples: int = 73) -> float:
    """What rounding may leave of the shaking force: accelerations as far as their digits reach, times all masses."""
    solved = solve_evenly(ready(mechanism), samples)
    scale = solved.ready.kinematics.path.scale
    reach = scale + max(
        (math.hypot(*one.centre) for one in mechanism.links.values() if isinstance(one.centre, tuple)),
        default=0.0,
    )
    mass = sum(one.mass or 0.0 for one in mechanism.links.values())
    rate = max(
        mechanism.machine.mean_speed if mechanism.machine else 0.0, abs(mechanism.drives[0].speed or 0.0)
    )
    return 4 * float(np.max(np.sum(rounding(solved), axis=0))) * reach * mass * rate**2


def static_moment(mechanism: ct.Mechanism, link: str, base: str) -> complex:
    """Mass times place of the centre from a point, in the link's axes."""
    one = mechanism.links[link]
    x, y = one.coordinates[base]
    assert isinstance(one.centre, tuple) and one.mass is not None
    return one.mass * complex(one.centre[0] - x, one.centre[1] - y)


@settings(max_examples=20)
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
@pytest.mark.parametrize("seed", range(3))
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


def moved(mechanism: ct.Mechanism, one: Counterweight, product: complex) -> Counterweight:
    """The counterweight, a mass in one point, with another product of mass and radius."""
    x, y = mechanism.links[one.link].coordinates[one.base]
    at = complex(x, y) + one.radius * product / abs(product)
    return replace(one, mass=abs(product) / one.radius, place=(at.real, at.imag))


def effect(mechanism: ct.Mechanism, counterweights: list[Counterweight], what: str) -> float:
    """The greatest value of an effect with counterweights."""
    changed = with_counterweights(mechanism, masses_of(mechanism), counterweights)
    return float(ct.shaking(changed, samples=2).attrs[f"greatest_{what}"])


def product_of(one: Counterweight) -> complex:
    """Mass times radius as a vector in the link's axes."""
    return one.product * complex(np.exp(1j * one.angle))


def test_no_fraction_is_better_than_the_least_maximum() -> None:
    engine = ct.example("single-cylinder-engine")
    least = ct.balance(engine, to="least")
    best = least.after.attrs["greatest_shaking_force"]
    assert least.bound is not None
    assert least.bound <= best * (1 + 16 * EPS)
    assert best - least.bound <= 2e-8 * best
    for share in (0, 0.3, "1/2", 0.55, 0.6, "2/3", 1):
        by_share = ct.balance(engine, to="fraction", fraction=share).after.attrs["greatest_shaking_force"]
        assert by_share > best
    # by symmetry the best counterweight lies along the crank: a search over its product alone finds it too
    (one,) = least.counterweights
    assert abs(abs(one.angle) - math.pi) <= 1e-4
    low, high = 0.5 * one.product, 1.5 * one.product

    def force(product: float) -> float:
        return effect(engine, [moved(engine, one, complex(-product))], "shaking_force")

    for _round in range(40):
        a, b = low + (high - low) / 3, high - (high - low) / 3
        low, high = (low, b) if force(a) < force(b) else (a, high)
    alone = force((low + high) / 2)
    assert abs(alone - best) <= 4e-8 * best


def test_nothing_near_or_far_is_better() -> None:
    """A problem with two counterweights and bounds: no other ones go below what is proved."""
    mechanism = four_bar(5)
    free = ct.balance(mechanism, to="least", on=["OA"])
    (one,) = free.counterweights
    assert free.bound is not None
    best, random = free.after.attrs["greatest_shaking_force"], np.random.default_rng(2)
    for scale in (1e-3, 0.05, 0.5, 2.0):
        for _try in range(6):
            step = scale * one.product * complex(*random.normal(size=2))
            other = moved(mechanism, one, product_of(one) + step)
            assert effect(mechanism, [other], "shaking_force") >= free.bound * (1 - 1e-12)
    assert best - free.bound <= 2e-8 * best
    held = ct.balance(mechanism, to="least", most=0.4)
    assert all(weight.mass <= 0.4 * (1 + 1e-9) for weight in held.counterweights)
    reached = held.after.attrs["greatest_shaking_force"]
    assert held.bound is not None and reached - held.bound <= 2e-8 * reached
    assert 0 < reached < held.before.attrs["greatest_shaking_force"]


def test_weights_trade_force_for_moment() -> None:
    mechanism = four_bar(8)
    force = ct.balance(mechanism, to="least")
    both = ct.balance(mechanism, to="least", weights=(1, 1, 0))
    assert force.bound is not None and both.bound is None and both.proved

    def sum_of(found: ct.Balance) -> float:
        return sum(
            found.after.attrs[name] / found.before.attrs[name]
            for name in ("greatest_shaking_force", "greatest_shaking_moment")
        )

    assert force.after.attrs["greatest_shaking_force"] <= rest_of(force.balanced)
    assert sum_of(both) < min(sum_of(force), 2.0)
    # a minimum: counterweights nearby are no better
    random = np.random.default_rng(4)
    for _try in range(12):
        near = [
            moved(mechanism, one, product_of(one) + 1e-3 * complex(*random.normal(size=2)))
            for one in both.counterweights
        ]
        there = sum(
            effect(mechanism, near, name) / both.before.attrs[f"greatest_{name}"]
            for name in ("shaking_force", "shaking_moment")
        )
        assert there >= sum_of(both) * (1 - 1e-8)


def test_a_counterweight_beyond_the_coupler() -> None:
    """On a link that is not hinged to the frame its mass counts too; the whole still rests."""
    engine = ct.example("single-cylinder-engine")
    found = ct.balance(engine, on=["rod@A", "crank"], radius={"rod": "60 mm", "crank": "20 mm"})
    rod, crank = found.counterweights
    assert math.isclose(rod.mass, 0.766 * 160 / 60, rel_tol=1e-12)
    turning = 3.2 * 8 / 45 + 0.504 + 0.766 + rod.mass
    assert math.isclose(crank.mass, turning * 45 / 20, rel_tol=1e-12)
    assert found.after.attrs["greatest_shaking_force"] <= rest_of(found.balanced)


@settings(max_examples=8)
@given(st.integers(0, 10_000), st.floats(0.3, 1.0))
def test_discs_balance_the_moment_of_an_in_line_four_bar(seed: int, pendulum: float) -> None:
    """Berkof 1973: the coupler a physical pendulum, discs of the side links with its shares."""
    mechanism = four_bar(seed, in_line=True, pendulum=pendulum)
    found = ct.balance(mechanism, moment=True)
    discs = {disc.link: disc for disc in found.discs}
    coupler = mechanism.links["AB"]
    assert isinstance(coupler.centre, tuple) and coupler.mass and coupler.inertia
    length, r = coupler.coordinates["B"][0], coupler.centre[0]
    missing = coupler.mass * r * (length - r) - coupler.inertia
    exact = {"AB": missing}
    for link, base, end, share in (("OA", "O", "A", 1 - r / length), ("DB", "D", "B", r / length)):
        heavy = ct.balance(mechanism).balanced.links[link]
        assert isinstance(heavy.centre, tuple) and heavy.mass and heavy.inertia
        arm = heavy.coordinates[end][0]
        exact[link] = (
            heavy.inertia + heavy.mass * abs(complex(*heavy.centre)) ** 2 + share * coupler.mass * arm**2
        )
        assert discs[link].base == base
    whole = sum(exact.values())
    for link, inertia in exact.items():
        got = discs[link].inertia if link in discs else 0.0
        assert abs(got - inertia) <= 1e-8 * whole
    rest = rest_of(found.balanced)
    rate = SPEED**2 * float(np.max(rounding(solve_evenly(ready(mechanism), 37))[2])) * whole
    assert found.after.attrs["greatest_shaking_force"] <= rest
    assert found.after.attrs["greatest_shaking_moment"] <= 100 * (rate + 10 * rest)
    assert found.before.attrs["greatest_shaking_moment"] > 1e3 * (rate + rest)


@pytest.mark.parametrize("weighs", [True, False])
def test_a_disc_on_a_coupler_whose_inertia_a_shape_tells(weighs: bool) -> None:
    """A rod has m l^2/12, and a coupler needs m l^2/4: the disc on it adds m l^2/6. One without mass needs none."""
    coupler = {"mass": 1.4, "shape": "rod"} if weighs else {}
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [0.4, 0.0]}},
        links={
            "OA": {"length": 0.1, "mass": 0.9, "shape": "rod"},
            "AB": {"length": 0.4, **coupler},
            "DB": {"length": 0.3, "mass": 1.1, "shape": "rod"},
        },
        drives=[{"link": "OA", "start": 1.0, "speed": SPEED}],
        assembly={"sides": {"B": "left"}},
    )
    found = ct.balance(mechanism, moment=True)
    discs = {disc.link: disc.inertia for disc in found.discs if disc.base is None}
    assert discs == ({"AB": pytest.approx(1.4 * 0.4**2 / 6, rel=1e-8)} if weighs else {})
    assert found.balanced.links["AB"].shape is None or not discs
    # as much of the moment as the discs are apart from what they should be
    before, after = (data.attrs["greatest_shaking_moment"] for data in (found.before, found.after))
    assert after <= 1e-8 * before


def test_discs_that_are_not_to_be_had() -> None:
    with pytest.raises(ct.MotionError, match="no discs balance"):
        ct.balance(four_bar(1), moment=True)
    with pytest.raises(ct.MotionError, match=r"the inertia of AB is .* too great"):
        ct.balance(four_bar(1, in_line=True, pendulum=1.5), moment=True)
    with pytest.raises(ct.InputError, match="only where the force is balanced fully"):
        ct.balance(four_bar(1), to="least", moment=True)


def test_discs_as_counterweights() -> None:
    engine = ct.example("single-cylinder-engine")
    touching = ct.balance(engine, on=["crank"], to="least", thickness="20 mm")
    (one,) = touching.counterweights
    assert one.disc is not None
    assert math.isclose(one.disc, one.radius, rel_tol=1e-12)
    assert math.isclose(one.mass, 7800 * 0.02 * math.pi * one.disc**2, rel_tol=1e-12)
    assert math.isclose(one.inertia, one.mass * one.disc**2 / 2, rel_tol=1e-12)
    least = one.inertia + one.mass * one.radius**2
    for factor in (0.7, 0.9, 1.1, 1.5):
        radius = {"crank": factor * one.radius}
        beside = ct.balance(engine, on=["crank"], to="least", thickness="20 mm", radius=radius)
        (other,) = beside.counterweights
        # the same product, to what is left of the search
        assert math.isclose(other.product, one.product, rel_tol=1e-3)
        scaled = (one.product / other.product) ** 2 * (other.inertia + other.mass * other.radius**2)
        assert scaled > least
    # half an inch of lead is not half an inch of steel
    lead = ct.balance(engine, on=["crank"], to="least", thickness="20 mm", density="11.3 g/cm^3")
    assert lead.counterweights[0].disc is not None and lead.counterweights[0].disc < one.disc


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
    text = ct.example_text("scotch-yoke")
    yoke = ct.parse_mechanism(text)
    slid = next(guide.link for guide in yoke.guides if guide.link is not None)
    heavy = yoke.model_copy(
        update={
            "links": {**yoke.links, slid: yoke.links[slid].model_copy(update={"mass": 2.0, "centre": "H"})}
        }
    )
    with pytest.raises(ct.MotionError, match=f"hinges alone do not lead from the frame to {slid}"):
        ct.balance(heavy)
    found = ct.balance(heavy, to="least")
    before, after = (data.attrs["greatest_shaking_force"] for data in (found.before, found.after))
    assert abs(after / before - 0.5) <= 1e-7
    with pytest.raises(ct.InputError, match="slider-cranks only"):
        ct.balance(heavy, to="fraction")


@pytest.mark.parametrize(
    ("change", "error", "reason"),
    [
        ({"to": "half"}, ct.InputError, "no way to balance"),
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
        ({"on": ["OA"]}, ct.MotionError, "do not balance its force"),
        ({"to": "least", "weights": (0, 0, 0)}, ct.InputError, "not all zero"),
        ({"to": "least", "weights": (1, -1, 0)}, ct.InputError, "none negative"),
        ({"to": "least", "weights": (1, 0)}, ct.InputError, "three numbers"),
        ({"to": "fraction"}, ct.InputError, "slider-cranks only"),
        ({"to": "fraction", "fraction": 1.5}, ct.InputError, "from 0 to 1"),
        ({"about": "Z"}, ct.InputError, "no point of the frame"),
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
    text = ct.example_text("double-rocker").replace("length", 'mass = 1\nshape = "rod"\nlength')
    with pytest.raises(ct.MotionError, match="does not turn fully"):
        ct.balance(ct.parse_mechanism(text))
    with pytest.raises(ct.InputError, match="one drive, the mechanism has 2"):
        ct.balance(with_masses("two-link-arm", 1))
    with pytest.raises(ct.InputError, match="no whole turn"):
        ct.balance(with_masses("scissor-lift-cylinder", 1))
    law = four_bar(3).model_copy(update={"drives": (ct.Drive(link="OA", law="t^2"),)})
    with pytest.raises(ct.InputError, match="constant speed"):
        ct.balance(law)
