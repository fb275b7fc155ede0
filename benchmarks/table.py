"""One table: a section, its rows of ratios, and what the rows say besides."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Promise:
    """What is asked of a number: that it is at most, or at least, a bound."""

    what: str
    measured: float
    at_most: float | None = None
    at_least: float | None = None

    @property
    def asked(self) -> str:
        """The bound in words."""
        return f"<= {self.at_most:g}" if self.at_most is not None else f">= {self.at_least:g}"

    @property
    def held(self) -> bool:
        """Whether it is kept; what could not be measured is not."""
        if self.at_most is not None:
            return self.measured <= self.at_most
        return self.at_least is not None and self.measured >= self.at_least


@dataclass(frozen=True)
class Row:
    """What was measured of one subject: number by name; `note` says what the numbers do not."""

    subject: str
    numbers: Mapping[str, float] = field(default_factory=dict)
    note: str = ""
    promises: Sequence[Promise] = ()


def print_section(title: str, rows: Iterable[Row]) -> list[Row]:
    """Print rows as they are measured, a line of column names whenever these change; returns the rows."""
    print(f"\n{title}", flush=True)
    printed: list[Row] = []
    names: tuple[str, ...] = ()
    for row in rows:
        if row.numbers and tuple(row.numbers) != names:
            names = tuple(row.numbers)
            print(f"  {'':<42}" + "  ".join(names))
        cells = [f"{_short(row.numbers[name]):>{len(name)}}" for name in row.numbers]
        print(f"  {row.subject:<42}" + "  ".join(cells) + (f"   {row.note}" if row.note else ""), flush=True)
        printed.append(row)
    return printed


def print_promises(rows: Iterable[Row]) -> bool:
    """Print every promise of rows, what was asked and measured; returns whether all are held."""
    promises = [promise for row in rows for promise in row.promises]
    width = max((len(promise.what) for promise in promises), default=0)
    if promises:
        print(f"\nPromises\n  {'':<{width}}{'asked':>9}  {'measured':>8}  held")
    for promise in promises:
        held = "yes" if promise.held else "NO"
        print(f"  {promise.what:<{width}}{promise.asked:>9}  {_short(promise.measured):>8}  {held}")
    return all(promise.held for promise in promises)


def _short(number: float) -> str:
    return f"{number:.3g}" if number < 100 else f"{number:.0f}"
