"""Results of a sweep in a store (zarr), block by block: a run that was killed goes on where it was.

A block's numbers are written first, then its mark, by a rename that happens or does not. What has no mark, or differs
from what its mark says, is computed again. Beside the zarr arrays stands the group `progress` with the lock, the study
and the marks.

Nothing in a folder is trusted for being there: metadata have to be those that this sweep has, chunks have their size
(they are not compressed, so nothing can unpack to more), small files are read up to a bound.
"""

from __future__ import annotations

import functools
import hashlib
import importlib
import importlib.util
import json
import math
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any, Protocol, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import DamageWarning, InputError
from centrode.locale import _, ngettext
from centrode.optional_packages import how_to_install
from centrode.sweeps import designs
from centrode.sweeps.arrays import SweepTask
from centrode.sweeps.designs import MECHANISM, Design, path_digests
from centrode.sweeps.drawn_designs import DrawnDesigns, lazy_values
from centrode.sweeps.executors import bare
from centrode.sweeps.outputs import PATH, SAMPLE, SweepColumn, SweepOutputs
from centrode.sweeps.result_columns import StreamedColumns, columns_for
from centrode.sweeps.storage import DONE, GREATEST, METADATA, PROGRESS, Storage, place_refusals, table_of

# The blocks of a sweep: runs of mechanisms that are computed, kept and marked as done together.


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
        # as many whole dimensions as fit, from the last one on
        while axis > 0 and inner * shape[axis] <= most:
            inner *= shape[axis]
            axis -= 1
        # pieces of nearly equal length: none is left over that is very short
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
        # the last piece of an axis may be shorter
        end = (outer * self.shape[self.axis] + min((piece + 1) * self.step, self.shape[self.axis])) * inner
        return first, end

    def place(self, block: int) -> tuple[int, ...]:
        """Number of a block along each dimension."""
        outer, piece = divmod(block, self.pieces)
        places: list[int] = []
        # the outer dimensions, the last one fastest
        for extent in reversed(self.shape[: self.axis]):
            outer, place = divmod(outer, extent)
            places.insert(0, place)
        return (*places, piece, *[0] * (len(self.shape) - self.axis - 1))

    def region(self, block: int) -> tuple[slice, ...]:
        """Where a block stands in an array of the shape."""
        return tuple(
            slice(place * step, min((place + 1) * step, extent))
            for place, step, extent in zip(self.place(block), self.chunk, self.shape, strict=True)
        )


# What a sweep came to: mechanisms by how far they move, worst residual, extremes; added up block by block.

Extremes: TypeAlias = dict[str, list[list[float] | None]]
"""Column -> for each of its components (in order) least and greatest value; None where there is no number."""


@dataclass
class Tally:
    """Counts of mechanisms, and extremes of reduced columns.

    Attributes
    ----------
    mechanisms : computed so far
    whole, none : those of which every sample is ok, and none
    worst_residual : the worst of all; NaN without any
    """

    mechanisms: int = 0
    whole: int = 0
    none: int = 0
    worst_residual: float = math.nan
    extremes: Extremes = field(default_factory=dict)

    def add(self, other: Tally) -> None:
        """Count the mechanisms of another block in."""
        self.mechanisms += other.mechanisms
        self.whole += other.whole
        self.none += other.none
        # NaN is no residual: a block without any changes nothing
        self.worst_residual = float(np.fmax(self.worst_residual, other.worst_residual))
        for name, theirs in other.extremes.items():
            own = self.extremes.get(name)
            self.extremes[name] = (
                theirs if own is None else [_wider(a, b) for a, b in zip(own, theirs, strict=True)]
            )

    def as_dict(self) -> dict[str, Any]:
        """The totals as JSON that a marker holds; numbers survive to the last bit."""
        # JSON has no NaN
        worst = None if math.isnan(self.worst_residual) else self.worst_residual
        return {
            "mechanisms": self.mechanisms,
            "whole": self.whole,
            "none": self.none,
            "worst_residual": worst,
            "extremes": self.extremes,
        }

    @classmethod
    def from_dict(cls, told: Mapping[str, Any], components: Mapping[str, int]) -> Tally:
        """The tally of a mark; `components` says how many each column has.

        Raises KeyError, TypeError, ValueError or OverflowError where it is none.
        """
        worst = told["worst_residual"]
        extremes = {name: [_ends(pair) for pair in found] for name, found in told["extremes"].items()}
        if any(components.get(name) != len(found) for name, found in extremes.items()):
            raise ValueError("extremes of other columns")
        return cls(
            int(told["mechanisms"]),
            int(told["whole"]),
            int(told["none"]),
            math.nan if worst is None else float(worst),
            extremes,
        )


def _ends(pair: Sequence[float] | None) -> list[float] | None:
    if pair is None:
        return None
    least, greatest = pair
    return [float(least), float(greatest)]


def _wider(one: Sequence[float] | None, other: Sequence[float] | None) -> list[float] | None:
    if one is None or other is None:
        both = one if other is None else other
        return None if both is None else list(both)
    return [min(one[0], other[0]), max(one[1], other[1])]


def tally_of(asked: SweepOutputs, samples: int, results: Mapping[str, npt.NDArray[Any]]) -> Tally:
    """The tally of one block."""
    ok = results["samples_ok"]
    worst = float(np.fmax.reduce(results["worst_residual"]))
    extremes: Extremes = {}
    # derivatives have no extremes of interest, and the variables of whole mechanisms have theirs
    others = {"samples_ok", "worst_residual", *asked.slopes.values()}
    for column in asked.columns:
        if not column.at_samples and column.name not in others:
            flat = results[column.name].reshape(len(ok), math.prod(column.shape))
            extremes[column.name] = [_extremes(flat[:, k]) for k in range(flat.shape[1])]
    return Tally(len(ok), int(np.sum(ok == samples)), int(np.sum(ok == 0)), worst, extremes)


def _extremes(values: npt.NDArray[np.float64]) -> list[float] | None:
    finite = values[np.isfinite(values)]
    return [float(finite.min()), float(finite.max())] if finite.size else None


# The labelled result of a sweep: its frame without numbers, and results kept in memory.

AnyArray: TypeAlias = npt.NDArray[Any]


class Kept(Protocol):
    """Where the blocks of a sweep go."""

    blocks: Blocks
    tally: Tally

    def has(self, block: int) -> bool:
        """Whether a block is there already."""

    def room(self, block: int) -> StreamedColumns:
        """Arrays that the results of a block are written to, before it is put."""

    def put(self, block: int, results: Mapping[str, AnyArray], tally: Tally) -> None:
        """Keep what stands in the room of a block: all of it, or nothing."""


@dataclass(frozen=True)
class SweepFrame:
    """Dimensions, coordinates and attributes of a result; `empty` holds no variables, `units` those of what varies."""

    design: Design
    asked: SweepOutputs
    empty: xr.Dataset
    units: Mapping[str, str]

    @property
    def mechanisms(self) -> int:
        """Number of mechanisms."""
        return math.prod(self.design.shape)

    @property
    def labels(self) -> Mapping[Any, Any]:
        """Coordinates of a result: those of `empty`, and values of a drawn design, made when they are read."""
        drawn = {
            path: ((MECHANISM,), lazy_values(self.design, path), {"units": self.units[path]})
            for path in self.units
            if path not in self.design.coordinates
        }
        if not drawn:
            return self.empty.coords
        return xr.Dataset(coords={**self.empty.coords, **drawn}).coords

    @property
    def bytes(self) -> int:
        """Memory [bytes] of all columns."""
        return self.mechanisms * sum(column.bytes for column in self.asked.columns)

    def room(self, mechanisms: int) -> StreamedColumns:
        """Arrays for the columns of some mechanisms, as files have them."""
        return StreamedColumns(
            {
                column.name: np.empty((mechanisms, *column.shape), dtype=column.kind)
                for column in self.asked.columns
            }
        )


@dataclass(frozen=True)
class MotionLabels:
    """Words and labels of results of one task, taken from a motion of the mechanism; made once.

    Attributes
    ----------
    coordinates : the motion's that results have
    attributes : what results say of the mechanism
    """

    coordinates: xr.Dataset
    attributes: Mapping[str, Any]
    _designs: dict[Any, xr.Dataset] = field(default_factory=dict)

    @classmethod
    def of(cls, motion: xr.Dataset, asked: SweepOutputs) -> MotionLabels:
        """The labels of what is requested."""
        used = {dimension for column in asked.columns for dimension in column.dimensions}
        labels = [dimension for dimension in motion.dims if dimension in used and dimension in motion.coords]
        if SAMPLE in used:
            labels += ["time", "drive", "drive_value"]
        coordinates: dict[Any, Any] = {name: motion[name] for name in labels}
        if SAMPLE in used:
            # what formulas compare the motion with stands beside it
            coordinates |= {
                name: ((SAMPLE,), table.numbers, {"long_name": name}) for name, table in asked.tables.items()
            }
        told = {key: motion.attrs[key] for key in ("title", "mechanism", "version", "mobility")}
        attributes = {**told, "samples": motion.sizes["sample"]}
        found = xr.Dataset(coords=coordinates)
        # the drive along the samples is a label of a motion, and a number beside it here
        return cls(
            found.drop_indexes([name for name in found.xindexes if name not in found.dims]), attributes
        )

    def with_design(
        self, design: Design, units: Mapping[str, str], asked: SweepOutputs, attributes: Mapping[str, Any]
    ) -> xr.Dataset:
        """The coordinates of a result: these, the paths that vary, and the values of a design."""
        given = {path: (along, x, {"units": units[path]}) for path, (along, x) in design.coordinates.items()}
        key = tuple((path, along, x.shape, x.dtype) for path, (along, x, _units) in given.items())
        kept = self._designs.get(key)
        if kept is None:
            added: dict[Any, Any] = {}
            if any(PATH in column.dimensions for column in asked.columns):
                # texts of any length, as all other labels: a store has no standard for those of one length
                added[PATH] = (PATH, np.array(list(design.paths), dtype=object))
            # values of a grid are indexes, and stay what they are
            is_grid = any(along == path for path, (along, _x, _units) in given.items())
            added |= given if is_grid else {path: _in_its_place(*one) for path, one in given.items()}
            kept = self.coordinates.assign_coords(added)
            if not is_grid:
                self._designs.clear()
                self._designs[key] = kept
        # to align coordinates takes as long as hundreds of motions: those of designs of one shape are put together
        # once, and values take their places
        found = kept.copy()
        for name, variable in found.variables.items():
            if isinstance(variable, xr.IndexVariable):
                continue
            # whoever writes to a result must not write to the next one
            variable.data = given[str(name)][1] if name in given else variable.data.copy()
        found.attrs = {**self.attributes, **attributes}
        return found


def _in_its_place(
    along: str, values: AnyArray, told: Mapping[str, str]
) -> tuple[str, AnyArray, Mapping[str, str]]:
    """A coordinate of that shape without its values, which takes no memory."""
    return along, np.broadcast_to(np.zeros(1, values.dtype), values.shape), told


def frame_of(
    labels: MotionLabels, design: Design, units: Mapping[str, str], asked: SweepOutputs, executor: str
) -> SweepFrame:
    """The frame of a sweep."""
    attributes = {"executor": executor}
    if isinstance(design, DrawnDesigns):
        # values of a drawn design are in no store: this says what they are
        attributes["drawn"] = design.text
    empty = labels.with_design(design, units, asked, attributes)
    return SweepFrame(design, asked, empty, dict(units))


class InMemory:
    """A result in arrays; what is not computed is empty."""

    def __init__(self, frame: SweepFrame, blocks: Blocks, out: npt.NDArray[np.float64] | None = None) -> None:
        self.frame = frame
        self.blocks = blocks
        self.tally = Tally()
        self.arrays = columns_for(frame.asked.columns, frame.mechanisms, out)

    def has(self, block: int) -> bool:
        return False

    def room(self, block: int) -> StreamedColumns:
        return self.arrays.part(slice(*self.blocks.mechanisms(block)))

    def put(self, block: int, results: Mapping[str, AnyArray], tally: Tally) -> None:
        self.tally.add(tally)  # the results stand where they belong

    def leave_the_rest_empty(self) -> None:
        """Leave no part of a block that was being put when an interruption came."""
        # blocks are put in order, so all behind the last one put is not computed
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
        found = xr.Dataset(variables, self.frame.labels, self.frame.empty.attrs)
        return with_tally(found, self.frame, self.tally)


def with_tally(data: xr.Dataset, frame: SweepFrame, tally: Tally) -> xr.Dataset:
    """The result with what it came to in its attributes."""
    data.attrs |= {
        "mechanisms": tally.mechanisms,
        "mechanisms_whole": tally.whole,
        "mechanisms_none": tally.none,
        "worst_residual": tally.worst_residual,
    }
    for column in frame.asked.columns:
        extremes = tally.extremes.get(column.name)
        if extremes is None:
            continue
        ends = [(math.nan, math.nan) if pair is None else tuple(pair) for pair in extremes]
        least, greatest = [end[0] for end in ends], [end[1] for end in ends]
        single = not column.shape
        told = data.variables[column.name].attrs
        told["least"] = least[0] if single else least
        told["greatest"] = greatest[0] if single else greatest
    return data


# Marks of the blocks of a store that are done: what each came to, with a checksum of it and of the block's
# chunks.
#
# A mark holds for exactly what was written: a chunk that was cut off, changed or taken away, a mark of
# another block or one that was edited give another checksum, and the block counts as damaged.

CHECK = 4
"""Bytes that the codec `crc32c` puts behind the numbers of a chunk."""
TOGETHER = 1000
"""Marks in one folder."""


class Marks:
    """The marks of a store whose columns are kept in chunks, a chunk of each column for every block."""

    def __init__(self, storage: Storage, columns: Sequence[SweepColumn], blocks: Blocks) -> None:
        self.storage = storage
        self.columns = columns
        self.blocks = blocks

    def chunks(self, block: int) -> Iterator[tuple[str, int]]:
        """Name of a block's chunk in each column, and the bytes that it has if it is there."""
        place = "/".join(map(str, self.blocks.place(block)))
        for column, behind, size in self._columns:
            yield f"{column}/c/{place}{behind}", size

    @functools.cached_property
    def _columns(self) -> list[tuple[str, str, int]]:
        """Of each column its name, what a chunk's name ends with, and the bytes of a chunk."""
        lanes = math.prod(self.blocks.chunk)
        return [
            (column.name, "/0" * len(column.shape), lanes * column.bytes + CHECK) for column in self.columns
        ]

    def write(self, block: int, tally: Tally, contents: Mapping[str, bytes | None]) -> None:
        """Mark a block whose chunks are written; `contents` are what was written by the names of the chunks."""
        told = tally.as_dict()
        if self.storage.reads_back:
            # the checksum is of what is read back, not of what was meant to be written
            checksum = self._checksum(block, told)
        else:
            checksum = _checksum_of(block, told, (contents[name] for name, _size in self.chunks(block)))
        if checksum is None:
            what = _("block {block} cannot be read back").format(block=block)
            raise InputError(str(self.storage), what, _("give another path"))
        name = f"{PROGRESS}/{DONE}/{block // TOGETHER}/{block}.json"
        self.storage.write_durably(name, {"tally": told, "sha256": checksum})

    def read(self, thorough: bool) -> Iterator[tuple[int, Tally | None]]:
        """(block, tally) of the blocks that have a mark; None of those that are damaged.

        A mark that cannot be read, or is no mark of a block, counts for nothing. Without `thorough` chunks are not
        read: only their sizes are compared, in an object store nothing of them.
        """
        # any file may lie there: names that are no block's are left alone
        for name, told in self.storage.marks(f"{PROGRESS}/{DONE}"):
            block = self._block(*name.split("/")[-2:])
            # no mark at all: the block is simply not done
            if block is None or told is None or not isinstance(told.get("sha256"), str):
                continue
            tally = self._tally(block, told.get("tally"))
            whole = tally is not None and (
                told["sha256"] == self._checksum(block, tally.as_dict())
                if thorough
                else self._sizes_fit(block)
            )
            yield block, tally if whole else None

    def _block(self, folder: str, file: str) -> int | None:
        """The block whose mark has this name in a folder of this name, if any has."""
        stem = file.removesuffix(".json")
        # digits of other scripts, and numbers longer than any block's, are refused before they are read
        if not (stem.isascii() and stem.isdigit()) or len(stem) > len(str(len(self.blocks))):
            return None
        block = int(stem)
        own = block < len(self.blocks) and folder == str(block // TOGETHER)
        return block if own and stem == str(block) else None

    def _tally(self, block: int, told: object) -> Tally | None:
        """The tally in a mark; None where it is none of this block."""
        first, stop = self.blocks.mechanisms(block)
        try:
            tally = Tally.from_dict(told, self._components)  # type: ignore[arg-type]
        except (ValueError, KeyError, TypeError, OverflowError, AttributeError):
            return None
        return tally if tally.mechanisms == stop - first else None

    @functools.cached_property
    def _components(self) -> Mapping[str, int]:
        return {column.name: math.prod(column.shape) for column in self.columns}

    def _sizes_fit(self, block: int) -> bool:
        """Whether the chunks that are there have their size; an object store is not asked for what it keeps itself."""
        if not self.storage.reads_back:
            return True
        for name, size in self.chunks(block):
            try:
                if self.storage.pieces(name, size) is None:
                    return False
            except FileNotFoundError:
                # a chunk of empty numbers has no file
                continue
            except OSError:
                return False
        return True

    def _checksum(self, block: int, told: Mapping[str, Any]) -> str | None:
        """Checksum of a block's tally and of its chunks as they are read; None where a file is no chunk."""
        checksum = hashlib.sha256(_head(block, told))
        for name, size in self.chunks(block):
            try:
                pieces = self.storage.pieces(name, size)
                if pieces is None:
                    return None
                checksum.update(b"chunk")
                for piece in pieces:
                    checksum.update(piece)
            except FileNotFoundError:
                # a chunk of empty numbers is not written: its absence is part of the checksum
                checksum.update(b"none")
            except OSError:
                return None
        return checksum.hexdigest()


def _head(block: int, told: Mapping[str, Any]) -> bytes:
    return json.dumps([block, told], sort_keys=True).encode()


def _checksum_of(block: int, told: Mapping[str, Any], contents: Iterable[bytes | None]) -> str:
    """The checksum of chunks that are at hand."""
    checksum = hashlib.sha256(_head(block, told))
    for content in contents:
        checksum.update(b"none" if content is None else b"chunk")
        checksum.update(content or b"")
    return checksum.hexdigest()


STUDY = "study.json"
FORMAT = 3
NAMED = 5
"""Damaged blocks that a warning names at most."""

_zarr = functools.partial(importlib.import_module, "zarr")  # an extra, and slower to import than NumPy
_codecs = functools.partial(importlib.import_module, "zarr.codecs")
_storage = functools.partial(importlib.import_module, "zarr.storage")


class BlockWriter:
    """Writes blocks of a store that is made: their chunks, then their mark. A worker has one without the lock.

    Two that write the same block write the same bytes, each object whole: what stands there in the end is one of both.
    """

    def __init__(self, storage: Storage, frame: SweepFrame, blocks: Blocks) -> None:
        self.storage = storage
        self.frame = frame
        self.blocks = blocks
        self.marks = Marks(storage, frame.asked.columns, blocks)
        # zarr writes into memory, from where chunks go to their place as they are
        self._written: dict[str, Any] = {}
        root = _empty_arrays(_storage().MemoryStore(self._written), frame, blocks)
        self._arrays = {column.name: root[column.name] for column in frame.asked.columns}
        self._metadata = set(self._written)

    def write(self, block: int, results: Mapping[str, AnyArray], tally: Tally) -> None:
        """Write a block's chunks and its mark; the mark last: without it the block counts as not done."""
        region = self.blocks.region(block)
        extent = tuple(along.stop - along.start for along in region)
        contents: dict[str, bytes | None] = {}
        for column, (name, _size) in zip(self.frame.asked.columns, self.marks.chunks(block), strict=True):
            values = results[column.name].reshape(extent + column.shape)
            self._arrays[column.name][(*region, *[slice(None)] * len(column.shape))] = values
            chunk = self._written.pop(name, None)
            contents[name] = None if chunk is None else chunk.to_bytes()
        for name, content in contents.items():
            # a chunk of empty numbers has no file
            if content is None:
                self.storage.remove(name)
            else:
                self.storage.write(name, content)
        self.marks.write(block, tally, contents)


class Store:
    """An open store; only the process that holds its lock has one."""

    def __init__(self, storage: Storage, frame: SweepFrame, blocks: Blocks, thorough: bool) -> None:
        self.storage = storage
        self.frame = frame
        self.blocks = blocks
        self.writer = BlockWriter(storage, frame, blocks)
        self._room = StreamedColumns()
        self._roomy = 0
        self.tally = Tally()
        # a byte a block: a set of a million numbers takes sixty times as much
        self._done = bytearray(len(blocks))
        damaged = []
        for block, tally in self.writer.marks.read(thorough):
            if tally is None:
                damaged.append(block)
            else:
                self._done[block] = True
                self.tally.add(tally)
        if damaged:
            warnings.warn(f"{storage}: {self._damage_sentence(sorted(damaged))}", DamageWarning, stacklevel=5)

    def _damage_sentence(self, damaged: list[int]) -> str:
        """A sentence that names damaged blocks."""
        named = []
        for block in damaged[:NAMED]:
            first, stop = self.blocks.mechanisms(block)
            named.append(_("{block} (mechanisms {first} to {last})").format(
                block=block, first=first, last=stop - 1
            ))  # fmt: skip
        if len(damaged) > NAMED:
            named.append(_("and {count} more").format(count=len(damaged) - NAMED))
        what = ngettext(
            "{n} block is damaged and is computed again: {blocks}",
            "{n} blocks are damaged and are computed again: {blocks}",
            len(damaged),
        )
        return what.format(n=len(damaged), blocks=", ".join(named))

    def has(self, block: int) -> bool:
        return bool(self._done[block])

    def room(self, block: int) -> StreamedColumns:
        first, stop = self.blocks.mechanisms(block)
        if stop - first > self._roomy:
            self._room, self._roomy = self.frame.room(stop - first), stop - first
        return self._room.part(slice(0, stop - first))

    def put(self, block: int, results: Mapping[str, AnyArray], tally: Tally) -> None:
        with place_refusals(str(self.storage)):
            self.writer.write(block, results, tally)
        self.take(block, tally)

    def take(self, block: int, tally: Tally) -> None:
        """Count a block in that another process has written."""
        if not self._done[block]:
            self._done[block] = True
            self.tally.add(tally)


@contextmanager
def open_store(
    storage: Storage,
    frame: SweepFrame,
    blocks: Callable[[], Blocks],
    study: Mapping[str, Any],
    *,
    thorough: bool = True,
) -> Iterator[Store]:
    """The store of a sweep, made (with the blocks that `blocks` gives) or found; nobody else holds it meanwhile.

    Blocks that are damaged are named in a DamageWarning, and are not done; without `thorough` chunks are not read.
    Raises InputError: zarr is not installed, the place holds something else, another sweep or a file that was read,
    another run writes into it, the place refuses.
    """
    if importlib.util.find_spec("zarr") is None:
        what = _("a store needs zarr, which is not installed")
        raise InputError(str(storage), what, how_to_install("sweeps"))
    with place_refusals(str(storage)):
        storage.prepare()
    with storage.lock():
        with place_refusals(str(storage)):
            stored = _stored_study(storage)
            if stored is None:
                made = blocks()
                _make(storage, frame, made, study)
            else:
                _refuse_other_studies(storage, stored, study)
                # the store's own division counts: another version may have chosen otherwise
                made = _blocks_of(stored, storage, frame)
                # metadata are compared with what this sweep would write, before zarr reads any of it
                _refuse_damaged_files(storage, _empty_store(frame, made), stored["files"])
                storage.tidy()
            store = Store(storage, frame, made, thorough)
        yield store


def read_store(storage: Storage, frame: SweepFrame) -> xr.Dataset:
    """The result in a store; numbers are read when they are used, coordinates are those of the sweep."""
    # coordinates come from the sweep itself
    coordinates = frame.labels
    stored = list(map(str, frame.empty.coords))
    data = xr.open_zarr(storage.for_zarr(), chunks=None, drop_variables=stored)
    # a folder has no order of its own
    return xr.Dataset(
        {column.name: data[column.name] for column in frame.asked.columns}, coordinates, data.attrs
    )


def _stored_study(storage: Storage) -> dict[str, Any] | None:
    """Description of its sweep in a store; None where its making was cut short, or has not begun."""
    if not storage.exists(f"{PROGRESS}/{STUDY}"):
        return None
    told = table_of(storage.read(f"{PROGRESS}/{STUDY}")) or {}
    try:
        return {"study": dict(told["study"]), "blocks": told["blocks"], "files": dict(told.get("files", {}))}
    except (ValueError, KeyError, TypeError):
        raise _damage_error(storage) from None


def _blocks_of(found: Mapping[str, Any], storage: Storage, frame: SweepFrame) -> Blocks:
    """The blocks that a store says it has; InputError where there cannot be such."""
    try:
        axis, step = map(int, found["blocks"])
    except (ValueError, TypeError, OverflowError):
        raise _damage_error(storage) from None
    shape = frame.design.shape
    if not (0 <= axis < len(shape) and 1 <= step <= shape[axis]):
        raise _damage_error(storage)
    blocks = Blocks(shape, axis, step)
    if _too_great(blocks, frame):
        raise _damage_error(storage)
    return blocks


def _damage_error(storage: Storage, name: str = f"{PROGRESS}/{STUDY}") -> InputError:
    what = _("{file} in it is damaged").format(file=name)
    return InputError(str(storage), what, _("delete the folder, or give another path"))


def _too_great(blocks: Blocks, frame: SweepFrame) -> bool:
    """Whether a block would take more memory than those that a sweep makes."""
    _first, stop = blocks.mechanisms(0)
    each = max(1, sum(column.bytes for column in frame.asked.columns))
    return stop > max(1, designs.BLOCK_BYTES // each)


def study_of(frame: SweepFrame, task: SweepTask, target: str | None) -> dict[str, Any]:
    """Facts that must be the same for a run to go on: all that the numbers depend on."""
    asked, parameter = task.asked, task.span.parameter
    told = frame.empty.attrs
    return {
        "version": told["version"],
        "mechanism": told["mechanism"],
        "vary": path_digests(frame.design),
        "samples": [len(parameter), float(parameter[0]), float(parameter[-1])],
        "outputs": [output.name for output in asked.outputs],
        "reduce": {
            formula.name: [formula.text.text, formula.reduction] if formula.reduction else formula.text.text
            for formula in asked.formulas
        }
        or asked.reduction,
        "tables": {name: table.digest for name, table in asked.tables.items()} or None,
        "gradient": bool(asked.slopes),
        "executor": bare(told["executor"]),
        "target": target,
    }


SHORT = 40
"""Letters of a value that is told where two studies differ."""


def _refuse_other_studies(storage: Storage, found: Mapping[str, Any], study: Mapping[str, Any]) -> None:
    other = [key for key in study if found["study"].get(key) != study[key]]
    if not other:
        return
    what = _("it holds another sweep; what differs: {keys}")
    keys = ", ".join(_difference(key, found["study"].get(key), study[key]) for key in other)
    raise InputError(str(storage), what.format(keys=keys), _("give another path, or delete it"))


def _difference(key: str, there: object, here: object) -> str:
    """A key of two studies, with both values where they are names."""
    if all(value is None or (isinstance(value, str) and 0 < len(value) <= SHORT) for value in (there, here)):
        return f"{key} ({there or '-'} / {here or '-'})"
    return key


def _make(storage: Storage, frame: SweepFrame, blocks: Blocks, study: Mapping[str, Any]) -> None:
    """Make the arrays, without numbers, and keep what they are of; what is left of a making cut short is removed."""
    files = _empty_store(frame, blocks)
    names = {column.name for column in frame.asked.columns}
    # a making cut short left no study, so nothing there counts
    storage.make(files, {METADATA, *map(str, frame.empty.coords), *names})
    # in one order: zarr writes them as they come
    checksums = {name: hashlib.sha256(files[name]).hexdigest() for name in sorted(files)}
    told = {"study": study, "blocks": [blocks.axis, blocks.step], "files": checksums}
    storage.write_durably(f"{PROGRESS}/{STUDY}", told)


def _refuse_damaged_files(storage: Storage, files: Mapping[str, bytes], checksums: Mapping[str, Any]) -> None:
    """InputError where metadata or labels are not those that the store was made with."""
    for name, content in files.items():
        if not _as_made(storage, name, content, checksums.get(name)):
            raise _damage_error(storage, name)


def _as_made(storage: Storage, name: str, content: bytes, checksum: object) -> bool:
    """Whether an object holds what a making writes: metadata of the same meaning, labels as they were written."""
    stored = storage.read(name, 2 * len(content) + GREATEST)
    if stored is None or stored == content:
        return stored is not None
    if PurePosixPath(name).name != METADATA:
        # on another machine coordinates may differ in their last bits
        return hashlib.sha256(stored).hexdigest() == checksum
    try:
        return bool(json.loads(stored) == json.loads(content))
    except (ValueError, RecursionError):
        return False


def _empty_store(frame: SweepFrame, blocks: Blocks) -> dict[str, bytes]:
    """The files of the store before there are results: metadata, coordinates."""
    files: dict[str, Any] = {}
    memory = _storage().MemoryStore(files)
    root = _zarr().open_group(memory, mode="a", zarr_format=FORMAT)
    root.create_group(PROGRESS)
    frame.empty.to_zarr(memory, mode="a", zarr_format=FORMAT, consolidated=False)
    _empty_arrays(memory, frame, blocks)
    with warnings.catch_warnings():
        # the metadata in one place, for readers; zarr warns that this is new
        warnings.simplefilter("ignore")
        _zarr().consolidate_metadata(memory, zarr_format=FORMAT)
    return {name: content.to_bytes() for name, content in files.items()}


def _empty_arrays(memory: Any, frame: SweepFrame, blocks: Blocks) -> Any:
    """The group with the arrays of the columns, without numbers."""
    root = _zarr().open_group(memory, mode="a", zarr_format=FORMAT)
    for column in frame.asked.columns:
        root.create_array(
            column.name,
            shape=frame.design.shape + column.shape,
            chunks=tuple(max(1, extent) for extent in blocks.chunk + column.shape),
            dtype=column.kind,
            compressors=_codecs().Crc32cCodec(),  # any reader tells a damaged chunk by it
            fill_value=column.empty,
            dimension_names=frame.design.dimensions + column.dimensions,
            attributes=dict(column.attributes),
        )
    return root
