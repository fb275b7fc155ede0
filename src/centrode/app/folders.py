"""The one folder whose descriptions the workbench reads and writes: text of a bounded size, and nothing outside."""

from __future__ import annotations

import os
import re
import stat
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from centrode.app.documents import TEXT_SIZE, digest_of
from centrode.errors import InputError
from centrode.files.drafts import draft_file
from centrode.locale import _
from centrode.model.reading import value_text

FILES = 500
"""Names of a folder that are listed."""
SIZE = 4 * TEXT_SIZE
"""Bytes of a file."""

_NAME = re.compile(r"[^\W_][\w .()'-]{0,99}\.toml", re.IGNORECASE)
_DEVICES = re.compile(r"(?:con|prn|aux|nul|com\d|lpt\d)(?:\.|\Z)", re.IGNORECASE)


@dataclass(frozen=True)
class WorkFolder:
    """A folder and the file of it that is opened first.

    Attributes
    ----------
    folder : absolute, with links resolved
    file : name of the file that the workbench was started with; empty without one
    """

    folder: Path
    file: str = ""

    def checked_name(self, name: object) -> str:
        """A name of a file of the folder; InputError for a path, another kind of file, a name that systems reserve."""
        if not isinstance(name, str) or not _NAME.fullmatch(name) or _DEVICES.match(name):
            what = _("{name} is no name of a description").format(name=value_text(name))
            raise InputError("", what, _("use letters, digits, spaces and hyphens, and end it in .toml"))
        return name

    def names(self) -> list[str]:
        """Descriptions in the folder, sorted."""
        try:
            with os.scandir(self.folder) as entries:
                files = [entry.name for entry in entries if entry.is_file(follow_symlinks=False)]
        except OSError as error:
            what = _("the folder cannot be read: {reason}").format(reason=error.strerror)
            raise InputError("", what) from None
        return sorted(filter(_NAME.fullmatch, files))[:FILES]

    def read(self, name: str) -> str:
        """Text of a file; InputError where there is none, or it is a link, too great or no text."""
        content = self._content(name)
        try:
            return content.decode("utf-8-sig") if content.startswith(b"\xef\xbb\xbf") else content.decode()
        except UnicodeDecodeError as error:
            what = _("the file is not text in UTF-8 (byte {place})").format(place=error.start)
            raise InputError(name, what, _("save it as UTF-8")) from None

    def _content(self, name: str) -> bytes:
        path = self.folder / name
        flags = (
            os.O_RDONLY
            | getattr(os, "O_NOFOLLOW", 0)
            | getattr(os, "O_NONBLOCK", 0)
            | getattr(os, "O_BINARY", 0)
        )
        try:
            if path.is_symlink():
                raise InputError(name, _("links to other files are not followed"), _("open the file itself"))
            if path.is_dir():  # Linux opens one, and fails when it is read
                raise InputError(name, _("this is not a file"), _("give the path of a file"))
            handle = os.open(path, flags)
        except FileNotFoundError:
            raise InputError(name, _("there is no such file"), "") from None
        except OSError as error:
            raise InputError(
                name, _("the file cannot be read: {reason}").format(reason=error.strerror)
            ) from None
        with os.fdopen(handle, "rb") as stream:
            status = os.fstat(stream.fileno())
            if not stat.S_ISREG(status.st_mode):
                raise InputError(name, _("this is not a file"), _("give the path of a file"))
            if status.st_size > SIZE:
                what = _("the file has {size} bytes, at most {most} are allowed")
                raise InputError(name, what.format(size=status.st_size, most=SIZE))
            return stream.read(SIZE)

    def write(self, name: str, text: str, expected: str | None) -> None:
        """Write a file, whole or not at all.

        `expected` is the digest of what was read from it; InputError where the file holds something else, and without
        it where there is a file.
        """
        path = self.folder / name
        try:
            present: str | None = self.read(name)
        except InputError:
            if path.exists() or path.is_symlink():
                raise
            present = None
        if present is not None and digest_of(present) not in (expected, digest_of(text)):
            what = (
                _("the file has changed since it was opened")
                if expected
                else _("there is a file of this name")
            )
            raise InputError(name, what, _("save under another name, or open it again"))
        try:
            with draft_file(path) as draft:
                draft.write_bytes(text.encode())
        except OSError as error:
            what = _("the file cannot be written: {reason}").format(reason=error.strerror)
            raise InputError(name, what) from None

    def first_file(self) -> dict[str, Any] | None:
        """Name and text of the file that the workbench was started with; None without one."""
        if not self.file:
            return None
        if not (self.folder / self.file).exists():
            return {"name": self.file, "text": "", "digest": digest_of("")}
        text = self.read(self.file)
        return {"name": self.file, "text": text, "digest": digest_of(text)}
