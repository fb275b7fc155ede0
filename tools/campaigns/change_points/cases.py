"""Motions of such linkages beside the truth: alone, in batches and in sweeps by machine code."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import mpmath
import numpy as np
import numpy.typing as npt

import centrode as ct
from tools.campaigns.campaign import Campaign, Outcome
from tools.campaigns.change_points.drawing import drawn, lanes_of, values_of
from tools.campaigns.change_points.linkage import Linkage

Array = npt.NDArray[np.float64]
ORDERS = ("position", "velocity", "acceleration")
BOUNDS = (1e-12, 1e-10, 1e-8)
"""Errors in units of the size, per rad and per rad^2, where |1 - ratio| is `WIDE` or more."""
WIDE = 1e-2
TIMES = 100.0
"""Errors nearer to ratio 1, in units of what rounding of the dimensions and of the drive's value makes there.

The bounds of wide ratios hold where this is less."""


def compare(
    outcome: Outcome, linkage: Linkage, found: Mapping[str, Array], values: Array, row: str
) -> list[float]:
    """Keep the errors of a motion: `found` has (samples, orders, axes) for each point; returns the worst ones."""
    worst = [0.0] * 3
    for k, value in enumerate(values):
        exact = linkage.exact(float(value))
        for name in linkage.free:
            for order in range(3):
                truth = exact[order][name]
                error = max(
                    abs(float(mpmath.mpf(float(x)) - y))
                    for x, y in zip(found[name][k, order], truth, strict=True)
                )
                worst[order] = max(worst[order], error / linkage.size)
    answers = [linkage.answer(at) for at in places_of_rounding(linkage)]
    rounding = [max(one[order] for one in answers) for order in range(3)]
    for order, name in enumerate(ORDERS):
        outcome.measure(row, name, worst[order])
        outcome.measure(row, "times rounding", worst[order] / rounding[order])
        bound = BOUNDS[order]
        if 0.0 < linkage.gap < WIDE or linkage.chained:
            bound = max(bound, TIMES * rounding[order])
        if not worst[order] <= bound:
            outcome.fault(
                f"{row} ({linkage.ratio!r}): {name} off by {worst[order]:.2g} of the size, bound {bound:.2g}"
            )
    return worst


def places_of_rounding(linkage: Linkage) -> list[float]:
    """Where the answer to rounding is measured: about each spot at half its width and more, and along the turn.

    At a change point itself it is infinite, for the least change of one dimension makes limits of it.
    """
    begun = linkage.parts["drives"][0]["start"]
    around = [spot + times * width for spot, width in linkage.spots for times in (-2.0, -0.5, 0.5, 1.0)]
    if math.isinf(linkage.reach):
        return [*around, begun, begun + 1.6, begun + 3.0]
    return [at for at in around if abs(at - linkage.spots[0][0]) < 0.9 * linkage.reach] + [begun]


def alone(outcome: Outcome, linkage: Linkage, random: np.random.Generator) -> None:
    """One motion at values on and about the change points."""
    values = values_of(linkage, random)
    data = ct.motion(ct.Mechanism(**linkage.parts), at=values)
    status = data.status.to_numpy()
    outcome.count("samples", len(values))
    if (status != 0).any():
        outcome.fault(f"{linkage.row} ({linkage.ratio!r}): {told(status)}")
        return
    found = {
        name: np.stack([data[order].sel(point=name).to_numpy() for order in ORDERS], axis=1)
        for name in linkage.free
    }
    compare(outcome, linkage, found, values, linkage.row)


def told(status: npt.NDArray[Any]) -> str:
    """How many samples have each status."""
    codes, counts = np.unique(status, return_counts=True)
    return ", ".join(
        f"{ct.Status(int(code)).word} {count}" for code, count in zip(codes, counts, strict=True)
    )


def batch(outcome: Outcome, linkage: Linkage, random: np.random.Generator) -> None:
    """Several mechanisms in one motion."""
    lanes = lanes_of(linkage, random)
    values = values_of(linkage, random)
    vary = {path: np.array([lane.dimensions[path] for lane in lanes]) for path in linkage.vary}
    data = ct.motion(ct.Mechanism(**linkage.parts), at=values, vary=vary)
    for k, lane in enumerate(lanes):
        own = data.isel(mechanism=k)
        outcome.count("samples", len(values))
        if (own.status != 0).any():
            outcome.fault(
                f"{lane.row} ({lane.ratio!r}), mechanism {k} of a batch: {told(own.status.to_numpy())}"
            )
            continue
        found = {"B": np.stack([own[order].sel(point="B").to_numpy() for order in ORDERS], axis=1)}
        compare(outcome, lane, found, values, lane.row)


def compiled(outcome: Outcome, linkage: Linkage, random: np.random.Generator) -> None:
    """Several mechanisms in a sweep by machine code, over a narrow range about a change point or over two turns."""
    lanes = lanes_of(linkage, random)
    spot, width = linkage.spots[int(random.integers(len(linkage.spots)))]
    about = 5.0 * width if random.random() < 0.5 else 2.0 * math.pi
    span: dict[str, Any] = {"samples": 41, "start": spot - about, "stop": spot + about}
    mechanism = ct.Mechanism(**linkage.parts)
    vary = {path: np.array([lane.dimensions[path] for lane in lanes]) for path in linkage.vary}
    outputs = [f"{order}.B" for order in ORDERS]
    data = ct.sweep(mechanism, vary, outputs, executor="machine code", **span)
    values = ct.motion(mechanism, **span).drive_value.to_numpy()[:, 0]
    for k, lane in enumerate(lanes):
        own = data.isel(mechanism=k)
        outcome.count("samples", len(values))
        if (own.status != 0).any():
            outcome.fault(
                f"{lane.row} ({lane.ratio!r}), mechanism {k} of a sweep: {told(own.status.to_numpy())}"
            )
            continue
        found = {"B": np.stack([own[name].to_numpy() for name in outputs], axis=1)}
        compare(outcome, lane, found, values, lane.row)


def run(seed: int, number: int) -> Outcome:
    """One linkage, alone, in a batch or in a sweep by machine code."""
    linkage, way, random = drawn(seed, number)
    outcome = Outcome(
        f"# {way}, ratio {linkage.ratio!r}\n" + ct.mechanism_text(ct.Mechanism(**linkage.parts))
    )
    outcome.count(way)
    {"alone": alone, "batch": batch, "machine code": compiled}[way](outcome, linkage, random)
    return outcome


CAMPAIGN = Campaign(
    name="change-points",
    title="Change points",
    about="""Parallelograms, antiparallelograms, kites, in-line four-bars and aligned slider-cranks, in the plane and
on the sphere, alone, in chains, in batches and in sweeps by machine code. The ratio of crank to frame (of coupler to
rocker, or of coupler to crank, where these make the bend) goes from 0.05 to 20. Half of the cases lie within 0.1 of
ratio 1, down to 1e-6.

The truth is a closed form in which the passage of the change point is a factor, computed with 80 digits from the very
doubles that the program is given; derivatives are difference quotients at 80 digits. What rounding makes is the answer
of the closure equations to one rounding of each dimension and of the drive's value, the greatest along the turn and
about the bends, not nearer to a change point than half the width of its bend.""",
    columns={
        "position": "greatest error of a place in the size of the mechanism; bound 1e-12 where |1 - ratio| >= 0.01",
        "velocity": "of its first derivative by the drive's value; bound 1e-10",
        "acceleration": "of its second derivative; bound 1e-8",
        "times rounding": (
            "the greatest of these three over what rounding alone makes; below 0.01 the bound is 100, or the bounds "
            "above where these are greater"
        ),
    },
    run=run,
    cases=2000,
)
