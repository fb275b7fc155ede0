"""Motions written by machine code: every number of a `Solved` is one stream of the samples of each mechanism."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.machine_code.trace import Traced
from centrode.kinematics.machine_code.variables import PARAMETER, box_array
from centrode.kinematics.solve import Solved
from centrode.numerics.executors import runner
from centrode.numerics.expressions import Node, as_node
from centrode.numerics.graphs import Graph, topological_order
from centrode.numerics.machine_code.loops import FUNCTIONS
from centrode.numerics.operations import CONSTANT, VARIABLE
from centrode.numerics.rooms import fresh_room, is_blank
from centrode.numerics.scans import LaneExtreme, Scan

Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]

ORDERED = frozenset({"all_points", "angles", "slides", "spins", "attitudes"})
"""Arrays with the derivatives in front."""
ROOMS = ("all_points", "angles", "slides", "spins", "attitudes", "contacts", "residual")
SINES, RESIDUAL, JUDGED = "sines", "residual", "judged"
LAST_BITS = (RESIDUAL, JUDGED)
"""Of what is written: what may hang on the last bit of a residual, though no decision does."""


def nodes_of(plan: Traced) -> dict[str, Nodes]:
    """Arrays of a Solved of one lane and one sample; cosines stand where angles will, their sines beside them.

    Walks know the turns of angles, so these are written at once.
    """
    solved = plan.solved
    outputs: dict[str, Nodes | None] = {name: getattr(solved, name) for name in ROOMS}
    if not plan.steps:
        # the arc tangent of these is taken afterwards, on NumPy
        angles: Nodes = solved.angles.copy()
        for k, link in enumerate(solved.layout.angles):
            if link in plan.turning:
                angles[0, 0, 0, k] = plan.turning[link][0]
        outputs["angles"] = angles
        outputs[SINES] = box_array([sine for _cosine, sine in plan.turning.values()]).reshape(1, 1, -1)
    return {name: nodes for name, nodes in outputs.items() if nodes is not None}


@dataclass(frozen=True)
class Writer:
    """Writer of arrays of nodes, each of one lane and one sample, for many mechanisms.

    Attributes
    ----------
    outputs : name -> nodes
    places : what the variables of a place on the path stand for: name -> (n,)
    kernels : what runs scans, see `numerics.executors`
    memory : what `same_room` hands out, in its first place; writers that do not write at once may share it
    sparing : numbers that are the same everywhere, as those of fixed points, are put into a room once and not written
    judged : name -> extreme over the places of each mechanism
    """

    outputs: Mapping[str, Nodes]
    places: Mapping[str, Array]
    kernels: str
    threads: int = 1
    memory: list[Array] = field(default_factory=list)
    sparing: bool = False
    judged: Mapping[str, LaneExtreme] = field(default_factory=dict)

    @cached_property
    def flat(self) -> list[Node]:
        """All nodes, in the order in which they are written."""
        return [as_node(x) for nodes in self.outputs.values() for x in nodes.ravel()]

    @cached_property
    def graph(self) -> Graph:
        """All nodes, each called by its place."""
        return Graph({str(k): node for k, node in enumerate(self.flat)})

    @cached_property
    def fixed_places(self) -> dict[int, float]:
        """Place among all numbers -> what stands there everywhere, and is not written."""
        nodes = enumerate(self.flat if self.sparing else ())
        return {k: float(node.detail) for k, node in nodes if node.operation == CONSTANT}

    @cached_property
    def scan(self) -> Scan:
        """Lanes are places, steps are mechanisms."""
        written = [k for k in range(len(self.flat)) if k not in self.fixed_places]
        outputs = {str(k): self.flat[k] for k in written}
        used = Graph({**outputs, **{name: x.value for name, x in self.judged.items()}}).variables
        along = tuple(name for name in self.places if name in used or name == PARAMETER)
        of_mechanisms = tuple(name for name in used if name not in along)
        places = tuple(written) if self.fixed_places else ()
        return Scan(along, of_mechanisms, outputs, extremes=self.judged, places=places)

    @cached_property
    def alike(self) -> bool:
        """Whether every number is rounded as the arrays round it: no function is left to the kernel.

        Residuals are not asked: an arc tangent in them moves their last bit, and decides nothing.
        """
        asked = [
            as_node(x) for name, nodes in self.outputs.items() if name not in LAST_BITS for x in nodes.ravel()
        ]
        kinds: dict[Node, frozenset[bool]] = {}
        for node in topological_order(asked):
            own = {str(node.detail) in self.places} if node.operation == VARIABLE else set()
            kinds[node] = frozenset(own).union(*(kinds[x] for x in node.arguments))
            # what depends on places alone, or on mechanisms alone, is computed on NumPy
            # a function of both a place and a mechanism is left to the kernel, which rounds it otherwise
            if node.operation in FUNCTIONS and len(kinds[node]) > 1:
                return False
        return True

    @cached_property
    def _along(self) -> Array:
        return np.stack([self.places[name] for name in self.scan.parameters])

    def room(self, lanes: int, out: Array | None = None) -> Array:
        """Memory for what is written for so many mechanisms, fresh or that of `out`: (numbers, lanes, n)."""
        shape = (len(self.flat), lanes, len(self.places[PARAMETER]))
        numbers = math.prod(shape)
        whole, blank = fresh_room(numbers) if out is None else (out.reshape(-1)[:numbers], False)
        room = whole.reshape(shape)
        for place, number in self.fixed_places.items():
            if not (blank and is_blank(number)):
                room[place] = number
        return room

    def same_room(self, lanes: int) -> Array:
        """Memory (numbers, lanes, n) that every call uses again, which is faster: the last call's numbers are lost."""
        shape = (len(self.flat), lanes, len(self.places[PARAMETER]))
        size = math.prod(shape)
        # it grows and never shrinks: the longest batch comes first as a rule
        if not self.memory or self.memory[0].size < size:
            self.memory[:] = [np.empty(size)]
        return self.memory[0][:size].reshape(shape)

    def write(self, values: Mapping[str, Array], room: Array) -> dict[str, Array]:
        """Fill a room from what variables stand for in its mechanisms; returns what these are judged by."""
        scan = self.scan
        of_lanes = np.stack([values[name] for name in scan.inputs]) if scan.inputs else None
        run = runner(scan, self.kernels, lanes_inside=True, threads=self.threads)
        found = run(self._along, of_lanes, out=room, steps=room.shape[1])
        return dict(zip(self.judged, found.extremes, strict=True))

    def streams(self, room: Array) -> dict[str, Array]:
        """Outputs by name, as views of the room: (numbers, lanes, n)."""
        streams, first = {}, 0
        for name, nodes in self.outputs.items():
            streams[name] = room[first : first + nodes.size]
            first += nodes.size
        return streams

    def views(self, room: Array) -> dict[str, Array]:
        """Outputs by name, as views of the room with the shapes of a `Solved`: (..., lanes, samples, ...)."""
        return {
            name: _shape_numbers(name, stream, self.outputs[name].shape)
            for name, stream in self.streams(room).items()
        }


def _shape_numbers(name: str, room: Array, shape: tuple[int, ...]) -> Array:
    """Numbers (numbers, lanes, samples) as an array of a shape that has one lane and one sample."""
    lane = 1 if name in ORDERED else 0
    whole = room.reshape(*shape[:lane], *shape[lane + 2 :], *room.shape[1:])
    return np.moveaxis(whole, (-2, -1), (lane, lane + 1))


def streams_of(name: str, array: Array) -> Array:
    """An array of a Solved with its mechanisms and samples behind everything else."""
    lane = 1 if name in ORDERED else 0
    return np.moveaxis(array, (lane, lane + 1), (-2, -1))


def solved_of(plan: Solved, found: Mapping[str, Array], status: npt.NDArray[np.int8], **whole: Any) -> Solved:
    """The motion of a plan of one sample with what was written; `whole` are its parts that are no arrays."""
    points = found["all_points"]
    # the frame's points come first among all points
    frame = plan.all_points.shape[3] - plan.points.shape[3]
    return replace(
        plan,
        all_points=points,
        points=points[:, :, :, frame:],
        angles=found["angles"],
        slides=found["slides"],
        spins=found.get("spins"),
        attitudes=found.get("attitudes"),
        status=status,
        residual=found["residual"],
        contacts=found["contacts"],
        **whole,
    )
