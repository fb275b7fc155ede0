"""The table of joints: which link a reaction acts on, and which one bears its opposite."""

from __future__ import annotations

from centrode.locale import _
from centrode.model.mechanism import FRAME, Mechanism

Column = tuple[str, str, str]
"""A joint's name, the link that its reaction acts on (+1), and the link that bears the opposite (-1)."""


def joint_table(mechanism: Mechanism) -> tuple[list[str], list[list[str]]]:
    """Links (rows, the frame last as 0) and joints (columns): 1 where a reaction acts, -1 where its opposite does.

    Hinges come first, in the order in which the links name them, then guides, gears, wheels and cylinders. The
    reaction acts on the link that the description names first. A hinge of k links is k - 1 joints: of the first
    link with each of the others.
    """
    joints = [*_hinges(mechanism), *_guides(mechanism), *_wheels(mechanism), *_cylinders(mechanism)]
    names = [*mechanism.links, FRAME]
    rows = []
    for number, name in enumerate(names, start=1):
        label = f"{number} {name}" if name != FRAME else "0 " + _("frame")
        rows.append([label, *(str((one == name) - (other == name)) for _joint, one, other in joints)])
    return [_("link"), *(joint for joint, _one, _other in joints)], rows


def _bodies_at(mechanism: Mechanism, point: str) -> list[str]:
    """Links hinged at a point, in description order, the frame last."""
    links = [name for name, link in mechanism.links.items() if point in link.coordinates]
    return [*links, FRAME] if point in mechanism.frame.points else links


def _hinges(mechanism: Mechanism) -> list[Column]:
    points = dict.fromkeys(point for link in mechanism.links.values() for point in link.coordinates)
    found = []
    for point in points:
        first, *others = _bodies_at(mechanism, point)
        said = [_("frame") if other == FRAME else other for other in others]
        names = [f"{point} {other}" for other in said] if len(others) > 1 else [point]
        found += [(name, first, other) for name, other in zip(names, others, strict=False)]
    return found


def _guides(mechanism: Mechanism) -> list[Column]:
    """Guides, each between the slider, or the first link at its point, and the body that carries its line."""
    found = []
    for guide in mechanism.guides:
        slider = guide.link or next(iter(_bodies_at(mechanism, guide.point)), "")
        found.append((_("guide {guide}").format(guide=guide.id), slider, guide.on))
    return found


def _wheels(mechanism: Mechanism) -> list[Column]:
    gears = [
        (_("gear {gear}").format(gear=gear.id), gear.links[0], gear.links[1]) for gear in mechanism.gears
    ]
    rolling = [
        (_("wheel {wheel}").format(wheel=wheel.id), wheel.link, wheel.on) for wheel in mechanism.rolling
    ]
    return [*gears, *rolling]


def _cylinders(mechanism: Mechanism) -> list[Column]:
    found = []
    for drive in mechanism.drives:
        if drive.distance is not None:
            first, second = (next(iter(_bodies_at(mechanism, point)), "") for point in drive.distance)
            found.append((_("cylinder {drive}").format(drive=drive.id), second, first))
    return found
