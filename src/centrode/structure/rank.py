"""Which constraints are independent: rank of the Jacobian, row by row.

Counting alone assigns redundancy wrongly in some couplers (a rigid braced quadrilateral has as many bars as
unknowns elsewhere), so rows are tested numerically at a random realisation of the same structure. A generic
rank in the plane is also the generic rank on the sphere (coning), so this serves both.
"""

from __future__ import annotations

import heapq
from collections import Counter, deque
from collections.abc import Collection, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import cos, sin, tau
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from centrode.geometry.plane import PlanePose, Vector, cross, reversed_rotor, rotate_vector, subtract
from centrode.geometry.space import Row
from centrode.locale import _
from centrode.model.mechanism import Guide, Mechanism, Rolling
from centrode.numerics.arrays import ARRAYS
from centrode.structure.constraints import FRAME, Constraint, Entity, Positions, TrackContact
from centrode.structure.dimensions import Dimensions
from centrode.structure.gearing import Gearing, Round, Straight, Track

# Random numbers of gears and rolling wheels for the generic rank: nothing special but what the description
# says.
#
# An arm or a guide that keeps a wheel at its track does so because the arm turns about the circle's centre,
# or because the guide is parallel to the line. These two coincidences belong to the structure and are kept.

COINCIDE = 1e-9
"""Places closer than this (in the greatest length) are one, directions closer than this (sine) parallel."""


def random_gearing(
    mechanism: Mechanism,
    numbers: Dimensions,
    at: Positions,
    directions: Mapping[str, Vector],
    random: np.random.Generator,
) -> Gearing:
    """Ratios, radii and tracks at random; `at` and `directions` are the random positions and lines of guides."""
    ratio = {
        # away from 0 and from infinity, of either sign: nothing about them is special
        gear.id: float(random.choice([-1.0, 1.0]) * random.uniform(0.3, 3.0))
        for gear in mechanism.gears
    }
    radius = {wheel.id: float(random.uniform(0.2, 0.6)) for wheel in mechanism.rolling}
    track: dict[str, Track] = {}
    for wheel in mechanism.rolling:
        own = numbers.gearing.track[wheel.id]
        # drawn in any case, so that the other random numbers do not depend on the kind of track
        place = float(random.normal()), float(random.normal())
        if isinstance(own, Straight):
            track[wheel.id] = Straight(place, _direction(mechanism, numbers, at, directions, wheel, random))
        else:
            # a track about a point of the body keeps being about it
            named = point_at(numbers, wheel.on, own.centre)
            centre = place if named is None else local_of(at, wheel.on, named)
            track[wheel.id] = Round(centre, float(random.uniform(0.7, 1.5)), own.inside)
    # constants do not enter derivatives
    phase = dict.fromkeys((*ratio, *radius), 0.0)
    return Gearing(ratio, radius, track, phase, numbers.gearing.shares, numbers.gearing.measured)


def point_at(numbers: Dimensions, body: str, local: Vector) -> str | None:
    """The point of a body that lies at local coordinates, if there is one."""
    points = numbers.frame if body == FRAME else numbers.local[body]
    near = COINCIDE * float(numbers.scale)
    for name, (x, y) in points.items():
        if abs(x - local[0]) <= near and abs(y - local[1]) <= near:
            return name
    return None


def local_of(at: Positions, body: str, point: str) -> Vector:
    """Coordinates of a point in the axes of a body."""
    pose = at.poses[body]
    return rotate_vector(subtract(at.points[point], pose.origin), reversed_rotor(pose.rotor))


def _direction(
    mechanism: Mechanism,
    numbers: Dimensions,
    at: Positions,
    directions: Mapping[str, Vector],
    wheel: Rolling,
    random: np.random.Generator,
) -> Vector:
    """Direction of a line in the axes of its body: that of a guide it is parallel to, else a random one."""
    track = numbers.gearing.track[wheel.id]
    assert isinstance(track, Straight)
    for guide in mechanism.guides:
        own = numbers.direction[guide.id]
        if guide.on == wheel.on and parallel(own, track.direction):
            # directions in the body's axes, which the random realisation chose
            return directions[guide.id]
        # the body that carries the track slides on the guide without turning
        seen = rotate_vector(own, reversed_rotor(numbers.turn[guide.id]))
        if guide.link == wheel.on and parallel(seen, track.direction):
            absolute = rotate_vector(directions[guide.id], at.poses[guide.on].rotor)
            return rotate_vector(absolute, reversed_rotor(at.poses[wheel.on].rotor))
    angle = random.uniform(0.0, tau)
    return cos(angle), sin(angle)


def parallel(one: Vector, other: Vector) -> bool:
    """Whether two unit vectors lie in one line."""
    return bool(abs(float(cross(one, other))) <= COINCIDE)


INDEPENDENT = 1e-8
"""A unit row counts as independent if this much of it is left after projection on the rows before it."""

Matrix = npt.NDArray[np.float64]


def columns_of(unknowns: Sequence[Entity]) -> tuple[dict[Entity, int], int]:
    """First column of each unknown in the Jacobian, and the number of columns."""
    first, total = {}, 0
    for entity in unknowns:
        first[entity] = total
        total += entity.unknowns
    return first, total


def jacobian(
    constraints: Iterable[Constraint], unknowns: Sequence[Entity], numbers: Dimensions, at: Positions
) -> Matrix:
    """Jacobian of the constraints at given positions (plain floats): one row an equation, in order."""
    first, total = columns_of(unknowns)
    rows = []
    for constraint in constraints:
        for entries in constraint.rows(numbers, at):
            row = np.zeros(total)
            for entity, values in entries.items():
                if entity in first:
                    row[first[entity] : first[entity] + entity.unknowns] += values
            rows.append(row)
    return np.array(rows).reshape(len(rows), total)


def independent_rows(matrix: Matrix) -> npt.NDArray[np.bool_]:
    """Mask of the rows that are independent of the rows before them (twice-repeated Gram-Schmidt)."""
    count, width = matrix.shape
    # mechanisms without redundancy are the rule: one factorisation answers for all rows
    if all_independent(matrix):
        return np.ones(count, dtype=bool)
    basis = np.zeros((min(count, width), width))
    kept = np.zeros(count, dtype=bool)
    rank = 0
    for i, row in enumerate(matrix):
        norm = np.linalg.norm(row)
        # a zero row, or a full basis: nothing more can be independent
        if norm == 0.0 or rank == width:
            continue
        rest = row / norm
        # once leaves a part of the size of rounding over what is left; twice is enough (Kahan and Parlett)
        for _pass in range(2):
            rest = rest - basis[:rank].T @ (basis[:rank] @ rest)
        size = np.linalg.norm(rest)
        if size > INDEPENDENT:
            basis[rank] = rest / size
            rank += 1
            kept[i] = True
    return kept


def all_independent(matrix: Matrix) -> bool:
    """Whether all rows are independent, by one orthogonalisation: much faster than asking row by row."""
    count, width = matrix.shape
    norms = np.linalg.norm(matrix, axis=1)
    # more rows than columns cannot be independent
    if count > width or not norms.all():
        return False
    # as long as no row is dependent, the diagonal is what Gram-Schmidt leaves of each
    diagonal = np.diagonal(np.linalg.qr((matrix / norms[:, None]).T, mode="r"))
    return bool((np.abs(diagonal) > INDEPENDENT).all())


def random_realisation(mechanism: Mechanism, numbers: Dimensions) -> tuple[Dimensions, Positions]:
    """Random positions, and the lengths that make them fit: the same structure with nothing special about it."""
    # a fixed seed: a mechanism has the same plan every time
    random = np.random.default_rng(1)
    points = {name: _pair(random.normal(size=2)) for name in mechanism.points}
    poses = {FRAME: PlanePose((0.0, 0.0), (1.0, 0.0))}
    for link in mechanism.links:
        angle = random.uniform(0.0, tau)
        poses[link] = PlanePose(_pair(random.normal(size=2)), (cos(angle), sin(angle)))
    at = Positions(points, poses, {drive.id: 0.0 for drive in mechanism.drives})

    def local(body: str, point: str) -> Vector:
        pose = poses[body]
        return rotate_vector(subtract(points[point], pose.origin), reversed_rotor(pose.rotor))

    direction, turn = {}, {}
    for guide in mechanism.guides:
        angle, other = random.uniform(0.0, tau, size=2)
        direction[guide.id] = (cos(angle), sin(angle))
        turn[guide.id] = (cos(other), sin(other))
    fitted = Dimensions(
        {name: points[name] for name in numbers.frame},
        {link: {point: local(link, point) for point in inside} for link, inside in numbers.local.items()},
        # a guide goes through its point's random place, so that the constraint holds
        {guide.id: local(guide.on, guide.point) for guide in mechanism.guides},
        direction,
        turn,
        numbers.bodies,
        gearing=random_gearing(mechanism, numbers, at, direction, random),
    )
    return fitted, at


def _pair(values: Sequence[float] | Matrix) -> Vector:
    return float(values[0]), float(values[1])


def generic_jacobian(
    mechanism: Mechanism,
    constraints: Sequence[Constraint],
    unknowns: Sequence[Entity],
    numbers: Dimensions,
) -> Matrix:
    """Jacobian at the random realisation."""
    fitted, at = random_realisation(mechanism, numbers)
    return jacobian(constraints, unknowns, fitted, at)


def scaled_jacobian(
    constraints: Sequence[Constraint], unknowns: Sequence[Entity], numbers: Dimensions, at: Positions
) -> Matrix:
    """Jacobian at real positions with lengths measured in the mechanism's own scale, so that rank has a threshold.

    Links are moved by shifts of one of their points and turns about it.
    """
    scale = float(numbers.scale)
    matrix = jacobian(constraints, unknowns, numbers, at)
    for entity, column in columns_of(unknowns)[0].items():
        own = slice(column, column + entity.unknowns)
        # columns by motions of the size of the mechanism: with turns in rad beside metres no threshold would
        # fit
        matrix[:, own] = matrix[:, own] @ np.array(_motions(entity, numbers, at, scale)).T
    units = [1.0 if c.angular else scale for c in constraints for _row in range(c.size)]
    return np.asarray(matrix / np.array(units)[:, None])


def _motions(entity: Entity, numbers: Dimensions, at: Positions, scale: float) -> Sequence[Row]:
    """Coordinates of a body's small motions: by the scale, or 1 rad."""
    if entity.kind == "point":
        return (scale, 0.0), (0.0, scale)
    first = next(iter(numbers.local[entity.name]))
    return numbers.space.shifts(ARRAYS, at.points[first], scale)


def rank_of(matrix: Matrix) -> int:
    """Numerical rank: singular values above INDEPENDENT times the greatest."""
    if not matrix.size:
        return 0
    if all_independent(matrix):
        return int(matrix.shape[0])
    values = np.linalg.svd(matrix, compute_uv=False)
    return int(np.sum(values > INDEPENDENT * values[0]))


def residuals_at(
    constraints: Sequence[Constraint], numbers: Dimensions, at: Positions
) -> Mapping[Constraint, float]:
    """Greatest residual of each constraint at given positions [rad, or lengths in units of the greatest length]."""
    scale = float(numbers.scale)
    return {
        c: max(abs(float(r)) for r in c.residual(ARRAYS, numbers, at)) / (1.0 if c.angular else scale)
        for c in constraints
    }


# Links, joints and loops counted, and Chebyshev's formula beside the rank.


@dataclass(frozen=True)
class Count:
    """Chebyshev's count of a planar mechanism (also Gruebler's): 3 n - 2 p5 - p4.

    A point on a guide without a link of its own counts as a slider: one more link, hinged to the point and
    sliding on the guide; a cylinder as barrel and rod, hinged to its points and sliding on each other. A hinge
    of k links counts k - 1 times. Meshing wheels are a higher pair; so is a rolling wheel whose distance from its
    track an arm or a guide keeps. Another rolling wheel leaves one freedom, as a lower pair does, and counts as one.
    """

    moving_links: int
    lower_pairs: int
    higher_pairs: int

    @property
    def mobility(self) -> int:
        """Mobility by the formula; the rank decides where they differ."""
        return 3 * self.moving_links - 2 * self.lower_pairs - self.higher_pairs

    @property
    def loops(self) -> int:
        """Independent closed loops: joints less moving links (Euler)."""
        return self.lower_pairs + self.higher_pairs - self.moving_links


def count(mechanism: Mechanism, redundant: Collection[Constraint] = ()) -> Count:
    """Count links and pairs of a mechanism; `redundant` are the constraints that repeat others."""
    # a point that is shared by k bodies is k - 1 hinges
    members: Counter[str] = Counter(list(mechanism.frame.points))
    for link in mechanism.links.values():
        members.update(list(link.coordinates))
    blocks = [guide for guide in mechanism.guides if is_bare(guide)]
    members.update(guide.point for guide in blocks)
    cylinders = [drive.distance for drive in mechanism.drives if drive.distance]
    for ends in cylinders:
        members.update(ends)
    hinges = sum(number - 1 for number in members.values())
    kept_at_track = {c.rolling for c in redundant if isinstance(c, TrackContact)}
    # where an arm or a guide keeps the distance, the contact is redundant and a pair of another kind
    rolling = sum(wheel.id not in kept_at_track for wheel in mechanism.rolling)
    links = len(mechanism.links) + len(blocks) + 2 * len(cylinders)
    lower = hinges + len(mechanism.guides) + len(cylinders) + rolling
    return Count(links, lower, len(mechanism.gears) + len(mechanism.rolling) - rolling)


def is_bare(guide: Guide) -> bool:
    """Whether a guide has no link of its own, so that a slider is understood."""
    return guide.link is None


def slider_of(guide: Guide) -> str:
    """The link that slides on a guide: its own, or the slider understood at its point."""
    return guide.link if guide.link is not None else _("slider {point}").format(point=guide.id)


# Order from dependence: matching of equations to unknowns, and the groups that must be solved together.
#
# Dulmage-Mendelsohn decomposition of a square structurally regular system: a perfect matching, then the
# strongly connected components of "depends on", dependencies first. Any perfect matching gives the same
# components.

Left = TypeVar("Left", bound=Hashable)
Right = TypeVar("Right", bound=Hashable)
Node = TypeVar("Node", bound=Hashable)


def match(neighbours: Mapping[Left, Sequence[Right]]) -> dict[Right, Left]:
    """Matching of greatest size, right -> left, by augmenting paths (breadth first, no recursion)."""
    owner: dict[Right, Left] = {}
    mate: dict[Left, Right] = {}
    for start in neighbours:
        came_from, free = _augmenting_path(start, neighbours, owner)
        while free is not None:
            left = came_from[free]
            # along the path back to its start every unknown changes its owner: the matching grows by one
            owner[free], mate[left], free = left, free, mate.get(left)
    return owner


def _augmenting_path(
    start: Left, neighbours: Mapping[Left, Sequence[Right]], owner: Mapping[Right, Left]
) -> tuple[dict[Right, Left], Right | None]:
    """Where each right node was reached from, and a free one at the end of a path, if there is one."""
    came_from: dict[Right, Left] = {}
    queue = deque([start])
    while queue:
        left = queue.popleft()
        for right in neighbours[left]:
            if right in came_from:
                continue
            came_from[right] = left
            # a taken unknown may be had if its owner finds another
            if right not in owner:
                return came_from, right
            queue.append(owner[right])
    return came_from, None


def strong_components(depends: Mapping[Node, Sequence[Node]]) -> list[list[Node]]:
    """Strongly connected components (Tarjan, iterative), each in the order of `depends`."""
    index: dict[Node, int] = {}
    low: dict[Node, int] = {}
    on_stack: set[Node] = set()
    stack: list[Node] = []
    # for the order of results
    components: list[list[Node]] = []
    rank = {node: k for k, node in enumerate(depends)}

    for root in depends:
        if root in index:
            continue
        # an explicit stack in place of recursion: linkages may be long
        work = [(root, iter(depends[root]))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on_stack.add(root)
        while work:
            node, rest = work[-1]
            for other in rest:
                if other not in index:
                    index[other] = low[other] = len(index)
                    stack.append(other)
                    on_stack.add(other)
                    work.append((other, iter(depends[other])))
                    break
                # only what is on the stack belongs to the same component
                if other in on_stack:
                    low[node] = min(low[node], index[other])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == index[node]:
                    component: list[Node] = []
                    while not component or component[-1] != node:
                        component.append(stack.pop())
                        on_stack.discard(component[-1])
                    components.append(sorted(component, key=rank.__getitem__))
    return components


def in_order(
    components: Sequence[Sequence[Node]], depends: Mapping[Node, Sequence[Node]]
) -> list[list[Node]]:
    """Components with dependencies first; of those that are ready, the first in the order of `depends`."""
    rank = {node: k for k, node in enumerate(depends)}
    home = {node: k for k, component in enumerate(components) for node in component}
    # the component itself is not waited for
    waits = {
        k: {home[other] for node in component for other in depends[node]} - {k}
        for k, component in enumerate(components)
    }
    followers: dict[int, list[int]] = {k: [] for k in waits}
    for k, before in waits.items():
        for other in before:
            followers[other].append(k)
    first = {k: min(rank[node] for node in component) for k, component in enumerate(components)}
    # a heap by description order: of those that are ready the first, so that a plan reads as the description
    # does
    ready = [(first[k], k) for k, before in waits.items() if not before]
    heapq.heapify(ready)
    ordered = []
    while ready:
        _rank, k = heapq.heappop(ready)
        ordered.append(list(components[k]))
        for follower in followers[k]:
            waits[follower].discard(k)
            if not waits[follower]:
                heapq.heappush(ready, (first[follower], follower))
    return ordered
