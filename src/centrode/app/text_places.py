"""Where the keys of a description stand in its text: lines and columns for problems, ends of sections for additions."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

from centrode.model.reading import Place

QUOTES = "\"'"


@dataclass(frozen=True)
class Statement:
    """A heading, or a key with its value, in a text of TOML.

    Attributes
    ----------
    start, end : offsets of its first character and behind its last one, its line's end and comment included
    value, value_end : offsets of the value of a key, and behind it; those of the heading itself
    place : keys and indices from the top of the description
    is_heading : whether it is a heading
    """

    start: int
    end: int
    value: int
    value_end: int
    place: Place
    is_heading: bool


@dataclass(frozen=True)
class TextPlaces:
    """The statements of a text of TOML, in their order.

    A text that is no TOML has the statements up to where they can be followed.
    """

    text: str

    @cached_property
    def statements(self) -> tuple[Statement, ...]:
        """Headings and keys in the order of the text."""
        return tuple(_statements(self.text))

    def position(self, place: Place) -> tuple[int, int]:
        """Line and column, both from 1, of the deepest part of a place that the text has."""
        return line_and_column(self.text, self._offset(place))

    def _offset(self, place: Place) -> int:
        best, depth = 0, 0
        for statement in self.statements:
            known = statement.place
            if known == place[: len(known)] and len(known) > depth:
                inner = _inside(self.text, statement, place[len(known) :])
                best, depth = (statement.value if inner is None else inner), len(known)
            elif not depth and place and known[:1] == place[:1]:
                best = statement.value
        return best

    def section_end(self, heading: Statement) -> int:
        """Offset behind the last statement under a heading; comments that lead the next heading are that one's."""
        end = heading.end
        for statement in self.statements:
            if statement.start > heading.start:
                if statement.is_heading:
                    break
                end = statement.end
        return end

    def heading(self, place: Place) -> Statement | None:
        """The heading of a table, or of an entry of a list of tables."""
        return next((one for one in self.statements if one.is_heading and one.place == place), None)


@lru_cache(maxsize=16)
def text_places(text: str) -> TextPlaces:
    """The places of a text, kept while it is worked on."""
    return TextPlaces(text)


def line_and_column(text: str, offset: int) -> tuple[int, int]:
    """Line and column, both from 1, of an offset."""
    before = text[:offset]
    return before.count("\n") + 1, offset - (before.rfind("\n") + 1) + 1


def _statements(text: str) -> Iterator[Statement]:
    table: Place = ()
    counts: dict[Place, int] = {}
    offset = 0
    while offset < len(text):
        start = offset
        while offset < len(text) and text[offset] in " \t\r\n":
            offset += 1
        line = text.rfind("\n", 0, offset) + 1
        start = max(line, start)
        if offset >= len(text):
            return
        if text[offset] == "#":
            offset = _line_end(text, offset)
            continue
        if text[offset] == "[":
            double = text.startswith("[[", offset)
            close = _closing_bracket(text, offset, "]")
            keys = _keys(text[offset + 1 + double : close - double])
            end = _line_end(text, close)
            table = _enter(keys, counts, double)
            yield Statement(start, end, offset, close + 1, table, True)
            offset = end
            continue
        equals = _equals(text, offset)
        if equals < 0:
            offset = _line_end(text, offset)
            continue
        keys = _keys(text[offset:equals])
        value = equals + 1
        while value < len(text) and text[value] in " \t":
            value += 1
        value_end = _value_end(text, value)
        end = _line_end(text, value_end)
        written = text[value:value_end].rstrip()
        yield Statement(start, end, value, value + len(written), (*table, *keys), False)
        offset = end


def _enter(keys: tuple[str, ...], counts: dict[Place, int], double: bool) -> Place:
    """Place of a heading: the last entry of each list of tables on its way."""
    place: Place = ()
    for i, key in enumerate(keys):
        place = (*place, key)
        if i == len(keys) - 1 and double:
            counts[place] = counts.get(place, -1) + 1
        if place in counts:
            place = (*place, counts[place])
    return place


def _keys(text: str) -> tuple[str, ...]:
    """The parts of a dotted key."""
    try:
        value: object = tomllib.loads(f"{text.strip()} = 0")
    except (tomllib.TOMLDecodeError, RecursionError):
        return (text.strip(),)
    keys: list[str] = []
    while isinstance(value, dict):
        (key,) = value
        keys.append(key)
        value = value[key]
    return tuple(keys)


def _text_end(text: str, offset: int) -> int:
    """Offset behind a text in quotes that begins here."""
    quote = text[offset]
    if text.startswith(quote * 3, offset):
        end = text.find(quote * 3, offset + 3)
        return len(text) if end < 0 else end + 3
    offset += 1
    while offset < len(text) and text[offset] not in (quote, "\n"):
        offset += 2 if text[offset] == "\\" and quote == '"' else 1
    return min(offset + 1, len(text))


def _closing_bracket(text: str, offset: int, bracket: str) -> int:
    """Offset of the bracket that closes a heading, on its line."""
    while offset < len(text) and text[offset] != "\n":
        if text[offset] in QUOTES:
            offset = _text_end(text, offset)
            continue
        if text[offset] == bracket:
            return offset + 1 if text.startswith(bracket, offset + 1) else offset
        offset += 1
    return offset


def _equals(text: str, offset: int) -> int:
    """Offset of the sign of equality behind a key; -1 where the line has none."""
    while offset < len(text) and text[offset] not in "\n#":
        if text[offset] in QUOTES:
            offset = _text_end(text, offset)
            continue
        if text[offset] == "=":
            return offset
        offset += 1
    return -1


def _value_end(text: str, offset: int) -> int:
    """Offset behind a value: a list and a table end with their bracket, anything else with its line."""
    depth = 0
    while offset < len(text):
        letter = text[offset]
        if letter in QUOTES:
            offset = _text_end(text, offset)
            continue
        if letter == "#":
            if not depth:
                return offset
            offset = _line_end(text, offset)
            continue
        if letter in "[{":
            depth += 1
        elif letter in "]}":
            depth -= 1
        elif letter == "\n" and depth <= 0:
            return offset
        offset += 1
        if depth <= 0 and letter in "]}":
            return offset
    return offset


def _line_end(text: str, offset: int) -> int:
    """Offset behind the end of the line."""
    end = text.find("\n", offset)
    return len(text) if end < 0 else end + 1


def _inside(text: str, statement: Statement, rest: Place) -> int | None:
    """Offset of a key inside a list or table that is written as one value."""
    if not rest or statement.is_heading:
        return None
    written = text[statement.value : statement.end]
    offset = 0
    for part in rest:
        if isinstance(part, str):
            at = min(
                (k for k in (written.find(q, offset) for q in _key_spellings(part)) if k >= 0), default=-1
            )
            if at < 0:
                return statement.value + offset
            offset = at
    return statement.value + offset


def _key_spellings(key: str) -> tuple[str, ...]:
    return f"{key} =", f"{key}=", f'"{key}"', f"'{key}'"
