"""Bearings of a mechanism: loads in the axes of journal and bush, and how each of the two wears around."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import pandas as pd
import xarray as xr

from centrode.errors import InputError, NotComputedYet
from centrode.kinematics.motion import labels_of, motion, vocabulary_variable
from centrode.kinematics.sample_index import drives_along, selectable
from centrode.locale import _
from centrode.model.mechanism import FRAME, Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
SECTORS = 36
MOST_SECTORS = 3600
ARC = 2.0 * np.pi / 3.0
"""A load wears the surface 60 degrees to each side of its direction, as for the crank pins of engines."""
SURFACES = ("journal", "bush")


@dataclass(frozen=True)
class Bearing:
    """A hinge of two bodies: the pin is the journal of the first, the second has the bush."""

    point: str
    journal: str
    bush: str

    @property
    def label(self) -> str:
        """Its name in results."""
        return f"{self.point}: {self.journal}, {self.bush}"


def bearings(
    mechanism: Mechanism,
    reactions: xr.Dataset,
    motion_there: xr.Dataset | None = None,
    *,
    sectors: int = SECTORS,
    arc: float = ARC,
) -> xr.Dataset:
    """Loads of all bearings in the axes of their journals and bushes, and the share of the wear around each.

    Parameters
    ----------
    reactions : Dataset
        Of `reactions`; the wear is that of all its samples, so they should cover a cycle.
    motion_there : Dataset, optional
        The motion at the same samples; computed if left out.
    sectors : int
        Into how many equal sectors each surface is cut.
    arc : float [rad]
        Over what arc a load wears the surface, half of it to each side of its direction.

    Returns
    -------
    Dataset
        `bearing_load`, `load_on_journal`, `load_on_bush` (sample, bearing, axis), `relative_turning` (sample, bearing),
        `load_path` (bearing) and `wear` (bearing, surface, sector).

    Raises
    ------
    InputError
        Less than one or more than 3600 sectors, an arc that is no part of a turn, a motion of other samples.
    NotComputedYet
        The sphere.

    Notes
    -----
    `load_path` is the integral of F |dφ|, load times relative turning: the work of friction is it times coefficient
    and radius. Each sample's part of it is spread evenly over the arc. Kolchin and Demidov, Design of Automotive
    Engines, draw the wear of a crank pin so, with forces alone. The trapezoid rule takes it from sample to sample.
    """
    if mechanism.space != "plane":
        what = _("loads of bearings in the axes of their links are not computed on the sphere yet")
        raise NotComputedYet("space", what, _("the forces are in the reactions"))
    _check(sectors, arc)
    links = _moving(mechanism, reactions, motion_there)
    found = list(_bearings(mechanism, reactions))
    samples = reactions.sizes["sample"]
    loads = np.zeros((samples, len(found), 2))
    turns = np.zeros((2, samples, len(found)))
    sides = reactions["side"].values.tolist()
    force = reactions["joint_force"].transpose("sample", "side", "axis").values
    for k, one in enumerate(found):
        loads[:, k] = force[:, sides.index(f"{one.point}/{one.bush}")]
        turns[:, :, k] = links[one.journal], links[one.bush]
    # the bush presses on the journal where the journal presses on the bush
    places = np.arctan2(loads[..., 1], loads[..., 0]) - turns
    size = np.hypot(loads[..., 0], loads[..., 1])
    path = _path(size, turns[0] - turns[1])
    wear = _wear(path, places, sectors, arc)
    values = {
        "bearing_load": (("sample", "bearing", "axis"), loads),
        "load_on_journal": (("sample", "bearing", "axis"), _turn(-loads, -turns[0])),
        "load_on_bush": (("sample", "bearing", "axis"), _turn(loads, -turns[1])),
        "relative_turning": (("sample", "bearing"), turns[0] - turns[1]),
        "load_path": (("bearing",), path.sum(axis=(0, 1))),
        "wear": (("bearing", "surface", "sector"), wear),
    }
    variables: dict[str, Any] = {name: reactions[name].variable for name in ("status", "reaction_status")}
    variables |= {
        name: vocabulary_variable(name, dimensions, data) for name, (dimensions, data) in values.items()
    }
    coordinates: dict[str, Any] = {
        name: reactions.coords[name].variable
        for name in ("time", "drive_value", "drive", "axis", *drives_along(reactions))
    } | {
        "bearing": labels_of(tuple(one.label for one in found)),
        "surface": labels_of(SURFACES),
        # an index as it is, see `labels_of`
        "sector": vocabulary_variable(
            "sector", ("sector",), pd.Index((np.arange(sectors) + 0.5) * (2.0 * np.pi / sectors))
        ),
    }
    for part in ("point", "journal", "bush"):
        names = np.array([getattr(one, part) for one in found], dtype=str)
        coordinates[f"bearing_{part}"] = (("bearing",), names)
    title = reactions.attrs.get("title", "")
    return selectable(xr.Dataset(variables, coordinates, {"title": title, "wear_arc": float(arc)}))


def _check(sectors: int, arc: float) -> None:
    if isinstance(sectors, bool) or not 1 <= sectors <= MOST_SECTORS:
        what = _("{count} sectors are given").format(count=sectors)
        raise InputError("sectors", what, _("give 1 to {most}").format(most=MOST_SECTORS))
    if not 0.0 < arc <= 2.0 * np.pi:
        what = _("an arc of {arc:g} rad is not part of a turn").format(arc=arc)
        raise InputError("arc", what, _("give more than 0 and at most 2 pi"))


def motion_beside(mechanism: Mechanism, reactions: xr.Dataset) -> xr.Dataset:
    """The motion at the samples of reactions."""
    return motion(mechanism, at=mechanism.motion_parameter.instants(reactions))


def _moving(mechanism: Mechanism, reactions: xr.Dataset, there: xr.Dataset | None) -> dict[str, Array]:
    """Angles of all bodies at the samples."""
    parameter = mechanism.motion_parameter
    places = parameter.instants(reactions)
    there = motion_beside(mechanism, reactions) if there is None else there
    if not np.array_equal(parameter.instants(there), places):
        raise InputError("motion_there", _("it has other samples than the reactions"))
    angles = there["angle"].transpose("link", "sample").values
    return {
        FRAME: np.zeros(len(places)),
        **dict(zip(there["link"].values.tolist(), angles, strict=True)),
    }


def _bearings(mechanism: Mechanism, reactions: xr.Dataset) -> Iterator[Bearing]:
    """Of each hinge the link that is described first, which has the pin, with each of the others."""
    points = reactions["side_point"].values.tolist()
    bodies = reactions["side_link"].values.tolist()
    order = [*mechanism.links, FRAME]
    for point in dict.fromkeys(points):
        joined = [body for where, body in zip(points, bodies, strict=True) if where == point]
        first, *others = sorted(joined, key=order.index)
        for other in others:
            yield Bearing(point, first, other)


def _turn(vectors: Array, angle: Array) -> Array:
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y = vectors[..., 0], vectors[..., 1]
    return np.stack([cosine * x - sine * y, sine * x + cosine * y], axis=-1)


def _path(size: Array, turning: Array) -> Array:
    """Load times turning (end, step, bearing): halves of each step, at its beginning and its end; 0 where unknown."""
    step = np.abs(np.diff(turning, axis=0))
    halves = 0.5 * step * np.stack([size[:-1], size[1:]])
    return np.where(np.isfinite(halves).all(axis=0), halves, 0.0)


def _wear(path: Array, places: Array, sectors: int, arc: float) -> Array:
    """Shares (bearing, surface, sector) of the whole path, each half step spread over the arc about its place."""
    weights = np.zeros(places.shape[1:])
    # each half of a step belongs to the sample at its end, at whose place it wears
    weights[:-1] += path[0]
    weights[1:] += path[1]
    wide = 2.0 * np.pi / sectors
    found = np.zeros((places.shape[-1], len(SURFACES), sectors))
    whole = weights.sum(axis=0)
    for surface in range(len(SURFACES)):
        for sector in range(sectors):
            # in [-pi, pi): the shorter way around
            away = np.remainder(places[surface] - (sector + 0.5) * wide + np.pi, 2.0 * np.pi) - np.pi
            shared = _overlap(away, arc, wide) / arc
            found[:, surface, sector] = np.where(weights > 0.0, weights * shared, 0.0).sum(axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        found /= whole[:, None, None]
    return found


def _overlap(away: Array, arc: float, wide: float) -> Array:
    """Overlap [rad] of an arc and a sector whose middles lie so far apart [rad], also across the end of the turn."""
    total = np.zeros_like(away)
    # an arc of nearly a turn meets a sector from both sides
    for shift in (-2.0 * np.pi, 0.0, 2.0 * np.pi):
        low = np.maximum(away + shift - 0.5 * arc, -0.5 * wide)
        high = np.minimum(away + shift + 0.5 * arc, 0.5 * wide)
        total += np.maximum(high - low, 0.0)
    return total
