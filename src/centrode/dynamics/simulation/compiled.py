"""The fixed-step scheme as one scan over expressions: machine code where llvmlite is there.

Positions are those of the closed forms, traced at each of the four stages: nothing is represented, so nothing is
approximated but by the scheme. That needs a mechanism without events, as sweeps do (`kinematics.compiled`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import tau
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.executors import runner
from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.graphs import Graph
from centrode.algebra.scans import Scan
from centrode.dynamics.batches import state_of_nodes
from centrode.dynamics.burden import Burden
from centrode.dynamics.inertia import share
from centrode.dynamics.simulation.course import STATES, VALUE, Course, Ending
from centrode.dynamics.simulation.driving import Driving
from centrode.dynamics.simulation.field import Field, too_far
from centrode.dynamics.simulation.fixed import course_of, next_state
from centrode.dynamics.simulation.rows import Rows
from centrode.dynamics.simulation.sorts import SORTS, sorted_efforts
from centrode.dynamics.states import Moving
from centrode.kinematics.compiled.deciding import Untraceable
from centrode.kinematics.compiled.traced import traced
from centrode.kinematics.compiled.turns import centre_of, winding_of
from centrode.kinematics.compiled.variables import PARAMETER, RATE, TIME, varied_of
from centrode.kinematics.spans import Span
from centrode.locale import mark
from centrode.model.simulations import MOST_TURNS

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any

NAMES = ("value", "speed", "of drive", "of friction", "of others")
"""States of the scan, in the order of a course."""
BEGINNING, STEP = "beginning", "step"
"""Time at the beginning of a step [s], its length [s]."""


@dataclass(frozen=True)
class Compiled:
    """A simulation as a scan.

    Attributes
    ----------
    scan : one step of the scheme; parameters: its length; inputs: times at which steps begin
    executor : "machine code" or "arrays"
    """

    scan: Scan
    executor: str

    def states(self, value: float, rate: float, duration: float, steps: int) -> Array:
        """States (STATES, steps + 1) at the ends of all steps."""
        step = duration / steps
        times = step * np.arange(steps, dtype=np.float64)
        start = np.array([value, rate, *[0.0] * (STATES - 2)])
        known = {BEGINNING: times}
        inputs = np.stack([known[name] for name in self.scan.inputs]) if self.scan.inputs else None
        run = runner(self.scan, self.executor)
        outputs = run([[step]], inputs, start[:, None], steps=None if self.scan.inputs else steps).outputs
        return np.concatenate([start[:, None], outputs[:, :, 0]], axis=1)

    def course(self, field: Field, value: float, rate: float, duration: float, steps: int) -> Course:
        """The course of so many steps, up to where the motion ends."""
        states = self.states(value, rate, duration, steps)
        far = np.flatnonzero(np.abs(states[VALUE] - value) > MOST_TURNS * field.tracks.length)
        if len(far):
            raise too_far(duration / steps * int(far[0]))
        lost = ~np.isfinite(states).all(axis=0)
        ended: Ending = "duration"
        if lost.any():
            done = int(np.argmax(lost)) - 1
            step = duration / steps
            next_state(field, done * step, states[:, done], step)  # says which formula has no value
            states, ended = states[:, : done + 1], "limit"
        course = course_of(field, states, duration / steps, ended, 4 * steps)
        course.executor = self.executor
        return course


def compiled(rows: Rows, driving: Driving, executor: str) -> Compiled:
    """The scan of a mechanism; raises Untraceable, with a reason, where its motion cannot be said by expressions."""
    _refuse_events(rows)
    rates = _rates(rows, driving)
    step = variable(STEP)
    begun = {name: variable(name) for name in NAMES}

    def at_stage(before: Mapping[str, Operand] | None, share: float) -> dict[str, Node]:
        moved = begun if before is None else {k: begun[k] + share * step * before[k] for k in NAMES}
        time = variable(BEGINNING) + share * step
        places: dict[str, Operand] = {PARAMETER: moved["value"], RATE: moved["speed"], TIME: time}
        return dict(rates.substituted(places).outputs)

    k1 = at_stage(None, 0.0)
    k2 = at_stage(k1, 0.5)
    k3 = at_stage(k2, 0.5)
    k4 = at_stage(k3, 1.0)
    after = {
        name: as_node(begun[name] + step / 6.0 * (k1[name] + 2.0 * k2[name] + 2.0 * k3[name] + k4[name]))
        for name in NAMES
    }
    used = Graph(after).variables
    return Compiled(Scan((STEP,), tuple(x for x in (BEGINNING,) if x in used), after, after), executor)


def _rates(rows: Rows, driving: Driving) -> Graph:
    """Derivatives of the states as expressions of time, value and rate."""
    reducer = rows.reducer
    # two samples whose times and rates differ: then these are variables
    span = Span(np.array([0.0, 1.0]), np.array([0.0, 1.0]), np.array([1.0, 2.0]), np.zeros(2))
    found = traced(reducer.ready, span, varied_of(reducer.ready.kinematics.numbers, {}))
    if found.steps:
        raise Untraceable(mark("groups of higher class"))
    time, value, rate = (variable(name) for name in (TIME, PARAMETER, RATE))
    mechanism = reducer.ready.mechanism
    burden = Burden.of(mechanism, None, EXPRESSIONS)
    state = state_of_nodes(found.solved, burden, Moving(time, value, rate))  # type: ignore[arg-type]
    inertia: Number = rows.added
    slope: Number = 0.0
    for mass in burden.masses:
        inertia, slope = (a + b for a, b in zip((inertia, slope), share(state, mass), strict=True))
    moments: dict[str, Number] = dict.fromkeys(SORTS, 0.0)
    for one in sorted_efforts(mechanism, burden.loads):
        along = one.effort.along(state)
        moments[one.sort] = moments[one.sort] + one.effort.strength(state) * along
    driven = driving.over(EXPRESSIONS, time, value, rate)
    total = moments["stored"] + moments["friction"] + moments["other"] + driven
    powers = {"of drive": driven, "of friction": moments["friction"], "of others": moments["other"]}
    outputs: dict[str, Number] = {
        "value": rate,
        "speed": (total - 0.5 * slope * rate * rate) / inertia,
        **{name: moment * rate for name, moment in powers.items()},
    }
    graph = Graph.of(outputs)
    return graph.substituted(_turns(rows, graph))


def _refuse_events(rows: Rows) -> None:
    """Limits and change points are not followed by expressions."""
    reducer = rows.reducer
    path = reducer.ready.kinematics.path
    if path.driven[0].drive.kind != "angle":
        raise Untraceable(mark("a drive that does not turn"))
    if reducer.events(path.initial - tau, path.initial + tau):
        raise Untraceable(mark("limits or change points within a turn"))


def _turns(rows: Rows, graph: Graph) -> dict[str, float]:
    """Centres and windings of the links whose angles matter: from a turn of the drive."""
    reducer = rows.reducer
    path = reducer.ready.kinematics.path
    values = path.initial + np.linspace(0.0, tau, 721)
    found: dict[str, float] = {}
    drive = path.driven[0].drive.id
    for link in reducer.ready.mechanism.link_names:
        names = centre_of(link), winding_of(link, drive)
        if not set(names) & set(graph.variables):
            continue
        angle = np.asarray(rows.state(values)[0].angle(link).value).reshape(-1)
        winding = round(float(angle[-1] - angle[0]) / tau)
        rest = angle - winding * values
        if np.ptp(rest) >= tau / 2:
            raise Untraceable(mark("links that swing by half a turn or more"))
        found |= {names[0]: 0.5 * float(np.min(rest) + np.max(rest)), names[1]: float(winding)}
    return found
