"""Types of four-bars against the inequality of every pair of neighbours, circuits against other ways of counting."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from centrode.analysis.rotatability.circuits import Uncounted
from mechanisms import four_bar
from samples import few

Array = npt.NDArray[np.float64]


def neighbours_turn(a: float, b: float, c: float, d: float, *, sphere: bool = False) -> bool:
    """Whether links a and d, hinged together, turn fully against each other in the loop a, b, c, d.

    The far ends of a and d are between |a - d| and a + d apart; b and c have to span all of that.
    """
    farthest, reach = a + d, b + c
    if sphere:
        farthest, reach = (min(total, math.tau - total) for total in (farthest, reach))
    return abs(b - c) <= abs(a - d) and farthest <= reach


def expected(a: float, b: float, c: float, d: float, *, sphere: bool = False) -> str:
    """Type of the loop crank a, coupler b, rocker c, ground d by which neighbours turn fully."""
    crank = neighbours_turn(a, b, c, d, sphere=sphere)
    rocker = neighbours_turn(c, b, a, d, sphere=sphere)
    coupler = neighbours_turn(b, a, d, c, sphere=sphere) or neighbours_turn(b, c, d, a, sphere=sphere)
    if crank and rocker:
        return "double crank"
    if crank:
        return "crank-rocker"
    if rocker:
        return "rocker-crank"
    return "double rocker, the coupler turns fully" if coupler else "triple rocker"


def closing(lengths: tuple[float, float, float, float]) -> float | None:
    """A crank angle at which a four-bar closes well, if the loop can be closed at all."""
    a, b, c, d = lengths
    for q in np.linspace(0.05, 3.1, 62):
        apart = math.sqrt(a * a + d * d - 2 * a * d * math.cos(q))
        if abs(b - c) * 1.01 < apart < (b + c) * 0.99:
            return float(q)
    return None


def test_types_and_turning_of_random_four_bars() -> None:
    random = np.random.default_rng(11)
    seen: set[str] = set()
    for _k in range(70):
        a, b, c, d = (float(x) for x in 0.5 + 2.5 * random.random(4))
        start = closing((a, b, c, d))
        if start is None:
            continue
        mechanism = four_bar(a, b, c, d, drives=[{"link": "OA", "start": start, "speed": 1}])
        found = ct.rotatability(mechanism)
        (loop,) = found.four_bars
        assert loop.bodies == ("frame", "OA", "AB", "DB")
        assert loop.kind == expected(a, b, c, d)
        assert found.turns_fully is neighbours_turn(a, b, c, d)
        circuits = found.one.circuits
        assert circuits is not None
        assert len(circuits.circuits) == (2 if loop.grashof else 1)
        seen.add(loop.kind)
    assert len(seen) == 5


def spherical(a: float, b: float, c: float, d: float, start: float) -> ct.Mechanism:
    return ct.Mechanism(
        space="sphere",
        frame={"points": {"A": [0, 0], "D": [d, 0]}},
        links={"AB": {"length": a, "reference": ["A", "D"]}, "BC": {"length": b}, "DC": {"length": c}},
        drives=[{"link": "AB", "start": start, "speed": 1}],
        assembly={"sides": {"C": "left"}},
    )


def test_types_and_turning_of_random_spherical_four_bars() -> None:
    random = np.random.default_rng(5)
    seen: set[str] = set()
    obtuse = 0
    for _k in range(few(55, 110)):
        a, b, c, d = (float(x) for x in 0.2 + 2.6 * random.random(4))
        for q in np.linspace(0.1, 3.0, 30):
            apart = math.acos(math.cos(a) * math.cos(d) + math.sin(a) * math.sin(d) * math.cos(q))
            if abs(b - c) + 0.02 < apart < min(b + c, math.tau - b - c) - 0.02:
                break
        else:
            continue
        found = ct.rotatability(spherical(a, b, c, d, float(q)))
        (loop,) = found.four_bars
        assert loop.kind == expected(a, b, c, d, sphere=True)
        assert found.turns_fully is neighbours_turn(a, b, c, d, sphere=True)
        assert all(loop.reduced[i] + loop.reduced[k] <= math.pi for i in range(4) for k in range(i))
        seen.add(loop.kind)
        obtuse += loop.reduced != loop.lengths
    assert len(seen) == 5
    assert obtuse > few(10, 20)


def test_change_point_loops_are_told_from_near_misses() -> None:
    (loop,) = ct.rotatability(ct.example("kite")).four_bars
    assert loop.grashof is None
    assert loop.kind == "change-point linkage"
    nearly = four_bar(1.0, 1.0 + 1e-9, 2.0, 2.0)
    assert ct.rotatability(nearly).four_bars[0].grashof is not None


@pytest.mark.parametrize(
    ("crank", "coupler", "offset", "kind"),
    [
        (1.0, 3.0, 0.3, "slider-crank, the crank turns fully"),
        (3.0, 1.0, 0.3, "slider-crank, the coupler turns fully, the crank swings"),
        (1.0, 1.2, 0.5, "slider-crank, no link turns fully"),
        (1.0, 1.5, 0.5, "change-point linkage"),
    ],
)
def test_types_of_slider_cranks(crank: float, coupler: float, offset: float, kind: str) -> None:
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": crank}, "AB": {"length": coupler}},
        guides=[{"point": "B", "on": "frame", "through": [0, offset], "direction": [1, 0]}],
        drives=[{"link": "OA", "start": 0.2, "speed": 1}],
        assembly={"sides": {"B": "ahead"}},
    )
    found = ct.rotatability(mechanism)
    (loop,) = found.four_bars
    assert loop.kind == kind
    assert found.turns_fully is (loop.grashof is None or (loop.shortest == "OA" and loop.grashof))


def test_inversions_of_the_slider_crank() -> None:
    kinds = {
        name: ct.rotatability(ct.example(name)).four_bars[0].kind
        for name in ("whitworth-quick-return", "shaper", "oscillating-cylinder")
    }
    assert kinds == {
        "whitworth-quick-return": "crank and slotted lever, the lever turns fully",
        "shaper": "crank and slotted lever",
        "oscillating-cylinder": "crank and slotted lever",
    }


def circuits_on_a_torus(a: float, b: float, c: float, d: float) -> int:
    """Connected pieces of the curve of all positions in the angles of crank and rocker, on a grid."""
    nodes = 360
    angle = (np.arange(nodes) + 0.31) * (math.tau / nodes)
    apart = np.abs(a * np.exp(1j * angle)[:, None] - d - c * np.exp(1j * angle)[None, :]) - b
    sign = apart > 0
    cells = (sign != np.roll(sign, -1, 0)) | (sign != np.roll(sign, -1, 1))
    cells |= sign != np.roll(np.roll(sign, -1, 0), -1, 1)
    left, pieces = {(int(i), int(k)) for i, k in zip(*np.nonzero(cells), strict=True)}, 0
    while left:
        pieces += 1
        todo = [left.pop()]
        while todo:
            i, k = todo.pop()
            for di in (-1, 0, 1):
                for dk in (-1, 0, 1):
                    cell = (i + di) % nodes, (k + dk) % nodes
                    if cell in left:
                        left.remove(cell)
                        todo.append(cell)
    return pieces


@pytest.mark.parametrize(
    "lengths",
    [(1, 3.5, 3, 4), (3, 1, 3, 4), (2, 2.5, 3, 4), (2, 2.5, 2.2, 1), (3, 3.5, 1, 4), (2.5, 1.7, 1.9, 3)],
)
def test_circuits_of_a_four_bar_are_the_pieces_of_its_curve(lengths: tuple[float, ...]) -> None:
    a, b, c, d = (float(x) for x in lengths)
    start = closing((a, b, c, d))
    assert start is not None
    mechanism = four_bar(a, b, c, d, drives=[{"link": "OA", "start": start, "speed": 1}])
    circuits = ct.rotatability(mechanism).one.circuits
    assert circuits is not None
    assert len(circuits.circuits) == circuits_on_a_torus(a, b, c, d)


def worked_circuits(phi: tuple[float, float, float], lengths: tuple[float, float, float]) -> int:
    """Circuits of the worked mechanism of the source: its curve is followed step by step, not by signs.

    Unknowns: angles of AC, CB and BD and the crank's; a plane square to the curve and Newton's method keep on it.
    """
    l2, l3, l4 = lengths
    start = np.array([0.0, *phi])
    height = l2 * math.sin(phi[0])
    c0 = 0.5 + l2 * np.exp(1j * phi[0])
    d = c0 + l3 * np.exp(1j * phi[1]) + l4 * np.exp(1j * phi[2])

    def residual(x: Array) -> Array:
        chain = 0.5 * np.exp(1j * x[0]) + l2 * np.exp(1j * x[1])
        end = chain + l3 * np.exp(1j * x[2]) + l4 * np.exp(1j * x[3]) - d
        return np.array([chain.imag - height, end.real, end.imag])

    def jacobian(x: Array) -> Array:
        column = 1j * np.array([0.5, l2, l3, l4]) * np.exp(1j * x)
        return np.array([[*column.imag[:2], 0.0, 0.0], column.real, column.imag])

    def corrected(x: Array) -> Array:
        for _step in range(8):
            x = x - np.linalg.pinv(jacobian(x)) @ residual(x)
        return x

    def followed(x: Array) -> Array:
        """Places along the closed curve through x."""
        places, before = [x], np.zeros(4)
        for k in range(20_000):
            tangent = np.linalg.svd(jacobian(x))[2][3]
            tangent = tangent if k == 0 or tangent @ before > 0 else -tangent
            x = corrected(x + 0.01 * tangent)
            before = tangent
            places.append(x)
            away = np.abs(np.exp(1j * x) - np.exp(1j * places[0])).max()
            if k > 5 and away < 0.006:
                return np.array(places)
        raise AssertionError("the curve does not close")

    curves: list[Array] = []
    for t in np.linspace(0.05, math.tau + 0.05, 24, endpoint=False):
        for x in assemblies(t, l2, l3, l4, height, d):
            on = any(
                np.abs(np.exp(1j * curve) - np.exp(1j * x)).max(axis=1).min() < 0.011 for curve in curves
            )
            if not on:
                curves.append(followed(x))
    assert np.abs(residual(start)).max() < 1e-12
    return len(curves)


def assemblies(t: float, l2: float, l3: float, l4: float, height: float, d: complex) -> list[Array]:
    """All positions at a crank angle, by triangles."""
    found = []
    a = 0.5 * np.exp(1j * t)
    rise = height - a.imag
    if abs(rise) >= l2:
        return []
    for ahead in (1, -1):
        c = a + complex(ahead * math.sqrt(l2**2 - rise**2), rise)
        line = d - c
        if not abs(l3 - l4) < abs(line) < l3 + l4:
            continue
        bend = math.acos((l3**2 + abs(line) ** 2 - l4**2) / (2 * l3 * abs(line)))
        for side in (1, -1):
            b = c + l3 * np.exp(1j * (np.angle(line) + side * bend))
            found.append(np.array([t, *(np.angle(v) for v in (c - a, b - c, d - b))]))
    return found


@pytest.mark.parametrize("name", ["slider-between-cranks", "slider-between-cranks-locked"])
def test_circuits_of_two_dyads_are_those_of_the_curve_followed_step_by_step(name: str) -> None:
    mechanism = ct.example(name)
    links = mechanism.links
    phi = tuple(float(links[link].angle or 0.0) for link in ("AC", "CB", "BD"))
    lengths = tuple(float(links[link].length or 0.0) for link in ("AC", "CB", "BD"))
    circuits = ct.rotatability(mechanism).one.circuits
    assert circuits is not None
    assert len(circuits.circuits) == worked_circuits(phi, lengths)  # type: ignore[arg-type]


def test_branches_end_at_the_limits() -> None:
    found = ct.rotatability(ct.example("triple-rocker"))
    circuits = found.one.circuits
    assert circuits is not None
    low, high = (limit.value for limit in found.limits)
    for branch in circuits.circuits[circuits.own]:
        assert branch.low is not None and branch.high is not None
        assert branch.low - low == pytest.approx(0.0, abs=1e-14)
        assert branch.high - high == pytest.approx(0.0, abs=1e-14)
    assert {branch.sides["B"] for branch in circuits.circuits[0]} == {"left", "right"}


def test_circuits_that_no_sign_tells_are_not_counted() -> None:
    turning = ct.rotatability(ct.example("third-class-triad")).one
    assert turning.circuits is None
    assert turning.circuits_missing == Uncounted.HIGHER_CLASS
