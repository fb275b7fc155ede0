"""Documents in few bytes: packed objects say what they said, edges about letters cover what they covered."""

from __future__ import annotations

import io
import re

import numpy as np
import pypdfium2
import pytest
import typst
from matplotlib.figure import Figure

from centrode.render.document.figures import svg_of
from centrode.render.drawing.style import halo, house_style
from centrode.report.pdf_document import EPOCH, STANDARDS, with_cubic_letters
from centrode.report.pdf_objects import packed_pdf

PAGE = """#set document(title: "A table")
#outline()
= One
#table(columns: 4, table.header[a][b][c][d], ..range(600).map(k => [x#k]))
= Two
#lorem(300)
"""


@pytest.fixture(scope="module")
def page() -> bytes:
    compiler = typst.Compiler(ignore_system_fonts=True)
    made = compiler.compile(
        input={"main": PAGE.encode()}, format="pdf", timestamp=EPOCH, pdf_standards=STANDARDS[0]
    )
    assert isinstance(made, bytes)
    return made


def test_a_packed_document_shows_and_says_the_same(page: bytes) -> None:
    """PDFium reads both: pages, text, outline, tags, properties."""
    packed = packed_pdf(page)
    assert len(packed) < 0.6 * len(page)
    before, after = pypdfium2.PdfDocument(page), pypdfium2.PdfDocument(packed)
    assert len(before) == len(after) > 1
    for one, other in zip(before, after, strict=True):
        assert one.get_textpage().get_text_range() == other.get_textpage().get_text_range()
        assert np.array_equal(one.render().to_numpy(), other.render().to_numpy())
    assert [mark.get_title() for mark in before.get_toc()] == [mark.get_title() for mark in after.get_toc()]
    assert before.is_tagged() and after.is_tagged()
    assert before.get_metadata_dict() == after.get_metadata_dict()
    assert packed_pdf(page) == packed


def test_what_is_packed_or_no_document_stays(page: bytes) -> None:
    packed = packed_pdf(page)
    assert packed_pdf(packed) == packed
    assert packed_pdf(b"no document") == b"no document"


def rendered(svg: bytes) -> np.ndarray:
    """A picture in shades of grey, as typst draws it."""
    source = b'#set page(width: auto, height: auto, margin: 0pt)\n#image("a.svg", width: 288pt)'
    made = typst.Compiler(ignore_system_fonts=True).compile(
        input={"main": source, "a.svg": svg}, format="pdf"
    )
    return np.asarray(
        pypdfium2.PdfDocument(made)[0].render(scale=3.0, grayscale=True).to_numpy(), dtype=float
    )


@pytest.mark.drawn
def test_edges_about_letters_are_where_matplotlib_draws_them() -> None:
    """The same picture but for the rounding of places: where edges are left out, ten times as many pixels differ."""
    with house_style():
        figure = Figure(figsize=(4.0, 2.0))
        axes = figure.subplots()
        axes.plot([0, 1], [0, 1], linewidth=8)
        for x, text in ((0.3, "P21, B"), (0.7, "$\\varphi_{12}$")):
            axes.text(x, x, text, fontsize=14, path_effects=halo(), ha="center", va="center")
        made = svg_of(figure)
        assert all(text.get_path_effects() for text in axes.texts)
        stream = io.BytesIO()
        figure.savefig(stream, format="svg", metadata={"Date": None})
    own, plain = rendered(made), rendered(stream.getvalue())
    assert own.shape == plain.shape
    differs = np.abs(own - plain) > 64
    assert differs.mean() < 5e-4
    assert len(made) < len(stream.getvalue())


OUTLINES = re.compile(rb'<path id="([^"]*)" d="([^"]*)"')


def curves(svg: bytes, kind: str, points: int) -> list[np.ndarray]:
    """Ends and controls of all curves of one kind in the outlines of letters, the place before each in front."""
    found = []
    for _name, outline in OUTLINES.findall(svg):
        here: list[float] = []
        for letter, numbers in re.findall(r"([MLQCz])([^MLQCz]*)", outline.decode()):
            values = [float(one) for one in numbers.split()]
            if letter == kind:
                found.append(np.array([*here, *values]).reshape(points, 2))
            here = values[-2:] or here
    return found


@pytest.mark.drawn
@pytest.mark.parametrize("text", ["Speeds 0.69, Щебёнка", "Speeds 0.69, $\\varphi_{12}$, Щебёнка"])
def test_cubic_letters_cover_what_parabolas_cover(text: str) -> None:
    """The outline of a letter is that of its parabolas to a unit, far less than a pixel; the document is shorter."""
    with house_style():
        figure = Figure(figsize=(4.0, 1.0))
        figure.text(0.05, 0.3, text, fontsize=20)
        made = svg_of(figure)
    cubic = with_cubic_letters(made)
    assert b"Q" in made and b" C " in cubic and b"Q" not in cubic
    parabolas, cubics = np.stack(curves(made, "Q", 3)), np.stack(curves(cubic, "C", 4))
    share = np.linspace(0.0, 1.0, 33)[:, None, None]
    rest = 1.0 - share
    one = rest**2 * parabolas[:, 0] + 2 * rest * share * parabolas[:, 1] + share**2 * parabolas[:, 2]
    other = rest**3 * cubics[:, 0] + 3 * rest**2 * share * cubics[:, 1]
    other += 3 * rest * share**2 * cubics[:, 2] + share**3 * cubics[:, 3]
    # two controls, each rounded by half a unit, act with three quarters in the middle
    assert np.abs(one - other).max() <= 0.375 + 1e-9
    # how a viewer makes either curve straight pieces shows in a single pixel
    assert (np.abs(rendered(cubic) - rendered(made)) > 16).mean() < 1e-5
    assert with_cubic_letters(cubic) == cubic
    assert b" C " not in with_cubic_letters(made.replace(b"Q ", b"A "))
