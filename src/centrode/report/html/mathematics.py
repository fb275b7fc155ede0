"""Formulas as MathML: one run of typst for all formulas of a page, of which only the formulas themselves are kept."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any
from xml.etree import ElementTree as Xml

import typst

from centrode.report.mathematics import fragments_of

FORMULA = re.compile(r"<math\b.*?</math>", re.DOTALL)
STYLE = re.compile(r"<style>(.*?)</style>", re.DOTALL)
ARROW = "\u20d7"
RADICAL, ROOTS = "\u221a", ("msqrt", "mroot")
ABOVE = {"\u0307": "\u02d9", "\u0308": "\u00a8", ARROW: "\u2192"}
"""Combining signs stand left of their letter in browsers; the spacing ones stand above it."""
SIGNS = {"+", "\u2212", "-", "±", "∓"}
PRIMES = {"\u2032", "\u2033", "\u2034"}
"""Browsers take for a superscript the letter that is raised by itself, and raise it twice."""


@dataclass(frozen=True)
class Formulas:
    """MathML of formulas by their spelling, and the rules that lay it out."""

    found: Mapping[str, Xml.Element]
    style: str

    @property
    def letters(self) -> frozenset[str]:
        """All letters of the formulas, and the sign of roots, which no text of theirs has."""
        found = frozenset(letter for one in self.found.values() for text in one.itertext() for letter in text)
        rooted = any(part.tag in ROOTS for one in self.found.values() for part in one.iter())
        return found | {RADICAL} if rooted else found

    def inline(self, spelled: str) -> str:
        """A formula in a sentence."""
        return _written(list(self.found[spelled]))

    def display_formula(self, spelled: str) -> str:
        """A formula on a line of its own, that stays in one piece."""
        return _written(list(self.found[spelled]), display=True)

    def pieces(self, spelled: str, relation: str = "") -> list[str]:
        """A formula in pieces between which a line may end: each begins with a relation or a sign."""
        first, *others = (list(self.found[one]) for one in fragments_of(spelled))
        start = [_operator(relation), _leading(first)] if relation else first
        return [
            _written(start, display=True),
            *(_written(one, display=True, continued=True) for one in others),
        ]

    def system(self, matrix: Sequence[Sequence[str]], unknowns: Sequence[str], right: Sequence[str]) -> str:
        """A matrix times its unknowns = the right sides."""
        columns = [[(one,) for one in unknowns], [(one,) for one in right]]
        parts = [self._matrix(rows) for rows in (matrix, *columns)]
        return _written([*parts[:2], _operator("="), parts[2]], display=True)

    def _matrix(self, rows: Iterable[Sequence[str]]) -> Xml.Element:
        whole = Xml.Element("mrow")
        whole.append(_operator("(", "prefix"))
        table = Xml.SubElement(whole, "mtable")
        for row in rows:
            line = Xml.SubElement(table, "mtr")
            for entry in row:
                Xml.SubElement(line, "mtd").extend(copy.deepcopy(list(self.found[entry])))
        whole.append(_operator(")", "postfix"))
        return whole


def formulas_of(spelled: Iterable[str]) -> Formulas:
    """Lay out formulas in typst's notation, which were `check_formula`, each of them once."""
    wanted = list(dict.fromkeys(spelled))
    if not wanted:
        return Formulas({}, "")
    source = "\n\n".join(f"$ {one} $" for one in wanted)
    page = _compile(source)
    # the one thing that pages may write and XML may not
    found = [_mend(Xml.fromstring(one.replace("]]>", "]]&gt;"))) for one in FORMULA.findall(page)]
    if len(found) != len(wanted):
        raise ValueError(f"{len(wanted)} formulas became {len(found)}")
    style = STYLE.search(page)
    return Formulas(dict(zip(wanted, found, strict=True)), style.group(1) if style else "")


def _compile(source: str) -> str:
    """The page that typst makes; it sees nothing of the machine."""
    files: Any = {"main": source.encode()}
    compiler = typst.Compiler(ignore_system_fonts=True)
    page, _warnings = compiler.compile_with_warnings(input=files, format="html")
    assert isinstance(page, bytes)
    return page.decode()


def _mend(formula: Xml.Element) -> Xml.Element:
    for raised in [*formula.iter("msup"), *formula.iter("msubsup")]:
        if raised[-1].text in PRIMES:
            _lower(raised)
    for accent in formula.iter("mover"):
        sign = accent[-1]
        if accent.get("accent") == "true" and sign.text in ABOVE:
            if sign.text == ARROW:
                sign.set("class", "vector")
            sign.text = ABOVE[sign.text]
            sign.set("stretchy", "false")
    return formula


def _lower(raised: Xml.Element) -> None:
    """Put a prime behind its letter instead of above it."""
    base, *below, prime = raised
    prime.set("lspace", "0")
    prime.set("rspace", "0")
    raised[:] = [base, prime]
    raised.tag = "mrow"
    if below:
        row = Xml.Element("mrow")
        row.extend([base, prime])
        raised[:] = [row, *below]
        raised.tag = "msub"


def _leading(elements: Sequence[Xml.Element]) -> Xml.Element:
    """Elements whose first sign stands before a term, not between two."""
    row = Xml.Element("mrow")
    row.extend(copy.deepcopy(list(elements)))
    if len(row) and row[0].tag == "mo" and row[0].text in SIGNS:
        row[0].set("form", "prefix")
    return row


def _operator(sign: str, form: str = "infix") -> Xml.Element:
    made = Xml.Element("mo", {"form": form})
    made.text = sign
    return made


def _written(elements: Sequence[Xml.Element], display: bool = False, continued: bool = False) -> str:
    """MathML of elements in a row; an operator that begins a continued one keeps its room."""
    whole = Xml.Element("math", {"displaystyle": "true"} if display else {})
    whole.extend(copy.deepcopy(list(elements)))
    if continued and len(whole) and whole[0].tag == "mo":
        whole[0].set("form", "infix")
    return Xml.tostring(whole, encoding="unicode", short_empty_elements=False)
