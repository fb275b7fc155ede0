"""Matching, components and their order against brute force; Jacobian rows against jets of the residuals."""

from __future__ import annotations

import math
from itertools import permutations
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from centrode.geometry.plane import PlanePose
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet, JetFunctions
from centrode.structure.constraints import Positions, constraints_of, unknowns_of
from centrode.structure.dimensions import dimensions_of
from centrode.structure.plan import structure_of
from centrode.structure.rank import (
    in_order,
    independent_rows,
    jacobian,
    match,
    random_realisation,
    strong_components,
)
from growing import descriptions, mechanism_of
from mechanisms import EPS, Parts

SMALL = st.integers(1, 5)
JETS = JetFunctions(ARRAYS)


@st.composite
def bipartite(draw: st.DrawFn) -> dict[int, list[str]]:
    left, right = draw(SMALL), draw(SMALL)
    names = [f"r{k}" for k in range(right)]
    return {k: draw(st.lists(st.sampled_from(names), unique=True)) for k in range(left)}


def greatest_matching(neighbours: dict[int, list[str]]) -> int:
    rights = sorted({r for found in neighbours.values() for r in found})
    slots: list[Any] = [*rights, *([None] * len(neighbours))]
    return max(
        sum(r in neighbours[k] for k, r in enumerate(chosen))
        for chosen in set(permutations(slots, len(neighbours)))
    )


@settings(max_examples=60)
@given(bipartite())
def test_matchings_are_greatest(neighbours: dict[int, list[str]]) -> None:
    owner = match(neighbours)
    assert all(right in neighbours[left] for right, left in owner.items())
    assert len(set(owner.values())) == len(owner)
    if len(neighbours) <= 4:
        assert len(owner) == greatest_matching(neighbours)


@st.composite
def digraph(draw: st.DrawFn) -> dict[int, list[int]]:
    size = draw(st.integers(1, 8))
    return {k: draw(st.lists(st.integers(0, size - 1), unique=True)) for k in range(size)}


def reachable(depends: dict[int, list[int]], node: int) -> set[int]:
    seen, todo = {node}, [node]
    while todo:
        for other in depends[todo.pop()]:
            if other not in seen:
                seen.add(other)
                todo.append(other)
    return seen


@settings(max_examples=60)
@given(digraph())
def test_components_reach_each_other_and_stand_after_what_they_need(depends: dict[int, list[int]]) -> None:
    reach = {node: reachable(depends, node) for node in depends}
    expected = {frozenset(b for b in depends if b in reach[a] and a in reach[b]) for a in depends}
    ordered = in_order(strong_components(depends), depends)
    assert {frozenset(component) for component in ordered} == expected
    done: set[int] = set()
    for component in ordered:
        done |= set(component)
        assert all(set(depends[node]) <= done for node in component)


def test_a_long_chain_needs_no_recursion() -> None:
    depends = {k: [k - 1] if k else [] for k in range(20_000)}
    assert in_order(strong_components(depends), depends) == [[k] for k in range(20_000)]


@settings(max_examples=30)
@given(st.integers(1, 6), st.integers(1, 6), st.integers(0, 2**31))
def test_independent_rows_have_the_rank(rows: int, columns: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    matrix = random.integers(-2, 3, size=(rows, columns)).astype(float)
    kept = independent_rows(matrix)
    assert kept.sum() == np.linalg.matrix_rank(matrix)
    for k in range(rows):
        assert kept[: k + 1].sum() == np.linalg.matrix_rank(matrix[: k + 1])


@settings(max_examples=40)
@given(descriptions(), st.integers(0, 2**31))
def test_jacobian_rows_are_the_slopes_of_the_residuals(parts: Parts, seed: int) -> None:
    mechanism = mechanism_of(parts)
    constraints, unknowns = constraints_of(mechanism), unknowns_of(mechanism)
    numbers, at = random_realisation(mechanism, dimensions_of(mechanism))
    rates = np.random.default_rng(seed).normal(size=sum(entity.unknowns for entity in unknowns))
    moving = Positions(dict(at.points), dict(at.poses), at.drives)
    first = 0
    for entity in unknowns:
        own = rates[first : first + entity.unknowns]
        first += entity.unknowns
        if entity.kind == "point":
            x, y = at.points[entity.name]
            moving.points[entity.name] = (Jet((x, own[0])), Jet((y, own[1])))
        else:
            (x, y), (c, s) = at.poses[entity.name]
            rotor = (Jet((c, -s * own[2])), Jet((s, c * own[2])))
            moving.poses[entity.name] = PlanePose((Jet((x, own[0])), Jet((y, own[1]))), rotor)
            moving.angles[entity.name] = Jet((math.atan2(s, c), own[2]))
    slopes = [
        r.derivative(1) if isinstance(r, Jet) else 0.0
        for c in constraints
        for r in c.residual(JETS, numbers, moving)
    ]
    rows = jacobian(constraints, unknowns, numbers, at)
    # a sum of at most a dozen products of numbers of the order of 1 (normal deviates, below 5)
    assert rows @ rates == pytest.approx(np.array(slopes), abs=16 * EPS * 12 * 25)


@settings(max_examples=30)
@given(descriptions())
def test_every_group_needs_only_what_stands_before_it(parts: Parts) -> None:
    structure = structure_of(mechanism_of(parts))
    assert structure.redundant == ()
    assert structure.generic_mobility == 1
    assert "higher class" not in [group.kind for group in structure.groups]
    # the order is tested by the motion of these mechanisms; here: each unknown is given once
    from_groups = [name for group in structure.groups for name in (*_points(group), *_links(group))]
    assert sorted(from_groups) == sorted(entity.name for entity in structure.unknowns)


def _points(group: Any) -> tuple[str, ...]:
    if hasattr(group, "points"):
        return tuple(group.points)
    if group.kind == "rigid point":
        return (group.point,)
    return (group.sliding,) if getattr(group, "sliding", None) else ()


def _links(group: Any) -> tuple[str, ...]:
    if hasattr(group, "loci"):
        carriage = (group.carriage,) if group.carriage else ()
        return carriage + tuple(rod.link for rod in group.rods)
    if group.kind == "rigid point":
        return ()
    return (group.link, group.block) if getattr(group, "block", None) else (group.link,)
