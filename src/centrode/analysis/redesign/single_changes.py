"""The change of one dimension after which a mechanism that locks makes the motion that its description asks for.

The motion is a full turn of the drive, or the range between the ends that the description gives. Each dimension is
varied alone, from its present value outwards, until every dyad keeps its transmission angle all over the motion; the
value is rounded away from the dead position in the units of the display. What is found is assembled at every sample
of the motion.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import asin, floor, inf, log10, pi, sin, sqrt, tau
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.redesign.candidates import (
    Candidates,
    Varying,
    narrow_bounds,
    paths_of_lengths,
    places_anew,
)
from centrode.analysis.redesign.repair import (
    COARSE,
    ENOUGH,
    FINE,
    LEAST_ANGLES,
    check_repairable,
    least,
    over_turn,
    squared_sines,
)
from centrode.analysis.rotatability.rotatability import LimitFound, Rotatability, rotatability
from centrode.errors import STATUSES_NOT_REACHED, CentrodeError
from centrode.kinematics.motion import motion
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.solve import requested_grid
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import value_at, with_value
from centrode.model.mechanism import FRAME, Guide, Mechanism
from centrode.model.placement import replace_placed
from centrode.model.settings import Display, shown_as
from centrode.model.values import Placed
from centrode.structure.dimensions import SPACES

if TYPE_CHECKING:
    import xarray as xr

Array: TypeAlias = npt.NDArray[np.float64]

SHORTEST, LONGEST = 0.2, 3.0
"""Between which shares of itself a length, or a distance in the frame, is varied."""
STEPS = 160
"""Values of a dimension that are tried below its present one, and above."""
HALVINGS = 40
FINER_VALUES = 65
"""Values about the best of a dimension, among which the greatest transmission angle is sought."""
ROUNDED = 0.03
"""Share of a value up to which it is rounded."""
DIGITS = 12
"""Digits of rounded values in SI: no more are meant."""
FINER = 4
"""How often a step of rounding is divided by ten where the rounded value is not good enough."""
NO_LENGTH = 1e-9
"""Share of the greatest length up to which a distance is none."""


@dataclass(frozen=True)
class DrivenRange:
    """Values of the drive [rad or m] that a description asks for; a full turn where `turn` is set."""

    low: float
    high: float
    turn: bool


@dataclass(frozen=True)
class Dimension:
    """A number of a description that a designer may change alone.

    Attributes
    ----------
    path : of the number
    kind : the length of a link, its initial angle, a coordinate of a point of the frame or of a guide's line
    name : of the link, the point or the guide
    axis : "x" or "y" of a coordinate
    """

    path: str
    kind: Literal["length", "angle", "point", "guide"]
    name: str
    axis: str = ""


@dataclass(frozen=True)
class SingleChange:
    """A dimension and the value with which the mechanism makes the motion.

    Attributes
    ----------
    dimension : what is changed
    unit : "rad" or "m"
    before, after : present value and the one proposed
    bound : value between them at which the mechanism just passes its dead position
    size : of the change, as `Repair` measures it: over the length, over the greatest length, or in radians
    least_angle : least transmission angle of all dyads over the motion [rad]
    residual : worst residual of the motion of the repaired mechanism, over its greatest length
    repaired : the mechanism with the value
    """

    dimension: Dimension
    unit: str
    before: float
    after: float
    bound: float
    size: float
    least_angle: float
    residual: float
    repaired: Mechanism


@dataclass(frozen=True)
class SingleChanges:
    """What one dimension alone repairs.

    Attributes
    ----------
    mechanism : the one given
    required : the motion that is asked for
    margin : transmission angle that every dyad keeps [rad]
    changes : the best of each dimension that repairs the mechanism: initial angles first, which a source calls initial
        data, then lengths and distances; of either the smallest first
    without : dimensions that do not
    wanted : transmission angle that is sought first [rad]
    named : whether it was named, so that no lesser one does
    greatest_change : the greatest that a change of a length or a distance may be, as `repair` has it
    greatest : the greatest transmission angle [rad] that any one dimension brings about between its bounds, where this
        is less than the first one wanted; else None
    """

    mechanism: Mechanism
    required: DrivenRange
    margin: float
    changes: tuple[SingleChange, ...]
    without: tuple[Dimension, ...]
    greatest: float | None = None
    wanted: float = LEAST_ANGLES[0]
    named: bool = False
    greatest_change: float | None = None


def required_range(prepared: Ready) -> DrivenRange:
    """The values of the one drive that a description asks for, from its initial value on."""
    path = prepared.kinematics.path
    places = requested_grid(prepared, None, None, None).parameter
    low, high = float(np.min(places)), float(np.max(places))
    turn = path.turns and high - low >= tau * (1.0 - NO_LENGTH)
    return DrivenRange(min(low, path.initial), max(high, path.initial), turn)


def is_reached(found: Rotatability, required: DrivenRange) -> bool:
    """Whether a mechanism makes a motion."""
    one = found.one
    if one.turns_fully or required.turn:
        return one.turns_fully is True
    bounds = {limit.end: limit.value for limit in one.limits}
    return bounds.get("low", -inf) <= required.low and required.high <= bounds.get("high", inf)


def single_changes(
    mechanism: MechanismSource,
    found: Rotatability | None = None,
    margins: Sequence[float] = LEAST_ANGLES,
    greatest_change: float | None = None,
) -> SingleChanges | None:
    """The dimensions of which each alone repairs a mechanism that locks; None where it makes the motion asked for.

    Parameters
    ----------
    found : Rotatability of the mechanism, where it is known
    margins : transmission angles [rad] that every dyad keeps; the first for which any dimension is found. One alone is
        named: a repair keeps it, or none is found
    greatest_change : of a length over itself, of a coordinate over the greatest length; as `repair` has it

    Raises
    ------
    InputError
        There are several drives.
    NotComputedYet
        Groups of higher class, gears and rolling wheels.

    Examples
    --------
    >>> import centrode as ct
    >>> from centrode.analysis.redesign.single_changes import single_changes
    >>> found = single_changes(ct.slider_crank(crank=2, coupler=3, offset=2))
    >>> [(change.dimension.path, round(change.bound, 6), change.after) for change in found.changes]
    [('guides.B.through.y', 1.0, 0.81), ('links.coupler.length', 4.0, 4.3), ('links.crank.length', 1.0, 0.81)]
    """
    mechanism = mechanism_of(mechanism)
    prepared = ready(mechanism)
    if len(mechanism.drives) == 1:
        required = required_range(prepared)
        if is_reached(rotatability(mechanism) if found is None else found, required):
            return None
    check_repairable(prepared, turning=False)
    searches = [
        DimensionSearch(prepared, one, required, greatest_change) for one in dimensions_of_design(mechanism)
    ]
    greatest = None
    sought = margins[0], len(margins) == 1, greatest_change
    for margin in margins:
        changes = {search.dimension: search.change(margin) for search in searches}
        good = sorted((change for change in changes.values() if change is not None), key=_rank)
        if good:
            without = tuple(one for one, change in changes.items() if change is None)
            return SingleChanges(mechanism, required, margin, tuple(good), without, greatest, *sought)
        if greatest is None:
            most = max((search.greatest() for search in searches), default=0.0)
            greatest = asin(sqrt(min(most, 1.0))) if most > 0.0 else None
    return SingleChanges(mechanism, required, margins[-1], (), tuple(changes), greatest, *sought)


def _rank(change: SingleChange) -> tuple[bool, float]:
    """Initial data before dimensions, small changes before great ones."""
    return change.dimension.kind != "angle", change.size


@dataclass(frozen=True)
class DeadPosition:
    """Where a mechanism that locks ends its motion, and where a repaired one stands then.

    Attributes
    ----------
    limit : what bounds the motion
    locked : motion with one sample, the mechanism there
    repaired : motion with one sample, the repaired mechanism at the same value of the drive
    """

    limit: LimitFound
    locked: xr.Dataset
    repaired: xr.Dataset


def dead_position(found: Rotatability, required: DrivenRange, repaired: Mechanism) -> DeadPosition | None:
    """The first dead position that the drive comes to; None where it cannot be given.

    Under a law, whose places are times, it is the last sample that is reached.
    """
    mechanism = found.mechanism
    limits = [one for one in found.limits if required.turn or required.low <= one.value <= required.high]
    if not limits:
        return None
    path = ready(mechanism).kinematics.path
    limit = min(limits, key=lambda one: (one.end != ("high" if path.forward > 0 else "low"), one.value))
    if mechanism.motion_parameter.states_instants:
        at = limit.value
    else:
        course = motion(mechanism)
        status = course["status"].values
        open_from = int(np.argmax(np.isin(status, STATUSES_NOT_REACHED)))
        at = float(course["time"][max(open_from - 1, 0)])
    locked, mended = motion(mechanism, at=[at]), motion(repaired, at=[at])
    if not all(np.isfinite(one["position"].values).all() for one in (locked, mended)):
        return None
    return DeadPosition(limit, locked, mended)


# What a designer may change


def dimensions_of_design(mechanism: Mechanism) -> tuple[Dimension, ...]:
    """Lengths of links and distances in the frame; initial angles too, where these place something."""
    found = [Dimension(path, "length", name) for name, path in paths_of_lengths(mechanism).items()]
    if mechanism.space == "plane":
        found += [*_initial_angles(mechanism), *_points_of_frame(mechanism), *_lines_of_guides(mechanism)]
    return tuple(found)


def _initial_angles(mechanism: Mechanism) -> Iterator[Dimension]:
    driven = {drive.link for drive in mechanism.drives}
    if places_anew(mechanism):
        for name, link in mechanism.links.items():
            if link.angle is not None and name not in driven:
                yield Dimension(f"links.{name}.angle", "angle", name)


def _points_of_frame(mechanism: Mechanism) -> Iterator[Dimension]:
    """Coordinates of the fixed hinges by which they lie away from the first one."""
    fixed = {n: at for n, at in mechanism.frame.points.items() if not isinstance(at, Placed)}
    first = _origin(mechanism)
    for name in fixed:
        for axis, value, zero in zip("xy", mechanism.frame.coordinates[name], first, strict=True):
            if abs(value - zero) > NO_LENGTH:
                yield Dimension(f"frame.points.{name}.{axis}", "point", name, axis)


def _lines_of_guides(mechanism: Mechanism) -> Iterator[Dimension]:
    """Offsets of the guides of the frame that run along an axis."""
    first = _origin(mechanism)
    for guide in mechanism.guides:
        axis = _axis_across(guide)
        if guide.on != FRAME or axis is None or isinstance(guide.through, Placed | str) or not guide.through:
            continue
        number = "xy".index(axis)
        if abs(float(guide.through[number]) - first[number]) > NO_LENGTH:
            yield Dimension(f"guides.{guide.id}.through.{axis}", "guide", guide.id, axis)


def _axis_across(guide: Guide) -> str | None:
    x, y = guide.unit
    if abs(y) < NO_LENGTH:
        return "y"
    return "x" if abs(x) < NO_LENGTH else None


def _origin(mechanism: Mechanism) -> tuple[float, float]:
    """The hinge of the driven link on the frame, from which distances in the frame are counted."""
    drive = mechanism.drives[0].link
    own = () if drive is None else mechanism.links[drive].coordinates
    for name in (*own, *mechanism.frame.points):
        if name in mechanism.frame.coordinates:
            return mechanism.frame.coordinates[name]
    return 0.0, 0.0


# One dimension, from its present value outwards


class DimensionSearch:
    """One dimension of a mechanism that is varied alone."""

    def __init__(
        self,
        prepared: Ready,
        dimension: Dimension,
        required: DrivenRange,
        greatest_change: float | None = None,
    ) -> None:
        self.prepared, self.dimension, self.required = prepared, dimension, required
        self.varying = narrow_bounds(_varying(prepared, dimension), greatest_change)
        self.candidates = Candidates(prepared, (self.varying,))
        low, high = (float(end[0]) for end in self.candidates.box())
        outwards = np.linspace(0.0, 1.0, STEPS + 1)[1:]
        self._sides = (low * outwards, high * outwards**2)

    @functools.cached_property
    def margins(self) -> tuple[Array, ...]:
        """The least squared sines of the values that are tried, on the coarse nodes."""
        return tuple(self._least(side, COARSE) for side in self._sides)

    def change(self, margin: float) -> SingleChange | None:
        """The smallest change with which the mechanism makes the motion with a transmission angle, verified."""
        found = []
        for side, margins in zip(self._sides, self.margins, strict=True):
            bound = self._first(side, margins, 0.0)
            edge = self._first(side, margins, sin(margin + ENOUGH) ** 2)
            if bound is not None and edge is not None:
                found.append((abs(edge), edge, bound))
        for _size, edge, bound in sorted(found):
            change = self._verify(edge, bound, margin)
            if change is not None:
                return change
        return None

    def greatest(self) -> float:
        """The greatest least squared sine between the bounds; negative where no value makes the motion."""
        sides, margins = np.concatenate(self._sides), np.concatenate(self.margins)
        ascending = np.argsort(sides)
        best = int(np.argmax(margins[ascending]))
        near = sides[ascending][[max(best - 1, 0), min(best + 1, len(sides) - 1)]]
        fine = np.linspace(float(near[0]), float(near[1]), FINER_VALUES)
        return float(self._least(fine, FINE).max())

    def _least(self, changes: Array, nodes: int) -> Array:
        """The least squared sine of all dyads over the motion at scaled changes."""
        with np.errstate(all="ignore"):
            batch = self.candidates.batch(np.asarray(changes)[:, None])
            if self.required.turn:
                return least(squared_sines(batch, over_turn(batch, nodes)))
            sines = squared_sines(batch, np.linspace(self.required.low, self.required.high, nodes))
        # behind an open group nothing is known: the least is that group's own, negative one
        return np.asarray(np.where(np.isnan(sines), inf, sines).min(axis=(1, 2)))

    def _first(self, side: Array, margins: Array, target: float) -> float | None:
        """The scaled change nearest to none with squared sines above a target, halved down to rounding."""
        good = np.flatnonzero(margins > target)
        for k in good.tolist():
            inside = float(side[k])
            if not self._is_good(inside, target):
                continue  # by fewer places than are looked at now
            outside = float(side[k - 1]) if k else 0.0
            for _halving in range(HALVINGS):
                middle = 0.5 * (inside + outside)
                inside, outside = (middle, outside) if self._is_good(middle, target) else (inside, middle)
            return inside
        return None

    def _is_good(self, change: float, target: float) -> bool:
        return float(self._least(np.array([change]), FINE)[0]) > target

    def _verify(self, edge: float, bound: float, margin: float) -> SingleChange | None:
        """The rounded value with which the mechanism, assembled at every sample, makes the motion."""
        one = self.varying
        exact = one.before + edge * one.scale
        for value in _rounded_outwards(exact, one.before, one.unit, self.prepared.mechanism.display):
            if not one.low <= value <= one.high:
                continue
            change = (value - one.before) / one.scale
            reached = float(self._least(np.array([change]), FINE)[0])
            if reached < sin(margin) ** 2 * (1.0 - NO_LENGTH):
                continue
            repaired = self._repaired_mechanism(value, change)
            verified = None if repaired is None else _angle_and_residual(repaired, self.required, reached)
            if repaired is not None and verified is not None:
                numbers = one.before, value, one.before + bound * one.scale, abs(change)
                return SingleChange(self.dimension, one.unit, *numbers, *verified, repaired)
        return None

    def _repaired_mechanism(self, value: float, change: float) -> Mechanism | None:
        try:
            redesigned = with_value(self.candidates.mechanism(np.array([change])), self.varying.path, value)
        except CentrodeError:
            return None
        return replace_placed(redesigned) if places_anew(redesigned) else redesigned


def _angle_and_residual(
    repaired: Mechanism, required: DrivenRange, squared_sine: float
) -> tuple[float, float] | None:
    """Least transmission angle and worst residual of a mechanism that makes a motion; None where it does not."""
    try:
        found, course = rotatability(repaired), motion(repaired)
    except CentrodeError:
        return None
    if np.isin(course["status"].values, STATUSES_NOT_REACHED).any() or not is_reached(found, required):
        return None
    angle = float(np.arcsin(np.sqrt(min(squared_sine, 1.0))))
    if required.turn:
        angle = min((one.least for one in found.one.transmissions), default=pi / 2)
    return angle, float(course.attrs["worst_residual"])


def _varying(prepared: Ready, dimension: Dimension) -> Varying:
    """A dimension with its bounds: shares of itself, of its distance from the first hinge, half a turn of an angle."""
    mechanism = prepared.mechanism
    before = value_at(mechanism, dimension.path)
    unit = SPACES[mechanism.space].unit
    if dimension.kind == "angle":
        return Varying(dimension.path, before, before - pi, before + pi, "rad", 1.0)
    if dimension.kind == "length":
        ends = sorted((SHORTEST * before, LONGEST * before))
        high = min(ends[1], 0.999 * pi) if unit == "rad" else ends[1]
        return Varying(dimension.path, before, ends[0], high, unit, abs(before))
    zero = _origin(mechanism)["xy".index(dimension.axis)]
    ends = sorted((zero + SHORTEST * (before - zero), zero + LONGEST * (before - zero)))
    if dimension.kind == "guide":  # a guide may pass through the hinge
        ends = sorted((zero, zero + LONGEST * (before - zero)))
    scale = float(prepared.kinematics.numbers.scale)
    return Varying(dimension.path, before, ends[0], ends[1], unit, scale)


def _rounded_outwards(value: float, before: float, unit: str, display: Display) -> Iterator[float]:
    """A value away from the present one in few digits of the unit shown, then in more, then as it is [SI]."""
    factor, _unit = shown_as(unit, display)
    shown, away = factor * value, 1.0 if value > before else -1.0
    if shown:
        power = floor(log10(ROUNDED * abs(shown)))
        for exponent in range(power, power - FINER, -1):
            step = 10.0**exponent
            whole = np.ceil(shown / step - ENOUGH) if away > 0 else np.floor(shown / step + ENOUGH)
            yield float(f"{float(whole) * step / factor:.{DIGITS}g}")
    yield value
