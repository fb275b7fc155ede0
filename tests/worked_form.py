"""The worked mechanism's equations (2.5) to (2.8) written by hand, as the source prints them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
L1, L2, L3, L4 = 0.5, 1.0, 1.2, 0.8


@dataclass(frozen=True)
class Worked:
    """phi2, phi3, phi4 of the slider between two cranks."""

    start: tuple[float, float, float]

    @property
    def initial(self) -> Array:
        return np.array(self.start)

    @property
    def sizes(self) -> Array:
        return np.ones(3)

    def rates(self, time: npt.ArrayLike, state: Array) -> Array:
        two, three, four = np.moveaxis(state, -1, 0)
        common = np.sin(time - two) / (np.cos(two) * np.sin(three - four))
        return np.stack(
            [
                -L1 / L2 * np.cos(time) / np.cos(two),
                -L1 / L3 * np.cos(four) * common,
                L1 / L4 * np.cos(three) * common,
            ],
            axis=-1,
        )

    def left(self, time: npt.ArrayLike, state: Array) -> Array:
        two, three, four = np.moveaxis(state, -1, 0)
        height = L1 * np.sin(time) + L2 * np.sin(two)
        across = L1 * np.cos(time) + L2 * np.cos(two) + L3 * np.cos(three) + L4 * np.cos(four)
        up = height + L3 * np.sin(three) + L4 * np.sin(four)
        return np.stack([height, across, up], axis=-1)

    def constraints(self, time: npt.ArrayLike, state: Array) -> Array:
        return (self.left(time, state) - self.left(0.0, self.initial)) / L3
