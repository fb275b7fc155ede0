"""Initial value problems with constraints, as expressions: what an integrator needs to know of them.

The scheme is DOP853: E. Hairer, S. P. Norsett and G. Wanner, Solving Ordinary Differential Equations I, 2nd ed.,
1993, section II.10. Twelve stages have order 8, embedded formulas of orders 5 and 3 tell the error. After a step that
is taken everything may be brought back to where constraints hold.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph

HEADER = 4
"""Rows of a state before what is carried: time, size of the next step, attempts, rows that were written."""

SAFETY, LEAST, MOST = 0.9, 0.2, 6.0
"""The factor by which a step changes aims at this share of the tolerance, and lies between these."""
RETREAT = 0.25
"""Factor of a step at which something has no value."""

TIME, STEP, SIZE, END, SMALLEST = "time", "step", "size", "end", "smallest"
TAKEN = "taken"
OF_FIFTH, OF_THIRD, BEFORE = "fifth ", "third ", "before "
"""Before the name of what is followed: estimates of its error over the step's length, and its value before the step."""


@dataclass(frozen=True)
class InitialValueProblem:
    """What is followed, how fast it changes, how it is closed after a step, and how great a step's error is.

    All are expressions in the names of what is followed, of what stays as it is during a step, of the parameters and of
    `TIME`; what is closed may depend on `STEP` too, the step that was taken.

    Attributes
    ----------
    parameters : names of numbers of a lane; `END` and `SMALLEST` are among them: when it ends, and the least step
    rates : what is followed -> its derivative by time
    closing : what is followed, and what stays as it is during a step -> its value after a step that is taken
    error : the error of a step over the tolerance, in `OF_FIFTH`, `OF_THIRD`, `BEFORE` and the values behind the step
    limit : name of what, among that which stays during a step, the next step must not exceed; or empty
    guard : name of what stops the integration where it is not zero; empty where nothing does
    """

    parameters: tuple[str, ...]
    rates: Mapping[str, Node]
    closing: Mapping[str, Node]
    error: Node
    limit: str = ""
    guard: str = ""

    @cached_property
    def unknowns(self) -> tuple[str, ...]:
        """Names of what is followed."""
        return tuple(self.rates)

    @cached_property
    def fixed_names(self) -> tuple[str, ...]:
        """Names of what stays as it is during a step."""
        return tuple(name for name in self.closing if name not in self.rates)

    @cached_property
    def carried_names(self) -> tuple[str, ...]:
        """All that is handed from step to step."""
        return (*self.unknowns, *self.fixed_names)

    @cached_property
    def key(self) -> tuple[object, ...]:
        """Key that distinguishes the problem from all others, equal in every process."""
        graphs = (self.of_rates, self.of_closing, self.of_control)
        return self.parameters, self.carried_names, self.limit, self.guard, *(graph.key for graph in graphs)

    @cached_property
    def of_rates(self) -> Graph:
        """The derivatives together."""
        return Graph(dict(self.rates))

    @cached_property
    def of_closing(self) -> Graph:
        """What a step that is taken ends with; what is not closed stays as it is."""
        values = {name: self.closing.get(name, variable(name)) for name in self.unknowns}
        return Graph(values | {name: self.closing[name] for name in self.fixed_names})

    @cached_property
    def of_control(self) -> Graph:
        """Whether a step is taken, and the size of the next: of `STEP`, `SIZE` and what the error depends on."""
        m = EXPRESSIONS
        step, size, error = variable(STEP), variable(SIZE), self.error
        taken = m.both(m.less_equal(error, 1.0), m.less(0.0, step))
        root = m.sqrt(m.sqrt(m.sqrt(m.max(error, 1e-9))))
        factor = m.min(m.max(SAFETY / root, LEAST), MOST)
        proposed = m.where(m.is_number(error), step * factor, step * RETREAT)
        # a step that is cut at the end says nothing against the size before it
        cut = m.where(taken, m.max(size, proposed), proposed)
        further = m.where(m.less(step, size), cut, proposed)
        return Graph({TAKEN: as_node(m.where(taken, 1.0, 0.0)), SIZE: as_node(further)})
