"""The page of a campaign as Markdown."""

from __future__ import annotations

import math
import textwrap

import centrode
from tools.campaigns.campaign import Campaign, Tally

WIDTH = 120
FAULTS = 20
"""Faults told on a page; of more only how many there are."""
LONGEST = 300


def page(campaign: Campaign, seed: int, tally: Tally) -> str:
    """What was compared with what, the worst figures with their cases, the faults."""
    parts = [f"# {campaign.title}", _filled(campaign.about), _told(campaign, seed, tally)]
    if tally.worst:
        parts += [_table(campaign, tally), _columns(campaign)]
    parts.append(_faults(campaign, seed, tally))
    return "\n\n".join(parts) + "\n"


def _told(campaign: Campaign, seed: int, tally: Tally) -> str:
    text = f"centrode {centrode.__version__}, seed {seed}: {tally.cases} cases"
    if tally.counts:
        text += "; " + "; ".join(f"{what}: {count}" for what, count in sorted(tally.counts.items()))
    command = f"python -m tools.campaigns {campaign.name} --seed {seed}"
    return _filled(
        f"{text}.\n\nThe page is written by `{command} --cases {tally.cases}`; `--case NUMBER` instead of `--cases` "
        "runs one case and shows it in full. In brackets: the number of the case that has the figure."
    )


def _table(campaign: Campaign, tally: Tally) -> str:
    columns = list(campaign.columns)
    lines = [
        "| | cases | " + " | ".join(columns) + " |",
        "|---|---:|" + "---:|" * len(columns),
    ]
    for row, worst in tally.rows():
        cells = [f"{_short(worst[name][0])} [{worst[name][1]}]" if name in worst else "" for name in columns]
        lines.append(f"| {row.replace('|', chr(92) + '|')} | {tally.held[row]} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _columns(campaign: Campaign) -> str:
    return "\n".join(
        textwrap.fill(f"- {name}: {text}", WIDTH, subsequent_indent="  ")
        for name, text in campaign.columns.items()
    )


def _faults(campaign: Campaign, seed: int, tally: Tally) -> str:
    cases = sorted({number for number, _what in tally.faults})
    if not cases:
        return "No faults were found."
    told = [
        f"{len(cases)} of {tally.cases} cases have faults"
        + (f"; the first {FAULTS}:" if len(cases) > FAULTS else ":")
    ]
    lines = []
    for number in cases[:FAULTS]:
        first, *more = [what for own, what in tally.faults if own == number]
        text = " ".join(first.split())[:LONGEST].replace("`", "'")
        lines.append(f"- case {number}: `{text}`" + (f" and {len(more)} more" if more else ""))
    return "\n".join(told) + "\n\n" + "\n".join(_item(line) for line in lines)


def _item(line: str) -> str:
    return textwrap.fill(line, WIDTH, subsequent_indent="  ", break_long_words=True, break_on_hyphens=False)


def _filled(text: str) -> str:
    paragraphs = text.split("\n\n")
    return "\n\n".join(
        textwrap.fill(" ".join(one.split()), WIDTH, break_on_hyphens=False) for one in paragraphs
    )


def _short(value: float) -> str:
    if math.isinf(value):
        return "infinite"
    return f"{value:.2g}"
