"""All chains of so many links: counts of the literature, an independent enumeration, isomorphism."""

from __future__ import annotations

import random
import shutil
import subprocess
from collections import Counter
from itertools import combinations

import networkx
import numpy as np
import pytest

import centrode as ct
from centrode.chains.kinematic_chains import KinematicChain
from centrode.errors import InputError

# T. S. Mruthyunjaya, Kinematic structure of mechanisms revisited, Mechanism and Machine Theory 38 (2003) 279-320.
COUNTS = {
    (4, 1): (1, 1, 1),
    (6, 1): (2, 2, 5),
    (8, 1): (16, 16, 71),
    (10, 1): (230, 230, 1834),
    (5, 2): (1, 1, None),
    (7, 2): (3, 4, None),
    (9, 2): (35, 40, None),
    (6, 3): (1, 1, None),
    (8, 3): (5, 7, None),
    (10, 3): (74, 98, None),
    (3, 0): (1, 1, 1),
    (5, 0): (1, 1, 2),
    (7, 0): (3, 3, 10),
    (9, 0): (28, 28, 173),
    # not of the literature: every graph of nauty's without triangles was judged by the definition
    (11, 0): (562, 562, 5438),
}
"""Links and mobility -> chains without cut links, with them, inversions (of trusses: Assur groups)."""
GENG = shutil.which("geng") or shutil.which("nauty-geng")


@pytest.mark.parametrize(("links", "mobility"), COUNTS)
def test_counts(links: int, mobility: int) -> None:
    without, with_cut_links, inversions = COUNTS[links, mobility]
    found = ct.chains(links, mobility)
    assert len(found) == without
    assert len(ct.chains(links, mobility, cut_links=True)) == with_cut_links
    if inversions is not None:
        assert sum(len(chain.inversions) for chain in found) == inversions
    for chain in found:
        assert (chain.links, chain.mobility, chain.has_cut_link) == (links, mobility, False)
        assert sum(chain.assortment) == links
        assert sorted(link for one in chain.inversions for link in one.alike) == list(range(links))


def test_chains_with_cut_links_come_last() -> None:
    for links, mobility in ((7, 2), (9, 2), (8, 3)):
        found = ct.chains(links, mobility)
        assert ct.chains(links, mobility, cut_links=True)[: len(found)] == found


def test_chains_of_twelve_links() -> None:
    assert len(ct.chains(12)) == 6856


def _is_movable(joints: tuple[tuple[int, int], ...], links: int) -> bool:
    """Each part of two links or more has a freedom, by the definition: over all sets of links."""
    for count in range(2, links):
        for part in combinations(range(links), count):
            inside = sum(one in part and other in part for one, other in joints)
            if inside and 3 * (count - 1) - 2 * inside < 1:
                return False
    return True


@pytest.mark.parametrize(("links", "mobility"), [(4, 1), (6, 1), (5, 2), (6, 3), (5, 0)])
def test_all_graphs_looked_through(links: int, mobility: int) -> None:
    """Every graph with so many edges, judged by the definition, told apart by another library."""
    joints = (3 * (links - 1) - mobility) // 2
    found: list[networkx.Graph] = []
    for edges in combinations(combinations(range(links), 2), joints):
        degrees = Counter(link for edge in edges for link in edge)
        if len(degrees) < links or min(degrees.values()) < 2:
            continue
        graph = networkx.Graph(edges)
        if not networkx.is_connected(graph) or not _is_movable(edges, links):
            continue
        if not any(networkx.is_isomorphic(graph, other) for other in found):
            found.append(graph)
    ours = [networkx.Graph(chain.joints) for chain in ct.chains(links, mobility, cut_links=True)]
    assert len(ours) == len(found)
    assert all(any(networkx.is_isomorphic(one, other) for other in found) for one in ours)


@pytest.mark.skipif(GENG is None, reason="nauty is not installed")
@pytest.mark.parametrize(("links", "mobility"), [(8, 1), (9, 2), (8, 3), (9, 0)])
def test_graphs_of_nauty(links: int, mobility: int) -> None:
    joints = (3 * (links - 1) - mobility) // 2
    assert GENG is not None
    listed = subprocess.run(
        [GENG, "-q", "-c", "-d2", str(links), f"{joints}:{joints}"], capture_output=True, check=True
    ).stdout
    graphs = (networkx.from_graph6_bytes(line) for line in listed.split())
    theirs = {
        KinematicChain.of(tuple(graph.edges)) for graph in graphs if _is_movable(tuple(graph.edges), links)
    }
    assert theirs == set(ct.chains(links, mobility, cut_links=True))


def test_relabelled_chains_keep_their_name() -> None:
    rng = random.Random(35)
    chains = [*ct.chains(8), *ct.chains(10), *ct.chains(9, 2, cut_links=True), *ct.chains(7, 0)]
    for _case in range(10_000):
        chain = rng.choice(chains)
        numbers = rng.sample(range(chain.links), chain.links)
        joints = [tuple(rng.sample((numbers[u], numbers[v]), 2)) for u, v in chain.joints]
        rng.shuffle(joints)
        assert KinematicChain.of(joints) == chain


def test_inversions_are_the_orbits_of_the_automorphisms() -> None:
    for chain in ct.chains(8):
        graph = networkx.Graph(chain.joints)
        matcher = networkx.isomorphism.GraphMatcher(graph, graph)
        symmetries = list(matcher.isomorphisms_iter())
        orbits = {frozenset(symmetry[link] for symmetry in symmetries) for link in graph}
        assert {frozenset(one.alike) for one in chain.inversions} == orbits


def test_a_contracted_chain_has_the_joints_given() -> None:
    joints = [(9, 4), (4, 7), (7, 1), (1, 9), (9, 3), (3, 5), (5, 7)]
    found = networkx.Graph(KinematicChain.of(joints).joints)
    assert networkx.is_isomorphic(found, networkx.Graph(joints))


def test_watt_and_stephenson() -> None:
    watt, stephenson = ct.chains(6)
    assert (watt.assortment, stephenson.assortment) == ((4, 2), (4, 2))
    ternary = {link for link, degree in enumerate(watt.degrees) if degree == 3}
    assert any(set(joint) == ternary for joint in watt.joints)
    ternary = {link for link, degree in enumerate(stephenson.degrees) if degree == 3}
    assert not any(set(joint) == ternary for joint in stephenson.joints)
    assert [watt.degrees[one.frame] for one in watt.inversions] == [2, 3]
    assert [stephenson.degrees[one.frame] for one in stephenson.inversions] == [2, 2, 3]
    # Stephenson I: the frame joins both ternary links
    first = stephenson.inversions[0].frame
    assert {u if v == first else v for u, v in stephenson.joints if first in (u, v)} == ternary


@pytest.mark.parametrize(
    ("links", "mobility", "what"),
    [
        (7, 1, "4, 6, 8, 10, 12"),
        (2, 1, "3 to 12"),
        (14, 1, "3 to 12"),
        (6, 2, "5, 7, 9, 11"),
        (4, -1, "0"),
        (12, 11, "at most"),
    ],
)
def test_what_is_refused(links: int, mobility: int, what: str) -> None:
    with pytest.raises(InputError, match=what):
        ct.chains(links, mobility)


def test_assur_groups() -> None:
    assert [len(ct.assur_groups(links)) for links in (2, 4, 6, 8)] == [1, 2, 10, 173]
    for links in (2, 4, 6, 8):
        for group in ct.assur_groups(links):
            joints = len(group.inner_joints) + group.order
            assert (len(group.links), 3 * links) == (links, 2 * joints)
    assert [(group.roman, group.order) for group in ct.assur_groups(2)] == [("II", 2)]


@pytest.mark.parametrize("links", [0, 3, 12])
def test_groups_that_are_refused(links: int) -> None:
    with pytest.raises(InputError):
        ct.assur_groups(links)


@pytest.mark.parametrize(("name", "roman"), [("third-class-triad", "III"), ("fourth-class-group", "IV")])
def test_the_groups_of_four_links_are_those_of_the_examples(name: str, roman: str) -> None:
    (own,) = (group for group in ct.check(name).groups if group.kind == "higher class")
    (found,) = (group for group in ct.assur_groups(4) if group.roman == roman)
    assert (own.roman, own.order, len(own.members)) == (found.roman, found.order, 4)


def test_numbers_of_links_and_joints_follow_from_the_graph() -> None:
    for chain in ct.chains(10, 3, cut_links=True):
        graph = networkx.Graph(chain.joints)
        assert graph.number_of_nodes() == chain.links
        assert graph.number_of_edges() == len(chain.joints)
        assert chain.loops == len(networkx.cycle_basis(graph))
        assert chain.has_cut_link == bool(list(networkx.articulation_points(graph)))
        assert chain.degrees == tuple(np.array([graph.degree[link] for link in range(chain.links)]))
