"""The eight figures of the thesis on the spherical crank-rocker: speed, gamma and psi over beta and over time.

    python tools/thesis_figures.py FOLDER

Where the thesis's moment and friction are lost, those of its other figures stand in, and the title says so.
"""

from __future__ import annotations

import math
import sys
import tomllib
from importlib.resources import files
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import centrode as ct

FIGURES: tuple[tuple[int, float, float, float | None, float | None], ...] = (
    (1, math.pi / 24, math.pi / 2, None, None),
    (2, math.pi / 24, math.pi / 2, 2.67, None),
    (3, math.pi / 24, math.pi / 3, None, None),
    (4, math.pi / 24, math.pi / 6, None, None),
    (5, math.pi / 12, math.pi / 3, 1.0, 0.1),
    (6, math.pi / 12, math.pi / 3, 3.5, 0.1),
    (7, math.pi / 13, math.pi / 2, 1.0, 0.1),
    (8, math.pi / 13, math.pi / 2, 3.5, 0.1),
)
"""Number, AB, AB + BC, M [N m], alpha; None where it is lost."""
MOMENT, ALPHA = 2.67, 0.1
DURATION = 12.0
INK = "#1F4E79"


def mechanism(crank: float, coupler: float, alpha: float) -> ct.Mechanism:
    """The example with other arcs, their inertias, and friction."""
    text = (files("centrode.model.examples") / "spherical-crank-rocker.toml").read_text(encoding="utf-8")
    parts = tomllib.loads(text)
    parts["links"]["AB"] |= {"length": f"{crank!r} rad", "inertia": 1 - math.cos(crank)}
    parts["links"]["BC"] |= {"length": f"{coupler!r} rad", "inertia": 1 - math.cos(coupler)}
    parts["links"]["DC"] |= {"angle": f"{math.asin(math.cos(coupler) / math.cos(crank))!r} rad"}
    for load in parts["loads"]:
        load["quadratic"] = alpha
    return ct.Mechanism.model_validate(parts)


def curves(crank: float, coupler: float, moment: float, alpha: float) -> dict[str, np.ndarray]:
    """Time, beta, speed, gamma, psi from rest at beta = 0."""
    settings = ct.Simulation(driving=str(moment), duration=DURATION)
    found = ct.simulate(mechanism(crank, coupler, alpha), settings, motion=True)
    beta = found["turned"].to_numpy()
    return {
        "t": found["time"].to_numpy(),
        "beta": beta,
        "speed": found["drive_speed"].to_numpy(),
        "gamma": np.arcsin(found["position"].sel(point="B", axis="y").to_numpy() / math.sin(coupler)),
        "psi": found["joint_angle"].sel(joint="DC").to_numpy(),
    }


def figure(title: str, found: dict[str, np.ndarray]) -> Figure:
    """Three rows over beta and over time."""
    drawn = Figure(figsize=(9.0, 7.0), layout="constrained")
    grid = drawn.subplots(3, 2, sharex="col", sharey="row")
    rows = (("speed", "$\\dot\\beta$ [rad/s]"), ("gamma", "$\\gamma$ [rad]"), ("psi", "$\\psi$ [rad]"))
    for axes, (name, label) in zip(grid, rows, strict=True):
        axes[0].plot(found["beta"], found[name], color=INK)
        axes[1].plot(found["t"], found[name], color=INK)
        axes[0].set_ylabel(label)
        for one in axes:
            one.grid(alpha=0.3)
    grid[2][0].set_xlabel("$\\beta$ [rad]")
    grid[2][1].set_xlabel("$t$ [s]")
    drawn.suptitle(title)
    return drawn


def main(folder: Path) -> None:
    """Write figure-1.png to figure-8.png."""
    folder.mkdir(parents=True, exist_ok=True)
    for number, crank, whole, moment, alpha in FIGURES:
        lost = " (not told: " + ", ".join(n for n, x in (("M", moment), ("alpha", alpha)) if x is None) + ")"
        used = (MOMENT if moment is None else moment, ALPHA if alpha is None else alpha)
        parts = f"AB = pi/{math.pi / crank:.0f}, BC = pi/{math.pi / whole:.0f} - AB"
        parts += f", M = {used[0]:g}, alpha = {used[1]:g}"
        title = f"Figure {number}: {parts}" + (lost if None in (moment, alpha) else "")
        figure(title, curves(crank, whole - crank, *used)).savefig(folder / f"figure-{number}.png", dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
