"""On which side a group is assembled: what the description says, in words or by initial angles."""

from __future__ import annotations

from math import remainder, tau
from typing import Any, TypeAlias

import numpy as np

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.rounding import ROUNDED, SAFETY, Rounded
from centrode.errors import InputError
from centrode.geometry.space import Space
from centrode.kinematics.evaluate import FixedSigns, Kinematics
from centrode.kinematics.layout import rotor_of_angle
from centrode.locale import _
from centrode.structure.assur import name_of
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Aim, Group, Meet, Newton, links_of, points_of

Number: TypeAlias = Any

DEGENERATE = 1e-9
"""A triangle flatter than this (sine) does not tell its side."""
AWAY = np.array([0.5, 1.1, 2.3])
"""Places, in the path's units from the initial position, where a flat triangle ought to have opened."""

SIDES = {"left": 1.0, "right": -1.0, "ahead": 1.0, "behind": -1.0}


def stated_side(kinematics: Kinematics, group: Group) -> float | None:
    """The sign that [assembly] sides states for a group; None if it states none."""
    sides = kinematics.structure.mechanism.assembly.sides
    names = side_names(group)
    said = [(name, sides[name]) for name in names if name in sides]
    if not said:
        return None
    name, word = said[0]
    space = kinematics.numbers.space
    if word not in side_words(space, group):
        raise InputError(
            f"[assembly] sides.{name}",
            _("{word} does not apply to a group {kind}").format(word=f'"{word}"', kind=group.kind),
            _("write {words}").format(words=side_choice(space, group)),
        )
    return SIDES[word]


def side_names(group: Group) -> tuple[str, ...]:
    """Names under which [assembly] sides may speak of a group: its unknown points, or the guide of an RPR group."""
    if isinstance(group, Aim):
        return (group.contact.rolling if group.contact else group.guide, group.target)
    return points_of(group)


def side_words(space: Space, group: Group) -> tuple[str, str]:
    """The words that tell the sides of a group: of the line between two centres, or along a line."""
    between_centres = isinstance(group, Meet) and group.kind == "RRR"
    return ("left", "right") if between_centres or not space.crosses_once else ("ahead", "behind")


def side_choice(space: Space, group: Group) -> str:
    """How a side of the group is written."""
    first, second = side_words(space, group)
    return f'{side_names(group)[0]} = "{first}" | "{second}"'


def side_by_angles(kinematics: Kinematics, group: Group, options: dict[float, Positions]) -> float:
    """The sign whose angles are nearer to the initial angles given."""
    links = kinematics.structure.mechanism.links
    left, right = options.values()
    hints = {
        link: links[link].angle
        for link in links_of(group)
        # a link that points the same way in both assemblies tells nothing
        if links[link].angle is not None
        and is_measured(kinematics.numbers, left, link)
        and turned_apart(kinematics.numbers.space, link, left, right) > DEGENERATE
    }
    if not hints:
        raise InputError(
            name_of(group),
            _("nothing says on which side it is assembled"),
            _("give the initial angle of {links}, or [assembly] sides, {words}").format(
                links=_(" or ").join(links_of(group)), words=side_choice(kinematics.numbers.space, group)
            ),
        )
    misfit = {
        sign: sum(
            abs(angle_off(kinematics.numbers, hint or 0.0, option, link)) for link, hint in hints.items()
        )
        for sign, option in options.items()
    }
    return min(misfit, key=misfit.__getitem__)


def turned_apart(space: Space, link: str, one: Positions, other: Positions) -> float:
    """How far a link is turned from one position to another: the length of the difference of its axes."""
    first, second = (space.attitude(at.poses[link]) for at in (one, other))
    return float(np.linalg.norm(np.subtract(first, second)))


def check_sides(kinematics: Kinematics) -> None:
    """Refuse sides of what no group is asked about, which would be passed over in silence."""
    groups = [group for group in kinematics.structure.groups if group.signed]
    known = [name for group in groups for name in side_names(group)]
    for name in kinematics.structure.mechanism.assembly.sides:
        if name not in known:
            raise InputError(
                f"[assembly] sides.{name}",
                _("no group is assembled on a side of {name}").format(name=name),
                _("take it out, or name one of: {names}").format(names=", ".join(known) or "-"),
            )


def check_opens(kinematics: Kinematics, index: int, signs: dict[int, float]) -> None:
    """Refuse a group that is flat in the initial position and everywhere else: its sides would be rounding."""
    groups = kinematics.structure.groups
    group, path = groups[index], kinematics.path
    if any(isinstance(before, Newton) for before in groups[:index]):
        return  # how those go on is not known yet
    start = Rounded.of(np.float64(path.initial))
    here = Rounded.of(kinematics.guard(ROUNDED, start, index, FixedSigns(ROUNDED, signs)))
    if abs(here.value) > SAFETY * here.bound:
        return
    away = Rounded.of(path.initial + path.unit * AWAY)
    there = Rounded.of(kinematics.guard(ROUNDED, away, index, FixedSigns(ROUNDED, signs)))
    if bool(np.all(np.abs(there.value) <= SAFETY * there.bound)):
        raise InputError(
            name_of(group),
            _("its triangle is flat wherever the drive stands, so its assemblies never part"),
            _("change a length, or take a link away"),
        )


def is_measured(numbers: Dimensions, at: Positions, link: str) -> bool:
    """Whether everything that a link's angle is measured between has a place already."""
    return link in numbers.ends and all(end in at.points for end in numbers.ends[link])


def angle_off(numbers: Dimensions, angle: float, at: Positions, link: str) -> float:
    """By how much a link is turned from an angle, in (-pi, pi]."""
    cosine, sine = rotor_of_angle(ARRAYS, numbers, at, link)
    return remainder(float(np.arctan2(sine, cosine)) - angle, tau)
