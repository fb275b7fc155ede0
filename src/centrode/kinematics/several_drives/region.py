"""The reachable region of two drives: where the mechanism gets from its initial position without passing a limit."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import STATUSES_OF_MOTION, InputError, NotComputedYet, Status
from centrode.kinematics.dataset import labels_of
from centrode.kinematics.motion import motion
from centrode.kinematics.ready import Ready, ready
from centrode.kinematics.several_drives.grids import Lines, cells_of, lines_along, reached_from
from centrode.kinematics.several_drives.holding import (
    Value,
    held_values,
    initial_values,
    named_drive,
)
from centrode.kinematics.several_drives.ranges import Ranges, comes_round, grid_nodes, node_of
from centrode.locale import _, speaking
from centrode.model.files import mechanism_text
from centrode.model.mechanism import Mechanism
from centrode.structure.groups import Newton
from centrode.structure.steps import name_of
from centrode.version import __version__

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]

DEFAULT_NODES = 181


def reachable_region(
    mechanism: Mechanism,
    drives: Sequence[str] | None = None,
    ranges: Ranges | None = None,
    samples: int = DEFAULT_NODES,
    held: Mapping[str, Value] | None = None,
) -> xr.Dataset:
    """Values of two drives that the mechanism reaches from its initial position without passing a limit.

    Parameters
    ----------
    drives : two names
        May be left out where there are two.
    ranges : drive -> (first, last) [rad or m, or texts with units]
        They hold the initial values. Left out: one turn about the initial value of an angle; the limits of a
        displacement with the other drives at their initial values, and a little beyond. A range of one turn goes
        on at its other end, where the mechanism stands alike.
    samples : int
        Grid lines of each drive; those of the initial values are added.
    held : drive -> value
        Of further drives; those not named keep their initial values.

    Returns
    -------
    Dataset
        `status` (first, second) of the grid nodes: ok, cut off (it closes, but not within reach), open; `margin`,
        the smallest radicand of all groups, each over its greatest on the grid; `border_value` (border, drive), the
        limits on all grid lines, exact to rounding (docs: results). Groups keep their initial signs.

    Raises
    ------
    InputError
        Not two drives; ranges that do not hold the initial position.
    NotComputedYet
        A group of higher class, gears or rolling wheels; as `motion` does.
    """
    prepared = ready(mechanism)
    _refuse_what_is_not_computed(prepared)
    first, second = _two_drives(mechanism, drives)
    others = held_values(prepared, (first, second), held)
    nodes = [grid_nodes(prepared, name, (first, second), others, ranges, samples) for name in (first, second)]
    along_first = lines_along(prepared, first, nodes[0], second, nodes[1], others)
    along_second = lines_along(prepared, second, nodes[1], first, nodes[0], others)
    start = initial_values(prepared)
    seed = node_of(nodes[0], start[first]), node_of(nodes[1], start[second])
    if not along_second.closed[seed]:
        raise InputError(
            "hold",
            _("the mechanism does not close there in its initial position"),
            _("choose values at which it closes"),
        )
    passages = along_first.passages(nodes[0]).T, along_second.passages(nodes[1])
    rounds = [comes_round(mechanism, name, n) for name, n in zip((first, second), nodes, strict=True)]
    reached = reached_from(along_second.closed, *passages, seed, rounds)
    status = np.where(reached, Status.OK, np.where(along_second.closed, Status.CUT_OFF, Status.OPEN))
    variables: dict[str, Any] = {
        "status": _named(("first", "second"), status.astype(np.int8), "status of the node", "1"),
        "margin": _named(
            ("first", "second"), along_second.margin(), "smallest radicand over its greatest", "1"
        ),
        **_border(prepared, nodes, (along_first, along_second), reached),
    }
    variables["status"][2]["flag_values"] = np.array([s.value for s in STATUSES_OF_MOTION], dtype=np.int8)
    variables["status"][2]["flag_meanings"] = " ".join(s.name.lower() for s in STATUSES_OF_MOTION)
    return _dataset(prepared, variables, (first, second), nodes, others)


@dataclass(frozen=True)
class RegionResults:
    """The reachable region of two drives.

    Attributes
    ----------
    mechanism : Mechanism
    region : the dataset of `reachable_region`
    motion : the motion whose path leads through the region; None where nothing says how long it lasts
    """

    mechanism: Mechanism
    region: xr.Dataset
    motion: xr.Dataset | None


def region_results(
    mechanism: Mechanism,
    drives: Sequence[str] | None = None,
    ranges: Ranges | None = None,
    samples: int = DEFAULT_NODES,
    held: Mapping[str, Value] | None = None,
) -> RegionResults:
    """The reachable region with the mechanism and its motion; raises as `reachable_region` does."""
    region = reachable_region(mechanism, drives, ranges, samples, held)
    try:
        return RegionResults(mechanism, region, motion(mechanism))
    except InputError:  # laws of several drives may not say how long the motion lasts
        return RegionResults(mechanism, region, None)


def has_two_drives(mechanism: Mechanism) -> bool:
    """Whether a region needs no choice of drives."""
    return len(mechanism.drives) == 2


def _refuse_what_is_not_computed(prepared: Ready) -> None:
    mechanism = prepared.mechanism
    higher = [group for group in prepared.structure.groups if isinstance(group, Newton)]
    if higher:
        where, what = (
            name_of(higher[0]),
            _("the reachable region of groups of higher class is not computed yet"),
        )
    elif mechanism.gears or mechanism.rolling:
        where, what = "[[gears]]", _("the reachable region with gears or rolling wheels is not computed yet")
    else:
        return
    raise NotComputedYet(where, what, _("ask for the limits of one drive at a time"))


def _two_drives(mechanism: Mechanism, drives: Sequence[str] | None) -> tuple[str, str]:
    names = [drive.id for drive in mechanism.drives]
    if len(names) < 2:
        raise InputError(
            "[[drives]]",
            _("a region needs two drives, the mechanism has one"),
            _("ask for the limits of its drive"),
        )
    chosen = names if drives is None else [named_drive(mechanism, name, "drives").id for name in drives]
    if len(chosen) != 2 or chosen[0] == chosen[1]:
        raise InputError(
            "drives",
            _("a region needs two different drives; {n} are given").format(n=len(set(chosen))),
            _("name two of: {names}").format(names=", ".join(names)),
        )
    return chosen[0], chosen[1]


def _border(
    prepared: Ready, nodes: Sequence[Array], lines: tuple[Lines, Lines], reached: Mask
) -> dict[str, Any]:
    """Limits on all grid lines, those along the first drive before those along the second."""
    places, groups, touching = [], [], []
    for k, found in enumerate(lines):
        line, value, group = found.limits
        across = nodes[1 - k][line]
        places.append(np.stack([value, across] if k == 0 else [across, value], axis=-1))
        cell = cells_of(nodes[k], value)
        grid = reached.T if k == 0 else reached
        touching.append(grid[line, cell] | grid[line, cell + 1])
        groups.append(group)
    with speaking("en"):
        names = [name_of(prepared.structure.groups[group]) for group in np.concatenate(groups)]
    return {
        "border_value": _named(
            ("border", "drive"), np.concatenate(places), "values of the drives at a limit", ""
        ),
        "border_reached": _named(
            ("border",), np.concatenate(touching).astype(np.int8), "whether the limit bounds the region", "1"
        ),
        "border_group": _named(("border",), np.array(names, dtype=str), "group of the limit", "1"),
    }


def _named(dimensions: tuple[str, ...], values: Any, long_name: str, unit: str) -> tuple[Any, ...]:
    return dimensions, values, {"units": unit, "long_name": long_name}


def _dataset(
    prepared: Ready,
    variables: dict[str, Any],
    pair: tuple[str, str],
    nodes: Sequence[Array],
    held: Mapping[str, float],
) -> xr.Dataset:
    mechanism, start = prepared.mechanism, initial_values(prepared)
    units = [prepared.parameter.drive(name).unit for name in pair]
    each = units[0] if units[0] == units[1] else " ".join(units)
    variables["border_value"][2]["units"] = each
    initial = np.array([start[name] for name in pair])
    variables["initial_value"] = _named(
        ("drive",), initial, "values of the drives in the initial position", each
    )
    coordinates = {
        "first": _named(("first",), nodes[0], f"value of drive {pair[0]}", units[0]),
        "second": _named(("second",), nodes[1], f"value of drive {pair[1]}", units[1]),
        "drive": labels_of(pair),
    }
    attributes = {
        "title": mechanism.title,
        "mechanism": mechanism_text(mechanism),
        "version": __version__,
        "held": json.dumps(held),
    }
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)
