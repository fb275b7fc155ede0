"""Which mechanisms of a batch have no events: judged on the mesh of events, along the path where that is needed.

Of the commonest groups closed forms tell that (`closure_conditions`). Others are looked at cell by cell, first in wide
cells, then in those of the mesh. A mechanism is clear where every radicand stays above zero all over each cell, and
every divisor off it, by the bounds of `numerics.bends`: the search of `events` would find nothing. Behind a group of
higher class nothing is bounded; there no sign change and no low minimum is enough. Then no sign flips, nothing is cut
off, and the formulas of `traced` are the whole motion. What is not clear is left to the arrays; to call a clear
mechanism unclear costs time and nothing else.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.kinematics.change_points import WINDOW
from centrode.kinematics.machine_code.bends import DIVISOR, RADICAND, bends_of
from centrode.kinematics.machine_code.closure_conditions import ClosureConditions, FoundClosure
from centrode.kinematics.machine_code.link_rotation import LinkRotation
from centrode.kinematics.machine_code.path_continuation import SURE, Walk, Walking, way_of
from centrode.kinematics.machine_code.trace import Traced
from centrode.kinematics.machine_code.variables import (
    AWAY,
    FIRST,
    INFINITE,
    MOST,
    PARAMETER,
    TURN,
    Pass,
    centre_of,
    greatest,
    least,
    least_of,
    places_of,
    whole_turns,
    winding_of,
)
from centrode.kinematics.mesh import LOW, mesh_of
from centrode.kinematics.path import Path
from centrode.kinematics.samples import ORDERS, SUSPECT
from centrode.numerics.expressions import EXPRESSIONS, Node, Operand, as_node, variable
from centrode.numerics.jets import Jet
from centrode.numerics.scans import Reduction, together

# Where the angles of links stand: each stays within half a turn of a centre, which may run on with a drive.

Array: TypeAlias = npt.NDArray[np.float64]
Mask: TypeAlias = npt.NDArray[np.bool_]
Values: TypeAlias = dict[str, Array]

m = EXPRESSIONS
SPARSE = 4
"""Angles are followed at every fourth node of the mesh: 2 degrees of an angle drive."""
START = "start"


def sparse_nodes(mesh: Array, initial: float) -> tuple[npt.NDArray[np.intp], int]:
    """Numbers of the nodes at which angles are followed, and that of the node nearest to the initial position."""
    start = int(np.argmin(np.abs(mesh - initial)))
    nodes = np.arange(len(mesh))
    # turns are counted from the initial position, so its node is looked at; the ends bound the range of the angle
    return np.unique(np.concatenate([nodes[start % SPARSE :: SPARSE], nodes[[0, -1]]])), start


def mesh_places(path: Path, mesh: Array) -> Values:
    """Variables of a place at the nodes of a mesh; with several drives also how far from each the next one may be."""
    gaps = np.diff(mesh)
    # the next node on either side: the farther one counts
    either = np.maximum(np.append(gaps, 0.0), np.append(0.0, gaps))
    values = places_of(path, mesh, ORDERS - 1) | bends_of(path, mesh)
    return values | ({GAP: either} if path.by_time else {})


@dataclass(frozen=True)
class Centring:
    """Kernels that find centres of the angles of some links of a traced plan."""

    traced: Traced
    links: tuple[str, ...]
    mesh: Array
    names: tuple[str, ...]

    @property
    def path(self) -> Path:
        """The path of the drives."""
        return self.traced.solved.ready.kinematics.path

    def centres(self, values: Mapping[str, Array], kernels: str, threads: int) -> tuple[Mask, Values]:
        """The mechanisms whose links all stay near enough to their centres; these with their windings."""
        clear, further = self._over_nodes.run(values, kernels, threads), Values()
        near = [self._add_centre(link, clear, further) for link in self.links]
        return np.logical_and.reduce(near), further

    @cached_property
    def _sparse(self) -> Values:
        """Every fourth node, the one nearest to the initial position among them."""
        chosen, start = sparse_nodes(self.mesh, self.path.initial)
        return {
            **places_of(self.path, self.mesh[chosen], ORDERS - 1),
            START: (chosen == start).astype(np.float64),
            FIRST: (chosen == 0).astype(np.float64),
        }

    @cached_property
    def _over_nodes(self) -> Pass:
        return Pass(self._of_angles, self.names, self._sparse)

    @cached_property
    def _of_angles(self) -> Reduction:
        """States: each angle run on from node to node, its jumps, its ends less those of some turns of the drive."""
        parts = [Reduction({}, {})]
        for link in self.links:
            cosine, sine = self.traced.turning[link]
            raw, before = m.atan2(sine, cosine), variable(f"angle {link}")
            angle = as_node(raw + TURN * whole_turns(before, raw))
            # the first node has none before it to jump from
            jump = m.where(m.equal(variable(FIRST), 1.0), 0.0, m.abs(angle - before))
            there = m.where(m.equal(variable(START), 1.0), angle, variable(f"at start {link}"))
            parts.append(
                Reduction(
                    {f"angle {link}": angle, f"at start {link}": as_node(there)},
                    {f"angle {link}": 0.0, f"at start {link}": 0.0},
                )
            )
            parts.append(greatest(f"jump {link}", as_node(jump)))
            for k, winding in enumerate(self._windings):
                rest = angle
                for drive, turns in winding.items():
                    rest = as_node(rest - turns * self.traced.winders[drive])
                parts += [greatest(f"high {k} {link}", rest), least(f"low {k} {link}", rest)]
        return together(*parts)

    def _add_centre(self, link: str, found: Values, further: Values) -> Mask:
        """Where an angle stays within half a turn of a centre; the centre and its winding are added."""
        start = self.traced.solved.ready.assembled.angles[link]
        whole = np.round((start - found[f"at start {link}"]) / TURN)
        off = np.abs(start - found[f"at start {link}"] - TURN * whole)
        kinds = range(len(self._windings))
        halves = np.stack([found[f"high {k} {link}"] - found[f"low {k} {link}"] for k in kinds]) / 2.0
        # of the windings the one that leaves the least range: NaN, of an angle without value, must not win
        best = np.argmin(np.where(np.isnan(halves), INFINITE, halves), axis=0)
        middles = np.stack([found[f"high {k} {link}"] + found[f"low {k} {link}"] for k in kinds]) / 2.0
        lanes = np.arange(len(best))
        for drive in self.traced.winders:
            of_each = np.array([winding.get(drive, 0.0) for winding in self._windings])
            further[winding_of(link, drive)] = of_each[best]
        # the centre is moved by whole turns to where the initial position of the description has the angle
        further[centre_of(link)] = middles[best, lanes] + TURN * whole
        jump = found[f"jump {link}"]
        # between two nodes looked at, the angle may go beyond what was seen by as much as it changes from one
        # to the next
        fits: Mask = halves[best, lanes] + jump < np.pi - AWAY
        return fits & (jump < MOST) & (off < np.pi - AWAY)

    @cached_property
    def _windings(self) -> list[dict[str, float]]:
        """Turns that a link may make for one of a drive: none, or one to either side for one of the drives."""
        return [{}, *[{drive: sense} for drive in self.traced.winders for sense in (1.0, -1.0)]]


SAFE = 2.0
"""Margins of the search are kept this many times over: the last bits may differ from those of the arrays."""
ROOM = 1.0 + 1e-6
"""How much more than their bounds numbers may stray: the search's own comparisons are rounded otherwise."""
SLACK, GAP, LOWEST = "slack", "gap", "lowest"
WIDE = 12
"""Nodes of the mesh that a wide cell stands for: 6 degrees of an angle drive."""


@dataclass(frozen=True)
class ScreenedEvents:
    """Of mechanisms (lanes,): which are clear, and further variables of their formulas.

    `certain` are those that closed forms show to be clear: no sample of them comes near to a limit.
    """

    clear: Mask
    certain: Mask
    values: Values


@dataclass(frozen=True)
class EventScreening:
    """Kernels that judge mechanisms of a traced plan; `links` are those whose turns are requested."""

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
    def _rotation(self) -> LinkRotation:
        return LinkRotation.of(self.traced, self.links, self.names)

    @cached_property
    def _centring(self) -> Centring:
        return Centring(self.traced, self.links, self.mesh, self.names)

    @cached_property
    def _centring_of_others(self) -> Centring:
        others = tuple(link for link in self.links if link not in self._rotation.headings)
        return Centring(self.traced, others, self.mesh, self.names)

    def _where_angles_stand(self, values: Mapping[str, Array], clear: Mask) -> Values:
        """Centres and windings in the mechanisms that are clear; where none is found a mechanism is clear no more."""
        names = [centre_of(link) for link in self.links]
        names += [winding_of(link, drive) for link in self.links for drive in self.traced.winders]
        further = {name: np.zeros(len(clear)) for name in names}

        told = near = np.zeros_like(clear)
        if self._rotation.headings:
            found = self._rotation.judge(values, self.executor, self.threads)
            told, near = found.told, clear & found.near
            further |= found.values

        def follow(centring: Centring, mechanisms: Mask) -> Mask:
            """Which of some mechanisms have a centre of each angle that is looked at."""
            found = mechanisms.copy()
            at = np.nonzero(mechanisms)[0]
            if len(at):
                some = values if len(at) == len(found) else {name: x[at] for name, x in values.items()}
                found[at], centres = centring.centres(some, self.executor, self.threads)
                for name, x in centres.items():
                    further[name][at] = x
            return found

        # what closed forms do not tell is followed over the mesh: other links, and of some mechanisms all
        followed = follow(self._centring, clear & ~told)
        if len(self._rotation.headings) < len(self.links):
            near = follow(self._centring_of_others, near)
        clear &= near | followed
        return further

    @cached_property
    def walk(self) -> Walk:
        """States handed on along the path, where there are groups of higher class."""
        return Walk(self.traced, self.links)

    @cached_property
    def closure(self) -> ClosureConditions | None:
        """Closed forms that say whether groups close all along the cells of the mesh, where there are any."""
        return ClosureConditions.of(self.traced, *self.covered_range, self.names)

    @property
    def covered_range(self) -> tuple[float, float]:
        """Ends of the range that the cells of the mesh cover: half a step beyond the first and the last node."""
        beyond = 0.5 * self._path.step
        return float(self.mesh[0] - beyond), float(self.mesh[-1] + beyond)

    def judge(self, values: Mapping[str, Array]) -> ScreenedEvents:
        """Judge the mechanisms of a batch; with groups of higher class `values` have where walks begin.

        What a walk along the samples finds out about these groups themselves is not looked at here.
        """
        lanes = len(next(iter(values.values())))
        clear, certain = np.zeros(lanes, dtype=bool), np.zeros(lanes, dtype=bool)
        further = {f"largest {group}": np.full(lanes, np.nan) for group in self.traced.radicands}
        doubtful = ~clear
        if self.closure is not None:
            found = self.closure.judge(values, self.executor, self.threads)
            clear, certain, doubtful = found.clear.copy(), found.clear, ~(found.clear | found.opens)
            further |= found.largest
        # each way looks at more places than the one before, and at fewer mechanisms
        for look in (self._in_wide_cells, self._on_the_mesh):
            left = np.nonzero(doubtful)[0]
            if len(left):
                some = values if len(left) == lanes else {name: x[left] for name, x in values.items()}
                found = look(some)
                for name, x in found.largest.items():
                    further[name][left] = x
                clear[left] = found.clear
                doubtful[left] = ~(found.clear | found.opens)
        if self.links and not self.traced.steps:
            further |= self._where_angles_stand(values, clear)
        return ScreenedEvents(clear, certain & clear, further)

    def _in_wide_cells(self, values: Mapping[str, Array]) -> FoundClosure:
        """What bounds over few wide cells, and radicands in their middles, tell."""
        if self._over_wide_cells is None:
            nothing = np.zeros(len(next(iter(values.values()))), dtype=bool)
            return FoundClosure(nothing, nothing, {})
        events = self._over_wide_cells.run(values, self.executor, self.threads)
        # NaN stands where a group before has no value
        opens = ~(events[LOWEST] >= 0.0) if LOWEST in events else np.zeros(len(events[SLACK]), dtype=bool)
        return FoundClosure(events[SLACK] > 0.0, opens, _largest_of(events))

    @cached_property
    def _over_wide_cells(self) -> Pass | None:
        """A pass over cells that together cover those of the mesh; None where that is not what is asked."""
        path = self._path
        if path.by_time or self.traced.steps or len(self.mesh) < 2 * WIDE:
            return None
        low, high = self.covered_range
        count = int(np.ceil((high - low) / (WIDE * path.step)))
        half = float(0.5 * (high - low) / count)
        bends = self.traced.bent.guards(half)
        slacks, values, parts = [], [], []
        for (kind, group), bent in bends.items():
            size = as_node(m.abs(bent.value))
            if kind == RADICAND:
                values.append(as_node(bent.value))
                parts.append(greatest(f"largest {group}", as_node(size + bent.strays)))
            slacks.append(as_node((bent.value if kind == RADICAND else size) - ROOM * bent.strays))
        if not slacks:
            return None
        if values:
            parts.append(least(LOWEST, least_of(values)))
        places = self._places(low + half * (2.0 * np.arange(count, dtype=np.float64) + 1.0))
        return Pass(together(*parts, least(SLACK, least_of(slacks))), self.names, places)

    def _on_the_mesh(self, values: Mapping[str, Array]) -> FoundClosure:
        """The mechanisms of which nothing on the mesh says that they may have events."""
        events = self._events(values)
        clear = np.ones(len(next(iter(values.values()))), dtype=bool)
        for slack in {SLACK, SURE} & events.keys():
            clear &= events[slack] > 0.0
        for group in self.traced.divisors:
            if f"least {group}" in events:
                # NaN fails both comparisons: what is not known is not clear
                clear &= (events[f"least {group}"] > 0.0) | (events[f"most {group}"] < 0.0)
        return FoundClosure(clear, ~clear, _largest_of(events))

    def _events(self, values: Mapping[str, Array]) -> Values:
        walk = Walk(self.traced)
        # where no radicand hangs on a group of higher class, nodes have nothing to do with one another and
        # need no walk
        if walk.moves(list(self._of_events.state.values())):
            way = way_of(self._path, {PARAMETER: self._near})
            return Walking(walk, self._of_events).reduce(way, values, self.executor, self.threads)
        return self._over_nodes.run(values, self.executor, self.threads)

    @property
    def _near(self) -> Array:
        """The nodes on which an event would matter to a sample, or to the way from the initial position to it."""
        path = self._path
        ends = np.append(self.samples, path.initial)
        # a change point beyond the samples still reaches into them by its window, and two steps cover the
        # cell it lies in
        beyond = WINDOW * path.unit + 2.0 * path.step
        near: Array = self.mesh[(self.mesh >= ends.min() - beyond) & (self.mesh <= ends.max() + beyond)]
        return near

    @cached_property
    def _over_nodes(self) -> Pass:
        return Pass(self._of_events, self.names, self._nodes)

    @cached_property
    def _nodes(self) -> Values:
        return mesh_places(self._path, self.mesh)

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
                # a divisor behind a group of higher class has no bound of its bend: its sign at the nodes has
                # to do
                value = as_node(_with_slope(divisor)[0])
                parts += [greatest(f"most {group}", value), least(f"least {group}", value)]
            else:
                slacks.append(as_node(m.abs(bent.value) - ROOM * bent.strays))
        if slacks:
            parts.append(least(SLACK, least_of(slacks)))
        return together(*parts)

    @property
    def over_mesh(self) -> tuple[Reduction, Values]:
        """What is reduced over the nodes of the mesh, and what the variables of a place stand for there."""
        return self._of_events, self._nodes

    @cached_property
    def slack_at_samples(self) -> Node | None:
        """Positive where no radicand comes near enough to zero to be compared with its rounding error."""
        slacks = []
        for group, radicand in self.traced.radicands.items():
            value = _with_slope(radicand)[0]
            slacks.append(as_node(value - SAFE * SUSPECT * variable(f"largest {group}")))
        return least_of(slacks) if slacks else None


def _largest_of(events: Values) -> Values:
    return {name: array for name, array in events.items() if name.startswith("largest")}


def _with_slope(number: object) -> tuple[Operand, Operand]:
    if isinstance(number, Jet):
        return number.coefficients[0], number.coefficients[1]
    return number, 0.0  # type: ignore[return-value]
