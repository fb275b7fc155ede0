"""Small linkages on the sphere against planar ones."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import centrode as ct
from mechanisms import EPS, Parts, statuses
from spherical_four_bars import four_bar, place

Array = npt.NDArray[np.float64]
PI = math.pi


SIZES = (1e-1, 1e-2, 1e-3)


def planar(points: Parts, links: Parts, drives: list[Parts], side: str, guides: list[Parts]) -> xr.Dataset:
    mechanism = ct.Mechanism(
        frame={"points": points}, links=links, guides=guides, drives=drives, assembly={"sides": {"C": side}}
    )
    return ct.motion(mechanism, at=Q)


Q = np.linspace(0.3, 5.9, 9)
CRANK = [{"link": "AB", "start": 1.0, "speed": 1.0}]


def differences(flat: list[Array], curved: list[list[Array]]) -> None:
    """They fall with the square of the size: a hundredfold for each power of ten, until rounding shows."""
    for one, others in zip(flat, zip(*curved, strict=True), strict=True):
        gaps = [np.max(np.abs(other - one)) for other in others]
        assert gaps[0] > 1e-4  # curvature shows at 0.1 rad
        for near, (wide, narrow) in zip(SIZES[1:], pairwise(gaps), strict=True):
            # places are rounded to eps of the sphere, angles to eps over the size, their derivatives likewise
            assert narrow <= wide / 100 * 1.35 + 256 * EPS / near
            assert narrow >= wide / 100 / 1.35 - 256 * EPS / near


def turned(data: xr.Dataset, names: tuple[str, ...]) -> list[Array]:
    """Angles and their derivatives by the drive."""
    if "joint_angle" not in data:
        kinds = ("angle", "angular_velocity_coefficient", "angular_acceleration_coefficient")
        return [data[kind].sel(link=name).to_numpy() for name in names for kind in kinds]
    kinds = ("joint_angle", "joint_velocity_coefficient", "joint_acceleration_coefficient")
    return [data[kind].sel(joint=name).to_numpy() for name in names for kind in kinds]


def test_a_small_four_bar_is_planar() -> None:
    a, b, c, d = 1.0, 2.6, 2.2, 3.0
    links = {"AB": {"length": a}, "BC": {"length": b}, "DC": {"length": c}}
    flat = planar({"A": [0, 0], "D": [d, 0]}, links, CRANK, "left", [])
    # the plane measures from +x, which the arc DA leaves backwards; angles continuous over turns both
    exact = turned(flat, ("DC",))
    exact[0] = exact[0] - PI
    curved = []
    for size in SIZES:
        data = ct.motion(four_bar(a * size, b * size, c * size, d * size), at=Q)
        assert statuses(data) == ["ok"] * len(Q)
        assert data.attrs["worst_residual"] <= 64 * EPS / size
        found = turned(data, ("DC",))
        found[0] = found[0] - math.tau * np.round((found[0] - exact[0]) / math.tau)
        curved.append(found)
    differences(exact, curved)


def test_a_small_crank_with_a_great_circle_is_a_slider_crank() -> None:
    a, b, e = 1.0, 2.7, 0.4
    links = {"AB": {"length": a}, "BC": {"length": b}}
    guide = {"point": "C", "through": [0, e], "direction": [1, 0]}
    sides = {"C": "ahead"}
    flat = ct.motion(
        ct.Mechanism(
            frame={"points": {"A": [0, 0]}},
            links=links,
            guides=[guide],
            drives=CRANK,
            assembly={"sides": sides},
        ),
        at=Q,
    )
    kinds = ("slide", "slide_velocity_coefficient", "slide_acceleration_coefficient")
    exact = [flat[kind].sel(guide="C").to_numpy() for kind in kinds]
    curved = []
    for size in SIZES:
        mechanism = spherical_slider(a, b, e, size)
        data = ct.motion(mechanism, at=Q - PI / 2)
        assert statuses(data) == ["ok"] * len(Q)
        curved.append([data[kind].sel(guide="C").to_numpy() / size for kind in kinds])
    differences(exact, curved)


def spherical_slider(a: float, b: float, e: float, size: float) -> ct.Mechanism:
    """A crank below the equator of the sphere, its coupler's end on the equator; angles from the north."""
    return ct.Mechanism(
        space="sphere",
        frame={"points": {"A": [0.0, -e * size], "N": [0.0, 1.0]}},
        links={"AB": {"length": a * size, "reference": ["A", "N"]}, "BC": {"length": b * size}},
        guides=[{"point": "C", "pole": [PI, PI / 2]}],
        drives=[{"link": "AB", "start": 1.0 - PI / 2, "speed": 1.0}],
        assembly={"sides": {"C": "right"}},
    )


def test_a_small_pin_in_a_slot_is_planar() -> None:
    a, d = 1.0, 2.3
    flat = ct.motion(
        ct.Mechanism(
            frame={"points": {"A": [0, 0], "D": [d, 0]}},
            links={"AB": {"length": a}, "lever": {"points": {"D": [0, 0], "E": [1, 0]}}},
            guides=[{"point": "B", "on": "lever", "through": "D", "direction": [1, 0]}],
            drives=CRANK,
            assembly={"sides": {"B": "ahead"}},
        ),
        at=Q,
    )
    exact = turned(flat, ("lever",))
    exact[0] = exact[0] - PI
    curved = []
    for size in SIZES:
        lever = {"points": {"D": [0.0, 0.0], "E": [size, 0.0]}, "reference": ["D", "A"]}
        data = ct.motion(
            ct.Mechanism(
                space="sphere",
                frame={"points": {"A": [0.0, 0.0], "D": [d * size, 0.0]}},
                links={"AB": {"length": a * size, "reference": ["A", "D"]}, "lever": lever},
                guides=[{"point": "B", "on": "lever", "pole": [0.0, PI / 2]}],
                drives=CRANK,
                assembly={"sides": {"B": "left"}},
            ),
            at=Q,
        )
        assert statuses(data) == ["ok"] * len(Q)
        found = turned(data, ("lever",))
        found[0] = found[0] - math.tau * np.round((found[0] - exact[0]) / math.tau)
        curved.append(found)
    differences(exact, curved)


def test_lines_of_the_plane_meet_once_circles_of_the_sphere_twice() -> None:
    """Two guides at one point: which of the two places is meant has to be said."""
    parts: Parts = {
        "space": "sphere",
        "frame": {"points": {"A": [0.0, 0.0], "D": [1.0, 0.0]}},
        "links": {"K": {"points": {"A": [0.0, 0.0], "B": [0.5, 0.0]}, "reference": ["A", "D"]}},
        "guides": [
            {"name": "one", "point": "P", "pole": "D", "radius": 0.8},
            {"name": "two", "point": "P", "on": "K", "pole": [0.0, 1.5], "radius": 1.3},
        ],
        "drives": [{"link": "K", "start": 0.2, "speed": 1.0}],
    }
    with pytest.raises(ct.InputError, match="left"):
        ct.motion(ct.Mechanism(**parts), samples=2)
    found = [
        place(ct.motion(ct.Mechanism(**parts, assembly={"sides": {"P": side}}), at=[0.2]), "P")[0]
        for side in ("left", "right")
    ]
    d = np.array([math.cos(1.0), math.sin(1.0), 0.0])
    assert all(p @ d == pytest.approx(math.cos(0.8), abs=16 * EPS) for p in found)
    assert np.linalg.norm(found[0] - found[1]) > 0.1
