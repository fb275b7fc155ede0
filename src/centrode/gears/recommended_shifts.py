"""Shifts that GOST 16532-70 recommends for spur external pairs of its reference rack.

Two public programs that follow the standard agree on the values. The bounds of the numbers of teeth are those which
textbooks restate; they were not compared with the printed standard.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from centrode.errors import InputError
from centrode.locale import _, mark
from centrode.model.gear_pairs import Application

DistanceUse = Literal["free", "unshifted", "shifted"]
"""The centre distance: not given, that of a pair without shifts, or another."""
SAME_SUM = 1e-9
"""Sums of shifts nearer than this are one: a distance with its unit and the involutes behind the sum are rounded."""


@dataclass(frozen=True)
class RecommendedRow:
    """A row of the recommendation: which pairs it is for, and their shifts.

    Attributes
    ----------
    application : what the pair is for
    distances : the centre distances it is for
    first : x_1; None where it is the whole sum
    second : x_2; None where it is what x_1 leaves of the sum
    sums : of the shifts where they follow from the distance, the first one excluded
    pinion : least and greatest z_1
    least_wheel : least z_2
    least_ratio : least z_2/z_1
    """

    application: Application
    distances: tuple[DistanceUse, ...]
    first: float | None
    second: float | None
    sums: tuple[float, float] = (0.0, 0.0)
    pinion: tuple[int, float] = (0, math.inf)
    least_wheel: int = 0
    least_ratio: float = 0.0

    def covers(self, teeth: tuple[float, float]) -> bool:
        """Whether these numbers of teeth lie within the row."""
        first, second = teeth
        least, most = self.pinion
        # z_2 >= u z_1: a quotient would round, this does not with u = 3.5
        return least <= first <= most and second >= max(self.least_wheel, self.least_ratio * first)

    def shifts(self, total: float) -> tuple[float, float]:
        """x_1 and x_2, where the row is for the sum `total`."""
        first = total if self.first is None else self.first
        return first, total - first if self.second is None else self.second


ROWS = (
    RecommendedRow("power", ("shifted",), None, 0.0, sums=(0.0, 0.5)),
    RecommendedRow("power", ("shifted",), 0.5, None, sums=(0.5, 1.0)),
    RecommendedRow("power", ("unshifted",), 0.0, 0.0, pinion=(21, math.inf)),
    RecommendedRow("power", ("unshifted",), 0.3, -0.3, pinion=(14, 20), least_ratio=3.5),
    RecommendedRow("power", ("free",), 0.5, 0.5, pinion=(10, 30)),
    RecommendedRow("power", ("free",), 0.0, 0.0, pinion=(31, math.inf)),
    RecommendedRow("kinematic", ("shifted",), None, 0.0, sums=(0.0, 1.0)),
    RecommendedRow("kinematic", ("unshifted", "free"), 0.0, 0.0, pinion=(17, math.inf)),
    RecommendedRow("kinematic", ("unshifted", "free"), 0.3, -0.3, pinion=(12, 16), least_wheel=22),
)
"""The recommendation; no two of its rows are for one pair."""


_NO_ROW: Mapping[tuple[Application, DistanceUse], str] = {
    ("power", "free"): mark(
        "GOST 16532 recommends no shifts of a power transmission with {first:g} and {second:g} teeth"
    ),
    ("power", "unshifted"): mark(
        "GOST 16532 recommends no shifts of a power transmission with {first:g} and {second:g} teeth at the centre"
        " distance without shifts"
    ),
    ("kinematic", "free"): mark(
        "GOST 16532 recommends no shifts of a kinematic transmission with {first:g} and {second:g} teeth"
    ),
    ("kinematic", "unshifted"): mark(
        "GOST 16532 recommends no shifts of a kinematic transmission with {first:g} and {second:g} teeth at the centre"
        " distance without shifts"
    ),
}


def distance_use(total: float | None) -> DistanceUse:
    """What a sum of shifts says of the centre distance; None where no distance is given."""
    if total is None:
        return "free"
    return "unshifted" if abs(total) <= SAME_SUM else "shifted"


def recommended_row(
    teeth: tuple[float, float], application: Application, total: float | None
) -> RecommendedRow:
    """The row for a pair.

    Parameters
    ----------
    teeth : z_1 and z_2, the pinion first
    application : what the pair is for
    total : x_1 + x_2 of a given centre distance; None where the distance is free

    Raises
    ------
    InputError
        The recommendation says nothing of such a pair.
    """
    use = distance_use(total)
    rows = [row for row in ROWS if row.application == application and use in row.distances]
    if total is not None and use == "shifted":
        for row in rows:
            above, most = row.sums
            if above < total <= most + SAME_SUM:
                return row
        what = _(
            "GOST 16532 recommends shifts for sums from 0 to 1, at this centre distance it is {total:.6g}"
        )
        raise InputError("centre_distance", what.format(total=total), _advice())
    for row in rows:
        if row.covers(teeth):
            return row
    raise InputError("teeth", _(_NO_ROW[application, use]).format(first=teeth[0], second=teeth[1]), _advice())


def _advice() -> str:
    return _("give [x1, x2] from the blocking contour, or another purpose")
