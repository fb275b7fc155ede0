"""Chapters of a document on a train of gears: data, choice of its teeth, their conditions, velocities."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from centrode.gears.closed_trains import ClosedTrain
from centrode.gears.planetary_trains import (
    INTERNAL,
    TIP,
    OrdinaryTrain,
    PlanetaryTrain,
)
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Paragraph,
    Section,
    Table,
)
from centrode.sheets.texts import NOTHING, Counted, Expression, Leaf, Number, Sentence, Text
from centrode.views.closed_train_chapters import closed_sections, shaft_facts

if TYPE_CHECKING:
    from centrode.gears.train_results import GearTrainResults

Line = tuple[Leaf, ...]
ROUNDING = 1e-12
"""Share by which a ratio of whole numbers of teeth and its decimal number may differ."""


def data_chapter(results: GearTrainResults, scheme: Text) -> Chapter:
    """What is given of the train."""
    described = results.gear_train
    facts = [
        Fact(Sentence("scheme of the train"), scheme),
        Fact(Sentence("ratio that is sought"), Number(described.whole_ratio)),
    ]
    if isinstance(results.chosen, ClosedTrain):
        facts += shaft_facts(results.chosen)
    if described.input_speed is not None:
        facts.append(_speed(Sentence("speed of the motor"), described.input_speed))
    if described.output_speed is not None:
        facts.append(_speed(Sentence("speed of the driven shaft"), described.output_speed))
    if described.pair_behind is not None:
        driving, driven = described.pair_behind
        teeth = Sentence(
            "{driving} and {driven}", driving=Number(float(driving)), driven=Number(float(driven))
        )
        facts.append(Fact(Sentence("teeth of the pair behind the train"), teeth))
        facts.append(Fact(Sentence("of it the train has"), Number(described.train_ratio)))
    facts.append(Fact(Sentence("admissible deviation of the ratio"), Number(described.tolerance)))
    facts.append(Fact(Sentence("module"), Number(described.module, "m")))
    least, most = described.teeth
    bounds = Sentence("{least} to {most}", least=Number(float(least)), most=Number(float(most)))
    facts.append(Fact(Sentence("numbers of teeth within"), bounds))
    if not isinstance(results.chosen, OrdinaryTrain):
        facts.append(Fact(Sentence("planets"), Number(float(described.planets))))
    losses = described.mesh_efficiency
    facts.append(Fact(Sentence("efficiency of an external mesh"), Number(losses.external)))
    facts.append(Fact(Sentence("efficiency of an internal mesh"), Number(losses.internal)))
    return Chapter(Sentence("Data"), (Section(NOTHING, (FactTable(tuple(facts), Sentence("Gear train")),)),))


def _speed(label: Text, value: float) -> Fact:
    return Fact(label, Number(value, "rad/s", unit_fixed=True))


def choice_chapter(results: GearTrainResults, facts: tuple[Fact, ...], trains: Table) -> Chapter:
    """The trains that have the ratio, the chosen one, its pitch circles."""
    text = Paragraph(
        Sentence(
            "All numbers of teeth within the bounds were looked at. Those that have the ratio and can be built are "
            "listed by size; the one with the number {number} is chosen.",
            number=Number(float(results.gear_train.chosen)),
        )
    )
    blocks: tuple[Block, ...] = (
        text, trains, FactTable(facts, Sentence("The chosen train")), Illustration("wheels")
    )  # fmt: skip
    return Chapter(Sentence("Choice of the numbers of teeth"), (Section(NOTHING, blocks),))


def conditions_chapter(results: GearTrainResults, powers: tuple[Table, ...]) -> Chapter:
    """Ratio, coaxiality, neighbourhood, assembly and efficiency of the chosen train, with their numbers.

    `powers` has the table of the flow of power of a closed train.
    """
    train = results.chosen
    if isinstance(train, OrdinaryTrain):
        sections = [Section(NOTHING, tuple(_ordinary(results, train)))]
    elif isinstance(train, PlanetaryTrain):
        sections = [Section(NOTHING, tuple(_planetary(results, train)))]
    elif isinstance(train, ClosedTrain):
        sections = [
            Section(Sentence("Set {number}", number=Number(float(number))), tuple(_set(stage, number)))
            for number, stage in enumerate(train.stages, 1)
        ]
        sections += closed_sections(train, results.efficiencies, powers[0])
    else:
        sections = [
            Section(
                Sentence("Train {number}", number=Number(float(number))), tuple(_planetary(results, stage))
            )
            for number, stage in enumerate(train.stages, 1)
        ]
    sections.append(Section(Sentence("Whole train"), tuple(_whole(results))))
    return Chapter(Sentence("Ratio, conditions and efficiency"), tuple(sections))


def _teeth(value: int) -> Number:
    return Number(float(value))


def _planetary(results: GearTrainResults, train: PlanetaryTrain) -> Iterator[Block]:
    yield from _willis(train)
    yield from _conditions(train)
    yield from _efficiency(results, train)


def _set(train: PlanetaryTrain, number: int) -> Iterator[Block]:
    """A set of a closed train: its own ratio, and the conditions of its teeth."""
    yield Paragraph(
        Sentence(
            "Against the carrier the set is an ordinary train. Its ring has so many times the teeth of its sun:"
        )
    )
    yield Formula(
        (
            (
                f"p_{number}",
                Expression("frac(z_3, z_1)"),
                Expression("frac({d}, {a})", d=_teeth(train.teeth[3]), a=_teeth(train.teeth[0])),
                Number(-float(train.fixed_carrier_ratio)),
            ),
        ),
        "ratio",
    )
    yield from _conditions(train)


def _willis(train: PlanetaryTrain) -> Iterator[Block]:
    """The ratio against the carrier, and with wheel 3 at rest."""
    sun, planet, other, fixed = train.teeth
    sign = "-" if train.scheme.sun * train.scheme.fixed < 0 else ""
    stepped = train.scheme.stepped
    letters = f"{sign}frac(z_2 z_3, z_1 z'_2)" if stepped else "-frac(z_3, z_1)"
    numbers = f"{sign}frac({{b}} dot {{d}}, {{a}} dot {{c}})" if stepped else "-frac({d}, {a})"
    values: dict[str, Leaf] = {"a": _teeth(sun), "b": _teeth(planet), "c": _teeth(other), "d": _teeth(fixed)}
    own = float(train.fixed_carrier_ratio)
    yield Paragraph(
        Sentence("Against the carrier the train is an ordinary one. By Willis' method its ratio is")
    )
    lines: list[Line] = [
        ("u_0", Expression(letters), Expression(numbers, **_used_letters(numbers, values)), Number(own)),
        ('u_(1 "H")', Expression("1 - u_0"), Number(float(train.sun_ratio))),
    ]
    if train.driver == "carrier":
        lines.append(('u_("H" 1)', Expression('frac(1, u_(1 "H"))'), Number(float(train.ratio))))
    yield Formula(tuple(lines), "ratio")


def _conditions(train: PlanetaryTrain) -> Iterator[Block]:
    """Coaxial axes, neighbours, assembly."""
    sun, planet, other, fixed = train.teeth
    scheme, second = train.scheme, "z'_2" if train.scheme.stepped else "z_2"
    yield Paragraph(
        Sentence(
            "Wheels 1 and 3 and the carrier have one axis where both meshes give one radius of the carrier:"
        )
    )
    first, last = ("-" if scheme.sun == INTERNAL else "+"), ("-" if scheme.fixed == INTERNAL else "+")
    yield Formula(
        (
            (
                f"z_1 {first} z_2",
                Expression(f"{{a}} {first} {{b}}", a=_teeth(sun), b=_teeth(planet)),
                _teeth(train.arms[0]),
            ),
            (
                f"z_3 {last} {second}",
                Expression(f"{{d}} {last} {{c}}", d=_teeth(fixed), c=_teeth(other)),
                _teeth(train.arms[1]),
            ),
        ),
        "coaxiality",
    )
    if train.planets > 1:
        yield from _neighbours(train)
        yield from _assembly(train)


def _used_letters(notation: str, values: dict[str, Leaf]) -> dict[str, Leaf]:
    return {name: value for name, value in values.items() if f"{{{name}}}" in notation}


def _neighbours(train: PlanetaryTrain) -> Iterator[Block]:
    yield Paragraph(
        Sentence(
            "Neighbouring planets pass each other if their axes lie further apart than their tips reach:"
        )
    )
    largest = max(train.teeth[1:3])
    apart = abs(train.arms[0]) * math.sin(math.pi / train.planets)
    letters = "(z_1 - z_2)" if train.scheme.sun == INTERNAL else "(z_1 + z_2)"
    if train.scheme.sun == INTERNAL:
        letters = "|z_1 - z_2|"
    yield Formula(
        (
            (
                f"{letters} sin frac(pi, k)",
                Expression(
                    "{arm} dot sin frac(pi, {k})", arm=_teeth(abs(train.arms[0])), k=_teeth(train.planets)
                ),
                Number(apart),
            ),
            (
                'z_"max" + 2 h_a^*',
                Expression("{z} + {two}", z=_teeth(largest), two=Number(TIP)),
                Number(largest + TIP),
            ),
        ),
        "neighbourhood",
    )
    yield Paragraph(
        Counted(
            "The first number is the greater one. At most {n} planet fits.",
            "The first number is the greater one. At most {n} planets fit.",
            train.most_planets,
        )
    )


def _assembly(train: PlanetaryTrain) -> Iterator[Block]:
    sun, planet, other, fixed = train.teeth
    yield Paragraph(Sentence("Planets at equal angles can be assembled if this is a whole number:"))
    if not train.scheme.stepped:
        total = Expression("frac({a} + {d}, {k})", a=_teeth(sun), d=_teeth(fixed), k=_teeth(train.planets))
        yield Formula((("frac(z_1 + z_3, k)", total, Number((sun + fixed) / train.planets)),), "assembly")
        return
    step = math.gcd(planet, other)
    sign = "+" if train.scheme.sun * train.scheme.fixed < 0 else "-"
    whole = sun * other + planet * fixed if sign == "+" else abs(sun * other - planet * fixed)
    yield Formula(
        (
            (
                f"frac(|z_1 z'_2 {sign} z_2 z_3|, k D)",
                Expression(
                    f"frac(|{{a}} dot {{c}} {sign} {{b}} dot {{d}}|, {{k}} dot {{g}})",
                    a=_teeth(sun),
                    b=_teeth(planet),
                    c=_teeth(other),
                    d=_teeth(fixed),
                    k=_teeth(train.planets),
                    g=_teeth(step),
                ),
                Number(whole / (train.planets * step)),
            ),
        ),
        "assembly",
    )
    yield Paragraph(Sentence("$D$ is the greatest common divisor of $z_2$ and $z'_2$."))


def _efficiency(results: GearTrainResults, train: PlanetaryTrain) -> Iterator[Block]:
    meshes = results.efficiencies
    fixed_carrier = meshes.of_mesh(train.scheme.sun) * meshes.of_mesh(train.scheme.fixed)
    ratio, efficiency = float(train.fixed_carrier_ratio), train.efficiency(meshes)
    sun_drives = (ratio / (ratio - 1) > 0) == (train.driver == "sun")
    power = "eta_0" if sun_drives else "eta_0^(-1)"
    letters = (
        f"frac(1 - u_0 {power}, 1 - u_0)" if train.driver == "sun" else f"frac(1 - u_0, 1 - u_0 {power})"
    )
    yield Paragraph(
        Sentence(
            "The meshes lose power as against a fixed carrier ($eta_0$); where wheel 1 does not drive there, it is "
            "inverted:"
        )
    )
    first, last = (meshes.of_mesh(sign) for sign in (train.scheme.sun, train.scheme.fixed))
    yield Formula(
        (
            ("eta_0", Expression("{a} dot {b}", a=Number(first), b=Number(last)), Number(fixed_carrier)),
            ("eta", Expression(letters), Number(efficiency)),
        ),
        "efficiency",
    )
    if efficiency <= 0:
        yield Paragraph(Sentence("The train locks itself."))


def _ordinary(results: GearTrainResults, train: OrdinaryTrain) -> Iterator[Block]:
    yield Paragraph(
        Sentence("Each external pair turns the sense of rotation round. The ratio of the train is")
    )
    factors = " ".join(f"(-frac(z_{2 * place + 2}, z_{2 * place + 1}))" for place in range(len(train.pairs)))
    numbers = " dot ".join(f"(-frac({{b{place}}}, {{a{place}}}))" for place in range(len(train.pairs)))
    values: dict[str, Leaf] = {}
    for place, (driving, driven) in enumerate(train.pairs):
        values |= {f"a{place}": _teeth(driving), f"b{place}": _teeth(driven)}
    yield Formula(
        (("u", Expression(factors), Expression(numbers, **values), Number(float(train.ratio))),), "ratio"
    )
    meshes = results.efficiencies
    yield Formula(
        (
            (
                "eta",
                Expression("{a}^({n})", a=Number(meshes.external), n=Number(float(len(train.pairs)))),
                Number(train.efficiency(meshes)),
            ),
        ),
        "efficiency",
    )


def _whole(results: GearTrainResults) -> Iterator[Block]:
    train, described = results.chosen, results.gear_train
    ratio = results.whole_ratio(train)
    if described.pair_behind is not None:
        driving, driven = described.pair_behind
        yield Paragraph(Sentence("With the pair behind the train:"))
        yield Formula(
            (
                (
                    "u",
                    Expression(
                        "{t} dot (-frac({b}, {a}))",
                        t=Number(float(train.ratio)),
                        a=_teeth(driving),
                        b=_teeth(driven),
                    ),
                    Number(ratio),
                ),
            )
        )
    yield Paragraph(
        Sentence(
            "The ratio {ratio} deviates by {share} % from that which is sought; the efficiency is {efficiency}.",
            ratio=Number(ratio),
            share=Number(100 * results.deviation(train), digits=".3g"),
            efficiency=Number(results.efficiency(train), digits=".4g"),
        )
    )
    speeds = results.motions[-1].speed if described.pair_behind is not None else None
    if speeds is not None:
        yield Check(
            Sentence(
                "The plan of velocities gives the speed of the driven shaft by the ratio within {share}."
            ),
            abs(speeds - results.output_speed),
            abs(results.output_speed),
            ROUNDING,
        )


def motion_chapter(members: Table) -> Chapter:
    """Plans of linear and angular velocities, and how fast each member turns."""
    text = Paragraph(
        Sentence(
            "Each member has velocities that grow in a straight line along the line of centres; two members that mesh "
            "have one velocity at their contact. Rays from a pole parallel to these lines cut off the angular "
            "velocities."
        )
    )
    blocks: tuple[Block, ...] = (
        text, Illustration("velocities"), Illustration("angular-velocities"), members
    )  # fmt: skip
    return Chapter(Sentence("Velocities of the train"), (Section(NOTHING, blocks),))
