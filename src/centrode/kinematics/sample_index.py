"""Samples of a result by the value of a drive, or by the angle of a cam: `motion.sel(OA="60 deg")`.

xarray aligns datasets by the values of an index and joins them on these. A motion may pass a value many times, and its
samples go together by their order, so its index aligns by order and is used to select alone.
"""

from __future__ import annotations

import functools
from collections.abc import Hashable, Iterable, Mapping, Sequence
from typing import Any, Literal, Self, TypeAlias

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr
from xarray.core.indexing import IndexSelResult
from xarray.indexes import PandasIndex

from centrode.errors import InputError
from centrode.locale import _
from centrode.model.motion_parameter import MotionVariable
from centrode.model.reading import value_text
from centrode.quantities import QUANTITIES

Array: TypeAlias = npt.NDArray[np.float64]
Places: TypeAlias = npt.NDArray[np.intp]
Direction: TypeAlias = Literal["nearest", "before", "behind"]

SAMPLE = "sample"
KINDS_OF_UNITS: Mapping[str, Literal["angle", "length", "time"]] = {
    "rad": "angle",
    "m": "length",
    "s": "time",
}
CAM_ANGLES = ("cam_angle", "carrier_angle")
DIMENSIONS = frozenset(
    (
        *("sample", "point", "link", "guide", "rolling", "drive", "drive_2", "drive_3", "axis", "event"),
        *("mechanism", "joint", "group", "pair", "constraint", "load", "jump", "order", "coefficient"),
        *("side", "side_point", "side_link", "held", "gear", "gear_body", "friction", "occasion"),
        *(
            "coordinate",
            "contact",
            "controller",
            "source",
            "equilibrium",
            "mode",
            "freedom",
            "root",
            "number",
            "band",
            "end",
            "branch_point",
            "critical",
        ),
        *("bearing", "surface", "sector"),
    )
)
"""Names that a drive may not take among the coordinates."""
ROUNDING = 8 * float(np.finfo(np.float64).eps)
"""Values that differ by so much of the greatest are the same: samples are spaced evenly, texts converted."""
DIRECTIONS: Mapping[str, Direction] = {
    "nearest": "nearest",
    "pad": "before",
    "ffill": "before",
    "backfill": "behind",
    "bfill": "behind",
}
"""Methods of xarray -> which sample stands for a value between two."""


class SampleIndex(xr.Index):
    """Samples by the values of drives along them; labels are numbers in SI or texts with a unit.

    Attributes
    ----------
    values : name of a coordinate -> its values (sample) [rad or m]
    units : name -> SI unit
    """

    def __init__(self, values: Mapping[Hashable, Array], units: Mapping[Hashable, str]) -> None:
        self.values = values
        self.units = units

    @classmethod
    def from_variables(
        cls, variables: Mapping[Any, xr.Variable], *, options: Mapping[str, Any]
    ) -> SampleIndex:
        """The index of coordinates along `sample`; ValueError for a coordinate along anything else."""
        if any(variable.dims != (SAMPLE,) for variable in variables.values()):
            raise ValueError("a SampleIndex takes coordinates along the dimension sample")
        return cls(
            {name: variable.values for name, variable in variables.items()},
            {name: variable.attrs.get("units", "") for name, variable in variables.items()},
        )

    @classmethod
    def concat(
        cls, indexes: Sequence[Self], dim: Hashable, positions: Iterable[Iterable[int]] | None = None
    ) -> Self:
        """The index of samples one after another, or at given positions."""
        first = indexes[0]
        values = {name: np.concatenate([each.values[name] for each in indexes]) for name in first.values}
        if positions is not None:
            order = np.argsort(np.concatenate([np.asarray(list(one), dtype=np.intp) for one in positions]))
            values = {name: one[order] for name, one in values.items()}
        return cls(values, first.units)

    def create_variables(self, variables: Mapping[Any, xr.Variable] | None = None) -> dict[Any, xr.Variable]:
        """The coordinates, with the attributes of those given."""
        known, found = variables or {}, dict[Any, xr.Variable]()
        for name, values in self.values.items():
            given = known.get(name)
            attributes = {"units": self.units[name]} if given is None else given.attrs
            # xarray gives the variable before a roll or a join, whose values are others
            if given is None or given.values is not values:
                given = xr.Variable((SAMPLE,), values, attributes)
            found[name] = given
        return found

    def isel(self, indexers: Mapping[Any, Any]) -> SampleIndex | None:
        """The index of some of the samples; None where one is taken, or where they lie along another dimension."""
        indexer = indexers[SAMPLE]
        if isinstance(indexer, xr.Variable):
            if indexer.dims != (SAMPLE,):
                return None
            indexer = indexer.values
        if not isinstance(indexer, slice) and np.ndim(indexer) != 1:
            return None
        return SampleIndex({name: values[indexer] for name, values in self.values.items()}, self.units)

    def sel(self, labels: dict[Any, Any], method: str | None = None, tolerance: Any = None) -> IndexSelResult:
        """Which samples have the values of labels: a value, several of them, or a slice with both ends.

        A value that the motion passes several times selects all these samples, so the dimension stays. With several
        drives all labels hold. Raises InputError where no sample has a value, for a text without a unit, and for
        a method that xarray does not know.
        """
        if len(labels) > 1:
            if method is not None:
                what = _("a method takes the value of one drive")
                raise InputError("sel", what, _("select by one drive after the other"))
            chosen = np.logical_and.reduce(
                [self._holding(name, label, tolerance) for name, label in labels.items()]
            )
            return IndexSelResult({SAMPLE: _indexer(np.flatnonzero(chosen))})
        ((name, label),) = labels.items()
        if isinstance(label, slice):
            return IndexSelResult({SAMPLE: _indexer(self._between(name, label))})
        if isinstance(label, xr.DataArray | xr.Variable):
            places = self._one_each(name, label.values, method, tolerance)
            found = xr.Variable(label.dims, places)
            if isinstance(label, xr.DataArray):
                return IndexSelResult({SAMPLE: xr.DataArray(found, coords=label.coords)})
            return IndexSelResult({SAMPLE: found})
        if isinstance(label, str) or np.ndim(label) == 0:
            places = self._passing(name, label, method, tolerance)
            return IndexSelResult({SAMPLE: int(places[0]) if places.size == 1 else _indexer(places)})
        each = [
            self._passing(name, one, method, tolerance) for one in np.ravel(np.asarray(label, dtype=object))
        ]
        return IndexSelResult({SAMPLE: np.concatenate([*each, np.array([], dtype=np.intp)])})

    def equals(self, other: xr.Index, *, exclude: frozenset[Hashable] | None = None) -> bool:
        """Whether the samples stand at the same values, to rounding."""
        if not isinstance(other, SampleIndex) or self.values.keys() != other.values.keys():
            return False
        return self is other or all(
            values is other.values[name] or _same(values, other.values[name])
            for name, values in self.values.items()
        )

    def join(self, other: Self, how: str = "inner") -> Self:
        """The index of samples that go together by their order: NaN where their values differ.

        Raises ValueError for different numbers of samples.
        """
        values = {}
        for name, ours in self.values.items():
            theirs = other.values[name]
            if ours.size != theirs.size:
                raise ValueError(
                    f"cannot align along dimension 'sample' because of different sizes: {ours.size}, {theirs.size}"
                )
            values[name] = np.where(_agreeing(ours, theirs), ours, np.nan)
        return type(self)(values, self.units)

    def reindex_like(self, other: Self) -> dict[Hashable, Any]:
        """Every sample stays where it is; ValueError for another number of samples."""
        sizes = {values.size for values in (*self.values.values(), *other.values.values())}
        if len(sizes) != 1:
            raise ValueError(
                f"cannot align along dimension 'sample' because of different sizes: {sorted(sizes)}"
            )
        return {SAMPLE: np.arange(sizes.pop())}

    def rename(self, name_dict: Mapping[Any, Hashable], dims_dict: Mapping[Any, Hashable]) -> SampleIndex:
        """The index under other names of its coordinates."""
        return SampleIndex(
            {name_dict.get(name, name): values for name, values in self.values.items()},
            {name_dict.get(name, name): unit for name, unit in self.units.items()},
        )

    def roll(self, shifts: Mapping[Any, int]) -> SampleIndex:
        """The index of samples moved round."""
        return SampleIndex(
            {name: np.roll(values, shifts[SAMPLE]) for name, values in self.values.items()}, self.units
        )

    def to_pandas_index(self) -> pd.Index:
        """The values as an index of pandas, which parts of xarray want."""
        if len(self.values) == 1:
            ((name, values),) = self.values.items()
            return pd.Index(values, name=name)
        return pd.MultiIndex.from_arrays(list(self.values.values()), names=list(self.values))

    def _repr_inline_(self, max_width: int) -> str:
        return type(self).__name__

    def _number(self, name: Hashable, label: Any) -> float:
        """Value in SI of a number or of a text with a unit; InputError for any other label."""
        if isinstance(label, str):
            kind = KINDS_OF_UNITS[self.units[name]]
            return MotionVariable(kind, "", refuses_bare=True).read(label, str(name))
        try:
            return float(label)
        except (TypeError, ValueError):
            what = _("{value} is no value of a drive").format(value=value_text(label))
            raise InputError(str(name), what, _("give a number in SI or a text with a unit")) from None

    def _rounding(self, name: Hashable, number: float) -> float:
        return ROUNDING * max(float(np.max(np.abs(self.values[name]), initial=0.0)), abs(number))

    def _passing(self, name: Hashable, label: Any, method: str | None, tolerance: Any) -> Places:
        """Samples at a value, or the one that stands for it by a method of xarray."""
        number, values = self._number(name, label), self.values[name]
        allowed = None if tolerance is None else abs(self._number(name, tolerance))
        away = values - number
        here = np.abs(away) <= self._rounding(name, number)
        if here.any():
            return np.flatnonzero(here)
        if method is not None:
            candidates = _on_side(away, method)
            if allowed is not None:
                candidates = candidates & (np.abs(away) <= allowed)
            if candidates.any():
                return np.array([np.argmin(np.where(candidates, np.abs(away), np.inf))])
        elif allowed is not None and (near := np.abs(away) <= allowed).any():
            return np.flatnonzero(near)
        what = _("no sample has the value {value}").format(value=value_text(label))
        raise InputError(
            str(name), what, _('take the nearest one with method="nearest", or compute it with at=[...]')
        )

    def _one_each(self, name: Hashable, labels: Any, method: str | None, tolerance: Any) -> Places:
        """The first sample at each of an array of labels."""
        flat = [self._passing(name, one, method, tolerance)[0] for one in np.ravel(labels)]
        return np.array(flat, dtype=np.intp).reshape(np.shape(labels))

    def _between(self, name: Hashable, label: slice) -> Places:
        """Samples between the ends of a slice, both included, whichever way the drive runs."""
        values = self.values[name]
        ends = [None if end is None else self._number(name, end) for end in (label.start, label.stop)]
        start, stop = ends
        if start is not None and stop is not None:
            start, stop = min(start, stop), max(start, stop)
        elif values.size and values[-1] < values[0]:
            start, stop = stop, start  # an open end of a drive that runs backwards
        inside = np.isfinite(values)
        if start is not None:
            inside &= values >= start - self._rounding(name, start)
        if stop is not None:
            inside &= values <= stop + self._rounding(name, stop)
        return np.flatnonzero(inside)[:: label.step]

    def _holding(self, name: Hashable, label: Any, tolerance: Any) -> npt.NDArray[np.bool_]:
        """Whether each sample is one of those of a label."""
        places = (
            self._between(name, label)
            if isinstance(label, slice)
            else np.concatenate(
                [
                    self._passing(name, one, None, tolerance)
                    for one in np.ravel(np.asarray(label, dtype=object))
                ]
            )
        )
        chosen = np.zeros(self.values[name].size, dtype=np.bool_)
        chosen[places] = True
        return chosen


def _on_side(away: Array, method: str) -> npt.NDArray[np.bool_]:
    """Which samples may stand for a value; InputError for an unknown method."""
    direction = DIRECTIONS.get(method)
    if direction is None:
        what = _("there is no method {method}").format(method=value_text(method))
        raise InputError("sel", what, _("give one of: {names}").format(names=", ".join(DIRECTIONS)))
    known = np.isfinite(away)
    if direction == "nearest":
        return known
    return known & (away <= 0) if direction == "before" else known & (away >= 0)


def _indexer(places: Places) -> slice | Places:
    """A slice where samples follow each other, so that a view is taken."""
    if places.size and places[-1] - places[0] == places.size - 1:
        return slice(int(places[0]), int(places[-1]) + 1)
    return places


def _agreeing(ours: Array, theirs: Array) -> npt.NDArray[np.bool_]:
    scale = max(float(np.max(np.abs(ours), initial=0.0)), float(np.max(np.abs(theirs), initial=0.0)))
    return (np.abs(ours - theirs) <= ROUNDING * scale) | (np.isnan(ours) & np.isnan(theirs))


def _same(ours: Array, theirs: Array) -> bool:
    return ours.shape == theirs.shape and bool(_agreeing(ours, theirs).all())


def drive_coordinates(names: Sequence[str], values: Array, units: Sequence[str]) -> dict[str, Any]:
    """Coordinates along `sample` of the values of drives (sample, drive), each by the id of its drive.

    A drive that has the name of a variable or a dimension has none; its values are those of `drive_value`.
    """
    # (dimensions, values, attributes)
    return {
        name: ((SAMPLE,), values[:, k], {"units": units[k], "long_name": "value of the drive"})
        for k, name in enumerate(names)
        if name not in QUANTITIES and name not in DIMENSIONS
    }


def label_coordinates(coordinates: Mapping[str, Any]) -> xr.Coordinates:
    """Coordinates with their indexes: of labels, which are an index of pandas each, and of what lies along `sample`.

    It says of `selectable` what xarray would find out with a tenth more of its time.
    """
    variables: dict[Any, xr.Variable] = {}
    indexes: dict[Any, xr.Index] = {}
    along: dict[Any, xr.Variable] = {}
    drives = coordinates["drive"]
    for name, value in coordinates.items():
        if isinstance(value, pd.Index):
            indexes[name], variables[name] = _labels(name, tuple(value), value.dtype)
        else:
            variables[name] = xr.Variable(*value)
            if name in drives:
                along[name] = variables[name]
    indexes |= dict.fromkeys(along, SampleIndex.from_variables(along, options={}))
    return xr.Coordinates(variables, indexes=indexes)


@functools.lru_cache(maxsize=256)
def _labels(name: str, labels: tuple[Hashable, ...], dtype: Any) -> tuple[PandasIndex, xr.Variable]:
    """The index of labels along a dimension, and its variable, of which a dataset takes a copy."""
    index = PandasIndex(pd.Index(labels, dtype=dtype), name, coord_dtype=dtype)
    return index, index.create_variables()[name]


def selectable(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset whose samples are selected by the values of its drives, or by the angle of its cam."""
    cam = [name for name in CAM_ANGLES if name in dataset.coords]
    names = [name for name in (*drives_along(dataset), *cam) if name not in dataset.xindexes]
    return dataset.set_xindex(names, SampleIndex) if names else dataset


def drives_along(dataset: xr.Dataset) -> list[str]:
    """The drives whose values are coordinates along `sample`."""
    drives = dataset["drive"].values.tolist() if "drive" in dataset.coords else []
    along = dataset.coords.variables
    return [str(name) for name in drives if name in along and along[name].dims == (SAMPLE,)]


def with_drive_coordinates(dataset: xr.Dataset) -> xr.Dataset:
    """A dataset that was read from a file, with the values of its drives by their names."""
    if "drive_value" in dataset.coords and "drive" in dataset.coords:
        names, values = dataset["drive"].values.tolist(), dataset["drive_value"]
        units = values.attrs.get("units", "").split()
        if values.dims == (SAMPLE, "drive") and len(units) in (1, len(names)):
            each = units if len(units) == len(names) else units * len(names)
            dataset = dataset.assign_coords(drive_coordinates(names, values.values, each))
    return selectable(dataset)
