"""Velocities by integrating the equations in Cauchy form: the second of three routes, where it applies."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Mapping

import numpy as np
import xarray as xr

from centrode.errors import CentrodeError, Status
from centrode.model.mechanism import Mechanism

STEPS = 100
"""Rows of an integration; of them only the last is asked for."""

# the equations in symbols are heavy, and needed by this column alone
_integrated = functools.partial(importlib.import_module, "centrode.equations.integration")


def integrated_rates(mechanism: Mechanism, exact: xr.Dataset) -> Mapping[tuple[str, str], float]:
    """(quantity, link or point) -> its value at the only sample of a motion, by integration from the initial position.

    Speeds of points are lengths of their velocities. Empty where there are no such equations, where the integration
    does not get to the instant, or where this installation cannot integrate. Accelerations are not integrated.
    """
    stop = float(mechanism.motion_parameter.instants(exact)[0])
    try:
        course = _integrated().integrate(mechanism, "adaptive", steps=STEPS, stop=stop)
    except (ModuleNotFoundError, CentrodeError):
        return {}
    if int(course["status"][-1]) != Status.OK:
        return {}
    last = course.isel(sample=-1)
    found = {
        ("angular_velocity", name): float(last["angular_velocity"].sel(link=name))
        for name in mechanism.link_names
    }
    for name in mechanism.moving_points:
        found["velocity", name] = float(np.hypot(*last["velocity"].sel(point=name).to_numpy()))
    return found
