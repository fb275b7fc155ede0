"""The reachable region of two drives: what the terminal, the files and the picture show."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.errors import Status
from centrode.sheets.plots import Area, AreaDiagram, AreaKind, AreaPath, AxisLabel
from centrode.sheets.sheet import Column, Fact, Sheet, Table
from centrode.sheets.texts import Joined, Name, Number, Sentence, Text, Title
from centrode.views.abscissa import drive_label
from centrode.views.columns import counted_statuses
from centrode.views.instants import place_number

if TYPE_CHECKING:
    import xarray

    from centrode.kinematics.several_inputs.region import RegionResults

Array: TypeAlias = NDArray[np.float64]

DIMENSIONS = ("first", "second")
TURN = 2.0 * np.pi


def sheet(results: RegionResults) -> Sheet:
    """Ranges and statuses of the grid, its nodes and the limits on its lines, and the picture of the region."""
    region = results.region
    return Sheet(
        facts=tuple(_facts(region)),
        tables={"region": _nodes(region), "border": _border(region)},
        datasets={"region": region},
        pictures={"region": _diagram(results)},
    )


def _facts(region: xarray.Dataset) -> Iterator[Fact]:
    """Ranges of both drives, how much of the grid is reached, and how many limits bound it."""
    for number, dimension in enumerate(DIMENSIONS):
        values, unit = region[dimension].values, _unit(region, dimension)
        ends = Sentence(
            "{first} to {last}",
            first=place_number(float(values[0]), unit),
            last=place_number(float(values[-1]), unit),
        )
        yield Fact(Sentence("drive {name}", name=Name(str(region["drive"].values[number]))), ends)
    status = region["status"].values
    yield Fact(
        Sentence("grid nodes"), Joined((Number(status.size, digits="d"), counted_statuses(status)), ": ")
    )
    yield Fact(Sentence("limits on grid lines"), _limits(region))


def _limits(region: xarray.Dataset) -> Text:
    """How many limits there are on grid lines, and how many of them bound the region."""
    count, around = region.sizes["border"], int(region["border_reached"].values.sum())
    n = Number(count, digits="d")
    if not count:
        return Sentence("none")
    if not around:
        return Sentence("{n}, none around the region", n=n)
    if around == count:
        return Sentence("{n}, all around the region", n=n)
    return Sentence("{n}, {bounds} of them around the region", n=n, bounds=Number(around, digits="d"))


def _unit(region: xarray.Dataset, dimension: str) -> str:
    return str(region[dimension].attrs["units"])


def _nodes(region: xarray.Dataset) -> Table:
    """One row a grid node."""
    grid = np.meshgrid(*(region[dimension].values for dimension in DIMENSIONS), indexing="ij")
    words = tuple(Name(Status(code).word) for code in region["status"].values.ravel().tolist())
    margin = Column("margin", region["margin"].values.ravel())
    return Table((*_drives(region, [values.ravel() for values in grid]), Column("status", words), margin))


def _border(region: xarray.Dataset) -> Table:
    """One row a limit on a grid line."""
    groups = tuple(map(Name, map(str, region["border_group"].values)))
    bounds = tuple(Name("yes" if one else "no") for one in region["border_reached"].values)
    values = region["border_value"].values
    drives = _drives(region, [values[:, number] for number in range(len(DIMENSIONS))])
    return Table((*drives, Column("group", groups), Column("bounds the region", bounds)))


def _drives(region: xarray.Dataset, values: list[Array]) -> Iterator[Column]:
    for name, dimension, column in zip(region["drive"].values, DIMENSIONS, values, strict=True):
        yield Column(f"drive_{name}", column, _unit(region, dimension))


def _diagram(results: RegionResults) -> AreaDiagram:
    """What is reached and what is cut off, the path that the drives take in time, and the initial position."""
    region, mechanism = results.region, results.mechanism
    x, y = (_label(results, number) for number in range(len(DIMENSIONS)))
    across, up = (region[dimension].values for dimension in DIMENSIONS)
    start = region["initial_value"].values
    return AreaDiagram(
        Sentence("Reachable region of two drives"),
        Title(mechanism.title),
        x,
        y,
        across,
        up,
        tuple(_areas(region)),
        tuple(_paths(results)),
        ((Sentence("initial position"), float(start[0]), float(start[1])),),
    )


def _label(results: RegionResults, number: int) -> AxisLabel:
    name = str(results.region["drive"].values[number])
    return drive_label(results.mechanism.motion_parameter.drive(name))


def _areas(region: xarray.Dataset) -> Iterator[Area]:
    status, margin = region["status"].values, region["margin"].values
    for kind, name, drawn in (
        (Status.OK, Sentence("reached"), AreaKind.MAIN),
        (Status.CUT_OFF, Sentence("closes, but cut off"), AreaKind.BESIDE),
    ):
        yield Area(name, _levels(status, margin, kind), drawn)


def _levels(status: NDArray[np.int8], margin: Array, kind: Status) -> Array:
    """A number that is positive where a status is and passes through zero at the limits around it."""
    size = np.nan_to_num(np.abs(margin), nan=1.0)
    # between two parts of different status, both closed, the border lies half way
    return np.where(status == kind, np.maximum(size, 1e-12), -size - 1e-300)


def _paths(results: RegionResults) -> Iterator[AreaPath]:
    """The path of the drives in time, and its part where the mechanism does not get."""
    motion = results.motion
    if motion is None:
        return
    values = [_wrap(results, number, motion) for number in range(len(DIMENSIONS))]
    ok = motion["status"].values == Status.OK
    jumps = np.flatnonzero(np.any([np.abs(np.diff(one)) > 0.5 * TURN for one in values], axis=0))
    for regular, name, drawn in (
        (ok, Sentence("path of the drives in time"), AreaKind.MAIN),
        (~ok, Sentence("path that is not reached"), AreaKind.BESIDE),
    ):
        if regular.any():
            x, y = (np.insert(np.where(regular, one, np.nan), jumps + 1, np.nan) for one in values)
            yield AreaPath(name, x, y, drawn)


def _wrap(results: RegionResults, number: int, motion: xarray.Dataset) -> Array:
    """Values of a drive over the motion; whole turns are taken out where the region is a turn wide."""
    name = str(results.region["drive"].values[number])
    first, last = results.region[DIMENSIONS[number]].values[[0, -1]]
    values: Array = motion["drive_value"].sel(drive=name).values
    if results.mechanism.motion_parameter.drive(name).turns and last - first >= TURN * (1 - 1e-9):
        values = values - TURN * np.floor((values - first) / TURN)
    return values
