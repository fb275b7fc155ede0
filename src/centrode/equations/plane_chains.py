"""Vector chains through a mechanism, group by group of its plan, as a student lays them.

A chain starts at the joint that was found last, runs from link to link, and ends where a place is known already:
there it says x_D = ... and y_D = ...; where it meets a guide of the frame it says one of them.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from typing import TypeAlias

from centrode.equations.linear import Draft, LinearConstraint, UnknownPlace, polar
from centrode.equations.symbol_table import SymbolLine, SymbolRod, SymbolTable, lines_of, rods_of
from centrode.equations.symbols import Angle, Sum, quarters_of
from centrode.structure.constraints import FRAME, AngleDrive, NoTurning
from centrode.structure.groups import Group

# Where vector chains close: what guides and cylinders say whose ends are all placed, and places met again.


class Closing:
    """Writes down the constraints of chains laid on a board; `lines` and `rods` are those still to be used.

    What is placed by a line or a rod is taken out of them by whoever places it.
    """

    def __init__(self, board: SymbolTable) -> None:
        self.board = board
        self.lines = lines_of(board.ready)
        self.rods = rods_of(board.ready)
        self.names: set[str] = set()
        self.pairs = 0

    def close(self, draft: Draft) -> None:
        """Write down what guides and cylinders say whose ends are all placed."""
        board = self.board
        for line in list(self.lines):
            if line.point in board.points and line.on in board.placed:
                self.lines.remove(line)
                if line.on == FRAME and line.drive is None:
                    self._on_frame(line, draft)
                else:
                    self._on_body(line, draft)
        for rod in list(self.rods):
            start, end = self.rod_ends(rod)
            if start is not None and end is not None:
                self.rods.remove(rod)
                self._along_rod(rod, start, end, draft)

    def meet(
        self, point: str, at: UnknownPlace, full: UnknownPlace, closing: Angle, of: str, draft: Draft
    ) -> None:
        """A chain ends at a place that is known: two constraints."""
        board = self.board
        known = board.points[point]
        if point not in board.moving:
            fixed = board.numbers.frame[point]
            known = UnknownPlace(*(Sum.letter(board.alphabet.constant(float(x), "m")) for x in fixed))
        self.pairs += 1
        for axis, left, long, right in zip("xy", at, full, known, strict=True):
            name = self._name(f"{axis}_{point}", of)
            draft.conditions.append(LinearConstraint(name, left, long, right, self.pairs, closing))

    def _on_frame(self, line: SymbolLine, draft: Draft) -> None:
        """A point of a chain on a line of the frame: one coordinate of it is constant."""
        board = self.board
        at, full = board.points[line.point], board.full[line.point]
        quarters = quarters_of(line.direction)
        x, y = line.through
        if quarters is not None:
            axis = "y" if quarters % 2 == 0 else "x"
            constant = Sum.letter(board.alphabet.constant(y if axis == "y" else x, "m"))
            name = self._name(f"{axis}_{line.point}", line.name)
            left, long = (at.y, full.y) if axis == "y" else (at.x, full.x)
            board.points[line.point] = (
                UnknownPlace(at.x, constant) if axis == "y" else UnknownPlace(constant, at.y)
            )
        else:
            heading = board.heading(line)
            ux, uy = line.direction
            constant = Sum.letter(board.alphabet.constant(ux * y - uy * x, "m"))
            name = self._name(f"n_{line.point}", line.name)
            left, long = at.across(heading), full.across(heading)
            board.points[line.point] = polar(at.along(heading), heading).plus(
                polar(constant, heading.turned_by(1))
            )
        board.constants[line.name] = constant
        draft.conditions.append(LinearConstraint(name, left, long, constant))

    def _on_body(self, line: SymbolLine, draft: Draft) -> None:
        """A point of a chain on a line of a moving body: two constraints with the displacement along it."""
        board = self.board
        way = board.track(line, Sum.letter(board.slide(line, draft)))
        base = board.base(line)
        at = way if base is None else board.points[base].plus(way)
        full = way if base is None else board.full[base].plus(way)
        self.meet(line.point, at, full, board.heading(line), line.name, draft)

    def _along_rod(
        self,
        rod: SymbolRod,
        start: tuple[UnknownPlace, UnknownPlace],
        end: tuple[UnknownPlace, UnknownPlace],
        draft: Draft,
    ) -> None:
        board = self.board
        size, angle = board.bearing(rod, draft)
        way = polar(size, angle)
        if isinstance(rod.first, str) and rod.first not in board.moving:
            self.meet(rod.first, end[0].plus(way, -1), end[1].plus(way, -1), angle, rod.name, draft)
        else:
            self.meet(rod.second, start[0].plus(way), start[1].plus(way), angle, rod.name, draft)

    def rod_ends(
        self, rod: SymbolRod
    ) -> tuple[tuple[UnknownPlace, UnknownPlace] | None, tuple[UnknownPlace, UnknownPlace] | None]:
        """Places of both ends of a cylinder, as put in and in full, where they are known."""
        board = self.board
        second = board.points.get(rod.second)
        end = None if second is None else (second, board.full[rod.second])
        if isinstance(rod.first, str):
            first = board.points.get(rod.first)
            return (None if first is None else (first, board.full[rod.first])), end
        body, local = rod.first
        if body not in board.placed:
            return None, end
        return (board.spot(body, local, rod.name), board.spot(body, local, rod.name, full=True)), end

    def _name(self, name: str, of: str) -> str:
        """A name of a constraint that no other one has."""
        found, count = name, 1
        while found in self.names:
            found = f"{name}({of})" if count == 1 else f"{name}({of} {count})"
            count += 1
        self.names.add(found)
        return found


# Angles of links in symbols: driven, tied to another link's angle, or unknown.

Tie: TypeAlias = AngleDrive | NoTurning
"""A constraint that gives the angle of one link from that of another."""


def ties_of(board: SymbolTable) -> list[Tie]:
    """Drives of angles and prismatic pairs."""
    structure = board.ready.structure
    return [
        c
        for c in structure.constraints
        if isinstance(c, (AngleDrive, NoTurning)) and c not in structure.redundant
    ]


def give_angles(board: SymbolTable, ties: list[Tie], draft: Draft, links: Sequence[str]) -> None:
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
        board.angles[link] = _angle_of_tie(board, tie, link, draft)
        waiting.remove(link)


def _base(tie: Tie) -> str:
    return tie.relative_to if isinstance(tie, AngleDrive) else tie.on


def _reaches(board: SymbolTable, tie: Tie, waiting: Sequence[str]) -> bool:
    ends = (tie.link, _base(tie))
    return any(one in waiting and other in board.angles for one, other in (ends, ends[::-1]))


def _angle_of_tie(board: SymbolTable, tie: Tie, link: str, draft: Draft) -> Angle:
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


Rank: TypeAlias = tuple[int, int]


class Chains:
    """Lays the chains of one group of the plan after the other on a board."""

    def __init__(self, board: SymbolTable) -> None:
        self.board = board
        self.ties = ties_of(board)
        self.closing = Closing(board)
        self.lines, self.rods = self.closing.lines, self.closing.rods

    def lay(self, group: Group, number: int, draft: Draft) -> None:
        """Add a group of the plan to a draft: its angles, its chains, the constraints where they close."""
        links, points = group.links, group.points
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

    def _place_body(self, line: SymbolLine, draft: Draft) -> None:
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

    def _place_on(self, line: SymbolLine, draft: Draft) -> None:
        """Place a point on a line by its displacement."""
        board = self.board
        self.lines.remove(line)
        way = board.track(line, Sum.letter(board.slide(line, draft)))
        base = board.base(line)
        at = way if base is None else board.points[base].plus(way)
        board.put(line.point, at, way if base is None else board.full[base].plus(way))
        self.closing.close(draft)

    def _place_by_rod(self, rod: SymbolRod, draft: Draft, wanted: set[str]) -> bool:
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


# The shortest chain to every point: the end of a rocker from its fixed hinge, not through the coupler.

STEP = 2
"""Terms that move, which one link more adds to both coordinates together."""


def shorten(board: SymbolTable) -> None:
    """Write the place of every point that was found by the chain with the fewest terms."""
    ways = _ways(board)
    points, full = dict(board.points), dict(board.full)

    def place(name: str, known: dict[str, UnknownPlace], found: dict[str, UnknownPlace]) -> UnknownPlace:
        if name not in found:
            step = ways[name]
            found[name] = (
                known[name]
                if step is None
                else place(step[1], known, found).plus(board.arm(step[0], step[1], name))
            )
        return found[name]

    for known in (points, full):
        found: dict[str, UnknownPlace] = {}
        for name in known:
            place(name, known, found)
        (board.points if known is points else board.full).update(found)


def _ways(board: SymbolTable) -> dict[str, tuple[str, str] | None]:
    """The last link of the shortest chain to a point and where it begins; None where the chain is as it was."""
    cost = {
        name: _count_moving_terms(board, at.x) + _count_moving_terms(board, at.y)
        for name, at in board.points.items()
    }
    ways: dict[str, tuple[str, str] | None] = dict.fromkeys(cost)
    links = [(link, list(board.local(link))) for link in board.order if link in board.placed]
    waiting = [(far, name) for name, far in cost.items()]
    heapq.heapify(waiting)
    while waiting:
        far, name = heapq.heappop(waiting)
        if far > cost[name]:
            continue
        for link, points in links:
            for other in points if name in points else ():
                if other in cost and other not in board.numbers.frame and far + STEP < cost[other]:
                    cost[other], ways[other] = far + STEP, (link, name)
                    heapq.heappush(waiting, (far + STEP, other))
    return ways


def _count_moving_terms(board: SymbolTable, total: Sum) -> int:
    """Number of terms that move."""
    return sum(bool(Sum({term: 1}).letters & board.alphabet.rates.keys()) for term in total.terms)
