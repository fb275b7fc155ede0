"""Sheets as blocks of JSON for a page that draws itself: numbers stay numbers, words and units are spelled."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, assert_never

import numpy as np

from centrode import render
from centrode.render.drawing.figure_room import screen_of_width
from centrode.render.plain_formulas import relation_lines, symbol_lines, system_lines
from centrode.render.spelling import ScreenSpelling
from centrode.render.terminal import symbol_texts
from centrode.sheets.players import CamPlayer, MotionPlayer, WheelPlayer
from centrode.sheets.plots import CurveDiagram, Plot, TraceKind
from centrode.sheets.sheet import (
    Block,
    Check,
    FactTable,
    Formula,
    Illustration,
    Items,
    Listing,
    Paragraph,
    Reference,
    Section,
    SheetEquations,
    SymbolList,
    Table,
)
from centrode.sheets.texts import NOTHING, Expression, Number, Sentence, Text

if TYPE_CHECKING:
    from centrode.model.settings import Display
    from centrode.sheets.pictures import Picture
    from centrode.sheets.players import MarkedEvent
    from centrode.sheets.plots import Abscissa, AxisLabel, Curve
    from centrode.sheets.sheet import Column, Fact, PointArrows, Sheet

JSON: TypeAlias = dict[str, Any]
Mathematics: TypeAlias = Callable[[Sequence[Formula]], "list[str]"]
"""Formulas as MathML, all of a panel at once."""

ROWS = 400
"""Rows of a table that a page shows; its files have all of them."""
PICTURES = 40
"""Pictures of one panel."""
MARKS = 2000
"""Events that a slider marks: more than it has places."""
TIME_DIGITS = 12
"""Significant digits of the instants of events, which may lie close to each other."""
UNITS = "unit"
"""Name of the column in which tables have the units of their rows."""
DIGITS = 7
"""Significant digits of numbers on their way to a page, which shows fewer."""


def panel_blocks(
    sheet: Sheet,
    display: Display,
    mathematics: Mathematics | None = None,
    *,
    pictures: bool = True,
    sentences: Callable[[str], str] = str,
    width: float | None = None,
) -> list[JSON]:
    """What a page shows of a sheet: its facts, what a terminal prints below them, its pictures and its notes.

    Parameters
    ----------
    mathematics : formulas as MathML; without it they are spelled as on a terminal
    sentences : what the page makes of a translated sentence before its holes are filled
    width : room of the page for a picture [inch], at the size that letters have on it; that of a document if None
    """
    writer = _BlockWriter(display, mathematics, sentences)
    blocks: list[JSON] = []
    if sheet.heading != NOTHING:
        blocks.append({"kind": "heading", "text": writer.spelling.text(sheet.heading)})
    listed = any(player.marks for player in panel_motions(sheet))
    facts = [fact for fact in sheet.facts if not (listed and fact.is_marked)]
    if facts:
        blocks.append(writer.facts(facts))
    for block in sheet.printed:
        blocks += writer.section(block) if isinstance(block, Section) else writer.block(block)
    if sheet.failure is not None:
        parts = (sheet.failure.what, sheet.failure.repair)
        said = "; ".join(filter(None, map(writer.spelling.text, parts)))
        blocks.append({"kind": "paragraph", "text": said})
    for arrows in sheet.arrows.values():
        blocks.append(writer.arrows(arrows))
    if pictures:
        with screen_of_width(width):
            for name in [*sheet.pictures][:PICTURES]:
                blocks += writer.picture(name, sheet.pictures[name])
    blocks += [{"kind": "paragraph", "text": writer.spelling.text(note)} for note in sheet.notes]
    writer.set_formulas()
    return blocks


def panel_motions(sheet: Sheet) -> tuple[MotionPlayer, ...]:
    """The motions of a sheet by the numbers that its blocks of a page give them."""
    blocks = (
        one for block in sheet.printed for one in (block.blocks if isinstance(block, Section) else (block,))
    )
    return tuple(block for block in blocks if isinstance(block, MotionPlayer))


def screen_text(text: Text, display: Display) -> str:
    """A text as a page shows it."""
    return ScreenSpelling(display).text(text)


class _BlockWriter:
    """Writes parts of a sheet as blocks."""

    def __init__(
        self, display: Display, mathematics: Mathematics | None, sentences: Callable[[str], str]
    ) -> None:
        self.display, self.mathematics = display, mathematics
        self.spelling = ScreenSpelling(display, sentences)
        self.formulas: list[tuple[JSON, Formula]] = []
        self.motions = 0

    def set_formulas(self) -> None:
        """Add the MathML of all formulas that were written."""
        if self.mathematics is None or not self.formulas:
            return
        made = self.mathematics([formula for _block, formula in self.formulas])
        for (block, _formula), mathml in zip(self.formulas, made, strict=True):
            block["mathml"] = mathml

    def facts(self, facts: Iterable[Fact]) -> JSON:
        spelled = [
            {"label": self.spelling.text(fact.label), "text": self.spelling.text(fact.value)}
            for fact in facts
        ]
        return {"kind": "facts", "facts": spelled}

    def section(self, section: Section) -> Iterator[JSON]:
        title = self.spelling.text(section.title)
        if title:
            yield {"kind": "heading", "text": title}
        for block in section.blocks:
            yield from self.block(block)

    def block(self, block: Block) -> Iterator[JSON]:
        text = self.spelling.text
        match block:
            case FactTable(facts):
                yield self.facts(facts)
            case Table():
                yield self.table(block)
            case Paragraph(said):
                yield {"kind": "paragraph", "text": text(said)}
            case Items(texts):
                for item in texts:
                    yield {"kind": "paragraph", "text": text(item), "item": True}
            case Listing(heading, items):
                yield {"kind": "paragraph", "text": f"{text(heading)}: {', '.join(map(text, items))}"}
            case Formula():
                yield from self.formula(block)
            case SheetEquations(matrix, unknowns, right):
                entries = [list(map(self.spelling.leaf, row)) for row in matrix]
                sides = (list(map(self.spelling.leaf, side)) for side in (unknowns, right))
                yield {"kind": "formula", "text": "\n".join(system_lines(entries, *sides))}
            case SymbolList(symbols):
                lines = symbol_lines([symbol_texts(one, self.spelling) for one in symbols])
                yield {"kind": "formula", "text": "\n".join(lines)}
            case MotionPlayer():
                yield self.motion(block)
            case Illustration() | Reference() | Check() | CamPlayer() | WheelPlayer():
                return
            case _:
                assert_never(block)

    def motion(self, player: MotionPlayer) -> JSON:
        """A motion that the page plays, by its number among those of the sheet, with what its slider marks."""
        self.motions += 1
        text = self.spelling.text
        marks = [
            {"at": _number(one.time, TIME_DIGITS), "label": text(one.name), "sign": one.sign}
            for one in player.marks[:MARKS]
        ]
        return {
            "kind": "motion",
            "number": self.motions - 1,
            "title": text(player.title),
            "loops": player.loops,
            "marks": marks,
            "held": [
                {
                    "from": _number(one.begin, TIME_DIGITS),
                    "to": _number(one.end, TIME_DIGITS),
                    "label": text(one.name),
                }
                for one in player.held[:MARKS]
            ],
            "events": self.events(player.marks) if player.marks else None,
        }

    def events(self, marks: Sequence[MarkedEvent]) -> JSON:
        """The first events in full: a row for each mark."""
        text = self.spelling.text
        parts: dict[str, tuple[Text, Sequence[Text]]] = {
            "time": (Expression("t"), [Number(one.time, "s") for one in marks[:ROWS]]),
            "event": (Sentence("event"), [one.kind for one in marks[:ROWS]]),
            "part": (Sentence("part of the event"), [one.part for one in marks[:ROWS]]),
            "impulse": (Sentence("impulse"), [one.impulse for one in marks[:ROWS]]),
            "loss": (Sentence("lost energy"), [one.loss for one in marks[:ROWS]]),
        }
        columns = [(head, list(map(text, cells))) for head, cells in parts.values()]
        kept = [(text(head), cells) for head, cells in columns if any(cells)]
        return {
            "title": text(Sentence("Events")),
            "columns": [head for head, _cells in kept],
            "rows": [list(row) for row in zip(*(cells for _head, cells in kept), strict=True)],
            "count": len(marks),
        }

    def formula(self, block: Formula) -> Iterator[JSON]:
        lines = [line for one in block.lines for line in relation_lines(map(self.spelling.leaf, one))]
        written: JSON = {"kind": "formula", "text": "\n".join(lines)}
        self.formulas.append((written, block))
        yield written

    # tables

    def table(self, table: Table) -> JSON:
        columns = [column for column in table.columns if not column.is_empty]
        count = len(columns[0].values) if columns else 0
        # of a long table rows at even distances
        rows = (
            range(count) if count <= ROWS else np.unique(np.linspace(0, count - 1, ROWS).round().astype(int))
        )
        named = any(column.name == UNITS for column in columns)
        cells = [self._cells(column, rows, named) for column in columns]
        return {
            "kind": "table",
            "title": self.spelling.text(table.caption),
            "columns": [self._head(column) for column in columns],
            "rows": [list(row) for row in zip(*cells, strict=True)],
            "shortened": count > ROWS,
        }

    def _head(self, column: Column) -> JSON:
        factor, unit = self._shown(column.unit, column.unit_fixed)
        del factor
        return {
            "head": self.spelling.text(column.head) or column.name,
            "unit": "" if column.units else unit,
            "numeric": column.is_numeric,
        }

    def _cells(self, column: Column, rows: Iterable[int], units_named: bool) -> list[Any]:
        if not isinstance(column.values, np.ndarray):
            return [self.spelling.text(column.values[row]) for row in rows]
        if column.units:
            shown = [(column.values[row], column.units[row]) for row in rows]
            return [
                self.spelling.text(Number(float(value), unit, unit_hidden=units_named))
                for value, unit in shown
            ]
        factor = self._shown(column.unit, column.unit_fixed)[0]
        return [_number(float(column.values[row]) * factor) for row in rows]

    def _shown(self, unit: str, fixed: bool = False) -> tuple[float, str]:
        """Factor from an SI unit to the one that is shown, and how that is spelled."""
        factor, shown = self.spelling.shown_unit(Number(0.0, unit, unit_fixed=fixed))
        return factor, "" if shown in ("", "1") else self.spelling.unit(shown)

    # pictures

    def picture(self, name: str, picture: Picture) -> Iterator[JSON]:
        match picture:
            case Plot() if picture.sizes_above is None and not _has_bands(picture):
                yield from self._plot(name, picture)
            case CurveDiagram():
                yield self._diagram(name, picture)
            case _:
                yield self._drawn(name, picture)

    def _axis(self, label: AxisLabel) -> tuple[float, JSON]:
        factor, unit = self._shown(label.unit, label.unit_fixed)
        symbol = "" if label.symbol is None else self.spelling.symbol(label.symbol)
        words = " ".join(filter(None, (self.spelling.text(label.text), symbol)))
        return factor, {"label": words, "unit": unit}

    def _finer(self, abscissa: Abscissa, curve: Curve, across: float, up: float) -> JSON:
        """The course of a curve through its samples, where it has places between them."""
        if abscissa.samples is None:
            return {}
        values = np.asarray(curve.values, dtype=float)[abscissa.order]
        return {"finer": {"x": _numbers(abscissa.values * across), "values": _numbers(values * up)}}

    def _plot(self, name: str, plot: Plot) -> Iterator[JSON]:
        across, x = self._axis(plot.abscissa.label)
        # what a player follows has one place a sample
        samples = slice(None) if plot.abscissa.samples is None else plot.abscissa.samples
        values = _numbers(plot.abscissa.values[samples] * across)
        ends = None if plot.abscissa.ends is None else [_number(x * across) for x in plot.abscissa.ends]
        title = self.spelling.text(plot.title)
        by_drive = plot.abscissa.label.unit in ("rad", "m", "s")
        for panel in (panel for row in plot.rows for panel in row if panel.curves):
            up, y = self._axis(panel.label)
            curves = [
                {
                    "label": self.spelling.text(curve.name),
                    "unit": y["unit"],
                    "values": _numbers(
                        np.asarray(curve.values, dtype=float)[plot.abscissa.order][samples] * up
                    ),
                    "dashed": curve.approximate,
                    "pen": curve.place,
                    **self._finer(plot.abscissa, curve, across, up),
                }
                for curve in panel.curves
            ]
            yield {
                "kind": "plot",
                "name": name,
                "title": title,
                "x": {**x, "values": values, "ends": ends},
                "y": y,
                "curves": curves,
                "cursor": "drive" if by_drive else None,
                "marks": [
                    {"label": self.spelling.text(place_name), "at": _number(place * across)}
                    for place_name, place in plot.places
                ],
                "shaded": [[_number(end * across) for end in ends] for ends in plot.shaded],
            }

    def _diagram(self, name: str, diagram: CurveDiagram) -> JSON:
        across, x = self._axis(diagram.x)
        up, y = self._axis(diagram.y)
        return {
            "kind": "plot",
            "name": name,
            "title": self.spelling.text(diagram.title),
            "x": {**x, "values": []},
            "y": y,
            "curves": [
                {
                    "label": self.spelling.text(trace.name),
                    "unit": y["unit"],
                    "x": _numbers(trace.x * across),
                    "values": _numbers(trace.y * up),
                    "dashed": trace.kind is not TraceKind.CURVE,
                }
                for trace in diagram.traces
            ],
            "cursor": None,
        }

    def _drawn(self, name: str, picture: Picture) -> JSON:
        title = getattr(picture, "title", None)
        words = name if title is None else self.spelling.text(title)
        svg = render.screen_svg(render.figure_of(picture, self.display), picture)
        return {"kind": "picture", "name": name, "title": words, "svg": svg, "alt": words}

    def arrows(self, arrows: PointArrows) -> JSON:
        factor, unit = self._shown(arrows.unit)
        return {
            "kind": "arrows",
            "title": self.spelling.text(arrows.title),
            "unit": unit,
            "samples": len(arrows.vectors),
            "at": list(arrows.points),
            "vectors": [[_numbers(vector) for vector in sample] for sample in arrows.vectors * factor],
        }


def _number(value: float, digits: int = DIGITS) -> float | None:
    """A number of a few digits; None where there is none."""
    return float(f"{value:.{digits}g}") if np.isfinite(value) else None


def _numbers(values: Any) -> list[float | None]:
    return [_number(float(value)) for value in np.asarray(values).ravel()]


def _has_bands(plot: Plot) -> bool:
    """Whether areas lie behind the curves, which a chart of the page does not have."""
    return any(panel.bands for row in plot.rows for panel in row)
