"""Motions with limits and change points: the mesh of the search and most samples as machine code.

The bits are those of `solve`. Signs take the change points as numbers of the mechanism; a sample is open where
a radicand lies below zero by more than rounding. What is left to the arrays are the samples that hang on
rounding and those on power series: they are computed one by one, and put into their places (`patches`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.kinematics.angular_velocity import NodeTurns, angle_and_rates, node_turns
from centrode.kinematics.change_points import BranchedPlan, inside
from centrode.kinematics.events import EventScan
from centrode.kinematics.machine_code.bends import bends_of
from centrode.kinematics.machine_code.outputs import (
    JUDGED,
    ORDERED,
    ROOMS,
    SINES,
    Writer,
    nodes_of,
    solved_of,
)
from centrode.kinematics.machine_code.trace import Traced, trace_motion
from centrode.kinematics.machine_code.variables import (
    PARAMETER,
    TURN,
    Varied,
    box_array,
    centre_of,
    inputs_of,
    places_of,
    take_lanes,
)
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import SampleGrid, nearest_node
from centrode.kinematics.plan_evaluation import Branches, positions_from, rotor_of_angle
from centrode.kinematics.preparation import Ready
from centrode.kinematics.quick_turns import QuickTurns
from centrode.kinematics.samples import (
    CLOSED,
    ORDERS,
    SUSPECT,
    ResultArrays,
    Samples,
    beyond_limits,
    contacts_at,
    open_what_does_not_close,
    residuals,
    sample,
    settle,
    start_of,
)
from centrode.kinematics.solve import Solved, fit_for, lanes_at_once, of_batch, of_lanes, solve
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.bends import Bent, Cells
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.jets import Jet
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

# Single samples of a batch as the arrays compute them, put into their places among those of machine code.

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Patches:
    """Computes samples of the mechanisms of a batch whose events are known.

    `plan` is a motion of one sample whose arrays hold nodes: angles that stand are numbers there. `turns` are those, on
    the mesh, of the links that turn and whose turns the plan does not give.
    """

    continuation: BranchedPlan
    span: SampleGrid
    plan: Solved
    turns: Mapping[str, NodeTurns]
    mesh: Array

    def put(
        self, lanes: Lanes, places: Lanes, found: Mapping[str, Array], status: npt.NDArray[np.int8]
    ) -> Lanes:
        """Put samples, one of each of these mechanisms, into the arrays of all; returns those that do not close."""
        arrays, status[lanes, places], broken = self._compute_samples(lanes, places)
        for name in ROOMS:
            if name in found:
                if name in ORDERED:
                    found[name][:, lanes, places] = arrays[name][:, :, 0]
                else:
                    found[name][lanes, places] = arrays[name][:, 0]
        return lanes[broken]

    def _compute_samples(
        self, lanes: Lanes, places: Lanes
    ) -> tuple[dict[str, Array], npt.NDArray[np.int8], Mask]:
        """The samples as motions (k, 1) of one sample each."""
        parameter = self.span.parameter[places]
        kinematics = of_lanes(self.continuation.kinematics, lanes)
        room = ResultArrays.of(self.plan.layout, kinematics.numbers, len(lanes), 1)
        samples = room.samples
        single = Samples(
            # samples of many mechanisms, one of each, in the shape that `sample` takes
            self.plan.layout,
            samples.columns[..., 0],
            samples.angles[..., 0],
            samples.status[:, 0],
            samples.followed,
        )
        sample(self.continuation, parameter, single, lanes)
        settle(single)
        self._fill_angles(samples, lanes, parameter)
        at = positions_from(
            kinematics, self.plan.layout, samples.columns[0], samples.angles[0], parameter[:, None]
        )
        residual, _worst = residuals(kinematics, samples, at)
        with np.errstate(invalid="ignore"):
            broken = residual[:, 0] > CLOSED
        open_what_does_not_close(samples, residual)
        contacts = contacts_at(kinematics, at, samples)
        room.fill_frame(kinematics.numbers)
        arrays = {
            "all_points": room.all_points,
            "angles": room.all_angles,
            "slides": room.slides,
            "contacts": contacts,
            "residual": residual,
        }
        if room.spins is not None and room.attitudes is not None:
            arrays["spins"], arrays["attitudes"] = room.spins, room.attitudes
        return arrays, room.status[:, 0], broken

    def _fill_angles(self, samples: Samples, lanes: Lanes, parameter: Array) -> None:
        nearest = nearest_node(self.mesh, parameter)
        for link, nodes in self.turns.items():
            rotor = samples.columns[:, self.plan.layout.rotor(link)]
            cosine, sine = rotor[0, :, :, 0]
            turns = nodes.at_single(lanes, nearest, cosine, sine, parameter)
            angle = self.plan.layout.angles.index(link)
            angle_and_rates(rotor, turns[:, None], samples.angles[:, angle])
        for angle, link in enumerate(self.plan.layout.angles):
            if link not in self.turns and link not in samples.followed:
                # NaN of an open sample times zero is NaN, so that a link that stands is absent there too
                samples.angles[:, angle] = 0.0 * samples.columns[:, self.plan.layout.rotor(link).start]
                samples.angles[0, angle] += self.plan.angles[0, 0, 0, angle]


# Signs that flip at change points, as expressions: the places of the change points are numbers of the
# mechanism.

MOST = 16
"""Change points of a group that a sign knows at most: each costs a comparison or two at every sample."""


def signs_of(ready: Ready, crossings: Mapping[int, int]) -> dict[int, Operand]:
    """The sign of each group at a parameter, as `Branches.sign` has it, with so many change points."""
    initial = ready.kinematics.path.initial
    signs = ready.assembled.signs
    return {group: _sign(group, sign, initial, crossings.get(group, 0)) for group, sign in signs.items()}


def _sign(group: int, sign: float, initial: float, count: int) -> Operand:
    m, branch = EXPRESSIONS, sign
    if not count:
        return sign
    # a sign flips for a sample if the change point lies between the initial position and the sample
    low, high = m.min(variable(PARAMETER), initial), m.max(variable(PARAMETER), initial)
    for k in range(count):
        at = variable(crossing_of(group, k))
        # a change point that is not there is NaN, and lies nowhere between
        between = m.both(m.less(low, at), m.less(at, high))
        branch = m.where(between, -branch, branch)  # type: ignore[assignment]
    return branch


def crossing_of(group: int, k: int) -> str:
    """Name of the place of a change point of a group."""
    return f"change point {k} of {group}"


def counts_of(branches: Branches) -> dict[int, int]:
    """Group -> number of change points that its signs hold: the next power of two, so that kernels are few."""
    # where assemblies are kept, signs never flip
    if not branches.smooth:
        return {}
    # every count is a kernel of its own: rounded up to powers of two there are few
    return {group: 1 << (table.shape[1] - 1).bit_length() for group, table in branches.crossings.items()}


def values_of(branches: Branches, counts: Mapping[int, int]) -> dict[str, Array]:
    """The places of the change points: name -> (lanes,), NaN where there is none."""
    values = {}
    for group, count in counts.items():
        table = branches.crossings[group]
        for k in range(count):
            known = table[:, k] if k < table.shape[1] else np.full(branches.lanes, np.nan)
            values[crossing_of(group, k)] = known
    return values


# The search for events on a mesh that machine code has filled: what is found, and its bits, are those of
# `events`.
#
# All radicands are computed at once with constant signs. Where a group has change points, those of the groups
# behind it are computed again with its signs, and at the nodes next to its change points, which power
# series give, by the arrays.

Nodes: TypeAlias = npt.NDArray[Any]
Writers: TypeAlias = Callable[[Mapping[int, int]], tuple[Traced, Writer]]
"""From how many change points the signs of groups know: the plan, and what writes the mesh."""


def of_mesh(plan: Traced) -> dict[str, Nodes]:
    """Outputs on the mesh: radicands and divisors with slopes and bends, cosines and sines of angles."""
    nodes = {f"radicand {group}": _pair(x) for group, x in plan.radicands.items()}
    nodes |= {f"divisor {group}": _pair(x) for group, x in plan.divisors.items() if isinstance(x, Jet)}
    for (kind, group), bent in plan.bends.items():
        if f"{kind} {group}" in nodes:
            nodes[f"bend of {kind} {group}"] = box_array([bent.bend])
    return nodes | {f"rotor {link}": box_array(rotor) for link, rotor in plan.turning.items()}


def _angle_of(link: str, numbers: Dimensions, at: Positions) -> Any:
    cosine, sine = rotor_of_angle(ARRAYS, numbers, at, link)
    return np.arctan2(sine, cosine)


def _pair(number: Any) -> Nodes:
    return box_array(number.coefficients[:2] if isinstance(number, Jet) else (number, 0.0))


@dataclass
class EventSearch:
    """The search for the events of some mechanisms of a batch.

    Attributes
    ----------
    values : what the variables of the plan stand for: name -> (lanes,)
    """

    continuation: BranchedPlan
    mesh: Array
    values: Mapping[str, Array]
    writers: Writers
    _counts: dict[int, int] = field(default_factory=dict)
    _found: dict[str, Array] = field(default_factory=dict)

    def run(self) -> bool:
        """Record all events in the branches; whether that was possible."""
        scan = EventScan(self.continuation, self.mesh)
        self._write()
        plan, _writer = self.writers(self._counts)
        # in the order of the plan: a change point of a group changes the signs on which the groups behind it
        # stand
        for group in sorted({*plan.radicands, *plan.divisors}):
            for kind, find in (("radicand", scan.find), ("divisor", scan.find_poles)):
                if f"{kind} {group}" in self._found:
                    # the search of the group before may have found change points: then this group is looked
                    # at with the new signs
                    if not self._up_to_date():
                        return False
                    bend = self._found.get(f"bend of {kind} {group}")
                    find(group, self._with_patches(scan, group, self._found[f"{kind} {group}"], bend))
        # the last group may have found some too
        return self._up_to_date()

    def turns(self, link: str, initial: float) -> NodeTurns:
        """Turns of a link's angle along the mesh; `initial` [rad] is its value in the initial position."""
        cosine, sine = self._found[f"rotor {link}"]
        if len(self._repaired_nodes[0]):
            # on a power series the kernel's rotor is the root of a rounded difference; the arrays have the
            # right one
            cosine[self._repaired_nodes], sine[self._repaired_nodes] = self._rotors_mended[link]
        start = int(np.argmin(np.abs(self.mesh - self.continuation.branches.initial)))
        quick = self._quick.measure(partial(_angle_of, link))
        return node_turns((cosine, sine), initial, start, len(self.mesh), quick)

    @cached_property
    def _quick(self) -> QuickTurns:
        groups = self.continuation.kinematics.structure.groups
        return QuickTurns(self.continuation, self.mesh, len(groups))

    def _write(self) -> None:
        _plan, writer = self.writers(self._counts)
        branches = self.continuation.branches
        room = writer.same_room(branches.lanes)
        writer.write({**self.values, **values_of(branches, self._counts)}, room)
        self._found = writer.streams(room)

    def _up_to_date(self) -> bool:
        """Compute the mesh again if change points were found since; whether signs can know so many."""
        counts = counts_of(self.continuation.branches)
        if max(counts.values(), default=0) > MOST:
            return False
        if counts != self._counts:
            self._counts = counts
            self._write()
        return True

    def _with_patches(self, scan: EventScan, group: int, pair: Array, bend: Array | None) -> Jet:
        """Value and slope of a radicand or divisor, those of the arrays where a series gives a group before it."""
        lanes, nodes = self._near_change_points(range(group))
        if bend is None:
            if len(lanes):
                guard = scan.guards.jets(group, lanes, self.mesh[nodes], 1)
                pair[:, lanes, nodes] = guard.value, guard.derivative(1)
            return Jet((pair[0], pair[1]))
        if len(lanes):
            half = np.broadcast_to(scan.zeros.half, self.mesh.shape)[nodes]
            patched = scan.guards.bend_bound(group, lanes, self.mesh[nodes], half)
            pair[:, lanes, nodes], bend[0, lanes, nodes] = patched[:2], patched[2]
        return Bent(pair[0], pair[1], bend[0], Cells(scan.zeros.half, ARRAYS))

    def _near_change_points(self, groups: range) -> tuple[Lanes, Lanes]:
        """Mechanisms and nodes that lie next to change points of some groups, each once."""
        near = np.zeros((self.continuation.branches.lanes, len(self.mesh)), dtype=bool)
        for group in groups:
            windows = self.continuation.windows_of(group)
            if windows is not None:
                near[inside(windows, self.mesh, None)[0]] = True
        lanes, nodes = np.nonzero(near)
        return lanes, nodes

    @cached_property
    def _repaired_nodes(self) -> tuple[Lanes, Lanes]:
        return self._near_change_points(range(len(self.continuation.kinematics.structure.groups)))

    @cached_property
    def _rotors_mended(self) -> dict[str, tuple[Any, Any]]:
        """Rotors where a series gives any group, as the arrays have them."""
        lanes, nodes = self._repaired_nodes
        parameter = self.mesh[nodes]
        kinematics = self.continuation.kinematics.take(lanes)
        with np.errstate(all="ignore"):
            at = kinematics.positions(ARRAYS, parameter, self.continuation.hooks(ARRAYS, parameter, lanes))
            plan, _writer = self.writers(self._counts)
            return {link: rotor_of_angle(ARRAYS, kinematics.numbers, at, link) for link in plan.turning}


m = EXPRESSIONS
FINE, OPEN, DOUBTFUL = 0.0, 1.0, 2.0
"""What machine code says of a sample: doubtful are those that hang on rounding, or are not finite."""
NEARLY = 1e-3
"""Residuals that lie this close to the greatest that counts as closed are left to the arrays."""
AT_ONCE = 2
"""How many times as many mechanisms are computed together as by arrays."""


@dataclass(frozen=True)
class Eventful:
    """Computes motions that have events.

    Attributes
    ----------
    varied : the numbers of the batch as variables
    plan : the same with constant signs
    kernels : what runs scans, see `numerics.executors`
    unclosed : filled with mechanisms that have a sample which does not close
    """

    ready: Ready
    span: SampleGrid
    varied: Varied
    plan: Traced
    kernels: str
    threads: int = 1
    unclosed: set[int] = field(default_factory=set)
    _writers: dict[tuple[tuple[int, int], ...], tuple[Traced, Writer, Writer]] = field(default_factory=dict)
    _memory: tuple[list[Array], list[Array]] = field(default_factory=lambda: ([], []))

    def solve_lanes(self, numbers: Dimensions, lanes: Lanes) -> Iterator[tuple[Lanes, Solved]]:
        """The motions of some mechanisms of a batch, part by part; arrays stay as they are until the next part."""
        ready = fit_for(self.ready, self.span)
        kinematics = of_batch(ready.kinematics, numbers)
        values = self.varied.values(numbers)
        size = AT_ONCE * lanes_at_once(kinematics, self.span)
        for first in range(0, len(lanes), size):
            some = lanes[first : first + size]
            continuation = start_of(ready, of_lanes(kinematics, some), len(some))
            of_some = {name: row[some] for name, row in values.items()}
            search = EventSearch(continuation, self.mesh, of_some, lambda counts: self._writer(counts)[:2])
            if search.run():
                yield some, self._part(search, some)
            else:
                self.unclosed.update(some.tolist())  # nobody has looked
                yield some, solve(self.ready, self.span, take_lanes(numbers, some), len(some))

    @cached_property
    def possible(self) -> bool:
        """Whether the bits will be those of the arrays: where the plan leaves no function to a kernel.

        Groups of higher class, whose places hang on one another, are not for this; nor are residuals of gears that
        compare angles with their turns, which are counted only when all is written.
        """
        writers = self._writer({})[1:]
        if self.plan.steps or not all(writer.alike for writer in writers):
            return False
        centres = {centre_of(link) for link in self.plan.turning}
        return not any(centres.intersection(writer.graph.variables) for writer in writers)

    @cached_property
    def mesh(self) -> Array:
        """The nodes on which events are looked for."""
        return mesh_of(fit_for(self.ready, self.span).kinematics.path, self.span.parameter)

    def _part(self, search: EventSearch, some: Lanes) -> Solved:
        continuation = search.continuation
        branches = continuation.branches
        counts = counts_of(branches)
        plan, _of_mesh, writer = self._writer(counts)
        room = writer.same_room(branches.lanes)
        values = {**search.values, **values_of(branches, counts)}
        values |= {largest_of(group): largest for group, largest in branches.largest.items()}
        writer.write(values, room)
        arrays = writer.views(room)
        turns = self._turns(plan, search, arrays)
        status, doubtful = self._judge_samples(continuation, arrays[JUDGED], arrays["residual"])
        # samples that do not close although no radicand says so: their numbers go, as the arrays take theirs
        # out
        broken = (status == Status.OPEN) & (arrays[JUDGED] != OPEN)
        if broken.any():
            self.unclosed.update(some[broken.any(axis=1)].tolist())
            for name in ROOMS:
                if name in arrays:
                    arrays[name][(slice(None), broken) if name in ORDERED else broken] = np.nan
        lanes, places = np.nonzero(doubtful)
        if len(lanes):
            patches = Patches(continuation, self.span, plan.solved, turns, self.mesh)
            self.unclosed.update(some[patches.put(lanes, places, arrays, status)].tolist())
        return solved_of(plan.solved, arrays, status, ready=self.ready, span=self.span, branches=branches)

    def _writer(self, counts: Mapping[int, int]) -> tuple[Traced, Writer, Writer]:
        key = tuple(sorted(counts.items()))
        if key not in self._writers:
            signs = signs_of(self.ready, counts)
            plan = trace_motion(self.ready, self.span, self.varied, signs) if counts else self.plan
            nodes = plan
            # a radicand that does not move is a number on the mesh and a jet of zero derivatives at samples:
            # quotients by what depends on it are rounded in two ways, as in the arrays
            if not all(isinstance(radicand, Jet) for radicand in plan.radicands.values()):
                nodes = trace_motion(self.ready, self.span, self.varied, signs, on_mesh=True)
            path = self.ready.kinematics.path
            mesh = places_of(path, self.mesh, ORDERS - 1) | bends_of(path, self.mesh)
            samples = inputs_of(path, self.span)
            self._writers[key] = (
                plan,
                Writer(of_mesh(nodes), mesh, self.kernels, self.threads, self._memory[0]),
                Writer(_outputs(plan), samples, self.kernels, self.threads, self._memory[1]),
            )
        return self._writers[key]

    def _turns(self, plan: Traced, search: EventSearch, found: dict[str, Array]) -> dict[str, NodeTurns]:
        """Put angles with their turns where their cosines stand; returns their turns on the mesh."""
        layout, nearest = plan.solved.layout, nearest_node(self.mesh, self.span.parameter)
        known = {}
        for k, link in enumerate(plan.turning):
            known[link] = nodes = search.turns(link, self.ready.assembled.angles[link])
            angle, sine = found["angles"][0, :, :, layout.angles.index(link)], found[SINES][:, :, k]
            turns = nodes.at(nearest, angle, sine, self.span.parameter)
            np.arctan2(sine, angle, out=angle)
            if turns.any():
                angle += TURN * turns
        return known

    def _judge_samples(self, continuation: BranchedPlan, judged: Array, residual: Array) -> tuple[Any, Mask]:
        """Statuses of the samples, and which of them the arrays have to look at."""
        status = np.full(judged.shape, Status.OK, dtype=np.int8)
        status[beyond_limits(continuation.branches, self.span.parameter)] = Status.CUT_OFF
        with np.errstate(invalid="ignore"):
            status[(judged == OPEN) | (residual > CLOSED)] = Status.OPEN
            # the kernel's residual may differ in its last bits, so those beside the bound are decided by the
            # arrays
            doubtful = (judged == DOUBTFUL) | (np.abs(residual - CLOSED) <= NEARLY * CLOSED)
        for group in continuation.branches.largest:
            windows = continuation.windows_of(group)
            if windows is not None:
                # next to a change point a power series takes the place of the formula
                doubtful[inside(windows, self.span.parameter, None)[0]] = True
        return status, doubtful


def largest_of(group: int) -> str:
    """Name of the greatest radicand of a group on the mesh."""
    return f"greatest {group}"


def _outputs(plan: Traced) -> dict[str, Nodes]:
    """Outputs at a sample: the motion, NaN where a group is open, and the judgement of the sample."""
    outputs = nodes_of(plan)
    lowest: Operand | None = None
    near: Node | None = None
    for group, radicand in plan.radicands.items():
        value = radicand.value if isinstance(radicand, Jet) else radicand
        lowest = value if lowest is None else m.least(lowest, value)
        close = m.less_equal(m.abs(value), SUSPECT * variable(largest_of(group)))
        near = close if near is None else m.either(near, close)
    total: Operand = 0.0
    for nodes in outputs.values():
        for node in nodes.ravel():
            total = total + node
    # zero times a finite number is zero; times infinity or NaN it is NaN: one comparison looks at all numbers
    judged: Operand = m.where(m.equal(as_node(total) * 0.0, 0.0), FINE, DOUBTFUL)
    if lowest is not None and near is not None:
        opened = m.less(lowest, 0.0)
        # near zero first: there the sign of a radicand is not to be trusted
        judged = m.where(near, DOUBTFUL, m.where(opened, OPEN, judged))
        outputs = {
            name: box_array([m.where(opened, np.nan, node) for node in nodes.ravel()]).reshape(nodes.shape)
            for name, nodes in outputs.items()
        }
    return {**outputs, JUDGED: box_array([judged]).reshape(1, 1)}
