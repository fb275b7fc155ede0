"""An importer of FMUs as models of exchange that integrates by an explicit method of order 8: FMPy has none."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from ctypes import c_double

import fmpy
import numpy as np
import numpy.typing as npt
from fmpy.fmi3 import FMU3Model
from scipy.integrate import solve_ivp

Array = npt.NDArray[np.float64]


def exchanged_outputs(
    file: str, times: Array, outputs: Sequence[str], given: Mapping[str, float], tolerance: float
) -> Array:
    """Outputs (times, outputs) of an FMU with constant inputs, its states integrated to a tolerance."""
    description = fmpy.read_model_description(file)
    references = {one.name: one.valueReference for one in description.modelVariables}
    model = FMU3Model(
        guid=description.guid, modelIdentifier=description.modelExchange.modelIdentifier,
        unzipDirectory=fmpy.extract(file), instanceName="model",
    )  # fmt: skip
    model.instantiate()
    for name, value in given.items():
        model.setFloat64([references[name]], [value])
    model.enterInitializationMode()
    model.exitInitializationMode()
    model.enterContinuousTimeMode()
    count = model.getNumberOfContinuousStates()
    states, rates = ((c_double * count)() for _k in range(2))
    model.getContinuousStates(states, count)

    def put(time: float, values: Array) -> None:
        model.setTime(time)
        states[:] = list(values)
        model.setContinuousStates(states, count)

    def derivatives(time: float, values: Array) -> Array:
        put(time, values)
        model.getContinuousStateDerivatives(rates, count)
        return np.array(rates[:])

    values, rows = np.array(states[:]), []
    for k, time in enumerate(times):
        if k:
            # to the time itself: what lies between steps is interpolated to less
            span = (times[k - 1], time)
            values = solve_ivp(derivatives, span, values, method="DOP853", rtol=tolerance, atol=tolerance).y[
                :, -1
            ]
        put(time, values)
        rows.append(model.getFloat64([references[name] for name in outputs]))
    model.terminate()
    model.freeInstance()
    return np.array(rows)
