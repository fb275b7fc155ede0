"""Dyads as they are taught: tangential parts by moments of one link, the rest where two directions close the polygon.

A dyad has two bodies, a and b, an outer joint of each and one inner joint, each a hinge (R; or a rolling contact)
or a guide (P). Kinds are named outer, inner, outer: RRR, RRP, RPR, PRP, RPP.
"""

from __future__ import annotations

from dataclasses import dataclass

from centrode.analysis.graphic.board import cross, dot
from centrode.dynamics.force_polygons.actions import Action
from centrode.dynamics.force_polygons.joints import Joint
from centrode.dynamics.force_polygons.ledger import SINGULAR, Ledger, across, dead_point
from centrode.dynamics.force_polygons.partition import Cell
from centrode.dynamics.force_polygons.sides import Dyad, Side
from centrode.dynamics.force_polygons.words import Words

KINDS = ("RRR", "RRP", "RPR", "PRP", "RPP")


@dataclass(frozen=True)
class Found:
    """Reactions of a group.

    Attributes
    ----------
    forces : joint, force and moment on a body of share 1
    chain : forces on the group in the order of its polygon, reactions in parts where they were found in parts
    marks : special points of the construction, by name
    """

    forces: tuple[tuple[Joint, complex, float], ...]
    chain: tuple[Action, ...]
    marks: tuple[tuple[str, complex], ...] = ()


def dyad_of(cell: Cell) -> Dyad | None:
    """The dyad that two bodies make, or nothing."""
    if len(cell.bodies) != 2 or len(cell.joints) != 3 or len(cell.inner) != 1:
        return None
    (inner,) = cell.inner
    outer = [joint for joint in cell.joints if joint is not inner]
    sides = [Side(body, joint) for body in cell.bodies for joint in outer if body in joint.shares]
    if {side.body for side in sides} != set(cell.bodies) or len(sides) != 2:
        return None
    sides.sort(key=lambda side: "RP".find(side.joint.letter))
    dyad = Dyad(sides[0], sides[1], inner)
    return dyad if dyad.kind in KINDS else None


def solve_dyad(dyad: Dyad, ledger: Ledger, words: Words) -> Found:
    """Reactions of a dyad; MotionError at its dead points."""
    solver = _by_hinge if dyad.inner.letter == "R" else _by_guide
    first, second, chain = solver(dyad, ledger, words)
    inner = -(dyad.first.known(ledger) + first)
    share = dyad.inner.shares[dyad.first.body]
    on_inner = ledger.reaction(dyad.inner, dyad.first.body, share * inner)
    words.closing(dyad.first.body, ledger, dyad.first.joint, on_inner)
    turning = _moments(dyad, ledger, words, first, second, inner)
    ends = ((dyad.first, first), (dyad.second, second))
    forces = [(side.joint, side.joint.shares[side.body] * force) for side, force in ends]
    forces.append((dyad.inner, share * inner))
    return Found(tuple((joint, force, turning.get(id(joint), 0.0)) for joint, force in forces), tuple(chain))


def _by_hinge(dyad: Dyad, ledger: Ledger, words: Words) -> tuple[complex, complex, list[Action]]:
    """RRR, RRP, PRP: the unknown parts of both outer reactions close the polygon of the group."""
    parts = [split(side, dyad.inner, ledger, words) for side in (dyad.first, dyad.second)]
    (one, along), (other, beside) = parts
    known = dyad.first.known(ledger) + dyad.second.known(ledger) + one + other
    sine = across(along, beside)
    normal, thrust = -cross(known, beside) / sine * along, cross(known, along) / sine * beside
    words.polygon(dyad, ledger)
    chain = [
        *parts_of(dyad.first, ledger, normal, one, last=True),
        *forces_on(ledger, dyad.first.body),
        *forces_on(ledger, dyad.second.body),
        *parts_of(dyad.second, ledger, thrust, other, last=False),
    ]
    return one + normal, other + thrust, chain


def split(side: Side, inner: Joint, ledger: Ledger, words: Words) -> tuple[complex, complex]:
    """The known part of an outer reaction and the unit vector of what is left of it."""
    if side.joint.letter == "P":
        return 0j, 1j * side.joint.along
    arm = side.joint.place - inner.place
    if abs(arm) <= SINGULAR * ledger.scale:
        dead_point()
    radial = arm / abs(arm)
    size = -ledger.moment([side.body], inner.place) / abs(arm)
    words.tangential(side, inner, ledger, abs(arm), size)
    return size * 1j * radial, radial


def _by_guide(dyad: Dyad, ledger: Ledger, words: Words) -> tuple[complex, complex, list[Action]]:
    """RPR, RPP: along the inner guide each link is in equilibrium by itself."""
    along, normal = dyad.inner.along, 1j * dyad.inner.along
    first, second = dyad.first, dyad.second
    w1, w2 = first.known(ledger), second.known(ledger)
    part = -dot(w1, along)
    words.along_guide(first, dyad.inner, ledger, part)
    if second.joint.letter == "P":
        thrust_along = 1j * second.joint.along
        sine = across(normal, thrust_along)
        known = w1 + w2 + part * along
        left, thrust = (
            -cross(known, thrust_along) / sine * normal,
            cross(known, normal) / sine * thrust_along,
        )
        words.polygon(dyad, ledger)
    else:
        arm = first.joint.place - second.joint.place
        reach = dot(arm, along)
        if abs(reach) <= SINGULAR * max(abs(arm), SINGULAR * ledger.scale):
            dead_point()
        turning = ledger.moment([first.body, second.body], second.joint.place)
        left = -(turning + part * cross(arm, along)) / reach * normal
        words.about_far_hinge(dyad, ledger, part, cross(arm, along), reach, dot(left, normal))
        thrust = -(w1 + w2 + part * along + left)
        words.polygon(dyad, ledger)
    chain = [
        *parts_of(first, ledger, left, part * along, last=True),
        *forces_on(ledger, first.body),
        *forces_on(ledger, second.body),
        ledger.reaction(second.joint, second.body, second.joint.shares[second.body] * thrust),
    ]
    return part * along + left, thrust, chain


def forces_on(ledger: Ledger, body: str) -> list[Action]:
    """The known forces on a body that are more than moments."""
    return [action for action in ledger.actions[body] if action.force != 0]


def parts_of(side: Side, ledger: Ledger, normal: complex, tangential: complex, last: bool) -> list[Action]:
    """An outer reaction in its two parts, or whole where it has one; the normal part at the polygon's end."""
    share = side.joint.shares[side.body]
    if side.joint.letter == "P":
        return [ledger.reaction(side.joint, side.body, share * normal)]
    found = []
    for mark, part in (("ⁿ", normal), ("ᵗ", tangential)):
        whole = ledger.reaction(side.joint, side.body, share * part)
        symbol = ledger.symbol(side.joint, side.body) + mark
        found.append(Action(symbol, whole.label, side.body, "reaction", part, side.joint.place))
    return found if last else found[::-1]


def _moments(
    dyad: Dyad, ledger: Ledger, words: Words, first: complex, second: complex, inner: complex
) -> dict[int, float]:
    """Moments of guides on bodies of share 1, by the joint's identity: about the place of the guide."""
    found: dict[int, float] = {}
    if dyad.inner.letter == "P":
        at = dyad.inner.place
        arm = dyad.first.joint.place - at
        moment = -(ledger.moment([dyad.first.body], at) + cross(arm, first))
        found[id(dyad.inner)] = dyad.inner.shares[dyad.first.body] * moment
        words.guide_moment(dyad.inner, dyad.first.body, ledger, moment, inner)
    for side, force in ((dyad.first, first), (dyad.second, second)):
        if side.joint.letter != "P":
            continue
        at = side.joint.place
        hold = -inner if side is dyad.second else inner
        inside = dyad.inner.shares[side.body] * found.get(id(dyad.inner), 0.0)
        moment = -(ledger.moment([side.body], at) + cross(dyad.inner.place - at, hold) + inside)
        found[id(side.joint)] = side.joint.shares[side.body] * moment
        words.guide_moment(side.joint, side.body, ledger, moment, force)
    return found
