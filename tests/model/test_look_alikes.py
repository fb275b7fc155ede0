"""Letters of other alphabets among Latin names, and points that nothing joins: messages name them."""

from __future__ import annotations

import unicodedata

import pytest

import centrode as ct
from centrode.errors import InputError
from centrode.locale import speaking
from centrode.model.files import parse_mechanism
from centrode.model.look_alikes import in_latin, look_alike, look_alike_pairs
from centrode.model.reading import Problem, likely, read_choice

RIGHT = """
[frame.points]
A = [0, 0]
D = [4, 0]
[links.AB]
length = 1
[links.BC]
length = 3.5
[links.CD]
length = 3
[[drives]]
link = "AB"
start = 0.7
speed = 1
[assembly]
sides = { C = "left" }
"""

LETTERS = "type it with one keyboard layout"


def told(old: str, new: str) -> str:
    """What checking the linkage with another text in one place complains about."""
    assert old in RIGHT
    with pytest.raises(InputError) as caught:
        ct.check(parse_mechanism(RIGHT.replace(old, new, 1), "f.toml"))
    assert caught.value.exit_code == 2
    return str(caught.value)


def test_a_name_is_near_another_whatever_its_letters() -> None:
    assert likely("\u0410\u041e", ["OA", "BD"]) == likely("AO", ["OA", "BD"]) == 'did you mean "OA"?'


def test_the_linkage_itself_is_right() -> None:
    assert ct.check(parse_mechanism(RIGHT)).mobility == 1


@pytest.mark.parametrize("letter", "АВСЕНКМОРТХІЈЅасеорхіјѕ" + "ΑΒΕΖΗΙΚΜΝΟΡΤΥΧο")
def test_letters_that_look_alike_have_latin_ones(letter: str) -> None:
    """The table against the names of Unicode, for letters whose names say the same."""
    latin = in_latin(letter)
    assert len(latin) == 1
    assert unicodedata.name(latin).startswith("LATIN")
    assert letter.isupper() == latin.isupper()
    assert look_alike(letter + "1", ["Q1", latin + "1"]) == latin + "1"
    assert look_alike(latin, [latin, "Q"]) is None


def test_the_rarer_alphabet_is_the_odd_one() -> None:
    assert look_alike_pairs(["A", "B", "\u0412", "D"]) == [("\u0412", "B")]
    assert look_alike_pairs(["\u0410", "\u0411", "\u0412", "B"]) == [("B", "\u0412")]
    assert look_alike_pairs(["A", "\u0411", "\u0416"]) == []


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'link = "AB"',
            'link = "\u0410\u0412"',
            'f.toml, [[drives]] 1, link: unknown link "\u0410\u0412"; \u0410\u0412 is written with the Cyrillic letters'
            " \u0410, \u0412, the other names with Latin ones: " + LETTERS,
        ),
        (
            'link = "AB"',
            'link = "A\u0392"',
            "A\u0392 is written with the Greek letter \u0392, the other names with Latin ones: " + LETTERS,
        ),
        (
            "{ C =",
            '{ "\u0421" =',
            'unknown point, link or guide "\u0421"; \u0421 is written with the Cyrillic letter \u0421, the other',
        ),
        (
            "[links.BC]",
            '[links."\u0412\u0421"]',
            "f.toml, [links.\u0412\u0421]: nothing connects \u0412\u0421 to the frame; \u0412\u0421 is"
            " written with the Cyrillic letters \u0412, \u0421, the other names with Latin ones: " + LETTERS,
        ),
        (
            "[links.BC]",
            '[links.coupler]\npoints = ["B", "\u0421"]',
            "[links.coupler]: 1 drive is given, but the mobility (by rank) is 3; \u0421 is written with the Cyrillic"
            " letter \u0421, the other names with Latin ones: " + LETTERS,
        ),
        (
            "[links.BC]",
            '[links."B\u0421"]',
            "[links.B\u0421]: 1 drive is given, but the mobility (by rank) is 3; B\u0421 is written"
            " with the Cyrillic letter \u0421, the other names with Latin ones: " + LETTERS,
        ),
        (
            "A = [0, 0]",
            '"\u0410" = [0, 0]',
            "[frame.points]: 1 drive is given, but the mobility (by rank) is 3; \u0410 is written with the Cyrillic",
        ),
    ],
)
def test_letters_that_look_alike_are_named(old: str, new: str, message: str) -> None:
    assert message in told(old, new)


def test_a_placed_guide_whose_point_is_mistyped_names_the_letter() -> None:
    with pytest.raises(InputError) as caught:
        ct.Mechanism(
            frame={"points": {"O": [0, 0]}},
            links={"OA": {"length": 1, "angle": 0}, "AB": {"length": 3, "angle": 0}},
            guides=[{"point": "\u0412", "through": "placed", "direction": [1, 0]}],
            drives=[{"link": "OA", "speed": 1}],
        )
    told = "\u0412 is written with the Cyrillic letter \u0412, the other names with Latin ones"
    assert told in str(caught.value)


def test_latin_letters_among_cyrillic_names_are_named_too() -> None:
    cyrillic = str.maketrans("ABC", "\u0410\u0412\u0421")
    names = {name: name.translate(cyrillic) for name in ("AB", "BC", "CD")}
    with pytest.raises(
        InputError, match="AB is written with the Latin letters A, B, the other names with Cyrillic"
    ):
        ct.Mechanism(
            frame={"points": {"\u0410": [0, 0], "D": [4, 0]}},
            links={
                name: {"length": length} for name, length in zip(names.values(), (1, 3.5, 3), strict=True)
            },
            drives=[{"link": "AB", "speed": 1}],
        )


@pytest.mark.parametrize(
    ("points", "message"),
    [
        # one name against one: either may be mistyped
        (
            ["\u0412"],
            "B is written with the Latin letter B, \u0412, which looks the same, with Cyrillic ones: type both",
        ),
        # the guide's point has the letters of most names: the link's was mistyped
        (
            ["\u0412", "C", "D"],
            "\u0412 is written with the Cyrillic letter \u0412, the other names with Latin ones: ",
        ),
    ],
)
def test_the_mistyped_one_of_two_names_that_look_alike_is_named(points: list[str], message: str) -> None:
    piston = {"points": {point: [0.1 * place, 0] for place, point in enumerate(points)}}
    with pytest.raises(InputError) as caught:
        ct.Mechanism(
            frame={"points": {"O": [0, 0]}},
            links={"OA": {"length": 1}, "AB": {"length": 3}, "piston": piston},
            guides=[{"point": "B", "through": "O", "direction": [1, 0], "link": "piston"}],
            drives=[{"link": "OA", "speed": 1}],
        )
    assert message in str(caught.value)


MOBILITY = "[[drives]]: 1 drive is given, but the mobility (by rank) is 3; "


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("D = [4, 0]\n", "", "point D of link CD is joined to nothing: is it a point of the frame?"),
        ("A = [0, 0]\n", "", "point A of link AB is joined to nothing: is it a point of the frame?"),
        (
            "D = [4, 0]",
            "E = [4, 0]",
            "point D of link CD is joined to nothing, nor is E of the frame: are they one?",
        ),
        ("[links.CD]", "[links.Cd]", 'point d of link Cd is joined to nothing: did you mean "D"?'),
        (
            "[links.CD]\nlength = 3",
            "[links.rocker]\npoints = { C = [0, 0], E = [3, 0], G = [1, 1] }",
            "point E of link rocker is joined to nothing: is it a point of the frame?\n"
            "point G of link rocker is joined to nothing: is it a point of the frame?",
        ),
    ],
)
def test_loose_points_are_named(old: str, new: str, message: str) -> None:
    assert told(old, new) == MOBILITY + message


def test_a_guide_that_holds_no_point_leaves_its_slide_loose() -> None:
    """A slider-crank whose guide is left out: its slider is the loose point; with the guide nothing is."""
    parts: dict[str, object] = {
        "frame": {"points": {"O": [0, 0]}},
        "links": {"OA": {"length": 1}, "AB": {"length": 3}},
        "drives": [{"link": "OA", "start": 1, "speed": 1}],
    }
    with pytest.raises(InputError, match="point B of link AB is joined to nothing"):
        ct.check(ct.Mechanism(**parts))
    guide = {"point": "B", "through": [0, 0], "direction": [1, 0]}
    assert ct.check(ct.Mechanism(**parts, guides=[guide], assembly={"sides": {"B": "ahead"}})).mobility == 1


LEVER: dict[str, object] = {
    "frame": {"points": {"O": [0, 0], "D": [0, -2]}},
    "links": {"OA": {"length": 1}, "lever": {"points": {"D": [0, 0], "B": [4, 0]}}, "BE": {"length": 1.5}},
    "guides": [
        {"point": "A", "on": "lever", "through": "D", "direction": [1, 0]},
        {"point": "E", "through": [0, 1.6], "direction": [1, 0]},
    ],
    "drives": [{"link": "OA", "start": 0, "speed": 1}],
}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"frame": {"points": {"O": [0, 0]}}},
            "point D of link lever is joined to nothing: is it a point of the frame?",
        ),
        (
            {
                "guides": [
                    {"point": "Q", "on": "lever", "through": "D", "direction": [1, 0]},
                    LEVER["guides"][1],
                ]
            },
            "no link has point Q of guide Q: is it spelled as in its link?",
        ),
    ],
)
def test_the_pivot_and_the_pin_of_a_slotted_lever_are_named(change: dict[str, object], message: str) -> None:
    with pytest.raises(InputError) as caught:
        ct.check(ct.Mechanism(**(LEVER | change)))
    assert str(caught.value).startswith(MOBILITY + message)


def test_where_every_end_is_joined_no_point_is_named() -> None:
    assert told("[links.CD]", "[links.CE]\nlength = 1\n[links.ED]").endswith("constrain what moves freely")


@pytest.mark.parametrize(
    ("language", "typed", "meant"),
    [("uk", "циклоїдальний", "cycloidal"), ("ru", "Модифицированный синусоидальный", "modified sine")],
)
def test_words_of_results_are_known_where_they_are_typed(language: str, typed: str, meant: str) -> None:
    with speaking(language), pytest.raises(Problem) as caught:
        read_choice(typed, ("uniform", "cycloidal", "modified sine"))
    assert f'"{meant}"' in caught.value.repair
