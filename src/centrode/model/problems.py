"""Problems of a description while it is read, and the sentences they become."""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from typing import Any

from pydantic import ValidationError

from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model import limits

Place = tuple[str | int, ...]
"""Keys and indices from the top of the description to the value a problem is about."""

TABLES = (
    *("display", "frame", "assembly", "machine", "study", "report"),
    *("curvature", "start", "range", "roller", "return", "mover", "contact", "choose"),
    *("cam", "follower", "bounds", "tool"),
)

KEY = "{key}"
"""Stands in a problem's sentence for the key it is about, which only the reader of the whole knows."""


class Problem(ValueError):
    """One thing wrong with a description; pydantic gathers these and adds the place above `at`."""

    def __init__(self, what: str, repair: str = "", at: Place = ()) -> None:
        super().__init__(what)
        self.what = what
        self.repair = repair
        self.at = at


class Problems(ValueError):
    """Several problems found by one check."""

    def __init__(self, problems: Sequence[Problem]) -> None:
        super().__init__("; ".join(problem.what for problem in problems))
        self.problems = tuple(problems)


def shown(value: object) -> str:
    """A value as a sentence shows it: texts in quotes, numbers as written, anything else by its kind."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        text = value if len(value) <= 60 else value[:57] + "..."
        return '"' + "".join(c if c.isprintable() else repr(c)[1:-1] for c in text) + '"'
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, int):
        return str(value) if abs(value) < 10**30 else _("a number of that size")
    if isinstance(value, dict):
        return _("a table")
    if isinstance(value, list | tuple):
        count = len(value)
        return ngettext("a list of {count} value", "a list of {count} values", count).format(count=count)
    return _("a value of another kind")


def likely(name: str, known: Iterable[str]) -> str:
    """Repair of a misspelt name: the nearest known one, if one is near."""
    names = list(known)
    folded = [other for other in names if other.casefold() == name.casefold()]
    cutoff = 0.5 if len(name) <= 3 else 0.6  # AO is near OA; "angle" is not near "machine"
    close = folded or difflib.get_close_matches(name[: limits.NAME_LENGTH], names, n=1, cutoff=cutoff)
    return _("did you mean {name}?").format(name=shown(close[0])) if close else ""


def nearest(name: str, known: Iterable[str]) -> str:
    """Repair of a misspelt name: the nearest known one, else what is known."""
    names = list(known)
    repair = likely(name, names)
    if repair or not names:
        return repair
    few = ", ".join(names[:20]) + (", ..." if len(names) > 20 else "")
    return _("known are: {names}").format(names=few)


def location(place: Place) -> tuple[str, str]:
    """Table and key of a place as the file spells them: ("[links.BC]", "length"), ("[[guides]] 2", "point")."""
    place = tuple(part if isinstance(part, int) else shown(str(part))[1:-1] for part in place)
    if len(place) >= 2 and isinstance(place[1], int):
        return f"[[{place[0]}]] {place[1] + 1}", ".".join(str(p) for p in place[2:])
    if len(place) >= 3 and place[:2] == ("machine", "shafts") and isinstance(place[2], int):
        return f"[[machine.shafts]] {place[2] + 1}", ".".join(str(p) for p in place[3:])
    if (len(place) == 2 and place[0] == "links") or place == ("frame", "points"):
        return "[" + ".".join(str(p) for p in place) + "]", ""
    if len(place) >= 2 and isinstance(place[-1], int):
        return "[" + ".".join(str(p) for p in place[:-2]) + "]", str(place[-2])
    if len(place) >= 2:
        return "[" + ".".join(str(p) for p in place[:-1]) + "]", str(place[-1])
    if place and place[0] in TABLES:
        return f"[{place[0]}]", ""
    return "", str(place[0]) if place else ""


def told(problem: Problem, place: Place, source: str) -> InputError:
    """The sentence of a problem at a place of a source (a file's name; empty in Python)."""
    table, key = location(place + problem.at)
    what = problem.what
    if KEY in what:
        what = what.replace(KEY, key, 1)
    elif key:
        table = f"{table} {key}" if not table.startswith("[[") else f"{table}, {key}"
    where = ", ".join(part for part in (source, table.strip()) if part)
    return InputError(where, what, problem.repair)


def problems_of(error: dict[str, Any]) -> list[Problem]:
    """The problems that one of pydantic's errors carries; its own kinds are told without its words."""
    cause = error.get("ctx", {}).get("error")
    if isinstance(cause, Problems):
        return list(cause.problems)
    if isinstance(cause, Problem):
        return [cause]
    return [Problem(_("this value does not fit here: {value}").format(value=shown(error.get("input"))))]


def input_error(error: ValidationError, source: str) -> InputError:
    """One InputError that tells the first few problems pydantic gathered, one a line."""
    found: list[InputError] = []
    for entry in error.errors(include_url=False):
        place: Place = tuple(part for part in entry["loc"] if part != "[key]")
        found += [told(problem, place, source) for problem in problems_of(dict(entry))]
    first, rest = found[0], found[1 : limits.PROBLEMS_SHOWN]
    lines = [str(other) for other in rest]
    left = len(found) - 1 - len(rest)
    if left > 0:
        lines.append(
            ngettext("and {count} more problem", "and {count} more problems", left).format(count=left)
        )
    tail = "".join("\n" + line for line in lines)
    if first.repair:
        return InputError(first.where, first.what, first.repair + tail)
    return InputError(first.where, first.what + tail)
