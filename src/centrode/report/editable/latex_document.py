"""A report as a LaTeX document (amsmath) with its figures in a folder beside it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from centrode.locale import _, speaking
from centrode.render.document.blocks import Report, TitlePageBlocks
from centrode.render.latex import escape
from centrode.report.editable.pandoc import run_pandoc
from centrode.report.editable.pictures import convert_pictures
from centrode.report.editable.tree import Element, continued_table, raw_block, raw_inline, tree_of
from centrode.report.page_styles import page_style

LANGUAGES = {"en": "english", "ru": "russian", "uk": "ukrainian"}
"""Names of languages in LaTeX."""
LETTERS = {
    "\u2212": r"\ensuremath{-}", "\u221e": r"\ensuremath{\infty}", "\u00b7": r"\ensuremath{\cdot}",
    "\u202f": r"\,", "\u2713": r"\ensuremath{\checkmark}", "\u2717": r"\ensuremath{\times}",
    "\u22a5": r"\ensuremath{\perp}", "\u2225": r"\ensuremath{\parallel}", "\u2265": r"\ensuremath{\ge}",
    "\u2264": r"\ensuremath{\le}", "\u00d7": r"\ensuremath{\times}", "\u00b1": r"\ensuremath{\pm}",
    "\u2248": r"\ensuremath{\approx}", "\u2260": r"\ensuremath{\ne}", "\u2192": r"\ensuremath{\to}",
    "\u2032": r"\ensuremath{'}", "\u2033": r"\ensuremath{''}", "\u221a": r"\ensuremath{\surd}",
    "\u03b1": r"\ensuremath{\alpha}", "\u03b2": r"\ensuremath{\beta}", "\u03b3": r"\ensuremath{\gamma}",
    "\u03b4": r"\ensuremath{\delta}", "\u03b5": r"\ensuremath{\varepsilon}", "\u03b7": r"\ensuremath{\eta}",
    "\u03b8": r"\ensuremath{\theta}", "\u03ba": r"\ensuremath{\kappa}", "\u03bb": r"\ensuremath{\lambda}",
    "\u03bc": r"\ensuremath{\mu}", "\u03bd": r"\ensuremath{\nu}", "\u03be": r"\ensuremath{\xi}",
    "\u03c0": r"\ensuremath{\pi}", "\u03c1": r"\ensuremath{\rho}", "\u03c3": r"\ensuremath{\sigma}",
    "\u03c4": r"\ensuremath{\tau}", "\u03c6": r"\ensuremath{\varphi}", "\u03c8": r"\ensuremath{\psi}",
    "\u03c9": r"\ensuremath{\omega}", "\u0394": r"\ensuremath{\Delta}", "\u03a3": r"\ensuremath{\Sigma}",
    "\u03a6": r"\ensuremath{\Phi}", "\u03a9": r"\ensuremath{\Omega}", "\u207b": r"\textsuperscript{-}",
    "\u2070": r"\textsuperscript{0}", "\u2074": r"\textsuperscript{4}", "\u2075": r"\textsuperscript{5}",
    "\u2076": r"\textsuperscript{6}", "\u2077": r"\textsuperscript{7}", "\u2078": r"\textsuperscript{8}",
    "\u2079": r"\textsuperscript{9}", "\u2080": r"\textsubscript{0}", "\u2081": r"\textsubscript{1}",
    "\u2082": r"\textsubscript{2}", "\u2083": r"\textsubscript{3}", "\u2084": r"\textsubscript{4}",
    "\u2085": r"\textsubscript{5}", "\u2086": r"\textsubscript{6}", "\u207f": r"\textsuperscript{n}",
    "\u1d57": r"\textsuperscript{t}", "\u1d4f": r"\textsuperscript{k}", "\u02b3": r"\textsuperscript{r}",
}  # fmt: skip
"""Letters of reports that the fonts of LaTeX may lack."""
HEAD = r"""% Compiles with LuaLaTeX, XeLaTeX and pdfLaTeX (twice, for the contents). The figures lie in FIGURES/.
\documentclass[11pt,a4paper]{article}
\usepackage{iftex}
\ifPDFTeX
  \usepackage[T1,T2A]{fontenc}
  \usepackage[utf8]{inputenc}
\else
  \usepackage{fontsetup}
\fi
\usepackage[LANGUAGE]{babel}
\usepackage{amsmath,amssymb}
\usepackage[margin=2cm]{geometry}
\usepackage{graphicx,float,array,calc,longtable,booktabs}
\usepackage{newunicodechar,etoolbox}
\usepackage[unicode,hidelinks]{hyperref}
\floatplacement{figure}{H}
\AtBeginEnvironment{longtable}{\footnotesize}
\allowdisplaybreaks
\sloppy
\setcounter{secnumdepth}{2}
\setcounter{tocdepth}{2}
\providecommand{\tightlist}{\setlength{\itemsep}{0pt}\setlength{\parskip}{0pt}}
\newcommand{\pandocbounded}[1]{#1}
"""

TABLE_OF_CONTENTS = "\\tableofcontents"
STANDARD_PAGE = r"""\usepackage{setspace,indentfirst,fancyhdr,titlesec,caption}
\onehalfspacing
\pagestyle{fancy}
\fancyhf{}
\renewcommand{\headrulewidth}{0pt}
\titleformat{\section}[block]{\normalfont\bfseries}{\thesection}{1ex}{}
\titleformat{name=\section,numberless}[block]{\normalfont\bfseries\centering}{}{0pt}{\MakeUppercase}
\titleformat{\subsection}[block]{\normalfont\bfseries}{\thesubsection}{1ex}{}
\titleformat{\subsubsection}[block]{\normalfont\bfseries}{\thesubsubsection}{1ex}{}
\titlespacing*{\section}{\parindent}{*3}{*3}
\titlespacing*{name=\section,numberless}{0pt}{*3}{*3}
\titlespacing*{\subsection}{\parindent}{*3}{*2}
\titlespacing*{\subsubsection}{\parindent}{*3}{*2}
\pretocmd{\section}{\clearpage}{}{}
\captionsetup{labelsep=endash}
\captionsetup[table]{justification=raggedright,singlelinecheck=false}
"""
"""What notes by a standard have in their preamble besides: numbers of pages and headings, captions, spaces."""

NUMBERED_PART = r"\titleformat{\section}[block]{\normalfont\bfseries}{\thesection}{1ex}{}"


def latex_document(report: Report, figures: str) -> tuple[bytes, Mapping[str, bytes]]:
    """A report as LaTeX, and its figures as PDF by their names.

    Parameters
    ----------
    report : Report
    figures : name of the folder in which the figures lie

    Returns
    -------
    source, figures
    """
    with speaking(report.language):
        contents = _("Contents")
        tree, pictures = tree_of(
            report,
            _numbered_formula,
            _number_reference,
            "pdf",
            contents=lambda: [raw_block("latex", TABLE_OF_CONTENTS)],
        )
        words = (_("Figure {number}"), _("Table {number}"))
        continued = continued_table("\\thetable{}")
    body = run_pandoc(tree, "--from=json", "--to=latex-smart-auto_identifiers", "--wrap=preserve").decode()
    body = _with_continuations(_in_folder(body, pictures, figures), continued)
    letters = "".join(
        f"\\newunicodechar{{{letter}}}{{{code}}}\n" for letter, code in LETTERS.items() if letter in body
    )
    source = (
        _head(report).replace("LANGUAGE", LANGUAGES[report.language]).replace("FIGURES", figures)
        + letters
        + _page(report, [word.format(number="").strip() for word in words])
        + _beginning(report, contents)
        + body
        + "\\end{document}\n"
    )
    return source.encode(), convert_pictures(pictures, "pdf")


def _head(report: Report) -> str:
    """The preamble; a standard has a size of letters that `article` has not."""
    if report.standard == "plain":
        return HEAD
    size = page_style(report.standard).size
    return HEAD.replace("[11pt,a4paper]{article}", f"[{size:g}pt,a4paper]{{extarticle}}")


def _page(report: Report, words: Sequence[str]) -> str:
    """Margins, number of the page, headings and captions of a standard."""
    if report.standard == "plain":
        return ""
    style = page_style(report.standard)
    figure, table = words
    place = "\\fancyhead[R]{\\thepage}" if style.number == "top-right" else "\\fancyfoot[C]{\\thepage}"
    preamble = STANDARD_PAGE
    if style.capital_parts:
        preamble = preamble.replace(NUMBERED_PART, f"{NUMBERED_PART[:-1]}\\MakeUppercase}}")
    return (
        f"\\geometry{{left={style.left:g}mm,right={style.right:g}mm,top={style.top:g}mm,bottom={style.bottom:g}mm}}\n"
        f"\\setlength{{\\headheight}}{{17pt}}\n{preamble}{place}\n"
        f"\\setlength{{\\parindent}}{{{style.indent:g}mm}}\n"
        f"\\AtBeginDocument{{\\renewcommand{{\\figurename}}{{{figure}}}\\renewcommand{{\\tablename}}{{{table}}}}}\n"
    )


def _cover(page: TitlePageBlocks) -> str:
    """The title page."""
    people = "".join(f"\\noindent {escape(f'{label}: {name}')}\\\\\n" for label, name in page.people)
    middle = [f"{{\\bfseries {escape(page.work)}}}" if page.work else "", escape(page.course)]
    middle += [f"{{\\Large\\bfseries {escape(page.title)}}}", escape(page.variant)]
    lines = "\\\\[1ex]\n".join(one for one in middle if one)
    head = "\\\\\n".join(map(escape, page.head))
    box = f"\\begin{{minipage}}{{0.6\\textwidth}}\n{people}\\end{{minipage}}"
    right = f"\\begin{{flushright}}{box}\\end{{flushright}}\n"
    return (
        f"\\begin{{titlepage}}\n\\centering\n{head}\n\n\\vfill\n{lines}\n\n\\vfill\n"
        f"{right if page.people else ''}\\vfill\n{escape(page.foot)}\n\\end{{titlepage}}\n\\setcounter{{page}}{{2}}\n"
    )


def _beginning(report: Report, contents: str) -> str:
    title = escape(" ".join(report.title.split()))
    subtitle = escape(" ".join(report.subtitle.split()))
    # quotation marks are short for accents and dashes in these languages: here they are themselves
    plain = "" if report.language == "en" else '\\shorthandoff{"}\n'
    if report.is_note:
        cover = "\\maketitle\n" if report.title_page is None else _cover(report.title_page)
        return (
            f"\\setcounter{{secnumdepth}}{{3}}\n\\title{{{title}}}\n\\author{{}}\n\\date{{}}\n\n"
            f"\\begin{{document}}\n{plain}\\renewcommand{{\\contentsname}}{{{contents}}}\n{cover}\n"
        )
    return (
        f"\\title{{{title}}}\n\\author{{}}\n\\date{{{subtitle}}}\n\n\\begin{{document}}\n{plain}\\maketitle\n"
        f"\\renewcommand{{\\contentsname}}{{{contents}}}\n\\tableofcontents\n\n"
    )


def _in_folder(body: str, pictures: Mapping[str, bytes], folder: str) -> str:
    """The names of pictures with their folder before them."""
    names = "|".join(map(re.escape, pictures))
    if not names:
        return body
    found = re.compile(rf"(\\includegraphics(?:\[(?:[^\[\]{{}}]|\{{[^{{}}]*\}})*\])?)\{{({names})\}}")
    return found.sub(lambda one: f"{one[1]}{{{folder}/{one[2]}}}", body)


_LONG_TABLE = re.compile(r"(- (\d+)\\tabcolsep\)(?:(?!\\end\{longtable\}).)*?\\endfirsthead\n)", re.DOTALL)
"""A table up to the head of its further pages; between n columns there is 2 (n - 1) times the space of one side."""


def _with_continuations(body: str, continued: str) -> str:
    """Tables with a line above the head that further pages repeat."""

    def add_line(found: re.Match[str]) -> str:
        return f"{found[1]}\\multicolumn{{{int(found[2]) // 2 + 1}}}{{@{{}}l@{{}}}}{{{continued}}} \\\\\n"

    return _LONG_TABLE.sub(add_line, body)


def _numbered_formula(latex: str, number: int) -> list[Element]:
    """A formula that LaTeX numbers, with a label to refer to."""
    return [raw_block("latex", f"\\begin{{equation}}\\label{{eq:{number}}}\n{latex}\n\\end{{equation}}")]


def _number_reference(number: int) -> Element:
    """The number of a formula that LaTeX looks up."""
    return raw_inline("latex", f"\\eqref{{eq:{number}}}")
