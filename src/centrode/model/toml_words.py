"""What the parser of TOML complains about, in sentences of ours: its own are for programmers, and English only."""

from __future__ import annotations

import re

from centrode.locale import _, mark

_TWICE = mark("a key is given twice")
_OPEN_TEXT = mark("a text is not closed: its quote is missing")
_NO_CHARACTER = mark("the code of a character in a text is wrong")
_CLOSED = mark("this table is complete already, nothing can be added to it")

_SENTENCES = {
    r"Invalid statement": mark("this is neither a [heading] nor key = value"),
    r"Expected newline or end of document .*": mark("there is more on the line than one value"),
    r"Cannot declare .* twice": mark("this table stands in the file already"),
    r"Cannot overwrite a value": _TWICE,
    r"Duplicate inline table key .*": _TWICE,
    r"Cannot (mutate|redefine) .*": _CLOSED,
    r"Expected '\]+' at the end of .*": mark("a heading is not closed: its bracket is missing"),
    r"Expected '=' after a key .*": mark("= is missing behind a key"),
    r"Invalid initial character for a key part": mark("a key is missing, or begins with a wrong character"),
    r"Unclosed array": mark("a list is not closed: its bracket is missing"),
    r"Unclosed inline table": mark("a table is not closed: its brace is missing"),
    r"Unterminated string": _OPEN_TEXT,
    r"(Illegal|Found invalid) character '\\n'|Expected ['\"]{3,}": _OPEN_TEXT,
    r"Illegal character .*|Found invalid character .*": mark("this character may not stand here"),
    r"Unescaped '\\' in a string": mark("a backslash in a text: double it, or use single quotes"),
    r"Invalid hex value|Escaped character .*": _NO_CHARACTER,
    r"Invalid date or datetime": mark("this date does not exist"),
    r"Invalid value": mark("a value is missing, or a text without quotes"),
}


def toml_reason(message: str) -> str:
    """The sentence for what `tomllib` says; its own words where a later version of it says something new."""
    for pattern, sentence in _SENTENCES.items():
        if re.fullmatch(pattern, message, re.DOTALL):
            return _(sentence)
    return message
