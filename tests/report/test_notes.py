"""Reports as explanatory notes: title page, order, parts, captions, pages by standards, in every kind of document."""

from __future__ import annotations

import io
import json
import re
import zipfile
from dataclasses import replace
from pathlib import Path

import docx
import pytest

import centrode as ct
from centrode.model.cam_files import cam_text
from centrode.render.document.blocks import (
    ChapterBlocks,
    Moving,
    ParagraphBlock,
    Picture,
    ProseBlock,
    ReferenceBlock,
    Report,
    SectionBlocks,
    TableBlock,
    TitlePageBlocks,
)
from centrode.render.document.outline import outline_of
from centrode.report.citations import cited_numbers
from centrode.report.editable.latex_document import latex_document
from centrode.report.editable.word import word_document
from centrode.report.html.page import html_page
from centrode.report.notebook_document import notebook_document
from centrode.report.pdf_document import pdf_document
from centrode.report.texts import blocks_of

from .made import svg
from .pdf_reading import PdfFile

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"
CHAPTERS = ("data", "words", "structure", "tables", "plots", "flywheel")
MM = 72 / 25.4
SLACK = 7.0
"""Points that punctuation with the blank behind it hangs into a margin: half a letter of the size of these notes."""


def note_of(language: str, **options: object) -> Report:
    mechanism = ct.read_mechanism(EXAMPLES / f"press-note-{language}.toml")
    chosen = ct.ReportOptions(chapters=CHAPTERS, full=False, **options)  # type: ignore[arg-type]
    return ct.report(mechanism, chosen, language=language)


@pytest.fixture(scope="module", params=["ru", "uk"])
def note(request: pytest.FixtureRequest) -> Report:
    return note_of(request.param)


@pytest.fixture(scope="module")
def pdf(note: Report) -> PdfFile:
    return PdfFile(pdf_document(note))


def by_hand(**changes: object) -> Report:
    """A note of one table and one figure."""
    blocks = (
        ParagraphBlock("Words"),
        TableBlock(("a",), (("1",),), "Rows", number=1),
        Picture(svg(200, 100), "Drawn", 2.0, number=1),
    )
    made = Report(
        "Press",
        "",
        "en",
        (
            ChapterBlocks("task", "Task", (SectionBlocks("", (ParagraphBlock("Do it."),)),), role="front"),
            ChapterBlocks("one", "First", (SectionBlocks("Inside", blocks),), part="Kinematics"),
            ChapterBlocks("two", "Second", part="Kinematics"),
            ChapterBlocks("three", "Third"),
            ChapterBlocks("end", "Conclusions", role="element"),
            ChapterBlocks("checks", "Checks", (SectionBlocks("More", blocks),), role="appendix"),
        ),
        title_page=TitlePageBlocks(
            ("School", "Faculty"), "Note", "", "Press", "Variant 7", (("Done by", "A"),), "Kyiv"
        ),
        is_note=True,
        standard="gost",
    )
    return replace(made, **changes)  # type: ignore[arg-type]


# The order of a note, and the numbers of its headings


def test_the_order_is_that_of_an_explanatory_note(note: Report) -> None:
    names = [chapter.name for chapter in note.chapters]
    body = ["data", "words", "structure", "tables", "plots", "flywheel"]
    assert names == ["task", "introduction", *body, "conclusions", "sources", "checks"]
    roles = {chapter.name: chapter.role for chapter in note.chapters}
    assert roles["task"] == "front"
    assert roles["introduction"] == roles["conclusions"] == roles["sources"] == "element"
    assert roles["checks"] == "appendix"
    parts = {chapter.name: chapter.part for chapter in note.chapters}
    assert parts["words"] == parts["structure"] != parts["tables"] == parts["plots"]
    assert parts["data"] == parts["flywheel"] == ""  # alone in their parts, they stand for themselves


def test_the_standard_is_that_of_the_language_unless_it_is_named() -> None:
    mechanism = ct.read_mechanism(EXAMPLES / "press-note-ru.toml")
    wishes = mechanism.report.model_copy(update={"standard": None})
    unnamed = mechanism.model_copy(update={"report": wishes})
    options = ct.ReportOptions(chapters=("structure",))
    found = {
        language: ct.report(unnamed, options, language=language).standard for language in ("en", "ru", "uk")
    }
    assert found == {"en": "plain", "ru": "gost", "uk": "dstu"}
    assert ct.report(unnamed, replace(options, standard="plain"), language="ru").standard == "plain"
    assert ct.report("crank-rocker", options, language="ru").standard == "plain"


def test_headings_are_numbered_through_parts() -> None:
    headings = [
        (heading.number, heading.title)
        for chapter in outline_of(by_hand())
        for heading in (*chapter.headings, *(title for title, _section in chapter.sections if title))
    ]
    assert headings == [
        ("", "Task"),
        ("1", "Kinematics"),
        ("1.1", "First"),
        ("1.1.1", "Inside"),
        ("1.2", "Second"),
        ("2", "Third"),
        ("", "Conclusions"),
        ("A", "Appendix A. Checks"),
        ("A.1", "More"),
    ]


# What the text names


def test_every_table_and_figure_is_named_in_the_text(note: Report) -> None:
    text = " ".join(re.sub(r"\s+", " ", one) for one in told(note))
    blocks = list(blocks_of(note))
    for kind, word in ((TableBlock, "табли"), ((Picture, Moving), "рисун")):
        numbers = {block.number for block in blocks if isinstance(block, kind) and block.number}
        named = set()
        for first, joint, last in re.findall(rf"{word}\w+ (\d+)(?:( і | и |–)(\d+))?", text):
            named |= (
                set(range(int(first), int(last) + 1)) if joint == "–" else {int(first), int(last or first)}
            )
        assert numbers
        assert named >= numbers, numbers - named


def told(report: Report) -> list[str]:
    """What sentences say."""
    return [block.text for block in blocks_of(report) if isinstance(block, ParagraphBlock | ReferenceBlock)]


def test_every_source_is_cited(note: Report) -> None:
    (listed,) = next(chapter for chapter in note.chapters if chapter.name == "sources").sections[0].blocks
    assert isinstance(listed, ProseBlock)
    spans = (
        span.text
        for block in blocks_of(note)
        if isinstance(block, ProseBlock)
        for one in block.paragraphs
        for span in one
    )
    text = " ".join([*told(note), *spans])
    assert {number for number in cited_numbers(text)} == set(range(1, len(listed.paragraphs) + 1))
    # its author cites them all, so that no sentence has to
    assert not re.search("Использованная литература|Використана література", text)


def test_sources_that_the_author_does_not_cite_are_named_after_the_introduction() -> None:
    note = "".join(f'"Book {k}.", ' for k in range(1, 5))
    text = ct.mechanism_text(ct.example("crank-rocker")) + (
        f'\n[report]\nintroduction = "As [2] and [4, p. 7] have it."\nsources = [{note}]\n'
    )
    made = ct.report(ct.parse_mechanism(text), ct.ReportOptions(chapters=("structure",)), language="en")
    assert made.chapters[0].name == "introduction"
    last = made.chapters[0].sections[-1].blocks[-1]
    assert last == ParagraphBlock("Literature used: [1], [3].")
    without = text.replace('introduction = "As [2] and [4, p. 7] have it."', "")
    made = ct.report(ct.parse_mechanism(without), ct.ReportOptions(chapters=("structure",)), language="en")
    assert made.chapters[0].sections[0].blocks == (ParagraphBlock("Literature used: [1], [2], [3], [4]."),)


@pytest.mark.parametrize(
    ("text", "numbers"),
    [("[1]", [1]), ("[1, 3]", [1, 3]), ("[2, с. 15]", [2]), ("[1–3; 5]", [1, 2, 3, 5]), ("x[i] [a1]", [])],
)
def test_citations_are_read(text: str, numbers: list[int]) -> None:
    assert list(cited_numbers(text)) == numbers


# PDF


@pytest.mark.drawn
@pytest.mark.parametrize("language", ["ru", "uk"])
def test_no_page_of_a_note_is_half_empty_unless_a_chapter_ends(language: str) -> None:
    chapters = ("data", "structure", "derivation", "tables", "plots", "positions", "rotatability", "flywheel")
    mechanism = ct.read_mechanism(EXAMPLES / f"press-note-{language}.toml")
    made = ct.report(mechanism, ct.ReportOptions(chapters=chapters, full=False), language=language)
    found = PdfFile(pdf_document(made))
    assert len(found.pages) > 15
    assert found.half_empty_pages == []


def test_the_title_page_has_what_is_given_and_no_number(pdf: PdfFile, note: Report) -> None:
    page = note.title_page
    assert page is not None
    first = re.sub(r"\s+", " ", pdf.pages[0])
    for line in (*page.head, page.work, page.course, page.title, page.variant, page.foot):
        assert line in first
    for label, name in page.people:
        assert f"{label}: {name}" in first
    assert not re.search(r"^\d+$", pdf.pages[0], re.MULTILINE)
    assert re.search(r"^2$", pdf.pages[1], re.MULTILINE)


def test_task_contents_and_chapters_follow_each_other(pdf: PdfFile, note: Report) -> None:
    words = {
        "ru": (
            "ЗАДАНИЕ",
            "СОДЕРЖАНИЕ",
            "ВВЕДЕНИЕ",
            "ЗАКЛЮЧЕНИЕ",
            "СПИСОК ИСПОЛЬЗОВАННЫХ ИСТОЧНИКОВ",
            "ПРИЛОЖЕНИЕ А",
        ),
        "uk": ("ЗАВДАННЯ", "ЗМІСТ", "ВСТУП", "ВИСНОВКИ", "ПЕРЕЛІК ДЖЕРЕЛ ПОСИЛАННЯ", "ДОДАТОК А"),
    }[note.language]
    pages = [next(k for k, page in enumerate(pdf.pages) if word in page) for word in words]
    assert pages == sorted(set(pages))
    assert pages[0] == 1


def test_titles_of_parts_are_in_capitals_by_dstu(pdf: PdfFile, note: Report) -> None:
    capital, plain = {
        "ru": ("1 ИСХОДНЫЕ ДАННЫЕ", "1 Исходные данные"),
        "uk": ("1 ВИХІДНІ ДАНІ", "1 Вихідні дані"),
    }[note.language]
    chapter = next(page for page in pdf.pages[3:] if capital in page or f"{plain}\n" in page)
    assert (capital in chapter) == (note.standard == "dstu")
    styles = zipfile.ZipFile(io.BytesIO(word_document(by_hand(standard=note.standard)))).read(
        "word/styles.xml"
    )
    (heading,) = re.findall(rb'<w:style [^>]*w:styleId="Heading1".*?</w:style>', styles, re.DOTALL)
    assert bool(re.search(rb"<w:caps ?/>", heading)) == (note.standard == "dstu")
    source = latex_document(by_hand(standard=note.standard), "figures")[0].decode()
    assert (r"{\thesection}{1ex}{\MakeUppercase}" in source) == (note.standard == "dstu")


def test_the_appendix_is_named_in_the_last_chapter(note: Report) -> None:
    last = [chapter for chapter in note.chapters if chapter.role == "chapter"][-1].sections[-1].blocks[-1]
    words = {
        "ru": "Проверки результатов собраны в приложении А.",
        "uk": "Перевірки результатів зібрано в додатку А.",
    }
    assert last == ParagraphBlock(words[note.language])


def test_figures_and_tables_are_called_as_the_standards_call_them(pdf: PdfFile, note: Report) -> None:
    figure, table = {"ru": ("Рисунок", "Таблица"), "uk": ("Рисунок", "Таблиця")}[note.language]
    assert re.search(rf"{figure}\s1 – \S", pdf.text)
    assert re.search(rf"{table}\s1 – \S", pdf.text)
    assert "Рис. 1" not in pdf.text


def test_heads_of_columns_and_rows_begin_with_capitals(note: Report) -> None:
    tables = [
        block
        for chapter in note.chapters
        for section in chapter.sections
        for block in section.blocks
        if isinstance(block, TableBlock)
    ]
    heads = [head for table in tables for head in (*table.head, *(row[0] for row in table.rows))]
    words = [head for head in heads if re.match(r"[а-яіїєґ]{2}", head, re.IGNORECASE)]
    assert len(words) > 30
    assert all(word[0].isupper() for word in words)


def test_an_appendix_has_its_letter_above_its_title(pdf: PdfFile, note: Report) -> None:
    letter, title = {"ru": ("ПРИЛОЖЕНИЕ А", "Проверки"), "uk": ("ДОДАТОК А", "Перевірки")}[note.language]
    assert re.search(rf"^{letter}\s*\n{title}\s*$", pdf.text, re.MULTILINE)


def test_enumerations_have_brackets_and_sources_full_stops(pdf: PdfFile, note: Report) -> None:
    assert re.search(r"^1\) ", pdf.pages[1], re.MULTILINE)
    sources = {"ru": "СПИСОК ИСПОЛЬЗОВАННЫХ ИСТОЧНИКОВ", "uk": "ПЕРЕЛІК ДЖЕРЕЛ ПОСИЛАННЯ"}[note.language]
    page = next(page for page in pdf.pages if sources in page)
    assert re.search(r"^1\. ", page, re.MULTILINE)


def test_units_of_the_conclusions_are_whole(pdf: PdfFile, note: Report) -> None:
    title = {"ru": "ЗАКЛЮЧЕНИЕ", "uk": "ВИСНОВКИ"}[note.language]
    page = next(page for page in pdf.pages if title in page).replace("\r", "")
    assert re.search(r"\d[\u00a0\u202f ]м/с", page)
    assert not re.search(r"/\s*\n|\d\s*\n\s*(м|Н|кг|рад|Дж)\b", page)


def test_a_note_is_accessible_and_kept(pdf: PdfFile, note: Report) -> None:
    assert pdf.standards == "ua-1 a-2a"
    assert pdf.is_tagged
    assert pdf.language == note.language
    assert pdf.title == note.title


@pytest.mark.parametrize(
    ("standard", "left", "right"), [("gost", 30, 15), ("dstu", 30, 10), ("plain", 20, 20)]
)
def test_margins_are_those_of_the_standard(standard: str, left: float, right: float) -> None:
    boxes = PdfFile(pdf_document(replace(note_of("ru"), standard=standard))).words()  # type: ignore[arg-type]
    assert min(box[0] for box in boxes) == pytest.approx(left * MM, abs=SLACK)
    assert max(box[2] for box in boxes) == pytest.approx((210 - right) * MM, abs=SLACK)


def test_numbers_of_pages_stand_where_the_standard_has_them() -> None:
    for standard, across, up in (("gost", 112.5, 0.0), ("dstu", 200.0, 297.0)):
        boxes = PdfFile(pdf_document(by_hand(standard=standard))).words()
        numbers = [box for box in boxes if box[4].strip() in ("2", "3") and abs(box[3] - up * MM) < 20 * MM]
        assert numbers
        for left, _bottom, right, _top, _word in numbers:
            place = right if standard == "dstu" else (left + right) / 2
            assert place == pytest.approx(across * MM, abs=SLACK)


def test_a_note_without_a_title_page_begins_with_its_title() -> None:
    first = PdfFile(pdf_document(by_hand(title_page=None))).pages[0]
    assert first.startswith("Press")


def test_letters_that_no_font_has_leave_the_note_without_a_claim() -> None:
    page = TitlePageBlocks(("School \U0001f600",), "", "", "Press", "", (), "")
    made = PdfFile(pdf_document(by_hand(title_page=page)))
    assert made.standards == ""
    assert "School" in made.pages[0]


# The other documents


def test_the_word_document_is_the_same_note() -> None:
    made = word_document(by_hand(standard="dstu"))
    document = docx.Document(io.BytesIO(made))
    found = [(one.style.name if one.style else "", one.text) for one in document.paragraphs if one.text]
    assert found[:6] == [
        ("Cover", "School"),
        ("Cover", "Faculty"),
        ("Cover Work", "Note"),
        ("Title", "Press"),
        ("Cover", "Variant 7"),
        ("Cover People", "Done by: A"),
    ]
    titles = [text for style, text in found if style.startswith(("Heading", "Element", "TOC"))]
    assert titles[:4] == ["Task", "Contents", "Kinematics", "First"]
    assert ("Element", "Conclusions") in found
    assert ("Table Caption", "Table  – Rows") in found  # the number is a field
    assert ("Image Caption", "Figure  – Drawn") in found
    section = document.sections[0]
    margins = [round(side.mm) for side in (section.left_margin, section.right_margin) if side is not None]
    assert margins == [30, 10]
    assert section.different_first_page_header_footer
    with zipfile.ZipFile(io.BytesIO(made)) as parts:
        assert b"<w:hdr" in parts.read("word/footer-page.xml")  # at the top


def test_the_latex_document_is_the_same_note() -> None:
    source = latex_document(by_hand(), "figures")[0].decode()
    assert r"\geometry{left=30mm,right=15mm,top=20mm,bottom=20mm}" in source
    order = (
        r"\begin{titlepage}",
        r"\section*{Task}",
        r"\tableofcontents",
        r"\section{Kinematics}",
        r"\subsection{First}",
    )
    places = [source.index(one) for one in (*order, r"\section*{Conclusions}")]
    assert places == sorted(places)
    assert "labelsep=endash" in source


def test_the_page_is_the_same_note(note: Report) -> None:
    text = html_page(note).decode()
    page = note.title_page
    assert page is not None
    assert text.index(page.head[0]) < text.index(f"<h1>{page.title}") < text.index(page.people[0][1])
    assert re.search(r"<figcaption>\S+ 1 – ", text)
    numbers = re.findall(r'<h[234] id="[^"]*"><span class="number">([\d.]+)</span>', text)
    assert numbers[:4] == ["1", "2", "2.1", "2.2"]


def test_the_notebook_begins_with_the_title_page_and_the_task(note: Report) -> None:
    cells = ["".join(cell["source"]) for cell in json.loads(notebook_document(note))["cells"]]
    page = note.title_page
    assert page is not None
    assert page.head[0] in cells[0]
    assert cells[1].startswith("## ")
    assert any("chapters=('conclusions',)" in cell for cell in cells)


def test_a_cam_has_a_note_with_the_conclusions_of_its_author() -> None:
    text = (
        cam_text(ct.example("valve-cam"))
        + '[report]\nconclusions = "It lifts."\n[report.title_page]\nyear = 2026\n'
    )
    made = ct.report(ct.parse_cam(text), ct.ReportOptions(chapters=("data",)), language="en")
    assert [(chapter.name, chapter.missing) for chapter in made.chapters] == [
        ("data", ""),
        ("conclusions", ""),
    ]
    assert made.title_page is not None
    assert made.title_page.foot == "2026"
    assert "It lifts." in PdfFile(pdf_document(made)).text
