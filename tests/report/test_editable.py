"""Documents that are written on: read by other programs, which count their formulas, headings, tables and figures."""

from __future__ import annotations

import io
import json
import re
import zipfile
from collections.abc import Iterator
from functools import cache
from typing import Any

import docx
import pytest
from docx.oxml.ns import qn

import centrode as ct
from centrode.errors import InputError
from centrode.locale import speaking
from centrode.render.document.blocks import (
    ChapterBlocks,
    FormulaBlock,
    ItemsBlock,
    Moving,
    ParagraphBlock,
    Picture,
    ProseBlock,
    Report,
    SectionBlocks,
    SystemBlock,
    TableBlock,
    shown,
)
from centrode.report import files
from centrode.report.editable.latex_document import latex_document
from centrode.report.editable.mathematics import latex_formulas
from centrode.report.editable.pandoc import run_pandoc
from centrode.report.editable.tree import ROOM, tree_of
from centrode.report.editable.word import word_document
from centrode.report.texts import blocks_of, parts_of, texts_of
from report import made

HOSTILE = (
    "No 1.23456",
    "run 30 deg",
    "2.50 kg",
    "$x_1$",
    "<b>",
    "#a",
    r"\input{x}",
    "50 % & 'a_b' ~^ \\",
    '"q" -- x',
)
CHAPTERS = ("data", "structure", "equations", "derivation")


@cache
def crank_rocker(language: str) -> Report:
    return ct.report(ct.example("crank-rocker"), ct.ReportOptions(chapters=CHAPTERS), language=language)


@cache
def by_hand() -> Report:
    return made.report()


def formulas(report: Report) -> tuple[int, int]:
    """Formulas in sentences and formulas on lines of their own, by the blocks of the report."""
    inline = displayed = 0
    for block in blocks_of(report):
        inline += sum(part.mathematics for text in texts_of(block) for part in parts_of(text))
        displayed += isinstance(block, FormulaBlock | SystemBlock)
    return inline, displayed


def opened(report: Report) -> docx.document.Document:
    return docx.Document(io.BytesIO(word_document(report)))


CAPTION_WORDS = {"en": ("Figure", "Table"), "ru": ("Рисунок", "Таблица"), "uk": ("Рисунок", "Таблиця")}


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
def test_word_has_the_formulas_headings_tables_and_language_of_the_report(language: str) -> None:
    report = crank_rocker(language)
    found = opened(report)
    inline, displayed = formulas(report)
    assert len(found.element.findall(f".//{qn('m:oMath')}")) == inline + displayed > 25
    assert len(found.element.findall(f".//{qn('m:oMathPara')}")) == displayed
    headings = [one.text for one in found.paragraphs if one.style.name.startswith("Heading")]
    sections = [section.title for chapter in report.chapters for section in chapter.sections if section.title]
    assert sorted(headings) == sorted([*sections, *(chapter.title for chapter in report.chapters)])
    tables = [table for table in found.tables if table.style.name == "Table"]
    blocks = [block for block in blocks_of(report) if isinstance(block, TableBlock)]
    assert len(tables) == len(blocks)
    assert all(table.rows[0]._tr.trPr.find(qn("w:tblHeader")) is not None for table in tables)
    assert len(found.tables) - len(tables) == displayed
    assert found.core_properties.title == report.title
    assert found.styles.element.find(f".//{qn('w:lang')}").get(qn("w:val")) == language
    page = found.sections[0]
    assert (page.page_width.mm, page.page_height.mm) == pytest.approx((210, 297), abs=0.1)
    numbers = re.findall(r"SEQ Formula", found.element.xml)
    assert len(numbers) == displayed
    captions = [
        "".join(text.text for text in one._p.iter(qn("w:t")))
        for one in found.paragraphs
        if one.style.name in ("Image Caption", "Table Caption")
    ]
    words = "|".join(CAPTION_WORDS[language])
    assert captions
    assert all(re.match(rf"(?:{words}) \d+\. \S", one) for one in captions)


def test_another_reader_of_word_finds_the_same_formulas() -> None:
    report = crank_rocker("ru")
    tree = json.loads(run_pandoc(word_document(report), "--from=docx", "--to=json"))
    kinds = re.findall(r'"t": "(InlineMath|DisplayMath)"', json.dumps(tree))
    assert (kinds.count("InlineMath"), kinds.count("DisplayMath")) == formulas(report)


def test_pictures_of_word_keep_the_width_of_the_report() -> None:
    report = by_hand()
    found = opened(report)
    widths = [shape.width.inches for shape in found.inline_shapes]
    pictures = [block for block in blocks_of(report) if isinstance(block, Picture | Moving)]
    assert len(widths) == len(pictures)
    assert max(widths) <= 210 / 25.4
    images = [part for part in found.part.package.iter_parts() if part.partname.endswith(".png")]
    assert images


@pytest.mark.parametrize("language", ["en", "ru", "uk"])
def test_latex_has_the_formulas_and_headings_of_the_report(language: str) -> None:
    report = crank_rocker(language)
    source, figures = latex_document(report, "report-figures")
    text = source.decode()
    inline, displayed = formulas(report)
    assert text.count(r"\begin{equation}\label{eq:") == displayed
    # heads of tables stand twice: on the first page and on the others
    tree = json.loads(run_pandoc(source, "--from=latex", "--to=json"))
    assert json.dumps(tree).count('"DisplayMath"') == displayed
    assert text.count(r"\section{") + text.count(r"\subsection{") == sum(
        1 + sum(bool(section.title) for section in chapter.sections) for chapter in report.chapters
    )
    assert json.dumps(tree).count('"InlineMath"') >= inline
    assert set(re.findall(r"report-figures/(\d+\.pdf)", text)) == set(figures)
    assert all(content.startswith(b"%PDF-") for content in figures.values())
    _check_pairs(text)


def _check_pairs(text: str) -> None:
    """Braces, environments and brackets that grow close in their row, as LaTeX demands it."""
    depth = 0
    for brace in re.findall(r"(?<!\\)(?:\\\\)*([{}])", text):
        depth += 1 if brace == "{" else -1
        assert depth >= 0
    assert depth == 0
    for body in re.findall(r"\\begin\{aligned\}(.*?)\\end\{aligned\}", text, re.DOTALL):
        for row in body.split(r"\\" + "\n"):
            assert row.count(r"\left") == row.count(r"\right"), row
            assert len(re.findall(r"(?<!\\)&", row)) == 1, row
    begun, ended = (sorted(re.findall(rf"\\{word}\{{(\w+)\*?\}}", text)) for word in ("begin", "end"))
    assert begun == ended


def test_a_report_made_by_hand_is_whole_in_both() -> None:
    report = by_hand()
    source, figures = latex_document(report, "f")
    _check_pairs(source.decode())
    _inline, displayed = formulas(report)
    found = opened(report)
    assert len(found.element.findall(f".//{qn('m:oMathPara')}")) == displayed
    assert len(figures) == len(found.inline_shapes)


def words_of(tree: Any) -> Iterator[str]:
    """The words of pandoc's tree."""
    if isinstance(tree, list):
        for one in tree:
            yield from words_of(one)
    elif isinstance(tree, dict):
        if tree.get("t") == "Str":
            yield tree["c"]
        else:
            yield from words_of(tree.get("c", []))


@pytest.mark.parametrize("name", HOSTILE)
def test_names_stand_as_they_are_written(name: str) -> None:
    table = TableBlock((shown(name), "n"), ((shown(name), "1.5"),), shown(name))
    blocks = (ItemsBlock((shown(name),)), table, FormulaBlock(((f'x_("{made.name(name)}")', "1"),)))
    report = made.Report(
        name, name, "en", (made.ChapterBlocks("one", name, (made.SectionBlocks(name, blocks),)),)
    )
    found = opened(report)
    texts = [one.text for one in found.paragraphs] + [
        cell.text for table in found.tables for row in table.rows for cell in row.cells
    ]
    assert sum(name in text for text in texts) == 8  # title, subtitle, headings, an item, head, cell, caption
    source, _figures = latex_document(report, "f")
    body = source.decode().partition(r"\maketitle")[2]
    assert r"\input" not in body
    read = json.loads(run_pandoc(source, "--from=latex-smart", "--to=json"))
    # two headings, an item, a head, a caption; the reader takes a number that begins a row for a length
    assert " ".join(words_of(read["blocks"])).count(" ".join(name.split())) >= 5
    _check_pairs(source.decode())


def test_what_is_no_formula_is_refused() -> None:
    with pytest.raises(ValueError, match="not a formula"):
        latex_formulas(["x #panic(1)"])


def test_decimals_of_a_language_are_no_punctuation() -> None:
    with speaking("ru"):
        found = latex_formulas(['"2,84" dot.op x', '"No 1.5"', 'sin "54,3°"', 'op("tg") alpha'])
    assert found.inline('"2,84" dot.op x') == r"2{,}84 \cdot x"
    assert found.inline('"No 1.5"') == r"\text{No 1.5}"
    assert found.inline('sin "54,3°"') == r"\sin54{,}3^{\circ}"
    assert found.inline('op("tg") alpha') == r"\operatorname{tg}\alpha"


def test_wide_tables_are_dealt_to_several_that_begin_with_the_first_column() -> None:
    heads = ("sample", *(f"column {k}" for k in range(20)))
    block = TableBlock(heads, (tuple("123.4567" for _ in heads),), "Wide", (True,) * len(heads))
    report = Report("a", "b", "en", (made.ChapterBlocks("one", "One", (made.SectionBlocks("", (block,)),)),))
    tree, _pictures = tree_of(report, lambda latex, number: [], lambda number: {}, "png")
    tables = [one["c"] for one in json.loads(tree)["blocks"] if one["t"] == "Table"]
    assert len(tables) > 1
    columns = [[cell[4][0]["c"][0]["c"] for cell in table[3][1][0][1]] for table in tables]
    assert all(names[0] == "sample" and sum(map(len, names)) <= ROOM for names in columns)
    assert [name for names in columns for name in names[1:]] == list(heads[1:])


def test_further_parts_of_a_table_name_it_and_have_no_number() -> None:
    head = tuple(f"long words {k}" for k in range(14))
    wide = TableBlock(head, (("1234.5678",) * 14,) * 3, "Wide", (True,) * 14)
    narrow = TableBlock(("a", "b"), (("1", "2"),), "Narrow")
    report = Report(
        "T", "", "en", (ChapterBlocks("one", "One", (SectionBlocks("", (wide, narrow)),)),), standard="gost"
    )
    document = docx.Document(io.BytesIO(word_document(report)))
    captions = [
        (one.text, "SEQ Table" in one._p.xml)
        for one in document.paragraphs
        if one.style is not None and one.style.name == "Table Caption"
    ]
    assert captions == [
        ("Table  – Wide", True),
        ("Table 1, continued", False),
        ("Table  – Narrow", True),
    ]
    assert all(table.rows[0]._tr.xpath("w:trPr/w:tblHeader") for table in document.tables)
    source = latex_document(report, "figures")[0].decode()
    # what further pages repeat, of tables with numbers
    assert re.findall(
        r"\\endfirsthead\n\\multicolumn\{(\d+)\}\{@\{\}l@\{\}\}\{Table \\thetable\{\}, continued\}", source
    ) == ["8", "2"]
    assert source.count("Table 1, continued") == 1
    assert source.count(r"\caption{") == 2


def test_the_same_report_gives_the_same_bytes() -> None:
    report = crank_rocker("en")
    first = word_document(report)
    assert first == word_document(report)
    assert latex_document(report, "f") == latex_document(report, "f")
    with zipfile.ZipFile(io.BytesIO(first)) as parts:
        assert parts.testzip() is None


def test_without_pandoc_nothing_is_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    found = files.find_spec
    monkeypatch.setattr(files, "find_spec", lambda name: None if name == "pypandoc" else found(name))
    with pytest.raises(InputError, match=r'pypandoc, which is not installed.*"\.\[editable\]"'):
        files.check_formats(("docx",))
    files.check_formats(("html", "pdf", "ipynb"))


OWN = """
# Aim

**Strong** *slanted* `code` <b> $x_1$ [link](https://example.org)

1. first
2. second

| a | b |
|---|---|
| <i> | $2$ |
"""


def test_own_text_stands_before_and_after_its_chapter() -> None:
    mechanism = ct.example("crank-rocker")
    text = ct.mechanism_text(mechanism) + (
        f"\n[report.text.structure]\nbefore = '''{OWN}'''\nafter = \"It turns.\"\n"
    )
    report = ct.report(ct.parse_mechanism(text), ct.ReportOptions(chapters=("structure",)))
    sections = report.chapters[0].sections
    assert [section.written for section in sections][:: len(sections) - 1] == ["before", "after"]
    aim = sections[0]
    assert aim.title == "Aim"
    words, items, named, table = aim.blocks
    assert named == ParagraphBlock("See table 1.")
    assert isinstance(words, ProseBlock)
    assert isinstance(items, ProseBlock)
    assert isinstance(table, TableBlock)
    assert [
        (span.text, span.strong, span.emphasized, span.code)
        for span in words.paragraphs[0]
        if span.text.strip()
    ] == [
        ("Strong", True, False, False),
        ("slanted", False, True, False),
        ("code", False, False, True),
        (" <b> $x_1$ ", False, False, False),
        ("link", False, False, False),
        (" (https://example.org)", False, False, False),
    ]
    assert items.kind == "numbers"
    assert table.rows == (("<i>", r"\$2\$"),)
    for kind in ("html", "pdf", "docx", "tex", "ipynb"):
        assert files.document(report, kind)
    page = files.document(report, "html")["report.html"].decode()
    assert "<strong>Strong</strong> <em>slanted</em> <code>code</code> &lt;b&gt; $x_1$ link" in page
    assert "It turns." in page


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[report.text.structur]\nafter = 'x'", "there is no chapter.*structur"),
        ("[report.text.structure]\nafter = 1", "expected a text"),
        (f"[report.text.structure]\nafter = '{'x' * 20_001}'", "at most 20000 characters"),
        ('[report.text.structure]\nafter = "\\u0007"', "control characters"),
    ],
)
def test_own_text_is_bounded(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        ct.report(ct.parse_mechanism(f"{ct.mechanism_text(ct.example('crank-rocker'))}\n{text}\n"))
