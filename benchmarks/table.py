"""One table: a section, its rows of ratios, and what the rows say besides."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Row:
    """What was measured of one subject: number by name; `note` says what the numbers do not."""

    subject: str
    numbers: Mapping[str, float] = field(default_factory=dict)
    note: str = ""


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


def _short(number: float) -> str:
    return f"{number:.3g}" if number < 100 else f"{number:.0f}"
