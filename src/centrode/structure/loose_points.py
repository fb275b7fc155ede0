"""Points that nothing joins although they ought to be: why a mechanism has more freedoms than drives."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.links import Guide
from centrode.model.look_alikes import letters_note, look_alike_pairs
from centrode.model.mechanism import Mechanism
from centrode.model.reading import FRAME, location, value_text
from centrode.structure.constraints import Entity
from centrode.structure.rank import INDEPENDENT, Matrix, columns_of

MOST_NAMED = 5
"""Loose points that one message names."""


def look_alike_error(mechanism: Mechanism, what: str) -> InputError | None:
    """The error of two points whose names look alike, if there are any; `what` goes wrong because of them."""
    pairs = look_alike_pairs(mechanism.points)
    if not pairs:
        return None
    odd = [name for name, _common in pairs]
    # The name of the link tells more than that of a point where all of them are in it.
    for link in mechanism.links:
        if set(odd) <= set(mechanism.links[link].coordinates) and all(name in link for name in odd):
            return InputError(location(("links", link))[0], what, letters_note(link, pairs))
    name = odd[0]
    owner = next((link for link in mechanism.links if name in mechanism.links[link].coordinates), FRAME)
    place = ("frame", "points") if name in mechanism.frame.points else ("links", owner)
    return InputError(location(place)[0], what, letters_note(name, pairs[:1]))


def loose_points_repair(mechanism: Mechanism, free: Matrix, unknowns: Sequence[Entity]) -> str:
    """Which points nothing joins, with what could be meant; empty where every end of what moves freely is joined.

    Parameters
    ----------
    free : Jacobian of all constraints, those of the drives included, at a generic position
    unknowns : the columns of it
    """
    moving = _moving_freely(free, unknowns)
    loose = list(_loose_points(mechanism, moving)) or list(_loose_pivots(mechanism, moving))
    # A slider of no link is a body of its own, which may be meant; here it moves on its own.
    told = _("no link has point {point} of guide {guide}: is it spelled as in its link?")
    sentences = [told.format(point=guide.point, guide=guide.id) for guide in _guides_of_nothing(mechanism)]
    spare = _spare_points(mechanism)
    for point, link in loose[:MOST_NAMED]:
        named = {"point": point, "link": link}
        alike = [name for name in mechanism.points if name != point and name.casefold() == point.casefold()]
        if alike:
            what = _("point {point} of link {link} is joined to nothing: did you mean {other}?")
            sentences.append(what.format(**named, other=value_text(alike[0])))
        elif len(loose) == 1 and len(spare) == 1:
            what = _(
                "point {point} of link {link} is joined to nothing, nor is {other} of the frame: are they one?"
            )
            sentences.append(what.format(**named, other=spare[0]))
        else:
            what = _("point {point} of link {link} is joined to nothing: is it a point of the frame?")
            sentences.append(what.format(**named))
    return "\n".join(sentences)


def _moving_freely(matrix: Matrix, unknowns: Sequence[Entity]) -> frozenset[str]:
    """Links that can still move while the drives stand."""
    _left, values, directions = np.linalg.svd(matrix)
    rank = int(np.sum(values > INDEPENDENT * values[0])) if values.size else 0
    motions = directions[rank:]
    first, _width = columns_of(unknowns)
    return frozenset(
        entity.name
        for entity, column in first.items()
        if entity.kind == "link"
        and bool(np.any(np.abs(motions[:, column : column + entity.unknowns]) > INDEPENDENT))
    )


def _loose_points(mechanism: Mechanism, moving: frozenset[str]) -> Iterator[tuple[str, str]]:
    """Points that are in one link only, with it, where this link has no second joint."""
    bodies = Counter([*mechanism.frame.points])
    for link in mechanism.links.values():
        bodies.update([*link.coordinates])
    held = {guide.point for guide in mechanism.guides}
    held.update(point for drive in mechanism.drives for point in drive.distance or ())
    # Joints that a link has by itself, not by a point: slides along it or of it, gears and rolling contacts.
    joints: Counter[str] = Counter()
    for guide in mechanism.guides:
        joints.update([guide.on])
        # A guided link has a prismatic pair, which leaves it one freedom as two joints do.
        joints.update([guide.link] * 2 if guide.link else [])
    for gear in mechanism.gears:
        joints.update(gear.links)
    for wheel in mechanism.rolling:
        joints.update([wheel.link, wheel.on])
    for name, link in mechanism.links.items():
        joined = [point for point in link.coordinates if bodies[point] > 1 or point in held]
        if name in moving and len(joined) + joints[name] < 2:
            yield from ((point, name) for point in link.coordinates if point not in joined)


def _loose_pivots(mechanism: Mechanism, moving: frozenset[str]) -> Iterator[tuple[str, str]]:
    """Points in one link only, with it, that are its first one or one through which its own guide goes."""
    bodies = Counter([*mechanism.frame.points])
    for link in mechanism.links.values():
        bodies.update([*link.coordinates])
    held = {guide.point for guide in mechanism.guides}
    held.update(point for drive in mechanism.drives for point in drive.distance or ())
    for name in mechanism.links:
        if name in moving:
            points = [*mechanism.links[name].coordinates]
            through = [guide.through for guide in mechanism.guides if guide.on == name]
            pivots = [point for point in points if point == points[0] or point in through]
            yield from ((point, name) for point in pivots if bodies[point] < 2 and point not in held)


def _guides_of_nothing(mechanism: Mechanism) -> list[Guide]:
    """Guides whose point neither a link nor the frame has."""
    used = {*mechanism.frame.points}.union(*(link.coordinates for link in mechanism.links.values()))
    counts = Counter(guide.point for guide in mechanism.guides)
    return [guide for guide in mechanism.guides if guide.point not in used and counts[guide.point] == 1]


def _spare_points(mechanism: Mechanism) -> list[str]:
    """Points of the frame that nothing is at."""
    used = {point for link in mechanism.links.values() for point in link.coordinates}
    for guide in mechanism.guides:
        used.update(name for name in (guide.point, guide.through, guide.pole) if isinstance(name, str))
    used.update(point for drive in mechanism.drives for point in drive.distance or ())
    used.update(wheel.along.centre for wheel in mechanism.rolling if isinstance(wheel.along.centre, str))
    for load in mechanism.loads:
        for field in load.keys().values():
            value = getattr(load, field)
            used.update(
                name for name in (value if isinstance(value, tuple) else (value,)) if isinstance(name, str)
            )
    return [point for point in mechanism.frame.points if point not in used]
