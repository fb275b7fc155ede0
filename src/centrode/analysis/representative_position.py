"""The position in which a mechanism is drawn as a scheme: the one farthest from its dead and limit positions.

At a dead or a limit position two links of a group lie in one line, or a link stands square to its guide. So the sine of
the angle between neighbouring links at each hinge, and of twice the angle between a link and the guide of its point,
are compared with the greatest that they have in the motion. The position is the sample at which the least of these
shares is greatest: there no two neighbours come near to one line, and none covers another.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.errors import Status
from centrode.model.mechanism import FRAME

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Guide, Mechanism

Array: TypeAlias = NDArray[np.float64]

ALWAYS_IN_LINE = 1e-6
"""Greatest sine up to which two lines are in one line throughout the motion, and say nothing of a position."""


def representative_sample(mechanism: Mechanism, motion: xarray.Dataset) -> int:
    """The sample of a motion that shows a mechanism farthest from its dead and limit positions.

    Parameters
    ----------
    mechanism : Mechanism
    motion : Dataset
        Of `motion`, without batch dimensions.

    Returns
    -------
    int
        Among the samples that are reached; of equally good ones the nearest to the initial position, which is also
        taken where neighbouring links meet at no angle that changes.
    """
    reached = motion["status"].values == Status.OK
    if not reached.any():
        return int(np.argmin(np.abs(motion["time"].values)))
    shares = [np.where(reached, sine, 0.0) for sine in _sines(mechanism, motion)]
    shares = [share / share.max() for share in shares if share.max() > ALWAYS_IN_LINE]
    least = np.min(shares, axis=0, initial=1.0) if shares else np.ones(len(reached))
    least = np.where(reached, np.round(least, 6), -1.0)
    best = np.flatnonzero(least == least.max())
    return int(best[np.argmin(np.abs(motion["time"].values[best]))])


def _sines(mechanism: Mechanism, motion: xarray.Dataset) -> Iterator[Array]:
    """Sines of the angles between neighbours (sample); zero where one of the lines has no length."""
    places = {str(name): motion["position"].sel(point=name).values for name in motion["point"].values}
    links = {
        name: [one for one in link.coordinates if one in places] for name, link in mechanism.links.items()
    }
    for name in places:
        joined = [
            [place for other in points if other != name and len(place := places[other])]
            for points in links.values()
            if name in points
        ]
        for one, other in combinations([arms for arms in joined if arms], 2):
            yield _sine(places[name], one[0], other[0])
    if mechanism.space == "plane":
        for guide in mechanism.guides:
            yield from _sines_at_guide(guide, places, links, motion)


def _sines_at_guide(
    guide: Guide, places: dict[str, Array], links: dict[str, list[str]], motion: xarray.Dataset
) -> Iterator[Array]:
    """Sines of twice the angle between a guide and each link at its point: zero along the guide and square to it."""
    turn = 0.0 if guide.on == FRAME else motion["angle"].sel(link=guide.on).values
    along = turn + guide.direction_angle
    for name, points in links.items():
        if guide.point not in points or name in (guide.link, guide.on):
            continue
        for other in points[:2]:
            if other != guide.point:
                way = places[other] - places[guide.point]
                yield np.abs(np.sin(2.0 * (np.arctan2(way[:, 1], way[:, 0]) - along)))


def _sine(at: Array, one: Array, other: Array) -> Array:
    """Sine of the angle at a place between two others, in the plane or on the unit sphere."""
    first, second = one - at, other - at
    if at.shape[-1] == 3:  # of the arcs: what is across the radius
        first, second = (way - np.sum(way * at, axis=-1, keepdims=True) * at for way in (first, second))
        product = np.linalg.norm(np.cross(first, second), axis=-1)
    else:
        product = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    size = np.linalg.norm(first, axis=-1) * np.linalg.norm(second, axis=-1)
    known = np.where(size > np.finfo(float).tiny, size, 1.0)
    return np.asarray(np.nan_to_num(np.where(size > np.finfo(float).tiny, product / known, 0.0)))
