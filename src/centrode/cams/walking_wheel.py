"""A walking wheel proved: its shoes are put on the ground as curves, by the paper's formulas, and looked at.

Nothing here uses the support function by which the shoes are made (`shoe`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.polynomial import legendre

from centrode.cams.nodes import nodes_of
from centrode.cams.return_arc import Arc, ClosedPath
from centrode.cams.roller_path import JETS, Array, Frames, SymmetricPath, frames, radius_jet
from centrode.dynamics.steady_motion.cycle import NODES, Panels, PanelSeries
from centrode.errors import InputError, MotionError
from centrode.locale import _, ngettext
from centrode.numerics.jets import Jet, quotient
from centrode.numerics.search import Extremes, extremes, maxima_between
from centrode.printed_results import PrintsSummary

if TYPE_CHECKING:
    from centrode.model.cam import Cam

# The shoe of a leg: the profile that rolls on flat ground while the hub stays at its height.
#
# The ground touches the shoe in the leg's axes as a line whose normal makes the angle phi with the leg. Its
# distance from the roller's centre is p(phi) = h - H cos phi, h the height of the hub, H the polar radius of
# the roller's path: the support function of the shoe. Its envelope is the paper's X_B = Y2 sin phi, Y_B = Y1
# + Y2 cos phi with Y1 = H' cot phi - H and Y2 = h - H' cos(phi)^2 / sin phi, but p has no quotient that
# vanishes at phi = 0.

NEAR = 0.03
"""Within so many radians of phi = 0, H'/sin phi is the quotient of two series."""
TERMS = 14
LEVEL = 1e-12
"""Greatest pressure angle [rad] at phi = 0 that counts as zero."""


@dataclass(frozen=True)
class Shoe:
    """The shoe that belongs to a symmetric working arc and a height of the hub.

    Attributes
    ----------
    arc : Arc
        Working arc, -half to half; the shoe is as symmetric as the path over it.
    height : float [m]
        Of the hub over the ground, R0 + r + C.
    """

    arc: Arc
    height: float

    @property
    def half(self) -> float:
        """Half the working arc [rad]."""
        return self.arc.stop

    def support(self, phi: Array, order: int = 0) -> Array:
        """Distance of the ground from the roller's centre and its derivatives (order + 1, n) [m/rad^k]."""
        p = self._support(np.asarray(phi, dtype=np.float64), order)
        return np.array([c * math.factorial(k) for k, c in enumerate(p.coefficients)])

    def place(self, phi: Array) -> Array:
        """Points (X_B, Y_B) of the profile (n, 2) [m] in the leg's axes: Y along the leg from the roller's centre."""
        p, slope = self.support(phi, 1)
        sine, cosine = np.sin(phi), np.cos(phi)
        # the envelope of the lines x sin(phi) + y cos(phi) = p: the place p n + p' t with their normal and
        # tangent
        return np.stack([p * sine + slope * cosine, p * cosine - slope * sine], axis=-1)

    def polar(self, phi: Array) -> tuple[Array, Array]:
        """Angle alpha [rad] from the shoe's axis and radius [m] about the roller's centre: the paper's (9), (10)."""
        x, y = self.place(phi).T
        return np.arctan2(x, y), np.hypot(x, y)

    def bend(self, phi: Array) -> Array:
        """Radius of curvature (n) [m] of the profile: p + p''."""
        p = self.support(phi, 2)
        return np.asarray(p[0] + p[2])

    def parts(self, phi: Array) -> tuple[Array, Array]:
        """The paper's Y1 along the leg and Y2 upright (n) [m]: the contact lies at Y1 d + Y2 n.

        At phi = 0, H'/sin phi is a removable singularity: near it both are divided as series, elsewhere as numbers.
        """
        phi = np.asarray(phi, dtype=np.float64)
        radius, slope = self.arc.curve.radius(phi, 1)
        with np.errstate(divide="ignore", invalid="ignore"):
            share = slope / np.sin(phi)
        near = np.abs(phi) <= self._near
        # a law that breaks at phi = 0 is mirrored there, and the series to the right serves both sides
        inner = np.abs(phi[near]) if 0.0 in self.arc.breaks else phi[near]
        share[near] = np.polynomial.polynomial.polyval(inner, self._share)
        cosine = np.cos(phi)
        return share * cosine - radius, self.height - share * cosine**2

    @cached_property
    def least_bend(self) -> tuple[float, float]:
        """The least radius of curvature [m] of the profile and where [rad]."""
        bends = extremes(
            self.bend,
            # the radius of curvature p + p'' has its extremes where p' + p''' vanishes
            lambda phi: np.asarray(self.support(phi, 1)[1] + self.support(phi, 3)[3]),
            nodes_of(self.arc.edges),
        )
        return bends.least, bends.at_least

    def _support(self, phi: Array, order: int) -> Jet:
        angle = Jet([phi, *([np.ones_like(phi)] if order else []), *([0.0 * phi] * (order - 1))])
        # the cosine is taken over jets, so that the support's derivatives follow from those of the path
        lowered: Jet = radius_jet(self.arc.curve, phi, order) * JETS.cos(angle)
        return -lowered + self.height

    @cached_property
    def _share(self) -> Array:
        """Taylor coefficients of H'/sin phi about phi = 0, to the right."""
        rho = radius_jet(self.arc.curve, np.zeros(1), TERMS + 1).slope()
        sine = JETS.sin(Jet.variable(np.zeros(1), TERMS))
        # both series begin with a zero: without it the quotient has a value at phi = 0
        share = quotient(tuple(rho.coefficients[1:]), tuple(c + np.zeros(1) for c in sine.coefficients[1:]))
        return np.array([float(c[0]) for c in share])

    @cached_property
    def _near(self) -> float:
        """Angle [rad] up to which the series is good to rounding; 0 where the law breaks at 0 without symmetry."""
        if 0.0 in self.arc.breaks and not isinstance(self.arc.curve, SymmetricPath):
            # the two series differ there, so neither side has one that holds for both
            return 0.0
        last, first = abs(self._share[-1]), abs(self._share[0]) or 1.0
        # the last term over the first is the share left out at the distance where it reaches rounding
        reach = (np.finfo(float).eps * first / last) ** (1.0 / TERMS) if last else NEAR
        return float(min(NEAR, reach, *(abs(place) for place in self.arc.breaks if place)))


def shoe(arc: Arc, height: float) -> Shoe:
    """The shoe of a working arc.

    Parameters
    ----------
    arc : Arc
        From -half to half, less than a quarter turn to each side.
    height : float [m]
        Of the hub over the ground.

    Raises
    ------
    InputError
        gamma is not zero at phi = 0, where the contact would jump across the shoe (the paper's Y2 is infinite
        there); the arc is not as asked; the height does not exceed the path's radius.
    MotionError
        The shoe would have a cusp: the message tells the least height without one.
    """
    if abs(arc.start + arc.stop) > LEVEL or arc.stop >= math.pi / 2:
        raise InputError(
            "",
            _("a shoe requires equal arcs of less than 90 deg on both sides"),
            _("use three legs or more"),
        )
    radius, slope = arc.curve.radius(np.zeros(1), 1)[:, 0]
    gamma = math.atan2(slope, radius)
    if abs(gamma) > LEVEL:
        what = _("the shoe is singular: at phi = 0 its contact would jump by {jump:.6g} mm").format(
            jump=2e3 * abs(slope)
        )
        raise InputError("[start] pressure_angle", what, _("set it to 0"))
    if not height > radius:
        what = _("the hub at {height:.6g} mm is lower than the reach of the roller's path, {radius:.6g} mm")
        raise InputError(
            "[mover]", what.format(height=1e3 * height, radius=1e3 * radius), _("use a longer shoe post")
        )
    candidate = Shoe(arc, height)
    least, at = candidate.least_bend
    if least <= 0.0:
        # the height enters the radius of curvature as it is: so much more of it takes the cusp away
        what = _(
            "the shoe has a cusp: its radius of curvature falls to {least:.6g} mm at {at:.6g} deg"
        ).format(least=1e3 * least, at=math.degrees(at))
        more = _("make the post of the shoe longer by more than {more:.6g} mm").format(more=-1e3 * least)
        raise MotionError("[mover]", what, more)
    return candidate


# The walking wheel: a fixed cam, a carrier of N legs with rollers, shoes that roll on the ground.
#
# The carrier turns clockwise and the hub goes to the right. The angle phi of a leg is counted from straight
# down in the sense of the carrier's turning; leg 0 stands straight down where the carrier has turned by 0,
# leg 1 comes after it. The ground is the x axis, the hub is over x = 0 then. Seen from the hub, the cam's y
# axis points down.

LEAST_LEGS, MOST_LEGS = 3, 24
PANEL = 0.1
"""Width of the panels of quadratures [rad]."""


@dataclass(frozen=True)
class WheelPose:
    """The wheel at one instant; places are in the axes of the ground, (2) [m].

    Attributes
    ----------
    turned : float [rad]
        Of the carrier.
    supporting : int
        The leg that stands on the ground; the one that comes where two do.
    angles : (legs) [rad]
        Of the legs, -pi to pi.
    hub, contact : (2)
    rollers, along, across : (legs, 2)
        Centres of the rollers; unit vectors along the legs, outwards, and across them.
    """

    turned: float
    supporting: int
    angles: Array
    hub: Array
    contact: Array
    rollers: Array
    along: Array
    across: Array

    def of_leg(self, leg: int, local: Array) -> Array:
        """Where points (n, 2) [m] in a leg's axes (across, along from its roller's centre) are."""
        return np.asarray(
            self.rollers[leg] + local[:, :1] * self.across[leg] + local[:, 1:] * self.along[leg]
        )

    def of_cam(self, places: Array) -> Array:
        """Where points (n, 2) [m] in the cam's axes are: half a turn about the hub."""
        return np.asarray(self.hub - places)


@dataclass(frozen=True, repr=False)
class WheelMover(PrintsSummary):
    """A walking wheel.

    Attributes
    ----------
    closed : ClosedPath
        Path of the rollers' centres about the hub.
    legs : int
    shoe : Shoe
    roller : float [m]
        Radius of the rollers.
    cam : Cam or None
        The description that it is the wheel of; None without one.
    """

    closed: ClosedPath
    legs: int
    shoe: Shoe
    roller: float
    cam: Cam | None = field(default=None, repr=False, compare=False)

    @property
    def half(self) -> float:
        """A leg works over +-pi/legs [rad]."""
        return math.pi / self.legs

    @property
    def height(self) -> float:
        """Of the hub [m]."""
        return self.shoe.height

    def travel(self, phi: Array) -> Array:
        """Travel of the hub [m] while the standing leg turns from 0 to phi (n) [rad], the paper's (2)."""
        phi = np.asarray(phi, dtype=np.float64)
        # the integral from 0: the series begins at the end of the arc, so its value there is taken off
        lift = self._lift.integral(np.append(phi, 0.0))
        return np.asarray(self.height * phi + (lift[:-1] - lift[-1]))

    def rate(self, phi: Array) -> Array:
        """dX/dphi (n) [m/rad] of the hub over the standing leg's angle, the paper's (5)."""
        return np.asarray(self.height + self.shoe.arc.curve.radius(phi, 1)[1] * np.sin(phi))

    def touch(self, phi: Array) -> Array:
        """Distance of the contact before the hub (n) [m]: -H' cos phi."""
        return np.asarray(-self.shoe.arc.curve.radius(phi, 1)[1] * np.cos(phi))

    @cached_property
    def step(self) -> float:
        """Travel of the hub over one leg [m]."""
        back, forth = self.travel(np.array([-self.half, self.half]))
        return float(forth - back)

    @property
    def print_length(self) -> float:
        """Length of a footprint [m], the arc of a shoe."""
        return self.step - self.print_gap

    @property
    def print_gap(self) -> float:
        """From the end of a footprint to the beginning of the next [m]; negative where they overlap."""
        first, last = self.touch(np.array([-self.half, self.half]))
        return float(first - last)

    @cached_property
    def rates(self) -> Extremes:
        """Least and greatest dX/dphi [m/rad]: how unevenly the hub travels."""

        def slope(phi: Array) -> Array:
            _radius, first, second = self.shoe.arc.curve.radius(phi, 2)
            return np.asarray(second * np.sin(phi) + first * np.cos(phi))

        return extremes(self.rate, slope, nodes_of(self.shoe.arc.edges))

    @property
    def unevenness(self) -> float:
        """Greatest over least dX/dphi."""
        return self.rates.greatest / self.rates.least

    def roller_frames(self, phi: Array) -> Frames:
        """Places of the rollers' centres around the hub, with tangent and normal of their path, at angles [rad]."""
        return frames(self.closed, phi)

    def pose(self, turned: float) -> WheelPose:
        """The wheel where the carrier has turned by an angle [rad]."""
        pitch = math.tau / self.legs
        # whole steps of legs that have stood since leg 0
        steps = math.floor((turned + self.half) / pitch)
        angles = turned - pitch * np.arange(self.legs)
        # angles of the legs from straight down, within half a turn either way
        angles = angles - math.tau * np.round(angles / math.tau)
        # by rounding the standing leg may lie a hair beyond its arc
        standing = np.clip(np.array([turned - pitch * steps]), -self.half, self.half)
        hub = np.array([steps * self.step + float(self.travel(standing)[0]), self.height])
        # straight down is -y, and legs turn clockwise
        along = np.stack([-np.sin(angles), -np.cos(angles)], axis=-1)
        across = np.stack([np.cos(angles), -np.sin(angles)], axis=-1)
        contact = np.array([hub[0] + float(self.touch(standing)[0]), 0.0])
        rollers = hub + self.closed.radius(angles)[0][:, None] * along
        return WheelPose(turned, steps % self.legs, angles, hub, contact, rollers, along, across)

    @cached_property
    def _lift(self) -> PanelSeries:
        """H' sin phi over the working arc."""
        panels = quadrature_panels(self.shoe.arc)
        slope = self.shoe.arc.curve.radius(panels.nodes, 1)[1]
        return panels.series(slope * np.sin(panels.nodes))


def quadrature_panels(arc: Arc) -> Panels:
    """Panels over an arc, ending at its breaks."""
    pieces = [
        np.linspace(low, high, 1 + max(1, math.ceil((high - low) / PANEL)))[:-1]
        for low, high in pairwise(arc.edges)
    ]
    return Panels(np.append(np.concatenate(pieces), arc.stop))


def mover(closed: ClosedPath, legs: int, post: float, roller: float) -> WheelMover:
    """A walking wheel.

    Parameters
    ----------
    closed : ClosedPath
        Its first arc is the working arc; it holds +-pi/legs.
    legs : int
        3 to 24.
    post : float [m]
        C, from the roller's centre to the ground where the leg stands upright.
    roller : float [m]
        Radius of the rollers.

    Raises
    ------
    InputError, MotionError
        Too few legs, a post not longer than the roller's radius, a working arc too short for the legs, and what
        `shoe` says.
    """
    if isinstance(legs, bool) or not LEAST_LEGS <= legs <= MOST_LEGS:
        raise InputError(
            "[mover] legs",
            ngettext("{n} leg is given", "{n} legs are given", legs).format(n=legs),
            _("give {least} to {most}").format(least=LEAST_LEGS, most=MOST_LEGS),
        )
    if not (math.isfinite(post) and post > roller):
        what = _("a post of {post:.6g} mm lets the roller of {roller:.6g} mm reach the ground").format(
            post=1e3 * post, roller=1e3 * roller
        )
        raise InputError("[mover] post", what, _("make it longer than the roller's radius"))
    working, half = closed.arcs[0], math.pi / legs
    # a leg that works at the very end of the arc may miss it by rounding
    if working.stop < half * (1 - 1e-12) or working.start > -half * (1 - 1e-12):
        what = _("the working arc extends to {asked:.6g} deg, a leg works up to {half:.6g} deg").format(
            asked=math.degrees(working.stop), half=math.degrees(half)
        )
        raise InputError("[mover] legs", what, _("use a longer working arc or more legs"))
    breaks = tuple(place for place in working.breaks if -half < place < half)
    arc = Arc("working", working.curve, -half, half, breaks)
    height = float(working.curve.radius(np.zeros(1))[0, 0]) + post
    return WheelMover(closed, legs, shoe(arc, height), roller)


SAMPLES = 181
SEARCH = 401
"""Points of a shoe among which its lowest is looked for first."""
RETURNING = 721


@dataclass(frozen=True)
class WheelRolling:
    """What was found.

    Attributes
    ----------
    level : float [m]
        Greatest departure of the hub from its height where the shoe's lowest point lies on the ground.
    slip : float
        Greatest speed of the shoe's point at the contact over the speed of the hub.
    shoe_arc, ground : float [m]
        Arc of the shoe, and what the contact travels while it rolls from end to end.
    joint : float [m/rad]
        Jump of the hub's dX/dphi where one leg takes over from another.
    clearance, clearance_at : float [m], [rad]
        Least height over the ground of a shoe that does not stand, and the leg's angle. It is zero where the leg
        leaves the ground; negative where a shoe would dig in.
    room, room_at : float [m], [rad]
        Least room between the rollers of neighbouring legs, and the angle of the first leg; negative where they
        would overlap.
    """

    level: float
    slip: float
    shoe_arc: float
    ground: float
    joint: float
    clearance: float
    clearance_at: float
    room: float
    room_at: float


def rolling(mover: WheelMover) -> WheelRolling:
    """Prove a walking wheel at 181 angles of a working leg, and 721 of one that returns or goes round."""
    phi = np.linspace(-mover.half, mover.half, SAMPLES)
    ends = mover.rate(np.array([-mover.half, mover.half]))
    arc, ground = _lengths(mover)
    clearance, at = _clearance(mover)
    return WheelRolling(
        float(np.max(np.abs(_heights(mover, phi) - mover.height))),
        float(np.max(_contact_speed(mover, phi) / mover.rate(phi))),
        arc,
        ground,
        float(ends[0] - ends[1]),
        clearance,
        at,
        *_room(mover),
    )


def profile_by_parts(mover: WheelMover, phi: Array) -> Array:
    """Points of the shoe (n, 2) [m] in the leg's axes by the paper's (8)."""
    first, second = mover.shoe.parts(phi)
    return np.stack([second * np.sin(phi), first + second * np.cos(phi)], axis=-1)


def _heights(mover: WheelMover, phi: Array) -> Array:
    """Height of the hub over the lowest point of the standing shoe, by a search among its points."""
    radius = mover.shoe.arc.curve.radius(phi)[0]

    def below(u: Array) -> Array:
        # the shoe's points as they are, without the support function: the proof shares nothing with the
        # design
        x, y = np.moveaxis(profile_by_parts(mover, u.reshape(-1)).reshape(*u.shape, 2), -1, 0)
        shape = (-1,) + (1,) * (u.ndim - 1)
        lever = radius.reshape(shape) + y
        return np.asarray(lever * np.cos(phi).reshape(shape) + x * np.sin(phi).reshape(shape))

    points = np.linspace(-mover.half, mover.half, SEARCH)
    best = np.argmax(below(np.broadcast_to(points, (len(phi), SEARCH))), axis=1)
    # about the best of the points, between its neighbours
    low, high = points[np.maximum(best - 1, 0)], points[np.minimum(best + 1, SEARCH - 1)]
    _places, lowest = maxima_between(below, low, high)
    # the point itself may be better than the interval's search by rounding
    return np.maximum(lowest, below(points[best]))


def _contact_speed(mover: WheelMover, phi: Array) -> Array:
    """Speed [m/rad] of the leg's point that is at the contact: hub, turning leg, roller that goes along it."""
    radius, slope = mover.shoe.arc.curve.radius(phi, 1)
    first, second = mover.shoe.parts(phi)
    x, y = profile_by_parts(mover, phi).T
    sine, cosine = np.sin(phi), np.cos(phi)
    hub = slope * sine + (radius + first) * cosine + second  # (3)
    # velocities by phi: of the hub, of the roller along its leg, and of the leg's turn about the roller
    forwards = hub - (slope + x) * sine - (radius + y) * cosine
    upwards = -(slope + x) * cosine + (radius + y) * sine
    return np.asarray(np.hypot(forwards, upwards))


def _lengths(mover: WheelMover) -> tuple[float, float]:
    """Arc of the shoe, from its points alone; and travel of the contact."""
    panels = quadrature_panels(mover.shoe.arc)
    points = profile_by_parts(mover, panels.nodes)
    widths = np.diff(panels.edges)[:, None]
    inner = legendre.leggauss(NODES)[0]
    rates = []
    for column in points.T:
        coefficients = panels.series(column).coefficients
        # derivatives of the series by the place within a panel, over half its width
        slopes = legendre.legder(coefficients, axis=1) * (2.0 / widths)
        rates.append(legendre.legval(inner, slopes.T))
    arc = float(np.sum(panels.weights * np.hypot(*rates).reshape(-1)))
    ends = np.array([-mover.half, mover.half])
    return arc, float(np.diff(mover.travel(ends) + mover.touch(ends))[0])


def _clearance(mover: WheelMover) -> tuple[float, float]:
    """Least height of the returning shoes over the ground, and the leg's angle."""
    phi = np.linspace(mover.half, math.tau - mover.half, RETURNING)
    x, y = profile_by_parts(mover, np.linspace(-mover.half, mover.half, SEARCH)).T
    radius = mover.closed.radius(phi)[0]
    # heights below the hub of all points of the shoe, at every angle of its leg
    levers = (radius[:, None] + y) * np.cos(phi)[:, None] + x * np.sin(phi)[:, None]
    lowest = mover.height - levers.max(axis=1)
    worst = int(np.argmin(lowest))
    return float(lowest[worst]), float(phi[worst])


def _room(mover: WheelMover) -> tuple[float, float]:
    """Least room between neighbouring rollers, and the angle of the first one's leg."""
    phi, pitch = np.linspace(-math.pi, math.pi, RETURNING), math.tau / mover.legs
    one, two = mover.closed.radius(phi)[0], mover.closed.radius(phi + pitch)[0]
    # law of cosines, with one leg along an axis
    apart = np.hypot(two * math.cos(pitch) - one, two * math.sin(pitch))
    worst = int(np.argmin(apart))
    return float(apart[worst]) - 2.0 * mover.roller, float(phi[worst])
