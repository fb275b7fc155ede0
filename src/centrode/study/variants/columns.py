"""Columns of a table of variants: which numbers of a mechanism a header names.

A header is a path ("links.AC.length"), or short as tables of assignments have it: a letter and the number of the
link, counted in the order of the description. l2 is the length of the second link, phi2_0 its initial angle,
omega1 the speed of the drive of the first. A unit stands behind, in brackets or after an underscore.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model.files import kind_at
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.units import unit_factor

NAME = "variant"
"""Header of the column that names the variants."""

_BRACKET = re.compile(r"(.*?)\s*\[([^\[\]]*)\]\s*")
_SHORT = re.compile(r"(l|phi|φ|omega|ω)(\d{1,4})(_0)?(?:_([a-zA-Z°]\w*))?")
_KINDS = {"l": "length", "phi": "angle", "φ": "angle", "omega": "speed", "ω": "speed"}


@dataclass(frozen=True)
class Column:
    """One column of numbers.

    Attributes
    ----------
    header : as the table has it
    paths : what the number is put into; a driven link's initial angle is also the start of its drive
    kind : kind of quantity ("length", "angle", ...)
    factor : value in SI of one of the header's unit; None where it names none, so that cells may have their own
    """

    header: str
    paths: tuple[str, ...]
    kind: str
    factor: float | None


def columns_of(mechanism: Mechanism, headers: Sequence[str]) -> list[Column | None]:
    """The columns of a table, None for the one with the names.

    Raises InputError: no column of names, a header that names nothing, two that name the same, a unit that does
    not fit.
    """
    found: list[Column | None] = []
    named: dict[str, str] = {}
    for header in headers:
        column = None if header.strip().casefold() == NAME else _column(mechanism, header)
        for path in (NAME,) if column is None else column.paths:
            if path in named:
                both = _("columns {one} and {other} name the same number")
                raise InputError(
                    "",
                    both.format(one=value_text(named[path]), other=value_text(header)),
                    _("keep one of them"),
                )
            named[path] = header
        found.append(column)
    if NAME not in named:
        what = _("the column {name} is missing").format(name=value_text(NAME))
        raise InputError("", what, _("give every variant a name in it, such as its number"))
    if len(found) == 1:
        raise InputError("", _("no column has a number of the mechanism"), _hint(mechanism))
    return found


def _column(mechanism: Mechanism, header: str) -> Column:
    bracket = _BRACKET.fullmatch(header)
    name, unit = (bracket.group(1).strip(), bracket.group(2)) if bracket else (header.strip(), None)
    short = _SHORT.fullmatch(name)
    try:
        if short is not None:
            letter, number, _initial, suffix = short.groups()
            if suffix is not None and unit is not None:
                raise InputError("", _("it names two units"), _("keep one of them"))
            unit = suffix.replace("_", "/") if suffix is not None else unit
            paths = _short_paths(mechanism, _KINDS[letter], int(number))
        elif "." in name:
            paths = (name,)
        else:
            raise InputError("", _("it names no number of the mechanism"), _hint(mechanism))
        kind = kind_at(mechanism, paths[0])
        factor = None if unit is None else unit_factor(unit, kind)
    except InputError as error:
        where = _("column {header}").format(header=value_text(header))
        raise InputError(where, error.what, error.repair) from None
    return Column(header.strip(), paths, kind, factor)


def _short_paths(mechanism: Mechanism, kind: str, number: int) -> tuple[str, ...]:
    """Paths of a short header: length, initial angle or speed of the link with a number."""
    names = mechanism.link_names
    if not 1 <= number <= len(names):
        what = ngettext(
            "there is no link {number}: the mechanism has {count} link",
            "there is no link {number}: the mechanism has {count} links",
            len(names),
        ).format(number=number, count=len(names))
        raise InputError(
            "",
            what,
            _("they are counted in the order of the description: {names}").format(names=", ".join(names)),
        )
    link = names[number - 1]
    drive = next((drive for drive in mechanism.drives if drive.link == link), None)
    if kind == "length":
        if mechanism.links[link].length is None:
            what = _("link {link} has no length, its points have coordinates").format(link=link)
            raise InputError("", what, _("name one of them: links.{link}.points.P.x").format(link=link))
        return (f"links.{link}.length",)
    if kind == "speed":
        if drive is None:
            what = _("link {link} is not driven").format(link=link)
            raise InputError("", what, nearest(link, [one.id for one in mechanism.drives]))
        return (f"drives.{link}.speed",)
    start = drive is not None and drive.relative_to == FRAME and drive.start is not None
    return (f"links.{link}.angle", *([f"drives.{link}.start"] if start else []))


def _hint(mechanism: Mechanism) -> str:
    link = mechanism.link_names[-1]
    return _("write a path such as links.{link}.length, or l{n}, phi{n}_0 for the {n}th link").format(
        link=link, n=len(mechanism.link_names)
    )
