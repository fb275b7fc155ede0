"""What a mechanism of a file shall do, as a row of misses with exact derivatives by its free numbers.

Crank angles that nobody gives are those of the nearest places of the motion in the order of the targets, so that a
miss is the distance along the normal, and the derivative of that place falls out; a common start of given angles is
eliminated in the same way.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.similarity import Similarity, check_similarity
from centrode.sweeps.outputs import identifier
from centrode.sweeps.solver import Solver
from centrode.synthesis.curve_places import PlacedCurve, SampledCurve, place_curve
from centrode.synthesis.four_bars import Array
from centrode.synthesis.measures import Measure, hermite, measure_of
from centrode.synthesis.path_synthesis import is_closed_path
from centrode.synthesis.requests import Synthesis
from centrode.synthesis.target_places import (
    BodyTargets,
    SampledMotion,
    TargetPlaces,
    aligned_similarity,
    mix,
    nearest_places,
    sampled_motion,
    shift_range,
    shifted_places,
    shifted_similarity,
)

Numbers: TypeAlias = Mapping[str, Array]
Misses: TypeAlias = Callable[[Solver, Numbers, Numbers], tuple[Array, Array, Array]]
"""(solver, outputs, their derivatives) -> misses, their derivatives, values of the drive at the targets."""
POINT = {"x": ("position", "x"), "y": ("position", "y"), "u": ("velocity", "x"), "v": ("velocity", "y")}
TURN = {"angle": "angle", "turning": "angular_velocity"}


class BrokenMotion(Exception):
    """The mechanism does not move all along."""


@dataclass(frozen=True)
class MechanismGoal:
    """What the misses are of: their outputs, and how they follow from these.

    Attributes
    ----------
    outputs : name -> what the solver computes for it
    at : values of the drive of targets that have some
    size : of the misses, in which constraints are weighed
    misses : of the outputs
    place : of a path whose place is free, and eliminated: how its curve, by the outputs, is moved onto the targets
    begin : where the place is free, and four numbers beside the dimensions: the similarity from which to go on
    by_samples : whether targets are met between the samples of a motion, so that finer ones say more
    """

    outputs: Mapping[str, str]
    at: Array | None
    size: float
    misses: Misses
    place: Callable[[Solver, Numbers], PlacedCurve] | None = None
    begin: Callable[[Solver, Numbers], Similarity] | None = None
    by_samples: bool = False


def mechanism_goal(mechanism: Mechanism, wanted: Synthesis) -> MechanismGoal:
    """The goal of a request; raises InputError where the mechanism has not what it names."""
    if wanted.kind == "function":
        return _function_goal(mechanism, wanted)
    if wanted.kind == "strokes":
        return _stroke_goal(mechanism, wanted)
    _check_body(mechanism, wanted)
    if not wanted.has_free_place:
        return _body_goal(wanted)
    check_similarity(mechanism, "[synthesis] place")
    if wanted.timing == "given":
        what = _("the zero of the drive turns with a mechanism whose place is free")
        raise InputError("[synthesis] timing", what, _('write timing = "phase", or place = "given"'))
    bounded = wanted.constraints.size is not None or bool(wanted.constraints.pivots.model_fields_set)
    if wanted.kind == "path" and wanted.timing == "free" and not bounded:
        return _placed_goal(wanted)
    return _body_goal(wanted)


def body_targets(wanted: Synthesis) -> BodyTargets:
    """The targets of a path, or of poses: these have an arm as long as they are apart."""
    rows = np.array(wanted.rows, dtype=np.float64)
    if wanted.kind == "path":
        return BodyTargets(rows[:, :2], 1.0)
    arm = _size_of(rows) or 1.0
    return BodyTargets(np.column_stack([rows[:, :2], arm * np.unwrap(rows[:, 2])]), arm)


def _size_of(rows: Array) -> float:
    return float(np.linalg.norm(rows[:, :2] - rows[:, :2].mean(axis=0), axis=1).max())


def _check_body(mechanism: Mechanism, wanted: Synthesis) -> None:
    """Raise InputError where the point, or the link of poses, is not there."""
    point = wanted.point
    if wanted.kind == "motion":
        link = mechanism.links.get(wanted.link)
        if link is None:
            what = _("there is no link {name}").format(name=value_text(wanted.link))
            raise InputError("[synthesis] link", what, nearest(wanted.link, mechanism.links))
        if point not in link.coordinates:
            what = _("the link {link} has no point {point}")
            what = what.format(link=value_text(wanted.link), point=value_text(point))
            raise InputError("[synthesis] point", what, nearest(point, link.coordinates))
    elif not any(point in link.coordinates for link in mechanism.links.values()):
        what = _("no link has the point {name}").format(name=value_text(point))
        points = dict.fromkeys(name for link in mechanism.links.values() for name in link.coordinates)
        raise InputError("[synthesis] point", what, nearest(point, points))


def _point_outputs(point: str) -> dict[str, str]:
    return {name: identifier(quantity, point, axis) for name, (quantity, axis) in POINT.items()}


def _body_goal(wanted: Synthesis) -> MechanismGoal:
    """A point, with the turn of its link where poses are wanted, as the mechanism stands."""
    targets = body_targets(wanted)
    times = np.array(wanted.rows, dtype=np.float64)[:, -1]
    outputs = _point_outputs(wanted.point)
    if wanted.kind == "motion":
        outputs |= {name: identifier(quantity, wanted.link) for name, quantity in TURN.items()}
    size = _size_of(targets.rows) or targets.arm

    def rows_of(values: Numbers, point: tuple[str, str], turn: str) -> Array:
        parts = [values[name] for name in point]
        if wanted.kind == "motion":
            angle = values[turn]
            parts.append(targets.arm * (np.unwrap(angle) if turn == "angle" and angle.ndim == 1 else angle))
        return np.stack(parts, axis=1)

    def misses_at_values(moved: Solver, values: Numbers, by: Numbers) -> tuple[Array, Array, Array]:
        missed = targets.misses(rows_of(values, ("x", "y"), "angle"))
        slopes = rows_of(by, ("x", "y"), "angle")
        return missed.ravel(), slopes.reshape(missed.size, -1), moved.parameter

    if wanted.timing == "given":
        outputs = {name: output for name, output in outputs.items() if name in ("x", "y", "angle")}
        return MechanismGoal(outputs, times, size, misses_at_values)

    def motion_of(moved: Solver, values: Numbers) -> SampledMotion:
        pace = moved.time[1] - moved.time[0]
        rates = pace * rows_of(values, ("u", "v"), "turning")
        return sampled_motion(rows_of(values, ("x", "y"), "angle"), rates, targets.arm)

    def places_of(moved: Solver, motion: SampledMotion) -> TargetPlaces:
        if wanted.timing == "free":
            return nearest_places(motion, targets, wanted.constraints.order)
        return shifted_places(motion, targets, _offsets(moved, motion, times))

    def misses(moved: Solver, values: Numbers, by: Numbers) -> tuple[Array, Array, Array]:
        motion = motion_of(moved, values)
        placed = places_of(moved, motion)
        pace = moved.time[1] - moved.time[0]
        cells, part = motion.split(placed.places)
        weights, _turn = hermite(part)
        rates = pace * rows_of(by, ("u", "v"), "turning")
        change = mix(rows_of(by, ("x", "y"), "angle"), rates, cells, weights)
        drive = moved.parameter[0] + (moved.parameter[1] - moved.parameter[0]) * placed.places
        return placed.project(placed.misses[:, :, None])[:, 0], placed.project(change), drive

    def begin(moved: Solver, values: Numbers) -> Similarity:
        motion = motion_of(moved, values)
        if wanted.timing == "phase":
            return shifted_similarity(motion, targets, _offsets(moved, motion, times))
        if wanted.kind == "motion":
            return aligned_similarity(motion, targets)
        curve = SampledCurve(motion.rows @ np.array([1, 1j]), motion.rates @ np.array([1, 1j]))
        points = targets.rows @ np.array([1, 1j])
        closed, ordered = is_closed_path(wanted, points), wanted.constraints.order
        return place_curve(curve, points, closed, ordered).similarity

    return MechanismGoal(
        outputs, None, size, misses, begin=begin if wanted.has_free_place else None, by_samples=True
    )


def _offsets(moved: Solver, motion: SampledMotion, times: Array) -> Array:
    """Given values of the drive in cells of a motion; raises InputError where they reach farther than it."""
    step = moved.parameter[1] - moved.parameter[0]
    offsets: Array = (times - moved.parameter[0]) / step
    low, high = shift_range(motion, offsets)
    if low > high + 1e-9:
        what = _("the values of the drive extend over {given:.6g}, its motion over {own:.6g} only")
        own = float(moved.parameter[-1] - moved.parameter[0])
        repair = _("remove targets, or let the drive move farther")
        raise InputError("[synthesis] targets", what.format(given=float(np.ptp(times)), own=own), repair)
    return offsets


def _placed_goal(wanted: Synthesis) -> MechanismGoal:
    """A path on which the whole mechanism is turned, scaled and shifted as it fits best."""
    rows = np.array(wanted.rows, dtype=np.float64)
    targets, size = rows[:, :2] @ np.array([1.0, 1j]), _size_of(rows)
    closed, ordered = is_closed_path(wanted, targets), wanted.constraints.order
    if closed and abs(targets[0] - targets[-1]) <= 1e-9 * size:
        # a point that stands twice would be passed twice
        targets = targets[:-1]
    outputs = _point_outputs(wanted.point)

    def curve_of(moved: Solver, values: Numbers) -> SampledCurve:
        pace = moved.time[1] - moved.time[0]
        return SampledCurve(values["x"] + 1j * values["y"], pace * (values["u"] + 1j * values["v"]))

    def place(moved: Solver, values: Numbers) -> PlacedCurve:
        return place_curve(curve_of(moved, values), targets, closed, ordered)

    def misses(moved: Solver, values: Numbers, by: Numbers) -> tuple[Array, Array, Array]:
        curve, changes = curve_of(moved, values), curve_of(moved, by)
        placed = place_curve(curve, targets, closed, ordered)
        cells, weights, _slopes = curve.weights(placed.places)
        weights = weights[:, :, None]
        change = weights[0] * changes.points[cells] + weights[1] * changes.tangents[cells]
        change = change + weights[2] * changes.points[cells + 1] + weights[3] * changes.tangents[cells + 1]
        slopes = placed.slopes(curve.at(placed.places)[0], change)
        steps = moved.parameter[1] - moved.parameter[0]
        drive = moved.parameter[0] + steps * placed.places
        return placed.project(placed.misses[:, None])[:, 0], slopes, drive

    return MechanismGoal(outputs, None, size, misses, place, by_samples=True)


def _function_goal(mechanism: Mechanism, wanted: Synthesis) -> MechanismGoal:
    """An output that follows the drive, up to a constant."""
    rows = np.array(wanted.rows, dtype=np.float64)
    output = output_name(mechanism, wanted)

    def misses(moved: Solver, values: Numbers, by: Numbers) -> tuple[Array, Array, Array]:
        missed = values["output"] - rows[:, 1]
        if output.startswith("angle"):
            missed = np.unwrap(missed)
        return missed - missed.mean(), by["output"] - by["output"].mean(axis=0), moved.parameter

    return MechanismGoal({"output": output}, rows[:, 0], float(np.ptp(rows[:, 1])) or 1.0, misses)


def _stroke_goal(mechanism: Mechanism, wanted: Synthesis) -> MechanismGoal:
    """Stroke, time ratio and dwell of an output, each in units of its size."""
    output = output_name(mechanism, wanted)
    _check_stroke(wanted, output)
    stroke = wanted.stroke if wanted.stroke is not None else wanted.swing
    goals: list[tuple[Measure, float, float]] = []
    for number, (text, value) in enumerate(
        ((f"stroke({output})", stroke), (f"time_ratio({output})", wanted.time_ratio))
    ):
        if value is not None:
            goals.append((measure_of(mechanism, text, "[synthesis]", number), value, value))
    outputs = {name: formula for one, _value, _size in goals for name, formula in one.outputs.items()}
    dwell = wanted.dwell
    if dwell is not None:
        outputs["dwell"] = output
    if not outputs:
        raise InputError("[synthesis]", _("neither a stroke nor a dwell is given"), _("give stroke or dwell"))
    scale = stroke or 1.0

    def misses(moved: Solver, values: Numbers, by: Numbers) -> tuple[Array, Array, Array]:
        missed, slopes = [], []
        for measure, value, size in goals:
            number, slope = measure.compute(moved.parameter, moved.time, values, by)
            if not math.isfinite(number):
                raise BrokenMotion
            missed.append(np.array([(number - value) / size]))
            slopes.append(slope[None] / size)
        if dwell is not None:
            first, last = dwell.range
            within = np.flatnonzero(np.mod(moved.parameter[:-1] - first, 2 * math.pi) <= last - first)
            if not len(within):
                what = _("the motion has no value of the drive between these two")
                raise InputError(
                    "[synthesis.dwell] range", what, _("choose a range in which the drive moves")
                )
            part, part_by = values["dwell"][within], by["dwell"][within]
            if dwell.value is None:
                part, part_by = part - part.mean(), part_by - part_by.mean(axis=0)
            else:
                part = part - dwell.value
            missed.append(part / scale / math.sqrt(len(within)))
            slopes.append(part_by / scale / math.sqrt(len(within)))
        return np.concatenate(missed), np.concatenate(slopes), np.empty(0)

    return MechanismGoal(outputs, None, 1.0, misses)


def output_name(mechanism: Mechanism, wanted: Synthesis) -> str:
    """What a function or a stroke is of, as the solver spells it; InputError where the mechanism has no such output."""
    guides = [guide.id for guide in mechanism.guides]
    if wanted.guide is not None:
        if wanted.guide not in guides:
            what = _("there is no guide {name}").format(name=value_text(wanted.guide))
            raise InputError("[synthesis] guide", what, nearest(wanted.guide, guides))
        return identifier("slide", wanted.guide)
    quantity, _dot, rest = wanted.of.partition(".")
    points = dict.fromkeys(name for link in mechanism.links.values() for name in link.coordinates)
    known = {
        "angle": list(mechanism.links),
        "slide": guides,
        "position": [f"{point}.{axis}" for point in points for axis in "xy"],
    }.get(quantity)
    if known is None or rest not in known:
        names = [
            f"{kind}.{name}"
            for kind, some in (("angle", mechanism.links), ("slide", guides))
            for name in some
        ]
        what = _("there is no output {name}").format(name=value_text(wanted.of))
        raise InputError("[synthesis] of", what, nearest(wanted.of, names))
    if quantity == "position":
        point, axis = rest[:-2], rest[-1]
        return identifier(quantity, point, axis)
    return identifier(quantity, rest)


def _check_stroke(wanted: Synthesis, output: str) -> None:
    """Raise InputError where an angle shall move by a length, or a length by an angle."""
    foreign, own = ("stroke", "swing") if output.startswith("angle") else ("swing", "stroke")
    if getattr(wanted, foreign) is not None:
        what = _('"{key}" means nothing to this output').format(key=foreign)
        raise InputError(f"[synthesis] {foreign}", what, _("give {key}").format(key=own))


def place_outputs(
    values: Numbers, by: Numbers, similarity: Similarity, size: float, points: Iterable[tuple[str, str]]
) -> tuple[Numbers, Numbers]:
    """Outputs of a mechanism that a similarity has moved, with four more derivatives each.

    These are by the logarithm of the scale, the turn [rad], and the shift in units of `size`. Points are named by the
    outputs of their coordinates; of other outputs the rates of "x", "y" and "angle" move.
    """
    moved = dict(values)
    slopes = {
        name: np.concatenate([change, np.zeros((len(change), 4))], axis=1) for name, change in by.items()
    }
    rates = [("u", "v")] if "u" in values else []
    for pair, shift in [*((pair, similarity.shift) for pair in points), *((pair, 0.0) for pair in rates)]:
        if pair[0] not in values:
            continue
        turned = similarity.factor * (values[pair[0]] + 1j * values[pair[1]])
        change = similarity.factor * (by[pair[0]] + 1j * by[pair[1]])
        # a shift moves points alone
        ends = np.full(len(turned), size if pair not in rates else 0.0)
        change = np.concatenate([change, np.stack([turned, 1j * turned, ends, 1j * ends], axis=1)], axis=1)
        moved[pair[0]], moved[pair[1]] = (turned + shift).real, (turned + shift).imag
        slopes[pair[0]], slopes[pair[1]] = change.real, change.imag
    if "angle" in values:
        moved["angle"] = values["angle"] + similarity.turn
        slopes["angle"][:, -3] = 1.0
    return moved, slopes
