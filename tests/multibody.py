"""A second way to forward dynamics in the plane, which shares no formula with the package.

Every link has three absolute coordinates: its centre of mass and its angle. Constraints are written down from the
description alone, their Jacobian by hand, its derivative along the motion by a complex step. Accelerations solve the
dense augmented (KKT) system of index one without stabilisation; SciPy's DOP853 integrates them, and after each step
positions and velocities are projected onto the constraints, with the masses as metric.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.linalg
from scipy.integrate import DOP853

import centrode as ct

Array = npt.NDArray[np.float64]
STEP = 1e-30
"""Of the complex differences, which lose nothing."""


@dataclass
class Body:
    """A link: where its coordinates stand, mass, inertia and its points about the centre of mass."""

    at: int
    mass: float
    inertia: float
    local: dict[str, tuple[float, float]]
    centre: tuple[float, float]


@dataclass
class Constraint:
    """Left sides, and the rows of their Jacobian, as functions of all coordinates and of time."""

    value: Callable[[Any, float], list[Any]]
    rows: Callable[[Any], list[dict[int, Any]]]
    acceleration: Callable[[float], float] = lambda t: 0.0
    """Second derivative by time of what a kept drive gives."""
    rate: Callable[[float], float] = lambda t: 0.0


@dataclass
class Multibody:
    """A planar mechanism in absolute coordinates.

    `inertias` gives links that the description leaves without mass a mass and an inertia; `kept` drives with their laws
    (value, first and second derivative by time).
    """

    mechanism: ct.Mechanism
    rods: bool = False
    kept: Mapping[str, tuple[Callable[[float], float], ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.bodies: dict[str, Body] = {}
        for k, (name, link) in enumerate(self.mechanism.links.items()):
            self.bodies[name] = self._body(3 * k, link)
        self.size = 3 * len(self.bodies)
        weights = np.zeros(self.size)
        for body in self.bodies.values():
            weights[body.at : body.at + 3] = body.mass, body.mass, body.inertia
        self.weights = weights
        self.gravity = np.array(self.mechanism.gravity or (0.0, 0.0))
        self.constraints: list[Constraint] = []
        self._hinges()
        self._guides()
        self._angles()
        self._drives()
        self.used: Array | None = None

    def _body(self, at: int, link: Any) -> Body:
        places = {name: tuple(map(float, where)) for name, where in link.coordinates.items()}
        mass, inertia, centre = link.mass or 0.0, link.inertia, link.centre
        ends = list(places.values())
        middle = tuple(float(np.mean(axis)) for axis in zip(*ends, strict=True))
        if isinstance(centre, str):
            centre = places[centre]
        if centre is None:
            centre = middle if len(ends) > 1 else ends[0]
        length = max(math.dist(a, b) for a in ends for b in ends)
        if self.rods and not link.mass and inertia is None:
            # 1 kg/m between the farthest points, for a plate as for a rod about the mean of its points
            mass, centre, inertia = (
                max(length, 1e-3),
                middle,
                max(length, 1e-3) * max(length, 1e-3) ** 2 / 12.0,
            )
        if link.shape == "rod":
            centre, inertia = middle, mass * length**2 / 12.0
        if link.shape == "disc":
            inertia = mass * link.radius**2 / 2.0
        if link.shape == "ring":
            inertia = mass * link.radius**2
        local = {name: (x - centre[0], y - centre[1]) for name, (x, y) in places.items()}
        return Body(at, float(mass), float(inertia or 0.0), local, centre)

    # Geometry: places of points as functions of the coordinates, and their derivatives.

    def place(self, q: Any, link: str, at: str | tuple[float, float]) -> tuple[Any, Any]:
        """Place of a point of a link, or of the frame."""
        if link == "frame":
            return self.mechanism.frame.coordinates[at] if isinstance(at, str) else at
        body = self.bodies[link]
        u, v = self.about(link, at)
        c, s = np.cos(q[body.at + 2]), np.sin(q[body.at + 2])
        return q[body.at] + c * u - s * v, q[body.at + 1] + s * u + c * v

    def about(self, link: str, at: str | tuple[float, float]) -> tuple[float, float]:
        """A point of a link about its centre of mass, in its own axes."""
        body = self.bodies[link]
        if isinstance(at, str):
            return body.local[at]
        return at[0] - body.centre[0], at[1] - body.centre[1]

    def slopes(
        self, q: Any, link: str, at: str | tuple[float, float]
    ) -> tuple[dict[int, Any], dict[int, Any]]:
        """Derivatives of the two coordinates of a point by all coordinates."""
        if link == "frame":
            return {}, {}
        body = self.bodies[link]
        u, v = self.about(link, at)
        c, s = np.cos(q[body.at + 2]), np.sin(q[body.at + 2])
        return (
            {body.at: 1.0, body.at + 2: -s * u - c * v},
            {body.at + 1: 1.0, body.at + 2: c * u - s * v},
        )

    def holder(self, point: str) -> str:
        """A body that carries a point."""
        if point in self.mechanism.frame.points:
            return "frame"
        return next(name for name, body in self.bodies.items() if point in body.local)

    # Constraints.

    def _hinges(self) -> None:
        for point in self.mechanism.points:
            bodies = ["frame"] if point in self.mechanism.frame.points else []
            bodies += [name for name, body in self.bodies.items() if point in body.local]
            for other in bodies[1:]:
                self._hinge(bodies[0], other, point)

    def _hinge(self, one: str, other: str, point: str) -> None:
        def value(q: Any, _t: float) -> list[Any]:
            (x, y), (u, v) = self.place(q, one, point), self.place(q, other, point)
            return [u - x, v - y]

        def rows(q: Any) -> list[dict[int, Any]]:
            return [
                _difference(b, a)
                for a, b in zip(self.slopes(q, one, point), self.slopes(q, other, point), strict=True)
            ]

        self.constraints.append(Constraint(value, rows))

    def angle(self, q: Any, link: str) -> Any:
        """Angle of a link; of the frame zero."""
        return 0.0 if link == "frame" else q[self.bodies[link].at + 2]

    def turn(self, link: str) -> dict[int, float]:
        """Derivative of a link's angle."""
        return {} if link == "frame" else {self.bodies[link].at + 2: 1.0}

    def along(self, q: Any, guide: Any, across: bool) -> Any:
        """Where the point of a guide is along its line, or how far beside it."""
        (px, py), (x, y), (dx, dy) = self._guide(q, guide)
        return -dy * (px - x) + dx * (py - y) if across else dx * (px - x) + dy * (py - y)

    def _guide(self, q: Any, guide: Any) -> tuple[tuple[Any, Any], tuple[Any, Any], tuple[Any, Any]]:
        through = self.mechanism.through(guide)
        ux, uy = guide.unit
        phi = self.angle(q, guide.on)
        c, s = np.cos(phi), np.sin(phi)
        holder = guide.link or self.holder(guide.point)
        return (
            self.place(q, holder, guide.point),
            self.place(q, guide.on, through),
            (c * ux - s * uy, s * ux + c * uy),
        )

    def along_row(self, q: Any, guide: Any, across: bool) -> dict[int, Any]:
        """Derivative of `along`."""
        (px, py), (x, y), (dx, dy) = self._guide(q, guide)
        holder = guide.link or self.holder(guide.point)
        ex, ey = (-dy, dx) if across else (dx, dy)
        row: dict[int, Any] = {}
        for factor, point, base in zip(
            (ex, ey),
            self.slopes(q, holder, guide.point),
            self.slopes(q, guide.on, self.mechanism.through(guide)),
            strict=True,
        ):
            for k, slope in _difference(point, base).items():
                row[k] = row.get(k, 0.0) + factor * slope
        if guide.on != "frame":
            k = self.bodies[guide.on].at + 2
            # the direction turns with its body: de/dphi is e turned by a right angle
            row[k] = row.get(k, 0.0) - ey * (px - x) + ex * (py - y)
        return row

    def _guides(self) -> None:
        for guide in self.mechanism.guides:
            if guide.link is None and not any(guide.point in body.local for body in self.bodies.values()):
                message = f"point {guide.point} of a guide belongs to no link"
                raise NotImplementedError(message)
            self.constraints.append(
                Constraint(
                    lambda q, _t, guide=guide: [self.along(q, guide, True)],  # type: ignore[misc]
                    lambda q, guide=guide: [self.along_row(q, guide, True)],  # type: ignore[misc]
                )
            )
            if guide.link is not None:
                self._equal_angles({guide.link: 1.0, guide.on: -1.0})

    def _angles(self) -> None:
        for gear in self.mechanism.gears:
            one, other = gear.links
            # (other - carrier) - ratio (one - carrier)
            weights: dict[str, float] = {}
            for link, weight in ((other, 1.0), (one, -gear.ratio), (gear.carrier, gear.ratio - 1.0)):
                weights[link] = weights.get(link, 0.0) + weight
            self._equal_angles(weights)
        if self.mechanism.rolling:
            raise NotImplementedError("rolling wheels")

    def _equal_angles(self, weights: Mapping[str, float]) -> None:
        """A sum of angles keeps the value that it has where the motion starts."""
        start: list[float] = []

        def value(q: Any, _t: float) -> list[Any]:
            total = sum(weight * self.angle(q, link) for link, weight in weights.items())
            if not start:
                start.append(float(np.real(total)))
            return [total - start[0]]

        def rows(_q: Any) -> list[dict[int, Any]]:
            row: dict[int, Any] = {}
            for link, weight in weights.items():
                for k, one in self.turn(link).items():
                    row[k] = row.get(k, 0.0) + weight * one
            return [row]

        self.constraints.append(Constraint(value, rows))

    def _drives(self) -> None:
        for name, (law, rate, acceleration) in self.kept.items():
            drive = self.mechanism.drive(name)
            assert drive.link is not None
            row = _difference(self.turn(drive.link), self.turn(drive.relative_to))
            self.constraints.append(
                Constraint(
                    lambda q, t, d=drive, law=law: [  # type: ignore[misc]
                        self.angle(q, d.link) - self.angle(q, d.relative_to) - law(t)
                    ],
                    lambda _q, row=row: [row],  # type: ignore[misc]
                    acceleration,
                    rate,
                )
            )

    # Equations.

    def jacobian(self, q: Any) -> Any:
        """Rows of all constraints, of which `used` is kept."""
        found = [row for one in self.constraints for row in one.rows(q)]
        matrix = np.zeros((len(found), self.size), dtype=np.asarray(q).dtype)
        for k, row in enumerate(found):
            for column, slope in row.items():
                matrix[k, column] = slope
        return matrix if self.used is None else matrix[self.used]

    def residual(self, q: Any, t: float = 0.0) -> Any:
        """Left sides of all constraints that are kept."""
        values = np.array([x for one in self.constraints for x in one.value(q, t)])
        return values if self.used is None else values[self.used]

    def _given(self, which: str, t: float) -> Array:
        values = [
            getattr(one, which)(t) for one in self.constraints for _row in one.rows(np.zeros(self.size))
        ]
        return np.array(values) if self.used is None else np.array(values)[self.used]

    def forces(self, t: float, q: Array, v: Array) -> Array:
        """Generalised forces: weights and the loads of the description."""
        total = np.zeros(self.size)
        for body in self.bodies.values():
            total[body.at : body.at + 2] += body.mass * self.gravity
        for load in self.mechanism.loads:
            total += self._load(load, t, q, v)
        return total

    def _load(self, load: Any, t: float, q: Array, v: Array) -> Array:
        total = np.zeros(self.size)
        kind = load.kind
        if kind in ("spring", "damper") and getattr(load, "points", None):
            first, second = load.points
            one, other = self.holder(first), self.holder(second)
            apart = np.subtract(self.place(q, other, second), self.place(q, one, first))
            length = math.hypot(*apart)
            rows = [
                _difference(b, a)
                for a, b in zip(self.slopes(q, one, first), self.slopes(q, other, second), strict=True)
            ]
            row = np.zeros(self.size)
            for factor, slopes in zip(apart / length, rows, strict=True):
                for k, slope in slopes.items():
                    row[k] += factor * slope
            force = (
                -load.stiffness * (length - load.free_length)
                if kind == "spring"
                else -load.damping * (row @ v)
            )
            return force * row
        if kind in ("spring", "damper"):
            row = np.zeros(self.size)
            for k, slope in _difference(self.turn(load.link), self.turn(load.relative_to)).items():
                row[k] = slope
            if kind == "damper":
                return -load.damping * (row @ v) * row
            turned = self.angle(q, load.link) - self.angle(q, load.relative_to)
            return -load.stiffness * (turned - load.free_angle) * row
        if kind == "torque" and isinstance(load.value, int | float):
            total[self.bodies[load.link].at + 2] += load.value
            return total
        raise NotImplementedError(kind)

    def energy(self, q: Array, v: Array) -> float:
        """Kinetic energy, and the potential energy of weights and springs."""
        total = 0.5 * float(self.weights @ v**2)
        for body in self.bodies.values():
            total -= body.mass * float(self.gravity @ q[body.at : body.at + 2])
        for load in self.mechanism.loads:
            if load.kind == "spring" and getattr(load, "points", None):
                (one, first), (other, second) = ((self.holder(p), p) for p in load.points)
                length = math.dist(self.place(q, one, first), self.place(q, other, second))
                total += 0.5 * load.stiffness * (length - load.free_length) ** 2
        return total

    def accelerations(self, t: float, q: Array, v: Array) -> tuple[Array, Array]:
        """Accelerations of all coordinates, and the multipliers, by the augmented system."""
        rows = self.jacobian(q)
        bent = np.imag(self.jacobian(q + 1j * STEP * v) @ v) / STEP
        count = len(rows)
        matrix = np.zeros((self.size + count, self.size + count))
        matrix[: self.size, : self.size] = np.diag(self.weights)
        matrix[: self.size, self.size :] = rows.T
        matrix[self.size :, : self.size] = rows
        right = np.concatenate([self.forces(t, q, v), self._given("acceleration", t) - bent])
        found = np.linalg.solve(matrix, right)
        return found[: self.size], found[self.size :]

    # Start and integration.

    def closed(self, q: Array, t: float = 0.0) -> Array:
        """The nearest coordinates that close."""
        for _step in range(30):
            gap = self.residual(q, t)
            rows = self.jacobian(q)
            step = np.linalg.lstsq(rows, -gap, rcond=1e-10)[0]
            q = q + step
            if np.abs(step).max() < 1e-15 * (1.0 + np.abs(q).max()):
                break
        return q

    def consistent(self, q: Array, v: Array, t: float = 0.0) -> Array:
        """The nearest velocities that the constraints allow."""
        rows = self.jacobian(q)
        gap = rows @ v - self._given("rate", t)
        return v - np.linalg.lstsq(rows, gap, rcond=1e-10)[0]

    def start(self, angles: Mapping[str, float], places: Mapping[str, Sequence[float]]) -> Array:
        """Coordinates of links at angles, with their first points near given places, closed."""
        q = np.zeros(self.size)
        for name, body in self.bodies.items():
            phi = angles[name]
            point, (u, v) = next(iter(body.local.items()))
            x, y = places[point]
            c, s = math.cos(phi), math.sin(phi)
            q[body.at : body.at + 3] = x - (c * u - s * v), y - (s * u + c * v), phi
        self.residual(q)  # what gears and guides keep is what they have here
        q = self.closed(q)
        # constraints that repeat others are left out, by a factorisation that takes the greatest rows first
        rows = self.jacobian(q)
        _q, r, order = scipy.linalg.qr(rows.T, pivoting=True, mode="economic")
        diagonal = np.abs(np.diag(r))
        rank = int((diagonal > 1e-9 * diagonal[0]).sum()) if len(diagonal) else 0
        if rank < len(rows):
            self.used = np.sort(order[:rank])
        return q

    def run(
        self, q: Array, v: Array, instants: Sequence[float], tolerance: float = 1e-12
    ) -> list[tuple[Array, Array]]:
        """Coordinates and velocities at instants that grow, from t = 0."""
        n = self.size

        def slope(t: float, y: Array) -> Array:
            return np.concatenate([y[n:], self.accelerations(t, y[:n], y[n:])[0]])

        state, time, found = np.concatenate([q, v]), 0.0, []
        for instant in instants:
            if instant > time:
                solver = DOP853(slope, time, state, instant, rtol=tolerance, atol=tolerance)
                while solver.status == "running":
                    solver.step()
                    at = self.closed(solver.y[:n], solver.t)
                    solver.y = np.concatenate([at, self.consistent(at, solver.y[n:], solver.t)])
                    solver.f = slope(solver.t, solver.y)
                assert solver.status == "finished"
                state, time = solver.y, instant
            found.append((state[:n].copy(), state[n:].copy()))
        return found

    def angles(self, q: Array) -> dict[str, float]:
        """Angles of the links."""
        return {name: float(q[body.at + 2]) for name, body in self.bodies.items()}


def _difference(one: Mapping[int, Any], other: Mapping[int, Any]) -> dict[int, Any]:
    found = dict(one)
    for k, slope in other.items():
        found[k] = found.get(k, 0.0) - slope
    return found
