"""Variants of a topology: the table of a terminal and of a file, and the sheet of answers for the teacher."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import degrees, nan
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from centrode.model.files import kind_at
from centrode.model.units import KINDS
from centrode.sheets.sheet import (
    Block,
    Chapter,
    Column,
    Deferred,
    Failure,
    Items,
    Paragraph,
    Section,
    Sheet,
    Table,
)
from centrode.sheets.texts import NOTHING, Counted, Expression, Joined, Name, Number, Sentence, Text
from centrode.views.instants import place_title
from centrode.views.parameter_studies import ANALYSES, number_title
from centrode.views.rotatability import cause_text
from centrode.views.single_changes import changes_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    from centrode.assignments.answers import InstantAnswers, RepairedAnswers
    from centrode.assignments.results import VariantRow, Variants
    from centrode.model.motion_parameter import DriveCoordinate

STATUS_WORDS = {
    "ok": Sentence("ok"),
    "locks": Sentence("locks"),
    "refused": Sentence("refused"),
    "fault": Sentence("fault"),
}
WORDS = {True: Sentence("yes"), False: Sentence("no")}
ABSENT = Number(nan, digits="")
"""What is not known of a variant: a dash."""
SHOWN = 5
"""Causes shown together; all stand in the summary."""
WIDE = 8
"""Columns of numbers beside the variant that still fit across a page."""
ROUNDING = 1e-12
"""What is below this share of the greatest of its kind is zero."""


def sheet(variants: Variants) -> Sheet:
    """Whether each variant turns and why not; where there are answers, the numbers at the instants of all of them."""
    counted = Counted("{n} variant", "{n} variants", len(variants.rows))
    return Sheet(
        printed=(
            _printed_table(variants),
            *_tables_of_numbers(variants),
            *_refused_analyses(variants),
            Paragraph(Joined((counted, _statuses(variants)), ": ")),
        ),
        tables={"summary": _summary(variants)},
        chapters=Deferred(
            {
                "variants": lambda: _data_chapter(variants),
                "turning": lambda: _rotatability_chapter(variants),
                **({"analysis": lambda: _analysis_chapter(variants)} if variants.compute is not None else {}),
                **_instant_chapters(variants, {name: one.instants for name, one in variants.answers.items()}),
                **_repaired_chapters(variants),
            }
        ),
        failure=_failure(variants),
    )


def _statuses(variants: Variants) -> Text:
    """How many variants there are of each status."""
    count = Counter(row.status for row in variants.rows)
    return Joined(
        [
            Joined((word, Number(count[status], digits="d")), " ")
            for status, word in STATUS_WORDS.items()
            if count[status]
        ]
    )


def _failure(variants: Variants) -> Failure | None:
    """Why some were not computed."""
    missing = [row for row in variants.rows if not row.is_computed]
    if not missing:
        return None
    what = Counted("{n} variant was not computed", "{n} variants were not computed", len(missing))
    causes = [Joined((Name(row.variant), Name(row.cause)), ": ") for row in missing[:SHOWN]]
    return Failure(Joined((what, *causes), "\n"))


def _names(rows: Sequence[VariantRow]) -> Column:
    return Column("variant", tuple(Name(row.variant) for row in rows), head=Sentence("variant"))


def _printed_table(variants: Variants) -> Table:
    """The table of a terminal; limits in SI, as the summary has them."""
    rows = variants.rows
    limits = tuple(
        NOTHING if row.limit is None else Number(row.limit, row.unit, ".9g", unit_fixed=True) for row in rows
    )
    turning = tuple(NOTHING if row.turns_fully is None else WORDS[row.turns_fully] for row in rows)
    return Table(
        (
            _names(rows),
            Column("turns_fully", turning, head=Sentence("turns fully")),
            Column("limit", limits, head=Sentence("limit")),
            Column("group", tuple(Name(row.group) for row in rows), head=Sentence("group")),
            Column("status", tuple(STATUS_WORDS[row.status] for row in rows), head=Sentence("status")),
        )
    )


def _numbers(variants: Variants) -> list[Column]:
    """The numbers of an analysis of each variant, NaN where it was refused."""
    units = {name: unit for row in variants.rows for name, (_value, unit) in row.numbers.items()}
    return [
        Column(
            name,
            np.array([row.numbers[name][0] if name in row.numbers else nan for row in variants.rows]),
            unit,
            number_title(name),
        )
        for name, unit in units.items()
    ]


def _tables_of_numbers(variants: Variants) -> Iterator[Table]:
    """The first numbers of an analysis, as a terminal shows them; the summary has all."""
    numbers = _numbers(variants)[:WIDE]
    for start in range(0, len(numbers), WIDE // 2):
        yield Table((_names(variants.rows), *numbers[start : start + WIDE // 2]))


def _refused_analyses(variants: Variants) -> Iterator[Block]:
    """Why an analysis has no numbers of some variants, whose motion is known all the same."""
    refused = [row for row in variants.rows if row.refusal]
    if refused:
        yield Paragraph(Counted("{n} variant has no numbers:", "{n} variants have no numbers:", len(refused)))
        yield Items(tuple(Joined((Name(row.variant), Name(row.refusal)), ": ") for row in refused))


def _causes(variants: Variants, row: VariantRow) -> str:
    """Why a variant locks or was not computed, and why its analysis was refused."""
    return "; ".join(filter(None, (row.cause, row.refusal and f"{variants.compute}: {row.refusal}")))


def _analysis_chapter(variants: Variants) -> Chapter:
    """The numbers of the analysis, a row a variant, and why some have none."""
    assert variants.compute is not None
    names = [row.variant for row in variants.rows]
    blocks = (*_tables(names, _numbers(variants)), *_refused_analyses(variants))
    return Chapter(Sentence("Analysis: {what}", what=ANALYSES[variants.compute]), (Section(NOTHING, blocks),))


def _summary(variants: Variants) -> Table:
    """The table of a file, in SI and in English."""
    rows = variants.rows
    words = {True: Name("yes"), False: Name("no"), None: Name("")}
    limits = np.array([nan if row.limit is None else row.limit for row in rows])
    unit = next((row.unit for row in rows if row.unit), "rad")
    return Table(
        (
            _names(rows),
            Column("turns_fully", tuple(words[row.turns_fully] for row in rows)),
            Column("limit", limits, unit, unit_fixed=True),
            Column("group", tuple(Name(row.group) for row in rows)),
            Column("cause", tuple(Name(_causes(variants, row)) for row in rows)),
            Column("status", tuple(Name(row.status) for row in rows)),
            *(replace(column, unit_fixed=True) for column in _numbers(variants)),
        )
    )


# The sheet of answers: one row a variant.


def _data_chapter(variants: Variants) -> Chapter:
    """The numbers of the table; those that are the same throughout, as of a link and its drive, stand once."""
    columns: dict[tuple[object, ...], Column] = {}
    if any(variant.source for variant in variants.given):
        sources = tuple(Name(variant.source) for variant in variants.given)
        columns[sources] = Column("topology", sources, head=Sentence("topology"))
    for path in dict.fromkeys(path for variant in variants.given for path in variant.values):
        values = tuple(variant.values.get(path, nan) for variant in variants.given)
        base = next(one for one in variants.given if path in one.values).base(variants.mechanism)
        unit = KINDS[kind_at(base, path)].unit.replace("*", " ") or "1"
        columns.setdefault(values, Column(path, np.array(values), unit, Name(path)))
    names = [variant.name for variant in variants.given]
    return Chapter(
        Sentence("Data of the variants"), (Section(NOTHING, tuple(_tables(names, list(columns.values())))),)
    )


def _tables(names: Sequence[str], columns: Sequence[Column]) -> Iterator[Table]:
    """As many tables as keep to the width of a page."""
    first = Column("variant", tuple(map(Name, names)), head=Sentence("variant"))
    for start in range(0, len(columns), WIDE):
        yield Table((first, *columns[start : start + WIDE]))


def _rotatability_chapter(variants: Variants) -> Chapter:
    """Whether each turns fully, where it locks and why; and which have no answers."""
    rows = variants.rows
    columns = (
        _names(rows),
        Column("turns_fully", tuple(_turning(row) for row in rows), head=Sentence("turns fully")),
        Column("limit", tuple(_limit(row) for row in rows), head=Sentence("limit")),
        Column("group", tuple(_group(variants, row) for row in rows), head=Sentence("group")),
        Column("cause", tuple(_cause(variants, row) for row in rows), head=Sentence("cause")),
        Column("status", tuple(STATUS_WORDS[row.status] for row in rows), head=Sentence("status")),
    )
    blocks: list[Block] = [Table(columns)]
    missing = [Name(row.variant) for row in rows if row.variant not in variants.answers]
    if missing:
        blocks.append(
            Paragraph(Sentence("No answers, for the causes above: {names}.", names=Joined(missing)))
        )
    return Chapter(Sentence("Rotatability"), (Section(NOTHING, tuple(blocks)),))


def _turning(row: VariantRow) -> Text:
    return ABSENT if row.turns_fully is None else WORDS[row.turns_fully]


def _limit(row: VariantRow) -> Text:
    return ABSENT if row.limit is None else Number(row.limit, row.unit, digits="")


def _group(variants: Variants, row: VariantRow) -> Text:
    """The group that locks, in the reader's language where the variant has answers."""
    answers = variants.answers.get(row.variant)
    return Name(row.group if answers is None else answers.group)


def _cause(variants: Variants, row: VariantRow) -> Text:
    """Why it locks; why it was refused, as that was written."""
    answers = variants.answers.get(row.variant)
    if answers is None:
        return Name(row.cause)
    return Joined([cause_text(cause) for cause in answers.causes], "; ") if answers.causes else Name("")


@dataclass(frozen=True)
class _InstantOfAll:
    """An instant of the variants that have it, by their names."""

    number: int
    answers: Mapping[str, InstantAnswers]


Instants: TypeAlias = "Mapping[str, tuple[InstantAnswers, ...]]"
"""Instants of each variant, by its name."""


def _instant_chapters(
    variants: Variants, found: Instants, repaired: bool = False
) -> dict[str, Callable[[], Chapter]]:
    """A chapter for each instant at which some variant has numbers."""
    prefix = "repaired-instant" if repaired else "instant"
    return {
        f"{prefix}-{instant.number + 1}": partial(_instant_chapter, variants, instant, repaired)
        for instant in _instants(variants, found)
    }


def _instants(variants: Variants, found: Instants) -> Iterator[_InstantOfAll]:
    """Every instant at which some variant has numbers."""
    names = [row.variant for row in variants.rows if row.variant in found]
    for number in range(max((len(found[name]) for name in names), default=0)):
        answers = {name: found[name][number] for name in names if number < len(found[name])}
        if any(answer.links or answer.points or answer.drives for answer in answers.values()):
            yield _InstantOfAll(number, answers)


def _repaired_chapters(variants: Variants) -> dict[str, Callable[[], Chapter]]:
    """What is changed in variants that lock, and the numbers of the repaired mechanisms at each instant."""
    found = {name: one.repaired for name, one in variants.answers.items() if one.repaired is not None}
    if not found:
        return {}
    instants = {name: one.instants for name, one in found.items()}
    return {
        "repaired": lambda: _repairs_chapter(variants, found),
        **_instant_chapters(variants, instants, repaired=True),
    }


def _repairs_chapter(variants: Variants, found: Mapping[str, RepairedAnswers]) -> Chapter:
    """The repair of each variant that locks, and the least transmission angle that it leaves."""
    names = [row.variant for row in variants.rows if row.variant in found]
    bases = {variant.name: variant.base(variants.mechanism) for variant in variants.given}
    repairs = tuple(changes_text(bases[name], found[name].dimensions, found[name].changes) for name in names)
    angles = tuple(Number(degrees(found[name].least_angle), "deg", ".3g") for name in names)
    table = Table(
        (
            Column("variant", tuple(map(Name, names)), head=Sentence("variant")),
            Column("repair", repairs, head=Sentence("repair")),
            Column("least_angle", angles, head=Sentence("least transmission angle")),
        )
    )
    asked = Sentence(
        "Mechanisms that lock are repaired by their initial angles where this is sufficient. Every group keeps a "
        "transmission angle of {angle} or more.",
        angle=Number(degrees(min(one.angle for one in found.values())), "deg", ".3g"),
    )
    return Chapter(Sentence("Repaired mechanisms"), (Section(NOTHING, (Paragraph(asked), table)),))


def _instant_chapter(variants: Variants, instant: _InstantOfAll, repaired: bool = False) -> Chapter:
    """Links, points and drives at one instant."""
    mechanism, answers = variants.mechanism, instant.answers
    flat = mechanism.space == "plane"
    links = {name: answer.links for name, answer in answers.items()}
    points = {name: answer.points for name, answer in answers.items()}
    speeds = (("v", "m/s"), ("a", "m/s^2")) if flat else (("v", "1/s"), ("a", "1/s^2"))
    drives = [
        table
        for drive in _drives(variants)
        for table in _quantity(
            {
                name: {drive.name: answer.drives[drive.name]} if drive.name in answer.drives else {}
                for name, answer in answers.items()
            },
            "M" if drive.force_unit == "N m" else "F",
            drive.force_unit,
        )
    ]
    sections = (
        Section(
            Sentence("Links") if flat else Sentence("Angles of the links, from their reference arcs"),
            tuple(_orders(links, (("phi", "rad"), ("omega", "rad/s"), ("epsilon", "rad/s^2")))),
        ),
        Section(Sentence("Points"), tuple(_orders(points, speeds))),
        Section(Sentence("Balancing moments and forces of the drives"), tuple(drives)),
    )
    title = _title(variants, instant)
    title = Sentence("{place}, repaired mechanisms", place=title) if repaired else title
    return Chapter(title, tuple(section for section in sections if section.blocks))


def _drives(variants: Variants) -> list[DriveCoordinate]:
    """The drives of all topologies, each name once."""
    topologies = [variant.base(variants.mechanism) for variant in variants.given]
    found = {drive.name: drive for one in topologies for drive in one.motion_parameter.drives}
    return list(found.values())


def _title(variants: Variants, instant: _InstantOfAll) -> Text:
    """What all variants call an instant, else its number."""
    titles = [
        place_title(variants.mechanism, answer.values, answer.time) for answer in instant.answers.values()
    ]
    if all(title == titles[0] for title in titles):
        return titles[0]
    return Sentence("Instant {number}", number=Number(instant.number + 1, digits="d"))


def _orders(
    numbers: Mapping[str, Mapping[str, tuple[float, ...]]], quantities: Sequence[tuple[str, str]]
) -> Iterator[Table]:
    """Tables of a quantity and of its derivatives in time, each with its letter and its unit."""
    for order, (letter, unit) in enumerate(quantities):
        chosen = {
            variant: {name: values[order] for name, values in of.items()} for variant, of in numbers.items()
        }
        yield from _quantity(chosen, letter, unit)


def _quantity(numbers: Mapping[str, Mapping[str, float]], letter: str, unit: str) -> Iterator[Table]:
    """Tables of a quantity of all links, points or drives, columns, for all variants, rows."""
    names = list(dict.fromkeys(name for of in numbers.values() for name in of))
    values = np.array([[of.get(name, nan) for of in numbers.values()] for name in names], dtype=float)
    greatest = float(np.max(np.abs(values), where=np.isfinite(values), initial=0.0))
    # beside the others of its kind, not of its own column alone: a link that stands has rounding in its speed
    values[np.abs(values) < ROUNDING * greatest] = 0.0
    columns = [
        Column(name, column, unit, Joined((Expression(letter), Name(name)), " "))
        for name, column in zip(names, values, strict=True)
    ]
    yield from _tables(list(numbers), columns)
