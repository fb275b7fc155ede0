"""From a mechanism made ready to its unknowns and constraints in symbols, group by group."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import combinations
from typing import TypeAlias

import numpy as np

from centrode.equations.linear import Draft, LinearConstraint, Unknown, UnknownPlace
from centrode.equations.plane_chains import Chains, shorten
from centrode.equations.symbol_table import SymbolTable
from centrode.equations.symbols import BEARING, LENGTH, RATIO, ZERO, Angle, Letter, Sum, SumTerm
from centrode.errors import InputError
from centrode.kinematics.preparation import Ready
from centrode.locale import _
from centrode.structure.constraints import FRAME, GearRatio, NoSlip
from centrode.structure.gearing import Round, Straight

# Gears and rolling wheels as equations between angles: phi2 - u phi1 = C.

Meshing: TypeAlias = GearRatio | NoSlip


def meshings_of(board: SymbolTable) -> list[Meshing]:
    """Gears and wheels that do not slip."""
    structure = board.ready.structure
    return [
        c
        for c in structure.constraints
        if isinstance(c, (GearRatio, NoSlip)) and c not in structure.redundant
    ]


def mesh(board: SymbolTable, waiting: list[Meshing], draft: Draft) -> None:
    """Write down the equations of gears and wheels whose bodies all have their angles and places."""
    for meshing in list(waiting):
        if isinstance(meshing, GearRatio):
            if all(link in board.angles for link in meshing.links):
                waiting.remove(meshing)
                draft.conditions.append(_gear(board, meshing))
        elif _stands(board, meshing):
            waiting.remove(meshing)
            draft.conditions.append(_rolling_condition(board, meshing, draft))


def _stands(board: SymbolTable, wheel: NoSlip) -> bool:
    return wheel.link in board.angles and wheel.centre in board.points and wheel.on in board.placed


def _gear(board: SymbolTable, gear: GearRatio) -> LinearConstraint:
    ratio = Sum.letter(_factor(board, "u", "ratio", gear.gear, float(board.numbers.gearing.ratio[gear.gear])))
    first, second, carrier = (_variable(board, board.angles[link]) for link in gear.links)
    left = second - ratio * first + (ratio - Sum.number(1)) * carrier
    return _angular(board, f"gear {gear.gear}", left)


def _rolling_condition(board: SymbolTable, wheel: NoSlip, draft: Draft) -> LinearConstraint:
    turn, base = (_variable(board, board.angles[link]) for link in (wheel.link, wheel.on))
    track = board.numbers.gearing.track[wheel.rolling]
    if isinstance(track, Straight):
        radius = board.alphabet.letter(
            LENGTH + 800_000, f"r_{wheel.link}", "radius", (wheel.link,),
            float(board.numbers.gearing.radius[wheel.rolling]), "m",
        )  # fmt: skip
        way = _way(board, wheel, track).divide(SumTerm(((radius, 1),)))
        return _angular(board, f"rolling {wheel.rolling}", turn - base + way)
    spin = Sum.letter(
        _factor(board, "k", "spin", wheel.rolling, float(board.numbers.gearing.spin(wheel.rolling)))
    )
    bearing = _variable(board, _centre_direction(board, wheel, track, draft))
    left = turn - spin * bearing + (spin - Sum.number(1)) * base
    return _angular(board, f"rolling {wheel.rolling}", left)


def _way(board: SymbolTable, wheel: NoSlip, track: Straight) -> Sum:
    """Way of the wheel's centre along its track, up to a constant."""
    x, y = (float(v) for v in track.direction)
    turn = board.alphabet.angle(f"beta_{wheel.rolling}", "angle of guide", (wheel.rolling, wheel.on), (x, y))
    at = board.points[wheel.centre]
    if wheel.on != FRAME:
        at = at.plus(board.points[next(iter(board.local(wheel.on)))], -1)
    return _moving_terms(board, at.along(board.angles[wheel.on].plus(turn)))


def _centre_direction(board: SymbolTable, wheel: NoSlip, track: Round, draft: Draft) -> Angle:
    """Direction from the circle's centre to that of the wheel: of an arm between them, else a letter of its own."""
    centre = (float(track.centre[0]), float(track.centre[1]))
    hub = next((p for p, at in board.local(wheel.on).items() if at == centre), None)
    for link in board.ready.mechanism.links:
        own = board.local(link)
        if hub in own and wheel.centre in own and link in board.angles and link not in (wheel.link, wheel.on):
            return board.angles[link]
    known = next((name for name in board.alphabet.rates if name.name == f"psi_{wheel.rolling}"), None)
    return Angle.of(known) if known is not None else _across(board, wheel, centre, draft)


def _across(board: SymbolTable, wheel: NoSlip, centre: tuple[float, float], draft: Draft) -> Angle:
    """A bearing of its own for a wheel that other links keep on its circle, with the equation that gives it."""
    way = board.at(wheel.centre) - board.world(wheel.on, centre)
    name = f"psi_{wheel.rolling}"
    letter = board.alphabet.moving(
        BEARING + len(board.alphabet.meanings), name, "bearing", (wheel.rolling,), math.atan2(way.imag, way.real),
        "rad", f"omega_{wheel.rolling}",
    )  # fmt: skip
    rate = board.alphabet.rates[letter]
    draft.unknowns.append(Unknown(f"bearing.{wheel.rolling}", letter, rate, board.alphabet.seconds[rate]))
    line = Angle.of(letter)
    at = board.points[wheel.centre].plus(board.spot(wheel.on, centre, wheel.rolling), -1)
    full = board.full[wheel.centre].plus(board.spot(wheel.on, centre, wheel.rolling, full=True), -1)
    draft.conditions.append(
        LinearConstraint(f"bearing {wheel.rolling}", at.across(line), full.across(line), ZERO)
    )
    return line


def _angular(board: SymbolTable, name: str, left: Sum) -> LinearConstraint:
    """An equation between angles; its constant is what the left side is in the initial position."""
    values = board.alphabet.values
    value = left.value(math, lambda letter: values[letter])
    return LinearConstraint(name, left, left, Sum.letter(board.alphabet.constant(value, "rad")))


def _variable(board: SymbolTable, angle: Angle) -> Sum:
    """What moves of an angle, as a sum; the rest goes into the constant."""
    total = ZERO
    for letter, count in angle.parts:
        if letter in board.alphabet.rates:
            total += Sum.letter(letter).scale(count)
    return total


def _moving_terms(board: SymbolTable, total: Sum) -> Sum:
    """A sum without its constant terms."""
    moving = board.alphabet.rates.keys()
    return Sum({term: x for term, x in total.terms.items() if Sum({term: x}).letters & moving})


def _factor(board: SymbolTable, letter: str, kind: str, name: str, value: float) -> Letter:
    several = len(meshings_of(board)) > 1
    number = sum(one.kind == kind for one in board.alphabet.meanings.values()) + 1
    return board.alphabet.letter(
        RATIO + number, f"{letter}{number}" if several else letter, kind, (name,), value, "1"
    )


def assemble_chains(ready: Ready) -> tuple[SymbolTable, tuple[Draft, ...]]:
    """All chains of a planar mechanism, and the groups that have unknowns.

    Raises InputError where constraints and unknowns do not match.
    """
    board = SymbolTable(ready)
    chains, waiting = Chains(board), meshings_of(board)
    groups: list[Draft] = []
    draft = Draft()
    for number, group in enumerate(ready.structure.groups):
        chains.lay(group, number, draft)
        mesh(board, waiting, draft)
        if draft.balance > 0:
            _take_out_repeated(board, draft)
        if draft.balance == 0:
            if draft.unknowns:
                groups.append(draft)
            draft = Draft()
            shorten(board)
    if draft.balance or chains.lines or chains.rods or waiting:
        raise InputError(
            "",
            _("the constraints of this mechanism do not give one vector chain per group"),
            _("solve them numerically"),
        )
    return board, tuple(groups)


def _take_out_repeated(board: SymbolTable, draft: Draft) -> None:
    """Leave out constraints that repeat others, until there are as many as unknowns.

    Of a vector equation that gives one angle only, the component across the closing link stays: it never
    degenerates, as either coordinate does.
    """
    moving = {one.letter for one in draft.unknowns}
    draft.conditions = [one for one in draft.conditions if one.residual.letters & moving]
    for pair in sorted({one.pair for one in draft.conditions if one.pair >= 0}, reverse=True):
        if draft.balance > 0:
            _project(draft, pair)
    if draft.balance > 0:
        draft.conditions = _independent(board, draft)


def _project(draft: Draft, pair: int) -> None:
    both = [one for one in draft.conditions if one.pair == pair]
    if len(both) < 2 or both[0].closing is None:
        return
    x, y = both
    line = both[0].closing
    place = draft.conditions.index(x)
    draft.conditions = [one for one in draft.conditions if one.pair != pair]
    vector = UnknownPlace(x.residual, y.residual)
    full = UnknownPlace(x.full, y.full).plus(UnknownPlace(x.right, y.right), -1).across(line)
    one = replace(
        x,
        name=x.name.replace("x_", "n_", 1),
        left=vector.across(line),
        full=full,
        right=ZERO,
        pair=-1,
        vector=vector,
    )
    draft.conditions.insert(place, one)


def _independent(board: SymbolTable, draft: Draft) -> list[LinearConstraint]:
    """As many conditions as unknowns whose rows are best independent in the initial position."""
    values = board.alphabet.values
    rows = np.array(
        [
            [
                float(one.residual.slope(x.letter).value(np, lambda letter: values[letter]))
                for x in draft.unknowns
            ]
            for one in draft.conditions
        ]
    )
    size = len(draft.unknowns)
    best = max(
        combinations(range(len(rows)), size),
        key=lambda chosen: abs(float(np.linalg.det(rows[list(chosen)]))),
    )
    return [draft.conditions[i] for i in best]
