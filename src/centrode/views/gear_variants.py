"""Variants of a gear pair or of a train: the table of a terminal, and the summary in a file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.gears.results import GearPairResults
from centrode.sheets.sheet import Column, Failure, Paragraph, Scalar, Sheet, Table
from centrode.sheets.texts import NOTHING, Counted, Joined, Name, Number, Sentence, Text
from centrode.views import gear_pair, gear_train

if TYPE_CHECKING:
    from centrode.assignments.gear_variants import GearVariantResults, GearVariants

STATUS_WORDS = {"ok": Sentence("ok"), "refused": Sentence("refused")}
HEADS: dict[str, Text] = {
    "centre_distance": Sentence("centre distance"),
    "contact_ratio": Sentence("contact ratio"),
    "greatest_sliding_1": Sentence("sliding of the pinion"),
    "greatest_sliding_2": Sentence("sliding of the wheel"),
    "shift_1": Sentence("shift of the pinion"),
    "shift_2": Sentence("shift of the wheel"),
    "working_pressure_angle": Sentence("working pressure angle"),
    "ratio": Sentence("ratio"),
    "deviation": Sentence("deviation"),
    "efficiency": Sentence("efficiency"),
    "diameter": Sentence("diameter"),
}
"""Numbers that a terminal shows, with their heads; the summary has all."""
SHOWN = 3
"""Refusals that a message tells."""


def sheet(variants: GearVariants) -> Sheet:
    """A row a variant, and how many of them were refused."""
    scalars = [_scalars(one) for one in variants.results]
    count = Counter(one.status for one in variants.results)
    counted = Counted("{n} variant", "{n} variants", len(variants.results))
    statuses = Joined(
        [
            Joined((word, Number(count[status], digits="d")), " ")
            for status, word in STATUS_WORDS.items()
            if count[status]
        ]
    )
    return Sheet(
        printed=(_printed_table(variants, scalars), Paragraph(Joined((counted, statuses), ": "))),
        tables={"summary": _summary(variants, scalars)},
        failure=_failure(variants),
    )


def _scalars(one: GearVariantResults) -> dict[str, Scalar]:
    """The numbers of a summary of the variant alone; none of one that was refused."""
    if one.result is None:
        return {}
    view = gear_pair if isinstance(one.result, GearPairResults) else gear_train
    return dict(view.sheet(one.result).scalars)


def _teeth(one: GearVariantResults) -> Text:
    """Numbers of teeth of the pair, or of the chosen train."""
    if one.result is None:
        return NOTHING
    if isinstance(one.result, GearPairResults):
        return Joined([Number(float(teeth)) for teeth in one.result.gear_pair.teeth])
    return gear_train.teeth_text(one.result.chosen)


def _numbers(scalars: list[dict[str, Scalar]], *, heads: bool) -> Iterator[Column]:
    """A column for each number, NaN where a variant has none."""
    units = {name: scalar.unit for one in scalars for name, scalar in one.items()}
    for name, unit in units.items():
        if heads and name not in HEADS:
            continue
        values = np.array([one[name].value if name in one else np.nan for one in scalars])
        yield Column(name, values, unit, head=HEADS[name] if heads else NOTHING, unit_fixed=not heads)


def _printed_table(variants: GearVariants, scalars: list[dict[str, Scalar]]) -> Table:
    results = variants.results
    return Table(
        (
            Column("variant", tuple(Name(one.variant.name) for one in results), head=Sentence("variant")),
            Column("teeth", tuple(map(_teeth, results)), head=Sentence("teeth")),
            *_numbers(scalars, heads=True),
            Column("status", tuple(STATUS_WORDS[one.status] for one in results), head=Sentence("status")),
        )
    )


def _summary(variants: GearVariants, scalars: list[dict[str, Scalar]]) -> Table:
    """The table of a file, in SI."""
    results = variants.results
    causes = (_cause(one) or NOTHING for one in results)
    return Table(
        (
            Column("variant", tuple(Name(one.variant.name) for one in results)),
            Column("teeth", tuple(map(_teeth, results))),
            *_numbers(scalars, heads=False),
            Column("status", tuple(Name(one.status) for one in results)),
            Column("cause", tuple(causes)),
        )
    )


def _cause(one: GearVariantResults) -> Text | None:
    """Why a variant was refused, or cannot work."""
    if one.refusal:
        return Name(one.refusal)
    if isinstance(one.result, GearPairResults):
        failure = gear_pair.sheet(one.result).failure
        return None if failure is None else failure.what
    return None


def _failure(variants: GearVariants) -> Failure | None:
    missing = [(one.variant.name, cause) for one in variants.results if (cause := _cause(one)) is not None]
    if not missing:
        return None
    what = Counted("{n} variant cannot be used", "{n} variants cannot be used", len(missing))
    causes = [Joined((Name(name), cause), ": ") for name, cause in missing[:SHOWN]]
    return Failure(Joined((what, *causes), "\n"))
