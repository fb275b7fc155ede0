"""A machine that is left to itself: its motion under loads and a drive, and the steady regime that it runs up to."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Mapping
from dataclasses import dataclass
from math import tau
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from centrode.dynamics.masses import has_masses_or_loads
from centrode.dynamics.simulation.routes import MULTIBODY, REDUCED, Tell, equations_for
from centrode.dynamics.simulation.simulate import simulate
from centrode.dynamics.simulation.steady_state import Regime, steady_regime
from centrode.errors import CentrodeError, InputError, MotionError
from centrode.locale import _
from centrode.model.simulation import Simulation
from centrode.quantities import terminal_unit

if TYPE_CHECKING:
    import xarray as xr

    from centrode.dynamics.sensitivities.return_map import PeriodicMotion
    from centrode.model.mechanism import Mechanism

# motions by one drive need nothing of the other route
_multibody = functools.partial(importlib.import_module, "centrode.dynamics.simulation.multibody_motion")
_return_maps = functools.partial(importlib.import_module, "centrode.dynamics.sensitivities.return_map")


RUN_UP = 0.01
"""Share of the regime's mean speed within which a machine has run up."""
RECURRING = 4
"""Events from which on a motion is looked at for a regime in which they recur."""
AT_REST = 1e-9
"""Speeds below this share of the greatest on the way are none."""


class Rest(NamedTuple):
    """How a machine has come to rest, and stays so.

    Attributes
    ----------
    time : since the start [s]
    coordinate : number of the generalised coordinate that has moved farthest
    way : of that, since the start [rad or m]
    """

    time: float
    coordinate: int
    way: float


@dataclass(frozen=True)
class SimulationResults:
    """The motion of a machine under its loads and what drives it.

    Attributes
    ----------
    mechanism : the machine
    settings : how it was driven and integrated
    simulation : dataset of `simulate`
    regime : steady regime or periodic motion of a drive that has turned all the way round; None without one
    no_regime : why such a drive has none, in a sentence; empty otherwise
    second : the same by the reduced equation, at the instants that it reaches, where the equations of all links were
        taken although one drive has all the mobility; None otherwise
    periodic : by the equations of all links, the regime that it runs up to; None without one
    """

    mechanism: Mechanism
    settings: Simulation
    simulation: xr.Dataset
    regime: Regime | None
    no_regime: str
    second: xr.Dataset | None = None
    periodic: PeriodicMotion | None = None

    @property
    def run_up_time(self) -> float | None:
        """When the mean speed over a period comes and stays within `RUN_UP` of the regime [s]; None if it does not."""
        return self.run_up_within(RUN_UP)

    def run_up_within(self, share: float) -> float | None:
        """When the mean speed over a period comes and stays within a share of the regime [s]; None if it does not."""
        if self.periodic is None or self.periodic.turning is None or self.periodic.given:
            return None
        times = self.simulation["time"].values
        course = self.simulation["generalised_coordinate"].values[:, self.periodic.turning]
        period, turns = self.periodic.period, float(self.periodic.turns[self.periodic.turning])
        begins = times[times <= times[-1] - period]
        if not len(begins):
            return None
        speeds = (np.interp(begins + period, times, course) - np.interp(begins, times, course)) / (
            tau * turns
        )
        away = np.flatnonzero(np.abs(speeds - 1.0) > share)
        if len(away) and away[-1] + 1 == len(begins):
            return None
        return float(begins[away[-1] + 1]) if len(away) else 0.0

    @property
    def rest(self) -> Rest | None:
        """When everything has come to rest for good, by friction or at stops, and how far it went; None if it has not.

        A brake is friction of a given size, and this its braking: the instant is that of the last event.
        """
        run = self.simulation
        if run.attrs.get("equations") != MULTIBODY or run.sizes["sample"] < 2 or not run.sizes["occasion"]:
            return None
        speeds, times = np.abs(run["generalised_velocity"].values), run["time"].values
        moves = np.any(speeds > AT_REST * np.max(speeds, initial=0.0), axis=1)
        last = float(run["occasion_time"].values[-1])
        if not np.any(moves) or times[-1] <= last or np.any(moves & (times > last)):
            return None
        ways = run["generalised_coordinate"].values[-1] - run["generalised_coordinate"].values[0]
        farthest = int(np.argmax(np.abs(ways)))
        return Rest(last, farthest, float(ways[farthest]))


def simulation_results(
    mechanism: Mechanism,
    samples: int | None = None,
    *,
    settings: Simulation | None = None,
    motion: bool = False,
    reactions: bool = False,
    at_events: bool = False,
    progress: Tell | None = None,
    **changes: Any,
) -> SimulationResults:
    """Let a machine run, and find the steady regime that it runs up to.

    Parameters
    ----------
    samples : evenly spaced in time
    settings : in place of those of the description
    motion : also places, velocities and accelerations of everything
    reactions : also the reactions in all joints, by the equations of all links
    at_events : also at the instants of events, by the equations of all links
    progress : called with the share that is done
    changes : `duration`, `turns`, `driving`, `speed`, `speeds`, `keeps`, `equations`, `scheme`, `steps`, `tolerance`,
        `at` in place of those of the settings

    Raises
    ------
    InputError, MotionError
        As `simulate`; neither settings nor changes.

    Examples
    --------
    >>> import centrode as ct
    >>> from centrode.dynamics.simulation.results import simulation_results
    >>> results = simulation_results(ct.example("six-bar-press-run-up"), 5, duration="1 s")
    >>> print(results.simulation.attrs["ended"])
    duration
    """
    used = changed_settings(mechanism, samples, settings=settings, **changes)
    run = simulate(
        mechanism, used, motion=motion, reactions=reactions, progress=progress, at_events=at_events
    )
    return _with_regime(mechanism, used, run)


def results_of_simulation(mechanism: Mechanism, run: xr.Dataset) -> SimulationResults:
    """A dataset of `simulate`, whose mechanism has the settings that it ran by, with the regime that it ran up to."""
    return _with_regime(mechanism, changed_settings(mechanism), run)


def _with_regime(mechanism: Mechanism, used: Simulation, run: xr.Dataset) -> SimulationResults:
    """A simulation with the regime of a drive that has turned all the way round, or with its second route."""
    if run.attrs.get("equations") == MULTIBODY:
        second = _by_reduced_equation(mechanism, used, run)
        return SimulationResults(mechanism, used, run, None, "", second, _periodic(mechanism, used, run))
    regime, reason = None, ""
    if _has_turned(mechanism, run):
        try:
            regime = steady_regime(mechanism, used)
        except CentrodeError as failure:
            reason = failure.what
    return SimulationResults(mechanism, used, run, regime, reason)


def _periodic(mechanism: Mechanism, used: Simulation, run: xr.Dataset) -> PeriodicMotion | None:
    """The regime of a motion that may have run up to one: energy is given and taken, something turns or recurs."""
    if run.attrs["ended"] != "duration" or not run.attrs["work_sorts"].split() or run.sizes["sample"] < 2:
        return None
    sorts = set(run.attrs["work_sorts"].split())
    turned = np.abs(run["generalised_coordinate"].values[-1] - run["generalised_coordinate"].values[0])
    if not {"friction", "drive", "other"} & sorts:
        return None
    # where nothing turns events may recur
    if not np.max(turned, initial=0.0) > 2.0 * tau and run.sizes["occasion"] < RECURRING:
        return None
    try:
        setting = _multibody().multibody_setting(mechanism, used)
        start = setting.free.initial(setting.speeds, setting.start)
        found: PeriodicMotion = _return_maps().periodic_motion(setting.free, start, setting.duration)
    except CentrodeError:
        return None
    return found


def _by_reduced_equation(mechanism: Mechanism, used: Simulation, run: xr.Dataset) -> xr.Dataset | None:
    """The same motion by the reduced equation; None where it has none, or where that refuses it."""
    own = used.model_copy(update={"equations": None, "at": ()})
    # the reduced equation asks of a law only in which sense the drive sets out
    mechanism = mechanism.with_drives_held()
    if equations_for(mechanism, own) == MULTIBODY or int(run.attrs["mobility"]) != 1:
        return None
    try:
        second = simulate(mechanism, own.model_copy(update={"equations": REDUCED}), at=run["time"].values)
    except CentrodeError:
        return None
    return second if second.sizes["sample"] > 1 else None


def changed_settings(
    mechanism: Mechanism,
    samples: int | None = None,
    *,
    settings: Simulation | None = None,
    **changes: Any,
) -> Simulation:
    """Settings, those of the description if None, with those of `changes` that are not None in place of theirs."""
    own = mechanism.simulation if settings is None else settings
    known = {} if own is None else {key: getattr(own, key) for key in own.model_fields_set}
    given = {key: value for key, value in (changes | {"samples": samples}).items() if value is not None}
    if "driving" in given:
        known.pop("motor", None)
    if "turns" in given and "duration" not in given:
        known.pop("duration", None)
    if "duration" in given and "turns" not in given:
        known.pop("turns", None)
    if "samples" in given and "at" not in given:
        known.pop("at", None)
    if "speeds" in given:
        given["speeds"] = dict(known.pop("speeds", {})) | dict(given["speeds"])
    if not known and not given:
        raise InputError(
            "[simulation]", _("it is missing"), _('add --driving "20 - 2*v" and --duration "10 s"')
        )
    made = Simulation.for_parameter(mechanism.motion_parameter, **known | given)
    _check_means_of_scheme(made, given)
    return made


def _check_means_of_scheme(settings: Simulation, given: Mapping[str, Any]) -> None:
    """Refuse a number of steps, or a tolerance, that the scheme would leave unheeded; a description may hold both."""
    fixed = settings.scheme == "runge-kutta-4"
    if fixed and "tolerance" in given:
        raise InputError(
            "tolerance", _("fixed steps have no tolerance"), _("take an adaptive scheme, or more steps")
        )
    if not fixed and "steps" in given:
        what = _("an adaptive scheme chooses its steps by the tolerance")
        raise InputError("steps", what, _("add --scheme runge-kutta-4, or give a tolerance"))


def simulation_extent(mechanism: Mechanism, samples: int | None = None, **options: Any) -> tuple[int, float]:
    """Samples of a simulation, and turns of the drive at the speed of the start up to where it ends."""
    for flag in ("motion", "reactions"):
        options.pop(flag, None)
    settings = changed_settings(mechanism, samples, **options)
    ends = [settings.turns] if settings.turns is not None else []
    if settings.duration is not None and mechanism.drives:
        ends.append(abs(settings.speed) * settings.duration / tau)
    return settings.samples, min(ends, default=0.0) if mechanism.motion_parameter.turns else 0.0


def has_simulation(mechanism: Mechanism) -> bool:
    """Whether a description says how its masses and loads are to be set in motion."""
    return mechanism.simulation is not None and has_masses_or_loads(mechanism)


def check_ended(results: SimulationResults) -> None:
    """Raise where a machine did not run to the end: MotionError at a limit or a change point, or as interrupted."""
    run = results.simulation
    if run.attrs["ended"] == "interrupted":
        raise KeyboardInterrupt
    if run.attrs.get("equations") == MULTIBODY:
        _check_multibody(run)
        return
    if run.attrs["ended"] == "limit":
        what = _("it stops at a limit after {time:.6g} s").format(time=float(run["time"].values[-1]))
        repair = _(
            'give a shorter time, or equations = "multibody" in [simulation] (--equations multibody), for which a '
            "limit is a place like any other"
        )
        raise MotionError("", what, repair)
    if run.attrs["ended"] == "change point":
        what = _(
            "the motion reaches the change point at {value:.9g} {unit} after {time:.6g} s: the assembly mode is "
            "kept, and beyond it the motion would be a different one"
        ).format(
            value=float(run["occasion_value"].values[-1]),
            unit=terminal_unit(run["occasion_value"].attrs["units"]),
            time=float(run["occasion_time"].values[-1]),
        )
        repair = _('choose continuation = "smooth" in [assembly], which passes it, or a shorter time')
        raise MotionError("", what, repair)


def _check_multibody(run: xr.Dataset) -> None:
    """Raise MotionError where the equations of all links did not get to the end."""
    if run.attrs["ended"] in ("duration", "event"):
        return
    time = float(run["time"].values[-1]) if run.sizes["sample"] else 0.0
    cause = str(run.attrs["cause"])
    what = {
        "change point": _("it reaches a change point that it does not pass: {cause}"),
        "blow-up": _("the motion grows beyond all bounds: {cause}"),
        "ambiguous friction": _("friction has no or several solutions: {cause}"),
    }.get(run.attrs["ended"], _("it is broken off after {time:.6g} s: {cause}"))
    repair = _("give a shorter time, or look at what acts there: loads, masses, speeds at the start")
    raise MotionError("", what.format(time=time, cause=cause), repair)


def _has_turned(mechanism: Mechanism, run: xr.Dataset) -> bool:
    """Whether the drive has turned all the way round, and nothing has stopped it."""
    turned = float(run["turned"].values.max())
    return mechanism.motion_parameter.turns and run.attrs["ended"] in ("duration", "turns") and turned >= tau
