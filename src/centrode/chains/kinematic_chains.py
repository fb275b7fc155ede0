"""Kinematic chains with turning joints: all of so many links, their mobility and inversions.

A chain is closed (each link has two joints or more) and movable in all its parts: no links among it form a rigid body
or a part without freedom. Sliding pairs are turning pairs of another kind here, as sliders are links like others. The
method is that of contracted graphs (L. W. Tsai, Mechanism Design, 2001, chapters 2 and 4), grown by ears; counts agree
with T. S. Mruthyunjaya, Kinematic structure of mechanisms revisited, Mechanism and Machine Theory 38 (2003) 279-320.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise
from typing import TypeAlias

from centrode.chains.contracted_graphs import (
    ContractedGraph,
    Edge,
    binary_link_distributions,
    graphs_of_loops,
)
from centrode.errors import InputError
from centrode.locale import _, ngettext

Joint: TypeAlias = tuple[int, int]

GREATEST = 12
"""Links of a chain: of twelve with mobility 1 there are 6856, of fourteen 318 162."""
MARKED = 1


@dataclass(frozen=True)
class Inversion:
    """A chain with one of its links as the frame; links that symmetry exchanges give one inversion.

    Attributes
    ----------
    frame : number of the link
    alike : the links that would give the same inversion, itself among them
    """

    frame: int
    alike: tuple[int, ...]


@dataclass(frozen=True)
class KinematicChain:
    """A kinematic chain: two are equal where they are isomorphic.

    Its links are numbered from 0, polygonal ones first, in an order that follows from its structure.
    `KinematicChain.of(joints)` makes one of any numbering.

    Attributes
    ----------
    graph : the contracted graph in canonical form

    Examples
    --------
    >>> import centrode as ct
    >>> chain = KinematicChain.of([(0, 3), (3, 1), (1, 2), (2, 0)])
    >>> chain.links, chain.mobility, chain == ct.chains(4)[0]
    (4, 1, True)
    """

    graph: ContractedGraph

    @classmethod
    def of(cls, joints: Sequence[Joint]) -> KinematicChain:
        """The chain with these joints between links 0, 1, ..., however they are numbered."""
        return cls(contract(joints))

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """Pairs of links that a joint connects, in ascending order."""
        found, link = list[Joint](), self.graph.vertices
        for u, v, weight in self.graph.edges:
            string = [u, *range(link, link + weight), v]
            found += [(min(pair), max(pair)) for pair in pairwise(string)]
            link += weight
        return tuple(sorted(found))

    @property
    def links(self) -> int:
        """Number of links."""
        return self.graph.vertices + sum(weight for *_ends, weight in self.graph.edges)

    @property
    def mobility(self) -> int:
        """Degrees of freedom of the links against each other, 3 (links - 1) - 2 joints."""
        return 3 * (self.links - 1) - 2 * len(self.joints)

    @property
    def loops(self) -> int:
        """Number of independent loops."""
        return len(self.joints) - self.links + 1

    @cached_property
    def degrees(self) -> tuple[int, ...]:
        """Number of joints of each link."""
        count = Counter(link for joint in self.joints for link in joint)
        return tuple(count[link] for link in range(self.links))

    @property
    def assortment(self) -> tuple[int, ...]:
        """Numbers of binary, ternary, quaternary links and so on."""
        count = Counter(self.degrees)
        return tuple(count[degree] for degree in range(2, max(count) + 1))

    @cached_property
    def inversions(self) -> tuple[Inversion, ...]:
        """Links that differ as frames, polygonal ones last, each with those that symmetry exchanges with it."""
        classes: dict[ContractedGraph, list[int]] = {}
        for link in range(self.links):
            classes.setdefault(marked_graph(self.joints, link), []).append(link)
        ordered = sorted(classes.values(), key=lambda links: (self.degrees[links[0]], links))
        return tuple(Inversion(links[0], tuple(links)) for links in ordered)

    def inversion_of(self, graph: ContractedGraph) -> int:
        """Place among the inversions of one that `marked` gives."""
        return next(
            k for k, one in enumerate(self.inversions) if marked_graph(self.joints, one.frame) == graph
        )

    @cached_property
    def has_cut_link(self) -> bool:
        """Whether a link alone holds two parts together, which then move each for itself."""
        return any(not _is_connected(self.joints, self.links, without=link) for link in range(self.links))


def contract(joints: Sequence[Joint], mark: int | None = None) -> ContractedGraph:
    """The contracted graph of links with joints, a link marked; of a circle the marked link or the first stays."""
    neighbours: dict[int, list[int]] = {}
    for u, v in joints:
        neighbours.setdefault(u, []).append(v)
        neighbours.setdefault(v, []).append(u)
    kept = [link for link in sorted(neighbours) if len(neighbours[link]) != 2 or link == mark]
    kept = kept or [min(neighbours)]
    place = {link: k for k, link in enumerate(kept)}
    strings = _strings(neighbours, kept)
    edges = [(min(place[s[0]], place[s[-1]]), max(place[s[0]], place[s[-1]]), len(s) - 2) for s in strings]
    return ContractedGraph.of([MARKED if link == mark else 0 for link in kept], edges)


def _strings(neighbours: dict[int, list[int]], ends: Sequence[int]) -> Iterator[list[int]]:
    """Strings of binary links with the links at their ends, each once."""
    inside = set(ends)
    direct = Counter((u, v) for u in ends for v in neighbours[u] if v in inside and u < v)
    for (u, v), times in direct.items():
        yield from ([u, v] for _time in range(times))
    walked: set[int] = set()
    for end in ends:
        for first in neighbours[end]:
            if first in inside or first in walked:
                continue
            string, before, link = [end], end, first
            while link not in inside:
                string.append(link)
                walked.add(link)
                one, other = neighbours[link]
                before, link = link, other if one == before else one
            yield [*string, link]


def marked_graph(joints: Sequence[Joint], link: int) -> ContractedGraph:
    """The contracted graph of a chain with one link marked: equal for links that symmetry exchanges."""
    return contract(joints, link)


def chains(links: int, mobility: int = 1, *, cut_links: bool = False) -> tuple[KinematicChain, ...]:
    """All kinematic chains of so many links with turning joints, each once, in an order that never changes.

    Parameters
    ----------
    links : 3 to 12
    mobility : degrees of freedom; with 0 the Baranov trusses, from which Assur groups follow
    cut_links : also chains whose parts a single link holds together; with mobility 1 there are none

    Returns
    -------
    tuple of KinematicChain
        By their contracted graphs, those with cut links last; with mobility 1 there are 1, 2, 16, 230 and 6856 of 4, 6,
        8, 10 and 12 links.

    Raises
    ------
    InputError
        There is no chain of so many links, or there are more than 12.

    Examples
    --------
    >>> import centrode as ct
    >>> watt, stephenson = ct.chains(6)
    >>> watt.assortment, len(watt.inversions), len(stephenson.inversions)
    ((4, 2), 2, 3)
    """
    _check_links(links, mobility)
    return _enumerated_chains(links, mobility, cut_links)


@dataclass(frozen=True)
class ChainList:
    """All chains of so many links and so much mobility.

    Attributes
    ----------
    cut_links : also those whose parts a single link holds together
    """

    links: int
    mobility: int
    cut_links: bool
    chains: tuple[KinematicChain, ...]


def chain_list(links: int, mobility: int = 1, *, cut_links: bool = False) -> ChainList:
    """All chains of so many links as a result; raises as `chains` does."""
    return ChainList(links, mobility, cut_links, chains(links, mobility, cut_links=cut_links))


def _check_links(links: int, mobility: int) -> None:
    if mobility < 0:
        raise InputError("mobility", _("a chain has no fewer than 0 degrees of freedom"))
    if not 3 <= links <= GREATEST:
        raise InputError(
            "links",
            ngettext(
                "chains of 3 to {most} links are found, {n} is wished",
                "chains of 3 to {most} links are found, {n} are wished",
                links,
            ).format(most=GREATEST, n=links),
        )
    if (links - 1 - mobility) % 2 or links < 3 + mobility:
        possible = ", ".join(str(number) for number in range(3 + mobility, GREATEST + 1, 2))
        raise InputError(
            "links",
            _("there is no chain of {links} links with mobility {mobility}").format(
                links=links, mobility=mobility
            ),
            _("with this mobility chains have {numbers} links").format(numbers=possible)
            if possible
            else _("the mobility is at most {most}").format(most=GREATEST - 3),
        )


@cache
def _enumerated_chains(links: int, mobility: int, cut_links: bool) -> tuple[KinematicChain, ...]:
    # joints = links - 1 + loops, put into the formula of mobility
    loops = (links - 1 - mobility) // 2
    if loops == 1:
        return (KinematicChain.of([(k, (k + 1) % links) for k in range(links)]),)
    found: set[ContractedGraph] = set()
    for graph in graphs_of_loops(loops, cut_links=cut_links):
        binary = links - graph.vertices
        if binary < 0:
            continue
        groups = subgraphs(graph)
        # without a string of b links the rest has b - 2 degrees of freedom less, and has to keep one
        for edges in binary_link_distributions(graph, binary, mobility + 1):
            if is_movable(graph.vertices, edges, groups):
                found.add(ContractedGraph.of(graph.colours, edges))
    ordered = map(KinematicChain, sorted(found, key=lambda graph: (graph.vertices, graph)))
    # those with a cut link come last, so that the others have the same numbers with and without them
    return tuple(sorted(ordered, key=lambda chain: chain.has_cut_link) if cut_links else ordered)


Groups: TypeAlias = Sequence[tuple[int, tuple[int, ...]]]
"""Sets of two vertices or more: how many they are, and the edges between them."""


def subgraphs(graph: ContractedGraph) -> Groups:
    """All sets of two vertices of a graph or more, with the edges between them."""
    sets = []
    for chosen in range(1, 1 << graph.vertices):
        count = chosen.bit_count()
        inside = tuple(
            k for k, (u, v, _weight) in enumerate(graph.edges) if chosen >> u & 1 and chosen >> v & 1
        )
        if count > 1 and inside:
            sets.append((count, inside))
    # small sets refuse most
    return tuple(sorted(sets))


def is_movable(vertices: int, edges: Sequence[Edge], groups: Groups) -> bool:
    """Whether every proper part of a chain, and the chain itself but for a truss, has a freedom.

    A part that holds some polygonal links is stiffest with exactly those strings between them that have fewer than two
    binary links: a string of b links adds b - 2 to its mobility.
    """
    # a loop of its own needs four links, one of them polygonal
    if any(u == v and weight < 3 for u, v, weight in edges):
        return False
    taken = [min(0, weight - 2) for _u, _v, weight in edges]
    for count, inside in groups:
        freedom = 3 * (count - 1) + sum([taken[k] for k in inside])
        # the whole chain, where no string may be left out, is no part of itself: a truss has no freedom
        is_whole = count == vertices and all(edge[2] < 2 for edge in edges)
        if freedom < (0 if is_whole else 1):
            return False
    return True


def _is_connected(joints: Sequence[Joint], links: int, without: int) -> bool:
    left = set(range(links)) - {without}
    reached, waiting = set[int](), [next(iter(left))]
    while waiting:
        link = waiting.pop()
        if link in reached:
            continue
        reached.add(link)
        waiting += [v if u == link else u for u, v in joints if link in (u, v) and without not in (u, v)]
    return reached == left
