"""Why a group stops a mechanism, or lets its assemblies meet: in a sentence, and in symbols."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from centrode.algebra.arrays import ARRAYS
from centrode.analysis.turning.symbols import (
    HIGHER,
    Bearing,
    bearing_between,
    bearing_of,
    parallel,
    square,
)
from centrode.analysis.turning.tours import Tour
from centrode.geometry.plane import dot, subtract
from centrode.kinematics.dyads import aim_curve, loci_of
from centrode.kinematics.plan_evaluation import FixedSigns, SideChoices
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.quantities import display_unit
from centrode.structure.dimensions import Dimensions
from centrode.structure.groups import Aim, Group, Locus, Meet, Rail, Rod, Slot, Stop, Stroke

Number: TypeAlias = Any


@dataclass(frozen=True)
class Cause:
    """Why: a sentence, and the condition of the group's own geometry that holds there ("sin(phi3 - phi4) = 0")."""

    sentence: str
    condition: str


def cause_of(tour: Tour, group: Group, index: int, value: float, *, crossing: bool = False) -> Cause:
    """Why a group is at a limit, or at a change point (`crossing`), at a value of the drive."""
    mechanism, numbers = tour.prepared.mechanism, tour.continuation.kinematics.numbers
    about = _About(tour, mechanism, numbers, index, value)
    if isinstance(group, Aim):
        return _of_aim(about, group)
    if not isinstance(group, Meet):
        sentence = (
            _("positions of the group meet: the determinant of its equations is zero")
            if crossing
            else _("the positions of the group turn back: the determinant of its equations is zero")
        )
        return Cause(sentence, HIGHER)
    if group.kind == "RRR":
        return _of_two_rods(about, group)
    if group.kind == "RRP":
        return _of_rod_and_line(about, group)
    return _of_two_lines(about, group)


@dataclass(frozen=True)
class _About:
    """What a cause is told of."""

    tour: Tour
    mechanism: Mechanism
    numbers: Dimensions
    index: int
    value: float

    @property
    def on_sphere(self) -> bool:
        return self.mechanism.space == "sphere"

    def length(self, value: float) -> str:
        """A length, on the sphere an arc, in the units of the reader."""
        value = 0.0 if abs(value) <= 1e-12 * float(self.numbers.scale) else value
        display = self.mechanism.display
        factor, shown = display_unit(self.numbers.space.unit, display.length, display.angle)
        return f"{value * factor:.6g} {shown}"


def _one(x: Number) -> float:
    return float(np.reshape(x, -1)[0])


def body_of(locus: Locus) -> str:
    """A locus by what draws it: a link, a cylinder or a guide."""
    if isinstance(locus, Rod):
        return locus.link
    if isinstance(locus, Stroke):
        return _("cylinder {name}").format(name=locus.drive)
    if isinstance(locus, (Rail, Slot, Stop)):
        return _("guide {name}").format(name=locus.guide)
    return _("the track of a wheel")


def bearing_of_locus(
    mechanism: Mechanism, numbers: Dimensions, locus: Locus, carriage: str
) -> Bearing | None:
    """Bearing of a rod, or of a line on which a point moves; None where a wheel draws it."""
    if isinstance(locus, Rod):
        return bearing_between(mechanism, numbers, locus.link, locus.centre, locus.point)
    if isinstance(locus, Stroke):
        return Bearing(("psi_" + locus.drive.replace("-", ""),))
    if isinstance(locus, Rail):
        return bearing_of(mechanism, locus.on, numbers.direction[locus.guide])
    if isinstance(locus, Slot):
        return bearing_of(mechanism, carriage, numbers.direction[locus.guide])
    if isinstance(locus, Stop):
        x, y = numbers.direction[locus.guide]
        return bearing_of(mechanism, locus.on, (-y, x))
    return None


def _conditions(about: _About, group: Meet) -> tuple[Bearing | None, Bearing | None]:
    carriage = group.carriage or ""
    one, other = (bearing_of_locus(about.mechanism, about.numbers, locus, carriage) for locus in group.loci)
    return one, other


def _of_two_rods(about: _About, group: Meet) -> Cause:
    """The centres and the point where the rods meet lie on one line: stretched out, or folded."""
    one, other = (body_of(locus) for locus in group.loci)
    stretched, apart = _stretched(about, group)
    first, second = (getattr(locus, "centre", "") for locus in group.loci)
    if about.on_sphere:
        condition = f"sin(angle {first}-{group.points[0]}-{second}) = 0"
        line = _("{one} and {other} lie on one great circle")
    else:
        bearings = _conditions(about, group)
        condition = HIGHER if None in bearings else parallel(*bearings)  # type: ignore[arg-type]
        line = (
            _("{one} and {other} stand parallel") if group.carriage else _("{one} and {other} fall in line")
        )
    how = _("stretched out") if stretched else _("folded over each other")
    sentence = _("{line}, {how}").format(line=line.format(one=one, other=other), how=how)
    if first and second and not group.carriage:
        sentence = _("{sentence} ({first} and {second} are {apart} apart)").format(
            sentence=sentence, first=first, second=second, apart=about.length(apart)
        )
    return Cause(sentence, condition)


def _stretched(about: _About, group: Meet) -> tuple[bool, float]:
    """Whether two circles touch from outside, and how far apart their centres are."""
    at = about.tour.stopped(about.value, ARRAYS)
    choices = SideChoices(FixedSigns(ARRAYS, {about.index: 0.0}), about.index)
    space = about.numbers.space
    with np.errstate(all="ignore"):
        one, other = loci_of(group, ARRAYS, about.numbers, at, choices)
        apart = _one(space.distance(ARRAYS, one.centre, other.centre))
    radii = [_radius(circle) for circle in (one, other)]
    total, difference = sum(radii), abs(radii[0] - radii[1])
    total = min(total, 2.0 * np.pi - total) if about.on_sphere else total
    return abs(apart - total) <= abs(apart - difference), apart


def _radius(circle: Any) -> float:
    """Radius [m], on the sphere the arc [rad], of a circle."""
    if hasattr(circle, "half"):
        sine, cosine = (_one(x) for x in circle.half)
        return 2.0 * float(np.arctan2(abs(sine), abs(cosine)))
    return abs(_one(circle.radius))


def _of_rod_and_line(about: _About, group: Meet) -> Cause:
    """The rod stands square to the line on which its end moves."""
    rod, line = group.loci
    names = {"rod": body_of(rod), "guide": body_of(line)}
    if about.on_sphere:
        on = getattr(line, "guide", "")
        condition = f"cos(angle between {names['rod']} and guide {on}) = 0"
        return Cause(_("{rod} stands square to {guide}").format(**names), condition)
    bearings = _conditions(about, group)
    condition = HIGHER if None in bearings else square(*bearings)  # type: ignore[arg-type]
    if isinstance(line, Stop):
        return Cause(_("{rod} lies along {guide}").format(**names), condition)
    return Cause(_("{rod} stands square to {guide}").format(**names), condition)


def _of_two_lines(about: _About, group: Meet) -> Cause:
    """Two lines are parallel: where they meet goes to infinity."""
    one, other = (body_of(locus) for locus in group.loci)
    if about.on_sphere:
        return Cause(_("the circles of {one} and {other} touch").format(one=one, other=other), HIGHER)
    bearings = _conditions(about, group)
    condition = HIGHER if None in bearings else parallel(*bearings)  # type: ignore[arg-type]
    sentence = _("{one} and {other} are parallel: where they meet goes to infinity")
    return Cause(sentence.format(one=one, other=other), condition)


def _of_aim(about: _About, group: Aim) -> Cause:
    """The target is as near to the pivot as the line in the aimed link: the arm to it stands square to the line."""
    names = {"pivot": group.pivot, "target": group.target, "link": group.link, "guide": group.guide}
    if group.contact is not None:
        return Cause(_("{link} cannot come nearer to the wheel about {target}").format(**names), HIGHER)
    if about.on_sphere:
        condition = f"cos(angle between arc {group.pivot}-{group.target} and guide {group.guide}) = 0"
        return Cause(
            _("the arc from {pivot} to {target} stands square to guide {guide}").format(**names), condition
        )
    through, direction = aim_curve(group, about.numbers)
    to_pivot = subtract(about.numbers.local[group.link][group.pivot], through)
    foot = float(dot(direction, to_pivot))
    slide = f"s_{group.guide}"
    condition = (
        f"{slide} = {about.length(foot)}"
        if abs(foot) > 1e-12 * float(about.numbers.scale)
        else f"{slide} = 0"
    )
    offset = abs(float(direction[0] * to_pivot[1] - direction[1] * to_pivot[0]))
    if offset <= 1e-12 * float(about.numbers.scale):
        return Cause(_("{target} comes to the pivot {pivot} of {link}").format(**names), condition)
    sentence = _(
        "the line from {pivot} to {target} stands square to guide {guide}: {target} comes no nearer than {by}"
    )
    return Cause(sentence.format(**names, by=about.length(offset)), condition)
