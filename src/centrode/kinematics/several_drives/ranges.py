"""The values of two drives at which a region is computed."""

from __future__ import annotations

from collections.abc import Mapping
from math import tau
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import InputError
from centrode.kinematics.paths import unit_of
from centrode.kinematics.ready import Ready
from centrode.kinematics.several_drives.holding import Value, initial_values, named_drive, value_of
from centrode.kinematics.several_drives.reach import limits_about
from centrode.locale import _
from centrode.model.mechanism import Drive, Mechanism

Array: TypeAlias = npt.NDArray[np.float64]
Ranges: TypeAlias = Mapping[str, tuple[Value, Value]]

MOST_NODES = 1001
MOST_TURNS = 10.0
SAME = 1e-9
"""Share of a range below which two values are one grid line."""
BESIDE = 0.1
"""Share of the way between the limits of a displacement that is shown beyond them on both sides."""


def grid_nodes(
    prepared: Ready,
    name: str,
    pair: tuple[str, str],
    held: Mapping[str, float],
    ranges: Ranges | None,
    samples: int,
) -> Array:
    """Evenly spaced values of a drive over its range, with its initial value among them."""
    _check_asked(pair, ranges, samples)
    start = initial_values(prepared)
    drive = named_drive(prepared.mechanism, name, "ranges")
    if ranges is not None and name in ranges:
        low, high = sorted(value_of(prepared, drive, value, f"range {name}") for value in ranges[name])
    elif drive.kind == "angle":
        low, high = start[name] - np.pi, start[name] + np.pi
    else:
        low, high = _between_limits(prepared, name, {**start, **held})
    _check_range(drive, start[name], low, high, unit_of(drive, prepared.kinematics.path.scale))
    nodes = np.linspace(low, high, samples)
    nearest = node_of(nodes, start[name])
    if abs(nodes[nearest] - start[name]) > SAME * (high - low):
        return np.union1d(nodes, [start[name]])
    nodes[nearest] = start[name]
    return nodes


def _check_asked(pair: tuple[str, str], ranges: Ranges | None, samples: int) -> None:
    """Refuse numbers of samples that make no grid, and ranges of what is not on it."""
    if isinstance(samples, bool) or not 2 <= samples <= MOST_NODES:
        raise InputError(
            _("samples"),
            _("{samples} samples were asked for").format(samples=samples),
            _("ask for {least} to {most}").format(least=2, most=MOST_NODES),
        )
    for given in ranges or {}:
        if given not in pair:
            raise InputError("ranges", _("{name} is not one of the two drives").format(name=given))


def _check_range(drive: Drive, initial: float, low: float, high: float, unit: float) -> None:
    """Refuse a range that is empty, too long, without the initial value, or of cylinders without a length."""
    where = f"range {drive.id}"
    if drive.kind == "distance" and low <= 0.0:
        raise InputError(where, _("a cylinder has a length above zero"), _("give the distance of its points"))
    if low == high:
        raise InputError(where, _("it is empty"), _("ask for a range about the initial value"))
    if not low <= initial <= high:
        raise InputError(
            where,
            _("it has to hold the initial value, {value:.6g}").format(value=initial),
            _("ask for a range about it"),
        )
    turns = (high - low) / (tau * unit)
    if turns > MOST_TURNS * (1.0 + SAME):
        raise InputError(
            where,
            _("it reaches too far: {turns:.3g} turns").format(turns=turns),
            _("ask for at most {most:g}").format(most=MOST_TURNS),
        )


def _between_limits(prepared: Ready, name: str, values: Mapping[str, float]) -> tuple[float, float]:
    """Range of a displacement: its limits with the other drives held, and a little beyond."""
    held = {drive: value for drive, value in values.items() if drive != name}
    low, high = limits_about(prepared, name, held, values[name]).interval
    if not np.isfinite(high - low):
        raise InputError(
            f"range {name}", _("its range is unlimited"), _("say from where to where, first and last value")
        )
    beyond = BESIDE * (high - low)
    cylinder = named_drive(prepared.mechanism, name, "ranges").kind == "distance"
    return (max(low - beyond, 1e-3 * high) if cylinder else low - beyond), high + beyond


def node_of(nodes: Array, value: float) -> int:
    """Number of the node nearest to a value."""
    return int(np.argmin(np.abs(nodes - value)))


def comes_round(mechanism: Mechanism, name: str, nodes: Array) -> bool:
    """Whether the last value is the first one after a turn, so that the mechanism stands alike at both."""
    angular = named_drive(mechanism, name, "drives").kind == "angle"
    return angular and abs(nodes[-1] - nodes[0] - 2.0 * np.pi) <= 4.0 * np.spacing(np.max(np.abs(nodes)))
