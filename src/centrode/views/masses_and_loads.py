"""Masses of the links, loads and the machine, as the description gives them: a chapter of documents."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, assert_never

import numpy as np

from centrode.dynamics.state import Centre
from centrode.model.loads import (
    DISPLACEMENT,
    DRIVE,
    AnyLoad,
    BearingFriction,
    GuideForce,
    GuideFriction,
    HingeDamper,
    HingeFriction,
    HingeSpring,
    LinkWeight,
    PointDamper,
    PointForce,
    PointSpring,
    PointWeight,
    SliderFriction,
    Torque,
)
from centrode.model.reading import FRAME
from centrode.model.settings import Shaft
from centrode.model.values import TurnsPerMinute
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Column,
    Fact,
    FactTable,
    Illustration,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Place, Sentence, Symbol, Text
from centrode.views.load_names import KINDS, load_text
from centrode.views.load_plots import table_diagram

if TYPE_CHECKING:
    from centrode.dynamics.masses import LinkMasses
    from centrode.dynamics.state import Mass
    from centrode.model.mechanism import Mechanism
    from centrode.model.settings import Machine

AMOUNTS = (
    ("value", NOTHING),
    ("stiffness", Symbol("c")),
    ("damping", Symbol("k")),
    ("viscous", Sentence("viscous")),
    ("quadratic", Sentence("quadratic")),
    ("coefficient", Symbol("f")),
)
"""Numbers of a load, by what stands before them."""
TABLES = {
    "displacement": Sentence("indicator diagram of {count} points"),
    "stroke": Sentence("indicator diagram of {count} points over the stroke"),
    "drive": Sentence("table of {count} points over the drive"),
    "time": Sentence("table of {count} points over time"),
}
UNKNOWN = Number(math.nan)


def sheet(masses: LinkMasses) -> Sheet:
    """The chapter of what is given."""
    mechanism = masses.mechanism
    sections = [Section(Sentence("Masses of the links"), tuple(_masses(masses)))]
    if mechanism.loads or mechanism.gravity:
        sections.append(Section(Sentence("Loads"), tuple(_loads(mechanism))))
    if mechanism.machine is not None:
        facts = FactTable(tuple(_machine(mechanism.machine)))
        sections.append(Section(Sentence("Machine"), (facts,)))
    return Sheet(chapters={"masses-and-loads": Chapter(Sentence("Masses and loads"), tuple(sections))})


def _masses(masses: LinkMasses) -> Iterator[Block]:
    """A row of each link that has a mass, with what is known of it, and what is not."""
    mechanism = masses.mechanism
    known = {one.link: one for one in masses.masses}
    rows = [
        (Name(name), *(_known(mechanism, known[name]) if name in known else _given(mechanism, name)))
        for name in mechanism.links
        if name not in masses.massless
    ]
    if rows:
        link, mass, centre, inertia = zip(*rows, strict=True)
        yield Table(
            (
                Column("link", link, head=Sentence("link")),
                Column("mass", mass, "kg", Sentence("mass")),
                Column("centre", centre, head=Sentence("centre of mass")),
                Column("inertia", inertia, "kg m^2", Sentence("central moment of inertia")),
            )
        )
    several = [name for name, link in mechanism.links.items() if link.masses and name in known]
    if several:
        yield Paragraph(
            Sentence(
                "The masses of {links} are given one by one; the table has their sum, centre and inertia.",
                links=_names(several),
            )
        )
    for reason in masses.incomplete.values():
        yield Paragraph(Sentence("Not complete: {reason}.", reason=Name(str(reason))))
    if masses.massless:
        yield Paragraph(Sentence("Without mass: {links}.", links=_names(masses.massless)))


def _known(mechanism: Mechanism, one: Mass) -> tuple[Text, Text, Text]:
    """Mass, centre and inertia of a link."""
    return _number(one.mass), _centre(mechanism, one), _inertia(mechanism, one)


def _given(mechanism: Mechanism, name: str) -> tuple[Text, Text, Text]:
    """What a description has of a mass that is not complete."""
    link = mechanism.links[name]
    mass = UNKNOWN if link.mass is None else _number(link.mass)
    centre = Name(link.centre) if isinstance(link.centre, str) else UNKNOWN
    inertia = _number(link.inertia) if isinstance(link.inertia, int | float) else UNKNOWN
    return mass, centre, inertia


def _inertia(mechanism: Mechanism, one: Mass) -> Text:
    """In the plane a moment; on the sphere what the description has: moments, or the shape they follow from."""
    if mechanism.space == "plane":
        return _number(one.moment_of_inertia)
    link = mechanism.links[one.link]
    if link.inertia is None:
        return Sentence("of its shape") if link.shape else UNKNOWN
    return _vector(np.atleast_1d(np.asarray(link.inertia, dtype=float)).ravel())


def _centre(mechanism: Mechanism, one: Mass) -> Text:
    """Where a centre of mass lies: in a point, or beside one in the axes of its link."""
    if not one.weighs:
        return UNKNOWN
    link = mechanism.links[one.link]
    own = link.centre
    if isinstance(own, str) and not link.masses:
        return Name(own)
    if not isinstance(one.centre, Centre):
        distance = Number(float(one.centre.distance), "m", unit_fixed=True)
        return Sentence("{distance} from the centre of the sphere", distance=distance)
    along, across = float(one.centre.along), float(one.centre.across)
    if along == across == 0.0:
        return Name(one.centre.base)
    if across == 0.0:
        return Sentence(
            "{along} along the link from {point}", along=Number(along, "m"), point=Name(one.centre.base)
        )
    return Sentence(
        "{along} along and {across} across the link from {point}",
        along=Number(along, "m"),
        across=Number(across, "m"),
        point=Name(one.centre.base),
    )


def _loads(mechanism: Mechanism) -> Iterator[Block]:
    if mechanism.gravity:
        yield Paragraph(
            Sentence(
                "Weights act with $arrow(g)$ = {vector}.",
                vector=Place(tuple(map(float, mechanism.gravity)), "m/s^2"),
            )
        )
    if mechanism.loads:
        texts = [
            (load_text(mechanism, one.label), KINDS[one.kind], _acts_on(one), _amount(one))
            for one in mechanism.loads
        ]
        heads = (Sentence("load"), Sentence("kind"), Sentence("acts on"), Sentence("magnitude (SI)"))
        names = ("load", "kind", "acts_on", "amount")
        columns = zip(names, zip(*texts, strict=True), heads, strict=True)
        yield Table(tuple(Column(name, values, head=head) for name, values, head in columns))
    for diagram in filter(None, (table_diagram(mechanism, one) for one in mechanism.loads)):
        yield Illustration(diagram, diagram.title)


def _acts_on(load: AnyLoad) -> Text:
    """Point, link, guide or two points."""
    match load:
        case GuideForce(guide=guide) | GuideFriction(guide=guide) | SliderFriction(guide=guide):
            return Sentence("guide {name}", name=Name(guide))
        case PointSpring(points=points) | PointDamper(points=points):
            return _names(points)
        case Torque() | HingeSpring() | HingeDamper() | HingeFriction():
            return _names((load.link,) if load.relative_to == FRAME else (load.link, load.relative_to))
        case LinkWeight(link=link):
            return Name(link)
        case BearingFriction(point=point, link=link):
            return Name(point if link is None else link)
        case PointForce(point=point) | PointWeight(point=point):
            return Name(point)
        case _:
            assert_never(load)


def _amount(load: AnyLoad) -> Text:
    """Vector, value and coefficients of a load, in SI; a table by the number of its rows."""
    parts: list[Text] = []
    if isinstance(load, PointForce):
        parts.append(_bracketed_vector(load.vector))
    for key, before in AMOUNTS:
        value = getattr(load, key, None)
        if value is not None:
            parts.append(_number(value) if before == NOTHING else Joined((before, _number(value)), " = "))
    if isinstance(load, GuideForce | Torque) and load.table is not None:
        count = Number(len(load.table), digits="d")
        parts.append(
            TABLES[load.over or (DRIVE if isinstance(load, Torque) else DISPLACEMENT)].fill(count=count)
        )
    if isinstance(load, GuideForce) and load.pressure is not None and load.diameter is not None:
        parts.append(
            Sentence(
                "as shares of {pressure} on a piston of {diameter} across",
                pressure=Number(load.pressure, "Pa", unit_fixed=True),
                diameter=Number(load.diameter, "m"),
            )
        )
    if isinstance(load, PointForce) and load.while_moving is not None:
        way = Place(tuple(map(float, load.while_moving)), "1")
        parts.append(Sentence("while the point moves towards {way}", way=way))
    return Joined(parts) if parts else UNKNOWN


def _number(value: object) -> Text:
    """A number of the description in SI, its unit apart; a formula as it was written."""
    return Name(value) if isinstance(value, str) else Number(float(value), unit_fixed=True)  # type: ignore[arg-type]


def _vector(values: Iterable[object]) -> Joined:
    return Joined(tuple(map(_number, values)), "; ")


def _names(names: Iterable[str]) -> Text:
    return Joined(tuple(map(Name, names)))


def _bracketed_vector(values: Sequence[object]) -> Text:
    """Coordinates in SI; those that are formulas as they were written."""
    numbers = [float(value) for value in values if isinstance(value, int | float)]
    if len(numbers) == len(values):
        return Place(tuple(numbers), "1")
    return Sentence("({vector})", vector=_vector(values))


def _machine(machine: Machine) -> Iterator[Fact]:
    if machine.mean_speed:
        speed: Text = Number(machine.mean_speed, "rad/s", unit_fixed=True)
        if isinstance(machine.mean_speed, TurnsPerMinute):
            turns = Number(machine.mean_speed.rpm, "rpm", unit_fixed=True)
            speed = Sentence("{value} ({remark})", value=turns, remark=speed)
        yield Fact(Sentence("mean speed of the drive"), speed)
    if machine.fluctuation is not None:
        yield Fact(Sentence("admissible coefficient of fluctuation"), Number(machine.fluctuation))
    for number, shaft in enumerate(machine.shafts, start=1):
        label = (
            Name(shaft.name) if shaft.name else Sentence("shaft {number}", number=Number(number, digits="d"))
        )
        yield Fact(label, _shaft(shaft))
    if machine.flywheel.inertia is not None:
        yield Fact(
            Sentence("flywheel"),
            _shaft(Shaft(inertia=machine.flywheel.inertia, ratio=machine.flywheel.ratio)),
        )
    if machine.driving is not None:
        yield Fact(Sentence("course of the driving moment"), Name(machine.driving))


def _shaft(shaft: Shaft) -> Text:
    inertia = Number(shaft.inertia, "kg m^2")
    if shaft.ratio == 1.0:
        return Sentence("{inertia}, on the shaft of the drive", inertia=inertia)
    return Sentence(
        "{inertia}, {ratio} turns in a turn of the drive", inertia=inertia, ratio=Number(shaft.ratio)
    )
