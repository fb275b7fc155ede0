"""Sketches of chains: nothing crosses, nothing lies on anything else, by exact arithmetic."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from itertools import combinations, pairwise

import networkx
import pytest

import centrode as ct
from centrode.chains.kinematic_chains import KinematicChain
from centrode.chains.planar_drawings import ChainSketch, chain_sketch

Place = tuple[Fraction, Fraction]


@cache
def _sketch_of_eight(number: int) -> ChainSketch:
    return chain_sketch(ct.chains(8)[number])


def _exact(sketch: ChainSketch) -> list[Place]:
    return [(Fraction(float(x)), Fraction(float(y))) for x, y in sketch.places]


def _turn(a: Place, b: Place, c: Place) -> Fraction:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _sides(outline: tuple[int, ...]) -> list[tuple[int, int]]:
    return [*pairwise(outline), *([(outline[-1], outline[0])] if len(outline) > 2 else [])]


def _crossings(sketch: ChainSketch) -> int:
    at = _exact(sketch)
    sides = [side for outline in sketch.outlines for side in _sides(outline)]
    count = 0
    for (a, b), (c, d) in combinations(sides, 2):
        if {a, b} & {c, d}:
            continue
        p, q, r, s = at[a], at[b], at[c], at[d]
        count += _turn(p, q, r) * _turn(p, q, s) <= 0 and _turn(r, s, p) * _turn(r, s, q) <= 0
    return count


def _holds(place: Place, corners: list[Place]) -> bool:
    """Whether a place lies in a polygon: a ray to the right meets its sides an odd number of times."""
    inside = False
    for one, other in pairwise([*corners, corners[0]]):
        if (one[1] > place[1]) != (other[1] > place[1]):
            share = (place[1] - one[1]) / (other[1] - one[1])
            inside ^= place[0] < one[0] + share * (other[0] - one[0])
    return inside


def _assert_clear(sketch: ChainSketch) -> None:
    at = _exact(sketch)
    assert _crossings(sketch) == sketch.crossings == 0
    for outline in sketch.outlines:
        if len(outline) < 3:
            continue
        others = set(range(len(at))) - set(outline)
        assert not any(_holds(at[joint], [at[k] for k in outline]) for joint in others)


@pytest.mark.parametrize("number", range(16))
def test_chains_of_eight_links(number: int) -> None:
    _assert_clear(_sketch_of_eight(number))


def test_chains_of_other_numbers() -> None:
    for chain in (*ct.chains(4), *ct.chains(6), *ct.chains(7, 2), *ct.chains(7, 0), *ct.chains(10)[::40]):
        planar, _embedding = networkx.check_planarity(networkx.Graph(chain.joints))
        if planar:
            _assert_clear(chain_sketch(chain))


def test_chains_with_bridges() -> None:
    with_bridges = [
        chain
        for chain in (*ct.chains(8, 3, cut_links=True), *ct.chains(10, 3, cut_links=True))
        if networkx.has_bridges(networkx.Graph(chain.joints))
    ]
    assert len(with_bridges) == 6
    for chain in with_bridges:
        _assert_clear(chain_sketch(chain))


def test_bridges_at_both_sides_of_a_loop_come_to_one() -> None:
    # four links in a loop, two of which bear a loop of four more at the end of a bridge
    joints = [(0, 1), (0, 2), (0, 4), (1, 3), (1, 5), (2, 6), (2, 8), (3, 9), (3, 11)]
    chain = KinematicChain.of([*joints, (4, 5), (6, 7), (7, 8), (9, 10), (10, 11)])
    _assert_clear(chain_sketch(chain))


def test_a_chain_without_planar_embedding_is_sketched() -> None:
    chains = [
        chain for chain in ct.chains(10) if not networkx.check_planarity(networkx.Graph(chain.joints))[0]
    ]
    assert chains
    sketch = chain_sketch(chains[0])
    assert sketch.crossings == _crossings(sketch) > 0


def test_outlines_are_the_joints_of_each_link() -> None:
    for chain in ct.chains(8, 3, cut_links=True):
        sketch = chain_sketch(chain)
        for link, outline in enumerate(sketch.outlines):
            assert sorted(outline) == [k for k, joint in enumerate(chain.joints) if link in joint]


def test_sides_are_alike() -> None:
    for number in range(16):
        sketch = _sketch_of_eight(number)
        lengths = [
            abs(complex(*(sketch.places[a] - sketch.places[b])))
            for outline in sketch.outlines
            for a, b in _sides(outline)
        ]
        assert min(lengths) > 0.3
        assert max(lengths) < 2.5
