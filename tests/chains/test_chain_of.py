"""The chains of mechanisms, and descriptions that start from them."""

from __future__ import annotations

import pytest
import tomli_w

import centrode as ct
from centrode.chains import identification
from centrode.chains.identification import family_of
from centrode.chains.planar_drawings import chain_sketch
from centrode.chains.start_descriptions import start_description, start_texts
from centrode.errors import InputError, Status
from centrode.kinematics.motion import initial_place
from centrode.model.mechanism import Mechanism

NAMED = {
    "crank-rocker": ("four-bar", 1),
    "spherical-four-bar": ("four-bar", 1),
    "single-cylinder-engine": ("four-bar", 1),
    "oscillating-cylinder": ("four-bar", 1),
    "scotch-yoke": ("four-bar", 1),
    "watt-six-bar": ("Watt", 1),
    "six-bar-press": ("Watt", 2),
    "shaper": ("Watt", 2),
    "whitworth-quick-return": ("Watt", 2),
    "stephenson-six-bar": ("Stephenson", 3),
    # D. E. G. Klann calls it a modified Stephenson type III
    "klann-leg": ("Stephenson", 3),
    "third-class-triad": ("Stephenson", 3),
    "fourth-class-group": ("Stephenson", 2),
}


ROW = ["AE", "BF", "CG", "DH", "EF", "FG", "GH", "EJ", "JH", "BJ"]


@pytest.mark.parametrize("name", NAMED)
def test_chains_of_examples(name: str) -> None:
    (inversion,) = ct.chain_of(name).inversions
    assert (inversion.family, inversion.number) == NAMED[name]


def test_all_examples_of_hinges_and_sliders_have_a_chain() -> None:
    for name in ct.example_names():
        found = ct.chain_of(name)
        mechanism = ct.example(name)
        if mechanism.gears or mechanism.rolling:
            assert (found.unnamed, bool(found.higher)) == ("higher pairs", True)
        elif name in ("two-link-arm", "double-pendulum", "catapult", "door-closer", "vibrating-screen"):
            assert found.unnamed == "open"
        else:
            assert found.inversions, name
            for inversion in found.inversions:
                assert inversion.chain.mobility == len(mechanism.drives)
                assert inversion.chain.links == found.links - len(found.passive)


def test_a_hinge_of_three_links_is_split_in_each_way() -> None:
    found = ct.chain_of("slider-between-cranks")
    assert found.split == ("C",)
    assert [(one.family, one.number) for one in found.inversions] == [("Watt", 2), ("Stephenson", 3)]


def test_a_truss_is_one_link() -> None:
    # both triangles of Jansen's leg are three bars each in the description
    found = ct.chain_of("jansen-leg")
    assert (found.links, found.joints) == (8, 10)


def _mechanism(points: dict[str, tuple[int, int]], links: list[str], drives: list[str]) -> Mechanism:
    """Links named after their points; the points of the first are those of the frame."""
    frame, *moving = links
    tables = {
        "points": {name: list(place) for name, place in points.items()},
        "frame": {"points": list(frame)},
        "links": {name: {"points": list(name)} for name in moving},
        "drives": [{"link": name, "speed": 1} for name in drives],
    }
    return ct.parse_mechanism(tomli_w.dumps(tables))


FOUR_BAR = {"A": (0, 0), "D": (30, 0), "B": (0, 10), "C": (25, 20)}


def test_a_truss_without_triangles_is_one_link() -> None:
    # the coupler is the truss of five links: BEFG and CHIJ, three bars between them
    more = {"E": (5, 15), "F": (10, 12), "G": (4, 20), "H": (15, 22), "I": (16, 26), "J": (20, 15)}
    mechanism = _mechanism(FOUR_BAR | more, ["AD", "AB", "BEFG", "CHIJ", "EH", "FI", "GJ", "CD"], ["AB"])
    found = ct.chain_of(mechanism)
    assert ct.check(mechanism).mobility == 1
    assert [one.family for one in found.inversions] == ["four-bar"]
    assert (found.links, found.joints, found.passive) == (4, 4, ())


def test_a_mechanism_without_drives_has_a_chain() -> None:
    found = ct.chain_of(_mechanism(FOUR_BAR, ["AD", "AB", "BC", "CD"], []))
    assert [one.family for one in found.inversions] == ["four-bar"]


WEDGES = """
links.wedge = { points = { P = [0, 0] } }
links.follower = { points = { Q = [0, 0] } }
guides = [
    { point = "P", through = [0, 0], direction = [1, 0], link = "wedge" },
    { point = "Q", through = [0, 0], direction = [0, 1], link = "follower" },
    { point = "Q", name = "S", on = "wedge", through = "P", direction = [1, 1], link = "follower" },
]
drives = [{ guide = "P", speed = 1 }]
"""


def test_wedges_have_no_chain_of_the_formula() -> None:
    found = ct.chain_of(ct.parse_mechanism(WEDGES))
    assert (found.links, found.joints, found.sliding, found.unnamed) == (3, 3, 3, "dimensions")


def test_ways_to_split_hinges_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    # six hinges of three links, of which one link is left out
    points = {name: (100 * k, 0) for k, name in enumerate("ABCD")}
    points |= {name: (100 * k + 50, 80) for k, name in enumerate("EFGH")}
    mechanism = _mechanism(points | {"J": (100, 200)}, ["ABCD", *ROW], ["AE"])
    assert ct.chain_of(mechanism).inversions
    monkeypatch.setattr(identification, "MOST_WAYS", 50)
    assert ct.chain_of(mechanism).unnamed == "many links"


def test_a_link_that_only_follows_is_left_out() -> None:
    found = ct.chain_of("three-crank-parallelogram")
    assert found.passive == ("FE",)
    assert [one.family for one in found.inversions] == ["four-bar"]


@pytest.mark.parametrize(("links", "mobility"), [(4, 1), (6, 1), (8, 1), (5, 2), (7, 2), (8, 3)])
def test_descriptions_have_the_chain_that_they_start_from(links: int, mobility: int) -> None:
    chains = ct.chains(links, mobility, cut_links=True)
    for chain in chains[:: 1 if links < 8 else 4]:
        for number, text in enumerate(start_texts(chain), start=1):
            mechanism = ct.parse_mechanism(text)
            assert ct.check(mechanism).mobility == mobility
            (inversion,) = ct.chain_of(mechanism).inversions
            assert (inversion.chain, inversion.number) == (chain, number)


def test_a_description_moves() -> None:
    mechanism = start_description(ct.chains(8)[3], 2)
    start = initial_place(mechanism)
    motion = ct.motion(mechanism, at=[start - 0.01, start, start + 0.01])
    assert (motion.status == Status.OK).all()


def test_descriptions_that_are_refused() -> None:
    watt, _stephenson = ct.chains(6)
    with pytest.raises(InputError, match="inversion 3"):
        start_description(watt, 3)
    (truss,) = ct.chains(3, 0)
    with pytest.raises(InputError, match="truss"):
        start_description(truss)


def test_names_of_families() -> None:
    assert [family_of(chain) for chain in (*ct.chains(4), *ct.chains(6), ct.chains(8)[0])] == [
        "four-bar",
        "Watt",
        "Stephenson",
        "",
    ]


def test_numbers_of_a_chain_are_those_of_the_list() -> None:
    (lift,) = ct.chain_of("scissor-lift").inversions
    assert lift.chain_number is not None
    assert ct.chains(8)[lift.chain_number - 1] == lift.chain
    sketch = chain_sketch(lift.chain)
    assert sketch.crossings == 0
