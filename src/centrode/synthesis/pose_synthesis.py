"""Four-bar linkages that lead their coupler exactly through two to five poses: from a request to answers."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from centrode.errors import MotionError
from centrode.locale import _
from centrode.synthesis.answers import Answer, SynthesisResults, four_bar_answer, refuse_poses
from centrode.synthesis.burmester import (
    Dyads,
    Poses,
    five_pose_dyads,
    four_pose_dyads,
    three_pose_centres,
    three_pose_moving_points,
)
from centrode.synthesis.four_bars import (
    Array,
    Booleans,
    Complex,
    coupler_motion,
    crank_margins,
    least_transmission,
    lengths,
)
from centrode.synthesis.requests import Synthesis, SynthesisTask

ALONG = 90
"""Dyads of each branch of the curves of four poses that are paired."""
GRID = 15
"""Places of each direction at which hinges are tried where two or three poses leave them free."""
REACH = 2.5
"""Of that grid, in sizes of the poses."""
MOST_RATIO = 20.0
"""Of lengths, where the request gives none."""
GOOD_TRANSMISSION, ALIKE = math.radians(50), math.radians(10)
"""A transmission angle beyond which more is not better, and a difference that does not count."""
WAY = 91
"""Crank angles at which the way between poses is looked at before the engine proves it."""


def pose_answers(
    task: SynthesisTask,
    progress: Callable[[float], None] = lambda share: None,
    stop: Callable[[], bool] = lambda: False,
) -> SynthesisResults:
    """Linkages through all poses exactly, those without defects first, then by their least transmission angle.

    Raises
    ------
    MotionError
        No linkage leads through the poses, or none that keeps what is required.
    """
    wanted = task.synthesis
    rows = np.array(wanted.rows, dtype=np.float64)
    poses = Poses(rows[:, 0] + 1j * rows[:, 1], rows[:, 2])
    dyads, pairs, curves = _dyads(wanted, poses)
    if not len(pairs):
        what = _("no real dyad leads through these poses") if len(poses.angles) == 5 else _(
            "no pair of dyads leads through these poses"
        )  # fmt: skip
        raise MotionError("[synthesis] targets", what, _("change one of the poses, or remove one"))
    progress(0.3)
    answers = _choose_answers(task, poses, dyads, pairs, progress, stop)
    if not answers:
        refuse_poses(len(pairs))
    return SynthesisResults(
        task, tuple(answers), poses.places, examined=len(pairs), complete=not stop(), curves=curves
    )


def _dyads(
    wanted: Synthesis, poses: Poses
) -> tuple[Dyads, np.ndarray[tuple[int, ...], np.dtype[np.int64]], dict[str, Complex]]:
    """Dyads, pairs of their numbers of which the first is the crank, and curves to be drawn."""
    count = len(poses.angles)
    curves: dict[str, Complex] = {}
    if count == 5:
        dyads = five_pose_dyads(poses)
        four = four_pose_dyads(Poses(poses.places[:4], poses.angles[:4]))
        curves = {"centres": four.fixed, "circle_points": four.moving}
    elif count == 4:
        four = four_pose_dyads(poses)
        curves = {"centres": four.fixed, "circle_points": four.moving}
        near = np.abs(four.fixed - poses.places.mean()) + np.abs(four.moving - poses.places.mean())
        kept = np.flatnonzero(near < 20 * poses.size)
        dyads = four.take(kept[:: max(1, len(kept) // (2 * ALONG))])
    elif wanted.hinges is not None and count == 3:
        fixed = np.array([complex(*hinge) for hinge in wanted.hinges])
        dyads = Dyads(three_pose_moving_points(poses, fixed), fixed)
    else:
        dyads = _free_dyads(poses)
    number = len(dyads.moving)
    first, second = np.meshgrid(np.arange(number), np.arange(number), indexing="ij")
    pairs = np.column_stack([first.ravel(), second.ravel()])
    return dyads, pairs[pairs[:, 0] != pairs[:, 1]], curves


def _free_dyads(poses: Poses) -> Dyads:
    """Dyads of two or three poses, with moving points on a grid around the first pose."""
    axis = np.linspace(-REACH, REACH, GRID)
    size = poses.size if poses.size > 1e-9 else 1.0
    grid = (axis[:, None] + 1j * axis[None, :]).ravel() * size + poses.places[0]
    if len(poses.angles) == 3:
        fixed = three_pose_centres(poses, grid)
        good = np.abs(fixed - poses.places.mean()) < 10 * size
        return Dyads(grid[good], fixed[good])
    # Of two poses each centre lies on the perpendicular bisector of a point's two places.
    grid = grid[::5]
    image = poses.turns[0] * grid + poses.shifts[0]
    across = 1j * (image - grid)
    away = np.array([-1.5, -0.6, 0.6, 1.5])
    fixed = (grid + image)[:, None] / 2 + across[:, None] * away
    return Dyads(np.repeat(grid, len(away)), fixed.ravel())


def _choose_answers(
    task: SynthesisTask,
    poses: Poses,
    dyads: Dyads,
    pairs: np.ndarray[tuple[int, ...], np.dtype[np.int64]],
    progress: Callable[[float], None],
    stop: Callable[[], bool],
) -> list[Answer]:
    wanted = task.synthesis
    linkages, crank, sides = _linkages(poses, dyads, pairs)
    constraints = wanted.constraints
    turns = np.all(crank_margins(linkages) > 1e-9, axis=1)
    sense = np.where(crank[:, -1] >= crank[:, 0], 1.0, -1.0)
    one_side = (sides == sides[:, :1]).all(axis=1)
    # A crank that turns fully may pass all poses in the other sense as well.
    forwards, backwards = (np.mod(s * np.diff(crank, axis=1), 2 * np.pi) for s in (1.0, -1.0))
    unrolled = {
        1.0: np.concatenate([crank[:, :1], crank[:, :1] + np.cumsum(forwards, axis=1)], axis=1),
        -1.0: np.concatenate([crank[:, :1], crank[:, :1] - np.cumsum(backwards, axis=1)], axis=1),
    }
    found_sense = np.where(forwards.sum(axis=1) <= backwards.sum(axis=1), 1.0, -1.0)
    way = np.where(found_sense[:, None] > 0, unrolled[1.0], unrolled[-1.0])
    sense = found_sense
    ordered = np.abs(way[:, -1] - way[:, 0]) < 2 * np.pi - 1e-9
    transmission, passes = _along(linkages, sides[:, 0], way, turns)
    good = np.isfinite(linkages).all(axis=1) & (linkages[:, 4:7] > 1e-6 * poses.size).all(axis=1)
    ratio = lengths(linkages)
    good &= ratio.max(axis=1) <= (constraints.length_ratio or MOST_RATIO) * ratio.min(axis=1)
    if constraints.crank is not None:
        good &= turns
    if constraints.transmission is not None:
        good &= transmission >= constraints.transmission - 1e-9
    for ks, box in (((0, 2), constraints.pivots.x), ((1, 3), constraints.pivots.y)):
        if box is not None:
            for k in ks:
                good &= (linkages[:, k] >= box[0] - 1e-9) & (linkages[:, k] <= box[1] + 1e-9)
    clean = one_side & ordered & passes
    if constraints.order:
        good &= clean
    # of linkages that transmit nearly alike the smaller one comes first
    grade = np.floor(np.minimum(np.nan_to_num(transmission), GOOD_TRANSMISSION) / ALIKE)
    rank = np.lexsort((ratio.sum(axis=1), -grade, ~clean))
    answers: list[Answer] = []
    kept: list[int] = []
    for k in rank[good[rank]].tolist():
        if stop() and answers:
            break
        if len(poses.angles) < 5 and any(_near(linkages[k], linkages[j], poses.size) for j in kept):
            continue
        answer = _answer(task, poses, linkages[k], float(sides[k, 0]), way[k], float(sense[k]))
        if constraints.order and not answer.defects.none:
            continue
        if constraints.size is not None and any(
            mine > most + 1e-9 for mine, most in zip(answer.size, constraints.size, strict=True)
        ):
            continue
        kept.append(k)
        answers.append(answer)
        progress(0.3 + 0.7 * len(answers) / wanted.answers)
        if len(answers) == wanted.answers:
            break
    return answers


def _linkages(
    poses: Poses, dyads: Dyads, pairs: np.ndarray[tuple[int, ...], np.dtype[np.int64]]
) -> tuple[Array, Array, Array]:
    """Dimensions (pairs, 9), crank angles (pairs, poses) and sides (pairs, poses) of pairs of dyads."""
    first, second = dyads.take(pairs[:, 0]), dyads.take(pairs[:, 1])
    turns = np.concatenate([[1.0], poses.turns])
    shifts = np.concatenate([[0.0], poses.shifts])
    joint = first.moving[:, None] * turns + shifts
    other = second.moving[:, None] * turns + shifts
    arm = second.moving - first.moving
    length = np.abs(arm)
    with np.errstate(divide="ignore", invalid="ignore"):
        local = (poses.places[0] - first.moving) / (arm / length)
    crank = np.angle(joint - first.fixed[:, None])
    line = second.fixed[:, None] - joint
    sides = np.where((np.conj(line) * (other - joint)).imag >= 0, 1.0, -1.0)
    linkages = np.column_stack(
        [
            first.fixed.real, first.fixed.imag, second.fixed.real, second.fixed.imag,
            np.abs(first.moving - first.fixed), length, np.abs(second.moving - second.fixed),
            local.real, local.imag,
        ]
    )  # fmt: skip
    return linkages, crank, sides


def _along(linkages: Array, side: Array, way: Array, turns: Booleans) -> tuple[Array, Booleans]:
    """Least transmission angle (n,) [rad] and whether a linkage closes all along, over a turn or from pose to pose."""
    transmission = least_transmission(linkages)
    passes = turns.copy()
    for begin in range(0, len(linkages), 4000):
        part = slice(begin, begin + 4000)
        share = np.linspace(0.0, 1.0, WAY)
        angles = way[part, :1] + (way[part, -1:] - way[part, :1]) * share
        motion = coupler_motion(linkages[part], angles, side[part])
        closes = (motion.radicand > 0).all(axis=1)
        least = np.arcsin(np.minimum(np.abs(motion.sine).min(axis=1), 1.0))
        transmission[part] = np.where(turns[part], transmission[part], least)
        passes[part] |= closes
    return transmission, passes


def _near(linkage: Array, other: Array, size: float) -> bool:
    """Whether two linkages are nearly the same, or the same with crank and rocker exchanged."""
    near = 0.5 * size
    exchanged = other[[2, 3, 0, 1, 6, 5, 4]]
    return bool(np.abs(linkage[:7] - other[:7]).max() < near or np.abs(linkage[:7] - exchanged).max() < near)


def _answer(
    task: SynthesisTask, poses: Poses, linkage: Array, side: float, way: Array, sense: float
) -> Answer:
    motion = coupler_motion(linkage[None], way, np.array([side]))
    errors = np.abs(motion.point[0] - poses.places)
    attachment = poses.angles - np.angle(motion.direction[0])
    turn = np.angle(np.exp(1j * (attachment - attachment[0])))
    base = float(attachment[0])
    arm = 0.25 * float(linkage[5])
    further = {"Q": [float(linkage[7]) + arm * math.cos(base), float(linkage[8]) + arm * math.sin(base)]}
    numbers = {"turn_error": (float(np.abs(turn).max()), "rad")}
    return four_bar_answer(task, linkage, side, way, sense, errors, False, numbers, further)
