"""Candidates of a repair: many mechanisms of one structure at once, and one of them as a description."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import cos, degrees, pi, sqrt
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.geometry.plane import Vector, add, cross, reversed_rotor, rotate_vector, rotor_of, subtract
from centrode.kinematics.assembly_mode import side_names, side_words, stated_side
from centrode.kinematics.dyads import solve_group
from centrode.kinematics.plan_evaluation import FixedSigns, Kinematics, SideChoices
from centrode.kinematics.preparation import Ready, ready
from centrode.locale import _
from centrode.model.files import value_at, with_value, with_values
from centrode.model.mechanism import FRAME, Mechanism
from centrode.model.placement import replace_placed
from centrode.model.reading import FrozenMap
from centrode.model.settings import Display
from centrode.model.units import read_quantity
from centrode.model.values import Placed
from centrode.numerics.arrays import ARRAYS
from centrode.quantities import terminal_unit
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import SPACES, Dimensions, dimensions_of
from centrode.structure.groups import Group, Meet, Rail, Rod, TurnedLink

# What may change in a repair: numbers by their paths, between bounds, and how large a change counts.

Value: TypeAlias = float | str
Bounds: TypeAlias = Mapping[str, tuple[Value, Value]]

MOST_PATHS = 12
SHRINK, STRETCH = 0.5, 2.0
"""How far a length changes where no bounds are given: to half and to double."""
AROUND = 0.5
"""How far a coordinate moves where no bounds are given, in the greatest length."""


@dataclass(frozen=True)
class Varying:
    """Number of a description that may change.

    Attributes
    ----------
    unit : "rad", "m" or "1"
    scale : change that counts as 1: a radian, the length itself, for coordinates the greatest length
    """

    path: str
    before: float
    low: float
    high: float
    unit: str
    scale: float

    @property
    def is_initial_angle(self) -> bool:
        """Whether it is the initial angle of a link, which places what is `placed`."""
        return self.path.startswith("links.") and self.path.endswith(".angle")


def varyings(
    prepared: Ready,
    vary: Sequence[str] | None,
    bounds: Bounds | None,
    greatest_change: float | None = None,
) -> tuple[Varying, ...]:
    """The numbers that may change, with their bounds in SI; where none are given, within the greatest change.

    Without `vary`: the initial angles of links that are not driven, where these place something; otherwise the
    lengths of all links.
    """
    mechanism = prepared.mechanism
    # bounds alone name what varies as well
    paths = list(dict.fromkeys(vary)) if vary else [*dict.fromkeys(bounds or ())] or default_paths(mechanism)
    for path in bounds or {}:
        if path not in paths:
            raise InputError(
                "bounds",
                _("{path} is not one of the varied numbers").format(path=path),
                _("name it in vary as well"),
            )
    if not 1 <= len(paths) <= MOST_PATHS:
        raise InputError(
            "vary",
            _("{n} numbers were named").format(n=len(paths)),
            _("name {least} to {most}").format(least=1, most=MOST_PATHS),
        )
    found = tuple(_varying_value(prepared, path, (bounds or {}).get(path)) for path in paths)
    return tuple(one if one.path in (bounds or {}) else narrow_bounds(one, greatest_change) for one in found)


def narrow_bounds(one: Varying, greatest_change: float | None) -> Varying:
    """The same number between bounds at most so far apart: parts of a length, of the greatest length, of a ratio.

    Angles keep their bounds: they have no size of which a change could be a part.
    """
    if greatest_change is None or one.path.endswith((".angle", ".direction")):
        return one
    reach = greatest_change * one.scale
    return replace(one, low=max(one.low, one.before - reach), high=min(one.high, one.before + reach))


def read_least_angle(given: Value | None, display: Display) -> float | None:
    """A least transmission angle [rad] as it is given; None where it is not. Raises InputError."""
    if given is None:
        return None
    value = read_quantity(
        given, "angle", "least_transmission_angle", refuses_bare=display.refuses_bare_angles
    )
    if not 0.0 < value < pi / 2:
        raise InputError(
            "least_transmission_angle",
            _("it must lie between 0 and 90 deg, got {value:.6g} deg").format(value=degrees(value)),
            _('write "20 deg"'),
        )
    return value


def check_greatest_change(value: float | None) -> None:
    """Raise InputError for a greatest change that is not between 0 and 1."""
    if value is not None and not 0.0 < value < 1.0:
        raise InputError(
            "greatest_change",
            _("it must lie between 0 and 1, got {value:.6g}").format(value=value),
            _("write 0.3 for changes of up to 30 %"),
        )


def default_paths(mechanism: Mechanism) -> list[str]:
    """Paths that vary if none is named."""
    driven = {drive.link for drive in mechanism.drives}
    if places_anew(mechanism):
        angled = [name for name, link in mechanism.links.items() if link.angle is not None]
        return [f"links.{name}.angle" for name in angled if name not in driven][:MOST_PATHS]
    return list(paths_of_lengths(mechanism).values())[:MOST_PATHS]


def paths_of_lengths(mechanism: Mechanism) -> dict[str, str]:
    """Paths of the lengths of links, by the names of the links.

    Of a link that gives coordinates for two points, its origin and one on an axis, the coordinate is the length.
    """
    found: dict[str, str] = {}
    for name, link in mechanism.links.items():
        if link.length is not None:
            found[name] = f"links.{name}.length"
        elif mechanism.space == "plane" and len(link.coordinates) == 2:
            ends = link.coordinates.items()
            (_name, origin), (point, coordinates) = sorted(ends, key=lambda end: end[1] != (0.0, 0.0))
            along = [axis for axis, value in zip("xy", coordinates, strict=True) if value]
            if origin == (0.0, 0.0) and len(along) == 1:
                found[name] = f"links.{name}.points.{point}.{along[0]}"
    return found


def places_anew(mechanism: Mechanism) -> bool:
    """Whether the chain of initial angles places anything, so that changed angles are changed dimensions.

    On the sphere what is placed stays where it is.
    """
    if mechanism.space == "sphere":
        return False
    points = any(isinstance(at, Placed) for at in mechanism.frame.points.values())
    return points or any(isinstance(guide.through, Placed) for guide in mechanism.guides)


def _varying_value(prepared: Ready, path: str, bounds: tuple[Value, Value] | None) -> Varying:
    mechanism = prepared.mechanism
    try:
        before = value_at(mechanism, path)
    except InputError as error:
        raise InputError(path, error.what, error.repair) from None
    unit = _unit(mechanism, path)
    scale = _scale(prepared, path, before, unit)
    unbounded = Varying(path, before, 0.0, 0.0, unit, scale)
    _check_varies(prepared, unbounded)
    low, high = (
        _default_bounds(unbounded, is_length=path in paths_of_lengths(mechanism).values())
        if bounds is None
        else _given_bounds(unbounded, bounds, mechanism.display)
    )
    return Varying(path, before, low, high, unit, scale)


def _unit(mechanism: Mechanism, path: str) -> str:
    if path.endswith((".angle", ".direction")):
        return "rad"
    return "1" if path.endswith(".ratio") else SPACES[mechanism.space].unit


def _scale(prepared: Ready, path: str, before: float, unit: str) -> float:
    if (
        path.endswith((".length", ".ratio", ".radius"))
        or path in paths_of_lengths(prepared.mechanism).values()
    ):
        return abs(before)
    return 1.0 if unit == "rad" else float(prepared.kinematics.numbers.scale)


def _default_bounds(one: Varying, *, is_length: bool = False) -> tuple[float, float]:
    if is_length or one.path.endswith((".length", ".ratio", ".radius")):
        ends = sorted((SHRINK * one.before, STRETCH * one.before))
        # an arc stays below half a great circle
        return ends[0], min(ends[1], 0.999 * pi) if one.unit == "rad" else ends[1]
    reach = pi if one.unit == "rad" else AROUND * one.scale
    return one.before - reach, one.before + reach


def _given_bounds(one: Varying, bounds: tuple[Value, Value], display: Display) -> tuple[float, float]:
    kind = {"rad": "angle", "m": "length", "1": "ratio"}[one.unit]
    refuses_bare = display.refuses_bare_angles
    low, high = (read_quantity(value, kind, one.path, refuses_bare=refuses_bare) for value in bounds)
    if low > high:
        raise InputError(one.path, _("its lower bound is above its upper one"), _("exchange them"))
    if not low <= one.before <= high:
        raise InputError(
            one.path,
            _("its bounds must contain its present value, {value:.6g} {unit}").format(
                value=one.before, unit=terminal_unit(one.unit)
            ),
            _("widen them"),
        )
    if one.path.endswith((".length", ".radius")) and low <= 0.0:
        raise InputError(one.path, _("a length must be positive"), _("raise its lower bound"))
    return low, high


def _check_varies(prepared: Ready, one: Varying) -> None:
    """Refuse what changes nothing, or is not a dimension."""
    mechanism = prepared.mechanism
    if one.is_initial_angle:
        link = one.path.removeprefix("links.").removesuffix(".angle")
        if not places_anew(mechanism):
            raise InputError(
                one.path,
                _("this initial angle determines no dimension: nothing is placed by it"),
                _('vary lengths or points, or set a point of the frame to "placed"'),
            )
        if any(drive.link == link for drive in mechanism.drives):
            raise InputError(one.path, _("the drive gives this angle"), _("vary that of another link"))
        return
    if _is_placed(mechanism, one.path):
        raise InputError(
            one.path,
            _("it is placed by the initial angles"),
            _("vary these, or give it coordinates"),
        )
    # tried with the present value: what is no dimension is refused there, and the result is not needed
    dimensions_of(mechanism, {one.path: one.before})


def _is_placed(mechanism: Mechanism, path: str) -> bool:
    placed = [f"frame.points.{n}." for n, at in mechanism.frame.points.items() if isinstance(at, Placed)]
    placed += [f"guides.{g.id}.through." for g in mechanism.guides if isinstance(g.through, Placed)]
    return path.startswith(tuple(placed))


Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


@dataclass(frozen=True)
class Batch:
    """Mechanisms of one structure: the plan with their numbers as columns, and the signs of their initial positions."""

    kinematics: Kinematics
    signs: Mapping[int, Array]
    size: int


@dataclass(frozen=True)
class Candidates:
    """A mechanism and what may change in it."""

    prepared: Ready
    varying: tuple[Varying, ...]

    def values(self, changes: Array) -> Array:
        """Values (n, p) in SI at scaled changes (n, p)."""
        before = np.array([number.before for number in self.varying])
        return np.asarray(before + changes * np.array([number.scale for number in self.varying]))

    def box(self) -> tuple[Array, Array]:
        """Least and greatest scaled change of each number."""
        low = np.array([(number.low - number.before) / number.scale for number in self.varying])
        high = np.array([(number.high - number.before) / number.scale for number in self.varying])
        return low, high

    def batch(self, changes: Array) -> Batch:
        """The mechanisms at scaled changes (n, p); what the initial angles place is placed anew."""
        mechanism = self.prepared.mechanism
        columns = dict(zip((number.path for number in self.varying), self.values(changes).T, strict=True))
        angles = {p.split(".")[1]: x for p, x in columns.items() if self._turns(p)}
        varied = {path: x for path, x in columns.items() if not self._turns(path)}
        # twice: what is placed depends on the numbers that vary, and the dimensions on what is placed
        numbers = dimensions_of(mechanism, varied, ARRAYS)
        if places_anew(mechanism):
            size = len(changes)
            placed = placed_numbers(mechanism, numbers, angles)
            whole = {path: np.broadcast_to(x, size).astype(np.float64) for path, x in placed.items()}
            numbers = dimensions_of(mechanism, {**varied, **whole}, ARRAYS)
        # mechanisms down, samples across: columns meet the row of nodes
        upright = numbers.map_numbers(lambda x: x if isinstance(x, float) else np.asarray(x)[:, None])
        kinematics = replace(self.prepared.kinematics, numbers=upright)
        signs = signs_at_start(self.prepared, kinematics, angles, len(changes))
        return Batch(kinematics, signs, len(changes))

    def _turns(self, path: str) -> bool:
        return any(number.path == path and number.is_initial_angle for number in self.varying)

    def mechanism(self, change: Array) -> Mechanism:
        """The description of one candidate at scaled changes (p,)."""
        mechanism = self.prepared.mechanism
        for number, value in zip(self.varying, self.values(change[None, :])[0], strict=True):
            mechanism = with_value(mechanism, number.path, float(value))
        if places_anew(mechanism):
            # where angles place, they also decide the assembly; elsewhere the sides have to be written down
            return replace_placed(mechanism)
        return _assembled_as(self.prepared, mechanism, self.batch(change[None, :]))


def placed_numbers(
    mechanism: Mechanism, numbers: Dimensions, angles: Mapping[str, Number]
) -> dict[str, Number]:
    """Coordinates by path of all that is placed, as the chain of initial angles puts it, over arrays."""
    fixed = {n: at for n, at in mechanism.frame.points.items() if not isinstance(at, Placed)}
    points: dict[str, Vector] = {name: numbers.frame[name] for name in fixed}
    poses: dict[str, tuple[Vector, Vector]] = {FRAME: ((0.0, 0.0), (1.0, 0.0))}
    # links wait until one of their points is known; a round that poses none leaves the rest unplaced
    waiting = list(mechanism.links)
    while waiting:
        posed = [name for name in waiting if _pose(mechanism, numbers, angles, name, points, poses)]
        if not posed:
            break
        waiting = [name for name in waiting if name not in posed]
    # paths are those of plain coordinates, so that dimensions_of takes them as given
    coordinates: dict[str, Number] = {}
    for name, at in mechanism.frame.points.items():
        if isinstance(at, Placed):
            coordinates |= {
                f"frame.points.{name}.{axis}": x for axis, x in zip("xy", points[name], strict=True)
            }
    for guide in mechanism.guides:
        if isinstance(guide.through, Placed):
            origin, rotor = poses[guide.on]
            inside = rotate_vector(subtract(points[guide.point], origin), reversed_rotor(rotor))
            coordinates |= {
                f"guides.{guide.id}.through.{axis}": x for axis, x in zip("xy", inside, strict=True)
            }
    return coordinates


def _pose(
    mechanism: Mechanism,
    numbers: Dimensions,
    angles: Mapping[str, Number],
    name: str,
    points: dict[str, Vector],
    poses: dict[str, tuple[Vector, Vector]],
) -> bool:
    """Pose a link that has an initial angle and a known point, and with it all its points."""
    local = numbers.local[name]
    angle = angles[name] if name in angles else mechanism.initial_angle(name)
    known = next((point for point in local if point in points), None)
    if angle is None or known is None:
        return False
    rotor = rotor_of(ARRAYS, angle)
    origin = subtract(points[known], rotate_vector(local[known], rotor))
    poses[name] = origin, rotor
    for point, coordinates in local.items():
        # the first link that reaches a point places it
        points.setdefault(point, add(origin, rotate_vector(coordinates, rotor)))
    return True


def signs_at_start(
    prepared: Ready, kinematics: Kinematics, angles: Mapping[str, Number], size: int
) -> dict[int, Array]:
    """Signs (size, 1) of all groups in the initial positions: stated, by initial angles, or those of the original."""
    mechanism, groups = prepared.mechanism, kinematics.structure.groups
    signs = {
        index: np.full((size, 1), prepared.assembled.signs[index])
        for index, group in enumerate(groups)
        if group.is_signed
    }
    # a side that the description states stays; initial angles decide only where they place
    hints: dict[int, dict[str, Number]] = {}
    if places_anew(mechanism):
        free = (index for index in signs if stated_side(kinematics, groups[index]) is None)
        hints = {index: found for index in free if (found := _hints(mechanism, groups[index], angles))}
    at = kinematics.frame(ARRAYS, np.full((1, 1), kinematics.path.initial))
    last = max(hints, default=-1)
    with np.errstate(all="ignore"):
        for index, group in enumerate(groups[: last + 1]):
            if index in hints:
                signs[index] = _nearer(kinematics, group, index, at, hints[index])
            if index < last:
                # in the plan's order: later groups stand on positions of earlier ones
                solve_group(
                    group, ARRAYS, kinematics.numbers, at, SideChoices(FixedSigns(ARRAYS, signs), index)
                )
    return {index: np.broadcast_to(sign, (size, 1)) for index, sign in signs.items()}


def _hints(mechanism: Mechanism, group: Group, angles: Mapping[str, Number]) -> dict[str, Number]:
    hints: dict[str, Number] = {}
    for link in group.links:
        angle = mechanism.links[link].angle
        if link in angles:
            hints[link] = np.asarray(angles[link])[:, None]
        elif angle is not None:
            hints[link] = angle
    return hints


def _nearer(
    kinematics: Kinematics, group: Group, index: int, at: Positions, hints: Mapping[str, Number]
) -> Array:
    """The sign whose angles are nearer to the hints."""
    off = []
    for sign in (1.0, -1.0):
        trial = at.copy()
        solve_group(
            group, ARRAYS, kinematics.numbers, trial, SideChoices(_Clamped(ARRAYS, {index: sign}), index)
        )
        total: Number = 0.0
        for link, hint in hints.items():
            cosine, sine = trial.poses[link].rotor
            # cosine of the angle to the hint, negative: small where they agree, without unwrapping
            total = total - (cosine * np.cos(hint) + sine * np.sin(hint))
        off.append(total)
    return np.asarray(np.where(off[0] <= off[1], 1.0, -1.0))


class _Clamped(FixedSigns):
    """A group that falls short of closing by rounding closes flat."""

    def root(self, group: int, radicand: Number) -> Number:
        return super().root(group, np.maximum(radicand, 0.0))


def _assembled_as(prepared: Ready, mechanism: Mechanism, batch: Batch) -> Mechanism:
    """The description with its assembly said by sides, and initial angles as they are with the new dimensions."""
    groups = [group for group in prepared.structure.groups if group.is_signed]
    space = batch.kinematics.numbers.space
    # with other dimensions the initial angles of before may be nearer to the other assembly: sides are said outright
    sides: dict[str, Any] = dict(mechanism.assembly.sides)
    for index, group in enumerate(prepared.structure.groups):
        # a side stated under either name of the group stays
        if group.is_signed and not any(name in sides for name in side_names(group)):
            sides[side_names(group)[0]] = side_words(space, group)[
                0 if prepared.assembled.signs[index] > 0 else 1
            ]
    assembly = mechanism.assembly.model_copy(update={"sides": FrozenMap(sides)})
    redesigned = mechanism.model_copy(update={"assembly": assembly})
    at = _positions(batch)
    # The angle of a guided link, or of a link that carries a guide, fixes the constant angle between them, and that
    # of a driven link where its drive starts: another number there would be another mechanism. All others are
    # estimates, and are put to where the links are.
    guided = {guide.link for guide in mechanism.guides} | {guide.on for guide in mechanism.guides}
    driven = {drive.link for drive in mechanism.drives}
    for link in _links_with_angles(mechanism, groups):
        # on the sphere an angle is measured from another link, and the rotor does not give it
        if link not in guided and link not in driven and mechanism.space == "plane":
            cosine, sine = (float(np.reshape(x, -1)[0]) for x in at.poses[link].rotor)
            redesigned = with_value(redesigned, f"links.{link}.angle", float(np.arctan2(sine, cosine)))
    return redesigned


def _positions(batch: Batch) -> Positions:
    kinematics = batch.kinematics
    with np.errstate(all="ignore"):
        return kinematics.positions(
            ARRAYS, np.full((1, 1), kinematics.path.initial), FixedSigns(ARRAYS, batch.signs)
        )


def _links_with_angles(mechanism: Mechanism, groups: Sequence[Group]) -> list[str]:
    names = dict.fromkeys(link for group in groups for link in group.links)
    return [name for name in names if mechanism.links[name].angle is not None]


# Inequalities that exclude a repair, whatever the numbers that may change become.
#
# Only what follows for certain is said: the first dyad behind a crank, and the second dyad behind a slider-
# crank.

MARGIN = 1e-12
"""Relative: an inequality between rounded numbers has to hold by more than this."""

TRIED = 0.37
"""A number that moves something moves it at this share of its greatest change, or at all of it."""


@dataclass(frozen=True)
class VariedRange:
    """A length between its bounds."""

    low: float
    high: float


@dataclass(frozen=True)
class Impossibility:
    """An inequality that no change within the bounds fulfils, so that the drive cannot turn.

    Attributes
    ----------
    crank : the driven link
    rods : the link behind the crank, whose end a guide leads; or both links of the dyad behind such a slider
    least_angle : transmission angle that every dyad is to keep [rad]
    low, high : least length that is needed, and the greatest that the rods reach [m]
    offset : of the guide from the crank's pivot, which is part of `low`; 0 where something may change it [m]
    """

    crank: str
    rods: tuple[str, ...]
    least_angle: float
    low: float
    high: float
    offset: float = 0.0


def impossible(candidates: Candidates, least_angle: float) -> Impossibility | None:
    """The inequality that no change within the bounds fulfils; None where none of these says so."""
    prepared = candidates.prepared
    if prepared.mechanism.space != "plane":
        return None
    lengths = _Lengths(candidates)
    crank = next(
        (g for g in prepared.structure.groups if isinstance(g, TurnedLink) and g.kind == "crank"), None
    )
    if crank is None or crank.pivot not in prepared.mechanism.frame.points:
        return None
    for group in prepared.structure.groups:
        if isinstance(group, Meet) and group.carriage is None:
            reason = _behind_crank(lengths, crank.link, group, least_angle) or _behind_slider(
                prepared, lengths, crank.link, group, least_angle
            )
            if reason:
                return reason
    return None


class _Lengths:
    """Lengths of links with two points, between the bounds of what varies."""

    def __init__(self, candidates: Candidates) -> None:
        self.candidates = candidates
        self.mechanism = candidates.prepared.mechanism
        self.bounds = {number.path: VariedRange(number.low, number.high) for number in candidates.varying}

    def of(self, link: str) -> VariedRange | None:
        length = self.mechanism.links[link].length
        return (
            None if length is None else self.bounds.get(f"links.{link}.length", VariedRange(length, length))
        )


def _rods(group: Meet) -> list[Rod]:
    return [locus for locus in group.loci if isinstance(locus, Rod)]


def _on_crank(lengths: _Lengths, crank: str, point: str) -> bool:
    """Whether a point is the end of the crank: a link of two points, the other of which is the frame's."""
    link = lengths.mechanism.links[crank]
    return (
        link.length is not None and point in link.coordinates and point not in lengths.mechanism.frame.points
    )


def _behind_crank(lengths: _Lengths, crank: str, group: Meet, least_angle: float) -> Impossibility | None:
    """Crank, coupler and slider on a line of the frame: the pin's distance from the line reaches the crank's length."""
    rods, rails = _rods(group), [locus for locus in group.loci if isinstance(locus, Rail)]
    if (
        len(rods) != 1
        or len(rails) != 1
        or rails[0].on != FRAME
        or not _on_crank(lengths, crank, rods[0].centre)
    ):
        return None
    short, rod = lengths.of(crank), lengths.of(rods[0].link)
    if short is None or rod is None:
        return None
    # the rod's part square to the guide is its length times the cosine of the transmission angle
    reach, offset = rod.high * cos(least_angle), _offset(lengths.candidates, crank, rails[0])
    if short.low + offset <= reach * (1.0 + MARGIN):
        return None
    return Impossibility(crank, (rods[0].link,), least_angle, short.low + offset, reach, offset)


def _offset(candidates: Candidates, crank: str, rail: Rail) -> float:
    """Distance of the crank's pivot from the guide, if no number that may change moves either; otherwise 0."""
    low, high = candidates.box()
    # a number may move the pivot there and back: a share besides the ends shows it
    one_by_one = [np.diag(share * end) for end in (low, high) for share in (1.0, TRIED)]
    changes = np.vstack([np.zeros((1, len(low))), *one_by_one])
    numbers = candidates.batch(changes).kinematics.numbers
    pivot = next(p for p in candidates.prepared.mechanism.links[crank].coordinates if p in numbers.frame)
    through, direction = numbers.curve(rail.guide)
    offsets = np.broadcast_to(
        np.abs(cross(direction, subtract(numbers.frame[pivot], through))), (len(changes), 1)
    )
    first = float(offsets[0, 0])
    scale = float(candidates.prepared.kinematics.numbers.scale)
    # the offset is a bound only if nothing moves it
    return first if float(np.max(np.abs(offsets - first))) <= MARGIN * scale else 0.0


def _behind_slider(
    prepared: Ready, lengths: _Lengths, crank: str, group: Meet, least_angle: float
) -> Impossibility | None:
    """A dyad whose end is carried by a slider-crank's slider: its stroke is at least twice the crank."""
    rods = _rods(group)
    if len(rods) != 2:
        return None
    fixed = [rod for rod in rods if rod.centre in prepared.mechanism.frame.points]
    moving = [rod for rod in rods if rod.centre not in prepared.mechanism.frame.points]
    if len(fixed) != 1 or len(moving) != 1:
        return None
    if not _is_slider(prepared, lengths, crank, moving[0].centre):
        return None
    ranges = [lengths.of(rod.link) for rod in rods]
    short = lengths.of(crank)
    if short is None or None in ranges:
        return None
    one, other = (one for one in ranges if one is not None)
    # at angles from mu to pi - mu the squared distance of the ends is r1^2 + r2^2 -+ 2 r1 r2 cos mu at most:
    # the longest straight way in that ring touches the inner circle, 4 sqrt(r1 r2 cos mu), and half of a
    # stroke is the crank
    reach = 2.0 * sqrt(one.high * other.high * cos(least_angle))
    if short.low <= reach * (1.0 + MARGIN):
        return None
    return Impossibility(crank, tuple(rod.link for rod in rods), least_angle, short.low, reach)


def _is_slider(prepared: Ready, lengths: _Lengths, crank: str, point: str) -> bool:
    """Whether a point is the slider of a slider-crank of the crank on the frame."""
    for group in prepared.structure.groups:
        if isinstance(group, Meet) and group.points == (point,) and group.carriage is None:
            rods, rails = _rods(group), [locus for locus in group.loci if isinstance(locus, Rail)]
            on_frame = len(rails) == 1 and rails[0].on == FRAME
            return on_frame and len(rods) == 1 and _on_crank(lengths, crank, rods[0].centre)
    return False


def with_numbers(mechanism: Mechanism, values: Mapping[str, float | str]) -> Mechanism:
    """The mechanism with other numbers, assembled as it was.

    Parameters
    ----------
    mechanism : Mechanism
    values : path -> number [SI] or text with a unit

    Returns
    -------
    Mechanism
        Where dimensions change, its assembly names the sides, and the initial angles of its groups are those of the
        new position: angles of before would be refused, or choose another assembly.

    Raises
    ------
    InputError
        A path without a number, a value that does not fit.
    """
    changed = with_values(mechanism, values)
    numbers = {path: value_at(changed, path) for path in values}
    dimensions = [path for path in values if _is_dimension(mechanism, path)]
    if not dimensions:
        return changed
    prepared = ready(mechanism)
    varying = tuple(Varying(path, 0.0, 0.0, 0.0, "", 1.0) for path in dimensions)
    redesigned = Candidates(prepared, varying).mechanism(np.array([numbers[path] for path in dimensions]))
    rest = {path: value for path, value in values.items() if path not in dimensions}
    return with_values(redesigned, rest) if rest else redesigned


def _is_dimension(mechanism: Mechanism, path: str) -> bool:
    """Whether positions depend on a number."""
    try:
        dimensions_of(mechanism, {path: value_at(mechanism, path)})
    except InputError:
        return False
    return True
