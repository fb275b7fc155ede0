"""Masses of spherical links: shapes against mass points, tensors that no body has, what is refused."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import centrode as ct
from centrode.dynamics.masses import masses_of, massless_links
from centrode.dynamics.state import Radial, Spread
from centrode.model.values import principal
from growing_sphere import unit
from mechanisms import EPS
from spherical_bodies import Array, Cloud, triad

FRAME = {"points": {"A": [1, 0, 0], "D": [0, 1, 0]}}
ARM = {"length": 0.7, "reference": ["A", "D"]}
DRIVES = [{"link": "AB", "start": 0.2, "speed": 2}]


def arm(link: dict[str, Any], *loads: dict[str, Any], **more: Any) -> ct.Mechanism:
    """One link that turns about A."""
    parts = {"space": "sphere", "frame": FRAME, "drives": DRIVES, "loads": loads} | more
    return ct.Mechanism(**parts, links={"AB": ARM | link})


def about_centre(mechanism: ct.Mechanism) -> tuple[float, Array]:
    """Mass and sum of m x x about the centre of the sphere, as a matrix in the link's own axes."""
    (mass,) = masses_of(mechanism)
    assert isinstance(mass.centre, Radial)
    assert isinstance(mass.inertia, tuple)
    middle = np.array(mass.centre.direction, dtype=float) * mass.centre.distance
    total = mass.mass * np.outer(middle, middle)
    for part in mass.inertia:
        assert isinstance(part, Spread)
        total += part.moment * np.outer(part.direction, part.direction)
    return mass.mass, total


def spread(cloud: Cloud) -> Array:
    return np.einsum("p,pi,pj->ij", cloud.masses, cloud.places, cloud.places)


NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


@pytest.mark.parametrize("length", [0.02, 0.7, 2.9])
def test_an_arc_is_so_many_mass_points(length: float) -> None:
    mechanism = arm({"length": length, "mass": 3, "shape": "arc"}, radius=0.4)
    along = length / 2 * (1 + NODES)
    cloud = Cloud(1.5 * WEIGHTS, 0.4 * np.stack([np.cos(along), np.sin(along), 0 * along], axis=1))
    mass, total = about_centre(mechanism)
    assert mass == 3
    assert np.max(abs(total - spread(cloud))) <= 64 * EPS * cloud.size
    (found,) = masses_of(mechanism)
    assert isinstance(found.centre, Radial)
    centre = np.array(found.centre.direction) * found.centre.distance
    assert np.max(abs(centre - cloud.centre)) <= 16 * EPS * 0.4


def test_an_arc_of_a_link_with_coordinates() -> None:
    """Between the two farthest of its points, wherever its own axes lie."""
    ends = [unit([0.3, 0.8]), unit([1.9, -0.4])]
    axes = triad(*ends)
    along = float(np.arccos(ends[0] @ ends[1]))
    places = {
        name: axes @ [np.cos(x), np.sin(x), 0] for name, x in (("A", 0), ("M", 0.3 * along), ("B", along))
    }
    points = {name: at.tolist() for name, at in places.items()}
    del ARM["length"]
    try:
        mechanism = arm({"points": points, "mass": 2, "shape": "arc"})
    finally:
        ARM["length"] = 0.7
    angles = along / 2 * (1 + NODES)
    cloud = Cloud(WEIGHTS, np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1) @ axes.T)
    assert np.max(abs(about_centre(mechanism)[1] - spread(cloud))) <= 256 * EPS * cloud.size


@pytest.mark.parametrize("shape", ["disc", "ring"])
def test_discs_and_rings_stand_square_to_their_centre(shape: str) -> None:
    """Gauss's rule over the radius, equal steps around: exact for squares."""
    mechanism = arm(
        {"mass": 3, "shape": shape, "radius": "20 mm", "centre": [0.4, 0.9], "centre_radius": 0.25},
        radius="300 mm",
    )
    normal = unit([0.4, 0.9])
    axes = triad(normal, np.array([1.0, 0.0, 0.0]))
    nodes, weights = np.polynomial.legendre.leggauss(3)
    radii, shares = (
        (0.01 * (1 + nodes), weights * 0.005 * (1 + nodes)) if shape == "disc" else ([0.02], [1.0])
    )
    turns = 2 * pi * np.arange(5) / 5
    places, masses = [], []
    for radius, share in zip(radii, shares, strict=True):
        for turn in turns:
            places.append(axes @ [0.25, radius * np.cos(turn), radius * np.sin(turn)])
            masses.append(share)
    total = np.array(masses) * 3 / np.sum(masses)
    cloud = Cloud(total, np.array(places))
    assert np.max(abs(about_centre(mechanism)[1] - spread(cloud))) <= 64 * EPS * cloud.size


def test_numbers_and_principal_moments_are_tensors() -> None:
    at = {"mass": 2, "centre": [0.1, 0.2], "centre_radius": 0.5}
    ball = about_centre(arm(at | {"inertia": 0.3}))[1]
    same = about_centre(arm(at | {"inertia": [0.3, 0.3, 0.3]}))[1]
    assert np.max(abs(ball - same)) <= 2 * EPS
    tensor = [[0.2, 0, 0], [0, 0.3, 0], [0, 0, 0.4]]
    three = about_centre(arm(at | {"inertia": [0.2, 0.3, 0.4]}))[1]
    assert np.array_equal(three, about_centre(arm(at | {"inertia": tensor}))[1])
    (pointlike,) = masses_of(arm(at | {"inertia": 0}))
    assert pointlike.inertia == ()
    # about x: what is spread along y and z
    alone = arm({"inertia": [0.2, 0.3, 0.4]})
    assert massless_links(alone) == ()
    assert abs(float(ct.reduce(alone, samples=2).reduced_inertia[0]) - 0.2) <= 4 * EPS


def test_a_description_with_masses_comes_back() -> None:
    more = {"gravity": [0, 0, -9.81], "radius": 0.3}
    loads = [
        {"kind": "friction", "link": "AB", "value": 1, "viscous": 2, "quadratic": 3},
        {"kind": "friction", "link": "AB", "quadratic": 3, "form": "plain sum"},
        {"kind": "torque", "link": "AB", "value": 1, "axis": [0, 0, 1]},
        {"kind": "torque", "link": "AB", "value": 1, "axis": "B"},
        {"kind": "force", "point": "B", "vector": [1, "x", 2], "while_moving": [0, 1, 1]},
    ]
    tensor = [[0.2, 0.01, 0], [0.01, 0.3, 0], [0, 0, 0.4]]
    for link in (
        {"mass": 1, "centre": "B", "centre_radius": 0.2, "inertia": tensor},
        {"mass": 1, "centre": [0.1, 0.2], "inertia": [1, 1, 1]},
        {"mass": 1, "shape": "ring", "radius": 0.1, "centre": "A"},
        {"inertia": 1, "centre": "A", "model": "ring and point mass"},
    ):
        mechanism = arm(link, *loads, **more)
        assert ct.parse_mechanism(ct.mechanism_text(mechanism)) == mechanism


@given(arrays(float, (3, 3), elements=st.floats(-3, 3)))
def test_principal_axes_are_those_of_linear_algebra(values: Array) -> None:
    tensor = values + values.T
    moments, axes = principal(tuple(tuple(row) for row in tensor.tolist()))
    found, size = np.array(axes), 16 * EPS * (1 + np.max(abs(tensor)))
    assert np.max(abs(found @ found.T - np.eye(3))) <= 32 * EPS
    assert np.max(abs(found.T @ np.diag(moments) @ found - tensor)) <= 8 * size
    assert np.max(abs(np.sort(moments) - np.linalg.eigvalsh(tensor))) <= 4 * size


HEAVY = {"mass": 1, "centre": "B"}
WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "not positive": (HEAVY | {"inertia": [-1, 2, 2]}, "not positive definite: its principal moments are -1, 2, 2"),
    "indefinite tensor": (
        HEAVY | {"inertia": [[1, 2, 0], [2, 1, 0], [0, 0, 1]]}, "not positive definite: its principal moments are -1"),
    "no body": (HEAVY | {"inertia": [1, 2, 3.5]}, "no body has the principal moments 1, 2, 3.5"),
    "by how much": (HEAVY | {"inertia": [1, 2, 3.5]}, "by 0.5"),
    "not symmetric": (HEAVY | {"inertia": [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]}, "elements 0.1 and 0 differ"),
    "two moments": (HEAVY | {"inertia": [1, 2]}, "expected a number, principal moments"),
    "rows of two": (HEAVY | {"inertia": [[1, 2], [1, 2], [1, 2]]}, "expected a number, principal moments"),
    "negative": (HEAVY | {"inertia": -1}, "inertia must not be negative"),
    "text": (HEAVY | {"inertia": ["1 kg", 1, 1]}, "expected a moment of inertia"),
    "negative distance": (HEAVY | {"inertia": 1, "centre_radius": -1}, "centre_radius must not be negative"),
    "ring with a tensor": (HEAVY | {"inertia": [1, 1, 1], "model": "ring and point mass"}, "a ring has one moment"),
    "ring off the sphere": (
        HEAVY | {"inertia": 1, "model": "ring and point mass", "centre_radius": 0.1}, "lies on the sphere"),
    "ring and shape": (HEAVY | {"shape": "arc", "model": "ring and point mass"}, "shape and model are given together"),
    "unknown model": (HEAVY | {"model": "ring"}, 'expected one of "ring and point mass"'),
    "rod": (HEAVY | {"shape": "rod"}, "rod is used in the plane only"),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_wrong_masses_are_refused(case: str) -> None:
    link, message = WRONG[case]
    with pytest.raises(ct.InputError) as told:
        arm(link)
    assert message in str(told.value)


LACKING: dict[str, tuple[dict[str, Any], str]] = {
    "no centre": (
        {"mass": 1, "inertia": 1, "shape": "disc", "radius": 0.1},
        "the position of its centre of mass is not given",
    ),
    "no inertia": (HEAVY, "it has a mass and turns, but no inertia"),
    "no radius": (HEAVY | {"shape": "disc"}, "a disc needs a radius"),
    "no mass": ({"shape": "arc"}, "it has a shape, but no mass"),
    "arc with a centre": (HEAVY | {"shape": "arc"}, "the centre of an arc is that of its shape"),
}


@pytest.mark.parametrize("case", LACKING)
def test_what_is_not_complete_is_told(case: str) -> None:
    link, message = LACKING[case]
    with pytest.raises(ct.InputError, match=message):
        ct.reduce(arm(link))


LOADS: dict[str, tuple[dict[str, Any], str]] = {
    "plane vector": ({"kind": "force", "point": "B", "vector": [1, 2]}, "expected [x, y, z]"),
    "no friction": ({"kind": "friction", "link": "AB"}, "one of value, viscous, quadratic, coefficient is missing"),
    "negative": ({"kind": "friction", "link": "AB", "value": -1}, "value must not be negative"),
    "backwards": ({"kind": "friction", "link": "AB", "quadratic": -1}, "quadratic must not be negative"),
    "two ways": ({"kind": "friction", "link": "AB", "value": 1, "coefficient": 0.1}, "are given together"),
    "plain": ({"kind": "friction", "link": "AB", "value": 1, "form": "plain sum"}, "the plain sum is used"),
    "form": ({"kind": "friction", "link": "AB", "value": 1, "form": "sum"}, 'expected one of "virtual work"'),
    "unknown axis": ({"kind": "torque", "link": "AB", "value": 1, "axis": "Q"}, 'unknown point "Q"'),
    "no axis": ({"kind": "torque", "link": "AB", "value": 1, "axis": [0, 0, 0]}, "a direction must not be zero"),
    "flat axis": ({"kind": "torque", "link": "AB", "value": 1, "axis": [0, 1]}, "expected [x, y, z]"),
}  # fmt: skip


@pytest.mark.parametrize("case", LOADS)
def test_wrong_loads_are_refused(case: str) -> None:
    load, message = LOADS[case]
    with pytest.raises(ct.InputError) as told:
        arm({}, load)
    assert message in str(told.value)


def rocker(*loads: dict[str, Any]) -> ct.Mechanism:
    parts = ct.example("spherical-crank-rocker")
    return ct.Mechanism(
        space="sphere",
        frame=parts.frame,
        links=parts.links,
        drives=parts.drives,
        assembly=parts.assembly,
        loads=loads,
    )


@pytest.mark.parametrize(
    ("load", "message"),
    [
        ({"kind": "friction", "link": "BC", "value": 1}, "BC and frame have no hinge in common"),
        (
            {"kind": "torque", "link": "AB", "relative_to": "DC", "value": 1},
            "AB and DC have no hinge in common",
        ),
        (
            {"kind": "spring", "link": "BC", "relative_to": "AB", "stiffness": 1},
            "is not measured there",
        ),
        ({"kind": "torque", "link": "BC", "relative_to": "AB", "value": "x"}, "is not measured there"),
        (
            {"kind": "friction", "point": "A", "radius": 0.01, "coefficient": 0.1},
            "Coulomb friction needs the reactions",
        ),
        ({"kind": "weight", "point": "B", "value": 3}, "give gravity, such as gravity = [0, 0, -9.81]"),
    ],
)
def test_loads_that_cannot_be_reduced_are_told(load: dict[str, Any], message: str) -> None:
    with pytest.raises(ct.InputError) as told:
        ct.reduce(rocker(load))
    assert message in str(told.value)


def test_keys_of_the_sphere_are_refused_in_the_plane() -> None:
    def crank(link: dict[str, Any], **more: Any) -> None:
        ct.Mechanism(frame={"points": {"O": [0, 0]}}, links={"OA": {"length": 1} | link}, **more)

    for link, key in (
        ({"centre_radius": 1}, "centre_radius"),
        ({"model": "ring and point mass"}, "model"),
        ({"shape": "arc"}, "arc"),
    ):
        with pytest.raises(ct.InputError, match=f"{key} is used on the sphere only"):
            crank(link)
    with pytest.raises(ct.InputError, match="radius is used on the sphere only"):
        crank({}, radius=1)
    with pytest.raises(ct.InputError, match="axis is used on the sphere only"):
        crank({}, loads=[{"kind": "torque", "link": "OA", "value": 1, "axis": "A"}])
    with pytest.raises(ct.InputError, match="expected a moment of inertia"):
        crank({"inertia": [1, 1, 1]})


def test_the_ring_of_several_drives_is_refused() -> None:
    ring = {"model": "ring and point mass", "inertia": 1}
    arms = ct.Mechanism(
        space="sphere",
        frame=FRAME,
        links={
            "AB": {"length": 0.7, "reference": ["A", "D"]},
            "BC": {"points": ["B", "C"], "length": 0.5, "reference": ["B", "A"], "centre": "C"} | ring,
        },
        drives=[
            {"link": "AB", "speed": 1, "start": 0.1},
            {"link": "BC", "relative_to": "AB", "speed": 1, "start": 1},
        ],
    )
    with pytest.raises(ct.InputError, match="one drive"):
        ct.reduce(arms, samples=3)
