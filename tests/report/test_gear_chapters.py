"""Documents on pairs and trains of gears: their chapters, formulas and checks, in three languages."""

from __future__ import annotations

import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.model.gear_pairs import GEAR_PAIRS
from centrode.model.gear_trains import GEAR_TRAINS
from centrode.render.document.blocks import FormulaBlock
from centrode.report.html.page import html_page

PAIR_CHAPTERS = ["data", "gear-geometry", "gear-contact", "blocking-contour", "gear-teeth"]
TRAIN_CHAPTERS = ["data", "train-choice", "train-conditions", "train-motion"]
TERMS = {
    "en": (
        "shift coefficients",
        "working pressure angle",
        "contact ratio",
        "specific sliding",
        "blocking contour",
    ),
    "ru": (
        "коэффициенты смещения",
        "угол зацепления",
        "коэффициент перекрытия",
        "удельное скольжение",
        "блокирующий контур",
    ),
    "uk": (
        "коефіцієнти зміщення",
        "кут зачеплення",
        "коефіцієнт перекриття",
        "питоме ковзання",
        "блокувальний контур",
    ),
}


@pytest.mark.parametrize("name", ct.example_names("gear pair"))
def test_chapters_of_a_pair(name: str) -> None:
    made = ct.report(name)
    rack = name == "rack-gear-pair"
    wanted = [chapter for chapter in PAIR_CHAPTERS if not (rack and chapter == "blocking-contour")]
    assert [chapter.name for chapter in made.chapters] == [*wanted, "checks"]
    assert not any(chapter.missing for chapter in made.chapters)
    assert made.description is not None
    assert GEAR_PAIRS.parse(made.description.text) == ct.example(name)


@pytest.mark.parametrize("name", ct.example_names("gear train"))
def test_chapters_of_a_train(name: str) -> None:
    made = ct.report(name)
    assert [chapter.name for chapter in made.chapters][:4] == TRAIN_CHAPTERS
    assert not any(chapter.missing for chapter in made.chapters)
    assert made.description is not None
    assert GEAR_TRAINS.parse(made.description.text) == ct.example(name)


@pytest.mark.parametrize("language", TERMS)
def test_terms_of_the_field(language: str) -> None:
    page = html_page(ct.report("shifted-gear-pair", language=language)).decode().lower()
    for term in TERMS[language]:
        assert term in page


def test_formulas_end_with_the_numbers_of_the_pair() -> None:
    """A maker's printed example, to the digits that a formula shows."""
    made = ct.report("shifted-gear-pair", ct.ReportOptions(digits=6))
    formulas = " ".join(
        str(block)
        for chapter in made.chapters
        for section in chapter.sections
        for block in section.blocks
        if isinstance(block, FormulaBlock)
    )
    for printed in ("26.0886", "56.4999", "37.6666", "75.3332", "44.8397", "79.3997", "1.2021"):
        assert printed in formulas, printed


def test_wishes_of_gears() -> None:
    text = 'kind = "gear pair"\nmodule = "3 mm"\nteeth = [12, 24]\nshifts = [0.6, 0.36]\n'
    pair = GEAR_PAIRS.parse(f'{text}[report]\nchapters = ["gear-contact"]\ndigits = 5\n')
    assert [chapter.name for chapter in ct.report(pair).chapters] == ["gear-contact"]
    with pytest.raises(InputError, match="there is no chapter"):
        ct.report(GEAR_PAIRS.parse(f'{text}[report]\nchapters = ["gear"]\n'))
    with pytest.raises(InputError, match="instants are those of mechanisms and cams"):
        ct.report(pair, at=0.3)
    with pytest.raises(InputError, match="takes a mechanism, a cam, or a pair or train of gears"):
        ct.report(3)  # type: ignore[arg-type]
