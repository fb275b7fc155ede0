"""Sections of a document on a closed train: shafts, ratio of both sets, efficiency, flow of power."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.gears.closed_trains import ClosedTrain, WillisRatio
from centrode.sheets.sheet import Block, Check, Fact, Formula, Paragraph, Section, Table
from centrode.sheets.texts import Expression, Factor, Joined, Leaf, Number, Sentence, Text

if TYPE_CHECKING:
    from centrode.gears.closed_trains import Coefficients
    from centrode.gears.planetary_trains import MeshEfficiency
    from centrode.model.gear_trains import Shaft

ROUNDING = 1e-9
"""Share by which two routes to one efficiency may differ: circulating power loses digits."""


def member_text(name: str) -> Text:
    """What a member of a train is called."""
    if name == "crank":
        return Sentence("crank")
    kind, number = name.split()
    which = Number(float(number))
    words = {
        "wheel": Sentence("wheel {number}", number=which),
        "sun": Sentence("sun {number}", number=which),
        "ring": Sentence("ring {number}", number=which),
        "planet": Sentence("planet {number}", number=which),
        "carrier": Sentence("carrier {number}", number=which),
    }
    return words[kind]


def shaft_text(shaft: Shaft) -> Text:
    """What the members of a shaft are called."""
    return Joined(tuple(map(member_text, shaft)))


def shaft_facts(train: ClosedTrain) -> Iterator[Fact]:
    """What is joined, and what the shafts do."""
    shafts = train.shafts
    yield Fact(Sentence("joined shafts"), Joined(tuple(map(shaft_text, shafts.joined)), "; "))
    yield Fact(Sentence("driving shaft"), shaft_text(shafts.shaft(shafts.input)))
    yield Fact(Sentence("driven shaft"), shaft_text(shafts.shaft(shafts.output)))
    yield Fact(Sentence("shaft at rest"), shaft_text(shafts.shaft(shafts.fixed)))


def power_flow(train: ClosedTrain) -> Sentence:
    """Whether power branches in a closed train, or goes round in it."""
    if train.circulating_power > 0:
        share = Number(train.circulating_power, digits=".4g")
        return Sentence("circulates, {share} of that which drives", share=share)
    if len(train.shafts.shaft(train.shafts.fixed)) == 2:
        return Sentence("passes through one set after the other")
    return Sentence("branches over both sets")


def closed_sections(train: ClosedTrain, meshes: MeshEfficiency, powers: Table) -> Iterator[Section]:
    """The ratio of the whole by both sets, its efficiency, the flow of power."""
    yield Section(Sentence("Ratio of the closed train"), tuple(_ratio(train)))
    yield Section(Sentence("Efficiency of the closed train"), tuple(_efficiency(train, meshes)))
    yield Section(Sentence("Flow of power"), tuple(_flow(train, meshes, powers)))


def _ratio(train: ClosedTrain) -> Iterator[Block]:
    yield Paragraph(
        Sentence(
            "Willis' equations of both sets, with suns $a$, rings $b$ and carriers $H$, and $p = z_b / z_a$:"
        )
    )
    yield Formula(
        tuple(
            (f"omega_(a {k}) + p_{k} omega_(b {k})", Expression(f'(1 + p_{k}) omega_("H" {k})'))
            for k in (1, 2)
        )
    )
    yield Paragraph(
        Sentence("What is joined has one speed. Without the speed of the inner shaft ({shaft}) they give",
                 shaft=shaft_text(train.shafts.inner))
    )  # fmt: skip
    first, second = train.set_ratios
    values: dict[str, Leaf] = {"p": Number(float(first)), "q": Number(float(second))}
    yield Formula(
        (
            (
                "u",
                Expression(ratio_letters(train.formula)),
                _with_numbers(train.formula, values),
                Number(float(train.ratio)),
            ),
        ),
        "ratio",
    )


def ratio_letters(formula: WillisRatio, first: str = "p_1", second: str = "p_2") -> str:
    """The ratio over both p, as a formula in letters; holes may stand for them."""
    above, below = formula.numerator, formula.denominator
    if _leading(below) < 0:
        above, below = -above, -below
    if (below == [[1, 0], [0, 0]]).all():
        return _sum_letters(above, first, second)
    return f"frac({_sum_letters(above, first, second)}, {_sum_letters(below, first, second)})"


def _with_numbers(formula: WillisRatio, values: dict[str, Leaf]) -> Expression:
    notation = ratio_letters(formula, "{p}", "{q}").replace("{p} {q}", "{p} dot {q}")
    return Expression(
        notation, **{name: value for name, value in values.items() if f"{{{name}}}" in notation}
    )


def _leading(coefficients: Coefficients) -> int:
    """The first coefficient that is not zero."""
    return int(next(value for value in coefficients.ravel() if value))


def _sum_letters(coefficients: Coefficients, first: str, second: str) -> str:
    """c_00 + c_10 p_1 + c_01 p_2 + c_11 p_1 p_2 without what is zero, what is positive first."""
    powers = {(0, 0): "", (1, 0): first, (0, 1): second, (1, 1): f"{first} {second}"}
    terms = [(int(coefficients[place]), power) for place, power in powers.items() if coefficients[place]]
    text = ""
    for value, power in sorted(terms, key=lambda term: term[0] < 0):
        size = power if power and abs(value) == 1 else f"{abs(value)} {power}".strip()
        if text:
            text += f" - {size}" if value < 0 else f" + {size}"
        else:
            text = f"-{size}" if value < 0 else size
    return text


def _efficiency(train: ClosedTrain, meshes: MeshEfficiency) -> Iterator[Block]:
    yield Paragraph(
        Sentence(
            "Each set transmits its moments as with its carrier held: with $p eta_0$ where its sun drives against the "
            "carrier, which is where $u$ grows in size with $p$, else with $p \\/ eta_0$."
        )
    )
    loss = meshes.external * meshes.internal
    lines: list[tuple[Leaf | str, ...]] = [
        (
            "eta_0",
            Expression("{a} dot {b}", a=Number(meshes.external), b=Number(meshes.internal)),
            Number(loss),
        )
    ]
    lossy = train.lossy_ratios(meshes)
    for number, (own, value, exponent) in enumerate(
        zip(train.set_ratios, lossy, train.exponents, strict=True), 1
    ):
        sign = "" if exponent > 0 else "^(-1)"
        lines.append(
            (
                f"p'_{number}",
                Expression(f"p_{number} eta_0{sign}"),
                Expression(f"{{p}} dot {{e}}{sign}", p=Number(float(own)), e=Number(loss)),
                Number(value),
            )
        )
    transmitted = train.formula.at(*lossy)
    letters = ratio_letters(train.formula, "p'_1", "p'_2")
    lines.append(("u'", Expression(letters), Number(transmitted)))
    lines.append(
        (
            "eta",
            Expression("frac(u', u)"),
            Expression("frac({t}, {u})", t=Factor(Number(transmitted)), u=Factor(Number(float(train.ratio)))),
            Number(train.efficiency(meshes)),
        )
    )
    yield Formula(tuple(lines), "efficiency")
    if train.efficiency(meshes) <= 0:
        yield Paragraph(Sentence("The train locks itself."))


def _flow(train: ClosedTrain, meshes: MeshEfficiency, powers: Table) -> Iterator[Block]:
    yield Paragraph(
        Sentence("Speeds and moments over those of the driving shaft. Power {flow}.", flow=power_flow(train))
    )
    yield powers
    driven = train.shafts.shaft(train.shafts.output)
    given = -sum(one.power for one in train.powers(meshes) if one.member in driven)
    efficiency = train.efficiency(meshes)
    yield Check(
        Sentence(
            "The power of the driven shaft over that of the driving one is the efficiency within {share}."
        ),
        abs(given - efficiency),
        abs(efficiency),
        ROUNDING,
    )
