"""Vector chains through a mechanism, group by group of its plan, as a student lays them.

A chain starts at the joint that was found last, runs from link to link, and ends where a place is known already:
there it says x_D = ... and y_D = ...; where it meets a guide of the frame it says one of them.
"""

from __future__ import annotations

from typing import TypeAlias

from centrode.equations.board import Board
from centrode.equations.closing import Closing
from centrode.equations.draft import Draft
from centrode.equations.lines import Line, Rod
from centrode.equations.places import polar
from centrode.equations.sums import Sum
from centrode.equations.ties import give_angles, ties_of
from centrode.structure.constraints import FRAME
from centrode.structure.groups import Group, links_of, points_of

Rank: TypeAlias = tuple[int, int]


class Chains:
    """Lays the chains of one group of the plan after the other on a board."""

    def __init__(self, board: Board) -> None:
        self.board = board
        self.ties = ties_of(board)
        self.closing = Closing(board)
        self.lines, self.rods = self.closing.lines, self.closing.rods

    def lay(self, group: Group, number: int, draft: Draft) -> None:
        """Add a group of the plan to a draft: its angles, its chains, the constraints where they close."""
        links, points = links_of(group), points_of(group)
        draft.links += links
        draft.points += points
        draft.plan.append(number)
        give_angles(self.board, self.ties, draft, links)
        pending = [link for link in draft.links if link not in self.board.placed]
        wanted = set(draft.points) | {p for link in pending for p in self.board.local(link)}
        since = len(self.board.moving)
        self.closing.close(draft)
        while self._driven(draft, wanted) or self._step(draft, pending, wanted, since):
            pass

    # one step of a chain

    def _step(self, draft: Draft, pending: list[str], wanted: set[str], since: int) -> bool:
        """Place one thing more; False if there is nothing left that can be placed."""
        board = self.board
        ranked = [(self._rank(link, since), link) for link in pending]
        best = max(ranked, key=lambda one: one[0], default=((-2, 0), ""))
        if best[0][0] > -1:
            self._place_link(best[1], self._anchor(best[1], since), draft)
            pending.remove(best[1])
            return True
        for line in self.lines:
            if line.on in pending and line.point in board.points and line.on in board.angles:
                self._place_body(line, draft)
                pending.remove(line.on)
                return True
        on_links = [line for line in self.lines if line.on != FRAME]
        for line in [*on_links, *(line for line in self.lines if line.on == FRAME)]:
            if line.on in board.placed and line.point in wanted and line.point not in board.points:
                self._place_on(line, draft)
                return True
        # the first that can be placed takes itself out of the list
        return any(self._place_by_rod(rod, draft, wanted) for rod in list(self.rods))

    def _driven(self, draft: Draft, wanted: set[str]) -> bool:
        for line in self.lines:
            free = line.point in wanted and line.point not in self.board.points
            if line.drive is not None and free and line.on in self.board.placed:
                self._place_on(line, draft)
                return True
        return False

    def _rank(self, link: str, since: int) -> Rank:
        """How much a link is next: from the joint placed last, else from a moving joint, else from the frame."""
        anchor = self._anchor(link, since)
        if anchor is None:
            return -1, 0
        if anchor not in self.board.moving:
            return 0, -self.board.order[link]
        place = self.board.moving.index(anchor)
        return (2, place) if place >= since else (1, -self.board.order[link])

    def _anchor(self, link: str, since: int) -> str | None:
        """The point of a link from which a chain goes on: that placed last in this group, else a moving one."""
        moving = self.board.moving
        known = [point for point in self.board.local(link) if point in self.board.points]
        new = [point for point in known if point in moving and moving.index(point) >= since]
        if new:
            return max(new, key=moving.index)
        return next((point for point in known if point in moving), known[0] if known else None)

    def _place_link(self, link: str, anchor: str | None, draft: Draft) -> None:
        assert anchor is not None
        board = self.board
        board.placed.add(link)
        ends = []
        for point in board.local(link):
            if point == anchor:
                continue
            arm = board.arm(link, anchor, point)
            at, full = board.points[anchor].plus(arm), board.full[anchor].plus(arm)
            if point in board.points:
                ends.append((point, at, full))
            else:
                board.put(point, at, full)
        for point, at, full in ends:
            self.closing.meet(point, at, full, board.angles[link], link, draft)
        self.closing.close(draft)

    def _place_body(self, line: Line, draft: Draft) -> None:
        """Place a link that carries a guide from the guided point."""
        board = self.board
        self.lines.remove(line)
        base = board.base(line)
        assert base is not None
        way = board.track(line, Sum.letter(board.slide(line, draft)))
        at, full = (places[line.point].plus(way, -1) for places in (board.points, board.full))
        if base in board.points:
            self.closing.meet(base, at, full, board.angles[line.on], line.on, draft)
        else:
            board.put(base, at, full)
        self._place_link(line.on, base, draft)

    def _place_on(self, line: Line, draft: Draft) -> None:
        """Place a point on a line by its displacement."""
        board = self.board
        self.lines.remove(line)
        way = board.track(line, Sum.letter(board.slide(line, draft)))
        base = board.base(line)
        at = way if base is None else board.points[base].plus(way)
        board.put(line.point, at, way if base is None else board.full[base].plus(way))
        self.closing.close(draft)

    def _place_by_rod(self, rod: Rod, draft: Draft, wanted: set[str]) -> bool:
        """Place one end of a cylinder from the other."""
        start, end = self.closing.rod_ends(rod)
        if (start is None) == (end is None):
            return False
        target = rod.second if end is None else rod.first
        if not isinstance(target, str) or target not in wanted:
            return False
        self.rods.remove(rod)
        way, sign = polar(*self.board.bearing(rod, draft)), 1 if end is None else -1
        known = start or end
        assert known is not None
        self.board.put(target, known[0].plus(way, sign), known[1].plus(way, sign))
        self.closing.close(draft)
        return True
