"""The chapter of a report on a synthesis: its table, pictures and construction, in three languages."""

from __future__ import annotations

from pathlib import Path

import pytest

import centrode as ct
from centrode.render.document.blocks import Picture, TableBlock
from centrode.report.html.page import html_page

LEVER = """title = "Lever of a press"
display = { length = "mm", angle = "deg" }

[report]
digits = 5

[synthesis]
topology = "crank-rocker"
kind = "strokes"
swing = "40 deg"
time_ratio = 1.25
transmission = "35 deg"
length = "200 mm"
answers = 3
"""
TERMS = {
    "en": ("synthesis of the mechanism", "limit positions", "time ratio", "the best answer"),
    "ru": (
        "синтез механизма",
        "крайние положения",
        "коэффициент изменения средней скорости",
        "лучшее решение",
    ),
    "uk": (
        "синтез механізму",
        "крайні положення",
        "коефіцієнт зміни середньої швидкості",
        "найкращий розв",
    ),
}


@pytest.fixture
def lever(tmp_path: Path) -> Path:
    file = tmp_path / "lever.toml"
    file.write_text(LEVER, "utf-8")
    return file


def test_a_chapter_of_strokes(lever: Path) -> None:
    made = ct.report(lever)
    assert made.title == "Lever of a press"
    (chapter,) = [one for one in made.chapters if one.name == "synthesis"]
    assert not chapter.missing
    blocks = [block for section in chapter.sections for block in section.blocks]
    assert any(isinstance(block, Picture) for block in blocks)
    tables = [block for block in blocks if isinstance(block, TableBlock)]
    answers = next(block for block in tables if len(block.rows) == 3)
    best = ct.synthesise(lever).mechanism
    # the crank of the table is that of the description, in its unit and digits
    assert any(f"{best.links['OA'].length * 1e3:.3f}"[:5] in cell for cell in map(str, answers.rows[0]))


@pytest.mark.parametrize("language", TERMS)
def test_terms(lever: Path, language: str) -> None:
    page = html_page(ct.report(lever, language=language)).decode().lower()
    for term in TERMS[language]:
        assert term in page


def test_a_request_itself_and_one_without_answers(lever: Path) -> None:
    assert ct.report(ct.read_synthesis(lever)).chapters
    wanted = ct.read_synthesis(lever).synthesis
    far = wanted.model_copy(update={"transmission": 1.5})
    made = ct.report(ct.read_synthesis(lever).model_copy(update={"synthesis": far}))
    assert any(chapter.missing for chapter in made.chapters)
    with pytest.raises(ct.InputError, match="instants are those of mechanisms"):
        ct.report(lever, at="10 deg")
