"""Where the angles of spherical links are measured: between the link's own arc and its reference arc."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeAlias

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import FRAME, Mechanism
from centrode.structure.bevels import measured_on

Local: TypeAlias = Mapping[str, tuple[Any, Any]]


def ends_of(mechanism: Mechanism) -> dict[str, tuple[str, ...]]:
    """End of the reference arc of every link that has one; it starts at the link's first point."""
    return {name: link.reference[1:] for name, link in mechanism.links.items() if link.reference is not None}


def references_of(
    mechanism: Mechanism,
    frame: Local,
    local: Mapping[str, Local],
    ends: Mapping[str, tuple[str, ...]],
) -> dict[str, tuple[Any, ...]]:
    """Of driven links and those of gears: ends of the own arc, and of the reference arc in the base's axes."""
    found = {}
    for link, body in measured_on(mechanism).items():
        pivot, second = list(local[link])[:2]
        base = frame if body == FRAME else local[body]
        found[link] = (local[link][pivot], local[link][second], base[pivot], base[ends[link][0]])
    for drive in mechanism.drives:
        if drive.link is None:
            continue
        pivot, second = list(local[drive.link])[:2]
        (towards,) = ends[drive.link]
        base = frame if drive.relative_to == FRAME else local[drive.relative_to]
        missing = [point for point in (pivot, towards) if point not in base]
        if missing:
            raise InputError(
                _("drive of link {link}").format(link=drive.link),
                _("its reference arc has to lie on {body}, and {point} is no point of it").format(
                    body=drive.relative_to, point=missing[0]
                ),
                _("drive it relative to the link that has both points, or choose other points"),
            )
        own = local[drive.link]
        found[drive.link] = (own[pivot], own[second], base[pivot], base[towards])
    return found
