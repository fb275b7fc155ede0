"""From a mechanism made ready to its unknowns and constraints in symbols, group by group."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations

import numpy as np

from centrode.equations.board import Board
from centrode.equations.chains import Chains
from centrode.equations.draft import Condition, Draft
from centrode.equations.places import Place
from centrode.equations.shortcuts import shorten
from centrode.equations.sums import ZERO
from centrode.equations.wheels import mesh, meshings_of
from centrode.errors import InputError
from centrode.kinematics.prepared import Ready
from centrode.locale import _


def laid(ready: Ready) -> tuple[Board, tuple[Draft, ...]]:
    """All chains of a planar mechanism, and the groups that have unknowns.

    Raises InputError where constraints and unknowns do not match.
    """
    board = Board(ready)
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
            _("the constraints of this mechanism do not make one vector chain a group"),
            _("leave them numerical"),
        )
    return board, tuple(groups)


def _take_out_repeated(board: Board, draft: Draft) -> None:
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
    vector = Place(x.residual, y.residual)
    full = Place(x.full, y.full).plus(Place(x.right, y.right), -1).across(line)
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


def _independent(board: Board, draft: Draft) -> list[Condition]:
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
