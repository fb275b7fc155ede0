"""What views of cams by a curvature law share: angles, tables and courses over the angle of the carrier."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from centrode.errors import Status
from centrode.quantities import QUANTITIES
from centrode.sheets.plots import Abscissa, AxisLabel
from centrode.sheets.sheet import Check, Column, Failure, Table
from centrode.sheets.texts import NOTHING, Expression, Joined, Name, Number, Sentence, Symbol, Text
from centrode.views.columns import columns_of, rows_shown, unit_of

if TYPE_CHECKING:
    import xarray as xr

    from centrode.model.cam import Cam

ROUNDED = float(np.finfo(float).eps) * (1 << 16)
"""What rounding may leave of sums that are to vanish: series of some twenty terms, quotients near a stall."""
LEAST_ANGLE = 1e-9
"""Smaller angles [rad] are shown as zero."""
MEGA = 1e-6


def angle(value: float, digits: str = ".6g") -> Number:
    """An angle of the carrier, or a pressure angle [rad], in degrees too."""
    return Number(value, "rad", digits, degrees_too=True)


def on_both_sides(cam: Cam, value: float, digits: str = ".6g") -> Text:
    """An angle [rad], with both signs where the law is the same on both sides."""
    value = value if abs(value) > LEAST_ANGLE else 0.0
    both = cam.curvature.symmetric and value
    return Joined((Name("±"), angle(abs(value), digits)), "") if both else angle(value, digits)


def stress(value: float) -> Number:
    """A stress [Pa] in megapascals."""
    return Number(MEGA * value, "MPa")


def over_carrier(dataset: xr.Dataset) -> Abscissa:
    """The angle of the carrier as an abscissa."""
    phi, quantity = dataset["carrier_angle"].values, QUANTITIES["carrier_angle"]
    order = np.argsort(phi, kind="stable")
    label = AxisLabel(Sentence(quantity.long_name), Symbol(quantity.symbol), "rad")
    return Abscissa(label, phi[order], order)


def carrier_table(dataset: xr.Dataset, variables: Sequence[str]) -> Table:
    """Variables over the angle of the carrier, one row a sample, with their status where it is known."""
    columns = [
        _column(header, unit, values.values)
        for variable in ("carrier_angle", *variables)
        for header, unit, values in columns_of(dataset[variable], variable)
    ]
    if "status" in dataset:
        words = tuple(Name(Status(code).word) for code in dataset["status"].values.tolist())
        columns.append(Column("status", words))
    return Table(tuple(columns))


def _column(header: str, unit: str, values: np.ndarray) -> Column:
    """Numbers with their unit, or words."""
    if values.dtype.kind == "f":
        return Column(header, values, unit)
    return Column(header, tuple(map(Name, values.tolist())))


def course(dataset: xr.Dataset, variables: Sequence[tuple[str, str]], caption: Sentence) -> Table:
    """Variables at even steps of the carrier under their letters, stresses in megapascals."""
    columns = [Column("carrier_angle", dataset["carrier_angle"].values, "rad", Expression("phi"))]
    for name, letter in variables:
        unit, values = unit_of(dataset[name]) or "1", dataset[name].values
        scale, shown = (MEGA, "MPa") if unit == "Pa" else (1.0, unit)
        columns.append(Column(name, scale * values, shown, Expression(letter)))
    return Table(tuple(columns), caption, rows_shown(dataset.sizes["sample"]))


def shortfall(failure: Failure | None) -> tuple[Check, ...]:
    """What a cam cannot do, as a check of a document that does not hold."""
    if failure is None:
        return ()
    statement = Sentence("{what}; {repair}.", what=failure.what, repair=failure.repair)
    if failure.repair == NOTHING:
        statement = Sentence("{what}.", what=failure.what)
    return (Check(statement, difference=1.0, size=1.0, bound=0.0),)
