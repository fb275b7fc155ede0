"""Four-bar and slider-crank loops of a mechanism, and which of their links turn fully: Grashof's rule.

On the sphere two arcs whose sum exceeds pi are replaced by their supplements (a hinge is exchanged for the
opposite one on its axis), until no two arcs together exceed pi; then the rule of the plane holds as it is
(Chiang, Kinematics of Spherical Mechanisms, 1988).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, permutations
from math import pi

from centrode.algebra.arrays import ARRAYS
from centrode.geometry.plane import cross, subtract
from centrode.kinematics.prepared import Ready
from centrode.locale import _, mark
from centrode.model.mechanism import FRAME, Guide, Mechanism
from centrode.model.names import body_word
from centrode.quantities import display_unit
from centrode.structure.dimensions import Dimensions

ROUNDING = 16 * 2.0**-52
"""Sums of lengths that differ by less than this part of them are equal."""

CRANK_ROCKER, DOUBLE_CRANK = mark("crank-rocker"), mark("double crank")
DOUBLE_ROCKER, ROCKER_CRANK = mark("double rocker, the coupler turns fully"), mark("rocker-crank")
TRIPLE_ROCKER, CHANGE_POINT = mark("triple rocker"), mark("change-point linkage")
TURNS = mark("the shortest link turns fully")
NONE_TURNS = mark("no link turns fully against another")
SLIDER_CRANK = mark("slider-crank, the crank turns fully")
SLIDER_COUPLER = mark("slider-crank, the coupler turns fully, the crank swings")
SLIDER_ROCKER = mark("slider-crank, no link turns fully")
TURNING_GUIDE, SWINGING_GUIDE = mark("crank and turning guide"), mark("crank and swinging guide")
SWINGING_ALL = mark("swinging guide, no link turns fully")


@dataclass(frozen=True)
class FourBar:
    """A loop of four links, or of three links and a slider, with the rule that decides how it turns.

    Attributes
    ----------
    bodies : names around the loop, the fixed link first where it belongs to the loop; a slider by its guide
    lengths : [m, rad on the sphere] of the bodies in the same order; of a slider's guide the offset
    reduced : on the sphere the arcs by which the rule decides, otherwise the lengths
    grashof : whether the shortest link turns fully against all others; None at a change point
    shortest : its name; in a change-point loop the first of the shortest
    kind : the type in words, as seen from the fixed link (and the drive, if it belongs to the loop)
    inequality : the rule with the numbers in it
    """

    bodies: tuple[str, ...]
    lengths: tuple[float, ...]
    reduced: tuple[float, ...]
    grashof: bool | None
    shortest: str
    kind: str
    inequality: str


def four_bars_of(prepared: Ready) -> tuple[FourBar, ...]:
    """Every loop of four hinged links, and of three with a slider on a guide, in the order of the description."""
    mechanism, numbers = prepared.mechanism, prepared.kinematics.numbers
    found = [_hinged(mechanism, numbers, bodies, pins) for bodies, pins in _loops(mechanism)]
    if mechanism.space == "plane":
        found += [loop for guide in mechanism.guides for loop in _slider_loops(mechanism, numbers, guide)]
    return tuple(found)


def _points(mechanism: Mechanism) -> dict[str, tuple[str, ...]]:
    """Points of the frame and of every link."""
    links = {name: tuple(link.coordinates) for name, link in mechanism.links.items()}
    return {FRAME: tuple(mechanism.frame.points), **links}


def _loops(mechanism: Mechanism) -> Iterator[tuple[tuple[str, ...], tuple[str, ...]]]:
    """Loops of four bodies and the pins between them: pins[k] joins body k and the next one."""
    points = _points(mechanism)
    at_point: dict[str, list[str]] = {}
    for body, names in points.items():
        for name in names:
            at_point.setdefault(name, []).append(body)
    shared: dict[str, dict[str, list[str]]] = {body: {} for body in points}
    for name, bodies in at_point.items():
        for one, other in permutations(bodies, 2):
            shared[one].setdefault(other, []).append(name)
    rank = {body: k for k, body in enumerate(points)}
    for first in points:
        behind = [body for body in shared[first] if rank[body] > rank[first]]
        for second, last in combinations(sorted(behind, key=rank.__getitem__), 2):
            if last in shared[second]:
                continue
            for third in shared[second]:
                if rank[third] > rank[first] and third in shared[last] and third not in shared[first]:
                    loop = (first, second, third, last)
                    pins = [shared[loop[k]][loop[(k + 1) % 4]] for k in range(4)]
                    if all(len(pin) == 1 for pin in pins) and len({pin[0] for pin in pins}) == 4:
                        yield loop, tuple(pin[0] for pin in pins)


def _hinged(
    mechanism: Mechanism, numbers: Dimensions, bodies: tuple[str, ...], pins: tuple[str, ...]
) -> FourBar:
    lengths = tuple(_distance(numbers, body, pins[k - 1], pins[k]) for k, body in enumerate(bodies))
    reduced = reduced_arcs(lengths) if mechanism.space == "sphere" else lengths
    order = sorted(range(4), key=lambda k: reduced[k])
    shortest, longest = order[0], order[3]
    short, long = reduced[shortest] + reduced[longest], reduced[order[1]] + reduced[order[2]]
    verdict = _compared(short, long)
    sign = "=" if verdict is None else "<" if verdict else ">"
    inequality = f"{_shown(mechanism, numbers, short)} {sign} {_shown(mechanism, numbers, long)}: " + _(
        "shortest and longest ({one}, {other}) against the others"
    ).format(one=body_word(bodies[shortest]), other=body_word(bodies[longest]))
    kind = _kind(mechanism, bodies, shortest, verdict)
    return FourBar(bodies, lengths, reduced, verdict, bodies[shortest], kind, inequality)


def reduced_arcs(arcs: Sequence[float]) -> tuple[float, ...]:
    """Arcs of an equivalent spherical four-bar no two of which together exceed half a great circle."""
    found = list(arcs)
    while True:
        first, second = sorted(range(4), key=lambda k: -found[k])[:2]
        if found[first] + found[second] <= pi:
            return tuple(found)
        found[first], found[second] = pi - found[first], pi - found[second]


def _shown(mechanism: Mechanism, numbers: Dimensions, length: float) -> str:
    """A length, on the sphere an arc, in the units of the reader."""
    factor, unit = display_unit(numbers.space.unit, mechanism.display.length, mechanism.display.angle)
    return f"{length * factor:.6g} {unit}"


def _compared(short: float, long: float) -> bool | None:
    """Whether a sum is the smaller one; None where both are equal but for rounding."""
    if abs(short - long) <= ROUNDING * (abs(short) + abs(long)):
        return None
    return short < long


def _kind(mechanism: Mechanism, bodies: tuple[str, ...], shortest: int, verdict: bool | None) -> str:
    if verdict is None:
        return CHANGE_POINT
    if bodies[0] != FRAME:
        return TURNS if verdict else NONE_TURNS
    if not verdict:
        return TRIPLE_ROCKER
    if shortest == 0:
        return DOUBLE_CRANK
    if shortest == 2:
        return DOUBLE_ROCKER
    driven = {drive.link for drive in mechanism.drives if drive.relative_to == FRAME}
    other = bodies[4 - shortest]
    return ROCKER_CRANK if other in driven and bodies[shortest] not in driven else CRANK_ROCKER


def _distance(numbers: Dimensions, body: str, first: str, second: str) -> float:
    """Distance of two points of a body [m], on the sphere their arc [rad]."""
    local: Mapping[str, tuple[float, float]] = numbers.frame if body == FRAME else numbers.local[body]
    space = numbers.space
    one, other = (space.place(ARRAYS, space.at_rest, local[point]) for point in (first, second))
    return float(space.distance(ARRAYS, one, other))


def _slider_loops(mechanism: Mechanism, numbers: Dimensions, guide: Guide) -> Iterator[FourBar]:
    """Loops of the body with the guide, two links hinged together, and a slider that turns on the last one."""
    points = _points(mechanism)
    carrier = guide.on
    sliding = [name for name in mechanism.links if guide.point in points[name] and name != guide.link]
    for coupler in [name for name in sliding if name != carrier] + _frame_end(points, guide, carrier):
        for crank in points:
            if crank in (carrier, coupler, guide.link):
                continue
            pivots = [p for p in points[crank] if p in points[carrier]]
            pins = [p for p in points[crank] if p in points[coupler] and p != guide.point]
            if len(pivots) == 1 and len(pins) == 1 and pivots[0] != pins[0]:
                loop = (carrier, crank, coupler)
                yield _sliding(mechanism, numbers, guide, loop, (pivots[0], pins[0]))


def _frame_end(points: Mapping[str, tuple[str, ...]], guide: Guide, carrier: str) -> list[str]:
    """The frame, where it holds the guided point itself."""
    return [FRAME] if guide.point in points[FRAME] and carrier != FRAME else []


def _sliding(
    mechanism: Mechanism,
    numbers: Dimensions,
    guide: Guide,
    loop: tuple[str, str, str],
    pins: tuple[str, str],
) -> FourBar:
    carrier, crank, coupler = loop
    pivot, pin = pins
    local = numbers.frame if carrier == FRAME else numbers.local[carrier]
    offset = abs(float(cross(numbers.direction[guide.id], subtract(local[pivot], numbers.through[guide.id]))))
    one, other = _distance(numbers, crank, pivot, pin), _distance(numbers, coupler, pin, guide.point)
    short, long = min(one, other) + offset, max(one, other)
    verdict = _compared(short, long)
    shortest = crank if one <= other else coupler
    sign = "=" if verdict is None else "<" if verdict else ">"
    inequality = f"{_shown(mechanism, numbers, short)} {sign} {_shown(mechanism, numbers, long)}: " + _(
        "shorter link {one} and offset against the longer one"
    ).format(one=shortest)
    bodies, lengths = (carrier, crank, coupler, f"{guide.id}"), (offset, one, other)
    kind = _slider_kind(loop, shortest, verdict)
    return FourBar(bodies, lengths, lengths, verdict, shortest, kind, inequality)


def _slider_kind(loop: tuple[str, str, str], shortest: str, verdict: bool | None) -> str:
    carrier, crank, _coupler = loop
    if verdict is None:
        return CHANGE_POINT
    if FRAME not in loop:
        return TURNS if verdict else NONE_TURNS
    if carrier == FRAME:
        if not verdict:
            return SLIDER_ROCKER
        return SLIDER_CRANK if shortest == crank else SLIDER_COUPLER
    if not verdict:
        return SWINGING_ALL
    return TURNING_GUIDE if shortest == FRAME else SWINGING_GUIDE
