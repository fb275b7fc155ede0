"""A report as one page that holds everything it needs: no network, no fonts, no other files."""

from __future__ import annotations

import base64
import hashlib
import html
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from centrode.locale import _, speaking
from centrode.render.document.blocks import ChapterBlocks, Report, SectionBlocks
from centrode.render.document.numbering import number_blocks
from centrode.report.html.elements import Elements, formulas_in
from centrode.report.html.mathematics import formulas_of
from centrode.report.texts import blocks_of

HERE = Path(__file__).parent
FONT, COMMON_FONT = "math-font.woff2", "math-font-common.woff2"
"""All letters that formulas can hold, and those of nearly every page."""
SCRIPTS = (("page.js",), ("space.js", "picture.js", "animation.js"))
STYLE = "page.css"


def html_page(report: Report) -> bytes:
    """A report as a page (HTML, UTF-8); the same report gives the same bytes.

    Parameters
    ----------
    report : Report
        Its mathematics is laid out by typst.

    Raises
    ------
    InputError
        typst is not installed, a formula is not in its notation, a figure is no SVG.
    """
    with speaking(report.language):
        return _page(report).encode("utf-8")


def _page(report: Report) -> str:
    report = number_blocks(report)
    formulas = formulas_of(one for block in blocks_of(report) for one in formulas_in(block))
    font = COMMON_FONT if formulas.has_common_letters else FONT
    elements = Elements(formulas)
    opening = "".join(f"{elements.element(block)}\n" for block in report.opening)
    chapters = [_chapter(chapter, k, elements) for k, chapter in enumerate(report.chapters, start=1)]
    scripts = [_script(names) for names in SCRIPTS]
    contents = "".join(_entry(chapter, k) for k, chapter in enumerate(report.chapters, start=1))
    title, heading = html.escape(report.title), html.escape(_("Contents"))
    return (
        f'<!DOCTYPE html>\n<html lang="{html.escape(report.language)}">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_policy(scripts)}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>{_style(font)}{formulas.style}{elements.drawings.style()}</style>\n</head>\n<body>\n"
        f'{elements.drawings.shared()}\n<div class="sheet">\n'
        f"<nav><details open><summary>{heading}</summary><ol>{contents}</ol></details></nav>\n"
        f"<main>\n<header><h1>{title}</h1>"
        f'<p class="subtitle">{html.escape(report.subtitle)}</p></header>\n'
        f"{opening}{''.join(chapters)}</main>\n</div>\n"
        f"{''.join(f'<script>{script}</script>' for script in scripts)}\n</body>\n</html>\n"
    )


def _chapter(chapter: ChapterBlocks, number: int, elements: Elements) -> str:
    """A chapter with its sections, or why there is none."""
    drawn = f'<h2 id="c{number}"><span class="number">{number}</span>{html.escape(chapter.title)}</h2>\n'
    if chapter.missing:
        words = _("This chapter could not be made: {reason}").format(reason=chapter.missing)
        drawn += f'<p class="missing">{html.escape(words)}</p>\n'
    for part, section in _number_sections(chapter):
        if section.title:
            own = f"{number}.{part}"
            drawn += f'<h3 id="c{number}-{part}"><span class="number">{own}</span>{html.escape(section.title)}</h3>\n'
        drawn += "".join(f"{elements.element(block)}\n" for block in section.blocks)
    return f"<section>{drawn}</section>\n"


def _number_sections(chapter: ChapterBlocks) -> Iterator[tuple[int, SectionBlocks]]:
    """Sections with their numbers; those without a title are not counted."""
    number = 0
    for section in chapter.sections:
        number += bool(section.title)
        yield number, section


def _entry(chapter: ChapterBlocks, number: int) -> str:
    """A chapter in the contents."""
    parts = "".join(
        f'<li><a href="#c{number}-{part}"><span>{html.escape(section.title)}</span></a></li>'
        for part, section in _number_sections(chapter)
        if section.title
    )
    below = f"<ol>{parts}</ol>" if parts else ""
    name = f'<span class="number">{number}</span><span>{html.escape(chapter.title)}</span>'
    return f'<li><a href="#c{number}">{name}</a>{below}</li>'


def _policy(scripts: list[str]) -> str:
    """What the page may do: run its own scripts, nothing else, and load nothing."""
    sums = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in scripts
    )
    return f"default-src 'none'; script-src {sums}; style-src 'unsafe-inline'; font-src data:; img-src data:"


@cache
def _script(names: tuple[str, ...]) -> str:
    """One script of several files, whose names nothing else on the page sees."""
    return "".join(['(() => {\n"use strict";\n', *(_data(name) for name in names), "})();"])


@cache
def _data(name: str) -> str:
    return (HERE / name).read_text(encoding="utf-8")


@cache
def _style(font: str) -> str:
    letters = base64.b64encode((HERE / font).read_bytes()).decode()
    return _data(STYLE).replace("@FONT@", letters)
