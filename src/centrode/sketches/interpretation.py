"""A drawing as a mechanism: lines are links, circles hinges, hatching the frame, rectangles sliders.

Where the drawing has circles, links are hinged where these stand, and lines that meet elsewhere are one link. Where it
has none, lines are hinged wherever they meet. Layers say more: see `sketch.ROLES`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations, pairwise

from centrode.errors import InputError
from centrode.locale import _, ngettext
from centrode.model.reading import Problem, read_name
from centrode.sketches.parts import (
    FRAME,
    RIGHT_ANGLE,
    Body,
    DrawingParts,
    Guided,
    along,
    distance_to_line,
    distance_to_segment,
    less,
    parallel,
    signed_distance,
    unit,
)
from centrode.sketches.sketch import Label, Place, Polyline, Sketch, extent, role_of

NEAR = 2e-3
"""Ends that are so near meet, as a part of the drawing's size."""
WHEEL = 0.15
"""A circle of a greater radius, as a part of the drawing's size, is no hinge."""
BLOCK = 0.3
"""A rectangle that is longer, as a part of the drawing's size, is no slider."""
LETTERS_APART = 0.08
"""So far a letter may stand from its point, as a part of the drawing's size."""
PASSING = 1e-4
"""A line whose pieces end at a circle passes behind it where it misses the middle by more, as a part of the size."""
MOST_NODES = 300


@dataclass(frozen=True)
class SliderBlock:
    """A slider drawn as a rectangle: its middle, the unit vector along its longer sides, half of its breadth."""

    centre: Place
    direction: Place
    half: float
    length: float


def read_sketch(
    sketch: Sketch, where: str, near: float | None = None, *, straight_on: bool = False
) -> DrawingParts:
    """Bodies, hinges and guides of a drawing; notes on what was guessed are added to it.

    Parameters
    ----------
    near : how far apart ends that meet may be, in the drawing's units
    straight_on : lines that go straight on through a hinge are one link

    Raises
    ------
    InputError
        There are no lines, or too many.
    """
    return _Reader(sketch, where, near, straight_on).read()


class _Reader:
    """The steps from strokes to bodies, each of which uses what those before it have found."""

    def __init__(self, sketch: Sketch, where: str, near: float | None, straight_on: bool) -> None:
        self.sketch, self.where, self.straight_on = sketch, where, straight_on
        self.strokes: dict[str, list[Polyline]] = {}
        for stroke in sketch.strokes:
            self.strokes.setdefault(role_of(stroke.layer), []).append(stroke)
        layers = {one.layer for one in sketch.strokes}
        layers |= {one.layer for one in (*sketch.rings, *sketch.arcs)}
        if any(role_of(layer) == "gear" for layer in layers):
            what = _("gears and wheels are not read")
            raise InputError(where, what, _("remove their layer, and write them into the description"))
        aside = len(self.strokes.pop("aside", [])) + len(self.strokes.pop("name", []))
        if aside:
            sketch.leave_out(_("lines on layers of dimensions, titles and paths"), aside)
        drawn = [*self.strokes.get("link", []), *self.strokes.get("", []), *self.strokes.get("drive", [])]
        if not drawn:
            what = _("the drawing has no straight lines that could be links")
            raise InputError(where, what, _("draw links as lines, polylines or polygons"))
        self.size = extent([place for stroke in drawn for place in stroke.points])
        if self.size <= 0.0:
            raise InputError(where, _("the drawing has no extent"))
        self.near = NEAR * self.size if near is None else near
        self.rims: list[float] = []
        """Radius of the circle at a node; negative where there is none."""
        self.parts = DrawingParts()
        self.gap = 0.0
        self.passed: dict[frozenset[Place], set[Place]] = {}
        """Ends of a line -> the circles behind which it passes."""
        self.beside: dict[int, set[int]] = {}
        """Body by its identity -> nodes behind which it passes."""
        self.forks: set[Place] = set()
        """Hinges through which lines seem to go straight on."""

    def read(self) -> DrawingParts:
        blocks = self._blocks()
        self._add_rings(blocks)
        blocks += self._slots()
        drawn: set[frozenset[Place]] = set()
        for stroke in self._bars(blocks):
            # a line that is drawn twice is one
            if frozenset(stroke.points) not in drawn or stroke.closed:
                drawn.add(frozenset(stroke.points))
                self._add_bodies(stroke, blocks)
        if self.forks:
            text = ngettext(
                "lines that go straight on through a hinge are two links ({n} time)",
                "lines that go straight on through a hinge are two links ({n} times)",
                len(self.forks),
            )
            self.sketch.notes.append(text.format(n=len(self.forks)))
        self._attach_inner_nodes(blocks)
        if self._has_rings:
            self._weld()
        self._ground(blocks)
        self._guide(blocks)
        self._guess_ground()
        self.parts.names = self._names()
        united = self.parts.unite_rigid(self.where)
        if united:
            text = ngettext(
                "lines that hold each other rigidly are one part ({n} time)",
                "lines that hold each other rigidly are one part ({n} times)",
                united,
            )
            self.sketch.notes.append(text.format(n=united))
        loose = self.parts.leave_out_loose()
        if loose:
            self.sketch.leave_out(_("lines that do not hang together with the frame"), loose)
        self.parts.check(self.where)
        if self.gap > 1e-6 * self.size:
            text = _("ends that were up to {gap} of the drawing's size apart were joined")
            self.sketch.notes.append(text.format(gap=f"{self.gap / self.size:.1e}"))
        self.parts.driven = [(number, "") for number in self._driven_bodies()]
        return self.parts

    # Nodes.

    @property
    def _has_rings(self) -> bool:
        return any(rim >= 0.0 for rim in self.rims)

    def _add_rings(self, blocks: Sequence[SliderBlock]) -> None:
        """Nodes at circles; concentric ones are one."""
        for ring in sorted(self.sketch.rings, key=lambda one: -one.radius):
            if role_of(ring.layer) in ("aside", "name"):
                self.sketch.leave_out(_("circles on layers of dimensions, titles and paths"))
            elif ring.radius > WHEEL * self.size:
                self.sketch.leave_out(_("circles too large for hinges (wheels are not read)"))
            elif self._nearest(ring.centre, self.near) is None:
                self._add_node(ring.centre, ring.radius)
        for block in blocks:
            if self._nearest(block.centre, max(self.near, 0.2 * block.length)) is None:
                self._add_node(block.centre, 0.0 if self._has_rings else -1.0)

    def _add_node(self, place: Place, rim: float) -> int:
        self.parts.places.append(place)
        self.rims.append(rim)
        if len(self.parts.places) > MOST_NODES:
            what = _("the drawing has more than {most} hinges and ends of lines").format(most=MOST_NODES)
            raise InputError(self.where, what, _("keep the mechanism alone"))
        return len(self.parts.places) - 1

    def _nearest(self, place: Place, within: float, taken: Iterable[int] = ()) -> int | None:
        apart = [(math.dist(place, at), k) for k, at in enumerate(self.parts.places) if k not in taken]
        least = min(apart, default=(math.inf, -1))
        return least[1] if least[0] <= within else None

    def _node(self, place: Place, before: Place | None = None) -> int:
        """The node at a place, or at whose circle a line from `before` ends on its way in; else a new one."""
        found = []
        for k, (at, rim) in enumerate(zip(self.parts.places, self.rims, strict=True)):
            off = max(0.0, math.dist(place, at) - max(0.0, rim))
            aims = before is None or abs(signed_distance(at, before, place)) <= 2.0 * self.near
            if off <= self.near and (aims or math.dist(place, at) <= self.near):
                found.append((off, math.dist(place, at), k))
        if not found:
            return self._add_node(place, -1.0)
        off, _way, k = min(found)
        self.gap = max(self.gap, off)
        return k

    # Links.

    def _blocks(self) -> list[SliderBlock]:
        """Rectangles that are sliders; they are taken from the strokes."""
        found: list[SliderBlock] = []
        for role in ("slider", "link", ""):
            kept = []
            for stroke in self.strokes.get(role, []):
                block = _block(stroke)
                holds = block is not None and (role == "slider" or self._is_hinged_inside(block))
                if block is not None and holds and block.length <= BLOCK * self.size:
                    found.append(block)
                else:
                    kept.append(stroke)
            self.strokes[role] = kept
        left = len(self.strokes.pop("slider", []))
        if left:
            self.sketch.leave_out(_("lines on a layer of sliders that are no rectangles"), left)
        return found

    def _is_hinged_inside(self, block: SliderBlock) -> bool:
        """Whether a circle, or an end of a line, is in the middle of a rectangle."""
        within = max(self.near, 0.1 * block.length)
        ends = [place for stroke in self.sketch.strokes for place in stroke.points if not stroke.closed]
        return any(
            math.dist(place, block.centre) <= within
            for place in (*(one.centre for one in self.sketch.rings), *ends)
        )

    def _slots(self) -> list[SliderBlock]:
        """Outlines with two long sides and round ends become middle lines; circles between the ends slide there."""
        found: list[SliderBlock] = []
        for role in ("link", "guide", ""):
            kept = []
            for stroke in self.strokes.get(role, []):
                axis = _slot_axis(stroke)
                if axis is None:
                    kept.append(stroke)
                    continue
                start, end, half = axis
                x, y = unit(less(end, start))
                # lines go on from the tips; a circle in the middle of a round end is a hinge, and the end is there
                hinged = [self._nearest(place, self.near) is not None for place in (start, end)]
                low, high = (0.0 if one else half for one in hinged)
                tips = (start[0] - low * x, start[1] - low * y), (end[0] + high * x, end[1] + high * y)
                kept.append(Polyline(tips, False, stroke.layer))
                for place, rim in zip(self.parts.places, self.rims, strict=True):
                    between = min(math.dist(place, start), math.dist(place, end)) > self.near
                    if rim >= 0.0 and between and distance_to_segment(place, start, end) <= self.near:
                        found.append(SliderBlock(place, (x, y), half, 2.0 * half))
            self.strokes[role] = kept
        if found:
            self.sketch.notes.append(_("circles inside outlines with round ends slide along these"))
        return found

    def _bars(self, blocks: Sequence[SliderBlock]) -> list[Polyline]:
        """Strokes that are links, those that a circle hides in part as one."""
        bars = [
            *self.strokes.get("link", []),
            *self.strokes.get("", []),
            *(one for one in self.strokes.get("drive", []) if len(one.points) <= 4 and not one.closed),
        ]
        while pair := next(self._hidden_pairs(bars, blocks), None):
            one, other, joined = pair
            bars = [bar for bar in bars if bar is not one and bar is not other] + [joined]
        return bars

    def _hidden_pairs(
        self, bars: Sequence[Polyline], blocks: Sequence[SliderBlock]
    ) -> Iterator[tuple[Polyline, Polyline, Polyline]]:
        """Two pieces of a line that passes behind a circle or a slider, or straight on through a hinge."""
        single = [bar for bar in bars if len(bar.points) == 2]
        for centre, on_edge, plain in self._covers(blocks):
            ends = [
                (bar, bar.points[k], bar.points[1 - k])
                for bar in single
                for k in (0, 1)
                if on_edge(bar.points[k])
            ]
            for (one, end, far), (other, beginning, beyond) in combinations(ends, 2):
                onwards = 0.0 < along(end, far, beyond) < along(beginning, far, beyond) < 1.0
                if one is other or not onwards or abs(signed_distance(end, far, beyond)) > self.near:
                    continue
                if abs(signed_distance(beginning, far, beyond)) > self.near:
                    continue
                over = abs(signed_distance(centre, far, beyond)) > PASSING * self.size or (
                    plain and self._is_drawn_twice(single, one, other)
                )
                joined = Polyline((far, beyond), False, one.layer)
                if over:
                    known = (self.passed.get(frozenset(bar.points), set()) for bar in (one, other))
                    self.passed[frozenset(joined.points)] = {centre}.union(*known)
                if over or (plain and self._goes_on(ends, centre)):
                    yield one, other, joined

    def _is_drawn_twice(self, single: Sequence[Polyline], *pair: Polyline) -> bool:
        """Whether one of two pieces lies on another line: that one ends there, and this one goes on."""
        shapes = [frozenset(bar.points) for bar in single]
        return any(shapes.count(frozenset(bar.points)) > 1 for bar in pair)

    def _goes_on(self, ends: Sequence[object], centre: Place) -> bool:
        """Whether two pieces that end at a hinge on one line are one link: only where something else is hinged."""
        rim = next(rim for place, rim in zip(self.parts.places, self.rims, strict=True) if place == centre)
        signs = self.strokes.get("ground", [])
        held = len(ends) > 2 or any(_touches(sign, centre, rim + self.near) for sign in signs)
        if held and not self.straight_on:
            self.forks.add(centre)
        return held and self.straight_on

    def _covers(self, blocks: Sequence[SliderBlock]) -> Iterator[tuple[Place, Callable[[Place], bool], bool]]:
        """What hides lines: its middle, whether a place is on its edge, whether it is a hinge."""
        for centre, rim in zip(self.parts.places, self.rims, strict=True):
            if rim > 0.0:
                yield centre, partial(self._is_on_rim, centre, rim), True
        for block in blocks:
            yield block.centre, partial(self._is_on_edge, block), False

    def _is_on_rim(self, centre: Place, rim: float, place: Place) -> bool:
        return abs(math.dist(place, centre) - rim) <= self.near

    def _is_on_edge(self, block: SliderBlock, place: Place) -> bool:
        onwards, across = _in_axes(block, place)
        off = max(onwards - 0.5 * block.length, across - block.half)
        return abs(off) <= self.near

    def _end_node(self, place: Place, before: Place, blocks: Sequence[SliderBlock]) -> int:
        """The node at the end of a line from a place before; of a slider, at whose side it may end, the middle."""
        for block in blocks:
            onwards, across = _in_axes(block, place)
            inside = onwards <= 0.5 * block.length + self.near and across <= block.half + self.near
            if inside and abs(signed_distance(block.centre, before, place)) <= 2.0 * self.near:
                node = self._nearest(block.centre, max(self.near, 0.2 * block.length))
                if node is not None:
                    return node
        return self._node(place, before)

    def _add_bodies(self, stroke: Polyline, blocks: Sequence[SliderBlock]) -> None:
        """A closed polygon is one link; an open polyline is hinged where circles stand, or everywhere without any."""
        points = stroke.points
        first = self._end_node(points[0], points[1], blocks)
        nodes = [first, *(self._node(place) for place in points[1:-1])]
        nodes.append(self._end_node(points[-1], points[-2], blocks))
        nodes = [k for k, before in zip(nodes, [-1, *nodes], strict=False) if k != before]
        if stroke.closed and len(nodes) > 1 and nodes[0] == nodes[-1]:
            nodes.pop()
        if len(nodes) < 2:
            self.sketch.leave_out(_("lines shorter than the gap that is closed"))
            return
        if stroke.closed:
            self._add_body([*nodes, nodes[0]], stroke.layer)
            return
        start = 0
        for k in range(1, len(nodes)):
            if k == len(nodes) - 1 or not self._has_rings or self.rims[nodes[k]] >= 0.0:
                self._add_body(nodes[start : k + 1], stroke.layer, self.passed.get(frozenset(points), ()))
                start = k

    def _add_body(self, nodes: Sequence[int], layer: str, passed: Collection[Place] = ()) -> None:
        sides = [side for side in pairwise(nodes) if side[0] != side[1]]
        body = Body(list(dict.fromkeys(nodes)), sides, layer=layer)
        self.beside[id(body)] = {k for k, place in enumerate(self.parts.places) if place in passed}
        self.parts.bodies.append(body)

    def _attach_inner_nodes(self, blocks: Sequence[SliderBlock]) -> None:
        """Nodes on the side of a link belong to it, unless a slider stands there that slides along it."""
        for body in self.parts.bodies[1:]:
            for k, place in enumerate(self.parts.places):
                if k in body.nodes or k in self.beside[id(body)]:
                    continue
                if not any(self._is_on(place, side) for side in body.sides):
                    continue
                block = next(
                    (
                        one
                        for one in blocks
                        if math.dist(one.centre, place) <= max(self.near, 0.2 * one.length)
                    ),
                    None,
                )
                if block is not None and any(
                    self._is_on(place, side) and parallel(block.direction, self._way(side))
                    for side in body.sides
                ):
                    continue
                body.nodes.append(k)

    def _is_on(self, place: Place, side: tuple[int, int]) -> bool:
        start, end = self.parts.places[side[0]], self.parts.places[side[1]]
        return distance_to_segment(place, start, end) <= self.near

    def _way(self, side: tuple[int, int]) -> Place:
        return less(self.parts.places[side[1]], self.parts.places[side[0]])

    def _weld(self) -> None:
        """Links that meet where there is no circle are one link."""
        welded = 0
        while True:
            pair = next(
                (
                    (one, other)
                    for one, other in combinations(self.parts.bodies[1:], 2)
                    if any(self.rims[k] < 0.0 for k in set(one.nodes) & set(other.nodes))
                ),
                None,
            )
            if pair is None:
                break
            self.parts.unite(*pair)
            welded += 1
        if welded:
            self.sketch.notes.append(
                ngettext(
                    "lines that meet without a circle are one link ({n} time)",
                    "lines that meet without a circle are one link ({n} times)",
                    welded,
                ).format(n=welded)
            )

    # The frame.

    def _ground(self, blocks: Sequence[SliderBlock]) -> None:
        """Nodes that signs of the frame touch are fixed; not those in a slider, which slides along the frame."""
        sliding = {self._nearest(one.centre, max(self.near, 0.2 * one.length)) for one in blocks}
        filled = [one for one in self.sketch.hatches if role_of(one.layer) in ("ground", "")]
        marks = [*self.strokes.get("ground", []), *filled]
        rings = [ring for ring in self.sketch.rings if role_of(ring.layer) == "ground"]
        arcs = [arc for arc in self.sketch.arcs if role_of(arc.layer) == "ground"]
        for k, place in enumerate(self.parts.places):
            rim = max(0.0, self.rims[k]) + self.near
            touched = any(_touches(mark, place, rim) for mark in marks) or any(
                math.dist(ring.centre, place) <= self.near for ring in (*rings, *arcs)
            )
            if touched and (
                k not in sliding or any(math.dist(ring.centre, place) <= self.near for ring in rings)
            ):
                self.parts.bodies[FRAME].nodes.append(k)

    def _guess_ground(self) -> None:
        """Where nothing marks the frame, ends of links at which no other is hinged are fixed."""
        frame = self.parts.bodies[FRAME]
        if frame.nodes or any(one.carrier == FRAME for one in self.parts.guided):
            return
        guided = {one.node for one in self.parts.guided}
        count = [sum(k in body.nodes for body in self.parts.bodies) for k in range(len(self.parts.places))]
        for body in self.parts.bodies[1:]:
            hangs_on = any(count[k] > 1 or k in guided for k in body.nodes)
            for k in body.nodes if hangs_on else ():
                # without circles a corner of a plate is a point of it, and the end of a bar a hinge
                is_hinge = self.rims[k] >= 0.0 if self._has_rings else len(body.nodes) == 2
                if count[k] == 1 and k not in guided and is_hinge:
                    frame.nodes.append(k)
        if not frame.nodes:
            what = _("no point is marked as fixed")
            raise InputError(self.where, what, _("put circles, hatching or lines on a layer named ground"))
        self.sketch.notes.append(
            _(
                "no layer is named ground, and nothing is hatched: ends of links where no other is hinged are fixed"
            )
        )

    # Guides.

    def _guide(self, blocks: Sequence[SliderBlock]) -> None:
        frame = set(self.parts.bodies[FRAME].nodes)
        rails = [side for stroke in self.strokes.get("guide", []) for side in _sides(stroke)]
        ground = [side for stroke in self.strokes.get("ground", []) for side in _sides(stroke)]
        used: set[int] = set()
        for block in blocks:
            node = self._nearest(block.centre, max(self.near, 0.2 * block.length))
            if node is None or not any(node in body.nodes for body in self.parts.bodies):
                self.sketch.leave_out(_("sliders without a hinge"))
                continue
            touching = [
                k
                for k, side in enumerate(rails)
                if parallel(block.direction, less(side[1], side[0]))
                and distance_to_line(block.centre, *side) <= block.half + self.near
            ]
            used |= set(touching)
            carrier = self._slot(block, node)
            fixed = touching or any(
                parallel(block.direction, less(*side))
                and distance_to_line(block.centre, *side) <= block.half + self.near
                for side in ground
            )
            if carrier is None and node in frame:
                self.sketch.leave_out(_("fixed sliders through which no link passes"))
                continue
            if carrier is None and not fixed:
                what = _("a slider has no guide")
                raise InputError(self.where, what, _("draw a line on a layer named guide beside it"))
            self.parts.guided.append(
                Guided(node, block.direction, FRAME if carrier is None or fixed else carrier)
            )
        for k in range(len(rails)):
            if k not in used:
                self._guide_by_line(k, rails, used)
        left = len(rails) - len(used)
        if left:
            self.sketch.leave_out(_("guides on which no point lies"), left)

    def _slot(self, block: SliderBlock, node: int) -> int | None:
        """The link along which a slider slides: one of its sides goes through the middle."""
        for number, body in enumerate(self.parts.bodies[1:], 1):
            if node in body.nodes:
                continue
            if any(
                self._is_on(block.centre, side) and parallel(block.direction, self._way(side))
                for side in body.sides
            ):
                return number
        return None

    def _guide_by_line(self, k: int, rails: Sequence[tuple[Place, Place]], used: set[int]) -> None:
        """A line on a layer of guides leads the moving points on it, two parallel ones the point midway."""
        start, end = rails[k]
        leads = [
            node
            for node in self._moving()
            if distance_to_segment(self.parts.places[node], start, end) <= self.near
        ]
        direction = unit(less(end, start))
        if leads:
            used.add(k)
            for node in leads:
                if all(one.node != node for one in self.parts.guided):
                    self.parts.guided.append(Guided(node, direction, FRAME))
            return
        for other in range(len(rails)):
            if other in (k, *used) or not parallel(direction, less(rails[other][1], rails[other][0])):
                continue
            for node in self._moving():
                here, there = (signed_distance(self.parts.places[node], *rails[one]) for one in (k, other))
                beyond = signed_distance(rails[other][0], start, end)
                same = signed_distance(self.parts.places[node], start, end)
                between = 0.0 < same / beyond < 1.0 if beyond else False
                share = along(self.parts.places[node], start, end)
                if between and abs(abs(here) - abs(there)) <= self.near and 0.0 <= share <= 1.0:
                    used |= {k, other}
                    self.parts.guided.append(Guided(node, direction, FRAME))
                    self.sketch.notes.append(
                        _("a point midway between two parallel guides slides along them")
                    )
                    return

    def _moving(self) -> Iterator[int]:
        for k in range(len(self.parts.places)):
            if k not in self.parts.bodies[FRAME].nodes and any(
                k in body.nodes for body in self.parts.bodies[1:]
            ):
                yield k

    # Names and drives.

    def _names(self) -> list[str]:
        """Letters that stand beside points, else letters in order."""
        names = [""] * len(self.parts.places)
        labels = [one for one in self.sketch.labels if role_of(one.layer) in ("name", "")]
        pairs = sorted(
            (math.dist(label.place, place), k, name)
            for label in labels
            if (name := _point_name(label)) is not None
            for k, place in enumerate(self.parts.places)
        )
        for apart, k, name in pairs:
            if (
                apart <= LETTERS_APART * self.size + 2.0 * max(0.0, self.rims[k])
                and not names[k]
                and name not in names
            ):
                names[k] = name
        letters = (
            f"{letter}{number}" for number in ("", *range(1, 99)) for letter in "ABCDEFGHJKLMNPQRSTUVW"
        )
        for k in range(len(names)):
            names[k] = names[k] or next(name for name in letters if name not in names)
        unused = sum(1 for one in labels if _point_name(one) not in names)
        if unused:
            self.sketch.leave_out(_("texts that name no point"), unused)
        return names

    def _driven_bodies(self) -> list[int]:
        """Links on a layer of drives, and those at whose fixed hinge an arc or an arrow of that layer is drawn."""
        found = [
            number
            for number, body in enumerate(self.parts.bodies)
            if number != FRAME and role_of(body.layer) == "drive"
        ]
        arrows = [_circle_centre(one.points) for one in self.strokes.get("drive", []) if len(one.points) > 4]
        arrows += [arc.centre for arc in self.sketch.arcs if role_of(arc.layer) == "drive"]
        for centre in arrows:
            node = None if centre is None else self._nearest(centre, 10.0 * self.near)
            hinged = [k for k, body in enumerate(self.parts.bodies[1:], 1) if node in body.nodes]
            if node in self.parts.bodies[FRAME].nodes and len(hinged) == 1 and hinged[0] not in found:
                found += hinged
            else:
                self.sketch.leave_out(_("signs of drives at no fixed hinge of one link"))
        return found


def _point_name(label: Label) -> str | None:
    try:
        name: str = read_name(label.text.strip())
    except Problem:
        return None
    return name if len(name) <= 4 else None


# Shapes of the signs.


def _sides(stroke: Polyline) -> Iterator[tuple[Place, Place]]:
    points = (*stroke.points, stroke.points[0]) if stroke.closed else stroke.points
    return iter(pairwise(points))


def _touches(mark: Polyline, place: Place, within: float) -> bool:
    """Whether a sign goes through the circle around a place, or a closed one holds it."""
    if any(distance_to_segment(place, *side) <= within for side in _sides(mark)):
        return True
    if not mark.closed:
        return False
    inside = False
    x, y = place
    for (a, b), (c, d) in _sides(mark):
        if (b > y) != (d > y) and x < a + (y - b) / (d - b) * (c - a):
            inside = not inside
    return inside


def _block(stroke: Polyline) -> SliderBlock | None:
    """A stroke as a slider where it is a rectangle."""
    if not stroke.closed or len(stroke.points) != 4:
        return None
    a, b, c, d = stroke.points
    ways = [less(end, start) for start, end in pairwise((a, b, c, d, a))]
    lengths = [math.hypot(*way) for way in ways]
    if min(lengths) <= 0.0:
        return None
    for k in range(4):
        one, other = ways[k], ways[k - 1]
        if abs(one[0] * other[0] + one[1] * other[1]) > RIGHT_ANGLE * lengths[k] * lengths[k - 1]:
            return None
    longer = 0 if lengths[0] >= lengths[1] else 1
    centre = (sum(x for x, _y in stroke.points) / 4.0, sum(y for _x, y in stroke.points) / 4.0)
    return SliderBlock(centre, unit(ways[longer]), 0.5 * lengths[1 - longer], lengths[longer])


def _in_axes(block: SliderBlock, place: Place) -> Place:
    """How far a place is from the middle of a slider along it and across."""
    off = less(place, block.centre)
    (x, y) = block.direction
    return abs(off[0] * x + off[1] * y), abs(off[0] * y - off[1] * x)


def _slot_axis(stroke: Polyline) -> tuple[Place, Place, float] | None:
    """Centres of the round ends of an outline, and half of its breadth; None of other outlines."""
    if not stroke.closed or len(stroke.points) < 8:
        return None
    sides = sorted(_sides(stroke), key=lambda side: -math.dist(*side))
    (a, b), (c, d) = sides[:2]
    length = math.dist(a, b)
    if abs(math.dist(c, d) - length) > 0.02 * length or not parallel(less(b, a), less(d, c)):
        return None
    if len(sides) > 2 and math.dist(*sides[2]) > 0.5 * length:
        return None
    half = 0.5 * abs(signed_distance(c, a, b))
    start, end = _middle(a, d), _middle(b, c)
    # the ends are round: all corners are half a breadth away from the middle line
    off = [distance_to_segment(place, start, end) for place in stroke.points]
    if not 0.0 < half < 0.5 * length or max(off) > 1.05 * half or min(off) < 0.9 * half:
        return None
    return start, end, half


def _middle(one: Place, other: Place) -> Place:
    return 0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])


def _circle_centre(places: Sequence[Place]) -> Place | None:
    """Centre of the circle through the ends and the middle of an arc; None of a straight line."""
    a, b, c = places[0], places[len(places) // 2], places[-1]
    (u, v), (p, q) = less(b, a), less(c, a)
    double = 2.0 * (u * q - v * p)
    if abs(double) <= 1e-6 * (math.hypot(u, v) * math.hypot(p, q) or 1.0):
        return None
    one, other = u * u + v * v, p * p + q * q
    return a[0] + (q * one - v * other) / double, a[1] + (u * other - p * one) / double
