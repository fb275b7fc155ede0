"""The files that a command reads: no output of the command takes the place of one of them."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path

from centrode.errors import InputError
from centrode.locale import _


@dataclass(frozen=True)
class Input:
    """A file that was read; plain data, which goes to another process.

    Attributes
    ----------
    name : as the command names it
    real : its path without links
    device, number : which file it is, whatever its names; number 0 where the file system numbers none
    """

    name: str
    real: str
    device: int
    number: int

    def is_at(self, path: Path) -> bool:
        """Whether a path leads to this file: by another spelling, a link, or another name of the same file."""
        try:
            found = path.stat()
        except OSError:
            return False
        if self.number and (found.st_dev, found.st_ino) == (self.device, self.number):
            return True
        return _real(path) == self.real

    def is_below(self, folder: Path) -> bool:
        """Whether this file stands somewhere below a folder."""
        return Path(_real(folder)) in Path(self.real).parents


_READ: ContextVar[list[Input] | None] = ContextVar("files that the command has read", default=None)


@contextmanager
def guard_inputs() -> Iterator[None]:
    """While the block runs, the files that it reads are kept from being replaced by what it writes."""
    token = _READ.set([])
    try:
        yield
    finally:
        _READ.reset(token)


def note(path: Path, status: os.stat_result) -> None:
    """Remember a file that is read, where a command is running."""
    read = _READ.get()
    if read is not None:
        read.append(Input(str(path), _real(path), status.st_dev, status.st_ino))


def inputs_read() -> tuple[Input, ...]:
    """The files read so far."""
    return tuple(_READ.get() or ())


def carry_on(read: Sequence[Input]) -> None:
    """Guard, in a process of a command's own, the files that the command has read."""
    _READ.set(list(read))


def keep_inputs(*outputs: Path) -> None:
    """Raise InputError where one of the outputs would replace a file that was read."""
    for output in outputs:
        for read in inputs_read():
            if read.is_at(output):
                raise _refusal(output, read)


def keep_inputs_below(folder: Path) -> None:
    """Raise InputError where a file that was read stands in a folder that is to be cleared."""
    for read in inputs_read():
        if read.is_below(folder):
            raise _refusal(folder, read)


def _refusal(output: Path, read: Input) -> InputError:
    what = _("it would replace {file}, which this command reads").format(file=read.name)
    return InputError(str(output), what, _("give another path"))


def _real(path: Path) -> str:
    return os.path.normcase(os.path.realpath(path))
