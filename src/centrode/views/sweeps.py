"""Sweeps over many mechanisms: what the terminal and the table show."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from centrode.sheets.sheet import Column, Deferred, Fact, Failure, Sheet, Table
from centrode.sheets.texts import NOTHING, Joined, Name, Number, Sentence, Text
from centrode.sweeps.executors import bare, reason_of
from centrode.sweeps.sweep import check_table
from centrode.views.columns import unit_of

if TYPE_CHECKING:
    import xarray as xr

    from centrode.sweeps.sweep import SweepResults

SHOWN = 20
"""Extremes of this many numbers are listed."""


def sheet(results: SweepResults) -> Sheet:
    """How many mechanisms, how far they move, how well they close, extremes of what is reduced; the table of these."""
    data = results.data
    failure = Failure(
        Sentence("no mechanism has a valid sample"),
        Sentence("choose another range, or change what varies"),
    )
    return Sheet(
        facts=tuple(_facts(data)),
        tables=Deferred({"sweep": lambda: _table(data)}),
        failure=failure if data.attrs["mechanisms_none"] == data.attrs["mechanisms"] else None,
    )


def _count(value: int) -> Number:
    return Number(value, digits="d")


def _facts(data: xr.Dataset) -> Iterator[Fact]:
    attributes = data.attrs
    extents = list(data["samples_ok"].sizes.values())
    count: Text = _count(math.prod(extents))
    if len(extents) > 1:
        grid = Joined([_count(extent) for extent in extents], " x ")
        count = Sentence("{value} ({remark})", value=count, remark=grid)
    whole, none = attributes["mechanisms_whole"], attributes["mechanisms_none"]
    some = attributes["mechanisms"] - whole - none
    yield Fact(Sentence("mechanisms"), count)
    yield Fact(Sentence("samples"), _count(attributes["samples"]))
    yield Fact(
        Sentence("ok"),
        Sentence(
            "at every sample {whole}, at some {some}, at none {none}",
            whole=_count(whole),
            some=_count(some),
            none=_count(none),
        ),
    )
    yield Fact(Sentence("worst residual"), _residual(attributes["worst_residual"]))
    yield Fact(Sentence("executor"), _executor(attributes["executor"]))
    extremes = list(_extremes(data))
    yield from extremes[:SHOWN]
    if len(extremes) > SHOWN:
        yield Fact(NOTHING, Sentence("and {count} more", count=_count(len(extremes) - SHOWN)))


def _residual(residual: float) -> Text:
    # where no sample is ok there is no residual
    if math.isnan(residual):
        return Sentence("none")
    return Sentence("{value} of the greatest length", value=Number(residual, digits=".1e"))


def _executor(executor: str) -> Text:
    """The executor by its name, with the reason why it is this one."""
    name, reason = Name(bare(executor)), reason_of(executor)
    return Sentence("{value} ({remark})", value=name, remark=Sentence(reason)) if reason else name


def _extremes(data: xr.Dataset) -> Iterator[Fact]:
    """The least and the greatest value of each reduced number over all mechanisms, in SI."""
    for name, variable in data.data_vars.items():
        if "least" not in variable.attrs:
            continue
        least, greatest = np.atleast_1d(variable.attrs["least"]), np.atleast_1d(variable.attrs["greatest"])
        for labels, low, high in zip(_labels(data, variable), least, greatest, strict=True):
            text: Text = Sentence("no number")
            if not math.isnan(low):
                text = Sentence(
                    "{low} to {high}",
                    low=Number(low, digits=".9g"),
                    high=Number(high, unit_of(variable) or "1", ".9g", unit_fixed=True),
                )
            yield Fact(Name(".".join((str(name), *labels))), text)


def _labels(data: xr.Dataset, variable: xr.DataArray) -> Iterator[tuple[str, ...]]:
    """Labels of each number that a variable holds of one mechanism."""
    mechanisms = data["samples_ok"].dims
    rooms = [data[name].values.tolist() for name in variable.dims if name not in mechanisms]
    for labels in itertools.product(*rooms):
        yield tuple(map(str, labels))


def _table(data: xr.Dataset) -> Table:
    """A row for each mechanism, the varied values first, in SI; raises InputError where there is no such table."""
    check_table(data)
    mechanisms = data["samples_ok"]
    places = np.unravel_index(np.arange(mechanisms.size), mechanisms.shape)
    columns = []
    for name, coordinate in data.coords.items():
        if len(coordinate.dims) == 1 and coordinate.dims[0] in mechanisms.dims:
            along = mechanisms.dims.index(coordinate.dims[0])
            columns.append(_column(str(name), coordinate, coordinate.values[places[along]]))
    for name, variable in data.data_vars.items():
        numbers = variable.values.reshape(mechanisms.size, -1).T
        for labels, values in zip(_labels(data, variable), numbers, strict=True):
            columns.append(_column("_".join((str(name).replace(".", "_"), *labels)), variable, values))
    return Table(tuple(columns))


def _column(name: str, variable: xr.DataArray, values: NDArray[np.float64]) -> Column:
    return Column(name, values, unit_of(variable), unit_fixed=True)
