"""Datasets as netCDF files of the classic format, which every reader knows."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import xarray
from xarray.backends import ScipyDataStore

from centrode.errors import InputError
from centrode.locale import _

WITHOUT_ENTRIES = "without_entries"
"""Attribute with the variables that a file leaves out: name -> [dimensions, sizes, kind of number, attributes]."""
SLASHED = "names_with_slash"
"""Attribute with the names that hold a slash, which the format keeps for groups: name in the file -> name."""
MOST_BYTES = 1 << 31
"""Larger files are refused: no offset of the format's first version reaches further."""


def write_dataset(dataset: xarray.Dataset, path: Path) -> None:
    """Write a dataset as netCDF through scipy; the same dataset gives the same bytes.

    A dimension without entries (no events, no guides) cannot be told from an unlimited one in the file format: what
    has such a dimension stands in an attribute. The values of each drive by its name are those of `drive_value`, and
    are left out: a name may hold signs that a file refuses. A slash in a name is written as a bar, and an attribute has
    the names as they are.
    """
    dataset = dataset.drop_vars(_drives_by_name(dataset))
    empty = [name for name, size in dataset.sizes.items() if size == 0]
    kept = dataset.drop_dims(empty)
    absent = {
        str(name): [
            list(map(str, variable.dims)),
            list(variable.shape),
            variable.dtype.str if variable.dtype != object else "O",
            {key: value for key, value in variable.attrs.items() if isinstance(value, str)},
        ]
        for name, variable in dataset.variables.items()
        if name not in kept.variables
    }
    if absent:
        kept = kept.assign_attrs({WITHOUT_ENTRIES: json.dumps(absent)})
    slashed = {name: _without_slash(name, kept) for name in map(str, kept.variables) if "/" in name}
    if slashed:
        spelled = json.dumps({written: name for name, written in slashed.items()})
        kept = kept.rename(slashed).assign_attrs({SLASHED: spelled})
    # `to_netcdf` looks first for a cluster of computers, which takes as long as a whole run where its library is there
    with path.open("wb") as stream:
        store = ScipyDataStore(stream, mode="w", lock=False)
        kept.dump_to_store(store)
        store.close()


def _without_slash(name: str, dataset: xarray.Dataset) -> str:
    written = name.replace("/", "|")
    while written in dataset.variables:
        written += "|"
    return written


def _drives_by_name(dataset: xarray.Dataset) -> list[str]:
    drives = dataset["drive"].values.tolist() if "drive" in dataset.coords else []
    return [str(name) for name in drives if name in dataset.coords]


def read_dataset(path: Path) -> xarray.Dataset:
    """A dataset from a netCDF file, as it was written.

    Raises InputError where there is no such file, and where it is damaged or too large.
    """
    repair = _("name a netCDF file that a command has written")
    if not path.is_file():
        raise InputError(str(path), _("there is no such file"), repair)
    if path.stat().st_size > MOST_BYTES:
        raise InputError(str(path), _("the file is too large"), repair)
    try:
        # units of time stay numbers
        dataset = xarray.load_dataset(path, engine="scipy", decode_times=False)
        absent = _empty_variables(dataset.attrs.pop(WITHOUT_ENTRIES, "{}"))
        slashed = json.loads(dataset.attrs.pop(SLASHED, "{}"))
        return dataset.rename(slashed).assign(absent)
    except (
        OSError,
        ArithmeticError,
        LookupError,
        TypeError,
        ValueError,
        AssertionError,
        MemoryError,
    ) as failure:
        raise InputError(str(path), _("the file is not netCDF, or cannot be read"), repair) from failure


def _empty_variables(text: str) -> dict[str, xarray.Variable]:
    """Variables without entries from their attribute; ValueError or TypeError where it says something else."""
    known = json.loads(text)
    if not isinstance(known, dict):
        raise TypeError(text)
    variables = {}
    for name, (dimensions, sizes, kind, attributes) in known.items():
        if 0 not in sizes:  # an attribute of a few bytes must not ask for memory
            raise ValueError(text)
        variables[name] = xarray.Variable(dimensions, np.empty(sizes, np.dtype(kind)), attributes)
    return variables
