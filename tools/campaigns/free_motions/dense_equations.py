"""A second way to a free motion that shares no formula with the package: absolute coordinates, dense equations.

In the plane a body has the place of its centre of mass and its angle, on the sphere the nine cosines of its axes, so
that both mass matrices are constant and no term of the motion itself has to be written down. Constraints are values
alone: their Jacobian comes from complex steps, what their second derivative by time holds beside the accelerations
from differences of the sixth order. Equations that repeat others are dealt with by the least forces (a singular value
decomposition). SciPy's DOP853 integrates; after each step places and velocities are brought back to the constraints.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.integrate import DOP853

Array: TypeAlias = npt.NDArray[Any]
Parts: TypeAlias = Mapping[str, Any]
Pose: TypeAlias = tuple[Array, Array]
"""Of a body, over lanes: place of its origin (axes, lanes), and cosines of its axes (axes, axes, lanes)."""

TINY = 1e-30
"""Complex steps, which lose nothing."""
AWAY = np.array([-3.0, -2.0, -1.0, 1.0, 2.0, 3.0])
WEIGHTS = np.array([-1.0, 9.0, -45.0, 45.0, -9.0, 1.0]) / 60.0
"""Differences of the sixth order of a first derivative."""
APART = 3e-3
"""Their step, of unit coordinates."""
RANK = 1e-9
"""Equations below this share of the greatest singular value repeat others."""
INDEPENDENT = 1e-6
"""The same share at the start, where constraints hold."""
MOST_STEPS = 500


class TooManySteps(Exception):
    """The motion needs more steps than are waited for."""


@dataclass
class DenseEquations:
    """Constraints and a constant mass matrix.

    Attributes
    ----------
    constraints : (coordinates, lanes) -> (equations, lanes), over complex numbers too
    root : W with W W' = M^-1
    force : (coordinates), constant
    repeats : whether equations repeat others
    rank : number of equations that do not; off the constraints those that repeat others are none, as far as it goes
    potential : (coordinates, lanes) -> (lanes), of springs, over complex numbers too
    """

    constraints: Callable[[Array], Array]
    root: Array
    force: Array
    repeats: bool = True
    rank: int | None = None
    potential: Callable[[Array], Array] | None = None

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.force)

    def rows(self, q: Array) -> Array:
        """Jacobian of the constraints."""
        lanes = q[:, None] + 1j * TINY * np.eye(self.size)
        return np.imag(self.constraints(lanes)) / TINY

    def forces(self, q: Array) -> Array:
        """Forces along the coordinates: weights, and what springs give."""
        if self.potential is None:
            return self.force
        lanes = q[:, None] + 1j * TINY * np.eye(self.size)
        return np.asarray(self.force - np.imag(self.potential(lanes)) / TINY)

    def accelerations(self, q: Array, v: Array) -> Array:
        """Accelerations that the forces and the least forces of the constraints give."""
        step = APART / max(1.0, float(np.max(np.abs(v))))
        lanes = np.concatenate(
            [
                q[:, None] + 1j * TINY * np.eye(self.size),
                q[:, None] + v[:, None] * (step * AWAY) + 1j * TINY * v[:, None],
            ],
            axis=1,
        )
        slopes = np.imag(self.constraints(lanes)) / TINY
        rows, bias = slopes[:, : self.size], slopes[:, self.size :] @ WEIGHTS / step
        free = self.root @ (self.root.T @ self.forces(q))
        along = rows @ self.root
        right = rows @ free + bias
        if self.repeats:
            return np.asarray(free - self.root @ self._least_change(along, right))
        forces = np.linalg.solve(along @ along.T, right)
        return np.asarray(free - self.root @ (along.T @ forces))

    def closed(self, q: Array) -> Array:
        """The nearest coordinates that close."""
        for _step in range(20):
            gap = self.constraints(q[:, None])[:, 0]
            change = -self._least_change(self.rows(q), gap)
            q = q + change
            if np.max(np.abs(change), initial=0.0) < 1e-14 * (1.0 + np.max(np.abs(q))):
                break
        return q

    def consistent(self, q: Array, v: Array) -> Array:
        """The nearest velocities that the constraints allow."""
        rows = self.rows(q)
        return np.asarray(v - self._least_change(rows, rows @ v))

    def _least_change(self, rows: Array, gap: Array) -> Array:
        """The least change that makes up for a gap, by as many singular values as there are equations that count."""
        if not len(rows):
            return np.zeros(self.size)
        left, sizes, right = np.linalg.svd(rows, full_matrices=False)
        counted = slice(0, self.rank if self.rank is not None else int(np.sum(sizes > RANK * sizes[0])))
        return np.asarray(right[counted].T @ ((left[:, counted].T @ gap) / sizes[counted]))

    def energy_of_motion(self, v: Array) -> float:
        """Kinetic energy [J]."""
        return 0.5 * float(np.sum(np.linalg.solve(self.root, v) ** 2))

    def state_at(self, q: Array, v: Array, end: float, tolerance: float = 1e-10) -> tuple[Array, Array]:
        """Coordinates and velocities at a time [s]; TooManySteps where that takes too long."""
        size = self.size

        def slope(_time: float, y: Array) -> Array:
            return np.concatenate([y[size:], self.accelerations(y[:size], y[size:])])

        solver = DOP853(slope, 0.0, np.concatenate([q, v]), end, rtol=tolerance, atol=tolerance)
        count = 0
        while solver.status == "running":
            count += 1
            if count > MOST_STEPS:
                raise TooManySteps(solver.t)
            solver.step()
            at = self.closed(solver.y[:size])
            solver.y = np.concatenate([at, self.consistent(at, solver.y[size:])])
            solver.f = slope(solver.t, solver.y)
        if solver.status != "finished":
            raise TooManySteps(solver.t)
        return solver.y[:size], solver.y[size:]


class DenseMechanism:
    """A mechanism in absolute coordinates, from the parts of its description.

    Parameters
    ----------
    parts : of a description whose points all belong to bodies, and all numbers are SI
    places : points -> where they are at the start [m]
    turns : links -> angle [rad] in the plane, cosines of the axes (3, 3) on the sphere, at the start
    """

    def __init__(self, parts: Parts, places: Mapping[str, Sequence[float]], turns: Mapping[str, Any]) -> None:
        self.parts, self.on_sphere = parts, parts.get("space") == "sphere"
        self.bodies = list(parts["links"])
        self.each = 9 if self.on_sphere else 3
        self.local = {name: self._local(body) for name, body in parts["links"].items()}
        self.local["frame"] = {
            name: unit(at) if self.on_sphere else np.array(at, dtype=float)
            for name, at in parts["frame"]["points"].items()
        }
        self.centres = (
            {} if self.on_sphere else {name: np.array(parts["links"][name]["centre"]) for name in self.bodies}
        )
        self.kept: dict[Any, Any] = {}
        self.turned: tuple[Array, Array, Array] | None = None
        """Coordinates that were looked at last, and cosines and sines of their angles."""
        start = self._start(places, turns)
        self.equations = DenseEquations(self.constraints, self._root(), self._force())
        self.constraints(start[:, None])  # what wheels keep is what they have here
        self.start = self.equations.closed(start)
        rows = self.equations.rows(self.start)
        sizes = np.linalg.svd(rows, compute_uv=False) if len(rows) else np.ones(1)
        independent = int(np.sum(sizes > INDEPENDENT * sizes[0])) if len(rows) else 0
        self.equations.repeats = independent < len(rows)
        self.equations.rank = independent

    def _local(self, body: Parts) -> dict[str, Array]:
        points = body["points"]
        if isinstance(points, Mapping):
            return {name: unit(at) if self.on_sphere else np.array(at, float) for name, at in points.items()}
        first, second = points
        return {first: unit((0.0, 0.0)), second: unit((body["length"], 0.0))}

    def _start(self, places: Mapping[str, Sequence[float]], turns: Mapping[str, Any]) -> Array:
        q = np.zeros(self.each * len(self.bodies))
        for k, name in enumerate(self.bodies):
            if self.on_sphere:
                q[9 * k : 9 * k + 9] = np.asarray(turns[name]).ravel()
                continue
            angle, (point, local) = float(turns[name]), next(iter(self.local[name].items()))
            x, y = rotated(local - self.centres[name], angle)
            q[3 * k : 3 * k + 3] = places[point][0] - x, places[point][1] - y, angle
        return q

    # masses and weights

    def _root(self) -> Array:
        root = np.zeros((self.each * len(self.bodies),) * 2)
        for k, name in enumerate(self.bodies):
            body = self.parts["links"][name]
            if self.on_sphere:
                # twice the energy is the sum over masses of |R' x|^2: the nine cosines have a constant matrix
                tensor = np.diag(np.asarray(body["inertia"], float))
                spread = 0.5 * np.trace(tensor) * np.eye(3) - tensor
                centre = body["centre_radius"] * unit(body["centre"])
                spread += body["mass"] * np.outer(centre, centre)
                own = np.kron(np.linalg.inv(np.linalg.cholesky(spread)).T, np.eye(3))
                root[9 * k : 9 * k + 9, 9 * k : 9 * k + 9] = own
                continue
            sizes = np.array([body["mass"], body["mass"], body["inertia"]])
            root[3 * k : 3 * k + 3, 3 * k : 3 * k + 3] = np.diag(1.0 / np.sqrt(sizes))
        return root

    def _force(self) -> Array:
        gravity = np.array(self.parts["gravity"], dtype=float)
        force = np.zeros(self.each * len(self.bodies))
        for k, name in enumerate(self.bodies):
            body = self.parts["links"][name]
            if self.on_sphere:
                centre = body["centre_radius"] * unit(body["centre"])
                # the centre is the sum of the axes times its components
                force[9 * k : 9 * k + 9] = body["mass"] * np.kron(centre, gravity)
            else:
                force[3 * k : 3 * k + 2] = body["mass"] * gravity
        return force

    def add_springs(self, springs: Sequence[Any]) -> None:
        """Springs between two points, straight and with a stiffness and a free length."""
        if not springs:
            return

        def potential(q: Array) -> Array:
            total = np.zeros(q.shape[1], dtype=q.dtype)
            for spring in springs:
                apart = self.point(q, spring.points[1]) - self.point(q, spring.points[0])
                length = np.sqrt(np.sum(apart**2, axis=0))
                total = total + 0.5 * spring.stiffness * (length - spring.free_length) ** 2
            return total

        self.equations.potential = potential

    # places of everything

    def place(self, q: Array, body: str, local: Array) -> Array:
        """Where a place of a body is (axes, lanes)."""
        if body == "frame":
            return np.broadcast_to(local[:, None], (len(local), q.shape[1]))
        k = self.bodies.index(body)
        if self.on_sphere:
            return np.tensordot(local, self.axes(q, body), 1)
        x, y = local - self.centres[body]
        if self.turned is None or self.turned[0] is not q:
            self.turned = q, np.cos(q[2::3]), np.sin(q[2::3])
        cosine, sine = self.turned[1][k], self.turned[2][k]
        return np.array([q[3 * k] + cosine * x - sine * y, q[3 * k + 1] + sine * x + cosine * y])

    def axes(self, q: Array, body: str) -> Array:
        """On the sphere: axes of a body (axis, component, lanes)."""
        k = self.bodies.index(body)
        return np.asarray(q[9 * k : 9 * k + 9].reshape(3, 3, -1))

    def angle(self, q: Array, body: str) -> Array:
        """In the plane: angle of a body (lanes)."""
        return np.zeros(q.shape[1]) if body == "frame" else np.asarray(q[3 * self.bodies.index(body) + 2])

    def holders(self, point: str) -> list[str]:
        """Bodies that a point belongs to, the frame first."""
        return [name for name in ("frame", *self.bodies) if point in self.local[name]]

    def point(self, q: Array, name: str) -> Array:
        """Where a point is (axes, lanes)."""
        body = self.holders(name)[0]
        return self.place(q, body, self.local[body][name])

    # constraints

    def constraints(self, q: Array) -> Array:
        """Left sides of all constraints (equations, lanes)."""
        found: list[Array] = []
        points = dict.fromkeys(point for body in self.bodies for point in self.local[body])
        for point in points:
            first, *others = self.holders(point)
            at = self.place(q, first, self.local[first][point])
            for other in others:
                found.extend(self.place(q, other, self.local[other][point]) - at)
        if self.on_sphere:
            for body in self.bodies:
                a = self.axes(q, body)
                found += [np.sum(a[i] * a[j], axis=0) - float(i == j) for i in range(3) for j in range(i, 3)]
        for guide in self.parts.get("guides", ()):
            found += self._circle(q, guide) if self.on_sphere else self._line(q, guide)
        for number, gear in enumerate(self.parts.get("gears", ())):
            one, other = gear["links"]
            carrier = self.angle(q, gear.get("carrier", "frame"))
            turned = (self.angle(q, other) - carrier) - gear["ratio"] * (self.angle(q, one) - carrier)
            found.append(self._less_start(("gear", number), turned))
        for number, rolling in enumerate(self.parts.get("rolling", ())):
            found += self._rolling(q, number, rolling)
        return np.array(found) if found else np.zeros((0, q.shape[1]))

    def _less_start(self, key: Any, value: Array) -> Array:
        """A quantity less what it is at the start."""
        if key not in self.kept:
            self.kept[key] = float(np.real(value[0]))
        return np.asarray(value - self.kept[key])

    def _circle(self, q: Array, guide: Parts) -> list[Array]:
        pole = self.place(q, guide["on"], unit(guide["pole"]))
        return [np.sum(pole * self.point(q, guide["point"]), axis=0) - math.cos(guide["radius"])]

    def _line(self, q: Array, guide: Parts) -> list[Array]:
        on, local = guide["on"], np.array(guide["through"], float)
        heading = guide["direction"] + self.angle(q, on)
        holder = guide.get("link") or self.holders(guide["point"])[0]
        apart = self.place(q, holder, self.local[holder][guide["point"]]) - self.place(q, on, local)
        found = [np.cos(heading) * apart[1] - np.sin(heading) * apart[0]]
        if guide.get("link"):
            turned = self.angle(q, guide["link"]) - self.angle(q, on)
            found.append(self._less_start(("guide", guide["name"]), turned))
        return found

    def _rolling(self, q: Array, number: int, rolling: Parts) -> list[Array]:
        on, along, radius = rolling["on"], rolling["along"], rolling["radius"]
        centre = self.point(q, rolling["centre"])
        turned = self.angle(q, rolling["link"]) - self.angle(q, on)
        if "through" in along:
            heading = along["direction"] + self.angle(q, on)
            apart = centre - self.place(q, on, np.array(along["through"], float))
            across = np.cos(heading) * apart[1] - np.sin(heading) * apart[0]
            way = np.cos(heading) * apart[0] + np.sin(heading) * apart[1]
            # a wheel on the left side of its line turns clockwise as it goes on
            side = math.copysign(1.0, float(np.real(across[0]))) if ("side", number) not in self.kept else 0.0
            side = self.kept.setdefault(("side", number), side)
            return [
                across - side * radius,
                self._less_start(("roll", number), turned + side * way / radius),
            ]
        inside, circle = along.get("inside", False), along["radius"]
        apart = centre - self.place(q, on, np.array(along["centre"], float))
        reach = abs(circle - radius) if inside else circle + radius
        # the wheel turns against the body as much as the direction of its centre does, times this
        spin = 1.0 - circle / radius if inside else 1.0 + circle / radius
        begun = self.kept.setdefault(
            ("bearing", number),
            (
                float(
                    np.real(
                        np.arctan2(np.real(apart[1]), np.real(apart[0]))[0] - np.real(self.angle(q, on)[0])
                    )
                ),
                float(np.real(turned[0])),
            ),
        )
        bearing = begun[0] + (turned - begun[1]) / spin + self.angle(q, on)
        return [
            apart[0] ** 2 + apart[1] ** 2 - reach**2,
            np.cos(bearing) * apart[1] - np.sin(bearing) * apart[0],
        ]


def unit(at: Sequence[float]) -> Array:
    """Unit vector at longitude and latitude."""
    longitude, latitude = at
    return np.array(
        [
            math.cos(latitude) * math.cos(longitude),
            math.cos(latitude) * math.sin(longitude),
            math.sin(latitude),
        ]
    )


def rotated(vector: Array, angle: float) -> tuple[float, float]:
    """A vector of the plane turned by an angle."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]
