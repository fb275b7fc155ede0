"""Forces of a follower in letters, followed by their numbers at one angle, all in SI."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from centrode.cams.followers.forces import FollowerForces, meeting_of
from centrode.cams.followers.geometry import Oscillating
from centrode.render.document.formulas import factor, in_si, with_unit

if TYPE_CHECKING:
    from centrode.model.cam import Material
    from centrode.model.follower_cam import PlateCam
    from centrode.render.document.numbers import Numbers

Lines = Iterator[tuple[str, ...]]
ROUNDING = 1e-12
"""Shares of the greatest size below which a lift or a derivative is rounding."""


class Worked:
    """Formulas of the forces of one cam."""

    def __init__(self, cam: PlateCam, forces: FollowerForces, numbers: Numbers) -> None:
        self.cam, self.forces, self.numbers = cam, forces, numbers
        self.si = in_si(numbers)
        self.swings = cam.swings
        self.lettered = "psi" if self.swings else "s"
        self.inertia = "J" if self.swings else "m"
        self.unit = "N m" if self.swings else "N"
        self.sizes = np.abs(forces.body.motion.lift(np.linspace(0.0, math.tau, 361), 2)).max(axis=1)

    def rows(self, at: float) -> list[float]:
        """Lift, slope, second derivative at an angle, rounding left out; at an edge what is nearer inside."""
        found = self.forces.body.motion.lift(np.array([at]), 2)[:, 0]
        return [
            0.0 if abs(one) <= ROUNDING * size else float(one)
            for one, size in zip(found, self.sizes, strict=True)
        ]

    def letters(self) -> tuple[tuple[str, ...], ...]:
        """Push, normal force, torque."""
        lines = [("Q", " + ".join(text for text, _value in self._parts([1.0, 1.0, 1.0])) or "0")]
        if self.forces.friction:
            lines += [("N", "frac(Q, b_n + mu b_t)"), ("T", "N (g_n + mu g_t)")]
        else:
            body = self.forces.body
            flat = math.isinf(body.touch.roller)
            if not self.swings:
                lines.append(("N", "Q" if flat else "frac(Q, cos alpha)"))
            else:
                lines.append(("N", "frac(Q, q)" if flat else "frac(Q, l cos alpha)"))
            lines.append(("T", f"Q {self.lettered}'"))
        return tuple(lines)

    def _parts(self, rows: list[float]) -> list[tuple[str, str]]:
        """Terms of the push that are there, in letters and with numbers."""
        burden, speed = self.forces.burden, self.forces.speed
        one = self.si
        found = []
        if burden.preload:
            found.append(("F_0", one.math(burden.preload)))
        if burden.load:
            found.append(("P", factor(one, burden.load)))
        if burden.stiffness:
            found.append(
                (f"k {self.lettered}", f"{one.math(burden.stiffness)} dot.op {factor(one, rows[0])}")
            )
        if burden.inertia and speed:
            worked = f"{one.math(burden.inertia)} dot.op {one.math(speed)}^2 dot.op {factor(one, rows[2])}"
            found.append((f"{self.inertia} omega^2 {self.lettered}''", worked))
        return found

    def lift(self, at: float) -> Lines:
        """Lift and second derivative in SI."""
        value, _slope, second = self.rows(at)
        units = ("", "") if self.swings else (' thin "m"', ' thin "m/rad"^2')
        end = ' thin "rad"' if self.swings else units[0]
        yield self.lettered, self.si.math(value) + end
        yield f"{self.lettered}''", self.si.math(second) + units[1]

    def slope(self, at: float) -> Lines:
        """The slope of the lift."""
        yield f"{self.lettered}'", self.si.math(self.rows(at)[1]) + ("" if self.swings else ' thin "m/rad"')

    def push(self, at: float) -> Lines:
        """The push with its numbers."""
        rows = self.rows(at)
        parts = self._parts(rows)
        value = float(self.forces.at(np.array([at])).push[0])
        letters, worked = (" + ".join(part[k] for part in parts) for k in (0, 1))
        yield "Q", letters or "0", worked or "0", with_unit(self.si, value, self.unit)

    def push_told(self, at: float) -> Lines:
        """The push alone."""
        yield "Q", with_unit(self.si, float(self.forces.at(np.array([at])).push[0]), self.unit)

    def normal(self, at: float) -> Lines:
        """The force along the normal."""
        phi = np.array([at])
        found, body = self.forces.at(phi), self.forces.body
        push, force = float(found.push[0]), float(found.normal[0])
        end = with_unit(self.si, force, "N")
        if self.forces.friction:
            levers, _arms = self._levers(at)
            for name, value in zip(("b_n", "b_t"), levers, strict=True):
                yield name, self._arm(value) if self.swings else self.si.math(value)
            coefficient = self.si.math(self.forces.friction)
            below = f"{self.si.math(levers[0])} + {coefficient} dot.op {factor(self.si, levers[1])}"
            yield "N", "frac(Q, b_n + mu b_t)", f"frac({factor(self.si, push)}, {below})", end
            return
        contact = body.contact(phi)
        if math.isinf(body.touch.roller):
            if self.swings:
                q = float(contact.along[0])
                yield "q", self._arm(q)
                yield "N", "frac(Q, q)", f"frac({self.si.math(push)}, {self.si.math(q)})", end
            else:
                yield "N", "Q", end
            return
        alpha = math.degrees(float(contact.pressure_angle[0]))
        cosine = f"cos ({factor(self.si, alpha)} degree)"
        if isinstance(body.guide, Oscillating):
            below = f"{self.si.math(body.guide.arm)} dot.op {cosine}"
            yield "N", "frac(Q, l cos alpha)", f"frac({self.si.math(push)}, {below})", end
        else:
            yield "N", "frac(Q, cos alpha)", f"frac({self.si.math(push)}, {cosine})", end

    def _arm(self, value: float) -> str:
        return f'{self.si.math(value)} thin "m"'

    def _levers(self, at: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """What forces of one along the normal and the drag do on the follower's way, and their arms about the axis."""
        met = meeting_of(self.forces.body, self.forces.body.motion.lift(np.array([at]), 2))

        def clean(value: float, size: float) -> float:
            return 0.0 if abs(value) <= ROUNDING * size else value

        on_way = [float(np.sum(met.lever * one)) for one in (met.normal, met.slip)]
        arms = [
            met.sense * float(met.place[0, 0] * one[0, 1] - met.place[0, 1] * one[0, 0])
            for one in (met.normal, met.slip)
        ]
        size, reach = float(np.linalg.norm(met.lever)), float(np.linalg.norm(met.place))
        return (clean(on_way[0], size), clean(on_way[1], size)), (
            clean(arms[0], reach),
            clean(arms[1], reach),
        )

    def torque(self, at: float) -> Lines:
        """The torque about the cam's axis."""
        found = self.forces.at(np.array([at]))
        push, force, torque = float(found.push[0]), float(found.normal[0]), float(found.torque[0])
        end = with_unit(self.si, torque, "N m")
        if not self.forces.friction:
            worked = f"{factor(self.si, push)} dot.op {factor(self.si, self.rows(at)[1])}"
            yield "T", f"Q {self.lettered}'", worked, end
            return
        _levers, arms = self._levers(at)
        yield "N", with_unit(self.si, force, "N")
        for name, value in zip(("g_n", "g_t"), arms, strict=True):
            yield name, self._arm(value)
        bracket = f"({self.si.math(arms[0])} + {self.si.math(self.forces.friction)} dot.op {factor(self.si, arms[1])})"
        yield "T", "N (g_n + mu g_t)", f"{factor(self.si, force)} dot.op {bracket}", end

    def jump(self, at: float, speed: float) -> Lines:
        """The speed at which the push is zero there."""
        value, _slope, second = self.rows(at)
        burden = self.forces.burden
        rest = [part for part in self._parts([value, 0.0, 0.0]) if not part[0].startswith(self.inertia)]
        letters, worked = (" + ".join(part[k] for part in rest) for k in (0, 1))
        below = f"-{self.si.math(burden.inertia)} dot.op {factor(self.si, second)}"
        yield (
            'omega_"j"',
            f"sqrt(frac({letters}, -{self.inertia} {self.lettered}''))",
            f"sqrt(frac({worked}, {below}))",
            f'{self.si.math(speed)} thin "rad/s"',
        )
        yield 'n_"j"', 'frac(30, pi) omega_"j"', f'{self.si.math(speed * 30.0 / math.pi)} thin "min"^(-1)'

    def preload(self, needed: float, at: float) -> tuple[tuple[str, ...], ...]:
        """The least preload, from the angle that asks for most."""
        parts = [part for part in self._parts(self.rows(at)) if part[0] != "F_0"]
        letters, worked = (" + ".join(part[k] for part in parts) for k in (0, 1))
        degrees = f"{self.si.math(math.degrees(at))} degree"
        return (
            ("phi", degrees),
            ('F_(0, "min")', f"-({letters})", f"-({worked})", with_unit(self.si, needed, self.unit)),
        )

    def stress(self, at: float) -> tuple[tuple[str, ...], ...]:
        """Load of the strip, curvatures, contact modulus, stress, half width."""
        phi = np.array([at])
        forces, si = self.forces, self.si
        found, contact = forces.at(phi), forces.body.contact(phi)
        strip = found.strip
        assert strip is not None and forces.width is not None and forces.modulus is not None
        normal, roller = abs(float(found.normal[0])), forces.body.touch.roller
        load, bend = normal / forces.width, float(contact.bend[0])
        curvature = (0.0 if math.isinf(roller) else 1.0 / roller) + float(contact.curvature[0])
        modulus = forces.modulus
        mega = 1e-6
        rolling = f"frac(1, {si.math(roller)}) + " if math.isfinite(roller) else ""
        letters = "frac(1, r) + frac(1, R)" if rolling else "frac(1, R)"
        return (
            ("phi", f"{si.math(math.degrees(at))} degree"),
            ("w", "frac(N, b)", f"frac({si.math(normal)}, {si.math(forces.width)})", f'{si.math(load)} thin "N/m"'),
            ("kappa", letters, f"{rolling}frac(1, {factor(si, bend)})", f'{si.math(curvature)} thin "1/m"'),
            ("frac(1, E^*)", "frac(1 - nu_1^2, E_1) + frac(1 - nu_2^2, E_2)", self._moduli(),
             f'frac(1, {si.math(modulus * mega)} thin "MPa")'),
            ("sigma", "sqrt(frac(w kappa E^*, pi))",
             f"sqrt(frac({si.math(load)} dot.op {si.math(curvature)} dot.op {si.math(modulus)}, pi))",
             f'{si.math(float(strip.pressure[0]) * mega)} thin "MPa"'),
            ("a", "sqrt(frac(4 w, pi kappa E^*))", f'{si.math(1e3 * float(strip.half_width[0]))} thin "mm"'),
        )  # fmt: skip

    def _moduli(self) -> str:
        first, second = self.cam.body.material, self.cam.follower.material
        texts = [self._compliance(one) for one in (first or second, second or first) if one is not None]
        return " + ".join(texts)

    def _compliance(self, material: Material) -> str:
        mega = self.si.math(material.elasticity * 1e-6)
        return f"frac(1 - {self.si.math(material.poisson)}^2, {mega})"
