"""What a campaign is: cases that follow from a seed and a number alone, and what they add up to."""

from __future__ import annotations

import math
import traceback
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

import numpy as np

Worst = tuple[float, int]
"""A figure and the number of the case that has it."""


@dataclass
class Outcome:
    """What one case gave.

    `figures` are errors and the like by (row, column) of the campaign's table, `counts` what was counted, `faults`
    what the program did wrong; `subject` is the case itself in full, to be seen when it is run alone.
    """

    subject: str = ""
    figures: dict[tuple[str, str], float] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=dict)
    faults: list[str] = field(default_factory=list)

    def measure(self, row: str, column: str, value: float) -> None:
        """Keep the greatest value of a figure; what is no number counts as infinite."""
        value = math.inf if math.isnan(value) else float(value)
        self.figures[row, column] = max(value, self.figures.get((row, column), -math.inf))

    def count(self, what: str, number: int = 1) -> None:
        """Add to a count."""
        self.counts[what] = self.counts.get(what, 0) + int(number)

    def fault(self, what: str) -> None:
        """Note something that the program did wrong."""
        self.faults.append(what)

    def hold(self, row: str, column: str, value: float, bound: float) -> None:
        """Keep a figure; one above its bound is a fault."""
        self.measure(row, column, value)
        if not value <= bound:
            self.fault(f"{row}: {column} {value:.2g}, bound {bound:.2g}")


@dataclass(frozen=True)
class Campaign:
    """A kind of random cases and their oracle.

    `run` makes the case of a seed and a number; the case depends on nothing else. `about` says what is compared with
    what, `columns` what the figures mean and which bound they have. `block` cases are written to the record together.
    """

    name: str
    title: str
    about: str
    columns: Mapping[str, str]
    run: Callable[[int, int], Outcome]
    cases: int
    block: int = 10

    def outcome(self, seed: int, number: int) -> Outcome:
        """The case of a seed and a number; an exception of the program is a fault like any other."""
        try:
            return self.run(seed, number)
        except Exception as error:
            found = Outcome(subject="".join(traceback.format_exception(error)))
            found.fault(f"{type(error).__name__}: {error} ({_place(error)})")
            return found


def random_of(seed: int, number: int) -> np.random.Generator:
    """The generator that draws a case."""
    return np.random.default_rng([seed, number])


@dataclass
class Tally:
    """What cases add up to: the worst figure of each kind with its case, counts, faults by case."""

    cases: int = 0
    worst: dict[tuple[str, str], Worst] = field(default_factory=dict)
    held: dict[str, int] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=dict)
    faults: list[tuple[int, str]] = field(default_factory=list)

    @classmethod
    def of(cls, campaign: Campaign, seed: int, numbers: Iterable[int]) -> Self:
        """Run cases and add them up."""
        found = cls()
        for number in numbers:
            found.add(number, campaign.outcome(seed, number))
        return found

    def add(self, number: int, outcome: Outcome) -> None:
        """Take one case in."""
        self.cases += 1
        for key, value in outcome.figures.items():
            self._take(key, (value, number))
        for row in {row for row, _column in outcome.figures}:
            self.held[row] = self.held.get(row, 0) + 1
        for what, count in outcome.counts.items():
            self.counts[what] = self.counts.get(what, 0) + count
        self.faults += [(number, what) for what in outcome.faults]

    def join(self, other: Tally) -> None:
        """Take the cases of another tally in."""
        self.cases += other.cases
        for key, worst in other.worst.items():
            self._take(key, worst)
        for mine, more in ((self.held, other.held), (self.counts, other.counts)):
            for what, count in more.items():
                mine[what] = mine.get(what, 0) + count
        self.faults += other.faults

    def _take(self, key: tuple[str, str], worst: Worst) -> None:
        if key not in self.worst or worst[0] > self.worst[key][0]:
            self.worst[key] = worst

    def rows(self) -> Iterator[tuple[str, dict[str, Worst]]]:
        """Rows of the table in the order of their names, each with its figures by column."""
        for row in sorted(self.held):
            yield row, {column: worst for (own, column), worst in self.worst.items() if own == row}

    def plain(self) -> dict[str, Any]:
        """The tally as JSON has it."""
        worst = [[row, column, *found] for (row, column), found in self.worst.items()]
        return {
            "cases": self.cases, "worst": worst, "held": self.held, "counts": self.counts, "faults": self.faults
        }  # fmt: skip

    @classmethod
    def from_plain(cls, plain: Mapping[str, Any]) -> Self:
        """The tally that JSON has."""
        worst = {(row, column): (value, number) for row, column, value, number in plain["worst"]}
        faults = [(number, what) for number, what in plain["faults"]]
        return cls(plain["cases"], worst, dict(plain["held"]), dict(plain["counts"]), faults)


def _place(error: BaseException) -> str:
    """File and line where an exception arose."""
    frames = traceback.extract_tb(error.__traceback__)
    return f"{Path(frames[-1].filename).name}:{frames[-1].lineno}" if frames else "?"
