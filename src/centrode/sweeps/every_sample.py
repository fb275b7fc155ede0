"""Where every sample of mechanisms without events goes: straight to its place in a result, or by way of a buffer."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.expressions import Node
from centrode.algebra.scans import room_of
from centrode.sweeps import limits
from centrode.sweeps.arrays import NUMBER
from centrode.sweeps.streams import Columns

Array: TypeAlias = npt.NDArray[np.float64]
AnyArray: TypeAlias = npt.NDArray[Any]


@dataclass(frozen=True)
class EverySample:
    """The columns of a result that have every sample.

    Attributes
    ----------
    columns : column -> its numbers
    results : column -> (mechanisms, ...)
    at : the mechanisms among these that are written: a whole slice, or their numbers
    samples : how many there are
    """

    columns: Mapping[str, Sequence[Node]]
    results: Mapping[str, AnyArray]
    at: Any
    samples: int

    def rooms(self) -> Iterator[tuple[slice, Array]]:
        """Mechanisms and where their samples go, (numbers, lanes, samples); filled before the next is asked for."""
        streams = self.results.streams if isinstance(self.results, Columns) else None
        if streams is not None and isinstance(self.at, slice):
            yield slice(0, streams.shape[1]), streams
            return
        numbers = sum(map(len, self.columns.values()))
        places = np.arange(len(self.results["samples_ok"]))[self.at]
        size = max(1, limits.KERNEL_BUFFER // (NUMBER * numbers * self.samples))
        buffer = room_of(numbers, min(size, len(places)), self.samples)
        for first in range(0, len(places), size):
            where = places[first : first + size]
            room = buffer[:, : len(where)]
            yield slice(first, first + size), room
            self._put(room, where)

    def _put(self, room: Array, where: npt.NDArray[np.intp]) -> None:
        stream = iter(room)
        for name, nodes in self.columns.items():
            target = self.results[name].reshape(*self.results[name].shape[:2], len(nodes))
            for k in range(len(nodes)):
                target[where, :, k] = next(stream)
