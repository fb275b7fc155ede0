"""How much the motions of the higher oracle answer to their numbers, by which tests know what rounding may do."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from typing import Any

import mpmath as mp
from oracle_fields import DIGITS
from oracle_solving import Higher, Started, Vector, beside, jacobian

STEP = mp.mpf(2) ** -30
TRIES = 8
DIFFERENCE = mp.mpf(10) ** -9
LENGTHS = ("length", "radius", "through", "centre", "pole", "points")


def scale(case: Higher) -> float:
    """The greatest length of a description [m]; 1 on the sphere."""
    if case.parts.get("space") == "sphere":
        return 1.0
    fixed = [complex(*v) for v in case.parts["frame"]["points"].values()]
    found = [abs(a - b) for a in fixed for b in fixed]
    for link in case.parts["links"].values():
        local = link.get("points", {})
        at = [complex(*v) for v in local.values()] if isinstance(local, Mapping) else []
        found += [abs(a - b) for a in at for b in at] + [link.get("length", 0.0)]
    for wheel in case.parts.get("rolling", ()):
        found += [wheel["radius"], wheel["along"].get("radius", 0.0)]
    return float(max(found))


def unit(case: Higher) -> float:
    """What one of the drive's value counts as: 1 rad, 1 s or the greatest length."""
    return 1.0 if case.laws or "link" in case.parts["drives"][0] else scale(case)


def nudged(case: Higher, chance: random.Random) -> dict[str, Any]:
    """The description with every number changed by up to STEP of the greatest length (of one, of itself)."""
    length = mp.mpf(scale(case))

    def changed(value: Any, key: str) -> Any:
        if isinstance(value, Mapping):
            return {name: changed(v, key if key == "points" else name) for name, v in value.items()}
        if isinstance(value, list):
            return [changed(v, key) for v in value]
        if isinstance(value, str | bool):
            return value
        size = length if key in LENGTHS else max(abs(mp.mpf(value)), 1)
        return mp.mpf(value) + STEP * size * chance.uniform(-1, 1)

    return {key: v if key in ("drives", "space") else changed(v, key) for key, v in case.parts.items()}


def differences(case: Higher, f: Any, q: Any, x: Vector, inverse: list[Vector]) -> dict[str, list[Any]]:
    """Outputs with first and second derivative; `f(q, x)` are the equations."""
    outputs = []
    model = case.model(DIGITS)
    for k in (-2, -1, 0, 1, 2):
        at = q + k * DIFFERENCE
        outputs.append(model.outputs(beside(lambda y, at=at: f(at, y), x, inverse)))
    found = {}
    for name in outputs[2]:
        a, b, c, d, e = (o[name] for o in outputs)
        first = (a - 8 * b + 8 * d - e) / (12 * DIFFERENCE)
        second = (-a + 16 * b - 30 * c + 16 * d - e) / (12 * DIFFERENCE**2)
        found[name] = [c, first, second]
    return found


def sampled(case: Higher, start: Started, q: Any, x: Vector) -> tuple[dict[str, list[Any]], list[float]]:
    """Outputs at a value of the drive with their derivatives, and the condition of each order."""
    model = case.model(DIGITS)

    def exact(at: Any, y: Vector) -> Vector:
        return model.equations(case.values(at), y, start.phases)

    inverse = mp.inverse(jacobian(lambda y: exact(q, y), x)).tolist()
    found = differences(case, exact, q, x, inverse)
    chance = random.Random(case.name + repr(float(q)))
    answers = [mp.mpf(0)] * 3
    for _ in range(TRIES):
        f, moved = _changed(case, start, q, chance)
        other = differences(case, f, moved, x, inverse)
        answers = [max(answers[k], _apart(case, found, other, k)) for k in range(3)]
    return found, [float(max(a / STEP, mp.mpf(unit(case)) ** -k)) for k, a in enumerate(answers)]


def _changed(case: Higher, start: Started, q: Any, chance: random.Random) -> tuple[Any, Any]:
    """Equations with changed numbers, and the changed value of the drive."""
    model = case.model(DIGITS, nudged(case, chance))
    phases = {k: v + STEP * max(1, abs(v)) * chance.uniform(-1, 1) for k, v in start.phases.items()}
    factors = [1 + STEP * chance.uniform(-1, 1) for _ in case.parts["drives"]]
    moved = q + STEP * chance.choice([-1, 1]) * max(abs(q), mp.mpf(unit(case)))

    def f(at: Any, y: Vector) -> Vector:
        values = case.values(at)
        if case.laws:
            values = [v * factor for v, factor in zip(values, factors, strict=True)]
        return model.equations(values, y, phases)

    return f, moved


def _apart(case: Higher, a: Mapping[str, Sequence[Any]], b: Mapping[str, Sequence[Any]], order: int) -> Any:
    """The greatest difference of outputs, lengths in the greatest length."""
    lengths = mp.mpf(scale(case))
    return max(
        abs(a[name][order] - b[name][order]) / (1 if name.startswith("angle") else lengths) for name in a
    )


def limit_condition(case: Higher, start: Started, x: Vector, q: Any) -> float:
    """How much a limit answers to the numbers, in rad, s or the greatest length."""
    model = case.model(DIGITS)
    matrix = jacobian(lambda y: model.equations(case.values(q), y, start.phases), x)
    left = _left_null(matrix)
    ahead, behind = (model.equations(case.values(q + d), x, start.phases) for d in (DIFFERENCE, -DIFFERENCE))
    rate = mp.fdot(left, [(a - b) / (2 * DIFFERENCE) for a, b in zip(ahead, behind, strict=True)])
    chance = random.Random(case.name)
    answer = abs(q)
    for _ in range(TRIES):
        f, _moved = _changed(case, start, q, chance)
        answer = max(answer, abs(mp.fdot(left, f(q, x)) / rate) / STEP)
    return float(max(answer / mp.mpf(unit(case)), 1))


def _left_null(matrix: Any) -> Vector:
    """The unit vector that a singular matrix makes vanish from the left, by inverse iteration."""
    slightly = matrix.T + mp.mpf(10) ** -30 * mp.eye(matrix.rows)
    v = mp.matrix([1] * matrix.rows)
    for _ in range(4):
        v = mp.lu_solve(slightly, v)
        v = v / mp.norm(v)
    return list(v)
