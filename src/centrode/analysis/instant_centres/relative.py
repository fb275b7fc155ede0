"""The motion of one body as another one sees it: derivatives of its pose, and what follows for the pole.

Complex numbers z = c + s, s a place of the body turned with it, in the axes of the other body. By the relative
angle: pole P = c + i c', where z' = 0; A = c'' - i c' leads from it to the inflection pole; B = c''' + c'
(Bottema and Roth, Theoretical Kinematics, 1979, chapter 8, write them as instantaneous invariants).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from centrode.analysis.instant_centres.bodies import Array, Bodies, Pair, Places


@dataclass(frozen=True)
class Seen:
    """Derivatives by one parameter: of the origin of a body's axes `c`, and of its angle `w` (first, second, ...).

    All are in the axes of the body that looks on, whose own origin and rotor are `origin` and `rotor`; `turned`
    is the rotor of the body looked at, in these axes.
    """

    c: tuple[Places, ...]
    w: tuple[Array, ...]
    turned: Places
    origin: Places
    rotor: Places

    @property
    def pole(self) -> Places:
        """Place whose velocity is zero."""
        return np.asarray(self.c[0] + 1j * self.c[1] / self.w[0])

    @property
    def pole_in_body(self) -> Places:
        """The same place in the axes of the body looked at."""
        return np.asarray(np.conj(self.turned) * 1j * self.c[1] / self.w[0])

    @property
    def pole_velocity(self) -> Places:
        """Velocity of the pole along the fixed centrode, by the parameter."""
        w, w1 = self.w[:2]
        return np.asarray(self.c[1] + 1j * (self.c[2] * w - self.c[1] * w1) / w**2)

    def by_angle(self) -> tuple[Places, ...]:
        """Derivatives of `c` by the relative angle, first to third where there are so many."""
        w = self.w[0]
        first = self.c[1] / w
        second = (self.c[2] - self.w[1] * first) / w**2
        if len(self.c) < 4:
            return first, second
        third = (self.c[3] - 3.0 * w * self.w[1] * second - self.w[2] * first) / w**3
        return first, second, third

    def outside(self, place: Places) -> Places:
        """A place in the frame's axes."""
        return np.asarray(self.origin + self.rotor * place)


def seen_by(bodies: Bodies, pair: Pair) -> Seen:
    """The first body as the second sees it, over a motion: two derivatives."""
    first, second = pair
    rotor = np.exp(1j * bodies.turn[..., second])
    place, velocity, acceleration = (
        np.asarray(x[..., first] - x[..., second])
        for x in (bodies.place, bodies.velocity, bodies.acceleration)
    )
    w, w1 = bodies.spin[..., second], bodies.spin_rate[..., second]
    back = np.conj(rotor)
    c = (
        back * place,
        back * (velocity - 1j * w * place),
        back * (acceleration - 2j * w * velocity - (1j * w1 + w * w) * place),
    )
    spins = tuple(np.asarray(x[..., first] - x[..., second]) for x in (bodies.spin, bodies.spin_rate))
    turned = np.exp(1j * (bodies.turn[..., first] - bodies.turn[..., second]))
    return Seen(c, spins, turned, np.asarray(bodies.place[..., second]), rotor)
