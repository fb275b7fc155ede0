"""Letters of formulas, and angles as sums of letters and right angles."""

from __future__ import annotations

from typing import NamedTuple


class Letter(NamedTuple):
    """A symbol; `rank` says where it stands in a product or a sum. Driven angles, too, rank with their link."""

    rank: int
    name: str


Parts = tuple[tuple[Letter, int], ...]


class Angle(NamedTuple):
    """A sum of letters with whole factors, and of right angles."""

    parts: Parts = ()
    quarters: int = 0

    @classmethod
    def of(cls, letter: Letter) -> Angle:
        """The angle that a letter stands for."""
        return cls(((letter, 1),))

    def plus(self, other: Angle, factor: int = 1) -> Angle:
        """The angle and `factor` times the other."""
        total = dict(self.parts)
        for letter, count in other.parts:
            total[letter] = total.get(letter, 0) + factor * count
        parts = tuple(sorted((letter, count) for letter, count in total.items() if count))
        return Angle(parts, (self.quarters + factor * other.quarters) % 4)

    def turned(self, quarters: int) -> Angle:
        """The angle and some right angles."""
        return Angle(self.parts, (self.quarters + quarters) % 4)


class Wave(NamedTuple):
    """A sine or cosine of an angle without right angles, whose first letter has a positive factor."""

    parts: Parts
    kind: str

    @property
    def order(self) -> tuple[bool, Parts, str]:
        """Where it stands in a product: single angles before differences."""
        return len(self.parts) > 1, self.parts, self.kind

    @property
    def partner(self) -> Wave:
        """The sine of the same angle for a cosine, and the other way round."""
        return Wave(self.parts, "cos" if self.kind == "sin" else "sin")


COSINES = ((1, "cos"), (-1, "sin"), (-1, "cos"), (1, "sin"))
"""cos(x + k pi/2) for k = 0, 1, 2, 3: sign and function of x."""
SINES = ((1, "sin"), (1, "cos"), (-1, "sin"), (-1, "cos"))


def wave(kind: str, angle: Angle) -> tuple[int, Wave | None]:
    """A sine or cosine as sign and wave; no wave where it is a number: then the sign is that number."""
    sign, function = (COSINES if kind == "cos" else SINES)[angle.quarters % 4]
    parts = angle.parts
    if not parts:
        return (sign if function == "cos" else 0), None
    if parts[0][1] < 0:
        parts = tuple((letter, -count) for letter, count in parts)
        sign = -sign if function == "sin" else sign
    return sign, Wave(parts, function)
