"""Where vector chains close: what guides and cylinders say whose ends are all placed, and places met again."""

from __future__ import annotations

from centrode.equations.alphabet import quarters_of
from centrode.equations.board import Board
from centrode.equations.draft import Condition, Draft
from centrode.equations.letters import Angle
from centrode.equations.lines import Line, Rod, lines_of, rods_of
from centrode.equations.places import Place, polar
from centrode.equations.sums import Sum
from centrode.structure.constraints import FRAME


class Closing:
    """Writes down the constraints of chains laid on a board; `lines` and `rods` are those still to be used.

    What is placed by a line or a rod is taken out of them by whoever places it.
    """

    def __init__(self, board: Board) -> None:
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

    def meet(self, point: str, at: Place, full: Place, closing: Angle, of: str, draft: Draft) -> None:
        """A chain ends at a place that is known: two constraints."""
        board = self.board
        known = board.points[point]
        if point not in board.moving:
            fixed = board.numbers.frame[point]
            known = Place(*(Sum.letter(board.alphabet.constant(float(x), "m")) for x in fixed))
        self.pairs += 1
        for axis, left, long, right in zip("xy", at, full, known, strict=True):
            name = self._name(f"{axis}_{point}", of)
            draft.conditions.append(Condition(name, left, long, right, self.pairs, closing))

    def _on_frame(self, line: Line, draft: Draft) -> None:
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
            board.points[line.point] = Place(at.x, constant) if axis == "y" else Place(constant, at.y)
        else:
            heading = board.heading(line)
            ux, uy = line.direction
            constant = Sum.letter(board.alphabet.constant(ux * y - uy * x, "m"))
            name = self._name(f"n_{line.point}", line.name)
            left, long = at.across(heading), full.across(heading)
            board.points[line.point] = polar(at.along(heading), heading).plus(
                polar(constant, heading.turned(1))
            )
        draft.conditions.append(Condition(name, left, long, constant))

    def _on_body(self, line: Line, draft: Draft) -> None:
        """A point of a chain on a line of a moving body: two constraints with the displacement along it."""
        board = self.board
        way = board.track(line, Sum.letter(board.slide(line, draft)))
        base = board.base(line)
        at = way if base is None else board.points[base].plus(way)
        full = way if base is None else board.full[base].plus(way)
        self.meet(line.point, at, full, board.heading(line), line.name, draft)

    def _along_rod(
        self, rod: Rod, start: tuple[Place, Place], end: tuple[Place, Place], draft: Draft
    ) -> None:
        board = self.board
        size, angle = board.bearing(rod, draft)
        way = polar(size, angle)
        if isinstance(rod.first, str) and rod.first not in board.moving:
            self.meet(rod.first, end[0].plus(way, -1), end[1].plus(way, -1), angle, rod.name, draft)
        else:
            self.meet(rod.second, start[0].plus(way), start[1].plus(way), angle, rod.name, draft)

    def rod_ends(self, rod: Rod) -> tuple[tuple[Place, Place] | None, tuple[Place, Place] | None]:
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
