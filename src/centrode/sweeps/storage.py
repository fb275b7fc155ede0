"""Where the store of a sweep stands: a folder, or a place in an object store (`s3://...`) that fsspec knows.

What a store needs of its place is little: objects that appear whole or not at all, a list of marks, and a lock.
All functions raise OSError where the place refuses; `files.drafts.refusals` says it to the user.
"""

from __future__ import annotations

import functools
import importlib
import importlib.util
import json
import os
import re
import socket
import stat
import threading
import time
import uuid
from collections.abc import Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path
from typing import Any, Protocol

from centrode.errors import InputError
from centrode.files.drafts import (
    clear_drafts,
    clear_folder,
    draft_folder,
    refusals,
    remove_file,
    replace_file,
)
from centrode.files.inputs import keep_inputs_below
from centrode.files.locks import hold_lock
from centrode.locale import _
from centrode.optional_packages import how_to_install

GREATEST = 8_000_000
"""Bytes of a small object of a store; a mark has some hundreds, the study holds the mechanism as text."""
PIECE = 1 << 20
"""Bytes of a file that are read at once."""
PROGRESS, LOCK, DONE = "progress", "lock", "done"
METADATA = "zarr.json"
DRAFT = re.compile(r"(?:.*\.)?[0-9a-f]{32}\.partial|zarr\.[\w.]*partial")
"""Name under which a file is written before it is renamed, by this module and by zarr."""


class Storage(Protocol):
    """The place of a store. Names of objects are parted by "/"."""

    reads_back: bool
    """Whether what is written is read again to be sure; an object store keeps checksums itself."""

    @property
    def url(self) -> str:
        """Text from which another process has the same place."""

    def prepare(self) -> None:
        """Make the place; InputError where it is none, or holds something else."""

    def lock(self) -> AbstractContextManager[None]:
        """Hold the place for this run alone while the block runs; InputError where another run does."""

    def exists(self, name: str) -> bool:
        """Whether there is an object of a name, or anything else."""

    def read(self, name: str, most: int = GREATEST) -> bytes | None:
        """Bytes of an object; None where there is none, or it has more than `most`."""

    def write(self, name: str, content: bytes) -> None:
        """Put an object, whole or not at all."""

    def write_durably(self, name: str, told: Mapping[str, Any]) -> None:
        """Put a small table, so that it outlives a loss of power."""

    def remove(self, name: str) -> None:
        """Remove an object, if it is there."""

    def marks(self, under: str) -> Iterator[tuple[str, dict[str, Any] | None]]:
        """(name, table) of the small objects two levels under a name; None where one is no table."""

    def pieces(self, name: str, size: int) -> Iterator[bytes] | None:
        """The content of an object of this size, piece by piece; None where it is no such object.

        Raises FileNotFoundError where there is none.
        """

    def make(self, files: Mapping[str, bytes], own: set[str]) -> None:
        """Put the first objects; what is left of a making cut short (names in `own`) is removed before."""

    def tidy(self) -> None:
        """Remove what a run that was killed was writing."""

    def for_zarr(self) -> Any:
        """What zarr opens."""


def storage_of(place: str | Path) -> Storage:
    """The place that a path or an address names; InputError where what it needs is not installed."""
    text = str(place)
    if text.startswith("file://"):
        text = text.removeprefix("file://")
    elif "://" in text:
        if any(importlib.util.find_spec(name) is None for name in ("fsspec", "zarr")):
            what = _("an object store needs fsspec and zarr, which are not installed")
            raise InputError(text, what, how_to_install("cluster", "sweeps"))
        return ObjectStorage(text)
    return FolderStorage(Path(text))


def table_of(content: bytes | None) -> dict[str, Any] | None:
    """The table in a small object; None where it is anything else."""
    if content is None:
        return None
    try:
        told = json.loads(content)
    except (ValueError, RecursionError):
        return None
    return told if isinstance(told, dict) else None


@contextmanager
def place_refusals(place: str) -> Iterator[None]:
    """Say what the place of a store refuses as an InputError about it."""
    if "://" not in place:
        with refusals(Path(place)):
            yield
        return
    try:
        yield
    except OSError as refusal:
        reason = refusal.strerror or str(refusal)
        what = _("cannot be written: {reason}").format(reason=reason)
        repair = _("look at the address, and at the rights that the environment gives")
        raise InputError(place, what, repair) from refusal


# A folder.


class FolderStorage:
    """A folder of this machine, or one that all machines share."""

    reads_back = True

    def __init__(self, path: Path) -> None:
        self.path = path

    @property
    def url(self) -> str:
        return str(self.path.absolute())

    def __str__(self) -> str:
        return str(self.path)

    def prepare(self) -> None:
        self._refuse_other_folders()
        keep_inputs_below(self.path)
        (self.path / PROGRESS).mkdir(parents=True, exist_ok=True)

    def _refuse_other_folders(self) -> None:
        path = self.path
        if path.exists() and not path.is_dir():
            raise InputError(str(path), _("is not a folder"), _("give another path"))
        if not path.exists() or not any(path.iterdir()):
            return
        progress = path / PROGRESS
        # an empty `progress` alone is what an interrupted beginning leaves
        begun = [entry.name for entry in path.iterdir()] == [PROGRESS] and not any(progress.iterdir())
        if not begun and not (progress / LOCK).is_file():
            raise _foreign_error(str(path))

    def lock(self) -> AbstractContextManager[None]:
        return hold_lock(self.path / PROGRESS / LOCK, str(self.path))

    def exists(self, name: str) -> bool:
        return (self.path / name).exists()

    def read(self, name: str, most: int = GREATEST) -> bytes | None:
        return read_bounded(self.path / name, most)

    def write(self, name: str, content: bytes) -> None:
        file = self.path / name
        draft = file.with_name(f"{file.name}.{uuid.uuid4().hex}.partial")
        try:
            draft.write_bytes(content)
        except FileNotFoundError:
            file.parent.mkdir(parents=True, exist_ok=True)
            draft.write_bytes(content)
        try:
            replace_file(draft, file)
        except BaseException:
            draft.unlink(missing_ok=True)
            raise

    def write_durably(self, name: str, told: Mapping[str, Any]) -> None:
        file = self.path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        # a name of its own: two workers may write the same mark at once
        draft = file.with_name(f"{file.name}.{uuid.uuid4().hex}.partial")
        with draft.open("w", encoding="utf-8") as stream:
            json.dump(told, stream)
            stream.flush()
            os.fsync(stream.fileno())
        replace_file(draft, file)

    def remove(self, name: str) -> None:
        remove_file(self.path / name)

    def marks(self, under: str) -> Iterator[tuple[str, dict[str, Any] | None]]:
        # any file may lie there; texts and not paths, as there may be a hundred thousand
        for folder in _folders_in(self.path / under):
            with os.scandir(folder) as entries:
                for entry in entries:
                    if entry.name.endswith(".json"):
                        yield (
                            f"{under}/{folder.name}/{entry.name}",
                            table_of(read_bounded(entry.path, GREATEST)),
                        )

    def pieces(self, name: str, size: int) -> Iterator[bytes] | None:
        file = f"{self.path}/{name}"
        try:
            status = os.stat(file)
        except NotADirectoryError as none:
            raise FileNotFoundError(file) from none
        # a size that is wrong says so without reading
        if not stat.S_ISREG(status.st_mode) or status.st_size != size:
            return None
        return _pieces_of(file)

    def make(self, files: Mapping[str, bytes], own: set[str]) -> None:
        self._clear(own)
        # in a draft that is renamed as a whole
        with draft_folder(self.path) as draft:
            for name, content in files.items():
                (draft / name).parent.mkdir(parents=True, exist_ok=True)
                (draft / name).write_bytes(content)

    def _clear(self, own: set[str]) -> None:
        """Remove what is left of a making that was cut short; InputError where there is anything else."""
        path = self.path
        clear_drafts(path)
        remains = [entry for entry in path.iterdir() if entry.name != PROGRESS]
        if any(entry.name not in own and not DRAFT.fullmatch(entry.name) for entry in remains):
            raise _foreign_error(str(path))
        for entry in (*remains, path / PROGRESS / METADATA, path / PROGRESS / DONE):
            if entry.is_dir() and not entry.is_symlink():
                clear_folder(entry)
            else:
                remove_file(entry)

    def tidy(self) -> None:
        for folder, _folders, files in os.walk(self.path):
            for name in files:
                if name.endswith(".partial") and DRAFT.fullmatch(name):
                    remove_file(Path(folder, name))

    def for_zarr(self) -> Any:
        return str(self.path)


def _foreign_error(place: str) -> InputError:
    return InputError(place, _("the folder holds something else"), _("give another path"))


def _folders_in(folder: Path) -> list[Path]:
    """The folders directly in a folder; none where there is no such folder."""
    try:
        with os.scandir(folder) as entries:
            return [Path(entry) for entry in entries if entry.is_dir()]
    except (FileNotFoundError, NotADirectoryError):
        return []


def _pieces_of(file: str) -> Iterator[bytes]:
    with open(file, "rb") as stream:
        yield from iter(lambda: stream.read(PIECE), b"")


def read_bounded(file: Path | str, most: int) -> bytes | None:
    """Bytes of a regular file; None where it is none, cannot be read or has more than `most`."""
    try:
        status = os.stat(file)
        if not stat.S_ISREG(status.st_mode) or status.st_size > most:
            return None
        with open(file, "rb", buffering=0) as stream:
            # one byte more than there was, as the file may have grown
            content = stream.read(status.st_size + 1)
    except OSError:
        return None
    return content if len(content) == status.st_size else None


# An object store.
#
# Nothing in it can be locked as a file is. So a lock is an object that is put only where there is none ("create"), and
# whose owner puts it anew as long as it lives. Each owner has a number of its own, so two that find a lock
# abandoned cannot both follow it.

LEASE = 120.0
"""Seconds after which a lock counts as abandoned that its owner has not renewed."""
BEAT = 20.0
"""Seconds between renewals."""
OWNERS = "progress/owners"
TOGETHER = 500
"""Marks that are read at once."""

BELOW = ("aiobotocore", "aiohttp", "asyncio", "botocore", "fsspec", "s3fs")
"""Libraries that an object store is reached by."""

_fsspec = functools.partial(importlib.import_module, "fsspec")
_zarr = functools.partial(importlib.import_module, "zarr")
_storage = functools.partial(importlib.import_module, "zarr.storage")


@contextmanager
def _as_refusals() -> Iterator[None]:
    """Failures of the libraries below as OSError: what is refused, and what cannot be reached."""
    try:
        yield
    except (OSError, InputError):
        raise
    except Exception as failure:
        if type(failure).__module__.partition(".")[0] in BELOW:
            raise OSError(str(failure) or type(failure).__name__) from failure
        raise


class ObjectStorage:
    """A place in an object store; rights and addresses are those of the environment (AWS_..., FSSPEC_...)."""

    reads_back = False

    def __init__(self, url: str) -> None:
        self.url = url.rstrip("/")
        try:
            with _as_refusals():
                self.files, self.root = _fsspec().url_to_fs(self.url)
        except ImportError as missing:
            library = (missing.name or str(missing)).partition(".")[0]
            what = _("this address needs {library}, which is not installed").format(library=library)
            raise InputError(url, what, how_to_install("cluster")) from missing
        except ValueError as unknown:
            what = _("this address is of no kind that is known: {reason}").format(reason=unknown)
            raise InputError(
                url, what, _("give a folder, or an address such as s3://bucket/sweep.zarr")
            ) from unknown

    def __str__(self) -> str:
        return self.url

    def _at(self, name: str) -> str:
        return f"{self.root}/{name}" if name else self.root

    def prepare(self) -> None:
        names = self._names("")
        if names and PROGRESS not in names:
            raise InputError(self.url, _("the place holds something else"), _("give another path"))

    def _names(self, under: str) -> list[str]:
        """Last parts of the names directly under a name."""
        with _as_refusals():
            self.files.invalidate_cache()
            try:
                found = self.files.ls(self._at(under), detail=False)
            except FileNotFoundError:
                return []
        return [str(path).rstrip("/").rpartition("/")[2] for path in found]

    @contextmanager
    def lock(self) -> Iterator[None]:
        with place_refusals(self.url):
            number = self._take()
        beating = threading.Event()
        beat = threading.Thread(target=self._renew, args=(number, beating), daemon=True)
        beat.start()
        try:
            yield
        finally:
            beating.set()
            beat.join()
            # a lock that cannot be given back is abandoned, and ends by itself
            with suppress(OSError), _as_refusals():
                self._put_owner(number, alive=False)

    def _take(self) -> int:
        numbers = self._owners()
        if numbers and self._is_held(numbers[-1]):
            raise _busy_error(self.url)
        number = numbers[-1] + 1 if numbers else 0
        try:
            self._put_owner(number, alive=True, mode="create")
        except FileExistsError:
            # another run took it in between
            raise _busy_error(self.url) from None
        if self._owners()[-1:] != [number]:
            # a list that was read long ago: others have come and gone
            self.remove(f"{OWNERS}/{number}")
            raise _busy_error(self.url)
        for old in numbers[:-1]:
            self.remove(f"{OWNERS}/{old}")
        return number

    def _owners(self) -> list[int]:
        return sorted(int(name) for name in self._names(OWNERS) if name.isascii() and name.isdigit())

    def _put_owner(self, number: int, *, alive: bool, mode: str = "overwrite") -> None:
        told = {"host": socket.gethostname(), "process": os.getpid(), "alive": alive, "time": time.time()}
        with _as_refusals():
            self.files.pipe_file(self._at(f"{OWNERS}/{number}"), json.dumps(told).encode(), mode=mode)

    def _is_held(self, number: int) -> bool:
        told = table_of(self.read(f"{OWNERS}/{number}"))
        if told is None or not told.get("alive"):
            return False
        # a process of this machine that is no more holds nothing
        if told.get("host") == socket.gethostname() and not _is_alive(told.get("process")):
            return False
        last = told.get("time")
        return isinstance(last, int | float) and time.time() - last < LEASE

    def _renew(self, number: int, ended: threading.Event) -> None:
        while not ended.wait(BEAT):
            with suppress(OSError), _as_refusals():
                self._put_owner(number, alive=True)

    def exists(self, name: str) -> bool:
        with _as_refusals():
            return bool(self.files.exists(self._at(name)))

    def read(self, name: str, most: int = GREATEST) -> bytes | None:
        with _as_refusals():
            try:
                content: bytes = self.files.cat_file(self._at(name), start=0, end=most + 1)
            except FileNotFoundError:
                return None
        return content if len(content) <= most else None

    def write(self, name: str, content: bytes) -> None:
        with _as_refusals():
            self.files.pipe_file(self._at(name), content)

    def write_durably(self, name: str, told: Mapping[str, Any]) -> None:
        self.write(name, json.dumps(told).encode())

    def remove(self, name: str) -> None:
        with _as_refusals(), suppress(FileNotFoundError):
            self.files.rm_file(self._at(name))

    def marks(self, under: str) -> Iterator[tuple[str, dict[str, Any] | None]]:
        # a folder of marks at a time: the list of all may be long
        for folder in self._names(under):
            names = [
                f"{under}/{folder}/{name}"
                for name in self._names(f"{under}/{folder}")
                if name.endswith(".json")
            ]
            for first in range(0, len(names), TOGETHER):
                some = names[first : first + TOGETHER]
                yield from zip(some, self._read_together(some), strict=True)

    def _read_together(self, names: Sequence[str]) -> Iterator[dict[str, Any] | None]:
        paths = [self._at(name) for name in names]
        with _as_refusals():
            found = self.files.cat(paths, on_error="return")
        for path in paths:
            content = found.get(path) if isinstance(found, dict) else found
            if isinstance(content, Exception) and not isinstance(content, FileNotFoundError):
                with _as_refusals():
                    raise content
            yield table_of(content) if isinstance(content, bytes) else None

    def pieces(self, name: str, size: int) -> Iterator[bytes] | None:
        content = self.read(name, size)
        if content is None:
            raise FileNotFoundError(name)
        return iter([content]) if len(content) == size else None

    def make(self, files: Mapping[str, bytes], own: set[str]) -> None:
        remains = [name for name in self._names("") if name != PROGRESS]
        if any(name not in own for name in remains):
            raise InputError(self.url, _("the place holds something else"), _("give another path"))
        with _as_refusals():
            for name in (*remains, f"{PROGRESS}/{DONE}"):
                with suppress(FileNotFoundError):
                    self.files.rm(self._at(name), recursive=True)
        for name, content in files.items():
            self.write(name, content)

    def tidy(self) -> None:
        """Nothing: an object is there whole or not at all."""

    def for_zarr(self) -> Any:
        return _storage().FsspecStore.from_url(self.url)


def _busy_error(place: str) -> InputError:
    return InputError(
        place, _("another run is writing into it"), _("wait until it ends, or give another path")
    )


def _is_alive(process: object) -> bool:
    """Whether a process of this machine runs; True where that cannot be known."""
    if not isinstance(process, int) or process <= 0 or os.name == "nt":
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


def zarr_array(storage: Storage, name: str) -> Any:
    """The numbers of an array of a store."""
    with _as_refusals():
        return _zarr().open_group(storage.for_zarr(), mode="r")[name][...]
