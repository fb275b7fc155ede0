"""The record of a campaign: a file to which blocks of cases are appended, so that a run that was killed goes on.

The first line says what the record belongs to; each further line is the tally of a block. A line that was cut short is
dropped: its block is computed again.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

from centrode.errors import InputError
from tools.campaigns.campaign import Tally


@dataclass
class Record:
    """An open record: what it has, and the file that takes more. Only one process may hold it (`locking`)."""

    file: Path
    tally: Tally

    @classmethod
    def opened(cls, file: Path, heading: Mapping[str, Any]) -> Self:
        """The record in a file, or a new one. Raises InputError where the file belongs to another run."""
        if not file.exists():
            file.parent.mkdir(parents=True, exist_ok=True)
            draft = file.with_suffix(".draft")
            draft.write_text(json.dumps(heading) + "\n", encoding="utf-8")
            draft.replace(file)
            return cls(file, Tally())
        content = file.read_bytes()
        whole = content[: content.rfind(b"\n") + 1]
        first, *blocks = whole.splitlines() or [b"{}"]
        if json.loads(first) != dict(heading):
            raise InputError(
                str(file),
                "the record belongs to another state of the program",
                "say --anew, or name another folder",
            )
        if len(whole) < len(content):
            os.truncate(file, len(whole))
        tally = Tally()
        for block in blocks:
            tally.join(Tally.from_plain(json.loads(block)))
        return cls(file, tally)

    def take(self, block: Tally) -> None:
        """Append a block: when this returns it is on the disk."""
        line = json.dumps(block.plain()) + "\n"
        with self.file.open("a", encoding="utf-8", newline="\n") as stream:
            stream.write(line)
            stream.flush()
            os.fsync(stream.fileno())
        self.tally.join(block)
