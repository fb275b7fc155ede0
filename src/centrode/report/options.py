"""What a report is to hold: the wishes of the description's [report], and those of the caller, which go before them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeVar

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.cam_files import AnyCam
from centrode.model.mechanism import Mechanism
from centrode.model.motion_parameter import ANGLE
from centrode.model.reading import nearest, value_text
from centrode.model.settings import DIGITS, LEAST_DIGITS, MOST_DIGITS, ReportWishes

Wished = TypeVar("Wished")


@dataclass(frozen=True)
class ReportOptions:
    """What a report is to hold; what is None is left to the description, and else to the report.

    Attributes
    ----------
    chapters : names of chapters, in any order; all that apply if nobody chooses
    instants : values of the drive at which tables, diagrams and forces are shown [rad or m; s with several drives]
    points : names of points whose velocities and paths are told
    digits : significant digits of numbers
    """

    chapters: tuple[str, ...] | None = None
    instants: tuple[float, ...] | None = None
    points: tuple[str, ...] | None = None
    digits: int | None = None


@dataclass(frozen=True)
class Wishes:
    """The same, settled; chapters and points are None where nobody chose, instants empty."""

    chapters: tuple[str, ...] | None
    instants: tuple[float, ...]
    points: tuple[str, ...] | None
    digits: int


def settled(description: Mechanism | AnyCam, options: ReportOptions, known: Iterable[str]) -> Wishes:
    """The wishes of a caller, where there are none those of the description.

    Raises InputError for a chapter that is not in `known`, for a point that the mechanism has not, for digits out of
    bounds.
    """
    asked = description.report
    points = asked.points or None if isinstance(asked, ReportWishes) else None
    found = Wishes(
        _first(options.chapters, asked.chapters or None),
        _first(options.instants, asked.instants or description.study.instants) or (),
        _first(options.points, points),
        options.digits if options.digits is not None else asked.digits or DIGITS,
    )
    where = "chapters" if options.chapters is not None else "[report] chapters"
    if found.chapters is not None and not found.chapters:
        raise InputError(where, _("no chapter is named"), nearest("", list(known)))
    _check(found.chapters, known, where, _("there is no chapter {name}"))
    names = description.points if isinstance(description, Mechanism) else ()
    _check(found.points, names, "points", _("unknown point {name}"))
    moving = description.moving_points if isinstance(description, Mechanism) else ()
    _check(found.points, moving, "points", _("point {name} does not move"))
    if not LEAST_DIGITS <= found.digits <= MOST_DIGITS:
        what = _("numbers have {least} to {most} digits, {digits} were asked for")
        said = what.format(least=LEAST_DIGITS, most=MOST_DIGITS, digits=found.digits)
        raise InputError("digits", said)
    return found


def instant(description: Mechanism | AnyCam, text: float | str, where: str) -> float:
    """Value of the drive, a time with several drives, an angle of a cam [rad, m or s], of a number or a text.

    Raises InputError, which names `where`, for a unit of another kind.
    """
    known = description.motion_parameter.variable if isinstance(description, Mechanism) else ANGLE
    return known.read(text, where)


def _first(wish: Wished | None, other: Wished | None) -> Wished | None:
    return other if wish is None else wish


def _check(names: Iterable[str] | None, known: Iterable[str], where: str, what: str) -> None:
    candidates = list(known)
    for name in names or ():
        if name not in candidates:
            raise InputError(where, what.format(name=value_text(name)), nearest(name, candidates))
