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
from centrode.render.document.blocks import Report
from centrode.report.editable.pandoc import run_pandoc
from centrode.report.editable.pictures import convert_pictures
from centrode.report.editable.tree import NO_ATTRIBUTES, Element, cell_of, displayed, raw_inline, tree_of

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
        tree, pictures = tree_of(report, _numbered_formula, _referred, "png")
    with tempfile.TemporaryDirectory() as folder:
        for name, picture in convert_pictures(pictures, "png").items():
            (Path(folder) / name).write_bytes(picture)
        (Path(folder) / REFERENCE).write_bytes(_reference())
        made = run_pandoc(
            tree,
            *("--from=json", "--to=docx+native_numbering", "--standalone", "--toc", "--toc-depth=2"),
            *(f"--reference-doc={REFERENCE}", "--output=-"),
            folder=folder,
        )
    with speaking(report.language):
        return _change_parts(made, FINISHED, {"word/footer-page.xml": FOOTER})


def _numbered_formula(latex: str, number: int) -> list[Element]:
    """A formula with its number at the edge of the page, a field that can be referred to."""
    # a comma between digits is punctuation in mathematics, unless the number is text
    formula = cell_of([displayed(DECIMAL.sub(r"\\text{\1,\2}", latex))["c"][0]], "AlignLeft")
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


def _referred(number: int) -> Element:
    """The number of a formula as a field that repeats the one at its formula."""
    field = (
        f'<w:fldSimple w:instr=" REF formula-{number} \\h "><w:r><w:t>({number})</w:t></w:r></w:fldSimple>'
    )
    return raw_inline("openxml", field)


@cache
def _reference() -> bytes:
    """The document whose styles and page pandoc takes: its own, restyled."""
    own = run_pandoc(b"", "--print-default-data-file=reference.docx")
    return _change_parts(
        own, {"word/styles.xml": _styles, "word/document.xml": lambda text: _page(text, PAGE)}, {}
    )


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


def _styles(text: str) -> str:
    """Pandoc's styles without those that reports have of their own, which stand behind them."""
    for identity in STYLES:
        text = re.sub(rf'<w:style [^>]*w:styleId="{identity}"[^>]*>.*?</w:style>', "", text, flags=re.DOTALL)
    text = re.sub(r"<w:rFonts w:asciiTheme=[^>]*/>", FONTS, text, count=1)
    return text.replace("</w:styles>", f"{''.join(STYLES.values())}</w:styles>")


def _numbering(text: str) -> str:
    place = text.index("<w:num ") if "<w:num " in text else text.index("</w:numbering>")
    text = f"{text[:place]}{OUTLINE}{text[place:]}"
    number = f'<w:num w:numId="{HEADINGS}"><w:abstractNumId w:val="{HEADINGS}"/></w:num>'
    return text.replace("</w:numbering>", f"{number}</w:numbering>")


def _captions(text: str) -> str:
    """Captions that begin as they do in PDF and on pages: pandoc's word is short in some languages, with a colon."""
    words = {"Figure": _("Figure {number}"), "Table": _("Table {number}")}
    return CAPTION.sub(lambda found: f"{words[found[2]].format(number='')}{found[1]}.", text)


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


FINISHED: Mapping[str, Callable[[str], str]] = {
    "word/numbering.xml": _numbering,
    "word/document.xml": lambda text: _captions(_page(text, FOOT + PAGE)),
    "[Content_Types].xml": _types,
    "word/_rels/document.xml.rels": _relations,
}
"""What changes in each part of the document when it is made."""


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
CELLS = (
    '<w:tblInd w:w="0" w:type="dxa"/><w:tblBorders>{rules}</w:tblBorders><w:tblCellMar>'
    '<w:top w:w="20" w:type="dxa"/><w:left w:w="60" w:type="dxa"/>'
    '<w:bottom w:w="20" w:type="dxa"/><w:right w:w="60" w:type="dxa"/></w:tblCellMar>'
)
HEAD_ROW = (
    '<w:tblStylePr w:type="firstRow"><w:rPr><w:b/></w:rPr><w:tcPr>'
    f"<w:tcBorders>{RULE.format(side='bottom', width=6)}</w:tcBorders>"
    '<w:shd w:val="clear" w:color="auto" w:fill="F0F0F0"/><w:vAlign w:val="center"/></w:tcPr></w:tblStylePr>'
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
        for level, text in enumerate(("%1", "%1.%2"))
    )
    + "</w:abstractNum>"
)
FOOT = '<w:footerReference w:type="default" r:id="rIdPage"/>'
PAGE = (
    '<w:pgSz w:w="11906" w:h="16838"/><w:pgMar w:top="1134" w:right="1134" w:bottom="1134" w:left="1134"'
    ' w:header="567" w:footer="567" w:gutter="0"/>'
)
FOOTER = (
    '<?xml version="1.0" encoding="UTF-8"?>'
    '<w:ftr xmlns:w="http://schemas.openxmlformats.org/wordprocessingml/2006/main"><w:p><w:pPr>'
    f'{CENTRE}</w:pPr><w:fldSimple w:instr=" PAGE "><w:r><w:t>1</w:t></w:r></w:fldSimple></w:p></w:ftr>'
)
