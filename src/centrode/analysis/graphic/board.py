"""A drawing board: how finely directions and lengths are read, where lines meet, which scales a person takes.

Vectors are complex numbers, x + i y. Turning by a quarter is multiplying by i.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import dataclass

from centrode.errors import InputError, MotionError
from centrode.locale import _

PARALLEL = 1e-12
"""Lines whose sine is smaller count as parallel: rounding of directions makes some 1e-16, a dead point 1e-8."""
ROUND = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
"""Scales that a person takes, times a power of ten."""
COARSEST_ANGLE, COARSEST_LENGTH = math.pi / 6, 0.01
"""Reading steps [rad] and [m on paper] above which nothing is told."""


@dataclass(frozen=True)
class Board:
    """Reading steps of angles [rad] and of lengths on paper [m]; None reads exactly.

    `length_step` is what the step on paper is in the mechanism [m], once its scale is chosen.
    """

    angle_step: float | None = None
    paper_step: float | None = None
    length_step: float | None = None

    def __post_init__(self) -> None:
        if self.angle_step is not None and not 0.0 < self.angle_step <= COARSEST_ANGLE:
            raise InputError(
                "angle_step",
                _("a reading step of {step:g} rad is none").format(step=self.angle_step),
                _("give one above 0 and at most 30 deg"),
            )
        if self.paper_step is not None and not 0.0 < self.paper_step <= COARSEST_LENGTH:
            raise InputError(
                "length_step",
                _("a reading step of {step:g} m is none").format(step=self.paper_step),
                _("give one above 0 and at most 10 mm on paper"),
            )

    def angle(self, angle: float) -> float:
        """An angle [rad] as it is read."""
        return angle if self.angle_step is None else self.angle_step * round(angle / self.angle_step)

    def direction(self, vector: complex) -> complex:
        """Unit vector along a vector, its angle as it is read."""
        if self.angle_step is None:
            return vector / abs(vector)
        return cmath.rect(1.0, self.angle(cmath.phase(vector)))

    def arm(self, vector: complex, known: bool = False) -> complex:
        """A distance in the drawing as it is read; the length of one between two points of a link is `known`."""
        if vector == 0:
            return 0j
        length = abs(vector)
        if self.length_step is not None and not known:
            length = self.length_step * round(length / self.length_step)
        return (
            vector if self.angle_step is None and length == abs(vector) else length * self.direction(vector)
        )


def meet(first: complex, along: complex, second: complex, other: complex) -> complex:
    """Where a line through `first` along a unit vector meets one through `second`; MotionError if they do not."""
    sine = cross(along, other)
    if abs(sine) < PARALLEL:
        raise MotionError(
            "",
            _("two lines of the construction are parallel: the group stands at a dead point"),
            _("choose another instant, or a finer reading step"),
        )
    return first + cross(second - first, other) / sine * along


def cross(a: complex, b: complex) -> float:
    """Sine of the angle from a to b, times both lengths."""
    return (a.conjugate() * b).imag


def dot(a: complex, b: complex) -> float:
    """Cosine of the angle between a and b, times both lengths."""
    return (a.conjugate() * b).real


def round_scale(extent: float, room: float) -> float:
    """The finest round scale at which an extent goes into a room: of [SI] and [mm] in SI a millimetre."""
    if not extent > 0.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(extent / room))
    return next(float(f"{step * power:.3g}") for step in ROUND if step * power >= (1 - 1e-9) * extent / room)


def extent_of(places: Iterable[complex]) -> float:
    """The longer side of the box around places."""
    places = list(places)
    across, up = [place.real for place in places], [place.imag for place in places]
    return max(max(across) - min(across), max(up) - min(up))
