"""Balance of the shaking moment: discs that turn against links hinged to the frame, and inertia added to the others.

Once the force is balanced, the moment of momentum does not depend on the place it is taken about. Where it is a sum
of constants times the angular velocities of the links, discs geared one to one against the links on the frame cancel
their shares. Of an in-line four-bar the coupler has no share if it is a physical pendulum, k^2 = r r' with r, r' the
distances of its centre of mass from its joints (R. S. Berkof, Mechanism and Machine Theory 8, 1973, 397-410).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from centrode.dynamics.balancing.counterweights import replaced, stiffened
from centrode.dynamics.balancing.full import INSTANTS
from centrode.dynamics.balancing.inertial import Array, Tracks, cross, orders
from centrode.dynamics.balancing.reachable import hinged_from
from centrode.dynamics.balancing.turning import Turning, heavy
from centrode.dynamics.masses import Mass
from centrode.errors import MotionError
from centrode.locale import _
from centrode.model.mechanism import Link, Mechanism
from centrode.model.pairs import Gear

SAME = 1e-9
"""What is left of the moment of momentum, over the sum of its parts, that counts as rounding."""


@dataclass(frozen=True)
class Disc:
    """Inertia that balances the shaking moment.

    Attributes
    ----------
    link : str
        The link it is geared to, one to one, or fixed to.
    base : str or None
        The point of the frame about which it turns against the link; None where it is fixed to the link.
    inertia : float [kg m^2]
    """

    link: str
    base: str | None
    inertia: float


def discs_for(turning: Turning, mechanism: Mechanism) -> tuple[Disc, ...]:
    """The discs that balance the moment of a mechanism whose force is balanced.

    Raises MotionError where none do: the links are not in line, or a link has more inertia than it may have.
    """
    values = turning.values(INSTANTS * turning.turns)
    state, tracks = turning.at(values)
    momentum, size = _momentum(tracks, turning.masses)
    hinged = hinged_from(mechanism)
    names = [name for name in mechanism.links if _turns(orders(state.angle(name), len(values))[1])]
    rates = np.array([orders(state.angle(name), len(values))[1] for name in names])
    found, _rest, _rank, _sizes = np.linalg.lstsq(rates.T, momentum, rcond=SAME)
    left = float(np.max(np.abs(momentum - found @ rates), initial=0.0))
    if left > SAME * size:
        raise MotionError(
            "",
            _("no discs balance the shaking moment: {share:.2%} of it would be left").format(
                share=left / float(np.max(np.abs(momentum)))
            ),
            _("put the centres of mass of the links on the lines between their joints"),
        )
    discs = []
    for name, inertia in zip(names, found, strict=True):
        if abs(inertia) * float(np.max(np.abs(rates))) <= SAME * size:
            continue
        base = hinged.get(name)
        if inertia > 0.0 and base in mechanism.frame.points:
            discs.append(Disc(name, base, float(inertia)))
        elif inertia < 0.0:
            discs.append(Disc(name, None, -float(inertia)))
        else:
            raise _too_much(name, float(inertia))
    return tuple(discs)


def _momentum(tracks: Tracks, masses: Sequence[Mass]) -> tuple[Array, float]:
    """Moment of momentum at unit speed of the drive (n), and the greatest sum of the sizes of its parts."""
    mass, inertia = (np.array([getattr(one, name) for one in masses]) for name in ("mass", "inertia"))
    middle = tracks.places[0].mean()
    parts = [mass[:, None] * cross(tracks.places[0] - middle, tracks.places[1])]
    parts.append(inertia[:, None] * tracks.angles[1])
    whole = np.concatenate(parts)
    return whole.sum(axis=0), float(np.max(np.abs(whole).sum(axis=0)))


def _turns(rate: Array) -> bool:
    return bool(np.max(np.abs(rate)) > SAME)


def _too_much(link: str, surplus: float) -> MotionError:
    what = _(
        "the shaking moment cannot be balanced: the inertia of {link} is {surplus:.6g} kg m² too great, and it is"
        " not hinged to the frame, where a disc could turn against it"
    )
    return MotionError(
        f"[links.{link}]",
        what.format(link=link, surplus=surplus),
        _(
            "make it a physical pendulum: less inertia, or its centre of mass nearer to the middle of its joints"
        ),
    )


def with_discs(mechanism: Mechanism, discs: Sequence[Disc]) -> Mechanism:
    """The description with the discs: fixed ones in the inertia of their links, the others as links with gears."""
    links, gears = dict(mechanism.links), list(mechanism.gears)
    own = {mass.link: mass for mass in heavy(mechanism)}
    for disc in discs:
        if disc.base is None:
            links[disc.link] = stiffened(links[disc.link], own.get(disc.link), disc.inertia)
            continue
        name = disc_name(mechanism, disc.link)
        links[name] = Link(points={disc.base: (0.0, 0.0)}, inertia=disc.inertia)
        gears.append(Gear(links=(disc.link, name), ratio=-1.0))
    return replaced(mechanism, links=links, gears=tuple(gears))


def disc_name(mechanism: Mechanism, link: str) -> str:
    """A name for the disc of a link that no link has."""
    taken = set(mechanism.links)
    name = f"disc {link}"[:40]
    number = 2
    while name in taken:
        name, number = f"disc {number} {link}"[:40], number + 1
    return name
