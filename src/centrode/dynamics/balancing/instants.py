"""A mechanism of one drive at any values of it, and how fast the drive is there."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import copysign, tau
from typing import Literal, TypeAlias, get_args

import numpy as np

from centrode.dynamics.balancing.inertial import Array, Pace
from centrode.dynamics.masses import Mass
from centrode.dynamics.states import Moving, State
from centrode.dynamics.steady_motion.cycle import FEW_TURNS, MOST_TURNS, PROBES, SAME
from centrode.dynamics.steady_motion.quadrature import Panels
from centrode.dynamics.steady_motion.solution import Solution, solution_of
from centrode.errors import InputError, MotionError, NotComputedYet
from centrode.kinematics.places import Places
from centrode.kinematics.ready import Ready, ready
from centrode.locale import _
from centrode.model.mechanism import Mechanism

Speed: TypeAlias = Literal["mean", "steady"]
SPEEDS = get_args(Speed)


@dataclass
class Instants:
    """A mechanism with one drive; events of its path are looked for once.

    Attributes
    ----------
    ready : the mechanism with its plan
    pace : values of the drive (n) -> its first two derivatives by time
    panels : Panels or None
        Of the angle turned in a cycle, ending where a load makes the acceleration jump; None at constant speed.
    """

    ready: Ready
    pace: Callable[[Array], Pace]
    panels: Panels | None = None
    _places: Places | None = field(default=None, repr=False)

    @classmethod
    def of(cls, mechanism: Mechanism, speed: Speed = "mean") -> Instants:
        """The mechanism at the speed that loads see (see `ct.reduce`), or at its real one (`ct.steady_motion`).

        Raises InputError for several drives, for a drive without a constant speed, and as `steady_motion`.
        """
        check_speed(speed)
        if speed == "steady":
            found = solution_of(mechanism)
            return cls(found.prepared, lambda values: steady_pace(found, values), found.cycle.panels)
        if mechanism.space == "sphere":
            raise on_sphere()
        prepared = ready(mechanism)
        rate = constant_rate(prepared)
        return cls(prepared, lambda values: Pace(np.full(len(values), rate), np.zeros(len(values))))

    def state(self, values: Array) -> State:
        """Places at values of the drive, with derivatives by it."""
        places = self._places
        if places is None or not (places.mesh[0] <= np.min(values) and np.max(values) <= places.mesh[-1]):
            reach = values if places is None else np.append(values, places.mesh[[0, -1]])
            places = Places.along(self.ready, self.ready.kinematics, reach)
            self._places = places
        moving = Moving(0.0 * values, values, np.ones(len(values)))
        return State.of_samples(
            self.ready.mechanism, places.at(values), moving, self.ready.kinematics.path.scale
        )


def check_speed(speed: str) -> None:
    """Refuse what is no speed."""
    if speed not in SPEEDS:
        raise InputError(
            "speed",
            _("{name} is not a speed of the drive").format(name=f'"{speed}"'),
            _("use one of {known}").format(known=", ".join(SPEEDS)),
        )


def on_sphere() -> NotComputedYet:
    """The refusal of a spherical mechanism."""
    return NotComputedYet("space", _("forces on the sphere are not computed yet"), _("describe a plane one"))


def steady_pace(found: Solution, values: Array) -> Pace:
    """The real speed and acceleration of a drive in steady motion."""
    cycle = found.cycle
    turned = cycle.sense * (values - cycle.first)
    turned = turned - cycle.period * np.floor(turned / cycle.period)
    return Pace(cycle.sense * found.speed.at(turned), cycle.sense * found.speed.acceleration(turned))


def constant_rate(prepared: Ready) -> float:
    """The machine's mean speed in the sense of the drive, else the drive's own; InputError where neither tells."""
    mechanism, path = prepared.mechanism, prepared.kinematics.path
    if path.by_time:
        what = _("a cycle needs one drive, the mechanism has {count}").format(count=len(mechanism.drives))
        raise InputError("[[drives]]", what, _("tie the drives by a gear"))
    if not path.parameter.is_uniform:
        what = _("a cycle needs a drive of constant speed, and this one is a law of time")
        raise InputError(f"[[drives]] {path.driven[0].drive.id}", what, _("give it a speed"))
    rate = float(path.parameter.constant_speed or 0.0)
    if mechanism.machine is not None:
        rate = copysign(mechanism.machine.mean_speed, path.forward)
    if rate == 0.0:
        what = _("its speed is zero, so there is no inertia force")
        raise InputError(f"[[drives]] {path.driven[0].drive.id}", what, _("give it a speed"))
    return rate


def turns_of_cycle(
    instants: Instants, masses: Sequence[Mass], carriers: Sequence[tuple[str, str]] = ()
) -> int:
    """The least number of whole turns of the drive after which all masses are back in their places.

    `carriers` are links that may carry more, each with one of its points: they are to be back too.

    Raises
    ------
    InputError
        A drive that does not turn, or masses that never come back.
    MotionError
        The mechanism does not turn fully.
    """
    path = instants.ready.kinematics.path
    drive = path.driven[0].drive
    if drive.kind != "angle":
        what = _("there is no whole turn: the drive moves to and fro")
        raise InputError(f"[[drives]] {drive.id}", what, _("drive the angle of a link that turns fully"))
    for most in (FEW_TURNS, MOST_TURNS):
        turned = (PROBES + tau * np.arange(most + 1)[:, None]).reshape(-1)
        values = path.initial + path.forward * turned
        found = _signature(instants, masses, carriers, values)
        missing = ~np.isfinite(found).all(axis=0)
        if missing.any():
            raise does_not_turn(float(values[missing][0]))
        by_turn = found.reshape(len(found), most + 1, -1)
        apart = np.max(np.abs(by_turn[:, 1:] - by_turn[:, :1]), axis=(0, 2))
        same = apart <= SAME * float(np.max(np.abs(found)))
        if same.any():
            return 1 + int(np.argmax(same))
    what = _("the masses are not back in their places after {turns} turns of the drive").format(turns=most)
    raise InputError("[[gears]]", what, _("change the ratios of the gears"))


def _signature(
    instants: Instants, masses: Sequence[Mass], carriers: Sequence[tuple[str, str]], values: Array
) -> Array:
    """What has to be the same again: places over the greatest length with their derivatives, turning, and carriers."""
    state, count = instants.state(values), len(values)
    size = 1.0 / state.scale
    rows = []
    for mass in masses:
        x, y = state.centre(mass.centre)
        turning = state.angle(mass.link)
        rows += [(jet * size).derivative(k) for jet in (x, y) for k in range(2)]
        rows += [turning.derivative(k) for k in (1, 2)]
    for link, base in carriers:
        x, y = state.point(base)
        rows += [jet.value for jet in (x * size, y * size, *state.rotor(link))]
    return np.array([np.broadcast_to(np.squeeze(row), (count,)) for row in rows])


def does_not_turn(value: float) -> MotionError:
    """The refusal of a mechanism that has no whole cycle."""
    return MotionError(
        "",
        _("the mechanism does not turn fully: it has no motion at {value:.6g} deg of its drive").format(
            value=np.degrees(value)
        ),
        _("change the dimensions (centrode rotatability says what stops it)"),
    )
