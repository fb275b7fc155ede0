"""The walking wheel: a fixed cam, a carrier of N legs with rollers, shoes that roll on the ground.

The carrier turns clockwise and the hub goes to the right. The angle phi of a leg is counted from straight down in the
sense of the carrier's turning; leg 0 stands straight down where the carrier has turned by 0, leg 1 comes after it. The
ground is the x axis, the hub is over x = 0 then. Seen from the hub, the cam's y axis points down.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from centrode.cams.closed.arcs import Arc, ClosedPath
from centrode.cams.frames import Array
from centrode.cams.nodes import nodes_of
from centrode.cams.wheel.shoe import Shoe, shoe
from centrode.dynamics.steady_motion.cycle import Panels, PanelSeries
from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.search import Extremes, extremes

LEAST_LEGS, MOST_LEGS = 3, 24
PANEL = 0.1
"""Width of the panels of quadratures [rad]."""


@dataclass(frozen=True)
class Pose:
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


@dataclass(frozen=True)
class Mover:
    """A walking wheel.

    Attributes
    ----------
    closed : ClosedPath
        Path of the rollers' centres about the hub.
    legs : int
    shoe : Shoe
    roller : float [m]
        Radius of the rollers.
    """

    closed: ClosedPath
    legs: int
    shoe: Shoe
    roller: float

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
        lift = self._lift.integral(np.append(phi, 0.0))
        return np.asarray(self.height * phi + (lift[:-1] - lift[-1]))

    def rate(self, phi: Array) -> Array:
        """dX/dphi (n) [m/rad] of the hub over the standing leg's angle, the paper's (5)."""
        return np.asarray(self.height + self.shoe.arc.curve.radius(phi, 1)[1] * np.sin(phi))

    def touch(self, phi: Array) -> Array:
        """How far the contact lies before the hub (n) [m]: -H' cos phi."""
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

    def pose(self, turned: float) -> Pose:
        """The wheel where the carrier has turned by an angle [rad]."""
        pitch = math.tau / self.legs
        steps = math.floor((turned + self.half) / pitch)
        angles = turned - pitch * np.arange(self.legs)
        angles = angles - math.tau * np.round(angles / math.tau)
        standing = np.clip(np.array([turned - pitch * steps]), -self.half, self.half)
        hub = np.array([steps * self.step + float(self.travel(standing)[0]), self.height])
        along = np.stack([-np.sin(angles), -np.cos(angles)], axis=-1)
        across = np.stack([np.cos(angles), -np.sin(angles)], axis=-1)
        contact = np.array([hub[0] + float(self.touch(standing)[0]), 0.0])
        rollers = hub + self.closed.radius(angles)[0][:, None] * along
        return Pose(turned, steps % self.legs, angles, hub, contact, rollers, along, across)

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


def mover(closed: ClosedPath, legs: int, post: float, roller: float) -> Mover:
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
            _("{legs} legs were asked for").format(legs=legs),
            _("ask for {least} to {most}").format(least=LEAST_LEGS, most=MOST_LEGS),
        )
    if not (math.isfinite(post) and post > roller):
        what = _("a post of {post:.6g} mm lets the roller of {roller:.6g} mm reach the ground").format(
            post=1e3 * post, roller=1e3 * roller
        )
        raise InputError("[mover] post", what, _("make it longer than the roller's radius"))
    working, half = closed.arcs[0], math.pi / legs
    if working.stop < half * (1 - 1e-12) or working.start > -half * (1 - 1e-12):
        what = _("the working arc goes to {asked:.6g} deg, a leg works to {half:.6g} deg").format(
            asked=math.degrees(working.stop), half=math.degrees(half)
        )
        raise InputError("[mover] legs", what, _("take a longer working arc or more legs"))
    breaks = tuple(one for one in working.breaks if -half < one < half)
    arc = Arc("working", working.curve, -half, half, breaks)
    height = float(working.curve.radius(np.zeros(1))[0, 0]) + post
    return Mover(closed, legs, shoe(arc, height), roller)
