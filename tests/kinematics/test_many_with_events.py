"""Many motions with limits and change points as machine code: the bits and the statuses of the arrays."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from centrode.kinematics.machine_code import batch
from centrode.kinematics.machine_code.events import Eventful
from centrode.kinematics.path import SampleGrid, grid_at
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import Solved, requested_grid, solve
from centrode.numerics import machine_code
from centrode.structure.dimensions import dimensions_of
from drives import five_bar
from growing import DYADS, grown, mechanism_of
from growing_sphere import KINDS as ON_SPHERE
from growing_sphere import grown as grown_on_sphere
from mechanisms import four_bar, parts_of
from samples import few, spread

pytestmark = pytest.mark.skipif(not machine_code.PRESENT, reason="machine code needs the extra fast")

Array = npt.NDArray[np.float64]
Vary = dict[str, Array]
ARRAYS = ("all_points", "angles", "slides", "spins", "contacts", "residual", "status")
NEAR = np.array([0.0, 1.0, 2.0, 3.0, 8.0, 100.0, 1e4, 1e7])
"""Distances in units of the last place."""
OPEN = ct.Status.OPEN.value


@pytest.fixture(autouse=True)
def by_machine_code(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[int]]:
    """However few there are, machine code computes them; the mechanisms with events that it did."""
    monkeypatch.setattr(batch, "WORTH_COMPILING", 1)
    lanes: list[int] = []
    part = Eventful._part

    def counted(self: Eventful, search: Any, some: Any) -> Solved:
        lanes.append(len(some))
        return part(self, search, some)

    monkeypatch.setattr(Eventful, "_part", counted)
    yield lanes


def around(places: Any) -> Array:
    """Places and what lies next to them."""
    at = np.atleast_1d(np.asarray(places, dtype=np.float64))[:, None]
    steps = np.concatenate([-NEAR[:0:-1], NEAR]) * np.spacing(np.maximum(np.abs(at), 1.0))
    return np.unique(at + steps)


def both(mechanism: ct.Mechanism, vary: Vary, at: Array | int) -> tuple[Solved, Solved]:
    """The motions with machine code, and by arrays, at places or at so many samples."""
    prepared = ready(mechanism)
    span: SampleGrid = (
        requested_grid(prepared, at, None, None)
        if isinstance(at, int)
        else grid_at(prepared.kinematics.path, at)
    )
    numbers, lanes = dimensions_of(mechanism, vary, np), len(next(iter(vary.values())))
    return batch.solve_many(prepared, span, numbers, lanes), solve(prepared, span, numbers, lanes)


def same(found: Solved, expected: Solved, off: float = 0.0) -> None:
    """Every bit, every status, every event; residuals may be off by so much."""
    for name in ARRAYS:
        if name == "residual":
            np.testing.assert_allclose(found.residual, expected.residual, rtol=0.0, atol=off)
        elif getattr(expected, name) is not None:
            np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), err_msg=name)
    told = [
        sorted((e.lane, e.group, e.kind, e.at, str(e.closes_above)) for e in solved.branches.events)
        for solved in (found, expected)
    ]
    assert told[0] == told[1]
    assert found.worst_constraint.label == expected.worst_constraint.label


def drawn(mechanism: ct.Mechanism, draw: np.random.Generator, spread: float, count: int) -> Vary:
    """Some lengths and places of a mechanism, varied by up to a share of themselves."""
    axis = "x" if mechanism.space == "plane" else "longitude"
    paths = [f"frame.points.{name}.{axis}" for name in mechanism.frame.points]
    for name, link in mechanism.links.items():
        if link.length is not None:
            paths.append(f"links.{name}.length")
        elif mechanism.space == "plane":
            paths += [f"links.{name}.points.{point}.x" for point in link.coordinates]
    paths = [path for path in paths if abs(ct.value_at(mechanism, path)) > 0.01]
    chosen = draw.choice(paths, size=min(len(paths), 3), replace=False).tolist()
    return {
        path: ct.value_at(mechanism, path) * draw.uniform(1.0 - spread, 1.0 + spread, count)
        for path in chosen
    }


SIX_BAR = ("RRR", "RRR")
SLIDERS = ("RRP", "RRP carriage", "RPR", "RPR block", "PRP")


@pytest.mark.parametrize("seed", range(few(4, 14)))
def test_random_mechanisms_of_which_many_lock(seed: int) -> None:
    draw = np.random.default_rng(seed)
    kinds = {0: ["RRR"], 1: list(SIX_BAR), 2: [str(draw.choice(SLIDERS))]}.get(seed % 4)
    kinds = kinds or [str(kind) for kind in draw.choice(DYADS, size=3)]
    mechanism = mechanism_of(grown(kinds, seed))
    same(*both(mechanism, drawn(mechanism, draw, 0.4, 120), 31))


@pytest.mark.parametrize("seed", range(4))
def test_random_mechanisms_on_the_sphere(seed: int) -> None:
    draw = np.random.default_rng(seed)
    mechanism = ct.Mechanism(
        **grown_on_sphere([str(k) for k in draw.choice(ON_SPHERE, size=2)], seed).parts()
    )
    same(*both(mechanism, drawn(mechanism, draw, 0.4, 60), 25))


def test_a_fifth_of_the_samples_open(by_machine_code: list[int]) -> None:
    draw = np.random.default_rng(11)
    vary = {f"links.{link}.length": draw.uniform(0.7, 4.0, 2000) for link in ("OA", "AB", "DB")}
    found, expected = both(four_bar(1.0, 3.0, 3.0, 3.5), vary, 19)
    assert 0.15 < (expected.status == OPEN).mean() < 0.5
    same(found, expected)
    assert 500 < sum(by_machine_code) < 2000


SPECIAL = {
    "parallelogram": ("links.OA.length", "links.DB.length"),
    "antiparallelogram": ("links.OA.length", "links.DB.length"),
    "kite": ("links.OA.length", "links.AB.length"),
    "three-crank-parallelogram": ("links.OA.length", "links.DB.length", "links.FE.length"),
}
"""Paths whose common change leaves the change points where they are."""


@pytest.mark.parametrize("continuation", ["smooth", "keep"])
@pytest.mark.parametrize("name", SPECIAL)
def test_change_points(name: str, continuation: str, by_machine_code: list[int]) -> None:
    parts = parts_of(ct.example(name))
    parts["assembly"] = {**parts.get("assembly", {}), "continuation": continuation}
    mechanism = ct.Mechanism(**parts)
    size = np.random.default_rng(3).uniform(0.8, 1.1, 20)
    vary = {path: ct.value_at(mechanism, path) * size for path in SPECIAL[name]}
    at = np.concatenate([np.linspace(-6.9, 6.9, 80), around(np.pi * np.arange(-2, 3))])
    found, expected = both(mechanism, vary, at)
    same(found, expected)
    assert sum(by_machine_code) == 20
    assert len(expected.branches.events) >= 4 * 20


@pytest.mark.parametrize("name", spread([*SPECIAL, "galloway", "scott-russell"], 3))
def test_change_points_that_are_just_missed(name: str) -> None:
    """Lengths wrong in their last places, samples next to where a change point would be."""
    mechanism = ct.example(name)
    path = next(f"links.{k}.length" for k, link in mechanism.links.items() if link.length is not None)
    misses = np.concatenate([NEAR, -NEAR[1:], 1e-3 * NEAR, [1e10, -1e10, 1e13, -1e13]]) * 2.0**-52
    at = np.concatenate([np.linspace(-6.9, 6.9, 40), around(0.5 * np.pi * np.arange(-4, 5))])
    same(*both(mechanism, {path: ct.value_at(mechanism, path) * (1.0 + misses)}, at))


@pytest.mark.parametrize("seed", range(few(3, 6)))
def test_samples_next_to_limits(seed: int, by_machine_code: list[int]) -> None:
    """Samples within a few units of the last place of every limit of every mechanism."""
    draw = np.random.default_rng(seed)
    a, b, c = draw.uniform(0.8, 2.0, 3)
    mechanism = four_bar(a, b, c, 0.9 * (b + c) - a)
    vary = {"links.AB.length": b * draw.uniform(0.8, 1.0, 8)}
    limits = [event.at for event in both(mechanism, vary, 73)[1].branches.events]
    assert limits
    found, expected = both(mechanism, vary, around(limits))
    same(found, expected)
    assert {OPEN, ct.Status.SINGULAR.value, ct.Status.OK.value} <= set(np.unique(expected.status).tolist())


def chain(count: int) -> tuple[ct.Mechanism, Vary]:
    """Parallelograms in a row: each group's change points are those of the one before it."""
    links: dict[str, Any] = {"c0": {"points": ["D0", "A0"], "length": 1.0}}
    for i in range(count):
        links[f"k{i}"] = {"points": [f"A{i}", f"A{i + 1}"], "length": 1.5, "angle": 0.0}
        links[f"c{i + 1}"] = {"points": [f"D{i + 1}", f"A{i + 1}"], "length": 1.0, "angle": 0.7}
    mechanism = ct.Mechanism(
        frame={"points": {f"D{i}": [1.5 * i, 0.0] for i in range(count + 1)}},
        links=links,
        drives=[{"link": "c0", "start": 0.7, "speed": 1.0}],
    )
    return mechanism, {f"links.c{i}.length": np.linspace(0.7, 1.4, 12) for i in range(count + 1)}


@pytest.mark.parametrize("count", [2, 4])
def test_groups_behind_change_points(count: int, by_machine_code: list[int]) -> None:
    found, expected = both(*chain(count), around([0.0, 0.3, np.pi, 4.0, 6.2]))
    same(found, expected)
    assert sum(by_machine_code) == 12
    assert (expected.status == ct.Status.OK).all()


def test_more_change_points_than_a_sign_knows_are_left_to_the_arrays(by_machine_code: list[int]) -> None:
    mechanism, vary = chain(1)
    same(*both(mechanism, vary, np.linspace(0.7, 60.0, 50)))
    assert not by_machine_code


@pytest.mark.parametrize("law", [None, "0.4 * sin(3 * t) + 0.2 * t", "0.5 * t^2"])
def test_two_drives(law: Any, by_machine_code: list[int]) -> None:
    second = {"link": "EC", "start": 2.0, **({"speed": -0.7} if law is None else {"law": law})}
    mechanism = five_bar(drives=[{"link": "OA", "start": 0.5, "speed": 1.3}, second])
    vary = {"links.AB.length": np.linspace(0.6, 1.4, 40) * ct.value_at(mechanism, "links.AB.length")}
    found, expected = both(mechanism, vary, np.linspace(0.0, 4.0, 60))
    same(found, expected)
    assert (expected.status == OPEN).any()
    assert by_machine_code


def test_change_points_of_two_drives(by_machine_code: list[int]) -> None:
    """Cranks that mirror each other stretch their rods out at the same time, whatever the speed of the tables."""
    parts = {
        "frame": {"points": {"O": [0.0, 0.0], "E": [1.0, 0.0]}},
        "links": {"OA": {"length": 0.3}, "AB": {"length": 0.8}, "CB": {"length": 0.8}, "EC": {"length": 0.3}},
        "drives": [{"link": "OA", "start": 0.0, "speed": 1.0}, {"link": "EC", "start": np.pi, "speed": -1.0}],
        "assembly": {"sides": {"B": "left"}},
    }
    size = 0.8 + np.linspace(-0.05, 0.05, 11)
    vary = {"links.AB.length": size, "links.CB.length": size}
    at = np.concatenate([np.linspace(0.0, 7.0, 50), around([np.pi])])
    found, expected = both(ct.Mechanism(**parts), vary, at)
    same(found, expected)
    assert any(event.kind == "change point" for event in expected.branches.events)


def test_two_drives_on_the_sphere(by_machine_code: list[int]) -> None:
    mechanism = ct.Mechanism(
        space="sphere",
        frame={"points": {"A": [0.0, 0.0], "E": [1.2, 0.0]}},
        links={
            "AB": {"length": 0.5, "reference": ["A", "E"]}, "BC": {"length": 0.9}, "DC": {"length": 0.9},
            "ED": {"length": 0.5, "reference": ["E", "A"]},
        },
        drives=[{"link": "AB", "start": 0.8, "speed": 1.0}, {"link": "ED", "start": 1.1, "speed": -1.7}],
        assembly={"sides": {"C": "left"}},
    )  # fmt: skip
    found, expected = both(
        mechanism, {"links.BC.length": np.linspace(0.5, 1.0, 25)}, np.linspace(0.0, 6.0, 40)
    )
    same(found, expected)
    assert (expected.status == OPEN).any()
    assert by_machine_code


def test_functions_of_a_mechanism_and_a_sample_are_left_to_the_arrays(by_machine_code: list[int]) -> None:
    """Sines of angles that a kernel would round otherwise, and that points hang on."""
    mechanism = mechanism_of(grown(["PRP", "wheel on a line", "RPP"], 165))
    same(*both(mechanism, drawn(mechanism, np.random.default_rng(165), 0.1, 20), 25))
    assert not by_machine_code


@pytest.mark.parametrize(("kinds", "seed"), [(["wheel on a line"], 108), (["gear", "wheel on a line"], 198)])
def test_arc_tangents_in_residuals_move_their_last_bits(kinds: list[str], seed: int) -> None:
    mechanism = mechanism_of(grown(kinds, seed))
    # two units of the last place of an angle, and the one of half a turn that was added to it
    off = 2.0 * np.spacing(np.pi) + np.spacing(8.0 * np.pi)
    same(*both(mechanism, drawn(mechanism, np.random.default_rng(seed), 0.1, 20), 25), off)
