"""Kinetic energy: reduced inertia of one drive, inertia matrix of several, each link's share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.algebra.jets import Jet
from centrode.dynamics.bodies import About, Mass
from centrode.dynamics.states import State

Array: TypeAlias = npt.NDArray[np.float64]
Number: TypeAlias = Any


def coordinates_of(state: State, mass: Mass) -> list[tuple[Number, Jet]]:
    """Coordinates whose squared speeds make twice the kinetic energy of a link, each with its factor [kg or kg m^2]."""
    found = [(mass.mass, x) for x in state.centre(mass.centre)] if mass.weighs else []
    if not mass.resists:
        return found
    if not isinstance(mass.inertia, tuple):
        return [*found, (mass.inertia, state.angle(mass.link))]
    for part in mass.inertia:
        if isinstance(part, About):
            found.append((part.moment, state.turned_about(mass.link, part.direction)))
        else:
            found += [(part.moment, x) for x in state.heading(mass.link, part.direction)]
    return found


def shares(state: State, masses: Sequence[Mass], shape: tuple[int, ...]) -> tuple[Array, Array]:
    """Reduced inertia of each link and its derivative by the parameter, (links, *shape).

    J = m (x'^2 + y'^2) + I phi'^2, J' = 2 m (x' x'' + y' y'') + 2 I phi' phi''.
    """
    inertia, slope = np.zeros((len(masses), *shape)), np.zeros((len(masses), *shape))
    for k, mass in enumerate(masses):
        inertia[k], slope[k] = share(state, mass)
    return inertia, slope


def share(state: State, mass: Mass) -> tuple[Number, Number]:
    """Reduced inertia of one link and its derivative, over arrays or expressions."""
    inertia: Number = 0.0
    slope: Number = 0.0
    for factor, coordinate in coordinates_of(state, mass):
        first, second = coordinate.derivative(1), coordinate.derivative(2)
        inertia = inertia + factor * (first * first)
        slope = slope + factor * (2.0 * (first * second))
    return inertia, slope
