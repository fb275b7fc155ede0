"""The blocks of a sweep: runs of mechanisms that are computed, kept and marked as done together."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class Blocks:
    """Blocks of a grid of a shape, its last dimension running fastest.

    A block is a run of mechanisms in that order and at the same time a box of the grid (all of the dimensions
    behind `axis`, at most `step` along it), so that it is one chunk of a stored array.
    """

    shape: tuple[int, ...]
    axis: int
    step: int

    @classmethod
    def of(cls, shape: tuple[int, ...], most: int) -> Blocks:
        """Blocks as great as they may be: at most `most` mechanisms."""
        axis, inner = len(shape) - 1, 1
        while axis > 0 and inner * shape[axis] <= most:
            inner *= shape[axis]
            axis -= 1
        pieces = math.ceil(shape[axis] / max(1, most // inner))
        return cls(shape, axis, math.ceil(shape[axis] / pieces))

    @property
    def chunk(self) -> tuple[int, ...]:
        """Extent of a whole block along each dimension."""
        return (*[1] * self.axis, self.step, *self.shape[self.axis + 1 :])

    @property
    def pieces(self) -> int:
        """Blocks along `axis`."""
        return math.ceil(self.shape[self.axis] / self.step)

    def __len__(self) -> int:
        return math.prod(self.shape[: self.axis]) * self.pieces

    def __iter__(self) -> Iterator[int]:
        return iter(range(len(self)))

    def mechanisms(self, block: int) -> tuple[int, int]:
        """First mechanism of a block, and the one behind its last."""
        outer, piece = divmod(block, self.pieces)
        inner = math.prod(self.shape[self.axis + 1 :])
        first = (outer * self.shape[self.axis] + piece * self.step) * inner
        end = (outer * self.shape[self.axis] + min((piece + 1) * self.step, self.shape[self.axis])) * inner
        return first, end

    def region(self, block: int) -> tuple[slice, ...]:
        """Where a block stands in an array of the shape."""
        outer, piece = divmod(block, self.pieces)
        places: list[slice] = []
        for extent in reversed(self.shape[: self.axis]):
            outer, place = divmod(outer, extent)
            places.insert(0, slice(place, place + 1))
        along = slice(piece * self.step, min((piece + 1) * self.step, self.shape[self.axis]))
        return (*places, along, *[slice(0, extent) for extent in self.shape[self.axis + 1 :]])
