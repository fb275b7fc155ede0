"""A four-bar linkage followed in small steps of its crank, by Newton's method on its closure alone.

It shares nothing with the package: from the coordinates of a description it goes from target to target, and says where
the coupler point is at each, whether the order was kept, and whether a branch or a circuit was left.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

STEP = math.radians(0.2)


@dataclass(frozen=True)
class Walk:
    """Places of the points of the coupler at the targets, and what was met on the way."""

    places: dict[str, list[complex]]
    ordered: bool
    one_branch: bool
    closes: bool


def walk(mechanism: Any, crank: Any) -> Walk:
    """Follow a linkage O-A-B-D through angles of its crank [rad]."""
    points = mechanism.frame.points
    fixed, other = complex(*points["O"][:2]), complex(*points["D"][:2])
    arms = {
        name: [complex(*place) for place in mechanism.links[name].coordinates.values()]
        for name in ("OA", "DB")
    }
    a, c = (abs(arms[name][1] - arms[name][0]) for name in ("OA", "DB"))
    body = {name: complex(*place) for name, place in mechanism.links["AB"].coordinates.items()}
    b = abs(body["B"] - body["A"])
    left = mechanism.assembly.sides["B"] == "left"
    # the first position by the cosine rule, everything after it by continuation
    joint = fixed + a * np.exp(1j * crank[0])
    line = other - joint
    cosine = (abs(line) ** 2 + b * b - c * c) / (2 * b * abs(line))
    corner = math.acos(cosine) * (1 if left else -1)
    beta = float(np.angle(line)) + corner
    psi = float(np.angle(joint + b * np.exp(1j * beta) - other))
    places: dict[str, list[complex]] = {name: [] for name in body}
    sign, one_branch, closes = 0.0, True, True
    angle = float(crank[0])
    for target in crank:
        count = max(1, math.ceil(abs(target - angle) / STEP))
        for phi in np.linspace(angle, float(target), count + 1)[1 if target != angle else 0 :]:
            joint = fixed + a * np.exp(1j * phi)
            for _iteration in range(20):
                miss = joint + b * np.exp(1j * beta) - other - c * np.exp(1j * psi)
                slopes = np.array(
                    [[-b * math.sin(beta), c * math.sin(psi)], [b * math.cos(beta), -c * math.cos(psi)]]
                )
                step = np.linalg.solve(slopes, [-miss.real, -miss.imag])
                beta, psi = beta + step[0], psi + step[1]
                if np.abs(step).max() < 1e-13:
                    break
            closes &= abs(miss) < 1e-9 * (a + b + c)
            turned = math.copysign(1.0, math.sin(beta - psi))
            sign = sign or turned
            one_branch &= turned == sign
        angle = float(target)
        for name, local in body.items():
            places[name].append(joint + (local - body["A"]) * np.exp(1j * beta))
    steps = np.diff(crank)
    ordered = bool(((steps > 0).all() or (steps < 0).all()) and abs(crank[-1] - crank[0]) < 2 * math.pi)
    return Walk(places, ordered, one_branch, closes)
