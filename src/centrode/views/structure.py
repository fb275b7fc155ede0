"""The structure of a mechanism: what the terminal shows of a check, and the chapters of what is given and of it."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Deferred,
    Fact,
    Formula,
    Items,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Counted, Expression, Joined, Name, Number, Sentence, Text
from centrode.structure.pairs import kinematic_pairs
from centrode.views.chains import chain_fact, chain_text
from centrode.views.linkage_data import data_chapter

if TYPE_CHECKING:
    from centrode.kinematics.check import MechanismCheck
    from centrode.model.mechanism import Mechanism
    from centrode.structure.assur import AssurGroup
    from centrode.structure.pairs import KinematicPair, PairedBody, PairKind
    from centrode.structure.rank import Count

CLOSES = 1e-9
"""Residual over the greatest length up to which an initial position is accepted as closed."""


def _whole(number: int) -> Number:
    return Number(number, digits="d")


PAIRS: dict[PairKind, tuple[Text, Text]] = {
    "turning": (Sentence("revolute pair, class {number}", number=_whole(5)), Sentence("R")),
    "sliding": (Sentence("prismatic pair, class {number}", number=_whole(5)), Sentence("P")),
    "gear": (Sentence("gear pair, class {number}", number=_whole(4)), NOTHING),
    "rolling": (Sentence("rolling pair"), NOTHING),
}
"""Kind of a pair -> what it is called, and its sign."""

GROUP_KINDS: dict[str, Text] = {
    "RRR": Sentence("RRR"),
    "RRP": Sentence("RRP"),
    "RPR": Sentence("RPR"),
    "PRP": Sentence("PRP"),
    "RPP": Sentence("RPP"),
    "gear": Sentence("gear"),
    "rolling": Sentence("rolling"),
    "gear train": Sentence("gear train"),
    "higher class": Sentence("higher class"),
    "parallel link": Sentence("parallel link"),
    "link by two points": Sentence("link by two points"),
}
"""Kind of a group -> what it is called: dyads by the letters of their pairs, which depend on the language."""


def sheet(checked: MechanismCheck) -> Sheet:
    """Mobility, groups, plan and initial position, and the chapters on the data and the structure."""
    chapters = {
        "data": partial(data_chapter, checked.mechanism),
        "structure": partial(_chapter, checked),
    }
    return Sheet(facts=(*facts(checked), *_plan(checked)), chapters=Deferred(chapters))


def facts(checked: MechanismCheck) -> Iterator[Fact]:
    """Mobility, redundant constraints, loops, groups and initial position."""
    yield Fact(
        Sentence("mobility"),
        Sentence(
            "{rank} by rank; by Chebyshev's formula {formula}",
            rank=_whole(checked.mobility),
            formula=_chebyshev(checked.count),
        ),
    )
    yield Fact(Sentence("drives"), Joined(tuple(map(Name, checked.drives))))
    redundant = Joined(tuple(map(Name, checked.redundant)), "; ")
    yield Fact(Sentence("redundant constraints"), redundant if checked.redundant else Sentence("none"))
    yield Fact(Sentence("independent loops"), _whole(checked.count.loops))
    yield chain_fact(checked.chain)
    yield Fact(Sentence("structural formula"), Name(checked.formula))
    for number, group in enumerate(checked.groups):
        yield Fact(NOTHING if number else Sentence("groups"), _group(group))
    closes = Sentence(
        "closes within {residual} of the greatest length",
        residual=Number(checked.initial_residual, digits=".1e"),
    )
    yield Fact(
        Sentence("initial position"), closes if checked.initial_residual else Sentence("closes exactly")
    )


def _chebyshev(count: Count) -> Text:
    """Chebyshev's formula with its numbers, as a terminal has it."""
    return Expression(
        "3·{links} - 2·{lower} - {higher} = {mobility}",
        links=_whole(count.moving_links),
        lower=_whole(count.lower_pairs),
        higher=_whole(count.higher_pairs),
        mobility=_whole(count.mobility),
    )


def _group(group: AssurGroup) -> Text:
    name = Joined(tuple(map(Name, group.members)))
    if group.roman == "I":
        return Sentence("{name}: input, class I", name=name)
    if group.roman == "0":
        return Sentence("{name}: passive link, repeats other links", name=name)
    return Sentence(
        "{name}: class {roman}, order {order}, {kind}",
        name=name,
        roman=Name(group.roman),
        order=_whole(group.order),
        kind=GROUP_KINDS[group.kind],
    )


def _plan(checked: MechanismCheck) -> Iterator[Fact]:
    """The steps of the solution."""
    for number, step in enumerate(checked.plan):
        text = Joined((_whole(number + 1), Name(step)), ". ")
        yield Fact(NOTHING if number else Sentence("order of solution"), text)


# Chapter


def _chapter(checked: MechanismCheck) -> Chapter:
    """Pairs, mobility by formula and by rank, groups in the order of solving."""
    return Chapter(
        Sentence("Structure"),
        (
            Section(Sentence("Kinematic pairs"), (_pairs(checked.mechanism),)),
            Section(Sentence("Mobility"), tuple(_mobility(checked))),
            Section(Sentence("Assur groups"), tuple(_groups(checked))),
        ),
    )


def _pairs(mechanism: Mechanism) -> Table:
    """Every pair with the bodies it joins."""
    pairs = kinematic_pairs(mechanism)
    columns = (
        Column("pair", tuple(Name(pair.name) for pair in pairs), head=Sentence("pair")),
        Column("bodies", tuple(map(_bodies, pairs)), head=Sentence("bodies")),
        Column("kind", tuple(PAIRS[pair.kind][0] for pair in pairs), head=Sentence("kind")),
        Column("sign", tuple(PAIRS[pair.kind][1] for pair in pairs), head=Sentence("sign")),
    )
    return Table(columns, Sentence("Kinematic pairs"))


def _bodies(pair: KinematicPair) -> Text:
    return Joined(tuple(map(_body, pair.bodies)), " – ")


def _body(body: PairedBody) -> Text:
    name = Name(body.name)
    match body.kind:
        case "frame":
            return Sentence("frame")
        case "link":
            return name
        case "slider":
            return Sentence("slider {point}", point=name)
        case "barrel":
            return Sentence("barrel of cylinder {name}", name=name)
        case "rod":
            return Sentence("rod of cylinder {name}", name=name)


def _mobility(checked: MechanismCheck) -> Iterator[Block]:
    """Chebyshev's formula with its numbers, the rank, redundant constraints and loops."""
    count = checked.count
    links, lower, higher = map(_whole, (count.moving_links, count.lower_pairs, count.higher_pairs))
    counts = Sentence(
        "Moving links: $n = {n}$; pairs of class {five}: $p_5 = {lower}$; pairs of class {four}: $p_4 = {higher}$.",
        n=links,
        lower=lower,
        higher=higher,
        five=_whole(5),
        four=_whole(4),
    )
    yield Paragraph(counts)
    numbers = Expression(
        "3 dot.op {links} - 2 dot.op {lower} - {higher}", links=links, lower=lower, higher=higher
    )
    yield Formula((("W", "3 n - 2 p_5 - p_4", numbers, _whole(count.mobility)),))
    if checked.redundant:
        listed = Joined(tuple(map(Name, checked.redundant)))
        text = Sentence(
            "Redundant constraints (their dimensions have to be consistent with the others): {constraints}.",
            constraints=listed,
        )
        yield Paragraph(text)
    rank = Sentence(
        "The rank of the Jacobian of all constraints at real positions gives the mobility {rank}, as many as there are"
        " drives.",
        rank=_whole(checked.mobility),
    )
    yield Check(rank, abs(checked.mobility - len(checked.drives)), 1.0, 0.0)
    loops = Counted(
        "There is {n} independent closed loop.", "There are {n} independent closed loops.", count.loops
    )
    yield Paragraph(loops)
    yield Paragraph(Sentence("Kinematic chain: {chain}.", chain=chain_text(checked.chain)))


def _groups(checked: MechanismCheck) -> Iterator[Block]:
    """The structural formula, its groups and the steps of the solution."""
    formula = Name(checked.formula.replace("->", "→"))
    yield Paragraph(Sentence("Structural formula: {formula}", formula=formula))
    groups = checked.groups
    columns = (
        Column(
            "group", tuple(Joined(tuple(map(Name, one.members))) for one in groups), head=Sentence("group")
        ),
        Column(
            "class",
            tuple(Name("" if one.roman == "0" else one.roman) for one in groups),
            head=Sentence("class"),
        ),
        Column("order", tuple(map(_order, groups)), head=Sentence("order")),
        Column("kind", tuple(map(_kind, groups)), head=Sentence("kind")),
    )
    yield Table(columns, Sentence("Groups in the order of solving"))
    yield Items(tuple(map(Name, checked.plan)), numbered=True)
    closes = Sentence(
        "The initial position closes within {residual} of the greatest length.",
        residual=Number(checked.initial_residual, digits=".1e"),
    )
    if not checked.initial_residual:
        closes = Sentence("The initial position closes exactly.")
    yield Check(closes, checked.initial_residual, 1.0, CLOSES)


def _order(group: AssurGroup) -> Text:
    return _whole(group.order) if group.order and group.roman != "I" else NOTHING


def _kind(group: AssurGroup) -> Text:
    return Sentence("input") if group.roman == "I" else GROUP_KINDS[group.kind]
