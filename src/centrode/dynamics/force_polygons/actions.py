"""Forces and moments on the bodies at an instant: loads, weights, inertia, and reactions as they get known."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np

from centrode.analysis.graphic.board import cross
from centrode.analysis.graphic.stage import Drawing
from centrode.dynamics.bodies import Centre, Mass, Radial
from centrode.dynamics.burden import Burden
from centrode.dynamics.coordinates import Component, Distance, HalfSquare, Slide, Turn
from centrode.dynamics.force_polygons.bodies import Bodies
from centrode.dynamics.loads import Acting, Effort
from centrode.dynamics.states import State
from centrode.model.mechanism import FRAME

Source: TypeAlias = Literal["load", "weight", "inertia", "reaction", "drive"]


@dataclass(frozen=True)
class Action:
    """A force [N] at a place, or a moment [N m], on a body; a reaction of a guide has both.

    Attributes
    ----------
    symbol : G2, Φ2, MΦ2, F1, R12
    label : what it is: the load's name, the link, the joint
    """

    symbol: str
    label: str
    body: str
    source: Source
    force: complex = 0j
    place: complex = 0j
    moment: float = 0.0

    def about(self, place: complex) -> float:
        """Its moment about a place [N m], counter-clockwise positive."""
        return self.moment + cross(self.place - place, self.force)


def total(actions: Iterable[Action]) -> complex:
    """Sum of the forces."""
    return sum((action.force for action in actions), 0j)


def moment_about(actions: Iterable[Action], place: complex) -> float:
    """Sum of the moments about a place."""
    return sum(action.about(place) for action in actions)


def outer_actions(
    burden: Burden, state: State, rates: Rates, drawing: Drawing, bodies: Bodies
) -> list[Action]:
    """Loads, weights and inertia on the moving bodies and the frame at the only sample of a state."""
    reader = Reader(burden, state, drawing, bodies)
    found = list(reader.loads())
    for mass in burden.masses:
        found += reader.inertia(mass, rates)
    return found


@dataclass(frozen=True)
class Rates:
    """First and second derivative by time of what a state's jets are differentiated by."""

    first: float
    second: float

    def acceleration(self, jet: Any) -> float:
        """Second derivative by time of a jet."""
        return _number(jet.derivative(2)) * self.first**2 + _number(jet.derivative(1)) * self.second


@dataclass(frozen=True)
class Reader:
    """Turns loads and masses into actions."""

    burden: Burden
    state: State
    drawing: Drawing
    bodies: Bodies

    def inertia(self, mass: Mass, rates: Rates) -> Iterator[Action]:
        """Force and moment of inertia of a link, against its acceleration."""
        number = self.bodies.number(mass.link)
        if mass.weighs:
            x, y = self.state.centre(mass.centre)
            pulled = -mass.mass * complex(rates.acceleration(x), rates.acceleration(y))
            yield Action(f"Φ{number}", mass.link, mass.link, "inertia", pulled, self.place(mass.centre))
        if mass.resists:
            turn = -mass.moment_of_inertia * rates.acceleration(self.state.angle(mass.link))
            yield Action(f"MΦ{number}", mass.link, mass.link, "inertia", moment=turn)

    def loads(self) -> Iterator[Action]:
        """Loads in description order, then weights; forces of one load on one place are put together."""
        known = np.ones((1, 1), dtype=bool)
        numbers = Counter[str]()
        for load in self.burden.loads:
            source, symbol = self.symbol(load, numbers)
            gathered: dict[tuple[str, complex], Action] = {}
            for effort, strength in zip(load.efforts, load.strengths(self.state, known), strict=True):
                for one in self.actions(effort, _number(strength)):
                    body, force, place, moment = one
                    before = gathered.get((body, place))
                    if before is not None:
                        force, moment = force + before.force, moment + before.moment
                    gathered[body, place] = Action(symbol, load.label, body, source, force, place, moment)
            both = len([body for body, _place in gathered if body != FRAME]) > 1
            for (body, _place), action in gathered.items():
                name = f"{symbol}({self.bodies.number(body)})" if both or body == FRAME else symbol
                yield Action(name, action.label, body, source, action.force, action.place, action.moment)

    def symbol(self, load: Acting, numbers: Counter[str]) -> tuple[Source, str]:
        """G with the link's number of weights; F and M of other loads, counted."""
        coordinates = [effort.coordinate for effort in load.efforts]
        first = coordinates[0] if coordinates else None
        if isinstance(first, Component) and isinstance(first.at, Centre):
            symbol = f"G{self.bodies.number(first.at.link)}"
            numbers[symbol] += 1
            return "weight", symbol + "′" * (numbers[symbol] - 1)
        letter = "M" if isinstance(first, Turn) else "F"
        numbers[letter] += 1
        return "load", f"{letter}{numbers[letter]}"

    def actions(self, effort: Effort, strength: float) -> Iterator[tuple[str, complex, complex, float]]:
        """Body, force, place and moment of each action that an effort of this strength is."""
        along = effort.coordinate if effort.works is None else effort.works
        if isinstance(along, Component):
            body = self.bodies.host(along.at) if isinstance(along.at, str) else along.at.link
            yield body, strength * self.direction(along), self.place(along.at), 0.0
        elif isinstance(along, Turn):
            yield along.link, 0j, 0j, strength
            yield along.base, 0j, 0j, -strength
        elif isinstance(along, Slide):
            guide = self.bodies.mechanism.guide(along.guide)
            unit = complex(*self.drawing.numbers.direction[guide.id])
            force = strength * unit * complex(*self.drawing.at.poses[guide.on].rotor)
            place = self.drawing.point(guide.point)
            yield self.bodies.carrier(guide), force, place, 0.0
            yield guide.on, -force, place, 0.0
        elif not isinstance(along, (Distance, HalfSquare)):
            along.pulls(self.state)  # says why it acts on no body
        else:
            ends = self.drawing.point(along.first), self.drawing.point(along.second)
            apart = ends[1] - ends[0]
            force = strength * (apart if isinstance(along, HalfSquare) else apart / abs(apart))
            yield self.bodies.host(along.second), force, ends[1], 0.0
            yield self.bodies.host(along.first), -force, ends[0], 0.0

    def direction(self, along: Component) -> complex:
        """Unit vector of a component as it stands."""
        unit = complex(*along.direction)
        turn = 1.0 + 0j if along.axes == FRAME else complex(*self.drawing.at.poses[along.axes].rotor)
        return unit / abs(unit) * turn

    def place(self, at: str | Centre | Radial) -> complex:
        """Place of a point or of a centre of mass."""
        if isinstance(at, str):
            return self.drawing.point(at)
        assert isinstance(at, Centre)
        turn = complex(*self.drawing.at.poses[at.link].rotor)
        return self.drawing.point(at.base) + turn * complex(float(at.along), float(at.across))


def _number(value: Any) -> float:
    """The only entry of what may be an array, or a plain number."""
    return float(np.ravel(value)[0])
