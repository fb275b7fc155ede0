"""The initial position: which of a group's two assemblies is meant, and whether everything closes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import degrees, radians
from typing import Any, TypeAlias, assert_never

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.geometry.space import Space
from centrode.kinematics.assembly_mode import (
    DEGENERATE,
    Bounding,
    OneSide,
    Starting,
    angle_off,
    check_fit,
    check_opens,
    check_sides,
    check_touch,
    is_measured,
    side_by_angles,
    side_choice,
    stated_side,
    turned_apart,
    undetermined_error,
)
from centrode.kinematics.dyads import equation_at, solve_group, turn_link
from centrode.kinematics.higher_class.initial_states import bound_higher, guesses, start_higher
from centrode.kinematics.higher_class.system import GroupSystem
from centrode.kinematics.plan_evaluation import Kinematics, SideChoices
from centrode.locale import _
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.rounding_bounds import ROUNDED, Rounded
from centrode.structure.assur import name_of
from centrode.structure.constraints import (
    Constraint,
    Entity,
    GearRatio,
    Meshing,
    NoSlip,
    Positions,
    Standing,
    angle_links,
    identity_of,
    phase_of,
)
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import (
    Aim,
    AngleEquation,
    AngleGiven,
    Arm,
    Following,
    Group,
    Meet,
    Meshed,
    Newton,
    RigidPoint,
    Rolled,
    Rolloff,
    Train,
    TurnedLink,
    Turning,
    TwoPointLink,
)
from centrode.structure.rank import columns_of, independent_rows, match

# How wheels mesh: the constants of gears and rolling contacts, from the initial angles of the description.
#
# A gear gives the angle of a link; where that link stands initially is what its own `angle` says, else zero.
# A wheel that is turned by something else, and so puts its centre or its track somewhere, starts at the
# line's own point.

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


def with_phases(kinematics: Kinematics, phases: Mapping[str, float]) -> Kinematics:
    """The plan with constants of gears and rolling contacts [rad] added to its numbers."""
    if not phases:
        return kinematics
    numbers = kinematics.numbers
    return replace(kinematics, numbers=replace(numbers, gearing=numbers.gearing.with_phases(phases)))


def phases_before(
    kinematics: Kinematics, group: Group, at: Positions, choices: SideChoices
) -> dict[str, float]:
    """Constants that a group needs before it is solved in the initial position."""
    match group:
        case Train():
            return _of_train(kinematics, group, at, choices)
        case TurnedLink():
            return _phase_of_turning(kinematics, group.link, group.turning, at)
        case Meet():
            turning = None if group.carriage is None else group.turning
            phases = _phase_of_turning(kinematics, group.carriage or "", turning, at)
            # a wheel that something else turns stands with its centre at the line's own point, by definition
            for locus in group.loci:
                if isinstance(locus, Rolloff):
                    ahead = with_phases(kinematics, phases)
                    phases[locus.rolling.rolling] = _turn_at_start(ahead, group, locus.rolling, at, choices)
            return phases
        case RigidPoint() | TwoPointLink() | Aim() | Newton():
            return {}
        case _:
            assert_never(group)


def _phase_of_turning(
    kinematics: Kinematics, link: str, turning: Turning | Following | None, at: Positions
) -> dict[str, float]:
    """The constant of a gear or a rolling contact that turns a link; none where something else does."""
    match turning:
        case None | Turning():
            return {}
        case Meshed(gear):
            meshing: Meshing = gear
        case Rolled(rolling):
            meshing = rolling
        case _:
            assert_never(turning)
    trial = at.copy()
    # as if the link stood where the description says: the constant is what the meshing then lacks
    trial.angles[link] = stated_angle(kinematics, link)
    return {identity_of(meshing): float(phase_of(meshing, ARRAYS, kinematics.numbers, trial))}


def phases_after(kinematics: Kinematics, at: Positions) -> dict[str, float]:
    """Constants of what no group needed: gears and rolling contacts that repeat others."""
    known = kinematics.numbers.gearing.phase
    return {
        identity_of(c): float(phase_of(c, ARRAYS, kinematics.numbers, at))
        for c in kinematics.structure.constraints
        if isinstance(c, Meshing) and identity_of(c) not in known
    }


def phases_in(kinematics: Kinematics, group: Newton, at: Positions) -> dict[str, float]:
    """Constants of the gears and rolling contacts in a group of higher class that stands in its initial position."""
    return {
        identity_of(c): float(phase_of(c, ARRAYS, kinematics.numbers, at))
        for c, _row in group.equations
        if isinstance(c, Meshing)
    }


def standing_links(kinematics: Kinematics, group: Newton, at: Positions) -> Newton:
    """A group of higher class in which links stand at their initial angles instead of meshing.

    Of the links that an equation between angles could give, the first is taken that nothing else gives: the
    second wheel of a gear, the wheel that rolls, else any link of the group.
    """
    meshing = [c for c, _row in group.equations if isinstance(c, Meshing)]
    if not meshing:
        return group
    entities = [Entity("point", name) for name in group.points] + [
        Entity("link", name) for name in group.links
    ]
    first, width = columns_of(entities)
    guess = guesses(kinematics.structure.mechanism, kinematics.numbers, group, at)[0]
    # without the meshings, which have no constants yet; links that stand take their places
    kept = [equation for equation in group.equations if not isinstance(equation[0], Meshing)]

    def row(equation: tuple[Constraint, int]) -> Array:
        constraint, which = equation
        offsets = np.zeros(width)
        for entity, slopes in constraint.rows(kinematics.numbers, guess)[which].items():
            if entity in first:
                offsets[first[entity] : first[entity] + entity.unknowns] += slopes
        return offsets

    rows = [row(equation) for equation in kept]
    for constraint in meshing:
        wanted = [link for link in angle_links(constraint) if link in group.links]
        for link in dict.fromkeys([*wanted, *group.links]):
            standing: tuple[Constraint, int] = (Standing(link, stated_angle(kinematics, link)), 0)
            # the link's angle has to be something that the other equations leave free
            if independent_rows(np.array([*rows, row(standing)]))[-1]:
                rows.append(row(standing))
                kept.append(standing)
                break
    return replace(group, equations=tuple(kept))


def stated_angle(kinematics: Kinematics, link: str) -> float:
    """Initial angle of a link [rad]; zero where the description gives none."""
    return kinematics.structure.mechanism.initial_angle(link) or 0.0


def _turn_at_start(
    kinematics: Kinematics, group: Meet, rolling: NoSlip, at: Positions, choices: SideChoices
) -> float:
    """Angle of a wheel against its track in the initial position, where its centre is at the line's own point."""
    trial = at.copy()
    link = group.carriage
    if link is not None and group.turning is not None:
        rotor = turn_link(group.turning, link, ARRAYS, kinematics.numbers, trial, choices.continue_angle)
        if link not in trial.angles:
            trial.angles[link] = choices.continue_angle(link, np.arctan2(rotor[1], rotor[0]))
    return float(trial.angles[rolling.link] - trial.angles[rolling.on])


def _of_train(kinematics: Kinematics, group: Train, at: Positions, choices: SideChoices) -> dict[str, float]:
    """Constants of a train's equations: each lets one link of its own stand at its initial angle."""
    bearing = {equation: meshing for equation in group.equations if (meshing := _mesh_of(equation))}
    # constants zero: what the equations then lack are the constants
    blank = with_phases(kinematics, {identity_of(meshing): 0.0 for meshing in bearing.values()})
    rows = {
        equation: equation_at(equation, ARRAYS, blank.numbers, at, choices.continue_angle)
        for equation in group.equations
    }
    owner = match(
        {
            e: _links_by_preference(kinematics, e, rows[e][0], group)
            # equations without a constant choose first: they cannot let a link stand instead
            for e in sorted(rows, key=lambda e: e in bearing)
        }
    )
    matrix, right = np.zeros((len(rows), len(rows))), np.zeros(len(rows))
    for k, (link, equation) in enumerate(owner.items()):
        if equation in bearing:
            matrix[k, group.links.index(link)] = 1.0
            right[k] = stated_angle(kinematics, link)
        else:
            factors, value = rows[equation]
            right[k] = float(value)
            for name, factor in factors.items():
                if name in group.links:
                    matrix[k, group.links.index(name)] = factor
                else:
                    right[k] -= factor * float(at.angles[name])
    try:
        angles = dict(zip(group.links, np.linalg.solve(matrix, right).tolist(), strict=True))
    # the links that were chosen do not determine the others
    except np.linalg.LinAlgError:
        raise InputError(
            name_of(group),
            _("its initial angles do not determine how the wheels mesh"),
            _("give the initial angle of: {links}").format(links=", ".join(group.links)),
        ) from None
    everything = {**at.angles, **angles}
    return {
        identity_of(meshing): float(
            sum(factor * everything[name] for name, factor in rows[equation][0].items()) - rows[equation][1]
        )
        for equation, meshing in bearing.items()
    }


def _mesh_of(equation: AngleEquation) -> Meshing | None:
    match equation:
        case AngleGiven():
            return None
        case Arm(rolling=rolling):
            return rolling
        case GearRatio() | NoSlip():
            return equation
        case _:
            assert_never(equation)


def _links_by_preference(
    kinematics: Kinematics, equation: AngleEquation, factors: Mapping[str, Number], group: Train
) -> list[str]:
    """Links whose initial angle an equation may rest on: those that state one, then the second wheel first."""
    own = [link for link, factor in factors.items() if link in group.links and factor != 0.0]
    if isinstance(equation, GearRatio):
        own.sort(key=lambda link: (equation.second, equation.first, equation.carrier).index(link))
    links = kinematics.structure.mechanism.links
    return sorted(own, key=lambda link: links[link].angle is None)


ANGLE_TOLERANCE = radians(5.0)
"""Initial angles name an assembly; further than this from the assembled position they are taken as a mistake."""
ROUGH = radians(45.0)
"""Where [assembly] sides decides, an initial angle is a sketch; what is further off is a mistake all the same."""


@dataclass(frozen=True)
class Assembled:
    """The initial position: sign of each signed group, places of everything, and how well it closes.

    `angles` has those of all links and the bearings of rolling wheels; `numbers` are the dimensions with the
    constants of gears and rolling contacts, which are found here.
    """

    signs: dict[int, float]
    positions: Positions
    angles: dict[str, float]
    residual: float
    numbers: Dimensions


def assemble(kinematics: Kinematics) -> Assembled:
    """Initial position of a single mechanism.

    Raises
    ------
    InputError
        It does not close (the error says by how much), or the description does not say on which side a group is
        assembled.
    """
    initial = kinematics.path.initial
    drives = kinematics.path.drive_values(ARRAYS, initial)
    at = Positions.of_frame(kinematics.numbers, drives, ARRAYS)
    bounded = Positions.of_frame(
        kinematics.numbers, {k: Rounded.of(np.float64(v)) for k, v in drives.items()}, ARRAYS
    )
    signs: dict[int, float] = {}
    check_sides(kinematics)
    starting = Starting(kinematics)
    # bounds of rounding errors serve groups with two sides or with a divisor, and nothing behind the last of these
    groups = kinematics.structure.groups
    last = max(
        (i for i, group in enumerate(groups) if not isinstance(group, Newton | RigidPoint)), default=-1
    )
    with np.errstate(all="ignore"):
        for i, group in enumerate(kinematics.structure.groups):
            _check_apart(kinematics, group)
            try:
                phases = phases_before(kinematics, group, at, SideChoices(starting, i))
                kinematics = with_phases(kinematics, phases)
                if isinstance(group, Newton):
                    kinematics = _start_higher(kinematics, group, at, bounded if i < last else None)
                # the bound is needed before: it tells how far below zero a radicand may be
                elif group.is_signed:
                    radicand = _bounded_radicand(kinematics, group, bounded)
                    bound = float(np.max(radicand.bound))  # one place, as an array or not
                    signs[i] = _solve_signed(kinematics, group, at, bound)
                    check_opens(kinematics, i, signs, radicand)
                else:
                    solve_group(group, ARRAYS, kinematics.numbers, at, SideChoices(starting, i))
            except ZeroDivisionError:  # plain floats do not become infinite as arrays do
                raise undetermined_error(group) from None
            _check_finite(group, at)
            decided = group.is_signed and stated_side(kinematics, group) is not None
            _check_angles(kinematics, group, at, ROUGH if decided else ANGLE_TOLERANCE)
            kinematics.count(i, at, ARRAYS, starting)
            if i > last:
                continue
            bounding = Bounding(kinematics, group, signs.get(i, 1.0))
            if not isinstance(group, Newton):  # its places have their bounds already
                # the same group once more with bounds, as groups behind need them
                solve_group(group, ROUNDED, kinematics.numbers, bounded, SideChoices(bounding, i))
            kinematics.count(i, bounded, ROUNDED, bounding)
    kinematics = with_phases(kinematics, phases_after(kinematics, at))
    check_touch(kinematics, at)
    residual = check_fit(kinematics, at)
    return Assembled(signs, at, _angles(kinematics, at), residual, kinematics.numbers)


def _start_higher(
    kinematics: Kinematics, group: Newton, at: Positions, bounded: Positions | None
) -> Kinematics:
    """Solve a group of higher class; its wheels mesh as they stand then."""
    known = at.copy()
    standing = standing_links(kinematics, group, at)
    start_higher(kinematics.structure.mechanism, kinematics.numbers, standing, at)
    kinematics = with_phases(kinematics, phases_in(kinematics, group, at))
    if bounded is not None:
        bound_higher(GroupSystem(group, kinematics.numbers, known, 1), at, bounded)
    return kinematics


def _bounded_radicand(kinematics: Kinematics, group: Group, bounded: Positions) -> Rounded:
    """A group's radicand with its rounding error, from positions with bounds known before it."""
    bounding = Bounding(kinematics, group, 1.0)
    solve_group(group, ROUNDED, kinematics.numbers, bounded.copy(), SideChoices(bounding, 0))
    return bounding.radicand


def _solve_signed(kinematics: Kinematics, group: Group, at: Positions, bound: float) -> float:
    """Solve a group on the side that the description means; returns its sign."""
    # both sides are tried; a side that does not close refuses by itself, as both do
    options = {sign: _option(kinematics, group, at, sign, bound) for sign in (1.0, -1.0)}
    stated = stated_side(kinematics, group)
    left, right = options.values()
    apart = _distance(kinematics.numbers.space, group, left, right)
    # where both sides meet, angles cannot tell which is meant
    flat = apart < DEGENERATE * float(kinematics.numbers.scale)
    if stated is None and flat:
        raise InputError(
            name_of(group),
            _("its triangle is degenerate in the initial position, where both assembly modes coincide"),
            _("give the side on which the motion continues: [assembly] sides, {word}").format(
                word=side_choice(kinematics.numbers.space, group)
            ),
        )
    sign = stated if stated is not None else side_by_angles(kinematics, group, options)
    at.points.update(options[sign].points)
    at.poses.update(options[sign].poses)
    at.angles.update(options[sign].angles)
    return sign


def _option(kinematics: Kinematics, group: Group, at: Positions, sign: float, bound: float) -> Positions:
    trial = at.copy()
    solve_group(
        group, ARRAYS, kinematics.numbers, trial, SideChoices(OneSide(kinematics, group, at, sign, bound), 0)
    )
    return trial


def _distance(space: Space, group: Group, one: Positions, other: Positions) -> float:
    """Distance of the two assemblies of a group: the greatest over its points and links."""
    apart = [np.linalg.norm(np.subtract(one.points[p], other.points[p])) for p in group.points]
    if isinstance(group, Aim):
        arm = np.linalg.norm(np.subtract(one.points[group.target], one.points[group.pivot]))
        # an aimed link has no unknown point: the arm to its target makes its turn a length
        apart.append(arm * turned_apart(space, group.link, one, other))
    return float(max(apart, default=0.0))


def _check_angles(kinematics: Kinematics, group: Group, at: Positions, tolerance: float) -> None:
    for link in group.links:
        angle = kinematics.structure.mechanism.links[link].angle
        if angle is None or link not in at.poses or not is_measured(kinematics.numbers, at, link):
            continue
        difference = angle_off(kinematics.numbers, angle, at, link)
        if abs(difference) > tolerance:
            raise InputError(
                f"[links.{link}] angle",
                _(
                    "the position cannot be assembled at {given:.4g} deg: it has {found:.4g} deg, a difference "
                    "of {off:.3g} deg"
                ).format(
                    given=degrees(angle), found=degrees(angle + difference), off=degrees(abs(difference))
                ),
                _("correct the angle, a length or the start of the drive"),
            )


def _check_apart(kinematics: Kinematics, group: Group) -> None:
    """Refuse a link that is to be turned by two of its points which are one place."""
    pairs = [(rod.link, rod.centre, rod.point) for rod in group.rods] if isinstance(group, Meet) else []
    if isinstance(group, TwoPointLink):
        pairs = [(group.link, group.first, group.second)]
    for link, first, second in pairs:
        local = kinematics.numbers.local[link]
        leverage = kinematics.numbers.space.leverage(ARRAYS, local[first], local[second])
        if leverage <= DEGENERATE * kinematics.numbers.scale:
            raise InputError(
                f"[links.{link}]",
                _(
                    "points {first} and {second} coincide and do not determine the rotation of the link"
                ).format(first=first, second=second),
                _("correct their coordinates"),
            )


def _check_finite(group: Group, at: Positions) -> None:
    values = [x for p in group.points for x in at.points[p]]
    values += [x for link in group.links for vector in at.poses[link] for x in vector]
    if not all(np.isfinite(float(x)) for x in values):
        raise undetermined_error(group)


def _angles(kinematics: Kinematics, at: Positions) -> dict[str, float]:
    """Angles of all links in the initial position, in the turn that the description names."""
    mechanism = kinematics.structure.mechanism
    named = {name: link.angle for name, link in mechanism.links.items()}
    for drive in mechanism.drives:
        if drive.kind == "angle" and drive.relative_to == "frame" and drive.link is not None:
            named[drive.link] = float(at.drives[drive.id])
    angles = {key: float(angle) for key, angle in at.angles.items()}
    # the turn that the drive's start or the description's angle names
    for link in kinematics.numbers.ends:
        near = at.angles.get(link, named[link]) or 0.0
        angles[link] = near + angle_off(kinematics.numbers, near, at, link)
    return angles
