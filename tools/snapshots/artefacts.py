"""An artefact: one thing that a command gives, as words and series of numbers.

Its digest holds three things. The bits are a hash of the whole, numbers in full. The words are a hash of what is left
when every number is replaced by a sign. A sketch of each series of numbers is its length, its greatest magnitude and a
weighted sum, so that numbers can be compared to a part of their scale on a machine whose last bits differ.
"""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

HASH = 16
"""Hexadecimal digits of a hash: 64 bits."""
NOISE = 1e-12
"""Numbers below this part of the greatest of their artefact are rounding errors."""
TOLERANCE = 1e-12
"""Of the scale of a series: to this two sketches agree."""
SHORT = 8
"""Series up to this length are digested together with the numbers in words."""
POINT = re.compile(r"(?<![\w.])[-\u2212+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w])")
COMMA = re.compile(r"(?<![\w.])[-\u2212+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?(?![\w])")


@dataclass(frozen=True)
class Sketch:
    """A series of numbers in short.

    Attributes
    ----------
    count : numbers of the series
    absent : how many of them are not finite
    scale : greatest magnitude
    total : sum with fixed weights, half to one in magnitude, of either sign
    """

    count: int
    absent: int
    scale: float
    total: float

    def __str__(self) -> str:
        absent = f"/{self.absent}" if self.absent else ""
        return f"{self.count}{absent}:{self.scale:.2g}:{self.total:.14g}"

    @classmethod
    def parse(cls, text: str) -> Sketch:
        """The sketch that `str` wrote."""
        count, scale, total = text.split(":")
        numbers, _slash, absent = count.partition("/")
        return cls(int(numbers), int(absent or 0), float(scale), float(total))

    def distance(self, other: Sketch) -> float:
        """Difference of the sums as a part of the greater scale; infinite for series that differ in length."""
        if (self.count, self.absent) != (other.count, other.absent):
            return math.inf
        scale = max(self.scale, other.scale)
        return abs(self.total - other.total) / scale if scale else 0.0


@dataclass(frozen=True)
class Digest:
    """What the record keeps of an artefact; hashes and sketches in the order of the artefact."""

    bits: str
    words: str
    sketches: tuple[Sketch, ...] = ()

    def __str__(self) -> str:
        return " ".join([self.bits, self.words, *map(str, self.sketches)])

    @classmethod
    def parse(cls, text: str) -> Digest:
        """The digest that `str` wrote."""
        bits, words, *sketches = text.split()
        return cls(bits, words, tuple(map(Sketch.parse, sketches)))


@dataclass
class Artefact:
    """Lines of words, and labelled series of numbers between them.

    Attributes
    ----------
    comma : whether numbers in its words may have a decimal comma
    brief : whether one sketch stands for all long series, as their numbers are recorded in full in another language
    """

    comma: bool = False
    brief: bool = False
    parts: list[str | tuple[str, NDArray[np.float64]]] = field(default_factory=list)

    def say(self, text: str) -> None:
        """Add words; numbers in them are taken for numbers."""
        self.parts.append(text)

    def add(self, label: str, values: Any) -> None:
        """Add a series of numbers, as they are now."""
        self.parts.append((label, np.array(values, dtype=float).ravel()))

    @property
    def text(self) -> str:
        """All of it to read, every number in full."""
        lines = []
        for part in self.parts:
            if isinstance(part, str):
                lines.append(part)
            else:
                label, values = part
                lines.append(f"{label} [{len(values)}]")
                lines += [f"    {' '.join(map(repr, row))}" for row in _rows(values.tolist())]
        return "\n".join(lines) + "\n"

    @property
    def series(self) -> list[tuple[str, Sketch]]:
        """Label and sketch of each series, first of the numbers within words and short series, where there are any."""
        loose: list[float] = []
        long: list[tuple[str, NDArray[np.float64]]] = []
        for part in self.parts:
            if isinstance(part, str):
                loose += self._numbers(part)
            elif len(part[1]) <= SHORT:
                loose += [value for value in part[1].tolist() if math.isfinite(value)]
            elif not any(label == part[0] and np.array_equal(values, part[1]) for label, values in long[-4:]):
                long.append(part)  # curves over one abscissa repeat it
        found = [("single numbers", _sketch(_digits(np.array(loose))))] if loose else []
        sketches = [(label, _sketch(values)) for label, values in long]
        return found + (
            [("series", _together([one for _label, one in sketches]))]
            if self.brief and sketches
            else sketches
        )

    def digest(self) -> Digest:
        """The digest."""
        words = "\n".join(
            self._pattern.sub("#", part) if isinstance(part, str) else f"{part[0]} []" for part in self.parts
        )
        return Digest(_hash(self.text), _hash(words), tuple(sketch for _label, sketch in self.series))

    @property
    def _pattern(self) -> re.Pattern[str]:
        return COMMA if self.comma else POINT

    def _numbers(self, text: str) -> Iterable[float]:
        for token in self._pattern.findall(text):
            yield float(token.replace("\u2212", "-").replace(",", "."))


def differences(
    recorded: Digest, labels: Sequence[str], given: Digest, tolerance: float = TOLERANCE
) -> list[str]:
    """What differs between two digests beyond the tolerance, each as a sentence; `labels` are those of the series."""
    found = ["words differ"] if recorded.words != given.words else []
    if len(recorded.sketches) != len(given.sketches):
        return [
            *found,
            f"{len(recorded.sketches)} series of numbers were recorded, {len(given.sketches)} are given",
        ]
    scale = max((one.scale for one in (*recorded.sketches, *given.sketches)), default=0.0)
    for label, before, after in zip(labels, recorded.sketches, given.sketches, strict=True):
        if (before.count, before.absent) != (after.count, after.absent):
            told = f"{before.count} numbers ({before.absent} absent) became {after.count} ({after.absent} absent)"
            found.append(f"{label}: {told}")
        elif max(before.scale, after.scale) > NOISE * scale and before.distance(after) > tolerance:
            found.append(f"{label}: numbers differ by {before.distance(after):.1e} of the scale")
    return found


def _rows(values: list[float]) -> Iterable[list[float]]:
    for start in range(0, len(values), 8):
        yield values[start : start + 8]


def _digits(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Numbers of any size as ones of like size: mantissa with the decade beside it, 0 for rounding errors.

    In a text great and small numbers stand beside each other; a changed digit of a small one has to be seen.
    """
    greatest = float(np.max(np.abs(numbers), initial=0.0))
    real = np.abs(numbers) > NOISE * greatest
    decades = np.zeros_like(numbers)
    decades[real] = np.floor(np.log10(np.abs(numbers[real])))
    mantissas = np.where(real, numbers / 10.0**decades, 0.0)
    return np.column_stack([mantissas, decades]).ravel()


def _sketch(values: NDArray[np.float64]) -> Sketch:
    finite = np.isfinite(values)
    known = np.where(finite, values, 0.0)
    total = math.fsum(known * _weights(len(known)))
    return Sketch(
        len(values), int(len(values) - finite.sum()), float(np.max(np.abs(known), initial=0.0)), total
    )


def _together(sketches: Sequence[Sketch]) -> Sketch:
    """One sketch for several series, each by its own scale."""
    noise = NOISE * max(one.scale for one in sketches)
    totals = np.array([one.total / one.scale for one in sketches if one.scale > noise])
    return Sketch(
        sum(one.count for one in sketches),
        sum(one.absent for one in sketches),
        1.0,
        math.fsum(totals * _weights(len(totals))),
    )


def _weights(count: int) -> NDArray[np.float64]:
    """Fixed weights, so that neither a change, an exchange nor a shift of numbers leaves the sum as it was."""
    drawn = np.frombuffer(hashlib.shake_128(b"centrode").digest(max(count, 1)), dtype=np.uint8)[:count]
    signs: NDArray[np.float64] = np.where(drawn & 128, -1.0, 1.0)
    return signs * ((drawn & 127) + 128.0) / 256.0


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "surrogateescape")).hexdigest()[:HASH]
