"""Numbers of handbooks and test sets: Andrews' squeezing mechanism, contact stresses, a check by drawing."""

from __future__ import annotations

import math

import numpy as np

import centrode as ct
from centrode.analysis.graphic.checks import graphic_check
from tools.validation.rows import Row, Source

BETA = 15.81077119629904
SQUEEZER = {
    "gamma": 0.04082224013073101, "delta": 0.5244099658805304, "Phi": -0.5347301163226948,
    "Omega": 0.5347301163226948, "epsilon": 1.048080741042263,
}  # fmt: skip
"""The published solution at 0.03 s; it drifts off its own constraints by some 1e-10."""


def squeezer() -> Source:
    """Andrews' squeezing mechanism at the published crank angle."""
    data = ct.motion(ct.example("andrews-squeezer"), at=[BETA])
    link = {name: float(data.angle.sel(link=name)[0]) for name in ("BE", "AG", "AH", "GE", "HE")}
    found = {
        "gamma": link["BE"], "delta": link["AG"], "Phi": link["GE"] - link["AG"] + math.pi / 2,
        "Omega": link["HE"] - link["AH"], "epsilon": link["AH"],
    }  # fmt: skip
    return Source(
        "Andrews' squeezing mechanism",
        "Multibody Systems Handbook (1990) and Hairer & Wanner, Solving Ordinary Differential Equations II: the "
        f"reference solution at 0.03 s, where the crank is at {BETA} rad. It comes from an integration, here from "
        "the closure of the linkage (`andrews-squeezer`).",
        rows=tuple(
            Row("angle", name, "rad", told, 0.5e-9, told + _turned(found[name] - told))
            for name, told in SQUEEZER.items()
        ),
    )


def _turned(angle: float) -> float:
    """An angle brought to (-pi, pi]."""
    return float(np.remainder(angle + math.pi, 2 * math.pi) - math.pi)


def drawing() -> Source:
    """The assignment's check by drawing: angles read to whole degrees."""
    read = graphic_check(ct.example("slider-between-cranks"), math.pi / 2, angle_step=math.radians(1))
    rows = [
        Row(
            "angular velocity",
            "omega3",
            "rad/s",
            0.41,
            0.005,
            abs(read.row("angular_velocity", "CB").graphic),
        ),
        Row(
            "angular velocity",
            "omega4",
            "rad/s",
            0.024,
            0.0005,
            abs(read.row("angular_velocity", "BD").graphic),
        ),
        Row("speed", "v_B", "m/s", 0.0191, 0.00005, abs(read.row("velocity", "B").graphic)),
        Row("speed", "v_C", "m/s", 0.5, 0.05, abs(read.row("velocity", "C").graphic)),
    ]
    return Source(
        "Slider between two cranks, by drawing",
        "The assignment's graph-analytic check at t = pi/2, its angles read to whole degrees (`centrode diagrams "
        'slider-between-cranks --at "pi/2 rad" --angle-step "1 deg"`).',
        rows=tuple(rows),
    )
