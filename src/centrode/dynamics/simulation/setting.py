"""A mechanism and what its description asks of a simulation, made ready and checked."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import inf, tau

import numpy as np

from centrode.dynamics.burden import Burden
from centrode.dynamics.reducer import Reducer
from centrode.dynamics.simulation.driving import Driving
from centrode.dynamics.simulation.field import Field
from centrode.dynamics.simulation.rows import Rows
from centrode.dynamics.simulation.sorts import STORED, of_time
from centrode.dynamics.simulation.tracks import NEAR_LIMIT, Tracks
from centrode.dynamics.simulation.watching import Until
from centrode.errors import InputError
from centrode.kinematics.ready import Ready, ready
from centrode.locale import _
from centrode.model.mechanism import Mechanism
from centrode.model.simulations import MOST_TURNS, Simulation


@dataclass(frozen=True)
class Setting:
    """What is simulated.

    Attributes
    ----------
    mechanism : as described
    settings : Simulation
    rows : Rows
    driving : Driving
    start : value of the drive [rad or m] at time zero
    rate : its derivative by time
    """

    mechanism: Mechanism
    settings: Simulation
    rows: Rows
    driving: Driving
    start: float
    rate: float

    @property
    def prepared(self) -> Ready:
        """The mechanism with its plan; one that keeps its assembly is prepared as one that passes change points."""
        return self.rows.reducer.ready

    @cached_property
    def field(self) -> Field:
        """What moves the mechanism; the start is checked."""
        field = Field(Tracks(self.rows), self.driving)
        self._check_start(field.tracks)
        return field

    @property
    def is_conservative(self) -> bool:
        """Whether nothing drives it but weights and springs, and nothing takes energy."""
        undriven = not self.driving.formula.used and self.driving.at(0.0, 0.0, 0.0) == 0.0
        return undriven and all(one.sort == STORED for one in self.rows.efforts)

    @property
    def until(self) -> Until:
        """When it ends."""
        settings = self.settings
        if settings.duration is None and settings.turns is None:
            raise InputError(
                "[simulation]",
                _("nothing says how long it runs"),
                _("give duration, such as 10 s, or turns of the drive"),
            )
        self._check_turns()
        way = None if settings.turns is None else settings.turns * tau * self._unit
        time = inf if settings.duration is None else settings.duration
        if time == inf and (self.driving.of_time or of_time(self.rows.efforts)):
            raise InputError(
                "[simulation]",
                _("drive or loads depend on time, and only turns are given"),
                _("give duration too"),
            )
        return Until(time, way)

    @property
    def turns_at_start(self) -> float | None:
        """Turns that the speed at the start makes in the duration; None without one."""
        duration = self.settings.duration
        return None if duration is None else abs(self.rate) * duration / (tau * self._unit)

    def _check_turns(self) -> None:
        """Refuse what at its speed at the start would be too long, before anything is integrated."""
        turns = self.turns_at_start
        if self.settings.turns is None and turns is not None and turns > MOST_TURNS:
            raise InputError(
                "[simulation]",
                _(
                    "at its speed at the start it makes {turns:.3g} turns in {time:.6g} s, "
                    "and at most {most} are integrated"
                ).format(turns=turns, time=self.settings.duration, most=MOST_TURNS),
                _("give a shorter duration, or turns, after which it ends"),
            )

    @property
    def _unit(self) -> float:
        return self.prepared.kinematics.path.unit

    def _check_start(self, tracks: Tracks) -> None:
        """Refuse a start at a dead point, or where the mechanism does not get to."""
        tracks.stretch(tracks.place(self.start, self.rate * self.rows.sense >= 0.0)[0])
        known = self.rows.state(np.array([self.start]))[1][0]
        if known and (tracks.low < self.start < tracks.high or tracks.is_change_point(self.start)):
            return
        near = (
            min(abs(self.start - end) for end in (tracks.low, tracks.high)) <= 2.0 * NEAR_LIMIT * tracks.unit
        )
        what = (
            _("it starts at a dead point, drive at {value:.9g}: there the drive moves nothing")
            if near or not known
            else _("it starts at {value:.9g}, where the mechanism does not get to")
        )
        raise InputError(
            "[simulation] start",
            what.format(value=self.start),
            _("start between the limits (centrode limits tells them)"),
        )


def setting_of(mechanism: Mechanism, settings: Simulation | None = None) -> Setting:
    """What a description asks for, or settings in its place.

    Raises
    ------
    InputError
        No `[simulation]`, several drives, nothing that has mass.
    """
    settings = settings or mechanism.simulation
    if settings is None:
        raise InputError(
            "[simulation]",
            _("it is missing"),
            _('give driving = "20 - 2*v" and duration, or pass ct.Simulation'),
        )
    if len(mechanism.drives) != 1:
        raise InputError(
            "[[drives]]",
            _("a simulation needs one drive, the mechanism has {count}").format(count=len(mechanism.drives)),
            _("tie the drives by a gear"),
        )
    if settings.turns is not None and mechanism.drives[0].kind != "angle":
        raise InputError("[simulation] turns", _("the drive does not turn"), _("give duration"))
    if settings.motor is not None and mechanism.drives[0].kind != "angle":
        raise InputError("[simulation] motor", _("the drive does not turn"), _("give driving, a force"))
    # up to the next change point both continuations are one motion, and the smooth one keeps its digits there
    kept = mechanism.assembly.continuation == "keep"
    passing = mechanism.assembly.model_copy(update={"continuation": "smooth"})
    smooth = mechanism.model_copy(update={"assembly": passing}) if kept else mechanism
    reducer = Reducer(ready(smooth), Burden.of(smooth))
    shafts = () if mechanism.machine is None else mechanism.machine.shafts
    rows = Rows(reducer, sum(shaft.inertia * shaft.ratio**2 for shaft in shafts), kept)
    if not reducer.burden.masses and not rows.added:
        raise InputError(
            "[links]", _("no link has a mass: nothing carries the motion"), _("give links a mass")
        )
    path = reducer.ready.kinematics.path
    driving = Driving.of(settings, path.forward)
    start = path.initial if settings.start is None else settings.start
    return Setting(mechanism, settings, rows, driving, start, path.forward * settings.speed)
