"""Standard tolerances on linear sizes: ISO 286-1:2010, Table 1 (grades IT1 to IT18, sizes up to 3150 mm).

The grades are the values of the table itself: the standard rounds its formulas (Annex A: i = 0.45 D^(1/3) + 0.001 D up
to 500 mm, I = 0.004 D + 2.1 beyond, with D the geometric mean of the step in millimetres), so they do not give them.
"""

from __future__ import annotations

import re
from typing import NamedTuple

from centrode.errors import InputError
from centrode.locale import _

GRADES = 18
"""IT1 to IT18."""
LARGEST_SIZE = 3.15
"""Size [m] at which the table ends."""

STEPS = (
    3, 6, 10, 18, 30, 50, 80, 120, 180, 250, 315, 400, 500, 630, 800, 1000, 1250, 1600, 2000, 2500, 3150
)  # fmt: skip
"""Upper ends [mm] of the steps of nominal size, each included in its step."""

_MICROMETRES = (
    (0.8, 1.2, 2, 3, 4, 6, 10, 14, 25, 40, 60, 100, 140, 250, 400, 600, 1000, 1400),
    (1, 1.5, 2.5, 4, 5, 8, 12, 18, 30, 48, 75, 120, 180, 300, 480, 750, 1200, 1800),
    (1, 1.5, 2.5, 4, 6, 9, 15, 22, 36, 58, 90, 150, 220, 360, 580, 900, 1500, 2200),
    (1.2, 2, 3, 5, 8, 11, 18, 27, 43, 70, 110, 180, 270, 430, 700, 1100, 1800, 2700),
    (1.5, 2.5, 4, 6, 9, 13, 21, 33, 52, 84, 130, 210, 330, 520, 840, 1300, 2100, 3300),
    (1.5, 2.5, 4, 7, 11, 16, 25, 39, 62, 100, 160, 250, 390, 620, 1000, 1600, 2500, 3900),
    (2, 3, 5, 8, 13, 19, 30, 46, 74, 120, 190, 300, 460, 740, 1200, 1900, 3000, 4600),
    (2.5, 4, 6, 10, 15, 22, 35, 54, 87, 140, 220, 350, 540, 870, 1400, 2200, 3500, 5400),
    (3.5, 5, 8, 12, 18, 25, 40, 63, 100, 160, 250, 400, 630, 1000, 1600, 2500, 4000, 6300),
    (4.5, 7, 10, 14, 20, 29, 46, 72, 115, 185, 290, 460, 720, 1150, 1850, 2900, 4600, 7200),
    (6, 8, 12, 16, 23, 32, 52, 81, 130, 210, 320, 520, 810, 1300, 2100, 3200, 5200, 8100),
    (7, 9, 13, 18, 25, 36, 57, 89, 140, 230, 360, 570, 890, 1400, 2300, 3600, 5700, 8900),
    (8, 10, 15, 20, 27, 40, 63, 97, 155, 250, 400, 630, 970, 1550, 2500, 4000, 6300, 9700),
    (9, 11, 16, 22, 32, 44, 70, 110, 175, 280, 440, 700, 1100, 1750, 2800, 4400, 7000, 11000),
    (10, 13, 18, 25, 36, 50, 80, 125, 200, 320, 500, 800, 1250, 2000, 3200, 5000, 8000, 12500),
    (11, 15, 21, 28, 40, 56, 90, 140, 230, 360, 560, 900, 1400, 2300, 3600, 5600, 9000, 14000),
    (13, 18, 24, 33, 47, 66, 105, 165, 260, 420, 660, 1050, 1650, 2600, 4200, 6600, 10500, 16500),
    (15, 21, 29, 39, 55, 78, 125, 195, 310, 500, 780, 1250, 1950, 3100, 5000, 7800, 12500, 19500),
    (18, 25, 35, 46, 65, 92, 150, 230, 370, 600, 920, 1500, 2300, 3700, 6000, 9200, 15000, 23000),
    (22, 30, 41, 55, 78, 110, 175, 280, 440, 700, 1100, 1750, 2800, 4400, 7000, 11000, 17500, 28000),
    (26, 36, 50, 68, 96, 135, 210, 330, 540, 860, 1350, 2100, 3300, 5400, 8600, 13500, 21000, 33000),
)
"""Tolerances [um] by step and grade."""

_CLASS = re.compile(r"(IT|H|h|JS|js)\s*(\d{1,2})")
POSITIONS = ("IT", "H", "h", "JS", "js")
"""Positions of the tolerance interval: those whose fundamental deviation is zero, or that lie evenly about it."""


class ToleranceClass(NamedTuple):
    """Where the interval of a tolerance lies, and its grade: H 7."""

    position: str
    grade: int

    def __str__(self) -> str:
        return f"{self.position}{self.grade}"

    def deviations(self, size: float) -> tuple[float, float]:
        """Lower and upper deviation [m] of a size [m]: from H up, from h down, IT and js half to each side.

        Raises InputError for a size beyond the table, without a place.
        """
        width = standard_tolerance(size, self.grade)
        if self.position == "H":
            return 0.0, width
        return (-width, 0.0) if self.position == "h" else (-width / 2, width / 2)


def looks_like_class(text: str) -> bool:
    """Whether a text is letters and a number behind them, as H7: perhaps a class that there is not."""
    return re.fullmatch(r"[A-Za-z]{1,2}\s*\d{1,2}", text.strip()) is not None


def tolerance_class(text: str) -> ToleranceClass:
    """The class that a text names ("IT7", "H7", "h7", "js9"); raises InputError for another, without a place."""
    match = _CLASS.fullmatch(text.strip())
    if match is None:
        what = _("the tolerance class {name} is not known").format(name=f'"{text.strip()}"')
        raise InputError(
            "", what, _('write IT, H, h or js with its grade, as "IT7", or limits: ["-0.1 mm", 0]')
        )
    grade = int(match[2])
    if not 1 <= grade <= GRADES:
        what = _("there is no grade {grade}").format(grade=f"IT{grade}")
        raise InputError("", what, _("grades are IT1 to IT{most}").format(most=GRADES))
    return ToleranceClass(match[1], grade)


def standard_tolerance(size: float, grade: int) -> float:
    """Tolerance [m] of a grade at a nominal size [m].

    Raises InputError beyond 3150 mm, and for a size that is not positive. Source: ISO 286-1:2010, Table 1. Of sizes up
    to 1 mm the standard gives no grades from IT14 on; the first step is taken for them too.

    Examples
    --------
    >>> from centrode.model.limits_and_fits import standard_tolerance
    >>> standard_tolerance(0.040, 7)
    2.5e-05
    """
    # a size given in millimetres may have been rounded on its way to metres: 0.003 has to be in the first step
    millimetres = round(size * 1e3, 9)
    if not 0.0 < millimetres <= STEPS[-1]:
        what = _("standard grades end at {most} mm, and this size is {size:g} mm")
        raise InputError(
            "",
            what.format(most=STEPS[-1], size=millimetres),
            _('give the limits: "±0.5 mm", or ["-0.5 mm", "0.5 mm"]'),
        )
    step = next(k for k, end in enumerate(STEPS) if millimetres <= end)
    return round(_MICROMETRES[step][grade - 1] * 1e-6, 12)


def widest_grade(size: float, width: float) -> int | None:
    """The greatest grade whose tolerance at a size [m] is not more than a width [m]; None where even IT1 is wider.

    Raises InputError as `standard_tolerance` does.
    """
    fitting = [grade for grade in range(1, GRADES + 1) if standard_tolerance(size, grade) <= width]
    return fitting[-1] if fitting else None
