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
from centrode.kinematics.mending import Windows, inside, numbers_of, set_numbers
from centrode.kinematics.paths import JETS, Path
from centrode.structure.constraints import Positions
from centrode.structure.groups import Newton, links_of, points_of

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Number: TypeAlias = Any
Namespace: TypeAlias = Any

BENDS = BendFunctions(ARRAYS)


INSIDE = 0.95
"""Share of a circle's radius up to which the terms of a series bound its second derivative."""
ROOM = 2.0
"""What is known of a law at three places of a cell is taken this many times for the cell: laws are not bounded."""


def half_widths(mesh: Array) -> Array | float:
    """Half widths of the cells about the nodes of a mesh, which together cover it."""
    gaps = np.diff(mesh)
    widest = float(np.max(gaps))
    if np.min(gaps) >= 0.99 * widest:
        return 0.5 * widest
    return np.asarray(0.5 * np.maximum(np.append(gaps, 0.0), np.append(0.0, gaps)))


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
        continuation = self.continuation
        windows = continuation.windows_of(group)
        if windows is None:
            return
        before = numbers_of(continuation.kinematics, group, at)
        super().after(group, at)
        index, chosen = inside(windows, self.parameter.reshape(-1), self.lanes)
        if not len(chosen):
            return
        shape = self.parameter.shape
        if self.lanes is None:
            shape = continuation.branches.lanes, shape[-1]
        along = self.parameter.reshape(-1)[index[-1]]
        numbers = []
        for old, new, series in zip(
            before,
            numbers_of(continuation.kinematics, group, at),
            continuation.series_of(group).numbers,
            strict=True,
        ):
            if isinstance(old, Bent) and isinstance(new, Jet):
                half = np.broadcast_to(old.cells.half, shape)[index]
                bend = np.array(np.broadcast_to(old.bend, shape), dtype=np.float64)
                bend[index] = _bends(series, windows.of(chosen), chosen, along, half, bend[index])
                new = Bent(new.coefficients[0], new.coefficients[1], bend, old.cells)
            numbers.append(new)
        set_numbers(continuation.kinematics, group, at, numbers)


def _bends(series: Array, windows: Windows, chosen: Lanes, along: Array, half: Array, closed: Array) -> Array:
    """Bends over cells about places in windows, by the terms of the series; those of closed forms beyond it."""
    share = (np.abs(along - windows.centre) + half) / windows.radius
    found = np.zeros(len(chosen))
    for k in range(series.shape[1] - 1, 1, -1):
        found = found * share + k * (k - 1.0) * np.abs(series[chosen, k])
    return np.where(share <= INSIDE, found / windows.radius**2, closed)
