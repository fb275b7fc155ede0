"""Which mechanisms a sweep is over: values one by one, a full grid, or a sample of ranges.

Values are made chunk by chunk, so a grid costs no memory however many mechanisms it has.
"""

from __future__ import annotations

import functools
import hashlib
import importlib
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.files import kind_at, value_at
from centrode.model.load_paths import ROOMS
from centrode.model.mechanism import Mechanism
from centrode.model.reading import nearest, value_text
from centrode.model.units import KINDS, read_quantity
from centrode.numerics.arrays import ARRAYS
from centrode.structure.dimensions import dimensions_of
from centrode.sweeps.drawn_designs import DrawnDesigns
from centrode.sweeps.kept_plans import KeptValues

# What a sweep may take of memory and ask for at most; named here, explained in docs/sweeps.md.

WORKING_SET = 256_000_000
"""Bytes that the mechanisms solved together may take, results aside (one mechanism alone may take more)."""

BLOCK_POSITIONS = 2_000_000
"""Positions of one block, the unit that is stored and marked as done: a few seconds of work."""

BLOCKS_OF_KERNELS = 32
"""How many times as many positions stand in a block that machine code computes."""

WORTH_COMPILING = 100_000
"""Positions (nodes of the mesh, if they are more) from which on "auto" takes machine code."""

THREADS = 256
"""Threads of one sweep."""

KERNEL_LANES = 1 << 16
"""Mechanisms that machine code computes at once."""

KERNEL_BUFFER = 2_000_000
"""Bytes of the buffer that machine code writes samples to: it should stay in the cache."""

BLOCK_BYTES = 32_000_000
"""Bytes of one block's results."""

IN_MEMORY = 2_000_000_000
"""Bytes of a result that is kept in memory; a greater one needs a store."""

IN_STORE = 100_000_000_000_000
"""Bytes of a result in a store: what as many mechanisms as there may be have, reduced to some numbers each."""

MECHANISMS = 1_000_000_000_000
"""Mechanisms of one sweep."""

DRAWN = 20_000_000
"""Numbers of a sample (mechanisms times paths) that are drawn at once; those of a longer one block by block."""

BLOCK_SECONDS = 2.0
"""Seconds of work of a block that a cluster computes, where its bytes allow it."""

BLOCKS = 1_000_000
"""Blocks of one store that a cluster computes, so that their marks can be listed; longer sweeps have longer blocks."""

LISTED = 20_000_000
"""Values given one by one."""

PATHS = 100
"""Paths that vary together."""

OUTPUTS = 200
"""Outputs, or formulas, of one sweep."""

TABLES = 100
"""Tables of one sweep."""


# Varied values as they are given: numbers in SI, texts with a unit, ranges.

Array: TypeAlias = npt.NDArray[np.float64]

_ALONG = frozenset({"x", "y", "length", "radius"})
_METRES = frozenset({"radius", "centre_radius"})
"""Of links: lengths on the sphere too."""
_MASSES = frozenset({"mass", "inertia"})
_ANGLES = frozenset({"direction", "angle", "longitude", "latitude"})


def kind_of(mechanism: Mechanism, path: str) -> str:
    """Kind of the number at a path, which tells its units; InputError where there is no such path."""
    return _kinds.get(mechanism, path, functools.partial(_kind_of, mechanism, path))


_kinds: KeptValues[str] = KeptValues(1000)


def _kind_of(mechanism: Mechanism, path: str) -> str:
    try:
        value_at(mechanism, path)
    except InputError as error:
        raise InputError("vary", error.what, error.repair) from None
    room, word = path.partition(".")[0], path.rpartition(".")[2]
    if room in ROOMS or room == "drives":
        return kind_at(mechanism, path)
    if word in _METRES and room == "links":
        return "length"
    if word in _ALONG:
        return "length" if mechanism.space == "plane" else "arc"
    # on the sphere lengths of links are arcs; only radii of wheels and centres of mass are metres
    if word in _MASSES:
        return word
    return "angle" if word in _ANGLES else "ratio"


def unit_of(mechanism: Mechanism, path: str) -> str:
    """SI unit of the number at a path; "1" where it has none."""
    kind = kind_of(mechanism, path)
    if path.partition(".")[0] in (*ROOMS, "drives"):
        return KINDS[kind].unit.replace("*", " ") or "1"
    return {"length": "m", "ratio": "1", "mass": "kg", "inertia": "kg m^2"}.get(kind, "rad")


def numbers(mechanism: Mechanism, path: str, given: Any) -> Array:
    """Values [SI] given one by one: an array of numbers, or a list of numbers and texts with a unit.

    Raises InputError at the path: none, not in one dimension, not finite, a text that is no number, a range.
    """
    kind = kind_of(mechanism, path)
    # a tuple of a range is not a list of values: it would pass as three numbers
    if (
        isinstance(given, tuple)
        and len(given) == 3
        and isinstance(given[0], str)
        and isinstance(given[2], int)
    ):
        raise InputError(path, _("a range is given where values are expected"), _("use ct.grid or ct.sample"))
    if isinstance(given, Sequence) and not isinstance(given, str) and any(isinstance(x, str) for x in given):
        given = [_number(mechanism, kind, path, value) for value in given]
    try:
        array = np.asarray(given, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise InputError(
            path, _("its values are not numbers"), _("give numbers, or texts with a unit")
        ) from None
    if array.ndim != 1 or not array.size:
        raise InputError(path, _("a one-dimensional array of one or more values is required"))
    if array.size > LISTED:
        what = _("{count} values were given").format(count=array.size)
        raise InputError(path, what, _("give at most {most}, or a ct.grid").format(most=LISTED))
    if not np.isfinite(array).all():
        raise InputError(path, _("values must be finite"))
    _refuse_negative(kind, path, float(array.min()))
    return array


def ends(mechanism: Mechanism, path: str, first: Any, last: Any) -> tuple[float, float]:
    """Both ends [SI] of a range; InputError at the path where it is reversed or has no extent."""
    kind = kind_of(mechanism, path)
    low, high = (_number(mechanism, kind, path, end) for end in (first, last))
    if not low < high:
        what = _("the range from {first} to {last} does not increase").format(
            first=value_text(first), last=value_text(last)
        )
        raise InputError(path, what, _("give the smaller end first, and a larger one after it"))
    _refuse_negative(kind, path, low)
    return low, high


def _refuse_negative(kind: str, path: str, least: float) -> None:
    if kind in _MASSES and least < 0.0:
        raise InputError(path, _("{value:g} is negative").format(value=least), _("give 0 or more"))


def _number(mechanism: Mechanism, kind: str, path: str, given: Any) -> float:
    value = given.item() if isinstance(given, np.generic) else given
    return read_quantity(value, kind, path, refuses_bare=mechanism.display.refuses_bare_angles)


def count_of(path: str, given: Any, most: int) -> int:
    """A number of values; InputError at the path where it is no whole number from 1 to `most`."""
    if isinstance(given, np.integer):
        given = int(given)
    if isinstance(given, bool) or not isinstance(given, int) or not 1 <= given <= most:
        what = _("{count} is not a valid number of values").format(count=value_text(given))
        raise InputError(path, what, _("give a whole number from 1 to {most}").format(most=most))
    return given


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
        """Number of values along each dimension."""

    @property
    def paths(self) -> tuple[str, ...]:
        """What varies."""

    @property
    def coordinates(self) -> Coordinates:
        """Path -> its dimension and its values [SI] along it; nothing of values that are made block by block."""

    @property
    def ends(self) -> Mapping[str, Array]:
        """Path -> its least and greatest value [SI]."""

    def rows(self, first: int, stop: int) -> Rows:
        """Path -> values [SI] of the mechanisms from `first` up to `stop`."""


def ends_of(values: Rows) -> dict[str, Array]:
    """Path -> least and greatest of its values."""
    return {path: np.array([column.min(), column.max()]) for path, column in values.items()}


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
    def paths(self) -> tuple[str, ...]:
        return tuple(self.values)

    @property
    def coordinates(self) -> Coordinates:
        return {path: (MECHANISM, values) for path, values in self.values.items()}

    @property
    def ends(self) -> Mapping[str, Array]:
        return ends_of(self.values)

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
    def paths(self) -> tuple[str, ...]:
        return tuple(self.axes)

    @property
    def coordinates(self) -> Coordinates:
        return {path: (path, values) for path, values in self.axes.items()}

    @property
    def ends(self) -> Mapping[str, Array]:
        return ends_of(self.axes)

    def rows(self, first: int, stop: int) -> Rows:
        # the last path runs fastest, as in the arrays of the result
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

    Examples
    --------
    >>> import centrode as ct
    >>> lengths = ct.grid({"links.AB.length": ("3.4 m", "3.6 m", 3), "links.DB.length": [3.0, 3.1]})
    >>> found = ct.sweep(ct.example("crank-rocker"), lengths, ["angle.DB"], 37, reduce="max")
    >>> dict(found.sizes)
    {'links.AB.length': 3, 'links.DB.length': 2}
    """
    return Grid(dict(ranges))


# Samples of ranges: latin hypercubes and Sobol sequences.

METHODS = ("latin hypercube", "sobol")

# scipy costs more to import than a small sweep takes
_qmc = functools.partial(importlib.import_module, "scipy.stats.qmc")


@dataclass(frozen=True)
class Sample:
    """Mechanisms to be drawn from ranges; made by `sample`."""

    ranges: Mapping[str, Any]
    count: int
    method: str
    seed: int


def sample(ranges: Mapping[str, Any], count: int, method: str = "latin hypercube", seed: int = 0) -> Sample:
    """Mechanisms spread evenly over ranges of several dimensions, for `sweep`.

    Parameters
    ----------
    ranges : path -> (first, last)
        Numbers [SI] or texts with a unit.
    count : int
        How many mechanisms. More than 20 million numbers are not drawn at once, but as they are needed.
    method : "latin hypercube" or "sobol"
        Each of `count` slices of every range once; or the first points of a scrambled Sobol sequence (best with
        a power of two).
    seed : int
        The same seed draws the same mechanisms.

    Examples
    --------
    >>> import centrode as ct
    >>> drawn = ct.sample({"links.AB.length": ("3.4 m", "3.6 m")}, 4)
    >>> found = ct.sweep(ct.example("crank-rocker"), drawn, ["angle.DB"], 37, reduce="max")
    >>> found.sizes["mechanism"]
    4
    """
    return Sample(dict(ranges), count, method, seed)


def draw_sample(mechanism: Mechanism, asked: Sample) -> Design:
    """The mechanisms of a sample; InputError for a range, count, method or seed that is none."""
    count = count_of("sample", asked.count, MECHANISMS)
    if asked.method not in METHODS:
        what = _("unknown method {method}").format(method=value_text(asked.method))
        raise InputError("sample", what, nearest(str(asked.method), METHODS))
    seed: object = asked.seed
    if isinstance(seed, bool) or not isinstance(seed, int) or seed < 0:
        raise InputError("sample", _("the seed must be a whole number from 0"))
    bounds = {path: _bounds(mechanism, path, given) for path, given in asked.ranges.items()}
    if count * len(bounds) > DRAWN:
        return DrawnDesigns(bounds, count, asked.method, seed)
    unit = _in_unit_cube(asked.method, len(bounds), count, np.random.default_rng(seed))
    columns = zip(bounds.items(), unit.T, strict=True)
    # the last value may pass the end by rounding
    return Listed(
        {path: np.clip(low + (high - low) * column, low, high) for (path, (low, high)), column in columns}
    )


def _bounds(mechanism: Mechanism, path: str, given: Any) -> tuple[float, float]:
    if isinstance(given, str) or not isinstance(given, tuple | list) or len(given) != 2:
        raise InputError(path, _("a range of a sample is (first, last)"))
    return ends(mechanism, path, *given)


def _in_unit_cube(method: str, paths: int, count: int, random: np.random.Generator) -> Array:
    """Points of the unit cube (count, paths)."""
    if method == "latin hypercube":
        return np.asarray(_qmc().LatinHypercube(paths, seed=random).random(count))
    # powers of two are what the sequence is balanced for; the rest is cut off
    return np.asarray(_qmc().Sobol(paths, seed=random).random_base2((count - 1).bit_length())[:count])


def design_of(
    mechanism: Mechanism, vary: Mapping[str, Any] | Grid | Sample, *, dimensions_only: bool = True
) -> Design:
    """The mechanisms that `vary` asks for; without `dimensions_only` loads, machine and simulation may vary too.

    Raises InputError: nothing varies, unequal numbers of values, a path that is no dimension, values that no
    mechanism can have, more mechanisms than `limits.MECHANISMS`.
    """
    given: object = vary.ranges if isinstance(vary, Grid | Sample) else vary
    if not isinstance(given, Mapping) or not given:
        raise InputError(
            "vary", _("nothing varies"), _('name a path and its values: {"links.AC.length": [...]}')
        )
    if len(given) > PATHS or not all(isinstance(path, str) for path in given):
        raise InputError("vary", _("give at most {most} paths, as texts").format(most=PATHS))
    design = _resolve_design(mechanism, vary)
    if math.prod(design.shape) > MECHANISMS:
        what = _("{count} mechanisms are given").format(count=math.prod(design.shape))
        raise InputError("vary", what, _("give at most {most}").format(most=MECHANISMS))
    if not dimensions_only:
        return design
    # only the ends: what lies between them is possible where both are
    dimensions_of(
        mechanism, design.ends, ARRAYS
    )  # refuses what no mechanism can have, before any is computed
    return design


def _resolve_design(mechanism: Mechanism, vary: Mapping[str, Any] | Grid | Sample) -> Design:
    if isinstance(vary, Grid):
        return Crossed({path: _axis(mechanism, path, given) for path, given in vary.ranges.items()})
    if isinstance(vary, Sample):
        return draw_sample(mechanism, vary)
    values = {path: numbers(mechanism, path, given) for path, given in vary.items()}
    sizes = {path: array.size for path, array in values.items()}
    if len(set(sizes.values())) > 1:
        told = ", ".join(f"{path} {size}" for path, size in sizes.items())
        what = _("every path needs the same number of values; got {counts}").format(counts=told)
        raise InputError("vary", what, _("use ct.grid for every combination"))
    return Listed(values)


def _axis(mechanism: Mechanism, path: str, given: Any) -> Array:
    if not isinstance(given, tuple):
        return numbers(mechanism, path, given)
    if len(given) != 3:
        raise InputError(path, _("a range is (first, last, count)"), _("give values as a list"))
    low, high = ends(mechanism, path, *given[:2])
    count = count_of(path, given[2], LISTED)
    if count < 2:
        raise InputError(path, _("a range needs two values or more"), _("give one value as a list"))
    # both ends, as a range is given by them
    return np.linspace(low, high, count)


def path_digests(design: Design) -> dict[str, str]:
    """The values by which two designs are distinguished: path -> a digest of its values along the design."""
    if isinstance(design, DrawnDesigns):
        return {path: design.text for path in design.paths}
    # a digest of the bytes: two designs are the same if every bit is
    told = {}
    for path, (dimension, values) in design.coordinates.items():
        digest = hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()
        told[path] = f"{dimension}: {values.size}, {digest}"
    return told
