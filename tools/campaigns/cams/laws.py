"""Lifts of followers at many digits: textbook formulas of the rises, polynomials by their conditions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import mpmath

Rise = Callable[[Any], Any]


def cycloidal(u: Any) -> Any:
    """The cycloidal rise."""
    return u - mpmath.sin(2 * mpmath.pi * u) / (2 * mpmath.pi)


def harmonic(u: Any) -> Any:
    """Simple harmonic motion."""
    return (1 - mpmath.cos(mpmath.pi * u)) / 2


def modified_sine(u: Any) -> Any:
    """Modified sine (R. L. Norton, Cam Design and Manufacturing Handbook, 2009, section 3.5)."""
    pi = mpmath.pi
    if u > 0.5:
        return 1 - modified_sine(1 - u)
    if u < mpmath.mpf(1) / 8:
        return (pi * u - mpmath.sin(4 * pi * u) / 4) / (4 + pi)
    return (2 + pi * u - mpmath.mpf(9) / 4 * mpmath.sin(pi / 3 + 4 * pi * u / 3)) / (4 + pi)


def modified_trapezoid(u: Any) -> Any:
    """Modified trapezoid (the same, section 3.4): its acceleration integrated twice by hand."""
    pi = mpmath.pi
    if u > 0.5:
        return 1 - modified_trapezoid(1 - u)
    eighth, peak = mpmath.mpf(1) / 8, 8 * pi / (2 + pi)

    def quarter_wave(v: Any) -> tuple[Any, Any]:
        """Value and speed where the acceleration is peak sin(4 pi v)."""
        k = 4 * pi
        return peak * (v / k - mpmath.sin(k * v) / k**2), peak * (1 - mpmath.cos(k * v)) / k

    if u <= eighth:
        return quarter_wave(u)[0]
    value, speed = quarter_wave(eighth)
    w = min(u, 3 * eighth) - eighth
    value, speed = value + speed * w + peak * w**2 / 2, speed + peak * w
    if u <= 3 * eighth:
        return value
    w, k = u - 3 * eighth, 4 * pi
    return value + speed * w + peak * (1 - mpmath.cos(k * w)) / k**2


def parabolic(u: Any) -> Any:
    """Constant acceleration 4 up to the middle, as much retardation behind it."""
    return 2 * u**2 if u <= 0.5 else 1 - 2 * (1 - u) ** 2


def trapezoid(u: Any) -> Any:
    """Acceleration that grows evenly up to an eighth, stays up to three and falls up to the middle.

    It is the sum of three accelerations that grow evenly from 0, 1/8 and 3/8, the later two against the first.
    """
    if u > 0.5:
        return 1 - trapezoid(1 - u)
    eighth, peak = mpmath.mpf(1) / 8, mpmath.mpf(16) / 3

    def ramp(since: Any) -> Any:
        """The way by an acceleration that grows by 8 peak in a unit, since so long."""
        return 8 * peak * since**3 / 6 if since > 0 else mpmath.mpf(0)

    return ramp(u) - ramp(u - eighth) - ramp(u - 3 * eighth)


RISES: dict[str, Rise] = {
    "uniform": lambda u: u,
    "parabolic": parabolic,
    "trapezoid": trapezoid,
    "harmonic": harmonic,
    "cycloidal": cycloidal,
    "3-4-5": lambda u: u**3 * (10 - 15 * u + 6 * u**2),
    "4-5-6-7": lambda u: u**4 * (35 - 84 * u + 70 * u**2 - 20 * u**3),
    "modified sine": modified_sine,
    "modified trapezoid": modified_trapezoid,
}


@dataclass(frozen=True)
class Segment:
    """A segment of a turn: its angle, the lift at its ends, its curve; a polynomial has derivatives and points too."""

    angle: float
    begin: float
    end: float
    curve: str
    at_start: Sequence[float] = ()
    at_end: Sequence[float] = ()
    through: Sequence[tuple[float, float]] = ()
    coefficients: list[Any] = field(default_factory=list)

    def value(self, x: Any) -> Any:
        """The lift at an angle from the segment's start."""
        if self.curve == "dwell":
            return mpmath.mpf(self.begin)
        if self.curve == "polynomial":
            if not self.coefficients:
                self.coefficients.extend(self._solved())
            return mpmath.polyval(self.coefficients[::-1], x / mpmath.mpf(self.angle))
        begin, end = mpmath.mpf(self.begin), mpmath.mpf(self.end)
        return begin + (end - begin) * RISES[self.curve](x / mpmath.mpf(self.angle))

    def _solved(self) -> list[Any]:
        """Coefficients by powers of the share of the angle, from all conditions."""
        beta = mpmath.mpf(self.angle)
        conditions = [
            (mpmath.mpf(0), k, mpmath.mpf(v) * beta**k) for k, v in enumerate((self.begin, *self.at_start))
        ]
        conditions += [
            (mpmath.mpf(1), k, mpmath.mpf(v) * beta**k) for k, v in enumerate((self.end, *self.at_end))
        ]
        conditions += [(mpmath.mpf(x) / beta, 0, mpmath.mpf(v)) for x, v in self.through]
        count = len(conditions)
        rows = mpmath.matrix(count, count)
        for row, (u, k, _value) in enumerate(conditions):
            for power in range(k, count):
                rows[row, power] = mpmath.ff(power, k) * u ** (power - k)
        return list(mpmath.lu_solve(rows, mpmath.matrix([value for *_at, value in conditions])))


@dataclass(frozen=True)
class Lift:
    """The lift over a turn."""

    segments: tuple[Segment, ...]

    def segment_at(self, phi: float) -> tuple[Any, Segment]:
        """The segment in which an angle lies, and where it begins."""
        begun = mpmath.mpf(0)
        for segment in self.segments:
            if phi < begun + mpmath.mpf(segment.angle):
                return begun, segment
            begun += mpmath.mpf(segment.angle)
        return begun - mpmath.mpf(segment.angle), segment
