"""The reachable region of two drives: where the mechanism gets from its initial position without passing a limit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode import __version__
from centrode.errors import InputError, NotComputedYet, Status
from centrode.kinematics.dataset import labels_of
from centrode.kinematics.grids import Lines, lines_along
from centrode.kinematics.holding import (
    Value,
    held_values,
    initial_values,
    named_drive,
    unit_of_value,
    value_of,
)
from centrode.kinematics.reach import limits_about
from centrode.kinematics.ready import Ready, ready
from centrode.locale import _, speaking
from centrode.model.files import mechanism_text
from centrode.model.mechanism import Mechanism
from centrode.structure.groups import Newton
from centrode.structure.steps import name_of

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Ranges: TypeAlias = Mapping[str, tuple[Value, Value]]

DEFAULT_NODES = 181
MOST_NODES = 1001
SAME = 1e-9
"""Share of a range below which two values are one grid line."""
AT_A_NODE = 64.0
"""A limit this many units of the last place from a node is that node itself: it parts no neighbours."""
BESIDE = 0.1
"""Share of the way between the limits of a displacement that is shown beyond them on both sides."""


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
    nodes = [_nodes(prepared, name, (first, second), others, ranges, samples) for name in (first, second)]
    along_first = lines_along(prepared, first, nodes[0], second, nodes[1], others)
    along_second = lines_along(prepared, second, nodes[1], first, nodes[0], others)
    start = initial_values(prepared)
    seed = _node(nodes[0], start[first]), _node(nodes[1], start[second])
    if not along_second.closed[seed]:
        raise InputError(
            "hold",
            _("the mechanism does not close there in its initial position"),
            _("choose values at which it closes"),
        )
    passages = _passages(along_first, nodes[0]).T, _passages(along_second, nodes[1])
    rounds = [_comes_round(mechanism, name, n) for name, n in zip((first, second), nodes, strict=True)]
    reached = _reached(along_second.closed, *passages, seed, rounds)
    status = np.where(reached, Status.OK, np.where(along_second.closed, Status.CUT_OFF, Status.OPEN))
    variables: dict[str, Any] = {
        "status": _named(("first", "second"), status.astype(np.int8), "status of the node", "1"),
        "margin": _named(
            ("first", "second"), _margin(along_second), "smallest radicand over its greatest", "1"
        ),
        **_border(prepared, nodes, (along_first, along_second), reached),
    }
    variables["status"][2]["flag_values"] = np.array([s.value for s in Status], dtype=np.int8)
    variables["status"][2]["flag_meanings"] = " ".join(s.name.lower() for s in Status)
    return _dataset(prepared, variables, (first, second), nodes, others)


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
    chosen = names if drives is None else [named_drive(mechanism, name, "drives").id for name in drives]
    if len(chosen) != 2 or chosen[0] == chosen[1]:
        raise InputError(
            "drives",
            _("a region needs two different drives; {n} are given").format(n=len(set(chosen))),
            _("name two of: {names}").format(names=", ".join(names)),
        )
    return chosen[0], chosen[1]


def _nodes(
    prepared: Ready,
    name: str,
    pair: tuple[str, str],
    held: Mapping[str, float],
    ranges: Ranges | None,
    samples: int,
) -> Array:
    """Evenly spaced values of a drive over its range, with its initial value among them."""
    if isinstance(samples, bool) or not 2 <= samples <= MOST_NODES:
        raise InputError(
            _("samples"),
            _("{samples} samples were asked for").format(samples=samples),
            _("ask for {least} to {most}").format(least=2, most=MOST_NODES),
        )
    for given in ranges or {}:
        if given not in pair:
            raise InputError("ranges", _("{name} is not one of the two drives").format(name=given))
    mechanism, start = prepared.mechanism, initial_values(prepared)
    drive = named_drive(mechanism, name, "ranges")
    if ranges is not None and name in ranges:
        low, high = sorted(value_of(mechanism, drive, value, f"range {name}") for value in ranges[name])
    elif drive.kind == "angle":
        low, high = start[name] - np.pi, start[name] + np.pi
    else:
        low, high = _between_limits(prepared, name, {**start, **held})
    if drive.kind == "distance" and low <= 0.0:
        raise InputError(
            f"range {name}", _("a cylinder has a length above zero"), _("give the distance of its points")
        )
    if not low <= start[name] <= high or low == high:
        raise InputError(
            f"range {name}",
            _("it has to hold the initial value, {value:.6g}").format(value=start[name]),
            _("ask for a range about it"),
        )
    nodes = np.linspace(low, high, samples)
    nearest = _node(nodes, start[name])
    if abs(nodes[nearest] - start[name]) > SAME * (high - low):
        return np.union1d(nodes, [start[name]])
    nodes[nearest] = start[name]
    return nodes


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


def _node(nodes: Array, value: float) -> int:
    return int(np.argmin(np.abs(nodes - value)))


def _passages(lines: Lines, nodes: Array) -> Mask:
    """Where a line is closed at two neighbouring nodes and passes no limit between them: (lines, nodes - 1)."""
    free = lines.closed[:, :-1] & lines.closed[:, 1:]
    line, value, _group = lines.limits
    cell = np.clip(np.searchsorted(nodes, value, side="right") - 1, 0, len(nodes) - 2)
    margin = AT_A_NODE * np.spacing(np.max(np.abs(nodes)))
    inside = (nodes[cell] + margin < value) & (value < nodes[cell + 1] - margin)
    free[line[inside], cell[inside]] = False
    return free


def _comes_round(mechanism: Mechanism, name: str, nodes: Array) -> bool:
    """Whether the last value is the first one after a turn, so that the mechanism stands alike at both."""
    angular = named_drive(mechanism, name, "drives").kind == "angle"
    return angular and abs(nodes[-1] - nodes[0] - 2.0 * np.pi) <= 4.0 * np.spacing(np.max(np.abs(nodes)))


def _reached(closed: Mask, first: Mask, second: Mask, seed: tuple[int, int], rounds: Sequence[bool]) -> Mask:
    """Nodes connected with the seed by free passages along the first and the second drive.

    Where a drive comes round within its range, its last line goes on at its first.
    """
    reached = np.zeros(closed.shape, dtype=bool)
    reached[seed] = closed[seed]
    while True:
        before = int(reached.sum())
        for free, here, comes_round in ((first, reached, rounds[0]), (second.T, reached.T, rounds[1])):
            if comes_round:
                here[0] |= here[-1]
                here[-1] |= here[0]
            for k in range(len(free)):
                here[k + 1] |= here[k] & free[k]
            for k in range(len(free) - 1, -1, -1):
                here[k] |= here[k + 1] & free[k]
        if int(reached.sum()) == before:
            return reached


def _margin(lines: Lines) -> Array:
    """Smallest radicand of all groups, each over its greatest; NaN where none is known."""
    least = np.full(lines.closed.shape, np.nan)
    for values in lines.margins.values():
        with np.errstate(all="ignore"):
            greatest = float(np.nanmax(np.abs(values), initial=0.0))
            least = np.fmin(least, values / greatest if greatest > 0.0 else values)
    return np.ones_like(least) if not lines.margins else least


def _border(
    prepared: Ready, nodes: Sequence[Array], lines: tuple[Lines, Lines], reached: Mask
) -> dict[str, Any]:
    """Limits on all grid lines, those along the first drive before those along the second."""
    places, groups, touching = [], [], []
    for k, found in enumerate(lines):
        line, value, group = found.limits
        across = nodes[1 - k][line]
        places.append(np.stack([value, across] if k == 0 else [across, value], axis=-1))
        cell = np.clip(np.searchsorted(nodes[k], value, side="right") - 1, 0, len(nodes[k]) - 2)
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
    units = [unit_of_value(mechanism, named_drive(mechanism, name, "drives")) for name in pair]
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
        **{f"held_{name}": value for name, value in held.items()},
    }
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)
