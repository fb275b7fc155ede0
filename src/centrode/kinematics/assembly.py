"""The initial position: which of a group's two assemblies is meant, and whether everything closes."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, radians
from typing import Any, TypeAlias

import numpy as np

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.rounding import ROUNDED, Rounded
from centrode.errors import InputError
from centrode.geometry.space import Space
from centrode.kinematics.evaluate import Choices, Kinematics
from centrode.kinematics.fitting import check_fit, check_touch
from centrode.kinematics.groups import solve_group
from centrode.kinematics.higher_class.guesses import bound_higher, start_higher
from centrode.kinematics.higher_class.system import System
from centrode.kinematics.phases import phases_after, phases_before, phases_in, standing_links, with_phases
from centrode.kinematics.sides import (
    DEGENERATE,
    angle_off,
    check_opens,
    check_sides,
    is_measured,
    side_by_angles,
    side_choice,
    stated_side,
    turned_apart,
)
from centrode.kinematics.starting import Bounding, OneSide, Starting, undetermined
from centrode.locale import _
from centrode.structure.assur import name_of
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Aim, Group, Meet, Newton, TwoPointLink, links_of, points_of

Number: TypeAlias = Any

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
        It does not close (by how much is told), or the description does not say on which side a group is
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
    with np.errstate(all="ignore"):
        for i, group in enumerate(kinematics.structure.groups):
            _check_apart(kinematics, group)
            try:
                phases = phases_before(kinematics, group, at, Choices(starting, i))
                kinematics = with_phases(kinematics, phases)
                if isinstance(group, Newton):
                    kinematics = _start_higher(kinematics, group, at, bounded)
                elif group.signed:
                    signs[i] = _solve_signed(kinematics, group, at, _bound(kinematics, group, bounded))
                    check_opens(kinematics, i, signs)
                else:
                    solve_group(group, ARRAYS, kinematics.numbers, at, Choices(starting, i))
            except ZeroDivisionError:  # plain floats do not become infinite as arrays do
                raise undetermined(group) from None
            _check_finite(group, at)
            decided = group.signed and stated_side(kinematics, group) is not None
            _check_angles(kinematics, group, at, ROUGH if decided else ANGLE_TOLERANCE)
            kinematics.count(i, at, ARRAYS, starting)
            bounding = Bounding(kinematics, group, signs.get(i, 1.0))
            if not isinstance(group, Newton):  # its places have their bounds already
                solve_group(group, ROUNDED, kinematics.numbers, bounded, Choices(bounding, i))
            kinematics.count(i, bounded, ROUNDED, bounding)
    kinematics = with_phases(kinematics, phases_after(kinematics, at))
    check_touch(kinematics, at)
    residual = check_fit(kinematics, at)
    return Assembled(signs, at, _angles(kinematics, at), residual, kinematics.numbers)


def _start_higher(kinematics: Kinematics, group: Newton, at: Positions, bounded: Positions) -> Kinematics:
    """Solve a group of higher class; its wheels mesh as they stand then."""
    known = at.copied()
    standing = standing_links(kinematics, group, at)
    start_higher(kinematics.structure.mechanism, kinematics.numbers, standing, at)
    kinematics = with_phases(kinematics, phases_in(kinematics, group, at))
    bound_higher(System(group, kinematics.numbers, known, 1), at, bounded)
    return kinematics


def _bound(kinematics: Kinematics, group: Group, bounded: Positions) -> float:
    """Rounding error of a group's radicand, from positions with bounds known before it."""
    bounding = Bounding(kinematics, group, 1.0)
    solve_group(group, ROUNDED, kinematics.numbers, bounded.copied(), Choices(bounding, 0))
    return bounding.bound


def _solve_signed(kinematics: Kinematics, group: Group, at: Positions, bound: float) -> float:
    """Solve a group on the side that the description means; returns its sign."""
    options = {sign: _option(kinematics, group, at, sign, bound) for sign in (1.0, -1.0)}
    stated = stated_side(kinematics, group)
    left, right = options.values()
    apart = _distance(kinematics.numbers.space, group, left, right)
    flat = apart < DEGENERATE * float(kinematics.numbers.scale)
    if stated is None and flat:
        raise InputError(
            name_of(group),
            _("its triangle is flat in the initial position, so both assemblies meet there"),
            _("say on which side it goes on: [assembly] sides, {word}").format(
                word=side_choice(kinematics.numbers.space, group)
            ),
        )
    sign = stated if stated is not None else side_by_angles(kinematics, group, options)
    at.points.update(options[sign].points)
    at.poses.update(options[sign].poses)
    at.angles.update(options[sign].angles)
    return sign


def _option(kinematics: Kinematics, group: Group, at: Positions, sign: float, bound: float) -> Positions:
    trial = at.copied()
    solve_group(
        group, ARRAYS, kinematics.numbers, trial, Choices(OneSide(kinematics, group, at, sign, bound), 0)
    )
    return trial


def _distance(space: Space, group: Group, one: Positions, other: Positions) -> float:
    """How far apart the two assemblies of a group are."""
    apart = [np.linalg.norm(np.subtract(one.points[p], other.points[p])) for p in points_of(group)]
    if isinstance(group, Aim):
        arm = np.linalg.norm(np.subtract(one.points[group.target], one.points[group.pivot]))
        apart.append(arm * turned_apart(space, group.link, one, other))
    return float(max(apart, default=0.0))


def _check_angles(kinematics: Kinematics, group: Group, at: Positions, tolerance: float) -> None:
    for link in links_of(group):
        angle = kinematics.structure.mechanism.links[link].angle
        if angle is None or link not in at.poses or not is_measured(kinematics.numbers, at, link):
            continue
        difference = angle_off(kinematics.numbers, angle, at, link)
        if abs(difference) > tolerance:
            raise InputError(
                f"[links.{link}] angle",
                _(
                    "{given:.4g} deg does not assemble: the position has {found:.4g} deg, {off:.3g} deg off"
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
                _("points {first} and {second} coincide, so they do not tell how the link turns").format(
                    first=first, second=second
                ),
                _("correct their coordinates"),
            )


def _check_finite(group: Group, at: Positions) -> None:
    values = [x for p in points_of(group) for x in at.points[p]]
    values += [x for link in links_of(group) for vector in at.poses[link] for x in vector]
    if not all(np.isfinite(float(x)) for x in values):
        raise undetermined(group)


def _angles(kinematics: Kinematics, at: Positions) -> dict[str, float]:
    """Angles of all links in the initial position, in the turn that the description names."""
    mechanism = kinematics.structure.mechanism
    named = {name: link.angle for name, link in mechanism.links.items()}
    for drive in mechanism.drives:
        if drive.kind == "angle" and drive.relative_to == "frame" and drive.link is not None:
            named[drive.link] = float(at.drives[drive.id])
    angles = {key: float(angle) for key, angle in at.angles.items()}
    for link in kinematics.numbers.ends:
        near = at.angles.get(link, named[link]) or 0.0
        angles[link] = near + angle_off(kinematics.numbers, near, at, link)
    return angles
