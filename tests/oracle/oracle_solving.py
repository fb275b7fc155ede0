"""Newton's method for the higher oracle: traces in doubles, solutions in sixty digits, limits by F = 0 and J v = 0."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import mpmath as mp
import numpy as np
from oracle_bodies import Plane
from oracle_fields import DIGITS, FLOATS, Field
from oracle_sphere import Sphere

Vector = list[Any]
Equations = Callable[[Vector], Vector]

SMALL = mp.mpf(10) ** -25
ENOUGH = mp.mpf(10) ** -55
TRACE = 0.02
"""Length of a step of a trace, in metres and radians."""


@dataclass(frozen=True)
class Higher:
    """A mechanism, rough places to start from, and what chooses its samples.

    `angles` are rough angles where points do not tell them; `meshing` says for each gear and wheel which output has
    which exact value in the initial position; `laws` are those of several drives by time; `dropped` are wheels that
    something else keeps at their distance; `exact` asks for initial angles in full.
    """

    name: str
    parts: dict[str, Any]
    points: Mapping[str, Sequence[float]]
    angles: Mapping[str, float] = field(default_factory=dict)
    meshing: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    laws: tuple[Callable[[Any], Any], ...] = ()
    dropped: tuple[str, ...] = ()
    exact: bool = False
    width: float = 0.6

    def model(self, numbers: Field, parts: Mapping[str, Any] | None = None) -> Plane | Sphere:
        """The equations in a kind of numbers."""
        found = self.parts if parts is None else parts
        if found.get("space") == "sphere":
            return Sphere(found, numbers)
        return Plane(found, numbers, self.dropped)

    @property
    def start(self) -> float:
        """Value of the drive in the initial position; with several drives the time."""
        return 0.0 if self.laws else float(self.parts["drives"][0]["start"])

    def values(self, q: Any) -> list[Any]:
        """Values of the drives at a value of the drive (a time)."""
        if not self.laws:
            return [q]
        drives = self.parts["drives"]
        return [mp.mpf(drive["start"]) + law(q) for drive, law in zip(drives, self.laws, strict=True)]


@dataclass(frozen=True)
class Started:
    """The initial position and what gears and wheels keep from it."""

    x: Vector
    phases: dict[str, Any]


def jacobian(f: Equations, x: Vector) -> Any:
    columns = []
    for k in range(len(x)):
        ahead, behind = list(x), list(x)
        ahead[k], behind[k] = x[k] + SMALL, x[k] - SMALL
        columns.append([(a - b) / (2 * SMALL) for a, b in zip(f(ahead), f(behind), strict=True)])
    return mp.matrix(columns).T


def newton(f: Equations, guess: Vector) -> Vector:
    """The solution near a guess."""
    x = list(guess)
    for _ in range(60):
        step = mp.lu_solve(jacobian(f, x), mp.matrix(f(x)))
        x = [a - b for a, b in zip(x, step, strict=True)]
        if mp.norm(step) < ENOUGH:
            return x
    raise ArithmeticError("Newton's method does not converge")


def beside(f: Equations, guess: Vector, inverse: list[Vector]) -> Vector:
    """The solution very near a guess, where the inverse of the Jacobian is known well enough."""
    x = list(guess)
    for _ in range(60):
        wrong = f(x)
        steps = [mp.fdot(row, wrong) for row in inverse]
        x = [a - b for a, b in zip(x, steps, strict=True)]
        if max(abs(s) for s in steps) < ENOUGH:
            return x
    raise ArithmeticError("Newton's method does not converge")


def started(case: Higher) -> Started:
    """The initial position, with the constants of gears and wheels found along with it."""
    model = case.model(DIGITS)
    values = case.values(mp.mpf(case.start))
    given = [(model.meshes.index(mesh), *rest) for mesh, rest in case.meshing.items()]
    first = model.guess(case.points, case.angles)
    names = list(model.meshes)

    def f(y: Vector) -> Vector:
        x, phases = y[: model.size], dict(zip(names, y[model.size :], strict=True))
        seen = model.outputs(x)
        return model.equations(values, x, phases) + [seen[name] - mp.mpf(v) for _, name, v in given]

    y = newton(f, first + [model.constants(first)[mesh] for mesh in names])
    if max((abs(a - b) for a, b in zip(y[: model.size], first, strict=True)), default=0) > 0.1:
        raise ArithmeticError(f"{case.name}: the initial position is far from its guess")
    return Started(y[: model.size], dict(zip(names, y[model.size :], strict=True)))


def equations(case: Higher, start: Started, q: Any) -> Equations:
    model, values = case.model(DIGITS), case.values(q)
    return lambda x: model.equations(values, x, start.phases)


class Trace:
    """The motion in doubles: from the initial position along the curve of (unknowns, drive)."""

    def __init__(self, case: Higher, start: Started) -> None:
        self.model, self.case = case.model(FLOATS), case
        self.phases = {name: float(v) for name, v in start.phases.items()}
        self.first = np.array([*(float(v) for v in start.x), case.start])

    def _f(self, y: Any) -> Any:
        values = [float(v) for v in self.case.values(float(y[-1]))]
        return np.array(self.model.equations(values, [float(v) for v in y[:-1]], self.phases))

    def _slopes(self, y: Any) -> Any:
        columns = []
        for k in range(len(y)):
            step = np.zeros(len(y))
            step[k] = 1e-6
            columns.append((self._f(y + step) - self._f(y - step)) / 2e-6)
        return np.array(columns).T

    def sense(self, y: Any) -> float:
        """Sign of the determinant by the unknowns: it changes at limits."""
        return float(np.sign(np.linalg.det(self._slopes(y)[:, :-1])))

    def walked(self, q: float) -> Vector:
        """The unknowns at a value of the drive, reached from the initial one in small steps; no limit between."""
        steps = 8 + int(abs(q - self.case.start) / TRACE)
        y = self.first.copy()
        for k in range(1, steps + 1):
            y[-1] = self.case.start + (q - self.case.start) * k / steps
            for _ in range(12):
                y[:-1] -= np.linalg.solve(self._slopes(y)[:, :-1], self._f(y))
        if self.sense(y) != self.sense(self.first):
            raise ArithmeticError(f"{self.case.name}: a limit lies before {q}")
        return list(y[:-1])

    def limit(self, way: float, reach: float) -> tuple[Any, Any] | None:
        """The place (unknowns, drive) of the limit in a direction, roughly, and the way the unknowns go there."""
        y, before = self.first.copy(), None
        while abs(y[-1] - self.case.start) < reach:
            tangent = np.linalg.svd(self._slopes(y))[2][-1]
            if before is None:
                tangent = tangent * np.sign(tangent[-1]) * way
            elif tangent @ before < 0:
                tangent = -tangent
            if before is not None and tangent[-1] * before[-1] < 0:
                return y, tangent[:-1] / np.linalg.norm(tangent[:-1])
            before = tangent
            y = self._corrected(y + TRACE * tangent, tangent)
        return None

    def _corrected(self, y: Any, tangent: Any) -> Any:
        for _ in range(8):
            matrix = np.vstack([self._slopes(y), tangent])
            y = y - np.linalg.solve(matrix, np.append(self._f(y), 0.0))
        return y


def limit(case: Higher, start: Started, near: Any, along: Any) -> tuple[Vector, Any, Vector]:
    """Unknowns, drive and direction where F = 0, J v = 0 and v is of unit length along itself roughly."""
    n = len(along)
    model, rough = case.model(DIGITS), [mp.mpf(float(v)) for v in along]

    def f(x: Vector, q: Any) -> Vector:
        return model.equations(case.values(q), x, start.phases)

    def extended(y: Vector) -> Vector:
        x, q, v = y[:n], y[n], y[n + 1 :]
        small = mp.mpf(10) ** -28
        ahead = f([a + small * b for a, b in zip(x, v, strict=True)], q)
        behind = f([a - small * b for a, b in zip(x, v, strict=True)], q)
        slopes = [(a - b) / (2 * small) for a, b in zip(ahead, behind, strict=True)]
        return f(x, q) + slopes + [mp.fdot(rough, v) - 1]

    with mp.workdps(100):
        y = newton(extended, [*(mp.mpf(float(v)) for v in near), *rough])
    return y[:n], y[n], y[n + 1 :]
