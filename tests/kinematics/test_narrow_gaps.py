"""Gaps narrower than a cell of the mesh: limits by bounds of second derivatives against a slow scan of plain values."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import centrode as ct
import growing_sphere
from centrode.kinematics.events import BENDS
from centrode.kinematics.machine_code import batch
from centrode.kinematics.path import JETS, grid_at
from centrode.kinematics.plan_evaluation import FixedSigns
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import of_batch, requested_grid, solve
from centrode.numerics import machine_code
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.bends import Bent, Cells
from centrode.numerics.jets import Jet
from centrode.structure.dimensions import dimensions_of
from growing import DYADS, grown, mechanism_of
from mechanisms import EPS
from slow_scan import reaches

Number = Any
STEP = np.pi / 360
BESIDE_POLES: dict[int, tuple[list[str], int, float]] = {
    # seed: groups on the crank, the side of the initial value, and where the mechanism locks
    282: (["PRP", "RPR block", "RRP", "RPP", "RPP"], 0, 0.6472780627544472),
    763: (["parallel link", "RRP carriage", "RPR", "PRP", "RRP carriage"], 1, 0.8600562604994724),
    1779: (["parallel link", "RRP", "PRP", "rigid point"], 0, -0.8734554068275051),
    2371: (["RPR", "PRP", "RPP", "parallel link", "RRP"], 1, -1.2844778228126597),
}
"""Grown chains that lock just before a point in them runs to infinity, found by the scan."""
FOUND = 2e-9
"""How exactly the scan finds a limit: its finest stretch."""
CRANK, ROD, ROCKER, BASE = 1.0, 3.5, 3.0, 4.0


def grazing(gap: float) -> tuple[ct.Mechanism, Any]:
    """A crank-rocker with a point on a line of the rocker and on a fixed one, and where the lines are parallel.

    The rocker passes the direction of the fixed line just before it turns back, stretched out within half a gap of the
    crank's turn: places by the triangles of the linkage.
    """
    bent = gap / 2.0 * (CRANK + ROD) / ROD  # between crank and rod, to first order
    across = np.sqrt(CRANK**2 + ROD**2 + 2.0 * CRANK * ROD * np.cos(bent))
    lean = np.pi - np.arccos((BASE**2 + ROCKER**2 - across**2) / (2.0 * BASE * ROCKER))
    end = BASE + ROCKER * np.exp(1j * lean)
    half = np.arcsin(ROD * np.sin(bent) / across)
    places = np.angle(end) + half * np.array([-1.0, 1.0])
    mechanism = ct.Mechanism(
        frame={"points": {"O": [0.0, 0.0], "D": [BASE, 0.0]}},
        links={"OA": {"length": CRANK}, "AB": {"length": ROD}, "DB": {"length": ROCKER}},
        guides=[
            {"name": "rocking", "point": "P", "on": "DB", "through": [0.0, 0.5], "direction": 0.0},
            {"name": "fixed", "point": "P", "on": "frame", "through": [0.0, 0.0], "direction": float(lean)},
        ],
        drives=[{"link": "OA", "start": float(np.angle(end)) - 1.0, "speed": 1.0}],
        assembly={"sides": {"B": "left"}},
    )
    return mechanism, places


@pytest.mark.parametrize("gap", [2e-2, 8e-4, 1e-5, 1e-6])
def test_a_point_that_runs_to_infinity_within_a_cell(gap: float) -> None:
    mechanism, places = grazing(gap)
    # the lines' sine is the square of the gap's share: it feels rounding of directions so much more
    bound = 16 * EPS / gap
    prepared = ready(mechanism)
    start = prepared.kinematics.path.initial
    solved = solve(prepared, grid_at(prepared.kinematics.path, start + np.linspace(0.05, 6.05, 61)))
    assert solved.branches.reach(0)[1] == pytest.approx(places[0], abs=bound)
    poles = [e.at for e in solved.events() if e.kind == "limit"]
    np.testing.assert_allclose(poles, places, rtol=0.0, atol=bound)
    behind = solved.span.parameter > places[0]
    np.testing.assert_array_equal(solved.status[0], np.where(behind, ct.Status.CUT_OFF, ct.Status.OK))


@pytest.mark.parametrize("gap", [0.0, 1e-8])
def test_a_point_that_touches_infinity(gap: float) -> None:
    mechanism, places = grazing(gap)
    found = ct.limits(mechanism).high
    assert found is not None
    # a square of rounding cannot be told from zero
    assert abs(found.value - places[0]) <= 4 * np.sqrt(EPS)


def narrow(seed: int) -> ct.Mechanism:
    return mechanism_of(grown(BESIDE_POLES[seed][0], seed))


def varied(mechanism: ct.Mechanism, lanes: int, spread: float) -> dict[str, Any]:
    """Coordinates of the fixed points, each about what it is."""
    random = np.random.default_rng(1)
    return {
        f"frame.points.{name}.{axis}": x * (1.0 + spread * random.uniform(-1.0, 1.0, lanes))
        for name, place in mechanism.frame.points.items()
        for axis, x in zip(("x", "y"), place, strict=True)
    }


def by_scan(prepared: Ready, vary: dict[str, Any] | None = None, lanes: int = 1) -> Any:
    """Ends of the reach, found slowly, within half a turn."""
    mechanism = prepared.mechanism
    numbers = dimensions_of(mechanism, vary or varied(mechanism, 1, 0.0), np)
    return reaches(of_batch(prepared.kinematics, numbers), prepared.assembled.signs, lanes, np.pi)


@pytest.mark.parametrize("seed", BESIDE_POLES)
def test_limits_just_before_a_pole(seed: int) -> None:
    _kinds, side, at = BESIDE_POLES[seed]
    prepared = ready(narrow(seed))
    slow = by_scan(prepared)[0]
    assert abs(slow[side] - at) <= FOUND
    sense = 1.0 if side else -1.0
    places = at + sense * np.append(-0.5 * STEP, np.geomspace(1e-8, 10 * STEP, 20))
    solved = solve(prepared, grid_at(prepared.kinematics.path, np.sort(places)[:: int(sense)]))
    assert abs(solved.branches.reach(0)[side] - at) <= FOUND
    assert solved.status[0, 0] == ct.Status.OK
    assert (solved.status[0, 1:] != ct.Status.OK).all()
    assert all(e.kind == "limit" for e in solved.events())


def test_a_batch_against_the_scan() -> None:
    for seed in (282, 1779):
        mechanism = narrow(seed)
        prepared, lanes = ready(mechanism), 6
        vary = varied(mechanism, lanes, 0.02)
        slow = by_scan(prepared, vary, lanes)
        start = prepared.kinematics.path.initial
        span = requested_grid(prepared, 9, start - np.pi + 0.1, start + np.pi - 0.1)
        fast = solve(prepared, span, dimensions_of(mechanism, vary, np), lanes).branches.reaches()
        closed = ~np.isnan(slow).any(axis=1)
        near = closed[:, None] & (np.abs(slow - start) < np.pi - 0.2)
        assert near.any()
        np.testing.assert_allclose(fast[near], slow[near], rtol=0.0, atol=FOUND)


@pytest.mark.skipif(not machine_code.PRESENT, reason="machine code needs the extra fast")
@pytest.mark.parametrize("seed", [763])
def test_machine_code_agrees(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(batch, "WORTH_COMPILING", 1)
    mechanism = narrow(seed)
    prepared, lanes = ready(mechanism), 8
    numbers = dimensions_of(mechanism, varied(mechanism, lanes, 0.02), np)
    start = prepared.kinematics.path.initial
    span = requested_grid(prepared, 61, start - 1.5, start + 1.5)
    fast, slow = (f(prepared, span, numbers, lanes) for f in (batch.solve_many, solve))
    np.testing.assert_array_equal(fast.status, slow.status)
    told = [sorted((e.lane, e.group, e.kind, e.at) for e in x.branches.events) for x in (fast, slow)]
    assert told[0] == told[1]


def on_sphere(kinds: list[str], seed: int) -> ct.Mechanism:
    return ct.Mechanism(**growing_sphere.grown(kinds, seed).parts())


def chains(kinds: tuple[str, ...], count: int) -> list[tuple[list[str], int]]:
    random = np.random.default_rng(4)
    return [
        ([str(k) for k in random.choice(kinds, size=random.integers(2, 5))], int(random.integers(2**32)))
        for _k in range(count)
    ]


@pytest.mark.parametrize(
    ("made", "kinds"),
    [(lambda *x: mechanism_of(grown(*x)), DYADS), (on_sphere, growing_sphere.KINDS)],
    ids=["plane", "sphere"],
)
def test_random_chains_against_the_scan(made: Callable[..., ct.Mechanism], kinds: tuple[str, ...]) -> None:
    for chain in chains(kinds, 8):
        prepared = ready(made(*chain))
        numbers = prepared.kinematics.numbers.map_numbers(lambda x: np.array([x]) if x != 0.0 else x)
        slow = reaches(of_batch(prepared.kinematics, numbers), prepared.assembled.signs, 1, np.pi)[0]
        start = prepared.kinematics.path.initial
        found = solve(prepared, requested_grid(prepared, 3, start - np.pi, start + np.pi)).branches.reach(0)
        for scanned, searched in zip(slow, found, strict=True):
            if np.isfinite(scanned) or abs(searched - start) < np.pi:
                assert abs(scanned - searched) <= FOUND, chain


@pytest.mark.parametrize(
    ("made", "kinds"),
    [(lambda *x: mechanism_of(grown(*x)), DYADS), (on_sphere, growing_sphere.KINDS)],
    ids=["plane", "sphere"],
)
@pytest.mark.parametrize("holds", [False, True], ids=["lengths", "directions"])
def test_bends_bound_second_derivatives(
    made: Callable[..., ct.Mechanism], kinds: tuple[str, ...], holds: bool
) -> None:
    """Everywhere in the cells, of all that a chain gives: exact second derivatives at seven places of each."""
    for chain in chains(kinds, 10):
        prepared = ready(made(*chain))
        kinematics, signs = prepared.kinematics, prepared.assembled.signs
        centres = kinematics.path.initial + np.arange(180) * 4.0 * STEP
        inside = centres[:, None] + np.linspace(-0.5, 0.5, 7) * STEP
        with np.errstate(all="ignore"):
            cells = Cells(0.5 * STEP, ARRAYS, holds)
            bent = kinematics.positions(BENDS, BENDS.variable(centres, cells), FixedSigns(BENDS, signs))
            exact = kinematics.positions(JETS, Jet.variable(inside, 2), FixedSigns(JETS, signs))
        pairs = [
            *(
                (x, y)
                for name, at in bent.points.items()
                for x, y in zip(at, exact.points[name], strict=True)
            ),
            *(
                (x, y)
                for name, pose in bent.poses.items()
                for v, w in zip(pose, exact.poses[name], strict=True)
                for x, y in zip(v, w, strict=True)
            ),
        ]
        bounded = 0
        for x, y in pairs:
            if isinstance(y, Jet):
                assert isinstance(x, Bent)
                bend = np.broadcast_to(x.bend, centres.shape)
                true = np.abs(np.broadcast_to(y.derivative(2), inside.shape))
                known = np.isfinite(bend)
                # near poles and limits second derivatives are rounded in their own size
                assert (true[known] <= bend[known, None] * (1.0 + 1e-6) + 1e-9).all(), chain
                bounded += int(known.sum())
        assert bounded > 0
