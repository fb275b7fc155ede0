"""The search for events on a mesh that machine code has filled: what is found, and its bits, are those of `events`.

All radicands are computed at once with constant signs. Where a group has change points, those of the groups
behind it are computed again with its signs, and at the nodes next to its change points, which power
series give, by the arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.bends import Bent, Cells
from centrode.algebra.jets import Jet
from centrode.kinematics.angles import NodeTurns, node_turns
from centrode.kinematics.compiled.events.signs import MOST, counts_of, values_of
from centrode.kinematics.compiled.traced import Traced
from centrode.kinematics.compiled.variables import boxed
from centrode.kinematics.compiled.writing import Writer
from centrode.kinematics.continuation import Continuation
from centrode.kinematics.events import Scan
from centrode.kinematics.layout import rotor_of_angle
from centrode.kinematics.mending import inside
from centrode.kinematics.quick_turns import QuickTurns
from centrode.structure.constraints import Positions
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Nodes: TypeAlias = npt.NDArray[Any]
Writers: TypeAlias = Callable[[Mapping[int, int]], tuple[Traced, Writer]]
"""From how many change points the signs of groups know: the plan, and what writes the mesh."""


def of_mesh(plan: Traced) -> dict[str, Nodes]:
    """What is written on the mesh: radicands and divisors with slopes and bends, cosines and sines of angles."""
    found = {f"radicand {group}": _pair(x) for group, x in plan.radicands.items()}
    found |= {f"divisor {group}": _pair(x) for group, x in plan.divisors.items() if isinstance(x, Jet)}
    for (kind, group), bent in plan.bends.items():
        if f"{kind} {group}" in found:
            found[f"bend of {kind} {group}"] = boxed([bent.bend])
    return found | {f"rotor {link}": boxed(rotor) for link, rotor in plan.turning.items()}


def _angle_of(link: str, numbers: Dimensions, at: Positions) -> Any:
    cosine, sine = rotor_of_angle(ARRAYS, numbers, at, link)
    return np.arctan2(sine, cosine)


def _pair(number: Any) -> Nodes:
    return boxed(number.coefficients[:2] if isinstance(number, Jet) else (number, 0.0))


@dataclass
class Search:
    """The search for the events of some mechanisms of a batch.

    Attributes
    ----------
    values : what the variables of the plan stand for: name -> (lanes,)
    """

    continuation: Continuation
    mesh: Array
    values: Mapping[str, Array]
    writers: Writers
    _counts: dict[int, int] = field(default_factory=dict)
    _found: dict[str, Array] = field(default_factory=dict)

    def run(self) -> bool:
        """Record all events in the branches; whether that was possible."""
        scan = Scan(self.continuation, self.mesh)
        self._write()
        plan, _writer = self.writers(self._counts)
        for group in sorted({*plan.radicands, *plan.divisors}):
            for kind, find in (("radicand", scan.find), ("divisor", scan.find_poles)):
                if f"{kind} {group}" in self._found:
                    if not self._up_to_date():
                        return False
                    bend = self._found.get(f"bend of {kind} {group}")
                    find(group, self._with_patches(scan, group, self._found[f"{kind} {group}"], bend))
        return self._up_to_date()

    def turns(self, link: str, initial: float) -> NodeTurns:
        """Turns of a link's angle along the mesh; `initial` [rad] is its value in the initial position."""
        cosine, sine = self._found[f"rotor {link}"]
        if len(self._mended[0]):
            cosine[self._mended], sine[self._mended] = self._rotors_mended[link]
        start = int(np.argmin(np.abs(self.mesh - self.continuation.branches.initial)))
        quick = self._quick.measured(partial(_angle_of, link))
        return node_turns((cosine, sine), initial, start, len(self.mesh), quick)

    @cached_property
    def _quick(self) -> QuickTurns:
        groups = self.continuation.kinematics.structure.groups
        return QuickTurns(self.continuation, self.mesh, len(groups))

    def _write(self) -> None:
        _plan, writer = self.writers(self._counts)
        branches = self.continuation.branches
        room = writer.same_room(branches.lanes)
        writer.write({**self.values, **values_of(branches, self._counts)}, room)
        self._found = writer.streams(room)

    def _up_to_date(self) -> bool:
        """Compute the mesh again if change points were found since; whether signs can know so many."""
        counts = counts_of(self.continuation.branches)
        if max(counts.values(), default=0) > MOST:
            return False
        if counts != self._counts:
            self._counts = counts
            self._write()
        return True

    def _with_patches(self, scan: Scan, group: int, pair: Array, bend: Array | None) -> Jet:
        """Value and slope of a radicand or divisor, those of the arrays where a series gives a group before it."""
        lanes, nodes = self._near_change_points(range(group))
        if bend is None:
            if len(lanes):
                guard = scan.guards.jets(group, lanes, self.mesh[nodes], 1)
                pair[:, lanes, nodes] = guard.value, guard.derivative(1)
            return Jet((pair[0], pair[1]))
        if len(lanes):
            half = np.broadcast_to(scan.zeros.half, self.mesh.shape)[nodes]
            patched = scan.guards.bent(group, lanes, self.mesh[nodes], half)
            pair[:, lanes, nodes], bend[0, lanes, nodes] = patched[:2], patched[2]
        return Bent(pair[0], pair[1], bend[0], Cells(scan.zeros.half, ARRAYS))

    def _near_change_points(self, groups: range) -> tuple[Lanes, Lanes]:
        """Mechanisms and nodes that lie next to change points of some groups, each once."""
        near = np.zeros((self.continuation.branches.lanes, len(self.mesh)), dtype=bool)
        for group in groups:
            windows = self.continuation.windows_of(group)
            if windows is not None:
                near[inside(windows, self.mesh, None)[0]] = True
        lanes, nodes = np.nonzero(near)
        return lanes, nodes

    @cached_property
    def _mended(self) -> tuple[Lanes, Lanes]:
        return self._near_change_points(range(len(self.continuation.kinematics.structure.groups)))

    @cached_property
    def _rotors_mended(self) -> dict[str, tuple[Any, Any]]:
        """Rotors where a series gives any group, as the arrays have them."""
        lanes, nodes = self._mended
        parameter = self.mesh[nodes]
        kinematics = self.continuation.kinematics.taken(lanes)
        with np.errstate(all="ignore"):
            at = kinematics.positions(ARRAYS, parameter, self.continuation.hooks(ARRAYS, parameter, lanes))
            plan, _writer = self.writers(self._counts)
            return {link: rotor_of_angle(ARRAYS, kinematics.numbers, at, link) for link in plan.turning}
