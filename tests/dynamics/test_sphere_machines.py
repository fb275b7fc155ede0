"""Spherical machines by hand: the thesis's crank-rocker and Hooke's joint."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, sin, tan
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from centrode.dynamics.reduction import Reducer
from centrode.model.examples import example_text
from mechanisms import EPS
from spherical_bodies import Cloud, dot, place, rotation

Array = npt.NDArray[np.float64]

TURN = np.linspace(0.0, 2 * pi, 37)
FIGURES = [
    (pi / 24, pi / 2 - pi / 24),
    (pi / 24, pi / 3 - pi / 24),
    (pi / 24, pi / 6 - pi / 24),
    (pi / 12, pi / 3 - pi / 12),
    (pi / 13, pi / 2 - pi / 13),
]


@dataclass(frozen=True)
class Thesis:
    """The closed forms of the source, as its page of errata has them."""

    crank: float
    coupler: float
    beta: Array

    @property
    def gamma(self) -> Array:
        return np.asarray(np.arcsin(sin(self.crank) * np.cos(self.beta) / sin(self.coupler)))

    @property
    def gamma_slope(self) -> Array:
        return np.asarray(-sin(self.crank) * np.sin(self.beta) / (sin(self.coupler) * np.cos(self.gamma)))

    @property
    def psi(self) -> Array:
        """Root of cos BC = cos AB sin psi + sin AB cos psi sin beta."""
        along, across = cos(self.crank) + 0 * self.beta, sin(self.crank) * np.sin(self.beta)
        return np.asarray(np.arcsin(cos(self.coupler) / np.hypot(along, across)) - np.arctan2(across, along))

    @property
    def psi_slope(self) -> Array:
        a, psi = self.crank, self.psi
        through = cos(a) * np.cos(psi) - sin(a) * np.sin(psi) * np.sin(self.beta)
        return np.asarray(-sin(a) * np.cos(psi) * np.cos(self.beta) / through)

    @property
    def inertia(self) -> Array:
        """I_AB + I_CB gamma'^2 + (I_CD + m_CB) psi'^2."""
        coupler = (1 - cos(self.coupler)) * self.gamma_slope**2
        return np.asarray(1 - cos(self.crank) + coupler + 2.0 * self.psi_slope**2)

    @property
    def size(self) -> Array:
        """How much rounding is enlarged where coupler and crank come into line, or gamma near a quarter turn."""
        reach = np.hypot(cos(self.crank), sin(self.crank) * np.sin(self.beta))
        flat = np.sqrt(np.maximum(0.0, 1 - (cos(self.coupler) / reach) ** 2))
        return np.asarray(1 / np.maximum(flat, np.sqrt(EPS)) + 1 / np.cos(self.gamma) ** 2)


def thesis(crank: float, coupler: float, **more: Any) -> ct.Mechanism:
    """The example with other arcs and their inertias."""
    ring = {"model": "ring and point mass"}
    parts: dict[str, Any] = {
        "space": "sphere",
        "frame": {"points": {"A": [1, 0, 0], "D": [0, 1, 0], "Z": [0, 0, 1]}},
        "links": {
            "AB": {"length": crank, "reference": ["A", "D"], "centre": "A", "inertia": 1 - cos(crank)} | ring,
            "BC": {"points": ["C", "B"], "length": coupler, "reference": ["C", "D"], "centre": "C", "mass": 1}
            | ring
            | {"inertia": 1 - cos(coupler)},
            "DC": {"length": pi / 2, "reference": ["D", "Z"], "centre": "D", "inertia": 1} | ring,
        },
        "drives": [{"link": "AB", "start": 0, "speed": 2}],
        "assembly": {"sides": {"C": "left"}},
    }
    return ct.Mechanism(**{**parts, **more})


def friction(link: str, other: str, **amount: Any) -> dict[str, Any]:
    return {"kind": "friction", "link": link, "relative_to": other} | amount


HINGES = [("AB", "frame"), ("BC", "DC"), ("DC", "frame")]


@pytest.mark.parametrize(("crank", "coupler"), FIGURES)
def test_inertia_and_friction_of_the_thesis(crank: float, coupler: float) -> None:
    sums = [friction(*hinge, quadratic=0.1, form="plain sum") for hinge in HINGES]
    work = [friction(*hinge, quadratic=0.1) for hinge in HINGES]
    reducer = Reducer.of(thesis(crank, coupler, loads=sums + work))
    source, found = Thesis(crank, coupler, TURN), reducer.at(TURN, rate=3.0)
    allowed = 64 * EPS * source.size**2
    assert (abs(found.inertia - source.inertia) <= allowed * source.inertia).all()
    slopes = [1 + 0 * TURN, source.gamma_slope, source.psi_slope]
    for k, slope in enumerate(slopes):
        plain, virtual = found.moment_parts[k], found.moment_parts[3 + k]
        assert (abs(plain + 0.1 * 9 * slope**2) <= allowed).all()
        assert (abs(virtual + 0.1 * 9 * abs(slope) ** 3) <= allowed).all()
    backwards = reducer.at(TURN, rate=-3.0)
    assert np.array_equal(backwards.moment_parts, -found.moment_parts)


@pytest.mark.parametrize(
    ("crank", "coupler", "first"), [(pi / 12, pi / 4, 0.3747), (pi / 24, pi / 2 - pi / 24, 0.1320)]
)
def test_gamma_is_a_joint_angle(crank: float, coupler: float, first: float) -> None:
    """gamma counts from the circle of C, the joint angle from the rocker, a quarter turn farther."""
    data = ct.motion(thesis(crank, coupler), at=TURN)
    source = Thesis(crank, coupler, TURN)
    gamma = pi / 2 - abs(data.joint_angle.sel(joint="BC").to_numpy())
    assert abs(gamma[0] - first) <= 0.5e-4
    allowed = 64 * EPS * source.size
    assert (abs(gamma - source.gamma) <= allowed).all()
    assert (abs(data.joint_angle.sel(joint="DC") - source.psi) <= allowed).all()


def test_the_examples_are_the_thesis_and_rigid_bodies() -> None:
    found = Reducer.of(ct.example("spherical-crank-rocker")).at(TURN, rate=2.0)
    source = Thesis(pi / 12, pi / 4, TURN)
    assert np.allclose(found.inertia, source.inertia, rtol=64 * EPS, atol=0)
    total = 0.1 * 4 * (1 + source.gamma_slope**2 + source.psi_slope**2)
    assert np.allclose(found.moment, -total, rtol=64 * EPS, atol=0)
    rigid = ct.example("spherical-crank-rocker-rigid")
    data, reduced = ct.motion(rigid, at=TURN), ct.reduce(rigid, at=TURN)
    # the coupler as so many mass points on its arc that Gauss's rule is exact
    nodes, weights = np.polynomial.legendre.leggauss(24)
    along = pi / 8 * (1 + nodes)
    r = np.stack([np.cos(along), np.sin(along), 0 * along], axis=1)
    cloud = Cloud(weights / 2, r)
    omega = data.angular_velocity.sel(link="BC").to_numpy()[:, None, :]
    speed = np.cross(omega, np.einsum("nij,pj->npi", rotation(rigid, data, "BC"), cloud.places))
    twice = np.einsum("p,npk,npk->n", cloud.masses, speed, speed) / 2.94**2
    assert np.allclose(reduced.reduced_inertia_part.sel(link="BC"), twice, rtol=256 * EPS, atol=0)


@pytest.mark.parametrize("bend", [20, 45, 70])
def test_hookes_joint(bend: float) -> None:
    """Shafts at an angle a: dphi_2/dphi_1 = cos a/(1 - sin(a)^2 sin(phi_1)^2), phi_1 from the normal of both."""
    a = radians(bend)
    joint = ct.Mechanism(
        space="sphere",
        frame={"points": {"A": [1, 0, 0], "D": [cos(a), sin(a), 0], "N": [0, 0, 1]}},
        links={
            "driver": {"points": ["A", "B"], "length": pi / 2, "reference": ["A", "N"],
                       "mass": 2, "centre": "A", "inertia": [0.7, 0.9, 1.1]},
            "cross": {"points": ["B", "C"], "length": pi / 2, "mass": 3, "centre_radius": 0, "centre": "B",
                      "inertia": [0.3, 0.3, 0.5]},
            "driven": {"points": ["D", "C"], "length": pi / 2, "reference": ["D", "N"], "angle": pi / 2,
                       "centre": "D", "inertia": [0.4, 0.5, 0.6]},
        },
        drives=[{"link": "driver", "start": 0, "speed": 1.5}],
        assembly={"sides": {"C": "right"}},
    )  # fmt: skip
    phi = np.linspace(0.1, 6.2, 41)
    data, reduced = ct.motion(joint, at=phi), ct.reduce(joint, at=phi)
    ratio = cos(a) / (1 - sin(a) ** 2 * np.sin(phi) ** 2)
    slope = ratio**2 / cos(a) * 2 * sin(a) ** 2 * np.sin(phi) * np.cos(phi)
    rate = data.joint_velocity.sel(joint="driven") / 1.5
    allowed = 256 * EPS / cos(a) ** 2
    assert np.max(abs(rate - ratio)) <= allowed
    # the driver turns by 1 about A, the cross against it about B: w = e_A + s e_B = ratio e_D + u e_C
    pins = [place(data, name) for name in "ABCD"]
    matrix = np.stack([pins[1], -pins[2]], axis=-1)
    wanted = ratio[:, None] * pins[3] - pins[0]
    turns = np.stack([np.linalg.lstsq(m, w, rcond=None)[0] for m, w in zip(matrix, wanted, strict=True)])
    spin = pins[0] + turns[:, :1] * pins[1]
    normal = np.cross(pins[1], pins[2])
    energy = 0.3 * dot(spin, pins[1]) ** 2 + 0.3 * dot(spin, pins[2]) ** 2 + 0.5 * dot(spin, normal) ** 2
    inertia = reduced.reduced_inertia_part
    assert np.max(abs(inertia.sel(link="driver") - 0.7)) <= allowed
    assert np.max(abs(inertia.sel(link="driven") - 0.4 * ratio**2)) <= allowed * np.max(ratio) ** 2
    assert np.max(abs(inertia.sel(link="cross") - energy)) <= allowed * np.max(ratio) ** 2 * 4
    slopes = reduced.reduced_inertia_slope_part.sel(link="driven")
    assert np.max(abs(slopes - 0.8 * ratio * slope)) <= allowed * (1 + tan(a) ** 2) ** 2 * 4


def test_steady_motion_of_a_spherical_machine() -> None:
    """J eps + J' w^2/2 is the moment of drive and loads at the real speed, friction included; a turn takes its work."""
    text = example_text("spherical-crank-rocker-rigid")
    machine = ct.parse_mechanism(text + "\n[machine]\nmean_speed = 2.94\nfluctuation = 0.1\n")
    steady = ct.steady_motion(machine, samples=37)
    q, speed = steady.drive_value.isel(drive=0).to_numpy(), steady.drive_speed.to_numpy()
    found = Reducer.of(machine).at(q, rate=speed)
    carried = steady.attrs["inertia"] + found.inertia
    left = carried * steady.drive_acceleration.to_numpy() + 0.5 * speed**2 * found.inertia_slope
    right = found.moment + steady.driving_moment.to_numpy()
    assert steady.attrs["inertia"] > 0
    # loads and speed are made to agree up to this share of the moments
    assert np.max(abs(left - right)) <= 1e-11 * np.max(abs(found.moment))
    assert abs((speed.max() - speed.min()) / 2.94 - 0.1) <= 0.01


@pytest.mark.parametrize(
    ("crank", "coupler", "moment", "least", "greatest", "mean"),
    [(pi / 12, pi / 4, 1.0, 2.478, 3.631, 2.940), (pi / 13, pi / 2 - pi / 13, 3.5, 5.062, 6.532, None)],
)
def test_steady_speeds_of_the_thesis(
    crank: float, coupler: float, moment: float, least: float, greatest: float, mean: float | None
) -> None:
    """With w = J q'^2 the equation is linear by q, w' = 2 M - 2 F w/J, F the friction at unit speed.

    A turn maps w on a w + b, which has one fixed point: the steady regime.
    """
    sums = [friction(*hinge, quadratic=0.1, form="plain sum") for hinge in HINGES]
    reducer, count = Reducer.of(thesis(crank, coupler, loads=sums)), 2000
    q = np.linspace(0.0, 2 * pi, 2 * count + 1)
    found = reducer.at(q, rate=1.0)
    assert (found.status == ct.Status.OK).all()
    drop, step = -2.0 * found.moment / found.inertia, 2 * pi / count

    def turned(first: float) -> Array:
        w = [first]
        for n in range(0, 2 * count, 2):
            k1 = 2 * moment - drop[n] * w[-1]
            k2 = 2 * moment - drop[n + 1] * (w[-1] + 0.5 * step * k1)
            k3 = 2 * moment - drop[n + 1] * (w[-1] + 0.5 * step * k2)
            k4 = 2 * moment - drop[n + 2] * (w[-1] + step * k3)
            w.append(w[-1] + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4))
        return np.array(w)

    share = turned(1.0)[-1] - turned(0.0)[-1]
    speed = np.sqrt(turned(turned(0.0)[-1] / (1 - share)) / found.inertia[::2])
    half = 0.5e-3  # of the last digit given
    assert abs(speed.min() - least) <= half
    assert abs(speed.max() - greatest) <= half
    if mean is not None:
        assert abs(1 / np.mean(1 / speed[:-1]) - mean) <= half
