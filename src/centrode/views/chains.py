"""Kinematic chains and Assur groups: the chain of a mechanism, lists of all, and their atlases."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.chains.identification import family_of, fellows
from centrode.chains.kinematic_chains import GREATEST
from centrode.chains.planar_drawings import chain_sketch
from centrode.sheets.chain_atlas import AtlasCell, ChainAtlas
from centrode.sheets.sheet import Column, Deferred, Fact, Sheet, Table
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Text
from centrode.structure.assur import roman

if TYPE_CHECKING:
    from centrode.chains.assur_schemes import AssurList, AssurScheme
    from centrode.chains.identification import ChainInversion, ChainOfMechanism
    from centrode.chains.kinematic_chains import ChainList, KinematicChain

Outlines: TypeAlias = tuple[tuple[int, ...], ...]
CellOf: TypeAlias = Callable[[int], tuple[NDArray[np.float64], Outlines, tuple[int, ...]]]

MOST_ROWS = 60
"""Rows of a table that a terminal shows."""
CELLS = 20
"""Sketches of one picture."""
MOST_NAMED = 3
"""Inversions that are named one by one where a hinge of several links leaves a choice."""
POLYGONS = {
    2: Sentence("binary links"),
    3: Sentence("ternary links"),
    4: Sentence("quaternary links"),
    5: Sentence("quinary links"),
    6: Sentence("senary links"),
}
"""Joints of a link -> what such links are called."""


def _whole(number: int) -> Number:
    return Number(number, digits="d")


# The chain of a mechanism


def sheet(found: ChainOfMechanism) -> Sheet:
    """Numbers of links and joints, and the inversion."""
    return Sheet(facts=tuple(_facts(found)))


def _facts(found: ChainOfMechanism) -> Iterator[Fact]:
    yield Fact(Sentence("links"), _whole(found.links))
    joints = Sentence(
        "{joints}, {sliding} of them prismatic", joints=_whole(found.joints), sliding=_whole(found.sliding)
    )
    yield Fact(Sentence("joints"), joints if found.sliding else _whole(found.joints))
    if found.split:
        yield Fact(Sentence("hinges of several links"), Joined(tuple(map(Name, found.split))))
    yield chain_fact(found)


def chain_fact(found: ChainOfMechanism) -> Fact:
    """The chain and inversion of a mechanism, or why it has none that is named here."""
    return Fact(Sentence("kinematic chain"), chain_text(found))


def chain_text(found: ChainOfMechanism) -> Text:
    """The chain and inversion of a mechanism as a phrase, or why it has none that is named here."""
    match found.unnamed:
        case "higher pairs":
            return Sentence(
                "none of lower pairs alone; higher pairs: {names}",
                names=Joined(tuple(map(Name, found.higher))),
            )
        case "open":
            return Sentence("open: a link has a single joint")
        case "many links":
            return Sentence(
                "not named: more than {most} links, or hinges of too many links", most=_whole(GREATEST)
            )
        case "dimensions":
            return Sentence(
                "not named: so many links and joints move by special dimensions or directions alone"
            )
        case "":
            chain = _inversions(found.inversions)
            if not found.passive:
                return chain
            passive = Joined(tuple(map(Name, found.passive)))
            return Sentence("{chain}; passive links: {names}", chain=chain, names=passive)


def _inversions(inversions: Sequence[ChainInversion]) -> Text:
    """The inversion, or those that a mechanism with hinges of several links is a limit of."""
    if len(inversions) == 1:
        return inversion_name(inversions[0])
    if len(inversions) <= MOST_NAMED:
        return Sentence("limit of {names}", names=Joined(tuple(map(inversion_name, inversions)), "; "))
    return Sentence(
        "{name}, or another of the {count} that its hinges of several links are limits of",
        name=inversion_name(inversions[0]),
        count=_whole(len(inversions)),
    )


def inversion_name(inversion: ChainInversion) -> Text:
    """What an inversion is called: Stephenson III, or its numbers in the lists."""
    chain, number = inversion.chain, Name(roman(inversion.number))
    match family_of(chain):
        case "four-bar":
            return Sentence("four-bar chain")
        case "Watt":
            return Sentence("Watt {number}", number=number)
        case "Stephenson":
            return Sentence("Stephenson {number}", number=number)
        case "":
            pass
    inversions = _whole(len(chain.inversions))
    if inversion.chain_number is None:
        return Sentence(
            "chain of {links} links, inversion {number} of {inversions}",
            links=_whole(chain.links),
            number=_whole(inversion.number),
            inversions=inversions,
        )
    return Sentence(
        "chain of {links} links no. {chain} of {chains}, inversion {number} of {inversions}",
        links=_whole(chain.links),
        chain=_whole(inversion.chain_number),
        chains=_whole(len(fellows(chain))),
        number=_whole(inversion.number),
        inversions=inversions,
    )


# Lists


def chains_sheet(found: ChainList, number: int | None = None) -> Sheet:
    """Counts, a row for each chain, and their atlas; of the chain of a number alone where there is one."""
    chains = found.chains
    shown = range(len(chains)) if number is None else range(number - 1, number)
    facts = (
        Fact(Sentence("links"), _whole(found.links)),
        Fact(Sentence("joints"), _whole(len(chains[0].joints))),
        Fact(Sentence("mobility"), _whole(found.mobility)),
        Fact(Sentence("independent loops"), _whole(chains[0].loops)),
        Fact(Sentence("chains"), _whole(len(chains))),
        Fact(Sentence("inversions"), _whole(sum(len(chain.inversions) for chain in chains))),
    )
    title = Sentence(
        "Kinematic chains of {links} links, mobility {mobility}",
        links=facts[0].value,
        mobility=facts[2].value,
    )
    names = [chain_name(chains[place], place + 1) for place in shown]
    chosen = [chains[place] for place in shown]
    table = Table(tuple(_chain_columns(chosen, names)), title)
    pictures = _pages(title, names, partial(_chain_cell, chosen))
    return Sheet(facts=facts, tables={"chains": table}, pictures=pictures, **_printed_table(table))


def _printed_table(table: Table) -> dict[str, Any]:
    """The table on the terminal, or where it is found if it is long."""
    if len(table.columns[0].values) <= MOST_ROWS:
        return {"printed": (table,)}
    return {"notes": (Sentence("the list is long: --out writes it into a folder"),)}


def chain_name(chain: KinematicChain, number: int) -> Text:
    """A chain by its number in its list, with its name where it has one."""
    match family_of(chain):
        case "Watt":
            return Joined((_whole(number), Sentence("Watt chain")), ". ")
        case "Stephenson":
            return Joined((_whole(number), Sentence("Stephenson chain")), ". ")
        case "four-bar" | "":
            return _whole(number)


def _chain_columns(chains: Sequence[KinematicChain], names: Sequence[Text]) -> Iterator[Column]:
    yield Column("chain", tuple(names), head=Sentence("chain"))
    for degree in range(2, 2 + max(len(chain.assortment) for chain in chains)):
        counts = tuple(_whole(chain.degrees.count(degree)) for chain in chains)
        name = POLYGONS[degree]
        yield Column(name.message.replace(" ", "_"), counts, head=name)
    inversions = tuple(_whole(len(chain.inversions)) for chain in chains)
    yield Column("inversions", inversions, head=Sentence("inversions"))
    joints = tuple(Name(joints_text(chain.joints)) for chain in chains)
    yield Column("joints", joints, head=Sentence("joints between links"))


def joints_text(joints: Sequence[tuple[int, int]]) -> str:
    """Joints by the numbers of their links, counted from 1: 1-2 1-3."""
    return " ".join(f"{one + 1}-{other + 1}" for one, other in joints)


def _chain_cell(
    chains: Sequence[KinematicChain], place: int
) -> tuple[NDArray[np.float64], Outlines, tuple[int, ...]]:
    sketch = chain_sketch(chains[place])
    return sketch.places, sketch.outlines, ()


def groups_sheet(found: AssurList) -> Sheet:
    """Counts, a row for each Assur group, and their atlas."""
    groups = found.groups
    facts = (
        Fact(Sentence("links"), _whole(found.links)),
        Fact(Sentence("joints"), _whole(len(groups[0].truss.joints))),
        Fact(Sentence("Assur groups"), _whole(len(groups))),
    )
    title = Sentence("Assur groups of {links} links", links=facts[0].value)
    names = [_group_name(group, number) for number, group in enumerate(groups, start=1)]
    columns = (
        Column("group", tuple(map(_whole, range(1, 1 + len(groups)))), head=Sentence("group")),
        Column("class", tuple(Name(group.roman) for group in groups), head=Sentence("class")),
        Column("order", tuple(_whole(group.order) for group in groups), head=Sentence("order")),
        Column(
            "inner_joints",
            tuple(Name(_inner(group)) for group in groups),
            head=Sentence("inner joints between links"),
        ),
        Column(
            "outer_links",
            tuple(Name(_outer(group)) for group in groups),
            head=Sentence("links with outer joints"),
        ),
    )
    table = Table(columns, title)
    pictures = _pages(title, names, partial(_group_cell, groups))
    return Sheet(facts=facts, tables={"groups": table}, pictures=pictures, **_printed_table(table))


def _group_name(group: AssurScheme, number: int) -> Text:
    about = Sentence("class {roman}, order {order}", roman=Name(group.roman), order=_whole(group.order))
    return Joined((_whole(number), about), ". ")


def _numbers(group: AssurScheme) -> dict[int, int]:
    return {link: number for number, link in enumerate(group.links)}


def _inner(group: AssurScheme) -> str:
    number = _numbers(group)
    return joints_text([(number[one], number[other]) for one, other in group.inner_joints])


def _outer(group: AssurScheme) -> str:
    number = _numbers(group)
    return " ".join(str(number[link] + 1) for link in group.outer_links)


def _group_cell(
    groups: Sequence[AssurScheme], place: int
) -> tuple[NDArray[np.float64], Outlines, tuple[int, ...]]:
    group = groups[place]
    sketch = chain_sketch(group.truss)
    outlines = tuple(sketch.outlines[link] for link in group.links)
    return sketch.places, outlines, sketch.outlines[group.removed]


def _pages(title: Sentence, names: Sequence[Text], cell: CellOf) -> Mapping[str, ChainAtlas]:
    """Pictures of an atlas, as many as are needed."""
    firsts = range(0, len(names), CELLS)
    page = partial(_page, title, names, cell)
    if len(firsts) == 1:
        return Deferred({"atlas": partial(page, 0)})
    # as many figures in each number, so that folders list the pages in order
    wide = len(str(len(firsts)))
    return Deferred({f"atlas-{k:0{wide}d}": partial(page, first) for k, first in enumerate(firsts, 1)})


def _page(title: Sentence, names: Sequence[Text], cell: CellOf, first: int) -> ChainAtlas:
    places = range(first, min(first + CELLS, len(names)))
    cells = tuple(AtlasCell(names[place], *cell(place)) for place in places)
    has_outer = any(one.outer for one in cells)
    return ChainAtlas(title, Sentence("filled circles: outer joints") if has_outer else NOTHING, cells)
