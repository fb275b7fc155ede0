"""Parameter studies: what the terminal, the table and the figure show."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import isnan, prod
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.plots import AxisLabel, Curve, CurvePanel, Plot
from centrode.sheets.sheet import Column, Deferred, Fact, Failure, Sheet, Table
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Text, Title
from centrode.sweeps.parameter_studies import PLACE, REFUSAL, STATUS
from centrode.views.columns import unit_of
from centrode.views.motion_plots import CURVES, over_samples

if TYPE_CHECKING:
    import xarray as xr

    from centrode.sweeps.parameter_studies import ParameterStudy

Array: TypeAlias = NDArray[np.float64]

SHOWN = 20
"""Numbers that are listed."""
PANELS = 4
"""Panels of a figure."""
CONSTANT = 1e-9
"""What varies by less than this share over all mechanisms does not depend on what varies, and is not drawn."""
QUANTITIES = {
    ("rad/s", False): Sentence("speed"),
    ("rad", True): Sentence("place"),
    ("m", True): Sentence("place"),
    ("J", False): Sentence("change of energy"),
    ("kg m^2", False): Sentence("moment of inertia"),
    ("N", False): Sentence("force"),
    ("N m", False): Sentence("moment"),
}
"""What several numbers of one unit are called, by the unit and whether they are places."""
ANALYSES = {
    "simulate": Sentence("steady regime of the simulation"),
    "steady_motion": Sentence("steady motion at the mean speed of the machine"),
    "flywheel": Sentence("flywheel"),
    "reactions": Sentence("reactions over the motion"),
}
TITLES: dict[str, Text] = {
    "least_speed": Sentence("least speed"),
    "least_speed_at": Sentence("place of the least speed"),
    "greatest_speed": Sentence("greatest speed"),
    "greatest_speed_at": Sentence("place of the greatest speed"),
    "mean_speed": Sentence("mean speed"),
    "fluctuation": Sentence("coefficient of fluctuation"),
    "driving_moment": Sentence("mean driving moment"),
    "period": Sentence("period"),
    "multiplier": Sentence("share of a deviation left after a period"),
    "energy_least": Sentence("least change of energy"),
    "energy_least_at": Sentence("place of the least change of energy"),
    "energy_greatest": Sentence("greatest change of energy"),
    "energy_greatest_at": Sentence("place of the greatest change of energy"),
    "inertia_first_order": Sentence("inertia to first order"),
    "inertia": Sentence("inertia of what turns evenly"),
    "added": Sentence("inertia of the flywheel"),
    "rim_diameter": Sentence("diameter of the rim"),
    "rim_mass": Sentence("mass of the rim"),
}
"""What the numbers are called; a reaction by its own name."""


def sheet(study: ParameterStudy) -> Sheet:
    """How many mechanisms, how far each number ranges; the table of them, and how they depend on what varies."""
    data = study.data
    return Sheet(
        facts=tuple(_facts(data)),
        tables=Deferred({"study": lambda: _table(data)}),
        datasets={"study": data},
        pictures=dict(_pictures(study)),
        failure=_failure(data),
    )


def _failure(data: xr.Dataset) -> Failure | None:
    """Why no mechanism was computed: the first refusal."""
    if data[STATUS].values.any():
        return None
    cause = Name(str(data[REFUSAL].values.flat[0]))
    return Failure(
        Sentence("no mechanism was computed: {cause}", cause=cause),
        Sentence("choose another range, or change what varies"),
    )


def number_names(data: xr.Dataset) -> list[str]:
    """Names of the numbers of the analysis, without what varies and what follows from it."""
    return [str(name) for name in data.data_vars if "." not in str(name) and name not in (STATUS, REFUSAL)]


def number_title(name: str) -> Text:
    """What a number is called."""
    return TITLES.get(name, Name(name.replace("_", " ")))


def _unit(variable: xr.DataArray) -> str:
    return unit_of(variable) or "1"


def _facts(data: xr.Dataset) -> Iterator[Fact]:
    extents = list(data[STATUS].sizes.values())
    count: Text = Number(prod(extents), digits="d")
    if len(extents) > 1:
        grid = Joined([Number(extent, digits="d") for extent in extents], " x ")
        count = Sentence("{value} ({remark})", value=count, remark=grid)
    yield Fact(Sentence("mechanisms"), count)
    yield Fact(Sentence("computed"), ANALYSES[data.attrs["compute"]])
    refused = int(np.count_nonzero(data[STATUS].values == 0))
    if refused:
        first = Name(next(text for text in data[REFUSAL].values.ravel().tolist() if text))
        yield Fact(
            Sentence("refused"),
            Sentence("{count}, the first: {cause}", count=Number(refused, digits="d"), cause=first),
        )
    names = number_names(data)
    for name in names[:SHOWN]:
        yield Fact(number_title(name), _range(data[name]))
    if len(names) > SHOWN:
        yield Fact(NOTHING, Sentence("and {count} more", count=Number(len(names) - SHOWN, digits="d")))


def _range(variable: xr.DataArray) -> Text:
    """The least and the greatest value over all mechanisms."""
    low, high = (float(fold(variable.values, axis=None)) for fold in (np.fmin.reduce, np.fmax.reduce))
    if isnan(low):
        return Sentence("no number")
    unit = _unit(variable)
    return Sentence("{low} to {high}", low=Number(low, unit, unit_hidden=True), high=Number(high, unit))


def _flat(data: xr.Dataset, name: str) -> Array:
    """Values of a coordinate or a variable, one for each mechanism."""
    return np.asarray(data[name].broadcast_like(data[STATUS]).transpose(*data[STATUS].dims).values.ravel())


def varied_paths(data: xr.Dataset) -> list[str]:
    """Paths of what varies, in the order of the design."""
    along = data[STATUS].dims
    return [str(name) for name, one in data.coords.items() if one.ndim == 1 and one.dims[0] in along]


def _table(data: xr.Dataset) -> Table:
    """A row for each mechanism: what varies, what follows from it, the numbers, why one was refused."""
    following = [str(name) for name in data.data_vars if "." in str(name)]
    columns = [
        Column(name, _flat(data, name), unit_of(data[name]), unit_fixed=True)
        for name in (*varied_paths(data), *following, *number_names(data))
    ]
    refusals = tuple(Name(text) for text in data[REFUSAL].values.ravel().tolist())
    return Table((*columns, Column(REFUSAL, refusals)))


# The figure: numbers over what varies; with two paths a curve for each value of the second.


def _pictures(study: ParameterStudy) -> Iterator[tuple[str, Plot]]:
    data = study.data
    paths, shape = varied_paths(data), data[STATUS].shape
    # of a list of several paths and of grids of more than two there is no one abscissa
    single = len(shape) == 1 and shape[0] > 1
    if not single and not (len(shape) == 2 and shape[0] > 1 and shape[1] <= CURVES):
        return
    first = data[paths[0]]
    panels = _panels(data) if single else _families(data, paths[1])
    order = np.argsort(first.values, kind="stable")
    label = AxisLabel(Name(paths[0]), unit=_unit(first))
    abscissa = over_samples(label, np.asarray(first.values, dtype=np.float64)[order])
    title = Sentence("Parameter study: {what}", what=ANALYSES[data.attrs["compute"]])
    rows = tuple((_in_order(panel, order),) for panel in panels)
    if rows:
        yield "study", Plot(title, Title(study.mechanism.title), abscissa, rows)


def _in_order(panel: CurvePanel, order: NDArray[np.intp]) -> CurvePanel:
    return replace(panel, curves=tuple(replace(curve, values=curve.values[order]) for curve in panel.curves))


def _drawn(data: xr.Dataset) -> list[str]:
    """Names of the numbers that depend on what varies."""
    names = []
    for name in number_names(data):
        values = data[name].values[np.isfinite(data[name].values)]
        if values.size and name != "multiplier" and np.ptp(values) > CONSTANT * np.abs(values).max():
            names.append(name)
    return names


def _panels(data: xr.Dataset) -> list[CurvePanel]:
    """A panel for each unit, with a curve for each number; extremes first, their places behind."""
    groups: dict[tuple[str, bool], list[str]] = {}
    for name in _drawn(data):
        groups.setdefault((_unit(data[name]), name.endswith(PLACE)), []).append(name)
    numbers, places = (
        [_group(data, key, names[:CURVES]) for key, names in groups.items() if key[1] is of_places]
        for of_places in (False, True)
    )
    return numbers[: PANELS - 1] + places[:1]


def _group(data: xr.Dataset, key: tuple[str, bool], names: Sequence[str]) -> CurvePanel:
    """Numbers of one unit."""
    text = QUANTITIES.get(key, NOTHING) if len(names) > 1 else number_title(names[0])
    return _panel(text, key[0], [(number_title(name), data[name].values) for name in names])


def _families(data: xr.Dataset, second: str) -> list[CurvePanel]:
    """A panel for each number that is no place, with a curve for each value of the second path."""
    unit = _unit(data[second])
    names = [Joined((Name(second), Number(value, unit)), " = ") for value in data[second].values.tolist()]
    chosen = [name for name in _drawn(data) if not name.endswith(PLACE)][:PANELS]
    panels = [
        _panel(
            number_title(name),
            _unit(data[name]),
            [(label, data[name].values[:, k]) for k, label in enumerate(names)],
        )
        for name in chosen
    ]
    return [replace(panel, legend=place == 0) for place, panel in enumerate(panels)]


def _panel(title: Text, unit: str, curves: Sequence[tuple[Text, Array]]) -> CurvePanel:
    drawn = tuple(Curve(name, values, place) for place, (name, values) in enumerate(curves))
    scale = max(float(np.nanmax(np.abs(values), initial=0.0)) for _name, values in curves)
    return CurvePanel(AxisLabel(title, unit=unit), drawn, scale, legend=len(curves) > 1)
