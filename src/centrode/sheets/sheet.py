"""What there is to say about a result: facts, scalars, tables, figures, and the chapters of a document."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.plots import Diagram, Plot, SpanPlot
from centrode.sheets.texts import NOTHING, Leaf, Sentence, Text

if TYPE_CHECKING:
    import xarray

Picture: TypeAlias = Plot | Diagram | SpanPlot
Part = TypeVar("Part")


@dataclass(frozen=True)
class Fact:
    """A label and what is known under it; a fact without a label continues the one above."""

    label: Text
    value: Text


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
        In documents; the name of the column if left out.
    """

    name: str
    values: NDArray[np.float64] | tuple[Text, ...]
    unit: str = "1"
    head: Text = NOTHING


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
    """Sentences of a document."""

    text: Text


@dataclass(frozen=True)
class Formula:
    """Relations below each other, aligned at their first sign of equality.

    Attributes
    ----------
    lines : each the parts of a = b = ..., the first the left side
    """

    lines: tuple[tuple[Leaf, ...], ...]


@dataclass(frozen=True)
class FactTable:
    """Facts as a table of a document."""

    facts: tuple[Fact, ...]
    caption: Text = NOTHING


@dataclass(frozen=True)
class Illustration:
    """A picture of the sheet in a document, by its name, with a caption; its own title if None."""

    picture: str
    caption: Text | None = None


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


Block: TypeAlias = Paragraph | Formula | Table | FactTable | Illustration | Check


@dataclass(frozen=True)
class Section:
    """A heading and the blocks under it."""

    title: Text
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Chapter:
    """A chapter of a document."""

    title: Sentence
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
class Sheet:
    """Everything there is to say about a result; numbers are in SI.

    Attributes
    ----------
    heading : of the facts, where a terminal prints several sheets of one description
    facts : what a terminal prints
    printed : tables that it prints below them, each under its caption
    failures : what the mechanism cannot do of what its description wants: a command ends with 3
    scalars : name -> number, as `summary.json` holds them
    tables : name of a file without its ending -> table
    datasets : name of a file without its ending -> dataset, as netCDF
    pictures : name -> plot, diagram or scene
    chapters : name -> chapter of a document
    """

    facts: tuple[Fact, ...] = ()
    scalars: Mapping[str, Scalar] = field(default_factory=dict)
    tables: Mapping[str, Table] = field(default_factory=dict)
    datasets: Mapping[str, xarray.Dataset] = field(default_factory=dict)
    pictures: Mapping[str, Picture] = field(default_factory=dict)
    chapters: Mapping[str, Chapter] = field(default_factory=dict)
    heading: Text = NOTHING
    printed: tuple[Table, ...] = ()
    failures: tuple[Text, ...] = ()


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


def illustrations(pictures: Iterable[str], captions: Mapping[str, Text] = MappingProxyType({})) -> Section:
    """The section of the figures of a chapter, each with its own caption or, without one, with its title."""
    figures = tuple(Illustration(name, captions.get(name)) for name in pictures)
    return Section(Sentence("Figures"), figures)
