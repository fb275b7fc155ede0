"""Closed forms of pressure angle, curvature and profile of a follower's cam, each as a textbook has it.

They share nothing with `FollowerCam.contact`, which differentiates envelopes, and so prove it.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from centrode.cams.followers.geometry import ContactMotion, Face, FollowerCam, Oscillating

Array = npt.NDArray[np.float64]

ROUNDING = 1e-12
"""Share of its greatest size below which the lift or a derivative is rounding."""


TURN = np.linspace(0.0, math.tau, 721)[:-1]
"""Angles [rad] of a turn at which routes are compared."""


def clear_lift(motion: ContactMotion, phi: Array, order: int) -> Array:
    """Lift and derivatives (order + 1, n) at angles of the cam (n) [rad], without what rounding leaves of zero."""
    rows = motion.lift(phi, order)
    sizes = np.abs(motion.lift(np.linspace(0.0, math.tau, 361), order)).max(axis=1)
    return np.where(np.abs(rows) <= ROUNDING * sizes[:, None], 0.0, rows)


class ClosedForms:
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
