"""Complaints of the TOML parser in sentences of ours; every one it has is made to happen."""

from __future__ import annotations

import pytest

from centrode.errors import InputError
from centrode.model.files import parse_mechanism


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("{}", "this is neither a [heading] nor key = value"),
        ("a = 1 2", "there is more on the line than one value"),
        ("[a]\n[b]\n[a]", "this table is already in the file"),
        ("a = 1\na = 2", "a key is given twice"),
        ("a = { b = 1, b = 2 }", "a key is given twice"),
        ("a = { b = 1 }\n[a.c]", "this table is already in the file"),
        ("a = { b = 1 }\na.c = 1", "this table is complete already, nothing can be added to it"),
        ("[a.b]\n[a]\nb.c = 1", "this table is complete already, nothing can be added to it"),
        ("[a", "a heading is not closed: its bracket is missing"),
        ("[[a]", "a heading is not closed: its bracket is missing"),
        ("a 1", "= is missing after a key"),
        ("a.%", "a key is missing, or begins with a wrong character"),
        ("a = [1", "a list is not closed: its bracket is missing"),
        ("a = { b = 1", "a table is not closed: its brace is missing"),
        ('a = "b', "a text is not closed: its quote is missing"),
        ('a = "b\nc = 1', "a text is not closed: its quote is missing"),
        ("a = 'b", "a text is not closed: its quote is missing"),
        ("a = 'b\nc = 1'", "a text is not closed: its quote is missing"),
        ('a = "\x01"', "this character is not allowed here"),
        ("# \x01", "this character is not allowed here"),
        (r'a = "C:\data"', "a backslash in a text: double it, or use single quotes"),
        (r'a = "\uXYZW"', "the code of a character in a text is wrong"),
        (r'a = "\ud800"', "the code of a character in a text is wrong"),
        ("a = 2001-02-30T00:00:00", "this date does not exist"),
        ("a = left right", "a value is missing, or a text without quotes"),
        ("a =", "a value is missing, or a text without quotes"),
    ],
)
def test_every_complaint_has_its_sentence(text: str, sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_mechanism(text, "press.toml")
    assert str(caught.value).endswith(f"not TOML: {sentence}")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("a = 3,5", "line 1, column 6: not TOML: decimals have a point, not a comma; write 3.5"),
        (
            "b = 1\na = -3,05 # m",
            "line 2, column 7: not TOML: decimals have a point, not a comma; write -3.05",
        ),
        (
            "[links.O1А]",
            'А in "O1А" only looks like a Latin letter; type O1A with the Latin keyboard layout, or put the name in'
            ' quotes: "O1А"',
        ),
        (
            "points = { В = [0, 0] }",
            'В in "В" only looks like a Latin letter; type B with the Latin keyboard layout, or put the name in'
            ' quotes: "В"',
        ),
        (
            "[links.рычаг]",
            "column 8: not TOML: a name with letters other than a to z stands in quotes;"
            ' put the name in quotes: "рычаг"',
        ),
        ("a = “3 mm”", 'column 5: not TOML: these quotes are typographic; type straight ones: "..."'),
        ("a = «3 mm»", 'column 5: not TOML: these quotes are typographic; type straight ones: "..."'),
        ("a = \u22123", "column 5: not TOML: this minus is typographic; type the one of the keyboard: -"),
        (
            "a\u00a0= 1",
            "column 2: not TOML: a space or an invisible character that TOML does not know (U+00A0); remove it, or type"
            " an ordinary space",
        ),
        ("\u200ba = 1", "TOML does not know (U+200B); remove it, or type an ordinary space"),
        (
            "```toml\na = 1\n```",
            "line 1, column 1: not TOML: ``` belongs to the document, not to the example; remove this line",
        ),
        ("a = 1\r\nb = left # side\r\n", 'line 2, column 5: not TOML: a text stands in quotes; write "left"'),
        ("a = True", "column 5: not TOML: TOML writes this word in small letters; write true"),
        ("a = { b = 3,5, c = 1 }", "decimals have a point, not a comma; write 3.5"),
        ("a = { b = 3,5 }", "decimals have a point, not a comma; write 3.5"),
        ("a = { b = 3,5 mm }", 'decimals have a point, not a comma; write "3.5 mm"'),
        ("a = 3,5 mm", 'decimals have a point, not a comma; write "3.5 mm"'),
        ("a = 3.5 mm", 'column 9: not TOML: a number with a unit is a text in quotes; write "3.5 mm"'),
        ("a = -3.5mm", 'a number with a unit is a text in quotes; write "-3.5 mm"'),
        ("a = { b = 3500 mm, c = 1 }", 'a number with a unit is a text in quotes; write "3500 mm"'),
        ("a = 60°", 'a number with a unit is a text in quotes; write "60 °"'),
        ("a = 5 мм/с^2", 'a number with a unit is a text in quotes; write "5 mm/s^2"'),
        (
            "a = [\n  1e-3 m, 0\n]",
            'line 2, column 8: not TOML: a number with a unit is a text in quotes; write "1e-3 m"',
        ),
        ("a = [1, 2 mm]", 'a number with a unit is a text in quotes; write "2 mm"'),
    ],
)
def test_decimal_commas_and_units_without_quotes_are_named(text: str, told: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_mechanism(text, "press.toml")
    assert str(caught.value).startswith("press.toml, line")
    assert str(caught.value).endswith(told)


@pytest.mark.parametrize(
    ("text", "repair"),
    [
        ("[links.кулиса]", 'put the name in quotes: "кулиса"'),
        ("a = { кулиса = 1 }", 'put the name in quotes: "кулиса"'),
        ("[links.B\u0421]", "type BC with the Latin keyboard layout"),
        ("\u041e = [0, 0]", "type O with the Latin keyboard layout"),
    ],
)
def test_letters_of_other_alphabets_in_keys_are_named(text: str, repair: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_mechanism(text)
    assert repair in caught.value.repair


@pytest.mark.parametrize("text", ["kind = сила", "a = [диск]", "[links.OA] кривошип"])
def test_values_in_other_alphabets_are_not_taken_for_keys(text: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_mechanism(text)
    assert caught.value.repair in ("", 'write "сила"')


@pytest.mark.parametrize(
    "text", ["a = 1 b = 2", "a = { b = 1 c = 2 }", "a = [1,5", "a = 5.", "a = 1/2", "a = { b = 1, 5 = }"]
)
def test_other_mistakes_beside_numbers_are_not_taken_for_these(text: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_mechanism(text)
    assert not caught.value.repair
