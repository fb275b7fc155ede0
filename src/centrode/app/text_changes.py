"""Changes of a text of TOML that touch nothing else: comments, order and spelling of the rest stay to the byte.

Every change is made twice, in the text and in its tables; where the two do not agree, nothing is changed.
"""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any

import tomlkit
from tomlkit.exceptions import TOMLKitError

from centrode.app.text_places import Statement, TextPlaces
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.reading import Place

_BARE = re.compile(r"[A-Za-z0-9_-]+")
GREATEST_WHOLE = 1e15
"""Greatest whole number that is written without a point."""


def spelled_key(key: str) -> str:
    """A key as TOML writes it."""
    return key if _BARE.fullmatch(key) else str(tomlkit.string(key).as_string())


def spelled_value(value: object) -> str:
    """A value as TOML writes it in one line."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        whole = value.is_integer() and abs(value) < GREATEST_WHOLE
        return str(int(value)) if whole else repr(value)
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return str(tomlkit.string(value).as_string())
    if isinstance(value, Mapping):
        inner = ", ".join(f"{spelled_key(key)} = {spelled_value(one)}" for key, one in value.items())
        return f"{{ {inner} }}" if inner else "{}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(map(spelled_value, value)) + "]"
    raise TypeError(type(value).__name__)


class TextChanges:
    """A text of TOML that is changed key by key."""

    def __init__(self, text: str) -> None:
        self.text = text
        self.tables: dict[str, Any] = tomllib.loads(text)
        self.newline = "\r\n" if "\r\n" in text else "\n"

    # single values

    def set(self, place: Place, value: Any) -> None:
        """Give a key a value; a key that is not there is added at the end of its table."""
        expected = copy.deepcopy(self.tables)
        container = _enter(expected, place[:-1])
        key = place[-1]
        known = key in container if isinstance(container, dict) else True
        container[key] = value
        if known and container is not None:
            self._become(self._with_value(place, value), expected)
        else:
            self._become(self._with_key(place, value), expected)

    def remove(self, place: Place) -> None:
        """Take out a key, a table or an entry of a list; tables below it go with it."""
        expected = copy.deepcopy(self.tables)
        container = _enter(expected, place[:-1])
        del container[place[-1]]
        if place[:-1] and isinstance(container, list) and not container and len(place) == 2:
            del expected[str(place[0])]
        self._become(self._without(place), expected)

    def add_table(self, place: Place, entries: Mapping[str, Any]) -> None:
        """Add a table under a heading of its own, behind the last of its kind."""
        expected = copy.deepcopy(self.tables)
        container = expected
        for key in place[:-1]:
            container = container.setdefault(str(key), {})
        container[str(place[-1])] = dict(entries)
        heading = "[" + ".".join(spelled_key(str(key)) for key in place) + "]"
        self._become(self._with_section(place, heading, entries, double=False), expected)

    def add_entry(self, room: str, entries: Mapping[str, Any]) -> None:
        """Add an entry to a list of tables, under a heading of its own."""
        expected = copy.deepcopy(self.tables)
        expected.setdefault(room, []).append(dict(entries))
        self._become(self._with_section((room,), f"[[{room}]]", entries, double=True), expected)

    def insert_entry(self, room: str, number: int, entries: Mapping[str, Any]) -> None:
        """Put an entry into a list of tables, behind one that is there: it gets this number."""
        expected = copy.deepcopy(self.tables)
        expected[room].insert(number, dict(entries))
        self._become(self._with_entry(room, number, entries), expected)

    def rename_key(self, place: Place, name: str) -> None:
        """Give a key, or a table with all below it, another name in its place."""
        expected = copy.deepcopy(self.tables)
        container = _enter(expected, place[:-1])
        renamed = {name if key == place[-1] else key: value for key, value in container.items()}
        container.clear()
        container.update(renamed)
        self._become(self._with_name(place, name), expected)

    # how the text becomes the other one

    def _become(self, text: str, expected: Mapping[str, Any]) -> None:
        try:
            tables = tomllib.loads(text)
        except (tomllib.TOMLDecodeError, RecursionError):
            tables = {}
        if tables != expected and tables != _without_empty(expected, tables):
            what = _("this part of the text is written in a way that cannot be changed here")
            raise InputError("", what, _("change it in the text"))
        self.text, self.tables = text, tables

    @property
    def _places(self) -> TextPlaces:
        return TextPlaces(self.text)

    def _statement(self, place: Place) -> Statement | None:
        """The statement whose value holds a place."""
        holding = [
            one
            for one in self._places.statements
            if not one.is_heading and one.place == place[: len(one.place)]
        ]
        return max(holding, key=lambda one: len(one.place), default=None)

    def _with_value(self, place: Place, value: Any) -> str:
        statement = self._statement(place)
        if statement is None:
            return self.text
        rest = place[len(statement.place) :]
        if not rest:
            return self._splice(statement.value, statement.value_end, spelled_value(value))
        return self._within(statement, lambda inner: _put(inner, rest, value))

    def _within(self, statement: Statement, change: Callable[[Any], None]) -> str:
        """The text in which a value that holds others is changed, by a library that keeps its spelling."""
        written = self.text[statement.value : statement.value_end]
        try:
            document = tomlkit.parse(f"value = {written}\n")
            change(document["value"])
            spelled = tomlkit.dumps(document).removeprefix("value = ").removesuffix("\n")
        except (TOMLKitError, KeyError, IndexError, TypeError, AttributeError):
            return self.text
        return self._splice(statement.value, statement.value_end, spelled)

    def _with_key(self, place: Place, value: Any) -> str:
        line = f"{spelled_key(str(place[-1]))} = {spelled_value(value)}{self.newline}"
        if len(place) == 1:
            return self._with_top_key(line)
        heading = self._places.heading(place[:-1])
        if heading is not None:
            return self._insert(self._places.section_end(heading), line)
        statement = self._statement(place[:-1])
        if statement is not None:
            rest = place[len(statement.place) : -1]
            return self._within(statement, lambda inner: _add(inner, rest, str(place[-1]), value))
        # a table that only its dotted keys, or headings below it, make
        beside = [
            one
            for one in self._places.statements
            if not one.is_heading and one.place[: len(place) - 1] == place[:-1]
        ]
        if beside:
            last = beside[-1]
            depth = len(last.place) - len(place)
            written = self.text[last.start : last.value].split("=")[0].strip()
            prefix = ".".join(written.split(".")[: -1 - depth])
            return self._insert(last.end, f"{prefix}.{line}" if prefix else line)
        names = ".".join(spelled_key(str(key)) for key in place[:-1])
        first = next(
            (
                one
                for one in self._places.statements
                if one.is_heading and one.place[: len(place) - 1] == place[:-1]
            ),
            None,
        )
        at = first.start if first is not None else len(self.text)
        return self._insert(at, f"[{names}]{self.newline}{line}{self.newline if first else ''}")

    def _with_top_key(self, line: str) -> str:
        top = [one for one in self._places.statements]
        end = 0
        for one in top:
            if one.is_heading:
                break
            end = one.end
        if not end and top:
            end = top[0].start
            before = self.text[:end]
            blank = self.newline if not before.endswith("\n\n") or not before else ""
            return before + line + (self.newline if blank or not before else "") + self.text[end:]
        return self._insert(end, line)

    def _insert(self, offset: int, lines: str) -> str:
        before, after = self.text[:offset], self.text[offset:]
        if before and not before.endswith("\n"):
            before += self.newline
        return before + lines + after

    def _splice(self, start: int, end: int, written: str) -> str:
        return self.text[:start] + written + self.text[end:]

    def _with_section(self, place: Place, heading: str, entries: Mapping[str, Any], *, double: bool) -> str:
        lines = [f"{spelled_key(key)} = {spelled_value(value)}" for key, value in entries.items()]
        section = self.newline.join([heading, *lines, ""])
        headings = [one for one in self._places.statements if one.is_heading]
        same = [one for one in headings if one.place[:1] == place[:1]]
        if same:
            end = self._places.section_end(same[-1])
            # entries of one kind that follow each other without a blank line go on so
            close = not double and self._stand_close(same)
            return self._insert(end, section if close else self.newline + section)
        room = ROOMS.index(place[0]) if place[0] in ROOMS else len(ROOMS)
        before = [one for one in headings if one.place[0] in ROOMS and ROOMS.index(one.place[0]) <= room]
        if before:
            return self._insert(self._places.section_end(before[-1]), self.newline + section)
        top = [one for one in self._places.statements if not one.is_heading and len(one.place) == 1]
        if headings and not top:
            start = self._lead(headings[0].start)
            return self._insert(start, section + self.newline)
        if headings:
            end = max(one.end for one in self._places.statements if one.start < headings[0].start)
            return self._insert(end, self.newline + section)
        return self._insert(len(self.text), (self.newline if self.text.strip() else "") + section)

    def _with_entry(self, room: str, number: int, entries: Mapping[str, Any]) -> str:
        before = [
            one for one in self._places.statements if one.is_heading and one.place[:2] == (room, number - 1)
        ]
        if before:
            lines = [f"{spelled_key(key)} = {spelled_value(value)}" for key, value in entries.items()]
            section = self.newline.join(["", f"[[{room}]]", *lines, ""])
            return self._insert(self._places.section_end(before[-1]), section)
        statement = self._statement((room,))
        if statement is None:
            return self.text
        return self._within(statement, lambda inner: _insert_value(inner, number, entries))

    def _stand_close(self, same: Sequence[Statement]) -> bool:
        """Whether headings of one kind follow each other without a blank line."""
        pairs = [self.text[self._places.section_end(one) : other.start] for one, other in pairwise(same)]
        return bool(pairs) and not any(
            between.strip(" \t\r\n") == "" and "\n" in between for between in pairs
        )

    def _lead(self, offset: int) -> int:
        """Where the comments that lead a heading begin; comments at the top of a text belong to the text."""
        lines = self.text[:offset].splitlines(keepends=True)
        start = offset
        for line in reversed(lines):
            if not line.lstrip().startswith("#"):
                return start
            start -= len(line)
        return offset

    def _without(self, place: Place) -> str:
        statements = self._places.statements
        if isinstance(place[-1], int) and not any(
            one.is_heading and one.place == place for one in statements
        ):
            statement = self._statement(place)
            rest = place[len(statement.place) :] if statement else ()
            return (
                self._within(statement, lambda inner: _take(inner, rest)) if statement and rest else self.text
            )
        whole = [one for one in statements if one.place[: len(place)] == place]
        if not whole:
            statement = self._statement(place)
            rest = place[len(statement.place) :] if statement else ()
            return self._within(statement, lambda inner: _take(inner, rest)) if statement else self.text
        text = self.text
        for one in reversed(whole):
            start, end = one.start, one.end
            if one.is_heading:
                # the blank line that parts the section from the one before goes with it
                blank = re.search(r"(?:\r?\n)(?=[ \t]*\Z)", text[:start])
                led = text[:start].rstrip(" \t").endswith(("\n\n", "\r\n\r\n"))
                if led and blank:
                    start = blank.start() + (1 if text[blank.start()] == "\n" else 2)
                    start = (
                        one.start - len(self.newline)
                        if text[: one.start].endswith(self.newline * 2)
                        else one.start
                    )
            text = text[:start] + text[end:]
        return text

    def _with_name(self, place: Place, name: str) -> str:
        text = self.text
        written = spelled_key(name)
        depth = len([key for key in place if isinstance(key, str)]) - 1
        found = [one for one in self._places.statements if one.place[: len(place)] == place]
        if not found:
            statement = self._statement(place)
            rest = place[len(statement.place) :] if statement else ()
            return self._within(statement, lambda inner: _rename(inner, rest, name)) if statement else text
        tables = {one.place for one in self._places.statements if one.is_heading}
        for one in reversed(found):
            if not one.is_heading and any(
                one.place[: len(head)] == head and len(head) >= len(place) for head in tables
            ):
                continue
            head = next(
                (len(h) for h in sorted(tables, key=len, reverse=True) if one.place[: len(h)] == h), 0
            )
            skipped = 0 if one.is_heading else len([k for k in one.place[:head] if isinstance(k, str)])
            start, end = _key_span(text, one, depth - skipped)
            text = text[:start] + written + text[end:]
        return text


def _without_empty(expected: Mapping[str, Any], tables: Mapping[str, Any]) -> dict[str, Any]:
    """Tables without those at the top that have become empty and have no heading of their own."""
    return {key: value for key, value in expected.items() if value not in ({}, []) or key in tables}


ROOMS = (
    "points",
    "frame",
    "links",
    "guides",
    "gears",
    "rolling",
    "drives",
    "assembly",
    "loads",
    "machine",
    "simulation",
)
"""Tables of a description in the order in which a person writes them."""


def _key_span(text: str, statement: Statement, index: int) -> tuple[int, int]:
    """Offsets of one part of the dotted key of a statement."""
    at = statement.start
    while text[at] in " \t[":
        at += 1
    for _part in range(index):
        at = _part_end(text, at)
        while text[at] in " \t.":
            at += 1
    return at, _part_end(text, at)


def _part_end(text: str, at: int) -> int:
    if text[at] in "\"'":
        return text.index(text[at], at + 1) + 1
    found = _BARE.match(text, at)
    return found.end() if found else at


def _enter(tables: Any, place: Place) -> Any:
    """The table or list at a place; tables that are not there are made."""
    for key in place:
        tables = tables.setdefault(key, {}) if isinstance(tables, dict) else tables[key]
    return tables


def _put(inner: Any, rest: Place, value: Any) -> None:
    for key in rest[:-1]:
        inner = inner[key]
    inner[rest[-1]] = tomlkit.value(spelled_value(value))


def _add(inner: Any, rest: Place, key: str, value: Any) -> None:
    for part in rest:
        inner = inner[part]
    inner[key] = tomlkit.value(spelled_value(value))


def _insert_value(inner: Any, number: int, value: Any) -> None:
    inner.insert(number, tomlkit.value(spelled_value(value)))


def _take(inner: Any, rest: Place) -> None:
    for key in rest[:-1]:
        inner = inner[key]
    del inner[rest[-1]]


def _rename(inner: Any, rest: Place, name: str) -> None:
    for key in rest[:-1]:
        inner = inner[key]
    pairs = [(name if key == rest[-1] else key, value) for key, value in list(inner.items())]
    for key in list(inner):
        del inner[key]
    for key, value in pairs:
        inner[key] = value
