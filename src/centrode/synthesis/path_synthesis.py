"""Path synthesis of four-bar linkages: from a request to answers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from centrode.errors import InputError, MotionError
from centrode.locale import _
from centrode.model.reading import nearest, value_text
from centrode.model.units import read_quantity
from centrode.synthesis.answers import Answer, SynthesisResults, four_bar_answer
from centrode.synthesis.candidate_refinement import SHARP, Progress, fit_lanes
from centrode.synthesis.four_bars import (
    COUPLER,
    CRANK,
    DX,
    DY,
    OX,
    OY,
    PX,
    PY,
    ROCKER,
    Array,
    Complex,
    coupler_motion,
    crank_margins,
    lengths,
)
from centrode.synthesis.least_squares import (
    ATTACHMENT,
    LEAST_LENGTH,
    PHASE,
    VARIABLES,
    FitLanes,
    FitProblem,
    Hinges,
    Targets,
    is_ordered,
    least_squares,
)
from centrode.synthesis.processes import HERE, Processes
from centrode.synthesis.requests import Constraints, Synthesis, SynthesisTask
from centrode.synthesis.start_candidates import (
    closed_candidates,
    nearby_candidates,
    open_candidates,
    random_candidates,
    timed_candidates,
)

CRANK_MARGIN = 1e-4
"""Of Grashof's rule, in units of frame and crank: a crank that only just turns is none."""
OPEN_CANDIDATES = 320
RANDOM_STARTS = 1500
BOX_PLACES, FINE_PLACES = 36, 7200
"""Crank angles at which the box around a mechanism is looked at, in the search and of an answer."""
BOX_MARGIN = 3e-3
TRADES = 5
"""Steps of a trade-off."""
MET = 1e-6
"""A constraint holds up to this part."""

FREE_VARIABLES = {
    "frame.points.O.x": OX,
    "frame.points.O.y": OY,
    "frame.points.D.x": DX,
    "frame.points.D.y": DY,
    "links.OA.length": CRANK,
    "links.AB.length": COUPLER,
    "links.DB.length": ROCKER,
}
OWN = {"O": (0.0, 0.0), "D": (4.0, 0.0), "lengths": (1.0, 3.5, 3.0)}
"""Numbers of the built-in four-bar linkages that nobody sets free."""


def path_answers(
    task: SynthesisTask,
    progress: Progress = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
    processes: Processes = HERE,
) -> SynthesisResults:
    """Four-bar linkages for a path, or for poses of the coupler in the least squares sense.

    Raises
    ------
    InputError
        Bounds that leave nothing.
    MotionError
        No linkage keeps the constraints.
    """
    wanted = task.synthesis
    rows = np.array(wanted.rows, dtype=np.float64)
    points = rows[:, 0] + 1j * rows[:, 1]
    is_motion = wanted.kind == "motion"
    directions = np.unwrap(rows[:, 2]) if is_motion else None
    drive = rows[:, 3 if is_motion else 2] if wanted.timing != "free" else None
    closed = is_closed_path(wanted, points) and drive is None and not is_motion
    if closed and abs(points[0] - points[-1]) <= 1e-9 * np.abs(points - points.mean()).max():
        points = points[:-1]
    middle = complex(points.mean())
    size = float(np.abs(points - middle).max()) or 1.0
    scaled = (points - middle) / size
    problem = _problem(wanted, Targets(scaled, directions, drive), middle, size)
    lanes = _candidates(wanted, problem, closed, wanted.seed)
    examined = len(lanes.side)
    random = np.random.default_rng([wanted.seed, 1])

    def neighbours(lanes: FitLanes, distance: float, count: int) -> FitLanes:
        near = nearby_candidates(problem.targets, lanes, distance, count, random)
        near.variables = np.clip(near.variables, problem.low, problem.high)
        return near

    lanes = fit_lanes(problem, lanes, closed, wanted.constraints.order, progress, stop, neighbours, processes)
    answers, nearest_miss = _answers(task, problem, lanes, middle, size, closed)
    if not answers:
        raise _nothing(wanted, nearest_miss, _broken_name(wanted.constraints, lanes, size))
    if wanted.trade_off is not None:
        answers = _trade(task, problem, lanes, answers, middle, size, closed, stop)
    return SynthesisResults(task, tuple(answers), points, closed, examined=examined, complete=not stop())


def is_closed_path(wanted: Synthesis, points: Complex) -> bool:
    """Whether a path is closed: as it is given, else where its ends are no farther apart than its points elsewhere."""
    if wanted.closed is not None:
        return wanted.closed
    steps = np.abs(np.diff(points))
    return bool(abs(points[0] - points[-1]) <= 1.5 * steps.max() and len(points) > 4)


def _problem(wanted: Synthesis, targets: Targets, middle: complex, size: float) -> FitProblem:
    """Variables, bounds and constraints in units of the targets, the middle of which is the origin."""
    low, high = np.full(VARIABLES, -np.inf), np.full(VARIABLES, np.inf)
    low[[CRANK, COUPLER, ROCKER]] = LEAST_LENGTH
    free = np.ones(VARIABLES, dtype=bool)
    bounds = _bounds(wanted)
    if wanted.place == "given":
        own = (*OWN["O"], *OWN["D"], *OWN["lengths"], 0.0, 0.0)
        for k in range(9):
            free[k] = k in bounds
            if not free[k]:
                low[k] = high[k] = _to_units(k, own[k], middle, size)
    for k, (least, greatest) in bounds.items():
        low[k] = max(low[k], _to_units(k, least, middle, size))
        high[k] = min(high[k], _to_units(k, greatest, middle, size))
    pivots = wanted.constraints.pivots
    for ks, box, name in (((OX, DX), pivots.x, "x"), ((OY, DY), pivots.y, "y")):
        for k in ks:
            if box is not None:
                low[k] = max(low[k], _to_units(k, box[0], middle, size))
                high[k] = min(high[k], _to_units(k, box[1], middle, size))
            if low[k] > high[k]:
                what = _("no fixed hinge lies both in pivots and in its own range")
                raise InputError(f"[synthesis.constraints] pivots.{name}", what, _("widen one of them"))
    free[PHASE] = wanted.timing == "phase"
    free[ATTACHMENT] = targets.directions is not None
    hinges = hinges_of(wanted.constraints, size)
    return FitProblem(targets, free, low, high, hinges)


def _to_units(variable: int, value: float, middle: complex, size: float) -> float:
    shift = {OX: middle.real, DX: middle.real, OY: middle.imag, DY: middle.imag}.get(variable, 0.0)
    return (value - shift) / size


def _bounds(wanted: Synthesis) -> dict[int, tuple[float, float]]:
    """Variable -> least and greatest value [m] of [synthesis.free]."""
    point = wanted.point
    known = {
        **FREE_VARIABLES,
        f"links.AB.points.{point}.x": PX,
        f"links.AB.points.{point}.y": PY,
        "links.AB.points.B.x": COUPLER,
    }
    found = {}
    for path, given in wanted.free.items():
        plain = path.replace('"', "")
        if plain not in known:
            what = _("{path} is not a number of this topology").format(path=value_text(path))
            raise InputError("[synthesis.free]", what, nearest(plain, known))
        if not isinstance(given, list | tuple) or len(given) != 2:
            raise InputError(f"[synthesis.free] {path}", _("expected [least, greatest]"))
        least, greatest = (read_quantity(value, "length", f"[synthesis.free] {path}") for value in given)
        if least > greatest:
            what = _("the range goes from {low:g} to {high:g}").format(low=least, high=greatest)
            raise InputError(f"[synthesis.free] {path}", what, _("exchange them"))
        variable = known[plain]
        if variable in (CRANK, COUPLER, ROCKER) and greatest <= 0:
            raise InputError(f"[synthesis.free] {path}", _("a length is positive"), _("correct the range"))
        found[variable] = (least, greatest)
    return found


@dataclass(frozen=True)
class ConstraintHinges:
    """Constraints as residuals that are positive where they do not hold.

    Attributes
    ----------
    size : of the targets [m], the unit
    """

    constraints: Constraints
    size: float

    def __call__(self, variables: Array, side: Array) -> Array:
        """All of them (lanes, m)."""
        parts = [part(variables, side) for _name, part in named_hinges(self.constraints, self.size)]
        return np.concatenate(parts, axis=1)


def hinges_of(constraints: Constraints, size: float) -> Hinges | None:
    """The constraints as residuals; None where there are none."""
    return ConstraintHinges(constraints, size) if named_hinges(constraints, size) else None


def named_hinges(constraints: Constraints, size: float) -> list[tuple[str, Hinges]]:
    """Each constraint that is given by its key, in units of which the targets' size is one."""
    parts: list[tuple[str, Hinges]] = []
    if constraints.crank is not None:
        parts.append(("crank", lambda variables, side: CRANK_MARGIN - crank_margins(variables[:, :9])))
    if constraints.transmission is not None:
        most = float(np.cos(constraints.transmission)) * (1 - 1e-9)

        def transmission(variables: Array, side: Array) -> Array:
            ground, a, b, c = lengths(variables[:, :9]).T
            ends = np.column_stack([np.abs(ground - a), ground + a])
            cosine = ((b * b + c * c)[:, None] - ends**2) / (2 * b * c)[:, None]
            return np.concatenate([cosine - most, -cosine - most], axis=1) + 1e-7

        parts.append(("transmission", transmission))
    if constraints.length_ratio is not None:
        ratio = float(np.log(constraints.length_ratio))

        def length_ratio(variables: Array, side: Array) -> Array:
            logs = np.log(lengths(variables[:, :9]))
            return (logs[:, :, None] - logs[:, None, :]).reshape(len(logs), 16) - ratio + 1e-7

        parts.append(("length_ratio", length_ratio))
    if constraints.size is not None:
        width, height = (side / size for side in constraints.size)

        def box(variables: Array, side: Array) -> Array:
            # what parabolas between the places leave is smaller than the margin
            excess: Array = box_of(variables[:, :9], side) / np.array([width, height]) - 1.0 + BOX_MARGIN
            return excess

        parts.append(("size", box))
    return parts


def box_of(linkages: Array, side: Array, places: int = BOX_PLACES) -> Array:
    """Width and height (lanes, 2) of the box around O, D, A, B and P over a full turn.

    Between places of the crank each extreme is that of the parabola through its neighbours.
    """
    turn = np.linspace(0.0, 2 * np.pi, places, endpoint=False)
    motion = coupler_motion(linkages, turn, side)
    shape = linkages[:, PX, None] + 1j * linkages[:, PY, None]
    joint = motion.point - shape * motion.direction
    other = joint + linkages[:, COUPLER, None] * motion.direction
    fixed = linkages[:, [OX, DX]] + 1j * linkages[:, [OY, DY]]
    moving = np.stack([joint, other, motion.point], axis=1)
    sides = []
    for part, still in ((moving.real, fixed.real), (moving.imag, fixed.imag)):
        most = np.maximum(_greatest(part).max(axis=1), still.max(axis=1))
        least = np.minimum(-_greatest(-part).max(axis=1), still.min(axis=1))
        sides.append(most - least)
    return np.column_stack(sides)


def _greatest(values: Array) -> Array:
    """Greatest value (...) of periodic samples (..., n), with the parabola about the greatest of them."""
    n = values.shape[-1]
    rows = values.reshape(-1, n)
    row, best = np.arange(len(rows)), np.argmax(rows, axis=1)
    before, here, after = (rows[row, (best + k) % n].reshape(values.shape[:-1]) for k in (-1, 0, 1))
    bend = 2 * here - before - after
    greatest: Array = here + (after - before) ** 2 / (8 * np.maximum(bend, 1e-300))
    return np.where(bend > 0, greatest, here)


def is_within(linkage: Array, side: float, size: tuple[float, ...]) -> bool:
    """Whether the box around all positions of a linkage (9,) keeps a size [m]: between fine samples it is bounded.

    Over a step h a coordinate exceeds its samples by h^2/8 of its greatest second derivative at most, which the second
    differences of the samples give but for a hundredth.
    """
    turn = np.linspace(0.0, 2 * np.pi, FINE_PLACES, endpoint=False)
    motion = coupler_motion(linkage[None], turn, np.array([side]))
    joint = motion.point - complex(linkage[PX], linkage[PY]) * motion.direction
    places = np.concatenate([motion.point, joint, joint + linkage[COUPLER] * motion.direction])
    bends = np.abs(np.roll(places, 1, axis=1) + np.roll(places, -1, axis=1) - 2 * places).max()
    fixed = np.array([complex(linkage[OX], linkage[OY]), complex(linkage[DX], linkage[DY])])
    everything = np.append(places.ravel(), fixed)
    width, height = np.ptp(everything.real), np.ptp(everything.imag)
    slack = 2 * 1.01 * bends / 8
    return bool(width + slack <= size[0] * (1 + 1e-9) and height + slack <= size[1] * (1 + 1e-9))


def _candidates(wanted: Synthesis, problem: FitProblem, closed: bool, seed: int) -> FitLanes:
    targets = problem.targets
    points = np.asarray(targets.points, dtype=np.complex128)
    if targets.crank is not None:
        lanes = timed_candidates(points, targets.crank, wanted.timing == "phase")
    elif closed:
        lanes = closed_candidates(points)
    else:
        lanes = open_candidates(points, OPEN_CANDIDATES)
    bounded = np.isfinite(problem.low[:9]) & np.isfinite(problem.high[:9])
    if wanted.place == "given" or bounded[CRANK:].any() or len(points) < 6:
        random = np.random.default_rng(seed)
        low, high = problem.low.copy(), problem.high.copy()
        low[PHASE:], high[PHASE:] = 0.0, 0.0
        if problem.free[PHASE]:
            low[PHASE], high[PHASE] = -np.pi, np.pi
        further = random_candidates(points, targets.crank, low, high, random, RANDOM_STARTS)
        lanes = lanes.join(further)
    lanes.variables = np.clip(lanes.variables, problem.low, problem.high)
    if targets.directions is not None:
        motion = coupler_motion(
            lanes.variables[:, :9], lanes.crank + lanes.variables[:, PHASE, None], lanes.side
        )
        turn = np.exp(1j * targets.directions) / motion.direction
        lanes.variables[:, ATTACHMENT] = np.angle(turn.sum(axis=1))
    return lanes


def _answers(
    task: SynthesisTask, problem: FitProblem, lanes: FitLanes, middle: complex, size: float, closed: bool
) -> tuple[list[Answer], float]:
    """Distinct answers that keep everything, best first, and the least error of those that do not."""
    wanted = task.synthesis
    constraints = wanted.constraints
    found: list[Answer] = []
    miss = float("inf")
    for k in range(len(lanes.side)):
        if not np.isfinite(lanes.errors[k]):
            continue
        linkage = lanes.variables[k, :9] * size
        for x, y in ((OX, OY), (DX, DY)):
            linkage[x] += middle.real
            linkage[y] += middle.imag
        side = float(lanes.side[k])
        crank = lanes.crank[k] + lanes.variables[k, PHASE]
        sense = float(lanes.sense[k])
        if problem.targets.crank is not None:
            sense = 1.0 if crank[-1] >= crank[0] else -1.0
        motion = coupler_motion(lanes.variables[k : k + 1, :9], crank, lanes.side[k : k + 1])
        errors = np.abs(motion.point[0] - problem.targets.points) * size
        numbers: dict[str, tuple[float, str]] = {}
        further = None
        if problem.targets.directions is not None:
            turn = np.angle(
                motion.direction[0]
                * np.exp(1j * (lanes.variables[k, ATTACHMENT] - problem.targets.directions))
            )
            numbers["turn_error"] = (float(np.abs(turn).max()), "rad")
            further = direction_point(linkage, lanes.variables[k, ATTACHMENT])
        broken = lanes.violation[k] > MET
        unordered = constraints.order and not is_ordered((crank * sense)[None], closed)[0]
        miss = min(miss, float(np.sqrt(np.mean(errors**2))))
        if broken or unordered or any(_draws_alike(linkage, side, errors, one, size) for one in found):
            continue
        answer = four_bar_answer(task, linkage, side, crank, sense, errors, closed, numbers, further)
        if constraints.order and not answer.defects.none:
            continue
        if constraints.size is not None and not is_within(linkage, side, constraints.size):
            continue
        if any(_alike(answer, other, size) for other in found):
            continue
        found.append(answer)
        if len(found) == wanted.answers:
            break
    return found, miss


def direction_point(linkage: Array, attachment: float) -> Mapping[str, list[float]]:
    """Point Q of the coupler that lies from P along the x axis of the body whose poses were given."""
    arm = 0.25 * float(linkage[COUPLER])
    return {
        "Q": [
            float(linkage[PX] + arm * np.cos(attachment)),
            float(linkage[PY] + arm * np.sin(attachment)),
        ]
    }


def _draws_alike(linkage: Array, side: float, errors: Array, other: Answer, size: float) -> bool:
    """Whether a linkage whose crank turns fully draws the curve of an answer; it need not be proved then."""
    error = float(np.sqrt(np.mean(errors**2)))
    if abs(error - other.error) > 1e-3 * other.error + 1e-9 * size or not len(other.curve):
        return False
    if not (crank_margins(linkage[None]) > 0).all():
        return False
    turn = np.linspace(0.0, 2 * np.pi, 61)
    curve = coupler_motion(linkage[None], turn, np.array([side])).point[0]
    return bool(np.abs(curve[:, None] - other.curve[None]).min(axis=1).max() < 2e-2 * size)


def _alike(answer: Answer, other: Answer, size: float) -> bool:
    """Whether two answers draw the same curve, as cognates do."""
    if abs(answer.error - other.error) > 1e-3 * other.error + 1e-9 * size:
        return False
    if not len(answer.curve) or not len(other.curve):
        return True
    distance = np.abs(answer.curve[::12, None] - other.curve[None, :]).min(axis=1).max()
    return bool(distance < 2e-2 * size)


def _trade(
    task: SynthesisTask,
    problem: FitProblem,
    lanes: FitLanes,
    answers: list[Answer],
    middle: complex,
    size: float,
    closed: bool,
    stop: Callable[[], bool],
) -> list[Answer]:
    """Answers of which none is worse than another in both its error and its size or transmission angle.

    From the best answers on, the bound is tightened step by step.
    """
    wanted = task.synthesis
    everything = list(answers)
    best = answers[0]
    for step in range(1, TRADES + 1):
        if stop():
            break
        constraints = wanted.constraints
        if wanted.trade_off == "transmission":
            least = best.transmission + (np.radians(60) - best.transmission) * step / TRADES
            if not least > best.transmission:
                break
            constraints = constraints.model_copy(update={"transmission": float(least)})
        else:
            edge = max(best.size) * (1 - step / (TRADES + 2))
            constraints = constraints.model_copy(update={"size": (edge, edge)})
        narrowed = replace(problem, hinges=hinges_of(constraints, size), weight=SHARP)
        moved = least_squares(replace(narrowed, weight=30.0), lanes, 200, 1e-10, stop)
        moved = least_squares(narrowed, moved, 200, 1e-12, stop)
        its = task.model_copy(update={"synthesis": wanted.model_copy(update={"constraints": constraints})})
        order = np.argsort(moved.errors, kind="stable")
        everything += _answers(its, narrowed, moved.take(order), middle, size, closed)[0][:2]

    def cost(answer: Answer) -> float:
        return -answer.transmission if wanted.trade_off == "transmission" else max(answer.size)

    front = [
        one
        for one in everything
        if not any(
            other.error <= one.error
            and cost(other) <= cost(one)
            and (other.error, cost(other)) != (one.error, cost(one))
            for other in everything
        )
    ]
    front.sort(key=lambda one: one.error)
    return front[: wanted.answers]


def _broken_name(constraints: Constraints, lanes: FitLanes, size: float) -> str:
    """The constraint that the lane breaks which breaks least; empty where none is broken."""
    if not len(lanes.side):
        return ""
    least = int(np.argmin(lanes.violation))
    row, side = lanes.variables[least : least + 1], lanes.side[least : least + 1]
    worst = [(float(part(row, side).max()), name) for name, part in named_hinges(constraints, size)]
    broken = [one for one in worst if one[0] > MET]
    return max(broken)[1] if broken else ""


def _nothing(wanted: Synthesis, miss: float, broken: str) -> MotionError:
    where = f"[synthesis.constraints] {broken}" if broken else "[synthesis]"
    what = _("no linkage keeps everything that is required")
    repair = _("loosen a constraint or a range")
    if np.isfinite(miss):
        repair = _(
            "without it the nearest misses the targets by {miss:.3g} m; loosen a constraint or a range"
        )
        repair = repair.format(miss=miss)
    return MotionError(where, what, repair)
