"""Closed forms of a follower's cam in letters, followed by their numbers at one angle: its motion, then its profile."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from centrode.cams.followers.geometry import Face, Oscillating
from centrode.render.document.formulas import factor, with_unit

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam
    from centrode.render.document.numbers import Numbers

# Closed forms of pressure angle, curvature and profile, each as a textbook has it.
#
# They share nothing with `FollowerCam.contact`, which differentiates envelopes, and so prove it.

Array = NDArray[np.float64]


class Textbook:
    """Closed forms for one cam; rows (3 or more, n) are the lift with its derivatives."""

    def __init__(self, body: FollowerCam) -> None:
        self.body = body
        self.flat = isinstance(body.touch, Face)
        self.swings = isinstance(body.guide, Oscillating)
        self.sense = body.sense
        self.roller = 0.0 if self.flat else body.touch.roller

    @property
    def has_pressure_angle(self) -> bool:
        """Whether it is not zero whatever the cam."""
        return self.swings or not self.flat

    def pressure(self, rows: Array) -> Array:
        """Tangent of the pressure angle (n)."""
        guide, sense = self.body.guide, self.sense
        if not isinstance(guide, Oscillating):
            if self.flat:
                return np.zeros(rows.shape[1])
            return np.asarray((rows[1] - sense * guide.offset) / (guide.start + rows[0]))
        turn = guide.start + rows[0]
        if self.flat:
            below = guide.distance * np.cos(turn)
            return np.asarray(-sense * guide.face_offset * (1.0 + sense * rows[1]) / below)
        above = guide.arm * (rows[1] + sense) - sense * guide.distance * np.cos(turn)
        return np.asarray(above / (guide.distance * np.sin(turn)))

    def radius(self, rows: Array) -> Array:
        """Radius of curvature [m] of the profile (n)."""
        guide, sense = self.body.guide, self.sense
        if not self.flat:
            return np.asarray(1.0 / self.bending(rows) - self.roller)
        if not isinstance(guide, Oscillating):
            return np.asarray(guide.start + rows[0] + rows[2])
        turn, pace = guide.start + rows[0], 1.0 + sense * rows[1]
        straight = guide.distance * np.sin(turn) * (1.0 - (rows[1] / pace) ** 2) - guide.face_offset
        return np.asarray(straight + guide.distance * np.cos(turn) * rows[2] / pace**3)

    def bending(self, rows: Array) -> Array:
        """Curvature [1/m] of the path of the roller's centre in the cam (n)."""
        (x, y), (across, up) = self.rates(rows)
        return np.asarray(self.sense * (y * across - x * up) / (x**2 + y**2) ** 1.5)

    def rates(self, rows: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """First and second derivative of the centre's way in the cam, along the frame's axes."""
        guide, sense = self.body.guide, self.sense
        nothing = np.zeros(rows.shape[1])
        if isinstance(guide, Oscillating):
            turn = guide.start + rows[0]
            sine, cosine, arm = np.sin(turn), np.cos(turn), guide.arm
            place = guide.distance - arm * cosine, arm * sine
            first = arm * rows[1] * sine, arm * rows[1] * cosine
            second = (
                arm * (rows[2] * sine + rows[1] ** 2 * cosine),
                arm * (rows[2] * cosine - rows[1] ** 2 * sine),
            )
        else:
            place = nothing + guide.offset, guide.start + rows[0]
            first, second = (nothing, rows[1]), (nothing, rows[2])
        velocity = first[0] + sense * place[1], first[1] - sense * place[0]
        acceleration = (
            second[0] + 2.0 * sense * first[1] - place[0],
            second[1] - 2.0 * sense * first[0] - place[1],
        )
        return velocity, acceleration

    def place(self, phi: Array, rows: Array) -> Array:
        """The profile (n, 2) [m] in the cam's axes."""
        guide, sense = self.body.guide, self.sense
        sine, cosine = np.sin(phi), np.cos(phi)
        if self.flat and not isinstance(guide, Oscillating):
            height = guide.start + rows[0]
            return np.stack(
                [sense * (height * sine + rows[1] * cosine), height * cosine - rows[1] * sine], axis=-1
            )
        if isinstance(guide, Oscillating) and self.flat:
            turn = guide.start + rows[0]
            omega = turn + sense * phi
            apart = guide.distance * np.sin(turn) - guide.face_offset
            foot = guide.distance * np.cos(turn) * sense * rows[1] / (1.0 + sense * rows[1])
            return np.stack(
                [apart * np.sin(omega) + foot * np.cos(omega), apart * np.cos(omega) - foot * np.sin(omega)],
                axis=-1,
            )
        (u, v), _second = self.rates(rows)
        length = np.hypot(u, v)
        x, y = self._centre(rows)
        # outward normal in the frame's axes: the way turned by a quarter
        x, y = x + sense * self.roller * v / length, y - sense * self.roller * u / length
        return np.stack([x * cosine + sense * y * sine, y * cosine - sense * x * sine], axis=-1)

    def _centre(self, rows: Array) -> tuple[Array, Array]:
        guide = self.body.guide
        if isinstance(guide, Oscillating):
            turn = guide.start + rows[0]
            return guide.distance - guide.arm * np.cos(turn), guide.arm * np.sin(turn)
        return np.zeros(rows.shape[1]) + guide.offset, guide.start + rows[0]


# Start, lift and pressure angle of a follower in letters, followed by their numbers at one angle.

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
