"""What views of cams with followers share: names of curves and of followers, letters, tables over a turn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.quantities import QUANTITIES
from centrode.sheets.sheet import Check, Column, Failure, Table
from centrode.sheets.texts import NOTHING, Expression, Joined, Name, Number, Sentence, Symbol, Text
from centrode.views.columns import rows_shown, unit_of

if TYPE_CHECKING:
    import xarray as xr

Array = npt.NDArray[np.float64]

MEGA = 1e-6
CURVE_NAMES = {
    "uniform": Sentence("uniform"),
    "parabolic": Sentence("parabolic"),
    "harmonic": Sentence("harmonic"),
    "cycloidal": Sentence("cycloidal"),
    "trapezoid": Sentence("trapezoid"),
    "modified sine": Sentence("modified sine"),
    "modified trapezoid": Sentence("modified trapezoid"),
    "dwell": Sentence("dwell"),
    "formula": Sentence("formula"),
    "polynomial": Sentence("polynomial"),
    "b-spline": Sentence("b-spline"),
    "its own": Sentence("its own"),
}
KINDS = {"translating": Sentence("translating"), "oscillating": Sentence("oscillating")}
CONTACTS = {
    "knife": Sentence("a knife edge"),
    "roller": Sentence("a roller"),
    "flat": Sentence("a flat face"),
}

SAME = 1e-12
"""Share of a column's greatest size below which a difference is rounding."""
ROWS = 37
"""Rows of a table over a turn: every ten degrees of 361 samples."""


def curve_name(curve: str) -> Text:
    """A curve of a segment; those that are called by their powers are no words."""
    return CURVE_NAMES.get(curve, Name(curve))


def angle(value: float) -> Number:
    """An angle of the cam [rad], in degrees too."""
    return Number(value, "rad", degrees_too=True)


def at(value: Text, place: float) -> Sentence:
    """A value at an angle of the cam [rad]."""
    return Sentence("{value} at {at}", value=value, at=angle(place))


def turns_a_minute(speed: float) -> Number:
    """An angular velocity [rad/s] in turns a minute."""
    return Number(30.0 * speed / np.pi, "rpm", unit_fixed=True)


def letter_of(swings: bool) -> str:
    """The lift, in the notation of formulas."""
    return "psi" if swings else "s"


def rate(swings: bool, order: int) -> str:
    """A derivative of the lift by the angle of the cam, in the notation of formulas."""
    return letter_of(swings) + "'" * order


def rates_in_time(swings: bool) -> tuple[str, str, str]:
    """Velocity, acceleration and jerk, in the notation of formulas."""
    return ("dot(psi)", "dot.double(psi)", "dot.triple(psi)") if swings else ("v", "a", "j")


def symbols_of(names: Sequence[str]) -> list[Text]:
    """Symbols of quantities of the vocabulary, as heads on a terminal."""
    return [Symbol(QUANTITIES[name].symbol) for name in names]


def turn_table(dataset: xr.Dataset) -> Table:
    """All variables over a turn of the cam, one row a sample."""
    names = [str(name) for name, one in dataset.data_vars.items() if one.dims == ("sample",)]
    columns = (
        Column(name, dataset[name].values, unit_of(dataset[name]))
        for name in ("cam_angle", *names)
        if name != "status"
    )
    words = tuple(Name(Status(code).word) for code in dataset["status"].values.tolist())
    return Table((*columns, Column("status", words)))


def course(
    dataset: xr.Dataset, variables: Sequence[tuple[str, str]], caption: Sentence, *, brief: bool = False
) -> Table:
    """Variables over the angle of the cam at even steps, under their letters; stresses in MPa.

    A `brief` table has of rows that are alike, but for the angle, only the first and the last.
    """
    columns = [Column("cam_angle", dataset["cam_angle"].values, "rad", Expression("phi"))]
    for name, letter in variables:
        values, unit = in_megapascals(dataset[name].values, str(dataset[name].attrs["units"]))
        columns.append(Column(name, values, unit, Expression(letter)))
    rows = rows_shown(dataset.sizes["sample"], ROWS)
    if brief:
        kept = _unlike(rows, columns[1:])
        if len(kept) < len(rows):
            rows, caption = kept, Sentence("{caption}; of equal rows the first and the last", caption=caption)
    return Table(tuple(columns), caption, rows)


def in_megapascals(values: Array, unit: str) -> tuple[Array, str]:
    """Values in a unit, stresses in MPa."""
    return (MEGA * values, "MPa") if unit == "Pa" else (values, unit)


def failed_checks(failure: Failure | None) -> tuple[Check, ...]:
    """What a cam cannot do, among the checks of a document."""
    if failure is None:
        return ()
    parts = [text for text in (failure.what, failure.repair) if text != NOTHING]
    return (Check(Sentence("{failure}.", failure=Joined(parts, "; ")), 1.0, 1.0, 0.0),)


def _unlike(rows: tuple[int, ...], columns: Sequence[Column]) -> tuple[int, ...]:
    """Rows without those between others that are the same."""
    values = np.array([np.asarray(one.values)[list(rows)] for one in columns])
    sizes = np.nanmax(np.abs(values), axis=1, initial=0.0, keepdims=True)
    step = np.abs(np.diff(values, axis=1)) <= SAME * sizes
    alike = (step | (np.isnan(values[:, 1:]) & np.isnan(values[:, :-1]))).all(axis=0)
    inner = set((np.flatnonzero(alike[1:] & alike[:-1]) + 1).tolist())
    return tuple(row for k, row in enumerate(rows) if k not in inner)
