"""Whether a position closes: constraints that repeat others hold only if their dimensions fit."""

from __future__ import annotations

from centrode.algebra.arrays import ARRAYS
from centrode.errors import InputError
from centrode.kinematics.evaluate import Kinematics
from centrode.locale import _
from centrode.structure.constraints import Contact, Positions
from centrode.structure.gearing import Straight
from centrode.structure.groups import TwoPointLink
from centrode.structure.plan import drives_against_mobility
from centrode.structure.rank import residuals_at

RESIDUAL_TOLERANCE = 1e-9
"""Greatest residual of a closed mechanism, in units of its greatest length."""


def check_fit(kinematics: Kinematics, at: Positions) -> float:
    """Worst residual (see `residuals_at`); refuse a position in which a constraint does not hold."""
    structure = kinematics.structure
    found = residuals_at(structure.constraints, kinematics.numbers, at)
    residuals = {c.label: (value, c.angular) for c, value in found.items()}
    residuals |= {label: (value, False) for label, value in length_misfits(kinematics, at).items()}
    label = max(residuals, key=lambda name: residuals[name][0])
    value, angular = residuals[label]
    if value > RESIDUAL_TOLERANCE:
        if 1 <= structure.generic_mobility < structure.drives:
            # the drives contradict each other: that is what is wrong, not a length
            raise InputError(
                "[[drives]]",
                drives_against_mobility(structure.drives, structure.generic_mobility),
                _("give as many drives as the mobility"),
            )
        space = kinematics.numbers.space
        off, unit = (value, "rad") if angular else (value * float(kinematics.numbers.scale), space.unit)
        raise InputError(
            label,
            _("the initial position does not assemble: this constraint is off by {off:.3g} {unit}").format(
                off=off, unit=unit
            ),
            _repair_of_misfit(structure.drives),
        )
    return value


def _repair_of_misfit(drives: int) -> str:
    if drives > 1:
        # special dimensions move though the count says no: a drive may be one too many all the same
        return _(
            "it repeats other constraints, so its dimensions must fit theirs: correct them, or take it or a drive away"
        )
    return _("it repeats other constraints, so its dimensions must fit theirs: correct them or take it away")


def check_touch(kinematics: Kinematics, at: Positions) -> None:
    """Refuse a wheel whose centre something else keeps off its track."""
    numbers = kinematics.numbers
    for constraint in kinematics.structure.redundant:
        if not isinstance(constraint, Contact):
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
