"""One drive that moves while the others are held: its path, and the position in which it starts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.errors import InputError
from centrode.kinematics.assembly import Assembled
from centrode.kinematics.branches import branches_at_start
from centrode.kinematics.continuation import Continuation, Smooth
from centrode.kinematics.events import Scan
from centrode.kinematics.layout import layout_of
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.pace import Pace
from centrode.kinematics.paths import DrivenBy, Path, unit_of
from centrode.kinematics.ready import Ready
from centrode.kinematics.sampling import ORDERS, Samples, evaluate_columns
from centrode.kinematics.spans import MAX_TURNS
from centrode.laws import Uniform
from centrode.locale import _
from centrode.model.mechanism import Drive, Mechanism
from centrode.model.problems import nearest
from centrode.structure.groups import Newton

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
    found = ready.parameter.drive(drive.id).read(value, where)
    way = abs(found - initial_values(ready)[drive.id]) / unit_of(drive, ready.kinematics.path.scale)
    if way > tau * MAX_TURNS:
        raise InputError(
            where,
            _("it reaches too far: {turns:.3g} turns").format(turns=way / tau),
            _("ask for at most {most:g}").format(most=MAX_TURNS),
        )
    return found


def held_values(ready: Ready, moving: tuple[str, ...], held: Mapping[str, Value] | None) -> dict[str, float]:
    """Values of all drives but the moving ones; those not named keep their initial ones."""
    mechanism = ready.mechanism
    found = {name: value for name, value in initial_values(ready).items() if name not in moving}
    for name, value in (held or {}).items():
        drive = named_drive(mechanism, name, "hold")
        if name in moving:
            raise InputError(
                "hold",
                _("drive {name} is the one that moves").format(name=name),
                _("hold the others"),
            )
        found[name] = value_of(ready, drive, value, f"hold {name}")
        if drive.kind == "distance" and found[name] <= 0.0:
            raise InputError(
                f"hold {name}", _("a cylinder has a length above zero"), _("give the distance of its points")
            )
    return found


def initial_values(ready: Ready) -> dict[str, float]:
    """Values of all drives in the initial position."""
    return {name: float(value) for name, value in ready.assembled.positions.drives.items()}


def held_path(ready: Ready, drive: str, initial: float, held: Mapping[str, float | Array]) -> Path:
    """The path of one drive's value; the values held may be arrays (lanes, 1)."""
    path = ready.kinematics.path
    one = next(one for one in path.driven if one.drive.id == drive)
    unit, parameter = unit_of(one.drive, path.scale), path.parameter.along(drive)
    return Path((one,), parameter, initial, 1.0, unit, path.scale, None, dict(held))


def starting_at(ready: Ready, path: Path) -> Continuation:
    """The plan along the path of one drive, from the position in which that begins.

    That is the position with the signs of the initial one. Where signs do not tell it (groups of higher class, gears,
    rolling wheels), it is reached from the initial one by moving all drives there together, at constant speeds.
    """
    target: dict[str, float] = {path.driven[0].drive.id: path.initial, **path.held}
    kinematics = replace(ready.kinematics, path=path)
    start = ready.assembled
    if _needs_a_way(ready) and target != initial_values(ready):
        start = _brought(ready, target)
    smooth = ready.mechanism.assembly.continuation == "smooth"
    branches = branches_at_start(path, start.signs, start.angles, smooth)
    return Continuation(kinematics, branches, start.positions, kinematics.numbers)


def _needs_a_way(ready: Ready) -> bool:
    """Whether signs alone do not tell a position: in groups of higher class, and where turns are counted."""
    mechanism = ready.mechanism
    higher = any(isinstance(group, Newton) for group in ready.structure.groups)
    return higher or bool(mechanism.gears or mechanism.rolling)


class _Arriving(Smooth):
    """Keeps the angles that are counted with their turns."""

    def __init__(self, continuation: Continuation, parameter: Array) -> None:
        super().__init__(continuation, ARRAYS, parameter, None)
        self.angles: dict[str, float] = {}

    def continued(self, group: int, key: str, angle: Any) -> Any:
        with_turns = super().continued(group, key, angle)
        self.angles[key] = _one(with_turns)
        return with_turns


def _one(x: Any) -> float:
    return float(np.asarray(x, dtype=np.float64).reshape(-1)[0])


def _brought(ready: Ready, target: Mapping[str, float]) -> Assembled:
    """The position after moving all drives from their initial values to others."""
    old = ready.kinematics.path
    start = initial_values(ready)
    ways = {name: target[name] - value for name, value in start.items()}
    driven = tuple(
        DrivenBy(one.drive, Uniform(ways[one.drive.id]), start[one.drive.id]) for one in old.driven
    )
    fastest = max(abs(ways[one.drive.id]) / unit_of(one.drive, old.scale) for one in driven)
    pace = Pace.of(lambda times: np.full(len(times), fastest))
    path = Path(driven, old.parameter.in_time(), 0.0, 1.0, pace.unit_at(0.0), old.scale, pace)
    kinematics = replace(ready.kinematics, path=path)
    smooth = ready.mechanism.assembly.continuation == "smooth"
    first = ready.assembled
    branches = branches_at_start(path, first.signs, first.angles, smooth)
    continuation = Continuation(kinematics, branches, first.positions, kinematics.numbers)
    Scan(continuation, mesh_of(path, np.ones(1))).run()
    if branches.reach(0)[1] < 1.0:
        raise InputError(
            "hold",
            _("on the straight way there from the initial position the mechanism locks"),
            _("hold values nearer to the initial ones, or let the description begin elsewhere"),
        )
    arriving = _Arriving(continuation, np.ones((1, 1)))
    positions = kinematics.positions(ARRAYS, np.ones((1, 1)), arriving).mapped(_one)
    signs = {group: float(branches.sign(group, np.ones(1))[0, 0]) for group in branches.signs}
    angles = {**first.angles, **positions.angles, **arriving.angles}
    return replace(first, signs=signs, positions=positions, angles=angles)


def check_closed(continuation: Continuation) -> None:
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
