"""Allocated tolerances: a table, and by how much they use their bounds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from centrode.sheets.sheet import Column, Fact, Sheet, Table
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Text

if TYPE_CHECKING:
    from centrode.tolerances.allocation import Allocation

METHODS = {
    "worst case": Sentence("worst case"),
    "statistical": Sentence("statistical, three standard deviations"),
}


def sheet(results: Allocation) -> Sheet:
    """Each number with its tolerance, exact and rounded, and the share of each bound that is used."""
    facts = [
        Fact(Sentence("bounds hold by"), METHODS[results.method]),
        Fact(
            Sentence("cost"),
            Sentence(
                "{cost}, rounded {rounded}",
                cost=Number(results.cost),
                rounded=Number(results.rounded_cost),
            ),
        ),
    ]
    facts += [
        Fact(
            Sentence("use of the bound of {output}", output=Name(name)),
            Joined(
                (
                    Number(100.0 * use, "%", ".4g"),
                    Sentence("rounded {use}", use=Number(100.0 * results.rounded_use[name], "%", ".4g")),
                ),
                ", ",
            ),
        )
        for name, use in results.use.items()
    ]
    return Sheet(facts=tuple(facts), tables={"allocation": table(results)}, printed=(table(results),))


def table(results: Allocation) -> Table:
    """A row for each number."""
    units = tuple(results.units)

    # a number that moves no output has no bound: an empty field
    exact, rounded = (np.where(np.isfinite(x), x, np.nan) for x in (results.halves, results.rounded))
    grades: tuple[Text, ...] = tuple(Name(f"IT{grade}") if grade else NOTHING for grade in results.grades)
    return Table(
        (
            Column("path", tuple(map(Name, results.paths)), head=Sentence("dimension or mass")),
            Column("value", results.values, head=Sentence("nominal"), units=units),
            Column("tolerance", exact, head=Sentence("tolerance ±"), units=units),
            Column("rounded", rounded, head=Sentence("rounded ±"), units=units),
            Column("grade", grades, head=Sentence("grade")),
        )
    )
