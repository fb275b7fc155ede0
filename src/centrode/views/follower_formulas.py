"""Closed forms of a follower's cam in letters, followed by their numbers at one angle."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.closed_forms import ClosedForms, clear_lift
from centrode.cams.followers.geometry import Oscillating
from centrode.sheets.texts import Expression, Factor, Leaf, Number
from centrode.views.followers import letter_of, rate
from centrode.views.formulas import relation

if TYPE_CHECKING:
    from centrode.cams.followers.geometry import FollowerCam

Lines = Iterator[tuple[Leaf, ...]]
CUSP = 1e-9
"""Share of the base radius below which a radius of curvature is that of a cusp."""
TURNED = "psi_0 + psi"
"""The angle of an oscillating follower."""


def in_degrees(angle: float) -> Expression:
    """An angle [rad] as formulas have it."""
    return Expression("{angle} degree", angle=Number(math.degrees(angle)))


def length(value: float) -> Number:
    """A length [m] with its unit."""
    return Number(value, "m")


class FollowerFormulas:
    """Formulas of one cam with numbers at an angle [rad]; lengths are in the unit of the display, psi in radians.

    Every line has a left side, what it is in letters where it has any, the same with numbers, and the result.
    """

    def __init__(self, body: FollowerCam, phi: float) -> None:
        self.body, self.phi = body, phi
        self.forms = ClosedForms(body)
        self.rows = clear_lift(body.motion, np.array([phi]), 3)
        self.value, self.slope, self.second = (float(one) for one in self.rows[:3, 0])
        self.turned = body.guide.start + self.value
        # of a cam that turns clockwise some signs are the other ones
        self.sign, self.other = ("+", "-") if body.sense > 0 else ("-", "+")
        swings = self.forms.swings
        self.letters = {"s": letter_of(swings), "slope": rate(swings, 1), "second": rate(swings, 2)}
        self.letters |= {"turned": TURNED, "pace": f"(1 {self.sign} {rate(swings, 1)})"}

    def start(self) -> Lines:
        """Where the follower stands at lift zero."""
        guide, values = self.body.guide, self._sizes()
        path = "{r_0} + {r}" if self.forms.roller else "{r_0}"
        bracket = f"({path})" if self.forms.roller else path
        if isinstance(guide, Oscillating):
            notation = f"arccos (frac({{d}}^2 + {{l}}^2 - {bracket}^2, 2 * {{d}} * {{l}}))"
            if self.forms.flat:
                above = "{r_0} + {f}" if guide.face_offset else "{r_0}"
                notation = f"arcsin (frac({above}, {{d}}))"
            yield self._line("psi_0", notation, in_degrees(guide.start), values)
        elif guide.offset and not self.forms.flat:
            yield self._line("y_0", f"sqrt({bracket}^2 - {{e}}^2)", length(guide.start), values)
        elif self.forms.roller:
            yield self._line("y_0", path, length(guide.start), values)
        elif not self.forms.flat:
            yield "y_0", "r_0", length(guide.start)

    def lift(self) -> Lines:
        """The lift with its first derivatives at the angle."""
        letter = self.letters["s"]
        yield "phi", in_degrees(self.phi)
        if self.forms.swings:
            yield letter, Number(self.value, "rad", unit_fixed=True), in_degrees(self.value)
            yield f"{letter}'", Number(self.slope)
            yield f"{letter}''", Number(self.second)
        else:
            yield letter, length(self.value)
            yield f"{letter}'", Number(self.slope, "m/rad")
            yield f"{letter}''", Number(self.second, "m/rad^2")

    def pressure(self) -> Lines:
        """The pressure angle; nothing where there is none."""
        guide, values = self.body.guide, self._sizes()
        if not self.forms.has_pressure_angle:
            return
        tangent = float(self.forms.pressure(self.rows)[0])
        values |= {"slope": Factor(length(self.slope)), "s": Factor(length(self.value))}
        if not isinstance(guide, Oscillating):
            offset = f" {self.other} {{e}}" if guide.offset else ""
            notation = f"frac({{slope}}{offset}, {{y_0}} + {{s}})"
        elif self.forms.flat:
            place = guide.distance * math.cos(self.turned) / (1.0 + self.body.sense * self.slope)
            ratio = {**values, "slope": Factor(Number(self.slope))}
            yield self._line(
                "q", f"frac({{d}} * cos ({{turned}}), 1 {self.sign} {{slope}})", length(place), ratio
            )
            values["q"] = Factor(length(place))
            notation = f"{'-' if self.body.sense > 0 else ''}frac({{f}}, {{q}})"
        else:
            values["slope"] = Number(self.slope)
            above = f"{{l}} * ({{slope}} {self.sign} 1) {self.other} {{d}} * cos ({{turned}})"
            notation = f"frac({above}, {{d}} * sin ({{turned}}))"
        yield self._line("tan alpha", notation, Number(tangent), values)
        yield (
            "alpha",
            Expression("arctan ({tangent})", tangent=Number(tangent)),
            in_degrees(math.atan(tangent)),
        )

    def radius(self) -> Lines:
        """The radius of curvature of the profile."""
        guide, radius = self.body.guide, float(self.forms.radius(self.rows)[0])
        if not self.forms.flat:
            yield from self._bent(radius)
        elif not isinstance(guide, Oscillating):
            terms: dict[str, Leaf] = {"s": Factor(length(self.value)), "second": Factor(length(self.second))}
            radius = 0.0 if abs(radius) < CUSP * guide.start else radius
            yield self._line("R", "{r_0} + {s} + {second}", length(radius), self._sizes() | terms)
        else:
            offset = " - {f}" if guide.face_offset else ""
            slope = Factor(Number(self.slope))
            rates: dict[str, Leaf] = {
                "slope": slope,
                "second": Number(self.second),
                "pace": Expression(f"(1 {self.sign} {{slope}})", slope=slope),
            }
            notation = (
                f"{{d}} * sin ({{turned}}) * (1 - frac({{slope}}^2, {{pace}}^2)){offset}"
                " + {d} * cos ({turned}) * frac({second}, {pace}^3)"
            )
            yield self._line("R", notation, length(radius), self._sizes() | rates)

    def _bent(self, radius: float) -> Lines:
        """By the curvature of the path of the roller's centre, from its rates in the cam."""
        velocity, acceleration = self.forms.rates(self.rows)
        rates = dict(zip(("u_x", "u_y", "w_x", "w_y"), (*velocity, *acceleration), strict=True))
        values: dict[str, Leaf] = {}
        for (name, value), letters in zip(rates.items(), self._rates(), strict=True):
            unit = "m/rad" if name.startswith("u") else "m/rad^2"
            yield name, letters, Number(float(value[0]), unit)
            values[name] = Factor(length(float(value[0])))
        first, last = "{u_y} * {w_x}", "{u_x} * {w_y}"
        above = f"{first} - {last}" if self.body.sense > 0 else f"{last} - {first}"
        curvature = float(self.forms.bending(self.rows)[0])
        inverse = Number(curvature, "1/m")
        yield self._line("K", f"frac({above}, ({{u_x}}^2 + {{u_y}}^2)^(3/2))", inverse, values)
        size = length(1.0 / curvature if curvature else math.inf)
        if not self.forms.roller:
            bare = Number(curvature, "1/m", unit_hidden=True)
            yield "R", "frac(1, K)", Expression("frac(1, {curvature})", curvature=bare), size
            return
        worked = Expression("{size} - {r}", size=Factor(size), r=self._sizes()["r"])
        yield "R", "frac(1, K) - r", worked if curvature else size, length(radius)

    def _rates(self) -> tuple[str, str, str, str]:
        """Rates of the way of the roller's centre in the cam, along the axes of the frame, in letters."""
        guide, sign, other = self.body.guide, self.sign, self.other
        minus = "-" if self.body.sense < 0 else ""
        if not isinstance(guide, Oscillating):
            e, minus_e = (f" {other} e", " - e") if guide.offset else ("", "")
            return f"{minus}(y_0 + s)", f"s'{e}", f"{minus}2 s'{minus_e}", "s'' - (y_0 + s)"
        return (
            f"l (psi' {sign} 1) sin ({TURNED})",
            f"l (psi' {sign} 1) cos ({TURNED}) {other} d",
            f"l psi'' sin ({TURNED}) + l (psi' {sign} 1)^2 cos ({TURNED}) - d",
            f"l psi'' cos ({TURNED}) - l (psi' {sign} 1)^2 sin ({TURNED})",
        )

    def place(self) -> Lines:
        """The point of the profile in the axes of the cam."""
        places = self.forms.place(np.array([self.phi]), self.rows)[0]
        for name, letters, value in zip(("x", "y"), self._places(), places, strict=True):
            yield name, letters, length(float(value))

    def _places(self) -> tuple[str, str]:
        if self.forms.flat and not self.forms.swings:
            across = "(r_0 + s) sin phi + s' cos phi"
            return across if self.body.sense > 0 else f"-({across})", "(r_0 + s) cos phi - s' sin phi"
        if self.forms.flat:
            return "p sin theta + t cos theta", "p cos theta - t sin theta"
        return f"x_P cos phi {self.sign} y_P sin phi", f"y_P cos phi {self.other} x_P sin phi"

    def aids(self) -> Lines:
        """What the formulas of the profile use besides the lift: the contact in the frame, or the line of the face."""
        guide, sign, other = self.body.guide, self.sign, self.other
        if self.forms.flat:
            if isinstance(guide, Oscillating):
                yield "theta", f"{TURNED} {sign} phi"
                yield "p", f"d sin ({TURNED}){' - f' if guide.face_offset else ''}"
                yield "t", f"frac(d psi' cos ({TURNED}), psi' {sign} 1)"
            return
        if isinstance(guide, Oscillating):
            x, y = f"d - l cos ({TURNED})", f"l sin ({TURNED})"
        else:
            x, y = "e" if guide.offset else "0", "y_0 + s"
        if self.forms.roller:
            way = "sqrt(u_x^2 + u_y^2)"
            across = f"{sign} r frac(u_y, {way})"
            x = f"{x} {across}" if x != "0" else across.removeprefix("+ ")
            y = f"{y} {other} r frac(u_x, {way})"
        yield "x_P", x
        yield "y_P", y

    def _line(self, left: str, notation: str, result: Leaf, values: Mapping[str, Leaf]) -> tuple[Leaf, ...]:
        used = {name: value for name, value in values.items() if f"{{{name}}}" in notation}
        return relation(left, notation, result, used, self.letters)

    def _sizes(self) -> dict[str, Leaf]:
        """Sizes of cam and follower in sums and products."""
        guide = self.body.guide
        sizes = {"r_0": self.body.base_radius, "r": self.forms.roller}
        if isinstance(guide, Oscillating):
            sizes |= {"d": guide.distance, "l": guide.arm, "f": guide.face_offset}
        else:
            sizes |= {"e": guide.offset, "y_0": guide.start}
        return {
            "turned": Expression("{angle} degree", angle=Factor(Number(math.degrees(self.turned)))),
            **{name: Factor(length(value)) for name, value in sizes.items()},
        }
