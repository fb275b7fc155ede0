"""Friction at the samples of a motion: as great as reactions make it that depend on it themselves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from math import pi
from typing import Any, TypeAlias, assert_never

import numpy as np
import numpy.typing as npt

from centrode.dynamics.kinetostatics.equations import ForceSystem, Kinetostatics
from centrode.dynamics.kinetostatics.joints import JointSide, column, side_forces
from centrode.dynamics.kinetostatics.radial_forces import radial_force_on, tooth_senses
from centrode.dynamics.load_coordinates import Slide, Turn, place_of
from centrode.dynamics.loads import REST, AppliedLoad, Constant, Friction, LoadTerm, MassesAndLoads, Square
from centrode.dynamics.reduction import Reducer
from centrode.dynamics.state import State
from centrode.dynamics.wrenches import Wrench, couple
from centrode.errors import InputError, NotComputedYet
from centrode.geometry.plane import rotate_vector
from centrode.kinematics.preparation import Ready
from centrode.locale import _
from centrode.model.loads import BearingFriction, CoefficientFriction, SliderFriction
from centrode.model.mechanism import FRAME, Mechanism
from centrode.structure.constraints import Constraint, NoTurning, PointOnGuide

# Where parts rub on each other: bearings on the pins of hinges, sliders in guides.

FITS = {"clearance": 1.0, "new": pi / 2.0, "worn-in": 4.0 / pi}
"""Moment of friction over coefficient, radius and load of the pin, by how the bearing fits."""


@dataclass(frozen=True)
class HingeBearing:
    """A link that turns on a pin; the pin is fixed in another body.

    Attributes
    ----------
    coefficient : of the moment, the fit in it
    where : what messages name it by
    static : the same of what sticks
    """

    point: str
    link: str
    pin: str
    coefficient: float
    radius: float
    where: str
    static: float = 0.0

    @property
    def label(self) -> str:
        """Name of the joint in results, "point/link" as that of the side."""
        return f"{self.point}/{self.link}"

    @property
    def pressed_by(self) -> tuple[str, ...]:
        """Reactions that its friction depends on."""
        return ("joint_force",)

    @property
    def motion(self) -> Turn:
        """Coordinate along which friction works: turning of the link against the pin."""
        return Turn(self.link, self.pin)


@dataclass(frozen=True)
class Sliding:
    """A slider or a pin that moves along a guide.

    Attributes
    ----------
    link : the slider; None where the point itself slides
    length, height : of the slider along and across the guide [m]; 0 where they do not matter
    static : coefficient of what sticks
    surface_speed : of a belt along the guide [m/s]
    """

    guide: str
    link: str | None
    on: str
    coefficient: float
    length: float
    height: float
    where: str
    static: float = 0.0
    surface_speed: float = 0.0

    @property
    def label(self) -> str:
        """Name of the joint in results, "guide C"."""
        return f"guide {self.guide}"

    @property
    def pressed_by(self) -> tuple[str, ...]:
        """Reactions that its friction depends on."""
        return ("guide_normal", "guide_moment") if self.length else ("guide_normal",)

    @property
    def motion(self) -> Slide:
        """Coordinate along which friction works: displacement along the guide."""
        return Slide(self.guide)


Contact: TypeAlias = HingeBearing | Sliding


def contacts_of(mechanism: Mechanism) -> tuple[Contact, ...]:
    """Contacts with friction by a coefficient, in the order of the loads.

    Raises InputError for a hinge that is none, a pin in a body that is not there, a slider that is no link, and for a
    contact that is given twice; NotComputedYet on the sphere.
    """
    by_label: dict[str, Contact] = {}
    for load in mechanism.loads:
        if not isinstance(load, CoefficientFriction):
            continue
        where = f"[[loads]] {load.label}"
        if mechanism.space == "sphere":
            what = _("Coulomb friction is available for planar mechanisms only")
            raise NotComputedYet(where, what, _("give the value of the friction, or omit it"))
        for contact in _contacts(mechanism, load, where):
            if contact.label in by_label:
                what = _("friction at {contact} is given twice").format(contact=contact.label)
                raise InputError(where, what, _("keep one of them"))
            by_label[contact.label] = contact
    return tuple(by_label.values())


def _contacts(mechanism: Mechanism, load: CoefficientFriction, where: str) -> Sequence[Contact]:
    match load:
        case BearingFriction():
            return _bearings(mechanism, load, where)
        case SliderFriction():
            return [_sliding_friction(mechanism, load, where)]
        case _:
            assert_never(load)


def without_friction(mechanism: Mechanism) -> Mechanism:
    """The mechanism without friction by coefficients."""
    loads = tuple(load for load in mechanism.loads if not isinstance(load, CoefficientFriction))
    return mechanism.model_copy(update={"loads": loads})


def refuse_undetermined(
    contacts: Sequence[Contact], undetermined: Mapping[str, Any], sides: Sequence[Any], mechanism: Mechanism
) -> None:
    """Raise InputError where friction depends on a reaction that nothing determines.

    `undetermined` tells of each kind of reaction which entries that is, in the order of `sides` and guides.
    """
    labels = [side.label for side in sides]
    guides = [guide.id for guide in mechanism.guides]
    for contact in contacts:
        row = (
            labels.index(contact.label) if isinstance(contact, HingeBearing) else guides.index(contact.guide)
        )
        parts = contact.pressed_by
        if any(part in undetermined and undetermined[part][row].any() for part in parts):
            what = _("friction at {contact} depends on a reaction that the constraints do not determine")
            repair = _("omit a redundant constraint, or the friction there")
            raise InputError(contact.where, what.format(contact=contact.label), repair)


def _sliding_friction(mechanism: Mechanism, load: SliderFriction, where: str) -> Sliding:
    guide = mechanism.guide(load.guide)
    if guide.link is None and (load.length or load.height):
        what = _("guide {guide} has no slider of its own that could tilt").format(guide=guide.id)
        raise InputError(where, what, _("remove length and height, or give the guide a link"))
    length, height = load.length or 0.0, load.height or 0.0
    return Sliding(
        guide.id,
        guide.link,
        guide.on,
        load.coefficient,
        length,
        height,
        where,
        load.greatest_coefficient,
        load.surface_speed,
    )


def _bearings(mechanism: Mechanism, load: BearingFriction, where: str) -> list[HingeBearing]:
    point = load.point
    bodies = _bodies(mechanism, point)
    if len(bodies) < 2:
        what = _("{point} is not a hinge: no link turns about it").format(point=point)
        raise InputError(where, what, _("name a point in which links are hinged together"))
    for key, name in (("link", load.link), ("pin", load.pin)):
        if name is not None and name not in bodies:
            what = _("{key} {name} has no hinge in {point}").format(key=key, name=name, point=point)
            raise InputError(where, what, _("use one of {known}").format(known=", ".join(bodies)))
    carrier = _carrier(mechanism, point)
    pin = load.pin or carrier or bodies[0]
    if carrier not in (None, pin):
        text = _("the pin {point} is fixed in the frame")
        text = (
            text
            if point in mechanism.frame.points
            else _("the pin {point} is fixed in the slider of its guide")
        )
        raise InputError(where, text.format(point=point), _("remove pin"))
    links = [name for name in bodies if name != pin]
    if load.link is not None:
        if load.link == pin:
            what = _("the pin {point} is fixed in {link}, which therefore does not rub on it")
            raise InputError(
                where, what.format(point=point, link=pin), _("name another link, or another pin")
            )
        links = [load.link]
    # the fit is a factor of the moment, so it goes into the coefficient
    coefficient, static = load.coefficient * FITS[load.fit], load.greatest_coefficient * FITS[load.fit]
    return [HingeBearing(point, link, pin, coefficient, load.radius, where, static) for link in links]


def _bodies(mechanism: Mechanism, point: str) -> list[str]:
    """Bodies hinged in a point: the frame, or what carries the guide of a slider without a link; then links."""
    links = [name for name, link in mechanism.links.items() if point in link.coordinates]
    carrier = _carrier(mechanism, point)
    return links if carrier is None else [carrier, *(name for name in links if name != carrier)]


def _carrier(mechanism: Mechanism, point: str) -> str | None:
    """The body that a pin cannot turn against: the frame, or that of the guide in which its slider moves."""
    if point in mechanism.frame.points:
        return FRAME
    return next((guide.on for guide in mechanism.guides if guide.point == point and not guide.link), None)


# How great friction is where it depends on reactions that depend on it: f = c |R(f)|, at many positions.
#
# The reactions are straight in the sizes f of friction, R(f) = R_0 + G f. The solution that counts is the one
# that grows out of no friction at all while every coefficient grows from 0 to its value: f = s c |R(f)|, s
# from 0 to 1. Where all of c G is small there is no other; elsewhere it is followed. A branch that ends
# before s = 1, because it goes to infinity or turns back, has no solution that motion without friction leads
# to: self-locking.

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Codes: TypeAlias = npt.NDArray[np.int8]

EPSILON = 2.0**-52
ROUNDING = 32.0
"""Roundings in one residual."""
TRIES, TRIES_ON_BRANCH = 40, 8
"""Steps of Newton's method from no friction on, where it may wander, and from a place foretold on the branch, where
it converges at once or not at all."""
STRIDE, SHORTEST = 0.25, 2.0**-9
"""Greatest step of s: this part of the s at which sizes could feed on themselves at the earliest, but no less."""
LEAST_STEP = 2.0**-30
"""Step of s at which the branch has ended: so exactly is the share of the coefficients known that still moves."""
MOST_STEPS = 2000
"""Steps in all: the shortest pass the whole of s in 512, the rest is for halvings."""
# Measured on 3000 random laws of three sizes that feed on each other, half of them self-locking. Half and double of
# TRIES, SHORTEST, ROUNDING and STRIDE change no outcome and no size; the work changes by -7 and +14 %, nothing,
# nothing, +7 and -2 %. Neither do a LEAST_STEP of 2^-15 (44 % less) and of 2^-40 (29 % more). Four times STRIDE
# changes two outcomes and a size: steps then leave the branch. Twice TRIES_ON_BRANCH costs 81 % more and changes one
# outcome, as Newton's method is given time to reach another branch.


class FrictionRule(IntEnum):
    """Rule by which two components of a reaction make the size of friction."""

    LENGTH = 0
    GREATER = 1
    FIRST = 2


class Outcome(IntEnum):
    """Outcome of the search for friction at a position."""

    FOUND = 0
    LOCKED = 1
    LOST = 2


@dataclass(frozen=True)
class FrictionLaw:
    """f_j = c_j m_j(base_j + gain_j f) at n positions, for m sizes.

    Attributes
    ----------
    factor : (n, m)
        c, with the sign of the motion in it.
    base : (n, m, 2)
        What friction depends on, without friction.
    gain : (n, m, 2, m)
        What each size adds to it.
    rules : (m)
        Which m_j: length of the two numbers, greater of their magnitudes, or the first with its sign.
    """

    factor: Array
    base: Array
    gain: Array
    rules: npt.NDArray[np.int8]

    def at(self, mask: Mask) -> FrictionLaw:
        """The law at some of the positions (n)."""
        return FrictionLaw(self.factor[mask], self.base[mask], self.gain[mask], self.rules)

    def measures(self, sizes: Array) -> tuple[Array, Array]:
        """m_j (n, m) at sizes (n, m), and its derivatives by them (n, m, m); 0 where there is none."""
        parts = self.base + np.einsum("njak,nk->nja", self.gain, sizes)
        first, second = parts[..., 0], parts[..., 1]
        length = np.hypot(first, second)
        # zero vectors are divided by 1: their direction does not count
        safe = np.where(length > 0.0, length, 1.0)
        larger = np.abs(first) >= np.abs(second)
        weights = np.empty_like(parts)
        by = (self.rules == FrictionRule.LENGTH, self.rules == FrictionRule.GREATER)
        # derivatives of the measure by its two numbers: direction cosines, or the sign of the greater one, or
        # 1
        weights[..., 0] = np.select(by, (first / safe, np.sign(first) * larger), 1.0)
        weights[..., 1] = np.select(by, (second / safe, np.sign(second) * ~larger), 0.0)
        measures = np.select(by, (length, np.maximum(np.abs(first), np.abs(second))), first)
        return measures, np.einsum("nja,njak->njk", weights, self.gain)

    @property
    def feedback(self) -> Array:
        """Spectral radius (n) of the greatest shares of sizes that sizes can add: below 1 there is one solution."""
        # by how much a size can change another's measure at most, whatever the directions
        shares = np.abs(self.factor)[..., None] * np.linalg.norm(self.gain, axis=2)
        return np.asarray(np.abs(np.linalg.eigvals(shares)).max(axis=-1, initial=0.0))

    def residual(self, sizes: Array, share: Array) -> tuple[Array, Array, Array]:
        """Residual f - s c m(f) (n, m), its derivatives (n, m, m), and what rounding leaves of it (n, m)."""
        measures, slopes = self.measures(sizes)
        factor = share[:, None] * self.factor
        # sizes of the terms before they cancel: rounding is a share of these
        parts = np.abs(self.base).max(axis=2) + np.einsum(
            "njk,nk->nj", np.abs(self.gain).max(axis=2), np.abs(sizes)
        )
        noise = ROUNDING * EPSILON * (np.abs(sizes) + np.abs(factor) * parts)
        return sizes - factor * measures, np.eye(sizes.shape[1]) - factor[..., None] * slopes, noise


@dataclass(frozen=True)
class Followed:
    """Sizes of friction at n positions.

    Attributes
    ----------
    sizes : (n, m)
    outcome : (n) of Outcome
    share : (n)
        How far the coefficients could grow: 1 where there is a solution.
    residual : (n)
        Greatest |f - c m(f)| over the greatest of |f| and |c m(f)|.
    tries : int
        Most corrections at one position.
    """

    sizes: Array
    outcome: Codes
    share: Array
    residual: Array
    tries: int


def solve_friction(law: FrictionLaw) -> Followed:
    """Solve at every position; all numbers have to be finite."""
    count, width = law.factor.shape
    feedback, ones = law.feedback, np.ones(count)
    sizes, good, _slope, tries = _newton_corrections(law, np.zeros((count, width)), ones, TRIES)
    # with feedback of 1 or more there may be other solutions, and Newton's method may have found one of them
    good &= feedback < 1.0
    outcome = np.where(good, Outcome.FOUND, Outcome.LOST).astype(np.int8)
    share = np.where(good, 1.0, 0.0)
    if not good.all():
        rest = ~good
        sizes[rest], outcome[rest], share[rest], more = _along(law.at(rest), feedback[rest])
        tries = max(tries, more)
    missing = np.abs(law.residual(sizes, ones)[0])
    # where there is no friction at all the share is 0 and not 0/0
    size = np.maximum(np.abs(sizes).max(axis=1, initial=0.0), np.finfo(np.float64).tiny)
    return Followed(sizes, outcome, share, missing.max(axis=1, initial=0.0) / size, tries)


def _newton_corrections(
    law: FrictionLaw, sizes: Array, share: Array, tries: int
) -> tuple[Array, Mask, Array, int]:
    """Newton's method: sizes, where it converged, the determinants there, and how often it went on."""
    sizes = sizes.copy()
    open_, made = np.ones(len(sizes), dtype=bool), 0
    determinant = np.ones(len(sizes))
    while made < tries and open_.any():
        made += 1
        part = law.at(open_)
        with np.errstate(all="ignore"):
            residual, slopes, noise = part.residual(sizes[open_], share[open_])
            # the determinant at the last place tells whether the branch has been left
            determinant[open_] = np.linalg.det(slopes)
            sizes[open_] -= _solve_matrices(slopes, residual)
            done = (np.abs(residual) <= noise).all(axis=1)
        open_[open_] = ~done & np.isfinite(sizes[open_]).all(axis=1)
    return sizes, ~open_ & np.isfinite(sizes).all(axis=1), determinant, made


def _solve_matrices(matrix: Array, right: Array) -> Array:
    """Solutions (n, m); NaN where a matrix is singular."""
    with np.errstate(all="ignore"):
        singular = ~(np.abs(np.linalg.det(matrix)) > 0.0)
    regular = np.where(singular[:, None, None], np.eye(matrix.shape[-1]), matrix)
    solution = np.linalg.solve(regular, right[..., None])[..., 0]
    solution[singular] = np.nan
    return np.asarray(solution)


def _along(law: FrictionLaw, feedback: Array) -> tuple[Array, Codes, Array, int]:
    """Follow the branch from no friction on, each position with steps of its own."""
    count, width = law.factor.shape
    sizes, share, tries = np.zeros((count, width)), np.zeros(count), 0
    # sizes feed on themselves from s = 1 / feedback on: a quarter of that is a safe step
    longest = np.clip(STRIDE / np.maximum(feedback, STRIDE), SHORTEST, 1.0)
    step = longest.copy()
    for _step in range(MOST_STEPS):
        going = (share < 1.0) & (step >= LEAST_STEP)
        if not going.any():
            break
        part, here, aim = law.at(going), sizes[going], np.minimum(share[going] + step[going], 1.0)
        slopes = part.residual(here, share[going])[1]
        ahead = part.factor * part.measures(here)[0]
        # along the branch (I - s c m') df/ds = c m: a tangent step, which Newton's method then corrects
        guess = here + (aim - share[going])[:, None] * _solve_matrices(slopes, ahead)
        corrected, good, determinant, made = _newton_corrections(part, guess, aim, TRIES_ON_BRANCH)
        # the determinant is 1 without friction and changes its sign where the branch ends
        good &= determinant > 0.0
        tries = max(tries, made)
        sizes[going] = np.where(good[:, None], corrected, here)
        share[going] = np.where(good, aim, share[going])
        # twice as long after success, half as long after failure
        step[going] = np.where(good, np.minimum(2.0 * step[going], longest[going]), 0.5 * step[going])
    locked = (share < 1.0) & (step < LEAST_STEP)
    outcome = np.select((share >= 1.0, locked), (Outcome.FOUND, Outcome.LOCKED), Outcome.LOST)
    return sizes, outcome.astype(np.int8), share, tries


Number: TypeAlias = Any


@dataclass(frozen=True)
class Size:
    """Size of friction: the moment in a bearing, the force along a guide, or the moment of that about its line.

    Attributes
    ----------
    pulls : what a size of one does
    factor : size over measure, without the sense of the motion
    """

    contact: Contact
    pulls: tuple[Wrench, ...]
    factor: float
    rule: FrictionRule


@dataclass(frozen=True)
class Rubbed:
    """Friction of all contacts.

    Attributes
    ----------
    amounts : (n, contacts)
        Moment on the link [N m], or force on the slider [N] along the guide's direction.
    arms : (n, contacts)
        Moment on the slider that the height of a slider brings with it [N m].
    slopes : (n, contacts)
        Derivative of what rubs by the path's parameter; 0 where it turns round.
    turns : (n, contacts)
        Where a contact stands for an instant: what is returned holds just after it.
    standing : labels of contacts that do not move
    """

    contacts: tuple[Contact, ...]
    sizes: tuple[Size, ...]
    solution: Followed
    amounts: Array
    arms: Array
    slopes: Array
    turns: Mask
    standing: tuple[str, ...]

    @property
    def pulls(self) -> list[Wrench]:
        """Friction as forces and moments on links and pins."""
        sizes = self.solution.sizes
        return [
            pull.times(sizes[None, :, k].copy()) for k, size in enumerate(self.sizes) for pull in size.pulls
        ]

    @property
    def moment(self) -> Array:
        """Moment of all friction along the path's parameter (n)."""
        return np.asarray((self.amounts * self.slopes).sum(axis=1))


def friction_of_contacts(
    state: State, free: ForceSystem, contacts: Sequence[Contact], acceleration: Array, useful: Mask
) -> Rubbed:
    """Friction of the contacts, from the reactions without it, at the samples where these are of use."""
    for contact in contacts:
        if isinstance(contact, Sliding) and contact.surface_speed:
            what = _("friction of a belt by a coefficient is computed in simulations alone")
            raise NotComputedYet(contact.where, what, _("remove surface_speed, or use centrode simulate"))
    system = free.system
    motions = [_motion(contact, state, system, acceleration) for contact in contacts]
    senses = np.stack([sense for sense, _slope, _turns in motions], axis=1)
    slopes = np.stack([slope for _sense, slope, _turns in motions], axis=1)
    turns = np.stack([turn for _sense, _slope, turn in motions], axis=1)
    sizes = [size for contact in contacts for size in _sizes(contact, state)]
    owner = [contacts.index(size.contact) for size in sizes]
    solution = _where_known(_law(free, sizes, senses[:, owner]), useful)
    amounts, arms = np.zeros(senses.shape), np.zeros(senses.shape)
    for k, size in enumerate(sizes):
        # the moment that a slider's height brings is kept apart from the force along the guide
        (arms if size.rule is FrictionRule.FIRST else amounts)[:, owner[k]] += solution.sizes[:, k]
    still = tuple(c.label for c, sense in zip(contacts, senses.T, strict=True) if not np.any(sense))
    return Rubbed(tuple(contacts), tuple(sizes), solution, amounts, arms, slopes, turns, still)


def _motion(
    contact: Contact, state: State, system: Kinetostatics, acceleration: Array
) -> tuple[Array, Array, Mask]:
    """Sense of what rubs (1, -1, or 0 where it does not move), its derivative, and where it turns round.

    At an instant where it turns, the sense is the one it goes on with.
    """
    jet = contact.motion.slope(state)
    samples = len(state.parameter)
    slope, bend = column(jet.value, samples), column(jet.derivative(1), samples)
    unit = max(1.0, state.scale)
    reach = np.maximum(1.0, np.abs(state.parameter))
    condition = system.inverse.condition[0]
    with np.errstate(all="ignore"):
        # a slope this small is rounding: of the place, and of positions near a singular one
        noise = REST * (np.abs(bend) * reach + unit) + EPSILON * condition * unit
        rest = ~(np.abs(slope) > noise)
        # the second derivative is less exact: its rounding goes with the square of the condition number
        bends = np.abs(bend) > noise + EPSILON * condition**2 * unit
        speed = np.where(rest, 0.0, slope) * state.rate
        # where the drive itself stands, it is about to move as it is accelerated
        onward = np.where(rest, np.where(bends, bend, 0.0) * state.rate**2, slope * acceleration)
        sense = np.sign(np.where(speed == 0.0, onward, speed))
    sense = np.where(np.isfinite(sense), sense, 0.0)
    return sense, np.where(rest, 0.0, slope), (speed == 0.0) & (sense != 0.0)


def _sizes(contact: Contact, state: State) -> list[Size]:
    pulls = contact.motion.pulls(state)
    if isinstance(contact, HingeBearing):
        return [Size(contact, pulls, contact.coefficient * contact.radius, FrictionRule.LENGTH)]
    sizes = [Size(contact, pulls, contact.coefficient, FrictionRule.GREATER)]
    if contact.link is not None and contact.height:
        # the faces that bear lie half the height beside the line, on the side the force comes from
        arm = couple(contact.link, 1.0), couple(contact.on, -1.0)
        sizes.append(Size(contact, arm, 0.5 * contact.coefficient * contact.height, FrictionRule.FIRST))
    return sizes


def _law(free: ForceSystem, sizes: Sequence[Size], senses: Array) -> FrictionLaw:
    samples, count = len(senses), len(sizes)
    gain = np.empty((samples, count, 2, count))
    # reactions are linear in the sizes: those of each unit size, without any load, are the gains; radial forces of
    # teeth are as long as friction does not turn the tangential ones round
    teeth = tooth_senses(free)
    for k, size in enumerate(sizes):
        gain[..., k] = _size_measures(free.system.forces(size.pulls), sizes, teeth, samples)
    # friction acts against the motion
    factors = -senses * np.array([size.factor for size in sizes])
    rules = np.array([size.rule for size in sizes], dtype=np.int8)
    return FrictionLaw(factors, _size_measures(free, sizes, teeth, samples), gain, rules)


def _size_measures(
    forces: ForceSystem, sizes: Sequence[Size], teeth: Mapping[str, Array], samples: int
) -> Array:
    """The two numbers (n, sizes, 2) that each size depends on; `teeth` are the senses of tangential forces."""
    measures = np.zeros((samples, len(sizes), 2))
    for k, size in enumerate(sizes):
        for part, value in enumerate(_contact_forces(forces, size.contact)):
            measures[:, k, part] = column(value, samples)
        if teeth and isinstance(size.contact, HingeBearing):
            side = JointSide(size.contact.point, size.contact.link)
            measures[:, k] += radial_force_on(forces, side, teeth)
    return measures


def _contact_forces(forces: ForceSystem, contact: Contact) -> tuple[Number, Number]:
    """Force between pin and bearing; normal force of a guide, and what its moment presses with at both ends."""
    if isinstance(contact, HingeBearing):
        side = JointSide(contact.point, contact.link)
        return side_forces(forces, [side])[side]
    constraints = forces.system.scheme.structure.constraints
    normal = next(c for c in constraints if isinstance(c, PointOnGuide) and c.guide == contact.guide)
    if not contact.length:
        return _value(forces, normal), 0.0
    turning = next(c for c in constraints if isinstance(c, NoTurning) and c.guide == contact.guide)
    # N_1, N_2 = N/2 -+ M/l, so that |N_1| + |N_2| is the greater of |N| and 2 |M|/l
    return _value(forces, normal), 2.0 * _value(forces, turning) / contact.length


def _value(forces: ForceSystem, constraint: Constraint) -> Number:
    return forces.multipliers.get((constraint, 0), 0.0)


def _where_known(law: FrictionLaw, useful: Mask) -> Followed:
    """Solve where all numbers are known; NaN elsewhere."""
    count, width = law.factor.shape
    known = useful & np.isfinite(law.base).all(axis=(1, 2)) & np.isfinite(law.gain).all(axis=(1, 2, 3))
    followed = solve_friction(law.at(known))
    sizes, outcome = np.full((count, width), np.nan), np.zeros(count, dtype=np.int8)
    share, residual = np.full(count, np.nan), np.zeros(count)
    sizes[known], outcome[known] = followed.sizes, followed.outcome
    share[known], residual[known] = followed.share, followed.residual
    # where there is no solution nothing is said of its residual
    residual[outcome != Outcome.FOUND] = 0.0
    return Followed(sizes, outcome, share, residual, followed.tries)


# What friction takes: power and work of each contact, efficiency, and where loads no longer drive.

NOISE = 2.0**-40
"""Powers below this share of the greatest are rounding."""
FREE, HELD, JAMMED = 0, 1, 2
LOCKING = {FREE: "free", HELD: "held", JAMMED: "jammed"}


@dataclass(frozen=True)
class Powers:
    """Moments along the path's parameter of all that gives or takes energy; power is the moment times `rate`.

    Attributes
    ----------
    drives, loads : (n, drives), (n, loads)
        Loads other than friction.
    inertia, lost : (n)
        Inertia of all links together; all friction, what a load of a given size takes among it.
    rate : (n)
    """

    drives: Array
    loads: Array
    inertia: Array
    lost: Array
    rate: Array

    @classmethod
    def of(
        cls,
        drives: Array,
        loads: Sequence[AppliedLoad],
        shares: Array,
        total: Array,
        rubbed: Rubbed,
        rate: Array,
    ) -> Powers:
        """`drives` (n, drives) give, `shares` (loads, 1, n) and, with inertia, `total` (1, n) do without friction."""
        rubbing = np.array([_rubs(load) for load in loads], dtype=bool)
        by_load = shares[:, 0].T
        return cls(
            drives,
            by_load[:, ~rubbing],
            # what is left of the sum of loads and inertia is the inertia
            total[0] - by_load.sum(axis=1),
            -rubbed.moment - by_load[:, rubbing].sum(axis=1),
            rate,
        )

    @property
    def efficiency(self) -> Array:
        """Share (n) of the power that is given which friction does not take; NaN where none is given."""
        parts = np.column_stack([self.drives, self.loads, self.inertia]) * self.rate[:, None]
        return _efficiency(parts, self.lost * self.rate)

    def mean_efficiency(self, parameter: Array) -> float:
        """Efficiency by works over all samples; each drive, load and inertia counts with what it gives in all."""
        parts = np.column_stack([self.drives, self.loads, self.inertia])
        works, lost = (works_over(parameter, self.rate, values) for values in (parts, self.lost[:, None]))
        return float(_efficiency(works[None], lost)[0])

    @property
    def locking(self) -> Codes:
        """HELD (n) where loads and inertia would drive the mechanism without friction, and do not with it."""
        outer = (self.loads.sum(axis=1) + self.inertia) * self.rate
        driving = self.drives.sum(axis=1) * self.rate
        # what may be the difference of great powers is rounding
        noise = NOISE * (np.abs(self.loads).sum(axis=1) + np.abs(self.inertia)) * np.abs(self.rate)
        with np.errstate(invalid="ignore"):
            held = (outer > noise) & (driving >= 0.0)
        return np.where(held, HELD, FREE).astype(np.int8)


def works_over(parameter: Array, rate: Array, moments: Array) -> Array:
    """Works (m) of moments (n, m) along a parameter, by the trapezoidal rule, in the sense in which `rate` goes.

    The samples may be in reverse order.
    """
    # samples may run backwards: the way is counted as positive, in the sense of the rate
    way = np.abs(np.diff(parameter))[:, None]
    values = moments * np.sign(rate)[:, None]
    return np.asarray((0.5 * way * (values[1:] + values[:-1])).sum(axis=0))


def _rubs(load: AppliedLoad) -> bool:
    return bool(load.efforts) and all(
        isinstance(effort.amount, (Friction, Square)) for effort in load.efforts
    )


def _efficiency(parts: Array, lost: Array) -> Array:
    given = np.maximum(parts, 0.0).sum(axis=1)
    noise = NOISE * np.abs(parts).max(axis=1, initial=0.0)
    with np.errstate(all="ignore"):
        return np.where(given > noise, np.maximum(1.0 - lost / given, 0.0), np.nan)


# Where friction jumps: values of the drive at which a contact turns round.

UNIT = Friction(Constant(1.0))


def reversals(prepared: Ready, contacts: Sequence[Contact], first: float, last: float) -> Array:
    """Values of the only drive, in increasing order, between two values."""
    rubbing = AppliedLoad("friction", tuple(LoadTerm(contact.motion, UNIT) for contact in contacts))
    return Reducer(prepared, MassesAndLoads((), (rubbing,))).jumps(first, last)


# Friction as it stands among the reactions of a dataset.


def friction_parts(rubbed: Rubbed, powers: Powers, mechanism: Mechanism) -> dict[str, Array]:
    """Variables of a dataset, samples first."""
    bearings = [k for k, contact in enumerate(rubbed.contacts) if isinstance(contact, HingeBearing)]
    parts = {
        "friction_power": -rubbed.amounts * rubbed.slopes * powers.rate[:, None],
        "efficiency": powers.efficiency,
    }
    if bearings:
        parts["friction_moment"] = rubbed.amounts[:, bearings]
    if len(bearings) < len(rubbed.contacts):
        parts["friction_force"] = np.zeros((len(rubbed.amounts), len(mechanism.guides)))
        for k, guide in _guide_contacts(rubbed, mechanism):
            parts["friction_force"][:, guide] = rubbed.amounts[:, k]
    return parts


def _guide_contacts(rubbed: Rubbed, mechanism: Mechanism) -> list[tuple[int, int]]:
    """Contacts in guides, each with the number of its guide."""
    guides = [guide.id for guide in mechanism.guides]
    return [(k, guides.index(c.guide)) for k, c in enumerate(rubbed.contacts) if isinstance(c, Sliding)]


def with_friction(parts: dict[str, Array], rubbed: Rubbed, state: State) -> None:
    """Add friction to the force and the moment of each guide, whose lines exert it."""
    for k, which in _guide_contacts(rubbed, state.mechanism):
        guide = state.mechanism.guides[which]
        unit = rotate_vector(guide.unit, place_of(state.rotor(guide.on)))
        for axis in range(2):
            along = column(unit[axis], len(rubbed.amounts))
            parts["guide_force"][:, which, axis] += rubbed.amounts[:, k] * along
        parts["guide_moment"][:, which] += rubbed.arms[:, k]
