"""From a motion to the panels of its figures: which curves stand together, with which texts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from centrode.present.abscissa import Abscissa
from centrode.present.curves import Panel
from centrode.present.shown import formula, labelled, shown_as
from centrode.present.style import Pen
from centrode.quantities import QUANTITIES
from centrode.views.motion_plots import MAGNITUDE, component, deal_to_panels, great_value, turning_links

if TYPE_CHECKING:
    import xarray

    from centrode.model.mechanism import Mechanism

Array = NDArray[np.float64]
Rows = list[list[Panel]]


@dataclass(frozen=True)
class Motion:
    """A motion and what its figures share: a pen for each link, point and guide, and the abscissa."""

    mechanism: Mechanism
    dataset: xarray.Dataset
    abscissa: Abscissa
    pens: Mapping[str, Mapping[str, Pen]]

    @property
    def axes(self) -> int:
        """Number of components of a place."""
        return int(self.dataset.sizes["axis"])

    @property
    def components(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(self.dataset["axis"].to_numpy().tolist())


def of_links(motion: Motion, variable: str) -> Rows:
    """One panel below another, with as many links each as can be told apart; magnitudes of vectors."""
    part = MAGNITUDE if "axis" in motion.dataset[variable].dims else ""
    groups = deal_to_panels(turning_links(motion.mechanism))
    return [[panel(motion, variable, "link", names, part)] for names in groups]


def of_joints(motion: Motion, variable: str) -> Rows:
    """Links whose angle is measured from a reference arc."""
    groups = deal_to_panels(motion.dataset["joint"].to_numpy().tolist())
    return [[panel(motion, variable, "joint", names)] for names in groups]


def of_points(motion: Motion, variable: str) -> Rows:
    """Components and magnitude below each other; further points in further columns."""
    groups = deal_to_panels(motion.pens["point"])
    parts = (*motion.components, MAGNITUDE)
    return [
        [panel(motion, variable, "point", names, part, part == "x") for names in groups] for part in parts
    ]


def of_guides(motion: Motion) -> Rows:
    """Displacement, velocity and acceleration along the guides below each other."""
    groups = deal_to_panels(motion.pens["guide"])
    variables = ("slide", "slide_velocity", "slide_acceleration")
    return [
        [panel(motion, name, "guide", names, legend=name == "slide") for names in groups]
        for name in variables
    ]


def of_coefficients(motion: Motion) -> Rows:
    """Velocity coefficients at the left, acceleration coefficients at the right: links, points, guides."""
    points = deal_to_panels(motion.pens["point"])
    turning = deal_to_panels(turning_links(motion.mechanism))
    if motion.axes > 2:
        joints = deal_to_panels(motion.dataset["joint"].to_numpy().tolist())
        first = [both(motion, "joint_", "joint", names) for names in joints]
    else:
        first = [both(motion, "angular_", "link", names) for names in turning]
    rows = [
        *first,
        *(both(motion, "", "point", names, part) for part in motion.components for names in points),
        *(both(motion, "slide_", "guide", names) for names in deal_to_panels(motion.pens["guide"])),
    ]
    return [row for row in rows if row[0].curves]


def both(motion: Motion, prefix: str, dim: str, names: Sequence[str], part: str = "") -> list[Panel]:
    """A panel of velocity coefficients and one of acceleration coefficients, with one legend."""
    return [
        panel(motion, f"{prefix}velocity_coefficient", dim, names, part, legend=False),
        panel(motion, f"{prefix}acceleration_coefficient", dim, names, part),
    ]


def panel(
    motion: Motion, variable: str, dim: str, names: Iterable[str], part: str = "", legend: bool = True
) -> Panel:
    """Curves of one variable along `dim` ("link", "point" or "guide"), of one component or the magnitude."""
    values = motion.dataset[variable]
    unit = str(values.attrs.get("units", QUANTITIES[variable].unit))
    factor, shown = shown_as(unit, motion.mechanism.display)
    curves = {name: factor * component(values.sel({dim: name}), part) for name in names}
    text = formula(QUANTITIES[variable].symbol, part if part != MAGNITUDE else "")
    scale = factor * great_value(motion.dataset, variable)
    return Panel(labelled(text, shown), shown, curves, motion.pens[dim], scale, legend)
