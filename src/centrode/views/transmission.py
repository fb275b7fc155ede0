"""Transmission and pressure angles: what the terminal, the files, the figure and the document show."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.errors import Status
from centrode.quantities import QUANTITIES
from centrode.sheets.plots import AxisLabel, Curve, CurvePanel, Plot
from centrode.sheets.sheet import Column, Illustration, Section, Sheet, Table
from centrode.sheets.texts import NOTHING, Name, Number, Sentence, Symbol, Text, Title
from centrode.views.abscissa import motion_abscissa

if TYPE_CHECKING:
    import xarray

    from centrode.analysis.transmission import TransmissionResults

Array: TypeAlias = NDArray[np.float64]

VARIABLES = ("transmission_angle", "pressure_angle")
HINGES = (("hinge_angle", "rad"), ("hinge_velocity", "rad/s"), ("hinge_acceleration", "rad/s^2"))
PICTURE = "transmission"


def sheet(results: TransmissionResults) -> Sheet:
    """Extremes of the angles of every group, the angles over the motion as a table and as curves."""
    return Sheet(
        tables={"transmission": _over_motion(results)},
        datasets={"transmission": results.angles},
        pictures={PICTURE: _plot(results)},
        printed=(extremes_table(results),),
    )


def section(results: TransmissionResults) -> Section:
    """The section of a document: extremes over the motion, and the curves."""
    table = extremes_table(
        results, Sentence("Least transmission angle and greatest pressure angle of the groups")
    )
    caption = (
        Sentence(
            "Transmission angle $mu$ and pressure angle $alpha$ of the groups, angle $delta$ between links at their "
            "hinges"
        )
        if "hinge_angle" in results.angles
        else Sentence("Transmission angle $mu$ and pressure angle $alpha$ of the groups")
    )
    figure = Illustration(PICTURE, caption)
    return Section(Sentence("Transmission angles"), (_of_documents(table), figure))


def _of_documents(table: Table) -> Table:
    """Without the greatest acute angle, which the curve of the angle itself may pass."""
    return replace(table, columns=tuple(one for one in table.columns if one.name != "greatest"))


def extremes_table(results: TransmissionResults, caption: Text = NOTHING) -> Table:
    """Each group with the exact extremes of its acute angles over what is reached, in degrees for every reader."""
    angles = results.angles
    least, greatest = (
        np.degrees(angles[name].values)
        for name in ("least_transmission_angle", "greatest_transmission_angle")
    )
    names = tuple(map(Name, angles["group"].values.tolist()))
    return Table(
        (
            Column("group", names, head=Sentence("group")),
            _degrees("least", Sentence("least transmission angle"), least),
            _degrees("greatest", Sentence("greatest transmission angle"), greatest),
            _degrees("pressure", Sentence("greatest pressure angle"), 90.0 - least),
        ),
        caption,
    )


def _degrees(name: str, head: Sentence, values: Array) -> Column:
    # what is zero but for rounding is said without a sign
    texts = tuple(Number(value + 0.0, "deg", ".4f", unit_hidden=True) for value in values.tolist())
    return Column(name, texts, "deg", head)


def _over_motion(results: TransmissionResults) -> Table:
    """The angles in SI, one row a sample."""
    angles = results.angles
    columns = [Column("time", angles["time"].values, "s")]
    columns += [
        Column(f"drive_{name}", angles["drive_value"].values[:, number])
        for number, name in enumerate(angles["drive"].values.tolist())
    ]
    columns += [
        Column(f"{variable}_{name}", angles[variable].sel(group=name).values, "rad", unit_fixed=True)
        for variable in VARIABLES
        for name in angles["group"].values.tolist()
    ]
    columns += [
        Column("_".join((variable, name)), angles[variable].sel(hinge=name).values, unit, unit_fixed=True)
        for variable, unit in HINGES
        if variable in angles
        for name in angles["hinge"].values.tolist()
    ]
    words = tuple(Name(Status(code).word) for code in angles["status"].values.tolist())
    return Table((*columns, Column("status", words)))


def _hinges(angles: xarray.Dataset) -> CurvePanel:
    """Angles at the moving hinges of a linkage on the sphere, with their sense."""
    curves = tuple(
        Curve(Name(name), np.degrees(angles["hinge_angle"].sel(hinge=name).values), place)
        for place, name in enumerate(angles["hinge"].values.tolist())
    )
    return CurvePanel(AxisLabel(symbol=Symbol("δ"), unit="deg"), curves, scale=90.0)


def _plot(results: TransmissionResults) -> Plot:
    """Both angles of every group over the motion, in degrees for every reader."""
    angles, mechanism = results.angles, results.mechanism
    names = angles["group"].values.tolist()
    rows = tuple(
        (
            CurvePanel(
                AxisLabel(symbol=Symbol(QUANTITIES[variable].symbol), unit="deg"),
                tuple(
                    Curve(Name(name), np.degrees(angles[variable].sel(group=name).values), place)
                    for place, name in enumerate(names)
                ),
                scale=90.0,
                legend=variable == VARIABLES[0],
            ),
        )
        for variable in VARIABLES
    )
    if "hinge_angle" in angles:
        rows = (*rows, (_hinges(angles),))
    title = Sentence("Transmission and pressure angles")
    return Plot(title, Title(mechanism.title), motion_abscissa(mechanism, angles), rows)
