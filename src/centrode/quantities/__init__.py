"""The vocabulary of results: what each variable is called, its symbol, its unit, and how units are shown.

Every table, plot and report reads it. Inside the package all numbers are SI and radians; a unit is a short
text like "m", "rad/s", "m/rad^2", and "1" where there is none.
"""

from __future__ import annotations

from collections.abc import Mapping

from centrode.quantities.cams import CAMS
from centrode.quantities.forces import FORCES
from centrode.quantities.motions import MOTIONS
from centrode.quantities.quantity import STATUS_WORDS, Quantity, status_word
from centrode.quantities.units import ANGLES, LENGTHS, display_unit, typeset_unit

__all__ = [
    "ANGLES",
    "LENGTHS",
    "QUANTITIES",
    "STATUS_WORDS",
    "Quantity",
    "display_unit",
    "status_word",
    "typeset_unit",
]

QUANTITIES: Mapping[str, Quantity] = {quantity.name: quantity for quantity in (*MOTIONS, *FORCES, *CAMS)}
"""Every variable of a motion by its name, in reading order."""
