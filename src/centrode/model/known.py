"""Checks that a name in a description is one of something: a point, a link, a guide."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from centrode.locale import _
from centrode.model.description import Description
from centrode.model.names import FRAME
from centrode.model.problems import Place, Problem, nearest, shown


def known(name: str, names: Iterable[str], kind: str, at: Place, link: str = "") -> Iterator[Problem]:
    """The problem, if any, of a name that is none of `names`; `link` is the one whose points they are."""
    candidates = list(names)
    if name in candidates:
        return
    sentences = {
        "point": _("{link} has no point {name}") if link else _("unknown point {name}"),
        "link": _("unknown link {name}"),
        "guide": _("unknown guide {name}"),
        "point, link or guide": _("unknown point, link or guide {name}"),
    }
    yield Problem(sentences[kind].format(name=shown(name), link=link), nearest(name, candidates), at)


def link_known(mechanism: Description, name: str, at: Place, moving: bool = False) -> Iterator[Problem]:
    """The problem, if any, of a link that is not there; the frame counts as one unless it has to move."""
    yield from known(name, list(mechanism.links) if moving else [FRAME, *mechanism.links], "link", at)


def two_known_points(mechanism: Description, points: tuple[str, ...] | None, at: Place) -> Iterator[Problem]:
    """Problems of a pair of points, where one is given: they are known and differ."""
    if points is None:
        return
    if len(set(points)) != 2 or len(points) != 2:
        yield Problem(_('two different points are needed: ["A", "B"]'), "", at)
    for point in points:
        yield from known(point, mechanism.points, "point", at)


def points_on(mechanism: Description, link: str) -> Iterable[str]:
    """Names of the points of a link, or of the frame."""
    return mechanism.frame.points if link == FRAME else mechanism.links[link].coordinates


def is_link(mechanism: Description, name: str) -> bool:
    """Whether a name is the frame's or a link's."""
    return name == FRAME or name in mechanism.links
