"""Equations spelled for a page as blocks of a report: the relations and systems that `centrode equations` prints."""

from __future__ import annotations

from collections.abc import Iterable

from centrode.locale import _
from centrode.present.equations import page
from centrode.render.document.blocks import Block, Formula, Paragraph, Section, System, Table, shown
from centrode.render.document.numbers import respelled
from centrode.render.document.rows import degrees


def section_of(section: page.Section) -> Section:
    """A section of the equations' page as one of a report."""
    return Section(section.heading, blocks_of(section.entries))


def blocks_of(entries: Iterable[page.Entry]) -> tuple[Block, ...]:
    """Relations that follow each other stand below each other."""
    found: list[Block] = []
    lines: list[tuple[str, ...]] = []
    for entry in entries:
        if isinstance(entry, page.Relation):
            lines.append(entry.parts)
            continue
        if lines:
            found.append(Formula(tuple(lines)))
            lines = []
        found.append(_block(entry))
    return (*found, Formula(tuple(lines))) if lines else tuple(found)


def _block(entry: page.System | page.Symbols | page.Note) -> Block:
    if isinstance(entry, page.System):
        return System(entry.matrix, entry.unknowns, entry.right)
    if isinstance(entry, page.Note):
        return Paragraph(entry.text)
    rows = tuple((f"${name}$", respelled(degrees(value)), shown(words)) for name, value, words in entry.rows)
    return Table((_("symbol"), _("value"), _("meaning")), rows, "", (False, True, False))
