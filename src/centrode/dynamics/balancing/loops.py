"""Slider-cranks and four-bars by their parts, with masses replaced at joints: the textbook's way to counterweights.

A link's mass with its centre on the line of two joints is replaced by two masses there with the same centre; as complex
numbers also one beside the line: m z_S = m (1 - c) z_P + m c z_Q with c = (S - P)/(Q - P) in the link's axes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from centrode.dynamics.masses import Mass
from centrode.model.mechanism import Mechanism


@dataclass(frozen=True)
class Share:
    """The mass of a link replaced at its joints [kg]; the part beside their line is imaginary."""

    link: str
    first: str
    second: str
    at_first: complex
    at_second: complex


@dataclass(frozen=True)
class Loop:
    """A crank O-A, a coupler A-B, and what B moves with: a rocker B-D, or a guide of the frame.

    `slider` is the mass [kg] that moves with B along the guide besides the coupler's share; 0 with a rocker.
    """

    crank: str
    coupler: str
    rocker: str | None
    O: str
    A: str
    B: str
    D: str | None
    slider: float


def loop_of(mechanism: Mechanism, masses: Sequence[Mass]) -> Loop | None:
    """The four-bar or slider-crank that a mechanism is, driven at the crank; None for any other."""
    if mechanism.gears or mechanism.rolling or len(mechanism.drives) != 1:
        return None
    crank = mechanism.drives[0].link
    fixed = set(mechanism.frame.points)
    joints = {name: _joints(mechanism, name) for name in mechanism.links}
    if crank is None or mechanism.drives[0].relative_to != "frame":
        return None
    own = joints[crank]
    if len(own) != 2 or len(fixed & set(own)) != 1:
        return None
    O = next(point for point in own if point in fixed)
    A = next(point for point in own if point != O)
    couplers = [name for name, points in joints.items() if name != crank and A in points]
    if len(couplers) != 1 or len(joints[couplers[0]]) != 2:
        return None
    B = next(point for point in joints[couplers[0]] if point != A)
    rest = [name for name in mechanism.links if name not in (crank, couplers[0])]
    if not mechanism.guides and len(rest) == 1 and B in joints[rest[0]] and fixed & set(joints[rest[0]]):
        D = next(point for point in joints[rest[0]] if point in fixed)
        return Loop(crank, couplers[0], rest[0], O, A, B, D, 0.0)
    if len(mechanism.guides) == 1 and mechanism.guides[0].on == "frame" and mechanism.guides[0].point == B:
        if len(rest) > 1 or (rest and rest[0] != mechanism.guides[0].link):
            return None
        slider = sum(mass.mass for mass in masses if mass.link in rest)
        return Loop(crank, couplers[0], None, O, A, B, None, float(slider))
    return None


def _joints(mechanism: Mechanism, link: str) -> list[str]:
    """Points of a link that another one, the frame or a guide has too."""
    shared = set(mechanism.frame.points) | {guide.point for guide in mechanism.guides}
    for name, other in mechanism.links.items():
        if name != link:
            shared |= set(other.coordinates)
    return [point for point in mechanism.links[link].coordinates if point in shared]


def share_of(mechanism: Mechanism, masses: Sequence[Mass], link: str, first: str, second: str) -> Share:
    """The mass of a link replaced at two of its points."""
    places = {name: complex(*xy) for name, xy in mechanism.links[link].coordinates.items()}
    for mass in masses:
        if mass.link == link:
            centre = mass.planar_centre
            at = places[centre.base] + complex(centre.along, centre.across)
            c = (at - places[first]) / (places[second] - places[first])
            return Share(link, first, second, mass.mass * (1.0 - c), mass.mass * c)
    return Share(link, first, second, 0j, 0j)


def arm(mechanism: Mechanism, link: str, first: str, second: str) -> complex:
    """The way from one point of a link to another, in its axes [m]."""
    places = mechanism.links[link].coordinates
    return complex(*places[second]) - complex(*places[first])


def shares_of(mechanism: Mechanism, masses: Sequence[Mass], loop: Loop) -> tuple[Share, ...]:
    """Crank, coupler and rocker replaced at their joints; what stands at a fixed joint does not move."""
    found = [
        share_of(mechanism, masses, loop.crank, loop.O, loop.A),
        share_of(mechanism, masses, loop.coupler, loop.A, loop.B),
    ]
    if loop.rocker is not None and loop.D is not None:
        found.append(share_of(mechanism, masses, loop.rocker, loop.D, loop.B))
    return tuple(found)


def fraction_of_slider_crank(
    mechanism: Mechanism, masses: Sequence[Mass], loop: Loop, fraction: float
) -> complex:
    """Product on the crank that balances what turns with its pin and a fraction of what moves to and fro [kg m]."""
    crank, coupler = shares_of(mechanism, masses, loop)
    rotating = crank.at_second + coupler.at_first
    reciprocating = coupler.at_second + loop.slider
    return -(rotating + fraction * reciprocating) * arm(mechanism, loop.crank, loop.O, loop.A)
