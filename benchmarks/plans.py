"""Plans of built-in mechanisms as graphs, their dimensions variables: what the kernels of `kernels` compute."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

import centrode as ct
from centrode.kinematics.machine_code.variables import NODE_JETS, PARAMETER, varied_of
from centrode.kinematics.plan_evaluation import FixedSigns, rotor_of_angle
from centrode.kinematics.preparation import ready
from centrode.numerics.expressions import EXPRESSIONS, Node, variable
from centrode.numerics.graphs import Graph
from centrode.numerics.jets import Jet
from centrode.structure.dimensions import dimensions_of

Array = npt.NDArray[np.float64]
SAMPLES = 361
DRIVE = np.linspace(0.0, 2.0 * np.pi, SAMPLES)[None]
LANES = 2000
"""Mechanisms of a batch: the outputs of one take no more than some hundred megabytes."""
EACH = 1e9 / (LANES * SAMPLES)
"""From seconds for a batch to nanoseconds for a position."""
DIMENSIONS: Mapping[str, tuple[str, ...]] = {
    "crank-rocker": ("links.OA.length", "links.AB.length", "links.DB.length", "frame.points.D.x"),
    "six-bar-press": (
        "links.OA.length", "links.AB.points.B.x", "links.CD.points.B.x", "links.CD.points.D.x",
        "links.DH.points.H.x", "frame.points.C.x", "guides.H.through.y",
    ),
    "spherical-four-bar": ("links.AB.length", "links.BC.length", "links.DC.length", "frame.points.D.longitude"),
}  # fmt: skip
"""What makes up the shape of a mechanism."""
SIX: Mapping[str, tuple[str, ...]] = {
    "crank-rocker": (*DIMENSIONS["crank-rocker"], "frame.points.D.y", "frame.points.O.x"),
    "six-bar-press": DIMENSIONS["six-bar-press"][:6],
    "spherical-four-bar": (
        *DIMENSIONS["spherical-four-bar"], "frame.points.D.latitude", "frame.points.A.longitude",
    ),
    "slider-crank-offset": (
        "links.OA.length", "links.AB.length", "guides.B.through.y", "guides.B.direction", "frame.points.O.x",
        "frame.points.O.y",
    ),
    "third-class-triad": (
        "links.OA.length", "links.AB.length", "links.DC.length", "links.EF.length", "frame.points.D.x",
        "frame.points.E.x",
    ),
}  # fmt: skip
"""Six of the dimensions by which a number is differentiated."""


@dataclass(frozen=True)
class Plan:
    """Points and angles with two derivatives by the drive, as expressions of dimensions and the drive's value.

    The crank, its end and its angle, is left out: they are products with what all mechanisms have in common.

    Attributes
    ----------
    outputs : value, first and second derivative of each number
    points : the outputs that are coordinates
    dimensions : variable -> (LANES,)
    took : processor time of tracing [s]
    """

    outputs: Mapping[str, Node]
    points: tuple[str, ...]
    dimensions: Mapping[str, Array]
    took: float

    @property
    def positions(self) -> dict[str, Node]:
        """Coordinates without derivatives."""
        return {name: self.outputs[name] for name in self.points}

    @property
    def of_points(self) -> dict[str, Node]:
        """Coordinates with their derivatives."""
        stems = tuple(name.rsplit(", ", 1)[0] for name in self.points)
        return {name: node for name, node in self.outputs.items() if name.startswith(stems)}

    @property
    def names(self) -> tuple[str, ...]:
        """Variables of a mechanism."""
        return tuple(self.dimensions)

    @property
    def by_lanes(self) -> Array:
        """Dimensions of the batch, (dimensions, LANES)."""
        return np.stack(list(self.dimensions.values()))


def plan_of(name: str, paths: tuple[str, ...]) -> Plan:
    """The plan of a built-in mechanism with variables at paths, for mechanisms that differ by some hundredths."""
    mechanism, draw = ct.example(name), np.random.default_rng(0)
    prepared = ready(mechanism)
    values = {path: ct.value_at(mechanism, path) + draw.uniform(-0.02, 0.02, LANES) for path in paths}
    numbers = dimensions_of(mechanism, values, np)
    start = time.process_time()
    varied = varied_of(numbers, values)
    kinematics = replace(prepared.kinematics, numbers=varied.numbers)
    signs = FixedSigns(NODE_JETS, prepared.assembled.signs)
    at = kinematics.positions(NODE_JETS, Jet.variable(variable(PARAMETER), 2), signs)
    crank = str(mechanism.drives[0].link)
    moving = [point for point in mechanism.moving_points if point not in mechanism.links[crank].coordinates]
    outputs = {
        f"{point} {axis}, {k}": x.derivative(k)
        for point in moving
        for axis, x in enumerate(at.points[point])
        for k in range(3)
    }
    points = tuple(outputs)[::3]
    for link in mechanism.links:
        if link != crank and link in varied.numbers.ends:
            rotor = rotor_of_angle(NODE_JETS, varied.numbers, at, link)
            if isinstance(rotor[0], Jet):
                outputs |= {f"angle {link}, {k}": x for k, x in enumerate(_angle(*rotor))}
    graph = Graph.of(outputs)
    took = time.process_time() - start
    found = varied.values(numbers)
    return Plan(graph.outputs, points, {x: found[x] for x in graph.variables if x in found}, took)


def _angle(cosine: Jet, sine: Jet) -> list[Any]:
    """An angle with two derivatives as a motion has them: those of a rotor, whose length is one."""
    rates = [cosine.value * sine.derivative(k) - sine.value * cosine.derivative(k) for k in (1, 2)]
    return [EXPRESSIONS.atan2(sine.value, cosine.value), *rates]
