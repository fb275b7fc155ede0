"""A plan run over bent numbers: bounds of second derivatives over cells, through interpolated stretches as well."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.arrays import ARRAYS
from centrode.algebra.bends import BendFunctions, Bent, Cells
from centrode.algebra.jets import Jet
from centrode.kinematics.continuation import Continuation, Rough
from centrode.kinematics.evaluate import Kinematics
from centrode.kinematics.mending import NODES, WEIGHTS, inside, numbers_of, set_numbers
from centrode.kinematics.paths import JETS, Path
from centrode.structure.groups import Newton, links_of, points_of
from centrode.structure.positions import Positions

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

BENDS = BendFunctions(ARRAYS)


LOOKS = 3 * len(NODES)
LOOKED = 2.0 * np.cos((np.arange(LOOKS) + 0.5) * np.pi / LOOKS)
"""Chebyshev points of the stretch between the outermost nodes of a window, in its half widths."""
BASIS = WEIGHTS / (LOOKED[:, None] - NODES)
BASIS /= BASIS.sum(axis=1, keepdims=True)
BETWEEN = 1.0 / np.cos(0.5 * np.pi * (len(NODES) - 1) / LOOKS)
"""How many times its greatest value at these a polynomial may reach elsewhere (Ehlich and Zeller, 1964)."""
ROOM = 2.0
"""What is known of a law at three places of a cell is taken this many times for the cell: laws are not bounded."""


def half_widths(mesh: Array) -> Array | float:
    """Half widths of the cells about the nodes of a mesh, which together cover it."""
    gaps = np.diff(mesh)
    widest = float(np.max(gaps))
    if np.min(gaps) >= 0.99 * widest:
        return 0.5 * widest
    return 0.5 * np.maximum(np.append(gaps, 0.0), np.append(0.0, gaps))


def bent_drives(path: Path, at: Array, half: Array | float) -> dict[str, Number]:
    """Values of all drives over cells about parameters; of laws of time the second derivative is looked at."""
    if not path.by_time:
        return path.drive_values(BENDS, BENDS.variable(at, half))
    cells = Cells(half, ARRAYS)
    looks = [Path.drive_values(path, JETS, Jet.variable(at + shift * half, 2)) for shift in (0.0, -1.0, 1.0)]
    found: dict[str, Number] = {}
    for drive, here in looks[0].items():
        if not isinstance(here, Jet):
            found[drive] = here
            continue
        value, slope = here.coefficients[:2]
        seconds = [look[drive].derivative(2) for look in looks]
        if all(np.ndim(x) == 0 and x == 0.0 for x in seconds):
            found[drive] = Bent(value, slope, 0.0, cells)
        else:
            found[drive] = Bent(
                value, slope, ROOM * np.max(np.abs(np.broadcast_arrays(*seconds)), axis=0), cells
            )
    return found


def bent_frame(kinematics: Kinematics, at: Array, half: Array | float) -> Positions:
    """What is known before the first group of the plan, over cells about parameters."""
    return Positions.of_frame(kinematics.numbers, bent_drives(kinematics.path, at, half), BENDS)


class Bending(Rough):
    """Signs and interpolated stretches as the branches have them, over bent numbers."""

    def __init__(self, continuation: Continuation, parameter: Array, lanes: Lanes | None) -> None:
        super().__init__(continuation, BENDS, parameter, lanes)

    def higher(self, group: int, m: Namespace, at: Positions) -> None:
        """What a group of higher class gives are jets: nothing is known of their second derivatives."""
        known = at.mapped(lambda x: Jet(x.coefficients) if isinstance(x, Bent) else x)
        super().higher(group, JETS, known)
        which = self.continuation.kinematics.structure.groups[group]
        assert isinstance(which, Newton)
        at.points.update({name: known.points[name] for name in points_of(which)})
        at.poses.update({name: known.poses[name] for name in links_of(which)})
        at.angles.update({name: known.angles[name] for name in links_of(which) if name in known.angles})

    def after(self, group: int, at: Positions) -> None:
        windows = self.continuation.windows_of(group)
        if windows is None:
            return
        kinematics = self.continuation.kinematics
        before = numbers_of(kinematics, group, at)
        super().after(group, at)
        index, chosen = inside(windows, self.parameter.reshape(-1), self.lanes)
        if not len(chosen):
            return
        known = self.continuation._at_nodes(group, bounded=False)
        shape = (
            (self.continuation.branches.lanes, self.parameter.shape[-1])
            if self.lanes is None
            else self.parameter.shape
        )
        numbers = []
        for old, new, nodes in zip(before, numbers_of(kinematics, group, at), known, strict=True):
            if isinstance(old, Bent) and isinstance(new, Jet):
                bend = np.array(np.broadcast_to(old.bend, shape), dtype=np.float64)
                half = np.broadcast_to(old.cells.half, shape)[index]
                bend[index] = np.where(
                    half <= windows.half[chosen],
                    _bends(nodes, len(windows), bend[index], chosen),
                    bend[index],
                )
                new = Bent(*new.coefficients, bend, old.cells)
            numbers.append(new)
        set_numbers(kinematics, group, at, numbers)


def _bends(nodes: Number, windows: int, closed: Array, chosen: Lanes) -> Array:
    """Bends inside windows, from second derivatives at their nodes; those of closed forms where there are none."""
    if not isinstance(nodes, Jet):
        return np.zeros(len(chosen))
    second = np.broadcast_to(nodes.derivative(2), (windows * len(NODES),)).reshape(windows, len(NODES))
    found = BETWEEN * np.max(np.abs(second @ BASIS.T), axis=1)[chosen]
    return np.where(np.isfinite(found), found, closed)
