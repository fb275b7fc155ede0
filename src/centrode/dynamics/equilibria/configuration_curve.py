"""All positions of a mechanism with one degree of freedom that it reaches without being taken apart, as a curve."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.equilibria.linear_equations import LinearEquations, LoadedMechanism
from centrode.dynamics.equilibria.pressed_friction import held_by_friction
from centrode.dynamics.load_coordinates import Spin, Turn

Array: TypeAlias = npt.NDArray[np.float64]

STEP = 0.03
"""Between neighbours [rad, or of the greatest length]."""
SHORTEST = 1e-5
MOST_STEPS = 6000
FAR = 20.0
"""Displacements beyond this many greatest lengths are not followed."""
TURNS = 1
"""Rounds in each sense where the loads do not repeat with the position."""


@dataclass(frozen=True)
class ConfigurationCurve:
    """Positions one behind the other.

    Attributes
    ----------
    loaded : whose positions
    places : (n, coordinates) [rad or m]
    tangents : (n, coordinates), in the sense of the curve, of unit length in the units of the coordinates
    start : number of the initial position
    closed : the last position is the first one again
    """

    loaded: LoadedMechanism
    places: Array
    tangents: Array
    start: int
    closed: bool

    @cached_property
    def equations(self) -> LinearEquations:
        """The equations at all positions."""
        return self.loaded.at(self.places)

    @cached_property
    def force(self) -> Array:
        """Generalised force along the curve (n) [J per rad or per greatest length]."""
        return np.asarray(np.einsum("nc,nc->n", self.equations.force, self.tangents))

    @cached_property
    def friction(self) -> Array:
        """Greatest generalised dry friction along the curve (n), in the unit of the force."""
        return held_by_friction(self.loaded, self.places, self.equations, self.tangents)


def repeats_with_position(loaded: LoadedMechanism) -> bool:
    """Whether whole turns of links change no load: none depends on the value of an angle but by its sine and cosine."""
    terms = [load.term for load in loaded.equations.loads]
    terms += [friction.term for friction in loaded.frictions]
    if any(isinstance(one.measures, Turn | Spin) and one.uses_place for one in loaded.equations.controls):
        return False
    return not any(
        "q" in term.amount.uses or ("x" in term.amount.uses and isinstance(term.coordinate, Turn | Spin))
        for term in terms
    )


def same_position(loaded: LoadedMechanism, places: Array, other: Array) -> Array:
    """How far positions (n, coordinates) are from another one (coordinates), whole turns being none."""
    apart = (places - other) / loaded.units
    turned = np.abs(2.0 * np.sin(0.5 * apart))
    return np.asarray(np.max(np.where(loaded.angles, turned, np.abs(apart)), axis=-1, initial=0.0))


def configuration_curve(loaded: LoadedMechanism) -> ConfigurationCurve:
    """The curve of positions through the initial one of a mechanism with one degree of freedom."""
    begin = loaded.start
    repeats = repeats_with_position(loaded)
    rounds = 1 if repeats else TURNS
    tangent = _tangent(loaded, begin, None)
    ahead, closed = _walk(loaded, begin, tangent, rounds)
    if closed and repeats:
        behind: list[tuple[Array, Array]] = []
    else:
        behind, _closed = _walk(loaded, begin, -tangent, rounds)
    whole = [(place, -along) for place, along in reversed(behind)] + [(begin, tangent)] + ahead
    places, tangents = (np.array([pair[k] for pair in whole]) for k in (0, 1))
    return ConfigurationCurve(loaded, places, tangents, len(behind), closed and repeats)


def _tangent(loaded: LoadedMechanism, place: Array, before: Array | None) -> Array:
    """The free direction, going on as before."""
    _left, rows = loaded.closures_at(place[None])
    along = loaded.free_directions(rows)[0, :, 0]
    if before is not None and np.dot(along / loaded.units, before / loaded.units) < 0.0:
        return -along
    return np.asarray(along)


def _walk(
    loaded: LoadedMechanism, begin: Array, tangent: Array, rounds: int
) -> tuple[list[tuple[Array, Array]], bool]:
    """Positions behind one another, with tangents, and whether they come back to the first."""
    found: list[tuple[Array, Array]] = []
    place, along, step, passed = begin, tangent, STEP, 0
    while len(found) < MOST_STEPS:
        longest = float(np.max(np.abs(along / loaded.units)))
        ahead = loaded.closed_coordinates(place + along * (step / longest))
        moved = np.max(np.abs((ahead - place) / loaded.units))
        turned = _tangent(loaded, ahead, along) if np.isfinite(moved) else along
        straight = float(np.dot(turned / loaded.units, along / loaded.units))
        # a place that was closed far off, or a tangent that turned sharply, lies on another branch
        if not moved <= 1.5 * step or straight < 0.9:
            if step > SHORTEST:
                step *= 0.25
                continue
            if not np.isfinite(moved):
                break
        found.append((ahead, turned))
        behind, before = (
            float(np.dot(_way(loaded, one - begin), tangent / loaded.units)) for one in (place, ahead)
        )
        near = same_position(loaded, ahead[None], begin)[0] < 1.5 * STEP
        if (
            behind < 0.0 <= before
            and near
            and float(np.dot(turned / loaded.units, tangent / loaded.units)) > 0.5
        ):
            passed += 1
            if passed == rounds:
                return found, True
        if _is_far(loaded, ahead):
            break
        place, along, step = ahead, turned, min(STEP, 2.0 * step)
    return found, False


def _way(loaded: LoadedMechanism, apart: Array) -> Array:
    """A change of the coordinates in their units, angles by less than half a turn."""
    scaled = apart / loaded.units
    return np.where(loaded.angles, np.remainder(scaled + np.pi, 2.0 * np.pi) - np.pi, scaled)


def _is_far(loaded: LoadedMechanism, place: Array) -> bool:
    slid = [
        abs(x / unit)
        for x, unit, one in zip(place, loaded.units, loaded.coordinates, strict=False)
        if one.kind != "angle"
    ]
    return max(slid, default=0.0) > FAR
