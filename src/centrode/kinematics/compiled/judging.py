"""Which mechanisms of a batch have no events: judged on the mesh of events, along the path where that is needed.

A mechanism is clear where every radicand stays above zero all over each cell of the mesh, and every divisor off it,
by the bounds of `algebra.bends`: the search of `events` would find nothing. Behind a group of higher class nothing is
bounded; there no sign change and no low minimum is enough. Then no sign flips, nothing is cut off, and the formulas of
`traced` are the whole motion. What is not clear is left to the arrays; to call a clear mechanism unclear costs time and
nothing else.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.expression_functions import EXPRESSIONS
from centrode.algebra.expressions import Node, Operand, as_node, variable
from centrode.algebra.jets import Jet
from centrode.algebra.reductions import Reduction, together
from centrode.kinematics.compiled.bends import DIVISOR, RADICAND, bends_of
from centrode.kinematics.compiled.centring import Centring
from centrode.kinematics.compiled.drives import places_of
from centrode.kinematics.compiled.passes import Pass, greatest, least, least_of
from centrode.kinematics.compiled.traced import Traced
from centrode.kinematics.compiled.variables import PARAMETER
from centrode.kinematics.compiled.walks.walking import SURE, Walk, Walking
from centrode.kinematics.compiled.walks.ways import way_of
from centrode.kinematics.continuation import WINDOW
from centrode.kinematics.mesh import LOW, mesh_of
from centrode.kinematics.paths import Path
from centrode.kinematics.sampling import ORDERS, SUSPECT

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Values: TypeAlias = dict[str, Array]

m = EXPRESSIONS
SAFE = 2.0
"""Margins of the search are kept this many times over: the last bits may differ from those of the arrays."""
ROOM = 1.0 + 1e-6
"""How much more than their bounds numbers may stray: the search's own comparisons are rounded otherwise."""
SLACK, GAP = "slack", "gap"


@dataclass(frozen=True)
class Judged:
    """Of mechanisms (lanes,): which are clear, and further variables of their formulas."""

    clear: Mask
    values: Values


@dataclass(frozen=True)
class Judging:
    """How mechanisms of a traced plan are judged; `links` are those whose turns are asked for."""

    traced: Traced
    samples: Array
    names: tuple[str, ...]
    links: tuple[str, ...]
    executor: str
    threads: int = 1

    @cached_property
    def mesh(self) -> Array:
        """The nodes on which the arrays look for events."""
        return mesh_of(self._path, self.samples)

    @property
    def _path(self) -> Path:
        return self.traced.solved.ready.kinematics.path

    def _places(self, parameter: Array) -> Values:
        return places_of(self._path, parameter, ORDERS - 1)

    @cached_property
    def _centring(self) -> Centring:
        return Centring(self.traced, self.links, self.mesh, self.names)

    @cached_property
    def walk(self) -> Walk:
        """What is handed on along the path, where there are groups of higher class."""
        return Walk(self.traced, self.links)

    def judge(self, values: Mapping[str, Array]) -> Judged:
        """Judge the mechanisms of a batch; with groups of higher class `values` have where walks begin.

        What a walk along the samples finds out about these groups themselves is not looked at here.
        """
        found = self._events(values)
        lanes = len(next(iter(values.values())))
        clear = np.ones(lanes, dtype=bool)
        for slack in {SLACK, SURE} & found.keys():
            clear &= found[slack] > 0.0
        for group in self.traced.divisors:
            if f"least {group}" in found:
                clear &= (found[f"least {group}"] > 0.0) | (found[f"most {group}"] < 0.0)
        further = {name: array for name, array in found.items() if name.startswith("largest")}
        if self.links and not self.traced.steps:
            near, centres = self._centring.centres(values, self.executor, self.threads)
            clear &= near
            further |= centres
        return Judged(clear, further)

    def _events(self, values: Mapping[str, Array]) -> Values:
        walk = Walk(self.traced)
        if walk.moves(list(self._of_events.state.values())):
            way = way_of(self._path, {PARAMETER: self._near})
            return Walking(walk, self._of_events).reduced(way, values, self.executor, self.threads)
        return self._over_nodes.run(values, self.executor, self.threads)

    @property
    def _near(self) -> Array:
        """The nodes on which an event would matter to a sample, or to the way from the initial position to it."""
        path = self._path
        ends = np.append(self.samples, path.initial)
        beyond = WINDOW * path.unit + 2.0 * path.step
        near: Array = self.mesh[(self.mesh >= ends.min() - beyond) & (self.mesh <= ends.max() + beyond)]
        return near

    @cached_property
    def _over_nodes(self) -> Pass:
        return Pass(self._of_events, self.names, self._nodes)

    @cached_property
    def _nodes(self) -> Values:
        """The mesh; with several drives also how far from each node the next one may be."""
        gaps = np.diff(self.mesh)
        either = np.maximum(np.append(gaps, 0.0), np.append(0.0, gaps))
        found = self._places(self.mesh) | bends_of(self._path, self.mesh)
        return found | ({GAP: either} if self._path.by_time else {})

    @cached_property
    def _of_events(self) -> Reduction:
        """States: how far the worst radicand is from what the search would look into; ends of divisors."""
        step = variable(GAP) if self._path.by_time else self._path.step
        slacks, parts = [], []
        for group, radicand in self.traced.radicands.items():
            value, slope = _with_slope(radicand)
            bent = self.traced.bends.get((RADICAND, group))
            if bent is None:
                # a minimum next to a node lies no deeper than its tangent reaches in one step
                slacks.append(as_node(value * (1.0 - SAFE * LOW) - m.abs(slope) * step))
            else:
                slacks.append(as_node(bent.value - ROOM * bent.strays))
            parts.append(greatest(f"largest {group}", as_node(m.abs(value))))
        for group, divisor in self.traced.divisors.items():
            bent = self.traced.bends.get((DIVISOR, group))
            if bent is None:
                value = as_node(_with_slope(divisor)[0])
                parts += [greatest(f"most {group}", value), least(f"least {group}", value)]
            else:
                slacks.append(as_node(m.abs(bent.value) - ROOM * bent.strays))
        if slacks:
            parts.append(least(SLACK, least_of(slacks)))
        return together(*parts)

    @cached_property
    def slack_at_samples(self) -> Node | None:
        """Positive where no radicand comes near enough to zero to be compared with its rounding error."""
        slacks = []
        for group, radicand in self.traced.radicands.items():
            value = _with_slope(radicand)[0]
            slacks.append(as_node(value - SAFE * SUSPECT * variable(f"largest {group}")))
        return least_of(slacks) if slacks else None


def _with_slope(number: object) -> tuple[Operand, Operand]:
    if isinstance(number, Jet):
        return number.coefficients[0], number.coefficients[1]
    return number, 0.0  # type: ignore[return-value]
