"""The arrays of a result in memory: what is kept of every sample stands there number by number, as it is computed.

A number of a mechanism is one stream of its samples. The result's arrays are views that have the samples in front
of the numbers; nothing is put in another order.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.sweeps.asked import Column

AnyArray: TypeAlias = npt.NDArray[Any]


class Columns(dict[str, AnyArray]):
    """Arrays of some mechanisms by name: (mechanisms, ...).

    `streams` is what is kept of every sample, in the order of the columns, where it stands like that in memory:
    (numbers, mechanisms, samples).
    """

    streams: npt.NDArray[np.float64] | None = None

    def part(self, rows: slice) -> Columns:
        """A view of some mechanisms."""
        found = Columns({name: array[rows] for name, array in self.items()})
        found.streams = None if self.streams is None else self.streams[:, rows]
        return found


def streamed(columns: Sequence[Column]) -> list[Column]:
    """The columns that have a float64 of every sample."""
    return [
        column for column in columns if column.dimensions[:1] == ("sample",) and column.kind == np.float64
    ]


def columns_for(columns: Sequence[Column], mechanisms: int) -> Columns:
    """Fresh memory for columns, with streams where there is any."""
    kept = streamed(columns)
    found = Columns(
        {x.name: np.empty((mechanisms, *x.shape), dtype=x.kind) for x in columns if x not in kept}
    )
    if kept:
        numbers = [math.prod(column.shape[1:]) for column in kept]
        found.streams = np.empty((sum(numbers), mechanisms, kept[0].shape[0]))
        first = 0
        for column, count in zip(kept, numbers, strict=True):
            streams = found.streams[first : first + count].reshape(
                *column.shape[1:], *found.streams.shape[1:]
            )
            found[column.name] = np.moveaxis(streams, (-2, -1), (0, 1))
            first += count
    return found
