"""Forces between a described cam and its follower over a turn: push, normal force, torque, contact stress."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
import xarray as xr
from numpy.typing import NDArray

from centrode.cams.contact_stress import ContactMaterial, Pressed, contact_modulus, line_contact
from centrode.cams.followers.base_circle import follower_cam
from centrode.cams.followers.geometry import FollowerCam, Oscillating
from centrode.cams.roller_path import angles_of
from centrode.errors import Status
from centrode.kinematics.motion import Variable, vocabulary_variable
from centrode.kinematics.sample_index import selectable
from centrode.model.cam import Material as DescribedMaterial
from centrode.model.cam_files import AnyCam, cam_text, with_follower
from centrode.model.examples.catalogue import CamSource, cam_of
from centrode.model.follower_cam import PlateCam
from centrode.numerics.search import tops
from centrode.version import __version__

# What a follower asks of its cam: the force along its motion that accelerates it against spring and load.
#
# A translating follower counts in m, kg, N and N/m, an oscillating one in rad, kg m^2, N m and N m/rad; the
# formulas are
# the same. Angles of the cam are turned in its own sense, so that they grow with time.

Array = NDArray[np.float64]


class Lifting(Protocol):
    """A follower's motion over a turn of its cam."""

    @property
    def edges(self) -> tuple[float, ...]:
        """Angles [rad] from 0 to 2 pi between which the motion is smooth."""

    def lift(self, phi: Array, order: int = 0) -> Array:
        """Lift and its derivatives by the cam's angle (order + 1, n); at an edge those of what begins."""


@dataclass(frozen=True)
class Burden:
    """What resists a follower's motion.

    Attributes
    ----------
    inertia : float [kg, or kg m^2]
    stiffness : float [N/m, or N m/rad]
        Of the spring that presses the follower on the cam.
    preload : float [N, or N m]
        Of the spring, at lift zero.
    load : float [N, or N m]
        Constant, positive where it presses on the cam: weight, work.
    """

    inertia: float = 0.0
    stiffness: float = 0.0
    preload: float = 0.0
    load: float = 0.0

    def at_rest(self, lift: Array) -> Array:
        """What presses on the cam while nothing accelerates."""
        return self.preload + self.load + self.stiffness * lift

    def required_effort(self, rows: Array, speed: float) -> Array:
        """What the cam has to give along the motion.

        Parameters
        ----------
        rows : (3 or more, n)
            Lift and its derivatives by the cam's angle.
        speed : float [rad/s]
            Of the cam.
        """
        return np.asarray(self.at_rest(rows[0]) + self.inertia * speed**2 * rows[2])


# Extremes over a turn of a cam of what a follower's motion decides, with both sides of every edge.

OfRows = Callable[[Array], Array]
"""From lift and derivatives (3, n) to values (n)."""

NODES = 181
"""Angles of a stretch among which an extreme is looked for before it is refined."""

STEP = 1e-9
"""Slopes at an edge that differ by less, over the greatest slope, are taken for equal."""


@dataclass(frozen=True)
class ForceExtreme:
    """A greatest or least value and the angle of the cam [rad] where it is; NaN where nothing is known."""

    value: float
    angle: float


TIE = 64.0 * float(np.finfo(np.float64).eps)
"""Share by which two tops that rounding alone parts may differ."""


def greatest(motion: Lifting, value: OfRows) -> ForceExtreme:
    """The greatest value over a turn; values that are NaN do not count, NaN where there are no others.

    Every stretch is looked at by itself, its end from inside, so that what jumps at an edge counts on both sides.
    """
    return greatest_between(motion.edges, lambda phi: value(motion.lift(phi, 2)))


def greatest_between(edges: Sequence[float], value: Callable[[Array], Array]) -> ForceExtreme:
    """The greatest value of a function of angles (n) [rad], smooth between edges, as `greatest`."""
    best = ForceExtreme(math.nan, edges[0])
    for start, stop in pairwise(edges):
        places, values = tops(value, np.linspace(start, inside(start, stop), NODES), most=1)
        # of tops that are equal to rounding, as a rise and its mirrored return have them, the first counts
        if places.size and not values[0] <= best.value + TIE * abs(best.value):
            best = ForceExtreme(float(values[0]), float(places[0]))
    return best


def least(motion: Lifting, value: OfRows) -> ForceExtreme:
    """The least value over a turn, as `greatest`."""
    found = greatest(motion, lambda rows: -value(rows))
    return ForceExtreme(0.0 - found.value, found.angle)  # no zero below zero


def slope_drops(motion: Lifting) -> list[float]:
    """Edges [rad] at which the slope of the lift falls by a step: no spring keeps the contact there."""
    starts = np.array(motion.edges[:-1])
    ends = np.array([inside(start, stop) for start, stop in pairwise(motion.edges)])
    after = motion.lift(starts, 1)[1]
    before = np.roll(motion.lift(ends, 1)[1], 1)
    scale = greatest(motion, lambda rows: np.abs(rows[1])).value
    return [float(at) for at, step in zip(starts, after - before, strict=True) if step < -STEP * scale]


def inside(start: float, stop: float) -> float:
    """The end of a stretch, seen from inside: at the edge itself holds what begins there."""
    return float(np.nextafter(stop, start))


# Springs that keep a follower on its cam, and the speed at which it jumps.

LOWEST = 1e-12
"""Share of the greatest lift below which the follower counts as down: a spring's stiffness does nothing there."""


def least_push(motion: Lifting, burden: Burden, speed: float) -> ForceExtreme:
    """The least force along the motion over a turn, and where: below zero the contact is lost.

    Minus infinity where the slope of the lift falls by a step while there is inertia and speed.
    """
    drops = slope_drops(motion) if burden.inertia and speed else []
    if drops:
        return ForceExtreme(-math.inf, drops[0])
    return least(motion, lambda rows: burden.required_effort(rows, speed))


def jump_speed(motion: Lifting, burden: Burden) -> ForceExtreme:
    """The speed of the cam [rad/s] above which the follower leaves it, and the angle where it does.

    Infinite where it never does, with NaN for the angle; zero where it does at once.
    """
    rest = least(motion, lambda rows: burden.at_rest(rows[0]))
    if rest.value < 0:
        return ForceExtreme(0.0, rest.angle)
    if not burden.inertia:
        return ForceExtreme(math.inf, math.nan)
    drops = slope_drops(motion)
    if drops:
        return ForceExtreme(0.0, drops[0])

    def inverse_square(rows: Array) -> Array:
        """1/speed^2 of losing contact; below zero or NaN where it is not lost at any speed."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(-burden.inertia * rows[2] / burden.at_rest(rows[0]))

    worst = greatest(motion, inverse_square)
    if not worst.value > 0:
        return ForceExtreme(math.inf, math.nan)
    return ForceExtreme(1 / math.sqrt(worst.value), worst.angle)


def preload_needed(motion: Lifting, burden: Burden, speed: float, push: float = 0.0) -> ForceExtreme:
    """The preload of a spring of the burden's stiffness that leaves at least a push [N, or N m] at a speed [rad/s].

    Infinite where no spring does; below zero where the rest of the burden presses more than is needed.
    """
    found = least_push(motion, replace(burden, preload=0.0), speed)
    return ForceExtreme(push - found.value, found.angle)


def stiffness_needed(motion: Lifting, burden: Burden, speed: float, push: float = 0.0) -> ForceExtreme:
    """The stiffness of a spring of the burden's preload that leaves at least a push [N, or N m] at a speed [rad/s].

    Infinite where none does, because too little presses while the follower is down; zero where none is needed.
    """
    plain = replace(burden, stiffness=0.0)
    drops = slope_drops(motion) if burden.inertia and speed else []
    if drops:
        return ForceExtreme(math.inf, drops[0])
    high = greatest(motion, lambda rows: np.abs(rows[0])).value

    def lacking(rows: Array) -> Array:
        return push - plain.required_effort(rows, speed)

    def when_down(rows: Array) -> Array:
        return np.where(rows[0] <= LOWEST * high, lacking(rows), np.nan)

    def by_lift(rows: Array) -> Array:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(rows[0] > LOWEST * high, lacking(rows) / rows[0], np.nan)

    down = greatest(motion, when_down)
    if down.value > 0:
        return ForceExtreme(math.inf, down.angle)
    found = greatest(motion, by_lift)
    return found if found.value > 0 else ForceExtreme(0.0, math.nan)


# Where cam and follower touch, which way they push each other, and the torque that this takes.
#
# Everything stands in the follower's frame, the cam's axis at the origin. A translating follower moves along
# y at
# x = offset; an oscillating one has its pivot at (distance, 0) and its arm above, so that it lifts clockwise.
# The cam
# turns counter-clockwise (sense +1) or clockwise (-1). Directions follow from the instant centre, which lies
# on the
# normal: nothing is taken from the profile.


@dataclass(frozen=True)
class Meeting:
    """Cam and follower at angles of the cam.

    Attributes
    ----------
    place : (n, 2) [m]
        Where the force acts: the contact, of a roller its centre.
    normal : (n, 2)
        From the cam to the follower.
    slip : (n, 2)
        Direction in which the cam's surface slides on the follower; zero under a roller.
    lever : (n, 2)
        What a force of one along x or y does along the follower's motion [1, or m].
    sense : +1.0 or -1.0
        Of the cam's turning, counter-clockwise positive.
    """

    place: Array
    normal: Array
    slip: Array
    lever: Array
    sense: float

    def directions(self, flank: Array, friction: float = 0.0) -> Array:
        """The force on the follower by a normal force of one (n, 2), with friction by a coefficient.

        `flank` (n) has the sign of the normal force. On the other flank of a groove it is negative, but the cam's
        surface drags the follower the same way: friction turns round in relation to it.
        """
        return self.normal + friction * np.where(flank < 0, -1.0, 1.0)[:, None] * self.slip

    def share(self, flank: Array, friction: float = 0.0) -> Array:
        """What a normal force of one does along the motion [1, or m]; zero or less where friction holds it fast."""
        return np.asarray(np.sum(self.lever * self.directions(flank, friction), axis=1))

    def normal_force(self, push: Array, friction: float = 0.0) -> Array:
        """Normal force [N] that gives a push [N, or N m] along the motion.

        Infinite with the push's sign where friction lets no force along the normal move the follower.
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            share = self.share(push, friction)
            return np.asarray(np.where(share > 0, push / share, np.copysign(np.inf, push)))

    def torque(self, force: Array, friction: float = 0.0) -> Array:
        """Torque [N m] that drives the cam against a normal force [N], positive along its turning."""
        along = self.directions(force, friction)
        moment = self.place[:, 0] * along[:, 1] - self.place[:, 1] * along[:, 0]
        return np.asarray(self.sense * force * moment)


def on_centre(rows: Array, offset: float, rise: float, sense: float, rolling: bool) -> Meeting:
    """A translating follower whose roller's centre, or edge, is led through (offset, rise) at lift zero [m]."""
    height = rise + rows[0]
    place = np.stack([np.full_like(height, offset), height], axis=1)
    normal = _unit(np.stack([offset - sense * rows[1], height], axis=1))
    slip = np.zeros_like(normal) if rolling else sense * _quarter_turn(normal)
    return Meeting(place, normal, slip, _along_y(height), sense)


def on_face(rows: Array, base: float, sense: float) -> Meeting:
    """A translating follower with a flat face square to its motion, over a base circle [m]."""
    height = base + rows[0]
    place = np.stack([sense * rows[1], height], axis=1)
    normal = _along_y(height)
    return Meeting(place, normal, sense * _quarter_turn(normal), normal, sense)


def on_arm(rows: Array, arm: float, distance: float, start: float, sense: float, rolling: bool) -> Meeting:
    """An oscillating follower with a roller's centre, or an edge, at the end of its arm.

    Parameters
    ----------
    rows : (2 or more, n) [rad]
    arm, distance : float [m]
        Length of the arm, distance of the pivot from the cam's axis.
    start : float [rad]
        Angle between the arm and the line to the cam's axis at lift zero.
    sense : +1.0 or -1.0
    rolling : bool
        Whether a roller touches the cam.
    """
    angle = math.pi - (start + rows[0])
    reach = arm * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    place = reach + np.array([distance, 0.0])
    ray = _unit(_from_pole(place, rows, distance, sense))
    slip = np.zeros_like(ray) if rolling else sense * _quarter_turn(ray)
    return Meeting(place, _turned_out(ray, reach), slip, _unit_force_moments(reach), sense)


def on_turning_face(rows: Array, distance: float, start: float, shift: float, sense: float) -> Meeting:
    """An oscillating follower with a flat face.

    Parameters
    ----------
    rows : (2 or more, n) [rad]
    distance : float [m]
        Of the pivot from the cam's axis.
    start : float [rad]
        Angle between the face and the line to the cam's axis at lift zero.
    shift : float [m]
        Of the face from the pivot, positive towards the cam.
    sense : +1.0 or -1.0
    """
    angle = math.pi - (start + rows[0])
    along = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    normal = -_quarter_turn(along)
    foot = np.array([distance, 0.0]) - shift * normal
    turn = sense * rows[1]
    pole = np.stack([distance * turn / (1 + turn), np.zeros_like(turn)], axis=1)
    place = foot + along * np.sum((pole - foot) * along, axis=1, keepdims=True)
    above = np.sign(np.sum(normal * _from_pole(place, rows, distance, sense), axis=1, keepdims=True))
    reach = place - np.array([distance, 0.0])
    return Meeting(place, normal, sense * above * _quarter_turn(normal), _unit_force_moments(reach), sense)


def _from_pole(place: Array, rows: Array, distance: float, sense: float) -> Array:
    """From the instant centre to a place, by a factor that keeps it finite where the centre is far away.

    The centre lies on the line of the axes, where cam and follower have one velocity.
    """
    turn = sense * rows[1]
    return np.stack([place[:, 0] * (1 + turn) - distance * turn, place[:, 1] * (1 + turn)], axis=1)


def _turned_out(normal: Array, reach: Array) -> Array:
    """The normal in the sense that lifts the follower."""
    lifts = np.sum(normal * _unit_force_moments(reach), axis=1, keepdims=True)
    return np.where(lifts < 0, -normal, normal)


def _unit_force_moments(reach: Array) -> Array:
    """What forces of one along x and y do clockwise about the pivot, at a reach from it."""
    return np.stack([reach[:, 1], -reach[:, 0]], axis=1)


def _along_y(height: Array) -> Array:
    return np.stack([np.zeros_like(height), np.ones_like(height)], axis=1)


def _quarter_turn(vectors: Array) -> Array:
    """Vectors turned by a quarter counter-clockwise: the way the surface of a cam that turns so slides."""
    return np.stack([-vectors[:, 1], vectors[:, 0]], axis=1)


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))


# How the follower of a cam's body meets it.


def meeting_of(body: FollowerCam, rows: Array) -> Meeting:
    """Where the cam touches the follower and which way they push, for a lift with its slope (2 or more, n)."""
    guide, roller, sense = body.guide, body.touch.roller, body.sense
    flat, rolling = math.isinf(roller), roller > 0.0
    if isinstance(guide, Oscillating):
        if flat:
            return on_turning_face(rows, guide.distance, guide.start, guide.face_offset, sense)
        return on_arm(rows, guide.arm, guide.distance, guide.start, sense, rolling)
    if flat:
        return on_face(rows, guide.start, sense)
    return on_centre(rows, guide.offset, guide.start, sense, rolling)


@dataclass(frozen=True)
class ActingForces:
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

    def at(self, phi: Array) -> ActingForces:
        """Forces at angles (n) [rad]."""
        rows = self.body.motion.lift(phi, 2)
        push = self.burden.required_effort(rows, self.speed)
        met = meeting_of(self.body, rows)
        kept = push if self.led else np.where(push >= 0, push, np.nan)
        force = met.normal_force(kept, self.friction)
        normal = np.where(np.isfinite(force), force, np.nan)
        return ActingForces(phi, push, normal, met.torque(normal, self.friction), self._strip(phi, normal))

    def _strip(self, phi: Array, normal: Array) -> Pressed | None:
        """The strip of contact, where width and materials are known; a knife edge has none."""
        if self.width is None or self.modulus is None or self.body.touch.roller == 0.0:
            return None
        curvature = 1.0 / self.body.touch.roller + self.body.contact(phi).curvature
        return line_contact(np.abs(normal) / self.width, curvature, self.modulus)

    @cached_property
    def greatest_normal(self) -> ForceExtreme:
        """The greatest normal force [N] and where [rad]; infinite where friction locks."""
        return self.self_locking or self._greatest(lambda one: np.abs(one.normal))

    @cached_property
    def greatest_torque(self) -> ForceExtreme:
        """The greatest torque [N m] and where [rad]; infinite where friction locks."""
        return self.self_locking or self._greatest(lambda one: one.torque)

    @cached_property
    def least_torque(self) -> ForceExtreme:
        """The least torque [N m] and where [rad]: below zero the follower drives the cam."""
        found = self._greatest(lambda one: -one.torque)
        return ForceExtreme(0.0 - found.value, found.angle)  # no zero below zero

    @cached_property
    def greatest_stress(self) -> ForceExtreme:
        """The greatest contact stress [Pa] and where [rad]; NaN where it is not known.

        Of a profile that is undercut it is not: towards a cusp the stress has no bound, and behind it no meaning.
        """
        if self.width is None or self.modulus is None or self.body.touch.roller == 0.0 or self.body.undercuts:
            return ForceExtreme(math.nan, math.nan)
        return self.self_locking or self._greatest(lambda one: _pressure(one.strip, one.phi))

    @cached_property
    def self_locking(self) -> ForceExtreme | None:
        """An infinite force, and where [rad] friction holds the follower fastest; None where it moves all the way."""
        if not self.friction:
            return None

        def held(phi: Array) -> Array:
            rows = self.body.motion.lift(phi, 2)
            push = self.burden.required_effort(rows, self.speed)
            share = meeting_of(self.body, rows).share(push, self.friction)
            return np.where((push > 0) | self.led, -share, np.nan)

        worst = greatest_between(self.body.edges, held)
        return ForceExtreme(math.inf, worst.angle) if worst.value >= 0 else None

    def _greatest(self, value: Callable[[ActingForces], Array]) -> ForceExtreme:
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


def _material(given: DescribedMaterial) -> ContactMaterial:
    return ContactMaterial(given.elasticity, given.poisson)


def _pressure(strip: Pressed | None, phi: Array) -> Array:
    return np.full(phi.shape, np.nan) if strip is None else strip.pressure


# Forces between cam and follower as a labelled result.


def cam_forces(cam: CamSource, samples: int | None = None, at: npt.ArrayLike | None = None) -> xr.Dataset:
    """Forces between a cam and its follower over a turn.

    Parameters
    ----------
    cam : PlateCam
        With `base_radius` or `[bounds]`; without `speed` the forces are those at rest.
    samples : int
        Evenly spaced over a turn, both ends included; the description's own number, else 361.
    at : (n,) angles of the cam [rad]
        Exactly these places instead.

    Returns
    -------
    Dataset
        Along `sample`, over `cam_angle`: the push along the follower's motion (`follower_push` [N], of an oscillating
        follower `follower_moment` [N m]), `contact_force` along the normal, `cam_torque`; with width and materials
        also the stress, the half width, the shear and its depth (docs: cam mechanisms). Where the contact is lost
        samples are open, where friction locks they are singular; both are NaN but for the push. Attributes hold what
        `FollowerForces` and `keeping` find over the whole turn.

    Raises
    ------
    InputError
        As `follower_cam`.

    Examples
    --------
    >>> import centrode as ct
    >>> forces = ct.cam_forces(ct.example("valve-cam"), 37)
    >>> print(ct.summary(forces).splitlines()[3])
    contact of cam and follower  kept: at least 180 N along the follower at 0 deg
    """
    cam = cam_of(cam)
    plate = with_follower(cam)
    return dataset_of_forces(plate, follower_forces(plate), angles_of(plate, samples, at))


def dataset_of_forces(cam: PlateCam, forces: FollowerForces, phi: Array) -> xr.Dataset:
    """The labelled forces at angles of the cam [rad]."""
    found = forces.at(phi)
    push = "follower_moment" if cam.swings else "follower_push"
    values = {push: found.push, "contact_force": found.normal, "cam_torque": found.torque}
    if found.strip is not None:
        values |= {
            "contact_stress": found.strip.pressure,
            "contact_shear": found.strip.shear,
            "contact_depth": found.strip.depth,
            "contact_half_width": found.strip.half_width,
        }
    data = {name: vocabulary_variable(name, ("sample",), one) for name, one in values.items()}
    data["status"] = _status(forces, found)
    coordinates = {"cam_angle": vocabulary_variable("cam_angle", ("sample",), phi)}
    return selectable(xr.Dataset(data, coords=coordinates, attrs=_facts(cam, forces)))


def _status(forces: FollowerForces, found: ActingForces) -> Variable:
    lost = (found.push < 0) & (not forces.led)
    status = np.where(np.isnan(found.normal), np.int8(Status.SINGULAR), np.int8(Status.OK))
    status = np.where(lost, np.int8(Status.OPEN), status).astype(np.int8)
    dimensions, values, attributes = vocabulary_variable("status", ("sample",), status)
    attributes["flag_values"] = np.array([s.value for s in Status], dtype=np.int8)
    attributes["flag_meanings"] = " ".join(s.name.lower() for s in Status)
    return dimensions, values, attributes


def _facts(cam: PlateCam, forces: FollowerForces) -> dict[str, Any]:
    motion, burden = forces.body.motion, forces.burden
    extremes = {
        "least_push": least_push(motion, burden, forces.speed),
        "jump_speed": jump_speed(motion, burden),
        "preload_needed": preload_needed(motion, burden, forces.speed),
        "stiffness_needed": stiffness_needed(motion, burden, forces.speed),
        "greatest_force": forces.greatest_normal,
        "greatest_torque": forces.greatest_torque,
        "least_torque": forces.least_torque,
    }
    if forces.modulus is not None and forces.width is not None:
        extremes["greatest_stress"] = forces.greatest_stress
    facts: dict[str, Any] = {"topic": "follower-forces", "title": cam.title, "cam": cam_text(cam)}
    facts |= {"version": __version__, "speed": forces.speed, "led": int(forces.led)}
    for name, one in extremes.items():
        facts |= {name: one.value, f"{name}_at": one.angle}
    if cam.bounds.stress is not None:
        facts["admissible_stress"] = cam.bounds.stress
    facts["works_difference"] = works_difference(forces)
    return facts


def works_difference(forces: FollowerForces) -> float:
    """By how much [N m] the torque of the normal force departs from that of virtual work; NaN with friction."""
    if forces.friction:
        return math.nan
    phi = np.linspace(0.0, math.tau, 361)
    found = forces.at(phi)
    apart = np.abs(found.torque - found.push * forces.body.motion.lift(phi, 1)[1])
    return float(np.nanmax(apart)) if np.isfinite(apart).any() else math.nan
