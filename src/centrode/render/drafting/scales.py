"""Scales of drawings: the ratios of GOST 2.302, and round numbers of units that a millimetre stands for."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterator
from dataclasses import dataclass

from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.round_scales import HAIR, round_scale

ENLARGING = (100.0, 50.0, 40.0, 20.0, 10.0, 5.0, 4.0, 2.5, 2.0)
"""GOST 2.302: larger than life; beyond, 100 times a whole number."""
REDUCING = (
    1.0, 2.0, 2.5, 4.0, 5.0, 10.0, 15.0, 20.0, 25.0, 40.0, 50.0, 75.0, 100.0, 200.0, 400.0, 500.0, 800.0, 1000.0,
)  # fmt: skip
"""GOST 2.302: life size and smaller; beyond, 2, 5 and 10 times a power of ten, as plans are drawn."""
DIAGRAM_SCALES = (1.0, 2.0, 2.5, 4.0, 5.0, 10.0)
"""Units that a millimetre of a diagram stands for, times a power of ten."""
RATIO = re.compile(r"\s*(\d+(?:[.,]\d+)?)\s*:\s*(\d+(?:[.,]\d+)?)\s*")


@dataclass(frozen=True)
class DrawingScale:
    """The scale of a drawing: so many millimetres on paper stand for so many in reality."""

    paper: float
    real: float

    @property
    def ratio(self) -> float:
        """Size on paper over size in reality."""
        return self.paper / self.real

    @property
    def text(self) -> str:
        """The scale as a title block has it, with a decimal point: "1:2.5"."""
        return f"{self.paper:g}:{self.real:g}"


def standard_scales() -> Iterator[DrawingScale]:
    """All standard scales, the largest first, without end."""
    for power in range(6, 0, -1):
        for step in (5.0, 2.0, 1.0):
            yield DrawingScale(step * 100.0 * 10.0**power, 1.0)
    yield from (DrawingScale(500.0, 1.0), DrawingScale(200.0, 1.0))
    yield from (DrawingScale(times, 1.0) for times in ENLARGING)
    yield from (DrawingScale(1.0, times) for times in REDUCING)
    for power in itertools.count(3):
        yield from (DrawingScale(1.0, step * 10.0**power) for step in (2.0, 5.0, 10.0))


def largest_standard_scale(fits: float) -> DrawingScale:
    """The largest standard scale that is not greater than a ratio of paper to reality."""
    return next(scale for scale in standard_scales() if scale.ratio <= fits * (1.0 + HAIR))


def diagram_scale(extent: float, room: float) -> float:
    """The finest round number of units to a millimetre at which an extent goes into so many millimetres."""
    return round_scale(extent, room, DIAGRAM_SCALES)


def read_scale(text: str, where: str) -> DrawingScale:
    """A scale such as "1:5" or "2:1".

    Raises
    ------
    InputError
        It is no ratio of two positive numbers, or a ratio beyond a million.
    """
    found = RATIO.fullmatch(text)
    paper, real = (float(part.replace(",", ".")) for part in found.groups()) if found else (0.0, 0.0)
    if not (paper > 0.0 and real > 0.0 and 1e-6 <= paper / real <= 1e6):
        what = _("{text} is not a scale").format(text=f'"{text}"')
        raise InputError(where, what, _("write it as a ratio, such as 1:5 or 2:1"))
    return DrawingScale(paper, real)
