"""Groups that are no dyads: input links with what drives them, single links, and groups solved together."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from centrode.analysis.graphic.board import cross, dot
from centrode.dynamics.force_polygons.actions import total
from centrode.dynamics.force_polygons.dyads import Found
from centrode.dynamics.force_polygons.joints import Joint
from centrode.dynamics.force_polygons.ledger import SINGULAR, Ledger, dead_point
from centrode.dynamics.force_polygons.partition import Cell
from centrode.dynamics.force_polygons.words import Words, joint_words
from centrode.locale import _

Array: TypeAlias = npt.NDArray[np.float64]


def solve_single(cell: Cell, ledger: Ledger, words: Words) -> Found | None:
    """A link by itself: on a hinge with one more unknown, or on a guide along which it is driven; else nothing."""
    if len(cell.bodies) != 1 or len(cell.joints) != 2:
        return None
    pivot = next((joint for joint in cell.joints if len(joint.bases) == 2), None)
    other = next((joint for joint in cell.joints if len(joint.bases) == 1), None)
    if pivot is None or other is None:
        return None
    if pivot.letter == "R":
        return _on_hinge(cell.bodies[0], pivot, other, ledger, words)
    if abs(dot(other.bases[0][0], pivot.along)) > SINGULAR:
        return _on_guide(cell.bodies[0], pivot, other, ledger, words)
    return None


def _on_hinge(body: str, pivot: Joint, other: Joint, ledger: Ledger, words: Words) -> Found:
    """Moments about the hinge give the other unknown, the link's polygon then the reaction of the hinge."""
    (unit, turn) = other.bases[0]
    share = other.shares[body]
    factor = turn + cross(other.place - pivot.place, unit)
    arm = abs(other.place - pivot.place)
    if abs(factor) <= SINGULAR * max(turn, arm):
        dead_point()
    turning = ledger.moment([body], pivot.place)
    size = -turning / (share * factor)
    acts = ledger.reaction(other, body, size * unit, size * turn)
    known = ledger.told([body], pivot.place)
    unknown = f"{acts.symbol}·{share * factor:.5g}" if unit or share * factor != 1.0 else acts.symbol
    symbol = acts.symbol if share > 0 else acts.symbol.removeprefix("−")
    unit_name = "N" if unit else "N m"
    value = size if other.kind == "drive" else share * size
    if other.kind != "drive":
        unknown = f"{acts.symbol}·{factor:.5g}" if unit else acts.symbol
    elif not unit:
        unknown = symbol if share > 0 else f"−{symbol}"
    words.about(body, pivot, ledger, f"{unknown}{known} = 0, {symbol} = {value:.6g} {unit_name}")
    force = -(total(ledger.actions[body]) + acts.force)
    hold = ledger.reaction(pivot, body, pivot.shares[body] * force)
    chain = [action for action in [*ledger.actions[body], acts, hold] if action.force != 0]
    words.closing(body, ledger, other if unit else None, hold)
    return Found(((other, size * unit, size * turn), (pivot, pivot.shares[body] * force, 0.0)), tuple(chain))


def _on_guide(body: str, guide: Joint, other: Joint, ledger: Ledger, words: Words) -> Found:
    """A slider: what pushes it along the guide is the other unknown, square to it the guide holds."""
    known, along = total(ledger.actions[body]), guide.along
    unit = other.bases[0][0]
    size = -dot(known, along) / (other.shares[body] * dot(unit, along))
    push = ledger.reaction(other, body, size * unit)
    thrust = -cross(along, known + push.force) * 1j * along
    moment = -(ledger.moment([body], guide.place) + push.about(guide.place))
    share = guide.shares[body]
    hold = ledger.reaction(guide, body, share * thrust, share * moment)
    words.say(
        _("link {link} along guide {guide}: {equation}").format(
            link=ledger.bodies.number(body),
            guide=guide.name,
            equation=f"|{push.symbol}| = {abs(push.force):.6g} N",
        )
    )
    words.closing(body, ledger, other, hold)
    words.guide_moment(guide, body, ledger, moment, thrust)
    chain = [action for action in [*ledger.actions[body], push, hold] if action.force != 0]
    forces = ((other, size * unit, 0.0), (guide, share * thrust, share * moment))
    return Found(forces, tuple(chain))


def solve_together(cell: Cell, ledger: Ledger, words: Words) -> Found:
    """All equations of equilibrium of a group at once; MotionError where they are singular to rounding."""
    unknowns = [(joint, *basis) for joint in cell.joints for basis in joint.bases]
    scale = ledger.scale
    rows: list[list[float]] = []
    right: list[float] = []
    for body in cell.bodies:
        # about a place of the body itself, so that far origins cost no digits
        centre = next((j.place for j in cell.of(body) if j.kind not in ("mesh", "drive")), 0j)
        columns = [_column(joint, unit, turn, body, centre, scale) for joint, unit, turn in unknowns]
        known = total(ledger.actions[body])
        sides = [-known.real, -known.imag, -ledger.moment([body], centre) / scale]
        count = 2 if body in ledger.bodies.pins else 3
        rows += [[column[row] for column in columns] for row in range(count)]
        right += sides[:count]
    values = _solved(np.array(rows), np.array(right))
    words.say(
        _("solved together: {equations} equations of equilibrium of {links}").format(
            equations=len(rows), links=", ".join(str(ledger.bodies.number(body)) for body in cell.bodies)
        )
    )
    forces = []
    for joint in cell.joints:
        force, moment = 0j, 0.0
        for (owner, unit, turn), value in zip(unknowns, values, strict=True):
            if owner is joint:
                force, moment = force + value * unit, moment + value * scale * turn
        forces.append((joint, force, moment))
        _tell(joint, force, moment, cell, ledger, words)
    known_ones = [action for action in ledger.on(cell.bodies) if action.force != 0]
    outer = [
        ledger.reaction(joint, body, force, moment)
        for joint, force, moment in forces
        for body in cell.bodies
        if body in joint.shares and not any(joint is inner for inner in cell.inner)
    ]
    return Found(tuple(forces), tuple([*known_ones, *(one for one in outer if one.force != 0)]))


def _column(
    joint: Joint, unit: complex, turn: float, body: str, centre: complex, scale: float
) -> tuple[float, float, float]:
    """What a unit of an unknown does on a body: force and moment over the scale; moments are counted in scales."""
    share = joint.shares.get(body, 0.0)
    moment = cross(joint.place - centre, unit) / scale + turn if share else 0.0
    return share * unit.real, share * unit.imag, share * moment


def _solved(matrix: Array, right: Array) -> Array:
    """The solution, with columns and rows of one size; refuses what is singular to rounding."""
    across = np.abs(matrix).max(axis=0)
    if not (across > 0).all():
        dead_point()
    scaled = matrix / across
    down = np.abs(scaled).max(axis=1)
    if not (down > 0).all():
        dead_point()
    scaled = scaled / down[:, None]
    sizes = np.linalg.svd(scaled, compute_uv=False)
    if sizes[-1] <= SINGULAR * sizes[0]:
        dead_point()
    return np.asarray(np.linalg.solve(scaled, right / down) / across)


def _tell(joint: Joint, force: complex, moment: float, cell: Cell, ledger: Ledger, words: Words) -> None:
    """One reaction that was found with others."""
    bodies = [name for name in cell.bodies if name in joint.shares]
    body = max(bodies, key=lambda name: joint.shares[name])
    action = ledger.reaction(joint, body, force, moment)
    parts = [f"|{action.symbol}| = {abs(action.force):.6g} N"] if action.force else []
    if joint.kind == "guide":
        parts.append(f"M{action.symbol.removeprefix('R')} = {action.moment:.6g} N m")
    elif joint.kind in ("mesh", "drive") and not joint.has_force:
        parts = [f"{action.symbol} = {action.moment:.6g} N m"]
    if parts:
        words.say(f"{joint_words(joint)}: {', '.join(parts)}")
