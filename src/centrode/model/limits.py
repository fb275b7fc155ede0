"""What a file may ask for at most: a text that asks for more is refused before anything is built from it."""

from __future__ import annotations

FILE_SIZE = 1_000_000
"""Bytes of a description or of a drive's table."""

LINKS = 200
"""Structure and systems of equations grow with their square and more: a check takes seconds here, a run a minute."""
POINTS = 2000
GUIDES = 500
DRIVES = 100
LOADS = 500
SAMPLES = 1_000_000
INSTANTS = 1000
TABLE_ROWS = 10_000

GREATEST = 1e50
"""Greatest number; fourth powers of it can still be computed with."""

GREATEST_ANGLE = 1e6
"""Greatest angle [rad]: of a greater one the place within a turn is lost in rounding."""

LEAST = 1e-50
"""Least length and other number that has to be positive."""

NAME_LENGTH = 40
TEXT_LENGTH = 1000
"""Characters of a title or a formula."""

QUANTITY_LENGTH = 100
"""Characters of a number with its unit."""

UNIT_LENGTH = 40
NESTING = 12
"""Tables and lists inside each other; the grammar needs five."""

PROBLEMS_SOUGHT = 20
"""Problems of one table after which no more are looked for."""

PROBLEMS_SHOWN = 5
"""Problems of one file that are told together."""
