"""Figures inside of a page: nothing acts or loads, names do not meet, the picture stays what it was."""

from __future__ import annotations

import io
import re
from xml.etree import ElementTree as Xml

import numpy as np
import pytest
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from centrode.errors import InputError
from centrode.render.drawing.style import house_style
from centrode.render.figures.files import METADATA
from centrode.report.html.drawings import Drawings

HOSTILE = b"""<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
 viewBox="0 0 10 10" onload="alert(1)"><script>alert(1)</script><style>@import "http://example.org/a.css";</style>
 <a href="http://example.org"><path id="z" d="M0 0"/></a><foreignObject><p>x</p></foreignObject>
 <g onclick="alert(1)"><path id="q" d="M 0 0 L 1 1" style="fill: url(http://example.org/b)"/></g>
 <use xlink:href="http://example.org/c#d"/><image href="https://example.org/e.png" width="1" height="1"/>
 <image href="data:image/svg+xml;base64,AAAA"/><image href="data:image/png;base64,AAAA"/>
 <animate attributeName="href" values="javascript:alert(1)"/><text>&lt;script&gt;</text></svg>"""
REFERENCE = re.compile(r'href="#([^"]+)"|url\(#([^)]+)\)')
NAME = re.compile(r' id="([^"]+)"')


def drawn(wide: float = 3.0) -> bytes:
    """A figure with letters, markers and a clip."""
    with house_style():
        figure = Figure(figsize=(wide, 2.0))
        axes = figure.subplots()
        places = np.linspace(0.0, 1.0, 5)
        axes.plot(places, places**2, "o-")
        axes.set_title("title $\\varphi_1$")
        stream = io.BytesIO()
        FigureCanvasSVG(figure).print_svg(stream, metadata=METADATA["svg"])
    return stream.getvalue()


def test_nothing_acts_or_loads() -> None:
    drawings = Drawings()
    element = drawings.embedded_figure(HOSTILE, 'a "label" <b>')
    for word in (
        "script>",
        "alert",
        "onload",
        "onclick",
        "example",
        "import",
        "foreignObject",
        "svg+xml",
        "javascript",
    ):
        assert word not in element.replace("&lt;script&gt;", ""), word
    root = Xml.fromstring(element)
    assert root.get("aria-label") == 'a "label" <b>'
    assert sum("href" in one.attrib for one in root.iter("image")) == 1


def test_names_do_not_meet() -> None:
    drawings = Drawings()
    page = "".join(drawings.embedded_figure(drawn(), str(k)) for k in range(3)) + drawings.shared_outlines()
    names = NAME.findall(page)
    wanted = {first or second for first, second in REFERENCE.findall(page)}
    assert len(names) == len(set(names))
    assert wanted == set(names)  # nothing refers to nothing, nothing has a name in vain
    assert len(wanted) > 10


def test_letters_are_drawn_once() -> None:
    once, thrice = Drawings(), Drawings()
    once.embedded_figure(drawn(), "")
    for k in range(3):
        thrice.embedded_figure(drawn(), str(k))
    assert thrice.shared_outlines() == once.shared_outlines()


def test_the_picture_is_what_it_was() -> None:
    """Every number of every line is the one that was drawn, to half a hundredth of a point."""
    before = Xml.fromstring(drawn())
    after = Xml.fromstring(Drawings().embedded_figure(drawn(), ""))
    lines = [
        one.get("d", "")
        for one in before.iter("{http://www.w3.org/2000/svg}path")
        if "clip-path" in one.attrib
    ]
    found = [one.get("d", "") for one in after.iter("path") if "clip-path" in one.attrib]
    assert len(lines) == len(found) > 3
    for line, same in zip(lines, found, strict=True):
        (steps, places), (kept_steps, kept) = followed(line), followed(same)
        assert steps == kept_steps
        assert np.abs(np.array(places) - kept).max() <= 0.005 * (1 + 1e-9)
        assert len(same) < len(line)


def followed(path: str) -> tuple[str, list[complex]]:
    """The steps of a path and every point that it names, as SVG reads it: small letters count from the last point."""
    words = re.findall(r"[A-Za-z]|-?(?:\d+\.?\d*|\.\d+)", path)
    steps, points, letter = "", [], ""
    here = start = 0j
    while words:
        if words[0].isalpha():
            letter = words.pop(0)
        steps += letter.upper()
        if letter in "zZ":
            here = start
            continue
        count = {"M": 1, "L": 1, "Q": 2, "C": 3}[letter.upper()]
        own = [complex(float(words.pop(0)), float(words.pop(0))) for _k in range(count)]
        own = [point + here for point in own] if letter.islower() else own
        points += own
        here = own[-1]
        if letter in "Mm":
            start, letter = here, "L" if letter == "M" else "l"
    return steps, points


@pytest.mark.parametrize(
    ("path", "short"),
    [
        ("M 1 1 L 2 3 L 0 3 z M 5 5 L 5.5 4.25", "M1 1l1 2-2 0zm4 4l.5-.75"),
        ("M 0 0 Q 1 2 3 4 Q 5 6 7 8", "M0 0q1 2 3 4 2 2 4 4"),
        ("M 0.004 0 L 0.008 0 L 0.012 0", "M0 0l.01 0 0 0"),  # rounded places, not rounded steps
        ("M 1 2 A 3 3 0 0 1 4 5", "M 1 2 A 3 3 0 0 1 4 5"),
    ],
)
def test_paths_go_from_point_to_point(path: str, short: str) -> None:
    svg = f'<svg xmlns="http://www.w3.org/2000/svg"><path d="{path}"/></svg>'.encode()
    root = Xml.fromstring(Drawings().embedded_figure(svg, ""))
    assert root[0].get("d") == short


def test_letters_with_an_edge_are_one_path_and_pens_stand_once() -> None:
    edge, letters = "fill: #202020; stroke: #ffffff; stroke-width: 2", "fill: #202020"
    twice = f'<path d="M 0 0 L 1 1" style="{edge}"/><path d="M 0 0 L 1 1" style="{letters}"/>'
    svg = f'<svg xmlns="http://www.w3.org/2000/svg"><g>{twice}</g><g>{twice}</g></svg>'.encode()
    drawings = Drawings()
    root = Xml.fromstring(drawings.embedded_figure(svg, ""))
    assert [one.tag for one in root] == ["path", "path"]
    assert {one.get("class") for one in root} == {"p0"}
    colours, pens = drawings.style().split("svg ", 1)
    assert pens == ".p0 { fill: var(--c0); stroke: var(--paper); stroke-width: 2; paint-order: stroke }\n"
    assert colours.startswith(":root { --c0: #202020; }")


def test_a_style_that_would_end_its_rule_stays_where_it_is() -> None:
    svg = (
        b'<svg xmlns="http://www.w3.org/2000/svg"><path d="M 0 0" style="fill: red} body {color: red"/></svg>'
    )
    drawings = Drawings()
    assert "body" in drawings.embedded_figure(svg, "") and drawings.style() == ""


def test_same_bytes() -> None:
    assert Drawings().embedded_figure(drawn(), "x") == Drawings().embedded_figure(drawn(), "x")


@pytest.mark.parametrize("wrong", [b"", b"not", b"<svg", b"<p>text</p>", b"\xff\xfe"])
def test_what_is_no_figure_is_refused(wrong: bytes) -> None:
    with pytest.raises(InputError, match="a figure is not SVG"):
        Drawings().embedded_figure(wrong, "")


SQUARES = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><g clip-path="url(#c)">
 <path d="M 0 0 L 1 0" style="{0}"/><path d="M 2 2 L 3 2" style="{0}"/><path d="M 4 4 L 5 4" style="stroke: red"/></g>
 </svg>"""


@pytest.mark.parametrize(
    ("pen", "paths"),
    [("fill: none; stroke: #000", 2), ("fill: none; stroke: #000; stroke-opacity: 0.5", 3), ("fill: red", 3)],
)
def test_lines_of_one_opaque_pen_are_one_path(pen: str, paths: int) -> None:
    """Their strokes cover the same; what is filled, or seen through where it crosses, stays by itself."""
    found = [
        one.get("d")
        for one in Xml.fromstring(Drawings().embedded_figure(SQUARES.format(pen).encode(), "")).iter("path")
    ]
    assert len(found) == paths
    assert "".join(map(str, found)) == "M0 0l1 0M2 2l1 0M4 4l1 0"


def test_a_text_is_there_once_however_many_figures_have_it() -> None:
    drawings = Drawings()
    for wide in (3.0, 4.0):
        drawings.embedded_figure(drawn(wide), "")
    shared = Xml.fromstring(drawings.shared_outlines())
    texts = ["".join(use.get("href", "") for use in group.iter("use")) for group in shared.iter("g")]
    assert len(texts) == len(set(texts)) >= 2
    names = {one.get("id") for one in shared.iter()}
    assert {use.get("href", "").removeprefix("#") for use in shared.iter("use")} <= names
