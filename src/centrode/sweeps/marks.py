"""Marks of the blocks of a store that are done: what each came to, with a checksum of it and of the block's chunks.

A mark holds for exactly what was written: a chunk that was cut off, changed or taken away, a mark of another block or
one that was edited give another checksum, and the block counts as damaged.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import stat
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from centrode.errors import InputError
from centrode.files.drafts import remove_file, write_whole
from centrode.locale import _
from centrode.sweeps.asked import Column
from centrode.sweeps.blocks import Blocks
from centrode.sweeps.tallies import Tally

GREATEST = 8_000_000
"""Bytes of a small file of a store; a mark has some hundreds, the study holds the mechanism as text."""
PIECE = 1 << 20
"""Bytes of a chunk that are read at once."""
CHECK = 4
"""Bytes that the codec `crc32c` puts behind the numbers of a chunk."""
TOGETHER = 1000
"""Marks in one folder."""


class Marks:
    """The marks of a store whose columns are kept in chunks, a chunk of each column for every block."""

    def __init__(self, folder: Path, store: Path, columns: Sequence[Column], blocks: Blocks) -> None:
        self.folder = folder
        self.store = store
        self.columns = columns
        self.blocks = blocks

    def chunks(self, block: int) -> Iterator[tuple[Path, int]]:
        """File of a block's chunk in each column, and the bytes that it has if it is there."""
        extents = self.blocks.chunk
        place = [
            str(along.start // extent)
            for along, extent in zip(self.blocks.region(block), extents, strict=True)
        ]
        for column in self.columns:
            inner = ["0"] * len(column.shape)
            size = math.prod(extents) * column.bytes + CHECK
            yield self.store.joinpath(column.name, "c", *place, *inner), size

    def remove_chunks(self, block: int) -> None:
        """Remove a block's chunks: what is there must not be read where zarr writes a part of a chunk.

        Raises InputError where one of them is a file that was read.
        """
        for file, _size in self.chunks(block):
            remove_file(file)

    def write(self, block: int, tally: Tally) -> None:
        """Mark a block whose chunks are written."""
        told = tally.as_dict()
        checksum = self._checksum(block, told)
        if checksum is None:
            what = _("block {block} cannot be read back").format(block=block)
            raise InputError(str(self.store), what, _("name another place"))
        folder = self.folder / str(block // TOGETHER)
        folder.mkdir(parents=True, exist_ok=True)
        write_whole(folder / f"{block}.json", {"tally": told, "sha256": checksum})

    def read(self) -> tuple[dict[int, Tally], list[int]]:
        """Tallies of the blocks that are done, and the blocks that are damaged.

        A mark that cannot be read, or is no mark of a block, counts for nothing.
        """
        done: dict[int, Tally] = {}
        damaged: list[int] = []
        for file in self.folder.glob("*/*.json"):
            block = self._block(file)
            told = read_small(file)
            if block is None or told is None or not isinstance(told.get("sha256"), str):
                continue
            tally = self._tally(block, told.get("tally"))
            if tally is not None and told["sha256"] == self._checksum(block, tally.as_dict()):
                done[block] = tally
            else:
                damaged.append(block)
        return done, sorted(damaged)

    def _block(self, file: Path) -> int | None:
        """The block whose mark has this name, if any has."""
        if not (file.stem.isascii() and file.stem.isdigit()) or len(file.stem) > len(str(len(self.blocks))):
            return None
        block = int(file.stem)
        own = block < len(self.blocks) and file.parent.name == str(block // TOGETHER)
        return block if own and file.stem == str(block) else None

    def _tally(self, block: int, told: object) -> Tally | None:
        """The tally in a mark; None where it is none of this block."""
        first, stop = self.blocks.mechanisms(block)
        components = {column.name: math.prod(column.shape) for column in self.columns}
        try:
            tally = Tally.from_dict(told, components)  # type: ignore[arg-type]
        except (ValueError, KeyError, TypeError, OverflowError, AttributeError):
            return None
        return tally if tally.mechanisms == stop - first else None

    def _checksum(self, block: int, told: Mapping[str, Any]) -> str | None:
        """Checksum of a block's tally and chunks; None where a file is no chunk.

        A chunk that holds nothing but empty numbers has no file.
        """
        found = hashlib.sha256(json.dumps([block, told], sort_keys=True).encode())
        for file, size in self.chunks(block):
            try:
                status = file.stat()
                if not stat.S_ISREG(status.st_mode) or status.st_size != size:
                    return None
                with file.open("rb") as stream:
                    found.update(b"chunk")
                    for piece in iter(lambda: stream.read(PIECE), b""):
                        found.update(piece)
            except (FileNotFoundError, NotADirectoryError):
                found.update(b"none")
            except OSError:
                return None
        return found.hexdigest()


def read_small(file: Path) -> dict[str, Any] | None:
    """A small file of JSON that holds a table; None where it is anything else, or cannot be read."""
    content = read_bounded(file, GREATEST)
    if content is None:
        return None
    try:
        told = json.loads(content)
    except (ValueError, RecursionError):
        return None
    return told if isinstance(told, dict) else None


def read_bounded(file: Path, most: int) -> bytes | None:
    """Bytes of a regular file; None where it is none, cannot be read or has more than `most`."""
    try:
        status = os.stat(file)
        if not stat.S_ISREG(status.st_mode) or status.st_size > most:
            return None
        with file.open("rb") as stream:
            content = stream.read(most + 1)
    except OSError:
        return None
    return content if len(content) <= most else None
