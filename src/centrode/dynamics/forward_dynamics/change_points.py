"""Change points of a free motion, passed on a half circle of complex time.

In a change point the closures lose rank: two motions cross there, and the equations of motion become 0/0. The motion
that goes on smoothly is an analytic function of time, so it is followed around the place, at a distance at which
nothing is lost: from the time before, along a half circle above the real axis, to as long behind. The same numbers
give Taylor's coefficients of everything on the disc (Cauchy's integral), from which instants near the change point
are taken. A singularity inside the circle, as where the closures only come near to losing rank, gives coefficients of
negative powers: then there is nothing to pass, and the motion is integrated straight on.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.numerics.complex_graphs import IMAGINARY, Parts, complex_parts, product
from centrode.numerics.dormand_prince import C
from centrode.numerics.executors import MACHINE_CODE, choose_executor
from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.initial_value_problems import END, SAFETY, SMALLEST, TIME, InitialValueProblem
from centrode.numerics.integrators import integrator_of
from centrode.numerics.python_integrations import PythonIntegration

Array: TypeAlias = npt.NDArray[np.float64]
Complex: TypeAlias = npt.NDArray[np.complex128]

POINTS = 32
"""Steps along the half circle: an arc of 0.1 rad each, which the scheme follows to rounding."""
LONG = 600
"""Operations of the right side beyond which machine code is built for complex numbers too."""
CENTRE, RADIUS = "centre", "radius"
SINGULAR = 1e-8
"""Coefficients of negative powers above this share of what changes tell of a singularity inside the circle."""
UNRESOLVED = 1e-9
"""The last coefficients of positive powers below this share are small enough for the whole disc."""


@dataclass(frozen=True)
class Detour:
    """A piece of motion around a change point.

    Attributes
    ----------
    centre, radius : of the circle in complex time [s]
    coefficients : (followed, powers) of ((t - centre) / radius)
    singular : size of the coefficients of negative powers, over that of what changes
    unresolved : size of the last coefficients, in the same measure
    short : how long before the end of the disc it is left [s]
    """

    centre: float
    radius: float
    coefficients: Array
    singular: float
    unresolved: float
    short: float = 0.0

    @property
    def begin(self) -> float:
        """Time before."""
        return self.centre - self.radius

    @property
    def end(self) -> float:
        """Time behind."""
        return self.centre + self.radius - self.short

    @property
    def is_analytic(self) -> bool:
        """Whether everything is analytic on the disc."""
        return self.singular < SINGULAR and self.unresolved < UNRESOLVED

    def at(self, times: Array) -> Array:
        """What is followed at times within (followed, n)."""
        share = (np.asarray(times) - self.centre) / self.radius
        return np.asarray(np.polynomial.polynomial.polyval(share, self.coefficients.T))


@dataclass(frozen=True)
class HalfCircles:
    """The initial value problem of a motion, taken along half circles of complex time.

    Short problems are followed by functions of Python, long ones by machine code.
    """

    problem: InitialValueProblem
    executor: str = "auto"

    def around(
        self,
        parameters: Array,
        time: float,
        carried: Array,
        ahead: float,
        measured: Sequence[tuple[slice, Array]],
    ) -> Detour:
        """The motion from a time along a half circle to twice `ahead` later, as a detour.

        `measured` are parts of what is followed, one kind each, with what they are compared with.
        """
        if self._is_long and choose_executor(self.executor) == MACHINE_CODE:
            values = self._by_machine_code(parameters, time, carried, ahead)
        else:
            values = self._by_python(parameters, time, carried, ahead)
        if not np.all(np.isfinite(values)):
            return Detour(time + ahead, ahead, np.zeros((len(self.problem.unknowns), 1)), np.inf, np.inf)
        return _detour(time + ahead, ahead, values, measured)

    @property
    def _is_long(self) -> bool:
        return self.problem.of_rates.counts.total() > LONG

    @cached_property
    def _python(self) -> PythonIntegration:
        return PythonIntegration(self.problem, is_complex=True)

    def _by_python(self, parameters: Array, time: float, carried: Array, radius: float) -> Complex:
        count, step = len(self.problem.unknowns), np.pi / POINTS
        given = [float(x) for x in parameters]
        here: list[Any] = [complex(x) for x in carried]
        fixed = here[count:]
        values = np.empty((POINTS + 1, count), dtype=np.complex128)
        values[0] = here[:count]
        for k in range(POINTS):
            turned = [np.exp(-1j * (k + c) * step) for c in C]
            times = [complex(time + radius - radius * x) for x in turned]
            slopes = [complex(1j * radius * x) for x in turned]
            found, _stages = self._python.stages(given, here, times, step, slopes.__getitem__)
            here = [*found, *fixed]
            values[k + 1] = found
        return values

    @cached_property
    def _complex_problem(self) -> InitialValueProblem:
        """The problem over real and imaginary parts, whose time is the angle along the half circle."""
        m, problem = EXPRESSIONS, self.problem
        centre, radius, angle = variable(CENTRE), variable(RADIUS), variable(TIME)
        cosine, sine = m.cos(angle), m.sin(angle)
        # t = c - r exp(-i u), whose derivative by u is i r exp(-i u)
        slope = Parts(radius * sine, radius * cosine)
        parts = complex_parts(problem.of_rates, {*problem.parameters, *problem.fixed_names})
        place = {TIME: as_node(centre - radius * cosine), IMAGINARY + TIME: as_node(radius * sine)}
        plain = {name: as_node(rate.real) for name, rate in parts.items()}
        plain |= {IMAGINARY + name: as_node(rate.imaginary) for name, rate in parts.items()}
        placed = Graph(plain).substitute(place).outputs
        rates: dict[str, Node] = {}
        for name in parts:
            along = product(Parts(placed[name], placed[IMAGINARY + name]), slope)
            rates |= {name: as_node(along.real), IMAGINARY + name: as_node(along.imaginary)}
        parameters = (*problem.parameters, CENTRE, RADIUS)
        # an error of this size leaves steps as they are
        steady = as_node(SAFETY**8)
        return InitialValueProblem(
            parameters, rates, {name: variable(name) for name in problem.fixed_names}, steady
        )

    def _by_machine_code(self, parameters: Array, time: float, carried: Array, radius: float) -> Complex:
        problem, followed = self._complex_problem, self.problem.unknowns
        values = dict(zip(self.problem.carried_names, carried, strict=True))
        given = dict(zip(self.problem.parameters, parameters, strict=True))
        given |= {CENTRE: time + radius, RADIUS: radius, END: np.pi, SMALLEST: 0.0}
        state = np.array(
            [0.0, np.pi / POINTS, 0.0, 0.0, *(values.get(name, 0.0) for name in problem.carried_names)]
        )
        rows = np.full((POINTS + 1, len(problem.carried_names) + 1), np.nan)
        lanes = np.array([given[name] for name in problem.parameters])[:, None]
        found = integrator_of(problem, self.executor, hasty=True).run(lanes, state[:, None], POINTS + 1, rows)
        # the last step is of rounding, if there is one
        steps = rows[: int(found[3, 0])][:POINTS]
        if len(steps) < POINTS:
            return np.full((POINTS + 1, len(followed)), np.nan, dtype=np.complex128)
        if int(found[3, 0]) > POINTS:
            steps[-1] = rows[POINTS]
        order = {name: k + 1 for k, name in enumerate(problem.carried_names)}
        real = steps[:, [order[name] for name in followed]]
        imaginary = steps[:, [order[IMAGINARY + name] for name in followed]]
        start = np.array([values[name] for name in followed], dtype=np.complex128)
        return np.concatenate([start[None], real + 1j * imaginary])


def _detour(centre: float, radius: float, values: Complex, measured: Sequence[tuple[slice, Array]]) -> Detour:
    """Taylor's coefficients from values on the half circle, which begins on the left."""
    upper = values[::-1]  # from the right, over the top, to the left
    lower = np.conj(upper[1:-1])[::-1]
    circle = np.concatenate([upper, lower])
    coefficients = np.fft.fft(circle, axis=0).T / len(circle)
    half = len(circle) // 2
    singular = unresolved = 0.0
    for part, units in measured:
        sizes = np.abs(coefficients[part]) / units[:, None]
        if not len(sizes):
            continue
        # what stands is compared with what moves
        moved = float(np.max(sizes[:, 1:half])) or 1.0
        imaginary = np.abs(coefficients[part, :half].imag) / units[:, None]
        singular = max(
            singular, float(np.max(sizes[:, half + 1 :])) / moved, float(np.max(imaginary)) / moved
        )
        unresolved = max(unresolved, float(np.max(sizes[:, half - 6 : half])) / moved)
    return Detour(centre, radius, coefficients[:, :half].real.copy(), singular, unresolved)
