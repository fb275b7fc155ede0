"""The motion of one description at one grid of samples by machine code, to the bits of `solve`.

Tracing and compiling take as long as some twenty motions by the arrays, so this pays for a description that is
requested again and again. What is not rounded alike everywhere, the arc tangent, stays with NumPy.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.errors import Status
from centrode.kinematics.hinge_angles import moving_hinges
from centrode.kinematics.machine_code.event_free_mechanisms import EventScreening, ScreenedEvents
from centrode.kinematics.machine_code.outputs import RESIDUAL, SINES, Writer, nodes_of, solved_of
from centrode.kinematics.machine_code.trace import Traced, Untraceable, trace_motion
from centrode.kinematics.machine_code.variables import (
    SCALE,
    TURN,
    centre_of,
    inputs_of,
    varied_of,
    whole_turns,
    winding_of,
)
from centrode.kinematics.path import SampleGrid
from centrode.kinematics.plan_evaluation import Branches, branches_at_start
from centrode.kinematics.preparation import Ready
from centrode.kinematics.samples import CLOSED, Kept, each_residual
from centrode.kinematics.solve import Solved, check_size, fit_for
from centrode.numerics import machine_code
from centrode.numerics.executors import MACHINE_CODE
from centrode.numerics.expressions import EXPRESSIONS, as_node
from centrode.numerics.graphs import Graph
from centrode.numerics.scans import LaneExtreme, evaluate
from centrode.structure.dimensions import Dimensions

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any
SLACK = "slack"


@dataclass(frozen=True)
class MotionKernels:
    """Kernels that judge and write the motion of one mechanism.

    Attributes
    ----------
    ready : the mechanism, fit for the samples
    constraints : name of an extreme -> constraint whose greatest residual it is, and whether that has no unit
    values : name -> (1,), the mechanism's numbers that stand as variables
    """

    ready: Ready
    span: SampleGrid
    plan: Traced
    judging: EventScreening
    writer: Writer
    constraints: Mapping[str, tuple[Kept, bool]]
    values: Mapping[str, Array]

    @classmethod
    def of(cls, ready: Ready, span: SampleGrid) -> MotionKernels | None:
        """The kernels; None of what only the arrays compute, or what kernels would round otherwise."""
        # angles at hinges take their turns from the search of the arrays
        if not machine_code.PRESENT or (ready.mechanism.space == "sphere" and moving_hinges(ready.mechanism)):
            return None
        ready = fit_for(ready, span)
        numbers = _with_one_variable(ready.kinematics.numbers)
        varied = varied_of(numbers, {})
        values = varied.values(numbers)
        if not values:
            return None
        try:
            plan = trace_motion(ready, span, varied)
        except Untraceable:
            return None
        check_size(plan.solved.layout, 1, len(span.parameter))
        names = tuple(dict.fromkeys([*varied.names, SCALE]))
        judging = EventScreening(plan, span.parameter, names, tuple(plan.turning), MACHINE_CODE)
        judged, constraints = _extremes(plan, judging)
        writer = Writer(
            nodes_of(plan), inputs_of(ready.kinematics.path, span), MACHINE_CODE, sparing=True, judged=judged
        )
        # an arc tangent in a residual would move its last bit, and with it the constraint that is kept worst
        of_residuals = Writer({"all": plan.solved.residual}, writer.places, MACHINE_CODE)
        if plan.steps or not (writer.alike and of_residuals.alike):
            return None
        return cls(ready, span, plan, judging, writer, constraints, values)

    def solve(self) -> Solved | None:
        """The motion; None where it has events, which the arrays look for."""
        found = self.judging.judge(self.values)
        if not found.clear[0]:
            return None
        room = self.writer.room(1)
        judged = self.writer.write(dict(self.values) | dict(found.values), room)
        # a kernel may round a residual otherwise: half of the bound is kept free
        if not judged[RESIDUAL][0] <= 0.5 * CLOSED or (SLACK in judged and not judged[SLACK][0] > 0.0):
            return None
        arrays = self.writer.views(room)
        if SINES in arrays:
            self._fill_angles(arrays["angles"], arrays[SINES], found)
        status = np.full(arrays[RESIDUAL].shape, Status.OK, dtype=np.int8)
        solved = solved_of(
            self.plan.solved, arrays, status, ready=self.ready, span=self.span, branches=self._branches()
        )
        return replace(solved, worst_constraint=self._worst(judged))

    def _fill_angles(self, angles: Array, sines: Array, found: ScreenedEvents) -> None:
        """Angles with their turns where their cosines stand."""
        layout = self.plan.solved.layout
        for k, link in enumerate(self.plan.turning):
            angle = angles[0, :, :, layout.angles.index(link)]
            np.arctan2(sines[:, :, k], angle, out=angle)
            middle: Number = found.values[centre_of(link)][:, None]
            for drive, value in self._drives.items():
                middle = middle + found.values[winding_of(link, drive)][:, None] * value
            angle += TURN * whole_turns(middle, angle)

    @cached_property
    def _drives(self) -> Mapping[str, Number]:
        return evaluate(Graph.of(self.plan.winders), self.writer.places)

    def _branches(self) -> Branches:
        start = self.ready.assembled
        smooth = self.ready.mechanism.assembly.continuation == "smooth"
        return branches_at_start(self.ready.kinematics.path, start.signs, start.angles, smooth)

    def _worst(self, judged: Mapping[str, Array]) -> Kept:
        """The constraint that is kept worst, the first of equal ones."""
        scale = float(self.ready.kinematics.numbers.scale)
        sizes = {
            name: judged[name][0] / (1.0 if angular else scale)
            for name, (_one, angular) in self.constraints.items()
        }
        return self.constraints[max(sizes, key=sizes.__getitem__)][0]


def _with_one_variable(numbers: Dimensions) -> Dimensions:
    """Dimensions of which one number is an array of one: plans are judged for lanes of mechanisms."""
    left = itertools.count()

    def lift(x: Number) -> Number:
        # plain zeros and ones cost nothing where they are known
        plain = not isinstance(x, float) or x in (0.0, 1.0, -1.0)
        return x if plain or next(left) else np.array([x])

    return numbers.map_numbers(lift)


def _extremes(
    plan: Traced, judging: EventScreening
) -> tuple[dict[str, LaneExtreme], dict[str, tuple[Kept, bool]]]:
    """Extremes over the samples: greatest residual, least slack of radicands, greatest residual of each constraint."""
    found = {RESIDUAL: LaneExtreme("maximum", as_node(plan.solved.residual[0, 0]), 0.0)}
    if judging.slack_at_samples is not None:
        found[SLACK] = LaneExtreme("minimum", judging.slack_at_samples, np.inf)
    kept: dict[str, tuple[Kept, bool]] = {}
    for one, size, angular in each_residual(plan.solved.ready.kinematics, EXPRESSIONS, plan.at):
        name = f"residual {len(kept)}"
        kept[name] = one, angular
        found[name] = LaneExtreme("maximum", as_node(size), 0.0)
    return found, kept
