"""The chapter of a document on a synthesis: what is wanted, how it was sought, the answers, the best one."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from centrode.sheets.sheet import (
    Block,
    Chapter,
    Fact,
    FactTable,
    Illustration,
    Paragraph,
    Section,
    Table,
)
from centrode.sheets.texts import NOTHING, Number, Sentence, Text
from centrode.views.linkage_data import data_chapter

if TYPE_CHECKING:
    from centrode.synthesis.answers import SynthesisResults

WAYS = {
    "path": Sentence(
        "Coupler curves of an atlas that resemble the targets are where least squares begin; around the best linkages "
        "others are tried. A crank angle that nobody gives is the one at which the point is nearest to its target."
    ),
    "motion": Sentence(
        "A point of the link stays on a circle through all its poses where it is a circle point, about a centre point. "
        "Two such pairs make a linkage; more poses than five are met in the sense of least squares."
    ),
    "function": Sentence(
        "Freudenstein's equation gives the linkages of some precision points; from them the greatest error is made "
        "least."
    ),
    "strokes": Sentence(
        "In both limit positions the crank and the coupler lie in one line, so that the hinge of the crank sees the "
        "stroke at the angle that the time ratio fixes."
    ),
}
OF_A_FILE = Sentence(
    "The free numbers of the mechanism go from many places between their bounds to the least squares of what is "
    "missed, with exact derivatives."
)
PROVED = Sentence(
    "Every answer has been moved over its whole motion: a defect of order, branch or circuit stands in the table."
)


def synthesis_chapter(
    results: SynthesisResults,
    facts: Sequence[Fact],
    answers: Table,
    construction: Sequence[Section],
    pictures: Collection[str],
    notes: Sequence[Text],
) -> Chapter:
    """What was wanted, the table and the pictures of the answers, the construction, the numbers of the best.

    Parameters
    ----------
    pictures : names of those that the sheet has
    """
    on_file = results.task.mechanism is not None
    way = OF_A_FILE if on_file else WAYS[results.task.synthesis.kind]
    numbers = tuple(Number(k, digits="d") for k in range(1, len(results.answers) + 1))
    numbered = replace(answers.columns[0], values=numbers, whole=False)
    found: list[Block] = [replace(answers, columns=(numbered, *answers.columns[1:]))]
    found += [Illustration(name) for name in ("answers", "errors", "curves") if name in pictures]
    found += [Paragraph(note, clause=True) for note in notes]
    return Chapter(
        Sentence("Synthesis of the mechanism"),
        (
            Section(NOTHING, (FactTable(tuple(facts), Sentence("What is wanted and found")),)),
            Section(Sentence("How the mechanisms were sought"), (Paragraph(way), Paragraph(PROVED))),
            Section(Sentence("Answers"), tuple(found)),
            *_construction_sections(construction, pictures),
            Section(Sentence("The best answer"), data_chapter(results.mechanism).sections[0].blocks),
        ),
    )


def _construction_sections(construction: Sequence[Section], pictures: Collection[str]) -> Iterator[Section]:
    """The construction with its picture."""
    drawn: tuple[Block, ...] = (Illustration("construction"),) if "construction" in pictures else ()
    if construction:
        first, *others = construction
        yield Section(first.title, (*first.blocks, *drawn))
        yield from others
    elif drawn:
        yield Section(Sentence("Construction"), drawn)
