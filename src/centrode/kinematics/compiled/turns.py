"""Turns of angles as expressions."""

from __future__ import annotations

import math

from centrode.algebra.expressions import Operand

TURN = 2.0 * math.pi
WHOLE = 1.5 * 2.0**52
"""Added and taken away again it leaves the nearest whole number: the bits behind the point do not fit."""


def whole_turns(near: Operand, angle: Operand) -> Operand:
    """The turns to add to an angle to come as close as may be to another."""
    return ((near - angle) * (1.0 / TURN) + WHOLE) - WHOLE
