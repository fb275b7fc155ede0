"""Synthesis of spherical four-bar linkages by path, function and poses: from a request to answers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import CentrodeError, InputError, MotionError
from centrode.kinematics.motion import motion
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.units import read_quantity
from centrode.synthesis.answers import CHECKED_PLACES, Answer, SynthesisResults, proved_defects, refuse_poses
from centrode.synthesis.candidate_refinement import Progress, fit_lanes
from centrode.synthesis.four_bars import Array, Booleans
from centrode.synthesis.function_generation import lessen_greatest
from centrode.synthesis.function_synthesis import wanted_angles
from centrode.synthesis.least_squares import (
    ATTACHMENT,
    PHASE,
    VARIABLES,
    FitLanes,
    FitProblem,
    Hinges,
    Targets,
    is_ordered,
)
from centrode.synthesis.processes import HERE, Processes
from centrode.synthesis.requests import MOST_POSES, Constraints, Synthesis, SynthesisTask
from centrode.synthesis.spherical_dyads import (
    PosedLinkages,
    SphericalPoses,
    posed_linkages,
    poses_of,
    spherical_dyads,
)
from centrode.synthesis.spherical_four_bars import (
    COUPLER,
    CRANK,
    D_LAT,
    D_LON,
    O_LAT,
    O_LON,
    P_LAT,
    P_LON,
    ROCKER,
    SPHERE,
    STEP,
    coupler_headings,
    coupler_points,
    hinges_within,
    in_range,
    longitudes,
    rocker_angles_from_frame,
    spherical_crank_margins,
    spherical_motion,
    transmission_cosines,
    unit_vectors,
)

IntArray: TypeAlias = npt.NDArray[np.int64]

SHAPES = 2500
"""Random linkages whose curves are compared with the targets."""
CANDIDATES = 300
COMPARED = 16
"""Targets by which curves are compared at most."""
LEAST_ARC = 0.02
"""Of a link [rad], and of what it stays away from half a great circle."""
CRANK_MARGIN = 1e-4
MET = 1e-6
GRID = 24
"""Starting angles of each side of a function that are tried."""
STARTS = 160
REFINED = 6
FREE = {
    "frame.points.O.longitude": O_LON,
    "frame.points.O.latitude": O_LAT,
    "frame.points.D.longitude": D_LON,
    "frame.points.D.latitude": D_LAT,
    "links.OA.length": CRANK,
    "links.AB.length": COUPLER,
    "links.DB.length": ROCKER,
}


def spherical_answers(
    task: SynthesisTask,
    progress: Progress = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
    processes: Processes = HERE,
) -> SynthesisResults:
    """Spherical four-bar linkages for a path, a function or poses of the coupler.

    Raises
    ------
    InputError
        What is wanted has no meaning on the sphere.
    MotionError
        No linkage keeps what is required.
    """
    wanted = task.synthesis
    _check_bounds(wanted)
    if wanted.place == "given":
        raise InputError("[synthesis] place", _("on the sphere the place is free"), _("remove it"))
    if wanted.kind == "function":
        return _function_answers(task, progress, stop)
    if (
        wanted.kind == "motion"
        and len(wanted.rows) <= MOST_POSES
        and wanted.timing == "free"
        and not wanted.free
    ):
        return _pose_answers(task, progress, stop)
    return _path_answers(task, progress, stop, processes)


def _check_bounds(wanted: Synthesis) -> None:
    """Refuse bounds that the sphere, or a function on it, does not have."""
    pivots, what = wanted.constraints.pivots, _("on the sphere there is no such bound")
    if wanted.constraints.size is not None:
        raise InputError("[synthesis.constraints] size", what, _("remove it"))
    where = "[synthesis.constraints] pivots"
    if pivots.x is not None or pivots.y is not None:
        raise InputError(where, what, _("give longitude and latitude"))
    bounded = pivots.longitude is not None or pivots.latitude is not None
    if wanted.kind == "function" and bounded:
        what = _("a function says nothing of where the linkage stands")
        raise InputError(where, what, _("remove it"))


# Paths, and many poses in the least squares sense


def _path_answers(
    task: SynthesisTask, progress: Progress, stop: Callable[[], bool], processes: Processes
) -> SynthesisResults:
    wanted = task.synthesis
    rows = np.array(wanted.rows, dtype=np.float64)
    is_motion = wanted.kind == "motion"
    points = unit_vectors(rows[:, 0], rows[:, 1])
    directions = poses_of(rows[:, :3]).headings if is_motion else None
    drive = rows[:, 3 if is_motion else 2] if wanted.timing != "free" else None
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    gap = float(np.linalg.norm(points[0] - points[-1]))
    closed = wanted.closed if wanted.closed is not None else gap <= 1.5 * steps.max() and len(points) > 4
    closed = closed and drive is None and not is_motion
    if closed and gap <= 1e-9:
        points = points[:-1]
    targets = Targets(points, directions, drive)
    problem = _problem(wanted, targets)
    lanes = _candidates(wanted, problem, bool(closed))
    examined = len(lanes.side)
    lanes = fit_lanes(
        problem, lanes, bool(closed), wanted.constraints.order, progress, stop, processes=processes
    )
    answers, miss = _answers(task, problem, lanes, bool(closed))
    if not answers:
        what = _("no linkage keeps everything that is required")
        repair = _("loosen a constraint or a range")
        if np.isfinite(miss):
            repair = _(
                "without it the nearest misses the targets by {miss:.3g} rad; loosen a constraint or a range"
            )
            repair = repair.format(miss=miss)
        raise MotionError("[synthesis]", what, repair)
    return SynthesisResults(
        task, tuple(answers), _map(points), bool(closed), examined=examined, complete=not stop()
    )


def _map(points: Array) -> Any:
    """Longitude + i latitude (n) [rad]."""
    longitude, latitude = longitudes(points)
    return longitude + 1j * latitude


def _problem(wanted: Synthesis, targets: Targets) -> FitProblem:
    low, high = np.full(VARIABLES, -np.inf), np.full(VARIABLES, np.inf)
    low[[CRANK, COUPLER, ROCKER]], high[[CRANK, COUPLER, ROCKER]] = LEAST_ARC, np.pi - LEAST_ARC
    point = wanted.point
    known = {**FREE, f"links.AB.points.{point}.longitude": P_LON, f"links.AB.points.{point}.latitude": P_LAT}
    for path, given in wanted.free.items():
        plain, where = path.replace('"', ""), f"[synthesis.free] {path}"
        if plain not in known:
            what = _("{path} is not a number of this topology").format(path=value_text(path))
            raise InputError("[synthesis.free]", what, nearest(plain, known))
        if not isinstance(given, list | tuple) or len(given) != 2:
            raise InputError(where, _("expected [least, greatest]"))
        ends = [read_quantity(value, "angle", where) for value in given]
        k = known[plain]
        low[k], high[k] = max(low[k], ends[0]), min(high[k], ends[1])
        if low[k] > high[k]:
            what = _("the range goes from {low:g} to {high:g}").format(low=ends[0], high=ends[1])
            raise InputError(where, what, _("a length is an arc between 0 and 180 deg"))
    _narrow_hinges(wanted, low, high)
    free = np.ones(VARIABLES, dtype=bool)
    free[PHASE], free[ATTACHMENT] = wanted.timing == "phase", targets.directions is not None
    return FitProblem(targets, free, low, high, _hinges_of(wanted.constraints), kernel=SPHERE)


def _narrow_hinges(wanted: Synthesis, low: Array, high: Array) -> None:
    """Ranges of the fixed hinges put within [synthesis.constraints] pivots; InputError where nothing is left."""
    pivots = wanted.constraints.pivots
    for name, box, variables in (
        ("longitude", pivots.longitude, (O_LON, D_LON)),
        ("latitude", pivots.latitude, (O_LAT, D_LAT)),
    ):
        if box is None:
            continue
        for k in variables:
            low[k], high[k] = max(low[k], box[0]), min(high[k], box[1])
            if low[k] > high[k]:
                what = _("no fixed hinge lies both in pivots and in its own range")
                where = f"[synthesis.constraints] pivots.{name}"
                raise InputError(where, what, _("widen one of them"))
    if pivots.longitude is not None:
        # beyond a pole a point has another longitude
        for k in (O_LAT, D_LAT):
            low[k], high[k] = max(low[k], -np.pi / 2), min(high[k], np.pi / 2)


@dataclass(frozen=True)
class SphericalHinges:
    """Constraints on the sphere as residuals that are positive where they do not hold."""

    constraints: Constraints

    def __call__(self, variables: Array, side: Array) -> Array:
        """All of them (lanes, m)."""
        constraints, parts = self.constraints, []
        if constraints.crank is not None:
            parts.append(CRANK_MARGIN - spherical_crank_margins(variables[:, :9]))
        if constraints.transmission is not None:
            most = float(np.cos(constraints.transmission)) * (1 - 1e-9)
            cosine = transmission_cosines(variables[:, :9])
            parts.append(np.concatenate([cosine - most, -cosine - most], axis=1) + 1e-7)
        if constraints.length_ratio is not None:
            ratio = float(np.log(constraints.length_ratio))
            logs = np.log(variables[:, [CRANK, COUPLER, ROCKER]])
            parts.append((logs[:, :, None] - logs[:, None, :]).reshape(len(logs), 9) - ratio + 1e-7)
        return np.concatenate(parts, axis=1)


def _hinges_of(constraints: Constraints) -> Hinges | None:
    kept = (constraints.crank, constraints.transmission, constraints.length_ratio)
    return SphericalHinges(constraints) if any(one is not None for one in kept) else None


def _drawn_shapes(random: np.random.Generator, count: int, *, turning: bool) -> tuple[Array, Array]:
    """Random linkages (count, 9) with O in longitude and latitude 0 and D on the equator, and sides (count,)."""
    kept: list[Array] = []
    total = 0
    while total < count:
        rows = np.zeros((4 * count, 9))
        rows[:, D_LON] = random.uniform(0.2, 2.6, len(rows))
        rows[:, CRANK] = random.uniform(0.1, 1.5, len(rows))
        rows[:, [COUPLER, ROCKER]] = random.uniform(0.2, 2.6, (len(rows), 2))
        rows[:, P_LON] = random.uniform(-np.pi, np.pi, len(rows))
        rows[:, P_LAT] = np.arcsin(random.uniform(-1.0, 1.0, len(rows)))
        if turning:
            rows = rows[(spherical_crank_margins(rows) > 0.02).all(axis=1)]
        kept.append(rows)
        total += len(rows)
    return np.concatenate(kept)[:count], np.where(random.uniform(size=count) < 0.5, -1.0, 1.0)


def _candidates(wanted: Synthesis, problem: FitProblem, closed: bool) -> FitLanes:
    """Random linkages, each turned to where it fits best (W. Kabsch, Acta Cryst. A 32, 1976, 922-923)."""
    targets = problem.targets
    random = np.random.default_rng(wanted.seed)
    turning = wanted.constraints.crank is not None or closed
    shapes, sides = _drawn_shapes(random, SHAPES, turning=turning)
    windows = _crank_windows(wanted, targets, closed)
    offers = _best_turned(shapes, sides, windows, np.asarray(targets.points, dtype=np.float64))
    variables = np.zeros((len(offers), VARIABLES))
    crank = np.zeros((len(offers), len(targets.points)))
    for row, (k, index, turn) in enumerate(offers):
        angles, phase = windows[index]
        variables[row, :9] = shapes[k]
        for lon, lat in ((O_LON, O_LAT), (D_LON, D_LAT)):
            vector = turn @ unit_vectors(shapes[k, lon], shapes[k, lat])
            variables[row, lon], variables[row, lat] = (float(x) for x in longitudes(vector))
        variables[row, PHASE] = phase
        crank[row] = angles - phase
    side = sides[[k for k, _index, _turn in offers]]
    for k in (O_LON, D_LON):
        if np.isfinite([problem.low[k], problem.high[k]]).all():
            # a whole turn of a longitude is the same place, and may lie in the range
            middle = (problem.low[k] + problem.high[k]) / 2
            variables[:, k] += 2 * np.pi * np.rint((middle - variables[:, k]) / (2 * np.pi))
    variables = np.clip(variables, problem.low, problem.high)
    if targets.directions is not None:
        variables[:, ATTACHMENT] = _best_attachments(variables, crank, side, targets.directions)
    sense = np.where(crank[:, -1] >= crank[:, 0], 1.0, -1.0)
    return FitLanes(variables, side, crank, sense)


def _crank_windows(wanted: Synthesis, targets: Targets, closed: bool) -> list[tuple[Array, float]]:
    """Angles of a crank at the targets that are tried, each with the phase that it has of them [rad].

    Without timing the crank turns with the length of the polygon through the targets, in either sense.
    """
    starts = np.linspace(0.0, 2 * np.pi, 12, endpoint=False)
    if targets.crank is not None:
        return [
            (targets.crank + start, float(start))
            for start in (starts if wanted.timing == "phase" else (0.0,))
        ]
    points = np.asarray(targets.points, dtype=np.float64)
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    share = np.concatenate([[0.0], np.cumsum(step)])
    last = float(np.linalg.norm(points[0] - points[-1])) if closed else 0.0
    share = share / max(float(share[-1]) + last, 1e-12)
    widths = (2 * np.pi,) if closed else (0.5, 1.0, 1.8, 2.8, 4.0)
    return [
        (start + sense * width * share, 0.0) for width in widths for start in starts for sense in (1.0, -1.0)
    ]


def _best_turned(
    shapes: Array, sides: Array, windows: Sequence[tuple[Array, float]], points: Array
) -> list[tuple[int, int, Array]]:
    """Shapes and windows that fit points best, each with the rotation (3, 3) that brings it there, best first."""
    n = len(points)
    chosen = np.unique(np.linspace(0, n - 1, min(n, COMPARED)).astype(np.int64))
    misses, offers = [], []
    for index, (angles, _phase) in enumerate(windows):
        drawn = spherical_motion(shapes, angles[chosen], sides)
        closes = (drawn.radicand > 0).all(axis=1)
        mixed = points[chosen].T @ coupler_points(drawn, shapes)
        left, values, right = np.linalg.svd(mixed)
        # a rotation, never a reflection: the least singular value counts with the sign of the determinant
        sign = np.sign(np.linalg.det(left @ right))
        match = values[:, 0] + values[:, 1] + sign * values[:, 2]
        miss = np.where(closes, len(chosen) - match, np.inf)
        best = np.argsort(miss, kind="stable")[: CANDIDATES // 2]
        left[:, :, 2] *= sign[:, None]
        misses.append(miss[best])
        offers += [(int(k), index, left[k] @ right[k]) for k in best]
    order = np.argsort(np.concatenate(misses), kind="stable")[:CANDIDATES]
    return [offers[place] for place in order.tolist()]


def _best_attachments(variables: Array, crank: Array, side: Array, directions: Array) -> Array:
    """Angles at which a direction stands on the coupler that miss the required directions least [rad]."""
    drawn = spherical_motion(variables[:, :9], crank + variables[:, PHASE, None], side)
    heading = coupler_headings(drawn, variables, np.zeros(len(variables)))
    across = np.cross(coupler_points(drawn, variables), heading)
    cosine = (heading * directions).sum(axis=(1, 2))
    return np.asarray(np.arctan2((across * directions).sum(axis=(1, 2)), cosine))


def _answers(
    task: SynthesisTask, problem: FitProblem, lanes: FitLanes, closed: bool
) -> tuple[list[Answer], float]:
    """Distinct answers that keep everything, best first, and the least error of those that do not."""
    wanted = task.synthesis
    found: list[Answer] = []
    miss = float("inf")
    for k in range(len(lanes.side)):
        if not np.isfinite(lanes.errors[k]):
            continue
        row, side = lanes.variables[k, :9], float(lanes.side[k])
        crank = lanes.crank[k] + lanes.variables[k, PHASE]
        sense = 1.0 if crank[-1] >= crank[0] else -1.0
        if problem.targets.crank is None:
            sense = float(lanes.sense[k])
        attachment = lanes.variables[k : k + 1, ATTACHMENT]
        drawn = spherical_motion(row[None], crank, lanes.side[k : k + 1])
        errors = _arcs_between(coupler_points(drawn, row[None])[0], np.asarray(problem.targets.points))
        numbers: dict[str, tuple[float, str]] = {}
        if problem.targets.directions is not None:
            heading = coupler_headings(drawn, row[None], attachment)[0]
            turn = _arcs_between(heading, problem.targets.directions)
            numbers["turn_error"] = (float(turn.max()), "rad")
        miss = min(miss, float(np.sqrt(np.mean(errors**2))))
        unordered = wanted.constraints.order and not is_ordered((crank * sense)[None], closed)[0]
        if lanes.violation[k] > MET or unordered:
            continue
        answer = _answer(task, row, side, crank, sense, errors, float(attachment[0]), numbers)
        if wanted.constraints.order and not answer.defects.none:
            continue
        if any(_alike(answer, other) for other in found):
            continue
        found.append(answer)
        if len(found) == wanted.answers:
            break
    return found, miss


def _alike(answer: Answer, other: Answer) -> bool:
    """Whether two answers draw the same curve."""
    if abs(answer.error - other.error) > 1e-3 * other.error + 1e-9:
        return False
    if not len(answer.curve) or not len(other.curve):
        return True
    first, second = (unit_vectors(one.curve.real, one.curve.imag) for one in (answer, other))
    distance = np.linalg.norm(first[::12, None] - second[None], axis=-1).min(axis=1).max()
    return bool(distance < 2e-2)


def _arcs_between(first: Array, second: Array) -> Array:
    arcs: Array = 2 * np.arcsin(np.minimum(np.linalg.norm(first - second, axis=-1) / 2, 1.0))
    return arcs


def spherical_description(
    linkage: Array,
    side: float,
    start: float,
    sense: float,
    title: str,
    display: Mapping[str, object],
    points: Mapping[str, list[float]],
) -> Mechanism:
    """The description of a spherical four-bar linkage O-A-B-D; `points` are further ones of the coupler."""
    row = [float(value) for value in linkage]
    return Mechanism(
        title=title,
        space="sphere",
        display=display,
        frame={"points": {"O": row[O_LON : O_LAT + 1], "D": row[D_LON : D_LAT + 1]}},
        links={
            "OA": {"length": row[CRANK], "reference": ["O", "D"]},
            "AB": {"points": {"A": [0.0, 0.0], "B": [row[COUPLER], 0.0], **points}},
            "DB": {"length": row[ROCKER], "reference": ["D", "O"]},
        },
        drives=[{"link": "OA", "start": float(start), "speed": float(sense)}],
        assembly={"sides": {"B": "left" if side > 0 else "right"}},
    )


def _answer(
    task: SynthesisTask,
    linkage: Array,
    side: float,
    crank: Array,
    sense: float,
    errors: Array,
    attachment: float = 0.0,
    numbers: Mapping[str, tuple[float, str]] | None = None,
) -> Answer:
    """An answer with everything about it that the engine computes from its description."""
    wanted = task.synthesis
    linkage, attachment = in_range(linkage, attachment)
    points: dict[str, list[float]] = {}
    if wanted.kind != "function":
        place = [float(linkage[P_LON]), float(linkage[P_LAT])]
        points[wanted.point] = place
        if wanted.kind == "motion":
            points["Q"] = _beyond(place, attachment, 0.25 * float(linkage[COUPLER]))
    display = task.display.model_dump(exclude_unset=True)
    title = task.title or "Spherical four-bar linkage"
    mechanism = spherical_description(linkage, side, crank[0], sense, title, display, points)
    turns = bool((spherical_crank_margins(linkage[None]) > 0).all())
    defects = proved_defects(mechanism, crank, sense, turns, wanted.constraints.crank is not None)
    curve, met = _trace_point(mechanism, wanted.point, crank, sense, turns, bool(points))
    return Answer(
        mechanism,
        float(np.sqrt(np.mean(errors**2))),
        float(np.max(np.abs(errors))),
        float((errors**2).sum()),
        float(_transmissions(linkage[None], np.array([side]), crank[None], np.array([turns]))[0]),
        (float("nan"), float("nan")),
        defects,
        curve,
        met,
        crank,
        (),
        errors if wanted.kind == "function" else None,
        numbers or {},
    )


def _beyond(place: list[float], attachment: float, arc: float) -> list[float]:
    """Longitude and latitude of the point that lies from P along the x axis of the body."""
    point = unit_vectors(*(np.array(x) for x in place))
    east = np.array([-np.sin(place[0]), np.cos(place[0]), 0.0])
    heading = np.cos(attachment) * east + np.sin(attachment) * np.cross(point, east)
    end = np.cos(arc) * point + np.sin(arc) * heading
    return [float(x) for x in longitudes(end)]


def _trace_point(
    mechanism: Mechanism, point: str, crank: Array, sense: float, turns: bool, traces: bool
) -> tuple[Any, Any]:
    """Curve of the point and its places at crank angles, as longitude + i latitude, by the engine."""
    none = np.empty(0, dtype=np.complex128)
    start = float(crank[0])
    stop = start + sense * 2 * np.pi if turns else float(crank[-1])
    if not traces or stop == start:
        return none, none
    try:
        data = motion(mechanism, CHECKED_PLACES, start=start, stop=stop)
        exact = motion(mechanism, at=list(crank))
    except CentrodeError:
        return none, none
    return tuple(_map(one.position.sel(point=point).to_numpy()) for one in (data, exact))


def _transmissions(linkages: Array, side: Array, way: Array, turns: Booleans) -> Array:
    """Least angles (lanes,) of coupler and rocker [rad]: over a full turn, else from the first target to the last."""
    share = np.linspace(0.0, 1.0, 61)
    angles = way[:, :1] + (way[:, -1:] - way[:, :1]) * share
    with np.errstate(invalid="ignore", divide="ignore"):
        whole = np.abs(transmission_cosines(linkages)).max(axis=1)
        joint = spherical_motion(linkages, angles, side).crank
        other = unit_vectors(linkages[:, D_LON], linkages[:, D_LAT])
        b, c = linkages[:, COUPLER, None], linkages[:, ROCKER, None]
        near = (joint * other[:, None]).sum(axis=-1)
        cosine = np.abs((near - np.cos(b) * np.cos(c)) / (np.sin(b) * np.sin(c))).max(axis=1)
        cosine = np.where(turns, whole, cosine)
        angle: Array = np.arccos(np.minimum(np.nan_to_num(cosine, nan=1.0), 1.0))
    return angle


# Poses that are met exactly


def _pose_answers(task: SynthesisTask, progress: Progress, stop: Callable[[], bool]) -> SynthesisResults:
    wanted = task.synthesis
    rows = np.array(wanted.rows, dtype=np.float64)
    if wanted.hinges is not None:
        raise InputError("[synthesis] hinges", _("on the sphere hinges are not given"), _("remove it"))
    poses = poses_of(rows[:, :3])
    dyads = spherical_dyads(poses)
    pairs = _dyad_pairs(len(dyads.moving))
    if not len(pairs):
        what = _("no pair of dyads leads through these poses")
        raise MotionError("[synthesis] targets", what, _("change one of the poses, or remove one"))
    progress(0.3)
    posed = posed_linkages(poses, dyads, pairs)
    ways = _ways_through(posed)
    answers: list[Answer] = []
    for k in _kept_linkages(posed, ways, wanted.constraints):
        if stop() and answers:
            break
        # up to four poses leave a family of linkages, of which neighbours tell nothing new
        near = (np.abs(posed.linkages[k, :7] - one).max() < 0.15 for one in kept_rows(answers))
        if len(rows) < 5 and any(near):
            continue
        answer = _posed_answer(task, posed, ways, poses, k)
        if wanted.constraints.order and not answer.defects.none:
            continue
        answers.append(answer)
        progress(0.3 + 0.7 * len(answers) / wanted.answers)
        if len(answers) == wanted.answers:
            break
    if not answers:
        refuse_poses(len(pairs))
    return SynthesisResults(
        task, tuple(answers), _map(poses.places), examined=len(pairs), complete=not stop()
    )


def _dyad_pairs(number: int) -> IntArray:
    """Ordered pairs (n, 2) of different dyads, of evenly chosen ones where there are many."""
    few = (
        np.unique(np.linspace(0, number - 1, min(number, 110)).astype(np.int64))
        if number
        else np.empty(0, int)
    )
    first, second = np.meshgrid(few, few, indexing="ij")
    pairs = np.column_stack([first.ravel(), second.ravel()])
    return np.asarray(pairs[pairs[:, 0] != pairs[:, 1]])


class _Ways(NamedTuple):
    """How cranks turn from pose to pose: angles without jumps (n, poses) [rad], and senses (n)."""

    angles: Array
    senses: Array


def _ways_through(posed: PosedLinkages) -> _Ways:
    """The ways on which the cranks turn less in all, all steps in one sense."""
    forwards, backwards = (np.mod(s * np.diff(posed.crank, axis=1), 2 * np.pi) for s in (1.0, -1.0))
    sense = np.where(forwards.sum(axis=1) <= backwards.sum(axis=1), 1.0, -1.0)
    steps = np.where(sense[:, None] > 0, forwards, -backwards)
    turned = np.concatenate([np.zeros((len(steps), 1)), np.cumsum(steps, axis=1)], axis=1)
    return _Ways(posed.crank[:, :1] + turned, sense)


def _kept_linkages(posed: PosedLinkages, ways: _Ways, constraints: Constraints) -> list[int]:
    """Numbers of the linkages that keep the constraints: without defects first, then by their transmission."""
    linkages, way = posed.linkages, ways.angles
    arcs = linkages[:, [CRANK, COUPLER, ROCKER]]
    good: Booleans = np.all(np.isfinite(linkages), axis=1)
    good &= np.all((arcs > LEAST_ARC) & (arcs < np.pi - LEAST_ARC), axis=1)
    turns: Booleans = np.all(spherical_crank_margins(linkages) > 1e-9, axis=1)
    # clean: on one branch and within one turn, along which every position closes
    with np.errstate(invalid="ignore"):
        clean = (posed.sides == posed.sides[:, :1]).all(axis=1) & (np.abs(way[:, -1] - way[:, 0]) < 2 * np.pi)
        clean &= turns | posed.passes(way[:, [0, -1]])
    transmission = _transmissions(linkages, posed.sides[:, 0], way, turns)
    if constraints.crank is not None:
        good &= turns
    if constraints.transmission is not None:
        good &= transmission >= constraints.transmission - 1e-9
    if constraints.length_ratio is not None:
        good &= arcs.max(axis=1) <= constraints.length_ratio * arcs.min(axis=1)
    if constraints.order:
        good &= clean
    good &= hinges_within(linkages, constraints.pivots.longitude, constraints.pivots.latitude)
    return [k for k in np.lexsort((-transmission, ~clean)).tolist() if good[k]]


def _posed_answer(
    task: SynthesisTask, posed: PosedLinkages, ways: _Ways, poses: SphericalPoses, k: int
) -> Answer:
    """A linkage as an answer, with what it misses of each pose."""
    row, attachment = posed.linkages[k : k + 1], posed.attachment[k : k + 1]
    drawn = spherical_motion(row, ways.angles[k], posed.sides[k, :1])
    errors = _arcs_between(coupler_points(drawn, row)[0], poses.places)
    turn = _arcs_between(coupler_headings(drawn, row, attachment)[0], poses.headings)
    return _answer(
        task, posed.linkages[k], float(posed.sides[k, 0]), ways.angles[k], float(ways.senses[k]), errors,
        float(posed.attachment[k]), {"turn_error": (float(turn.max()), "rad")},
    )  # fmt: skip


def kept_rows(answers: list[Answer]) -> list[Array]:
    """Places of the hinges and arcs (7,) of answers."""
    rows = []
    for answer in answers:
        links = answer.mechanism.links
        places = np.array(list(answer.mechanism.frame.points.values()), dtype=np.float64)
        arcs = [float(links[name].length or links[name].coordinates["B"][0]) for name in ("OA", "AB", "DB")]
        rows.append(np.array([*places[:2, :2].ravel(), *arcs]))
    return rows


# Functions


def _function_answers(task: SynthesisTask, progress: Progress, stop: Callable[[], bool]) -> SynthesisResults:
    wanted = task.synthesis
    crank, rocker = wanted_angles(wanted)
    crank, rocker = crank - crank[0], rocker - rocker[0]
    exact = len(crank) if wanted.targets is not None and len(crank) <= 5 else wanted.exact
    first, second = crank, rocker
    if exact is not None and len(crank) != exact:
        # Chebyshev's spacing of the exact positions
        share = 0.5 - 0.5 * np.cos(np.pi * (2 * np.arange(exact) + 1) / (2 * exact))
        first, second = wanted_angles(wanted, share)
    variables, side = _function_starts(first, second)
    # the best starts alone, at some of the samples, go on
    some = slice(None, None, max(1, len(first) // 20))
    worst = np.abs(_function_errors(variables, side, first, second)).max(axis=1, initial=0.0)
    best = np.argsort(worst, kind="stable")[:STARTS]
    begun, side = variables[best], side[best]
    variables = _squares(begun, side, first[some], second[some])
    progress(0.5)
    keeps = _keeps(wanted, crank)
    if exact is None:
        # what the fit has led beyond a constraint begins where it was
        variables = np.where(keeps(variables, side)[:, None], variables, begun)
    worst = np.abs(_function_errors(variables, side, first, second)).max(axis=1, initial=0.0)
    worst = np.where(keeps(variables, side), worst, np.inf)
    if exact is None:
        order = np.argsort(worst, kind="stable")
    else:
        worst = np.where(worst < 1e-9, worst, np.inf)
        rank = _ranks_of_exact(variables, side, crank, rocker, only_exact=len(crank) == exact)
        order = np.lexsort((rank, ~np.isfinite(worst)))
    chosen = _unlike(variables, worst, order, REFINED if exact is None else 4 * wanted.answers)
    rows = [variables[k] for k in chosen]
    if exact is None:
        for count, k in enumerate(chosen):
            if stop():
                break
            rows[count] = _lessen(rows[count], side[k : k + 1], crank, rocker, keeps)
            progress(0.5 + 0.5 * (count + 1) / len(chosen))
    answers = list(_answers_of_functions(task, rows, side[chosen], crank, rocker))
    progress(1.0)
    if not answers:
        what = _("no linkage keeps everything that is required")
        raise MotionError("[synthesis]", what, _("loosen a constraint"))
    if exact is None or len(crank) != exact:
        answers.sort(key=lambda one: one.greatest)
    return SynthesisResults(
        task, tuple(answers[: wanted.answers]), examined=GRID * GRID // 2, complete=not stop(),
        values=np.column_stack([crank, rocker]),
    )  # fmt: skip


def _ranks_of_exact(variables: Array, side: Array, crank: Array, rocker: Array, *, only_exact: bool) -> Array:
    """What linkages with exact positions are sorted by: the greatest error elsewhere, else the transmission."""
    if only_exact:
        return -_transmissions_of_functions(variables, side, crank)
    errors = np.abs(_function_errors(variables, side, crank, rocker))
    return np.asarray(errors.max(axis=1, initial=0.0))


def _unlike(variables: Array, worst: Array, order: IntArray, most: int) -> list[int]:
    """Numbers of the first linkages in an order, of those that are alike one."""
    # a hinge and the point opposite to it are the same: arcs x and pi - x
    folded = np.minimum(variables[:, 2:], np.pi - variables[:, 2:])
    chosen: list[int] = []
    for k in order.tolist():
        alike = (np.allclose(folded[k], folded[j], rtol=1e-3, atol=1e-4) for j in chosen)
        if np.isfinite(worst[k]) and not any(alike):
            chosen.append(k)
        if len(chosen) == most:
            break
    return chosen


def _answers_of_functions(
    task: SynthesisTask, rows: Sequence[Array], sides: Array, crank: Array, rocker: Array
) -> Iterator[Answer]:
    """Linkages as answers: those that close at all angles, without defects where the order is required."""
    for row, side in zip(rows, sides, strict=True):
        missed = _function_errors(row[None], np.array([side]), crank, rocker)[0]
        if not np.isfinite(missed).all():
            continue
        angles = crank + float(np.angle(np.exp(1j * row[0])))
        answer = _answer(
            task, _frames(row[None])[0], float(side), angles, 1.0 if crank[-1] > 0 else -1.0, missed
        )
        if not task.synthesis.constraints.order or answer.defects.none:
            yield answer


def _frames(variables: Any) -> Any:
    """Linkages (lanes, 9) of variables (lanes, 6): both starting angles, crank, coupler, rocker, frame."""
    rows = np.zeros((len(variables), 9), dtype=variables.dtype)
    rows[:, [CRANK, COUPLER, ROCKER]], rows[:, D_LON] = variables[:, 2:5], variables[:, 5]
    return rows


def _function_starts(crank: Array, rocker: Array) -> tuple[Array, Array]:
    """Variables (lanes, 6) and sides of linkages through some of the pairs, for a grid of starting angles.

    With phi and psi the angles from the arcs OD and DO the closure is linear in cot a sin d, cot c sin d, cos d and
    (cos a cos c cos d - cos b)/(sin a sin c): y1 cos psi + y2 cos phi - y3 cos phi cos psi + y4 = sin phi sin psi.
    """
    count = min(len(crank), 4)
    rows = np.rint(np.linspace(0, len(crank) - 1, count)).astype(np.int64)
    grid = np.linspace(0.0, 2 * np.pi, GRID, endpoint=False)
    starts = np.stack(np.meshgrid(grid, grid, indexing="ij"), axis=-1).reshape(-1, 2)
    phi, psi = crank[rows] + starts[:, :1], rocker[rows] + starts[:, 1:]
    system = np.stack([np.cos(psi), np.cos(phi), -np.cos(phi) * np.cos(psi), np.ones_like(phi)], axis=-1)
    numbers = np.einsum("nij,nj->ni", np.linalg.pinv(system, rcond=1e-9), np.sin(phi) * np.sin(psi))
    frame = np.arccos(np.clip(numbers[:, 2], -0.98, 0.98))
    a, c = (np.arctan2(np.sin(frame), numbers[:, k]) for k in (0, 1))
    cosine = np.cos(a) * np.cos(c) * np.cos(frame) - numbers[:, 3] * np.sin(a) * np.sin(c)
    b = np.arccos(np.clip(cosine, -0.98, 0.98))
    variables = np.column_stack([starts, a, b, c, frame])
    variables[:, 2:] = np.clip(variables[:, 2:], LEAST_ARC, np.pi - LEAST_ARC)
    both = np.concatenate([variables, variables])
    side = np.repeat([1.0, -1.0], len(variables))
    good = np.isfinite(_function_errors(both, side, crank, rocker)).all(axis=1)
    return both[good], side[good]


def _function_errors(variables: Any, side: Array, crank: Array, rocker: Array) -> Any:
    """Angle of the rocker less what it should be (lanes, n) [rad]; infinite where the linkage is open."""
    drawn = spherical_motion(_frames(variables), crank + variables[:, :1], side)
    errors = rocker_angles_from_frame(drawn, _frames(variables)) - rocker - variables[:, 1:2]
    errors = errors - 2 * np.pi * np.rint(errors.real / (2 * np.pi))
    if np.iscomplexobj(errors):
        return errors
    return np.where((drawn.radicand > 0).all(axis=1, keepdims=True), errors, np.inf)


def _function_slopes(variables: Array, side: Array, crank: Array, rocker: Array) -> Array:
    slopes = np.empty((len(variables), len(crank), 6))
    for k in range(6):
        moved = variables.astype(np.complex128)
        moved[:, k] += 1j * STEP
        slopes[..., k] = _function_errors(moved, side, crank, rocker).imag / STEP
    return slopes


def _squares(variables: Array, side: Array, crank: Array, rocker: Array) -> Array:
    """Levenberg and Marquardt for all lanes at once."""
    damping = np.full(len(variables), 1e-3)
    errors = _function_errors(variables, side, crank, rocker)
    cost = (errors**2).sum(axis=1)
    for _iteration in range(60):
        slopes = _function_slopes(variables, side, crank, rocker)
        normal = np.einsum("lni,lnj->lij", slopes, slopes)
        gradient = np.einsum("lni,ln->li", slopes, errors)
        diagonal = np.einsum("lii->li", normal)
        diagonal += damping[:, None] * diagonal + 1e-14
        proposed = variables - np.linalg.solve(normal, gradient[..., None])[..., 0]
        proposed[:, 2:] = np.clip(proposed[:, 2:], LEAST_ARC, np.pi - LEAST_ARC)
        missed = _function_errors(proposed, side, crank, rocker)
        total = (missed**2).sum(axis=1)
        better = total < cost
        variables = np.where(better[:, None], proposed, variables)
        errors = np.where(better[:, None], missed, errors)
        cost = np.where(better, total, cost)
        damping = np.clip(np.where(better, damping * 0.3, damping * 5.0), 1e-14, 1e12)
    return variables


def _transmissions_of_functions(variables: Array, side: Array, crank: Array) -> Array:
    """Least transmission angles (lanes,) [rad]: over a full turn, or where the crank is used."""
    rows = _frames(variables)
    turns = np.asarray((spherical_crank_margins(rows) > 0).all(axis=1))
    return _transmissions(rows, side, variables[:, :1] + crank, turns)


def _keeps(wanted: Synthesis, crank: Array) -> Callable[[Array, Array], Booleans]:
    constraints = wanted.constraints

    def keeps(variables: Array, side: Array) -> Booleans:
        rows = _frames(variables)
        arcs = variables[:, 2:]
        good: Booleans = np.all((arcs > LEAST_ARC) & (arcs < np.pi - LEAST_ARC), axis=1)
        if constraints.crank is not None:
            good &= (spherical_crank_margins(rows) > 1e-9).all(axis=1)
        if constraints.transmission is not None:
            least = constraints.transmission - 1e-9
            good &= _transmissions_of_functions(variables, side, crank) >= least
        if constraints.length_ratio is not None:
            good &= arcs.max(axis=1) <= constraints.length_ratio * arcs.min(axis=1)
        return good

    return keeps


def _lessen(
    row: Array, side: Array, crank: Array, rocker: Array, keeps: Callable[[Array, Array], Booleans]
) -> Array:
    for _round in range(4):
        before = float(np.abs(_function_errors(row[None], side, crank, rocker)).max())
        row = lessen_greatest(
            row,
            lambda at: _function_errors(at[None], side, crank, rocker)[0],
            lambda at: _function_slopes(at[None], side, crank, rocker)[0],
            lambda at: bool(keeps(at[None], side)[0]),
        )
        if np.abs(_function_errors(row[None], side, crank, rocker)).max() > before * (1 - 1e-6):
            break
    return row
