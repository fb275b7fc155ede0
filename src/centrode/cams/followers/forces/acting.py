"""Forces between a described cam and its follower over a turn: push, normal force, torque, contact stress."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from centrode.cams.contacts.line import Material, Pressed, contact_modulus, line_contact
from centrode.cams.followers.bodies import FollowerCam
from centrode.cams.followers.described import follower_cam
from centrode.cams.followers.forces.cycle import Extreme, greatest_between
from centrode.cams.followers.forces.demand import Burden
from centrode.cams.followers.forces.meeting_of import meeting_of
from centrode.model.cams.files import AnyCam, with_follower
from centrode.model.cams.parts import Material as DescribedMaterial
from centrode.model.cams.plate import PlateCam

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Forces:
    """Forces at angles (n) of the cam.

    Attributes
    ----------
    phi : (n) [rad]
    push : (n) [N], of an oscillating follower [N m]
        Along the follower's motion; below zero the contact is lost where the follower is not led both ways.
    normal : (n) [N]
        Along the normal; NaN where the contact is lost or friction locks.
    torque : (n) [N m]
        That drives the cam, positive along its turning; NaN as `normal`.
    strip : Pressed or None
        The strip of contact; NaN where the profile is undercut.
    """

    phi: Array
    push: Array
    normal: Array
    torque: Array
    strip: Pressed | None


@dataclass(frozen=True)
class FollowerForces:
    """What acts between a cam and its follower.

    Attributes
    ----------
    body : FollowerCam
    burden : Burden
    speed : float [rad/s]
        Of the cam; zero: at rest.
    friction : float
        Coefficient between cam and follower; a roller rolls without.
    width : float [m] or None
        Of the strip of contact.
    modulus : float [Pa] or None
        Of the contact.
    led : bool
        Whether the cam leads the follower both ways, as nothing presses it on the cam.
    """

    body: FollowerCam
    burden: Burden
    speed: float
    friction: float = 0.0
    width: float | None = None
    modulus: float | None = None
    led: bool = False

    def at(self, phi: Array) -> Forces:
        """Forces at angles (n) [rad]."""
        rows = self.body.motion.lift(phi, 2)
        push = self.burden.needed(rows, self.speed)
        met = meeting_of(self.body, rows)
        kept = push if self.led else np.where(push >= 0, push, np.nan)
        force = met.normal_force(kept, self.friction)
        normal = np.where(np.isfinite(force), force, np.nan)
        return Forces(phi, push, normal, met.torque(normal, self.friction), self._strip(phi, normal))

    def _strip(self, phi: Array, normal: Array) -> Pressed | None:
        """The strip of contact, where width and materials are known; a knife edge has none."""
        if self.width is None or self.modulus is None or self.body.touch.roller == 0.0:
            return None
        curvature = 1.0 / self.body.touch.roller + self.body.contact(phi).curvature
        return line_contact(np.abs(normal) / self.width, curvature, self.modulus)

    @cached_property
    def greatest_normal(self) -> Extreme:
        """The greatest normal force [N] and where [rad]; infinite where friction locks."""
        return self.locked or self._greatest(lambda one: np.abs(one.normal))

    @cached_property
    def greatest_torque(self) -> Extreme:
        """The greatest torque [N m] and where [rad]; infinite where friction locks."""
        return self.locked or self._greatest(lambda one: one.torque)

    @cached_property
    def least_torque(self) -> Extreme:
        """The least torque [N m] and where [rad]: below zero the follower drives the cam."""
        found = self._greatest(lambda one: -one.torque)
        return Extreme(0.0 - found.value, found.angle)  # no zero below zero

    @cached_property
    def greatest_stress(self) -> Extreme:
        """The greatest contact stress [Pa] and where [rad]; NaN where it is not known.

        Of a profile that is undercut it is not: towards a cusp the stress has no bound, and behind it no meaning.
        """
        if self.width is None or self.modulus is None or self.body.touch.roller == 0.0 or self.body.undercuts:
            return Extreme(math.nan, math.nan)
        return self.locked or self._greatest(lambda one: _pressure(one.strip, one.phi))

    @cached_property
    def locked(self) -> Extreme | None:
        """An infinite force, and where [rad] friction holds the follower fastest; None where it moves all the way."""
        if not self.friction:
            return None

        def held(phi: Array) -> Array:
            rows = self.body.motion.lift(phi, 2)
            push = self.burden.needed(rows, self.speed)
            share = meeting_of(self.body, rows).share(push, self.friction)
            return np.where((push > 0) | self.led, -share, np.nan)

        worst = greatest_between(self.body.edges, held)
        return Extreme(math.inf, worst.angle) if worst.value >= 0 else None

    def _greatest(self, value: Callable[[Forces], Array]) -> Extreme:
        return greatest_between(self.body.edges, lambda phi: value(self.at(phi)))


def follower_forces(cam: AnyCam) -> FollowerForces:
    """What acts between the cam and the follower of a description.

    Parameters
    ----------
    cam : PlateCam

    Raises
    ------
    InputError
        As `follower_cam`.
    """
    plate = with_follower(cam)
    follower = plate.follower
    led = follower.spring is None and not follower.load
    friction = 0.0 if follower.contact == "roller" else follower.friction
    return FollowerForces(
        follower_cam(plate),
        burden_of(plate),
        plate.body.speed or 0.0,
        friction,
        plate.body.thickness,
        _modulus(plate),
        led,
    )


def burden_of(cam: PlateCam) -> Burden:
    """What resists the motion of a described follower."""
    follower, spring = cam.follower, cam.follower.spring
    inertia = follower.inertia if cam.swings else follower.mass
    stiffness, preload = (0.0, 0.0) if spring is None else (spring.stiffness, spring.preload)
    return Burden(inertia or 0.0, stiffness, preload, follower.load)


def _modulus(cam: PlateCam) -> float | None:
    """Contact modulus [Pa]; one material that is not given is the other's."""
    first, second = cam.body.material, cam.follower.material
    given = first or second
    if given is None:
        return None
    return contact_modulus(_material(first or given), _material(second or given))


def _material(given: DescribedMaterial) -> Material:
    return Material(given.elasticity, given.poisson)


def _pressure(strip: Pressed | None, phi: Array) -> Array:
    return np.full(phi.shape, np.nan) if strip is None else strip.pressure
