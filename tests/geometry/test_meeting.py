"""Derivatives of meeting points against series in 40 digits of a closed form of their own."""

from __future__ import annotations

import math
from typing import Any

import mpmath as mp
import numpy as np
import pytest

from centrode.geometry.in_plane import PLANE
from centrode.geometry.intersections import meet_circle_and_line, meet_circles, meet_circles_on_sphere
from centrode.geometry.on_sphere import SPHERE, SphereCircle
from centrode.geometry.plane import Line, PlaneCircle
from centrode.geometry.sphere import half, unit_vector
from centrode.numerics.expressions import EXPRESSIONS, Node, as_node, variable
from centrode.numerics.graphs import Graph, gradient
from centrode.numerics.jets import Jet, JetFunctions
from centrode.numerics.scans import evaluate
from samples import few

ORDER = 5
DIGITS = 40
EPS = 2.0**-52
JETS = JetFunctions(math)


def closed(one: tuple[Any, ...], other: tuple[Any, ...], side: int) -> tuple[Any, Any]:
    """Where circles (x, y, radius) meet, by the angle at the first centre."""
    x, y, r = one
    apart = mp.hypot(other[0] - x, other[1] - y)
    angle = mp.acos((apart**2 + r**2 - other[2] ** 2) / (2 * apart * r))
    towards = mp.atan2(other[1] - y, other[0] - x) + side * angle
    return x + r * mp.cos(towards), y + r * mp.sin(towards)


def moving(random: np.random.Generator, count: int) -> list[list[float]]:
    """Coefficients of numbers that move: (numbers, ORDER + 1)."""
    return (
        random.uniform(-1, 1, (count, ORDER + 1)) / [math.factorial(k) for k in range(ORDER + 1)]
    ).tolist()


def exact(coefficients: list[list[float]], side: int) -> list[list[Any]]:
    """Taylor's coefficients of the place."""
    with mp.workdps(DIGITS):

        def at(t: Any, axis: int) -> Any:
            values = [mp.polyval([mp.mpf(c) for c in reversed(one)], t) for one in coefficients]
            return closed(tuple(values[:3]), tuple(values[3:]), side)[axis]

        return [mp.taylor(lambda t, axis=axis: at(t, axis), 0, ORDER) for axis in (0, 1)]


@pytest.mark.parametrize("fixed", ["nothing", "radii", "a circle"])
@pytest.mark.parametrize("seed", range(12))
def test_derivatives_of_every_order(seed: int, fixed: str) -> None:
    random = np.random.default_rng(seed)
    numbers = moving(random, 6)
    numbers[2][0], numbers[5][0] = random.uniform(1.0, 2.0, 2)
    # centres as far apart as leaves the triangle open
    numbers[3][0] = numbers[0][0] + random.uniform(0.6, 0.9) * (numbers[2][0] + numbers[5][0])
    numbers[4][0] = numbers[1][0]
    still = {"nothing": (), "radii": (2, 5), "a circle": (3, 4, 5)}[fixed]
    for i in still:
        numbers[i][1:] = [0.0] * ORDER
    side = 1 if seed % 2 else -1
    given = [one[0] if i in still else Jet(one) for i, one in enumerate(numbers)]
    found = meet_circles(
        PlaneCircle((given[0], given[1]), given[2]),
        PlaneCircle((given[3], given[4]), given[5]),
        lambda x: side * JETS.sqrt(x),
    )
    expected = exact(numbers, side)
    # each order divides by the sine of the triangle once more
    sine = float(abs(mp.sin(_turn(numbers, side))))
    for series, true in zip(found, expected, strict=True):
        for k, (one, other) in enumerate(zip(series.coefficients, true, strict=True)):
            greatest = max(1.0, *(abs(float(x)) for x in (*expected[0], *expected[1])))
            assert abs(one - float(other)) <= 64 * EPS * greatest / sine ** (2 * k + 1), k


def on_line(numbers: tuple[Any, ...], side: int) -> tuple[Any, Any]:
    """Where a circle (x, y, radius) meets a line (x, y, angle), by lengths along it from its point."""
    x, y, r, px, py, angle = numbers
    towards = mp.atan2(y - py, x - px) - angle
    apart = mp.hypot(x - px, y - py)
    length = apart * mp.cos(towards) + side * mp.sqrt(r**2 - (apart * mp.sin(towards)) ** 2)
    return px + length * mp.cos(angle), py + length * mp.sin(angle)


@pytest.mark.parametrize("still", ["nothing", "the line", "the radius and the angle"])
@pytest.mark.parametrize("seed", range(12))
def test_derivatives_on_lines(seed: int, still: str) -> None:
    random = np.random.default_rng(100 + seed)
    numbers = moving(random, 6)
    numbers[2][0], numbers[5][0] = random.uniform(2.0, 3.0), random.uniform(-3.0, 3.0)
    stand = {"nothing": (), "the line": (3, 4, 5), "the radius and the angle": (2, 5)}[still]
    for i in stand:
        numbers[i][1:] = [0.0] * ORDER
    side = 1 if seed % 2 else -1
    given = [one[0] if i in stand else Jet(one) for i, one in enumerate(numbers)]
    direction = (
        (math.cos(given[5]), math.sin(given[5])) if 5 in stand else (JETS.cos(given[5]), JETS.sin(given[5]))
    )
    found = meet_circle_and_line(
        PlaneCircle((given[0], given[1]), given[2]),
        Line((given[3], given[4]), direction),
        lambda x: side * JETS.sqrt(x),
    )
    with mp.workdps(DIGITS):

        def at(t: Any, axis: int) -> Any:
            values = tuple(mp.polyval([mp.mpf(c) for c in reversed(one)], t) for one in numbers)
            return on_line(values, side)[axis]

        expected = [mp.taylor(lambda t, axis=axis: at(t, axis), 0, ORDER) for axis in (0, 1)]
    x, y, radius, px, py, angle = (one[0] for one in numbers)
    distance = math.sin(angle) * (x - px) - math.cos(angle) * (y - py)
    sine = math.sqrt(1.0 - (distance / radius) ** 2)
    greatest = max(1.0, *(abs(float(x)) for x in (*expected[0], *expected[1])))
    for series, true in zip(found, expected, strict=True):
        for k, (one, other) in enumerate(zip(series.coefficients, true, strict=True)):
            assert abs(one - float(other)) <= 64 * EPS * greatest / sine ** (2 * k + 1), k


def on_sphere(numbers: list[Any], side: int) -> list[Any]:
    """Where circles (longitude, latitude, arc) meet, by the angle at the first centre."""
    (one, r), (other, s) = (
        (mp.matrix([mp.cos(b) * mp.cos(a), mp.cos(b) * mp.sin(a), mp.sin(b)]), arc)
        for a, b, arc in (numbers[:3], numbers[3:])
    )
    cosine = (one.T * other)[0]
    sine = mp.sqrt(1 - cosine**2)
    ahead = (other - cosine * one) / sine
    left = mp.matrix(
        [one[(i + 1) % 3] * ahead[(i + 2) % 3] - one[(i + 2) % 3] * ahead[(i + 1) % 3] for i in range(3)]
    )
    turn = side * mp.acos((mp.cos(s) - mp.cos(r) * cosine) / (mp.sin(r) * sine))
    return list(mp.cos(r) * one + mp.sin(r) * (mp.cos(turn) * ahead + mp.sin(turn) * left))


def _flatness(numbers: list[float], place: list[Any]) -> float:
    """Sine of the angle at the meeting place: the triple product of the three over the sines of the arcs."""
    with mp.workdps(DIGITS):
        rows = [
            [mp.cos(b) * mp.cos(a), mp.cos(b) * mp.sin(a), mp.sin(b)] for a, b in (numbers[:2], numbers[3:5])
        ]
        volume = mp.det(mp.matrix([*rows, place]))
        return float(abs(volume) / (mp.sin(numbers[2]) * mp.sin(numbers[5])))


@pytest.mark.parametrize("size", [1.0, 1e-3])
@pytest.mark.parametrize("still", ["nothing", "the arcs", "a circle"])
@pytest.mark.parametrize("seed", range(few(2, 6)))
def test_derivatives_on_the_sphere(seed: int, still: str, size: float) -> None:
    """Linkages of any size: errors are measured against the size."""
    random = np.random.default_rng(200 + seed)
    numbers = [[size * x for x in one] for one in moving(random, 6)]
    numbers[2][0], numbers[5][0] = size * random.uniform(0.4, 0.7, 2)
    numbers[3][0] = numbers[0][0] + random.uniform(0.6, 0.9) * (numbers[2][0] + numbers[5][0])
    numbers[4][0] = numbers[1][0] = size * random.uniform(-0.2, 0.2)
    stand = {"nothing": (), "the arcs": (2, 5), "a circle": (3, 4, 5)}[still]
    for i in stand:
        numbers[i][1:] = [0.0] * ORDER
    side = 1 if seed % 2 else -1
    given = [one[0] if i in stand else Jet(one) for i, one in enumerate(numbers)]
    circles: list[Any] = []
    for longitude, latitude, arc in (given[:3], given[3:]):
        centre = (
            JETS.cos(latitude) * JETS.cos(longitude),
            JETS.cos(latitude) * JETS.sin(longitude),
            JETS.sin(latitude),
        )
        circles += [centre, (JETS.sin(0.5 * arc), JETS.cos(0.5 * arc))]
    found = meet_circles_on_sphere(*circles, lambda x: side * JETS.sqrt(x))
    with mp.workdps(DIGITS):

        def at(t: Any, axis: int) -> Any:
            return on_sphere([mp.polyval([mp.mpf(c) for c in reversed(one)], t) for one in numbers], side)[
                axis
            ]

        expected = [mp.taylor(lambda t, axis=axis: at(t, axis), 0, ORDER) for axis in range(3)]
    sine = _flatness([one[0] for one in numbers], [axis[0] for axis in expected])
    greatest = max(size, *(abs(float(x)) for axis in expected for x in axis[1:]))
    for series, true in zip(found, expected, strict=True):
        for k, (one, other) in enumerate(zip(series.coefficients[1:], true[1:], strict=True), 1):
            # places are known to an eps of one, chords to that over the size
            assert abs(one - float(other)) <= 64 * EPS / size * greatest / sine ** (2 * k + 1), k


def _turn(numbers: list[list[float]], side: int) -> Any:
    """Angle between the arms at the meeting point."""
    values = [one[0] for one in numbers]
    x, y = closed(tuple(values[:3]), tuple(values[3:]), side)
    return mp.atan2(y - values[1], x - values[0]) - mp.atan2(y - values[4], x - values[3])


def test_circles_that_stand() -> None:
    """Plain numbers give a plain place, with the bits of the moving one's value."""
    one, other = ((0.0, 0.0), 3.0), ((5.0, 0.0), 4.0)
    plain = meet_circles(PlaneCircle(*one), PlaneCircle(*other), math.sqrt)
    assert plain == pytest.approx((1.8, 2.4), rel=EPS * 4)
    moves = meet_circles(PlaneCircle((Jet((0.0, 1.0)), 0.0), 3.0), PlaneCircle(*other), JETS.sqrt)
    assert tuple(x.value for x in moves) == plain


def test_touching_circles_have_no_finite_velocity() -> None:
    centre = Jet((np.float64(0.0), 1.0)), 0.0
    with np.errstate(all="ignore"):
        moves = meet_circles(PlaneCircle(centre, 2.0), PlaneCircle((5.0, 0.0), 3.0), JetFunctions(np).sqrt)
    assert [float(x.value) for x in moves] == [2.0, 0.0]
    assert not all(np.isfinite(x.coefficients[1]) for x in moves)


@pytest.mark.parametrize("space", ["two circles", "a circle and a line", "the sphere"])
@pytest.mark.parametrize("seed", range(4))
def test_implied_places_have_the_derivatives_of_closed_forms(space: str, seed: int) -> None:
    """By every number of the loci: what is held gives no derivatives, and nothing else is left out."""
    random = np.random.default_rng(seed)
    count = {"two circles": 6, "a circle and a line": 6, "the sphere": 8}[space]
    names = [variable(f"x{k}") for k in range(count)]
    held: dict[str, Node] = {}

    def hold(number: Any) -> Any:
        name = f"held {len(held)}"
        held[name] = as_node(number)
        return variable(name)

    def root(radicand: Any) -> Any:
        return roots.setdefault("", m.sqrt(radicand) * (1.0 if seed % 2 else -1.0))

    m, roots = EXPRESSIONS, {}
    if space == "the sphere":
        # unit vectors by longitude and latitude, and half arcs by arcs
        longitude, latitude = random.uniform(-1, 1, 2), random.uniform(-0.5, 0.5, 2)
        values = [longitude[0], latitude[0], 0.9, longitude[0] + 0.7, latitude[1], 0.8, 1.0, 1.0]
        circles = [
            SphereCircle(unit_vector(m, (names[k], names[k + 1])), half(m, names[k + 2] * names[6 + k // 3]))
            for k in (0, 3)
        ]
        place = SPHERE.meet(*circles, root, lambda x: x)
        implied = SPHERE.implied_place(*circles, place, roots[""], hold)
    else:
        one = PlaneCircle((names[0], names[1]), names[2])
        if space == "two circles":
            values = [*random.uniform(-0.3, 0.3, 2), 1.2, *random.uniform(0.7, 1.0, 2), 0.9]
            other: Any = PlaneCircle((names[3], names[4]), names[5])
        else:
            values = [*random.uniform(-0.3, 0.3, 2), 1.2, *random.uniform(-0.3, 0.3, 3)]
            other = Line((names[3], names[4]), (m.cos(names[5]), m.sin(names[5])))
        place = PLANE.meet(one, other, root, lambda x: x)
        implied = PLANE.implied_place(one, other, place, roots[""], hold)
    at = dict(zip((str(x.detail) for x in names), map(float, values), strict=True))
    for closed, other in zip(place, implied, strict=True):
        expected = Graph.of(dict(zip(at, gradient(closed, names), strict=True)))
        found = Graph.of(dict(zip(at, gradient(other, names), strict=True))).substitute(held)
        for name, slope in evaluate(expected, at).items():
            # sines of the triangles are above 0.2: some fifty operations round once
            assert abs(evaluate(found, at)[name] - slope) <= 50 * EPS * max(1.0, abs(slope)) / 0.2**2, name
