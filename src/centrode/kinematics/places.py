"""Positions anywhere on a path whose events have been looked for once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.branches import branches_at_start
from centrode.kinematics.continuation import Continuation
from centrode.kinematics.evaluate import Kinematics
from centrode.kinematics.events import Scan
from centrode.kinematics.layout import Layout, layout_of, positions_from
from centrode.kinematics.mesh import mesh_of
from centrode.kinematics.quick_turns import QuickTurns
from centrode.kinematics.ready import Ready
from centrode.kinematics.residuals import Kept, open_what_does_not_close, residuals
from centrode.kinematics.sampling import ORDERS, Samples, sample, settle
from centrode.kinematics.unwound import Course, fill_angles, fill_slides
from centrode.structure.constraints import Positions

Array: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Filled:
    """What is found at samples besides their columns: positions as plain arrays, residuals, the worst constraint."""

    at: Positions
    residual: Array
    worst_constraint: Kept


@dataclass(frozen=True)
class Places:
    """A plan with everything that happens along a stretch of its path.

    Attributes
    ----------
    continuation : the plan with its events
    course : angles and displacements that run on over turns
    """

    continuation: Continuation
    course: Course

    @classmethod
    def along(cls, ready: Ready, kinematics: Kinematics, parameter: Array, lanes: int = 1) -> Places:
        """Search the path between the initial position and all values of the parameter."""
        continuation = start_of(ready, kinematics, lanes)
        mesh = mesh_of(kinematics.path, parameter)
        on_mesh = Scan(continuation, mesh).run()
        quick = QuickTurns(continuation, mesh, len(kinematics.structure.groups))
        return cls(continuation, Course(ready, kinematics.numbers, on_mesh, mesh, quick))

    @property
    def mesh(self) -> Array:
        """The nodes on which events were looked for."""
        return self.course.mesh

    def fill(self, parameter: Array, samples: Samples) -> Filled:
        """Fill in columns, angles and statuses at values of the parameter on the stretch."""
        kinematics = self.continuation.kinematics
        sample(self.continuation, parameter, samples)
        settle(samples)
        fill_angles(self.course, samples, parameter)
        at = positions_from(kinematics, samples.layout, samples.columns[0], samples.angles[0], parameter)
        residual, worst = residuals(kinematics, samples, at)
        open_what_does_not_close(samples, residual)
        fill_slides(self.course, samples, parameter)
        return Filled(at, residual, worst)

    def at(self, parameter: Array) -> Samples:
        """Columns, angles and statuses at values of the parameter on the stretch."""
        layout = layout_of(self.continuation.kinematics)
        samples = blank(layout, self.continuation.branches.lanes, len(parameter))
        self.fill(parameter, samples)
        return samples


def blank(layout: Layout, lanes: int, count: int) -> Samples:
    """Room for samples."""
    columns = np.empty((ORDERS, layout.width, lanes, count))
    angles = np.empty((ORDERS, len(layout.angles), lanes, count))
    return Samples(layout, columns, angles, np.zeros((lanes, count), dtype=np.int8))


def start_of(ready: Ready, kinematics: Kinematics, lanes: int = 1) -> Continuation:
    """A plan with the signs of the initial position, before any event is known."""
    smooth = ready.mechanism.assembly.continuation == "smooth"
    start = ready.assembled
    branches = branches_at_start(kinematics.path, start.signs, start.angles, smooth, lanes)
    return Continuation(kinematics, branches, start.positions, ready.kinematics.numbers)
