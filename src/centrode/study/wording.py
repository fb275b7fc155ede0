"""Places on a path in words: drive values in the units the description wants, limits with the group that locks."""

from __future__ import annotations

from math import tau

import numpy as np

from centrode.kinematics.assembly import name_of
from centrode.kinematics.solve import Solved
from centrode.locale import _
from centrode.quantities import display_unit


class Words:
    """Sentences about one solved motion."""

    def __init__(self, solved: Solved) -> None:
        self.solved = solved
        path = solved.ready.kinematics.path
        display = solved.ready.mechanism.display
        self.unit = "s" if path.by_time else "rad" if path.driven[0].drive.kind == "angle" else "m"
        if self.unit == "s":
            self.factor, self.shown = 1.0, "s"
        else:
            self.factor, self.shown = display_unit(self.unit, display.length, display.angle)

    def value(self, at: float) -> str:
        """A value of the path's parameter with its unit, angles also in degrees."""
        text = f"{at * self.factor:.9g} {self.shown}"
        return f"{text} ({np.degrees(at):.6g} deg)" if self.shown == "rad" else text

    def range(self) -> str:
        """From where to where, and how long that takes."""
        parameter, time = self.solved.span.parameter, self.solved.span.time
        return _("{first} to {last} in {duration:.6g} s").format(
            first=self.value(float(parameter[0])),
            last=self.value(float(parameter[-1])),
            duration=abs(float(time[-1] - time[0])),
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
        path = solved.ready.kinematics.path
        if path.by_time or path.driven[0].drive.kind != "angle" or len(solved.span.parameter) < 2:
            return []
        turned = abs(solved.span.parameter[-1] - solved.span.parameter[0])
        ends = solved.points[0, 0, [0, -1]]
        if abs(turned - tau) > 1e-9 or not np.isfinite(ends).all() or not ends.size:
            return []
        apart = float(np.abs(ends[1] - ends[0]).max())
        if apart <= 1e-6 * float(solved.ready.kinematics.numbers.scale):
            return []
        return [_("after one turn of the drive the mechanism is not back in its first position")]
