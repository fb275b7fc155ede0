"""Plans, groups, structural formulas and mobilities of the examples and of mechanisms known to be awkward."""

from __future__ import annotations

from typing import Any

import pytest

import centrode as ct
from centrode.structure.assur import assur_groups, structural_formula
from centrode.structure.plan import structure_of
from centrode.structure.rank import count

FORMULAS = {
    "andrews-squeezer": "I(OF) -> II(EF, BE) -> II(GE, AG) -> II(HE, AH)",
    "andrews-mechanism": "I(OF) -> II(EF, BE) -> II(GE, AG) -> II(HE, AH)",
    "catapult": "I(cross) -> I(arm) -> I(stone)",
    "vibrating-screen": "I(slider G) -> I(screen) -> I(exciter)",
    "double-pendulum": "I(OA) -> I(AB)",
    "five-bar-pendulum": "I(AB) -> I(ED) -> II(BC, DC)",
    "antiparallelogram": "I(OA) -> II(AB, DB)",
    "chebyshev-straight-line": "I(AB, OA, DB)",
    "cardan-gear": "I(OA) -> II(planet)",
    "excavator-arm": (
        "I(boom, cylinder K-A) -> I(stick, cylinder C-E) -> I(GN, cylinder S-N) -> II(NL, bucket)"
    ),
    "geared-five-bar": "I(OA) -> II(EC) -> II(AB, CB)",
    "planetary-gear-train": "I(sun) -> II(OA, planet)",
    "rack-and-pinion": "I(pinion) -> II(rack)",
    "rolling-wheel-rod": "I(slider C) -> II(wheel) -> II(PB, slider B)",
    "elliptic-trammel": "I(slider A) -> II(AB, slider B)",
    "inverted-slider-crank": "I(OA) -> II(lever, slider A)",
    "jansen-leg": "I(OA) -> II(AB, ZB) -> II(BC, ZC) -> II(AE, ZE) -> II(CF, EF) -> II(FG, EG)",
    "klann-leg": "I(crank) -> II(rod, rocker) -> II(leg, hip)",
    "oscillating-cylinder": "I(OA) -> II(cylinder, rod)",
    "pantograph": "I(CQ) -> II(OB, AQ) -> II(QE, BP)",
    "peaucellier": "I(QC) -> II(OB, CB) -> II(OE, CE) -> II(BP, EP)",
    "scissor-lift": "I(slider A) -> II(OC, AB) -> II(BE, CF) -> II(platform, slider E)",
    "scotch-yoke": "I(OA) -> II(yoke, slider A)",
    "shaper": "I(OA) -> II(lever, slider A) -> II(BE, slider E)",
    "six-bar-press": "I(OA) -> II(AB, CD) -> II(DH, slider)",
    "slider-between-cranks": "I(OA) -> II(AC, slider C) -> II(CB, BD)",
    "stephenson-six-bar": "I(OA) -> II(coupler, DB) -> II(PR, FR)",
    "tangent-mechanism": "I(lever) -> II(slider P, slider slot)",
    "two-link-arm": "I(OA) -> I(AB)",
    "watt-six-bar": "I(OA) -> II(coupler, rocker) -> II(PR, QR)",
}
MOBILITY = {
    "two-link-arm": 2,
    "five-bar-two-drives": 2,
    "bevel-differential": 2,
    "excavator-arm": 3,
    "double-pendulum": 2,
    "five-bar-pendulum": 2,
    "catapult": 3,
    "vibrating-screen": 3,
}
BY_CHEBYSHEV = MOBILITY | {"three-crank-parallelogram": 0}


@pytest.mark.parametrize("name", FORMULAS)
def test_structural_formulas_of_the_examples(name: str) -> None:
    assert structural_formula(structure_of(ct.example(name))) == FORMULAS[name]


@pytest.mark.parametrize("name", ct.example_names())
def test_mobility_by_rank_and_by_chebyshev(name: str) -> None:
    checked = ct.check(ct.example(name))
    assert checked.mobility == MOBILITY.get(name, 1)
    assert checked.count.mobility == BY_CHEBYSHEV.get(name, 1)
    # n links and p pairs: each loop closes with three equations, 3 p - 2 p equations of pairs, so p - n loops
    pairs = checked.count.lower_pairs + checked.count.higher_pairs
    assert checked.count.loops == pairs - checked.count.moving_links


def test_redundant_constraints_are_named() -> None:
    checked = ct.check(ct.example("three-crank-parallelogram"))
    assert set(checked.redundant) == {"point E in link FE"}
    assert ct.check(ct.example("crank-rocker")).redundant == ()


def bars(
    frame: dict[str, tuple[float, float]], drive: str = "OA", guides: Any = (), **lengths: Any
) -> ct.Mechanism:
    """A mechanism of bars named by their ends (a number), or of links with points (a mapping)."""
    links = {
        name: {"length": v} if isinstance(v, float) else {"points": v} for name, v in lengths.items()
    }  # fmt: skip
    return ct.Mechanism(
        frame={"points": {name: list(v) for name, v in frame.items()}},
        links=links,
        guides=list(guides),
        drives=[{"link": drive, "speed": 1.0, "start": 0.5}],
    )


O, D, F = (0.0, 0.0), (4.0, 0.0), (1.0, 4.0)
K = {"A": [0.0, 0.0], "B": [3.0, 0.0], "P": [1.5, 1.0]}
R = {"D": [0.0, 0.0], "B": [2.5, 0.0], "Q": [2.6, 1.0]}
RAIL = {"point": "C", "through": [0.0, 0.0], "direction": [1.0, 0.0]}


def k4_coupler() -> ct.Mechanism:
    """The coupler is a braced quadrilateral of bars: counting alone assigns its redundancy wrongly."""
    return bars({"O": O, "D": D}, OA=1.0, AB=3.5, AE=2.0, AF=2.0, BE=2.5, BF=2.2, EF=1.5, DB=3.0)


def truss_crank() -> ct.Mechanism:
    return bars({"O": O}, guides=[RAIL], OA=1.0, AB=1.0, OB=1.0, BC=3.0)


def parallel_cranks() -> ct.Mechanism:
    coupler = {"A": [0.0, 0.0], "B": [4.0, 0.0], "E": [2.0, 0.0]}
    return bars({"O": O, "D": D, "F": (2.0, 0.0)}, OA=1.0, K=coupler, DB=1.0, FE=1.0)


def scotch() -> ct.Mechanism:
    guides = [
        {"point": "H", "through": [0.0, 0.0], "direction": [1.0, 0.0], "link": "Y"},
        {"point": "A", "on": "Y", "through": [0.0, 0.0], "direction": [0.0, 1.0]},
    ]
    return bars({"O": O}, guides=guides, OA=1.0, Y={"H": [2.0, 0.0]})


def collar() -> ct.Mechanism:
    guides = [{"point": "C", "through": [0.0, 0.6], "direction": [1.0, 0.0], "link": "Y"}]
    return bars({"O": O}, guides=guides, OA=1.0, AB=3.0, Y={"B": [0.2, 0.1], "C": [0.0, 0.0]})


PLANS: dict[str, tuple[ct.Mechanism, list[str]]] = {
    "four-bar": (bars({"O": O, "D": D}, OA=1.0, AB=3.5, DB=3.0), ["crank", "RRR"]),
    "slider-crank": (bars({"O": O}, guides=[RAIL], OA=1.0, AC=3.0), ["crank", "RRP"]),
    "inverted slider-crank": (
        bars(
            {"O": O, "D": D},
            guides=[{"point": "A", "on": "S", "through": [0.0, 0.2], "direction": [1.0, 0.0]}],
            OA=1.0, S={"D": [0.0, 0.0]},
        ),
        ["crank", "RPR"],
    ),
    "scotch yoke": (scotch(), ["crank", "RPP"]),
    "collar": (collar(), ["crank", "RRP"]),
    "Watt": (bars({"O": O, "D": D}, OA=1.0, K=K, R=R, PW=1.2, QW=1.1), ["crank", "RRR", "RRR"]),
    "Stephenson": (bars({"O": O, "D": D, "F": F}, OA=1.0, K=K, DB=2.5, PW=1.5, FW=1.5), ["crank", "RRR", "RRR"]),
    "truss crank": (truss_crank(), ["crank", "RRR", "RRP"]),
    "three cranks": (parallel_cranks(), ["crank", "RRR", "link by two points"]),
    "driven coupler": (bars({"O": O, "D": D}, drive="AB", OA=1.0, AB=3.5, DB=3.0), ["RRR"]),
}  # fmt: skip


@pytest.mark.parametrize("name", PLANS)
def test_plans(name: str) -> None:
    mechanism, kinds = PLANS[name]
    found = [group.kind for group in structure_of(mechanism).groups if group.kind != "rigid point"]
    assert found == kinds


def test_coupler_of_a_braced_quadrilateral() -> None:
    structure = structure_of(k4_coupler())
    assert len(structure.redundant) == 1
    assert structure.generic_mobility == 1
    assert count(k4_coupler()).mobility == 0


def test_hinges_of_three_links_are_counted_twice() -> None:
    counted = count(ct.example("jansen-leg"))
    # eleven bars; A, B, C, E, F, G, Z are hinges of several links
    assert (counted.moving_links, counted.lower_pairs, counted.loops) == (11, 16, 5)


HIGHER = {
    "Watt driven at the rod": bars({"O": O, "D": D}, drive="PW", OA=1.0, K=K, R=R, PW=1.2, QW=1.1),
    "Stephenson driven at the rocker": bars(
        {"O": O, "D": D, "F": F}, drive="FW", OA=1.0, K=K, DB=2.5, PW=1.5, FW=1.5
    ),
}


@pytest.mark.parametrize(
    ("name", "roman", "order", "links"),
    [("Stephenson driven at the rocker", "III", 3, 4), ("Watt driven at the rod", "IV", 2, 5)],
)
def test_classes_of_higher_groups(name: str, roman: str, order: int, links: int) -> None:
    """A ternary link with three inner joints is class III; a closed chain of four joints (B, Q, W, P) class IV."""
    (group,) = [one for one in assur_groups(structure_of(HIGHER[name])) if one.kind == "higher class"]
    assert (group.roman, group.order, len(group.members)) == (roman, order, links)


def test_group_of_class_four() -> None:
    groups = assur_groups(structure_of(ct.example("fourth-class-group")))
    (group,) = [one for one in groups if one.roman == "IV"]
    assert (group.order, set(group.members)) == (2, {"plate", "BD", "CG", "lever"})


def test_a_drive_of_what_is_held_is_refused() -> None:
    """A triangle of the frame and two links stands still; the link DB beside it can move and has no drive."""
    mechanism = bars({"O": O, "D": D, "F": F}, OA=1.0, AF=2.0, DB=1.0)
    with pytest.raises(
        ct.InputError, match="drive of link OA: it cannot move: the rest of the mechanism holds it"
    ):
        ct.check(mechanism)


def test_a_slider_counts_in_the_class_of_its_group() -> None:
    """A platform on two rods, a fixed pin in its slot: three inner joints (two hinges, one slide), class III."""
    pin = {"name": "slot", "point": "F", "on": "K", "through": [0.0, 0.0], "direction": [1.0, 0.2]}
    mechanism = bars(
        {"O": O, "D": D, "F": F}, guides=[pin], OA=1.0, AP=2.0, K={"P": [0.0, 1.0], "B": [2.0, 0.5]}, DB=2.5
    )
    (group,) = [one for one in assur_groups(structure_of(mechanism)) if one.kind == "higher class"]
    assert (group.roman, group.order) == ("III", 3)
    assert set(group.members) == {"AP", "K", "DB", "slider slot"}


def driven(links: list[str], **lengths: Any) -> ct.Mechanism:
    free = bars({"O": O, "D": D}, **lengths)
    return free.model_copy(
        update={
            "drives": tuple(ct.Drive(link=name, speed=1.0, start=0.3 + k) for k, name in enumerate(links))
        }
    )


def test_drives_are_compared_with_the_mobility() -> None:
    four_bar = {"OA": 1.0, "AB": 3.5, "DB": 3.0}
    with pytest.raises(
        ct.InputError, match=r"2 drives are given, but the mobility \(by rank\) is 1; give as many"
    ):
        ct.check(driven(["OA", "DB"], **four_bar))
    with pytest.raises(
        ct.InputError, match=r"1 drive is given, but the mobility \(by rank\) is 2; add drives"
    ):
        structure_of(driven(["OA"], OA=1.0, AB=2.0, BC=2.0, DC=1.0))
    with pytest.raises(ct.InputError, match="the mechanism has no drive"):
        structure_of(driven([], **four_bar))
    assert structure_of(driven(["OA", "DC"], OA=1.0, AB=2.0, BC=2.0, DC=1.0)).generic_mobility == 2


def test_special_dimensions_move_though_the_count_says_no() -> None:
    assert ct.check(ct.example("three-crank-parallelogram")).mobility == 1
    parts = ct.example("three-crank-parallelogram")
    wrong = ct.with_value(parts, "links.FE.length", 1.001)
    with pytest.raises(
        ct.InputError, match=r"length of link FE: .* the residual of this constraint is 0\.001 m"
    ):
        ct.check(wrong)


def test_a_drive_of_what_is_held_fast_is_told() -> None:
    """As many drives as the mobility, but on the wrong link: not that there are too few."""
    held = ct.Mechanism(
        frame={"points": {"O": [0, 0], "E": [2, 0], "F": [1, 1]}},
        links={"OA": {"length": 1}, "arch": {"points": {"E": [0, 0], "F": [2**0.5, 0]}}},
        drives=[{"link": "arch", "start": "135 deg", "speed": 1}],
    )
    with pytest.raises(
        ct.InputError, match=r"drive of link arch: it cannot move: .* holds it; drive a part that can move"
    ):
        ct.check(held)
