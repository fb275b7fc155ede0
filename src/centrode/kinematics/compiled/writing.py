"""Motions written by machine code: every number of a `Solved` is one stream of the samples of each mechanism."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.executors import runner
from centrode.algebra.expressions import Node, as_node
from centrode.algebra.graphs import Graph
from centrode.algebra.scans import Scan
from centrode.kinematics.compiled.traced import Traced
from centrode.kinematics.compiled.variables import PARAMETER, boxed, inputs_of
from centrode.kinematics.spans import Span

Array: TypeAlias = npt.NDArray[np.float64]
Nodes: TypeAlias = npt.NDArray[Any]

ORDERED = frozenset({"all_points", "angles", "slides", "spins"})
"""Arrays with the derivatives in front."""
ROOMS = ("all_points", "angles", "slides", "spins", "contacts", "residual")
SINES = "sines"


def nodes_of(plan: Traced) -> dict[str, Nodes]:
    """Arrays of a Solved of one lane and one sample; cosines stand where angles will, their sines beside them."""
    solved = plan.solved
    angles: Nodes = solved.angles.copy()
    for k, link in enumerate(solved.layout.angles):
        if link in plan.turning:
            angles[0, 0, 0, k] = plan.turning[link][0]
    found: dict[str, Nodes | None] = {name: getattr(solved, name) for name in ROOMS}
    found["angles"] = angles
    found[SINES] = boxed([sine for _cosine, sine in plan.turning.values()]).reshape(1, 1, -1)
    return {name: nodes for name, nodes in found.items() if nodes is not None}


@dataclass(frozen=True)
class Writer:
    """What writes arrays of nodes, each of one lane and one sample, for many mechanisms."""

    outputs: Mapping[str, Nodes]
    span: Span
    kernels: str
    threads: int = 1

    @cached_property
    def flat(self) -> list[Node]:
        """All nodes, in the order in which they are written."""
        return [as_node(x) for nodes in self.outputs.values() for x in nodes.ravel()]

    @cached_property
    def scan(self) -> Scan:
        """Lanes are samples, steps are mechanisms."""
        graph = Graph({str(k): node for k, node in enumerate(self.flat)})
        inputs = inputs_of(self.span)
        along = tuple(name for name in inputs if name in graph.variables or name == PARAMETER)
        return Scan(along, tuple(name for name in graph.variables if name not in along), graph.outputs)

    @cached_property
    def _of_samples(self) -> Array:
        inputs = inputs_of(self.span)
        return np.stack([inputs[name] for name in self.scan.parameters])

    def room(self, lanes: int) -> Array:
        """What is written for so many mechanisms: (numbers, lanes, samples)."""
        return np.empty((len(self.flat), lanes, len(self.span.parameter)))

    def write(self, values: Mapping[str, Array], room: Array) -> None:
        """Fill a room from what variables stand for in its mechanisms."""
        scan = self.scan
        of_lanes = np.stack([values[name] for name in scan.inputs]) if scan.inputs else None
        run = runner(scan, self.kernels, lanes_inside=True, threads=self.threads)
        run(self._of_samples, of_lanes, out=room, steps=room.shape[1])

    def placed(self, room: Array) -> dict[str, Array]:
        """The arrays by name, views of the room."""
        found, first = {}, 0
        for name, nodes in self.outputs.items():
            found[name] = _placed(name, room[first : first + nodes.size], nodes.shape)
            first += nodes.size
        return found


def _placed(name: str, room: Array, shape: tuple[int, ...]) -> Array:
    """Numbers (numbers, lanes, samples) as an array of a shape that has one lane and one sample."""
    lane = 1 if name in ORDERED else 0
    whole = room.reshape(*shape[:lane], *shape[lane + 2 :], *room.shape[1:])
    return np.moveaxis(whole, (-2, -1), (lane, lane + 1))
