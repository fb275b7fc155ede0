"""Where the angles of spherical links are measured: between the link's own arc and its reference arc."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import FRAME, Link, Mechanism

Local: TypeAlias = Mapping[str, tuple[Any, Any]]


def ends_of(name: str, link: Link) -> tuple[str, str, str]:
    """Pivot, end of the reference arc, and second point of a link that has a reference."""
    pivot, towards = link.reference or ("", "")
    first, second = [*link.coordinates, "", ""][:2]
    if not second:
        raise InputError(
            f"[links.{name}] reference",
            _("the link has one point, so it has no arc whose angle could be measured"),
            _("give it a second point, or take the reference out"),
        )
    if pivot != first:
        raise InputError(
            f"[links.{name}] reference",
            _("the angle of a link is measured at its first point, {first}").format(first=first),
            _("write reference = [{first}, ...]").format(first=f'"{first}"'),
        )
    return pivot, towards, second


def references_of(
    mechanism: Mechanism,
    frame: Local,
    local: Mapping[str, Local],
    ends: Mapping[str, tuple[str, ...]],
) -> dict[str, tuple[Any, ...]]:
    """Of each driven link: ends of its own arc in its axes, and of the reference arc in those of its base."""
    found = {}
    for drive in mechanism.drives:
        if drive.link is None:
            continue
        if drive.link not in ends:
            raise InputError(
                f"[links.{drive.link}]",
                _("a driven link needs an arc that its angle is measured from"),
                _("give reference = [...], two points: its first point, and another one"),
            )
        pivot, towards, second = ends[drive.link]
        base = frame if drive.relative_to == FRAME else local[drive.relative_to]
        missing = [point for point in (pivot, towards) if point not in base]
        if missing:
            raise InputError(
                _("drive of link {link}").format(link=drive.link),
                _("its reference arc is to lie on {body}, which has no point {point}").format(
                    body=drive.relative_to, point=missing[0]
                ),
                _("drive it relative to the link of both points, or choose other points"),
            )
        own = local[drive.link]
        found[drive.link] = (own[pivot], own[second], base[pivot], base[towards])
    return found
