"""Limits of one drive while the others are held."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf, isfinite, pi, tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import STATUSES_NOT_REACHED, InputError
from centrode.kinematics.assembly import Assembled
from centrode.kinematics.change_points import BranchedPlan, Smooth
from centrode.kinematics.events import EventScan
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.path import MAX_TURNS, DrivenBy, Path, TimeScale, unit_of
from centrode.kinematics.plan_evaluation import RadicandZero, branches_at_start, layout_of
from centrode.kinematics.preparation import Ready, ready
from centrode.kinematics.samples import ORDERS, Samples, evaluate_columns
from centrode.kinematics.solve import SEARCH, TURNS
from centrode.laws import Uniform
from centrode.locale import _
from centrode.model.examples.catalogue import MechanismSource, mechanism_of
from centrode.model.mechanism import Drive, Mechanism
from centrode.model.reading import nearest
from centrode.numerics.arrays import ARRAYS
from centrode.printed_results import PrintsSummary
from centrode.structure.assur import name_of
from centrode.structure.groups import Newton

# One drive that moves while the others are held: its path, and the position in which it starts.

Array: TypeAlias = npt.NDArray[np.float64]
Value: TypeAlias = float | str


def named_drive(mechanism: Mechanism, name: str, where: str) -> Drive:
    """The drive of a name; raises InputError for another."""
    names = [drive.id for drive in mechanism.drives]
    if name not in names:
        raise InputError(where, _("there is no drive {name}").format(name=name), nearest(name, names))
    return next(drive for drive in mechanism.drives if drive.id == name)


def value_of(ready: Ready, drive: Drive, value: Value, where: str) -> float:
    """Value of a drive [rad or m] of a number in SI, or of a text with a unit ("30 deg"); not too far away."""
    reading = ready.parameter.drive(drive.id).read(value, where)
    # as for samples: the mesh of nodes between both has to stay small
    way = abs(reading - initial_values(ready)[drive.id]) / unit_of(drive, ready.kinematics.path.scale)
    if way > tau * MAX_TURNS:
        raise InputError(
            where,
            _("it is too long: {turns:.3g} turns").format(turns=way / tau),
            _("give at most {most:g}").format(most=MAX_TURNS),
        )
    return reading


def held_values(ready: Ready, moving: tuple[str, ...], held: Mapping[str, Value] | None) -> dict[str, float]:
    """Values of all drives but the moving ones; those not named keep their initial ones."""
    mechanism = ready.mechanism
    values = {name: value for name, value in initial_values(ready).items() if name not in moving}
    for name, value in (held or {}).items():
        drive = named_drive(mechanism, name, "hold")
        if name in moving:
            raise InputError(
                "hold",
                _("drive {name} is the one that moves").format(name=name),
                _("fix the others"),
            )
        values[name] = value_of(ready, drive, value, f"hold {name}")
        if drive.kind == "distance" and values[name] <= 0.0:
            raise InputError(
                f"hold {name}", _("a cylinder has a length above zero"), _("give the distance of its points")
            )
    return values


def initial_values(ready: Ready) -> dict[str, float]:
    """Values of the coordinates of all drives in the initial position."""
    found = ready.assembled.positions.drives
    return {name: float(ready.parameter.drive(name).value_of(value)) for name, value in found.items()}


def held_path(ready: Ready, drive: str, initial: float, held: Mapping[str, float | Array]) -> Path:
    """The path of one drive's value; the values held may be arrays (lanes, 1)."""
    path = ready.kinematics.path
    driven = next(driven for driven in path.driven if driven.drive.id == drive)
    unit, parameter = unit_of(driven.drive, path.scale), path.parameter.along(drive)
    return Path((driven,), parameter, initial, 1.0, unit, path.scale, None, dict(held))


def starting_at(ready: Ready, path: Path) -> BranchedPlan:
    """The plan along the path of one drive, from the position in which that begins.

    That is the position with the signs of the initial one. Where signs do not tell it (groups of higher class, gears,
    rolling wheels), it is reached from the initial one by moving all drives there together, at constant speeds.
    """
    target: dict[str, float] = {path.driven[0].drive.id: path.initial, **path.held}
    kinematics = replace(ready.kinematics, path=path)
    start = ready.assembled
    # where the signs tell, the position follows from values alone, and no way is walked
    if _needs_a_way(ready) and target != initial_values(ready):
        start = _brought(ready, target)
    smooth = ready.mechanism.assembly.continuation == "smooth"
    branches = branches_at_start(path, start.signs, start.angles, smooth)
    return BranchedPlan(kinematics, branches, start.positions, kinematics.numbers)


def _needs_a_way(ready: Ready) -> bool:
    """Whether signs alone do not tell a position: in groups of higher class, and where turns are counted."""
    mechanism = ready.mechanism
    higher = any(isinstance(group, Newton) for group in ready.structure.groups)
    return higher or bool(mechanism.gears or mechanism.rolling)


class _Arriving(Smooth):
    """Keeps the angles that are counted with their turns."""

    def __init__(self, continuation: BranchedPlan, parameter: Array) -> None:
        super().__init__(continuation, ARRAYS, parameter, None)
        self.angles: dict[str, float] = {}

    def continue_angle(self, group: int, key: str, angle: Any) -> Any:
        with_turns = super().continue_angle(group, key, angle)
        self.angles[key] = _as_float(with_turns)
        return with_turns


def _as_float(x: Any) -> float:
    return float(np.asarray(x, dtype=np.float64).reshape(-1)[0])


def _brought(ready: Ready, target: Mapping[str, float]) -> Assembled:
    """The position after moving all drives from their initial values to others."""
    old = ready.kinematics.path
    # the way is one of what the drives give, whichever coordinates are chosen
    start = {name: float(value) for name, value in ready.assembled.positions.drives.items()}
    ways = {name: ready.parameter.drive(name).measure_at(target[name]) - start[name] for name in start}
    # all drives arrive at time 1
    driven = tuple(
        DrivenBy(one.drive, Uniform(ways[one.drive.id]), start[one.drive.id]) for one in old.driven
    )
    # the mesh has to be fine enough for the drive that goes farthest in its own unit
    fastest = max(abs(ways[one.drive.id]) / unit_of(one.drive, old.scale) for one in driven)
    pace = TimeScale.of(lambda times: np.full(len(times), fastest))
    path = Path(driven, old.parameter.in_time(), 0.0, 1.0, pace.unit_at(0.0), old.scale, pace)
    kinematics = replace(ready.kinematics, path=path)
    smooth = ready.mechanism.assembly.continuation == "smooth"
    first = ready.assembled
    branches = branches_at_start(path, first.signs, first.angles, smooth)
    continuation = BranchedPlan(kinematics, branches, first.positions, kinematics.numbers)
    # a limit on the way would leave the branch
    EventScan(continuation, mesh_of(path, np.ones(1))).run()
    if branches.reach(0)[1] < 1.0:
        raise InputError(
            "hold",
            _("on the straight path from the initial position to these values the mechanism locks"),
            _("choose values closer to the initial ones, or change the initial position in the description"),
        )
    # positions at the end of the way, with the turns counted on it
    arriving = _Arriving(continuation, np.ones((1, 1)))
    positions = kinematics.positions(ARRAYS, np.ones((1, 1)), arriving).map_numbers(_as_float)
    signs = {group: float(branches.sign(group, np.ones(1))[0, 0]) for group in branches.signs}
    angles = {**first.angles, **positions.angles, **arriving.angles}
    return replace(first, signs=signs, positions=positions, angles=angles)


def check_closed(continuation: BranchedPlan) -> None:
    """Refuse a path whose first position is open; its events are known."""
    path, layout = continuation.kinematics.path, layout_of(continuation.kinematics)
    at = np.array([path.initial])
    room = np.empty((ORDERS, layout.width, 1, 1)), np.empty((ORDERS, len(layout.angles), 1, 1))
    judged = evaluate_columns(continuation, Samples(layout, *room, np.zeros((1, 1), dtype=np.int8)), at)
    if bool(judged.opened.any() or judged.lost.any() or path.impossible(at).any()):
        values = {path.driven[0].drive.id: path.initial, **path.held}
        where = ", ".join(f"{name} = {value:.6g}" for name, value in values.items())
        raise InputError(
            _("values of the drives"),
            _("the mechanism does not close there ({where})").format(where=where),
            _("choose values at which it closes"),
        )


@dataclass(frozen=True)
class End:
    """A value of a drive [rad or m] and the group at whose limit or change point it lies."""

    value: float
    group: str


@dataclass(frozen=True, repr=False)
class Limits(PrintsSummary):
    """Between which values a drive can move while the others are held.

    Attributes
    ----------
    mechanism : Mechanism
    drive : its name
    unit : "rad" or "m"
    about : the value from which it moves
    held : values of the other drives [rad or m]
    low, high : End, or None where there is no limit within two turns (four times the greatest length)
    change_points : those between the limits
    """

    mechanism: Mechanism = field(compare=False, repr=False)
    drive: str
    unit: str
    about: float
    held: Mapping[str, float]
    low: End | None
    high: End | None
    change_points: tuple[End, ...]

    @property
    def interval(self) -> tuple[float, float]:
        """The ends as numbers; infinite where there is no limit."""
        return (self.low.value if self.low else -inf), (self.high.value if self.high else inf)

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        ends = {name: vars(end) if end else None for name, end in (("low", self.low), ("high", self.high))}
        return {
            "drive": self.drive,
            "unit": self.unit,
            "about": self.about,
            "held": dict(self.held),
            **ends,
            "change_points": [vars(end) for end in self.change_points],
        }


def limits(
    mechanism: MechanismSource,
    drive: str | None = None,
    held: Mapping[str, Value] | None = None,
    about: Value | None = None,
) -> Limits:
    """Limits of one drive about a value of it, with the others held.

    Parameters
    ----------
    drive : str
        Which drive moves; may be omitted where there is one.
    held : drive -> value [rad or m, or a text with a unit]
        Values of the others; those not named keep their initial ones.
    about : float or text
        The value from which it moves; its initial one by default.

    Returns
    -------
    Limits
        Exact to rounding: the radicand of a group is followed to its zero. The assembly is that with the signs of
        the initial position; one with a group of higher class is brought there from the initial position, all
        drives together.

    Raises
    ------
    InputError
        There is no such drive, or the mechanism does not close at the values given.
    NotComputedYet
        As `motion` does.

    Examples
    --------
    >>> import centrode as ct
    >>> locked = ct.example("slider-between-cranks-locked")
    >>> print(ct.summary(ct.limits(locked)))
    drive          OA
    held drives    none
    initial value  0 rad (0 deg)
    from           -0.808314721 rad (-46.313 deg), limit of group CB-BD (point B)
    to             1.79991242 rad (103.127 deg), limit of group CB-BD (point B)
    change points  none
    """
    mechanism = mechanism_of(mechanism)
    prepared = ready(mechanism)
    moving = chosen_drive(mechanism, drive)
    others = held_values(prepared, (moving,), held)
    chosen = named_drive(mechanism, moving, "drive")
    start = initial_values(prepared)[moving]
    start = start if about is None else value_of(prepared, chosen, about, "about")
    return limits_about(prepared, moving, others, start)


def chosen_drive(mechanism: Mechanism, drive: str | None) -> str:
    """The drive that moves, the only one if none is named."""
    names = [one.id for one in mechanism.drives]
    if drive is not None:
        return named_drive(mechanism, drive, "drive").id
    if len(names) == 1:
        return names[0]
    raise InputError(
        "drive",
        _("the mechanism has {n} drives").format(n=len(names)),
        _("name the drive that moves: {names}").format(names=", ".join(names)),
    )


def has_one_drive(mechanism: Mechanism) -> bool:
    """Whether limits need no choice of the drive."""
    return len(mechanism.drives) == 1


def limits_met(mechanism: Mechanism, status: npt.NDArray[np.int8]) -> tuple[End, ...]:
    """What bounds the motion of the only drive where samples (n) are not reached; nothing where all are."""
    if not has_one_drive(mechanism) or not np.isin(status, STATUSES_NOT_REACHED).any():
        return ()
    found = limits(mechanism)
    return tuple(end for end in (found.low, found.high) if end is not None)


def limits_about(prepared: Ready, drive: str, held: Mapping[str, float], about: float) -> Limits:
    """Limits of a drive about its value `about` [rad or m], the values of the others held; see `limits`."""
    path = held_path(prepared, drive, about, held)
    continuation = starting_at(prepared, path)
    angular = path.driven[0].drive.kind == "angle"
    extent = 2.0 * pi * TURNS if angular else SEARCH * path.unit
    EventScan(continuation, mesh_of(path, np.array([about - extent, about + extent]))).run()
    # after the search, as it needs the events
    check_closed(continuation)
    low, high = continuation.branches.reach(0)
    low, high = path.possible(low, high)

    def end(value: float) -> End | None:
        if not isfinite(value):
            return None
        groups = _groups(prepared, continuation.branches.events, value)
        return End(value, groups or _("cylinder {name} of no length").format(name=drive))

    inside = [
        End(event.at, name_of(prepared.structure.groups[event.group]))
        for event in continuation.branches.events
        if event.kind == "change point" and low <= event.at <= high and abs(event.at - about) <= extent
    ]
    unit = path.parameter.variable.unit
    limits = tuple(sorted(inside, key=lambda one: one.value))
    return Limits(prepared.mechanism, drive, unit, about, dict(held), end(low), end(high), limits)


def _groups(prepared: Ready, events: list[RadicandZero], value: float) -> str:
    """Names of the groups that lock at a value."""
    # several groups may lock at one value: to the last bit the same event
    which = dict.fromkeys(event.group for event in events if event.kind == "limit" and event.at == value)
    return ", ".join(name_of(prepared.structure.groups[group]) for group in which)
