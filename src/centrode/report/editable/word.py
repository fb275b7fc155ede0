"""A report as a document of word processors (Office Open XML): native formulas, styles, captions with fields."""

from __future__ import annotations

import io
import re
import tempfile
import zipfile
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from xml.sax.saxutils import escape

from centrode.locale import _, speaking
from centrode.model.page_standards import Standard
from centrode.render.document.blocks import Report, TitlePageBlocks
from centrode.render.document.outline import Heading
from centrode.report.editable.pandoc import run_pandoc
from centrode.report.editable.pictures import convert_pictures
from centrode.report.editable.tree import (
    NO_ATTRIBUTES,
    TABLE_CAPTION,
    Element,
    cell_of,
    displayed_formula,
    raw_block,
    raw_inline,
    styled_paragraph,
    tree_of,
)
from centrode.report.page_styles import page_style

FIRST = (1980, 1, 1, 0, 0, 0)
"""The first time that a ZIP knows: the same report gives the same bytes."""
REFERENCE = "reference.docx"
FONT = "Times New Roman"
FORMULA_TABLE = "Formula"
"""Style of the table that sets a formula and its number on one line."""
NUMBER = 0.1
"""Share of the width of a page that the number of a formula takes."""
HEADINGS = 4242
"""Number of the list that headings are numbered by; pandoc's own lists have others."""
DECIMAL = re.compile(r"(\d+)\{,\}(\d+)")
CAPTION = re.compile(
    r"[^<>]*(</w:t></w:r><w:fldSimple w:instr=\"SEQ (Figure|Table) [^>]*>.{0,400}?</w:fldSimple>"
    r"(?:<w:bookmarkEnd [^>]*/>)?<w:r><w:t[^>]*>):(?= )"
)
"""Pandoc's word for a figure or a table, and the colon behind its number."""


def word_document(report: Report) -> bytes:
    """A report as DOCX, whose formulas, headings, tables and captions are the word processor's own."""
    with speaking(report.language):
        words = _("Contents")
        tree, pictures = tree_of(
            report,
            _numbered_formula,
            _number_reference,
            "png",
            cover=_cover,
            contents=lambda: [raw_block("openxml", _contents(words))],
            unnumbered=_heading_without_number,
        )
    with tempfile.TemporaryDirectory() as folder:
        for name, picture in convert_pictures(pictures, "png").items():
            (Path(folder) / name).write_bytes(picture)
        (Path(folder) / REFERENCE).write_bytes(_reference(report.standard, report.is_note))
        made = run_pandoc(
            tree,
            *("--from=json", "--to=docx+native_numbering", "--standalone"),
            *(() if report.is_note else ("--toc", "--toc-depth=2")),
            *(f"--reference-doc={REFERENCE}", "--output=-"),
            folder=folder,
        )
    with speaking(report.language):
        return _change_parts(
            made, _finished_parts(report), {"word/footer-page.xml": page_number(report.standard)}
        )


def _numbered_formula(latex: str, number: int) -> list[Element]:
    """A formula with its number at the edge of the page, a field that can be referred to."""
    # a comma between digits is punctuation in mathematics, unless the number is text
    formula = cell_of([displayed_formula(DECIMAL.sub(r"\\text{\1,\2}", latex))["c"][0]], "AlignLeft")
    name = f"formula-{number}"
    field = (
        f'<w:bookmarkStart w:id="{90000 + number}" w:name="{name}"/><w:r><w:t>(</w:t></w:r>'
        f'<w:fldSimple w:instr=" SEQ Formula \\* ARABIC "><w:r><w:t>{number}</w:t></w:r></w:fldSimple>'
        f'<w:r><w:t>)</w:t></w:r><w:bookmarkEnd w:id="{90000 + number}"/>'
    )
    row = [NO_ATTRIBUTES, [formula, cell_of([raw_inline("openxml", field)], "AlignRight")]]
    widths = [
        [{"t": "AlignLeft"}, {"t": "ColWidth", "c": 1 - NUMBER}],
        [{"t": "AlignRight"}, {"t": "ColWidth", "c": NUMBER}],
    ]
    attributes = ["", [], [["custom-style", FORMULA_TABLE]]]
    nothing = [NO_ATTRIBUTES, []]
    return [
        {
            "t": "Table",
            "c": [attributes, [None, []], widths, nothing, [[NO_ATTRIBUTES, 0, [], [row]]], nothing],
        }
    ]


def _number_reference(number: int) -> Element:
    """The number of a formula as a field that repeats the one at its formula."""
    field = (
        f'<w:fldSimple w:instr=" REF formula-{number} \\h "><w:r><w:t>({number})</w:t></w:r></w:fldSimple>'
    )
    return raw_inline("openxml", field)


def _heading_without_number(heading: Heading, role: str) -> Element:
    """A heading without a number: of an element, which contents list unless it stands before them, or in one."""
    level = ELEMENT_SECTION if heading.level > 1 else ELEMENT_FRONT if role == "front" else ELEMENT
    return styled_paragraph(level, heading.title)


def _cover(page: TitlePageBlocks) -> list[Element]:
    """The title page, and what ends it."""
    middle = [styled_paragraph(COVER, one) for one in (page.course, page.variant) if one]
    found = [styled_paragraph(COVER, line) for line in page.head]
    found += [styled_paragraph(COVER_WORK, page.work)] if page.work else []
    found += [
        *middle[: bool(page.course)],
        styled_paragraph("Title", page.title),
        *middle[bool(page.course) :],
    ]
    found += [styled_paragraph(COVER_PEOPLE, f"{label}: {name}") for label, name in page.people]
    found += [styled_paragraph(COVER_FOOT, page.foot)] if page.foot else []
    return [*found, raw_block("openxml", '<w:p><w:r><w:br w:type="page"/></w:r></w:p>')]


def _contents(title: str) -> str:
    """The contents as a field, which word processors fill."""
    field = ' TOC \\o "1-2" \\h \\z \\u '
    return (
        f'<w:p><w:pPr><w:pStyle w:val="TOCHeading"/></w:pPr><w:r><w:t>{escape(title)}</w:t></w:r></w:p>'
        '<w:p><w:r><w:fldChar w:fldCharType="begin" w:dirty="true"/></w:r>'
        f'<w:r><w:instrText xml:space="preserve">{escape(field)}</w:instrText></w:r>'
        '<w:r><w:fldChar w:fldCharType="separate"/></w:r><w:r><w:fldChar w:fldCharType="end"/></w:r></w:p>'
    )


@cache
def _reference(standard: Standard, is_note: bool) -> bytes:
    """The document whose styles and page pandoc takes: its own, restyled."""
    own = run_pandoc(b"", "--print-default-data-file=reference.docx")
    changes: dict[str, Callable[[str], str]] = {
        "word/styles.xml": lambda text: _styles(text, styles_of(standard, is_note)),
        "word/document.xml": lambda text: _page(text, page_of(standard)),
    }
    return _change_parts(own, changes, {})


def _change_parts(
    document: bytes, changes: Mapping[str, Callable[[str], str]], added: Mapping[str, str]
) -> bytes:
    """A document some of whose parts are changed, and others added."""
    made = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(document)) as given, zipfile.ZipFile(made, "w") as new:
        parts = {name: given.read(name) for name in given.namelist()}
        parts |= {name: change(parts[name].decode()).encode() for name, change in changes.items()}
        parts |= {name: text.encode() for name, text in added.items()}
        for name, content in parts.items():
            new.writestr(zipfile.ZipInfo(name, FIRST), content, zipfile.ZIP_DEFLATED)
    return made.getvalue()


def _styles(text: str, styles: Mapping[str, str]) -> str:
    """Pandoc's styles without those that reports have of their own, which stand behind them."""
    for identity in styles:
        text = re.sub(rf'<w:style [^>]*w:styleId="{identity}"[^>]*>.*?</w:style>', "", text, flags=re.DOTALL)
    text = re.sub(r"<w:rFonts w:asciiTheme=[^>]*/>", FONTS, text, count=1)
    return text.replace("</w:styles>", f"{''.join(styles.values())}</w:styles>")


def _numbering(text: str) -> str:
    place = text.index("<w:num ") if "<w:num " in text else text.index("</w:numbering>")
    text = f"{text[:place]}{OUTLINE}{text[place:]}"
    number = f'<w:num w:numId="{HEADINGS}"><w:abstractNumId w:val="{HEADINGS}"/></w:num>'
    return text.replace("</w:numbering>", f"{number}</w:numbering>")


def _captions(text: str, separator: str) -> str:
    """Captions that begin as they do in PDF and on pages: pandoc's word is short in some languages, with a colon."""
    words = {"Figure": _("Figure {number}"), "Table": _("Table {number}")}
    return CAPTION.sub(lambda found: f"{words[found[2]].format(number='')}{found[1]}{separator}", text)


def _page(text: str, content: str) -> str:
    """The size and the margins of a page, and what stands on each."""
    start = text.rindex("<w:sectPr")
    return f"{text[:start]}<w:sectPr>{content}</w:sectPr></w:body></w:document>"


def _types(text: str) -> str:
    kind = "application/vnd.openxmlformats-officedocument.wordprocessingml.footer+xml"
    return text.replace(
        "</Types>", f'<Override PartName="/word/footer-page.xml" ContentType="{kind}"/></Types>'
    )


def _relations(text: str) -> str:
    kind = "http://schemas.openxmlformats.org/officeDocument/2006/relationships/footer"
    one = f'<Relationship Type="{kind}" Id="rIdPage" Target="footer-page.xml"/>'
    return text.replace("</Relationships>", f"{one}</Relationships>")


def _finished_parts(report: Report) -> Mapping[str, Callable[[str], str]]:
    """What changes in each part of the document when it is made."""
    style = page_style(report.standard)
    foot = FOOT.replace("footer", "header") if style.number == "top-right" else FOOT
    first = "<w:titlePg/>" if report.title_page is not None else ""
    page = foot + page_of(report.standard) + first

    def document(text: str) -> str:
        return _captions(_page(text, page), style.separator.rstrip())

    def properties(text: str) -> str:
        title = f"<dc:title>{escape(report.title)}</dc:title>"
        return re.sub(r"<dc:title>.*?</dc:title>|<dc:title ?/>", lambda _found: title, text, count=1)

    kind = "header" if style.number == "top-right" else "footer"
    named: Mapping[str, Callable[[str], str]] = {"docProps/core.xml": properties} if first else {}
    return {
        **named,
        "word/numbering.xml": _numbering,
        "word/document.xml": document,
        "[Content_Types].xml": lambda text: _types(text).replace("footer+xml", f"{kind}+xml"),
        "word/_rels/document.xml.rels": lambda text: _relations(text).replace(
            'relationships/footer" Id="rIdPage"', f'relationships/{kind}" Id="rIdPage"'
        ),
    }


def _style(
    identity: str,
    name: str,
    base: str,
    paragraph: str,
    run: str,
    following: str = "BodyText",
    own: bool = False,
) -> str:
    """A style of paragraphs."""
    custom = ' w:customStyle="1"' if own else ""
    return (
        f'<w:style w:type="paragraph"{custom} w:styleId="{identity}"><w:name w:val="{escape(name)}"/>'
        f'<w:basedOn w:val="{base}"/><w:next w:val="{following}"/><w:uiPriority w:val="9"/><w:qFormat/>'
        f"<w:pPr>{paragraph}</w:pPr><w:rPr>{run}</w:rPr></w:style>"
    )


def _size(points: float) -> str:
    return f'<w:sz w:val="{points * 2:g}"/><w:szCs w:val="{points * 2:g}"/>'


def _spacing(before: float, after: float) -> str:
    return f'<w:spacing w:before="{before * 20:g}" w:after="{after * 20:g}"/>'


def _heading(level: int, points: float, before: float) -> str:
    number = f'<w:numPr><w:ilvl w:val="{level - 1}"/><w:numId w:val="{HEADINGS}"/></w:numPr>'
    return _style(
        f"Heading{level}",
        f"heading {level}",
        "Normal",
        f'<w:keepNext/><w:keepLines/>{number}{_spacing(before, 6)}<w:outlineLvl w:val="{level - 1}"/>',
        f"<w:b/>{_size(points)}",
    )


FONTS = f'<w:rFonts w:ascii="{FONT}" w:hAnsi="{FONT}" w:eastAsia="{FONT}" w:cs="{FONT}"/>'
CENTRE = '<w:jc w:val="center"/>'
RULE = '<w:{side} w:val="single" w:sz="{width}" w:space="0" w:color="auto"/>'
RULES = "".join(
    RULE.format(side=side, width=width) for side, width in (("top", 6), ("bottom", 6), ("insideH", 2))
)
GRID = "".join(
    RULE.format(side=side, width=4) for side in ("top", "left", "bottom", "right", "insideH", "insideV")
)
"""Lines of a table: of the program's own style, and of the standards, which bound cells on all sides."""
SHADE = '<w:shd w:val="clear" w:color="auto" w:fill="F0F0F0"/>'
CELLS = (
    '<w:tblInd w:w="0" w:type="dxa"/><w:tblBorders>{rules}</w:tblBorders><w:tblCellMar>'
    '<w:top w:w="20" w:type="dxa"/><w:left w:w="60" w:type="dxa"/>'
    '<w:bottom w:w="20" w:type="dxa"/><w:right w:w="60" w:type="dxa"/></w:tblCellMar>'
)
HEAD_ROW = (
    '<w:tblStylePr w:type="firstRow"><w:rPr><w:b/></w:rPr><w:tcPr>'
    f"<w:tcBorders>{RULE.format(side='bottom', width=6)}</w:tcBorders>"
    f'{SHADE}<w:vAlign w:val="center"/></w:tcPr></w:tblStylePr>'
)
STYLES = {
    "Title": _style("Title", "Title", "Normal", f"{_spacing(120, 6)}{CENTRE}", f"<w:b/>{_size(22)}"),
    "Subtitle": _style("Subtitle", "Subtitle", "Normal", f"{_spacing(0, 24)}{CENTRE}", _size(11)),
    "BodyText": _style("BodyText", "Body Text", "Normal", _spacing(4, 4), ""),
    "Compact": _style("Compact", "Compact", "Normal", _spacing(1, 1), "", own=True),
    "Heading1": _heading(1, 16, 20),
    "Heading2": _heading(2, 13, 14),
    "TOCHeading": _style(
        "TOCHeading",
        "TOC Heading",
        "Normal",
        f'<w:keepNext/><w:numPr><w:numId w:val="0"/></w:numPr>{_spacing(12, 6)}',
        f"<w:b/>{_size(16)}",
    ),
    "Caption": _style("Caption", "caption", "Normal", f"<w:keepLines/>{_spacing(2, 8)}{CENTRE}", _size(10)),
    "CaptionedFigure": _style(
        "CaptionedFigure",
        "Captioned Figure",
        "Normal",
        f"<w:keepNext/>{_spacing(8, 0)}{CENTRE}",
        "",
        own=True,
    ),
    "Table": (
        '<w:style w:type="table" w:default="1" w:styleId="Table"><w:name w:val="Table"/>'
        f'<w:basedOn w:val="TableNormal"/><w:qFormat/><w:rPr>{_size(9)}</w:rPr>'
        f"<w:tblPr>{CELLS.format(rules=RULES)}</w:tblPr>{HEAD_ROW}</w:style>"
    ),
    FORMULA_TABLE: (
        f'<w:style w:type="table" w:customStyle="1" w:styleId="{FORMULA_TABLE}">'
        f'<w:name w:val="{FORMULA_TABLE}"/><w:basedOn w:val="TableNormal"/><w:qFormat/>'
        f'<w:tblPr>{CELLS.format(rules="")}</w:tblPr><w:tcPr><w:vAlign w:val="center"/></w:tcPr></w:style>'
    ),
}
"""Styles by their names inside of the document, in place of pandoc's."""
OUTLINE = (
    f'<w:abstractNum w:abstractNumId="{HEADINGS}"><w:multiLevelType w:val="multilevel"/>'
    + "".join(
        f'<w:lvl w:ilvl="{level}"><w:start w:val="1"/><w:numFmt w:val="decimal"/>'
        f'<w:pStyle w:val="Heading{level + 1}"/><w:lvlText w:val="{text}"/><w:lvlJc w:val="left"/>'
        '<w:pPr><w:ind w:left="567" w:hanging="567"/></w:pPr></w:lvl>'
        for level, text in enumerate(("%1", "%1.%2", "%1.%2.%3"))
    )
    + "</w:abstractNum>"
)
FOOT = '<w:footerReference w:type="default" r:id="rIdPage"/>'
ELEMENT, ELEMENT_FRONT, ELEMENT_SECTION = "Element", "Element Front", "Element Section"
COVER, COVER_WORK, COVER_PEOPLE, COVER_FOOT = "Cover", "Cover Work", "Cover People", "Cover Foot"
"""Names of the styles of notes: headings without numbers, lines of the title page."""
TWIPS = 1440 / 25.4
"""Twentieths of a point that a millimetre has."""


def styles_of(standard: Standard, is_note: bool) -> Mapping[str, str]:
    """Styles by their names inside of the document, in place of pandoc's: of a standard, and of notes."""
    styles = dict(STYLES)
    if standard != "plain":
        styles |= _standard_styles(standard)
    if is_note:
        styles |= _note_styles(standard, styles)
    return styles


def _standard_styles(standard: Standard) -> dict[str, str]:
    """Text, headings, captions and tables as a standard has them."""
    style, styles = page_style(standard), STYLES
    size = _size(style.size)
    indent = f'<w:ind w:firstLine="{style.indent * TWIPS:.0f}"/>'
    spaced = (
        f'<w:spacing w:before="0" w:after="0" w:line="360" w:lineRule="auto"/>{indent}<w:jc w:val="both"/>'
    )
    return {
        "BodyText": _style("BodyText", "Body Text", "Normal", spaced, size),
        "Compact": _style("Compact", "Compact", "Normal", _spacing(1, 1), size, own=True),
        "Title": _style("Title", "Title", "Normal", f"{_spacing(12, 12)}{CENTRE}", f"<w:b/>{_size(18)}"),
        "TOCHeading": styles["TOCHeading"]
        .replace("<w:keepNext/>", "<w:keepNext/><w:pageBreakBefore/>")
        .replace("</w:pPr>", f"{CENTRE}</w:pPr>")
        .replace(_size(16), f"<w:caps/>{_size(style.size)}"),
        "Caption": _style("Caption", "caption", "Normal", f"<w:keepLines/>{_spacing(4, 8)}{CENTRE}", size),
        "ImageCaption": _style("ImageCaption", "Image Caption", "Caption", "", "", own=True),
        "TableCaption": _style(
            "TableCaption", TABLE_CAPTION, "Caption", '<w:keepNext/><w:jc w:val="left"/>', "", own=True
        ),
        "Heading1": _heading(1, style.size, 12)
        .replace("<w:keepLines/>", "<w:keepLines/><w:pageBreakBefore/>")
        .replace("<w:b/>", "<w:b/><w:caps/>" if style.capital_parts else "<w:b/>"),
        "Heading2": _heading(2, style.size, 12),
        "Heading3": _heading(3, style.size, 12),
        "Table": styles["Table"]
        .replace(RULES, GRID)
        .replace(SHADE, "")
        .replace(_size(9), _size(style.tables[-1])),
    }


def _note_styles(standard: Standard, styles: Mapping[str, str]) -> dict[str, str]:
    """Elements of a note that are no chapters, and the lines of its title page; `styles` are those of its text."""
    style = page_style(standard)
    size, bold = _size(style.size), f"<w:b/>{_size(style.size)}"
    new_page = "<w:pageBreakBefore/>" if standard != "plain" else ""
    centred = f"{new_page}{_spacing(0, 12)}{CENTRE}"
    big = bold.replace("<w:b/>", "<w:b/><w:caps/>") if new_page else f"<w:b/>{_size(16)}"
    before = {COVER_WORK: 130, COVER_PEOPLE: 12, COVER_FOOT: 110}
    return {
        "Heading3": styles.get("Heading3", _heading(3, 11, 12)),
        "Element": _style(
            "Element",
            ELEMENT,
            "Normal",
            f'<w:keepNext/>{centred}<w:outlineLvl w:val="0"/>',
            big,
            own=True,
        ),
        "ElementFront": _style(
            "ElementFront", ELEMENT_FRONT, "Normal", f"<w:keepNext/>{centred}", big, own=True
        ),
        "ElementSection": _style(
            "ElementSection", ELEMENT_SECTION, "Normal", f"<w:keepNext/>{_spacing(12, 6)}", bold, own=True
        ),
        "Cover": _style("Cover", COVER, "Normal", f"{_spacing(0, 6)}{CENTRE}", size, own=True),
        "CoverWork": _style(
            "CoverWork",
            COVER_WORK,
            "Normal",
            f"{_spacing(before[COVER_WORK], 6)}{CENTRE}",
            bold,
            own=True,
        ),
        "CoverPeople": _style(
            "CoverPeople",
            COVER_PEOPLE,
            "Normal",
            f'{_spacing(before[COVER_PEOPLE], 6)}<w:ind w:left="4536"/>',
            size,
            own=True,
        ),
        "CoverFoot": _style(
            "CoverFoot",
            COVER_FOOT,
            "Normal",
            f"{_spacing(before[COVER_FOOT], 0)}{CENTRE}",
            size,
            own=True,
        ),
    }


def page_of(standard: Standard) -> str:
    """Size and margins of a page."""
    style = page_style(standard)
    sides = {"top": style.top, "right": style.right, "bottom": style.bottom, "left": style.left}
    if standard == "plain":
        sides["top"] = style.bottom
    margins = " ".join(f'w:{side}="{value * TWIPS:.0f}"' for side, value in sides.items())
    return f'<w:pgSz w:w="11906" w:h="16838"/><w:pgMar {margins} w:header="567" w:footer="567" w:gutter="0"/>'


def page_number(standard: Standard) -> str:
    """What stands on each page: its number, below in the middle or above at the right."""
    above = page_style(standard).number == "top-right"
    root, place = ("hdr", '<w:jc w:val="right"/>') if above else ("ftr", CENTRE)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>'
        f'<w:{root} xmlns:w="http://schemas.openxmlformats.org/wordprocessingml/2006/main"><w:p><w:pPr>'
        f'{place}</w:pPr><w:fldSimple w:instr=" PAGE "><w:r><w:t>1</w:t></w:r></w:fldSimple></w:p></w:{root}>'
    )
