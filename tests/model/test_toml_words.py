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
        ("[a]\n[b]\n[a]", "this table stands in the file already"),
        ("a = 1\na = 2", "a key is given twice"),
        ("a = { b = 1, b = 2 }", "a key is given twice"),
        ("a = { b = 1 }\n[a.c]", "this table stands in the file already"),
        ("a = { b = 1 }\na.c = 1", "this table is complete already, nothing can be added to it"),
        ("[a.b]\n[a]\nb.c = 1", "this table is complete already, nothing can be added to it"),
        ("[a", "a heading is not closed: its bracket is missing"),
        ("[[a]", "a heading is not closed: its bracket is missing"),
        ("a 1", "= is missing behind a key"),
        ("a.%", "a key is missing, or begins with a wrong character"),
        ("a = [1", "a list is not closed: its bracket is missing"),
        ("a = { b = 1", "a table is not closed: its brace is missing"),
        ('a = "b', "a text is not closed: its quote is missing"),
        ('a = "b\nc = 1', "a text is not closed: its quote is missing"),
        ("a = 'b", "a text is not closed: its quote is missing"),
        ("a = 'b\nc = 1'", "a text is not closed: its quote is missing"),
        ('a = "\x01"', "this character may not stand here"),
        ("# \x01", "this character may not stand here"),
        (r'a = "C:\data"', "a backslash in a text: double it, or use single quotes"),
        (r'a = "\uXYZW"', "the code of a character in a text is wrong"),
        (r'a = "\ud800"', "the code of a character in a text is wrong"),
        ("a = 2001-02-30T00:00:00", "this date does not exist"),
        ("a = left", "a value is missing, or a text without quotes"),
        ("a =", "a value is missing, or a text without quotes"),
    ],
)
def test_every_complaint_has_its_sentence(text: str, sentence: str) -> None:
    with pytest.raises(InputError) as caught:
        parse_mechanism(text, "press.toml")
    assert str(caught.value).endswith(f"not TOML: {sentence}")
