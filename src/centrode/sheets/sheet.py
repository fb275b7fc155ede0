"""What there is to say about a result: facts, scalars, tables, figures, and the chapters of a document."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.players import CamPlayer, MotionPlayer, WheelPlayer
from centrode.sheets.texts import NOTHING, Joined, Leaf, Name, Number, Sentence, Text

if TYPE_CHECKING:
    import xarray

    # A sheet without pictures loads none of their kinds: a command that only prints starts sooner.
    from centrode.sheets.outlines import OutlineSet
    from centrode.sheets.pictures import Picture

Part = TypeVar("Part")


@dataclass(frozen=True)
class Fact:
    """A label and what is known under it; a fact without a label continues the one above.

    Attributes
    ----------
    label, value : texts
    is_marked : whether it is an event that the player of the sheet marks and lists; a page does not say it twice
    """

    label: Text
    value: Text
    is_marked: bool = False


def _is_number(text: Text) -> bool:
    """Whether a text is a number, alone or with words behind it; what a number and a name make is a name."""
    if isinstance(text, Joined):
        names = any(isinstance(part, Name) for part in text.parts)
        return isinstance(text.parts[0], Number) and not names
    return isinstance(text, Number)


@dataclass(frozen=True)
class Column:
    """A column of a table.

    Attributes
    ----------
    name : str
        In files: ASCII words and names, without the unit.
    values : (rows) numbers in `unit`, or texts
    unit : str
        SI unit; the renderer converts lengths and angles to the units of the display.
    head : text
        In documents and on terminals; the name of the column if left out.
    unit_fixed : bool
        The unit stays whatever the display says: tables that are in SI for every reader.
    whole : bool
        The numbers are whole, and files write them so; NaN is an empty field all the same.
    units : tuple of str
        SI unit of each row, where rows have units of their own, which another column names; empty otherwise.
    detail : bool
        Only the full form of a document shows it.
    """

    name: str
    values: NDArray[np.float64] | NDArray[np.int64] | tuple[Text, ...]
    unit: str = "1"
    head: Text = NOTHING
    unit_fixed: bool = False
    whole: bool = False
    units: tuple[str, ...] = ()
    detail: bool = False

    @property
    def is_numeric(self) -> bool:
        """Whether it holds numbers, with or without words behind them, which stand flush right."""
        if isinstance(self.values, np.ndarray):
            return True
        known = [text for text in self.values if text != NOTHING]
        return bool(known) and all(map(_is_number, known))

    @property
    def is_empty(self) -> bool:
        """Whether it has rows, and no text in any of them."""
        if isinstance(self.values, np.ndarray) or not self.values:
            return False
        return all(text == NOTHING for text in self.values)


@dataclass(frozen=True)
class Table:
    """Columns of one length.

    Attributes
    ----------
    columns : at least one
    caption : what the rows are
    rows : numbers of the rows that a document shows; all if None. Files have all of them
    """

    columns: tuple[Column, ...]
    caption: Text = NOTHING
    rows: tuple[int, ...] | None = None


@dataclass(frozen=True)
class Paragraph:
    """Sentences of a document; of a `clause` it makes a sentence, with a capital letter and a full stop."""

    text: Text
    clause: bool = False


@dataclass(frozen=True)
class Formula:
    """Relations below each other, aligned at their first sign of equality.

    Attributes
    ----------
    lines : each the parts of a = b = ..., the first the left side
    name : by which a `Reference` finds it; several formulas may share one
    """

    lines: tuple[tuple[Leaf, ...], ...]
    name: str = ""


@dataclass(frozen=True)
class Reference:
    """A sentence of a document whose holes are names of formulas: their numbers stand there.

    It is left out where the document has no formula of such a name.
    """

    text: Sentence


@dataclass(frozen=True)
class FactTable:
    """Facts as a table of a document."""

    facts: tuple[Fact, ...]
    caption: Text = NOTHING


@dataclass(frozen=True)
class Illustration:
    """A picture of the sheet by its name, or one of a document alone, with a caption; its own title if None.

    A `detail` is shown by the full form of a document alone.
    """

    picture: str | Picture
    caption: Text | None = None
    detail: bool = False


@dataclass(frozen=True)
class Check:
    """How a result was verified.

    Attributes
    ----------
    statement : with the hole {share}: by which share of its size two routes differ
    difference, size : of the two routes, and of what they give; of nothing only nothing is right
    bound : the share that rounding or conditioning allows
    """

    statement: Sentence
    difference: float
    size: float
    bound: float


@dataclass(frozen=True)
class Items:
    """Texts below each other; on a terminal a paragraph before them is their heading. Documents number steps."""

    texts: tuple[Text, ...]
    numbered: bool = False


@dataclass(frozen=True)
class Listing:
    """A heading and what is listed behind it; no item is broken over two lines."""

    heading: Text
    items: tuple[Text, ...]


@dataclass(frozen=True)
class SheetEquations:
    """matrix unknowns = right.

    Attributes
    ----------
    matrix : (n, n) entries
    unknowns, right : (n)
    """

    matrix: tuple[tuple[Leaf, ...], ...]
    unknowns: tuple[Leaf, ...]
    right: tuple[Leaf, ...]


@dataclass(frozen=True)
class ExplainedSymbol:
    """A symbol of formulas, its value, and what it stands for."""

    symbol: Leaf
    value: Text
    meaning: Text


@dataclass(frozen=True)
class SymbolList:
    """Symbols of formulas with their values and meanings."""

    symbols: tuple[ExplainedSymbol, ...]


Block: TypeAlias = (
    Paragraph
    | Formula
    | Reference
    | Table
    | FactTable
    | Illustration
    | Check
    | Items
    | Listing
    | SheetEquations
    | SymbolList
    | MotionPlayer
    | CamPlayer
    | WheelPlayer
)


@dataclass(frozen=True)
class Section:
    """A heading and the blocks under it; a `detail` is shown by the full form of a document alone."""

    title: Text
    blocks: tuple[Block, ...]
    detail: bool = False


@dataclass(frozen=True)
class Chapter:
    """A chapter of a document."""

    title: Text
    sections: tuple[Section, ...]


@dataclass(frozen=True)
class Scalar:
    """One number of a summary, in SI."""

    value: float | int
    unit: str

    def as_dict(self) -> dict[str, float | int | str]:
        """As `summary.json` holds it."""
        return {"value": self.value, "unit": self.unit}


@dataclass(frozen=True)
class PointArrows:
    """Vectors at points over a motion, which a moving picture draws.

    Attributes
    ----------
    title : what they are
    unit : SI unit
    points : where each begins
    vectors : (samples, points, 2); NaN where there is none
    """

    title: Text
    unit: str
    points: tuple[str, ...]
    vectors: NDArray[np.float64]


@dataclass(frozen=True)
class Failure:
    """Why a result falls short of what a command computes, although there is something to show; and what helps."""

    what: Text
    repair: Text = NOTHING


@dataclass(frozen=True)
class Sheet:
    """Everything there is to say about a result; numbers are in SI.

    Attributes
    ----------
    heading : of the facts, where a terminal prints several sheets of one description
    facts : what a terminal prints
    scalars : name -> number, as `summary.json` holds them
    tables : name of a file without its ending -> table
    datasets : name of a file without its ending -> dataset, as netCDF
    pictures : name -> plot, diagram or scene
    chapters : name -> chapter of a document
    printed : what a terminal prints below the facts; the title of a section stands on the line above it
    files : name of a further file -> its text
    record : the result as JSON holds it, in SI and in English; None where a result has no such form
    failure : what ends a command after everything is shown and written; None if nothing does
    notes : what a reader should know besides; a terminal prints them behind all
    brief : what a result that has this one as a part shows of it among its own facts; without it, all its facts below
    outlines : name of a file without its ending -> outlines, as SVG and DXF
    arrows : name -> vectors at points over the motion, as a moving picture shows them
    """

    facts: tuple[Fact, ...] = ()
    scalars: Mapping[str, Scalar] = field(default_factory=dict)
    tables: Mapping[str, Table] = field(default_factory=dict)
    datasets: Mapping[str, xarray.Dataset] = field(default_factory=dict)
    pictures: Mapping[str, Picture] = field(default_factory=dict)
    chapters: Mapping[str, Chapter] = field(default_factory=dict)
    printed: tuple[Block | Section, ...] = ()
    files: Mapping[str, str] = field(default_factory=dict)
    record: Mapping[str, Any] | None = None
    failure: Failure | None = None
    heading: Text = NOTHING
    outlines: Mapping[str, OutlineSet] = field(default_factory=dict)
    notes: tuple[Text, ...] = ()
    brief: tuple[Fact, ...] = ()
    arrows: Mapping[str, PointArrows] = field(default_factory=dict)

    def with_parts(self, parts: Mapping[str, Sheet]) -> Sheet:
        """A sheet with what the sheets of the parts of its result have for a terminal and for files.

        The files and pictures of a part are in a folder of its name. Chapters are its own. The parts of a part are in
        its sheet already. What a part falls short of is no failure of the whole.
        """
        sheets = (self, *(part._in_folder(name) for name, part in parts.items()))
        below = (FactTable(part.facts) for part in parts.values() if part.facts and not part.brief)
        return replace(
            self,
            facts=(*self.facts, *(fact for part in parts.values() for fact in part.brief)),
            scalars={name: scalar for sheet in sheets for name, scalar in sheet.scalars.items()},
            tables=_merge(sheet.tables for sheet in sheets),
            datasets=_merge(sheet.datasets for sheet in sheets),
            pictures=_merge(sheet.pictures for sheet in sheets),
            printed=(*self.printed, *below),
            files=_merge(sheet.files for sheet in sheets),
            outlines=_merge(sheet.outlines for sheet in sheets),
            notes=tuple(note for sheet in sheets for note in sheet.notes),
        )

    def _in_folder(self, folder: str) -> Sheet:
        """The sheet whose files and pictures are named behind a folder."""
        return replace(
            self,
            tables=_behind(folder, self.tables),
            datasets=_behind(folder, self.datasets),
            pictures=_behind(folder, self.pictures),
            files=_behind(folder, self.files),
            outlines=_behind(folder, self.outlines),
        )


class Deferred(Mapping[str, Part]):
    """Parts of a sheet by name, each made when it is looked up: a command without figures makes none.

    Parameters
    ----------
    makers : name -> what makes the part
    """

    def __init__(self, makers: Mapping[str, Callable[[], Part]]) -> None:
        self._makers = makers

    def __getitem__(self, name: str) -> Part:
        return self._makers[name]()

    def __iter__(self) -> Iterator[str]:
        return iter(self._makers)

    def __len__(self) -> int:
        return len(self._makers)

    def __contains__(self, name: object) -> bool:
        return name in self._makers


def _merge(mappings: Iterable[Mapping[str, Part]]) -> Mapping[str, Part]:
    """All entries by name; what costs is still made when it is looked up."""
    return Deferred({name: partial(mapping.__getitem__, name) for mapping in mappings for name in mapping})


def _behind(folder: str, mapping: Mapping[str, Part]) -> Mapping[str, Part]:
    """Entries by their name behind a folder; what costs is still made when it is looked up."""
    return Deferred({f"{folder}/{name}": partial(mapping.__getitem__, name) for name in mapping})


def illustrations(
    pictures: Iterable[str],
    captions: Mapping[str, Text] = MappingProxyType({}),
    details: Collection[str] = (),
) -> Section:
    """The figures of a chapter, each with its own caption or, without one, with its title.

    Those among the `details` are shown by the full form of a document alone.
    """
    figures = tuple(Illustration(name, captions.get(name), name in details) for name in pictures)
    return Section(NOTHING, figures)
