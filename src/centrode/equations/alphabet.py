"""The letters of a mechanism's equations, what each stands for, and its number."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TypeAlias

from centrode.equations.letters import Angle, Letter
from centrode.equations.sums import ZERO, Sum

Vector: TypeAlias = tuple[float, float]

RATIO, BEARING, TURN, FIXED, RATE, SECOND, LENGTH, SLIDE, PLACE, CONSTANT = (
    -1_000_000, 1_000_000, 2_000_000, 3_000_000, 10_000_000, 20_000_000, 30_000_000, 40_000_000, 50_000_000, 60_000_000,
)  # fmt: skip
"""Ranks from which letters of a kind are counted; angles of links stand between the first two, by number."""
ROUNDING = 4 * math.ulp(1.0)
"""A direction this near to an axis [rad] is along it: the cosine of 90 deg is not zero in floats."""
SIMPLE = re.compile(r"[^\W\d_]\d*['’′]*")


@dataclass(frozen=True)
class Meaning:
    """What a letter stands for.

    Attributes
    ----------
    symbol : its name ("phi2")
    kind : "link angle", "relative angle", "bearing", "angle in link", "angle of guide", "angle of pair", "length",
        "reach", "stroke", "slide", "offset along", "offset beside", "coordinate", "ratio", "spin", "radius", "constant"
    names : links, points or guides it belongs to
    value : its number; of what moves, that in the initial position
    unit : "m", "rad" or "1"
    moves : whether it is a function of time
    """

    symbol: str
    kind: str
    names: tuple[str, ...]
    value: float
    unit: str
    moves: bool = False


@dataclass
class Alphabet:
    """Letters as they are needed, each with its meaning."""

    meanings: dict[Letter, Meaning] = field(default_factory=dict)
    rates: dict[Letter, Letter] = field(default_factory=dict)
    seconds: dict[Letter, Letter] = field(default_factory=dict)
    found: dict[tuple[str, tuple[str, ...], str], Letter] = field(default_factory=dict)

    def letter(
        self, rank: int, name: str, kind: str, names: tuple[str, ...], value: float, unit: str
    ) -> Letter:
        """A letter that stays, or the one there is; another thing of the same name gets a prime."""
        key = kind, names, name
        if key in self.found:
            return self.found[key]
        new = self.found[key] = Letter(rank, self._free(name))
        self.meanings[new] = Meaning(new.name, kind, names, float(value), unit)
        return new

    def moving(
        self, rank: int, name: str, kind: str, names: tuple[str, ...], value: float, unit: str, rate: str
    ) -> Letter:
        """A letter that moves, with those of its two derivatives (`rate` begins with omega where it is an angle's)."""
        new = Letter(rank, self._free(name))
        self.meanings[new] = Meaning(new.name, kind, names, float(value), unit, True)
        second = (
            rate.replace("omega", "epsilon") if rate.startswith("omega") else rate.replace("_dot", "_ddot")
        )
        self.rates[new] = Letter(RATE + rank, self._free(rate))
        self.seconds[self.rates[new]] = Letter(SECOND + rank, self._free(second))
        return new

    def constant(self, value: float, unit: str) -> Letter:
        """The next constant of a constraint: C1, C2, ..."""
        number = 1 + sum(one.kind == "constant" for one in self.meanings.values())
        new = Letter(CONSTANT + number, f"C{number}")
        self.meanings[new] = Meaning(new.name, "constant", (), float(value), unit)
        return new

    def angle(self, name: str, kind: str, names: tuple[str, ...], direction: Vector) -> Angle:
        """A constant angle by its cosine and sine: right angles as such, another one by a letter."""
        quarters = quarters_of(direction)
        if quarters is not None:
            return Angle((), quarters)
        value = math.atan2(direction[1], direction[0])
        return Angle.of(self.letter(FIXED + len(self.meanings), name, kind, names, value, "rad"))

    def size(self, rank: int, name: str, kind: str, names: tuple[str, ...], value: float) -> Sum:
        """A constant length, or nothing where it is zero."""
        return Sum.letter(self.letter(rank, name, kind, names, value, "m")) if value else ZERO

    @property
    def values(self) -> Mapping[Letter, float]:
        """Number of every letter; of what moves, that in the initial position."""
        return {letter: meaning.value for letter, meaning in self.meanings.items()}

    def _free(self, name: str) -> str:
        taken = {letter.name for letters in (self.meanings, self.rates, self.seconds) for letter in letters}
        taken |= {letter.name for letter in self.seconds.values()}
        while name in taken:
            name += "'"
        return name


def quarters_of(direction: Vector) -> int | None:
    """Right angles from the x axis to a direction, or None where it is along no axis."""
    x, y = direction
    size = math.hypot(x, y)
    if abs(y) <= ROUNDING * size:
        return 0 if x > 0 else 2
    if abs(x) <= ROUNDING * size:
        return 1 if y > 0 else 3
    return None


def joined(first: str, second: str) -> str:
    """Two points as an index: AP, or A1-P where that could be read otherwise."""
    plain = SIMPLE.fullmatch(first) and SIMPLE.fullmatch(second)
    return f"{first}{second}" if plain else f"{first}-{second}"
