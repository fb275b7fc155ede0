"""A motion of the program beside the solutions of closure equations: statuses, limits, positions and derivatives."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np

import centrode as ct
from centrode.errors import CentrodeError
from tools.campaigns.campaign import Outcome
from tools.campaigns.closure.equations import Array, Equations
from tools.campaigns.closure.walk import Walk, walked
from tools.campaigns.columns import EPS

ORDERS = ("position", "velocity", "acceleration")
SAMPLES = 25
EXACT = 4
"""Samples of a case that are compared at 50 digits."""
UNTIL = 2.0 * math.pi
WORTH = 1e4
"""Samples whose answer to rounding is more are compared by their status alone."""
BOUND = 8.0
"""Errors in units of what rounding of the equations makes."""
BESIDE = 1e-6
"""Samples nearer to a limit [rad] are not judged."""
LIMITS = 1e-9
"""Error of a limit [rad]."""
SINGULAR = 1e8
"""Condition of the equations at the start from which a case is left out."""
COLUMNS = {
    "position": "greatest error of a point in the size of the mechanism",
    "velocity": "of its first derivative by the crank's angle",
    "acceleration": "of its second derivative",
    "position / rounding": f"the same in units of what rounding makes; bound {BOUND:g}",
    "velocity / rounding": f"bound {BOUND:g}",
    "acceleration / rounding": f"bound {BOUND:g}",
    "limit": f"error of a limit [rad]; bound {LIMITS:g}",
}


def compare_motion(
    outcome: Outcome, row: str, mechanism: ct.Mechanism, closure: Equations, random: np.random.Generator
) -> None:
    """Judge statuses over two turns, limits, and at some samples positions with two derivatives."""
    wrong = float(np.max(abs(closure.values(closure.start, closure.begun))))
    if wrong > 1e-12 * (1.0 + closure.length):
        raise ArithmeticError(f"the start does not close: {wrong:.2g}")
    if np.linalg.cond(closure.jacobian(closure.start, closure.begun)[:, :-1]) > SINGULAR:
        outcome.count("left out: singular at the start")
        return
    # events are those of the range, so both its ends are among the samples
    apart = np.sort(random.uniform(-UNTIL, UNTIL, SAMPLES - 2))
    values = closure.begun + np.concatenate([[-UNTIL], apart, [UNTIL]])
    try:
        data = ct.motion(mechanism, at=values)
    except CentrodeError as refusal:
        outcome.count("refused")
        outcome.fault(f"refused: {refusal}")
        return
    back, forth = (walked(closure, way, UNTIL) for way in (-1.0, 1.0))
    outcome.count("samples", SAMPLES)
    outcome.count("walks given up", int(back.given_up) + int(forth.given_up))
    good = []
    for k, value in enumerate(values):
        walk = forth if value > closure.begun else back
        if judged(outcome, row, walk, float(value), ct.Status(int(data.status[k]))):
            good.append(k)
    compare_limits(outcome, row, data, (back, forth))
    for k in random.permutation(good)[:EXACT]:
        value = float(values[k])
        compare(
            outcome, row, closure, forth if value > closure.begun else back, data.isel(sample=int(k)), value
        )


def judged(outcome: Outcome, row: str, walk: Walk, value: float, status: ct.Status) -> bool:
    """Whether a sample is there; a status that the walk contradicts is a fault."""
    last = float(walk.nodes[-1][-1])
    first = float(walk.nodes[0][-1])
    way = 1.0 if value > first else -1.0
    if walk.limit is not None:
        if abs(value - walk.limit) < BESIDE:
            return False
        there = way * (walk.limit - value) > 0.0
    elif walk.given_up:
        there = way * (last - value) > 0.0
        if not there:
            return False
    else:
        there = True
    if there and status != ct.Status.OK:
        outcome.fault(f"{row}: {status.word} at {value!r}, where the chain gets")
    elif not there and status not in (ct.Status.OPEN, ct.Status.CUT_OFF):
        outcome.fault(f"{row}: {status.word} at {value!r}, beyond the limit {walk.limit!r}")
    return there and status == ct.Status.OK


def compare_limits(outcome: Outcome, row: str, data: Any, walks: tuple[Walk, Walk]) -> None:
    """The nearest limits on both sides of the start."""
    places = data.event_value.to_numpy()[data.event_kind.to_numpy() == 0]
    for walk in walks:
        if walk.limit is None:
            continue
        outcome.count("limits")
        off = float(np.min(abs(places - walk.limit), initial=math.inf))
        outcome.hold(row, "limit", off, LIMITS)


def compare(outcome: Outcome, row: str, closure: Equations, walk: Walk, data: Any, value: float) -> None:
    """Positions with two derivatives at one sample, in units of what rounding makes of them."""
    x = closure.closed(walk.near(value), value)
    if x is None:
        outcome.count("samples left out: no solution in doubles")
        return
    exact = closure.exact(x, value)
    size = max(closure.length, 1.0)
    rounding = answers(closure, x, value, exact)
    if rounding[0] > WORTH * EPS:
        outcome.count("samples left out: badly conditioned")
        return
    outcome.count("samples at 50 digits")
    for order, name in enumerate(ORDERS):
        found = data[name].sel(point=closure.points).to_numpy().ravel()
        worst = max(
            abs(float(mpmath.mpf(float(a)) - b)) for a, b in zip(found, exact[order], strict=True)
        ) / size  # fmt: skip
        if order == 0 and worst > 1e-6:
            outcome.fault(f"{row}: another position at {value!r}, {worst:.2g} of the size off")
            return
        outcome.measure(row, name, worst)
        outcome.hold(row, f"{name} / rounding", worst / rounding[order], BOUND)


def answers(closure: Equations, x: Array, value: float, exact: tuple[list[Any], ...]) -> list[float]:
    """What one rounding of every term of the equations makes of the positions and their derivatives.

    The equations are sums of lengths times sines: their second and third derivatives are of the size of the lengths.
    """
    size = max(closure.length, 1.0)
    inverse = np.linalg.inv(closure.jacobian(x, value)[:, :-1])
    condition = float(np.max(np.sum(abs(inverse), axis=1))) * size
    speed, bend = (1.0 + max(abs(float(u)) for u in column) for column in exact[1:])
    turns = 1.0 + float(np.max(abs(inverse @ closure.jacobian(x, value)[:, -1])))
    speed = max(speed, turns)
    zero = EPS * condition
    first = condition * zero * speed
    second = condition * (first * speed + zero * (speed**2 + bend))
    return [zero, first, second]
