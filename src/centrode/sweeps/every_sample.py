"""Every sample of mechanisms without events, written by machine code."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.executors import runner
from centrode.algebra.expressions import Node
from centrode.algebra.graphs import Graph
from centrode.algebra.scans import Scan, room_of
from centrode.kinematics.compiled.variables import PARAMETER
from centrode.sweeps import limits
from centrode.sweeps.expressed import Expressed

Array: TypeAlias = npt.NDArray[np.float64]
AnyArray: TypeAlias = npt.NDArray[Any]
Values: TypeAlias = Mapping[str, Array]

NUMBER = 8
"""Bytes of a float64."""


@dataclass(frozen=True)
class EverySample:
    """Kernels whose lanes are samples and whose steps are mechanisms: every number is written as one stream."""

    asked: Expressed
    kernels: str
    threads: int

    @cached_property
    def scan(self) -> Scan:
        """What is asked for."""
        outputs: dict[str, Node] = {}
        for name, nodes in self.asked.columns.items():
            outputs |= {f"{name} {k}": node for k, node in enumerate(nodes)}
        used = Graph(outputs).variables
        along = tuple(name for name in self.asked.inputs if name in used or name == PARAMETER)
        return Scan(along, tuple(name for name in used if name not in along), outputs)

    @property
    def samples(self) -> int:
        """How many there are."""
        return len(self.asked.task.span.parameter)

    def write(self, rows: Values, streams: Array) -> None:
        """Fill (numbers, mechanisms, samples)."""
        scan, lanes = self.scan, streams.shape[1]
        along = np.stack([self.asked.inputs[name] for name in scan.parameters])
        inputs = np.stack([rows[name] for name in scan.inputs]) if scan.inputs else None
        run = runner(scan, self.kernels, lanes_inside=True, threads=self.threads)
        run(along, inputs, out=streams, steps=lanes)

    def put(self, rows: Values, places: npt.NDArray[np.intp], results: Mapping[str, AnyArray]) -> None:
        """Fill the columns of mechanisms at some places by way of a buffer."""
        size = max(1, limits.KERNEL_BUFFER // (NUMBER * len(self.scan.outputs) * self.samples))
        buffer = room_of(len(self.scan.outputs), min(size, len(places)), self.samples)
        for first in range(0, len(places), size):
            part = slice(first, first + size)
            where = places[part]
            out = buffer[:, : len(where)]
            self.write({name: row[part] for name, row in rows.items()}, out)
            stream = iter(out)
            for name, nodes in self.asked.columns.items():
                target = results[name].reshape(*results[name].shape[:2], len(nodes))
                for k in range(len(nodes)):
                    target[where, :, k] = next(stream)
