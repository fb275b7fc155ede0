"""Results of a sweep in a folder (zarr), block by block: a run that was killed goes on where it was.

A block's numbers are written first, then its marker, by a rename that happens or does not. What has no marker is
computed again. Beside the zarr arrays stands the group `progress` with the lock, the study and the markers.
"""

from __future__ import annotations

import functools
import importlib.util
import json
import os
import re
import shutil
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, TypeAlias

import lazy_loader
import numpy.typing as npt
import xarray as xr

from centrode.errors import InputError
from centrode.locale import _
from centrode.sweeps.arrays import Task
from centrode.sweeps.blocks import Blocks
from centrode.sweeps.designs import described
from centrode.sweeps.executors import bare
from centrode.files.locks import locked
from centrode.sweeps.results import Frame
from centrode.sweeps.streams import Columns
from centrode.sweeps.tallies import Tally

AnyArray: TypeAlias = npt.NDArray[Any]

PROGRESS, LOCK, STUDY, DONE = "progress", "lock", "study.json", "done"
FORMAT = 3
DRAFT = re.compile(r"zarr\.[\w.]*partial")
"""Name under which zarr writes metadata before it renames them."""
TOGETHER = 1000
"""Markers in one folder."""

_zarr = functools.partial(lazy_loader.load, "zarr")  # an extra, and slower to import than NumPy


class Store:
    """An open store; only the process that holds its lock has one."""

    def __init__(self, path: Path, frame: Frame, blocks: Blocks) -> None:
        self.frame = frame
        self.blocks = blocks
        self.markers = path / PROGRESS / DONE
        root = _zarr().open_group(str(path), mode="r+", zarr_format=FORMAT)
        self.arrays = {column.name: root[column.name] for column in frame.asked.columns}
        self.tally = Tally()
        self.done: set[int] = set()
        self._room = Columns()
        self._roomy = 0
        for block, tally in _marked(self.markers):
            self.done.add(block)
            self.tally.add(tally)

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
        for column in self.frame.asked.columns:
            values = results[column.name].reshape(extent + column.shape)
            self.arrays[column.name][(*region, *[slice(None)] * len(column.shape))] = values
        folder = self.markers / str(block // TOGETHER)
        folder.mkdir(parents=True, exist_ok=True)
        write_whole(folder / f"{block}.json", tally.as_dict())
        self.done.add(block)
        self.tally.add(tally)


def write_whole(file: Path, told: Mapping[str, Any]) -> None:
    """Write a small file of JSON so that it is there whole or not at all."""
    draft = file.with_suffix(".draft")
    with draft.open("w", encoding="utf-8") as stream:
        json.dump(told, stream)
        stream.flush()
        os.fsync(stream.fileno())
    os.replace(draft, file)


def _marked(markers: Path) -> Iterator[tuple[int, Tally]]:
    """Blocks that are done; a marker that cannot be read counts for nothing."""
    for file in markers.glob("*/*.json"):
        try:
            yield int(file.stem), Tally.from_dict(json.loads(file.read_text(encoding="utf-8")))
        except (ValueError, KeyError, TypeError):
            continue


@contextmanager
def opened(path: Path, frame: Frame, blocks: Blocks, task: Task) -> Iterator[Store]:
    """The store of a sweep, made or found; nobody else writes into it while the block runs.

    Raises InputError: zarr is not installed, the folder holds something else or another sweep, another run writes
    into it, the operating system refuses.
    """
    if importlib.util.find_spec("zarr") is None:
        what = _("a store needs zarr, which is not installed")
        raise InputError(str(path), what, _('install it with pip install "centrode[sweeps]"'))
    try:
        _refuse_other_folders(path)
        (path / PROGRESS).mkdir(parents=True, exist_ok=True)
    except OSError as refusal:
        reason = refusal.strerror or str(refusal)
        what = _("cannot be written: {reason}").format(reason=reason)
        raise InputError(str(path), what, _("name another place")) from refusal
    with locked(path / PROGRESS / LOCK, str(path)):
        study = _study(frame, task)
        found = _found(path)
        if found is None:
            _make(path, frame, blocks)
            write_whole(path / PROGRESS / STUDY, {"study": study, "blocks": [blocks.axis, blocks.step]})
        else:
            _refuse_other_studies(path, found, study)
            blocks = Blocks(frame.design.shape, *found["blocks"])
        yield Store(path, frame, blocks)


def read(path: Path, frame: Frame) -> xr.Dataset:
    """The result in a store; numbers are read when they are asked for."""
    data = xr.open_zarr(str(path), chunks=None)
    # a folder has no order of its own
    return xr.Dataset(
        {column.name: data[column.name] for column in frame.asked.columns}, data.coords, data.attrs
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
    try:
        told = json.loads(file.read_text(encoding="utf-8"))
        axis, step = told["blocks"]
        return {"study": dict(told["study"]), "blocks": (int(axis), int(step))}
    except (ValueError, KeyError, TypeError):
        damaged = _("{file} in it is damaged").format(file=f"{PROGRESS}/{STUDY}")
        raise InputError(str(path), damaged, _("delete the folder, or name another place")) from None


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


def _make(path: Path, frame: Frame, blocks: Blocks) -> None:
    """Make the arrays, without numbers; remains of a making that was cut short are taken away first."""
    columns = frame.asked.columns
    ours = {"zarr.json", PROGRESS, *map(str, frame.empty.coords), *(column.name for column in columns)}
    remains = [entry for entry in path.iterdir() if entry.name != PROGRESS]
    if any(entry.name not in ours and not DRAFT.fullmatch(entry.name) for entry in remains):
        raise InputError(str(path), _("the folder holds something else"), _("name another place"))
    for entry in remains:
        shutil.rmtree(entry) if entry.is_dir() else entry.unlink()
    (path / PROGRESS / "zarr.json").unlink(missing_ok=True)
    root = _zarr().open_group(str(path), mode="a", zarr_format=FORMAT)
    root.create_group(PROGRESS)
    frame.empty.to_zarr(str(path), mode="a", zarr_format=FORMAT, consolidated=False)
    for column in columns:
        root.create_array(
            column.name,
            shape=frame.design.shape + column.shape,
            chunks=tuple(max(1, extent) for extent in blocks.chunk + column.shape),
            dtype=column.kind,
            fill_value=column.empty,
            dimension_names=frame.design.dimensions + column.dimensions,
            attributes=dict(column.attributes),
        )
    with warnings.catch_warnings():
        # the metadata in one place, for readers; zarr warns that this is new, and of the lock that is none of its own
        warnings.simplefilter("ignore")
        _zarr().consolidate_metadata(str(path), zarr_format=FORMAT)
