"""The reachable region of two drives: where the mechanism gets from its initial position without passing a limit."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from centrode.errors import STATUSES_OF_MOTION, InputError, NotComputedYet, Status
from centrode.kinematics.change_points import BranchedPlan
from centrode.kinematics.events import EventScan
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.motion import labels_of, motion
from centrode.kinematics.path import JETS, unit_of
from centrode.kinematics.plan_evaluation import PlanLayout, RadicandZero, branches_at_start, layout_of
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.samples import ORDERS, SampleJudging, fill_columns
from centrode.kinematics.several_inputs.limits import (
    Value,
    held_path,
    held_values,
    initial_values,
    limits_about,
    named_drive,
    value_of,
)
from centrode.locale import _, ngettext, speaking
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.files import mechanism_text
from centrode.model.mechanism import Drive, Mechanism
from centrode.numerics.jets import Jet
from centrode.structure.assur import name_of
from centrode.structure.groups import Newton
from centrode.version import __version__

# Two drives on a grid of their values: where the mechanism closes, and where every grid line meets a limit.

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Number: TypeAlias = Any

AT_A_NODE = 64.0
"""A limit this many units of the last place from a node is that node itself: it parts no neighbours."""
CHUNK = 200_000
"""Lines are followed together as long as lines times mesh nodes stay below this."""


@dataclass(frozen=True)
class Lines:
    """All grid lines along one drive, one for each value of the other.

    Attributes
    ----------
    closed : (lines, nodes) where the mechanism closes
    margins : group -> (lines, nodes) its radicand, or the size of its divisor
    limits : (k,) line, (k,) value, (k,) group of every limit on them
    """

    closed: Mask
    margins: Mapping[int, Array]
    limits: tuple[npt.NDArray[np.intp], Array, npt.NDArray[np.intp]]

    def passages(self, nodes: Array) -> Mask:
        """Where a line is closed at two neighbouring nodes and passes no limit between them: (lines, nodes - 1)."""
        free = self.closed[:, :-1] & self.closed[:, 1:]
        line, value, _group = self.limits
        cell = cells_of(nodes, value)
        # a limit at a node, but for rounding, is the end of a passage and not within one
        margin = AT_A_NODE * np.spacing(np.max(np.abs(nodes)))
        inside = (nodes[cell] + margin < value) & (value < nodes[cell + 1] - margin)
        free[line[inside], cell[inside]] = False
        return free

    def margin(self) -> Array:
        """Smallest radicand of all groups, each over its greatest; NaN where none is known."""
        least = np.full(self.closed.shape, np.nan)
        for values in self.margins.values():
            # over the greatest on the grid: radicands of different groups have different units
            with np.errstate(all="ignore"):
                greatest = float(np.nanmax(np.abs(values), initial=0.0))
                least = np.fmin(least, values / greatest if greatest > 0.0 else values)
        return least if self.margins else np.ones_like(least)


def cells_of(nodes: Array, values: Array) -> npt.NDArray[np.intp]:
    """Between which node and the next values lie."""
    return np.clip(np.searchsorted(nodes, values, side="right") - 1, 0, len(nodes) - 2)


def lines_along(
    ready: Ready, drive: str, nodes: Array, across: str, places: Array, held: Mapping[str, float]
) -> Lines:
    """Grid lines along `drive` at `nodes`, one for each of `places` of the drive `across`."""
    path = held_path(ready, drive, float(ready.assembled.positions.drives[drive]), held)
    count = max(1, CHUNK // len(mesh_of(path, nodes)))
    parts = [
        _some(ready, drive, nodes, {**held, across: places[first : first + count, None]}, first)
        for first in range(0, len(places), count)
    ]
    limits = tuple(np.concatenate(each) for each in zip(*(part.limits for part in parts), strict=True))
    return Lines(
        np.concatenate([part.closed for part in parts]),
        {group: np.concatenate([part.margins[group] for part in parts]) for group in parts[0].margins},
        (limits[0], limits[1], limits[2]),
    )


def _some(ready: Ready, drive: str, nodes: Array, held: Mapping[str, Any], first: int) -> Lines:
    """Grid lines that are followed together, the first with number `first`."""
    path = held_path(ready, drive, float(ready.assembled.positions.drives[drive]), held)
    lanes = max(len(value) for value in held.values() if isinstance(value, np.ndarray))
    # signs stay: the region is that of one assembly, and change points do not lead out of it
    branches = branches_at_start(
        path,
        ready.assembled.signs,
        ready.assembled.angles,
        smooth=False,
        lanes=lanes,
    )
    kinematics = replace(ready.kinematics, path=path)
    continuation = BranchedPlan(kinematics, branches, ready.assembled.positions, kinematics.numbers)
    EventScan(continuation, mesh_of(path, nodes)).run()
    judged = _measure_nodes(continuation, layout_of(kinematics), nodes, lanes)
    return Lines(~judged.opened, judged.margins, _limits(branches.events, nodes, first))


def _limits(
    events: list[RadicandZero], nodes: Array, first: int
) -> tuple[npt.NDArray[np.intp], Array, npt.NDArray[np.intp]]:
    limits = [e for e in events if e.kind == "limit" and nodes[0] <= e.at <= nodes[-1]]
    return (
        np.array([event.lane + first for event in limits], dtype=np.intp),
        np.array([event.at for event in limits], dtype=np.float64),
        np.array([event.group for event in limits], dtype=np.intp),
    )


class _Measuring(SampleJudging):
    """Judges as for a motion, and keeps what decides whether each group closes."""

    def __init__(self, continuation: BranchedPlan, along: Array, shape: tuple[int, ...]) -> None:
        super().__init__(continuation, along, shape)
        self.margins: dict[int, Array] = {}

    def root(self, group: int, radicand: Number) -> Number:
        self.margins[group] = self._spread(radicand)
        return super().root(group, radicand)

    def divisor(self, group: int, divisor: Number) -> Number:
        # a divisor is lost at zero from either side
        self.margins[group] = np.abs(self._spread(divisor))
        return divisor

    def _spread(self, number: Number) -> Array:
        value = number.value if isinstance(number, Jet) else number
        return np.array(np.broadcast_to(value, self.shape), dtype=np.float64)


def _measure_nodes(continuation: BranchedPlan, layout: PlanLayout, nodes: Array, lanes: int) -> _Measuring:
    columns = np.empty((ORDERS, layout.width, lanes, len(nodes)))
    judging = _Measuring(continuation, nodes[None, :], (lanes, len(nodes)))
    kinematics = continuation.kinematics
    with np.errstate(all="ignore"):
        at = kinematics.positions(JETS, Jet.variable(nodes[None, :], ORDERS - 1), judging)
        fill_columns(kinematics, layout, at, columns)
    # groups at infinity close nowhere
    judging.opened |= ~np.isfinite(columns[0]).all(axis=0)
    return judging


def reached_from(
    closed: Mask, first: Mask, second: Mask, seed: tuple[int, int], rounds: Sequence[bool]
) -> Mask:
    """Nodes connected with the seed by free passages along the first and the second drive.

    Where a drive comes round within its range, its last line goes on at its first.
    """
    reached = np.zeros(closed.shape, dtype=bool)
    reached[seed] = closed[seed]
    # until nothing is added: each round sweeps forwards and backwards along both drives
    while True:
        before = int(reached.sum())
        for free, here, closes, comes_round in (
            (first, reached, closed, rounds[0]),
            (second.T, reached.T, closed.T, rounds[1]),
        ):
            # the first and the last line are one
            if comes_round:
                ends = here[0] | here[-1]
                here[0], here[-1] = ends & closes[0], ends & closes[-1]
            # row by row, each with all its columns: a sweep carries a passage as far as it goes
            for k in range(len(free)):
                here[k + 1] |= here[k] & free[k]
            for k in range(len(free) - 1, -1, -1):
                here[k] |= here[k + 1] & free[k]
        if int(reached.sum()) == before:
            return reached


# The values of two drives at which a region is computed.

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
    # about the initial value, so that it stands in the middle
    elif drive.kind == "angle":
        low, high = start[name] - np.pi, start[name] + np.pi
    else:
        low, high = _between_limits(prepared, name, {**start, **held})
    _check_range(drive, start[name], low, high, unit_of(drive, prepared.kinematics.path.scale))
    nodes = np.linspace(low, high, samples)
    nearest = node_of(nodes, start[name])
    # the initial value is a node exactly, as the search begins there
    if abs(nodes[nearest] - start[name]) > SAME * (high - low):
        return np.union1d(nodes, [start[name]])
    nodes[nearest] = start[name]
    return nodes


def _check_asked(pair: tuple[str, str], ranges: Ranges | None, samples: int) -> None:
    """Refuse numbers of samples that make no grid, and ranges of what is not on it."""
    if isinstance(samples, bool) or not 2 <= samples <= MOST_NODES:
        raise InputError(
            _("samples"),
            ngettext("{n} sample is given", "{n} samples are given", samples).format(n=samples),
            _("give {least} to {most}").format(least=2, most=MOST_NODES),
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
        raise InputError(where, _("it is empty"), _("choose a range around the initial value"))
    if not low <= initial <= high:
        raise InputError(
            where,
            _("it must contain the initial value, {value:.6g}").format(value=initial),
            _("choose a range that contains it"),
        )
    turns = (high - low) / (tau * unit)
    if turns > MOST_TURNS * (1.0 + SAME):
        raise InputError(
            where,
            _("it is too long: {turns:.3g} turns").format(turns=turns),
            _("give at most {most:g}").format(most=MOST_TURNS),
        )


def _between_limits(prepared: Ready, name: str, values: Mapping[str, float]) -> tuple[float, float]:
    """Range of a displacement: its limits with the other drives held, and a little beyond."""
    held = {drive: value for drive, value in values.items() if drive != name}
    low, high = limits_about(prepared, name, held, values[name]).interval
    if not np.isfinite(high - low):
        raise InputError(f"range {name}", _("its range is unlimited"), _("give the first and the last value"))
    beyond = BESIDE * (high - low)
    cylinder = named_drive(prepared.mechanism, name, "ranges").kind == "distance"
    # a cylinder's range begins above zero
    return (max(low - beyond, 1e-3 * high) if cylinder else low - beyond), high + beyond


def node_of(nodes: Array, value: float) -> int:
    """Number of the node nearest to a value."""
    return int(np.argmin(np.abs(nodes - value)))


def comes_round(mechanism: Mechanism, name: str, nodes: Array) -> bool:
    """Whether the last value is the first one after a turn, so that the mechanism stands alike at both."""
    angular = named_drive(mechanism, name, "drives").kind == "angle"
    return angular and abs(nodes[-1] - nodes[0] - 2.0 * np.pi) <= 4.0 * np.spacing(np.max(np.abs(nodes)))


DEFAULT_NODES = 181


def reachable_region(
    mechanism: MechanismSource,
    drives: Sequence[str] | None = None,
    ranges: Ranges | None = None,
    samples: int = DEFAULT_NODES,
    held: Mapping[str, Value] | None = None,
) -> xr.Dataset:
    """Values of two drives that the mechanism reaches from its initial position without passing a limit.

    Parameters
    ----------
    drives : two names
        May be omitted where there are two.
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

    Examples
    --------
    >>> import centrode as ct
    >>> region = ct.reachable_region(ct.example("five-bar-two-drives"), samples=9)
    >>> print(ct.summary(region).splitlines()[0])
    drive OA              -3.14159265 rad (-180 deg) to 3.14159265 rad (180 deg)
    """
    mechanism = mechanism_of(mechanism)
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
        "status": _region_variable(("first", "second"), status.astype(np.int8), "status of the node", "1"),
        "margin": _region_variable(
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
    return results_of_region(mechanism, reachable_region(mechanism, drives, ranges, samples, held))


def results_of_region(mechanism: Mechanism, region: xr.Dataset) -> RegionResults:
    """A dataset of `reachable_region` with the motion whose path leads through it."""
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
    raise NotComputedYet(where, what, _("compute the limits of one drive at a time"))


def _two_drives(mechanism: Mechanism, drives: Sequence[str] | None) -> tuple[str, str]:
    names = [drive.id for drive in mechanism.drives]
    if len(names) < 2:
        raise InputError(
            "[[drives]]",
            _("a region needs two drives, the mechanism has one"),
            _("compute the limits of its drive"),
        )
    chosen = names if drives is None else [named_drive(mechanism, name, "drives").id for name in drives]
    if len(chosen) != 2 or chosen[0] == chosen[1]:
        raise InputError(
            "drives",
            ngettext(
                "a region needs two different drives; {n} is given",
                "a region needs two different drives; {n} are given",
                len(set(chosen)),
            ).format(n=len(set(chosen))),
            _("name two of: {names}").format(names=", ".join(names)),
        )
    return chosen[0], chosen[1]


def _border(
    prepared: Ready, nodes: Sequence[Array], lines: tuple[Lines, Lines], reached: Mask
) -> dict[str, Any]:
    """Limits on all grid lines, those along the first drive before those along the second."""
    places, groups, touching = [], [], []
    for k, points in enumerate(lines):
        line, value, group = points.limits
        across = nodes[1 - k][line]
        # points are in the order of the drives, whichever runs along the line
        places.append(np.stack([value, across] if k == 0 else [across, value], axis=-1))
        cell = cells_of(nodes[k], value)
        grid = reached.T if k == 0 else reached
        # a limit bounds the region if a node beside it is reached
        touching.append(grid[line, cell] | grid[line, cell + 1])
        groups.append(group)
    with speaking("en"):
        names = [name_of(prepared.structure.groups[group]) for group in np.concatenate(groups)]
    return {
        "border_value": _region_variable(
            ("border", "drive"), np.concatenate(places), "values of the drives at a limit", ""
        ),
        "border_reached": _region_variable(
            ("border",), np.concatenate(touching).astype(np.int8), "whether the limit bounds the region", "1"
        ),
        "border_group": _region_variable(("border",), np.array(names, dtype=str), "group of the limit", "1"),
    }


def _region_variable(dimensions: tuple[str, ...], values: Any, long_name: str, unit: str) -> tuple[Any, ...]:
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
    variables["initial_value"] = _region_variable(
        ("drive",), initial, "values of the drives in the initial position", each
    )
    coordinates = {
        "first": _region_variable(("first",), nodes[0], f"value of drive {pair[0]}", units[0]),
        "second": _region_variable(("second",), nodes[1], f"value of drive {pair[1]}", units[1]),
        "drive": labels_of(pair),
    }
    attributes = {
        "topic": "region",
        "title": mechanism.title,
        "mechanism": mechanism_text(mechanism),
        "version": __version__,
        "held": json.dumps(held),
    }
    return xr.Dataset(variables, coords=coordinates, attrs=attributes)
