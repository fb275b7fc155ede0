"""The standards that pages of a report may follow."""

from __future__ import annotations

from typing import Literal, TypeAlias

STANDARDS = ("plain", "gost", "dstu")
"""Page styles: the program's own, GOST 2.105 with the page of GOST 7.32, DSTU 3008:2015."""
Standard: TypeAlias = Literal["plain", "gost", "dstu"]
