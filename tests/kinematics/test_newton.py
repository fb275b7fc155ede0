"""Newton's method inside a group: quadratic convergence, bounds of rounding, derivatives, the small equations."""

from __future__ import annotations

from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest

import centrode as ct
from centrode.kinematics.higher_class.newton import newton
from centrode.kinematics.higher_class.system import GroupMotion, GroupSystem
from centrode.kinematics.path import JETS
from centrode.kinematics.plan_evaluation import EvaluationPolicy
from centrode.kinematics.preparation import Ready, ready
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet
from centrode.numerics.rounding_bounds import ROUNDED, Rounded
from centrode.structure.constraints import Entity, Positions
from centrode.structure.groups import Newton
from mechanisms import EPS

EXAMPLES = (
    "third-class-triad", "fourth-class-group", "stephenson-driven-at-rocker", "watt-driven-second-loop"
)  # fmt: skip


def group_of(prepared: Ready) -> tuple[int, Newton]:
    groups = prepared.structure.groups
    return next((i, group) for i, group in enumerate(groups) if isinstance(group, Newton))


def known_before(prepared: Ready, m: object, parameter: object) -> Positions:
    """What stands before the group in the plan: cranks and rigid points, which decide nothing."""
    number, _group = group_of(prepared)
    at = prepared.kinematics.frame(m, parameter)
    prepared.kinematics.advance(at, range(number), m, EvaluationPolicy())
    return at


def system_of(prepared: Ready, known: Positions, places: int = 1) -> GroupSystem:
    return GroupSystem(group_of(prepared)[1], prepared.kinematics.numbers, known, places)


@pytest.fixture(scope="module", params=EXAMPLES)
def prepared(request: pytest.FixtureRequest) -> Ready:
    return ready(ct.example(request.param))


def started(prepared: Ready) -> tuple[GroupSystem, np.ndarray]:
    known = known_before(prepared, ARRAYS, np.array([prepared.kinematics.path.initial]))
    system = system_of(prepared, known)
    state = system.state_of(prepared.assembled.positions)
    return system, newton(system, state).state


def test_convergence_is_quadratic(prepared: Ready) -> None:
    """Every step is bounded by the square of the one before times the curvature that the first two show."""
    system, state = started(prepared)
    random = np.random.default_rng(5)
    for size in (1e-1, 1e-2, 1e-3, 1e-4):
        free = list(size * random.uniform(-1.0, 1.0, (system.free, 1)))
        linear = system.linear(system.at(ARRAYS, system.known, state))
        still = {entity: (0.0,) * entity.unknowns for entity in linear.tangents}
        found = newton(system, system.move(state, GroupMotion(linear.whole(still, free), free)))
        assert found.found.all()
        steps = found.sizes[:, 0][np.isfinite(found.sizes[:, 0])]
        curvature = 20.0 / np.min(np.linalg.svd(linear.matrix[0], compute_uv=False))
        for before, after in pairwise(steps):
            assert after <= curvature * before**2 + 100 * EPS * curvature
        assert len(steps) <= 6


def test_the_small_equations_are_the_great_ones(prepared: Ready) -> None:
    """A motion along the free coordinates keeps every hinge that was left out, to the square of the motion."""
    system, state = started(prepared)
    linear = system.linear(system.at(ARRAYS, system.known, state))
    still = {entity: (0.0,) * entity.unknowns for entity in linear.tangents}
    kept = set(linear.pattern.kept)
    scale = float(system.numbers.scale)
    for j in range(system.free):
        gaps = []
        for size in (1e-3, 1e-4):
            free = [np.array([size if i == j else 0.0]) for i in range(system.free)]
            moved = system.move(state, GroupMotion(linear.whole(still, free), free))
            values = system.residual(ARRAYS, system.at(ARRAYS, system.known, moved))
            gaps.append(max(abs(float(v[0])) for i, v in enumerate(values) if i not in kept) / scale)
        assert gaps[0] <= 10.0 * 1e-3**2 * system.free
        assert gaps[1] <= 0.011 * gaps[0] + 8 * EPS


def test_matrix_is_the_derivative_of_the_residual(prepared: Ready) -> None:
    """Jets along each free coordinate give the columns of the matrix."""
    system, state = started(prepared)
    linear = system.linear(system.at(ARRAYS, system.known, state))
    still = {entity: (0.0,) * entity.unknowns for entity in linear.tangents}
    units = np.array(linear.units, dtype=float).reshape(-1)
    for j in range(system.free):
        free = [1.0 if i == j else 0.0 for i in range(system.free)]
        motion = linear.whole(still, free)
        jets = GroupMotion(
            {e: tuple(Jet((0.0, x)) for x in shift) for e, shift in motion.items()},
            [Jet((0.0, x)) for x in free],
        )
        values = system.residual(JETS, system.at(JETS, system.known, state, jets))
        for i, k in enumerate(linear.pattern.kept):
            slope = values[k].coefficients[1] if isinstance(values[k], Jet) else 0.0
            column = float(np.max(np.abs(linear.matrix[0, :, j])))
            assert float(np.squeeze(slope)) * units[i] == pytest.approx(
                linear.matrix[0, i, j], abs=64 * EPS * max(1.0, column)
            )


def test_bounds_hold_against_fifty_digits(prepared: Ready) -> None:
    """What rounding may have done to the group's points is within their bounds, and these are not idle."""
    system, state = started(prepared)
    at = system.at(ARRAYS, system.known, state)
    linear = system.linear(at)
    known = known_before(prepared, ROUNDED, Rounded.of(np.array([prepared.kinematics.path.initial])))
    bounded = system.at(ROUNDED, known, state, system.bounds(known, state, linear))
    with mp.workdps(50):
        exact = _polished(prepared, system, at)
        scale = float(system.numbers.scale)
        for name in system.group.points:
            for k in (0, 1):
                error = abs(exact[name][k] - mp.mpf(float(at.points[name][k][0])))
                bound = float(np.squeeze(Rounded.of(bounded.points[name][k]).bound))
                assert error <= bound
                assert bound <= 1e4 * EPS * scale


def _polished(prepared: Ready, system: GroupSystem, at: Positions) -> dict[str, tuple[mp.mpf, mp.mpf]]:
    """The group's points to fifty digits: distances of points of one link, solved by mpmath from where they are."""
    mechanism, numbers = prepared.mechanism, prepared.kinematics.numbers
    fixed = {name: tuple(map(mp.mpf, map(float, place))) for name, place in numbers.frame.items()}
    q = mp.mpf(prepared.kinematics.path.initial)
    names = list(mechanism.moving_points)
    links = list(mechanism.links)
    places = prepared.assembled.positions
    start = [mp.mpf(float(x)) for name in names for x in places.points[name]]
    angles = [mp.atan2(*(mp.mpf(float(x)) for x in reversed(places.poses[link].rotor))) for link in links]
    origins = [mp.mpf(float(x)) for link in links for x in places.poses[link].origin]
    drive = mechanism.drives[0]

    def gaps(*x: mp.mpf) -> list[mp.mpf]:
        point = {name: (x[2 * k], x[2 * k + 1]) for k, name in enumerate(names)} | fixed
        first = 2 * len(names)
        found = []
        for k, link in enumerate(links):
            ox, oy, angle = x[first + 3 * k : first + 3 * k + 3]
            c, s = mp.cos(angle), mp.sin(angle)
            for name, (u, v) in numbers.local[link].items():
                found += [point[name][0] - ox - c * u + s * v, point[name][1] - oy - s * u - c * v]
        turn = x[first + 3 * links.index(drive.link) + 2]
        base = 0 if drive.relative_to == "frame" else x[first + 3 * links.index(drive.relative_to) + 2]
        return [*found, mp.sin(turn - base - q)]

    unknown = [*start]
    for k, angle in enumerate(angles):
        unknown += [*origins[2 * k : 2 * k + 2], angle]
    solution = mp.findroot(gaps, unknown, tol=1e-40)
    return {name: (solution[2 * k], solution[2 * k + 1]) for k, name in enumerate(names)}


def test_jets_foretell_the_motion(prepared: Ready) -> None:
    """The Taylor series of order 8 at the initial position gives the position a little further."""
    path = prepared.kinematics.path
    system, state = started(prepared)
    known = known_before(prepared, JETS, Jet.variable(np.array([path.initial]), 8))
    linear = system.linear(system.at(ARRAYS, system.known, state))
    jets = system.at(JETS, known, state, system.jets(known, state, linear, 8))
    step = 1e-2
    there = ct.motion(prepared.mechanism, at=[path.initial + step])
    for name in system.group.points:
        for k, axis in enumerate("xy"):
            terms = [float(np.squeeze(c)) * step**n for n, c in enumerate(jets.points[name][k].coefficients)]
            rest = 4 * max(abs(t) for t in terms[-2:])
            gap = abs(sum(terms) - float(there.position.sel(point=name, axis=axis)[0]))
            assert gap <= rest + 256 * EPS * float(system.numbers.scale)


def test_points_and_links_of_the_pattern_are_the_groups(prepared: Ready) -> None:
    system, _state = started(prepared)
    follows = [follow.entity for follow in system.pattern.follows]
    expected = [Entity("link", name) for name in system.group.links]
    expected += [Entity("point", name) for name in system.group.points]
    assert sorted(follows) == sorted(expected)
    assert system.free < len(system.group.equations) / 3
