"""Samples of ranges of any length: the values of any run of mechanisms, made from the seed alone.

A Sobol point is the exclusive or of the direction numbers that its place names in Gray code, so any of them costs the
same. A latin hypercube takes each slice of a range once: in an order that a keyed permutation of the places gives.
"""

from __future__ import annotations

import functools
import importlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from xarray.backends import BackendArray
from xarray.core import indexing

Array: TypeAlias = npt.NDArray[np.float64]
Places: TypeAlias = npt.NDArray[np.uint64]

SOBOL = "sobol"
ALONG = "mechanism"
"""The dimension of mechanisms that stand in no grid."""
SHORT_BITS, LONG_BITS = 30, 64
"""Bits of a Sobol sequence: those of SciPy, and those of one with more than 2^30 points."""
AT_ONCE = 1 << 18
"""Mechanisms whose values are made together, so that what is made on the way stays small."""

# scipy costs more to import than a small sweep takes
_qmc = functools.partial(importlib.import_module, "scipy.stats.qmc")


@dataclass(frozen=True)
class DrawnDesigns:
    """Mechanisms drawn from ranges, made block by block.

    Attributes
    ----------
    ranges : path -> least and greatest value [SI]
    count : how many mechanisms
    method, seed : as of `sample`
    """

    ranges: Mapping[str, tuple[float, float]]
    count: int
    method: str
    seed: int

    @property
    def dimensions(self) -> tuple[str, ...]:
        return (ALONG,)

    @property
    def shape(self) -> tuple[int, ...]:
        return (self.count,)

    @property
    def paths(self) -> tuple[str, ...]:
        return tuple(self.ranges)

    @property
    def coordinates(self) -> Mapping[str, tuple[str, Array]]:
        return {}

    @property
    def ends(self) -> Mapping[str, Array]:
        return {path: np.array(ends) for path, ends in self.ranges.items()}

    @property
    def text(self) -> str:
        """All that the values follow from, as JSON."""
        told = {"method": self.method, "seed": self.seed, "count": self.count, "ranges": dict(self.ranges)}
        return json.dumps({key: told[key] for key in sorted(told)})

    @classmethod
    def of_text(cls, text: str) -> DrawnDesigns:
        """The design of a text."""
        told = json.loads(text)
        ranges = {str(path): (float(low), float(high)) for path, (low, high) in told["ranges"].items()}
        return cls(ranges, int(told["count"]), str(told["method"]), int(told["seed"]))

    def rows(self, first: int, stop: int) -> Mapping[str, Array]:
        """Path -> values [SI] of the mechanisms from `first` up to `stop`."""
        return self._values(self.paths, first, stop)

    def values(self, path: str, first: int, stop: int) -> Array:
        """The values [SI] of one path."""
        return self._values((path,), first, stop)[path]

    def _values(self, paths: tuple[str, ...], first: int, stop: int) -> dict[str, Array]:
        found = {path: np.empty(stop - first) for path in paths}
        numbers = {path: k for k, path in enumerate(self.ranges)}
        for low in range(first, stop, AT_ONCE):
            places = np.arange(low, min(low + AT_ONCE, stop), dtype=np.uint64)
            part = slice(low - first, low - first + len(places))
            for path in paths:
                least, greatest = self.ranges[path]
                unit = self._unit(numbers[path], places)
                # the last value may pass the end by rounding
                found[path][part] = np.clip(least + (greatest - least) * unit, least, greatest)
        return found

    def _unit(self, path: int, places: Places) -> Array:
        """Numbers in [0, 1) of a path, at places of the sample."""
        if self.method == SOBOL:
            return sobol_numbers(self.seed, len(self.ranges), path, places, self.count)
        slices = permute(places, self.count, key_of(self.seed, path, 0))
        within = unit_numbers(places, key_of(self.seed, path, 1))
        return np.asarray((slices + within) / self.count)


# Sobol sequences.


@functools.lru_cache(maxsize=4)
def _directions(seed: int, paths: int, bits: int) -> tuple[npt.NDArray[Any], npt.NDArray[Any]]:
    """Scrambled direction numbers (paths, bits) and the digital shift (paths) of SciPy's engine."""
    engine = _qmc().Sobol(paths, bits=bits, seed=np.random.default_rng(seed))
    # its own way to a far point takes a step for each point before it; a test compares with the public one
    return np.asarray(engine._sv, np.uint64), np.asarray(engine._shift, np.uint64)


def sobol_numbers(seed: int, paths: int, path: int, places: Places, count: int) -> Array:
    """One coordinate of points of a scrambled Sobol sequence, as SciPy's engine of this seed draws them in order."""
    bits = SHORT_BITS if count <= 1 << SHORT_BITS else LONG_BITS
    directions, shift = _directions(seed, paths, bits)
    gray = places ^ (places >> np.uint64(1))
    quasi = np.full(len(places), shift[path], np.uint64)
    for bit in range(int(gray.max()).bit_length() if len(gray) else 0):
        set_there = (gray >> np.uint64(bit)) & np.uint64(1)
        quasi ^= set_there * directions[path, bit]
    return np.asarray(quasi * (1.0 / 2**bits))


# Latin hypercubes: a permutation of 0 ... count - 1 that is computed at each place by itself.
#
# A Feistel network permutes the numbers of so many bits, whatever its rounds compute. Numbers beyond the count are sent
# through again until they fall below it: that is a permutation of those below.

ROUNDS = 6
_MIX = (np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB))
_STEP = np.uint64(0x9E3779B97F4A7C15)


def key_of(seed: int, path: int, use: int) -> Places:
    """Keys of the rounds, drawn for a seed, a path and a use."""
    return np.asarray(np.random.SeedSequence([seed, path, use]).generate_state(ROUNDS, np.uint64))


def mix_bits(numbers: Places) -> Places:
    """Numbers whose bits depend on all bits of those given (the finalizer of SplitMix64)."""
    numbers = numbers + _STEP
    numbers = (numbers ^ (numbers >> np.uint64(30))) * _MIX[0]
    numbers = (numbers ^ (numbers >> np.uint64(27))) * _MIX[1]
    return numbers ^ (numbers >> np.uint64(31))


def unit_numbers(places: Places, key: Places) -> Array:
    """Numbers in [0, 1) with 53 bits, one for each place."""
    return np.asarray((mix_bits(mix_bits(places ^ key[0]) ^ key[1]) >> np.uint64(11)) * 2.0**-53)


def permute(places: Places, count: int, key: Places) -> Places:
    """Where a keyed permutation of 0 ... count - 1 sends these places."""
    half = max(1, -(-(count - 1).bit_length() // 2))
    found = _network(places, half, key)
    beyond = np.flatnonzero(found >= count)
    while len(beyond):
        found[beyond] = _network(found[beyond], half, key)
        beyond = beyond[found[beyond] >= count]
    return found


def _network(numbers: Places, half: int, key: Places) -> Places:
    """A permutation of the numbers of twice `half` bits."""
    low, mask = np.uint64(half), np.uint64((1 << half) - 1)
    left, right = numbers >> low, numbers & mask
    for k in range(ROUNDS):
        left, right = right, left ^ (mix_bits(right ^ key[k]) & mask)
    return (left << low) | right


# Values as an array that is made when it is read.


class _DesignValues(BackendArray):
    """The values of one path; what is read of them is made then."""

    def __init__(self, design: DrawnDesigns, path: str) -> None:
        self.design = design
        self.path = path
        self.shape = design.shape
        self.dtype = np.dtype(np.float64)

    def __getitem__(self, key: Any) -> Array:
        return indexing.explicit_indexing_adapter(  # type: ignore[no-any-return]
            key, self.shape, indexing.IndexingSupport.BASIC, self._part
        )

    def _part(self, key: tuple[Any, ...]) -> Any:
        (along,) = key
        if isinstance(along, slice):
            first, stop, step = along.indices(self.design.count)
            # xarray asks for steps forwards
            return self.design.values(self.path, first, max(first, stop))[::step]
        return self.design.values(self.path, int(along), int(along) + 1)[0]


def lazy_values(design: Any, path: str) -> Any:
    """The values of a path of a drawn design, for a variable of xarray."""
    return indexing.LazilyIndexedArray(_DesignValues(design, path))
