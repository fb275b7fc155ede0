"""Spherical linkages: printed values, closed forms of the four-bar, limits, change points, batches, refusals."""

from __future__ import annotations

import math
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
from spherical_four_bars import four_bar, place

Array = npt.NDArray[np.float64]
PI = math.pi
ARC = st.floats(0.3, 1.4)


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
