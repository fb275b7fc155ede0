"""Turns of angles as expressions: told by a centre that may run on with the drive, or by the place before."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, TypeAlias

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Operand, variable

Number: TypeAlias = Any

TURN = 2.0 * math.pi
WHOLE = 1.5 * 2.0**52
"""Added and taken away again it leaves the nearest whole number: the bits behind the point do not fit."""
MOST = 0.8
"""Greatest change of an angle [rad] from one place at which turns are counted to the next."""
AWAY = 0.2
"""How far [rad] angles stay from half a turn off what tells their turns."""


def whole_turns(near: Number, angle: Number) -> Number:
    """The turns to add to an angle to come as close as may be to another, over any algebra."""
    return ((near - angle) * (1.0 / TURN) + WHOLE) - WHOLE


def turns_of(link: str, cosine: Operand, sine: Operand, winders: Mapping[str, Operand]) -> Operand:
    """The turns that bring an angle within half a turn of a centre that runs on with a drive."""
    centre: Operand = variable(centre_of(link))
    for drive, value in winders.items():
        centre = centre + variable(winding_of(link, drive)) * value
    turns: Operand = whole_turns(centre, EXPRESSIONS.atan2(sine, cosine))
    return turns


def turns_along(link: str, cosine: Operand, sine: Operand) -> Operand:
    """The turns that bring an angle within half a turn of what it was at the place before."""
    turns: Operand = whole_turns(variable(before_of(link)), EXPRESSIONS.atan2(sine, cosine))
    return turns


def before_of(link: str) -> str:
    """Name of a link's angle at the place before."""
    return f"angle before {link}"


def centre_of(link: str) -> str:
    """Name of the middle of a link's angles, those of the drive (times its winding) taken off."""
    return f"centre {link}"


def winding_of(link: str, drive: str) -> str:
    """Name of the turns that a link makes for one of a drive: -1, 0 or 1."""
    return f"winding {link} with {drive}"
