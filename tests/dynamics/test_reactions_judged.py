"""What reactions are worth: dead points, constraints that repeat others, several drives, refusals."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import centrode as ct
from centrode.dynamics.kinetostatics.applied_forces import input_motion_of
from centrode.dynamics.kinetostatics.equations import (
    EPSILON,
    ForceSystem,
    InPlane,
    Inverse,
    Kinetostatics,
    blocks_of,
    inverse_of,
)
from centrode.dynamics.kinetostatics.reactions import ReactionNumbers, checks_of, find
from centrode.dynamics.loads import MassesAndLoads
from centrode.dynamics.state import DriveMotion, State
from centrode.dynamics.steady_motion.steady import SETTLED
from centrode.kinematics.path import grid_at
from centrode.kinematics.preparation import ready
from centrode.kinematics.solve import requested_grid, solve
from centrode.structure.constraints import PointInLink
from centrode.structure.rank import jacobian
from mechanisms import EPS, parts_of
from newton_euler import vector

OK, OPEN, CUT_OFF, SINGULAR = 0, 1, 2, 3
LOADED: dict[str, Any] = {
    "gravity": [0, -9.81],
    "loads": [{"kind": "force", "point": "B", "vector": [3.0, -2.0]}],
}


def parallelogram(**more: Any) -> ct.Mechanism:
    parts: dict[str, Any] = {
        "frame": {"points": {"O": [0, 0], "D": [4, 0]}},
        "links": {"OA": {"length": 1}, "AB": {"length": 4}, "DB": {"length": 1}},
        "drives": [{"link": "OA", "start": 1.0, "speed": 1.0}],
        "assembly": {"sides": {"B": "left"}},
    }
    return ct.Mechanism(**{**parts, **LOADED, **more})


def test_a_change_point_is_singular_and_not_a_great_number() -> None:
    """The motion runs smoothly through it; cranks and coupler in line cannot bear a cross force."""
    found = ct.reactions(parallelogram(), at=[0.0, 1e-8, 1e-3, 0.5, np.pi])
    assert found.status.to_numpy().tolist() == [OK] * 5
    assert found.reaction_status.to_numpy().tolist() == [SINGULAR, SINGULAR, OK, OK, SINGULAR]
    assert np.isnan(found.joint_force[[0, 1, 4]]).all()
    assert np.isnan(found.balancing[[0, 1, 4]]).all()
    assert np.isfinite(found.joint_force[[2, 3]]).all()


def test_the_loss_near_a_change_point_covers_the_error() -> None:
    """Near it the force in the second crank is -2 / sin, half of a unit less: its error stays within the bound."""
    places = np.array([1e-6, 1e-5, 1e-4, 1e-3, 1e-2])
    found = ct.reactions(parallelogram(gravity=None), at=places)
    good = found.reaction_status.to_numpy() == OK
    assert good.sum() >= 3
    # moments about A of the coupler: the second crank's force S along itself, 4 S sin = 4 * 2
    wanted = 2.0 / np.sin(places) * np.exp(1j * places) - 0.0
    error = abs(vector(found.joint_force.sel(side="D/DB")) - wanted)[good]
    assert (
        error <= (found.reaction_loss.to_numpy() * abs(wanted))[good] + 64 * EPS * abs(wanted)[good]
    ).all()


def test_equilibrium_holds_to_rounding_however_near_a_dead_point() -> None:
    """What is lost there is lost to the position, not to the solution."""
    for near in (1e-1, 1e-3, 1e-5):
        found = ct.reactions(parallelogram(), at=[near])
        assert found.reaction_status.to_numpy().tolist() == [OK]
        assert found.attrs["equilibrium_residual"] <= 64 * EPS
    galloway = ct.Mechanism(**{**parts_of(ct.example("galloway")), "loads": LOADED["loads"]})
    found = ct.reactions(galloway, at=[1e-3, 1e-4, 1e-5])
    assert found.attrs["equilibrium_residual"] <= 64 * EPS


def test_checks_tell_of_wrong_reactions() -> None:
    """Each of the three residuals sees a force that is off by a thousandth."""
    prepared = ready(ct.example("six-bar-press"))
    solved = solve(prepared, requested_grid(prepared, 5, None, None))
    burden = MassesAndLoads.of(prepared.mechanism)
    found = find(solved, burden, input_motion_of(solved, burden))
    rates = found.pace.moving.rate[:, None]
    assert max(checks_of(ReactionNumbers.of(found), rates).values()) <= 1e3 * EPS
    for unknown, names in (
        ((PointInLink("O", "OA"), 0), {"equilibrium_residual", "frame_residual"}),
        ((PointInLink("A", "OA"), 1), {"equilibrium_residual"}),
    ):
        off = {**found.forces.multipliers, unknown: found.forces.multipliers[unknown] * 1.001}
        wrong = replace(found, forces=ForceSystem(found.forces.system, off, found.forces.outer))
        assert {
            name for name, share in checks_of(ReactionNumbers.of(wrong), rates).items() if share > 1e-5
        } == names
    wrong = replace(found, parts={**found.parts, "balancing": found.parts["balancing"] * 1.001})
    assert checks_of(ReactionNumbers.of(wrong), rates)["power_residual"] > 1e-5


def test_limits_are_singular_and_what_lies_beyond_is_open() -> None:
    rocker = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [4, 0]}},
        links={"OA": {"length": 3}, "AB": {"length": 2}, "DB": {"length": 3}},
        drives=[{"link": "OA", "start": 0.5, "speed": 1.0}],
        assembly={"sides": {"B": "left"}},
        **LOADED,
    )
    edge = float(np.arccos((9 + 16 - 25) / 24))  # AB and DB stretched: 5 from A to D
    found = ct.reactions(rocker, at=[0.5, edge - 1e-3, edge, edge + 0.1])
    statuses = found.reaction_status.to_numpy()
    assert statuses[0] == OK
    assert statuses[1] == OK
    assert statuses[2] == SINGULAR
    assert statuses[3] == OPEN
    assert np.isnan(found.joint_force[2:]).all()


def test_inverses_say_what_is_singular() -> None:
    whole, flat = np.diag([1.0, 2.0]), np.array([[1.0, 2.0], [2.0, 4.0]])
    near = flat + np.diag([0.0, 4 * EPSILON])
    unknown = np.array([[np.nan, 0.0], [0.0, 1.0]])
    found = inverse_at(np.stack([whole, flat, near, unknown], axis=-1))
    assert found.condition[0] == 2.0
    assert found.condition[1] == np.inf
    assert np.isnan(found.condition[3])
    assert found.useless.tolist() == [False, True, True, False]
    assert np.isnan(found.times([1.0, 1.0])[:, [1, 3]]).all()
    # a column behind the others helps where these are singular, and nowhere else
    wide = np.stack([np.column_stack([square, [0.0, 1.0]]) for square in (whole, flat)], axis=-1)
    helped = inverse_at(wide)
    assert not helped.useless.any()
    solution = helped.times([1.0, 5.0])
    assert np.allclose(np.einsum("ijk,jk->ik", wide, solution), [[1.0, 1.0], [5.0, 5.0]])
    assert solution[2, 0] == 0.0
    assert np.allclose(solution[:, 1], np.linalg.pinv(wide[..., 1]) @ [1.0, 5.0])


def inverse_at(matrix: np.ndarray, filled: np.ndarray | None = None) -> Inverse:
    """Inverses of matrices (n, m, k) with numbers in the filled places."""
    filled = np.ones(matrix.shape[:2], dtype=bool) if filled is None else filled
    entries = {(int(row), int(column)): matrix[row, column] for row, column in np.argwhere(filled)}
    return inverse_of(entries, *matrix.shape[:2], matrix.shape[2:])


def whole_inverses(found: Inverse) -> np.ndarray:
    """The inverses (k, m, n) of n equations, column by column."""
    return np.stack([found.times(list(side)).T for side in np.eye(found.size)], axis=-1)


def places_of(filled: np.ndarray) -> frozenset[tuple[int, int]]:
    return frozenset((int(row), int(column)) for row, column in np.argwhere(filled))


def test_an_inverse_by_blocks_is_that_of_the_whole() -> None:
    """Blocks that random orders of equations and unknowns hide are found again, and solved one after the other."""
    random = np.random.default_rng(25)
    sizes = (3, 1, 6, 1, 2)
    block = np.repeat(np.arange(len(sizes)), sizes)
    before = (block[:, None] > block) & (random.random((13, 13)) < 0.4)
    rows, columns = random.permutation(13), random.permutation(13)
    filled = ((block[:, None] == block) | before)[rows][:, columns]
    matrix = np.where(filled[..., None], random.normal(size=(13, 13, 50)), 0.0)
    blocks = blocks_of(13, places_of(filled))
    assert sorted(len(one.rows) for one in blocks) == [1, 1, 2, 3, 6]
    stacked = np.moveaxis(matrix, -1, 0)
    whole = np.linalg.inv(stacked)
    condition = np.abs(stacked).sum(axis=2).max(axis=1) * np.abs(whole).sum(axis=2).max(axis=1)
    parts = inverse_at(matrix, filled)
    off = np.abs(whole_inverses(parts) - whole).max(axis=(1, 2)) / np.abs(whole).max(axis=(1, 2))
    assert (off < 64 * EPSILON * condition).all()
    assert np.allclose(parts.condition, condition, rtol=1e-6)
    # a singular block makes the whole singular, and nothing of its neighbours in the stack
    for one in blocks:
        flat = matrix.copy()
        flat[(*np.ix_(one.rows, one.columns), 7)] = 1.0 if len(one.rows) > 1 else 0.0
        judged = inverse_at(flat, filled)
        assert np.isinf(judged.condition).tolist() == [k == 7 for k in range(50)]
        inverses = whole_inverses(judged)
        assert np.isnan(inverses[7]).all()
        assert np.allclose(inverses[8], whole[8], rtol=1e-10)


def test_nearly_singular_blocks_in_a_row_are_singular() -> None:
    """Their inverses multiply up to more than any number: that is no matrix without numbers."""
    size = 60
    matrix = np.zeros((size, size, 3))
    # what is one in the first matrix is rounding of zero in the second, and unknown in the third
    matrix[np.arange(size), np.arange(size)] = [1.0, EPSILON / 2.0, np.nan]
    for below in (1, 2):
        matrix[np.arange(below, size), np.arange(size - below)] = 0.5
    found = inverse_at(matrix, np.tri(size, dtype=bool) & ~np.tri(size, k=-3, dtype=bool))
    assert np.isfinite(found.condition[0])
    assert found.condition[1] == np.inf
    assert np.isnan(found.condition[2])
    assert found.useless.tolist() == [False, True, False]
    assert np.isnan(found.times([1.0] * size)[:, 1:]).all()


def test_equations_come_apart_into_blocks() -> None:
    """Of a dyad two moments in two unknowns are left; all other forces follow from one equation each."""
    for name, sizes in (("six-bar-press", [1] * 13 + [2]), ("third-class-triad", [1] * 9 + [6])):
        system = _equations(name)
        blocks = blocks_of(system.scheme.size, frozenset(system.matrix()))
        assert sorted(len(one.rows) for one in blocks) == sizes
        known: set[int] = set()
        for one in blocks:
            assert {other for others in one.before for other in others} <= known
            known |= set(one.columns)
    # without a match of equations and unknowns there is nothing to take apart
    (one,) = blocks_of(2, frozenset({(0, 0), (0, 1)}))
    assert one.rows == one.columns == (0, 1)


def _equations(name: str) -> Kinetostatics:
    prepared = ready(ct.Mechanism(**{**parts_of(ct.example(name)), **LOADED}))
    solved = solve(prepared, requested_grid(prepared, 5, None, None))
    burden = MassesAndLoads.of(prepared.mechanism)
    return find(solved, burden, input_motion_of(solved, burden)).forces.system


def test_three_cranks_say_what_they_do_not_determine() -> None:
    """A third parallel crank: nothing tells how the load is shared, but the drive and the whole are known."""
    three = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [4, 0], "F": [2, 0]}},
        links={
            "OA": {"length": 1},
            "coupler": {"points": {"A": [0, 0], "E": [2, 0], "B": [4, 0]}},
            "DB": {"length": 1},
            "FE": {"length": 1},
        },
        drives=[{"link": "OA", "start": 1.0, "speed": 1.0}],
        assembly={"sides": {"B": "left"}},
        **LOADED,
    )
    found, two = ct.reactions(three, at=[0.4, 2.0]), ct.reactions(parallelogram(), at=[0.4, 2.0])
    assert found.attrs["undetermined"].split("; ") == found.side.to_numpy().tolist()
    assert not found.determined.any()
    assert np.isnan(found.joint_force).all()
    size = 16 * EPS * float(abs(two.joint_force).max()) * 8
    assert abs(found.balancing - two.balancing).max() <= size
    assert abs(found.frame_force - two.frame_force).max() <= size
    assert abs(found.frame_moment - two.frame_moment).max() <= 4 * size


@pytest.mark.parametrize(("apart", "slope"), [(1.0, 0.0), (1e-7, 0.0), (1.0, 1e-10)])
def test_a_slider_in_two_bearings_on_one_line(apart: float, slope: float) -> None:
    """The normal forces and the moment of one bearing depend on each other; all hinges are determined.

    So they are where the lines differ by what an initial position may be off.
    """
    double = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1}, "AB": {"length": 3}, "bar": {"points": {"B": [0, 0], "C": [apart, 0]}}},
        guides=[
            {"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "bar"},
            {"point": "C", "on": "frame", "through": "O", "direction": [1, slope], "name": "second"},
        ],
        drives=[{"link": "OA", "speed": 1.0}],
        assembly={"sides": {"B": "ahead"}},
        **LOADED,
    )
    single = double.model_copy(update={"guides": double.guides[:1]})
    found, plain = ct.reactions(double, 9), ct.reactions(single, 9)
    undetermined = found.attrs["undetermined"].split("; ")
    assert undetermined == ["C/bar", "guide B", "guide second", "moment of guide B"]
    hinges = ["O/OA", "O/frame", "A/OA", "A/AB", "B/AB"]
    size = 512 * EPS * float(abs(plain.joint_force).max())
    assert abs(found.joint_force.sel(side=hinges) - plain.joint_force.sel(side=hinges)).max() <= size
    assert abs(found.balancing - plain.balancing).max() <= size
    assert np.isnan(found.guide_normal).all()
    assert np.isnan(found.guide_moment.sel(guide="B")).all()


@pytest.mark.parametrize("seed", range(6))
def test_what_is_not_determined_by_singular_values(seed: int) -> None:
    """Hinges of cranks on a rigid plate: those that the null space of the whole transposed Jacobian touches."""
    random = np.random.default_rng(seed)
    cranks = int(random.integers(2, 5))
    places = random.uniform(-3.0, 3.0, (cranks, 2))
    names = [f"A{k}" for k in range(cranks)]
    links: dict[str, Any] = {
        f"c{k}": {"points": {f"O{k}": [0, 0], names[k]: [1, 0]}, "angle": 0.8} for k in range(cranks)
    }
    links["plate"] = {"points": dict(zip(names, places.tolist(), strict=True)), "angle": 0.0}
    links["rod"] = {"points": {names[0]: [0, 0], "E": [2.5, 0]}}
    links["end"] = {"points": {"Q": [0, 0], "E": [2.0, 0]}}
    frame = {f"O{k}": place for k, place in enumerate(places.tolist())}
    frame["Q"] = [float(places[0, 0]) + 3.5, float(places[0, 1])]
    mechanism = ct.Mechanism(
        frame={"points": frame},
        links=links,
        drives=[{"link": "c0", "start": 0.8, "speed": 1.0}],
        loads=[{"kind": "force", "point": "E", "vector": [1, 2]}],
        assembly={"sides": {"E": "left"}},
    )
    found = ct.reactions(mechanism, at=[0.9, 1.0])
    structure = ready(mechanism).structure
    state = solve(ready(mechanism), grid_at(ready(mechanism).kinematics.path, np.array([0.9])))
    at = InPlane().positions(State.of(state, DriveMotion(*(np.ones(1),) * 3)), structure.dimensions)
    matrix = jacobian(
        structure.constraints,
        structure.unknowns,
        structure.dimensions,
        at.map_numbers(lambda x: float(np.ravel(x)[0])),
    )
    _left, values, right = np.linalg.svd(matrix.T)
    free = right[int(np.sum(values > 1e-9 * values[0])) :]
    owners = [c for c in structure.constraints for _row in range(c.size)]
    touched = {
        f"{owner.point}/{owner.link}"
        for owner, column in zip(owners, free.T, strict=True)
        if isinstance(owner, PointInLink) and np.any(abs(column) > 1e-9)
    }
    sides = [side for side in found.side.to_numpy().tolist() if not side.endswith("/frame")]
    said = {side for side in sides if not bool(found.determined.sel(side=side))}
    assert said == touched
    assert bool(touched) == (cranks > 2)


def test_what_repeats_others_carries_over_where_they_are_singular() -> None:
    """Two pairs of cranks at a right angle: each pair is dead where the other pushes best."""
    wheels = {
        "w1": {"points": {"O": [0, 0], "A": [1, 0], "P": [0, 1]}, "angle": 1.0},
        "w2": {"points": {"D": [0, 0], "B": [1, 0], "Q": [0, 1]}, "angle": 1.0},
    }
    rods = {
        "AB": {"points": {"A": [0, 0], "B": [4, 0]}, "angle": 0.0},
        "PQ": {"points": {"P": [0, 0], "Q": [4, 0]}, "angle": 0.0},
    }
    engine = ct.Mechanism(
        frame={"points": {"O": [0, 0], "D": [4, 0]}},
        links=wheels | rods,
        drives=[{"link": "w1", "start": 1.0, "speed": 3.0}],
        loads=[{"kind": "torque", "link": "w2", "value": -5}],
    )
    found = ct.reactions(engine, at=[0.0, 0.5, np.pi / 2, np.pi])
    assert (found.reaction_status == OK).all()
    # positions near change points are interpolated, to some 1e-12 (conventions 25)
    assert abs(found.balancing - 5.0).max() <= 1e-12 * 5.0 * 4.0
    assert "A/AB" in found.attrs["undetermined"]


def test_several_drives_have_a_balancing_moment_each() -> None:
    """J q'' + Christoffel - Q, of the inertia matrix that `reduce` gives."""
    arm = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={
            "OA": {"length": 0.5, "mass": 3, "shape": "rod"},
            "AB": {"length": 0.8, "mass": 2, "shape": "rod"},
        },
        drives=[
            {"link": "OA", "law": "0.3*t**2 + t"},
            {"link": "AB", "relative_to": "OA", "law": "sin(2*t) + 0.4"},
        ],
        study={"to": 2.0},
    )
    found, reduced = ct.reactions(arm, 11), ct.reduce(arm, 11)
    t = found.time.to_numpy()
    rates = np.stack([0.6 * t + 1, 2 * np.cos(2 * t)], axis=1)
    second = np.stack([0.6 + 0 * t, -4 * np.sin(2 * t)], axis=1)
    wanted = (
        np.einsum("nij,nj->ni", reduced.inertia_matrix.to_numpy(), second)
        + np.einsum("nijk,ni,nj->nk", reduced.christoffel.to_numpy(), rates, rates)
        - reduced.generalised_force.to_numpy()
    )
    assert abs(found.balancing.to_numpy() - wanted).max() <= 512 * EPS * float(abs(wanted).max() + 50.0)
    assert found.balancing.attrs["units"] == "N m"
    assert "drive_rate" not in found


def test_drives_of_two_kinds_have_units_of_their_own() -> None:
    crane = ct.Mechanism(
        gravity=[0, -9.81],
        frame={"points": {"O": [0, 0]}},
        links={
            "carriage": {"points": {"A": [0, 0]}, "mass": 4},
            "AB": {"length": 1, "mass": 2, "shape": "rod"},
        },
        guides=[{"point": "A", "on": "frame", "through": "O", "direction": [1, 0], "link": "carriage"}],
        drives=[{"guide": "A", "law": "t"}, {"link": "AB", "law": "0.5*t"}],
        study={"to": 1.0},
    )
    found = ct.reactions(crane, 3)
    assert found.balancing.attrs["units"] == "N, N m"
    # of the drives one pushes 6 kg sideways: the rod's centre is drawn inwards with 0.25 * 0.5 m
    turned = found.drive_value.sel(drive="AB").to_numpy()
    assert np.allclose(found.balancing[:, 0], -2 * 0.25 * 0.5 * np.cos(turned), rtol=0, atol=512 * EPS * 60)


def test_units_scale_reactions() -> None:
    """Lengths a thousand times smaller under the same static force: the same forces, smaller moments, the same loss."""

    def engine(scale: float) -> ct.Mechanism:
        return ct.Mechanism(
            frame={"points": {"O": [0, 0]}},
            links={
                "OA": {"length": 1.0 * scale},
                "AB": {"length": 3.0 * scale},
                "p": {"points": {"B": [0, 0]}},
            },
            guides=[{"point": "B", "on": "frame", "through": "O", "direction": [1, 0], "link": "p"}],
            drives=[{"link": "OA", "speed": 1.0}],
            loads=LOADED["loads"],
            assembly={"sides": {"B": "ahead"}},
        )

    great, small = ct.reactions(engine(1.0), 19), ct.reactions(engine(1e-3), 19)
    size = 512 * EPS * float(abs(great.joint_force).max())
    assert abs(great.joint_force - small.joint_force).max() <= size
    assert abs(great.balancing - small.balancing * 1e3).max() <= size
    assert abs(great.reaction_loss / small.reaction_loss - 1.0).max() <= 1e-6


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"loads": ()}, "neither masses nor loads"),
        ({"loads": [{"kind": "weight", "link": "AB"}]}, "has no mass"),
        ({"loads": [{"kind": "force", "point": "B", "vector": ["1/(x-x)", 0]}]}, "no finite value"),
    ],
)
def test_what_is_missing_is_said(change: dict[str, Any], says: str) -> None:
    with pytest.raises(ct.InputError, match=says):
        ct.reactions(parallelogram(**change))


def test_wrong_arguments_are_refused() -> None:
    with pytest.raises(ct.InputError, match="is not a motion"):
        ct.reactions(parallelogram(), motion="fast")  # type: ignore[arg-type]
    with pytest.raises(ct.InputError, match="whole cycle"):
        ct.reactions(ct.example("six-bar-press"), start=0.0, motion="real")
    with pytest.raises(ct.InputError, match="give at most"):
        ct.reactions(parallelogram(), samples=900_000)
    with pytest.raises(ct.InputError, match="neither masses nor loads"):
        ct.reactions(ct.example("spherical-four-bar"))
    with pytest.raises(ct.InputError, match="not a moment in a hinge"):
        ct.reactions(ct.example("spherical-crank-rocker"))


def test_a_formula_that_names_q_is_refused_with_several_drives() -> None:
    arm = ct.Mechanism(
        frame={"points": {"O": [0, 0]}},
        links={"OA": {"length": 1}, "AB": {"length": 1}},
        drives=[{"link": "OA", "speed": 1}, {"link": "AB", "speed": 2}],
        loads=[{"kind": "torque", "link": "AB", "value": "sin(q)"}],
    )
    with pytest.raises(ct.InputError, match="several drives"):
        ct.reactions(arm, 5)


def test_the_steady_motion_gives_the_driving_moment() -> None:
    """The drive's moment less what its own inertia takes is what group II needs, at the machine's real speed."""
    press = ct.example("six-bar-press")
    steady = ct.steady_motion(press, 91)
    found = ct.reactions(press, 91, motion="real")
    assert found.attrs["rate_from"] == "steady"
    assert np.array_equal(found.drive_value, steady.drive_value)
    needed = steady.driving_moment - steady.attrs["inertia"] * steady.drive_acceleration
    # loads and speed of the cycle are made to agree to SETTLED
    size = float(abs(steady.driving_moment).max() + abs(steady.moment_of_loads).max())
    assert abs(found.balancing[:, 0] - needed).max() <= 16 * SETTLED * size
