"""Start, lift and pressure angle of a follower in letters, followed by their numbers at one angle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.geometry import Oscillating
from centrode.render.document.formulas import factor, with_unit
from centrode.report.chapters.followers.textbook import Array, Textbook

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.render.document.numbers import Numbers

Lines = Iterator[tuple[str, ...]]


ROUNDING = 1e-12
"""Share of its greatest size below which a derivative is rounding."""


def _clean(rows: Array, body: FollowerCam) -> Array:
    """Lift and derivatives without what rounding has left of zero."""
    sizes = np.abs(body.motion.lift(np.linspace(0.0, math.tau, 361), len(rows) - 1)).max(axis=1)
    return np.where(np.abs(rows) <= ROUNDING * sizes[:, None], 0.0, rows)


class SpelledMotion:
    """Formulas of one cam, with numbers at an angle [rad]; lengths in the unit of the display, psi in radians."""

    def __init__(self, body: FollowerCam, numbers: Numbers, phi: float) -> None:
        self.body, self.numbers, self.phi = body, numbers, phi
        self.book = Textbook(body)
        self.rows = _clean(body.motion.lift(np.array([phi]), 3), body)
        self.turned = body.guide.start + float(self.rows[0, 0])
        self.sign, self.other = ("+", "-") if body.sense > 0 else ("-", "+")

    def length(self, value: float) -> str:
        """In a sum or a product."""
        return factor(self.numbers, value, "m")

    def told(self, value: float) -> str:
        """A length with its unit."""
        return with_unit(self.numbers, value, "m")

    def ratio(self, value: float) -> str:
        return factor(self.numbers, value)

    def angle(self, value: float) -> str:
        """In degrees, in a function."""
        return f"{self.ratio(math.degrees(value))} degree"

    def start(self) -> Lines:
        """Where the follower stands at lift 0."""
        guide, base, roller = self.body.guide, self.body.base_radius, self.book.roller
        path, shown = (
            ("r_0 + r", f"{self.length(base)} + {self.length(roller)}")
            if roller
            else ("r_0", self.length(base))
        )
        bracket, number = (f"({path})", f"({shown})") if roller else (path, shown)
        if not isinstance(guide, Oscillating):
            if self.book.flat:
                return
            if not guide.offset:
                yield "y_0", path, *((shown,) if roller else ()), self.told(guide.start)
                return
            worked = f"sqrt({number}^2 - {self.length(guide.offset)}^2)"
            yield "y_0", f"sqrt({bracket}^2 - e^2)", worked, self.told(guide.start)
            return
        start = f"{self.numbers.math(math.degrees(guide.start))} degree"
        if self.book.flat:
            letters = "arcsin (frac(r_0 + f, d))" if guide.face_offset else "arcsin (frac(r_0, d))"
            above = self.length(base) + (f" + {self.length(guide.face_offset)}" if guide.face_offset else "")
            yield "psi_0", letters, f"arcsin (frac({above}, {self.length(guide.distance)}))", start
            return
        d, arm = self.length(guide.distance), self.length(guide.arm)
        worked = f"arccos (frac({d}^2 + {arm}^2 - {number}^2, 2 dot.op {d} dot.op {arm}))"
        yield "psi_0", f"arccos (frac(d^2 + l^2 - {bracket}^2, 2 d l))", worked, start

    def lift(self) -> Lines:
        """The lift with its first derivatives at the angle."""
        value, slope, second = (float(one) for one in self.rows[:3, 0])
        yield "phi", f"{self.numbers.math(math.degrees(self.phi))} degree"
        if self.book.swings:
            yield (
                "psi",
                f'{self.numbers.math(value)} thin "rad"',
                f"{self.numbers.math(math.degrees(value))} degree",
            )
            yield "psi'", self.numbers.math(slope)
            yield "psi''", self.numbers.math(second)
            return
        yield "s", self.told(value)
        yield "s'", with_unit(self.numbers, slope, "m/rad")
        yield "s''", with_unit(self.numbers, second, "m/rad^2")

    def pressure(self) -> Lines:
        """The pressure angle; nothing where it is none."""
        guide, value, slope = self.body.guide, float(self.rows[0, 0]), float(self.rows[1, 0])
        if not self.book.has_pressure_angle:
            return
        tangent = float(self.book.pressure(self.rows)[0])
        end = self.numbers.math(tangent)
        if not isinstance(guide, Oscillating):
            offset = f" {self.other} e" if guide.offset else ""
            shown = f" {self.other} {self.length(guide.offset)}" if guide.offset else ""
            worked = f"frac({self.length(slope)}{shown}, {self.length(guide.start)} + {self.length(value)})"
            yield "tan alpha", f"frac(s'{offset}, y_0 + s)", worked, end
        elif self.book.flat:
            q = self.foot()
            yield "q", f"frac(d cos (psi_0 + psi), 1 {self.sign} psi')", self._foot(), self.told(q)
            worked = f"{self._flipped()}frac({self.length(guide.face_offset)}, {self.length(q)})"
            yield "tan alpha", f"{self._flipped()}frac(f, q)", worked, end
        else:
            cosine, sine = (f"{wave} ({self.angle(self.turned)})" for wave in ("cos", "sin"))
            d, arm = self.length(guide.distance), self.length(guide.arm)
            above = (
                f"{arm} dot.op ({self.numbers.math(slope)} {self.sign} 1) {self.other} {d} dot.op {cosine}"
            )
            letters = f"frac(l (psi' {self.sign} 1) {self.other} d cos (psi_0 + psi), d sin (psi_0 + psi))"
            yield "tan alpha", letters, f"frac({above}, {d} dot.op {sine})", end
        yield "alpha", f"arctan ({end})", f"{self.numbers.math(math.degrees(math.atan(tangent)))} degree"

    def _flipped(self) -> str:
        return "-" if self.body.sense > 0 else ""

    def foot(self) -> float:
        """Place of contact along a swinging face [m], from the foot of the pivot."""
        guide = self.body.guide
        assert isinstance(guide, Oscillating)
        return guide.distance * math.cos(self.turned) / (1.0 + self.body.sense * float(self.rows[1, 0]))

    def _foot(self) -> str:
        guide = self.body.guide
        assert isinstance(guide, Oscillating)
        above = f"{self.length(guide.distance)} dot.op cos ({self.angle(self.turned)})"
        return f"frac({above}, 1 {self.sign} {self.ratio(float(self.rows[1, 0]))})"
