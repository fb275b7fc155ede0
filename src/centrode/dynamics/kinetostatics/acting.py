"""What acts on a mechanism in motion: its loads, and the inertia of its links."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.dynamics.coordinates import place_of
from centrode.dynamics.inertia import shares
from centrode.dynamics.loads import Acting
from centrode.dynamics.masses import Mass
from centrode.dynamics.pulls import Pull, couple, on_link
from centrode.dynamics.reducer import Burden
from centrode.dynamics.states import State

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


@dataclass(frozen=True)
class InertiaForce:
    """Inertia force -m a [N] in the centre of mass, and inertia moment -I alpha [N m], of one link."""

    link: str
    force: tuple[Number, Number]
    at: tuple[Number, Number]
    moment: Number

    @property
    def pulls(self) -> tuple[Pull, ...]:
        """The same as forces on the link."""
        return on_link(self.link, self.force, self.at), couple(self.link, self.moment)


@dataclass(frozen=True)
class Outer:
    """Loads and inertia at the positions of a state.

    Attributes
    ----------
    loads : forces and moments of all loads
    inertia : of each link that has mass
    moment : (1, n)
        What both do along the path's parameter, by virtual work: power over its rate.
    shares : (loads, 1, n)
        What each load does.
    """

    loads: tuple[Pull, ...]
    inertia: tuple[InertiaForce, ...]
    moment: Array
    shares: Array

    @property
    def pulls(self) -> tuple[Pull, ...]:
        """Everything that acts."""
        return (*self.loads, *(pull for one in self.inertia for pull in one.pulls))


def outer_of(state: State, burden: Burden, acceleration: Array, known: Any) -> Outer:
    """What acts on a mechanism; `acceleration` is that of the path's parameter.

    Raises InputError for a load without a finite amount although the positions are `known`.
    """
    pulls, by_load = _loads(state, burden.loads, known)
    inertia, slope = (part.sum(axis=0) for part in shares(state, burden.masses, by_load.shape[1:]))
    moment = by_load.sum(axis=0) - inertia * acceleration - 0.5 * slope * state.rate**2
    return Outer(tuple(pulls), _inertia_forces(state, burden.masses, acceleration), moment, by_load)


def _loads(state: State, loads: Sequence[Acting], known: Any) -> tuple[list[Pull], Array]:
    pulls: list[Pull] = []
    done = np.zeros((len(loads), 1, len(state.parameter)))
    with np.errstate(all="ignore"):
        for k, load in enumerate(loads):
            strengths = load.strengths(state, known)
            done[k] = load.along(state, strengths)
            for effort, strength in zip(load.efforts, strengths, strict=True):
                pulls += [pull.times(strength) for pull in effort.pulls(state)]
    return pulls, done


def _inertia_forces(state: State, masses: Sequence[Mass], acceleration: Array) -> tuple[InertiaForce, ...]:
    accelerates = bool(acceleration.any())

    def second(jet: Jet) -> Number:
        straight = jet.derivative(2) * state.rate**2
        return straight + jet.derivative(1) * acceleration if accelerates else straight

    found = []
    for mass in masses:
        assert not isinstance(mass.inertia, tuple)
        x, y = state.centre(mass.centre)
        force = (-mass.mass * second(x), -mass.mass * second(y)) if mass.weighs else (0.0, 0.0)
        moment = -mass.moment_of_inertia * second(state.angle(mass.link)) if mass.resists else 0.0
        found.append(InertiaForce(mass.link, force, place_of((x, y)), moment))
    return tuple(found)
