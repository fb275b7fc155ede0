"""Forces by hand: polygons close, links are in equilibrium, and three routes give one balancing moment."""

from __future__ import annotations

import cmath
from typing import Any

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import centrode as ct
from burdened import burdened
from centrode.kinematics.preparation import ready
from growing import KINDS, grown, mechanism_of
from growing_higher import higher_descriptions
from mechanisms import EPS, parts_of
from polygonal import (
    OPERATIONS,
    PLANE,
    TYPICAL,
    an_instant,
    assert_closed,
    assert_routes_agree,
    loaded,
    size_of,
)
from samples import examples_at_hand, few


@pytest.mark.parametrize(
    "name",
    [
        name
        for name in examples_at_hand(PLANE)
        if name not in ("three-crank-parallelogram", "six-bar-press-toleranced")
    ],
)
def test_three_routes_on_every_example(name: str) -> None:
    mechanism = loaded(name)
    found = ct.force_polygons(mechanism, an_instant(mechanism))
    assert_routes_agree(found)
    assert_closed(found)
    assert found.levers
    assert {group.kind for group in found.groups} <= set(TYPICAL)


def test_the_examples_have_groups_of_all_kinds() -> None:
    names = ("four-bar-and-slider", "whitworth-quick-return", "scotch-yoke", "tangent-mechanism")
    names += ("third-class-triad", "fourth-class-group", "rolling-wheel-rod")
    found = [ct.force_polygons(loaded(name), an_instant(loaded(name))) for name in names]
    assert {group.kind for one in found for group in one.groups} == set(TYPICAL)


@settings(max_examples=few(12, 40))
@given(st.lists(st.sampled_from(KINDS), min_size=1, max_size=4), st.integers(0, 2**32 - 1))
def test_random_mechanisms(kinds: list[str], seed: int) -> None:
    mechanism = mechanism_of(burdened(grown(kinds, seed), seed))
    try:
        found = ct.force_polygons(mechanism, ready(mechanism).kinematics.path.initial + 0.01)
    except ct.MotionError:
        assume(False)  # it is open there, or at a dead point
    assert_closed(found)
    assert_routes_agree(found)


@settings(max_examples=few(3, 15))
@given(higher_descriptions(), st.integers(0, 2**32 - 1))
def test_random_groups_of_higher_class(parts: dict[str, Any], seed: int) -> None:
    parts.setdefault("guides", [])
    try:
        mechanism = mechanism_of(burdened(parts, seed))
        found = ct.force_polygons(mechanism, ready(mechanism).kinematics.path.initial + 0.01)
    except (ct.InputError, ct.MotionError):
        assume(False)  # a plate on rods may be left loose, or lock
    assert_closed(found)
    assert_routes_agree(found)


def newton_euler(mechanism: ct.Mechanism, at: float) -> dict[str, tuple[complex, float]]:
    """Force [N] and moment about the frame's origin [N m] that each link must get, weight not among them."""
    data = ct.motion(mechanism, at=[at])
    found = {}
    for name, link in mechanism.links.items():
        (point, own), *_more = link.coordinates.items()
        assert isinstance(link.centre, tuple)
        arm = complex(link.centre[0] - own[0], link.centre[1] - own[1])
        arm *= cmath.exp(1j * float(data.angle.sel(link=name)[0]))
        omega = float(data.angular_velocity.sel(link=name)[0])
        epsilon = float(data.angular_acceleration.sel(link=name)[0])
        place, a = (complex(*data[key].sel(point=point).values[0]) for key in ("position", "acceleration"))
        a += (1j * epsilon - omega**2) * arm
        assert mechanism.gravity is not None
        force = (link.mass or 0.0) * (a - complex(*mechanism.gravity))
        moment = ((place + arm).conjugate() * force).imag + (link.inertia or 0.0) * epsilon
        found[name] = force, moment
    return found


def heavy_links(name: str) -> ct.Mechanism:
    """An example whose links are heavy, without any other load."""
    parts = parts_of(loaded(name))
    parts["loads"] = []
    for number, body in enumerate(parts["links"].values()):
        body |= {"mass": 2.0 + number, "centre": [0.2, 0.1 * number], "inertia": 0.3 + 0.1 * number}
    return ct.Mechanism(**parts)


@pytest.mark.parametrize(
    "name",
    ["crank-rocker", "watt-six-bar", "slider-between-cranks", "whitworth-quick-return", "third-class-triad"],
)
def test_every_link_is_in_equilibrium(name: str) -> None:
    """Newton and Euler from the motion, with hinge forces by their names at the places of the hinges."""
    mechanism = heavy_links(name)
    at = an_instant(mechanism)
    found = ct.force_polygons(mechanism, at)
    forces, moments = size_of(found)
    needed = newton_euler(mechanism, at)
    for group in found.groups:
        for polygon in group.link_polygons:
            (body,) = polygon.bodies
            if body not in needed:
                continue
            acting = [vector for vector in polygon.vectors if vector.source == "reaction"]
            force = sum((found.reactions[vector.name] for vector in acting), 0j)
            moment = sum((vector.place.conjugate() * vector.force).imag for vector in acting)
            number = found.names.index(body)
            moment += sum(found.moments.get(vector.name.replace("R", "M"), 0.0) for vector in acting)
            moment += sum(found.balancing.values()) if body == mechanism.drives[0].link else 0.0
            assert number
            assert abs(force - needed[body][0]) <= OPERATIONS * EPS * forces
            assert abs(moment - needed[body][1]) <= OPERATIONS * EPS * moments
