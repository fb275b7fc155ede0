"""Sketches of kinematic chains: joints as points of the plane, links as polygons that do not cross.

Joints are the vertices of a plane graph whose edges are the sides of links: a binary link is one side, another link a
polygon round its joints in the order in which an embedding of the chain's graph has them. Its longest loop, or one with
a bridge, goes outside, and every other joint stands in the middle of its neighbours (W. T. Tutte, How to draw a graph,
1963), so no two sides cross. Then sides are made more alike as long as nothing crosses.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import pairwise
from typing import Any, TypeAlias

import lazy_loader
import numpy as np
import numpy.typing as npt

from centrode.chains.kinematic_chains import Joint, KinematicChain
from centrode.errors import InputError
from centrode.locale import _
from centrode.optional_packages import how_to_install

Array: TypeAlias = npt.NDArray[np.float64]
Pairs: TypeAlias = npt.NDArray[np.intp]
Rings: TypeAlias = Sequence[Sequence[int]]

ROUNDS, STEP = 300, 0.1
"""Rounds in which sides are made alike; how far joints go at most in the first [length of a side]."""
CLEARANCE = 0.7
"""Distance below which a joint is pushed off the sides of other links [length of a side]."""
TRIES = 40
"""Times a step is halved before a sketch is left as it is."""

_BEYOND = -1
"""Vertex beside the links of a graph, towards the loop outside."""


@dataclass(frozen=True)
class ChainSketch:
    """A chain in the plane.

    Attributes
    ----------
    chain : KinematicChain
    places : (joints, 2) where joints stand, in the order of the chain; sides are some 1 long
    outlines : for each link its joints in the order round it
    crossings : number of pairs of sides that cross; none where the graph of the chain is planar
    """

    chain: KinematicChain
    places: Array
    outlines: tuple[tuple[int, ...], ...]
    crossings: int


def chain_sketch(chain: KinematicChain) -> ChainSketch:
    """Places of the joints of a chain, without crossings where its graph has a planar embedding.

    Raises
    ------
    InputError
        networkx, whose test of planarity is used, is not installed.
    """
    embedding = _embedding(chain)
    number = {joint: k for k, joint in enumerate(chain.joints)}
    around = [
        [number[min(link, other), max(link, other)] for other in _neighbours(chain, embedding, link)]
        for link in range(chain.links)
    ]
    sides = _sides(around)
    loops = list(_loops(embedding, number)) if embedding is not None else []
    # a loop passes a bridge twice: outside, where the first passage counts, both parts are held apart
    loops.sort(key=lambda loop: (len(loop) - len(set(loop)), len(loop)))
    places = (
        _barycentric(around, loops[:-1], list(dict.fromkeys(loops[-1]))) if loops else _circle(len(number))
    )
    places = _evened_places(
        places / np.linalg.norm(places[sides[:, 0]] - places[sides[:, 1]], axis=1).mean(), around
    )
    return ChainSketch(chain, places, tuple(map(tuple, around)), crossing_pairs(places, sides))


_load = functools.partial(lazy_loader.load, "networkx")


def _networkx() -> Any:
    if find_spec("networkx") is None:
        raise InputError(
            "", _("sketches of chains need networkx, which is not installed"), how_to_install("figures")
        )
    return _load()


def _embedding(chain: KinematicChain) -> Any:
    """An embedding of the chain's graph in the plane, all its bridges along one loop; None where there is none."""
    networkx = _networkx()
    graph = networkx.Graph(chain.joints)
    # links that one more vertex can be joined with lie along one loop
    graph.add_edges_from([(_BEYOND, link) for bridge in networkx.bridges(graph) for link in bridge])
    planar, found = networkx.check_planarity(graph)
    if not planar:
        return None
    around = {link: [k for k in order if k != _BEYOND] for link, order in found.get_data().items()}
    around.pop(_BEYOND, None)
    embedding = networkx.PlanarEmbedding()
    embedding.set_data(around)
    return embedding


def _neighbours(chain: KinematicChain, embedding: Any, link: int) -> list[int]:
    """The links next to a link, in their order round it where there is an embedding."""
    if embedding is None:
        return sorted(v if u == link else u for u, v in chain.joints if link in (u, v))
    return list(embedding.neighbors_cw_order(link))


def _loops(embedding: Any, number: dict[Joint, int]) -> Iterator[list[int]]:
    """The joints along each loop of an embedding."""
    seen: set[tuple[int, int]] = set()
    for joint in number:
        for first in (joint, joint[::-1]):
            if first not in seen:
                links = embedding.traverse_face(*first, mark_half_edges=seen)
                after = [*links[1:], links[0]]
                yield [number[min(pair), max(pair)] for pair in zip(links, after, strict=True)]


def _circle(count: int) -> Array:
    turn = 2.0 * np.pi * np.arange(count) / count
    return np.column_stack([np.cos(turn), np.sin(turn)])


def _sides(around: Rings) -> Pairs:
    """Pairs of joints that a side of a link connects, (sides, 2)."""
    return np.array([side for ring in around for side in _round(ring)], dtype=np.intp)


def _round(ring: Sequence[int]) -> list[tuple[int, int]]:
    closing = [(ring[-1], ring[0])] if len(ring) > 2 else []
    return [*pairwise(ring), *closing]


def _barycentric(around: Rings, inside: Rings, outside: Sequence[int]) -> Array:
    """Places of joints in the middle of their neighbours, those of the outer loop on a circle."""
    count = 1 + max(joint for ring in around for joint in ring)
    # a place of its own inside each loop and each large polygon holds its corners apart: so well connected, no
    # joints fall together
    inner = [*inside, *(ring for ring in around if len(ring) > 3)]
    sides = [(int(u), int(v)) for u, v in _sides(around)]
    sides += [(joint, count + k) for k, loop in enumerate(inner) for joint in loop]
    laplacian = np.zeros((count + len(inner),) * 2)
    for u, v in dict.fromkeys((min(side), max(side)) for side in sides):
        laplacian[[u, v], [v, u]] -= 1.0
        laplacian[[u, v], [u, v]] += 1.0
    places = np.zeros((len(laplacian), 2))
    places[list(outside)] = _circle(len(outside))
    free = [k for k in range(len(laplacian)) if k not in outside]
    pull = -laplacian[np.ix_(free, list(outside))] @ places[list(outside)]
    places[free] = np.linalg.solve(laplacian[np.ix_(free, free)], pull)
    return places[:count]


def crossing_pairs(places: Array, sides: Pairs) -> int:
    """Number of pairs of sides, without a joint in common, that cross or touch."""
    first, second = np.triu_indices(len(sides), 1)
    apart = (sides[first][:, :, None] != sides[second][:, None, :]).all(axis=(1, 2))
    one, other = sides[first[apart]], sides[second[apart]]
    (a, b), (c, d) = ((places[pair[:, 0]], places[pair[:, 1]]) for pair in (one, other))
    over = (_turn(a, b, c) * _turn(a, b, d) <= 0) & (_turn(c, d, a) * _turn(c, d, b) <= 0)
    return int(over.sum())


def _turn(a: Array, b: Array, c: Array) -> Array:
    """Twice the area of triangles, positive where they are passed counter-clockwise."""
    ab, ac = b - a, c - a
    return np.asarray(ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0], dtype=np.float64)


# Sides are springs of length 1, polygons want to be regular, and joints are pushed off the sides of other links. A step
# that makes sides cross is halved.


@dataclass(frozen=True)
class _Springs:
    pairs: Pairs
    lengths: Array
    joints: Pairs
    sides: Pairs

    @classmethod
    def of(cls, around: Rings, count: int) -> _Springs:
        """Springs of all links, and what is pushed off what."""
        pairs, lengths = list[tuple[int, int]](), list[float]()
        for ring in around:
            corners = len(ring)
            for k in range(corners):
                for other in range(k + 1, corners):
                    pairs.append((ring[k], ring[other]))
                    # chords of a regular polygon whose sides are 1 long
                    lengths.append(math.sin(math.pi * (other - k) / corners) / math.sin(math.pi / corners))
        sides = _sides(around)
        off = [(joint, k) for joint in range(count) for k, side in enumerate(sides) if joint not in side]
        joints, of = np.array(off, dtype=np.intp).reshape(-1, 2).T
        return cls(np.array(pairs, dtype=np.intp), np.array(lengths), joints, sides[of])

    def energy(self, places: Array) -> tuple[float, Array]:
        """What is lowered, and its slope (joints, 2)."""
        slope = np.zeros_like(places)
        u, v = self.pairs.T
        way = places[v] - places[u]
        length = np.linalg.norm(way, axis=1)
        excess = length - self.lengths
        pull = (2.0 * excess / length)[:, None] * way
        np.add.at(slope, v, pull)
        np.add.at(slope, u, -pull)
        total = float(excess @ excess)
        a, b = places[self.sides[:, 0]], places[self.sides[:, 1]]
        along = b - a
        share = np.clip(
            ((places[self.joints] - a) * along).sum(axis=1) / (along * along).sum(axis=1), 0.0, 1.0
        )
        away = places[self.joints] - a - share[:, None] * along
        distance = np.maximum(np.linalg.norm(away, axis=1), 1e-9)
        near = np.maximum(CLEARANCE / distance - 1.0, 0.0)
        total += float(near @ near)
        push = (-2.0 * near * CLEARANCE / distance**3)[:, None] * away
        np.add.at(slope, self.joints, push)
        np.add.at(slope, self.sides[:, 0], -(1.0 - share)[:, None] * push)
        np.add.at(slope, self.sides[:, 1], -share[:, None] * push)
        return total, slope


def _evened_places(places: Array, around: Rings) -> Array:
    """Places with sides more alike, and no more crossings than before."""
    springs, sides = _Springs.of(around, len(places)), _sides(around)
    crossings, (energy, slope) = crossing_pairs(places, sides), springs.energy(places)
    step = STEP
    for _round_number in range(ROUNDS):
        for _try in range(TRIES):
            moved = places - step * slope / max(float(np.abs(slope).max()), 1e-12)
            lower, its_slope = springs.energy(moved)
            if lower < energy and crossing_pairs(moved, sides) <= crossings:
                break
            step /= 2.0
        else:
            return places
        places, energy, slope = moved, lower, its_slope
        crossings = crossing_pairs(places, sides)
        step *= 1.5
    return places
