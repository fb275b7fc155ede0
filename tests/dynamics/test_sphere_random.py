"""Random spherical mechanisms: energy is that of clouds of mass points, virtual power is power."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.kinematics.preparation import ready
from growing_sphere import Growing, grown
from mechanisms import EPS
from samples import few
from spherical_bodies import Array, Cloud, dot, drawn, place, rotation, spin, velocities

WIDTH, SAMPLES, SPEED, RADIUS = 0.3, 7, -1.7, 0.8
GRAVITY = [1.3, -9.7, 2.1]
ONE_DRIVE = ("RRR", "RRP", "RPR", "PRP", "rigid point")


def burdened(growing: Growing, seed: int) -> tuple[dict[str, Any], dict[str, Cloud]]:
    """The description with a cloud on each link, and a load of every kind."""
    random = np.random.default_rng(seed)
    parts = growing.parts() | {"gravity": GRAVITY, "radius": RADIUS}
    clouds = {name: drawn(random, RADIUS) for name in parts["links"]}
    for name, cloud in clouds.items():
        parts["links"][name] |= cloud.keys()
    moving = [name for name in growing.places if name not in growing.frame]
    links = list(parts["links"])

    def some(names: list[str], *but: str) -> str:
        return str(random.choice([name for name in names if name not in but]))

    pair = random.choice(list(growing.places), 2, replace=False).tolist()
    link = some(links)
    axis, other = random.normal(size=3).tolist(), some(["frame", *links], link)
    parts["loads"] = [
        {"kind": "force", "point": some(moving), "vector": [2.0, -1.0, 0.5]},
        {"kind": "force", "point": some(moving), "vector": [0.7, -1.1, 3.0], "axes": some(links)},
        {"kind": "force", "point": some(moving), "vector": ["2*x - v", "-v*abs(v)", "sin(q)"]},
        {"kind": "force", "point": some(moving), "vector": [3, -2, 1], "while_moving": [0.6, 0.8, -1.0]},
        {"kind": "torque", "link": link, "relative_to": other, "axis": axis, "value": "1.5 - 0.2*v"},
        {"kind": "torque", "link": "link0", "value": "0.4*x"},
        {"kind": "spring", "points": pair, "stiffness": 40.0, "free_length": 0.1},
        {"kind": "damper", "link": link, "relative_to": other, "axis": axis, "damping": 0.8},
        {"kind": "friction", "link": link, "relative_to": other, "axis": axis, "value": 0.7},
        {"kind": "friction", "link": "link0", "viscous": 0.3, "quadratic": 0.9},
        {"kind": "weight", "point": some(moving), "value": 6.0},
        *[
            {"kind": "friction", "guide": guide["name"], "value": 2.0, "viscous": 0.5}
            for guide in parts["guides"][:1]
        ],
    ]
    return parts, clouds


def powers(mechanism: ct.Mechanism, data: Any, clouds: dict[str, Cloud]) -> list[Array]:
    """Power of each load of the description, then of the weights of all links [W], from places and velocities."""
    found = [_power(mechanism, load, data) for load in mechanism.loads]
    for name, cloud in clouds.items():
        speed = velocities(mechanism, data, name, cloud)[0]
        found.append(np.einsum("npk,k,p->n", speed, GRAVITY, cloud.masses))
    return found


def _power(mechanism: ct.Mechanism, load: Any, data: Any) -> Array:
    if hasattr(load, "guide"):
        v = RADIUS * data.slide_velocity.sel(guide=load.guide).to_numpy()
        return np.asarray(-2.0 * np.abs(v) - 0.5 * v**2)
    if hasattr(load, "points"):
        first, second = (RADIUS * place(data, name) for name in load.points)
        apart = second - first
        speed = RADIUS * (place(data, load.points[1], "velocity") - place(data, load.points[0], "velocity"))
        length = np.sqrt(dot(apart, apart))
        return np.asarray(-40.0 * (length - 0.1) * dot(apart, speed) / length)
    if hasattr(load, "point"):
        return _of_force(mechanism, load, data)
    if load.axis is None:
        axis = place(data, next(iter(mechanism.links["link0"].coordinates)))
    else:
        axis = np.asarray(load.axis) / np.linalg.norm(load.axis)
    v = dot(spin(data, load.link) - spin(data, load.relative_to), axis)
    if load.kind == "torque":
        x = data.joint_angle.sel(joint="link0").to_numpy()
        return np.asarray((1.5 - 0.2 * v if load.axis else 0.4 * x) * v)
    if load.kind == "damper":
        return np.asarray(-0.8 * v**2)
    return np.asarray(-0.7 * np.abs(v) if load.axis else -0.3 * v**2 - 0.9 * np.abs(v) ** 3)


def _of_force(mechanism: ct.Mechanism, load: Any, data: Any) -> Array:
    r, v = RADIUS * place(data, load.point), RADIUS * place(data, load.point, "velocity")
    if load.kind == "weight":
        return np.asarray(6.0 * dot(v, np.array(GRAVITY) / np.linalg.norm(GRAVITY)))
    if isinstance(load.vector[0], str):
        x, u, w = r[:, 0], v[:, 0], v[:, 1]
        q = data.drive_value.isel(drive=0).to_numpy()
        return np.asarray((2 * x - u) * u - w**2 * np.abs(w) + np.sin(q) * v[:, 2])
    force = np.array(load.vector)
    if load.while_moving is not None:
        return np.where(dot(v, np.array(load.while_moving)) >= 0.0, dot(v, force), 0.0)
    turned = force if load.axes == "frame" else rotation(mechanism, data, load.axes) @ force
    return dot(v, turned)


@pytest.mark.parametrize("seed", range(few(12, 24)))
def test_random_spherical_mechanisms(seed: int) -> None:
    kinds = np.random.default_rng(seed).choice(ONE_DRIVE, 1 + seed % 4).tolist()
    growing = grown(kinds, seed)
    parts, clouds = burdened(growing, seed)
    parts["drives"][0]["speed"] = SPEED
    mechanism = ct.Mechanism(**parts)
    prepared = ready(mechanism)
    initial = prepared.kinematics.path.initial
    ends = {"samples": SAMPLES, "start": initial - WIDTH, "stop": initial + WIDTH}
    data, reduced = ct.motion(mechanism, **ends), ct.reduce(mechanism, **ends)
    good = data.status.to_numpy() == ct.Status.OK
    assert good.any()
    assert np.array_equal(data.status, reduced.status)
    assert np.array_equal(np.isfinite(reduced.reduced_inertia), np.isfinite(spin(data, "link0")[:, 0]))
    # both stand on the same positions; the axes of a link here are those of two of its points
    nearest = min(
        np.linalg.norm(np.cross(*(growing.places[p] for p in list(body["points"])[:2])))
        for body in growing.links.values()
    )
    error = 256 * EPS / min(nearest, 1.0)
    fast = max(float(np.nanmax(abs(spin(data, name)))) for name in growing.links) + 1.0
    swift = (
        max(float(np.nanmax(abs(spin(data, name, "angular_acceleration")))) for name in growing.links)
        + fast**2
    )
    moved, changed = error * fast, error * swift
    total = 0.0
    for name, cloud in clouds.items():
        speed, bend = velocities(mechanism, data, name, cloud)
        energy = 0.5 * np.einsum("p,npk,npk->n", cloud.masses, speed, speed)
        power = np.einsum("p,npk,npk->n", cloud.masses, speed, bend)
        inertia, slope = (
            reduced[f"reduced_inertia{x}_part"].sel(link=name).to_numpy() for x in ("", "_slope")
        )
        assert np.max(abs(0.5 * SPEED**2 * inertia - energy)[good]) <= cloud.size * fast * moved * SPEED**2
        allowed = cloud.size * (fast * changed + swift * moved) * 4
        assert np.max(abs(0.5 * SPEED**3 * slope - power)[good]) <= allowed
        total += cloud.size
    given_power = powers(mechanism, data, clouds)
    assert len(given_power) == reduced.sizes["load"]
    reach = (10.0 + total) * (1.0 + fast) ** 2 * moved * abs(SPEED)
    for k, power in enumerate(given_power):
        part = SPEED * reduced.reduced_moment_part.isel(load=k).to_numpy()
        assert np.max(abs(part - power)[good]) <= reach, reduced["load"][k]


@pytest.mark.parametrize("seed", range(4))
def test_several_drives(seed: int) -> None:
    """Energy by the inertia matrix; Sum m a . r_k by matrix and Christoffel terms; generalised forces."""
    parts, clouds = burdened(grown(["turned link", "RRR"], seed), seed)
    parts["loads"] = [load for load in parts["loads"] if "q" not in str(load.get("vector"))]
    del parts["drives"][0]["speed"]
    parts["drives"][0]["law"], parts["drives"][1]["speed"] = "0.3*sin(2*t)", 0.4
    mechanism = ct.Mechanism(**parts)
    times = np.linspace(0.0, 0.4, 5)
    data, reduced = ct.motion(mechanism, at=times), ct.reduce(mechanism, at=times)
    ok = reduced.status.to_numpy() == ct.Status.OK
    assert ok.any()
    rates = np.stack([0.6 * np.cos(2 * times), 0.4 + 0.0 * times], axis=1)
    bends = np.stack([-1.2 * np.sin(2 * times), 0.0 * times], axis=1)
    matrix, terms = reduced.inertia_matrix.to_numpy(), reduced.christoffel.to_numpy()
    energy, power, sizes = np.zeros(5), np.zeros(5), 0.0
    for name, cloud in clouds.items():
        speed, bend = velocities(mechanism, data, name, cloud)
        energy += 0.5 * np.einsum("p,npk,npk->n", cloud.masses, speed, speed)
        power += np.einsum("p,npk,npk->n", cloud.masses, speed, bend)
        sizes += cloud.size
    scale = (
        sizes
        * (1.0 + float(np.nanmax(abs(data.angular_velocity))))
        * (1.0 + float(np.nanmax(abs(data.angular_acceleration))))
    )
    scale *= 4096 * EPS * (1.0 + float(np.nanmax(abs(matrix))) / sizes + float(np.nanmax(abs(terms))) / sizes)
    assert np.max(abs(0.5 * np.einsum("nij,ni,nj->n", matrix, rates, rates) - energy)[ok]) <= scale
    inertia = np.einsum("nkj,nj->nk", matrix, bends) + np.einsum("nijk,ni,nj->nk", terms, rates, rates)
    assert np.max(abs(dot(inertia, rates) - power)[ok]) <= scale
    force = reduced.generalised_force_part.to_numpy()
    for k, own in enumerate(powers(mechanism, data, clouds)):
        strong = 1.0 + float(np.max((abs(force[:, k]) * abs(rates)).sum(axis=1)[ok]))
        assert np.max(abs(dot(force[:, k], rates) - own)[ok]) <= 4096 * EPS * strong * (
            1.0 + scale / EPS / 4096
        )
