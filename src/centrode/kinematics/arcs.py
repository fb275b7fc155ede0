"""Following the curve of a group of higher class by its own arc where the path's parameter does not lead on.

State and parameter are found together on a plane square to the curve (Keller, Numerical Solution of Bifurcation
and Nonlinear Eigenvalue Problems, 1977), so limits are ordinary places: there the parameter turns back. Where
the determinant of the group changes its sign and the parameter runs on, another curve crosses: a change point.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.kinematics.anchors import Anchor, Fold, through_places
from centrode.kinematics.branches import Event
from centrode.kinematics.newton import solved
from centrode.kinematics.paths import JETS
from centrode.kinematics.surroundings import Surroundings
from centrode.kinematics.walkers import Walkers

Array: TypeAlias = npt.NDArray[np.float64]
Lanes: TypeAlias = npt.NDArray[np.intp]
Mask: TypeAlias = npt.NDArray[np.bool_]

FIRST, GREATEST, LEAST = 0.01, 0.1, 1e-6
"""Steps of the arc, in rad and in the greatest length: the first, the greatest, the one at which it is given up."""
STRAIGHT = 0.98
"""Cosine of the angle by which the curve may turn in a step."""
CONTRACTION = 0.2
STEPS = 8
SMALL = 1e-9
LONGER = 1.05
"""The stretch back from a limit reaches this much further than a parabola would have to."""
NODES = 9
"""Places on a stretch of arc through which polynomials are laid."""
PASSES, NARROWER = 3, 0.05
"""How often a limit is looked for, each time on a stretch so many times narrower on both sides."""


@dataclass(frozen=True)
class Places:
    """Places on curves: parameters, states, the curve's derivative by its arc there, sign of the determinant."""

    parameter: Array
    state: Array
    slope: Array
    sense: Array
    found: Mask

    def of(self, which: Lanes | Mask) -> Places:
        """Some of the places."""
        return Places(
            self.parameter[which], self.state[which], self.slope[which], self.sense[which], self.found[which]
        )


def on_plane(around: Surroundings, lanes: Lanes, base: Places, along: Array, arc: Array) -> Places:
    """Where curves pass the planes square to `along` at distances `arc` from their bases."""
    parameter = base.parameter + around.unit * along[:, -1] * arc
    system = around.system(around.known(base.parameter, lanes, 0), lanes)
    state = system.moved(base.state, along[:, :-1] * arc[:, None])
    count, size = along.shape
    last, found = np.full(count, np.inf), np.zeros(count, dtype=bool)
    active = np.isfinite(state).all(axis=1)
    slope, sense = np.full((count, size), np.nan), np.zeros(count)
    for _step in range(STEPS):
        matrix, right = _bordered(around, lanes, parameter, state, along)
        step, _sign = solved(matrix, right)
        sense = np.where(active, np.linalg.slogdet(matrix[:, :-1, :-1])[0], sense)
        length = np.max(np.abs(step), axis=1)
        good = active & np.isfinite(length) & (length < 1.0)
        state = np.where(
            good[:, None], system.moved(state, np.where(good[:, None], step[:, :-1], 0.0)), state
        )
        parameter = np.where(good, parameter + around.unit * step[:, -1], parameter)
        square = np.zeros((count, size))
        square[:, -1] = 1.0
        slope = np.where(good[:, None], solved(matrix, square)[0], slope)
        done = good & (last <= SMALL) & (length <= SMALL)
        found |= done
        active = good & ~done & (length <= np.maximum(CONTRACTION * last, SMALL))
        last = length
        if not active.any():
            break
    return Places(parameter, state, slope, sense, found)


def _bordered(
    around: Surroundings, lanes: Lanes, parameter: Array, state: Array, along: Array
) -> tuple[Array, Array]:
    """Jacobian by state and parameter, bordered by the plane's normal, and the right side of a Newton step."""
    known = around.known(parameter, lanes, 1)
    system = around.system(known, lanes)
    count, size = along.shape
    matrix, right = np.zeros((count, size, size)), np.zeros((count, size))
    at = system.at(JETS, known, state)
    matrix[:, :-1, :-1] = system.matrix(system.at(JETS, system.known, state))
    for i, value in enumerate(system.residual(JETS, at)):
        jet = value if isinstance(value, Jet) else Jet((value, 0.0))
        right[:, i] = -jet.coefficients[0]
        matrix[:, i, -1] = jet.coefficients[1] * around.unit
    matrix[:, -1] = along
    return matrix, right


def follow(around: Surroundings, walkers: Walkers, who: Lanes) -> list[Event]:
    """Lead walkers along their arcs past what stops them, or to their limits; returns the events."""
    events: list[Event] = []
    goal = np.array([_goal(around, walkers, k) for k in who])
    here, along = _start(around, walkers, who)
    arc = np.full(len(who), FIRST)
    left = here.found.copy()
    for k in who[~left]:
        walkers.give_up(k)
    while left.any():
        now = np.nonzero(left)[0]
        lanes = walkers.lane[who[now]]
        there = on_plane(around, lanes, here.of(now), along[now], arc[now])
        unit = there.slope / np.linalg.norm(there.slope, axis=1)[:, None]
        with np.errstate(invalid="ignore"):
            good = there.found & (np.sum(unit * along[now], axis=1) >= STRAIGHT)
        arc[now[~good]] *= 0.25
        for k in now[~good & (arc[now] < LEAST)]:
            walkers.plant(around, who[[k]], here.parameter[[k]], here.state[[k]])
            walkers.give_up(who[k])
            left[k] = False
        sense = walkers.sense[who[now]]
        folded = good & (there.slope[:, -1] * sense <= 0.0)
        for k in np.nonzero(folded)[0]:
            events.append(
                _fold(around, walkers, who[now[k]], here.of(now[[k]]), along[now[[k]]], arc[now[k]])
            )
            left[now[k]] = False
        on = good & ~folded
        for k in np.nonzero(on & (there.sense != here.sense[now]))[0]:
            events.append(
                _crossing(around, walkers, who[now[k]], here.of(now[[k]]), along[now[[k]]], arc[now[k]])
            )
            if not walkers.smooth:
                walkers.give_up(who[now[k]])
                left[now[k]] = on[k] = False
        for k in np.nonzero(on)[0]:
            _move(here, now[k], there, int(k))
        along[now[on]] = unit[on]
        arc[now[on]] = np.minimum(1.5 * arc[now[on]], GREATEST)
        arrived = on & ((there.parameter - goal[now]) * sense >= 0.0)
        for k in np.nonzero(arrived)[0]:
            walkers.plant(around, who[now[[k]]], there.parameter[[k]], there.state[[k]])
            left[now[k]] = False
    return events


def _goal(around: Surroundings, walkers: Walkers, walker: int) -> float:
    """How far the arc is followed if nothing happens: as far as the step that failed, and at least a small one."""
    start = walkers.trails[walker].anchors[-1].parameter
    return start + float(walkers.sense[walker]) * max(2.0 * float(walkers.step[walker]), 0.02) * around.unit


def _start(around: Surroundings, walkers: Walkers, who: Lanes) -> tuple[Places, Array]:
    """The newest anchors as places, and the unit vectors in which their curves go on."""
    last = [walkers.trails[k].anchors[-1] for k in who]
    forward = (
        np.array([np.append(a.series[0] * around.unit, 1.0) for a in last]) * walkers.sense[who][:, None]
    )
    along = forward / np.linalg.norm(forward, axis=1)[:, None]
    base = Places(
        np.array([a.parameter for a in last]),
        np.array([a.state for a in last]),
        along,
        np.array([a.sense for a in last]),
        np.ones(len(who), dtype=bool),
    )
    return on_plane(around, walkers.lane[who], base, along, np.zeros(len(who))), along


def _move(here: Places, k: int, there: Places, j: int) -> None:
    here.parameter[k], here.state[k] = there.parameter[j], there.state[j]
    here.slope[k], here.sense[k] = there.slope[j], there.sense[j]


def _fold(
    around: Surroundings, walkers: Walkers, walker: int, base: Places, along: Array, arc: float
) -> Event:
    """The place between a base and an arc's length where the parameter turns back."""
    lane = walkers.lane[[walker]]
    least, most = 0.0, arc
    for _pass in range(PASSES):
        nodes, places = _spread(around, lane, base, along, least, most)
        turn = _root_between(nodes, places.slope[:, -1], least, most)
        half = NARROWER * (most - least)
        least, most = turn - half, turn + half
    limit = on_plane(around, lane, base, along, np.array([turn]))
    parameter, trail = float(limit.parameter[0]), walkers.trails[walker]
    last = trail.anchors[-1]
    bend = float(places.slope[-1, -1] - places.slope[0, -1]) / float(nodes[-1] - nodes[0])
    trail.end = "limit"
    trail.fold = Fold(parameter, limit.state[0], last.sense, *_way_to(around, lane, limit, bend, last))
    walkers.active[walker] = False
    return Event("limit", around.group, int(lane[0]), parameter, bool(walkers.sense[walker] < 0.0))


def _way_to(
    around: Surroundings, lane: Lanes, limit: Places, bend: float, last: Anchor
) -> tuple[Array, Array]:
    """Polynomials from the last anchor to a limit, in the share of the arc; `bend` is p'' by the arc."""
    along = limit.slope / np.linalg.norm(limit.slope, axis=1)[:, None]
    back = abs(last.parameter - float(limit.parameter[0])) / around.unit
    extent = LONGER * float(np.sqrt(2.0 * back / abs(bend)))
    nodes, places = _spread(around, lane, limit, along, -extent, 0.0)
    return through_places(1.0 + nodes / extent, places.parameter, places.state)


def _crossing(
    around: Surroundings, walkers: Walkers, walker: int, base: Places, along: Array, arc: float
) -> Event:
    """The place between a base and an arc's length where another curve crosses."""
    lane = walkers.lane[[walker]]
    nodes, places = _spread(around, lane, base, along, 0.0, arc)
    lanes = np.repeat(lane, len(nodes))
    matrix, _right = _bordered(around, lanes, places.parameter, places.state, np.repeat(along, len(nodes), 0))
    at = _root_between(nodes, np.linalg.det(matrix[:, :-1, :-1]), 0.0, arc)
    parameter = np.polynomial.Polynomial.fit(nodes, places.parameter, len(nodes) - 1)(at)
    return Event("change point", around.group, int(lane[0]), float(parameter))


def _spread(
    around: Surroundings, lane: Lanes, base: Places, along: Array, least: float, most: float
) -> tuple[Array, Places]:
    """Places at Chebyshev nodes of a stretch of arc, as far as they are found."""
    nodes = 0.5 * (least + most) - 0.5 * (most - least) * np.cos((np.arange(NODES) + 0.5) * np.pi / NODES)
    many = np.zeros(NODES, dtype=np.intp)
    places = on_plane(around, lane[many], base.of(many), along[many], nodes)
    return nodes[places.found], places.of(places.found)


def _root_between(nodes: Array, values: Array, least: float, most: float) -> float:
    """Where the polynomial through values at nodes is zero; the middle of the stretch if it is nowhere."""
    middle = 0.5 * (least + most)
    if len(nodes) < 2:
        return middle
    roots = np.polynomial.Polynomial.fit(nodes, values, len(nodes) - 1).roots()
    room = 0.1 * (most - least)
    real = roots[np.abs(roots.imag) <= room].real
    inside = real[(real >= least - room) & (real <= most + room)]
    return float(inside[np.argmin(np.abs(inside - middle))]) if len(inside) else middle
