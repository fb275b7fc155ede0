"""The kinematic chain of a mechanism, and which of its inversions the mechanism is.

Sliders and the parts of cylinders are links, sliding pairs are joints. A hinge of k links is k - 1 joints, which may
join the links in different ways: a mechanism with such hinges is the limit of one inversion or of several.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import combinations, product
from typing import Literal, TypeAlias

from centrode.chains.contracted_graphs import ContractedGraph
from centrode.chains.kinematic_chains import (
    GREATEST,
    Joint,
    KinematicChain,
    chains,
    is_movable,
    marked,
    subgraphs,
)
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.printing import PrintsSummary
from centrode.structure.pairs import KinematicPair, PairedBody, kinematic_pairs

Unnamed: TypeAlias = Literal["", "higher pairs", "open", "many links", "dimensions"]
Family: TypeAlias = Literal["", "four-bar", "Watt", "Stephenson"]

MOST_SPLITS = 2_000
"""Ways to split hinges of many links that are looked at."""
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
    links, joints : their numbers, the frame and sliders counted, hinges of several links split
    sliding : number of prismatic pairs among the joints
    split : points where three links or more are hinged
    unnamed : "higher pairs" with gears or rolling wheels, named in `higher`; "open" where a link has a single joint;
        "many links" beyond 12 links, or with too many hinges to split; "dimensions" where the mobility comes from
        special dimensions, not from the numbers of links and joints
    higher : names of its gears and rolling wheels
    """

    mechanism: Mechanism = field(repr=False)
    inversions: tuple[ChainInversion, ...]
    links: int
    joints: int
    sliding: int
    split: tuple[str, ...]
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
    higher = tuple(pair.name for pair in pairs if pair.kind in ("gear", "rolling"))
    bodies = tuple(dict.fromkeys((PairedBody("frame"), *(body for pair in pairs for body in pair.bodies))))
    hinges = _hinges(pairs)
    split = tuple(name for name, joined in hinges.items() if len(joined) > 2)
    sliding = sum(pair.kind == "sliding" for pair in pairs)

    def chain(inversions: Sequence[ChainInversion], unnamed: Unnamed) -> ChainOfMechanism:
        return ChainOfMechanism(
            mechanism,
            tuple(inversions),
            len(bodies),
            len(pairs) - len(higher),
            sliding,
            split,
            unnamed,
            higher,
        )

    if higher:
        return chain((), "higher pairs")
    if min(Counter(body for pair in pairs for body in set(pair.bodies)).values(), default=0) < 2:
        return chain((), "open")
    sizes = [len(joined) ** (len(joined) - 2) for joined in hinges.values()]
    if len(bodies) > GREATEST or math.prod(sizes) > MOST_SPLITS:
        return chain((), "many links")
    number = {body: k for k, body in enumerate(bodies)}
    firm = [_joint(number, *pair.bodies) for pair in pairs if pair.kind == "sliding"]
    found: dict[ContractedGraph, list[Joint]] = {}
    for trees in product(*(tuple(_trees(joined)) for joined in hinges.values())):
        joints = [*firm, *(_joint(number, *edge) for tree in trees for edge in tree)]
        if _is_chain(joints, len(bodies), len(mechanism.drives)):
            found.setdefault(marked(joints, 0), joints)
    inversions = [_inversion(graph, joints) for graph, joints in found.items()]
    inversions.sort(key=lambda one: (one.chain.graph, one.number))
    return chain(inversions, "" if inversions else "dimensions")


def _hinges(pairs: Sequence[KinematicPair]) -> dict[str, list[PairedBody]]:
    """The bodies that turn about each point; their pairs have the first of them in common."""
    hinges: dict[str, list[PairedBody]] = {}
    for pair in pairs:
        if pair.kind == "turning":
            joined = hinges.setdefault(pair.name, [pair.bodies[0]])
            joined.append(pair.bodies[1])
    return hinges


def _joint(number: dict[PairedBody, int], one: PairedBody, other: PairedBody) -> Joint:
    return min(number[one], number[other]), max(number[one], number[other])


Tree: TypeAlias = tuple[tuple[PairedBody, PairedBody], ...]


def _trees(bodies: Sequence[PairedBody]) -> Iterator[Tree]:
    """Ways to join bodies two by two so that all hold together without a loop."""
    for edges in combinations(tuple(combinations(bodies, 2)), len(bodies) - 1):
        joined = {body: {body} for body in bodies}
        for one, other in edges:
            both = joined[one] | joined[other]
            joined.update(dict.fromkeys(both, both))
        # as many edges as bodies less one make no loop where all hold together
        if len(joined[bodies[0]]) == len(bodies):
            yield edges


def _is_chain(joints: Sequence[Joint], links: int, drives: int) -> bool:
    """Whether joints make a closed chain of so many links with the mobility that the drives take away."""
    count = Counter(link for joint in joints for link in joint)
    if len(set(joints)) < len(joints) or any(count[link] < 2 for link in range(links)):
        return False
    if 3 * (links - 1) - 2 * len(joints) != drives:
        return False
    graph = marked(joints, 0)
    return is_movable(graph.vertices, graph.edges, subgraphs(graph))


def _inversion(graph: ContractedGraph, joints: Sequence[Joint]) -> ChainInversion:
    chain = KinematicChain.of(joints)
    return ChainInversion(chain, 1 + chain.inversion_of(graph))
