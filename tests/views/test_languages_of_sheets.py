"""Letters, words and signs of one sheet in the three languages, each as books of the language print them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

import centrode as ct
from centrode.analysis.instant_centres.results import require_centres
from centrode.render.document.numbers import Numbers
from centrode.render.document.spelling import DocumentSpelling
from centrode.render.spelling import PlainSpelling
from centrode.sheets.sheet import Sheet, SymbolList, Table
from centrode.sheets.texts import Expression, Name, Number, Place, Sentence, Text
from centrode.structure.constraints import NoTurning
from centrode.topics.presentation import sheet_of
from centrode.views.equations import constraint_text

LANGUAGES = ("en", "ru", "uk")
CYRILLIC = str.maketrans("RP", "ВП")


@pytest.fixture(autouse=True)
def english() -> Iterator[None]:
    ct.choose_language("en")
    yield
    ct.choose_language("en")


def in_languages(text: Text, mechanism: ct.Mechanism) -> list[str]:
    """A text as documents have it, in each language."""
    spelling, spelled = DocumentSpelling(Numbers(mechanism.display)), []
    for language in LANGUAGES:
        ct.choose_language(language)
        spelled.append(spelling.text(text))
    ct.choose_language("en")
    return spelled


def table_of(sheet: Sheet, chapter: str, number: int) -> Table:
    """The table of a section of a chapter."""
    blocks = sheet.chapters[chapter].sections[number].blocks
    return next(block for block in blocks if isinstance(block, Table))


@pytest.mark.parametrize(
    ("name", "kinds"),
    [("slider-between-cranks", ["RRP", "RRR"]), ("shaper", ["RPR", "RRP"]), ("scotch-yoke", ["RPP"])],
)
def test_kinds_of_groups_have_the_letters_of_the_language(name: str, kinds: list[str]) -> None:
    """Revolute and prismatic pairs are R and P in English, В and П in Russian and Ukrainian; data keep R and P."""
    checked = ct.check(ct.example(name))
    assert [group.kind for group in checked.groups if group.roman == "II"] == kinds
    column = table_of(sheet_of(checked), "structure", 2).columns[3]
    cells = [cell for cell, group in zip(column.values, checked.groups, strict=True) if group.roman == "II"]
    for kind, cell in zip(kinds, cells, strict=True):
        assert in_languages(cell, checked.mechanism) == [
            kind,
            kind.translate(CYRILLIC),
            kind.translate(CYRILLIC),
        ]
    for language in LANGUAGES:
        ct.choose_language(language)
        spoken = [kind if language == "en" else kind.translate(CYRILLIC) for kind in kinds]
        again = ct.check(checked.mechanism)
        assert [group.kind for group in again.groups] == [group.kind for group in checked.groups]
        assert [
            step.split(":")[0] for step in again.plan if ":" in step and step.split(":")[0].isupper()
        ] == spoken
        assert all(word in ct.summary(again) for word in spoken)
        assert language == "en" or not any(kind in ct.summary(again) for kind in kinds)


def test_pairs_have_the_signs_of_the_language() -> None:
    checked = ct.check(ct.example("slider-between-cranks"))
    signs = table_of(sheet_of(checked), "structure", 0).columns[3].values
    english, russian, ukrainian = zip(*(in_languages(sign, checked.mechanism) for sign in signs), strict=True)
    assert sorted(set(english)) == ["P", "R"]
    assert russian == ukrainian == tuple(sign.translate(CYRILLIC) for sign in english)


def test_names_that_look_like_kinds_stay() -> None:
    """Only kinds are translated: what a user calls R, P or RRP keeps its letters."""
    mechanism = ct.Mechanism(
        frame={"points": {"R": [0, 0], "P": [4, 0]}},
        links={
            "RRP": {"points": {"R": [0, 0], "A": [1, 0]}},
            "AB": {"length": 3.5},
            "PB": {"length": 3},
        },
        drives=[{"link": "RRP", "start": 1, "speed": 1}],
        assembly={"sides": {"B": "left"}},
    )
    ct.choose_language("ru")
    text = PlainSpelling(None).text(sheet_of(ct.check(mechanism)).facts[6].value)
    assert text.startswith("RRP: ")
    assert "AB, PB: класс II, порядок 2, ВВВ" in ct.summary(ct.check(mechanism))


TANGENTS = {"en": ("tan alpha", "arctan (2)"), "ru": ('op("tg") alpha', 'op("arctg") (2)')}


@pytest.mark.parametrize("language", TANGENTS)
def test_functions_have_their_names_of_the_language(language: str) -> None:
    """Readers of Russian and Ukrainian write tg; what a user calls tan stays."""
    ct.choose_language(language)
    spelling = DocumentSpelling(Numbers(ct.example("crank-rocker").display))
    tangent, angle = TANGENTS[language]
    assert spelling.mathematics("tan alpha") == tangent
    assert spelling.mathematics(Expression("arctan ({size})", size=Number(2.0))) == angle
    assert spelling.mathematics(Name("tan")) == '"tan"'


# The frame among links, in the case of its sentence.

AGAINST = {"en": "{} relative to the frame", "ru": "{} относительно стойки", "uk": "{} відносно стояка"}
REFUSED = {
    "en": ("the frame has no point", "both belong to the frame", "lie on the frame", "relative to the frame"),
    "ru": ("у стойки нет точки", "принадлежат стойке", "лежать на стойке", "относительно стойки"),
    "uk": ("у стояка немає точки", "належать стояку", "лежати на стояку", "відносно стояка"),
}
FOUR_BAR = {
    "frame": {"points": {"O": [0, 0], "D": [4, 0]}},
    "links": {"OA": {"length": 1}, "AB": {"length": 3.5}, "DB": {"length": 3}},
    "drives": [{"link": "OA", "start": 1, "speed": 1}],
    "assembly": {"sides": {"B": "left"}},
}


@pytest.mark.parametrize("language", LANGUAGES)
def test_bodies_are_told_against_the_frame(language: str) -> None:
    """Centres and centrodes name the frame by its word in the right case, between links as before."""
    mechanism = ct.example("crank-rocker")
    ct.choose_language(language)
    told = ct.summary(ct.instant_centres(ct.motion(mechanism, at=[1.0])))
    assert all(AGAINST[language].format(link) in told for link in mechanism.links)
    assert language == "en" or "frame" not in told
    told = ct.summary(ct.centrodes(ct.motion(mechanism, 9), "AB"))
    assert AGAINST[language].format("AB") in told
    assert language == "en" or "frame" not in told


@pytest.mark.parametrize("language", LANGUAGES)
def test_refusals_name_the_frame_in_its_case(language: str) -> None:
    ct.choose_language(language)
    guide = {"point": "B", "on": "frame", "through": "Q", "direction": 0}
    sphere = ct.mechanism_text(ct.example("spherical-four-bar")).replace(
        'reference = ["A", "D"]', 'reference = ["A", "C"]'
    )
    wrong: list[Callable[[], object]] = [
        lambda: ct.Mechanism(**FOUR_BAR | {"guides": [guide]}),
        lambda: ct.Mechanism(**FOUR_BAR | {"drives": [{"distance": ["O", "D"], "start": 1, "speed": 1}]}),
        lambda: ct.check(ct.parse_mechanism(sphere)),
        lambda: require_centres(ct.centrodes(ct.motion(ct.example("rack-and-pinion"), 9), "rack")),
    ]
    for make, part in zip(wrong, REFUSED[language], strict=True):
        with pytest.raises(ct.CentrodeError) as refused:
            make()
        assert part in str(refused.value)
        assert language == "en" or "frame" not in str(refused.value).replace("[frame", "")


@pytest.mark.parametrize("language", LANGUAGES)
def test_redundant_constraints_name_the_frame_in_its_case(language: str) -> None:
    ct.choose_language(language)
    label = NoTurning("AB", "C", "frame").label
    assert REFUSED[language][3] in label and "AB" in label and "C" in label
    assert language == "en" or "frame" not in label
    assert "DE" in NoTurning("AB", "C", "DE").label


# Coordinates, and letters of formulas in sentences.


def test_coordinates_are_parted_as_the_decimal_mark_allows() -> None:
    """(1.2, 3.4) in English, (1,2; 3,4) where a comma stands before decimals; the head of their column agrees."""
    mechanism = ct.example("crank-rocker")
    assert in_languages(Place((1.2, 3.4)), mechanism) == ["(1.2, 3.4) m", "(1,2; 3,4) м", "(1,2; 3,4) м"]
    heads = in_languages(Sentence("through $(x, y)$"), mechanism)
    assert [head.partition("$")[2] for head in heads] == ["(x, y)$", "(x; y)$", "(x; y)$"]


def test_letters_in_sentences_are_formulas_in_documents() -> None:
    """Terminals print x_C, documents set it; names of constraints that are no coordinates stay names."""
    mechanism = ct.example("slider-between-cranks")
    assert in_languages(constraint_text("x_C"), mechanism) == ["$x_(C)$"] * 3
    assert PlainSpelling(None).text(constraint_text("x_C")) == "x_C"
    assert in_languages(constraint_text("x_C (second)"), mechanism) == ["x_C (second)"] * 3
    (drift,) = (
        fact.value
        for fact in sheet_of(ct.integrate(mechanism, steps=20)).facts
        if fact.label == Sentence("greatest drift")
    )
    assert all("$y_(" in text or "$x_(" in text for text in in_languages(drift, mechanism))
    sections = sheet_of(ct.equations(mechanism)).chapters["equations"].sections
    (listed,) = (block for section in sections for block in section.blocks if isinstance(block, SymbolList))
    meanings = [one.meaning for one in listed.symbols]
    constants = [text for text in map(PlainSpelling(None).text, meanings) if text.startswith("constant of ")]
    assert constants and all(text.removeprefix("constant of ")[:2] in ("x_", "y_") for text in constants)
    spelled = [in_languages(one, mechanism) for one in meanings]
    assert sum("$y_(" in english for english, _russian, _ukrainian in spelled) > 0
    assert all(("$y_(" in russian) == ("$y_(" in english) for english, russian, _ukrainian in spelled)
