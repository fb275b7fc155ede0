"""Constraints of a mechanism of a file as misses that steer its search: box, transmission angle, ratio of lengths.

A miss is zero where a constraint holds, and grows with what is exceeded; its derivatives by the free numbers are those
of the places of points and of the angles of links, which the sweep kernels give exactly.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from centrode.errors import InputError
from centrode.kinematics.preparation import ready
from centrode.locale import _
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.reading import two_points
from centrode.structure.groups import Aim, Meet, Rail, Rod, Slot
from centrode.sweeps.outputs import identifier
from centrode.synthesis.four_bars import Array, Complex
from centrode.synthesis.requests import Constraints

MARGIN = 1e-5
"""Share by which a limit is kept, so that what a weight leaves does not break it."""
KEPT = 1e-6
"""Part by which a limit may be missed."""
PIVOT_MARGIN = 1e-7
"""Of the box of fixed hinges, which may be as narrow as a point."""
BOX_MARGIN = 2e-5
"""Of a box: what parabolas between samples leave is smaller."""
Numbers: TypeAlias = Mapping[str, Array]
Line: TypeAlias = Callable[[Numbers, Numbers], tuple[Complex, Complex]]
"""(outputs, their derivatives) -> complex directions (samples,) and derivatives (samples, free)."""


@dataclass(frozen=True)
class MechanismConstraints:
    """What steers a search beside its targets.

    Attributes
    ----------
    outputs : name -> what the solver computes for it
    misses : of these outputs, their derivatives and the number of free numbers: (m,) and (m, free)
    points : those that stand among the outputs as they do in the plane, as "box_P_x" and "box_P_y"
    """

    outputs: Mapping[str, str]
    misses: Callable[[Numbers, Numbers, int], tuple[Array, Array]]
    points: tuple[str, ...] = ()


def mechanism_constraints(
    mechanism: Mechanism, constraints: Constraints, placed_size: float | None = None
) -> MechanismConstraints:
    """The constraints on size, transmission and lengths of a mechanism in the plane, of a placed one on its pivots too.

    Pivots of a mechanism that stands where it is are ranges of its free numbers.

    Parameters
    ----------
    placed_size : of the targets [m], on which a mechanism is placed; None where it stands as it is described

    Raises InputError where a transmission angle is required of a mechanism that has none.
    """
    outputs: dict[str, str] = {}
    parts: list[Callable[[Numbers, Numbers, int], tuple[Array, Array]]] = []
    boxed: dict[str, None] = {}
    if constraints.size is not None:
        box = _BoxLimit(tuple(_points(mechanism)), constraints.size)
        boxed |= dict.fromkeys(box.points)
        parts.append(box.misses)
    pivots = constraints.pivots
    if placed_size is not None and (pivots.x is not None or pivots.y is not None):
        fixed = tuple(mechanism.frame.points)
        boxed |= dict.fromkeys(fixed)
        parts.append(_PivotLimit(fixed, (pivots.x, pivots.y), placed_size).misses)
    if constraints.transmission is not None:
        dyads = list(_dyads(mechanism, outputs))
        if not dyads:
            what = _("no group of the mechanism has a transmission angle")
            raise InputError("[synthesis.constraints] transmission", what, _("remove it"))
        parts.append(_TransmissionLimit(tuple(dyads), constraints.transmission).misses)
    if constraints.length_ratio is not None:
        ends = link_ends(mechanism)
        boxed |= dict.fromkeys(point for two in ends.values() for point in two)
        parts.append(_LengthLimit(tuple(ends.values()), math.log(constraints.length_ratio)).misses)

    outputs |= {box_output(p, axis): identifier("position", p, axis) for p in boxed for axis in "xy"}

    def misses(values: Numbers, by: Numbers, free: int) -> tuple[Array, Array]:
        rows = [part(values, by, free) for part in parts]
        missed = np.concatenate([row for row, _slopes in rows] or [np.empty(0)])
        slopes = np.concatenate([slope for _row, slope in rows] or [np.empty((0, free))])
        return missed, slopes

    return MechanismConstraints(outputs, misses, tuple(boxed))


def box_output(point: str, axis: str) -> str:
    """Name among the outputs of a coordinate of a point where the mechanism stands."""
    return f"box_{_spell(point)}_{axis}"


def _spell(name: str) -> str:
    """A name of a point or a link in the letters that the name of an output may have."""
    return name.encode().hex()


def link_ends(mechanism: Mechanism) -> dict[str, tuple[str, str]]:
    """Link -> two points between which it has its length: those it is named by, else its first two."""
    ends: dict[str, tuple[str, str]] = {}
    for name, link in mechanism.links.items():
        at = list(link.coordinates)
        named = two_points(name)
        if named and set(named) <= set(at):
            ends[name] = named[0], named[1]
        elif len(at) > 1:
            ends[name] = at[0], at[1]
    return ends


def _points(mechanism: Mechanism) -> list[str]:
    """All points, those of the frame too."""
    links = mechanism.links.values()
    return list(dict.fromkeys([*mechanism.frame.points, *(point for link in links for point in link.points)]))


@dataclass(frozen=True)
class _BoxLimit:
    """Width and height of the box around all positions: what they exceed in shares of what is allowed."""

    points: tuple[str, ...]
    size: Sequence[float]

    def misses(self, values: Numbers, by: Numbers, free: int) -> tuple[Array, Array]:
        """Two misses (2,) with derivatives (2, free): those of the two points that stand out farthest."""
        rows, slopes = np.zeros(2), np.zeros((2, free))
        for k, axis in enumerate("xy"):
            ends = [
                _greatest(sign, values, by, [box_output(p, axis) for p in self.points]) for sign in (1, -1)
            ]
            excess = (ends[0][0] + ends[1][0]) / self.size[k] - 1.0 + BOX_MARGIN
            if excess > 0:
                rows[k], slopes[k] = excess, (ends[0][1] + ends[1][1]) / self.size[k]
        return rows, slopes


def _greatest(sign: int, values: Numbers, by: Numbers, names: Sequence[str]) -> tuple[float, Array]:
    """Greatest of outputs times a sign, with its derivatives (free,): between samples that of the parabola there."""
    name = max(names, key=lambda one: float((sign * values[one]).max()))
    places = sign * values[name]
    k = int(np.argmax(places))
    if not 0 < k < len(places) - 1:
        return float(places[k]), sign * by[name][k]
    return _summit(places, sign * by[name], k)


def _summit(places: Array, changes: Array, k: int) -> tuple[float, Array]:
    """Top of the parabola through three samples about a greatest one, with its derivatives."""
    before, here, after = places[k - 1 : k + 2]
    bend = max(2 * here - before - after, 1e-300)
    part = float(np.clip((after - before) / (2 * bend), -0.5, 0.5))
    weights = np.array([part * (part - 1) / 2, 1 - part**2, part * (part + 1) / 2])
    # where it is greatest its place does not change it
    return float(weights @ places[k - 1 : k + 2]), weights @ changes[k - 1 : k + 2]


@dataclass(frozen=True)
class _PivotLimit:
    """Fixed hinges of a placed mechanism: how far they stand outside a box, in sizes of the targets."""

    points: tuple[str, ...]
    box: Sequence[tuple[float, float] | None]
    size: float

    def misses(self, values: Numbers, by: Numbers, free: int) -> tuple[Array, Array]:
        """One miss a point, axis and end that is given, with its derivatives; a fixed point stands still."""
        rows, slopes = [], []
        for axis, ends in zip("xy", self.box, strict=True):
            if ends is None:
                continue
            margin = min(PIVOT_MARGIN, 0.25 * (ends[1] - ends[0]) / self.size)
            for point in self.points:
                place, change = values[box_output(point, axis)][0], by[box_output(point, axis)][0]
                for sign, end in ((1.0, ends[1]), (-1.0, ends[0])):
                    excess = sign * (place - end) / self.size + margin
                    rows.append(max(excess, 0.0))
                    slopes.append(sign * change / self.size if excess > 0 else np.zeros(free))
        return np.array(rows), np.array(slopes)


@dataclass(frozen=True)
class _LengthLimit:
    """The logarithm of the longest to the shortest link, less what is allowed."""

    ends: tuple[tuple[str, str], ...]
    ratio: float

    def misses(self, values: Numbers, by: Numbers, free: int) -> tuple[Array, Array]:
        """One miss (1,) with derivatives (1, free); a link is as long at the first sample as at any other."""
        logs, slopes = [], []
        for first, second in self.ends:
            apart = np.array(
                [values[box_output(second, axis)][0] - values[box_output(first, axis)][0] for axis in "xy"]
            )
            change = np.array(
                [by[box_output(second, axis)][0] - by[box_output(first, axis)][0] for axis in "xy"]
            )
            square = max(float(apart @ apart), 1e-300)
            logs.append(0.5 * math.log(square))
            slopes.append(apart @ change / square)
        longest, shortest = int(np.argmax(logs)), int(np.argmin(logs))
        excess = logs[longest] - logs[shortest] - self.ratio + MARGIN
        if excess <= 0:
            return np.zeros(1), np.zeros((1, free))
        return np.array([excess]), (slopes[longest] - slopes[shortest])[None]


@dataclass(frozen=True)
class _TransmissionLimit:
    """How far the angle of each dyad's two lines falls short at every sample, as cosines."""

    dyads: tuple[tuple[Line, Line], ...]
    least: float

    def misses(self, values: Numbers, by: Numbers, free: int) -> tuple[Array, Array]:
        """One row a sample and dyad, in units of which all samples of a dyad count as one."""
        rows, slopes = [], []
        for one, other in self.dyads:
            (first, first_by), (second, second_by) = one(values, by), other(values, by)
            turned = second * first.conj()
            change = second_by * first.conj()[:, None] + second[:, None] * first_by.conj()
            # the cosine of turned/|turned| changes with its angle only
            angle = np.angle(turned)
            angle_by = (change / turned[:, None]).imag
            cosine = np.abs(np.cos(angle))
            slope = -(np.sign(np.cos(angle)) * np.sin(angle))[:, None] * angle_by
            samples, changes = cosine.copy(), slope.copy()
            for k in np.flatnonzero((cosine[1:-1] >= cosine[:-2]) & (cosine[1:-1] >= cosine[2:])) + 1:
                cosine[k], slope[k] = _summit(samples, changes, int(k))
            excess = cosine - math.cos(self.least) + MARGIN
            over = excess > 0
            rows.append(np.where(over, excess, 0.0) / math.sqrt(len(excess)))
            slopes.append(np.where(over[:, None], slope, 0.0) / math.sqrt(len(excess)))
        return np.concatenate(rows), np.concatenate(slopes)


def _dyads(mechanism: Mechanism, outputs: dict[str, str]) -> Iterator[tuple[Line, Line]]:
    """The two lines of each dyad that has a transmission angle; adds the outputs that they are made of.

    Of two links they are the links, else the lines along which the loci let a point move, as in
    `centrode.analysis.transmission`.
    """
    prepared = ready(mechanism)
    along = {name: complex(*at) for name, at in prepared.structure.dimensions.direction.items()}

    def guide(on: str, name: str) -> Line:
        if on != FRAME:
            outputs[f"line_{_spell(on)}"] = identifier("angle", on)
        return _RailLine(along[name], "" if on == FRAME else f"line_{_spell(on)}")

    def arm(centre: str, point: str, turn: complex) -> Line:
        ends = (centre, point)
        outputs.update(
            {f"line_{_spell(p)}_{axis}": identifier("position", p, axis) for p in ends for axis in "xy"}
        )
        return _ArmLine(centre, point, turn)

    for group in prepared.structure.groups:
        if isinstance(group, Aim) and group.contact is None:
            yield arm(group.target, group.pivot, 1j), guide(group.link, group.guide)
        elif isinstance(group, Meet) and not group.has_stop:
            lines: list[Line] = []
            for locus in group.loci:
                if isinstance(locus, Rod):
                    lines.append(arm(locus.centre, locus.point, 1.0 if group.circles == 2 else 1j))
                elif isinstance(locus, Rail):
                    lines.append(guide(locus.on, locus.guide))
                elif isinstance(locus, Slot) and group.carriage is not None:
                    lines.append(guide(group.carriage, locus.guide))
            if len(lines) == 2:
                yield lines[0], lines[1]


@dataclass(frozen=True)
class _ArmLine:
    """From one point to another, turned by a factor of unit size."""

    end: str
    start: str
    turn: complex

    def __call__(self, values: Numbers, by: Numbers) -> tuple[Complex, Complex]:
        """Complex directions and their derivatives."""
        ends = [
            numbers[f"line_{_spell(point)}_x"] + 1j * numbers[f"line_{_spell(point)}_y"]
            for numbers in (values, by)
            for point in (self.end, self.start)
        ]
        return self.turn * (ends[0] - ends[1]), self.turn * (ends[2] - ends[3])


@dataclass(frozen=True)
class _RailLine:
    """A guide's direction: as it is on the frame, or turned with the link that carries it."""

    along: complex
    angle: str

    def __call__(self, values: Numbers, by: Numbers) -> tuple[Complex, Complex]:
        """Complex directions and their derivatives."""
        if not self.angle:
            sample = next(iter(values))
            size = len(np.atleast_1d(values[sample]))
            return np.full(size, self.along), np.zeros((size, by[sample].shape[-1]), dtype=np.complex128)
        direction = self.along * np.exp(1j * values[self.angle])
        return direction, 1j * direction[:, None] * by[self.angle]


@dataclass(frozen=True)
class BrokenConstraint:
    """A constraint that a mechanism does not keep.

    Attributes
    ----------
    name : its key
    own, limit : what the mechanism has, and what is allowed; None of order and crank
    unit : of both, as it is read
    """

    name: str
    own: float | None = None
    limit: float | None = None
    unit: str = ""

    def sentence(self, error: float | None) -> str:
        """What is broken and by how much; the root mean square error [m] of the targets, where they are points."""
        if self.own is None or self.limit is None:
            what = _("the nearest breaks {what}").format(what=self.name)
        else:
            what = {
                "m": _("the nearest breaks {what}: {own:.5g} m, where {limit:.5g} m is the limit"),
                "deg": _("the nearest breaks {what}: {own:.5g} deg, where {limit:.5g} deg is the limit"),
            }.get(self.unit, _("the nearest breaks {what}: {own:.5g}, where {limit:.5g} is the limit"))
            what = what.format(what=self.name, own=self.own, limit=self.limit)
        if error is None:
            return what
        return what + "; " + _("it misses the targets by {miss:.3g} m").format(miss=error)


def broken_constraints(
    mechanism: Mechanism,
    constraints: Constraints,
    size: tuple[float, float],
    transmission: float,
    branch: bool,
    order: bool,
) -> Iterator[BrokenConstraint]:
    """What a mechanism does not keep, by its whole motion.

    Parameters
    ----------
    size : width and height [m] of the box around all positions
    transmission : least transmission angle [rad]; NaN where there is none
    branch, order : its defects
    """
    if branch and (constraints.order or constraints.crank is not None):
        yield BrokenConstraint("crank" if constraints.crank is not None else "order")
    if order and constraints.order:
        yield BrokenConstraint("order")
    least = constraints.transmission
    if least is not None and not transmission >= least - KEPT:
        yield BrokenConstraint("transmission", math.degrees(transmission), math.degrees(least), "deg")
    if constraints.size is not None:
        for own, most in zip(size, constraints.size, strict=True):
            if own > most * (1 + KEPT):
                yield BrokenConstraint("size", own, most, "m")
    for axis, box in enumerate((constraints.pivots.x, constraints.pivots.y)):
        if box is None:
            continue
        places = np.array(list(mechanism.frame.points.values()), dtype=np.float64)[:, axis].tolist()
        for own, limit, sign in ((min(places), box[0], -1.0), (max(places), box[1], 1.0)):
            if sign * (own - limit) > KEPT:
                yield BrokenConstraint(f"pivots.{'xy'[axis]}", own, limit, "m")
    if constraints.length_ratio is not None:
        lengths = list(_lengths(mechanism))
        if max(lengths) > constraints.length_ratio * min(lengths) * (1 + KEPT):
            yield BrokenConstraint("length_ratio", max(lengths) / min(lengths), constraints.length_ratio)


def _lengths(mechanism: Mechanism) -> Iterator[float]:
    for link, (first, second) in link_ends(mechanism).items():
        at = mechanism.links[link].coordinates
        yield math.dist(at[first][:2], at[second][:2])
