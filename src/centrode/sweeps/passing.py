"""How machine code passes samples: each for itself, or along the path where groups of higher class ask for it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.executors import streamer
from centrode.algebra.graphs import Graph
from centrode.algebra.reductions import Reduction, together
from centrode.algebra.scans import Scan
from centrode.kinematics.compiled.path_following import Walking
from centrode.kinematics.compiled.variables import PARAMETER, Pass, greatest, least
from centrode.sweeps.expressed import RESIDUAL, SLACK, Expressed

Array: TypeAlias = npt.NDArray[np.float64]
Values: TypeAlias = Mapping[str, Array]
"""Of mechanisms: name -> (lanes,)."""
Rooms: TypeAlias = Iterable[tuple[slice, Array]]
"""Some mechanisms after the other, and where their samples go: (numbers, lanes, samples)."""


class Passing(Protocol):
    """One way to pass the samples of mechanisms without events."""

    def reduced(self, reduction: Reduction, rows: Values) -> dict[str, Array]:
        """The states when all samples are passed."""

    def written(self, rows: Values, rooms: Rooms) -> dict[str, Array]:
        """Write every sample; returns what mechanisms are judged by."""


def passing_of(asked: Expressed) -> Passing:
    """How the samples of a task are passed."""
    return Along(asked) if asked.traced.steps else EachForItself(asked)


@dataclass(frozen=True)
class EachForItself:
    """Nothing is handed on but what is reduced. Every number that is written is one stream."""

    asked: Expressed

    def reduced(self, reduction: Reduction, rows: Values) -> dict[str, Array]:
        asked = self.asked
        over_samples = Pass(reduction, tuple(rows), asked.inputs)
        # where nothing moves the samples are counted all the same
        return over_samples.run(rows, asked.kernels, asked.threads, steps=asked.samples)

    def written(self, rows: Values, rooms: Rooms) -> dict[str, Array]:
        scan = self._scan
        along = np.stack([self.asked.inputs[name] for name in scan.parameters])
        take = streamer(scan, along, self.asked.kernels, self.asked.threads)
        for part, room in rooms:
            take(np.stack([rows[name][part] for name in scan.inputs]) if scan.inputs else None, room)
        return self.reduced(judging_states(self.asked), rows)

    @cached_property
    def _scan(self) -> Scan:
        """Lanes are samples, steps are mechanisms."""
        outputs = self.asked.outputs
        used = Graph(outputs).variables
        along = tuple(name for name in self.asked.inputs if name in used or name == PARAMETER)
        return Scan(along, tuple(name for name in used if name not in along), outputs)


@dataclass(frozen=True)
class Along:
    """Every place is found from the one before: what is written is judged on the same way."""

    asked: Expressed

    def reduced(self, reduction: Reduction, rows: Values) -> dict[str, Array]:
        asked = self.asked
        return Walking(asked.judging.walk, reduction).reduced(asked.way, rows, asked.kernels, asked.threads)

    def written(self, rows: Values, rooms: Rooms) -> dict[str, Array]:
        asked = self.asked
        walking = Walking(asked.judging.walk, judging_states(asked), asked.outputs)
        parts = []
        for part, room in rooms:
            some = {name: row[part] for name, row in rows.items()}
            parts.append(walking.written(asked.way, some, asked.kernels, asked.threads, room))
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def judging_states(asked: Expressed) -> Reduction:
    """Greatest residual, least slack of radicands; NaN where one is."""
    judges = asked.judges
    parts = [greatest(RESIDUAL, judges[RESIDUAL], 0.0)]
    if SLACK in judges:
        parts.append(least(SLACK, judges[SLACK]))
    return together(*parts)
