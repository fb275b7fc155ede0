"""Forces by hand: what the terminal, the files and the document show of force polygons and Zhukovsky's lever."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, assert_never

import numpy as np
from numpy.typing import NDArray

from centrode.dynamics.force_polygons.steps import (
    Assumption,
    AssurPoint,
    ClosedAlong,
    ClosedPolygon,
    EquationOutcome,
    ForceLine,
    ForcesAlongGuide,
    JointReaction,
    MomentsOfBase,
    MomentsOfGroup,
    MomentsOfLink,
    MomentUnknown,
    Neglect,
    SolvedTogether,
    Step,
)
from centrode.errors import Status
from centrode.sheets.force_pages import GroupPage, LeverPage
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Fact,
    FactTable,
    Illustration,
    Items,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Symbol, Text, Unit
from centrode.views.drive_balance import REAL_MOTION, drive_balance, printed_balance
from centrode.views.force_equations import lever_equation, step_equations
from centrode.views.force_pages import RIGHT_ANGLE, group_page, lever_page
from centrode.views.instants import body_text, instant_title, place_number
from centrode.views.load_names import load_text
from centrode.views.structure import GROUP_KINDS

if TYPE_CHECKING:
    from centrode.dynamics.force_polygons.polygons import (
        ForcePolygons,
        GroupForces,
        Lever,
        Polygon,
        PolygonVector,
    )
    from centrode.dynamics.force_polygons.results import ForcePolygonResults
    from centrode.dynamics.force_polygons.statics import MomentTerm, StaticJoint
    from centrode.dynamics.kinetostatics.applied_forces import DriveGroup
    from centrode.model.mechanism import Mechanism

NONE = 1e-13
"""What is smaller than this part of the greatest force is rounding of what is nothing."""
ROUNDINGS = 1e4
"""Roundings that the routes may differ by: the square of the condition of some well turned mechanism."""
PIN = "pin "
"""How bodies begin that are the bare pin of a hinge."""


def sheet(results: ForcePolygonResults) -> Sheet:
    """Everything there is to say about forces by hand; parts of several instants are numbered."""
    several = len(results.polygons) > 1
    found = [
        (f"-{number}" if several else "", place, one)
        for number, (place, one) in enumerate(zip(results.at, results.polygons, strict=True), start=1)
        if one is not None
    ]
    return Sheet(
        tables={f"polygons{suffix}": _file(one) for suffix, _place, one in found},
        pictures={
            f"{name}{suffix}": page for suffix, _place, one in found for name, page in _pages(one).items()
        },
        chapters={"force-polygons": _chapter(results)},
        printed=tuple(block for _suffix, place, one in found for block in _printed_instant(one, place)),
    )


def _printed_instant(found: ForcePolygons, place: float | str) -> Iterator[Block | Section]:
    """What is printed of one instant: what is what, the steps of each group, all forces, the three routes."""
    instant = found.mechanism.motion_parameter.instant
    where = place_number(instant.read(place, "at"), instant.unit)
    yield Section(Sentence("at {value}", value=where), (FactTable(tuple(_facts(found))),))
    for group in found.groups:
        yield Section(_group_title(found, group), (_steps(found, group),))
    yield _forces(found)
    yield _routes(found)
    if found.group is not None:
        yield printed_balance(*_driving_terms(found, found.group))


def _driving_terms(found: ForcePolygons, group: DriveGroup) -> tuple[float, float, float, float]:
    """Moment of the links, inertia of group I, acceleration, and driving moment, along the coordinate of the drive."""
    (links,) = found.balancing.values()
    return links, group.inertia, float(group.acceleration[0]), float(group.driving[0])


# Facts


def _facts(found: ForcePolygons) -> Iterator[Fact]:
    """Numbers of the bodies, the speed, what F1 and M1 stand for."""
    mechanism = found.mechanism
    bodies = [
        Joined((Number(number), _body(mechanism, name)), " ") for number, name in enumerate(found.names)
    ]
    labels = {one.symbol.partition("(")[0]: one.label for one in found.outer if one.source != "inertia"}
    loads = [Joined((Name(symbol), load_text(mechanism, label)), " ") for symbol, label in labels.items()]
    yield Fact(Sentence("bodies"), Joined(bodies))
    yield Fact(Sentence("speed of the drive"), _speed(found))
    yield Fact(Sentence("loads"), Joined(loads) if loads else Sentence("none"))


def _body(mechanism: Mechanism, name: str) -> Text:
    """A body by its name; frame, sliders and bare pins by a word."""
    if name.startswith(PIN) and name not in mechanism.links:
        return Sentence("pin {point}", point=Name(name.removeprefix(PIN)))
    return body_text(mechanism, name)


def _speed(found: ForcePolygons) -> Text:
    speeds = Joined([_rate(found.mechanism, drive, rate) for drive, rate in found.speed.items()])
    if found.speed_from == "machine":
        return Sentence("{speed}, the mean speed of the machine", speed=speeds)
    if found.speed_from == "steady":
        return Sentence("{speed}, the real speed of the machine", speed=speeds)
    return speeds


def _rate(mechanism: Mechanism, drive: str, rate: float) -> Text:
    """The rate of a drive; a law gives it none of its own."""
    if math.isnan(rate):
        return Sentence("by the law of the drive")
    return Number(rate, mechanism.motion_parameter.drive(drive).speed_unit, unit_fixed=True)


# Steps


def _group_title(found: ForcePolygons, group: GroupForces) -> Text:
    """What a group is: "Group 4, 5 (RRP): DH, slider"."""
    numbers = _numbers(group.numbers)
    names = Joined([_body(found.mechanism, name) for name in group.bodies])
    if group.kind == "input":
        return Sentence("Input link {numbers}: {names}", numbers=numbers, names=names)
    if group.kind == "single":
        return Sentence("Link {numbers} alone: {names}", numbers=numbers, names=names)
    other = {"together": Sentence("solved together"), "triad": Sentence("triad, by an Assur point")}
    kind = other.get(group.kind) or GROUP_KINDS[group.kind]
    return Sentence("Group {numbers} ({kind}): {names}", numbers=numbers, kind=kind, names=names)


def _steps(found: ForcePolygons, group: GroupForces) -> Items:
    return Items(tuple(map(step_text, group.steps)), numbered=True)


def step_text(step: Step) -> Text:
    """A step as an equation with its terms, or as a sentence."""
    match step:
        case MomentsOfLink(link, about, unknown, terms):
            return Sentence(
                "moments of link {link} about {point}: {equation}",
                link=Number(link),
                point=_joint(about),
                equation=_guide_moment(step) if unknown is None else _moments(unknown, terms, step.outcome),
            )
        case MomentsOfGroup(links, about, unknown, terms, outcome):
            return Sentence(
                "moments of the group {links} about {point}: {equation}",
                links=_numbers(links),
                point=_joint(about),
                equation=_moments(unknown, terms, outcome),
            )
        case MomentsOfBase(link, unknown, moment, outcome):
            left = _sum(_unknown(unknown), [(_moment(abs(moment)), moment < 0)])
            return Sentence(
                "moments of base {link} about S, including the loads of the links at their hinges: {equation}",
                link=Number(link),
                equation=_equation(left, outcome),
            )
        case ClosedPolygon(links, forces, lines, last):
            closed = _is_zero(_names(forces))
            given = [*map(_line, lines), *(() if last is None else (_outcome(last),))]
            return Sentence(
                "polygon of {links}: {equation}", links=_numbers(links), equation=Joined((closed, *given))
            )
        case ForcesAlongGuide(link, guide, forces, outcome):
            return Sentence(
                "link {link} along guide {guide}: {equation}",
                link=Number(link),
                guide=Name(guide),
                equation=_equation(_names(forces), outcome) if forces else _outcome(outcome),
            )
        case AssurPoint(((one, first), (other, second))):
            return Sentence(
                "Assur point S of the lines of {one} through {first} and {other} through {second}",
                one=Name(one),
                first=_joint(first),
                other=Name(other),
                second=_joint(second),
            )
        case ClosedAlong((one, other)):
            return Sentence(
                "the polygon of the group closes along {one} and {other}", one=Name(one), other=Name(other)
            )
        case SolvedTogether(equations, links):
            return Sentence(
                "solved together: {equations} equations of equilibrium of {links}",
                equations=Number(equations),
                links=_numbers(links),
            )
        case JointReaction(joint, outcomes):
            return Joined((_joint(joint), Joined([_outcome(one) for one in outcomes])), ": ")
        case Assumption(joint, neglected):
            return _neglected_component(joint, neglected)
        case _:
            assert_never(step)


def _numbers(numbers: Iterable[int]) -> Text:
    return Joined(tuple(map(Number, numbers)))


def _names(forces: Iterable[str]) -> Text:
    """Forces one behind the other, as a sum of vectors."""
    return Joined(tuple(map(Name, forces)), " + ")


def _joint(joint: StaticJoint) -> Text:
    """Where a joint is: the point of a hinge, a guide, a contact."""
    name = Name(joint.name)
    match joint.kind:
        case "guide":
            return Sentence("guide {guide}", guide=name)
        case "mesh":
            return Sentence("the teeth of {gear}", gear=name)
        case "rolling":
            return Sentence("the contact of {wheel}", wheel=name)
        case _:
            return name


def _moments(unknown: MomentUnknown, terms: Sequence[MomentTerm], outcome: EquationOutcome) -> Text:
    """An equation of moments: "R34ᵗ·1.7 + 165.5 (G4) − 14.041 (MΦ4) = 0, R34ᵗ = -86.0431 N"."""
    known = [
        (Joined((_moment(abs(term.moment)), Name(f"({term.symbol})")), " "), term.moment < 0)
        for term in terms
    ]
    return _equation(_sum(_unknown(unknown), known), outcome)


def _sum(first: Text, terms: Iterable[tuple[Text, bool]]) -> Text:
    """A sum of terms, each with whether it is subtracted."""
    for term, subtracted in terms:
        first = Joined((first, term), " − " if subtracted else " + ")
    return first


def _unknown(unknown: MomentUnknown) -> Text:
    symbol = Name(unknown.symbol)
    if unknown.arm is None:
        return symbol
    arm: Text = Number(unknown.arm, "m", ".5g", unit_fixed=True, unit_hidden=True)
    return Joined((symbol, Joined((Name("("), arm, Name(")")), "") if unknown.arm < 0 else arm), "·")


def _moment(moment: float) -> Number:
    return Number(moment, "N m", ".5g", unit_hidden=True)


def _is_zero(left: Text) -> Text:
    return Joined((left, Number(0)), " = ")


def _equation(left: Text, outcome: EquationOutcome) -> Text:
    return Joined((_is_zero(left), _outcome(outcome)))


def _outcome(outcome: EquationOutcome) -> Text:
    symbol = f"|{outcome.symbol}|" if outcome.magnitude else outcome.symbol
    return Joined((Name(symbol), Number(outcome.value, outcome.unit)), " = ")


def _guide_moment(step: MomentsOfLink) -> Text:
    """The moment of a guide, and by how much its force passes beside the guide's point."""
    if step.beside is None:
        return _outcome(step.outcome)
    symbol, arm = step.beside
    beside = Sentence(
        "{symbol} acts at an offset of {arm}",
        symbol=Name(symbol),
        arm=Number(arm, "m", ".5g", unit_fixed=True),
    )
    return Joined((_outcome(step.outcome), beside))


def _line(line: ForceLine) -> Text:
    """A force of known direction: "R05 ⊥ guide H", "R34ⁿ ∥ DH"."""
    if line.guide:
        return Joined((Name(line.symbol), Sentence("⊥ guide {guide}", guide=Name(line.guide))), " ")
    short = all(joint.kind == "hinge" and len(joint.name) <= 2 for joint in line.through)
    between = Joined(tuple(map(_joint, line.through)), "" if short else " – ")
    return Joined((Name(line.symbol), between), " ∥ ")


def _neglected_component(joint: StaticJoint, neglected: Neglect) -> Text:
    name = Name(joint.name)
    match neglected:
        case Neglect.TOOTH_PRESSURE:
            return Sentence(
                "gear {name}: the radial component of the tooth force is neglected",
                name=name,
            )
        case Neglect.PITCH_POINT:
            return Sentence(
                "gear {name}: moments only, because its pitch point is not defined; the bearing reactions due to "
                "tooth forces are omitted",
                name=name,
            )
        case Neglect.NORMAL_FORCE:
            return Sentence(
                "wheel {name} is held on its track by other joints: equilibrium does not determine its normal "
                "force, which is set to zero here and in those joints",
                name=name,
            )
        case _:
            assert_never(neglected)


# Tables


def _forces(found: ForcePolygons, caption: Text = NOTHING) -> Table:
    """Every vector of the polygons: its size and direction, its length on paper, the scale."""
    rows = [row for group in found.groups for polygon in _drawn(group) for row in _vectors(found, polygon)]
    polygons, names, sizes, directions, lengths, scales = zip(*rows, strict=True) if rows else ((),) * 6
    return Table(
        (
            Column("polygon", tuple(polygons), head=Sentence("polygon")),
            Column("force", tuple(names), head=Sentence("force")),
            Column("magnitude", tuple(sizes), "N", Sentence("magnitude"), unit_fixed=True),
            Column("direction", tuple(directions), "deg", Sentence("direction"), unit_fixed=True),
            Column("length", tuple(lengths), "mm", Sentence("length"), unit_fixed=True),
            Column("scale", tuple(scales), "N/mm", Symbol("μ", "F", slanted=True), unit_fixed=True),
        ),
        caption,
    )


def _drawn(group: GroupForces) -> tuple[Polygon, ...]:
    """The polygon of a group; of one solved together those of its links."""
    return group.link_polygons if group.kind == "together" else (group.polygon,)


def _vectors(found: ForcePolygons, polygon: Polygon) -> Iterator[tuple[Text, ...]]:
    """Cells of the forces of a polygon; what is rounding of nothing has no direction."""
    title = Name(", ".join(str(found.names.index(body)) for body in polygon.bodies))
    vectors = (*polygon.vectors, *polygon.sums, *polygon.chords)
    greatest = max((abs(vector.force) for vector in vectors), default=0.0)
    for vector in vectors:
        none = abs(vector.force) <= NONE * greatest
        direction = math.nan if none else math.degrees(cmath.phase(vector.force)) + 0.0
        yield (
            title,
            Name(vector.name),
            Number(0.0 if none else abs(vector.force)),
            Number(direction, digits=".2f"),
            Number(polygon.length(vector), digits=".1f"),
            Number(polygon.scale),
        )


def _routes(found: ForcePolygons, caption: Text = NOTHING) -> Table:
    """The balancing moment or force of each drive by three routes."""
    levers = {lever.drive: lever.balancing for lever in found.levers}
    size = max((abs(force) for force in found.reactions.values()), default=0.0)
    rows = []
    for drive in found.mechanism.drives:
        routes = (found.balancing[drive.id], levers.get(drive.id), found.work.get(drive.id))
        known = [value for value in routes if value is not None]
        apart, none = max(known) - min(known), NONE * max(size, *map(abs, known))
        rows.append(
            (
                Name(drive.id),
                Unit(found.mechanism.motion_parameter.drive(drive.id).force_unit),
                *(_balancing(value, none) for value in routes),
                Number(apart, digits=".1e") if apart else Number(0),
            )
        )
    heads = (
        ("drive", Sentence("drive")),
        ("unit", Sentence("unit")),
        ("polygons", Sentence("force polygons")),
        ("lever", Sentence("Zhukovsky's lever")),
        ("work", Sentence("virtual work")),
        ("apart", Sentence("difference")),
    )
    columns = zip(*rows, strict=True)
    return Table(
        tuple(
            Column(name, cells, head=head, detail=name == "apart")
            for (name, head), cells in zip(heads, columns, strict=True)
        ),
        caption,
    )


def _balancing(value: float | None, none: float) -> Number:
    if value is None:
        return Number(math.nan)
    return Number(value if abs(value) > none else 0.0, digits=".9g")


def _file(found: ForcePolygons) -> Table:
    """Every vector in full: of groups ("group"), their inner reactions, and of links."""
    rows = [row for group in found.groups for row in _rows(group)]
    kinds, polygons, orders, vectors = zip(*rows, strict=True) if rows else ((),) * 4
    texts = {
        "polygon": kinds,
        "bodies": ["; ".join(polygon.bodies) for polygon in polygons],
        "name": [vector.name for vector in vectors],
        "on": [vector.body for vector in vectors],
        "source": [vector.source for vector in vectors],
        "label": [vector.label for vector in vectors],
    }
    columns = [Column(name, tuple(map(Name, cells))) for name, cells in texts.items()]
    columns.insert(2, Column("order", np.array(orders, dtype=np.int64), whole=True))
    forces = np.array([vector.force for vector in vectors], dtype=np.complex128)
    lengths = [polygon.length(vector) for polygon, vector in zip(polygons, vectors, strict=True)]
    columns += _components("force", forces, "N")
    columns.append(_in_si("force", np.array([abs(vector.force) for vector in vectors]), "N"))
    columns.append(_in_si("direction", np.array([cmath.phase(vector.force) for vector in vectors]), "rad"))
    columns.append(_in_si("length", np.array(lengths), "mm"))
    columns += _components("start", np.array([vector.start for vector in vectors], np.complex128), "N")
    columns += _components("end", np.array([vector.end for vector in vectors], np.complex128), "N")
    columns += _components("place", np.array([vector.place for vector in vectors], np.complex128), "m")
    return Table(tuple(columns))


def _components(name: str, values: NDArray[np.complex128], unit: str) -> list[Column]:
    return [_in_si(f"{name}_x", values.real, unit), _in_si(f"{name}_y", values.imag, unit)]


def _in_si(name: str, values: NDArray[np.float64], unit: str) -> Column:
    return Column(name, values, unit, unit_fixed=True)


def _rows(group: GroupForces) -> Iterator[tuple[str, Polygon, int, PolygonVector]]:
    """Kind of polygon, polygon, place in it, and vector."""
    polygon = group.polygon
    parts = [("group", polygon, polygon.vectors), ("sum", polygon, polygon.sums)]
    parts += [("inner", polygon, polygon.chords)]
    parts += [("link", one, one.vectors) for one in group.link_polygons]
    for kind, whole, vectors in parts:
        for order, vector in enumerate(vectors, start=1):
            yield kind, whole, order, vector


# Pages


def _pages(found: ForcePolygons) -> dict[str, GroupPage | LeverPage]:
    """Pages of an instant: "group-1" and on in the order in which groups were solved, "lever" of each drive."""
    pages: dict[str, GroupPage | LeverPage] = {
        f"group-{number}": group_page(found, group, _group_title(found, group), _steps(found, group).texts)
        for number, group in enumerate(found.groups, start=1)
    }
    for lever in found.levers:
        name = "lever" if len(found.levers) == 1 else f"lever-{lever.drive}"
        pages[name] = lever_page(found, lever, tuple(_lever_lines(lever)))
    return pages


def _lever_lines(lever: Lever) -> Iterator[Text]:
    """Moments about the pole, force by force, and what balances them."""
    greatest = max((abs(one.moment) for one in lever.forces), default=0.0)
    yield Sentence("moments about the pole, per unit rate of drive {drive}", drive=Name(lever.drive))
    yield NOTHING
    for one in lever.forces:
        if abs(one.moment) > NONE * greatest:
            yield Joined((Name(one.name), Number(one.moment, lever.unit)), ": ")
    yield NOTHING
    symbol = Name("Mb" if lever.unit == "N m" else "Fb")
    yield Joined((symbol, Number(lever.balancing + 0.0, lever.unit)), " = −Σ = ")


# Chapter


def _chapter(results: ForcePolygonResults) -> Chapter:
    """Force polygons of the instants."""
    text = Sentence(
        "Groups are treated in reverse order: each is isolated, moment equations give the tangential components "
        "of its outer reactions, the force polygon gives the rest. Drawings are to the scales stated."
    )
    real = any(one is not None and one.group is not None for one in results.polygons)
    sections = [Section(NOTHING, (Paragraph(text), *((Paragraph(REAL_MOTION),) if real else ())))]
    for sample, found in enumerate(results.polygons):
        title = instant_title(results.mechanism, results.motion, sample)
        blocks = _without_forces(results, sample) if found is None else _instant(found)
        sections.append(Section(title, tuple(blocks)))
        if found is not None:
            forces = _forces(found, Sentence("Forces of the polygons at {place}", place=title))
            sections.append(Section(NOTHING, (forces,), detail=True))
    return Chapter(Sentence("Force polygons"), tuple(sections))


def _without_forces(results: ForcePolygonResults, sample: int) -> Iterator[Block]:
    """Why an instant has no forces: the mechanism is open there, or at a dead point."""
    status = Status(int(results.motion["status"][sample]))
    if status in (Status.OK, Status.CUT_OFF):  # the motion goes through where forces have no limit
        status = Status.SINGULAR
    yield Paragraph(
        Sentence(
            "The mechanism is {status} there: no finite forces keep it in equilibrium.",
            status=Sentence(status.word),
        )
    )


def _instant(found: ForcePolygons) -> Iterator[Block]:
    """What is what, group by group with its drawing, the levers, all forces, the balancing moment, checks."""
    pages = _pages(found)
    yield FactTable(tuple(_facts(found)))
    for number, group in enumerate(found.groups, start=1):
        title = _group_title(found, group)
        yield Paragraph(Joined((title, NOTHING), "."))
        for step in group.steps:
            yield from step_equations(step, step_text(step))
        yield Illustration(pages[f"group-{number}"], title)
    for page in pages.values():
        if isinstance(page, LeverPage):
            caption = Sentence(
                "Zhukovsky's lever of drive {drive}: the velocity diagram turned by {angle} clockwise",
                drive=Name(page.drive),
                angle=RIGHT_ANGLE,
            )
            yield Illustration(page, caption)
    for lever in found.levers:
        greatest = max((abs(one.moment) for one in lever.forces), default=0.0)
        yield Paragraph(
            Sentence("Moments about the pole of Zhukovsky's lever of drive {drive}:", drive=Name(lever.drive))
        )
        yield lever_equation(lever, NONE * greatest)
    yield _routes(found, Sentence("Balancing moment or force by three routes"))
    yield from _checks(found)
    if found.group is not None:
        size, error = float(found.group.size[0]), float(found.group.error[0])
        bound = ROUNDINGS * float(np.finfo(float).eps) + error / size
        yield from drive_balance(*_driving_terms(found, found.group), size, bound)


def _checks(found: ForcePolygons) -> Iterator[Check]:
    """The polygons beside lever and virtual work."""
    levers = {lever.drive: lever.balancing for lever in found.levers}
    size = max((abs(force) for force in found.reactions.values()), default=0.0)
    for drive in found.mechanism.drives:
        own = found.balancing[drive.id]
        others = [value for value in (levers.get(drive.id), found.work.get(drive.id)) if value is not None]
        yield Check(
            Sentence(
                "Drive {drive}: polygons, lever and virtual work agree within {share}.", drive=Name(drive.id)
            ),
            max((abs(own - value) for value in others), default=0.0),
            max(size, abs(own)),
            ROUNDINGS * float(np.finfo(float).eps),
        )
