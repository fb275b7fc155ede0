"""Full balance of the shaking force: the common centre of mass is brought to rest.

The sum of mass times place of all links is to be constant. Places of bases and rotors of links with counterweights
are functions of the drive; where the sum lies in their span (with constants) the counterweights follow from linear
equations: the method of linearly independent vectors (R. S. Berkof, G. G. Lowen, Journal of Engineering for Industry
91, 1969, 21-26) by numbers in place of the closure of loops.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from centrode.dynamics.balancing.counterweights import Spot, mass_moments
from centrode.dynamics.balancing.inertial import Complex
from centrode.dynamics.balancing.turning import Turning

INSTANTS = 90
"""Values of the drive in a turn at which the sum is looked at."""
SAME = 1e-9
"""What is left of the sum, over the sum of masses times the greatest length, that counts as rounding."""
MOST_ROUNDS = 60
SETTLED = 1e-14


@dataclass(frozen=True)
class FullBalance:
    """Products of mass and radius (spots) in the axes of their links [kg m].

    Attributes
    ----------
    left : float
        What is left of the sum of mass times place, over all masses times the greatest length.
    unique : bool
        Whether no other counterweights on these links do the same.
    """

    products: Complex
    left: float
    unique: bool

    @property
    def complete(self) -> bool:
        """Whether the centre of mass is at rest."""
        return self.left <= SAME


def full_balance(turning: Turning, spots: Sequence[Spot]) -> FullBalance:
    """The counterweights on given links that come nearest to a centre of mass at rest.

    The mass of a counterweight whose base moves acts on what carries it, so it is found in rounds.
    """
    values = turning.values(INSTANTS * turning.turns)
    state, tracks = turning.at(values)
    mass = np.array([one.mass for one in turning.masses])
    own = _swing(mass @ tracks.places[0])
    pairs = [mass_moments(state, spot) for spot in spots]
    bases = np.array([_swing(base) for base, _rotor in pairs]).reshape(len(spots), len(values))
    rotors = np.array([_swing(rotor) for _base, rotor in pairs]).reshape(len(spots), len(values))
    products = np.zeros(len(spots), dtype=np.complex128)
    rank = len(spots)
    for _round in range(MOST_ROUNDS):
        masses = np.array([spot.making.made(abs(s)).mass for spot, s in zip(spots, products, strict=True)])
        before = products
        if len(spots):
            products, _rest, rank, _sizes = np.linalg.lstsq(rotors.T, -(own + masses @ bases), rcond=SAME)
        if np.max(np.abs(products - before), initial=0.0) <= SETTLED * float(mass.sum()) * state.scale:
            break
    masses = np.array([spot.making.made(abs(s)).mass for spot, s in zip(spots, products, strict=True)])
    rest = own + masses @ bases + products @ rotors
    whole = float(mass.sum() + masses.sum()) * state.scale
    return FullBalance(products, float(np.max(np.abs(rest))) / whole, int(rank) == len(spots))


def _swing(places: Complex) -> Complex:
    """Places less their mean."""
    return np.asarray(places - places.mean())


def enough_spots(turning: Turning, candidates: Sequence[Spot]) -> list[Spot]:
    """As few of the candidates, the first ones before the others, as balance the mechanism; all if none do."""
    hung = [spot for spot in candidates if spot.fixed]
    chosen = list(hung)
    for spot in [one for one in candidates if not one.fixed]:
        if full_balance(turning, chosen).complete:
            break
        chosen.append(spot)
    if not full_balance(turning, chosen).complete:
        return list(candidates)
    for spot in reversed(list(chosen)):
        fewer = [one for one in chosen if one is not spot]
        if full_balance(turning, fewer).complete:
            chosen = fewer
    return chosen
