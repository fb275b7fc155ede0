"""Numbers and plane vectors as the XML spells them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from centrode.present.mjcf.tree import Place


def turned(vector: Sequence[float], angle: float) -> Place:
    """A vector turned by an angle [rad]."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]


def less(place: Place, origin: Place) -> Place:
    """A place as seen from an origin."""
    return place[0] - origin[0], place[1] - origin[1]


def number(value: float) -> str:
    """The shortest digits that read back as the same number."""
    return repr(float(value))


def numbers(values: Sequence[float]) -> str:
    """Several of them, apart by blanks."""
    return " ".join(number(value) for value in values)
