"""Least squares of many four-bar linkages at once: targets of a point and of the coupler, with or without crank angles.

Each lane is one linkage that starts from a place of its own. A crank angle that nobody gives is a variable of its own
target only, so the normal equations are an arrow: the angles are eliminated target by target, and what remains is one
small system of the dimensions (Levenberg and Marquardt with a Schur complement; G. H. Golub, V. Pereyra, Inverse
Problems 19, 2003, R1-R26). Constraints are hinges: residuals that are zero where a constraint holds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from centrode.synthesis.four_bars import (
    Array,
    Booleans,
    Complex,
    coupler_motion,
    coupler_slopes,
)

PHASE, ATTACHMENT = 9, 10
"""Variables behind the nine dimensions: of given crank angles, and of the body's x axis from that of the coupler."""
VARIABLES = 11
GAP = 1e-3
"""Crank angle [rad] by which consecutive targets of an ordered path are apart at least."""
LANES_AT_ONCE = 64
"""Lanes whose hinges are differentiated by all variables at once: so many fit a processor's cache."""
LEAST_LENGTH = 1e-3
"""Of a link, in units of the size of the targets."""
Hinges = Callable[[Array, Array], Array]
"""(linkages (lanes, 11), side (lanes,)) -> (lanes, m) above zero where a constraint does not hold."""


@dataclass(frozen=True, eq=False)
class Targets:
    """What is to be met, in any unit of length.

    Attributes
    ----------
    points : (n) of P, complex; on the sphere unit vectors (n, 3)
    directions : (n) angles of the body [rad], on the sphere unit vectors (n, 3) of its x axis, or None
    crank : (n) angles of the crank [rad], or None where they are free
    arm : length that an angle of one radian counts for
    """

    points: Complex | Array
    directions: Array | None = None
    crank: Array | None = None
    arm: float = 1.0


@dataclass(frozen=True)
class FitKernel:
    """How linkages of a space miss targets; both functions take the targets, variables, sides and crank angles.

    Attributes
    ----------
    residuals : (lanes, n, rows), and (lanes,) bool whether a linkage closes at all targets
    slopes : derivatives (lanes, n, rows, 11) by the variables and (lanes, n, rows) by the crank's angle
    """

    residuals: Callable[[Targets, Array, Array, Array], tuple[Array, Booleans]]
    slopes: Callable[[Targets, Array, Array, Array], tuple[Array, Array]]


def _plane_residuals(
    targets: Targets, variables: Array, side: Array, angles: Array
) -> tuple[Array, Booleans]:
    motion = coupler_motion(variables[:, :9], angles, side)
    miss = motion.point - targets.points
    rows = [miss.real, miss.imag]
    if targets.directions is not None:
        wanted = np.exp(1j * (targets.directions - variables[:, ATTACHMENT, None]))
        rows.append(targets.arm * np.angle(motion.direction / wanted))
    return np.stack(rows, axis=-1), np.all(motion.radicand > 0, axis=1)


def _plane_slopes(targets: Targets, variables: Array, side: Array, angles: Array) -> tuple[Array, Array]:
    linkages = variables[:, :9]
    slopes = coupler_slopes(linkages, angles, coupler_motion(linkages, angles, side))
    lanes, n = angles.shape
    rows = 3 if targets.directions is not None else 2
    by = np.zeros((lanes, n, rows, VARIABLES))
    by[:, :, 0, :9], by[:, :, 1, :9] = slopes.point.real, slopes.point.imag
    turn = np.zeros((lanes, n, rows))
    turn[:, :, 0], turn[:, :, 1] = slopes.point_by_crank.real, slopes.point_by_crank.imag
    if rows == 3:
        by[:, :, 2, :9] = targets.arm * slopes.angle
        by[:, :, 2, ATTACHMENT] = targets.arm
        turn[:, :, 2] = targets.arm * slopes.angle_by_crank
    by[..., PHASE] = turn
    return by, turn


PLANE = FitKernel(_plane_residuals, _plane_slopes)


@dataclass(frozen=True, eq=False)
class FitProblem:
    """Targets, what may vary, and what has to hold.

    Attributes
    ----------
    free : (11) bool
    low, high : (11) bounds of the variables
    hinges : constraints, or None
    weight : of the hinges
    kernel : of the plane or of the sphere
    """

    targets: Targets
    free: Booleans
    low: Array
    high: Array
    hinges: Hinges | None = None
    weight: float = 30.0
    kernel: FitKernel = PLANE


@dataclass(eq=False)
class FitLanes:
    """Linkages on their way.

    Attributes
    ----------
    variables : (lanes, 11)
    side : (lanes,)
    crank : (lanes, n) angles of the crank at the targets, without the phase
    sense : (lanes,) +1 where the crank turns counter-clockwise from target to target, -1 otherwise
    first : (lanes, n) index of the target whose angle a target shares, its own if it is free
    errors : (lanes,) sum of squares of what misses the targets
    violation : (lanes,) greatest hinge
    """

    variables: Array
    side: Array
    crank: Array
    sense: Array
    first: np.ndarray[tuple[int, ...], np.dtype[np.int64]] | None = None
    errors: Array = field(default_factory=lambda: np.empty(0))
    violation: Array = field(default_factory=lambda: np.empty(0))

    def take(self, which: np.ndarray[tuple[int, ...], np.dtype[np.int64]]) -> FitLanes:
        """Some of the lanes."""
        return FitLanes(
            self.variables[which],
            self.side[which],
            self.crank[which],
            self.sense[which],
            None if self.first is None else self.first[which],
            self.errors[which] if len(self.errors) else self.errors,
            self.violation[which] if len(self.violation) else self.violation,
        )

    def put(self, which: np.ndarray[tuple[int, ...], np.dtype[np.int64]], others: FitLanes) -> None:
        """Fitted lanes in place of some of these."""
        if self.first is None:
            self.first = np.tile(np.arange(self.crank.shape[1]), (len(self.crank), 1))
        for name in ("variables", "crank", "first", "errors", "violation"):
            getattr(self, name)[which] = getattr(others, name)

    def join(self, other: FitLanes) -> FitLanes:
        """These and others; both have been fitted."""
        own = np.broadcast_to(np.arange(self.crank.shape[1]), self.crank.shape)
        others = np.broadcast_to(np.arange(self.crank.shape[1]), other.crank.shape)
        return FitLanes(
            np.concatenate([self.variables, other.variables]),
            np.concatenate([self.side, other.side]),
            np.concatenate([self.crank, other.crank]),
            np.concatenate([self.sense, other.sense]),
            np.concatenate(
                [own if self.first is None else self.first, others if other.first is None else other.first]
            ),
            np.concatenate([self.errors, other.errors]),
            np.concatenate([self.violation, other.violation]),
        )


def _angles(problem: FitProblem, variables: Array, crank: Array) -> Array:
    return crank + variables[:, PHASE, None]


def _residuals(problem: FitProblem, variables: Array, side: Array, crank: Array) -> tuple[Array, Booleans]:
    """(lanes, n, rows) of the targets, and (lanes,) bool whether the linkage closes at all of them."""
    return problem.kernel.residuals(problem.targets, variables, side, _angles(problem, variables, crank))


def _slopes(problem: FitProblem, variables: Array, side: Array, crank: Array) -> tuple[Array, Array]:
    """Derivatives (lanes, n, rows, 11) by the variables and (lanes, n, rows) by the crank's angle."""
    return problem.kernel.slopes(problem.targets, variables, side, _angles(problem, variables, crank))


def _hinges(problem: FitProblem, variables: Array, side: Array) -> Array:
    if problem.hinges is None:
        return np.zeros((len(variables), 0))
    return np.maximum(problem.hinges(variables, side), 0.0)


def _hinge_slopes(problem: FitProblem, variables: Array, side: Array, values: Array) -> Array:
    """(lanes, m, 11); hinges are smooth where they are not zero, and their slopes need no more than half the digits."""
    slopes = np.zeros((*values.shape, VARIABLES))
    active = np.flatnonzero((values > 0).any(axis=1))
    if not len(active) or problem.hinges is None:
        return slopes
    for some in np.split(active, range(LANES_AT_ONCE, len(active), LANES_AT_ONCE)):
        slopes[some] = _hinge_differences(problem.hinges, variables[some], side[some], problem.free)
    slopes[values <= 0] = 0.0
    return np.nan_to_num(slopes, posinf=0.0, neginf=0.0)


def _hinge_differences(hinges: Hinges, variables: Array, side: Array, free: Booleans) -> Array:
    """Central differences (lanes, m, 11) of hinges by the variables that are free, all of them in one call."""
    steps = np.where(free, 1e-6 * np.maximum(np.abs(variables), 1.0), 0.0)
    moves = steps[:, None, :] * np.eye(VARIABLES)[free]
    both = np.stack([variables[:, None, :] + moves, variables[:, None, :] - moves])
    sides = np.broadcast_to(side[:, None], both.shape[:3])
    ahead, behind = hinges(both.reshape(-1, VARIABLES), sides.ravel()).reshape(*both.shape[:3], -1)
    slopes = np.zeros((len(variables), ahead.shape[-1], VARIABLES))
    slopes[:, :, free] = ((ahead - behind) / (2 * steps[:, free])[..., None]).transpose(0, 2, 1)
    return slopes


def least_squares(
    problem: FitProblem,
    start: FitLanes,
    iterations: int = 100,
    tolerance: float = 1e-12,
    stop: Callable[[], bool] = lambda: False,
) -> FitLanes:
    """Every lane brought to the next minimum of its sum of squares.

    Parameters
    ----------
    iterations : at most
    tolerance : a lane rests once three steps together gain less than this part of its sum
    stop : looked at before each iteration

    Returns
    -------
    Lanes
        In the order of `start`; `errors` is without the hinges. A lane that does not close keeps infinite errors.
    """
    variables, side, crank = start.variables.copy(), start.side, start.crank.copy()
    lanes = len(variables)
    damping = np.full(lanes, 1e-3)
    poor = np.zeros(lanes, dtype=np.int64)
    cost, _errors, _violation = _cost(problem, variables, side, crank)
    moving = np.flatnonzero(np.isfinite(cost))
    for _iteration in range(iterations):
        if not len(moving) or stop():
            break
        first = None if start.first is None else start.first[moving]
        step, turn = _step(problem, variables[moving], side[moving], crank[moving], first, damping[moving])
        proposed = np.clip(variables[moving] + step, problem.low, problem.high)
        turned = crank[moving] + turn
        found, _errors, _violation = _cost(problem, proposed, side[moving], turned)
        better = found < cost[moving]
        gain = np.where(better, cost[moving] - np.where(better, found, 0.0), 0.0)
        small = gain <= tolerance * cost[moving]
        taken = moving[better]
        variables[taken], crank[taken], cost[taken] = proposed[better], turned[better], found[better]
        damping[moving] = np.where(better, damping[moving] * 0.2, damping[moving] * 6.0)
        damping[moving] = np.clip(damping[moving], 1e-14, 1e16)
        poor[moving] = np.where(
            small & (better | (damping[moving] > 1e6)), poor[moving] + 1, poor[moving] * small
        )
        moving = moving[(poor[moving] < 3) & (damping[moving] < 1e12) & (cost[moving] > 1e-30)]
    _total, errors, violation = _cost(problem, variables, side, crank)
    return FitLanes(variables, side, crank, start.sense, start.first, errors, violation)


def _cost(problem: FitProblem, variables: Array, side: Array, crank: Array) -> tuple[Array, Array, Array]:
    with np.errstate(over="ignore", invalid="ignore"):
        rows, closes = _residuals(problem, variables, side, crank)
        errors = (rows**2).sum(axis=(1, 2))
        hinges = _hinges(problem, variables, side)
        cost = errors + problem.weight**2 * (hinges**2).sum(axis=1)
    good = closes & np.isfinite(cost)
    return (
        np.where(good, cost, np.inf),
        np.where(good, errors, np.inf),
        hinges.max(axis=1, initial=0.0),
    )


def _step(
    problem: FitProblem,
    variables: Array,
    side: Array,
    crank: Array,
    first: np.ndarray[tuple[int, ...], np.dtype[np.int64]] | None,
    damping: Array,
) -> tuple[Array, Array]:
    """One damped step of the variables (lanes, 11) and of the crank angles (lanes, n)."""
    rows, _closes = _residuals(problem, variables, side, crank)
    by, turn = _slopes(problem, variables, side, crank)
    lanes = len(crank)
    transposed = by.reshape(lanes, -1, VARIABLES).transpose(0, 2, 1)
    normal, gradient = _normal_equations(problem, variables, side, by, rows)
    diagonal = np.einsum("lii->li", normal)
    diagonal += damping[:, None] * (diagonal + 1e-12)
    free_crank = problem.targets.crank is None
    if free_crank:
        # each angle belongs to its own target, or to the first of those that share it
        own = _sum_shared((turn * turn).sum(axis=-1), first)
        mixed = _sum_shared(np.einsum("lnr,lnri->lni", turn, by), first)
        # a cusp must not send the angle far
        own = own + 1e-4 * own.mean(axis=1, keepdims=True) + 1e-14
        scaled = mixed / own[..., None]
        normal -= mixed.transpose(0, 2, 1) @ scaled
        pull = _sum_shared((turn * rows).sum(axis=-1), first)
        gradient -= (scaled * pull[..., None]).sum(axis=1)
    # Variables that are fixed, or pressed against their bound, stay.
    fixed = ~problem.free | ((variables <= problem.low) & (gradient > 0))
    fixed |= (variables >= problem.high) & (gradient < 0)
    normal, scale = _with_unit_diagonals(normal, fixed)
    # lanes without numbers take no step
    good: Booleans = np.asarray(np.isfinite(normal).all(axis=(1, 2)) & np.isfinite(gradient).all(axis=1))
    normal[~good], gradient[~good] = np.eye(VARIABLES), 0.0
    inverse = np.linalg.inv(normal)

    def solve(right: Array, pulled: Array | None) -> tuple[Array, Array]:
        step = (inverse @ np.where(fixed, 0.0, -right / scale)[..., None])[..., 0] / scale
        if pulled is None:
            return step, np.zeros_like(crank)
        turned = -(pulled + (mixed @ step[..., None])[..., 0]) / own
        return step, turned if first is None else np.take_along_axis(turned, first, axis=1)

    step, turned = solve(gradient, pull if free_crank else None)
    # Along a curved valley the second derivative in the direction of the step bends it
    # (M. K. Transtrum, J. P. Sethna, arXiv:1201.5885, 2012).
    part = 0.1
    ahead, _closes = _residuals(problem, variables + part * step, side, crank + part * turned)
    straight = (
        np.einsum("lnri,li->lnr", by, step) + turn * (turned if free_crank else 0.0 * turned)[..., None]
    )
    bend = 2.0 / part * ((ahead - rows) / part - straight)
    gradient = (transposed @ bend.reshape(lanes, -1, 1))[..., 0]
    if free_crank:
        pull = _sum_shared((turn * bend).sum(axis=-1), first)
        gradient -= (scaled * pull[..., None]).sum(axis=1)
    second, turned_further = solve(np.where(good[:, None], gradient, 0.0), pull if free_crank else None)
    ratio = np.linalg.norm(second * scale, axis=1) / np.maximum(np.linalg.norm(step * scale, axis=1), 1e-300)
    bent = np.where(np.isfinite(ratio) & (ratio < 0.75), 0.5, 0.0)[:, None]
    step = step + bent * np.where(bent > 0, second, 0.0)
    turned = np.clip(turned + bent * np.where(bent > 0, turned_further, 0.0), -0.5, 0.5)
    return step, turned


def _normal_equations(
    problem: FitProblem, variables: Array, side: Array, by: Array, rows: Array
) -> tuple[Array, Array]:
    """Matrices (lanes, 11, 11) and right sides (lanes, 11) of the residuals and of hinges beyond their ranges."""
    lanes = len(variables)
    flat = by.reshape(lanes, -1, VARIABLES)
    transposed = flat.transpose(0, 2, 1)
    normal = transposed @ flat
    gradient = (transposed @ rows.reshape(lanes, -1, 1))[..., 0]
    values = _hinges(problem, variables, side)
    if values.shape[1]:
        slopes = _hinge_slopes(problem, variables, side, values)
        normal += problem.weight**2 * np.einsum("lmi,lmj->lij", slopes, slopes)
        gradient += problem.weight**2 * np.einsum("lmi,lm->li", slopes, values)
    return normal, gradient


def _with_unit_diagonals(normal: Array, fixed: Booleans) -> tuple[Array, Array]:
    """Matrices with ones on their diagonals, and the scale of each variable; those that are fixed stand alone."""
    normal = np.where(fixed[:, :, None] | fixed[:, None, :], 0.0, normal)
    scale = np.sqrt(np.maximum(np.einsum("lii->li", normal), 1e-30))
    scale = np.where(fixed, 1.0, scale)
    normal = normal / (scale[:, :, None] * scale[:, None, :])
    return normal + np.where(fixed, 1.0, 1e-15)[:, :, None] * np.eye(VARIABLES), scale


def _sum_shared(values: Array, first: np.ndarray[tuple[int, ...], np.dtype[np.int64]] | None) -> Array:
    return values if first is None else _gather(values, first)


def _gather(values: Array, first: np.ndarray[tuple[int, ...], np.dtype[np.int64]]) -> Array:
    """Sums over targets that share an angle, at the first of them; zero at the others."""
    sums = np.zeros_like(values)
    np.add.at(sums, (np.arange(len(values))[:, None], first), values)
    return sums


# Order of targets along the path.


def is_ordered(crank: Array, closed: bool) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Whether crank angles (lanes, n) grow from target to target, over less than a turn for a closed path."""
    steps = np.diff(crank, axis=1)
    grows = (steps > GAP / 2).all(axis=1)
    within = crank[:, -1] - crank[:, 0] < 2 * np.pi - (GAP / 2 if closed else -1e-9)
    good: np.ndarray[tuple[int, ...], np.dtype[np.bool_]] = grows & within
    return good


def ordered_fit(
    problem: FitProblem,
    lanes: FitLanes,
    closed: bool,
    iterations: int,
    stop: Callable[[], bool] = lambda: False,
) -> FitLanes:
    """Least squares with crank angles that grow from target to target by `GAP` at least.

    With the linkage kept, the angles are an isotonic regression of where they would go, which tells which targets share
    an angle; with these together the linkage follows. Both alternate until the groups stay.
    """
    done = least_squares(problem, lanes, 0)
    moving = np.arange(len(lanes.side))
    for _round in range(10):
        before = done.take(moving)
        first, crank = _shared_angles(problem, before, closed)
        proposed = replace(before, crank=crank, first=first)
        done.put(moving, least_squares(problem, proposed, iterations, 1e-10, stop))
        if before.first is not None:
            moving = moving[(before.first != first).any(axis=1)]
        if stop() or not len(moving):
            break
    return done


def _shared_angles(
    problem: FitProblem, lanes: FitLanes, closed: bool
) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.int64]], Array]:
    """First target of each group that shares an angle (lanes, n), and the angles, which are in order."""
    rows, _closes = _residuals(problem, lanes.variables, lanes.side, lanes.crank)
    _by, turn = _slopes(problem, lanes.variables, lanes.side, lanes.crank)
    weight = (turn * turn).sum(axis=-1) + 1e-12
    wanted = lanes.crank - np.clip((turn * rows).sum(axis=-1) / weight, -0.3, 0.3)
    wanted, present = wanted * lanes.sense[:, None], lanes.crank * lanes.sense[:, None]
    count, n = wanted.shape
    first = np.empty((count, n), dtype=np.int64)
    crank = np.empty((count, n))
    for lane in range(count):
        order = np.arange(n)
        angles = wanted[lane].copy()
        if closed:
            # begun behind the widest gap, where no group reaches over the end
            widest = int(np.argmax(np.diff(np.append(present[lane], present[lane, 0] + 2 * np.pi))))
            order = np.roll(order, -(widest + 1))
            angles = angles[order]
            angles[n - widest - 1 :] += 2 * np.pi
        groups, level = _isotonic(angles - GAP * np.arange(n), weight[lane, order])
        level = level + GAP * np.arange(n)
        if closed:
            level[n - widest - 1 :] -= 2 * np.pi
        # a group may begin at the end of the list and go on at its start: its first is any one of its own
        first[lane, order] = order[groups]
        crank[lane, order] = level
    return first, crank * lanes.sense[:, None]


def _isotonic(values: Array, weights: Array) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.int64]], Array]:
    """Weighted isotonic regression by pooling adjacent violators: first index of each group, and its level."""
    starts: list[int] = []
    levels: list[float] = []
    masses: list[float] = []
    for index, (value, weight) in enumerate(zip(values.tolist(), weights.tolist(), strict=True)):
        starts.append(index)
        levels.append(value)
        masses.append(weight)
        while len(levels) > 1 and levels[-2] > levels[-1]:
            level, mass = levels.pop(), masses.pop()
            starts.pop()
            total = masses[-1] + mass
            levels[-1] = (levels[-1] * masses[-1] + level * mass) / total
            masses[-1] = total
    bounds = [*starts, len(values)]
    sizes = np.diff(bounds)
    return np.repeat(np.array(starts, dtype=np.int64), sizes), np.repeat(np.array(levels), sizes)
