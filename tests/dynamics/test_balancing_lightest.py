"""Counterweights of the least greatest effects: proofs, and nothing near or far that is better."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

import centrode as ct
from balanced import four_bar, rest_of
from centrode.dynamics.balancing.balance import Balance
from centrode.dynamics.balancing.counterweights import Counterweight, with_counterweights
from centrode.dynamics.masses import masses_of
from mechanisms import EPS


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

    golden = (math.sqrt(5) - 1) / 2
    a, b = high - golden * (high - low), low + golden * (high - low)
    at_a, at_b = force(a), force(b)
    for _round in range(38):
        if at_a < at_b:
            high, b, at_b = b, a, at_a
            a = high - golden * (high - low)
            at_a = force(a)
        else:
            low, a, at_a = a, b, at_b
            b = low + golden * (high - low)
            at_b = force(b)
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

    def sum_of(found: Balance) -> float:
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
