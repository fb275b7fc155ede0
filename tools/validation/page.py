"""The page of validation as Markdown."""

from __future__ import annotations

import textwrap

from tools.campaigns.registry import CAMPAIGNS as CAMPAIGNS_BY_NAME
from tools.validation import cams, kinematics, literature, machines
from tools.validation.rows import Row, Source

HEAD = """# Validation

Every number that a source prints, beside what centrode computes; the page is made by running it (`make reference`),
and compared with the program at every `make test`. A number agrees when it rounds to the printed one. Where a source
is wrong, an example repeats its slip and says so, and the right value stands beside it: see [errata](errata.md).
"""
CAMPAIGNS = """## Random cases

Campaigns compare many random cases with oracles that share no code with the program. `make campaigns` runs all of
them, `make campaigns CAMPAIGNS="gaps --minutes 5"` one for some minutes; a run that was cut short goes on where it
was. Each writes its page:

{pages}

`python -m tools.campaigns NAME --case NUMBER` runs one case and shows it in full. The suite runs a fixed sample of
each.
"""
WIDTH = 120
SOURCES = (
    kinematics.assignment,
    literature.drawing,
    kinematics.excerpt,
    kinematics.coursework,
    machines.coursework,
    cams.paper,
    cams.laws,
    cams.flat_face,
    machines.thesis,
    literature.squeezer,
)


def sources() -> list[Source]:
    """All that is compared."""
    return [source() for source in SOURCES]


def page() -> str:
    """The page."""
    found = sources()
    total = sum(len(one.rows) + sum(len(column.printed) for column in one.columns) for one in found)
    agreeing = sum(
        sum(row.agrees for row in one.rows) + sum(column.agreeing for column in one.columns) for one in found
    )
    counted = f"{agreeing} of {total} printed numbers agree.\n"
    return "\n".join([HEAD, counted, *(_section(one) for one in found), _campaigns()])


def _campaigns() -> str:
    """Where the pages of campaigns stand."""
    pages = [f"- [{one.title}](validation/{name}.md)" for name, one in CAMPAIGNS_BY_NAME.items()]
    return CAMPAIGNS.format(pages="\n".join(pages))


def _section(source: Source) -> str:
    parts = [f"## {source.title}\n\n{textwrap.fill(source.about, WIDTH, break_on_hyphens=False)}\n"]
    if source.columns:
        rows = [
            "| column | numbers | agree | farthest, in half units of the last digit |",
            "|---|---:|---:|---:|",
        ]
        rows += [
            f"| `{one.quantity}` | {len(one.printed)} | {one.agreeing} | {one.worst:.2f} |"
            for one in source.columns
        ]
        parts.append("\n".join(rows) + "\n")
    if source.rows:
        rows = ["| quantity | | unit | printed | computed | |", "|---|---|---|---:|---:|---|"]
        rows += [_row(one) for one in source.rows]
        parts.append("\n".join(rows) + "\n")
    return "\n".join(parts)


def _row(row: Row) -> str:
    digits = max(0, -_exponent(row.half_unit))
    found = f"{row.found:.{digits + 1}f}"
    said = "agrees" if row.agrees else "**differs**"
    return f"| {row.quantity} | `{row.symbol}` | {row.unit} | {row.printed:.{digits}f} | {found} | {said} |"


def _exponent(half_unit: float) -> int:
    """Power of ten of the last printed digit."""
    return round(float(f"{half_unit:e}".split("e")[1]) + (1 if f"{half_unit:e}".startswith("5") else 0))
