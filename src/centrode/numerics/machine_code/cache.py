"""Compiled kernels on disk: a saving, never a need. Whatever is wrong with an entry, it is as if it were not there.

An entry is run as native code, and its checksum keeps errors out, not people: anybody can compute it. So an entry
counts only where nobody but the user can have written it.
"""

from __future__ import annotations

import hashlib
import os
import stat
import sys
import tempfile
from pathlib import Path
from typing import IO

FOLDER = "CENTRODE_CACHE"
"""Environment variable that names another folder; if it is empty, nothing is kept on disk."""
MARK = b"centrode kernel 1\n"
GREATEST = 1 << 24
"""Bytes of an entry that is read; the code of a large mechanism has some 2^16."""
ENTRIES = 512
"""The newest are kept."""
SUFFIX = ".kernel"


def folder() -> Path | None:
    """Where kernels are kept; None if nowhere."""
    named = os.environ.get(FOLDER)
    if named is not None:
        return Path(named) if named else None
    try:
        home = Path.home()
    except RuntimeError:  # a process without a home
        return None
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or home / "AppData" / "Local") / "centrode" / "kernels"
    if sys.platform == "darwin":
        return home / "Library" / "Caches" / "centrode" / "kernels"
    return Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache") / "centrode" / "kernels"


def name_of(*parts: str) -> str:
    """Name of the entry that depends on some texts, and on nothing else."""
    # the length goes first, so that no two lists of texts run together to the same bytes
    digest = hashlib.sha256()
    for part in parts:
        digest.update(f"{len(part)}:{part}".encode())
    return digest.hexdigest()


def read_entry(name: str) -> bytes | None:
    """Bytes kept under a name; None where there are none, or their checksum does not fit."""
    place = folder()
    if place is None:
        return None
    try:
        with _open_entry(place, f"{name}{SUFFIX}") as file:
            # one byte more than allowed, so that what is too long is not taken for whole
            content = file.read(GREATEST + 1)
    except OSError:
        return None
    head = len(MARK) + hashlib.sha256().digest_size
    kept, payload = content[:head], content[head:]
    return payload if kept == MARK + _digest(name, payload) else None


def write(name: str, payload: bytes) -> None:
    """Keep something under a name; in one stroke, so that other processes see all of it or nothing."""
    place = folder()
    if place is None or len(payload) > GREATEST // 2:
        return
    try:
        place.mkdir(mode=0o700, parents=True, exist_ok=True)
        if not _is_private_folder(place):
            return
        handle, temporary = tempfile.mkstemp(dir=place)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(MARK + _digest(name, payload) + payload)
            Path(temporary).replace(place / f"{name}{SUFFIX}")
        except OSError:
            Path(temporary).unlink(missing_ok=True)
        _leave_the_newest(place)
    except OSError:
        return  # a full disk, a folder that cannot be written: nothing is kept


def _digest(name: str, payload: bytes) -> bytes:
    return hashlib.sha256(name.encode() + payload).digest()


def _open_entry(place: Path, entry: str) -> IO[bytes]:
    """An entry that is open to be read; PermissionError where somebody else may have written it.

    The folder is opened first and the entry in it, so that neither can be exchanged between looking and reading.
    """
    if sys.platform == "win32":  # rights are lists there, not bits: the folder of a user's own is trusted
        return (place / entry).open("rb")
    inside = os.open(place, os.O_RDONLY | os.O_DIRECTORY)
    try:
        if not _is_private(os.fstat(inside)) or _is_exchangeable(place):
            raise PermissionError(f"others may write into {place}")
        handle = os.open(entry, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK, dir_fd=inside)
    finally:
        os.close(inside)
    file = os.fdopen(handle, "rb")
    facts = os.fstat(handle)
    if stat.S_ISREG(facts.st_mode) and _is_private(facts):
        return file
    file.close()
    raise PermissionError(f"others may write {entry}")


def _is_private_folder(place: Path) -> bool:
    """Whether nobody but the user can put entries into a folder."""
    return sys.platform == "win32" or (_is_private(place.stat()) and not _is_exchangeable(place))


def _is_private(found: os.stat_result) -> bool:
    """Whether a file or folder is the user's own, and neither a group nor others may write to it."""
    return found.st_uid == os.geteuid() and not found.st_mode & (stat.S_IWGRP | stat.S_IWOTH)


def _is_exchangeable(place: Path) -> bool:
    """Whether a folder stands, links followed, in one where anybody may rename what is not theirs."""
    modes = [folder.stat().st_mode for folder in place.resolve().parents]
    return any(mode & stat.S_IWOTH and not mode & stat.S_ISVTX for mode in modes)


def _leave_the_newest(place: Path) -> None:
    entries = list(place.glob(f"*{SUFFIX}"))
    if len(entries) <= ENTRIES:
        return
    entries.sort(key=lambda entry: entry.stat().st_mtime)
    for entry in entries[:-ENTRIES]:
        entry.unlink(missing_ok=True)
