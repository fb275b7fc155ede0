"""Progress of long work on the terminal: one line on stderr, only where somebody watches."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import Self

from centrode.cli.output import tell

PATIENCE = 0.5
"""Seconds of work before anything is shown: short work stays silent."""
ERASE = "\r\033[K"


class Progress:
    """What is being done, with how far it is; nothing where stderr is no terminal."""

    def __init__(self) -> None:
        self.began = time.monotonic()
        self.shown = False
        self.watched = sys.stderr is not None and sys.stderr.isatty()

    def __enter__(self) -> Self:
        return self

    def say(self, what: str, done: int = 0, of: int = 0) -> None:
        """Show what is being done now."""
        if self.watched and time.monotonic() - self.began >= PATIENCE:
            self.shown = True
            tell(f"{ERASE}{what} {done}/{of}" if of else f"{ERASE}{what}", nl=False)

    def __exit__(
        self, kind: type[BaseException] | None, failure: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self.shown:
            tell(ERASE, nl=False)
