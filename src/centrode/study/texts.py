"""Places on a path in words: drive values in the units the description wants, limits with the group that locks."""

from __future__ import annotations

from math import tau
from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import Status
from centrode.kinematics.solve import Solved
from centrode.locale import _
from centrode.model.mechanism import Display, Drive, Mechanism
from centrode.numerics.arrays import ARRAYS
from centrode.quantities import display_unit, status_word
from centrode.structure.assur import name_of

if TYPE_CHECKING:
    import xarray as xr


def extremes(solved: Solved) -> list[tuple[Drive, float, float]]:
    """Least and greatest value of each drive among the samples [rad or m]."""
    path = solved.ready.kinematics.path
    values = path.drive_values(ARRAYS, solved.span.parameter)
    drives = [one.drive for one in path.driven]
    return [(drive, float(np.min(values[drive.id])), float(np.max(values[drive.id]))) for drive in drives]


def value_text(at: float, unit: str, display: Display) -> str:
    """A value in SI as it is shown, with its unit; angles in radians also in degrees."""
    factor, shown = display_unit(unit, display.length, display.angle)
    text = f"{at * factor:.9g} {shown}"
    return f"{text} ({np.degrees(at):.6g} deg)" if shown == "rad" else text


def place_words(mechanism: Mechanism, motion: xr.Dataset, sample: int) -> str:
    """Where a sample is: values of the drives with their units, and its status where it is not ok."""
    values = motion["drive_value"].to_numpy()[sample]
    texts = []
    for drive, value in zip(mechanism.drives, values, strict=True):
        texts.append(
            f"{drive.id} {value_text(float(value), mechanism.motion_parameter.drive(drive.id).unit, mechanism.display)}"
        )
    status = int(motion["status"][sample])
    return ", ".join(texts) + ("" if status == Status.OK else f" ({status_word(status)})")


class Words:
    """Sentences about one solved motion."""

    def __init__(self, solved: Solved) -> None:
        self.solved = solved
        display = solved.ready.mechanism.display
        self.unit = solved.ready.parameter.variable.unit
        self.display = display

    def value(self, at: float, unit: str = "") -> str:
        """A value of the path's parameter (or one in another unit) with its unit, angles also in degrees."""
        return value_text(at, unit or self.unit, self.display)

    def range(self) -> str:
        """From where to where, and how long that takes; times and extremes where a law drives."""
        parameter, time = self.solved.span.parameter, self.solved.span.time
        if not self.solved.ready.parameter.is_uniform:
            first, last = (self.value(float(time[end]), "s") for end in (0, -1))
            reached = ", ".join(self._reached(*extreme) for extreme in extremes(self.solved))
            return _("{first} to {last}, {drives}").format(first=first, last=last, drives=reached)
        return _("{first} to {last} in {duration:.6g} s").format(
            first=self.value(float(parameter[0])),
            last=self.value(float(parameter[-1])),
            duration=abs(float(time[-1] - time[0])),
        )

    def _reached(self, drive: Drive, low: float, high: float) -> str:
        unit = self.solved.ready.parameter.drive(drive.id).unit
        return _("{drive} between {low} and {high}").format(
            drive=drive.id, low=self.value(low, unit), high=self.value(high, unit)
        )

    def events(self, kind: str) -> str:
        """Places of the events of one kind within the range, each once."""
        places = dict.fromkeys(event.at for event in self.solved.events() if event.kind == kind)
        return "; ".join(self.value(at) for at in places) or _("none")

    def limit(self, at: float) -> str:
        """Where a limit lies, and which group locks there."""
        groups = [e.group for e in self.solved.branches.events if e.kind == "limit" and e.at == at]
        names = dict.fromkeys(name_of(self.solved.ready.structure.groups[group]) for group in groups)
        return _("limit at {value}, where {group} is a dead point").format(
            value=self.value(at), group=", ".join(names)
        )

    def period(self) -> list[str]:
        """A note if a full turn does not bring the mechanism back to where it was."""
        solved = self.solved
        if not solved.ready.parameter.turns or len(solved.span.parameter) < 2:
            return []
        turned = abs(solved.span.parameter[-1] - solved.span.parameter[0])
        ends = solved.points[0, 0, [0, -1]]
        if abs(turned - tau) > 1e-9 or not np.isfinite(ends).all() or not ends.size:
            return []
        apart = float(np.abs(ends[1] - ends[0]).max())
        if apart <= 1e-6 * float(solved.ready.kinematics.numbers.scale):
            return []
        return [_("after one turn of the drive the mechanism is not back in its first position")]
