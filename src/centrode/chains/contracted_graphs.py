"""Contracted graphs of kinematic chains: polygonal links as vertices, strings of binary links as weighted edges.

The graph of a chain has a vertex for each link and an edge for each joint. Its binary links stand in strings between
links of three joints or more; to contract every string to one edge, whose weight is the number of its binary links,
leaves few vertices (L. W. Tsai, Mechanism Design: Enumeration of Kinematic Structures According to Function, 2001,
chapter 2). All questions about isomorphism are put to contracted graphs: a chain of twelve links has at most eight such
vertices.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TypeAlias

Edge: TypeAlias = tuple[int, int, int]
"""Two vertices, the lesser first, and the number of binary links between them."""
Matrix: TypeAlias = Sequence[Sequence[tuple[int, ...]]]
Colours: TypeAlias = tuple[int, ...]


@dataclass(frozen=True, order=True)
class ContractedGraph:
    """A contracted graph in canonical form: two are equal where they are isomorphic.

    Attributes
    ----------
    colours : of the vertices; a link that is marked (a frame, say) has another colour than the rest
    edges : in ascending order; several may join the same two vertices, and one may join a vertex with itself
    """

    colours: Colours
    edges: tuple[Edge, ...]

    @classmethod
    def of(cls, colours: Sequence[int], edges: Iterable[Edge]) -> ContractedGraph:
        """The canonical form of a graph."""
        edges = tuple(edges)
        order = canonical_order(tuple(colours), edges)
        place = {vertex: k for k, vertex in enumerate(order)}
        moved = ((min(place[u], place[v]), max(place[u], place[v]), weight) for u, v, weight in edges)
        return cls(tuple(colours[v] for v in order), tuple(sorted(moved)))

    @property
    def vertices(self) -> int:
        """Number of vertices."""
        return len(self.colours)


def canonical_order(colours: Colours, edges: Sequence[Edge]) -> tuple[int, ...]:
    """Vertices in an order that hangs on nothing but the structure, up to automorphisms.

    Vertices are told apart by their colours and by what joins them with the others, as far as this goes; then each of a
    class in turn is put first, and of all orders found the one with the least matrix counts (individualisation and
    refinement: B. D. McKay, Practical graph isomorphism, 1981).
    """
    matrix = _matrix(len(colours), edges)
    best: tuple[tuple[tuple[tuple[int, ...], ...], ...], tuple[int, ...]] | None = None
    for order in _discrete_orders(_refined_colours(colours, matrix), matrix):
        read = tuple(tuple(matrix[u][v] for v in order) for u in order)
        if best is None or read < best[0]:
            best = read, order
    return () if best is None else best[1]


def _matrix(count: int, edges: Sequence[Edge]) -> list[list[tuple[int, ...]]]:
    """Weights of the edges between each two vertices, in ascending order."""
    between: dict[tuple[int, int], list[int]] = {}
    for u, v, weight in edges:
        between.setdefault((u, v), []).append(weight)
        if u != v:
            between.setdefault((v, u), []).append(weight)
    return [[tuple(sorted(between.get((u, v), ()))) for v in range(count)] for u in range(count)]


def _refined_colours(colours: Colours, matrix: Matrix) -> Colours:
    """Classes of vertices, numbered, that differ by their own class or by what joins them with each class."""
    while True:
        # the class itself stands first, so that classes are only split, in an order that names do not change
        signs = [
            (
                colour,
                row[u],
                tuple(sorted((between, colours[v]) for v, between in enumerate(row) if between and v != u)),
            )
            for u, (colour, row) in enumerate(zip(colours, matrix, strict=True))
        ]
        number = {sign: k for k, sign in enumerate(sorted(set(signs)))}
        if len(number) == len(set(colours)):
            return tuple(number[sign] for sign in signs)
        colours = tuple(number[sign] for sign in signs)


def _discrete_orders(classes: Colours, matrix: Matrix) -> Iterator[tuple[int, ...]]:
    """Orders of the vertices by classes that hold one vertex each, whichever of the larger ones are put first."""
    members: dict[int, list[int]] = {}
    for vertex, number in enumerate(classes):
        members.setdefault(number, []).append(vertex)
    shared = [number for number in sorted(members) if len(members[number]) > 1]
    if not shared:
        yield tuple(members[number][0] for number in sorted(members))
        return
    for vertex in members[shared[0]]:
        # twice the number leaves room for the chosen vertex before the rest of its class
        chosen = tuple(2 * number - (u == vertex) for u, number in enumerate(classes))
        yield from _discrete_orders(_refined_colours(chosen, matrix), matrix)


# Graphs without weights, as many independent loops as are wanted: each grows from one with a loop less by an ear.
#
# An ear is a path between two places of a graph, which are vertices or lie on edges. Every graph without cut vertices
# grows from a circle in this way (H. Whitney, Non-separable and planar graphs, 1932). With cut links a further loop may
# stand on one place as well, by itself or at the end of a bridge: the last block of the graph, taken away, leaves a
# smaller one.

Plain: TypeAlias = tuple[int, tuple[tuple[int, int], ...]]
"""Number of vertices, and edges."""

THETA: Plain = (2, ((0, 1), (0, 1), (0, 1)))
EIGHT: Plain = (1, ((0, 0), (0, 0)))
DUMB_BELL: Plain = (2, ((0, 0), (0, 1), (1, 1)))


def graphs_of_loops(loops: int, *, cut_links: bool) -> tuple[ContractedGraph, ...]:
    """All contracted graphs with so many independent loops, two or more, their weights zero.

    Parameters
    ----------
    cut_links : also those that a single vertex holds together
    """
    grown = {_plain_form(graph) for graph in ((THETA, EIGHT, DUMB_BELL) if cut_links else (THETA,))}
    for _loops in range(loops - 2):
        grown = {
            _plain_form(larger)
            for graph in grown
            for larger in _with_an_ear((graph.vertices, tuple(edge[:2] for edge in graph.edges)), cut_links)
        }
    return tuple(sorted(grown))


def _plain_form(graph: Plain) -> ContractedGraph:
    vertices, edges = graph
    return ContractedGraph.of((0,) * vertices, [(min(edge), max(edge), 0) for edge in edges])


def _with_an_ear(graph: Plain, cut_links: bool) -> Iterator[Plain]:
    vertices, edges = graph
    places = [*range(vertices), *edges]
    indices = range(len(places))
    for first, second in combinations(indices, 2):
        # of parallel edges any will do, and equal edges give equal graphs; they are few, and the canonical form is one
        larger, ends = _with_vertices(graph, (first, second))
        yield larger[0], (*larger[1], (ends[0], ends[1]))
    for k, (u, v) in enumerate(edges):
        # both ends on one edge
        rest = edges[:k] + edges[k + 1 :]
        x, y = vertices, vertices + 1
        yield vertices + 2, (*rest, (u, x), (x, y), (y, v), (x, y))
    if cut_links:
        for place in indices:
            (count, more), (end,) = _with_vertices(graph, (place,))
            yield count, (*more, (end, end))
            yield count + 1, (*more, (end, count), (count, count))


def _with_vertices(graph: Plain, places: Sequence[int]) -> tuple[Plain, list[int]]:
    """A graph with a vertex at each of some different places, and these: numbers of vertices, then of edges."""
    vertices, edges = graph
    more, removed, ends, count = list[tuple[int, int]](), set[int](), list[int](), vertices
    for place in places:
        if place < vertices:
            ends.append(place)
            continue
        u, v = edges[place - vertices]
        removed.add(place - vertices)
        more += [(u, count), (count, v)]
        ends.append(count)
        count += 1
    kept = [edge for k, edge in enumerate(edges) if k not in removed]
    return (count, (*kept, *more)), ends


def binary_link_distributions(
    graph: ContractedGraph, binary_links: int, most: int
) -> Iterator[tuple[Edge, ...]]:
    """Ways to hand out so many binary links to the edges of a graph, at most `most` to each; parallel ones in order."""
    ends = [(u, v) for u, v, _weight in graph.edges]

    def hand_out(first: int, left: int, given: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
        if first == len(ends):
            if left == 0:
                yield given
            return
        # edges stand in ascending order, so parallel ones are neighbours
        least = given[-1] if first and ends[first] == ends[first - 1] else 0
        # what the edges behind cannot take has to be given here
        for weight in range(max(least, left - most * (len(ends) - first - 1)), min(left, most) + 1):
            yield from hand_out(first + 1, left - weight, (*given, weight))

    for weights in hand_out(0, binary_links, ()):
        yield tuple((u, v, weight) for (u, v), weight in zip(ends, weights, strict=True))
