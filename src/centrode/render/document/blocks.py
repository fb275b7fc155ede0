r"""What a report is made of: plain data, which the renderers of pages and of PDF show alike.

Text is in the reader's language. In a `ParagraphBlock`, `ItemsBlock`, a `CheckBlock`, heads and cells of a `TableBlock`
and in captions every other part between dollar signs is mathematics as the formula printer spells it (typst's
notation); a dollar sign of the text itself is written `\$`. What users named goes through `shown` first: it is shown as
it is. Titles, and why a
chapter is missing, are plain text without mathematics.
"""

from __future__ import annotations

import string
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np

from centrode.model.page_standards import Standard
from centrode.render.document.typst import shown as shown


@dataclass(frozen=True)
class ParagraphBlock:
    """Sentences."""

    text: str


@dataclass(frozen=True)
class ItemsBlock:
    """Sentences below each other, each with a mark; numbered where their order matters."""

    texts: tuple[str, ...]
    numbered: bool = False


@dataclass(frozen=True)
class Span:
    """A stretch of a user's own text, shown as it is."""

    text: str
    strong: bool = False
    emphasized: bool = False
    code: bool = False


@dataclass(frozen=True)
class ProseBlock:
    """What a user wrote about a chapter: a paragraph, or items below each other.

    Attributes
    ----------
    paragraphs : each its stretches; nothing in them is mathematics
    kind : one paragraph, items with marks, items with numbers
    """

    paragraphs: tuple[tuple[Span, ...], ...]
    kind: Literal["paragraph", "bullets", "numbers"] = "paragraph"


@dataclass(frozen=True)
class FormulaBlock:
    """Relations below each other, aligned at their first sign of equality.

    Attributes
    ----------
    lines : each the parts of a = b = ..., the first the left side, as mathematics
    name : by which a `ReferenceBlock` finds it
    number : of the formula in its document, from 1
    """

    lines: tuple[tuple[str, ...], ...]
    name: str = ""
    number: int = 0


@dataclass(frozen=True)
class SystemBlock:
    """matrix unknowns = right, as mathematics; its `number` in the document counts from 1, with those of formulas."""

    matrix: tuple[tuple[str, ...], ...]
    unknowns: tuple[str, ...]
    right: tuple[str, ...]
    number: int = 0


@dataclass(frozen=True)
class ReferenceBlock:
    """A sentence with numbers of formulas.

    Attributes
    ----------
    text : plain, with a hole {name} for each name of formulas
    numbers : name -> numbers of its formulas; empty until the document is numbered
    """

    text: str
    numbers: Mapping[str, tuple[int, ...]] = field(default_factory=dict)

    @property
    def names(self) -> tuple[str, ...]:
        """Of the formulas."""
        return tuple(name for _text, name, *_rest in string.Formatter().parse(self.text) if name)

    @property
    def pieces(self) -> tuple[str | int, ...]:
        """The sentence, with the numbers of formulas as numbers in their places."""
        found: list[str | int] = []
        for text, name, *_rest in string.Formatter().parse(self.text):
            found.append(text)
            for place, number in enumerate(self.numbers[name] if name else ()):
                found += [", ", number] if place else [number]
        return tuple(piece for piece in found if piece != "")


@dataclass(frozen=True)
class TableBlock:
    """Rows under heads.

    Attributes
    ----------
    head : names of the columns, with their units
    rows : cells as text, in the language's spelling of numbers
    caption : what the rows are
    numbers : True for columns of numbers, which are set flush right
    number : of the table in its document, from 1; 0 of a table that has none
    """

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str = ""
    numbers: tuple[bool, ...] = ()
    number: int = 0


@dataclass(frozen=True)
class Picture:
    """A figure as SVG, with its caption and its natural width [inches]; `to_scale` is kept at that width on paper.

    Its `number` in the document counts from 1; it is 0 of a figure that has none. Its `description` tells those who do
    not see it what curves it shows.
    """

    svg: bytes
    caption: str
    width: float
    to_scale: bool = False
    number: int = 0
    description: str = ""


@dataclass(frozen=True)
class CheckBlock:
    """How something was verified: by what second route, how far it is off, and what was allowed.

    Attributes
    ----------
    text : the statement with its numbers
    holds : whether it does
    kind : the statement without them, the same for the same check of another instant
    part : of what was allowed
    """

    text: str
    holds: bool
    kind: str = ""
    part: float = 0.0


@dataclass(frozen=True)
class Outline:
    """Lines that move as one body: a slot, a wheel, a cam.

    Attributes
    ----------
    corners : (n, 2) [m] in axes of its own; a row of NaN lifts the pen
    poses : (samples, 3): where these axes are, x and y [m] and their angle [rad]; one row for what stands still
    colour : of its lines, "#RRGGBB"
    filled : lightly; then it is closed
    behind : under the links
    white : filled with white, over the links: a block, a barrel
    """

    corners: np.ndarray
    poses: np.ndarray
    colour: str
    filled: bool = False
    behind: bool = True
    white: bool = False


@dataclass(frozen=True)
class RingBlock:
    """A circle on the sphere.

    Attributes
    ----------
    poles : (samples, 3) unit vectors; one row for what stands still
    arc : its radius [rad]
    colour : of its line, "#RRGGBB"
    """

    poles: np.ndarray
    arc: float
    colour: str


@dataclass(frozen=True)
class Moving:
    """A motion that a page plays, step by step and by dragging the drive; a PDF shows its first picture.

    Attributes
    ----------
    places : name of a point -> its places (samples, 2) [m], on the sphere (samples, 3); NaN where it has none, one row
        for what stands still
    bodies : name of a link -> names of its points, drawn as lines between them
    fixed : names of the points of the frame
    guides : name of a guide -> two ends (2, 2) [m] of the line that is drawn
    sliders : name of a point on a guide -> the guide
    drive : values of the drive (samples), as text with unit in `drive_texts`
    tracks : names of the points whose paths are drawn
    still : the first picture, for paper
    shapes : what moves beside the lines of links
    view : on the sphere (3, 3): to the right, up and towards the eye, as rows
    driven : names of the points that the drive moves
    dots : names of the points of one link alone, where nothing is hinged
    start : the sample shown first
    box : lower left and upper right corner (2, 2) [m] of what is seen; all places if None
    number : of the figure in its document, from 1; 0 of one that has none
    marks : (share of the way from the first to the last sample, name, sign) of the events that the slider marks
    held : (two such shares, name) of the stretches that it shades
    """

    places: Mapping[str, np.ndarray]
    bodies: Mapping[str, tuple[str, ...]]
    fixed: tuple[str, ...]
    guides: Mapping[str, np.ndarray]
    sliders: Mapping[str, str]
    drive: np.ndarray
    drive_texts: tuple[str, ...]
    tracks: tuple[str, ...]
    still: Picture
    caption: str
    shapes: tuple[Outline | RingBlock, ...] = ()
    view: np.ndarray | None = None
    driven: tuple[str, ...] = ()
    dots: tuple[str, ...] = ()
    start: int = 0
    box: np.ndarray | None = None
    number: int = 0
    marks: tuple[tuple[float, str, str], ...] = ()
    held: tuple[tuple[float, float, str], ...] = ()


Block: TypeAlias = (
    ParagraphBlock
    | ProseBlock
    | ItemsBlock
    | FormulaBlock
    | SystemBlock
    | ReferenceBlock
    | TableBlock
    | Picture
    | CheckBlock
    | Moving
)


@dataclass(frozen=True)
class SectionBlocks:
    """A heading below a chapter's, and what stands under it.

    `written` says where a user's own text has its place, before or after what is computed; else it is empty.
    """

    title: str
    blocks: tuple[Block, ...]
    written: Literal["", "before", "after"] = ""


@dataclass(frozen=True)
class ChapterBlocks:
    """A chapter.

    Attributes
    ----------
    name, title, sections : of the chapter
    missing : why it could not be made, and what would help
    computed : False where it only says why nothing was computed
    code : what computes it in a notebook
    role : a numbered chapter, what stands before the contents, what has no number, or an appendix
    part : title of the chapter of a note that it is a section of; empty of one that stands for itself
    """

    name: str
    title: str
    sections: tuple[SectionBlocks, ...] = ()
    missing: str = ""
    computed: bool = True
    code: str = ""
    role: Literal["chapter", "front", "element", "appendix"] = "chapter"
    part: str = ""


@dataclass(frozen=True)
class TitlePageBlocks:
    """Lines of a title page, as plain text; what is empty is not there.

    Attributes
    ----------
    head : where the work is done, line by line from the top
    work, course, title, variant : in the middle
    people : what somebody did, and who
    foot : place and year
    """

    head: tuple[str, ...]
    work: str
    course: str
    title: str
    variant: str
    people: tuple[tuple[str, str], ...]
    foot: str


@dataclass(frozen=True)
class DescriptionText:
    """What a report is about, as a file: a notebook computes everything anew from it.

    Attributes
    ----------
    text : of the description (TOML)
    subject : "mechanism", "cam", "gear pair" or "gear train"
    instants : values of the drive that are shown [rad or m; s with several drives]
    """

    text: str
    subject: Literal["mechanism", "cam", "gear pair", "gear train"]
    instants: tuple[float, ...] = ()


@dataclass(frozen=True)
class Report:
    """A whole document.

    Attributes
    ----------
    title, subtitle : shown on the first page; the subtitle says what was computed, by which version
    language : "en", "ru" or "uk": hyphenation, and the word for contents
    chapters : in the order of the document
    opening : blocks below the title, before the contents: the kinematic scheme
    description : what the report is about; None of a sheet about many
    standard : of the page and the captions
    title_page : None where there is none
    is_note : contents stand behind what comes before them, and the opening in the first numbered chapter
    """

    title: str
    subtitle: str
    language: str
    chapters: tuple[ChapterBlocks, ...] = field(default=())
    opening: tuple[Block, ...] = ()
    description: DescriptionText | None = None
    standard: Standard = "plain"
    title_page: TitlePageBlocks | None = None
    is_note: bool = False

    def __repr__(self) -> str:
        """Its title and chapters: all its blocks would fill many screens."""
        return f"Report({self.title!r}, chapters={[chapter.name for chapter in self.chapters]})"
