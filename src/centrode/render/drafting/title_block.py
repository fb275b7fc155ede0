"""Frame and main inscription of a sheet: GOST 2.104, form 1; DSTU GOST 2.104 is the same form in Ukrainian."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from centrode.locale import _
from centrode.render.drafting.drawing_page import (
    BINDING,
    HEADING,
    MARGIN,
    SMALLEST,
    USUAL,
    DrawingPage,
    SheetField,
)
from centrode.render.drafting.recorder import MAIN, THIN
from centrode.render.drawing.texts import plain

if TYPE_CHECKING:
    from centrode.sheets.drawing_sheets import TitleBlock

WIDE, HIGH = 185.0, 55.0
"""Sides of the main inscription [mm]."""
ROW = 5.0
CHANGES = (0.0, 7.0, 17.0, 40.0, 55.0, 65.0)
"""Where the columns of changes begin, and the last ends [mm]."""
RIGHT = 135.0
"""Where the columns at the right begin [mm]."""
LETTER, MASS, SCALE, END = 135.0, 150.0, 167.0, 185.0
"""Columns of letter, mass and scale [mm]."""
SHEETS = 155.0
"""Where the number of sheets begins [mm]."""
TURNED = 70.0, 14.0
"""Sides of the field at the upper left corner of the frame, which repeats the designation upside down [mm]."""
SMALL = 2.0, 1.8
"""Heights of letters in the columns of changes and of signatures [mm], which hold whole words."""
COURSE = 6.0
"""Height of the line of the course below the designation [mm]."""
LAYER, LINES, STRONG = "title-block", "title-block", "title-block-main"


@dataclass(frozen=True)
class Inscription:
    """What the main inscription of one sheet says.

    Attributes
    ----------
    block : of all sheets
    names : of all sheets; those of one work have letters of one height
    number : of this sheet, counted from 1
    scale : of this sheet
    """

    block: TitleBlock
    names: tuple[str, ...]
    number: int
    scale: str

    @property
    def titles(self) -> list[str]:
        """Title of the work and name of the sheet, of every sheet."""
        return ["\n".join(filter(None, (plain(self.block.title), name))) for name in self.names]


def drawing_field(size: tuple[float, float]) -> SheetField:
    """The field inside the frame."""
    return SheetField.between(BINDING, MARGIN, size[0] - MARGIN, size[1] - MARGIN)


def block_field(size: tuple[float, float]) -> SheetField:
    """The field of the main inscription, in the lower right corner of the frame."""
    right = size[0] - MARGIN
    return SheetField.between(right - WIDE, MARGIN, right, MARGIN + HIGH)


def turned_field(size: tuple[float, float]) -> SheetField:
    """The field of the repeated designation, in the upper left corner of the frame."""
    top = size[1] - MARGIN
    return SheetField.between(BINDING, top - TURNED[1], BINDING + TURNED[0], top)


def draw_frame(page: DrawingPage, said: Inscription) -> None:
    """Frame, main inscription and the repeated designation."""
    _rectangle(page, drawing_field(page.size), "frame")
    block = block_field(page.size)
    _rectangle(page, block, STRONG)
    _lines(page, block)
    _words(page, block, said)
    turned = turned_field(page.size)
    _rectangle(page, turned, STRONG)
    if said.block.designation:
        page.fit(turned, plain(_designation(said)), (HEADING, USUAL, SMALLEST), LAYER, rotation=180.0)


def _designation(said: Inscription) -> str:
    return f"{said.block.designation}.{said.number:02d}" if said.block.designation else ""


def _rectangle(page: DrawingPage, field: SheetField, layer: str) -> None:
    (left, low), (right, top) = field.corner, field.end
    page.line([(left, low), (right, low), (right, top), (left, top), (left, low)], MAIN, layer)


def _lines(page: DrawingPage, block: SheetField) -> None:
    """Lines of the form: main between its parts, thin between rows of signatures."""
    x, y = block.corner

    def across(up: float, first: float, last: float, width: float = MAIN) -> None:
        layer = STRONG if width == MAIN else LINES
        page.line([(x + first, y + up), (x + last, y + up)], width, layer)

    def upright(right: float, low: float, high: float, width: float = MAIN) -> None:
        page.line([(x + right, y + low), (x + right, y + high)], width, STRONG if width == MAIN else LINES)

    for row in range(1, 11):
        across(row * ROW, 0.0, CHANGES[-1], MAIN if row in (6, 7) else THIN)
    upright(CHANGES[1], 6 * ROW, HIGH)
    for column in CHANGES[2:]:
        upright(column, 0.0, HIGH)
    across(3 * ROW, CHANGES[-1], WIDE)
    across(8 * ROW, CHANGES[-1], WIDE)
    upright(RIGHT, 0.0, 8 * ROW)
    across(7 * ROW, RIGHT, WIDE)
    across(4 * ROW, RIGHT, WIDE)
    upright(MASS, 4 * ROW, 8 * ROW)
    upright(SCALE, 4 * ROW, 8 * ROW)
    for column in (LETTER + 5.0, LETTER + 10.0):
        upright(column, 4 * ROW, 7 * ROW, THIN)
    upright(SHEETS, 3 * ROW, 4 * ROW)


def _words(page: DrawingPage, block: SheetField, said: Inscription) -> None:
    x, y = block.corner

    def write(
        left: float, low: float, right: float, top: float, text: str, *heights: float, start: bool = False
    ) -> None:
        if text:
            field = SheetField.between(x + left, y + low, x + right, y + top)
            page.fit(field, text, heights or (SMALLEST, 2.0, 1.8), LAYER, start)

    heads = (_("Rev."), _("Sheet"), _("Doc. no."), _("Sign."), _("Date"))
    for text, left, right in zip(heads, CHANGES, CHANGES[1:], strict=False):
        write(left, 6 * ROW, right, 7 * ROW, text, *SMALL)
    roles = (
        (_("Drawn"), said.block.author),
        (_("Chkd."), said.block.teacher),
        (_("Tech. ch."), ""),
        ("", ""),
        (_("Std. ch."), ""),
        (_("Approved"), ""),
    )
    for row, (role, name) in enumerate(roles):
        low, top = (5 - row) * ROW, (6 - row) * ROW
        write(0.0, low, CHANGES[2], top, role, *SMALL, start=True)
        write(CHANGES[2], low, CHANGES[3], top, plain(name), SMALLEST, 2.0, 1.6, 1.3, start=True)
    course = plain(said.block.course)
    above = 8 * ROW + (COURSE if course else 0.0)
    write(CHANGES[-1], above, WIDE, HIGH, plain(_designation(said)), 7.0, HEADING, USUAL)
    write(CHANGES[-1], 8 * ROW, WIDE, above, course, USUAL, SMALLEST, 2.0, 1.6)
    field = SheetField.between(x + CHANGES[-1], y + 3 * ROW, x + RIGHT, y + 8 * ROW)
    height = page.largest_height(field, said.titles, (HEADING, USUAL, SMALLEST, 2.0))
    write(CHANGES[-1], 3 * ROW, RIGHT, 8 * ROW, said.titles[said.number - 1], height)
    write(LETTER, 7 * ROW, MASS, 8 * ROW, _("Lit."))
    write(MASS, 7 * ROW, SCALE, 8 * ROW, _("Mass"))
    write(SCALE, 7 * ROW, END, 8 * ROW, _("Scale"))
    write(SCALE, 4 * ROW, END, 7 * ROW, said.scale, HEADING, USUAL, SMALLEST)
    write(LETTER, 3 * ROW, SHEETS, 4 * ROW, _("Sheet {number}").format(number=said.number))
    write(SHEETS, 3 * ROW, END, 4 * ROW, _("Sheets {count}").format(count=len(said.names)))
    organisation = "\n".join(plain(line) for line in said.block.organisation)
    write(RIGHT, 0.0, END, 3 * ROW, organisation, USUAL, SMALLEST, 2.0, 1.6)
