"""The integrator of forward dynamics: DOP853 over any algebra, one attempt after the other.

E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., 1993, section II.10: twelve
stages of order 8, the error from embedded formulas of orders 5 and 3. After a step is taken its coordinates and speeds are
closed by one projection. Cosine and sine of angles are followed through the stages like states and computed anew at the
start of each step, so that a stage has no functions of angles.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from scipy.integrate import DOP853

from centrode.dynamics.forward_dynamics.elimination import is_zero
from centrode.dynamics.forward_dynamics.equations_of_motion import EquationsOfMotion, Flags
from centrode.dynamics.forward_dynamics.spanning_tree import Values
from centrode.numerics.expressions import EXPRESSIONS, as_node, variable
from centrode.numerics.scans import Scan

Number: TypeAlias = Any
Namespace: TypeAlias = Any

STAGES = 12
A: tuple[tuple[float, ...], ...] = tuple(tuple(map(float, DOP853.A[i, :i])) for i in range(STAGES))
B: tuple[float, ...] = tuple(map(float, DOP853.B))
C: tuple[float, ...] = tuple(map(float, DOP853.C[:STAGES]))
FIFTH: tuple[float, ...] = tuple(map(float, DOP853.E5[:STAGES]))
THIRD: tuple[float, ...] = tuple(map(float, DOP853.E3[:STAGES]))
SAFETY, LEAST, MOST = 0.9, 0.2, 6.0
"""Of the factor by which a step's size changes: Hairer's."""
RETREAT = 0.25
"""Factor of a step at which something has no value."""

END, TOLERANCE, RATE, LENGTH = "end", "tolerance", "rate", "length"
CONTROLS = (END, TOLERANCE, RATE, LENGTH)
"""Parameters of a lane: the time it ends at, the error of a step, and what speeds and lengths are compared with."""
TIME, STEP = "time", "step"


def weighted_sum(weights: Sequence[float], numbers: Sequence[Number]) -> Number:
    """The sum of numbers times weights; weights of zero and plain zeros cost nothing."""
    total: Number = 0.0
    for weight, number in zip(weights, numbers, strict=False):
        if weight and not is_zero(number):
            term = weight * number
            total = term if is_zero(total) else total + term
    return total


def advanced(start: Number, step: Number, rate: Number) -> Number:
    """Start + step rate, nothing where the rate is the plain zero."""
    return start if is_zero(rate) else start + step * rate


@dataclass(frozen=True)
class MotionNames:
    """Names of what is carried from step to step: coordinates, speeds, works."""

    coordinates: tuple[str, ...]
    speeds: tuple[str, ...]
    works: tuple[str, ...]

    @classmethod
    def of(cls, equations: EquationsOfMotion) -> MotionNames:
        """Names by numbers."""
        size, works = equations.size, len(equations.loads) + len(equations.kept)
        return cls(
            tuple(f"coordinate {k}" for k in range(size)),
            tuple(f"speed {k}" for k in range(size)),
            tuple(f"work {k}" for k in range(works)),
        )

    @property
    def all(self) -> tuple[str, ...]:
        """All of them in order."""
        return (*self.coordinates, *self.speeds, *self.works)


@dataclass(frozen=True)
class StageRates:
    """Derivatives by time in one stage."""

    speeds: Sequence[Number]
    rotors: Sequence[Number]
    accelerations: Sequence[Number]
    powers: Sequence[Number]
    flags: Flags


def rates_of(
    m: Namespace,
    equations: EquationsOfMotion,
    values: Values,
    speeds: Sequence[Number],
    time: Number,
    flags: Flags | None,
) -> StageRates:
    """Derivatives of everything that is followed."""
    terms = equations.terms(m, values, speeds, time)
    accelerations, forces, chosen = equations.accelerations(m, terms, flags)
    rotors = []
    for k in equations.tree.angles:
        cosine, sine = values.rotors[k]
        rotors += [-(speeds[k] * sine), speeds[k] * cosine]
    kept = forces[len(forces) - len(equations.kept) :] if equations.kept else []
    # the constraint of a drive is its value less the law: the force that moves it is that on the law's side
    powers = [*terms.powers, *(-(force * rate) for force, rate in zip(kept, terms.rates, strict=True))]
    return StageRates(speeds, rotors, accelerations, powers, chosen)


def attempt(
    m: Namespace,
    equations: EquationsOfMotion,
    time: Number,
    step: Number,
    coordinates: Sequence[Number],
    speeds: Sequence[Number],
    works: Sequence[Number],
    rate: Number,
    length: Number,
) -> tuple[list[Number], list[Number], list[Number], Number]:
    """Coordinates, speeds and works a step further, closed, and the error of the step over the tolerance 1."""
    tree, size = equations.tree, equations.size
    start = tree.values(m, coordinates)
    turned = [x for k in tree.angles for x in start.rotors[k]]
    stages: list[StageRates] = []
    flags: Flags | None = None
    for row, share in zip(A, C, strict=True):
        q = _advance_all(coordinates, step, row, [s.speeds for s in stages])
        r = _advance_all(turned, step, row, [s.rotors for s in stages])
        w = _advance_all(speeds, step, row, [s.accelerations for s in stages])
        values = Values(q, {k: (r[2 * i], r[2 * i + 1]) for i, k in enumerate(tree.angles)})
        stage = rates_of(m, equations, values, w, advanced(time, step, share), flags)
        # which dependent equations count is decided where the step begins: its positions are closed
        flags = stage.flags if equations.dependent else flags
        stages.append(stage)
    q = _advance_all(coordinates, step, B, [s.speeds for s in stages])
    w = _advance_all(speeds, step, B, [s.accelerations for s in stages])
    done = _advance_all(works, step, B, [s.powers for s in stages])
    error = _error(m, equations, step, stages, (speeds, w), rate, length)
    if equations.equations:
        values = tree.values(m, q)
        terms = equations.terms(m, values, w, time + step)
        q, w = equations.projected(m, q, w, terms, flags if equations.dependent else None)
    assert len(q) == size
    return q, w, done, error


def _advance_all(
    start: Sequence[Number], step: Number, weights: Sequence[float], rates: Sequence[Sequence[Number]]
) -> list[Number]:
    return [
        advanced(x, step, weighted_sum(weights, [stage[k] for stage in rates])) for k, x in enumerate(start)
    ]


def _error(
    m: Namespace,
    equations: EquationsOfMotion,
    step: Number,
    stages: Sequence[StageRates],
    speeds: tuple[Sequence[Number], Sequence[Number]],
    rate: Number,
    length: Number,
) -> Number:
    """Hairer's estimate: of angles in rad and displacements over the length, of speeds over what they reach."""
    fifth: Number = 0.0
    third: Number = 0.0
    for k, coordinate in enumerate(equations.tree.coordinates):
        unit = 1.0 if coordinate.kind == "angle" else length
        reach = unit * rate + m.max(m.abs(speeds[0][k]), m.abs(speeds[1][k]))
        for numbers, scale in (
            ([s.speeds[k] for s in stages], unit),
            ([s.accelerations[k] for s in stages], reach),
        ):
            inverse = None if isinstance(scale, float) else 1.0 / scale
            parts = [weighted_sum(weights, numbers) for weights in (FIFTH, THIRD)]
            one, other = (x if inverse is None else x * inverse for x in parts)
            fifth, third = fifth + one * one, third + other * other
    together = fifth + 0.01 * third
    size = m.abs(step) * fifth / m.sqrt(together * float(2 * equations.size))
    # nothing erred, or something has no value
    return m.where(m.less(0.0, together), size, together)


def next_step(m: Namespace, step: Number, error: Number) -> Number:
    """The size of the next step after one whose error over the tolerance is this."""
    root = m.sqrt(m.sqrt(m.sqrt(m.max(error, 1e-9))))
    factor = m.min(m.max(SAFETY / root, LEAST), MOST)
    return m.where(m.is_number(error), step * factor, step * RETREAT)


def attempt_scan(equations: EquationsOfMotion, parameters: Sequence[str], written: bool) -> Scan:
    """One attempt a step: a step that errs more than the tolerance leaves everything where it is, but its size.

    `written` outputs everything after each attempt.
    """
    m, names = EXPRESSIONS, MotionNames.of(equations)
    time, size = variable(TIME), variable(STEP)
    step = m.min(size, variable(END) - time)
    before = [variable(name) for name in names.all]
    count = equations.size
    q, w, works, error = attempt(
        m, equations, time, step, before[:count], before[count : 2 * count], before[2 * count :],
        variable(RATE), variable(LENGTH),
    )  # fmt: skip
    error = error / variable(TOLERANCE)
    taken = m.both(m.less_equal(error, 1.0), m.less(0.0, step))
    proposed = next_step(m, step, error)
    # a step that is cut at the end says nothing against the size before it
    further = m.where(
        m.less(step, size), m.where(taken, m.max(size, proposed), m.min(size, proposed)), proposed
    )
    further = m.where(m.less(0.0, step), further, size)
    state = {TIME: m.where(taken, time + step, time), STEP: further}
    for name, old, new in zip(names.all, before, [*q, *w, *works], strict=True):
        state[name] = m.where(taken, new, old)
    nodes = {name: as_node(x) for name, x in state.items()}
    outputs = {name: nodes[name] for name in (TIME, *names.all)} if written else {}
    return Scan((*CONTROLS, *parameters), (), outputs, nodes)
