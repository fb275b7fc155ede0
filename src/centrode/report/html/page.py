"""A report as one page that holds everything it needs: no network, no fonts, no other files."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from functools import cache

from centrode.locale import _, speaking
from centrode.render.document.blocks import Moving, Report
from centrode.render.document.captions import number_blocks
from centrode.render.document.outline import Heading, OutlinedChapter, outline_of
from centrode.report.html.elements import Elements, formulas_in
from centrode.report.html.fonts import embedded_font, font_letters
from centrode.report.html.mathematics import formulas_of
from centrode.report.html.parts import page_part, page_policy, page_script
from centrode.report.page_styles import page_style
from centrode.report.texts import blocks_of

SCRIPTS = (("page.js",), ("space.js", "picture.js", "animation.js", "motions.js"))
STYLES = ("font.css", "base.css", "document.css", "motion.css", "print.css")
NOTE_STYLE = """
h4 { font-size: 1.05rem; margin: 1.6rem 0 0.5rem; }
h4 .number { color: var(--muted); margin-right: 0.5em; }
.cover { text-align: center; padding-bottom: 2rem; }
.cover p { margin: 0.2rem 0; }
.cover .work { font-weight: bold; margin-top: 4rem; }
.cover h1 { margin: 1rem 0; }
.cover .people { text-align: left; margin-left: 50%; }
.cover .course + .people { margin-top: 3rem; }
.cover .foot { margin-top: 3rem; }
@media print { section:has(> h2) { break-before: page; } .cover { break-after: page; } }
"""
"""What pages of notes have besides."""


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
    elements = Elements(formulas, separator=page_style(report.standard).separator)
    outline = list(outline_of(report))
    opening = "" if report.is_note else _opening(report, elements)
    chapters = [_chapter(one, k, elements, report) for k, one in enumerate(outline, start=1)]
    scripts = [_script(names) for names in SCRIPTS]
    contents = _contents(outline)
    note_style = NOTE_STYLE if report.is_note else ""
    main = f"{_header(report)}\n{opening}{''.join(chapters)}"
    moving = (one for one in blocks_of(report) if isinstance(one, Moving))
    names = (name for one in moving for name in one.places)
    font = embedded_font(font_letters(formulas.letters, names, f"{report.title}{contents}{main}"))
    styles = "".join(map(page_part, STYLES))
    style = f"{styles.replace('@FONT@', font)}{note_style}{formulas.style}{elements.drawings.style()}"
    title, heading = html.escape(report.title), html.escape(_("Contents"))
    return (
        f'<!DOCTYPE html>\n<html lang="{html.escape(report.language)}">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{page_policy(scripts)}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{title}</title>\n<style>{style}</style>\n</head>\n<body>\n"
        f'{elements.drawings.shared_outlines()}\n<div class="sheet">\n'
        f"<nav><details open><summary>{heading}</summary><ol>{contents}</ol></details></nav>\n"
        f"<main>\n{main}</main>\n</div>\n"
        f"{''.join(f'<script>{script}</script>' for script in scripts)}\n</body>\n</html>\n"
    )


def _header(report: Report) -> str:
    """The title with what was computed, or the title page."""
    title, page = html.escape(report.title), report.title_page
    if page is None:
        return f'<header><h1>{title}</h1><p class="subtitle">{html.escape(report.subtitle)}</p></header>'

    def lines(kind: str, texts: Iterable[str]) -> str:
        return "".join(f'<p class="{kind}">{html.escape(one)}</p>' for one in texts if one)

    people = (f"{label}: {name}" for label, name in page.people)
    return (
        f'<header class="cover">{lines("head", page.head)}{lines("work", (page.work,))}'
        f"{lines('course', (page.course,))}<h1>{title}</h1>{lines('course', (page.variant,))}"
        f"{lines('people', people)}{lines('foot', (page.foot,))}</header>"
    )


def _opening(report: Report, elements: Elements) -> str:
    return "".join(f"{elements.element(block)}\n" for block in report.opening)


def _chapter(outlined: OutlinedChapter, place: int, elements: Elements, report: Report) -> str:
    """A chapter with its sections, or why there is none; `place` is that in the document."""
    chapter = outlined.chapter
    *above, own = outlined.headings
    drawn = "".join(_heading(heading, f"p{place}") for heading in above)
    drawn += _heading(own, f"c{place}")
    if chapter.missing:
        words = _("This chapter could not be made: {reason}").format(reason=chapter.missing)
        drawn += f'<p class="missing">{html.escape(words)}</p>\n'
    if outlined.opens:
        drawn += _opening(report, elements)
    part = 0
    for heading, section in outlined.sections:
        if heading is not None:
            part += 1
            drawn += _heading(heading, f"c{place}-{part}")
        drawn += "".join(f"{elements.element(block)}\n" for block in section.blocks)
    return f"<section>{drawn}</section>\n"


def _heading(heading: Heading, name: str) -> str:
    """A heading with its number; an appendix has its letter in its title."""
    kind = f"h{heading.level + 1}"
    return f'<{kind} id="{name}">{_number(heading)}{html.escape(heading.title)}</{kind}>\n'


def _number(heading: Heading) -> str:
    shown = heading.number and not heading.number.isalpha()
    return f'<span class="number">{heading.number}</span>' if shown else ""


def _contents(outline: Sequence[OutlinedChapter]) -> str:
    """Chapters with their sections; parts of a note with their chapters."""
    found, inside = "", ""
    for place, outlined in enumerate(outline, start=1):
        *above, own = outlined.headings
        if above or own.level == 1:
            found += f"{inside}</ol></li>" if inside else ""
            inside = ""
        if above:
            found += f'<li><a href="#p{place}">{_entry_text(above[0])}</a><ol>'
        if own.level > 1:
            inside += f'<li><a href="#c{place}">{_entry_text(own)}</a></li>'
        else:
            found += _entry(outlined, own, place)
    return f"{found}{inside}</ol></li>" if inside else found


def _entry(outlined: OutlinedChapter, own: Heading, place: int) -> str:
    """A chapter in the contents."""
    titles = [heading for heading, _section in outlined.sections if heading is not None]
    parts = "".join(
        f'<li><a href="#c{place}-{part}"><span>{html.escape(heading.title)}</span></a></li>'
        for part, heading in enumerate(titles, start=1)
    )
    below = f"<ol>{parts}</ol>" if parts else ""
    return f'<li><a href="#c{place}">{_entry_text(own)}</a>{below}</li>'


def _entry_text(heading: Heading) -> str:
    return f"{_number(heading)}<span>{html.escape(heading.title)}</span>"


@cache
def _script(names: tuple[str, ...]) -> str:
    """One script of several files."""
    return page_script(map(page_part, names))
