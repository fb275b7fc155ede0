"""A machine that is left to itself: its motion under loads and a drive, and the steady regime that it runs up to."""

from __future__ import annotations

from dataclasses import dataclass
from math import tau
from typing import TYPE_CHECKING, Any

from centrode.dynamics.masses import has_masses_or_loads
from centrode.dynamics.simulation.simulate import Tell, simulate
from centrode.dynamics.simulation.steady_state import Regime, steady_regime
from centrode.errors import CentrodeError, InputError, MotionError
from centrode.locale import _
from centrode.model.simulation import Simulation
from centrode.quantities import terminal_unit

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.mechanism import Mechanism


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
    """

    mechanism: Mechanism
    settings: Simulation
    simulation: xr.Dataset
    regime: Regime | None
    no_regime: str


def simulation_results(
    mechanism: Mechanism,
    samples: int | None = None,
    *,
    settings: Simulation | None = None,
    motion: bool = False,
    progress: Tell | None = None,
    **changes: Any,
) -> SimulationResults:
    """Let a machine run, and find the steady regime that it runs up to.

    Parameters
    ----------
    samples : evenly spaced in time
    settings : in place of those of the description
    motion : also places, velocities and accelerations of everything
    progress : called with the share that is done
    changes : `duration`, `turns`, `driving`, `speed`, `scheme`, `steps` in place of those of the settings

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
    return _with_regime(mechanism, used, simulate(mechanism, used, motion=motion, progress=progress))


def results_of_simulation(mechanism: Mechanism, run: xr.Dataset) -> SimulationResults:
    """A dataset of `simulate`, whose mechanism has the settings that it ran by, with the regime that it ran up to."""
    return _with_regime(mechanism, changed_settings(mechanism), run)


def _with_regime(mechanism: Mechanism, used: Simulation, run: xr.Dataset) -> SimulationResults:
    """A simulation with the regime of a drive that has turned all the way round."""
    regime, reason = None, ""
    if _has_turned(mechanism, run):
        try:
            regime = steady_regime(mechanism, used)
        except CentrodeError as failure:
            reason = failure.what
    return SimulationResults(mechanism, used, run, regime, reason)


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
    if not known and not given:
        raise InputError(
            "[simulation]", _("it is missing"), _('add --driving "20 - 2*v" and --duration "10 s"')
        )
    return Simulation.for_parameter(mechanism.motion_parameter, **known | given)


def simulation_extent(mechanism: Mechanism, samples: int | None = None, **options: Any) -> tuple[int, float]:
    """Samples of a simulation, and turns of the drive at the speed of the start up to where it ends."""
    options.pop("motion", None)
    settings = changed_settings(mechanism, samples, **options)
    ends = [settings.turns] if settings.turns is not None else []
    if settings.duration is not None:
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
    if run.attrs["ended"] == "limit":
        what = _("it stops at a limit after {time:.6g} s").format(time=float(run["time"].values[-1]))
        raise MotionError("", what, _("give a shorter time, or change the drive or the dimensions"))
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


def _has_turned(mechanism: Mechanism, run: xr.Dataset) -> bool:
    """Whether the drive has turned all the way round, and nothing has stopped it."""
    turned = float(run["turned"].values.max())
    return mechanism.motion_parameter.turns and run.attrs["ended"] in ("duration", "turns") and turned >= tau
