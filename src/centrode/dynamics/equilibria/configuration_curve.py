"""All positions of a mechanism with one degree of freedom that it reaches without being taken apart, as a curve."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.dynamics.equilibria.linear_equations import LinearEquations, LoadedMechanism
from centrode.dynamics.equilibria.pressed_friction import held_by_friction
from centrode.dynamics.load_coordinates import Coordinate, Spin, Turn
from centrode.dynamics.loads import LoadTerm
from centrode.numerics.arrays import ARRAYS
from centrode.numerics.jets import Jet

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
    def round_trip(self) -> Array:
        """Whole turns of the angles (coordinates) [rad] on the way round a closed curve; none on an open one."""
        apart = self.places[-1] - self.places[self.start]
        turns = 2.0 * np.pi * np.round(apart / (2.0 * np.pi))
        return np.where(self.loaded.angles & self.closed, turns, 0.0)

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
    return not counts_drive(loaded) and not counted_turns(loaded)


def counts_drive(loaded: LoadedMechanism) -> bool:
    """Whether a load depends on the value of the drive, turns and all."""
    return any("q" in term.amount.uses for term in _terms(loaded))


def counted_turns(loaded: LoadedMechanism) -> tuple[Turn | Spin, ...]:
    """Angles whose values loads and controllers depend on, turns and all: torsion springs and the like."""
    found = [term.coordinate for term in _terms(loaded) if "x" in term.amount.uses]
    found += [one.measures for one in loaded.equations.controls if one.measures and one.uses_place]
    return tuple(dict.fromkeys(one for one in found if isinstance(one, Turn | Spin)))


def _terms(loaded: LoadedMechanism) -> list[LoadTerm]:
    loads = [load.term for load in loaded.equations.loads]
    return loads + [friction.term for friction in loaded.frictions]


def counted_values(loaded: LoadedMechanism, places: Array) -> Array:
    """Values of the counted turns (n, turns) [rad] at positions (n, coordinates)."""
    return coordinate_values(loaded, counted_turns(loaded), places)


def coordinate_values(loaded: LoadedMechanism, asked: Sequence[Coordinate], places: Array) -> Array:
    """Values of coordinates of loads or stops (n, asked) [rad or m] at positions (n, coordinates)."""
    tree, places = loaded.equations.tree, places[:, : loaded.joints]
    jets = [Jet((x, np.zeros(len(places)), np.zeros(len(places)))) for x in places.T]
    state = loaded.equations.state(ARRAYS, tree.values(ARRAYS, list(places.T)), jets, 0.0)
    found = [one.value(state) for one in asked]
    return np.array([np.broadcast_to(x, len(places)) for x in found]).reshape(len(asked), len(places)).T


def uncounted_angles(loaded: LoadedMechanism) -> npt.NDArray[np.bool_]:
    """Which coordinates are angles whose whole turns change no load, whatever the others are."""
    if counts_drive(loaded):
        return np.zeros_like(loaded.angles)
    # a turn that counts changes a value by radians, one that does not by rounding: anything between tells them apart
    turned = np.vstack([loaded.start, loaded.start + 2.0 * np.pi * np.eye(loaded.size)])
    # wheels that mesh close by the values of their angles
    left, _rows = loaded.closures_at(turned)
    values = np.concatenate([counted_values(loaded, turned), left / loaded.equation_units], axis=1)
    return np.asarray(loaded.angles & np.all(np.abs(values[1:] - values[0]) < 1e-3, axis=1))


def position_distance(loaded: LoadedMechanism, places: Array, other: Array) -> Array:
    """How far positions (n, coordinates) are from another one in all that loads depend on: whole turns that none of
    them counts are none.
    """
    if counts_drive(loaded):
        return np.asarray(np.max(np.abs((places - other) / loaded.units), axis=-1, initial=0.0))
    found = same_position(loaded, places, other)
    if not counted_turns(loaded):
        return found
    counted = counted_values(loaded, np.concatenate([places, other[None]]))
    return np.asarray(np.maximum(found, np.max(np.abs(counted[:-1] - counted[-1]), axis=1)))


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
