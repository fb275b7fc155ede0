"""The motion of a machine that is left to itself, as a labelled result: which equations it is computed by."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, get_args

from centrode.dynamics.simulation.routes import MULTIBODY, Tell, equations_for, no_settings
from centrode.errors import InputError
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of

if TYPE_CHECKING:
    import numpy.typing as npt
    import xarray as xr

    from centrode.model.simulation import Simulation

# a simulation needs what one of the routes does
_reduced = functools.partial(importlib.import_module, "centrode.dynamics.simulation.reduced_motion")
_multibody = functools.partial(importlib.import_module, "centrode.dynamics.simulation.multibody_motion")
_gradients = functools.partial(importlib.import_module, "centrode.dynamics.sensitivities.motion_gradients")
_many = functools.partial(importlib.import_module, "centrode.dynamics.simulation.many_mechanisms")

Executor: TypeAlias = Literal["auto", "arrays", "machine code"]


def simulate(
    mechanism: MechanismSource,
    settings: Simulation | None = None,
    *,
    at: npt.ArrayLike | None = None,
    motion: bool = False,
    executor: Executor = "auto",
    progress: Tell | None = None,
    reactions: bool = False,
    vary: Mapping[str, Any] | None = None,
    threads: int | None = None,
    gradients: Sequence[str] = (),
    at_events: bool = False,
) -> xr.Dataset:
    """The motion of a mechanism under its loads and what drives it, or the states of many that differ in numbers.

    One drive that has all the mobility moves by the reduced equation; any number of degrees of freedom by the equations
    of all links with their constraints (`equations="multibody"` of the settings): its result has everything that moves.

    Parameters
    ----------
    settings : Simulation
        In place of the description's own.
    at : (n) times [s] or texts with a unit, growing
        Exactly these instants instead of evenly spaced ones.
    motion : bool
        Also positions, velocities and accelerations of everything.
    executor : "auto", "arrays" or "machine code"
        Of the equations of all links.
    progress : called with the share that is done
    reactions : bool
        Also the reactions in all joints at these instants, by the equations of all links; names are those of
        `ct.reactions`, NaN where redundant constraints leave them open.
    vary : path -> values (mechanisms), numbers [SI] or texts with a unit
        Lengths, masses and loads of many mechanisms of one structure, integrated together by the equations of all
        links. Each starts in the state that is nearest to the described one.
    threads : that share them; as many as there are processors by default
    gradients : paths of numbers of the description
        Also the derivatives of the motion by these, by the equations of all links: `coordinate_gradient`,
        `speed_gradient`, `position_gradient` and `point_speed_gradient` by `number`; through events too, whose own are
        `occasion_time_gradient` and those of `occasion_position` and `occasion_point_speed`.
    at_events : bool
        Also the instants of impacts, sticking, opening and all other events, as the motion goes on behind them, by
        the equations of all links; the reduced equation has none at which anything jumps.

    Returns
    -------
    Dataset
        Value, speed and acceleration of the drive, moments, works, energies and powers over time, `occasion_...` and
        what ended it (docs: simulation). Speeds and moments count along the coordinate of the drive, `turned` in the
        sense in which it sets out. With `vary` coordinates, velocities and energies of every `mechanism` at the
        instants of `at`, at the end without it; `ended` says how, `reached` [s] how far each came.

    Raises
    ------
    InputError
        No settings, several drives, nothing with mass, a start at a dead position.
    MotionError
        Nothing sets it in motion, or a formula has no value on the way.

    Examples
    --------
    >>> import centrode as ct
    >>> settings = ct.Simulation(driving="2000", duration="0.2 s")
    >>> run = ct.simulate(ct.example("six-bar-press-run-up"), settings)
    >>> run.attrs["ended"]
    'duration'
    >>> pendulum = ct.Mechanism(
    ...     gravity=[0, -9.81],
    ...     frame={"points": {"O": [0, 0]}},
    ...     links={"OA": {"length": 1, "mass": 1, "shape": "rod", "angle": 0}},
    ... )
    >>> many = ct.simulate(pendulum, ct.Simulation(duration="1 s"), vary={"links.OA.length": [0.5, "80 cm"]})
    >>> many.generalised_coordinate.shape
    (2, 1, 1)
    """
    mechanism = mechanism_of(mechanism)
    if executor not in get_args(Executor):
        raise InputError(
            "executor",
            _("{name} is not a scheme of integration").format(name=f'"{executor}"'),
            _("use one of {known}").format(known=", ".join(get_args(Executor))),
        )
    settings = settings or mechanism.simulation
    if vary is not None:
        if settings is None:
            raise no_settings()
        many: xr.Dataset = _many().simulate_many(mechanism, settings, vary, at, executor, progress, threads)
        return many
    if settings is not None and equations_for(mechanism, settings) == MULTIBODY:
        run: xr.Dataset = _multibody().simulate_multibody(
            mechanism, settings, at, executor, progress, reactions, at_events
        )
        if gradients:
            run = _gradients().add_gradients(mechanism, settings, run, gradients, executor)
        return run
    if gradients:
        what = _("derivatives of a motion come from the equations of all links")
        raise InputError("gradients", what, _('write equations = "multibody" in [simulation]'))
    if reactions:
        what = _("reactions in a simulation come from the equations of all links")
        raise InputError("reactions", what, _('write equations = "multibody" in [simulation]'))
    if executor == "machine code":
        raise InputError(
            "executor",
            _("the reduced equation has no machine code"),
            _('use executor = "auto", or equations = "multibody"'),
        )
    reduced: xr.Dataset = _reduced().simulate_reduced(mechanism, settings, at, progress, motion=motion)
    return reduced
