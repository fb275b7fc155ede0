"""Files and folders that appear whole or not at all, and never in the place of a file that the command reads.

Everything is written into a draft beside its place and moved there at the end. A draft is a folder with a lock that
its process holds: where the lock is free the process was killed, and the next run that writes there removes the draft.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from pathlib import Path
from typing import Any

from centrode.errors import InputError
from centrode.files.inputs import keep_inputs, keep_inputs_below
from centrode.files.locks import taken
from centrode.locale import _

PREFIX = ".centrode-"
NAME = re.compile(re.escape(PREFIX) + r"[a-z0-9_]{8}")
"""Name of a draft, as `tempfile` makes it."""
LOCK, CONTENT = "lock", "content"


@contextmanager
def draft_folder(path: Path) -> Iterator[Path]:
    """Folder to write into; its files appear in `path` when the block ends, and not at all when it raises.

    Raises InputError at once where `path` cannot be written, and at the end where one of the files would replace a
    file that was read. Files of the same name that are in `path` are replaced, others are left alone.
    """
    with refusals(path):
        base = existing_part(path)
        for place in {base, existing_part(path.parent)}:
            clear_drafts(place)
    with _draft(base, path) as draft:
        yield draft
        with refusals(path):
            _move_files(draft, path)


@contextmanager
def draft_file(path: Path) -> Iterator[Path]:
    """File to write; it appears at `path` when the block ends, and not at all when it raises.

    Raises InputError at once where `path` cannot be written or is a file that was read. The draft has the same name.
    """
    with refusals(path):
        keep_inputs(path)
        base = existing_part(path.parent)
        clear_drafts(base)
    with _draft(base, path) as draft:
        file = draft / path.name
        with refusals(path):
            file.touch()
        yield file
        with refusals(path):
            _move_files(draft, path.parent)


@contextmanager
def refusals(path: Path) -> Iterator[None]:
    """Say what the operating system refuses as an InputError about `path`."""
    try:
        yield
    except OSError as refusal:
        reason = refusal.strerror or str(refusal)
        raise InputError(
            str(path), _("cannot be written: {reason}").format(reason=reason), _("give another path")
        ) from refusal


def existing_part(path: Path) -> Path:
    """The folder itself, or the nearest one above it that exists: drafts are made there, on the same file system."""
    for part in (path, *path.parents):
        if part.is_dir():
            return part
        if part.exists() or part.is_symlink():
            where = "" if part == path else str(path)
            raise InputError(where, _("{part} is not a folder").format(part=part), _("name another folder"))
    raise InputError(str(path), _("no part of this path exists"), _("name another folder"))


def replace_file(draft: Path, path: Path) -> None:
    """Move a finished file into its place in one stroke; InputError where that is a file that was read."""
    keep_inputs(path)
    os.replace(draft, path)


def write_whole(file: Path, told: Mapping[str, Any]) -> None:
    """Write a small file of JSON so that it is there whole or not at all, and outlives a loss of power."""
    draft = file.with_suffix(".draft")
    keep_inputs(draft)
    with draft.open("w", encoding="utf-8") as stream:
        json.dump(told, stream)
        stream.flush()
        os.fsync(stream.fileno())
    replace_file(draft, file)


def remove_file(path: Path) -> None:
    """Remove a file of an earlier run, if it is there; InputError where it is one that was read."""
    keep_inputs(path)
    with suppress(FileNotFoundError, NotADirectoryError):
        path.unlink()


def clear_folder(path: Path) -> None:
    """Remove a folder of an earlier run, if it is there; InputError where a file that was read is in it."""
    keep_inputs_below(path)
    shutil.rmtree(path, ignore_errors=True)


def clear_drafts(folder: Path) -> None:
    """Remove the drafts in a folder that processes left which were killed."""
    with suppress(OSError), os.scandir(folder) as entries:
        found = [Path(entry) for entry in entries if NAME.fullmatch(entry.name) and _is_folder(entry)]
        for draft in found:
            # A lock that another process holds, an input inside, a foreign owner: such a draft is left alone.
            with suppress(OSError, InputError):
                lock = taken(draft / LOCK)
                if lock is not None:
                    lock.close()
                    clear_folder(draft)


def _is_folder(entry: os.DirEntry[str]) -> bool:
    return entry.is_dir(follow_symlinks=False)


@contextmanager
def _draft(base: Path, path: Path) -> Iterator[Path]:
    """An empty folder in `base`, this process's own until the block ends."""
    with refusals(path):
        home, lock = _own_folder(base)
    try:
        with lock:
            content = home / CONTENT
            with refusals(path):
                content.mkdir()
            yield content
    finally:
        shutil.rmtree(home, ignore_errors=True)


def _own_folder(base: Path) -> tuple[Path, AbstractContextManager[object]]:
    """A new folder and the lock in it."""
    while True:
        home = Path(tempfile.mkdtemp(prefix=PREFIX, dir=base))
        try:
            lock = taken(home / LOCK)
        except FileNotFoundError:
            continue  # another run removed the folder before it was locked
        except OSError:
            return home, nullcontext()  # where nothing can be locked, no other run removes drafts either
        if lock is not None:
            return home, lock


def _move_files(draft: Path, path: Path) -> None:
    """Move what is in a draft into its folder, once nothing speaks against any of its files."""
    files = sorted(file.relative_to(draft) for file in draft.rglob("*") if file.is_file())
    for file in files:
        existing_part((path / file).parent)
        if (path / file).is_dir():
            raise InputError(
                str(path / file),
                _("is a folder, but a file is to be written there"),
                _("name another folder"),
            )
    keep_inputs(*(path / file for file in files))
    path.mkdir(parents=True, exist_ok=True)
    for file in files:
        (path / file).parent.mkdir(parents=True, exist_ok=True)
        os.replace(draft / file, path / file)
