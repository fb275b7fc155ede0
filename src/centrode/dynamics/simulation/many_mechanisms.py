"""Simulations of many mechanisms of one structure whose numbers differ, as one dataset."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.dynamics.forward_dynamics.batches import (
    ENDS,
    FreeMotions,
    equations_of_many,
    integrate_many,
    numbers_that_vary,
)
from centrode.dynamics.simulation.multibody_motion import (
    MultibodySetting,
    coordinate_names,
    coordinate_variable,
    multibody_setting,
)
from centrode.errors import InputError
from centrode.kinematics.motion import vocabulary_variable
from centrode.locale import _
from centrode.model.files import kind_at, mechanism_text, with_values
from centrode.model.mechanism import Mechanism
from centrode.model.simulation import Simulation
from centrode.model.units import KINDS, read_quantity
from centrode.version import __version__

if TYPE_CHECKING:
    from centrode.kinematics.motion import Variable

Array: TypeAlias = npt.NDArray[np.float64]
Vary: TypeAlias = Mapping[str, Any]

MOST = 1_000_000
"""Mechanisms in one call."""
MOST_THREADS = 256


def simulate_many(
    mechanism: Mechanism,
    settings: Simulation,
    vary: Vary,
    at: npt.ArrayLike | None = None,
    executor: str = "auto",
    progress: Callable[[float], None] | None = None,
    threads: int | None = None,
) -> xr.Dataset:
    """The states of many mechanisms at the end of their simulation, or at instants; see `ct.simulate`."""
    setting = multibody_setting(mechanism, settings)
    if settings.scheme != "adaptive":
        what = _("many mechanisms are integrated by the adaptive scheme")
        raise InputError("[simulation] scheme", what, _('write scheme = "adaptive", or omit vary'))
    instants = np.array([setting.duration]) if at is None and not settings.at else setting.instants(at)
    numbers = _numbers(setting, vary)
    free = setting.free
    start = free.initial(setting.speeds, setting.start)
    motions = integrate_many(
        free, numbers, start, instants, settings.tolerance, _threads(threads), executor, progress
    )
    return many_dataset(setting, numbers, motions)


def _threads(given: object) -> int:
    if given is None:
        return max(1, min(os.cpu_count() or 1, MOST_THREADS))
    if isinstance(given, bool) or not isinstance(given, int) or not 1 <= given <= MOST_THREADS:
        what = _("{count} is not a valid number of threads").format(count=given)
        raise InputError("threads", what, _("give a whole number from 1 to {most}").format(most=MOST_THREADS))
    return given


def _numbers(setting: MultibodySetting, vary: Any) -> dict[str, Array]:
    """Values (mechanisms) of every path [SI]; InputError for what no mechanism of this structure can have."""
    if not isinstance(vary, Mapping) or not vary:
        raise InputError(
            "vary", _("nothing varies"), _('name a path and its values: {"links.AC.length": [...]}')
        )
    numbers = {path: _values(setting.mechanism, path, given) for path, given in vary.items()}
    sizes = {path: values.size for path, values in numbers.items()}
    if len(set(sizes.values())) > 1:
        told = ", ".join(f"{path} {size}" for path, size in sizes.items())
        what = _("every path needs the same number of values; got {counts}").format(counts=told)
        raise InputError("vary", what, _("give one value for each mechanism"))
    if not 1 <= next(iter(sizes.values())) <= MOST:
        raise InputError(
            "vary", _("it has no values, or too many"), _("give at most {most}").format(most=MOST)
        )
    for choose in (np.min, np.max):
        # what lies between the ends is possible where both are
        with_values(setting.mechanism, {path: float(choose(values)) for path, values in numbers.items()})
    for path, values in numbers.items():
        if not numbers_that_vary(equations_of_many(setting.free, {path: np.resize(values, 2)})):
            what = _("it is no length, mass or load of the simulation that may vary")
            raise InputError(path, what, _("vary dimensions, masses and loads"))
    return numbers


def _values(mechanism: Mechanism, path: str, given: Any) -> Array:
    """Values of a path [SI]; texts have a unit."""
    kind = kind_at(mechanism, path)
    if isinstance(given, str) or not np.iterable(given):
        raise InputError(path, _("it needs a list of values"), _("give one for each mechanism"))
    if isinstance(given, np.ndarray) and given.dtype.kind in "fiu":
        values = np.asarray(given, dtype=np.float64)
    else:
        values = np.array([read_quantity(one, kind, path) for one in given], dtype=np.float64)
    if values.ndim != 1 or not np.all(np.isfinite(values)):
        raise InputError(path, _("values have to be finite, and in one row"), _("correct them"))
    return values


def many_dataset(setting: MultibodySetting, numbers: Mapping[str, Array], motions: FreeMotions) -> xr.Dataset:
    """The labelled result: the numbers that vary along `mechanism`, states at the instants of `sample`."""
    mechanism, free = setting.mechanism, setting.free
    across = ("mechanism", "sample")
    variables: dict[str, Variable] = {}
    for name, values, behind in (
        ("generalised_coordinate", motions.coordinates, ""),
        ("generalised_velocity", motions.speeds, "/s"),
    ):
        rows = np.moveaxis(values, -1, 0)
        variables[name] = coordinate_variable(free, name, (*across, "coordinate"), rows, behind)
    for name, values in (
        ("kinetic_energy", motions.kinetic_energy),
        ("potential_energy", motions.potential_energy),
        ("energy_residual", motions.energy_residual),
    ):
        variables[name] = vocabulary_variable(name, across, values.T)
    attributes = {
        "flag_values": np.arange(len(ENDS), dtype=np.int8),
        "flag_meanings": " ".join(word.replace(" ", "_") for word in ENDS),
    }
    labels: dict[str, Any] = {
        "time": vocabulary_variable("time", ("sample",), motions.times),
        "coordinate": ("coordinate", list(coordinate_names(free))),
        **{
            path: ("mechanism", values, {"units": KINDS[kind_at(mechanism, path)].unit})
            for path, values in numbers.items()
        },
    }
    whole = motions.ended == 0
    found = xr.Dataset(
        {
            **variables,
            "reached": ("mechanism", motions.reached, {"units": "s"}),
            "ended": ("mechanism", motions.ended, attributes),
        },
        labels,
    )
    return found.assign_attrs(
        topic="simulations",
        title=mechanism.title,
        mechanism=mechanism_text(mechanism.model_copy(update={"simulation": setting.settings})),
        version=__version__,
        mobility=free.mobility,
        mechanisms=len(motions.ended),
        mechanisms_whole=int(np.sum(whole)),
        worst_energy_residual=float(np.nanmax(np.abs(motions.energy_residual), initial=0.0)),
    )
