"""Results of a sweep in a folder (zarr), block by block: a run that was killed goes on where it was.

A block's numbers are written first, then its mark, by a rename that happens or does not. What has no mark, or differs
from what its mark says, is computed again. Beside the zarr arrays stands the group `progress` with the lock, the study
and the marks.

Nothing in a folder is trusted for being there: metadata have to be those that this sweep has, chunks have their size
(they are not compressed, so nothing can unpack to more), small files are read up to a bound.
"""

from __future__ import annotations

import functools
import hashlib
import importlib.util
import json
import re
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

import lazy_loader
import numpy.typing as npt
import xarray as xr

from centrode.errors import DamageWarning, InputError
from centrode.files.drafts import clear_drafts, clear_folder, draft_folder, refusals, remove_file, write_whole
from centrode.files.inputs import keep_inputs_below
from centrode.files.locks import locked
from centrode.locale import _, ngettext
from centrode.sweeps import limits
from centrode.sweeps.arrays import Task
from centrode.sweeps.blocks import Blocks
from centrode.sweeps.designs import described
from centrode.sweeps.executors import bare
from centrode.sweeps.marks import GREATEST, Marks, read_bounded, read_small
from centrode.sweeps.results import Frame
from centrode.sweeps.streams import Columns
from centrode.sweeps.tallies import Tally

AnyArray: TypeAlias = npt.NDArray[Any]

PROGRESS, LOCK, STUDY, DONE = "progress", "lock", "study.json", "done"
METADATA = "zarr.json"
FORMAT = 3
DRAFT = re.compile(r"(?:.*\.)?[0-9a-f]{32}\.partial|zarr\.[\w.]*partial")
"""Name under which zarr writes a file before it renames it."""
NAMED = 5
"""Damaged blocks that a warning names at most."""

_zarr = functools.partial(lazy_loader.load, "zarr")  # an extra, and slower to import than NumPy
_codecs = functools.partial(lazy_loader.load, "zarr.codecs")
_storage = functools.partial(lazy_loader.load, "zarr.storage")


class Store:
    """An open store; only the process that holds its lock has one."""

    def __init__(self, path: Path, frame: Frame, blocks: Blocks) -> None:
        self.frame = frame
        self.blocks = blocks
        self.marks = Marks(path / PROGRESS / DONE, path, frame.asked.columns, blocks)
        root = _zarr().open_group(str(path), mode="r+", zarr_format=FORMAT)
        self.arrays = {column.name: root[column.name] for column in frame.asked.columns}
        self._room = Columns()
        self._roomy = 0
        done, damaged = self.marks.read()
        self.tally = Tally()
        for block in sorted(done):
            self.tally.add(done[block])
        self.done = set(done)
        if damaged:
            warnings.warn(f"{path}: {self._told(damaged)}", DamageWarning, stacklevel=5)

    def _told(self, damaged: list[int]) -> str:
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
        return block in self.done

    def room(self, block: int) -> Columns:
        first, stop = self.blocks.mechanisms(block)
        if stop - first > self._roomy:
            self._room, self._roomy = self.frame.room(stop - first), stop - first
        return self._room.part(slice(0, stop - first))

    def put(self, block: int, results: Mapping[str, AnyArray], tally: Tally) -> None:
        region = self.blocks.region(block)
        extent = tuple(along.stop - along.start for along in region)
        self.marks.remove_chunks(block)
        for column in self.frame.asked.columns:
            values = results[column.name].reshape(extent + column.shape)
            self.arrays[column.name][(*region, *[slice(None)] * len(column.shape))] = values
        self.marks.write(block, tally)
        self.done.add(block)
        self.tally.add(tally)


@contextmanager
def opened(path: Path, frame: Frame, blocks: Blocks, task: Task) -> Iterator[Store]:
    """The store of a sweep, made or found; nobody else writes into it while the block runs.

    Blocks that are damaged are named in a DamageWarning, and are not done. Raises InputError: zarr is not installed,
    the folder holds something else, another sweep or a file that was read, another run writes into it, the operating
    system refuses.
    """
    if importlib.util.find_spec("zarr") is None:
        what = _("a store needs zarr, which is not installed")
        raise InputError(str(path), what, _('install it with pip install "centrode[sweeps]"'))
    with refusals(path):
        _refuse_other_folders(path)
        keep_inputs_below(path)
        (path / PROGRESS).mkdir(parents=True, exist_ok=True)
    with locked(path / PROGRESS / LOCK, str(path)):
        with refusals(path):
            study = _study(frame, task)
            found = _found(path)
            if found is None:
                _make(path, frame, blocks, study)
            else:
                _refuse_other_studies(path, found, study)
                blocks = _blocks_of(found, path, frame)
                _refuse_damaged_files(path, _empty_store(frame, blocks), found["files"])
                _remove_drafts(path)
        yield Store(path, frame, blocks)


def read(path: Path, frame: Frame) -> xr.Dataset:
    """The result in a store; numbers are read when they are used, coordinates are those of the sweep."""
    coordinates = frame.empty.coords
    data = xr.open_zarr(str(path), chunks=None, drop_variables=list(map(str, coordinates)))
    # a folder has no order of its own
    return xr.Dataset(
        {column.name: data[column.name] for column in frame.asked.columns}, coordinates, data.attrs
    )


def _refuse_other_folders(path: Path) -> None:
    if path.exists() and not path.is_dir():
        raise InputError(str(path), _("is no folder"), _("name another place"))
    if not path.exists() or not any(path.iterdir()):
        return
    progress = path / PROGRESS
    begun = [entry.name for entry in path.iterdir()] == [PROGRESS] and not any(progress.iterdir())
    if not begun and not (progress / LOCK).is_file():
        raise InputError(str(path), _("the folder holds something else"), _("name another place"))


def _found(path: Path) -> dict[str, Any] | None:
    """What the store says of its sweep; None where its making was cut short, or has not begun."""
    file = path / PROGRESS / STUDY
    if not file.exists():
        return None
    told = read_small(file) or {}
    try:
        return {"study": dict(told["study"]), "blocks": told["blocks"], "files": dict(told.get("files", {}))}
    except (ValueError, KeyError, TypeError):
        raise _damaged(path) from None


def _blocks_of(found: Mapping[str, Any], path: Path, frame: Frame) -> Blocks:
    """The blocks that a store says it has; InputError where there cannot be such."""
    try:
        axis, step = map(int, found["blocks"])
    except (ValueError, TypeError, OverflowError):
        raise _damaged(path) from None
    shape = frame.design.shape
    if not (0 <= axis < len(shape) and 1 <= step <= shape[axis]):
        raise _damaged(path)
    blocks = Blocks(shape, axis, step)
    if _too_great(blocks, frame):
        raise _damaged(path)
    return blocks


def _damaged(path: Path, name: str = f"{PROGRESS}/{STUDY}") -> InputError:
    what = _("{file} in it is damaged").format(file=name)
    return InputError(str(path), what, _("delete the folder, or name another place"))


def _too_great(blocks: Blocks, frame: Frame) -> bool:
    """Whether a block would take more memory than those that a sweep makes."""
    _first, stop = blocks.mechanisms(0)
    each = max(1, sum(column.bytes for column in frame.asked.columns))
    return stop > max(1, limits.BLOCK_BYTES // each)


def _study(frame: Frame, task: Task) -> dict[str, Any]:
    """What must be the same for a run to go on: all that the numbers depend on."""
    asked, parameter = task.asked, task.span.parameter
    told = frame.empty.attrs
    return {
        "version": told["version"],
        "mechanism": told["mechanism"],
        "vary": described(frame.design),
        "samples": [len(parameter), float(parameter[0]), float(parameter[-1])],
        "outputs": [output.name for output in asked.outputs],
        "reduce": {formula.name: formula.text.text for formula in asked.formulas} or asked.reduction,
        "gradient": bool(asked.slopes),
        "executor": bare(told["executor"]),
    }


def _refuse_other_studies(path: Path, found: Mapping[str, Any], study: Mapping[str, Any]) -> None:
    other = [key for key in study if found["study"].get(key) != study[key]]
    if not other:
        return
    what = _("it holds another sweep; what differs: {keys}").format(keys=", ".join(other))
    raise InputError(str(path), what, _("name another place, or delete it"))


def _make(path: Path, frame: Frame, blocks: Blocks, study: Mapping[str, Any]) -> None:
    """Make the arrays, without numbers, and keep what they are of; what is left of a making cut short is removed."""
    _clear(path, frame)
    files = _empty_store(frame, blocks)
    with draft_folder(path) as draft:
        for name, content in files.items():
            (draft / name).parent.mkdir(parents=True, exist_ok=True)
            (draft / name).write_bytes(content)
    checksums = {name: hashlib.sha256(content).hexdigest() for name, content in files.items()}
    told = {"study": study, "blocks": [blocks.axis, blocks.step], "files": checksums}
    write_whole(path / PROGRESS / STUDY, told)


def _clear(path: Path, frame: Frame) -> None:
    """Remove what is left of a making that was cut short; InputError where there is anything else."""
    clear_drafts(path)
    names = {column.name for column in frame.asked.columns}
    ours = {METADATA, PROGRESS, *map(str, frame.empty.coords), *names}
    remains = [entry for entry in path.iterdir() if entry.name != PROGRESS]
    if any(entry.name not in ours and not DRAFT.fullmatch(entry.name) for entry in remains):
        raise InputError(str(path), _("the folder holds something else"), _("name another place"))
    for entry in (*remains, path / PROGRESS / METADATA, path / PROGRESS / DONE):
        if entry.is_dir() and not entry.is_symlink():
            clear_folder(entry)
        else:
            remove_file(entry)


def _remove_drafts(path: Path) -> None:
    """Remove what zarr was writing in a run that was killed."""
    for draft in path.rglob("*.partial"):
        if DRAFT.fullmatch(draft.name):
            remove_file(draft)


def _refuse_damaged_files(path: Path, files: Mapping[str, bytes], checksums: Mapping[str, Any]) -> None:
    """InputError where metadata or labels are not those that the store was made with."""
    for name, content in files.items():
        if not _as_made(path / name, content, checksums.get(name)):
            raise _damaged(path, name)


def _as_made(file: Path, content: bytes, checksum: object) -> bool:
    """Whether a file holds what a making writes: metadata of the same meaning, labels as they were written."""
    found = read_bounded(file, 2 * len(content) + GREATEST)
    if found is None or found == content:
        return found is not None
    if file.name != METADATA:
        # on another machine coordinates may differ in their last bits
        return hashlib.sha256(found).hexdigest() == checksum
    try:
        return bool(json.loads(found) == json.loads(content))
    except (ValueError, RecursionError):
        return False


def _empty_store(frame: Frame, blocks: Blocks) -> dict[str, bytes]:
    """The files of the store before there are results: metadata, coordinates."""
    files: dict[str, Any] = {}
    memory = _storage().MemoryStore(files)
    root = _zarr().open_group(memory, mode="a", zarr_format=FORMAT)
    root.create_group(PROGRESS)
    frame.empty.to_zarr(memory, mode="a", zarr_format=FORMAT, consolidated=False)
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
    with warnings.catch_warnings():
        # the metadata in one place, for readers; zarr warns that this is new
        warnings.simplefilter("ignore")
        _zarr().consolidate_metadata(memory, zarr_format=FORMAT)
    return {name: content.to_bytes() for name, content in files.items()}
