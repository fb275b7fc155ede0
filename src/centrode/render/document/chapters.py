"""Chapters of sheets as blocks of a document, in the language that is spoken."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias, assert_never

import numpy as np
from matplotlib.figure import Figure

from centrode.locale import _
from centrode.quantities import spelled_unit
from centrode.render.document import blocks
from centrode.render.document.cam_player import moving_follower, moving_wheel
from centrode.render.document.figures import picture
from centrode.render.document.linkage_player import moving_of
from centrode.render.document.numbers import Numbers, spelled_number
from centrode.render.document.scale import INCH, drawn_to_scale, scale_of
from centrode.render.document.spelling import ROUNDING, DocumentSpelling
from centrode.render.figures import pictures as figures_pictures
from centrode.render.pages.force_polygons import drawing_end, group_scales
from centrode.render.pages.instants import DRAWING as INSTANT
from centrode.render.pages.positions import DRAWING as POSITIONS
from centrode.render.pages.several_instants import DRAWING as INSTANTS
from centrode.sheets.force_pages import GroupPage, LeverPage
from centrode.sheets.pages import InstantPage, InstantsPage, PositionsPage, VectorDiagramPage
from centrode.sheets.players import CamPlayer, MotionPlayer, WheelPlayer
from centrode.sheets.plots import VectorPage
from centrode.sheets.sheet import (
    Block,
    Check,
    Column,
    Fact,
    FactTable,
    Formula,
    Illustration,
    Items,
    Listing,
    Paragraph,
    Reference,
    Section,
    Sheet,
    SheetEquations,
    SymbolList,
    Table,
)

if TYPE_CHECKING:
    from centrode.sheets.pictures import Picture

    Pictures: TypeAlias = Mapping[str, Picture]

COMPACT_ROWS = 13
"""Rows that a table over a motion has at most in a compact document: a turn in steps of 30 degrees."""


def document_chapter(
    name: str, sheet: Sheet, numbers: Numbers, *, full: bool = True, rows: int | None = None
) -> blocks.ChapterBlocks:
    """A chapter of a sheet, spelled and with its pictures drawn; unless `full`, without its details.

    Tables over a motion have at most `rows` rows, where that is given.
    """
    chapter, spelling = sheet.chapters[name], DocumentSpelling(numbers)
    sections = tuple(
        _section(
            _with_rows(section if full else _compact_section(section, thin=rows is None), rows),
            sheet.pictures,
            spelling,
        )
        for section in chapter.sections
        if full or not section.detail
    )
    kept = tuple(section for section in sections if full or section.blocks)
    return blocks.ChapterBlocks(name, spelling.text(chapter.title), kept)


def _with_rows(section: Section, most: int | None) -> Section:
    """A section whose tables over a motion have at most so many rows."""
    if most is None:
        return section
    changed = (_choose_rows(one, most) if isinstance(one, Table) else one for one in section.blocks)
    return replace(section, blocks=tuple(changed))


def _choose_rows(table: Table, most: int) -> Table:
    """A table over a motion with other rows at even steps, as many as there may be; a gap stays a gap."""
    if table.rows is None or len(table.rows) < 2:
        return table
    gaps = np.diff(table.rows)
    parts = (
        range(row, row + gap) if gap <= 2 * gaps.min() else (row,)
        for row, gap in zip(table.rows, gaps.tolist(), strict=False)
    )
    every = [*(row for part in parts for row in part), table.rows[-1]]
    last = len(every) - 1
    least = max(-(-last // (most - 1)), 1)
    step = next((k for k in range(least, 2 * least + 1) if last % k == 0), None)
    if step is None:  # the steps do not divide evenly
        chosen = np.unique(np.linspace(0, last, most).round().astype(int)).tolist()
    else:
        chosen = list(range(0, last + 1, step))
    return replace(table, rows=tuple(every[k] for k in chosen))


def _compact_section(section: Section, *, thin: bool = True) -> Section:
    """A section without figures and columns that are details, its tables over a motion at fewer places."""
    kept = (block for block in section.blocks if not (isinstance(block, Illustration) and block.detail))
    return replace(
        section, blocks=tuple(_compact(one, thin) if isinstance(one, Table) else one for one in kept)
    )


def _compact(table: Table, thin: bool) -> Table:
    columns = tuple(column for column in table.columns if not column.detail)
    compact = replace(table, columns=columns)
    return _thin_table(compact) if thin else compact


def _thin_table(table: Table) -> Table:
    """A table that shows some of its rows, with fewer of them at even steps: the first and the last stay.

    So do both ends of a gap, where rows between them are alike and left out.
    """
    if table.rows is None or len(table.rows) <= COMPACT_ROWS:
        return table
    gaps = np.diff(table.rows)
    wide = np.flatnonzero(gaps > 2 * gaps.min())
    last = len(table.rows) - 1
    step = next(step for step in range(1, last + 1) if last // step < COMPACT_ROWS and last % step == 0)
    if last // step < COMPACT_ROWS // 2:  # the steps do not divide evenly
        step = -(-last // (COMPACT_ROWS - 1))
    kept = {*range(0, last, step), last, *wide.tolist(), *(wide + 1).tolist()}
    return replace(table, rows=tuple(table.rows[k] for k in sorted(kept)))


def _section(section: Section, pictures: Pictures, spelling: DocumentSpelling) -> blocks.SectionBlocks:
    made = [_block(block, pictures, spelling) for block in section.blocks if _is_there(block, pictures)]
    return blocks.SectionBlocks(spelling.text(section.title), tuple(made))


def _is_there(block: Block, pictures: Pictures) -> bool:
    """Whether there is something to show: pictures belong to some descriptions only."""
    return (
        not (isinstance(block, Illustration) and isinstance(block.picture, str)) or block.picture in pictures
    )


def _block(block: Block, pictures: Pictures, spelling: DocumentSpelling) -> blocks.Block:
    match block:
        case Paragraph(text, clause):
            spelled = spelling.text(text)
            return blocks.ParagraphBlock(f"{spelled[:1].upper()}{spelled[1:]}." if clause else spelled)
        case MotionPlayer(mechanism, motion, by_time, marks=marks):
            return moving_of(mechanism, motion, by_time, [(spelling.text(name), at) for name, at in marks])
        case Formula(lines, name):
            return blocks.FormulaBlock(tuple(tuple(map(spelling.mathematics, line)) for line in lines), name)
        case Reference(text):
            return blocks.ReferenceBlock(_(text.message))
        case Table():
            return _table(block, spelling)
        case FactTable(facts, caption):
            return _facts(facts, spelling.text(caption), spelling)
        case Illustration(picture_or_name, caption):
            shown = pictures[picture_or_name] if isinstance(picture_or_name, str) else picture_or_name
            figure = figures_pictures.figure_of(shown, spelling.numbers.display)
            if isinstance(shown, GroupPage | LeverPage):
                # cut from its page: the column beside it stands in the text of the chapter
                name = spelling.text(shown.title if caption is None else caption)
                name = _with_scales(shown, name) if isinstance(shown, GroupPage) else name
                return drawn_to_scale(figure, name, *drawing_end(shown))
            if isinstance(shown, PositionsPage | InstantPage | InstantsPage | VectorDiagramPage):
                words = spelling.text(shown.title if caption is None else caption)
                return _drawn(shown, figure, words, spelling)
            if isinstance(shown, VectorPage):
                # a page whose scales are true on paper: only what is empty is cut off
                width, height = (float(inches) * INCH for inches in figure.get_size_inches())
                title = shown.title if caption is None else caption
                return drawn_to_scale(figure, spelling.text(title), width, height)
            return picture(figure, spelling.text(shown.title if caption is None else caption))
        case Check():
            return _check(block, spelling)
        case CamPlayer():
            return moving_follower(block.body, _(block.title.text))
        case WheelPlayer():
            return moving_wheel(block.wheel, _(block.title.text))
        case Items(texts, numbered):
            return blocks.ItemsBlock(tuple(map(spelling.text, texts)), numbered)
        case Listing(heading, items):
            return blocks.ParagraphBlock(f"{spelling.text(heading)}: {', '.join(map(spelling.text, items))}")
        case SheetEquations(matrix, unknowns, right):
            rows = tuple(tuple(map(spelling.mathematics, row)) for row in matrix)
            left, right_side = (tuple(map(spelling.mathematics, side)) for side in (unknowns, right))
            return blocks.SystemBlock(rows, left, right_side)
        case SymbolList(symbols):
            entries = tuple(
                (
                    f"${spelling.mathematics(one.symbol)}$",
                    spelling.text(one.value),
                    spelling.text(one.meaning),
                )
                for one in symbols
            )
            heads = (_("symbol"), _("value"), _("meaning"))
            return blocks.TableBlock(heads, entries, "", (False, True, False))
        case _:
            assert_never(block)


def document_picture(drawn: Picture, numbers: Numbers) -> blocks.Picture:
    """A picture of its own, outside any chapter, under its title."""
    spelling = DocumentSpelling(numbers)
    figure = figures_pictures.figure_of(drawn, numbers.display)
    return picture(figure, spelling.text(drawn.title))


def _with_scales(page: GroupPage, name: str) -> str:
    """A caption with what a millimetre stands for: "...; $mu_l$ = 0.02 m/mm, $mu_F$ = 100 N/mm"."""
    scales = (
        f"$mu_{letter}$ = {spelled_number(f'{size:g}')} {spelled_unit(unit)}/{spelled_unit('mm')}"
        for letter, size, unit in group_scales(page)
    )
    return f"{name}; {', '.join(scales)}"


def _drawn(
    page: PositionsPage | InstantPage | InstantsPage | VectorDiagramPage,
    figure: Figure,
    title: str,
    spelling: DocumentSpelling,
) -> blocks.Picture:
    """The drawing of a page without its head and its column, with its scale in the caption."""
    if isinstance(page, VectorDiagramPage):
        factor, unit = spelling.numbers.shown(page.unit)
        scale = factor * page.scale
    else:  # a drawing of a mechanism has axes of its own, in which its scale can be read
        unit, scale = spelling.numbers.shown("m")[1], scale_of(figure)
    caption = _("{title}; 1 mm of the drawing is {scale} {unit}").format(
        title=title, scale=spelling.numbers.plain(scale), unit=unit
    )
    return drawn_to_scale(figure, caption, *_drawing_end(page))


def _drawing_end(page: PositionsPage | InstantPage | InstantsPage | VectorDiagramPage) -> tuple[float, float]:
    """Where the drawing of a page ends at its column of text, and at its head [mm]."""
    if isinstance(page, InstantsPage):
        return INSTANTS
    return POSITIONS if isinstance(page, PositionsPage) else INSTANT


def _table(table: Table, spelling: DocumentSpelling) -> blocks.TableBlock:
    columns = [column for column in table.columns if not column.is_empty]
    heads = tuple(map(spelling.head, columns))
    cells = [_cells(column, table.rows, spelling) for column in columns]
    numbers = tuple(column.is_numeric for column in columns)
    return blocks.TableBlock(heads, tuple(zip(*cells, strict=True)), spelling.text(table.caption), numbers)


def _cells(column: Column, rows: Sequence[int] | None, spelling: DocumentSpelling) -> Sequence[str]:
    """The rows of a column that a document shows; what rounding has left of zero is zero."""
    values = column.values
    if not isinstance(values, np.ndarray):
        return [spelling.text(values[row]) for row in (range(len(values)) if rows is None else rows)]
    if column.units:
        return _cells_of_own_units(column, spelling)
    least = ROUNDING * float(np.max(np.abs(values), where=np.isfinite(values), initial=0.0))
    return spelling.of_column(column).column(
        values if rows is None else values[list(rows)], column.unit, least
    )


def _cells_of_own_units(column: Column, spelling: DocumentSpelling) -> list[str]:
    """Numbers whose rows have units of their own: those of one unit have the same decimals."""
    values, cells = np.asarray(column.values, dtype=float), [""] * len(column.units)
    for unit in dict.fromkeys(column.units):
        rows = [row for row, one in enumerate(column.units) if one == unit]
        least = ROUNDING * float(np.max(np.abs(values[rows]), where=np.isfinite(values[rows]), initial=0.0))
        shown = spelling.of_column(column).column(values[rows], unit, least)
        for row, cell in zip(rows, shown, strict=True):
            cells[row] = cell
    return cells


def _facts(facts: Sequence[Fact], caption: str, spelling: DocumentSpelling) -> blocks.TableBlock:
    rows = tuple((spelling.text(fact.label), spelling.text(fact.value)) for fact in facts)
    return blocks.TableBlock((_("quantity"), _("value")), rows, caption, (False, False))


def _check(check: Check, spelling: DocumentSpelling) -> blocks.CheckBlock:
    """A difference that is no number does not hold; of nothing no share can be given, and only nothing is right."""
    share = check.difference / check.size if check.size else check.difference
    shown = spelled_number(f"{share:.1e}") if share else "0"
    statement = _(check.statement.message).format(
        share=shown, **{name: spelling.text(value) for name, value in check.statement.values.items()}
    )
    part = abs(share) / check.bound if check.bound else abs(share)
    return blocks.CheckBlock(statement, bool(share <= check.bound), check.statement.message, float(part))
