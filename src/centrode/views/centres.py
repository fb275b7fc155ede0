"""Instant centres of velocity: what the terminal, the files, the drawing and the document show; on the sphere axes."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from centrode.analysis.instant_centres.bodies import body_names
from centrode.analysis.instant_centres.centres import Case, line_direction, order_pair
from centrode.errors import Status
from centrode.model.reading import FRAME
from centrode.sheets.scenes import (
    ChordKind,
    CircleDiagram,
    LineKind,
    Linkage,
    Mark,
    MarkKind,
    Scene,
    SceneNote,
    StraightLine,
)
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Check,
    Column,
    Illustration,
    Listing,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import (
    NOTHING,
    Counted,
    Expression,
    Indexed,
    Joined,
    Name,
    Number,
    Place,
    Sentence,
    Text,
    Title,
)
from centrode.views.columns import instant_columns, without_rounding
from centrode.views.instants import body_text, instant_place, instant_title, pair_text

if TYPE_CHECKING:
    import xarray as xr

    from centrode.analysis.instant_centres.bodies import Pair
    from centrode.analysis.instant_centres.kennedy import CentreConstruction, KennedyStep
    from centrode.analysis.instant_centres.results import CentreResults

MOST_ROWS = 60
"""Centres of one instant in a document; of more those against the frame."""
MOST_MARKED = 6
"""Bodies of which all centres are drawn; of more those against the frame."""
PRIMARY = ("hinge", "guide", "rolling")
ALLOWED = float(np.finfo(float).eps) * (1 << 20)
"""Rounding times what lines that meet at an angle of 0.06 deg lose."""
ABSENT, INFINITE, DEGREES = Number(math.nan), Name("∞ "), Name("°")


def sheet(results: CentreResults) -> Sheet:
    """Everything there is to say about the instant centres at some instants."""
    return Sheet(
        tables={"centres": _file(results)},
        datasets={"centres": results.centres},
        pictures=dict(_pictures(results)),
        chapters={"centres": _chapter(results)}
        if results.mechanism.space == "plane"
        else _axes_chapter(results),
        printed=tuple(_printed_parts(results)),
    )


def place_text(place: np.ndarray, unit: str = "m") -> Text:
    """Coordinates of a place; a dash where there is none."""
    if not np.isfinite(place).all():
        return ABSENT
    return Place(tuple(without_rounding(place).tolist()), unit, ".9g")


# Tables


def _printed_parts(results: CentreResults) -> Iterator[Section]:
    """The bodies by number, and the centres of each instant; of named pairs also what they were found from."""
    bodies = tuple(_bodies_by_number(results))
    yield Section(NOTHING, (Listing(Sentence("bodies"), bodies),))
    for sample, construction in enumerate(results.constructions):
        blocks: list[Block] = [_table(results, results.centres.isel(sample=sample), construction)]
        if results.pairs is not None and construction is not None:
            steps = tuple(_steps_leading_to(construction, results.pairs))
            blocks += [Listing(Sentence("through"), steps)] if steps else []
        yield Section(instant_place(results.mechanism, results.motion, sample), tuple(blocks))


def _bodies_by_number(results: CentreResults) -> Iterator[Text]:
    for number, name in enumerate(body_names(results.mechanism)):
        yield Joined((Number(number), body_text(results.mechanism, name)), " ")


def _table(results: CentreResults, centres: xr.Dataset, construction: CentreConstruction | None) -> Table:
    """The centres of one instant: symbol, bodies, place, case, how each is constructed, and by how much both differ.

    On the sphere the place is the end of the axis, and the relative angular velocity about it stands behind it.
    """
    mechanism, names = results.mechanism, body_names(results.mechanism)
    labels = [tuple(str(label).split(",")) for label in centres["pair"].values]
    pairs = [(names.index(first), names.index(second)) for first, second in labels]
    steps = [_step(construction, pair) for pair in pairs]
    bodies = tuple(pair_text(mechanism, first, second) for first, second in labels)
    spherical = mechanism.space == "sphere"
    places = tuple(_place(centres.isel(pair=number)) for number in range(len(pairs)))
    speeds = tuple(map(_speed, _speeds(centres))) if spherical else ()
    cases = tuple(Sentence(Case(int(number)).word) for number in centres["centre_case"].values)
    ways = tuple(NOTHING if step is None else step_text(step, len(names)) for step in steps)
    off = tuple(
        NOTHING
        if step is None or construction is None
        else Number(construction.mismatch[step.pair], digits=".1e")
        for step in steps
    )
    symbols = tuple(centre_symbol(pair, len(names)) for pair in pairs)
    beside = [Column("relative speed", speeds, head=Sentence("relative speed"))] if spherical else []
    return Table(
        (
            Column("centre", symbols, head=Sentence("axis") if spherical else Sentence("centre")),
            Column("bodies", bodies, head=Sentence("bodies")),
            Column("place", places, head=Sentence("end of the axis") if spherical else Sentence("place")),
            *beside,
            Column("case", cases, head=Sentence("case")),
            Column("constructed from", ways, head=Sentence("constructed from")),
            Column("off", off, head=Sentence("deviation"), detail=True),
        )
    )


def centre_symbol(pair: Pair, bodies: int) -> Indexed:
    """How a centre is called: P20 is that of bodies 2 and 0; with many bodies P12,0."""
    return Indexed("P", f"{pair[0]}{',' if bodies > 10 else ''}{pair[1]}")


def _step(construction: CentreConstruction | None, pair: Pair) -> KennedyStep | None:
    steps = () if construction is None else construction.steps
    return next((step for step in steps if step.pair == order_pair(pair)), None)


def _place(centre: xr.Dataset) -> Text:
    """Coordinates of a centre, or the direction in which it lies at infinity; a dash where there is none."""
    if "centre_direction" not in centre:
        return place_text(centre["centre"].values, "1")
    direction = centre["centre_direction"].values
    if np.isfinite(direction).all():
        return Sentence("at infinity, {angle}", angle=Number(line_direction(direction.tolist()), "deg"))
    return place_text(centre["centre"].values)


def _speeds(centres: xr.Dataset) -> list[float]:
    """Relative angular velocities; what rounding has left of zero is zero."""
    speeds = centres["relative_speed"].values
    greatest = np.nanmax(np.abs(speeds), initial=0.0)
    return np.where(np.abs(speeds) < 1e-12 * greatest, 0.0, speeds).tolist()  # type: ignore[no-any-return]


def _speed(speed: float) -> Text:
    return ABSENT if math.isnan(speed) else Number(speed, "rad/s", ".9g")


def step_text(step: KennedyStep, bodies: int, between: str = " ", *, named: bool = True) -> Text:
    """How a centre was constructed, in symbols where there are some; `named` after the joint that shows it."""

    def symbol(one: int, by: int) -> Text:
        return centre_symbol(order_pair((one, by)), bodies)

    first, second = step.pair
    if step.how == "kennedy":
        return Joined([Joined((symbol(first, by), symbol(second, by)), between) for by in step.by], " × ")
    if step.how == "together":
        return Joined((symbol(first, step.by[0]), symbol(second, step.by[0])), " = ")
    name, at_infinity = Name(step.name), step.place is None
    if named:
        joints = {
            "hinge": Sentence("hinge {name}", name=name),
            "guide": Sentence("perpendicular to guide {name}", name=name)
            if at_infinity
            else Sentence("pole of guide {name}", name=name),
            "rolling": Sentence("contact of {name}", name=name),
            "gear": Sentence("gear {name}", name=name),
        }
    else:
        joints = {
            "hinge": Sentence("hinge"),
            "guide": Sentence("perpendicular to the guide") if at_infinity else Sentence("pole of the guide"),
            "rolling": Sentence("contact"),
            "gear": Sentence("gear"),
        }
    rest, field = Sentence("no relative motion"), Sentence("velocity field")
    return {**joints, "rest": rest, "field": field}[step.how]


def _steps_leading_to(construction: CentreConstruction, pairs: Sequence[tuple[str, str]]) -> Iterator[Text]:
    """The steps that some centres were found from, themselves left out: "P10 hinge O"."""
    wanted = _numbers(construction, pairs)
    for step in construction.needed_steps(wanted).steps:
        if step.pair not in wanted:
            bodies = len(construction.bodies)
            yield Joined((centre_symbol(step.pair, bodies), step_text(step, bodies)), " ")


def _numbers(construction: CentreConstruction, pairs: Sequence[tuple[str, str]]) -> list[Pair]:
    """Pairs by the numbers of their bodies, the later body first."""
    names = construction.bodies
    return [order_pair((names.index(first), names.index(second))) for first, second in pairs]


def _file(results: CentreResults) -> Table:
    """One row a position and pair: places, directions at infinity (on the sphere relative speeds), constructions."""
    centres, spherical = results.centres, results.mechanism.space == "sphere"
    labels = [str(label).split(",") for label in centres["pair"].values]
    count, samples = len(labels), centres.sizes["sample"]
    axes = "xyz" if spherical else "xy"
    flat = centres["centre"].values.reshape(-1, len(axes))
    places = [
        Column(f"centre_{axis}", flat[:, number], "1" if spherical else "m")
        for number, axis in enumerate(axes)
    ]
    if spherical:
        beside = [Column("relative_speed", centres["relative_speed"].values.ravel(), "rad/s")]
    else:
        directions = centres["centre_direction"].values.reshape(-1, 2)
        beside = [
            Column(f"centre_direction_{axis}", directions[:, number]) for number, axis in enumerate("xy")
        ]
    how, mismatch = zip(*_constructions(results, labels), strict=True)
    return Table(
        (
            *instant_columns(results.motion, np.repeat(np.arange(samples), count)),
            *(
                Column(head, tuple(Name(label[end]) for label in labels) * samples)
                for end, head in enumerate(("first", "second"))
            ),
            *places,
            *beside,
            Column(
                "case",
                tuple(Name(Case(int(case)).word) for case in centres["centre_case"].values.ravel()),
            ),
            Column("constructed", tuple(map(Name, how))),
            Column("mismatch", np.array(mismatch)),
        )
    )


def _constructions(results: CentreResults, labels: Sequence[Sequence[str]]) -> Iterator[tuple[str, float]]:
    """How each centre was constructed, and the relative velocity left there over the greatest of the motion."""
    names = body_names(results.mechanism)
    for construction in results.constructions:
        steps = {} if construction is None else {step.pair: step for step in construction.steps}
        for first, second in labels:
            step = steps.get(order_pair((names.index(first), names.index(second))))
            known = construction is not None and step is not None
            yield (step.how, construction.mismatch[step.pair]) if known else ("", math.nan)  # type: ignore[union-attr]


# Drawings


def _pictures(results: CentreResults) -> Iterator[tuple[str, Scene]]:
    """One drawing for each instant that has a construction; numbered where there are several instants."""
    for sample, construction in enumerate(results.constructions):
        if construction is not None:
            name = "centres" if len(results.constructions) == 1 else f"centres-{sample + 1}"
            yield name, _scene(results, results.motion, sample, construction, results.pairs)


def _scene(
    results: CentreResults,
    motion: xr.Dataset,
    sample: int,
    construction: CentreConstruction,
    pairs: Sequence[tuple[str, str]] | None,
) -> Scene:
    """A position with its centres, the lines that they were found on, and the circle diagram."""
    mechanism = results.mechanism
    shown = _shown(construction, pairs)
    needed, count = construction.needed_steps(shown), len(construction.bodies)
    marks = {
        step.pair: Mark(
            np.array(step.place),
            MarkKind.CENTRE,
            centre_symbol(step.pair, count),
            either_end=step.how not in ("hinge", "guide"),
        )
        for step in needed.steps
        if step.place is not None
    }
    lines = _great_circles if mechanism.space == "sphere" else _lines
    found = [step for step in needed.steps if step.how == "kennedy" and step.pair in shown]
    chords = {True: ChordKind.PRIMARY, False: ChordKind.CONSTRUCTED}
    return Scene(
        Sentence("Instantaneous axes") if mechanism.space == "sphere" else Sentence("Instant centres"),
        Title(mechanism.title),
        Linkage(mechanism, motion, sample),
        marks=tuple(mark for pair, mark in marks.items() if pair in shown),
        lines=tuple(line for step in found for line in lines(step, needed, marks)),
        diagram=CircleDiagram(
            tuple((name, body_text(mechanism, name)) for name in construction.bodies),
            tuple(
                (step.pair, ChordKind.FIELD if step.how == "field" else chords[step.how in PRIMARY])
                for step in needed.steps
            ),
        ),
        notes=tuple(
            _note(step, count, marks.get(step.pair))
            for step in needed.steps
            if step.how not in PRIMARY or step.pair in shown
        ),
    )


def _shown(construction: CentreConstruction, pairs: Sequence[tuple[str, str]] | None) -> list[Pair]:
    if pairs is not None:
        return _numbers(construction, pairs)
    everything = [step.pair for step in construction.steps]
    return (
        everything
        if len(construction.bodies) <= MOST_MARKED
        else [pair for pair in everything if pair[1] == 0]
    )


def _lines(step: KennedyStep, needed: CentreConstruction, marks: dict[Pair, Mark]) -> Iterator[StraightLine]:
    """The lines of Kennedy's theorem through a centre, each by the centres on it; one may lie at infinity."""
    directions = {step.pair: np.array(step.direction) for step in needed.steps if step.direction}
    for by in step.by:
        legs = [step.pair, *(order_pair((one, by)) for one in step.pair)]
        places = tuple(marks[leg] for leg in legs if leg in marks)
        ways = [directions[leg] for leg in legs if leg in directions]
        if places and (ways or len(places) > 1):
            yield StraightLine(places, LineKind.CONSTRUCTION, ways[0] if ways else None)


def _great_circles(
    step: KennedyStep, _needed: CentreConstruction, marks: dict[Pair, Mark]
) -> Iterator[StraightLine]:
    """The great circles that an axis was found on, each through two known axes."""
    for by in step.by:
        legs = [order_pair((one, by)) for one in step.pair]
        if all(leg in marks for leg in legs):
            yield StraightLine(tuple(marks[leg] for leg in legs), LineKind.CONSTRUCTION)


def _note(step: KennedyStep, bodies: int, mark: Mark | None) -> SceneNote:
    """How a centre was found, and the direction of one at infinity; of a joint only where the picture lacks it."""
    text: Text = Joined((centre_symbol(step.pair, bodies), step_text(step, bodies, "", named=False)), ": ")
    if step.direction is not None:
        towards = Joined((INFINITE, Number(line_direction(step.direction), digits=".4g"), DEGREES), "")
        text = Joined((text, towards))
    return SceneNote(text, mark, always=step.how not in PRIMARY or mark is None)


# Chapters


def _chapter(results: CentreResults) -> Chapter:
    """For each instant the table of centres with their constructions, and the drawing."""
    first = Paragraph(Sentence("Bodies: {names}.", names=Joined(tuple(_bodies_by_number(results)))))
    instants = (
        Section(instant_title(results.mechanism, results.motion, sample), tuple(_instant(results, sample)))
        for sample in range(len(results.constructions))
    )
    return Chapter(Sentence("Instant centres of velocity"), (Section(NOTHING, (first,)), *instants))


def _instant(results: CentreResults, sample: int) -> Iterator[Block]:
    mechanism, here = results.mechanism, results.motion.isel(sample=[sample])
    status = Status(int(here["status"][0]))
    if status != Status.OK:
        yield Paragraph(
            Sentence(
                "At {place} the sample is {status}: the velocities are not defined.",
                place=instant_title(mechanism, here, 0),
                status=Sentence(status.word),
            )
        )
        return
    names = body_names(mechanism)
    pairs = len(names) * (len(names) - 1) // 2
    centres, construction = results.centres.isel(sample=sample), results.constructions[sample]
    few = pairs > MOST_ROWS and results.pairs is None
    if few:
        centres = centres.sel(pair=[f"{name},{FRAME}" for name in names[1:]])
    table = _table(results, centres, construction)
    bodies = tuple(
        Joined([body_text(mechanism, name) for name in str(label).split(",")], " – ")
        for label in centres["pair"].values
    )
    symbol, both, *others = table.columns
    yield Table((symbol, Column(both.name, bodies, head=both.head), *others), Sentence("Instant centres"))
    if few:
        yield Paragraph(
            Counted(
                "The mechanism has {n} centre; those relative to the frame are listed.",
                "The mechanism has {n} centres; those relative to the frame are listed.",
                pairs,
            )
        )
    if construction is not None:
        yield Check(
            Sentence(
                "The centres were constructed from positions alone. With the velocities of the motion, the "
                "relative velocity at each centre is at most {share} of the greatest velocity; {allowed} is "
                "allowed.",
                allowed=Number(ALLOWED, digits=".1e"),
            ),
            max(construction.mismatch.values(), default=0.0),
            1.0,
            ALLOWED,
        )
        drawing = _scene(results, here, 0, construction, None)
        yield Illustration(drawing, Sentence("Instant centres and how they were found"))


def _axes_chapter(results: CentreResults) -> dict[str, Chapter]:
    """Instantaneous axes of the links against the frame at the instants; no chapter where none of them is reached."""
    statuses = results.motion["status"].values
    reached = [sample for sample, status in enumerate(statuses) if status == Status.OK]
    if not reached:
        return {}
    text = Sentence(
        "At every instant a link turns relative to the frame about an axis through the centre; the end given is "
        "the one about which the link turns counter-clockwise as the drive's value increases."
    )
    instants = (
        Section(instant_title(results.mechanism, results.motion, sample), (_axes(results, sample),))
        for sample in reached
    )
    return {
        "axes": Chapter(Sentence("Instantaneous axes"), (Section(NOTHING, (Paragraph(text),)), *instants))
    }


def _axes(results: CentreResults, sample: int) -> Table:
    given = set(results.centres["pair"].values.tolist())
    links = results.mechanism.links.items()
    names = [name for name, link in links if len(link.coordinates) > 1 and f"{name},{FRAME}" in given]
    found = results.centres.isel(sample=sample).sel(pair=[f"{name},{FRAME}" for name in names])
    ends, speeds = without_rounding(found["centre"].values), np.abs(found["relative_speed"].values)
    return Table(
        (
            Column("link", tuple(map(Name, names)), head=Sentence("link")),
            *(Column(axis, ends[:, k], head=Expression(axis)) for k, axis in enumerate("xyz")),
            Column("angular velocity", speeds, "rad/s", Sentence("angular velocity")),
        )
    )
