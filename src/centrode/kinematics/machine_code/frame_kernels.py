"""One mechanism after the other: judged on the mesh and written at its samples by kernels whose lanes are places.

Kernels of a batch have mechanisms in their lanes, and of one mechanism would fill a vector with copies. Here the lanes
are the nodes of the mesh, then the samples; what is reduced over them is reduced by NumPy. What is judged, and what
is written, are the same expressions as in a batch (`event_free_mechanisms`, `outputs`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.machine_code.event_free_mechanisms import (
    SLACK,
    EventScreening,
    mesh_places,
    sparse_nodes,
)
from centrode.kinematics.machine_code.trace import Traced
from centrode.kinematics.machine_code.variables import (
    AWAY,
    MOST,
    PARAMETER,
    SCALE,
    TURN,
    Varied,
    box_array,
    centre_of,
    inputs_of,
    places_of,
    whole_turns,
    winding_of,
)
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.motion import by_time, kinds_of
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.preparation import Ready
from centrode.kinematics.samples import CLOSED, ORDERS
from centrode.kinematics.solve import Solved
from centrode.numerics.executors import streamer
from centrode.numerics.expressions import EXPRESSIONS, FOLDED, Node, as_node
from centrode.numerics.graphs import Graph
from centrode.numerics.operations import VARIABLE
from centrode.numerics.scans import FUNCTIONS, Reduction, Scan, evaluate, room_of
from centrode.structure.gearing import Straight

Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]
Known: TypeAlias = dict[str, float]
"""Variable of a plan -> its number, of one mechanism."""

RESIDUAL, COSINES, SINES, SLACK_AT_SAMPLES = "residual", "cosines", "sines", "slack at samples"
CONTACT = "contact"
COEFFICIENTS = ("velocity_coefficient", "acceleration_coefficient")
LEAST, GREATEST = "minimum", "maximum"


# From the numbers at free paths to the variables of a plan.


@dataclass(frozen=True)
class FreeNumbers:
    """What the variables of a plan are of the numbers at free paths.

    Attributes
    ----------
    copied : variable -> which of the numbers it is
    turned : variable -> which of the numbers is the angle that it is the cosine or sine of, and which of these
    scale : the greatest length by the paths, where it varies
    """

    paths: tuple[str, ...]
    copied: Mapping[str, int]
    turned: Mapping[str, tuple[int, str]]
    scale: Graph | None

    @classmethod
    def of(cls, paths: Sequence[str], varied: Varied) -> FreeNumbers | None:
        """The rule of a plan's variables; None where one of them follows from the numbers in another way."""
        copied = {path: k for k, path in enumerate(paths) if path in varied.names}
        turned: dict[str, tuple[int, str]] = {}
        for path, direction in _directions(varied).items():
            if path in paths:
                for node, function in zip(direction, ("cos", "sin"), strict=True):
                    turned[str(node.detail)] = paths.index(path), function
        if set(varied.names) - copied.keys() - turned.keys():
            return None
        scale = None if isinstance(varied.scale, float) else Graph.of({SCALE: varied.numbers.scale})
        return cls(tuple(paths), copied, turned, scale)

    def known(self, given: Sequence[float]) -> Known:
        """The variables of a mechanism whose numbers at the paths are `given`."""
        known = {name: given[k] for name, k in self.copied.items()}
        for name, (k, function) in self.turned.items():
            known[name] = float(FUNCTIONS[function](given[k]))
        if self.scale is not None:
            known[SCALE] = self._scale(known)
        return known

    @cached_property
    def _scale(self) -> Callable[[Known], float]:
        assert self.scale is not None
        return scalar_function(self.scale, SCALE)


def _directions(varied: Varied) -> dict[str, tuple[Any, ...]]:
    """Path -> cosine and sine of a direction, where these are variables."""
    found = {f"guides.{guide}.direction": x for guide, x in varied.numbers.direction.items()}
    for wheel, track in varied.numbers.gearing.track.items():
        if isinstance(track, Straight):
            found[f"rolling.{wheel}.along.direction"] = track.direction
    return {path: x for path, x in found.items() if all(isinstance(y, Node) for y in x)}


def scalar_function(graph: Graph, output: str) -> Callable[[Known], float]:
    """One output of a small graph as a function of plain numbers, rounded as on arrays."""
    # it is called at every move: variables and constants come first, and are no steps
    leaves = [node for node in graph.order if not node.arguments]
    inner = [node for node in graph.order if node.arguments]
    places = {node: k for k, node in enumerate(leaves + inner)}
    names = [(k, str(node.detail)) for k, node in enumerate(leaves) if node.operation == VARIABLE]
    start: list[Any] = [node.detail for node in leaves]
    steps = [
        (
            # what is rounded correctly everywhere takes a tenth of the time on plain numbers
            FOLDED.get(node.operation) or FUNCTIONS[node.operation],
            [places[x] for x in node.arguments],
            len(node.arguments),
        )
        for node in inner
    ]
    end = places[graph.outputs[output]]

    def run(known: Known) -> float:
        numbers = start.copy()
        for k, name in names:
            numbers[k] = known[name]
        for function, at, count in steps:
            if count == 2:
                numbers.append(function(numbers[at[0]], numbers[at[1]]))
            else:
                numbers.append(function(*[numbers[k] for k in at]))
        return float(numbers[end])

    return run


# Scans whose lanes are places, called with one mechanism at a time.


def place_scan(outputs: Mapping[str, Node], places: Mapping[str, Array]) -> Scan:
    """The scan of outputs at places: what is no variable of a place is one of the mechanism."""
    used = Graph(outputs).variables
    # the parameter stays in any case: something has to say how many places there are
    along = tuple(name for name in places if name in used or name == PARAMETER)
    return Scan(along, tuple(name for name in used if name not in along), outputs)


@dataclass(frozen=True)
class PlaceScan:
    """A scan whose lanes are places.

    Attributes
    ----------
    names : variables of a mechanism
    count : number of outputs
    take : fills a room with the outputs, see `numerics.executors.streamer`
    places : how many there are
    """

    names: tuple[str, ...]
    count: int
    take: Callable[..., Array]
    places: int

    @classmethod
    def of(cls, scan: Scan, places: Mapping[str, Array], executor: str) -> PlaceScan:
        """The scan at places: name -> (places,)."""
        along = rows_along(scan.parameters, places)
        # somebody waits for the first frame, and kernels take a tenth of a move
        take = streamer(scan, along, executor, hasty=True)
        return cls(scan.inputs, len(scan.outputs), take, along.shape[1])

    def room(self) -> Array:
        """Memory for the outputs: (outputs, 1, places)."""
        return room_of(self.count, 1, self.places)

    def fill(self, known: Mapping[str, float], room: Array) -> bool:
        """Fill a room with the outputs of a mechanism; whether these are certain."""
        if self.count:
            self.take(np.array([[known[name]] for name in self.names]) if self.names else None, room)
        return True


def rows_along(names: Sequence[str], places: Mapping[str, Array]) -> Array:
    """The named variables at places: (names, places)."""
    return np.stack([places[name] for name in names])


# Whether a mechanism is clear, by what its radicands and divisors are at the nodes of the mesh.


@dataclass(frozen=True)
class MeshLayout:
    """Rows of what is judged at the nodes: numbers of which the least counts, the greatest; and links that turn."""

    least: tuple[str, ...]
    greatest: tuple[str, ...]
    links: tuple[str, ...]

    @property
    def divisors(self) -> tuple[tuple[int, int], ...]:
        """Places of the least and of the greatest of each divisor that has no bound of its bend."""
        return tuple(
            (self.least.index(name), self.greatest.index(f"most {name.removeprefix('least ')}"))
            for name in self.least
            if name != SLACK
        )


def mesh_outputs(reduction: Reduction, traced: Traced) -> tuple[MeshLayout, dict[str, Node]]:
    """What is judged at a node: what a reduction over the mesh compares."""
    folds: dict[str, dict[str, Node]] = {LEAST: {}, GREATEST: {}}
    for name, node in reduction.state.items():
        # greatest and least of all nodes: what is compared with the value so far
        value, _so_far = node.arguments
        folds[node.operation][name] = value
    outputs = {f"least, {name}": node for name, node in folds[LEAST].items()}
    outputs |= {f"greatest, {name}": node for name, node in folds[GREATEST].items()}
    return MeshLayout(tuple(folds[LEAST]), tuple(folds[GREATEST]), tuple(traced.turning)), outputs


def sparse_outputs(traced: Traced) -> dict[str, Node]:
    """Angles of links that turn, without their turns."""
    return {
        f"angle {link}": as_node(EXPRESSIONS.atan2(sine, cosine))
        for link, (cosine, sine) in traced.turning.items()
    }


@dataclass(frozen=True)
class MeshJudge:
    """Judge of one mechanism at a time on the mesh of events.

    Attributes
    ----------
    scan : at the nodes
    turning : angles of links at the sparse nodes
    drives : values of the drives with which links may turn at the sparse nodes, (drives, k)
    at_start : angles of the links in the initial position of the description, (links,)
    """

    layout: MeshLayout
    scan: PlaceScan
    turning: PlaceScan
    start: int
    winders: tuple[str, ...]
    drives: Array
    at_start: Array

    def judge(self, known: Known, memory: FrameMemory) -> Known | None:
        """Further variables of a mechanism that is clear; None of another."""
        layout, room = self.layout, memory.mesh
        self.scan.fill(known, room)
        first, then = len(layout.least), len(layout.least) + len(layout.greatest)
        least = room[:first, 0].min(axis=1).tolist() if first else []
        # NaN fails the comparisons: what is not known is not clear
        if SLACK in layout.least and not least[layout.least.index(SLACK)] > 0.0:
            return None
        greatest = room[first:then, 0].max(axis=1).tolist() if then > first else []
        for low, high in layout.divisors:
            if not (least[low] > 0.0 or greatest[high] < 0.0):
                return None
        further: Known = dict(zip(layout.greatest, greatest, strict=True))
        if layout.links:
            self.turning.fill(known, memory.sparse)
            if not self.centre(memory):
                return None
            for k, link in enumerate(layout.links):
                further[centre_of(link)] = memory.centres[k]
                for j, drive in enumerate(self.winders):
                    further[winding_of(link, drive)] = memory.windings[k, j]
        return further

    def centre(self, memory: FrameMemory) -> bool:
        """Find where the angles of links stand; False where one does not stay near enough to a centre."""
        count, raw = len(self.layout.links), memory.sparse[:, 0].copy()
        jumps = raw[:, 1:] - raw[:, :-1]
        steps = np.rint(jumps * (-1.0 / TURN))
        if steps.any():
            jumps += TURN * steps
            raw[:, 1:] += TURN * np.cumsum(steps, axis=1)
        jump = np.abs(jumps).max(axis=1) if jumps.shape[1] else np.zeros(count)
        off = self.at_start - raw[:, self.start]
        whole = np.rint(off * (1.0 / TURN))
        off -= TURN * whole
        if not (jump.max() < MOST and np.abs(off).max() < math.pi - AWAY):
            return False
        # the windings that did the last time do as a rule
        half, middle = self._about(raw, memory.windings)
        if not (half + jump).max() < math.pi - AWAY:
            memory.windings[:] = self._windings(raw)
            half, middle = self._about(raw, memory.windings)
            if not (half + jump).max() < math.pi - AWAY:
                return False
        memory.centres[:] = middle + TURN * whole
        return True

    def _about(self, angles: Array, windings: Array) -> tuple[Array, Array]:
        """Half the range of each angle, the drives' turns taken off, and its middle."""
        rest = angles - windings @ self.drives
        high, low = rest.max(axis=1), rest.min(axis=1)
        return 0.5 * (high - low), 0.5 * (high + low)

    def _windings(self, angles: Array) -> Array:
        """The windings, of each link those that leave the least range: (links, drives)."""
        drives = len(self.winders)
        kinds = [np.zeros(drives), *(sense * row for row in np.eye(drives) for sense in (1.0, -1.0))]
        ranges = [self._about(angles, np.broadcast_to(kind, (len(angles), drives)))[0] for kind in kinds]
        # NaN, of an angle without value, must not win
        best = np.argmin(np.nan_to_num(np.stack(ranges), nan=np.inf), axis=0)
        chosen: Array = np.stack(kinds)[best]
        return chosen


# What is written at every sample.


@dataclass(frozen=True)
class RoomQuantity:
    """Quantity of a motion: rows of a room, and what each sample has of it."""

    name: str
    first: int
    shape: tuple[int, ...]

    @property
    def rows(self) -> slice:
        """Its rows."""
        return slice(self.first, self.first + math.prod(self.shape))


def quantities_of(solved: Solved) -> dict[str, Any]:
    """Quantities of a motion by name, (lanes, samples, ...): by time, by the drive, and where wheels touch."""
    found: dict[str, Any] = {}
    for kind in kinds_of(solved):
        for order, name in enumerate(kind.names):
            values = by_time(kind.orders, order, solved.span)
            if values is not None:
                found[name] = values
        if not solved.ready.kinematics.path.by_time:
            for order, word in enumerate(COEFFICIENTS, 1):
                found[f"{kind.prefix}{word}"] = kind.orders[order]
    if solved.ready.mechanism.rolling:
        found[CONTACT] = solved.contacts
    return found


def frame_outputs(
    traced: Traced, slack: Node | None
) -> tuple[tuple[RoomQuantity, ...], tuple[int, ...], list[Node]]:
    """Quantities with their rows, rows of the angles whose turns are found, and the node of every row."""
    nodes = {
        name: np.asarray(values, dtype=object)[0, 0] for name, values in quantities_of(traced.solved).items()
    }
    name, angle = angles_of(traced.solved)
    turning = [k for k, link in enumerate(traced.solved.layout.angles) if link in traced.turning]
    if not traced.steps:
        # the arc tangent is NumPy's, as in `batch`: so angles have the bits of `solve`
        angle = angle.copy()
        angle[turning] = 0.0
        rotors = [traced.turning[traced.solved.layout.angles[k]] for k in turning]
        nodes[COSINES] = box_array([cosine for cosine, _sine in rotors])
        nodes[SINES] = box_array([sine for _cosine, sine in rotors])
    nodes[name] = angle
    nodes[RESIDUAL] = np.asarray(traced.solved.residual, dtype=object)[0, 0]
    if slack is not None:
        nodes[SLACK_AT_SAMPLES] = box_array([slack])[0]
    quantities: list[RoomQuantity] = []
    rows: list[Node] = []
    known: dict[tuple[Node, ...], int] = {}
    for label, values in nodes.items():
        flat = tuple(as_node(x) for x in np.ravel(values))
        # derivatives by the drive are those by time where it runs at one unit a second: they are written once
        first = known.setdefault(flat, len(rows))
        if first == len(rows):
            rows += flat
        quantities.append(RoomQuantity(label, first, np.shape(values)))
    angles = next(quantity for quantity in quantities if quantity.name == name)
    return tuple(quantities), tuple(angles.first + k for k in turning), rows


def angles_of(solved: Solved) -> tuple[str, Nodes]:
    """Name and values of the angles of a motion of one sample: (angles,)."""
    name = "angle" if solved.spins is None else "joint_angle"
    return name, np.asarray(solved.angles, dtype=object)[0, 0, 0]


class FrameMemory:
    """Memory of one thread: what the last mechanism was."""

    def __init__(self, kernels: FrameKernels) -> None:
        judge, write = kernels.judge, kernels.write
        self.mesh, self.sparse = judge.scan.room(), judge.turning.room()
        self.windings = np.zeros((len(judge.layout.links), len(judge.winders)))
        self.centres = np.zeros(len(judge.layout.links))
        self.room = write.room()
        self.quantities = {
            quantity.name: room_view(self.room, quantity)
            for quantity in kernels.quantities
            if quantity.name not in (COSINES, SINES, SLACK_AT_SAMPLES)
        }
        self.rows = {quantity.name: self.room[quantity.rows, 0] for quantity in kernels.quantities}


def room_view(room: Array, quantity: RoomQuantity) -> Array:
    """A quantity as a view of its room that cannot be written to: (samples, ...)."""
    rows = room[quantity.rows, 0]
    view = np.moveaxis(rows.reshape(*quantity.shape, rows.shape[-1]), -1, 0)
    view.flags.writeable = False
    return view


@dataclass(frozen=True)
class FrameKernels:
    """What moves one mechanism of a plan without groups of higher class.

    Attributes
    ----------
    quantities : what is written, with its rows
    angles : rows of the angles whose turns are found
    drives : values of the drives with which links may turn at the samples, (drives, samples)
    """

    judge: MeshJudge
    write: PlaceScan
    quantities: tuple[RoomQuantity, ...]
    angles: tuple[int, ...]
    drives: Array

    @property
    def scans(self) -> tuple[PlaceScan, PlaceScan, PlaceScan]:
        """What is computed at the nodes, at the sparse ones, and at the samples."""
        return self.judge.scan, self.judge.turning, self.write

    def memory(self) -> FrameMemory:
        """Memory for one thread."""
        return FrameMemory(self)

    def move(self, known: Known, memory: FrameMemory) -> bool:
        """Write the motion of a mechanism; False, with nothing to rely on, where it is not clear."""
        further = self.judge.judge(known, memory)
        if further is None:
            return False
        self.write.fill({**known, **further}, memory.room)
        rows = memory.rows
        if not closes(
            rows[RESIDUAL].max(), rows[SLACK_AT_SAMPLES].min() if SLACK_AT_SAMPLES in rows else None
        ):
            return False
        if self.angles:
            angle = np.arctan2(rows[SINES], rows[COSINES])
            middle = memory.centres[:, None] + memory.windings @ self.drives
            angle += TURN * whole_turns(middle, angle)
            memory.room[list(self.angles), 0] = angle
        return True


def closes(residual: float, slack: float | None) -> bool:
    """Whether samples with this greatest residual and least slack of radicands are clear; NaN is not."""
    # a kernel may round a residual otherwise: half of the bound is kept free, and what lies in it goes to the arrays
    return bool(residual <= 0.5 * CLOSED) and (slack is None or bool(slack > 0.0))


@dataclass(frozen=True)
class FrameLayout:
    """What a trace leaves behind besides its two scans: plain names and numbers."""

    mesh: MeshLayout
    winders: Graph
    quantities: tuple[RoomQuantity, ...]
    angles: tuple[int, ...]


@dataclass(frozen=True)
class FrameScans:
    """The scans of a plan at the nodes of the mesh and at the samples, and what their rows are."""

    layout: FrameLayout
    mesh: Scan
    sparse: Scan
    samples: Scan

    @property
    def all(self) -> tuple[Scan, Scan, Scan]:
        """The scans in the order of `FramePlaces.all`."""
        return self.mesh, self.sparse, self.samples


@dataclass(frozen=True)
class FramePlaces:
    """Nodes of the mesh, the sparse ones, and samples: name of a variable of a place -> (places,)."""

    mesh: Mapping[str, Array]
    sparse: Mapping[str, Array]
    samples: Mapping[str, Array]

    @property
    def all(self) -> tuple[Mapping[str, Array], Mapping[str, Array], Mapping[str, Array]]:
        """All places in their order."""
        return self.mesh, self.sparse, self.samples


def frame_places(ready: Ready, span: SampleGrid) -> FramePlaces:
    """The places of a mechanism."""
    path = ready.kinematics.path
    nodes = mesh_of(path, span.parameter)
    sparse, _start = sparse_nodes(nodes, path.initial)
    return FramePlaces(
        mesh_places(path, nodes), places_of(path, nodes[sparse], ORDERS - 1), sample_places(ready, span)
    )


def frame_scans(screening: EventScreening, places: FramePlaces, scale: Graph | None) -> FrameScans:
    """The scans of a traced plan without groups of higher class; `scale` is the greatest length, if it varies."""
    traced = screening.traced
    mesh, on_mesh = mesh_outputs(screening.over_mesh[0], traced)
    quantities, angles, rows = frame_outputs(traced, screening.slack_at_samples)
    layout = FrameLayout(mesh, Graph.of(traced.winders), quantities, angles)
    written = {str(k): node for k, node in enumerate(rows)}
    outputs = [on_mesh, sparse_outputs(traced), written]
    if scale is not None:
        # computed with the rest: to have it beforehand takes as long as a kernel
        outputs = [dict(Graph(x).substitute(scale.outputs).outputs) for x in outputs]
    return FrameScans(layout, *(place_scan(x, at) for x, at in zip(outputs, places.all, strict=True)))


def sample_places(ready: Ready, span: SampleGrid) -> dict[str, Array]:
    """Values of the variables of a place at the samples."""
    return inputs_of(ready.kinematics.path, span)


def frame_kernels(
    ready: Ready, span: SampleGrid, layout: FrameLayout, scans: Sequence[PlaceScan]
) -> FrameKernels:
    """The kernels of a plan, with what they need of the mechanism."""
    path = ready.kinematics.path
    nodes = mesh_of(path, span.parameter)
    sparse, start = sparse_nodes(nodes, path.initial)
    winders = tuple(layout.winders.outputs)

    def drives(places: Mapping[str, Array], count: int) -> Array:
        values = evaluate(layout.winders, places)
        return np.array([np.broadcast_to(values[drive], (count,)) for drive in winders]).reshape(
            len(winders), count
        )

    mesh, turning, samples = scans
    judge = MeshJudge(
        layout.mesh,
        mesh,
        turning,
        int(np.searchsorted(sparse, start)),
        winders,
        drives(places_of(path, nodes[sparse], ORDERS - 1), len(sparse)),
        np.array([ready.assembled.angles[link] for link in layout.mesh.links]),
    )
    at_samples = drives(sample_places(ready, span), len(span.parameter))
    return FrameKernels(judge, samples, layout.quantities, layout.angles, at_samples)
