"""On which side a group is assembled: what the description says, in words or by initial angles."""

from __future__ import annotations

from math import remainder, tau
from typing import Any, TypeAlias, assert_never

import numpy as np

from centrode.errors import InputError
from centrode.geometry.space import Space
from centrode.kinematics.dyads import aim_curve, loci_of
from centrode.kinematics.plan_evaluation import (
    EvaluationPolicy,
    FixedSigns,
    Kinematics,
    SideChoices,
    rotor_of_angle,
)
from centrode.locale import _
from centrode.model.settings import Display, shown_as
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.rounding_bounds import ROUNDED, SAFETY, Rounded
from centrode.quantities import terminal_unit
from centrode.structure.assur import name_of
from centrode.structure.constraints import Positions, TrackContact
from centrode.structure.dimensions import Dimensions
from centrode.structure.gearing import Straight
from centrode.structure.groups import (
    Aim,
    CylinderCircle,
    Group,
    GuideStop,
    Locus,
    Meet,
    Newton,
    Rail,
    Rod,
    Rolloff,
    Slot,
    Touch,
    TwoPointLink,
)
from centrode.structure.plan import Structure, drives_against_mobility
from centrode.structure.rank import residuals_at

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
            _("{word} does not apply to a group {kind}").format(word=f'"{word}"', kind=_(group.kind)),
            _("write {words}").format(words=side_choice(space, group)),
        )
    return SIDES[word]


def side_names(group: Group) -> tuple[str, ...]:
    """Names under which [assembly] sides may speak of a group: its unknown points, or the guide of an RPR group."""
    if isinstance(group, Aim):
        return (group.contact.rolling if group.contact else group.guide, group.target)
    return group.points


def side_words(space: Space, group: Group) -> tuple[str, str]:
    """The words that tell the sides of a group: of the line between two centres, or along a line."""
    between_centres = isinstance(group, Meet) and group.kind == "RRR"
    # "ahead" along a line that the locus meets twice; elsewhere left and right of the line between centres
    return ("left", "right") if between_centres or not space.crosses_once else ("ahead", "behind")


def side_choice(space: Space, group: Group) -> str:
    """Text of a group's side as a description writes it, both choices."""
    first, second = side_words(space, group)
    return f'{side_names(group)[0]} = "{first}" | "{second}"'


def side_by_angles(kinematics: Kinematics, group: Group, options: dict[float, Positions]) -> float:
    """The sign whose angles are nearer to the initial angles given."""
    links = kinematics.structure.mechanism.links
    left, right = options.values()
    hints = {
        link: links[link].angle
        for link in group.links
        # a link that points the same way in both assemblies tells nothing
        if links[link].angle is not None
        and is_measured(kinematics.numbers, left, link)
        and turned_apart(kinematics.numbers.space, link, left, right) > DEGENERATE
    }
    if not hints:
        raise _undecided_sides(kinematics, group)
    # the sum over all links that tell: one link alone may be drawn badly
    misfit = {
        sign: sum(
            abs(angle_off(kinematics.numbers, hint or 0.0, option, link)) for link, hint in hints.items()
        )
        for sign, option in options.items()
    }
    return min(misfit, key=misfit.__getitem__)


def _undecided_sides(kinematics: Kinematics, group: Group) -> InputError:
    """The error of a group whose side nothing says, and of those behind it of which the same is certain.

    Those behind are not solved, as their places depend on the side of this one: only where no initial angle of
    their links is given, none can tell.
    """
    groups = kinematics.structure.groups
    mechanism = kinematics.structure.mechanism
    behind = [
        other
        for other in groups[groups.index(group) + 1 :]
        if other.is_signed
        and not any(name in mechanism.assembly.sides for name in side_names(other))
        and all(mechanism.links[link].angle is None for link in other.links)
    ]
    space = kinematics.numbers.space
    errors = [
        InputError(
            name_of(undecided),
            _("the side on which it is assembled is not given"),
            _("give the initial angle of {links}, or [assembly] sides, {words}").format(
                links=_(" or ").join(undecided.links), words=side_choice(space, undecided)
            ),
        )
        for undecided in (group, *behind)
    ]
    first, rest = errors[0], errors[1:]
    return InputError(first.where, first.what, first.repair + "".join(f"\n{other}" for other in rest))


def turned_apart(space: Space, link: str, one: Positions, other: Positions) -> float:
    """Difference of a link's attitude in two positions: the length of the difference of its axes."""
    first, second = (space.attitude(at.poses[link]) for at in (one, other))
    return float(np.linalg.norm(np.subtract(first, second)))


def check_sides(kinematics: Kinematics) -> None:
    """Refuse sides of what is no group with two sides, which would be passed over in silence."""
    groups = [group for group in kinematics.structure.groups if group.is_signed]
    known = [name for group in groups for name in side_names(group)]
    for name in kinematics.structure.mechanism.assembly.sides:
        if name not in known:
            raise InputError(
                f"[assembly] sides.{name}",
                _("{name} does not select the side of any group").format(name=name),
                _("remove it, or name one of: {names}").format(names=", ".join(known) or "-"),
            )


def check_opens(kinematics: Kinematics, index: int, signs: dict[int, float], here: Rounded) -> None:
    """Refuse a group that is flat in the initial position and everywhere else: its sides would be rounding.

    `here` is its radicand in the initial position.
    """
    groups = kinematics.structure.groups
    group, path = groups[index], kinematics.path
    if any(isinstance(before, Newton) for before in groups[:index]):
        return  # how those go on is not known yet
    # one place is enough where it is open: only a group that is flat in the initial position can be flat
    # everywhere
    if bool(np.all(np.abs(here.value) > SAFETY * here.bound)):
        return
    away = Rounded.of(path.initial + path.unit * AWAY)
    there = Rounded.of(kinematics.guard(ROUNDED, away, index, FixedSigns(ROUNDED, signs)))
    # flat at three places as well: generic places, so it is flat always
    if bool(np.all(np.abs(there.value) <= SAFETY * there.bound)):
        raise InputError(
            name_of(group),
            _("its triangle is degenerate for every value of the drive, so its assembly modes coincide"),
            _("change a length, or remove a link"),
        )


def is_measured(numbers: Dimensions, at: Positions, link: str) -> bool:
    """Whether everything that a link's angle is measured between has a place already."""
    return link in numbers.ends and all(end in at.points for end in numbers.ends[link])


def angle_off(numbers: Dimensions, angle: float, at: Positions, link: str) -> float:
    """By how much a link is turned from an angle, in (-pi, pi]."""
    cosine, sine = rotor_of_angle(ARRAYS, numbers, at, link)
    return remainder(float(np.arctan2(sine, cosine)) - angle, tau)


# By how much a group of class II falls short of closing, in words a designer can act on.


def shortfall(group: Group, numbers: Dimensions, at: Positions, display: Display) -> str:
    """The sentence that says what is too short or too long, and by how much in the units of the display."""
    if isinstance(group, Aim):
        return _of_aim(group, numbers, at, display)
    assert isinstance(group, Meet)
    one, other = loci_of(group, ARRAYS, numbers, at, SideChoices(EvaluationPolicy(), 0))
    lack = numbers.space.lack(ARRAYS, one, other)
    by = _amount(max(lack), numbers.space, display)
    # lacks are in the order that `lack` gives: too short together, the first too long, the second too long,
    # too long together
    reason = lack.index(max(lack))
    links = [rod.link for rod in group.rods]
    if len(links) == 2:
        return _of_two_links(reason, (links[0], links[1]), by)
    if group.circles > len(links):
        return _of_circles(reason, [circle_name(locus) for locus in group.loci], by)
    if len(links) == 1:
        if reason in (1, 3):
            return _("link {a} is too long for its guide by {by}").format(a=links[0], by=by)
        return _("link {a} is too short to reach its guide by {by}").format(a=links[0], by=by)
    guides = [locus.guide for locus in group.loci if isinstance(locus, Rail)]
    return _("guides {names} do not meet by {by}").format(names=_(" and ").join(guides), by=by)


def _amount(size: float, space: Space, display: Display) -> str:
    factor, unit = shown_as(space.unit, display)
    return f"{factor * size:.4g} {terminal_unit(unit)}"


def _of_aim(group: Aim, numbers: Dimensions, at: Positions, display: Display) -> str:
    space = numbers.space
    pivot = space.place(ARRAYS, space.at_rest, numbers.local[group.link][group.pivot])
    offset = space.reach(ARRAYS, aim_curve(group, numbers), pivot)
    by = float(offset - space.distance(ARRAYS, at.points[group.target], at.points[group.pivot]))
    if by <= 0.0:  # only circles can be too near as well
        return _("{line} does not reach {b}").format(line=line_name(group), b=group.target)
    return _("the offset of {line} exceeds the distance {a}-{b} by {by}").format(
        line=line_name(group), a=group.pivot, b=group.target, by=_amount(by, space, display)
    )


def _of_two_links(reason: int, links: tuple[str, str], by: str) -> str:
    first, second = links
    if reason == 0:
        return _("links {a} and {b} together are too short by {by}").format(a=first, b=second, by=by)
    if reason == 3:
        return _("links {a} and {b} together are too long by {by}").format(a=first, b=second, by=by)
    longer, shorter = (first, second) if reason == 1 else (second, first)
    return _("link {a} is too long for link {b} by {by}").format(a=longer, b=shorter, by=by)


def _of_circles(reason: int, names: list[str], by: str) -> str:
    """Circles of which at least one is that of a cylinder or of a wheel; the other may be a line."""
    first, second = names
    if not second:
        return _("{a} is too short to reach its line by {by}").format(a=first, by=by)
    if reason == 0:
        return _("{a} and {b} together are too short by {by}").format(a=first, b=second, by=by)
    longer, shorter = (first, second) if reason == 1 else (second, first)
    return _("{a} is too long for {b} by {by}").format(a=longer, b=shorter, by=by)


def circle_name(locus: Locus) -> str:
    """Name of what draws the circle of a locus, for messages; empty for a line."""
    match locus:
        case Rod(link=link):
            return _("link {link}").format(link=link)
        case CylinderCircle(drive=drive):
            return _("cylinder {drive}").format(drive=drive)
        case Touch(contact=contact, letter="R"):
            return _("wheel {wheel}").format(wheel=contact.rolling)
        case Touch() | Rail() | Slot() | GuideStop() | Rolloff():
            return ""
        case _:
            assert_never(locus)


def line_name(group: Aim) -> str:
    """Name of the guide or wheel with which an aimed link passes its target, for messages."""
    if group.contact is not None:
        return _("wheel {wheel}").format(wheel=group.contact.rolling)
    return _("guide {guide}").format(guide=group.guide)


# What decides while the initial position is assembled: turns by the description, bounds, one side of a group.


class Starting(EvaluationPolicy):
    """Angles in the turn that the description names; of what is no link in (-pi, pi]."""

    def __init__(self, kinematics: Kinematics) -> None:
        self.links = kinematics.structure.mechanism.links

    def continue_angle(self, group: int, key: str, angle: Number) -> Number:
        # gears and tracks need the turn, not only the direction
        near = self.links[key].angle if key in self.links else None
        value = float(angle.value if isinstance(angle, Rounded) else angle)
        return angle if near is None else angle + tau * np.round((near - value) / tau)


class Bounding(Starting):
    """A group with rounding bounds: keeps its radicand, refuses a divisor that may be zero."""

    def __init__(self, kinematics: Kinematics, group: Group, sign: float) -> None:
        super().__init__(kinematics)
        self.solved = group
        self.sign = sign
        self.radicand = Rounded(0.0, 0.0)

    def root(self, group: int, radicand: Number) -> Number:
        self.radicand = Rounded.of(radicand)
        return ROUNDED.sqrt(radicand) * self.sign

    def divisor(self, group: int, divisor: Number) -> Number:
        sine = Rounded.of(divisor)
        if abs(sine.value) <= SAFETY * sine.bound:
            raise undetermined_error(self.solved)
        return sine


class OneSide(Starting):
    """Policy that takes one of a group's two assemblies, and refuses a group that falls short of closing."""

    def __init__(
        self, kinematics: Kinematics, group: Group, known: Positions, sign: float, bound: float
    ) -> None:
        super().__init__(kinematics)
        self.kinematics = kinematics
        self.solved = group
        self.known = known
        self.sign = sign
        self.bound = bound

    def root(self, group: int, radicand: Number) -> Number:
        # what is below zero by rounding counts as closed: flat, at a limit
        if radicand < -SAFETY * self.bound:
            raise InputError(
                name_of(self.solved),
                _("it does not close in the initial position: {by_how_much}").format(
                    by_how_much=shortfall(
                        self.solved,
                        self.kinematics.numbers,
                        self.known,
                        self.kinematics.structure.mechanism.display,
                    )
                ),
                _("change a length, or the initial position"),
            )
        return self.sign * np.sqrt(max(radicand, 0.0))


def undetermined_error(group: Group) -> InputError:
    """The refusal of a group whose initial position its formulas do not determine."""
    return InputError(
        name_of(group),
        _(
            "the initial position is undetermined there: two of its points coincide, or its lines are parallel"
        ),
        _("start the drive elsewhere, or change the dimensions"),
    )


# Whether a position closes: constraints that repeat others hold only if their dimensions fit.

RESIDUAL_TOLERANCE = 1e-9
"""Greatest residual of a closed mechanism, in units of its greatest length."""


def refuse_surplus_drives(structure: Structure) -> None:
    """Refuse more drives than a mechanism has mobility: they tear groups apart and contradict each other.

    A mechanism that is rigid at a generic position may move by its special dimensions: it is not refused here.
    """
    if 1 <= structure.generic_mobility < structure.drives:
        raise InputError(
            "[[drives]]",
            drives_against_mobility(structure.drives, structure.generic_mobility),
            _("give as many drives as the mobility"),
        )


def check_fit(kinematics: Kinematics, at: Positions) -> float:
    """Worst residual (see `residuals_at`); refuse a position in which a constraint does not hold."""
    structure = kinematics.structure
    misfits = residuals_at(structure.constraints, kinematics.numbers, at)
    residuals = {c.label: (value, c.angular) for c, value in misfits.items()}
    residuals |= {label: (value, False) for label, value in length_misfits(kinematics, at).items()}
    # of all constraints the worst one is reported
    label = max(residuals, key=lambda name: residuals[name][0])
    value, angular = residuals[label]
    if value > RESIDUAL_TOLERANCE:
        # surplus drives contradict each other: that is what is wrong, not a length
        refuse_surplus_drives(structure)
        space = kinematics.numbers.space
        off, unit = (value, "rad") if angular else (value * float(kinematics.numbers.scale), space.unit)
        raise InputError(
            label,
            _(
                "the initial position does not assemble: the residual of this constraint is {off:.3g} {unit}"
            ).format(off=off, unit=terminal_unit(unit)),
            _repair_of_misfit(structure.drives),
        )
    return value


def _repair_of_misfit(drives: int) -> str:
    if drives > 1:
        # special dimensions move though the count says no: a drive may be one too many all the same
        return _(
            "it repeats other constraints, so its dimensions must agree with theirs: correct them, or remove it "
            "or a drive"
        )
    return _(
        "it repeats other constraints, so its dimensions must agree with theirs: correct them or remove it"
    )


def check_touch(kinematics: Kinematics, at: Positions) -> None:
    """Refuse a wheel whose centre something else keeps off its track."""
    numbers = kinematics.numbers
    for constraint in kinematics.structure.redundant:
        if not isinstance(constraint, TrackContact):
            continue
        (off,) = (float(x) for x in constraint.residual(ARRAYS, numbers, at))
        if abs(off) <= RESIDUAL_TOLERANCE * float(numbers.scale):
            continue
        track = numbers.gearing.track[constraint.rolling]
        what = (
            _(
                "the wheel does not touch its track in the initial position: its centre is {by:.4g} m too far away"
            )
            if off > 0.0
            else _(
                "the wheel does not touch its track in the initial position: its centre is {by:.4g} m too near"
            )
        )
        repair = (
            _("correct the radius or the line; its direction has the wheel's centre on its left")
            if isinstance(track, Straight)
            else _("correct the radii; inside = true rolls inside the circle, false outside")
        )
        raise InputError(f"[[rolling]] {constraint.rolling}", what.format(by=abs(off)), repair)


def length_misfits(kinematics: Kinematics, at: Positions) -> dict[str, float]:
    """By how much links laid through two known points do not fit between them, in units of the greatest length.

    Their constraints do not tell: such a link is stretched to fit.
    """
    misfits = {}
    space = kinematics.numbers.space
    for group in kinematics.structure.groups:
        if isinstance(group, TwoPointLink):
            local = kinematics.numbers.local[group.link]
            first, second = (
                space.place(ARRAYS, space.at_rest, local[point]) for point in (group.first, group.second)
            )
            given = space.distance(ARRAYS, first, second)
            reached = space.distance(ARRAYS, at.points[group.first], at.points[group.second])
            label = _("length of link {link}").format(link=group.link)
            misfits[label] = float(abs(reached - given)) / float(kinematics.numbers.scale)
    return misfits
