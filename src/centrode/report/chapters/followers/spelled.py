"""Closed forms of a follower's cam in letters, followed by their numbers at one angle: its motion, then its profile."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.geometry import Oscillating
from centrode.render.document.formulas import with_unit
from centrode.report.chapters.followers.spelled_motion import Lines, SpelledMotion

if TYPE_CHECKING:
    pass


NOTHING = 1e-9
"""Share of the base radius below which a radius of curvature is that of a cusp."""


class Spelled(SpelledMotion):
    """The same with the profile: radius of curvature, place, and what its formulas use."""

    def radius(self) -> Lines:
        """The radius of curvature of the profile."""
        value, slope, second = (float(one) for one in self.rows[:3, 0])
        guide, found = self.body.guide, float(self.book.radius(self.rows)[0])
        if not self.book.flat:
            yield from self._bent(found)
        elif not isinstance(guide, Oscillating):
            base = self.length(guide.start)
            worked = f"{base} + {self.length(value)} + {self.length(second)}"
            yield (
                "R",
                "r_0 + s + s''",
                worked,
                self.told(0.0 if abs(found) < NOTHING * guide.start else found),
            )
        else:
            d, pace = self.length(guide.distance), f"(1 {self.sign} psi')"
            waves = [f"{wave} ({self.angle(self.turned)})" for wave in ("sin", "cos")]
            off, shown = (" - f", f" - {self.length(guide.face_offset)}") if guide.face_offset else ("", "")
            letters = (
                f"d sin (psi_0 + psi) (1 - frac(psi'^2, {pace}^2)){off}"
                f" + d cos (psi_0 + psi) frac(psi'', {pace}^3)"
            )
            number = f"(1 {self.sign} {self.ratio(slope)})"
            worked = (
                f"{d} dot.op {waves[0]} dot.op (1 - frac({self.ratio(slope)}^2, {number}^2)){shown}"
                f" + {d} dot.op {waves[1]} dot.op frac({self.numbers.math(second)}, {number}^3)"
            )
            yield "R", letters, worked, self.told(found)

    def _bent(self, found: float) -> Lines:
        """By the curvature of the path of the roller's centre, from its rates in the cam."""
        velocity, acceleration = self.book.rates(self.rows)
        names = ("u_x", "u_y", "w_x", "w_y")
        values = [float(one[0]) for one in (*velocity, *acceleration)]
        units = ("m/rad", "m/rad", "m/rad^2", "m/rad^2")
        for name, letters, value, unit in zip(names, self._rates(), values, units, strict=True):
            yield name, letters, with_unit(self.numbers, value, unit)
        u, v, a, b = (self.length(one) for one in values)
        first, last = ("u_y w_x", "u_x w_y") if self.body.sense > 0 else ("u_x w_y", "u_y w_x")
        front, back = (f"{v} dot.op {a}", f"{u} dot.op {b}")
        front, back = (front, back) if self.body.sense > 0 else (back, front)
        curvature = float(self.book.bending(self.rows)[0])
        worked = f"frac({front} - {back}, ({u}^2 + {v}^2)^(3/2))"
        letters = f"frac({first} - {last}, (u_x^2 + u_y^2)^(3/2))"
        yield "K", letters, worked, with_unit(self.numbers, curvature, "1/m")
        size = self.told(1.0 / curvature if curvature else math.inf)
        if not self.book.roller:
            yield "R", "frac(1, K)", f"frac(1, {self.numbers.math(curvature, '1/m')})", size
            return
        shown = f"{self.length(1.0 / curvature)} - {self.length(self.book.roller)}" if curvature else size
        yield "R", "frac(1, K) - r", shown, self.told(found)

    def _rates(self) -> tuple[str, str, str, str]:
        """Rates of the centre's way in the cam, along the frame's axes, in letters."""
        guide, sign, other = self.body.guide, self.sign, self.other
        minus = "-" if self.body.sense < 0 else ""
        if not isinstance(guide, Oscillating):
            e, minus_e = (f" {other} e", " - e") if guide.offset else ("", "")
            return f"{minus}(y_0 + s)", f"s'{e}", f"{minus}2 s'{minus_e}", "s'' - (y_0 + s)"
        turn = "(psi_0 + psi)"
        return (
            f"l (psi' {sign} 1) sin {turn}",
            f"l (psi' {sign} 1) cos {turn} {other} d",
            f"l psi'' sin {turn} + l (psi' {sign} 1)^2 cos {turn} - d",
            f"l psi'' cos {turn} - l (psi' {sign} 1)^2 sin {turn}",
        )

    def place(self) -> Lines:
        """The profile's point in the cam's axes."""
        x, y = (float(one) for one in self.book.place(np.array([self.phi]), self.rows)[0])
        for name, letters, value in zip(("x", "y"), self._places(), (x, y), strict=True):
            yield name, letters, self.told(value)

    def _places(self) -> tuple[str, str]:
        sign, other, minus = self.sign, self.other, "" if self.body.sense > 0 else "-"
        turns = ("cos phi", "sin phi")
        if self.book.flat and not self.book.swings:
            return (
                f"(r_0 + s) {turns[1]} + s' {turns[0]}"
                if not minus
                else f"-((r_0 + s) {turns[1]} + s' {turns[0]})",
                f"(r_0 + s) {turns[0]} - s' {turns[1]}",
            )
        if self.book.flat:
            return "p sin theta + t cos theta", "p cos theta - t sin theta"
        return f"x_P {turns[0]} {sign} y_P {turns[1]}", f"y_P {turns[0]} {other} x_P {turns[1]}"

    def aids(self) -> Lines:
        """What the profile's formulas use besides the lift: the contact in the frame, or the face's line."""
        guide, sign, other = self.body.guide, self.sign, self.other
        if self.book.flat:
            if isinstance(guide, Oscillating):
                off = " - f" if guide.face_offset else ""
                yield "theta", f"psi_0 + psi {sign} phi"
                yield "p", f"d sin (psi_0 + psi){off}"
                yield "t", f"frac(d psi' cos (psi_0 + psi), psi' {sign} 1)"
            return
        if isinstance(guide, Oscillating):
            centre = "d - l cos (psi_0 + psi)", "l sin (psi_0 + psi)"
        else:
            centre = "e" if guide.offset else "0", "y_0 + s"
        if not self.book.roller:
            yield "x_P", centre[0]
            yield "y_P", centre[1]
            return
        u = "sqrt(u_x^2 + u_y^2)"
        first = f"{sign if centre[0] != '0' or sign == '-' else ''} r frac(u_y, {u})"
        yield "x_P", (f"{centre[0]} {first}" if centre[0] != "0" else first.strip())
        yield "y_P", f"{centre[1]} {other} r frac(u_x, {u})"
