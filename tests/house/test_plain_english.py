"""Messages, public docstrings and pages are in plain technical English: a list of turns that they avoid."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from tools.catalogues import forms, read, sentences

import centrode as ct

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"

TURNS = {
    r"\b(?:is|are|be) told\b": "is given",
    r"\btold (?:as|by|from|apart)\b": "given as, distinguished from",
    r"\basked for\b": "requested, given",
    r"\bask for\b": "choose, give",
    r"\bforetold\b|\bforetells?\b": "predicted, estimated",
    r"\bsquare to\b": "perpendicular to",
    r"\bstands? (?:parallel|square)\b": "is parallel, is perpendicular",
    r"\bstands? still\b": "is at rest",
    r"\bto and fro\b": "reciprocates",
    r"\(the rule\)": "(default)",
    r"\b[Ff]riction by (?:a )?coefficients?\b": "Coulomb friction",
    r"\b[Nn]othing (?:says|tells)\b": "is not given, is not determined",
    r"\b(?:if|when) left out\b": "by default",
    r"\b(?:is|are|be|still) left out\b|\bleaves? (?:it |its ends )?out\b": "omitted",
    r"\btake (?:it|form|pin|length) out\b": "remove it",
    r"\bas often as needed\b": "may be repeated",
    r"\bkeeps? (?:the|all) bounds\b": "satisfies the bounds",
    r"\bless that\b": "minus that",
    r"\bdead points?\b": "dead position",
    r"\bturns over time\b": "average over time",
    r"\blooked for\b": "sought",
    r"\bfalls? in line\b": "are collinear",
    r"\bgoes on from there\b": "resumes from there",
    r"\bcan be computed with\b": "can be computed",
    r"\bsay (?:--|ct\.|executor)": "add, use",
    r"(?<!here )\bis no (?:scale|link|point|size|tolerance|number of|way to|kind of|format)\b": "is not a",
    r"\boff by \{": "differs by, residual",
}
"""A turn, as a pattern, and what is written instead."""

FENCE = re.compile(r"^( *)```.*?^\1```$", re.MULTILINE | re.DOTALL)
QUOTED = re.compile(r"`[^`\n]*`|\"[^\"\n]*\"|«[^»]*»|\]\([^)]*\)|^>.*$|\$[^$\n]*\$", re.MULTILINE)
NOT_ENGLISH_OR_MADE = {"ru", "uk", "reference", "validation", "_build"}
PAGES = [
    ROOT / "README.md",
    *(page for page in sorted(DOCS.rglob("*.md")) if not NOT_ENGLISH_OR_MADE & set(page.parts)),
]


def prose(text: str) -> str:
    """A page without code, quotations, targets of links and formulas."""
    return QUOTED.sub("", FENCE.sub("", text))


def turns_in(text: str) -> Iterator[str]:
    for pattern, better in TURNS.items():
        for found in re.finditer(pattern, text):
            around = text[max(found.start() - 30, 0) : found.end() + 30].replace("\n", " ")
            yield f"…{around}…: rather {better!r}"


def public_docstrings() -> Iterator[tuple[str, str]]:
    """Of the functions and classes of the face, and of the public methods and properties of the classes."""
    for name in ct.__all__:
        thing = getattr(ct, name)
        if not (inspect.isclass(thing) or inspect.isroutine(thing)):
            continue
        yield name, inspect.getdoc(thing) or ""
        for member, value in vars(thing).items() if inspect.isclass(thing) else ():
            if not member.startswith("_") and (inspect.isroutine(value) or isinstance(value, property)):
                yield f"{name}.{member}", inspect.getdoc(value) or ""


def test_messages() -> None:
    texts = [form for message in sentences(read("en")) for form in forms(message.id)]
    assert [(text, *turns_in(text)) for text in texts if any(turns_in(text))] == []


def test_public_docstrings() -> None:
    docs = list(public_docstrings())
    assert len(docs) > 90
    texts = [(name, re.sub(r"`[^`]*`", "", text)) for name, text in docs]
    assert [(name, *turns_in(text)) for name, text in texts if any(turns_in(text))] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_pages(page: Path) -> None:
    assert list(turns_in(prose(page.read_text(encoding="utf-8")))) == []


@pytest.mark.parametrize(
    ("text", "count"),
    [
        ("The reason is told, and two were asked for.", 2),
        ("With `is told` and\n> what is told in a quotation\n", 0),
        ("```text\nthe reason is told\n```\n", 0),
        ('The name "dead point" stays; a dead point does not.', 1),
    ],
)
def test_what_is_found(text: str, count: int) -> None:
    assert len(list(turns_in(prose(text)))) == count
