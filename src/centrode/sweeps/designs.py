"""Which mechanisms a sweep is over: values one by one, a full grid, or a sample of ranges.

Values are made chunk by chunk, so a grid costs no memory however many mechanisms it has.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model.mechanism import Mechanism
from centrode.structure.dimensions import dimensions_of
from centrode.sweeps import limits
from centrode.sweeps.drawing import Sample, drawn
from centrode.sweeps.values import count_of, ends, numbers

Array: TypeAlias = npt.NDArray[np.float64]
Rows: TypeAlias = Mapping[str, Array]
Coordinates: TypeAlias = Mapping[str, tuple[str, Array]]

MECHANISM = "mechanism"
"""Dimension of mechanisms that stand in no grid."""


class Design(Protocol):
    """The mechanisms of a sweep, numbered from 0 in the order of the result (the last dimension runs fastest)."""

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Names of the dimensions they span."""

    @property
    def shape(self) -> tuple[int, ...]:
        """How many there are along each."""

    @property
    def coordinates(self) -> Coordinates:
        """Path -> its dimension and its values [SI] along it."""

    def rows(self, first: int, stop: int) -> Rows:
        """Path -> values [SI] of the mechanisms from `first` up to `stop`."""


@dataclass(frozen=True)
class Listed:
    """Values one by one: as many mechanisms as each path has values."""

    values: Rows

    @property
    def dimensions(self) -> tuple[str, ...]:
        return (MECHANISM,)

    @property
    def shape(self) -> tuple[int, ...]:
        return (next(iter(self.values.values())).size,)

    @property
    def coordinates(self) -> Coordinates:
        return {path: (MECHANISM, values) for path, values in self.values.items()}

    def rows(self, first: int, stop: int) -> Rows:
        return {path: values[first:stop] for path, values in self.values.items()}


@dataclass(frozen=True)
class Crossed:
    """Every combination of the values of each path; the last path varies fastest."""

    axes: Rows

    @property
    def dimensions(self) -> tuple[str, ...]:
        return tuple(self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(values.size for values in self.axes.values())

    @property
    def coordinates(self) -> Coordinates:
        return {path: (path, values) for path, values in self.axes.items()}

    def rows(self, first: int, stop: int) -> Rows:
        places = np.unravel_index(np.arange(first, stop), self.shape)
        return {path: values[at] for (path, values), at in zip(self.axes.items(), places, strict=True)}


@dataclass(frozen=True)
class Grid:
    """Values of each path to be crossed with those of the others; made by `grid`."""

    ranges: Mapping[str, Any]


def grid(ranges: Mapping[str, Any]) -> Grid:
    """Every combination of the values of several dimensions, for `sweep`.

    Parameters
    ----------
    ranges : path -> (first, last, count), or values
        A tuple is a range: evenly spaced values with both ends, numbers [SI] or texts with a unit. A list or an
        array is taken as it is. The last path varies fastest.
    """
    return Grid(dict(ranges))


def design_of(mechanism: Mechanism, vary: Mapping[str, Any] | Grid | Sample) -> Design:
    """The mechanisms that `vary` asks for.

    Raises InputError: nothing varies, unequal numbers of values, a path that is no dimension, values that no
    mechanism can have, more mechanisms than `limits.MECHANISMS`.
    """
    given: object = vary.ranges if isinstance(vary, Grid | Sample) else vary
    if not isinstance(given, Mapping) or not given:
        raise InputError(
            "vary", _("nothing varies"), _('name a path and its values: {"links.AC.length": [...]}')
        )
    if len(given) > limits.PATHS or not all(isinstance(path, str) for path in given):
        raise InputError("vary", _("give at most {most} paths, as texts").format(most=limits.PATHS))
    design = _resolved(mechanism, vary)
    if math.prod(design.shape) > limits.MECHANISMS:
        what = _("{count} mechanisms were asked for").format(count=math.prod(design.shape))
        raise InputError("vary", what, _("ask for at most {most}").format(most=limits.MECHANISMS))
    extremes = {
        path: np.array([values.min(), values.max()]) for path, (_along, values) in design.coordinates.items()
    }
    dimensions_of(mechanism, extremes, ARRAYS)  # refuses what no mechanism can have, before any is computed
    return design


def _resolved(mechanism: Mechanism, vary: Mapping[str, Any] | Grid | Sample) -> Design:
    if isinstance(vary, Grid):
        return Crossed({path: _axis(mechanism, path, given) for path, given in vary.ranges.items()})
    if isinstance(vary, Sample):
        return Listed(drawn(mechanism, vary))
    values = {path: numbers(mechanism, path, given) for path, given in vary.items()}
    sizes = {path: array.size for path, array in values.items()}
    if len(set(sizes.values())) > 1:
        told = ", ".join(f"{path} {size}" for path, size in sizes.items())
        what = _("every path needs the same number of values; got {counts}").format(counts=told)
        raise InputError("vary", what, _("say ct.grid for every combination"))
    return Listed(values)


def _axis(mechanism: Mechanism, path: str, given: Any) -> Array:
    if not isinstance(given, tuple):
        return numbers(mechanism, path, given)
    if len(given) != 3:
        raise InputError(path, _("a range is (first, last, count)"), _("give values as a list"))
    low, high = ends(mechanism, path, *given[:2])
    count = count_of(path, given[2], limits.LISTED)
    if count < 2:
        raise InputError(path, _("a range needs two values or more"), _("give one value as a list"))
    return np.linspace(low, high, count)


def described(design: Design) -> dict[str, str]:
    """The values by which two designs are told apart: path -> a digest of its values along the design."""
    told = {}
    for path, (dimension, values) in design.coordinates.items():
        digest = hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()
        told[path] = f"{dimension}: {values.size}, {digest}"
    return told


def counted(design: Design) -> str:
    """How many mechanisms there are, in words; the extents of a grid with them."""
    count = math.prod(design.shape)
    words = ngettext("{n} mechanism", "{n} mechanisms", count).format(n=count)
    return f"{words} ({' x '.join(map(str, design.shape))})" if len(design.shape) > 1 else words
