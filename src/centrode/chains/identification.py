"""The kinematic chain of a mechanism, and which of its inversions the mechanism is.

Sliders and the parts of cylinders are links, sliding pairs are joints. Links that make a truss, such as a triangle of
hinges, are one body. A hinge of k links is k - 1 joints, which may join the links in different ways: a mechanism with
such hinges is the limit of one inversion or of several.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import combinations, product
from typing import Literal, TypeAlias

from centrode.chains.contracted_graphs import ContractedGraph
from centrode.chains.kinematic_chains import (
    GREATEST,
    Joint,
    KinematicChain,
    chains,
    is_movable,
    marked_graph,
    subgraphs,
)
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.printed_results import PrintsSummary
from centrode.structure.pairs import KinematicPair, PairedBody, kinematic_pairs

Unnamed: TypeAlias = Literal["", "higher pairs", "open", "many links", "dimensions"]
Family: TypeAlias = Literal["", "four-bar", "Watt", "Stephenson"]

MOST_WAYS = 5_000
"""Ways to split hinges of many links that are looked at, whichever links are left out, all together."""
NUMBERED = 10
"""Links of chains that get their number here: to list those of twelve takes some seconds."""
WATT = ((0, 1, 0), (0, 1, 2), (0, 1, 2))
STEPHENSON = ((0, 1, 1), (0, 1, 1), (0, 1, 2))


@dataclass(frozen=True)
class ChainInversion:
    """A chain with a frame.

    Attributes
    ----------
    chain : KinematicChain
    number : of the inversion, from 1 in the order of `chain.inversions`
    """

    chain: KinematicChain
    number: int

    @property
    def family(self) -> Family:
        """Name of the chain, if it has one that everybody knows."""
        return family_of(self.chain)

    @property
    def chain_number(self) -> int | None:
        """Place of the chain, from 1, among those of as many links and as much mobility; None beyond 10 links."""
        if self.chain.links > NUMBERED:
            return None
        return 1 + fellows(self.chain).index(self.chain)


def family_of(chain: KinematicChain) -> Family:
    """Name of a chain, if it has one that everybody knows."""
    if chain.links == 4 and chain.mobility == 1:
        return "four-bar"
    if chain.graph.edges == WATT:
        return "Watt"
    return "Stephenson" if chain.graph.edges == STEPHENSON else ""


def fellows(chain: KinematicChain) -> tuple[KinematicChain, ...]:
    """All chains among which one is numbered: of as many links, as mobile, with cut links only if it has one."""
    return chains(chain.links, chain.mobility, cut_links=chain.has_cut_link)


@dataclass(frozen=True, repr=False)
class ChainOfMechanism(PrintsSummary):
    """What chain a mechanism is made from.

    Attributes
    ----------
    mechanism : Mechanism
    inversions : the one that it is, or those that it is a limit of; none where `unnamed` says why
    links, joints : their numbers, the frame and sliders counted, hinges of several links split, trusses as one link
    sliding : number of prismatic pairs among the joints
    split : points where three links or more are hinged
    passive : links that only follow, which the chain lacks
    unnamed : "higher pairs" with gears or rolling wheels, named in `higher`; "open" where a link has a single joint;
        "many links" beyond 12 links, or with too many hinges to split; "dimensions" where special dimensions, or
        guides of special directions, alone let the links move
    higher : names of its gears and rolling wheels
    """

    mechanism: Mechanism = field(repr=False)
    inversions: tuple[ChainInversion, ...]
    links: int
    joints: int
    sliding: int
    split: tuple[str, ...]
    passive: tuple[str, ...] = ()
    unnamed: Unnamed = ""
    higher: tuple[str, ...] = ()


def chain_of(mechanism: MechanismSource) -> ChainOfMechanism:
    """The kinematic chain of a mechanism, and which of its inversions it is.

    Raises
    ------
    InputError
        The source names no mechanism.

    Examples
    --------
    >>> import centrode as ct
    >>> six_bar, = ct.chain_of("stephenson-six-bar").inversions
    >>> six_bar.family, six_bar.number
    ('Stephenson', 3)
    """
    mechanism = mechanism_of(mechanism)
    pairs = kinematic_pairs(mechanism)
    joined = _joined_bodies(pairs)
    found = _chain_numbers(
        mechanism, joined, tuple(one.name for one in pairs if one.kind in ("gear", "rolling"))
    )
    if found.higher:
        return replace(found, unnamed="higher pairs")
    if min(joined.degrees.values(), default=0) < 2:
        return replace(found, unnamed="open")
    # rank can make a mechanism no less mobile than the formula; drives may not be given yet
    freedom = max(len(mechanism.drives), joined.formula)
    # each link with two joints that only follows takes a degree of freedom from the formula
    surplus = freedom - joined.formula
    free = [body for body in joined.followers if body.name not in _driven(mechanism)]
    if len(joined.bodies) > GREATEST:
        return replace(found, unnamed="many links")
    ways = 0
    for passive in combinations(free, surplus):
        rest = joined.without(passive)
        ways += rest.splits
        if ways > MOST_WAYS:
            return replace(found, unnamed="many links")
        inversions = _inversions(rest, freedom)
        if inversions:
            return replace(found, inversions=inversions, passive=tuple(body.name for body in passive))
    if surplus:
        return replace(found, unnamed="dimensions")
    stiff = _with_trusses_as_links(joined)
    inversions = _inversions(stiff, freedom)
    return replace(
        _chain_numbers(mechanism, stiff, ()),
        inversions=inversions,
        unnamed="" if inversions else "dimensions",
    )


def _chain_numbers(mechanism: Mechanism, joined: _JoinedBodies, higher: tuple[str, ...]) -> ChainOfMechanism:
    """The numbers of links and joints."""
    return ChainOfMechanism(
        mechanism,
        (),
        len(joined.bodies),
        joined.joints,
        len(joined.sliding),
        tuple(name for name, bodies in joined.hinges.items() if len(bodies) > 2),
        higher=higher,
    )


def _driven(mechanism: Mechanism) -> set[str | None]:
    """Names of the links at both ends of drives."""
    links = {guide.id: guide.link for guide in mechanism.guides}
    ends = ((drive.link, drive.relative_to, links.get(drive.guide or "")) for drive in mechanism.drives)
    return {name for names in ends for name in names}


@dataclass(frozen=True)
class _JoinedBodies:
    """Bodies, the frame first; those hinged at each point; pairs that slide."""

    bodies: tuple[PairedBody, ...]
    hinges: dict[str, tuple[PairedBody, ...]]
    sliding: tuple[tuple[PairedBody, PairedBody], ...]

    @property
    def joints(self) -> int:
        """Number of joints, k - 1 at a hinge of k bodies."""
        return len(self.sliding) + sum(len(bodies) - 1 for bodies in self.hinges.values())

    @property
    def degrees(self) -> Counter[PairedBody]:
        """Body -> number of places where it is joined; those without any have 0."""
        places = [*self.hinges.values(), *self.sliding]
        return Counter({body: 0 for body in self.bodies}) + Counter(
            body for place in places for body in place
        )

    @property
    def formula(self) -> int:
        """Mobility by the formula."""
        return 3 * (len(self.bodies) - 1) - 2 * self.joints

    @property
    def splits(self) -> int:
        """Number of ways in which hinges of several links are joints."""
        return math.prod(max(1, len(bodies) ** (len(bodies) - 2)) for bodies in self.hinges.values())

    @property
    def followers(self) -> list[PairedBody]:
        """Links hinged at two places, the last of the description first: one of equals that follows is the later."""
        degrees = self.degrees
        return [body for body in reversed(self.bodies) if body.kind == "link" and degrees[body] == 2]

    def without(self, left_out: Sequence[PairedBody]) -> _JoinedBodies:
        """The same without some bodies."""
        return self.among([body for body in self.bodies if body not in left_out])

    def among(self, chosen: Collection[PairedBody]) -> _JoinedBodies:
        """Some of the bodies, with the joints between them."""
        hinges = {
            name: tuple(body for body in bodies if body in chosen) for name, bodies in self.hinges.items()
        }
        return _JoinedBodies(
            tuple(body for body in self.bodies if body in chosen),
            {name: bodies for name, bodies in hinges.items() if len(bodies) > 1},
            tuple((one, other) for one, other in self.sliding if one in chosen and other in chosen),
        )

    def merge_bodies(self, same: Mapping[PairedBody, PairedBody]) -> _JoinedBodies:
        """The same with bodies put in place of others, as parts of one."""
        hinges = {name: tuple(dict.fromkeys(same[body] for body in of)) for name, of in self.hinges.items()}
        return _JoinedBodies(
            tuple(body for body in self.bodies if same[body] is body),
            {name: bodies for name, bodies in hinges.items() if len(bodies) > 1},
            tuple((same[one], same[other]) for one, other in self.sliding if same[one] is not same[other]),
        )


def _joined_bodies(pairs: Sequence[KinematicPair]) -> _JoinedBodies:
    """The bodies of a mechanism with trusses as one body each, named after the first of their links."""
    hinges: dict[str, list[PairedBody]] = {}
    for pair in pairs:
        if pair.kind == "turning":
            # the pairs of a hinge have the first of its bodies in common
            hinges.setdefault(pair.name, [pair.bodies[0]]).append(pair.bodies[1])
    frame = PairedBody("frame")
    bodies = list(dict.fromkeys((frame, *(body for pair in pairs for body in pair.bodies))))
    same = {body: body for body in bodies}
    while True:
        points: dict[PairedBody, set[str]] = {body: set() for body in bodies}
        for name, hinged in hinges.items():
            for body in hinged:
                points[same[body]].add(name)
        triangle = _triangle({body: names for body, names in points.items() if same[body] is body})
        if not triangle:
            break
        for body in bodies:
            if same[body] in triangle:
                same[body] = triangle[0]
    sliding = tuple(pair.bodies for pair in pairs if pair.kind == "sliding")
    given = {name: tuple(hinged) for name, hinged in hinges.items()}
    return _JoinedBodies(tuple(bodies), given, sliding).merge_bodies(same)


def _with_trusses_as_links(joined: _JoinedBodies) -> _JoinedBodies:
    """Bodies with each part of some that has no freedom by the formula as one, smaller ones first."""
    part = next(
        (
            part
            for count in range(2, len(joined.bodies))
            for part in combinations(joined.bodies, count)
            if joined.among(part).formula == 0
        ),
        (),
    )
    if not part:
        return joined
    return _with_trusses_as_links(
        joined.merge_bodies({body: part[0] if body in part else body for body in joined.bodies})
    )


def _triangle(points: dict[PairedBody, set[str]]) -> tuple[PairedBody, ...]:
    """Bodies that cannot move against each other: two with two points in common, or three hinged in a triangle."""
    for one, other in combinations(points, 2):
        shared = points[one] & points[other]
        if len(shared) > 1:
            return one, other
        if not shared:
            continue
        for third in points:
            if third in (one, other):
                continue
            first, second = points[one] & points[third], points[other] & points[third]
            # three points, not one hinge of three links
            if first and second and not (first | second) & shared and first != second:
                return one, other, third
    return ()


def _inversions(joined: _JoinedBodies, freedom: int) -> tuple[ChainInversion, ...]:
    """The inversions that bodies make with their hinges split in all ways, those alike once."""
    number = {body: k for k, body in enumerate(joined.bodies)}

    def joint(one: PairedBody, other: PairedBody) -> Joint:
        return min(number[one], number[other]), max(number[one], number[other])

    firm = [joint(*pair) for pair in joined.sliding]
    found: dict[ContractedGraph, list[Joint]] = {}
    for trees in product(*(tuple(_trees(bodies)) for bodies in joined.hinges.values())):
        joints = [*firm, *(joint(*edge) for tree in trees for edge in tree)]
        if _is_chain(joints, len(joined.bodies), freedom):
            found.setdefault(marked_graph(joints, 0), joints)
    chains_of = [(graph, KinematicChain.of(joints)) for graph, joints in found.items()]
    inversions = [ChainInversion(chain, 1 + chain.inversion_of(graph)) for graph, chain in chains_of]
    return tuple(sorted(inversions, key=lambda one: (one.chain.graph, one.number)))


Tree: TypeAlias = tuple[tuple[PairedBody, PairedBody], ...]


def _trees(bodies: Sequence[PairedBody]) -> Iterator[Tree]:
    """Ways to join bodies two by two so that all hold together without a loop."""
    for edges in combinations(tuple(combinations(bodies, 2)), len(bodies) - 1):
        together = {body: {body} for body in bodies}
        for one, other in edges:
            both = together[one] | together[other]
            together.update(dict.fromkeys(both, both))
        # as many edges as bodies less one make no loop where all hold together
        if len(together[bodies[0]]) == len(bodies):
            yield edges


def _is_chain(joints: Sequence[Joint], links: int, freedom: int) -> bool:
    """Whether joints make a closed chain of so many links with this mobility, all parts of which move."""
    count = Counter(link for joint in joints for link in joint)
    if len(set(joints)) < len(joints) or any(count[link] < 2 for link in range(links)):
        return False
    if 3 * (links - 1) - 2 * len(joints) != freedom:
        return False
    graph = marked_graph(joints, 0)
    return is_movable(graph.vertices, graph.edges, subgraphs(graph))
