"""Formulas as MathML: one run of typst for all formulas of a page, of which only the formulas themselves are kept."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.etree import ElementTree as Xml

import lazy_loader as lazy

from centrode.errors import InputError
from centrode.locale import _

if TYPE_CHECKING:
    import typst
else:
    typst = lazy.load("typst")

FORMULA = re.compile(r"<math\b.*?</math>", re.DOTALL)
STYLE = re.compile(r"<style>(.*?)</style>", re.DOTALL)
DOTS = {"\u0307": "\u02d9", "\u0308": "\u00a8"}
"""Combining dots stand left of their letter in browsers; the spacing ones stand above it."""
SIGNS = {"+", "\u2212", "-", "±", "∓"}
RELATIONS = {"=", "≈", "<", ">", "≤", "≥", "≠", "≡", "≪", "≫", "∈", "→", "⇒"}


@dataclass(frozen=True)
class Formulas:
    """MathML of formulas by their spelling, and the rules that lay it out."""

    found: Mapping[str, Xml.Element]
    style: str

    def inline(self, spelled: str) -> str:
        """A formula in a sentence."""
        return _written(list(self.found[spelled]))

    def displayed(self, spelled: str) -> str:
        """A formula on a line of its own, that stays in one piece."""
        return _written(list(self.found[spelled]), display=True)

    def pieces(self, spelled: str, relation: str = "") -> list[str]:
        """A formula in pieces between which a line may end: each begins with a relation or a sign."""
        groups: list[list[Xml.Element]] = [[]]
        for element in self.found[spelled]:
            if _ends_piece(element, groups[-1]):
                groups.append([])
            groups[-1].append(element)
        first = [_operator(relation), _leading(groups[0])] if relation else groups[0]
        return [
            _written(group, display=True, continued=k > 0) for k, group in enumerate([first, *groups[1:]])
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
    """Lay out formulas in typst's notation, each of them once.

    Raises
    ------
    InputError
        typst is not installed, or a formula is not in its notation.
    """
    wanted = list(dict.fromkeys(spelled))
    if not wanted:
        return Formulas({}, "")
    source = "\n\n".join(f"$ {one} $" for one in wanted)
    page = _compiled(source)
    found = [_mended(Xml.fromstring(one)) for one in FORMULA.findall(page)]
    if len(found) != len(wanted):
        raise InputError("", _("{count} formulas became {found}").format(count=len(wanted), found=len(found)))
    style = STYLE.search(page)
    return Formulas(dict(zip(wanted, found, strict=True)), style.group(1) if style else "")


def _compiled(source: str) -> str:
    """The page that typst makes; it sees nothing of the machine."""
    try:
        compiler = typst.Compiler(ignore_system_fonts=True)
        page, _warnings = compiler.compile_with_warnings(input={"main": source.encode()}, format="html")
    except ModuleNotFoundError as missing:
        raise InputError(
            "", _("a report needs typst, which is not installed"), _("pip install 'centrode[documents]'")
        ) from missing
    except typst.TypstError as wrong:
        raise InputError("", _("a formula cannot be laid out: {why}").format(why=wrong)) from wrong
    assert isinstance(page, bytes)
    return page.decode()


def _mended(formula: Xml.Element) -> Xml.Element:
    for accent in formula.iter("mover"):
        sign = accent[-1]
        if accent.get("accent") == "true" and sign.text in DOTS:
            sign.text = DOTS[sign.text]
            sign.set("stretchy", "false")
    return formula


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


def _ends_piece(element: Xml.Element, before: Sequence[Xml.Element]) -> bool:
    """Whether a new piece begins: at a relation, and at a sign that stands between two terms."""
    if element.tag != "mo" or not before:
        return False
    last = before[-1]
    after_operator = last.tag == "mo" and last.text in SIGNS | RELATIONS
    return not after_operator and element.text in SIGNS | RELATIONS


def _written(elements: Sequence[Xml.Element], display: bool = False, continued: bool = False) -> str:
    """MathML of elements in a row; an operator that begins a continued one keeps its room."""
    whole = Xml.Element("math", {"displaystyle": "true"} if display else {})
    whole.extend(copy.deepcopy(list(elements)))
    if continued and len(whole) and whole[0].tag == "mo":
        whole[0].set("form", "infix")
    return Xml.tostring(whole, encoding="unicode", short_empty_elements=False)
