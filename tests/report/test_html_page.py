"""Reports as pages: whole, the same bytes, nothing from elsewhere, and what users wrote shown as it is."""

from __future__ import annotations

import base64
import hashlib
import os
import re
import subprocess
import sys
from html.parser import HTMLParser

import pytest

from centrode.render.document.blocks import (
    ChapterBlocks,
    FormulaBlock,
    ParagraphBlock,
    Report,
    SectionBlocks,
    TableBlock,
)
from centrode.report.html.page import html_page

from .made import HOSTILE, report

VOID = {"meta", "wbr", "br", "input", "img", "link", "hr"}


class Reader(HTMLParser):
    """Elements with their attributes, text by element, and whether every element is closed in its place."""

    def __init__(self, page: bytes) -> None:
        super().__init__()
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        self.wrong: list[str] = []
        self.feed(page.decode("utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        if self.open and self.open[-1] == tag:
            self.open.pop()
        else:
            self.wrong.append(tag)

    def handle_data(self, data: str) -> None:
        self.texts.append((self.open[-1] if self.open else "", data))

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.elements if name == tag]


@pytest.fixture(scope="module")
def page() -> bytes:
    return html_page(report())


def test_every_element_is_closed(page: bytes) -> None:
    reader = Reader(page)
    assert reader.wrong == []
    assert reader.open == []


def test_nothing_comes_from_elsewhere(page: bytes) -> None:
    reader = Reader(page)
    for tag, attributes in reader.elements:
        for key in ("src", "href", "action", "data", "poster", "srcset"):
            value = attributes.get(key)
            assert (
                value is None or value.startswith("#") or (tag == "image" and value.startswith("data:image/"))
            )
    assert not reader.all("link")
    text = page.decode()
    assert set(re.findall(r"url\(\"?(\w+):", text)) <= {"data"}
    assert set(re.findall(r"https?://[\w./]+", text)) == {
        "http://www.w3.org/2000/svg"
    }  # a name, not an address


def test_only_its_own_scripts_run(page: bytes) -> None:
    policy = next(one["content"] for one in Reader(page).all("meta") if one.get("http-equiv"))
    assert policy is not None
    scripts = re.findall(r"<script>(.*?)</script>", page.decode(), re.DOTALL)
    sums = [base64.b64encode(hashlib.sha256(one.encode()).digest()).decode() for one in scripts]
    assert re.findall(r"'sha256-([^']+)'", policy) == sums
    assert policy.startswith("default-src 'none';")
    assert "unsafe-inline" not in policy.split("style-src")[0]


def test_what_users_wrote_is_shown(page: bytes) -> None:
    reader = Reader(page)
    shown = [text for tag, text in reader.texts if tag not in ("script", "style")]
    assert any(HOSTILE in text for text in shown)
    assert ("title", HOSTILE) in reader.texts or any(
        tag == "h1" and HOSTILE in text for tag, text in reader.texts
    )
    events = [key for _tag, attributes in reader.elements for key in attributes if key.startswith("on")]
    assert events == []
    assert len(reader.all("script")) == 2 + len(re.findall(rb'class="moving"', page))


def test_names_are_given_once_and_found(page: bytes) -> None:
    reader = Reader(page)
    names = [attributes["id"] for _tag, attributes in reader.elements if "id" in attributes]
    assert len(names) == len(set(names))
    aims = [one["href"] for one in reader.all("a")] + [one["href"] for one in reader.all("use")]
    assert {str(aim)[1:] for aim in aims} <= set(names)


LANGUAGES = ("en", "ru", "uk")


def test_the_same_report_gives_the_same_bytes() -> None:
    """In every language, in a process with another seed of hashes."""
    code = (
        "import sys; from report.made import report; from centrode.report.html.page import html_page\n"
        f"for language in {LANGUAGES}: sys.stdout.buffer.write(html_page(report(language=language)))"
    )
    pages = [html_page(report(language=language)) for language in LANGUAGES]
    seed = "1" if os.environ.get("PYTHONHASHSEED") != "1" else "2"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, check=True, env=_environment(seed)
    )
    assert done.stdout == b"".join(pages)
    for language, page in zip(LANGUAGES, pages, strict=True):
        assert f'<html lang="{language}">'.encode() in page


def _environment(seed: str) -> dict[str, str]:
    paths = [path for path in sys.path if path]
    return {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join([*paths, "tests"])}


def test_chapters_and_sections_are_counted() -> None:
    sections = (
        SectionBlocks("", (ParagraphBlock("a"),)),
        SectionBlocks("First", ()),
        SectionBlocks("Second", ()),
    )
    made = Report(
        "T", "", "en", (ChapterBlocks("x", "One", sections), ChapterBlocks("y", "Two", missing="it locks"))
    )
    reader = Reader(html_page(made))
    heads = [one["id"] for tag, one in reader.elements if tag in ("h2", "h3")]
    assert heads == ["c1", "c1-1", "c1-2", "c2"]
    assert [str(one["href"])[1:] for one in reader.all("a")] == heads
    assert ("p", "This chapter could not be made: it locks") in reader.texts


def test_columns_of_numbers_are_flush_right() -> None:
    table = TableBlock(("name", "$x$, m"), (("a", "1.5"), ("b", "−2.5")), "Places", (False, True))
    reader = Reader(
        html_page(Report("T", "", "en", (ChapterBlocks("x", "X", (SectionBlocks("", (table,)),)),)))
    )
    assert [one.get("class") for one in reader.all("th")] == [None, "n"]
    assert [one.get("class") for one in reader.all("td")] == [None, "n"] * 2
    assert ("b", "Table 1") in reader.texts or ("b", "Table 1.") in reader.texts


def test_lines_are_aligned_unless_a_left_side_is_long() -> None:
    short = FormulaBlock((("a", "b + c"), ("d", "e", "1")))
    long = FormulaBlock(((" + ".join(f"l_({k}) cos phi_({k})" for k in range(9)), "0"), ("a", "1")))
    reader = Reader(
        html_page(Report("T", "", "en", (ChapterBlocks("x", "X", (SectionBlocks("", (short, long)),)),)))
    )
    kinds = [one.get("class") for one in reader.all("div")]
    assert kinds.count("aligned") == kinds.count("running") == 1
    assert kinds.count("left") == kinds.count("right") == 2
    assert len(reader.all("wbr")) >= 9
