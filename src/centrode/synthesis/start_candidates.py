"""Linkages of the atlas that draw something like given points: where least squares begin.

A candidate stands where it fits best: with z its points and t the targets, both from their means, the factor
sum(t conj z) / sum |z|^2 turns and scales it, and leaves sum |t|^2 - |sum(t conj z)|^2 / sum |z|^2.
"""

from __future__ import annotations

import numpy as np

from centrode.synthesis.curve_atlas import DENSE, PLACES, Atlas, at_equal_distances, atlas, descriptors
from centrode.synthesis.four_bars import Array, Complex, coupler_motion, mirror_image, transform
from centrode.synthesis.least_squares import PHASE, VARIABLES, FitLanes

CANDIDATES = 500
ARC_SHAPES = 5000
"""Linkages of the atlas whose arcs are compared with an open path."""
ARC_PLACES = 12
ARC_WIDTHS = (5, 7, 9, 12, 16, 21, 28, 37, 48)
"""Of arcs, in places of the atlas."""
PHASES = 36
"""Starting angles of the crank that are tried where its angles are given."""


def closed_candidates(points: Complex, count: int = CANDIDATES) -> FitLanes:
    """Linkages that draw something like a closed path, chosen by Fourier descriptors."""
    book = atlas()
    even, where = at_equal_distances(points[None], PLACES, closed=True)
    shares = np.interp(np.arange(len(points)), np.append(where[0], len(points)), np.arange(PLACES + 1))
    offers = []
    for mirror in (False, True):
        for backwards in (False, True):
            shape = _variant(even[0], mirror, backwards)
            distance = ((book.descriptors - descriptors(shape)) ** 2).sum(axis=1)
            for index in np.argpartition(distance, count)[:count]:
                offers.append((int(index), mirror, backwards))
    made = [_place_linkage(book, even[0], shares, *offer) for offer in offers]
    best = np.argsort([miss for miss, *_rest in made], kind="stable")[:count]
    return FitLanes(
        np.concatenate([made[k][1] for k in best]),
        np.array([made[k][2] for k in best]),
        np.stack([made[k][3] for k in best]),
        np.array([made[k][4] for k in best]),
    )


def _variant(points: Complex, mirror: bool, backwards: bool) -> Complex:
    shape = np.conj(points) if mirror else points
    return np.roll(shape[::-1], 1) if backwards else shape


def _place_linkage(
    book: Atlas, even: Complex, shares: Array, index: int, mirror: bool, backwards: bool
) -> tuple[float, Array, float, Array, float]:
    """The miss of one linkage in its best place, its variables, side, crank angles at the targets, and their sense."""
    shape = _variant(even, mirror, backwards)
    curve = book.curves[index]
    about, centred = shape.mean(), curve - curve.mean()
    # all starts at once: the correlation of both curves over their shift
    match = np.fft.ifft(np.fft.fft(shape - about) * np.conj(np.fft.fft(centred)))
    shift = int(np.argmax(np.abs(match)))
    power = float((np.abs(centred) ** 2).sum())
    factor = match[shift] / power
    miss = float((np.abs(shape - about) ** 2).sum() - np.abs(match[shift]) ** 2 / power)
    crank = np.append(book.crank[index], book.crank[index, :1] + 2 * np.pi)
    places = -shares if backwards else shares
    angles = np.interp((places - shift) % PLACES, np.arange(PLACES + 1), crank)
    linkage = transform(
        book.linkages[index : index + 1], np.array([factor]), np.array([about - factor * curve.mean()])
    )
    angles, side, sense = angles + float(np.angle(factor)), 1.0, -1.0 if backwards else 1.0
    if mirror:
        linkage, side, angles, sense = mirror_image(linkage), -1.0, -angles, -sense
    return miss, _as_variables(linkage), side, in_sense(angles, sense), sense


def in_sense(angles: Array, sense: float) -> Array:
    """The same angles, each less than a turn behind the one before it in a sense."""
    steps = np.mod(sense * np.diff(angles), 2 * np.pi)
    # rounding must not make a turn of two equal angles
    steps = np.where(steps > 2 * np.pi - 1e-9, 0.0, steps)
    unrolled: Array = angles[0] + sense * np.concatenate([[0.0], np.cumsum(steps)])
    return unrolled


def _as_variables(linkages: Array) -> Array:
    variables = np.zeros((len(linkages), VARIABLES))
    variables[:, :9] = linkages
    return variables


def open_candidates(points: Complex, count: int = CANDIDATES) -> FitLanes:
    """Linkages of whose curves an arc looks like an open path."""
    book = atlas()
    even, _where = at_equal_distances(points[None], ARC_PLACES, closed=False)
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(points)))])
    shares = way / way[-1]
    # crank-rockers stand first in the atlas, drag links last
    chosen = np.linspace(0, len(book.linkages) - 1, ARC_SHAPES).astype(np.int64)
    curves = book.curves[chosen].astype(np.complex64)
    found: list[tuple[float, int, int, int, bool, bool]] = []
    for width in ARC_WIDTHS:
        where = np.linspace(0.0, width, ARC_PLACES)
        low = where.astype(np.int64)
        part = (where - low).astype(np.float32)
        starts = np.arange(0, PLACES, 2)
        rows = (starts[:, None] + low) % PLACES
        arcs = curves[:, rows] * (1 - part) + curves[:, (rows + 1) % PLACES] * part
        arcs = arcs - arcs.mean(axis=-1, keepdims=True)
        power = np.maximum((np.abs(arcs) ** 2).sum(axis=-1), 1e-20)
        for mirror in (False, True):
            for backwards in (False, True):
                shape = np.conj(even[0]) if mirror else even[0]
                shape = shape[::-1] if backwards else shape
                shape = shape - shape.mean()
                total = float((np.abs(shape) ** 2).sum())
                match = np.abs(arcs @ np.conj(shape).astype(np.complex64)) ** 2 / power
                miss = np.maximum(total - match, 0.0)
                flat = miss.min(axis=1)
                for index in np.argpartition(flat, count // 4)[: count // 4].tolist():
                    start = int(np.argmin(miss[index]))
                    found.append((float(flat[index]), index, int(starts[start]), width, mirror, backwards))
    found.sort()
    made = [
        _place_arc(book, int(chosen[index]), points, shares, start, width, mirror, backwards)
        for _miss, index, start, width, mirror, backwards in found[:count]
    ]
    return FitLanes(
        np.concatenate([one[0] for one in made]),
        np.array([one[1] for one in made]),
        np.stack([one[2] for one in made]),
        np.array([one[3] for one in made]),
    )


def _place_arc(
    book: Atlas,
    index: int,
    points: Complex,
    shares: Array,
    start: int,
    width: int,
    mirror: bool,
    backwards: bool,
) -> tuple[Array, float, Array, float]:
    places = start + width * (1 - shares if backwards else shares)
    crank = np.interp(
        places, np.arange(2 * PLACES + 1), np.concatenate(
            [book.crank[index], book.crank[index] + 2 * np.pi, book.crank[index, :1] + 4 * np.pi]
        )
    )  # fmt: skip
    linkage = book.linkages[index : index + 1]
    drawn = coupler_motion(linkage, crank, np.ones(1)).point[0]
    shape = np.conj(points) if mirror else points
    linkage, turn = _best_place(linkage, drawn, shape)
    crank, side, sense = crank + turn, 1.0, -1.0 if backwards else 1.0
    if mirror:
        linkage, side, crank, sense = mirror_image(linkage), -1.0, -crank, -sense
    return _as_variables(linkage), side, crank, sense


def _best_place(linkage: Array, drawn: Complex, shape: Complex) -> tuple[Array, float]:
    """A linkage moved so that what it draws fits a shape best, and the angle by which it has been turned."""
    centred = drawn - drawn.mean()
    power = max(float((np.abs(centred) ** 2).sum()), 1e-300)
    factor = ((shape - shape.mean()) * np.conj(centred)).sum() / power
    shift = shape.mean() - factor * drawn.mean()
    return transform(linkage, np.array([factor]), np.array([shift])), float(np.angle(factor))


def timed_candidates(points: Complex, angles: Array, phase_free: bool, count: int = CANDIDATES) -> FitLanes:
    """Linkages that draw something like the points at given crank angles (n,) [rad]."""
    book = atlas()
    curves = book.dense.astype(np.complex64)
    offers: list[tuple[float, int, float, bool]] = []
    for mirror in (False, True):
        shape = np.conj(points) if mirror else points
        turned = -angles if mirror else angles
        shape = (shape - shape.mean()).astype(np.complex64)
        total = float((np.abs(shape) ** 2).sum())
        for phase in np.linspace(0.0, 2 * np.pi, PHASES, endpoint=False):
            rows = np.rint((turned + phase) * (DENSE / (2 * np.pi))).astype(np.int64) % DENSE
            drawn = curves[:, rows]
            drawn = drawn - drawn.mean(axis=1, keepdims=True)
            power = np.maximum((np.abs(drawn) ** 2).sum(axis=1), 1e-20)
            match = np.conj(drawn) @ shape
            # With a given zero of the crank angle the turn of the linkage follows from the phase.
            gain = np.abs(match) if phase_free else np.maximum((match * np.exp(1j * phase)).real, 0.0)
            miss = total - gain**2 / power
            for index in np.argpartition(miss, count // 10)[: count // 10].tolist():
                offers.append((float(miss[index]), index, float(phase), mirror))
    offers.sort()
    variables, sides, cranks = [], [], []
    for _miss, index, phase, mirror in offers[:count]:
        turned = -angles if mirror else angles
        linkage = book.linkages[index : index + 1]
        drawn = coupler_motion(linkage, turned + phase, np.ones(1)).point[0]
        linkage, turn = _best_place(linkage, drawn, np.conj(points) if mirror else points)
        offset, side = turn + phase, 1.0
        if mirror:
            linkage, side, offset = mirror_image(linkage), -1.0, -offset
        row = _as_variables(linkage)
        row[:, PHASE] = offset if phase_free else 0.0
        variables.append(row)
        sides.append(side)
        cranks.append(angles)
    sense = np.sign(angles[-1] - angles[0]) or 1.0
    return FitLanes(np.concatenate(variables), np.array(sides), np.stack(cranks), np.full(len(sides), sense))


def random_candidates(
    points: Complex,
    angles: Array | None,
    low: Array,
    high: Array,
    random: np.random.Generator,
    count: int,
) -> FitLanes:
    """Linkages whose variables are drawn evenly between bounds; without bounds within twice the size of the targets."""
    least = np.where(np.isfinite(low), low, np.where(np.isfinite(high), high - 4.0, -2.0))
    greatest = np.where(np.isfinite(high), high, np.maximum(least + 4.0, 2.0))
    variables = random.uniform(least, greatest, (count, VARIABLES))
    side = np.where(random.uniform(size=count) < 0.5, -1.0, 1.0)
    if angles is not None:
        crank = np.broadcast_to(angles, (count, len(angles))).copy()
        return FitLanes(variables, side, crank, np.ones(count))
    variables[:, PHASE] = 0.0
    turn = np.linspace(0.0, 2 * np.pi, 72, endpoint=False)
    motion = coupler_motion(variables[:, :9], turn, side)
    distance = np.abs(motion.point[:, :, None] - points) + np.where(motion.radicand[:, :, None] > 0, 0.0, 1e3)
    crank = np.unwrap(turn[np.argmin(distance, axis=1)], axis=1)
    sense = np.where(crank[:, -1] >= crank[:, 0], 1.0, -1.0)
    return FitLanes(variables, side, crank, sense)
