"""Reactions on the sphere in closed form: a pendulum, Hooke's joint, a guide for a rocker, small linkages."""

from __future__ import annotations

from math import cos, pi, radians, sin, tan
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import centrode as ct
from centrode.dynamics.reduction import Reducer
from mechanisms import EPS
from spherical_bodies import dot, place

Array = npt.NDArray[np.float64]
ROUNDING = 256 * EPS
RING = {
    "points": ["C", "B"],
    "length": pi / 4,
    "centre": "C",
    "mass": 1.5,
    "inertia": 0.8,
    "model": "ring and point mass",
}


def force(found: xr.Dataset, side: str) -> Array:
    return np.asarray(found.joint_force.sel(side=side))


@pytest.mark.parametrize("arc", [0.5, pi / 2, 2.4])
def test_a_pendulum(arc: float) -> None:
    """A mass on the cone about the x axis: hinge by the moments about y and z, centre by the sum of forces."""
    mass, radius, rate, g = 1.3, 0.7, 2.0, 9.81
    pendulum = ct.Mechanism(
        space="sphere", radius=radius, gravity=[0, 0, -g],
        frame={"points": {"A": [1, 0, 0], "Y": [0, 1, 0]}},
        links={"AB": {"length": arc, "reference": ["A", "Y"], "mass": mass, "centre": "B", "inertia": 0}},
        drives=[{"link": "AB", "start": 0, "speed": rate}],
    )  # fmt: skip
    turned = np.linspace(0.0, 6.0, 13)
    found = ct.reactions(pendulum, at=turned)
    x, y, z = (
        radius * cos(arc) + 0 * turned,
        radius * sin(arc) * np.cos(turned),
        radius * sin(arc) * np.sin(turned),
    )
    away = mass * rate**2
    # moment of weight and inertia about O: r x (0, away y, away z - m g)
    moment = np.cross(np.stack([x, y, z], 1), np.stack([0 * x, away * y, away * z - mass * g], 1))
    pin = np.stack([0 * x, -moment[:, 2], moment[:, 1]], 1) / radius
    size = mass * (g + rate**2) * max(1.0, radius)
    assert np.max(abs(found.balancing[:, 0] + moment[:, 0])) <= ROUNDING * size
    assert np.max(abs(force(found, "A/AB") - pin)) <= ROUNDING * size
    assert np.max(abs(force(found, "A/frame") + pin)) <= ROUNDING * size
    centre = -pin - np.stack([0 * x, away * y, away * z - mass * g], 1)
    assert np.max(abs(found.centre_force.sel(held="AB") - centre)) <= ROUNDING * size
    # the frame bears the weight and the centrifugal force
    assert np.max(abs(found.frame_force + centre + pin)) <= ROUNDING * size
    assert np.max(abs(found.frame_moment - moment)) <= ROUNDING * size
    assert np.max(abs(found.inertia_force[:, 0] - away * np.stack([0 * x, y, z], 1))) <= ROUNDING * size


def test_a_load_across_the_sphere() -> None:
    """What presses a tip outwards goes into the centre; that on a hinge of two links into it past both of them."""
    parts: dict[str, Any] = {
        "space": "sphere", "radius": 2,
        "frame": {"points": {"A": [1, 0, 0], "D": [0, 1, 0], "Z": [0, 0, 1]}},
        "links": {
            "AB": {"length": pi / 12, "reference": ["A", "D"]},
            "BC": {"length": pi / 4, "points": {"B": [0, 0], "C": [pi / 4, 0], "T": [0.3, 0.2]}},
            "DC": {"length": pi / 2, "reference": ["D", "Z"]},
        },
        "drives": [{"link": "AB", "start": 0.4, "speed": 1}],
        "assembly": {"sides": {"C": "left"}},
    }  # fmt: skip
    del parts["links"]["BC"]["length"]
    for point, holds in (("T", "BC"), ("C", "pin C")):
        load = {"kind": "force", "point": point, "vector": [5.0, -3.0, 8.0]}
        mechanism = ct.Mechanism(**parts, loads=[load])
        data, found = ct.motion(mechanism, 5), ct.reactions(mechanism, 5)
        assert found.held.to_numpy().tolist() == ["AB", "BC", "DC", *([] if holds == "BC" else [holds])]
        up = place(data, point)
        across = dot(up, np.array([5.0, -3.0, 8.0]) + 0 * up)[:, None] * up
        along = np.array([5.0, -3.0, 8.0]) - across
        unloaded = found.joint_force.sel(side=["B/BC", "C/BC"]).sum("side").to_numpy()
        bears = found.centre_force.sel(held=holds).to_numpy()
        expected = -across - along - unloaded if holds == "BC" else -across
        assert np.max(abs(bears - expected)) <= ROUNDING * 10
        if holds == "pin C":
            pair = found.joint_force.sel(side=["C/BC", "C/DC"]).sum("side").to_numpy()
            assert np.max(abs(pair - along)) <= ROUNDING * 10


def hookes_joint(bend: float, **more: Any) -> ct.Mechanism:
    return ct.Mechanism(
        space="sphere", radius=0.05,
        frame={"points": {"A": [1, 0, 0], "D": [cos(bend), sin(bend), 0], "N": [0, 0, 1]}},
        links={
            "driver": {"points": ["A", "B"], "length": pi / 2, "reference": ["A", "N"]},
            "cross": {"points": ["B", "C"], "length": pi / 2},
            "driven": {"points": ["D", "C"], "length": pi / 2, "reference": ["D", "N"], "angle": pi / 2},
        },
        drives=[{"link": "driver", "start": 0, "speed": 1.5}],
        assembly={"sides": {"C": "right"}},
        **more,
    )  # fmt: skip


@pytest.mark.parametrize("bend", [10.0, 25.0, 40.0])
def test_hookes_joint(bend: float) -> None:
    """The moment goes through the cross along its normal; shafts bend by what of it is square to them."""
    a, load = radians(bend), 7.0
    torque = {"kind": "torque", "link": "driven", "relative_to": "frame", "value": -load}
    phi = np.linspace(0.0, 2 * pi, 73)
    found = ct.reactions(hookes_joint(a, loads=[torque]), at=phi)
    ratio = cos(a) / (1 - sin(a) ** 2 * np.sin(phi) ** 2)
    given = load * ratio
    size = ROUNDING * load / cos(a) ** 3
    assert np.max(abs(found.balancing[:, 0] - given)) <= size
    # by hand: the driver's arm B, the driven arm C = D x B, the normal of the cross
    arm = np.stack([0 * phi, -np.sin(phi), np.cos(phi)], axis=1)
    driven = np.array([cos(a), sin(a), 0.0])
    normal = np.cross(arm, np.cross(driven, arm))
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    through = (given / normal[:, 0])[:, None] * normal
    moment = found.joint_moment
    assert np.max(abs(moment.sel(side="B/cross") - through)) <= size / cos(a)
    assert np.max(abs(moment.sel(side="C/driven") - through)) <= size / cos(a)
    bending = moment.sel(side="A/driver").to_numpy()
    assert np.max(abs(bending - (through - given[:, None] * [1, 0, 0]))) <= size / cos(a)
    # the textbooks: between 0 and tan a of the moment in the driver, between 0 and sin a of it in the driven shaft
    share = np.linalg.norm(bending, axis=1) / given
    assert np.max(abs(share - tan(a) * abs(np.cos(phi)))) <= size / cos(a) / load * 4
    other = np.linalg.norm(moment.sel(side="D/driven"), axis=1) / given
    assert abs(np.max(other) - sin(a)) <= size / load * 4 / cos(a)
    assert np.min(other) <= size / load * 4 / cos(a)
    # forces in the hinges are those of couples with the radius as their arm
    assert np.allclose(
        np.linalg.norm(found.joint_force, axis=2) * 0.05, np.linalg.norm(moment, axis=2), rtol=1e-14
    )


def crank(**more: Any) -> dict[str, Any]:
    parts: dict[str, Any] = {
        "space": "sphere", "radius": 0.4,
        "frame": {"points": {"A": [1, 0, 0], "D": [0, 1, 0], "Z": [0, 0, 1]}},
        "links": {
            "AB": {"length": pi / 12, "reference": ["A", "D"]},
            "BC": {"length": pi / 4, "mass": 2, "shape": "arc"},
        },
        "drives": [{"link": "AB", "start": 0, "speed": 3}],
        "assembly": {"sides": {"C": "left"}},
        "loads": [{"kind": "force", "point": "C", "vector": [4, 0, 9]}],
    }  # fmt: skip
    rocker = {"links": parts["links"] | {"DC": {"length": pi / 2, "reference": ["D", "Z"]}}}
    guide = {"guides": [{"point": "C", "on": "frame", "pole": "D", "radius": pi / 2}]}
    asked = {"rocker": rocker, "guide": guide, "both": rocker | guide}
    return parts | asked[more.pop("by")] | more


def test_a_guide_bears_what_a_massless_rocker_bears() -> None:
    rocker, guide = (ct.reactions(ct.Mechanism(**crank(by=by)), 25) for by in ("rocker", "guide"))
    size = float(np.max(abs(rocker.joint_force)))
    condition = float(np.sqrt(np.max(rocker.reaction_loss) / EPS))
    allowed = ROUNDING * condition * size
    for side in ("A/AB", "B/AB", "B/BC"):
        assert np.max(abs(force(guide, side) - force(rocker, side))) <= allowed
    assert np.max(abs(guide.balancing - rocker.balancing)) <= allowed
    # the pin presses the rocker along its own arc, as it does the guide across its circle: away from the pole D
    borne = -force(rocker, "C/DC")
    assert np.max(abs(guide.guide_force[:, 0] - borne)) <= allowed
    assert np.max(abs(guide.guide_normal[:, 0] + borne[:, 1])) <= allowed
    assert np.max(abs(guide.guide_force[:, 0, [0, 2]])) <= allowed
    assert "guide_moment" not in guide


def test_a_guide_beside_a_rocker_is_not_determined() -> None:
    found = ct.reactions(ct.Mechanism(**crank(by="both")), 7)
    alone = ct.reactions(ct.Mechanism(**crank(by="guide")), 7)
    said = found.attrs["undetermined"].split("; ")
    assert {"C/DC", "D/DC", "D/frame", "guide C", "centre on DC"} <= set(said)
    assert not {"A/AB", "B/AB", "B/BC", "centre on AB"} & set(said)
    assert np.isnan(found.guide_force).all()
    assert np.isnan(found.joint_moment.sel(side="C/DC")).all()
    allowed = (
        ROUNDING * float(np.sqrt(np.max(alone.reaction_loss) / EPS)) * float(np.max(abs(alone.joint_force)))
    )
    assert np.max(abs(found.balancing - alone.balancing)) <= allowed
    assert np.max(abs(force(found, "B/BC") - force(alone, "B/BC"))) <= allowed
    assert np.max(abs(found.frame_moment - alone.frame_moment)) <= allowed


def test_a_drive_along_a_circle() -> None:
    """Its arc is its value, so that it gives a moment: the force along the circle times the radius."""
    radius, arc, push = 0.4, 0.8, 5.0
    slider = ct.Mechanism(
        space="sphere", radius=radius,
        frame={"points": {"Z": [0, 0, 1]}},
        links={"rod": {"points": {"P": [0, 0], "Q": [0.3, 0]}}},
        guides=[
            {"point": "P", "on": "frame", "pole": "Z", "radius": arc},
            {"point": "Q", "on": "frame", "pole": "Z", "radius": arc},
        ],
        drives=[{"guide": "P", "law": "0.2*t"}],
        assembly={"sides": {"Q": "left"}},
        loads=[{"kind": "force", "guide": "Q", "value": push}],
        study={"to": 1},
    )  # fmt: skip
    found = ct.reactions(slider, 3)
    # both turn about the pole alike
    assert np.allclose(found.balancing, -push * radius, rtol=ROUNDING, atol=0)
    assert found.balancing.attrs["units"] == "N m"


def test_a_small_linkage_is_a_plane_one() -> None:
    """Arcs of 1e-4 on a great sphere: forces of the plane linkage, to the square of the arcs."""
    far, lengths = 1e4, {"OA": 0.3, "AB": 1.0, "CB": 0.7}
    load = {"kind": "force", "point": "B"}
    drive = {"drives": [{"link": "OA", "start": 0.7, "speed": 2}], "assembly": {"sides": {"B": "left"}}}
    torque = {"kind": "torque", "link": "CB", "value": 3.0}
    flat = ct.Mechanism(
        frame={"points": {"O": [0, 0], "C": [0.9, 0]}},
        links={name: {"length": x} for name, x in lengths.items()},
        loads=[load | {"vector": [30.0, -20.0]}, torque], **drive,
    )  # fmt: skip
    round_ = ct.Mechanism(
        space="sphere", radius=far,
        frame={"points": {"O": [0, 0], "C": [0.9 / far, 0]}},
        links={
            "OA": {"length": lengths["OA"] / far, "reference": ["O", "C"]},
            "AB": {"length": lengths["AB"] / far},
            "CB": {"length": lengths["CB"] / far},
        },
        loads=[load | {"vector": [0.0, 30.0, -20.0]}, torque], **drive,
    )  # fmt: skip
    turned = np.linspace(0.7, 6.0, 9)
    plane, sphere = ct.reactions(flat, at=turned), ct.reactions(round_, at=turned)
    size = float(np.max(abs(plane.joint_force)))
    # the plane touches at O, and is left by as much as arcs are long
    allowed = 4 * size / far + ROUNDING * size * float(np.sqrt(np.max(sphere.reaction_loss) / EPS))
    sides = plane.side.to_numpy().tolist()
    assert sides == sphere.side.to_numpy().tolist()
    for axis, other in (("x", "y"), ("y", "z")):
        apart = plane.joint_force.sel(axis=axis) - sphere.joint_force.sel(axis=other, side=sides)
        assert np.max(abs(apart)) <= allowed
    assert np.max(abs(plane.balancing - sphere.balancing)) <= allowed
    # equations are about places of the linkage, so that they are as good as those of the plane
    assert float(np.max(sphere.reaction_loss)) <= 16 * float(np.max(plane.reaction_loss))
    for name in ("equilibrium_residual", "frame_residual", "power_residual"):
        assert sphere.attrs[name] <= ROUNDING * float(np.sqrt(np.max(sphere.reaction_loss) / EPS))


def test_no_numbers_at_dead_points() -> None:
    """A rhomboid whose links lie in one great circle, and a crank that does not turn fully."""
    frame = {"points": {"A": [1, 0, 0], "D": [cos(1.0), sin(1.0), 0], "Z": [0, 0, 1]}}
    links: dict[str, Any] = {
        "AB": {"length": 0.5, "reference": ["A", "D"]},
        "BC": {"length": 1.0},
        "DC": {"length": 0.5, "reference": ["D", "Z"]},
    }
    load = {"kind": "force", "point": "C", "vector": [0.0, 0.0, -100.0]}
    parts: dict[str, Any] = {
        "space": "sphere", "frame": frame, "links": links, "loads": [load],
        "drives": [{"link": "AB", "start": 1, "speed": 1}],
    }  # fmt: skip
    flat = ct.reactions(ct.Mechanism(**parts, assembly={"sides": {"C": "left"}}), at=[0.0, 1e-3, 1.0])
    assert flat.reaction_status.to_numpy().tolist()[1:] == [ct.Status.OK] * 2
    assert flat.reaction_status[0] in (ct.Status.SINGULAR, ct.Status.CUT_OFF)
    for name in ("balancing", "joint_force", "centre_force", "frame_force", "frame_moment", "joint_moment"):
        assert np.isnan(flat[name][0]).all()
        assert np.isfinite(flat[name][1:]).all()
    links["BC"]["length"] = 1.2
    locks = ct.reactions(ct.Mechanism(**parts, assembly={"sides": {"C": "left"}}), 41, 1.0, 0.0)
    status = locks.reaction_status.to_numpy()
    assert set(status.tolist()) >= {ct.Status.OK, ct.Status.OPEN}
    assert np.isnan(locks.joint_force.to_numpy()[status == ct.Status.OPEN]).all()
    assert np.isfinite(locks.joint_force.to_numpy()[status == ct.Status.OK]).all()


def test_what_makes_no_reactions() -> None:
    with pytest.raises(ct.InputError, match="not a moment in a hinge"):
        ct.reactions(ct.example("spherical-crank-rocker"))
    parts = crank(by="rocker")
    parts["loads"] = [
        {"kind": "friction", "link": "BC", "relative_to": "DC", "coefficient": 0.1, "radius": 0.01}
    ]
    with pytest.raises(ct.InputError):
        ct.reactions(ct.Mechanism(**parts))


def test_rings_and_inertia_without_mass() -> None:
    """The moment of momentum of a ring of a moving coupler is I (w . e) e, of a ball without mass I w."""
    parts = crank(by="rocker", loads=[], gravity=[1.0, -9.0, 3.0])
    parts["links"]["AB"] |= {"inertia": [0.3, 0.5, 0.7]}
    parts["links"]["BC"] = RING
    parts["links"]["DC"] |= {"inertia": 0.6}
    mechanism = ct.Mechanism(**parts)
    values = np.linspace(0.1, 6.0, 15)
    found, data, reduced = (
        ct.reactions(mechanism, at=values),
        ct.motion(mechanism, at=values),
        ct.reduce(mechanism, at=values),
    )
    wanted = reduced.reduced_inertia_slope * 9.0 / 2 - reduced.reduced_moment
    condition = float(np.sqrt(np.max(found.reaction_loss) / EPS))
    size = ROUNDING * condition * float(np.max(abs(found.joint_force)) + np.max(abs(wanted)))
    assert np.max(abs(found.balancing[:, 0] - wanted)) <= size
    w, e = (data[f"angular_{name}"].sel(link="BC").to_numpy() for name in ("velocity", "acceleration"))
    axis = place(data, "C")
    rate = dot(e, axis)[:, None] * axis + dot(w, axis)[:, None] * np.cross(w, axis)
    assert np.max(abs(found.inertia_moment.sel(link="BC") + 0.8 * rate)) <= size
    rocker = data.angular_acceleration.sel(link="DC").to_numpy()
    assert np.max(abs(found.inertia_moment.sel(link="DC") + 0.6 * rocker)) <= size
    # the driven link turns evenly about its first axis, a principal one
    assert np.max(abs(found.inertia_moment.sel(link="AB"))) <= size
    assert np.array_equal(found.inertia_force.sel(link=["AB", "DC"]), np.zeros((15, 2, 3)))


@pytest.mark.parametrize("ring", [False, True])
def test_steady_motion(ring: bool) -> None:
    """At the real speed of a machine the drive gives J q'' + J' q'^2/2 - M, and bearings what that motion asks for."""
    torque = {"kind": "torque", "link": "DC", "value": "-2*v - 0.5*v*abs(v)"}
    machine = {"mean_speed": 5.0, "fluctuation": 0.05}
    parts = crank(by="rocker", machine=machine, loads=[torque])
    if ring:
        parts["links"]["BC"] = RING
    mechanism = ct.Mechanism(**parts)
    found, steady = ct.reactions(mechanism, 25, motion="real"), ct.steady_motion(mechanism, 25)
    rate, bend = steady.drive_speed.to_numpy(), steady.drive_acceleration.to_numpy()
    reduced = Reducer.of(mechanism).at(found.drive_value.to_numpy()[:, 0], rate)
    wanted = reduced.inertia * bend + 0.5 * reduced.inertia_slope * rate**2 - reduced.moment
    size = float(np.max(abs(wanted))) * float(np.sqrt(np.max(found.reaction_loss) / EPS))
    assert found.attrs["rate_from"] == "steady"
    assert np.max(abs(found.drive_rate - rate)) <= ROUNDING * 5.0
    assert np.max(abs(found.balancing[:, 0] - wanted)) <= ROUNDING * size
