"""Pitch circles of meshing wheels, in the units of the display."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.model.mechanism import FRAME
from centrode.present.scene import Array, Scene
from centrode.present.wheels import Disc

if TYPE_CHECKING:
    from centrode.model.mechanism import Gear

COAXIAL = 1e-9
"""Shafts nearer than this share of the drawing are one: no pitch circles tell their ratio."""


def pitch_circles(scene: Scene, sample: int) -> Iterator[tuple[str, Disc]]:
    """Each meshing wheel by its link, with its circle; none of gears whose shafts the carrier does not hold.

    The circles touch where they mesh: r1 omega1 = -+ r2 omega2 against the carrier, the distance of the shafts
    being r1 + r2 or, of a wheel in a ring, the difference.
    """
    for gear in scene.mechanism.gears:
        shafts = [_shaft(scene, gear, link, sample) for link in gear.links]
        if any(shaft is None for shaft in shafts):
            continue
        distance = float(np.hypot(*(shafts[1] - shafts[0])))  # type: ignore[operator]
        if not np.isfinite(distance) or distance < COAXIAL * scene.extent:
            continue
        second = distance / abs(gear.ratio - 1.0)
        for link, shaft, radius in zip(gear.links, shafts, (abs(gear.ratio) * second, second), strict=True):
            assert shaft is not None
            turn = 0.0 if link == FRAME else float(scene.turns[link][sample])
            yield link, Disc(shaft, radius, turn)


def _shaft(scene: Scene, gear: Gear, link: str, sample: int) -> Array | None:
    """Where a wheel turns on the carrier: the point that both have."""
    held = scene.mechanism.points_of(gear.carrier)
    shared = [point for point in scene.mechanism.points_of(link) if point in held]
    return scene.tracks[shared[0]][sample] if shared else None
