"""Spherical linkages: printed values, closed forms of the four-bar, small linkages against planar ones."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from mpmath import mp

import centrode as ct
from mechanisms import EPS, Parts, events, statuses

Array = npt.NDArray[np.float64]
PI = math.pi
ARC = st.floats(0.3, 1.4)


def four_bar(a: float, b: float, c: float, d: float, side: str = "left", **more: Any) -> ct.Mechanism:
    """Spherical four-bar A-B-C-D with A on the x axis and D on the equator, driven at AB."""
    parts: Parts = {
        "space": "sphere",
        "frame": {"points": {"A": [0.0, 0.0], "D": [d, 0.0]}},
        "links": {
            "AB": {"length": a, "reference": ["A", "D"]},
            "BC": {"length": b, "reference": ["B", "A"]},
            "DC": {"length": c, "reference": ["D", "A"]},
        },
        "drives": [{"link": "AB", "start": 1.0, "speed": 1.0}],
        "assembly": {"sides": {"C": side}},
    }
    return ct.Mechanism(**{**parts, **more})


def guided(a: float, b: float, d: float, radius: float, **more: Any) -> ct.Mechanism:
    """The same linkage with a guide about D in place of its rocker."""
    parts: Parts = {
        "space": "sphere",
        "frame": {"points": {"A": [0.0, 0.0], "D": [d, 0.0]}},
        "links": {"AB": {"length": a, "reference": ["A", "D"]}, "BC": {"length": b}},
        "guides": [{"point": "C", "pole": "D", "radius": radius}],
        "drives": [{"link": "AB", "start": 1.0, "speed": 1.0}],
        "assembly": {"sides": {"C": "left"}},
    }
    return ct.Mechanism(**{**parts, **more})


def place(data: xr.Dataset, name: str, variable: str = "position") -> Array:
    return np.asarray(data[variable].sel(point=name).to_numpy())


def joint(data: xr.Dataset, name: str, variable: str = "joint_angle") -> Array:
    return np.asarray(data[variable].sel(joint=name).to_numpy())


def rocker_angles(q: Any, a: Any, b: Any, c: Any, d: Any) -> tuple[Any, Any]:
    """Angle of DC from DA, left and right of B -> D: p cos + q sin = r (Chiang, Kinematics of Spherical Mechanisms)."""
    cos, sin = mp.cos, mp.sin
    x, y, z = cos(a), sin(a) * cos(q), sin(a) * sin(q)
    towards, along = x * sin(d) - y * cos(d), x * cos(d) + y * sin(d)
    p, s, r = sin(c) * towards, -sin(c) * z, cos(b) - cos(c) * along
    half = mp.acos(r / mp.sqrt(p * p + s * s))
    middle = mp.atan2(s, p)
    return middle - half, middle + half


# The printed checks: A on x, D on y, AD = CD = 90 deg, C = (sin psi, 0, cos psi) with psi from the z axis.

PRINTED = [
    (PI / 12, PI / 4, (0.8213, 0.5236, 0.8213, 1.0472)),
    (PI / 24, PI / 2 - PI / 24, (0.1320, 0.0, 0.1320, 0.2618)),
]
BETA = (0.0, PI / 2, PI, 3 * PI / 2)


def with_rocker(a: float, b: float) -> ct.Mechanism:
    frame = {"points": {"A": [1, 0, 0], "D": [0, 1, 0], "Z": [0, 0, 1]}}
    links = {
        "AB": {"length": a, "reference": ["A", "D"]},
        "BC": {"length": b},
        "DC": {"length": PI / 2, "reference": ["D", "Z"]},
    }
    return four_bar(a, b, PI / 2, PI / 2, frame=frame, links=links)


@pytest.mark.parametrize(("a", "b", "printed"), PRINTED)
def test_printed_angles_of_the_crank_rocker(a: float, b: float, printed: tuple[float, ...]) -> None:
    data = ct.motion(with_rocker(a, b), at=BETA)
    slid = ct.motion(guided(a, b, PI / 2, PI / 2), at=BETA)
    assert statuses(data) == ["ok"] * 4
    psi = joint(data, "DC")
    assert psi == pytest.approx(printed, abs=0.5e-4 * (1 + 1e-9))
    c = place(data, "C")
    assert np.arctan2(c[:, 0], c[:, 2]) == pytest.approx(psi, abs=8 * EPS)
    # closure, and what sin(psi) then is at 0 and 180 deg
    closure = math.cos(a) * np.sin(psi) + math.sin(a) * np.cos(psi) * np.sin(BETA)
    assert closure == pytest.approx(math.cos(b), abs=8 * EPS)
    # the guide's displacement counts from the north of its pole, which is z
    assert slid["slide"].sel(guide="C").to_numpy() == pytest.approx(psi, abs=16 * EPS)
    assert np.max(np.abs(place(slid, "C") - c)) <= 16 * EPS


def test_the_touching_rocker_turns_back() -> None:
    """psi comes to 0 at 90 deg with no speed and an acceleration that sends it back."""
    a = PI / 24
    data = ct.motion(with_rocker(a, PI / 2 - a), at=[PI / 2 - 0.01, PI / 2, PI / 2 + 0.01])
    psi, slope, bend = (
        joint(data, "DC", name)
        for name in ("joint_angle", "joint_velocity_coefficient", "joint_acceleration_coefficient")
    )
    assert events(data, "limit") == events(data, "change point") == []
    assert psi[1] == pytest.approx(0.0, abs=8 * EPS) and slope[1] == pytest.approx(0.0, abs=16 * EPS)
    # cos a sin psi + sin a cos psi sin q = sin a, differentiated twice at psi = 0
    assert bend[1] == pytest.approx(math.tan(a), abs=32 * EPS)
    assert psi[0] == pytest.approx(psi[2], abs=32 * EPS) and psi[0] > 0 and slope[0] < 0 < slope[2]


@settings(max_examples=40)
@given(ARC, ARC, ARC, ARC, st.floats(-3.0, 3.0), st.sampled_from(["left", "right"]))
def test_the_four_bar_has_its_closed_form(
    a: float, b: float, c: float, d: float, q: float, side: str
) -> None:
    """Value, first and second derivative against the closed form in 30 digits."""
    cos_bd = math.cos(a) * math.cos(d) + math.sin(a) * math.sin(d) * math.cos(q)
    assume(math.cos(b + c) + 0.03 < cos_bd < math.cos(b - c) - 0.03 and abs(cos_bd) < 0.99)
    mechanism = four_bar(a, b, c, d, side, drives=[{"link": "AB", "start": q, "speed": 1.0}])
    data = ct.motion(mechanism, at=[q])
    number = ("left", "right").index(side)
    with mp.workdps(30):
        dims = [mp.mpf(x) for x in (a, b, c, d)]
        # by its unit vector e, which does not jump: e' = i psi' e, e'' = (i psi'' - psi'^2) e
        e = [mp.diff(lambda x: mp.expj(rocker_angles(x, *dims)[number]), mp.mpf(q), k) for k in range(3)]
        exact = [float(mp.arg(e[0])), *(float((mp.conj(e[0]) * x).imag) for x in e[1:])]
    found = [
        joint(data, "DC", name)[0]
        for name in ("joint_angle", "joint_velocity_coefficient", "joint_acceleration_coefficient")
    ]
    # how steep the angle is where the triangle B, D, C is nearly flat: its sine, squared for each derivative
    sine = math.sqrt((math.cos(b - c) - cos_bd) * (cos_bd - math.cos(b + c)))
    steep = 1.0 / (sine * math.sin(c))
    assert abs(math.remainder(found[0] - exact[0], math.tau)) <= 64 * EPS * steep
    assert found[1] == pytest.approx(exact[1], abs=128 * EPS * steep**3)
    assert found[2] == pytest.approx(exact[2], abs=512 * EPS * steep**5)
    volume = np.linalg.det([place(data, name)[0] for name in ("B", "D", "C")])
    assert (volume > 0) == (side == "left")


def test_links_turn_as_their_angular_velocities_say() -> None:
    """v = w x r and a = e x r + w x v for every point of every link, about the centre of the sphere."""
    mechanism = four_bar(
        0.4, 1.1, 0.9, 1.2, drives=[{"link": "AB", "start": 0.3, "law": "2*t + 0.3*sin(3*t)"}]
    )
    data = ct.motion(mechanism, samples=60, start=0.0, stop=3.0)
    for link, body in mechanism.links.items():
        w, e = (data[f"angular_{x}"].sel(link=link).to_numpy() for x in ("velocity", "acceleration"))
        for name in body.coordinates:
            r, v, a = (place(data, name, x) for x in ("position", "velocity", "acceleration"))
            size = 1.0 + np.max(np.abs(w))
            assert np.max(np.abs(v - np.cross(w, r))) <= 256 * EPS * size
            assert np.max(np.abs(a - np.cross(e, r) - np.cross(w, v))) <= 1024 * EPS * size**2
    # the crank turns about its pivot, the rocker about its own
    speed = joint(data, "AB", "joint_velocity")
    t = data["time"].to_numpy()
    assert speed == pytest.approx(2 + 0.9 * np.cos(3 * t), abs=64 * EPS)
    w = data["angular_velocity"].sel(link="AB").to_numpy()
    assert np.max(np.abs(w - speed[:, None] * place(data, "A"))) <= 64 * EPS
    w = data["angular_velocity"].sel(link="DC").to_numpy()
    turn = joint(data, "DC", "joint_velocity")[:, None] * place(data, "D")
    assert np.max(np.abs(w - turn)) <= 512 * EPS


# Small linkages against planar ones of the same proportions.

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


# Events.


def test_limits_are_where_the_triangle_is_flat() -> None:
    """A rocker that cannot follow: cos BD = cos(b + c) at the limits."""
    a, b, c, d = 0.9, 0.5, 0.6, 0.8
    limit = math.acos((math.cos(b + c) - math.cos(a) * math.cos(d)) / (math.sin(a) * math.sin(d)))
    data = ct.motion(four_bar(a, b, c, d), samples=721, start=-PI, stop=PI)
    steep = 1.0 / (math.sin(a) * math.sin(d) * math.sin(limit))
    assert events(data, "limit") == pytest.approx([-limit, limit], abs=16 * EPS * steep)
    q = data["drive_value"].to_numpy()[:, 0]
    expected = np.where(np.abs(q) < limit, "ok", "open")
    assert statuses(data) == expected.tolist()
    at_limit = ct.motion(four_bar(a, b, c, d), at=[limit])
    assert statuses(at_limit) == ["singular"]
    volume = np.linalg.det([place(at_limit, name)[0] for name in ("B", "D", "C")])
    assert abs(volume) <= 64 * math.sqrt(EPS)


def test_what_lies_behind_a_limit_is_cut_off() -> None:
    """Two stretches on which the linkage closes, parted by limits."""
    a, b, c, d = 1.0, 0.35, 0.9, 1.1
    near = math.acos((math.cos(b - c) - math.cos(a) * math.cos(d)) / (math.sin(a) * math.sin(d)))
    far = math.acos((math.cos(b + c) - math.cos(a) * math.cos(d)) / (math.sin(a) * math.sin(d)))
    q = np.array([-far + 0.01, -near - 0.01, 0.0, near + 0.01, far - 0.01, far + 0.01])
    data = ct.motion(
        four_bar(a, b, c, d, drives=[{"link": "AB", "start": 0.5 * (near + far), "speed": 1.0}]), at=q
    )
    assert statuses(data) == ["cut off", "cut off", "open", "ok", "ok", "open"]


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("continuation", ["smooth", "keep"])
def test_change_points_of_equal_opposite_arcs(side: str, continuation: str) -> None:
    """Flat at 0 and 180 deg, as the parallelogram is; continued smoothly, tan(psi/2) tan(q/2) is constant for ever.

    By Napier's analogies it is -cos((d-a)/2)/cos((d+a)/2) uncrossed and sin((d-a)/2)/sin((d+a)/2) crossed.
    """
    a, d = 0.4, 0.9
    uncrossed = -math.cos((d - a) / 2) / math.cos((d + a) / 2)
    crossed = math.sin((d - a) / 2) / math.sin((d + a) / 2)
    q = np.linspace(0.2, 4 * PI - 0.2, 58)
    data = ct.motion(
        four_bar(a, d, a, d, assembly={"sides": {"C": side}, "continuation": continuation}), at=q
    )
    # the radicand is zero within its rounding error, and its minimum as sharp as its second derivative
    assert events(data, "change point") == pytest.approx([PI, 2 * PI, 3 * PI], abs=64 * EPS)
    assert events(data, "limit") == []
    assert statuses(data) == ["ok"] * len(q)
    product = np.tan(joint(data, "DC") / 2) * np.tan(q / 2)
    first, second = (uncrossed, crossed) if side == "left" else (crossed, uncrossed)
    passed = np.floor(q / PI).astype(int) if continuation == "keep" else np.zeros(len(q), dtype=int)
    exact = np.where(passed % 2 == 0, first, second)
    # an angle near a multiple of pi is multiplied by the tangent of its half
    steep = np.tan(q / 2) ** 2 + 1 / np.tan(q / 2) ** 2
    assert (np.abs(product - exact) <= 256 * EPS * steep).all()


def test_a_batch_is_its_mechanisms() -> None:
    mechanism = four_bar(0.5, 1.0, 0.9, 1.1)
    arcs = np.array([0.8, 0.9, 1.0, 1.2, 2.9])
    vary = {"links.BC.length": arcs, "frame.points.D.longitude": np.array([1.1, 1.0, 1.2, 0.9, 1.1])}
    batch = ct.motion(mechanism, samples=31, vary=vary)
    for lane in range(len(arcs)):
        one = mechanism
        for path, values in vary.items():
            one = ct.with_value(one, path, float(values[lane]))
        if lane == 4:
            assert (batch["status"][lane] == ct.Status.OPEN).all()
            with pytest.raises(ct.InputError, match="link BC is too long"):
                ct.motion(one, samples=31)
            continue
        alone = ct.motion(one, samples=31)
        np.testing.assert_array_equal(batch["status"][lane], alone["status"])
        for name in ("position", "acceleration", "joint_angle", "angular_acceleration"):
            np.testing.assert_allclose(batch[name][lane], alone[name], rtol=0, atol=1024 * EPS)


def test_a_drive_along_a_circle_runs_on_over_rounds() -> None:
    """A guide of arc 0.4 driven along its circle: the point runs round three times, 2 pi sin(0.4) each."""
    radius = 0.4
    driven = ct.Mechanism(
        space="sphere",
        frame={"points": {"D": [0.0, 0.0]}},
        links={"CF": {"length": 0.5}},
        guides=[
            {"point": "C", "pole": "D", "radius": radius},
            {"name": "other", "point": "F", "pole": [0.1, 0.05], "radius": 0.6},
        ],
        drives=[{"guide": "C", "start": 0.1, "speed": 1.0}],
        assembly={"sides": {"F": "left"}},
    )
    turn = math.tau * math.sin(radius)
    data = ct.motion(driven, samples=91, start=0.1, stop=0.1 + 3 * turn)
    assert data["drive_value"].attrs["units"] == "rad"
    slide = data["slide"].sel(guide="C").to_numpy()
    assert slide == pytest.approx(data["drive_value"].to_numpy()[:, 0], abs=32 * EPS)
    c = place(data, "C")
    angle = slide / math.sin(radius)
    exact = np.stack(
        [np.full(91, math.cos(radius)), -math.sin(radius) * np.sin(angle), math.sin(radius) * np.cos(angle)],
        axis=-1,
    )
    assert np.max(np.abs(c - exact)) <= 64 * EPS
    # speed along the guide is the speed of the point
    assert np.linalg.norm(place(data, "C", "velocity"), axis=1) == pytest.approx(1.0, abs=64 * EPS)


REFUSED = [
    (
        {"rolling": [{"link": "AB", "centre": "B", "radius": 0.1, "along": {"centre": "D", "radius": 0.2}}]},
        "rolling",
    ),
    ({"guides": [{"point": "C", "pole": "D", "link": "BC"}]}, "guides"),
    ({"drives": [{"distance": ["A", "C"], "start": 1.0, "speed": 0.1}]}, "drives"),
]


@pytest.mark.parametrize(("more", "where"), REFUSED)
def test_what_the_sphere_does_not_have_is_refused_with_a_repair(more: Parts, where: str) -> None:
    with pytest.raises(ct.NotComputedYet) as refused:
        ct.motion(four_bar(0.5, 1.0, 0.9, 1.1, **more))
    assert where in refused.value.where and refused.value.repair


def test_a_reference_lies_on_the_body_that_the_drive_is_relative_to() -> None:
    links = {
        "AB": {"length": 0.5, "reference": ["A", "B0"]},
        "BC": {"length": 1.0, "points": ["B0", "C"]},
        "DC": {"length": 0.9},
    }
    links["AB"]["points"] = ["A", "B0"]
    links["AB"]["reference"] = ["A", "C"]
    with pytest.raises(ct.InputError, match="reference"):
        ct.motion(four_bar(0.5, 1.0, 0.9, 1.1, links=links))


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


# A group of higher class: a six-bar driven at its second rocker.

SIX_BAR: Parts = {
    "AB": {"length": 0.4, "reference": ["A", "D"]},
    "BCE": {"points": {"B": [0.0, 0.0], "C": [1.0, 0.0], "E": [0.5, 0.4]}, "reference": ["B", "A"]},
    "DC": {"length": 0.8, "reference": ["D", "A"]},
    "EF": {"length": 0.9, "reference": ["E", "B"]},
    "GF": {"length": 0.7, "reference": ["G", "A"]},
}
SIX_BAR_FRAME = {"points": {"A": [0.0, 0.0], "D": [1.1, 0.0], "G": [0.6, -0.5]}}


def test_a_six_bar_driven_elsewhere_is_the_same_mechanism() -> None:
    """Driven at the crank it has dyads only; driven at GF, four links have to be solved together."""
    crank = ct.Mechanism(
        space="sphere",
        frame=SIX_BAR_FRAME,
        links=SIX_BAR,
        drives=CRANK,
        assembly={"sides": {"C": "left", "F": "right"}},
    )
    exact = ct.motion(crank, at=np.linspace(0.8, 1.4, 7))
    angles = exact["joint_angle"][3]
    links = {name: {**link, "angle": float(angles.sel(joint=name))} for name, link in SIX_BAR.items()}
    start = links["GF"].pop("angle")
    rocker = ct.Mechanism(
        space="sphere",
        frame=SIX_BAR_FRAME,
        links=links,
        drives=[{"link": "GF", "start": start, "speed": 1.0}],
    )
    assert "higher class" in ct.check(rocker).plan[-1]
    found = ct.motion(rocker, at=joint(exact, "GF"))
    assert statuses(found) == statuses(exact) == ["ok"] * 7
    assert np.max(np.abs(found["position"] - exact["position"])) <= 256 * EPS
    # the chain rule: derivatives by the crank over that of GF by the crank
    rate = joint(exact, "GF", "joint_velocity_coefficient")
    bend = joint(exact, "GF", "joint_acceleration_coefficient")
    first = exact["velocity_coefficient"].to_numpy() / rate[:, None, None]
    second = (exact["acceleration_coefficient"].to_numpy() - first * bend[:, None, None]) / (rate**2)[
        :, None, None
    ]
    steep = np.max(1 / np.abs(rate))
    assert np.max(np.abs(found["velocity_coefficient"] - first)) <= 1024 * EPS * steep**2
    assert np.max(np.abs(found["acceleration_coefficient"] - second)) <= 4096 * EPS * steep**4
    # GF turns back where its angle is greatest: a limit of the mechanism that it drives
    limit = events(ct.motion(rocker, samples=91), "limit")
    assert len(limit) == 1
    at_limit = crank_at_greatest(crank)
    assert limit[0] == pytest.approx(at_limit, abs=1024 * EPS)


def crank_at_greatest(crank: ct.Mechanism) -> float:
    """Greatest angle of GF: its slope by the crank is zero, found by bisection."""

    def slope(q: float) -> float:
        return float(joint(ct.motion(crank, at=[q]), "GF", "joint_velocity_coefficient")[0])

    coarse = ct.motion(crank, samples=361)
    q = coarse["drive_value"].to_numpy()[int(np.argmax(joint(coarse, "GF"))), 0]
    low, high = q - 0.02, q + 0.02
    assert slope(low) > 0 > slope(high)
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if slope(middle) > 0 else (low, middle)
    return float(joint(ct.motion(crank, at=[low]), "GF")[0])


def test_gears_at_a_group_of_higher_class() -> None:
    """A wheel may follow a link of such a group; a gear that holds the group together is refused."""
    exact = ct.motion(
        ct.Mechanism(
            space="sphere",
            frame=SIX_BAR_FRAME,
            links=SIX_BAR,
            drives=CRANK,
            assembly={"sides": {"C": "left", "F": "right"}},
        ),
        at=np.linspace(0.8, 1.4, 7),
    )
    links = {
        name: {**link, "angle": float(exact["joint_angle"][3].sel(joint=name))}
        for name, link in SIX_BAR.items()
    }
    start = links["GF"].pop("angle")
    frame = {"points": {**SIX_BAR_FRAME["points"], "W": [0.2, 0.7]}}
    wheel = {"WV": {"length": 0.3, "reference": ["W", "D"], "angle": 0.25}}
    geared = ct.Mechanism(
        space="sphere",
        frame=frame,
        links=links | wheel,
        gears=[{"links": ["DC", "WV"], "ratio": -3.0}],
        drives=[{"link": "GF", "start": start, "speed": 1.0}],
    )
    found = ct.motion(geared, at=joint(exact, "GF"))
    assert statuses(found) == ["ok"] * 7
    turn = joint(exact, "DC") - joint(exact, "DC")[3]
    assert np.max(np.abs(joint(found, "WV") - 0.25 + 3.0 * turn)) <= 1024 * EPS
    # without its drive, the loop is held by the gear alone
    held = ct.Mechanism(
        space="sphere",
        frame=SIX_BAR_FRAME,
        links={name: link for name, link in SIX_BAR.items() if name not in ("EF", "GF")}
        | {
            "EG": {"length": 0.6, "points": ["E", "H"]},
            "GH": {"length": 0.5, "points": ["G", "H"], "reference": ["G", "A"]},
            "GK": {"length": 0.5, "reference": ["G", "A"]},
        },
        gears=[{"links": ["DC", "GH"], "ratio": 2.0}],
        drives=[{"link": "GK", "start": 0.0, "speed": 1.0}],
    )
    with pytest.raises(ct.InputError):
        ct.motion(held, samples=3)
