"""Words, lists and tables in a description, of bounded sizes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from pydantic import BeforeValidator

from centrode.locale import _
from centrode.model.problems import Problem, Problems, likely, shown


def choice(*options: str) -> BeforeValidator:
    """One of a few words."""

    def read(value: object) -> object:
        if isinstance(value, str) and value in options:
            return value
        words = ", ".join(shown(option) for option in options)
        repair = likely(value, options) if isinstance(value, str) else ""
        raise Problem(
            _("expected one of {words}, got {value}").format(words=words, value=shown(value)), repair
        )

    return BeforeValidator(read)


def entries(value: object, most: int) -> tuple[object, ...]:
    """The entries of a list, at most `most`."""
    if not isinstance(value, list | tuple):
        repair = _("write each entry below a [[...]] heading, or values in [...]")
        raise Problem(_("expected a list, got {value}").format(value=shown(value)), repair)
    _bounded(len(value), most)
    return tuple(value)


def listed(most: int) -> BeforeValidator:
    """A list of at most `most` entries, kept as a tuple."""
    return BeforeValidator(lambda value: entries(value, most))


def named_entries(value: object, read_key: Callable[[object], str], most: int) -> dict[str, Any]:
    """The entries of a table, at most `most`; the names are read first, so that no two become one."""
    if not isinstance(value, Mapping):
        raise Problem(_("expected a table, got {value}").format(value=shown(value)))
    _bounded(len(value), most)
    named: dict[str, Any] = {}
    wrong: list[Problem] = []
    for key, entry in value.items():
        try:
            name = read_key(key)
        except Problem as problem:
            wrong.append(problem)
            continue
        if name in named:
            wrong.append(
                Problem(_("{name} is named twice").format(name=shown(name)), _("rename one of them"))
            )
        named[name] = entry
    if wrong:
        raise Problems(wrong)
    return named


def _bounded(count: int, most: int) -> None:
    if count > most:
        what = _("at most {most} entries are allowed, got {count}")
        raise Problem(what.format(most=most, count=count))


def table(read_key: Callable[[object], str], most: int) -> BeforeValidator:
    """A table of at most `most` named entries."""
    return BeforeValidator(lambda value: named_entries(value, read_key, most))
