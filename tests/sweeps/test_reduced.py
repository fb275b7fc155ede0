"""Sweeps of reduced inertia and moment over masses and lengths: the numbers of `reduce`, by both executors."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import centrode as ct
from burdened import burdened
from centrode.model.examples import example_text
from centrode.numerics import machine_code
from growing import grown, mechanism_of
from mechanisms import EPS

COMPILED = pytest.mark.skipif(not machine_code.PRESENT, reason="needs llvmlite")
EXECUTORS = ["arrays", pytest.param("machine code", marks=COMPILED)]
OUTPUTS = ["reduced_inertia", "reduced_inertia_slope", "reduced_moment"]
VARIED = {
    "links.DH.mass": [10.0, 22.0, 30.0],
    "links.AB.inertia": [0.45, 0.1, 2.0],
    "links.OA.length": [0.33, 0.347, 0.35],
    "links.CD.points.D.x": [1.6, 1.7, 1.65],
}


def one_by_one(mechanism: ct.Mechanism, vary: dict[str, Any], samples: int) -> list[Any]:
    found = []
    for k in range(len(next(iter(vary.values())))):
        one = mechanism
        for path, values in vary.items():
            one = ct.with_value(one, path, values[k])
        found.append(ct.reduce(one, samples=samples))
    return found


@pytest.mark.parametrize("executor", EXECUTORS)
def test_the_press_over_masses_and_lengths(executor: str) -> None:
    press = ct.example("six-bar-press")
    swept = ct.sweep(press, VARIED, OUTPUTS, samples=25, executor=executor)
    assert swept.attrs["executor"] == executor
    for k, one in enumerate(one_by_one(press, VARIED, 25)):
        for name in OUTPUTS:
            # the same formulas at the same positions
            size = float(abs(one[name]).max())
            assert float(abs(swept[name][k] - one[name]).max()) <= 16 * EPS * size
            assert swept[name].attrs["units"] == one[name].attrs["units"]


SPHERICAL = {
    "links.AB.length": [0.26, 0.3, 0.2],
    "links.BC.mass": [1.0, 0.5, 2.0],
    "links.DC.radius": [0.02, 0.05, 0.01],
    "links.DC.centre.longitude": [0.3, 0.1, 0.2],
    "links.DC.centre_radius": [0.4, 0.2, 0.3],
    "links.BC.length": [0.9, 1.0, 0.8],
}


@pytest.mark.parametrize("executor", EXECUTORS)
def test_the_sphere(executor: str) -> None:
    """Arcs and discs follow their dimensions, tensors stay; loads of every kind that machine code knows."""
    rocker = ct.Mechanism(
        space="sphere",
        radius=0.5,
        gravity=[0.1, 2.0, -9.81],
        frame={"points": {"A": [1, 0, 0], "D": [0, 1, 0], "Z": [0, 0, 1]}},
        links={
            "AB": {"length": 0.26, "reference": ["A", "D"], "mass": 2, "centre": "B", "inertia": [0.1, 0.2, 0.15]},
            "BC": {"length": 0.9, "mass": 1, "shape": "arc"},
            "DC": {"length": 1.5, "reference": ["D", "Z"], "mass": 3, "shape": "disc", "radius": 0.02,
                   "centre": [0.3, 0.1], "centre_radius": 0.4},
        },
        drives=[{"link": "AB", "start": 0.1, "speed": 2}],
        assembly={"sides": {"C": "left"}},
        loads=[
            {"kind": "friction", "link": "BC", "relative_to": "DC", "value": 0.3, "viscous": 0.2, "quadratic": 0.1},
            {"kind": "friction", "link": "DC", "quadratic": 0.1, "form": "plain sum"},
            {"kind": "force", "point": "C", "vector": ["x", "-v", 2], "axes": "BC"},
            {"kind": "spring", "points": ["A", "C"], "stiffness": 20},
            {"kind": "spring", "link": "DC", "stiffness": 2},
        ],
    )  # fmt: skip
    swept = ct.sweep(rocker, SPHERICAL, OUTPUTS, samples=13, executor=executor)
    assert swept.attrs["executor"] == executor
    for k, one in enumerate(one_by_one(rocker, SPHERICAL, 13)):
        for name in OUTPUTS:
            size = float(abs(one[name]).max())
            assert float(abs(swept[name][k] - one[name]).max()) <= 256 * EPS * size


@pytest.mark.parametrize("executor", EXECUTORS)
def test_rods_and_discs_follow_their_dimensions(executor: str) -> None:
    bar = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 2, "shape": "rod"}},
        drives=[{"link": "OA", "speed": 1}],
        gravity=[0, -10],
    )
    vary = {"links.OA.length": [1.0, 2.0, 0.5], "links.OA.mass": [2.0, 3.0, 4.0]}
    swept = ct.sweep(bar, vary, OUTPUTS, samples=5, reduce="max", executor=executor)
    exact = np.array(vary["links.OA.mass"]) * np.array(vary["links.OA.length"]) ** 2 / 3
    assert np.allclose(swept.reduced_inertia, exact, rtol=16 * EPS, atol=0)
    wheel = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1, "mass": 2, "shape": "disc", "radius": 0.3, "centre": [0.1, 0]}},
        drives=[{"link": "OA", "speed": 1}],
    )
    vary = {"links.OA.radius": [0.3, 0.4], "links.OA.centre.x": [0.1, 0.2]}
    swept = ct.sweep(wheel, vary, "reduced_inertia", samples=5, reduce="max", executor=executor)
    assert np.allclose(swept.reduced_inertia, [0.09 + 0.02, 0.16 + 0.08], rtol=16 * EPS, atol=0)


@COMPILED
@pytest.mark.parametrize("seed", range(4))
def test_every_kind_of_load_as_machine_code(seed: int) -> None:
    """Formulas, springs, dampers, weights, one-sided and turning forces: the arrays' numbers."""
    parts = burdened(grown(["RRR", "RRP"], seed), seed)
    parts["links"]["link0"] |= {"mass": 1.0}
    mechanism = mechanism_of(parts)
    vary = {"links.link0.mass": np.linspace(1.0, 2.0, 5)}
    start = mechanism.drives[0].start or 0.0
    ends = {"samples": 7, "start": start - 0.1, "stop": start + 0.1}
    both = [ct.sweep(mechanism, vary, OUTPUTS, executor=name, **ends) for name in ("arrays", "machine code")]
    for name in OUTPUTS:
        size = float(abs(both[0][name]).max())
        assert np.isfinite(size)
        assert float(abs(both[0][name] - both[1][name]).max()) <= 256 * EPS * size


def test_formulas_may_name_what_is_reduced() -> None:
    press = ct.example("six-bar-press")
    swept = ct.sweep(press, {"links.DH.mass": [22.0, 30.0]}, samples=37, reduce="max(reduced_inertia)")
    exact = [
        float(one.reduced_inertia.max()) for one in one_by_one(press, {"links.DH.mass": [22.0, 30.0]}, 37)
    ]
    assert np.allclose(swept["value"], exact, rtol=16 * EPS, atol=0)


def test_a_diagram_is_computed_by_arrays() -> None:
    text = example_text("six-bar-press").replace(
        'point = "H"\nvector = [-9000, 0]\nwhile_moving = [1, 0]',
        'guide = "H"\ntable = [[1, -9000, 0], [4, -9000, 0]]',
    )
    press = ct.parse_mechanism(text)
    vary = {"links.DH.mass": [22.0, 30.0]}
    swept = ct.sweep(press, vary, "reduced_moment", samples=13)
    one = ct.reduce(press, samples=13)
    assert float(abs(swept.reduced_moment[0] - one.reduced_moment).max()) <= 16 * EPS * 9000
    if machine_code.PRESENT:
        with pytest.raises(ct.InputError, match="indicator diagrams"):
            ct.sweep(press, vary, "reduced_moment", samples=13, executor="machine code")


def test_a_stroke_beside_its_diagram_has_no_number() -> None:
    text = example_text("six-bar-press").replace(
        'point = "H"\nvector = [-9000, 0]\nwhile_moving = [1, 0]',
        'guide = "H"\ntable = [[1, -9000, 0], [3.6, -9000, 0]]',
    )
    vary = {"links.DH.points.H.x": [1.7, 1.9]}
    swept = ct.sweep(ct.parse_mechanism(text), vary, "reduced_moment", samples=73)
    assert np.isfinite(swept.reduced_moment[0]).all()
    assert np.isnan(swept.reduced_moment[1]).any()


@pytest.mark.parametrize("executor", EXECUTORS)
def test_derivatives_by_masses(executor: str) -> None:
    """Inertia is linear in the mass of a link: its derivative is the link's share over the mass."""
    press = ct.example("six-bar-press")
    swept = ct.sweep(
        press,
        {"links.slider.mass": [3.5, 7.0]},
        "reduced_inertia",
        samples=37,
        reduce="mean",
        gradient=True,
        executor=executor,
    )
    share = ct.reduce(press, samples=37).reduced_inertia_part.sel(link="slider").mean() / 3.5
    assert np.allclose(swept["gradient.reduced_inertia"], float(share), rtol=64 * EPS, atol=0)


@pytest.mark.parametrize(
    ("name", "vary", "reason"),
    [
        ("kite", {"links.OA.length": [1.0, 1.1]}, "neither masses nor loads"),
        ("six-bar-press", {"links.DH.mass": [-1.0, 1.0]}, "is negative"),
        ("six-bar-press", {"links.DH.mass": ["3 m", "4 m"]}, "links.DH.mass"),
        ("six-bar-press", {"links.OA.mass": [1.0]}, "links.OA.mass"),
        ("two-link-arm", {"links.OA.length": [1.0]}, "several"),
    ],
)
def test_what_cannot_be_reduced_is_refused(name: str, vary: dict[str, Any], reason: str) -> None:
    with pytest.raises(ct.InputError, match=reason):
        ct.sweep(ct.example(name), vary, "reduced_inertia", samples=5)


TIED = """
[[loads]]
kind = "spring"
points = ["B", "D"]
stiffness = 80.0
free_length = 1.0
[[loads]]
kind = "damper"
points = ["O", "B"]
damping = 12.0
[[loads]]
kind = "spring"
points = ["A", "D"]
stiffness = 50.0
"""


@pytest.mark.parametrize("executor", EXECUTORS)
def test_loads_act_on_points_of_the_frame_where_these_are(executor: str) -> None:
    tied = ct.parse_mechanism(example_text("in-line-four-bar") + TIED)
    vary = {"frame.points.D.x": [0.39, 0.4, 0.42], "frame.points.O.y": [0.0, 0.01, -0.01]}
    swept = ct.sweep(tied, vary, OUTPUTS, samples=25, executor=executor)
    for k, one in enumerate(one_by_one(tied, vary, 25)):
        for name in OUTPUTS:
            size = float(abs(one[name]).max())
            assert float(abs(swept[name][k] - one[name]).max()) <= 64 * EPS * size
