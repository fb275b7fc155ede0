"""Columns of a result in memory: what is kept of every sample stands there number by number, as it is computed.

A number of a mechanism is one stream of its samples. The result's arrays are views that have the samples in front of
the numbers; nothing is put in another order. Samples of mechanisms without events go straight to their place in a
result, or by way of a buffer.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.locale import _
from centrode.numerics.expressions import Node
from centrode.numerics.rooms import check_room, fresh_room, is_blank
from centrode.numerics.scans import LINE, room_of
from centrode.sweeps import designs
from centrode.sweeps.arrays import NUMBER
from centrode.sweeps.outputs import SweepColumn

Array: TypeAlias = npt.NDArray[np.float64]
AnyArray: TypeAlias = npt.NDArray[Any]


class StreamedColumns(dict[str, AnyArray]):
    """Arrays of some mechanisms by name: (mechanisms, ...).

    `streams` is what is kept of every sample, in the order of the columns, where it stands like that in memory:
    (numbers, mechanisms, samples). `blank` says that it is all zeros, which take no pages until they are written to.
    """

    streams: npt.NDArray[np.float64] | None = None
    blank: bool = False

    def part(self, rows: slice) -> StreamedColumns:
        """A view of some mechanisms."""
        chosen = StreamedColumns({name: array[rows] for name, array in self.items()})
        chosen.streams = None if self.streams is None else self.streams[:, rows]
        chosen.blank = self.blank
        return chosen


def streamed_columns(columns: Sequence[SweepColumn]) -> list[SweepColumn]:
    """The columns that have a float64 of every sample."""
    return [column for column in columns if column.at_samples and column.kind == np.float64]


def columns_for(
    columns: Sequence[SweepColumn], mechanisms: int, out: npt.NDArray[np.float64] | None = None
) -> StreamedColumns:
    """Memory for columns, with streams where there is any: fresh, or that of `out`.

    Raises InputError where `out` has too little room, or is no array that numbers can be written to.
    """
    kept = streamed_columns(columns)
    streamed = StreamedColumns(
        # what has no sample dimension is an array of its own, in the order of the result
        {x.name: np.empty((mechanisms, *x.shape), dtype=x.kind) for x in columns if x not in kept}
    )
    if out is not None:
        numbers = mechanisms * sum(math.prod(column.shape) for column in kept)
        if not numbers:
            what = _("nothing is kept of every sample")
            raise InputError("out", what, _("omit it, or request outputs that are not reduced"))
        check_room(out, numbers)
    if kept:
        counts = [math.prod(column.shape[1:]) for column in kept]
        streamed.streams, streamed.blank = _streams((sum(counts), mechanisms, kept[0].shape[0]), out)
        first = 0
        for column, count in zip(kept, counts, strict=True):
            streams = streamed.streams[first : first + count].reshape(
                *column.shape[1:], *streamed.streams.shape[1:]
            )
            # a view with mechanisms and samples in front: nothing is copied
            streamed[column.name] = np.moveaxis(streams, (-2, -1), (0, 1))
            first += count
    return streamed


def _streams(
    shape: tuple[int, int, int], out: npt.NDArray[np.float64] | None
) -> tuple[npt.NDArray[np.float64], bool]:
    """Room for streams, and whether it is blank; fresh memory begins where a line of the cache does."""
    numbers = math.prod(shape)
    if out is not None:
        return out.reshape(-1)[:numbers].reshape(shape), False
    spare = LINE // NUMBER
    whole, blank = fresh_room(numbers + spare)
    first = (-whole.ctypes.data % LINE) // NUMBER
    return whole[first : first + numbers].reshape(shape), blank


HUGE_PAGE = (1 << 21) // NUMBER
"""Numbers on a huge page of most processors."""


@dataclass(frozen=True)
class EverySample:
    """The columns of a result that have every sample.

    Attributes
    ----------
    columns : column -> its numbers
    results : column -> (mechanisms, ...)
    at : the mechanisms among these that are written: a whole slice, or their numbers
    samples : how many there are
    fixed : place among all numbers -> number of every sample, which is not filled into rooms
    """

    columns: Mapping[str, Sequence[Node]]
    results: Mapping[str, AnyArray]
    at: Any
    samples: int
    fixed: Mapping[int, float]

    def rooms(self) -> Iterator[tuple[slice, Array]]:
        """Mechanisms and where their samples go, (numbers, lanes, samples); filled before the next is requested."""
        results = self.results
        streams, blank = (
            (results.streams, results.blank) if isinstance(results, StreamedColumns) else (None, False)
        )
        # a whole slice has its place in the result, and is written straight there
        if streams is not None and isinstance(self.at, slice):
            for place, number in self.fixed.items():
                if not (blank and is_blank(number)):
                    streams[place] = number
            for place in range(len(streams)):
                # huge pages that are cleared one stream after the other are cleared faster than in turns
                if blank and place not in self.fixed:
                    streams[place].reshape(-1)[::HUGE_PAGE] = 0.0
            yield slice(0, streams.shape[1]), streams
            return
        numbers = sum(map(len, self.columns.values()))
        places = np.arange(len(self.results["samples_ok"]))[self.at]
        size = max(1, designs.KERNEL_BUFFER // (NUMBER * numbers * self.samples))
        buffer = room_of(numbers, min(size, len(places)), self.samples)
        # as many mechanisms as the buffer holds, which stays in the cache
        for first in range(0, len(places), size):
            where = places[first : first + size]
            room = buffer[:, : len(where)]
            yield slice(first, first + size), room
            self._put(room, where)

    def _put(self, room: Array, where: npt.NDArray[np.intp]) -> None:
        place = 0
        for name, nodes in self.columns.items():
            target = self.results[name].reshape(*self.results[name].shape[:2], len(nodes))
            for k in range(len(nodes)):
                # number by number, as streams come; the target has them side by side
                target[where, :, k] = self.fixed.get(place, room[place])
                place += 1
