"""Triads of the third class: a base link on three links with one outer joint each, by an Assur point.

The tangential part of each outer reaction follows from moments of its link about the inner hinge. What is left acts on
the base along three known lines. About the point where two of them meet, an Assur point, moments give the third;
then the polygon closes along two directions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

from centrode.analysis.graphic.board import cross
from centrode.dynamics.force_polygons.actions import Action, total
from centrode.dynamics.force_polygons.dyads import Found, forces_on, parts_of, split
from centrode.dynamics.force_polygons.joints import Joint
from centrode.dynamics.force_polygons.ledger import SINGULAR, Ledger
from centrode.dynamics.force_polygons.partition import Cell
from centrode.dynamics.force_polygons.sides import Side
from centrode.dynamics.force_polygons.words import Words, joint_words
from centrode.locale import _


@dataclass(frozen=True)
class Leg:
    """A link between the base and its outer joint: what is known of its reaction, and along what the rest lies."""

    side: Side
    inner: Joint
    part: complex = 0j
    along: complex = 0j

    @property
    def hinge(self) -> complex:
        """Place of the inner hinge."""
        return self.inner.place


@dataclass(frozen=True)
class Triad:
    """The base link and its three legs."""

    base: str
    legs: tuple[Leg, Leg, Leg]


def triad_of(cell: Cell) -> Triad | None:
    """The triad that four bodies make, or nothing."""
    if len(cell.bodies) != 4 or len(cell.joints) != 6 or len(cell.inner) != 3:
        return None
    base = next((body for body in cell.bodies if all(body in joint.shares for joint in cell.inner)), None)
    if base is None or any(joint.letter != "R" for joint in cell.inner):
        return None
    legs = []
    for inner in cell.inner:
        body = inner.other(base)
        outer = [joint for joint in cell.of(body) if joint is not inner]
        if len(outer) != 1 or not outer[0].letter:
            return None
        legs.append(Leg(Side(body, outer[0]), inner))
    return Triad(base, (legs[0], legs[1], legs[2]))


def solve_triad(triad: Triad, ledger: Ledger, words: Words) -> Found | None:
    """Reactions of a triad; nothing where its three lines have no Assur point to use."""
    told = Words()
    legs = []
    for leg in triad.legs:
        part, along = split(leg.side, leg.inner, ledger, told)
        legs.append(Leg(leg.side, leg.inner, part, along))
    first, second = max(
        combinations(range(3), 2), key=lambda pair: abs(cross(legs[pair[0]].along, legs[pair[1]].along))
    )
    third = 3 - first - second
    one, other, last = legs[first], legs[second], legs[third]
    sine = cross(one.along, other.along)
    if abs(sine) <= SINGULAR:
        return None
    point = one.hinge + cross(other.hinge - one.hinge, other.along) / sine * one.along
    reach = cross(last.hinge - point, last.along)
    if abs(reach) <= SINGULAR * max(ledger.scale, abs(last.hinge - point)):
        return None
    carried = [leg.side.known(ledger) + leg.part for leg in legs]
    turning = ledger.moment([triad.base], point)
    turning += sum(cross(leg.hinge - point, force) for leg, force in zip(legs, carried, strict=True))
    sizes = [0.0, 0.0, 0.0]
    sizes[third] = -turning / reach
    known = total(ledger.actions[triad.base]) + sum(carried, 0j) + sizes[third] * last.along
    sizes[first] = -cross(known, other.along) / sine
    sizes[second] = cross(known, one.along) / sine
    words.lines += told.lines
    _tell(triad, ledger, words, (one, other, last), (turning, reach, sizes[third]))
    return replace(_found(triad, ledger, legs, sizes), marks=(("S", point),))


def _tell(
    triad: Triad,
    ledger: Ledger,
    words: Words,
    legs: tuple[Leg, Leg, Leg],
    numbers: tuple[float, float, float],
) -> None:
    """The moments about the Assur point, and the polygon."""
    turning, reach, size = numbers
    one, other, last = (
        ledger.symbol(leg.side.joint, leg.side.body) + ("ⁿ" if leg.side.joint.letter == "R" else "")
        for leg in legs
    )
    names = [joint_words(leg.inner) for leg in legs[:2]]
    words.say(
        _("Assur point S of the lines of {one} through {first} and {other} through {second}").format(
            one=one, other=other, first=names[0], second=names[1]
        )
    )
    words.say(
        _("moments of base {link} about S, what the links carry at their hinges included: {equation}").format(
            link=ledger.bodies.number(triad.base),
            equation=f"{last}·{reach:.5g} {'-' if turning < 0 else '+'} {abs(turning):.5g} = 0,"
            f" {last} = {size:.6g} N",
        )
    )
    words.say(_("the polygon of the group closes along {one} and {other}").format(one=one, other=other))


def _found(triad: Triad, ledger: Ledger, legs: list[Leg], sizes: list[float]) -> Found:
    """Reactions of all joints, and the polygon of the group."""
    forces: list[tuple[Joint, complex, float]] = []
    chain: list[Action] = []
    for number, (leg, size) in enumerate(zip(legs, sizes, strict=True)):
        body, joint, inner = leg.side.body, leg.side.joint, leg.inner
        held = leg.part + size * leg.along
        carried = leg.side.known(ledger) + held
        moment = 0.0
        if joint.letter == "P":
            moment = -(ledger.moment([body], joint.place) - cross(inner.place - joint.place, carried))
        forces.append((joint, joint.shares[body] * held, joint.shares[body] * moment))
        forces.append((inner, inner.shares[triad.base] * carried, 0.0))
        parts = parts_of(leg.side, ledger, size * leg.along, leg.part, last=number == 0)
        chain += [*parts, *forces_on(ledger, body)] if number == 0 else [*forces_on(ledger, body), *parts]
        if number == 0:
            chain += forces_on(ledger, triad.base)
    return Found(tuple(forces), tuple(chain))
