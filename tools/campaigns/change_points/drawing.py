"""Which linkage a case is, how it is computed and where."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from centrode.numerics import machine_code
from tools.campaigns.campaign import random_of
from tools.campaigns.change_points.chains import chain
from tools.campaigns.change_points.linkage import Linkage, bend
from tools.campaigns.change_points.plane import (
    aligned_slider_crank,
    galloway,
    in_line,
    kite,
    parallelogram,
)
from tools.campaigns.change_points.sphere import (
    spherical_kite,
    spherical_parallelogram,
    spherical_slider_crank,
)

Array = npt.NDArray[np.float64]


LANES = 3


def ratio_of(random: np.random.Generator) -> float:
    """A ratio from 0.05 to 20; half of them near 1, all decades down to 1e-6 alike."""
    if random.random() < 0.5:
        return float(1.0 + random.choice([-1.0, 1.0]) * 10.0 ** -random.uniform(1.0, 6.0))
    return float(np.exp(random.uniform(math.log(0.05), math.log(20.0))))


KINDS: tuple[Callable[[np.random.Generator, float], Linkage], ...] = (
    lambda random, ratio: parallelogram(random, ratio, crossed=False),
    lambda random, ratio: parallelogram(random, ratio, crossed=True),
    lambda random, ratio: parallelogram(random, ratio, crossed=True),
    kite,
    galloway,
    in_line,
    aligned_slider_crank,
    chain,
    lambda random, ratio: spherical_parallelogram(random, ratio, crossed=False),
    lambda random, ratio: spherical_parallelogram(random, ratio, crossed=True),
    spherical_kite,
    spherical_slider_crank,
)


WAYS = ("alone", "alone", "alone", "alone", "batch", "machine code")


def drawn(seed: int, number: int) -> tuple[Linkage, str, np.random.Generator]:
    """The linkage of a case, and how it is computed."""
    random = random_of(seed, number)
    kind = KINDS[int(random.integers(len(KINDS)))]
    linkage = kind(random, ratio_of(random))
    way = str(random.choice(WAYS))
    if (way != "alone" and not linkage.vary) or (way == "machine code" and not machine_code.PRESENT):
        way = "alone"
    return linkage, way, random


def values_of(linkage: Linkage, random: np.random.Generator) -> Array:
    """Values of the drive: two turns evenly, and on, beside and far nearer to each spot than its width."""
    begun = linkage.parts["drives"][0]["start"]
    if math.isinf(linkage.reach):
        found = list(np.linspace(begun - 2.0 * math.pi, begun + 2.0 * math.pi, 33))
    else:
        found = list(linkage.spots[0][0] + np.linspace(-0.9, 0.9, 33) * linkage.reach)
    for spot, width in linkage.spots:
        shifts = (-2, 0, 2) if math.isinf(linkage.reach) else (0,)
        at = spot + math.pi * float(random.choice(shifts))
        found.append(at)
        for power in range(7):
            found += [at + sign * width * 10.0 ** -(power * random.uniform(0.9, 1.1)) for sign in (-1.0, 1.0)]
        found += list(at + random.uniform(-2.0, 2.0, 4) * width)
    return np.array(found)


def lanes_of(linkage: Linkage, random: np.random.Generator) -> list[Linkage]:
    """The linkage with other ratios on the same side of 1, one a lane: the first keeps its own."""
    (one, *_rest) = linkage.vary
    own = linkage.dimensions[one]
    base = own / linkage.ratio
    lanes = []
    for lane in range(LANES):
        near = 1.0 + math.copysign(10.0 ** -random.uniform(0.5, 6.0), linkage.ratio - 1.0)
        length = own if lane == 0 else float(base * near)
        dimensions = {path: length if path in linkage.vary else x for path, x in linkage.dimensions.items()}
        spots = [
            (at, bend(length, base) if width != 0.5 or at != linkage.spots[1][0] else width)
            for at, width in linkage.spots
        ]
        if linkage.kind == "kite, coupler as rocker":
            spots = [
                (linkage.spots[0][0], 0.5),
                (linkage.spots[1][0], min(0.5, math.sqrt(2.0 * (length / base - 1.0)))),
            ]
        size = max(length, *linkage.dimensions.values())
        lanes.append(replace(linkage, ratio=length / base, dimensions=dimensions, spots=spots, size=size))
    return lanes
