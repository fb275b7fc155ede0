"""Angles of links in symbols: driven, tied to another link's angle, or unknown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

from centrode.equations.board import Board
from centrode.equations.draft import Draft
from centrode.equations.letters import Angle
from centrode.structure.constraints import FRAME, AngleDrive, NoTurning

Tie: TypeAlias = AngleDrive | NoTurning
"""A constraint that gives the angle of one link from that of another."""


def ties_of(board: Board) -> list[Tie]:
    """Drives of angles and prismatic pairs."""
    structure = board.ready.structure
    return [
        c
        for c in structure.constraints
        if isinstance(c, (AngleDrive, NoTurning)) and c not in structure.redundant
    ]


def give_angles(board: Board, ties: list[Tie], draft: Draft, links: Sequence[str]) -> None:
    """Give every link of a group its angle; ties that are used up are taken out of `ties`.

    A link of the group to which nothing is tied has an angle of its own, the first of the description first.
    """
    waiting = sorted((link for link in links if link not in board.angles), key=lambda link: board.order[link])
    while waiting:
        tie = next((tie for tie in ties if _reaches(board, tie, waiting)), None)
        if tie is None:
            link = waiting.pop(0)
            board.angles[link] = board.link_angle(link, draft)
            continue
        ties.remove(tie)
        base, link = _base(tie), tie.link
        if link in board.angles:
            base, link = link, base
        board.angles[link] = _tied(board, tie, link, draft)
        waiting.remove(link)


def _base(tie: Tie) -> str:
    return tie.relative_to if isinstance(tie, AngleDrive) else tie.on


def _reaches(board: Board, tie: Tie, waiting: Sequence[str]) -> bool:
    ends = (tie.link, _base(tie))
    return any(one in waiting and other in board.angles for one, other in (ends, ends[::-1]))


def _tied(board: Board, tie: Tie, link: str, draft: Draft) -> Angle:
    base = _base(tie)
    if isinstance(tie, AngleDrive):
        if base == FRAME:
            return board.link_angle(link, draft, tie.drive)
        turn = board.relative_angle(tie.link, base, draft, tie.drive)
    else:
        cosine, sine = board.numbers.turn[tie.guide]
        turn = board.alphabet.angle(
            f"gamma_{tie.guide}", "angle of pair", (tie.guide, tie.link, tie.on), (float(cosine), float(sine))
        )
    known = board.angles[base if link == tie.link else tie.link]
    return known.plus(turn, 1 if link == tie.link else -1)
