"""What stderr tells of long work: what it will take, before it begins, and a line of progress."""

from __future__ import annotations

import functools
import sys
import time
from types import TracebackType
from typing import Self

import lazy_loader

import centrode as ct
from centrode.cli.output import tell
from centrode.locale import _

# what it imports is too much for a list of commands
_reading = functools.partial(lazy_loader.load, "centrode.model.reading", suppress_warning=True)

PATIENCE = 0.5
"""Seconds of work before anything is shown: short work stays silent."""
ERASE = "\r\033[K"
ANNOUNCED_FROM = 200_000_000
"""Bytes of memory from which a run is announced."""
BYTES = 300
"""Memory of a coordinate at a sample: its derivatives, forces, and tables on the way to their files."""
OF_A_CAM = 4
"""What counts as its coordinates: a sample of a cam takes some 1 kB."""
MANY_LINKS = 60
"""Links from which a run is announced: matrices grow with their square, and so do pictures and reports."""
MANY_TURNS = 200
"""Turns of a simulation from which it is announced."""
STEPS = 40
"""Adaptive steps that a turn of a linkage takes at the usual tolerance."""


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


def announce_size(description: ct.Mechanism, samples: int | None) -> None:
    """Tell what many links and samples will take; what would take too much is refused where it is computed."""
    count = samples if isinstance(samples, int) else description.study.samples or 0
    coordinates = 3 * len(description.links) + 2 * len(description.moving_points)
    if len(description.links) >= MANY_LINKS:
        announcement = _("{count} links: this may take minutes")
        tell(announcement.format(count=len(description.links)))
    announce_samples(count, coordinates)


def announce_samples(count: int, coordinates: int = OF_A_CAM) -> None:
    """Tell how much memory so many samples of so many coordinates may take."""
    size = BYTES * coordinates * count
    if size >= ANNOUNCED_FROM and count <= _reading().SAMPLES:  # more are refused at once
        announcement = _("{count} samples: this may take {size:.2g} GB of memory")
        tell(announcement.format(count=count, size=size / 1e9))


def announce_turns(turns: float) -> None:
    """Tell how far a simulation would run at the speed of its start, and about how many steps that takes."""
    if turns >= MANY_TURNS:
        announcement = _("about {turns:.3g} turns of the drive at the initial speed, about {steps:.2g} steps")
        tell(announcement.format(turns=turns, steps=turns * STEPS))
