"""The labelled result of a sweep: its frame without numbers, and results kept in memory."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.sweeps.asked import PATH, Asked
from centrode.sweeps.blocks import Blocks
from centrode.sweeps.designs import Design
from centrode.sweeps.streams import Columns, columns_for
from centrode.sweeps.tallies import Tally

AnyArray: TypeAlias = npt.NDArray[Any]


class Kept(Protocol):
    """Where the blocks of a sweep go."""

    blocks: Blocks
    tally: Tally

    def has(self, block: int) -> bool:
        """Whether a block is there already."""

    def room(self, block: int) -> Columns:
        """Arrays that the results of a block are written to, before it is put."""

    def put(self, block: int, results: Mapping[str, AnyArray], tally: Tally) -> None:
        """Keep what stands in the room of a block: all of it, or nothing."""


@dataclass(frozen=True)
class Frame:
    """Dimensions, coordinates and attributes of a result; `empty` holds no variables."""

    design: Design
    asked: Asked
    empty: xr.Dataset

    @property
    def mechanisms(self) -> int:
        """How many there are."""
        return math.prod(self.design.shape)

    @property
    def bytes(self) -> int:
        """What the columns take."""
        return self.mechanisms * sum(column.bytes for column in self.asked.columns)

    def room(self, mechanisms: int) -> Columns:
        """Arrays for the columns of some mechanisms, as files have them."""
        return Columns(
            {
                column.name: np.empty((mechanisms, *column.shape), dtype=column.kind)
                for column in self.asked.columns
            }
        )


def frame_of(
    motion: xr.Dataset, design: Design, units: Mapping[str, str], asked: Asked, executor: str
) -> Frame:
    """The frame of a sweep; `motion` is a motion of the mechanism, and gives it words and labels."""
    used = {dimension for column in asked.columns for dimension in column.dimensions}
    labels = [dimension for dimension in motion.dims if dimension in used and dimension in motion.coords]
    coordinates: dict[Any, Any] = {dimension: motion.coords[dimension] for dimension in labels}
    if "sample" in used:
        coordinates |= {
            "time": motion["time"],
            "drive": motion["drive"],
            "drive_value": motion["drive_value"],
        }
    if PATH in used:
        coordinates[PATH] = (PATH, list(design.coordinates))
    for path, (dimension, values) in design.coordinates.items():
        coordinates[path] = ((dimension,), values, {"units": units[path]})
    told = {key: motion.attrs[key] for key in ("title", "mechanism", "version", "mobility")}
    return Frame(
        design,
        asked,
        xr.Dataset(
            coords=coordinates, attrs={**told, "samples": motion.sizes["sample"], "executor": executor}
        ),
    )


class InMemory:
    """A result in arrays; what is not computed is empty."""

    def __init__(self, frame: Frame, blocks: Blocks) -> None:
        self.frame = frame
        self.blocks = blocks
        self.tally = Tally()
        self.arrays = columns_for(frame.asked.columns, frame.mechanisms)

    def has(self, block: int) -> bool:
        return False

    def room(self, block: int) -> Columns:
        return self.arrays.part(slice(*self.blocks.mechanisms(block)))

    def put(self, block: int, results: Mapping[str, AnyArray], tally: Tally) -> None:
        self.tally.add(tally)  # the results stand where they belong

    def leave_the_rest_empty(self) -> None:
        """Leave no part of a block that was being put when an interruption came."""
        for column in self.frame.asked.columns:
            self.arrays[column.name][self.tally.mechanisms :] = column.empty

    def dataset(self) -> xr.Dataset:
        """The labelled result."""
        design = self.frame.design
        variables = {
            column.name: (
                design.dimensions + column.dimensions,
                self.arrays[column.name].reshape(design.shape + column.shape),
                dict(column.attributes),
            )
            for column in self.frame.asked.columns
        }
        return told(self.frame.empty.assign(variables), self.frame, self.tally)


def told(data: xr.Dataset, frame: Frame, tally: Tally) -> xr.Dataset:
    """The result with what it came to in its attributes."""
    data.attrs |= {
        "mechanisms": tally.mechanisms,
        "mechanisms_whole": tally.whole,
        "mechanisms_none": tally.none,
        "worst_residual": tally.worst_residual,
    }
    for column in frame.asked.columns:
        found = tally.extremes.get(column.name)
        if found is None:
            continue
        ends = [(math.nan, math.nan) if pair is None else tuple(pair) for pair in found]
        least, greatest = [end[0] for end in ends], [end[1] for end in ends]
        single = not column.shape
        data[column.name].attrs["least"] = least[0] if single else least
        data[column.name].attrs["greatest"] = greatest[0] if single else greatest
    return data
