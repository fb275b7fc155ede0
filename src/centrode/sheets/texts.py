"""Texts before they are spelled: sentences in English with typed holes for names, numbers and further texts.

A renderer chooses the language, the grammatical number, the decimal mark and the spelling of units; so a name is never
mistaken for a number or a unit, whatever a user has called a link. The sentence itself holds no digit and no unit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from centrode.sheets.symbolic import SymbolicLeaf


@dataclass(frozen=True)
class Name:
    """What a user called something: every renderer shows it character by character."""

    text: str


@dataclass(frozen=True)
class Title:
    """The title of a mechanism: translated where it is that of a built-in example, otherwise shown as it is."""

    text: str


@dataclass(frozen=True)
class Number:
    """A quantity.

    Attributes
    ----------
    value : float
        In `unit`.
    unit : str
        SI unit ("kg m^2", "1" for a plain number); lengths and angles appear in the units of the display. In prose "°"
        for an angle in degrees for every reader.
    digits : str
        Python's format of the number: ".6g", ".1e", "+.2%"; a document never shows more digits than it is set to, and
        formulas and columns have a rule of their own. Empty: as many digits as the document is set to; "+": so many,
        with the sign of a positive number as well. A value that is no number is shown as a dash.
    unit_fixed : bool
        The unit stays whatever the display says: speeds of machines in rad/s, terms of one formula in SI.
    unit_hidden : bool
        Without the unit, which stands elsewhere in the sentence.
    degrees_too : bool
        Angles that appear in radians have degrees behind them in brackets, as people think of positions.
    """

    value: float
    unit: str = "1"
    digits: str = ".6g"
    unit_fixed: bool = False
    unit_hidden: bool = False
    degrees_too: bool = False


@dataclass(frozen=True)
class Factor:
    """A number as a factor of a product in a formula: in brackets where it is negative or has a power of ten."""

    number: Number


@dataclass(frozen=True, init=False)
class Sentence:
    """A sentence or a phrase; `message` is its English text and its key in the catalogues.

    Each hole `{name}` is filled with the text of that name in `values`. Between dollar signs stands mathematics in the
    notation of `Expression`, which documents set.
    """

    message: str
    values: Mapping[str, Text]

    def __init__(self, message: str, /, **values: Text) -> None:
        object.__setattr__(self, "message", message)
        object.__setattr__(self, "values", values)

    def fill(self, **values: Text) -> Sentence:
        """The same sentence with these texts in its holes: sentences of one kind stand in a table without them."""
        return Sentence(self.message, **values)


@dataclass(frozen=True, init=False)
class Counted:
    """A sentence that depends on how many there are: the renderer chooses the grammatical number.

    `{n}` is the count.
    """

    singular: str
    plural: str
    count: int
    values: Mapping[str, Text]

    def __init__(self, singular: str, plural: str, count: int, /, **values: Text) -> None:
        object.__setattr__(self, "singular", singular)
        object.__setattr__(self, "plural", plural)
        object.__setattr__(self, "count", count)
        object.__setattr__(self, "values", values)


@dataclass(frozen=True)
class Joined:
    """Texts one behind the other.

    Attributes
    ----------
    parts : texts
    between : str
        What parts them: ", ", "; ", or nothing.
    """

    parts: Sequence[Text]
    between: str = ", "


@dataclass(frozen=True)
class Symbol:
    """A letter of a formula.

    Attributes
    ----------
    letter : str
        As the vocabulary of quantities writes it, with primes: "φ", "J′".
    index : str
        Upright below it: "II"; names of points and axes as well.
    slanted : bool
        The index is a variable ("x"), not a name.
    """

    letter: str
    index: str = ""
    slanted: bool = False


@dataclass(frozen=True, init=False)
class Expression:
    """Mathematics with typed leaves.

    Attributes
    ----------
    notation : str
        In typst's notation ("frac({work}, 2 pi)"), which the renderers of pages and of PDF read; holes are filled with
        numbers, factors, names and expressions. Braces of the notation itself are doubled.
    values : mapping of name -> leaf
    """

    notation: str
    values: Mapping[str, Leaf]

    def __init__(self, notation: str, /, **values: Leaf) -> None:
        object.__setattr__(self, "notation", notation)
        object.__setattr__(self, "values", values)


@dataclass(frozen=True)
class Unit:
    """An SI unit on its own, in a table whose rows have units of their own; `shown` as the unit of the display."""

    unit: str
    shown: bool = False


@dataclass(frozen=True)
class Place:
    """A place or a direction by its coordinates.

    Attributes
    ----------
    coordinates : along the axes, in `unit`
    unit : SI unit; "1" of a unit vector
    digits : as of a number
    """

    coordinates: tuple[float, ...]
    unit: str = "m"
    digits: str = ""


@dataclass(frozen=True)
class Part:
    """What belongs to the entry above it: indented on a terminal, behind a dash in a document."""

    text: Text


@dataclass(frozen=True)
class Setting:
    """What to write into a description; a terminal names its own option beside it.

    Attributes
    ----------
    line : 'range = "reachable"'
    table : str
        Under which it stands: "study".
    option : str
        Of the command, with its value: "--range reachable".
    """

    line: str
    table: str
    option: str


@dataclass(frozen=True)
class Indexed:
    """A letter with numbers of bodies as its index: P20 is the centre of bodies 2 and 0."""

    letter: str
    index: str


@dataclass(frozen=True)
class Slanted:
    """What a user called something, as the index of a formula's letter: Latin letters slanted, as in equations."""

    text: str


@dataclass(frozen=True, init=False)
class VectorNotation:
    """A relation between vectors, their lengths and angular rates, as constructions on paper write it.

    Attributes
    ----------
    notation : str
        "v_B = v_A + v_BA (⊥ BA)", "aⁿ_BA", "|v_B|", "ω_AB": a letter, the mark of a part, and what it belongs to.
    values : mapping of name -> Number
        Holes `{name}` are filled with numbers, which have no unit but the sign of degrees of the notation itself.
    """

    notation: str
    values: Mapping[str, Number]

    def __init__(self, notation: str, /, **values: Number) -> None:
        object.__setattr__(self, "notation", notation)
        object.__setattr__(self, "values", values)


Leaf: TypeAlias = (
    "str | Number | Factor | Name | Slanted | Expression | Sentence | Symbol | Indexed | VectorNotation"
    " | SymbolicLeaf"
)
"""A piece of a formula; a string is notation without leaves of its own, a sentence is words among the letters."""
Text: TypeAlias = (
    "Name | Title | Number | Sentence | Counted | Joined | Symbol"
    " | Expression | Unit | Part | Place | Setting | Indexed | VectorNotation | Slanted | SymbolicLeaf"
)

NOTHING = Joined(())
"""An empty text."""
