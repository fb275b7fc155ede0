"""Shaking force and shaking moment of a mechanism as a labelled result, with their harmonics."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import copysign, tau
from typing import Any, Literal, TypeAlias, TypeVar, get_args

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.masses import masses_of
from centrode.dynamics.state import DriveMotion, Mass, Place, State
from centrode.dynamics.steady_motion.cycle import FEW_TURNS, MOST_TURNS, PROBES, SAME, Panels
from centrode.dynamics.steady_motion.steady import SteadySolution, solution_of, turned_at
from centrode.errors import InputError, MotionError, NotComputedYet
from centrode.kinematics.motion import (
    Variable,
    attributes_of,
    coordinates_along,
    judgements_of,
    labels_of,
    vocabulary_variable,
)
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.sample_index import selectable
from centrode.kinematics.samples import MotionOnPath
from centrode.kinematics.solve import Solved, grid_of, solve
from centrode.locale import _, speaking
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.units import read_quantity
from centrode.numerics.jets import Jet
from centrode.numerics.search import tops

# Inertial effects of bodies on the frame and on the drive, as sums over bodies in plane motion.
#
# Vectors of the plane are complex numbers x + i y. With momentum P and moment of momentum K of all bodies the
# force on the frame is -dP/dt and the moment on it -dK/dt: the joints only hand on what the inertia asks for.

Array: TypeAlias = npt.NDArray[np.float64]
Complex: TypeAlias = npt.NDArray[np.complex128]
Numbers = TypeVar("Numbers", Array, Complex)


@dataclass(frozen=True)
class ShaftMotion:
    """Motion of the drive at n samples: first two derivatives of the path's parameter by time, each (n)."""

    rate: Array
    second_rate: Array

    def second(self, orders: Numbers) -> Numbers:
        """Second derivatives by time of what has value and two derivatives by the parameter (3, ..., n)."""
        second_rate: Numbers = orders[2] * self.rate**2 + orders[1] * self.second_rate
        return second_rate


@dataclass(frozen=True)
class MassTracks:
    """Where bodies are: `places` [m] and `angles` [rad] (3, bodies, n), with derivatives by the parameter."""

    places: Complex
    angles: Array


@dataclass(frozen=True)
class Effects:
    """Effects of inertia at n samples: force [N] and moment [N m] on the frame, and what the drive must give [N m]."""

    force: Complex
    moment: Array
    driving: Array

    def __add__(self, other: Effects) -> Effects:
        return Effects(self.force + other.force, self.moment + other.moment, self.driving + other.driving)

    def times(self, factors: Array) -> Effects:
        """Sum of rows (rows, n), each times a factor (rows)."""
        return Effects(factors @ self.force, factors @ self.moment, factors @ self.driving)


def tracks_of(state: State, masses: Sequence[Mass]) -> MassTracks:
    """Centres of mass and angles of links."""
    count = len(state.parameter)
    return MassTracks(
        np.array([track(state.centre(mass.centre), count) for mass in masses]).swapaxes(0, 1),
        np.array([orders(state.angle(mass.link), count) for mass in masses]).swapaxes(0, 1),
    )


def track(place: Place, count: int) -> Complex:
    """A place with two derivatives (3, n)."""
    return np.asarray(orders(place[0], count) + 1j * orders(place[1], count))


def orders(jet: Jet, count: int) -> Array:
    """A number with two derivatives (3, n)."""
    return np.array([np.broadcast_to(np.squeeze(jet.derivative(k)), (count,)) for k in range(3)])


def effects_of(tracks: MassTracks, masses: Sequence[Mass], pace: ShaftMotion, about: complex) -> Effects:
    """Force, moment about a fixed place and driving moment that the inertia of links makes.

    With J the inertia reduced to the parameter q, the drive must give J q'' + (dJ/dq) q'^2 / 2.
    """
    mass = np.array([each.mass for each in masses])
    inertia = np.array([each.inertia for each in masses])
    (place, first, second), angles = tracks.places, tracks.angles
    acceleration = pace.second(tracks.places)
    turning = pace.second(angles)
    reduced = mass @ np.abs(first) ** 2 + inertia @ angles[1] ** 2
    # half the derivative of the reduced inertia
    slope = mass @ (np.conj(first) * second).real + inertia @ (angles[1] * angles[2])
    return Effects(
        -(mass @ acceleration),
        -(mass @ cross(place - about, acceleration) + inertia @ turning),
        reduced * pace.second_rate + slope * pace.rate**2,
    )


def sizes_of(
    tracks: MassTracks, masses: Sequence[Mass], pace: ShaftMotion, about: complex
) -> tuple[float, float]:
    """Greatest force and moment if no link took anything from another: what rounding is a share of."""
    mass = np.array([each.mass for each in masses])
    inertia = np.array([each.inertia for each in masses])
    acceleration = np.abs(pace.second(tracks.places))
    moment = mass @ (np.abs(tracks.places[0] - about) * acceleration)
    moment = moment + inertia @ np.abs(pace.second(tracks.angles))
    return float(np.nanmax(mass @ acceleration)), float(np.nanmax(moment))


def cross(a: Complex, b: Complex) -> Array:
    """The vector product's component across the plane."""
    return np.asarray((np.conj(a) * b).imag)


# A mechanism of one drive at any values of it, and how fast the drive is there.

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
    pace: Callable[[Array], ShaftMotion]
    panels: Panels | None = None
    _places: MotionOnPath | None = field(default=None, repr=False)

    @classmethod
    def of(cls, mechanism: Mechanism, speed: Speed = "mean") -> Instants:
        """The mechanism at the speed that loads see (see `ct.reduce`), or at its real one (`ct.steady_motion`).

        Raises InputError for several drives, for a drive without a constant speed, and as `steady_motion`.
        """
        check_speed(speed)
        if speed == "steady":
            solution = solution_of(mechanism)
            return cls(
                solution.prepared, lambda values: steady_shaft_motion(solution, values), solution.cycle.panels
            )
        if mechanism.space == "sphere":
            raise on_sphere()
        prepared = ready(mechanism)
        rate = constant_rate(prepared)
        return cls(prepared, lambda values: ShaftMotion(np.full(len(values), rate), np.zeros(len(values))))

    def state(self, values: Array) -> State:
        """Places at values of the drive, with derivatives by it."""
        places = self._places
        if places is None or not (places.mesh[0] <= np.min(values) and np.max(values) <= places.mesh[-1]):
            reach = values if places is None else np.append(values, places.mesh[[0, -1]])
            places = MotionOnPath.along(self.ready, self.ready.kinematics, reach)
            self._places = places
        # by the value of the drive: rates come in later, by `ShaftMotion`
        moving = DriveMotion(0.0 * values, values, np.ones(len(values)))
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
    return NotComputedYet(
        "space",
        _("balancing is not available on the sphere"),
        _("centrode reactions has the force and the moment on the frame"),
    )


def steady_shaft_motion(found: SteadySolution, values: Array) -> ShaftMotion:
    """The real speed and acceleration of a drive in steady motion."""
    cycle = found.cycle
    turned = cycle.sense * (values - cycle.first)
    # the cycle repeats: any value of the drive has its place in it
    turned = turned - cycle.period * np.floor(turned / cycle.period)
    return ShaftMotion(cycle.sense * found.speed.at(turned), cycle.sense * found.speed.acceleration(turned))


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
    # a machine's mean speed counts before the drive's own, in the drive's sense
    if mechanism.machine is not None and mechanism.runs_at_mean_speed:
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
        what = _("there is no full turn: the drive reciprocates")
        raise InputError(f"[[drives]] {drive.id}", what, _("drive the angle of a link that turns fully"))
    # most mechanisms repeat after a turn: few turns are looked at first
    for most in (FEW_TURNS, MOST_TURNS):
        # at probes in every turn, which lie nowhere special
        turned = (PROBES + tau * np.arange(most + 1)[:, None]).reshape(-1)
        values = path.initial + path.forward * turned
        signature = _signature(instants, masses, carriers, values)
        missing = ~np.isfinite(signature).all(axis=0)
        if missing.any():
            raise does_not_turn(float(values[missing][0]))
        by_turn = signature.reshape(len(signature), most + 1, -1)
        # each turn against the first one, at the same probes
        apart = np.max(np.abs(by_turn[:, 1:] - by_turn[:, :1]), axis=(0, 2))
        same = apart <= SAME * float(np.max(np.abs(signature)))
        if same.any():
            # the first turn after which everything agrees
            return 1 + int(np.argmax(same))
    what = _("after {turns} turns of the drive the masses are not in their initial positions").format(
        turns=most
    )
    raise InputError("[[gears]]", what, _("change the gear ratios"))


def _signature(
    instants: Instants, masses: Sequence[Mass], carriers: Sequence[tuple[str, str]], values: Array
) -> Array:
    """Numbers (rows, n) that repeat with the cycle: places over the greatest length, slopes, turning, and carriers."""
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
        _("change the dimensions (centrode rotatability gives the cause)"),
    )


# A whole cycle of a mechanism: what its inertia does at any value of the drive, and how great that gets.

Curve: TypeAlias = Callable[[Array], Array]

NODES_PER_TURN = 360
NEAR = 0.02
"""Share of the greatest value at the nodes within which another top may be the greater one between them."""
MOST_TOPS = 40


@dataclass(frozen=True)
class ShakingTurning:
    """A cycle of a mechanism with masses.

    Attributes
    ----------
    turns : int
        Whole turns of the drive until everything repeats.
    about : complex [m]
        The place that moments are taken about.
    """

    instants: Instants
    masses: tuple[Mass, ...]
    turns: int
    about: complex

    @classmethod
    def of(
        cls,
        mechanism: Mechanism,
        about: complex,
        speed: Speed = "mean",
        carriers: Sequence[tuple[str, str]] = (),
    ) -> ShakingTurning:
        """The cycle of a mechanism, and of what stands on carriers; raises as `Instants.of` and `turns_of_cycle`."""
        masses = heavy(mechanism)
        instants = Instants.of(mechanism, speed)
        return cls(instants, masses, turns_of_cycle(instants, masses, carriers), about)

    @property
    def first(self) -> float:
        """The drive's value at the beginning [rad]."""
        return self.instants.ready.kinematics.path.initial

    @property
    def period(self) -> float:
        """Angle of the drive in a cycle, with the sign in which it turns [rad]."""
        return self.instants.ready.kinematics.path.forward * tau * self.turns

    def values(self, count: int) -> Array:
        """Values of the drive evenly over the cycle; the end, which is the beginning again, is left out."""
        return self.first + self.period * np.arange(count) / count

    @property
    def nodes(self) -> Array:
        """Values of the drive at which a first look is taken."""
        return self.values(NODES_PER_TURN * self.turns)

    @cached_property
    def sizes(self) -> tuple[float, float]:
        """Greatest force [N] and moment [N m] if no link took anything from another."""
        _state, tracks = self.at(self.nodes)
        return sizes_of(tracks, self.masses, self.instants.pace(self.nodes), self.about)

    def at(self, values: Array) -> tuple[State, MassTracks]:
        """Where the masses are at values of the drive; MotionError where the mechanism has no motion."""
        state = self.instants.state(values)
        tracks = tracks_of(state, self.masses)
        missing = ~np.isfinite(tracks.places.sum(axis=(0, 1)) + tracks.angles.sum(axis=(0, 1)))
        if missing.any():
            raise does_not_turn(float(values[missing][0]))
        return state, tracks

    def effects(self, values: Array) -> Effects:
        """Effects of the inertia at values (n) of the drive [rad]; raises as `at`."""
        _state, tracks = self.at(values)
        return effects_of(tracks, self.masses, self.instants.pace(values), self.about)


@dataclass(frozen=True)
class Top:
    """The greatest value of a curve over a cycle, and the drive's value there [rad]."""

    value: float
    at: float


def heavy(mechanism: Mechanism) -> tuple[Mass, ...]:
    """Links with mass or inertia; InputError where there are none."""
    masses = masses_of(mechanism)
    if not masses:
        what = _("no link has a mass, so there is no inertia force")
        raise InputError("[links]", what, _("give links a mass, with centre and inertia"))
    return masses


def tops_of(curve: Curve, nodes: Array) -> tuple[Array, Array]:
    """Places and values of the tops of a periodic curve that come near its greatest value.

    `nodes` are evenly over a cycle. Two tops between neighbouring nodes are missed.
    """
    return tops(curve, nodes, near=NEAR, most=MOST_TOPS, period=True)


def top(curve: Curve, nodes: Array) -> Top:
    """The greatest value of a periodic curve: exact to rounding, its place to some 1e-8 of a turn."""
    places, values = tops_of(curve, nodes)
    best = int(np.argmax(values))
    return Top(float(values[best]), float(places[best]))


# Harmonics of what inertia does to the frame: Fourier coefficients over a whole cycle of the drive.
#
# At constant speed by the trapezoidal rule on a whole period, which converges faster than any power of the
# number of nodes for smooth periodic functions (L. N. Trefethen, J. A. C. Weideman, SIAM Review 56, 2014,
# 385-458); where loads make the acceleration jump by Gauss's rule between the jumps.

MOST_DOUBLINGS = 5
SETTLED = 1e-13
"""Change of the coefficients, over what the parts of the sum amount to, at which the doubling of nodes ends."""


@dataclass(frozen=True)
class Harmonics:
    """F(q) = sum of cosine_k cos(k q) + sine_k sin(k q) over the orders k, q the drive's value.

    Attributes
    ----------
    orders : (orders)
        Times in a turn of the drive; fractions where the cycle has several turns. The first is 0, the mean.
    force_cosine, force_sine : (orders) complex x + i y [N]
    moment_cosine, moment_sine : (orders) [N m]
    nodes : int
        Values of the drive the coefficients come from.
    error : float
        Change of a coefficient with twice the nodes, over what the parts of its sum amount to.
    """

    orders: Array
    force_cosine: Complex
    force_sine: Complex
    moment_cosine: Array
    moment_sine: Array
    nodes: int
    error: float

    @property
    def force_greatest(self) -> Array:
        """Longer half axis of the ellipse that the force of each order describes (orders) [N]."""
        # an ellipse is two vectors that turn against each other: where they meet, their sizes add up
        forward, backward = self.force_cosine - 1j * self.force_sine, self.force_cosine + 1j * self.force_sine
        return np.asarray(0.5 * (np.abs(forward) + np.abs(backward)))


def harmonics_of(turning: ShakingTurning, most: int) -> Harmonics:
    """Harmonics up to an order of the drive's turns."""
    orders = np.arange(most * turning.turns + 1) / turning.turns
    panels = turning.instants.panels
    count = NODES_PER_TURN * turning.turns
    force, moment = turning.sizes
    sizes = np.array([force or 1.0, force or 1.0, moment or 1.0])  # nothing moves: the sums are zero
    before: Array | None = None
    error = np.inf
    for _doubling in range(MOST_DOUBLINGS):
        if panels is None:
            values, weights = turning.values(count), np.full(count, 1.0 / count)
        else:
            values, weights = _gauss(turning, panels)
        coefficients = _coefficients(turning, orders, values, weights)
        if before is not None:
            # force by force, moment by moment: each coefficient over what its own sum may come up to
            error = float(np.max(np.max(np.abs(coefficients - before), axis=(0, 2)) / sizes))
        if error <= SETTLED:
            break
        before, count = coefficients, 2 * count
        # twice the panels where the acceleration jumps: Gauss's rule converges between jumps only
        panels = None if panels is None else _halve_panels(panels)
    cosine, sine = coefficients
    return Harmonics(
        orders,
        cosine[0] + 1j * cosine[1],
        sine[0] + 1j * sine[1],
        cosine[2],
        sine[2],
        len(values),
        error,
    )


def _coefficients(turning: ShakingTurning, orders: Array, values: Array, weights: Array) -> Array:
    """Cosine and sine coefficients (2, 3, orders) of force x, force y and moment."""
    effects = turning.effects(values)
    rows = np.stack([effects.force.real, effects.force.imag, effects.moment])
    # the mean has weight 1, the others 2: the coefficients of a real Fourier series
    waves = np.exp(1j * orders[:, None] * values) * np.where(orders == 0.0, 1.0, 2.0)[:, None]
    coefficients = (rows * weights) @ waves.T
    return np.stack([coefficients.real, coefficients.imag])


def _gauss(turning: ShakingTurning, panels: Panels) -> tuple[Array, Array]:
    """Values of the drive at Gauss's nodes of a cycle, and weights that make a mean."""
    sense = np.sign(turning.period)
    return turning.first + sense * panels.nodes, panels.weights / abs(turning.period)


def _halve_panels(panels: Panels) -> Panels:
    middles = 0.5 * (panels.edges[:-1] + panels.edges[1:])
    return Panels(np.sort(np.concatenate([panels.edges, middles])))


About = str | tuple[float | str, float | str]
ORDERS, MOST_ORDERS = 8, 60


def shaking(
    mechanism: MechanismSource,
    samples: int | None = None,
    start: float | str | None = None,
    stop: float | str | None = None,
    at: npt.ArrayLike | None = None,
    *,
    about: About = (0.0, 0.0),
    speed: Speed = "mean",
    orders: int = ORDERS,
) -> xr.Dataset:
    """Force and moment that the inertia of a mechanism puts on its frame, at the samples of a motion.

    Parameters
    ----------
    samples, start, stop, at
        As for `motion`; in steady motion as for `steady_motion`, over its cycle.
    about : name of a point of the frame, or (x, y) [m]
        Reference point of moments; the frame's origin by default.
    speed : "mean" or "steady"
        The machine's mean speed, or the drive's own where there is none; or the real one of `steady_motion`.
    orders : int
        Harmonics up to this multiple of the drive's turns.

    Returns
    -------
    Dataset
        `shaking_force` (sample, axis), its size, `shaking_moment`, `inertia_on_drive` (sample); where the drive
        turns all the way round at a constant speed or in steady motion, harmonics by `order` (docs: balancing).

    Raises
    ------
    InputError
        As `motion` does; no link with a mass; a place that is not the frame's.
    NotComputedYet
        The sphere.

    Examples
    --------
    >>> import centrode as ct
    >>> print(ct.summary(ct.shaking(ct.example("six-bar-press"), 37)).splitlines()[0])
    greatest shaking force                        2669.34 N
    """
    mechanism = mechanism_of(mechanism)
    if mechanism.space == "sphere":
        raise on_sphere()
    check_speed(speed)
    if isinstance(orders, bool) or not 1 <= orders <= MOST_ORDERS:
        what = _("{orders} harmonics are given").format(orders=orders)
        raise InputError("orders", what, _("give 1 to {most}").format(most=MOST_ORDERS))
    centre, masses = place_of(mechanism, about), heavy(mechanism)
    prepared, span = _sampled_range(mechanism, samples, start, stop, at, speed)
    solved = solve(prepared, span)
    state = State.of(solved, DriveMotion(span.time, span.parameter, span.rate))
    effects = effects_of(
        tracks_of(state, masses), masses, ShaftMotion(span.rate, span.second_rate), complex(*centre)
    )
    variables = _curves(effects, solved.ready.parameter.units[0], several=prepared.kinematics.path.by_time)
    variables["drive_rate"] = vocabulary_variable(
        "drive_rate", ("sample",), span.rate.copy(), solved.ready.parameter.units[0]
    )
    variables["status"] = judgements_of(solved, ())["status"]
    found, facts = _harmonics(mechanism, complex(*centre), speed, orders)
    if prepared.kinematics.path.by_time:
        del variables["drive_rate"]
    attributes = attributes_of(solved, "shaking") | {"about": list(centre), "speed": speed} | facts
    coordinates = _coordinates(solved, found)
    return selectable(xr.Dataset(variables | found, coords=coordinates, attrs=attributes))


def place_of(mechanism: Mechanism, about: About) -> tuple[float, float]:
    """Coordinates of a place of the frame, given by name or by themselves; InputError for any other."""
    if isinstance(about, str):
        if about not in mechanism.frame.points:
            what = _("{name} is not a point of the frame").format(name=value_text(about))
            raise InputError("about", what, nearest(about, list(mechanism.frame.points)))
        x, y = mechanism.frame.coordinates[about]
        return x, y
    try:
        x, y = (
            read_quantity(number, "length", "about") if isinstance(number, str) else float(number)
            for number in about
        )
    except (TypeError, ValueError):
        x = y = np.nan
    if not np.isfinite([x, y]).all():
        raise InputError("about", _("expected a point of the frame, or two finite coordinates in metres"))
    return x, y


def _sampled_range(
    mechanism: Mechanism,
    samples: int | None,
    start: float | str | None,
    stop: float | str | None,
    at: npt.ArrayLike | None,
    speed: Speed,
) -> tuple[Ready, SampleGrid]:
    """The samples, passed at the speed that is requested."""
    if speed == "steady":
        if start is not None or stop is not None:
            what = _("steady motion is shown over its cycle")
            raise InputError("speed", what, _("omit the range, or give values with at"))
        solution = solution_of(mechanism)
        turned = turned_at(solution, samples, at)
        rate, second = solution.speed.at(turned), solution.speed.acceleration(turned)
        sense = solution.cycle.sense
        return solution.prepared, SampleGrid(
            solution.speed.time(turned), solution.cycle.value(turned), sense * rate, sense * second
        )
    prepared = ready(mechanism)
    path = prepared.kinematics.path
    span = grid_of(prepared, samples, start, stop, at)
    if mechanism.machine is not None and mechanism.runs_at_mean_speed and path.parameter.is_uniform:
        rate = np.full(len(span.parameter), np.copysign(mechanism.machine.mean_speed, path.forward))
        time = path.parameter.times(span.parameter, path.start, rate)
        return prepared, SampleGrid(time, span.parameter, rate, 0.0 * rate)
    return prepared, span


def _curves(effects: Effects, unit: str, *, several: bool) -> dict[str, Variable]:
    """Force, its size, moment; what the drive gives, where there is one."""
    force = np.stack([effects.force.real, effects.force.imag], axis=-1)
    curves = {
        "shaking_force": vocabulary_variable("shaking_force", ("sample", "axis"), force),
        "shaking_force_size": vocabulary_variable("shaking_force_size", ("sample",), np.abs(effects.force)),
        "shaking_moment": vocabulary_variable("shaking_moment", ("sample",), effects.moment),
    }
    if not several:
        curves["inertia_on_drive"] = vocabulary_variable(
            "inertia_on_drive", ("sample",), effects.driving, unit
        )
    return curves


def _coordinates(solved: Solved, found: dict[str, Variable]) -> dict[str, Any]:
    along = coordinates_along(solved)
    kept = {"drive": along.pop("drive"), "axis": labels_of(solved.layout.space.axes), **along}
    return kept | ({"order": found.pop("order")} if "order" in found else {})


def _harmonics(
    mechanism: Mechanism, about: complex, speed: Speed, orders: int
) -> tuple[dict[str, Variable], dict[str, Any]]:
    """Variables by order and facts of the whole cycle; without a cycle only the reason."""
    try:
        with speaking("en"):  # what results keep
            turning = ShakingTurning.of(mechanism, about, speed)
            harmonics = harmonics_of(turning, orders)
            greatest = greatest_of(turning)
    except (InputError, MotionError) as failure:
        return {}, {"no_harmonics": failure.what}
    facts = {
        "turns_of_cycle": turning.turns,
        "harmonics_nodes": harmonics.nodes,
        "harmonics_error": harmonics.error,
        **greatest,
    }
    return variables_of(harmonics), facts


def greatest_of(turning: ShakingTurning) -> dict[str, float]:
    """Greatest force, moment and driving moment of inertia over the cycle, between samples too, and where."""
    facts: dict[str, float] = {}
    for name, curve in (
        ("shaking_force", lambda q: np.abs(turning.effects(q).force)),
        ("shaking_moment", lambda q: np.abs(turning.effects(q).moment)),
        ("inertia_on_drive", lambda q: np.abs(turning.effects(q).driving)),
    ):
        peaks = top(curve, turning.nodes)
        facts |= {f"greatest_{name}": peaks.value, f"greatest_{name}_at": peaks.at % (tau * turning.turns)}
    return facts


def variables_of(harmonics: Harmonics) -> dict[str, Variable]:
    """Coefficients, amplitudes and phases by order: amplitude times cos(order q - phase)."""

    def parts(name: str, cosine: Array, sine: Array, dims: tuple[str, ...]) -> dict[str, Variable]:
        values = {
            "cosine": cosine,
            "sine": sine,
            "amplitude": np.hypot(cosine, sine),
            "phase": np.arctan2(sine, cosine),
        }
        return {
            f"{name}_{key}": vocabulary_variable(f"{name}_{key}", dims, value)
            for key, value in values.items()
        }

    cosine, sine = (
        np.stack([x.real, x.imag], axis=-1) for x in (harmonics.force_cosine, harmonics.force_sine)
    )
    return {
        "order": vocabulary_variable("order", ("order",), harmonics.orders),
        **parts("force_harmonic", cosine, sine, ("order", "axis")),
        "force_harmonic_greatest": vocabulary_variable(
            "force_harmonic_greatest", ("order",), harmonics.force_greatest
        ),
        **parts("moment_harmonic", harmonics.moment_cosine, harmonics.moment_sine, ("order",)),
    }
