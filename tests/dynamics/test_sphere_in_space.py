"""A spherical linkage let run, against three rigid bodies in space with multipliers."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

import centrode as ct

Array = npt.NDArray[np.float64]

GRAVITY = np.array([0.4, -0.6, -9.81])
DRIVING, VISCOUS = 1.7, 0.05
DURATION, TOLERANCE = 2.5, 1e-11
FRAME = {"A": [1, 0, 0], "D": [0, 1, 0], "Z": [0, 0, 1]}
LINKS: dict[str, dict[str, Any]] = {
    "AB": {
        "points": ["A", "B"], "length": 0.3, "reference": ["A", "D"], "mass": 0.7,
        "centre": [0.2, 0.1], "centre_radius": 0.6,
        "inertia": [[0.05, 0.01, 0], [0.01, 0.08, -0.02], [0, -0.02, 0.07]],
    },
    "BC": {
        "points": ["B", "C"], "length": 0.8, "mass": 1.1, "centre": [0.4, -0.15], "centre_radius": 0.9,
        "inertia": [[0.11, 0, 0.02], [0, 0.2, 0.01], [0.02, 0.01, 0.17]],
    },
    "DC": {
        "points": ["D", "C"], "length": 1.5, "reference": ["D", "Z"], "mass": 0.9,
        "centre": [0.7, 0.05], "centre_radius": 0.8, "inertia": [0.2, 0.3, 0.15],
    },
}  # fmt: skip
HINGES = (("AB", None, "A"), ("AB", "BC", "B"), ("BC", "DC", "C"), ("DC", None, "D"))


def mechanism() -> ct.Mechanism:
    return ct.Mechanism(
        space="sphere", gravity=GRAVITY.tolist(), frame={"points": FRAME}, links=LINKS,
        drives=[{"link": "AB", "start": 0.0, "speed": 1.0}], assembly={"sides": {"C": "left"}},
        loads=[{"kind": "friction", "link": "BC", "relative_to": "AB", "viscous": VISCOUS}],
        simulation={"driving": str(DRIVING), "duration": DURATION, "tolerance": 1e-12},
    )  # fmt: skip


def axes_of(first: Array, second: Array) -> Array:
    """The own axes of a link, as columns: x through its first point, the second one on the equator."""
    y = second - (second @ first) * first
    y /= np.linalg.norm(y)
    return np.column_stack([first, y, np.cross(first, y)])


def tensor_of(link: dict[str, Any]) -> tuple[Array, Array]:
    """Tensor about the centre of the sphere, and mass times centre of mass, in own axes."""
    longitude, latitude = link["centre"]
    unit = [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)]
    at = link["centre_radius"] * np.array(unit)
    inertia = np.array(link["inertia"], dtype=float)
    own = np.diag(inertia) if inertia.ndim == 1 else inertia
    return own + link["mass"] * (at @ at * np.eye(3) - np.outer(at, at)), link["mass"] * at


def crossing(vector: Array) -> Array:
    """The matrix that crosses with a vector from the left."""
    x, y, z = vector
    return np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def rates(_t: float, state: Array) -> Array:
    """Euler's equations of the three bodies, with multipliers of two constraints a hinge."""
    turned, spins = state[:27].reshape(3, 3, 3), state[27:].reshape(3, 3)
    names = list(LINKS)
    matrix, right = np.zeros((17, 17)), np.zeros(17)
    for k, name in enumerate(names):
        tensor, moment = tensor_of(LINKS[name])
        world = turned[k] @ tensor @ turned[k].T
        block = slice(3 * k, 3 * k + 3)
        matrix[block, block] = world
        right[block] = np.cross(turned[k] @ moment, GRAVITY) - np.cross(spins[k], world @ spins[k])
    hinge_of = {
        "A": (0, 0.0),
        "B": (0, LINKS["AB"]["length"]),
        "C": (1, LINKS["BC"]["length"]),
        "D": (2, 0.0),
    }
    row = 9
    for one, other, point in HINGES:
        body, arc = hinge_of[point]
        axis = turned[body] @ np.array([np.cos(arc), np.sin(arc), 0.0])
        drift = np.zeros(3)
        across = np.linalg.svd(axis[None])[2][1:]
        for name, sense in ((one, 1.0), (other, -1.0)):
            if name is None:
                continue
            k = names.index(name)
            # the point of the hinge as both bodies carry it has one acceleration
            matrix[row : row + 2, 3 * k : 3 * k + 3] = -sense * across @ crossing(axis)
            drift += sense * np.cross(spins[k], np.cross(spins[k], axis))
        right[row : row + 2] = -across @ drift
        row += 2
    matrix[:9, 9:] = matrix[9:, :9].T
    crank = turned[0][:, 0]
    right[:3] += DRIVING * crank
    pin = turned[0] @ np.array([np.cos(0.3), np.sin(0.3), 0.0])
    rubbing = -VISCOUS * ((spins[1] - spins[0]) @ pin) * pin
    right[3:6] += rubbing
    right[:3] -= rubbing
    accelerations = np.linalg.solve(matrix, right)[:9]
    slopes = np.array([crossing(spin) @ rotation for spin, rotation in zip(spins, turned, strict=True)])
    return np.concatenate([slopes.ravel(), accelerations])


def test_a_run_in_space() -> None:
    """Angle and speed of the crank that swings from rest, within what both integrations may be off."""
    one = mechanism()
    times = np.linspace(0.0, DURATION, 26)
    found = ct.simulate(one, at=times)
    there = ct.motion(one, at=[0.0]).isel(sample=0)
    places = {name: np.array(place, dtype=float) for name, place in FRAME.items()}
    places |= {name: there.position.sel(point=name).to_numpy() for name in ("B", "C")}
    start = np.array([axes_of(*(places[point] for point in link["points"])) for link in LINKS.values()])
    state = np.concatenate([start.ravel(), np.zeros(9)])
    run = solve_ivp(rates, (0.0, DURATION), state, "DOP853", times, rtol=TOLERANCE, atol=TOLERANCE)
    second = run.y[:27].reshape(3, 3, 3, -1)[0, :, 1]  # y axis of the crank
    zero = second[:, 0]
    sine, cosine = second.T @ np.cross(places["A"], zero), second.T @ zero
    angle = np.unwrap(np.arctan2(sine, cosine))
    speed = run.y[27]  # the crank turns about x
    assert np.ptp(angle) > 2.0  # it swings far
    # both carry errors of the size of their tolerances, which a run of some radians multiplies by its growth
    allowed = 1e5 * TOLERANCE
    assert np.abs(found.drive_value.to_numpy()[:, 0] - angle).max() <= allowed
    assert np.abs(found.drive_speed.to_numpy() - speed).max() <= allowed * np.abs(speed).max()
