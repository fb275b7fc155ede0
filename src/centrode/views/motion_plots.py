"""Curves of a motion: which stand together in a panel, and what they are drawn over."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from centrode.quantities import QUANTITIES
from centrode.sheets.plots import Abscissa, AxisLabel, Curve, CurvePanel
from centrode.sheets.texts import Name, Sentence, Symbol

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

Array: TypeAlias = NDArray[np.float64]
Rows: TypeAlias = tuple[tuple[CurvePanel, ...], ...]
MAGNITUDE = "magnitude"
DERIVATIVES = {
    "angle": "angular_velocity",
    "angular_velocity": "angular_acceleration",
    "joint_angle": "joint_velocity",
    "joint_velocity": "joint_acceleration",
    "hinge_angle": "hinge_velocity",
    "hinge_velocity": "hinge_acceleration",
    "velocity": "acceleration",
    "slide": "slide_velocity",
    "slide_velocity": "slide_acceleration",
    "velocity_coefficient": "acceleration_coefficient",
    "angular_velocity_coefficient": "angular_acceleration_coefficient",
    "joint_velocity_coefficient": "joint_acceleration_coefficient",
    "slide_velocity_coefficient": "slide_acceleration_coefficient",
}
"""Variables and their derivatives: by time, of coefficients by the drive."""
CURVES, PANELS = 7, 4
"""The most curves that can be told apart in a panel, and the most panels below each other that are not crowded."""


@dataclass(frozen=True)
class PlottedMotion:
    """A motion and what its figures share.

    Attributes
    ----------
    mechanism, dataset : the motion
    pace : by how much the abscissa grows in a second [its SI unit/s]; None where that changes
    places : "link", "joint", "point", "guide" -> name -> its place, which gives it the same pen in every figure
    """

    mechanism: Mechanism
    dataset: xarray.Dataset
    pace: float | None = None

    @functools.cached_property
    def places(self) -> Mapping[str, Mapping[str, int]]:
        """Places of links, points and guides among their kind."""
        kinds = {
            "link": self.mechanism.link_names,
            "joint": self.mechanism.link_names,
            "point": self.mechanism.moving_points,
            "guide": [guide.id for guide in self.mechanism.guides],
            "hinge": self.hinges,
        }
        return {kind: {name: place for place, name in enumerate(names)} for kind, names in kinds.items()}

    @property
    def components(self) -> tuple[str, ...]:
        """Names of the components of a place."""
        return tuple(self.dataset["axis"].values.tolist())

    @property
    def joints(self) -> list[str]:
        """Links whose angle is measured from a reference arc."""
        return self.dataset["joint"].values.tolist() if "joint" in self.dataset.dims else []

    @property
    def hinges(self) -> list[str]:
        """Pairs of links at moving hinges whose angle is known."""
        return self.dataset["hinge"].values.tolist() if "hinge_angle" in self.dataset else []


def panels_of_links(motion: PlottedMotion, variable: str) -> Rows:
    """One panel below another, with as many links each as can be told apart; magnitudes of vectors."""
    part = MAGNITUDE if "axis" in motion.dataset[variable].dims else ""
    groups = deal_to_panels(turning_links(motion.mechanism))
    return tuple((_panel(motion, variable, "link", names, part),) for names in groups)


def panels_of_points(motion: PlottedMotion, variable: str) -> Rows:
    """Components and magnitude below each other; further points in further columns."""
    groups = deal_to_panels(motion.places["point"])
    return tuple(
        tuple(_panel(motion, variable, "point", names, part, legend=part == "x") for names in groups)
        for part in (*motion.components, MAGNITUDE)
    )


def panels_of_guides(motion: PlottedMotion, variables: Sequence[str]) -> Rows:
    """One variable along the guides below another, names beside the first; further guides in further columns."""
    groups = deal_to_panels(motion.places["guide"])
    return tuple(
        tuple(_panel(motion, name, "guide", names, legend=name == variables[0]) for names in groups)
        for name in variables
    )


def panels_of_joints(motion: PlottedMotion, variable: str) -> Rows:
    """Links whose angle is measured from a reference arc, in panels below each other."""
    groups = deal_to_panels(motion.joints)
    return tuple((_panel(motion, variable, "joint", names),) for names in groups)


def panels_of_hinges(motion: PlottedMotion) -> Rows:
    """Angles at the hinges, their rates and second rates below each other; further hinges in further columns."""
    groups = deal_to_panels(motion.hinges)
    return tuple(
        tuple(_panel(motion, name, "hinge", names, legend=name == "hinge_angle") for names in groups)
        for name in ("hinge_angle", "hinge_velocity", "hinge_acceleration")
    )


def panels_of_coefficients(motion: PlottedMotion) -> Rows:
    """Velocity coefficients at the left, acceleration coefficients at the right: links, points, guides."""
    points, turning = deal_to_panels(motion.places["point"]), turning_links(motion.mechanism)
    on_sphere = len(motion.components) > 2
    first, names = ("joint", motion.joints) if on_sphere else ("link", turning)
    prefix = "joint_" if on_sphere else "angular_"
    rows = (
        *(_both(motion, prefix, first, some) for some in deal_to_panels(names)),
        *(_both(motion, "", "point", some, part) for part in motion.components for some in points),
        *(_both(motion, "slide_", "guide", some) for some in deal_to_panels(motion.places["guide"])),
    )
    return tuple(row for row in rows if row[0].curves)


def _both(
    motion: PlottedMotion, prefix: str, kind: str, names: Sequence[str], part: str = ""
) -> tuple[CurvePanel, CurvePanel]:
    """A panel of velocity coefficients and one of acceleration coefficients, with one legend."""
    return (
        _panel(motion, f"{prefix}velocity_coefficient", kind, names, part, legend=False),
        _panel(motion, f"{prefix}acceleration_coefficient", kind, names, part),
    )


def turning_links(mechanism: Mechanism) -> list[str]:
    """The links without those that a guide of the frame keeps from turning."""
    still = {guide.link for guide in mechanism.guides if guide.on == "frame"}
    return [name for name in mechanism.link_names if name not in still]


def deal_to_panels(names: Iterable[str]) -> list[list[str]]:
    """The names dealt evenly to as few panels as keep at most `CURVES` in one."""
    names = list(names)
    count = min(PANELS, max(1, -(-len(names) // CURVES)))
    cuts = [round(number * len(names) / count) for number in range(count + 1)]
    return [names[first:last] for first, last in pairwise(cuts)]


def over_samples(label: AxisLabel, values: Array) -> Abscissa:
    """An abscissa whose values are in drawing order, without gaps."""
    return Abscissa(label, values, np.arange(len(values)))


def quantity_label(name: str) -> AxisLabel:
    """Title, symbol and unit of a quantity of the vocabulary."""
    quantity = QUANTITIES[name]
    return AxisLabel(Sentence(quantity.long_name), Symbol(quantity.symbol), quantity.unit)


def quantities_panel(
    dataset: xarray.Dataset, variables: Sequence[str], symbol: Symbol, approximate: Sequence[str] = ()
) -> CurvePanel:
    """Curves of several variables of one unit, by their titles; those in `approximate` beside the exact ones."""
    curves = tuple(
        Curve(Sentence(QUANTITIES[name].long_name), dataset[name].values, place, name in approximate)
        for place, name in enumerate(variables)
    )
    scale = max(float(np.max(np.abs(curve.values), initial=0.0)) for curve in curves)
    return CurvePanel(AxisLabel(symbol=symbol, unit=QUANTITIES[variables[0]].unit), curves, scale)


def _panel(
    motion: PlottedMotion,
    variable: str,
    kind: str,
    names: Iterable[str],
    part: str = "",
    *,
    legend: bool = True,
) -> CurvePanel:
    """Curves of one variable of links, points or guides, of one component or the magnitude."""
    values = motion.dataset[variable]
    unit = str(values.attrs.get("units", QUANTITIES[variable].unit))
    curves = tuple(
        Curve(
            Name(name),
            component(values.sel({kind: name}), part),
            motion.places[kind][name],
            slopes=_slopes(motion, variable, kind, name, part),
        )
        for name in names
    )
    symbol = Symbol(QUANTITIES[variable].symbol, part if part != MAGNITUDE else "", slanted=True)
    return CurvePanel(
        AxisLabel(symbol=symbol, unit=unit), curves, great_value(motion.dataset, variable), legend
    )


def _slopes(motion: PlottedMotion, variable: str, kind: str, name: str, part: str) -> Array | None:
    """Derivatives of a curve by what it is drawn over; None where the motion does not hold them."""
    rate = DERIVATIVES.get(variable)
    pace = 1.0 if variable.endswith("coefficient") else motion.pace
    # at rest a curve by the drive is that of many positions: it has slopes, but there is no speed to find them by
    if rate is None or not pace or rate not in motion.dataset:
        return None
    derivative = motion.dataset[rate].sel({kind: name})
    if part != MAGNITUDE:
        return np.asarray((derivative.sel(axis=part) if part else derivative).values) / pace
    vector = motion.dataset[variable].sel({kind: name})
    with np.errstate(divide="ignore", invalid="ignore"):
        growth = (vector * derivative).sum("axis", skipna=False).values / component(vector, MAGNITUDE)
    return np.asarray(np.where(np.isfinite(growth), growth, np.nan) / pace)


def component(values: xarray.DataArray, part: str) -> Array:
    """A curve of a scalar, or of a vector's component or magnitude."""
    if part == MAGNITUDE:
        return np.asarray(functools.reduce(np.hypot, values.transpose("axis", ...).values))
    return np.asarray((values.sel(axis=part) if part else values).values)


def great_value(dataset: xarray.Dataset, variable: str) -> float:
    """A great value of a variable: its greatest, or for angular accelerations the squared angular velocity.

    So a link that translates shows accelerations of zero, not noise.
    """
    greatest = _peak(dataset, variable)
    if "angular_acceleration" in variable:
        greatest = max(greatest, _peak(dataset, variable.replace("acceleration", "velocity")) ** 2)
    return greatest


def _peak(dataset: xarray.Dataset, variable: str) -> float:
    """The greatest magnitude of a variable; 0 if it has no value."""
    values = dataset[variable].values
    known = np.abs(values[np.isfinite(values)])
    return float(known.max()) if known.size else 0.0
