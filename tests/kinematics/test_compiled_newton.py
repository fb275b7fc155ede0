"""Groups of higher class as expressions: small systems, chains of free coordinates, ways along the path, beginnings."""

from __future__ import annotations

import itertools

import numpy as np
import numpy.typing as npt
import pytest

import centrode as ct
from centrode.geometry.plane import dot
from centrode.kinematics.higher_class.system import GroupSystem
from centrode.kinematics.machine_code.newton import inverse
from centrode.kinematics.machine_code.path_continuation import NODES, beginnings, way_of
from centrode.kinematics.machine_code.trace import chains_of
from centrode.kinematics.machine_code.variables import FIRST, PARAMETER, SAMPLE, STEP
from centrode.kinematics.preparation import ready
from centrode.numerics.expressions import as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import evaluate
from centrode.structure.dimensions import dimensions_of
from growing_higher import grown_higher
from mechanisms import EPS
from samples import few

Array = npt.NDArray[np.float64]
HIGHER = (
    "third-class-triad", "fourth-class-group", "stephenson-driven-at-rocker", "watt-driven-second-loop",
    "scissor-lift-cylinder",
)  # fmt: skip


def inverted(matrices: Array, zeros: Array) -> Array:
    """Inverses of matrices (lanes, n, n) by straight-line code; literal zeros stand where `zeros` says so."""
    n = len(zeros)
    cells = list(itertools.product(range(n), repeat=2))
    nodes = [[0.0 if zeros[i, j] else variable(f"{i} {j}") for j in range(n)] for i in range(n)]
    found = inverse(nodes)
    graph = Graph({f"{i} {j}": as_node(found[i][j]) for i, j in cells})
    values = evaluate(graph, {f"{i} {j}": matrices[:, i, j] for i, j in cells})
    shape = len(matrices)
    return np.stack([np.broadcast_to(values[f"{i} {j}"], shape) for i, j in cells], axis=1).reshape(-1, n, n)


@pytest.mark.parametrize("size", range(1, 8))
@pytest.mark.parametrize("share", [0.0, 0.3])
def test_small_systems(size: int, share: float) -> None:
    """Against LAPACK: both err by the condition; small pivots and literal zeros in the way of elimination included."""
    draw = np.random.default_rng(size)
    zeros = draw.random((size, size)) < share
    zeros[np.arange(size), draw.permutation(size)] = False
    matrices = np.where(zeros, 0.0, draw.normal(size=(400, size, size)))
    if size > 1 and not zeros[0, 0]:
        matrices[::4, 0, 0] *= 1e-14
    found, expected = inverted(matrices, zeros), np.linalg.inv(matrices)
    whole = np.abs(expected).sum(axis=2).max(axis=1)
    condition = whole * np.abs(matrices).sum(axis=2).max(axis=1)
    # cofactors of three rows err by the condition once more, elimination by the growth of pivots: at most 2^(n - 1)
    growth = condition if size <= 3 else 2.0 ** (size - 1)
    off = np.abs(found - expected).max(axis=(1, 2))
    assert np.all(off <= 4 * size**3 * EPS * growth * condition * whole)


def test_no_inverse_is_not_finite() -> None:
    zeros = np.zeros((3, 3), dtype=bool)
    assert not np.isfinite(inverted(np.ones((1, 3, 3)), zeros)).all()


@pytest.mark.parametrize("name", HIGHER)
def test_chains_are_the_positions_of_their_free_coordinates(name: str) -> None:
    """All equations hold, those that are eliminated by construction, whatever the free coordinates are."""
    prepared = ready(ct.example(name))
    numbers, at = prepared.kinematics.numbers, prepared.assembled.positions
    for group, chain in chains_of(prepared, numbers).items():
        equations = prepared.structure.groups[group].equations
        posture = chain.posture(at)
        found = chain.positions(at, posture, [0.0] * chain.pattern.free)
        system = GroupSystem(chain.group, numbers, at, 1)
        allowed = 16 * EPS * len(equations)
        assert np.abs(system.state_of(found) - system.state_of(at)).max() <= allowed * max(1.0, numbers.scale)
        for link, (cosine, sine) in posture.rotors.items():
            # any posture at all
            posture.rotors[link] = 0.8 * cosine - 0.6 * sine, 0.8 * sine + 0.6 * cosine  # type: ignore[index]
        moved = chain.positions(at, posture, [0.0] * chain.pattern.free)
        values = [float(np.reshape(x, -1)[0]) for x in system.residual(np, moved)]
        eliminated = [k for k in range(len(values)) if k not in chain.pattern.kept]
        assert max(abs(values[k]) for k in eliminated) <= allowed * numbers.scale
        assert max(abs(values[k]) for k in chain.pattern.kept) > 0.01 * numbers.scale
        for leaf in chain.leaves:
            assert dot(chain.arm(leaf), chain.arm(leaf)) > 0.0


@pytest.mark.parametrize(
    "asked", [np.linspace(0.0, 6.28, 9), np.linspace(-3.0, 0.001, 500), np.array([0.5, 0.1, 0.5, -0.2, 0.0])],
    ids=["ahead", "behind", "any order"],
)  # fmt: skip
def test_ways_pass_every_sample_in_short_steps(asked: Array) -> None:
    path = ready(ct.example("third-class-triad")).kinematics.path
    way = way_of(path, {PARAMETER: asked, "time": 2.0 * asked})
    found = np.concatenate([leg.asked for leg in way.legs])
    assert sorted(found) == list(range(len(asked)))
    for leg, sense in zip(way.legs, (1.0, -1.0), strict=True):
        place, step = leg.inputs[PARAMETER], leg.inputs[STEP]
        assert np.array_equal(place[leg.places], asked[leg.asked])
        assert np.array_equal(leg.inputs["time"][leg.places], 2.0 * asked[leg.asked])
        assert place[0] == path.initial
        assert np.all(sense * step >= 0.0)
        assert np.abs(step).max() <= NODES * path.step * (1.0 + 4 * EPS * len(place))
        assert np.allclose(path.initial + np.cumsum(step), place, rtol=0.0, atol=EPS * len(place) * 10.0)
        assert leg.inputs[SAMPLE].sum() == len(leg.asked)
        assert leg.inputs[FIRST].tolist() == [1.0] + [0.0] * (leg.steps - 1)
        parts = list(leg.parts(7))
        assert np.array_equal(np.concatenate([part.inputs[PARAMETER] for part in parts]), place)
        assert np.array_equal(np.concatenate([part.asked for part in parts]), leg.asked)
        assert all(np.array_equal(p.inputs[PARAMETER][p.places], asked[p.asked]) for p in parts)


TWO_GROUPS = grown_higher(["RRR", "four sides", "four sides"], 1092)


def two_groups() -> tuple[ct.Mechanism, dict[str, Array]]:
    """Two groups of higher class one behind the other, in dimensions of which some are not reached, or not at once."""
    mechanism, draw = ct.Mechanism(**TWO_GROUPS), np.random.default_rng(3)
    paths = [
        f"links.{end}" for end in ("link6.points.P6bF3.x", "link9.points.P10aP6aF2.y", "link3.points.P6bF2.x")
    ]
    return mechanism, {path: ct.value_at(mechanism, path) * draw.uniform(0.82, 1.18, 60) for path in paths}


def test_batches_of_two_groups_do_not_hang_on_their_neighbours() -> None:
    mechanism, vary = two_groups()
    together = ct.motion(mechanism, at=[0.0], vary=vary)
    reached = together.status[:, 0] == ct.Status.OK
    assert 0 < int(reached.sum()) < 60
    for lane in range(3, 60, few(27, 9)):
        alone = ct.motion(mechanism, at=[0.0], vary={path: x[[lane]] for path, x in vary.items()})
        assert np.array_equal(alone.status[0], together.status[lane])
        assert np.array_equal(alone.position[0], together.position[lane], equal_nan=True)


def test_beginnings_close_and_are_those_of_the_arrays() -> None:
    mechanism, vary = two_groups()
    prepared = ready(mechanism)
    numbers = dimensions_of(prepared.mechanism, vary, np)
    found = beginnings(prepared, numbers, 60)
    initial = prepared.kinematics.path.initial
    motion = ct.motion(mechanism, at=[initial], vary=vary)
    for name, values in found.items():
        kind, _space, link = name.split(" ", 2)[2].partition(" ")
        if kind == "angle":
            reached = ~np.isnan(values) & (motion.status[:, 0] == ct.Status.OK).to_numpy()
            assert reached.any()
            # both end where Newton's steps are below 1e-9: what follows them is below their square
            assert np.abs(values - motion.angle.sel(link=link)[:, 0].to_numpy())[reached].max() <= 1e-9
