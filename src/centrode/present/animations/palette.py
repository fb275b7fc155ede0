"""The colours of a GIF: 256 for all of its frames, so that none flickers."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PIL import Image

COLOURS = 256
EXACT = 64
"""Of these the commonest of all frames are kept as they are: paper stays white."""
HEAVIEST = 16
"""Most that a colour counts for when the others are cut into groups."""
AT_ONCE = 4096
"""Colours whose distances to the palette are held in memory together."""

Packed = NDArray[np.uint32]


class Palette:
    """Counts colours, chooses those to keep, and gives the number of the nearest."""

    def __init__(self) -> None:
        self.parts: list[tuple[Packed, NDArray[np.int64]]] = []
        self.colours: Packed = np.empty(0, dtype=np.uint32)
        self.chosen: NDArray[np.int64] = np.empty((0, 3), dtype=np.int64)
        self.nearest: NDArray[np.uint8] = np.empty(0, dtype=np.uint8)

    def count(self, pixels: Packed) -> None:
        """Take the colours of pixels into account."""
        colours, counts = np.unique(pixels, return_counts=True)
        self.parts.append((colours, counts))

    def choose(self) -> None:
        """Choose the palette: the commonest colours as they are, the others cut into groups at medians."""
        every = np.concatenate([colours for colours, _counts in self.parts])
        self.colours, where = np.unique(every, return_inverse=True)
        counts = np.bincount(where, weights=np.concatenate([counts for _colours, counts in self.parts]))
        order = np.lexsort((self.colours, -counts))
        levels = _levels(self.colours)
        exact, rest = order[:EXACT], order[EXACT:]
        self.chosen = levels[exact]
        if len(rest):
            weights = np.clip(np.sqrt(counts[rest]).astype(int), 1, HEAVIEST)
            sheet = np.repeat(levels[rest], weights, axis=0).astype(np.uint8)
            cut = Image.fromarray(sheet[None]).quantize(COLOURS - EXACT, dither=Image.Dither.NONE)
            found = np.array(cut.getpalette() or [], dtype=np.int64).reshape(-1, 3)[: COLOURS - EXACT]
            self.chosen = np.concatenate([self.chosen, found])
        self.nearest = np.concatenate(
            [self._near(levels[first : first + AT_ONCE]) for first in range(0, len(levels), AT_ONCE)]
        )

    @property
    def table(self) -> list[int]:
        """Red, green and blue of every number."""
        numbers: list[int] = self.chosen.reshape(-1).tolist()
        return numbers

    def numbers(self, pixels: Packed) -> NDArray[np.uint8]:
        """Numbers of the nearest colours."""
        return np.asarray(self.nearest[np.searchsorted(self.colours, pixels)])

    def _near(self, levels: NDArray[np.int64]) -> NDArray[np.uint8]:
        """Numbers of the nearest; squares of whole levels are exact in single precision."""
        own, chosen = levels.astype(np.float32), self.chosen.astype(np.float32)
        apart = (chosen**2).sum(axis=1) - 2.0 * own @ chosen.T  # less what all distances of a colour share
        return np.asarray(np.argmin(apart, axis=1), dtype=np.uint8)


def _levels(colours: Packed) -> NDArray[np.int64]:
    """Red, green and blue (n, 3) of pixels as the canvas packs them."""
    return colours.view(np.uint8).reshape(-1, 4)[:, :3].astype(np.int64)
