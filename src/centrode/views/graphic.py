"""Graph-analytic checks: what the terminal, the files, the pages and the document show."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.analysis.graphic.checks import GraphicCheck
from centrode.errors import CentrodeError, Status
from centrode.quantities import QUANTITIES
from centrode.sheets.pages import (
    CentreOfLink,
    DiagramStroke,
    InstantPage,
    InstantsPage,
    MovingPoint,
    VectorDiagramPage,
)
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Items,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import (
    NOTHING,
    Joined,
    Name,
    Number,
    Part,
    Place,
    Sentence,
    Symbol,
    Text,
    Unit,
    VectorNotation,
)
from centrode.views.instants import instant_title, place_number

if TYPE_CHECKING:
    from centrode.analysis.graphic.checks import CheckRow
    from centrode.analysis.graphic.diagrams import Diagram, Diagrams
    from centrode.analysis.graphic.results import GraphicResults
    from centrode.analysis.graphic.stage import ConstructionStep, DrawingBoard

Array: TypeAlias = NDArray[np.float64]
Page: TypeAlias = InstantPage | InstantsPage | VectorDiagramPage

NONE = 1e-14
"""What is smaller than this part of the greatest number of its kind is nothing: rounding of the drawing."""
INTEGRATED = 1e-10
"""The same of what is integrated, which is as exact as the tolerance of a step."""
ALIKE = 1e-15
"""Differences below this part of the greatest number are none."""
TOLERANCE = 1e-9
"""Part of the greatest number of its kind up to which a drawing that is read exactly agrees with the closed form."""
MOST_TOGETHER = 3
"""Instants in one drawing."""
MOST_DISTANCES = 3
"""Distances from an instant centre that are listed behind its place."""
HEADS = {1: Sentence("velocities"), 2: Sentence("accelerations")}
GROUPWISE = {1: Sentence("Velocities, group by group:"), 2: Sentence("Accelerations, group by group:")}
OF_IMAGES = ("relative", "sliding", "image")
"""Kinds of vectors that begin at the pole and end in an image: the image has an arrow of its own."""
TOGETHER = Sentence("Positions with instant centres, velocities and accelerations")
TITLES = {1: Sentence("Velocity diagram"), 2: Sentence("Acceleration diagram")}


def sheet(results: GraphicResults) -> Sheet:
    """For each instant scales and centres, what was done, the comparison of the routes, and three pages."""
    checks = [(k, check) for k, check in enumerate(results.checks) if isinstance(check, GraphicCheck)]
    several = len(results.checks) > 1
    pictures: dict[str, Page] = {}
    for k, check in checks:
        pictures |= {_numbered_name(name, k, several): page for name, page in _pages(check.diagrams).items()}
    drawn = tuple(check.diagrams for _k, check in checks)[:MOST_TOGETHER]
    if len(drawn) > 1:
        pictures["instants"] = _instants_page(drawn)
    return Sheet(
        tables={_numbered_name("check", k, several): _file(check) for k, check in checks},
        pictures=pictures,
        chapters={"graphic": _chapter(results)},
        printed=tuple(block for k, check in checks for block in _printed_instant(results, k, check)),
    )


def _numbered_name(name: str, number: int, several: bool) -> str:
    return f"{name}-{number + 1}" if several else name


def _printed_instant(results: GraphicResults, sample: int, check: GraphicCheck) -> Iterator[Block | Section]:
    """What a terminal prints of an instant."""
    parameter = results.mechanism.motion_parameter
    value = place_number(float(parameter.instants(results.motion)[sample]), parameter.instant.unit)
    yield Section(Sentence("at {value}", value=value), (FactTable(tuple(_facts(check.diagrams))),))
    for diagram in (check.diagrams.velocity, check.diagrams.acceleration):
        lines: list[Text] = []
        for step in diagram.steps:
            lines += [Name(step.group), *map(Part, _lines(step, diagram.order))]
        yield Section(HEADS[diagram.order], (Items(tuple(lines)),))
    yield _table(check)


# Scales, and instant centres


def _facts(found: Diagrams) -> Iterator[Fact]:
    """Scales, how finely was read, and the instant centres."""
    scales = (
        ("μ_l", "m", found.scale),
        ("μ_v", "m/s", found.velocity.scale),
        ("μ_a", "m/s^2", found.acceleration.scale),
    )
    yield Fact(Sentence("scales"), Joined([_scale(*one) for one in scales]))
    yield Fact(Sentence("read"), _reading(found.board))
    label: Text = Sentence("instant centres")
    none = NONE * max((abs(place) for place in found.places.values()), default=0.0)
    for link, centre in found.centres.items():
        yield Fact(label, _centre(found, link, centre, none))
        label = NOTHING


def _scale(symbol: str, unit: str, value: float) -> Text:
    shown = Joined((Number(value, unit, unit_hidden=True), Unit(unit, shown=True)), " ")
    return Sentence(
        "{symbol} = {scale} per {paper}", symbol=VectorNotation(symbol), scale=shown, paper=Unit("mm")
    )


def _reading(board: DrawingBoard) -> Text:
    texts = []
    if board.angle_step is not None:
        step = Number(math.degrees(board.angle_step), "deg", unit_fixed=True)
        texts.append(Sentence("directions to {step}", step=step))
    if board.paper_step is not None:
        step = Number(1e3 * board.paper_step, "mm", unit_fixed=True)
        texts.append(Sentence("lengths on paper to {step}", step=step))
    return Joined(texts) if texts else Sentence("exactly")


def _centre(found: Diagrams, link: str, centre: complex | None, none: float) -> Text:
    """Place of an instant centre, and how far from it points of the link are."""
    if centre is None:
        return Sentence("{link}: at infinity, it translates", link=Name(link))
    place = Place((_rounded_number(centre.real, none), _rounded_number(centre.imag, none)), "m", ".6g")
    points = list(found.mechanism.links[link].coordinates)[:MOST_DISTANCES]
    distances = _distances(found, link, points, ".6g", none)
    return Joined((Name(link), Joined((place, *distances))), ": ")


def _distances(
    found: Diagrams, link: str, points: list[str], digits: str, none: float = 0.0
) -> Iterator[Text]:
    """Distances from an instant centre to points of the link; the last has the unit of all."""
    for point in points:
        distance = _rounded_number(found.reach(link, point), none)
        number = Number(distance, "m", digits, unit_hidden=point != points[-1])
        yield Joined((Name(f"P{point}"), number), " = ")


def _rounded_number(value: float, none: float) -> float:
    """A number; what is not greater than `none`, as nothing."""
    return value if abs(value) > none else 0.0


# What was done: vector equations, false positions, triangles


def _lines(step: ConstructionStep, order: int) -> list[Text]:
    return [*map(VectorNotation, step.equations), *_trial_lines(step, order), *_sine_lines(step)]


def _sine_lines(step: ConstructionStep) -> list[VectorNotation]:
    """The law of sines with its numbers, as a person writes it: all sides, then each ratio."""
    if step.triangle is None:
        return []
    names = [_literal(name) for name in step.triangle.names]
    sides, angles = step.triangle.sides, step.triangle.angles
    numbers = {f"angle_{k}": Number(math.degrees(angle), "deg", ".5g") for k, angle in enumerate(angles)}
    sines = [math.sin(angle) for angle in angles]
    shown = [f"sin {{angle_{k}}}°" for k in range(3)]
    lines = [VectorNotation(" : ".join(f"|{name}|" for name in names) + f" = {' : '.join(shown)}", **numbers)]

    def ratio(left: str, above: int, below: int, share: float) -> VectorNotation:
        parts = {"above": sines[above], "below": sines[below], "share": share}
        values = numbers | {name: Number(value, digits=".4f") for name, value in parts.items()}
        sine = f"{shown[above]}/{shown[below]}"
        return VectorNotation(f"{left} = {sine} = {{above}}/{{below}} = {{share}}", **values)

    lines += [ratio(f"|{names[k]}|/|{names[0]}|", k, 0, sides[k] / sides[0]) for k in (1, 2)]
    known = names[0].removeprefix("v_")
    for k in (1, 2):
        arm = names[k].removeprefix("v_")
        if arm != names[k] and arm.endswith(known) and arm != known:
            # the link's triangle with its instant centre has the same angles: its sides are square to the velocities
            lines.append(ratio(f"P{known}/{arm}", 0, k, sides[0] / sides[k]))
    return lines


def _literal(name: str) -> str:
    """A name within a notation that has holes."""
    return name.replace("{", "{{").replace("}", "}}")


def _trial_lines(step: ConstructionStep, order: int) -> list[Text]:
    """The false position: what was tried, what was amiss, what fits."""
    if step.trial is None:
        return []
    trial, letter = step.trial, "ω" if order == 1 else "ε"
    turned = [VectorNotation(f"{letter}_{link}") for link in trial.links]
    none = NONE * max(abs(x) for values in (*trial.values, trial.found) for x in values)
    apart = NONE * max(abs(x) for misfits in trial.misfits for x in misfits)

    def rates(values: tuple[float, ...]) -> Text:
        numbers = [Number(_rounded_number(value, none)) for value in values]
        return Joined([Joined(pair, " = ") for pair in zip(turned, numbers, strict=True)])

    checked = Joined([Name(name) for name in trial.checked])
    lines: list[Text] = [
        Sentence("false position: {links} tried, {cut} checked", links=Joined(turned), cut=checked)
    ]
    for values, misfits in zip(trial.values, trial.misfits, strict=True):
        amiss = Joined([Number(_rounded_number(x, apart)) for x in misfits])
        lines.append(Sentence("{tried}: residual {amiss}", tried=rates(values), amiss=amiss))
    return [*lines, Sentence("hence {found}", found=rates(trial.found))]


# Pages


def _pages(found: Diagrams) -> dict[str, Page]:
    """The mechanism at the instant, and both diagrams."""
    diagrams = {"velocity": found.velocity, "acceleration": found.acceleration}
    pages: dict[str, Page] = {"mechanism": _instant_page(found)}
    return pages | {name: _diagram_page(found, diagram) for name, diagram in diagrams.items()}


def _instant_page(found: Diagrams) -> InstantPage:
    """Places, velocities and centres; links that translate have no centre and no sense."""
    centres = {link: place for link, place in found.centres.items() if place is not None}
    links = found.mechanism.links
    return InstantPage(
        Sentence("Instant centres and velocities"),
        found.mechanism,
        found.exact,
        found.course,
        found.scale,
        found.velocity.scale,
        tuple(
            MovingPoint(point, found.places[point], found.velocity.images[point])
            for point in found.mechanism.moving_points
        ),
        tuple(
            CentreOfLink(link, place, tuple(found.places[point] for point in links[link].coordinates))
            for link, place in centres.items()
        ),
        {link: turn > 0 for link, turn in found.velocity.turns.items() if link in centres},
        tuple(_turning(found)),
    )


def _instants_page(several: Sequence[Diagrams]) -> InstantsPage:
    """The mechanism at several instants with centres, velocities and accelerations; ranges of links in the column."""
    lines: list[Text] = []
    for found in several:
        lines += [instant_title(found.mechanism, found.exact, 0), *_turning(found), NOTHING]
    return InstantsPage(
        TOGETHER,
        several[0].mechanism,
        tuple(_instant_page(found) for found in several),
        tuple(
            tuple(
                MovingPoint(point, found.places[point], found.acceleration.images[point])
                for point in found.mechanism.moving_points
            )
            for found in several
        ),
        tuple(lines[:-1]),
    )


def _diagram_page(found: Diagrams, diagram: Diagram) -> VectorDiagramPage:
    """The vectors of a diagram; those from the pole to an image are drawn as the image's own."""
    ends = [0j, *diagram.images.values(), *diagram.hidden.values()]
    ends += [end for edge in diagram.edges for end in (edge.start, edge.end)]
    shown = [*found.mechanism.frame.points, *found.mechanism.moving_points]
    images = {name: diagram.images[name] for name in shown if name in diagram.images} | dict(diagram.hidden)
    return VectorDiagramPage(
        TITLES[diagram.order],
        found.mechanism,
        found.exact,
        diagram.order,
        diagram.unit,
        diagram.scale,
        (
            complex(min(end.real for end in ends), min(end.imag for end in ends)),
            complex(max(end.real for end in ends), max(end.imag for end in ends)),
        ),
        tuple(
            DiagramStroke(edge.start, edge.end, edge.kind, edge.name, edge.link)
            for edge in diagram.edges
            if edge.start != 0 or edge.kind not in OF_IMAGES
        ),
        tuple((name.lower(), image) for name, image in images.items()),
        tuple(_done(diagram)),
    )


def _done(diagram: Diagram) -> list[Text]:
    """What was done: vector equations, trials, and triangles with their sines."""
    found: list[Text] = []
    for step in diagram.steps:
        found += [*map(VectorNotation, step.equations), *_trial_lines(step, diagram.order)]
    triangles = [line for step in diagram.steps for line in _sine_lines(step)[:1]]
    return [*found, NOTHING, *triangles] if triangles else found


def _turning(found: Diagrams) -> Iterator[Text]:
    """Angular velocities, each with the distances of points from the instant centre."""
    for link, turn in found.velocity.turns.items():
        centre = found.centres.get(link)
        rate = Number(0.0 if centre is None else turn, "rad/s", ".5g")
        yield Joined((VectorNotation(f"ω_{link}"), rate), " = ")
        if centre is not None:
            points = list(found.mechanism.links[link].coordinates)[:2]
            yield Part(Part(Joined(tuple(_distances(found, link, points, ".5g")))))
        elif link in found.centres:
            yield Part(Part(Sentence("it translates: P at infinity")))


# The comparison of the routes


def _file(check: GraphicCheck) -> Table:
    """Every number by every route, in SI and in full."""
    rows = check.rows
    integrated = [math.nan if row.integrated is None else row.integrated for row in rows]
    return Table(
        (
            Column("quantity", tuple(Name(row.quantity) for row in rows)),
            Column("name", tuple(Name(row.name) for row in rows)),
            Column("unit", tuple(Name(row.unit) for row in rows)),
            Column("drawing", np.array([row.graphic for row in rows], dtype=float)),
            Column("integrated", np.array(integrated)),
            Column("closed_form", np.array([row.closed for row in rows])),
            Column("difference", np.array([row.difference for row in rows], dtype=float)),
        )
    )


def _table(check: GraphicCheck, caption: Text = NOTHING) -> Table:
    """The table of a check: by the drawing, by integration, by the closed form."""
    rows, greatest = check.rows, _greatest(check)
    units = tuple(row.unit for row in rows)

    def column(head: Sentence, values: list[float]) -> Column:
        return Column(head.message, np.array(values, dtype=float), head=head, units=units)

    # of a mechanism at rest the integrated rates are rounding of its lengths and turns
    integrated = [
        math.nan
        if row.integrated is None
        else _rounded_number(row.integrated, INTEGRATED * (greatest[row.quantity] or 1.0))
        for row in rows
    ]
    return Table(
        (
            Column("quantity", tuple(map(_symbol, rows)), head=Sentence("quantity")),
            Column("unit", tuple(Unit(unit, shown=True) for unit in units), head=Sentence("unit")),
            column(
                Sentence("drawn"),
                [_rounded_number(row.graphic, NONE * greatest[row.quantity]) for row in rows],
            ),
            column(Sentence("integrated"), integrated),
            column(
                Sentence("closed form"),
                [_rounded_number(row.closed, NONE * greatest[row.quantity]) for row in rows],
            ),
            Column(
                "difference",
                tuple(_difference(row, greatest[row.quantity]) for row in rows),
                head=Sentence("difference"),
            ),
        ),
        caption,
    )


def _greatest(check: GraphicCheck) -> dict[str, float]:
    """Of every kind of quantity the greatest number at the instant."""
    greatest: dict[str, float] = {}
    for row in check.rows:
        greatest[row.quantity] = max(greatest.get(row.quantity, 0.0), abs(row.closed), abs(row.graphic))
    return greatest


def _symbol(row: CheckRow) -> Text:
    """The symbol of a number: of vectors their length, between bars."""
    symbol = Symbol(QUANTITIES[row.quantity].symbol, row.name)
    return symbol if row.quantity.startswith("angular") else Joined((Name("|"), symbol, Name("|")), "")


def _difference(row: CheckRow, greatest: float) -> Number:
    difference = _rounded_number(row.difference, ALIKE * greatest)
    return Number(difference, row.unit, ".1e" if difference else ".1g", unit_hidden=True)


# The chapter

COMPARISON = Sentence("Comparison of the routes: by drawing, by integration of the equations, in closed form")


def _chapter(results: GraphicResults) -> Chapter:
    """For each instant the drawing, what was done, and the comparison of three routes."""
    sections: list[Section] = []
    for sample, check in enumerate(results.checks):
        title = instant_title(results.mechanism, results.motion, sample)
        sections.append(Section(title, tuple(_instant(results, sample, check))))
        if isinstance(check, GraphicCheck):
            read_exactly = check.diagrams.board.angle_step is None
            sections.append(Section(NOTHING, (_table(check, COMPARISON),), detail=read_exactly))
    if sum(isinstance(check, GraphicCheck) for check in results.checks) > 1:
        sections.append(Section(Sentence("The instants in one drawing"), (Illustration("instants"),)))
    return Chapter(Sentence("Graph-analytic check"), tuple(sections))


def _instant(
    results: GraphicResults, sample: int, check: GraphicCheck | CentrodeError | None
) -> Iterator[Block]:
    if check is None:
        yield Paragraph(
            Sentence(
                "At {place} the sample is {status}: the velocities are not defined.",
                place=instant_title(results.mechanism, results.motion, sample),
                status=Sentence(Status(int(results.motion["status"][sample])).word),
            )
        )
        return
    if isinstance(check, CentrodeError):
        yield Paragraph(Sentence("It cannot be drawn: {reason}", reason=Name(str(check))))
        return
    pages = _pages(check.diagrams)
    yield FactTable(tuple(_facts(check.diagrams)), Sentence("Scales and instant centres"))
    yield Illustration(pages["mechanism"], Sentence("Instant centres, velocities, senses of rotation"))
    for diagram, name in (
        (check.diagrams.velocity, "velocity"),
        (check.diagrams.acceleration, "acceleration"),
    ):
        yield from _steps(diagram)
        yield Illustration(pages[name])
    yield _agreement(check) if check.diagrams.board.angle_step is None else _reading_errors(check)


def _steps(diagram: Diagram) -> Iterator[Block]:
    """Vector equations, false positions and the law of sines, group by group."""
    yield Paragraph(GROUPWISE[diagram.order])
    for step in diagram.steps:
        yield Paragraph(Joined((Name(step.group), NOTHING), ":"))
        yield _formula([VectorNotation(equation) for equation in step.equations])
        for line in _trial_lines(step, diagram.order):
            yield Paragraph(line)
        sines = _sine_lines(step)
        if sines:
            yield _formula(sines)


def _formula(relations: list[VectorNotation]) -> Formula:
    """Relations below each other, taken apart at their signs of equality."""
    return Formula(
        tuple(
            tuple(VectorNotation(part, **relation.values) for part in relation.notation.split(" = "))
            for relation in relations
        )
    )


def _worst_share(check: GraphicCheck) -> float:
    """The greatest difference of the drawing from the closed forms, over the greatest number of its kind."""
    sizes = _sizes(check)
    return max((abs(row.difference) / sizes[row.quantity] for row in check.rows), default=0.0)


def _reading_errors(check: GraphicCheck) -> Paragraph:
    """How far a drawing whose directions are read to a step is from the closed forms."""
    return Paragraph(
        Sentence(
            "The drawing is read by hand ({reading}); it differs from the closed forms by at most {share} of the"
            " greatest number of its kind in the motion.",
            reading=_reading(check.diagrams.board),
            share=Number(_worst_share(check), digits=".1%"),
        )
    )


def _agreement(check: GraphicCheck) -> Check:
    """The same of a drawing that is read exactly, which only rounding may make differ."""
    worst = _worst_share(check)
    statement = Sentence(
        "The drawing, read exactly, agrees with the closed forms: the greatest difference is {share} of the"
        " greatest number of its kind in the motion, {allowed} is allowed.",
        allowed=Number(TOLERANCE, digits=".1e"),
    )
    return Check(statement, worst, 1.0, TOLERANCE)


def _sizes(check: GraphicCheck) -> Mapping[str, float]:
    """The greatest number of each kind in the motion; of accelerations also that of their normal parts."""
    course = check.diagrams.course
    kinds = ("angular_velocity", "velocity", "angular_acceleration", "acceleration")
    greatest = {kind: float(np.nanmax(np.abs(course[kind].values), initial=0.0)) for kind in kinds}
    spin = greatest["angular_velocity"]
    greatest["angular_acceleration"] = max(greatest["angular_acceleration"], spin**2)
    greatest["acceleration"] = max(greatest["acceleration"], spin * greatest["velocity"])
    return {kind: size or 1.0 for kind, size in greatest.items()}
