"""Text of a file that somebody else wrote: bounded, a regular file, in UTF-8."""

from __future__ import annotations

import stat
from pathlib import Path

from centrode.errors import InputError
from centrode.files.inputs import note
from centrode.locale import _
from centrode.model import limits
from centrode.model.problems import shown


def read_file(path: Path) -> str:
    """Text of a file.

    Raises
    ------
    InputError
        Missing, not a regular file, not readable, more than `limits.FILE_SIZE` bytes (told before any is
        read), or not UTF-8.
    """
    where = shown(path.name or str(path))[1:-1]
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise InputError(where, _("this is not a file"), _("give the path of a file"))
        if status.st_size <= limits.FILE_SIZE:
            with path.open("rb") as stream:
                content = stream.read(limits.FILE_SIZE + 1)
            note(path, status)
        if status.st_size > limits.FILE_SIZE or len(content) > limits.FILE_SIZE:
            what = _("the file has {size} bytes, at most {most} are allowed")
            raise InputError(where, what.format(size=status.st_size, most=limits.FILE_SIZE))
        return content.decode("utf-8-sig")
    except FileNotFoundError:
        raise InputError(where, _("there is no such file"), _("check the path")) from None
    except UnicodeDecodeError as error:
        what = _("the file is not text in UTF-8 (byte {place})").format(place=error.start)
        raise InputError(where, what, _("save it as UTF-8")) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(where, _("the file cannot be read: {reason}").format(reason=reason)) from None
