"""A lock on a file that one process holds; when the process ends, however it ends, the lock is free."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from centrode.errors import InputError
from centrode.locale import _

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

WINDOWS = sys.platform == "win32"


@contextmanager
def hold_lock(file: Path, what: str, *, remove: Callable[[Path], None] | None = None) -> Iterator[None]:
    """Hold the lock in `file` while the block runs; `remove`, if given, then takes the file away.

    Raises InputError about `what` where another process holds it. A lock left by a process that was killed does
    not hold: it belongs to the open file, not to the file's being there.
    """
    try:
        stream = taken(file)
    except OSError as refusal:
        raise _is_refused(what, refusal) from refusal
    if stream is None:
        busy = _("another run is writing into it")
        raise InputError(what, busy, _("wait until it ends, or give another path"))
    try:
        with stream:
            try:
                yield
            finally:
                if remove is not None and not WINDOWS:
                    # while the lock is held: afterwards the file may be the lock of another process
                    with suppress(OSError):  # a file that stays does no harm
                        remove(file)
    finally:
        if remove is not None and WINDOWS:
            # an open file cannot be removed there: not before it is closed, nor the lock of another process
            with suppress(OSError):
                remove(file)


def taken(file: Path) -> IO[bytes] | None:
    """The open file with its lock, made where it is missing; None where another process holds it or took it away.

    Raises OSError where the file cannot be opened, or the file system cannot lock.
    """
    stream = file.open("a+b")
    try:
        _take(stream.fileno())
        # Between opening and locking, the process that held the lock may have removed the file.
        if os.path.samestat(os.fstat(stream.fileno()), file.stat()):
            return stream
    except (BlockingIOError, PermissionError, FileNotFoundError):
        pass
    except BaseException:
        stream.close()
        raise
    stream.close()
    return None


def _is_refused(what: str, refusal: OSError) -> InputError:
    """A file system that cannot lock, or lets nobody write."""
    reason = refusal.strerror or str(refusal)
    return InputError(what, _("cannot be locked: {reason}").format(reason=reason), _("give another path"))


def _take(handle: int) -> None:
    if sys.platform == "win32":
        os.lseek(handle, 0, os.SEEK_SET)
        msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
    else:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
