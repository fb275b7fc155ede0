"""The reactions of a motion one by one: which joint and which body each belongs to, its unit, its values."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.model.mechanism import Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
ROUNDING = 1e-12
"""Components below this share of the greatest force or moment are rounding."""


class ReactionKind(Enum):
    """What a reaction is; behind it the names that tell reactions of one kind apart."""

    HINGE = "hinge"  # point, body that exerts it, body that bears it
    PIN = "pin"  # point, body
    CENTRE = "centre"  # body
    GUIDE_NORMAL = "guide_normal"  # guide
    GUIDE_MOMENT = "guide_moment"  # guide
    GEAR_MOMENT = "gear_moment"  # gear, "first", "second" or "carrier"
    TOOTH_FORCE = "tooth_force"  # gear
    TOOTH_RADIAL_FORCE = "tooth_radial_force"  # gear
    ROLLING_NORMAL = "rolling_normal"  # wheel
    ROLLING_TANGENTIAL = "rolling_tangential"  # wheel
    BALANCING = "balancing"  # drive
    FRICTION_MOMENT = "friction_moment"  # side of a hinge
    FRICTION_FORCE = "friction_force"  # guide
    EFFICIENCY = "efficiency"
    FRAME_FORCE = "frame_force"
    FRAME_MOMENT = "frame_moment"


@dataclass(frozen=True)
class ReactionSeries:
    """One reaction over the samples of a motion.

    Attributes
    ----------
    kind, names : what it is, and which one of its kind
    key : variable and names, the same in every language: "joint_force_A/AB"
    unit : "N", "N m", or nothing for a plain number
    values : (samples), or components (samples, axes) [unit]; NaN where it is not determined
    """

    kind: ReactionKind
    names: tuple[str, ...]
    key: str
    unit: str
    values: Array

    @property
    def magnitudes(self) -> Array:
        """Magnitudes of vectors, the signed numbers themselves of scalars (samples)."""
        return np.hypot.reduce(self.values, axis=1) if self.values.ndim == 2 else self.values


ALONG = (
    (ReactionKind.GUIDE_NORMAL, "guide"),
    (ReactionKind.GUIDE_MOMENT, "guide"),
    (ReactionKind.GEAR_MOMENT, "gear"),
    (ReactionKind.TOOTH_FORCE, "gear"),
    (ReactionKind.TOOTH_RADIAL_FORCE, "gear"),
    (ReactionKind.ROLLING_NORMAL, "rolling"),
    (ReactionKind.ROLLING_TANGENTIAL, "rolling"),
    (ReactionKind.BALANCING, "drive"),
)
"""Variables of guides, gears, wheels and drives, with their dimension."""


def reaction_series(
    mechanism: Mechanism, reactions: xr.Dataset, like: xr.Dataset | None = None
) -> Iterator[ReactionSeries]:
    """Every reaction that tables and figures show: hinges, guides, gears, wheels, drives, friction, the frame.

    Parameters
    ----------
    reactions : Dataset
        Of `reactions`.
    like : Dataset, optional
        Other reactions of the mechanism: the series are those that these have, in place of what is determined in
        `reactions`.
    """
    like = reactions if like is None else like
    turning = [guide.id for guide in mechanism.guides if guide.link is not None]
    yield from _hinges(reactions, like)
    if "centre_force" in reactions:
        yield from _along(ReactionKind.CENTRE, reactions["centre_force"], like["centre_force"], "held")
    for kind, dimension in ALONG:
        if kind.value in reactions:
            values, known = reactions[kind.value], like[kind.value]
            # a guide without a slider of its own bears no moment
            values = values.sel(guide=turning) if kind is ReactionKind.GUIDE_MOMENT else values
            yield from _along(kind, values, known, dimension)
    if "friction" in reactions.dims:
        yield from _friction(reactions)
    for kind, unit in ((ReactionKind.FRAME_FORCE, "N"), (ReactionKind.FRAME_MOMENT, "N m")):
        yield ReactionSeries(kind, (), kind.value, unit, reactions[kind.value].values)


def _friction(reactions: xr.Dataset) -> Iterator[ReactionSeries]:
    """Moments and forces of friction, and the efficiency."""
    for label in reactions["friction"].values.tolist():
        guide = label.removeprefix("guide ")
        kind, name, unit = ReactionKind.FRICTION_FORCE, guide, "N"
        values = reactions["friction_force"].sel(guide=guide) if label != guide else None
        if values is None:
            kind, name, unit = ReactionKind.FRICTION_MOMENT, label, "N m"
            values = reactions["friction_moment"].sel(bearing=label)
        yield ReactionSeries(kind, (name,), f"{kind.value}_{name}", unit, values.values)
    kind = ReactionKind.EFFICIENCY
    yield ReactionSeries(kind, (), kind.value, "", reactions[kind.value].values)


def _along(
    kind: ReactionKind, values: xr.DataArray, like: xr.DataArray, dimension: str
) -> Iterator[ReactionSeries]:
    """One series for each label of a dimension, for each body of a gear; vectors that nothing determines are none."""
    # of units there is one for all, or one for each of the drives
    units = str(values.attrs["units"]).split(", ")
    for number, name in enumerate(values[dimension].values.tolist()):
        one, unit = values.sel({dimension: name}), units[number % len(units)]
        key = f"{values.name}_{name}"
        if "gear_body" in values.dims:
            for body in values["gear_body"].values.tolist():
                yield ReactionSeries(
                    kind, (name, body), f"{key}_{body}", unit, one.sel(gear_body=body).values
                )
        elif "axis" not in one.dims or not np.isnan(like.sel({dimension: name}).values).all():
            yield ReactionSeries(kind, (name,), key, unit, one.values)


def _hinges(reactions: xr.Dataset, like: xr.Dataset) -> Iterator[ReactionSeries]:
    """Sides of hinges; of two that are action and reaction one, with the names of both bodies."""
    points, bodies = reactions["side_point"].values, reactions["side_link"].values
    values, known = reactions["joint_force"].values, like["joint_force"].values
    for point in dict.fromkeys(points.tolist()):
        sides = np.flatnonzero(points == point)
        names = [str(bodies[k]) for k in sides]
        keys = [f"joint_force_{point}/{name}" for name in names]
        # a load on the pin itself parts the two: then each side is a reaction of its own
        if len(sides) == 2 and _opposite(known[:, sides[0]], known[:, sides[1]]):
            both = (point, names[1], names[0])
            yield ReactionSeries(ReactionKind.HINGE, both, keys[0], "N", values[:, sides[0]])
            continue
        for k, key, name in zip(sides, keys, names, strict=True):
            yield ReactionSeries(ReactionKind.PIN, (point, name), key, "N", values[:, k])


def _opposite(one: Array, other: Array) -> bool:
    """Whether two forces (samples, axes) are action and reaction but for rounding."""
    size = np.nanmax(np.abs(one), initial=0.0)
    return bool(np.array_equal(np.isnan(one), np.isnan(other))) and bool(
        np.nanmax(np.abs(one + other), initial=0.0) <= ROUNDING * size
    )
