"""Scales of drawings that a person gives instead of the round ones."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

from centrode.analysis.graphic.board import round_scale
from centrode.errors import InputError
from centrode.locale import _

if TYPE_CHECKING:
    pass

NAMES = ("length", "velocity", "acceleration")
PAGE = 120.0
"""Longest side of a drawing that goes on a page A5 [mm]."""


def chosen_scale(name: str, extent: float, room: float, scales: Mapping[str, float]) -> float:
    """The scale given for a drawing of an extent [SI], or the round one that fills a room [mm].

    Raises InputError where the scale given is no positive number, or the drawing does not go on a page with it.
    """
    for other in scales:
        if other not in NAMES:
            raise InputError(
                "scales",
                _("{name} is no scale").format(name=other),
                _("one of: {names}").format(names=", ".join(NAMES)),
            )
    given = scales.get(name)
    if given is None:
        return round_scale(extent, room)
    if not 0.0 < given < math.inf:
        raise InputError(
            f"scales, {name}", _("a scale has to be positive, got {value:g}").format(value=given)
        )
    if extent > PAGE * given:
        raise InputError(
            f"scales, {name}",
            _("the drawing would be {size:.4g} mm long").format(size=extent / given),
            _("take at least {least:g} a millimetre").format(least=round_scale(extent, PAGE)),
        )
    return given
